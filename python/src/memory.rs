//! Memory of large arrays, kept for the next ones: the system clears the pages of new memory, which takes as long as the
//! positions that are written there.

use numpy::{PyArrayDyn, PyUntypedArrayMethods};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use std::sync::{Mutex, PoisonError};

/// The least number of bytes of an array whose memory is kept.
const LEAST: usize = 1 << 20;
/// The most bytes that are kept in all.
const MOST: usize = 64 << 20;

/// The arrays that nobody uses any more, the oldest first.
static UNUSED: Mutex<Vec<Py<PyArrayDyn<f64>>>> = Mutex::new(Vec::new());

/// The owner of an array's memory, which numpy lets go of with the last array on it.
#[pyclass(module = "linkwright._linkwright", frozen)]
pub struct Memory {
    array: Option<Py<PyArrayDyn<f64>>>,
}

#[pymethods]
impl Memory {
    /// Describes the memory as numpy's array interface, of which it makes an array.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let interface =
            |array: &Py<PyArrayDyn<f64>>| array.bind(py).getattr(intern!(py, "__array_interface__"));
        self.array.as_ref().map(interface).transpose()
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        Python::attach(|py| self.array.take().into_iter().for_each(|array| keep(py, array)));
    }
}

fn bytes(array: &Bound<'_, PyArrayDyn<f64>>) -> usize {
    array.len() * size_of::<f64>()
}

/// Keeps an array for the next one of its shape; the oldest ones are let go of.
fn keep(py: Python<'_>, array: Py<PyArrayDyn<f64>>) {
    let mut unused = UNUSED.lock().unwrap_or_else(PoisonError::into_inner);
    unused.push(array);
    let mut all: usize = unused.iter().map(|array| bytes(array.bind(py))).sum();
    let mut gone = Vec::new();
    while all > MOST {
        let oldest = unused.remove(0);
        all -= bytes(oldest.bind(py));
        gone.push(oldest);
    }
    drop(unused);
}

/// Makes an array of a shape with any numbers in it, of memory that was kept if there is any of that shape.
///
/// # Errors
/// `MemoryError`.
pub fn array<'py>(py: Python<'py>, shape: Vec<usize>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let numpy = py.import(intern!(py, "numpy"))?;
    let new = || -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
        let shape = PyTuple::new(py, &shape)?;
        Ok(numpy.call_method1(intern!(py, "empty"), (shape,))?.cast_into()?)
    };
    let size = shape.iter().try_fold(size_of::<f64>(), |size, n| size.checked_mul(*n));
    if size.is_none_or(|size| !(LEAST..=MOST).contains(&size)) {
        return new();
    }
    let kept = {
        let mut unused = UNUSED.lock().unwrap_or_else(PoisonError::into_inner);
        let place = unused.iter().rposition(|array| array.bind(py).shape() == shape);
        place.map(|place| unused.remove(place))
    };
    let array = Some(kept.map_or_else(|| new().map(Bound::unbind), Ok)?);
    let memory = Bound::new(py, Memory { array })?;
    Ok(numpy.call_method1(intern!(py, "asarray"), (memory,))?.cast_into()?)
}
