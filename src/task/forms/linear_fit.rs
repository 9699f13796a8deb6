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

use super::design_space::Shape;
use crate::mechanism::{Complex, cross, unit_vector};
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

/// The six real unknowns v = (A, K, Z) as v = T w + v0 with `used` unknowns w; further columns of T are zero.
struct Unknowns {
    t: SMatrix<f64, 6, 6>,
    v0: SVector<f64, 6>,
    used: usize,
}

/// The first rows of A, K and Z among the real unknowns.
const A: usize = 0;
const K: usize = 2;
const Z: usize = 4;

impl Unknowns {
    /// Returns the unknowns that known pivots and ground leave, with the crank ratio p.
    fn of(known: &KnownPivots, p: f64) -> Self {
        let (t, v0) = (SMatrix::zeros(), SVector::zeros());
        let mut unknowns = Unknowns { t, v0, used: 0 };
        let axes = [Complex::new(1.0, 0.0), Complex::new(0.0, 1.0)];
        axes.into_iter().for_each(|axis| unknowns.free(&[(Z, axis)]));
        let (a, b) = (known.crank_pivot, known.follower_pivot);
        match a.or(b) {
            Some(pivot) => unknowns.fix(A, pivot),
            None => axes.into_iter().for_each(|axis| unknowns.free(&[(A, axis)])),
        }
        // With B known alone, A = B - K/p.
        let column = |axis: Complex| [(K, axis), (A, axis * (-1.0 / p))];
        let tied = if a.is_none() && b.is_some() { 2 } else { 1 };
        match (a, b, known.ground_angle, known.ground) {
            (Some(a), Some(b), ..) => unknowns.fix(K, (b - a) * p),
            (_, _, Some(angle), Some(ground)) => {
                for (row, part) in &column(Complex::from_polar(1.0, angle))[..tied] {
                    unknowns.fix(*row, part * (p * ground));
                }
            }
            (_, _, Some(angle), None) => unknowns.free(&column(Complex::from_polar(1.0, angle))[..tied]),
            (_, _, None, _) => axes.into_iter().for_each(|axis| unknowns.free(&column(axis)[..tied])),
        }
        unknowns
    }

    /// Adds an unknown with these entries in its column of T.
    fn free(&mut self, entries: &[(usize, Complex)]) {
        for &(row, value) in entries {
            (self.t[(row, self.used)], self.t[(row + 1, self.used)]) = (value.re, value.im);
        }
        self.used += 1;
    }

    /// Adds a known part of A, K or Z.
    fn fix(&mut self, row: usize, value: Complex) {
        self.v0[row] += value.re;
        self.v0[row + 1] += value.im;
    }

    /// Solves the normal equations of v for w and returns A, K and Z; `None` if they are singular.
    fn solve(&self, matrix: &SMatrix<f64, 6, 6>, right: &SVector<f64, 6>) -> Option<[Complex; 3]> {
        let (t, v0) = (&self.t, &self.v0);
        let mut reduced = t.transpose() * matrix * t;
        let reduced_right = t.transpose() * (right - matrix * v0);
        let scale = (0..self.used).map(|i| reduced[(i, i)]).fold(0.0, f64::max);
        for i in 0..6 {
            reduced[(i, i)] = if i < self.used { reduced[(i, i)] + RIDGE * scale } else { 1.0 };
        }
        let v = t * reduced.cholesky()?.solve(&reduced_right) + v0;
        Some([A, K, Z].map(|row| Complex::new(v[row], v[row + 1])))
    }
}

/// The ridge relative to the largest diagonal entry. u nearly affine in e (a parallelogram, a tiny crank) makes the
/// system singular, and the ridge keeps it solvable: it is well above the rounding of the sums, about 1e-15 of that
/// entry, and so small that a well-posed start moves by parts in 1e10, which the fit that follows undoes.
const RIDGE: f64 = 1e-10;

/// Returns the normal equations of the real unknowns (A, K, Z): complex sums over the columns 1, e, u, from which
/// everything real follows.
fn normal_equations(
    directions: &[[Complex; 2]],
    targets: impl Iterator<Item = Complex>,
    weights: &[f64],
) -> (SMatrix<f64, 6, 6>, SVector<f64, 6>) {
    let mut sums = [[Complex::new(0.0, 0.0); 3]; 3];
    let mut right = [Complex::new(0.0, 0.0); 3];
    for (([e, u], target), &weight) in directions.iter().zip(targets).zip(weights) {
        let columns = [Complex::new(1.0, 0.0), *e, *u];
        for i in 0..3 {
            let conjugate = columns[i].conj() * weight;
            right[i] += conjugate * target;
            for k in 0..3 {
                sums[i][k] += conjugate * columns[k];
            }
        }
    }
    let matrix = SMatrix::from_fn(|row, column| {
        let s = sums[row / 2][column / 2];
        match (row % 2, column % 2) {
            (0, 0) | (1, 1) => s.re,
            (0, _) => -s.im,
            _ => s.im,
        }
    });
    (matrix, SVector::from_fn(|row, _| if row % 2 == 0 { right[row / 2].re } else { right[row / 2].im }))
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
    let (matrix, right) = normal_equations(directions, targets.iter().map(|target| target - mean), weights);
    let [crank_pivot, k, z] = Unknowns::of(&known, ratios.crank).solve(&matrix, &right)?;
    let ground = match (known.crank_pivot, known.follower_pivot) {
        (Some(a), Some(b)) => b - a,
        _ => k / ratios.crank,
    };
    let reversed = |angle| (ground * Complex::from_polar(1.0, angle).conj()).re <= 0.0;
    let g = ground.norm();
    if known.ground_angle.is_some_and(reversed) || !g.is_finite() || g == 0.0 {
        return None;
    }
    Some(Shape {
        crank_pivot: crank_pivot + mean,
        follower_pivot: crank_pivot + mean + ground,
        crank: ratios.crank * g,
        coupler: ratios.coupler * g,
        follower: ratios.follower * g,
        // Z is the offset turned by the ground's direction.
        offset: z * unit_vector(ground).conj(),
    })
}

/// Returns the assembly sign of a position (from the ground line): +1 if it is the left one.
pub fn assembly_sign(ratios: &Ratios, [e, u]: [Complex; 2]) -> f64 {
    cross(Complex::new(1.0, 0.0) - e * ratios.crank, u).signum()
}
