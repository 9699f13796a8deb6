//! Figures of a moving linkage as arrays, for every kind of linkage.

use crate::arrays::{Input, Output};
use linkwright::CouplerCurve;
use linkwright::internals::mechanism::four_bar::coupler_curve::CrankDriven;
use linkwright::internals::mechanism::xy;
use numpy::PyArrayDyn;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// Returns an array with a number at each crank angle, NaN where there is none.
pub fn numbers(
    py: Python<'_>,
    phi: &Bound<'_, PyAny>,
    of: impl Fn(f64) -> Option<f64> + Sync,
) -> PyResult<Column> {
    let angles = Input::of(phi, "phi")?;
    let mut found = Output::new(py, angles.shape(), None)?;
    {
        let (numbers, places) = (angles.numbers()?, found.numbers()?);
        py.detach(|| {
            for (place, angle) in places.iter_mut().zip(numbers) {
                *place = of(*angle).unwrap_or(f64::NAN);
            }
        });
    }
    Ok(found.array())
}

/// An array of numbers.
type Column = Py<PyArrayDyn<f64>>;

/// The rates of a linkage: of C, D and P, and two more numbers.
pub type Moved = ([[f64; 2]; 3], [f64; 2]);

/// Returns the rates at each crank angle, NaN where there are none: arrays of three points and of two numbers.
pub fn rates(
    py: Python<'_>,
    phi: &Bound<'_, PyAny>,
    of: impl Fn(f64) -> Option<Moved> + Sync,
) -> PyResult<([Column; 3], [Column; 2])> {
    let angles = Input::of(phi, "phi")?;
    let linear = || Output::new(py, angles.shape(), Some(2));
    let plain = || Output::new(py, angles.shape(), None);
    let (mut points, mut links) = ([linear()?, linear()?, linear()?], [plain()?, plain()?]);
    {
        let numbers = angles.numbers()?;
        let [c, d, p] = &mut points;
        let (c, d, p) = (c.points()?, d.points()?, p.points()?);
        let [one, other] = &mut links;
        let (one, other) = (one.numbers()?, other.numbers()?);
        py.detach(|| {
            for (i, angle) in numbers.iter().enumerate() {
                ([c[i], d[i], p[i]], [one[i], other[i]]) =
                    of(*angle).unwrap_or(([[f64::NAN; 2]; 3], [f64::NAN; 2]));
            }
        });
    }
    Ok((points.map(Output::array), links.map(Output::array)))
}

/// Returns the coupler curve of the circuit that holds the position at a crank angle; shape (m, 2).
pub fn coupler_curve<L: CrankDriven>(
    py: Python<'_>,
    linkage: &L,
    at: f64,
    samples: usize,
) -> PyResult<Column> {
    if !(8..=100_000).contains(&samples) {
        return Err(PyValueError::new_err(format!("samples = {samples}: 8 to 100000 are possible")));
    }
    let curve = CouplerCurve::through(linkage, at, linkage.assembly(), samples);
    let points: Vec<[f64; 2]> = curve.points().map(xy).collect();
    let mut found = Output::new(py, &[points.len()], Some(2))?;
    found.points()?.copy_from_slice(&points);
    Ok(found.array())
}
