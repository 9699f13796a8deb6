//! Fits a linkage to poses by Gauss-Helmert Levenberg-Marquardt, to be compared with the fit of the searches.
//!
//! The unknowns are two dyads and a correction of each pose; a corrected pose meets both dyads' circles. There is no crank
//! angle and no assembly. With F the two circle errors of a pose, B their derivatives by its correction and A those by the
//! dyads, the linearised problem min |v + dv|² with F + B dv + A dx = 0 has the normal equations Σ Aᵀ S A dx = -Σ Aᵀ S g,
//! where S = (B Bᵀ)⁻¹ and g = F - B v. An inner iteration leads each pose to the nearest one of the dyads.

use linkwright::internals::mechanism::{Complex, Dyad, Pose};
use nalgebra::{SMatrix, SVector};

/// Pin, pivot and length of both dyads.
type Design = SVector<f64, 10>;
type Correction = SVector<f64, 3>;

/// Most steps of the inner iteration.
const INNER: usize = 10;
/// An accepted step that gains less than this part of the cost ends a fit, after so many steps. Of the rules that were tried
/// this one costs the least time a hit (24 problems, 200 starts each): 21 ms; with 1e-2 44 ms, without an end before
/// convergence 54 ms, with twice as many hits, each of them in a fit of 2.8 ms.
const GAIN: f64 = 1e-3;
const LEAST_STEPS: usize = 8;
/// Most steps of a fit.
const STEPS: usize = 200;

/// The end of a fit.
pub struct Fitted {
    /// Both dyads.
    pub dyads: [Dyad; 2],
    /// The poses that they generate nearest to the wanted ones.
    pub poses: Vec<Pose>,
    /// Σ |position error|² + w² (angle error)².
    pub cost: f64,
}

struct Fit<'a> {
    poses: &'a [Pose],
    angle_weight: f64,
}

/// The circle errors of a corrected pose, with their derivatives.
struct Linear {
    error: SVector<f64, 2>,
    by_correction: SMatrix<f64, 2, 3>,
    by_design: SMatrix<f64, 2, 10>,
    inverse: SMatrix<f64, 2, 2>,
}

impl Fit<'_> {
    fn corrected(&self, j: usize, v: &Correction) -> Pose {
        let Pose { position, direction } = self.poses[j];
        let turn = Complex::from_polar(1.0, v[2] / self.angle_weight);
        Pose { position: position + Complex::new(v[0], v[1]), direction: direction * turn }
    }

    fn linear(&self, x: &Design, j: usize, v: &Correction) -> Option<Linear> {
        let pose = self.corrected(j, v);
        let q = pose.direction;
        let mut error = SVector::<f64, 2>::zeros();
        let mut by_correction = SMatrix::<f64, 2, 3>::zeros();
        let mut by_design = SMatrix::<f64, 2, 10>::zeros();
        for k in 0..2 {
            let at = 5 * k;
            let (pin, pivot) = (Complex::new(x[at], x[at + 1]), Complex::new(x[at + 2], x[at + 3]));
            let arm = pose.position + q * pin - pivot;
            let n = arm / arm.norm();
            let turned = Complex::i() * q * pin;
            let by_pin = q.conj() * n;
            error[k] = arm.norm() - x[at + 4];
            let turn = (n.conj() * turned).re / self.angle_weight;
            by_correction.set_row(k, &SMatrix::<f64, 1, 3>::new(n.re, n.im, turn));
            for (i, value) in [by_pin.re, by_pin.im, -n.re, -n.im, -1.0].into_iter().enumerate() {
                by_design[(k, at + i)] = value;
            }
        }
        let inverse = (by_correction * by_correction.transpose()).try_inverse()?;
        Some(Linear { error, by_correction, by_design, inverse })
    }

    /// Leads the corrections to the nearest poses of the dyads; the cost. `None` where the dyads do not close near a pose.
    fn nearest(&self, x: &Design, all: &mut [Correction]) -> Option<f64> {
        let mut cost = 0.0;
        for (j, v) in all.iter_mut().enumerate() {
            let mut left = f64::INFINITY;
            for _ in 0..INNER {
                let Linear { error, by_correction: b, inverse, .. } = self.linear(x, j, v)?;
                let next = -b.transpose() * inverse * (error - b * *v);
                let moved = next - *v;
                let most = moved[2].abs() / (0.4 * self.angle_weight);
                *v += moved / most.max(1.0);
                left = moved.norm();
                if left <= 1e-12 * (1.0 + v.norm()) {
                    break;
                }
            }
            if left > 1e-6 * (1.0 + v.norm()) {
                return None;
            }
            cost += v.norm_squared();
        }
        cost.is_finite().then_some(cost)
    }
}

/// Fits from two dyads.
pub fn fit(dyads: [&Dyad; 2], poses: &[Pose], angle_weight: f64, exact: f64) -> Option<Fitted> {
    let fit = Fit { poses, angle_weight };
    let mut x = Design::zeros();
    for (k, dyad) in dyads.iter().enumerate() {
        let Dyad::RR { pin, pivot, length } = **dyad else { return None };
        for (i, value) in [pin.re, pin.im, pivot.re, pivot.im, length].into_iter().enumerate() {
            x[5 * k + i] = value;
        }
    }
    let mut all = vec![Correction::zeros(); poses.len()];
    let mut cost = fit.nearest(&x, &mut all)?;
    let mut damping = 1e-3;
    for step in 0..STEPS {
        let (mut normal, mut slope) = (SMatrix::<f64, 10, 10>::zeros(), Design::zeros());
        let mut rows = Vec::with_capacity(all.len());
        for (j, v) in all.iter().enumerate() {
            let row = fit.linear(&x, j, v)?;
            let g = row.error - row.by_correction * v;
            let weighted = row.by_design.transpose() * row.inverse;
            normal += weighted * row.by_design;
            slope += weighted * g;
            rows.push((row, g));
        }
        let mut gained = None;
        while gained.is_none() && damping < 1e12 {
            let mut damped = normal;
            for i in 0..10 {
                damped[(i, i)] += damping * normal[(i, i)].max(1e-12);
            }
            let step = damped.cholesky().map(|factor| -factor.solve(&slope));
            gained = step.and_then(|step| {
                let trial = x + step;
                let mut corrections: Vec<Correction> = rows
                    .iter()
                    .map(|(row, g)| -row.by_correction.transpose() * row.inverse * (g + row.by_design * step))
                    .collect();
                let lengths = trial[4] > 0.0 && trial[9] > 0.0;
                let less = fit.nearest(&trial, &mut corrections).filter(|less| lengths && *less < cost)?;
                let gain = cost - less;
                (x, all, cost) = (trial, corrections, less);
                Some(gain)
            });
            damping *= if gained.is_some() { 0.2 } else { 8.0 };
        }
        let Some(gain) = gained else { break };
        damping = damping.max(1e-14);
        if cost <= exact || (step >= LEAST_STEPS && gain < GAIN * cost) {
            break;
        }
    }
    let dyad = |k: usize| Dyad::RR {
        pin: Complex::new(x[5 * k], x[5 * k + 1]),
        pivot: Complex::new(x[5 * k + 2], x[5 * k + 3]),
        length: x[5 * k + 4],
    };
    let poses = all.iter().enumerate().map(|(j, v)| fit.corrected(j, v)).collect();
    Some(Fitted { dyads: [dyad(0), dyad(1)], poses, cost })
}
