//! Calls every generated function (see build.rs) and the steppers, and links only while no panic can be reached.
//!
//! The panic handler calls a function that nobody defines. Where the linker finds the handler
//! reachable it stops with `undefined symbol: a_panic_can_be_reached`. Values pass through
//! `black_box`, so that the optimiser knows nothing about them.
#![no_std]
#![no_main]

mod deterministic;

use core::hint::black_box;
use core::panic::PanicInfo;

use ahv_core::{Bounds, DifferentiableModel, DifferentiableNoise, Real, Vector, first_outside};
use ahv_integrate::{EulerMaruyama, ItoDri1, ItoHeun, StratonovichHeun, WeakIncrements};
use ahv_models::{com, com_rigid, dcom, flexible_mode, sdcom, sdcom_gust, sdcom_printed};

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
    every_model::<f64>();
    every_model::<f32>();
    deterministic::all::<f64>();
    deterministic::all::<f32>();
    #[cfg(feature = "plant")]
    black_box(dcom::State::<f64>::NAMES[black_box(0)]);
    loop {}
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
    let (mut x, u, dw) = (unknown(), unknown(), unknown());
    let dt = black_box(0.01);
    black_box(EulerMaruyama::new(dt).step(model, &mut x, &u, &dw).is_ok());
    black_box(
        StratonovichHeun::new(dt)
            .step(model, &mut x, &u, &dw)
            .is_ok(),
    );
    black_box(ItoHeun::new(dt).step(model, &mut x, &u, &dw).is_ok());
    let weak = WeakIncrements::from_normals::<M::Scalar>(dt, |channel| black_box(channel as f64));
    black_box(ItoDri1::new(dt).step(model, &mut x, &u, &weak).is_ok());
    black_box(model.iterated_increment(&x, &u, |_, _| black_box(M::Scalar::ONE)));
    vector::<M::Scalar, M::Noise>();
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
