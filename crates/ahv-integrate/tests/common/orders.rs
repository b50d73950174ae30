//! The table of the orders of convergence, measured.

use std::fmt::Write;

use ahv_integrate::{
    Constant, DormandPrince54, DormandPrince853, Euler, Exponential, Fixed, FlexibleMode, Heun,
    Method, Rk4, Rodas4, Start, StepError, Tsit5,
};
use ahv_models::{dcom, flexible_mode};

use super::observed_order;

type ModeState = flexible_mode::State<f64>;
type Flight = dcom::State<f64>;
type DenseError = fn(f64) -> f64;

/// A method with a fixed step on the two problems: the linear mode (closed form) and DCOM (fine reference).
struct Stepper {
    name: &'static str,
    order: u8,
    mode: fn(f64, &mut ModeState) -> Result<(), StepError<f64>>,
    flight: fn(f64, &mut Flight) -> Result<(), StepError<f64>>,
    /// Least numbers of steps on the two problems: where the error begins to fall as a power.
    from: [u32; 2],
    /// Order of the dense output, the longest step in s on which it is measured, and its error within one step of a size in s.
    dense: Option<(u8, f64, DenseError)>,
}

pub(crate) const FORCE: flexible_mode::Input<f64> = flexible_mode::Input { force: 300.0 };
pub(crate) const MODE_START: ModeState = ModeState {
    eta: 0.5,
    eta_dot: -10.0,
    chi: 0.3,
};

/// Near level flight with the modes of the set 5.1 displaced, so that they ring.
pub(crate) const FLIGHT_START: Flight = Flight {
    velocity: 7702.0808,
    altitude: 85_000.0,
    gamma: 0.002,
    alpha: 0.0262,
    pitch_rate: 0.01,
    eta_1: 0.5,
    eta_dot_1: 0.0,
    eta_2: -0.8,
    eta_dot_2: 20.0,
    eta_3: 0.6,
    eta_dot_3: 0.0,
};
pub(crate) const FLIGHT_INPUT: dcom::Input<f64> = dcom::Input {
    phi: 0.2821,
    delta_e: 0.2286,
    delta_c: 0.0,
};
const MODE_END: f64 = 0.4;
const FLIGHT_END: f64 = 0.4;

pub(crate) fn mode() -> flexible_mode::Model<f64> {
    flexible_mode::Model::new(&flexible_mode::NOMINAL)
}

pub(crate) fn flight() -> dcom::Model<f64> {
    dcom::Model::new(&dcom::NOMINAL)
}

