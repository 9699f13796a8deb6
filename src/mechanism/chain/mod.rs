//! Chains: compound mechanisms of a driven crank and stages, each attached to points that are already known, with the
//! position in closed form.
//!
//! Equation 19 of N. N. Romero Nunez (2016) gives C from the crank angle, then D as an intersection of two circles,
//! then P on the link C-D. A compound mechanism repeats the last two steps, stage by stage: Watt's and Stephenson's
//! six-bars, Jansen's leg, slider-cranks, quick-returns. Each stage makes one point N from points that are known:
//!
//! ```text
//! crank    C = A + a e^{i phi}                                                 (equation 10)
//! dyad     N = p + V (u + i t sqrt k),  V = q - p,  u, k from |V|, |pN|, |qN|   (equations 12 to 15)
//! point    N = p + z (q - p)            p, q on one link, z constant           (equation 18)
//! slider   N = O + u (<p - O, u> + t sqrt(r^2 - h^2)),  h = u x (p - O)        link r from p, line O + x u
//! guide    N = p + w u,  u = (q - p)/(x + i f),  x = t sqrt(|q - p|^2 - f^2)   w, f constant
//! ```
//!
//! A guide is a link that turns about p while a block hinged at q slides along it, at the distance f to the
//! left of the line through p: the rocker of a quick-return. The line of a slider is fixed or lies on a link.
//! t = +1 or -1 is the assembly of a stage. Every point that a stage makes may carry further stages; so may
//! any point rigidly attached to a link. A mechanism that cannot be built in this order (an Assur group of a higher
//! class, such as Stephenson's six-bar driven at its floating dyad) is no chain.
//!
//! Velocities and accelerations are in [`motion`], whole cycles in [`cycle`]; [`kind`] is the chain as a mechanism of any kind, and
//! `structure` has its bodies and pairs.

mod assembly;
mod builder;
pub mod cycle;
mod error;
pub mod kind;
pub mod motion;
mod structure;

pub use builder::{ChainBuilder, MAX_POINT_NAME, MAX_STAGES};
pub use cycle::{ChainArc, ChainInput};
pub use error::{ChainError, ChainFault, ChainPlace};
pub use motion::Motion;

use super::four_bar::position::{Meeting, meeting};
use super::{AssemblyMode, Complex, FLAT_TOLERANCE, cross, dot, turned};
use crate::numbers::arithmetic::sine::sin_cos;

/// Distance within which two points coincide, in roundings of the largest coordinate or length.
const COINCIDENT_ROUNDINGS: f64 = 16.0;

/// Identifier of a point of a chain, from [`Chain::point_id`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PointId(pub(super) usize);

impl PointId {
    /// Returns the index of the point in [`Chain::names`]: pivots, the crank's joint, then one point a stage.
    pub fn index(self) -> usize {
        self.0
    }
}

/// A stage of a chain, which makes one point; lengths in the unit of the file, angles in radians.
#[derive(Clone, Debug, PartialEq)]
pub enum Stage {
    /// Two links that meet in a new joint.
    Dyad {
        /// The new joint N.
        joint: String,
        /// The points p and q to which the links are attached.
        from: [String; 2],
        /// The link lengths |pN| and |qN|.
        lengths: [f64; 2],
        /// Plus: N lies left of the line from p to q.
        side: AssemblyMode,
    },
    /// A point rigidly attached to a link.
    Point {
        /// The new point N.
        name: String,
        /// Two points p and q of that link.
        on: [String; 2],
        /// The position of N on the link.
        at: Attachment,
    },
    /// A link whose end slides along a line.
    Slider {
        /// The new joint N.
        joint: String,
        /// The point p to which the link is attached.
        from: String,
        /// The link length r = |pN|.
        length: f64,
        /// The line that N keeps to.
        line: SliderLine,
        /// Plus: of the two places on the line, the one further along it.
        side: AssemblyMode,
    },
    /// A link that turns about a point while a block on another point slides along it.
    Guide {
        /// The new joint N on this link.
        joint: String,
        /// The point p that the link turns about.
        pivot: String,
        /// The point q of the block.
        block: String,
        /// w, the position of N along and across the guide, from p.
        at: [f64; 2],
        /// f, the distance of the block to the left of the line through p.
        offset: f64,
        /// Plus: the block is ahead of p along the guide.
        side: AssemblyMode,
    },
}

