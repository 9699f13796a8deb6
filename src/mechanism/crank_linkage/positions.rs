//! Positions of a linkage that a crank drives: its joints, and the angle or the place of its output.

use super::CrankLinkage;
use crate::mechanism::dyad_chain::kinds::COUPLER;
use crate::mechanism::{
    AssemblyMode, Complex, Joints, OnCircuit, SliderJoints, SliderLinkage, SliderPosition, dot,
};

/// A position of a linkage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopJoints {
    /// C, D and P; D of an inverted slider-crank is the foot of the perpendicular from B on the coupler's line, of a six-bar the
    /// joint of its first dyad.
    pub joints: Joints,
    /// The direction of the coupler from C, in which D lies at t1 = +1; of a six-bar that of the body that carries P; not of
    /// length 1.
    pub coupler: Complex,
}

/// The position of a four-bar, whose coupler points from C to D.
impl From<Joints> for LoopJoints {
    fn from(joints: Joints) -> Self {
        LoopJoints { joints, coupler: joints.follower_pin - joints.crank_pin }
    }
}

impl From<&Joints> for LoopJoints {
    fn from(joints: &Joints) -> Self {
        LoopJoints::from(*joints)
    }
}

impl From<&LoopJoints> for LoopJoints {
    fn from(at: &LoopJoints) -> Self {
        *at
    }
}

impl CrankLinkage {
    /// Computes the position at a crank angle (radians) in the given assembly; `None` if the loop is open or undetermined.
    pub fn joints_with(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<LoopJoints> {
        let of_slider = |position: SliderPosition| {
            let SliderJoints { crank_pin, slider_pin, coupler_point, coupler, .. } = position.joints()?;
            let joints = Joints { crank_pin, follower_pin: slider_pin, coupler_point };
            Some(LoopJoints { joints, coupler })
        };
        match self {
            CrankLinkage::FourBar(linkage) => {
                let joints = linkage.position_with(crank_angle, assembly).joints()?;
                Some(LoopJoints { joints, coupler: joints.follower_pin - joints.crank_pin })
            }
            CrankLinkage::SliderCrank(linkage) => of_slider(linkage.position_with(crank_angle, assembly)),
            CrankLinkage::InvertedSliderCrank(linkage) => {
                of_slider(linkage.position_with(crank_angle, assembly))
            }
            CrankLinkage::MultiLoop(linkage) => {
                let bodies = linkage.with_assembly(assembly).bodies(crank_angle)?;
                let traced = linkage.chain_kind().traced();
                let joints = Joints {
                    crank_pin: bodies.origins[COUPLER],
                    follower_pin: bodies.place(COUPLER, Complex::new(linkage.dyads()[0].lengths[0], 0.0)),
                    coupler_point: bodies.place(traced, linkage.coupler_point()),
                };
                Some(LoopJoints { joints, coupler: bodies.directions[traced] })
            }
        }
    }

    /// Computes the places of all moving joints and of P at a crank angle in the given assembly, P the last; `None` if the loop
    /// is open.
    pub fn moving_with(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<Vec<Complex>> {
        if let CrankLinkage::MultiLoop(linkage) = self {
            let bodies = linkage.with_assembly(assembly).bodies(crank_angle)?;
            return Some(linkage.moving(&bodies).collect());
        }
        let Joints { crank_pin, follower_pin, coupler_point } =
            self.joints_with(crank_angle, assembly)?.joints;
        Some(vec![crank_pin, follower_pin, coupler_point])
    }

    /// Computes the angle of the output link at a position from the x axis, radians: of the follower of a four-bar, of the
    /// block of an inverted slider-crank, which turns with the coupler. `None` of a slider-crank, whose slider does not turn,
    /// and of a six-bar, of which no link is the output.
    pub fn output_angle(&self, at: &LoopJoints) -> Option<f64> {
        match self {
            CrankLinkage::FourBar(linkage) => Some((at.joints.follower_pin - linkage.follower_pivot()).arg()),
            CrankLinkage::SliderCrank(_) | CrankLinkage::MultiLoop(_) => None,
            CrankLinkage::InvertedSliderCrank(_) => Some(at.coupler.arg()),
        }
    }

    /// Computes the place of the slider at a position: of a slider-crank along its line, in the line's direction from the foot
    /// of the perpendicular from A; of an inverted one that of the block along the coupler's line from C. `None` of
    /// other kinds.
    pub fn slider_place(&self, at: &LoopJoints) -> Option<f64> {
        let Joints { crank_pin, follower_pin, .. } = at.joints;
        match self {
            CrankLinkage::FourBar(_) | CrankLinkage::MultiLoop(_) => None,
            CrankLinkage::SliderCrank(linkage) => {
                Some(dot(follower_pin - linkage.crank_pivot(), linkage.line_direction()))
            }
            CrankLinkage::InvertedSliderCrank(_) => {
                Some(dot(follower_pin - crank_pin, at.coupler) / at.coupler.norm())
            }
        }
    }
}

impl OnCircuit<CrankLinkage> {
    /// Computes the joints at a parameter; `None` if the loop is open.
    pub fn joints_at(&self, parameter: f64) -> Option<Joints> {
        let (crank_angle, assembly) = self.position_at(parameter);
        self.linkage.joints_with(crank_angle, assembly).map(|at| at.joints)
    }

    /// Computes the places of all moving joints and of P at a parameter, P the last; `None` if the loop is open.
    pub fn moving_at(&self, parameter: f64) -> Option<Vec<Complex>> {
        let (crank_angle, assembly) = self.position_at(parameter);
        self.linkage.moving_with(crank_angle, assembly)
    }
}
