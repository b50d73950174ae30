//! Structs of numbers whose fields have names: what generated functions share, and compressed arrays.

/// Makes a struct of fields of one type, which can be filled and mapped.
///
/// It gets `splat(value)`, all fields of which are `value`, and `map_ref(f)`, which applies `f` to each field; the type of the
/// fields may change. With `from Source { … }` it has these fields of another struct as well, and `copied(source)`, which takes
/// them over and leaves the others zero.
///
/// ```
/// pub struct Gas<R> {
///     pub gamma: R,
///     pub temperature: R,
/// }
///
/// ahv_core::record! {
///     /// Air at a flight condition; `two_q` is twice the dynamic pressure.
///     pub struct Air<R> {
///         /// Density, kg/m^3.
///         density,
///         two_q, half_gamma,
///     }
///     from Gas { gamma, temperature }
/// }
///
/// let air = Air { density: 1.2, ..Air::copied(&Gas { gamma: 1.4, temperature: 288.15 }) };
/// assert_eq!((air.temperature, air.two_q), (288.15, 0.0));
/// assert_eq!(air.map_ref(|it| it * 2.0).density, 2.4);
/// ```
#[macro_export]
macro_rules! record {
    (
        $(#[$about:meta])*
        pub struct $name:ident<$scalar:ident> {
            $($(#[$doc:meta])* $field:ident),* $(,)?
        }
        $(from $source:ident { $($copied:ident),+ $(,)? })?
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(missing_docs, reason = "a name says what it is; what computes the struct has formulas and units")]
        pub struct $name<$scalar> {
            $($(#[doc = concat!("As in [`", stringify!($source), "`].")] pub $copied: $scalar,)+)?
            $($(#[$doc])* pub $field: $scalar,)*
        }

        impl<$scalar> $name<$scalar> {
            /// All fields are `value`.
            #[inline(always)]
            #[allow(dead_code, reason = "which of them are needed depends on the model")]
            pub fn splat(value: $scalar) -> Self
            where
                $scalar: Copy,
            {
                Self { $($($copied: value,)+)? $($field: value),* }
            }

            /// Applies `f` to each field; the type of the fields may change.
            #[inline(always)]
            #[allow(dead_code, reason = "which of them are needed depends on the model")]
            pub fn map_ref<__U>(&self, mut f: impl FnMut(&$scalar) -> __U) -> $name<__U> {
                $name { $($($copied: f(&self.$copied),)+)? $($field: f(&self.$field)),* }
            }
        }

        $(impl<$scalar: $crate::Real> $name<$scalar> {
            /// The fields that are those of the source; the others are zero.
            #[inline(always)]
            pub fn copied(source: &$source<$scalar>) -> Self {
                Self { $($copied: source.$copied,)+ ..Self::splat($scalar::ZERO) }
            }
        })?
    };
}

/// Makes a struct of the structurally non-zero entries of a matrix or of an array of three indices.
///
/// An entry has the name that it has in the array: `jacobian.left.right` is in row `left` and column `right`. The structs of the
/// rows stand in a module. The struct gets `splat`, `map_ref` (see [`record!`](crate::record)), `to_array`, and `dense`, which
/// puts the entries into the array; with `symmetric` into their mirror images in the last two indices too. The constant says
/// where the entries stand, in their order.
///
/// ```
/// # #[derive(Clone, Copy, Debug, PartialEq)]
/// # pub struct Pair<T> { pub left: T, pub right: T }
/// # ahv_core::impl_vector! { Pair { left: ["1", "1", 1.0], right: ["1", "1", 1.0] } }
/// ahv_core::entries! {
///     /// Entries of a triangle.
///     pub struct Triangle in triangle_rows, TRIANGLE: Pair<Pair> {
///         left { left }
///         right { left, right }
///     }
/// }
///
/// let mut triangle = Triangle::splat(1.0);
/// triangle.right.left = 5.0;
/// assert_eq!(triangle.dense().to_matrix(), [[1.0, 0.0], [5.0, 1.0]]);
/// assert_eq!(TRIANGLE.at, [[0, 0], [1, 0], [1, 1]]);
/// ```
#[macro_export]
macro_rules! entries {
    (
        $(#[$about:meta])*
        pub struct $name:ident in $rows:ident, $pattern:ident: $row:ident<$column:ident> {
            $($i:ident { $($j:ident),+ $(,)? })*
        }
    ) => {
        $crate::entries! { @rows $(#[$about])* $name, $rows { $($i { $($j,)+ })* } }
        $crate::entries! { @list $name, $pattern, 2, [$row, $column] { $($([$i.$j])+)* } }

        impl<__R: $crate::Real> $name<__R> {
            /// The matrix.
            #[inline(always)]
            #[allow(unused_variables, reason = "there may be no entry")]
            pub fn dense(&self) -> $row<$column<__R>> {
                let mut dense = $crate::Vector::splat(<$column<__R> as $crate::Vector<__R>>::splat(__R::ZERO));
                let matrix: &mut $row<$column<__R>> = &mut dense;
                $($(matrix.$i.$j = self.$i.$j;)+)*
                dense
            }
        }
    };
    (
        $(#[$about:meta])*
        pub struct $name:ident in $rows:ident, $pattern:ident: $row:ident<$column:ident<$depth:ident>> {
            $($i:ident { $($j:ident { $($k:ident),+ $(,)? })+ })*
        }
    ) => {
        $crate::entries! { @rows $(#[$about])* $name, $rows { $($i { $($j { $($k,)+ })+ })* } }
        $crate::entries! { @list $name, $pattern, 3, [$row, $column, $depth] { $($($([$i.$j.$k])+)+)* } }
        $crate::entries! { @array $name, $row<$column<$depth>> { $($($([$i.$j.$k])+)+)* } }
    };
    (
        $(#[$about:meta])*
        pub struct $name:ident in $rows:ident, $pattern:ident: symmetric $row:ident<$column:ident<$depth:ident>> {
            $($i:ident { $($j:ident { $($k:ident),+ $(,)? })+ })*
        }
    ) => {
        $crate::entries! { @rows $(#[$about])* $name, $rows { $($i { $($j { $($k,)+ })+ })* } }
        $crate::entries! { @list $name, $pattern, 3, [$row, $column, $depth] { $($($([$i.$j.$k])+)+)* } }
        $crate::entries! { @array $name, $row<$column<$depth>> { $($($([$i.$j.$k = $i.$k.$j])+)+)* } }
    };
    (@array $name:ident, $row:ident<$column:ident<$depth:ident>> {
        $([$i:ident.$j:ident.$k:ident $(= $l:ident.$m:ident.$n:ident)?])*
    }) => {
        impl<__R: $crate::Real> $name<__R> {
            /// The array.
            #[inline(always)]
            #[allow(unused_variables, reason = "there may be no entry")]
            pub fn dense(&self) -> $row<$column<$depth<__R>>> {
                let mut dense = $crate::Vector::splat($crate::Vector::splat($crate::Vector::splat(__R::ZERO)));
                let array: &mut $row<$column<$depth<__R>>> = &mut dense;
                $(
                    array.$i.$j.$k = self.$i.$j.$k;
                    $(array.$l.$m.$n = self.$i.$j.$k;)?
                )*
                dense
            }
        }
    };
    // The struct and those of its rows.
    (@rows $(#[$about:meta])* $name:ident, $rows:ident { $($i:ident $fields:tt)* }) => {
        $(#[$about])*
        pub use $rows::Entries as $name;

        /// The entries by rows.
        pub mod $rows {
            $crate::entries! { @node $($i $fields)* }
        }
    };
    (@node) => {
        /// There is no entry.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Entries<R>(::core::marker::PhantomData<R>);

        impl<R> Entries<R> {
            /// There is no entry.
            #[inline(always)]
            pub fn splat(_: R) -> Self {
                Self(::core::marker::PhantomData)
            }

            /// There is no entry.
            #[inline(always)]
            pub fn map_ref<__U>(&self, _: impl FnMut(&R) -> __U) -> Entries<__U> {
                Entries(::core::marker::PhantomData)
            }
        }
    };
    (@node $($k:ident,)+) => {
        $crate::record! {
            /// The entries of a row.
            pub struct Entries<R> { $($k),+ }
        }
    };
    (@node $($i:ident { $($fields:tt)+ })+) => {
        $(
            #[allow(missing_docs, reason = "it has the name of the row")]
            pub mod $i {
                $crate::entries! { @node $($fields)+ }
            }
        )+

        /// The entries, by rows.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(missing_docs, reason = "a field has the name of its row")]
        pub struct Entries<R> {
            $(pub $i: $i::Entries<R>,)+
        }

        impl<R> Entries<R> {
            /// All entries are `value`.
            #[inline(always)]
            pub fn splat(value: R) -> Self
            where
                R: Copy,
            {
                Self { $($i: $i::Entries::splat(value)),+ }
            }

            /// Applies `f` to each entry; the type of the entries may change.
            #[inline(always)]
            pub fn map_ref<__U>(&self, mut f: impl FnMut(&R) -> __U) -> Entries<__U> {
                Entries { $($i: self.$i.map_ref(&mut f)),+ }
            }
        }
    };
    // The entries as a list, and where they stand.
    (@list $name:ident, $pattern:ident, $indices:literal, $vectors:tt { $([$($at:ident).+])* }) => {
        impl<R: Copy> $name<R> {
            /// The entries in order.
            #[inline(always)]
            #[allow(clippy::wrong_self_convention, reason = "an entry is Copy wherever it is used")]
            pub fn to_array(self) -> [R; $pattern.at.len()] {
                [$(self.$($at).+),*]
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
