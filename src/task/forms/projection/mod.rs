//! Variable projection for prescribed timing (the reduced form): the linear parameters are solved for inside.
//!
//! With the ratios p = a/g, q = b/g, r = c/g, the crank's direction e_j measured from the ground line and
//! G = B - A, the joints of a linkage of ground 1 on the x axis are ([`super::linear_fit`])
//!
//! ```text
//! w = 1 - p e;  f2 = |w|^2;  sigma = (q^2 - r^2 + f2)/2;  H = sqrt(q^2 f2 - sigma^2)
//! q u = w (sigma + i t H)/f2            u: unit direction of the coupler, t = t1
//! P   = A + K e + Z u                   K = p G;  Z: the coupler point in the frame of the coupler, turned by G
//! ```
//!
//! A, K and Z enter linearly. For given p, q, r and (at most) one angle the best of them follow from linear least
//! squares, and the reduced cost is a function of three or four unknowns (Golub & Pereyra 1973):
//!
//! | crank angles | angle | K |
//! |---|---|---|
//! | increments only (offset free) | phi_0, the first from the ground line | complex; or as below |
//! | from the ground line | none | complex; or as below |
//! | from the x axis | theta = arg G, unless the design fixes it | kappa e^{i theta}, kappa > 0 |
//!
//! If the design fixes the ground's direction, K = kappa e^{i theta} in every row; if it fixes the length as well, or
//! both pivots, K is known. A is eliminated by centring; if the design fixes it, the points are measured from it; if it
//! fixes B alone, they are measured from B and the column is e - 1/p. A free offset with a ground of given length and
//! free direction would need a second angle: it has no reduced form here.
//!
//! Limits of the lengths are kept by the linear part: |K| is the crank's length a, and with the ratios it gives g, b
//! and c, so that together they give the interval [max(a_lo, p g_lo, p b_lo/q, p c_lo/r), min(..)] for |K|. The cost of
//! a K other than the unconstrained optimum K_0 is greater by N |K - K_0|^2 with one N for all directions, so that the
//! best K in the interval is K_0 with its length clamped to it. If no length satisfies all limits the geometric mean of
//! the two ends is taken; the physical fit has to follow. Pivot boxes and limits of the coupler point are left to it as
//! well.
//!
//! In a motion the error of the body's angle adds to the cost of target j, with u_j seen from the ground line,
//!
//! ```text
//! w_j (W (theta_j - arg u_j - beta))^2,    beta = the weighted mean of theta_j - arg u_j
//! ```
//!
//! W the length that a radian counts like. The frame beta is linear too; it takes up the direction of G.
//!
//! Weights are normalised to the sum 1 inside; every cost returned is the weighted sum of squares.

mod fit;
mod screen;

pub use fit::{ProjectedFit, Solution};
pub use screen::Batch;

use super::design_space::Shape;
use super::linear_fit::KnownPivots;
use crate::mechanism::{Complex, CouplerSide};
use crate::numbers::arithmetic::complex_lanes::{Column, column};
use crate::numbers::arithmetic::lane::LANES;
use crate::task::spec::Limits;
use crate::task::{AngleOffset, Body, Problem, Timing};

/// Number of unknowns: ln p, ln q, ln r and the angle.
pub const UNKNOWNS: usize = 4;
/// A point of the reduced form.
pub type Reduced = [f64; UNKNOWNS];
/// The ratio of links beyond which a linkage is a slider-crank in disguise: differences of large lengths, no digits
/// left.
pub const LARGEST_RATIO: f64 = 1e4;

/// Twice the margin (in sizes of the target, or relative) inside the limits at which requirements are aimed.
const MARGIN: f64 = 2e-9;

/// The part of a column's length below which its remainder after projecting off the other columns is rounding.
const SINGULAR: f64 = 1e-12;

/// The origin from which the points are measured, which determines the column of K.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Origin {
    /// A is free: points and columns are centred; the column is e.
    Mean(Complex),
    /// A is known; the column is e.
    CrankPivot(Complex),
    /// B is known and A is not; the column is e - 1/p.
    FollowerPivot(Complex),
}

/// The known part of K = p G.
#[derive(Clone, Copy, Debug, PartialEq)]
enum GroundKnown {
    /// Nothing is known: K is complex.
    Nothing,
    /// The direction is known: K = kappa e^{i theta}.
    Direction,
    /// Direction and length are known: K = p g e^{i theta}.
    Both(f64),
}

/// The meaning of the angle among the unknowns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum AngleRole {
    /// No angle is among the unknowns.
    None,
    /// The angle is phi_0: it turns the crank.
    Crank,
    /// The angle is theta, with crank angles from the ground line: it turns K.
    Ground,
    /// The angle is theta, with crank angles from the x axis: it turns K and, seen from the ground line, the crank
    /// back.
    Both,
}

/// The points as columns, padded to whole lanes with weight zero.
#[derive(Clone, Debug)]
struct Columns {
    phase: Column,
    /// The points measured from the origin.
    target: Column,
    weight: Vec<f64>,
    root_weight: Vec<f64>,
}

