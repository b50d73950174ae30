//! Samples for the curve fits of COM and DCOM: their coefficients at a point, from geometry.
//!
//! Lift and drag are those of all surfaces and of the turn at the inlet, thrust is the axial force of inlet and nozzle, as in
//! [`crate::Outputs`]; the moment of a table's thrust line is taken off the pitching moment, since the table adds it.

use ahv_fit::{Ask, Sampler, Source, Variable};

use crate::canard::Canard;
use crate::free::FreeMode;
use crate::surfaces::{Load, Surface};
use crate::{Input, Model, NOMINAL, State};

/// The first-principles model as a source of samples, with the geometry that the crate was built with.
pub const SOURCE: &dyn Source = &FirstPrinciples;

struct FirstPrinciples;

const DEGREE: f64 = std::f64::consts::PI / 180.0;

/// What samples are drawn over, unless another interval is asked for: about the trim of Table 2, where the engine does not choke.
const BOX: [Variable; 6] = [
    variable("velocity", "ft/s", 7500.0, 7900.0),
    variable("altitude", "ft", 84_000.0, 86_000.0),
    variable("alpha", "rad", -DEGREE, 5.0 * DEGREE),
    variable("phi", "1", 0.1, 0.5),
    variable("delta_e", "rad", -15.0 * DEGREE, 15.0 * DEGREE),
    variable("delta_c", "rad", -15.0 * DEGREE, 15.0 * DEGREE),
];

/// Coordinates of free-free modes, in the order of their numbers.
const MODES: [Variable; 4] = [
    variable("eta_1", "(ft*slug)^0.5", -1.0, 1.0),
    variable("eta_2", "(ft*slug)^0.5", -1.0, 1.0),
    variable("eta_3", "(ft*slug)^0.5", -1.0, 1.0),
    variable("eta_4", "(ft*slug)^0.5", -1.0, 1.0),
];

const fn variable(name: &'static str, unit: &'static str, low: f64, high: f64) -> Variable {
    Variable {
        name,
        unit,
        interval: (low, high),
    }
}

/// A fitted quantity.
#[derive(Clone, Copy, Debug)]
enum Quantity {
    /// In lb/ft.
    Thrust,
    ThrustCoefficient,
    Lift,
    Drag,
    Moment,
    /// Generalized force of a clamped beam: 0 forebody, 1 aftbody.
    Clamped(usize),
    /// Coefficient of the generalized force of a free-free mode.
    Free(usize),
}

struct Coefficients {
    model: Model<f64>,
    variables: Vec<Variable>,
    quantities: Vec<Quantity>,
    modes: Vec<FreeMode>,
    area: f64,
    chord: f64,
    thrust_line: f64,
}

