//! What the terms of a polynomial contribute over the validity box.

use ahv_core::Fit;
use ahv_table::{Part, Powers, Unit};

use super::{Findings, Limits};
use crate::Subject;
use crate::contents::{Contents, Number, models};

pub(super) fn find(findings: &mut Findings<'_>, contents: &Contents<'_>, limits: &Limits) {
    for fit in contents.family.table.fits {
        let of_fit = |it: &&Number<'_>| it.term.as_ref().is_some_and(|(own, _)| *own == fit);
        let terms: Vec<&Number<'_>> = contents.own().filter(of_fit).collect();
        for term in &terms {
            unit(findings, contents, term, fit);
        }
        negligible(findings, contents, &terms, limits.negligible);
        collinear(findings, contents, &terms, limits.collinear);
    }
}

/// The unit of a coefficient that the models do not have: that of the quantity over that of the monomial.
fn unit(findings: &mut Findings<'_>, contents: &Contents<'_>, term: &Number<'_>, fit: &Fit) {
    let Some((_, powers)) = &term.term else {
        return;
    };
    if contents.parameter(term).is_some() {
        return; // The check of the table has its unit.
    }
    let base = |unit: &str| Unit::parse(&contents.converted(unit).0);
    let expected = powers
        .iter()
        .try_fold(base(fit.unit), |unit, (name, exponent)| {
            let variable = fit.variables.iter().find(|it| it.name == *name)?;
            let per = base(variable.unit)?.power(-f64::from(*exponent));
            Some(unit.map(|unit| unit.times(per)))
        });
    let (Some(Some(expected)), Some(found)) = (expected, Unit::parse(term.unit)) else {
        return;
    };
    // Degrees may stand for radians.
    let plain = Unit::parse(&term.unit.replace("deg", "rad"));
    let ratio = plain.and_then(|plain| plain.in_terms_of(&expected));
    if found.in_terms_of(&expected).is_none() || ratio.is_none_or(|it| (it - 1.0).abs() > 1e-9) {
        let shown: Vec<String> = powers
            .iter()
            .filter_map(|(name, exponent)| {
                let variable = fit.variables.iter().find(|it| it.name == *name)?;
                let unit = contents.converted(variable.unit).0;
                Some(format!("`{name}` in `{unit}` to the power {exponent}"))
            })
            .collect();
        let quantity = contents.converted(fit.unit).0;
        let message = format!("the unit `{}` does not fit", term.unit);
        let help = format!("it is `{quantity}`, over {}", shown.join(", "));
        let path = [term.path().as_slice(), &["unit"]].concat();
        findings.add("unit", &path, Part::Value, message, &help);
    }
}

fn negligible(
    findings: &mut Findings<'_>,
    contents: &Contents<'_>,
    terms: &[&Number<'_>],
    limit: f64,
) {
    let largest = terms.iter().map(|term| contents.largest(term));
    let whole: f64 = largest.flatten().sum();
    for term in terms {
        let (section, key) = (term.section, term.key);
        if term.value == 0.0 {
            let message = format!("the coefficient of `{key}` is 0: its term adds nothing");
            let help = "leave the line out, unless the number is to be changed later";
            findings.add("zero", &term.path(), Part::Key, message, help);
            continue;
        }
        let Some(share) = contents.largest(term).map(|it| it / whole) else {
            continue;
        };
        if share < limit {
            let message = format!(
                "`{key}` is at most {} of `{section}` over the validity box",
                percent(share)
            );
            let help = "check the number and its unit, or leave the term out";
            findings.add("negligible", &term.path(), Part::Key, message, help);
        }
    }
}

/// A share in per cent, to two digits that count.
pub(crate) fn percent(share: f64) -> String {
    let percent = share * 100.0;
    let decimals = match percent {
        it if it >= 10.0 => 0,
        it if it >= 1.0 => 1,
        it if it >= 0.001 => 4,
        _ => return format!("{percent:.0e} %"),
    };
    format!("{percent:.decimals$} %")
}

fn collinear(
    findings: &mut Findings<'_>,
    contents: &Contents<'_>,
    terms: &[&Number<'_>],
    limit: f64,
) {
    for (index, term) in terms.iter().enumerate() {
        for other in &terms[..index] {
            let Some(cosine) = cosine(contents, term, other) else {
                continue;
            };
            if cosine.abs() > limit {
                let message = format!(
                    "over the validity box `{}` is nearly proportional to `{}` (cosine {cosine:.5})",
                    term.key, other.key
                );
                let help = "no data in this box can tell their coefficients apart: leave one out, or widen the box";
                findings.add("collinear", &term.path(), Part::Key, message, help);
            }
        }
    }
}

/// The cosine of the angle between two monomials as functions on the validity box.
fn cosine(contents: &Contents<'_>, one: &Number<'_>, other: &Number<'_>) -> Option<f64> {
    let ((fit, p), (_, q)) = (one.term.as_ref()?, other.term.as_ref()?);
    let product = mean(contents, fit, p, q)?;
    let norms = mean(contents, fit, p, p)? * mean(contents, fit, q, q)?;
    Some(product / norms.sqrt()).filter(|it| it.is_finite())
}

/// The mean of the product of two monomials over the validity box.
fn mean(contents: &Contents<'_>, fit: &Fit, p: &Powers<'_>, q: &Powers<'_>) -> Option<f64> {
    let power = |powers: &Powers<'_>, name: &str| powers.get(name).copied().unwrap_or(0);
    let variables = fit.variables.iter().map(|it| it.name);
    variables
        .filter(|name| power(p, name) + power(q, name) > 0)
        .try_fold(1.0, |product, name| {
            let (min, max) = contents.interval(fit, name)?;
            let n = i32::try_from(power(p, name) + power(q, name)).ok()? + 1;
            // Of x^(n-1), in units of the larger end: a high power of an altitude has no room in a double.
            let scale = min.abs().max(max.abs());
            let (a, b) = (min / scale, max / scale);
            let moment = (b.powi(n) - a.powi(n)) / (f64::from(n) * (b - a));
            Some(product * moment)
        })
}

/// Default flight conditions outside the validity box: there the fits are extrapolated.
pub(super) fn outside(findings: &mut Findings<'_>, contents: &Contents<'_>, subject: &Subject) {
    let table = subject.family.table;
    let mut found: Vec<&str> = Vec::new();
    for condition in &subject.conditions {
        let bounds = |it: &&ahv_core::Interval| it.variables.contains(&condition.state.as_str());
        let Some(interval) = table.validity.iter().find(bounds) else {
            continue;
        };
        let Some(&(min, max)) = contents.validity.get(interval.name) else {
            continue;
        };
        let (unit, factor) = contents.converted(interval.unit);
        let value = condition.value * factor;
        let is_listed = models(contents.text).contains(&condition.model.as_str());
        if is_listed && !(min..=max).contains(&value) && !found.contains(&interval.name) {
            found.push(interval.name);
            let message = format!(
                "the default flight condition of {}, `{}` = {value} {unit}, is outside the validity box",
                condition.model, condition.state
            );
            let help = "there the fits are extrapolated: widen the box if the fits hold, or trim elsewhere";
            let path = ["validity", interval.name];
            findings.add("outside-box", &path, Part::Value, message, help);
        }
    }
}
