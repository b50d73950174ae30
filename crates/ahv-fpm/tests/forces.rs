//! Loads against the oracle's, faults by name, and a box larger than the envelope.

use ahv_core::{DifferentiableModel, GeneratedModel, Model as _, Vector};
use ahv_fpm::{Fault, Input, Model, NOMINAL, Outputs, State, Surface, Total};
use ahv_table::{Family, Text, check};

/// By SciPy: `generator/ahv_oracle/first_principles.py`.
const VECTORS: &str = include_str!("../../../tests/vectors/fpm.txt");

fn level() -> (State<f64>, Input<f64>) {
    let alpha = 1.5153_f64.to_radians();
    let x = State {
        velocity: 7702.08,
        altitude: 85_000.0,
        alpha,
        ..State::from_array([0.0; 9])
    };
    (
        x,
        Input {
            phi: 0.2514,
            delta_e: 11.4635_f64.to_radians(),
        },
    )
}

/// The flow that shared/science.md states at the trim of Table 2.
#[test]
fn the_check_point_has_the_flow_that_was_checked() {
    let (x, u) = level();
    let flow = Model::new(&NOMINAL).forces(&x, &u).expect("a flow");
    let stream = &flow.stream;
    let near = |value: f64, wanted: f64, room: f64| {
        assert!((value - wanted).abs() < room, "{value} {wanted}")
    };
    near(flow.mach, 7.852, 1e-3);
    near(flow.air.density, 6.7434e-5, 1e-9 * 6.0);
    near(flow.bow.mach, 6.171, 1e-3);
    near(stream.cowl.mach, 5.285, 1e-3);
    near(stream.heat.mach, 2.66, 5e-3);
    near(stream.nozzle.mach, 4.696, 2e-3);
    near(stream.exit_pressure, 1.942, 2e-3);
    near(stream.height, 1.80, 5e-3);
    near(stream.exit_height, 11.44, 1e-2);
    assert!(stream.capture > 1.0, "the bow shock spills");
}

/// The points of the oracle with their loads.
fn vectors() -> Vec<(State<f64>, Input<f64>, Vec<f64>)> {
    let row = |line: &str| {
        let mut numbers = line.split(',').map(|it| it.parse().expect("a number"));
        let mut next = || numbers.next().expect("a column");
        let x = State {
            velocity: next(),
            altitude: next(),
            alpha: next(),
            eta_1: next(),
            eta_2: next(),
            ..State::from_array([0.0; 9])
        };
        let u = Input {
            phi: next(),
            delta_e: next(),
        };
        (x, u, numbers.collect())
    };
    VECTORS.lines().skip(2).map(row).collect()
}

#[test]
fn loads_are_those_of_the_oracle() {
    let model = Model::new(&NOMINAL);
    let vectors = vectors();
    for (x, u, wanted) in &vectors {
        let flow = model.forces_beyond(x, u).expect("a flow");
        let loads = flow
            .loads
            .iter()
            .flat_map(|it| [it.axial, it.normal, it.moment]);
        let found = loads.chain(flow.generalized);
        for (index, (found, wanted)) in found.zip(wanted).enumerate() {
            let size = wanted.abs().max(if index > 23 { 100.0 } else { 1000.0 });
            // The ramp's quadrature has twelve nodes, and its pressure falls by up to ten.
            let room = if (9..12).contains(&index) || index == 25 {
                1e-6
            } else {
                1e-9
            };
            assert!(
                (found - wanted).abs() < room * size,
                "{x:?} {u:?}\n{index}: {found} {wanted}"
            );
        }
    }
    assert!(vectors.len() > 50);
}

/// The oracle's trim is one: no rate is left, but that of the altitude, which is level.
#[test]
fn the_trim_is_that_of_the_oracle() {
    let (x, u, _) = vectors().pop().expect("the last row");
    let rates = Model::new(&NOMINAL).drift(&x, &u);
    let scale = [10.0, 1.0, 1e-3, 1e-3, 1.0, 1.0, 100.0, 1.0, 100.0];
    for (rate, scale) in rates.to_array().into_iter().zip(scale) {
        assert!(rate.abs() < 1e-8 * scale, "{rates:?}");
    }
    assert!(x.alpha > 0.03 && u.phi > 0.1);
}

