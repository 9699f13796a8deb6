//! Smoothing and resampling of digitised points into a target.
//!
//! Points q_0 .. q_m lie on a path with the arc lengths s_i = sum_k |q_k - q_(k-1)|; a closed path goes on from its
//! last point to its first.
//!
//! *Smoothing* with the standard deviation h replaces q_i by the value at s_i of the quadratic in s that fits its
//! neighbours with the weights exp(-(s_j - s_i)^2 / 2 h^2): local regression (Cleveland, *Robust locally weighted
//! regression*, J. Am. Stat. Assoc. 74, 1979). A quadratic keeps the height of bends that a mean would flatten.
//! *Resampling* takes n points at equal distances of arc length along the straight lines between the points.

use nalgebra::{Matrix3, Matrix3x2};

/// Distance in standard deviations beyond which neighbours have no weight.
const REACH: f64 = 4.0;
/// Least number of neighbours: a quadratic through three points smooths nothing.
const LEAST_NEIGHBOURS: usize = 4;
/// The most points that are smoothed: the work is their number times the neighbours of each.
pub const MAX_SMOOTHED: usize = 10_000;

/// Returns the arc length at each point, and that of the whole path, with the way back if it is closed.
fn arc_lengths(points: &[[f64; 2]], closed: bool) -> (Vec<f64>, f64) {
    let mut lengths = Vec::with_capacity(points.len());
    let mut length = 0.0;
    for (i, point) in points.iter().enumerate() {
        if i > 0 {
            length += distance(points[i - 1], *point);
        }
        lengths.push(length);
    }
    match (points.first(), points.last()) {
        (Some(first), Some(last)) if closed => (lengths, length + distance(*last, *first)),
        _ => (lengths, length),
    }
}

fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    (q[0] - p[0]).hypot(q[1] - p[1])
}

/// Smooths points by local regression: each is moved onto the quadratic that fits its neighbours within about
/// `deviation` of arc length.
///
/// A point with fewer than four neighbours that count stays unchanged. A last point that is equal to the first stays
/// equal to it if the path is closed.
pub fn smooth(points: &[[f64; 2]], closed: bool, deviation: f64) -> Vec<[f64; 2]> {
    let (lengths, total) = arc_lengths(points, closed);
    if !(deviation > 0.0 && total > 0.0 && total.is_finite()) {
        return points.to_vec();
    }
    let mut smoothed: Vec<[f64; 2]> =
        (0..points.len()).map(|i| fitted(points, &lengths, closed.then_some(total), i, deviation)).collect();
    if closed && points.len() > 1 && points.first() == points.last() {
        let (first, last) = (smoothed[0], smoothed.len() - 1);
        smoothed[last] = first;
    }
    smoothed
}

/// Returns the value at point `i` of the quadratic that fits its neighbours; `around` is the length of a closed path.
fn fitted(points: &[[f64; 2]], lengths: &[f64], around: Option<f64>, i: usize, deviation: f64) -> [f64; 2] {
    let mut normal = Matrix3::<f64>::zeros();
    let mut right = Matrix3x2::<f64>::zeros();
    let mut neighbours = 0;
    for (j, point) in points.iter().enumerate() {
        let along = lengths[j] - lengths[i];
        let along = match around {
            // The shorter way round.
            Some(total) => along - total * (along / total).round(),
            None => along,
        };
        let u = along / deviation;
        if u.abs() > REACH {
            continue;
        }
        neighbours += 1;
        let weight = (-0.5 * u * u).exp();
        let powers = [1.0, u, u * u];
        for (row, p) in powers.iter().enumerate() {
            for (column, q) in powers.iter().enumerate() {
                normal[(row, column)] += weight * p * q;
            }
            // Measured from the point itself: the terms added stay small beside it.
            for axis in 0..2 {
                right[(row, axis)] += weight * p * (point[axis] - points[i][axis]);
            }
        }
    }
    let solved = normal.cholesky().map(|factor| factor.solve(&right));
    match solved {
        Some(fit) if neighbours >= LEAST_NEIGHBOURS && fit.iter().all(|v| v.is_finite()) => {
            [points[i][0] + fit[(0, 0)], points[i][1] + fit[(0, 1)]]
        }
        _ => points[i],
    }
}

