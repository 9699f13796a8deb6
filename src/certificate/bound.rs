//! The bound of a box: a number L such that no point of the box has a sum of squares below it.
//!
//! SSE >= L exactly where |eta| >= kappa |<tau, u>| with kappa^2 = L/(S - L), eta being u off 1, e and tau. For a unit
//! vector y across all three |eta| >= |<y, u>|: two linear functionals of u are left. y is taken from the box's
//! centre; both are expanded there with exact first derivatives, and what the expansion leaves out is bounded by the
//! second derivatives of theta over the box (docs/certificate.md has each line).

use super::chart::{Centre, Class, Motion};
use super::target::{MAX_POINTS, Target};

/// A box of the chart: p, phi_0, g, d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cell {
    /// The lower ends.
    pub low: [f64; 4],
    /// The upper ends.
    pub high: [f64; 4],
}

impl Cell {
    /// The middle and half the width, so that the box lies within both.
    pub(super) fn centre(&self) -> ([f64; 4], [f64; 4]) {
        let mut c = [0.0; 4];
        let mut h = [0.0; 4];
        for k in 0..4 {
            c[k] = 0.5 * (self.low[k] + self.high[k]);
            h[k] = (self.high[k] - c[k]).max(c[k] - self.low[k]) * LARGER;
        }
        (c, h)
    }

    /// Both halves along an axis.
    pub(super) fn split(&self, axis: usize) -> [Cell; 2] {
        let middle = 0.5 * (self.low[axis] + self.high[axis]);
        let (mut lower, mut upper) = (*self, *self);
        lower.high[axis] = middle;
        upper.low[axis] = middle;
        [lower, upper]
    }
}

/// What a box's bound is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// L: at most the sum of squares of every linkage in the box with |Z| within the cap.
    pub sum_sq: f64,
    /// How much each axis adds to what the bound loses.
    pub weight: [f64; 4],
}

/// Majorants are computed in plain arithmetic from non-negative numbers and from differences that are kept above
/// [`NEAR`] times what they are taken from; this covers their rounding.
const LARGER: f64 = 1.0 + 1e-9;
/// Below this f or sin gamma no second derivatives are used.
const NEAR: f64 = 1e-4;

/// A difference, less what its rounding can be.
fn less(x: f64) -> f64 {
    x - 1e-12
}

/// At least |cos g|, |sin g|, |cos d|, |sin d| over a box.
struct Ranges([f64; 4], f64);

impl Ranges {
    fn new(c: &Centre, h: &[f64; 4], p: f64) -> Self {
        let up = |x: f64, h: f64| (x + h).min(1.0);
        Ranges(
            [
                up(c.cos_g.magnitude(), h[2]),
                up(c.sin_g.magnitude(), h[2]),
                up(c.cos_d.magnitude(), h[3]),
                up(c.sin_d.magnitude(), h[3]),
            ],
            p,
        )
    }

    /// At least |d gamma/d phi|: both forms of sin^2 gamma >= cos^2 d sin^2 psi + sin^2 d sin^2 chi and the same with
    /// g, with the Cauchy inequality, leave the root of cos^2 psi_phi^2 + sin^2 chi_phi^2.
    #[inline(always)]
    fn gamma_phi(&self, p: f64, f: f64) -> f64 {
        ((p + self.0[1].min(self.0[3])) / f).min(1.0 / f)
    }

    /// At least how far gamma is from its value at the centre: 1 in g and d, 1/f in p.
    #[inline(always)]
    fn gamma(&self, f: f64, h: &[f64; 4]) -> f64 {
        h[2] + h[3] + h[0] / f + h[1] * self.gamma_phi(self.1, f)
    }
}

