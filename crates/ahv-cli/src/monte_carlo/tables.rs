//! The files of `ahv montecarlo`.

use std::path::Path;

use ahv_analysis::monte_carlo::{Flown, QUANTILES};
use ahv_analysis::statistics::QuantileEstimate;
use ahv_core::Vector;

use super::{Told, figure, trajectories};
use crate::csv_file::CsvFile;
use crate::failure::Failure;
use crate::flights::Pair;
use crate::output;

/// Cells of an estimate; empty where there is none, or a side is open.
fn cells(estimate: &QuantileEstimate) -> [String; 3] {
    [estimate.value, estimate.low, estimate.high]
        .map(|number| number.map_or_else(String::new, |number| number.to_string()))
}

impl<F: Flown, M: Pair<F>> Told<'_, F, M> {
    /// Writes all files.
    pub(super) fn write(&self, folder: &Path) -> Result<(), Failure> {
        let svg = figure::draw(self).map_err(|error| Failure::Numeric(error.to_string()))?;
        output::write(&folder.join("montecarlo.svg"), svg)?;
        output::write(
            &folder.join("summary.json"),
            output::json(&self.json())? + "\n",
        )?;
        self.snapshots(&folder.join("snapshots.csv"))?;
        self.histograms(&folder.join("histograms.csv"))?;
        self.limits(&folder.join("limits.csv"))?;
        trajectories::write(self, folder)
    }

    /// A row a snapshot and state.
    fn snapshots(&self, path: &Path) -> Result<(), Failure> {
        let mut file = CsvFile::create(path)?;
        let mut heading: Vec<String> = ["time [s]", "members", "state", "unit"]
            .map(str::to_owned)
            .to_vec();
        let shares = QUANTILES.map(|share| format!("quantile_{share}"));
        for name in ["mean", "std"].map(str::to_owned).iter().chain(&shares) {
            heading.extend([name.clone(), format!("{name}_low"), format!("{name}_high")]);
        }
        file.row(&heading)?;
        let units = self.ready.vehicle.units.labels::<M::State>();
        for snapshot in &self.outcome.snapshots {
            for ((name, unit), state) in M::State::NAMES.iter().zip(units).zip(&snapshot.states) {
                let mut row = vec![
                    snapshot.time.to_string(),
                    snapshot.members.to_string(),
                    (*name).to_owned(),
                    (*unit).to_owned(),
                ];
                let moments = [state.mean, state.std].map(QuantileEstimate::from);
                row.extend(moments.iter().chain(&state.quantiles).flat_map(cells));
                file.row(&row)?;
            }
        }
        file.finish()
    }

    /// A row a bin of a state at the end.
    fn histograms(&self, path: &Path) -> Result<(), Failure> {
        let mut file = CsvFile::create(path)?;
        file.row(&["state", "unit", "low", "high", "members"])?;
        let units = self.ready.vehicle.units.labels::<M::State>();
        let last = self.outcome.snapshots.last();
        let states = last.into_iter().flat_map(|it| &it.states);
        for ((name, unit), state) in M::State::NAMES.iter().zip(units).zip(states) {
            for bin in &state.histogram {
                let [low, high] = [bin.low, bin.high].map(|edge| edge.to_string());
                file.row(&[*name, *unit, &low, &high, &bin.count.to_string()])?;
            }
        }
        file.finish()
    }

    /// A row a snapshot and state: shares of members that have left by then.
    fn limits(&self, path: &Path) -> Result<(), Failure> {
        let mut file = CsvFile::create(path)?;
        file.row(&[
            "time [s]",
            "intervals",
            "state",
            "left",
            "left_low",
            "left_high",
        ])?;
        for snapshot in &self.outcome.snapshots {
            for (set, intervals) in ["validity box", "limits"].into_iter().enumerate() {
                for (name, share) in self.left(snapshot, set).0 {
                    let [value, low, high] = cells(&Some(share).into());
                    file.row(&[
                        &snapshot.time.to_string(),
                        intervals,
                        name,
                        &value,
                        &low,
                        &high,
                    ])?;
                }
            }
        }
        file.finish()
    }
}
