//! Propagation of the members of an experiment by its scheme and in its mode, which are chosen at run time.

use std::borrow::Cow;
use std::marker::PhantomData;
use std::sync::atomic::Ordering;

use ahv_core::{Bounds, Fused, Real, Straight, Vector};
use ahv_integrate::NoiseError;

use super::MonteCarloError;
use super::arithmetic::{Called, In, Mode, Narrowed};
use super::batch::{Batch, Dynamics, Member, Noise, Watch};
use super::experiment::{Control, Experiment, Seen};
use super::family::{Dcom, Family, LANES, Packed, Sdcom, SdcomGust, SdcomPrinted};
use super::rare::{Goal, Particle, Passed, pass};
use super::scheme::{
    Dri1, EulerMaruyama, Heun, InStratonovichSense, MOST_NORMALS, Milstein, Scheme, Splitting,
    Sra1, Stepping, Steps, column,
};

/// Steps between two looks at whether to stop.
const PATIENCE: u64 = 1024;
/// Where in the validity box it is asked which noise moves the states; there is nothing special about it.
const FRACTION: f64 = 0.618;

/// Propagates members of an experiment.
pub trait Propagator<F: Family>: Send + Sync {
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

/// A model for which every scheme that it has can be chosen at run time.
pub trait Flown: Family {
    /// The propagator of an experiment's members.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError::Scheme`] for a scheme that is not for this model's noise, [`MonteCarloError::ModeOfScheme`],
    /// [`MonteCarloError::NoFma`], [`MonteCarloError::StepSize`].
    fn propagator(
        experiment: &Experiment<Self>,
    ) -> Result<Box<dyn Propagator<Self> + '_>, MonteCarloError>
    where
        Self: Sized;
}

/// A propagator with the scheme `$scheme` in the experiment's mode.
macro_rules! in_mode {
    ($experiment:ident, $scheme:ty) => {
        match $experiment.mode {
            Mode::Exact | Mode::F32Noise => {
                BatchPropagator::<Self, $scheme, In<Straight<f64>>, In<f64>>::new($experiment)
            }
            Mode::Fma => {
                BatchPropagator::<Self, $scheme, In<Fused<Straight<f64>>>, In<Fused<f64>>>::new(
                    $experiment,
                )
            }
            Mode::F32Drift => BatchPropagator::<
                Self,
                $scheme,
                Narrowed<Straight<f64>, Straight<f32>>,
                Narrowed<f64, f32>,
            >::new($experiment),
        }
    };
}

/// A propagator with the scheme `$scheme`, which has no modes but those of the noise.
macro_rules! in_doubles {
    ($experiment:ident, $scheme:ty) => {
        match $experiment.mode {
            Mode::Exact | Mode::F32Noise => {
                BatchPropagator::<Self, $scheme, Called<In<f64>>, In<f64>>::new($experiment)
            }
            mode => Err(MonteCarloError::ModeOfScheme {
                mode: mode.name(),
                scheme: $experiment.scheme.name(),
            }),
        }
    };
}

macro_rules! flown {
    ($($name:ident: $($splitting:ty)?;)+) => {$(
        impl Flown for $name {
            fn propagator(
                experiment: &Experiment<Self>,
            ) -> Result<Box<dyn Propagator<Self> + '_>, MonteCarloError> {
                match experiment.scheme {
                    $(Scheme::Splitting => in_mode!(experiment, $splitting),)?
                    Scheme::Heun => in_mode!(experiment, Heun),
                    Scheme::EulerMaruyama => in_mode!(experiment, EulerMaruyama),
                    Scheme::StratonovichHeun => in_doubles!(experiment, InStratonovichSense),
                    Scheme::Milstein => in_doubles!(experiment, Milstein),
                    Scheme::Sra1 => in_doubles!(experiment, Sra1),
                    Scheme::Dri1 => in_doubles!(experiment, Dri1),
                    #[allow(unreachable_patterns, reason = "a model with coloured noise has every scheme")]
                    scheme => Err(MonteCarloError::Scheme {
                        scheme: scheme.name(),
                        reason: NoiseError::ColouredStates { expected: 3, found: 0 },
                    }),
                }
            }
        }
    )+};
}

flown! {
    Sdcom: Splitting<3>;
    Dcom:;
}

