//! What the tests of the steppers share.

/// A named vector as the generated code has it.
macro_rules! vector {
    ($name:ident, $len:literal, $($field:ident),+) => {
        #[derive(Clone, Copy, Debug, PartialEq)]
        struct $name<T> {
            $($field: T,)+
        }

        impl<T> $name<T> {
            const NAMES: [&'static str; $len] = [$(stringify!($field)),+];
            const UNITS: [&'static str; $len] = ["1"; $len];

            #[allow(clippy::wrong_self_convention, reason = "the shape of the generated code")]
            fn to_array(self) -> [T; $len] {
                [$(self.$field),+]
            }

            fn from_array([$($field),+]: [T; $len]) -> Self {
                Self { $($field),+ }
            }
        }

        ahv_core::impl_vector!($name, $len);
    };
}
pub(crate) use vector;