fn steppers() -> [Stepper; 9] {
    [
        Stepper {
            name: "`Euler`",
            order: 1,
            mode: |dt, x| Euler::new(dt).step(&mode(), x, &FORCE),
            flight: |dt, x| Euler::new(dt).step(&flight(), x, &FLIGHT_INPUT),
            from: [1024, 2048],
            dense: None,
        },
        Stepper {
            name: "`Heun`",
            order: 2,
            mode: |dt, x| Heun::new(dt).step(&mode(), x, &FORCE),
            flight: |dt, x| Heun::new(dt).step(&flight(), x, &FLIGHT_INPUT),
            from: [256, 512],
            dense: None,
        },
        Stepper {
            name: "`Rk4`",
            order: 4,
            mode: |dt, x| Rk4::new(dt).step(&mode(), x, &FORCE),
            flight: |dt, x| Rk4::new(dt).step(&flight(), x, &FLIGHT_INPUT),
            from: [32, 128],
            dense: None,
        },
        Stepper {
            name: "`DormandPrince54`",
            order: 5,
            mode: |dt, x| Fixed::new(DormandPrince54, dt).step(&mode(), x, &FORCE),
            flight: |dt, x| Fixed::new(DormandPrince54, dt).step(&flight(), x, &FLIGHT_INPUT),
            from: [32, 40],
            dense: Some((4, 0.0125, |dt| dense_error(&DormandPrince54, dt))),
        },
        Stepper {
            name: "`Tsit5`",
            order: 5,
            mode: |dt, x| Fixed::new(Tsit5, dt).step(&mode(), x, &FORCE),
            flight: |dt, x| Fixed::new(Tsit5, dt).step(&flight(), x, &FLIGHT_INPUT),
            from: [48, 40],
            dense: Some((4, 0.0125, |dt| dense_error(&Tsit5, dt))),
        },
        Stepper {
            name: "`DormandPrince853`",
            order: 8,
            mode: |dt, x| Fixed::new(DormandPrince853, dt).step(&mode(), x, &FORCE),
            flight: |dt, x| Fixed::new(DormandPrince853, dt).step(&flight(), x, &FLIGHT_INPUT),
            from: [6, 12],
            dense: Some((7, 0.1, |dt| dense_error(&DormandPrince853, dt))),
        },
        Stepper {
            name: "`Rodas4`",
            order: 4,
            mode: |dt, x| Fixed::new(Rodas4, dt).step(&mode(), x, &FORCE),
            flight: |dt, x| Fixed::new(Rodas4, dt).step(&flight(), x, &FLIGHT_INPUT),
            from: [48, 64],
            dense: Some((3, 0.0125, |dt| dense_error(&Rodas4, dt))),
        },
        Stepper {
            name: "`Exponential`",
            order: 4,
            mode: |dt, x| Exponential::new(dt, [linear_mode()]).step(&mode(), x, &FORCE),
            flight: |dt, x| Exponential::new(dt, flight_modes()).step(&flight(), x, &FLIGHT_INPUT),
            from: [16, 48],
            dense: None,
        },
        Stepper {
            name: "`Exponential` with the modes of another set",
            order: 4,
            mode: |dt, x| Exponential::new(dt, [other_mode()]).step(&mode(), x, &FORCE),
            flight: |dt, x| Exponential::new(dt, other_modes()).step(&flight(), x, &FLIGHT_INPUT),
            from: [48, 128],
            dense: None,
        },
    ]
}

fn linear_mode() -> FlexibleMode {
    let p = flexible_mode::NOMINAL;
    FlexibleMode::new::<flexible_mode::Model<f64>>("eta", "eta_dot", p.omega, p.zeta)
        .expect("the model has these states")
}

/// A mode with the frequency and damping of set 5.3.
fn other_mode() -> FlexibleMode {
    let p = dcom::SECTION5_3;
    FlexibleMode::new::<flexible_mode::Model<f64>>("eta", "eta_dot", p.omega_1, p.zeta_1)
        .expect("the model has these states")
}

pub(crate) fn flight_modes() -> [FlexibleMode; 3] {
    modes_of(&dcom::NOMINAL)
}

fn other_modes() -> [FlexibleMode; 3] {
    modes_of(&dcom::SECTION5_3)
}

fn modes_of(p: &dcom::Parameters<f64>) -> [FlexibleMode; 3] {
    let mode = |position, rate, omega, zeta| {
        FlexibleMode::new::<dcom::Model<f64>>(position, rate, omega, zeta)
            .expect("the model has these states")
    };
    [
        mode("eta_1", "eta_dot_1", p.omega_1, p.zeta_1),
        mode("eta_2", "eta_dot_2", p.omega_2, p.zeta_2),
        mode("eta_3", "eta_dot_3", p.omega_3, p.zeta_3),
    ]
}

/// η and η̇/ω count; χ, which the exponential method steps as a rigid state, does not.
fn mode_distance(a: &ModeState, b: &ModeState) -> f64 {
    let omega = flexible_mode::NOMINAL.omega;
    (a.eta - b.eta).hypot((a.eta_dot - b.eta_dot) / omega)
}

/// Greatest difference in units of the half width of the validity box.
pub(crate) fn flight_distance(a: &Flight, b: &Flight) -> f64 {
    let bounds = dcom::STATE_BOUNDS.to_array();
    let pairs = a.to_array().into_iter().zip(b.to_array());
    pairs
        .zip(bounds)
        .map(|((a, b), bounds)| 2.0 * (a - b).abs() / (bounds.max - bounds.min))
        .fold(0.0, f64::max)
}

