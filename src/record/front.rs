//! The front of a problem: linkages none of which is beaten in every wish by another; and the picks beside the closest
//! candidate: the smallest and the best transmitting linkage whose error is nearly as good.

use super::Candidate;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The least and the greatest number of axes of a front.
pub const LEAST_AXES: usize = 2;
/// As [`LEAST_AXES`].
pub const MOST_AXES: usize = 4;
/// The greatest number of members that can be asked for.
pub const MOST_MEMBERS: usize = 200;
/// The picks use at most one part in this many of the evaluations of their search, or [`PICKS_LEAST`] if that is more.
const PICKS_SHARE: u64 = 4;
/// As [`PICKS_SHARE`].
const PICKS_LEAST: u64 = 10_000;
/// Figures within this relative distance of each other are equal.
pub const EQUAL_FIGURES: f64 = 1e-9;

/// A wish by which linkages are compared in a front.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// The rms error, small.
    Rms,
    /// The largest error, small.
    Max,
    /// The worst transmission angle, large.
    Transmission,
    /// The diagonal of the box of all joints and P over the motion used, small.
    Extent,
    /// The longest of ground, a, b, c, d and e, small.
    Longest,
    /// Longest over shortest of ground, a, b and c, small.
    LinkRatio,
    /// The rms shift of the path for independent errors of every dimension, per unit of their standard deviation, small.
    Sensitivity,
    /// The torque of largest size on the crank under the loads, small.
    PeakTorque,
}

impl Axis {
    /// Every axis, in the order of the columns of `front.csv`.
    pub const ALL: [Axis; 8] = [
        Axis::Rms,
        Axis::Max,
        Axis::Transmission,
        Axis::Extent,
        Axis::Longest,
        Axis::LinkRatio,
        Axis::Sensitivity,
        Axis::PeakTorque,
    ];

    /// Returns the name on the command line and in the record.
    pub fn name(self) -> &'static str {
        match self {
            Axis::Rms => "rms",
            Axis::Max => "max",
            Axis::Transmission => "transmission",
            Axis::Extent => "extent",
            Axis::Longest => "longest",
            Axis::LinkRatio => "link_ratio",
            Axis::Sensitivity => "sensitivity",
            Axis::PeakTorque => "peak_torque",
        }
    }

    /// Returns the axis of a name.
    pub fn named(name: &str) -> Option<Axis> {
        Self::ALL.into_iter().find(|axis| axis.name() == name)
    }
}

/// The figures of a linkage by which members of a front are compared; lengths in the file's unit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Figures {
    /// The rms error.
    pub rms: f64,
    /// The largest error.
    pub max: f64,
    /// The worst transmission angle, in degrees.
    pub transmission_deg: f64,
    /// The diagonal of the box of all joints and P over the motion used.
    pub extent: f64,
    /// The longest of ground, a, b, c, d and e.
    pub longest: f64,
    /// Longest over shortest of ground, a, b and c.
    pub link_ratio: f64,
    /// The rms shift of the path for independent errors of every dimension, per unit of their standard deviation.
    pub sensitivity: f64,
    /// The torque of largest size on the crank under the loads, N m; absent without loads, and of a motion that passes a toggle.
    #[serde(rename = "peak_torque_N_m", default, skip_serializing_if = "Option::is_none")]
    pub peak_torque: Option<f64>,
}

impl Figures {
    /// Returns the figure of an axis; infinity for a torque that is absent.
    pub fn of(&self, axis: Axis) -> f64 {
        match axis {
            Axis::Rms => self.rms,
            Axis::Max => self.max,
            Axis::Transmission => self.transmission_deg,
            Axis::Extent => self.extent,
            Axis::Longest => self.longest,
            Axis::LinkRatio => self.link_ratio,
            Axis::Sensitivity => self.sensitivity,
            Axis::PeakTorque => self.peak_torque.unwrap_or(f64::INFINITY),
        }
    }
}

/// The front: linkages none of which is beaten on every axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Front {
    /// The axes asked for.
    pub axes: Vec<Axis>,
    /// The number of members asked for.
    pub points: usize,
    /// The evaluations of the objective that it cost beside the search.
    pub evaluations: u64,
    /// The members, the least rms error first.
    pub members: Vec<Member>,
}

/// A member of a front.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Member {
    /// Its figures.
    pub figures: Figures,
    /// Whether the front bends sharply here: a little more of one wish costs much of another on either side.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub knee: bool,
    /// The linkage with every figure and verdict.
    pub candidate: Candidate,
}

/// Linkages whose error is nearly that of the closest candidate, and which are better to build.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Picks {
    /// The greatest rms error (or largest deviation, if that is the objective) of a pick; absent where the tolerance of
    /// the problem is the limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub within: Option<f64>,
    /// The evaluations of the objective that they cost beside the search.
    pub evaluations: u64,
    /// The linkage of least extent. Its rank is that of the equal candidate, 0 if it is none of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub smallest: Option<Candidate>,
    /// The linkage of the greatest worst transmission angle, ranked likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub best_transmission: Option<Candidate>,
}

impl Picks {
    /// Returns the most evaluations of the picks of a search that used so many.
    pub fn most_evaluations(search: u64) -> u64 {
        (search / PICKS_SHARE).max(PICKS_LEAST)
    }

    /// Returns the picks with the names that files and messages use.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, &Candidate)> {
        let picks = [("smallest", &self.smallest), ("best_transmission", &self.best_transmission)];
        picks.into_iter().filter_map(|(name, pick)| Some((name, pick.as_ref()?)))
    }
}
