//! Every generated function at a point, by the names that the oracle uses.

use ahv_core::{Real, Vector};
use std::collections::BTreeMap;

/// Values by label.
pub type Values = BTreeMap<String, f64>;

/// The models that are tested.
pub const MODELS: [&str; 3] = ["com", "dcom", "sdcom"];

/// The vector of a kind (`state`, `input`, `noise`, `parameter`) from a point's numbers.
///
/// # Panics
/// When the point lacks a component.
pub fn vector<R: Real, V: Vector<R>>(kind: &str, inputs: &BTreeMap<String, f64>) -> V {
    V::from_fn(|index| {
        let label = format!("{kind}.{}", V::NAMES[index]);
        R::from_f64(
            *inputs
                .get(&label)
                .unwrap_or_else(|| panic!("the point has no {label}; run `cargo xtask vectors`")),
        )
    })
}

fn put<R: Real, V: Vector<R>>(values: &mut Values, prefix: &str, of: &V) {
    for (index, name) in V::NAMES.iter().enumerate() {
        let component = of.get(index).map_or(f64::NAN, Real::to_f64);
        values.insert(format!("{prefix}.{name}"), component);
    }
}

fn put_rows<R: Real, C: Vector<R>, V: Vector<C>>(values: &mut Values, prefix: &str, of: &V) {
    for (index, name) in V::NAMES.iter().enumerate() {
        if let Some(row) = of.get(index) {
            put(values, &format!("{prefix}.{name}"), &row);
        }
    }
}

macro_rules! deterministic {
    ($model:ident, $real:ty, $inputs:expr) => {{
        use ahv_models::$model::{self as model, Input, Parameters, State};
        let x: State<$real> = vector("state", $inputs);
        let u: Input<$real> = vector("input", $inputs);
        let p = model::prepare(&vector::<$real, Parameters<$real>>("parameter", $inputs));
        let mut values = Values::new();
        put(&mut values, "drift", &model::drift(&x, &u, &p));
        let (by_state, by_input) = model::jacobians(&x, &u, &p);
        put_rows(&mut values, "jacobians.state", &by_state);
        put_rows(&mut values, "jacobians.input", &by_input);
        // Computed at one go, they are the same numbers: the oracle needs no second look at them.
        let at_one_go = model::drift_and_jacobians(&x, &u, &p);
        assert_eq!(at_one_go, (model::drift(&x, &u, &p), by_state, by_input));
        (values, x, u, p)
    }};
}

macro_rules! scalars {
    ($values:ident, $model:ident, $arguments:tt, $($name:ident)*) => {
        $($values.insert(stringify!($name).to_owned(), scalars!(@call $model $name $arguments).to_f64());)*
    };
    (@call $model:ident $name:ident ($x:expr, $u:expr, $p:expr)) => { ahv_models::$model::$name($x, $u, $p) };
}

macro_rules! arrays {
    ($values:ident, ($x:expr, $u:expr, $p:expr), $($name:ident)*) => {
        $(for (index, value) in ahv_models::sdcom::$name($x, $u, $p).into_iter().enumerate() {
            $values.insert(format!("{}.{index}", stringify!($name)), value.to_f64());
        })*
    };
}

fn com<R: Real + PartialEq>(inputs: &BTreeMap<String, f64>) -> Values {
    let (mut values, x, u, p) = deterministic!(com, R, inputs);
    scalars!(values, com, (&x, &u, &p),
        density dynamic_pressure c_l c_d c_m thrust lift drag pitching_moment);
    values
}

fn dcom<R: Real + PartialEq>(inputs: &BTreeMap<String, f64>) -> Values {
    let (mut values, x, u, p) = deterministic!(dcom, R, inputs);
    scalars!(values, dcom, (&x, &u, &p),
        density dynamic_pressure c_l c_d c_m c_t thrust lift drag pitching_moment
        c_n_1 c_n_2 c_n_3 generalized_force_1 generalized_force_2 generalized_force_3);
    values
}

fn sdcom<R: Real + PartialEq>(inputs: &BTreeMap<String, f64>) -> Values {
    let (mut values, x, u, p) = deterministic!(sdcom, R, inputs);
    let dw: ahv_models::sdcom::Noise<R> = vector("noise", inputs);
    put_rows(
        &mut values,
        "diffusion",
        &ahv_models::sdcom::diffusion(&x, &u, &p),
    );
    put(
        &mut values,
        "noise_increment",
        &ahv_models::sdcom::noise_increment(&x, &u, &p, &dw),
    );
    scalars!(values, sdcom, (&x, &u, &p),
        density dynamic_pressure c_l c_d c_m c_t thrust lift drag pitching_moment
        c_n_1 c_n_2 c_n_3 generalized_force_1 generalized_force_2 generalized_force_3
        eta_static_1 eta_static_2 eta_static_3 eta_1 eta_2 eta_3
        f_V g_V H_V f_V_eta f_gamma g_gamma H_gamma f_gamma_eta
        f_alpha g_alpha H_alpha f_alpha_eta f_Q g_Q H_Q f_Q_eta g_Q_total);
    arrays!(values, (&x, &u, &p), h_V h_gamma h_alpha h_Q);
    values
}

/// All functions of a model at a point, computed in `R`.
///
/// # Panics
/// When the model is unknown or the point lacks a number.
pub fn evaluate<R: Real + PartialEq>(model: &str, inputs: &BTreeMap<String, f64>) -> Values {
    match model {
        "com" => com::<R>(inputs),
        "dcom" => dcom::<R>(inputs),
        "sdcom" => sdcom::<R>(inputs),
        other => panic!("unknown model {other}"),
    }
}
