//! Trims over the whole validity box, beside a scan of it.

use ahv_analysis::trim::{SteadyState, TrimError, trim};
use ahv_core::{Bounds, DifferentiableModel, GeneratedModel, Vector};
use ahv_models::dcom::Canard;
use ahv_models::{com, com_rigid, sdcom};

use crate::common::level;
use crate::dcom_model;

/// Points along each side of the grid over the validity box of velocity and altitude.
const GRID: u32 = 20;

/// Whether there is a level trim inside the bounds, by scanning.
///
/// At each angle of attack the elevator is found from the pitching moment, which is all but linear in it, and phi from the
/// row of velocity, which is affine in it; both with the modes at rest. A trim is where the flight path stops turning.
fn exists<M: DifferentiableModel<Scalar = f64>>(
    model: &M,
    velocity: f64,
    altitude: f64,
    [phi, delta_e]: [Bounds; 2],
) -> bool {
    let at = |alpha: f64, input: [f64; 2]| {
        let (mut x, mut u) = (M::State::splat(0.0), M::Input::splat(0.0));
        for (name, value) in [
            ("velocity", velocity),
            ("altitude", altitude),
            ("alpha", alpha),
        ] {
            x.set(M::State::index_of(name).expect("a state"), value);
        }
        for (name, value) in ["phi", "delta_e"].into_iter().zip(input) {
            u.set(M::Input::index_of(name).expect("an input"), value);
        }
        // What the modes rest at: their equations are affine in eta, with -omega^2.
        for mode in 1..=3 {
            let indices = ["eta", "eta_dot"].map(|it| M::State::index_of(&format!("{it}_{mode}")));
            if let [Some(eta), Some(rate)] = indices {
                let force = model.drift(&x, &u).get(rate).expect("a row");
                let mut unit = x;
                unit.set(eta, 1.0);
                let stiffness = force - model.drift(&unit, &u).get(rate).expect("a row");
                x.set(eta, force / stiffness);
            }
        }
        let drift = model.drift(&x, &u);
        ["velocity", "gamma", "pitch_rate"].map(|row| {
            M::State::index_of(row)
                .and_then(|it| drift.get(it))
                .expect("a row")
        })
    };
    // At an elevator: phi, and the turn and pitch that are left.
    let balanced = |alpha: f64, elevator: f64| {
        let (zero, one) = (at(alpha, [0.0, elevator])[0], at(alpha, [1.0, elevator])[0]);
        let fuel = zero / (zero - one);
        let [_, turn, pitch] = at(alpha, [fuel, elevator]);
        (fuel, turn, pitch)
    };
    let settled = |alpha: f64| {
        let elevator = secant([0.0, 0.3], |elevator| balanced(alpha, elevator).2);
        let (fuel, turn, pitch) = balanced(alpha, elevator);
        // No elevator balances the largest angles; nothing falls through NaN.
        let turn = if pitch.abs() < 1e-9 { turn } else { f64::NAN };
        (turn, [fuel, elevator])
    };
    let scan: Vec<f64> = (-8..=16).map(|step| f64::from(step) * 2e-2).collect();
    scan.windows(2).any(|pair| {
        let [low, high] = [pair[0], pair[1]];
        let turns = settled(low).0 * settled(high).0 <= 0.0;
        turns && {
            let alpha = bisect([low, high], |alpha| -settled(alpha).0);
            let [fuel, elevator] = settled(alpha).1;
            phi.contains(fuel) && delta_e.contains(elevator)
        }
    })
}

/// Where a function that is all but linear is 0.
fn secant([mut old, mut new]: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    let mut before = of(old);
    for _ in 0..10 {
        let now = of(new);
        if now == before {
            break;
        }
        (old, new, before) = (new, new - now * (new - old) / (now - before), now);
    }
    new
}

/// Where a function that falls through 0 does so.
fn bisect([mut low, mut high]: [f64; 2], falling: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..30 {
        let middle = 0.5 * (low + high);
        if falling(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

/// A trim is found from the cold start exactly where there is one, and else the bound that blocks is told.
///
/// `scanned` is a model with the same trims whose modes do not act on each other.
fn trims_wherever_it_can<M, N>(model: &M, scanned: &N)
where
    M: GeneratedModel,
    N: DifferentiableModel<Scalar = f64>,
{
    fn of<V: Vector<Bounds>>(bounds: &V, name: &str) -> Bounds {
        V::index_of(name)
            .and_then(|index| bounds.get(index))
            .expect("a component")
    }

    let place = |bounds: Bounds, step| {
        let share = f64::from(step) / f64::from(GRID - 1);
        bounds.min + (bounds.max - bounds.min) * share
    };
    let [over_velocity, over_altitude] =
        ["velocity", "altitude"].map(|name| of(&M::STATE_BOUNDS, name));
    let bounds = ["phi", "delta_e"].map(|name| of(&M::INPUT_BOUNDS, name));
    let mut found = 0;
    for (i, j) in (0..GRID).flat_map(|i| (0..GRID).map(move |j| (i, j))) {
        let (velocity, altitude) = (place(over_velocity, i), place(over_altitude, j));
        let flight = at::<M>(velocity, altitude).within(&M::INPUT_BOUNDS);
        let there = exists(scanned, velocity, altitude, bounds);
        let what = format!("{} at {velocity} ft/s, {altitude} ft", M::NAME);
        match trim(model, &flight) {
            Ok(trim) => {
                assert!(there, "{what}: a trim that the scan does not see");
                assert!(trim.residual_max < 1e-9, "{what}: {}", trim.residual_max);
                found += 1;
            }
            Err(TrimError::Blocked {
                blocking,
                beyond,
                nearest,
            }) => {
                assert!(!there, "{what}: a trim that was not found");
                let at = |name| {
                    nearest
                        .input
                        .iter()
                        .find(|it| it.0 == name)
                        .expect("an input")
                        .1
                };
                assert_eq!(at(blocking[0].input), blocking[0].bound, "{what}");
                let beyond = beyond.expect("far from the bounds there is one");
                let mut outside = beyond.iter().zip(bounds);
                assert!(
                    outside.any(|((_, value), bounds)| !bounds.contains(*value)),
                    "{what}"
                );
            }
            Err(error) => panic!("{what}: {error}"),
        }
    }
    assert!((100..=400).contains(&found), "{}: {found}", M::NAME);
}

/// Level flight at this velocity and altitude.
fn at<M: GeneratedModel>(velocity: f64, altitude: f64) -> SteadyState {
    level::<M>()
        .with("velocity", velocity)
        .with("altitude", altitude)
}

#[test]
fn the_com_trims_over_the_box_wherever_it_can() {
    let rigid = com_rigid::Model::new(&com::NOMINAL);
    trims_wherever_it_can(&com::Model::new(&com::NOMINAL), &rigid);
}

#[test]
fn the_dcom_trims_over_the_box_wherever_it_can() {
    for canard in [Canard::None, Canard::Slaved] {
        let model = dcom_model(canard);
        trims_wherever_it_can(&model, &model);
    }
}

#[test]
fn the_sdcom_trims_over_the_box_wherever_it_can() {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    trims_wherever_it_can(&model, &model);
}
