//! The rims of a plate: the least material between the edge of each hole and what is next to it.
//!
//! A hole of diameter d whose centre lies at the distance s inside the outline has a rim of s - d/2 to the edge; two holes of
//! diameters d and f with centres a distance l apart have l - (d + f)/2 between them; a slot counts as a hole around its centre
//! line.

use super::{Bores, Placement, Plate};

/// A neighbour of a hole.
#[derive(Clone, Debug, PartialEq)]
pub enum Beside {
    /// The edge of the plate.
    Edge,
    /// Another hole, by the names of its joints.
    Hole(String),
    /// The slot.
    Slot,
}

/// The rim of a hole towards one of its neighbours.
#[derive(Clone, Debug, PartialEq)]
pub struct Rim {
    /// The names of the joints of the hole.
    pub joints: String,
    /// The neighbour.
    pub beside: Beside,
    /// The width of the material, negative where the two overlap.
    pub width: f64,
}

impl Plate {
    /// Computes the rims of all holes: to the edge, to the slot, and to each hole that is later in their order. Widths are in the
    /// unit of the plate.
    pub fn rims(&self, bores: &Bores) -> Vec<Rim> {
        let holes = self.distinct_holes();
        let half = |joints: &str| 0.5 * bores.of(self.link, joints);
        let mut rims = Vec::new();
        for (i, (joints, at)) in holes.iter().enumerate() {
            let mut push =
                |beside: Beside, width: f64| rims.push(Rim { joints: joints.clone(), beside, width });
            push(Beside::Edge, -self.distance(&Placement::HOME, *at) - half(joints));
            if let Some(slot) = &self.slot {
                push(Beside::Slot, slot.distance(*at) - half(joints) - 0.5 * bores.usual);
            }
            for (other, there) in &holes[i + 1..] {
                push(Beside::Hole(other.clone()), (there - at).norm() - half(joints) - half(other));
            }
        }
        rims
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::plates::{Edge, Hole, Joint, Link};
    use crate::mechanism::{Complex, point};

    /// Returns points of an outline, `n` on each edge.
    fn sampled(plate: &Plate, n: usize) -> Vec<Complex> {
        let on = |edge: &Edge, share: f64| match *edge {
            Edge::Line { from, to } => from + (to - from) * share,
            Edge::Arc { from, centre, turn, .. } => {
                centre + (from - centre) * Complex::from_polar(1.0, turn * share)
            }
        };
        let edges = plate.outline();
        edges.iter().flat_map(|edge| (0..n).map(move |i| on(edge, i as f64 / n as f64))).collect()
    }

    #[test]
    fn the_rim_to_the_edge_is_the_least_distance_to_a_dense_outline() {
        let at = [[0.0, 0.0], [50.0, 0.0], [20.0, 30.0], [22.0, 11.0]];
        let joints = [Joint::C, Joint::D, Joint::P, Joint::X2];
        let holes = at.iter().zip(joints).map(|(at, joint)| Hole { joint, at: point(*at) }).collect();
        let plate = Plate::new(Link::Coupler, holes, 7.0);
        let bores = Bores::new(4.0).with_hole(Joint::D, Link::Coupler, 9.0);
        let outline = sampled(&plate, 20_000);
        let rims = plate.rims(&bores);
        for (at, joint) in at.iter().zip(joints) {
            let rim = rims.iter().find(|rim| rim.joints == joint.name() && rim.beside == Beside::Edge);
            let hole = if joint == Joint::D { 9.0 } else { 4.0 };
            let least = outline.iter().map(|p| (p - point(*at)).norm()).fold(f64::INFINITY, f64::min);
            let width = rim.expect("every hole has one").width;
            // Samples are at most 60/20000 apart on a line, which shifts the foot of the perpendicular by half of that.
            assert!((width - (least - 0.5 * hole)).abs() < 1e-4, "{joint:?}: {width} {least}");
        }
        let between = |one: &str, other: &str| {
            let beside = Beside::Hole(other.to_owned());
            rims.iter().find(|rim| rim.joints == one && rim.beside == beside).map(|rim| rim.width)
        };
        assert_eq!(between("C", "D"), Some(50.0 - 2.0 - 4.5));
        assert_eq!(between("C", "P"), Some(1300f64.sqrt() - 4.0));
        // Three pairs of the first, two of the second, one of the third, and four edges.
        assert_eq!(rims.len(), 10);
    }
}
