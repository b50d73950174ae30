//! Propagation of the members of an experiment by its scheme and in its mode, which are chosen at run time.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::sync::atomic::Ordering;

use ahv_core::{Bounds, Branchless, CountVisitor, GeneratedModel, NoInline};
use ahv_integrate::{
    Checked, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1, ItoStrangSplitting,
    SdeScheme, StratonovichHeun,
};

use super::MonteCarloError;
use super::arithmetic::{Arithmetic, Called, In, Member, Mode};
use super::batch::{Batch, Dynamics, Noise, step};
use super::experiment::{Experiment, MemberRecord, Particle};
use super::lanes::{self, LANES, Packed, of_lane, packed, push_lane};
use super::observe::{BoundsMonitor, Observers};
use super::passage::{FirstPassage, Goal, PassageRecord, pass};
use super::scheme::{MOST_NORMALS, OneByOne, Scheme, Steps};
use crate::ordered::Control;
use crate::values::vector;

/// Steps between two looks at whether to stop.
pub(super) const STEPS_PER_STOP_CHECK: u64 = 1024;
/// Where in the validity box it is asked which noise moves the states; there is nothing special about it.
const FRACTION: f64 = 0.618;

/// Propagates members of an experiment.
pub(super) trait Propagator: Send + Sync {
    /// Which normal numbers a step uses.
    fn used(&self) -> &[bool; MOST_NORMALS];

    /// The state after a step of a member with the experiment's own parameters from this state, with this input and these normal
    /// numbers; not a number where it has none.
    fn after_step(&self, x: &[f64], u: &[f64], normals: &[f64; MOST_NORMALS]) -> Vec<f64>;

    /// Flies members, at most [`LANES`], and tells their states after each of these numbers of steps, which ascend; `None` if
    /// the work was stopped.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError::Scheme`] for parameters that the scheme is not for.
    fn fly(
        &self,
        members: &[u64],
        snapshots: &[u64],
        control: &Control,
    ) -> Result<Option<Vec<MemberRecord>>, MonteCarloError>;

    /// Flies members, at most [`LANES`], from where they are until they pass the goal or time is over; `None` if the work was
    /// stopped.
    ///
    /// # Errors
    ///
    /// As [`Self::fly`].
    fn pass(
        &self,
        flying: &[Particle],
        goal: &Goal,
        control: &Control,
    ) -> Result<Option<Vec<PassageRecord>>, MonteCarloError>;
}

/// The propagator of the members, with the scheme that is asked for.
pub(super) fn propagator<F: GeneratedModel>(
    experiment: &Experiment,
) -> Result<Box<dyn Propagator + '_>, MonteCarloError> {
    match experiment.scheme {
        Scheme::Splitting => F::coloured(BySplitting::<F>(experiment, PhantomData))
            .unwrap_or(Err(MonteCarloError::NoColouredNoise { model: F::NAME })),
        Scheme::Heun => side_by_side::<F, ItoHeun>(experiment),
        Scheme::EulerMaruyama => side_by_side::<F, ItoEulerMaruyama>(experiment),
        Scheme::StratonovichHeun => one_by_one::<F, StratonovichHeun>(experiment),
        Scheme::Milstein => one_by_one::<F, Checked<ItoMilstein>>(experiment),
        Scheme::Sra1 => one_by_one::<F, Checked<ItoSra1>>(experiment),
        Scheme::Dri1 => one_by_one::<F, ItoDri1>(experiment),
    }
}

/// Members by vector instructions.
fn side_by_side<F, S>(experiment: &Experiment) -> Result<Box<dyn Propagator + '_>, MonteCarloError>
where
    F: GeneratedModel,
    S: SdeScheme<F::With<Packed>>
        + Steps<F::With<Branchless<f64>>>
        + Steps<NoInline<F::With<f64>>>
        + 'static,
{
    BatchPropagator::<F, S, In<Branchless<f64>>, In<f64>>::new::<S>(experiment)
}

