//! The expansion of the coupler's directions over a box: first derivatives at its centre, and a bound of the
//! remainder.
//!
//! u_j = e^{i theta_j}. Less a common turn, theta_j is a linear part t_j and a rest that the second derivatives of
//! theta over the box bound; if these are not bounded, the chord of u_j is (docs/certificate.md has each line).

use super::ball::Ball;
use super::chart::{Centre, Motion};
use super::halving::{LARGER, centre};
use super::target::MAX_POINTS;
use linkwright_leaves::{Cell, Class};

/// The least f and sin gamma with which second derivatives are used.
const NEAR: f64 = 1e-4;
/// An upper bound of every slope |t_k| of a [`Moved`], to which the rounding of the sums of n products with slopes is
/// proportional.
///
/// Slopes of theta are at most 2/f <= 2/[`NEAR`] = 2e4 (docs/certificate.md, Ranges); no slope above half of this is
/// used, and a slope less their mean is at most twice as large.
pub(super) const STEEPEST: f64 = 1e5;

/// Returns a difference less a bound of its rounding.
fn less(x: f64) -> f64 {
    x - 1e-12
}

/// Upper bounds of |cos g|, |sin g|, |cos d|, |sin d| over a box, and the greatest p.
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

    /// Returns an upper bound of |d gamma/d phi|: both forms of sin^2 gamma >= cos^2 d sin^2 psi + sin^2 d sin^2 chi
    /// and the same with g, with the Cauchy inequality, leave the root of cos^2 psi_phi^2 + sin^2 chi_phi^2.
    #[inline(always)]
    fn gamma_phi(&self, p: f64, f: f64) -> f64 {
        ((p + self.0[1].min(self.0[3])) / f).min(1.0 / f)
    }

    /// Returns an upper bound of the distance of gamma from its value at the centre: slope 1 in g and d, 1/f in p.
    #[inline(always)]
    fn gamma(&self, f: f64, h: &[f64; 4]) -> f64 {
        h[2] + h[3] + h[0] / f + h[1] * self.gamma_phi(self.1, f)
    }
}

/// Returns upper bounds of the second derivatives of theta, in absolute value, over a box; by p, phi, g, d.
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

/// The expansion of the directions u_j over a box.
pub(super) struct Expansion {
    /// Half the box's widths.
    pub h: [f64; 4],
    p_high: f64,
    ranges: Ranges,
    /// The crank's own turn, which a double-crank's coupler makes with it.
    own_turn: f64,
    /// The directions u_j at the centre.
    pub u: [[f64; 2]; MAX_POINTS],
    around: [Around; MAX_POINTS],
}

/// The behaviour of one direction around the centre.
#[derive(Clone, Copy)]
struct Around {
    /// A bound of the error of u_j at the centre.
    error: f64,
    /// The gradient of theta_j, with a bound of what its error makes of it over the box.
    gradient: [f64; 4],
    gradient_error: f64,
    /// Bounds of the parts of the remainder of theta_j, by axes.
    second: [f64; 4],
    /// A bound of the distance of u_j from its value at the centre.
    chord: f64,
    /// Whether gradient and second derivatives are known.
    smooth: bool,
    /// f at the centre.
    near_f: f64,
}

impl Around {
    /// Of a unit vector nothing else is known.
    const UNKNOWN: Around = Around {
        error: 0.0,
        gradient: [0.0; 4],
        gradient_error: 0.0,
        second: [0.0; 4],
        chord: 2.0,
        smooth: false,
        near_f: 0.0,
    };
}

/// A turn common to all u_j, which a bound leaves out, with its extent over the box beyond the crank's own turn.
pub(super) struct CommonTurn {
    by: [f64; 4],
    beyond: f64,
}

/// The movement of u_j over a box, less the common turn: within `rest` of u_j (1 + i t . x).
#[derive(Clone, Copy)]
pub(super) struct Moved {
    /// The slopes of theta_j; 0 if only a chord is known.
    pub t: [f64; 4],
    /// A bound of the remainder.
    pub rest: f64,
    /// The contribution of each axis to the remainder.
    pub own: [f64; 4],
}

impl Moved {
    /// No movement.
    pub const NOT: Moved = Moved { t: [0.0; 4], rest: 0.0, own: [0.0; 4] };
}

