//! Propagation of the members of an experiment by its scheme and in its mode, which are chosen at run time.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::sync::atomic::Ordering;

use ahv_core::{Bounds, CountVisitor, GeneratedModel, Outlined, Real, Straight, Vector};
use ahv_integrate::ItoStrangSplitting;

use super::MonteCarloError;
use super::arithmetic::{Called, In, Mode};
use super::batch::{Batch, Dynamics, Member, Noise, Watch};
use super::experiment::{Control, Experiment, Seen};
use super::lanes::{LANES, Packed, packed};
use super::rare::{Goal, Particle, Passed, pass};
use super::scheme::{
    EulerMaruyama, Heun, MOST_NORMALS, OneByOne, Scheme, Splitting, Stepping, Steps, column,
};

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
            Scheme::Heun => side_by_side::<F, Heun>(self),
            Scheme::EulerMaruyama => side_by_side::<F, EulerMaruyama>(self),
            Scheme::StratonovichHeun | Scheme::Milstein | Scheme::Sra1 | Scheme::Dri1 => {
                BatchPropagator::<F, OneByOne, Called<In<f64>>, In<f64>>::new(self)
            }
        }
    }
}

/// Members by vector instructions.
fn side_by_side<F, S>(
    experiment: &Experiment<F>,
) -> Result<Box<dyn Propagator<F> + '_>, MonteCarloError>
where
    F: GeneratedModel,
    S: Steps<F, F::With<Straight<f64>>> + Steps<F, Outlined<F::With<f64>>> + 'static,
{
    BatchPropagator::<F, S, In<Straight<f64>>, In<f64>>::new(experiment)
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
        let first = |numbers: &Packed| numbers.0[0];
        let (x, u) = (F::map_state(&x, first), F::map_input(&u, first));
        ItoStrangSplitting::<f64, N>::new(&model, &x, &u, 1.0).is_ok()
    }
}

/// An experiment by the splitting.
struct BySplitting<'e, F: GeneratedModel>(&'e Experiment<F>);

impl<'e, F: GeneratedModel> CountVisitor for BySplitting<'e, F> {
    type Output = Result<Box<dyn Propagator<F> + 'e>, MonteCarloError>;

    fn visit<const N: usize>(self) -> Self::Output {
        side_by_side::<F, Splitting<N>>(self.0)
    }
}

/// A propagator with a scheme `S`, fast in the arithmetic `A` and again in `E` where that has no result.
struct BatchPropagator<'e, F: GeneratedModel, S, A, E> {
    experiment: &'e Experiment<F>,
    /// The model of the experiment's own parameters.
    shared: Dynamics<F, S>,
    /// Normal numbers that a step uses.
    used: [bool; MOST_NORMALS],
    arithmetic: PhantomData<fn() -> (A, E)>,
}

/// State and input in the validity box, where no noise is 0 by chance.
fn generic_point<F: GeneratedModel>() -> (F::StateOf<Packed>, F::InputOf<Packed>) {
    let between = |bounds: &Bounds| {
        let value = bounds.min + FRACTION * (bounds.max - bounds.min);
        Packed::splat(if value.is_finite() { value } else { FRACTION })
    };
    (
        F::map_state(&F::STATE_BOUNDS, between),
        F::map_input(&F::INPUT_BOUNDS, between),
    )
}

/// The model of these parameters, and the scheme for it.
fn dynamics<F: GeneratedModel, S: Stepping<F>>(
    experiment: &Experiment<F>,
    parameters: &[F::ParametersOf<f64>; LANES],
) -> Result<Dynamics<F, S>, MonteCarloError> {
    let model = packed::<F>(parameters);
    let (x, u) = generic_point::<F>();
    let scheme = S::new(experiment.scheme, &model, &x, &u, experiment.dt).map_err(|reason| {
        MonteCarloError::Scheme {
            scheme: experiment.scheme.name(),
            reason,
        }
    })?;
    Ok(Dynamics { model, scheme })
}

impl<'e, F, S, A, E> BatchPropagator<'e, F, S, A, E>
where
    F: GeneratedModel,
    A: Member<F> + 'e,
    E: Member<F> + 'e,
    S: Steps<F, A::Model> + Steps<F, <Called<E> as Member<F>>::Model> + 'e,
{
    #[allow(
        clippy::new_ret_no_self,
        reason = "callers need no more than the trait"
    )]
    fn new(experiment: &'e Experiment<F>) -> Result<Box<dyn Propagator<F> + 'e>, MonteCarloError> {
        if !(experiment.dt > 0.0 && experiment.dt.is_finite()) {
            return Err(MonteCarloError::StepSize(experiment.dt));
        }
        let shared: Dynamics<F, S> = dynamics(experiment, &[experiment.parameters; LANES])?;
        let normals = F::NoiseOf::<Packed>::LEN + shared.scheme.extra();
        if normals > MOST_NORMALS {
            return Err(MonteCarloError::Normals { normals });
        }
        let (x, u) = generic_point::<F>();
        let mut used = [false; MOST_NORMALS];
        let (wiener, extra) = used.split_at_mut(F::NoiseOf::<Packed>::LEN);
        for (channel, used) in wiener.iter_mut().enumerate() {
            *used = S::uses(&shared.model, &column(&shared.model, &x, &u, channel));
        }
        extra
            .iter_mut()
            .take(shared.scheme.extra())
            .for_each(|used| *used = true);
        Ok(Box::new(Self {
            experiment,
            shared,
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
                Cow::Owned(dynamics(experiment, &parameters)?)
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
    S: Steps<F, A::Model> + Steps<F, <Called<E> as Member<F>>::Model>,
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
