//! Vectors whose components have names.

/// A vector of `T` whose components have names and units.
///
/// A Jacobian is a vector of vectors: `State<Input<T>>` is a `Vector<Input<T>>` whose rows are `Vector<T>`.
/// Implemented by [`impl_vector!`](crate::impl_vector).
pub trait Vector<T>: Copy {
    /// Number of components.
    const LEN: usize;
    /// Names of the components, in order.
    const NAMES: &'static [&'static str];
    /// Units of the components, in order; `1` where there is none.
    const UNITS: &'static [&'static str];
    /// The same in metre, kilogram, second and radian.
    const SI_UNITS: &'static [&'static str];
    /// What each component is multiplied with to be in its SI unit.
    const SI_FACTORS: &'static [f64];

    /// The vector whose components all are `value`.
    fn splat(value: T) -> Self;

    /// The vector whose component `i` is `component(i)`.
    fn from_fn(component: impl FnMut(usize) -> T) -> Self;

    /// Component `index`; `None` out of range.
    fn get(&self, index: usize) -> Option<T>;

    /// Writes component `index`; `None`, and no change, out of range.
    fn set(&mut self, index: usize, value: T) -> Option<()>;

    /// Applies `f` to each component.
    fn map(self, f: impl FnMut(T) -> T) -> Self;

    /// Applies `f` to each pair of components.
    fn zip_with(self, other: Self, f: impl FnMut(T, T) -> T) -> Self;

    /// The first component for which `test` holds, with its name.
    fn find(&self, test: impl FnMut(T) -> bool) -> Option<(&'static str, T)>;

    /// Index of the component called `name`.
    fn index_of(name: &str) -> Option<usize> {
        Self::NAMES.iter().position(|&own| own == name)
    }
}

