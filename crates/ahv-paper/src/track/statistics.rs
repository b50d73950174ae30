//! Figures of many flights.

use ahv_analysis::statistics::{Estimate, mean_and_std};

use super::{Flight, Sample};

/// A figure of a flight, over all flights.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Figure {
    /// What it is.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Mean over the flights with its interval of 95 %.
    pub mean: Estimate,
    /// Median over the flights, with the 5 % and 95 % points.
    pub spread: Estimate,
    /// Least of all flights.
    pub least: f64,
    /// Largest of all flights.
    pub largest: f64,
}

/// How many flights did something.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Count {
    /// Flights that did.
    pub flights: usize,
    /// Their share, with its interval of 95 %.
    pub share: Estimate,
}

/// Statistics of flights. Lost ones are in every figure with what they flew.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Statistics {
    /// Flights.
    pub runs: usize,
    /// A state ceased to be finite.
    pub lost: Count,
    /// A state left the validity box.
    pub left_validity_box: Count,
    /// The figures.
    pub figures: Vec<Figure>,
}

/// A quantity over time, over the flights that still fly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// In s.
    pub time: f64,
    /// Median with the 5 % and 95 % points.
    pub spread: Estimate,
    /// Flights.
    pub flying: usize,
}

/// Name, unit and definition of each figure.
type Definition = (&'static str, &'static str, fn(&Flight) -> f64);

const FIGURES: [Definition; 15] = [
    ("velocity_error_rms", "ft/s", |flight| flight.errors[0].rms),
    ("velocity_error_max", "ft/s", |flight| flight.errors[0].max),
    ("altitude_error_rms", "ft", |flight| flight.errors[1].rms),
    ("altitude_error_max", "ft", |flight| flight.errors[1].max),
    ("gamma_error_rms", "deg", |flight| {
        flight.errors[2].rms.to_degrees()
    }),
    ("gamma_error_max", "deg", |flight| {
        flight.errors[2].max.to_degrees()
    }),
    ("alpha_peak", "deg", |flight| flight.alpha.to_degrees()),
    ("phi_least", "1", |flight| flight.inputs[0].0),
    ("phi_largest", "1", |flight| flight.inputs[0].1),
    ("delta_e_least", "deg", |flight| {
        flight.inputs[1].0.to_degrees()
    }),
    ("delta_e_largest", "deg", |flight| {
        flight.inputs[1].1.to_degrees()
    }),
    ("phi_position_limited", "1", |flight| {
        flight.limited[0].position
    }),
    ("phi_rate_limited", "1", |flight| flight.limited[0].rate),
    ("delta_e_position_limited", "1", |flight| {
        flight.limited[1].position
    }),
    ("delta_e_rate_limited", "1", |flight| flight.limited[1].rate),
];

impl Statistics {
    /// Statistics of `flights`; `None` of none.
    pub fn of(flights: &[Flight]) -> Option<Self> {
        let count = |test: fn(&Flight) -> bool| {
            let hits = flights.iter().filter(|flight| test(flight)).count();
            Count {
                flights: hits,
                share: Estimate::of_share(hits as u64, flights.len() as u64),
            }
        };
        let figures = FIGURES.map(|(name, unit, figure)| {
            let values: Vec<f64> = flights.iter().map(figure).collect();
            let (mean, std) = mean_and_std(&values);
            Some(Figure {
                name,
                unit,
                mean: Estimate::of_mean(mean, std, values.len() as f64),
                spread: Estimate::of_distribution(&values)?,
                least: values.iter().copied().fold(f64::INFINITY, f64::min),
                largest: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            })
        });
        Some(Self {
            runs: flights.len(),
            lost: count(|flight| flight.lost.is_some()),
            left_validity_box: count(|flight| flight.departure.is_some()),
            figures: figures.into_iter().collect::<Option<_>>()?,
        })
    }
}

/// `quantity` over time, at each record.
pub fn bands(flights: &[Flight], quantity: impl Fn(&Sample) -> f64) -> Vec<Band> {
    let records = flights
        .iter()
        .map(|flight| flight.samples.len())
        .max()
        .unwrap_or(0);
    let at = |record| {
        let samples: Vec<&Sample> = flights
            .iter()
            .filter_map(|flight| flight.samples.get(record))
            .collect();
        let values: Vec<f64> = samples.iter().map(|sample| quantity(sample)).collect();
        Some(Band {
            time: samples.first()?.time,
            spread: Estimate::of_distribution(&values)?,
            flying: values.len(),
        })
    };
    (0..records).filter_map(at).collect()
}