impl Stage {
    /// Returns the name of the point that the stage makes.
    pub fn joint(&self) -> &str {
        match self {
            Stage::Dyad { joint, .. } | Stage::Slider { joint, .. } | Stage::Guide { joint, .. } => joint,
            Stage::Point { name, .. } => name,
        }
    }
}

/// Position of a point on its link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Attachment {
    /// Lengths from p along the line from p to q and across it (left is positive).
    Offset([f64; 2]),
    /// Distances |pN|, |qN| and the side of the line from p to q (Romero, equations 16 and 17).
    Distances([f64; 2], super::CouplerSide),
}

/// The line of a slider.
#[derive(Clone, Debug, PartialEq)]
pub enum SliderLine {
    /// Through a fixed point in a fixed direction, radians from the x axis.
    Fixed {
        /// A point of the line.
        through: [f64; 2],
        /// The direction of the line.
        angle: f64,
    },
    /// On a link, parallel to the line from p to q, `offset` to its left.
    OnLink {
        /// p and q, two points of that link.
        along: [String; 2],
        /// Distance of the slider's line to the left of the line from p to q.
        offset: f64,
    },
}

/// A chain with its names resolved: see [`ChainBuilder`].
///
/// ```
/// use linkwright::{AssemblyMode, ChainBuilder};
/// // An in-line slider-crank, 3-4-5: crank 3 upright, rod 5, the slider is 4 ahead.
/// let chain = ChainBuilder::new()
///     .pivot("A", [0.0, 0.0])
///     .crank("A", "B", 3.0)
///     .slider("C", "B", 5.0, [0.0, 0.0], 0.0, AssemblyMode::Plus)
///     .build()?;
/// let mut pose = chain.pose();
/// assert!(chain.position(90f64.to_radians(), &mut pose).is_closed());
/// assert!((pose.point(chain.trace()).unwrap().re - 4.0).abs() < 1e-14);
/// # Ok::<(), Box<linkwright::internals::mechanism::chain::ChainError>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    pub(super) names: Vec<String>,
    pub(super) pivots: Vec<Complex>,
    pub(super) crank_pivot: usize,
    pub(super) crank: f64,
    pub(super) steps: Vec<Step>,
    pub(super) trace: usize,
    pub(super) links: Vec<Vec<PointId>>,
    /// The places of the points of each link in a frame of its own; of the ground, in the plane.
    pub(super) places: Vec<Vec<Complex>>,
    /// |V|^2 at and below which two points coincide.
    pub(super) coincident_sq: f64,
    pub(super) source: ChainBuilder,
}

/// A stage as the coefficients of its equations; p, q and so on are indices into the list of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Step {
    Dyad { p: usize, q: usize, radius_sq: f64, half_difference: f64, sine_per_cross: f64, t: f64 },
    Point { p: usize, q: usize, z: Complex },
    Slider { p: usize, length_sq: f64, line: Line, t: f64 },
    Guide { p: usize, q: usize, w: Complex, offset: f64, t: f64 },
}

/// The line O + x u of a slider, fixed or on the link through p and q.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Line {
    Fixed { origin: Complex, direction: Complex },
    OnLink { p: usize, q: usize, per_length: f64, offset: f64 },
}

/// Result of a position or motion analysis of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Every point is known.
    Closed,
    /// The stage (counted from 0) cannot be assembled at this crank angle.
    Open {
        /// Index of the stage, counted from 0.
        stage: usize,
    },
    /// The stage has no definite answer: no position if its two points coincide, no velocity at a toggle.
    Singular {
        /// Index of the stage, counted from 0.
        stage: usize,
    },
    /// The crank angle, its speed or its acceleration is NaN, infinite or beyond
    /// [`MAX_MAGNITUDE`](super::MAX_MAGNITUDE).
    InputNotUsable,
}

