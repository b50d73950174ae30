//! `ahv poles`: poles with their modes, and zeros, of a model about its trim.

mod figure;

use std::path::{Path, PathBuf};

use ahv_analysis::poles::{
    Decoupling, Pole, PolesError, Zero, Zeros, damping, frequency, poles, zeros,
};
use clap::Args;
use nalgebra::Complex;
use serde::Serialize;

use crate::csv_file::CsvFile;
use crate::failure::{Failure, all, print};
use crate::flight_condition::FlightCondition;
use crate::number::{Shown, cell};
use crate::output::{self, Pairs};
use crate::vehicle::{Heading, Vehicle, VehicleArgs};

/// Poles of a model about its trim, with their modes, and zeros from inputs to outputs.
///
/// Zeros are the invariant zeros, by a staircase reduction of the system pencil. Participation factors name the modes.
#[derive(Args)]
pub(crate) struct Arguments {
    #[command(flatten)]
    pub(crate) vehicle: VehicleArgs,

    #[command(flatten)]
    condition: FlightCondition,

    /// Inputs of the zeros [default: those of the model's path]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    inputs: Vec<String>,

    /// Outputs of the zeros, states or other quantities [default: those of the model's path]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    outputs: Vec<String>,

    /// Folder for poles.csv and poles.svg
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print poles and zeros as JSON
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input or a file that cannot be written, [`Failure::Numeric`] if there is no trim or the
/// eigenvalues do not converge.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    about_trim(arguments, &arguments.vehicle.vehicle()?)
}

/// Poles and zeros with where they belong to.
struct Roots<'a> {
    vehicle: &'a Vehicle,
    place: String,
    state: Vec<f64>,
    input: Vec<f64>,
    inputs: Vec<&'static str>,
    outputs: Vec<&'static str>,
    poles: Vec<Pole>,
    zeros: Zeros,
    /// Inputs that no derivative of a state depends on.
    idle: Vec<&'static str>,
}

#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    place: &'a str,
    state: Pairs<f64>,
    input: Pairs<f64>,
    output_values: Pairs<f64>,
    units: Pairs<&'static str>,
    poles: Vec<[f64; 2]>,
    zeros: Vec<[f64; 2]>,
    modes: Vec<JsonMode>,
    zero_details: Vec<JsonZero>,
    zeros_at_infinity: usize,
    normal_rank: usize,
    infinite_zero_orders: &'a [usize],
    zero_count: String,
    inputs: &'a [&'static str],
    outputs: &'a [&'static str],
}

#[derive(Serialize)]
struct JsonMode {
    pole: [f64; 2],
    name: Option<String>,
    damping: f64,
    frequency: f64,
    participation: f64,
}

#[derive(Serialize)]
struct JsonZero {
    zero: [f64; 2],
    damping: f64,
    frequency: f64,
    decoupling: Option<&'static str>,
}

fn about_trim(arguments: &Arguments, vehicle: &Vehicle) -> Result<(), Failure> {
    let flight = arguments.condition.flight(vehicle)?;
    let folder = arguments.out.as_deref();
    if let Some(folder) = folder {
        output::folder(folder)?;
    }
    let trim = vehicle.trim(&flight)?;
    let system = vehicle.linear(
        (&trim.state, &trim.input),
        &arguments.inputs,
        &arguments.outputs,
    )?;
    let failed = |error: PolesError| Failure::Numeric(format!("{}: {error}", vehicle.name()));
    let columns = system.inputs.iter().zip(system.b.column_iter());
    let idle = columns.filter(|(_, column)| column.iter().all(|&entry| entry == 0.0));
    let roots = Roots {
        idle: idle.map(|(&input, _)| input).collect(),
        vehicle,
        place: vehicle.at(&flight),
        state: trim.state,
        input: trim.input,
        poles: poles(&system, vehicle.model.modes()).map_err(failed)?,
        zeros: zeros(&system).map_err(failed)?,
        inputs: system.inputs,
        outputs: system.outputs,
    };
    // Whatever fails, the rest is reported; the picture comes last.
    let written = folder.map_or(Ok(()), |folder| roots.csv(&folder.join("poles.csv")));
    let printed = match arguments.json {
        true => output::print_json(&roots.json()),
        false => print(&roots.text()),
    };
    let drawn = folder.map_or(Ok(()), |folder| {
        output::picture(&folder.join("poles.svg"), figure::figure(&roots).svg())
    });
    all([written, printed, drawn])
}

fn pair(root: Complex<f64>) -> [f64; 2] {
    [root.re, root.im]
}

fn name(pole: &Pole) -> Option<String> {
    pole.mode.map(str::to_owned)
}

fn decoupling(zero: &Zero) -> Option<&'static str> {
    zero.decoupling.map(|it| match it {
        Decoupling::Input => "input",
        Decoupling::Output => "output",
    })
}

