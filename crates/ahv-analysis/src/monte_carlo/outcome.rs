//! What many members show together.

use std::time::Duration;

use sha2::{Digest, Sha256};

use super::Loss;
use super::companion::Companion;
use super::control_variate::{Controls, Remains};
use super::experiment::{Experiment, MemberRecord};
use super::spread::{Bin, QUANTILES};
use super::sums::{Part, Reference};
use crate::statistics::{Estimate, OpenEstimate};

/// Losses that are told one by one.
const LISTED_LOSSES: usize = 20;

/// What members show together.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Members that were flown.
    pub members: u64,
    /// Members that were asked for; more than were flown if the work was stopped.
    pub asked: u64,
    /// What is seen at each snapshot.
    pub snapshots: Vec<Snapshot>,
    /// Members that were lost, and the first of them.
    pub lost: u64,
    /// Of these, members whose parameters break a rule: they do not fly.
    pub not_flown: u64,
    /// The first that were lost, by number of the member.
    pub losses: Vec<(u64, Loss)>,
    /// SHA-256 of the bits of the members' last states: component by component, little end first, member by member.
    pub digest: String,
    /// Steps of these members, to the end of the flight also for those that were lost.
    pub member_steps: u64,
    /// Time that it took.
    pub elapsed: Duration,
}

impl Outcome {
    /// Members that flew.
    pub fn flown(&self) -> u64 {
        self.members - self.not_flown
    }
}

/// What is seen of the members at one time.
#[derive(Clone, Debug)]
pub struct Snapshot {
    /// Time, in s.
    pub time: f64,
    /// Members that still fly; of them are all that follows but `left`.
    pub members: u64,
    /// Each state.
    pub states: Vec<StateSpread>,
    /// Covariance of the states; infinite where numbers are too large.
    pub covariance: Vec<Vec<f64>>,
    /// For each set of watched intervals, how many members have left that of a state so far.
    pub left: Vec<Vec<u64>>,
    /// For each set of watched intervals, how many members have left any so far.
    pub left_any: Vec<u64>,
    /// Members that still fly and have stayed in the first set of watched intervals so far.
    pub stayed: u64,
}

/// How one state spreads over the members.
#[derive(Clone, Debug)]
pub struct StateSpread {
    /// Mean with its interval of 95 %; `None` where numbers are too large, or members too few.
    pub mean: Option<Estimate>,
    /// Standard deviation with its interval of 95 %, by the fourth moment; `None` as for the mean.
    pub std: Option<OpenEstimate>,
    /// What remains of the variances of both by the control variate; `None` where they are the sample's own.
    pub remains: Option<Remains>,
    /// Standard deviation of those that have stayed in the first of the watched intervals so far; `None` as for the mean.
    pub std_of_stayed: Option<f64>,
    /// Quantiles of [`QUANTILES`], each with its interval of 95 %.
    pub quantiles: [OpenEstimate; QUANTILES.len()],
    /// What the bins of the quantiles add to their error, in the unit of the state.
    pub resolution: f64,
    /// Counts between the least and the greatest number.
    pub histogram: Vec<Bin>,
}

/// What members show together, collected in their order.
pub struct Tally<'e> {
    experiment: &'e Experiment,
    reference: Reference,
    part: Part,
    /// With a control variate.
    controls: Option<Controls<'e>>,
    lost: u64,
    not_flown: u64,
    losses: Vec<(u64, Loss)>,
    hash: Sha256,
}

impl<'e> Tally<'e> {
    /// Of no members so far.
    pub fn new(experiment: &'e Experiment, reference: Reference) -> Self {
        Self {
            part: Part::new(experiment, &reference, 0),
            experiment,
            reference,
            controls: None,
            lost: 0,
            not_flown: 0,
            losses: Vec::new(),
            hash: Sha256::new(),
        }
    }

    /// The same with what is known of the members' companions.
    pub(super) fn beside(mut self, companion: Option<&'e Companion>) -> Self {
        self.controls = companion.map(Controls::new);
        self
    }

    /// Members so far; the next one has this number.
    pub fn members(&self) -> u64 {
        self.part.members()
    }

    /// The members of the next block.
    pub(super) fn add(&mut self, seen: &[MemberRecord]) {
        self.list(seen);
        self.part.add(self.experiment, &self.reference, seen);
        if let Some(controls) = &mut self.controls {
            controls.add(&self.reference, seen);
        }
    }

    /// The members that come next, [`BLOCK`](super::BLOCK) times some number unless they are the last, with their part. States
    /// at the snapshots, which are in the part, are not looked for in their records.
    pub fn join(&mut self, seen: &[MemberRecord], part: Part) {
        self.list(seen);
        self.part.join(part);
    }

    fn list(&mut self, seen: &[MemberRecord]) {
        for (member, seen) in (self.members()..).zip(seen) {
            for value in &seen.last {
                self.hash.update(value.to_le_bytes());
            }
            if let Some(loss) = seen.lost {
                self.lost += 1;
                self.not_flown += u64::from(loss.rule.is_some());
                if self.losses.len() < LISTED_LOSSES {
                    self.losses.push((member, loss));
                }
            }
        }
    }

    /// What they show, of `asked` members.
    pub fn outcome(self, asked: u64, elapsed: Duration) -> Outcome {
        let members = self.part.members();
        let mut snapshots = self.part.snapshots(self.experiment, &self.reference);
        if let Some(controls) = &self.controls {
            controls.apply(&self.reference, members - self.not_flown, &mut snapshots);
        }
        Outcome {
            members,
            asked,
            snapshots,
            lost: self.lost,
            not_flown: self.not_flown,
            losses: self.losses,
            digest: hexadecimal(&self.hash.finalize()),
            member_steps: (members - self.not_flown).saturating_mul(self.experiment.steps()),
            elapsed,
        }
    }
}

fn hexadecimal(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
