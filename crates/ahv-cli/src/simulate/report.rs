//! What a simulation tells when it is done.

use std::path::Path;

use ahv_analysis::erased::Passage;
use ahv_core::Outside;
use ahv_integrate::TimeGrid;
use serde::{Serialize, Serializer};

use crate::failure::{Failure, complain, print};
use crate::number::Shown;
use crate::output::{self, Pairs, describe_outside};
use crate::vehicle::{Heading, PointJson, Vehicle};

/// The first departure from the validity box.
#[derive(Clone, Copy)]
pub(super) struct Departure {
    pub(super) time: f64,
    pub(super) outside: Outside,
}

/// What steps of varying length did.
#[derive(Serialize)]
pub(super) struct Adaptive {
    pub(super) tolerance: f64,
    /// Steps that met the tolerance.
    pub(super) accepted: u32,
    /// Steps that did not, and were tried again with a shorter one.
    pub(super) refused: u32,
    /// Passages of boundaries of the drift, in order.
    #[serde(serialize_with = "passages")]
    pub(super) boundaries: Vec<Passage>,
}

fn passages<S: Serializer>(passages: &[Passage], serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Json {
        boundary: &'static str,
        time: f64,
    }

    let told = passages
        .iter()
        .map(|&Passage { boundary, time }| Json { boundary, time });
    serializer.collect_seq(told)
}

impl Adaptive {
    /// Lines that tell of it.
    fn text(&self) -> String {
        let mut text = format!(
            "tolerance {}: {} steps, {} tried again\n",
            Shown(self.tolerance),
            self.accepted,
            self.refused
        );
        for Passage { boundary, time } in &self.boundaries {
            text += &format!("at {} s passed {boundary}\n", Shown(*time));
        }
        text
    }
}

/// A finished simulation.
pub(super) struct Report<'a> {
    pub(super) vehicle: &'a Vehicle,
    pub(super) grid: &'a TimeGrid,
    pub(super) scheme: &'a str,
    pub(super) seed: Option<u64>,
    /// None with steps of fixed length.
    pub(super) adaptive: Option<Adaptive>,
    pub(super) initial_state: Vec<f64>,
    pub(super) final_state: Vec<f64>,
    pub(super) input: Vec<f64>,
    pub(super) out: &'a Path,
    pub(super) departure: Option<Departure>,
    pub(super) input_outside: Option<Outside>,
}

#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    heading: Heading<'a>,
    /// Where the run ends.
    #[serde(flatten)]
    point: PointJson,
    steps: u32,
    t_end: f64,
    dt: f64,
    scheme: &'a str,
    seed: Option<u64>,
    adaptive: Option<&'a Adaptive>,
    initial_state: Pairs<f64>,
    final_state: Pairs<f64>,
    out: String,
    left_validity_box: Option<JsonDeparture>,
    input_outside_validity_box: Option<JsonInput>,
}

#[derive(Serialize)]
struct JsonDeparture {
    time: f64,
    state: &'static str,
    value: f64,
}

#[derive(Serialize)]
struct JsonInput {
    input: &'static str,
    value: f64,
}

impl Report<'_> {
    /// Warns of departures from the validity box, then tells the outcome on stdout.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] if stdout cannot be written.
    pub(super) fn tell(&self, json: bool) -> Result<(), Failure> {
        if let Some(outside) = &self.input_outside {
            let place = describe_outside(outside, self.vehicle.inputs.unit(outside.name));
            complain(&format!(
                "warning: the input {place}; the model is not valid there"
            ));
        }
        if let Some(Departure { time, outside }) = &self.departure {
            let place = describe_outside(outside, self.vehicle.states.unit(outside.name));
            complain(&format!(
                "warning: at {time} s {place}; the model is not valid from there on"
            ));
        }
        print(&if json { self.json()? } else { self.text() })
    }

    fn json(&self) -> Result<String, Failure> {
        let json = Json {
            heading: self.vehicle.heading(),
            point: self.vehicle.point(&self.final_state, &self.input),
            steps: self.grid.steps(),
            t_end: self.grid.end(),
            dt: self.grid.dt(),
            scheme: self.scheme,
            seed: self.seed,
            adaptive: self.adaptive.as_ref(),
            initial_state: self
                .vehicle
                .states
                .pairs(self.initial_state.iter().copied()),
            final_state: self.vehicle.states.pairs(self.final_state.iter().copied()),
            out: self.out.display().to_string(),
            left_validity_box: self
                .departure
                .map(|Departure { time, outside }| JsonDeparture {
                    time,
                    state: outside.name,
                    value: outside.value,
                }),
            input_outside_validity_box: self
                .input_outside
                .map(|Outside { name, value, .. }| JsonInput { input: name, value }),
        };
        output::json(&json)
    }

    fn text(&self) -> String {
        let steps = self.grid.steps();
        let [t_end, dt] = [self.grid.end(), self.grid.dt().min(self.grid.end())].map(Shown);
        let seed = self
            .seed
            .map_or_else(String::new, |seed| format!(", seed {seed}"));
        let (how, adaptive) = match &self.adaptive {
            None => {
                let plural = if steps == 1 { "step" } else { "steps" };
                (format!("{steps} {plural} of {dt} s"), String::new())
            }
            Some(adaptive) => (format!("a row every {dt} s"), adaptive.text()),
        };
        format!(
            "{}: {}, {how} to {t_end} s{seed}, written to {}\n{adaptive}{}\nheld:\n{}\nat the end:\n{}",
            self.vehicle.name(),
            self.scheme,
            self.out.display(),
            self.vehicle.described(),
            self.vehicle.inputs.describe(&self.input),
            self.vehicle.states.describe(&self.final_state)
        )
    }
}
