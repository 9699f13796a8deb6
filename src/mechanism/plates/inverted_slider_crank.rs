//! The plates of an inverted slider-crank: ground A-B, crank A-C, coupler with C, P and a slot, block B-E-F.
//!
//! The coupler is a rod plate with a slot along its line through C; the block lies on it with two guide pins in the slot,
//! turns about B and holds B at the offset from the line; see [`guide`](super::guide). Where P lies in the slot or too
//! near it for a hole, the plate has none there.
//!
//! On a stretch, measured from its middle, with V = B - C and the block at x = t1 sqrt(|V|^2 - h^2) along the coupler,
//!
//! ```text
//! |dC| <= 2 a sin(h/2) = r_C,   w = asin(r_C / |V|) + max |delta - delta_middle|,   delta = -atan2(h, x)
//! |dD| <= |h| k,   |dP| <= r_C + |Z| k,   k = 2 sin(min(pi, w)/2)
//! ```
//!
//! w bounds the coupler's turn; |V| is monotone between the crank along and against the ground line, and delta is
//! monotone in |V|.

use super::guide::travel;
use super::kind::{Kind, Shape, Slot};
use super::{Guide, Joint, Link, Pin, Placement, Reach, Sizes, Stretch};
use crate::mechanism::slider::SliderLinkage;
use crate::mechanism::{Complex, InvertedSliderCrank, LoopJoints};
use std::f64::consts::PI;

/// The least material between the slot and a hole at P, in parts of the hole.
const BESIDE_SLOT: f64 = 0.5;

const PINS: [Pin; 5] = [
    Pin::new(Joint::A, Link::Ground, Link::Crank),
    Pin::new(Joint::B, Link::Ground, Link::Block),
    Pin::new(Joint::C, Link::Crank, Link::Coupler),
    Pin::new(Joint::E, Link::Coupler, Link::Block),
    Pin::new(Joint::F, Link::Coupler, Link::Block),
];

impl Kind for InvertedSliderCrank {
    fn links(&self) -> Vec<Link> {
        vec![Link::Ground, Link::Crank, Link::Coupler, Link::Block]
    }

    fn pins(&self) -> Vec<Pin> {
        PINS.to_vec()
    }

    fn points(&self) -> Vec<Joint> {
        vec![Joint::A, Joint::B, Joint::C, Joint::P]
    }

    fn in_slot(&self) -> Option<Joint> {
        (self.offset() == 0.0).then_some(Joint::B)
    }

    fn guide(&self, sizes: Sizes, motion: &[Stretch]) -> Option<Guide> {
        let along = self.ground_angle();
        Some(Guide::new(travel(self, &[along, along + PI], motion)?, sizes, self.offset().abs()))
    }

    fn shape(&self, link: Link, guide: Option<&Guide>) -> Shape {
        let x = |along: f64| Complex::new(along, 0.0);
        let half = guide.map_or(0.0, |guide| guide.half);
        match link {
            Link::Ground => Shape::with_holes(vec![(Joint::A, x(0.0)), (Joint::B, x(self.ground()))]),
            Link::Crank => {
                Shape::with_holes(vec![(Joint::A, x(0.0)), (Joint::C, x(SliderLinkage::crank(self)))])
            }
            Link::Coupler => {
                let p = SliderLinkage::coupler_offset(self);
                let slot = guide.map(|guide| Slot { link, ends: guide.ends().map(x) });
                let width = guide.map_or(0.0, |guide| guide.width);
                let drilled = slot.is_none_or(|slot| slot.distance(p) >= (1.0 + BESIDE_SLOT) * width);
                let holes =
                    [(Joint::C, x(0.0))].into_iter().chain(drilled.then_some((Joint::P, p))).collect();
                Shape { slot, corners: vec![p], ..Shape::with_holes(holes) }
            }
            _ => {
                let b = Complex::new(0.0, self.offset());
                Shape::with_holes(vec![(Joint::B, b), (Joint::E, x(-half)), (Joint::F, x(half))])
            }
        }
    }

    fn placement(&self, link: Link, at: &LoopJoints) -> Placement {
        let (a, joints) = (SliderLinkage::crank_pivot(self), at.joints);
        match link {
            Link::Ground => Placement::between(a, self.block_pivot()),
            Link::Crank => Placement::between(a, joints.crank_pin),
            Link::Coupler => Placement::along(joints.crank_pin, at.coupler),
            _ => Placement::along(joints.follower_pin, at.coupler),
        }
    }

    fn reach(&self, stretch: &Stretch, at: &LoopJoints) -> Reach {
        let crank_pin = 2.0 * SliderLinkage::crank(self) * (0.5 * stretch.half().min(PI)).sin();
        let s = (self.block_pivot() - at.joints.crank_pin).norm();
        let turn = if crank_pin < s { (crank_pin / s).asin() } else { PI };
        let swing = turn + change_of_angle(self, stretch, s);
        let chord = 2.0 * (0.5 * swing.min(PI)).sin();
        let coupler_point = crank_pin + SliderLinkage::coupler_offset(self).norm() * chord;
        let moving =
            [(Joint::C, crank_pin), (Joint::D, self.offset().abs() * chord), (Joint::P, coupler_point)];
        Reach::new(&moving, [chord, chord])
    }
}

/// Computes max |delta - delta(s)| over a stretch, delta the angle from the line C-B to the coupler.
fn change_of_angle(linkage: &InvertedSliderCrank, stretch: &Stretch, s: f64) -> f64 {
    let (g, a, h) = (linkage.ground(), SliderLinkage::crank(linkage), linkage.offset());
    let distance = |angle: f64| {
        let pin = SliderLinkage::crank_pivot(linkage) + Complex::from_polar(a, angle);
        (linkage.block_pivot() - pin).norm()
    };
    let along = linkage.ground_angle();
    let ends = [distance(stretch.from), distance(stretch.to)];
    let low = if stretch.holds(along) { (g - a).abs() } else { ends[0].min(ends[1]) };
    let high = if stretch.holds(along + PI) { g + a } else { ends[0].max(ends[1]) };
    let delta = |s: f64| h.abs().atan2(((s - h) * (s + h)).max(0.0).sqrt());
    let here = delta(s);
    (delta(low) - here).abs().max((delta(high) - here).abs())
}
