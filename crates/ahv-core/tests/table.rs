//! Rules of a table, with violations of each kind.
#![forbid(unsafe_code)]

use ahv_core::{Rule, Sign, Term};

#[derive(Clone, Copy, Debug, PartialEq)]
struct Pair<T> {
    mass: T,
    coupling: T,
}

ahv_core::impl_vector!(Pair {
    mass: ["kg", "kg", 1.0],
    coupling: ["1", "1", 1.0]
});

fn of(mass: f64, coupling: f64) -> Pair<f64> {
    Pair { mass, coupling }
}

#[test]
fn a_rule_holds_for_its_sign_alone() {
    for (must, negative, zero) in [
        (Sign::Positive, false, false),
        (Sign::NotNegative, false, true),
        (Sign::NotZero, true, false),
    ] {
        const TERMS: &[Term] = &[Term::new(1.0, &["mass"])];
        let rule = Rule::new("rule", "a reason", must, TERMS);
        for (mass, holds) in [
            (1e-300, true),
            (f64::INFINITY, true),
            (0.0, zero),
            (-0.0, zero),
            (-1e-300, negative),
            (f64::NEG_INFINITY, negative),
            (f64::NAN, false),
        ] {
            assert_eq!(rule.holds(&of(mass, f64::NAN)), holds, "{must:?} {mass}");
        }
    }
}

/// 2 mass − coupling² + 0.5 is a polynomial of parameters and a constant.
#[test]
fn terms_add_up_and_a_power_repeats_its_parameter() {
    const TERMS: &[Term] = &[
        Term::new(2.0, &["mass"]),
        Term::new(-1.0, &["coupling", "coupling"]),
        Term::new(0.5, &[]),
    ];
    let holds = |must, mass, coupling| {
        Rule::new("rule", "a reason", must, TERMS).holds(&of(mass, coupling))
    };
    for (mass, coupling, value) in [(4.0, 3.0, -0.5), (4.25, 3.0, 0.0), (4.5, -3.0, 0.5)] {
        assert_eq!(holds(Sign::Positive, mass, coupling), value > 0.0);
        assert_eq!(holds(Sign::NotNegative, mass, coupling), value >= 0.0);
        assert_eq!(holds(Sign::NotZero, mass, coupling), value != 0.0);
    }
}

/// No parameters obey a rule about one that they do not have.
#[test]
fn an_unknown_parameter_obeys_nothing() {
    for must in [Sign::Positive, Sign::NotNegative, Sign::NotZero] {
        const TERMS: &[Term] = &[Term::new(1.0, &["length"])];
        let rule = Rule::new("rule", "a reason", must, TERMS);
        assert!(!rule.holds(&of(1.0, 1.0)), "{must:?}");
    }
}
