//! Many flights of one closed loop.

use std::sync::atomic::Ordering;

use ahv_analysis::actuator::{Actuator, Limits};
use ahv_analysis::ordered::Control;
use ahv_analysis::ordered::in_order;
use ahv_analysis::trim::{SteadyState, Trim, TrimError, trim};
use ahv_core::{GeneratedModel, Outside, first_outside};
use ahv_integrate::WienerSource;
use ahv_models::dcom::{self, INPUT_BOUNDS, Parameters, STATE_BOUNDS};
use ahv_models::sdcom;

use super::flight::{Increments, SUBSTEPS};
use super::{
    ClosedLoop, Controller, LinearTracker, LinearTrackerError, LoopState, Manoeuvre, PERIOD,
    Reference,
};
use crate::backstepping::{Backstepping, DESIGN};

/// Channels of noise of the truth.
const CHANNELS: usize = dcom::Noise::<()>::LEN;

/// Samples between two records.
const RECORD: u64 = 25;

/// Flights of a manoeuvre, with all that tells them apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// Parameters of the vehicle that flies.
    pub truth: Parameters<f64>,
    /// Parameters that the controllers are designed on.
    pub believed: Parameters<f64>,
    /// Actuators of φ and δe.
    pub actuators: [Actuator; 2],
    /// What to fly; it starts in level flight at its first velocity and altitude.
    pub manoeuvre: Manoeuvre,
    /// Length of a flight, in s.
    pub duration: f64,
    /// Flights.
    pub runs: u64,
    /// Seed of the noise.
    pub seed: u64,
}

/// Why there is no trial.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TrackError {
    /// The vehicle, or what the controllers take it for, has no trim to start from.
    #[error("the flight cannot start: {0}")]
    Trim(#[from] TrimError),
    /// There is no linear-quadratic tracker.
    #[error(transparent)]
    Linear(#[from] LinearTrackerError),
}

/// What is recorded at one time. In ft, s and rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// In s.
    pub time: f64,
    /// State of the vehicle.
    pub state: dcom::State<f64>,
    /// Positions of the actuators.
    pub input: dcom::Input<f64>,
    /// The commands.
    pub reference: Reference,
}

/// Size of an error over a flight.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorSize {
    /// Root mean square.
    pub rms: f64,
    /// Largest absolute value.
    pub max: f64,
}

/// Shares of the samples after which an actuator met its limits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LimitedShare {
    /// Of position.
    pub position: f64,
    /// Of rate.
    pub rate: f64,
}

/// A flight and its figures. A flight that was lost has them up to its last good sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Flight {
    /// Records every 0.25 s.
    pub samples: Vec<Sample>,
    /// Error of V (ft/s), h (ft) and γ (rad) against the commands.
    pub errors: [ErrorSize; 3],
    /// Largest |α|, in rad.
    pub alpha: f64,
    /// Least and largest φ and δe (rad).
    pub inputs: [(f64, f64); 2],
    /// How often φ and δe were limited.
    pub limited: [LimitedShare; 2],
    /// Where the state first left the validity box, and when, in s.
    pub departure: Option<(f64, Outside)>,
    /// When a state ceased to be finite, in s.
    pub lost: Option<f64>,
}

/// Actuators of φ and δe, `assumed`: lags of 10 and 20 rad/s, rates of 1 per s and 1 rad/s, limits of the validity box.
pub const ACTUATORS: [Actuator; 2] = [
    Actuator {
        bandwidth: 10.0,
        rate: 1.0,
        bounds: INPUT_BOUNDS.phi,
    },
    Actuator {
        bandwidth: 20.0,
        rate: 1.0,
        bounds: INPUT_BOUNDS.delta_e,
    },
];

/// The vehicle without its noise.
pub fn silent(parameters: Parameters<f64>) -> Parameters<f64> {
    Parameters {
        sigma_1: 0.0,
        sigma_2: 0.0,
        sigma_3: 0.0,
        w_gamma: 0.0,
        w_alpha: 0.0,
        w_q: 0.0,
        ..parameters
    }
}

impl Trial {
    /// What `ahv track` flies: the standard manoeuvre from 7702.0808 ft/s and 85 000 ft over 90 s, by controllers that know
    /// the vehicle.
    pub const fn standard(parameters: Parameters<f64>, runs: u64, seed: u64) -> Self {
        Self {
            truth: parameters,
            believed: parameters,
            actuators: ACTUATORS,
            manoeuvre: Manoeuvre::standard(7702.0808, 85_000.0),
            duration: 90.0,
            runs,
            seed,
        }
    }

    /// The backstepping controller.
    pub fn backstepping(&self) -> Backstepping {
        Backstepping::new(DESIGN, &self.believed)
    }

    /// The linear-quadratic tracker at the trim of the believed SDCOM.
    ///
    /// # Errors
    ///
    /// [`TrackError`]
    pub fn linear(&self) -> Result<LinearTracker, TrackError> {
        let model = sdcom::Model::new(&self.believed);
        let at = trim(&model, &self.level::<sdcom::Model<f64>>())?;
        Ok(LinearTracker::new(&model, &at.state, &at.input)?)
    }