/// Returns `count` points at equal distances of arc length on the straight lines between the points: of an open path
/// from end to end, of a closed one from its first point on, without that point again at the end.
///
/// ```
/// use linkwright::internals::task::resampling::resample;
/// let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
/// assert_eq!(resample(&square, true, 8)[3], [1.0, 0.5]);
/// assert_eq!(resample(&square, false, 3), [[0.0, 0.0], [1.0, 0.5], [0.0, 1.0]]);
/// ```
pub fn resample(points: &[[f64; 2]], closed: bool, count: usize) -> Vec<[f64; 2]> {
    let (mut lengths, total) = arc_lengths(points, closed);
    let mut corners = points.to_vec();
    if let (true, Some(first)) = (closed, points.first()) {
        corners.push(*first);
        lengths.push(total);
    }
    let (Some(first), Some(last)) = (corners.first(), corners.last()) else { return Vec::new() };
    let intervals = if closed { count } else { count.saturating_sub(1) }.max(1);
    (0..count)
        .map(|i| {
            let s = total * i as f64 / intervals as f64;
            let after = lengths.partition_point(|length| *length <= s);
            if after == 0 {
                return *first;
            }
            let (Some(to), Some(end)) = (corners.get(after), lengths.get(after)) else { return *last };
            let (from, start) = (corners[after - 1], lengths[after - 1]);
            let t = (s - start) / (end - start);
            [from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circle(count: usize, noise: f64) -> Vec<[f64; 2]> {
        (0..count)
            .map(|i| {
                let angle = std::f64::consts::TAU * i as f64 / count as f64;
                // A fixed ripple that no neighbour shares.
                let r = 10.0 + noise * (i as f64 * 2.399).sin();
                [r * angle.cos(), r * angle.sin()]
            })
            .collect()
    }

    fn roughness(points: &[[f64; 2]]) -> f64 {
        let off = |p: &[f64; 2]| (p[0].hypot(p[1]) - 10.0).powi(2);
        (points.iter().map(off).sum::<f64>() / points.len() as f64).sqrt()
    }

    #[test]
    fn smoothing_takes_noise_and_leaves_bends() {
        let noisy = circle(200, 0.1);
        let smoothed = smooth(&noisy, true, 2.0);
        assert!(roughness(&smoothed) < 0.15 * roughness(&noisy), "{}", roughness(&smoothed));
        // A clean circle moves by the fourth order of h / r only.
        assert!(roughness(&smooth(&circle(200, 0.0), true, 2.0)) < 10.0 * 0.2f64.powi(4));
    }

    #[test]
    fn a_quadratic_is_kept_and_scarce_points_stay() {
        let line: Vec<[f64; 2]> = (0..30).map(|i| [f64::from(i), 2.0 * f64::from(i) - 3.0]).collect();
        for (p, q) in line.iter().zip(smooth(&line, false, 4.0)) {
            assert!(distance(*p, q) < 1e-12 * 60.0 * 4.0, "{p:?} {q:?}");
        }
        assert_eq!(smooth(&line, false, 0.1), line);
    }

    #[test]
    fn a_closed_path_stays_closed_and_turns_with_its_start() {
        let mut ring = circle(60, 0.2);
        let shifted: Vec<[f64; 2]> = ring[7..].iter().chain(&ring[..7]).copied().collect();
        let (one, other) = (smooth(&ring, true, 3.0), smooth(&shifted, true, 3.0));
        for (i, p) in other.iter().enumerate() {
            assert!(distance(*p, one[(i + 7) % 60]) < 1e-12 * 20.0);
        }
        ring.push(ring[0]);
        let twice = smooth(&ring, true, 3.0);
        assert_eq!(twice.first(), twice.last());
    }

    #[test]
    fn repeated_points_and_no_points_do_no_harm() {
        let points = [[1.0, 1.0], [1.0, 1.0], [2.0, 1.0], [2.0, 1.0]];
        assert_eq!(resample(&points, false, 3), [[1.0, 1.0], [1.5, 1.0], [2.0, 1.0]]);
        assert_eq!(resample(&[], true, 3), Vec::<[f64; 2]>::new());
        assert_eq!(smooth(&[[1.0, 1.0]; 5], true, 1.0), [[1.0, 1.0]; 5]);
        assert_eq!(resample(&[[1.0, 1.0]; 5], false, 2), [[1.0, 1.0]; 2]);
    }
}
