//! The reduced form on one assembly as a least-squares problem in a few unknowns, with Kaufman's Jacobian.
//!
//! The residual is r = T' - K a' with the columns orthogonalised in the order 1 (if A is free), u, a: u' is u centred,
//! a' is a centred and off u', T' alike. The model's derivative at fixed A, K, Z is
//!
//! ```text
//! m_x = i Z u dtheta3/dx + (terms that move K or a)       J_x = -(m_x off 1, u', a')         (Kaufman 1975)
//! dtheta3/dphi = k <V, i p e>;  d/dln p = k <V, p e>;  d/dln q = k q <V, u>;  d/dln r = -k r^2
//! k = -t/H,   V = p e + q u - 1
//! ```
//!
//! For a real column (K of known direction) only the real part along it is projected off; for a known K nothing. If a
//! limit is active, |K| = rho(p, q, r) is a product of powers and K moves with it; of a complex K only the turn
//! remains: the real column i K. J^T r is half the exact gradient of the reduced cost: the term that Kaufman leaves out
//! is orthogonal to r.
//!
//! In a motion each angle adds a row sqrt(w) W (theta - arg u - beta), whose derivative is -sqrt(w) W (dtheta3/dx less its
//! weighted mean).

use super::{AngleRole, BodyColumns, GroundKnown, Origin, Projection, Reduced, SINGULAR, UNKNOWNS};
use crate::mechanism::effort::computed;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, Complex, dot, turned, unit_vector};
use crate::numbers::arithmetic::complex_lanes::{Column, ComplexLanes};
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};
use crate::numbers::optimise::compact_lm::{CompactLeastSquares, Normal};
use crate::task::best_frame;
use crate::task::forms::design_space::Shape;
use std::array::from_fn;

/// The physical solution at a point of the reduced form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solution {
    /// Pivots, links and coupler point.
    pub shape: Shape,
    /// The crank angle from the x axis at the prescribed angle 0, if the offset is free; else 0.
    pub offset: f64,
    /// The weighted sum of squares.
    pub cost: f64,
}

/// The part of K that is solved for, which determines the column that is projected off.
#[derive(Clone, Copy, Debug)]
enum KColumn {
    /// Length and direction are solved for.
    Complex,
    /// One real number along a direction of unit length is solved for.
    Real(Complex),
    /// K is known; nothing is solved for.
    Known,
}

/// The linear unknowns and the quantities from which they were solved.
#[derive(Clone, Copy, Debug)]
struct Linear {
    ratio: [f64; 3],
    turn: Complex,
    column: KColumn,
    /// The slope d ln|K| / d(ln p, ln q, ln r) if |K| is not solved for.
    slope: [f64; 3],
    /// The sums of w e and w u.
    e_sum: Complex,
    u_sum: Complex,
    /// The squared norms |u'|^2 and |a'|^2.
    u_sq: f64,
    a_sq: f64,
    k: Complex,
    z: Complex,
}

/// The reduced form on one assembly, with workspace for its columns: nothing is allocated after it is made.
#[derive(Clone, Debug)]
pub struct ProjectedFit<'a> {
    form: &'a Projection,
    assembly: AssemblyMode,
    e: Column,
    /// The unit vectors u.
    u: Column,
    /// The values t/H.
    by_height: Vec<f64>,
    /// The columns u' and a', and T', later the residual r, all times sqrt(w).
    u_off: Column,
    a_off: Column,
    rest: Column,
    /// The columns sqrt(w) m_x.
    moved: [Column; UNKNOWNS],
    /// The errors of the body's angle, in radians; empty for a path.
    angle_errors: Vec<Option<f64>>,
    linear: Option<Linear>,
}

impl<'a> ProjectedFit<'a> {
    /// Creates the fit on an assembly.
    pub fn new(form: &'a Projection, assembly: AssemblyMode) -> Self {
        let n = form.columns.weight.len();
        let column = || [vec![0.0; n], vec![0.0; n]];
        ProjectedFit {
            form,
            assembly,
            e: column(),
            u: column(),
            by_height: vec![0.0; n],
            u_off: column(),
            a_off: column(),
            rest: column(),
            moved: [column(), column(), column(), column()],
            angle_errors: Vec::with_capacity(form.body.as_ref().map_or(0, |body| body.angle.len())),
            linear: None,
        }
    }

    /// Switches to another assembly.
    pub fn set_assembly(&mut self, assembly: AssemblyMode) {
        self.assembly = assembly;
        self.linear = None;
    }