    /// The closed loop of `model`, which is to have the true parameters, with `controller`; and the loop at rest at the trim.
    ///
    /// # Errors
    ///
    /// [`TrackError::Trim`]
    pub fn closed<'a, C: Controller>(
        &self,
        model: &'a dcom::Model<f64>,
        controller: &'a C,
    ) -> Result<(ClosedLoop<'a, C>, LoopState<C::Memory>), TrackError> {
        let Trim { state, input, .. } = trim(model, &self.level::<dcom::Model<f64>>())?;
        let closed = ClosedLoop {
            model,
            actuators: self.actuators,
            controller,
            manoeuvre: self.manoeuvre,
        };
        let rest = closed.start(state, input);
        Ok((closed, rest))
    }

    /// The flights of `controller`, member by member; fewer if `control` stops the work. It counts flights.
    ///
    /// Noise is a function of seed, member, channel and step: neither threads nor the controller change it.
    ///
    /// # Errors
    ///
    /// [`TrackError::Trim`]
    pub fn fly<C: Controller>(
        &self,
        controller: &C,
        control: &Control,
    ) -> Result<Vec<Flight>, TrackError> {
        let model = dcom::Model::new(&self.truth);
        let (closed, rest) = self.closed(&model, controller)?;
        in_order(0..self.runs, |member| {
            if control.stop.load(Ordering::Relaxed) {
                return Ok(None);
            }
            let flight = self.member(&closed, rest, member);
            control.done.fetch_add(1, Ordering::Relaxed);
            Ok(Some(flight))
        })
    }

    /// Level flight where the manoeuvre starts.
    fn level<M: GeneratedModel>(&self) -> SteadyState {
        SteadyState::new(&M::TRIM)
            .with("velocity", self.manoeuvre.velocity.from)
            .with("altitude", self.manoeuvre.altitude.from)
            .within(&M::INPUT_BOUNDS)
    }

    fn member<C: Controller>(
        &self,
        closed: &ClosedLoop<'_, C>,
        mut at: LoopState<C::Memory>,
        member: u64,
    ) -> Flight {
        let mut wiener = WienerSource::<CHANNELS>::new(self.seed, member);
        let mut record = Record::default();
        let periods = (self.duration / PERIOD).round() as u64;
        let mut lost = None;
        for period in 0..=periods {
            let time = period as f64 * PERIOD;
            record.sample(
                period,
                &Sample {
                    time,
                    state: at.state,
                    input: at.input,
                    reference: self.manoeuvre.at(time),
                },
            );
            if period == periods {
                break;
            }
            let noise =
                |substep, dt| -> Increments { wiener.increments(period * SUBSTEPS + substep, dt) };
            match closed.advance(&mut at, time, noise) {
                Ok(limits) => record.limits(limits),
                Err(_) => {
                    lost = Some(time);
                    break;
                }
            }
        }
        Flight {
            lost,
            ..record.flight()
        }
    }
}

/// Sums of a flight that goes on.
#[derive(Default)]
struct Record {
    samples: Vec<Sample>,
    squares: [f64; 3],
    errors: [ErrorSize; 3],
    alpha: f64,
    inputs: Option<[(f64, f64); 2]>,
    limited: [LimitedShare; 2],
    departure: Option<(f64, Outside)>,
    count: f64,
}

impl Record {
    fn sample(&mut self, period: u64, sample: &Sample) {
        let Sample {
            time,
            state,
            input,
            reference,
        } = sample;
        if period.is_multiple_of(RECORD) {
            self.samples.push(*sample);
        }
        self.count += 1.0;
        let errors = [
            state.velocity - reference.velocity,
            state.altitude - reference.altitude,
            state.gamma - reference.gamma(),
        ];
        for ((error, squares), size) in errors
            .into_iter()
            .zip(&mut self.squares)
            .zip(&mut self.errors)
        {
            *squares += error * error;
            size.max = size.max.max(error.abs());
        }
        self.alpha = self.alpha.max(state.alpha.abs());
        let positions = [input.phi, input.delta_e];
        let ranges = self
            .inputs
            .get_or_insert(positions.map(|position| (position, position)));
        for ((least, largest), position) in ranges.iter_mut().zip(positions) {
            (*least, *largest) = (least.min(position), largest.max(position));
        }
        if self.departure.is_none() {
            self.departure = first_outside(state, &STATE_BOUNDS).map(|outside| (*time, outside));
        }
    }

    fn limits(&mut self, limits: [Limits; 2]) {
        for (share, limits) in self.limited.iter_mut().zip(limits) {
            share.position += f64::from(u8::from(limits.position));
            share.rate += f64::from(u8::from(limits.rate));
        }
    }

    fn flight(self) -> Flight {
        let count = self.count;
        let mut errors = self.errors;
        for (size, squares) in errors.iter_mut().zip(self.squares) {
            size.rms = (squares / count).sqrt();
        }
        Flight {
            samples: self.samples,
            errors,
            alpha: self.alpha,
            inputs: self.inputs.unwrap_or_default(),
            limited: self
                .limited
                .map(|LimitedShare { position, rate }| LimitedShare {
                    position: position / count,
                    rate: rate / count,
                }),
            departure: self.departure,
            lost: None,
        }
    }
}
