//! An adaptive stepper over a kink of the drift: the boundary as an event, as `boundaries` of a generated model gives it.
#![forbid(unsafe_code)]

mod common;

use ahv_core::{Model, Real};
use ahv_integrate::{
    Adaptive, Constant, Crossing, DormandPrince54, DormandPrince853, Ending, Event, Method,
    Problem, Progress, Tsit5, When,
};
use common::vector;

vector!(Level, level);
vector!(Nothing, nothing);

const FROM: Level<f64> = Level { level: 3.0 };
const INPUT: Constant<Nothing<f64>> = Constant(Nothing { nothing: 0.0 });
const END: f64 = 1.5;

/// A tank that empties by one law above the level 1 and by another below; the rate has a kink there.
struct Tank;

impl Model for Tank {
    type Scalar = f64;
    type State = Level<f64>;
    type Input = Nothing<f64>;

    fn drift(&self, x: &Level<f64>, _: &Nothing<f64>) -> Level<f64> {
        let (below, above) = (-1.5 - 0.5 * x.level, -2.0 * x.level);
        Level {
            level: Real::select(x.level, 1.0, below, above),
        }
    }
}

/// When the tank is at the level 1.
fn at_the_kink() -> f64 {
    3.0_f64.ln() / 2.0
}

fn exact(time: f64) -> f64 {
    let after = time - at_the_kink();
    if after < 0.0 {
        3.0 * (-2.0 * time).exp()
    } else {
        4.0 * (-0.5 * after).exp() - 3.0
    }
}

/// A flight that ends a step at the boundary and goes on from there: the time of the boundary, the state at the end, the steps.
fn flown<S: Method<Tank> + Copy>(method: S, size: f64) -> (f64, Progress<Level<f64>>) {
    let boundary = When::new("boundary", Crossing::Either, |_, x: &Level<f64>| {
        x.level - 1.0
    });
    let events: [&dyn Event<Tank>; 1] = [&boundary];
    let problem = Problem::new(&Tank, &INPUT).events(&events);
    let mut progress = Progress::new(0.0, FROM);
    let stepper = Adaptive::new(method, size, Level { level: size });
    let mut time = f64::NAN;
    let mut passages = 0;
    loop {
        match stepper.run(&problem, &mut progress, END, &mut ()) {
            Ok(Ending::Event(located)) => {
                time = located.time;
                passages += 1;
            }
            Ok(_) => break,
            Err(failure) => panic!("{failure:?}"),
        }
    }
    assert_eq!(passages, 1);
    (time, progress)
}

#[test]
fn the_boundary_is_located_and_the_error_follows_the_tolerance() {
    fn check<S: Method<Tank> + Copy>(method: S, order: f64) {
        let mut work = Vec::new();
        for size in [1e-6, 1e-8, 1e-10, 1e-12] {
            let (time, progress) = flown(method, size);
            assert!((time - at_the_kink()).abs() < 20.0 * size, "{size}: {time}");
            let error = (progress.state.level - exact(END)).abs();
            assert!(error < 20.0 * size, "{size}: {error}");
            // Not one step more than the order asks for: no search for the kink with ever smaller steps.
            work.push(f64::from(progress.accepted) * size.powf(1.0 / order));
            assert!(progress.refused <= 2, "{size}: {}", progress.refused);
        }
        let greatest = work.iter().copied().fold(0.0, f64::max);
        assert!(greatest < 4.0 * work[0], "{work:?}");
    }
    check(DormandPrince54, 5.0);
    check(Tsit5, 5.0);
    check(DormandPrince853, 8.0);
}

/// Without the event a step over the kink fails, and the stepper looks for the kink with small steps.
#[test]
fn without_the_event_steps_are_rejected_at_the_kink() {
    let problem = Problem::new(&Tank, &INPUT);
    let mut progress = Progress::new(0.0, FROM);
    Adaptive::new(DormandPrince853, 1e-10, Level { level: 1e-10 })
        .run(&problem, &mut progress, END, &mut ())
        .expect("the tank empties");
    let (_, with) = flown(DormandPrince853, 1e-10);
    assert!(
        progress.refused > with.refused + 3,
        "{} and {}",
        progress.refused,
        with.refused
    );
}
