//! No step of a flight model allocates.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use ahv_core::Vector;
use ahv_integrate::{
    Adaptive, ComponentLimit, Constant, Ending, Euler, EulerMaruyama, Event, Exponential, Fixed,
    FlexibleMode, Heun, Leaving, Problem, Progress, Rk4, Rodas4, Saturated, StepError, Tsit5,
    Within,
};
use ahv_models::{dcom, sdcom};

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

/// Velocity and altitude of level flight; the rest of the state is 0.
const VELOCITY: f64 = 7702.0808;
const ALTITUDE: f64 = 85_000.0;

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

#[test]
fn no_step_allocates() {
    let deterministic = dcom::Model::new(&dcom::NOMINAL);
    let stochastic = sdcom::Model::new(&sdcom::NOMINAL);
    let mut x = dcom::State {
        velocity: VELOCITY,
        altitude: ALTITUDE,
        ..dcom::State::splat(0.0)
    };
    let mut y = sdcom::State {
        velocity: VELOCITY,
        altitude: ALTITUDE,
        ..sdcom::State::splat(0.0)
    };
    let (u, v) = (dcom::Input::splat(0.2), sdcom::Input::splat(0.2));
    let dw = sdcom::Noise::splat(1e-3);
    let count = allocations_in(|| {
        for _ in 0..100 {
            assert_eq!(Rk4::new(0.001).step(&deterministic, &mut x, &u), Ok(()));
            assert_eq!(
                EulerMaruyama::new(0.001).step(&stochastic, &mut y, &v, &dw),
                Ok(())
            );
        }
    });
    assert_eq!(count, 0);
}

#[test]
fn no_run_allocates() {
    let model = dcom::Model::new(&dcom::NOMINAL);
    let start = dcom::State {
        velocity: VELOCITY,
        altitude: ALTITUDE,
        ..dcom::State::splat(0.0)
    };
    let u = dcom::Input::splat(0.2);
    let count = allocations_in(|| {
        let input = Saturated::new(Constant(u), dcom::INPUT_BOUNDS);
        let floor = ComponentLimit::at_least::<dcom::Model<f64>>("floor", "altitude", 80_000.0);
        let floor = floor.expect("there is an altitude");
        let events: [&dyn Event<dcom::Model<f64>>; 1] = [&floor];
        let within = Within::new(dcom::STATE_BOUNDS, Leaving::Warn);
        let problem = Problem::new(&model, &input)
            .validity(within)
            .events(&events);
        let tolerance = dcom::State::splat(1e-6);
        let mut explicit = Progress::new(0.0, start);
        let ending =
            Adaptive::new(Tsit5, 1e-6, tolerance).run(&problem, &mut explicit, 0.2, &mut ());
        assert_eq!(ending, Ok(Ending::Time));
        let mut stiff = Progress::new(0.0, start);
        let ending = Adaptive::new(Rodas4, 1e-6, tolerance).run(&problem, &mut stiff, 0.2, &mut ());
        assert_eq!(ending, Ok(Ending::Time));
        let mode = FlexibleMode::new::<dcom::Model<f64>>("eta_1", "eta_dot_1", 19.7437, 0.7);
        let mode = mode.expect("a good mode");
        let mut x = start;
        assert_eq!(
            Exponential::new(0.001, [mode]).step(&model, &mut x, &u),
            Ok(())
        );
        assert_eq!(Fixed::new(Rodas4, 0.001).step(&model, &mut x, &u), Ok(()));
        assert_eq!(Euler::new(0.001).step(&model, &mut x, &u), Ok(()));
        assert_eq!(Heun::new(0.001).step(&model, &mut x, &u), Ok(()));
    });
    assert_eq!(count, 0);
}

#[test]
fn no_failing_step_allocates() {
    let model = dcom::Model::new(&dcom::NOMINAL);
    let (mut x, u) = (dcom::State::splat(0.0), dcom::Input::splat(0.2));
    let count = allocations_in(|| {
        let failed = Rk4::new(0.01).step(&model, &mut x, &u);
        assert!(matches!(failed, Err(StepError::NonFinite { .. })));
    });
    assert_eq!(count, 0);
}
