//! Numbers as the page of `ahv reproduce` has them.

/// A number with four significant digits.
pub(crate) fn significant(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    // The exponent after rounding: 0.99999 has one digit before the point.
    let scientific = format!("{value:.3e}");
    let exponent = scientific
        .split_once('e')
        .and_then(|(_, exponent)| exponent.parse().ok());
    match exponent {
        Some(exponent @ -4..6) => {
            let decimals = usize::try_from(3 - exponent).unwrap_or(0);
            format!("{value:.decimals$}")
        }
        _ => scientific,
    }
}

#[cfg(test)]
mod tests {
    use super::significant;

    #[test]
    fn numbers_have_four_digits() {
        let texts = [
            0.0,
            0.30735,
            -0.000_970_4,
            13.100_56,
            7702.08,
            85_000.0,
            1e-5,
        ]
        .map(significant);
        assert_eq!(
            texts,
            [
                "0",
                "0.3074",
                "-0.0009704",
                "13.10",
                "7702",
                "85000",
                "1.000e-5"
            ]
        );
    }
}