    /// Returns pivots, links and coupler point at `x`; `None` if the cost does not exist or the ground has no length.
    pub fn solution(&mut self, x: &Reduced) -> Option<Solution> {
        let cost = self.cost(x)?;
        let Linear { ratio: [p, q, r], turn, e_sum, u_sum, k, z, .. } = self.linear?;
        let ground = k / p;
        let crank_pivot = match self.form.origin {
            Origin::Mean(mean) => mean - k * e_sum - z * u_sum,
            Origin::CrankPivot(a) => a,
            Origin::FollowerPivot(b) => b - ground,
        };
        let g = ground.norm();
        if !g.is_finite() || g == 0.0 {
            return None;
        }
        let shape = Shape {
            crank_pivot,
            follower_pivot: crank_pivot + ground,
            crank: p * g,
            coupler: q * g,
            follower: r * g,
            offset: z * ground.conj() / g,
        };
        let offset = if self.form.offset_free { turn.arg() + ground.arg() } else { 0.0 };
        Some(Solution { shape, offset, cost })
    }

    /// Computes the positions of the linkage: e, u and t/H at every point; returns the sums of w e and w u. `None` if
    /// the loop is open at a point.
    #[inline(always)]
    fn place(&mut self, [p, q, r]: [f64; 3], turn: Complex) -> Option<[Complex; 2]> {
        let c = &self.form.columns;
        let s = F64x8::splat;
        let (turn, p_, q_sq) = (ComplexLanes::splat(turn), s(p), s(q * q));
        let half = s(0.5 * (q * q - r * r));
        let (by_q, t) = (s(1.0 / q), s(self.assembly.sign()));
        let zero = ComplexLanes::ZERO;
        let (mut gap, mut e_sum, mut u_sum) = (s(f64::INFINITY), zero, zero);
        for at in (0..c.weight.len()).step_by(LANES) {
            let e = ComplexLanes::load(&c.phase, at) * turn;
            let w = ComplexLanes { re: s(1.0) - p_ * e.re, im: -(p_ * e.im) };
            let f2 = w.norm_sq();
            let sigma = half + s(0.5) * f2;
            let height_sq = q_sq * f2 - sigma * sigma;
            gap = height_sq.min(gap);
            let height = t * height_sq.positive_part().sqrt();
            let by = f2.recip() * by_q;
            let u = (w * ComplexLanes { re: sigma, im: height }).scale(by);
            let weight = F64x8::load(&c.weight, at);
            e_sum = e_sum + e.scale(weight);
            u_sum = u_sum + u.scale(weight);
            e.store(&mut self.e, at);
            u.store(&mut self.u, at);
            height.recip().store(&mut self.by_height, at);
        }
        let open = gap.0.iter().any(|gap| gap.is_nan() || *gap <= 0.0);
        let sums = [e_sum.sum(), u_sum.sum()];
        (!open && sums.iter().all(|z| z.re.is_finite() && z.im.is_finite())).then_some(sums)
    }

