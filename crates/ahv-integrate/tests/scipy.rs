//! Flights of DCOM against SciPy's solvers on an independent derivation of the drift (`tests/vectors/dcom.flights.txt`).
#![forbid(unsafe_code)]

#[path = "common/order.rs"]
mod order;

use ahv_integrate::{
    Adaptive, Constant, DormandPrince54, DormandPrince853, Euler, Exponential, Fixed, FlexibleMode,
    Heun, Method, Problem, Progress, Rk4, Rodas4, StepError, TimeGrid, Tsit5,
};
use ahv_models::dcom;
use order::observed_order;

type State = dcom::State<f64>;
type Model = dcom::Model<f64>;

const FLIGHTS: &str = include_str!("../../../tests/vectors/dcom.flights.txt");
const END: f64 = 0.5;
const INPUT: dcom::Input<f64> = dcom::Input {
    phi: 0.2821,
    delta_e: 0.2286,
    delta_c: 0.0,
};

/// A flight of one parameter set, with SciPy's ends.
struct Flight {
    model: Model,
    modes: [FlexibleMode; 3],
    start: State,
    explicit: State,
    implicit: State,
}

fn row(set: &str, solver: &str) -> State {
    let line = FLIGHTS
        .lines()
        .find_map(|line| line.strip_prefix(&format!("{set},{solver},")))
        .expect("a row of the file");
    let values: Vec<f64> = line
        .split(',')
        .map(|value| value.parse().expect("a number"))
        .collect();
    State::from_array(values.try_into().expect("a value for each state"))
}

fn flights() -> [Flight; 2] {
    [
        ("section5.1", dcom::NOMINAL),
        ("section5.3", dcom::SECTION5_3),
    ]
    .map(|(set, p)| Flight {
        model: Model::new(&p),
        modes: [
            ("eta_1", "eta_dot_1", p.omega_1, p.zeta_1),
            ("eta_2", "eta_dot_2", p.omega_2, p.zeta_2),
            ("eta_3", "eta_dot_3", p.omega_3, p.zeta_3),
        ]
        .map(|(position, rate, omega, zeta)| {
            FlexibleMode::new::<Model>(position, rate, omega, zeta).expect("a mode of the model")
        }),
        start: row(set, "start"),
        explicit: row(set, "DOP853"),
        implicit: row(set, "Radau"),
    })
}

/// Greatest difference in units of the half width of the validity box.
fn distance(a: &State, b: &State) -> f64 {
    let bounds = dcom::STATE_BOUNDS.to_array();
    let pairs = a.to_array().into_iter().zip(b.to_array());
    pairs
        .zip(bounds)
        .map(|((a, b), bounds)| 2.0 * (a - b).abs() / (bounds.max - bounds.min))
        .fold(0.0, f64::max)
}

#[test]
fn the_file_is_of_this_flight() {
    let mut lines = FLIGHTS.lines();
    let held = format!(
        "held phi={} delta_e={} delta_c=0.0",
        INPUT.phi, INPUT.delta_e
    );
    let comment = lines.next().expect("a comment");
    assert!(comment.contains(&held) && comment.contains(&format!("{END} s")));
    let names = lines.next().expect("the columns").split(',').skip(2);
    assert!(names.eq(State::NAMES));
}

type Step = fn(&Flight, f64, &mut State) -> Result<(), StepError<f64>>;

/// A method with a fixed step.
struct Stepper {
    name: &'static str,
    order: f64,
    step: Step,
    /// Least number of steps for each set: where the error begins to fall as a power.
    from: [u32; 2],
    /// Number of steps after which no more than the reference's own error is left; of order 1 and 2 it would take days.
    tight: Option<u32>,
}

const fn stepper(
    name: &'static str,
    order: f64,
    step: Step,
    from: [u32; 2],
    tight: Option<u32>,
) -> Stepper {
    Stepper {
        name,
        order,
        step,
        from,
        tight,
    }
}

