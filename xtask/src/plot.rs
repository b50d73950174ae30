//! A picture of the demo's flights.

use std::fs;
use std::path::Path;

use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel};

use crate::trajectory::Trajectory;

/// One model with the table's value of the coefficient and with another.
pub(crate) struct Pair {
    pub(crate) model: String,
    pub(crate) nominal: Trajectory,
    pub(crate) changed: Trajectory,
}

/// Rows of the picture: the states to show (the first that a model has), and what to call them.
const ROWS: [(&[&str], &str); 5] = [
    (&["velocity"], "velocity"),
    (&["altitude"], "altitude"),
    (&["alpha"], "angle of attack"),
    (&["pitch_rate"], "pitch rate"),
    (&["eta_1", "chi_1"], "flexible coordinate"),
];

/// Draws one column a model and one row a state; `names` are those of the nominal flights and of the changed ones.
pub(crate) fn draw(pairs: &[Pair], names: &[String; 2], path: &Path) -> Result<(), String> {
    let panels = ROWS
        .iter()
        .flat_map(|(states, title)| pairs.iter().map(|pair| panel(states, title, pair, names)));
    let figure = Figure::new("", pairs.len(), panels.collect::<Result<_, _>>()?);
    let problem = |why: String| format!("error: cannot draw {}: {why}", path.display());
    let svg = figure.svg().map_err(|error| problem(error.to_string()))?;
    fs::write(path, svg).map_err(|error| problem(error.to_string()))
}

fn panel(states: &[&str], title: &str, pair: &Pair, names: &[String; 2]) -> Result<Panel, String> {
    let mut states = states.iter();
    let state = states
        .find(|state| pair.nominal.series(state).is_some())
        .ok_or_else(|| format!("error: {} has no {title}", pair.model))?;
    let series = |flight: &Trajectory| {
        let (unit, points) = flight.series(state).unwrap_or_default();
        in_degrees(unit, points)
    };
    let ((unit, nominal), (_, changed)) = (series(&pair.nominal), series(&pair.changed));
    let [nominal_name, changed_name] = names;
    Ok(Panel {
        title: format!("{}: {title}", pair.model),
        x: Axis::linear("time [s]"),
        y: Axis::linear(format!("{state} [{unit}]")),
        layers: vec![
            Layer::new(nominal_name.as_str(), Colour::Blue, Mark::Line(nominal)),
            Layer::new(
                changed_name.as_str(),
                Colour::Vermillion,
                Mark::Line(changed),
            )
            .dashed(),
        ],
    })
}

/// Angles are read in degrees.
fn in_degrees(unit: &str, mut points: Vec<(f64, f64)>) -> (String, Vec<(f64, f64)>) {
    if !unit.starts_with("rad") {
        return (unit.to_owned(), points);
    }
    for (_, value) in &mut points {
        *value = value.to_degrees();
    }
    (unit.replacen("rad", "deg", 1), points)
}
