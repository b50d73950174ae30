//! Named vectors and their conversions, on a vector made as the generated code makes them.
#![forbid(unsafe_code)]

use ahv_core::{Bounds, Real, Vector, entries, first_outside};
use nalgebra::{SMatrix, SVector};

#[derive(Clone, Copy, Debug, PartialEq)]
/// A state.
pub struct State<T> {
    velocity: T,
    alpha: T,
    eta: T,
}

ahv_core::impl_vector! {
    State {
        velocity: ["ft/s", "m/s", 0.3048],
        alpha: ["rad", "rad", 1.0],
        eta: ["1", "1", 1.0],
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Input<T> {
    phi: T,
}

ahv_core::impl_vector!(Input {
    phi: ["1", "1", 1.0]
});
ahv_core::impl_nalgebra!(State by State, Input);

const X: State<f64> = State {
    velocity: 1.0,
    alpha: 2.0,
    eta: 3.0,
};

fn units<T, V: Vector<T>>(_: &V) -> &'static [&'static str] {
    V::UNITS
}

#[test]
fn components_are_reached_by_index_and_name() {
    assert_eq!(State::<f64>::index_of("alpha"), Some(1));
    assert_eq!(State::<f64>::index_of("beta"), None);
    assert_eq!((X.get(1), X.get(3)), (Some(2.0), None));
    assert_eq!(units::<f64, _>(&X), ["ft/s", "rad", "1"]);
    let mut x = X;
    assert_eq!((x.set(2, 7.0), x.set(3, 8.0)), (Some(()), None));
    assert_eq!(x, State { eta: 7.0, ..X });
    assert_eq!(X.find(|c| c > 1.5), Some(("alpha", 2.0)));
    assert_eq!(X.find(|c| c > 5.0), None);
}

#[test]
fn components_are_built_and_combined() {
    assert_eq!(
        State::splat(2.0),
        State {
            velocity: 2.0,
            alpha: 2.0,
            eta: 2.0
        }
    );
    assert_eq!(
        <State<usize> as Vector<usize>>::from_fn(|i| i).to_array(),
        [0, 1, 2]
    );
    assert_eq!(X.map(|c| 2.0 * c).to_array(), [2.0, 4.0, 6.0]);
    assert_eq!(X.zip_with(X, |a, b| a * b).to_array(), [1.0, 4.0, 9.0]);
    assert_eq!(X.map_into(|c| c as f32).to_array(), [1.0_f32, 2.0, 3.0]);
    assert_eq!(State::from(<[f64; 3]>::from(X)), X);
}

#[test]
fn a_vector_of_vectors_is_a_matrix() {
    let b = X.map_into(|phi| Input { phi });
    assert_eq!(b.to_matrix(), [[1.0], [2.0], [3.0]]);
    assert_eq!(State::<Input<f64>>::from_matrix(b.to_matrix()), b);
    assert_eq!(
        SMatrix::<f64, 3, 1>::from(b),
        SVector::from([1.0, 2.0, 3.0])
    );
    assert_eq!(State::<Input<f64>>::from(SVector::from([1.0, 2.0, 3.0])), b);

    let a = State {
        velocity: X,
        alpha: X.map(|c| c + 3.0),
        eta: X.map(|c| c + 6.0),
    };
    let expected = SMatrix::from_row_slice(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
    assert_eq!(SMatrix::<f64, 3, 3>::from(a), expected);
    assert_eq!(State::<State<f64>>::from(expected), a);

    assert_eq!(SVector::<f64, 3>::from(X), SVector::from([1.0, 2.0, 3.0]));
    assert_eq!(State::<f64>::from(SVector::from([1.0, 2.0, 3.0])), X);
}

#[test]
fn the_first_component_outside_its_bounds_is_named() {
    let bounds = State {
        velocity: Bounds::new(0.0, 1.0),
        alpha: Bounds::new(0.0, 1.0),
        eta: Bounds::new(0.0, 1.0),
    };
    let outside = first_outside(&X, &bounds).expect("alpha is outside");
    assert_eq!((outside.name, outside.value), ("alpha", 2.0));
    assert_eq!(outside.bounds, bounds.alpha);
    // The ends belong to the interval.
    for end in [0.0, 1.0] {
        assert!(first_outside(&State::splat(end), &bounds).is_none());
    }
    assert!(first_outside(&State::splat(-0.1), &bounds).is_some());
    assert!(first_outside(&State::splat(f64::NAN), &bounds).is_some());
}

/// A value that differs in its last bit on another machine would change every recorded trajectory.
#[test]
fn elementary_functions_have_fixed_bits() {
    let (sin, cos) = Real::sin_cos(0.7_f64);
    assert_eq!(sin.to_bits(), Real::sin(0.7_f64).to_bits());
    assert_eq!(cos.to_bits(), Real::cos(0.7_f64).to_bits());
    assert_eq!(sin.to_bits(), 0x3FE4_9D6E_6946_19B8);
    assert_eq!(Real::exp(-0.7_f64).to_bits(), 0x3FDF_C80D_B9DD_5542);
    assert_eq!(Real::sqrt(2.0_f64).to_bits(), 0x3FF6_A09E_667F_3BCD);
    assert_eq!(Real::recip(4.0_f32), 0.25);
    assert_eq!(Real::abs(-3.0_f32), 3.0);
    assert!(!Real::is_finite(f32::NAN) && Real::is_finite(1.0_f32));
}

entries! {
    /// Entries of a matrix.
    pub struct Sparse in sparse, SPARSE: State<State> {
        velocity { alpha }
        eta { velocity, eta }
    }
}

entries! {
    /// A matrix without entries.
    pub struct Nothing in nothing, NOTHING: State<State> {
    }
}

entries! {
    /// Entries of an array of three indices.
    pub struct Deep in deep, DEEP: State<State<State>> {
        velocity { alpha { velocity } }
        eta { velocity { velocity } }
    }
}

entries! {
    /// Entries that stand for their mirror images too.
    pub struct Mirrored in mirrored, MIRRORED: symmetric State<State<State>> {
        velocity { alpha { velocity } eta { eta } }
    }
}

/// What compressed arrays stand for: the entries at their places, zero elsewhere, and mirror images.
#[test]
fn entries_stand_at_their_places() {
    let mut entries = Sparse::splat(6.0);
    (entries.velocity.alpha, entries.eta.velocity) = (4.0, 5.0);
    assert_eq!(
        (SPARSE.len(), SPARSE.is_empty(), SPARSE.shape),
        (3, false, [3, 3])
    );
    assert_eq!(SPARSE.at, [[0, 1], [2, 0], [2, 2]]);
    assert_eq!(entries.to_array(), [4.0, 5.0, 6.0]);
    assert_eq!(entries.map_ref(|it| 2.0 * it).eta.velocity, 10.0);
    let expected = [[0.0, 4.0, 0.0], [0.0; 3], [5.0, 0.0, 6.0]];
    assert_eq!(entries.dense().to_matrix(), expected);
    assert!(NOTHING.is_empty() && Nothing::splat(1.0).to_array().is_empty());
    assert_eq!(Nothing::splat(1.0).dense().to_matrix(), [[0.0; 3]; 3]);

    let of_matrices =
        |array: State<State<State<f64>>>| array.map_into(|matrix| matrix.to_matrix()).to_array();
    let mut deep = Deep::splat(7.0);
    deep.eta.velocity.velocity = 9.0;
    let mut expected = [[[0.0; 3]; 3]; 3];
    (expected[0][1][0], expected[2][0][0]) = (7.0, 9.0);
    assert_eq!(DEEP.at, [[0, 1, 0], [2, 0, 0]]);
    assert_eq!(of_matrices(deep.dense()), expected);
    let mut mirrored = Mirrored::splat(7.0);
    mirrored.velocity.eta.eta = 8.0;
    let mut expected = [[[0.0; 3]; 3]; 3];
    (expected[0][1][0], expected[0][0][1], expected[0][2][2]) = (7.0, 7.0, 8.0);
    assert_eq!(MIRRORED.at, [[0, 1, 0], [0, 2, 2]]);
    assert_eq!(of_matrices(mirrored.dense()), expected);
}

/// Structs and parameters with the names that a macro would give its own parameters.
mod names {
    macro_rules! named {
        ($($module:ident: $name:ident<$parameter:ident>;)+) => {$(
            mod $module {
                #[derive(Clone, Copy, Debug, PartialEq)]
                struct $name<$parameter> {
                    f: $parameter,
                    other: $parameter,
                }
                ahv_core::impl_vector! { $name { f: ["1", "1", 1.0], other: ["1", "1", 1.0] } }
                ahv_core::impl_nalgebra!($name by $name);

                #[test]
                fn it_is_a_vector() {
                    let x = $name { f: 1.0, other: 2.0 };
                    let rows = x.map_into(|f| $name { f, other: -f }).to_matrix();
                    assert_eq!(rows, [[1.0, -1.0], [2.0, -2.0]]);
                }
            }
        )+};
    }
    named! {
        t: T<U>;
        u: U<T>;
        e: E<T>;
        r: R<U>;
    }
}
