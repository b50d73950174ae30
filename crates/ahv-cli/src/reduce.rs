//! Reductions of a model's linear system, for `ahv reduce --method balanced` and `krylov`.

use std::fmt::Write as _;

use ahv_analysis::reduction::{
    H_INFINITY_RESOLUTION, H2_RESOLUTION, Part, Reduced, ReductionError, ReductionMethod,
};
use clap::Args;
use nalgebra::DMatrix;
use serde::Serialize;

use crate::failure::{Failure, print};
use crate::flight_condition::{FlightCondition, Point};
use crate::names;
use crate::number::Shown;
use crate::output;
use crate::vehicle::{Heading, Vehicle, VehicleArgs};

/// Which system is reduced, and to how many states.
#[derive(Args)]
struct Flags {
    #[command(flatten)]
    vehicle: VehicleArgs,

    #[command(flatten)]
    condition: FlightCondition,

    /// With balanced and krylov: number of states that remain of the part whose poles decay
    #[arg(long, value_name = "N")]
    order: Option<usize>,

    /// With balanced and krylov: states of the system; all others stay at the trim [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    states: Vec<String>,

    /// With balanced and krylov: inputs or Wiener processes [default: the model's default inputs]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    inputs: Vec<String>,

    /// With balanced and krylov: states or other outputs [default: the model's default outputs]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    outputs: Vec<String>,
}

/// Flags of a reduction of a model. Without `--model`, there is nothing to reduce here.
pub struct Arguments(Flags);

impl clap::FromArgMatches for Arguments {
    fn from_arg_matches(matches: &clap::ArgMatches) -> Result<Self, clap::Error> {
        Flags::from_arg_matches(matches).map(Self)
    }

    fn update_from_arg_matches(&mut self, matches: &clap::ArgMatches) -> Result<(), clap::Error> {
        self.0.update_from_arg_matches(matches)
    }
}

impl Args for Arguments {
    fn augment_args(command: clap::Command) -> clap::Command {
        let command = Flags::augment_args(command);
        command.mut_arg("model", |model| {
            let methods = ReductionMethod::ALL.map(|it| ("method", it.name()));
            model
                .required(false)
                .required_if_eq_any(methods)
                .help("With balanced and krylov: model whose linear system is reduced")
        })
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        Self::augment_args(command)
    }
}

impl Arguments {
    /// Refuses flags that `method`, which reduces modes, has no use for.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] with the flag.
    pub fn refuse(&self, method: &str) -> Result<(), Failure> {
        let Self(flags) = self;
        let given = [
            ("--order", flags.order.is_some()),
            ("--states", !flags.states.is_empty()),
            ("--inputs", !flags.inputs.is_empty()),
            ("--outputs", !flags.outputs.is_empty()),
        ];
        let given = given
            .into_iter()
            .find_map(|(flag, given)| given.then_some(flag));
        let given = given.or_else(|| flags.vehicle.is_given().then_some("--model"));
        match given {
            Some(flag) => {
                let methods = ReductionMethod::ALL.map(ReductionMethod::name);
                Err(Failure::Request(format!(
                    "{flag}: {method} reduces the modes of --omega, --zeta and --sigma; --method {} takes it",
                    methods.join(" or ")
                )))
            }
            None => Ok(()),
        }
    }

    /// Reduces the linear system about the trim that is asked for, and prints the outcome.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for names and orders without sense, [`Failure::Numeric`] if there is no trim or no reduction.
    pub fn run(&self, method: ReductionMethod, json: bool) -> Result<(), Failure> {
        let Self(flags) = self;
        let order = flags.order.ok_or_else(|| {
            Failure::Request(format!(
                "--order: {} needs the number of states",
                method.name()
            ))
        })?;
        let vehicle = flags.vehicle.vehicle()?;
        let (_, point) = flags.condition.point(&vehicle, &[])?;
        let system = System::new(&vehicle, &point, flags)?;
        let reduced = Reduced::new(&system.part, method, order).map_err(|error| match error {
            ReductionError::Order { .. } | ReductionError::Rank { .. } => {
                Failure::Request(format!("--order: {error}"))
            }
            other => Failure::Numeric(format!("{}: {other}", vehicle.name())),
        })?;
        match json {
            true => output::print_json(&Json::new(&vehicle, &system, method, &reduced)),
            false => print(&text(&vehicle, &system, method, &reduced)),
        }
    }
}

