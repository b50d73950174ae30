//! An `ahv` over a table of two flexible modes: `dcom` and `sdcom`.

fn main() -> std::process::ExitCode {
    ahv_cli::run::<own_models::Models>(&[])
}
