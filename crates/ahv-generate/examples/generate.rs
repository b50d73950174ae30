//! `ahv generate` by itself: it builds in a minute, where the whole `ahv` takes many.
//!
//! ```text
//! cargo run --release -p ahv-generate --example generate -- --check
//! ```

use clap::Parser;

#[derive(Parser)]
struct Line {
    #[command(flatten)]
    generate: ahv_generate::Args,
}

fn main() {
    let line = Line::parse();
    std::process::exit(ahv_generate::run(&line.generate).into());
}
