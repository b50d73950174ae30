//! What of a step in lanes the normal numbers take.

use std::hint::black_box;
use std::marker::PhantomData;

use ahv_analysis::monte_carlo::{LANES, Mode};
use ahv_integrate::{NormalLanes, Precision};
use ahv_models::sdcom::Noise;

use super::UNITS;
use super::own::{experiment, fly};
use super::problem::{Flight, MEMBERS, STEPS};
use crate::race::{Finish, Runner, race};
use crate::table::Table;
use crate::threads::pool;

const CHANNELS: usize = Noise::<()>::LEN;

/// Races steps and the normal numbers of as many, both in f64, then both with numbers in f32; on one thread.
pub(super) fn measure(rounds: u32) -> Result<Vec<Finish>, String> {
    eprintln!("timing normal numbers");
    let mut finishes = Vec::new();
    let modes: [(_, fn(u64)); 2] = [
        (Mode::Exact, normals::<f64>),
        (Mode::F32Noise, normals::<f32>),
    ];
    for (mode, normals) in modes {
        let (experiment, one) = (experiment(&Flight::new(), mode), pool(1)?);
        let step = move |seed| {
            let experiment = ahv_analysis::monte_carlo::Experiment {
                seed,
                ..experiment.clone()
            };
            fly(&experiment, MEMBERS as u64, &one)
        };
        let alone = move |seed| {
            normals(seed);
            Ok(())
        };
        let name = mode.name();
        let runners = vec![
            Runner::new(name, "a step", UNITS, step, |_| Vec::new()),
            Runner::new(name, "its normal numbers alone", UNITS, alone, |()| {
                Vec::new()
            }),
        ];
        finishes.extend(race(runners, 1, rounds)?);
    }
    Ok(finishes)
}

/// The normal numbers of all flights.
fn normals<T: Precision>(seed: u64) {
    for batch in 0..(MEMBERS / LANES) as u64 {
        let members = std::array::from_fn(|lane| batch * LANES as u64 + lane as u64);
        pulp::Arch::new().dispatch(Normals {
            channels: std::array::from_fn(|channel| {
                NormalLanes::<T, LANES>::new(seed, members, channel as u64)
            }),
            precision: PhantomData,
        });
    }
}

struct Normals<T> {
    channels: [NormalLanes<T, LANES>; CHANNELS],
    precision: PhantomData<T>,
}

impl<T: Precision> pulp::WithSimd for Normals<T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<V: pulp::Simd>(mut self, _: V) {
        for step in 0..STEPS as u64 {
            for channel in &mut self.channels {
                black_box(&channel.normal(step));
            }
        }
    }
}

/// For people.
pub(super) fn table(finishes: &[Finish]) -> Table {
    let row = |it: &Finish| {
        vec![
            it.candidate.to_owned(),
            it.how.to_owned(),
            format!("{:.1}", it.seconds.median * 1e9),
            format!("{:.1}", it.seconds.min * 1e9),
            format!("{:.2}", it.ratio.median),
        ]
    };
    Table {
        title: "What normal numbers take of that".to_owned(),
        note: format!(
            "A member-step of `ahv` in 8 lanes on one thread, and its {CHANNELS} normal numbers alone."
        ),
        columns: vec!["mode", "what", "ns", "min", "share"],
        rows: finishes.iter().map(row).collect(),
    }
}
