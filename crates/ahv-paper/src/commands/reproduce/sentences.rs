//! Every explaining sentence of the page, made from computed facts.
//!
//! A [`Sentence`] can be made in this module only, so that no section can claim what was not computed. The tests go through
//! all functions, with facts for and against.

mod table1;
mod table3;

use std::fmt;

use ahv_analysis::statistics::Estimate;
use ahv_core::{Provenance, Status};

use crate::commands::number::significant;
use crate::commands::reduce::{bargain, greatest};
use crate::reduce::{Comparison, StdErrors};
use crate::reproduce::Size;
use crate::reproduce::p_value::{LEVEL, PValue, Verdict};
pub(super) use table1::*;
pub(super) use table3::*;

/// Largest error, as a share of η, with which η̂ counts as following it.
const FOLLOWS: f64 = 0.25;
/// Largest relative distance of a trim, or of a pole, that counts as agreement.
const AGREES: f64 = 0.02;
/// Normal quantile of a 95 % test of three modes at once.
const THREE_MODES: f64 = 2.394;

/// A sentence on the page.
#[derive(Debug)]
pub(super) struct Sentence(String);

/// A sentence of the summary.
pub(super) struct Finding {
    /// Whether the paper and the computation agree in it.
    pub(super) agrees: bool,
    pub(super) sentence: Sentence,
}

impl fmt::Display for Sentence {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl Sentence {
    /// The text.
    pub(super) fn text(&self) -> &str {
        &self.0
    }
}

const fn finding(agrees: bool, text: String) -> Finding {
    Finding {
        agrees,
        sentence: Sentence(text),
    }
}

/// An estimate with its interval.
pub(super) fn interval(estimate: &Estimate) -> String {
    let [value, low, high] = [estimate.value, estimate.low, estimate.high].map(significant);
    format!("{value} [{low}, {high}]")
}

/// A p-value with its standard error.
pub(super) fn p_value(p: &PValue) -> String {
    format!("{:.3} ± {:.3}", p.value, p.std_error)
}

/// A verdict in a word.
pub(super) const fn verdict(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Inside => "inside",
        Verdict::Outside => "outside",
        Verdict::Undecided => "undecided",
    }
}

fn list(items: &[String]) -> String {
    match items {
        [] => "none".to_owned(),
        [one] => one.clone(),
        [items @ .., last] => format!("{} and {last}", items.join(", ")),
    }
}

fn percent(share: f64) -> String {
    format!("{} %", significant(100.0 * share))
}

fn count(verdicts: &[Verdict]) -> String {
    let kinds = [Verdict::Inside, Verdict::Outside, Verdict::Undecided];
    let counts = kinds.map(|kind| (kind, verdicts.iter().filter(|&&it| it == kind).count()));
    let counts = counts.iter().filter(|&&(_, count)| count > 0);
    let words = counts.map(|&(kind, count)| format!("{count} {}", verdict(kind)));
    list(&words.collect::<Vec<_>>())
}

/// What the page is about.
pub(super) fn subject(size: &Size) -> Sentence {
    Sentence(format!(
        "Tables 1 to 3 and figures 2 to 6 of \"Stochastic Control-Oriented Modeling of Flexible Air-Breathing Hypersonic \
         Vehicle\", each beside what this project computes. Steps of {} s over {} s, seed {}. Units are foot, slug, second; η is \
         in (ft·slug)^½. Only the numbers that the paper prints are compared, not its pictures.",
        size.dt,
        significant(size.steps as f64 * size.dt),
        size.seed
    ))
}

/// The two readings of the noise.
pub(super) fn readings(sigma: f64, dt: f64) -> Sentence {
    Sentence(format!(
        "ξ ~ N(0, {sigma}² δ(t)) has two readings: white noise of intensity {sigma}², or a number of N(0, {sigma}²) drawn every \
         {dt} s and held, whose intensity is {sigma}²·{dt}. The paper states neither the step, nor whether η and χ have one \
         noise or a noise each."
    ))
}

/// How verdicts on Table 1 are found.
pub(super) fn method(size: &Size) -> Sentence {
    Sentence(format!(
        "An entry of Table 1 is a maximum over time of one experiment. Each is compared with the distribution of that maximum over {} \
         to {} experiments, which are drawn from the exact law of sample mean and standard deviation. p is the two-sided p-value \
         with its standard error. An entry is inside if p is above {LEVEL} (it lies between the 5 % and 95 % points), outside if p is \
         below. The verdict is that of the whole interval of p (99.9 %), else it is undecided; experiments are doubled until it \
         stands. Processes start at rest.",
        size.repeats,
        size.most_repeats.max(size.repeats)
    ))
}

