//! Propagation of the members of an experiment by its scheme and in its mode, which are chosen at run time.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::sync::atomic::Ordering;

use ahv_core::{Bounds, CountVisitor, GeneratedModel, Outlined, Real, Straight, Vector};
use ahv_integrate::{
    Checked, ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1, ItoStrangSplitting,
    SdeScheme, StratonovichHeun,
};

use super::MonteCarloError;
use super::arithmetic::{Called, In, Mode};
use super::batch::{Batch, Dynamics, Member, Noise, Watch};
use super::experiment::{Control, Experiment, Seen};
use super::lanes::{LANES, Packed, packed};
use super::rare::{Goal, Particle, Passed, pass};
use super::scheme::{MOST_NORMALS, OneByOne, Scheme, Steps};

/// Steps between two looks at whether to stop.
const PATIENCE: u64 = 1024;
/// Where in the validity box it is asked which noise moves the states; there is nothing special about it.
const FRACTION: f64 = 0.618;

/// Propagates members of an experiment.
pub trait Propagator<F: GeneratedModel>: Send + Sync {
    /// Flies members, at most [`LANES`]; `None` if the work was stopped.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError::Scheme`] for parameters that the scheme is not for.
    fn fly(
        &self,
        members: &[u64],
        control: &Control,
    ) -> Result<Option<Vec<Seen<F>>>, MonteCarloError>;

    /// Flies members, at most [`LANES`], from where they are until they pass the goal or time is over; `None` if the work was
    /// stopped.
    ///
    /// # Errors
    ///
    /// As [`Self::fly`].
    fn pass(
        &self,
        flying: &[Particle<F>],
        goal: &Goal,
        control: &Control,
    ) -> Result<Option<Vec<Passed<F>>>, MonteCarloError>;
}

impl<F: GeneratedModel> Experiment<F> {
    /// The propagator of the members, with the scheme that is asked for.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError::Scheme`] for a scheme that is not for this model's noise, [`MonteCarloError::StepSize`],
    /// [`MonteCarloError::Normals`].
    pub fn propagator(&self) -> Result<Box<dyn Propagator<F> + '_>, MonteCarloError> {
        match self.scheme {
            Scheme::Splitting => F::coloured(BySplitting(self))
                .unwrap_or(Err(MonteCarloError::NoColouredNoise { model: F::NAME })),
            Scheme::Heun => side_by_side::<F, ItoHeun>(self),
            Scheme::EulerMaruyama => side_by_side::<F, ItoEulerMaruyama>(self),
            Scheme::StratonovichHeun => one_by_one::<F, StratonovichHeun>(self),
            Scheme::Milstein => one_by_one::<F, Checked<ItoMilstein>>(self),
            Scheme::Sra1 => one_by_one::<F, Checked<ItoSra1>>(self),
            Scheme::Dri1 => one_by_one::<F, ItoDri1>(self),
        }
    }
}

/// Members by vector instructions.
fn side_by_side<F, S>(
    experiment: &Experiment<F>,
) -> Result<Box<dyn Propagator<F> + '_>, MonteCarloError>
where
    F: GeneratedModel,
    S: SdeScheme<F::With<Packed>>
        + Steps<F::With<Straight<f64>>>
        + Steps<Outlined<F::With<f64>>>
        + 'static,
{
    BatchPropagator::<F, S, In<Straight<f64>>, In<f64>>::new::<S>(experiment)
}

/// Members one after the other, all schemes in one loop.
fn one_by_one<F, S>(
    experiment: &Experiment<F>,
) -> Result<Box<dyn Propagator<F> + '_>, MonteCarloError>
where
    F: GeneratedModel,
    S: SdeScheme<F::With<Packed>> + Into<OneByOne>,
{
    BatchPropagator::<F, OneByOne, Called<In<f64>>, In<f64>>::new::<S>(experiment)
}

impl Scheme {
    /// The scheme where none is asked for: the splitting, which steps coloured noise exactly, where the model of these
    /// parameters has coloured noise with channels of its own; else Heun's.
    pub fn default_for<F: GeneratedModel>(parameters: &F::ParametersOf<f64>) -> Self {
        match F::coloured(Splits::<F>(parameters)) {
            Some(true) => Self::Splitting,
            _ => Self::Heun,
        }
    }
}

/// Whether the model of these parameters can be split.
struct Splits<'p, F: GeneratedModel>(&'p F::ParametersOf<f64>);

impl<F: GeneratedModel> CountVisitor for Splits<'_, F> {
    type Output = bool;

    fn visit<const N: usize>(self) -> bool {
        let (x, u) = generic_point::<F>();
        let model = F::with_parameters(self.0);
        ItoStrangSplitting::<f64, N>::new(&model, &x, &u, 1.0).is_ok()
    }
}

/// An experiment by the splitting.
struct BySplitting<'e, F: GeneratedModel>(&'e Experiment<F>);

impl<'e, F: GeneratedModel> CountVisitor for BySplitting<'e, F> {
    type Output = Result<Box<dyn Propagator<F> + 'e>, MonteCarloError>;

    fn visit<const N: usize>(self) -> Self::Output {
        side_by_side::<F, ItoStrangSplitting<Packed, N>>(self.0)
    }
}

/// Sets up a scheme of the form `S` for the parameters of a batch.
type SetUp<F, S> = fn(
    &Experiment<F>,
    &[<F as GeneratedModel>::ParametersOf<f64>; LANES],
) -> Result<Dynamics<F, S>, MonteCarloError>;

