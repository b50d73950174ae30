//! An `ahv` over the winged cone, in calm air and in turbulence.

fn main() -> std::process::ExitCode {
    ahv_cli::run::<gusty_cone_models::Models>(&[])
}
