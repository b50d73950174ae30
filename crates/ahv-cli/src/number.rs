//! Numbers as text: one that is not finite is a word, and none has hundreds of digits.

pub use ahv_core::Shown;

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

/// A number with so many decimals; with a power of ten where they would all be 0.
pub fn fixed(value: f64, decimals: i32) -> String {
    let size = value.abs();
    let places = usize::try_from(decimals).unwrap_or(0);
    if size > 0.0 && size < 10_f64.powi(-decimals) {
        format!("{:.places$e}", Shown(value))
    } else {
        format!("{:.places$}", Shown(value))
    }
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
    use super::{cell, fixed, time};

    #[test]
    fn a_cell_reads_back_or_is_empty() {
        assert_eq!(cell(f64::NEG_INFINITY), "");
        assert_eq!(cell(1.0 / 3.0).parse(), Ok(1.0 / 3.0));
        assert_eq!(cell(1e300), "1e300");
    }

    #[test]
    fn what_has_no_decimals_has_a_power_of_ten() {
        assert_eq!(fixed(0.25, 4), "0.2500");
        assert_eq!(fixed(-2.5e-9, 4), "-2.5000e-9");
        assert_eq!(fixed(2e20, 4), "2.0000e20");
        assert_eq!(fixed(0.0, 4), "0.0000");
        assert_eq!(fixed(f64::NAN, 4), "not a number");
    }

    #[test]
    fn times_are_as_meant() {
        let times = (0..1000).map(|step| time(f64::from(step) * 0.01).to_string());
        assert!(times.map(|it| it.len()).max() <= Some(4));
        assert_eq!(time(0.350_000_000_000_000_03), 0.35);
        assert_eq!(time(1.0 / 3.0), 0.333_333_333_333_333);
    }
}
