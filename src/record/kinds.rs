//! The best linkage of each kind that was searched for, so that a reader sees what another dyad buys.

use super::Candidate;
use crate::mechanism::LinkageKind;
use serde::{Deserialize, Serialize};

/// The figures of the best linkage of one kind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct BestOfKind {
    /// The kind.
    pub kind: LinkageKind,
    /// Whether it is accepted.
    pub accepted: bool,
    /// Its rms error.
    pub rms: f64,
    /// Its largest error.
    pub max: f64,
    /// Its worst transmission angle, degrees.
    pub transmission_worst_deg: f64,
    /// The largest distance between two joints of one of its bodies.
    pub longest: f64,
}

impl BestOfKind {
    /// Returns the figures of a candidate.
    pub fn of(candidate: &Candidate) -> Self {
        BestOfKind {
            kind: candidate.linkage.kind(),
            accepted: candidate.accepted,
            rms: candidate.error.rms,
            max: candidate.error.max,
            transmission_worst_deg: candidate.transmission_deg.worst,
            longest: candidate.linkage.longest(),
        }
    }

    /// Returns the figures of the best candidate of each kind of a list in which the better ones come first, the simplest kind
    /// first.
    pub fn of_all<'c>(candidates: impl IntoIterator<Item = &'c Candidate>) -> Vec<Self> {
        let mut best: Vec<BestOfKind> = Vec::new();
        for candidate in candidates {
            let own = BestOfKind::of(candidate);
            match best.iter_mut().find(|known| known.kind == own.kind) {
                Some(known) if own.accepted && !known.accepted => *known = own,
                Some(_) => {}
                None => best.push(own),
            }
        }
        best.sort_by_key(|one| one.kind);
        best
    }
}
