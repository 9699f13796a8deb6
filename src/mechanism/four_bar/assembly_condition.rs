//! Assembly conditions of a four-bar at a crank angle: Romero's necessary condition and the sufficient one.
//!
//! With s = |CB| and the projections (N. N. Romero Nunez 2016, equations 12 and 16)
//!
//! ```text
//! l1 = (b^2 + s^2 - c^2)/(2 s)      l2 = (d^2 + b^2 - e^2)/(2 b)
//! condition (20):        (b^2 + d^2)/(l1^2 + l2^2) >= 1         necessary only
//! sufficient as well:    b^2 >= l1^2   and   d^2 >= l2^2        the triangles C-D-B and C-D-P both close
//! ```
//!
//! (20) adds the two inequalities, so that slack in the coupler triangle can hide a loop that does not close. An
//! example in which they differ: A = (0, 0), B = (5, 0), a = 1, b = c = 2, d = e = 5 at 180 degrees has s = 6, l1 = 3,
//! l2 = 1: (4 + 25)/(9 + 1) = 2.9, and no loop, for b^2 - l1^2 = -5.

use crate::mechanism::{Complex, FLAT_TOLERANCE, FourBar};

/// The two conditions at one distance |CB|.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AssemblyCondition {
    /// l1, along C -> B from C to the foot of D (equation 12).
    pub l1: f64,
    /// l2, along C -> D from C to the foot of P (equation 16).
    pub l2: f64,
    /// (b^2 + d^2)/(l1^2 + l2^2), the left side of (20); `None` if l1 = l2 = 0 (it holds then).
    pub ratio: Option<f64>,
    /// b^2 - l1^2 = h1^2, an area: negative if coupler and follower do not meet.
    pub loop_gap: f64,
    /// d^2 - l2^2 = h2^2, an area: negative if no triangle C-D-P exists.
    pub triangle_gap: f64,
    /// Whether the triangle C-D-B closes: b^2 - l1^2 >= 0, down to -[`FLAT_TOLERANCE`] b^2.
    pub loop_closes: bool,
    /// Whether the triangle C-D-P closes: d^2 - l2^2 >= 0, each side down to [`FLAT_TOLERANCE`] of the
    /// perimeter too short.
    pub triangle_closes: bool,
}

impl AssemblyCondition {
    /// Computes both conditions from s = |CB| and the lengths b, c, d, e.
    ///
    /// `None` if s or b is zero (l1 or l2 is undefined: C on B, or no coupler), if a length is negative or no finite
    /// number, or if a square overflows.
    pub fn of_lengths(s: f64, b: f64, c: f64, d: f64, e: f64) -> Option<Self> {
        if !(s > 0.0 && b > 0.0 && c >= 0.0 && d >= 0.0 && e >= 0.0) {
            return None;
        }
        // Factored, so that a flat triangle is recognised to the last digit.
        let l1 = (s + (b - c) * (b + c) / s) / 2.0;
        let l2 = (b + (d - e) * (d + e) / b) / 2.0;
        let loop_gap = (b - l1) * (b + l1);
        let triangle_gap = (d - l2) * (d + l2);
        let projections_sq = l1 * l1 + l2 * l2;
        let lengths_sq = b * b + d * d;
        if ![projections_sq, lengths_sq, loop_gap, triangle_gap].iter().all(|x| x.is_finite()) {
            return None;
        }
        let perimeter = b + d + e;
        let lacks = [b + d - e, d + e - b, e + b - d];
        Some(AssemblyCondition {
            l1,
            l2,
            ratio: (projections_sq > 0.0).then(|| lengths_sq / projections_sq),
            loop_gap,
            triangle_gap,
            loop_closes: loop_gap >= -FLAT_TOLERANCE * b * b,
            triangle_closes: lacks.iter().all(|lack| *lack >= -FLAT_TOLERANCE * perimeter),
        })
    }

    /// Returns whether condition (20) holds as Romero states it: necessary, not sufficient. If the triangles are flat
    /// it may fail by rounding; [`AssemblyCondition::sufficient`] has a tolerance for them.
    pub fn necessary(&self) -> bool {
        self.ratio.is_none_or(|ratio| ratio >= 1.0)
    }

    /// Returns whether both triangles close, so that the linkage can be assembled at this distance.
    pub fn sufficient(&self) -> bool {
        self.loop_closes && self.triangle_closes
    }
}

impl FourBar {
    /// Computes both conditions at a crank angle, radians; `None` if C lies on B or the angle is no number.
    ///
    /// ```
    /// # use linkwright::internals::mechanism::*;
    /// let linkage = FourBar::new(NaturalCoordinates {
    ///     crank_pivot: [0.0, 0.0], follower_pivot: [5.0, 0.0], crank: 1.0, coupler: 2.0, follower: 2.0,
    ///     crank_side: 5.0, follower_side: 5.0, assembly: AssemblyMode::Plus, side: CouplerSide::Plus })?;
    /// let condition = linkage.assembly_condition(180f64.to_radians()).unwrap();
    /// assert!(condition.necessary() && !condition.sufficient());
    /// # Ok::<(), LinkageError>(())
    /// ```
    pub fn assembly_condition(&self, crank_angle: f64) -> Option<AssemblyCondition> {
        let crank_pin = self.crank_pivot() + Complex::from_polar(self.crank(), crank_angle);
        AssemblyCondition::of_lengths(
            (self.follower_pivot() - crank_pin).norm(),
            self.coupler(),
            self.follower(),
            self.crank_side(),
            self.follower_side(),
        )
    }
}
