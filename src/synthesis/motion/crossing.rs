//! Crossings: linkages that keep one dyad of a known answer beside another one.
//!
//! Given the poses, the two dyads of a linkage are nearly independent of each other, so that a better answer often shares
//! one dyad with a good one. The other is drawn (sets of five poses, pins at random), lies beside a known one, or is one of
//! the minima of the map of circle errors at the poses that a known answer itself takes. Of the pairs drawn, those of the
//! least misfit are kept.
//!
//! The misfit of a pair is what it costs at the poses to first order. A body that moves by a little v = (dx, dy, W dtheta)
//! from a pose meets a dyad when F + B v = 0, F = |X - G| - R the circle error of the pin's place X and B = (n, <n, i Q m>/W)
//! its slopes, n the direction from the pivot G to X. The least such v that meets both dyads has the square F' (B B')^-1 F.

use super::starts::DyadStarts;
use crate::mechanism::{AssemblyMode, Complex, Dyad, LoopJoints, Pose, dot, turned};
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use crate::record::Candidate;
use crate::synthesis::constants::motion::{
    BESIDE, BESIDE_BETWEEN, CROSSED, CROSSED_GRID, CROSSED_MINIMA, CROSSED_PINS, REACH, SHORT,
};
use crate::synthesis::dyads::{circle_fit, circle_minima, pair, through_random_five};
use crate::task::forms::design_space::Shape;
use crate::task::forms::start::Start;
use std::f64::consts::TAU;

/// The least determinant of two dyads' slopes, in parts of that of independent ones.
const LEAST: f64 = 1e-6;

impl DyadStarts<'_> {
    /// Returns the starts of the least misfit among pairs of a dyad of a known answer and another one.
    pub(super) fn crossed(&self, leaders: &[&Candidate], stream: &mut Stream) -> Vec<Start> {
        let known: Vec<Dyad> = leaders.iter().copied().filter_map(dyads_of).flatten().collect();
        if known.is_empty() {
            return Vec::new();
        }
        let others = self.others(leaders, &known, stream);
        let of_known = self.misses(&known);
        let of_others = self.misses(&others);
        let mut pairs: Vec<(f64, [usize; 2])> = Vec::with_capacity(CROSSED);
        for _ in 0..CROSSED {
            let [i, j] = [below(stream, known.len()), below(stream, others.len())];
            let (Some(one), Some(other)) = (&of_known[i], &of_others[j]) else { continue };
            let misfit = one.with(other, &self.weights);
            if misfit.is_finite() && !pairs.iter().any(|(_, drawn)| *drawn == [i, j]) {
                pairs.push((misfit, [i, j]));
            }
        }
        pairs.sort_by(|(one, _), (other, _)| one.total_cmp(other));
        let starts = pairs.into_iter().filter_map(|(_, [i, j])| self.start(&pair(&known[i], &others[j])?));
        starts.take(SHORT).collect()
    }

    /// Returns the dyads that take the place of one of a known answer: new ones, and the known ones.
    fn others(&self, leaders: &[&Candidate], known: &[Dyad], stream: &mut Stream) -> Vec<Dyad> {
        let mut dyads = through_random_five(&self.poses, stream);
        dyads.extend((0..CROSSED_PINS).filter_map(|_| self.drawn(stream)));
        let taken = poses_of(leaders[below(stream, leaders.len())]).unwrap_or_default();
        let minima = circle_minima(&taken, Some(&self.weights), CROSSED_GRID, REACH);
        dyads.extend(minima.into_iter().take(CROSSED_MINIMA));
        dyads.extend((0..BESIDE).filter_map(|_| self.beside(&known[below(stream, known.len())], stream)));
        dyads.extend(known);
        dyads
    }

    /// Draws a pin beside that of a dyad, with the circle that it stays nearest to.
    fn beside(&self, dyad: &Dyad, stream: &mut Stream) -> Option<Dyad> {
        let Dyad::RR { pin, .. } = *dyad else { return None };
        let (least, most) = BESIDE_BETWEEN;
        let distance = uniform(stream, least.ln(), most.ln()).exp() * self.problem.task().size();
        let pin = pin + Complex::from_polar(distance, uniform(stream, 0.0, TAU));
        Some(circle_fit(&self.poses, pin, Some(&self.weights))?.dyad(pin))
    }

    fn misses(&self, dyads: &[Dyad]) -> Vec<Option<Misses>> {
        let radian = self.problem.task().body().map_or(1.0, |body| body.angle_weight);
        dyads.iter().map(|dyad| Misses::of(dyad, &self.poses, radian)).collect()
    }
}

