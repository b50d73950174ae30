//! `ahv reduce`: flexible modes and their reduction to coloured noise.

mod figure;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use ahv_analysis::reduction::ReductionMethod;
use ahv_analysis::statistics::Estimate;
use ahv_cli::csv_file::CsvFile;
use ahv_cli::failure::{Failure, print};
use ahv_cli::number::{self, Shown, fixed, positive};
use ahv_cli::output;
use ahv_cli::progress::{Progress, Work};
use ahv_cli::steps::allowed;
use clap::Args;
use clap::builder::PossibleValuesParser;
use serde::Serialize;

use crate::ensemble::{Drive, Experiment, Moments, Reading, process_of};
use crate::reduce::{
    Comparison, Damping, Mode, Peak, Property, ReducedMode, Reduction, StdErrors, section_5_1,
};

/// Fewest runs for which the intervals hold.
const FEWEST_RUNS: u64 = 30;
/// Most runs and most steps.
const MOST: u64 = 1_000_000;

/// Reduces flexible modes to coloured noise and compares the two, or the linear system of a model to fewer states.
///
/// A mode eta'' + 2 zeta omega eta' + omega^2 eta = sigma xi (17) becomes the Ornstein-Uhlenbeck process
/// dchi = -a chi dt + b dw (24). Moments, autocorrelations and spectra are in closed form, from rest; beside them stand
/// samples of an ensemble with intervals of 95 %. Lists have one value a mode.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Natural frequencies in rad/s [default: those of (36): 19.7437,47.7851,94.8203]
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    omega: Option<Vec<f64>>,

    /// Damping ratios [default: those of (36): 0.7,0.6,0.5]
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    zeta: Option<Vec<f64>>,

    /// Intensities of the white noise in (ft*slug)^0.5/s^1.5 [default: 100 for each mode, as in section 5.1]
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        allow_hyphen_values = true
    )]
    sigma: Option<Vec<f64>>,

    /// Choice of a and b: printed (23) is zeta omega, zeta sigma/omega; variance is zeta omega, sigma/(sqrt(2) omega); moment
    /// is omega/(2 zeta), sigma/(2 zeta omega). The outcome states what each keeps of the mode. balanced (truncation) and krylov (moments at zero frequency) reduce the
    /// linear system of --model about its trim to --order states
    #[arg(long, default_value = Reduction::Printed.name(), value_parser = methods())]
    method: String,

    /// Runs of the ensemble
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u64).range(FEWEST_RUNS..=MOST))]
    runs: u64,

    /// End of a run in s
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = positive, allow_negative_numbers = true)]
    t_end: f64,

    /// Time between samples in s; a step is exact however long
    #[arg(long, value_name = "S", default_value_t = 0.01, value_parser = positive, allow_negative_numbers = true)]
    dt: f64,

    /// Seed of the noise: the same seed gives the same numbers on every machine
    #[arg(long, default_value_t = 0)]
    seed: u64,

    /// Folder for reduce.svg and reduce.csv
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print the outcome as JSON
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    linear: ahv_cli::reduce::Arguments,
}

fn methods() -> PossibleValuesParser {
    let of_modes = Reduction::ALL.map(Reduction::name);
    let of_systems = ReductionMethod::ALL.map(ReductionMethod::name);
    PossibleValuesParser::new(of_modes.into_iter().chain(of_systems))
}

/// A mode, its reduction and an ensemble of both.
struct Subject {
    reduced: ReducedMode,
    times: Vec<f64>,
    eta: Moments,
    chi: Moments,
    runs: u64,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for modes or times without sense and files that cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let mut systems = ReductionMethod::ALL.into_iter();
    if let Some(method) = systems.find(|it| it.name() == arguments.method) {
        arguments.refuse_those_of_modes(method)?;
        return arguments.linear.run(method, arguments.json);
    }
    arguments.linear.refuse(&arguments.method)?;
    let method = Reduction::from_name(&arguments.method).unwrap_or(Reduction::Printed);
    let experiment = arguments.experiment()?;
    let modes = arguments.modes()?;
    let work = experiment.runs * experiment.steps;
    let folder = arguments.out.as_deref();
    if let Some(folder) = folder {
        output::folder(folder)?;
    }
    let progress = Progress::start(Work {
        command: "reduce",
        unit: "steps",
        total: Some(work * modes.len() as u64),
    });
    let mut subjects = Vec::new();
    for (index, mode) in (0..).zip(&modes) {
        let problem = |error| Failure::Request(format!("mode {}: {error}", index + 1));
        let reduced = ReducedMode::new(*mode, method).map_err(problem)?;
        let moments = experiment.moments(mode, index, 0).map_err(problem)?;
        subjects.push(Subject {
            reduced,
            times: experiment.times(),
            eta: moments[0].clone(),
            chi: moments[process_of(method)].clone(),
            runs: experiment.runs,
        });
        progress.reach(work * (index + 1));
    }
    drop(progress);
    // Whatever fails, the rest is reported; the picture comes last.
    let written = folder.map_or(Ok(()), |folder| write_table(folder, &subjects));
    let printed = if arguments.json {
        output::print_json(&Json::new(method, &experiment, &subjects))
    } else {
        print(&text(method, &experiment, &subjects))
    };
    let drawn = folder.map_or(Ok(()), |folder| {
        output::picture(&folder.join("reduce.svg"), figure::draw(&subjects))
    });
    written.and(printed).and(drawn)
}

