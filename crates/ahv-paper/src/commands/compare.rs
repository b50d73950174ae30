//! `ahv compare`: the first-principles model beside the published curve fits of the COM.

use std::path::PathBuf;

use ahv_cli::csv_file::CsvFile;
use ahv_cli::failure::{Failure, all, print};
use ahv_cli::output;
use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError};
use clap::Args;
use serde::Serialize;

use super::number::significant;
use crate::compare::{
    COMPARED, Deviation, ELEVATORS, Point, RATIOS, VARIATIONS, deviations, points,
};

/// Compares the first-principles model with the published curve fits of the COM, over the box of the fits.
///
/// alpha -1 to 5 deg, elevator 0 to 15 deg, phi 0.1 to 0.5 at the velocity and altitude of Table 2, rigid: axial force, normal force and
/// pitching moment, since bookkeepings of thrust differ. docs/first-principles.md says where the deviations come from.
#[derive(Args)]
pub(crate) struct Arguments {
    /// Folder for compare.csv and compare.svg
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Print what changes of the geometry table do to the deviations, in the place of the comparison
    #[arg(long, conflicts_with_all = ["out", "json"])]
    variations: bool,

    /// Print points and deviations as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Json<'a> {
    points: &'a [Point],
    axial_force: Deviation,
    normal_force: Deviation,
    pitching_moment: Deviation,
}

/// Runs the command.
///
/// # Errors
///
/// [`Failure::Request`] for a file that cannot be written, [`Failure::Numeric`] where the model has no flow.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if arguments.variations {
        return print(&variations()?);
    }
    let folder = arguments.out.as_deref();
    if let Some(folder) = folder {
        output::folder(folder)?;
    }
    let points = points().map_err(|fault| Failure::Numeric(format!("fpm: {fault}")))?;
    let found = deviations(&points);
    let written = folder.map_or(Ok(()), |folder| csv(&points, &folder.join("compare.csv")));
    let printed = if arguments.json {
        let [axial_force, normal_force, pitching_moment] = found;
        output::print_json(&Json {
            points: &points,
            axial_force,
            normal_force,
            pitching_moment,
        })
    } else {
        print(&text(&found, points.len()))
    };
    let drawn = folder.map_or(Ok(()), |folder| {
        output::picture(&folder.join("compare.svg"), figure(&points))
    });
    all([written, printed, drawn])
}

/// The deviations with each change, in % of the root mean square of COM; in brackets without their mean.
fn variations() -> Result<String, Failure> {
    let heading = COMPARED.map(|(name, _)| format!("{name:>20}")).concat();
    let lines = VARIATIONS.iter().map(|it| {
        let points = it
            .points()
            .map_err(|fault| Failure::Numeric(format!("fpm, {}: {fault}", it.name)))?;
        let cells = deviations(&points).map(|it| {
            let percent = |value: f64| 100.0 * value / it.size;
            let cell = format!("{:.0} ({:.0})", percent(it.difference), percent(it.rest));
            format!("{cell:>20}")
        });
        Ok(format!("{:<42}{}", it.name, cells.concat()))
    });
    let lines = lines.collect::<Result<Vec<String>, Failure>>()?;
    Ok(format!(
        "root mean square of fpm less com in % of com; in brackets without the mean\n{:<42}{heading}\n{}",
        "",
        lines.join("\n")
    ))
}

fn text(found: &[Deviation; 3], count: usize) -> String {
    let lines = COMPARED.iter().zip(found).map(|((name, unit), it)| {
        let changes = |it: [f64; 3]| it.map(significant).join(", ");
        format!(
            "{name} [{unit}]\n  root mean square: difference {}, com {}, so {:.0} %\n  mean difference {}, without it {} are left, {:.0} %\n  \
             change over the box with alpha, phi, delta_e: fpm {}; com {}",
            significant(it.difference),
            significant(it.size),
            100.0 * it.difference / it.size,
            significant(it.mean),
            significant(it.rest),
            100.0 * it.rest / it.size,
            changes(it.fpm_changes),
            changes(it.com_changes),
        )
    });
    let lines: Vec<String> = lines.collect();
    format!("fpm beside com at {count} points\n{}", lines.join("\n"))
}

fn csv(points: &[Point], path: &std::path::Path) -> Result<(), Failure> {
    let mut file = CsvFile::create(path)?;
    let mut header = vec![
        "alpha [deg]".to_owned(),
        "delta_e [deg]".to_owned(),
        "phi [1]".to_owned(),
    ];
    for (name, unit) in COMPARED {
        header.extend(["fpm", "com"].map(|model| format!("{model} {name} [{unit}]")));
    }
    file.row(&header)?;
    for it in points {
        let mut row = vec![it.alpha_deg, it.delta_e_deg, it.phi];
        row.extend(it.fpm.iter().zip(it.com).flat_map(|(&fpm, com)| [fpm, com]));
        file.numbers(&row)?;
    }
    file.finish()
}

/// Each quantity over α at the least and the greatest elevator and fuel.
fn figure(points: &[Point]) -> Result<String, PlotError> {
    let corners = [
        (ELEVATORS[0], RATIOS[0]),
        (ELEVATORS[0], RATIOS[4]),
        (ELEVATORS[3], RATIOS[0]),
        (ELEVATORS[3], RATIOS[4]),
    ];
    let panels = COMPARED.iter().enumerate().map(|(index, (name, unit))| {
        let layers = corners
            .iter()
            .zip(Colour::CYCLE)
            .flat_map(|(&(delta_e, phi), colour)| {
                let at = |it: &&Point| it.delta_e_deg == delta_e && it.phi == phi;
                let line = |of: fn(&Point) -> [f64; 3]| {
                    let points = points.iter().filter(at);
                    Mark::Line(points.map(|it| (it.alpha_deg, of(it)[index])).collect())
                };
                let words = format!("δe {delta_e}°, φ {phi}");
                [
                    Layer::new(format!("fpm, {words}"), colour, line(|it| it.fpm)),
                    Layer::new(format!("com, {words}"), colour, line(|it| it.com)).dashed(),
                ]
            });
        Panel {
            title: (*name).to_owned(),
            x: Axis::linear("angle of attack [deg]"),
            y: Axis::linear(format!("{name} [{unit}]")),
            layers: layers.collect(),
        }
    });
    Figure::new(
        "First-principles model and published fits of the COM",
        3,
        panels.collect(),
    )
    .svg()
}
