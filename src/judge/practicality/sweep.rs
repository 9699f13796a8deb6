//! Sweep: the motion of a linkage as stretches (intervals of crank angles), with bounds of the joints' displacements
//! within one, which each kind of linkage gives ([`plates`](crate::mechanism::plates)).

use crate::judge::referee::UsedMotion;
use crate::mechanism::plates::parts;
pub use crate::mechanism::plates::{Position, Reach, Stretch};
use crate::mechanism::{AssemblyMode, CrankLinkage, InputArc, InputRange, LoopJoints};
use std::cell::RefCell;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// The most positions that are kept, half a kilobyte each.
const MOST_KNOWN: usize = 50_000;

/// A linkage with its motion as stretches.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The linkage.
    pub linkage: CrankLinkage,
    /// The stretches, which together are the motion.
    pub stretches: Vec<Stretch>,
    /// Whether the crank turns fully.
    pub full_turn: bool,
}

impl Sweep {
    /// Returns the whole motion of a linkage by itself without passing a toggle: the full turn, or the arc of the crank (of
    /// two arcs the first, of a four-bar the one to the left of A -> B) with the linkage's own assembly mode; `None` if it
    /// cannot be assembled, and of a six-bar or an eight-bar whose crank does not turn fully.
    pub fn of_linkage(linkage: impl Into<CrankLinkage>) -> Option<Self> {
        let linkage = linkage.into();
        let input = linkage.mobility().input;
        let [from, to] = match input {
            InputRange::None => return None,
            InputRange::Full => [linkage.ground_angle(), linkage.ground_angle() + TAU],
            InputRange::One(arc) | InputRange::Two([arc, _]) => arc.ends(),
        };
        let stretches = vec![Stretch { from, to, assembly: linkage.assembly() }];
        Some(Sweep { linkage, stretches, full_turn: input == InputRange::Full })
    }

    /// Returns the motion through the points of a task. With `cycle` it is all of the circuit: the full turn, or both
    /// branches of a rocking crank.
    pub fn of_motion(motion: &UsedMotion, cycle: bool) -> Self {
        let linkage = motion.on.linkage;
        let [low, high] = motion.range;
        let high = if cycle { low + TAU } else { high };
        let full_turn = motion.on.arc.is_none() && high - low >= TAU;
        let to = if full_turn { low + TAU } else { high };
        let stretches = match motion.on.arc {
            Some(arc) => split(&arc, low, high),
            None => vec![Stretch { from: low, to, assembly: linkage.assembly() }],
        };
        Sweep { linkage, stretches, full_turn }
    }

    /// Computes the joints in the middle of a stretch and the bounds of their distances from there; `None` if the loop
    /// is open.
    pub fn reach(&self, stretch: &Stretch) -> Option<(LoopJoints, Reach)> {
        parts::reach(&self.linkage, stretch)
    }
}

/// The positions in the middle of stretches of a sweep with their bounds: each is computed once, for many distances.
#[derive(Debug)]
pub struct Positions<'a> {
    /// The sweep.
    pub sweep: &'a Sweep,
    known: RefCell<HashMap<[u64; 3], (Position, Reach)>>,
}

impl<'a> Positions<'a> {
    /// Returns the positions of a sweep, of which none is computed yet.
    pub fn of(sweep: &'a Sweep) -> Self {
        Positions { sweep, known: RefCell::default() }
    }

    /// Returns the position in the middle of a stretch with the bounds within it; `None` if the loop is open.
    pub fn middle_of(&self, stretch: &Stretch) -> Option<(Position, Reach)> {
        // A rocking crank passes the same angles in either assembly.
        let is_plus = u64::from(stretch.assembly == AssemblyMode::Plus);
        let key = [stretch.from.to_bits(), stretch.to.to_bits(), is_plus];
        if let Some(known) = self.known.borrow().get(&key) {
            return Some(*known);
        }
        let (at, reach) = self.sweep.reach(stretch)?;
        let found = (Position::new(&self.sweep.linkage, at), reach);
        let mut known = self.known.borrow_mut();
        if known.len() < MOST_KNOWN {
            known.insert(key, found);
        }
        Some(found)
    }

    /// Returns the position at a crank angle; `None` if the loop is open.
    pub fn at(&self, crank_angle: f64, assembly: AssemblyMode) -> Option<Position> {
        let at = self.sweep.linkage.joints_with(crank_angle, assembly)?;
        Some(Position::new(&self.sweep.linkage, at))
    }
}

/// Splits the crank angles between two values of psi at the toggles that psi passes.
fn split(arc: &InputArc, low: f64, high: f64) -> Vec<Stretch> {
    let mut cuts = vec![low];
    let mut toggle = FRAC_PI_2 + PI * ((low - FRAC_PI_2) / PI).floor() + PI;
    while toggle < high {
        cuts.push(toggle);
        toggle += PI;
    }
    cuts.push(high);
    let stretch = |w: &[f64]| {
        let (one, other) = (arc.crank_angle(w[0]), arc.crank_angle(w[1]));
        let assembly = AssemblyMode::of((0.5 * (w[0] + w[1])).cos());
        Stretch { from: one.min(other), to: one.max(other), assembly }
    };
    cuts.windows(2).map(stretch).collect()
}
