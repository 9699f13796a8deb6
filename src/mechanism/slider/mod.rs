//! Linkages of one loop with a slider: what the slider-crank and the inverted slider-crank have in common.
//!
//! Every single loop that a crank drives is C = A + a e^{i phi}, a coupler of unit direction u with P = C + Z u, and one
//! closure that gives u:
//!
//! ```text
//! slider-crank            D = C + b u lies on the line Q + y s          Im((C + b u - Q) conj s) = 0
//! inverted slider-crank   B lies h to the left of the line C + x u      Im((B - C) conj u) = h
//! ```
//!
//! A kind gives its closure, the rates of u and of the slider's place, and its mobility; the rest follows from C and u and
//! stands here once.
//!
//! | module | holds |
//! |---|---|
//! | `kind` | the linkages with a slider as mechanisms of any kind |
//! | [`mobility`] | whether the crank turns fully, and the circuits, branches and toggles of a linkage with a slider |
//! | [`motion`] | velocity and acceleration of the joints, the coupler and the slider |

mod kind;
pub mod mobility;
pub mod motion;

pub use mobility::SliderMobility;
pub use motion::{SliderMotion, SliderRates, SlidingMotion};

use super::four_bar::InputArc;
use super::four_bar::coupler_curve::CrankDriven;
use super::four_bar::position::LanePosition;
use super::four_bar::positions::{JointColumns, LaneKernel, positions_of};
use super::four_bar::transmission::TransmissionExtremes;
use super::{AssemblyMode, Complex, LinkageError, MAX_MAGNITUDE, least_and_greatest, point};
use crate::numbers::arithmetic::lane::Lane;
use crate::numbers::arithmetic::sine::sin_cos;
use std::f64::consts::TAU;

/// Position of a linkage with a slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderJoints {
    /// C, the crank pin.
    pub crank_pin: Complex,
    /// D: the pin of the slider; of an inverted slider-crank the foot of the perpendicular from B on the coupler's line.
    pub slider_pin: Complex,
    /// P, the coupler point.
    pub coupler_point: Complex,
    /// u, the coupler's unit direction.
    pub coupler: Complex,
    /// The slider's place, a length: y, from Q along the line; of an inverted slider-crank x, from C along the coupler.
    pub place: f64,
}

/// Result of the position analysis of a linkage with a slider at one crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SliderPosition {
    /// The loop closes.
    Closed(SliderJoints),
    /// No position: the slider cannot be reached at this crank angle.
    Open,
    /// C lies on B and the coupler's line passes through both: every direction closes the loop.
    Undetermined,
}

impl SliderPosition {
    /// Returns the joints if the loop closes in a definite way.
    pub fn joints(self) -> Option<SliderJoints> {
        match self {
            SliderPosition::Closed(joints) => Some(joints),
            SliderPosition::Open | SliderPosition::Undetermined => None,
        }
    }
}

/// A position in each lane, as [`SliderJoints`].
#[derive(Clone, Copy, Debug)]
pub struct SliderLanes<L> {
    /// C, D (as the follower pin) and P, and the gap that is at least zero exactly if the loop closes.
    pub joints: LanePosition<L>,
    /// x and y of u, the coupler's direction.
    pub coupler: [L; 2],
    /// The slider's place.
    pub place: L,
}

/// The position equations of a linkage with a slider, for one number or for eight side by side.
pub trait SliderKernel: Copy {
    /// Computes the position at a crank angle given by its cosine and sine.
    ///
    /// If the loop is open, the joints are those of the nearest flat position, or NaN, and the gap is negative or NaN.
    fn place<L: Lane>(&self, cos: L, sin: L) -> SliderLanes<L>;
}

impl<K: SliderKernel> LaneKernel for K {
    #[inline(always)]
    fn at<L: Lane>(&self, cos: L, sin: L) -> LanePosition<L> {
        self.place(cos, sin).joints
    }
}

/// Derivatives of a position by one parameter: of the joints, of the coupler's direction and of the slider's place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderColumn {
    /// dC.
    pub crank_pin: Complex,
    /// dD.
    pub slider_pin: Complex,
    /// du.
    pub coupler: Complex,
    /// dP.
    pub coupler_point: Complex,
    /// The derivative of the slider's place.
    pub place: f64,
}

/// A linkage of one loop with a slider: [`SliderCrank`](super::SliderCrank) and
/// [`InvertedSliderCrank`](super::InvertedSliderCrank).
pub trait SliderLinkage: Copy + std::fmt::Debug {
    /// The position equations with their coefficients.
    type Kernel: SliderKernel;

    /// Returns A, the fixed pivot of the crank.
    fn crank_pivot(&self) -> Complex;

    /// Returns a = |AC|, the length of the crank.
    fn crank(&self) -> f64;

    /// Returns Z, P along and across the coupler from C, as lengths: P = C + Z u.
    fn coupler_offset(&self) -> Complex;

    /// Returns t1, the sign of the closure's root.
    fn assembly(&self) -> AssemblyMode;

    /// Returns the same linkage with the given sign of the closure's root.
    #[must_use]
    fn with_assembly(self, assembly: AssemblyMode) -> Self;

    /// Computes the coefficients of the position equations.
    fn kernel(&self) -> Self::Kernel;

    /// Returns whether every direction of the coupler closes the loop with C at this place.
    fn is_undetermined(&self, crank_pin: Complex) -> bool;

    /// Returns the sine of the transmission angle, with the sign of t1, and the squared sine at and below which rounding
    /// leaves no digit of it.
    fn sine(&self, joints: &SliderJoints) -> (f64, f64);

