//! A Runge–Kutta method of weak order 2 for general Itô noise.

use core::cmp::Ordering;

use ahv_core::{NoiseClass, Real, StochasticModel, Vector};

use crate::StepError;
use crate::error::{accept, step_size};
use crate::vector::{component, unit};

/// Φ⁻¹(5/6): a standard normal number lies above it once in six times.
const FIVE_SIXTHS: f64 = 0.967_421_566_101_701_7;

/// Shift of the stages along the drift, as a part of the step.
const DRIFT_SHIFT: f64 = 342.0 / 491.0;
/// 3 √(38/491): shift of the stages along their own column.
const COLUMN_SHIFT: f64 = 0.834_588_328_583_463_4;
/// (6 − √6)/10 and (3 + 2√6)/5: shift of the second and third drift along the noise.
const NOISE_SHIFT: [f64; 2] = [0.355_051_025_721_682_23, 1.579_795_897_113_271];
/// Weight of the second difference along the own column.
const CURVATURE_WEIGHT: f64 = 491.0 / 1368.0;
/// √(491/38)/6: weight of the first difference along the own column.
const SLOPE_WEIGHT: f64 = 0.599_097_762_184_913_2;
/// 4 √(221/4955): shift along the other columns.
const CROSS_SHIFT: f64 = 0.844_761_861_965_18;
/// 491/513 √(221/4955): share in it of the other columns' second differences.
const CROSS_CURVATURE: f64 = 0.202_133_564_437_087_4;
/// Weight of the second difference along the other columns.
const CROSS_CURVATURE_WEIGHT: f64 = 4955.0 / 14144.0;
/// √(4955/221)/8: weight of the first difference along the other columns.
const CROSS_SLOPE_WEIGHT: f64 = 0.591_882_780_831_089_8;

/// What a step of weak order 2 needs in the place of Wiener increments, one component a channel: numbers of few values
/// that have the moments which matter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeakIncrements<W> {
    /// In the place of ΔW: −√(3h), 0 or √(3h) with probability 1/6, 2/3, 1/6, in s^½.
    pub three_point: W,
    /// For the iterated integrals: −√h or √h with probability 1/2 each, in s^½. A pair of channels uses the product of
    /// theirs.
    pub two_point: W,
}

impl<W> WeakIncrements<W> {
    /// The increments over a step of `dt`, in s, whose signs are `three_point(channel)` (−1, 0 or 1) and
    /// `two_point(channel)` (−1 or 1).
    pub fn from_signs<R: Real>(
        dt: f64,
        mut three_point: impl FnMut(usize) -> f64,
        mut two_point: impl FnMut(usize) -> f64,
    ) -> Self
    where
        W: Vector<R>,
    {
        let h = R::from_f64(dt);
        let (root, root_3) = (h.sqrt(), (R::from_f64(3.0) * h).sqrt());
        Self {
            three_point: W::from_fn(|channel| root_3 * R::from_f64(three_point(channel))),
            two_point: W::from_fn(|channel| root * R::from_f64(two_point(channel))),
        }
    }

    /// The increments over a step of `dt`, in s, from standard normal numbers: numbers 0 to m − 1 for the first sort of
    /// m channels, m to 2m − 1 for the second.
    pub fn from_normals<R: Real>(dt: f64, mut normal: impl FnMut(usize) -> f64) -> Self
    where
        W: Vector<R>,
    {
        let h = R::from_f64(dt);
        let (root, root_3) = (h.sqrt(), (R::from_f64(3.0) * h).sqrt());
        let three_point = W::from_fn(|channel| match normal(channel) {
            z if z > FIVE_SIXTHS => root_3,
            z if z < -FIVE_SIXTHS => -root_3,
            _ => R::ZERO,
        });
        let two_point = W::from_fn(|channel| {
            if normal(W::LEN + channel) < 0.0 {
                -root
            } else {
                root
            }
        });
        Self {
            three_point,
            two_point,
        }
    }
}

