//! The sections on Table 1 and Figs. 2 to 5.

use ahv_analysis::ensemble::{Drive, Reading};
use ahv_analysis::reduce::{ReducedMode, Reduction, section_5_1};
use ahv_analysis::reproduce::forced::Forced;
use ahv_analysis::reproduce::printed::TABLE_1;
use ahv_analysis::reproduce::snapshot::Snapshot;
use ahv_analysis::reproduce::table1::{Case, CaseResult, ModeResult, Table1};
use ahv_analysis::reproduce::{METHODS, Random};
use ahv_analysis::statistics::Estimate;

use super::figures;
use super::page::{Cell, Picture, Section, Table, number};
use super::{Findings, drawn};
use crate::failure::Failure;

/// An estimate with its interval.
fn interval(estimate: &Estimate) -> String {
    let [value, low, high] = [estimate.value, estimate.low, estimate.high].map(number);
    format!("{value} [{low}, {high}]")
}

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

    fn fits(&self, result: &CaseResult) -> bool {
        self.of(result, 0).holds(self.printed)
    }
}

/// Cases whose interval holds every entry, or as many as any does.
fn best(table: &Table1) -> Option<(&CaseResult, usize)> {
    let fits = |result: &CaseResult| {
        Entry::all()
            .iter()
            .filter(|entry| entry.fits(result))
            .count()
    };
    let scored = table.cases.iter().map(|result| (result, fits(result)));
    // The first of equals.
    scored.rev().max_by_key(|&(_, fits)| fits)
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
        let (ours, of_white) = (entry.of(held, 0), entry.of(white, 0));
        vec![
            Cell::words(entry.name.clone()),
            Cell::number(entry.printed),
            Cell::Number(interval(ours)),
            Cell::number(ours.value - entry.printed),
            Cell::Verdict(ours.holds(entry.printed)),
            Cell::Number(interval(of_white)),
            Cell::number(of_white.value - entry.printed),
            Cell::Verdict(of_white.holds(entry.printed)),
            Cell::words(why(&entry, table, size.dt)),
        ]
    });
    let entries = Table {
        file: "table1.csv",
        caption: format!(
            "Table 1 beside the maxima over {} s of {} experiments: median [5 %, 95 %]",
            size.steps as f64 * size.dt,
            size.repeats
        ),
        head: vec![
            "entry",
            "printed",
            "held for a step",
            "difference",
            "inside",
            "white noise",
            "difference",
            "inside",
            "why",
        ],
        rows: rows.collect(),
    };
    let fits = table.cases.iter().map(|result| {
        let mut row = vec![Cell::words(name(&result.case))];
        row.extend(
            Entry::all()
                .iter()
                .map(|entry| Cell::Verdict(entry.fits(result))),
        );
        row
    });
    let readings = Table {
        file: "table1_readings.csv",
        caption: "Does the interval hold the printed entry?".to_owned(),
        head: vec!["reading", "eᵐ 1", "eᴰ 1", "eᵐ 2", "eᴰ 2", "eᵐ 3", "eᴰ 3"],
        rows: fits.collect(),
    };
    find(table, findings);
    let mut pictures = Vec::new();
    let captions = [
        (
            "fig2_held.svg",
            "Fig. 2 with a number of N(0, 100²) held for each step.",
        ),
        (
            "fig2_white.svg",
            "Fig. 2 with white noise of intensity 100². Table 1's maxima are a tenth of these.",
        ),
    ];
    for (curves, (file, caption)) in table.curves.iter().zip(captions) {
        pictures.push(Picture {
            file,
            caption: format!("{caption} One experiment of {} runs.", size.runs),
            svg: drawn(file, figures::errors(curves))?,
        });
    }
    Ok(Section {
        id: "table1",
        title: "Table 1 and Fig. 2",
        paragraphs: vec![
            format!(
                "ξ ~ N(0, 100² δ(t)) can be read in two ways: as white noise of intensity 100², or, as programs often have it, as \
                 a number of N(0, 100²) drawn every {} s and held, whose intensity is 100²·{}. The paper does not state the step, \
                 nor whether η and χ have one noise or a noise each.",
                size.dt, size.dt
            ),
            "An entry is a maximum over time, so a single number proves little: each is set beside the distribution of that \
             maximum over repeated experiments. Processes start at rest, and steps are exact in law."
                .to_owned(),
        ],
        tables: vec![entries, readings],
        pictures,
    })
}

