//! The sections on Table 1 and Figs. 2 to 5.

use ahv_analysis::statistics::Estimate;
use ahv_cli::failure::Failure;

use super::figures;
use super::page::{Cell, Picture, Row, Section, Table};
use super::sentences::{self, Sentence, interval, p_value};
use super::{Findings, drawn};
use crate::commands::number::significant;
use crate::ensemble::{Drive, Reading};
use crate::reduce::{Comparison, Mode, Property, ReduceError, ReducedMode, Reduction, section_5_1};
use crate::reproduce::forced::Forced;
use crate::reproduce::p_value::{PValue, Verdict};
use crate::reproduce::printed::TABLE_1;
use crate::reproduce::snapshot::Snapshot;
use crate::reproduce::table1::{Case, CaseResult, FINE_PERIODS, ModeResult, Table1};
use crate::reproduce::{METHODS, Random};

fn name(case: &Case) -> String {
    let noise = match case.reading {
        Reading::White => "white noise",
        Reading::Held => "a number held for each step",
    };
    let drive = match case.drive {
        Drive::Common => "one noise for η and χ",
        Drive::Independent => "a noise each",
    };
    format!("{noise}, {drive}, {} runs", case.runs)
}

/// An entry of Table 1: its name, the printed value, and how to find ours.
struct Entry {
    name: String,
    printed: f64,
    mode: usize,
    deviation: bool,
}

impl Entry {
    fn all() -> Vec<Self> {
        let entries = TABLE_1.iter().enumerate().flat_map(|(mode, &(mean, std))| {
            let entry = |symbol, printed, deviation| Self {
                name: format!("|e{symbol}|, mode {}", mode + 1),
                printed,
                mode,
                deviation,
            };
            [entry("ᵐ", mean, false), entry("ᴰ", std, true)]
        });
        entries.collect()
    }

    fn of<'a>(&self, result: &'a CaseResult, method: usize) -> &'a Estimate {
        let ModeResult { mean, std, .. } = &result.modes[self.mode];
        if self.deviation {
            &std[method]
        } else {
            &mean[method]
        }
    }

    /// The printed value in the distribution of ours.
    fn p<'a>(&self, result: &'a CaseResult) -> &'a PValue {
        let ModeResult { mean_p, std_p, .. } = &result.modes[self.mode];
        if self.deviation { std_p } else { mean_p }
    }

    fn verdict(&self, result: &CaseResult) -> Verdict {
        self.p(result).verdict
    }

    /// The median over the printed value.
    fn ratio(&self, result: &CaseResult) -> f64 {
        self.of(result, 0).value / self.printed
    }
}

/// The case in which most entries are inside, and how many.
fn best(table: &Table1) -> Option<(&CaseResult, usize)> {
    let fits = |result: &CaseResult| {
        let entries = Entry::all().into_iter();
        let inside = entries.filter(|entry| entry.verdict(result) == Verdict::Inside);
        inside.count()
    };
    let scored = table.cases.iter().map(|result| (result, fits(result)));
    // The first of equals.
    scored.rev().max_by_key(|&(_, fits)| fits)
}

/// Intensity of the noise of section 5.1.
fn sigma() -> f64 {
    let [Mode { sigma, .. }, ..] = section_5_1();
    sigma
}

