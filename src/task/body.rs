//! The angles of a link that a task asks for: those of a body on the coupler in a motion, or the outputs of a function.
//!
//! A function's outputs are angles of the follower or of a block, or places of a slider. A place is written as the angle of as
//! many degrees, so that one arithmetic serves both; it has no turns.

use super::targets::{AngleOffset, SMALLEST_SIZE, TaskError};
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{Complex, CrankLinkage, LinkageKind, LoopJoints, MAX_MAGNITUDE};
use crate::task::ranges::Ranges;

/// The sense in which the follower turns while the crank turns as its angles are written.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize, schemars::JsonSchema,
)]
#[serde(rename_all = "kebab-case")]
pub enum Sense {
    /// Either.
    #[default]
    Any,
    /// Output angles count counter-clockwise, as input angles do.
    Same,
    /// Output angles count clockwise.
    Opposite,
}

impl Sense {
    /// Returns the signs of the output angles that it allows: +1 counts them counter-clockwise.
    pub fn signs(self) -> &'static [f64] {
        match self {
            Sense::Any => &[1.0, -1.0],
            Sense::Same => &[1.0],
            Sense::Opposite => &[-1.0],
        }
    }

    /// Returns the sense of a sign.
    pub fn of(sign: f64) -> Sense {
        if sign < 0.0 { Sense::Opposite } else { Sense::Same }
    }
}

/// The quantity that is the output of a function.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Output {
    /// The angle of the follower, or of the block of an inverted slider-crank.
    #[default]
    Angle,
    /// The place of a slider, a length. It is written as the angle of as many degrees, so that one arithmetic serves both;
    /// it has no turns.
    Place,
}

impl Output {
    /// Returns whether linkages of a kind have such an output.
    pub fn is_of(self, kind: LinkageKind) -> bool {
        match self {
            Output::Angle => matches!(kind, LinkageKind::FourBar | LinkageKind::InvertedSliderCrank),
            Output::Place => kind.has_slider(),
        }
    }

    /// Returns the words for what a linkage without such an output does not have.
    pub fn missing(self) -> &'static str {
        match self {
            Output::Angle => "no output link that turns",
            Output::Place => "no slider",
        }
    }
}

/// The link whose angles are wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Link {
    /// The coupler, which carries a body.
    Coupler,
    /// The output link of a function: the follower, or a slider.
    Output {
        /// The quantity that is wanted of it.
        output: Output,
        /// The reference of outputs: free, or the ground line A -> B; of places the foot of the perpendicular from A on the
        /// slider's line, or C.
        offset: AngleOffset,
        /// The sense in which they count: of a slider along its line or against it.
        sense: Sense,
        /// The ranges of inputs and outputs, where they are free.
        ranges: Ranges,
    },
}

/// The angles of a link at the targets: those of a body on the coupler in a motion, those of the output link in a function.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// The angle at each target, in radians; `None`: only the place counts there.
    pub angles: Vec<Option<f64>>,
    /// The length that an angle error of one radian counts like; positive. In a function 180/pi, so that squared errors are
    /// in degrees squared.
    pub angle_weight: f64,
    /// The largest angle error accepted at each target, in radians.
    pub tolerances: Option<Vec<f64>>,
    /// The link.
    pub link: Link,
}

/// Returns the mean direction of the angles `apart`, those of the body less those of the coupler.
fn mean_direction(apart: &[Option<f64>], weights: &[f64]) -> f64 {
    let given = apart.iter().zip(weights).filter_map(|(apart, weight)| Some(((*apart)?, *weight)));
    given.map(|(apart, weight)| Complex::from_polar(weight, apart)).sum::<Complex>().arg()
}

/// Returns the frame for which the weighted sum of squared angle errors is least: the mean of the angles `apart`, each on
/// the turn that is nearest to their mean direction.
pub fn best_frame(apart: &[Option<f64>], weights: &[f64]) -> f64 {
    let middle = mean_direction(apart, weights);
    wrapped(middle + mean(apart, weights, |apart| wrapped(apart - middle)))
}

/// Returns the weighted mean of what `of` makes of the numbers.
fn mean(numbers: &[Option<f64>], weights: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let given = || numbers.iter().zip(weights).filter_map(|(number, weight)| Some(((*number)?, *weight)));
    let total: f64 = given().map(|(_, weight)| weight).sum();
    let off: f64 = given().map(|(number, weight)| weight * of(number)).sum();
    off / total
}

impl Body {
    /// Returns the line of the link at joints B, C and D: C -> D of the coupler, B -> D of the follower.
    pub fn line(&self, [pivot, crank_pin, follower_pin]: [Complex; 3]) -> Complex {
        match self.link {
            Link::Coupler => follower_pin - crank_pin,
            Link::Output { .. } => follower_pin - pivot,
        }
    }

