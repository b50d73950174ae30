//! `ahv generate`: the command line and the act itself are those of `ahv-generate`.

use std::process::ExitCode;

pub(crate) use ahv_generate::Args as Arguments;

/// Runs the command, which says for itself what it did or why it failed.
pub(crate) fn run(arguments: &Arguments) -> ExitCode {
    ahv_generate::run(arguments).into()
}
