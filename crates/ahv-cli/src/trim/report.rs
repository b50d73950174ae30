//! What a trim at one point tells.

use ahv_analysis::trim::{Nearest, SteadyFlight, Trim, TrimError};
use ahv_core::{Outside, Vector, first_outside};
use serde::Serialize;

use crate::assignment::show;
use crate::condition::{Heading, Vehicle};
use crate::number::Shown;
use crate::output::{Pairs, describe, describe_outside};
use crate::vehicle::FlightModel;

/// The trim, or the point that comes nearest to one.
struct Found<M: FlightModel> {
    state: M::State,
    input: M::Input,
    residuals: M::State,
    residual_max: f64,
    iterations: usize,
}

/// A trim that was found or not.
pub(super) struct Report<'a, M: FlightModel> {
    vehicle: &'a Vehicle<M>,
    flight: &'a SteadyFlight<M::Input>,
    error: Option<&'a TrimError>,
    /// `None` where not even a nearest point is known.
    found: Option<Found<M>>,
}

/// Angles by the names of their unit; everything else in the units of the model.
#[derive(Serialize)]
pub(super) struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    velocity: f64,
    altitude: f64,
    gamma_deg: f64,
    converged: bool,
    reason: Option<String>,
    blocking_bound: Option<String>,
    blocking_bounds: Vec<String>,
    alpha_deg: Option<f64>,
    phi: Option<f64>,
    delta_e_deg: Option<f64>,
    eta: Vec<f64>,
    residual_max: Option<f64>,
    iterations: Option<usize>,
    in_validity_box: bool,
    outside_validity_box: Option<JsonOutside>,
    state: Option<Pairs<f64>>,
    input: Option<Pairs<f64>>,
    residuals: Option<Pairs<f64>>,
    units: Pairs<&'static str>,
}

#[derive(Serialize)]
struct JsonOutside {
    name: &'static str,
    value: f64,
    min: f64,
    max: f64,
}

impl<'a, M: FlightModel> Report<'a, M> {
    pub(super) fn new(
        vehicle: &'a Vehicle<M>,
        flight: &'a SteadyFlight<M::Input>,
        result: &'a Result<Trim<M::State, M::Input>, TrimError>,
    ) -> Self {
        let (found, error) = match result {
            Ok(trim) => (Some(Found::trimmed(trim)), None),
            Err(error) => (error.nearest().map(Found::nearest), Some(error)),
        };
        Self {
            vehicle,
            flight,
            error,
            found,
        }
    }

    /// What lies outside the validity box.
    fn outside(&self) -> Option<Outside> {
        let found = self.found.as_ref()?;
        first_outside(&found.state, &self.vehicle.state_bounds)
            .or_else(|| first_outside(&found.input, &self.vehicle.input_bounds))
    }

    pub(super) fn json(&self) -> Json<'_> {
        let (vehicle, found) = (self.vehicle, self.found.as_ref());
        let state = |name| found.and_then(|it| it.state.get(M::State::index_of(name)?));
        let input = |name| found.and_then(|it| it.input.get(M::Input::index_of(name)?));
        let outside = self.outside();
        let bounds = self.error.map(|error| vehicle.blocking(error));
        let bounds = bounds.unwrap_or_default();
        Json {
            heading: vehicle.heading(),
            velocity: self.flight.velocity,
            altitude: self.flight.altitude,
            gamma_deg: self.flight.gamma.to_degrees(),
            converged: self.error.is_none(),
            reason: self.error.map(|error| vehicle.no_trim(error)),
            blocking_bound: bounds.first().cloned(),
            blocking_bounds: bounds,
            alpha_deg: state("alpha").map(f64::to_degrees),
            phi: input("phi"),
            delta_e_deg: input("delta_e").map(f64::to_degrees),
            eta: self.eta(),
            residual_max: found.map(|it| it.residual_max),
            iterations: found.map(|it| it.iterations),
            in_validity_box: found.is_some() && outside.is_none(),
            outside_validity_box: outside.map(
                |Outside {
                     name,
                     value,
                     bounds,
                 }| JsonOutside {
                    name,
                    value,
                    min: bounds.min,
                    max: bounds.max,
                },
            ),
            state: found.map(|it| Pairs::of(&it.state)),
            input: found.map(|it| Pairs::of(&it.input)),
            residuals: found.map(|it| Pairs::of(&it.residuals)),
            units: Pairs::units_of_both::<M::State, M::Input>(vehicle.units),
        }
    }

    /// Deflections of the flexible modes: states, or what follows the rigid body.
    fn eta(&self) -> Vec<f64> {
        self.found.as_ref().map_or_else(Vec::new, |found| {
            self.vehicle.model.deflections(&found.state, &found.input)
        })
    }

    pub(super) fn text(&self) -> String {
        let units = self.vehicle.units;
        let what = if self.error.is_none() {
            "trim"
        } else {
            "no trim"
        };
        let head = format!(
            "{}: {what}, {}\n{}",
            M::NAME,
            self.vehicle.at(self.flight),
            self.vehicle.described()
        );
        let Some(found) = &self.found else {
            return head;
        };
        let nearest = if self.error.is_none() {
            ""
        } else {
            "at the nearest point:\n"
        };
        let eta: Vec<String> = self.eta().iter().map(|&it| show(it, "1")).collect();
        let eta = match eta.as_slice() {
            [] => String::new(),
            // In the COM and the DCOM they stand among the states.
            _ if M::State::index_of("eta_1").is_some() => String::new(),
            values => format!("\nquasi-static eta: {}", values.join(", ")),
        };
        let place = match self.outside() {
            None => "inside the validity box".to_owned(),
            Some(outside) => {
                let unit = units.label::<M::State>(outside.name);
                let unit = match M::Input::index_of(outside.name) {
                    Some(_) => units.label::<M::Input>(outside.name),
                    None => unit,
                };
                describe_outside(&outside, unit)
            }
        };
        format!(
            "{head}\n{nearest}state:\n{}\ninput:\n{}{eta}\nresiduals, per s:\n{}\nlargest {:.3e}, after {} iterations\n{place}",
            describe(&found.state, units),
            describe(&found.input, units),
            residuals(&found.residuals, units.labels::<M::State>()),
            Shown(found.residual_max),
            found.iterations,
        )
    }
}

/// In the units of the model, for they are too small for decimals.
fn residuals<X: Vector<f64>>(residuals: &X, units: &[&str]) -> String {
    let rows = Pairs::of(residuals).0.into_iter().zip(units);
    let rows = rows.map(|((name, value), unit)| match *unit {
        "1" => format!("  {name:<12} {:.3e}", Shown(value + 0.0)),
        unit => format!("  {name:<12} {:.3e} {unit}", Shown(value + 0.0)),
    });
    rows.collect::<Vec<_>>().join("\n")
}

impl<M: FlightModel> Found<M> {
    fn trimmed(trim: &Trim<M::State, M::Input>) -> Self {
        Self {
            state: trim.state,
            input: trim.input,
            residuals: trim.residuals,
            residual_max: trim.residual_max,
            iterations: trim.iterations,
        }
    }

    fn nearest(nearest: &Nearest) -> Self {
        fn vector<V: Vector<f64>>(components: &[(&str, f64)]) -> V {
            V::from_fn(|index| components.get(index).map_or(0.0, |it| it.1))
        }
        Self {
            state: vector(&nearest.state),
            input: vector(&nearest.input),
            residuals: vector(&nearest.residuals),
            residual_max: nearest.residual_max,
            iterations: nearest.iterations,
        }
    }
}
