//! Points of the certificate's chart (docs/certificate.md), from their definition: links, cognates, coupler directions,
//! and the least sum of squares.

use linkwright::internals::numbers::arithmetic::Complex;
use linkwright::internals::numbers::bound::Search;
use linkwright::internals::numbers::leaves::{Cell, Class, HALVED, OPEN};

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

/// Computes the sum of squares left by the best A, K and Z for given directions of the coupler, in plain arithmetic.
pub fn sum_sq(points: &[[f64; 2]], turns_deg: &[f64], direction: f64, u: &[[f64; 2]]) -> f64 {
    let complex = |v: &[[f64; 2]]| v.iter().map(|x| Complex::new(x[0], x[1])).collect::<Vec<_>>();
    let crank = turns_deg.iter().map(|deg| Complex::from_polar(1.0, direction * deg.to_radians())).collect();
    let mut basis: Vec<Vec<Complex>> = Vec::new();
    // Twice, against rounding.
    let across = |mut v: Vec<Complex>, basis: &[Vec<Complex>]| {
        for b in basis.iter().chain(basis) {
            let along: Complex = b.iter().zip(&v).map(|(b, v)| b.conj() * v).sum();
            v.iter_mut().zip(b).for_each(|(v, b)| *v -= b * along);
        }
        let length = v.iter().map(|z| z.norm_sqr()).sum::<f64>().sqrt();
        (v, length)
    };
    for column in [vec![Complex::ONE; points.len()], crank, complex(u)] {
        let (off, length) = across(column, &basis);
        if length > 1e-12 {
            basis.push(off.iter().map(|z| z / length).collect());
        }
    }
    across(complex(points), &basis).1.powi(2)
}

/// Returns whether some box that waits contains the point; `chart` is the part of the chart that the search covers.
pub fn waits_at(search: &Search, chart: Cell, point: [f64; 4]) -> bool {
    let holds = |cell: &Cell| (0..4).all(|k| (cell.low[k]..=cell.high[k]).contains(&point[k]));
    let mut boxes = vec![chart];
    search.nodes().codes().any(|code| {
        let cell = boxes.pop().expect("a box for every node");
        if let Some(axis) = code.checked_sub(HALVED).map(usize::from) {
            // The middle in single precision, as the format of the leaves says.
            let middle = f64::from((0.5 * (cell.low[axis] + cell.high[axis])) as f32);
            let (mut lower, mut upper) = (cell, cell);
            (lower.high[axis], upper.low[axis]) = (middle, middle);
            boxes.extend([upper, lower]);
        }
        code == OPEN && holds(&cell)
    })
}
