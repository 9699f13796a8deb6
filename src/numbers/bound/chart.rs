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
//! where |d| <= min(g, pi - g); the one sign t = +1 covers both assemblies (q < 0 in [`Point::ratios`] is t = -1).

use super::ball::Ball;
use linkwright_leaves::Class;

/// A point of the chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// The ratio a/g or g/a.
    pub p: f64,
    /// The first crank angle from the ground line, radians.
    pub phi: f64,
    /// (gamma(0) + gamma(pi))/2.
    pub g: f64,
    /// (gamma(0) - gamma(pi))/2.
    pub d: f64,
}

/// The ratios of b and c over the longer of a and g, and the sign of t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ratios {
    /// b over the longer of crank and ground.
    pub coupler: f64,
    /// c over the longer of crank and ground.
    pub follower: f64,
    /// Whether t = +1.
    pub positive: bool,
}

impl Point {
    /// Computes the ratios of the point's linkage; `None` if the coupler is endless (slider-cranks) or p is 0.
    ///
    /// cos gamma = k1/f + k2 f at f = 1 - p and 1 + p; q = 1/(2 k2), r^2 = q^2 - 2 q k1.
    pub fn ratios(&self) -> Option<Ratios> {
        let sum = self.g.cos() * self.d.cos();
        let difference = -self.g.sin() * self.d.sin() / self.p;
        let k2 = 0.5 * (sum - difference);
        let k1 = 0.5 * (sum + difference) * (1.0 - self.p * self.p);
        let q = 0.5 / k2;
        let r_sq = q * q - 2.0 * q * k1;
        (q.is_finite() && r_sq >= 0.0).then(|| Ratios {
            coupler: q.abs(),
            follower: r_sq.sqrt(),
            positive: q > 0.0,
        })
    }

    /// Computes the point of links p, q, r (over the longer of crank and ground) with t = +1 or -1; `None` if the
    /// input does not turn fully.
    pub fn of_ratios(p: f64, phi: f64, q: f64, r: f64, positive: bool) -> Option<Self> {
        let angle = |f: f64| {
            let cosine = (q * q + f * f - r * r) / (2.0 * q * f);
            (cosine.abs() <= 1.0).then(|| if positive { cosine.acos() } else { (-cosine).acos() })
        };
        let (near, far) = (angle(1.0 - p)?, angle(1.0 + p)?);
        Some(Point { p, phi, g: 0.5 * (near + far), d: 0.5 * (near - far) })
    }

    /// Computes the point of the cognate with the same crank angles: coupler and follower change places.
    pub fn cognate(&self) -> Option<Self> {
        let Ratios { coupler, follower, positive } = self.ratios()?;
        Point::of_ratios(self.p, self.phi, follower, coupler, !positive)
    }

    /// Computes u at crank angle phi_0 + `turn`.
    pub fn direction(&self, class: Class, turn: f64) -> [f64; 2] {
        let [cos, sin] = [(self.phi + turn).cos(), (self.phi + turn).sin()];
        let f = (cos - self.p).hypot(sin);
        let chi = sin.atan2(cos - self.p);
        let psi = (self.p * sin).atan2(1.0 - self.p * cos);
        debug_assert!(f >= 0.0);
        let cosine = self.g.cos() * self.d.cos() * psi.cos() - self.g.sin() * self.d.sin() * chi.cos();
        let gamma = cosine.clamp(-1.0, 1.0).acos();
        let theta = match class {
            Class::CrankRocker => gamma - psi,
            Class::DoubleCrank => gamma + chi,
        };
        [theta.cos(), theta.sin()]
    }
}

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
