//! Linkages that a crank drives, of the kinds that synthesis finds, behind one type: four-bar, slider-crank, inverted
//! slider-crank, and six-bars and eight-bars.
//!
//! The first three have one loop: C = A + a e^{i phi}, a coupler through C that carries P, and one closure with two roots, told by
//! t1; see [`slider`](super::slider). A four-bar's numbers are those of [`FourBar`], to the last digit. Six-bars and eight-bars
//! ([`MultiLoop`]) have a sign for each dyad; t1 is that of the first, and the others are part of the linkage.

mod keys;
mod kind;
mod mobility;

pub use keys::{LinkageKeys, NoLinkage};
pub use kind::LinkageKind;
pub use mobility::LoopMobility;

use super::any::Mechanism;
use super::dyad_chain::kinds::COUPLER;
use super::four_bar::coupler_curve::SingleLoop;
use super::four_bar::transmission::TransmissionExtremes;
use super::{
    AssemblyMode, Complex, FourBar, InputArc, InputRange, InvertedSliderCrank, InvertedSliderCrankParameters,
    Joints, LinkageError, LinkageType, MultiLoop, NaturalCoordinates, OnCircuit, SliderCrank,
    SliderCrankParameters, SliderJoints, SliderLinkage, SliderPosition, dot, least_and_greatest, xy,
};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A linkage that a crank drives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CrankLinkage {
    /// A four-bar.
    FourBar(FourBar),
    /// A slider-crank.
    SliderCrank(SliderCrank),
    /// An inverted slider-crank.
    InvertedSliderCrank(InvertedSliderCrank),
    /// A six-bar or an eight-bar.
    MultiLoop(MultiLoop),
}

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
    /// Returns the kind.
    pub fn kind(&self) -> LinkageKind {
        match self {
            CrankLinkage::FourBar(_) => LinkageKind::FourBar,
            CrankLinkage::SliderCrank(_) => LinkageKind::SliderCrank,
            CrankLinkage::InvertedSliderCrank(_) => LinkageKind::InvertedSliderCrank,
            CrankLinkage::MultiLoop(linkage) if linkage.dyad_count() > 2 => LinkageKind::EightBar,
            CrankLinkage::MultiLoop(_) => LinkageKind::SixBar,
        }
    }

    /// Returns the four-bar, if it is one.
    pub fn four_bar(&self) -> Option<&FourBar> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage),
            _ => None,
        }
    }

    /// Returns the six-bar or eight-bar, if it is one.
    pub fn multi_loop(&self) -> Option<&MultiLoop> {
        match self {
            CrankLinkage::MultiLoop(linkage) => Some(linkage),
            _ => None,
        }
    }

    /// Returns the slider-crank, if it is one.
    pub fn slider_crank(&self) -> Option<&SliderCrank> {
        match self {
            CrankLinkage::SliderCrank(linkage) => Some(linkage),
            _ => None,
        }
    }

    /// Returns the inverted slider-crank, if it is one.
    pub fn inverted_slider_crank(&self) -> Option<&InvertedSliderCrank> {
        match self {
            CrankLinkage::InvertedSliderCrank(linkage) => Some(linkage),
            _ => None,
        }
    }

    /// Returns the linkage as a mechanism of any kind.
    pub fn mechanism(&self) -> &dyn Mechanism {
        match self {
            CrankLinkage::FourBar(linkage) => linkage,
            CrankLinkage::SliderCrank(linkage) => linkage,
            CrankLinkage::InvertedSliderCrank(linkage) => linkage,
            CrankLinkage::MultiLoop(linkage) => linkage,
        }
    }

    /// Returns the same linkage with the given sign of the closure's root.
    #[must_use]
    pub fn with_assembly(self, assembly: AssemblyMode) -> Self {
        SingleLoop::with_assembly(self, assembly)
    }

    /// Returns t1, the sign of the closure's root.
    pub fn assembly(&self) -> AssemblyMode {
        SingleLoop::assembly(self)
    }

    /// Returns A, the fixed pivot of the crank.
    pub fn crank_pivot(&self) -> Complex {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.crank_pivot(),
            CrankLinkage::SliderCrank(linkage) => linkage.crank_pivot(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.crank_pivot(),
            CrankLinkage::MultiLoop(linkage) => linkage.crank_pivot(),
        }
    }

    /// Returns the second fixed pivot B, of the follower or of the block; a slider-crank has none.
    pub fn second_pivot(&self) -> Option<Complex> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage.follower_pivot()),
            CrankLinkage::SliderCrank(_) => None,
            CrankLinkage::InvertedSliderCrank(linkage) => Some(linkage.block_pivot()),
            CrankLinkage::MultiLoop(linkage) => Some(linkage.follower_pivot()),
        }
    }

    /// Returns the fixed pivots.
    pub fn pivots(&self) -> impl Iterator<Item = Complex> + use<> {
        let of_one_loop = || std::iter::once(self.crank_pivot()).chain(self.second_pivot()).collect();
        self.multi_loop().map_or_else(of_one_loop, MultiLoop::pivots).into_iter()
    }

    /// Returns a = |AC|, the length of the crank.
    pub fn crank(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.crank(),
            CrankLinkage::SliderCrank(linkage) => linkage.crank(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.crank(),
            CrankLinkage::MultiLoop(linkage) => linkage.crank(),
        }
    }

    /// Returns P along and across the coupler from C, as lengths; of a six-bar along and across the line of its body
    /// ([`multi_loop`](super::multi_loop)).
    pub fn coupler_offset(&self) -> Complex {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.coupler_offset(),
            CrankLinkage::SliderCrank(linkage) => linkage.coupler_offset(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.coupler_offset(),
            CrankLinkage::MultiLoop(linkage) => linkage.coupler_point(),
        }
    }

    /// Returns the direction from which crank angles of `offset = "ground"` count: of the line A -> B, or of the slider's
    /// line; 0 for coincident pivots.
    pub fn ground_angle(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.ground_angle(),
            CrankLinkage::SliderCrank(linkage) => linkage.line_angle(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.ground_angle(),
            CrankLinkage::MultiLoop(linkage) => (linkage.follower_pivot() - linkage.crank_pivot()).arg(),
        }
    }

    /// Returns the ratio of the longest to the shortest link: of ground, a, b, c of a four-bar, a and b of a slider-crank,
    /// ground and a of an inverted one, all distances between joints of one body of a six-bar. Infinite for coincident
    /// pivots.
    pub fn link_ratio(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.link_ratio(),
            CrankLinkage::SliderCrank(linkage) => linkage.link_ratio(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.link_ratio(),
            CrankLinkage::MultiLoop(linkage) => linkage.link_ratio(),
        }
    }

    /// Returns the longest link, of those whose ratio [`CrankLinkage::link_ratio`] is.
    pub fn longest_link(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.longest_link(),
            CrankLinkage::SliderCrank(linkage) => linkage.crank().max(linkage.coupler()),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.crank().max(linkage.ground()),
            CrankLinkage::MultiLoop(linkage) => linkage.longest_link(),
        }
    }

    /// Returns b = |CD|, the length of the coupler; that of an inverted slider-crank slides through its block.
    pub fn coupler(&self) -> Option<f64> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage.coupler()),
            CrankLinkage::SliderCrank(linkage) => Some(linkage.coupler()),
            CrankLinkage::InvertedSliderCrank(_) => None,
            CrankLinkage::MultiLoop(linkage) => Some(linkage.dyads()[0].lengths[0]),
        }
    }

    /// Returns |AB|, the distance of the fixed pivots; a slider-crank has one pivot.
    pub fn ground(&self) -> Option<f64> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage.ground()),
            CrankLinkage::SliderCrank(_) => None,
            CrankLinkage::InvertedSliderCrank(linkage) => Some(linkage.ground()),
            CrankLinkage::MultiLoop(linkage) => {
                Some((linkage.follower_pivot() - linkage.crank_pivot()).norm())
            }
        }
    }

    /// Returns e = |DP|; `None` of an inverted slider-crank, whose D moves along the coupler, and of a
    /// six-bar, whose P lies on another link.
    pub fn second_side(&self) -> Option<f64> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage.follower_side()),
            CrankLinkage::SliderCrank(linkage) => Some((linkage.coupler_offset() - linkage.coupler()).norm()),
            CrankLinkage::InvertedSliderCrank(_) | CrankLinkage::MultiLoop(_) => None,
        }
    }

    /// Returns |CP|, the distance from the crank pin to the coupler point; of a six-bar that of P from the
    /// first joint of its body's line.
    pub fn crank_side(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.crank_side(),
            CrankLinkage::SliderCrank(linkage) => linkage.coupler_offset().norm(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.coupler_offset().norm(),
            CrankLinkage::MultiLoop(linkage) => linkage.coupler_point().norm(),
        }
    }

    /// Returns the largest distance between two joints of one body, P and pivots included; a rail does not count.
    pub fn longest(&self) -> f64 {
        match self {
            CrankLinkage::FourBar(linkage) => {
                linkage.longest_link().max(linkage.crank_side()).max(linkage.follower_side())
            }
            CrankLinkage::SliderCrank(linkage) => linkage.longest(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.longest(),
            CrankLinkage::MultiLoop(linkage) => linkage.longest(),
        }
    }

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

    /// Computes the transmission angle at a crank angle, radians, of a six-bar that of the dyad nearest to flat; of a four-bar the
    /// nearest flat angle, 0 or pi, if the loop is open, of other kinds 0.
    pub fn transmission_at(&self, crank_angle: f64) -> f64 {
        let crank = || Complex::from_polar(1.0, crank_angle);
        match self {
            CrankLinkage::FourBar(linkage) => linkage.angle_at_follower_pin(crank_angle),
            CrankLinkage::SliderCrank(linkage) => linkage.transmission_toward(crank()),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.transmission_toward(crank()),
            CrankLinkage::MultiLoop(linkage) => linkage.transmission_at(crank_angle),
        }
    }

    /// Computes type, margin and range of the input.
    pub fn mobility(&self) -> LoopMobility {
        let of_slider = |mobility: super::slider::SliderMobility| LoopMobility {
            linkage_type: None,
            margin: mobility.full_turn_margin,
            input: mobility.input,
            change_point: mobility.change_point,
        };
        match self {
            CrankLinkage::FourBar(linkage) => {
                let mobility = linkage.mobility();
                LoopMobility {
                    linkage_type: mobility.linkage_type,
                    margin: mobility.grashof_margin,
                    input: mobility.input,
                    change_point: mobility.linkage_type == Some(LinkageType::ChangePoint),
                }
            }
            CrankLinkage::SliderCrank(linkage) => of_slider(linkage.mobility()),
            CrankLinkage::InvertedSliderCrank(linkage) => of_slider(linkage.mobility()),
            CrankLinkage::MultiLoop(linkage) => {
                // One that does not turn fully cannot be driven by a motor.
                let margin = linkage.full_turn_margin();
                let input = if margin > 0.0 { InputRange::Full } else { InputRange::None };
                LoopMobility { linkage_type: None, margin, input, change_point: false }
            }
        }
    }

    /// Computes the extremes of the transmission angle over the range of the crank; `None` without a position.
    pub fn transmission_over_cycle(&self) -> Option<TransmissionExtremes> {
        match self {
            CrankLinkage::FourBar(linkage) => Some(linkage.transmission_over_cycle()),
            CrankLinkage::SliderCrank(linkage) => linkage.transmission_over_range(),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.transmission_over_range(),
            CrankLinkage::MultiLoop(linkage) => Some(linkage.transmission_between([0.0, TAU])),
        }
    }

    /// Returns its numbers, by which equals are ordered: those of its keys, as many as there are.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.natural_coordinates().numbers().to_vec(),
            CrankLinkage::SliderCrank(linkage) => {
                let p = linkage.parameters();
                let ([ax, ay], [qx, qy]) = (p.crank_pivot, p.line_point);
                vec![ax, ay, qx, qy, p.line_deg, p.crank, p.coupler, p.coupler_x, p.coupler_y]
            }
            CrankLinkage::InvertedSliderCrank(linkage) => {
                let p = linkage.parameters();
                let ([ax, ay], [bx, by]) = (p.crank_pivot, p.block_pivot);
                vec![ax, ay, bx, by, p.crank, p.offset, p.coupler_x, p.coupler_y]
            }
            CrankLinkage::MultiLoop(linkage) => linkage.numbers(),
        }
    }

    /// Returns the image p -> shift + turn p of the linkage, of its mirror image in the x axis if it is to be mirrored.
    ///
    /// # Errors
    /// If a coordinate leaves the allowed range.
    pub fn carried(&self, mirrors: bool, turn: Complex, shift: Complex) -> Result<Self, LinkageError> {
        let place = |[x, y]: [f64; 2]| xy(shift + turn * Complex::new(x, if mirrors { -y } else { y }));
        let sign = if mirrors { -1.0 } else { 1.0 };
        Ok(match self {
            CrankLinkage::FourBar(linkage) => {
                let own = linkage.natural_coordinates();
                CrankLinkage::FourBar(FourBar::new(NaturalCoordinates {
                    crank_pivot: place(own.crank_pivot),
                    follower_pivot: place(own.follower_pivot),
                    assembly: self.carried_assembly(mirrors, own.assembly),
                    side: if mirrors { own.side.opposite() } else { own.side },
                    ..own
                })?)
            }
            CrankLinkage::SliderCrank(linkage) => {
                let own = linkage.parameters();
                CrankLinkage::SliderCrank(SliderCrank::new(SliderCrankParameters {
                    crank_pivot: place(own.crank_pivot),
                    line_point: place(own.line_point),
                    line_deg: turn.arg().to_degrees() + sign * own.line_deg,
                    coupler_y: sign * own.coupler_y,
                    ..own
                })?)
            }
            CrankLinkage::InvertedSliderCrank(linkage) => {
                let own = linkage.parameters();
                CrankLinkage::InvertedSliderCrank(InvertedSliderCrank::new(InvertedSliderCrankParameters {
                    crank_pivot: place(own.crank_pivot),
                    block_pivot: place(own.block_pivot),
                    offset: sign * own.offset,
                    coupler_y: sign * own.coupler_y,
                    ..own
                })?)
            }
            CrankLinkage::MultiLoop(linkage) => {
                CrankLinkage::MultiLoop(linkage.carried(mirrors, turn, shift)?)
            }
        })
    }

    /// Returns the assembly that an assembly becomes in the image: the mirror image of a four-bar and of a six-bar has the
    /// other one, a slider's the same.
    pub fn carried_assembly(&self, mirrors: bool, assembly: AssemblyMode) -> AssemblyMode {
        if mirrors && (self.four_bar().is_some() || self.multi_loop().is_some()) {
            assembly.opposite()
        } else {
            assembly
        }
    }

    /// Returns the linkage moved by the vector `by`.
    ///
    /// # Errors
    /// If a coordinate leaves the allowed range.
    pub fn shifted(&self, by: Complex) -> Result<Self, LinkageError> {
        Ok(match self {
            CrankLinkage::FourBar(linkage) => CrankLinkage::FourBar(linkage.shifted(by)?),
            CrankLinkage::SliderCrank(linkage) => CrankLinkage::SliderCrank(linkage.shifted(by)?),
            CrankLinkage::InvertedSliderCrank(linkage) => {
                CrankLinkage::InvertedSliderCrank(linkage.shifted(by)?)
            }
            CrankLinkage::MultiLoop(linkage) => {
                CrankLinkage::MultiLoop(linkage.carried(false, Complex::new(1.0, 0.0), by)?)
            }
        })
    }

    /// Returns the linkage with every length and coordinate multiplied by a factor.
    ///
    /// # Errors
    /// If a length leaves the allowed range.
    pub fn scaled(&self, factor: f64) -> Result<Self, LinkageError> {
        Ok(match self {
            CrankLinkage::FourBar(linkage) => CrankLinkage::FourBar(linkage.scaled(factor)?),
            CrankLinkage::SliderCrank(linkage) => CrankLinkage::SliderCrank(linkage.scaled(factor)?),
            CrankLinkage::InvertedSliderCrank(linkage) => {
                CrankLinkage::InvertedSliderCrank(linkage.scaled(factor)?)
            }
            CrankLinkage::MultiLoop(linkage) => CrankLinkage::MultiLoop(linkage.scaled(factor)?),
        })
    }
}