/// Makes a struct that is a [`Vector`]: for each field its unit, its SI unit and the factor between them, as in
/// [`impl_vector!`](crate::impl_vector).
///
/// ```
/// ahv_core::vector! {
///     /// A pair.
///     pub struct Pair<T> {
///         /// Length, ft.
///         left: ["ft", "m", 0.3048],
///         /// Angle, rad.
///         right: ["rad", "rad", 1.0],
///     }
/// }
///
/// assert_eq!(Pair { left: 1.0, right: 2.0 }.to_array(), [1.0, 2.0]);
/// assert_eq!(Pair::<f64>::UNITS, ["ft", "rad"]);
/// ```
#[macro_export]
macro_rules! vector {
    (
        $(#[$about:meta])*
        pub struct $name:ident<$component:ident> {
            $($(#[$doc:meta])* $field:ident: [$unit:literal, $si_unit:literal, $si_factor:literal]),+ $(,)?
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[repr(C)]
        pub struct $name<$component> {
            $($(#[$doc])* pub $field: $component,)+
        }

        $crate::impl_vector! { $name { $($field: [$unit, $si_unit, $si_factor]),+ } }
    };
}

/// Makes `struct Name<T>` a [`Vector`], with conversions. For each field stand its unit, its SI unit, and the factor
/// between them.
///
/// The struct is `Copy` where `T` is. It also gets inherent `LEN`, `NAMES`, `UNITS`, `to_array(self) -> [T; LEN]` and
/// `from_array([T; LEN]) -> Self`.
///
/// The struct and its parameter may have any name: those of the macro begin with two underscores.
///
/// ```
/// #[derive(Clone, Copy, Debug, PartialEq)]
/// pub struct Pair<T> {
///     pub left: T,
///     pub right: T,
/// }
///
/// ahv_core::impl_vector! {
///     Pair {
///         left: ["ft", "m", 0.3048],
///         right: ["rad", "rad", 1.0],
///     }
/// }
///
/// let jacobian = Pair { left: Pair { left: 1, right: 2 }, right: Pair { left: 3, right: 4 } };
/// assert_eq!(jacobian.to_matrix(), [[1, 2], [3, 4]]);
/// assert_eq!(Pair::<f64>::UNITS, ["ft", "rad"]);
/// ```
#[macro_export]
macro_rules! impl_vector {
    ($name:ident { $($field:ident: [$unit:literal, $si_unit:literal, $si_factor:literal]),+ $(,)? }) => {
        impl<__T> $name<__T> {
            /// Number of components.
            pub const LEN: usize = [$($unit),+].len();
            /// Names of the components.
            pub const NAMES: [&'static str; $name::<()>::LEN] = [$(stringify!($field)),+];
            /// Units of the components.
            pub const UNITS: [&'static str; $name::<()>::LEN] = [$($unit),+];

            /// The components in order.
            #[inline(always)]
            #[allow(clippy::wrong_self_convention, reason = "a component is Copy wherever a vector is used")]
            pub fn to_array(self) -> [__T; $name::<()>::LEN] {
                [$(self.$field),+]
            }

            /// A vector from its components in order.
            #[inline(always)]
            pub fn from_array([$($field),+]: [__T; $name::<()>::LEN]) -> Self {
                Self { $($field),+ }
            }
        }

        impl<__T: Copy> $crate::Vector<__T> for $name<__T> {
            const LEN: usize = $name::<()>::LEN;
            const NAMES: &'static [&'static str] = &$name::<()>::NAMES;
            const UNITS: &'static [&'static str] = &$name::<()>::UNITS;
            const SI_UNITS: &'static [&'static str] = &[$($si_unit),+];
            const SI_FACTORS: &'static [f64] = &[$($si_factor),+];

            #[inline(always)]
            fn splat(value: __T) -> Self {
                Self::from_array([value; $name::<()>::LEN])
            }

            #[inline(always)]
            fn from_fn(mut component: impl FnMut(usize) -> __T) -> Self {
                // No array: through one the compiler does not see single numbers.
                let mut index = 0;
                let mut next = || {
                    let value = component(index);
                    index += 1;
                    value
                };
                Self { $($field: next()),+ }
            }

            #[inline(always)]
            fn get(&self, index: usize) -> Option<__T> {
                (*self).to_array().get(index).copied()
            }

            #[inline(always)]
            fn set(&mut self, index: usize, value: __T) -> Option<()> {
                let mut components = (*self).to_array();
                *components.get_mut(index)? = value;
                *self = Self::from_array(components);
                Some(())
            }

            #[inline(always)]
            fn map(self, f: impl FnMut(__T) -> __T) -> Self {
                self.map_into(f)
            }

            #[inline(always)]
            fn zip_with(self, other: Self, mut f: impl FnMut(__T, __T) -> __T) -> Self {
                Self { $($field: f(self.$field, other.$field)),+ }
            }

            #[inline(always)]
            fn find(&self, mut test: impl FnMut(__T) -> bool) -> Option<(&'static str, __T)> {
                $name::<__T>::NAMES
                    .into_iter()
                    .zip((*self).to_array())
                    .find(|&(_, component)| test(component))
            }
        }

        impl<__T> $name<__T> {
            /// Applies `f` to each component; the type of the components may change.
            #[inline(always)]
            pub fn map_into<__U>(self, mut f: impl FnMut(__T) -> __U) -> $name<__U> {
                $name { $($field: f(self.$field)),+ }
            }

            /// As [`Self::map_into`], by reference: large components are not copied.
            #[inline(always)]
            pub fn map_ref<__U>(&self, mut f: impl FnMut(&__T) -> __U) -> $name<__U> {
                $name { $($field: f(&self.$field)),+ }
            }

            /// Tells `f` of each component and the one of `other` in its place.
            #[inline(always)]
            pub fn zip_ref<__U>(&self, other: &$name<__U>, mut f: impl FnMut(&__T, &__U)) {
                $(f(&self.$field, &other.$field);)+
            }

            /// Applies `f` to each component and the one of `other` in its place.
            #[inline(always)]
            pub fn update<__U>(&mut self, other: $name<__U>, mut f: impl FnMut(&mut __T, __U)) {
                $(f(&mut self.$field, other.$field);)+
            }

            /// Rows of a vector of vectors, such as a Jacobian.
            #[inline(always)]
            pub fn to_matrix<__E, const __COLUMNS: usize>(self) -> [[__E; __COLUMNS]; $name::<()>::LEN]
            where
                __T: Into<[__E; __COLUMNS]>,
            {
                self.to_array().map(Into::into)
            }

            /// The vector of vectors with these rows.
            #[inline(always)]
            pub fn from_matrix<__E, const __COLUMNS: usize>(rows: [[__E; __COLUMNS]; $name::<()>::LEN]) -> Self
            where
                __T: From<[__E; __COLUMNS]>,
            {
                Self::from_array(rows.map(__T::from))
            }
        }

        impl<__T> From<[__T; $name::<()>::LEN]> for $name<__T> {
            #[inline(always)]
            fn from(components: [__T; $name::<()>::LEN]) -> Self {
                Self::from_array(components)
            }
        }

        impl<__T> From<$name<__T>> for [__T; $name::<()>::LEN] {
            #[inline(always)]
            fn from(vector: $name<__T>) -> Self {
                vector.to_array()
            }
        }
    };
}
