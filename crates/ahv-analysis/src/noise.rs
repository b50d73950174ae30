//! Sources of Wiener increments.

use std::f64::consts::TAU;

use ahv_core::Vector;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// Words of 32 bits that a pair of normal numbers takes from a stream.
const WORDS_PER_PAIR: u128 = 4;

/// Standard normal numbers of one channel, by step.
struct Channel {
    stream: ChaCha8Rng,
    /// The second half of the latest pair, and the step to which it belongs.
    spare: Option<(u64, f64)>,
    /// Pair at which the stream stands.
    position: u64,
}

/// Wiener increments that are a function of (seed, member, channel, step) alone.
///
/// They depend neither on the order in which members run nor on the machine: the bits come from
/// ChaCha8 (member and channel select the stream, the step the place in it), and Box–Muller turns
/// them into normal numbers through `libm`. `rand_distr`'s normal distribution is not used: its
/// logarithm is the platform's as soon as any crate of a build enables `num-traits/std`, and it takes a random
/// number of words, so that no step could be reached without the ones before.
pub struct WienerSource {
    channels: Vec<Channel>,
}

impl WienerSource {
    /// A source of `channels` independent channels for run `member` of the experiment `seed`.
    pub fn new(seed: u64, member: u64, channels: usize) -> Self {
        let channel = |index: u64| {
            let mut key = [0; 32];
            for (bytes, word) in key.chunks_exact_mut(8).zip([seed, member, index, 0]) {
                bytes.copy_from_slice(&word.to_le_bytes());
            }
            Channel {
                stream: ChaCha8Rng::from_seed(key),
                spare: None,
                position: 0,
            }
        };
        Self {
            channels: (0..channels as u64).map(channel).collect(),
        }
    }

    /// The increments over step `step` of length `dt`, in s^½: normal, mean 0, variance `dt` (in s).
    ///
    /// The step's number selects the underlying normal number, `dt` only scales it. Components
    /// beyond the channels of this source are 0.
    pub fn increments<W: Vector<f64>>(&mut self, step: u64, dt: f64) -> W {
        let scale = libm::sqrt(dt);
        let mut channels = self.channels.iter_mut();
        W::from_fn(|_| {
            channels
                .next()
                .map_or(0.0, |channel| scale * channel.normal(step))
        })
    }
}

impl Channel {
    fn normal(&mut self, step: u64) -> f64 {
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

/// Two independent standard normal numbers from two uniform words (Box and Muller 1958).
fn box_muller(radius: u64, angle: u64) -> (f64, f64) {
    // 53 bits, shifted by one unit so that the logarithm never sees 0: u in (0, 1].
    let unit = |word: u64| ((word >> 11) + 1) as f64 * (1.0 / (1_u64 << 53) as f64);
    let radius = libm::sqrt(-2.0 * libm::log(unit(radius)));
    let (sin, cos) = libm::sincos(TAU * unit(angle));
    (radius * cos, radius * sin)
}
