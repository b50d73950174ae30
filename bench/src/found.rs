//! Everything that was found.

use serde::Serialize;

use crate::agreement::Agreement;
use crate::candidates::LANES;
use crate::compilation::Compilation;
use crate::generation::Generation;
use crate::interval::Interval;
use crate::machine::Machine;
use crate::modes::Modes;
use crate::monte_carlo::MonteCarlo;
use crate::operations::Operations;
use crate::ports::Bound;
use crate::process::Process;
use crate::rk4::Trajectories;
use crate::rounds::Spread;
use crate::steppers::Steppers;
use crate::subject::SUBJECTS;
use crate::timing::Timing;
use crate::weak::Weak;

/// What was measured, of which the bars and the pages are made.
#[derive(Serialize)]
pub(crate) struct Found {
    pub(crate) machine: Machine,
    /// With peers alone.
    pub(crate) generation: Option<Generation>,
    /// With peers alone: without them what is there already is not compiled again.
    pub(crate) compilation: Option<Vec<Compilation>>,
    pub(crate) operations: Vec<Operations>,
    pub(crate) agreement: Vec<Agreement>,
    pub(crate) points: usize,
    pub(crate) rounds: u32,
    pub(crate) timings: Vec<Timing>,
    pub(crate) steppers: Steppers,
    pub(crate) trajectories: Trajectories,
    pub(crate) monte_carlo: MonteCarlo,
    /// With peers alone.
    pub(crate) processes: Option<Vec<Process>>,
    /// With peers alone.
    pub(crate) interval: Option<Interval>,
    pub(crate) modes: Modes,
    /// With peers alone: it takes minutes.
    pub(crate) weak: Option<Weak>,
    pub(crate) bound: Bound,
}

impl Found {
    /// Time of a member's drift in lanes.
    pub(crate) fn lane_drift(&self) -> Option<Spread> {
        let mut timings = self.timings.iter();
        let drift = |it: &&Timing| it.function == SUBJECTS[0].symbol && it.candidate == LANES;
        timings.find(drift).map(|it| it.nanoseconds)
    }
}
