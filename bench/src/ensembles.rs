//! The ensembles in C++.
#![allow(
    unsafe_code,
    reason = "C++ is built while the benchmark runs, so it is loaded and called by address"
)]

use std::ffi::c_int;

use libloading::Library;

use crate::interval::problem as interval;
use crate::kernel;
use crate::modes::problem as modes;
use crate::monte_carlo::problem as monte_carlo;
use crate::setting::Setting;

type MonteCarlo = unsafe extern "C" fn(
    *const f64,
    *const f64,
    *const f64,
    f64,
    c_int,
    c_int,
    c_int,
    u64,
    *mut f64,
);
type ClosedLoop = unsafe extern "C" fn(
    *const f64,
    *const f64,
    *const f64,
    *const f64,
    f64,
    f64,
    f64,
    c_int,
    c_int,
    c_int,
    c_int,
    u64,
    *mut f64,
);
type Modes = unsafe extern "C" fn(*const f64, f64, c_int, c_int, c_int, u64, *mut f64);

/// peers/ensembles.cpp with CasADi's step.
#[derive(Clone, Copy)]
pub(crate) struct Ensembles {
    monte_carlo: MonteCarlo,
    closed_loop: ClosedLoop,
    modes: Modes,
    /// Seconds that the compiler took.
    pub(crate) compiled: f64,
}

/// How it was built, for people.
pub(crate) const GXX: &str =
    "g++ -O3 -march=native, `std::normal_distribution`, `std::mt19937_64`, `std::thread`";

impl Ensembles {
    /// Compiles and loads it.
    pub(crate) fn build(setting: &Setting) -> Result<Self, String> {
        let folder = setting.out.join("casadi");
        let built = setting.cpp(&folder, "ensembles", &setting.peer_file("ensembles.cpp"))?;
        let library: &'static Library = kernel::load(&built.library)?;
        let lacking = |error| format!("error: ensembles.cpp: {error}");
        // SAFETY: the source declares these symbols with these types.
        let (monte_carlo, closed_loop, modes) = unsafe {
            (
                *library.get::<MonteCarlo>("monte_carlo").map_err(lacking)?,
                *library.get::<ClosedLoop>("closed_loop").map_err(lacking)?,
                *library.get::<Modes>("modes").map_err(lacking)?,
            )
        };
        Ok(Self {
            monte_carlo,
            closed_loop,
            modes,
            compiled: built.seconds,
        })
    }

    /// The ends of all flights.
    pub(crate) fn monte_carlo(
        &self,
        flight: &monte_carlo::Flight,
        threads: usize,
        seed: u64,
    ) -> Vec<[f64; monte_carlo::STATES]> {
        let mut ends = vec![[0.0; monte_carlo::STATES]; monte_carlo::MEMBERS];
        let parameters = flight.parameters.to_array();
        // SAFETY: the arrays have the lengths of SDCOM's vectors, and `ends` has room for as many members.
        unsafe {
            (self.monte_carlo)(
                flight.start.to_array().as_ptr(),
                flight.input.to_array().as_ptr(),
                parameters.as_ptr(),
                monte_carlo::DT,
                monte_carlo::STEPS as c_int,
                monte_carlo::MEMBERS as c_int,
                threads as c_int,
                seed,
                ends.as_mut_ptr().cast(),
            );
        }
        ends
    }

    /// The angles of attack at the end of so many flights in closed loop of steps of `dt` s, each with the noise of `parts`
    /// shorter ones, so that flights of one seed and other steps see the same noise.
    pub(crate) fn closed_loop(
        &self,
        law: &interval::Law,
        (dt, parts): (f64, usize),
        members: usize,
        seed: u64,
    ) -> Vec<[f64; 1]> {
        let mut ends = vec![[0.0]; members];
        let flight = &law.flight;
        let parameters = flight.parameters.to_array();
        // SAFETY: the arrays have the lengths of SDCOM's vectors, and `ends` has room for as many members.
        unsafe {
            (self.closed_loop)(
                flight.start.to_array().as_ptr(),
                flight.input.to_array().as_ptr(),
                parameters.as_ptr(),
                law.rows.as_ptr().cast(),
                interval::BANDWIDTH,
                interval::RATE,
                dt,
                (interval::END / dt).round() as c_int,
                parts as c_int,
                members as c_int,
                interval::THREADS as c_int,
                seed,
                ends.as_mut_ptr().cast(),
            );
        }
        ends
    }

    /// Sums of all modes.
    pub(crate) fn modes(
        &self,
        rates: &[modes::Rates; modes::MODES],
        threads: usize,
        seed: u64,
    ) -> Vec<modes::Sums> {
        let mut parts = vec![[[0.0; 4]; modes::STEPS]; threads * modes::MODES];
        // SAFETY: `rates` holds five numbers a mode, and `parts` has room for what each thread sums.
        unsafe {
            (self.modes)(
                rates.as_ptr().cast(),
                modes::DT,
                modes::STEPS as c_int,
                modes::RUNS as c_int,
                threads as c_int,
                seed,
                parts.as_mut_ptr().cast(),
            );
        }
        modes::added(&parts)
    }
}
