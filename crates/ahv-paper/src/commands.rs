//! The commands of `ahv` that are about the paper.

mod number;
mod reduce;
mod reproduce;
mod track;

use ahv_cli::ExtraCommand;

/// `reduce`, `reproduce` and `track`.
pub fn all() -> [ExtraCommand; 3] {
    [
        ExtraCommand::new("reduce", reduce::run),
        ExtraCommand::new("reproduce", reproduce::run),
        ExtraCommand::new("track", track::run),
    ]
}
