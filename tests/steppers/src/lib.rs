//! Every stepper and source of noise of `ahv-integrate` on every model, each as a function that advances a state.
//!
//! What is promised of all steppers (no heap, no panic, the same bits) is tested by a [`Visitor`]. A test of this crate
//! fails when an export of `ahv-integrate` or a model is missing here. Settings pass through `black_box`: the optimiser
//! cannot leave out a check because it knows the outcome.
#![no_std]
#![forbid(unsafe_code)]

mod controlled;
mod fixed;
mod stochastic;

use ahv_core::{Bounds, Model, NoInline, Real, Vector};
use ahv_models::{com, com_rigid, dcom, flexible_mode, sdcom, sdcom_gust, sdcom_printed};
use core::hint::black_box;

/// Which stepper is visited.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Label {
    /// Name of the model's module.
    pub model: &'static str,
    /// Name of the stepper's type.
    pub stepper: &'static str,
    /// Name of the type from which its input or its noise comes, if that matters.
    pub source: &'static str,
}

/// Takes a step from a state, which becomes the one after it; whether it succeeded.
pub type Advance<'a, R> = dyn FnMut(&mut [R], u64) -> bool + 'a;

/// Who looks at the steppers.
pub trait Visitor<R> {
    /// The value of a parameter whose nominal value is `nominal`.
    fn parameter(&mut self, nominal: f64) -> R;

    /// A component of a state or an input, within `bounds`.
    fn within(&mut self, bounds: Bounds) -> R;

    /// A stepper and a state to start from. `advance(x, k)` takes step k, or makes a whole run.
    fn visit(&mut self, label: Label, start: &[R], advance: &mut Advance<'_, R>);
}

/// A model at a state and an input.
struct Place<M: Model> {
    name: &'static str,
    model: M,
    x: M::State,
    u: M::Input,
}

impl<M: Model> Place<M> {
    /// Shows the visitor a stepper; its state becomes a slice, whatever the model.
    fn visit(
        &self,
        visitor: &mut dyn Visitor<M::Scalar>,
        stepper: &'static str,
        source: &'static str,
        mut advance: impl FnMut(&mut M::State, u64) -> bool,
    ) {
        let label = Label {
            model: self.name,
            stepper,
            source,
        };
        let mut start = [M::Scalar::ZERO; MOST_STATES];
        write(&self.x, &mut start);
        let length = M::State::LEN;
        visitor.visit(
            label,
            start.get(..length).unwrap_or(&[]),
            &mut |slice, step| {
                let mut x =
                    M::State::from_fn(|index| slice.get(index).copied().unwrap_or(M::Scalar::ZERO));
                let succeeded = advance(&mut x, step);
                write(&x, slice);
                succeeded
            },
        );
    }
}

/// Greatest number of states of a model.
const MOST_STATES: usize = 16;

fn write<R: Real, X: Vector<R>>(x: &X, slice: &mut [R]) {
    const { assert!(X::LEN <= MOST_STATES) };
    for (index, place) in slice.iter_mut().enumerate() {
        *place = x.get(index).unwrap_or(*place);
    }
}

fn within<R: Real, X: Vector<R>, B: Vector<Bounds>>(visitor: &mut dyn Visitor<R>, bounds: &B) -> X {
    X::from_fn(|index| visitor.within(bounds.get(index).unwrap_or(Bounds::new(0.0, 0.0))))
}

/// A step size in s.
fn step_size() -> f64 {
    black_box(1.0 / 1024.0)
}

macro_rules! place {
    ($module:ident, $visitor:ident) => {{
        let parameters = $module::NOMINAL.map_into(|nominal| $visitor.parameter(nominal));
        Place {
            name: stringify!($module),
            // Called, not inlined: the schemes of all models would take minutes to compile.
            model: NoInline($module::Model::new(&parameters)),
            x: within($visitor, &$module::STATE_BOUNDS),
            u: within($visitor, &$module::INPUT_BOUNDS),
        }
    }};
}

/// Visits the steppers of [`fixed`] and [`controlled`] in `f64`, compiled once for all tests.
pub fn all(visitor: &mut dyn Visitor<f64>) {
    fixed(visitor);
    controlled(visitor);
}

/// Visits every stepper with a fixed step on every model.
pub fn fixed<R: Real + PartialEq>(visitor: &mut dyn Visitor<R>) {
    macro_rules! calm {
        ($($module:ident),+) => {$(
            let place = place!($module, visitor);
            fixed::all(&place, visitor);
        )+};
    }
    macro_rules! noisy {
        ($($module:ident),+) => {$(
            let place = place!($module, visitor);
            fixed::all(&place, visitor);
            stochastic::all::<_, { $module::Noise::<()>::LEN }>(&place, visitor);
        )+};
    }
    macro_rules! coloured {
        ($($module:ident, $states:literal;)+) => {$(
            noisy!($module);
            let place = place!($module, visitor);
            stochastic::splitting::<_, { $module::Noise::<()>::LEN }, $states>(&place, visitor);
        )+};
    }
    calm!(com, com_rigid);
    // The noise of flexible_mode drives mode and reduction at once: it cannot be split.
    noisy!(dcom, flexible_mode);
    coloured! {
        sdcom, 3;
        sdcom_printed, 3;
        sdcom_gust, 4;
    }
    let mode = place!(flexible_mode, visitor);
    stochastic::transitions(&mode, visitor);
}

/// Visits every stepper that controls its step, on every model, with every kind of input on one of them.
pub fn controlled<R: Real + Into<f64>>(visitor: &mut dyn Visitor<R>) {
    macro_rules! held {
        ($($module:ident),+) => {$(
            let place = place!($module, visitor);
            controlled::held(&place, $module::STATE_BOUNDS, $module::INPUT_BOUNDS, visitor);
        )+};
    }
    held!(
        com,
        com_rigid,
        dcom,
        sdcom,
        sdcom_printed,
        sdcom_gust,
        flexible_mode
    );
    let place = place!(dcom, visitor);
    controlled::moving(&place, dcom::STATE_BOUNDS, dcom::INPUT_BOUNDS, visitor);
}

/// Visits the schemes with noise that a generator of `rand` draws, whose bits are not promised.
pub fn drawn<R: Real>(visitor: &mut dyn Visitor<R>) {
    let place = place!(sdcom_gust, visitor);
    stochastic::drawn(&place, visitor);
}
