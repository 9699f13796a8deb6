//! Position analysis of the four-bar in closed form, in natural coordinates: the kernel that the other modules call.
//!
//! With V = B - C and s^2 = |V|^2 (N. N. Romero Nunez 2016, equations 10 to 19):
//!
//! ```text
//! C = A + a e^{i phi}
//! u = (1 + (b^2 - c^2)/s^2)/2        (= l1/s, equation 12)
//! k = b^2/s^2 - u^2                  (= (h1/s)^2, equation 13; negative: the loop does not close)
//! D = C + V (u + i t1 sqrt k)        (equation 15)
//! P = C + z (D - C)                  (equation 18)
//! ```
//!
//! One division and one square root a position. Romero's assembly condition (20) is necessary only: the loop closes if
//! k >= 0, and the coupler triangle if d^2 >= l2^2 (checked when a [`FourBar`] is made). The loop is also open when C
//! falls on B: D is then undetermined (b = c) or impossible.

use crate::mechanism::{AssemblyMode, Complex, FLAT_TOLERANCE, FourBar};
use crate::numbers::arithmetic::lane::Lane;
use crate::numbers::arithmetic::sine::sin_cos;

/// Positions of the moving joints.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joints {
    /// C, the crank pin.
    pub crank_pin: Complex,
    /// D, the follower pin.
    pub follower_pin: Complex,
    /// P, the coupler point.
    pub coupler_point: Complex,
}

/// Result of the position analysis at one crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Position {
    /// The loop closes.
    Closed(Joints),
    /// No position: coupler and follower cannot meet at this crank angle.
    Open,
    /// C lies on B and b = c: every direction of the follower closes the loop.
    Undetermined,
}

impl Position {
    /// Returns the joints if the loop closes in a definite way.
    pub fn joints(self) -> Option<Joints> {
        match self {
            Position::Closed(joints) => Some(joints),
            Position::Open | Position::Undetermined => None,
        }
    }

    /// Returns whether the loop closes in a definite way.
    pub fn is_closed(self) -> bool {
        matches!(self, Position::Closed(_))
    }
}

/// A linkage as the coefficients of its position equations.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    a_x: f64,
    a_y: f64,
    crank: f64,
    b_x: f64,
    b_y: f64,
    coupler_sq: f64,
    half_difference: f64,
    t1: f64,
    z_x: f64,
    z_y: f64,
}

/// A position in each lane; `gap` is at least zero if the loop closes there, and negative or NaN if it does not.
#[derive(Clone, Copy, Debug)]
pub struct LanePosition<L> {
    /// x and y of C, the crank pin.
    pub crank_pin: [L; 2],
    /// x and y of D, the follower pin.
    pub follower_pin: [L; 2],
    /// x and y of P, the coupler point.
    pub coupler_point: [L; 2],
    /// k + [`FLAT_TOLERANCE`] b^2/s^2: at least zero exactly if the loop closes.
    pub gap: L,
}

/// Intersection of the circle of radius b about C with the circle of radius c about B, in the frame of V = B - C.
#[derive(Clone, Copy)]
pub(crate) struct Meeting<L> {
    /// u = l1/s, the component along V.
    pub u: L,
    /// sqrt k = |h1|/s, the component across V; 0 if the circles miss each other.
    pub root: L,
    /// k + [`FLAT_TOLERANCE`] b^2/s^2: at least zero exactly if the circles meet.
    pub gap: L,
}

/// Computes u and sqrt k (equations 12 and 13) from V, b^2 and (b^2 - c^2)/2: D = C + V (u +- i sqrt k).
#[inline(always)]
pub(crate) fn meeting<L: Lane>(v: [L; 2], radius_sq: L, half_difference: L) -> Meeting<L> {
    let inv = (v[0] * v[0] + v[1] * v[1]).recip();
    let u = L::splat(0.5) + half_difference * inv;
    let reach = radius_sq * inv;
    let k = reach - u * u;
    Meeting { u, root: k.positive_part().sqrt(), gap: k + L::splat(FLAT_TOLERANCE) * reach }
}

impl Kernel {
    /// Computes the coefficients of a linkage.
    #[inline]
    pub fn new(linkage: &FourBar) -> Self {
        let p = &linkage.parameters;
        Kernel::from_parts(
            p.crank_pivot,
            p.follower_pivot,
            [p.crank, p.coupler, p.follower],
            [linkage.coupler_ratio.re, linkage.coupler_ratio.im],
            p.assembly,
        )
    }

