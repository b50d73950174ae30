//! The section on Table 2.

use ahv_models::dcom;

use super::page::{Cell, Row, Section, Table};
use super::{Findings, sentences};
use crate::commands::number::significant;
use crate::reproduce::printed::TABLE_2;
use crate::reproduce::vehicle::{TrimPoint, Vehicle};

/// Distance of a trim from the printed one: the largest relative difference of α, φ, δe.
pub(super) fn distance(trim: &TrimPoint) -> f64 {
    let pairs = [
        (trim.alpha_deg, TABLE_2.alpha_deg),
        (trim.phi, TABLE_2.phi),
        (trim.delta_e_deg, TABLE_2.delta_e_deg),
    ];
    pairs
        .iter()
        .map(|(ours, printed)| (ours / printed - 1.0).abs())
        .fold(0.0, f64::max)
}

fn name(vehicle: &Vehicle) -> String {
    let condition = &vehicle.condition;
    let canard = condition
        .canard
        .map_or_else(String::new, |canard| format!(", canard {canard}"));
    format!(
        "{}, {}{canard}, {} Earth",
        condition.model, condition.set, condition.earth
    )
}

/// A number with its difference from the printed one.
fn beside(ours: f64, printed: f64) -> Cell {
    let sign = if ours >= printed { "+" } else { "" };
    Cell::Number(format!(
        "{} ({sign}{})",
        significant(ours),
        significant(ours - printed)
    ))
}

/// Table 2.
pub(super) fn section(vehicles: &[Vehicle], findings: &mut Findings) -> Section {
    let etas = |values: &[f64], printed: &[f64]| {
        let three = (0..3).map(|index| match (values.get(index), printed.get(index)) {
            (Some(&ours), Some(&printed)) => beside(ours, printed),
            _ => Cell::words(""),
        });
        three.collect::<Vec<_>>()
    };
    let mut first = vec![
        Cell::words("printed (η of DCOM, SDCOM)"),
        Cell::number(TABLE_2.alpha_deg),
        Cell::number(TABLE_2.phi),
        Cell::number(TABLE_2.delta_e_deg),
    ];
    first.extend(TABLE_2.eta.map(Cell::number));
    let mut cantilever = vec![Cell::words("printed (η of FPM and COM)")];
    cantilever.extend((0..3).map(|_| Cell::words("")));
    cantilever.extend(TABLE_2.eta_cantilever.map(Cell::number));
    let mut rows = Vec::from([first, cantilever].map(Row::from));
    let mut nearest: Option<(f64, String)> = None;
    for vehicle in vehicles {
        let mut row = vec![Cell::words(name(vehicle))];
        match &vehicle.trim {
            Some(trim) => {
                row.push(beside(trim.alpha_deg, TABLE_2.alpha_deg));
                row.push(beside(trim.phi, TABLE_2.phi));
                row.push(beside(trim.delta_e_deg, TABLE_2.delta_e_deg));
                let printed: &[f64] = if ["fpm", "com"].contains(&vehicle.condition.model) {
                    &TABLE_2.eta_cantilever
                } else {
                    &TABLE_2.eta
                };
                row.extend(etas(&trim.eta, printed));
                let distance = distance(trim);
                if nearest.as_ref().is_none_or(|(least, _)| distance < *least) {
                    nearest = Some((distance, name(vehicle)));
                }
            }
            None => row.push(Cell::words(vehicle.problem.clone().unwrap_or_default())),
        }
        rows.push(Row::from(row));
    }
    if let Some((distance, name)) = nearest {
        findings.push(sentences::nearest_trim(distance, &name));
    }
    let rigid = vehicles.iter().filter_map(|vehicle| {
        let condition = &vehicle.condition;
        let trim = vehicle.trim.as_ref()?;
        (condition.model == "com_rigid").then(|| (condition.earth, distance(trim)))
    });
    Section {
        id: "table2",
        title: "Table 2",
        paragraphs: vec![sentences::trims(
            [TABLE_2.velocity, TABLE_2.altitude],
            &rigid.collect::<Vec<_>>(),
            dcom::PROVENANCE.c_n_1_alpha,
        )],
        tables: vec![Table {
            file: "table2.csv",
            caption: "Table 2 beside the trims of this project".to_owned(),
            head: vec!["model", "α [deg]", "φ", "δe [deg]", "η₁", "η₂", "η₃"],
            rows,
        }],
        pictures: Vec::new(),
    }
}
