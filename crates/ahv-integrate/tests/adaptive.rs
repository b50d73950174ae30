//! Control of the step size, dense output, events.
#![forbid(unsafe_code)]

mod common;

use std::cell::Cell;

use ahv_core::{Model, Vector};
use ahv_integrate::{
    Adaptive, ComponentLimit, Constant, Crossing, Dense, DormandPrince54, DormandPrince853, Ending,
    Event, Located, Method, Observer, Problem, Progress, Rodas4, Tsit5, When,
};
use ahv_models::{dcom, flexible_mode};
use approx::assert_relative_eq;
use common::vector;

vector!(Rigid, height, speed);

type ModeState = flexible_mode::State<f64>;
type ModeModel = flexible_mode::Model<f64>;

const FREE: flexible_mode::Input<f64> = flexible_mode::Input { force: 0.0 };
const PLUCKED: ModeState = ModeState {
    eta: 1.0,
    eta_dot: 0.0,
    chi: 0.0,
};

fn mode() -> ModeModel {
    flexible_mode::Model::new(&flexible_mode::NOMINAL)
}

fn exact(time: f64) -> ModeState {
    flexible_mode::response_underdamped(&PLUCKED, &FREE, &mode().prepared, time)
}

fn tolerance(size: f64) -> ModeState {
    ModeState {
        eta: size,
        eta_dot: 20.0 * size,
        chi: size,
    }
}

/// Greatest error of the dense output over a run.
struct Watch {
    worst: f64,
    end: f64,
}

impl Observer<ModeState> for Watch {
    fn accepted(&mut self, step: &Dense<ModeState>) {
        assert_eq!(step.start(), self.end, "steps join");
        self.end = step.end();
        for part in [0.0, 0.25, 0.5, 0.8, 1.0] {
            let time = step.start() + part * (step.end() - step.start());
            self.worst = self.worst.max((step.at(time).eta - exact(time).eta).abs());
        }
    }
}

fn follow<S: Method<ModeModel>>(method: S, size: f64) -> (f64, u32) {
    let (model, input) = (mode(), Constant(FREE));
    let mut progress = Progress::new(0.0, PLUCKED);
    let mut watch = Watch {
        worst: 0.0,
        end: 0.0,
    };
    let ending = Adaptive::new(method, size, tolerance(size))
        .run(
            &Problem::new(&model, &input),
            &mut progress,
            1.0,
            &mut watch,
        )
        .expect("a linear mode");
    assert_eq!((ending, progress.time), (Ending::Time, 1.0));
    assert_eq!(watch.end, 1.0);
    (watch.worst, progress.accepted)
}

#[test]
fn errors_and_steps_follow_the_tolerance() {
    let check = |name: &str, order: f64, run: &dyn Fn(f64) -> (f64, u32)| {
        let loose = run(1e-5);
        let tight = run(1e-10);
        assert!(
            loose.0 < 3e-4 && tight.0 < 3e-9,
            "{name}: {loose:?}, {tight:?}"
        );
        assert!(
            tight.0 > 1e-13,
            "{name}: {tight:?} is more than was asked for"
        );
        let growth = f64::from(tight.1) / f64::from(loose.1);
        let ideal = 1e5_f64.powf(1.0 / order);
        assert!(growth < 1.5 * ideal, "{name}: {growth} times the steps");
    };
    check("DormandPrince54", 5.0, &|size| {
        follow(DormandPrince54, size)
    });
    check("Tsit5", 5.0, &|size| follow(Tsit5, size));
    check("DormandPrince853", 8.0, &|size| {
        follow(DormandPrince853, size)
    });
    check("Rodas4", 4.0, &|size| follow(Rodas4, size));
}

/// Where the plucked mode first passes zero.
fn first_zero() -> f64 {
    let p = flexible_mode::NOMINAL;
    let damped = p.omega * (1.0 - p.zeta * p.zeta).sqrt();
    (std::f64::consts::PI - p.zeta.acos()) / damped
}

