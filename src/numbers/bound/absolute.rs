//! The lower bound of a box if crank angles are from the x axis: K = kappa is a real length.
//!
//! ```text
//! minimise over kappa, Z (and A):   sum_j |T_j - A - kappa e_j - Z u_j(x)|^2,    e_j = e^{i Phi_j} known
//! ```
//!
//! With E = e'/|e'|: T' = (r + i t) E + s tau, u' = v E + alpha tau + eta, b = |eta|, N = |u'|^2, D = N - |v|^2. The
//! least sum over kappa and Z is (s^2 b^2 N + q^2)/(N D), q = t D - s Im(conj(alpha) v); with kappa given it is
//! ((|w|^2 + s^2) b^2 + |s v - w alpha|^2)/N, w = r - kappa |e'| + i t (docs/certificate.md has each line).

use super::affine::Affine;
use super::ball::{Ball, not_negative};
use super::bound::{Bound, SMALLER, WIDER, Witness, largest};
use super::expansion::{Expansion, Moved, STEEPEST};
use super::halving::LARGER;
use super::target::{MAX_POINTS, Target};
use linkwright_leaves::{Cell, Class, Lengths};

/// Returns the least and greatest kappa over a range of p: by the crank's own limits, and by the ground's.
fn ranges(lengths: &Lengths, class: Class, p: [f64; 2]) -> [[f64; 2]; 2] {
    let [low, high] = lengths.ground;
    let by_ground = match class {
        Class::CrankRocker => [low * p[0], high * p[1]],
        Class::DoubleCrank => [low / p[1], if p[0] > 0.0 { high / p[0] } else { f64::INFINITY }],
    };
    [lengths.crank, by_ground]
}

/// Returns whether no length of the crank fits any p of the box.
pub fn exclude(lengths: &Lengths, class: Class, cell: &Cell) -> bool {
    let p = [cell.low[0], cell.high[0].min(1.0)];
    let [own, by_ground] = ranges(lengths, class, p);
    own[0] > by_ground[1] * LARGER || by_ground[0] > own[1] * LARGER
}

/// Enclosures of linear functionals of u over a box.
struct Parts {
    /// <y, u>: |eta| is at least its real part.
    beta: Affine,
    v: [Affine; 2],
    alpha: [Affine; 2],
    /// The squared length N = |u'|^2.
    length_sq: Affine,
    /// D = N - |v|^2.
    off_crank: Affine,
    /// The contribution of each axis to the rest of <y, u>.
    own: [f64; 4],
}

/// Encloses <w, u> = sum conj(w_j) u_j over the box.
#[inline(always)]
fn functional(w: &[[f64; 2]], u: &[[f64; 2]], moved: &[Moved], h: &[f64; 4], slack: f64) -> [Affine; 2] {
    let (mut re, mut im) = (0.0, 0.0);
    let (mut by_re, mut by_im) = ([0.0; 4], [0.0; 4]);
    let mut rest = 0.0;
    for ((w, u), moved) in w.iter().zip(u).zip(moved) {
        let c = [w[0] * u[0] + w[1] * u[1], w[0] * u[1] - w[1] * u[0]];
        re += c[0];
        im += c[1];
        for k in 0..4 {
            let t = moved.t[k] * h[k];
            by_re[k] -= c[1] * t;
            by_im[k] += c[0] * t;
        }
        rest += (w[0] * w[0] + w[1] * w[1]).sqrt() * moved.rest;
    }
    let rest = rest * LARGER + slack;
    [Affine { mid: re, by: by_re, rest }, Affine { mid: im, by: by_im, rest }]
}

