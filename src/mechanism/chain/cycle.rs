//! Whole cycles of a chain: the range of its input, and the path of a point.

use super::{Chain, PointId, Pose};
use crate::mechanism::Complex;
use std::f64::consts::TAU;

/// An interval of crank angles at which every stage closes, between two angles at which one opens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChainArc {
    /// The first crank angle, radians in [0, 2 pi).
    pub from: f64,
    /// The last crank angle, radians, above `from` and less than a turn from it.
    pub to: f64,
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
        let closes: Vec<bool> = (0..n).map(|i| self.position(angle(i), &mut pose).is_closed()).collect();
        let Some(first_open) = closes.iter().position(|closes| !closes) else { return ChainInput::Full };
        let mut arcs = Vec::new();
        let mut begun = None;
        for i in first_open..first_open + n {
            let (here, next) = (angle(i), angle(i + 1));
            match (closes[i % n], closes[(i + 1) % n]) {
                (false, true) => begun = Some(self.edge([next, here], &mut pose)),
                (true, false) => {
                    if let Some(from) = begun.take() {
                        let to = self.edge([here, next], &mut pose);
                        let turns = (from / TAU).floor() * TAU;
                        arcs.push(ChainArc { from: from - turns, to: to - turns });
                    }
                }
                _ => {}
            }
        }
        arcs.sort_by(|x, y| x.from.total_cmp(&y.from));
        if arcs.is_empty() { ChainInput::Never } else { ChainInput::Arcs(arcs) }
    }

    /// Finds the last closed angle on the way from a closed to an open one.
    fn edge(&self, [mut closed, mut open]: [f64; 2], pose: &mut Pose) -> f64 {
        /// Number of halvings, which reduce a step of at most 45 degrees to below rounding.
        const HALVINGS: usize = 60;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (closed + open);
            if self.position(middle, pose).is_closed() {
                closed = middle;
            } else {
                open = middle;
            }
        }
        closed
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