    /// Computes the rates of the coupler's angle and of the slider's place from velocity and acceleration of C.
    ///
    /// At a toggle they are infinite or NaN.
    fn rates(&self, joints: &SliderJoints, crank_pin: &motion::PointMotion) -> SliderRates;

    /// Computes whether the crank turns fully, else the arcs of crank angles at which the loop closes, in closed form.
    fn mobility(&self) -> SliderMobility;

    /// Computes mu from the cosine and sine of a crank angle, radians in [0, pi/2]; 0 where the loop is open.
    fn transmission_toward(&self, crank: Complex) -> f64;

    /// Returns the crank angles, radians, between which the transmission angle is monotone.
    fn transmission_turns(&self) -> [f64; 4];

    /// Computes the position at the crank angle `crank_angle` (radians from the x axis), in closed form.
    ///
    /// Open if the loop does not close (beyond [`FLAT_TOLERANCE`](super::FLAT_TOLERANCE)) or the crank angle is no number.
    fn position(&self, crank_angle: f64) -> SliderPosition {
        let (sin, cos) = sin_cos(crank_angle);
        let SliderLanes { joints: at, coupler, place } = self.kernel().place(cos, sin);
        if at.gap >= 0.0 && at.coupler_point.iter().all(|x| x.is_finite()) {
            return SliderPosition::Closed(SliderJoints {
                crank_pin: point(at.crank_pin),
                slider_pin: point(at.follower_pin),
                coupler_point: point(at.coupler_point),
                coupler: point(coupler),
                place,
            });
        }
        if self.is_undetermined(point(at.crank_pin)) {
            SliderPosition::Undetermined
        } else {
            SliderPosition::Open
        }
    }

    /// Computes the position as [`SliderLinkage::position`] does, with the given sign of the closure's root.
    fn position_with(&self, crank_angle: f64, assembly: AssemblyMode) -> SliderPosition {
        self.with_assembly(assembly).position(crank_angle)
    }

    /// Computes C, D and P at each of many crank angles, in blocks of lanes: the digits of [`SliderLinkage::position`],
    /// and NaN where that is open or undetermined.
    ///
    /// # Panics
    /// If there are fewer places than crank angles.
    fn positions(&self, crank_angles: &[f64], joints: JointColumns<'_>) {
        positions_of(&self.kernel(), crank_angles, joints);
    }

    /// Computes mu at a crank angle, radians in [0, pi/2]: the angle between the coupler's force on the slider and the
    /// direction in which the slider cannot yield. `None` if the loop is open.
    fn transmission_angle(&self, crank_angle: f64) -> Option<f64> {
        self.position(crank_angle).joints()?;
        let (sin, cos) = sin_cos(crank_angle);
        Some(self.transmission_toward(Complex::new(cos, sin)))
    }

    /// Computes the extremes of mu over the range of the crank; 0 at its toggles. `None` without a position.
    fn transmission_over_range(&self) -> Option<TransmissionExtremes> {
        let mobility = self.mobility();
        let over = |[from, to]: [f64; 2]| self.transmission_over(from, to);
        let arcs = mobility.input.arcs().iter().map(|arc| over(arc.ends()));
        let full = mobility.input_turns_fully().then(|| over([0.0, TAU]));
        arcs.chain(full).reduce(|one, other| TransmissionExtremes {
            min: one.min.min(other.min),
            max: one.max.max(other.max),
        })
    }

    /// Computes the extremes of mu over the crank angles between `from` and `to` (radians, either order, any number of
    /// turns): they lie at the ends or at the [turning angles](SliderLinkage::transmission_turns) between them.
    fn transmission_over(&self, from: f64, to: f64) -> TransmissionExtremes {
        let [low, high] = [from.min(to), from.max(to)];
        let passed =
            self.transmission_turns().into_iter().filter(|angle| low + (angle - low).rem_euclid(TAU) <= high);
        let mu = |angle: f64| {
            let (sin, cos) = sin_cos(angle);
            self.transmission_toward(Complex::new(cos, sin))
        };
        let [min, max] = least_and_greatest([low, high].into_iter().chain(passed).map(mu));
        TransmissionExtremes { min, max }
    }
}

impl<S: SliderLinkage> CrankDriven for S {
    fn with_assembly(self, assembly: AssemblyMode) -> Self {
        SliderLinkage::with_assembly(self, assembly)
    }

    fn assembly(&self) -> AssemblyMode {
        SliderLinkage::assembly(self)
    }

    fn coupler_point_with(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<Complex> {
        self.position_with(crank_angle, assembly).joints().map(|joints| joints.coupler_point)
    }

    fn arc_of(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<InputArc> {
        let mobility = self.mobility();
        mobility.arc(mobility.branch(crank_angle, assembly).circuit)
    }
}

/// Checks that numbers are finite and below [`MAX_MAGNITUDE`] and that lengths are above 0.
///
/// # Errors
/// [`LinkageError::NotFinite`], [`LinkageError::LengthNotPositive`].
pub(super) fn check(
    numbers: &[(&'static str, f64)],
    lengths: &[(&'static str, f64)],
) -> Result<(), LinkageError> {
    for (key, value) in numbers.iter().chain(lengths).copied() {
        if value.is_nan() || value.abs() > MAX_MAGNITUDE {
            return Err(LinkageError::NotFinite { key, value });
        }
    }
    match lengths.iter().copied().find(|(_, value)| *value <= 0.0) {
        Some((key, value)) => Err(LinkageError::LengthNotPositive { key, value }),
        None => Ok(()),
    }
}
