//! Starts of a motion search whose fixed pivots are to lie on given lines or at given points: dyads of the crank with a pivot on
//! its line, and of the follower with one on its own.
//!
//! Four poses and a line have up to three dyads; more poses, those of four of them and the best ones along the line, a map of one
//! dimension. The rest is drawn: a pivot on the line with its best pin.

use super::starts::{DyadStarts, distinct};
use crate::mechanism::{Complex, Dyad, Pose, dot};
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use crate::synthesis::constants::motion::{
    FAMILY_PINS, MINIMA, ON_LINE, PINS, REACH, SETS_FIRST, SETS_LATER,
};
use crate::synthesis::dyads::{best_from_pivot, pair, through_four_on_line};
use crate::task::forms::start::Start;
use crate::task::pivot_on::Locus;

impl DyadStarts<'_> {
    /// Returns whether a fixed pivot is to lie on a line or at a point.
    pub(super) fn are_on_lines(&self) -> bool {
        self.problem.spec().require.pivot_on.is_some()
    }

    /// Returns the starts of a round at every dyad of the crank with every one of the follower.
    pub(super) fn on_lines(&self, first: bool, stream: &mut Stream) -> Vec<Start> {
        let Some(pivot_on) = &self.problem.spec().require.pivot_on else { return Vec::new() };
        let [cranks, followers] = pivot_on.both().map(|locus| match locus {
            Some(locus) => self.on_line(locus, first, stream),
            None => self.dyads(first, stream),
        });
        let all = cranks.iter().flat_map(|crank| followers.iter().map(move |follower| (crank, follower)));
        all.filter_map(|(crank, follower)| self.start(&pair(crank, follower)?)).collect()
    }

    /// Returns the dyads of a round with a pivot on a line, or at a point.
    fn on_line(&self, locus: &Locus, first: bool, stream: &mut Stream) -> Vec<Dyad> {
        let mut dyads = Vec::new();
        if locus.line().is_some() {
            for _ in 0..if first { SETS_FIRST } else { SETS_LATER } {
                dyads.extend(self.through_four(locus, stream));
                if self.poses.len() <= 4 {
                    break;
                }
            }
            if first && self.poses.len() > 3 {
                dyads.extend(self.minima_along(locus));
            }
        }
        let least = if self.family { FAMILY_PINS } else { PINS };
        // A point has one best pin.
        let most = if locus.line().is_none() && self.poses.len() > 2 { 1 } else { least };
        while dyads.len() < most {
            match self.drawn_on(locus, stream) {
                Some(dyad) => dyads.push(dyad),
                None => break,
            }
        }
        distinct(dyads, self.problem.task().size())
    }

    /// Returns the dyads through four poses, drawn if there are more.
    fn through_four(&self, locus: &Locus, stream: &mut Stream) -> Vec<Dyad> {
        if self.poses.len() < 4 {
            return Vec::new();
        }
        let mut order: Vec<usize> = (0..self.poses.len()).collect();
        if order.len() > 4 {
            for k in 0..4 {
                let other = k + below(stream, order.len() - k);
                order.swap(k, other);
            }
            order[..4].sort_unstable();
        }
        let four: [Pose; 4] = std::array::from_fn(|k| self.poses[order[k]]);
        let normals = locus.normals();
        through_four_on_line(&four, locus.first(), normals[0])
    }

    /// Returns the best dyads among their neighbours along a line, the best first.
    fn minima_along(&self, locus: &Locus) -> Vec<Dyad> {
        let at = |k: usize| self.place_on(locus, 2.0 * (k as f64 + 0.5) / ON_LINE as f64 - 1.0);
        let fits: Vec<Option<(Dyad, f64)>> =
            (0..ON_LINE).map(|k| best_from_pivot(&self.poses, at(k), Some(&self.weights))).collect();
        let rms = |k: usize| fits[k].map_or(f64::INFINITY, |(_, rms)| rms);
        let is_least = |k: &usize| rms(*k) < rms(k - 1) && rms(*k) <= rms(k + 1);
        let mut least: Vec<(Dyad, f64)> = (1..ON_LINE - 1).filter(is_least).filter_map(|k| fits[k]).collect();
        least.sort_by(|(_, one), (_, other)| one.total_cmp(other));
        least.into_iter().take(MINIMA).map(|(dyad, _)| dyad).collect()
    }

    /// Returns the place at a part, from -1 to 1, of the reach to either side of the place of a line that is nearest to the
    /// target; of a point that point.
    fn place_on(&self, locus: &Locus, part: f64) -> Complex {
        let task = self.problem.task();
        let Some((from, along)) = locus.line() else { return locus.first() };
        let middle = from + along * dot(along, task.centre() - from);
        middle + along * (part * 2.0 * REACH * task.size())
    }

    /// Draws a pivot on a line, with the pin that suits it best.
    fn drawn_on(&self, locus: &Locus, stream: &mut Stream) -> Option<Dyad> {
        let reach = REACH * self.problem.task().size();
        for _ in 0..PINS {
            let pivot = self.place_on(locus, uniform(stream, -1.0, 1.0));
            let from_body: Vec<Pose> = self.poses.iter().map(Pose::inverse).collect();
            let dyad = match *from_body.as_slice() {
                [] => None,
                [one] => {
                    let to = Complex::new(uniform(stream, -reach, reach), uniform(stream, -reach, reach));
                    Some(Dyad::RR { pin: one.at(pivot) + to, pivot, length: to.norm() })
                }
                [one, other] => {
                    // Any point of the perpendicular bisector, in the body, is a pin.
                    let (from, to) = (one.at(pivot), other.at(pivot));
                    let along = Complex::new(0.5, uniform(stream, -REACH, REACH));
                    let pin = from + (to - from) * along;
                    Some(Dyad::RR { pin, pivot, length: (from - pin).norm() })
                }
                _ => best_from_pivot(&self.poses, pivot, Some(&self.weights)).map(|(dyad, _)| dyad),
            };
            if dyad.is_some() {
                return dyad;
            }
        }
        None
    }
}
