//! Calls every generated function (see build.rs) and every stepper (see tests/steppers), and links only while no panic
//! can be reached.
//!
//! The panic handler calls a function that nobody defines. Where the linker finds the handler
//! reachable it stops with `undefined symbol: a_panic_can_be_reached`. Values pass through
//! `black_box`, so that the optimiser knows nothing about them.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;

use ahv_core::{Bounds, DifferentiableModel, DifferentiableNoise, Real, Vector, first_outside};
use ahv_models::{com, com_rigid, dcom, flexible_mode, sdcom, sdcom_gust, sdcom_printed};
use ahv_steppers::{Advance, Label, Visitor};

unsafe extern "C" {
    fn a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    // SAFETY: never executed; it exists to be missed by the linker.
    unsafe { a_panic_can_be_reached() }
}

/// Where the linker starts to look for what is reachable.
#[unsafe(no_mangle)]
pub extern "C" fn _start() -> ! {
    #[cfg(not(feature = "plant"))]
    everything();
    #[cfg(feature = "plant")]
    black_box(dcom::State::<f64>::NAMES[black_box(0)]);
    loop {}
}

/// In both scalars. The planted panic stands alone, so that showing it costs little.
#[cfg_attr(feature = "plant", expect(dead_code))]
fn everything() {
    every_model::<f64>();
    every_model::<f32>();
    ahv_steppers::all(&mut Anything);
    ahv_steppers::drawn::<f64>(&mut Anything);
    ahv_steppers::fixed::<f32>(&mut Anything);
    ahv_steppers::controlled::<f32>(&mut Anything);
    ahv_steppers::drawn::<f32>(&mut Anything);
}

include!(concat!(env!("OUT_DIR"), "/calls.rs"));

fn differentiable<M, X, U>(model: &M, states: &X, inputs: &U)
where
    M: DifferentiableModel,
    X: Vector<Bounds>,
    U: Vector<Bounds>,
{
    let (x, u) = (unknown(), unknown());
    black_box(model.jacobians(&x, &u));
    black_box(model.drift_and_jacobians(&x, &u));
    black_box(first_outside(&x, states).is_some());
    black_box(first_outside(&u, inputs).is_some());
    vector::<M::Scalar, M::State>();
    vector::<M::Scalar, M::Input>();
}

fn stochastic<M: DifferentiableNoise>(model: &M) {
    let (x, u) = (unknown(), unknown());
    black_box(model.drift_and_noise_increment(&x, &u, &unknown()));
    black_box(model.iterated_increment(&x, &u, |_, _| black_box(M::Scalar::ONE)));
    vector::<M::Scalar, M::Noise>();
}

/// Takes a step from anywhere.
struct Anything;

impl<R: Real> Visitor<R> for Anything {
    fn parameter(&mut self, nominal: f64) -> R {
        black_box(R::from_f64(nominal))
    }

    fn within(&mut self, _: Bounds) -> R {
        black_box(R::ONE)
    }

    fn visit(&mut self, _: Label, start: &[R], advance: &mut Advance<'_, R>) {
        let mut buffer = [R::ONE; 16];
        for (place, &component) in buffer.iter_mut().zip(start) {
            *place = component;
        }
        if let Some(x) = buffer.get_mut(..start.len()) {
            black_box(advance(black_box(x), black_box(0)));
        }
        black_box(buffer);
    }
}

/// What `Vector` can do, at an index that may be out of range.
fn vector<R: Real, V: Vector<R>>() {
    let mut v: V = unknown();
    black_box(v.get(black_box(0)));
    black_box(v.set(black_box(0), black_box(R::ONE)));
    black_box(v.find(|component| !component.is_finite()));
    black_box(v.zip_with(unknown(), |a, b| a * b).map(R::sqrt));
    black_box(V::index_of(black_box("alpha")));
}

/// A vector of which the optimiser knows nothing.
fn unknown<R: Real, V: Vector<R>>() -> V {
    V::from_fn(|_| black_box(R::ONE))
}
