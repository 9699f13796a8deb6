//! Whole cycles of a chain: the range of its input, and the path of a point.

use super::{Chain, Outcome, PointId, Pose};
use crate::mechanism::Complex;
use std::f64::consts::TAU;

/// An interval of crank angles at which every stage closes, between two angles at which one opens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainArc {
    /// The first crank angle, radians in [0, 2 pi).
    pub from: f64,
    /// The last crank angle, radians, above `from` and less than a turn from it.
    pub to: f64,
    /// The stage that has no position just before `from`.
    pub limited_before: usize,
    /// The stage that has no position just after `to`.
    pub limited_after: usize,
}

/// The range of a chain's input with the assembly signs that it has.
#[derive(Clone, Debug, PartialEq)]
pub enum ChainInput {
    /// The full turn: every sample closes.
    Full,
    /// The arcs on which the chain closes, in the order of their first angle.
    Arcs(Vec<ChainArc>),
    /// No position: no sample closes.
    Never,
}

impl ChainInput {
    /// Returns whether the crank turns fully, so that a motor can drive it.
    pub fn is_full(&self) -> bool {
        *self == ChainInput::Full
    }
}

impl Chain {
    /// Finds the crank angles at which the chain closes from `samples` (at least 8) evenly over a turn; each end of an
    /// arc is then bisected down to the rounding of an angle.
    ///
    /// A gap or an arc that lies between two samples is missed: it is a search, not a proof. A stage that is
    /// singular counts as open.
    pub fn input(&self, samples: usize) -> ChainInput {
        let n = samples.max(8);
        let mut pose = self.pose();
        let angle = |i: usize| TAU * i as f64 / n as f64;
        let stuck: Vec<Option<usize>> = (0..n).map(|i| self.stuck_at(angle(i), &mut pose)).collect();
        let Some(first_open) = stuck.iter().position(Option::is_some) else { return ChainInput::Full };
        let mut arcs = Vec::new();
        let mut begun = None;
        for i in first_open..first_open + n {
            let (here, next) = (stuck[i % n], stuck[(i + 1) % n]);
            let between = [angle(i), angle(i + 1)];
            match (here, next) {
                (Some(_), None) => begun = Some(self.edge([between[1], between[0]], &mut pose)),
                (None, Some(_)) => {
                    if let Some((from, limited_before)) = begun.take() {
                        let (to, limited_after) = self.edge(between, &mut pose);
                        let turns = (from / TAU).floor() * TAU;
                        let (from, to) = (from - turns, to - turns);
                        arcs.push(ChainArc { from, to, limited_before, limited_after });
                    }
                }
                _ => {}
            }
        }
        arcs.sort_by(|x, y| x.from.total_cmp(&y.from));
        if arcs.is_empty() { ChainInput::Never } else { ChainInput::Arcs(arcs) }
    }

    /// Returns the stage that has no position at a crank angle.
    fn stuck_at(&self, angle: f64, pose: &mut Pose) -> Option<usize> {
        match self.position(angle, pose) {
            Outcome::Closed => None,
            other => other.stage().or(Some(0)),
        }
    }

    /// Finds the last closed angle on the way from a closed to an open one, and the stage that opens there.
    fn edge(&self, [mut closed, mut open]: [f64; 2], pose: &mut Pose) -> (f64, usize) {
        /// Number of halvings, which reduce a step of at most 45 degrees to below rounding.
        const HALVINGS: usize = 60;
        let mut stage = self.stuck_at(open, pose).unwrap_or(0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (closed + open);
            match self.stuck_at(middle, pose) {
                None => closed = middle,
                Some(stuck) => (open, stage) = (middle, stuck),
            }
        }
        (closed, stage)
    }

    /// Computes the path of a point over a full turn: N at phi = 2 pi i / samples; `None` if it is not known.
    pub fn path(&self, point: PointId, samples: usize) -> Vec<Option<Complex>> {
        let mut pose = self.pose();
        (0..samples)
            .map(|i| {
                self.position(TAU * i as f64 / samples as f64, &mut pose);
                pose.point(point)
            })
            .collect()
    }
}
