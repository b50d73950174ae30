use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use super::*;

/// Keys with every bit set, with none, and between.
const KEYS: [[u32; KEY]; 5] = [
    [0; KEY],
    [u32::MAX; KEY],
    [1, 0, 2, 0, 3, 0, 0, 0],
    [
        0x0302_0100,
        0x0706_0504,
        0x0b0a_0908,
        0x0f0e_0d0c,
        0x1312_1110,
        0x1716_1514,
        0x1b1a_1918,
        0x1f1e_1d1c,
    ],
    [0x9e37_79b9, 0x7f4a_7c15, 0, 0, 0, 0, 0, 0x8000_0000],
];
/// Where the counter's lower word ends too.
const COUNTERS: [u64; 8] = [
    0,
    1,
    2,
    1000,
    (1 << 32) - 1,
    1 << 32,
    (1 << 32) + 1,
    (1 << 59) + 7,
];

#[test]
fn blocks_are_those_of_rand_chacha() {
    let keys: [[u32; KEYS.len()]; KEY] = core::array::from_fn(|word| KEYS.map(|key| key[word]));
    for counter in COUNTERS {
        let together = blocks(&keys, counter);
        for (lane, key) in KEYS.iter().enumerate() {
            let mut seed = [0; 32];
            for (bytes, word) in seed.chunks_exact_mut(4).zip(key) {
                bytes.copy_from_slice(&word.to_le_bytes());
            }
            let mut generator = ChaCha8Rng::from_seed(seed);
            generator.set_word_pos(u128::from(counter) * WORDS as u128);
            let expected: [u32; WORDS] = core::array::from_fn(|_| generator.next_u32());
            assert_eq!(
                together.map(|word| word[lane]),
                expected,
                "key {lane}, block {counter}"
            );
            assert_eq!(
                blocks(&key.map(|word| [word]), counter).map(|[word]| word),
                expected
            );
        }
    }
}