#[test]
fn each_fault_names_its_surface() {
    let model = Model::new(&NOMINAL);
    let (x, u) = level();
    let beyond = |x, u: Input<f64>| model.forces_beyond(&x, &u).expect_err("no flow");
    let steep = State { alpha: 0.7, ..x };
    assert!(matches!(
        beyond(steep, u),
        Fault::DetachedShock {
            surface: Surface::Forebody,
            ..
        }
    ));
    let hinge = Input { delta_e: 0.9, ..u };
    assert!(matches!(
        beyond(x, hinge),
        Fault::DetachedShock {
            surface: Surface::ElevatorLower,
            ..
        }
    ));
    let up = Input { delta_e: -0.9, ..u };
    assert!(matches!(
        beyond(x, up),
        Fault::Vacuum {
            surface: Surface::ElevatorLower,
            ..
        }
    ));
    assert!(matches!(
        beyond(x, Input { phi: 30.0, ..u }),
        Fault::ThermalChoking { .. }
    ));
    assert!(matches!(
        beyond(
            State {
                velocity: 700.0,
                ..x
            },
            u
        ),
        Fault::Subsonic { .. }
    ));
    assert_eq!(
        beyond(
            State {
                alpha: f64::NAN,
                ..x
            },
            u
        ),
        Fault::NotFinite("alpha")
    );
    let outside = model
        .forces(&State { alpha: 0.3, ..x }, &u)
        .expect_err("outside");
    assert!(outside.to_string().starts_with("alpha is 0.3"), "{outside}");
    let text = beyond(steep, u).to_string();
    assert!(
        text.contains("forebody") && text.contains("Mach 7.85"),
        "{text}"
    );
    let vehicle = |change: &dyn Fn(&mut ahv_fpm::Parameters<f64>)| {
        let mut p = NOMINAL;
        change(&mut p);
        Model::new(&p).forces_beyond(&x, &u).expect_err("no flow")
    };
    assert!(matches!(
        vehicle(&|p| p.a_d = 0.001),
        Fault::ChokedDuct {
            surface: Surface::Inlet,
            ..
        }
    ));
    assert!(matches!(
        vehicle(&|p| p.a_n = 0.3),
        Fault::ChokedDuct {
            surface: Surface::Nozzle,
            ..
        }
    ));
    assert!(matches!(
        vehicle(&|p| p.a_n = 5e3),
        Fault::VacuumAtNozzle { .. }
    ));
    assert!(matches!(
        vehicle(&|p| p.tau_u = -2.5),
        Fault::Vacuum {
            surface: Surface::Upper,
            ..
        }
    ));
    assert!(matches!(vehicle(&|p| p.i_yy = 1e5), Fault::Inertia { .. }));
    // Slow and steep, the bow shock takes the stream below Mach 1, or the cowl shock does.
    let coast = Input {
        phi: 0.0,
        delta_e: 0.0,
    };
    let mut inlets = [false; 2];
    for velocity in (1200..4000).step_by(20) {
        for alpha in 0..70 {
            let velocity = f64::from(velocity);
            let alpha = 0.01 * f64::from(alpha);
            let flow = model.forces_beyond(
                &State {
                    velocity,
                    alpha,
                    ..x
                },
                &coast,
            );
            inlets[0] |=
                matches!(flow, Err(Fault::SubsonicInlet { mach }) if mach > 0.3 && mach <= 1.0);
            inlets[1] |= matches!(
                flow,
                Err(Fault::DetachedShock {
                    surface: Surface::Inlet,
                    ..
                })
            );
        }
    }
    assert_eq!(inlets, [true; 2]);
}

/// Numbers that look random, the same in every run.
fn draws() -> impl FnMut(f64, f64) -> f64 {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    move |low, high| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * ((state >> 11) as f64 / (1_u64 << 53) as f64)
    }
}

/// Three times the envelope and more: a result or a fault, never a NaN, alone and in a batch with the same bits.
#[test]
fn a_larger_box_has_results_or_faults() {
    let model = Model::new(&NOMINAL);
    let mut draw = draws();
    let points: Vec<(State<f64>, Input<f64>)> = (0..20_000)
        .map(|_| {
            // Many near the middle of the envelope, and some far out.
            let reach = draw(0.0, 1.0);
            let mut about = |middle: f64, most: f64| middle + reach * draw(-most, most);
            let x = State {
                velocity: about(9000.0, 16_000.0),
                altitude: about(95_000.0, 150_000.0),
                gamma: about(0.0, 1.5),
                alpha: about(0.03, 0.9),
                pitch_rate: about(0.0, 2.0),
                eta_1: about(0.0, 60.0),
                eta_dot_1: about(0.0, 500.0),
                eta_2: about(0.0, 60.0),
                eta_dot_2: about(0.0, 500.0),
            };
            let u = Input {
                phi: about(0.4, 6.0),
                delta_e: about(0.0, 1.2),
            };
            (x, u)
        })
        .collect();
    let (mut sound, mut faults) = (0, 0);
    for ((x, u), batch) in points.iter().zip(model.batch(&points)) {
        let alone = model.forces_beyond(x, u);
        match (&alone, &batch) {
            (Ok(flow), Ok(total)) => {
                assert_eq!(Total::of(flow), *total);
                assert!(model.drift(x, u).find(|it| !it.is_finite()).is_none());
                let (by_state, by_input) = model.jacobians(x, u);
                let rows = by_state.to_array().into_iter().zip(by_input.to_array());
                for (row, by_input) in rows {
                    assert!(row.find(|it| !it.is_finite()).is_none(), "{x:?} {u:?}");
                    assert!(by_input.find(|it| !it.is_finite()).is_none());
                }
                sound += 1;
            }
            (Err(one), Err(other)) => {
                assert_eq!(one, other);
                assert!(!one.to_string().contains("NaN"), "{one}");
                faults += 1;
            }
            (one, other) => panic!("{x:?} {u:?}: {one:?} {other:?}"),
        }
    }
    assert!(sound > 1000 && faults > 1000, "{sound} {faults}");
}

