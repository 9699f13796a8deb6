//! A linkage of several loops as a general [`Chain`], and from the [`DyadChain`] that a search found.

use super::keys::{ChainKeys, DyadKeys, PointKeys, StageKeys};
use super::{LinkPair, MultiLoop};
use crate::mechanism::chain::ChainError;
use crate::mechanism::dyad_chain::kinds::{CRANK, GROUND};
use crate::mechanism::dyad_chain::proportions::{first_parameter, length_parameters};
use crate::mechanism::dyad_chain::{Grid, MAX_PARAMETERS, Placement, Shape};
use crate::mechanism::{AssemblyMode, Chain, ChainBuilder, Complex, DyadChain, LinkageError, xy};

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
        let ChainKeys { crank, trace, .. } = self.keys();
        let mut builder = ChainBuilder::new();
        for joint in self.joints().iter().filter(|joint| joint.body == GROUND) {
            builder = builder.pivot(joint.name, xy(joint.at));
        }
        builder = builder.crank(&crank.pivot, &crank.joint, crank.length);
        for stage in self.stages() {
            builder = match stage {
                StageKeys::Dyad(DyadKeys { joint, from: [x, y], lengths, side }) => {
                    builder.dyad(&joint, [&x, &y], lengths, side)
                }
                StageKeys::Point(PointKeys { name, on: [p, q], at }) => builder.point(&name, [&p, &q], at),
            };
        }
        builder.trace(&trace).build()
    }
}

impl MultiLoop {
    /// Returns the linkage in the unknowns of a search, of which every value turns fully; `None` if its own crank does not.
    ///
    /// With M and m the greatest and the least |X - Y| of a dyad, alpha = ln((l1 + l2)/M - 1), beta = artanh((l1 - l2)/m).
    pub fn to_dyad_chain(&self) -> Option<DyadChain> {
        let (origin, ground) = (self.crank_pivot, self.follower_pivot() - self.crank_pivot);
        let size = ground.norm();
        if size <= 0.0 {
            return None;
        }
        let kind = self.kind;
        // A place on a body in its frame of the chain.
        let place = |body: usize, at: Complex| match body {
            GROUND => (at - origin) / ground,
            CRANK => at / size,
            link => at / self.dyads[(link - 2) / 2].lengths[(link - 2) % 2],
        };
        let mut shape =
            Shape { kind, assembly: self.dyads.map(|dyad| dyad.side), parameters: [0.0; MAX_PARAMETERS] };
        shape.parameters[0] = (self.crank / size).ln();
        let mut grid = Grid::default();
        for (dyad, pair) in self.dyads().iter().enumerate() {
            let first = first_parameter(dyad);
            if dyad > 0 {
                for (end, body) in kind.anchors(dyad).into_iter().enumerate() {
                    let at = place(body, pair.ends[end]);
                    (shape.parameters[first + 2 * end], shape.parameters[first + 2 * end + 1]) =
                        (at.re, at.im);
                }
            }
            // Its own lengths decide nothing of the distances of its ends.
            let [least, greatest] = shape.resolve(&mut grid).extremes[dyad].map(|extreme| extreme.distance);
            let [sum, difference] = [pair.lengths[0] + pair.lengths[1], pair.lengths[0] - pair.lengths[1]];
            let [alpha, beta] = length_parameters(dyad);
            shape.parameters[alpha] = (sum / size / greatest - 1.0).ln();
            shape.parameters[beta] = (difference / size / least).atanh();
        }
        let pointer = place(kind.traced(), self.coupler_point) * ground;
        let is_usable = shape.parameters.iter().all(|x| x.is_finite());
        is_usable.then_some(DyadChain { shape, placement: Placement { origin, ground, pointer } })
    }
}
