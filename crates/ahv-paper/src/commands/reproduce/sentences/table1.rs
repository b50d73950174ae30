//! Sentences on Table 1.

use ahv_analysis::statistics::Estimate;

use super::{Finding, Sentence, count, finding, interval, p_value, percent, verdict};
use crate::commands::number::significant;
use crate::reproduce::p_value::{PValue, Verdict};

/// The standard deviations of Table 1 with held noise: medians over printed values, and verdicts.
pub(crate) fn deviations(ratios: &[f64], verdicts: &[Verdict]) -> Finding {
    let off = ratios
        .iter()
        .fold(0.0, |off: f64, ratio| off.max((ratio - 1.0).abs()));
    finding(
        !verdicts.contains(&Verdict::Outside),
        format!(
            "Table 1, standard deviations, if the noise is a number held for each step: medians within {} of the printed values; \
             {}.",
            percent(off),
            count(verdicts)
        ),
    )
}

/// All entries of Table 1 with white noise.
pub(crate) fn white(sigma: f64, ratios: &[f64], verdicts: &[Verdict]) -> Finding {
    let (low, high) = ratios
        .iter()
        .fold((f64::INFINITY, 0.0_f64), |(low, high), &ratio| {
            (low.min(ratio), high.max(ratio))
        });
    finding(
        !verdicts.contains(&Verdict::Outside),
        format!(
            "Table 1 with white noise of intensity {sigma}², as in the text: {}; ours are {low:.1} to {high:.1} times the printed \
             ones.",
            count(verdicts)
        ),
    )
}

/// The means of Table 1 with held noise, and the reading that most entries fit.
pub(crate) fn means(
    runs: u64,
    verdicts: &[Verdict],
    best: Option<(&str, usize, usize)>,
) -> Finding {
    let best = best.map_or_else(String::new, |(name, fits, of)| {
        format!(" Most entries ({fits} of {of}) are inside with this reading: {name}.")
    });
    finding(
        !verdicts.contains(&Verdict::Outside),
        format!(
            "Table 1, means, if the noise is a number held for each step, with {runs} runs: {}.{best}",
            count(verdicts)
        ),
    )
}

/// Facts behind an entry of Table 1.
pub(crate) struct Entry<'a> {
    /// Median with white noise over the printed value.
    pub(crate) white_ratio: f64,
    /// Of a standard deviation: the greatest error of infinitely many runs with held noise, at the samples and between them.
    pub(crate) exact: Option<[f64; 2]>,
    /// Held noise, a noise each.
    pub(crate) held: &'a Estimate,
    /// Held noise, one noise.
    pub(crate) common: (&'a Estimate, &'a PValue),
    /// Held noise with fewer runs.
    pub(crate) fewer: (u64, &'a Estimate, &'a PValue),
}

/// What explains an entry of Table 1.
pub(crate) fn entry(facts: &Entry<'_>) -> Sentence {
    let Entry {
        white_ratio,
        exact,
        held,
        common: (common, common_p),
        fewer: (runs, fewer, fewer_p),
    } = facts;
    let exact = exact.map_or_else(String::new, |exact| {
        let [at, between] = exact.map(significant);
        format!(" Infinitely many runs with held noise give {at} at the samples and {between} between them.")
    });
    let change = if common.value < held.value {
        "smaller"
    } else {
        "larger"
    };
    Sentence(format!(
        "White noise gives {white_ratio:.1} times the printed value.{exact} With one noise for η and χ, held noise gives {}, \
         {change} (p {}, {}); with {runs} runs {} (p {}, {}).",
        interval(common),
        p_value(common_p),
        verdict(common_p.verdict),
        interval(fewer),
        p_value(fewer_p),
        verdict(fewer_p.verdict)
    ))
}