#[test]
fn an_event_is_located_to_a_tenth_of_a_nanosecond() {
    fn check<S: Method<ModeModel>>(method: S) {
        let (model, input) = (mode(), Constant(FREE));
        let zero = When::new("zero", Crossing::Falling, |_, x: &ModeState| x.eta);
        let events: [&dyn Event<ModeModel>; 1] = [&zero];
        let problem = Problem::new(&model, &input).events(&events);
        let mut progress = Progress::new(0.0, PLUCKED);
        let ending = Adaptive::new(method, 1e-12, tolerance(1e-12))
            .run(&problem, &mut progress, 1.0, &mut ())
            .expect("the mode passes zero");
        let Ending::Event(Located {
            index: 0,
            name: "zero",
            time,
            state,
        }) = ending
        else {
            panic!("{ending:?}");
        };
        assert!(
            (time - first_zero()).abs() < 1e-10,
            "{time}, not {}",
            first_zero()
        );
        assert_eq!((progress.time, progress.state), (time, state));
        assert!(state.eta.abs() < 1e-12);
        // Going on, it does not meet the same zero again; it ends with the next, a period later.
        let ending = Adaptive::new(DormandPrince54, 1e-12, tolerance(1e-12))
            .run(&problem, &mut progress, 1.0, &mut ())
            .expect("the mode goes on");
        let period = 2.0 * std::f64::consts::PI / (19.7437 * 0.51_f64.sqrt());
        let Ending::Event(Located { time, .. }) = ending else {
            panic!("{ending:?}");
        };
        assert!((time - first_zero() - period).abs() < 1e-8, "{time}");
    }
    check(DormandPrince54);
    check(Tsit5);
    check(DormandPrince853);
    check(Rodas4);
}

