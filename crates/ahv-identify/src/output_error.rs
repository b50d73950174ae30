//! Output error: maximum likelihood without process noise, by Gauss and Newton with Marquardt's damping.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use crate::covariance::{Segment, corrected};
use crate::normal::{damped, inverse, size};
use crate::whiteness;
use crate::{Estimate, IdentifyError, Parameter, Problem};

/// Iterations after which the search has failed.
const MOST: usize = 100;
/// Step in standard errors at which it ends.
const CONVERGED: f64 = 1e-6;
/// Damping after which nothing gets better by any step.
const MOST_DAMPING: f64 = 1e10;
/// Least noise of an output, over the range of its samples: rounding of the record.
const LEAST_NOISE: f64 = 1e-10;

const IDLE: &str =
    "its effect on the measured outputs is none, or that of the others; leave it out, or fly more";
const START: &str = "the measured outputs do not show these states at the start of a segment; measure them, or hold them at their start";

/// A flight of one segment: residuals, and their slopes by parameters and by the initial state.
struct Flown {
    residuals: Vec<DVector<f64>>,
    by_parameter: Vec<DMatrix<f64>>,
    by_start: Vec<DMatrix<f64>>,
}

/// What is estimated: parameters, and the state at the start of each segment.
#[derive(Clone)]
struct Unknowns {
    parameters: Vec<f64>,
    starts: Vec<Vec<f64>>,
}

/// Normal equations of a segment.
struct Equations {
    pp: DMatrix<f64>,
    px: DMatrix<f64>,
    xx: DMatrix<f64>,
    p: DVector<f64>,
    x: DVector<f64>,
}

/// Estimates parameters by output error. The noise of each output is estimated as well.
///
/// # Errors
///
/// [`IdentifyError`]
pub fn output_error(problem: &Problem<'_>) -> Result<Estimate, IdentifyError> {
    Search::new(problem)?.run()
}

struct Search<'a> {
    problem: &'a Problem<'a>,
    segments: Vec<Range<usize>>,
    steps: Vec<usize>,
    /// States that are estimated at the start of segments.
    loose: Vec<usize>,
    least: Vec<f64>,
}

impl<'a> Search<'a> {
    fn new(problem: &'a Problem<'a>) -> Result<Self, IdentifyError> {
        let segments = problem.segments();
        let states = 0..problem.model.states().len();
        let loose: Vec<usize> = states.filter(|it| !problem.held.contains(it)).collect();
        let steps = segments.iter().map(|it| problem.steps(it));
        let search = Self {
            steps: steps.collect::<Result<_, _>>()?,
            least: problem.least_noise(),
            problem,
            segments,
            loose,
        };
        let numbers = problem.record.times.len() * problem.measured.len();
        let unknowns = search.unknowns();
        if numbers <= unknowns {
            return Err(IdentifyError::Short { numbers, unknowns });
        }
        Ok(search)
    }

    /// Number of all that is estimated.
    fn unknowns(&self) -> usize {
        let of_all = self.problem.free.len() + self.problem.measured.len();
        of_all + self.segments.len() * self.loose.len()
    }

    fn run(&self) -> Result<Estimate, IdentifyError> {
        let mut unknowns = Unknowns {
            parameters: self.problem.first(),
            starts: self
                .segments
                .iter()
                .map(|it| self.problem.start_of(it.start))
                .collect(),
        };
        let mut flown = self.fly(&unknowns)?;
        let mut noise = self.noise(&flown);
        let mut damping = 0.0;
        for iteration in 1..=MOST {
            let equations: Vec<_> = flown.iter().map(|it| it.equations(&noise)).collect();
            let step = loop {
                let (step, size) = self.step(&equations, damping)?;
                let next = self.moved(&unknowns, &step);
                let found = self.fly(&next).ok().map(|flown| {
                    let noise = self.noise(&flown);
                    (next, flown, noise)
                });
                match found {
                    Some(found) if merit(&found.2) <= merit(&noise) => break Some((found, size)),
                    _ if size < CONVERGED || damping > MOST_DAMPING => break None,
                    _ => damping = (10.0 * damping).max(1e-3),
                }
            };
            let Some((found, size)) = step else {
                return self.outcome(&unknowns, &flown, &noise, iteration);
            };
            (unknowns, flown, noise) = found;
            damping = if damping < 1e-4 { 0.0 } else { 0.1 * damping };
            if size < CONVERGED {
                return self.outcome(&unknowns, &flown, &noise, iteration);
            }
        }
        Err(IdentifyError::NoConvergence { iterations: MOST })
    }

    fn fly(&self, unknowns: &Unknowns) -> Result<Vec<Flown>, IdentifyError> {
        let all = self.problem.with(&unknowns.parameters);
        let segments = self
            .segments
            .par_iter()
            .zip(&self.steps)
            .zip(&unknowns.starts);
        let flown = segments.map(|((segment, &steps), start)| {
            let time = self.problem.record.times[segment.start];
            self.segment(&all, segment, steps, start)
                .ok_or(IdentifyError::Diverges { time })
        });
        flown.collect()
    }

