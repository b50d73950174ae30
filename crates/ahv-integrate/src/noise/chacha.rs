//! ChaCha8 (Bernstein 2008), several keys side by side.

/// Words of 32 bits in a block.
pub(super) const WORDS: usize = 16;
/// Words of 32 bits in a key.
pub(super) const KEY: usize = 8;

/// "expand 32-byte k"
const CONSTANTS: [u32; 4] = [0x6170_7865, 0x3320_646e, 0x7962_2d32, 0x6b20_6574];

/// Block number `counter` of the stream of each of `N` keys, word by word: 4 double rounds, 64 bits of counter, no nonce.
///
/// A loop over keys around straight code, for the compiler to turn into vector instructions.
#[inline(always)]
pub(super) fn blocks<const N: usize>(keys: &[[u32; N]; KEY], counter: u64) -> [[u32; N]; WORDS] {
    let mut result = [[0; N]; WORDS];
    let [c0, c1, c2, c3] = CONSTANTS;
    let [k0, k1, k2, k3, k4, k5, k6, k7] = keys;
    let (low, high) = (counter as u32, (counter >> 32) as u32);
    for lane in 0..N {
        let start = [
            c0, c1, c2, c3, k0[lane], k1[lane], k2[lane], k3[lane], k4[lane], k5[lane], k6[lane],
            k7[lane], low, high, 0, 0,
        ];
        let state = double_round(double_round(double_round(double_round(start))));
        for word in 0..WORDS {
            result[word][lane] = state[word].wrapping_add(start[word]);
        }
    }
    result
}

#[inline(always)]
fn double_round(state: [u32; WORDS]) -> [u32; WORDS] {
    let [
        a0,
        a1,
        a2,
        a3,
        b0,
        b1,
        b2,
        b3,
        c0,
        c1,
        c2,
        c3,
        d0,
        d1,
        d2,
        d3,
    ] = state;
    let [a0, b0, c0, d0] = quarter_round([a0, b0, c0, d0]);
    let [a1, b1, c1, d1] = quarter_round([a1, b1, c1, d1]);
    let [a2, b2, c2, d2] = quarter_round([a2, b2, c2, d2]);
    let [a3, b3, c3, d3] = quarter_round([a3, b3, c3, d3]);
    let [a0, b1, c2, d3] = quarter_round([a0, b1, c2, d3]);
    let [a1, b2, c3, d0] = quarter_round([a1, b2, c3, d0]);
    let [a2, b3, c0, d1] = quarter_round([a2, b3, c0, d1]);
    let [a3, b0, c1, d2] = quarter_round([a3, b0, c1, d2]);
    [
        a0, a1, a2, a3, b0, b1, b2, b3, c0, c1, c2, c3, d0, d1, d2, d3,
    ]
}

#[inline(always)]
fn quarter_round([a, b, c, d]: [u32; 4]) -> [u32; 4] {
    let a = a.wrapping_add(b);
    let d = (d ^ a).rotate_left(16);
    let c = c.wrapping_add(d);
    let b = (b ^ c).rotate_left(12);
    let a = a.wrapping_add(b);
    let d = (d ^ a).rotate_left(8);
    let c = c.wrapping_add(d);
    let b = (b ^ c).rotate_left(7);
    [a, b, c, d]
}

#[cfg(test)]
mod tests;