impl Expansion {
    /// Expands the directions at the crank's turns over a box.
    #[inline(always)]
    pub fn new(turn: &[[Ball; 2]], class: Class, cell: &Cell) -> Self {
        let (middle, h) = centre(cell);
        let c = Centre::new(middle[0], middle[1], middle[2], middle[3]);
        let p_high = cell.high[0].min(1.0);
        let ranges = Ranges::new(&c, &h, p_high);
        // The crank's own turn, which a double-crank's coupler makes with it.
        let own_turn = if class == Class::DoubleCrank { 1.0 } else { 0.0 };
        let mut u = [[0.0; 2]; MAX_POINTS];
        let mut around = [Around::UNKNOWN; MAX_POINTS];
        for ((turn, u), around) in turn.iter().zip(&mut u).zip(&mut around) {
            let m = Motion::at(class, &c, *turn);
            let f = less(m.f.mid - m.f.rad - h[0] - h[1]);
            around.near_f = m.f.mid;
            let error = m.u[0].rad + m.u[1].rad;
            let known = error < 1e-3;
            if !known {
                // Nothing is known but that it is a unit vector.
                *u = [1.0, 0.0];
                continue;
            }
            (*u, around.error) = ([m.u[0].mid, m.u[1].mid], error);
            if f >= NEAR {
                // theta (less the crank's turn, for double-cranks) moves by gamma and psi.
                let gamma = ranges.gamma(f, &h);
                around.chord = (gamma + (h[0] + p_high * h[1]) / f) * LARGER;
                let s = less(m.sin.mid - m.sin.rad - gamma);
                if s >= NEAR {
                    let all = second_derivatives(&ranges, &m, p_high, &h, f, s);
                    let mut total = 0.0;
                    for k in 0..4 {
                        let bent: f64 = (0..4).map(|l| all[k][l] * h[l]).sum();
                        around.second[k] = 0.5 * h[k] * bent * LARGER;
                        total += around.second[k];
                        around.gradient[k] = m.gradient[k].mid;
                        around.gradient_error += h[k] * m.gradient[k].rad;
                    }
                    let steep = |slope: &f64| slope.is_nan() || slope.abs() > 0.49 * STEEPEST;
                    around.smooth =
                        total < 2.0 && around.gradient_error < 1.0 && !around.gradient.iter().any(steep);
                }
            }
        }
        Expansion { h, p_high, ranges, own_turn, u, around }
    }

    /// Returns the common turn that is the mean of the gradients by these weights.
    #[inline(always)]
    pub fn common_turn(&self, size_y: &[f64; MAX_POINTS]) -> CommonTurn {
        let mut common = [0.0; 4];
        let mut total = 0.0;
        for (size, around) in size_y.iter().zip(&self.around).filter(|(_, around)| around.smooth) {
            total += size;
            for (common, slope) in common.iter_mut().zip(around.gradient) {
                *common += size * slope;
            }
        }
        let by = if total > 0.0 { common.map(|sum| sum / total) } else { [0.0, self.own_turn, 0.0, 0.0] };
        let own = |k: usize| if k == 1 { self.own_turn } else { 0.0 };
        let beyond = (0..4).map(|k| (by[k] - own(k)).abs() * self.h[k]).sum();
        CommonTurn { by, beyond }
    }

    /// Returns an upper bound of the amount by which the rounding of the slopes' sums moves one of them over the box,
    /// if the rounding of a sum of n products with parts of unit vectors is at most `rounding`.
    ///
    /// ```text
    /// |fl(sum_j w_j t_jk) - sum_j w_j t_jk| <= (n + 4) 2^-53 sum_j |w_j| |t_jk| <= rounding STEEPEST,
    /// sum_j |w_j| <= sqrt n
    /// ```
    ///
    /// for the slope along axis k, which counts h_k times over the box.
    #[inline(always)]
    pub fn turning(&self, rounding: f64) -> f64 {
        let h = &self.h;
        rounding * (h[0] + h[1] + h[2] + h[3]) * STEEPEST
    }

