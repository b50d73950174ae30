//! Structs of numbers whose fields have names: what generated functions share, and compressed arrays.

/// Makes a struct of fields of one type, which can be filled and mapped.
///
/// It gets `splat(value)`, all fields of which are `value`, and `map_ref(f)`, which applies `f` to each field; the type of the
/// fields may change.
///
/// ```
/// ahv_core::record! {
///     /// Air at a flight condition.
///     pub struct Air<R> {
///         /// Density, kg/m^3.
///         pub density: R,
///         /// Speed of sound, m/s.
///         pub speed_of_sound: R,
///     }
/// }
///
/// let air = Air { density: 1.2, ..Air::splat(340.0) };
/// assert_eq!(air.map_ref(|it| it * 2.0).density, 2.4);
/// ```
#[macro_export]
macro_rules! record {
    (
        $(#[$about:meta])*
        pub struct $name:ident<$scalar:ident> {
            $($(#[$doc:meta])* pub $field:ident: $same:ident,)+
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name<$scalar> {
            $($(#[$doc])* pub $field: $same,)+
        }

        impl<$scalar> $name<$scalar> {
            /// All fields are `value`.
            #[inline(always)]
            #[allow(dead_code, reason = "which of them are needed depends on the model")]
            pub fn splat(value: $scalar) -> Self
            where
                $scalar: Copy,
            {
                Self { $($field: value),+ }
            }

            /// Applies `f` to each field; the type of the fields may change.
            #[inline(always)]
            #[allow(dead_code, reason = "which of them are needed depends on the model")]
            pub fn map_ref<__U>(&self, mut f: impl FnMut(&$scalar) -> __U) -> $name<__U> {
                $name { $($field: f(&self.$field)),+ }
            }
        }
    };
}

/// Makes a struct of the structurally non-zero entries of a matrix or of an array of three indices, one field an entry.
///
/// Each entry has a name and its place, row first. The struct gets `splat`, `map_ref` (see [`record!`](crate::record)),
/// `to_array`, and `dense`, which puts the entries into the array; with `symmetric` into their mirror images in the last two
/// indices too. The constant says where the entries stand, in their order.
///
/// ```
/// # #[derive(Clone, Copy, Debug, PartialEq)]
/// # pub struct Pair<T> { pub left: T, pub right: T }
/// # ahv_core::impl_vector! { Pair { left: ["1", "1", 1.0], right: ["1", "1", 1.0] } }
/// ahv_core::entries! {
///     /// Entries of a triangle.
///     pub struct Triangle, TRIANGLE: Pair<Pair> {
///         left_by_left: left.left,
///         right_by_left: right.left,
///         right_by_right: right.right,
///     }
/// }
///
/// let triangle = Triangle { right_by_left: 5.0, ..Triangle::splat(1.0) };
/// assert_eq!(triangle.dense().to_matrix(), [[1.0, 0.0], [5.0, 1.0]]);
/// assert_eq!(TRIANGLE.at, [[0, 0], [1, 0], [1, 1]]);
/// ```
#[macro_export]
macro_rules! entries {
    (
        $(#[$about:meta])*
        pub struct $name:ident, $pattern:ident: $row:ident<$column:ident> {
            $($entry:ident: $i:ident.$j:ident,)*
        }
    ) => {
        $crate::entries! { @struct $(#[$about])* $name, $pattern, 2, [$row, $column] { $($entry: $i.$j,)* } }

        impl<__R: $crate::Real> $name<__R> {
            /// The matrix.
            #[inline(always)]
            #[allow(unused_variables, reason = "there may be no entry")]
            pub fn dense(&self) -> $row<$column<__R>> {
                let mut dense = $crate::Vector::splat(<$column<__R> as $crate::Vector<__R>>::splat(__R::ZERO));
                let matrix: &mut $row<$column<__R>> = &mut dense;
                $(matrix.$i.$j = self.$entry;)*
                dense
            }
        }
    };
    (
        $(#[$about:meta])*
        pub struct $name:ident, $pattern:ident: $row:ident<$column:ident<$depth:ident>> {
            $($entry:ident: $i:ident.$j:ident.$k:ident,)*
        }
    ) => {
        $crate::entries! { @struct $(#[$about])* $name, $pattern, 3, [$row, $column, $depth] { $($entry: $i.$j.$k,)* } }

        impl<__R: $crate::Real> $name<__R> {
            /// The array.
            #[inline(always)]
            #[allow(unused_variables, reason = "there may be no entry")]
            pub fn dense(&self) -> $row<$column<$depth<__R>>> {
                let mut dense = $crate::Vector::splat($crate::Vector::splat($crate::Vector::splat(__R::ZERO)));
                let array: &mut $row<$column<$depth<__R>>> = &mut dense;
                $(array.$i.$j.$k = self.$entry;)*
                dense
            }
        }
    };
    (
        $(#[$about:meta])*
        pub struct $name:ident, $pattern:ident: symmetric $row:ident<$column:ident<$depth:ident>> {
            $($entry:ident: $i:ident.$j:ident.$k:ident,)*
        }
    ) => {
        $crate::entries! { @struct $(#[$about])* $name, $pattern, 3, [$row, $column, $depth] { $($entry: $i.$j.$k,)* } }

        impl<__R: $crate::Real> $name<__R> {
            /// The array, symmetric in its last two indices.
            #[inline(always)]
            #[allow(unused_variables, reason = "there may be no entry")]
            pub fn dense(&self) -> $row<$column<$depth<__R>>> {
                let mut dense = $crate::Vector::splat($crate::Vector::splat($crate::Vector::splat(__R::ZERO)));
                let array: &mut $row<$column<$depth<__R>>> = &mut dense;
                $(
                    array.$i.$j.$k = self.$entry;
                    array.$i.$k.$j = self.$entry;
                )*
                dense
            }
        }
    };
    (@struct $(#[$about:meta])* $name:ident, $pattern:ident, $indices:literal, $vectors:tt {}) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct $name<R>(::core::marker::PhantomData<R>);

        impl<R> $name<R> {
            /// Number of entries.
            pub const LEN: usize = 0;

            /// There is no entry.
            #[inline(always)]
            pub fn splat(_: R) -> Self {
                Self(::core::marker::PhantomData)
            }

            /// There is no entry.
            #[inline(always)]
            pub fn map_ref<__U>(&self, _: impl FnMut(&R) -> __U) -> $name<__U> {
                $name(::core::marker::PhantomData)
            }

            /// There is no entry.
            #[inline(always)]
            #[allow(clippy::wrong_self_convention, reason = "as where there are entries")]
            pub fn to_array(self) -> [R; 0] {
                []
            }
        }

        /// No entry stands anywhere.
        pub const $pattern: $crate::Pattern<$indices> = $crate::Pattern::new($crate::entries!(@shape $vectors), &[]);
    };
    (@struct $(#[$about:meta])* $name:ident, $pattern:ident, $indices:literal, $vectors:tt { $($entry:ident: $($at:ident).+,)* }) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(missing_docs, reason = "a name says which entry it is")]
        pub struct $name<R> {
            $(pub $entry: R,)+
        }

        impl<R> $name<R> {
            /// Number of entries.
            pub const LEN: usize = { const NAMES: &[&str] = &[$(stringify!($entry)),*]; NAMES.len() };

            /// All entries are `value`.
            #[inline(always)]
            pub fn splat(value: R) -> Self
            where
                R: Copy,
            {
                Self { $($entry: value),+ }
            }

            /// Applies `f` to each entry; the type of the entries may change.
            #[inline(always)]
            pub fn map_ref<__U>(&self, mut f: impl FnMut(&R) -> __U) -> $name<__U> {
                $name { $($entry: f(&self.$entry)),+ }
            }

            /// The entries in order.
            #[inline(always)]
            #[allow(clippy::wrong_self_convention, reason = "an entry is Copy wherever it is used")]
            pub fn to_array(self) -> [R; $name::<()>::LEN] {
                [$(self.$entry),+]
            }
        }

        /// Where the entries stand.
        pub const $pattern: $crate::Pattern<$indices> =
            $crate::Pattern::new($crate::entries!(@shape $vectors), &[$($crate::entries!(@at $vectors $($at).+)),*]);
    };
    (@shape [$($vector:ident),+]) => {
        [$($vector::<()>::LEN),+]
    };
    (@at [$a:ident, $b:ident] $i:ident.$j:ident) => {
        [::core::mem::offset_of!($a<u8>, $i), ::core::mem::offset_of!($b<u8>, $j)]
    };
    (@at [$a:ident, $b:ident, $c:ident] $i:ident.$j:ident.$k:ident) => {
        [
            ::core::mem::offset_of!($a<u8>, $i),
            ::core::mem::offset_of!($b<u8>, $j),
            ::core::mem::offset_of!($c<u8>, $k),
        ]
    };
}