/// Table 1 and Fig. 2.
///
/// # Errors
///
/// [`Failure::Numeric`] if a picture cannot be drawn.
pub(super) fn table1(random: &Random, findings: &mut Findings) -> Result<Section, Failure> {
    let (table, size) = (&random.table1, &random.size);
    let [held, _, white, ..] = table.cases.as_slice() else {
        return Err(Failure::Numeric("Table 1 was not computed".to_owned()));
    };
    let rows = Entry::all().into_iter().map(|entry| {
        let mut cells = vec![Cell::words(entry.name.clone()), Cell::number(entry.printed)];
        for result in [held, white] {
            let ours = entry.of(result, 0);
            cells.extend([
                Cell::Number(interval(ours)),
                Cell::number(ours.value - entry.printed),
                Cell::Number(p_value(entry.p(result))),
                Cell::Inside(entry.verdict(result)),
            ]);
        }
        let why = why(&entry, table, size.dt);
        Row { cells, why }
    });
    let entries = Table {
        file: "table1.csv",
        caption: format!(
            "Table 1 beside the maxima over {} s: median [5 %, 95 %], difference, p-value and verdict",
            significant(size.steps as f64 * size.dt)
        ),
        head: vec![
            "entry",
            "printed",
            "held for a step",
            "difference",
            "p",
            "verdict",
            "white noise",
            "difference",
            "p",
            "verdict",
        ],
        rows: rows.collect(),
    };
    let fits = table.cases.iter().map(|result| {
        let mut row = vec![Cell::words(name(&result.case))];
        for entry in Entry::all() {
            row.push(Cell::Number(p_value(entry.p(result))));
            row.push(Cell::Inside(entry.verdict(result)));
        }
        Row::from(row)
    });
    let readings = Table {
        file: "table1_readings.csv",
        caption: "p-value of each printed entry, by reading".to_owned(),
        head: vec![
            "reading", "eᵐ 1", "", "eᴰ 1", "", "eᵐ 2", "", "eᴰ 2", "", "eᵐ 3", "", "eᴰ 3", "",
        ],
        rows: fits.collect(),
    };
    find(table, findings);
    let mut pictures = Vec::new();
    let captions = [
        (
            "fig2_held.svg",
            format!(
                "Fig. 2 with a number of N(0, {0}²) held for each step; exact curves show what lies between the samples in the first {FINE_PERIODS} steps.",
                sigma()
            ),
        ),
        (
            "fig2_white.svg",
            format!("Fig. 2 with white noise of intensity {}².", sigma()),
        ),
    ];
    for (curves, (file, caption)) in table.curves.iter().zip(captions) {
        pictures.push(Picture {
            file,
            caption: format!(
                "{caption} One experiment of {} runs; time is logarithmic.",
                size.runs
            ),
            svg: drawn(file, figures::errors(curves))?,
        });
    }
    Ok(Section {
        id: "table1",
        title: "Table 1 and Fig. 2",
        paragraphs: vec![
            sentences::readings(sigma(), size.dt),
            sentences::method(size),
        ],
        tables: vec![entries, readings],
        pictures,
    })
}

/// What explains an entry.
fn why(entry: &Entry, table: &Table1, dt: f64) -> Option<Sentence> {
    let [held, common, white, _, fewer] = table.cases.as_slice() else {
        return None;
    };
    Some(sentences::entry(&sentences::Entry {
        white_ratio: entry.ratio(white),
        exact: entry.deviation.then(|| exact_held(entry.mode, dt)),
        held: entry.of(held, 0),
        common: (entry.of(common, 0), entry.p(common)),
        fewer: (fewer.case.runs, entry.of(fewer, 0), entry.p(fewer)),
    }))
}

/// Greatest |eᴰ| of a mode for infinitely many runs with held noise: at the samples, and at any time.
fn exact_held(mode: usize, dt: f64) -> [f64; 2] {
    let reduced = section_5_1()
        .get(mode)
        .map(|&mode| ReducedMode::new(mode, Reduction::Printed));
    let peak = reduced.and_then(|reduced| reduced.ok()?.largest_std_error_held(dt).ok());
    peak.map_or([0.0; 2], |peak| [peak.at_samples, peak.between_samples])
}

/// What Table 1 shows in short.
fn find(table: &Table1, findings: &mut Findings) {
    let [held, _, white, ..] = table.cases.as_slice() else {
        return;
    };
    let facts = |result: &CaseResult, chosen: fn(&Entry) -> bool| -> (Vec<f64>, Vec<Verdict>) {
        let entries = Entry::all();
        let entries = entries.iter().filter(|entry| chosen(entry));
        entries
            .map(|entry| (entry.ratio(result), entry.verdict(result)))
            .unzip()
    };
    let (ratios, verdicts) = facts(held, |entry| entry.deviation);
    findings.push(sentences::deviations(&ratios, &verdicts));
    let (ratios, verdicts) = facts(white, |_| true);
    findings.push(sentences::white(sigma(), &ratios, &verdicts));
    let (_, verdicts) = facts(held, |entry| !entry.deviation);
    let best = best(table).map(|(result, fits)| (name(&result.case), fits));
    let best = best
        .as_ref()
        .map(|(name, fits)| (name.as_str(), *fits, Entry::all().len()));
    findings.push(sentences::means(held.case.runs, &verdicts, best));
}

