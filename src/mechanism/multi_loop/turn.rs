//! The turn of the crank of a linkage of several loops: whether every dyad stays closed, and the transmission angles.
//!
//! A dyad closes where |l1 - l2| <= |X - Y| <= l1 + l2; its transmission angle mu at F has cos mu = (l1^2 + l2^2 - |X - Y|^2)
//! / (2 l1 l2) and grows with |X - Y|, so that its extremes are those of the distance. These are found on dense samples, each
//! extreme refined by golden section.

use super::{Bodies, MultiLoop};
use crate::mechanism::dyad_chain::kinds::MAX_DYADS;
use crate::mechanism::four_bar::transmission::TransmissionExtremes;
use std::f64::consts::{PI, TAU};

/// Samples of a turn.
const SAMPLES: usize = 720;
/// Rounds of the refinement: 0.618^44 of two steps is below the rounding of an angle that is near an extreme.
const ROUNDS: usize = 44;
const GOLDEN: f64 = 0.618_033_988_749_894_8;

impl MultiLoop {
    /// Returns |X - Y| of the dyads up to the first that does not close, and the number of them that close.
    fn distances_of_ends(&self, crank_angle: f64) -> ([f64; MAX_DYADS], usize, usize) {
        let mut bodies: Bodies = self.driven(crank_angle);
        let mut apart = [0.0; MAX_DYADS];
        for dyad in 0..self.kind.dyads() {
            let [x, y] = self.ends(&bodies, dyad);
            apart[dyad] = (y - x).norm();
            if self.assemble(&mut bodies, dyad).is_none() {
                return (apart, dyad + 1, dyad);
            }
        }
        (apart, self.kind.dyads(), self.kind.dyads())
    }

    /// Returns the length by which the dyads are closed at a crank angle: the least of l1 + l2 - |X - Y| and |X - Y| - |l1 - l2|
    /// of the dyads up to the first that does not close, of which it is negative.
    fn closure(&self, crank_angle: f64) -> f64 {
        let (apart, placed, _) = self.distances_of_ends(crank_angle);
        let of_dyad = |dyad: usize| {
            let [l1, l2] = self.dyads[dyad].lengths;
            (l1 + l2 - apart[dyad]).min(apart[dyad] - (l1 - l2).abs())
        };
        (0..placed).map(of_dyad).fold(f64::INFINITY, f64::min)
    }

    /// Returns the least length by which the dyads are closed over a turn: the crank turns fully if it is above zero.
    pub fn full_turn_margin(&self) -> f64 {
        least(|t| self.closure(t), [0.0, TAU])
    }

    /// Returns the transmission angle at a crank angle: of all dyads the one nearest to flat, radians; 0 if one does not close.
    pub fn transmission_at(&self, crank_angle: f64) -> f64 {
        let (apart, _, closed) = self.distances_of_ends(crank_angle);
        if closed < self.kind.dyads() {
            return 0.0;
        }
        let angles = (0..closed).map(|dyad| self.angle(dyad, apart[dyad]));
        angles.min_by(|x, y| x.min(PI - x).total_cmp(&y.min(PI - y))).unwrap_or(0.0)
    }

    /// Returns the transmission angles at a crank angle, one a dyad, radians; fewer if one does not close.
    pub fn transmissions_at(&self, crank_angle: f64) -> Vec<f64> {
        let (apart, _, closed) = self.distances_of_ends(crank_angle);
        (0..closed).map(|dyad| self.angle(dyad, apart[dyad])).collect()
    }

    /// Returns the angle at F of a dyad whose ends are so far apart.
    fn angle(&self, dyad: usize, apart: f64) -> f64 {
        let [l1, l2] = self.dyads[dyad].lengths;
        // Near flat, differences of squares lose what products of differences keep.
        let over = ((l1 + l2 - apart) * (l1 + l2 + apart)).max(0.0);
        let under = ((apart - (l1 - l2).abs()) * (apart + (l1 - l2).abs())).max(0.0);
        2.0 * f64::atan2(under.sqrt(), over.sqrt())
    }

    /// Computes the extremes of the transmission angles of each dyad over an interval of crank angles.
    pub fn transmissions_between(&self, range: [f64; 2]) -> Vec<TransmissionExtremes> {
        (0..self.kind.dyads())
            .map(|dyad| {
                let apart = |t: f64| {
                    let (apart, placed, _) = self.distances_of_ends(t);
                    (dyad < placed).then(|| apart[dyad])
                };
                // Before a dyad that does not close nothing is known of the next.
                let [low, high] = [1.0, -1.0].map(|sign: f64| {
                    sign * least(|t| apart(t).map_or(f64::NEG_INFINITY, |d| sign * d), range)
                });
                match low.is_finite() && high.is_finite() {
                    true => TransmissionExtremes { min: self.angle(dyad, low), max: self.angle(dyad, high) },
                    false => TransmissionExtremes { min: 0.0, max: PI },
                }
            })
            .collect()
    }

    /// Computes the extremes of the transmission angles of all dyads over an interval of crank angles.
    pub fn transmission_between(&self, range: [f64; 2]) -> TransmissionExtremes {
        let all = self.transmissions_between(range).into_iter();
        all.fold(TransmissionExtremes { min: PI, max: 0.0 }, |sum, one| TransmissionExtremes {
            min: sum.min.min(one.min),
            max: sum.max.max(one.max),
        })
    }
}

/// Returns the least value of a function over an interval: of dense samples, the lowest local ones refined by golden section.
fn least(value: impl Fn(f64) -> f64, [low, high]: [f64; 2]) -> f64 {
    let step = (high - low) / SAMPLES as f64;
    let at = |i: usize| low + step * i as f64;
    let sampled: Vec<f64> = (0..=SAMPLES).map(|i| value(at(i))).collect();
    let mut best = sampled.iter().copied().fold(f64::INFINITY, f64::min);
    let is_turn = low + TAU <= high + step * 1e-3;
    // Between samples a value falls by no more than a share of the steepest step beside it.
    let floor = best;
    for i in 0..=SAMPLES {
        let before = if i > 0 {
            sampled[i - 1]
        } else if is_turn {
            sampled[SAMPLES - 1]
        } else {
            sampled[0]
        };
        let after = if i < SAMPLES {
            sampled[i + 1]
        } else if is_turn {
            sampled[1]
        } else {
            sampled[SAMPLES]
        };
        if !sampled[i].is_finite() || sampled[i] > before || sampled[i] > after {
            continue;
        }
        if sampled[i] - (before - sampled[i]).max(after - sampled[i]) > floor {
            continue;
        }
        let inside = |t: f64| if is_turn { t } else { t.clamp(low, high) };
        let (mut from, mut to) = (inside(at(i) - step), inside(at(i) + step));
        let (mut left, mut right) = (to - GOLDEN * (to - from), from + GOLDEN * (to - from));
        let (mut at_left, mut at_right) = (value(left), value(right));
        for _ in 0..ROUNDS {
            if at_left <= at_right {
                (to, right, at_right) = (right, left, at_left);
                left = to - GOLDEN * (to - from);
                at_left = value(left);
            } else {
                (from, left, at_left) = (left, right, at_right);
                right = from + GOLDEN * (to - from);
                at_right = value(right);
            }
        }
        best = best.min(at_left).min(at_right);
    }
    best
}
