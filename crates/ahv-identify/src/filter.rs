//! The extended Kalman filter: maximum likelihood of its innovations, by Fisher's scoring with Marquardt's damping.
//!
//! Unknowns are the parameters and the logarithm of each output's measurement noise. The mean flies by Runge–Kutta; the covariance
//! follows the generated ∂f/∂x and the diffusion. Innovations and their covariances are differentiated by the unknowns by central
//! differences of a hundredth of a standard error.

use std::ops::Range;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;

use crate::covariance::{Segment, corrected};
use crate::normal::{damped, inverse, size};
use crate::output_error::correlations;
use crate::whiteness;
use crate::{Estimate, IdentifyError, Problem};

/// Iterations after which the search has failed.
const MOST: usize = 60;
/// Step in standard errors at which it ends.
const CONVERGED: f64 = 1e-3;
/// Damping after which nothing gets better by any step.
const MOST_DAMPING: f64 = 1e8;
/// Difference for a derivative, in standard errors.
const DIFFERENCE: f64 = 1e-2;
/// The same before a standard error is known, over the value, or absolute for 0.
const FIRST: f64 = 1e-5;

/// Standard deviation of the logarithm of the measurement noise before the record: where the record does not show the noise, it stays
/// within some factor of 20 of where it starts; elsewhere that counts for nothing.
const VAGUE: f64 = 3.0;

/// Innovations and their covariances, segment by segment.
struct Passed {
    segments: Vec<Vec<(DVector<f64>, DMatrix<f64>)>>,
    /// Twice the negative logarithm of the likelihood, up to a constant.
    cost: f64,
}

/// Estimates parameters, of the drift or of the noise, by an extended Kalman filter. Measurement noise is estimated as well.
///
/// # Errors
///
/// [`IdentifyError`]
pub fn filter(problem: &Problem<'_>) -> Result<Estimate, IdentifyError> {
    if problem.model.channels() == 0 {
        let model = problem.model.name();
        return Err(IdentifyError::NoNoise { model });
    }
    let segments = problem.segments();
    let steps = segments.iter().map(|it| problem.steps(it));
    let search = Search {
        steps: steps.collect::<Result<_, _>>()?,
        noise: problem.first_noise().iter().map(|it| it.ln()).collect(),
        least: problem.least_noise(),
        problem,
        segments,
    };
    let numbers = problem.record.times.len() * problem.measured.len();
    let unknowns = problem.free.len() + problem.measured.len();
    if numbers <= unknowns {
        return Err(IdentifyError::Short { numbers, unknowns });
    }
    search.run()
}

struct Search<'a> {
    problem: &'a Problem<'a>,
    segments: Vec<Range<usize>>,
    steps: Vec<usize>,
    least: Vec<f64>,
    /// Logarithms of the measurement noise at the start of the search.
    noise: Vec<f64>,
}

/// Information, gradient, and normalised innovations with their slopes.
struct Slopes {
    information: DMatrix<f64>,
    right: DVector<f64>,
    segments: Vec<Segment>,
}

