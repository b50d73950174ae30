//! The linear companion of each member: it starts off the nominal flight as far as the member does, sees the same normal numbers,
//! and moves by the slopes of the member's step at the start. Its variance is known without flying it.

use std::sync::atomic::Ordering;

use ahv_core::Real;
use nalgebra::DMatrix;

use super::arithmetic::Mode;
use super::batch::Noise;
use super::experiment::Experiment;
use super::lanes::{LANES, Packed};
use super::propagator::{Propagator, STEPS_PER_STOP_CHECK};
use super::scheme::MOST_NORMALS;
use crate::ordered::Control;

/// Difference of a state or an input by which a step is differentiated, for 1 and for each unit of its value.
const DIFFERENCE: f64 = 1e-6;
/// That of a normal number, of which a step is a polynomial or nearly so.
const DIFFERENCE_OF_NORMAL: f64 = 0.1;

/// How companions fly: z⁺ = F z + G ξ, of the deviations z of states and inputs and the normal numbers ξ.
pub(super) struct Companion {
    states: usize,
    /// Rows of F, then of G, without what is 0: column, factor.
    rows: Vec<[Vec<(usize, f64)>; 2]>,
    used: [bool; MOST_NORMALS],
    /// Variance of each state, snapshot by snapshot.
    pub(super) variances: Vec<Vec<f64>>,
}

impl Companion {
    /// Those of the members of an experiment.
    ///
    /// Differences are exact enough: the companion's variance is that of whatever F and G are, and only the correlation with the
    /// member is theirs.
    pub(super) fn new(experiment: &Experiment, propagator: &dyn Propagator) -> Self {
        let ([x, x_std], [u, u_std]) = (&experiment.state, &experiment.input);
        let (states, all) = (x.len(), x.len() + u.len());
        let point: Vec<f64> = x.iter().chain(u).copied().collect();
        let used = *propagator.used();
        let after = |point: &[f64], normals: &[f64; MOST_NORMALS]| {
            let (x, u) = point.split_at(states);
            propagator.after_step(x, u, normals)
        };
        // By state and input, of the state after a step.
        let mut step = DMatrix::zeros(states, all);
        for (column, &value) in point.iter().enumerate() {
            let difference = DIFFERENCE * (1.0 + value.abs());
            let at = |sign: f64| {
                let mut point = point.clone();
                point[column] = value + sign * difference;
                after(&point, &[0.0; MOST_NORMALS])
            };
            slopes(&mut step, column, &at(1.0), &at(-1.0), 2.0 * difference);
        }
        let mut by_normal = DMatrix::zeros(all, MOST_NORMALS);
        for column in (0..MOST_NORMALS).filter(|&column| used[column]) {
            let at = |sign: f64| {
                let mut normals = [0.0; MOST_NORMALS];
                normals[column] = sign * DIFFERENCE_OF_NORMAL;
                after(&point, &normals)
            };
            let width = 2.0 * DIFFERENCE_OF_NORMAL;
            slopes(&mut by_normal, column, &at(1.0), &at(-1.0), width);
        }
        // The law moves the inputs first, and the step holds them.
        let law = law(experiment, all);
        let mut transition = law.clone();
        let moved = step.columns(states, all - states) * law.rows(states, all - states);
        transition.rows_mut(0, states).copy_from(&moved);
        let mut own = transition.view_mut((0, 0), (states, states));
        own += step.columns(0, states);
        let start = x_std.iter().chain(u_std).map(|std| std * std);
        let start = DMatrix::from_diagonal(&nalgebra::DVector::from_iterator(all, start));
        Self {
            states,
            variances: variances(experiment, states, start, &transition, &by_normal),
            rows: (0..all)
                .map(|row| [sparse(&transition, row), sparse(&by_normal, row)])
                .collect(),
            used,
        }
    }