    /// Orthogonalises the columns, solves for K and Z and leaves the residual in `rest`; returns the cost over the
    /// weights' sum.
    #[inline(always)]
    fn project(&mut self, ratio: [f64; 3], turn: Complex, direction: Complex) -> Option<f64> {
        let [e_sum, u_sum] = self.place(ratio, turn)?;
        let form = self.form;
        let c = &form.columns;
        let s = F64x8::splat;
        let n = c.weight.len();
        let zero = ComplexLanes::ZERO;
        let centred = form.centred();
        let back = if form.measured_from_b() { 1.0 / ratio[0] } else { 0.0 };
        let (u_mean, a_mean) =
            if centred { (u_sum, e_sum) } else { (Complex::new(0.0, 0.0), Complex::new(back, 0.0)) };
        let (u_mean, a_mean) = (ComplexLanes::splat(u_mean), ComplexLanes::splat(a_mean));
        let (mut u_sq, mut a_raw, mut u_a, mut u_t) = (s(0.0), s(0.0), zero, zero);
        for at in (0..n).step_by(LANES) {
            let root = F64x8::load(&c.root_weight, at);
            let u = (ComplexLanes::load(&self.u, at) - u_mean).scale(root);
            let a = (ComplexLanes::load(&self.e, at) - a_mean).scale(root);
            let target = ComplexLanes::load(&c.target, at).scale(root);
            u_sq = u_sq + u.norm_sq();
            a_raw = a_raw + a.norm_sq();
            u_a = u_a + u.dot(a);
            u_t = u_t + u.dot(target);
            u.store(&mut self.u_off, at);
            a.store(&mut self.a_off, at);
            target.store(&mut self.rest, at);
        }
        let (u_sq, a_raw, u_a, u_t) = (u_sq.sum(), a_raw.sum(), u_a.sum(), u_t.sum());
        if u_sq.is_nan() || u_sq <= SINGULAR {
            return None;
        }
        let (along_a, along_t) = (ComplexLanes::splat(u_a / u_sq), ComplexLanes::splat(u_t / u_sq));
        let (mut a_sq, mut a_t) = (s(0.0), zero);
        for at in (0..n).step_by(LANES) {
            let u = ComplexLanes::load(&self.u_off, at);
            let a = ComplexLanes::load(&self.a_off, at) - u * along_a;
            let rest = ComplexLanes::load(&self.rest, at) - u * along_t;
            a_sq = a_sq + a.norm_sq();
            a_t = a_t + a.dot(rest);
            a.store(&mut self.a_off, at);
            rest.store(&mut self.rest, at);
        }
        let (a_sq, a_t) = (a_sq.sum(), a_t.sum());
        let singular = a_sq.is_nan() || a_sq <= SINGULAR * a_raw;
        let (free, column) = match form.ground {
            GroundKnown::Both(length) => (direction * (ratio[0] * length), KColumn::Known),
            _ if singular => return None,
            GroundKnown::Nothing => (a_t / a_sq, KColumn::Complex),
            GroundKnown::Direction => {
                (direction * ((direction.conj() * a_t).re / a_sq), KColumn::Real(direction))
            }
        };
        let (k, column, slope) = match column {
            KColumn::Known => (free, column, [1.0, 0.0, 0.0]),
            KColumn::Complex => match form.limited_length(ratio, free.norm()) {
                None => (free, column, [0.0; 3]),
                Some((length, slope)) => {
                    let unit = unit_vector(free);
                    (unit * length, KColumn::Real(turned(unit)), slope)
                }
            },
            KColumn::Real(_) => match form.limited_length(ratio, (direction.conj() * free).re) {
                None => (free, column, [0.0; 3]),
                Some((length, slope)) => (direction * length, KColumn::Known, slope),
            },
        };
        if k.norm_sqr().is_nan() || k.norm_sqr() <= 0.0 {
            return None;
        }
        let k_ = ComplexLanes::splat(k);
        let mut cost = s(0.0);
        for at in (0..n).step_by(LANES) {
            let rest = ComplexLanes::load(&self.rest, at) - ComplexLanes::load(&self.a_off, at) * k_;
            cost = cost + rest.norm_sq();
            rest.store(&mut self.rest, at);
        }
        let z = (u_t - u_a * k) / u_sq;
        self.linear = Some(Linear { ratio, turn, column, slope, e_sum, u_sum, u_sq, a_sq, k, z });
        let cost = cost.sum();
        cost.is_finite().then_some(cost)
    }

