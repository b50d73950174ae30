use ahv_analysis::monte_carlo::*;
use ahv_core::*;
use ahv_models::sdcom;
use std::time::Instant;
fn main() {
    let x = sdcom::State { velocity: 7702.0, altitude: 85000.0, gamma: 0.0, alpha: 0.025, pitch_rate: 0.0, chi_1: 0.0, chi_2: 0.0, chi_3: 0.0 };
    let u = sdcom::Input { phi: 0.25, delta_e: 0.2, delta_c: 0.0 };
    for mode in [Mode::Exact] { for scheme in [Scheme::EulerMaruyama] {
        let e = Experiment::<Sdcom> { parameters: sdcom::NOMINAL, dispersion: None, state: [x, Vector::splat(0.0)], input: [u, Vector::splat(0.0)], feedback: None,
            watched: vec![sdcom::STATE_BOUNDS], scheme, mode, dt: 1e-3, snapshots: vec![200], seed: 1 };
        let mut best = f64::MAX; let mut sum = 0.0;
        for _ in 0..15 { let t = Instant::now(); let c = Control::default();
            for b in 0..20u64 { let m: Vec<u64> = (8*b..8*b+8).collect(); let s = Sdcom::fly(&e, &m, &c).unwrap().unwrap(); sum += s[3].last.alpha; }
            best = best.min(t.elapsed().as_secs_f64()*1e9/(20.0*8.0*200.0)); }
        println!("{} {} {:.1} ns a member-step  {sum}", mode.name(), scheme.name(), best);
    } }
}
