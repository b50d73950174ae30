//! Units of measurement as tables write them.

/// A unit: powers of length, mass, time and angle, and its size in metre, kilogram, second and radian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    powers: [f64; 4],
    size: f64,
}

/// The units by name.
const KNOWN: [(&str, [f64; 4], f64); 10] = [
    ("1", [0.0; 4], 1.0),
    ("ft", [1.0, 0.0, 0.0, 0.0], FOOT),
    ("slug", [0.0, 1.0, 0.0, 0.0], SLUG),
    ("lb", [1.0, 1.0, -2.0, 0.0], POUND),
    ("m", [1.0, 0.0, 0.0, 0.0], 1.0),
    ("kg", [0.0, 1.0, 0.0, 0.0], 1.0),
    ("N", [1.0, 1.0, -2.0, 0.0], 1.0),
    ("s", [0.0, 0.0, 1.0, 0.0], 1.0),
    ("rad", [0.0, 0.0, 0.0, 1.0], 1.0),
    ("deg", [0.0, 0.0, 0.0, 1.0], Unit::DEGREE),
];

const FOOT: f64 = 0.3048;

/// The force that gives 0.45359237 kg standard gravity, in N.
const POUND: f64 = 0.453_592_37 * 9.806_65;

const SLUG: f64 = POUND / FOOT;

impl Unit {
    /// A degree in radians.
    pub(super) const DEGREE: f64 = std::f64::consts::PI / 180.0;

    /// Reads `slug/ft^3`, `(ft*slug)^0.5/s`, `1/rad`; `None` if it is no unit.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let mut rest = text.trim();
        let unit = product(&mut rest)?;
        rest.is_empty().then_some(unit)
    }

    /// The size of the unit in terms of `other`; `None` if they measure different things.
    pub(super) fn in_terms_of(&self, other: &Self) -> Option<f64> {
        (self.powers == other.powers).then(|| self.size / other.size)
    }

    fn power(self, exponent: f64) -> Self {
        Self {
            powers: self.powers.map(|power| power * exponent),
            size: self.size.powf(exponent),
        }
    }

    fn times(self, other: Self) -> Self {
        let [a, b, c, d] = self.powers;
        let [e, f, g, h] = other.powers;
        Self {
            powers: [a + e, b + f, c + g, d + h],
            size: self.size * other.size,
        }
    }
}

/// Reads powers joined by `*` and `/` from the start of `rest`.
fn product(rest: &mut &str) -> Option<Unit> {
    let mut unit = power(rest)?;
    loop {
        unit = if let Some(after) = rest.strip_prefix('*') {
            *rest = after;
            unit.times(power(rest)?)
        } else if let Some(after) = rest.strip_prefix('/') {
            *rest = after;
            unit.times(power(rest)?.power(-1.0))
        } else {
            return Some(unit);
        };
    }
}

/// Reads a name or a product in brackets, with an exponent or without.
fn power(rest: &mut &str) -> Option<Unit> {
    let base = if let Some(inside) = rest.strip_prefix('(') {
        *rest = inside;
        let unit = product(rest)?;
        *rest = rest.strip_prefix(')')?;
        unit
    } else {
        let word = taken(rest, |c| c.is_ascii_alphanumeric());
        let &(_, powers, size) = KNOWN.iter().find(|(name, ..)| *name == word)?;
        Unit { powers, size }
    };
    let Some(after) = rest.strip_prefix('^') else {
        return Some(base);
    };
    *rest = after;
    let exponent = taken(rest, |c| c.is_ascii_digit() || c == '.' || c == '-');
    let exponent = exponent.parse::<f64>().ok().filter(|it| it.is_finite())?;
    Some(base.power(exponent))
}

/// Takes the longest start of `rest` whose characters all are `wanted`.
fn taken<'a>(rest: &mut &'a str, wanted: impl Fn(char) -> bool) -> &'a str {
    let end = rest.find(|c| !wanted(c)).unwrap_or(rest.len());
    let (word, after) = rest.split_at(end);
    *rest = after;
    word
}

#[cfg(test)]
mod tests {
    use super::Unit;

    fn ratio(one: &str, other: &str) -> Option<f64> {
        let [one, other] = [one, other].map(|text| Unit::parse(text).expect("a unit"));
        one.in_terms_of(&other)
    }

    #[test]
    fn units_are_compared() {
        assert_eq!(ratio("slug*ft", "ft*slug"), Some(1.0));
        assert_eq!(ratio("1/(ft*slug)^0.5", "(ft*slug)^-0.5"), Some(1.0));
        let [acceleration, metre] = [ratio("lb/slug", "ft/s^2"), ratio("ft", "m")];
        assert!((acceleration.expect("the same") - 1.0).abs() < 1e-15);
        assert_eq!(metre, Some(0.3048));
        assert_eq!(ratio("deg", "rad"), Some(std::f64::consts::PI / 180.0));
        assert_eq!(ratio("rad", "1"), None);
        assert_eq!(ratio("ft", "s"), None);
    }

    #[test]
    fn what_is_no_unit_is_refused() {
        for text in [
            "", "furlong", "ft/", "(ft", "ft)", "ft^", "ft^x", "ft s", "*ft", "2",
        ] {
            assert_eq!(Unit::parse(text), None, "{text}");
        }
    }
}
