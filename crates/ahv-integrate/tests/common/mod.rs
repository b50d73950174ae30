//! What the tests of the steppers share.

/// A named vector as the generated code has it.
macro_rules! vector {
    ($name:ident, $($field:ident),+) => {
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub(crate) struct $name<T> {
            $(pub(crate) $field: T,)+
        }

        ahv_core::impl_vector!($name { $($field: ["1", "1", 1.0]),+ });
    };
}
pub(crate) use vector;
