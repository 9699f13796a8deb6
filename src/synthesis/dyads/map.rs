//! The map of the body plane: the rms error of the best circle at each place of a pin, and its local minima as dyads.
//!
//! Kasa's fit ([`super::circle`]) needs four moments of the pin's places x_j = p_j + q_j m (P_j and Q_j less their weighted
//! means p, q): E x^2, E|x|^2, E|x|^2 x and E|x|^4. They are polynomials in m and conj(m) whose coefficients are sums over
//! the poses, so that a place of the map costs the same for any number of poses. With |x|^2 = alpha + 2 Re(beta m) +
//! gamma |m|^2, alpha = |p|^2, beta = conj(p) q, gamma = |q|^2:
//!
//! ```text
//! E x^2     = E p^2 + 2 m E pq + m^2 E q^2
//! E|x|^2    = E alpha + 2 Re(m E beta) + |m|^2 E gamma
//! E|x|^2 x  = E alpha p + m E(alpha q + beta p) + conj(m) E conj(beta) p
//!             + |m|^2 E(gamma p + conj(beta) q) + m^2 E beta q + |m|^2 m E gamma q
//! E|x|^4    = E alpha^2 + 4 Re(m E alpha beta) + 2 |m|^2 E(alpha gamma + |beta|^2) + 2 Re(m^2 E beta^2)
//!             + 4 |m|^2 Re(m E beta gamma) + |m|^4 E gamma^2
//!
//! Delta = (E|x|^2)^2 - |E x^2|^2      N = E|x|^2 c - E x^2 conj(c), c = E|x|^2 x      g = N/Delta
//! rms^2 = (E|x|^4 - (E|x|^2)^2 - 2 Re(conj(c) N)/Delta) / (4 R^2),                R^2 = |g|^2 + E|x|^2
//! ```

use super::circle::{CircleFit, circle_fit, shares};
use super::scale::Scale;
use crate::mechanism::{Complex, Dyad, Pose, dot};
use nalgebra::{SMatrix, SVector};

/// Steps of the local search for a minimum of the map between its grid's places.
const STEPS: usize = 30;

/// Greatest distance of a minimum from its place on the grid, in parts of the map's side.
const WITHIN: f64 = 0.1;

/// Minima whose pins and pivots are nearer than this, in parts of the map's side, are the same one.
const SAME: f64 = 1e-5;

/// Relative fall of the error below which the local search stops.
const STAYS: f64 = 1e-6;

/// The rms distance of a pin from its best circle, at each place of a square grid about the body's origin.
#[derive(Clone, Debug, PartialEq)]
pub struct CircleMap {
    /// Places a side.
    grid: usize,
    /// Half the side of the square, a length.
    half: f64,
    /// The errors as lengths, row by row from the least y, each from the least x.
    rms: Vec<f64>,
}

impl CircleMap {
    /// Computes the map on `grid` x `grid` places whose x and y run over +-`reach` sizes of the poses' box; `weights` as for
    /// [`circle_fit`].
    ///
    /// A pin that stays on a line, or where it is, has the error zero. The cost is about 10 ns a place, for any number of
    /// poses. `None` if the positions are all the same, a number is not finite, `grid` is below two, or the weights do not
    /// fit.
    pub fn new(poses: &[Pose], weights: Option<&[f64]>, grid: usize, reach: f64) -> Option<Self> {
        let scale = Scale::of(poses).filter(|_| grid >= 2 && reach > 0.0 && reach.is_finite())?;
        let moments = Moments::of(&scale.poses(poses), &shares(poses.len(), weights)?);
        let along = |k: usize| reach * (2.0 * k as f64 / (grid - 1) as f64 - 1.0);
        let columns: Vec<f64> = (0..grid).map(along).collect();
        let mut rms = Vec::with_capacity(grid * grid);
        for &y in &columns {
            rms.extend(columns.iter().map(|&x| moments.rms_sq(Complex::new(x, y)).sqrt() * scale.size));
        }
        Some(CircleMap { grid, half: reach * scale.size, rms })
    }

    /// Returns the number of places a side.
    pub fn grid(&self) -> usize {
        self.grid
    }

    /// Returns the errors, lengths, row by row from the least y, each from the least x.
    pub fn rms(&self) -> &[f64] {
        &self.rms
    }

