//! The files of `ahv montecarlo`.

use std::path::Path;

use ahv_analysis::monte_carlo::QUANTILES;
use ahv_analysis::statistics::OpenEstimate;

use super::{Summary, figure, trajectories};
use crate::csv_file::CsvFile;
use crate::failure::{Failure, all};
use crate::number::{cell, time};
use crate::output;

/// Heading of the column that is the same in all rows: whether all members were flown.
pub(super) const COMPLETE: &str = "complete";

/// Cells of an estimate; empty where there is none, or a side is open.
fn cells(estimate: &OpenEstimate) -> [String; 3] {
    [estimate.value, estimate.low, estimate.high]
        .map(|number| number.map_or_else(String::new, cell))
}

impl Summary<'_> {
    /// Writes all files of numbers.
    pub(super) fn write(&self, folder: &Path) -> Result<(), Failure> {
        let json = output::json(&self.json())?;
        let summary = output::write(&folder.join("summary.json"), json + "\n");
        // One that cannot be written is no reason not to write the others.
        all([
            summary,
            self.snapshots(&folder.join("snapshots.csv")),
            self.limits(&folder.join("limits.csv")),
            self.histograms(&folder.join("histograms.csv")),
            trajectories::write(self, folder),
        ])
    }

    /// Draws the picture.
    pub(super) fn draw(&self, folder: &Path) -> Result<(), Failure> {
        output::picture(&folder.join("montecarlo.svg"), figure::draw(self))
    }

    /// Whether all members were flown that were asked for: the last column of the tables.
    pub(super) fn is_complete(&self) -> bool {
        self.outcome.members == self.outcome.asked
    }

    /// A row a snapshot and state.
    fn snapshots(&self, path: &Path) -> Result<(), Failure> {
        let complete = self.is_complete().to_string();
        let mut file = CsvFile::create(path)?;
        let mut heading: Vec<String> = ["time [s]", "members", "state", "unit"]
            .map(str::to_owned)
            .to_vec();
        let shares = QUANTILES.map(|share| format!("quantile_{share}"));
        for name in ["mean", "std"].map(str::to_owned).iter().chain(&shares) {
            heading.extend([name.clone(), format!("{name}_low"), format!("{name}_high")]);
        }
        heading.push(COMPLETE.to_owned());
        file.row(&heading)?;
        for snapshot in &self.outcome.snapshots {
            for ((name, unit), state) in self.ready.vehicle.states.iter().zip(&snapshot.states) {
                let mut row = vec![
                    cell(time(snapshot.time)),
                    snapshot.members.to_string(),
                    name.to_owned(),
                    unit.to_owned(),
                ];
                let moments = [state.mean.into(), state.std.unwrap_or_default()];
                row.extend(moments.iter().chain(&state.quantiles).flat_map(cells));
                row.push(complete.clone());
                file.row(&row)?;
            }
        }
        file.finish()
    }

    /// A row a bin of a state at the end.
    fn histograms(&self, path: &Path) -> Result<(), Failure> {
        let complete = self.is_complete().to_string();
        let mut file = CsvFile::create(path)?;
        file.row(&["state", "unit", "low", "high", "members", COMPLETE])?;
        let last = self.outcome.snapshots.last();
        let states = last.into_iter().flat_map(|it| &it.states);
        for ((name, unit), state) in self.ready.vehicle.states.iter().zip(states) {
            for bin in &state.histogram {
                let [low, high] = [bin.low, bin.high].map(cell);
                let count = bin.count.to_string();
                file.row(&[name, unit, &low, &high, &count, &complete])?;
            }
        }
        file.finish()
    }

    /// A row a snapshot and state: shares of members that have left by then.
    fn limits(&self, path: &Path) -> Result<(), Failure> {
        let complete = self.is_complete().to_string();
        let mut file = CsvFile::create(path)?;
        file.row(&[
            "time [s]",
            "intervals",
            "state",
            "left",
            "left_low",
            "left_high",
            COMPLETE,
        ])?;
        for snapshot in &self.outcome.snapshots {
            for (set, intervals) in ["validity box", "limits"].into_iter().enumerate() {
                for (name, share) in self.left(snapshot, set).0 {
                    let [value, low, high] = cells(&Some(share).into());
                    file.row(&[
                        &cell(time(snapshot.time)),
                        intervals,
                        name,
                        &value,
                        &low,
                        &high,
                        &complete,
                    ])?;
                }
            }
        }
        file.finish()
    }
}
