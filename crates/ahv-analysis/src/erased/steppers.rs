//! The steppers of a single flight, by name.

use ahv_core::{CountVisitor, GeneratedModel, NoInline, Vector};
use ahv_integrate::{
    Checked, DormandPrince54, DormandPrince853, Euler, Exponential, Fixed, FlexibleMode, Heun,
    ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1, ItoStrangSplitting, NoiseError,
    NormalStream, Rk4, Rodas4, SdeScheme, StepError, StratonovichHeun, Tsit5,
};

use super::{values, vector};
use crate::monte_carlo::{Scheme, generic_point};

/// Run of the noise: a single simulation is the first member of its ensemble.
const MEMBER: u64 = 0;

/// Takes a state over the step of this number and length in s, with this held input; where it fails, the state is as it was.
pub type Advance = Box<dyn FnMut(&mut Vec<f64>, &[f64], u32, f64) -> Result<(), StepError<f64>>>;

/// Why a stepper is not for a flight.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StepperError {
    /// The exponential method for a model without flexible modes.
    #[error("exponential needs one to three flexible modes, which {model} does not have")]
    FlexibleModes {
        /// Name of the model.
        model: &'static str,
    },
    /// A tolerance for a scheme that does not estimate its error.
    #[error("{scheme} has no estimate of its error, which a tolerance needs")]
    NoErrorEstimate {
        /// Name of the scheme.
        scheme: &'static str,
    },
    /// The splitting for a model without coloured noise.
    #[error("splitting needs coloured noise, which {model} does not have")]
    NoColouredNoise {
        /// Name of the model.
        model: &'static str,
    },
    /// Noise that the scheme does not admit.
    #[error("{scheme} is not for this flight: {reason}")]
    Noise {
        /// Name of the scheme.
        scheme: &'static str,
        /// What it does not admit.
        reason: NoiseError,
    },
}

/// A stepper for flights without noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DeterministicScheme {
    /// [`Euler`].
    Euler,
    /// [`Heun`].
    Heun,
    /// [`Rk4`].
    Rk4,
    /// [`DormandPrince54`] with a fixed step.
    DormandPrince54,
    /// [`Tsit5`] with a fixed step.
    Tsit5,
    /// [`DormandPrince853`] with a fixed step.
    DormandPrince853,
    /// [`Rodas4`] with a fixed step.
    Rodas4,
    /// [`Exponential`], for models with flexible modes.
    Exponential,
}

impl DeterministicScheme {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Euler,
        Self::Heun,
        Self::Rk4,
        Self::DormandPrince54,
        Self::Tsit5,
        Self::DormandPrince853,
        Self::Rodas4,
        Self::Exponential,
    ];

    /// Its name on command lines.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Euler => "euler",
            Self::Heun => "heun",
            Self::Rk4 => "rk4",
            Self::DormandPrince54 => "dormand-prince54",
            Self::Tsit5 => "tsit5",
            Self::DormandPrince853 => "dormand-prince853",
            Self::Rodas4 => "rodas4",
            Self::Exponential => "exponential",
        }
    }

    /// The stepper for a model.
    pub(super) fn advance<M: GeneratedModel>(self, model: M) -> Result<Advance, StepperError> {
        // Called, not inlined: a copy of every model in every method takes long to compile.
        let model = NoInline(model);
        Ok(match self {
            Self::Euler => alone::<M>(move |x, u, _, dt| Euler::new(dt).step(&model, x, u)),
            Self::Heun => alone::<M>(move |x, u, _, dt| Heun::new(dt).step(&model, x, u)),
            Self::Rk4 => alone::<M>(move |x, u, _, dt| Rk4::new(dt).step(&model, x, u)),
            Self::DormandPrince54 => {
                alone::<M>(move |x, u, _, dt| Fixed::new(DormandPrince54, dt).step(&model, x, u))
            }
            Self::Tsit5 => alone::<M>(move |x, u, _, dt| Fixed::new(Tsit5, dt).step(&model, x, u)),
            Self::DormandPrince853 => {
                alone::<M>(move |x, u, _, dt| Fixed::new(DormandPrince853, dt).step(&model, x, u))
            }
            Self::Rodas4 => {
                alone::<M>(move |x, u, _, dt| Fixed::new(Rodas4, dt).step(&model, x, u))
            }
            Self::Exponential => match *flexible_modes(&model.0) {
                [one] => exponential(model, [one]),
                [one, two] => exponential(model, [one, two]),
                [one, two, three] => exponential(model, [one, two, three]),
                _ => return Err(StepperError::FlexibleModes { model: M::NAME }),
            },
        })
    }
}