impl Arguments {
    /// A system has no list of modes, and leaves no file.
    fn refuse_those_of_modes(&self, method: ReductionMethod) -> Result<(), Failure> {
        let given = [
            ("--omega", self.omega.is_some()),
            ("--zeta", self.zeta.is_some()),
            ("--sigma", self.sigma.is_some()),
            ("--out", self.out.is_some()),
        ];
        match given.into_iter().find(|(_, given)| *given) {
            Some((flag, _)) => Err(Failure::Request(format!(
                "{flag}: it is for modes; --method {} reduces the linear system of --model",
                method.name()
            ))),
            None => Ok(()),
        }
    }

    fn experiment(&self) -> Result<Experiment, Failure> {
        let steps = (self.t_end / self.dt).round();
        let steps = allowed(self.t_end, self.dt, steps, MOST as f64)?;
        Ok(Experiment {
            reading: Reading::White,
            drive: Drive::Common,
            runs: self.runs,
            steps,
            dt: self.dt,
            seed: self.seed,
        })
    }

    fn modes(&self) -> Result<Vec<Mode>, Failure> {
        let list = |given: &Option<Vec<f64>>, of: fn(&Mode) -> f64| {
            let default = || section_5_1().iter().map(of).collect();
            given.clone().unwrap_or_else(default)
        };
        let omega = list(&self.omega, |mode| mode.omega);
        let zeta = list(&self.zeta, |mode| mode.zeta);
        let [first, ..] = section_5_1();
        let default = || vec![first.sigma; omega.len()];
        let sigma = self.sigma.clone().unwrap_or_else(default);
        if omega.len() != zeta.len() || omega.len() != sigma.len() {
            return Err(Failure::Request(format!(
                "--omega has {} values, --zeta {} and --sigma {}: each needs one value a mode",
                omega.len(),
                zeta.len(),
                sigma.len()
            )));
        }
        let modes = omega.into_iter().zip(zeta).zip(sigma);
        Ok(modes
            .map(|((omega, zeta), sigma)| Mode { omega, zeta, sigma })
            .collect())
    }
}

impl Subject {
    /// Standard deviations of the samples with their intervals, at each time. The steps are exact transitions of linear
    /// equations: the samples are normal.
    fn sampled(&self, moments: &Moments) -> Vec<Estimate> {
        let runs = self.runs as f64;
        moments
            .std
            .iter()
            .map(|&std| Estimate::of_normal_std(std, runs))
            .collect()
    }

    /// Share of the sampled deviations whose interval holds the exact one; nothing moves at 0 s.
    fn coverage(&self, moments: &Moments, variance: impl Fn(f64) -> f64) -> f64 {
        let samples = self.sampled(moments);
        let held = samples.iter().zip(&self.times).skip(1);
        let held = held.filter(|&(sample, &time)| sample.holds(variance(time).sqrt()));
        held.count() as f64 / (self.times.len() - 1) as f64
    }
}

/// The outcome as JSON.
#[derive(Serialize)]
struct Json {
    method: &'static str,
    experiment: Experiment,
    eta_std: Vec<f64>,
    chi_std: Vec<f64>,
    max_abs_std_error: Vec<f64>,
    modes: Vec<JsonMode>,
}