/// How Figs. 3 and 4 are made.
pub(super) fn snapshot(sigma: f64, time: f64, runs: u64) -> Sentence {
    Sentence(format!(
        "Distributions at {} s over {runs} runs under white noise of intensity {sigma}². η and χ have a noise each, as the test of \
         Kolmogorov and Smirnov requires. The text of the paper prints no numbers for these figures: ours stand beside the closed \
         forms.",
        significant(time)
    ))
}

/// Whether η is normal, by its excess kurtosis in each mode.
pub(super) fn normality(kurtosis: &[f64], runs: u64, time: f64) -> Finding {
    let bound = THREE_MODES * (24.0 / runs as f64).sqrt();
    let normal = kurtosis.iter().all(|kurtosis| kurtosis.abs() < bound);
    let values: Vec<String> = kurtosis.iter().map(|&it| significant(it)).collect();
    finding(
        normal,
        format!(
            "Figs. 3 and 4: the excess kurtosis of η at {} s is {}, {} ±{}, where 95 % of normal samples as large lie in all \
             three modes.",
            significant(time),
            list(&values),
            if normal {
                "all within"
            } else {
                "not all within"
            },
            significant(bound)
        ),
    )
}

/// Whether the runs distinguish η from χ of (23): by mode, whether they do, and the ratio of the variances.
pub(super) fn distributions(modes: &[(bool, f64)], runs: u64) -> Vec<Finding> {
    let of = |differs: bool| -> Vec<String> {
        let modes = (1..).zip(modes).filter(|(_, mode)| mode.0 == differs);
        modes
            .map(|(number_of, mode): (u32, _)| {
                format!("mode {number_of} ({} of the variance)", significant(mode.1))
            })
            .collect()
    };
    let mut findings = Vec::new();
    for (differs, words) in [(false, "do not distinguish"), (true, "distinguish")] {
        let modes = of(differs);
        if !modes.is_empty() {
            findings.push(finding(
                !differs,
                format!(
                    "Figs. 3 and 4: {runs} runs {words} the distributions of η and of χ of (23) in {}.",
                    list(&modes)
                ),
            ));
        }
    }
    findings
}

/// How Fig. 5 is made, and what part of the mean square error the missing lag makes, by mode.
pub(super) fn forced(runs: u64, lag: &[f64]) -> Sentence {
    let lag: Vec<String> = lag.iter().map(|&share| percent(share)).collect();
    Sentence(format!(
        "Generalized forces of (37): a sine of 1 rad/s with noise. η follows (5), η̂ = N/ω² + χ follows (25), both with one noise. \
         The quasi-static part N/ω² has no lag, which makes {} of the mean square error in modes 1 to 3 (white noise, closed \
         form). The text of the paper prints no numbers for this figure: root mean squares over the last period, of {runs} runs \
         with intervals of 95 %, stand beside closed forms.",
        list(&lag)
    ))
}

/// Whether η̂ follows η: its error over η, by mode.
pub(super) fn follows(shares: &[f64]) -> Finding {
    let follows = shares.iter().all(|&share| share < FOLLOWS);
    let words: Vec<String> = shares.iter().map(|&share| percent(share)).collect();
    finding(
        follows,
        format!(
            "Fig. 5: under the input (37) η̂ of (25) {} η within {}; its error is {} of η (root mean square, modes 1 to 3, white \
             noise).",
            if follows {
                "follows"
            } else {
                "does not follow"
            },
            percent(FOLLOWS),
            list(&words)
        ),
    )
}

/// What a reduction keeps in each mode.
pub(super) fn kept(method: &str, modes: &[[Comparison; 3]]) -> Sentence {
    let modes = (1..).zip(modes);
    let modes =
        modes.map(|(number, mode): (u32, _)| format!("n mode {number} it {}", bargain(mode)));
    let modes: Vec<String> = modes.collect();
    Sentence(format!("{method}: i{}.", modes.join(". I")))
}

