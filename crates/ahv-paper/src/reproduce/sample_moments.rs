//! Sample mean and standard deviation over many runs, drawn from their own law.
//!
//! Runs x → Φ x + L z are normal and start at rest. The mean of n of them is then one such run over √n. The sum of squares
//! about it is S = X Xᵀ, with d rows and n − 1 independent normal columns. Let S = R Rᵀ. The part of the next noise along the rows
//! of X is a matrix G of standard normal numbers, and the rest is independent of it:
//! S → (Φ R + L G)(Φ R + L G)ᵀ + L W Lᵀ, where W is Wishart with n − 1 − d degrees of freedom (Bartlett 1933). The
//! law is exact, and an experiment of any number of runs costs as much as a few.

use ahv_integrate::NormalStream;

use crate::ensemble::{Drive, Experiment, Reading};
use crate::reduce::{Mode, ReduceError, ReducedMode};

/// η, η̇ and χ.
const STATES: usize = 3;
/// Share of a variance below which a pivot is rounding.
const ROUNDING: f64 = 1e-14;

type Vector = [f64; STATES];

/// The law of the sample moments of η and χ over the runs of an experiment.
pub(super) struct SampleMoments {
    transition: [Vector; STATES],
    /// Columns of L.
    noise: Vec<Vector>,
    runs: f64,
    steps: u64,
}

/// Standard normal numbers, one after the other.
struct Normals {
    stream: NormalStream,
    next: u64,
}

impl SampleMoments {
    /// The law for an experiment with the mode of `reduced`.
    ///
    /// # Errors
    ///
    /// [`ReduceError`] for a step size without sense, or too few runs.
    pub(super) fn new(experiment: &Experiment, reduced: &ReducedMode) -> Result<Self, ReduceError> {
        let step = experiment.transition(reduced)?;
        let zero = [0.0; STATES];
        let Mode { sigma, .. } = reduced.mode;
        let (eta, chi) = ([0.0, sigma, 0.0], [0.0, 0.0, reduced.intensity()]);
        let held = |force: Vector| step.step(&zero, &force, &zero);
        let noise = match (experiment.reading, experiment.drive) {
            (Reading::Held, Drive::Common) => vec![held([eta[0], eta[1], chi[2]])],
            (Reading::Held, Drive::Independent) => vec![held(eta), held(chi)],
            (Reading::White, _) => {
                let units = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
                units.map(|unit| step.free_step(&zero, &unit)).to_vec()
            }
        };
        let runs = experiment.runs as f64;
        let freedom = runs - (1 + STATES + noise.len()) as f64;
        if freedom < 1.0 {
            return Err(ReduceError::NotPositive {
                name: "number of runs less 7",
                value: freedom,
            });
        }
        Ok(Self {
            transition: *step.transition(),
            noise,
            runs,
            steps: experiment.steps,
        })
    }

    /// The greatest |e^m| and |e^D| over time, of mean and standard deviation, of experiment number `repeat`.
    pub(super) fn maxima(&self, seed: u64, repeat: u64, channel: u64) -> [f64; 2] {
        let mut normals = Normals {
            stream: NormalStream::new(seed, repeat, channel),
            next: 0,
        };
        let freedom = self.runs - 1.0;
        let (mut mean, mut root) = ([0.0; STATES], [[0.0; STATES]; STATES]);
        let mut maxima = [0.0_f64; 2];
        for _ in 0..self.steps {
            mean = applied(&self.transition, &mean);
            for column in &self.noise {
                add(&mut mean, column, normals.next() / self.runs.sqrt());
            }
            let squares = self.next_squares(&root, freedom, &mut normals);
            root = cholesky(&squares);
            let [[eta, ..], _, [.., chi]] = squares;
            let errors = [
                mean[0] - mean[2],
                (eta.sqrt() - chi.sqrt()) / freedom.sqrt(),
            ];
            for (largest, error) in maxima.iter_mut().zip(errors) {
                *largest = largest.max(error.abs());
            }
        }
        maxima
    }

