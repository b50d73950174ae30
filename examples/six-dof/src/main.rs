//! Every command of ahv, for a vehicle with six degrees of freedom.

fn main() -> std::process::ExitCode {
    ahv_cli::run::<six_dof_models::Models>(&[])
}
