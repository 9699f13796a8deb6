//! The linear part of a path fit, for starts: given the shape ratios and the positions, the pivots, the size
//! and the coupler point follow from linear least squares.
//!
//! In the frame with A at 0 and B at 1, with e_j = e^{i theta_j} from the ground line and p = a/g, q = b/g,
//! r = c/g: w = 1 - p e, f2 = |w|^2, sigma = (q^2 - r^2 + f2)/2, H = sqrt(q^2 f2 - sigma^2),
//! q u = w (sigma + i t H)/f2. Then
//!
//! ```text
//! P = A + K e + Z u      A, K, Z complex and linear;  back: B - A = K/p
//! ```
//!
//! If the problem fixes A, B or the ground's direction, some of the six real unknowns are known or dependent: v = T w +
//! v0 with fewer unknowns w. This makes a start only; the actual fit follows.

use super::design_space::{Shape, unit};
use crate::mechanism::{Complex, cross};
use crate::task::Problem;
use crate::task::spec::Limits;
use nalgebra::{SMatrix, SVector};

/// The known pivots and ground, before the fit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct KnownPivots {
    /// A, if it is fixed.
    pub crank_pivot: Option<Complex>,
    /// B, if it is fixed.
    pub follower_pivot: Option<Complex>,
    /// The ground's direction arg(B - A), if it is fixed or drawn, in radians.
    pub ground_angle: Option<f64>,
    /// The ground's length |AB|, if it is fixed and the direction is known.
    pub ground: Option<f64>,
}

impl KnownPivots {
    /// Returns the values that the design's bounds fix.
    pub fn of(problem: &Problem) -> Self {
        let fixed = |limits: Option<Limits>| limits.filter(Limits::is_fixed).map(|l| l.0);
        let design = &problem.spec().design;
        let pivot = |p: Option<[Limits; 2]>| {
            let [x, y] = p?;
            Some(Complex::new(fixed(Some(x))?, fixed(Some(y))?))
        };
        KnownPivots {
            crank_pivot: pivot(design.crank_pivot),
            follower_pivot: pivot(design.follower_pivot),
            ground_angle: fixed(design.ground_angle_deg).map(f64::to_radians),
            ground: fixed(design.ground),
        }
    }
}

/// The ratios of the links to the ground: p = a/g, q = b/g, r = c/g.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratios {
    /// Crank to ground, a/g.
    pub crank: f64,
    /// Coupler to ground, b/g.
    pub coupler: f64,
    /// Follower to ground, c/g.
    pub follower: f64,
}

/// Returns the coupler direction u at a crank direction e (from the ground line) on the assembly with sign t; `None` if
/// the loop is open.
#[inline]
pub fn coupler_direction(ratios: &Ratios, e: Complex, t: f64) -> Option<Complex> {
    let (p, q, r) = (ratios.crank, ratios.coupler, ratios.follower);
    let w = Complex::new(1.0, 0.0) - e * p;
    let f2 = w.norm_sqr();
    let sigma = 0.5 * (q * q - r * r + f2);
    let h2 = q * q * f2 - sigma * sigma;
    if h2.is_nan() || h2 <= 0.0 || f2 == 0.0 {
        return None;
    }
    Some(w * Complex::new(sigma, t * h2.sqrt()) / (f2 * q))
}

