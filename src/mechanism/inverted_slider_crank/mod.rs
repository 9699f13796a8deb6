//! Planar inverted slider-cranks: parameters, position, gradient, motion and mobility.
//!
//! ```text
//!            P                    A, B   fixed pivots: A of the crank, B of the block
//!           /                     C      moving pin, P coupler point, P = C + Z u, Z = coupler_x + i coupler_y
//!   C -----/------D------> u      u      unit direction of the coupler, a rod that slides through the block at B
//!   a\           h|               D      foot of the perpendicular from B on the coupler's line, D = C + x u
//!     A         [=B=]             h      offset: B lies so far to the left of the coupler's line (drawn: h < 0)
//! ```
//!
//! t1 = +1: the block is ahead of C along u, x > 0. a = |AC| is the crank, g = |AB| the ground; phi is the crank angle from
//! the x axis, counter-clockwise, in radians.
//!
//! | module | holds |
//! |---|---|
//! | [`conversion`] | an inverted slider-crank as a chain, and back |
//! | [`gradient`] | gradient of C, D, u, P and the slider's place by the parameters and the crank angle |
//! | [`position`] | position analysis in closed form, and the rates of coupler and slider |
//! | [`range`] | the range of the crank and the transmission angle |

pub mod conversion;
pub mod gradient;
pub mod position;
pub mod range;

use super::slider::check;
use super::{AssemblyMode, Complex, LinkageError, point, xy};
use serde::{Deserialize, Serialize};

/// An inverted slider-crank: fixed pivots, crank, offset, coupler point and a sign.
///
/// ```
/// use linkwright::{AssemblyMode, InvertedSliderCrank, InvertedSliderCrankParameters, SliderLinkage};
/// // Crank 3 upright, B 4 ahead: the coupler points from (0, 3) to B, 5 away.
/// let linkage = InvertedSliderCrank::new(InvertedSliderCrankParameters {
///     crank_pivot: [0.0, 0.0], block_pivot: [4.0, 0.0], crank: 3.0, offset: 0.0,
///     coupler_x: 10.0, coupler_y: 0.0, assembly: AssemblyMode::Plus,
/// })?;
/// let joints = linkage.position(90f64.to_radians()).joints().unwrap();
/// assert!((joints.place - 5.0).abs() < 1e-14 && (joints.coupler_point.im + 3.0).abs() < 1e-14);
/// # Ok::<(), linkwright::LinkageError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(try_from = "InvertedSliderCrankParameters", into = "InvertedSliderCrankParameters")]
pub struct InvertedSliderCrank {
    parameters: InvertedSliderCrankParameters,
}

/// The parameters of an inverted slider-crank in their letters, as they stand in files.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InvertedSliderCrankParameters {
    /// The fixed pivot of the crank.
    #[serde(rename = "A")]
    pub crank_pivot: [f64; 2],
    /// The fixed pivot of the block.
    #[serde(rename = "B")]
    pub block_pivot: [f64; 2],
    /// |AC|.
    #[serde(rename = "a")]
    pub crank: f64,
    /// The distance of B to the left of the coupler's line through C.
    pub offset: f64,
    /// P along the coupler's line, from C.
    pub coupler_x: f64,
    /// P to the left of that line.
    pub coupler_y: f64,
    /// 1: the block is ahead of C along the coupler.
    #[serde(rename = "t1")]
    #[schemars(with = "i64")]
    pub assembly: AssemblyMode,
}

impl InvertedSliderCrank {
    /// Builds a linkage from its parameters.
    ///
    /// # Errors
    /// [`LinkageError`] when a number is not finite or beyond [`MAX_MAGNITUDE`](super::MAX_MAGNITUDE), or a is not positive.
    pub fn new(parameters: InvertedSliderCrankParameters) -> Result<Self, LinkageError> {
        let p = &parameters;
        let ([ax, ay], [bx, by]) = (p.crank_pivot, p.block_pivot);
        let numbers = [
            ("A", ax),
            ("A", ay),
            ("B", bx),
            ("B", by),
            ("offset", p.offset),
            ("coupler_x", p.coupler_x),
            ("coupler_y", p.coupler_y),
        ];
        check(&numbers, &[("a", p.crank)])?;
        Ok(InvertedSliderCrank { parameters })
    }

