//! What a trim at one point tells.

use ahv_analysis::trim::{Nearest, SteadyState, Trim, TrimError};
use ahv_core::Outside;
use serde::Serialize;

use crate::labels::Labels;
use crate::named::{Named, shown_as};
use crate::number::Shown;
use crate::output::{Pairs, describe_outside};
use crate::registry::models;
use crate::show::show;
use crate::vehicle::{Heading, PointJson, Vehicle};

/// The trim, or the point that comes nearest to one.
struct Found {
    state: Vec<f64>,
    input: Vec<f64>,
    residuals: Vec<f64>,
    residual_max: f64,
    iterations: usize,
}

/// A trim that was found or not.
pub(super) struct Report<'a> {
    vehicle: &'a Vehicle,
    flight: &'a SteadyState,
    error: Option<&'a TrimError>,
    /// `None` where not even a nearest point is known.
    found: Option<Found>,
}

/// Angles by the names of their unit; everything else in the units of the model.
#[derive(Serialize)]
pub(super) struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    #[serde(flatten)]
    condition: Named<f64>,
    converged: bool,
    reason: Option<String>,
    blocking_bound: Option<String>,
    blocking_bounds: Vec<String>,
    /// What is shown of a trim, those of one kind as a list.
    #[serde(flatten)]
    shown: Named<ShownValue>,
    residual_max: Option<f64>,
    iterations: Option<usize>,
    in_validity_box: bool,
    outside_validity_box: Option<JsonOutside>,
    #[serde(flatten)]
    point: Option<PointJson>,
    residuals: Option<Pairs<f64>>,
}

/// What a name with a number, such as that of a mode, has in common with others: `eta` of `eta_1`.
fn kind(name: &str) -> Option<&str> {
    let (kind, number) = name.rsplit_once('_')?;
    let is_number = !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then_some(kind)
}

/// A number, or those of one kind.
#[derive(Serialize)]
#[serde(untagged)]
enum ShownValue {
    One(Option<f64>),
    Several(Vec<f64>),
}

#[derive(Serialize)]
struct JsonOutside {
    name: &'static str,
    value: f64,
    min: f64,
    max: f64,
}

impl<'a> Report<'a> {
    pub(super) fn new(
        vehicle: &'a Vehicle,
        flight: &'a SteadyState,
        result: &'a Result<Trim<Vec<f64>, Vec<f64>>, TrimError>,
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
    fn outside(&self) -> Vec<Outside> {
        let found = self.found.iter();
        found
            .flat_map(|it| self.vehicle.outside(&it.state, &it.input))
            .collect()
    }

    pub(super) fn json(&self) -> Json<'_> {
        let (vehicle, found) = (self.vehicle, self.found.as_ref());
        let outside = self.outside().into_iter().next();
        let bounds = self.error.map(|error| vehicle.blocking(error));
        let bounds = bounds.unwrap_or_default();
        Json {
            heading: vehicle.heading(),
            condition: Named::given(vehicle, self.flight),
            converged: self.error.is_none(),
            reason: self.error.map(|error| vehicle.no_trim(error)),
            blocking_bound: bounds.first().cloned(),
            blocking_bounds: bounds,
            shown: self.shown(),
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
            point: found.map(|it| vehicle.point(&it.state, &it.input)),
            residuals: found.map(|it| vehicle.states.pairs(it.residuals.iter().copied())),
        }
    }

    /// A state, an input or another quantity of what was found.
    fn value(&self, name: &str) -> Option<f64> {
        let found = self.found.as_ref()?;
        self.vehicle.value(name, &found.state, &found.input)
    }

    /// What people look at, for a program: names that differ in their number alone, as those of modes, are one list.
    fn shown(&self) -> Named<ShownValue> {
        let mut shown: Vec<(String, ShownValue)> = Vec::new();
        for name in self.vehicle.model.trim_problem().shown {
            let value = self.value(name);
            let Some(kind) = kind(name) else {
                let (name, factor) = shown_as(name, 1.0, self.vehicle.unit(name));
                shown.push((name, ShownValue::One(value.map(|value| value * factor))));
                continue;
            };
            match shown.iter_mut().find(|(known, _)| known == kind) {
                Some((_, ShownValue::Several(list))) => list.extend(value),
                _ => shown.push((
                    kind.to_owned(),
                    ShownValue::Several(value.into_iter().collect()),
                )),
            }
        }
        // What other models have several of, this one has none of.
        let others = models().flat_map(|model| model.trim_problem().shown);
        for kind in others.filter_map(|name| kind(name)) {
            if shown.iter().all(|(known, _)| known != kind) {
                shown.push((kind.to_owned(), ShownValue::Several(Vec::new())));
            }
        }
        Named::new(shown)
    }

    pub(super) fn text(&self) -> String {
        let vehicle = self.vehicle;
        let what = if self.error.is_none() {
            "trim"
        } else {
            "no trim"
        };
        let head = format!(
            "{}: {what}, {}\n{}",
            vehicle.name(),
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
        // States and inputs stand there anyway.
        let shown = vehicle.model.trim_problem().shown.iter();
        let others = shown.filter(|name| vehicle.outputs.index_of(name).is_some());
        let others: String = others
            .filter_map(|name| Some((name, self.value(name)?)))
            .map(|(name, value)| format!("\n  {name:<12} {}", show(value, self.vehicle.unit(name))))
            .collect();
        let others = match others.as_str() {
            "" => String::new(),
            lines => format!("\noutputs:{lines}"),
        };
        let outside = self.outside();
        let outside = outside
            .iter()
            .map(|it| describe_outside(it, vehicle.unit(it.name)));
        let place = match outside.collect::<Vec<_>>().join("\n") {
            none if none.is_empty() => "inside the validity box".to_owned(),
            outside => outside,
        };
        format!(
            "{head}\n{nearest}state:\n{}\ninput:\n{}{others}\nresiduals, per s:\n{}\nlargest {:.3e}, after {} iterations\n{place}",
            vehicle.states.describe(&found.state),
            vehicle.inputs.describe(&found.input),
            residuals(vehicle.states, &found.residuals),
            Shown(found.residual_max),
            found.iterations,
        )
    }
}

/// In the units of the model, for they are too small for decimals.
fn residuals(states: Labels, residuals: &[f64]) -> String {
    let rows = states.iter().zip(residuals);
    let rows = rows.map(|((name, unit), value)| match unit {
        "1" => format!("  {name:<12} {:.3e}", Shown(value + 0.0)),
        unit => format!("  {name:<12} {:.3e} {unit}", Shown(value + 0.0)),
    });
    rows.collect::<Vec<_>>().join("\n")
}

impl Found {
    fn trimmed(trim: &Trim<Vec<f64>, Vec<f64>>) -> Self {
        Self {
            state: trim.state.clone(),
            input: trim.input.clone(),
            residuals: trim.residuals.clone(),
            residual_max: trim.residual_max,
            iterations: trim.iterations,
        }
    }

    fn nearest(nearest: &Nearest) -> Self {
        let values = |pairs: &[(&str, f64)]| pairs.iter().map(|it| it.1).collect();
        Self {
            state: values(&nearest.state),
            input: values(&nearest.input),
            residuals: values(&nearest.residuals),
            residual_max: nearest.residual_max,
            iterations: nearest.iterations,
        }
    }
}
