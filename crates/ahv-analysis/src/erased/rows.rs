//! The drift at many points, by the vector instructions of the machine.

use std::array;

use ahv_core::{Branchless, GeneratedModel, Lanes, Model, Vector};

use crate::monte_carlo::{LANES, Packed};

/// Points and the places of their drifts, row by row; there is one input for all, or one for each.
struct Rows<'r, M: GeneratedModel> {
    model: M::With<Branchless<f64>>,
    states: &'r [f64],
    inputs: &'r [f64],
    rates: &'r mut [f64],
}

/// Writes the drift of each row of `states` into the row of `rates` in its place. `inputs` has one row, or as many.
pub(super) fn drifts<M: GeneratedModel>(
    model: &M,
    states: &[f64],
    inputs: &[f64],
    rates: &mut [f64],
) {
    let work = Rows::<M> {
        model: model.with_scalar(),
        states,
        inputs,
        rates,
    };
    pulp::Arch::new().dispatch(work);
    // What has no result without branches may have one with them.
    let (n, m) = (M::State::LEN, M::Input::LEN);
    for (row, rates) in rates.chunks_exact_mut(n.max(1)).enumerate() {
        if rates.iter().all(|rate| rate.is_finite()) {
            continue;
        }
        let drift = model.drift(
            &M::State::from_fn(|index| of(states, n, row, index)),
            &M::Input::from_fn(|index| of(inputs, m, row, index)),
        );
        for (index, rate) in rates.iter_mut().enumerate() {
            *rate = drift.get(index).unwrap_or(*rate);
        }
    }
}

/// A number of a row, or of the only row; 0 where there is none.
#[inline(always)]
fn of(rows: &[f64], columns: usize, row: usize, column: usize) -> f64 {
    let row = if rows.len() == columns { 0 } else { row };
    rows.get(row * columns + column).copied().unwrap_or(0.0)
}

/// [`LANES`] rows from `first` on, side by side. Lanes without row repeat the last one.
#[inline(always)]
fn side_by_side<V: Vector<Packed>>(rows: &[f64], first: usize, last: usize) -> V {
    V::from_fn(|column| {
        Lanes(array::from_fn(|lane| {
            of(rows, V::LEN, last.min(first + lane), column)
        }))
    })
}

impl<M: GeneratedModel> pulp::WithSimd for Rows<'_, M> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        // A copy, of which the compiler knows that no store changes it.
        let model = self.model;
        let n = M::State::LEN;
        let last = (self.states.len() / n.max(1)).saturating_sub(1);
        for (batch, rates) in self.rates.chunks_mut(LANES * n.max(1)).enumerate() {
            let first = batch * LANES;
            let x: M::StateOf<Packed> = side_by_side(self.states, first, last);
            let u: M::InputOf<Packed> = side_by_side(self.inputs, first, last);
            let mut drift = x;
            // A loop over points around code without branches: it becomes vector instructions.
            for lane in 0..LANES {
                let x = M::map_state(&x, |numbers| Branchless(numbers.0[lane]));
                let u = M::map_input(&u, |numbers| Branchless(numbers.0[lane]));
                M::update_state(&mut drift, model.drift(&x, &u), |place, rate| {
                    place.0[lane] = rate.0;
                });
            }
            for (lane, rates) in rates.chunks_mut(n.max(1)).enumerate() {
                for (index, rate) in rates.iter_mut().enumerate() {
                    *rate = drift.get(index).map_or(0.0, |numbers| numbers.0[lane]);
                }
            }
        }
    }
}
