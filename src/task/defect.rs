//! Defects of a motion through target points: order, branch, circuit.

use serde::{Deserialize, Serialize};

/// The step of the circuit's parameter (radians) below which it counts as no step: two points may share a position.
pub const ORDER_TOLERANCE: f64 = 1e-9;

/// A defect of a motion through the points, with the points at which it occurs (counted from 0).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Defect {
    /// The points are not passed in their order.
    Order {
        /// The points at which the motion would have to jump back; `[0]` where it returns to its first point only
        /// through all others in reverse.
        at: Vec<usize>,
    },
    /// The motion passes a toggle.
    Branch {
        /// The points on another branch than point 0, or reached only by way of one.
        at: Vec<usize>,
    },
    /// The linkage would have to be taken apart, or turned where it does not close.
    Circuit {
        /// The points that cannot be reached from point 0.
        at: Vec<usize>,
    },
}

impl Defect {
    /// Returns the defect of a motion that returns to its first point only by reversing.
    pub fn to_and_fro() -> Defect {
        Defect::Order { at: vec![0] }
    }

    /// Returns whether the motion runs through its points in order, and returns to the first only by reversing.
    pub fn is_to_and_fro(&self) -> bool {
        *self == Defect::to_and_fro()
    }

    /// Returns its name: order, branch or circuit.
    pub fn name(&self) -> &'static str {
        match self {
            Defect::Order { .. } => "order",
            Defect::Branch { .. } => "branch",
            Defect::Circuit { .. } => "circuit",
        }
    }

    /// Returns the points at which it occurs, counted from 0.
    pub fn at(&self) -> &[usize] {
        match self {
            Defect::Order { at } | Defect::Branch { at } | Defect::Circuit { at } => at,
        }
    }
}
