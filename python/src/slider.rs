//! Slider-cranks and inverted slider-cranks: positions, rates and the slider's place at many crank angles.

use crate::arrays::{Input, Output};
use crate::errors::{guarded, refused};
use crate::linkage::{Positions, unit};
use crate::{moving, values};
use linkwright::internals::files::linkage_file::any_to_toml;
use linkwright::internals::files::name;
use linkwright::internals::mechanism::four_bar::coupler_curve::DEFAULT_SAMPLES;
use linkwright::internals::mechanism::four_bar::motion::{CrankMotion, PointMotion};
use linkwright::internals::mechanism::slider::motion::{SlidingMotion, motion};
use linkwright::internals::mechanism::{
    CrankLinkage, InvertedSliderCrank, InvertedSliderCrankParameters, LinkageError, LoopJoints, SliderCrank,
    SliderCrankParameters, xy,
};
use linkwright::{AssemblyMode, Complex, Unit};
use numpy::PyArrayDyn;
use pyo3::prelude::*;
use serde_json::json;

/// A linkage with a slider: a slider-crank or an inverted slider-crank.
///
/// A: fixed pivot of the crank, a = |AC|; P = C + (coupler_x + i coupler_y) u, u the coupler's direction. Of a slider-crank D
/// slides along the line through line_point at line_deg, b = |CD|; of an inverted one the coupler slides through a block that
/// turns about B, which lies `offset` to the left of the coupler's line through C, and D is the foot of B on that line.
/// Results give them, and :func:`linkwright.load` reads them; :func:`linkwright.slider_crank` and
/// :func:`linkwright.inverted_slider_crank` make them.
#[pyclass(frozen, module = "linkwright._linkwright")]
#[derive(Clone)]
pub struct SliderLinkage {
    pub name: String,
    pub unit: Option<Unit>,
    pub linkage: CrankLinkage,
}

/// Velocities or accelerations of a linkage with a slider; NaN where the loop does not close and at toggles.
#[pyclass(frozen, module = "linkwright._linkwright")]
pub struct SliderRates {
    /// Of the crank pin: length a second, or a second squared; shape (n, 2).
    #[pyo3(get, name = "C")]
    crank_pin: Py<PyArrayDyn<f64>>,
    /// Of the slider's pin.
    #[pyo3(get, name = "D")]
    slider_pin: Py<PyArrayDyn<f64>>,
    /// Of the coupler point.
    #[pyo3(get, name = "P")]
    coupler_point: Py<PyArrayDyn<f64>>,
    /// Of the coupler: rad/s, or rad/s^2; shape (n,).
    #[pyo3(get)]
    coupler: Py<PyArrayDyn<f64>>,
    /// Of the slider along its line, or of the block along the coupler; shape (n,).
    #[pyo3(get)]
    slider: Py<PyArrayDyn<f64>>,
}

impl SliderLinkage {
    fn at(&self, angle: f64) -> Option<LoopJoints> {
        self.linkage.joints_with(angle, self.linkage.assembly())
    }

    fn moving(&self, angle: f64, input: CrankMotion) -> Option<SlidingMotion> {
        match &self.linkage {
            CrankLinkage::FourBar(_) | CrankLinkage::MultiLoop(_) => None,
            CrankLinkage::SliderCrank(linkage) => motion(linkage, angle, input).definite(),
            CrankLinkage::InvertedSliderCrank(linkage) => motion(linkage, angle, input).definite(),
        }
    }

    fn rates(
        &self,
        py: Python<'_>,
        phi: &Bound<'_, PyAny>,
        input: CrankMotion,
        of_point: fn(PointMotion) -> Complex,
        of_parts: fn(&SlidingMotion) -> [f64; 2],
    ) -> PyResult<SliderRates> {
        let at = |angle: f64| {
            let moved = self.moving(angle, input)?;
            let points = [moved.crank_pin, moved.rates.slider_pin, moved.coupler_point];
            Some((points.map(|point| xy(of_point(point))), of_parts(&moved)))
        };
        let ([crank_pin, slider_pin, coupler_point], [coupler, slider]) = moving::rates(py, phi, at)?;
        Ok(SliderRates { crank_pin, slider_pin, coupler_point, coupler, slider })
    }

    /// Returns a linkage, if its numbers are those of one, with its name and the unit of a label.
    fn named(linkage: Result<CrankLinkage, LinkageError>, name: &str, label: Option<&str>) -> PyResult<Self> {
        Ok(SliderLinkage { name: name.to_owned(), unit: unit(label)?, linkage: linkage.map_err(refused)? })
    }
}

fn t1(value: i64) -> PyResult<AssemblyMode> {
    AssemblyMode::try_from(value).map_err(|why: String| refused(format!("t1: {why}")))
}

