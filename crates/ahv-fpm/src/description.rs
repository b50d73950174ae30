//! What the model says of itself, as a generated model does: with it every command takes it.

use std::fmt::Display;

use ahv_core::{
    Bounds, Component, CountVisitor, Dual, Equation, GeneratedModel, Given, ModeOfMotion,
    ParameterSet, ParameterSetOf, Real, Sought, Table, TrimProblem, Vector,
};

use crate::model::{INPUT_BOUNDS, Input, Model, Noise, STATE_BOUNDS, State, seeded, slope};
use crate::outputs::{Outputs, outputs};
use crate::table::{NOMINAL, PROVENANCE, Parameters, SET, TABLE};

impl GeneratedModel for Model<f64> {
    const NAME: &'static str = "fpm";
    const TITLE: &'static str =
        "first-principles model: forces from geometry, shocks and heat addition";
    const NOTE: Option<&'static str> = None;
    const TABLE: &'static Table = &TABLE;
    const SETS: &'static [ParameterSetOf<Self>] = &[ParameterSet::new(SET, NOMINAL, PROVENANCE)];
    const STATE_BOUNDS: State<Bounds> = STATE_BOUNDS;
    const INPUT_BOUNDS: Input<Bounds> = INPUT_BOUNDS;
    const TRIM: TrimProblem = TrimProblem {
        given: &[
            Given::new("velocity", 7702.0808, 0.0, f64::INFINITY),
            Given::new("altitude", 85000.0, f64::NEG_INFINITY, f64::INFINITY),
            Given::new(
                "gamma",
                0.0,
                -std::f64::consts::FRAC_PI_2,
                std::f64::consts::FRAC_PI_2,
            ),
        ],
        sought: &[
            Sought::new("alpha", 0.02, 0.1),
            Sought::new("eta_1", 0.0, 1.0),
            Sought::new("eta_dot_1", 0.0, 1.0),
            Sought::new("eta_2", 0.0, 1.0),
            Sought::new("eta_dot_2", 0.0, 1.0),
            Sought::new("phi", 0.25, 0.1),
            Sought::new("delta_e", 0.2, 0.1),
        ],
        equations: &[
            Equation::new("velocity", 1.0, Some(("gamma", "velocity"))),
            Equation::new("gamma", 1.0, None),
            Equation::new("pitch_rate", 1.0, None),
            Equation::new("eta_1", 100.0, None),
            Equation::new("eta_dot_1", 100.0, None),
            Equation::new("eta_2", 100.0, None),
            Equation::new("eta_dot_2", 100.0, None),
        ],
        moving: &["altitude"],
        shown: &["alpha", "phi", "delta_e", "eta_1", "eta_2"],
    };
    const MODES: &'static [ModeOfMotion] = &[
        ModeOfMotion::new(
            "phugoid",
            &["velocity", "altitude", "gamma"],
            Some("height"),
        ),
        ModeOfMotion::new("short period", &["alpha", "pitch_rate"], None),
        ModeOfMotion::new("flexible 1", &["eta_1", "eta_dot_1"], None),
        ModeOfMotion::new("flexible 2", &["eta_2", "eta_dot_2"], None),
    ];
    const DEFAULT_INPUTS: &'static [&'static str] = &["phi", "delta_e"];
    const DEFAULT_OUTPUTS: &'static [&'static str] = &["velocity", "gamma"];
    const DEVIATIONS: &'static [(&'static str, f64)] = &[
        ("velocity", 10.0),
        ("altitude", 100.0),
        ("gamma", 0.01),
        ("alpha", 0.02),
        ("pitch_rate", 0.05),
        ("phi", 0.2),
        ("delta_e", 0.05),
    ];

    type ParametersOf<T: Component> = Parameters<T>;
    type StateOf<T: Component> = State<T>;
    type InputOf<T: Component> = Input<T>;
    type NoiseOf<T: Component> = Noise<T>;
    type OutputsOf<T: Component> = Outputs<T>;
    type With<R: Real> = Model<R>;

    fn coloured<V: CountVisitor>(_: V) -> Option<V::Output> {
        None
    }

    fn fault(&self, x: &State<f64>, u: &Input<f64>) -> Option<impl Display> {
        self.forces_beyond(x, u).err()
    }

    /// By dual numbers: a drift for each parameter.
    fn parameter_jacobian(&self, x: &State<f64>, u: &Input<f64>) -> State<Parameters<f64>> {
        let p = self.parameters.map_ref(|&it| Dual::constant(it));
        let (x, u) = (
            x.map_ref(|&it| Dual::constant(it)),
            u.map_ref(|&it| Dual::constant(it)),
        );
        let columns = <Parameters<State<Dual>>>::from_fn(|column| {
            ahv_core::Model::drift(&Model::new(&seeded(p, column)), &x, &u)
        });
        Vector::from_fn(|row| columns.map_ref(|rates| slope(rates, row)))
    }

    fn outputs<R: Real>(model: &Model<R>, x: &State<R>, u: &Input<R>) -> Outputs<R> {
        outputs(model, x, u)
    }

    ahv_core::model_functions!();
}
