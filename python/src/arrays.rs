//! Arrays of numpy in and out.
//!
//! The rule: anything that numpy turns into an array of whole or floating-point numbers is taken, of any shape, byte
//! order, precision and layout; it is converted to 64-bit floats, and values that these cannot hold exactly are rounded.
//! Other kinds (booleans, complex numbers, texts, objects, dates) are refused with a `TypeError`. NaN and infinities are
//! numbers: at such a crank angle the loop does not close. The answers have the shape of the input, with one more axis of
//! 2 for points.

use crate::memory;
use numpy::{PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn, PyReadwriteArrayDyn, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;

/// A contiguous array of 64-bit floats.
pub struct Input<'py> {
    array: PyReadonlyArrayDyn<'py, f64>,
}

impl<'py> Input<'py> {
    /// Converts an object; `name` is that of the argument.
    ///
    /// # Errors
    /// `TypeError` for what is no array of numbers, `ValueError` for a ragged list.
    pub fn of(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Self> {
        let py = object.py();
        if let Ok(array) = object.cast::<PyArrayDyn<f64>>()
            && let Ok(array) = array.try_readonly()
            && array.is_c_contiguous()
            && array.as_slice().is_ok()
        {
            return Ok(Input { array });
        }
        let numpy = py.import(intern!(py, "numpy"))?;
        let array = numpy.call_method1(intern!(py, "asarray"), (object,)).map_err(|e| {
            PyValueError::new_err(format!("{name}: it cannot be made an array of numbers: {}", e.value(py)))
        })?;
        let dtype = array.getattr(intern!(py, "dtype"))?;
        let kind: String = dtype.getattr(intern!(py, "kind"))?.extract()?;
        if !["f", "i", "u"].contains(&kind.as_str()) {
            return Err(PyTypeError::new_err(format!(
                "{name}: real numbers are needed, and this is an array of {dtype}"
            )));
        }
        let plain = numpy.call_method1(intern!(py, "require"), (array, "f8", ["C", "A"]))?;
        let plain = plain.cast_into::<PyArrayDyn<f64>>()?;
        Ok(Input { array: plain.try_readonly()? })
    }

    /// Returns the numbers, the last axis the fastest.
    ///
    /// # Errors
    /// Never, of a contiguous array.
    pub fn numbers(&self) -> PyResult<&[f64]> {
        Ok(self.array.as_slice()?)
    }

    /// Returns the shape.
    pub fn shape(&self) -> &[usize] {
        self.array.shape()
    }
}

/// A new array, to be filled.
pub struct Output<'py> {
    array: PyReadwriteArrayDyn<'py, f64>,
}

impl<'py> Output<'py> {
    /// Makes an array of a shape, with a further axis if `last` is given.
    ///
    /// # Errors
    /// `MemoryError`.
    pub fn new(py: Python<'py>, shape: &[usize], last: Option<usize>) -> PyResult<Self> {
        let array = memory::array(py, shape.iter().copied().chain(last).collect())?;
        Ok(Output { array: array.try_readwrite()? })
    }

    /// Returns the numbers.
    ///
    /// # Errors
    /// Never, of a contiguous array.
    pub fn numbers(&mut self) -> PyResult<&mut [f64]> {
        Ok(self.array.as_slice_mut()?)
    }

    /// Returns the numbers in pairs.
    ///
    /// # Errors
    /// Never, of a contiguous array.
    pub fn points(&mut self) -> PyResult<&mut [[f64; 2]]> {
        Ok(self.numbers()?.as_chunks_mut().0)
    }

    /// Returns the array.
    pub fn array(self) -> Py<PyArrayDyn<f64>> {
        self.array.as_unbound().clone_ref(self.array.py())
    }
}