    /// Computes the coefficients from A, B, (a, b, c), z and t1; nothing is checked.
    #[inline(always)]
    pub fn from_parts(
        crank_pivot: [f64; 2],
        follower_pivot: [f64; 2],
        links: [f64; 3],
        coupler_ratio: [f64; 2],
        assembly: AssemblyMode,
    ) -> Self {
        let [crank, coupler, follower] = links;
        Kernel {
            a_x: crank_pivot[0],
            a_y: crank_pivot[1],
            crank,
            b_x: follower_pivot[0],
            b_y: follower_pivot[1],
            coupler_sq: coupler * coupler,
            half_difference: 0.5 * (coupler * coupler - follower * follower),
            t1: assembly.sign(),
            z_x: coupler_ratio[0],
            z_y: coupler_ratio[1],
        }
    }

    /// Computes C, V, u, sqrt k and the gap, which both assemblies share.
    #[inline(always)]
    fn reach<L: Lane>(&self, cos: L, sin: L) -> Reach<L> {
        let s = L::splat;
        let crank_pin = [s(self.a_x) + s(self.crank) * cos, s(self.a_y) + s(self.crank) * sin];
        let v = [s(self.b_x) - crank_pin[0], s(self.b_y) - crank_pin[1]];
        Reach { crank_pin, v, meeting: meeting(v, s(self.coupler_sq), s(self.half_difference)) }
    }

    #[inline(always)]
    fn close<L: Lane>(&self, reach: &Reach<L>, root: L) -> LanePosition<L> {
        let s = L::splat;
        let Reach { crank_pin: [c_x, c_y], v: [v_x, v_y], meeting: Meeting { u, gap, .. } } = *reach;
        let w_x = v_x * u - v_y * root;
        let w_y = v_y * u + v_x * root;
        LanePosition {
            crank_pin: [c_x, c_y],
            follower_pin: [c_x + w_x, c_y + w_y],
            coupler_point: [
                c_x + s(self.z_x) * w_x - s(self.z_y) * w_y,
                c_y + s(self.z_x) * w_y + s(self.z_y) * w_x,
            ],
            gap,
        }
    }

    /// Computes the position at a crank angle given by its cosine and sine, in any lane type.
    ///
    /// If the loop is open, the joints are those of the nearest flat position and `gap` is negative or NaN.
    #[inline(always)]
    pub fn at<L: Lane>(&self, cos: L, sin: L) -> LanePosition<L> {
        let reach = self.reach(cos, sin);
        self.close(&reach, L::splat(self.t1) * reach.meeting.root)
    }

    /// Computes the positions of both assemblies, [t1 = +1, t1 = -1], with one division and one root.
    #[inline(always)]
    pub fn at_both<L: Lane>(&self, cos: L, sin: L) -> [LanePosition<L>; 2] {
        let reach = self.reach(cos, sin);
        [self.close(&reach, reach.meeting.root), self.close(&reach, -reach.meeting.root)]
    }
}

#[derive(Clone, Copy)]
struct Reach<L> {
    crank_pin: [L; 2],
    v: [L; 2],
    meeting: Meeting<L>,
}

impl FourBar {
    /// Computes the position at the crank angle `crank_angle` (radians from the x axis), in closed form.
    ///
    /// ```
    /// # use linkwright::internals::mechanism::*;
    /// // De Castro, example 2.1 at 90 degrees: P = (64.893, 510.820).
    /// let linkage = FourBar::from_vector_loop(VectorLoop {
    ///     crank_pivot: [0.0, 0.0], follower_pivot: [-350.0, 0.0], crank: 700.0, coupler: 300.0,
    ///     follower: 500.0, coupler_point: 200.0, beta_deg: 30.0, assembly: AssemblyMode::Plus })?;
    /// let p = linkage.position(90f64.to_radians()).joints().unwrap().coupler_point;
    /// assert!((p.re - 64.893).abs() < 5e-4 && (p.im - 510.820).abs() < 5e-4);
    /// # Ok::<(), LinkageError>(())
    /// ```
    pub fn position(&self, crank_angle: f64) -> Position {
        self.position_with(crank_angle, self.assembly())
    }

    /// Computes the position as [`FourBar::position`] does, with the given assembly mode.
    pub fn position_with(&self, crank_angle: f64, assembly: AssemblyMode) -> Position {
        let (sin, cos) = sin_cos(crank_angle);
        let at = Kernel::new(&self.with_assembly(assembly)).at(cos, sin);
        if at.gap >= 0.0 && at.coupler_point.iter().all(|x| x.is_finite()) {
            let as_point = |p: [f64; 2]| Complex::new(p[0], p[1]);
            return Position::Closed(Joints {
                crank_pin: as_point(at.crank_pin),
                follower_pin: as_point(at.follower_pin),
                coupler_point: as_point(at.coupler_point),
            });
        }
        let distance = (self.follower_pivot() - Complex::new(at.crank_pin[0], at.crank_pin[1])).norm();
        if distance == 0.0 && self.coupler() == self.follower() {
            Position::Undetermined
        } else {
            Position::Open
        }
    }
}