impl Parts {
    fn new(target: &Target, class: Class, cell: &Cell) -> Self {
        let n = target.len();
        let expansion = Expansion::new(&target.turn, class, cell);
        let Expansion { h, u, .. } = &expansion;
        // The rounding of every sum of n products.
        let root_n = (n as f64).sqrt() * LARGER;
        let rounding = (n as f64 + 8.0) * 2.0 * f64::EPSILON * root_n;
        let turning = rounding * (1.0 + (h[0] + h[1] + h[2] + h[3]) * STEEPEST);
        let Witness { y, size: size_y, along } = Witness::new(target, u, 2, SMALLER, rounding);
        let common = expansion.common_turn(&size_y);
        let moved: [Moved; MAX_POINTS] =
            std::array::from_fn(|j| if j < n { expansion.moved(j, &common) } else { Moved::NOT });
        let mut own = [0.0; 4];
        for j in 0..n {
            for (own, part) in own.iter_mut().zip(moved[j].own) {
                *own += size_y[j] * part;
            }
        }
        let of =
            |w: &[[f64; 2]], error: f64| functional(w, &u[..n], &moved[..n], h, error * root_n + turning);
        let [beta, _] = of(&y[..n], along * WIDER);
        let error = target.basis_error;
        let [v, alpha] = [1, 2].map(|k| of(&target.basis[k], error));
        let mut length_sq = Affine::exact(n as f64);
        if !target.pivot_known {
            let m = of(&target.basis[0], error);
            length_sq = length_sq - m[0].square() - m[1].square();
        }
        let off_crank = length_sq - v[0].square() - v[1].square();
        Parts { beta, v, alpha, length_sq, off_crank, own }
    }
}

/// The condition X^2 + Y^2 >= L W^2 over the box, which holds if X cos a + Y sin a >= L^(1/2) W at one angle a.
struct Condition {
    x: Affine,
    y: Affine,
    w_sq: Affine,
}

impl Condition {
    /// Raises `sum_sq` to the largest L up to `wanted` that bisection certifies, and adds the change along each axis
    /// to `weight`.
    fn certified(&self, wanted: f64, sum_sq: &mut f64, weight: &mut [f64; 4]) {
        let (x, y) = (self.x.mid.max(0.0), self.y.mid);
        let size = (x * x + y * y).sqrt();
        if size.is_nan() || size <= 0.0 {
            return;
        }
        let (cos, sin) = (x / size * SMALLER, y / size * SMALLER);
        let sum = self.x.times(cos) + self.y.times(sin);
        // W <= W^2/(2 m) + m/2.
        let m = self.w_sq.mid.max(0.01 * self.w_sq.high()).max(1e-12).sqrt();
        let w = self.w_sq.times(0.5 / m) + Affine::exact(0.5 * m);
        let holds = |root: f64| (sum - w.times(root)).low() >= 0.0;
        for (weight, by) in weight.iter_mut().zip(sum.by) {
            *weight += 0.25 * by.abs();
        }
        let goal = wanted.sqrt() * (1.0 + 1e-13);
        let found = largest(goal, holds);
        *sum_sq = sum_sq.max(found * found * SMALLER);
    }
}

