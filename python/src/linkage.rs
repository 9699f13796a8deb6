//! Four-bars: positions, velocities and accelerations at many crank angles.

use crate::arrays::{Input, Output};
use crate::errors::{guarded, refused};
use crate::{moving, values};
use linkwright::internals::files::linkage_file::{self, LinkageFile};
use linkwright::internals::files::name;
use linkwright::internals::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES;
use linkwright::internals::mechanism::four_bar::motion::{CrankMotion, LinkageMotion, PointMotion, Turning};
use linkwright::internals::mechanism::four_bar::positions::JointColumns;
use linkwright::internals::mechanism::{analysis, xy};
use linkwright::{AssemblyMode, Complex, CouplerSide, NaturalCoordinates, Unit};
use numpy::PyArrayDyn;
use pyo3::prelude::*;

/// A planar four-bar linkage.
///
/// A, B: fixed pivots of crank and follower. C, D: moving pins. P: coupler point. a = |AC| crank, b = |CD| coupler,
/// c = |BD| follower, d = |CP|, e = |DP|. t1 = 1: D lies left of the line from C to B; t2 = 1: P lies left of the line
/// from C to D.
///
/// Raises ProblemError for lengths of no linkage.
///
/// >>> import linkwright as lw, math
/// >>> linkage = lw.FourBar((0, 0), (4, 1), 2, 5, 5, 5, 5, t1=1, t2=1)
/// >>> linkage.type
/// 'crank-rocker'
/// >>> at = linkage.positions([0.3, math.nan])
/// >>> at.C.round(3).tolist()
/// [[1.911, 0.591], [nan, nan]]
#[pyclass(frozen, module = "linkwright._linkwright")]
#[derive(Clone)]
pub struct FourBar {
    /// The linkage with its name and unit.
    pub file: LinkageFile,
}

/// Positions of the moving joints; NaN where the loop does not close. Shape: that of the crank angles, and 2.
#[pyclass(frozen, module = "linkwright._linkwright")]
pub struct Positions {
    /// The crank pin.
    #[pyo3(get, name = "C")]
    crank_pin: Py<PyArrayDyn<f64>>,
    /// The follower pin, or the slider's.
    #[pyo3(get, name = "D")]
    follower_pin: Py<PyArrayDyn<f64>>,
    /// The coupler point.
    #[pyo3(get, name = "P")]
    coupler_point: Py<PyArrayDyn<f64>>,
}

impl Positions {
    /// Returns the positions in columns of C, D and P.
    pub fn of([crank_pin, follower_pin, coupler_point]: [Py<PyArrayDyn<f64>>; 3]) -> Self {
        Positions { crank_pin, follower_pin, coupler_point }
    }
}

/// Velocities or accelerations; NaN where the loop does not close and at toggles.
#[pyclass(frozen, module = "linkwright._linkwright")]
pub struct Rates {
    /// Of the crank pin: length a second, or a second squared; shape (n, 2).
    #[pyo3(get, name = "C")]
    crank_pin: Py<PyArrayDyn<f64>>,
    /// Of the follower pin.
    #[pyo3(get, name = "D")]
    follower_pin: Py<PyArrayDyn<f64>>,
    /// Of the coupler point.
    #[pyo3(get, name = "P")]
    coupler_point: Py<PyArrayDyn<f64>>,
    /// Of the coupler: rad/s, or rad/s^2; shape (n,).
    #[pyo3(get)]
    coupler: Py<PyArrayDyn<f64>>,
    /// Of the follower: rad/s, or rad/s^2; shape (n,).
    #[pyo3(get)]
    follower: Py<PyArrayDyn<f64>>,
}

/// Returns the unit of a label.
///
/// # Errors
/// `ProblemError` for another text.
pub fn unit(label: Option<&str>) -> PyResult<Option<Unit>> {
    let of = |label: &str| {
        let found = Unit::ALL.into_iter().find(|unit| unit.label() == label);
        found.ok_or_else(|| refused(format!("`unit` is no unit of length: {label}; choose mm, cm, m or in")))
    };
    label.map(of).transpose()
}

fn sign<S: TryFrom<i64, Error = String>>(key: &str, value: i64) -> PyResult<S> {
    S::try_from(value).map_err(|why| refused(format!("{key}: {why}")))
}