impl Roots<'_> {
    /// How many finite zeros there are, and why.
    fn count(&self) -> String {
        let Zeros {
            finite,
            normal_rank,
            infinite_orders,
            right_indices,
            left_indices,
        } = &self.zeros;
        let (inputs, outputs) = (self.inputs.len(), self.outputs.len());
        let rank = match *normal_rank < inputs.min(outputs) {
            true if !self.idle.is_empty() => String::new(),
            true => format!(
                "the transfer matrix has rank {normal_rank} only: its {inputs} inputs cannot move its {outputs} outputs \
                 apart from each other\n"
            ),
            false => String::new(),
        };
        let idle = self.idle.iter().map(|&input| {
            let why = self.vehicle.idle(input);
            let why = why.unwrap_or_else(|| format!("{input} has no effect here"));
            format!("{why}: no derivative of a state depends on it\n")
        });
        let rank = idle.collect::<String>() + &rank;
        let list = |numbers: &[usize]| {
            let texts: Vec<String> = numbers.iter().map(usize::to_string).collect();
            texts.join(", ")
        };
        let mut why = format!("{} states", self.vehicle.states.len());
        for (what, numbers) in [
            ("orders of the infinite zeros", infinite_orders),
            ("Kronecker indices of the inputs", right_indices),
            ("Kronecker indices of the outputs", left_indices),
        ] {
            if numbers.iter().any(|&number| number > 0) {
                why += &format!(" less the {what} ({})", list(numbers));
            }
        }
        let cancelled = finite.iter().filter(|it| it.decoupling.is_some());
        let cancelled = match cancelled.count() {
            0 => String::new(),
            1 if finite.len() == 1 => {
                "; it is a pole that inputs or outputs miss, and cancels".to_owned()
            }
            1 => "; 1 of them is a pole that inputs or outputs miss, and cancels".to_owned(),
            count => format!("; {count} of them are poles that inputs or outputs miss, and cancel"),
        };
        let zeros = match finite.len() {
            1 => "zero",
            _ => "zeros",
        };
        format!("{rank}{} finite {zeros}: {why}{cancelled}", finite.len())
    }

    fn json(&self) -> Json<'_> {
        let modes = self.poles.iter().map(|pole| JsonMode {
            pole: pair(pole.value),
            name: name(pole),
            damping: damping(pole.value),
            frequency: frequency(pole.value),
            participation: pole.participation,
        });
        let zeros = self.zeros.finite.iter().map(|zero| JsonZero {
            zero: pair(zero.value),
            damping: damping(zero.value),
            frequency: frequency(zero.value),
            decoupling: decoupling(zero),
        });
        let point = self.vehicle.point(&self.state, &self.input);
        Json {
            heading: self.vehicle.heading(),
            place: &self.place,
            state: point.state,
            input: point.input,
            output_values: point.outputs,
            units: point.units,
            poles: self.poles.iter().map(|it| pair(it.value)).collect(),
            zeros: self.zeros.finite.iter().map(|it| pair(it.value)).collect(),
            modes: modes.collect(),
            zero_details: zeros.collect(),
            zeros_at_infinity: self.zeros.infinite(),
            normal_rank: self.zeros.normal_rank,
            infinite_zero_orders: &self.zeros.infinite_orders,
            zero_count: self.count(),
            inputs: &self.inputs,
            outputs: &self.outputs,
        }
    }

    fn text(&self) -> String {
        let line = |root: Complex<f64>, name: String| {
            let [re, im] = pair(root);
            format!(
                "  {:>12.6} {:>+12.6}i {:>9.4} {:>11.4}  {name}",
                Shown(re),
                Shown(im),
                Shown(damping(root)),
                Shown(frequency(root))
            )
        };
        let poles = self.poles.iter().map(|pole| {
            let name = name(pole).unwrap_or_default();
            line(
                pole.value,
                format!("{name} ({:.0} %)", Shown(100.0 * pole.participation)),
            )
        });
        let zeros = self.zeros.finite.iter().map(|zero| {
            let name = decoupling(zero).map(|it| format!("{it} decoupling"));
            "\n".to_owned() + &line(zero.value, name.unwrap_or_default())
        });
        let head = format!(
            "{:>14} {:>13} {:>9} {:>11}",
            "real [1/s]", "imaginary", "damping", "[rad/s]"
        );
        format!(
            "{}: {}\n{}\npoles\n{head}  mode (participation)\n{}\nzeros from {} to {}\n{head}{}\n{}",
            self.vehicle.name(),
            self.place,
            self.vehicle.described(),
            poles.collect::<Vec<_>>().join("\n"),
            self.inputs.join(", "),
            self.outputs.join(", "),
            zeros.collect::<String>(),
            self.count()
        )
    }

    fn csv(&self, path: &Path) -> Result<(), Failure> {
        let mut file = CsvFile::create(path)?;
        let header = [
            "kind",
            "real [1/s]",
            "imaginary [1/s]",
            "damping [1]",
            "frequency [rad/s]",
            "mode",
        ];
        file.row(&header)?;
        let poles = self.poles.iter().map(|it| ("pole", it.value, name(it)));
        let zeros = self.zeros.finite.iter().map(|it| {
            let name = decoupling(it).map(|name| format!("{name} decoupling"));
            ("zero", it.value, name)
        });
        for (kind, root, name) in poles.chain(zeros) {
            let numbers = [root.re, root.im, damping(root), frequency(root)];
            let mut row = vec![kind.to_owned()];
            row.extend(numbers.map(cell));
            row.push(name.unwrap_or_default());
            file.row(&row)?;
        }
        file.finish()
    }
}
