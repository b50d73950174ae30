//! `members.csv`: what was drawn for each member, and what became of it.

use std::path::Path;

use ahv_analysis::monte_carlo::MemberRecord;

use super::tables::COMPLETE;
use crate::csv_file::CsvFile;
use crate::failure::{Failure, complain};
use crate::flights::Ready;
use crate::number::cell;

/// Members that are listed at most: the file grows with them, and nothing else does.
const MOST_LISTED: u64 = 1_000_000;

/// Intervals that may be left, in the order in which they are watched.
pub(super) const INTERVALS: [&str; 2] = ["validity_box", "limits"];

/// The list of the members, which is written while they fly.
pub(super) struct MemberList<'r> {
    ready: &'r Ready,
    /// Indices of the parameters that are drawn.
    drawn: Vec<usize>,
    /// The file, or why it cannot be written.
    file: Result<CsvFile, Failure>,
}

impl<'r> MemberList<'r> {
    /// Starts the list of `asked` members.
    pub(super) fn create(ready: &'r Ready, folder: &Path, asked: u64) -> Result<Self, Failure> {
        if asked > MOST_LISTED {
            complain(&format!(
                "note: members.csv lists members 0 to {}",
                MOST_LISTED - 1
            ));
        }
        let mut list = Self {
            drawn: ready
                .experiment
                .dispersion
                .iter()
                .flat_map(|it| it.varied())
                .collect(),
            file: CsvFile::create(&folder.join("members.csv")),
            ready,
        };
        let heading = list.heading();
        list.row(&heading);
        match list.file {
            Ok(_) => Ok(list),
            Err(failure) => Err(failure),
        }
    }

    fn heading(&self) -> Vec<String> {
        let vehicle = &self.ready.vehicle;
        let intervals = INTERVALS.iter().take(self.ready.experiment.watched.len());
        let left = intervals.flat_map(|it| [format!("left_{it} [s]"), format!("left_{it}_state")]);
        let states = vehicle.states.iter();
        let states = states.map(|(name, unit)| format!("last_{name} [{unit}]"));
        let labels = vehicle.units.labels(vehicle.model.parameters());
        let parameters = self.drawn.iter().filter_map(|&it| labels.iter().nth(it));
        let parameters = parameters.map(|(name, unit)| format!("{name} [{unit}]"));
        let first = ["member", "outcome", "lost [s]", "lost_state"].map(str::to_owned);
        first
            .into_iter()
            .chain(left)
            .chain(states)
            .chain(parameters)
            .chain([COMPLETE.to_owned()])
            .collect()
    }

    /// Lists members from number `first` on.
    pub(super) fn add(&mut self, first: u64, seen: &[MemberRecord]) {
        for (member, seen) in (first..MOST_LISTED).zip(seen) {
            if self.file.is_err() {
                return;
            }
            let row = self.member(member, seen);
            self.row(&row);
        }
    }

    fn member(&self, member: u64, seen: &MemberRecord) -> Vec<String> {
        let time = |steps: u64| cell(self.ready.time(steps));
        let (outcome, lost, lost_state) = match &seen.lost {
            Some(loss) => ("lost", time(loss.step), loss.rule.unwrap_or(loss.state)),
            None => ("flown", String::new(), ""),
        };
        let mut row = vec![
            member.to_string(),
            outcome.to_owned(),
            lost,
            lost_state.to_owned(),
        ];
        for left in &seen.left {
            let states = left.iter().zip(self.ready.vehicle.states.names);
            let states = states.filter_map(|(steps, &state)| Some(((*steps)?, state)));
            row.extend(match states.min_by_key(|(steps, _)| *steps) {
                Some((steps, state)) => [time(steps), state.to_owned()],
                None => [const { String::new() }; 2],
            });
        }
        row.extend(seen.last.iter().copied().map(cell));
        if let Some(draws) = &self.ready.experiment.dispersion {
            let parameters = draws.member_values(member);
            let drawn = self.drawn.iter().filter_map(|&it| parameters.get(it));
            row.extend(drawn.copied().map(cell));
        }
        row.push(true.to_string());
        row
    }

    fn row(&mut self, cells: &[String]) {
        if let Ok(file) = &mut self.file
            && let Err(failure) = file.row(cells)
        {
            // The flights go on without the list. What it holds so far is no use, and takes up room.
            self.file = Err(failure);
        }
    }

    /// Puts the list in its place; its last column says whether all members were flown, which is known only now.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if it could not be written.
    pub(super) fn finish(self, complete: bool) -> Result<(), Failure> {
        let file = self.file?;
        if complete {
            return file.finish();
        }
        let [whole, part] = [true, false].map(|complete| format!(",{complete}"));
        let marked = |line: &str| match line.strip_suffix(&whole) {
            Some(cells) => format!("{cells}{part}"),
            None => line.to_owned(),
        };
        file.rewritten(marked)?.finish()
    }
}