/// The linear system with its names.
struct System {
    part: Part,
    states: Vec<&'static str>,
    inputs: Vec<String>,
    outputs: Vec<String>,
}

impl System {
    fn new(vehicle: &Vehicle, point: &Point, flags: &Flags) -> Result<Self, Failure> {
        let noise = vehicle.model.increments().names;
        let (channels, deflections): (Vec<String>, Vec<String>) = flags
            .inputs
            .iter()
            .cloned()
            .partition(|it| noise.contains(&it.as_str()));
        let known = [vehicle.inputs.names, noise].concat();
        if let Some(name) = flags.inputs.iter().find(|it| !known.contains(&it.as_str())) {
            let problem = names::unknown("input or Wiener process", name, &known);
            return Err(Failure::Request(format!("--inputs: {problem}")));
        }
        for (option, given) in [("--inputs", &flags.inputs), ("--states", &flags.states)] {
            if let Some(name) = names::twice(given) {
                return Err(Failure::Request(format!("{option}: {name} is given twice")));
            }
        }
        let linear = vehicle.linear((&point.0, &point.1), &deflections, &flags.outputs)?;
        let states = chosen(&linear.states, &flags.states)?;
        let diffusion = || {
            vehicle
                .model
                .diffusion(&vehicle.parameters, &point.0, &point.1)
        };
        let column_of = |name: &String| noise.iter().position(|it| it == name);
        let columns: Vec<_> = channels.iter().filter_map(column_of).collect();
        let (deflections, b) = match (deflections.is_empty(), channels.is_empty()) {
            // Wiener processes alone are asked for.
            (true, false) => (Vec::new(), diffusion().select_columns(&columns)),
            (_, true) => (linear.inputs.clone(), linear.b.clone()),
            (false, false) => {
                let noise = diffusion().select_columns(&columns);
                let both = linear.b.column_iter().chain(noise.column_iter());
                let both: Vec<_> = both.collect();
                (linear.inputs.clone(), DMatrix::from_columns(&both))
            }
        };
        let deflections = deflections.into_iter().map(str::to_owned);
        Ok(Self {
            part: Part {
                a: linear.a.select_rows(&states).select_columns(&states),
                b: b.select_rows(&states),
                c: linear.c.select_columns(&states),
            },
            states: states.iter().map(|&it| linear.states[it]).collect(),
            inputs: deflections.chain(channels).collect(),
            outputs: linear.outputs.iter().map(ToString::to_string).collect(),
        })
    }
}

/// The indices of the states that are asked for.
fn chosen(known: &[&'static str], asked: &[String]) -> Result<Vec<usize>, Failure> {
    if asked.is_empty() {
        return Ok((0..known.len()).collect());
    }
    let index = |name: &String| {
        let found = known.iter().position(|it| it == name);
        found.ok_or_else(|| {
            let problem = names::unknown("state", name, known);
            Failure::Request(format!("--states: {problem}"))
        })
    };
    asked.iter().map(index).collect()
}

/// What an exact step of a linear system with noise costs: multiplications of the full transition and of the triangular root
/// of its covariance, and normal numbers.
#[derive(Serialize)]
struct Cost {
    multiplications: usize,
    normals: usize,
}

impl Cost {
    const fn of(states: usize) -> Self {
        Self {
            multiplications: states * states + states * (states + 1) / 2,
            normals: states,
        }
    }
}

#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    method: &'static str,
    states: &'a [&'static str],
    inputs: &'a [String],
    outputs: &'a [String],
    order: usize,
    kept_exactly: usize,
    stable: usize,
    hankel_singular_values: &'a [f64],
    /// `null` where rounding hides it.
    h_infinity_error: Option<f64>,
    h_infinity: f64,
    /// Of balanced truncation alone.
    h_infinity_bound: Option<f64>,
    /// `null` where rounding hides it.
    h2_error: Option<f64>,
    h2: f64,
    step_before: Cost,
    step_after: Cost,
    #[serde(rename = "A")]
    a: Vec<Vec<f64>>,
    #[serde(rename = "B")]
    b: Vec<Vec<f64>>,
    #[serde(rename = "C")]
    c: Vec<Vec<f64>>,
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    let rows = matrix.row_iter();
    rows.map(|row| row.iter().copied().collect()).collect()
}