/// One sentence on a difference.
fn why(entry: &Entry, table: &Table1, dt: f64) -> String {
    let [held, common, white, _, fewer] = table.cases.as_slice() else {
        return String::new();
    };
    let inside = |result: &CaseResult| entry.of(result, 0).holds(entry.printed);
    let ratio = entry.of(white, 0).value / entry.printed;
    let tenth = format!("White noise gives {ratio:.1} times the printed value");
    if entry.deviation {
        let [exact, between] = exact_held(entry.mode, dt).map(number);
        return format!(
            "{tenth}; held numbers give {exact} at the samples and {between} between them with infinitely many runs."
        );
    }
    if inside(held) {
        return format!("{tenth}.");
    }
    let verdict = if inside(fewer) { "inside" } else { "outside" };
    format!(
        "{tenth}. With {} runs held numbers give {} ({verdict}); one noise for both makes it smaller still: {}.",
        fewer.case.runs,
        interval(entry.of(fewer, 0)),
        number(entry.of(common, 0).value)
    )
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
    let count = Entry::all().len();
    let [held, _, white, ..] = table.cases.as_slice() else {
        return;
    };
    let deviations: Vec<Entry> = Entry::all()
        .into_iter()
        .filter(|entry| entry.deviation)
        .collect();
    let inside = deviations.iter().filter(|entry| entry.fits(held)).count();
    let off = deviations
        .iter()
        .map(|entry| (entry.of(held, 0).value / entry.printed - 1.0).abs());
    findings.agrees.push(format!(
        "Table 1, standard deviations, if the noise is a number held for each step: medians within {:.0} % of the printed \
         values, {inside} of {} inside the interval.",
        100.0 * off.fold(0.0, f64::max),
        deviations.len()
    ));
    findings.cannot.push(format!(
        "Table 1 with white noise of intensity 100², as the text has it: {} of {count} entries fit; the printed ones are about a tenth.",
        Entry::all().iter().filter(|entry| entry.fits(white)).count()
    ));
    let means = Entry::all().into_iter().filter(|entry| !entry.deviation);
    let missed = means.filter(|entry| !entry.fits(held)).count();
    if let (true, Some((result, fits))) = (missed > 0, best(table)) {
        findings.cannot.push(format!(
            "Table 1, means: {missed} of 3 do not fit {} runs. Most entries ({fits} of {count}) fit this reading: {}.",
            held.case.runs,
            name(&result.case)
        ));
    }
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
            rows.push(vec![
                Cell::words(format!("{mode}")),
                Cell::words(method.name()),
                Cell::Number(interval(&of.eta_std.0)),
                Cell::number(of.eta_std.1),
                Cell::Number(interval(&chi.chi_std.0)),
                Cell::number(chi.chi_std.1),
                Cell::number(chi.distance),
                Cell::number(chi.critical),
                Cell::Verdict(!differs),
            ]);
        }
    }
    let told: Vec<String> = (1..)
        .zip(&snapshot.modes)
        .filter(|(_, of)| of.methods[0].distance > of.methods[0].critical)
        .map(|(mode, _): (u32, _)| mode.to_string())
        .collect();
    if told.len() < snapshot.modes.len() {
        findings.agrees.push(format!(
            "Figs. 3 and 4: η and χ are normal at {} s, and for {} of 3 modes {} runs do not tell their distributions apart.",
            snapshot.time,
            snapshot.modes.len() - told.len(),
            snapshot.runs
        ));
    }
    if !told.is_empty() {
        findings.cannot.push(format!(
            "Figs. 3 and 4, \"very close\": in mode {} the {} runs do tell χ of (23) from η, for its variance is 2ζ² of the mode's.",
            told.join(" and "),
            snapshot.runs
        ));
    }
    Ok(Section {
        id: "fig3",
        title: "Figs. 3 and 4",
        paragraphs: vec![format!(
            "Distributions at {} s over {} runs under white noise of intensity 100²; held numbers give the same shapes, a tenth as \
             wide. η and χ have a noise each, as the test of Kolmogorov and Smirnov asks. The text of the paper prints no \
             numbers for these figures: ours stand beside the closed forms.",
            snapshot.time, snapshot.runs
        )],
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
                rows.push(vec![
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
                ]);
            }
        }
    }
    let [(_, white), _] = &forced.readings;
    let shares = white
        .iter()
        .map(|of| format!("{:.0} %", 100.0 * of.error_rms[0].0.value / of.eta_rms));
    findings.agrees.push(format!(
        "Fig. 5: under the input (37) η̂ of (25) follows η; its error is {} of η (root mean square, modes 1 to 3, white noise).",
        shares.collect::<Vec<_>>().join(", ")
    ));
    Ok(Section {
        id: "fig5",
        title: "Fig. 5",
        paragraphs: vec![format!(
            "Generalized forces of (37): a sine of 1 rad/s with noise. η follows (5), η̂ = N/ω² + χ follows (25), both with one \
             noise. The quasi-static part has no lag, which in mode 1 makes most of the error. The text of the paper prints no \
             numbers for this figure: root mean squares over the last period, of {} runs with intervals of 95 %, stand beside \
             closed forms.",
            forced.runs
        )],
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
    for (index, mode) in section_5_1().into_iter().enumerate() {
        for (place, method) in METHODS.into_iter().enumerate() {
            let reduced = ReducedMode::new(mode, method)
                .map_err(|error| Failure::Numeric(error.to_string()))?;
            let (held, white) = (&held.modes[index], &white.modes[index]);
            rows.push(vec![
                Cell::words(format!("{}", index + 1)),
                Cell::words(method.name()),
                Cell::number(reduced.decay()),
                Cell::number(reduced.variance_ratio()),
                Cell::number(reduced.spectrum_ratio()),
                Cell::number(reduced.largest_std_errors().greatest.value),
                Cell::Number(interval(&held.mean[place])),
                Cell::Number(interval(&held.std[place])),
                Cell::Number(interval(&white.std[place])),
            ]);
        }
    }
    let losers: Vec<String> = section_5_1()
        .into_iter()
        .map(|mode| {
            ReducedMode::new(mode, Reduction::Printed).map(|reduced| reduced.variance_ratio())
        })
        .map(|ratio| ratio.map_or_else(|error| error.to_string(), number))
        .collect();
    findings.cannot.push(format!(
        "The reduction (23) has {} of the variances of the modes of (36); two others have all of it.",
        losers.join(", ")
    ));
    Ok(Section {
        id: "reductions",
        title: "Better reductions",
        paragraphs: vec![
            "printed is (23): a = ζω, b = ζσ/ω keep decay rate and gain at zero frequency, and miss the variance by 2ζ². \
             variance, a = ζω and b = σ/(√2 ω), keeps decay rate and variance, and raises the spectrum at zero frequency by \
             1/(2ζ²). moment, a = ω/(2ζ) and b = σ/(2ζω), keeps variance and gain, and is faster than the mode. From rest, \
             none follows the rise of η, for an Ornstein–Uhlenbeck process starts with t and the mode with t³: the greatest \
             error stands in that rise, and is no measure of the stationary noise."
                .to_owned(),
        ],
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
