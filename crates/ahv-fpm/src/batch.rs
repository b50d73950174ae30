//! Loads at many points, on all threads.

use rayon::prelude::*;

use crate::Fault;
use crate::model::{Input, Model, State};
use crate::surfaces::Load;

/// Points that a thread computes at a time.
const CHUNK: usize = 256;

/// All loads of a flow, and its generalized forces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Total {
    /// Axial and normal force and pitching moment.
    pub load: Load<f64>,
    /// Generalized forces of the modes, (ft·slug)^½/s².
    pub generalized: [f64; 2],
}

impl Model<f64> {
    /// The loads at many points, in their order, with the bits that each has alone.
    ///
    /// A point without flow has the fault of [`Model::forces_beyond`]: none is lost, and none stops the others. Points stand by
    /// themselves, not side by side: each needs a shock or an expansion at a surface, lanes would need both.
    pub fn batch(&self, points: &[(State<f64>, Input<f64>)]) -> Vec<Result<Total, Fault>> {
        let total = |(x, u): &(State<f64>, Input<f64>)| {
            self.forces_beyond(x, u).map(|flow| Total::of(&flow))
        };
        let points = points.par_iter().with_min_len(CHUNK);
        points.map(total).collect()
    }
}

impl Total {
    /// That of a flow.
    pub fn of(flow: &crate::Flow<f64>) -> Self {
        Self {
            load: flow.total(),
            generalized: flow.generalized,
        }
    }
}