fn integrate<X: Copy>(
    step: fn(f64, &mut X) -> Result<(), StepError<f64>>,
    start: X,
    end: f64,
    steps: u32,
) -> X {
    let mut x = start;
    for _ in 0..steps {
        step(end / f64::from(steps), &mut x).expect("the motion stays finite");
    }
    x
}

/// Eight numbers of steps, each the fourth root of 2 times the one before.
fn steps_from(first: u32) -> [u32; 8] {
    std::array::from_fn(|i| (f64::from(first) * 2.0_f64.powf(i as f64 / 4.0)).round() as u32)
}

fn order(first: u32, end: f64, error: impl Fn(u32) -> f64) -> f64 {
    let points = steps_from(first).map(|steps| (end / f64::from(steps), error(steps)));
    observed_order(&points)
}

/// Greatest error of the dense output within one step from the exact state.
fn dense_error(method: &impl Method<flexible_mode::Model<f64>>, dt: f64) -> f64 {
    let model = mode();
    let start = Start {
        time: 0.0,
        state: MODE_START,
        slope: None,
    };
    let input = Constant(FORCE);
    let mut attempt = method.attempt(&model, &input, &start, dt);
    let dense = method.dense(&model, &input, &mut attempt);
    [0.2, 0.35, 0.5, 0.65, 0.8]
        .map(|part| mode_distance(&dense.at(part * dt), &exact_mode(part * dt)))
        .into_iter()
        .fold(0.0, f64::max)
}

pub(crate) fn exact_mode(time: f64) -> ModeState {
    flexible_mode::response_underdamped(&MODE_START, &FORCE, &mode().prepared, time)
}

/// Observed orders of one method.
pub(crate) struct Observed {
    pub(crate) name: &'static str,
    pub(crate) order: u8,
    /// None where the error is rounding alone.
    pub(crate) mode: Option<f64>,
    pub(crate) flight: f64,
    pub(crate) dense: Option<(u8, f64)>,
}

/// Measures every method.
pub(crate) fn observed() -> Vec<Observed> {
    let fine = |dt: f64, x: &mut Flight| Fixed::new(Tsit5, dt).step(&flight(), x, &FLIGHT_INPUT);
    let reference = integrate(fine, FLIGHT_START, FLIGHT_END, 8192);
    let exact = exact_mode(MODE_END);
    let measure = |stepper: Stepper| {
        let mode_error = |steps| {
            let end = integrate(stepper.mode, MODE_START, MODE_END, steps);
            mode_distance(&end, &exact)
        };
        let flight_error = |steps| {
            let end = integrate(stepper.flight, FLIGHT_START, FLIGHT_END, steps);
            flight_distance(&end, &reference)
        };
        let exactly = mode_error(stepper.from[0]) < 1e-13;
        let within = |longest: f64, error: DenseError| {
            let points = steps_from(8).map(|parts| 8.0 * longest / f64::from(parts));
            // The error of one step falls one power faster than that of a run.
            observed_order(&points.map(|dt| (dt, error(dt)))) - 1.0
        };
        Observed {
            name: stepper.name,
            order: stepper.order,
            mode: (!exactly).then(|| order(stepper.from[0], MODE_END, mode_error)),
            flight: order(stepper.from[1], FLIGHT_END, flight_error),
            dense: stepper
                .dense
                .map(|(order, longest, error)| (order, within(longest, error))),
        }
    };
    steppers().into_iter().map(measure).collect()
}

/// The table in Markdown.
pub(crate) fn table(rows: &[Observed]) -> String {
    let mut text = String::from(
        "| method | order | linear mode | DCOM | dense output, order | linear mode |\n|---|---|---|---|---|---|\n",
    );
    for row in rows {
        let mode = row
            .mode
            .map_or_else(|| "exact".into(), |order| format!("{order:.2}"));
        let (dense, within) = row.dense.map_or_else(
            || (String::new(), String::new()),
            |(order, observed)| (order.to_string(), format!("{observed:.2}")),
        );
        writeln!(
            text,
            "| {} | {} | {mode} | {:.2} | {dense} | {within} |",
            row.name, row.order, row.flight
        )
        .expect("a string takes all that is written");
    }
    text
}
