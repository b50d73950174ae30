//! Coloured noise by its exact transition: SDCOM with steps that resolve the flight, not the noise.
//!
//! `cargo run --release -p ahv-integrate --example splitting`

use ahv_integrate::prelude::*;
use ahv_models::sdcom;

/// Near level flight in the set of section 5.1.
const START: sdcom::State<f64> = sdcom::State {
    velocity: 7702.0808,
    altitude: 85_000.0,
    gamma: 0.0,
    alpha: 0.0262,
    pitch_rate: 0.0,
    chi_1: 0.0,
    chi_2: 0.0,
    chi_3: 0.0,
};
const INPUT: sdcom::Input<f64> = sdcom::Input {
    phi: 0.2821,
    delta_e: 0.2286,
    delta_c: 0.0,
};
const CHANNELS: usize = sdcom::Noise::<()>::LEN;
/// States of coloured noise.
const COLOURED: usize = 3;
const MEMBERS: u64 = 4000;
const STEPS: u64 = 20;
/// In s: χ₃ has forgotten its past after half a step.
const DT: f64 = 0.05;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let model = sdcom::Model::new(&sdcom::NOMINAL);
    let splitting = ItoStrangSplitting::<f64, COLOURED>::new(&model, &START, &INPUT, DT)?;
    let (mut squares, mut altitude) = (0.0, 0.0);
    for member in 0..MEMBERS {
        // The increments take channels 0 to CHANNELS − 1 of the member, the splitting the channels after them: no number is
        // used twice.
        let mut wiener = WienerSource::<CHANNELS>::new(1, member);
        let mut normals: [NormalStream; 2 * COLOURED] =
            std::array::from_fn(|index| NormalStream::new(1, member, (CHANNELS + index) as u64));
        let mut x = START;
        for step in 0..STEPS {
            let dw = wiener.increments(step, DT);
            let mut normal = |index: usize| normals[index].normal(step);
            let halves =
                [0, COLOURED].map(|first| std::array::from_fn(|index| normal(first + index)));
            splitting.step_heun(&model, &mut x, &INPUT, &dw, &halves)?;
        }
        squares += x.chi_1 * x.chi_1;
        altitude += x.altitude;
    }
    let variance = squares / MEMBERS as f64;
    // dχ = −a χ dt + b dW: the variance is b²/(2a) (1 − e^{−2at}).
    let rate = model.decay(5).ok_or("chi_1 is coloured noise")?;
    let unit = sdcom::Noise {
        xi_1: 1.0,
        ..sdcom::Noise::splat(0.0)
    };
    let intensity = model.noise_increment(&START, &INPUT, &unit).chi_1;
    let time = STEPS as f64 * DT;
    let exact = intensity * intensity / (2.0 * rate) * (1.0 - (-2.0 * rate * time).exp());
    println!("variance of chi_1 after {time} s: {variance:.4}, exactly {exact:.4}");
    println!("mean altitude: {:.1} ft", altitude / MEMBERS as f64);
    assert!((variance / exact - 1.0).abs() < 0.1);
    Ok(())
}
