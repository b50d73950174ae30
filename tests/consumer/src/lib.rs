//! Links the generated models into a crate without std and without a heap.
#![no_std]
#![forbid(unsafe_code)]

use ahv_integrate::{ItoEulerMaruyama, Rk4, StepError};
use ahv_models::{dcom, sdcom};

/// Flies DCOM for `steps` steps of `dt` seconds.
///
/// # Errors
/// [`StepError`] when the state is no longer finite.
pub fn fly_dcom(x: &mut dcom::State<f64>, u: &dcom::Input<f64>, dt: f64, steps: u32) -> Result<(), StepError<f64>> {
    let model = dcom::Model::new(&dcom::NOMINAL);
    (0..steps).try_for_each(|_| Rk4::new(dt).step(&model, x, u))
}

/// Flies SDCOM in single precision through Wiener increments of `dt` seconds each, in the Itô sense.
///
/// # Errors
/// [`StepError`] when the state is no longer finite.
pub fn fly_sdcom(
    x: &mut sdcom::State<f32>,
    u: &sdcom::Input<f32>,
    dt: f64,
    increments: &[sdcom::Noise<f32>],
) -> Result<(), StepError<f32>> {
    let model = sdcom::Model::new(&sdcom::NOMINAL.map_into(|value| value as f32));
    increments.iter().try_for_each(|dw| ItoEulerMaruyama::new(dt).step(&model, x, u, dw))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIM: dcom::State<f64> = dcom::State {
        velocity: 7702.0808,
        altitude: 85_000.0,
        gamma: 0.0,
        alpha: 0.026_210,
        pitch_rate: 0.0,
        eta_1: 0.6276,
        eta_dot_1: 0.0,
        eta_2: -0.0137,
        eta_dot_2: 0.0,
        eta_3: -0.0372,
        eta_dot_3: 0.0,
    };

    #[test]
    fn dcom_stays_near_its_trim() {
        let u = dcom::Input { phi: 0.2821, delta_e: 0.228_649, delta_c: 0.0 };
        let mut x = TRIM;
        fly_dcom(&mut x, &u, 0.001, 1000).unwrap();
        assert!((x.velocity - TRIM.velocity).abs() < 1.0, "{x:?}");
        assert!((x.alpha - TRIM.alpha).abs() < 1e-3, "{x:?}");
    }

    #[test]
    fn sdcom_flies_in_single_precision() {
        let u = sdcom::Input { phi: 0.2821, delta_e: 0.228_649, delta_c: 0.0 };
        let mut x = sdcom::State {
            velocity: 7702.0808,
            altitude: 85_000.0,
            alpha: 0.026_210,
            gamma: 0.0,
            pitch_rate: 0.0,
            chi_1: 0.0,
            chi_2: 0.0,
            chi_3: 0.0,
        };
        let calm = sdcom::Noise { w_gamma: 0.0, w_alpha: 0.0, w_q: 0.0, xi_1: 0.1, xi_2: 0.0, xi_3: 0.0 };
        fly_sdcom(&mut x, &u, 0.001, &[calm; 100]).unwrap();
        assert!(x.chi_1 > 0.0 && x.chi_2 == 0.0, "{x:?}");
    }
}