/// The largest of the second derivatives of theta, in absolute value, over a box; by p, phi, g, d.
#[inline(always)]
fn second_derivatives(r: &Ranges, m: &Motion, p: f64, h: &[f64; 4], f: f64, s: f64) -> [[f64; 4]; 4] {
    let inv = 1.0 / f;
    let chi_range = (h[0] + h[1]) * inv;
    let psi_range = (p * h[1] + h[0]) * inv;
    let sin_psi = (m.sin_psi.magnitude() + psi_range).min(p);
    let cos_psi = m.cos_psi.magnitude() + psi_range;
    let cos_psi = cos_psi.min(1.0);
    let sin_chi = (m.sin_chi.magnitude() + chi_range).min(1.0);
    let cos_chi = (m.cos_chi.magnitude() + chi_range).min(1.0);
    let cos = (m.cos.magnitude() + r.gamma(f, h)).min(1.0);
    let [cos_g, sin_g, cos_d, sin_d] = r.0;
    let (cc, sc, cs, ss) = (cos_g * cos_d, sin_g * cos_d, cos_g * sin_d, sin_g * sin_d);
    let over = 1.0 / s;
    // psi and chi: chi_phi = cos psi/f, psi_phi = p cos chi/f, psi_p = chi_p = sin chi/f.
    let psi_phi = p * cos_chi * inv;
    let chi_phi = cos_psi * inv;
    let psi_p = sin_chi * inv;
    let psi_phiphi = sin_psi * (cos_psi + p * cos_chi) * inv * inv;
    let psi_phip = (cos_chi + p * inv * (cos_chi * cos_chi).max(sin_chi * sin_chi)) * inv;
    let psi_pp = 2.0 * sin_chi * cos_chi * inv * inv;
    // First derivatives of gamma.
    let (a, b) = (cc * sin_psi * over, ss * sin_chi * over);
    let gamma_phi = (a * psi_phi + b * chi_phi).min(r.gamma_phi(p, f));
    let gamma_p = ((a + b) * psi_p).min(inv);
    let gamma_g = ((sc * cos_psi + cs * cos_chi) * over).min(1.0);
    let gamma_d = ((cs * cos_psi + sc * cos_chi) * over).min(1.0);
    // Second: gamma_kl = -(C_kl + C gamma_k gamma_l)/sin gamma.
    let (psi_sq, chi_sq) = (sin_psi * sin_psi, sin_chi * sin_chi);
    let over_sq = over * over;
    let (cd, sd, cg, sg) = (cos_d * cos_d, sin_d * sin_d, cos_g * cos_g, sin_g * sin_g);
    let gg = cos * ((cd * psi_sq + sd * chi_sq) * over_sq).min(1.0) * over;
    let dd = cos * ((cg * psi_sq + sg * chi_sq) * over_sq).min(1.0) * over;
    let gd = ((ss * cos_psi * chi_sq + cc * cos_chi * psi_sq) * over_sq).min(1.0) * over;
    let mixed = |by_psi: f64, by_chi: f64, psi_k: f64, chi_k: f64, gamma_l: f64, gamma_k: f64| {
        (by_psi * sin_psi * psi_k + by_chi * sin_chi * chi_k + cos * gamma_l * gamma_k) * over
    };
    let gp = mixed(sc, cs, psi_p, psi_p, gamma_g, gamma_p);
    let gphi = mixed(sc, cs, psi_phi, chi_phi, gamma_g, gamma_phi);
    let dp = mixed(cs, sc, psi_p, psi_p, gamma_d, gamma_p);
    let dphi = mixed(cs, sc, psi_phi, chi_phi, gamma_d, gamma_phi);
    let outer = |kl: [f64; 4], psi_kl: f64, gamma_kl: f64| {
        let [psi_k, psi_l, chi_k, chi_l] = kl;
        let by_psi = cc * (cos_psi * psi_k * psi_l + sin_psi * psi_kl);
        let by_chi = ss * (cos_chi * chi_k * chi_l + sin_chi * psi_kl);
        (by_psi + by_chi + cos * gamma_kl) * over + psi_kl
    };
    let pp = outer([psi_p; 4], psi_pp, gamma_p * gamma_p);
    let pphi = outer([psi_p, psi_phi, psi_p, chi_phi], psi_phip, gamma_p * gamma_phi);
    let phiphi = outer([psi_phi, psi_phi, chi_phi, chi_phi], psi_phiphi, gamma_phi * gamma_phi);
    [[pp, pphi, gp, dp], [pphi, phiphi, gphi, dphi], [gp, gphi, gg, gd], [dp, dphi, gd, dd]]
}