#[derive(Default)]
struct Log(Vec<(&'static str, f64)>);

impl<X> Observer<X> for Log {
    const DENSE: bool = false;

    fn event(&mut self, event: &Located<X>) {
        self.0.push((event.name, event.time));
    }
}

#[test]
fn events_that_do_not_end_the_run_are_reported() {
    let (model, input) = (mode(), Constant(FREE));
    let falling = When::new("falling", Crossing::Falling, |_, x: &ModeState| x.eta).only_reported();
    let rising = When::new("rising", Crossing::Rising, |_, x: &ModeState| x.eta).only_reported();
    let either = When::new("either", Crossing::Either, |_, x: &ModeState| x.eta).only_reported();
    let end = When::new("end", Crossing::Rising, |time, _: &ModeState| time - 0.6);
    let events: [&dyn Event<ModeModel>; 4] = [&falling, &rising, &either, &end];
    let problem = Problem::new(&model, &input).events(&events);
    let (mut progress, mut log) = (Progress::new(0.0, PLUCKED), Log::default());
    let ending = Adaptive::new(Tsit5, 1e-10, tolerance(1e-12))
        .run(&problem, &mut progress, 1.0, &mut log)
        .expect("a linear mode");
    let Ending::Event(Located { index: 3, time, .. }) = ending else {
        panic!("{ending:?}");
    };
    assert_relative_eq!(time, 0.6, epsilon = 1e-12);
    let half = std::f64::consts::PI / (19.7437 * 0.51_f64.sqrt());
    let mut expected = Vec::new();
    for (count, name) in ["falling", "rising", "falling"].into_iter().enumerate() {
        let time = first_zero() + half * count as f64;
        if time < 0.6 {
            expected.extend([(name, time), ("either", time)]);
        }
    }
    assert_eq!(log.0.len(), expected.len(), "{:?}", log.0);
    for ((name, time), (expected_name, expected_time)) in log.0.iter().zip(&expected) {
        assert_eq!(name, expected_name);
        assert_relative_eq!(time, expected_time, epsilon = 1e-8);
    }
}

/// x'' = u: what leaves a height and comes back within one step.
struct Thrown;

impl Model for Thrown {
    type Scalar = f64;
    type State = Rigid<f64>;
    type Input = Rigid<f64>;

    fn drift(&self, x: &Rigid<f64>, u: &Rigid<f64>) -> Rigid<f64> {
        Rigid {
            height: x.speed,
            speed: u.speed,
        }
    }
}

#[test]
fn two_passages_in_one_long_step_are_both_found() {
    let input = Constant(Rigid {
        height: 0.0,
        speed: -10.0,
    });
    let above = When::new("height", Crossing::Either, |_, x: &Rigid<f64>| {
        x.height - 3.2
    });
    let above = above.only_reported();
    let events: [&dyn Event<Thrown>; 1] = [&above];
    let problem = Problem::new(&Thrown, &input).events(&events);
    let mut progress = Progress::new(
        0.0,
        Rigid {
            height: 0.0,
            speed: 10.0,
        },
    );
    progress.step = Some(2.0);
    let mut log = Log::default();
    Adaptive::new(
        DormandPrince54,
        1e-9,
        Rigid {
            height: 1e-9,
            speed: 1e-9,
        },
    )
    .run(&problem, &mut progress, 2.0, &mut log)
    .expect("a parabola");
    assert_eq!(
        (progress.accepted, log.0.len()),
        (1, 2),
        "{log:?}",
        log = log.0
    );
    assert_relative_eq!(log.0[0].1, 0.4, epsilon = 1e-12);
    assert_relative_eq!(log.0[1].1, 1.6, epsilon = 1e-12);
}

/// Regula falsi finds the zero of a line at once and that of a curve in a few rounds, where bisection takes fifty.
#[test]
fn an_event_takes_few_evaluations() {
    for (slope, time, most) in [(0.0, 0.32, 12), (-10.0, 0.4, 20)] {
        let evaluations = Cell::new(0);
        let above = When::new("height", Crossing::Rising, |_, x: &Rigid<f64>| {
            evaluations.set(evaluations.get() + 1);
            x.height - 3.2
        });
        let events: [&dyn Event<Thrown>; 1] = [&above];
        let input = Constant(Rigid {
            height: 0.0,
            speed: slope,
        });
        let problem = Problem::new(&Thrown, &input).events(&events);
        let mut progress = Progress::new(
            0.0,
            Rigid {
                height: 0.0,
                speed: 10.0,
            },
        );
        progress.step = Some(2.0);
        let absolute = Rigid {
            height: 1e-9,
            speed: 1e-9,
        };
        Adaptive::new(DormandPrince54, 1e-9, absolute)
            .run(&problem, &mut progress, 2.0, &mut ())
            .expect("a parabola");
        assert_relative_eq!(progress.time, time, epsilon = 1e-12);
        assert!(evaluations.get() <= most, "{}", evaluations.get());
    }
}

/// A height of ½ t² passes 3.2 at √6.4 s after the start, wherever on the clock that is.
#[test]
fn an_event_is_located_before_time_0_and_at_it() {
    let after = 6.4_f64.sqrt();
    for start in [-3.0, -after, -1.0, 5.0] {
        let above = When::new("height", Crossing::Rising, |_, x: &Rigid<f64>| {
            x.height - 3.2
        });
        let events: [&dyn Event<Thrown>; 1] = [&above];
        let input = Constant(Rigid {
            height: 0.0,
            speed: 1.0,
        });
        let problem = Problem::new(&Thrown, &input).events(&events);
        let mut progress = Progress::new(
            start,
            Rigid {
                height: 0.0,
                speed: 0.0,
            },
        );
        progress.step = Some(4.0);
        let ending = Adaptive::new(
            DormandPrince54,
            1e-9,
            Rigid {
                height: 1e-9,
                speed: 1e-9,
            },
        )
        .run(&problem, &mut progress, start + 4.0, &mut ())
        .expect("a parabola");
        assert!(matches!(ending, Ending::Event(_)), "{start}: {ending:?}");
        assert_relative_eq!(progress.time, start + after, epsilon = 1e-14);
    }
}

/// A dive with the limits that a flight has.
#[test]
fn a_flight_ends_at_its_first_limit() {
    let model = dcom::Model::new(&dcom::NOMINAL);
    let input = Constant(dcom::Input {
        phi: 0.2821,
        delta_e: 0.2286,
        delta_c: 0.0,
    });
    let start = dcom::State {
        velocity: 7702.0808,
        altitude: 85_000.0,
        gamma: -0.05,
        alpha: 0.0262,
        eta_1: 0.6,
        ..dcom::State::splat(0.0)
    };
    let prepared = model.prepared;
    let held = input.0;
    let floor =
        |limit| ComponentLimit::at_least::<dcom::Model<f64>>("altitude floor", "altitude", limit);
    let incidence =
        |limit| ComponentLimit::at_most::<dcom::Model<f64>>("angle of attack", "alpha", limit);
    let pressure = |limit: f64| {
        When::limit("dynamic pressure", move |_, x: &dcom::State<f64>| {
            limit - dcom::dynamic_pressure(x, &held, &prepared)
        })
    };
    let fly = |floor_limit: f64, pressure_limit: f64, incidence_limit: f64| {
        let floor = floor(floor_limit).expect("there is an altitude");
        let incidence = incidence(incidence_limit).expect("there is an angle of attack");
        let pressure = pressure(pressure_limit);
        let events: [&dyn Event<dcom::Model<f64>>; 3] = [&floor, &incidence, &pressure];
        let mut progress = Progress::new(0.0, start);
        let mut absolute = dcom::State::splat(1e-11);
        (absolute.velocity, absolute.altitude) = (1e-7, 1e-7);
        let ending = Adaptive::new(Tsit5, 1e-12, absolute)
            .run(
                &Problem::new(&model, &input).events(&events),
                &mut progress,
                3.0,
                &mut (),
            )
            .expect("a short dive");
        match ending {
            Ending::Event(event) => event,
            Ending::Time => panic!("no limit was met: {progress:?}"),
        }
    };
    let event = fly(84_500.0, 2.5e3, 0.1);
    assert_eq!(event.name, "altitude floor");
    assert_relative_eq!(event.state.altitude, 84_500.0, epsilon = 1e-7);
    let event = fly(80_000.0, 2020.0, 0.1);
    assert_eq!(event.name, "dynamic pressure");
    let met = dcom::dynamic_pressure(&event.state, &held, &prepared);
    assert_relative_eq!(met, 2020.0, epsilon = 1e-8);
    let event = fly(80_000.0, 2.5e3, 0.0275);
    assert_eq!(event.name, "angle of attack");
    assert_relative_eq!(event.state.alpha, 0.0275, epsilon = 1e-11);
    assert!(ComponentLimit::at_least::<dcom::Model<f64>>("floor", "height", 0.0).is_none());
}

/// f32 states are stepped by the same code.
#[test]
fn single_precision_works() {
    let parameters = flexible_mode::NOMINAL.map_into(|value| value as f32);
    let model = flexible_mode::Model::new(&parameters);
    let input = Constant(flexible_mode::Input { force: 0.0_f32 });
    let plucked = PLUCKED.map_into(|value| value as f32);
    for stiff in [false, true] {
        let mut progress = Progress::new(0.0, plucked);
        let absolute = flexible_mode::State::splat(1e-5_f32);
        let problem = Problem::new(&model, &input);
        let ending = if stiff {
            Adaptive::new(Rodas4, 1e-4, absolute).run(&problem, &mut progress, 0.2, &mut ())
        } else {
            Adaptive::new(Tsit5, 1e-4, absolute).run(&problem, &mut progress, 0.2, &mut ())
        };
        assert_eq!(ending, Ok(Ending::Time));
        assert_relative_eq!(
            f64::from(progress.state.eta),
            exact(0.2).eta,
            epsilon = 1e-3
        );
    }
}
