//! Limits of a chain that is fitted, in units of the target's rms radius, and the weights of their hinges.

use super::constants::{
    COSINE_WEIGHT, LAST_COSINES, LAST_SIZES, PIVOT_WEIGHT, SIZE_WEIGHT, WITHIN_ANGLE, WITHIN_SIZE,
};
use super::held::AllHeld;
use super::request::DyadChainLimits;
use super::target::Target;
use crate::mechanism::dyad_chain::kinds::{CRANK, DyadChainKind, GROUND};
use crate::mechanism::dyad_chain::sizes::{Joint, Side, distance, sides};
use crate::mechanism::dyad_chain::transmission::cosine;
use crate::mechanism::dyad_chain::{Placement, Proportions};
use crate::numbers::arithmetic::Complex;

/// The limits, and how heavily a fit holds to them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Cosine of the least transmission angle.
    pub(super) cosine: f64,
    /// ln of the greatest length.
    pub(super) longest: f64,
    /// ln of the greatest ratio of two lengths.
    pub(super) ratio: f64,
    /// Corners of the boxes of A, of B, and of further fixed pivots.
    pub(super) pivots_in: [Option<[Complex; 2]>; 3],
    /// Corners of the box of all joints and P.
    pub(super) footprint: Option<[Complex; 2]>,
    /// Greatest diagonal of the box of the motion.
    pub(super) extent: f64,
    /// Weights a point of the squares of the hinges.
    pub(super) cosine_weight: f64,
    pub(super) size_weight: f64,
    pub(super) pivot_weight: f64,
}

/// The bodies of one kind of chain: the pairs of their joints, the joints on the ground, and what is held of them.
#[derive(Clone, Debug, Default)]
pub(super) struct Bodies {
    kind: Option<DyadChainKind>,
    pub(super) sides: Vec<Side>,
    pub(super) pivots: Vec<Joint>,
    /// The moving joints and P, each on a body that carries it.
    pub(super) moving: Vec<(usize, Joint)>,
    /// Dimensions at given values.
    pub(super) held: AllHeld,
}

impl Bodies {
    /// Lists those of a kind, if they are of another one.
    #[inline(always)]
    pub(super) fn of(&mut self, kind: DyadChainKind) {
        if self.kind == Some(kind) {
            return;
        }
        (self.kind, self.sides) = (Some(kind), sides(kind));
        self.held = AllHeld::default();
        self.pivots = vec![Joint::Fixed(0.0), Joint::Fixed(1.0)];
        for dyad in 1..kind.dyads() {
            for (end, body) in kind.anchors(dyad).into_iter().enumerate() {
                if body == GROUND {
                    self.pivots.push(Joint::End { dyad, end });
                }
            }
        }
        self.moving = vec![(CRANK, Joint::CrankPin)];
        for dyad in 0..kind.dyads() {
            self.moving.push((2 + 2 * dyad, Joint::Fixed(1.0)));
            for (end, body) in kind.anchors(dyad).into_iter().enumerate().filter(|_| dyad > 0) {
                if body != GROUND {
                    self.moving.push((body, Joint::End { dyad, end }));
                }
            }
        }
        self.moving.push((kind.traced(), Joint::Traced));
    }

    /// Returns the indices of the least and the largest side without P, and the logarithm of their ratio.
    #[inline(always)]
    pub(super) fn ratio(&self, of: &Proportions, at: &Placement) -> (usize, usize, f64) {
        let (mut low, mut high) = ((0, f64::INFINITY), (0, 0.0));
        for (i, side) in self.sides.iter().enumerate() {
            if side.is_of_traced() {
                continue;
            }
            let length = distance(of, at, side);
            if length < low.1 {
                low = (i, length);
            }
            if length > high.1 {
                high = (i, length);
            }
        }
        (low.0, high.0, (high.1 / low.1.max(f64::MIN_POSITIVE)).ln())
    }
}