/// The bound of a box for linkages with |Z| <= `cap`.
///
/// `wanted` is the sum of squares that would decide the box: nothing above it is worked out.
pub fn bound(target: &Target, class: Class, cell: &Cell, cap: f64, wanted: f64) -> Bound {
    let n = target.len();
    let (middle, h) = cell.centre();
    let c = Centre::new(middle[0], middle[1], middle[2], middle[3]);
    let p_high = cell.high[0].min(1.0);
    let ranges = Ranges::new(&c, &h, p_high);
    // The crank's own turn, which a double-crank's coupler makes with it.
    let own_turn = if class == Class::DoubleCrank { 1.0 } else { 0.0 };
    let mut u = [[0.0; 2]; MAX_POINTS];
    let mut u_error = [0.0; MAX_POINTS];
    let mut gradient = [[0.0; 4]; MAX_POINTS];
    let mut gradient_error = [0.0; MAX_POINTS];
    let mut second = [[0.0; 4]; MAX_POINTS];
    let mut chord = [2.0; MAX_POINTS];
    let mut smooth = [false; MAX_POINTS];
    let mut near_f = [0.0; MAX_POINTS];
    for j in 0..n {
        let m = Motion::at(class, &c, target.turn[j]);
        let f = less(m.f.mid - m.f.rad - h[0] - h[1]);
        near_f[j] = m.f.mid;
        u[j] = [m.u[0].mid, m.u[1].mid];
        u_error[j] = m.u[0].rad + m.u[1].rad;
        let known = u_error[j] < 1e-3;
        if !known {
            // Nothing is known but that it is a unit vector.
            u[j] = [1.0, 0.0];
            u_error[j] = 0.0;
            continue;
        }
        if f >= NEAR {
            // theta (less the crank's turn, for double-cranks) moves by gamma and psi.
            let gamma = ranges.gamma(f, &h);
            chord[j] = (gamma + (h[0] + p_high * h[1]) / f) * LARGER;
            let s = less(m.sin.mid - m.sin.rad - gamma);
            if s >= NEAR {
                let all = second_derivatives(&ranges, &m, p_high, &h, f, s);
                let mut total = 0.0;
                for k in 0..4 {
                    second[j][k] = 0.5 * h[k] * (0..4).map(|l| all[k][l] * h[l]).sum::<f64>() * LARGER;
                    total += second[j][k];
                    gradient[j][k] = m.gradient[k].mid;
                    gradient_error[j] += h[k] * m.gradient[k].rad;
                }
                smooth[j] = total < 2.0 && gradient_error[j] < 1.0;
            }
        }
    }
    // The witness: u off the basis, of length 1.
    let dot = |b: &[[f64; 2]], v: &[[f64; 2]]| {
        b.iter().zip(v).fold((0.0, 0.0), |(re, im), (b, v)| {
            (re + b[0] * v[0] + b[1] * v[1], im + b[0] * v[1] - b[1] * v[0])
        })
    };
    let mut y = u;
    for b in &target.basis {
        let (re, im) = dot(b, &y[..n]);
        for (b, v) in b.iter().zip(&mut y) {
            *v = [v[0] - (b[0] * re - b[1] * im), v[1] - (b[0] * im + b[1] * re)];
        }
    }
    let across = y[..n].iter().map(|v| v[0] * v[0] + v[1] * v[1]).sum::<f64>().sqrt();
    let scale = if across > 0.0 { 1.0 / across } else { 0.0 };
    for v in &mut y[..n] {
        *v = [v[0] * scale, v[1] * scale];
    }
    // What y has along the exact basis, and the rounding of every sum of n products below.
    let rounding = (n as f64 + 8.0) * 2.0 * f64::EPSILON * (n as f64).sqrt();
    let mut along = 0.0;
    for b in &target.basis {
        let (re, im) = dot(b, &y[..n]);
        along += re.abs() + im.abs() + rounding + 1.01 * target.basis_error();
    }
    let slack = along * (n as f64).sqrt() * 1.01 + 2.0 * rounding;
    let tau = &target.basis[2];
    let (re, im) = dot(tau, &u[..n]);
    let beta = re.hypot(im);
    let turn = if beta > 0.0 { [re / beta, im / beta] } else { [1.0, 0.0] };
    // The common turn of u, which changes neither functional's size: the mean of the gradients.
    let mut common = [0.0; 4];
    let mut total = 0.0;
    let mut size_y = [0.0; MAX_POINTS];
    for j in 0..n {
        size_y[j] = (y[j][0] * y[j][0] + y[j][1] * y[j][1]).sqrt();
        if smooth[j] {
            total += size_y[j];
            for k in 0..4 {
                common[k] += size_y[j] * gradient[j][k];
            }
        }
    }
    common = if total > 0.0 { common.map(|sum| sum / total) } else { [0.0, own_turn, 0.0, 0.0] };
    let turned: f64 = (0..4).map(|k| (common[k] - if k == 1 { own_turn } else { 0.0 }).abs() * h[k]).sum();
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
        let flat = (chord[j] + turned).min(2.0);
        let mut own = [0.0; 4];
        let mut rest = flat;
        if smooth[j] {
            let mut linear = 0.0;
            let mut quadratic = 0.0;
            let mut t = [0.0; 4];
            for k in 0..4 {
                t[k] = gradient[j][k] - common[k];
                linear += t[k].abs() * h[k];
                quadratic += second[j][k];
            }
            let far = linear + quadratic + gradient_error[j];
            let expanded = quadratic + 0.5 * far * far + gradient_error[j];
            if expanded < flat {
                rest = expanded;
                for k in 0..4 {
                    own[k] = second[j][k] + 0.5 * far * t[k].abs() * h[k];
                    a[k] -= cy[1] * t[k];
                    b_re[k] -= ct[1] * t[k];
                    b_im[k] += ct[0] * t[k];
                }
            }
        }
        if rest == flat {
            // The chord's parts.
            let steep = 1.0 / near_f[j].max(NEAR);
            let by_phi = ranges.gamma_phi(p_high, near_f[j].max(NEAR)) + p_high * steep;
            own = [2.0 * steep * h[0], by_phi * h[1], h[2], h[3]];
        }
        rest += u_error[j] * (2.0 + rest);
        rest_y += size_y[j] * rest;
        rest_tau += size_tau * rest;
        for k in 0..4 {
            weight[k] += size_y[j] * own[k];
        }
    }
    // Every sum and product below has non-negative parts, or its rounding is within `slack`.
    let rest_y = rest_y * LARGER + slack + rounding * (h[0] + h[1] + h[2] + h[3]) * 1e5;
    let rest_tau = rest_tau * LARGER + slack + rounding * (h[0] + h[1] + h[2] + h[3]) * 1e5;
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
        (value - rest_y - kappa * mean - linear * LARGER) - 1e-12 * (1.0 + kappa * longest) >= 0.0
    };
    for k in 0..4 {
        weight[k] += 0.25 * (a[k] - slope * b_re[k] * 0.1).abs() * h[k];
    }
    let size_sq = target.size_sq();
    let reached = |kappa: f64| size_sq * (kappa * kappa / (1.0 + kappa * kappa)) * (1.0 - 1e-13);
    let goal = (wanted / (size_sq - wanted)).sqrt() * (1.0 + 1e-12);
    let mut sum_sq = 0.0_f64;
    if wanted < size_sq {
        if certified(goal) {
            sum_sq = reached(goal);
        } else if certified(0.0) {
            let (mut low, mut high) = (0.0, goal);
            for _ in 0..12 {
                let kappa = 0.5 * (low + high);
                if certified(kappa) { low = kappa } else { high = kappa }
            }
            sum_sq = reached(low);
        }
    }
    let short = size_sq.sqrt() * (1.0 - 1e-13) - cap * longest * LARGER;
    if short > 0.0 {
        sum_sq = sum_sq.max(short * short * (1.0 - 1e-13));
    }
    Bound { sum_sq, weight }
}
