//! Which members are flown, and how.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use ahv_core::{Bounds, Fused, Real, Straight, Vector};
use ahv_integrate::{NoiseError, NormalStream};

use super::arithmetic::{Called, In, Mode, Narrowed};
use super::batch::{Batch, Member, Noise, Start, Watch};
use super::family::{Dcom, Family, LANES, Packed, Sdcom};
use super::feedback::Feedback;
use super::rare::{Goal, Particle, Passed, pass};
use super::scheme::{
    Dri1, EulerMaruyama, Heun, InStratonovichSense, MOST_NORMALS, Milstein, Scheme, Splitting,
    Sra1, Stepping, Steps, column,
};
use super::{Loss, MonteCarloError};
use crate::disperse::Draws;

/// Added to the seed of the noise, it is the seed of what members start from.
const START_SEED: u64 = 0x9E37_79B9_7F4A_7C15;
/// Steps between two looks at whether to stop.
const PATIENCE: u64 = 1024;

/// Members of a model, each with noise of its own.
#[derive(Clone)]
pub struct Experiment<F: Family> {
    /// Parameters.
    pub parameters: F::Parameters<f64>,
    /// Parameters drawn for each member, in the place of those.
    pub dispersion: Option<Draws<F::Parameters<f64>>>,
    /// State at the start, and the standard deviation of a normal distribution about it.
    pub state: [F::State<f64>; 2],
    /// Input, and the standard deviation of a normal distribution about it: held, or where actuators start.
    pub input: [F::Input<f64>; 2],
    /// What moves the inputs.
    pub feedback: Option<Feedback<F>>,
    /// Intervals of the states that are watched: the box of validity, and limits of one's own.
    pub watched: Vec<F::State<Bounds>>,
    /// Stepper.
    pub scheme: Scheme,
    /// Arithmetic.
    pub mode: Mode,
    /// Step, in s.
    pub dt: f64,
    /// Numbers of steps after which the states are told, ascending; the flight ends with the last.
    pub snapshots: Vec<u64>,
    /// Seed of noise and dispersion.
    pub seed: u64,
}

/// What was seen of a member.
#[derive(Clone)]
pub struct Seen<F: Family> {
    /// State and input at each snapshot that it lived to see.
    pub at: Vec<(F::State<f64>, F::Input<f64>)>,
    /// Its last finite state.
    pub last: F::State<f64>,
    /// How it ended before its time.
    pub lost: Option<Loss>,
    /// Steps after which each state was first outside its interval, for each set of intervals.
    pub left: Vec<F::State<Option<u64>>>,
}

/// Counts steps, and stops the work when asked to.
#[derive(Debug, Default)]
pub struct Control {
    /// Steps of members that are done.
    pub done: AtomicU64,
    /// Whether to stop.
    pub stop: AtomicBool,
}

/// A model for which every scheme that it has can be chosen at run time.
pub trait Flown: Family {
    /// Flies members, at most [`LANES`]; `None` if the work was stopped.
    ///
    /// # Errors
    ///
    /// [`MonteCarloError::Scheme`] for a scheme that is not for this model's noise, [`MonteCarloError::NoFma`].
    fn fly(
        experiment: &Experiment<Self>,
        members: &[u64],
        control: &Control,
    ) -> Result<Option<Vec<Seen<Self>>>, MonteCarloError>
    where
        Self: Sized;

    /// Flies members, at most [`LANES`], from where they are until they pass the goal or time is over; `None` if the work was
    /// stopped.
    ///
    /// # Errors
    ///
    /// As [`Self::fly`].
    fn pass(
        experiment: &Experiment<Self>,
        flying: &[Particle<Self>],
        goal: &Goal,
        control: &Control,
    ) -> Result<Option<Vec<Passed<Self>>>, MonteCarloError>
    where
        Self: Sized;
}

/// Calls `$call` with the scheme `$scheme` in the experiment's mode.
macro_rules! in_mode {
    ($experiment:ident: $call:ident $arguments:tt, $scheme:ty) => {
        match $experiment.mode {
            Mode::Exact | Mode::F32Noise => $call::<Self, $scheme, In<Straight<f64>>, In<f64>> $arguments,
            Mode::Fma => $call::<Self, $scheme, In<Fused<Straight<f64>>>, In<Fused<f64>>> $arguments,
            Mode::F32Drift => $call::<Self, $scheme, Narrowed<Straight<f64>, Straight<f32>>, Narrowed<f64, f32>> $arguments,
        }
    };
}

/// Calls `$call` with the scheme `$scheme`, which has no modes but those of the noise.
macro_rules! in_doubles {
    ($experiment:ident: $call:ident $arguments:tt, $scheme:ty) => {
        match $experiment.mode {
            Mode::Exact | Mode::F32Noise => $call::<Self, $scheme, Called<In<f64>>, In<f64>> $arguments,
            mode => Err(MonteCarloError::ModeOfScheme {
                mode: mode.name(),
                scheme: $experiment.scheme.name(),
            }),
        }
    };
}

