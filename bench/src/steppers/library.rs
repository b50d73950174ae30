//! CasADi's C of steps and of whole flights.
#![allow(
    unsafe_code,
    reason = "CasADi's C is built while the benchmark runs, so it is loaded and called by address"
)]

use std::collections::BTreeMap;
use std::hint::black_box;
use std::path::Path;
use std::rc::Rc;
use std::time::Instant;

use libloading::Library;
use serde_json::Value;

use super::flights::{END, Flight, Flights, STATES};
use super::solver::{Request, Solution, Solver, steps};
use crate::kernel::{self, Function};
use crate::layout;

/// The functions of the library, by name.
pub(crate) struct Steps {
    library: &'static Library,
    said: BTreeMap<String, Value>,
}

/// A function with its working memory.
pub(crate) struct Step {
    function: Function,
    arguments: Vec<*const f64>,
    results: Vec<*mut f64>,
    integers: Vec<i64>,
    reals: Vec<f64>,
}

impl Steps {
    /// The library at `path`, of which CasADi's script said this.
    pub(crate) fn new(path: &Path, said: &Value) -> Result<Self, String> {
        let said = said["steps"].as_object().into_iter().flatten();
        Ok(Self {
            library: kernel::load(path)?,
            said: said
                .map(|(name, value)| (name.clone(), value.clone()))
                .collect(),
        })
    }

    /// The function `name`.
    pub(crate) fn step(&self, name: &str) -> Result<Step, String> {
        let work = layout::work(self.said.get(name).unwrap_or(&Value::Null))?;
        // SAFETY: all functions of CasADi's C have this type.
        let function = unsafe { self.library.get::<Function>(name) };
        let function = function.map_err(|error| format!("error: CasADi has no {name}: {error}"))?;
        Ok(Step {
            function: *function,
            arguments: vec![std::ptr::null(); work.arguments],
            results: vec![std::ptr::null_mut(); work.results],
            integers: vec![0; work.integers],
            reals: vec![0.0; work.reals],
        })
    }

    /// The Runge–Kutta method of order 4, a call a step and a call a flight.
    pub(crate) fn solvers(&self, flights: &Rc<Flights>) -> Result<Vec<Solver>, String> {
        let mut step = self.step("dcom_runge_kutta")?;
        let one = move |flight: &Flight, count: u64| {
            let (u, p) = (flight.input.to_array(), flight.parameters.to_array());
            let h = [END / count as f64];
            let mut x = flight.start.to_array();
            for _ in 0..count {
                x = step.call([&x, &u, &p, &h]);
            }
            Ok(x)
        };
        let mut loops = BTreeMap::new();
        for name in self.said.keys() {
            if let Some(count) = name.strip_prefix("dcom_rk_") {
                let count: u64 = count.parse().map_err(|_| format!("error: {name}?"))?;
                loops.insert(count, self.step(name)?);
            }
        }
        let lengths = loops.keys().map(|&count| count as f64).collect();
        let whole = move |flight: &Flight, count: u64| {
            let constants = flight.input.to_array().into_iter();
            let constants: Vec<f64> = constants.chain(flight.parameters.to_array()).collect();
            let step = loops.get_mut(&count).ok_or("no loop of this length")?;
            Ok(step.call([&flight.start.to_array(), &constants]))
        };
        Ok(vec![
            solver("CasADi RK4 in C, a call a step", steps(3, 16), one, flights),
            solver("CasADi `rk` in C, a call a flight", lengths, whole, flights),
        ])
    }
}

fn solver(
    name: &str,
    settings: Vec<f64>,
    mut fly: impl FnMut(&Flight, u64) -> Result<[f64; STATES], String> + 'static,
    flights: &Rc<Flights>,
) -> Solver {
    let flights = Rc::clone(flights);
    let solve = move |request: &Request| {
        let flight = flights
            .all
            .get(request.flight)
            .ok_or("error: no such flight")?;
        let steps = request.setting as u64;
        let state = fly(flight, steps)?;
        let begin = Instant::now();
        for _ in 0..request.repeats {
            black_box(fly(flight, black_box(steps))?);
        }
        Ok(Solution {
            seconds: begin.elapsed().as_secs_f64() / f64::from(request.repeats.max(1)),
            state,
            steps,
            drifts: 4 * steps,
            jacobians: 0,
        })
    };
    Solver {
        name: name.to_owned(),
        settings,
        solve: Box::new(solve),
    }
}

impl Step {
    /// The result for these arguments: one for each of the function, in its lengths, which the caller answers for.
    #[inline]
    pub(crate) fn call<const N: usize, const A: usize>(&mut self, inputs: [&[f64]; A]) -> [f64; N] {
        let mut result = [0.0; N];
        for (argument, input) in self.arguments.iter_mut().zip(inputs) {
            *argument = input.as_ptr();
        }
        if let Some(first) = self.results.first_mut() {
            *first = result.as_mut_ptr();
        }
        // SAFETY: the arguments and the result have the lengths that the script gave the function, which are
        // those of the model's vectors; working memory is as long as CasADi says.
        unsafe {
            (self.function)(
                self.arguments.as_ptr(),
                self.results.as_mut_ptr(),
                self.integers.as_mut_ptr(),
                self.reals.as_mut_ptr(),
                0,
            );
        }
        black_box(result)
    }
}
