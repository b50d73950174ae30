//! The geometry table as constants: parameters, values, origins, validity box and rules, made from `vehicle.toml` when the crate is
//! built.

use ahv_core::{
    Choice, ChoiceOption, Entry, Interval, Provenance, Rule, Sign, Status, Table, Term,
};

include!(concat!(env!("OUT_DIR"), "/table.rs"));

/// Entries, choices, validity box and rules of the table.
pub const TABLE: Table = Table {
    name: "fpm",
    models: &["fpm"],
    unit_system: "ft-slug-s-rad",
    entries: ENTRIES,
    choices: &[Choice::new(
        "earth",
        "Earth",
        &[
            ChoiceOption::new(
                "flat",
                "gravity is constant and the path is straight, as (1) has it",
                &[("spherical_earth", 0.0)],
            ),
            ChoiceOption::new(
                "spherical",
                "gravity falls with altitude, and flight follows the curvature",
                &[("spherical_earth", 1.0)],
            ),
        ],
    )],
    joins: &[],
    fits: &[],
    validity: &[
        Interval::new("velocity", "ft/s", validity::VELOCITY, &["velocity"]),
        Interval::new("altitude", "ft", validity::ALTITUDE, &["altitude"]),
        Interval::new("gamma", "rad", validity::GAMMA, &["gamma"]),
        Interval::new("alpha", "rad", validity::ALPHA, &["alpha"]),
        Interval::new("pitch_rate", "rad/s", validity::PITCH_RATE, &["pitch_rate"]),
        Interval::new("eta", "(ft*slug)^0.5", validity::ETA, &["eta_1", "eta_2"]),
        Interval::new(
            "eta_dot",
            "(ft*slug)^0.5/s",
            validity::ETA_DOT,
            &["eta_dot_1", "eta_dot_2"],
        ),
        Interval::new("phi", "1", validity::PHI, &["phi"]),
        Interval::new("delta_e", "rad", validity::DELTA_E, &["delta_e"]),
    ],
    rules: RULES,
};
