//! The generated functions behind the call that CasADi's C has: `arg` holds pointers to state, input
//! and parameters, `res` to the outputs, row by row. Parameters are what the model's `prepare` made.
#![allow(
    unsafe_code,
    reason = "candidates of the benchmark are called through CasADi's C interface, which takes raw pointers"
)]

pub mod lanes;

use core::ffi::c_int;

use ahv_core::Vector;
use ahv_models::{dcom, sdcom};

/// Element `index` of `pointers` as a vector whose components all are f64.
///
/// The generated vectors are `repr(C)`: their fields lie in the order of the array.
///
/// # Safety
/// `pointers` has more than `index` elements, and that one points to the numbers of an `X`.
unsafe fn at<'a, X: Vector<f64>>(pointers: *const *const f64, index: usize) -> &'a X {
    const { assert!(size_of::<X>() == X::LEN * size_of::<f64>()) };
    // SAFETY: the caller's promise; `X` is made of f64 alone.
    unsafe { &*(*pointers.add(index)).cast() }
}

/// Element `index` of `pointers` as what `prepare` gave.
///
/// # Safety
/// `pointers` has more than `index` elements, and that one points to a `P`.
unsafe fn prepared<'a, P>(pointers: *const *const f64, index: usize) -> &'a P {
    // SAFETY: the caller's promise.
    unsafe { &*(*pointers.add(index)).cast() }
}

/// Element `index` of `pointers` as a vector, or a vector of vectors, whose components all are f64.
///
/// # Safety
/// `pointers` has more than `index` elements, and that one points to the numbers of a `Y`, which nothing
/// else points to.
unsafe fn out<'a, Y>(pointers: *const *mut f64, index: usize) -> &'a mut Y {
    // SAFETY: the caller's promise; `Y` is made of f64 alone.
    unsafe { &mut *(*pointers.add(index)).cast() }
}

/// Parameters as the functions of DCOM take them. They live as long as the program.
///
/// # Safety
/// `parameters` points to as many numbers as the table has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dcom_prepare(parameters: *const f64) -> *const f64 {
    // SAFETY: the caller's promise.
    let parameters: &dcom::Parameters<f64> = unsafe { at(&raw const parameters, 0) };
    let prepared = dcom::prepare(parameters);
    (&raw const *Box::leak(Box::new(prepared))).cast()
}

/// Parameters as the functions of SDCOM take them. They live as long as the program.
///
/// # Safety
/// `parameters` points to as many numbers as the table has.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn sdcom_prepare(parameters: *const f64) -> *const f64 {
    // SAFETY: the caller's promise.
    let parameters: &sdcom::Parameters<f64> = unsafe { at(&raw const parameters, 0) };
    let prepared = sdcom::prepare(parameters);
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
    // References that nothing else refers to, so that the result is written in place.
    #[inline]
    extern "C" fn evaluate(
        x: &dcom::State<f64>,
        u: &dcom::Input<f64>,
        p: &dcom::Prepared<f64>,
        f: &mut dcom::State<f64>,
    ) {
        *f = dcom::drift(x, u, p);
    }
    // SAFETY: the caller's promise.
    unsafe { evaluate(at(arg, 0), at(arg, 1), prepared(arg, 2), out(res, 0)) };
    0
}

/// Drift of DCOM, and the entries of both Jacobians that are not 0 by structure, in the order of the patterns.
///
/// # Safety
/// `arg` points to state, input and what [`dcom_prepare`] gave; `res` to the drift and the entries.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn dcom_drift_jacobians(
    arg: *const *const f64,
    res: *const *mut f64,
    _iw: *mut i64,
    _w: *mut f64,
    _mem: c_int,
) -> c_int {
    #[inline]
    extern "C" fn evaluate(
        x: &dcom::State<f64>,
        u: &dcom::Input<f64>,
        p: &dcom::Prepared<f64>,
        f: &mut dcom::State<f64>,
        f_x: &mut [f64; dcom::STATE_JACOBIAN_PATTERN.len()],
        f_u: &mut [f64; dcom::INPUT_JACOBIAN_PATTERN.len()],
    ) {
        let (drift, by_state, by_input) = dcom::drift_and_jacobians_values(x, u, p);
        (*f, *f_x, *f_u) = (drift, by_state.to_array(), by_input.to_array());
    }
    // SAFETY: the caller's promise.
    unsafe {
        evaluate(
            at(arg, 0),
            at(arg, 1),
            prepared(arg, 2),
            out(res, 0),
            out(res, 1),
            out(res, 2),
        );
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
    #[inline]
    extern "C" fn evaluate(
        x: &sdcom::State<f64>,
        u: &sdcom::Input<f64>,
        p: &sdcom::Prepared<f64>,
        f: &mut sdcom::State<f64>,
        g: &mut sdcom::Diffusion<f64>,
    ) {
        (*f, *g) = sdcom::drift_and_diffusion(x, u, p);
    }
    // SAFETY: the caller's promise.
    unsafe {
        evaluate(
            at(arg, 0),
            at(arg, 1),
            prepared(arg, 2),
            out(res, 0),
            out(res, 1),
        );
    }
    0
}