/// Figs. 3 and 4.
///
/// # Errors
///
/// [`Failure::Numeric`] if a picture cannot be drawn.
pub(super) fn snapshot(snapshot: &Snapshot, findings: &mut Findings) -> Result<Section, Failure> {
    let mut rows = Vec::new();
    for (mode, of) in (1..).zip(&snapshot.modes) {
        for (method, chi) in METHODS.iter().zip(&of.methods) {
            let differs = chi.distance > chi.critical;
            rows.push(Row::from(vec![
                Cell::words(format!("{mode}")),
                Cell::words(method.name()),
                Cell::Number(interval(&of.eta_std.0)),
                Cell::number(of.eta_std.1),
                Cell::Number(interval(&chi.chi_std.0)),
                Cell::number(chi.chi_std.1),
                Cell::number(chi.distance),
                Cell::number(chi.critical),
                Cell::Verdict(!differs),
            ]));
        }
    }
    let kurtosis: Vec<f64> = snapshot.modes.iter().map(|of| of.eta_kurtosis).collect();
    findings.push(sentences::normality(
        &kurtosis,
        snapshot.runs,
        snapshot.time,
    ));
    let modes = snapshot.modes.iter().map(|of| {
        let [chi, ..] = &of.methods;
        let ratio = (chi.chi_std.1 / of.eta_std.1).powi(2);
        (chi.distance > chi.critical, ratio)
    });
    for finding in sentences::distributions(&modes.collect::<Vec<_>>(), snapshot.runs) {
        findings.push(finding);
    }
    Ok(Section {
        id: "fig3",
        title: "Figs. 3 and 4",
        paragraphs: vec![sentences::snapshot(sigma(), snapshot.time, snapshot.runs)],
        tables: vec![Table {
            file: "fig3.csv",
            caption: "Standard deviations with intervals of 95 %, and the distance of the distribution functions".to_owned(),
            head: vec![
                "mode", "reduction", "η sampled", "η exact", "χ sampled", "χ exact", "distance", "95 % point", "alike",
            ],
            rows,
        }],
        pictures: vec![
            Picture {
                file: "fig3.svg",
                caption: "Fig. 3: histograms and densities.".to_owned(),
                svg: drawn("fig3.svg", figures::histograms(snapshot))?,
            },
            Picture {
                file: "fig4.svg",
                caption: "Fig. 4: difference of the distribution functions. Between the dashed lines, two samples of one \
                          distribution stay with probability 95 %."
                    .to_owned(),
                svg: drawn("fig4.svg", figures::distributions(snapshot))?,
            },
        ],
    })
}

/// Fig. 5.
///
/// # Errors
///
/// [`Failure::Numeric`] if the picture cannot be drawn.
pub(super) fn forced(forced: &Forced, findings: &mut Findings) -> Result<Section, Failure> {
    let mut rows = Vec::new();
    for (reading, modes) in &forced.readings {
        for (mode, of) in (1..).zip(modes) {
            for (method, (error, exact)) in METHODS.iter().zip(&of.error_rms) {
                rows.push(Row::from(vec![
                    Cell::words(match reading {
                        Reading::White => "white",
                        Reading::Held => "held",
                    }),
                    Cell::words(format!("{mode}")),
                    Cell::words(method.name()),
                    Cell::number(of.eta_rms),
                    Cell::Number(interval(error)),
                    exact.map_or_else(|| Cell::words(""), Cell::number),
                    Cell::number(of.error_rms_without_noise),
                    Cell::Number(format!("{:.1} %", 100.0 * error.value / of.eta_rms)),
                ]));
            }
        }
    }
    let [(_, white), _] = &forced.readings;
    let shares = white.iter().map(|of| of.error_rms[0].0.value / of.eta_rms);
    findings.push(sentences::follows(&shares.collect::<Vec<_>>()));
    let lag = white.iter().map(|of| {
        let (sampled, exact) = of.error_rms[0];
        (of.error_rms_without_noise / exact.unwrap_or(sampled.value)).powi(2)
    });
    Ok(Section {
        id: "fig5",
        title: "Fig. 5",
        paragraphs: vec![sentences::forced(forced.runs, &lag.collect::<Vec<_>>())],
        tables: vec![Table {
            file: "fig5.csv",
            caption: "Root mean squares of η and of η̂ − η".to_owned(),
            head: vec![
                "noise",
                "mode",
                "reduction",
                "η",
                "η̂ − η",
                "exact",
                "without noise",
                "of η",
            ],
            rows,
        }],
        pictures: vec![Picture {
            file: "fig5.svg",
            caption: "Fig. 5: the first run.".to_owned(),
            svg: drawn("fig5.svg", figures::forced(forced))?,
        }],
    })
}

