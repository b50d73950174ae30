//! An `ahv` over the decoupled model alone.

fn main() -> std::process::ExitCode {
    ahv_cli::run::<dcom_alone::Models>(&[])
}
