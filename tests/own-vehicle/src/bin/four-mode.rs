//! An `ahv` over a table of four flexible modes: `dcom` alone.

fn main() -> std::process::ExitCode {
    ahv_cli::run::<four_mode_models::Models>(&[])
}
