//! Units of measurement as tables write them.

/// A unit: powers of length, mass, time, angle and temperature, and its size in metre, kilogram, second, radian and kelvin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    powers: [f64; 5],
    size: f64,
}

/// The units by name.
const KNOWN: [(&str, [f64; 5], f64); 10] = [
    ("ft", [1.0, 0.0, 0.0, 0.0, 0.0], FOOT),
    ("slug", [0.0, 1.0, 0.0, 0.0, 0.0], SLUG),
    ("lb", [1.0, 1.0, -2.0, 0.0, 0.0], POUND),
    ("m", [1.0, 0.0, 0.0, 0.0, 0.0], 1.0),
    ("kg", [0.0, 1.0, 0.0, 0.0, 0.0], 1.0),
    ("N", [1.0, 1.0, -2.0, 0.0, 0.0], 1.0),
    ("s", [0.0, 0.0, 1.0, 0.0, 0.0], 1.0),
    ("rad", [0.0, 0.0, 0.0, 1.0, 0.0], 1.0),
    ("deg", [0.0, 0.0, 0.0, 1.0, 0.0], Unit::DEGREE),
    ("K", [0.0, 0.0, 0.0, 0.0, 1.0], 1.0),
];

/// Of one unit, as the generator has it.
const MOST_FACTORS: usize = 32;

const FOOT: f64 = 0.3048;

/// The force that gives 0.45359237 kg standard gravity, in N.
const POUND: f64 = 0.453_592_37 * 9.806_65;

const SLUG: f64 = POUND / FOOT;

/// Names that the two unit systems have for the same thing.
const PAIRS: [(&str, &str); 3] = [("ft", "m"), ("slug", "kg"), ("lb", "N")];

/// The names of the units, as a list.
pub(crate) fn known() -> String {
    KNOWN.map(|(name, ..)| name).join(", ")
}

/// The SI unit of a unit in foot and slug, and what a value is multiplied with to be in it: `kg/m^3` for `slug/ft^3`; `None` if it
/// is no unit.
pub fn in_si(unit: &str) -> Option<(String, f64)> {
    Some((si_name(unit), Unit::parse(unit)?.size))
}

/// The SI unit in the place of one in foot and slug: `kg/m^3` for `slug/ft^3`.
#[must_use]
pub fn si_name(mut text: &str) -> String {
    let mut converted = String::new();
    while let Some(first) = text.chars().next() {
        let name = taken(&mut text, |c| c.is_ascii_alphabetic());
        let pair = PAIRS.iter().find(|(foot, _)| *foot == name);
        converted.push_str(pair.map_or(name, |(_, si)| si));
        if name.is_empty() {
            converted.push(first);
            text = &text[first.len_utf8()..];
        }
    }
    converted
}

/// By how many degrees a unit of a table differs from the same in radians: 1 for `deg`, -2 for `1/deg^2`, 0 for `m`; `None` if it
/// is no unit, or if that is no whole number.
pub fn degrees(unit: &str) -> Option<i32> {
    let [given, plain] = [unit.to_owned(), unit.replace("deg", "rad")].map(|it| Unit::parse(&it));
    let ratio = given?.in_terms_of(&plain?)?.ln() / Unit::DEGREE.ln();
    ((ratio - ratio.round()).abs() < 1e-6).then_some(ratio.round() as i32)
}

/// A value in so many [`degrees`] in radians: by one multiplication or division for each, so that it has the same bits everywhere.
pub fn in_radians(value: f64, degrees: i32) -> f64 {
    (0..degrees.abs()).fold(value, |value, _| {
        if degrees > 0 {
            value * Unit::DEGREE
        } else {
            value / Unit::DEGREE
        }
    })
}

impl Unit {
    /// The unit of a pure number.
    pub const ONE: Self = Self {
        powers: [0.0; 5],
        size: 1.0,
    };

    /// A degree in radians.
    pub const DEGREE: f64 = std::f64::consts::PI / 180.0;

    /// Reads `slug/ft^3`, `(ft*slug)^0.5/s`, `1/rad`; `None` if it is no unit. The grammar is that of the generator:
    /// brackets hold names alone, so that no text is too deep.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        if text.matches(['*', '/']).count() >= MOST_FACTORS {
            return None;
        }
        let mut rest = text;
        let unit = product(&mut rest, power)?;
        rest.is_empty().then_some(unit)
    }

    /// The size of the unit in terms of `other`; `None` if they measure different things.
    #[must_use]
    pub fn in_terms_of(&self, other: &Self) -> Option<f64> {
        (self.powers == other.powers).then(|| self.size / other.size)
    }

    /// The power of a unit.
    #[must_use]
    pub fn power(self, exponent: f64) -> Self {
        Self {
            powers: self.powers.map(|power| power * exponent),
            size: self.size.powf(exponent),
        }
    }

    /// The exponent of a base unit in it: -2 of `rad` in `ft/deg^2`.
    ///
    /// The name is one of `ft`, `slug`, `s`, `rad`, `K`; of any other the exponent is 0.
    #[must_use]
    pub fn exponent_of(&self, base: &str) -> f64 {
        let bases = ["ft", "slug", "s", "rad", "K"];
        let index = bases.iter().position(|name| *name == base);
        index.map_or(0.0, |index| self.powers[index])
    }

    /// The product of two units.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        let [a, b, c, d, j] = self.powers;
        let [e, f, g, h, k] = other.powers;
        Self {
            powers: [a + e, b + f, c + g, d + h, j + k],
            size: self.size * other.size,
        }
    }
}