/// Returns the place of a fixed pivot in the frame A = 0, B = 1.
#[inline(always)]
pub(super) fn pivot_place(of: &Proportions, joint: Joint) -> Complex {
    match joint {
        Joint::Fixed(x) => Complex::new(x, 0.0),
        Joint::End { dyad, end } => of.anchors[dyad][end],
        Joint::CrankPin | Joint::Traced => Complex::new(0.0, 0.0),
    }
}

/// Returns how far a point lies beyond a box, signed, along x and along y.
#[inline(always)]
pub(super) fn beyond(p: Complex, [low, high]: [Complex; 2]) -> [f64; 2] {
    [p.re - p.re.clamp(low.re, high.re), p.im - p.im.clamp(low.im, high.im)]
}

impl Limits {
    /// Returns the limits of fits to a target; those of a mirrored variant have a mirrored box.
    pub(super) fn of(limits: &DyadChainLimits, target: &Target, mirrored: bool) -> Limits {
        let inside = Complex::new(WITHIN_SIZE, WITHIN_SIZE);
        let within = |corners: [Complex; 2]| {
            let [low, high] = corners.map(|corner| (corner - target.centre) / target.radius);
            let [low, high] = if mirrored {
                [Complex::new(low.re, -high.im), Complex::new(high.re, -low.im)]
            } else {
                [low, high]
            };
            // A box smaller than the margin keeps its middle.
            let [low, high] = [low + inside, high - inside];
            let middle = (low + high) * 0.5;
            [
                Complex::new(low.re.min(middle.re), low.im.min(middle.im)),
                Complex::new(high.re.max(middle.re), high.im.max(middle.im)),
            ]
        };
        let pivots_in = limits.pivots_in.map(|corners| corners.map(within));
        let footprint = limits.footprint_in.map(within);
        let extent = limits.extent_max / target.radius * (1.0 - WITHIN_SIZE);
        Limits {
            cosine: (limits.transmission_min + WITHIN_ANGLE).cos(),
            longest: (limits.longest_max / target.radius).ln() - WITHIN_SIZE,
            ratio: limits.link_ratio_max.ln() - WITHIN_SIZE,
            pivots_in,
            footprint,
            extent,
            cosine_weight: COSINE_WEIGHT,
            size_weight: SIZE_WEIGHT,
            pivot_weight: PIVOT_WEIGHT,
        }
    }

    /// Returns the same limits with the weights of the last fit.
    pub(super) fn strictly(&self) -> Limits {
        Limits {
            cosine_weight: LAST_COSINES * self.cosine_weight,
            size_weight: LAST_SIZES * self.size_weight,
            pivot_weight: LAST_SIZES * self.pivot_weight,
            ..*self
        }
    }

    /// Returns the sum of the weighted squares of the hinges on cosines, a point.
    #[inline(always)]
    pub(super) fn of_transmission(&self, of: &Proportions) -> f64 {
        let mut sum = 0.0;
        for dyad in 0..of.kind.dyads() {
            for (end, sign) in [(0, 1.0), (1, -1.0)] {
                let over = (sign * cosine(of, dyad, end) - self.cosine).max(0.0);
                sum += over * over;
            }
        }
        sum * self.cosine_weight
    }

    /// Returns the sum of the weighted squares of the hinges on lengths and pivots, and of what is held, a point.
    #[inline(always)]
    pub(super) fn of_sizes(&self, of: &Proportions, at: &Placement, bodies: &Bodies) -> f64 {
        let mut sum = 0.0;
        for side in &bodies.sides {
            let over = (distance(of, at, side).max(f64::MIN_POSITIVE).ln() - self.longest).max(0.0);
            sum += over * over;
        }
        let over = (bodies.ratio(of, at).2 - self.ratio).max(0.0);
        sum = (sum + over * over) * self.size_weight;
        for (i, joint) in bodies.pivots.iter().enumerate() {
            if let Some(corners) = self.pivots_in[i.min(2)] {
                let [x, y] = beyond(at.origin + at.ground * pivot_place(of, *joint), corners);
                sum += (x * x + y * y) * self.pivot_weight;
            }
        }
        sum + bodies.held.value(of, at)
    }
}
