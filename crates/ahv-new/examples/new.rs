//! `ahv new` by itself: it builds without the models.

use clap::Parser;

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    new: ahv_new::Args,
}

fn main() -> std::process::ExitCode {
    ahv_new::run(&Line::parse().new).into()
}
