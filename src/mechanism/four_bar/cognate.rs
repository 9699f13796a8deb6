//! The Roberts-Chebyshev cognates: the two other four-bars that trace the same coupler curve.
//!
//! With the links as vectors, w2 = C - A, w3 = D - C, w4 = D - B, and z = (P - C)/(D - C), the third pivot is
//! G = A + z (B - A), and (S. Roberts 1875; P. L. Chebyshev 1878)
//!
//! | linkage | pivots | pins | links | P |
//! |---|---|---|---|---|
//! | the original | A, B | A + w2, B + w4 | w2, w3, w4 | C + z w3 |
//! | the first, at A | A, G | A + z w3, G + z w4 | z w3, z w2, z w4 | A + z w3 + w2 |
//! | the second, at B | B, G | B - (1-z) w3, G + (1-z) w2 | -(1-z) w3, (1-z) w4, (1-z) w2 | B - (1-z) w3 + w4 |
//!
//! Every link of a cognate is a link of the original, turned and scaled by a constant: it turns *in step* with
//! it, at a constant phase. Of the two links on the ground the input is the one that turns fully if exactly
//! one does; otherwise the first cognate is driven at A (in step with the coupler) and the second at G (in
//! step with the original's crank, so that it keeps the timing):
//!
//! | original | first cognate | second cognate |
//! |---|---|---|
//! | crank-rocker | double-rocker, driven at A | crank-rocker, driven at G, in step with the crank |
//! | rocker-crank | crank-rocker, driven at G, in step with the follower | double-rocker, driven at G |
//! | double-crank | double-crank, driven at A | double-crank, driven at G |
//! | double-rocker | crank-rocker, driven at A, in step with the coupler | the same, driven at B |
//! | triple-rocker, change-point | the same type, driven at A | the same type, driven at G |
//!
//! # Degenerate cases
//! - P on C (z = 0): the first cognate has no links and G = A; the second has the same crank, and coupler and
//!   follower have changed places (C-D-B completed to a parallelogram). The curve is the crank's circle.
//! - P on D (z = 1): the second has no links and G = B; of the first, crank and coupler have changed places.
//! - P on the line C-D (z real): G lies on the line A-B, all is well.
//! - A parallelogram (b = g, c = a, uncrossed): its coupler does not turn, so that the link in step with it
//!   does not turn either and the cognates are kites held in their folded position. The first cognate then has its
//!   driven pin on its other pivot: its position is undetermined, or by rounding arbitrary, for its follower
//!   turns freely about G, the centre of the original's curve.
//! - Coincident pivots (g = 0): G is there too, and all three turn as rigid wholes.

use super::mobility::{linkage_type, wrapped};
use crate::mechanism::{AssemblyMode, Complex, FourBar, InputRange, LinkageError, cross};
use std::f64::consts::{FRAC_PI_2, PI};

/// A moving link of the original linkage, as a vector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OriginalLink {
    /// The crank, A -> C.
    Crank,
    /// The coupler, C -> D.
    Coupler,
    /// The follower, B -> D.
    Follower,
}

/// The phase relation between a link of the cognate and the link of the original with which it turns in step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InStep {
    /// The link of the original.
    pub with: OriginalLink,
    /// The angle of the cognate's link less that of the original's, radians in (-pi, pi]; constant. The cognate's links
    /// are taken as the vectors crank A' -> C', coupler C' -> D', follower B' -> D'.
    pub phase: f64,
}

/// The fixed pivot that a cognate shares with the original; its other pivot is G.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SharedPivot {
    /// A: the first cognate.
    Crank,
    /// B: the second cognate.
    Follower,
}

/// The reason why there is no cognate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CognateError {
    /// The coupler point lies on the pin of the shared side, and the cognate's links have no length.
    #[error("the coupler point lies on a pin: the cognate at that side has no links")]
    CouplerPointOnPin,
    /// The original is open at the crank angle that the cognate was asked for.
    #[error("the linkage does not close at a crank angle of {crank_deg} degrees")]
    Open {
        /// The crank angle of the original, degrees.
        crank_deg: f64,
    },
    /// A length or coordinate of the cognate is outside the range allowed for a linkage.
    #[error("the cognate is no linkage: {0}")]
    Linkage(#[from] LinkageError),
}

/// One of the two cognates of a linkage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cognate {
    /// The pivot that it shares with the original.
    pub shared: SharedPivot,
    /// The cognate as a four-bar; its t1 is that of the position for which it was computed.
    pub linkage: FourBar,
    /// The link of the original with which the cognate's crank turns in step.
    pub crank: InStep,
    /// The link of the original with which the cognate's coupler turns in step.
    pub coupler: InStep,
    /// The link of the original with which the cognate's follower turns in step.
    pub follower: InStep,
    original: FourBar,
    /// Its links in the order (crank, coupler, follower), as factors of the original's.
    factors: [(OriginalLink, Complex); 3],
}

impl Cognate {
    /// Returns the original linkage.
    pub fn original(&self) -> FourBar {
        self.original
    }

