//! The skeleton of a linkage in a position: its links as lines, its joints, and of a slider the rail or the rod and the block.

use super::model::Model;
use crate::mechanism::plates::{Edge, Link, convex_hull};
use crate::mechanism::{Complex, CrankLinkage, LoopJoints, MultiLoop};

/// Half the height of a drawn block, in diameters of a hole.
const HALF_BLOCK: f64 = 1.0;

/// The lines of a linkage in a position.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Skeleton {
    /// The joints with their letters; D only where it is a pin.
    pub(super) joints: Vec<(&'static str, Complex)>,
    /// The fixed pivots; none without a second one.
    pub(super) ground: Vec<Complex>,
    /// A and C.
    pub(super) crank: [Complex; 2],
    /// B and D of a four-bar; the arm from B to the line of an inverted slider-crank.
    pub(super) follower: Option<[Complex; 2]>,
    /// C, D and P; C and P of a rod; none of a six-bar or an eight-bar.
    pub(super) coupler: Vec<Complex>,
    /// The names of the links of a six-bar or an eight-bar, a crank of two joints left out, with their corners.
    pub(super) links: Vec<(&'static str, Vec<Complex>)>,
    /// The rail, or the rod that runs through the block.
    pub(super) line: Option<[Complex; 2]>,
    /// The outline of the slot that the block's pins run in; none without a slider.
    pub(super) slot: Vec<Edge>,
    /// The corners of the block; none without a slider.
    pub(super) block: Vec<Complex>,
}

impl Skeleton {
    pub(super) fn of(model: &Model<'_>, at: &LoopJoints) -> Self {
        let (a, joints) = (model.linkage.crank_pivot(), at.joints);
        let (c, d, p) = (joints.crank_pin, joints.follower_pin, joints.coupler_point);
        let second = model.linkage.second_pivot();
        let plain = Skeleton {
            joints: [("A", Some(a)), ("B", second), ("C", Some(c)), ("D", Some(d)), ("P", Some(p))]
                .into_iter()
                .filter_map(|(name, at)| Some((name, at?)))
                .collect(),
            ground: second.map_or(Vec::new(), |b| vec![a, b]),
            crank: [a, c],
            follower: second.map(|b| [b, d]),
            coupler: vec![c, d, p],
            links: Vec::new(),
            line: None,
            slot: outline(model, at),
            block: block(model, at),
        };
        match model.linkage {
            CrankLinkage::FourBar(_) => plain,
            CrankLinkage::MultiLoop(linkage) => several_loops(&linkage, plain),
            CrankLinkage::SliderCrank(_) => Skeleton { line: line(model, at, None), ..plain },
            CrankLinkage::InvertedSliderCrank(_) => Skeleton {
                joints: plain.joints.into_iter().filter(|(name, _)| *name != "D").collect(),
                coupler: vec![c, p],
                line: line(model, at, Some(c)),
                follower: plain.follower.filter(|[b, d]| b != d),
                ..plain
            },
        }
    }

    /// Returns the lines of the links, without length or not.
    pub(super) fn bars(&self) -> Vec<[Complex; 2]> {
        let c = &self.coupler;
        let sides: Vec<[Complex; 2]> =
            (0..c.len()).flat_map(|j| (0..j).map(move |i| (i, j))).map(|(i, j)| [c[i], c[j]]).collect();
        let mut bars: Vec<[Complex; 2]> = self.ground.windows(2).map(|pair| [pair[0], pair[1]]).collect();
        bars.push(self.crank);
        bars.extend(sides.first());
        bars.extend(self.follower);
        bars.extend(sides.get(1..).unwrap_or_default());
        for (_, corners) in &self.links {
            bars.extend(corners.windows(2).map(|pair| [pair[0], pair[1]]));
            if let [first, _, .., last] = corners[..] {
                bars.push([last, first]);
            }
        }
        bars
    }

    /// Returns the points that a drawing has to hold.
    pub(super) fn points(&self) -> impl Iterator<Item = Complex> + '_ {
        let joints = self.joints.iter().map(|(_, at)| *at);
        joints.chain(self.line.into_iter().flatten()).chain(self.block.iter().copied())
    }
}

/// Returns the centre line of the slot on the sheet; of a rod from its pin on.
fn line(model: &Model<'_>, at: &LoopJoints, pin: Option<Complex>) -> Option<[Complex; 2]> {
    let parts = model.parts.as_ref()?;
    let slot = parts.slot()?;
    let placed = parts.placement(slot.link, at);
    let ends = slot.ends.map(|end| placed.of(end));
    let Some(pin) = pin else { return Some(ends) };
    let [near, far] = ends;
    let is_nearer = (near - pin).norm() <= (far - pin).norm();
    let far = if is_nearer { far } else { near };
    Some([pin, far])
}

/// Returns the outline of the slot.
fn outline(model: &Model<'_>, at: &LoopJoints) -> Vec<Edge> {
    let Some(parts) = model.parts.as_ref() else { return Vec::new() };
    let Some(link) = parts.slot().map(|slot| slot.link) else { return Vec::new() };
    let placed = parts.placement(link, at);
    let edges = parts.plate(link, 0.0).slot_outline(model.holes.pins);
    edges.iter().map(|edge| edge.placed(&placed)).collect()
}

/// Returns the corners of the block.
fn block(model: &Model<'_>, at: &LoopJoints) -> Vec<Complex> {
    let Some(parts) = model.parts.as_ref() else { return Vec::new() };
    let Some(guide) = parts.guide() else { return Vec::new() };
    let (wide, high) = (guide.half + model.holes.pins, HALF_BLOCK * model.holes.pins);
    let placed = parts.placement(Link::Block, at);
    let corners = [[-wide, -high], [wide, -high], [wide, high], [-wide, high]];
    corners.into_iter().map(|[x, y]| placed.of(Complex::new(x, y))).collect()
}

/// Returns the skeleton of a six-bar or an eight-bar.
fn several_loops(linkage: &MultiLoop, plain: Skeleton) -> Skeleton {
    let crank_pin = plain.crank[1];
    let at = |name: &str| linkage.joint_at(name, crank_pin);
    let near = 1e-9 * linkage.longest();
    let mut links = Vec::new();
    for body in linkage.links() {
        let link = Link::OF_BODIES[body.body];
        let corners: Vec<Complex> = body.joints.iter().filter_map(|(name, _)| at(name)).collect();
        if link != Link::Ground && (link != Link::Crank || corners.len() > 2) {
            let name = if link == Link::Crank { "crank-plate" } else { link.name() };
            links.push((name, convex_hull(&corners, near)));
        }
    }
    let joints = linkage.joints();
    let named = |joint: &crate::mechanism::multi_loop::NamedJoint| Some((joint.name, at(joint.name)?));
    Skeleton {
        joints: joints.iter().filter_map(named).collect(),
        ground: linkage.pivots(),
        follower: None,
        coupler: Vec::new(),
        links,
        ..plain
    }
}
