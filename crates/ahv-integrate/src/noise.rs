//! Sources of normal numbers.

#[cfg(feature = "chacha")]
pub use keyed::{KeyedNormals, NormalStream, WienerSource};
#[cfg(feature = "rand")]
pub use sequential::RandNormals;

#[cfg(feature = "chacha")]
mod keyed {
    use core::array::from_fn;
    use core::f64::consts::TAU;

    use ahv_core::{Real, Vector};
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::{Rng, SeedableRng};

    use crate::NormalSource;

    /// Words of 32 bits that a pair of normal numbers takes from a stream.
    const WORDS_PER_PAIR: u128 = 4;

    /// Standard normal numbers of one channel, each a function of (seed, member, channel, step) alone.
    ///
    /// The bits come from ChaCha8: seed, member and channel are its key, the step is the place in the stream.
    /// Box–Muller (Box and Muller 1958) turns them into normal numbers through `libm`, so that
    /// they are the same on every machine and in every order. Steps one after the other are cheapest.
    ///
    /// `rand_distr`'s normal distribution is not used: its logarithm is the platform's as soon as any crate of a build
    /// enables `num-traits/std`, and it takes a random number of words, so that no step could be reached without the
    /// ones before.
    #[derive(Clone, Debug)]
    pub struct NormalStream {
        stream: ChaCha8Rng,
        /// The second half of the latest pair, and the step to which it belongs.
        spare: Option<(u64, f64)>,
        /// Pair at which the stream stands.
        position: u64,
    }

    impl NormalStream {
        /// The stream of channel `channel` in run `member` of the experiment `seed`.
        pub fn new(seed: u64, member: u64, channel: u64) -> Self {
            let mut key = [0; 32];
            for (bytes, word) in key.chunks_exact_mut(8).zip([seed, member, channel, 0]) {
                for (byte, value) in bytes.iter_mut().zip(word.to_le_bytes()) {
                    *byte = value;
                }
            }
            Self {
                stream: ChaCha8Rng::from_seed(key),
                spare: None,
                position: 0,
            }
        }

        /// The number of this step.
        pub fn normal(&mut self, step: u64) -> f64 {
            if let Some((_, spare)) = self.spare.filter(|&(owner, _)| owner == step) {
                return spare;
            }
            let pair = step / 2;
            if pair != self.position {
                self.stream.set_word_pos(WORDS_PER_PAIR * u128::from(pair));
            }
            let (even, odd) = box_muller(self.stream.next_u64(), self.stream.next_u64());
            self.position = pair + 1;
            if step.is_multiple_of(2) {
                self.spare = Some((step + 1, odd));
                even
            } else {
                odd
            }
        }
    }

    /// The numbers of [`NormalStream`] for any number of channels, without state: a block of ChaCha8 each.
    ///
    /// What a [`BrownianPath`](crate::BrownianPath) is refined with.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct KeyedNormals {
        /// The experiment.
        pub seed: u64,
        /// The run of the experiment.
        pub member: u64,
    }

    impl NormalSource for KeyedNormals {
        fn normal(&mut self, step: u64, channel: usize) -> f64 {
            NormalStream::new(self.seed, self.member, channel as u64).normal(step)
        }
    }

    /// Wiener increments of `N` channels, each a function of (seed, member, channel, step) alone.
    ///
    /// One [`NormalStream`] a channel.
    /// Neither the order in which members run nor the machine matters.
    #[derive(Clone, Debug)]
    pub struct WienerSource<const N: usize> {
        channels: [NormalStream; N],
    }

    impl<const N: usize> WienerSource<N> {
        /// Channels 0 to `N` − 1 of run `member` of the experiment `seed`.
        pub fn new(seed: u64, member: u64) -> Self {
            Self {
                channels: from_fn(|channel| NormalStream::new(seed, member, channel as u64)),
            }
        }

        /// The increments over step `step` of length `dt`, in s^½: normal, mean 0, variance `dt` (in s).
        ///
        /// The step's number selects the underlying normal numbers, `dt` only scales them; every lane of a scalar with
        /// lanes gets the same ones. That `W` has `N` components is checked at compile time.
        pub fn increments<R: Real, W: Vector<R>>(&mut self, step: u64, dt: f64) -> W {
            const { assert!(W::LEN == N, "one channel a component") };
            let root = R::from_f64(dt).sqrt();
            let mut channels = self.channels.iter_mut();
            W::from_fn(|_| {
                channels
                    .next()
                    .map_or(R::ZERO, |channel| root * R::from_f64(channel.normal(step)))
            })
        }
    }

    /// Two independent standard normal numbers from two uniform words.
    fn box_muller(radius: u64, angle: u64) -> (f64, f64) {
        // 53 bits, shifted by one unit so that the logarithm never sees 0: u in (0, 1].
        let unit = |word: u64| ((word >> 11) + 1) as f64 * (1.0 / (1_u64 << 53) as f64);
        let radius = libm::sqrt(-2.0 * libm::log(unit(radius)));
        let (sin, cos) = libm::sincos(TAU * unit(angle));
        (radius * cos, radius * sin)
    }
}

#[cfg(feature = "rand")]
mod sequential {
    use ahv_core::{Real, Vector};
    use rand_distr::{Distribution, StandardNormal};

    use crate::{WeakIncrements, WienerIntegrals};

    /// Increments from any generator of `rand`, one after the other, through `rand_distr::StandardNormal`.
    ///
    /// Faster than keyed numbers, but a number depends on all that were drawn before it; and its last bit may depend
    /// on the platform's logarithm if a crate of the build enables `num-traits/std`. Every lane of a scalar with lanes
    /// gets the same number.
    #[derive(Clone, Debug)]
    pub struct RandNormals<G> {
        generator: G,
    }

    impl<G: rand::Rng> RandNormals<G> {
        /// Increments from `generator`, a generator or a mutable reference to one.
        pub const fn new(generator: G) -> Self {
            Self { generator }
        }

        /// Independent standard normal numbers, one a component.
        pub fn normals<R: Real, W: Vector<R>>(&mut self) -> W {
            W::from_fn(|_| R::from_f64(self.normal()))
        }

        /// Wiener increments over a step of `dt`, in s: mean 0 and variance `dt`, in s^½.
        pub fn increments<R: Real, W: Vector<R>>(&mut self, dt: f64) -> W {
            let root = R::from_f64(dt).sqrt();
            self.normals::<R, W>().map(|z| root * z)
        }

        /// ΔW and ΔZ over a step of `dt`, in s.
        pub fn integrals<R: Real, W: Vector<R>>(&mut self, dt: f64) -> WienerIntegrals<W> {
            WienerIntegrals::from_normals(dt, self.normals(), self.normals())
        }

        /// Increments for a scheme of weak order 2 over a step of `dt`, in s.
        pub fn weak_increments<R: Real, W: Vector<R>>(&mut self, dt: f64) -> WeakIncrements<W> {
            WeakIncrements::from_normals(dt, |_| self.normal())
        }

        fn normal(&mut self) -> f64 {
            StandardNormal.sample(&mut self.generator)
        }
    }
}
