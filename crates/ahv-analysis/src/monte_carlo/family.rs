//! Models whose scalar can be chosen, behind one trait.

use std::fmt::Debug;

use ahv_core::{Bounds, DifferentiableNoise, Lanes, Real, Vector};
use ahv_models::{dcom, sdcom, sdcom_gust, sdcom_printed};

/// Members that are flown side by side.
pub const LANES: usize = 8;

/// A number of each member that is flown.
pub type Packed = Lanes<f64, LANES>;

/// What a component of a vector may be.
pub trait Component: Copy + Send + Sync + 'static {}

impl<T: Copy + Send + Sync + 'static> Component for T {}

/// A stochastic model with any scalar.
///
/// State, input, noise and parameters are the generated vectors, whose components may be of any type.
pub trait Family: Copy + Debug + Send + Sync + 'static {
    /// Its name.
    const NAME: &'static str;
    /// Where its curve fits are meant to be used.
    const STATE_BOUNDS: Self::State<Bounds>;
    /// Limits of the inputs.
    const INPUT_BOUNDS: Self::Input<Bounds>;

    /// Parameters of the table.
    type Parameters<T: Component>: Vector<T> + Send + Sync;
    /// State.
    type State<T: Component>: Vector<T> + Send + Sync;
    /// Input.
    type Input<T: Component>: Vector<T> + Send + Sync;
    /// Wiener increments.
    type Noise<T: Component>: Vector<T> + Send + Sync;
    /// The model.
    type Model<R: Real>: DifferentiableNoise<
            Scalar = R,
            State = Self::State<R>,
            Input = Self::Input<R>,
            Noise = Self::Noise<R>,
        > + Copy
        + Send
        + Sync;

    /// The model with a parameter of its own in every member.
    fn model(parameters: &[Self::Parameters<f64>; LANES]) -> Self::Model<Packed>;

    /// The model with another scalar.
    fn map_model<R: Real, U: Real>(
        model: &Self::Model<R>,
        f: impl FnMut(&R) -> U,
    ) -> Self::Model<U>;

    /// The state with other components.
    fn map_state<T: Component, U: Component>(
        x: &Self::State<T>,
        f: impl FnMut(&T) -> U,
    ) -> Self::State<U>;

    /// Tells `f` of each component and the one of `y` in its place.
    fn zip_state<T: Component, U: Component>(
        x: &Self::State<T>,
        y: &Self::State<U>,
        f: impl FnMut(&T, &U),
    );

    /// Applies `f` to each component and the one of `y` in its place.
    fn update_state<T: Component, U: Component>(
        x: &mut Self::State<T>,
        y: Self::State<U>,
        f: impl FnMut(&mut T, U),
    );

    /// The input with other components.
    fn map_input<T: Component, U: Component>(
        u: &Self::Input<T>,
        f: impl FnMut(&T) -> U,
    ) -> Self::Input<U>;

    /// The increments with other components.
    fn map_noise<T: Component, U: Component>(
        w: &Self::Noise<T>,
        f: impl FnMut(&T) -> U,
    ) -> Self::Noise<U>;

    /// Applies `f` to each component and the one of `v` in its place.
    fn update_input<T: Component, U: Component>(
        u: &mut Self::Input<T>,
        v: Self::Input<U>,
        f: impl FnMut(&mut T, U),
    );
}

macro_rules! families {
    ($($(#[$doc:meta])+ $name:ident = $module:ident;)+) => {$(
        $(#[$doc])+
        #[derive(Clone, Copy, Debug)]
        pub struct $name;

        impl Family for $name {
            const NAME: &'static str = stringify!($module);
            const STATE_BOUNDS: $module::State<Bounds> = $module::STATE_BOUNDS;
            const INPUT_BOUNDS: $module::Input<Bounds> = $module::INPUT_BOUNDS;

            type Parameters<T: Component> = $module::Parameters<T>;
            type State<T: Component> = $module::State<T>;
            type Input<T: Component> = $module::Input<T>;
            type Noise<T: Component> = $module::Noise<T>;
            type Model<R: Real> = $module::Model<R>;

            fn model(parameters: &[Self::Parameters<f64>; LANES]) -> Self::Model<Packed> {
                let mut packed = $module::Parameters::splat(Packed::ZERO);
                for (lane, &parameters) in parameters.iter().enumerate() {
                    packed.update(parameters, |packed, value| packed.0[lane] = value);
                }
                $module::Model::new(&packed)
            }

            #[inline(always)]
            fn map_model<R: Real, U: Real>(
                model: &Self::Model<R>,
                f: impl FnMut(&R) -> U,
            ) -> Self::Model<U> {
                model.map_ref(f)
            }

            #[inline(always)]
            fn map_state<T: Component, U: Component>(
                x: &Self::State<T>,
                f: impl FnMut(&T) -> U,
            ) -> Self::State<U> {
                x.map_ref(f)
            }

            #[inline(always)]
            fn zip_state<T: Component, U: Component>(
                x: &Self::State<T>,
                y: &Self::State<U>,
                f: impl FnMut(&T, &U),
            ) {
                x.zip_ref(y, f);
            }

            #[inline(always)]
            fn update_state<T: Component, U: Component>(
                x: &mut Self::State<T>,
                y: Self::State<U>,
                f: impl FnMut(&mut T, U),
            ) {
                x.update(y, f);
            }

            #[inline(always)]
            fn map_input<T: Component, U: Component>(
                u: &Self::Input<T>,
                f: impl FnMut(&T) -> U,
            ) -> Self::Input<U> {
                u.map_ref(f)
            }

            #[inline(always)]
            fn map_noise<T: Component, U: Component>(
                w: &Self::Noise<T>,
                f: impl FnMut(&T) -> U,
            ) -> Self::Noise<U> {
                w.map_ref(f)
            }

            #[inline(always)]
            fn update_input<T: Component, U: Component>(
                u: &mut Self::Input<T>,
                v: Self::Input<U>,
                f: impl FnMut(&mut T, U),
            ) {
                u.update(v, f);
            }
        }
    )+};
}

families! {
    /// The stochastic model, exact.
    Sdcom = sdcom;
    /// The deterministic model, with noise on path, attitude and modes.
    Dcom = dcom;
    /// The stochastic model as the paper prints it.
    SdcomPrinted = sdcom_printed;
    /// The stochastic model with a band-limited gust.
    SdcomGust = sdcom_gust;
}
