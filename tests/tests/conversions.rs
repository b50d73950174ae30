//! States, inputs and Jacobians as arrays and as nalgebra's static types.

use ahv_core::{Bounds, DifferentiableModel, Vector};
use ahv_models::dcom::{
    INPUT_BOUNDS, Input, InputJacobian, Model, NOMINAL, PROVENANCE, STATE_BOUNDS, State,
    StateJacobian,
};
use approx::assert_abs_diff_eq;
use nalgebra::{SMatrix, SVector};

fn state() -> State<f64> {
    State::from_fn(|i| i as f64 + 0.5)
}

#[test]
fn arrays_keep_the_order_of_the_names() {
    let x = state();
    let array: [f64; 11] = x.into();
    assert_eq!(array[3], x.alpha);
    assert_eq!(State::<f64>::NAMES[3], "alpha");
    assert_eq!(State::<f64>::UNITS[3], "rad");
    assert_eq!(State::from(array), x);
}

#[test]
fn vectors_convert_to_nalgebra_and_back() {
    let x = state();
    let column: SVector<f64, 11> = x.into();
    assert_eq!(column[2], x.gamma);
    assert_eq!(State::from(column), x);
}

/// A Jacobian as a matrix: rows are rates, columns are states or inputs.
#[test]
fn jacobians_convert_to_nalgebra_and_back() {
    let model = Model::new(&NOMINAL);
    let x = State {
        velocity: 7702.0,
        altitude: 85_000.0,
        alpha: 0.03,
        ..State::splat(0.01)
    };
    let u = Input {
        phi: 0.28,
        delta_e: 0.2,
        delta_c: 0.0,
    };
    let (by_state, by_input) = model.jacobians(&x, &u);
    let a: SMatrix<f64, 11, 11> = by_state.into();
    let b: SMatrix<f64, 11, 3> = by_input.into();
    assert_eq!(a[(0, 3)], by_state.velocity.alpha);
    assert_eq!(a[(1, 0)], by_state.altitude.velocity);
    assert_eq!(b[(4, 1)], by_input.pitch_rate.delta_e);
    assert_eq!(StateJacobian::from(a), by_state);
    assert_eq!(InputJacobian::from(b), by_input);
    // The rows of gamma and alpha add up to the pitch rate: a check of rows against columns.
    assert_abs_diff_eq!(by_state.gamma.alpha, -by_state.alpha.alpha, epsilon = 1e-15);
    assert_eq!(by_state.alpha.pitch_rate, 1.0);
}

#[test]
fn single_precision_is_a_map_away() {
    let single = NOMINAL.map_into(|value| value as f32);
    assert_eq!(single.c_l_alpha, 4.6773_f32);
}

#[test]
fn the_box_and_the_provenance_come_from_the_table() {
    assert_eq!(STATE_BOUNDS.velocity, Bounds::new(7000.0, 11000.0));
    assert_abs_diff_eq!(
        INPUT_BOUNDS.delta_e.max,
        20f64.to_radians(),
        epsilon = 1e-16
    );
    assert_eq!(STATE_BOUNDS.eta_2, STATE_BOUNDS.eta_1);
    assert_eq!(PROVENANCE.c_l_alpha.source, "parker2007");
    assert_eq!(PROVENANCE.c_l_delta_c.status, ahv_core::Status::Derived);
    assert_eq!(PROVENANCE.c_l_alpha.uncertainty, 0.4);
}

/// Thrust coefficients of the DCOM are those of the COM over q S at the reference condition.
#[test]
fn derived_thrust_is_the_com_thrust() {
    let force = 2000.01 * 17.0;
    let com = ahv_models::com::NOMINAL;
    for (dcom, com) in [
        (NOMINAL.c_t_phi_alpha_3, com.t_phi_alpha_3),
        (NOMINAL.c_t_phi_alpha_2, com.t_phi_alpha_2),
        (NOMINAL.c_t_phi_alpha, com.t_phi_alpha),
        (NOMINAL.c_t_phi, com.t_phi),
        (NOMINAL.c_t_alpha_3, com.t_alpha_3),
        (NOMINAL.c_t_alpha_2, com.t_alpha_2),
        (NOMINAL.c_t_alpha, com.t_alpha),
        (NOMINAL.c_t_0, com.t_0),
    ] {
        approx::assert_relative_eq!(dcom * force, com, max_relative = 1e-7);
    }
}
