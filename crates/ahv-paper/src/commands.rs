//! The commands of `ahv` that are about the paper.

mod compare;
mod draw;
mod number;
mod reduce;
mod reproduce;
mod track;

use ahv_cli::ExtraCommand;

/// `compare`, `draw`, `reduce`, `reproduce` and `track`.
pub fn all() -> [ExtraCommand; 5] {
    [
        ExtraCommand::new("compare", compare::run),
        ExtraCommand::new("draw", draw::run),
        ExtraCommand::new("reduce", reduce::run),
        ExtraCommand::new("reproduce", reproduce::run),
        ExtraCommand::new("track", track::run),
    ]
}
