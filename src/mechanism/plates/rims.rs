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
