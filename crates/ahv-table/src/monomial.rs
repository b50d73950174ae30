//! Monomials: `1`, `alpha`, `phi*alpha^3`.

use std::collections::BTreeMap;

use ahv_core::Fit;

use crate::fault::{shortened, suggestion};

/// The exponents of a monomial's variables, by their names.
pub type Powers<'a> = BTreeMap<&'a str, u32>;

/// Reads the key of a coefficient, in the grammar of the generator; `None` if it is not a monomial.
#[must_use]
pub fn powers(key: &str) -> Option<Powers<'_>> {
    let mut powers = BTreeMap::new();
    if key == "1" {
        return Some(powers);
    }
    for factor in key.split('*') {
        let factor = factor.trim_matches(' ');
        let (name, exponent) = match factor.split_once('^') {
            Some((name, exponent)) => (name, exponent),
            None => (factor, "1"),
        };
        let digits = exponent.bytes().all(|c| c.is_ascii_digit()) && !exponent.starts_with('0');
        let exponent = exponent.parse::<u32>().ok().filter(|_| digits)?;
        let power: &mut u32 = powers.entry(name).or_default();
        *power = power.checked_add(exponent)?;
    }
    Some(powers)
}

/// The highest degree of a monomial: derivatives multiply its variables by others.
const HIGHEST_DEGREE: u32 = 9;

/// Why a key is not a monomial of a fit: the rule that it breaks, what is wrong, what would be right.
pub(crate) type Refusal = (&'static str, String, String);

/// Reads the key of a coefficient of a fit, as the generator does.
pub(crate) fn powers_in<'a>(key: &'a str, fit: &Fit) -> Result<Powers<'a>, Refusal> {
    let shown = shortened(key);
    let Some(powers) = powers(key) else {
        let advice = match key {
            "0" => "the key of the constant part is `1`",
            _ => "",
        };
        let message = format!(
            "`{shown}` is not a monomial; write it like `alpha`, `alpha^2` or `phi*alpha^3`"
        );
        return Err(("monomial", message, advice.to_owned()));
    };
    let known: Vec<&str> = fit.variables.iter().map(|it| it.name).collect();
    if let Some(name) = powers.keys().find(|name| !known.contains(name)) {
        let message = format!("`{}` is not a variable of this quantity", shortened(name));
        return Err(("monomial", message, suggestion(name, &known)));
    }
    let degree = powers
        .values()
        .fold(0, |sum: u32, it| sum.saturating_add(*it));
    if degree > HIGHEST_DEGREE {
        let message =
            format!("the degree of `{shown}` is too high; the highest is {HIGHEST_DEGREE}");
        return Err(("monomial", message, String::new()));
    }
    let affine = powers.iter().filter(|(name, _)| fit.affine.contains(name));
    if affine.map(|(_, exponent)| exponent).sum::<u32>() > 1 {
        let message = format!("`{shown}` is not affine in `{}`", fit.affine.join("`, `"));
        return Err(("affine", message, String::new()));
    }
    Ok(powers)
}

#[cfg(test)]
mod tests {
    use super::powers;

    #[test]
    fn one_monomial_has_many_spellings() {
        for (one, other) in [
            ("alpha", "alpha^1"),
            ("phi*alpha", "alpha * phi"),
            ("a^2", "a*a"),
        ] {
            assert_eq!(powers(one), powers(other), "{one}");
        }
        for text in ["a^0", "a^01", "a^", "a^x", "a^-1", "a^2^3", "a^4294967296"] {
            assert_eq!(powers(text), None, "{text}");
        }
    }
}