    /// Returns a place of the map in the body's frame.
    pub fn pin(&self, column: usize, row: usize) -> Complex {
        let along = |k: usize| self.half * (2.0 * k as f64 / (self.grid - 1) as f64 - 1.0);
        Complex::new(along(column), along(row))
    }

    /// Returns the columns and rows of the places that are lower than their neighbours, the border's left out; of equal
    /// neighbours the first counts as lower.
    pub fn minima(&self) -> Vec<[usize; 2]> {
        let inner = 1..self.grid - 1;
        let places = inner.clone().flat_map(|row| inner.clone().map(move |column| [column, row]));
        places.filter(|&[column, row]| self.is_minimum(row * self.grid + column)).collect()
    }

    fn is_minimum(&self, at: usize) -> bool {
        let (here, above, below) = (self.rms[at], at + self.grid, at - self.grid);
        let before = [below - 1, below, below + 1, at - 1];
        let after = [at + 1, above - 1, above, above + 1];
        before.into_iter().all(|other| here < self.rms[other])
            && after.into_iter().all(|other| here <= self.rms[other])
    }
}

/// Returns the RR dyads at the local minima of the [`CircleMap`], the closest first: each found on the grid, then by
/// least squares in the pin, the pivot and the length, within a tenth of the map's side from its place on the grid.
///
/// None if there is no map.
pub fn circle_minima(poses: &[Pose], weights: Option<&[f64]>, grid: usize, reach: f64) -> Vec<Dyad> {
    let (Some(map), Some(shares)) =
        (CircleMap::new(poses, weights, grid, reach), shares(poses.len(), weights))
    else {
        return Vec::new();
    };
    let side = 2.0 * map.half;
    let refined = |[column, row]: [usize; 2]| {
        let pin = map.pin(column, row);
        let fit = circle_fit(poses, pin, weights)?;
        Some(between_places(poses, &shares, (pin, fit), WITHIN * side))
    };
    let mut minima: Vec<(Complex, CircleFit)> = map.minima().into_iter().filter_map(refined).collect();
    minima.sort_by(|(_, one), (_, other)| one.rms.total_cmp(&other.rms));
    let mut distinct: Vec<(Complex, CircleFit)> = Vec::new();
    for (pin, fit) in minima {
        let is_same = |(other, its): &(Complex, CircleFit)| {
            (pin - other).norm().max((fit.pivot - its.pivot).norm()) < SAME * side
        };
        if !distinct.iter().any(is_same) {
            distinct.push((pin, fit));
        }
    }
    distinct.into_iter().map(|(pin, fit)| fit.dyad(pin)).collect()
}

/// Returns the pin and circle after a few steps of Levenberg and Marquardt's in (m, G, R) while the error falls and the pin
/// stays within a distance of its start.
///
/// With n = (X - G)/|X - G|, X = P + Q m: d|X - G| = <conj(Q) n, dm> - <n, dG>.
fn between_places(
    poses: &[Pose],
    shares: &[f64],
    (start, fit): (Complex, CircleFit),
    within: f64,
) -> (Complex, CircleFit) {
    let (mut pin, mut best) = (start, fit);
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let (mut matrix, mut right) = (SMatrix::<f64, 5, 5>::zeros(), SVector::<f64, 5>::zeros());
        for (pose, &share) in poses.iter().zip(shares) {
            let from = pose.at(pin) - best.pivot;
            let distance = from.norm();
            let normal = from / distance;
            let by_pin = pose.direction.conj() * normal;
            let slopes = SVector::from([by_pin.re, by_pin.im, -normal.re, -normal.im, -1.0]);
            matrix.ger(share, &slopes, &slopes, 1.0);
            right.axpy(-share * (distance - best.length), &slopes, 1.0);
        }
        for k in 0..5 {
            matrix[(k, k)] *= 1.0 + damping;
        }
        let Some(step) = matrix.cholesky().map(|factor| factor.solve(&right)) else { break };
        let to = pin + Complex::new(step[0], step[1]);
        let pivot = best.pivot + Complex::new(step[2], step[3]);
        let is_near = (to - start).norm() <= within;
        if !is_near {
            break;
        }
        match circle_about(poses, shares, to, pivot).filter(|fit| fit.rms < best.rms) {
            Some(fit) => {
                let stays = best.rms - fit.rms < STAYS * best.rms;
                (pin, best) = (to, fit);
                damping *= 0.1;
                if stays {
                    break;
                }
            }
            None => damping *= 100.0,
        }
    }
    (pin, best)
}

