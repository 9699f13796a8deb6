//! Mechanisms: the four-bar, the slider-crank and its inversion, the chain and the dyad chains, their motion, the dyads that guide a body, their links as plates, the units of their lengths.
//!
//! | module | holds |
//! |---|---|
//! | [`analysis`] | analysis of a given linkage: positions, velocities and accelerations at crank angles, by one method or by several side by side, in one configuration or in all four |
//! | [`any`] | a linkage of any kind, and the trait by which each kind tells its joints, rates, range and links |
//! | [`chain`] | chains: compound mechanisms of a driven crank and stages, each attached to points that are already known, with the position in closed form |
//! | [`dyad`] | poses of a body, and the dyads that guide it |
//! | [`dyad_chain`] | dyad chains: a crank that turns fully, and dyads that hang on it one after the other: four-bars, six-bars, eight-bars |
//! | [`effort`] | counter of linkage positions computed between two checks for a stop, in this crate's own tests; elsewhere it does nothing |
//! | [`four_bar`] | planar four-bar linkages: parameters, position, motion, mobility, coupler curve and cognates |
//! | [`inverted_slider_crank`] | planar inverted slider-cranks, whose coupler slides through a block at a fixed pivot |
//! | [`crank_linkage`] | linkages that a crank drives, of the kinds that synthesis finds, behind one type |
//! | [`loads`] | masses, forces, couples and springs of a linkage: the crank's torque, the forces at the joints, energies |
//! | [`multi_loop`] | six-bars and eight-bars: a crank, and two or three dyads, with the lengths of their links |
//! | [`plates`] | the links as flat plates with holes at the joints, which can be cut out |
//! | [`slider`] | linkages of one loop with a slider: what the slider-crank and the inverted slider-crank have in common |
//! | [`slider_crank`] | planar slider-cranks, whose coupler ends on a block that slides along a fixed line |
//! | [`structure`] | the bodies of a mechanism and the pairs that connect them |
//! | [`mod@unit`] | the units that label lengths |

pub mod analysis;
pub mod any;
pub mod chain;
pub mod crank_linkage;
pub mod dyad;
pub mod dyad_chain;
pub(crate) mod effort;
pub mod four_bar;
pub mod inverted_slider_crank;
pub mod loads;
pub mod multi_loop;
pub mod plates;
pub mod slider;
pub mod slider_crank;
pub mod structure;
mod unit;

pub use crate::numbers::arithmetic::{
    Complex, bounding_box, centroid_and_radius, cross, dot, least_and_greatest, length, nearest_share, point,
    turned, unit_vector, xy,
};
pub use any::{
    CrankRange, Link, Linkage, Mechanism, MechanismMotion, MechanismPose, Output, OutputRate, Slide, Status,
};
pub use chain::{Chain, ChainBuilder};
pub use crank_linkage::{
    CrankLinkage, LinkageKeys, LinkageKind, LoopJoints, LoopMobility, NoLinkage, article,
};
pub use dyad::{Dyad, Pose};
pub use dyad_chain::{DyadChain, DyadChainKind};
pub use four_bar::{
    AssemblyMode, Branch, Circuit, CouplerCurve, CouplerSide, FLAT_TOLERANCE, FourBar, InputArc, InputRange,
    Joints, LinkageError, LinkageType, MAX_MAGNITUDE, Mobility, NaturalCoordinates, OnCircuit, Position,
    Toggle, VectorLoop,
};
pub use inverted_slider_crank::{InvertedSliderCrank, InvertedSliderCrankParameters};
pub use multi_loop::{ChainKeys, MultiLoop, NoMultiLoop};
pub use slider::{SliderJoints, SliderLinkage, SliderPosition};
pub use slider_crank::{SliderCrank, SliderCrankParameters};
pub use unit::Unit;
