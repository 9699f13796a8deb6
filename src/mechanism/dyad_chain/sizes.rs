//! Distances between the joints of one body of a dyad chain: lengths of links, of the sides of ternary links, of the ground,
//! and from P to the joints of its link.

use super::gradient::Rates;
use super::kinds::{CRANK, DyadChainKind, GROUND};
use super::proportions::{MAX_PARAMETERS, Proportions, first_parameter};
use super::{DyadChain, Placement};
use crate::numbers::arithmetic::{Complex, dot};

/// A joint of a body, or P.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Joint {
    /// At the constant place 0 or 1 of the body's frame.
    Fixed(f64),
    /// C, at the place p of the crank.
    CrankPin,
    /// An end (0: X, 1: Y) of a dyad.
    End {
        /// The dyad, counted from 0.
        dyad: usize,
        /// 0: X, 1: Y.
        end: usize,
    },
    /// P.
    Traced,
}

/// Two joints of one body, of which the distance is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// The body.
    pub body: usize,
    /// The joints.
    pub joints: [Joint; 2],
}

impl Side {
    /// Returns whether one of the two is P, which needs no distance from a joint.
    pub fn is_of_traced(&self) -> bool {
        self.joints.contains(&Joint::Traced)
    }
}

/// Returns the joints of a body of a kind of chain, and P where it carries it; the line of its frame joins the first two.
pub fn joints(kind: DyadChainKind, body: usize) -> Vec<Joint> {
    let mut joints = vec![Joint::Fixed(0.0)];
    joints.push(if body == CRANK { Joint::CrankPin } else { Joint::Fixed(1.0) });
    for dyad in 1..kind.dyads() {
        for (end, on) in kind.anchors(dyad).into_iter().enumerate() {
            if on == body {
                joints.push(Joint::End { dyad, end });
            }
        }
    }
    if kind.traced() == body {
        joints.push(Joint::Traced);
    }
    joints
}

/// Returns all pairs of joints of each body of a kind of chain.
pub fn sides(kind: DyadChainKind) -> Vec<Side> {
    let mut sides = Vec::new();
    for body in 0..2 + 2 * kind.dyads() {
        let joints = joints(kind, body);
        for (i, one) in joints.iter().enumerate() {
            for other in &joints[..i] {
                sides.push(Side { body, joints: [*other, *one] });
            }
        }
    }
    sides
}

/// Returns the place of a joint in the frame of its body.
#[inline(always)]
fn place(of: &Proportions, at: &Placement, joint: Joint) -> Complex {
    match joint {
        Joint::Fixed(x) => Complex::new(x, 0.0),
        Joint::CrankPin => of.anchors[0][0],
        Joint::End { dyad, end } => of.anchors[dyad][end],
        Joint::Traced => at.pointer / at.ground,
    }
}

/// Returns the length of the vector v of a body's frame.
#[inline(always)]
fn unit(of: &Proportions, body: usize) -> f64 {
    if body == GROUND || body == CRANK { 1.0 } else { of.lengths[(body - 2) / 2][(body - 2) % 2] }
}

/// Returns the distance of two joints of a body.
#[inline(always)]
pub fn distance(of: &Proportions, at: &Placement, side: &Side) -> f64 {
    let [one, other] = side.joints.map(|joint| place(of, at, joint));
    ((one - other).norm_sqr() * at.ground.norm_sqr()).sqrt() * unit(of, side.body)
}

/// The derivative of the logarithm of a distance by the parameters, and by S and Z (x and y).
#[derive(Clone, Copy, Debug)]
pub struct LogRate {
    /// By the parameters of the shape.
    pub shape: [f64; MAX_PARAMETERS],
    /// By the parts of S.
    pub ground: [f64; 2],
    /// By the parts of Z.
    pub pointer: [f64; 2],
}

/// Computes the derivative of ln of [`distance`].
#[inline(always)]
pub fn log_rate(of: &Proportions, rates: &Rates, at: &Placement, side: &Side) -> LogRate {
    let [one, other] = side.joints.map(|joint| place(of, at, joint));
    let apart = one - other;
    let per = 1.0 / apart.norm_sqr().max(1e-300);
    let by = |z: Complex| dot(apart, z) * per;
    let mut out = LogRate { shape: [0.0; MAX_PARAMETERS], ground: [0.0; 2], pointer: [0.0; 2] };
    let s = at.ground / at.ground.norm_sqr();
    out.ground = [s.re, s.im];
    if side.body > CRANK {
        let (dyad, end) = ((side.body - 2) / 2, (side.body - 2) % 2);
        let per = 1.0 / of.lengths[dyad][end];
        for (out, rate) in out.shape.iter_mut().zip(&rates.lengths[dyad][end]) {
            *out = rate * per;
        }
    }
    for (joint, sign) in side.joints.into_iter().zip([1.0, -1.0]) {
        match joint {
            Joint::Fixed(_) => {}
            Joint::CrankPin => out.shape[0] += sign * by(of.anchors[0][0]),
            Joint::End { dyad, end } => {
                let k = first_parameter(dyad) + 2 * end;
                out.shape[k] += sign * by(Complex::new(1.0, 0.0));
                out.shape[k + 1] += sign * by(Complex::new(0.0, 1.0));
            }
            Joint::Traced => {
                let inverse = 1.0 / at.ground;
                let turn = -at.pointer * inverse * inverse;
                let i = Complex::new(0.0, 1.0);
                out.pointer = [sign * by(inverse), sign * by(i * inverse)];
                out.ground[0] += sign * by(turn);
                out.ground[1] += sign * by(i * turn);
            }
        }
    }
    out
}

impl DyadChain {
    /// Returns the largest distance between two joints of one body, P and pivots included.
    pub fn longest(&self) -> f64 {
        let of = self.proportions();
        let lengths = sides(self.shape.kind).into_iter().map(|side| distance(&of, &self.placement, &side));
        lengths.fold(0.0, f64::max)
    }

    /// Returns the ratio of the largest to the least distance between two joints of one body; P does not count.
    pub fn link_ratio(&self) -> f64 {
        let of = self.proportions();
        let sides = sides(self.shape.kind).into_iter().filter(|side| !side.is_of_traced());
        let range = sides.map(|side| distance(&of, &self.placement, &side));
        let [least, most] = crate::numbers::arithmetic::least_and_greatest(range);
        most / least
    }
}