/// DRI1 for Itô equations with any noise, with a fixed step and a held input.
///
/// Weak order 2, order 3 without noise (Debrabant and Rößler 2009, "Families of efficient second order Runge–Kutta
/// methods for the weak approximation of Itô stochastic differential equations"). Expectations converge, not paths: the
/// increments take few values and stand for no Wiener path.
///
/// The iterated integral of channels k < l is (Î_k Î_l − Ĩ_k Ĩ_l)/2. The form with Ĩ_k √h in the place of the product is
/// not used: it correlates the integrals of (k, l) and (k, l').
///
/// A step costs three drifts, one noise increment and up to nine more for each column whose
/// [`StochasticModel::noise_class`] is not `Constant`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ItoDri1 {
    pub(crate) dt: f64,
}

impl ItoDri1 {
    /// A stepper of step size `dt`, in s; [`step`](Self::step) refuses one that is not positive and finite.
    pub const fn new(dt: f64) -> Self {
        Self { dt }
    }

    /// Advances `x` by one step; `u` is held over the step.
    ///
    /// # Errors
    ///
    /// [`StepError`]; `x` is then the state before the step.
    #[inline(always)]
    pub fn step<M: StochasticModel>(
        &self,
        model: &M,
        x: &mut M::State,
        u: &M::Input,
        increments: &WeakIncrements<M::Noise>,
    ) -> Result<(), StepError<M::Scalar>> {
        let dt: M::Scalar = step_size(self.dt)?;
        let c = |value: f64| M::Scalar::from_f64(value);
        let [shift_2, shift_3] = NOISE_SHIFT;
        let k1 = model.drift(x, u);
        let noise = model.noise_increment(x, u, &increments.three_point);
        let at = |slope: M::State, shift: f64| {
            x.zip_with(slope, |x, k| x + dt * k)
                .zip_with(noise, |x, g| x + c(shift) * g)
        };
        let k2 = model.drift(&at(k1.map(|k| c(0.5) * k), shift_2), u);
        let k3 = model.drift(&at(k2.zip_with(k1, |k2, k1| c(2.0) * k2 - k1), shift_3), u);
        let slope = k1
            .zip_with(k2, |a, b| a + c(4.0) * b)
            .zip_with(k3, |a, b| a + b);

        let base = Base {
            model,
            x,
            u,
            shifted: x.zip_with(k1, |x, k| x + c(DRIFT_SHIFT) * dt * k),
            increments,
            root: dt.sqrt(),
        };
        let next = x
            .zip_with(slope, |x, k| x + c(1.0 / 6.0) * dt * k)
            .zip_with(noise, |x, g| x + g)
            .zip_with(base.correction(), |x, g| x + g);
        accept(x, next)
    }
}

/// What the columns' stages of one step share.
struct Base<'s, M: StochasticModel> {
    model: &'s M,
    x: &'s M::State,
    u: &'s M::Input,
    /// `x`, and what the drift adds at the stages.
    shifted: M::State,
    increments: &'s WeakIncrements<M::Noise>,
    /// √dt
    root: M::Scalar,
}

/// A column at the start, and its first and second difference between two stages on either side.
struct Differences<X> {
    here: X,
    slope: X,
    curvature: X,
}

/// Sums over columns l of their second differences: Σ c_l Î_l, Σ c_l Ĩ_l, and the latter over the columns before the
/// present one.
struct Sums<X> {
    hats: X,
    signs: X,
    signs_before: X,
}

