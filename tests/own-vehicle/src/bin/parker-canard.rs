//! An `ahv` over a vehicle with a canard, whose family uses parts of a built-in one.

fn main() -> std::process::ExitCode {
    ahv_cli::run::<parker_canard_models::Models>(&[])
}