impl Search<'_> {
    fn run(&self) -> Result<Estimate, IdentifyError> {
        let mut unknowns = self.problem.first();
        unknowns.extend(&self.noise);
        let time = self.problem.record.times.first().copied().unwrap_or(0.0);
        let mut passed = self
            .pass(&unknowns)
            .ok_or(IdentifyError::Diverges { time })?;
        let first = |it: &f64| if *it == 0.0 { FIRST } else { FIRST * it.abs() };
        let mut differences: Vec<f64> = unknowns.iter().map(first).collect();
        let mut damping = 0.0;
        for iteration in 1..=MOST {
            let slopes = self.slopes(&unknowns, &passed, &differences)?;
            let bound = inverse(&slopes.information).map_err(|it| self.idle(&it))?;
            differences = bound
                .diagonal()
                .iter()
                .map(|it| DIFFERENCE * it.sqrt())
                .collect();
            let found = loop {
                let solved = inverse(&damped(&slopes.information, damping));
                let step = solved.map_err(|it| self.idle(&it))? * &slopes.right;
                let size = size(&step, &bound);
                let mut next: Vec<f64> = unknowns
                    .iter()
                    .zip(step.iter())
                    .map(|(a, b)| a + b)
                    .collect();
                let noise = next.iter_mut().skip(self.problem.free.len());
                noise
                    .zip(&self.least)
                    .for_each(|(it, least)| *it = it.max(least.ln()));
                match self.pass(&next) {
                    Some(passed_next) if passed_next.cost <= passed.cost => {
                        break Some((next, passed_next, size));
                    }
                    _ if size < CONVERGED || damping > MOST_DAMPING => break None,
                    _ => damping = (10.0 * damping).max(1e-3),
                }
            };
            // The first derivatives are rough.
            let rough = iteration == 1;
            let Some((next, next_passed, size)) = found else {
                return self.outcome(&unknowns, &passed, &differences, iteration);
            };
            (unknowns, passed) = (next, next_passed);
            damping = if damping < 1e-4 { 0.0 } else { 0.1 * damping };
            if size < CONVERGED && !rough {
                return self.outcome(&unknowns, &passed, &differences, iteration);
            }
        }
        Err(IdentifyError::NoConvergence { iterations: MOST })
    }

    fn idle(&self, places: &[usize]) -> IdentifyError {
        let names = [
            self.problem.parameter_names(),
            self.problem.measured.clone(),
        ]
        .concat();
        match self.problem.idle(&[]) {
            IdentifyError::Unobservable { why, .. } => IdentifyError::Unobservable {
                names: places
                    .iter()
                    .filter_map(|&it| names.get(it).copied())
                    .collect(),
                why,
            },
            other => other,
        }
    }

    /// The filter over the record; `None` where it leaves what numbers can be.
    fn pass(&self, unknowns: &[f64]) -> Option<Passed> {
        let all = self.problem.with(unknowns);
        let noise = unknowns.iter().skip(self.problem.free.len());
        let noise = DVector::from_iterator(self.least.len(), noise.map(|it| (2.0 * it).exp()));
        let segments = self.segments.iter().zip(&self.steps);
        let segments = segments.map(|(segment, &steps)| self.segment(&all, &noise, segment, steps));
        let segments: Vec<_> = segments.collect::<Option<_>>()?;
        let mut cost = 0.0;
        for (innovation, covariance) in segments.iter().flatten() {
            let root = Cholesky::new(covariance.clone())?;
            let diagonal = root.l_dirty().diagonal();
            let normalised = root.l().solve_lower_triangular(innovation)?;
            cost +=
                2.0 * diagonal.iter().map(|it| it.ln()).sum::<f64>() + normalised.norm_squared();
        }
        let noise = unknowns.iter().skip(self.problem.free.len());
        let vague = noise
            .zip(&self.noise)
            .map(|(it, first)| ((it - first) / VAGUE).powi(2));
        cost += vague.sum::<f64>();
        cost.is_finite().then_some(Passed { segments, cost })
    }

    fn segment(
        &self,
        p: &[f64],
        noise: &DVector<f64>,
        segment: &Range<usize>,
        steps: usize,
    ) -> Option<Vec<(DVector<f64>, DMatrix<f64>)>> {
        let (problem, record) = (self.problem, &self.problem.record);
        let mut x = problem.start_of(segment.start);
        let variances = problem.deviation.iter().map(|it| it * it);
        let mut covariance = DMatrix::from_diagonal(&DVector::from_iterator(x.len(), variances));
        let r = DMatrix::from_diagonal(noise);
        let one = DMatrix::identity(x.len(), x.len());
        let mut innovations = Vec::with_capacity(segment.len());
        for sample in segment.clone() {
            if sample > segment.start {
                let u = &record.inputs[sample - 1];
                let h = (record.times[sample] - record.times[sample - 1]) / steps as f64;
                for _ in 0..steps {
                    covariance = self.spread(p, &x, u, h, &covariance);
                    problem.step(p, &mut x, u, h);
                }
            }
            if x.iter().any(|it| !it.is_finite()) {
                return None;
            }
            let seen = problem.see(p, &x, &record.inputs[sample], false)?;
            let innovation = DVector::from_row_slice(&record.outputs[sample]) - &seen.outputs;
            let across = &covariance * seen.by_state.transpose();
            let own = &seen.by_state * &across + &r;
            let own = (&own + own.transpose()) * 0.5;
            let gain = Cholesky::new(own.clone())?
                .solve(&across.transpose())
                .transpose();
            let moved = &gain * &innovation;
            x.iter_mut()
                .zip(moved.iter())
                .for_each(|(x, moved)| *x += moved);
            // Joseph's form stays positive.
            let kept = &one - &gain * &seen.by_state;
            covariance = &kept * covariance * kept.transpose() + &gain * &r * gain.transpose();
            innovations.push((innovation, own));
        }
        Some(innovations)
    }

    /// The covariance after a step: Φ P Φᵀ and the noise by Simpson's rule, Φ to the fourth order.
    fn spread(
        &self,
        p: &[f64],
        x: &[f64],
        u: &[f64],
        h: f64,
        before: &DMatrix<f64>,
    ) -> DMatrix<f64> {
        let a = self.problem.model.state_jacobian(p, x, u);
        let g = self.problem.model.diffusion(p, x, u);
        let n = x.len();
        let one = DMatrix::<f64>::identity(n, n);
        let transition = |h: f64| {
            let b = &a * h;
            let tail = &one + &b * 0.25;
            let tail = &one + &b * (1.0 / 3.0) * tail;
            let tail = &one + &b * 0.5 * tail;
            &one + &b * tail
        };
        let (half, whole) = (transition(0.5 * h), transition(h));
        let (at_half, at_whole) = (&half * &g, &whole * &g);
        let noise = &g * g.transpose()
            + &at_half * at_half.transpose() * 4.0
            + &at_whole * at_whole.transpose();
        &whole * before * whole.transpose() + noise * (h / 6.0)
    }

    fn slopes(
        &self,
        unknowns: &[f64],
        passed: &Passed,
        differences: &[f64],
    ) -> Result<Slopes, IdentifyError> {
        let time = self.problem.record.times.first().copied().unwrap_or(0.0);
        let pairs: Vec<[Passed; 2]> = (0..unknowns.len())
            .into_par_iter()
            .map(|index| {
                let at = |sign: f64| {
                    let mut moved = unknowns.to_vec();
                    moved[index] += sign * differences[index];
                    self.pass(&moved).ok_or(IdentifyError::Diverges { time })
                };
                Ok([at(1.0)?, at(-1.0)?])
            })
            .collect::<Result<_, IdentifyError>>()?;
        let many = unknowns.len();
        let gradient = pairs.iter().zip(differences);
        let gradient = gradient.map(|([up, down], h)| (down.cost - up.cost) / (4.0 * h));
        let mut slopes = Slopes {
            information: DMatrix::zeros(many, many),
            right: DVector::from_iterator(many, gradient),
            segments: Vec::with_capacity(passed.segments.len()),
        };
        for index in self.problem.free.len()..many {
            slopes.information[(index, index)] += 1.0 / (VAGUE * VAGUE);
        }
        for (place, segment) in passed.segments.iter().enumerate() {
            let mut of_segment = Segment {
                residuals: Vec::with_capacity(segment.len()),
                slopes: Vec::with_capacity(segment.len()),
            };
            for (sample, (innovation, covariance)) in segment.iter().enumerate() {
                let diverges = || IdentifyError::Diverges { time };
                let root = Cholesky::new(covariance.clone()).ok_or_else(diverges)?.l();
                let solve =
                    |it: &DMatrix<f64>| root.solve_lower_triangular(it).ok_or_else(diverges);
                let mut columns = Vec::with_capacity(many);
                let mut spreads = Vec::with_capacity(many);
                for ([up, down], h) in pairs.iter().zip(differences) {
                    let (up, down) = (&up.segments[place][sample], &down.segments[place][sample]);
                    columns.push((&down.0 - &up.0) / (2.0 * h));
                    let spread = solve(&((&up.1 - &down.1) / (2.0 * h)))?;
                    spreads.push(solve(&spread.transpose())?);
                }
                let columns = solve(&DMatrix::from_columns(&columns))?;
                slopes.information += columns.tr_mul(&columns);
                for (row, a) in spreads.iter().enumerate() {
                    for (column, b) in spreads.iter().enumerate() {
                        slopes.information[(row, column)] += 0.5 * a.dot(b);
                    }
                }
                let normalised = root
                    .solve_lower_triangular(innovation)
                    .ok_or_else(diverges)?;
                of_segment.residuals.push(normalised);
                of_segment.slopes.push(columns);
            }
            slopes.segments.push(of_segment);
        }
        Ok(slopes)
    }

    fn outcome(
        &self,
        unknowns: &[f64],
        passed: &Passed,
        differences: &[f64],
        iterations: usize,
    ) -> Result<Estimate, IdentifyError> {
        let slopes = self.slopes(unknowns, passed, differences)?;
        let bound = inverse(&slopes.information).map_err(|it| self.idle(&it))?;
        let covariance = corrected(&slopes.information, &bound, &slopes.segments);
        let many = self.problem.free.len();
        let residuals: Vec<_> = slopes.segments.into_iter().map(|it| it.residuals).collect();
        let innovations = passed.segments.iter().flatten();
        let fitted = self.problem.record.outputs.iter().zip(innovations);
        let fitted = fitted.map(|(z, (v, _))| z.iter().zip(v.iter()).map(|(z, v)| z - v).collect());
        let outputs = 0..self.least.len();
        Ok(Estimate {
            parameters: self.problem.estimated(unknowns, &bound, &covariance),
            correlations: correlations(&covariance.view((0, 0), (many, many)).into_owned()),
            noise: unknowns.iter().skip(many).map(|it| it.exp()).collect(),
            whiteness: outputs.map(|it| whiteness::test(&residuals, it)).collect(),
            fitted: fitted.collect(),
            iterations,
            segments: self.segments.len(),
            log_likelihood: -0.5 * passed.cost,
        })
    }
}

impl Problem<'_> {
    /// Measurement noise from the third differences of the samples, to which smooth motion adds little.
    fn first_noise(&self) -> Vec<f64> {
        let rows = &self.record.outputs;
        let of = |(output, least): (usize, &f64)| {
            let differences = rows.windows(4).map(|it| {
                it[3][output] - 3.0 * it[2][output] + 3.0 * it[1][output] - it[0][output]
            });
            let sum: f64 = differences.map(|it| it * it / 20.0).sum();
            (sum / rows.len() as f64).sqrt().max(*least)
        };
        self.least_noise().iter().enumerate().map(of).collect()
    }
}
