//! Where the vehicle flies: flags of every command that starts at a trim of the user's choice.

use ahv_analysis::trim::{SOUGHT_INPUTS, SteadyFlight, Trim, TrimError, trim};
use ahv_core::{Vector, first_outside};
use clap::Args;

use crate::assignment::{Assignments, show, show_beside};
use crate::condition::Vehicle;
use crate::failure::{Failure, complain};
use crate::names;
use crate::output::describe_outside;
use crate::units::Units;
use crate::vehicle::FlightModel;

/// Velocity in ft/s of the standard trim.
pub(crate) const VELOCITY: f64 = 7702.0808;

/// Altitude in ft of the standard trim.
pub(crate) const ALTITUDE: f64 = 85_000.0;

/// Steady flight at a point.
#[derive(Args)]
pub(crate) struct Place {
    /// Velocity in ft/s, above 0, with --units si in m/s [default: 7702.0808 ft/s]
    #[arg(long, value_name = "FT_S", value_parser = finite, allow_negative_numbers = true)]
    velocity: Option<f64>,

    /// Altitude in ft, with --units si in m [default: 85000 ft]
    #[arg(long, value_name = "FT", value_parser = finite, allow_negative_numbers = true)]
    altitude: Option<f64>,

    /// Flight-path angle in deg, between -90 and 90
    #[arg(long, value_name = "DEG", default_value_t = 0.0, value_parser = finite, allow_negative_numbers = true)]
    gamma: f64,

    /// Held inputs, e.g. delta_c=2deg with --canard free; the trim finds phi and delta_e
    #[arg(long, value_name = "NAME=VALUE", value_delimiter = ',')]
    input: Vec<String>,
}

fn finite(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite());
    number.ok_or_else(|| "not a finite number".to_owned())
}

impl Place {
    /// Steady flight of `vehicle` here, `phi` and `delta_e` inside their validity box.
    ///
    /// # Errors
    ///
    /// [`Failure::Request`] for a place where there is no steady flight, and for inputs that are not held, or have no
    /// effect.
    pub(crate) fn flight<M: FlightModel>(
        &self,
        vehicle: &Vehicle<M>,
    ) -> Result<SteadyFlight<M::Input>, Failure> {
        let units = vehicle.units;
        let inputs = Assignments::parse::<M::Input>("--input", &self.input, units)?;
        if let Some(name) = SOUGHT_INPUTS
            .into_iter()
            .find(|name| inputs.get::<M::Input>(name).is_some())
        {
            return Err(Failure::Request(format!(
                "--input: {name} is not held; the trim finds {}",
                names::list(&SOUGHT_INPUTS)
            )));
        }
        vehicle.check_canard(&inputs)?;
        let velocity = self.velocity.unwrap_or(units.feet(VELOCITY));
        let altitude = self.altitude.unwrap_or(units.feet(ALTITUDE));
        let mut flight = SteadyFlight::new(velocity, altitude)
            .climbing(self.gamma.to_radians())
            .within(&vehicle.input_bounds);
        inputs.apply(&mut flight.input, &[]);
        flight
            .check()
            .map_err(|error| outside_domain::<M>(&error, units))?;
        Ok(flight)
    }
}

/// What to say of a flight condition outside the domain of steady flight.
fn outside_domain<M: FlightModel>(error: &TrimError, units: Units) -> Failure {
    Failure::Request(match *error {
        TrimError::Domain { name, value, must } => {
            let value = show(value, units.label::<M::State>(name));
            format!("--{name}: {value} is outside the domain of steady flight; it must be {must}")
        }
        ref other => other.to_string(),
    })
}

impl<M: FlightModel> Vehicle<M> {
    /// The trim of a steady flight; a warning says if it is outside the validity box.
    ///
    /// # Errors
    ///
    /// [`Failure::Numeric`] if there is none.
    pub(crate) fn trim(
        &self,
        flight: &SteadyFlight<M::Input>,
    ) -> Result<Trim<M::State, M::Input>, Failure> {
        let trim = trim(&self.model, flight).map_err(|error| {
            let why = self.no_trim(&error);
            Failure::Numeric(format!("{}: {why} ({})", M::NAME, self.at(flight)))
        })?;
        if let Some(outside) = first_outside(&trim.state, &self.state_bounds) {
            let unit = self.units.label::<M::State>(outside.name);
            let outside = describe_outside(&outside, unit);
            complain(&format!("warning: {}: {outside}", M::NAME));
        }
        Ok(trim)
    }

    /// Whether a state can fly: at no velocity, or backwards, its rates are no numbers, or mean nothing.
    ///
    /// # Errors
    ///
    /// What is wrong, for a person.
    pub(crate) fn moves(&self, state: &M::State) -> Result<(), String> {
        let velocity = M::State::index_of("velocity").and_then(|index| state.get(index));
        match velocity {
            Some(velocity) if velocity.is_nan() || velocity <= 0.0 => Err(format!(
                "velocity must be above 0, not {}",
                show(velocity, self.units.label::<M::State>("velocity"))
            )),
            _ => Ok(()),
        }
    }

    /// Where a steady flight is, for a person.
    pub(crate) fn at(&self, flight: &SteadyFlight<M::Input>) -> String {
        let label = |name| self.units.label::<M::State>(name);
        let path = match flight.gamma {
            0.0 => "level flight".to_owned(),
            gamma => format!("flight path {}", show(gamma, "rad")),
        };
        format!(
            "{path} at {} and {}",
            show(flight.velocity, label("velocity")),
            show(flight.altitude, label("altitude"))
        )
    }

    /// Why there is no trim, for a person.
    pub(crate) fn no_trim(&self, error: &TrimError) -> String {
        let TrimError::Blocked {
            blocking,
            beyond,
            nearest,
        } = error
        else {
            return error.to_string();
        };
        let instead = match beyond {
            Some(values) => {
                let values = SOUGHT_INPUTS.iter().zip(values);
                let values: Vec<String> = values
                    .map(|(&name, &value)| {
                        let mut bounds = blocking.iter().filter(|it| it.input == name);
                        let bound = bounds.next().map_or(f64::NAN, |it| it.bound);
                        let unit = self.units.label::<M::Input>(name);
                        format!("{name} = {}", show_beside(value, bound, unit))
                    })
                    .collect();
                format!("without bounds the trim is at {}", values.join(", "))
            }
            None => "nor was one found beyond".to_owned(),
        };
        let rate = self.units.label::<M::State>(nearest.worst);
        format!(
            "no trim with {}; {instead}; at the nearest point {} still changes by {} a second",
            self.blocking(error).join(" and "),
            nearest.worst,
            show(nearest.worst_residual(), rate)
        )
    }

    /// The bounds that block a trim, for a person; none if it is not for bounds.
    pub(crate) fn blocking(&self, error: &TrimError) -> Vec<String> {
        let TrimError::Blocked { blocking, .. } = error else {
            return Vec::new();
        };
        let bounds = blocking.iter().map(|it| {
            let relation = if it.upper { "<=" } else { ">=" };
            let bound = show(it.bound, self.units.label::<M::Input>(it.input));
            format!("{} {relation} {bound}", it.input)
        });
        bounds.collect()
    }
}
