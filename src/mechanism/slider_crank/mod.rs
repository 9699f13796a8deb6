//! Planar slider-cranks: parameters, position, gradient, motion and mobility.
//!
//! ```text
//!                  P              A      fixed pivot of the crank
//!                 /               C      moving pin, D the pin of the slider
//!        C ------/------.         P      coupler point, P = C + Z u, Z = coupler_x + i coupler_y
//!      a/       b        `-- D    a = |AC| crank      b = |CD| coupler      u from C to D
//!      A                 [===]    phi    crank angle from the x axis, counter-clockwise, radians
//!    --------Q-------------------> s      the slider's line: Q + y s, s = e^{i line_angle}
//! ```
//!
//! t1 = +1: of the two places at which D meets the line, the one further along s. The place of Q along its line changes
//! only the number y of the slider's place; eight numbers are left: A, a, b, the line (two), Z and the crank angle's zero.
//!
//! | module | holds |
//! |---|---|
//! | [`cognate`] | the other slider-crank that traces the same coupler curve |
//! | [`conversion`] | a slider-crank as a chain, and back |
//! | [`gradient`] | gradient of C, D, u, P and the slider's place by the parameters and the crank angle |
//! | [`position`] | position analysis in closed form, and the rates of coupler and slider |
//! | [`range`] | the range of the crank and the transmission angle |

pub mod cognate;
pub mod conversion;
pub mod gradient;
pub mod position;
pub mod range;

use super::slider::check;
use super::{AssemblyMode, Complex, LinkageError, point, xy};
use serde::{Deserialize, Serialize};

/// A slider-crank: fixed pivot, crank, coupler, line, coupler point and a sign.
///
/// ```
/// use linkwright::{AssemblyMode, SliderCrank, SliderCrankParameters, SliderLinkage};
/// // In line, 3-4-5: crank 3 upright, rod 5, the slider is 4 ahead.
/// let linkage = SliderCrank::new(SliderCrankParameters {
///     crank_pivot: [0.0, 0.0], crank: 3.0, coupler: 5.0, line_point: [0.0, 0.0], line_deg: 0.0,
///     coupler_x: 2.5, coupler_y: 0.0, assembly: AssemblyMode::Plus,
/// })?;
/// let joints = linkage.position(90f64.to_radians()).joints().unwrap();
/// assert!((joints.place - 4.0).abs() < 1e-14 && (joints.coupler_point.re - 2.0).abs() < 1e-14);
/// # Ok::<(), linkwright::LinkageError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(try_from = "SliderCrankParameters", into = "SliderCrankParameters")]
pub struct SliderCrank {
    parameters: SliderCrankParameters,
    /// s, the unit direction of the slider's line.
    direction: Complex,
}

/// The parameters of a slider-crank in their letters, as they stand in files.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SliderCrankParameters {
    /// The fixed pivot of the crank.
    #[serde(rename = "A")]
    pub crank_pivot: [f64; 2],
    /// |AC|.
    #[serde(rename = "a")]
    pub crank: f64,
    /// |CD|.
    #[serde(rename = "b")]
    pub coupler: f64,
    /// Q, a point of the slider's line, from which its place counts.
    pub line_point: [f64; 2],
    /// The direction of the slider's line from the x axis, degrees.
    pub line_deg: f64,
    /// P along the coupler's line from C to D, from C.
    pub coupler_x: f64,
    /// P to the left of that line.
    pub coupler_y: f64,
    /// Of the two places of D on the line, 1: the one further along it.
    #[serde(rename = "t1")]
    #[schemars(with = "i64")]
    pub assembly: AssemblyMode,
}

impl SliderCrank {
    /// Builds a linkage from its parameters.
    ///
    /// # Errors
    /// [`LinkageError`] when a number is not finite or beyond [`MAX_MAGNITUDE`](super::MAX_MAGNITUDE), or a or b is not
    /// positive.
    pub fn new(parameters: SliderCrankParameters) -> Result<Self, LinkageError> {
        let p = &parameters;
        let ([ax, ay], [qx, qy]) = (p.crank_pivot, p.line_point);
        let numbers = [
            ("A", ax),
            ("A", ay),
            ("line_point", qx),
            ("line_point", qy),
            ("line_deg", p.line_deg),
            ("coupler_x", p.coupler_x),
            ("coupler_y", p.coupler_y),
        ];
        check(&numbers, &[("a", p.crank), ("b", p.coupler)])?;
        let direction = Complex::from_polar(1.0, p.line_deg.to_radians());
        Ok(SliderCrank { parameters, direction })
    }