    /// S after a step from S = R Rᵀ, with R = `root`.
    fn next_squares(
        &self,
        root: &[Vector; STATES],
        freedom: f64,
        normals: &mut Normals,
    ) -> [Vector; STATES] {
        let mut squares = [[0.0; STATES]; STATES];
        for column in 0..STATES {
            let mut moved = applied(&self.transition, &root.map(|row| row[column]));
            for noise in &self.noise {
                add(&mut moved, noise, normals.next());
            }
            add_square(&mut squares, &moved);
        }
        // W = T Tᵀ with a lower triangular T: normal numbers below the diagonal, roots of χ² on it.
        for (place, noise) in self.noise.iter().enumerate() {
            let mut column = [0.0; STATES];
            let chi_squared = normals.chi_squared(freedom - (STATES + place) as f64);
            add(&mut column, noise, chi_squared.sqrt());
            for below in self.noise.iter().skip(place + 1) {
                add(&mut column, below, normals.next());
            }
            add_square(&mut squares, &column);
        }
        squares
    }
}

impl Normals {
    fn next(&mut self) -> f64 {
        let normal = self.stream.normal(self.next);
        self.next += 1;
        normal
    }

    /// A χ² number with `freedom` of 2 or more degrees of freedom (Marsaglia and Tsang 2000).
    fn chi_squared(&mut self, freedom: f64) -> f64 {
        let d = 0.5 * freedom - 1.0 / 3.0;
        let c = 1.0 / (9.0 * d).sqrt();
        loop {
            let normal = self.next();
            let v = (1.0 + c * normal).powi(3);
            let uniform = 0.5 * libm::erfc(self.next() * std::f64::consts::FRAC_1_SQRT_2);
            if v > 0.0 && uniform.ln() < 0.5 * normal * normal + d * (1.0 - v + v.ln()) {
                return 2.0 * d * v;
            }
        }
    }
}

fn applied(matrix: &[Vector; STATES], x: &Vector) -> Vector {
    matrix.map(|row| row.iter().zip(x).map(|(a, b)| a * b).sum())
}

fn add(sum: &mut Vector, column: &Vector, factor: f64) {
    for (sum, entry) in sum.iter_mut().zip(column) {
        *sum += factor * entry;
    }
}

fn add_square(sum: &mut [Vector; STATES], column: &Vector) {
    for (row, &factor) in sum.iter_mut().zip(column) {
        add(row, column, factor);
    }
}

/// Lower triangular R with R Rᵀ = `squares`; a direction without variance gets a column of zeros.
fn cholesky(squares: &[Vector; STATES]) -> [Vector; STATES] {
    let mut root = [[0.0; STATES]; STATES];
    for column in 0..STATES {
        for row in column..STATES {
            let known: f64 = (0..column).map(|k| root[row][k] * root[column][k]).sum();
            let rest = squares[row][column] - known;
            root[row][column] = if row == column {
                if rest > ROUNDING * squares[row][row] {
                    rest.sqrt()
                } else {
                    0.0
                }
            } else if root[column][column] > 0.0 {
                rest / root[column][column]
            } else {
                0.0
            };
        }
    }
    root
}

#[cfg(test)]
mod tests {
    use ahv_analysis::statistics::{kolmogorov_smirnov, mean_and_std};

    use super::{NormalStream, Normals, SampleMoments};
    use crate::ensemble::{Drive, Experiment, Reading};
    use crate::reduce::{ReducedMode, Reduction, section_5_1};

