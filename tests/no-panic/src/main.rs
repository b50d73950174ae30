//! Calls every generated function and both steppers, and links only while no panic can be reached.
//!
//! The panic handler calls a function that nobody defines. Where the linker finds the handler
//! reachable it stops with `undefined symbol: a_panic_can_be_reached`. Values pass through
//! `black_box`, so that the optimiser knows nothing about them.
#![no_std]
#![no_main]

use core::hint::black_box;
use core::panic::PanicInfo;

use ahv_core::{Bounds, DifferentiableModel, Real, StochasticModel, Vector, first_outside};
use ahv_integrate::{EulerMaruyama, Rk4};
use ahv_models::{com, dcom, sdcom};

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
    #[cfg(feature = "plant")]
    black_box(dcom::State::<f64>::NAMES[black_box(0)]);
    loop {}
}

fn every_model<R: Real>() {
    com_functions::<R>();
    dcom_functions::<R>();
    sdcom_functions::<R>();
    com_evaluations::<R>();
    dcom_evaluations::<R>();
    sdcom_evaluations::<R>();
}

fn com_functions<R: Real>() {
    let nominal = com::NOMINAL.map_into(R::from_f64);
    let (x, u, p) = (unknown(), unknown(), com::prepare(&black_box(nominal)));
    black_box(com::drift::<R>(&x, &u, &p));
    black_box(com::jacobians::<R>(&x, &u, &p));
    black_box(com::drift_and_jacobians::<R>(&x, &u, &p));
    let model = black_box(com::Model::new(&nominal));
    differentiable(&model, &com::STATE_BOUNDS, &com::INPUT_BOUNDS);
    vector::<R, com::Parameters<R>>();
}

fn dcom_functions<R: Real>() {
    let nominal = dcom::NOMINAL.map_into(R::from_f64);
    let (x, u, p) = (unknown(), unknown(), dcom::prepare(&black_box(nominal)));
    black_box(dcom::drift::<R>(&x, &u, &p));
    black_box(dcom::jacobians::<R>(&x, &u, &p));
    black_box(dcom::drift_and_jacobians::<R>(&x, &u, &p));
    let model = black_box(dcom::Model::new(&nominal));
    differentiable(&model, &dcom::STATE_BOUNDS, &dcom::INPUT_BOUNDS);
    vector::<R, dcom::Parameters<R>>();
}

fn sdcom_functions<R: Real>() {
    let nominal = sdcom::NOMINAL.map_into(R::from_f64);
    let (x, u, p) = (unknown(), unknown(), sdcom::prepare(&black_box(nominal)));
    black_box(sdcom::drift::<R>(&x, &u, &p));
    black_box(sdcom::jacobians::<R>(&x, &u, &p));
    black_box(sdcom::drift_and_jacobians::<R>(&x, &u, &p));
    black_box(sdcom::diffusion::<R>(&x, &u, &p));
    black_box(sdcom::drift_and_diffusion::<R>(&x, &u, &p));
    black_box(sdcom::noise_increment::<R>(&x, &u, &p, &unknown()));
    let model = black_box(sdcom::Model::new(&nominal));
    differentiable(&model, &sdcom::STATE_BOUNDS, &sdcom::INPUT_BOUNDS);
    stochastic(&model);
}

/// Calls functions of state, input and prepared parameters.
macro_rules! call {
    ($x:expr, $u:expr, $p:expr; $($function:path),+ $(,)?) => {
        $(black_box($function($x, $u, $p));)+
    };
}

fn com_evaluations<R: Real>() {
    let (x, u) = (unknown(), unknown());
    let p = com::prepare(&com::NOMINAL.map_into(R::from_f64));
    call!(&x, &u, &p;
        com::density,
        com::dynamic_pressure,
        com::c_l,
        com::c_d,
        com::c_m,
        com::thrust,
        com::lift,
        com::drag,
        com::pitching_moment,
    );
}

fn dcom_evaluations<R: Real>() {
    let (x, u) = (unknown(), unknown());
    let p = dcom::prepare(&dcom::NOMINAL.map_into(R::from_f64));
    call!(&x, &u, &p;
        dcom::density,
        dcom::dynamic_pressure,
        dcom::c_l,
        dcom::c_d,
        dcom::c_m,
        dcom::c_t,
        dcom::thrust,
        dcom::lift,
        dcom::drag,
        dcom::pitching_moment,
        dcom::c_n_1,
        dcom::c_n_2,
        dcom::c_n_3,
        dcom::generalized_force_1,
        dcom::generalized_force_2,
        dcom::generalized_force_3,
    );
}

fn sdcom_evaluations<R: Real>() {
    let (x, u) = (unknown(), unknown());
    let p = sdcom::prepare(&sdcom::NOMINAL.map_into(R::from_f64));
    call!(&x, &u, &p;
        sdcom::density,
        sdcom::dynamic_pressure,
        sdcom::c_l,
        sdcom::c_d,
        sdcom::c_m,
        sdcom::c_t,
        sdcom::thrust,
        sdcom::lift,
        sdcom::drag,
        sdcom::pitching_moment,
        sdcom::c_n_1,
        sdcom::c_n_2,
        sdcom::c_n_3,
        sdcom::generalized_force_1,
        sdcom::generalized_force_2,
        sdcom::generalized_force_3,
        sdcom::eta_static_1,
        sdcom::eta_static_2,
        sdcom::eta_static_3,
        sdcom::eta_1,
        sdcom::eta_2,
        sdcom::eta_3,
        sdcom::f_V,
        sdcom::g_V,
        sdcom::h_V,
        sdcom::H_V,
        sdcom::f_V_eta,
        sdcom::f_gamma,
        sdcom::g_gamma,
        sdcom::h_gamma,
        sdcom::H_gamma,
        sdcom::f_gamma_eta,
        sdcom::f_alpha,
        sdcom::g_alpha,
        sdcom::h_alpha,
        sdcom::H_alpha,
        sdcom::f_alpha_eta,
        sdcom::f_Q,
        sdcom::g_Q,
        sdcom::h_Q,
        sdcom::H_Q,
        sdcom::f_Q_eta,
        sdcom::g_Q_total,
    );
}

fn differentiable<M, X, U>(model: &M, states: &X, inputs: &U)
where
    M: DifferentiableModel,
    X: Vector<Bounds>,
    U: Vector<Bounds>,
{
    let (mut x, u) = (unknown(), unknown());
    black_box(model.jacobians(&x, &u));
    black_box(model.drift_and_jacobians(&x, &u));
    black_box(Rk4::new(black_box(0.01)).step(model, &mut x, &u).is_ok());
    black_box(first_outside(&x, states).is_some());
    black_box(first_outside(&u, inputs).is_some());
    vector::<M::Scalar, M::State>();
    vector::<M::Scalar, M::Input>();
}

fn stochastic<M: StochasticModel>(model: &M) {
    let (mut x, u, dw) = (unknown(), unknown(), unknown());
    let stepper = EulerMaruyama::new(black_box(0.01));
    black_box(stepper.step(model, &mut x, &u, &dw).is_ok());
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
