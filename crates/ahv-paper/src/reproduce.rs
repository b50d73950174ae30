//! The paper's section 5, computed again.
//!
//! Table 1 and Fig. 2 ([`table1`]), Figs. 3 and 4 ([`snapshot`]), Fig. 5 ([`forced`]), Tables 2 and 3 with Fig. 6
//! ([`vehicle`]); [`differences`] compares (27)–(35) as printed with the exact form; what the paper prints is in [`printed`]. Random results are functions of [`Size`] alone, on any number of
//! threads.

pub mod differences;
pub mod forced;
pub mod p_value;
pub mod pairing;
pub mod printed;
mod sample_moments;
pub mod snapshot;
pub mod table1;
pub mod vehicle;

use crate::reduce::{ReduceError, Reduction};

/// Methods in the order of all results.
pub const METHODS: [Reduction; 3] = Reduction::ALL;

/// How much is computed.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Size {
    /// Experiments behind the distribution of a maximum over time, at least.
    pub repeats: u64,
    /// Most experiments of the reduction that Table 1 is about: they are doubled until its verdicts stand.
    pub most_repeats: u64,
    /// Runs of an experiment of Table 1.
    pub runs: u64,
    /// Runs of Figs. 3 and 4.
    pub snapshot_runs: u64,
    /// Runs behind the estimates beside Fig. 5.
    pub forced_runs: u64,
    /// Steps of a run.
    pub steps: u64,
    /// Step size, in s.
    pub dt: f64,
    /// Seed of all noise.
    pub seed: u64,
}

impl Size {
    /// The sizes of section 5, with a step of 10 ms, which the paper does not state.
    pub const PAPER: Self = Self {
        repeats: 1000,
        most_repeats: 16_000,
        runs: printed::TABLE_1_RUNS,
        snapshot_runs: printed::SNAPSHOT_RUNS,
        forced_runs: 1000,
        steps: 1000,
        dt: 0.01,
        seed: 1,
    };

    /// Steps of all random parts.
    pub fn work(&self) -> u64 {
        table1::steps(self) + snapshot::steps(self) + forced::steps(self)
    }
}

/// Steps that are done, with whom to report them to.
struct Work<'a> {
    done: u64,
    report: &'a mut dyn FnMut(u64),
}

impl Work<'_> {
    fn done(&mut self, steps: u64) {
        self.done += steps;
        (self.report)(self.done);
    }
}

/// The random parts of section 5.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Random {
    /// How much was computed.
    pub size: Size,
    /// Table 1 and Fig. 2.
    pub table1: table1::Table1,
    /// Figs. 3 and 4.
    pub snapshot: snapshot::Snapshot,
    /// Fig. 5.
    pub forced: forced::Forced,
}

/// Computes the random parts. `report` gets from time to time how many of [`Size::work`] steps are done.
///
/// # Errors
///
/// [`ReduceError`] for a step size without sense.
pub fn random(size: &Size, mut report: impl FnMut(u64)) -> Result<Random, ReduceError> {
    let mut work = Work {
        done: 0,
        report: &mut report,
    };
    Ok(Random {
        size: *size,
        table1: table1::run(size, &mut work)?,
        snapshot: snapshot::run(size, &mut work)?,
        forced: forced::run(size, &mut work)?,
    })
}
