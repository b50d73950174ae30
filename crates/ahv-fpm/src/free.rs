//! Modes of the whole vehicle as a uniform beam that is free at both ends, as DCOM has them, under the pressures of the flow.

use crate::beam::{Mode, Support};
use crate::canard::Canard;
use crate::structure::{NODES, quadrature};
use crate::surfaces::Surface;
use crate::{Flow, Parameters};

/// A free-free mode, mass-normalised in (slug/ft)^−½: deflections positive up, the nose's above 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FreeMode {
    /// Angle by which a unit of the coordinate turns the nose up, rad.
    pub nose_slope: f64,
    /// Integrals of the shape over the forebody, the engine and the whole vehicle.
    forebody: f64,
    engine: f64,
    whole: f64,
    /// The shape at the inlet, the elevator and the canard.
    inlet: f64,
    elevator: f64,
    canard: f64,
    /// Place on the ramp from 0 to 1, and the shape there times the weight of the quadrature.
    ramp: [(f64, f64); NODES],
}

impl FreeMode {
    /// Mode `number`, from 1, of a vehicle whose mass is spread evenly along it.
    #[must_use]
    pub fn new(p: &Parameters<f64>, number: u32) -> Self {
        let mode = Mode::new(Support::Free, number);
        let length = p.l_f + p.l_n + p.l_a;
        let mass = p.mu_f * p.x_cm + p.mu_a * (length - p.x_cm);
        let scale = mass.sqrt().recip();
        let shape = |x: f64| scale * mode.shape(x / length);
        let until = |x: f64| scale * length * mode.integral(x / length);
        let ramp = quadrature().map(|(place, weight)| {
            let x = p.l_f + p.l_n + place * p.l_a;
            (place, weight * p.l_a * shape(x))
        });
        Self {
            nose_slope: -scale * mode.slope(0.0) / length,
            forebody: until(p.l_f),
            engine: until(p.l_f + p.l_n) - until(p.l_f),
            whole: until(length),
            inlet: shape(p.l_f),
            elevator: shape(p.x_cm + p.x_e),
            canard: shape(p.x_cm - p.x_c),
            ramp,
        }
    }

    /// The generalized force of a flow, (ft·slug)^½/s².
    #[must_use]
    pub fn force(&self, flow: &Flow<f64>, canard: Option<&Canard<f64>>) -> f64 {
        let pressure = flow.air.pressure;
        let gauge = |ratio: f64| (ratio - 1.0) * pressure;
        let exit = flow.stream.exit_pressure;
        let ramp = self.ramp.iter().map(|(place, weight)| {
            let ratio = exit / (1.0 + place * (exit - 1.0));
            gauge(ratio) * weight
        });
        let normal = |surface: Surface| flow.loads[surface as usize].normal;
        gauge(flow.bow.pressure) * self.forebody + gauge(flow.underside.pressure) * self.engine
            - gauge(flow.upper.pressure) * self.whole
            + ramp.sum::<f64>()
            + normal(Surface::Inlet) * self.inlet
            + (normal(Surface::ElevatorLower) + normal(Surface::ElevatorUpper)) * self.elevator
            + canard.map_or(0.0, |it| it.load.normal * self.canard)
    }
}
