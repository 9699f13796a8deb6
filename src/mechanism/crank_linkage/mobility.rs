//! Mobility of linkages: how far the input turns, on which circuits and branches.

use super::CrankLinkage;
use crate::mechanism::slider::SliderMobility;
use crate::mechanism::{AssemblyMode, Branch, Circuit, InputArc, InputRange, LinkageType, SliderLinkage};

/// Mobility of a linkage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopMobility {
    /// The type of a four-bar; `None` of other kinds, or if the links cannot be assembled.
    pub linkage_type: Option<LinkageType>,
    /// The length that is at least zero where a link turns fully: p + q - s - l of a four-bar, of other kinds the margin of
    /// the crank's own turn.
    pub margin: f64,
    /// The range of the input.
    pub input: InputRange,
    /// Whether the two circuits of a full turn meet in a flat position.
    pub change_point: bool,
}

impl LoopMobility {
    /// Returns whether the crank turns fully, so that a motor can drive it; never of a change point among four-bars.
    pub fn input_turns_fully(&self) -> bool {
        self.linkage_type.map_or(self.input == InputRange::Full, LinkageType::input_turns_fully)
    }

    /// Returns the arc on which a circuit's input moves; `None` if it turns fully or cannot move.
    pub fn arc(&self, circuit: Circuit) -> Option<InputArc> {
        self.input.arc(circuit)
    }

    /// Returns the branch of a position that closes the loop.
    pub fn branch(&self, crank_angle: f64, assembly: AssemblyMode) -> Branch {
        self.input.branch(self.change_point, crank_angle, assembly)
    }
}

impl CrankLinkage {
    /// Computes type, margin and range of the input.
    pub fn mobility(&self) -> LoopMobility {
        let of_slider = |mobility: SliderMobility| LoopMobility {
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
}
