//! What a trim at one point tells.

use ahv_analysis::trim::{Nearest, SteadyState, Trim, TrimError};
use ahv_core::{GeneratedModel, Outside, Vector, first_outside};
use serde::Serialize;

use crate::assignment::show;
use crate::named::{Named, shown_as};
use crate::number::Shown;
use crate::output::{Pairs, describe, describe_outside};
use crate::registry::models;
use crate::vehicle::{Heading, PointJson, Vehicle};

/// The trim, or the point that comes nearest to one.
struct Found<M: GeneratedModel> {
    state: M::State,
    input: M::Input,
    residuals: M::State,
    residual_max: f64,
    iterations: usize,
}

/// A trim that was found or not.
pub(super) struct Report<'a, M: GeneratedModel> {
    vehicle: &'a Vehicle<M>,
    flight: &'a SteadyState<M::Input>,
    error: Option<&'a TrimError>,
    /// `None` where not even a nearest point is known.
    found: Option<Found<M>>,
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

impl<'a, M: GeneratedModel> Report<'a, M> {
    pub(super) fn new(
        vehicle: &'a Vehicle<M>,
        flight: &'a SteadyState<M::Input>,
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
        let outside = self.outside();
        let bounds = self.error.map(|error| vehicle.blocking(error));
        let bounds = bounds.unwrap_or_default();
        Json {
            heading: vehicle.heading(),
            condition: Named::given::<M>(self.flight),
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
            residuals: found.map(|it| Pairs::of(&it.residuals)),
        }
    }

    /// A state, an input or another quantity of what was found.
    fn value(&self, name: &str) -> Option<f64> {
        let found = self.found.as_ref()?;
        let state = M::State::index_of(name).and_then(|index| found.state.get(index));
        let input = M::Input::index_of(name).and_then(|index| found.input.get(index));
        let outputs = || self.vehicle.outputs(&found.state, &found.input);
        let output = || outputs().get(M::OutputsOf::<f64>::index_of(name)?);
        state.or(input).or_else(output)
    }

    /// What people look at, for a program: names that differ in their number alone, as those of modes, are one list.
    fn shown(&self) -> Named<ShownValue> {
        let mut shown: Vec<(String, ShownValue)> = Vec::new();
        for name in M::TRIM.shown {
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
        let others = models().iter().flat_map(|model| model.trim.shown);
        for kind in others.filter_map(|name| kind(name)) {
            if shown.iter().all(|(known, _)| known != kind) {
                shown.push((kind.to_owned(), ShownValue::Several(Vec::new())));
            }
        }
        Named::new(shown)
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
        // States and inputs stand there anyway.
        let others = M::TRIM
            .shown
            .iter()
            .filter(|name| M::OutputsOf::<f64>::index_of(name).is_some());
        let others: String = others
            .filter_map(|name| Some((name, self.value(name)?)))
            .map(|(name, value)| format!("\n  {name:<12} {}", show(value, self.vehicle.unit(name))))
            .collect();
        let others = match others.as_str() {
            "" => String::new(),
            lines => format!("\noutputs:{lines}"),
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
            "{head}\n{nearest}state:\n{}\ninput:\n{}{others}\nresiduals, per s:\n{}\nlargest {:.3e}, after {} iterations\n{place}",
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

impl<M: GeneratedModel> Found<M> {
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