/// Members one after the other, all schemes in one loop.
fn one_by_one<F, S>(experiment: &Experiment) -> Result<Box<dyn Propagator + '_>, MonteCarloError>
where
    F: GeneratedModel,
    S: SdeScheme<F::With<Packed>> + Into<OneByOne>,
{
    BatchPropagator::<F, OneByOne, Called<In<f64>>, In<f64>>::new::<S>(experiment)
}

impl Scheme {
    /// The scheme where none is asked for: the splitting, which steps coloured noise exactly, where the model of these
    /// parameters has coloured noise with channels of its own; else Heun's.
    pub fn default_for<F: GeneratedModel>(parameters: &[f64]) -> Self {
        match F::coloured(Splits::<F>(vector(parameters))) {
            Some(true) => Self::Splitting,
            _ => Self::Heun,
        }
    }
}

/// Whether the model of these parameters can be split.
struct Splits<F: GeneratedModel>(F::ParametersOf<f64>);

impl<F: GeneratedModel> CountVisitor for Splits<F> {
    type Output = bool;

    fn visit<const N: usize>(self) -> bool {
        let (x, u) = generic_point::<F>();
        let model = F::with_parameters(&self.0);
        ItoStrangSplitting::<f64, N>::new(&model, &x, &u, 1.0).is_ok()
    }
}

/// An experiment by the splitting.
struct BySplitting<'e, F>(&'e Experiment, PhantomData<fn() -> F>);

impl<'e, F: GeneratedModel> CountVisitor for BySplitting<'e, F> {
    type Output = Result<Box<dyn Propagator + 'e>, MonteCarloError>;

    fn visit<const N: usize>(self) -> Self::Output {
        side_by_side::<F, ItoStrangSplitting<Packed, N>>(self.0)
    }
}

/// Sets up a scheme of the form `S` for the parameters of a batch.
type SetUp<F, S> = fn(&Experiment, [&[f64]; LANES]) -> Result<Dynamics<F, S>, MonteCarloError>;

/// A propagator with a scheme `S`, fast in the arithmetic `A` and again in `E` where that has no result.
struct BatchPropagator<'e, F: GeneratedModel, S, A, E> {
    experiment: &'e Experiment,
    /// The model of the experiment's own parameters.
    shared: Dynamics<F, S>,
    /// Makes those of dispersed parameters.
    dynamics: SetUp<F, S>,
    /// Normal numbers that a step uses.
    used: [bool; MOST_NORMALS],
    arithmetic: PhantomData<fn() -> (A, E)>,
}

/// A state and an input in the validity box at which no noise is 0 by chance: what a scheme is set up at.
pub fn generic_point<F: GeneratedModel>() -> (F::StateOf<f64>, F::InputOf<f64>) {
    let between = |bounds: &Bounds| {
        let value = bounds.min + FRACTION * (bounds.max - bounds.min);
        if value.is_finite() { value } else { FRACTION }
    };
    (
        F::map_state(&F::STATE_BOUNDS, between),
        F::map_input(&F::INPUT_BOUNDS, between),
    )
}

/// The same for members side by side.
fn generic_members<F: GeneratedModel>() -> (F::StateOf<Packed>, F::InputOf<Packed>) {
    let (x, u) = generic_point::<F>();
    let splat = |&value: &f64| Packed::splat(value);
    (F::map_state(&x, splat), F::map_input(&u, splat))
}

/// The rule that parameters break. Not inlined, as other work on all fields of a vector: each scheme would have a copy.
#[inline(never)]
fn broken_rule<F: GeneratedModel>(parameters: &[f64]) -> Option<&'static str> {
    F::broken_rule(&vector(parameters)).map(|rule| rule.reason)
}

