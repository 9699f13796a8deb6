//! States of a search between two islands, from which it can be resumed.
//!
//! A resumed search ends in the same digits as one that was never interrupted, and as one that was given the larger budget
//! from the beginning: islands that were cut short are no part of a state.

use super::answers::{DyadChainOutcome, End};
use super::fit::State;
use super::target::Variant;
use crate::mechanism::dyad_chain::{DyadChain, DyadChainKind, MAX_DYADS, MAX_PARAMETERS, Placement, Shape};
use crate::mechanism::{AssemblyMode, Complex};
use serde::{Deserialize, Serialize};

/// An end of a fit as data; its numbers are in the normalised coordinates of the target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct KeptEnd {
    /// Index of the kind among those that are searched.
    kind: usize,
    assembly: [AssemblyMode; MAX_DYADS],
    parameters: [f64; MAX_PARAMETERS],
    /// T, S and Z.
    linear: [[f64; 2]; 3],
    phases: Vec<f64>,
    value: f64,
    misfit: f64,
    reversed: bool,
    mirrored: bool,
    hits: u64,
}

/// The state of a search between two islands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DyadChainState {
    archive: Vec<KeptEnd>,
    of_kinds: Vec<KeptEnd>,
    next_stream: u64,
    evaluations: u64,
    draws: u64,
    ends: u64,
    islands: Vec<f64>,
}

/// The parts of a state as a search has them.
pub(super) struct Resumed {
    pub(super) archive: Vec<End>,
    pub(super) of_kinds: Vec<End>,
    pub(super) next_stream: u64,
    pub(super) done: DyadChainOutcome,
}

impl DyadChainState {
    /// Returns the state with these ends and counts.
    pub(super) fn of(
        kinds: &[DyadChainKind],
        [archive, of_kinds]: [&[&End]; 2],
        next_stream: u64,
        done: &DyadChainOutcome,
    ) -> Self {
        let kept = |ends: &[&End]| ends.iter().filter_map(|end| kept(end, kinds)).collect();
        DyadChainState {
            archive: kept(archive),
            of_kinds: kept(of_kinds),
            next_stream,
            evaluations: done.evaluations,
            draws: done.draws,
            ends: done.ends,
            islands: done.islands.clone(),
        }
    }

    /// Returns its parts; `None` if it is the state of another request, or no state of a search.
    pub(super) fn resumed(&self, kinds: &[DyadChainKind], points: usize) -> Option<Resumed> {
        let ends =
            |kept: &[KeptEnd]| kept.iter().map(|kept| end(kept, kinds, points)).collect::<Option<Vec<End>>>();
        Some(Resumed {
            archive: ends(&self.archive)?,
            of_kinds: ends(&self.of_kinds)?,
            next_stream: self.next_stream,
            done: DyadChainOutcome {
                evaluations: self.evaluations,
                draws: self.draws,
                ends: self.ends,
                islands: self.islands.clone(),
                ..DyadChainOutcome::default()
            },
        })
    }
}

fn kept(end: &End, kinds: &[DyadChainKind]) -> Option<KeptEnd> {
    let State { chain, phases, value, misfit } = &end.state;
    let Shape { kind, assembly, parameters } = chain.shape;
    Some(KeptEnd {
        kind: kinds.iter().position(|other| *other == kind)?,
        assembly,
        parameters,
        linear: chain.placement.numbers().map(|z| [z.re, z.im]),
        phases: phases.clone(),
        value: *value,
        misfit: *misfit,
        reversed: end.variant.reversed,
        mirrored: end.variant.mirrored,
        hits: end.hits,
    })
}

fn end(kept: &KeptEnd, kinds: &[DyadChainKind], points: usize) -> Option<End> {
    let kind = *kinds.get(kept.kind)?;
    let [origin, ground, pointer] = kept.linear.map(|[x, y]| Complex::new(x, y));
    let numbers = kept.parameters.iter().chain(&kept.phases).chain(kept.linear.iter().flatten());
    let is_sound =
        kept.phases.len() == points && kept.value >= 0.0 && numbers.into_iter().all(|x| x.is_finite());
    is_sound.then(|| End {
        state: State {
            chain: DyadChain {
                shape: Shape { kind, assembly: kept.assembly, parameters: kept.parameters },
                placement: Placement { origin, ground, pointer },
            },
            phases: kept.phases.clone(),
            value: kept.value,
            misfit: kept.misfit,
        },
        variant: Variant { reversed: kept.reversed, mirrored: kept.mirrored },
        hits: kept.hits,
    })
}
