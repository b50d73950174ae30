//! Integrals of a Wiener process over a step, and a path of them that can be refined.

use ahv_core::{Real, Vector};

/// Halving a step more often than this would leave the numbers of `u64`.
const DEEPEST: u32 = 62;

/// 1/(2√3)
const HALF_OVER_SQRT_3: f64 = 0.288_675_134_594_812_9;
/// √3/2
const HALF_SQRT_3: f64 = 0.866_025_403_784_438_6;
/// √(3/2)
const SQRT_THREE_HALVES: f64 = 1.224_744_871_391_589;
/// 1/√2
const INV_SQRT_2: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// Standard normal numbers, each a function of (step, channel): asked twice, a source answers the same.
pub trait NormalSource {
    /// The standard normal number of this step and channel, independent of all others.
    fn normal(&mut self, step: u64, channel: usize) -> f64;
}

/// What a step of a strong scheme needs to know of the Wiener processes W, one component a channel.
///
/// The pair is normal with mean 0, Var ΔW = h, Var ΔZ = h³/3 and Cov(ΔW, ΔZ) = h²/2 over a step of length h.
/// These are integrals of deterministic functions: Itô and Stratonovich agree on them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WienerIntegrals<W> {
    /// ΔW = W(t + h) − W(t), in s^½.
    pub dw: W,
    /// ΔZ = ∫ (W(s) − W(t)) ds over the step, in s^³⁄².
    pub dz: W,
}

impl<W> WienerIntegrals<W> {
    /// The integrals over a step of `dt`, in s, from two independent standard normal numbers a channel.
    #[inline(always)]
    pub fn from_normals<R: Real>(dt: f64, first: W, second: W) -> Self
    where
        W: Vector<R>,
    {
        let h = R::from_f64(dt);
        let root = h.sqrt();
        let dw = first.map(|z| root * z);
        let (half, spread) = (h * R::HALF, h * root * R::from_f64(HALF_OVER_SQRT_3));
        Self {
            dw,
            dz: dw.zip_with(second, |dw, z| half * dw + spread * z),
        }
    }

    /// The integrals over this step and the `next` one, of `next_dt`, in s, together.
    #[inline(always)]
    pub fn then<R: Real>(self, next: Self, next_dt: f64) -> Self
    where
        W: Vector<R>,
    {
        let h = R::from_f64(next_dt);
        Self {
            dw: self.dw.zip_with(next.dw, |a, b| a + b),
            dz: self
                .dz
                .zip_with(next.dz, |a, b| a + b)
                .zip_with(self.dw, |z, w| z + h * w),
        }
    }

    /// The integrals over the two halves of this step of `dt`, in s: a Brownian bridge in ΔW and ΔZ at once.
    ///
    /// `first` and `second` are independent standard normal numbers, one a channel. The halves have the law of the
    /// process given this step, and [`then`](Self::then) puts them together to this step again, but for rounding.
    #[inline(always)]
    pub fn bisect<R: Real>(self, dt: f64, first: W, second: W) -> (Self, Self)
    where
        W: Vector<R>,
    {
        let c = |value: f64| R::from_f64(value);
        let h = c(dt) * R::HALF;
        let root = h.sqrt();
        // The known part t of ΔZ − hΔW is a unit combination (√3/2, 1/2) of the difference s of the halves' ΔW
        // and the sum e of what the halves' ΔZ have of their own.
        let scale = c(SQRT_THREE_HALVES) / (h * root);
        let known = self.dz.zip_with(self.dw, |dz, dw| (dz - h * dw) * scale);
        let s = known.zip_with(first, |t, z| c(HALF_SQRT_3) * t + R::HALF * z);
        let e = known.zip_with(first, |t, z| R::HALF * t - c(HALF_SQRT_3) * z);
        let spread = root * c(INV_SQRT_2);
        let (half, own) = (h * R::HALF, h * root * c(HALF_OVER_SQRT_3) * c(INV_SQRT_2));

        let left = self.dw.zip_with(s, |w, s| R::HALF * w + spread * s);
        let right = self.dw.zip_with(s, |w, s| R::HALF * w - spread * s);
        let sum = e.zip_with(second, |e, d| own * (e + d));
        let difference = e.zip_with(second, |e, d| own * (e - d));
        (
            Self {
                dw: left,
                dz: left.zip_with(sum, |w, own| half * w + own),
            },
            Self {
                dw: right,
                dz: right.zip_with(difference, |w, own| half * w + own),
            },
        )
    }
}

/// The increments over the two halves of a step of `dt`, in s, whose increments are `dw`, in s^½: the Brownian bridge
/// of Lévy. `normals` are independent standard normal numbers, one a channel.
///
/// For schemes that use ΔW alone; [`WienerIntegrals::bisect`] keeps ΔZ too.
#[inline(always)]
pub fn bisect<R: Real, W: Vector<R>>(dw: W, dt: f64, normals: W) -> (W, W) {
    let spread = R::from_f64(dt).sqrt() * R::HALF;
    (
        dw.zip_with(normals, |w, z| R::HALF * w + spread * z),
        dw.zip_with(normals, |w, z| R::HALF * w - spread * z),
    )
}

/// One path of Wiener processes over a fixed time that can be looked at as finely as one likes.
///
/// Level l cuts the time into 2^l equal steps. The steps of a finer level add up to those of a coarser one, so coarse
/// and fine solutions see the same path. Nothing is stored: a step is found from the whole time by l bisections,
/// whose normal numbers come from the source, of which this path uses two channels for each of its own
/// and the steps below 2^l.
#[derive(Clone, Copy, Debug)]
pub struct BrownianPath<S> {
    source: S,
    duration: f64,
}

impl<S: NormalSource> BrownianPath<S> {
    /// The path of `source` over `duration`, in s.
    pub const fn new(source: S, duration: f64) -> Self {
        Self { source, duration }
    }

    /// Length of a step at `level`, in s.
    pub fn dt(&self, level: u32) -> f64 {
        (0..level).fold(self.duration, |dt, _| dt * 0.5)
    }

    /// The integrals over step `index` of `level`; `None` if `level` has no such step or is above 62.
    ///
    /// The numbers are `f64`'s, the same in every lane of `R`.
    pub fn integrals<R: Real, W: Vector<R>>(
        &mut self,
        level: u32,
        index: u64,
    ) -> Option<WienerIntegrals<W>> {
        if level > DEEPEST || index >> level != 0 {
            return None;
        }
        let (first, second) = self.normals(0);
        let mut dt = self.duration;
        let mut whole = WienerIntegrals::from_normals(dt, first, second);
        for depth in 0..level {
            let below = level - depth;
            let (first, second) = self.normals((1 << depth) + (index >> below));
            let (left, right) = whole.bisect(dt, first, second);
            whole = if (index >> (below - 1)) & 1 == 0 {
                left
            } else {
                right
            };
            dt *= 0.5;
        }
        Some(whole)
    }

    fn normals<R: Real, W: Vector<R>>(&mut self, node: u64) -> (W, W) {
        let source = &mut self.source;
        let mut pick = |offset: usize| {
            W::from_fn(|channel| R::from_f64(source.normal(node, 2 * channel + offset)))
        };
        (pick(0), pick(1))
    }
}