    /// Returns the movement of u_j over the box, less the common turn.
    #[inline(always)]
    pub fn moved(&self, j: usize, common: &CommonTurn) -> Moved {
        let (h, ranges, p_high, around) = (&self.h, &self.ranges, self.p_high, &self.around[j]);
        let flat = (around.chord + common.beyond).min(2.0);
        let mut own = [0.0; 4];
        let mut rest = flat;
        let mut slopes = [0.0; 4];
        if around.smooth {
            let mut linear = 0.0;
            let mut quadratic = 0.0;
            let mut t = [0.0; 4];
            for k in 0..4 {
                t[k] = around.gradient[k] - common.by[k];
                linear += t[k].abs() * h[k];
                quadratic += around.second[k];
            }
            let far = linear + quadratic + around.gradient_error;
            let expanded = quadratic + 0.5 * far * far + around.gradient_error;
            if expanded < flat {
                rest = expanded;
                slopes = t;
                for k in 0..4 {
                    own[k] = around.second[k] + 0.5 * far * t[k].abs() * h[k];
                }
            }
        }
        if rest == flat {
            // The contributions of the axes to the chord.
            let steep = 1.0 / around.near_f.max(NEAR);
            let by_phi = ranges.gamma_phi(p_high, around.near_f.max(NEAR)) + p_high * steep;
            own = [2.0 * steep * h[0], by_phi * h[1], h[2], h[3]];
        }
        rest += around.error * (2.0 + rest);
        Moved { t: slopes, rest, own }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use linkwright_arithmetic::streams::{below, stream, uniform};

    /// Returns a sum of products as it is computed here, and without rounding but in the last digit of the result:
    /// products and sums with their errors (Dekker 1971, Knuth 1969), which are summed apart.
    fn both_sums(terms: &[(f64, f64)]) -> (f64, f64) {
        let (mut plain, mut sum, mut errors) = (0.0, 0.0, 0.0);
        for &(x, y) in terms {
            plain += x * y;
            let product = x * y;
            errors += x.mul_add(y, -product);
            let next = sum + product;
            let part = next - sum;
            errors += (sum - (next - part)) + (product - part);
            sum = next;
        }
        (plain, sum + errors)
    }

    #[test]
    fn slopes_stay_below_the_steepest_and_their_sums_round_by_less_than_is_allowed() {
        let mut random = stream(41, 0);
        let (mut steepest, mut used, mut nearest) = (0.0_f64, 0, 0.0_f64);
        for _ in 0..20_000 {
            let n = 5 + below(&mut random, 24);
            let turn: Vec<[Ball; 2]> = (0..n)
                .map(|_| {
                    // Many of them near the angle at which f is least.
                    let angle = uniform(&mut random, -1.0, 1.0).powi(9) * 3.0;
                    Ball::cos_sin(angle)
                })
                .collect();
            // Towards p = 1, where f comes near 0, with boxes from small to tiny.
            let p = 1.0 - 10f64.powf(uniform(&mut random, -6.0, 0.0));
            let half = 10f64.powf(uniform(&mut random, -9.0, -3.0));
            let g = uniform(&mut random, 0.05, 3.1);
            let d = uniform(&mut random, -1.5, 1.5);
            let middle = [p, 0.0, g, d];
            let cell = Cell { low: middle.map(|x| x - half), high: middle.map(|x| x + half) };
            let class = if below(&mut random, 2) == 0 { Class::CrankRocker } else { Class::DoubleCrank };
            let expansion = Expansion::new(&turn, class, &cell);
            // Unit weights, as those of a witness.
            let mut y: Vec<[f64; 2]> =
                (0..n).map(|_| [uniform(&mut random, -1.0, 1.0), uniform(&mut random, -1.0, 1.0)]).collect();
            let length = y.iter().flatten().map(|v| v * v).sum::<f64>().sqrt();
            y.iter_mut().flatten().for_each(|v| *v /= length);
            let mut size_y = [0.0; MAX_POINTS];
            for (size, y) in size_y.iter_mut().zip(&y) {
                *size = y[0].hypot(y[1]);
            }
            let common = expansion.common_turn(&size_y);
            let moved: Vec<Moved> = (0..n).map(|j| expansion.moved(j, &common)).collect();
            let rounding = (n as f64 + 8.0) * 2.0 * f64::EPSILON * (n as f64).sqrt();
            for k in 0..4 {
                let mut terms = Vec::with_capacity(2 * n);
                for (y, (moved, u)) in y.iter().zip(moved.iter().zip(&expansion.u)) {
                    steepest = steepest.max(moved.t[k].abs());
                    used += usize::from(moved.t[k] != 0.0);
                    assert!(moved.t[k].abs() <= STEEPEST, "{}", moved.t[k]);
                    // Im(conj(y) u) t, each product on its own.
                    terms.push((y[0] * u[1], moved.t[k]));
                    terms.push((-y[1] * u[0], moved.t[k]));
                }
                let (plain, exact) = both_sums(&terms);
                let off = (plain - exact).abs();
                let allowed = rounding * STEEPEST;
                assert!(off <= allowed, "{off} {allowed}");
                nearest = nearest.max(off / allowed);
            }
        }
        // The test has seen steep slopes, and sums that round.
        assert!(steepest > 1e3 && used > 100_000 && nearest > 0.0, "{steepest} {used} {nearest}");
    }
}
