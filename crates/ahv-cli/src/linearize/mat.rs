//! Matrices in a file of MATLAB's level 4 format, which SciPy and Octave read too.

use nalgebra::DMatrix;

/// Numeric type of a matrix: little endian, double precision, full.
const DOUBLES: i32 = 0;

/// The bytes of a file with these matrices.
pub(super) fn file(matrices: &[(&str, &DMatrix<f64>)]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (name, matrix) in matrices {
        // Matrices of a model, and their names, are far smaller than what 32 bits count.
        let size = |count: usize| i32::try_from(count).unwrap_or(i32::MAX);
        let imaginary = 0;
        let header = [
            DOUBLES,
            size(matrix.nrows()),
            size(matrix.ncols()),
            imaginary,
            size(name.len() + 1),
        ];
        bytes.extend(header.into_iter().flat_map(i32::to_le_bytes));
        bytes.extend(name.bytes());
        bytes.push(0);
        // nalgebra keeps columns together, as the format does.
        bytes.extend(matrix.iter().flat_map(|value| value.to_le_bytes()));
    }
    bytes
}
