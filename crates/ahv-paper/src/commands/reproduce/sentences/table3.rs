//! Sentences on Table 3, and on what the numbers behind it rest.

use ahv_core::{Provenance, Status};

use super::{AGREES, Finding, Sentence, finding, list, percent, word};
use crate::commands::number::significant;
use crate::reproduce::pairing::{LIMIT, SLOW};

/// How roots are paired.
pub(crate) fn pairing() -> Sentence {
    Sentence(format!(
        "Poles and zeros of y = [V, γ], u = [δe, φ] at the trims above, on the flat Earth without canard. Roots are compared \
         within a kind. Our poles are rigid, flexible or noise by the states that participate; a zero that cancels a pole of noise is that \
         of the noise. Printed roots, and other zeros of models with flexible states, are flexible if they are pairs above {SLOW} \
         rad/s, else rigid. Two roots correspond only if they differ by at most {} of the larger. Within that limit as many \
         correspond as can, such that the sum of the relative differences is least. All others have no counterpart. The FPM's \
         column is not compared.",
        percent(LIMIT)
    ))
}

/// How many printed roots have a counterpart.
pub(crate) fn counterparts(model: &str, set: &str, found: usize, of: usize) -> Finding {
    finding(
        found == of,
        format!(
            "Table 3, {}, set {set}: {found} of {of} printed poles and zeros (a pair counts once) have a counterpart within {}.",
            model.to_uppercase(),
            percent(LIMIT)
        ),
    )
}

/// Damping ratios of the flexible poles printed for the DCOM beside those of section 5.1.
pub(crate) fn dampings([low, high]: [f64; 2], [from, to]: [f64; 2]) -> Finding {
    let apart = high < from || to < low;
    let verdict = if apart {
        "the ranges are apart, so that section 5.3 rests on other modal data than section 5.1: hence two sets of parameters here"
    } else {
        "the ranges overlap"
    };
    finding(
        !apart,
        format!(
            "Table 3: its flexible poles of the DCOM have damping ratios of {low:.3} to {high:.3}, those of (36) are {from} to {to}; \
             {verdict}."
        ),
    )
}

/// The short period of the DCOM in a set beside the printed one, and how far that set trims from Table 2.
pub(crate) fn short_period(set: &str, ours: [f64; 2], printed: [f64; 2], trim: f64) -> Finding {
    let off = ours
        .iter()
        .zip(&printed)
        .fold(0.0, |off: f64, (ours, printed)| {
            off.max((ours / printed - 1.0).abs())
        });
    let but = if trim < AGREES {
        "and the set trims"
    } else {
        "but the set trims"
    };
    finding(
        off < AGREES,
        format!(
            "Table 3, DCOM: the short period of set {set} is {} and {}, printed are {} and {} (within {}); {but} {} away from Table 2.",
            significant(ours[0]),
            significant(ours[1]),
            significant(printed[0]),
            significant(printed[1]),
            percent(off),
            percent(trim)
        ),
    )
}

/// Number of poles of the SDCOM: ours, of which real ones of the noise, and the printed ones with their complex flexible pairs.
pub(crate) fn sdcom(ours: usize, noise: usize, printed: usize, pairs: usize) -> Finding {
    let agrees = ours == printed;
    let end = if agrees {
        "as many."
    } else {
        "which cannot come from (27)."
    };
    finding(
        agrees,
        format!(
            "SDCOM of (27) has {ours} states and so {ours} poles, of which {noise} are the real -a of the coloured noises. Table 3 \
             prints {printed}, {pairs} complex flexible pairs among them, {end}"
        ),
    )
}

/// Where ω and ζ of a set come from, and how near the real parts of its flexible poles are to the printed ones.
pub(crate) fn modal_data(set: &str, origin: Provenance, off: f64) -> Finding {
    let circular = origin.source == "table-3";
    let end = if circular {
        "This agreement is circular: it holds by construction, and is no evidence"
    } else {
        "Table 3 is not among the sources"
    };
    finding(
        !circular && off < AGREES,
        format!(
            "Set {set} takes ω and ζ of the flexible modes from the source {} ({}). The real parts of its flexible poles are within \
             {} of the printed ones. {end}.",
            origin.source,
            word(origin.status),
            percent(off)
        ),
    )
}

/// Where ω of the COM comes from, and whether it is the imaginary parts that Table 3 prints for the coupled vehicle.
pub(crate) fn clamped(origin: Provenance, omegas: &[f64], coupled: bool) -> Finding {
    let values: Vec<String> = omegas.iter().map(|&it| significant(it)).collect();
    let end = if coupled {
        "They are the imaginary parts that Table 3 prints, frequencies of the coupled vehicle, used here as clamped ones: the \
         coupling comes twice, and the flexible roots of the COM are no test"
    } else {
        "They are not the imaginary parts that Table 3 prints"
    };
    finding(
        !coupled,
        format!(
            "The COM takes ω = {} rad/s of its clamped modes from the source {} ({}). {end}.",
            list(&values),
            origin.source,
            word(origin.status)
        ),
    )
}

/// How far mass and inertia of a set can be trusted.
pub(crate) fn mass(set: &str, mass: Provenance, inertia: Provenance) -> Finding {
    let sure = [mass, inertia]
        .iter()
        .all(|it| matches!(it.status, Status::Published | Status::Derived));
    let end = if sure {
        ""
    } else {
        ": what depends on them, the short period above all, is no confirmation"
    };
    finding(
        sure,
        format!(
            "m of set {set} is {} (source {}), I_yy {} (source {}){end}.",
            word(mass.status),
            mass.source,
            word(inertia.status),
            inertia.source
        ),
    )
}
