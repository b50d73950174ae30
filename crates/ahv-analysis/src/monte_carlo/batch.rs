//! Members side by side, from step to step.

use std::borrow::Cow;
use std::marker::PhantomData;

use ahv_core::{GeneratedModel, Real};
use ahv_integrate::{NormalLanes, Precision, StepError};

use super::arithmetic::{Arithmetic, Called, Member};
use super::feedback::SampledFeedback;
use super::lanes::{LANES, Packed, of_lane};
use super::observe::Observers;
use super::scheme::{MOST_NORMALS, Steps};

/// How a member ended before its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loss {
    /// Number of the step that failed.
    pub step: u64,
    /// State that became infinite or NaN; empty where it is for a rule.
    pub state: &'static str,
    /// The rule that the drawn parameters break: such a member does not fly.
    pub rule: Option<&'static str>,
}

/// The normal numbers of a batch, in the order in which a step takes them.
pub(super) enum Noise {
    Double(Vec<Option<NormalLanes<f64, LANES>>>),
    Single(Vec<Option<NormalLanes<f32, LANES>>>),
}

impl Noise {
    /// Those of these members; channels that are not used have none.
    pub(super) fn new(seed: u64, members: [u64; LANES], used: &[bool], single: bool) -> Self {
        let numbered = || used.iter().copied().zip(0_u64..);
        if single {
            let streams = numbered()
                .map(|(used, channel)| used.then(|| NormalLanes::new(seed, members, channel)));
            Self::Single(streams.collect())
        } else {
            let streams = numbered()
                .map(|(used, channel)| used.then(|| NormalLanes::new(seed, members, channel)));
            Self::Double(streams.collect())
        }
    }

    /// Puts the numbers of a step to their places; those that are not used stay.
    #[inline(always)]
    pub(super) fn fill(&mut self, numbers: &mut [Packed; MOST_NORMALS], step: u64) {
        match self {
            Self::Double(channels) => fill(numbers, channels, step, |number| number),
            Self::Single(channels) => fill(numbers, channels, step, f64::from),
        }
    }
}

#[inline(always)]
fn fill<T: Precision>(
    numbers: &mut [Packed; MOST_NORMALS],
    channels: &mut [Option<NormalLanes<T, LANES>>],
    step: u64,
    widened: impl Fn(T) -> f64,
) {
    for (place, channel) in numbers.iter_mut().zip(channels) {
        if let Some(channel) = channel {
            *place = channel.normal(step).map(&widened);
        }
    }
}

/// What members fly.
#[derive(Clone, Copy)]
pub(super) struct Dynamics<F: GeneratedModel, S> {
    pub(super) model: F::With<Packed>,
    pub(super) scheme: S,
}

/// [`LANES`] members in flight.
pub(super) struct Batch<'c, F: GeneratedModel, S: Copy> {
    dynamics: Cow<'c, Dynamics<F, S>>,
    law: Option<SampledFeedback<F>>,
    noise: Noise,
    dt: f64,
    /// Step that comes next.
    pub(super) step: u64,
    pub(super) x: F::StateOf<Packed>,
    pub(super) u: F::InputOf<Packed>,
    /// Where the members started: a lane flies on from there when its member is lost.
    start: F::StateOf<Packed>,
    pub(super) lost: [Option<Loss>; LANES],
    /// Last states of those that are lost.
    last: F::StateOf<Packed>,
}

/// Steps a batch with the instructions of the machine that it runs on.
struct Advance<'b, 'c, 'o, F: GeneratedModel, S: Copy, A> {
    batch: &'b mut Batch<'c, F, S>,
    observers: &'b mut Observers<'o, F>,
    /// Step to stop before.
    until: u64,
    /// Fast, and for what is stepped again.
    arithmetic: PhantomData<A>,
}

impl<F, S, A, E> pulp::WithSimd for Advance<'_, '_, '_, F, S, (A, E)>
where
    F: GeneratedModel,
    A: Member<F>,
    E: Member<F>,
    S: Steps<A::Model> + Steps<<Called<E> as Member<F>>::Model>,
{
    type Output = ();

    #[inline(always)]
    fn with_simd<V: pulp::Simd>(self, _: V) {
        let (batch, observers) = (self.batch, self.observers);
        let dt = batch.dt;
        // Known to hold from here on, it costs nothing in the loop.
        if !(dt > 0.0 && dt.is_finite()) {
            return;
        }
        // Local copies, of which the compiler knows that no store to a state changes them.
        let (Dynamics { model, scheme }, law) = (*batch.dynamics, batch.law);
        let (mut x, mut u, mut normals) = (batch.x, batch.u, [Packed::ZERO; MOST_NORMALS]);
        let mut next = x;
        while batch.step < self.until {
            batch.noise.fill(&mut normals, batch.step);
            if let Some(law) = &law {
                law.apply(&x, &mut u, batch.step);
            }
            // A loop over members around code without branches: it becomes vector instructions.
            for lane in 0..LANES {
                let mut member = F::map_state(&x, |numbers| A::Scalar::of(numbers.0[lane]));
                // A scalar without branches has no failure.
                let _ = step::<F, S, A>((&model, &scheme), dt, &mut member, &u, &normals, lane);
                F::update_state(&mut next, member, |place, value| {
                    place.0[lane] = value.value();
                });
            }
            let mut sound = true;
            for lane in 0..LANES {
                let mut sum = 0.0;
                F::map_state(&next, |value| sum += value.0[lane] * 0.0);
                sound &= sum == 0.0;
            }
            if !sound {
                batch.repair::<Called<E>>((&x, &u, &normals), &mut next, observers);
            }
            x = next;
            batch.step += 1;
            observers.after_step(&x, &u, batch.step);
        }
        (batch.x, batch.u) = (x, u);
    }
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
impl<F: GeneratedModel, S: Copy, A, E> Advance<'_, '_, '_, F, S, (A, E)> {
    /// Steps member after member, with the instructions that every machine has.
    fn one_by_one(self)
    where
        E: Member<F>,
        S: Steps<<Called<E> as Member<F>>::Model>,
    {
        let work = Advance {
            batch: self.batch,
            observers: self.observers,
            until: self.until,
            arithmetic: PhantomData::<(Called<E>, E)>,
        };
        pulp::WithSimd::with_simd(work, pulp::Scalar);
    }
}

