//! Functions of shared libraries, called as CasADi's C is.
#![allow(
    unsafe_code,
    reason = "the candidates are built while the benchmark runs, so they are loaded and called by address"
)]

use std::ffi::c_int;
use std::path::Path;
use std::time::Instant;

use libloading::Library;

use crate::points::Points;
use crate::subject::Subject;

/// A function of CasADi's C.
pub(crate) type Function =
    unsafe extern "C" fn(*const *const f64, *mut *mut f64, *mut i64, *mut f64, c_int) -> c_int;
type Prepare = unsafe extern "C" fn(*const f64) -> *const f64;

/// Working memory that CasADi's C asks for.
#[derive(Default)]
pub(crate) struct Work {
    pub(crate) arguments: usize,
    pub(crate) results: usize,
    pub(crate) integers: usize,
    pub(crate) reals: usize,
}

/// For each output, where its stored values stand in the dense matrix, row by row.
pub(crate) type Layout = Vec<Vec<usize>>;

/// Passes over the points in one turn.
pub(crate) const PASSES: u32 = 3;

/// A way to compute a subject.
pub(crate) trait Evaluate {
    /// All outputs at every point, dense and row by row.
    fn values(&mut self, points: &Points) -> Result<Vec<Vec<f64>>, String>;

    /// Seconds of an evaluation in this round.
    fn turn(&mut self, points: &Points, round: u32) -> Result<f64, String>;

    /// Seconds that it took until it had run for the first time, where it is compiled then.
    fn first(&self) -> f64 {
        0.0
    }
}

/// A function with its arguments in place.
pub(crate) struct Kernel {
    function: Function,
    parameters: *const f64,
    arguments: Vec<*const f64>,
    outputs: Vec<Vec<f64>>,
    place: usize,
    results: Vec<*mut f64>,
    integers: Vec<i64>,
    reals: Vec<f64>,
    layout: Layout,
    dense: usize,
}

/// A library that stays loaded.
pub(crate) fn load(path: &Path) -> Result<&'static Library, String> {
    // SAFETY: a library that the benchmark has built; it runs nothing when loaded.
    let library = unsafe { Library::new(path) };
    let library =
        library.map_err(|error| format!("error: cannot load {}: {error}", path.display()))?;
    Ok(Box::leak(Box::new(library)))
}

/// Places that an output is moved through, in numbers.
const PLACES: usize = 512;

impl Kernel {
    /// The function of `subject` in `library`. `prepare` turns the parameters into what it takes.
    pub(crate) fn new(
        library: &'static Library,
        subject: &Subject,
        prepare: Option<&str>,
        layout: Layout,
        work: Work,
    ) -> Result<Self, String> {
        let lacking = |error| format!("error: a candidate has no {}: {error}", subject.symbol);
        // SAFETY: all libraries declare the symbol with this type, which is CasADi's.
        let function = unsafe { library.get::<Function>(subject.symbol) }.map_err(lacking)?;
        let parameters: &'static [f64] = subject.model.parameters().1.leak();
        let parameters = match prepare {
            None => parameters.as_ptr(),
            Some(name) => {
                // SAFETY: the library of generated functions declares its symbol with this type, and takes
                // as many numbers as the table has.
                unsafe { library.get::<Prepare>(name).map_err(lacking)?(parameters.as_ptr()) }
            }
        };
        let room = |it: &Vec<usize>| vec![0.0; it.len() + PLACES];
        let mut outputs: Vec<Vec<f64>> = layout.iter().map(room).collect();
        let mut results: Vec<*mut f64> = outputs.iter_mut().map(|it| it.as_mut_ptr()).collect();
        results.resize(results.len().max(work.results), std::ptr::null_mut());
        Ok(Self {
            function: *function,
            parameters,
            arguments: vec![std::ptr::null(); work.arguments.max(3)],
            outputs,
            place: 0,
            results,
            integers: vec![0; work.integers],
            reals: vec![0.0; work.reals],
            layout,
            dense: subject.dense(),
        })
    }

    /// Moves the outputs: how they lie to cache lines and pages changes a time by up to a tenth, and a
    /// candidate shall be neither lucky nor unlucky for all rounds.
    fn move_outputs(&mut self, round: u32) {
        self.place = round as usize * 13 % PLACES;
        for (result, output) in self.results.iter_mut().zip(&mut self.outputs) {
            *result = output[self.place..].as_mut_ptr();
        }
    }

    #[inline]
    fn call(&mut self, state: &[f64], input: &[f64]) {
        self.arguments[..3].copy_from_slice(&[state.as_ptr(), input.as_ptr(), self.parameters]);
        // SAFETY: `arguments` and `results` hold pointers to as many numbers as the function reads and
        // writes: the points have the lengths of the model's vectors, and `outputs` those of the layout.
        unsafe {
            (self.function)(
                self.arguments.as_ptr(),
                self.results.as_mut_ptr(),
                self.integers.as_mut_ptr(),
                self.reals.as_mut_ptr(),
                0,
            );
        }
    }

    fn gather(&self) -> Vec<f64> {
        let mut dense = vec![0.0; self.dense];
        for (positions, output) in self.layout.iter().zip(&self.outputs) {
            for (&position, pointer) in positions.iter().zip(&output[self.place..]) {
                // SAFETY: a number of `outputs`, which the function writes behind the compiler's back.
                dense[position] = unsafe { std::ptr::read_volatile(pointer) };
            }
        }
        dense
    }
}

impl Evaluate for Kernel {
    fn values(&mut self, points: &Points) -> Result<Vec<Vec<f64>>, String> {
        let values = points.iter().map(|(state, input)| {
            self.call(state, input);
            self.gather()
        });
        Ok(values.collect())
    }

    fn turn(&mut self, points: &Points, round: u32) -> Result<f64, String> {
        self.move_outputs(round);
        let start = Instant::now();
        for _ in 0..PASSES {
            for (state, input) in points.iter() {
                self.call(state, input);
            }
        }
        let evaluations = PASSES as usize * points.len();
        Ok(start.elapsed().as_secs_f64() / evaluations as f64)
    }
}
