//! Coloured noise as a process of its own, whose passages are computed without a flight.

use ahv_analysis::monte_carlo::Scheme;
use ahv_analysis::trim::{Trim, trim};
use ahv_core::{ColouredNoise, StochasticModel, Vector};
use ahv_models::sdcom::{Input, NOMINAL, Noise, State};

use crate::common::level;

type Model = ahv_models::sdcom::Model<f64>;

/// Steps of a flight, and their size in s.
pub(super) const STEPS: u64 = 100;
pub(super) const DT: f64 = 0.002;

pub(super) fn steady() -> Trim<State<f64>, Input<f64>> {
    trim(&Model::new(&NOMINAL), &level::<Model>()).expect("a trim")
}

pub(super) fn index(name: &str) -> usize {
    State::<f64>::index_of(name).expect("a state")
}

/// chi_1 as a process of its own, sampled: x becomes factor · x + spread · normal number.
#[derive(Clone, Copy)]
pub(super) struct Chain {
    pub(super) factor: f64,
    pub(super) spread: f64,
}

impl Chain {
    pub(super) fn of(scheme: Scheme) -> Self {
        let (model, at) = (Model::new(&NOMINAL), steady());
        let rate = model.decay(index("chi_1")).expect("coloured noise");
        let unit = Noise {
            xi_1: 1.0,
            ..Noise::splat(0.0)
        };
        let intensity = model.noise_increment(&at.state, &at.input, &unit).chi_1;
        let (factor, variance) = match scheme {
            Scheme::EulerMaruyama => (1.0 - rate * DT, DT),
            _ => (
                (-rate * DT).exp(),
                (1.0 - (-2.0 * rate * DT).exp()) / (2.0 * rate),
            ),
        };
        Self {
            factor,
            spread: intensity * variance.sqrt(),
        }
    }

    /// Standard deviation after a long time.
    pub(super) fn settled(self) -> f64 {
        self.spread / (1.0 - self.factor * self.factor).sqrt()
    }

    /// Probability that it is above `limit` after one of `STEPS` steps, from a normal start about 0 or from 0: the
    /// equation of Chapman and Kolmogorov backwards from the end, by Gauss's rule of three points on panels.
    pub(super) fn passes(self, limit: f64, start_std: f64) -> f64 {
        const PANELS: usize = 160;
        let lowest = -9.0 * self.settled();
        let panel = (limit - lowest) / PANELS as f64;
        let nodes: Vec<[f64; 2]> = (0..3 * PANELS)
            .map(|node| {
                let place = [-0.6_f64.sqrt(), 0.0, 0.6_f64.sqrt()][node % 3];
                let weight = [5.0, 8.0, 5.0][node % 3] / 18.0;
                let x = lowest + panel * ((node / 3) as f64 + 0.5 + 0.5 * place);
                [x, weight * panel]
            })
            .collect();
        let beyond = |x: f64, std: f64| 0.5 * libm::erfc((limit - x) / (std * 2.0_f64.sqrt()));
        let density = |x: f64, std: f64| {
            (-0.5 * (x / std).powi(2)).exp() / (std * std::f64::consts::TAU.sqrt())
        };
        let row = |x: f64| -> Vec<f64> {
            let to = |&[y, weight]: &[f64; 2]| weight * density(y - self.factor * x, self.spread);
            nodes.iter().map(to).collect()
        };
        let from = |x: f64, row: &[f64], passes: &[f64]| {
            let later: f64 = row
                .iter()
                .zip(passes)
                .map(|(weight, passes)| weight * passes)
                .sum();
            beyond(self.factor * x, self.spread) + later
        };
        let kernel: Vec<Vec<f64>> = nodes.iter().map(|&[x, _]| row(x)).collect();
        let mut passes = vec![0.0; nodes.len()];
        for _ in 1..STEPS {
            let next = nodes
                .iter()
                .zip(&kernel)
                .map(|(&[x, _], row)| from(x, row, &passes));
            passes = next.collect();
        }
        if start_std == 0.0 {
            return from(0.0, &row(0.0), &passes);
        }
        // One step more for those that start at the nodes; those that start beyond have passed.
        let next = nodes
            .iter()
            .zip(&kernel)
            .map(|(&[x, weight], row)| weight * density(x, start_std) * from(x, row, &passes));
        next.sum::<f64>() + beyond(0.0, start_std)
    }
}