/// Models of one scheme without vector loops: they are flown beside others, not by the million, and each loop takes long to
/// compile.
macro_rules! flown_by_splitting {
    ($($name:ident: $splitting:ty;)+) => {$(
        impl Flown for $name {
            fn propagator(
                experiment: &Experiment<Self>,
            ) -> Result<Box<dyn Propagator<Self> + '_>, MonteCarloError> {
                match experiment.scheme {
                    Scheme::Splitting => in_doubles!(experiment, $splitting),
                    scheme => Err(MonteCarloError::SchemeOfModel {
                        scheme: scheme.name(),
                        model: Self::NAME,
                    }),
                }
            }
        }
    )+};
}

flown_by_splitting! {
    SdcomPrinted: Splitting<3>;
    SdcomGust: Splitting<4>;
}

/// A propagator with a scheme `S`, fast in the arithmetic `A` and again in `E` where that has no result.
struct BatchPropagator<'e, F: Family, S, A, E> {
    experiment: &'e Experiment<F>,
    /// The model of the experiment's own parameters.
    shared: Dynamics<F, S>,
    /// Normal numbers that a step uses.
    used: [bool; MOST_NORMALS],
    arithmetic: PhantomData<fn() -> (A, E)>,
}

/// Whether this processor multiplies and adds in one rounding.
fn has_fma() -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return std::arch::is_x86_feature_detected!("fma");
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    return cfg!(target_arch = "aarch64");
}

/// State and input in the validity box, where no noise is 0 by chance.
fn generic_point<F: Family>() -> (F::State<Packed>, F::Input<Packed>) {
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
fn dynamics<F: Family, S: Stepping<F>>(
    experiment: &Experiment<F>,
    parameters: &[F::Parameters<f64>; LANES],
) -> Result<Dynamics<F, S>, MonteCarloError> {
    let model = F::model(parameters);
    let (x, u) = generic_point::<F>();
    let scheme =
        S::new(&model, &x, &u, experiment.dt).map_err(|reason| MonteCarloError::Scheme {
            scheme: experiment.scheme.name(),
            reason,
        })?;
    Ok(Dynamics { model, scheme })
}

impl<'e, F, S, A, E> BatchPropagator<'e, F, S, A, E>
where
    F: Family,
    A: Member<F> + 'e,
    E: Member<F> + 'e,
    S: Steps<F, A::Model> + Steps<F, <Called<E> as Member<F>>::Model> + 'e,
{
    #[allow(
        clippy::new_ret_no_self,
        reason = "callers need no more than the trait"
    )]
    fn new(experiment: &'e Experiment<F>) -> Result<Box<dyn Propagator<F> + 'e>, MonteCarloError> {
        if experiment.mode == Mode::Fma && !has_fma() {
            return Err(MonteCarloError::NoFma);
        }
        if !(experiment.dt > 0.0 && experiment.dt.is_finite()) {
            return Err(MonteCarloError::StepSize(experiment.dt));
        }
        let shared: Dynamics<F, S> = dynamics(experiment, &[experiment.parameters; LANES])?;
        let (x, u) = generic_point::<F>();
        let mut used = [false; MOST_NORMALS];
        let (wiener, extra) = used.split_at_mut(F::Noise::<Packed>::LEN);
        for (channel, used) in wiener.iter_mut().enumerate() {
            *used = S::uses(&shared.model, &column(&shared.model, &x, &u, channel));
        }
        extra
            .iter_mut()
            .take(S::EXTRA)
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
        let dynamics = match &experiment.dispersion {
            None => Cow::Borrowed(&self.shared),
            Some(draws) => {
                let parameters = flying.map(|particle| draws.member(particle.origin));
                Cow::Owned(dynamics(experiment, &parameters)?)
            }
        };
        let mut x = F::State::splat(Packed::ZERO);
        let mut u = F::Input::splat(Packed::ZERO);
        for (lane, particle) in flying.iter().enumerate() {
            F::update_state(&mut x, particle.x, |numbers, value| numbers.0[lane] = value);
            F::update_input(&mut u, particle.u, |numbers, value| numbers.0[lane] = value);
        }
        let members = flying.map(|particle| particle.member);
        let single = matches!(experiment.mode, Mode::F32Noise | Mode::F32Drift);
        let noise = Noise::new(experiment.seed, members, &self.used, single);
        let law = experiment
            .feedback
            .as_ref()
            .map(|feedback| feedback.over(experiment.dt, flying.map(|particle| particle.step)));
        let watches = experiment.watched.iter();
        let watches = watches.map(|&bounds| Watch::new(bounds)).collect();
        Ok(Batch::new(
            dynamics,
            (x, u),
            experiment.dt,
            noise,
            law,
            watches,
        ))
    }
}

impl<F, S, A, E> Propagator<F> for BatchPropagator<'_, F, S, A, E>
where
    F: Family,
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