/// Fits the six real numbers (A, K, Z) by linear least squares through `targets` at directions (e_j, u_j) with weights.
///
/// Returns the shape; the positions of the points are the directions turned by the ground's direction. `None` if the
/// system is singular, the crank would have no length, or (known ground direction) the size came out negative.
pub fn fit(
    ratios: &Ratios,
    known: &KnownPivots,
    directions: &[[Complex; 2]],
    targets: &[Complex],
    weights: &[f64],
) -> Option<Shape> {
    // Everything is measured from the targets' mean: far from the origin the sums would lose their digits.
    let total: f64 = weights.iter().sum();
    let mean = targets.iter().zip(weights).map(|(t, w)| t * w).sum::<Complex>() / total;
    let known = KnownPivots {
        crank_pivot: known.crank_pivot.map(|p| p - mean),
        follower_pivot: known.follower_pivot.map(|p| p - mean),
        ..*known
    };
    // Complex normal sums over the columns 1, e, u; everything real follows from them.
    let mut sums = [[Complex::new(0.0, 0.0); 3]; 3];
    let mut right = [Complex::new(0.0, 0.0); 3];
    for (([e, u], target), &weight) in directions.iter().zip(targets).zip(weights) {
        let columns = [Complex::new(1.0, 0.0), *e, *u];
        for i in 0..3 {
            let conjugate = columns[i].conj() * weight;
            right[i] += conjugate * (target - mean);
            for k in 0..3 {
                sums[i][k] += conjugate * columns[k];
            }
        }
    }
    let mut matrix = SMatrix::<f64, 6, 6>::zeros();
    let mut vector = SVector::<f64, 6>::zeros();
    for i in 0..3 {
        vector[2 * i] = right[i].re;
        vector[2 * i + 1] = right[i].im;
        for k in 0..3 {
            let s = sums[i][k];
            matrix[(2 * i, 2 * k)] = s.re;
            matrix[(2 * i, 2 * k + 1)] = -s.im;
            matrix[(2 * i + 1, 2 * k)] = s.im;
            matrix[(2 * i + 1, 2 * k + 1)] = s.re;
        }
    }
    // v = T w + v0; unused columns of T stay zero and get a unit diagonal.
    let mut t = SMatrix::<f64, 6, 6>::zeros();
    let mut v0 = SVector::<f64, 6>::zeros();
    let (mut used, p) = (0, ratios.crank);
    let mut free = |entries: &[(usize, f64)]| {
        for &(row, value) in entries {
            t[(row, used)] = value;
        }
        used += 1;
    };
    free(&[(4, 1.0)]);
    free(&[(5, 1.0)]);
    let direction = known.ground_angle.map(|angle| Complex::from_polar(1.0, angle));
    match (known.crank_pivot, known.follower_pivot, direction) {
        (Some(a), Some(b), _) => {
            let k = (b - a) * p;
            (v0[0], v0[1], v0[2], v0[3]) = (a.re, a.im, k.re, k.im);
        }
        (a, b, Some(direction)) => {
            // K = kappa e^{i angle}; with B known A = B - K/p.
            match (a, b) {
                (Some(a), _) => (v0[0], v0[1]) = (a.re, a.im),
                (None, Some(b)) => (v0[0], v0[1]) = (b.re, b.im),
                (None, None) => {
                    free(&[(0, 1.0)]);
                    free(&[(1, 1.0)]);
                }
            }
            let tied = if a.is_none() && b.is_some() { -1.0 / p } else { 0.0 };
            let column =
                [(2, direction.re), (3, direction.im), (0, tied * direction.re), (1, tied * direction.im)];
            match known.ground {
                Some(ground) => column.iter().for_each(|&(row, value)| v0[row] += p * ground * value),
                None if tied == 0.0 => free(&column[..2]),
                None => free(&column),
            }
        }
        (a, b, None) => {
            match (a, b) {
                (Some(a), _) => (v0[0], v0[1]) = (a.re, a.im),
                (None, Some(b)) => {
                    (v0[0], v0[1]) = (b.re, b.im);
                    free(&[(2, 1.0), (0, -1.0 / p)]);
                    free(&[(3, 1.0), (1, -1.0 / p)]);
                }
                (None, None) => {
                    free(&[(0, 1.0)]);
                    free(&[(1, 1.0)]);
                }
            }
            if b.is_none() || a.is_some() {
                free(&[(2, 1.0)]);
                free(&[(3, 1.0)]);
            }
        }
    }
    let mut reduced = t.transpose() * matrix * t;
    let reduced_right = t.transpose() * (vector - matrix * v0);
    let scale = (0..used).map(|i| reduced[(i, i)]).fold(0.0, f64::max);
    for i in 0..6 {
        if i >= used {
            reduced[(i, i)] = 1.0;
        } else {
            // u nearly affine in e (a parallelogram, a tiny crank) makes the system singular: keep it solvable.
            reduced[(i, i)] += 1e-10 * scale;
        }
    }
    let v = t * reduced.cholesky()?.solve(&reduced_right) + v0;
    let crank_pivot = Complex::new(v[0], v[1]);
    let k = Complex::new(v[2], v[3]);
    let ground = match (known.crank_pivot, known.follower_pivot) {
        (Some(a), Some(b)) => b - a,
        _ => k / p,
    };
    if let Some(direction) = direction
        && (ground * direction.conj()).re <= 0.0
    {
        return None;
    }
    let g = ground.norm();
    if !g.is_finite() || g == 0.0 {
        return None;
    }
    // Z is the offset turned by the ground's direction.
    let offset = Complex::new(v[4], v[5]) * unit(ground).conj();
    Some(Shape {
        crank_pivot: crank_pivot + mean,
        follower_pivot: crank_pivot + mean + ground,
        crank: p * g,
        coupler: ratios.coupler * g,
        follower: ratios.follower * g,
        offset,
    })
}

/// Returns the assembly sign of a position (from the ground line): +1 if it is the left one.
pub fn assembly_sign(ratios: &Ratios, [e, u]: [Complex; 2]) -> f64 {
    cross(Complex::new(1.0, 0.0) - e * ratios.crank, u).signum()
}