impl Source for FirstPrinciples {
    fn name(&self) -> &'static str {
        "fpm"
    }

    fn sampler(&self, ask: &Ask<'_>) -> Result<Box<dyn Sampler>, String> {
        let number = |name: &str, prefix: &str| name.strip_prefix(prefix)?.parse::<usize>().ok();
        let of = |name: &&str| {
            let numbered = |prefix, most: usize| {
                number(name, prefix)
                    .filter(|it| (1..=most).contains(it))
                    .map(|it| it - 1)
            };
            let quantity = match *name {
                "T" => Quantity::Thrust,
                "C_T" => Quantity::ThrustCoefficient,
                "C_L" => Quantity::Lift,
                "C_D" => Quantity::Drag,
                "C_M" => Quantity::Moment,
                _ => numbered("N_", 2)
                    .map(Quantity::Clamped)
                    .or(numbered("C_N_", MODES.len()).map(Quantity::Free))
                    .ok_or_else(|| {
                        let known = "T, C_T, C_L, C_D, C_M, N_1, N_2, C_N_1 to C_N_4";
                        format!("it has no quantity `{name}`; it has {known}")
                    })?,
            };
            Ok(quantity)
        };
        let quantities = ask.quantities.iter().map(of);
        let quantities = quantities.collect::<Result<Vec<Quantity>, String>>()?;
        let free = quantities.iter().filter_map(|it| match it {
            Quantity::Free(index) => Some(index + 1),
            _ => None,
        });
        let modes = free.max().unwrap_or(0);
        let known: Vec<Variable> = BOX
            .into_iter()
            .chain(MODES.into_iter().take(modes))
            .collect();
        for name in ask.variables {
            if !known.iter().any(|it| it.name == *name) {
                let known: Vec<&str> = known.iter().map(|it| it.name).collect();
                let known = known.join(", ");
                return Err(format!("it has no variable `{name}`; it has {known}"));
            }
        }
        // The air varies in any case, the rest where the table has it.
        let wanted = |it: &Variable| {
            ["velocity", "altitude"].contains(&it.name) || ask.variables.contains(&it.name)
        };
        let parameter = |name: &str| {
            let found = (ask.parameter)(name);
            found.ok_or_else(|| format!("the table has no parameter `{name}`"))
        };
        Ok(Box::new(Coefficients {
            model: Model::new(&NOMINAL),
            variables: known.into_iter().filter(wanted).collect(),
            quantities,
            modes: (1..=modes as u32)
                .map(|it| FreeMode::new(&NOMINAL, it))
                .collect(),
            area: parameter("s")?,
            chord: parameter("c_bar")?,
            thrust_line: parameter("z_t")?,
        }))
    }
}

impl Sampler for Coefficients {
    fn variables(&self) -> &[Variable] {
        &self.variables
    }

    fn at(&self, point: &[f64]) -> Result<Vec<f64>, String> {
        let of = |name: &str| {
            let index = self.variables.iter().position(|it| it.name == name);
            index.and_then(|it| point.get(it)).copied()
        };
        let value = |name: &str| of(name).unwrap_or(0.0);
        let etas = self.modes.iter().zip(MODES);
        let nose: f64 = etas
            .map(|(mode, it)| mode.nose_slope * value(it.name))
            .sum();
        let alpha = value("alpha");
        let x = State {
            velocity: value("velocity"),
            altitude: value("altitude"),
            alpha,
            // Of all shapes the flow feels the nose's slope alone.
            eta_1: nose / self.model.structure.nose_slope,
            ..State::from_array([0.0; 9])
        };
        let u = Input {
            phi: value("phi"),
            delta_e: value("delta_e"),
        };
        let flow = self
            .model
            .forces_beyond(&x, &u)
            .map_err(|it| it.to_string())?;
        let p = &self.model.parameters;
        let canard = of("delta_c").map(|it| Canard::new(p, &flow, alpha, it));
        if let Some(fault) = canard.and_then(|it| it.fault(p.kappa)) {
            return Err(fault.to_string());
        }
        let total = flow.total().and(canard.map_or(Load::NONE, |it| it.load));
        let axial = |surface: Surface| flow.loads[surface as usize].axial;
        let thrust = axial(Surface::Inlet) + axial(Surface::Nozzle);
        let rest = total.axial - thrust;
        let (sin, cos) = alpha.sin_cos();
        let force = 0.5 * flow.air.density * x.velocity * x.velocity * self.area;
        let quantity = |it: &Quantity| match *it {
            Quantity::Thrust => thrust,
            Quantity::ThrustCoefficient => thrust / force,
            Quantity::Lift => (total.normal * cos + rest * sin) / force,
            Quantity::Drag => (total.normal * sin - rest * cos) / force,
            Quantity::Moment => (total.moment - self.thrust_line * thrust) / (force * self.chord),
            Quantity::Clamped(index) => flow.generalized[index],
            Quantity::Free(index) => self.modes[index].force(&flow, canard.as_ref()) / force,
        };
        Ok(self.quantities.iter().map(quantity).collect())
    }
}