/// Makes a slider-crank.
#[pyfunction]
#[pyo3(
    signature = (A, a, b, line_point, line_deg, coupler_x = None, coupler_y = 0.0, t1 = 1, *, name = "linkage", unit = None),
    text_signature = "(A, a, b, line_point, line_deg, coupler_x=None, coupler_y=0.0, t1=1, *, name='linkage', unit=None)"
)]
#[expect(non_snake_case, reason = "the letters of a linkage file")]
#[expect(clippy::too_many_arguments, reason = "the parameters of a slider-crank")]
pub fn slider_crank(
    A: [f64; 2],
    a: f64,
    b: f64,
    line_point: [f64; 2],
    line_deg: f64,
    coupler_x: Option<f64>,
    coupler_y: f64,
    t1: i64,
    name: &str,
    unit: Option<&str>,
) -> PyResult<SliderLinkage> {
    guarded(|| {
        let made = SliderCrank::new(SliderCrankParameters {
            crank_pivot: A,
            crank: a,
            coupler: b,
            line_point,
            line_deg,
            coupler_x: coupler_x.unwrap_or(b),
            coupler_y,
            assembly: self::t1(t1)?,
        });
        SliderLinkage::named(made.map(CrankLinkage::SliderCrank), name, unit)
    })
}

/// Makes an inverted slider-crank.
#[pyfunction]
#[pyo3(
    signature = (A, B, a, offset = 0.0, coupler_x = 0.0, coupler_y = 0.0, t1 = 1, *, name = "linkage", unit = None),
    text_signature = "(A, B, a, offset=0.0, coupler_x=0.0, coupler_y=0.0, t1=1, *, name='linkage', unit=None)"
)]
#[expect(non_snake_case, reason = "the letters of a linkage file")]
#[expect(clippy::too_many_arguments, reason = "the parameters of an inverted slider-crank")]
pub fn inverted_slider_crank(
    A: [f64; 2],
    B: [f64; 2],
    a: f64,
    offset: f64,
    coupler_x: f64,
    coupler_y: f64,
    t1: i64,
    name: &str,
    unit: Option<&str>,
) -> PyResult<SliderLinkage> {
    guarded(|| {
        let made = InvertedSliderCrank::new(InvertedSliderCrankParameters {
            crank_pivot: A,
            block_pivot: B,
            crank: a,
            offset,
            coupler_x,
            coupler_y,
            assembly: self::t1(t1)?,
        });
        SliderLinkage::named(made.map(CrankLinkage::InvertedSliderCrank), name, unit)
    })
}