/// A propagator with a scheme `S`, fast in the arithmetic `A` and again in `E` where that has no result.
struct BatchPropagator<'e, F: GeneratedModel, S, A, E> {
    experiment: &'e Experiment<F>,
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

/// The scheme `S` for a model of this experiment.
fn set_up<F: GeneratedModel, S: SdeScheme<F::With<Packed>>>(
    experiment: &Experiment<F>,
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
    experiment: &Experiment<F>,
    parameters: &[F::ParametersOf<f64>; LANES],
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
    fn new<Own>(
        experiment: &'e Experiment<F>,
    ) -> Result<Box<dyn Propagator<F> + 'e>, MonteCarloError>
    where
        Own: SdeScheme<F::With<Packed>> + Into<S>,
    {
        if !(experiment.dt > 0.0 && experiment.dt.is_finite()) {
            return Err(MonteCarloError::StepSize(experiment.dt));
        }
        let shared = dynamics::<F, Own, S>(experiment, &[experiment.parameters; LANES])?;
        let scheme: Own = set_up(experiment, &shared.model)?;
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

    /// The batch of members that fly on from where they are; its steps count from there.
    fn batch(&self, flying: &[Particle<F>]) -> Result<Batch<'_, F, S>, MonteCarloError> {
        let experiment = self.experiment;
        // Lanes without member repeat the last one.
        let last = flying
            .last()
            .copied()
            .unwrap_or_else(|| experiment.particle(0));
        let flying: [Particle<F>; LANES] =
            std::array::from_fn(|lane| flying.get(lane).copied().unwrap_or(last));
        let mut broken = [None; LANES];
        let dynamics = match &experiment.dispersion {
            None => Cow::Borrowed(&self.shared),
            Some(draws) => {
                let mut parameters = flying.map(|particle| draws.member(particle.origin));
                for (parameters, broken) in parameters.iter_mut().zip(&mut broken) {
                    *broken = F::broken_rule(parameters);
                    // The lane flies all the same, unseen.
                    if broken.is_some() {
                        *parameters = experiment.parameters;
                    }
                }
                Cow::Owned((self.dynamics)(experiment, &parameters)?)
            }
        };
        let mut x = F::StateOf::splat(Packed::ZERO);
        let mut u = F::InputOf::splat(Packed::ZERO);
        for (lane, particle) in flying.iter().enumerate() {
            F::update_state(&mut x, particle.x, |numbers, value| numbers.0[lane] = value);
            F::update_input(&mut u, particle.u, |numbers, value| numbers.0[lane] = value);
        }
        let members = flying.map(|particle| particle.member);
        let single = experiment.mode == Mode::F32Noise;
        let noise = Noise::new(experiment.seed, members, &self.used, single);
        let law = experiment
            .feedback
            .as_ref()
            .map(|feedback| feedback.over(experiment.dt, flying.map(|particle| particle.step)));
        let watches = experiment.watched.iter();
        let watches = watches.map(|&bounds| Watch::new(bounds)).collect();
        let mut batch = Batch::new(dynamics, (x, u), experiment.dt, noise, law, watches);
        for (lane, rule) in broken.into_iter().enumerate() {
            if let Some(rule) = rule {
                batch.ground(lane, rule.reason);
            }
        }
        Ok(batch)
    }
}

impl<F, S, A, E> Propagator<F> for BatchPropagator<'_, F, S, A, E>
where
    F: GeneratedModel,
    A: Member<F>,
    E: Member<F>,
    S: Steps<A::Model> + Steps<<Called<E> as Member<F>>::Model>,
{
    fn fly(
        &self,
        members: &[u64],
        control: &Control,
    ) -> Result<Option<Vec<Seen<F>>>, MonteCarloError> {
        let experiment = self.experiment;
        let flying: Vec<_> = members
            .iter()
            .map(|&member| experiment.particle(member))
            .collect();
        let mut batch = self.batch(&flying)?;
        let count = members.len().min(LANES);
        let mut at: Vec<Vec<_>> = vec![Vec::new(); count];
        for &snapshot in &experiment.snapshots {
            while batch.step < snapshot {
                if control.stop.load(Ordering::Relaxed) {
                    return Ok(None);
                }
                let (from, until) = (batch.step, snapshot.min(batch.step + PATIENCE));
                batch.advance::<A, E>(until);
                control
                    .done
                    .fetch_add((until - from) * count as u64, Ordering::Relaxed);
            }
            for (lane, at) in at.iter_mut().enumerate() {
                if let (x, true) = batch.member(lane) {
                    at.push((x, F::map_input(&batch.u, |numbers| numbers.0[lane])));
                }
            }
        }
        let seen = at.into_iter().enumerate().map(|(lane, at)| Seen {
            at,
            last: batch.member(lane).0,
            lost: batch.lost[lane],
            left: batch.watches.iter().map(|watch| watch.left(lane)).collect(),
        });
        Ok(Some(seen.collect()))
    }

    fn pass(
        &self,
        flying: &[Particle<F>],
        goal: &Goal,
        control: &Control,
    ) -> Result<Option<Vec<Passed<F>>>, MonteCarloError> {
        let batch = self.batch(flying)?;
        Ok(pass::<F, S, A, E>(
            batch,
            self.experiment.steps(),
            flying,
            goal,
            control,
        ))
    }
}
