//! Monomials: `1`, `alpha`, `phi*alpha^3`.

use std::collections::BTreeMap;

/// The exponents of a monomial's variables, by their names.
pub(crate) type Powers<'a> = BTreeMap<&'a str, u32>;

/// Reads the key of a coefficient, in the grammar of the generator; `None` if it is not a monomial.
pub(crate) fn powers(key: &str) -> Option<Powers<'_>> {
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
