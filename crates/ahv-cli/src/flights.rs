//! Flights with noise and dispersions: what `ahv montecarlo` and `ahv rare` fly.

pub(crate) mod feedback;

use std::num::NonZeroUsize;

use ahv_analysis::disperse::{Distribution, Draws};
use ahv_analysis::monte_carlo::{Experiment, LANES, Mode, MonteCarloError, Scheme};
use ahv_analysis::ordered::Control;
use ahv_analysis::trim::SteadyState;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use serde::Serialize;

use crate::assignment::Assignments;
use crate::failure::{Failure, complain};
use crate::flight_condition::FlightCondition;
use crate::labels::Labels;
use crate::number::positive;
use crate::number::{self, Shown};
use crate::progress::Progress;
use crate::registry::needs_noise;
use crate::show::show;
use crate::signals::Stoppable;
use crate::steps::allowed;
use crate::vehicle::{PointJson, Vehicle, VehicleArgs};

/// Difference of two times, relative to them, that is rounding.
const SAME: f64 = 1e-9;
/// Most steps of a member: some hours.
const MOST_STEPS: f64 = 1e12;

/// How members fly.
#[derive(Args)]
pub(crate) struct Flights {
    #[command(flatten)]
    pub(crate) vehicle: VehicleArgs,

    #[command(flatten)]
    condition: FlightCondition,

    /// End of the flights in s
    #[arg(long, value_name = "S", value_parser = positive, allow_negative_numbers = true)]
    t_end: f64,

    /// Step in s; the last one ends at --t-end or up to half a step beside it
    #[arg(long, value_name = "S", default_value_t = 0.001, value_parser = positive, allow_negative_numbers = true)]
    dt: f64,

    /// Stepper [default: splitting, which steps coloured noise exactly; for a model without noise that can be split off heun]
    #[arg(long, value_parser = one_of(Scheme::ALL, Scheme::name))]
    scheme: Option<Scheme>,

    /// Arithmetic: exact; f32-noise, normal numbers in single precision
    #[arg(long, default_value = "exact", value_parser = one_of(Mode::ALL, Mode::name))]
    mode: Mode,

    /// Seed of noise and dispersion
    #[arg(long, default_value_t = 0)]
    seed: u64,

    /// Threads, as many as the machine runs at once at most [default: so many]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,

    /// Draw the parameters of each member, uniformly within their uncertainty, as `ahv disperse` does with the same seed
    #[arg(long)]
    disperse: bool,

    /// Standard deviations of the states at the start, e.g. altitude=50ft,gamma=0.2deg
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    state_std: Vec<String>,

    /// Standard deviations of the inputs at the start, e.g. phi=0.01; without feedback they are held
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    input_std: Vec<String>,

    #[command(flatten)]
    feedback: feedback::FeedbackArguments,
}

/// Reads one of these by its name.
fn one_of<T: Copy + Send + Sync + 'static, const N: usize>(
    all: [T; N],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let names = PossibleValuesParser::new(all.map(name));
    names.try_map(move |text| {
        let found = all.into_iter().find(|&it| name(it) == text);
        found.ok_or_else(|| format!("there is no {text}"))
    })
}

/// Flights that are about to start, with no limits but the validity box.
pub(crate) struct Ready {
    pub(crate) vehicle: Vehicle,
    /// Where they start, in words.
    pub(crate) place: String,
    pub(crate) experiment: Experiment,
    threads: usize,
}

impl Flights {
    /// Makes the flights ready.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for bad input, [`Failure::Numeric`] if there is no trim.
    pub(crate) fn ready(&self) -> Result<Ready, Failure> {
        let vehicle = self.vehicle.vehicle()?;
        let flight = self.condition.flight(&vehicle)?;
        let trim = vehicle.trim(&flight)?;
        let experiment = self.experiment(&vehicle, &flight, (trim.state, trim.input))?;
        let most = std::thread::available_parallelism().ok();
        let threads = self.threads.into_iter().chain(most).min();
        Ok(Ready {
            place: vehicle.at(&flight),
            vehicle,
            experiment,
            threads: threads.map_or(1, NonZeroUsize::get),
        })
    }