#[pymethods]
impl SliderLinkage {
    /// slider-crank or inverted-slider-crank.
    #[getter]
    fn kind(&self) -> &'static str {
        self.linkage.kind().name()
    }

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

    /// The fixed pivot of the crank.
    #[getter]
    #[pyo3(name = "A")]
    fn crank_pivot(&self) -> (f64, f64) {
        xy(self.linkage.crank_pivot()).into()
    }

    /// The fixed pivot of the block; None of a slider-crank.
    #[getter]
    #[pyo3(name = "B")]
    fn block_pivot(&self) -> Option<(f64, f64)> {
        self.linkage.second_pivot().map(|pivot| xy(pivot).into())
    }

    /// |AC|, the crank.
    #[getter]
    fn a(&self) -> f64 {
        self.linkage.crank()
    }

    /// |CD|, the coupler; None of an inverted slider-crank.
    #[getter]
    fn b(&self) -> Option<f64> {
        self.linkage.coupler()
    }

    /// The distance of B to the left of the coupler's line; None of a slider-crank.
    #[getter]
    fn offset(&self) -> Option<f64> {
        self.linkage.inverted_slider_crank().map(|linkage| linkage.offset())
    }

    /// A point of the slider's line; None of an inverted slider-crank.
    #[getter]
    fn line_point(&self) -> Option<(f64, f64)> {
        self.linkage.slider_crank().map(|linkage| xy(linkage.line_point()).into())
    }

    /// The direction of the slider's line, degrees; None of an inverted slider-crank.
    #[getter]
    fn line_deg(&self) -> Option<f64> {
        self.linkage.slider_crank().map(|linkage| linkage.parameters().line_deg)
    }

    /// P along the coupler from C.
    #[getter]
    fn coupler_x(&self) -> f64 {
        self.linkage.coupler_offset().re
    }

    /// P to the left of the coupler.
    #[getter]
    fn coupler_y(&self) -> f64 {
        self.linkage.coupler_offset().im
    }

    /// 1: D is the further of its two places along the line, or the block is ahead of C; -1: the other.
    #[getter]
    fn t1(&self) -> i64 {
        self.linkage.assembly().into()
    }

    /// The longest over the shortest of a and b, or of a and |AB|.
    #[getter]
    fn link_ratio(&self) -> f64 {
        self.linkage.link_ratio()
    }

    /// Whether the crank turns fully (input_turns_fully), and where it can stand (input_arcs_deg).
    #[getter]
    fn mobility<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        guarded(|| {
            let mobility = self.linkage.mobility();
            let turns = mobility.input_turns_fully();
            let arcs: Vec<[f64; 2]> =
                mobility.input.arcs().iter().map(|arc| arc.ends().map(f64::to_degrees)).collect();
            values::data(py, &json!({ "input_turns_fully": turns, "input_arcs_deg": arcs }))
        })
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
                let (c, d, p) = (c.points()?, d.points()?, p.points()?);
                py.detach(|| {
                    for (i, angle) in numbers.iter().enumerate() {
                        let at = self.at(*angle).map(|at| at.joints);
                        let joints = at.map(|at| [at.crank_pin, at.follower_pin, at.coupler_point].map(xy));
                        [c[i], d[i], p[i]] = joints.unwrap_or([[f64::NAN; 2]; 3]);
                    }
                });
            }
            Ok(Positions::of(columns.map(Output::array)))
        })
    }

    /// Computes the slider's place at crank angles: along its line from the foot of the perpendicular from A, or of the block
    /// along the coupler from C; NaN where the loop does not close.
    fn places<'py>(&self, py: Python<'py>, phi: &Bound<'py, PyAny>) -> PyResult<Py<PyArrayDyn<f64>>> {
        guarded(|| moving::numbers(py, phi, |angle| self.linkage.slider_place(&self.at(angle)?)))
    }

    /// Computes velocities at crank angles, for a crank speed in rad/s.
    #[pyo3(signature = (phi, omega = 1.0))]
    fn velocities<'py>(&self, py: Python<'py>, phi: &Bound<'py, PyAny>, omega: f64) -> PyResult<SliderRates> {
        guarded(|| {
            let of_parts = |m: &SlidingMotion| [m.rates.coupler.speed_rad_s, m.rates.sliding.speed];
            self.rates(py, phi, CrankMotion::steady(omega), |point| point.velocity, of_parts)
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
    ) -> PyResult<SliderRates> {
        guarded(|| {
            let input = CrankMotion { speed_rad_s: omega, acceleration_rad_s2: alpha };
            let of_parts =
                |m: &SlidingMotion| [m.rates.coupler.acceleration_rad_s2, m.rates.sliding.acceleration];
            self.rates(py, phi, input, |point| point.acceleration, of_parts)
        })
    }

    /// Computes the transmission angle at crank angles, degrees; NaN where the loop does not close.
    fn transmission_deg<'py>(
        &self,
        py: Python<'py>,
        phi: &Bound<'py, PyAny>,
    ) -> PyResult<Py<PyArrayDyn<f64>>> {
        guarded(|| {
            let of = |angle: f64| self.at(angle).map(|_| self.linkage.transmission_at(angle).to_degrees());
            moving::numbers(py, phi, of)
        })
    }

    /// Samples the coupler curve of the circuit that holds the position at the crank angle `at`; shape (m, 2).
    #[pyo3(
        signature = (at = 0.0, samples = DEFAULT_SAMPLES),
        text_signature = "($self, at=0.0, samples=720)"
    )]
    fn coupler_curve(&self, py: Python<'_>, at: f64, samples: usize) -> PyResult<Py<PyArrayDyn<f64>>> {
        guarded(|| moving::coupler_curve(py, &self.linkage, at, samples))
    }

    /// Returns the text of its linkage file.
    fn to_toml(&self) -> String {
        any_to_toml(&name::legal(&self.name, "linkage"), self.unit, &self.linkage)
    }

    fn __repr__(&self) -> String {
        format!("SliderLinkage({}: {})", self.kind(), self.linkage)
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<SliderLinkage>().is_ok_and(|other| other.get().linkage == self.linkage)
    }

    fn __hash__(&self) -> u64 {
        use std::hash::{Hash, Hasher};
        let mut hasher = std::collections::hash_map::DefaultHasher::new();
        // Equal numbers have equal bits, but for the two zeros.
        (
            self.kind(),
            self.linkage.numbers().into_iter().map(|x| (x + 0.0).to_bits()).collect::<Vec<u64>>(),
            self.t1(),
        )
            .hash(&mut hasher);
        hasher.finish()
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let read = py.import("linkwright._linkwright")?.getattr("parse_linkage")?;
        Ok((read, (self.to_toml(),)))
    }
}