impl FourBar {
    fn rates<'py>(
        &self,
        py: Python<'py>,
        phi: &Bound<'py, PyAny>,
        input: CrankMotion,
        of_point: fn(PointMotion) -> Complex,
        of_link: fn(Turning) -> f64,
    ) -> PyResult<Rates> {
        let linkage = self.file.linkage;
        let at = |angle: f64| {
            let LinkageMotion { crank_pin, follower_pin, coupler_point, coupler, follower, .. } =
                linkage.motion(angle, input).definite()?;
            let points = [crank_pin, follower_pin, coupler_point].map(|point| xy(of_point(point)));
            Some((points, [coupler, follower].map(of_link)))
        };
        let ([crank_pin, follower_pin, coupler_point], [coupler, follower]) = moving::rates(py, phi, at)?;
        Ok(Rates { crank_pin, follower_pin, coupler_point, coupler, follower })
    }
}

#[pymethods]
impl FourBar {
    #[new]
    #[pyo3(
        signature = (A, B, a, b, c, d, e, t1 = 1, t2 = -1, *, name = "linkage", unit = None),
        text_signature = "(A, B, a, b, c, d, e, t1=1, t2=-1, *, name='linkage', unit=None)"
    )]
    #[expect(non_snake_case, reason = "the letters of a linkage file")]
    #[expect(clippy::too_many_arguments, reason = "the parameters of a four-bar")]
    fn new(
        A: [f64; 2],
        B: [f64; 2],
        a: f64,
        b: f64,
        c: f64,
        d: f64,
        e: f64,
        t1: i64,
        t2: i64,
        name: &str,
        unit: Option<&str>,
    ) -> PyResult<Self> {
        guarded(|| {
            let parameters = NaturalCoordinates {
                crank_pivot: A,
                follower_pivot: B,
                crank: a,
                coupler: b,
                follower: c,
                crank_side: d,
                follower_side: e,
                assembly: sign::<AssemblyMode>("t1", t1)?,
                side: sign::<CouplerSide>("t2", t2)?,
            };
            let linkage = linkwright::FourBar::new(parameters).map_err(refused)?;
            let unit = self::unit(unit)?;
            Ok(FourBar { file: LinkageFile { name: name.to_owned(), unit, linkage } })
        })
    }

    /// The name.
    #[getter]
    fn name(&self) -> &str {
        &self.file.name
    }

    /// The unit of its lengths: mm, cm, m or in.
    #[getter]
    fn unit(&self) -> Option<&'static str> {
        self.file.unit.map(Unit::label)
    }

    /// The fixed pivot of the crank.
    #[getter]
    #[pyo3(name = "A")]
    fn crank_pivot(&self) -> (f64, f64) {
        self.file.linkage.natural_coordinates().crank_pivot.into()
    }

    /// The fixed pivot of the follower.
    #[getter]
    #[pyo3(name = "B")]
    fn follower_pivot(&self) -> (f64, f64) {
        self.file.linkage.natural_coordinates().follower_pivot.into()
    }

    /// |AC|, the crank.
    #[getter]
    fn a(&self) -> f64 {
        self.file.linkage.crank()
    }

    /// |CD|, the coupler.
    #[getter]
    fn b(&self) -> f64 {
        self.file.linkage.coupler()
    }

    /// |BD|, the follower.
    #[getter]
    fn c(&self) -> f64 {
        self.file.linkage.follower()
    }

    /// |CP|.
    #[getter]
    fn d(&self) -> f64 {
        self.file.linkage.crank_side()
    }

    /// |DP|.
    #[getter]
    fn e(&self) -> f64 {
        self.file.linkage.follower_side()
    }

    /// |AB|.
    #[getter]
    fn ground(&self) -> f64 {
        self.file.linkage.ground()
    }

    /// 1: D lies left of the line from C to B; -1: right.
    #[getter]
    fn t1(&self) -> i64 {
        self.file.linkage.assembly().into()
    }

    /// 1: P lies left of the line from C to D; -1: right.
    #[getter]
    fn t2(&self) -> i64 {
        self.file.linkage.side().into()
    }

    /// crank-rocker, rocker-crank, double-crank, double-rocker, triple-rocker or change-point; None: no linkage.
    #[getter]
    fn r#type(&self) -> Option<&'static str> {
        self.file.linkage.linkage_type().map(|found| found.name())
    }

    /// p + q - s - l, a length.
    #[getter]
    fn grashof_margin(&self) -> f64 {
        self.file.linkage.mobility().grashof_margin
    }

    /// The longest over the shortest of ground, a, b, c.
    #[getter]
    fn link_ratio(&self) -> f64 {
        self.file.linkage.link_ratio()
    }

    /// Type, range of the input, toggles, circuits, branches, transmission angles (degrees).
    #[getter]
    fn mobility<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        guarded(|| values::data(py, &analysis::mobility(&self.file.linkage)))
    }

    /// Computes the position at crank angles (radians from the x axis, any shape).
    fn positions<'py>(&self, py: Python<'py>, phi: &Bound<'py, PyAny>) -> PyResult<Positions> {
        guarded(|| {
            let angles = Input::of(phi, "phi")?;
            let column = || Output::new(py, angles.shape(), Some(2));
            let mut columns = [column()?, column()?, column()?];
            {
                let numbers = angles.numbers()?;
                let [c, d, p] = &mut columns;
                let joints = JointColumns {
                    crank_pin: c.points()?,
                    follower_pin: d.points()?,
                    coupler_point: p.points()?,
                };
                let linkage = self.file.linkage;
                py.detach(|| linkage.positions(numbers, joints));
            }
            Ok(Positions::of(columns.map(Output::array)))
        })
    }

    /// Computes velocities at crank angles, for a crank speed in rad/s.
    #[pyo3(signature = (phi, omega = 1.0))]
    fn velocities<'py>(&self, py: Python<'py>, phi: &Bound<'py, PyAny>, omega: f64) -> PyResult<Rates> {
        guarded(|| {
            let input = CrankMotion::steady(omega);
            self.rates(py, phi, input, |point| point.velocity, |link| link.speed_rad_s)
        })
    }

    /// Computes accelerations at crank angles, for a crank's speed (rad/s) and acceleration (rad/s^2).
    #[pyo3(signature = (phi, omega = 1.0, alpha = 0.0))]
    fn accelerations<'py>(
        &self,
        py: Python<'py>,
        phi: &Bound<'py, PyAny>,
        omega: f64,
        alpha: f64,
    ) -> PyResult<Rates> {
        guarded(|| {
            let input = CrankMotion { speed_rad_s: omega, acceleration_rad_s2: alpha };
            self.rates(py, phi, input, |point| point.acceleration, |link| link.acceleration_rad_s2)
        })
    }

    /// Computes the transmission angle at crank angles, in [0, 180] degrees; NaN where the loop does not close.
    fn transmission_deg<'py>(
        &self,
        py: Python<'py>,
        phi: &Bound<'py, PyAny>,
    ) -> PyResult<Py<PyArrayDyn<f64>>> {
        guarded(|| {
            let linkage = self.file.linkage;
            moving::numbers(py, phi, |angle| linkage.transmission_angle(angle).map(f64::to_degrees))
        })
    }

    /// Samples the coupler curve of the circuit that holds the position at the crank angle `at`; shape (m, 2).
    #[pyo3(
        signature = (at = 0.0, samples = DEFAULT_SAMPLES),
        text_signature = "($self, at=0.0, samples=720)"
    )]
    fn coupler_curve(&self, py: Python<'_>, at: f64, samples: usize) -> PyResult<Py<PyArrayDyn<f64>>> {
        guarded(|| moving::coupler_curve(py, &self.file.linkage, at, samples))
    }

    /// Returns the text of its linkage file.
    fn to_toml(&self) -> String {
        let name = name::legal(&self.file.name, "linkage");
        linkage_file::to_toml(&name, self.file.unit, &self.file.linkage)
    }

    /// Returns the other linkages of the same coupler curve.
    fn cognates(&self) -> PyResult<Vec<FourBar>> {
        guarded(|| {
            let found = self.file.linkage.cognates().into_iter().flatten().map(|cognate| cognate.linkage);
            let named = |(i, linkage): (usize, linkwright::FourBar)| {
                let suffix = format!("-cognate-{}", i + 1);
                let name = name::with_suffix(&self.file.name, &suffix);
                FourBar { file: LinkageFile { name, unit: self.file.unit, linkage } }
            };
            Ok(found.enumerate().map(named).collect())
        })
    }

    fn __repr__(&self) -> String {
        let [ax, ay, bx, by, a, b, c, d, e] = self.file.linkage.natural_coordinates().numbers();
        let (t1, t2) = (self.t1(), self.t2());
        format!(
            "FourBar(A=({ax:?}, {ay:?}), B=({bx:?}, {by:?}), a={a:?}, b={b:?}, c={c:?}, d={d:?}, e={e:?}, t1={t1}, \
             t2={t2})"
        )
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<FourBar>().is_ok_and(|other| other.get().file.linkage == self.file.linkage)
    }

    fn __hash__(&self) -> u64 {
        use std::hash::{Hash, Hasher};
        let mut hasher = std::collections::hash_map::DefaultHasher::new();
        let numbers = self.file.linkage.natural_coordinates().numbers();
        // Equal numbers have equal bits, but for the two zeros.
        (numbers.map(|x| (x + 0.0).to_bits()), self.t1(), self.t2()).hash(&mut hasher);
        hasher.finish()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let read = py.import("linkwright._linkwright")?.getattr("parse_linkage")?;
        Ok((read, (self.to_toml(),)))
    }
}