    fn experiment(
        &self,
        vehicle: &Vehicle,
        flight: &SteadyState,
        (state, input): (Vec<f64>, Vec<f64>),
    ) -> Result<Experiment, Failure> {
        if self.state_std.is_empty() && self.input_std.is_empty() && !self.disperse {
            let why = "; without --disperse, --state-std or --input-std all members are one";
            needs_noise("--model", vehicle.model, why)?;
        }
        let steps = (self.t_end / self.dt).round();
        let steps = allowed(self.t_end, self.dt, steps, MOST_STEPS)?;
        let end = number::time(steps as f64 * self.dt);
        if (end - self.t_end).abs() > SAME * self.t_end {
            complain(&format!(
                "note: the flights end at {} s, the multiple of --dt that is nearest to --t-end",
                Shown(end)
            ));
        }
        Ok(Experiment {
            parameters: vehicle.parameters.clone(),
            dispersion: self.dispersion(vehicle)?,
            state: [
                state,
                deviations("--state-std", &self.state_std, vehicle, vehicle.states)?,
            ],
            input: [
                input,
                deviations("--input-std", &self.input_std, vehicle, vehicle.inputs)?,
            ],
            feedback: self.feedback.read(vehicle, flight)?,
            watched: vec![vehicle.state_bounds.clone()],
            scheme: self
                .scheme
                .unwrap_or_else(|| vehicle.model.default_scheme(&vehicle.parameters)),
            mode: self.mode,
            dt: self.dt,
            snapshots: vec![steps],
            seed: self.seed,
            control_variate: false,
        })
    }

    fn dispersion(&self, vehicle: &Vehicle) -> Result<Option<Draws>, Failure> {
        let draws = self.disperse.then(|| {
            Draws::of_values(
                vehicle.model.parameters().names,
                vehicle.parameters.clone(),
                vehicle.uncertainty.clone(),
                Distribution::Uniform,
                Vec::new(),
                self.seed,
            )
        });
        draws
            .transpose()
            .map_err(|error| Failure::Request(format!("--disperse: {error}")))
    }
}

/// How members flew, as JSON.
#[derive(Serialize)]
pub(crate) struct Settings {
    threads: usize,
    scheme: &'static str,
    mode: &'static str,
    seed: u64,
    dt: f64,
    steps: u64,
    dispersed: bool,
    feedback: bool,
}

impl Ready {
    /// Threads for so many members that fly at a time.
    pub(crate) fn threads(&self, members: u64) -> usize {
        let batches = members.div_ceil(LANES as u64);
        // Never more than there were.
        self.threads
            .min(usize::try_from(batches).unwrap_or(usize::MAX))
    }

    /// End of the flights, in s.
    pub(crate) fn duration(&self) -> f64 {
        self.time(self.experiment.steps())
    }

    /// Where the flights start.
    pub(crate) fn point(&self) -> PointJson {
        let Experiment { state, input, .. } = &self.experiment;
        self.vehicle.point(&state[0], &input[0])
    }

    /// Time after so many steps, in s.
    pub(crate) fn time(&self, steps: u64) -> f64 {
        number::time(steps as f64 * self.experiment.dt)
    }

    /// For so many members that fly at a time.
    pub(crate) fn settings(&self, members: u64) -> Settings {
        let experiment = &self.experiment;
        Settings {
            threads: self.threads(members),
            scheme: experiment.scheme.name(),
            mode: experiment.mode.name(),
            seed: experiment.seed,
            dt: experiment.dt,
            steps: experiment.steps(),
            dispersed: experiment.dispersion.is_some(),
            feedback: experiment.feedback.is_some(),
        }
    }
}

/// Standard deviations, 0 where none is given.
pub(crate) fn deviations(
    option: &str,
    texts: &[String],
    vehicle: &Vehicle,
    labels: Labels,
) -> Result<Vec<f64>, Failure> {
    let mut deviations = vec![0.0; labels.len()];
    let given = Assignments::parse(option, texts, labels)?;
    given.apply(&mut deviations);
    vehicle.check_effect(option, &given)?;
    let mut named = labels.iter().zip(&deviations);
    match named.find(|(_, deviation)| **deviation < 0.0) {
        Some(((name, unit), &value)) => Err(Failure::Request(format!(
            "{option}: {name} is {}; a standard deviation is 0 or more",
            show(value, unit)
        ))),
        None => Ok(deviations),
    }
}

/// Does work that a signal stops.
///
/// # Errors
///
/// [`Failure::Interrupted`] if the signal came before there was anything to report, those of the work.
pub(crate) fn watched<T>(
    progress: Progress,
    work: impl FnOnce(&Control) -> Result<T, MonteCarloError>,
) -> Result<T, Failure> {
    let stoppable = Stoppable::new(progress.control());
    let outcome = work(progress.control());
    drop(stoppable);
    drop(progress);
    outcome.map_err(|error| match error {
        MonteCarloError::Stopped => Failure::Interrupted(format!("interrupted: {error}")),
        MonteCarloError::Scheme { .. }
        | MonteCarloError::NoColouredNoise { .. }
        | MonteCarloError::Normals { .. } => Failure::Request(format!("--scheme: {error}")),
        other => Failure::Request(other.to_string()),
    })
}