/// Computes a lower bound of a box for linkages with |Z| <= `cap` and these lengths.
///
/// `wanted` is the sum of squares that would decide the box: the bound is not sharpened beyond it.
pub fn bound(target: &Target, class: Class, cell: &Cell, lengths: &Lengths, cap: f64, wanted: f64) -> Bound {
    let parts = Parts::new(target, class, cell);
    let Parts { beta, v, alpha, length_sq, off_crank, own } = &parts;
    let [r, t] = target.along;
    let s = target.size_sq.root();
    let [r, t, s] = [r, t, s].map(Affine::constant);
    let (h, p) = ((cell.high[0] - cell.low[0]) * 0.5 * LARGER, 0.5 * (cell.low[0] + cell.high[0]));
    let p = Affine::variable(p, h, 0);
    let mut sum_sq = 0.0;
    let mut weight = [0.0; 4];
    let [v_spread, a_spread] = [v, alpha].map(spread);
    for k in 0..4 {
        let [v_k, a_k] = [v, alpha].map(|z| z[0].by[k].abs() + z[1].by[k].abs());
        weight[k] = s.mid * own[k] * length_sq.mid.max(0.0).sqrt()
            + t.mid.abs() * v_k * v_spread
            + s.mid * 0.5 * (v_k * a_spread + a_k * v_spread);
    }
    let fixed = lengths.ground[0] == lengths.ground[1];
    let (v_re_a, v_im_a) = (v[0] * alpha[0] + v[1] * alpha[1], alpha[0] * v[1] - alpha[1] * v[0]);
    if !fixed {
        let q = t * *off_crank - s * v_im_a;
        let x = s * *beta * length_sq.root();
        Condition { x, y: q, w_sq: *off_crank * *length_sq }.certified(wanted, &mut sum_sq, &mut weight);
    }
    let crank = Affine::constant(target.crank);
    let at_length = |kappa: Affine, side: f64, sum_sq: &mut f64, weight: &mut [f64; 4]| {
        let w = r - kappa * crank;
        // With a side, the best length kappa* has to be beyond this one on the whole box; with side 0, this is the
        // only length.
        if side != 0.0 && ((w * *off_crank - s * v_re_a).times(side)).low() <= 0.0 {
            return;
        }
        let size_sq = w.square() + t.square() + s.square();
        let x = size_sq.root() * *beta;
        let part = [s * v[0] - (w * alpha[0] - t * alpha[1]), s * v[1] - (w * alpha[1] + t * alpha[0])];
        let far = (part[0].mid * part[0].mid + part[1].mid * part[1].mid).sqrt();
        let (cos, sin) = if far > 0.0 { (part[0].mid / far, part[1].mid / far) } else { (1.0, 0.0) };
        let y = (part[0].times(cos) + part[1].times(sin)).times(SMALLER);
        Condition { x, y, w_sq: *length_sq }.certified(wanted, sum_sq, weight);
    };
    let by_ground = |ground: f64| {
        let ground = Affine::constant(Ball { mid: ground, rad: ground * 4.0 * f64::EPSILON });
        match class {
            Class::CrankRocker => Some(p * ground),
            Class::DoubleCrank => p.inverse().map(|over| over * ground),
        }
    };
    if fixed && let Some(kappa) = by_ground(lengths.ground[0]) {
        at_length(kappa, 0.0, &mut sum_sq, &mut weight);
    }
    if sum_sq < wanted {
        // Below the least length: the derivative by kappa is positive there, and the sum is convex in kappa.
        for (side, own, ground) in
            [(-1.0, lengths.crank[0], lengths.ground[0]), (1.0, lengths.crank[1], lengths.ground[1])]
        {
            let mut ignored = [0.0; 4];
            if own.is_finite() {
                at_length(Affine::exact(own), side, &mut sum_sq, &mut ignored);
            }
            let limited = ground.is_finite() && ground > 0.0 && !fixed;
            if limited && let Some(kappa) = by_ground(ground) {
                at_length(kappa, side, &mut sum_sq, &mut ignored);
            }
        }
    }
    // |T' - kappa e' - Z u'| >= |T_y| - |Z| |<y, u>| for y = tau, and for y along i t E + s tau.
    let alpha_sq = alpha[0].square() + alpha[1].square();
    let longest = |sq: Affine| not_negative(sq.high()).sqrt() * LARGER;
    let short = s.low() - cap * longest(alpha_sq);
    let y = [t * v[1] + s * alpha[0], s * alpha[1] - t * v[0]];
    let size = (t.square() + s.square()).root();
    let short_2 = size.low() - cap * longest(y[0].square() + y[1].square()) / size.low().max(1e-300);
    let short = short.max(short_2);
    if short > 0.0 {
        sum_sq = sum_sq.max(short * short * (1.0 - 1e-9));
    }
    Bound { sum_sq, weight }
}

fn spread(z: &[Affine; 2]) -> f64 {
    z.iter().flat_map(|z| z.by).map(f64::abs).sum()
}
