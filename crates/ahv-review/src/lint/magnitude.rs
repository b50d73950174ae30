//! Numbers that are off by a factor of units: degrees in the place of radians, pounds in the place of slugs.
//!
//! A number is compared with its neighbours: what it is in other sets of the table and in the generated models; and with
//! its siblings: numbers of the same unit whose names differ in digits only (`omega_1`, `omega_2`), or which are coefficients of the
//! same quantity.

use ahv_table::{Part, Unit};

use super::Findings;
use crate::Subject;
use crate::contents::{Contents, Number};

/// Degrees in a radian.
const DEGREES: f64 = 180.0 / std::f64::consts::PI;
/// Pounds of mass in a slug.
const POUNDS: f64 = 32.174_05;
/// By how much a number may have changed besides.
const CHANGE: f64 = 1.25;
/// By how much siblings may differ from one another: else they say nothing.
const SPREAD: f64 = 4.0;
/// By how much a number may differ from its siblings.
const LIKENESS: f64 = 1.6;

pub(super) fn find(findings: &mut Findings<'_>, contents: &Contents<'_>, subject: &Subject) {
    for entry in &contents.entries {
        let Some(unit) = Unit::parse(entry.unit).filter(|_| entry.value != 0.0) else {
            continue;
        };
        let neighbours = neighbours(contents, subject, entry);
        let seen = neighbours.iter().find_map(|(label, value)| {
            let slip = slip(&unit, entry.value / value, CHANGE)?;
            Some((slip, format!("{label} has {}", rounded(*value))))
        });
        let seen = seen.or_else(|| of_siblings(contents, entry, &unit));
        let Some((slip, label)) = seen else { continue };
        let message = format!(
            "`{}` = {} looks like {}: {label}, {} times {}",
            entry.key,
            entry.written,
            slip.looks,
            rounded(slip.factor),
            slip.than,
        );
        let path = [entry.path().as_slice(), &["value"]].concat();
        findings.add(slip.rule, &path, Part::Value, message, slip.help);
    }
}

/// A mistake of units.
struct Slip {
    rule: &'static str,
    looks: &'static str,
    than: &'static str,
    /// By which a neighbour differs, above 1.
    factor: f64,
    help: &'static str,
}

/// The mistake that a ratio to a neighbour betrays.
fn slip(unit: &Unit, ratio: f64, tolerance: f64) -> Option<Slip> {
    let size = ratio.abs().ln();
    let is = |factor: f64, exponent: f64| {
        exponent != 0.0 && (size.abs() - exponent.abs() * factor.ln()).abs() < tolerance.ln()
    };
    let (factor, than) = match size {
        it if it < 0.0 => ((-size).exp(), "as much"),
        _ => (size.exp(), "less"),
    };
    let of = |rule, looks, help| Slip {
        rule,
        looks,
        than,
        factor,
        help,
    };
    if is(DEGREES, unit.exponent_of("rad")) {
        let help = "write the unit with `deg` if the number is in degrees";
        return Some(of("degrees", "a number in the other unit of angle", help));
    }
    let help = "a slug is 32.174 lb of mass: a force of 1 lb gives it 1 ft/s^2";
    is(POUNDS, unit.exponent_of("slug"))
        .then(|| of("pounds", "a number in pounds of mass, not slugs", help))
}

/// What the number of an entry is elsewhere.
fn neighbours(
    contents: &Contents<'_>,
    subject: &Subject,
    entry: &Number<'_>,
) -> Vec<(String, f64)> {
    let mut found = Vec::new();
    for other in &contents.entries {
        let same = (other.section, other.key) == (entry.section, entry.key);
        // A set is compared with the table's own, not the other way round.
        if same && entry.set.is_some() && other.set != entry.set {
            let label = match other.set {
                Some(set) => format!("the set `{set}`"),
                None => "the table".to_owned(),
            };
            found.push((label, other.value));
        }
    }
    if let Some(index) = contents.parameter(entry) {
        let unit = subject.family.units.get(index).copied().unwrap_or("1");
        let (_, factor) = contents.converted(unit);
        let of = |reference: &crate::Reference| {
            let value = reference.values.get(index)?;
            Some((reference.label.clone(), value * factor))
        };
        found.extend(subject.references.iter().filter_map(of));
    }
    found.retain(|(_, value)| *value != 0.0);
    found
}

/// The mistake that an entry's siblings betray, which must be like one another.
fn of_siblings(contents: &Contents<'_>, entry: &Number<'_>, unit: &Unit) -> Option<(Slip, String)> {
    let mut siblings: Vec<&Number<'_>> = contents
        .entries
        .iter()
        .filter(|other| other.set == entry.set && other.value != 0.0)
        .filter(|other| (other.section, other.key) != (entry.section, entry.key))
        .filter(|other| is_sibling(other, entry))
        .collect();
    siblings.sort_by(|a, b| a.value.abs().total_cmp(&b.value.abs()));
    let (first, last) = (siblings.first()?, siblings.last()?);
    if siblings.len() < 2 || last.value.abs() > SPREAD * first.value.abs() {
        return None;
    }
    let logarithms = siblings.iter().map(|it| it.value.abs().ln());
    let usual = (logarithms.sum::<f64>() / siblings.len() as f64).exp();
    let names: Vec<String> = siblings
        .iter()
        .take(3)
        .map(|it| format!("`{}`", it.key))
        .collect();
    let label = format!("{} are about {}", names.join(", "), rounded(usual));
    let slip = slip(unit, entry.value.abs() / usual, LIKENESS)?;
    Some((slip, label))
}

fn is_sibling(one: &Number<'_>, other: &Number<'_>) -> bool {
    let numbered = |it: &Number<'_>| {
        let name = format!("{}.{}", it.section, it.key);
        let letters: String = name.chars().filter(|c| !c.is_ascii_digit()).collect();
        (letters.len() < name.len()).then_some(letters)
    };
    let same_name = numbered(one).is_some_and(|name| numbered(other) == Some(name));
    let same_quantity = one.section == other.section && one.term.is_some();
    one.unit == other.unit && (same_name || same_quantity)
}

fn rounded(value: f64) -> String {
    match value.abs() {
        it if (1e-3..1e6).contains(&it) => {
            let text = format!("{value:.6}");
            let (whole, _) = text.split_at(text.len().min(8));
            whole.trim_end_matches('0').trim_end_matches('.').to_owned()
        }
        _ => format!("{value:.4e}"),
    }
}
