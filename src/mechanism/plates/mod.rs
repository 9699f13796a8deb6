//! The links as flat plates with holes at the joints, which can be cut out.
//!
//! A plate is the convex hull of its hole centres grown by a radius r: every point within r of the hull. The radius is
//! half a hole and the edge margin around it. The outline is made of straight segments and circular arcs of radius r
//! about the corners of the hull; once round it turns by 2 pi. With hull area H and perimeter L its area is H + L r +
//! pi r^2 and its perimeter L + 2 pi r (Steiner 1840).
//!
//! | link of a four-bar | holes | own frame: origin, x axis |
//! |---|---|---|
//! | ground | A, B | A, towards B |
//! | crank | A, C | A, towards C |
//! | follower | B, D | B, towards D |
//! | coupler | C, D, P | C, towards D |
//!
//! | link of a slider-crank | holes and slot | own frame: origin, x axis |
//! |---|---|---|
//! | ground | A, the rail as a slot | A, along the line |
//! | crank, coupler | as of a four-bar | |
//! | block | D, guide pins E and F | D, along the line |
//!
//! | link of an inverted slider-crank | holes and slot | own frame: origin, x axis |
//! |---|---|---|
//! | ground, crank | as of a four-bar | |
//! | coupler | C, P, a slot on its line | C, along the coupler |
//! | block | B, guide pins E and F | D, along the coupler |
//!
//! | link of a six-bar or an eight-bar | holes | own frame: origin, x axis |
//! |---|---|---|
//! | ground | all fixed pivots | A, towards B |
//! | crank | A, C, and the ends of dyads on it | A, towards C |
//! | coupler, follower, link5 to link8: the links X-F and Y-F of each dyad in turn | X or Y, F, the ends of dyads on it, P | X or Y, towards F |
//!
//! A slot counts in the hull as its two ends do. Lengths are in the unit of the linkage.
//!
//! | module | holds |
//! |---|---|
//! | `four_bar`, `slider_crank`, `inverted_slider_crank`, `multi_loop` | the plates of each kind, and bounds of their motion |
//! | `displacement` | bounds of the motion of six-bars and eight-bars |
//! | `guide` | the block of a slider and the slot that it runs in |
//! | `hull`, `outline`, `separation` | geometry of one plate, and of two |
//! | `bores`, `rims`, `shop` | diameters of holes and pins; the material around holes; the sizes that a linkage is built with |
//! | `moments` | area, centroid and second moment of an outline |
//! | `joint`, `kind`, `motion`, `parts` | joints and pins; what a kind gives; intervals of the motion; all parts of a linkage |

mod bores;
mod displacement;
mod four_bar;
mod guide;
mod hull;
mod inverted_slider_crank;
mod joint;
mod kind;
pub mod moments;
mod motion;
mod multi_loop;
mod outline;
pub(crate) mod parts;
mod rims;
mod separation;
pub mod shop;
mod slider_crank;
#[cfg(test)]
mod slider_tests;
#[cfg(test)]
mod tests;

pub use bores::Bores;
pub use guide::{Guide, Sizes};
pub(crate) use hull::hull as convex_hull;
pub use joint::{Joint, Pin};
pub use kind::Slot;
pub use motion::{Reach, Stretch};
pub use outline::Edge;
pub use parts::{Parts, Position};
pub use rims::{Beside, Rim};
pub use shop::Shop;

use crate::mechanism::{Complex, CrankLinkage, FourBar, LoopJoints, bounding_box};
use std::f64::consts::PI;

/// Distance, as a part of the plate's size (hull and radius), below which two holes coincide and a corner of the hull
/// is left out: far below what any machine cuts.
pub const COINCIDENT: f64 = 1e-9;

/// A link of a linkage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Link {
    /// The fixed link from A to B.
    Ground,
    /// The driving link from A to C.
    Crank,
    /// The link with C, D and the coupler point P.
    Coupler,
    /// The link from B to D of a four-bar.
    Follower,
    /// The block of a slider.
    Block,
    /// The link X-F of the second dyad of a six-bar or an eight-bar.
    Fifth,
    /// The link Y-F of the second dyad.
    Sixth,
    /// The link X-F of the third dyad of an eight-bar.
    Seventh,
    /// The link Y-F of the third dyad.
    Eighth,
}

impl Link {
    /// All four of a four-bar, in the order of drawings and lists.
    pub const ALL: [Link; 4] = [Link::Ground, Link::Crank, Link::Coupler, Link::Follower];

    /// Those of a six-bar or an eight-bar by the number of their body ([`multi_loop`](crate::mechanism::multi_loop)).
    pub const OF_BODIES: [Link; 8] = [
        Link::Ground,
        Link::Crank,
        Link::Coupler,
        Link::Follower,
        Link::Fifth,
        Link::Sixth,
        Link::Seventh,
        Link::Eighth,
    ];

