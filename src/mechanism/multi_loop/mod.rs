//! Linkages of several loops, six-bars and eight-bars: a crank, and dyads that hang on it one after the other.
//!
//! Body 0 is the ground, 1 the crank; dyad j (counted from 0) adds body 2 + 2j, its link X-F, and body 3 + 2j, its link Y-F
//! ([`DyadChainKind`]). The first dyad is the coupler C-D and the follower B-D of a four-bar. A place on a body is given along and
//! across (to the left of) the line between two joints of it, from the first:
//!
//! | body | line |
//! |---|---|
//! | ground | the x axis of the plane |
//! | crank | A-C |
//! | link X-F | X-F |
//! | link Y-F | Y-F |
//!
//! ```text
//! F = X + V (x + i t h),  V = Y - X,  x = (|V|^2 + l1^2 - l2^2) / (2 |V|^2),  h^2 = l1^2/|V|^2 - x^2
//! ```
//!
//! t = +1 where F lies left of the line from X to Y (derived here; two circles meet). [`DyadChain`](super::DyadChain) is the same
//! linkage in the unknowns of a search, of which every value turns fully; here lengths are those of the links.
//!
//! | module | holds |
//! |---|---|
//! | [`conversion`] | a linkage as a general [`Chain`](super::Chain), and from a [`DyadChain`](super::DyadChain) |
//! | [`joints`] | the joints of a linkage and of each body, by name |
//! | [`kind`] | the linkage as a mechanism of any kind |
//! | [`keys`] | the keys of `[chain]` in files and records |
//! | [`lengths`] | the lengths that fix the shape of each body, and linkages with given ones |
//! | [`turn`] | whether the crank turns fully, and the transmission angles of all dyads |

pub mod conversion;
pub mod joints;
pub mod keys;
pub mod kind;
pub mod lengths;
pub mod turn;

pub use joints::{Body, NamedJoint};
pub use keys::{ChainKeys, NoMultiLoop};
pub use lengths::LinkLength;

use super::dyad_chain::kinds::{CRANK, DyadChainKind, GROUND, MAX_BODIES, MAX_DYADS};
use super::{AssemblyMode, Complex, FLAT_TOLERANCE, LinkageError, LinkageKind, MAX_MAGNITUDE, dot, xy};
use crate::numbers::arithmetic::sine::sin_cos;

/// A dyad of a linkage: two links that meet in a joint F.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkPair {
    /// The places of X and Y on the bodies that carry them.
    pub ends: [Complex; 2],
    /// |XF| and |YF|.
    pub lengths: [f64; 2],
    /// Plus: F lies left of the line from X to Y.
    pub side: AssemblyMode,
}

impl LinkPair {
    /// The dyad that a linkage of fewer dyads has in place of those that it lacks.
    const NONE: LinkPair =
        LinkPair { ends: [Complex::new(0.0, 0.0); 2], lengths: [0.0; 2], side: AssemblyMode::Plus };
}

/// A six-bar or an eight-bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MultiLoop {
    kind: DyadChainKind,
    crank_pivot: Complex,
    crank: f64,
    dyads: [LinkPair; MAX_DYADS],
    coupler_point: Complex,
}

/// The bodies of a linkage at one position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bodies {
    /// The first joint of each body's line.
    pub origins: [Complex; MAX_BODIES],
    /// The unit direction of its line.
    pub directions: [Complex; MAX_BODIES],
}

impl Bodies {
    /// Returns the place in the plane of a place on a body.
    pub fn place(&self, body: usize, at: Complex) -> Complex {
        self.origins[body] + self.directions[body] * at
    }
}

