//! A flight on a Cortex-M7 under QEMU: prints its states, and what its steps cost, through semihosting.
//!
//! Every way out ends the emulator with a status: 0 after a whole flight, 1 after a failed step, a panic or a fault.
#![no_std]

mod probe;

use core::fmt::Write;
use core::panic::PanicInfo;

use cortex_m_rt::{ExceptionFrame, exception};
use cortex_m_semihosting::debug::{self, EXIT_FAILURE, EXIT_SUCCESS};
use cortex_m_semihosting::hio;
use flights::{Flight, STEPS, fly};

use crate::probe::{Cost, Probe};

/// Flies, prints, and ends the emulator.
pub fn run<F: Flight>() -> ! {
    let status = match print::<F>() {
        Ok(()) => EXIT_SUCCESS,
        Err(Silent) => EXIT_FAILURE,
    };
    end(status)
}

/// The flight did not come to its end; why has been said where that was possible.
struct Silent;

/// The states as [`fly`] writes them, then the costs, a line each.
fn print<F: Flight>() -> Result<(), Silent> {
    let mut out = hio::hstdout().map_err(|()| Silent)?;
    let Some(mut probe) = Probe::new() else {
        return say("the instruction counter is not as expected: run QEMU with -icount shift=8");
    };
    let mut costs = Some((0, Cost::default()));
    let flown = fly::<F>(&mut out, |flight| {
        let (result, cost) = probe.measure(|| flight.step());
        costs = costs
            .zip(cost)
            .map(|((total, worst), cost)| (total + cost.instructions, worst.max(cost)));
        result
    });
    if let Err(ended) = flown {
        return say(ended);
    }
    let Some((total, worst)) = costs else {
        return say("a step takes more instructions or stack than can be measured");
    };
    let lines = writeln!(
        out,
        "mean {}\nworst {}\nstack {}\nsize {}",
        (total + STEPS / 2) / STEPS,
        worst.instructions,
        worst.stack,
        size_of::<F>()
    );
    lines.map_err(|_| Silent)
}

/// Says on the host's standard error why there is no result.
fn say(reason: impl core::fmt::Display) -> Result<(), Silent> {
    let mut err = hio::hstderr().map_err(|()| Silent)?;
    let _ = writeln!(err, "error: {reason}");
    Err(Silent)
}

fn end(status: debug::ExitStatus) -> ! {
    loop {
        debug::exit(status);
    }
}

#[panic_handler]
fn panic(info: &PanicInfo) -> ! {
    let _ = say(info);
    end(EXIT_FAILURE)
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    let _ = say(format_args!("hard fault at {:#010x}", frame.pc()));
    end(EXIT_FAILURE)
}

#[exception]
unsafe fn DefaultHandler(exception: i16) -> ! {
    let _ = say(format_args!("exception {exception}"));
    end(EXIT_FAILURE)
}
