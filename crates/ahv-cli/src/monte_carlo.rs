//! `ahv montecarlo`: many flights with noise and dispersions.

mod feedback;
mod figure;
mod report;
mod tables;
mod trajectories;

use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

use ahv_analysis::disperse::{Distribution, Draws};
use ahv_analysis::monte_carlo::{
    Control, Dcom, Experiment, Family, Flown, Mode, MonteCarloError, Outcome, Scheme, Sdcom,
};
use ahv_core::{Bounds, Vector};
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};

use crate::assignment::Assignments;
use crate::condition::{Condition, Vehicle};
use crate::failure::{Failure, print};
use crate::output;
use crate::place::Place;
use crate::progress::Progress;
use crate::simulate::grid::positive;
use crate::vehicle::{FlightModel, ModelName};
use trajectories::Format;

/// Between two looks at how far the flights are.
const GLANCE: Duration = Duration::from_millis(5);
/// Set in the seed of the drawn parameters: they have nothing to do with the noise.
const DISPERSION_SEED: u64 = 0x5851_F42D_4C95_7F2D;

/// Flies a stochastic model many times and tells how the flights spread.
///
/// Members start at the trim and hold its inputs, or follow a state feedback. They fly eight at a time with the vector
/// instructions of the machine. The same seed gives the same numbers whatever the threads, and with the mode exact on every
/// machine. A member whose state is no longer finite is lost: it is counted, and left out of what is told from then on. One
/// that leaves the validity box is counted and flies on. Ctrl-C ends the work, and what was flown till then is told.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    condition: Condition,

    #[command(flatten)]
    place: Place,

    /// Flights
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..=1_000_000_000))]
    members: u64,

    /// End of the flights in s
    #[arg(long, value_name = "S", value_parser = positive, allow_negative_numbers = true)]
    t_end: f64,

    /// Step in s; the last one ends at --t-end or up to half a step beside it
    #[arg(long, value_name = "S", default_value_t = 0.001, value_parser = positive, allow_negative_numbers = true)]
    dt: f64,

    /// Stepper [default: splitting, which steps coloured noise exactly; for dcom, which has none, heun]
    #[arg(long, value_parser = names(Scheme::ALL.map(Scheme::name)))]
    scheme: Option<String>,

    /// Arithmetic: exact; fma, one rounding for a product and its sum; f32-noise, normal numbers in single precision;
    /// f32-drift, drift and noise in single precision, states in double
    #[arg(long, default_value = "exact", value_parser = names(Mode::ALL.map(Mode::name)))]
    mode: String,

    /// Seed of noise and dispersion
    #[arg(long, default_value_t = 0)]
    seed: u64,

    /// Threads [default: as many as the machine runs at once]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,

    /// Draw the parameters of each member, uniformly within their uncertainty
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

    /// Limits of states whose violation is told, e.g. alpha=-2deg..6deg
    #[arg(
        long,
        value_name = "NAME=LOW..HIGH",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    limit: Vec<String>,

    /// Times at which the spread is told, in equal parts of the flight
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=1000))]
    snapshots: u64,

    /// Members whose whole flights are written, e.g. 0,7,100
    #[arg(long, value_name = "MEMBERS", value_delimiter = ',')]
    trajectories: Vec<u64>,

    /// File format of the trajectories
    #[arg(long, value_enum, default_value_t = Format::Csv)]
    trajectory_format: Format,

    /// Folder for montecarlo.svg, summary.json, snapshots.csv, histograms.csv, limits.csv and trajectories
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print the outcome as JSON, in the units of the model
    #[arg(long)]
    json: bool,
}

fn names<const N: usize>(names: [&'static str; N]) -> PossibleValuesParser {
    names.into()
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if there is no trim,
/// [`Failure::Interrupted`] once the part is told that was flown.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    match arguments.condition.model {
        ModelName::Sdcom => fly::<ahv_models::sdcom::Model<f64>, Sdcom>(arguments),
        ModelName::Dcom => fly::<ahv_models::dcom::Model<f64>, Dcom>(arguments),
        other => {
            let name = other.to_possible_value();
            let name = name.as_ref().map_or("this", |it| it.get_name());
            Err(Failure::Request(format!(
                "--model: {name} is not flown side by side; sdcom and dcom are"
            )))
        }
    }
}

