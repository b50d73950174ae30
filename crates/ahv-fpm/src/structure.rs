//! The flexible body: two beams that are clamped at the centre of mass, with a mode each.

use ahv_core::Real;

use crate::Parameters;
use crate::beam::{Mode, Support};

/// Nodes of the quadrature along the aftbody: the pressure falls there, by less than a factor 10.
pub(crate) const NODES: usize = 12;

/// Places on 0 to 1 and weights of Gauss and Legendre's quadrature, symmetric about 1/2: distances from it, and weights.
const GAUSS: [(f64, f64); NODES / 2] = [
    (0.062_616_704_255_734_46, 0.124_573_522_906_701_34),
    (0.183_915_749_499_090_9, 0.116_746_268_269_177_3),
    (0.293_658_977_143_308_74, 0.101_583_713_361_532_9),
    (0.384_951_337_097_152_35, 0.080_039_164_271_673_11),
    (0.452_058_628_185_237_4, 0.053_469_662_997_659_45),
    (0.490_780_317_123_359_6, 0.023_587_668_193_255_706),
];

/// A beam with its first mode. Shapes are mass-normalised, in (slug/ft)^−½, deflections positive up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Beam<R> {
    /// Natural frequency, rad/s.
    pub frequency: R,
    /// Damping ratio.
    pub damping: R,
    /// Integral of x times shape over the mass, x ahead of the centre of mass, (ft·slug)^½: the coupling with the pitch rate.
    pub coupling: R,
    /// Integral of the shape over the whole beam, for the upper surface.
    pub(crate) whole: R,
    /// Integral of the shape from the centre of mass to the engine's end on this side, for its underside.
    pub(crate) engine: R,
}

/// What the modes take from the pressures, from parameters alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Structure<R> {
    /// The beam ahead of the centre of mass.
    pub forebody: Beam<R>,
    /// The beam behind.
    pub aftbody: Beam<R>,
    /// Angle of the nose of a unit of the forebody's coordinate, rad.
    pub nose_slope: R,
    /// Shape of the forebody at the inlet.
    pub(crate) inlet: R,
    /// Shape of the aftbody at the elevator.
    pub(crate) elevator: R,
    /// Quadrature of the shape of the aftbody along its ramp: place from 0 to 1, weight with the shape.
    pub(crate) ramp: [(R, R); NODES],
    /// Pitch moment of inertia that is left when the modes yield, slug·ft.
    pub(crate) inertia: R,
}

/// Places and weights of the quadrature over 0 to 1.
pub(crate) fn quadrature() -> [(f64, f64); NODES] {
    std::array::from_fn(|node| {
        let (distance, weight) = GAUSS[node / 2];
        let side = if node % 2 == 0 { -distance } else { distance };
        (0.5 + side, weight)
    })
}

impl<R: Real> Structure<R> {
    pub(crate) fn new(p: &Parameters<R>) -> Self {
        let mode = Mode::new(Support::Clamped, 1);
        let ahead = p.x_cm;
        let behind = p.l_f + p.l_n + p.l_a - p.x_cm;
        let scale = |mass: R, length: R| (mass * length).sqrt().recip();
        let (by_fore, by_aft) = (scale(p.mu_f, ahead), scale(p.mu_a, behind));
        let beam = |length: R, mass: R, stiffness, damping, engine: R| {
            let scale = scale(mass, length);
            Beam {
                frequency: mode.frequency(length, stiffness, mass),
                damping,
                coupling: R::from_f64(mode.lever()) * length / scale,
                whole: scale * length * mode.integral(R::ONE),
                engine: scale * length * mode.integral(engine / length),
            }
        };
        let forebody = beam(ahead, p.mu_f, p.ei_f, p.zeta_1, ahead - p.l_f);
        let back = beam(behind, p.mu_a, p.ei_a, p.zeta_2, p.l_f + p.l_n - p.x_cm);
        let aftbody = Beam {
            coupling: -back.coupling,
            ..back
        };
        let start = behind - p.l_a;
        let ramp = quadrature().map(|(place, weight)| {
            let (place, weight) = (R::from_f64(place), R::from_f64(weight));
            let shape = by_aft * mode.shape((start + place * p.l_a) / behind);
            (place, weight * p.l_a * shape)
        });
        let couplings = forebody.coupling * forebody.coupling + aftbody.coupling * aftbody.coupling;
        Self {
            nose_slope: by_fore * mode.slope(R::ONE) / ahead,
            inlet: by_fore * mode.shape((ahead - p.l_f) / ahead),
            elevator: by_aft * mode.shape(p.x_e / behind),
            inertia: p.i_yy - couplings,
            forebody,
            aftbody,
            ramp,
        }
    }
}

impl<R> Beam<R> {
    fn map_ref<U>(&self, f: &mut impl FnMut(&R) -> U) -> Beam<U> {
        Beam {
            frequency: f(&self.frequency),
            damping: f(&self.damping),
            coupling: f(&self.coupling),
            whole: f(&self.whole),
            engine: f(&self.engine),
        }
    }
}

impl<R> Structure<R> {
    pub(crate) fn map_ref<U>(&self, f: &mut impl FnMut(&R) -> U) -> Structure<U> {
        Structure {
            forebody: self.forebody.map_ref(f),
            aftbody: self.aftbody.map_ref(f),
            nose_slope: f(&self.nose_slope),
            inlet: f(&self.inlet),
            elevator: f(&self.elevator),
            ramp: self
                .ramp
                .each_ref()
                .map(|(place, weight)| (f(place), f(weight))),
            inertia: f(&self.inertia),
        }
    }
}
