//! Conversions to and from nalgebra, expanded in the crate that has nalgebra as a dependency.

/// `From` both ways between `Name<T>`, made by [`impl_vector!`](crate::impl_vector), and `nalgebra::SVector<T, LEN>`.
///
/// Names `::nalgebra` as the invoking crate knows it.
#[macro_export]
macro_rules! impl_nalgebra {
    ($name:ident) => {
        impl<T: ::nalgebra::Scalar> From<$name<T>>
            for ::nalgebra::SVector<T, { $name::<()>::LEN }>
        {
            #[inline]
            fn from(vector: $name<T>) -> Self {
                Self::from(vector.to_array())
            }
        }

        impl<T: ::nalgebra::Scalar> From<::nalgebra::SVector<T, { $name::<()>::LEN }>>
            for $name<T>
        {
            #[inline]
            fn from(vector: ::nalgebra::SVector<T, { $name::<()>::LEN }>) -> Self {
                Self::from_array(vector.into())
            }
        }
    };
}

/// `From` both ways between `Row<Column<T>>`, for example a Jacobian, and `nalgebra::SMatrix<T, rows, columns>`.
///
/// `impl_nalgebra_matrix!(State, Input)` makes `State<Input<T>>` a matrix with a row a state and a column an input.
#[macro_export]
macro_rules! impl_nalgebra_matrix {
    ($row:ident, $column:ident) => {
        impl<T: ::nalgebra::Scalar> From<$row<$column<T>>>
            for ::nalgebra::SMatrix<T, { $row::<()>::LEN }, { $column::<()>::LEN }>
        {
            #[inline]
            fn from(matrix: $row<$column<T>>) -> Self {
                // nalgebra stores columns; an array of rows is therefore the transpose.
                let rows: [[T; $column::<()>::LEN]; $row::<()>::LEN] = matrix.to_matrix();
                ::nalgebra::SMatrix::<T, { $column::<()>::LEN }, { $row::<()>::LEN }>::from(rows)
                    .transpose()
            }
        }

        impl<T: ::nalgebra::Scalar>
            From<::nalgebra::SMatrix<T, { $row::<()>::LEN }, { $column::<()>::LEN }>>
            for $row<$column<T>>
        {
            #[inline]
            fn from(
                matrix: ::nalgebra::SMatrix<T, { $row::<()>::LEN }, { $column::<()>::LEN }>,
            ) -> Self {
                let rows: [[T; $column::<()>::LEN]; $row::<()>::LEN] = matrix.transpose().into();
                Self::from_matrix(rows)
            }
        }
    };
}
