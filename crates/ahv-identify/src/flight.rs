//! The model along the record: states, outputs and their sensitivities.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use crate::{IdentifyError, Problem};

/// Longest step of Runge–Kutta, over the fastest pole: its error is then below 1e-5 of a step's motion.
const STEP: f64 = 0.2;
/// Most steps between two samples.
const MOST_STEPS: usize = 1000;

/// What the model says at a point: outputs, and their derivatives by state and by estimated parameter.
pub(crate) struct Seen {
    pub(crate) outputs: DVector<f64>,
    pub(crate) by_state: DMatrix<f64>,
    pub(crate) by_parameter: DMatrix<f64>,
}

impl Problem<'_> {
    /// All parameters with these in the place of the estimated ones.
    pub(crate) fn with(&self, free: &[f64]) -> Vec<f64> {
        let mut all = self.parameters.clone();
        for (&index, &value) in self.free.iter().zip(free) {
            all[index] = value;
        }
        all
    }

    /// The values that the search starts from.
    pub(crate) fn first(&self) -> Vec<f64> {
        self.free.iter().map(|&it| self.parameters[it]).collect()
    }

    pub(crate) fn parameter_names(&self) -> Vec<&'static str> {
        let names = self.model.parameters().names;
        self.free.iter().map(|&it| names[it]).collect()
    }

    /// The samples of each segment. A rest of two samples or fewer belongs to the segment before.
    pub(crate) fn segments(&self) -> Vec<Range<usize>> {
        let times = &self.record.times;
        let mut segments: Vec<Range<usize>> = Vec::new();
        let mut from = 0;
        for (index, &time) in times.iter().enumerate() {
            // A length that is a number of steps must not depend on rounding.
            if time - times[from] >= self.segment * (1.0 - 1e-9) {
                segments.push(from..index);
                from = index;
            }
        }
        match segments.last_mut() {
            Some(last) if times.len() - from <= 2 => last.end = times.len(),
            _ => segments.push(from..times.len()),
        }
        segments
    }

    /// The state at the start of a segment: what is measured of it, and the rest as given.
    pub(crate) fn start_of(&self, sample: usize) -> Vec<f64> {
        let mut state = self.start.clone();
        let names = self.model.states();
        for (name, &value) in self.measured.iter().zip(&self.record.outputs[sample]) {
            if let Some(index) = names.index_of(name) {
                state[index] = value;
            }
        }
        state
    }

    pub(crate) fn see(&self, p: &[f64], x: &[f64], u: &[f64], slopes: bool) -> Option<Seen> {
        let (states, outputs) = (self.model.states(), self.model.outputs());
        let place = |name: &&str| states.index_of(name);
        let only_states = self.measured.iter().all(|name| place(name).is_some());
        let (rows, n, many) = (self.measured.len(), x.len(), self.free.len());
        let mut seen = Seen {
            outputs: DVector::zeros(rows),
            by_state: DMatrix::zeros(rows, n),
            by_parameter: DMatrix::zeros(rows, if slopes { many } else { 0 }),
        };
        let values = match only_states {
            true => Vec::new(),
            false => self.model.output_values(p, x, u),
        };
        for (row, name) in self.measured.iter().enumerate() {
            match place(name) {
                Some(index) => {
                    seen.outputs[row] = x[index];
                    seen.by_state[(row, index)] = 1.0;
                }
                None => seen.outputs[row] = values[outputs.index_of(name)?],
            }
        }
        if !only_states {
            seen.by_state = self.model.output_slopes(p, x, u, &self.measured)?;
        }
        if !only_states && slopes {
            let all = self.model.output_parameter_jacobian(p, x, u);
            for (row, name) in self.measured.iter().enumerate() {
                if let (None, Some(index)) = (place(name), outputs.index_of(name)) {
                    for (column, &parameter) in self.free.iter().enumerate() {
                        seen.by_parameter[(row, column)] = all[(index, parameter)];
                    }
                }
            }
        }
        Some(seen)
    }

    /// Steps between the samples of a segment, so that they resolve the fastest pole at its start.
    pub(crate) fn steps(&self, segment: &Range<usize>) -> Result<usize, IdentifyError> {
        let (x, u) = (
            self.start_of(segment.start),
            &self.record.inputs[segment.start],
        );
        let a = self.model.state_jacobian(&self.parameters, &x, u);
        let times = &self.record.times[segment.clone()];
        let diverges = IdentifyError::Diverges {
            time: times.first().copied().unwrap_or(0.0),
        };
        if a.iter().any(|entry| !entry.is_finite()) {
            return Err(diverges);
        }
        let poles = a.complex_eigenvalues();
        let fastest = poles
            .iter()
            .map(|it| it.re.hypot(it.im))
            .fold(0.0, f64::max);
        let longest = times
            .windows(2)
            .map(|pair| pair[1] - pair[0])
            .fold(0.0, f64::max);
        let steps = (longest * fastest / STEP).ceil();
        Ok((steps as usize).clamp(1, MOST_STEPS))
    }

    /// A step of Runge–Kutta of the state.
    pub(crate) fn step(&self, p: &[f64], x: &mut [f64], u: &[f64], h: f64) {
        let rate = |x: &[f64]| self.model.drift(p, x, u);
        let moved = |x: &[f64], k: &[f64], h: f64| -> Vec<f64> {
            x.iter().zip(k).map(|(x, k)| x + h * k).collect()
        };
        let first = rate(x);
        let second = rate(&moved(x, &first, 0.5 * h));
        let third = rate(&moved(x, &second, 0.5 * h));
        let fourth = rate(&moved(x, &third, h));
        for (index, x) in x.iter_mut().enumerate() {
            let inner = second[index] + third[index];
            *x += h / 6.0 * (first[index] + 2.0 * inner + fourth[index]);
        }
    }

    /// The same with sensitivities: columns by the estimated parameters, then by the estimated initial states.
    pub(crate) fn step_with(
        &self,
        p: &[f64],
        x: &mut DVector<f64>,
        s: &mut DMatrix<f64>,
        u: &[f64],
        h: f64,
    ) {
        let many = self.free.len();
        let rate = |x: &DVector<f64>, s: &DMatrix<f64>| {
            let x = x.as_slice();
            let a = self.model.state_jacobian(p, x, u);
            let slopes = self
                .model
                .parameter_jacobian(p, x, u)
                .select_columns(&self.free);
            let mut rate = a * s;
            let mut of_parameters = rate.columns_mut(0, many);
            of_parameters += slopes;
            (DVector::from_vec(self.model.drift(p, x, u)), rate)
        };
        let first = rate(x, s);
        let second = rate(&(&*x + &first.0 * (0.5 * h)), &(&*s + &first.1 * (0.5 * h)));
        let third = rate(
            &(&*x + &second.0 * (0.5 * h)),
            &(&*s + &second.1 * (0.5 * h)),
        );
        let fourth = rate(&(&*x + &third.0 * h), &(&*s + &third.1 * h));
        *x += (first.0 + (second.0 + third.0) * 2.0 + fourth.0) * (h / 6.0);
        *s += (first.1 + (second.1 + third.1) * 2.0 + fourth.1) * (h / 6.0);
    }
}
