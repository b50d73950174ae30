//! Failures are typed, and leave the last good state.
#![forbid(unsafe_code)]

#[path = "common/blow_up.rs"]
mod blow_up;
mod common;
#[path = "common/random.rs"]
mod random;

use ahv_core::{Bounds, DifferentiableModel, Model, Outside, Vector, first_outside};
use ahv_integrate::{
    Adaptive, Constant, Crossing, DormandPrince54, DormandPrince853, Ending, Event, Failure,
    Leaving, Method, Observer, Problem, Progress, Rodas4, Tsit5, When, Within,
};
use ahv_models::{com, com_rigid, dcom, sdcom};
use blow_up::{BlowUp, ONE, State};
use random::Random;

const HELD: Constant<State<f64>> = Constant(ONE);
const ABSOLUTE: State<f64> = State {
    size: 1e-9,
    time: 1e-9,
};

fn solver<S>(method: S) -> Adaptive<S, State<f64>> {
    Adaptive::new(method, 1e-9, ABSOLUTE)
}

#[test]
fn a_pole_is_a_failure_at_its_time() {
    let mut progress = Progress::new(0.0, ONE);
    let failure = solver(Tsit5)
        .run(&Problem::new(&BlowUp, &HELD), &mut progress, 2.0, &mut ())
        .expect_err("there is no solution beyond 1 s");
    let (time, name) = match failure {
        Failure::StepUnderflow { time, name, .. } | Failure::NonFinite { time, name, .. } => {
            (time, name)
        }
        other => panic!("{other}"),
    };
    assert!((time - 1.0).abs() < 1e-6, "{failure}");
    assert_eq!(name, "size");
    assert_eq!(progress.time, time);
    assert!(progress.state.size.is_finite() && progress.state.size > 1e6);
    assert!(failure.to_string().contains("size"), "{failure}");
}

#[test]
fn a_state_that_is_not_finite_is_named() {
    let mut progress = Progress::new(
        3.0,
        State {
            size: 1e200,
            time: 0.0,
        },
    );
    let before = progress;
    let failure =
        solver(DormandPrince54).run(&Problem::new(&BlowUp, &HELD), &mut progress, 4.0, &mut ());
    let expected = Failure::NonFinite {
        time: 3.0,
        name: "size",
        value: f64::INFINITY,
    };
    assert_eq!(failure, Err(expected));
    assert_eq!(progress, before);
}

#[test]
fn too_many_steps_are_a_failure_that_can_be_gone_on_from() {
    let mut progress = Progress::new(0.0, ONE);
    let few = solver(DormandPrince54).most_steps(5);
    let problem = Problem::new(&BlowUp, &HELD);
    let failure = few.run(&problem, &mut progress, 0.9, &mut ());
    let expected = Failure::TooManySteps {
        time: progress.time,
        steps: 5,
    };
    assert_eq!(failure, Err(expected));
    assert!(progress.time > 0.0 && progress.accepted > 0);
    let ending = solver(DormandPrince54).run(&problem, &mut progress, 0.9, &mut ());
    assert_eq!(ending, Ok(Ending::Time));
    assert!((progress.state.size - 10.0).abs() < 1e-5, "{progress:?}");
}

#[test]
fn settings_that_make_no_sense_are_refused() {
    let problem = Problem::new(&BlowUp, &HELD);
    let mut progress = Progress::new(0.0, ONE);
    let mut refused = |solver: Adaptive<Tsit5, State<f64>>, end: f64, expected: &str| match solver
        .run(&problem, &mut progress, end, &mut ())
    {
        Err(Failure::Setting { name, .. }) => assert_eq!(name, expected),
        other => panic!("{other:?}"),
    };
    refused(
        Adaptive::new(Tsit5, 0.0, ABSOLUTE),
        1.0,
        "relative tolerance",
    );
    refused(
        Adaptive::new(Tsit5, f64::NAN, ABSOLUTE),
        1.0,
        "relative tolerance",
    );
    let none = State {
        size: 1e-9,
        time: 0.0,
    };
    refused(Adaptive::new(Tsit5, 1e-9, none), 1.0, "absolute tolerance");
    refused(solver(Tsit5).longest_step(-1.0), 1.0, "longest step");
    refused(solver(Tsit5), -1.0, "end");
    refused(solver(Tsit5), f64::NAN, "end");
    progress.step = Some(f64::NAN);
    let result = solver(Tsit5).run(&problem, &mut progress, 1.0, &mut ());
    assert!(matches!(result, Err(Failure::Setting { name: "step", .. })));
}

#[test]
fn an_event_that_cannot_be_bracketed_is_a_failure() {
    let mut progress = Progress::new(0.0, ONE);
    let passed = When::limit("ceiling", |_, x: &State<f64>| 0.5 - x.size);
    let events: [&dyn Event<BlowUp>; 1] = [&passed];
    let problem = Problem::new(&BlowUp, &HELD).events(&events);
    let result = solver(Tsit5).run(&problem, &mut progress, 0.5, &mut ());
    let expected = Failure::EventNotBracketed {
        time: 0.0,
        event: "ceiling",
        value: -0.5,
    };
    assert_eq!(result, Err(expected));
    let undefined = When::new("root", Crossing::Falling, |_, x: &State<f64>| {
        (1.5 - x.size).sqrt()
    });
    let events: [&dyn Event<BlowUp>; 1] = [&undefined];
    let problem = Problem::new(&BlowUp, &HELD).events(&events);
    let result = solver(Tsit5).run(&problem, &mut progress, 0.5, &mut ());
    let Err(Failure::EventNotBracketed {
        event: "root",
        value,
        ..
    }) = result
    else {
        panic!("{result:?}");
    };
    assert!(value.is_nan());
    assert!(
        progress.state.size < 1.5,
        "the last good state: {progress:?}"
    );
}

