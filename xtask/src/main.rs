//! What cargo alone cannot do for this project. Run as `cargo xtask <command>`.
#![forbid(unsafe_code)]

mod audit;
mod bench;
mod book;
mod c;
mod demo;
mod determinism;
mod examples;
mod firmware;
mod guide;
mod instructions;
mod names;
mod no_panic;
mod own_vehicle;
mod packages;
mod plot;
mod python;
mod shell;
mod steps;
mod trajectory;
mod vectors;
mod wheel;

use std::process::ExitCode;

use clap::Parser;

/// Chores of the ahv project.
#[derive(Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
enum Task {
    Generate(ahv_generate::Args),
    /// Make the Python environments for generation and for development
    Setup,
    /// Run everything that must hold before a change goes in
    Test {
        /// And what takes too long for every change: features that are off, and the audit in full
        #[arg(long)]
        all: bool,
    },
    /// Compare the generated functions with 50-digit arithmetic at many random points, and the coverage of intervals with that
    /// which docs/monte-carlo.md has, over many seeds
    Audit {
        /// Number of points for each function
        #[arg(long, default_value_t = audit::POINTS)]
        points: u32,
        /// Number of seeds for each interval
        #[arg(long, default_value_t = audit::SEEDS)]
        seeds: u32,
    },
    /// Compare the bits of every stepper between builds of all optimisation levels
    Determinism,
    /// Compile the C library with every compiler found, build and run its examples, and run the checkers of C
    C {
        /// Also the pinned clang and clang-tidy, which are large
        #[arg(long)]
        all: bool,
    },
    /// Generate models of other tables than this repository's, and run an `ahv` of their own over each
    OwnVehicle,
    /// Package the library crates as for a registry, and build each from its package
    Package,
    /// Run the commands of the pages in docs/guide, and compare what they print with what stands there
    Guide,
    /// Run the commands of crates/ahv/tests/messages.txt, and write there what they print
    Messages,
    /// Draw and compute the reference vectors of the tests again
    Vectors,
    /// List the values of the generated code whose names only say whose part they are, each with the reason
    Names,
    /// Measure the generated functions and the steppers beside CasADi's C
    Bench {
        /// Beside all peers, and write docs/benchmarks.md
        #[arg(long)]
        peers: bool,
    },
    /// Count the instructions of a call under valgrind, and hold them to bench/kernels/instructions.json
    Instructions {
        /// Write the counts there
        #[arg(long)]
        write: bool,
    },
    /// Build the documentation as pages for a browser, in target/book
    Book,
    /// Fly on a Cortex-M7 under QEMU, compare with this machine bit for bit, and print what a step costs
    Firmware {
        /// Write the table of docs/embedded.md
        #[arg(long)]
        write: bool,
    },
    /// Build the wheel of Python, install it in a clean environment, and test it there
    Wheel {
        /// As it is published; the tests take the same time, the build much longer
        #[arg(long)]
        release: bool,
    },
    /// Change a coefficient, regenerate, and fly both models with both values
    Demo,
}

fn main() -> ExitCode {
    let done = match Task::parse() {
        Task::Generate(args) => return examples::generate(&args).into(),
        Task::Setup => python::set_up(),
        Task::Test { all } => steps::run(all),
        Task::Audit { points, seeds } => audit::run(points, seeds),
        Task::Determinism => determinism::run(),
        Task::C { all } => c::run(all),
        Task::OwnVehicle => own_vehicle::run(),
        Task::Package => packages::run(true),
        Task::Guide => guide::run(),
        Task::Messages => shell::run(
            shell::cargo()
                .args(["test", "--package", "ahv", "--test", "messages", "session"])
                .env("AHV_WRITE_MESSAGES", "1"),
        ),
        Task::Vectors => vectors::run(),
        Task::Names => names::run(),
        Task::Bench { peers } => bench::run(peers),
        Task::Instructions { write } => instructions::run(write),
        Task::Book => book::run(),
        Task::Firmware { write } => firmware::run(steps::BARE_METAL, write),
        Task::Wheel { release } => wheel::run(release),
        Task::Demo => demo::run(),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            eprintln!("{problem}");
            ExitCode::FAILURE
        }
    }
}
