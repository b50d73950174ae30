//! The generated functions behind the call that CasADi's C has: `arg` holds pointers to state, input
//! and parameters, `res` to the outputs, row by row. Parameters are what the model's `prepare` made.
#![allow(
    unsafe_code,
    reason = "candidates of the benchmark are called through CasADi's C interface, which takes raw pointers"
)]

use core::ffi::c_int;

use ahv_core::Vector;
use ahv_models::{dcom, sdcom};

const PARAMETERS: usize = <dcom::Parameters<f64> as Vector<f64>>::LEN;

/// Element `index` of `pointers`, as a pointer to `T`.
///
/// # Safety
/// `pointers` has more than `index` elements, and that one points to a `T`.
unsafe fn at<'a, T>(pointers: *const *const f64, index: usize) -> &'a T {
    // SAFETY: the caller's promise.
    unsafe { &*(*pointers.add(index)).cast() }
}

/// Writes an output.
///
/// # Safety
/// `pointers` has more than `index` elements, and that one points to room for a `T`.
unsafe fn put<T>(pointers: *const *mut f64, index: usize, value: T) {
    // SAFETY: the caller's promise.
    unsafe { (*pointers.add(index)).cast::<T>().write(value) }
}

/// Parameters as the functions of DCOM take them. They live as long as the program.
///
/// # Safety
/// `parameters` points to as many numbers as the table has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dcom_prepare(parameters: *const f64) -> *const f64 {
    // SAFETY: the caller's promise.
    let parameters: [f64; PARAMETERS] = unsafe { *parameters.cast() };
    let prepared = dcom::prepare(&dcom::Parameters::from(parameters));
    (&raw const *Box::leak(Box::new(prepared))).cast()
}

/// Parameters as the functions of SDCOM take them. They live as long as the program.
///
/// # Safety
/// `parameters` points to as many numbers as the table has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdcom_prepare(parameters: *const f64) -> *const f64 {
    // SAFETY: the caller's promise.
    let parameters: [f64; PARAMETERS] = unsafe { *parameters.cast() };
    let prepared = sdcom::prepare(&sdcom::Parameters::from(parameters));
    (&raw const *Box::leak(Box::new(prepared))).cast()
}

/// Drift of DCOM.
///
/// # Safety
/// `arg` points to state, input and what [`dcom_prepare`] gave; `res` to the drift.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dcom_drift(
    arg: *const *const f64,
    res: *const *mut f64,
    _iw: *mut i64,
    _w: *mut f64,
    _mem: c_int,
) -> c_int {
    // SAFETY: the caller's promise.
    unsafe {
        let (x, u) = (at::<[f64; 11]>(arg, 0), at::<[f64; 3]>(arg, 1));
        let f = dcom::drift(&dcom::State::from(*x), &dcom::Input::from(*u), at(arg, 2));
        put(res, 0, f.to_array());
    }
    0
}

/// Drift of DCOM and both Jacobians.
///
/// # Safety
/// `arg` points to state, input and what [`dcom_prepare`] gave; `res` to the drift and the Jacobians.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dcom_drift_jacobians(
    arg: *const *const f64,
    res: *const *mut f64,
    _iw: *mut i64,
    _w: *mut f64,
    _mem: c_int,
) -> c_int {
    // SAFETY: the caller's promise.
    unsafe {
        let (x, u) = (at::<[f64; 11]>(arg, 0), at::<[f64; 3]>(arg, 1));
        let (x, u, p) = (dcom::State::from(*x), dcom::Input::from(*u), at(arg, 2));
        let f = dcom::drift(&x, &u, p);
        let (f_x, f_u) = dcom::jacobians(&x, &u, p);
        put(res, 0, f.to_array());
        put(res, 1, f_x.to_matrix::<f64, 11>());
        put(res, 2, f_u.to_matrix::<f64, 3>());
    }
    0
}

/// Drift and diffusion of SDCOM.
///
/// # Safety
/// `arg` points to state, input and what [`sdcom_prepare`] gave; `res` to the drift and the diffusion.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdcom_drift_diffusion(
    arg: *const *const f64,
    res: *const *mut f64,
    _iw: *mut i64,
    _w: *mut f64,
    _mem: c_int,
) -> c_int {
    // SAFETY: the caller's promise.
    unsafe {
        let (x, u) = (at::<[f64; 8]>(arg, 0), at::<[f64; 3]>(arg, 1));
        let (x, u, p) = (sdcom::State::from(*x), sdcom::Input::from(*u), at(arg, 2));
        let f = sdcom::drift(&x, &u, p);
        let g = sdcom::diffusion(&x, &u, p);
        put(res, 0, f.to_array());
        put(res, 1, g.to_matrix::<f64, 6>());
    }
    0
}
