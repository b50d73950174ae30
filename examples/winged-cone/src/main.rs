//! Every command of ahv, for the winged cone.

fn main() -> std::process::ExitCode {
    ahv_cli::run::<winged_cone_models::Models>(&[])
}
