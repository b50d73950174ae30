//! The times of the kernels.

use serde::Serialize;

use crate::candidates::Candidate;
use crate::points::Points;
use crate::rounds::{Spread, interleave};
use crate::subject::SUBJECTS;

/// Rounds of kernels before those that count.
const WARM_UP: u32 = 20;

/// A candidate's times for one subject.
#[derive(Serialize)]
pub(crate) struct Timing {
    pub(crate) function: &'static str,
    pub(crate) candidate: &'static str,
    pub(crate) built: String,
    /// Nanoseconds an evaluation.
    pub(crate) nanoseconds: Spread,
    /// Time over that of the reference in the same round.
    pub(crate) ratio: Spread,
}

/// Times all candidates, by subject and then in the order of the candidates.
///
/// # Errors
/// A peer that does not answer.
pub(crate) fn measure(
    candidates: &mut [Candidate],
    points: &[Points],
    rounds: u32,
) -> Result<Vec<Timing>, String> {
    let mut timings = Vec::new();
    for (index, (subject, points)) in SUBJECTS.iter().zip(points).enumerate() {
        let measured = interleave(candidates.len(), WARM_UP, rounds, |candidate, round| {
            let seconds = candidates[candidate].kernels[index].turn(points, round)?;
            Ok(seconds * 1e9)
        })?;
        for (candidate, measured) in candidates.iter().zip(measured) {
            timings.push(Timing {
                function: subject.symbol,
                candidate: candidate.name,
                built: candidate.built.clone(),
                nanoseconds: measured.time,
                ratio: measured.ratio,
            });
        }
    }
    Ok(timings)
}
