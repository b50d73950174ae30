//! Ensembles of a flexible mode beside its three reductions.
//!
//! The law of a step is exact, whatever its length. Noise is a function of seed, member, channel and step, and sums run
//! in the order of the members: results do not depend on the number of threads.

use std::ops::Range;

use ahv_analysis::statistics::deviation_of;
use ahv_integrate::{LinearTransition, NormalStream};
use rayon::prelude::*;

use crate::reduce::{Mode, ReduceError, ReducedMode, Reduction};

/// η, η̇ and χ.
const STATES: usize = 3;
/// Methods of reduction.
const METHODS: usize = Reduction::ALL.len();
/// Processes that are compared: η and χ by each method.
pub const PROCESSES: usize = 1 + METHODS;
/// Channels of noise that a mode may use.
const CHANNELS: u64 = 8;
/// Runs whose sums one task takes.
const CHUNK: u64 = 50;
/// Tasks whose sums are in memory at a time.
const GROUP: usize = 32;

/// How N(0, σ² δ(t)) is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reading {
    /// White noise of intensity σ².
    White,
    /// A number of N(0, σ²) a step, held over it: intensity σ²·dt.
    Held,
}

/// Which noise drives χ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Drive {
    /// The noise of the mode.
    Common,
    /// A noise of its own.
    Independent,
}

/// An ensemble of runs from rest.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Experiment {
    /// Reading of the noise.
    pub reading: Reading,
    /// Noise of χ.
    pub drive: Drive,
    /// Runs.
    pub runs: u64,
    /// Steps of a run.
    pub steps: u64,
    /// Step size, in s.
    pub dt: f64,
    /// Seed of the noise.
    pub seed: u64,
}

/// Sample mean and standard deviation (n − 1) over time: at 0 and after each step.
#[derive(Clone, Debug, PartialEq)]
pub struct Moments {
    /// Mean, in the unit of η.
    pub mean: Vec<f64>,
    /// Standard deviation, in the unit of η.
    pub std: Vec<f64>,
}

/// Place of a method's χ among the processes; η is at 0.
pub fn process_of(method: Reduction) -> usize {
    1 + Reduction::ALL
        .iter()
        .position(|&other| other == method)
        .unwrap_or(0)
}

impl Experiment {
    /// Times of the samples, in s.
    pub fn times(&self) -> Vec<f64> {
        (0..=self.steps).map(|step| step as f64 * self.dt).collect()
    }

    /// Moments of each process over members `first..first + runs` of the mode number `index`.
    ///
    /// # Errors
    ///
    /// [`ReduceError`] for a mode or a step size without sense.
    pub fn moments(
        &self,
        mode: &Mode,
        index: u64,
        first: u64,
    ) -> Result<[Moments; PROCESSES], ReduceError> {
        let simulator = Simulator::new(self, mode, index)?;
        let chunks: Vec<u64> = (0..self.runs).step_by(CHUNK as usize).collect();
        let mut total = self.no_sums();
        // Chunks are added one by one in order, so that threads do not matter.
        for group in chunks.chunks(GROUP) {
            let sums = group.par_iter().map(|&start| {
                let runs = start..(start + CHUNK).min(self.runs);
                self.sums(&simulator, first + runs.start..first + runs.end)
            });
            for sums in sums.collect::<Vec<Sums>>() {
                for (total, sums) in total.iter_mut().flatten().zip(sums.iter().flatten()) {
                    total[0] += sums[0];
                    total[1] += sums[1];
                }
            }
        }
        Ok(std::array::from_fn(|process| {
            moments(&total, process, self.runs as f64)
        }))
    }

    fn no_sums(&self) -> Sums {
        vec![[[0.0; 2]; PROCESSES]; self.steps as usize]
    }

    fn sums(&self, simulator: &Simulator<'_>, members: Range<u64>) -> Sums {
        let mut sums = self.no_sums();
        for member in members {
            let mut rows = sums.iter_mut();
            simulator.run(member, |processes| {
                let Some(row) = rows.next() else { return };
                for (sums, value) in row.iter_mut().zip(processes) {
                    sums[0] += value;
                    sums[1] += value * value;
                }
            });
        }
        sums
    }

