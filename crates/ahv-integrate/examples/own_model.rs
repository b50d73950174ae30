//! A model of your own, here a mass on a spring, flown by two steppers.
//!
//! `cargo run -p ahv-integrate --example own_model`

use ahv_integrate::prelude::*;

/// The state: named components, each with its unit, its SI unit and the factor between them.
#[derive(Clone, Copy, Debug, PartialEq)]
struct State<T> {
    position: T,
    speed: T,
}

/// The input.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Input<T> {
    force: T,
}

impl_vector!(State {
    position: ["m", "m", 1.0],
    speed: ["m/s", "m/s", 1.0]
});
impl_vector!(Input {
    force: ["N", "N", 1.0]
});

struct Spring {
    /// In N/m.
    stiffness: f64,
    /// In kg.
    mass: f64,
}

impl Model for Spring {
    type Scalar = f64;
    type State = State<f64>;
    type Input = Input<f64>;

    fn drift(&self, x: &State<f64>, u: &Input<f64>) -> State<f64> {
        State {
            position: x.speed,
            speed: (u.force - self.stiffness * x.position) / self.mass,
        }
    }
}

fn main() -> Result<(), Failure> {
    let model = Spring {
        stiffness: 4.0,
        mass: 1.0,
    };
    let start = State {
        position: 1.0,
        speed: 0.0,
    };
    let held = Input { force: 0.0 };
    // x = cos 2t.
    let exact = 2.0_f64.cos();

    // Fixed steps of 10 ms from 0 to 1 s.
    let grid = TimeGrid::new(0.0, 1.0, 0.01)?;
    let mut progress = Progress::new(0.0, start);
    while grid.step(&mut progress, |x, _, dt| {
        Rk4::new(dt).step(&model, x, &held)
    })? {}
    println!("Rk4:              {:.12} m", progress.state.position);
    assert!((progress.state.position - exact).abs() < 1e-8);

    // Steps as long as the tolerances allow: 1e-10 of a component, and 1e-12 in its own unit.
    let mut progress = Progress::new(0.0, start);
    Adaptive::new(DormandPrince853, 1e-10, State::splat(1e-12)).run(
        &Problem::new(&model, &Constant(held)),
        &mut progress,
        1.0,
        &mut (),
    )?;
    println!("DormandPrince853: {:.12} m", progress.state.position);
    println!("exact:            {exact:.12} m");
    assert!((progress.state.position - exact).abs() < 1e-9);
    Ok(())
}
