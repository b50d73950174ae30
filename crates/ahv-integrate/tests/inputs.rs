//! Constants, samples, feedback and limits.
#![forbid(unsafe_code)]

mod common;

use ahv_core::{Bounds, DifferentiableModel, Model, Outside, Pattern};
use ahv_integrate::{
    Adaptive, Constant, Dense, DormandPrince54, DormandPrince853, Ending, Feedback, Held,
    InputSource, Interpolated, Method, Observer, Problem, Progress, Rodas4, Saturated, Tsit5,
    saturate,
};
use approx::assert_relative_eq;
use common::vector;

vector!(State, level, sum);
vector!(Input, flow);

const DECAY: f64 = 0.8;

/// x' = −a x + u, y' = u.
struct Tank;

impl Model for Tank {
    type Scalar = f64;
    type State = State<f64>;
    type Input = Input<f64>;

    fn drift(&self, x: &State<f64>, u: &Input<f64>) -> State<f64> {
        State {
            level: u.flow - DECAY * x.level,
            sum: u.flow,
        }
    }
}

impl DifferentiableModel for Tank {
    type StateJacobian = State<State<f64>>;
    type InputJacobian = State<Input<f64>>;

    const STATE_JACOBIAN_PATTERN: Pattern<2> = Pattern::new([2, 2], &[[0, 0]]);

    fn jacobians(&self, _: &State<f64>, _: &Input<f64>) -> (State<State<f64>>, State<Input<f64>>) {
        let none = State {
            level: 0.0,
            sum: 0.0,
        };
        let one = Input { flow: 1.0 };
        (
            State {
                level: State {
                    level: -DECAY,
                    ..none
                },
                sum: none,
            },
            State {
                level: one,
                sum: one,
            },
        )
    }
}

const START: State<f64> = State {
    level: 2.0,
    sum: 0.0,
};
const TIMES: [f64; 4] = [0.5, 0.9, 1.7, 2.0];
const FLOWS: [Input<f64>; 4] = [
    Input { flow: 1.0 },
    Input { flow: -3.0 },
    Input { flow: 4.0 },
    Input { flow: 0.5 },
];

fn run<S: Method<Tank>>(
    method: S,
    input: &impl InputSource<Tank>,
    end: f64,
) -> Progress<State<f64>> {
    let mut progress = Progress::new(0.0, START);
    let absolute = State {
        level: 1e-10,
        sum: 1e-10,
    };
    let ending = Adaptive::new(method, 1e-10, absolute)
        .run(&Problem::new(&Tank, input), &mut progress, end, &mut ())
        .expect("a linear tank");
    assert_eq!(ending, Ending::Time);
    assert_eq!(progress.time, end);
    progress
}

/// Piece by piece in closed form: u = u₀ + s t over each piece.
fn exact(pieces: &[(f64, f64, f64)]) -> State<f64> {
    let mut x = START;
    for &(length, u, slope) in pieces {
        // x = c e^{−at} + u/a + s (t/a − 1/a²)
        let particular = |t: f64| (u + slope * t) / DECAY - slope / (DECAY * DECAY);
        let free = x.level - particular(0.0);
        x.level = free * (-DECAY * length).exp() + particular(length);
        x.sum += u * length + 0.5 * slope * length * length;
    }
    x
}

fn assert_all(input: &impl InputSource<Tank>, end: f64, exact: State<f64>) {
    for progress in [
        run(DormandPrince54, input, end),
        run(Tsit5, input, end),
        run(DormandPrince853, input, end),
        run(Rodas4, input, end),
    ] {
        assert_relative_eq!(progress.state.level, exact.level, epsilon = 2e-9);
        assert_relative_eq!(progress.state.sum, exact.sum, epsilon = 2e-9);
        // Jumps are met at step ends, not felt for.
        assert!(progress.refused <= 3, "{progress:?}");
    }
}

#[test]
fn samples_hold() {
    let held = Held::new(&TIMES, &FLOWS).expect("rising times");
    let pieces = [
        (0.9, 1.0, 0.0),
        (0.8, -3.0, 0.0),
        (0.3, 4.0, 0.0),
        (1.0, 0.5, 0.0),
    ];
    assert_all(&held, 3.0, exact(&pieces));
}

#[test]
fn samples_are_joined_by_lines() {
    let lines = Interpolated::new(&TIMES, &FLOWS).expect("rising times");
    let pieces = [
        (0.5, 1.0, 0.0),
        (0.4, 1.0, -10.0),
        (0.8, -3.0, 7.0 / 0.8),
        (0.3, 4.0, -3.5 / 0.3),
        (1.0, 0.5, 0.0),
    ];
    assert_all(&lines, 3.0, exact(&pieces));
}

