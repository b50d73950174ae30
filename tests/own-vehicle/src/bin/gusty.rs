//! An `ahv` over the examples, in calm air and in gusts.

fn main() -> std::process::ExitCode {
    ahv_cli::run::<gusty_models::Models>(&[])
}