impl SingleLoop for CrankLinkage {
    fn with_assembly(self, assembly: AssemblyMode) -> Self {
        match self {
            CrankLinkage::FourBar(linkage) => CrankLinkage::FourBar(linkage.with_assembly(assembly)),
            CrankLinkage::SliderCrank(linkage) => {
                CrankLinkage::SliderCrank(SliderLinkage::with_assembly(linkage, assembly))
            }
            CrankLinkage::InvertedSliderCrank(linkage) => {
                CrankLinkage::InvertedSliderCrank(SliderLinkage::with_assembly(linkage, assembly))
            }
            CrankLinkage::MultiLoop(linkage) => CrankLinkage::MultiLoop(linkage.with_assembly(assembly)),
        }
    }

    fn assembly(&self) -> AssemblyMode {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.assembly(),
            CrankLinkage::SliderCrank(linkage) => SliderLinkage::assembly(linkage),
            CrankLinkage::InvertedSliderCrank(linkage) => SliderLinkage::assembly(linkage),
            CrankLinkage::MultiLoop(linkage) => linkage.assembly(),
        }
    }

    fn coupler_point_with(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<Complex> {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.coupler_point_with(crank_angle, assembly),
            CrankLinkage::SliderCrank(linkage) => linkage.coupler_point_with(crank_angle, assembly),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.coupler_point_with(crank_angle, assembly),
            CrankLinkage::MultiLoop(linkage) => linkage.with_assembly(assembly).point_at(crank_angle),
        }
    }

    fn arc_of(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<InputArc> {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.arc_of(crank_angle, assembly),
            CrankLinkage::SliderCrank(linkage) => linkage.arc_of(crank_angle, assembly),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.arc_of(crank_angle, assembly),
            CrankLinkage::MultiLoop(_) => None,
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

    /// Computes the extremes of the transmission angle over an interval of the parameter, at most a whole turn, in closed
    /// form: they lie at its ends, at a toggle, and where the crank lies along the ground; of a slider at the
    /// [turning angles](SliderLinkage::transmission_turns) of its kind.
    pub fn transmission_between(&self, [low, high]: [f64; 2]) -> TransmissionExtremes {
        let inside = |t: &f64| low + (t - low).rem_euclid(TAU);
        match &self.linkage {
            CrankLinkage::FourBar(linkage) => {
                let ground = linkage.ground_angle();
                let extreme: &[f64] = if self.arc.is_some() {
                    &[0.0, FRAC_PI_2, PI, -FRAC_PI_2]
                } else {
                    &[ground, ground + PI]
                };
                let inside = extreme.iter().map(inside).filter(|t| *t <= high);
                let all = [low, high].into_iter().chain(inside);
                linkage.transmission_at(all.map(|t| linkage.diagonal(self.position_at(t).0)))
            }
            CrankLinkage::SliderCrank(linkage) => self.of_slider(linkage, [low, high]),
            CrankLinkage::InvertedSliderCrank(linkage) => self.of_slider(linkage, [low, high]),
            CrankLinkage::MultiLoop(linkage) => linkage.transmission_between([low, high]),
        }
    }

    fn of_slider<L: SliderLinkage>(&self, linkage: &L, [low, high]: [f64; 2]) -> TransmissionExtremes {
        let turns = linkage.transmission_turns();
        let extreme: Vec<f64> = match self.arc {
            None => turns.to_vec(),
            Some(arc) => {
                let on_arc = turns.into_iter().filter(|t| arc.offset(*t).abs() <= arc.half_width);
                let of_both =
                    |t: f64| [AssemblyMode::Plus, AssemblyMode::Minus].map(|sign| arc.parameter(t, sign));
                on_arc.flat_map(of_both).chain([FRAC_PI_2, -FRAC_PI_2]).collect()
            }
        };
        let inside = extreme.iter().map(|t| low + (t - low).rem_euclid(TAU)).filter(|t| *t <= high);
        let at = |t: f64| linkage.transmission_toward(Complex::from_polar(1.0, self.position_at(t).0));
        let [min, max] = least_and_greatest([low, high].into_iter().chain(inside).map(at));
        TransmissionExtremes { min, max }
    }
}

impl From<FourBar> for CrankLinkage {
    fn from(linkage: FourBar) -> Self {
        CrankLinkage::FourBar(linkage)
    }
}

impl From<&FourBar> for CrankLinkage {
    fn from(linkage: &FourBar) -> Self {
        CrankLinkage::FourBar(*linkage)
    }
}

impl From<SliderCrank> for CrankLinkage {
    fn from(linkage: SliderCrank) -> Self {
        CrankLinkage::SliderCrank(linkage)
    }
}

impl From<InvertedSliderCrank> for CrankLinkage {
    fn from(linkage: InvertedSliderCrank) -> Self {
        CrankLinkage::InvertedSliderCrank(linkage)
    }
}

impl From<MultiLoop> for CrankLinkage {
    fn from(linkage: MultiLoop) -> Self {
        CrankLinkage::MultiLoop(linkage)
    }
}

impl From<&CrankLinkage> for CrankLinkage {
    fn from(linkage: &CrankLinkage) -> Self {
        *linkage
    }
}

impl From<CrankLinkage> for super::Linkage {
    fn from(linkage: CrankLinkage) -> Self {
        match linkage {
            CrankLinkage::FourBar(linkage) => super::Linkage::FourBar(linkage),
            CrankLinkage::SliderCrank(linkage) => super::Linkage::SliderCrank(linkage),
            CrankLinkage::InvertedSliderCrank(linkage) => super::Linkage::InvertedSliderCrank(linkage),
            CrankLinkage::MultiLoop(linkage) => super::Linkage::MultiLoop(Box::new(linkage)),
        }
    }
}

impl std::fmt::Display for CrankLinkage {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            CrankLinkage::FourBar(linkage) => linkage.fmt(f),
            CrankLinkage::SliderCrank(linkage) => linkage.fmt(f),
            CrankLinkage::InvertedSliderCrank(linkage) => linkage.fmt(f),
            CrankLinkage::MultiLoop(linkage) => linkage.fmt(f),
        }
    }
}