    /// Maxima of 400 experiments whose runs are flown one by one, and of 400 drawn by their law, have one distribution.
    #[test]
    fn maxima_have_the_distribution_of_flown_ones() {
        let [mode, ..] = section_5_1();
        let reduced = ReducedMode::new(mode, Reduction::Printed).expect("a mode");
        for reading in [Reading::White, Reading::Held] {
            for drive in [Drive::Common, Drive::Independent] {
                let experiment = Experiment {
                    reading,
                    drive,
                    runs: 12,
                    steps: 25,
                    dt: 0.01,
                    seed: 11,
                };
                let law = SampleMoments::new(&experiment, &reduced).expect("a law");
                let repeats = 0..400_u64;
                let drawn: Vec<[f64; 2]> = repeats.clone().map(|it| law.maxima(5, it, 0)).collect();
                let flown: Vec<[f64; 2]> = repeats
                    .map(|repeat| {
                        let moments = experiment.moments(&mode, 0, repeat * experiment.runs);
                        let [eta, chi, ..] = moments.expect("an ensemble");
                        let largest = |a: &[f64], b: &[f64]| {
                            let errors = a.iter().zip(b).map(|(a, b)| (a - b).abs());
                            errors.fold(0.0, f64::max)
                        };
                        [largest(&eta.mean, &chi.mean), largest(&eta.std, &chi.std)]
                    })
                    .collect();
                for kind in 0..2 {
                    let of = |sample: &[[f64; 2]]| -> Vec<f64> {
                        sample.iter().map(|maxima| maxima[kind]).collect()
                    };
                    let (distance, critical) = kolmogorov_smirnov(&of(&drawn), &of(&flown));
                    // Eight looks: 1.3 times the 95 % point is that of 99.8 %.
                    assert!(
                        distance < 1.3 * critical,
                        "{reading:?} {drive:?} {kind}: {distance} {critical}"
                    );
                }
            }
        }
    }

    /// χ² with 2 degrees of freedom is exponential with the mean 2.
    #[test]
    fn chi_squared_with_two_degrees_is_exponential() {
        let mut normals = Normals {
            stream: NormalStream::new(3, 0, 0),
            next: 0,
        };
        let mut draws: Vec<f64> = (0..40_000).map(|_| normals.chi_squared(2.0)).collect();
        draws.sort_by(f64::total_cmp);
        let count = draws.len() as f64;
        let distances = (1..).zip(draws).map(|(rank, draw)| {
            let below = 1.0 - (-0.5 * draw).exp();
            (f64::from(rank) / count - below).abs()
        });
        let distance = distances.fold(0.0, f64::max);
        // The 99 % point of Kolmogorov's distribution.
        assert!(distance * count.sqrt() < 1.63, "{distance}");
    }

    /// After one step of noise that η and χ share, their runs are one normal sample times D_η and D_χ: of n runs, n e_m² and
    /// (n − 1) e_D², over (D_η − D_χ)², are χ² with 1 and n − 1 degrees of freedom.
    #[test]
    fn one_step_from_rest_has_the_moments_of_a_normal_sample() {
        let [mode, ..] = section_5_1();
        let reduced = ReducedMode::new(mode, Reduction::Printed).expect("a mode");
        let experiment = Experiment {
            reading: Reading::Held,
            drive: Drive::Common,
            runs: 6,
            steps: 1,
            dt: 0.01,
            seed: 0,
        };
        let law = SampleMoments::new(&experiment, &reduced).expect("a law");
        let exact = reduced.std_errors_held(0.01, 1, 1).expect("a period")[1];
        let draws: Vec<[f64; 2]> = (0..20_000).map(|it| law.maxima(5, it, 0)).collect();
        for (kind, number, freedom) in [(0, 6.0, 1.0), (1, 5.0, 5.0)] {
            let squares = draws.iter().map(|draw| (draw[kind] / exact).powi(2));
            let (mean, std) = mean_and_std(&squares.map(|it| number * it).collect::<Vec<_>>());
            assert!((mean / freedom - 1.0).abs() < 0.05, "{kind}: {mean}");
            let variance = std * std / (2.0 * freedom);
            assert!((variance - 1.0).abs() < 0.1, "{kind}: {variance}");
        }
    }
}