    fn segment(
        &self,
        p: &[f64],
        segment: &Range<usize>,
        steps: usize,
        start: &[f64],
    ) -> Option<Flown> {
        let (problem, record) = (self.problem, &self.problem.record);
        let (n, many) = (start.len(), problem.free.len());
        let mut x = DVector::from_row_slice(start);
        let mut s = DMatrix::zeros(n, many + self.loose.len());
        for (column, &state) in self.loose.iter().enumerate() {
            s[(state, many + column)] = 1.0;
        }
        let mut flown = Flown {
            residuals: Vec::with_capacity(segment.len()),
            by_parameter: Vec::with_capacity(segment.len()),
            by_start: Vec::with_capacity(segment.len()),
        };
        for sample in segment.clone() {
            if sample > segment.start {
                let u = &record.inputs[sample - 1];
                let h = (record.times[sample] - record.times[sample - 1]) / steps as f64;
                for _ in 0..steps {
                    problem.step_with(p, &mut x, &mut s, u, h);
                }
            }
            if x.iter().chain(s.iter()).any(|it| !it.is_finite()) {
                return None;
            }
            let seen = problem.see(p, x.as_slice(), &record.inputs[sample], true)?;
            let measured = DVector::from_row_slice(&record.outputs[sample]);
            let residual = measured - &seen.outputs;
            if residual.iter().any(|it| !it.is_finite()) {
                return None;
            }
            let slopes = &seen.by_state * &s;
            flown.residuals.push(residual);
            flown
                .by_parameter
                .push(slopes.columns(0, many) + seen.by_parameter);
            flown
                .by_start
                .push(slopes.columns(many, self.loose.len()).into_owned());
        }
        Some(flown)
    }

    /// Standard deviation of the residuals of each output.
    fn noise(&self, flown: &[Flown]) -> Vec<f64> {
        let samples = self.problem.record.times.len() as f64;
        let of = |(output, least): (usize, &f64)| {
            let residuals = flown.iter().flat_map(|it| &it.residuals);
            let sum: f64 = residuals.map(|it| it[output] * it[output]).sum();
            (sum / samples).sqrt().max(*least)
        };
        self.least.iter().enumerate().map(of).collect()
    }

    /// A step of parameters and starts, the starts eliminated, and its size in standard errors of the parameters.
    fn step(&self, equations: &[Equations], damping: f64) -> Result<(Step, f64), IdentifyError> {
        let many = self.problem.free.len();
        let mut reduced = DMatrix::zeros(many, many);
        let mut right = DVector::zeros(many);
        let mut parts = Vec::with_capacity(equations.len());
        for it in equations {
            let xx = inverse(&damped(&it.xx, damping)).map_err(|places| self.unseen(&places))?;
            let through = &it.px * &xx;
            reduced += damped(&it.pp, damping) - &through * it.px.transpose();
            right += &it.p - &through * &it.x;
            parts.push(xx);
        }
        let covariance = inverse(&reduced).map_err(|places| self.problem.idle(&places))?;
        let parameters = &covariance * right;
        let starts = equations.iter().zip(parts);
        let starts = starts.map(|(it, xx)| xx * (&it.x - it.px.tr_mul(&parameters)));
        let size = size(&parameters, &covariance);
        let starts = starts.collect();
        Ok((Step { parameters, starts }, size))
    }

    fn unseen(&self, places: &[usize]) -> IdentifyError {
        let names = self.problem.model.states().names;
        IdentifyError::Unobservable {
            names: places.iter().map(|&it| names[self.loose[it]]).collect(),
            why: START,
        }
    }

    fn moved(&self, from: &Unknowns, step: &Step) -> Unknowns {
        let mut moved = from.clone();
        let parameters = moved.parameters.iter_mut().zip(step.parameters.iter());
        parameters.for_each(|(value, step)| *value += step);
        for (start, step) in moved.starts.iter_mut().zip(&step.starts) {
            for (&state, step) in self.loose.iter().zip(step.iter()) {
                start[state] += step;
            }
        }
        moved
    }