    /// The states of the companions of members, at most [`LANES`], snapshot by snapshot; `None` if the work was stopped.
    pub(super) fn fly(
        &self,
        experiment: &Experiment,
        members: &[u64],
        control: &Control,
    ) -> Option<Vec<Vec<f64>>> {
        // Lanes without member repeat the last one.
        let last = members.last().copied().unwrap_or(0);
        let lanes: [u64; LANES] =
            std::array::from_fn(|lane| members.get(lane).copied().unwrap_or(last));
        let single = experiment.mode == Mode::F32Noise;
        let mut noise = Noise::new(experiment.seed, lanes, &self.used, single);
        let mut z = vec![Packed::ZERO; self.rows.len()];
        for (lane, &member) in lanes.iter().enumerate() {
            let particle = experiment.particle(member);
            let ([x, _], [u, _]) = (&experiment.state, &experiment.input);
            let nominal = x.iter().chain(u);
            let own = particle.x.iter().chain(&particle.u);
            for ((z, own), nominal) in z.iter_mut().zip(own).zip(nominal) {
                z.0[lane] = own - nominal;
            }
        }
        let mut next = z.clone();
        let mut normals = [Packed::ZERO; MOST_NORMALS];
        let mut flown = vec![Vec::new(); members.len().min(LANES)];
        let mut step = 0;
        for &snapshot in &experiment.snapshots {
            while step < snapshot {
                if step % STEPS_PER_STOP_CHECK == 0 && control.stop.load(Ordering::Relaxed) {
                    return None;
                }
                noise.fill(&mut normals, step);
                for (next, [by_own, by_normal]) in next.iter_mut().zip(&self.rows) {
                    let mut sum = Packed::ZERO;
                    for &(column, factor) in by_own {
                        sum = sum + Packed::splat(factor) * z[column];
                    }
                    for &(column, factor) in by_normal {
                        sum = sum + Packed::splat(factor) * normals[column];
                    }
                    *next = sum;
                }
                std::mem::swap(&mut z, &mut next);
                step += 1;
            }
            for (lane, states) in flown.iter_mut().enumerate() {
                states.extend(z.iter().take(self.states).map(|z| z.0[lane]));
            }
        }
        Some(flown)
    }
}

/// Writes the central differences of a column. Where one is not finite the companion does without it.
fn slopes(matrix: &mut DMatrix<f64>, column: usize, above: &[f64], below: &[f64], width: f64) {
    let mut column = matrix.column_mut(column);
    for ((slope, above), below) in column.iter_mut().zip(above).zip(below) {
        let difference = (above - below) / width;
        if difference.is_finite() {
            *slope = difference;
        }
    }
}

/// How the law moves the deviations of the inputs at the start of a step, without the limits of its actuators; those of the states
/// have no rows.
fn law(experiment: &Experiment, all: usize) -> DMatrix<f64> {
    let states = experiment.state[0].len();
    let mut law = DMatrix::zeros(all, all);
    for input in states..all {
        law[(input, input)] = 1.0;
    }
    let Some(feedback) = &experiment.feedback else {
        return law;
    };
    for (input, actuator) in feedback.actuators.iter().enumerate() {
        let (row, Some(actuator)) = (states + input, actuator) else {
            continue;
        };
        let share = actuator.over(experiment.dt).share();
        law[(row, row)] = 1.0 - share;
        for state in 0..states {
            law[(row, state)] = -share * feedback.gain[(input, state)];
        }
    }
    law
}

/// The variances of the states at the snapshots: P⁺ = F P Fᵀ + G Gᵀ from the start on.
fn variances(
    experiment: &Experiment,
    states: usize,
    mut covariance: DMatrix<f64>,
    transition: &DMatrix<f64>,
    by_normal: &DMatrix<f64>,
) -> Vec<Vec<f64>> {
    let noise = by_normal * by_normal.transpose();
    let mut step = 0;
    let at = experiment.snapshots.iter().map(|&snapshot| {
        while step < snapshot {
            covariance = transition * &covariance * transition.transpose() + &noise;
            step += 1;
        }
        covariance.diagonal().iter().take(states).copied().collect()
    });
    at.collect()
}

/// The entries of a row that are not 0.
fn sparse(matrix: &DMatrix<f64>, row: usize) -> Vec<(usize, f64)> {
    let row = matrix.row(row);
    let entries = row.iter().copied().enumerate();
    entries.filter(|&(_, factor)| factor != 0.0).collect()
}
