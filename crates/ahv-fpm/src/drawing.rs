//! A side view of the vehicle in its flow: outline, shocks and expansions, stream, turns and pressures.

use ahv_plot::{Axis, Colour, Figure, Layer, Mark, Panel, PlotError};

use crate::surfaces::Turned;
use crate::{Flow, Model};

/// Width and height of the picture, in pixels.
const SIZE: (u32, u32) = (1100, 560);
/// Width of the picture over the vehicle's length.
const ROOM: f64 = 1.35;
/// A line of text, over the vehicle's length.
const LINE: f64 = 0.034;

type Point = (f64, f64);

/// The picture of a flow of the model at angle of attack `alpha` and elevator `delta_e`, rad, as SVG.
///
/// Feet aft of and above the nose, in body axes.
///
/// # Errors
///
/// [`PlotError`] where a number is not finite.
pub fn drawing(
    model: &Model<f64>,
    flow: &Flow<f64>,
    alpha: f64,
    delta_e: f64,
    title: &str,
) -> Result<String, PlotError> {
    let p = &model.parameters;
    let shape = Shape::new(model);
    let length = shape.length;
    let mut layers = vec![
        Layer::new("vehicle", Colour::Black, Mark::Line(shape.outline())),
        Layer::new("vehicle", Colour::Black, Mark::Line(shape.cowl(p.h_i))),
        Layer::new(
            "vehicle",
            Colour::Black,
            Mark::Line(shape.elevator(model, delta_e)),
        ),
    ];
    for (flow, from, below) in [
        (&flow.bow, shape.nose, true),
        (&flow.upper, shape.nose, false),
        (&flow.underside, shape.lip, true),
    ] {
        layers.push(wave(flow, alpha, from, below, 0.45 * length));
    }
    let stream = &flow.stream;
    layers.push(shape.cowl_wave(&stream.cowl, p.h_i, p.tau_l));
    let bottom = shape.lip.1 - p.h_i * (p.a_n - 1.0).min(2.0);
    let edge = vec![(shape.lip.0 + p.l_n, shape.lip.1), (length, bottom)];
    layers.push(
        Layer::new(
            "edge of the exhaust, as a sign",
            Colour::Grey,
            Mark::Line(edge),
        )
        .dashed(),
    );
    layers.extend(labels(flow, &shape));
    let height = f64::from(SIZE.1) / f64::from(SIZE.0) * ROOM * length;
    let panel = Panel {
        title: String::new(),
        x: Axis::linear("aft of the nose [ft]").within(-0.12 * length, (ROOM - 0.12) * length),
        y: Axis::linear("above the nose [ft]").within(-0.6 * height, 0.4 * height),
        layers,
    };
    Figure {
        panel_size: SIZE,
        ..Figure::new(title, 1, vec![panel])
    }
    .svg()
}

/// Points of the outline.
struct Shape {
    length: f64,
    nose: Point,
    /// End of the forebody.
    inlet: Point,
    lip: Point,
    /// End of the engine, at the body.
    ramp: Point,
    tail: Point,
}

impl Shape {
    fn new(model: &Model<f64>) -> Self {
        let p = &model.parameters;
        let length = p.l_f + p.l_n + p.l_a;
        let depth = p.l_f * p.tau_l.tan();
        Self {
            length,
            nose: (0.0, 0.0),
            inlet: (p.l_f, -depth),
            lip: (p.l_f, -depth - p.h_i),
            ramp: (p.l_f + p.l_n, -depth),
            tail: (length, length * p.tau_u.tan()),
        }
    }

    fn outline(&self) -> Vec<Point> {
        vec![self.nose, self.tail, self.ramp, self.inlet, self.nose]
    }

    fn cowl(&self, height: f64) -> Vec<Point> {
        vec![self.lip, (self.ramp.0, self.ramp.1 - height)]
    }

    fn elevator(&self, model: &Model<f64>, delta_e: f64) -> Vec<Point> {
        let p = &model.parameters;
        let hinge = (p.x_cm + p.x_e, -p.z_el);
        let half = 0.5 * p.s_e;
        let end = |side: f64| {
            (
                hinge.0 + side * half * delta_e.cos(),
                hinge.1 - side * half * delta_e.sin(),
            )
        };
        vec![end(-1.0), end(1.0)]
    }

