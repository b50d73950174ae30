//! How many points a second the model takes: `cargo run --release -p ahv-fpm --example batch`.

use std::time::Instant;

use ahv_fpm::{Input, Model, NOMINAL, State};

/// Points of a batch.
const POINTS: u32 = 400_000;
/// Batches, of which the fastest counts.
const BATCHES: u32 = 5;

fn main() {
    let model = Model::new(&NOMINAL);
    let share = |k: u32, ratio: f64| (f64::from(k) * ratio).fract();
    let point = |k: u32| {
        let x = State {
            velocity: 7000.0 + 4000.0 * share(k, 0.618_034),
            altitude: 80_000.0 + 30_000.0 * share(k, 0.414_214),
            alpha: -0.08 + 0.25 * share(k, 0.732_051),
            eta_1: share(k, 0.236_068),
            ..State::from_array([0.0; 9])
        };
        let u = Input {
            phi: 0.05 + 0.4 * share(k, 0.302_776),
            delta_e: -0.3 + 0.6 * share(k, 0.449_490),
        };
        (x, u)
    };
    let points: Vec<_> = (0..POINTS).map(point).collect();
    let mut best = f64::INFINITY;
    let mut sound = 0;
    for _ in 0..BATCHES {
        let start = Instant::now();
        sound = model.batch(&points).iter().filter(|it| it.is_ok()).count();
        best = best.min(start.elapsed().as_secs_f64());
    }
    let rate = f64::from(POINTS) / best / 1e6;
    println!("{rate:.2} million points a second, {sound} of {POINTS} with a flow");
}