#[test]
fn a_callback_closes_the_loop() {
    let gain = 1.7;
    let feedback = Feedback(|_, x: &State<f64>| Input {
        flow: -gain * x.level,
    });
    let level = START.level * (-(DECAY + gain) * 1.5_f64).exp();
    let sum = -gain * (START.level - level) / (DECAY + gain);
    for progress in [
        run(DormandPrince54, &feedback, 1.5),
        run(Tsit5, &feedback, 1.5),
        run(DormandPrince853, &feedback, 1.5),
    ] {
        assert_relative_eq!(progress.state.level, level, epsilon = 1e-9);
        assert_relative_eq!(progress.state.sum, sum, epsilon = 1e-9);
    }
}

#[test]
fn samples_that_make_no_sense_are_refused() {
    for times in [
        &[0.0, 1.0, 1.0, 2.0][..],
        &[0.0, 2.0, 1.0, 3.0],
        &[0.0, 1.0, f64::NAN, 3.0],
        &[0.0, 1.0, 2.0, f64::INFINITY],
        &[0.0, 1.0, 2.0],
    ] {
        assert!(Held::new(times, &FLOWS).is_none(), "{times:?}");
        assert!(Interpolated::new(times, &FLOWS).is_none(), "{times:?}");
    }
    assert!(Held::<Input<f64>>::new(&[], &[]).is_none());
}

#[derive(Default)]
struct Log {
    saturated: Vec<(f64, Outside)>,
    steps: usize,
}

impl Observer<State<f64>> for Log {
    fn accepted(&mut self, _: &Dense<State<f64>>) {
        self.steps += 1;
    }

    fn saturated(&mut self, time: f64, command: &Outside) {
        self.saturated.push((time, *command));
    }
}

#[test]
fn a_limit_is_kept_and_reported() {
    let bounds = Bounds::new(-0.5, 0.5);
    let ramp = Feedback(|time, _: &State<f64>| Input { flow: time - 1.0 });
    let limited = Saturated::new(ramp, Input { flow: bounds });
    let (mut progress, mut log) = (Progress::new(0.0, START), Log::default());
    let absolute = State {
        level: 1e-9,
        sum: 1e-9,
    };
    Adaptive::new(Tsit5, 1e-9, absolute)
        .longest_step(0.05)
        .run(&Problem::new(&Tank, &limited), &mut progress, 2.0, &mut log)
        .expect("a linear tank");
    assert_relative_eq!(progress.state.sum, 0.0, epsilon = 1e-7);
    assert!(log.saturated.len() < log.steps + 1 && log.saturated.len() >= log.steps / 2);
    for (time, command) in log.saturated {
        assert_eq!((command.name, command.bounds), ("flow", bounds));
        assert_relative_eq!(command.value, time - 1.0);
        assert!((time - 1.0).abs() >= 0.5);
    }
}

#[test]
fn every_component_beyond_its_limit_is_reported_and_nan_passes() {
    let limits = State {
        level: Bounds::new(0.0, 1.0),
        sum: Bounds::new(-2.0, 2.0),
    };
    let mut names = Vec::new();
    let wild = State {
        level: -3.0,
        sum: f64::INFINITY,
    };
    let held = saturate(&wild, &limits, |outside| names.push(outside.name));
    assert_eq!(
        held,
        State {
            level: 0.0,
            sum: 2.0
        }
    );
    assert_eq!(names, ["level", "sum"]);
    let mut reports = 0;
    let held = saturate(
        &State {
            level: f64::NAN,
            sum: 1.0,
        },
        &limits,
        |_| reports += 1,
    );
    assert!(held.level.is_nan() && held.sum == 1.0 && reports == 1);
}

#[test]
fn a_line_behind_limits_has_no_rate_where_it_is_held_back() {
    let lines = Interpolated::new(&TIMES, &FLOWS).expect("rising times");
    let limited = Saturated::new(
        lines,
        Input {
            flow: Bounds::new(-1.0, 5.0),
        },
    );
    let rate = |since| InputSource::<Tank>::rate(&limited, since, &START);
    assert_eq!(rate(0.0), None);
    assert_relative_eq!(
        rate(0.55).expect("a line").flow,
        -10.0,
        max_relative = 1e-14
    );
    assert_eq!(
        rate(0.9),
        Some(Input { flow: 0.0 }),
        "the command is -3 there"
    );
    let constant = Constant(Input { flow: 1.0 });
    assert_eq!(
        InputSource::<Tank>::next_break(&constant, 0.0),
        f64::INFINITY
    );
    assert_eq!(InputSource::<Tank>::next_break(&limited, 0.9), 1.7);
}
