//! Matrices in a file of MATLAB's level 4 format, which SciPy and Octave read too.

use nalgebra::DMatrix;

/// Type of a matrix of numbers: little endian, double precision, full.
const DOUBLES: i32 = 0;

/// Type of a matrix of characters: little endian, bytes, text.
const TEXT: i32 = 51;

/// The bytes of a file with these matrices, and these lists of names as matrices of characters, a row a name.
pub(super) fn file(matrices: &[(&str, &DMatrix<f64>)], lists: &[(&str, &[&str])]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for (name, matrix) in matrices {
        bytes.extend(header(DOUBLES, name, matrix.nrows(), matrix.ncols()));
        // nalgebra keeps columns together, as the format does.
        bytes.extend(matrix.iter().flat_map(|value| value.to_le_bytes()));
    }
    for (name, list) in lists {
        let length = list.iter().map(|text| text.len()).max().unwrap_or(0);
        bytes.extend(header(TEXT, name, list.len(), length));
        for column in 0..length {
            let letter = |text: &&str| text.as_bytes().get(column).copied().unwrap_or(b' ');
            bytes.extend(list.iter().map(letter));
        }
    }
    bytes
}

/// What stands before the entries of a matrix.
fn header(kind: i32, name: &str, rows: usize, columns: usize) -> Vec<u8> {
    // Matrices of a model, and their names, are far smaller than what 32 bits count.
    let size = |count: usize| i32::try_from(count).unwrap_or(i32::MAX);
    let imaginary = 0;
    let numbers = [
        kind,
        size(rows),
        size(columns),
        imaginary,
        size(name.len() + 1),
    ];
    let mut bytes: Vec<u8> = numbers.into_iter().flat_map(i32::to_le_bytes).collect();
    bytes.extend(name.bytes());
    bytes.push(0);
    bytes
}