    /// Computes the crank angle (radians) and t1 of the cognate at the position of the original with the crank angle
    /// `crank_angle` and the assembly `assembly`, from the actual joints.
    ///
    /// The angle is `crank_angle` plus the phase if the two cranks turn in step, full turns included, and in (-pi, pi]
    /// otherwise. At a toggle of the cognate both t1 are right within rounding. `None` if the original is open or
    /// undetermined.
    ///
    /// ```
    /// # use linkwright::internals::mechanism::*;
    /// let original = FourBar::with_coupler_offset([point([0.0, 0.0]), point([4.0, 1.0])], [2.0, 5.0, 5.0],
    ///     point([2.5, 4.3]), AssemblyMode::Plus)?;
    /// for cognate in original.cognates() {
    ///     let cognate = cognate.unwrap();
    ///     let (angle, t1) = cognate.position_of(0.3, AssemblyMode::Plus).unwrap();
    ///     let theirs = cognate.linkage.position_with(angle, t1).joints().unwrap().coupler_point;
    ///     assert!((theirs - original.position(0.3).joints().unwrap().coupler_point).norm() < 1e-13);
    /// }
    /// # Ok::<(), LinkageError>(())
    /// ```
    pub fn position_of(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<(f64, AssemblyMode)> {
        let joints = self.original.position_with(crank_angle, assembly).joints()?;
        let vectors = [
            joints.crank_pin - self.original.crank_pivot(),
            joints.follower_pin - joints.crank_pin,
            joints.follower_pin - self.original.follower_pivot(),
        ];
        let vector = |(link, factor): (OriginalLink, Complex)| factor * vectors[link as usize];
        let [crank, coupler, _] = self.factors.map(vector);
        let to_pivot = self.linkage.follower_pivot() - self.linkage.crank_pivot() - crank;
        let angle = match self.crank.with {
            OriginalLink::Crank => crank_angle + self.crank.phase,
            OriginalLink::Coupler | OriginalLink::Follower => crank.arg(),
        };
        Some((angle, AssemblyMode::of(cross(to_pivot, coupler))))
    }
}

impl FourBar {
    /// Returns G = A + z (B - A), the third pivot, which both cognates share.
    pub fn cognate_pivot(&self) -> Complex {
        self.crank_pivot() + self.coupler_ratio() * (self.follower_pivot() - self.crank_pivot())
    }

    /// Computes the two cognates, [at A, at B], as the module describes. The t1 of each belongs to a position in the
    /// middle of the original's input range (90 degrees from the ground line if the input turns fully). For another
    /// circuit or branch see [`FourBar::cognates_at`].
    ///
    /// # Errors
    /// [`CognateError`] for each one that does not exist; [`CognateError::Open`] for a linkage that cannot be assembled
    /// at all.
    pub fn cognates(&self) -> [Result<Cognate, CognateError>; 2] {
        let middle = match self.mobility().input {
            InputRange::One(arc) | InputRange::Two([arc, _]) => arc.middle,
            InputRange::Full | InputRange::None => self.ground_angle() + FRAC_PI_2,
        };
        self.cognates_at(middle)
    }

    /// Computes the two cognates, [at A, at B], whose t1 belongs to the original's position at `crank_angle` (radians)
    /// with its own t1.
    ///
    /// # Errors
    /// As [`FourBar::cognates`]; [`CognateError::Open`] if the original does not close there.
    pub fn cognates_at(&self, crank_angle: f64) -> [Result<Cognate, CognateError>; 2] {
        [SharedPivot::Crank, SharedPivot::Follower].map(|shared| self.cognate(shared, crank_angle))
    }

    fn cognate(&self, shared: SharedPivot, crank_angle: f64) -> Result<Cognate, CognateError> {
        use OriginalLink::{Coupler, Crank, Follower};
        let z = self.coupler_ratio();
        let pivot = self.cognate_pivot();
        // The cognate driven at its shared pivot: factor, size, links (crank, coupler, follower).
        let (turn, size, standing, links) = match shared {
            SharedPivot::Crank => {
                let size = self.crank_side() / self.coupler();
                (z, size, self.crank_pivot(), [(Coupler, 1.0), (Crank, 1.0), (Follower, 1.0)])
            }
            SharedPivot::Follower => {
                let size = self.follower_side() / self.coupler();
                (1.0 - z, size, self.follower_pivot(), [(Coupler, -1.0), (Follower, 1.0), (Crank, 1.0)])
            }
        };
        if size == 0.0 || turn.norm() == 0.0 {
            return Err(CognateError::CouplerPointOnPin);
        }
        let lengths = [self.crank(), self.coupler(), self.follower()];
        let length = |link: OriginalLink| size * lengths[link as usize];
        let turns = |order: [OriginalLink; 3]| {
            let [crank, coupler, follower] = order.map(length);
            linkage_type([size * self.ground(), crank, coupler, follower])
                .is_some_and(|t| t.input_turns_fully())
        };
        let [near, middle, far] = links;
        let driven_near = turns([near.0, middle.0, far.0]);
        let driven_far = turns([far.0, middle.0, near.0]);
        let at_shared = if driven_near == driven_far { shared == SharedPivot::Crank } else { driven_near };
        // Seen from the other end the coupler points the other way, and P lies at 1 - 1/turn along it.
        let inverse = turn.inv();
        let (pivots, order, ratio) = if at_shared {
            ([standing, pivot], [near, middle, far], inverse)
        } else {
            ([pivot, standing], [far, (middle.0, -middle.1), near], 1.0 - inverse)
        };
        let lengths = order.map(|(link, _)| length(link));
        let linkage = FourBar::with_coupler_offset(pivots, lengths, ratio * lengths[1], AssemblyMode::Plus)?;
        let [crank, coupler, follower] = order.map(|(with, sign)| {
            let half = if sign < 0.0 { PI } else { 0.0 };
            InStep { with, phase: wrapped(turn.arg() + half) }
        });
        let factors = order.map(|(link, sign)| (link, turn * sign));
        let mut cognate = Cognate { shared, linkage, crank, coupler, follower, original: *self, factors };
        let (_, assembly) = cognate
            .position_of(crank_angle, self.assembly())
            .ok_or(CognateError::Open { crank_deg: crank_angle.to_degrees() })?;
        cognate.linkage = linkage.with_assembly(assembly);
        Ok(cognate)
    }
}