const STEPPERS: [Stepper; 8] = [
    stepper(
        "Euler",
        1.0,
        |f, dt, x| Euler::new(dt).step(&f.model, x, &INPUT),
        [2000, 16_000],
        None,
    ),
    stepper(
        "Heun",
        2.0,
        |f, dt, x| Heun::new(dt).step(&f.model, x, &INPUT),
        [500, 2000],
        None,
    ),
    stepper(
        "Rk4",
        4.0,
        |f, dt, x| Rk4::new(dt).step(&f.model, x, &INPUT),
        [80, 640],
        Some(40_000),
    ),
    stepper(
        "DormandPrince54",
        5.0,
        |f, dt, x| Fixed::new(DormandPrince54, dt).step(&f.model, x, &INPUT),
        [32, 256],
        Some(6000),
    ),
    stepper(
        "Tsit5",
        5.0,
        |f, dt, x| Fixed::new(Tsit5, dt).step(&f.model, x, &INPUT),
        [34, 128],
        Some(4000),
    ),
    stepper(
        "DormandPrince853",
        8.0,
        |f, dt, x| Fixed::new(DormandPrince853, dt).step(&f.model, x, &INPUT),
        [12, 72],
        Some(500),
    ),
    stepper(
        "Rodas4",
        4.0,
        |f, dt, x| Fixed::new(Rodas4, dt).step(&f.model, x, &INPUT),
        [40, 160],
        Some(20_000),
    ),
    stepper(
        "Exponential",
        4.0,
        |f, dt, x| Exponential::new(dt, f.modes).step(&f.model, x, &INPUT),
        [64, 64],
        Some(4000),
    ),
];

fn fly(flight: &Flight, step: Step, steps: u32) -> State {
    let grid = TimeGrid::new(0.0, END, END / f64::from(steps)).expect("few steps");
    let mut progress = Progress::new(0.0, flight.start);
    while grid
        .step(&mut progress, |x, _, dt| step(flight, dt, x))
        .expect("the flight stays finite")
    {}
    progress.state
}

/// With a tolerance relative to a component and to its half width in the validity box.
fn fly_adaptively<S: Method<Model>>(flight: &Flight, method: S, tolerance: f64) -> State {
    let input = Constant(INPUT);
    let bounds = dcom::STATE_BOUNDS.to_array();
    let absolute = bounds.map(|bounds| 0.5 * tolerance * (bounds.max - bounds.min));
    let mut progress = Progress::new(0.0, flight.start);
    Adaptive::new(method, tolerance, State::from_array(absolute))
        .run(
            &Problem::new(&flight.model, &input),
            &mut progress,
            END,
            &mut (),
        )
        .expect("the flight stays finite");
    progress.state
}

/// SciPy's two ends differ by so much at most, 1e-13 when this was written: nothing can be told below.
const ATTAINABLE: f64 = 2e-13;
/// What the methods have to meet.
const MET: f64 = 1e-12;

#[test]
fn scipys_solvers_agree() {
    for flight in flights() {
        let apart = distance(&flight.explicit, &flight.implicit);
        println!("DOP853 and Radau are {apart:.1e} apart");
        assert!(apart < ATTAINABLE, "{apart:e}");
    }
}

#[test]
fn short_steps_meet_scipy() {
    for flight in flights() {
        for Stepper {
            name, step, tight, ..
        } in STEPPERS
        {
            let Some(steps) = tight else { continue };
            let error = distance(&fly(&flight, step, steps), &flight.explicit);
            println!("{name}, {steps} steps: {error:.1e}");
            assert!(error < MET, "{name}: {error:e}");
        }
    }
}

#[test]
fn tight_tolerances_meet_scipy() {
    for flight in flights() {
        for (name, end) in [
            (
                "DormandPrince54",
                fly_adaptively(&flight, DormandPrince54, 1e-14),
            ),
            ("Tsit5", fly_adaptively(&flight, Tsit5, 1e-14)),
            (
                "DormandPrince853",
                fly_adaptively(&flight, DormandPrince853, 1e-14),
            ),
            ("Rodas4", fly_adaptively(&flight, Rodas4, 1e-14)),
        ] {
            let error = distance(&end, &flight.explicit);
            println!("{name}: {error:.1e}");
            assert!(error < MET, "{name}: {error:e}");
        }
    }
}

#[test]
fn the_orders_show_against_scipy() {
    for (set, flight) in flights().iter().enumerate() {
        for stepper in STEPPERS {
            let points: Vec<(f64, f64)> = (0..5)
                .map(|i| {
                    let steps = f64::from(stepper.from[set]) * 2.0_f64.powf(f64::from(i) / 2.0);
                    let end = fly(flight, stepper.step, steps.round() as u32);
                    (END / steps.round(), distance(&end, &flight.explicit))
                })
                .collect();
            let excess = observed_order(&points) - stepper.order;
            println!("{}: {:.2}", stepper.name, stepper.order + excess);
            // More is no fault: terms of a higher order are still felt where those of the order itself are small.
            assert!(
                (-0.15..0.5).contains(&excess),
                "{}: {excess} {points:?}",
                stepper.name
            );
        }
    }
}
