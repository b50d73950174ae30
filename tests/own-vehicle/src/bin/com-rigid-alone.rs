//! An `ahv` over the rigid COM alone.

fn main() -> std::process::ExitCode {
    ahv_cli::run::<com_rigid_alone::Models>(&[])
}
