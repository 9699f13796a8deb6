//! Exceptions, and the border that no panic crosses.

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use std::any::Any;
use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};

pyo3::create_exception!(
    linkwright,
    ProblemError,
    PyValueError,
    "Bad input: a problem, linkage, result or setting that linkwright refuses.\n\nThe text is that of the command \
     line: the place, the fault and the remedy."
);
pyo3::create_exception!(
    linkwright,
    InternalError,
    PyRuntimeError,
    "A bug of linkwright. Please report it with the input that shows it."
);

/// Returns the exception of an input that is refused.
pub fn refused(why: impl Display) -> PyErr {
    ProblemError::new_err(why.to_string())
}

/// Returns the exception of a panic.
pub fn bug(panic: &(dyn Any + Send)) -> PyErr {
    let text = panic.downcast_ref::<&str>().map(|text| (*text).to_owned());
    let text = text.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_default();
    InternalError::new_err(format!(
        "this is a bug of linkwright: please report it with the input that shows it: {text}"
    ))
}

/// Calls a function whose panic becomes an [`InternalError`].
///
/// # Errors
/// Those of the function, and [`InternalError`].
pub fn guarded<T>(call: impl FnOnce() -> PyResult<T>) -> PyResult<T> {
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| Err(bug(panic.as_ref())))
}
