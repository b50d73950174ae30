//! wrenfold's functions behind the call that CasADi's C has: `arg` holds pointers to state, input and
//! parameters, `res` to the outputs, column by column. The vectors are nalgebra's, viewed where they lie.

use core::ffi::c_int;

use nalgebra::{SMatrix, SVector};

mod generated {
    #![allow(clippy::all)]
    include!(concat!(env!("AHV_BENCH_WRENFOLD"), "/peer.rs"));
}

/// Element `index` of `pointers`, as a vector.
///
/// # Safety
/// `pointers` has more than `index` elements, and that one points to `N` numbers.
unsafe fn vector<'a, const N: usize>(
    pointers: *const *const f64,
    index: usize,
) -> &'a SVector<f64, N> {
    // SAFETY: the caller's promise; a static vector of nalgebra is an array.
    unsafe { &*(*pointers.add(index)).cast() }
}

/// Element `index` of `pointers`, as a matrix.
///
/// # Safety
/// `pointers` has more than `index` elements, and that one points to the numbers of a matrix.
unsafe fn matrix<'a, const R: usize, const C: usize>(
    pointers: *const *mut f64,
    index: usize,
) -> &'a mut SMatrix<f64, R, C> {
    // SAFETY: the caller's promise; a static matrix of nalgebra is an array of its columns.
    unsafe { &mut *(*pointers.add(index)).cast() }
}

/// Drift of DCOM.
///
/// # Safety
/// `arg` points to state, input and parameters; `res` to the drift.
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
        generated::dcom_drift(
            vector(arg, 0),
            vector(arg, 1),
            vector(arg, 2),
            matrix(res, 0),
        );
    }
    0
}

/// Drift of DCOM and both Jacobians.
///
/// # Safety
/// `arg` points to state, input and parameters; `res` to the drift and the Jacobians.
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
        generated::dcom_drift_jacobians(
            vector(arg, 0),
            vector(arg, 1),
            vector(arg, 2),
            matrix(res, 0),
            matrix(res, 1),
            matrix(res, 2),
        );
    }
    0
}

/// Drift and diffusion of SDCOM.
///
/// # Safety
/// `arg` points to state, input and parameters; `res` to the drift and the diffusion.
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
        generated::sdcom_drift_diffusion(
            vector(arg, 0),
            vector(arg, 1),
            vector(arg, 2),
            matrix(res, 0),
            matrix(res, 1),
        );
    }
    0
}