/// Jacobians and output slopes beside central differences.
#[test]
fn jacobians_are_those_of_differences() {
    let model = Model::new(&NOMINAL);
    let (x, u) = level();
    let x = State {
        gamma: 0.01,
        pitch_rate: 0.02,
        eta_1: 1.1,
        eta_dot_1: 0.3,
        eta_2: 0.9,
        eta_dot_2: -0.4,
        ..x
    };
    let (by_state, by_input) = model.jacobians(&x, &u);
    let steps = [1.0, 10.0, 1e-5, 1e-5, 1e-5, 1e-3, 1e-3, 1e-3, 1e-3];
    for (column, step) in steps.into_iter().enumerate() {
        let moved = |sign: f64| {
            let mut x = x;
            x.set(column, x.get(column).expect("in range") + sign * step)
                .expect("in range");
            model.drift(&x, &u)
        };
        let difference = moved(1.0).zip_with(moved(-1.0), |up, down| (up - down) / (2.0 * step));
        for (row, wanted) in difference.to_array().into_iter().enumerate() {
            let found = by_state
                .get(row)
                .and_then(|row: State<f64>| row.get(column))
                .expect("in range");
            assert!(
                (found - wanted).abs() < 1e-5 * (wanted.abs() + 1e-3),
                "{row} {column}: {found} {wanted}"
            );
        }
    }
    let step = 1e-5;
    let moved = |delta_e| model.drift(&x, &Input { delta_e, ..u });
    let (up, down) = (moved(u.delta_e + step), moved(u.delta_e - step));
    let wanted = (up.pitch_rate - down.pitch_rate) / (2.0 * step);
    assert!((by_input.pitch_rate.delta_e / wanted - 1.0).abs() < 1e-6);
    let by_parameter = model.parameter_jacobian(&x, &u);
    let moved = |tau_l| {
        Model::new(&ahv_fpm::Parameters { tau_l, ..NOMINAL })
            .drift(&x, &u)
            .velocity
    };
    let wanted = (moved(NOMINAL.tau_l + step) - moved(NOMINAL.tau_l - step)) / (2.0 * step);
    assert!((by_parameter.velocity.tau_l / wanted - 1.0).abs() < 1e-6);
}

/// What the surfaces give adds up to forces and moment of the equations of motion.
#[test]
fn outputs_add_up() {
    let (x, u) = level();
    let model = Model::new(&NOMINAL);
    let it: Outputs<f64> = Model::outputs(&model, &x, &u);
    let (sin, cos) = x.alpha.sin_cos();
    let rates = model.drift(&x, &u);
    assert!((rates.velocity - (it.thrust * cos - it.drag) / NOMINAL.m).abs() < 1e-12);
    let turn = (it.lift + it.thrust * sin) / (NOMINAL.m * x.velocity) - NOMINAL.g / x.velocity;
    assert!((rates.gamma - turn).abs() < 1e-15);
    let values = it.to_array();
    let parts = |end: &str| -> f64 {
        let named = Outputs::<f64>::NAMES.iter().zip(values).skip(12);
        named
            .filter(|(name, _)| name.ends_with(end))
            .map(|(_, value)| value)
            .sum()
    };
    assert!((parts("_axial_force") - it.axial_force).abs() < 1e-8);
    assert!((parts("_normal_force") - it.normal_force).abs() < 1e-8);
    assert!((parts("_pitching_moment") - it.pitching_moment).abs() < 1e-6);
}

/// The table is read by the reader of all tables, which reports faults with their places.
#[test]
fn the_geometry_table_has_no_fault() {
    let families = [Family::of::<Model<f64>>()];
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/vehicle.toml");
    let own = std::fs::read_to_string(path).expect("the table");
    let text = Text::parse(own.clone()).expect("TOML");
    let checked =
        check(&text, &families).unwrap_or_else(|faults| panic!("{}", text.line(path, &faults[0])));
    let values = checked.sets[0].entries.iter().zip(NOMINAL.to_array());
    for (entry, nominal) in values.take(NOMINAL.to_array().len() - 1) {
        assert_eq!(entry.expect("a value").value.to_bits(), nominal.to_bits());
    }
    let wrong =
        Text::parse(own.replacen("L_n = { value = ", "L_n = { value = -", 1)).expect("TOML");
    let faults = check(&wrong, &families).expect_err("a length is positive");
    let line = wrong.line("vehicle.toml", &faults[0]);
    assert!(
        line.starts_with("vehicle.toml:")
            && line.contains("`L_n` (length of the engine) must be positive"),
        "{line}"
    );
}
