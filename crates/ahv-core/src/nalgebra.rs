//! Conversions to and from nalgebra, expanded in the crate that has nalgebra as a dependency.

/// `From` both ways between `Name<T>`, made by [`impl_vector!`](crate::impl_vector), and `nalgebra::SVector<T, len>`.
///
/// Names `::nalgebra` as the invoking crate knows it.
#[macro_export]
macro_rules! impl_nalgebra {
    ($name:ident, $len:literal) => {
        impl<T: ::nalgebra::Scalar> From<$name<T>> for ::nalgebra::SVector<T, $len> {
            #[inline]
            fn from(vector: $name<T>) -> Self {
                Self::from(vector.to_array())
            }
        }

        impl<T: ::nalgebra::Scalar> From<::nalgebra::SVector<T, $len>> for $name<T> {
            #[inline]
            fn from(vector: ::nalgebra::SVector<T, $len>) -> Self {
                Self::from_array(vector.into())
            }
        }
    };
}

/// `From` both ways between `Row<Column<T>>`, for example a Jacobian, and `nalgebra::SMatrix<T, rows, columns>`.
///
/// `impl_nalgebra_matrix!(State, 11, Input, 3)` makes `State<Input<T>>` a matrix of 11 rows and 3 columns.
#[macro_export]
macro_rules! impl_nalgebra_matrix {
    ($row:ident, $rows:literal, $column:ident, $columns:literal) => {
        impl<T: ::nalgebra::Scalar> From<$row<$column<T>>>
            for ::nalgebra::SMatrix<T, $rows, $columns>
        {
            #[inline]
            fn from(matrix: $row<$column<T>>) -> Self {
                // nalgebra stores columns; an array of rows is therefore the transpose.
                let rows: [[T; $columns]; $rows] = matrix.to_matrix();
                ::nalgebra::SMatrix::<T, $columns, $rows>::from(rows).transpose()
            }
        }

        impl<T: ::nalgebra::Scalar> From<::nalgebra::SMatrix<T, $rows, $columns>>
            for $row<$column<T>>
        {
            #[inline]
            fn from(matrix: ::nalgebra::SMatrix<T, $rows, $columns>) -> Self {
                let rows: [[T; $columns]; $rows] = matrix.transpose().into();
                Self::from_matrix(rows)
            }
        }
    };
}