impl Outcome {
    /// Returns whether every point is known.
    pub fn is_closed(self) -> bool {
        self == Outcome::Closed
    }

    /// Returns the stage that has no answer, if there is one.
    pub fn stage(self) -> Option<usize> {
        match self {
            Outcome::Open { stage } | Outcome::Singular { stage } => Some(stage),
            Outcome::Closed | Outcome::InputNotUsable => None,
        }
    }
}

/// Buffer for the points of one position, from [`Chain::pose`].
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    pub(super) points: Vec<Complex>,
    /// Number of known points.
    pub(super) known: usize,
}

impl Pose {
    /// Returns the position of a point; `None` for points of and after a stage that has none.
    pub fn point(&self, id: PointId) -> Option<Complex> {
        self.known().get(id.0).copied()
    }

    /// Returns the points that are known, in the order of [`Chain::names`].
    pub fn known(&self) -> &[Complex] {
        &self.points[..self.known]
    }
}

impl Chain {
    /// Allocates a buffer for a position.
    pub fn pose(&self) -> Pose {
        let mut points = vec![Complex::new(0.0, 0.0); self.names.len()];
        points[..self.pivots.len()].copy_from_slice(&self.pivots);
        Pose { points, known: self.pivots.len() }
    }

    /// Returns the names of the points: pivots, the crank's joint, then one a stage.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the point with the given name.
    pub fn point_id(&self, name: &str) -> Option<PointId> {
        self.names.iter().position(|n| n == name).map(PointId)
    }

    /// Returns the traced point: the one that was named, or the last that was made.
    pub fn trace(&self) -> PointId {
        PointId(self.trace)
    }

    /// Returns the point that a stage makes; `None` beyond the last stage.
    pub fn joint_of(&self, stage: usize) -> Option<PointId> {
        (stage < self.steps.len()).then_some(PointId(self.pivots.len() + 1 + stage))
    }

    /// Returns the number of stages that follow the crank.
    pub fn stages(&self) -> usize {
        self.steps.len()
    }

    /// Returns the links, each as the points that are rigidly attached to it; the first is the ground, the second the
    /// crank.
    pub fn links(&self) -> &[Vec<PointId>] {
        &self.links
    }

    /// Returns the builder from which the chain was made.
    pub fn source(&self) -> &ChainBuilder {
        &self.source
    }

    /// Computes the position at the crank angle `crank_angle` (radians from the x axis, counter-clockwise), in closed
    /// form, stage by stage as in the [module's](self) equations. Allocates nothing.
    ///
    /// Open if k (dyad), r^2 - h^2 (slider) or |V|^2 - f^2 (guide) is negative beyond [`FLAT_TOLERANCE`]; singular if
    /// the two points of a dyad with equal lengths, or pivot and block of a guide without offset, coincide within
    /// rounding: every direction closes there. A toggle is a position like others.
    ///
    /// # Panics
    /// When `pose` is of a chain with another number of points.
    #[inline]
    pub fn position(&self, crank_angle: f64, pose: &mut Pose) -> Outcome {
        let (sin, cos) = sin_cos(crank_angle);
        self.position_toward(Complex::new(cos, sin), pose)
    }

