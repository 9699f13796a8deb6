//! The plates of a four-bar: ground A-B, crank A-C, coupler C-D-P, follower B-D.
//!
//! On a stretch from phi - h to phi + h with one assembly, measured from its middle,
//!
//! ```text
//! |dC| <= 2 a sin(h/2) = r_C
//! |dD| <= 2 c sin(min(pi, w)/2),   w = asin(r_C / s) + max |delta - delta_middle|
//! |dP| <= |1 - z| |dC| + |z| |dD|,   P = C + z (D - C)
//! ```
//!
//! s = |CB|; the first part of w is the turn of the line B-C, delta is the angle at B between it and the follower
//! (law of cosines). s is monotone between the crank along and against the ground line, so its range over the
//! stretch is that of its ends and of those two directions; delta as a function of s has its one extreme at
//! s^2 = c^2 - b^2. No derivative enters, so a toggle, where D's speed by the crank angle is infinite, is no
//! exception.

use super::kind::{Kind, Shape};
use super::{Guide, Joint, Link, Pin, Placement, Reach, Sizes, Stretch, displacement};
use crate::mechanism::{FourBar, LoopJoints, length, point};
use std::f64::consts::PI;

const PINS: [Pin; 4] = [
    Pin::new(Joint::A, Link::Ground, Link::Crank),
    Pin::new(Joint::B, Link::Ground, Link::Follower),
    Pin::new(Joint::C, Link::Crank, Link::Coupler),
    Pin::new(Joint::D, Link::Coupler, Link::Follower),
];

impl Kind for FourBar {
    fn links(&self) -> Vec<Link> {
        vec![Link::Ground, Link::Crank, Link::Coupler, Link::Follower]
    }

    fn pins(&self) -> Vec<Pin> {
        PINS.to_vec()
    }

    fn points(&self) -> Vec<Joint> {
        Joint::ALL.to_vec()
    }

    fn guide(&self, _: Sizes, _: &[Stretch]) -> Option<Guide> {
        None
    }

    fn shape(&self, link: Link, _: Option<&Guide>) -> Shape {
        let [ground, crank, coupler, follower] = FourBar::links(self);
        let x = |along: f64| point([along, 0.0]);
        Shape::with_holes(match link {
            Link::Ground => vec![(Joint::A, x(0.0)), (Joint::B, x(ground))],
            Link::Crank => vec![(Joint::A, x(0.0)), (Joint::C, x(crank))],
            Link::Coupler => {
                vec![(Joint::C, x(0.0)), (Joint::D, x(coupler)), (Joint::P, self.coupler_offset())]
            }
            _ => vec![(Joint::B, x(0.0)), (Joint::D, x(follower))],
        })
    }

    fn placement(&self, link: Link, at: &LoopJoints) -> Placement {
        let (a, b, joints) = (self.crank_pivot(), self.follower_pivot(), at.joints);
        match link {
            Link::Ground => Placement::between(a, b),
            Link::Crank => Placement::between(a, joints.crank_pin),
            Link::Coupler => Placement::between(joints.crank_pin, joints.follower_pin),
            _ => Placement::between(b, joints.follower_pin),
        }
    }

    fn reach(&self, stretch: &Stretch, _: &LoopJoints) -> Reach {
        let crank_pin = 2.0 * self.crank() * (0.5 * stretch.half().min(PI)).sin();
        let s = self.diagonal(stretch.middle());
        let turn = if crank_pin < s { (crank_pin / s).asin() } else { PI };
        let swing = turn + change_of_angle(self, stretch, s);
        let follower_pin = 2.0 * self.follower() * (0.5 * swing.min(PI)).sin();
        let z = self.coupler_ratio();
        let coupler_point = length(1.0 - z) * crank_pin + length(z) * follower_pin;
        let coupler_chord = ((crank_pin + follower_pin) / self.coupler()).min(2.0);
        let moving = [(Joint::C, crank_pin), (Joint::D, follower_pin), (Joint::P, coupler_point)];
        Reach::new(&moving, [coupler_chord, 0.0])
    }
}

/// Computes max |delta - delta(s)| over a stretch, delta the angle at B opposite to the coupler.
fn change_of_angle(linkage: &FourBar, stretch: &Stretch, s: f64) -> f64 {
    let (g, a) = (linkage.ground(), linkage.crank());
    let ground = linkage.ground_angle();
    let ends = [linkage.diagonal(stretch.from), linkage.diagonal(stretch.to)];
    let low = if stretch.holds(ground) { (g - a).abs() } else { ends[0].min(ends[1]) };
    let high = if stretch.holds(ground + PI) { g + a } else { ends[0].max(ends[1]) };
    displacement::change_of_angle([linkage.follower(), linkage.coupler()], [low, s, high])
}
