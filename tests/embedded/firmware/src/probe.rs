//! What a call costs: instructions and stack.

use core::arch::asm;
use core::ptr;
use core::sync::atomic::{Ordering, compiler_fence};

use cortex_m::Peripherals;
use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::register::msp;

/// Virtual time of an instruction under `-icount shift=8`, in ns.
const INSTRUCTION: u32 = 1 << 8;
/// Period of the processor's clock of the MPS2+, 25 MHz, in ns: 6.4 of them an instruction, so that SysTick tells single ones.
const TICK: u32 = 40;
/// Greatest value of SysTick.
const RELOAD: u32 = 0x00ff_ffff;
/// Turns of two loops that show whether instructions are counted.
const LOOPS: [u32; 2] = [1000, 100_000];
/// Words below the stack pointer that are painted, and the colour.
const PAINTED: usize = 4096;
const PAINT: u32 = 0x5a5a_5a5a;

/// Cost of one call, or the greatest of several.
#[derive(Clone, Copy, Default)]
pub(crate) struct Cost {
    /// Instructions, from the call to behind it.
    pub(crate) instructions: u32,
    /// Bytes of stack below the caller's frame.
    pub(crate) stack: usize,
}

impl Cost {
    pub(crate) fn max(self, other: Self) -> Self {
        Self {
            instructions: self.instructions.max(other.instructions),
            stack: self.stack.max(other.stack),
        }
    }
}

/// Measures calls by SysTick and by painting the stack.
pub(crate) struct Probe {
    timer: SYST,
    /// Instructions that are counted around a call of nothing.
    own: u32,
}

impl Probe {
    /// A probe that has counted loops of known length; `None` where it counts otherwise, or at a second call.
    pub(crate) fn new() -> Option<Self> {
        let mut timer = Peripherals::take()?.SYST;
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(RELOAD);
        timer.enable_counter();
        let mut probe = Self { timer, own: 0 };
        probe.own = probe.measure(|| ()).1?.instructions;
        let mut counted = [0; LOOPS.len()];
        for (counted, turns) in counted.iter_mut().zip(LOOPS) {
            *counted = probe.measure(|| pairs(turns)).1?.instructions;
        }
        let [short, long] = counted;
        let exact = long.checked_sub(short) == Some(2 * (LOOPS[1] - LOOPS[0]));
        // Around the loop: what a function begins and ends with.
        let whole = short
            .checked_sub(2 * LOOPS[0])
            .is_some_and(|rest| rest < 10);
        (exact && whole).then_some(probe)
    }

    /// The result of `work`, and what it cost; `None` where that is more than can be measured.
    #[inline(never)]
    pub(crate) fn measure<T>(&mut self, work: impl FnOnce() -> T) -> (T, Option<Cost>) {
        let base = msp::read() as usize;
        paint(base);
        self.timer.clear_current();
        let before = SYST::get_current();
        compiler_fence(Ordering::SeqCst);
        let result = call(work);
        compiler_fence(Ordering::SeqCst);
        let after = SYST::get_current();
        let wrapped = self.timer.has_wrapped();
        let stack = used(base).filter(|_| !wrapped);
        let nanoseconds = (before.wrapping_sub(after) & RELOAD) * TICK;
        let instructions = (nanoseconds + INSTRUCTION / 2) / INSTRUCTION - self.own;
        let cost = stack.map(|stack| Cost {
            instructions,
            stack,
        });
        (result, cost)
    }
}

/// Keeps the frame of `work` apart from that of its caller.
#[inline(never)]
fn call<T>(work: impl FnOnce() -> T) -> T {
    work()
}

/// As many times two instructions as `turns` says.
fn pairs(turns: u32) {
    // SAFETY: a loop that writes its counter and the flags, which is what the block declares.
    unsafe {
        asm!(
            "2: subs {turns}, {turns}, #1",
            "bne 2b",
            turns = inout(reg) turns => _,
            options(nomem, nostack),
        );
    }
}

/// The addresses of the words below a stack pointer that are painted, the lowest first.
#[inline(always)]
fn below(base: usize) -> impl Iterator<Item = *mut u32> {
    let lowest = base - PAINTED * size_of::<u32>();
    (lowest..base)
        .step_by(size_of::<u32>())
        .map(ptr::with_exposed_provenance_mut)
}

/// Paints the stack below `base`, the caller's stack pointer. Inlined, for it must not paint over a frame of its own.
#[inline(always)]
fn paint(base: usize) {
    for word in below(base) {
        // SAFETY: aligned, in RAM as long as the stack has room for it, and below the stack pointer: no frame is there,
        // and no interrupt that would put one there is enabled.
        unsafe { word.write_volatile(PAINT) };
    }
}

/// Bytes below `base` down to the lowest word whose paint is gone; `None` if that is the lowest that was painted.
#[inline(always)]
fn used(base: usize) -> Option<usize> {
    let gone = below(base).position(|word| {
        // SAFETY: as in `paint`.
        unsafe { word.read_volatile() != PAINT }
    });
    match gone {
        Some(0) => None,
        Some(untouched) => Some((PAINTED - untouched) * size_of::<u32>()),
        None => Some(0),
    }
}