/// The three reductions on the tests of Table 1.
///
/// # Errors
///
/// [`Failure::Numeric`] if a mode has no reduction.
pub(super) fn reductions(random: &Random, findings: &mut Findings) -> Result<Section, Failure> {
    let [held, _, white, ..] = random.table1.cases.as_slice() else {
        return Err(Failure::Numeric("Table 1 was not computed".to_owned()));
    };
    let mut rows = Vec::new();
    let all = METHODS.map(|method| {
        let modes = section_5_1().into_iter();
        let reduced = modes.map(|mode| ReducedMode::new(mode, method));
        reduced.collect::<Result<Vec<ReducedMode>, ReduceError>>()
    });
    let all = all
        .into_iter()
        .collect::<Result<Vec<_>, _>>()
        .map_err(|error| Failure::Numeric(error.to_string()))?;
    for index in 0..section_5_1().len() {
        for (place, (method, reduced)) in METHODS.into_iter().zip(&all).enumerate() {
            let reduced = &reduced[index];
            let (held, white) = (&held.modes[index], &white.modes[index]);
            rows.push(Row::from(vec![
                Cell::words(format!("{}", index + 1)),
                Cell::words(method.name()),
                Cell::number(reduced.decay()),
                Cell::number(reduced.variance_ratio()),
                Cell::number(reduced.spectrum_ratio()),
                Cell::number(reduced.largest_std_errors().greatest.value),
                Cell::Number(interval(&held.mean[place])),
                Cell::Number(interval(&held.std[place])),
                Cell::Number(interval(&white.std[place])),
            ]));
        }
    }
    let mut paragraphs = Vec::new();
    let mut keepers = Vec::new();
    for (method, modes) in METHODS.into_iter().zip(&all) {
        let modes: Vec<_> = modes.iter().map(ReducedMode::comparisons).collect();
        paragraphs.push(sentences::kept(method.name(), &modes));
        let variance = |it: &Comparison| it.property == Property::Variance && it.kept;
        if modes.iter().all(|mode| mode.iter().any(variance)) {
            keepers.push(method.name());
        }
    }
    let names = METHODS.map(|method| method.name());
    let greatest = |reduced: &ReducedMode| reduced.largest_std_errors().greatest.value;
    let of_mode = |mode: usize| all.iter().filter_map(move |it| it.get(mode));
    let modes = (0..section_5_1().len()).map(|mode| of_mode(mode).map(greatest).collect());
    paragraphs.push(sentences::least_errors(&names, &modes.collect::<Vec<_>>()));
    let errors = all.iter().take(1).flatten();
    let errors: Vec<_> = errors.map(ReducedMode::largest_std_errors).collect();
    paragraphs.push(sentences::differ(&errors));
    let ratios = all.iter().take(1).flatten();
    let ratios: Vec<f64> = ratios.map(ReducedMode::variance_ratio).collect();
    findings.push(sentences::variances(&ratios, &keepers));
    Ok(Section {
        id: "reductions",
        title: "Three reductions",
        paragraphs,
        tables: vec![Table {
            file: "reductions.csv",
            caption: "Three reductions: stationary ratios χ to η in closed form, and the tests of Table 1".to_owned(),
            head: vec![
                "mode",
                "reduction",
                "a [1/s]",
                "variance",
                "spectrum at 0",
                "max |eᴰ|, white, exact",
                "max |eᵐ|, held",
                "max |eᴰ|, held",
                "max |eᴰ|, white",
            ],
            rows,
        }],
        pictures: Vec::new(),
    })
}
