//! The chart: coordinates of every four-bar whose input turns fully, in a compact box of four numbers.
//!
//! p in [0, 1] is a/g for crank-rockers and g/a for double-cranks; phi_0 is the first crank angle from the ground
//! line; gamma is the angle from the diagonal CB to the coupler, and g, d are half the sum and half the difference of
//! its values at phi = 0 and phi = pi. With f = |e^{i phi} - p| and psi = -arg(1 - p e^{i phi}), chi = phi + psi:
//!
//! ```text
//! e^{i chi} = (e^{i phi} - p)/f        sin psi = p sin chi        cos psi = (1 - p cos phi)/f
//! cos gamma = cos g cos d cos psi - sin g sin d cos chi           gamma in [0, pi]
//! u = e^{i (gamma - psi)}  crank-rocker;    u = e^{i (gamma + chi)}  double-crank
//! ```
//!
//! u is the coupler's direction up to a constant turn, which Z absorbs. The loop closes at every crank angle exactly
//! where |d| <= min(g, pi - g); the one sign t = +1 covers both assemblies: with q = b/g < 0 the
//! equations are those of t = -1.

use super::ball::Ball;
use linkwright_leaves::Class;

/// The centre of a box with the numbers that all points share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Centre {
    pub p: Ball,
    pub phi: [Ball; 2],
    /// cos g cos d, sin g cos d, cos g sin d, sin g sin d.
    pub cc: Ball,
    pub sc: Ball,
    pub cs: Ball,
    pub ss: Ball,
    pub cos_g: Ball,
    pub sin_g: Ball,
    pub cos_d: Ball,
    pub sin_d: Ball,
    pub cos_d_sq: Ball,
    pub sin_d_sq: Ball,
}

impl Centre {
    pub fn new(p: f64, phi: f64, g: f64, d: f64) -> Self {
        let [cg, sg] = Ball::cos_sin(g);
        let [cd, sd] = Ball::cos_sin(d);
        Centre {
            p: Ball::exact(p),
            phi: Ball::cos_sin(phi),
            cc: cg * cd,
            sc: sg * cd,
            cs: cg * sd,
            ss: sg * sd,
            cos_g: cg,
            sin_g: sg,
            cos_d: cd,
            sin_d: sd,
            cos_d_sq: cd.square(),
            sin_d_sq: sd.square(),
        }
    }
}

/// A point of the motion at a box's centre: the direction u and the gradient of its angle theta.
#[derive(Clone, Copy, Debug)]
pub(super) struct Motion {
    pub f: Ball,
    pub cos_psi: Ball,
    pub sin_psi: Ball,
    pub cos_chi: Ball,
    pub sin_chi: Ball,
    /// cos gamma.
    pub cos: Ball,
    /// sin gamma, from sin^2 gamma = C_g^2 + cos^2 d sin^2 psi + sin^2 d sin^2 chi: no cancellation.
    pub sin: Ball,
    pub u: [Ball; 2],
    /// The gradient of theta by p, phi, g, d.
    pub gradient: [Ball; 4],
}

impl Motion {
    /// Computes the motion at the crank angle phi_0 + turn, the turn given by its cosine and sine.
    #[inline(always)]
    pub fn at(class: Class, c: &Centre, turn: [Ball; 2]) -> Self {
        let cos_phi = c.phi[0] * turn[0] - c.phi[1] * turn[1];
        let sin_phi = c.phi[1] * turn[0] + c.phi[0] * turn[1];
        let one = Ball::exact(1.0);
        let dx = cos_phi - c.p;
        let f = (dx.square() + sin_phi.square()).root();
        let inv = one.over(f);
        let (cos_chi, sin_chi) = (dx * inv, sin_phi * inv);
        let cos_psi = (one - c.p * cos_phi) * inv;
        let sin_psi = c.p * sin_chi;
        let cos = c.cc * cos_psi - c.ss * cos_chi;
        let by_g = c.sc * cos_psi + c.cs * cos_chi;
        let by_d = c.cs * cos_psi + c.sc * cos_chi;
        let (psi_sq, chi_sq) = (sin_psi.square(), sin_chi.square());
        let sin = (by_g.square() + c.cos_d_sq * psi_sq + c.sin_d_sq * chi_sq).root();
        let over_sin = one.over(sin);
        let by_psi = c.cc * sin_psi * over_sin;
        let by_chi = -(c.ss * sin_chi * over_sin);
        let psi_p = sin_chi * inv;
        let psi_phi = c.p * cos_chi * inv;
        let chi_phi = one + psi_phi;
        let gamma_p = (by_psi + by_chi) * psi_p;
        let gamma_phi = by_psi * psi_phi + by_chi * chi_phi;
        let (u, theta_p, theta_phi) = match class {
            Class::CrankRocker => (
                [cos * cos_psi + sin * sin_psi, sin * cos_psi - cos * sin_psi],
                gamma_p - psi_p,
                gamma_phi - psi_phi,
            ),
            Class::DoubleCrank => (
                [cos * cos_chi - sin * sin_chi, sin * cos_chi + cos * sin_chi],
                gamma_p + psi_p,
                gamma_phi + chi_phi,
            ),
        };
        let gradient = [theta_p, theta_phi, by_g * over_sin, by_d * over_sin];
        Motion { f, cos_psi, sin_psi, cos_chi, sin_chi, cos, sin, u, gradient }
    }
}
