//! Chains: compound mechanisms, every point at many crank angles.

use crate::arrays::{Input, Output};
use crate::errors::{guarded, refused};
use linkwright::Chain as Kernel;
use linkwright::Unit;
use linkwright::internals::files::linkage_file::multi_loop_to_toml;
use linkwright::internals::mechanism::MultiLoop;
use linkwright::internals::mechanism::chain::PointId;
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A compound mechanism of a crank and stages, from :func:`linkwright.load`; six-bars and eight-bars of results are chains.
#[pyclass(frozen, module = "linkwright._linkwright")]
pub struct Chain {
    pub name: String,
    pub unit: Option<Unit>,
    pub chain: Kernel,
    /// The text of its file, from which it is read again.
    pub text: String,
}

/// The quantity that is asked for.
#[derive(Clone, Copy)]
enum Asked {
    Position,
    Velocity { omega: f64 },
    Acceleration { omega: f64, alpha: f64 },
}

impl Chain {
    /// Returns the chain of a six-bar or an eight-bar.
    pub fn of(name: String, unit: Option<Unit>, linkage: &MultiLoop) -> PyResult<Self> {
        let text = multi_loop_to_toml(&name, unit, linkage);
        let chain = linkage.to_chain().map_err(refused)?;
        Ok(Chain { name, unit, chain, text })
    }

    fn computed<'py>(
        &self,
        py: Python<'py>,
        phi: &Bound<'py, PyAny>,
        asked: Asked,
    ) -> PyResult<Bound<'py, PyDict>> {
        let angles = Input::of(phi, "phi")?;
        let ids: Vec<PointId> =
            self.chain.names().iter().filter_map(|name| self.chain.point_id(name)).collect();
        let columns = ids.iter().map(|_| Output::new(py, angles.shape(), Some(2)));
        let mut columns = columns.collect::<PyResult<Vec<_>>>()?;
        {
            let numbers = angles.numbers()?;
            let mut places = columns.iter_mut().map(Output::points).collect::<PyResult<Vec<_>>>()?;
            py.detach(|| {
                let mut motion = self.chain.motion();
                let (omega, alpha) = match asked {
                    Asked::Position => (0.0, 0.0),
                    Asked::Velocity { omega } => (omega, 0.0),
                    Asked::Acceleration { omega, alpha } => (omega, alpha),
                };
                for (i, angle) in numbers.iter().enumerate() {
                    let usable = self.chain.move_at(*angle, omega, alpha, &mut motion);
                    let usable =
                        !matches!(usable, linkwright::internals::mechanism::chain::Outcome::InputNotUsable);
                    for (place, id) in places.iter_mut().zip(&ids) {
                        let found = match asked {
                            Asked::Position => motion.point(*id),
                            Asked::Velocity { .. } => motion.velocity(*id),
                            Asked::Acceleration { .. } => motion.acceleration(*id),
                        };
                        place[i] = found.filter(|_| usable).map_or([f64::NAN; 2], |p| [p.re, p.im]);
                    }
                }
            });
        }
        let found = PyDict::new(py);
        for (name, column) in self.chain.names().iter().zip(columns) {
            let array: Py<PyArrayDyn<f64>> = column.array();
            found.set_item(name, array)?;
        }
        Ok(found)
    }
}

#[pymethods]
impl Chain {
    /// The name.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    /// The unit of its lengths: mm, cm, m or in.
    #[getter]
    fn unit(&self) -> Option<&'static str> {
        self.unit.map(Unit::label)
    }

    /// The names of the points: pivots, the crank's joint, then one point a stage.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.chain.names().to_vec()
    }

    /// The name of the point whose path is shown.
    #[getter]
    fn trace(&self) -> &str {
        &self.chain.names()[self.chain.trace().index()]
    }

    /// The links, each as the names of its points.
    #[getter]
    fn links(&self) -> Vec<Vec<String>> {
        let name = |id: &PointId| self.chain.names()[id.index()].clone();
        self.chain.links().iter().map(|link| link.iter().map(name).collect()).collect()
    }

    /// Computes every point at crank angles (radians); NaN of and after a stage that does not close.
    fn positions<'py>(&self, py: Python<'py>, phi: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
        guarded(|| self.computed(py, phi, Asked::Position))
    }

    /// Computes the velocity of every point, for a crank speed in rad/s.
    #[pyo3(signature = (phi, omega = 1.0))]
    fn velocities<'py>(
        &self,
        py: Python<'py>,
        phi: &Bound<'py, PyAny>,
        omega: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        guarded(|| self.computed(py, phi, Asked::Velocity { omega }))
    }

    /// Computes the acceleration of every point.
    #[pyo3(signature = (phi, omega = 1.0, alpha = 0.0))]
    fn accelerations<'py>(
        &self,
        py: Python<'py>,
        phi: &Bound<'py, PyAny>,
        omega: f64,
        alpha: f64,
    ) -> PyResult<Bound<'py, PyDict>> {
        guarded(|| self.computed(py, phi, Asked::Acceleration { omega, alpha }))
    }

    /// Returns the text of its linkage file.
    fn to_toml(&self) -> &str {
        &self.text
    }

    fn __repr__(&self) -> String {
        format!(
            "<Chain {:?}: {} stages, points {}>",
            self.name,
            self.chain.stages(),
            self.chain.names().join(", ")
        )
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let read = py.import("linkwright._linkwright")?.getattr("parse_linkage")?;
        Ok((read, (self.text.clone(),)))
    }
}
