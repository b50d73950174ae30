//! Numbers as text: one that is not finite is a word, and none has hundreds of digits.

use std::fmt::{self, Display, Formatter, LowerExp};

/// What stands in the place of a number that is infinite or NaN.
const NOT_FINITE: &str = "not finite";
/// Sizes that are written without a power of ten.
const PLAIN: std::ops::Range<f64> = 1e-5..1e16;

/// A number in a text. Width, precision and `e` are heeded; huge and tiny ones have a power of ten anyway.
#[derive(Clone, Copy)]
pub struct Shown(pub f64);

impl Display for Shown {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        // With a precision, what is tiny is short.
        let tiny = size != 0.0 && size < PLAIN.start && f.precision().is_none();
        if tiny || size >= PLAIN.end {
            return LowerExp::fmt(self, f);
        }
        if size.is_nan() {
            return not_finite(f);
        }
        Display::fmt(&self.0, f)
    }
}

impl LowerExp for Shown {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.0.is_finite() {
            LowerExp::fmt(&self.0, f)
        } else {
            not_finite(f)
        }
    }
}

fn not_finite(f: &mut Formatter<'_>) -> fmt::Result {
    // `pad` would take a precision for a largest length.
    let width = f.width().unwrap_or(0);
    write!(f, "{NOT_FINITE:>width$}")
}

/// The number of a cell of a table, which reads back as the same bits; empty if it is not finite.
pub fn cell(value: f64) -> String {
    if value.is_finite() {
        Shown(value).to_string()
    } else {
        String::new()
    }
}

/// A time that is a number of steps, in s, as a person would write it: 15 significant digits, which leave out what rounding
/// adds to 35 · 0.01.
pub fn time(seconds: f64) -> f64 {
    format!("{seconds:.14e}").parse().unwrap_or(seconds)
}

/// Reads a positive, finite number.
///
/// # Errors
///
/// What is wrong, for clap to print.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        Ok(_) => Err("must be positive and finite".to_owned()),
        Err(_) => Err("is not a number of seconds".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::{Shown, cell, time};

    #[test]
    fn no_number_is_long_and_none_is_nan() {
        assert_eq!(Shown(7702.0808).to_string(), "7702.0808");
        assert_eq!(Shown(0.0).to_string(), "0");
        assert_eq!(Shown(-1e300).to_string(), "-1e300");
        assert_eq!(Shown(1e-300).to_string(), "1e-300");
        assert_eq!(format!("{:.4}", Shown(1e-300)), "0.0000");
        assert_eq!(format!("{:>9.2}", Shown(1e300)), " 1.00e300");
        assert_eq!(format!("{:>12.4}|", Shown(f64::NAN)), "  not finite|");
        assert_eq!(format!("{:.2e}", Shown(f64::INFINITY)), "not finite");
        assert_eq!(cell(f64::NEG_INFINITY), "");
        assert_eq!(cell(1.0 / 3.0).parse(), Ok(1.0 / 3.0));
    }

    #[test]
    fn times_are_as_meant() {
        let times = (0..1000).map(|step| time(f64::from(step) * 0.01).to_string());
        assert!(times.map(|it| it.len()).max() <= Some(4));
        assert_eq!(time(0.350_000_000_000_000_03), 0.35);
        assert_eq!(time(1.0 / 3.0), 0.333_333_333_333_333);
    }
}