    /// Computes the position as [`Chain::position`] does from e^{i phi}, for tabulated cosines and sines.
    ///
    /// # Panics
    /// When `pose` is of a chain with another number of points.
    pub fn position_toward(&self, crank: Complex, pose: &mut Pose) -> Outcome {
        assert_eq!(pose.points.len(), self.names.len(), "the pose is of another chain");
        let fixed = self.pivots.len();
        let points = &mut pose.points[..];
        points[..fixed].copy_from_slice(&self.pivots);
        pose.known = fixed;
        if !(crank.re.is_finite() && crank.im.is_finite()) {
            return Outcome::InputNotUsable;
        }
        points[fixed] = points[self.crank_pivot] + crank * self.crank;
        pose.known = points.len();
        for (stage, step) in self.steps.iter().enumerate() {
            let made = self.place(step, points);
            match made {
                Ok(n) if n.re.is_finite() && n.im.is_finite() => points[fixed + 1 + stage] = n,
                other => {
                    pose.known = fixed + 1 + stage;
                    return match other {
                        Err(Stuck::Singular) => Outcome::Singular { stage },
                        Ok(_) | Err(Stuck::Open) => Outcome::Open { stage },
                    };
                }
            }
        }
        Outcome::Closed
    }

    /// Computes the point of one stage.
    #[inline(always)]
    fn place(&self, step: &Step, points: &[Complex]) -> Result<Complex, Stuck> {
        match *step {
            Step::Dyad { p, q, radius_sq, half_difference, t, .. } => {
                let (c, v) = (points[p], points[q] - points[p]);
                let Meeting { u, root, gap } = meeting([v.re, v.im], radius_sq, half_difference);
                if dot(v, v) <= self.coincident_sq {
                    return Err(if half_difference == 0.0 { Stuck::Singular } else { Stuck::Open });
                }
                closes(gap)?;
                let root = t * root;
                Ok(Complex::new(c.re + (v.re * u - v.im * root), c.im + (v.im * u + v.re * root)))
            }
            Step::Point { p, q, z } => Ok(points[p] + z * (points[q] - points[p])),
            Step::Slider { p, length_sq, line, t } => {
                let (origin, u) = line.place(points);
                let v = points[p] - origin;
                let across = cross(u, v);
                let half_chord_sq = length_sq - across * across;
                closes(half_chord_sq + FLAT_TOLERANCE * length_sq)?;
                Ok(origin + u * (dot(u, v) + t * half_chord_sq.max(0.0).sqrt()))
            }
            Step::Guide { p, q, w, offset, t } => {
                let v = points[q] - points[p];
                Ok(points[p] + w * guide(v, offset, t, self.coincident_sq)?.1)
            }
        }
    }
}

/// The reason why a stage has no position.
#[derive(Clone, Copy)]
pub(super) enum Stuck {
    Open,
    Singular,
}

/// Returns `Ok` if a stage closes, that is, if its gap is at least zero. NaN is open.
#[inline(always)]
fn closes(gap: f64) -> Result<(), Stuck> {
    if gap >= 0.0 { Ok(()) } else { Err(Stuck::Open) }
}

/// Computes x and u with V = u (x + i f): the distance of the block along its guide, and the guide's direction.
#[inline(always)]
pub(super) fn guide(v: Complex, offset: f64, t: f64, coincident_sq: f64) -> Result<(f64, Complex), Stuck> {
    let distance_sq = dot(v, v);
    if distance_sq <= coincident_sq {
        return Err(if offset * offset <= coincident_sq { Stuck::Singular } else { Stuck::Open });
    }
    let along_sq = distance_sq - offset * offset;
    closes(along_sq + FLAT_TOLERANCE * distance_sq)?;
    let along = t * along_sq.max(0.0).sqrt();
    let u = v * Complex::new(along, -offset);
    Ok((along, u / u.norm_sqr().sqrt()))
}

impl Line {
    /// Returns O and u.
    #[inline(always)]
    pub(super) fn place(&self, points: &[Complex]) -> (Complex, Complex) {
        match *self {
            Line::Fixed { origin, direction } => (origin, direction),
            Line::OnLink { p, q, per_length, offset } => {
                let u = (points[q] - points[p]) * per_length;
                (points[p] + turned(u) * offset, u)
            }
        }
    }
}

/// Returns the |V|^2 at and below which two points of a mechanism of this scale coincide.
pub(in crate::mechanism) fn coincident_sq(scale: f64) -> f64 {
    let nearest = COINCIDENT_ROUNDINGS * f64::EPSILON * scale;
    nearest * nearest
}
