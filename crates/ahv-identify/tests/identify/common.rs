//! Records of known coefficients.

use std::marker::PhantomData;

use ahv_analysis::dual::{output_parameter_slopes, output_slopes};
use ahv_analysis::erased::{Components, values, vector};
use ahv_analysis::trim::{SteadyState, trim};
use ahv_core::{GeneratedModel, Vector};
use ahv_identify::{Dynamics, Estimate, IdentifyError, Problem, Record};
use ahv_integrate::NormalStream;
use ahv_models::{com_rigid, flexible_mode, sdcom};
use nalgebra::DMatrix;

/// A generated model, without all that is compiled for it behind `AnyModel`.
struct Plain<M>(PhantomData<fn() -> M>);

fn matrix<Row: Vector<f64>, Rows: Vector<Row>>(rows: &Rows) -> DMatrix<f64> {
    DMatrix::from_fn(Rows::LEN, Row::LEN, |row, column| {
        let row: Row = rows.get(row).expect("a row");
        row.get(column).expect("an entry")
    })
}

impl<M: GeneratedModel> Dynamics for Plain<M> {
    fn name(&self) -> &'static str {
        M::NAME
    }

    fn parameters(&self) -> Components {
        Components::of::<f64, M::ParametersOf<f64>>()
    }

    fn states(&self) -> Components {
        Components::of::<f64, M::State>()
    }

    fn outputs(&self) -> Components {
        Components::of::<f64, M::OutputsOf<f64>>()
    }

    fn channels(&self) -> usize {
        <M::Noise as Vector<f64>>::LEN
    }

    fn drift(&self, p: &[f64], x: &[f64], u: &[f64]) -> Vec<f64> {
        values(&M::with_parameters(&vector(p)).drift(&vector(x), &vector(u)))
    }

    fn state_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        let (by_state, _) = M::with_parameters(&vector(p)).jacobians(&vector(x), &vector(u));
        matrix::<M::State, _>(&by_state)
    }

    fn parameter_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        let model = M::with_parameters(&vector(p));
        matrix::<M::ParametersOf<f64>, _>(&model.parameter_jacobian(&vector(x), &vector(u)))
    }

    fn diffusion(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        let (model, x, u) = (M::with_parameters(&vector(p)), vector(x), vector(u));
        let columns = (0..self.channels()).map(|column| {
            let unit = M::Noise::from_fn(|it| f64::from(u8::from(it == column)));
            nalgebra::DVector::from_vec(values(&model.noise_increment(&x, &u, &unit)))
        });
        match columns.collect::<Vec<_>>() {
            columns if columns.is_empty() => DMatrix::zeros(M::State::LEN, 0),
            columns => DMatrix::from_columns(&columns),
        }
    }

    fn output_values(&self, p: &[f64], x: &[f64], u: &[f64]) -> Vec<f64> {
        let model = M::generic(&vector::<M::ParametersOf<f64>>(p));
        values(&M::outputs(&model, &vector(x), &vector(u)))
    }

    fn output_slopes(
        &self,
        p: &[f64],
        x: &[f64],
        u: &[f64],
        names: &[&str],
    ) -> Option<DMatrix<f64>> {
        let model = M::with_parameters(&vector(p));
        let slopes = output_slopes(&model, &vector(x), &vector(u));
        Some(DMatrix::from_fn(
            names.len(),
            x.len(),
            |row, column| match M::State::index_of(names[row]) {
                Some(state) => f64::from(u8::from(state == column)),
                None => {
                    let output = M::OutputsOf::<f64>::index_of(names[row]).expect("an output");
                    slopes[column].get(output).expect("an output")
                }
            },
        ))
    }

    fn output_parameter_jacobian(&self, p: &[f64], x: &[f64], u: &[f64]) -> DMatrix<f64> {
        let columns = (0..p.len()).map(|parameter| {
            let slopes =
                output_parameter_slopes::<M>(&vector(p), parameter, &vector(x), &vector(u));
            nalgebra::DVector::from_vec(values(&slopes))
        });
        DMatrix::from_columns(&columns.collect::<Vec<_>>())
    }
}