#[derive(Serialize)]
struct JsonMode {
    omega: f64,
    zeta: f64,
    sigma: f64,
    damping: Damping,
    /// Slowest decay rate of the mode, in 1/s.
    mode_decay: f64,
    decay: f64,
    intensity: f64,
    eta_std: f64,
    chi_std: f64,
    max_abs_std_error: f64,
    /// `null` where the greatest error is that of the stationary processes.
    max_abs_std_error_time: Option<f64>,
    /// Whether chi has the larger deviation there.
    max_abs_std_error_chi_leads: bool,
    max_abs_std_error_in_rise: bool,
    /// The greatest error in the rise from rest, and when.
    rise_abs_std_error: f64,
    rise_abs_std_error_time: Option<f64>,
    decay_ratio: f64,
    variance_ratio: f64,
    spectrum_ratio_at_zero: f64,
    keeps: Vec<Property>,
    gives_up: Vec<Property>,
    monte_carlo: JsonSamples,
}

#[derive(Serialize)]
struct JsonSamples {
    eta_std: Estimate,
    chi_std: Estimate,
    max_abs_mean_error: f64,
    max_abs_std_error: f64,
    eta_std_coverage: f64,
    chi_std_coverage: f64,
}

impl Json {
    fn new(method: Reduction, experiment: &Experiment, subjects: &[Subject]) -> Self {
        let modes: Vec<JsonMode> = subjects.iter().map(JsonMode::new).collect();
        let list = |of: fn(&JsonMode) -> f64| modes.iter().map(of).collect();
        Self {
            method: method.name(),
            experiment: *experiment,
            eta_std: list(|mode| mode.eta_std),
            chi_std: list(|mode| mode.chi_std),
            max_abs_std_error: list(|mode| mode.max_abs_std_error),
            modes,
        }
    }
}

impl JsonMode {
    fn new(subject: &Subject) -> Self {
        let Subject {
            reduced, eta, chi, ..
        } = subject;
        let Mode { omega, zeta, sigma } = reduced.mode;
        let errors = reduced.largest_std_errors();
        let Peak {
            value,
            time,
            chi_leads,
        } = errors.greatest;
        let comparisons = reduced.comparisons();
        let [Comparison { ratio, .. }, ..] = comparisons;
        let properties = |kept| {
            let chosen = comparisons.iter().filter(|it| it.kept == kept);
            chosen.map(|it| it.property).collect()
        };
        let largest = |a: &[f64], b: &[f64]| {
            let errors = a.iter().zip(b).map(|(a, b)| (a - b).abs());
            errors.fold(0.0, f64::max)
        };
        let last = |moments: &Moments| {
            let last = moments.std.last().copied().unwrap_or_default();
            Estimate::of_normal_std(last, subject.runs as f64)
        };
        Self {
            omega,
            zeta,
            sigma,
            damping: reduced.damping,
            mode_decay: reduced.mode_decay(),
            decay: reduced.decay(),
            intensity: reduced.intensity(),
            eta_std: reduced.eta_variance().sqrt(),
            chi_std: reduced.chi_variance().sqrt(),
            max_abs_std_error: value,
            max_abs_std_error_time: time,
            max_abs_std_error_chi_leads: chi_leads,
            max_abs_std_error_in_rise: errors.greatest_in_rise(),
            rise_abs_std_error: errors.rise.value,
            rise_abs_std_error_time: errors.rise.time,
            decay_ratio: ratio,
            variance_ratio: reduced.variance_ratio(),
            spectrum_ratio_at_zero: reduced.spectrum_ratio(),
            keeps: properties(true),
            gives_up: properties(false),
            monte_carlo: JsonSamples {
                eta_std: last(eta),
                chi_std: last(chi),
                max_abs_mean_error: largest(&eta.mean, &chi.mean),
                max_abs_std_error: largest(&eta.std, &chi.std),
                eta_std_coverage: subject.coverage(eta, |time| reduced.eta_variance_at(time)),
                chi_std_coverage: subject.coverage(chi, |time| reduced.chi_variance_at(time)),
            },
        }
    }
}

/// How a method chooses a and b.
fn choice(method: Reduction) -> &'static str {
    match method {
        Reduction::Printed => "a = zeta omega, b = zeta sigma/omega (23)",
        Reduction::Variance => "a = zeta omega, b = sigma/(sqrt(2) omega)",
        Reduction::Moment => "a = omega/(2 zeta), b = sigma/(2 zeta omega)",
    }
}

