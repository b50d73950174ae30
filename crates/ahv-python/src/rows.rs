//! Functions of models at many points: rows of arrays, on all threads.

use numpy::{PyReadonlyArray2, PyReadwriteArray2};
use pyo3::prelude::*;
use rayon::prelude::*;

use crate::failure::request;

/// Rows that are worth a task of their own.
const TASK: usize = 2048;
/// Rows between two looks for Ctrl-C.
const SEGMENT: usize = 1 << 18;

/// Rows of an array; one row may stand for all.
#[derive(Clone, Copy)]
pub(crate) struct Rows<'r> {
    name: &'static str,
    numbers: &'r [f64],
    columns: usize,
    single: bool,
}

impl<'r> Rows<'r> {
    /// The rows of an array for so many points.
    ///
    /// # Errors
    ///
    /// A shape that does not fit, or rows that do not lie one after the other.
    pub(crate) fn new(
        name: &'static str,
        array: &'r PyReadonlyArray2<'_, f64>,
        columns: usize,
        count: usize,
    ) -> PyResult<Self> {
        let shape = array.as_array();
        let (rows, found) = (shape.nrows(), shape.ncols());
        let py = array.py();
        if found != columns || (rows != count && rows != 1) {
            let text = format!(
                "{name}: {rows} x {found}; it must be {count} x {columns} or 1 x {columns}"
            );
            return Err(request(py, &text));
        }
        let numbers = array.as_slice().map_err(|_| {
            request(
                py,
                &format!("{name}: its rows must lie one after the other"),
            )
        })?;
        Ok(Self {
            name,
            numbers,
            columns,
            single: rows == 1,
        })
    }

    /// Whether one row stands for all.
    pub(crate) fn is_single(&self) -> bool {
        self.single
    }

    /// The row of a point.
    pub(crate) fn row(&self, point: usize) -> &'r [f64] {
        self.part(point, 1)
    }

    /// The rows of so many points from one on; the only one where there is one.
    pub(crate) fn part(&self, first: usize, count: usize) -> &'r [f64] {
        let first = if self.single { 0 } else { first };
        let count = if self.single { 1 } else { count };
        let rows = first * self.columns..(first + count) * self.columns;
        self.numbers.get(rows).unwrap_or_default()
    }

    /// Refuses a row that holds a number that is not finite.
    fn check(&self, py: Python<'_>, point: usize) -> PyResult<()> {
        let wrong = self.row(point).iter().position(|it| !it.is_finite());
        wrong.map_or(Ok(()), |column| {
            let (name, row) = (self.name, if self.single { 0 } else { point });
            Err(request(
                py,
                &format!("{name}: number {column} of row {row} is not finite"),
            ))
        })
    }
}

/// Lets `write` fill the rows of `out`, part by part: it is given the number of a first point, and the rows of some.
///
/// # Errors
///
/// Ctrl-C, and a row of one of `of` that is not finite where the result is not.
pub(crate) fn fill(
    py: Python<'_>,
    out: &mut PyReadwriteArray2<'_, f64>,
    of: &[Rows<'_>],
    write: impl Fn(usize, &mut [f64]) + Sync + Send,
) -> PyResult<()> {
    let columns = out.as_array().ncols();
    let out = out
        .as_slice_mut()
        .map_err(|_| request(py, "out: its rows must lie one after the other"))?;
    if columns == 0 {
        return Ok(());
    }
    for (segment, rows) in out.chunks_mut(SEGMENT * columns).enumerate() {
        let first = segment * SEGMENT;
        let unsound = py.detach(|| {
            let tasks = rows.par_chunks_mut(TASK * columns).enumerate();
            let unsound = tasks.filter_map(|(task, rows)| {
                let first = first + task * TASK;
                write(first, rows);
                let wrong = rows.iter().position(|it| !it.is_finite());
                wrong.map(|place| first + place / columns)
            });
            unsound.min()
        });
        py.check_signals()?;
        if let Some(point) = unsound {
            of.iter().try_for_each(|rows| rows.check(py, point))?;
        }
    }
    Ok(())
}
