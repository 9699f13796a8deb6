//! A linkage of several loops as a general [`Chain`], and from the [`DyadChain`] that a search found.

use super::keys::{ChainKeys, DyadKeys, PointKeys};
use super::{LinkPair, MultiLoop};
use crate::mechanism::chain::ChainError;
use crate::mechanism::dyad_chain::kinds::{CRANK, GROUND};
use crate::mechanism::{AssemblyMode, Chain, ChainBuilder, Complex, DyadChain, LinkageError};

impl MultiLoop {
    /// Returns the linkage of a dyad chain; a phase of the chain is the crank angle less the angle of the line A-B.
    ///
    /// # Errors
    /// If a length is zero, or a number beyond the range.
    pub fn of_dyad_chain(chain: &DyadChain) -> Result<Self, LinkageError> {
        let of = chain.proportions();
        let [origin, ground, pointer] = chain.placement.numbers();
        let size = ground.norm();
        // A place in the frame of a body as lengths along and across its line.
        let place = |body: usize, at: Complex| match body {
            GROUND => origin + ground * at,
            CRANK => at * size,
            link => at * (of.lengths[(link - 2) / 2][(link - 2) % 2] * size),
        };
        let kind = chain.shape.kind;
        let dyads: Vec<LinkPair> = (0..kind.dyads())
            .map(|dyad| {
                let on = kind.anchors(dyad);
                LinkPair {
                    ends: [0, 1].map(|end| place(on[end], of.anchors[dyad][end])),
                    lengths: of.lengths[dyad].map(|length| length * size),
                    side: if of.signs[dyad] > 0.0 { AssemblyMode::Plus } else { AssemblyMode::Minus },
                }
            })
            .collect();
        let crank = of.anchors[0][0].re * size;
        MultiLoop::new(kind, (origin, crank), &dyads, place(kind.traced(), pointer / ground))
    }

    /// Returns the linkage as a general chain, with the joints of [`MultiLoop::joints`] in their order.
    ///
    /// # Errors
    /// If the chain's own limits are exceeded.
    pub fn to_chain(&self) -> Result<Chain, Box<ChainError>> {
        let ChainKeys { pivots, crank, dyad, point, trace } = self.keys();
        let mut builder = ChainBuilder::new();
        for joint in self.joints() {
            if let Some(at) = pivots.get(joint.name) {
                builder = builder.pivot(joint.name, *at);
            }
        }
        builder = builder.crank(&crank.pivot, &crank.joint, crank.length);
        for joint in self.joints() {
            let made = dyad.iter().find(|d| d.joint == joint.name);
            if let Some(DyadKeys { joint, from: [x, y], lengths, side }) = made {
                builder = builder.dyad(joint, [x, y], *lengths, *side);
            }
            if let Some(PointKeys { name, on: [p, q], at }) = point.iter().find(|p| p.name == joint.name) {
                builder = builder.point(name, [p, q], *at);
            }
        }
        builder.trace(&trace).build()
    }
}
