//! Mobility of linkages: how far the input turns, on which circuits and branches.

use crate::mechanism::{AssemblyMode, Branch, Circuit, InputArc, InputRange, LinkageType};

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
