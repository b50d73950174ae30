//! Samples that are drawn from a source such as a model from first principles.

use std::sync::atomic::Ordering;
use std::sync::{Mutex, PoisonError};

use ahv_analysis::ordered::in_order;
use ahv_fit::{Ask, Sampler, Source, latin_hypercube};
use ahv_table::Text;

use super::plan::Plan;
use super::samples::Columns;
use crate::failure::Failure;
use crate::names;
use crate::progress::{Progress, Work};
use crate::signals::Stoppable;

/// Points that are computed at a time.
const CHUNK: usize = 1024;

static SOURCES: Mutex<Vec<&'static dyn Source>> = Mutex::new(Vec::new());

/// Makes `ahv fit --from` know a source; one of a name that is known takes its place.
pub fn offer(source: &'static dyn Source) {
    let mut sources = SOURCES.lock().unwrap_or_else(PoisonError::into_inner);
    sources.retain(|it| it.name() != source.name());
    sources.push(source);
}

/// What is drawn.
pub(super) struct Draw<'a> {
    /// Name of the source.
    pub(super) from: &'a str,
    pub(super) samples: usize,
    pub(super) seed: u64,
    /// Intervals in the place of the source's, e.g. `alpha=-1deg:5deg`.
    pub(super) intervals: &'a [String],
}

impl Draw<'_> {
    /// Draws the samples of a plan.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for an unknown source, variable or interval; [`Failure::Numeric`] if fewer than half of the points have
    /// samples; [`Failure::Interrupted`] by a signal.
    pub(super) fn columns(&self, plan: &Plan, text: &Text) -> Result<Columns, Failure> {
        let sampler = self.sampler(plan, text).map_err(|why| {
            Failure::Request(format!("--from {}: {why}", names::printable(self.from)))
        })?;
        let variables = sampler.variables();
        let mut intervals: Vec<(f64, f64)> = variables.iter().map(|it| it.interval).collect();
        for text in self.intervals {
            let failed =
                |why| Failure::Request(format!("--box `{}`: {why}", names::printable(text)));
            let (index, interval) = interval(&*sampler, text).map_err(failed)?;
            intervals[index] = interval;
        }
        let unit = latin_hypercube(variables.len(), self.samples, self.seed);
        let columns = unit.iter().zip(&intervals);
        let columns = columns.map(|(column, (low, high))| {
            let place = |share: &f64| low + share * (high - low);
            column.iter().map(place).collect::<Vec<f64>>()
        });
        let columns: Vec<Vec<f64>> = columns.collect();
        let computed = self.computed(&*sampler, &columns)?;
        let sound: Vec<usize> = (0..self.samples)
            .filter(|&row| computed[row].is_ok())
            .collect();
        if 2 * sound.len() < self.samples {
            let first = computed.iter().find_map(|it| it.as_ref().err());
            return Err(Failure::Numeric(format!(
                "--from {}: only {} of {} points of the box have samples; the first that has none: {}; narrow the box with --box",
                self.from,
                sound.len(),
                self.samples,
                first.map_or("", String::as_str)
            )));
        }
        let pick = |column: &[f64]| sound.iter().map(|&row| column[row]).collect::<Vec<f64>>();
        let own = plan.variables.iter().map(|wanted| {
            let known = variables.iter().position(|it| it.name == wanted.name);
            known.map_or_else(|| vec![0.0; sound.len()], |it| pick(&columns[it]))
        });
        let rows: Vec<&Vec<f64>> = computed.iter().flatten().collect();
        let responses =
            (0..plan.quantities.len()).map(|it| rows.iter().map(|row| row[it]).collect());
        Ok(Columns {
            variables: own.collect(),
            responses: responses.collect(),
            quantities: (0..plan.quantities.len()).collect(),
            weights: None,
            origin: format!(
                "{} ({} of {} points of a Latin hypercube, seed {})",
                self.from,
                sound.len(),
                self.samples,
                self.seed
            ),
            drawn: variables.iter().map(|it| it.name).zip(intervals).collect(),
        })
    }

    fn sampler(&self, plan: &Plan, text: &Text) -> Result<Box<dyn Sampler>, String> {
        let sources = SOURCES.lock().unwrap_or_else(PoisonError::into_inner);
        let known: Vec<&str> = sources.iter().map(|it| it.name()).collect();
        let source = sources.iter().find(|it| it.name() == self.from);
        let source =
            source.ok_or_else(|| names::unknown("source of samples", self.from, &known))?;
        let table = plan.family.table;
        if text.item(&["table", "units"]).and_then(|it| it.as_str()) != Some("ft-slug-s-rad") {
            return Err("the table must be in ft-slug-s-rad".to_owned());
        }
        let parameter = |name: &str| {
            let index = plan.family.names.iter().position(|it| *it == name)?;
            let entry = table.entries.get(index)?;
            let value = text.item(&[entry.section, entry.key, "value"])?;
            value
                .as_float()
                .or_else(|| value.as_integer().map(|it| it as f64))
        };
        let quantities: Vec<&str> = plan.quantities.iter().map(|it| it.fit.section).collect();
        let variables: Vec<&str> = plan.variables.iter().map(|it| it.name).collect();
        source.sampler(&Ask {
            quantities: &quantities,
            variables: &variables,
            parameter: &parameter,
        })
    }

    /// The quantities at all points.
    fn computed(
        &self,
        sampler: &dyn Sampler,
        columns: &[Vec<f64>],
    ) -> Result<Vec<Result<Vec<f64>, String>>, Failure> {
        let progress = Progress::start(Work {
            command: "fit",
            unit: "samples",
            total: Some(self.samples as u64),
        });
        let control = progress.control();
        let stoppable = Stoppable::new(control);
        let chunk = |start: usize| {
            if control.stop.load(Ordering::Relaxed) {
                return Ok::<_, Failure>(None);
            }
            let rows = start..(start + CHUNK).min(self.samples);
            let count = rows.len() as u64;
            let at = |row: usize| {
                let point: Vec<f64> = columns.iter().map(|it| it[row]).collect();
                sampler.at(&point)
            };
            let done = rows.map(at).collect::<Vec<_>>();
            control.done.fetch_add(count, Ordering::Relaxed);
            Ok(Some(done))
        };
        let chunks = in_order((0..self.samples).step_by(CHUNK), chunk)?;
        drop(stoppable);
        let all: Vec<_> = chunks.into_iter().flatten().collect();
        if all.len() < self.samples {
            return Err(Failure::Interrupted(
                "interrupted; nothing was written".to_owned(),
            ));
        }
        Ok(all)
    }
}