    /// Computes sqrt(w) m_x for all unknowns, then J^T J and J^T r.
    #[inline(always)]
    fn linearised(&mut self, at: &Linear) -> Normal<UNKNOWNS> {
        let form = self.form;
        let c = &form.columns;
        let s = F64x8::splat;
        let n = c.weight.len();
        let [p, q, r] = at.ratio;
        let zero = ComplexLanes::ZERO;
        let i_z = ComplexLanes::splat(turned(at.z));
        let (k, i_k) = (at.k, turned(at.k));
        let from_b = form.measured_from_b();
        let nothing = Complex::new(0.0, 0.0);
        // d(K a)/dln x = slope K a, plus K/p for x = p if the column is e - 1/p: the factor of e and a constant.
        let to_b = if from_b { k / p } else { nothing };
        let by_ratio = |x: usize| {
            let slope = at.slope[x];
            [k * slope, if x == 0 { to_b - to_b * slope } else { -to_b * slope }]
        };
        // d(K a)/dangle: i K e with the crank's turn, i K a with the ground's.
        let (sense, on_e, on_a) = match form.role {
            AngleRole::None => (0.0, 0.0, 0.0),
            AngleRole::Crank => (1.0, 1.0, 0.0),
            AngleRole::Ground => (0.0, 0.0, 1.0),
            AngleRole::Both => (-1.0, -1.0, 1.0),
        };
        let angle_by_e = i_k * (on_e + on_a);
        let angle_constant = if from_b { -i_k * (on_a / p) } else { nothing };
        let terms = [by_ratio(0), by_ratio(1), by_ratio(2), [angle_by_e, angle_constant]]
            .map(|pair| pair.map(ComplexLanes::splat));
        let (p_, q_, r_sq, sense) = (s(p), s(q), s(r * r), s(sense));
        let unknowns = if form.has_angle() { UNKNOWNS } else { UNKNOWNS - 1 };
        let mut mean = [zero; UNKNOWNS];
        let mut on_u = [zero; UNKNOWNS];
        let mut on_a = [zero; UNKNOWNS];
        for at in (0..n).step_by(LANES) {
            let (e, u) = (ComplexLanes::load(&self.e, at), ComplexLanes::load(&self.u, at));
            let root = F64x8::load(&c.root_weight, at);
            let pe = e.scale(p_);
            let v = ComplexLanes { re: pe.re + q_ * u.re - s(1.0), im: pe.im + q_ * u.im };
            // k of the equations.
            let by = -F64x8::load(&self.by_height, at);
            let by_p = by * (v.re * pe.re + v.im * pe.im);
            let by_phi = by * (v.im * pe.re - v.re * pe.im);
            let by_q = by * q_ * (v.re * u.re + v.im * u.im);
            let by_r = -(by * r_sq);
            let turning = i_z * u;
            let by = [by_p, by_q, by_r, by_phi * sense];
            let (u_off, a_off) = (ComplexLanes::load(&self.u_off, at), ComplexLanes::load(&self.a_off, at));
            for x in 0..UNKNOWNS {
                if x >= unknowns {
                    continue;
                }
                let [on_e, constant] = terms[x];
                let m = (turning.scale(by[x]) + (on_e * e + constant)).scale(root);
                mean[x] = mean[x] + m.scale(root);
                on_u[x] = on_u[x] + u_off.dot(m);
                on_a[x] = on_a[x] + a_off.dot(m);
                m.store(&mut self.moved[x], at);
            }
        }
        let mut off = [[zero; 3]; UNKNOWNS];
        for x in 0..UNKNOWNS {
            let along_a = on_a[x].sum() / at.a_sq;
            let along_a = match at.column {
                KColumn::Complex => along_a,
                KColumn::Real(direction) => direction * (direction.conj() * along_a).re,
                KColumn::Known => nothing,
            };
            let centre = if form.centred() { mean[x].sum() } else { nothing };
            off[x] = [centre, on_u[x].sum() / at.u_sq, along_a].map(ComplexLanes::splat);
        }
        let mut matrix = [[s(0.0); UNKNOWNS]; UNKNOWNS];
        let mut gradient = [s(0.0); UNKNOWNS];
        for at in (0..n).step_by(LANES) {
            let root = F64x8::load(&c.root_weight, at);
            let (u_off, a_off) = (ComplexLanes::load(&self.u_off, at), ComplexLanes::load(&self.a_off, at));
            let rest = ComplexLanes::load(&self.rest, at);
            let mut off_m = [zero; UNKNOWNS];
            for x in 0..unknowns {
                let [centre, along_u, along_a] = off[x];
                let m = ComplexLanes::load(&self.moved[x], at) - centre.scale(root);
                let m = m - u_off * along_u - a_off * along_a;
                gradient[x] = gradient[x] + (m.re * rest.re + m.im * rest.im);
                off_m[x] = m;
                for (sum, other) in matrix[x].iter_mut().zip(&off_m).take(x + 1) {
                    *sum = *sum + (m.re * other.re + m.im * other.im);
                }
            }
        }
        let lower = matrix.map(|row| row.map(|sum| form.total_weight * sum.sum()));
        Normal {
            matrix: from_fn(|x| from_fn(|y| if y <= x { lower[x][y] } else { lower[y][x] })),
            gradient: gradient.map(|sum| -form.total_weight * sum.sum()),
        }
    }
}

