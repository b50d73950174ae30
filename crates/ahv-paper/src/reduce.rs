//! A flexible mode and its reduction to coloured noise, in closed form.
//!
//! The mode η̈ + 2ζω η̇ + ω² η = σ ξ (17) and the Ornstein–Uhlenbeck process dχ = −a χ dt + b dw (18), both from rest, ξ
//! being white noise of intensity 1. The generated package `flexible_mode` gives the moments; here are their extremes.

mod held;

use ahv_core::{Shown, Vector};
use ahv_integrate::{LinearTransition, StepError};
use ahv_models::flexible_mode::{self, Input, NOMINAL, Parameters, Prepared, SETS, State, prepare};

pub use ahv_models::flexible_mode::Reduction;
pub use held::HeldPeak;

/// Distance of ζ from 1 below which the mode is critically damped: an error of this order in place of cancellation.
const CRITICAL: f64 = 1e-12;
/// Samples among which the extreme of the error is sought: as many at steps short against every period and decay, and
/// as many in geometric progression after them.
const SAMPLES: u32 = 4096;
/// The short steps, in units of the shortest time of mode and coloured noise.
const SHORT: f64 = 0.02;
/// End of the search, in units of the longest time of mode and coloured noise.
const LONG: f64 = 40.0;
/// Halvings of the interval that holds the extreme (by golden section).
const SECTIONS: usize = 60;
/// Share of the stationary variance of η below which the closed form cancels and the transition takes its place.
const CANCELS: f64 = 1e-3;
/// Relative difference from the mode's value below which a reduction keeps it.
const KEPT: f64 = 1e-9;

/// A flexible mode with the intensity of its noise.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Mode {
    /// Natural frequency ω, in rad/s.
    pub omega: f64,
    /// Damping ratio ζ.
    pub zeta: f64,
    /// Intensity σ of the white noise, in the unit of η per s^³⁄².
    pub sigma: f64,
}

/// Why a mode has no reduction.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ReduceError {
    /// A parameter that must be positive and finite is not.
    #[error("{name} must be positive and finite, not {}", Shown(*value))]
    NotPositive {
        /// Name of the parameter.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// The parameters are so large or small that a moment is not representable.
    #[error("the {name} of the mode with these parameters is {}", Shown(*value))]
    OutOfRange {
        /// Name of the moment.
        name: &'static str,
        /// Its value.
        value: f64,
    },
    /// A step of noise or of a search that makes no sense.
    #[error(transparent)]
    Step(#[from] StepError<f64>),
}

/// How the mode comes to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Damping {
    /// ζ < 1.
    Underdamped,
    /// ζ = 1.
    Critical,
    /// ζ > 1.
    Overdamped,
}

/// What a reduction may keep of its mode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Property {
    /// The slowest decay rate of the mode: ζω, or ω(ζ − √(ζ² − 1)) for ζ > 1.
    DecayRate,
    /// The stationary variance.
    Variance,
    /// The spectrum at zero frequency, which is what slow states feel.
    SpectrumAtZero,
}

/// A property of χ beside that of η.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Comparison {
    /// The property.
    pub property: Property,
    /// Its value for χ as a share of that for η.
    pub ratio: f64,
    /// Whether the two agree within 1e-9.
    pub kept: bool,
}

/// A greatest distance between the standard deviations of η and χ.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Peak {
    /// |D_η(t) − D_χ(t)|, in the unit of η.
    pub value: f64,
    /// When, in s; `None` if it is approached as time goes on.
    pub time: Option<f64>,
    /// Whether χ has the larger deviation there.
    pub chi_leads: bool,
}

/// Where the standard deviations of η and χ, from rest, differ most.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct StdErrors {
    /// Over all times.
    pub greatest: Peak,
    /// In the rise from rest: until D_η first reaches D_χ. χ starts with √t, η with t^³⁄², so that χ leads there.
    pub rise: Peak,
}

impl StdErrors {
    /// Whether the greatest distance is that of the rise.
    pub fn greatest_in_rise(&self) -> bool {
        self.greatest == self.rise
    }
}

/// A mode with its reduction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReducedMode {
    /// The mode.
    pub mode: Mode,
    /// How a and b are chosen.
    pub method: Reduction,
    /// Whether the mode oscillates.
    pub damping: Damping,
    prepared: Prepared<f64>,
}

/// The modes of (36) with σ = 100, as section 5.1 has them.
pub fn section_5_1() -> [Mode; 3] {
    SETS.map(|set| set.parameters).map(|set| Mode {
        omega: set.omega,
        zeta: set.zeta,
        sigma: set.sigma,
    })
}

/// The arguments that every function of the package takes and those used here ignore.
fn at_rest() -> (State<f64>, Input<f64>) {
    (State::splat(0.0), Input::splat(0.0))
}

