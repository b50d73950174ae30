//! How far (27)–(35) as printed are from the form that (1)–(4) and (25) imply, over the box of validity.

use ahv_core::{Bounds, Model as _, Vector};
use ahv_models::dcom::{self, Canard};
use ahv_models::sdcom_printed::{INPUT_BOUNDS, Input, STATE_BOUNDS, State};
use ahv_models::{sdcom, sdcom_printed};

/// Points of the box beside its corners.
const POINTS: u32 = 20_000;
/// States and inputs.
const VARIABLES: usize = State::<f64>::LEN + Input::<f64>::LEN;
/// Their names.
const NAMES: [&str; ROWS] = [
    "Δf_V", "Δf_γ", "Δf_α", "Δf_Q", "ΔH_V", "ΔH_γ", "ΔH_α", "ΔH_Q",
];
const UNITS: [&str; ROWS] = [
    "ft/s²",
    "rad/s",
    "rad/s",
    "rad/s²",
    "ft/s²/rad",
    "1/s",
    "1/s",
    "1/s²",
];
const ROWS: usize = 8;

/// A difference under one choice of canard: the largest magnitudes at all corners of the box and at 20 000 points between.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Difference {
    /// Name of the choice.
    pub canard: &'static str,
    /// The exact form less the printed one.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its largest magnitude.
    pub largest: f64,
    /// The largest magnitude of the exact form.
    pub exact: f64,
}

/// The differences of the first set of parameters, without a canard and with a slaved one.
pub fn differences() -> Vec<Difference> {
    let choices = [Canard::None, Canard::Slaved];
    choices.into_iter().flat_map(of).collect()
}

fn of(canard: Canard) -> Vec<Difference> {
    let parameters = dcom::NOMINAL.with_canard(canard);
    let printed = sdcom_printed::Model::new(&parameters);
    let exact = sdcom::Model::new(&parameters);
    let mut largest = [[0.0_f64; 2]; ROWS];
    for point in points() {
        let x = State::from_fn(|index| point[index]);
        let u = Input::from_fn(|index| point[State::<f64>::LEN + index]);
        let found = rows(&x, &u, &printed.prepared, &exact);
        for (largest, found) in largest.iter_mut().zip(found) {
            for (largest, found) in largest.iter_mut().zip(found) {
                *largest = largest.max(found.abs());
            }
        }
    }
    let rows = NAMES.into_iter().zip(UNITS).zip(largest);
    rows.map(|((name, unit), [largest, exact])| Difference {
        canard: canard.name(),
        name,
        unit,
        largest,
        exact,
    })
    .collect()
}

/// Every difference at a point, with the exact form beside it.
fn rows(
    x: &State<f64>,
    u: &Input<f64>,
    p: &sdcom_printed::Prepared<f64>,
    exact: &sdcom::Model<f64>,
) -> [[f64; 2]; ROWS] {
    // The two forms have the same states and inputs, in the same order.
    let exact_x = sdcom::State::from_fn(|index| x.get(index).unwrap_or_default());
    let exact_u = sdcom::Input::from_fn(|index| u.get(index).unwrap_or_default());
    let q = &exact.prepared;
    let f = exact.drift(&exact_x, &exact_u);
    [
        [sdcom_printed::delta_f_V(x, u, p), f.velocity],
        [sdcom_printed::delta_f_gamma(x, u, p), f.gamma],
        [sdcom_printed::delta_f_alpha(x, u, p), f.alpha],
        [sdcom_printed::delta_f_Q(x, u, p), f.pitch_rate],
        [
            sdcom_printed::delta_H_V(x, u, p),
            sdcom::H_V(&exact_x, &exact_u, q),
        ],
        [
            sdcom_printed::delta_H_gamma(x, u, p),
            sdcom::H_gamma(&exact_x, &exact_u, q),
        ],
        [
            sdcom_printed::delta_H_alpha(x, u, p),
            sdcom::H_alpha(&exact_x, &exact_u, q),
        ],
        [
            sdcom_printed::delta_H_Q(x, u, p),
            sdcom::H_Q(&exact_x, &exact_u, q),
        ],
    ]
}

/// The box of validity: states, then inputs.
fn bounds() -> [Bounds; VARIABLES] {
    let (x, u) = (STATE_BOUNDS.to_array(), INPUT_BOUNDS.to_array());
    let mut both = x.into_iter().chain(u);
    [(); VARIABLES].map(|()| both.next().unwrap_or(Bounds { min: 0.0, max: 0.0 }))
}

/// The corners of the box of validity, and points that an additive recurrence spreads over it: the same everywhere.
fn points() -> impl Iterator<Item = [f64; VARIABLES]> {
    let bounds = bounds();
    let between = move |share: &dyn Fn(usize) -> f64| {
        let mut index = 0..;
        bounds.map(|Bounds { min, max }| min + (max - min) * index.next().map_or(0.0, share))
    };
    let corners =
        (0_u32..1 << VARIABLES).map(move |corner| between(&|index| f64::from(corner >> index & 1)));
    // Powers of the reciprocal of the root above 1 of x^(n+1) = x + 1, n variables (Roberts' sequence).
    let root = (0..64).fold(1.5_f64, |root, _| {
        (1.0 + root).powf(1.0 / (VARIABLES + 1) as f64)
    });
    let spread = (1..=POINTS).map(move |point| {
        between(&|index| (0.5 + f64::from(point) * root.powi(-(index as i32) - 1)).fract())
    });
    corners.chain(spread)
}

#[cfg(test)]
mod tests {
    use super::{ROWS, differences, points};

    #[test]
    fn every_difference_has_a_magnitude() {
        let differences = differences();
        assert_eq!(differences.len(), 2 * ROWS);
        for it in &differences {
            assert!(it.largest > 0.0 && it.largest.is_finite(), "{it:?}");
            assert!(it.exact > 0.0 && it.exact.is_finite(), "{it:?}");
        }
        // The same by another search, with refinement: 149 ft/s² with a slaved canard.
        let velocity = differences.iter().find(|it| it.canard == "slaved");
        let largest = velocity.expect("a row").largest;
        assert!((148.0..151.0).contains(&largest), "{largest}");
    }

    #[test]
    fn points_fill_the_box() {
        let mut sums = [0.0; 11];
        let mut count = 0.0;
        for point in points().skip(1 << 11) {
            count += 1.0;
            for (sum, (value, bounds)) in sums.iter_mut().zip(point.iter().zip(super::bounds())) {
                assert!((bounds.min..=bounds.max).contains(value));
                *sum += (value - bounds.min) / (bounds.max - bounds.min);
            }
        }
        assert_eq!(count, f64::from(super::POINTS));
        for sum in sums {
            assert!((sum / count - 0.5_f64).abs() < 0.01, "{sum}");
        }
    }
}
