//! Steps under control of the error, with events and the state between steps: a ball that is thrown up through air.
//!
//! `cargo run -p ahv-integrate --example adaptive`

use ahv_integrate::prelude::*;

#[derive(Clone, Copy, Debug, PartialEq)]
struct Ball<T> {
    height: T,
    speed: T,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Wind<T> {
    upwards: T,
}

impl_vector!(Ball {
    height: ["m", "m", 1.0],
    speed: ["m/s", "m/s", 1.0]
});
impl_vector!(Wind {
    upwards: ["m/s", "m/s", 1.0]
});

/// In m/s².
const GRAVITY: f64 = 9.81;
/// Drag over speed squared and mass, in 1/m.
const DRAG: f64 = 0.01;

struct Throw;

impl Model for Throw {
    type Scalar = f64;
    type State = Ball<f64>;
    type Input = Wind<f64>;

    fn drift(&self, x: &Ball<f64>, u: &Wind<f64>) -> Ball<f64> {
        let through_air = x.speed - u.upwards;
        Ball {
            height: x.speed,
            speed: -GRAVITY - DRAG * through_air * through_air.abs(),
        }
    }
}

/// Prints the flight every 0.25 s, whatever the steps are.
struct Print {
    next: f64,
}

impl Observer<Ball<f64>> for Print {
    fn accepted(&mut self, step: &Dense<Ball<f64>>) {
        while self.next <= step.end() {
            let x = step.at(self.next);
            println!("{:5.2} s {:7.3} m {:8.3} m/s", self.next, x.height, x.speed);
            self.next += 0.25;
        }
    }

    fn event(&mut self, event: &Located<Ball<f64>>) {
        let (name, time, height) = (event.name, event.time, event.state.height);
        println!("{time:5.2} s {height:7.3} m, {name}");
    }
}

fn main() -> Result<(), Failure> {
    let start = Ball {
        height: 1.5,
        speed: 15.0,
    };
    let apex = When::new("apex", Crossing::Falling, |_, x: &Ball<f64>| x.speed).only_reported();
    // Ends the run.
    let ground = When::limit("ground", |_, x: &Ball<f64>| x.height);
    let events: [&dyn Event<Throw>; 2] = [&apex, &ground];
    let calm = Constant(Wind { upwards: 0.0 });
    let problem = Problem::new(&Throw, &calm).events(&events);

    let mut progress = Progress::new(0.0, start);
    let solver = Adaptive::new(Tsit5, 1e-10, Ball::splat(1e-10));
    let ending = solver.run(&problem, &mut progress, 60.0, &mut Print { next: 0.0 })?;

    let Ending::Event(landing) = ending else {
        panic!("the ball never lands");
    };
    println!(
        "{:5.2} s the {} is met at {:.3} m/s",
        landing.time, landing.name, landing.state.speed
    );
    // With drag the ball rises to ln(1 + k v²/g)/(2k) and comes down from there at the speed √(g/k (1 − e^{−2kh})).
    let apex =
        start.height + (1.0 + DRAG * start.speed * start.speed / GRAVITY).ln() / (2.0 * DRAG);
    let speed = (GRAVITY / DRAG * (1.0 - (-2.0 * DRAG * apex).exp())).sqrt();
    assert!((landing.state.speed + speed).abs() < 1e-8);
    Ok(())
}
