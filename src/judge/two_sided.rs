//! Two-sided distance of a path and a coupler curve: of each from the other, whatever the timing.
//!
//! Both are cut into equal arcs. Of each point of one the nearest point of the other is taken; the two means are added (the
//! Chamfer sum of the literature on path synthesis), and the largest of all is the worst distance (Hausdorff's). A curve that
//! goes astray between two target points has small errors at the points and a large distance here.

use crate::judge::referee::judge;
use crate::mechanism::{Complex, bounding_box, centroid_and_radius, point, xy};
use crate::record::{Candidate, TwoSidedRecord};
use crate::task::Problem;
use crate::task::resampling::resample;

/// Points into which the path and the curve are cut each.
const PIECES: usize = 2000;
/// Samples of the curve that are cut into equal arcs.
const SAMPLES: usize = 4000;
/// Points of a piece of a path whose box is looked at before its points are.
const BLOCK: usize = 40;

/// Returns the two-sided distance of a candidate of a path; `None` of another task, or where the curve has no point.
pub fn two_sided(problem: &Problem, candidate: &Candidate) -> Option<TwoSidedRecord> {
    let task = problem.task();
    if task.body().is_some() || task.points().len() < 2 {
        return None;
    }
    let radians: Vec<f64> = candidate.crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let motion = judge(task, candidate.linkage, &radians, &candidate.t1_at).motion;
    let [low, high] = motion.range;
    let at = |i: usize| motion.on.point_at(low + (high - low) * i as f64 / SAMPLES as f64);
    let curve: Vec<Complex> = (0..=SAMPLES).filter_map(at).collect();
    if curve.is_empty() {
        return None;
    }
    let path = in_equal_arcs(task.points(), task.closed() && !task.repeats_first());
    let curve = in_equal_arcs(&curve, false);
    let (_, radius) = centroid_and_radius(task.points());
    let (there, back) = (distances(&path, &curve), distances(&curve, &path));
    let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
    let sum = mean(&there) + mean(&back);
    let worst = there.iter().chain(&back).copied().fold(0.0, f64::max);
    Some(TwoSidedRecord { mean: sum, mean_over_radius: sum / radius, worst })
}

/// Returns points at equal distances of arc length on a polyline.
fn in_equal_arcs(line: &[Complex], closed: bool) -> Vec<Complex> {
    let corners: Vec<[f64; 2]> = line.iter().copied().map(xy).collect();
    resample(&corners, closed, PIECES).into_iter().map(point).collect()
}

/// Returns the distance of each point from the nearest of others, which lie along a path: pieces of it whose box is farther away
/// than what was found are passed over.
fn distances(points: &[Complex], others: &[Complex]) -> Vec<f64> {
    let blocks: Vec<([Complex; 2], &[Complex])> =
        others.chunks(BLOCK).map(|block| (bounding_box(block.iter().copied()), block)).collect();
    // The next point's nearest is mostly in the same piece.
    let mut found_in = 0;
    let nearest = |p: &Complex| {
        let mut best = f64::INFINITY;
        let first = found_in;
        for k in 0..blocks.len() {
            let i = (first + k) % blocks.len();
            let ([low, high], block) = blocks[i];
            let beyond = |x: f64, from: f64, to: f64| (from - x).max(x - to).max(0.0);
            let (x, y) = (beyond(p.re, low.re, high.re), beyond(p.im, low.im, high.im));
            if x * x + y * y >= best {
                continue;
            }
            let here = block.iter().map(|other| (p - other).norm_sqr()).fold(f64::INFINITY, f64::min);
            if here < best {
                (best, found_in) = (here, i);
            }
        }
        best.sqrt()
    };
    points.iter().map(nearest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::arithmetic::streams::{stream, uniform};

    #[test]
    fn the_nearest_of_the_pieces_is_the_nearest_of_all() {
        let draws = &mut stream(12, 0);
        for reach in [1.0, 30.0] {
            let mut drawn = |shift: f64| -> Vec<Complex> {
                (0..300)
                    .map(|_| Complex::new(uniform(draws, 0.0, reach) + shift, uniform(draws, 0.0, 1.0)))
                    .collect()
            };
            let (points, others) = (drawn(0.0), drawn(3.0));
            for (p, found) in points.iter().zip(distances(&points, &others)) {
                let least = others.iter().map(|q| (p - q).norm()).fold(f64::INFINITY, f64::min);
                assert!((found - least).abs() < 1e-14 * (1.0 + least), "{found} {least}");
            }
        }
    }

    #[test]
    fn circles_of_two_radii_are_their_difference_apart_each_way() {
        let circle = |r: f64| -> Vec<Complex> {
            (0..=720).map(|i| Complex::from_polar(r, std::f64::consts::TAU * f64::from(i) / 720.0)).collect()
        };
        let (one, other) = (in_equal_arcs(&circle(1.0), false), in_equal_arcs(&circle(1.25), false));
        for found in distances(&one, &other).into_iter().chain(distances(&other, &one)) {
            assert!((found - 0.25).abs() < 1e-4, "{found}");
        }
        let still = in_equal_arcs(&[Complex::new(1.0, 1.0); 3], true);
        assert_eq!(still, vec![Complex::new(1.0, 1.0); PIECES]);
    }
}
