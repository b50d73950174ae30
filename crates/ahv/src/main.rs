//! The command `ahv`: what is done with any model, over the models of this repository, and what is about the paper.
#![forbid(unsafe_code)]

use std::process::ExitCode;

use ahv_core::{ModelList, ModelVisitor};

/// The generated models, and the one from first principles.
struct Models;

impl ModelList for Models {
    fn visit(visitor: &mut impl ModelVisitor) {
        ahv_models::Models::visit(visitor);
        visitor.visit::<ahv_fpm::Model<f64>>();
    }
}

fn main() -> ExitCode {
    #[cfg(feature = "generate")]
    ahv_cli::fit::offer(ahv_fpm::SOURCE);
    ahv_cli::run::<Models>(&ahv_paper::commands::all())
}