/// A model that the command line knows, and as a family.
trait Pair<F: Family>:
    FlightModel<
        State = F::State<f64>,
        Input = F::Input<f64>,
        Parameters = F::Parameters<f64>,
        StateBounds = F::State<Bounds>,
        InputBounds = F::Input<Bounds>,
    >
{
}

impl<F: Family, M> Pair<F> for M where
    M: FlightModel<
            State = F::State<f64>,
            Input = F::Input<f64>,
            Parameters = F::Parameters<f64>,
            StateBounds = F::State<Bounds>,
            InputBounds = F::Input<Bounds>,
        >
{
}

/// What was flown, and what came of it.
struct Told<'a, F: Flown, M: Pair<F>> {
    arguments: &'a Arguments,
    vehicle: &'a Vehicle<M>,
    place: String,
    experiment: Experiment<F>,
    threads: usize,
    outcome: Outcome,
}

fn fly<M: Pair<F>, F: Flown>(arguments: &Arguments) -> Result<(), Failure> {
    let vehicle: Vehicle<M> = arguments.condition.vehicle()?;
    let flight = arguments.place.flight(&vehicle)?;
    let trim = vehicle.trim(&flight)?;
    let experiment = experiment::<M, F>(arguments, &vehicle, trim.state, trim.input)?;
    // Before the work: what cannot be written is not told after it.
    trajectories::check(arguments)?;
    if let Some(folder) = &arguments.out {
        output::folder(folder)?;
    }
    let threads = arguments
        .threads
        .or_else(|| std::thread::available_parallelism().ok());
    let threads = threads.map_or(1, NonZeroUsize::get);
    let outcome = with_progress(&experiment, arguments.members, |control| {
        experiment.run(arguments.members, threads, control)
    })?;
    let told = Told {
        arguments,
        place: vehicle.at(&flight),
        vehicle: &vehicle,
        experiment,
        threads,
        outcome,
    };
    if let Some(folder) = &arguments.out {
        told.write(folder)?;
    }
    if arguments.json {
        output::print_json(&told.json())?;
    } else {
        print(&told.text())?;
    }
    if told.outcome.members < told.outcome.asked {
        return Err(Failure::Interrupted(format!(
            "interrupted: {} of {} members were flown, and are told",
            told.outcome.members, told.outcome.asked
        )));
    }
    Ok(())
}

fn experiment<M: Pair<F>, F: Flown>(
    arguments: &Arguments,
    vehicle: &Vehicle<M>,
    state: F::State<f64>,
    input: F::Input<f64>,
) -> Result<Experiment<F>, Failure> {
    let dispersion = arguments.disperse.then(|| {
        let seed = arguments.seed ^ DISPERSION_SEED;
        let (nominal, uncertainty) = (vehicle.parameters, vehicle.uncertainty);
        Draws::new(
            nominal,
            uncertainty,
            Distribution::Uniform,
            Vec::new(),
            seed,
        )
        .map_err(|error| Failure::Request(format!("--disperse: {error}")))
    });
    let steps = (arguments.t_end / arguments.dt).round();
    if !(1.0..=1e12).contains(&steps) {
        return Err(Failure::Request(format!(
            "--dt and --t-end: {steps} steps; 1 to 1e12 can be flown"
        )));
    }
    let feedback = arguments.feedback.read::<M, F>(vehicle)?;
    let limits = limits::<M, F>(&arguments.limit, vehicle)?;
    let named = |name: &str| Scheme::ALL.into_iter().find(|scheme| scheme.name() == name);
    let default = if F::NAME == Dcom::NAME {
        Scheme::Heun
    } else {
        Scheme::Splitting
    };
    Ok(Experiment {
        parameters: vehicle.parameters,
        dispersion: dispersion.transpose()?,
        state: [
            state,
            deviations("--state-std", &arguments.state_std, vehicle)?,
        ],
        input: [
            input,
            deviations("--input-std", &arguments.input_std, vehicle)?,
        ],
        feedback,
        watched: std::iter::once(vehicle.state_bounds)
            .chain(limits)
            .collect(),
        scheme: arguments
            .scheme
            .as_deref()
            .and_then(named)
            .unwrap_or(default),
        mode: Mode::ALL
            .into_iter()
            .find(|mode| mode.name() == arguments.mode)
            .unwrap_or_default(),
        dt: arguments.dt,
        snapshots: snapshots(steps as u64, arguments.snapshots),
        seed: arguments.seed,
    })
}

