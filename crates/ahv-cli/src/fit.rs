//! `ahv fit`: coefficients of a table from samples.

mod drawn;
mod outcome;
mod parquet;
mod plan;
mod report;
mod samples;
mod written;

use std::path::PathBuf;

use ahv_table::Text;
use clap::{ArgGroup, Args};

use crate::failure::{Failure, complain, print};
use crate::{names, output, tables};

use drawn::Draw;
pub use drawn::offer;
use outcome::Asked;
use plan::Plan;
use report::Report;

/// Fits the coefficients of a table to samples, by least squares.
///
/// Samples are a file with a column for each variable and each quantity, e.g. `alpha [deg]`, `delta_e [deg]`, `C_L`; or they are drawn
/// from a model by --from. The structure is a table: its monomials are fitted, the rest of it stays. Prints for each quantity R²,
/// residuals, cross-validation, condition, and coefficients with their errors. docs/fit.md says what they are.
#[derive(Args)]
#[command(group(ArgGroup::new("origin").required(true).args(["data", "from"])))]
pub(crate) struct Arguments {
    /// Samples: CSV, or Parquet where the name ends so
    #[arg(long, value_name = "FILE")]
    data: Option<PathBuf>,

    /// Draw the samples from this model, over a Latin hypercube
    #[arg(long, value_name = "MODEL")]
    from: Option<String>,

    /// The table whose monomials are fitted
    #[arg(long, value_name = "TABLE")]
    structure: PathBuf,

    /// Write the fitted table to this file
    #[arg(long, value_name = "TABLE")]
    out: Option<PathBuf>,

    /// Draw the residuals to this SVG file
    #[arg(long, value_name = "FILE")]
    picture: Option<PathBuf>,

    /// Column of the weights of the squares
    #[arg(long, value_name = "COLUMN", conflicts_with = "from")]
    weight: Option<String>,

    /// What a coefficient must obey: C_L.alpha=4.6, C_D.alpha^2>=0, C_L.delta_c=0.6*C_L.delta_e; numbers in the unit of the table
    #[arg(long, value_name = "CONSTRAINT")]
    constrain: Vec<String>,

    /// Folds of the cross-validation
    #[arg(long, value_name = "COUNT", default_value_t = ahv_fit::FOLDS)]
    folds: usize,

    /// Propose monomials that are worth adding or dropping, and what each buys
    #[arg(long)]
    search: bool,

    /// Take what the search proposes
    #[arg(long, requires = "search")]
    adopt: bool,

    /// Highest degree of a monomial that is searched
    #[arg(long, value_name = "DEGREE", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=9), requires = "search")]
    degree: u32,

    /// Samples to draw
    #[arg(
        long,
        value_name = "COUNT",
        default_value_t = 20_000,
        conflicts_with = "data"
    )]
    samples: usize,

    /// Seed of the drawn samples
    #[arg(
        long,
        value_name = "SEED",
        default_value_t = 1,
        conflicts_with = "data"
    )]
    seed: u64,

    /// An interval that is drawn from, in the place of the model's: alpha=-1deg:5deg, velocity=7500:8000
    #[arg(long = "box", value_name = "NAME=MIN:MAX", conflicts_with = "data")]
    intervals: Vec<String>,

    /// Print the fit as JSON, with covariances
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for bad input and files that cannot be written; [`Failure::Numeric`] if a drawn box has hardly any samples.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let path = &arguments.structure;
    let structure = tables::parsed(path)?;
    let family = tables::sound(&structure, path)?.family;
    let shown = names::printable(&path.display().to_string());
    let mut plan = Plan::new(&structure, family)?;
    let constraints = plan.constraints(&arguments.constrain)?;
    let columns = match (&arguments.data, &arguments.from) {
        (Some(data), _) => {
            samples::read(data, &plan, arguments.weight.as_deref(), arguments.search)?
        }
        (None, from) => Draw {
            from: from.as_deref().unwrap_or_default(),
            samples: arguments.samples,
            seed: arguments.seed,
            intervals: &arguments.intervals,
        }
        .columns(&plan, &structure)?,
    };
    let asked = Asked {
        folds: arguments.folds,
        constraints,
        degree: arguments.search.then_some(arguments.degree),
        adopt: arguments.adopt,
    };
    let fitted = outcome::fit(&mut plan, &columns, &asked)?;
    let intervals = written::intervals(&structure, &plan, &columns);
    let report = Report::new(&shown, &plan, &columns, &fitted, intervals);
    let made = arguments.out.as_ref().map(|out| {
        let text = written::table(&structure, out, &plan, &columns, &fitted)?;
        Ok::<_, Failure>((out, text))
    });
    let made = made.transpose()?;
    if let Some((_, text)) = &made {
        warn_of_faults(text, path)?;
    }
    // A file that cannot be written is a bad request: then nothing is printed.
    made.map_or(Ok(()), |(out, text)| output::write(out, text))?;
    let drawn = arguments.picture.as_ref();
    drawn.map_or(Ok(()), |path| output::picture(path, report.figure()))?;
    match arguments.json {
        true => output::print_json(&report),
        false => print(&report.text()),
    }
}

/// Says what the models of this program find wrong with a fitted table: a monomial that they do not have, a sign.
fn warn_of_faults(text: &str, path: &std::path::Path) -> Result<(), Failure> {
    let table =
        Text::parse(text.to_owned()).map_err(|error| Failure::Numeric(error.to_string()))?;
    if let Err(Failure::Request(why) | Failure::Numeric(why)) = tables::sound(&table, path) {
        complain(&format!("warning: of the fitted table: {why}"));
    }
    Ok(())
}
