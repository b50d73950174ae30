//! Sums of two doubles, for what a result needs beyond the precision of one.

/// A number of about 106 bits: the sum of a double and of one far smaller.
#[derive(Clone, Copy)]
pub(super) struct Pair {
    pub(super) high: f64,
    pub(super) low: f64,
}

impl Pair {
    /// A double.
    #[inline(always)]
    pub(super) const fn exact(high: f64) -> Self {
        Self { high, low: 0.0 }
    }

    /// a + b without an error, for |a| ≥ |b| or a = 0.
    #[inline(always)]
    pub(super) fn ordered_sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let low = (a - high) + b;
        Self { high, low }
    }

    /// a + b without an error.
    #[inline(always)]
    pub(super) fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let back = high - a;
        let low = (a - (high - back)) + (b - back);
        Self { high, low }
    }

    /// a · b without an error, for factors below 2⁹⁹⁶ and a product that is not tiny.
    #[inline(always)]
    pub(super) fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        let (a, b) = (halves(a), halves(b));
        let low = ((a.0 * b.0 - high) + a.0 * b.1 + a.1 * b.0) + a.1 * b.1;
        Self { high, low }
    }

    #[inline(always)]
    pub(super) fn negative(self) -> Self {
        let (high, low) = (-self.high, -self.low);
        Self { high, low }
    }

    #[inline(always)]
    pub(super) fn plus(self, other: Self) -> Self {
        let sum = Self::sum(self.high, other.high);
        Self::ordered_sum(sum.high, sum.low + (self.low + other.low))
    }

    #[inline(always)]
    pub(super) fn times(self, other: Self) -> Self {
        let product = Self::product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        Self::ordered_sum(product.high, product.low + cross)
    }

    /// The quotient, its low part as a correction of the high one.
    #[inline(always)]
    pub(super) fn over(self, divisor: Self) -> Self {
        let high = self.high / divisor.high;
        let back = Self::product(high, divisor.high);
        let rest = ((self.high - back.high) - back.low) + (self.low - high * divisor.low);
        let low = rest / divisor.high;
        Self { high, low }
    }

    /// The nearest double.
    #[inline(always)]
    pub(super) fn rounded(self) -> f64 {
        self.high + self.low
    }
}

/// A number as a sum of two of 26 bits, whose products are exact.
#[inline(always)]
fn halves(x: f64) -> (f64, f64) {
    let shifted = x * 134_217_729.0;
    let high = shifted - (shifted - x);
    (high, x - high)
}