/// Calls functions of the package with a time, by damping.
macro_rules! by_damping {
    ($self:ident, $time:ident: $under:ident, $critical:ident, $over:ident) => {{
        let ((x, u), p) = (at_rest(), &$self.prepared);
        match $self.damping {
            Damping::Underdamped => flexible_mode::$under(&x, &u, p, $time),
            Damping::Critical => flexible_mode::$critical(&x, &u, p, $time),
            Damping::Overdamped => flexible_mode::$over(&x, &u, p, $time),
        }
    }};
}

/// Calls a function of the package.
macro_rules! closed_form {
    ($self:ident, $function:ident $(, $argument:expr)?) => {{
        let (x, u) = at_rest();
        flexible_mode::$function(&x, &u, &$self.prepared $(, $argument)?)
    }};
}

impl ReducedMode {
    /// The reduction of `mode` by `method`.
    ///
    /// # Errors
    ///
    /// [`ReduceError`] unless ω, ζ and σ are positive and their moments finite and positive.
    pub fn new(mode: Mode, method: Reduction) -> Result<Self, ReduceError> {
        for (name, value) in [
            ("omega", mode.omega),
            ("zeta", mode.zeta),
            ("sigma", mode.sigma),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(ReduceError::NotPositive { name, value });
            }
        }
        let parameters = Parameters {
            omega: mode.omega,
            zeta: mode.zeta,
            sigma: mode.sigma,
            ..NOMINAL
        };
        let damping = match mode.zeta - 1.0 {
            excess if excess.abs() <= CRITICAL => Damping::Critical,
            excess if excess < 0.0 => Damping::Underdamped,
            _ => Damping::Overdamped,
        };
        let reduced = Self {
            mode,
            method,
            damping,
            prepared: prepare(&parameters.with_reduction(method)),
        };
        for (name, value) in [
            ("stationary variance", reduced.eta_variance()),
            ("variance of the coloured noise", reduced.chi_variance()),
            ("decay rate", reduced.decay()),
            ("spectrum at zero frequency", reduced.eta_spectrum(0.0)),
            (
                "spectrum of the coloured noise at zero frequency",
                reduced.chi_spectrum(0.0),
            ),
            ("slowest decay rate", reduced.rates().0),
            (
                "variance ratio of coloured noise and mode",
                reduced.variance_ratio(),
            ),
            (
                "spectrum ratio of coloured noise and mode",
                reduced.spectrum_ratio(),
            ),
        ] {
            if !(value.is_normal() && value > 0.0) {
                return Err(ReduceError::OutOfRange { name, value });
            }
        }
        Ok(reduced)
    }

    /// Decay rate a of the coloured noise, in 1/s.
    pub fn decay(&self) -> f64 {
        self.prepared.chi_decay
    }

    /// Intensity b of its noise, in the unit of η per s^½.
    pub fn intensity(&self) -> f64 {
        self.prepared.chi_diffusion
    }

    /// Stationary variance of η, σ²/(4ζω³).
    pub fn eta_variance(&self) -> f64 {
        closed_form!(self, eta_variance)
    }

    /// Stationary variance of χ, b²/(2a).
    pub fn chi_variance(&self) -> f64 {
        closed_form!(self, chi_variance)
    }

    /// Variance of η at `time`, in s, from rest: σ² ∫ h(s)² ds.
    pub fn eta_variance_at(&self, time: f64) -> f64 {
        let closed = by_damping!(self, time: eta_variance_at_underdamped, eta_variance_at_critical, eta_variance_at_overdamped);
        if closed >= CANCELS * self.eta_variance() {
            return closed;
        }
        // The closed form is a small difference of large numbers there; the transition is a sum.
        let Mode { omega, zeta, sigma } = self.mode;
        LinearTransition::mode(omega, zeta, sigma, time).map_or(0.0, |step| {
            let [[variance, _], _] = *step.covariance();
            variance
        })
    }

    /// Variance of χ at `time`, in s, from rest: b²(1 − e^{−2at})/(2a), without the difference.
    pub fn chi_variance_at(&self, time: f64) -> f64 {
        -self.chi_variance() * (-2.0 * self.decay() * time).exp_m1()
    }

    /// D_η(t) − D_χ(t), standard deviations from rest, at `time`, in s.
    pub fn std_error_at(&self, time: f64) -> f64 {
        self.eta_variance_at(time).sqrt() - self.chi_variance_at(time).sqrt()
    }

    /// Stationary autocorrelation of η at `lag`, in s.
    pub fn eta_autocorrelation(&self, lag: f64) -> f64 {
        by_damping!(self, lag: eta_autocorrelation_underdamped, eta_autocorrelation_critical, eta_autocorrelation_overdamped)
    }

    /// Stationary autocorrelation of χ at `lag`, in s.
    pub fn chi_autocorrelation(&self, lag: f64) -> f64 {
        closed_form!(self, chi_autocorrelation, lag)
    }

    /// Two-sided spectral density of η at `frequency`, in rad/s.
    pub fn eta_spectrum(&self, frequency: f64) -> f64 {
        closed_form!(self, eta_spectrum, frequency)
    }

    /// Two-sided spectral density of χ at `frequency`, in rad/s.
    pub fn chi_spectrum(&self, frequency: f64) -> f64 {
        closed_form!(self, chi_spectrum, frequency)
    }

    /// What χ has of the stationary variance of η.
    pub fn variance_ratio(&self) -> f64 {
        self.chi_variance() / self.eta_variance()
    }

    /// What χ has of the spectrum of η at zero frequency.
    pub fn spectrum_ratio(&self) -> f64 {
        self.chi_spectrum(0.0) / self.eta_spectrum(0.0)
    }

    /// Slowest decay rate of the mode, in 1/s: ζω for ζ ≤ 1, ω(ζ − √(ζ² − 1)) beyond.
    pub fn mode_decay(&self) -> f64 {
        match self.damping {
            Damping::Overdamped => self.prepared.slow_pole,
            _ => self.mode.zeta * self.mode.omega,
        }
    }

    /// Decay rate, variance and spectrum at zero frequency of χ beside those of η.
    pub fn comparisons(&self) -> [Comparison; 3] {
        [
            (Property::DecayRate, self.decay() / self.mode_decay()),
            (Property::Variance, self.variance_ratio()),
            (Property::SpectrumAtZero, self.spectrum_ratio()),
        ]
        .map(|(property, ratio)| Comparison {
            property,
            ratio,
            kept: (ratio - 1.0).abs() <= KEPT,
        })
    }

    /// Slowest and fastest rate of mode and coloured noise, in 1/s.
    fn rates(&self) -> (f64, f64) {
        let fast = match self.damping {
            Damping::Overdamped => self.prepared.fast_pole,
            _ => self.mode.omega,
        };
        (self.mode_decay().min(self.decay()), fast.max(self.decay()))
    }

    /// Time after which both processes are stationary to double precision, in s.
    pub fn settling_time(&self) -> f64 {
        LONG / self.rates().0
    }

    /// Where D_η(t) and D_χ(t) differ most, for white noise: over all times, and in the rise from rest.
    pub fn largest_std_errors(&self) -> StdErrors {
        let (slow, fast) = self.rates();
        let (end, step) = (LONG / slow, SHORT / fast);
        let short = f64::from(SAMPLES) * step;
        let ratio = (end / short).max(1.0).powf(1.0 / f64::from(SAMPLES));
        let late = (1..=SAMPLES).map(|index| short * ratio.powf(f64::from(index)));
        let early = (0..=SAMPLES).map(|index| step * f64::from(index));
        // At first D_η is σ t^³⁄²/√3 and D_χ is b √t: about when they meet.
        let meeting = 3.0_f64.sqrt() * self.intensity() / self.mode.sigma;
        let rise = (1..=SAMPLES).map(|index| 2.0 * meeting * f64::from(index) / f64::from(SAMPLES));
        let mut times: Vec<f64> = early.chain(late).chain(rise).collect();
        times.sort_by(f64::total_cmp);
        let samples: Vec<(f64, f64)> = times
            .into_iter()
            .map(|time| (time, self.std_error_at(time)))
            .collect();
        // Nothing moves at 0 s.
        let caught_up = samples.iter().skip(1).position(|&(_, error)| error >= 0.0);
        let rise = caught_up.map_or(samples.len(), |place| place + 1);
        let whole = self.peak(&samples, samples.len());
        let limit = self.eta_variance().sqrt() - self.chi_variance().sqrt();
        let greatest = if whole.value > limit.abs() * (1.0 + 1e-9) {
            whole
        } else {
            Peak {
                value: limit.abs(),
                time: None,
                chi_leads: limit < 0.0,
            }
        };
        let rise = match caught_up {
            // η never catches up: all is rise.
            None => greatest,
            Some(_) => self.peak(&samples, rise),
        };
        StdErrors { greatest, rise }
    }

    /// The greatest distance about the first `count` of `samples`, times with errors.
    fn peak(&self, samples: &[(f64, f64)], count: usize) -> Peak {
        let size = |index: usize| samples.get(index).map_or(0.0, |(_, error)| error.abs());
        let best = (0..count)
            .max_by(|&a, &b| size(a).total_cmp(&size(b)))
            .unwrap_or(0);
        let at = |index: usize| {
            samples
                .get(index.min(samples.len() - 1))
                .map_or(0.0, |it| it.0)
        };
        let error = |time: f64| self.std_error_at(time).abs();
        let time = summit(error, at(best.saturating_sub(1)), at(best + 1));
        let error = self.std_error_at(time);
        Peak {
            value: error.abs(),
            time: Some(time),
            chi_leads: error < 0.0,
        }
    }
}

/// Where `f` is greatest between `low` and `high`, if it has one maximum there (golden section).
fn summit(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
    for _ in 0..SECTIONS {
        let (left, right) = (high - golden * (high - low), low + golden * (high - low));
        if f(left) < f(right) {
            low = left;
        } else {
            high = right;
        }
    }
    low.midpoint(high)
}
