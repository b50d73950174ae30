//! An `ahv` over a family that does not fly.

fn main() -> std::process::ExitCode {
    ahv_cli::run::<tank_models::Models>(&[])
}
