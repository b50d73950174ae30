//! Statistics and flights as CSV.

use std::fmt::Write;

use ahv_analysis::track::Flight;
use ahv_models::dcom::{Input, State};

use super::Outcome;

/// A row for each figure of each controller; of shares of flights only value and interval.
pub(super) fn statistics(outcomes: &[Outcome]) -> String {
    let mut table = String::from(
        "controller,figure,unit,mean,mean_low,mean_high,median,p05,p95,least,largest\n",
    );
    // Writing into a String cannot fail.
    for Outcome {
        controller,
        statistics,
        ..
    } in outcomes
    {
        for (name, count) in [
            ("lost", &statistics.lost),
            ("left_validity_box", &statistics.left_validity_box),
        ] {
            let share = &count.share;
            let _ = writeln!(
                table,
                "{controller},{name},1,{},{},{},,,,,",
                share.value, share.low, share.high
            );
        }
        for figure in &statistics.figures {
            let (mean, spread) = (&figure.mean, &figure.spread);
            let numbers = [
                mean.value,
                mean.low,
                mean.high,
                spread.value,
                spread.low,
                spread.high,
                figure.least,
                figure.largest,
            ];
            let numbers = numbers.map(|number| number.to_string()).join(",");
            let _ = writeln!(
                table,
                "{controller},{},{},{numbers}",
                figure.name, figure.unit
            );
        }
    }
    table
}

/// State, input and commands of a flight over time.
pub(super) fn flight(flight: &Flight) -> String {
    let units = State::<f64>::UNITS.into_iter().chain(Input::<f64>::UNITS);
    let names = State::<f64>::NAMES.into_iter().chain(Input::<f64>::NAMES);
    let mut table = String::from("time [s]");
    for (name, unit) in names.zip(units) {
        let _ = write!(table, ",{name} [{unit}]");
    }
    table.push_str(",velocity_command [ft/s],altitude_command [ft],gamma_command [rad]\n");
    for sample in &flight.samples {
        let _ = write!(table, "{}", sample.time);
        for value in sample
            .state
            .to_array()
            .into_iter()
            .chain(sample.input.to_array())
        {
            let _ = write!(table, ",{value}");
        }
        let command = &sample.reference;
        let _ = writeln!(
            table,
            ",{},{},{}",
            command.velocity,
            command.altitude,
            command.gamma()
        );
    }
    table
}
