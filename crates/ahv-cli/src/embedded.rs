//! The commands inside a host program, such as a binding to another language: what they say is a value, and nothing of it ends
//! the process.

use std::ffi::OsString;
use std::iter;

use ahv_analysis::erased::AnyModel;
use ahv_core::ModelList;
use clap::{Args, FromArgMatches};

use crate::failure::{Failure, heard};
use crate::registry;
use crate::vehicle::{Vehicle, VehicleArgs};
use crate::{Asked, Command, ExtraCommand, asked};

#[cfg(feature = "parquet")]
pub use crate::monte_carlo::campaign::Lock as CampaignLock;
pub use crate::signals::stop;

/// How clap begins what is wrong.
const ERROR: &str = "error: ";
/// What clap adds to it for a person at a terminal.
const USAGE: &str = "\n\nUsage";

/// What a command said, and how it ended.
#[derive(Debug)]
pub struct Told {
    /// What it would have printed on stdout.
    pub text: String,
    /// Its notes and warnings.
    pub notes: Vec<String>,
    /// How it ended.
    pub end: Result<(), Failure>,
}

/// Makes the models of `L` those that this program knows; the first call of a process decides.
pub fn register<L: ModelList>() {
    registry::register::<L>();
}

/// The models that this program knows.
pub fn models() -> impl Iterator<Item = &'static dyn AnyModel> {
    registry::models()
}

/// Runs a command of the models by the words of its line, without the program's name.
///
/// `completions`, `diff`, `generate`, `man`, `new` and `table` run only on a command line: here they are a request that fails.
pub fn tell(words: Vec<String>, extra: &[ExtraCommand]) -> Told {
    let (asked, quiet) = match asked(line(words), extra) {
        Ok((asked, console)) => (Ok(asked), console.quiet),
        Err(wrong) => (Err(refusal(&wrong)), false),
    };
    let (end, said) = heard(|| match asked? {
        Asked::General(Command::Model(command)) => command.run(),
        Asked::Extra(extra, matches) => (extra.run)(&matches),
        Asked::General(_) => Err(Failure::Request(
            "completions, diff, generate, man, new and table run only on a command line".to_owned(),
        )),
    });
    let notes = if quiet { Vec::new() } else { said.notes };
    Told {
        text: said.text,
        notes,
        end,
    }
}

/// The vehicle that the flags `--model`, `--table`, `--set`, `--units` and those of the choices ask for, and notes on it.
///
/// # Errors
///
/// [`Failure::Request`] as on a command line.
pub fn vehicle(words: Vec<String>) -> Result<(Vehicle, Vec<String>), Failure> {
    let parser = VehicleArgs::augment_args(clap::Command::new("vehicle"));
    let (vehicle, said) = heard(|| {
        let read = parser.try_get_matches_from(line(words));
        let read = read.and_then(|matches| VehicleArgs::from_arg_matches(&matches));
        read.map_err(|wrong| refusal(&wrong))?.vehicle()
    });
    Ok((vehicle?, said.notes))
}

fn line(words: Vec<String>) -> impl Iterator<Item = OsString> {
    iter::once("ahv".into()).chain(words.into_iter().map(OsString::from))
}

/// What is wrong with a line, without what is for a terminal.
fn refusal(wrong: &clap::Error) -> Failure {
    let text = wrong.render().to_string();
    let text = text.strip_prefix(ERROR).unwrap_or(&text);
    let text = text.split_once(USAGE).map_or(text, |(text, _)| text);
    Failure::Request(text.trim_end().to_owned())
}
