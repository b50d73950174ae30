//! Members side by side in the lanes of a scalar get the bits that each of them gets by itself.
#![forbid(unsafe_code)]

use ahv_core::{Bounds, Lanes, Real, Vector};
use ahv_models::{com, com_rigid, dcom, flexible_mode, sdcom, sdcom_gust, sdcom_printed};
use ahv_steppers::{Advance, Label, Visitor};
use std::ops::{Add, Div, Mul, Neg, Sub};

const WIDTH: usize = 4;
const STEPS: u64 = 6;

/// [`Lanes`] whose operations are calls. Inlined, as they are by themselves, every stepper on every model would be minutes
/// of compiling.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Called(Lanes<f64, WIDTH>);

macro_rules! call {
    ($($name:ident, $method:ident;)+) => {$(
        impl $name for Called {
            type Output = Self;

            #[inline(never)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )+};
}
call! {
    Add, add;
    Sub, sub;
    Mul, mul;
    Div, div;
}

impl Neg for Called {
    type Output = Self;

    #[inline(never)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Real for Called {
    const ZERO: Self = Self(Lanes::ZERO);
    const ONE: Self = Self(Lanes::ONE);
    const TWO: Self = Self(Lanes::TWO);
    const HALF: Self = Self(Lanes::HALF);

    fn from_f64(value: f64) -> Self {
        Self(Lanes::from_f64(value))
    }

    fn to_f64(self) -> f64 {
        self.0.to_f64()
    }

    #[inline(never)]
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.0.sin_cos();
        (Self(sin), Self(cos))
    }

    #[inline(never)]
    fn exp(self) -> Self {
        Self(self.0.exp())
    }

    #[inline(never)]
    fn tan(self) -> Self {
        Self(self.0.tan())
    }

    #[inline(never)]
    fn asin(self) -> Self {
        Self(self.0.asin())
    }

    #[inline(never)]
    fn atan(self) -> Self {
        Self(self.0.atan())
    }

    #[inline(never)]
    fn tanh(self) -> Self {
        Self(self.0.tanh())
    }

    #[inline(never)]
    fn ln(self) -> Self {
        Self(self.0.ln())
    }

    #[inline(never)]
    fn atan2(self, x: Self) -> Self {
        Self(self.0.atan2(x.0))
    }

    #[inline(never)]
    fn powr(self, exponent: Self) -> Self {
        Self(self.0.powr(exponent.0))
    }

    #[inline(never)]
    fn select(self, bound: Self, below: Self, otherwise: Self) -> Self {
        Self(self.0.select(bound.0, below.0, otherwise.0))
    }

    #[inline(never)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    fn is_finite(self) -> bool {
        self.0.is_finite()
    }
}

/// Lanes from their numbers.
fn called(lanes: [f64; WIDTH]) -> Called {
    Called(Lanes(lanes))
}

/// SplitMix64.
struct Random(u64);

impl Random {
    fn units(&mut self) -> [f64; WIDTH] {
        [(); WIDTH].map(|()| {
            self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        })
    }

    /// A parameter of its own in every lane.
    fn parameters(&mut self, nominal: f64) -> [f64; WIDTH] {
        self.units().map(|unit| nominal * (1.0 + 1e-3 * unit))
    }

    fn within(&mut self, Bounds { min, max }: Bounds) -> [f64; WIDTH] {
        self.units().map(|unit| min + (max - min) * unit)
    }
}

/// A stepper, and the bits of its states in one lane.
type Flight = (Label, Vec<u64>);

/// What a scalar shows of a flight: one lane, of many or of the only one.
struct Lane<R> {
    random: Random,
    pick: fn([f64; WIDTH]) -> R,
    show: fn(R) -> f64,
    flights: Vec<Flight>,
}

impl<R: Real> Visitor<R> for Lane<R> {
    fn parameter(&mut self, nominal: f64) -> R {
        (self.pick)(self.random.parameters(nominal))
    }

    fn within(&mut self, bounds: Bounds) -> R {
        (self.pick)(self.random.within(bounds))
    }

    fn visit(&mut self, label: Label, start: &[R], advance: &mut Advance<'_, R>) {
        let (mut x, mut bits) = (start.to_vec(), Vec::new());
        for step in 0..STEPS {
            assert!(advance(&mut x, step), "{label:?} fails at step {step}");
            bits.extend(x.iter().map(|&component| (self.show)(component).to_bits()));
        }
        self.flights.push((label, bits));
    }
}

fn fly<R: Real + PartialEq>(
    seed: u64,
    pick: fn([f64; WIDTH]) -> R,
    show: fn(R) -> f64,
) -> Vec<Flight> {
    let mut lane = Lane {
        random: Random(seed),
        pick,
        show,
        flights: Vec::new(),
    };
    ahv_steppers::fixed(&mut lane);
    lane.flights
}

fn lane_of<const LANE: usize>(seed: u64) {
    let together = fly::<Called>(seed, called, |scalar| scalar.0.0[LANE]);
    let alone = fly::<f64>(seed, |lanes| lanes[LANE], |scalar| scalar);
    assert!(alone.len() > 90, "{} steppers", alone.len());
    for (one, other) in together.iter().zip(&alone) {
        assert_eq!(one, other, "lane {LANE}");
    }
    assert_eq!(together.len(), alone.len());
}

#[test]
fn every_stepper_gives_each_lane_its_own_bits() {
    for seed in 1..=4 {
        lane_of::<0>(seed);
        lane_of::<1>(seed);
        lane_of::<2>(seed);
        lane_of::<3>(seed);
    }
}

/// The bits of a vector in one lane.
macro_rules! bits {
    ($vector:expr) => {
        $vector.map_into(f64::to_bits)
    };
    ($vector:expr, $lane:expr) => {
        $vector.map_into(|lanes| lanes.0.0[$lane].to_bits())
    };
}

#[test]
fn every_function_gives_each_lane_its_own_bits() {
    macro_rules! functions {
        ($($module:ident: $($noise:ident)?;)+) => {$({
            use $module::*;
            let mut random = Random(5);
            let p: Parameters<_> = NOMINAL.map_into(|nominal| called(random.parameters(nominal)));
            let x: State<_> = STATE_BOUNDS.map_into(|bounds| called(random.within(bounds)));
            let u: Input<_> = INPUT_BOUNDS.map_into(|bounds| called(random.within(bounds)));
            let prepared = prepare(&p);
            let (a, b) = jacobians(&x, &u, &prepared);
            for lane in 0..WIDTH {
                let (x1, u1) = (x.map_into(|x| x.0.0[lane]), u.map_into(|u| u.0.0[lane]));
                let prepared1 = prepare(&p.map_into(|p| p.0.0[lane]));
                let (a1, b1) = jacobians(&x1, &u1, &prepared1);
                let (together, alone) = (drift(&x, &u, &prepared), drift(&x1, &u1, &prepared1));
                assert_eq!(bits!(together, lane), bits!(alone));
                assert_eq!(a.map_into(|row| bits!(row, lane)), a1.map_into(|row| bits!(row)));
                assert_eq!(b.map_into(|row| bits!(row, lane)), b1.map_into(|row| bits!(row)));
                $(
                    let dw: $noise<_> = Vector::from_fn(|_| called(random.units()));
                    let dw1 = dw.map_into(|dw| dw.0.0[lane]);
                    let together = noise_increment(&x, &u, &prepared, &dw);
                    let alone = noise_increment(&x1, &u1, &prepared1, &dw1);
                    assert_eq!(bits!(together, lane), bits!(alone));
                    let together = ito_correction(&x, &u, &prepared);
                    assert_eq!(bits!(together, lane), bits!(ito_correction(&x1, &u1, &prepared1)));
                )?
            }
        })+};
    }
    functions! {
        com:;
        com_rigid:;
        dcom: Noise;
        sdcom: Noise;
        sdcom_printed: Noise;
        sdcom_gust: Noise;
        flexible_mode: Noise;
    }
}