fn bound(method: ReductionMethod, reduced: &Reduced) -> Option<f64> {
    (method == ReductionMethod::Balanced).then(|| reduced.bound())
}

impl<'a> Json<'a> {
    fn new(
        vehicle: &'a Vehicle,
        system: &'a System,
        method: ReductionMethod,
        reduced: &'a Reduced,
    ) -> Self {
        let kept = reduced.kept.order();
        Self {
            heading: vehicle.heading(),
            method: method.name(),
            states: &system.states,
            inputs: &system.inputs,
            outputs: &system.outputs,
            order: reduced.reduced.order(),
            kept_exactly: kept,
            stable: reduced.stable.order(),
            hankel_singular_values: &reduced.hankel,
            h_infinity_error: reduced.h_infinity_error,
            h_infinity: reduced.h_infinity,
            h_infinity_bound: bound(method, reduced),
            h2_error: reduced.h2_error,
            h2: reduced.h2,
            step_before: Cost::of(kept + reduced.stable.order()),
            step_after: Cost::of(kept + reduced.reduced.order()),
            a: rows(&reduced.reduced.a),
            b: rows(&reduced.reduced.b),
            c: rows(&reduced.reduced.c),
        }
    }
}

fn text(vehicle: &Vehicle, system: &System, method: ReductionMethod, reduced: &Reduced) -> String {
    let number = |value: f64| format!("{:.6e}", Shown(value));
    let (kept, before, after) = (
        reduced.kept.order(),
        reduced.stable.order(),
        reduced.reduced.order(),
    );
    let mut text = format!(
        "{}: {} reduction, {}\nfrom {} to {}\nstates: {}\n",
        vehicle.name(),
        method.name(),
        vehicle.described(),
        system.inputs.join(", "),
        system.outputs.join(", "),
        system.states.join(", ")
    );
    let hankel: Vec<String> = reduced.hankel.iter().map(|&it| number(it)).collect();
    let error = |error: Option<f64>, whole: f64, resolution: f64| match error {
        Some(error) => {
            let share = Shown(100.0 * error / whole);
            format!("{} ({share:.4} % of that of the part)", number(error))
        }
        None => {
            format!("less than {resolution:e} of that of the part, where rounding hides it")
        }
    };
    // Writing into a String cannot fail.
    let _ = write!(
        text,
        "{before} states decay and become {after}; {kept} do not decay and are kept exactly\n\
         Hankel singular values: {}\n\
         H-infinity error {}",
        hankel.join(", "),
        error(
            reduced.h_infinity_error,
            reduced.h_infinity,
            H_INFINITY_RESOLUTION
        ),
    );
    if let Some(bound) = bound(method, reduced) {
        let _ = write!(text, ", at most {} by the singular values", number(bound));
    }
    let [full, small] = [before, after].map(|it| Cost::of(it + kept));
    let _ = write!(
        text,
        "\nH2 error {}\n\
         an exact step of a member: {} multiplications and {} normal numbers become {} and {}",
        error(reduced.h2_error, reduced.h2, H2_RESOLUTION),
        full.multiplications,
        full.normals,
        small.multiplications,
        small.normals
    );
    text
}