/// The body of a motion, one value a target.
#[derive(Clone, Debug)]
struct BodyColumns {
    /// The angle theta_j, in radians.
    angle: Vec<Option<f64>>,
    /// The weight w_j, 0 without an angle, times e^{-i theta_j}.
    back: Vec<Complex>,
    /// The sum of these weights.
    weight: f64,
    /// W, the length that an angle error of one radian counts like.
    length: f64,
}

impl BodyColumns {
    fn of(body: &Body, weight: &[f64]) -> BodyColumns {
        let given = || body.angles.iter().zip(weight);
        BodyColumns {
            angle: body.angles.clone(),
            back: given()
                .map(|(angle, w)| {
                    angle.map_or(Complex::new(0.0, 0.0), |angle| Complex::from_polar(*w, -angle))
                })
                .collect(),
            weight: given().filter(|(angle, _)| angle.is_some()).map(|(_, w)| w).sum(),
            length: body.angle_weight,
        }
    }
}

/// The reduced form of a problem with prescribed timing, in one direction of the crank.
#[derive(Clone, Debug)]
pub struct Projection {
    origin: Origin,
    ground: GroundKnown,
    role: AngleRole,
    /// The turn from the prescribed angles to the crank's from the ground line, if no unknown determines it.
    turn: f64,
    /// The ground's direction theta, if it is known.
    theta: f64,
    bounds: [(f64, f64); UNKNOWNS],
    /// Limits of a, g, b, c.
    limits: [Limits; 4],
    points: usize,
    columns: Columns,
    body: Option<BodyColumns>,
    /// The sum of the weights as given.
    total_weight: f64,
    offset_free: bool,
    /// The sums of w phase, w T, w |T|^2 and w conj(phase) T.
    phase_sum: Complex,
    target_sum: Complex,
    target_sq: f64,
    phase_target: Complex,
}

impl Projection {
    /// Creates the reduced form in a direction of the crank (+1 or -1); `None` for free timing, if there are fewer
    /// equations than linear unknowns, and if two angles would be needed.
    pub fn new(problem: &Problem, direction: f64) -> Option<Self> {
        let task = problem.task();
        let Timing::Prescribed { offset, .. } = task.timing() else { return None };
        let known = KnownPivots::of(problem);
        let total_weight: f64 = task.weights().iter().sum();
        let mut weight: Vec<f64> = task.weights().iter().map(|w| w / total_weight).collect();
        let mean: Complex = task.points().iter().zip(&weight).map(|(p, w)| p * w).sum();
        let (origin, theta, length) = match (known.crank_pivot, known.follower_pivot) {
            (Some(a), Some(b)) => (Origin::CrankPivot(a), Some((b - a).arg()), Some((b - a).norm())),
            (Some(a), None) => (Origin::CrankPivot(a), known.ground_angle, known.ground),
            (None, Some(b)) => (Origin::FollowerPivot(b), known.ground_angle, known.ground),
            (None, None) => (Origin::Mean(mean), known.ground_angle, known.ground),
        };
        if length.is_some_and(|g| g <= 0.0) {
            return None;
        }
        let (role, turn) = match (offset, theta) {
            (AngleOffset::Free, None) if length.is_some() => return None,
            (AngleOffset::Free, _) => (AngleRole::Crank, 0.0),
            (AngleOffset::Ground, None) if length.is_some() => (AngleRole::Ground, 0.0),
            (AngleOffset::Ground, _) => (AngleRole::None, 0.0),
            (AngleOffset::Fixed, Some(theta)) => (AngleRole::None, -theta),
            (AngleOffset::Fixed, None) => (AngleRole::Both, 0.0),
        };
        let directed = theta.is_some() || matches!(role, AngleRole::Ground | AngleRole::Both);
        let ground = match (directed, length) {
            (true, Some(length)) => GroundKnown::Both(length),
            (true, None) => GroundKnown::Direction,
            (false, _) => GroundKnown::Nothing,
        };
        let linear = 2
            + if matches!(origin, Origin::Mean(_)) { 2 } else { 0 }
            + match ground {
                GroundKnown::Nothing => 2,
                GroundKnown::Direction => 1,
                GroundKnown::Both(_) => 0,
            };
        if 2 * task.len() < linear {
            return None;
        }
        let limits = link_limits(problem, length);
        let zero = match origin {
            Origin::Mean(p) | Origin::CrankPivot(p) | Origin::FollowerPivot(p) => p,
        };
        let phases = problem.phases(direction);
        let targets: Vec<Complex> = task.points().iter().map(|p| p - zero).collect();
        weight.resize(task.len().next_multiple_of(LANES), 0.0);
        let sum = |of: &dyn Fn(Complex, Complex) -> Complex| -> Complex {
            phases.iter().zip(&targets).zip(&weight).map(|((&e, &t), w)| of(e, t) * w).sum()
        };
        let columns = Columns {
            phase: column(&phases),
            target: column(&targets),
            root_weight: weight.iter().map(|w| w.sqrt()).collect(),
            weight: weight.clone(),
        };
        Some(Projection {
            phase_sum: sum(&|e, _| e),
            target_sum: sum(&|_, t| t),
            target_sq: sum(&|_, t| Complex::new(t.norm_sqr(), 0.0)).re,
            phase_target: sum(&|e, t| e.conj() * t),
            offset_free: *offset == AngleOffset::Free,
            bounds: ratio_bounds(problem, limits, role),
            limits: [limits[1], limits[0], limits[2], limits[3]],
            points: task.len(),
            body: task.body().map(|body| BodyColumns::of(body, &weight)),
            theta: theta.unwrap_or(0.0),
            origin,
            ground,
            role,
            turn,
            columns,
            total_weight,
        })
    }