    /// Returns the senses in which the angles may count: +1 alone of a body.
    pub fn signs(&self) -> &'static [f64] {
        match self.link {
            Link::Coupler => &[1.0],
            Link::Output { sense, .. } => sense.signs(),
        }
    }

    /// Returns the bounds of the scales of inputs and outputs: 1 unless a function's ranges are free.
    pub fn ranges(&self) -> Ranges {
        match self.link {
            Link::Coupler => Ranges::default(),
            Link::Output { ranges, .. } => ranges,
        }
    }

    /// Returns the frame that the ground's direction (radians) determines: of outputs that count from the ground line.
    pub fn given_frame(&self, ground_angle: f64) -> Option<f64> {
        match self.link {
            Link::Output { output: Output::Place, offset: AngleOffset::Ground, .. } => Some(0.0),
            Link::Output { offset: AngleOffset::Ground, .. } => Some(wrapped(-ground_angle)),
            Link::Output { .. } | Link::Coupler => None,
        }
    }

    /// Returns whether places of a slider are wanted.
    pub fn is_of_places(&self) -> bool {
        matches!(self.link, Link::Output { output: Output::Place, .. })
    }

    /// Returns the measure of the link that is wanted at a position of a linkage, in the radians of `angles`: the direction of
    /// the coupler or of the output link, or the place of a slider. `None` if the linkage has none.
    pub fn measured(&self, linkage: &CrankLinkage, at: &LoopJoints) -> Option<f64> {
        match self.link {
            Link::Coupler => Some(at.coupler.arg()),
            Link::Output { output: Output::Angle, .. } => linkage.output_angle(at),
            Link::Output { output: Output::Place, .. } => linkage.slider_place(at).map(f64::to_radians),
        }
    }

    /// Returns a difference of two measures: of angles within half a turn, of places as it is.
    pub fn apart(&self, difference: f64) -> f64 {
        if self.is_of_places() { difference } else { wrapped(difference) }
    }

    /// Returns the frame for which the weighted sum of squared errors is least, at the measures `apart`, those wanted less
    /// those of the link: of places their mean, of angles as [`best_frame`].
    pub fn best_frame(&self, apart: &[Option<f64>], weights: &[f64]) -> f64 {
        if self.is_of_places() { mean(apart, weights, |apart| apart) } else { best_frame(apart, weights) }
    }

    /// Returns the difference between the least and the greatest angle, in radians.
    pub(super) fn range(&self) -> f64 {
        let given = || self.angles.iter().flatten().copied();
        given().fold(f64::NEG_INFINITY, f64::max) - given().fold(f64::INFINITY, f64::min)
    }

    /// Returns the frame that suits the angles `apart`, those of the body less those of the coupler, best: the largest error
    /// is least, in parts of the tolerances if there are any; or, unless `largest` is asked for and if the tolerances can be
    /// met, the sum of squares within them is.
    ///
    /// With a_j apart and tolerances t_j the least largest error is the greatest (a_i - a_j) / (t_i + t_j).
    pub fn frame_within(&self, apart: &[Option<f64>], weights: &[f64], largest: bool) -> f64 {
        let middle = if self.is_of_places() { 0.0 } else { mean_direction(apart, weights) };
        // Each with its place, on the turn that is nearest to that direction.
        let given = apart.iter().enumerate();
        let given: Vec<(usize, f64)> =
            given.filter_map(|(j, apart)| Some((j, self.apart((*apart)? - middle)))).collect();
        let tolerance =
            |j: usize| self.tolerances.as_ref().map_or(1.0, |tolerances| tolerances[j].max(SMALLEST_SIZE));
        let (mut least, mut nearest) = (0.0, given.first().map_or(0.0, |(_, apart)| *apart));
        for (i, one) in &given {
            for (j, other) in &given {
                let error = (one - other) / (tolerance(*i) + tolerance(*j));
                if error > least {
                    (least, nearest) = (error, one - error * tolerance(*i));
                }
            }
        }
        if largest || least > 1.0 || self.tolerances.is_none() {
            return self.apart(middle + nearest);
        }
        let low = given.iter().map(|(j, apart)| apart - tolerance(*j)).fold(f64::NEG_INFINITY, f64::max);
        let high = given.iter().map(|(j, apart)| apart + tolerance(*j)).fold(f64::INFINITY, f64::min);
        let best = self.apart(self.best_frame(apart, weights) - middle);
        self.apart(middle + best.max(low).min(high))
    }
}

/// Checks the angles of a body at `n` targets.
pub(super) fn check_body(body: &Body, n: usize) -> Result<(), TaskError> {
    let Body { angles, angle_weight, tolerances, .. } = body;
    let same_length = |what, values: usize| {
        if values == n { Ok(()) } else { Err(TaskError::LengthMismatch { what, points: n, values }) }
    };
    same_length("the angle", angles.len())?;
    let mut given = angles.iter().enumerate().filter_map(|(index, angle)| Some((index, (*angle)?)));
    if let Some((index, value)) = given.find(|(_, angle)| angle.is_nan() || angle.abs() > MAX_MAGNITUDE) {
        return Err(TaskError::NotFinite { index, value });
    }
    if angles.iter().all(Option::is_none) {
        return Err(TaskError::NoAngle);
    }
    if !(SMALLEST_SIZE..=MAX_MAGNITUDE).contains(angle_weight) {
        return Err(TaskError::AngleWeight(*angle_weight));
    }
    let Some(tolerances) = tolerances else { return Ok(()) };
    same_length("tolerance_deg", tolerances.len())?;
    match tolerances.iter().position(|t| !(0.0..=MAX_MAGNITUDE).contains(t)) {
        None => Ok(()),
        Some(index) => {
            let value = tolerances[index].to_degrees();
            Err(TaskError::OutOfRange { what: "tolerance_deg", index, value, must: "0 or more" })
        }
    }
}