/// Reads `NAME=MIN:MAX`, angles with a unit.
fn interval(sampler: &dyn Sampler, text: &str) -> Result<(usize, (f64, f64)), String> {
    let known: Vec<&str> = sampler.variables().iter().map(|it| it.name).collect();
    let (name, ends) = text.split_once('=').ok_or("write NAME=MIN:MAX")?;
    let index = known.iter().position(|it| *it == name.trim());
    let index = index.ok_or_else(|| names::unknown("variable", name.trim(), &known))?;
    let variable = &sampler.variables()[index];
    let (low, high) = ends.split_once(':').ok_or("write NAME=MIN:MAX")?;
    let end = |text: &str| {
        let text = text.trim();
        let angle = variable.unit.starts_with("rad");
        let (number, factor) = match (text.strip_suffix("deg"), text.strip_suffix("rad")) {
            (Some(number), _) if angle => (number, ahv_table::Unit::DEGREE),
            (None, Some(number)) if angle => (number, 1.0),
            _ if angle => return Err(format!("`{text}` needs a unit: deg or rad")),
            _ => (text.strip_suffix(variable.unit).unwrap_or(text), 1.0),
        };
        let number = number
            .trim()
            .parse::<f64>()
            .ok()
            .filter(|it| it.is_finite());
        number
            .map(|it| it * factor)
            .ok_or_else(|| format!("`{text}` is not a number in {}", variable.unit))
    };
    let (low, high) = (end(low)?, end(high)?);
    match low <= high {
        true => Ok((index, (low, high))),
        false => Err("MIN is above MAX".to_owned()),
    }
}
