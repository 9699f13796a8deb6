//! Whether the crank turns fully, and the circuits, branches and toggles of a linkage with a slider.
//!
//! The crank turns fully where the margin of a kind is at least zero: b - a - |Im((A - Q) conj s)| of a slider-crank,
//! ||AB| - a| - |h| of an inverted one. Then t1 tells two circuits of one branch each; else each arc of crank angles at
//! which the loop closes is a circuit of two branches, told by t1, with a toggle at either end. Circuits and branches are
//! those of T. R. Chase and J. A. Mirth (1993).

use crate::mechanism::four_bar::mobility::CHANGE_POINT_TOLERANCE;
use crate::mechanism::{AssemblyMode, Branch, Circuit, InputArc, InputRange, Toggle};

/// Mobility of a linkage with a slider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SliderMobility {
    /// The crank turns fully if this length is at least zero.
    pub full_turn_margin: f64,
    /// Whether the margin is zero within [`CHANGE_POINT_TOLERANCE`] of the largest length: the two circuits of a full
    /// turn then meet in a flat position.
    pub change_point: bool,
    /// The range of the input.
    pub input: InputRange,
}

impl SliderMobility {
    /// Returns the mobility with a margin, the largest length of the closure and the range of the input.
    pub(in crate::mechanism) fn new(full_turn_margin: f64, scale: f64, input: InputRange) -> Self {
        let change_point =
            input == InputRange::Full && full_turn_margin.abs() <= CHANGE_POINT_TOLERANCE * scale;
        SliderMobility { full_turn_margin, change_point, input }
    }

    /// Returns whether the crank turns fully.
    pub fn input_turns_fully(&self) -> bool {
        self.input == InputRange::Full
    }

    /// Returns the number of circuits.
    pub fn circuits(&self) -> u8 {
        self.input.circuits(self.change_point)
    }

    /// Returns the number of branches of each circuit.
    pub fn branches_per_circuit(&self) -> u8 {
        self.input.branches_per_circuit(self.change_point)
    }

    /// Returns the arc on which a circuit's input moves; `None` if it turns fully or cannot move.
    pub fn arc(&self, circuit: Circuit) -> Option<InputArc> {
        self.input.arc(circuit)
    }

    /// Returns the branch of a position that closes the loop.
    pub fn branch(&self, crank_angle: f64, assembly: AssemblyMode) -> Branch {
        self.input.branch(self.change_point, crank_angle, assembly)
    }

    /// Returns the toggles, at each of which two branches of a circuit meet; none if the crank turns fully.
    pub fn toggles(&self) -> Vec<Toggle> {
        self.input.toggles()
    }
}