/// What a reduction keeps of its mode, and what it gives up.
pub(crate) fn bargain(comparisons: &[Comparison]) -> String {
    let name = |property| match property {
        Property::DecayRate => "decay rate",
        Property::Variance => "variance",
        Property::SpectrumAtZero => "spectrum at zero frequency",
    };
    let list = |parts: Vec<String>| match parts.as_slice() {
        [] => "none of the three".to_owned(),
        [parts @ .., last] if !parts.is_empty() => format!("{} and {last}", parts.join(", ")),
        parts => parts.concat(),
    };
    let kept = comparisons.iter().filter(|it| it.kept);
    let lost = comparisons.iter().filter(|it| !it.kept);
    let lost = lost.map(|it| {
        format!(
            "{} ({} of the mode's)",
            name(it.property),
            fixed(it.ratio, 4)
        )
    });
    format!(
        "keeps {}; gives up {}",
        list(kept.map(|it| name(it.property).to_owned()).collect()),
        list(lost.collect())
    )
}

/// Where the standard deviations differ most.
pub(crate) fn greatest(errors: &StdErrors) -> String {
    let peak = |peak: &Peak| {
        let when = peak.time.map_or_else(
            || "in the long run".to_owned(),
            |time| format!("at {} s", fixed(time, 4)),
        );
        let leader = if peak.chi_leads { "chi" } else { "eta" };
        format!(
            "by {} at most, {when}, where {leader} has the larger",
            fixed(peak.value, 6)
        )
    };
    let StdErrors {
        greatest: whole,
        rise,
    } = errors;
    if errors.greatest_in_rise() {
        format!("they differ {}, in the rise from rest", peak(whole))
    } else {
        format!(
            "they differ {}; in the rise from rest {}",
            peak(whole),
            peak(rise)
        )
    }
}

fn text(method: Reduction, experiment: &Experiment, subjects: &[Subject]) -> String {
    let mut text = format!("{}: {}\n", method.name(), choice(method));
    for (index, subject) in subjects.iter().enumerate() {
        let mode = JsonMode::new(subject);
        let sample = |estimate: &Estimate| {
            let ends = [estimate.value, estimate.low, estimate.high];
            let [value, low, high] = ends.map(|end| fixed(end, 6));
            format!("{value} [{low}, {high}]")
        };
        // Writing into a String cannot fail.
        let _ = write!(
            text,
            "mode {}: omega {} rad/s, zeta {}, sigma {}, slowest decay rate {} 1/s\n  \
             decay {} 1/s, intensity {}; {}\n  \
             stationary std of eta {}, of chi {}; {}\n  \
             sampled from rest, std at {} s: eta {}, chi {}\n",
            index + 1,
            Shown(mode.omega),
            Shown(mode.zeta),
            Shown(mode.sigma),
            fixed(mode.mode_decay, 6),
            fixed(mode.decay, 6),
            fixed(mode.intensity, 6),
            bargain(&subject.reduced.comparisons()),
            fixed(mode.eta_std, 6),
            fixed(mode.chi_std, 6),
            greatest(&subject.reduced.largest_std_errors()),
            Shown(experiment.steps as f64 * experiment.dt),
            sample(&mode.monte_carlo.eta_std),
            sample(&mode.monte_carlo.chi_std),
        );
    }
    let _ = write!(
        text,
        "Units: (ft*slug)^0.5. Samples: {} runs, one noise for eta and chi, seed {}, intervals of 95 %.",
        experiment.runs, experiment.seed
    );
    text
}

/// Columns of the table.
const COLUMNS: [&str; 10] = [
    "mode",
    "time [s]",
    "eta_std",
    "chi_std",
    "eta_std_sampled",
    "eta_std_low",
    "eta_std_high",
    "chi_std_sampled",
    "chi_std_low",
    "chi_std_high",
];

/// Writes the table.
fn write_table(folder: &Path, subjects: &[Subject]) -> Result<(), Failure> {
    let mut file = CsvFile::create(&folder.join("reduce.csv"))?;
    file.row(&COLUMNS)?;
    for (index, subject) in subjects.iter().enumerate() {
        let samples = subject
            .sampled(&subject.eta)
            .into_iter()
            .zip(subject.sampled(&subject.chi));
        for (&time, (eta, chi)) in subject.times.iter().zip(samples) {
            let exact = [
                subject.reduced.eta_variance_at(time),
                subject.reduced.chi_variance_at(time),
            ];
            let [eta_std, chi_std] = exact.map(f64::sqrt);
            let numbers = [
                number::time(time),
                eta_std,
                chi_std,
                eta.value,
                eta.low,
                eta.high,
                chi.value,
                chi.low,
                chi.high,
            ];
            let mode = [(index + 1).to_string()].into_iter();
            let cells = mode.chain(numbers.map(number::cell));
            file.row(&cells.collect::<Vec<_>>())?;
        }
    }
    file.finish()
}