/// A way to estimate.
pub(crate) type Method = fn(&Problem<'_>) -> Result<Estimate, IdentifyError>;

/// A flight and what is asked of it.
pub(crate) struct Case {
    pub(crate) model: Box<dyn Dynamics>,
    pub(crate) parameters: Vec<f64>,
    pub(crate) free: Vec<&'static str>,
    /// Measured outputs with their noise.
    pub(crate) measured: Vec<(&'static str, f64)>,
    pub(crate) start: Vec<f64>,
    pub(crate) deviation: Vec<f64>,
    pub(crate) input: Vec<f64>,
    pub(crate) inputs: &'static [&'static str],
    /// Amplitude of a doublet of 1 s of this input.
    pub(crate) doublet: Option<(&'static str, f64)>,
    /// Whether the noise of the model flies.
    pub(crate) noisy: bool,
    pub(crate) samples: usize,
    pub(crate) dt: f64,
    pub(crate) segment: f64,
    pub(crate) held: Vec<&'static str>,
}

/// Steps of a flight between two samples.
const STEPS: u32 = 20;

/// The model with its own parameters, its trim, and names of its inputs.
struct Trimmed {
    model: Box<dyn Dynamics>,
    parameters: Vec<f64>,
    start: Vec<f64>,
    input: Vec<f64>,
    inputs: &'static [&'static str],
}

fn trimmed<M: GeneratedModel>() -> Trimmed {
    let parameters = M::SETS[0].parameters;
    let steady = SteadyState::new(&M::TRIM).within(&M::INPUT_BOUNDS);
    let trim = trim(&M::with_parameters(&parameters), &steady).expect("it trims");
    Trimmed {
        model: Box::new(Plain::<M>(PhantomData)),
        parameters: values(&parameters),
        start: values(&trim.state),
        input: values(&trim.input),
        inputs: M::Input::NAMES,
    }
}

impl Case {
    /// A mode that white noise drives; its position is measured.
    pub(crate) fn flexible_mode() -> Self {
        type Mode = flexible_mode::Model<f64>;
        let parameters = values(&<Mode as GeneratedModel>::SETS[0].parameters);
        let inputs: &[&str] = &<Mode as ahv_core::Model>::Input::NAMES;
        Self {
            free: vec!["omega", "zeta", "sigma"],
            measured: vec![("eta", 0.1)],
            start: vec![0.0; 3],
            deviation: vec![1e-3, 1e-2, 1e-3],
            input: vec![0.0; inputs.len()],
            inputs,
            doublet: None,
            noisy: true,
            samples: 400,
            dt: 0.02,
            segment: f64::INFINITY,
            held: Vec::new(),
            parameters,
            model: Box::new(Plain::<Mode>(PhantomData)),
        }
    }

    /// The stochastic model of the vehicle in gusts and with its coloured noise, off its trim, elevator moving.
    pub(crate) fn airframe() -> Self {
        let Trimmed {
            model,
            parameters,
            start,
            input,
            inputs,
        } = trimmed::<sdcom::Model<f64>>();
        let deviation = model.states().names.iter();
        let deviation = deviation.map(|name| match *name {
            "velocity" => 5.0,
            "altitude" => 20.0,
            "chi_1" | "chi_2" | "chi_3" => 1e-4,
            _ => 0.01,
        });
        Self {
            free: vec!["c_l_alpha", "c_m_alpha", "c_m_delta_e"],
            measured: vec![
                ("velocity", 1.0),
                ("gamma", 2e-4),
                ("alpha", 3e-4),
                ("pitch_rate", 5e-4),
            ],
            deviation: deviation.collect(),
            start,
            input,
            inputs,
            doublet: Some(("delta_e", 0.02)),
            noisy: true,
            samples: 60,
            dt: 0.05,
            segment: f64::INFINITY,
            held: Vec::new(),
            parameters,
            model,
        }
    }

    /// The rigid vehicle with measurement noise alone, in segments of a second.
    pub(crate) fn rigid() -> Self {
        let Trimmed {
            model,
            parameters,
            start,
            input,
            inputs,
        } = trimmed::<com_rigid::Model<f64>>();
        Self {
            free: vec!["c_l_alpha", "c_m_alpha", "c_m_delta_e"],
            measured: vec![
                ("velocity", 1.0),
                ("gamma", 2e-4),
                ("alpha", 3e-4),
                ("pitch_rate", 5e-4),
            ],
            deviation: vec![1.0; start.len()],
            start,
            input,
            inputs,
            doublet: Some(("delta_e", 0.02)),
            noisy: false,
            samples: 60,
            dt: 0.05,
            segment: 1.0,
            held: vec!["altitude"],
            parameters,
            model,
        }
    }

    fn place(&self, name: &str) -> usize {
        self.model.parameters().index_of(name).expect("a parameter")
    }

    /// The coefficients that made the records.
    pub(crate) fn truth(&self) -> Vec<f64> {
        let places = self.free.iter().map(|name| self.place(name));
        places.map(|it| self.parameters[it]).collect()
    }

    /// A flight with the noise of a seed.
    pub(crate) fn record(&self, seed: u64) -> Record {
        let (states, outputs) = (self.model.states(), self.measured.len() as u64);
        let mut wiener: Vec<NormalStream> = (0..self.model.channels() as u64)
            .map(|it| NormalStream::new(seed, 0, it))
            .collect();
        let mut sensors: Vec<NormalStream> = (0..outputs)
            .map(|it| NormalStream::new(seed, 1, 100 + it))
            .collect();
        let mut record = Record {
            times: Vec::new(),
            inputs: Vec::new(),
            outputs: Vec::new(),
        };
        let mut x = self.start.clone();
        for sample in 0..self.samples {
            let time = sample as f64 * self.dt;
            let mut u = self.input.clone();
            if let Some((name, size)) = self.doublet {
                let place = self
                    .inputs
                    .iter()
                    .position(|it| *it == name)
                    .expect("an input");
                u[place] += match time {
                    t if t < 0.5 => size,
                    t if t < 1.0 => -size,
                    _ => 0.0,
                };
            }
            let row = self
                .measured
                .iter()
                .zip(&mut sensors)
                .map(|((name, noise), sensor)| {
                    let place = states.index_of(name).expect("a state");
                    x[place] + noise * sensor.normal(sample as u64)
                });
            record.outputs.push(row.collect());
            record.times.push(time);
            record.inputs.push(u.clone());
            let steps = if self.noisy { STEPS } else { 4 * STEPS };
            let h = self.dt / f64::from(steps);
            for step in 0..steps {
                let number = u64::from(sample as u32 * steps + step);
                let (rate, half) = (self.model.drift(&self.parameters, &x, &u), 0.5 * h);
                let middle: Vec<f64> = x.iter().zip(&rate).map(|(x, f)| x + half * f).collect();
                let rate = self.model.drift(&self.parameters, &middle, &u);
                let g = self.model.diffusion(&self.parameters, &x, &u);
                x.iter_mut().zip(rate).for_each(|(x, f)| *x += h * f);
                for (channel, stream) in wiener.iter_mut().enumerate().filter(|_| self.noisy) {
                    let dw = h.sqrt() * stream.normal(number);
                    x.iter_mut()
                        .zip(g.column(channel).iter())
                        .for_each(|(x, g)| *x += g * dw);
                }
            }
        }
        record
    }

    /// The question to a record, the search starting so much off the truth.
    pub(crate) fn problem(&self, record: Record, off: f64) -> Problem<'_> {
        let mut parameters = self.parameters.clone();
        let free: Vec<usize> = self.free.iter().map(|it| self.place(it)).collect();
        for &index in &free {
            parameters[index] *= 1.0 + off;
        }
        let states = self.model.states();
        let held = self.held.iter().filter_map(|name| states.index_of(name));
        Problem {
            model: &*self.model,
            parameters,
            free,
            measured: self.measured.iter().map(|it| it.0).collect(),
            start: self.start.clone(),
            deviation: self.deviation.clone(),
            held: held.collect(),
            record,
            segment: self.segment,
        }
    }
}

/// The estimates of so many records.
pub(crate) fn estimates(case: &Case, method: Method, repetitions: u64) -> Vec<Estimate> {
    let seeds = 0..repetitions;
    let found = seeds.map(|seed| {
        let estimate = method(&case.problem(case.record(seed), 0.1));
        estimate.unwrap_or_else(|error| panic!("seed {seed}: {error}"))
    });
    found.collect()
}