    /// The processes at the end of each run, member by member.
    ///
    /// # Errors
    ///
    /// As [`Self::moments`].
    pub fn ends(&self, mode: &Mode, index: u64) -> Result<[Vec<f64>; PROCESSES], ReduceError> {
        let simulator = Simulator::new(self, mode, index)?;
        let ends: Vec<[f64; PROCESSES]> = (0..self.runs)
            .into_par_iter()
            .map(|run| {
                let mut end = [0.0; PROCESSES];
                simulator.run(run, |processes| end = processes);
                end
            })
            .collect();
        Ok(std::array::from_fn(|process| {
            ends.iter().map(|end| end[process]).collect()
        }))
    }
}

impl Experiment {
    /// The transition of η, η̇ and χ over a step; held noise is a force, and none of the transition's.
    pub(crate) fn transition(
        &self,
        reduced: &ReducedMode,
    ) -> Result<LinearTransition<f64, STATES>, ReduceError> {
        let Mode { omega, zeta, sigma } = reduced.mode;
        let (decay, intensity) = (reduced.decay(), reduced.intensity());
        let a = [
            [0.0, 1.0, 0.0],
            [-omega * omega, -2.0 * zeta * omega, 0.0],
            [0.0, 0.0, -decay],
        ];
        let both = match self.drive {
            Drive::Common => sigma * intensity,
            Drive::Independent => 0.0,
        };
        let noise = match self.reading {
            Reading::White => [
                [0.0; STATES],
                [0.0, sigma * sigma, both],
                [0.0, both, intensity * intensity],
            ],
            Reading::Held => [[0.0; STATES]; STATES],
        };
        Ok(LinearTransition::new(a, noise, self.dt)?)
    }
}

/// Sums of the values and of their squares, by step and process.
type Sums = Vec<[[f64; 2]; PROCESSES]>;

/// The processes have mean 0: nothing cancels in the sum of squares.
fn moments(sums: &Sums, process: usize, runs: f64) -> Moments {
    let mut moments = Moments {
        mean: vec![0.0],
        std: vec![0.0],
    };
    for row in sums {
        let [sum, squares] = row[process];
        let mean = sum / runs;
        let variance = (squares - runs * mean * mean) / (runs - 1.0).max(1.0);
        moments.mean.push(mean);
        moments.std.push(deviation_of(variance));
    }
    moments
}

/// One mode with its three reductions, ready to run.
///
/// Each method has a transition of its own, of η, η̇ and its χ, and all take the same normal numbers: every pair (η, χ) has
/// its exact law, and η is the same in all of them.
struct Simulator<'a> {
    experiment: &'a Experiment,
    steps: [LinearTransition<f64, STATES>; METHODS],
    sigma: f64,
    /// b of each χ.
    intensities: [f64; METHODS],
    channel: u64,
}

impl<'a> Simulator<'a> {
    fn new(experiment: &'a Experiment, mode: &Mode, index: u64) -> Result<Self, ReduceError> {
        let [printed, variance, moment] = Reduction::ALL.map(|method| {
            let reduced = ReducedMode::new(*mode, method)?;
            let step = experiment.transition(&reduced)?;
            Ok::<_, ReduceError>((step, reduced.intensity()))
        });
        let methods = [printed?, variance?, moment?];
        Ok(Self {
            experiment,
            steps: methods.map(|(step, _)| step),
            sigma: mode.sigma,
            intensities: methods.map(|(_, intensity)| intensity),
            channel: CHANNELS * index,
        })
    }

    /// Runs member `member`, and tells the processes after each step.
    fn run(&self, member: u64, mut tell: impl FnMut([f64; PROCESSES])) {
        let Experiment {
            reading,
            drive,
            steps,
            seed,
            ..
        } = *self.experiment;
        let mut streams: [NormalStream; STATES] = std::array::from_fn(|channel| {
            NormalStream::new(seed, member, self.channel + channel as u64)
        });
        let mut x = [[0.0; STATES]; METHODS];
        for step in 0..steps {
            let (mut normals, mut held) = ([0.0; STATES], [0.0; 2]);
            match (reading, drive) {
                (Reading::White, _) => {
                    normals = streams.each_mut().map(|stream| stream.normal(step))
                }
                (Reading::Held, Drive::Common) => held = [streams[0].normal(step); 2],
                (Reading::Held, Drive::Independent) => {
                    held = [streams[0].normal(step), streams[1].normal(step)];
                }
            }
            for ((x, transition), intensity) in x.iter_mut().zip(&self.steps).zip(self.intensities)
            {
                let force = [0.0, self.sigma * held[0], intensity * held[1]];
                *x = transition.step(x, &force, &normals);
            }
            let [printed, variance, moment] = x;
            tell([printed[0], printed[2], variance[2], moment[2]]);
        }
    }
}
