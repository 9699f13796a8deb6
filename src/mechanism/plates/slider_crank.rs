//! The plates of a slider-crank: ground with A and the slot of the rail, crank A-C, coupler C-D-P, block E-D-F.
//!
//! The rail is a slot in the ground along the slider's line, the ground is one plate from A to both its ends. The block
//! lies on the ground with two guide pins in the slot, and carries D; see [`guide`](super::guide).
//!
//! On a stretch, measured from its middle, |dC| <= 2 a sin(h/2). D moves along the line by at most the range of its
//! place, which is monotone between the crank angles at which crank and coupler are in line. |dP| <= |1 - z| |dC| +
//! |z| |dD|, P = C + z (D - C), and the coupler's direction moves by at most (|dC| + |dD|)/b.

use super::guide::travel;
use super::kind::{Kind, Shape, Slot};
use super::{Guide, Joint, Link, Pin, Placement, Reach, Sizes, Stretch};
use crate::mechanism::slider::SliderLinkage;
use crate::mechanism::{Complex, LoopJoints, SliderCrank, dot, length};
use std::f64::consts::PI;

const PINS: [Pin; 5] = [
    Pin::new(Joint::A, Link::Ground, Link::Crank),
    Pin::new(Joint::C, Link::Crank, Link::Coupler),
    Pin::new(Joint::D, Link::Coupler, Link::Block),
    Pin::new(Joint::E, Link::Ground, Link::Block),
    Pin::new(Joint::F, Link::Ground, Link::Block),
];

impl Kind for SliderCrank {
    fn links(&self) -> Vec<Link> {
        vec![Link::Ground, Link::Crank, Link::Coupler, Link::Block]
    }

    fn pins(&self) -> Vec<Pin> {
        PINS.to_vec()
    }

    fn points(&self) -> Vec<Joint> {
        vec![Joint::A, Joint::C, Joint::D, Joint::P]
    }

    fn in_slot(&self) -> Option<Joint> {
        Some(Joint::D)
    }

    fn guide(&self, sizes: Sizes, motion: &[Stretch]) -> Option<Guide> {
        // The coupler's force acts at D, on the line.
        Some(Guide::new(travel(self, &turns(self), motion)?, sizes, 0.0))
    }

    fn shape(&self, link: Link, guide: Option<&Guide>) -> Shape {
        let x = |along: f64| Complex::new(along, 0.0);
        let half = guide.map_or(0.0, |guide| guide.half);
        match link {
            Link::Ground => {
                let line =
                    (self.line_point() - SliderLinkage::crank_pivot(self)) * self.line_direction().conj();
                let slot = guide.map(|guide| Slot { link, ends: guide.ends().map(|place| line + place) });
                Shape { slot, ..Shape::with_holes(vec![(Joint::A, x(0.0))]) }
            }
            Link::Crank => {
                Shape::with_holes(vec![(Joint::A, x(0.0)), (Joint::C, x(SliderLinkage::crank(self)))])
            }
            Link::Coupler => {
                let p = SliderLinkage::coupler_offset(self);
                Shape::with_holes(vec![(Joint::C, x(0.0)), (Joint::D, x(self.coupler())), (Joint::P, p)])
            }
            _ => Shape::with_holes(vec![(Joint::D, x(0.0)), (Joint::E, x(-half)), (Joint::F, x(half))]),
        }
    }

    fn placement(&self, link: Link, at: &LoopJoints) -> Placement {
        let (a, joints, line) = (SliderLinkage::crank_pivot(self), at.joints, self.line_direction());
        match link {
            Link::Ground => Placement { origin: a, direction: line },
            Link::Crank => Placement::between(a, joints.crank_pin),
            Link::Coupler => Placement::along(joints.crank_pin, at.coupler),
            _ => Placement { origin: joints.follower_pin, direction: line },
        }
    }

    fn reach(&self, stretch: &Stretch, at: &LoopJoints) -> Reach {
        let crank_pin = 2.0 * SliderLinkage::crank(self) * (0.5 * stretch.half().min(PI)).sin();
        let place = dot(self.line_direction(), at.joints.follower_pin - self.line_point());
        let range = travel(self, &turns(self), &[*stretch]);
        let follower_pin = range.map_or(f64::INFINITY, |[low, high]| (high - place).max(place - low));
        let z = SliderLinkage::coupler_offset(self) / self.coupler();
        let coupler_point = length(1.0 - z) * crank_pin + length(z) * follower_pin;
        let coupler_chord = ((crank_pin + follower_pin) / self.coupler()).min(2.0);
        let moving = [(Joint::C, crank_pin), (Joint::D, follower_pin), (Joint::P, coupler_point)];
        Reach::new(&moving, [coupler_chord, 0.0])
    }
}

/// Returns the crank angles at which the slider turns back (crank and coupler in line, D at b + a or at b - a from A), and
/// those at which C is farthest from the line, where the loop is open if it is anywhere.
fn turns(linkage: &SliderCrank) -> Vec<f64> {
    let (a, b) = (SliderLinkage::crank(linkage), linkage.coupler());
    let (height, line) = (linkage.pivot_height(), linkage.line_direction());
    let mut angles = vec![line.arg() - 0.5 * PI, line.arg() + 0.5 * PI];
    for reach in [a + b, a - b] {
        let along = ((reach - height) * (reach + height)).max(0.0).sqrt();
        if reach == 0.0 || reach.abs() < height.abs() {
            continue;
        }
        // From A to D on either side of A's foot on the line, as a multiple of the crank's direction.
        angles.extend([along, -along].map(|x| (line * Complex::new(x, -height) / reach).arg()));
    }
    angles
}