/// Returns the best circle of a pin about a pivot.
fn circle_about(poses: &[Pose], shares: &[f64], pin: Complex, pivot: Complex) -> Option<CircleFit> {
    let distances = poses.iter().map(|pose| (pose.at(pin) - pivot).norm()).zip(shares);
    let length = distances.clone().map(|(distance, share)| share * distance).sum::<f64>();
    let rms_sq = distances.map(|(distance, share)| share * (distance - length).powi(2)).sum::<f64>();
    (rms_sq.is_finite() && length > 0.0).then(|| CircleFit { pivot, length, rms: rms_sq.sqrt() })
}

/// The coefficients of the four moments, named by their power of m and, after an underscore, of conj(m).
struct Moments {
    square: [Complex; 3],
    spread: (f64, Complex, f64),
    third: [Complex; 6],
    fourth: (f64, Complex, f64, Complex, Complex, f64),
}

impl Moments {
    fn of(poses: &[Pose], shares: &[f64]) -> Self {
        let average = |f: &dyn Fn(&Pose) -> Complex| -> Complex {
            poses.iter().zip(shares).map(|(pose, share)| f(pose) * share).sum()
        };
        let mean =
            Pose { position: average(&|pose| pose.position), direction: average(&|pose| pose.direction) };
        let e = |f: &dyn Fn(Complex, Complex, f64, Complex, f64) -> Complex| {
            average(&|pose| {
                let (p, q) = (pose.position - mean.position, pose.direction - mean.direction);
                f(p, q, p.norm_sqr(), p.conj() * q, q.norm_sqr())
            })
        };
        Moments {
            square: [e(&|p, _, _, _, _| p * p), e(&|p, q, _, _, _| p * q) * 2.0, e(&|_, q, _, _, _| q * q)],
            spread: (
                e(&|_, _, alpha, _, _| alpha.into()).re,
                e(&|_, _, _, beta, _| beta) * 2.0,
                e(&|_, _, _, _, gamma| gamma.into()).re,
            ),
            third: [
                e(&|p, _, alpha, _, _| p * alpha),
                e(&|p, q, alpha, beta, _| q * alpha + beta * p),
                e(&|p, _, _, beta, _| beta.conj() * p),
                e(&|p, q, _, beta, gamma| p * gamma + beta.conj() * q),
                e(&|_, q, _, beta, _| beta * q),
                e(&|_, q, _, _, gamma| q * gamma),
            ],
            fourth: (
                e(&|_, _, alpha, _, _| (alpha * alpha).into()).re,
                e(&|_, _, alpha, beta, _| beta * alpha) * 4.0,
                e(&|_, _, alpha, beta, gamma| (alpha * gamma + beta.norm_sqr()).into()).re * 2.0,
                e(&|_, _, _, beta, _| beta * beta) * 2.0,
                e(&|_, _, _, beta, gamma| beta * gamma) * 4.0,
                e(&|_, _, _, _, gamma| (gamma * gamma).into()).re,
            ),
        }
    }