#[derive(Default)]
struct Warnings(Vec<(f64, Outside)>);

impl<X> Observer<X> for Warnings {
    const DENSE: bool = false;

    fn outside(&mut self, time: f64, outside: &Outside) {
        self.0.push((time, *outside));
    }
}

#[test]
fn the_edge_of_the_box_warns_or_stops() {
    let bounds = State {
        size: Bounds::new(0.0, 2.0),
        time: Bounds::new(-1.0, 10.0),
    };
    let problem = |leaving| Problem::new(&BlowUp, &HELD).validity(Within::new(bounds, leaving));
    let (mut progress, mut warnings) = (Progress::new(0.0, ONE), Warnings::default());
    let ending = solver(Tsit5).run(&problem(Leaving::Warn), &mut progress, 0.8, &mut warnings);
    assert_eq!((ending, progress.time), (Ok(Ending::Time), 0.8));
    let [(time, outside)] = warnings.0[..] else {
        panic!("one warning, not {:?}", warnings.0);
    };
    assert!(time > 0.5 && time < 0.8 && outside.name == "size" && outside.value > 2.0);

    let (mut progress, mut warnings) = (Progress::new(0.0, ONE), Warnings::default());
    let failure = solver(Tsit5)
        .run(&problem(Leaving::Stop), &mut progress, 0.8, &mut warnings)
        .expect_err("the box ends at 0.5 s");
    assert!(matches!(failure, Failure::OutsideValidity { outside, .. } if outside.name == "size"));
    assert!(failure.to_string().contains("outside 0..2"), "{failure}");
    assert!(
        progress.state.size <= 2.0 && progress.time <= 0.5,
        "{progress:?}"
    );
    assert!(warnings.0.is_empty());
}

/// From anywhere in the box, inputs and all: a finite state at the end, or a typed failure with the last good state.
fn property<M, B, U, S>(model: &M, states: B, inputs: U, method: S, seed: u64) -> [u32; 2]
where
    M: Model<Scalar = f64>,
    B: Vector<Bounds>,
    U: Vector<Bounds>,
    S: Method<M> + Copy,
{
    let mut random = Random(seed);
    let mut counts = [0, 0];
    for case in 0..40 {
        let start: M::State = random.within(&states);
        let input = Constant(random.within(&inputs));
        let leaving = if case % 2 == 0 {
            Leaving::Stop
        } else {
            Leaving::Warn
        };
        let problem = Problem::new(model, &input).validity(Within::new(states, leaving));
        let absolute = start.map(|value| 1e-6 * (1.0 + value.abs()));
        let mut progress = Progress::new(0.0, start);
        let solver = Adaptive::new(method, 1e-6, absolute).most_steps(2000);
        let result = solver.run(&problem, &mut progress, 5.0, &mut ());
        let found = progress.state.find(|value| !value.is_finite());
        assert!(
            found.is_none(),
            "{found:?} after {:?}",
            result.as_ref().err()
        );
        match result {
            Ok(Ending::Time) => {
                counts[0] += 1;
                assert_eq!(progress.time, 5.0);
            }
            Ok(Ending::Event(_)) => panic!("there are no events"),
            Err(failure) => {
                counts[1] += 1;
                assert!(progress.time < 5.0, "{failure}");
                if leaving == Leaving::Stop {
                    assert!(
                        first_outside(&progress.state, &states).is_none(),
                        "{failure}"
                    );
                } else {
                    assert!(!matches!(failure, Failure::OutsideValidity { .. }));
                }
            }
        }
    }
    counts
}

fn every_method<M, B, U>(model: &M, states: B, inputs: U)
where
    M: DifferentiableModel<Scalar = f64>,
    B: Vector<Bounds>,
    U: Vector<Bounds>,
{
    for [ended, failed] in [
        property(model, states, inputs, DormandPrince54, 1),
        property(model, states, inputs, Tsit5, 2),
        property(model, states, inputs, DormandPrince853, 2),
        property(model, states, inputs, Rodas4, 3),
    ] {
        assert!(
            ended > 0 && failed > 0,
            "{ended} ended, {failed} failed: one side is untested"
        );
    }
}

#[test]
fn from_anywhere_in_the_box_a_run_ends_well_or_with_a_typed_failure() {
    every_method(
        &dcom::Model::new(&dcom::NOMINAL),
        dcom::STATE_BOUNDS,
        dcom::INPUT_BOUNDS,
    );
    every_method(
        &dcom::Model::new(&dcom::SECTION5_3),
        dcom::STATE_BOUNDS,
        dcom::INPUT_BOUNDS,
    );
    every_method(
        &sdcom::Model::new(&sdcom::NOMINAL),
        sdcom::STATE_BOUNDS,
        sdcom::INPUT_BOUNDS,
    );
    every_method(
        &com::Model::new(&com::NOMINAL),
        com::STATE_BOUNDS,
        com::INPUT_BOUNDS,
    );
    every_method(
        &com_rigid::Model::new(&com_rigid::NOMINAL),
        com_rigid::STATE_BOUNDS,
        com_rigid::INPUT_BOUNDS,
    );
}