/// The steps of a type, without it.
fn alone<M: GeneratedModel>(
    mut advance: impl FnMut(&mut M::State, &M::Input, u32, f64) -> Result<(), StepError<f64>> + 'static,
) -> Advance {
    Box::new(move |state, u, step, dt| {
        let mut x: M::State = vector(state);
        advance(&mut x, &vector(u), step, dt)?;
        *state = values(&x);
        Ok(())
    })
}

fn exponential<M: GeneratedModel, const N: usize>(
    model: NoInline<M>,
    modes: [FlexibleMode; N],
) -> Advance {
    alone::<M>(move |x, u, _, dt| Exponential::new(dt, modes).step(&model, x, u))
}

/// The modes of two states of which one is the rate of the other, with frequency and damping from the Jacobian.
fn flexible_modes<M: GeneratedModel>(model: &M) -> Vec<FlexibleMode> {
    let (x, u) = generic_point::<M>();
    let (by_state, _) = model.jacobians(&x, &u);
    let entry = |row: &str, column: &str| {
        let row = by_state.get(M::State::index_of(row)?)?;
        row.get(M::State::index_of(column)?)
    };
    let modes = M::MODES.iter().filter_map(|mode| {
        let [position, rate] = *mode.states else {
            return None;
        };
        let follows = entry(position, rate)? == 1.0 && entry(position, position)? == 0.0;
        let omega = (-entry(rate, position)?).sqrt();
        let zeta = -entry(rate, rate)? / (2.0 * omega);
        follows.then(|| FlexibleMode::new::<M>(position, rate, omega, zeta))?
    });
    modes.collect()
}

/// A scheme for flights with noise, of the normal numbers of `seed`.
pub(super) fn stochastic<M: GeneratedModel>(
    scheme: Scheme,
    model: M,
    seed: u64,
) -> Result<Advance, StepperError> {
    let model = NoInline(model);
    match scheme {
        Scheme::Splitting => M::coloured(BySplitting::<M> { model, seed })
            .unwrap_or(Err(StepperError::NoColouredNoise { model: M::NAME })),
        Scheme::Heun => by::<M, ItoHeun>(scheme, model, seed),
        Scheme::EulerMaruyama => by::<M, ItoEulerMaruyama>(scheme, model, seed),
        Scheme::StratonovichHeun => by::<M, StratonovichHeun>(scheme, model, seed),
        Scheme::Milstein => by::<M, Checked<ItoMilstein>>(scheme, model, seed),
        Scheme::Sra1 => by::<M, Checked<ItoSra1>>(scheme, model, seed),
        Scheme::Dri1 => by::<M, ItoDri1>(scheme, model, seed),
    }
}

struct BySplitting<M> {
    model: NoInline<M>,
    seed: u64,
}

impl<M: GeneratedModel> CountVisitor for BySplitting<M> {
    type Output = Result<Advance, StepperError>;

    fn visit<const N: usize>(self) -> Self::Output {
        by::<M, ItoStrangSplitting<f64, N>>(Scheme::Splitting, self.model, self.seed)
    }
}

/// Steps by the scheme `S`, which is set up again where the length of the step changes.
fn by<M, S>(scheme: Scheme, model: NoInline<M>, seed: u64) -> Result<Advance, StepperError>
where
    M: GeneratedModel,
    S: SdeScheme<NoInline<M>> + 'static,
{
    let (x, u) = generic_point::<M>();
    let set_up = move |dt| S::set_up(&model, &x, &u, dt);
    // Any length of the step shows whether the noise is admitted.
    let first = set_up(1.0).map_err(|reason| StepperError::Noise {
        scheme: scheme.name(),
        reason,
    })?;
    let channels = 0..first.normals() as u64;
    let mut streams: Vec<NormalStream> = channels
        .map(|channel| NormalStream::new(seed, MEMBER, channel))
        .collect();
    let (mut current, mut length) = (first, 1.0);
    let mut normals = vec![0.0; streams.len()];
    Ok(alone::<M>(move |x, u, step, dt| {
        if dt != length {
            current = set_up(dt).map_err(|_| StepError::StepSize { dt })?;
            length = dt;
        }
        for (normal, stream) in normals.iter_mut().zip(&mut streams) {
            *normal = stream.normal(step.into());
        }
        let normal = |index: usize| normals.get(index).copied().unwrap_or(0.0);
        current.step_from_normals(&model, x, u, normal)
    }))
}
