//! Failures as exceptions: classes of the package `ahv`, which every module shares.

use ahv_cli::failure::Failure;
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

/// The exception of a failure, with the text of the command line.
pub(crate) fn raised(py: Python<'_>, failure: &Failure) -> PyErr {
    match failure {
        Failure::Request(text) => request(py, text),
        Failure::Numeric(text) => exception(py, "NumericError", text),
        Failure::Interrupted(text) => PyKeyboardInterrupt::new_err(text.clone()),
    }
}

/// A request that cannot be carried out.
pub(crate) fn request(py: Python<'_>, text: &str) -> PyErr {
    exception(py, "RequestError", text)
}

/// A computation that failed.
pub(crate) fn numeric(py: Python<'_>, error: impl std::fmt::Display) -> PyErr {
    exception(py, "NumericError", &error.to_string())
}

fn exception(py: Python<'_>, name: &str, text: &str) -> PyErr {
    let made = py
        .import("ahv._errors")
        .and_then(|module| module.getattr(name)?.call1((text,)));
    made.map_or_else(|error| error, PyErr::from_value)
}