impl<M: StochasticModel> Base<'_, M> {
    /// What the step has over the noise G ΔŴ at its start. Columns that are constant take no part: their differences
    /// are 0.
    fn correction(&self) -> M::State {
        let columns =
            || (0..M::Noise::LEN).filter(|&k| !matches!(M::noise_class(k), NoiseClass::Constant));
        let zero = M::State::splat(M::Scalar::ZERO);
        let mut sums = Sums {
            hats: zero,
            signs: zero,
            signs_before: zero,
        };
        // A single column has no others beside it.
        if M::Noise::LEN > 1 {
            for k in columns() {
                let bent = self.along_itself(k).curvature;
                let hat = component(&self.increments.three_point, k);
                let sign = component(&self.increments.two_point, k);
                sums.hats = sums.hats.zip_with(bent, |s, c| s + c * hat);
                sums.signs = sums.signs.zip_with(bent, |s, c| s + c * sign);
            }
        }
        columns().fold(zero, |total, k| self.column(k, total, &mut sums))
    }

    /// Adds the part of column k to `total`.
    fn column(&self, k: usize, total: M::State, sums: &mut Sums<M::State>) -> M::State {
        let c = |value: f64| M::Scalar::from_f64(value);
        let hat = component(&self.increments.three_point, k);
        let dt = self.root * self.root;
        let own = self.along_itself(k);
        let twice = c(0.5 * SLOPE_WEIGHT) * (hat * hat - dt) / self.root;
        let total = total
            .zip_with(own.curvature, |t, d| t + c(CURVATURE_WEIGHT) * hat * d)
            .zip_with(own.slope, |t, d| t + twice * d);
        if M::Noise::LEN < 2 {
            return total;
        }
        let others = self.along_others(k, &own, sums);
        total
            .zip_with(others.curvature, |t, d| {
                t + c(CROSS_CURVATURE_WEIGHT) * hat * d
            })
            .zip_with(others.slope, |t, d| {
                t + c(CROSS_SLOPE_WEIGHT) * self.root * d
            })
    }

    /// Differences of column k at stages that differ along the column itself.
    fn along_itself(&self, k: usize) -> Differences<M::State> {
        let here = self.at(self.x, k);
        let reach = M::Scalar::from_f64(COLUMN_SHIFT) * self.root;
        let shift = here.map(|b| reach * b);
        self.differences(k, &self.shifted, here, &shift)
    }

    /// Differences of column k at stages that differ along the other columns l, each times the iterated integral
    /// Î_(k,l)/√h; `sums` moves on to the next column.
    fn along_others(
        &self,
        k: usize,
        own: &Differences<M::State>,
        sums: &mut Sums<M::State>,
    ) -> Differences<M::State> {
        let curvature = own.curvature;
        let (hats, signs) = (&self.increments.three_point, &self.increments.two_point);
        let (hat, sign) = (component(hats, k), component(signs, k));
        // Î_(k,l)/√h = (Î_k Î_l ∓ Ĩ_k Ĩ_l)/(2√h), minus where l is the later channel.
        let scale = M::Scalar::HALF / self.root;
        let (hat_scale, sign_scale) = (scale * hat, scale * sign);
        let integrals = M::Noise::from_fn(|l| {
            let product = hat_scale * component(hats, l);
            let difference = sign_scale * component(signs, l);
            match l.cmp(&k) {
                Ordering::Less => product + difference,
                Ordering::Equal => M::Scalar::ZERO,
                Ordering::Greater => product - difference,
            }
        });
        let straight = self.model.noise_increment(self.x, self.u, &integrals);
        let before = sums.signs_before;
        let through = before.zip_with(curvature, |s, c| s + c * sign);
        let after = sums.signs.zip_with(through, |s, t| s - t);
        let bent = sums
            .hats
            .zip_with(curvature, |s, c| hat_scale * (s - c * hat))
            .zip_with(before, |b, s| b + sign_scale * s)
            .zip_with(after, |b, s| b - sign_scale * s);
        sums.signs_before = through;

        let shift = straight.zip_with(bent, |a, b| {
            M::Scalar::from_f64(CROSS_SHIFT) * a + M::Scalar::from_f64(CROSS_CURVATURE) * b
        });
        self.differences(k, self.x, own.here, &shift)
    }

    /// Differences of column k between `centre` + `shift` and `centre` − `shift`, with the column at the start, `here`.
    fn differences(
        &self,
        k: usize,
        centre: &M::State,
        here: M::State,
        shift: &M::State,
    ) -> Differences<M::State> {
        let above = self.at(&centre.zip_with(*shift, |x, d| x + d), k);
        let below = self.at(&centre.zip_with(*shift, |x, d| x - d), k);
        Differences {
            here,
            slope: above.zip_with(below, |a, b| a - b),
            curvature: above
                .zip_with(here, |a, b| a - b)
                .zip_with(below.zip_with(here, |a, b| a - b), |a, b| a + b),
        }
    }

    /// Column k of G at `x`.
    fn at(&self, x: &M::State, k: usize) -> M::State {
        self.model.noise_increment(x, self.u, &unit(k))
    }
}