    /// Returns the squared rms error of Kasa's circle of the pin m; 0 if its places are on a line.
    #[inline]
    fn rms_sq(&self, m: Complex) -> f64 {
        let m_sq = m.norm_sqr();
        let [s0, s1, s2] = self.square;
        let square = s0 + m * (s1 + m * s2);
        let spread = self.spread.0 + (self.spread.1 * m).re + self.spread.2 * m_sq;
        let [t0, t1, t1_, t11, t2, t21] = self.third;
        let third = t0 + m * (t1 + m * t2) + m.conj() * t1_ + (t11 + m * t21) * m_sq;
        let (f0, f1, f11, f2, f21, f22) = self.fourth;
        let fourth = f0 + (m * (f1 + m * f2)).re + m_sq * (f11 + (m * f21).re + m_sq * f22);
        let determinant = spread * spread - square.norm_sqr();
        let turned = third * spread - square * third.conj();
        // Times the determinant's square, so that neither part grows beyond all bounds near a line.
        let miss = (fourth - spread * spread) * determinant - 2.0 * dot(third, turned);
        let below = 4.0 * (turned.norm_sqr() + spread * determinant * determinant);
        if below > 0.0 { (miss * determinant / below).max(0.0) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{Moved, nearest, random_poses, size};
    use super::*;
    use crate::numbers::arithmetic::streams::{stream, uniform};

    /// Returns the error of Kasa's circle by its definition, a sum over the poses.
    fn kasa(poses: &[Pose], weights: &[f64], pin: Complex) -> f64 {
        let sum: f64 = weights.iter().sum();
        let places: Vec<Complex> = poses.iter().map(|pose| pose.at(pin)).collect();
        let (mut matrix, mut right) = (SMatrix::<f64, 3, 3>::zeros(), SVector::<f64, 3>::zeros());
        for (x, weight) in places.iter().zip(weights) {
            let row = SVector::from([2.0 * x.re, 2.0 * x.im, 1.0]);
            matrix += row * row.transpose() * *weight;
            right += row * x.norm_sqr() * *weight;
        }
        let solution = matrix.lu().solve(&right).expect("no line");
        let centre = Complex::new(solution[0], solution[1]);
        let radius_sq = solution[2] + centre.norm_sqr();
        let misses = places.iter().zip(weights);
        let miss_sq = misses.map(|(x, w)| w * ((x - centre).norm_sqr() - radius_sq).powi(2)).sum::<f64>();
        (miss_sq / sum / (4.0 * radius_sq)).sqrt()
    }

    #[test]
    fn the_moments_give_the_error_of_the_fit_at_every_place() {
        let draws = &mut stream(11, 0);
        for count in [6, 9, 36] {
            let poses = random_poses(draws, count);
            let weights: Vec<f64> = (0..count).map(|_| uniform(draws, 0.2, 3.0)).collect();
            let map = CircleMap::new(&poses, Some(&weights), 9, 2.5).expect("a map");
            for (at, &rms) in map.rms().iter().enumerate() {
                let wanted = kasa(&poses, &weights, map.pin(at % 9, at / 9));
                assert!((rms - wanted).abs() < 1e-7 * wanted, "{count}, {at}: {rms} for {wanted}");
            }
        }
    }

    #[test]
    fn equal_weights_are_no_weights() {
        let poses = random_poses(&mut stream(12, 0), 8);
        let (weighted, plain) =
            (CircleMap::new(&poses, Some(&[2.0; 8]), 21, 2.0), CircleMap::new(&poses, None, 21, 2.0));
        assert_eq!(weighted, plain);
    }

    #[test]
    fn bad_input_has_no_map() {
        let poses = random_poses(&mut stream(13, 0), 6);
        for (grid, reach, weights) in [
            (1, 2.5, None),
            (9, 0.0, None),
            (9, f64::NAN, None),
            (9, 2.5, Some(&[1.0; 5][..])),
            (9, 2.5, Some(&[0.0; 6])),
            (9, 2.5, Some(&[-1.0; 6])),
        ] {
            assert_eq!(CircleMap::new(&poses, weights, grid, reach), None, "{grid}, {reach}, {weights:?}");
            assert!(circle_minima(&poses, weights, grid, reach).is_empty());
        }
        let turning = [0.1, 0.5, 0.9, 1.4, 2.0, 3.0].map(|angle| Pose::new(Complex::new(2.0, 1.0), angle));
        assert_eq!(CircleMap::new(&turning, None, 9, 2.5), None);
    }

    #[test]
    fn minima_of_the_map_are_the_dyads_of_exact_poses_and_come_closest_first() {
        let draws = &mut stream(25, 0);
        let (mut found_both, cases) = (0, 40);
        for _ in 0..cases {
            let moved = Moved::random(draws, 10);
            let minima = circle_minima(&moved.poses, None, 81, 2.5);
            let rms = |dyad: &Dyad| moved.poses.iter().map(|pose| dyad.residual(pose).powi(2)).sum::<f64>();
            assert!(minima.windows(2).all(|pair| rms(&pair[0]) <= rms(&pair[1]) * (1.0 + 1e-9) + 1e-24));
            let is_found = |dyad: &Dyad| nearest(dyad, &minima) < 1e-2 * size(&moved.poses);
            found_both += usize::from(moved.dyads().iter().all(is_found));
        }
        assert!(found_both >= 30, "{found_both} of {cases}");
    }
}
