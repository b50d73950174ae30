//! Bending modes of a uniform Euler–Bernoulli beam, clamped at one end or free at both.

use ahv_core::Real;

/// How a beam is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// Clamped at its start, free at its end.
    Clamped,
    /// Free at both ends; its rigid motions are no modes here.
    Free,
}

/// A mode of a beam of length 1, with a shape whose square has the mean 1. Places run from 0 to 1.
///
/// On a beam of length L, stiffness EI and mass μ of a unit of length, the frequency is [`Self::frequency`], and the
/// mass-normalised shape is this one over √(μ L).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mode {
    support: Support,
    /// βL, a root of the frequency equation.
    pub eigenvalue: f64,
    /// Share of sinh and sin in the shape.
    share: f64,
}

impl Mode {
    /// Mode `number`, from 1.
    ///
    /// The eigenvalue b solves cos b cosh b = −1 (clamped) or 1 (free), by Newton's method on cos b ± 1/cosh b.
    pub fn new(support: Support, number: u32) -> Self {
        use std::f64::consts::PI;
        let (sign, odd) = match support {
            Support::Clamped => (1.0, -1.0),
            Support::Free => (-1.0, 1.0),
        };
        let mut b = (f64::from(number) + 0.5 * odd) * PI;
        // From there on it is exact but for the first mode, whose start is off by 0.3.
        for _ in 0..12 {
            let [cosh, sinh, cos, sin] = functions(b);
            b += (cos + sign / cosh) / (sin + sign * sinh / (cosh * cosh));
        }
        let [cosh, sinh, cos, sin] = functions(b);
        let share = (cosh + sign * cos) / (sinh + sign * sin);
        Self {
            support,
            eigenvalue: b,
            share,
        }
    }

    /// Natural frequency, rad/s, on a beam of this length, bending stiffness and mass of a unit of length.
    pub fn frequency<R: Real>(&self, length: R, stiffness: R, mass: R) -> R {
        let b = R::from_f64(self.eigenvalue);
        b * b / (length * length) * (stiffness / mass).sqrt()
    }

    /// The shape at `place`.
    pub fn shape<R: Real>(&self, place: R) -> R {
        self.terms(place, |[cosh, sinh, cos, sin], sign, share| {
            cosh - sign * cos - share * (sinh - sign * sin)
        })
    }

    /// Derivative of the shape by `place`.
    pub fn slope<R: Real>(&self, place: R) -> R {
        let found = self.terms(place, |[cosh, sinh, cos, sin], sign, share| {
            sinh + sign * sin - share * (cosh - sign * cos)
        });
        found * R::from_f64(self.eigenvalue)
    }

    /// Integral of the shape from 0 to `place`.
    pub fn integral<R: Real>(&self, place: R) -> R {
        let integral = |at| {
            self.terms(at, |[cosh, sinh, cos, sin], sign, share| {
                sinh - sign * sin - share * (cosh + sign * cos)
            })
        };
        (integral(place) - integral(R::ZERO)) / R::from_f64(self.eigenvalue)
    }

    /// Integral of place times shape over the beam, from its start: 2/b² of a clamped beam, 0 of a free one.
    pub fn lever(&self) -> f64 {
        match self.support {
            Support::Clamped => 2.0 / (self.eigenvalue * self.eigenvalue),
            Support::Free => 0.0,
        }
    }

    /// Something of cosh, sinh, cos and sin of βx.
    fn terms<R: Real>(&self, place: R, of: impl Fn([R; 4], R, R) -> R) -> R {
        let sign = match self.support {
            Support::Clamped => R::ONE,
            Support::Free => -R::ONE,
        };
        let argument = R::from_f64(self.eigenvalue) * place;
        of(functions(argument), sign, R::from_f64(self.share))
    }
}

/// cosh, sinh, cos and sin.
fn functions<R: Real>(x: R) -> [R; 4] {
    let (up, (sin, cos)) = (x.exp(), x.sin_cos());
    let down = up.recip();
    [R::HALF * (up + down), R::HALF * (up - down), cos, sin]
}
