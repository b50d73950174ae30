//! One second of DCOM and one of SDCOM, the same for host and microcontroller.
//!
//! Both start from numbers near the trim, so that no solver stands before them, and off it, so that every state moves.
#![no_std]
#![forbid(unsafe_code)]

use core::fmt::{self, Write};

use ahv_core::Vector;
use ahv_integrate::{ItoEulerMaruyama, Rk4, StepError, WienerSource};
use ahv_models::{dcom, sdcom};

/// Number of steps of a flight.
pub const STEPS: u32 = 1000;
/// Step size in s.
pub const DT: f64 = 0.001;

/// The experiment and its run, from which SDCOM's noise follows.
const SEED: u64 = 1;
const MEMBER: u64 = 0;
/// Elevator and fuel of level flight at 7702 ft/s and 85 000 ft.
const PHI: f64 = 0.282_090_6;
const DELTA_E: f64 = 0.228_647_8;
/// Angle of attack in rad: that of level flight and a tenth of a degree.
const ALPHA: f64 = 0.027_955_8;

/// A model with its state, stepper and noise.
pub trait Flight {
    /// Name of the model's module.
    const NAME: &'static str;
    /// State of the model.
    type State: Vector<f64>;

    /// The flight at its start.
    fn at_start() -> Self;

    /// Advances by [`DT`].
    ///
    /// # Errors
    ///
    /// [`StepError`]; the state is then the one before the step.
    fn step(&mut self) -> Result<(), StepError<f64>>;

    /// The present state.
    fn state(&self) -> Self::State;
}

/// DCOM by the classical Runge–Kutta method, at a held input.
#[derive(Clone, Debug)]
pub struct Dcom {
    model: dcom::Model<f64>,
    x: dcom::State<f64>,
    #[cfg(feature = "plant")]
    steps: u32,
}

impl Flight for Dcom {
    const NAME: &'static str = "dcom";
    type State = dcom::State<f64>;

    fn at_start() -> Self {
        Self {
            model: dcom::Model::new(&dcom::NOMINAL),
            x: dcom::State {
                velocity: 7702.0808,
                altitude: 85_000.0,
                gamma: 0.0,
                alpha: ALPHA,
                pitch_rate: 0.0,
                eta_1: 0.627_554_7,
                eta_dot_1: 0.0,
                eta_2: -0.013_697_9,
                eta_dot_2: 0.0,
                eta_3: -0.037_191_4,
                eta_dot_3: 0.0,
            },
            #[cfg(feature = "plant")]
            steps: 0,
        }
    }

    fn step(&mut self) -> Result<(), StepError<f64>> {
        let u = dcom::Input {
            phi: PHI,
            delta_e: DELTA_E,
            delta_c: 0.0,
        };
        Rk4::new(DT).step(&self.model, &mut self.x, &u)?;
        #[cfg(feature = "plant")]
        {
            self.steps += 1;
            if self.steps == STEPS / 2 {
                self.x.alpha = f64::from_bits(self.x.alpha.to_bits() ^ 1);
            }
        }
        Ok(())
    }

    fn state(&self) -> dcom::State<f64> {
        self.x
    }
}

/// SDCOM by the Euler–Maruyama method, at a held input, with keyed noise.
#[derive(Clone, Debug)]
pub struct Sdcom {
    model: sdcom::Model<f64>,
    noise: WienerSource<{ sdcom::Noise::<f64>::LEN }>,
    x: sdcom::State<f64>,
    steps: u64,
}

impl Flight for Sdcom {
    const NAME: &'static str = "sdcom";
    type State = sdcom::State<f64>;

    fn at_start() -> Self {
        Self {
            model: sdcom::Model::new(&sdcom::NOMINAL),
            noise: WienerSource::new(SEED, MEMBER),
            x: sdcom::State {
                velocity: 7702.0808,
                altitude: 85_000.0,
                gamma: 0.0,
                alpha: ALPHA,
                pitch_rate: 0.0,
                chi_1: 0.0,
                chi_2: 0.0,
                chi_3: 0.0,
            },
            steps: 0,
        }
    }

    fn step(&mut self) -> Result<(), StepError<f64>> {
        let u = sdcom::Input {
            phi: PHI,
            delta_e: DELTA_E,
            delta_c: 0.0,
        };
        let dw: sdcom::Noise<f64> = self.noise.increments(self.steps, DT);
        ItoEulerMaruyama::new(DT).step(&self.model, &mut self.x, &u, &dw)?;
        self.steps += 1;
        Ok(())
    }

    fn state(&self) -> sdcom::State<f64> {
        self.x
    }
}

/// A state that stands still: what a measurement costs without a model.
#[derive(Clone, Debug)]
pub struct Idle;

impl Flight for Idle {
    const NAME: &'static str = "idle";
    type State = sdcom::State<f64>;

    fn at_start() -> Self {
        Self
    }

    fn step(&mut self) -> Result<(), StepError<f64>> {
        Ok(())
    }

    fn state(&self) -> sdcom::State<f64> {
        sdcom::State::splat(0.0)
    }
}

/// Why a flight ended early.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ended {
    /// A step failed.
    Step {
        /// Number of the step, from 1.
        step: u32,
        /// Why.
        error: StepError<f64>,
    },
    /// The output took no more text.
    Output,
}

impl From<fmt::Error> for Ended {
    fn from(_: fmt::Error) -> Self {
        Self::Output
    }
}

/// Without the numbers of the error: printing a double would be most of a firmware's code.
impl fmt::Display for Ended {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Step { step, error } => match error {
                StepError::StepSize { .. } => write!(f, "step {step}: the step size is refused"),
                StepError::NonFinite { name, .. } => write!(f, "step {step}: {name} is not finite"),
            },
            Self::Output => write!(f, "the output took no more text"),
        }
    }
}

impl core::error::Error for Ended {}

/// Flies for [`STEPS`] steps, each taken by `step`, and writes the states: a line of names, then a line a step with number
/// and components, the latter as their bits in hexadecimal.
///
/// # Errors
///
/// [`Ended`].
pub fn fly<F: Flight>(
    out: &mut impl Write,
    mut step: impl FnMut(&mut F) -> Result<(), StepError<f64>>,
) -> Result<(), Ended> {
    let mut flight = F::at_start();
    write!(out, "{}", F::NAME)?;
    for name in F::State::NAMES {
        write!(out, " {name}")?;
    }
    writeln!(out)?;
    for number in 1..=STEPS {
        step(&mut flight).map_err(|error| Ended::Step {
            step: number,
            error,
        })?;
        write!(out, "{number}")?;
        let state = flight.state();
        for component in (0..F::State::LEN).filter_map(|index| state.get(index)) {
            write!(out, " {:016x}", component.to_bits())?;
        }
        writeln!(out)?;
    }
    Ok(())
}
