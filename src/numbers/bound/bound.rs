//! The lower bound of a box: a number L such that no point of the box has a sum of squares below it.
//!
//! SSE >= L exactly where |eta| >= kappa |<tau, u>| with kappa^2 = L/(S - L), eta being u projected off 1, e and tau.
//! For a unit vector y orthogonal to all three |eta| >= |<y, u>|: two linear functionals of u are left. y is taken
//! from the box's centre; both are expanded there with exact first derivatives, and the remainder of the expansion is
//! bounded by the second derivatives of theta over the box (docs/certificate.md has each line).

use super::expansion::{Expansion, Moved};
use super::halving::LARGER;
use super::target::{MAX_POINTS, Target};
use linkwright_leaves::{Cell, Class};

/// The factor that covers the rounding of a few products and roots in a lower bound.
pub(super) const SMALLER: f64 = 1.0 - 1e-13;
/// The factor that covers the rounding of the witness' own parts along the basis: they are rounding themselves, so
/// that their first two digits suffice.
pub(super) const WIDER: f64 = 1.01;
/// A relative margin for `f64::hypot`, which is trusted to 1e-12, and for a witness that rounding has made longer
/// than 1 (docs/certificate.md, Rounding).
const MARGIN: f64 = 1e-12;

/// The witness y of a box: u off the basis, scaled to a length of at most 1 but for rounding.
pub(super) struct Witness {
    pub(super) y: [[f64; 2]; MAX_POINTS],
    /// The sizes |y_j|.
    pub(super) size: [f64; MAX_POINTS],
    /// A bound of the part of y along the exact basis.
    pub(super) along: f64,
}

impl Witness {
    /// Projects u off the basis and scales it to `length`, both `times` in a row; `rounding` is that of a sum of n
    /// products.
    #[inline(always)]
    pub(super) fn new(
        target: &Target,
        u: &[[f64; 2]; MAX_POINTS],
        times: usize,
        length: f64,
        rounding: f64,
    ) -> Self {
        let n = target.len();
        let mut y = *u;
        for _ in 0..times {
            for b in &target.basis {
                let (re, im) = product(b, &y[..n]);
                for (b, v) in b.iter().zip(&mut y) {
                    *v = [v[0] - (b[0] * re - b[1] * im), v[1] - (b[0] * im + b[1] * re)];
                }
            }
            let across = y[..n].iter().map(|v| v[0] * v[0] + v[1] * v[1]).sum::<f64>().sqrt();
            let scale = if across > 0.0 { length / across } else { 0.0 };
            for v in &mut y[..n] {
                *v = [v[0] * scale, v[1] * scale];
            }
        }
        let mut along = 0.0;
        for b in &target.basis {
            let (re, im) = product(b, &y[..n]);
            along += re.abs() + im.abs() + rounding + WIDER * target.basis_error;
        }
        let mut size = [0.0; MAX_POINTS];
        for (size, y) in size.iter_mut().zip(&y[..n]) {
            *size = (y[0] * y[0] + y[1] * y[1]).sqrt();
        }
        Witness { y, size, along }
    }
}

/// Returns <b, v> = sum conj(b_j) v_j.
#[inline(always)]
fn product(b: &[[f64; 2]], v: &[[f64; 2]]) -> (f64, f64) {
    b.iter()
        .zip(v)
        .fold((0.0, 0.0), |(re, im), (b, v)| (re + b[0] * v[0] + b[1] * v[1], im + b[0] * v[1] - b[1] * v[0]))
}

/// Returns the largest number up to `goal` that twelve halvings find to hold; 0 if none does.
pub(super) fn largest(goal: f64, holds: impl Fn(f64) -> bool) -> f64 {
    if holds(goal) {
        return goal;
    }
    let (mut low, mut high) = (0.0, goal);
    if holds(0.0) {
        for _ in 0..12 {
            let middle = 0.5 * (low + high);
            if holds(middle) { low = middle } else { high = middle }
        }
    }
    low
}

/// The lower bound of a box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// The bound L: at most the sum of squares of every linkage in the box with |Z| within the cap.
    pub sum_sq: f64,
    /// The contribution of each axis to the loss of the bound.
    pub weight: [f64; 4],
}