/// The scheme `S` for a model of this experiment.
fn set_up<F: GeneratedModel, S: SdeScheme<F::With<Packed>>>(
    experiment: &Experiment,
    model: &F::With<Packed>,
) -> Result<S, MonteCarloError> {
    let (x, u) = generic_members::<F>();
    S::set_up(model, &x, &u, experiment.dt).map_err(|reason| MonteCarloError::Scheme {
        scheme: experiment.scheme.name(),
        reason,
    })
}

/// The model of these parameters, and the scheme for it, which is `Own` in the form `S`.
fn dynamics<F: GeneratedModel, Own: SdeScheme<F::With<Packed>> + Into<S>, S>(
    experiment: &Experiment,
    parameters: [&[f64]; LANES],
) -> Result<Dynamics<F, S>, MonteCarloError> {
    let model = packed::<F>(parameters);
    let scheme = set_up::<F, Own>(experiment, &model)?.into();
    Ok(Dynamics { model, scheme })
}

impl<'e, F, S, A, E> BatchPropagator<'e, F, S, A, E>
where
    F: GeneratedModel,
    A: Member<F> + 'e,
    E: Member<F> + 'e,
    S: Steps<A::Model> + Steps<<Called<E> as Member<F>>::Model> + 'e,
{
    /// With the scheme `Own`.
    #[allow(
        clippy::new_ret_no_self,
        reason = "callers need no more than the trait"
    )]
    fn new<Own>(experiment: &'e Experiment) -> Result<Box<dyn Propagator + 'e>, MonteCarloError>
    where
        Own: SdeScheme<F::With<Packed>> + Into<S>,
    {
        if !(experiment.dt > 0.0 && experiment.dt.is_finite()) {
            return Err(MonteCarloError::StepSize(experiment.dt));
        }
        let shared = dynamics::<F, Own, S>(experiment, [&*experiment.parameters; LANES])?;
        let scheme: Own = set_up::<F, Own>(experiment, &shared.model)?;
        let normals = scheme.normals();
        if normals > MOST_NORMALS {
            return Err(MonteCarloError::Normals { normals });
        }
        let (x, u) = generic_members::<F>();
        let used = std::array::from_fn(|index| scheme.uses(&shared.model, &x, &u, index));
        Ok(Box::new(Self {
            experiment,
            shared,
            dynamics: dynamics::<F, Own, S>,
            used,
            arithmetic: PhantomData,
        }))
    }

    /// The batch of members that fly on from where they are; its steps count from there. `observers` look away from those whose
    /// parameters break a rule.
    fn batch(
        &self,
        flying: &[Particle],
        observers: &mut Observers<'_, F>,
    ) -> Result<Batch<'_, F, S>, MonteCarloError> {
        let experiment = self.experiment;
        // Lanes without member repeat the last one.
        let first = experiment.particle(0);
        let last = flying.last().unwrap_or(&first);
        let flying: [&Particle; LANES] =
            std::array::from_fn(|lane| flying.get(lane).unwrap_or(last));
        let mut broken = [None; LANES];
        let dynamics = match &experiment.dispersion {
            None => Cow::Borrowed(&self.shared),
            Some(draws) => {
                let mut parameters = flying.map(|particle| draws.member_values(particle.origin));
                for (parameters, broken) in parameters.iter_mut().zip(&mut broken) {
                    *broken = broken_rule::<F>(parameters);
                    // The lane flies all the same, unseen.
                    if broken.is_some() {
                        parameters.clone_from(&experiment.parameters);
                    }
                }
                Cow::Owned((self.dynamics)(
                    experiment,
                    parameters.each_ref().map(|it| &**it),
                )?)
            }
        };
        let x = lanes::side_by_side(flying.map(|particle| &*particle.x));
        let u = lanes::side_by_side(flying.map(|particle| &*particle.u));
        let members = flying.map(|particle| particle.member);
        let single = experiment.mode == Mode::F32Noise;
        let noise = Noise::new(experiment.seed, members, &self.used, single);
        let law = experiment
            .feedback
            .as_ref()
            .map(|feedback| feedback.over(experiment.dt, flying.map(|particle| particle.step)));
        let mut batch = Batch::new(dynamics, (x, u), experiment.dt, noise, law);
        for (lane, rule) in broken.into_iter().enumerate() {
            if let Some(rule) = rule {
                batch.ground(lane, rule);
                observers.close(lane);
            }
        }
        Ok(batch)
    }
}

