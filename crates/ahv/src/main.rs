//! The command `ahv`: what is done with any model, over the models of this repository, and what is about the paper.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ahv_cli::run::<ahv_models::Models>(&ahv_paper::commands::all())
}