/// Calls `$call` with the experiment's scheme and mode.
macro_rules! in_scheme {
    ($experiment:ident: $call:ident $arguments:tt $(, $splitting:ident)?) => {
        match $experiment.scheme {
            $(Scheme::Splitting => in_mode!($experiment: $call $arguments, $splitting),)?
            Scheme::Heun => in_mode!($experiment: $call $arguments, Heun),
            Scheme::EulerMaruyama => in_mode!($experiment: $call $arguments, EulerMaruyama),
            Scheme::StratonovichHeun => {
                in_doubles!($experiment: $call $arguments, InStratonovichSense)
            }
            Scheme::Milstein => in_doubles!($experiment: $call $arguments, Milstein),
            Scheme::Sra1 => in_doubles!($experiment: $call $arguments, Sra1),
            Scheme::Dri1 => in_doubles!($experiment: $call $arguments, Dri1),
            #[allow(unreachable_patterns, reason = "a model with coloured noise has every scheme")]
            scheme => Err(MonteCarloError::Scheme {
                scheme: scheme.name(),
                reason: NoiseError::ColouredStates { expected: 3, found: 0 },
            }),
        }
    };
}

macro_rules! flown {
    ($($name:ident: $($splitting:ident)?;)+) => {$(
        impl Flown for $name {
            fn fly(
                experiment: &Experiment<Self>,
                members: &[u64],
                control: &Control,
            ) -> Result<Option<Vec<Seen<Self>>>, MonteCarloError> {
                in_scheme!(experiment: fly(experiment, members, control) $(, $splitting)?)
            }

            fn pass(
                experiment: &Experiment<Self>,
                flying: &[Particle<Self>],
                goal: &Goal,
                control: &Control,
            ) -> Result<Option<Vec<Passed<Self>>>, MonteCarloError> {
                in_scheme!(experiment: pass(experiment, flying, goal, control) $(, $splitting)?)
            }
        }
    )+};
}

flown! {
    Sdcom: Splitting;
    Dcom:;
}

fn fly<F, S, A, E>(
    experiment: &Experiment<F>,
    members: &[u64],
    control: &Control,
) -> Result<Option<Vec<Seen<F>>>, MonteCarloError>
where
    F: Family,
    A: Member<F>,
    E: Member<F>,
    S: Steps<F, A::Model> + Steps<F, <Called<E> as Member<F>>::Model>,
{
    let flying: Vec<_> = members
        .iter()
        .map(|&member| experiment.particle(member))
        .collect();
    let mut batch = experiment.batch::<S>(&flying)?;
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

/// Whether this processor multiplies and adds in one rounding.
fn has_fma() -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return std::arch::is_x86_feature_detected!("fma");
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    return cfg!(target_arch = "aarch64");
}

impl<F: Family> Experiment<F> {
    /// Steps of a whole flight.
    pub fn steps(&self) -> u64 {
        self.snapshots.last().copied().unwrap_or(0)
    }

    /// The batch of members that fly on from where they are; its steps count from there.
    pub(super) fn batch<S: Stepping<F>>(
        &self,
        flying: &[Particle<F>],
    ) -> Result<Batch<F, S>, MonteCarloError> {
        if self.mode == Mode::Fma && !has_fma() {
            return Err(MonteCarloError::NoFma);
        }
        if !(self.dt > 0.0 && self.dt.is_finite()) {
            return Err(MonteCarloError::StepSize(self.dt));
        }
        // Lanes without member repeat the last one.
        let last = flying.last().copied().unwrap_or_else(|| self.particle(0));
        let flying: [Particle<F>; LANES] =
            std::array::from_fn(|lane| flying.get(lane).copied().unwrap_or(last));
        let parameters = flying.map(|particle| match &self.dispersion {
            Some(draws) => draws.member(particle.origin),
            None => self.parameters,
        });
        let model = F::model(&parameters);
        let mut x = F::State::splat(Packed::ZERO);
        let mut u = F::Input::splat(Packed::ZERO);
        for (lane, particle) in flying.iter().enumerate() {
            F::update_state(&mut x, particle.x, |numbers, value| numbers.0[lane] = value);
            F::update_input(&mut u, particle.u, |numbers, value| numbers.0[lane] = value);
        }
        let scheme = S::new(&model, &x, &u, self.dt).map_err(|reason| MonteCarloError::Scheme {
            scheme: self.scheme.name(),
            reason,
        })?;
        let mut used = [false; MOST_NORMALS];
        let channels = F::Noise::<Packed>::LEN;
        for (channel, used) in used.iter_mut().enumerate().take(channels) {
            *used = S::uses(&model, &column(&model, &x, &u, channel));
        }
        used.iter_mut()
            .skip(channels)
            .take(S::EXTRA)
            .for_each(|used| *used = true);
        let single = matches!(self.mode, Mode::F32Noise | Mode::F32Drift);
        let noise = Noise::new(
            self.seed,
            flying.map(|particle| particle.member),
            &used,
            single,
        );
        let law = self
            .feedback
            .as_ref()
            .map(|feedback| feedback.over(self.dt));
        let watches = self
            .watched
            .iter()
            .map(|&bounds| Watch::new(bounds))
            .collect();
        Ok(Batch::new(
            Start { model, x, u },
            scheme,
            self.dt,
            noise,
            law,
            watches,
        ))
    }

    /// A member at the start.
    pub(super) fn particle(&self, member: u64) -> Particle<F> {
        let seed = self.seed.wrapping_add(START_SEED);
        let normal = |channel: usize| NormalStream::new(seed, member, channel as u64).normal(0);
        let ([mut x, x_std], [mut u, u_std]) = (self.state, self.input);
        let mut channel = 0;
        let mut about = |value: &mut f64, std: f64| {
            if std != 0.0 {
                *value += std * normal(channel);
            }
            channel += 1;
        };
        F::update_state(&mut x, x_std, &mut about);
        F::update_input(&mut u, u_std, &mut about);
        Particle {
            member,
            origin: member,
            step: 0,
            x,
            u,
        }
    }
}