/// Returns the two dyads of a candidate.
fn dyads_of(candidate: &Candidate) -> Option<[Dyad; 2]> {
    let shape = Shape::from(candidate.linkage.four_bar()?);
    // The direction C -> D in the body's frame, along which the pins are at -Z and b - Z.
    let along = Complex::from_polar(1.0, -candidate.frame_deg?.to_radians());
    let dyad = |at: Complex, pivot, length| Dyad::RR { pin: at * along, pivot, length };
    Some([
        dyad(-shape.offset, shape.crank_pivot, shape.crank),
        dyad(shape.coupler - shape.offset, shape.follower_pivot, shape.follower),
    ])
}

/// Returns the poses that a candidate takes at the targets.
fn poses_of(candidate: &Candidate) -> Option<Vec<Pose>> {
    let frame = candidate.frame_deg?.to_radians();
    let pose = |(deg, assembly): (&f64, &AssemblyMode)| {
        let LoopJoints { joints, coupler } = candidate.linkage.joints_with(deg.to_radians(), *assembly)?;
        Some(Pose::new(joints.coupler_point, coupler.arg() + frame))
    };
    candidate.crank_deg.iter().zip(&candidate.t1_at).map(pose).collect()
}

/// A dyad's circle error F, the direction n and the slope by the body's turn, at each pose.
struct Misses(Vec<(f64, Complex, f64)>);

impl Misses {
    /// Computes them; `radian`: the length W that a radian counts like. `None` for a slider, or a pin on its pivot.
    fn of(dyad: &Dyad, poses: &[Pose], radian: f64) -> Option<Self> {
        let Dyad::RR { pin, pivot, length } = *dyad else { return None };
        let at = |pose: &Pose| {
            let arm = pose.direction * pin;
            let from = pose.position + arm - pivot;
            let distance = from.norm();
            let normal = from / distance;
            (distance > 0.0).then(|| (distance - length, normal, dot(normal, turned(arm)) / radian))
        };
        Some(Misses(poses.iter().map(at).collect::<Option<_>>()?))
    }

    /// Returns the misfit of a pair: the weighted sum of the least squared moves of the body that meet both dyads.
    fn with(&self, other: &Misses, weights: &[f64]) -> f64 {
        let each = self.0.iter().zip(&other.0).zip(weights);
        each.map(|(((f, n, t), (g, m, s)), weight)| {
            let (one, two, both) = (1.0 + t * t, 1.0 + s * s, dot(*n, *m) + t * s);
            let determinant = (one * two - both * both).max(LEAST * one * two);
            weight * (f * f * two - 2.0 * f * g * both + g * g * one) / determinant
        })
        .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::arithmetic::streams::stream;
    use std::f64::consts::PI;

    #[test]
    fn the_misfit_of_a_pair_is_the_least_squared_move_that_meets_both_dyads() {
        let draws = &mut stream(61, 0);
        for _ in 0..50 {
            let place =
                |draws: &mut Stream| Complex::new(uniform(draws, -1.0, 1.0), uniform(draws, -1.0, 1.0));
            let pose = Pose::new(place(draws), uniform(draws, -PI, PI));
            let [radian, weight] = [0.7, 2.0];
            let mut dyad = || {
                let (pin, pivot) = (place(draws), place(draws) * 3.0);
                Dyad::RR { pin, pivot, length: (pose.at(pin) - pivot).norm() }
            };
            let pair = [dyad(), dyad()];
            // The body as the pair holds it, a little away from the pose by v along the normals of both constraints.
            let of = |dyad: &Dyad, pose: &Pose| Misses::of(dyad, &[*pose], radian).expect("an RR dyad");
            let slopes = pair.map(|dyad| {
                let (_, n, t) = of(&dyad, &pose).0[0];
                [n.re, n.im, t]
            });
            let v: [f64; 3] = std::array::from_fn(|k| 1e-6 * (slopes[0][k] - 0.4 * slopes[1][k]));
            let moved =
                Pose::new(pose.position + Complex::new(v[0], v[1]), pose.direction.arg() + v[2] / radian);
            let misfit = of(&pair[0], &moved).with(&of(&pair[1], &moved), &[weight]);
            let expected = weight * v.iter().map(|part| part * part).sum::<f64>();
            assert!((misfit - expected).abs() < 1e-2 * expected, "{misfit:e} {expected:e}");
        }
    }
}
