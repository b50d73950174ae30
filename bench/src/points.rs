//! Random points of the box of validity.

use ahv_core::{Bounds, Vector};
use ahv_models::{dcom, sdcom};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use serde_json::{Value, json};

use crate::subject::Model;

const SEED: u64 = 1;

/// States and inputs, one after the other.
pub(crate) struct Points {
    states: Vec<f64>,
    inputs: Vec<f64>,
    lengths: (usize, usize),
}

impl Points {
    /// The same `count` points on every machine.
    pub(crate) fn of(model: Model, count: usize) -> Self {
        let (states, inputs) = match model {
            Model::Dcom => (bounds(&dcom::STATE_BOUNDS), bounds(&dcom::INPUT_BOUNDS)),
            Model::Sdcom => (bounds(&sdcom::STATE_BOUNDS), bounds(&sdcom::INPUT_BOUNDS)),
        };
        let mut random = ChaCha8Rng::seed_from_u64(SEED);
        let mut points = Self {
            states: Vec::new(),
            inputs: Vec::new(),
            lengths: (states.len(), inputs.len()),
        };
        for _ in 0..count {
            points.states.extend(draw(&states, &mut random));
            points.inputs.extend(draw(&inputs, &mut random));
        }
        points
    }

    /// Pairs of state and input.
    pub(crate) fn iter(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        self.states
            .chunks_exact(self.lengths.0)
            .zip(self.inputs.chunks_exact(self.lengths.1))
    }

    /// For a peer.
    pub(crate) fn json(&self) -> Value {
        let (states, inputs): (Vec<_>, Vec<_>) = self.iter().unzip();
        json!({"states": states, "inputs": inputs})
    }

    /// Number of points.
    pub(crate) fn len(&self) -> usize {
        self.states.len() / self.lengths.0
    }
}

fn bounds<V: Vector<Bounds>>(box_: &V) -> Vec<Bounds> {
    (0..V::LEN).filter_map(|index| box_.get(index)).collect()
}

fn draw(bounds: &[Bounds], random: &mut ChaCha8Rng) -> Vec<f64> {
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    bounds
        .iter()
        .map(|it| it.min + (it.max - it.min) * uniform())
        .collect()
}