    fn outcome(
        &self,
        unknowns: &Unknowns,
        flown: &[Flown],
        noise: &[f64],
        iterations: usize,
    ) -> Result<Estimate, IdentifyError> {
        let many = self.problem.free.len();
        let weights = DMatrix::from_diagonal(&DVector::from_iterator(
            noise.len(),
            noise.iter().map(|it| 1.0 / it),
        ));
        let mut information = DMatrix::zeros(many, many);
        let mut segments = Vec::with_capacity(flown.len());
        for it in flown {
            let equations = it.equations(noise);
            let xx = inverse(&equations.xx).map_err(|places| self.unseen(&places))?;
            let through = &equations.px * xx;
            information += &equations.pp - &through * equations.px.transpose();
            let slopes = it.by_parameter.iter().zip(&it.by_start);
            let slopes = slopes.map(|(p, x)| &weights * (p - x * through.transpose()));
            segments.push(Segment {
                residuals: it.residuals.iter().map(|it| &weights * it).collect(),
                slopes: slopes.collect(),
            });
        }
        let bound = inverse(&information).map_err(|places| self.problem.idle(&places))?;
        // Residuals of a fit are smaller than the noise.
        let numbers = (self.problem.record.times.len() * noise.len()) as f64;
        let fitted = self.unknowns() - noise.len();
        let share = numbers / (numbers - fitted as f64);
        let covariance = corrected(&information, &bound, &segments) * share;
        let bound = bound * share;
        let residuals: Vec<_> = segments.into_iter().map(|it| it.residuals).collect();
        let measured = self.problem.record.outputs.iter();
        let fitted = measured.zip(flown.iter().flat_map(|it| &it.residuals));
        let fitted = fitted.map(|(z, v)| z.iter().zip(v.iter()).map(|(z, v)| z - v).collect());
        Ok(Estimate {
            parameters: self
                .problem
                .estimated(&unknowns.parameters, &bound, &covariance),
            correlations: correlations(&covariance),
            noise: noise.to_vec(),
            whiteness: (0..noise.len())
                .map(|it| whiteness::test(&residuals, it))
                .collect(),
            fitted: fitted.collect(),
            iterations,
            segments: self.segments.len(),
            log_likelihood: -merit(noise) * self.problem.record.times.len() as f64,
        })
    }
}

/// A step of all unknowns.
struct Step {
    parameters: DVector<f64>,
    starts: Vec<DVector<f64>>,
}

/// The negative logarithm of the likelihood of a sample, up to a constant, where the noise is that of the residuals.
fn merit(noise: &[f64]) -> f64 {
    noise.iter().map(|it| it.ln()).sum()
}

impl Flown {
    fn equations(&self, noise: &[f64]) -> Equations {
        let weights = DVector::from_iterator(noise.len(), noise.iter().map(|it| 1.0 / (it * it)));
        let weighted = |matrix: &DMatrix<f64>| {
            let mut weighted = matrix.clone();
            for (mut row, weight) in weighted.row_iter_mut().zip(weights.iter()) {
                row *= *weight;
            }
            weighted
        };
        let (many, loose) = match (self.by_parameter.first(), self.by_start.first()) {
            (Some(p), Some(x)) => (p.ncols(), x.ncols()),
            _ => (0, 0),
        };
        let mut sums = Equations {
            pp: DMatrix::zeros(many, many),
            px: DMatrix::zeros(many, loose),
            xx: DMatrix::zeros(loose, loose),
            p: DVector::zeros(many),
            x: DVector::zeros(loose),
        };
        let samples = self
            .residuals
            .iter()
            .zip(&self.by_parameter)
            .zip(&self.by_start);
        for ((residual, p), x) in samples {
            let (weighted_p, weighted_x) = (weighted(p), weighted(x));
            sums.pp += p.tr_mul(&weighted_p);
            sums.px += p.tr_mul(&weighted_x);
            sums.xx += x.tr_mul(&weighted_x);
            sums.p += weighted_p.tr_mul(residual);
            sums.x += weighted_x.tr_mul(residual);
        }
        sums
    }
}

impl Problem<'_> {
    /// Noise of each output below which it is rounding of the record.
    pub(crate) fn least_noise(&self) -> Vec<f64> {
        let of = |output: usize| {
            let values = self.record.outputs.iter().map(|row| row[output]);
            let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), it| {
                (a.min(it), b.max(it))
            });
            (LEAST_NOISE * (high - low))
                .max(f64::EPSILON * high.abs().max(low.abs()))
                .max(f64::MIN_POSITIVE)
        };
        (0..self.measured.len()).map(of).collect()
    }

    pub(crate) fn idle(&self, places: &[usize]) -> IdentifyError {
        let names = self.parameter_names();
        IdentifyError::Unobservable {
            names: places
                .iter()
                .filter_map(|&it| names.get(it).copied())
                .collect(),
            why: IDLE,
        }
    }

    pub(crate) fn estimated(
        &self,
        values: &[f64],
        bound: &DMatrix<f64>,
        covariance: &DMatrix<f64>,
    ) -> Vec<Parameter> {
        let all = self.free.iter().zip(values).enumerate();
        all.map(|(place, (&index, &value))| Parameter {
            index,
            value,
            white_error: bound[(place, place)].sqrt(),
            // Below the bound, a correction is an accident of the sample.
            standard_error: covariance[(place, place)].max(bound[(place, place)]).sqrt(),
        })
        .collect()
    }
}

/// Correlations of a covariance.
pub(crate) fn correlations(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let n = covariance.nrows();
    let std = covariance.diagonal().map(f64::sqrt);
    DMatrix::from_fn(n, n, |row, column| {
        covariance[(row, column)] / (std[row] * std[column])
    })
}
