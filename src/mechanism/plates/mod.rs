//! The links as flat plates with holes at the joints, which can be cut out.
//!
//! A plate is the convex hull of its hole centres grown by a radius r: every point within r of the hull. The radius is
//! half a hole and the edge margin around it. The outline is made of straight segments and circular arcs of radius r
//! about the corners of the hull; once round it turns by 2 pi. With hull area H and perimeter L its area is H + L r +
//! pi r^2 and its perimeter L + 2 pi r (Steiner 1840).
//!
//! | link | holes | own frame: origin, x axis |
//! |---|---|---|
//! | ground | A, B | A, towards B |
//! | crank | A, C | A, towards C |
//! | follower | B, D | B, towards D |
//! | coupler | C, D, P | C, towards D |
//!
//! Lengths are in the unit of the linkage.

mod hull;
mod outline;
mod separation;
#[cfg(test)]
mod tests;

pub use outline::Edge;

use crate::mechanism::{Complex, FourBar, Joints, bounding_box, point};
use std::f64::consts::PI;

/// Distance, as a part of the plate's size (hull and radius), below which two holes coincide and a corner of the hull
/// is left out: far below what any machine cuts.
pub const COINCIDENT: f64 = 1e-9;

/// A link of a four-bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Link {
    /// The fixed link from A to B.
    Ground,
    /// The driving link from A to C.
    Crank,
    /// The link with C, D and the coupler point P.
    Coupler,
    /// The link from B to D.
    Follower,
}

impl Link {
    /// All four, in the order of drawings and lists.
    pub const ALL: [Link; 4] = [Link::Ground, Link::Crank, Link::Coupler, Link::Follower];

    /// Returns the name of the link in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Link::Ground => "ground",
            Link::Crank => "crank",
            Link::Coupler => "coupler",
            Link::Follower => "follower",
        }
    }
}

/// The centre of a hole in the plate's own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hole {
    /// Letter of the joint: A, B, C, D or P.
    pub name: char,
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
        let along = to - from;
        let length = along.norm();
        let direction = if length > 0.0 { along / length } else { Complex::new(1.0, 0.0) };
        Placement { origin: from, direction }
    }

    /// Returns the point of the plane for a point of the plate's own frame.
    pub fn of(&self, own: Complex) -> Complex {
        self.origin + self.direction * own
    }
}

/// A link's plate: every point within `radius` of the convex hull of the hole centres.
#[derive(Clone, Debug, PartialEq)]
pub struct Plate {
    /// The link.
    pub link: Link,
    /// The hole centres in the plate's own frame.
    pub holes: Vec<Hole>,
    /// Distance that the plate reaches beyond the hull.
    pub radius: f64,
    /// The corners of the hull, counter-clockwise; one or two if the hull is a point or a line.
    corners: Vec<Complex>,
}

impl Plate {
    /// Builds the plate of one link of a linkage.
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
        let [ground, crank, coupler, follower] = linkage.links();
        let x = |along: f64| point([along, 0.0]);
        let holes = match link {
            Link::Ground => vec![('A', x(0.0)), ('B', x(ground))],
            Link::Crank => vec![('A', x(0.0)), ('C', x(crank))],
            Link::Coupler => vec![('C', x(0.0)), ('D', x(coupler)), ('P', linkage.coupler_offset())],
            Link::Follower => vec![('B', x(0.0)), ('D', x(follower))],
        };
        let holes = holes.into_iter().map(|(name, at)| Hole { name, at }).collect();
        Plate::new(link, holes, radius)
    }

    /// Builds the plates of all four links, in the order of [`Link::ALL`].
    pub fn all(linkage: &FourBar, radius: f64) -> [Plate; 4] {
        Link::ALL.map(|link| Plate::of(linkage, link, radius))
    }

    /// Builds a plate with holes anywhere (at least one); negative radii count as 0.
    pub fn new(link: Link, holes: Vec<Hole>, radius: f64) -> Self {
        let radius = radius.max(0.0);
        let centres: Vec<Complex> = holes.iter().map(|hole| hole.at).collect();
        let corners = hull::hull(&centres, COINCIDENT * (hull::extent(&centres) + radius));
        Plate { link, holes, radius, corners }
    }

    /// Returns the same plate with another radius: a tool that cuts away half its kerf needs a plate grown by it.
    #[must_use]
    pub fn with_radius(&self, radius: f64) -> Self {
        Plate::new(self.link, self.holes.clone(), radius)
    }

    /// Computes the closed outline, counter-clockwise: each edge starts exactly where the one before ends.
    pub fn outline(&self) -> Vec<Edge> {
        outline::outline(&self.corners, self.radius)
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

    /// Returns the distinct holes: the letters of coincident holes together, with the position of the first.
    pub fn distinct_holes(&self) -> Vec<(String, Complex)> {
        let centres: Vec<Complex> = self.holes.iter().map(|hole| hole.at).collect();
        let near = COINCIDENT * (hull::extent(&centres) + self.radius);
        let mut distinct: Vec<(String, Complex)> = Vec::new();
        for hole in &self.holes {
            match distinct.iter_mut().find(|(_, at)| (*at - hole.at).norm() <= near) {
                Some((names, _)) => names.push(hole.name),
                None => distinct.push((hole.name.to_string(), hole.at)),
            }
        }
        distinct
    }

    /// Returns the placement of the plate at a position of the linkage.
    pub fn placement(&self, linkage: &FourBar, joints: &Joints) -> Placement {
        let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
        match self.link {
            Link::Ground => Placement::between(a, b),
            Link::Crank => Placement::between(a, joints.crank_pin),
            Link::Coupler => Placement::between(joints.crank_pin, joints.follower_pin),
            Link::Follower => Placement::between(b, joints.follower_pin),
        }
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