/// Computes a lower bound of a box for linkages with |Z| <= `cap`.
///
/// `wanted` is the sum of squares that would decide the box: the bound is not sharpened beyond it.
pub fn bound(target: &Target, class: Class, cell: &Cell, cap: f64, wanted: f64) -> Bound {
    let n = target.len();
    let expansion = Expansion::new(&target.turn, class, cell);
    let Expansion { h, u, .. } = &expansion;
    let rounding = (n as f64 + 8.0) * 2.0 * f64::EPSILON * (n as f64).sqrt();
    let witness = Witness::new(target, u, 1, 1.0, rounding);
    let (y, size_y) = (&witness.y, &witness.size);
    let slack = witness.along * (n as f64).sqrt() * WIDER + 2.0 * rounding;
    let tau = &target.basis[2];
    let (re, im) = product(tau, &u[..n]);
    let beta = re.hypot(im);
    let turn = if beta > 0.0 { [re / beta, im / beta] } else { [1.0, 0.0] };
    let common = expansion.common_turn(size_y);
    let (mut value, mut rest_y, mut rest_tau) = (0.0, 0.0, 0.0);
    let (mut a, mut b_re, mut b_im) = ([0.0; 4], [0.0; 4], [0.0; 4]);
    let mut weight = [0.0; 4];
    for j in 0..n {
        // conj(y) u, and conj(tau) u turned so that their sum is real.
        let cy = [y[j][0] * u[j][0] + y[j][1] * u[j][1], y[j][0] * u[j][1] - y[j][1] * u[j][0]];
        let ct = [tau[j][0] * u[j][0] + tau[j][1] * u[j][1], tau[j][0] * u[j][1] - tau[j][1] * u[j][0]];
        let ct = [ct[0] * turn[0] + ct[1] * turn[1], ct[1] * turn[0] - ct[0] * turn[1]];
        value += cy[0];
        let size_tau = (tau[j][0] * tau[j][0] + tau[j][1] * tau[j][1]).sqrt();
        let Moved { t, rest, own } = expansion.moved(j, &common);
        for k in 0..4 {
            a[k] -= cy[1] * t[k];
            b_re[k] -= ct[1] * t[k];
            b_im[k] += ct[0] * t[k];
        }
        rest_y += size_y[j] * rest;
        rest_tau += size_tau * rest;
        for k in 0..4 {
            weight[k] += size_y[j] * own[k];
        }
    }
    // Every sum and product below has non-negative parts, or its rounding is within `slack`.
    let rest_y = rest_y * LARGER + slack + expansion.turning(rounding);
    let rest_tau = rest_tau * LARGER + slack + expansion.turning(rounding);
    let spread: f64 = (0..4).map(|k| b_re[k].abs() * h[k]).sum::<f64>() * LARGER;
    let aside = (0..4).map(|k| b_im[k].abs() * h[k]).sum::<f64>() * LARGER + rest_tau;
    // sqrt((|x| + R)^2 + I^2) is convex in x = beta + b delta: below its chord over the box.
    let length = |x: f64| (x.abs() + rest_tau).hypot(aside) * LARGER;
    let (top, bottom) = (length(beta + spread), length(beta - spread));
    let mean = 0.5 * (top + bottom) * LARGER;
    let slope = if spread > 0.0 { 0.5 * (top - bottom) / spread } else { 0.0 };
    let longest = top.max(bottom);
    let certified = |kappa: f64| {
        let linear: f64 = (0..4).map(|k| (a[k] - kappa * slope * b_re[k]).abs() * h[k]).sum();
        // The witness may be longer than 1 by rounding.
        (value - rest_y - kappa * mean - linear * LARGER) - MARGIN * (1.0 + kappa * longest) >= 0.0
    };
    for k in 0..4 {
        weight[k] += 0.25 * (a[k] - slope * b_re[k] * 0.1).abs() * h[k];
    }
    let size_sq = target.size_sq();
    let reached = |kappa: f64| size_sq * (kappa * kappa / (1.0 + kappa * kappa)) * SMALLER;
    let goal = (wanted / (size_sq - wanted)).sqrt() * (1.0 + MARGIN);
    let mut sum_sq = 0.0_f64;
    if wanted < size_sq {
        sum_sq = reached(largest(goal, certified));
    }
    let short = size_sq.sqrt() * SMALLER - cap * longest * LARGER;
    if short > 0.0 {
        sum_sq = sum_sq.max(short * short * SMALLER);
    }
    Bound { sum_sq, weight }
}