impl<F, S, A, E> Propagator for BatchPropagator<'_, F, S, A, E>
where
    F: GeneratedModel,
    A: Member<F>,
    E: Member<F>,
    S: Steps<A::Model> + Steps<<Called<E> as Member<F>>::Model>,
{
    fn used(&self) -> &[bool; MOST_NORMALS] {
        &self.used
    }

    fn after_step(&self, x: &[f64], u: &[f64], normals: &[f64; MOST_NORMALS]) -> Vec<f64> {
        let Dynamics { model, scheme } = &self.shared;
        let x: F::StateOf<Packed> = lanes::side_by_side([x; LANES]);
        let u: F::InputOf<Packed> = lanes::side_by_side([u; LANES]);
        let normals = normals.map(Packed::splat);
        let mut member = F::map_state(&x, |numbers| E::Scalar::of(numbers.0[0]));
        let stepped = step::<F, S, Called<E>>(
            (model, scheme),
            self.experiment.dt,
            &mut member,
            &u,
            &normals,
            0,
        );
        let after = F::map_state(&member, |value| match stepped {
            Ok(()) => Packed::splat(value.value()),
            Err(_) => Packed::splat(f64::NAN),
        });
        of_lane(&after, 0)
    }

    fn fly(
        &self,
        members: &[u64],
        snapshots: &[u64],
        control: &Control,
    ) -> Result<Option<Vec<MemberRecord>>, MonteCarloError> {
        let experiment = self.experiment;
        let flying: Vec<_> = members
            .iter()
            .map(|&member| experiment.particle(member))
            .collect();
        let mut watches: Vec<BoundsMonitor<F>> = experiment
            .watched
            .iter()
            .map(|it| BoundsMonitor::new(it))
            .collect();
        let mut observers = Observers {
            watches: &mut watches,
            other: None,
        };
        let mut batch = self.batch(&flying, &mut observers)?;
        let count = members.len().min(LANES);
        let mut at = vec![(Vec::new(), Vec::new()); count];
        for &snapshot in snapshots {
            while batch.step < snapshot {
                if control.stop.load(Ordering::Relaxed) {
                    return Ok(None);
                }
                let (from, until) = (batch.step, snapshot.min(batch.step + STEPS_PER_STOP_CHECK));
                batch.advance::<A, E>(until, &mut observers);
                control
                    .done
                    .fetch_add((until - from) * count as u64, Ordering::Relaxed);
            }
            for (lane, (states, inputs)) in at.iter_mut().enumerate() {
                if batch.lost[lane].is_none() {
                    push_lane(&batch.x, lane, states);
                    push_lane(&batch.u, lane, inputs);
                }
            }
        }
        let at = at.into_iter().enumerate();
        let seen = at.map(|(lane, (states, inputs))| MemberRecord {
            states,
            companion: Vec::new(),
            inputs,
            last: batch.last(lane),
            lost: batch.lost[lane],
            left: watches.iter().map(|watch| watch.left(lane)).collect(),
        });
        Ok(Some(seen.collect()))
    }

    fn pass(
        &self,
        flying: &[Particle],
        goal: &Goal,
        control: &Control,
    ) -> Result<Option<Vec<PassageRecord>>, MonteCarloError> {
        let steps = self.experiment.steps();
        let mut passage = FirstPassage::new(goal, steps, flying);
        let mut observers = Observers {
            watches: &mut [],
            other: Some(&mut passage),
        };
        let batch = self.batch(flying, &mut observers)?;
        Ok(pass::<F, S, A, E>(batch, passage, flying, control))
    }
}