    /// Returns the name of the link in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Link::Ground => "ground",
            Link::Crank => "crank",
            Link::Coupler => "coupler",
            Link::Follower => "follower",
            Link::Block => "block",
            Link::Fifth => "link5",
            Link::Sixth => "link6",
            Link::Seventh => "link7",
            Link::Eighth => "link8",
        }
    }

    /// Returns the name in a sentence: with an article, unless it has a number.
    pub fn in_words(self) -> String {
        if self.place() < 4 { format!("the {}", self.name()) } else { self.name().to_owned() }
    }

    /// Returns the place of the link among all of its linkage, the ground first: a block has that of a follower.
    pub fn place(self) -> usize {
        match self {
            Link::Ground => 0,
            Link::Crank => 1,
            Link::Coupler => 2,
            Link::Follower | Link::Block => 3,
            Link::Fifth => 4,
            Link::Sixth => 5,
            Link::Seventh => 6,
            Link::Eighth => 7,
        }
    }
}

/// The centre of a hole in the plate's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hole {
    /// The joint: E or F of a guide pin.
    pub joint: Joint,
    /// Position of the centre.
    pub at: Complex,
}

/// Position and direction of a plate: its own frame in the plane, z -> origin + direction z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Position of the first hole, the origin of the plate's own frame.
    pub origin: Complex,
    /// Unit vector along the x axis of the plate's own frame.
    pub direction: Complex,
}

impl Placement {
    /// The plane's own frame.
    pub const HOME: Placement =
        Placement { origin: Complex::new(0.0, 0.0), direction: Complex::new(1.0, 0.0) };

    /// Returns the frame with its origin at `from` and its x axis towards `to`; along the plane's x axis if both are
    /// one point.
    pub fn between(from: Complex, to: Complex) -> Self {
        Placement::along(from, to - from)
    }

    /// Returns the frame with its origin at `from` and its x axis along a vector; along the plane's x axis if that is 0.
    pub fn along(from: Complex, vector: Complex) -> Self {
        let length = vector.norm();
        let direction = if length > 0.0 { vector / length } else { Complex::new(1.0, 0.0) };
        Placement { origin: from, direction }
    }

    /// Returns the point of the plane for a point of the plate's own frame.
    pub fn of(&self, own: Complex) -> Complex {
        self.origin + self.direction * own
    }
}

/// A link's plate: every point within `radius` of the convex hull of the hole centres and the slot's ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// The link.
    pub link: Link,
    /// The hole centres in the plate's own frame.
    pub holes: Vec<Hole>,
    /// The slot, of a plate that guides a block.
    pub slot: Option<Slot>,
    /// Distance that the plate reaches beyond the hull.
    pub radius: f64,
    /// The points whose hull it is.
    points: Vec<Complex>,
    /// The corners of the hull, counter-clockwise; one or two if the hull is a point or a line.
    corners: Vec<Complex>,
}

impl Plate {
    /// Builds the plate of one link of a four-bar.
    ///
    /// ```
    /// use linkwright::{AssemblyMode, CouplerSide, FourBar, NaturalCoordinates};
    /// use linkwright::internals::mechanism::plates::{Link, Plate};
    /// let linkage = FourBar::new(NaturalCoordinates {
    ///     crank_pivot: [0.0, 0.0], follower_pivot: [40.0, 10.0],
    ///     crank: 20.0, coupler: 50.0, follower: 50.0, crank_side: 50.0, follower_side: 50.0,
    ///     assembly: AssemblyMode::Plus, side: CouplerSide::Plus,
    /// })?;
    /// let crank = Plate::of(&linkage, Link::Crank, 5.0);
    /// assert!((crank.perimeter() - (2.0 * 20.0 + 10.0 * std::f64::consts::PI)).abs() < 1e-12);
    /// # Ok::<(), linkwright::LinkageError>(())
    /// ```
    pub fn of(linkage: &FourBar, link: Link, radius: f64) -> Self {
        Plate::shaped(link, kind::Kind::shape(linkage, link, None), radius)
    }

    /// Builds the plates of all four links of a four-bar, in the order of [`Link::ALL`].
    pub fn all(linkage: &FourBar, radius: f64) -> [Plate; 4] {
        Link::ALL.map(|link| Plate::of(linkage, link, radius))
    }

    /// Builds a plate with holes anywhere (at least one); negative radii count as 0.
    pub fn new(link: Link, holes: Vec<Hole>, radius: f64) -> Self {
        let centres: Vec<Complex> = holes.iter().map(|hole| hole.at).collect();
        Plate::around(link, (holes, None), centres, radius)
    }

