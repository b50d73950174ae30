//! A canard: an all-moving plate ahead of the centre of mass, in the air ahead of the vehicle as the elevator is.

use ahv_core::Real;

use crate::fault::of_turn;
use crate::flow::Flow;
use crate::surfaces::{Load, Surface, Turned, plate};
use crate::{Fault, Parameters};

/// The flow along both faces of the canard, and their load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Canard<R> {
    /// Along the lower and the upper face.
    pub faces: [Turned<R>; 2],
    /// Load of both.
    pub load: Load<R>,
}

impl<R: Real> Canard<R> {
    /// The canard of these parameters in a flow at angle of attack `alpha`, turned by `delta_c`, trailing edge down, rad.
    pub fn new(p: &Parameters<R>, flow: &Flow<R>, alpha: R, delta_c: R) -> Self {
        let faces = plate(p.kappa, flow.mach, alpha + delta_c);
        let force = (faces[0].pressure - faces[1].pressure) * flow.air.pressure * p.s_c;
        let (sin, cos) = delta_c.sin_cos();
        Self {
            faces,
            load: Load::at(-force * sin, force * cos, p.x_c, p.z_c),
        }
    }
}

impl Canard<f64> {
    /// Why there is no such flow, if there is none.
    pub fn fault(&self, gamma: f64) -> Option<Fault> {
        let surfaces = [Surface::CanardLower, Surface::CanardUpper];
        let mut faces = surfaces.into_iter().zip(&self.faces);
        faces.find_map(|(surface, face)| of_turn(gamma, surface, face))
    }
}
