//! Members that fly on from where they are, until they pass a level.

use std::sync::atomic::Ordering;

use ahv_core::{GeneratedModel, Real, Vector};

use super::arithmetic::{Called, Member};
use super::batch::Batch;
use super::experiment::Particle;
use super::lanes::{LANES, Packed, of_lane};
use super::observe::{NEVER, Observer, Observers};
use super::scheme::Steps;
use crate::ordered::Control;

/// Steps between two looks at whether members still have to fly.
const STEPS_PER_PASSAGE_CHECK: u64 = 16;

/// A level of a state, passed where `sign` times the state is beyond `height`.
#[derive(Clone, Copy)]
pub(super) struct Goal {
    /// Number of the state.
    pub(super) state: usize,
    /// 1 for a level that is passed upwards, −1 downwards.
    pub(super) sign: f64,
    /// `sign` times the level.
    pub(super) height: f64,
}

/// What became of a member.
#[derive(Clone)]
pub(super) struct PassageRecord {
    /// Greatest height until it passed the goal, was lost, or time was over.
    pub(super) most: f64,
    /// Where it passed the goal.
    pub(super) at: Option<Particle>,
    /// Whether it was lost before.
    pub(super) lost: bool,
    /// Steps that it was computed for, beyond its passage included.
    pub(super) steps: u64,
}

/// Where the lanes of a batch pass a goal.
pub(super) struct FirstPassage<F: GeneratedModel> {
    goal: Goal,
    /// Step from which on nothing is looked for: time is over, or the lane is done.
    until: [u64; LANES],
    most: [f64; LANES],
    /// Steps after which the goal was passed, with state and input.
    step: [u64; LANES],
    x: F::StateOf<Packed>,
    u: F::InputOf<Packed>,
}

impl<F: GeneratedModel> Observer<F> for FirstPassage<F> {
    fn after_step(&mut self, x: &F::StateOf<Packed>, u: &F::InputOf<Packed>, step: u64) {
        let Some(values) = x.get(self.goal.state) else {
            return;
        };
        for lane in 0..LANES {
            let height = self.goal.sign * values.0[lane];
            if step >= self.until[lane] || height <= self.most[lane] {
                continue;
            }
            self.most[lane] = height;
            if height > self.goal.height {
                (self.step[lane], self.until[lane]) = (step, 0);
                F::update_state(&mut self.x, *x, |place, value| {
                    place.0[lane] = value.0[lane];
                });
                F::update_input(&mut self.u, *u, |place, value| {
                    place.0[lane] = value.0[lane];
                });
            }
        }
    }

    fn close(&mut self, lane: usize) {
        self.until[lane] = 0;
    }
}

impl<F: GeneratedModel> FirstPassage<F> {
    /// Before a flight of `steps`, of which these have flown a part.
    pub(super) fn new(goal: &Goal, steps: u64, flying: &[Particle]) -> Self {
        let mut until = [0; LANES];
        for (until, particle) in until.iter_mut().zip(flying) {
            *until = steps.saturating_sub(particle.step) + 1;
        }
        Self {
            goal: *goal,
            until,
            most: [f64::NEG_INFINITY; LANES],
            step: [NEVER; LANES],
            x: F::StateOf::splat(Packed::ZERO),
            u: F::InputOf::splat(Packed::ZERO),
        }
    }

    /// Last step that is looked at.
    fn end(&self) -> u64 {
        self.until.into_iter().max().unwrap_or(0).saturating_sub(1)
    }
}

/// Flies the members of a batch until each has passed the goal or its time is over; `None` if the work was stopped.
///
/// Who is beyond the goal already passes it at once: a step may lead past several levels.
pub(super) fn pass<F, S, A, E>(
    mut batch: Batch<'_, F, S>,
    mut passage: FirstPassage<F>,
    flying: &[Particle],
    control: &Control,
) -> Option<Vec<PassageRecord>>
where
    F: GeneratedModel,
    A: Member<F>,
    E: Member<F>,
    S: Steps<A::Model> + Steps<<Called<E> as Member<F>>::Model>,
{
    passage.after_step(&batch.x, &batch.u, 0);
    let count = flying.len().min(LANES) as u64;
    let mut end = passage.end();
    while batch.step < end {
        if control.stop.load(Ordering::Relaxed) {
            return None;
        }
        let (from, until) = (batch.step, end.min(batch.step + STEPS_PER_PASSAGE_CHECK));
        let mut observers = Observers {
            watches: &mut [],
            other: Some(&mut passage),
        };
        batch.advance::<A, E>(until, &mut observers);
        control
            .done
            .fetch_add((until - from) * count, Ordering::Relaxed);
        end = passage.end();
    }
    let passed = flying
        .iter()
        .take(LANES)
        .enumerate()
        .map(|(lane, particle)| {
            let step = Some(passage.step[lane]).filter(|&step| step != NEVER);
            PassageRecord {
                most: passage.most[lane],
                at: step.map(|step| Particle {
                    member: particle.member,
                    origin: particle.origin,
                    step: particle.step + step,
                    x: of_lane(&passage.x, lane),
                    u: of_lane(&passage.u, lane),
                }),
                lost: step.is_none() && batch.lost[lane].is_some(),
                steps: batch.step,
            }
        });
    Some(passed.collect())
}
