//! Loads at many points, eight side by side on all threads.

use ahv_core::{Lanes, Vector};
use rayon::prelude::*;

use crate::Fault;
use crate::model::{Input, Model, State};
use crate::surfaces::Load;

/// Points that are computed side by side.
const LANES: usize = 8;

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
    /// A point without flow has the fault of [`Model::forces_beyond`]: none is lost, and none stops the others.
    pub fn batch(&self, points: &[(State<f64>, Input<f64>)]) -> Vec<Result<Total, Fault>> {
        let wide = self.map_ref(|&it| Lanes::splat(it));
        let chunks = points.par_chunks(LANES);
        chunks
            .flat_map_iter(|chunk| self.side_by_side(&wide, chunk))
            .collect()
    }

    /// The loads at up to as many points as there are lanes.
    fn side_by_side(
        &self,
        wide: &Model<Lanes<f64, LANES>>,
        points: &[(State<f64>, Input<f64>)],
    ) -> impl Iterator<Item = Result<Total, Fault>> {
        // The last point fills lanes that are left.
        let point = |lane: usize| points[lane.min(points.len() - 1)];
        let x = State::from_fn(|index| {
            Lanes::from_fn(|lane| point(lane).0.get(index).unwrap_or(f64::NAN))
        });
        let u = Input::from_fn(|index| {
            Lanes::from_fn(|lane| point(lane).1.get(index).unwrap_or(f64::NAN))
        });
        let flow = wide.flow(&x, &u);
        let load = flow.total();
        let found: [Result<Total, Fault>; LANES] = std::array::from_fn(|lane| {
            let of = |value: Lanes<f64, LANES>| value.0[lane];
            let total = Total {
                load: Load {
                    axial: of(load.axial),
                    normal: of(load.normal),
                    moment: of(load.moment),
                },
                generalized: flow.generalized.map(of),
            };
            let numbers = [
                total.load.axial,
                total.load.normal,
                total.load.moment,
                total.generalized[0],
                total.generalized[1],
            ];
            let sound = of(flow.margin) > 0.0 && numbers.iter().all(|it| it.is_finite());
            // Alone, it says what is wrong.
            let (x, u) = point(lane);
            if sound {
                Ok(total)
            } else {
                self.forces_beyond(&x, &u).map(|flow| Total::of(&flow))
            }
        });
        found.into_iter().take(points.len())
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
