//! The one place where errors of the core become exceptions.

use pyo3::PyErr;
use pyo3::exceptions::{PyKeyboardInterrupt, PyValueError};

pyo3::create_exception!(
    _core,
    UlnaError,
    PyValueError,
    "A question that the core cannot answer, in words for the user."
);

/// Maps the core's errors.
pub fn raise(error: ulna::Error) -> PyErr {
    match error {
        ulna::Error::Interrupted => PyKeyboardInterrupt::new_err("interrupted"),
        other => UlnaError::new_err(other.to_string()),
    }
}
