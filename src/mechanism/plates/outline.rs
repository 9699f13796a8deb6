//! The outline of a rounded hull: segments beside the sides, arcs about the corners.

use crate::mechanism::{Complex, cross, dot, turned};
use std::f64::consts::{PI, TAU};

/// An edge of an outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edge {
    /// A straight segment.
    Line {
        /// Start point.
        from: Complex,
        /// End point.
        to: Complex,
    },
    /// A circular arc.
    Arc {
        /// Start point.
        from: Complex,
        /// End point.
        to: Complex,
        /// Centre of the arc.
        centre: Complex,
        /// Angle of the arc, in radians, counter-clockwise, in (0, pi].
        turn: f64,
    },
}

impl Edge {
    /// Returns the start point.
    pub fn from(&self) -> Complex {
        match *self {
            Edge::Line { from, .. } | Edge::Arc { from, .. } => from,
        }
    }

    /// Returns the bulge of drawing files: tan(turn/4), 0 for a segment.
    pub fn bulge(&self) -> f64 {
        match self {
            Edge::Line { .. } => 0.0,
            Edge::Arc { turn, .. } => (turn / 4.0).tan(),
        }
    }

    /// Returns the same edge moved to a placement.
    #[must_use]
    pub fn placed(&self, at: &super::Placement) -> Edge {
        match *self {
            Edge::Line { from, to } => Edge::Line { from: at.of(from), to: at.of(to) },
            Edge::Arc { from, to, centre, turn } => {
                Edge::Arc { from: at.of(from), to: at.of(to), centre: at.of(centre), turn }
            }
        }
    }
}

/// Computes the edges around a hull's corners (counter-clockwise, one or more) at distance r; none for r = 0 about a
/// point.
pub(super) fn outline(corners: &[Complex], radius: f64) -> Vec<Edge> {
    if let [centre] = *corners {
        if radius == 0.0 {
            return Vec::new();
        }
        let (east, west) = (centre + radius, centre - radius);
        return vec![
            Edge::Arc { from: east, to: west, centre, turn: PI },
            Edge::Arc { from: west, to: east, centre, turn: PI },
        ];
    }
    let n = corners.len();
    // The outward normal of the side from corner i to the next.
    let normal = |i: usize| {
        let along = corners[(i + 1) % n] - corners[i];
        -turned(along / along.norm())
    };
    let mut edges = Vec::with_capacity(2 * n);
    for i in 0..n {
        let (here, next) = (normal(i), normal((i + 1) % n));
        let corner = corners[(i + 1) % n];
        let (from, to) = (corners[i] + here * radius, corner + here * radius);
        edges.push(Edge::Line { from, to });
        if radius > 0.0 {
            let turn = cross(here, next).atan2(dot(here, next));
            let turn = if turn > 0.0 { turn } else { turn + TAU };
            edges.push(Edge::Arc { from: to, to: corner + next * radius, centre: corner, turn });
        }
    }
    edges
}
