//! Two-sided distance of a path and a coupler curve: of each from the other, whatever the timing.
//!
//! Both are cut into equal arcs. Of each point of one the nearest point of the other is taken; the two means are added (the
//! Chamfer sum of the literature on path synthesis), and the largest of all is the worst distance (Hausdorff's). A curve that
//! goes astray between two target points has small errors at the points and a large distance here.

use crate::judge::referee::judge;
use crate::mechanism::{Complex, bounding_box};
use crate::record::{Candidate, TwoSidedRecord};
use crate::task::Problem;
use std::collections::HashMap;

/// Points into which the path and the curve are cut each.
const PIECES: usize = 2000;
/// Samples of the curve that are cut into equal arcs.
const SAMPLES: usize = 4000;

/// Returns the two-sided distance of a candidate of a path; `None` of another task, or where the curve has no length.
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
    let mut path = task.points().to_vec();
    if task.closed() && !task.repeats_first() {
        path.push(path[0]);
    }
    let n = task.points().len() as f64;
    let centre = task.points().iter().sum::<Complex>() / n;
    let radius = (task.points().iter().map(|p| (p - centre).norm_sqr()).sum::<f64>() / n).sqrt();
    let (path, curve) = (in_equal_arcs(&path)?, in_equal_arcs(&curve)?);
    let (there, back) = (distances(&path, &curve), distances(&curve, &path));
    let mean = |all: &[f64]| all.iter().sum::<f64>() / all.len() as f64;
    let sum = mean(&there) + mean(&back);
    let worst = there.iter().chain(&back).copied().fold(0.0, f64::max);
    Some(TwoSidedRecord { mean: sum, mean_over_radius: sum / radius, worst })
}

/// Returns the middles of equal arcs of a polyline; `None` if it has no length.
fn in_equal_arcs(line: &[Complex]) -> Option<Vec<Complex>> {
    let mut along = vec![0.0];
    for pair in line.windows(2) {
        along.push(along[along.len() - 1] + (pair[1] - pair[0]).norm());
    }
    let whole = *along.last()?;
    if whole <= 0.0 || !whole.is_finite() {
        return None;
    }
    let mut i = 0;
    let at = |piece: usize| {
        let to = whole * (piece as f64 + 0.5) / PIECES as f64;
        while i + 2 < along.len() && along[i + 1] < to {
            i += 1;
        }
        let length = along[i + 1] - along[i];
        let share = if length > 0.0 { ((to - along[i]) / length).clamp(0.0, 1.0) } else { 0.0 };
        line[i] + (line[i + 1] - line[i]) * share
    };
    Some((0..PIECES).map(at).collect())
}

/// Returns the distance of each point from the nearest of others, which are sorted into the cells of a grid.
fn distances(points: &[Complex], others: &[Complex]) -> Vec<f64> {
    let [low, high] = bounding_box(points.iter().chain(others).copied());
    let cells = (PIECES as f64).sqrt();
    let side = ((high - low).norm() / cells).max(f64::MIN_POSITIVE);
    let cell = |p: Complex| {
        let at = (p - low) / side;
        [at.re.floor() as i64, at.im.floor() as i64]
    };
    let mut grid: HashMap<[i64; 2], Vec<Complex>> = HashMap::new();
    for other in others {
        grid.entry(cell(*other)).or_default().push(*other);
    }
    let nearest = |p: &Complex| {
        let [x, y] = cell(*p);
        let mut best = f64::INFINITY;
        // What lies in a ring of cells is at least as far as the rings inside it are wide.
        for ring in 0.. {
            let most = i64::from(ring);
            for i in x - most..=x + most {
                let step = if (i - x).abs() == most { 1 } else { (2 * most).max(1) };
                for j in (y - most..=y + most).step_by(usize::try_from(step).unwrap_or(1)) {
                    for other in grid.get(&[i, j]).into_iter().flatten() {
                        best = best.min((p - other).norm_sqr());
                    }
                }
            }
            if best <= (f64::from(ring) * side).powi(2) || f64::from(ring) > 4.0 * cells {
                break;
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
    fn the_nearest_of_a_grid_is_the_nearest_of_all() {
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
        let (one, other) = (in_equal_arcs(&circle(1.0)), in_equal_arcs(&circle(1.25)));
        let (one, other) = (one.expect("a length"), other.expect("a length"));
        for found in distances(&one, &other).into_iter().chain(distances(&other, &one)) {
            assert!((found - 0.25).abs() < 1e-4, "{found}");
        }
        assert_eq!(in_equal_arcs(&[Complex::new(1.0, 1.0); 3]), None);
    }
}