/// Steps one member.
#[inline(always)]
pub(super) fn step<F, S, A>(
    (model, scheme): (&F::With<Packed>, &S),
    dt: f64,
    x: &mut F::StateOf<A::Scalar>,
    u: &F::InputOf<Packed>,
    normals: &[Packed; MOST_NORMALS],
    lane: usize,
) -> Result<(), StepError<A::Scalar>>
where
    F: GeneratedModel,
    A: Member<F>,
    S: Steps<A::Model>,
{
    let pick = |numbers: &Packed| A::Scalar::of(numbers.0[lane]);
    let (model, u) = (A::model(model, lane), F::map_input(u, pick));
    scheme.step(dt, pick, &model, x, &u, |channel| normals[channel].0[lane])
}

impl<'c, F: GeneratedModel, S: Copy> Batch<'c, F, S> {
    /// The batch before its first step.
    pub(super) fn new(
        dynamics: Cow<'c, Dynamics<F, S>>,
        (x, u): (F::StateOf<Packed>, F::InputOf<Packed>),
        dt: f64,
        noise: Noise,
        law: Option<SampledFeedback<F>>,
    ) -> Self {
        Self {
            dynamics,
            law,
            noise,
            dt,
            step: 0,
            x,
            u,
            start: x,
            lost: [None; LANES],
            last: x,
        }
    }

    /// Flies until before this step, with the instructions of the machine.
    ///
    /// On x86 those are AVX-512, where all members fill a register, or AVX2 and FMA. Without either members are stepped one by
    /// one: a copy more of every loop, for machines of the past, would take long to compile.
    #[inline(never)]
    pub(super) fn advance<A, E>(&mut self, until: u64, observers: &mut Observers<'_, F>)
    where
        A: Member<F>,
        E: Member<F>,
        S: Steps<A::Model> + Steps<<Called<E> as Member<F>>::Model>,
    {
        let work = Advance {
            batch: self,
            observers,
            until,
            arithmetic: PhantomData::<(A, E)>,
        };
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        if A::SIDE_BY_SIDE {
            if let Some(machine) = pulp::x86::V4::try_new() {
                pulp::Simd::vectorize(machine, work);
            } else if let Some(machine) = pulp::x86::V3::try_new() {
                pulp::Simd::vectorize(machine, work);
            } else {
                work.one_by_one();
            }
        } else {
            work.one_by_one();
        }
        #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
        pulp::Arch::new().dispatch(work);
    }

    /// The state of a member; of one that is lost the last that was finite.
    pub(super) fn last(&self, lane: usize) -> Vec<f64> {
        let flies = self.lost.get(lane).is_some_and(Option::is_none);
        of_lane(if flies { &self.x } else { &self.last }, lane)
    }

    /// Steps members again whose result is not finite: exactly, they may have one. Those that have none are lost.
    #[cold]
    #[inline(never)]
    fn repair<E>(
        &mut self,
        (x, u, normals): (
            &F::StateOf<Packed>,
            &F::InputOf<Packed>,
            &[Packed; MOST_NORMALS],
        ),
        next: &mut F::StateOf<Packed>,
        observers: &mut Observers<'_, F>,
    ) where
        E: Member<F>,
        S: Steps<E::Model>,
    {
        for lane in 0..LANES {
            let mut finite = true;
            F::map_state(next, |value| finite &= value.0[lane].is_finite());
            if finite {
                continue;
            }
            let mut member = F::map_state(x, |numbers| E::Scalar::of(numbers.0[lane]));
            let Dynamics { model, scheme } = self.dynamics.as_ref();
            match step::<F, S, E>((model, scheme), self.dt, &mut member, u, normals, lane) {
                Ok(()) => F::update_state(next, member, |place, value| {
                    place.0[lane] = value.value();
                }),
                Err(error) => {
                    self.lose(lane, x, error);
                    observers.close(lane);
                    // The lane flies on from where it is safe, unseen.
                    F::update_state(next, self.start, |place, value| {
                        place.0[lane] = value.0[lane];
                    });
                }
            }
        }
    }

    /// Leaves a member on the ground, whose parameters break a rule.
    pub(super) fn ground(&mut self, lane: usize, rule: &'static str) {
        if let Some(lost) = self.lost.get_mut(lane) {
            *lost = Some(Loss {
                step: 0,
                state: "",
                rule: Some(rule),
            });
        }
    }

    fn lose<R: Real>(&mut self, lane: usize, x: &F::StateOf<Packed>, error: StepError<R>) {
        let Some(lost @ None) = self.lost.get_mut(lane) else {
            return;
        };
        let state = match error {
            StepError::NonFinite { name, .. } => name,
            StepError::StepSize { .. } => "",
        };
        *lost = Some(Loss {
            step: self.step,
            state,
            rule: None,
        });
        F::update_state(&mut self.last, *x, |place, value| {
            place.0[lane] = value.0[lane];
        });
    }
}