    /// Builds the plate of a link with its holes and its slot.
    fn shaped(link: Link, shape: kind::Shape, radius: f64) -> Self {
        let holes: Vec<Hole> = shape.holes.into_iter().map(|(joint, at)| Hole { joint, at }).collect();
        let ends = shape.slot.iter().flat_map(|slot| slot.ends);
        let points = holes.iter().map(|hole| hole.at).chain(ends).chain(shape.corners).collect();
        Plate::around(link, (holes, shape.slot), points, radius)
    }

    /// Builds a plate around the hull of points.
    fn around(
        link: Link,
        (holes, slot): (Vec<Hole>, Option<Slot>),
        points: Vec<Complex>,
        radius: f64,
    ) -> Self {
        let radius = radius.max(0.0);
        let corners = hull::hull(&points, COINCIDENT * (hull::extent(&points) + radius));
        Plate { link, holes, slot, radius, points, corners }
    }

    /// Returns the same plate with another radius: a tool that cuts away half its kerf needs a plate grown by it.
    #[must_use]
    pub fn with_radius(&self, radius: f64) -> Self {
        Plate::around(self.link, (self.holes.clone(), self.slot), self.points.clone(), radius)
    }

    /// Computes the closed outline, counter-clockwise: each edge starts exactly where the one before ends.
    pub fn outline(&self) -> Vec<Edge> {
        outline::outline(&self.corners, self.radius)
    }

    /// Computes the closed outline of the slot for its width, counter-clockwise; none without a slot.
    pub fn slot_outline(&self, width: f64) -> Vec<Edge> {
        self.slot.map_or(Vec::new(), |slot| outline::outline(&slot.ends, 0.5 * width))
    }

    /// Computes the distance of a convex polygon (corners counter-clockwise, in the plate's own frame) from the centre
    /// line of the slot; infinite without a slot.
    pub fn distance_from_slot(&self, polygon: &[Complex]) -> f64 {
        self.slot.map_or(f64::INFINITY, |slot| separation::separation(polygon, &slot.ends))
    }

    /// Returns the largest distance of a point of the hull from the origin of the plate's own frame.
    pub fn farthest(&self) -> f64 {
        self.corners.iter().map(|corner| corner.norm()).fold(0.0, f64::max)
    }

    /// Computes the area of the whole plate, with the area of its holes included.
    pub fn area(&self) -> f64 {
        hull::area(&self.corners) + hull::perimeter(&self.corners) * self.radius + PI * self.radius.powi(2)
    }

    /// Computes the length of the outline.
    pub fn perimeter(&self) -> f64 {
        hull::perimeter(&self.corners) + 2.0 * PI * self.radius
    }

    /// Returns the lower left and upper right corner of the plate's bounding box in its own frame.
    pub fn bounds(&self) -> [Complex; 2] {
        let reach = Complex::new(self.radius, self.radius);
        let [low, high] = bounding_box(self.corners.iter().copied());
        [low - reach, high + reach]
    }

    /// Returns the distinct holes: the names of coincident holes together, with the position of the first.
    pub fn distinct_holes(&self) -> Vec<(String, Complex)> {
        let centres: Vec<Complex> = self.holes.iter().map(|hole| hole.at).collect();
        let near = COINCIDENT * (hull::extent(&centres) + self.radius);
        let mut distinct: Vec<(String, Complex)> = Vec::new();
        for hole in &self.holes {
            match distinct.iter_mut().find(|(_, at)| (*at - hole.at).norm() <= near) {
                Some((names, _)) => names.push_str(hole.joint.name()),
                None => distinct.push((hole.joint.name().to_owned(), hole.at)),
            }
        }
        distinct
    }

    /// Returns the placement of the plate at a position of the linkage.
    pub fn placement(&self, linkage: impl Into<CrankLinkage>, joints: impl Into<LoopJoints>) -> Placement {
        kind::plated(&linkage.into()).placement(self.link, &joints.into())
    }

    /// Computes the signed distance between two placed plates, below zero if they overlap (then its size is the least
    /// shift after which they only touch).
    pub fn separation(&self, at: &Placement, other: &Plate, other_at: &Placement) -> f64 {
        let placed = |plate: &Plate, at: &Placement| -> Vec<Complex> {
            plate.corners.iter().map(|corner| at.of(*corner)).collect()
        };
        separation::separation(&placed(self, at), &placed(other, other_at)) - (self.radius + other.radius)
    }

    /// Computes the signed distance of a point of the plane from the placed plate, below zero inside.
    pub fn distance(&self, at: &Placement, to: Complex) -> f64 {
        let own = (to - at.origin) * at.direction.conj();
        separation::separation(&self.corners, &[own]) - self.radius
    }
}
