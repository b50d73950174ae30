//! What the execution ports allow a function in lanes at best.

use std::hint::black_box;
use std::path::Path;
use std::time::Instant;

use serde::Serialize;

use crate::operations;
use crate::table::Table;

/// Additions and multiplications of a sine and cosine of a small angle in `ahv-core`.
const SIN_COS: [u64; 2] = [18, 17];
/// Those of an exponential.
const EXP: [u64; 2] = [18, 16];
/// Vectors that are added in a cycle, and as many that are multiplied: Zen 2 to 4.
const VECTORS: u64 = 2;
/// Members in a vector.
const WIDTH: u64 = 4;
/// Cycles of a multiplication of integers and an exclusive or after it, on all x86_64 since 2008.
const CHAIN: f64 = 4.0;
/// Links of the chain that the clock is measured by.
const LINKS: u32 = 2_000_000;
/// Times that it is measured.
const TRIES: u32 = 20;

/// The least time of a member's drift of DCOM.
#[derive(Serialize)]
pub(crate) struct Bound {
    pub(crate) additions: u64,
    pub(crate) multiplications: u64,
    pub(crate) cycles: f64,
    pub(crate) gigahertz: f64,
    pub(crate) nanoseconds: f64,
}

/// Counts the operations, and measures the clock.
///
/// # Errors
/// A function that does not say its operations.
pub(crate) fn measure(root: &Path) -> Result<Bound, String> {
    let count = operations::of(root, "dcom", "drift")?;
    let [additions, multiplications] = [(count.additions, 0), (count.multiplications, 1)]
        .map(|(own, kind)| own + count.sin_cos * SIN_COS[kind] + count.exp * EXP[kind]);
    let cycles = additions.max(multiplications) as f64 / (VECTORS * WIDTH) as f64;
    let gigahertz = clock();
    Ok(Bound {
        additions,
        multiplications,
        cycles,
        gigahertz,
        nanoseconds: cycles / gigahertz,
    })
}

/// The clock in GHz, at its fastest, from a chain of integer operations.
fn clock() -> f64 {
    let run = || {
        let (factor, mask) = (black_box(0x9E37_79B9_7F4A_7C15_u64), black_box(0xA5A5_u64));
        let start = Instant::now();
        let end = (0..LINKS).fold(black_box(1_u64), |x, _| x.wrapping_mul(factor) ^ mask);
        black_box(end);
        start.elapsed().as_secs_f64()
    };
    let least = (0..TRIES).map(|_| run()).fold(f64::INFINITY, f64::min);
    CHAIN * f64::from(LINKS) / least * 1e-9
}

impl Bound {
    /// For people; `measured` is the time in lanes, in ns.
    pub(crate) fn table(&self, measured: [f64; 2]) -> Table {
        let row = |name: &str, value: String| vec![name.to_owned(), value];
        let distance = measured.map(|it| it / self.nanoseconds);
        Table {
            title: "Bound of the execution ports".to_owned(),
            note: format!(
                "DCOM drift of a member in lanes. {VECTORS} vectors of {WIDTH} doubles are added in a cycle and {VECTORS} multiplied, as \
                 Zen 2 to 4 do; what there is more of bounds the time. Where two vectors of twice the width are added or multiplied in a \
                 cycle, as AVX-512 of Intel does, the bound is not greater. A sine and cosine has {} additions and {} multiplications, an \
                 exponential {} and {}. Divisions, comparisons, loads and stores are left out. The clock is that of a chain of \
                 integer operations at its fastest.",
                SIN_COS[0], SIN_COS[1], EXP[0], EXP[1]
            ),
            columns: vec!["of a member", "value"],
            rows: vec![
                row("additions", self.additions.to_string()),
                row("multiplications", self.multiplications.to_string()),
                row("cycles at least", format!("{:.1}", self.cycles)),
                row("clock, GHz", format!("{:.2}", self.gigahertz)),
                row("ns at least", format!("{:.1}", self.nanoseconds)),
                row("ns measured, median", format!("{:.1}", measured[0])),
                row("ns measured, least", format!("{:.1}", measured[1])),
                row("median over bound", format!("{:.2}", distance[0])),
                row("least over bound", format!("{:.2}", distance[1])),
            ],
        }
    }
}
