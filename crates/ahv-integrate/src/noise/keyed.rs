//! Normal numbers as functions of seed, member, channel and step.

use core::array::from_fn;

use ahv_core::{Lanes, Real, Vector};

use super::box_muller::{MOST, Precision};
use super::chacha::{KEY, blocks};
use crate::NormalSource;

/// Standard normal numbers of one channel in `N` members side by side, each a function of (seed, member, channel, step) alone.
///
/// With `T` = `f64` a lane has the bits of [`NormalStream`]; `f32` takes fewer random bits and less time, and its numbers
/// have 20 correct bits and reach to 6.5.
#[derive(Clone, Copy, Debug)]
pub struct NormalLanes<T, const N: usize> {
    key: [[u32; N]; KEY],
    /// `None` before the first.
    block: Option<u64>,
    numbers: Numbers<T, N>,
}

/// The numbers of a block, aligned as a whole: single lanes take no room for others.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
struct Numbers<T, const N: usize>([[T; N]; MOST]);

impl<T: Precision, const N: usize> NormalLanes<T, N> {
    /// The streams of channel `channel` in runs `members` of the experiment `seed`.
    pub fn new(seed: u64, members: [u64; N], channel: u64) -> Self {
        let low = |word: u64| [word as u32; N];
        let high = |word: u64| [(word >> 32) as u32; N];
        Self {
            key: [
                low(seed),
                high(seed),
                members.map(|member| member as u32),
                members.map(|member| (member >> 32) as u32),
                low(channel),
                high(channel),
                [0; N],
                [0; N],
            ],
            block: None,
            numbers: Numbers([[T::ZERO; N]; MOST]),
        }
    }

    /// The numbers of this step.
    #[inline(always)]
    pub fn normal(&mut self, step: u64) -> Lanes<T, N> {
        let block = step / T::PER_BLOCK;
        if self.block != Some(block) {
            T::fill(&mut self.numbers.0, &blocks(&self.key, block));
            self.block = Some(block);
        }
        let place = (step % T::PER_BLOCK) as usize;
        self.numbers
            .0
            .get(place)
            .map_or(Lanes::ZERO, |&numbers| Lanes(numbers))
    }
}

/// Standard normal numbers of one channel, each a function of (seed, member, channel, step) alone.
///
/// The bits come from ChaCha8: seed, member and channel are its key, the step is the place in the stream.
/// Box–Muller (Box and Muller 1958) turns them into normal numbers by additions, multiplications, a division and a square
/// root, so that they are the same on every machine, in every order, and in the lanes of [`NormalLanes`]. Steps one after the
/// other are cheapest. Numbers have 44 correct bits and reach to 8.5.
///
/// `rand_distr`'s normal distribution is not used: its logarithm is the platform's as soon as any crate of a build
/// enables `num-traits/std`, and it takes a random number of words, so that no step could be reached without the
/// ones before.
#[derive(Clone, Debug)]
pub struct NormalStream {
    channel: NormalLanes<f64, 1>,
}

impl NormalStream {
    /// The stream of channel `channel` in run `member` of the experiment `seed`.
    pub fn new(seed: u64, member: u64, channel: u64) -> Self {
        Self {
            channel: NormalLanes::new(seed, [member], channel),
        }
    }

    /// The number of this step.
    pub fn normal(&mut self, step: u64) -> f64 {
        let Lanes([number]) = self.channel.normal(step);
        number
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
