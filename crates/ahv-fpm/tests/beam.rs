//! Modes of beams: eigenvalues of the textbooks, orthonormality, and the table's two cantilevers.

use ahv_fpm::beam::{Mode, Support};
use ahv_fpm::{Model, NOMINAL};

/// Integrates over 0 to 1, by Gauss and Legendre's five points on many pieces.
fn integral(f: impl Fn(f64) -> f64) -> f64 {
    let nodes = [
        (0.0, 128.0 / 225.0),
        (0.538_469_310_105_683, 0.478_628_670_499_366_5),
        (0.906_179_845_938_664, 0.236_926_885_056_189_1),
    ];
    let pieces = 200;
    let half = 0.5 / f64::from(pieces);
    (0..pieces)
        .map(|piece| {
            let middle = f64::from(2 * piece + 1) * half;
            let sum: f64 = nodes
                .iter()
                .map(|&(at, weight)| match at {
                    0.0 => weight * f(middle),
                    _ => weight * (f(middle - half * at) + f(middle + half * at)),
                })
                .sum();
            half * sum
        })
        .sum()
}

#[test]
fn eigenvalues_are_those_of_the_textbooks() {
    let books = [
        (
            Support::Clamped,
            [1.875_104_068_7, 4.694_091_133_0, 7.854_757_438_2],
        ),
        (
            Support::Free,
            [4.730_040_744_9, 7.853_204_624_1, 10.995_607_838_0],
        ),
    ];
    for (support, values) in books {
        for (number, value) in (1..).zip(values) {
            let found = Mode::new(support, number).eigenvalue;
            assert!(
                (found - value).abs() < 1e-10,
                "{support:?} {number}: {found}"
            );
        }
    }
}

/// Orthonormal, and of free beams orthogonal to both rigid motions, to 1e-10.
#[test]
fn shapes_are_orthonormal() {
    for support in [Support::Clamped, Support::Free] {
        let modes = [1, 2, 3].map(|number| Mode::new(support, number));
        for (row, one) in modes.iter().enumerate() {
            for (column, other) in modes.iter().enumerate() {
                let product = integral(|x: f64| one.shape(x) * other.shape(x));
                let wanted = f64::from(u8::from(row == column));
                assert!(
                    (product - wanted).abs() < 1e-10,
                    "{support:?} {row} {column}: {product}"
                );
            }
            let (mean, lever) = (
                integral(|x: f64| one.shape(x)),
                integral(|x: f64| x * one.shape(x)),
            );
            assert!((one.integral(1.0_f64) - mean).abs() < 1e-10);
            assert!(
                (one.integral(0.3_f64) - 0.3 * integral(|x: f64| one.shape(0.3 * x))).abs() < 1e-10
            );
            assert!((one.lever() - lever).abs() < 1e-10, "{lever}");
            if support == Support::Free {
                assert!(mean.abs() < 1e-10 && lever.abs() < 1e-10);
            }
        }
    }
}

/// What holds a beam holds its shape: nothing moves or turns at the clamp, nothing bends at a free end.
#[test]
fn shapes_obey_the_ends() {
    for number in [1, 2, 3] {
        let clamped = Mode::new(Support::Clamped, number);
        assert!(clamped.shape(0.0_f64).abs() < 1e-12 && clamped.slope(0.0_f64).abs() < 1e-12);
        for support in [Support::Clamped, Support::Free] {
            let mode = Mode::new(support, number);
            // The slope is even about a free end to the second order: its curvature vanishes there.
            let bend: f64 = (mode.slope(1.0_f64) - mode.slope(1.0 - 1e-4)) / 1e-4;
            let inside: f64 = (mode.slope(0.5_f64) - mode.slope(0.5 - 1e-4)) / 1e-4;
            assert!(
                bend.abs() < 1e-2 * (1.0 + inside.abs()),
                "{support:?} {number}: {bend}"
            );
            let difference: f64 = (mode.shape(0.7_f64 + 1e-6) - mode.shape(0.7 - 1e-6)) / 2e-6;
            assert!((mode.slope(0.7_f64) - difference).abs() < 1e-6);
        }
    }
}

/// 1.875² √(EI/μ)/L², and the couplings of com.toml, whose beams are the same.
#[test]
fn the_table_has_the_frequencies_that_it_says() {
    let structure = Model::new(&NOMINAL).structure;
    assert!((structure.forebody.frequency - 16.2).abs() < 2e-3);
    assert!((structure.aftbody.frequency - 19.6).abs() < 2e-3);
    assert!((structure.forebody.coupling - 401.86).abs() < 1e-2);
    assert!((structure.aftbody.coupling + 297.41).abs() < 1e-2);
    // √(EI/(μ L⁴)) of a free beam of the whole length: the first frequency of section 6 is 22.373 times that.
    let free = Mode::new(Support::Free, 1).frequency(100.0_f64, 2.336e8, 3.0);
    assert!((free - 19.7437).abs() < 5e-3);
}
