//! The steppers of a simulation, by name.

use ahv_analysis::monte_carlo::{Scheme, generic_point};
use ahv_core::{CountVisitor, GeneratedModel, Outlined, Vector};
use ahv_integrate::{
    Checked, DormandPrince54, DormandPrince853, Euler, Exponential, Fixed, FlexibleMode, Heun,
    ItoDri1, ItoEulerMaruyama, ItoHeun, ItoMilstein, ItoSra1, ItoStrangSplitting, NormalStream,
    Rk4, Rodas4, SdeScheme, StepError, StratonovichHeun, Tsit5,
};

use crate::failure::Failure;
use crate::vehicle::Vehicle;

/// Run of the noise: a single simulation is the first member of its ensemble.
const MEMBER: u64 = 0;

/// Takes the step of this number and length in s.
pub(super) type Advance<'v, M> = Box<
    dyn FnMut(
            &mut <M as GeneratedModel>::StateOf<f64>,
            &<M as GeneratedModel>::InputOf<f64>,
            u32,
            f64,
        ) -> Result<(), StepError<f64>>
        + 'v,
>;

/// A stepper for flights without noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Calm {
    Euler,
    Heun,
    Rk4,
    DormandPrince54,
    Tsit5,
    DormandPrince853,
    Rodas4,
    Exponential,
}

impl Calm {
    pub(super) const ALL: [Self; 8] = [
        Self::Euler,
        Self::Heun,
        Self::Rk4,
        Self::DormandPrince54,
        Self::Tsit5,
        Self::DormandPrince853,
        Self::Rodas4,
        Self::Exponential,
    ];

    pub(super) const fn name(self) -> &'static str {
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

    /// The stepper for a vehicle.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for the exponential method on a model without flexible modes.
    pub(super) fn advance<M: GeneratedModel>(
        self,
        vehicle: &Vehicle<M>,
    ) -> Result<Advance<'static, M>, Failure> {
        // Called, not inlined: a copy of every model in every method takes long to compile.
        let model = Outlined(vehicle.model);
        Ok(match self {
            Self::Euler => Box::new(move |x, u, _, dt| Euler::new(dt).step(&model, x, u)),
            Self::Heun => Box::new(move |x, u, _, dt| Heun::new(dt).step(&model, x, u)),
            Self::Rk4 => Box::new(move |x, u, _, dt| Rk4::new(dt).step(&model, x, u)),
            Self::DormandPrince54 => {
                Box::new(move |x, u, _, dt| Fixed::new(DormandPrince54, dt).step(&model, x, u))
            }
            Self::Tsit5 => Box::new(move |x, u, _, dt| Fixed::new(Tsit5, dt).step(&model, x, u)),
            Self::DormandPrince853 => {
                Box::new(move |x, u, _, dt| Fixed::new(DormandPrince853, dt).step(&model, x, u))
            }
            Self::Rodas4 => Box::new(move |x, u, _, dt| Fixed::new(Rodas4, dt).step(&model, x, u)),
            Self::Exponential => match *flexible_modes(&vehicle.model) {
                [one] => exponential(model, [one]),
                [one, two] => exponential(model, [one, two]),
                [one, two, three] => exponential(model, [one, two, three]),
                _ => {
                    return Err(Failure::Request(format!(
                        "--scheme: exponential needs one to three flexible modes, which {} does not have",
                        M::NAME
                    )));
                }
            },
        })
    }
}

fn exponential<M: GeneratedModel, const N: usize>(
    model: Outlined<M>,
    modes: [FlexibleMode; N],
) -> Advance<'static, M> {
    Box::new(move |x, u, _, dt| Exponential::new(dt, modes).step(&model, x, u))
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
///
/// # Errors
///
/// [`Failure::Request`] for noise that the scheme does not admit.
pub(super) fn noisy<M: GeneratedModel>(
    scheme: Scheme,
    vehicle: &Vehicle<M>,
    seed: u64,
) -> Result<Advance<'static, M>, Failure> {
    let model = Outlined(vehicle.model);
    match scheme {
        Scheme::Splitting => M::coloured(BySplitting::<M> { model, seed }).unwrap_or_else(|| {
            Err(Failure::Request(format!(
                "--scheme: splitting needs coloured noise, which {} does not have",
                M::NAME
            )))
        }),
        Scheme::Heun => by::<M, ItoHeun>(scheme, model, seed),
        Scheme::EulerMaruyama => by::<M, ItoEulerMaruyama>(scheme, model, seed),
        Scheme::StratonovichHeun => by::<M, StratonovichHeun>(scheme, model, seed),
        Scheme::Milstein => by::<M, Checked<ItoMilstein>>(scheme, model, seed),
        Scheme::Sra1 => by::<M, Checked<ItoSra1>>(scheme, model, seed),
        Scheme::Dri1 => by::<M, ItoDri1>(scheme, model, seed),
    }
}

struct BySplitting<M> {
    model: Outlined<M>,
    seed: u64,
}

impl<M: GeneratedModel> CountVisitor for BySplitting<M> {
    type Output = Result<Advance<'static, M>, Failure>;

    fn visit<const N: usize>(self) -> Self::Output {
        by::<M, ItoStrangSplitting<f64, N>>(Scheme::Splitting, self.model, self.seed)
    }
}

/// Steps by the scheme `S`, which is set up again where the length of the step changes.
fn by<M, S>(scheme: Scheme, model: Outlined<M>, seed: u64) -> Result<Advance<'static, M>, Failure>
where
    M: GeneratedModel,
    S: SdeScheme<Outlined<M>> + 'static,
{
    let (x, u) = generic_point::<M>();
    let set_up = move |dt| S::set_up(&model, &x, &u, dt);
    // Any length of the step shows whether the noise is admitted.
    let first = set_up(1.0).map_err(|reason| {
        Failure::Request(format!(
            "--scheme: {} is not for this flight: {reason}",
            scheme.name()
        ))
    })?;
    let channels = 0..first.normals() as u64;
    let mut streams: Vec<NormalStream> = channels
        .map(|channel| NormalStream::new(seed, MEMBER, channel))
        .collect();
    let (mut current, mut length) = (first, 1.0);
    let mut normals = vec![0.0; streams.len()];
    Ok(Box::new(move |x, u, step, dt| {
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