/// Where the deviations of η and χ of (23) differ most, by mode.
pub(super) fn differ(modes: &[StdErrors]) -> Sentence {
    let modes = (1..).zip(modes);
    let modes =
        modes.map(|(number, errors): (u32, _)| format!("n mode {number} {}", greatest(errors)));
    let modes: Vec<String> = modes.collect();
    Sentence(format!(
        "From rest, the standard deviation of χ starts with √t and that of η with t^³⁄². With printed and white noise, i{}.",
        modes.join(". I")
    ))
}

/// The method of the least greatest |eᴰ| of exact white noise, by mode; errors stand in the order of the methods.
pub(super) fn least_errors(methods: &[&str], modes: &[Vec<f64>]) -> Sentence {
    let least = |errors: &Vec<f64>| {
        let pairs = methods.iter().zip(errors);
        let least = pairs.min_by(|a, b| a.1.total_cmp(b.1));
        least.map_or("", |(method, _)| *method)
    };
    let modes = (1..).zip(modes);
    let modes = modes.map(|(mode, errors): (u32, _)| format!("{} in mode {mode}", least(errors)));
    Sentence(format!(
        "Of the three, the greatest |eᴰ| of exact white noise is least with {}.",
        list(&modes.collect::<Vec<_>>())
    ))
}

/// The variances that (23) leaves, by mode, and the methods that keep them.
pub(super) fn variances(ratios: &[f64], keepers: &[&str]) -> Finding {
    let agrees = ratios.iter().all(|ratio| (ratio - 1.0).abs() < AGREES);
    let values: Vec<String> = ratios.iter().map(|&it| significant(it)).collect();
    let keepers: Vec<String> = keepers.iter().map(|&it| it.to_owned()).collect();
    finding(
        agrees,
        format!(
            "χ of (23) has {} of the variances of the modes of (36); reductions that keep all of them: {}.",
            list(&values),
            list(&keepers)
        ),
    )
}

/// How near the nearest trim is to Table 2: the largest relative difference of α, φ, δe.
pub(super) fn nearest_trim(distance: f64, name: &str) -> Finding {
    let agrees = distance < AGREES;
    finding(
        agrees,
        format!(
            "Table 2: {} with the tables of this project trims within {} of the printed α, φ, δe; {name} comes nearest, within {}.",
            if agrees { "a model" } else { "no model" },
            percent(AGREES),
            percent(distance)
        ),
    )
}

/// The difference that is the greatest share of its row, and that share: both are largest magnitudes over the box.
pub(super) fn printed_form(name: &str, share: f64) -> Finding {
    let agrees = share < AGREES;
    finding(
        agrees,
        format!(
            "Equations (27)-(35): over the box of validity {name} reaches {} of the largest magnitude of its row in the exact form, {} than {}.",
            percent(share),
            if agrees { "less" } else { "not less" },
            percent(AGREES)
        ),
    )
}

/// What the table of differences shows.
pub(super) fn differences() -> Sentence {
    Sentence(
        "The exact form is what (1)-(4) and (25) imply; the printed form is (27)-(35) without their misprints. \
         A magnitude is the largest one at the corners of the box and at points spread over it."
            .to_owned(),
    )
}

/// Level flight of Table 2, the distance of the rigid COM by Earth, and where the DCOM's coefficients come from.
pub(super) fn trims(
    [velocity, altitude]: [f64; 2],
    rigid: &[(&str, f64)],
    flexible: Provenance,
) -> Sentence {
    let rigid: Vec<String> = rigid
        .iter()
        .map(|(earth, distance)| format!("{} ({earth} Earth)", percent(*distance)))
        .collect();
    let table = match flexible.status {
        Status::Published => "is published".to_owned(),
        status => format!(
            "was not available: its rows are those of a table of this project (source {}, {})",
            flexible.source,
            word(status)
        ),
    };
    Sentence(format!(
        "Level flight at {velocity} ft/s and {altitude} ft; the paper's table gives V the value of h and h that of V. One trim is \
         printed for all models, which have different equations. The rigid COM trims {} away from it, the largest relative difference \
         of α, φ, δe. The flexible part of the DCOM {table}. Differences from the printed values are in brackets; η of com is that of \
         forebody and aftbody.",
        list(&rigid)
    ))
}

const fn word(status: Status) -> &'static str {
    match status {
        Status::Published => "published",
        Status::Derived => "derived",
        Status::Unverified => "unverified",
        Status::Assumed => "assumed",
    }
}

#[cfg(test)]
mod tests;