    /// The shock that the cowl lip sends into the inlet, up to the body.
    fn cowl_wave(&self, cowl: &Turned<f64>, height: f64, slope: f64) -> Layer {
        // The flow ahead comes down along the forebody.
        let rise = (cowl.wave() - slope).tan();
        let reach = (height / rise).min(self.ramp.0 - self.lip.0);
        let end = (self.lip.0 + reach, self.lip.1 + reach * rise);
        Layer::new(kind(cowl), colour(cowl), Mark::Line(vec![self.lip, end]))
    }
}

fn kind(flow: &Turned<f64>) -> &'static str {
    if flow.turn < 0.0 {
        "first wave of an expansion"
    } else {
        "shock"
    }
}

fn colour(flow: &Turned<f64>) -> Colour {
    if flow.turn < 0.0 {
        Colour::SkyBlue
    } else {
        Colour::Vermillion
    }
}

/// A shock or the first wave of an expansion from a corner, below or above the vehicle.
fn wave(flow: &Turned<f64>, alpha: f64, (x, y): Point, below: bool, reach: f64) -> Layer {
    // The air comes from below by the angle of attack.
    let slope = if below {
        (alpha - flow.wave()).tan()
    } else {
        (alpha + flow.wave()).tan()
    };
    let end = (x + reach, y + slope * reach);
    Layer::new(kind(flow), colour(flow), Mark::Line(vec![(x, y), end]))
}

/// Turns, Mach numbers and pressures beside what they are of.
fn labels(flow: &Flow<f64>, shape: &Shape) -> Vec<Layer> {
    let stream = &flow.stream;
    let length = shape.length;
    let of = |name: &str, flow: &Turned<f64>, over: &str| {
        format!(
            "{name}: turn {:.2}°, Mach {:.3}, p/{over} {:.3}",
            flow.turn.to_degrees(),
            flow.mach,
            flow.pressure
        )
    };
    let turned = |name: &str, flow: &Turned<f64>| of(name, flow, "p∞");
    let [lower, upper] = &flow.elevator;
    let inside = stream.heat.pressure * stream.diffuser.pressure * stream.cowl.pressure;
    let air = format!(
        "air: Mach {:.3}, {:.2} lb/ft²",
        flow.mach, flow.air.pressure
    );
    let captured = format!(
        "mass flow {:.3} slug/(s ft), {}",
        stream.mass_flow,
        spilled(stream.capture)
    );
    let combustor = format!(
        "combustor: Mach {:.3}, p/p∞ {:.2}",
        stream.heat.mach,
        inside * flow.bow.pressure
    );
    let nozzle = format!(
        "nozzle: Mach {:.3}, p/p∞ {:.3}, {:.0} ft/s",
        stream.nozzle.mach, stream.exit_pressure, stream.exit_velocity
    );
    let above = (0.1 * length, shape.tail.1 + 0.12 * length);
    let low = shape.lip.1 - 0.12 * length;
    let columns = [
        (above, vec![air, turned("upper surface", &flow.upper)]),
        (
            (-0.1 * length, low),
            vec![
                turned("forebody", &flow.bow),
                of("cowl", &stream.cowl, "p of the forebody"),
                captured,
                combustor,
                nozzle,
            ],
        ),
        (
            (0.6 * length, low),
            vec![
                turned("engine underside", &flow.underside),
                turned("elevator, lower face", lower),
                turned("elevator, upper face", upper),
            ],
        ),
    ];
    let lines = columns.into_iter().flat_map(|((x, y), texts)| {
        let lines = texts.into_iter().enumerate();
        lines.map(move |(row, text)| {
            let at = (x, y - row as f64 * LINE * length);
            Layer::new("", Colour::Black, Mark::Label { at, text })
        })
    });
    lines.collect()
}

/// Whether the bow shock passes the lip outside.
fn spilled(capture: f64) -> String {
    if capture > 1.0 {
        "the bow shock passes below the lip: spillage".to_owned()
    } else {
        "the bow shock is inside the lip".to_owned()
    }
}