/// Reads factors joined by `*` and `/` from the start of `rest`.
fn product(rest: &mut &str, factor: fn(&mut &str) -> Option<Unit>) -> Option<Unit> {
    let mut unit = factor(rest)?;
    loop {
        unit = if let Some(after) = rest.strip_prefix('*') {
            *rest = after;
            unit.times(factor(rest)?)
        } else if let Some(after) = rest.strip_prefix('/') {
            *rest = after;
            unit.times(factor(rest)?.power(-1.0))
        } else {
            return Some(unit);
        };
    }
}

/// Reads 1, a name or a product of names in brackets, with an exponent or without.
fn power(rest: &mut &str) -> Option<Unit> {
    let base = if let Some(inside) = rest.strip_prefix('(') {
        *rest = inside;
        let unit = product(rest, name)?;
        *rest = rest.strip_prefix(')')?;
        unit
    } else if let Some(after) = rest.strip_prefix('1') {
        *rest = after;
        Unit::ONE
    } else {
        name(rest)?
    };
    let Some(after) = rest.strip_prefix('^') else {
        return Some(base);
    };
    *rest = after;
    Some(base.power(exponent(rest)?))
}

fn name(rest: &mut &str) -> Option<Unit> {
    let word = taken(rest, |c| c.is_ascii_alphabetic());
    let &(_, powers, size) = KNOWN.iter().find(|(name, ..)| *name == word)?;
    Some(Unit { powers, size })
}

/// One or two digits, and up to three behind a point; not 0.
fn exponent(rest: &mut &str) -> Option<f64> {
    let text = taken(rest, |c| c.is_ascii_digit() || c == '.');
    let (whole, fraction) = match text.split_once('.') {
        Some((whole, fraction)) => (whole, Some(fraction)),
        None => (text, None),
    };
    let allowed = (1..=2).contains(&whole.len())
        && fraction.is_none_or(|it| (1..=3).contains(&it.len()) && !it.contains('.'));
    text.parse().ok().filter(|&it: &f64| allowed && it > 0.0)
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
    use super::*;

    fn ratio(one: &str, other: &str) -> Option<f64> {
        let [one, other] = [one, other].map(|text| Unit::parse(text).expect("a unit"));
        one.in_terms_of(&other)
    }

    #[test]
    fn units_are_compared() {
        assert_eq!(ratio("slug*ft", "ft*slug"), Some(1.0));
        assert_eq!(ratio("1/(ft*slug)^0.5", "1/(slug*ft)^0.5"), Some(1.0));
        let [acceleration, metre] = [ratio("lb/slug", "ft/s^2"), ratio("ft", "m")];
        assert!((acceleration.expect("the same") - 1.0).abs() < 1e-15);
        assert_eq!(metre, Some(0.3048));
        assert_eq!(ratio("deg", "rad"), Some(std::f64::consts::PI / 180.0));
        assert_eq!(ratio("rad", "1"), None);
        assert_eq!(ratio("ft", "s"), None);
    }

    #[test]
    fn each_unit_has_one_in_si() {
        for (foot, si) in [
            ("slug/ft^3", "kg/m^3"),
            ("(ft*slug)^0.5/s", "(m*kg)^0.5/s"),
            ("lb*ft/rad", "N*m/rad"),
            ("1", "1"),
        ] {
            assert_eq!(si_name(foot), si);
        }
    }

    /// What the generator's reader takes and refuses, too.
    #[test]
    fn both_readers_have_one_grammar() {
        let cases = include_str!("../example/units.txt");
        for case in cases.lines().filter(|line| !line.starts_with('#')) {
            let (taken, text) = case.split_at(1);
            let text = text.strip_prefix(' ').unwrap_or(text);
            assert_eq!(Unit::parse(text).is_some(), taken == "+", "{text:?}");
        }
    }

    #[test]
    fn brackets_are_not_too_deep_for_the_stack() {
        for depth in [2, 40_000] {
            let text = format!("{}ft{}", "(".repeat(depth), ")".repeat(depth));
            assert_eq!(Unit::parse(&text), None, "{depth}");
            assert_eq!(Unit::parse(&"(".repeat(depth)), None, "{depth}");
        }
    }

    #[test]
    fn degrees_are_counted_and_converted_one_by_one() {
        for (unit, count) in [
            ("deg", 1),
            ("1/deg", -1),
            ("1/deg^2", -2),
            ("ft*deg/s/deg", 0),
            ("rad^2/deg", -1),
            ("slug/ft^3", 0),
        ] {
            assert_eq!(degrees(unit), Some(count), "{unit}");
        }
        assert_eq!(degrees("deg^0.5"), None);
        assert_eq!(degrees("furlong"), None);
        assert_eq!(in_radians(180.0, 1), std::f64::consts::PI);
        let turn = std::f64::consts::PI / 180.0;
        assert_eq!(in_radians(0.3, -2), 0.3 / turn / turn);
    }
}