impl ProjectedFit<'_> {
    /// Computes the errors of the body's angle at the positions; returns their part of the cost, over the weights' sum.
    fn measure_angles(&mut self, body: &BodyColumns) -> f64 {
        let (u, weights) = (&self.u, &self.form.columns.weight);
        let apart = |(j, angle): (usize, &Option<f64>)| angle.map(|angle| angle - u[1][j].atan2(u[0][j]));
        self.angle_errors.clear();
        self.angle_errors.extend(body.angle.iter().enumerate().map(apart));
        let frame = best_frame(&self.angle_errors, weights);
        let mut cost = 0.0;
        for (error, weight) in self.angle_errors.iter_mut().zip(weights) {
            *error = error.map(|apart| wrapped(apart - frame));
            cost += weight * error.unwrap_or(0.0).powi(2);
        }
        body.length * body.length * cost
    }

    /// Adds the rows of the body's angle to J^T J and J^T r.
    fn add_angle_rows(&self, body: &BodyColumns, at: &Linear, normal: &mut Normal<UNKNOWNS>) {
        let form = self.form;
        let [p, q, r] = at.ratio;
        let sense = match form.role {
            AngleRole::None | AngleRole::Ground => 0.0,
            AngleRole::Crank => 1.0,
            AngleRole::Both => -1.0,
        };
        let swing = |j: usize| {
            let [e, u] = [&self.e, &self.u].map(|column| Complex::new(column[0][j], column[1][j]));
            let v = e * p + u * q - 1.0;
            let by = -self.by_height[j];
            [by * p * dot(v, e), by * q * dot(v, u), -by * r * r, by * p * dot(v, turned(e)) * sense]
        };
        let given = || {
            let errors = self.angle_errors.iter().zip(&form.columns.weight).enumerate();
            errors.filter_map(|(j, (error, weight))| Some((swing(j), (*error)?, *weight)))
        };
        let mut mean = [0.0; UNKNOWNS];
        for (swing, _, weight) in given() {
            (0..UNKNOWNS).for_each(|x| mean[x] += swing[x] * weight / body.weight);
        }
        let scale = form.total_weight * body.length * body.length;
        for (swing, error, weight) in given() {
            let row: [f64; UNKNOWNS] = from_fn(|x| swing[x] - mean[x]);
            for x in 0..UNKNOWNS {
                (0..UNKNOWNS).for_each(|y| normal.matrix[x][y] += scale * weight * row[x] * row[y]);
                normal.gradient[x] -= scale * weight * row[x] * error;
            }
        }
    }
}

impl Projection {
    /// Returns the crank's length at an active limit, with d ln / d(ln p, ln q, ln r); `None` if `length` is inside.
    #[inline]
    fn limited_length(&self, [p, q, r]: [f64; 3], length: f64) -> Option<(f64, [f64; 3])> {
        const SLOPES: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, -1.0, 0.0], [1.0, 0.0, -1.0]];
        let factors = [1.0, p, p / q, p / r];
        let (mut low, mut high) = ((0.0, SLOPES[0]), (f64::INFINITY, SLOPES[0]));
        for ((limits, factor), slope) in self.limits.iter().zip(factors).zip(SLOPES) {
            if limits.0 * factor > low.0 {
                low = (limits.0 * factor, slope);
            }
            if limits.1 * factor < high.0 {
                high = (limits.1 * factor, slope);
            }
        }
        if low.0 > high.0 {
            let mean = [0, 1, 2].map(|x| 0.5 * (low.1[x] + high.1[x]));
            return Some(((low.0 * high.0).sqrt(), mean));
        }
        if length < low.0 {
            Some(low)
        } else if length > high.0 {
            Some(high)
        } else {
            None
        }
    }
}

impl CompactLeastSquares<UNKNOWNS> for ProjectedFit<'_> {
    fn cost(&mut self, x: &Reduced) -> Option<f64> {
        self.linear = None;
        let ratio = [x[0].exp(), x[1].exp(), x[2].exp()];
        let (turn, theta) = self.form.angles(x[3]);
        let (turn, direction) = (Complex::from_polar(1.0, turn), Complex::from_polar(1.0, theta));
        let weight = self.form.total_weight;
        computed(self.form.points());
        let cost = vectorised(
            #[inline(always)]
            || self.project(ratio, turn, direction),
        )?;
        let form = self.form;
        let cost = form.body.as_ref().map_or(cost, |body| cost + self.measure_angles(body));
        Some(cost * weight)
    }

    fn normal(&mut self) -> Normal<UNKNOWNS> {
        let nothing = Normal { matrix: [[0.0; UNKNOWNS]; UNKNOWNS], gradient: [0.0; UNKNOWNS] };
        let Some(linear) = self.linear else { return nothing };
        computed(self.form.points());
        let mut normal = vectorised(
            #[inline(always)]
            || self.linearised(&linear),
        );
        if let Some(body) = &self.form.body {
            self.add_angle_rows(body, &linear, &mut normal);
        }
        normal
    }
}
