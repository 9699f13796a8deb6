//! Reasons why a balance is refused.

use crate::mechanism::loads::LoadError;

/// A balance that cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum BalanceError {
    /// A load, an end of the spring or a body does not fit the linkage.
    #[error("{0}; {remedy}", remedy = .0.fault.remedy())]
    Load(#[from] LoadError),
    /// The linkage is open or at a toggle within the range.
    #[error(
        "at a crank angle of {crank_deg:.4} degrees the linkage is open or at a toggle: give a range without it"
    )]
    NotClosed {
        /// The crank angle.
        crank_deg: f64,
    },
    /// The range of crank angles is empty, or wider than a turn.
    #[error("the range of crank angles has to be wider than 0 and at most 360 degrees: give two angles")]
    BadRange,
    /// The crank needs no torque.
    #[error("the crank needs no torque there without a balance: give loads, such as gravity and masses")]
    NothingToBalance,
    /// No spring between these places lessens the torque.
    #[error(
        "no spring between these places lessens the torque: choose other places, or a range on one side of its dead centre"
    )]
    NoSpringHelps,
    /// The bodies of a torsion spring turn further against each other than its moment is defined.
    #[error(
        "the two bodies turn a full turn against each other in the range, too far for a torsion spring: give a smaller one"
    )]
    TurnsTooFar,
    /// A rate is not positive, or a length is negative.
    #[error("{what} = {value} is not allowed: write a number {must}")]
    BadNumber {
        /// The number.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The rule.
        must: &'static str,
    },
    /// A crank that does not turn fully.
    #[error(
        "counter-masses are chosen over a full turn, and this crank does not turn fully: balance it by a spring"
    )]
    NoFullTurn,
    /// A body without a fixed pivot.
    #[error(
        "{name} does not turn about a fixed pivot, where a counter-mass would not be carried: {known} do"
    )]
    NotPivoted {
        /// The body.
        name: String,
        /// The bodies that do.
        known: String,
    },
    /// No body is named, or one is named twice.
    #[error("name one body or several, each once")]
    BadBodies,
    /// No counter-mass is any use.
    #[error(
        "no counter-mass at this radius lessens what is to be balanced: give another body, radius or aim"
    )]
    NoMassHelps,
}
