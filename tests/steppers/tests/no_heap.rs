//! No step of any stepper allocates, nor does a source of noise.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use ahv_core::{Bounds, Vector};
use ahv_integrate::{Adaptive, Constant, Failure, Problem, Progress, Rk4, StepError, Tsit5};
use ahv_models::dcom;
use ahv_steppers::{Advance, Label, Visitor};

thread_local! {
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

struct Counting;

#[allow(
    unsafe_code,
    reason = "an allocator that counts can only be written through this unsafe trait"
)]
// SAFETY: every call is handed to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        ALLOCATIONS.with(|count| count.set(count.get() + 1));
        // SAFETY: the caller's promise about `layout` is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise about `pointer` and `layout` is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations_in(work: impl FnOnce()) -> usize {
    let before = ALLOCATIONS.with(Cell::get);
    work();
    ALLOCATIONS.with(Cell::get) - before
}

#[test]
fn the_counter_counts() {
    assert_eq!(
        allocations_in(|| drop(std::hint::black_box(Box::new(1)))),
        1
    );
}

/// Steps from the middle of the box, at nominal parameters.
#[derive(Default)]
struct Middle {
    visited: usize,
}

impl Visitor<f64> for Middle {
    fn parameter(&mut self, nominal: f64) -> f64 {
        nominal
    }

    fn within(&mut self, bounds: Bounds) -> f64 {
        0.5 * (bounds.min + bounds.max)
    }

    fn visit(&mut self, label: Label, start: &[f64], advance: &mut Advance<'_, f64>) {
        let mut buffer = [0.0; 16];
        let x = &mut buffer[..start.len()];
        x.copy_from_slice(start);
        for step in 0..20 {
            assert!(advance(x, step), "{label:?} fails at step {step}");
        }
        self.visited += 1;
    }
}

#[test]
fn no_stepper_and_no_source_of_noise_allocates() {
    let mut middle = Middle::default();
    let count = allocations_in(|| {
        ahv_steppers::all(&mut middle);
        ahv_steppers::drawn(&mut middle);
    });
    assert!(middle.visited > 100, "{} steppers", middle.visited);
    assert_eq!(count, 0);
}

#[test]
fn no_failure_allocates() {
    let model = dcom::Model::new(&dcom::NOMINAL);
    let (mut x, u) = (dcom::State::splat(0.0), dcom::Input::splat(0.2));
    let count = allocations_in(|| {
        let failed = Rk4::new(0.01).step(&model, &mut x, &u);
        assert!(matches!(failed, Err(StepError::NonFinite { .. })));
        let input = Constant(u);
        let solver = Adaptive::new(Tsit5, 1e-6, dcom::State::splat(1e-6));
        let mut progress = Progress::new(0.0, x);
        let failed = solver.run(&Problem::new(&model, &input), &mut progress, 1.0, &mut ());
        assert!(matches!(failed, Err(Failure::NonFinite { .. })));
    });
    assert_eq!(count, 0);
}
