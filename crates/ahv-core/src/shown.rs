//! Numbers as text for people: one that is not finite is words, and none has hundreds of digits.

use core::fmt::{self, Display, Formatter, LowerExp};
use core::ops::Range;

/// Sizes that are written without a power of ten.
const PLAIN: Range<f64> = 1e-5..1e16;

/// A number in a text. Width, precision, sign and `e` are heeded; huge and tiny ones have a power of ten anyway, and one that
/// is not finite is "infinite" or "not a number". The messages of all errors show their numbers by it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown(pub f64);

impl Display for Shown {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        // With a precision, what is tiny is short.
        let tiny = size != 0.0 && size < PLAIN.start && f.precision().is_none();
        if tiny || size >= PLAIN.end || size.is_nan() {
            return LowerExp::fmt(self, f);
        }
        Display::fmt(&self.0, f)
    }
}

impl LowerExp for Shown {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let words = if self.0.is_nan() {
            "not a number"
        } else if self.0.is_infinite() {
            "infinite"
        } else {
            return LowerExp::fmt(&self.0, f);
        };
        // `pad` would take a precision for a largest length.
        let width = f.width().unwrap_or(0);
        write!(f, "{words:>width$}")
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use std::format;
    use std::string::ToString;

    use super::Shown;

    #[test]
    fn no_number_is_long_and_none_is_nan() {
        assert_eq!(Shown(7702.0808).to_string(), "7702.0808");
        assert_eq!(Shown(0.0).to_string(), "0");
        assert_eq!(Shown(-1e300).to_string(), "-1e300");
        assert_eq!(Shown(1e-300).to_string(), "1e-300");
        assert_eq!(format!("{:.4}", Shown(1e-300)), "0.0000");
        assert_eq!(format!("{:+.1}", Shown(2.0)), "+2.0");
        assert_eq!(format!("{:>9.2}", Shown(1e300)), " 1.00e300");
        assert_eq!(format!("{:>14.4}|", Shown(f64::NAN)), "  not a number|");
        assert_eq!(format!("{:.2e}", Shown(f64::INFINITY)), "infinite");
        assert_eq!(Shown(f64::NEG_INFINITY).to_string(), "infinite");
    }
}