/// Numbers of steps: 0, and the ends of equal parts, as far as steps allow.
fn snapshots(steps: u64, parts: u64) -> Vec<u64> {
    let parts = parts.min(steps);
    (0..=parts)
        .map(|part| (u128::from(steps) * u128::from(part) / u128::from(parts)) as u64)
        .collect()
}

/// Standard deviations, 0 where none is given.
fn deviations<M: FlightModel, V: Vector<f64>>(
    option: &str,
    texts: &[String],
    vehicle: &Vehicle<M>,
) -> Result<V, Failure> {
    let mut deviations = V::splat(0.0);
    Assignments::parse::<V>(option, texts, vehicle.units)?.apply(&mut deviations, &[]);
    match deviations.find(|deviation| deviation < 0.0) {
        Some((name, value)) => Err(Failure::Request(format!(
            "{option}: {name} is {value}; a standard deviation is 0 or more"
        ))),
        None => Ok(deviations),
    }
}

/// Limits of the user's; `None` if there are none. States without are not limited.
fn limits<M: Pair<F>, F: Flown>(
    texts: &[String],
    vehicle: &Vehicle<M>,
) -> Result<Option<F::State<Bounds>>, Failure> {
    let (mut low, mut high) = (Vec::new(), Vec::new());
    for text in texts {
        let form = || {
            Failure::Request(format!(
                "--limit: `{text}` is not of the form NAME=LOW..HIGH, e.g. alpha=-2deg..6deg"
            ))
        };
        let (name, ends) = text.split_once('=').ok_or_else(form)?;
        let (min, max) = ends.split_once("..").ok_or_else(form)?;
        low.push(format!("{name}={min}"));
        high.push(format!("{name}={max}"));
    }
    if texts.is_empty() {
        return Ok(None);
    }
    let parse = |texts: &[String], infinite: f64| -> Result<F::State<f64>, Failure> {
        let mut ends = F::State::splat(infinite);
        Assignments::parse::<F::State<f64>>("--limit", texts, vehicle.units)?.apply(&mut ends, &[]);
        Ok(ends)
    };
    let (low, high) = (
        parse(&low, f64::NEG_INFINITY)?,
        parse(&high, f64::INFINITY)?,
    );
    let bounds = F::State::from_fn(|index| {
        let end = |ends: &F::State<f64>| ends.get(index).unwrap_or(f64::NAN);
        Bounds::new(end(&low), end(&high))
    });
    match bounds.find(|it| it.min >= it.max) {
        Some((name, Bounds { min, max })) => Err(Failure::Request(format!(
            "--limit: of {name} the lower limit {min} is not below the upper one {max}"
        ))),
        None => Ok(Some(bounds)),
    }
}

/// Works while a bar shows how far it is, and Ctrl-C is listened to.
fn with_progress<F: Flown>(
    experiment: &Experiment<F>,
    members: u64,
    work: impl FnOnce(&Control) -> Result<Outcome, MonteCarloError> + Send,
) -> Result<Outcome, Failure> {
    let control = std::sync::Arc::new(Control::default());
    let heard = std::sync::Arc::clone(&control);
    ctrlc::set_handler(move || {
        // A second time means now.
        if heard.stop.swap(true, Ordering::Relaxed) {
            std::process::exit(Failure::INTERRUPTED.into());
        }
    })
    .map_err(|error| Failure::Request(format!("cannot listen to Ctrl-C: {error}")))?;
    let total = members.saturating_mul(experiment.steps());
    let outcome = std::thread::scope(|scope| {
        let worker = scope.spawn(|| work(&control));
        let mut progress = Progress::of_member_steps(total);
        while !worker.is_finished() {
            std::thread::sleep(GLANCE);
            progress.tell(control.done.load(Ordering::Relaxed));
        }
        worker.join()
    });
    let outcome =
        outcome.map_err(|_| Failure::Numeric("a thread of the flights failed".to_owned()))?;
    outcome.map_err(|error| match error {
        MonteCarloError::Stopped => Failure::Interrupted(format!("interrupted: {error}")),
        MonteCarloError::Scheme { .. } | MonteCarloError::ModeOfScheme { .. } => {
            Failure::Request(format!("--scheme: {error}"))
        }
        MonteCarloError::NoFma => Failure::Request(format!("--mode: {error}")),
        other => Failure::Request(other.to_string()),
    })
}