    /// Builds a linkage from A, B, a, h, Z and t1.
    ///
    /// # Errors
    /// As [`InvertedSliderCrank::new`].
    pub fn from_parts(
        [crank_pivot, block_pivot]: [Complex; 2],
        crank: f64,
        offset: f64,
        coupler_offset: Complex,
        assembly: AssemblyMode,
    ) -> Result<Self, LinkageError> {
        InvertedSliderCrank::new(InvertedSliderCrankParameters {
            crank_pivot: xy(crank_pivot),
            block_pivot: xy(block_pivot),
            crank,
            offset,
            coupler_x: coupler_offset.re,
            coupler_y: coupler_offset.im,
            assembly,
        })
    }

    /// Returns the linkage with every length and coordinate multiplied by a factor.
    ///
    /// # Errors
    /// As [`InvertedSliderCrank::new`], if a length leaves the allowed range.
    pub fn scaled(&self, factor: f64) -> Result<Self, LinkageError> {
        let p = self.parameters;
        InvertedSliderCrank::new(InvertedSliderCrankParameters {
            crank_pivot: p.crank_pivot.map(|x| x * factor),
            block_pivot: p.block_pivot.map(|x| x * factor),
            crank: p.crank * factor,
            offset: p.offset * factor,
            coupler_x: p.coupler_x * factor,
            coupler_y: p.coupler_y * factor,
            ..p
        })
    }

    /// Returns the same linkage moved by the vector `by`.
    ///
    /// # Errors
    /// As [`InvertedSliderCrank::new`], if a coordinate leaves the allowed range.
    pub fn shifted(&self, by: Complex) -> Result<Self, LinkageError> {
        let mut parameters = self.parameters;
        parameters.crank_pivot = xy(point(parameters.crank_pivot) + by);
        parameters.block_pivot = xy(point(parameters.block_pivot) + by);
        InvertedSliderCrank::new(parameters)
    }

    /// Returns the parameters.
    pub fn parameters(&self) -> InvertedSliderCrankParameters {
        self.parameters
    }

    /// Returns B, the fixed pivot of the block.
    pub fn block_pivot(&self) -> Complex {
        point(self.parameters.block_pivot)
    }

    /// Returns h, the distance of B to the left of the coupler's line through C.
    pub fn offset(&self) -> f64 {
        self.parameters.offset
    }

    /// Returns g = |AB|, the length of the ground link.
    pub fn ground(&self) -> f64 {
        (self.block_pivot() - point(self.parameters.crank_pivot)).norm()
    }

    /// Returns arg(B - A), the direction of the ground line; 0 for coincident pivots.
    pub fn ground_angle(&self) -> f64 {
        let ground = self.block_pivot() - point(self.parameters.crank_pivot);
        if ground.norm_sqr() == 0.0 { 0.0 } else { ground.arg() }
    }

    /// Returns the ratio of the longer to the shorter of ground and crank; infinite for coincident pivots.
    pub fn link_ratio(&self) -> f64 {
        let (g, a) = (self.ground(), self.parameters.crank);
        g.max(a) / g.min(a)
    }

    /// Returns the largest distance between two joints of one body, P included: of |AB|, a and |CP|.
    pub fn longest(&self) -> f64 {
        let p = &self.parameters;
        self.ground().max(p.crank).max(Complex::new(p.coupler_x, p.coupler_y).norm())
    }
}

impl From<InvertedSliderCrank> for InvertedSliderCrankParameters {
    fn from(linkage: InvertedSliderCrank) -> Self {
        linkage.parameters
    }
}

impl TryFrom<InvertedSliderCrankParameters> for InvertedSliderCrank {
    type Error = LinkageError;
    fn try_from(parameters: InvertedSliderCrankParameters) -> Result<Self, LinkageError> {
        InvertedSliderCrank::new(parameters)
    }
}

impl std::fmt::Display for InvertedSliderCrank {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let p = &self.parameters;
        let ([ax, ay], [bx, by]) = (p.crank_pivot, p.block_pivot);
        let (a, h, x, y) = (p.crank, p.offset, p.coupler_x, p.coupler_y);
        let t1 = p.assembly.sign();
        write!(
            f,
            "A ({ax}, {ay})  B ({bx}, {by})  a {a}  offset {h}  coupler_x {x}  coupler_y {y}  t1 {t1:+}"
        )
    }
}
