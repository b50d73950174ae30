//! Conversions to and from nalgebra, expanded in the crate that has nalgebra as a dependency.

/// `From` both ways between vectors, made by [`impl_vector!`](crate::impl_vector), and `nalgebra::SVector<T, LEN>`; and between
/// matrices that have such a vector a row, for example a Jacobian, and `nalgebra::SMatrix<T, rows, columns>`.
///
/// `impl_nalgebra!(State by State, Input)` is for `State<T>`, `Input<T>`, `State<State<T>>` and `State<Input<T>>`, which has a row a
/// state and a column an input. Names `::nalgebra` as the invoking crate knows it.
#[macro_export]
macro_rules! impl_nalgebra {
    ($rows:ident by $($name:ident),+) => {$(
        $crate::impl_nalgebra! { @vector $name }
        $crate::impl_nalgebra! { @matrix $rows, $name }
    )+};
    (@vector $name:ident) => {
        impl<__T: ::nalgebra::Scalar> From<$name<__T>>
            for ::nalgebra::SVector<__T, { $name::<()>::LEN }>
        {
            #[inline]
            fn from(vector: $name<__T>) -> Self {
                Self::from(vector.to_array())
            }
        }

        impl<__T: ::nalgebra::Scalar> From<::nalgebra::SVector<__T, { $name::<()>::LEN }>>
            for $name<__T>
        {
            #[inline]
            fn from(vector: ::nalgebra::SVector<__T, { $name::<()>::LEN }>) -> Self {
                Self::from_array(vector.into())
            }
        }
    };
    (@matrix $row:ident, $column:ident) => {
        impl<__T: ::nalgebra::Scalar> From<$row<$column<__T>>>
            for ::nalgebra::SMatrix<__T, { $row::<()>::LEN }, { $column::<()>::LEN }>
        {
            #[inline]
            fn from(matrix: $row<$column<__T>>) -> Self {
                // nalgebra stores columns; an array of rows is therefore the transpose.
                let rows: [[__T; $column::<()>::LEN]; $row::<()>::LEN] = matrix.to_matrix();
                ::nalgebra::SMatrix::<__T, { $column::<()>::LEN }, { $row::<()>::LEN }>::from(rows)
                    .transpose()
            }
        }

        impl<__T: ::nalgebra::Scalar>
            From<::nalgebra::SMatrix<__T, { $row::<()>::LEN }, { $column::<()>::LEN }>>
            for $row<$column<__T>>
        {
            #[inline]
            fn from(
                matrix: ::nalgebra::SMatrix<__T, { $row::<()>::LEN }, { $column::<()>::LEN }>,
            ) -> Self {
                let rows: [[__T; $column::<()>::LEN]; $row::<()>::LEN] = matrix.transpose().into();
                Self::from_matrix(rows)
            }
        }
    };
}