    /// Builds a linkage from A, a, b, Q, the direction of the line (radians), Z and t1.
    ///
    /// # Errors
    /// As [`SliderCrank::new`].
    pub fn from_parts(
        crank_pivot: Complex,
        [crank, coupler]: [f64; 2],
        (line_point, line_angle): (Complex, f64),
        offset: Complex,
        assembly: AssemblyMode,
    ) -> Result<Self, LinkageError> {
        SliderCrank::new(SliderCrankParameters {
            crank_pivot: xy(crank_pivot),
            crank,
            coupler,
            line_point: xy(line_point),
            line_deg: line_angle.to_degrees(),
            coupler_x: offset.re,
            coupler_y: offset.im,
            assembly,
        })
    }

    /// Returns the linkage with every length and coordinate multiplied by a factor.
    ///
    /// # Errors
    /// As [`SliderCrank::new`], if a length leaves the allowed range.
    pub fn scaled(&self, factor: f64) -> Result<Self, LinkageError> {
        let p = self.parameters;
        SliderCrank::new(SliderCrankParameters {
            crank_pivot: p.crank_pivot.map(|x| x * factor),
            crank: p.crank * factor,
            coupler: p.coupler * factor,
            line_point: p.line_point.map(|x| x * factor),
            coupler_x: p.coupler_x * factor,
            coupler_y: p.coupler_y * factor,
            ..p
        })
    }

    /// Returns the same linkage moved by the vector `by`.
    ///
    /// # Errors
    /// As [`SliderCrank::new`], if a coordinate leaves the allowed range.
    pub fn shifted(&self, by: Complex) -> Result<Self, LinkageError> {
        let mut parameters = self.parameters;
        parameters.crank_pivot = xy(point(parameters.crank_pivot) + by);
        parameters.line_point = xy(point(parameters.line_point) + by);
        SliderCrank::new(parameters)
    }

    /// Returns the parameters.
    pub fn parameters(&self) -> SliderCrankParameters {
        self.parameters
    }

    /// Returns b = |CD|, the length of the coupler.
    pub fn coupler(&self) -> f64 {
        self.parameters.coupler
    }

    /// Returns Q, the point of the slider's line from which its place counts.
    pub fn line_point(&self) -> Complex {
        point(self.parameters.line_point)
    }

    /// Returns s, the unit direction of the slider's line.
    pub fn line_direction(&self) -> Complex {
        self.direction
    }

    /// Returns the direction of the slider's line from the x axis, radians.
    pub fn line_angle(&self) -> f64 {
        self.parameters.line_deg.to_radians()
    }

    /// Returns Im((A - Q) conj s), the distance of A to the left of the slider's line.
    pub fn pivot_height(&self) -> f64 {
        super::cross(self.direction, point(self.parameters.crank_pivot) - self.line_point())
    }

    /// Returns the ratio of the longer to the shorter of crank and coupler.
    pub fn link_ratio(&self) -> f64 {
        let (a, b) = (self.parameters.crank, self.parameters.coupler);
        a.max(b) / a.min(b)
    }

    /// Returns the largest distance between two joints of one body, P included: of a, b, |CP| and |DP|.
    pub fn longest(&self) -> f64 {
        let p = &self.parameters;
        let offset = Complex::new(p.coupler_x, p.coupler_y);
        [p.crank, p.coupler, offset.norm(), (offset - p.coupler).norm()].into_iter().fold(0.0, f64::max)
    }
}

impl From<SliderCrank> for SliderCrankParameters {
    fn from(linkage: SliderCrank) -> Self {
        linkage.parameters
    }
}

impl TryFrom<SliderCrankParameters> for SliderCrank {
    type Error = LinkageError;
    fn try_from(parameters: SliderCrankParameters) -> Result<Self, LinkageError> {
        SliderCrank::new(parameters)
    }
}

impl std::fmt::Display for SliderCrank {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let p = &self.parameters;
        let ([ax, ay], [qx, qy]) = (p.crank_pivot, p.line_point);
        let (a, b, deg, x, y) = (p.crank, p.coupler, p.line_deg, p.coupler_x, p.coupler_y);
        let t1 = p.assembly.sign();
        write!(
            f,
            "A ({ax}, {ay})  a {a}  b {b}  line ({qx}, {qy}) at {deg} degrees  coupler_x {x}  coupler_y {y}  t1 {t1:+}"
        )
    }
}