impl MultiLoop {
    /// Creates a linkage from the kind, A, the length of the crank, its dyads (X of the first is C, and its place is not read) and
    /// the place of P on the body that carries it.
    ///
    /// # Errors
    /// [`LinkageError`] if a number is beyond the range, or a length is not positive.
    pub fn new(
        kind: DyadChainKind,
        (crank_pivot, crank): (Complex, f64),
        dyads: &[LinkPair],
        coupler_point: Complex,
    ) -> Result<Self, LinkageError> {
        const ENDS: [[[&str; 2]; 2]; MAX_DYADS] = [
            [["Cx", "Cy"], ["Bx", "By"]],
            [["X2x", "X2y"], ["Y2x", "Y2y"]],
            [["X3x", "X3y"], ["Y3x", "Y3y"]],
        ];
        const LENGTHS: [[&str; 2]; MAX_DYADS] = [["b", "c"], ["X2F2", "Y2F2"], ["X3F3", "Y3F3"]];
        let finite = |key: &'static str, value: f64| match value.abs() < MAX_MAGNITUDE {
            true => Ok(()),
            false => Err(LinkageError::NotFinite { key, value }),
        };
        let length = |key: &'static str, value: f64| {
            finite(key, value)?;
            if value > 0.0 { Ok(()) } else { Err(LinkageError::LengthNotPositive { key, value }) }
        };
        finite("Ax", crank_pivot.re)?;
        finite("Ay", crank_pivot.im)?;
        length("a", crank)?;
        let mut all = [LinkPair::NONE; MAX_DYADS];
        for (j, dyad) in dyads.iter().take(kind.dyads()).enumerate() {
            let mut dyad = *dyad;
            if j == 0 {
                dyad.ends[0] = Complex::new(crank, 0.0);
            }
            for end in 0..2 {
                finite(ENDS[j][end][0], dyad.ends[end].re)?;
                finite(ENDS[j][end][1], dyad.ends[end].im)?;
                length(LENGTHS[j][end], dyad.lengths[end])?;
            }
            all[j] = dyad;
        }
        finite("Px", coupler_point.re)?;
        finite("Py", coupler_point.im)?;
        Ok(MultiLoop { kind, crank_pivot, crank, dyads: all, coupler_point })
    }

    /// Returns the kind of linkage: a six-bar, or an eight-bar.
    pub fn linkage_kind(&self) -> LinkageKind {
        if self.dyad_count() > 2 { LinkageKind::EightBar } else { LinkageKind::SixBar }
    }

    /// Returns the kind of chain: the bodies that carry the dyads and P.
    pub fn chain_kind(&self) -> DyadChainKind {
        self.kind
    }

    /// Returns the number of dyads: 2 of a six-bar, 3 of an eight-bar.
    pub fn dyad_count(&self) -> usize {
        self.kind.dyads()
    }

    /// Returns the dyads.
    pub fn dyads(&self) -> &[LinkPair] {
        &self.dyads[..self.kind.dyads()]
    }

    /// Returns A.
    pub fn crank_pivot(&self) -> Complex {
        self.crank_pivot
    }

    /// Returns B, the fixed pivot of the first dyad.
    pub fn follower_pivot(&self) -> Complex {
        self.dyads[0].ends[1]
    }

    /// Returns a = |AC|.
    pub fn crank(&self) -> f64 {
        self.crank
    }

    /// Returns the place of P on its body.
    pub fn coupler_point(&self) -> Complex {
        self.coupler_point
    }

    /// Returns the signs of the dyads' roots.
    pub fn signs(&self) -> Vec<AssemblyMode> {
        self.dyads().iter().map(|dyad| dyad.side).collect()
    }

    /// Returns the sign of the first dyad's root.
    pub fn assembly(&self) -> AssemblyMode {
        self.dyads[0].side
    }

    /// Returns the linkage with another sign of the first dyad's root.
    #[must_use]
    pub fn with_assembly(mut self, assembly: AssemblyMode) -> Self {
        self.dyads[0].side = assembly;
        self
    }

    /// Computes the bodies at a crank angle (radians from the x axis); `None` if a dyad does not close, or its ends are at one
    /// place.
    pub fn bodies(&self, crank_angle: f64) -> Option<Bodies> {
        let mut bodies = self.driven(crank_angle);
        for dyad in 0..self.kind.dyads() {
            self.assemble(&mut bodies, dyad)?;
        }
        Some(bodies)
    }

    /// Returns the ground and the crank at a crank angle.
    fn driven(&self, crank_angle: f64) -> Bodies {
        let (sin, cos) = sin_cos(crank_angle);
        let mut bodies = Bodies {
            origins: [Complex::new(0.0, 0.0); MAX_BODIES],
            directions: [Complex::new(1.0, 0.0); MAX_BODIES],
        };
        (bodies.origins[CRANK], bodies.directions[CRANK]) = (self.crank_pivot, Complex::new(cos, sin));
        bodies
    }

    /// Returns the places of X and Y of a dyad.
    fn ends(&self, bodies: &Bodies, dyad: usize) -> [Complex; 2] {
        let on = self.kind.anchors(dyad);
        [0, 1].map(|end| bodies.place(on[end], self.dyads[dyad].ends[end]))
    }

    /// Places the two links of a dyad; `None` if it does not close.
    fn assemble(&self, bodies: &mut Bodies, dyad: usize) -> Option<()> {
        let LinkPair { lengths: [l1, l2], side, .. } = self.dyads[dyad];
        let [x, y] = self.ends(bodies, dyad);
        let v = y - x;
        let apart_sq = dot(v, v);
        if apart_sq == 0.0 {
            return None;
        }
        let along = 0.5 + 0.5 * (l1 - l2) * (l1 + l2) / apart_sq;
        let across_sq = l1 * l1 / apart_sq - along * along;
        if across_sq < -FLAT_TOLERANCE {
            return None;
        }
        let joint = x + v * Complex::new(along, side.sign() * across_sq.max(0.0).sqrt());
        let first = 2 + 2 * dyad;
        (bodies.origins[first], bodies.directions[first]) = (x, (joint - x) / l1);
        (bodies.origins[first + 1], bodies.directions[first + 1]) = (y, (joint - y) / l2);
        Some(())
    }

    /// Computes P at a crank angle.
    pub fn point_at(&self, crank_angle: f64) -> Option<Complex> {
        Some(self.bodies(crank_angle)?.place(self.kind.traced(), self.coupler_point))
    }

    /// Returns the image p -> shift + turn p of the linkage, of its mirror image in the x axis if it is to be mirrored; |turn| = 1.
    ///
    /// # Errors
    /// If a coordinate leaves the allowed range.
    pub fn carried(&self, mirrors: bool, turn: Complex, shift: Complex) -> Result<Self, LinkageError> {
        let of_body = |z: Complex| if mirrors { z.conj() } else { z };
        let mut dyads = self.dyads;
        for (j, dyad) in dyads.iter_mut().enumerate().take(self.kind.dyads()) {
            for (end, body) in self.kind.anchors(j).into_iter().enumerate() {
                dyad.ends[end] = of_body(dyad.ends[end]);
                if body == GROUND {
                    dyad.ends[end] = shift + turn * dyad.ends[end];
                }
            }
            dyad.side = if mirrors { dyad.side.opposite() } else { dyad.side };
        }
        let pivot = shift + turn * of_body(self.crank_pivot);
        MultiLoop::new(self.kind, (pivot, self.crank), &dyads, of_body(self.coupler_point))
    }

    /// Returns the linkage with every length and coordinate multiplied by a factor.
    ///
    /// # Errors
    /// If a length leaves the allowed range.
    pub fn scaled(&self, factor: f64) -> Result<Self, LinkageError> {
        let scaled = |dyad: &LinkPair| LinkPair {
            ends: dyad.ends.map(|z| z * factor),
            lengths: dyad.lengths.map(|l| l * factor),
            side: dyad.side,
        };
        let dyads: Vec<LinkPair> = self.dyads().iter().map(scaled).collect();
        let crank = (self.crank_pivot * factor, self.crank * factor);
        MultiLoop::new(self.kind, crank, &dyads, self.coupler_point * factor)
    }

    /// Returns the linkage with other numbers, in the order of [`MultiLoop::numbers`]; `None` if they are those of none, or not as
    /// many.
    pub fn with_numbers(&self, numbers: &[f64]) -> Option<Self> {
        let mut left = numbers.iter().copied();
        let mut next = || left.next();
        let pivot = Complex::new(next()?, next()?);
        let crank = next()?;
        let mut dyads = self.dyads;
        for (j, dyad) in dyads.iter_mut().enumerate().take(self.kind.dyads()) {
            for end in usize::from(j == 0)..2 {
                dyad.ends[end] = Complex::new(next()?, next()?);
            }
            dyad.lengths = [next()?, next()?];
        }
        let point = Complex::new(next()?, next()?);
        MultiLoop::new(self.kind, (pivot, crank), &dyads, point).ok().filter(|_| next().is_none())
    }

    /// Returns its numbers, by which equals are ordered: A, a, the ends and lengths of each dyad, P.
    pub fn numbers(&self) -> Vec<f64> {
        let mut numbers = xy(self.crank_pivot).to_vec();
        numbers.push(self.crank);
        for (j, dyad) in self.dyads().iter().enumerate() {
            let from = usize::from(j == 0);
            numbers.extend(dyad.ends[from..].iter().flat_map(|z| xy(*z)));
            numbers.extend(dyad.lengths);
        }
        numbers.extend(xy(self.coupler_point));
        numbers
    }
}

impl std::fmt::Display for MultiLoop {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [ax, ay] = xy(self.crank_pivot);
        write!(f, "{}, A = ({ax}, {ay}), a = {}", self.kind.name(), self.crank)?;
        for (j, dyad) in self.dyads().iter().enumerate() {
            let [l1, l2] = dyad.lengths;
            write!(f, ", dyad {}: {l1}, {l2}", j + 1)?;
        }
        Ok(())
    }
}