    /// Returns [low, high] of the unknowns: the ratios between 1 / [`LARGEST_RATIO`] and [`LARGEST_RATIO`], or within
    /// the design's bounds and the link ratio; the angle unbounded, or fixed at 0 if there is none.
    pub fn bounds(&self) -> &[(f64, f64); UNKNOWNS] {
        &self.bounds
    }

    /// Returns the number of points.
    pub fn points(&self) -> usize {
        self.points
    }

    /// Returns whether one of the unknowns is an angle.
    pub fn has_angle(&self) -> bool {
        self.role != AngleRole::None
    }

    /// Returns the point of the form at a shape whose crank stands at `turn` where the prescribed angle is 0, both from the x
    /// axis, brought within the bounds.
    pub fn at(&self, shape: &Shape, turn: f64) -> Reduced {
        let [ground, crank, coupler, follower] = shape.links();
        let direction = (shape.follower_pivot - shape.crank_pivot).arg();
        let angle = match self.role {
            AngleRole::None => 0.0,
            AngleRole::Crank => turn - direction,
            AngleRole::Ground => turn,
            AngleRole::Both => direction,
        };
        let mut x = [(crank / ground).ln(), (coupler / ground).ln(), (follower / ground).ln(), angle];
        for (value, (low, high)) in x.iter_mut().zip(&self.bounds) {
            *value = value.max(*low).min(*high);
        }
        x
    }

    /// Returns the turn of the crank against the prescribed angles, and the direction of the ground line, as angles.
    fn angles(&self, angle: f64) -> (f64, f64) {
        match self.role {
            AngleRole::None => (self.turn, self.theta),
            AngleRole::Crank => (angle, self.theta),
            AngleRole::Ground => (0.0, angle),
            AngleRole::Both => (-angle, angle),
        }
    }

    /// Returns the angle from the prescribed angles to the crank's from the ground line at a point of the form.
    pub fn crank_turn(&self, x: &Reduced) -> f64 {
        self.angles(x[3]).0
    }

    fn centred(&self) -> bool {
        matches!(self.origin, Origin::Mean(_))
    }

    fn measured_from_b(&self) -> bool {
        matches!(self.origin, Origin::FollowerPivot(_))
    }
}

/// Returns [low, high] of ln p, ln q, ln r of a problem whose ground has this length, if it is known.
pub fn ratio_box(problem: &Problem, ground: Option<f64>) -> [(f64, f64); 3] {
    let [p, q, r, _] = ratio_bounds(problem, link_limits(problem, ground), AngleRole::None);
    [p, q, r]
}

/// Returns the limits of ground, a, b and c, slightly inside the design's if a requirement keeps a margin.
fn link_limits(problem: &Problem, ground: Option<f64>) -> [Limits; 4] {
    let mut limits = problem.space(CouplerSide::Plus).link_limits();
    let [of_ground, ..] = &mut limits;
    *of_ground = match ground {
        Some(length) => Limits(length, length),
        None if of_ground.is_fixed() => *of_ground,
        None => {
            let margin = MARGIN * problem.task().size();
            Limits(of_ground.0 + margin, (of_ground.1 - margin).max(of_ground.0 + margin))
        }
    };
    limits
}

/// Returns the bounds of the ratios that follow from the lengths' limits and the link ratio.
fn ratio_bounds(problem: &Problem, limits: [Limits; 4], role: AngleRole) -> [(f64, f64); UNKNOWNS] {
    let widest = LARGEST_RATIO.min(problem.spec().require.link_ratio_max * (1.0 - 10.0 * MARGIN)).max(1.0);
    let [ground, a, b, c] = limits;
    let of = |Limits(low, high): Limits| {
        // max and min leave a 0/0 behind.
        let low = (low / ground.1).max(1.0 / widest).min(widest);
        let high = (high / ground.0).min(widest).max(low);
        (low.ln(), high.ln())
    };
    let angle = if role == AngleRole::None { (0.0, 0.0) } else { (f64::NEG_INFINITY, f64::INFINITY) };
    [of(a), of(b), of(c), angle]
}
