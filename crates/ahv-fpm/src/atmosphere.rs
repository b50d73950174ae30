//! The US Standard Atmosphere 1976, up to 169 000 ft.

use ahv_core::Real;

use crate::Parameters;

/// The air at an altitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air<R> {
    /// Static temperature, K.
    pub temperature: R,
    /// Static pressure, lb/ft².
    pub pressure: R,
    /// Density, slug/ft³.
    pub density: R,
    /// Speed of sound, ft/s.
    pub sound: R,
}

/// What a layer begins with.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Layer<R> {
    /// Geopotential altitude, ft.
    floor: R,
    temperature: R,
    pressure: R,
    /// Temperature gradient, K/ft.
    lapse: R,
    /// Exponent of the temperature ratio, 0 where the layer is isothermal.
    power: R,
    /// Decay of the pressure, 1/ft, 0 where there is a gradient.
    decay: R,
}

/// The layers, from their parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Atmosphere<R> {
    layers: [Layer<R>; 5],
    radius: R,
    gas: R,
    kappa: R,
}

impl<R: Real> Atmosphere<R> {
    pub(crate) fn new(p: &Parameters<R>) -> Self {
        let floors = [p.h_1, p.h_2, p.h_3, p.h_4];
        let lapses = [
            Some(p.lapse_0),
            None,
            Some(p.lapse_2),
            Some(p.lapse_3),
            None,
        ];
        let weight = p.g_0 / p.r_air;
        let layer = |floor, temperature, pressure, lapse: Option<R>| Layer {
            floor,
            temperature,
            pressure,
            lapse: lapse.unwrap_or(R::ZERO),
            power: lapse.map_or(R::ZERO, |lapse| weight / lapse),
            decay: lapse.map_or(weight / temperature, |_| R::ZERO),
        };
        let mut layers = [layer(R::ZERO, p.t_0, p.p_0, lapses[0]); 5];
        for (below, (floor, lapse)) in floors
            .into_iter()
            .zip(lapses.into_iter().skip(1))
            .enumerate()
        {
            let (temperature, pressure) = layers[below].at(floor);
            layers[below + 1] = layer(floor, temperature, pressure, lapse);
        }
        Self {
            layers,
            radius: p.r_0,
            gas: p.r_air,
            kappa: p.kappa,
        }
    }

    /// The air at a geometric altitude, ft. Below the first layer and above the last these go on.
    pub(crate) fn at(&self, altitude: R) -> Air<R> {
        let height = self.radius * altitude / (self.radius + altitude);
        let [mut found, above @ ..] = self.layers;
        for layer in above {
            let choose = |below, here| height.select(layer.floor, below, here);
            found = Layer {
                floor: choose(found.floor, layer.floor),
                temperature: choose(found.temperature, layer.temperature),
                pressure: choose(found.pressure, layer.pressure),
                lapse: choose(found.lapse, layer.lapse),
                power: choose(found.power, layer.power),
                decay: choose(found.decay, layer.decay),
            };
        }
        let (temperature, pressure) = found.at(height);
        Air {
            temperature,
            pressure,
            density: pressure / (self.gas * temperature),
            sound: (self.kappa * self.gas * temperature).sqrt(),
        }
    }
}

impl<R: Real> Layer<R> {
    /// Temperature and pressure at a geopotential altitude.
    fn at(&self, height: R) -> (R, R) {
        let above = height - self.floor;
        let temperature = self.temperature + self.lapse * above;
        // One of the two factors is 1.
        let factor =
            (temperature / self.temperature).powr(-self.power) * (-self.decay * above).exp();
        (temperature, self.pressure * factor)
    }
}

impl<R> Atmosphere<R> {
    pub(crate) fn map_ref<U>(&self, f: &mut impl FnMut(&R) -> U) -> Atmosphere<U> {
        Atmosphere {
            layers: self.layers.each_ref().map(|layer| Layer {
                floor: f(&layer.floor),
                temperature: f(&layer.temperature),
                pressure: f(&layer.pressure),
                lapse: f(&layer.lapse),
                power: f(&layer.power),
                decay: f(&layer.decay),
            }),
            radius: f(&self.radius),
            gas: f(&self.gas),
            kappa: f(&self.kappa),
        }
    }
}
