//! A linkage of any kind, and what every kind tells of itself: its joints and its output at a crank angle, their rates, the
//! range of its crank, and its links.
//!
//! Analysis and reports are written against [`Mechanism`]; a new kind is a folder of its own that implements it and a row
//! of [`Linkage`].

use super::four_bar::motion::Turning;
use super::four_bar::transmission::TransmissionExtremes;
use super::slider::motion::Sliding;
use super::{Chain, Complex, FourBar, InvertedSliderCrank, MultiLoop, SliderCrank};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::structure::Structure;
use serde::Serialize;
use std::f64::consts::TAU;

/// The linkage in a linkage file, of any kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Linkage {
    /// A four-bar.
    FourBar(FourBar),
    /// A slider-crank.
    SliderCrank(SliderCrank),
    /// An inverted slider-crank.
    InvertedSliderCrank(InvertedSliderCrank),
    /// A six-bar or an eight-bar.
    MultiLoop(Box<MultiLoop>),
    /// A chain.
    Chain(Box<Chain>),
}

impl Linkage {
    /// Returns the linkage as a mechanism.
    pub fn mechanism(&self) -> &dyn Mechanism {
        match self {
            Linkage::FourBar(linkage) => linkage,
            Linkage::SliderCrank(linkage) => linkage,
            Linkage::InvertedSliderCrank(linkage) => linkage,
            Linkage::MultiLoop(linkage) => linkage.as_ref(),
            Linkage::Chain(chain) => chain.as_ref(),
        }
    }
}

/// Status of the result at one crank angle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// Position and motion are definite.
    Ok,
    /// A toggle: the position is known, velocities and accelerations are not decided by the crank.
    Singular,
    /// The loop does not close at this crank angle.
    Open,
    /// Every direction of a link closes the loop: C lies on B, with b = c in a four-bar, without offset in an inverted
    /// slider-crank.
    Undetermined,
    /// The input or a result is beyond the range of numbers.
    NotFinite,
}

impl Status {
    /// Returns the status as a word: ok, singular, open, undetermined or not-finite.
    pub fn word(self) -> &'static str {
        match self {
            Status::Ok => "ok",
            Status::Singular => "singular",
            Status::Open => "open",
            Status::Undetermined => "undetermined",
            Status::NotFinite => "not-finite",
        }
    }
}

/// The output of a mechanism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Output {
    /// The follower's angle from the x axis, radians.
    Follower(f64),
    /// The slider's place, a length.
    Slider(f64),
}

/// The rate of a mechanism's output.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OutputRate {
    /// Of the follower's angle.
    Follower(Turning),
    /// Of the slider's place.
    Slider(Sliding),
}

/// The position of a mechanism at one crank angle. A place that is not known is `None`, and no number is NaN.
#[derive(Clone, Debug, PartialEq)]
pub struct MechanismPose {
    /// The status.
    pub status: Status,
    /// Index of the joint that cannot be placed, or whose motion is not decided.
    pub stuck: Option<usize>,
    /// The places of the joints, in the order of [`Mechanism::joint_names`].
    pub joints: Vec<Option<Complex>>,
    /// The unit direction of the coupler, from C; `None` for kinds with several.
    pub coupler: Option<Complex>,
    /// The output; `None` for kinds without a certain one.
    pub output: Option<Output>,
    /// The transmission angle, radians.
    pub transmission: Option<f64>,
}

/// Position, velocity and acceleration of a mechanism at one crank angle.
#[derive(Clone, Debug, PartialEq)]
pub struct MechanismMotion {
    /// The position, with the status of the motion.
    pub pose: MechanismPose,
    /// The velocities of the joints.
    pub velocities: Vec<Option<Complex>>,
    /// The accelerations of the joints.
    pub accelerations: Vec<Option<Complex>>,
    /// The rates of the coupler's angle.
    pub coupler: Option<Turning>,
    /// The rates of the output.
    pub output: Option<OutputRate>,
}

/// The range of a mechanism's crank.
#[derive(Clone, Debug, PartialEq)]
pub struct CrankRange {
    /// Whether the crank turns fully.
    pub turns_fully: bool,
    /// [from, to] of each arc that the crank reaches, radians; empty for a full turn, or if there is none.
    pub arcs: Vec<[f64; 2]>,
    /// The crank angles of the toggles between branches, radians; empty if they are not known.
    pub toggles: Vec<f64>,
    /// Number of circuits, and of branches in each; `None` if they are not known.
    pub circuits: Option<[u8; 2]>,
    /// The crank turns fully if this length is at least zero; `None` if it is found from samples.
    pub margin: Option<f64>,
}

/// A moving link.
#[derive(Clone, Debug, PartialEq)]
pub struct Link {
    /// Its name: crank, coupler, follower, or in a chain its joints: B-C.
    pub name: String,
    /// Indices of its joints and attached points.
    pub joints: Vec<usize>,
    /// The distance of its first two joints; `None` if that is not constant.
    pub length: Option<f64>,
}

/// The guide of a slider, for drawings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slide {
    /// A block on the joint slides along the fixed line.
    Rail {
        /// Index of the block's joint.
        block: usize,
        /// A point of the line.
        through: Complex,
        /// Its unit direction.
        direction: Complex,
    },
    /// The coupler is a rod that slides through a block.
    Rod {
        /// Index of the joint from which the rod goes along the coupler.
        from: usize,
        /// Index of the foot of the perpendicular from the pivot on the rod.
        foot: usize,
        /// Index of the block's fixed pivot.
        pivot: usize,
    },
}

/// A planar mechanism with one driven crank, which knows its own kinematics.
pub trait Mechanism {
    /// Returns the kind as a word of files: four-bar, slider-crank, inverted-slider-crank, six-bar,
    /// eight-bar or chain.
    fn kind(&self) -> &'static str;

    /// Returns the names of the joints and points, the fixed pivots first.
    fn joint_names(&self) -> Vec<&str>;

    /// Returns the number of fixed pivots among the joints.
    fn pivots(&self) -> usize;

    /// Returns the index of the traced point: P of a kind with one coupler.
    fn traced(&self) -> usize;

    /// Computes the position at a crank angle (radians from the x axis).
    fn pose_at(&self, crank_angle: f64) -> MechanismPose;

    /// Computes position, velocity and acceleration at a crank angle, with the speed and acceleration of the crank.
    fn motion_at(&self, crank_angle: f64, input: CrankMotion) -> MechanismMotion;

    /// Computes the range of the crank, with the assembly that the mechanism has.
    fn crank_range(&self) -> CrankRange;

    /// Returns the moving links, the crank first.
    fn moving_links(&self) -> Vec<Link>;

    /// Returns the bodies, and the pairs that connect them.
    fn structure(&self) -> Structure;

    /// Returns the guide of the slider; `None` for kinds that are drawn without one.
    fn slide(&self) -> Option<Slide> {
        None
    }

    /// Computes the extremes of the transmission angle over the range of the crank; `None` if they are not known.
    fn transmission_extremes(&self) -> Option<TransmissionExtremes> {
        None
    }

    /// Returns the ratio of the longest to the shortest link; `None` if it is not finite or not known.
    fn longest_to_shortest(&self) -> Option<f64> {
        None
    }

    /// Computes the path of the traced point over a full turn: at phi = 2 pi i / samples; `None` if it is not known.
    fn path(&self, samples: usize) -> Vec<Option<Complex>> {
        let at = |i: usize| self.pose_at(TAU * i as f64 / samples as f64).joints[self.traced()];
        (0..samples).map(at).collect()
    }
}
