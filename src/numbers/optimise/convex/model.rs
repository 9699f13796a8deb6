//! The convex model of a step: its linear and quadratic terms, and the points and rows that enter it.

use super::{At, ConvexOptions, Goal, MAX_TAU, Multipliers, norm};
use crate::conic::{ConicProgram, ConicSolution, LinearForm};
use crate::levenberg_marquardt::{BlockLeastSquares, ConstraintRow, PointBlock};
use nalgebra::{SMatrix, SVector, SymmetricEigen};

/// The largest number of points that get a cone of their own in the first program, and the largest number added in a
/// later round: the worst ones.
const CONES: usize = 48;
/// The largest number of rounds in which points that the model puts above the maximum are added.
const CONE_ROUNDS: usize = 12;

/// A step with the predictions of the model.
#[derive(Clone, Debug)]
pub(super) struct Step<const N: usize> {
    pub dx: [f64; N],
    /// The steps of the points' own unknowns.
    pub tau: Vec<f64>,
    /// The objective that the model predicts.
    pub objective: f64,
    /// The lack that the model predicts, dimensionless.
    pub lack: f64,
    /// The largest component of dx in half widths of the trust box: 1 on its boundary.
    pub reach: f64,
    pub multipliers: Multipliers<N>,
    /// The derivative of the Lagrangian by each residual.
    pub forces: Vec<[f64; 2]>,
}

/// The part of the Hessian of the Lagrangian that the linear models leave out, in units of the first half widths of
/// the trust box.
#[derive(Clone, Debug)]
pub(super) struct Curvature<const N: usize> {
    matrix: SMatrix<f64, N, N>,
}

/// The least denominator of a rank-one correction, relative to its factors; with a smaller one it is left out.
const LEAST_DENOMINATOR: f64 = 1e-6;

impl<const N: usize> Curvature<N> {
    pub fn none() -> Self {
        Curvature { matrix: SMatrix::zeros() }
    }

    /// Applies the symmetric rank-one correction from a step that was evaluated, whether it was accepted or not:
    /// B s = sum_j (J_j' - J_j)^T z_j - sum_i mu_i (dg_i' - dg_i).
    pub fn learn<S>(&mut self, options: &ConvexOptions<N>, from: &At<N, S>, to: &At<N, S>, step: &Step<N>) {
        let scale = &options.trust;
        let moved = SVector::<f64, N>::from_fn(|i, _| (to.x[i] - from.x[i]) / scale[i]);
        let mut change = [0.0; N];
        for ((old, new), force) in from.blocks.iter().zip(&to.blocks).zip(&step.forces) {
            for (axis, z) in force.iter().enumerate().filter(|(_, z)| **z != 0.0) {
                for (out, (n, o)) in change.iter_mut().zip(new.jacobian[axis].iter().zip(&old.jacobian[axis]))
                {
                    *out += z * (n - o);
                }
            }
        }
        for ((old, new), mu) in from.rows.iter().zip(&to.rows).zip(&step.multipliers.rows) {
            if *mu != 0.0 {
                for (out, (n, o)) in change.iter_mut().zip(new.gradient.iter().zip(&old.gradient)) {
                    *out -= mu * (n - o);
                }
            }
        }
        let change = SVector::<f64, N>::from_fn(|i, _| change[i] * scale[i]);
        let error = change - self.matrix * moved;
        let denominator = error.dot(&moved);
        if denominator.abs() > LEAST_DENOMINATOR * error.norm() * moved.norm() {
            let corrected = self.matrix + error * error.transpose() / denominator;
            if corrected.iter().all(|v| v.is_finite()) {
                self.matrix = corrected;
            }
        }
    }
}

/// Returns the positive semidefinite part of a symmetric matrix; zero if it has none.
fn positive_part<const N: usize>(matrix: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let symmetric = nalgebra::DMatrix::from_fn(N, N, |i, k| 0.5 * (matrix[(i, k)] + matrix[(k, i)]));
    if !symmetric.iter().all(|v| v.is_finite()) {
        return SMatrix::zeros();
    }
    let eigen = SymmetricEigen::new(symmetric);
    let mut out = SMatrix::<f64, N, N>::zeros();
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > 0.0 {
            for i in 0..N {
                for k in 0..N {
                    out[(i, k)] += value * vector[i] * vector[k];
                }
            }
        }
    }
    out
}

/// A point of the model: r + J dx, of which only the component across `tangent` counts if there is one.
#[derive(Clone, Copy, Debug)]
struct ModelPoint<const N: usize> {
    residual: [f64; 2],
    jacobian: [[f64; N]; 2],
    /// The tangent t_j with |t_j|^2, if the point's own unknown can take up the residual along it.
    tangent: Option<([f64; 2], f64)>,
    weight: f64,
}

impl<const N: usize> ModelPoint<N> {
    /// Computes the residual after a step, r + J dx + t tau, and the point's own step tau.
    fn after(&self, dx: &[f64; N], tau_limit: f64) -> ([f64; 2], f64) {
        let mut r = self.residual;
        for (axis, value) in r.iter_mut().enumerate() {
            *value += self.jacobian[axis].iter().zip(dx).map(|(j, d)| j * d).sum::<f64>();
        }
        match self.tangent {
            None => (r, 0.0),
            Some((t, t_sq)) => {
                let tau = (-(t[0] * r[0] + t[1] * r[1]) / t_sq).clamp(-tau_limit, tau_limit);
                ([r[0] + t[0] * tau, r[1] + t[1] * tau], tau)
            }
        }
    }

    /// Returns the unit vector perpendicular to the tangent, if there is one.
    fn across(&self) -> Option<[f64; 2]> {
        self.tangent.map(|(t, t_sq)| [-t[1] / t_sq.sqrt(), t[0] / t_sq.sqrt()])
    }
}

/// The convex model at an iterate, inside a trust box.
pub(super) struct Model<'a, const N: usize> {
    goal: &'a Goal<'a>,
    length: f64,
    unit: f64,
    points: Vec<ModelPoint<N>>,
    rows: Vec<ConstraintRow<N>>,
    /// The half width of the trust box relative to the first; `widths` and `sides` give the box in units of x around
    /// the present point.
    trust: f64,
    widths: [f64; N],
    sides: [(f64, f64); N],
    /// Whether a side is a bound of x, and not of the trust box.
    bound: [(bool, bool); N],
    free: Vec<usize>,
    tau_limit: f64,
    /// The points' own steps that the constants already contain.
    taken: Vec<f64>,
    objective: f64,
}

impl<'a, const N: usize> Model<'a, N> {
    pub fn new<P: BlockLeastSquares<N>>(
        problem: &P,
        goal: &'a Goal<'a>,
        options: &ConvexOptions<N>,
        at: &At<N, P::State>,
        trust: f64,
        unit: f64,
    ) -> Self {
        let tau_limit = MAX_TAU * trust.min(1.0);
        let points = at
            .blocks
            .iter()
            .map(|block| {
                let (t, t_sq) = (block.tangent, block.tangent_sq());
                let along = t[0] * block.residual[0] + t[1] * block.residual[1];
                // Beyond its reach a point's own unknown cannot be relied on to take up the residual.
                let within = t_sq > 0.0 && along.abs() <= 0.5 * MAX_TAU * t_sq;
                ModelPoint {
                    residual: block.residual,
                    jacobian: block.jacobian,
                    tangent: within.then_some((t, t_sq)),
                    weight: block.weight,
                }
            })
            .collect();
        let (mut sides, mut bound) = ([(0.0, 0.0); N], [(false, false); N]);
        let widths = options.trust.map(|width| trust * width);
        let mut free = Vec::new();
        for (i, &(low, high)) in problem.bounds().iter().enumerate() {
            if low == high {
                continue;
            }
            let (down, up) = ((low - at.x[i]).min(0.0), (high - at.x[i]).max(0.0));
            bound[i] = (down >= -widths[i], up <= widths[i]);
            sides[i] = (down.max(-widths[i]), up.min(widths[i]));
            free.push(i);
        }
        Model {
            goal,
            length: options.length,
            unit,
            points,
            rows: at.rows.clone(),
            trust,
            widths,
            sides,
            bound,
            free,
            tau_limit,
            taken: vec![0.0; at.blocks.len()],
            objective: at.objective,
        }
    }

    /// Moves the constants so that the model is exact at a rejected trial point (second-order correction).
    pub fn correct(&mut self, blocks: &[PointBlock<N>], rows: &[ConstraintRow<N>], step: &Step<N>) {
        let dot = |row: &[f64; N]| row.iter().zip(&step.dx).map(|(j, d)| j * d).sum::<f64>();
        for (point, block) in self.points.iter_mut().zip(blocks) {
            for axis in 0..2 {
                point.residual[axis] = block.residual[axis] - dot(&point.jacobian[axis]);
            }
        }
        self.taken.clone_from(&step.tau);
        for (row, new) in self.rows.iter_mut().zip(rows) {
            row.value = new.value - dot(&row.gradient);
        }
    }

    /// Returns the indices of the rows that can be violated inside the box.
    fn near_rows(&self) -> Vec<usize> {
        let can_break = |row: &ConstraintRow<N>| {
            let fall: f64 = self
                .free
                .iter()
                .map(|&i| (row.gradient[i] * self.sides[i].0).min(row.gradient[i] * self.sides[i].1))
                .sum();
            row.value + fall <= 0.0
        };
        (0..self.rows.len()).filter(|&i| can_break(&self.rows[i])).collect()
    }

    /// Minimises the model with a slack at this price; `None` if the program has no solution.
    pub fn solve(&self, curvature: &Curvature<N>, price: f64) -> Option<Step<N>> {
        let Some(tolerances) = self.goal.tolerances() else {
            return self.solve_with(curvature, price, &[]);
        };
        let n = self.points.len();
        let size = |j: usize, dx: &[f64; N]| norm(self.points[j].after(dx, self.tau_limit).0) / tolerances[j];
        let mut order: Vec<(f64, usize)> = (0..n).map(|j| (size(j, &[0.0; N]), j)).collect();
        let worst_first = |list: &mut Vec<(f64, usize)>| {
            list.sort_by(|one, other| other.0.total_cmp(&one.0).then(one.1.cmp(&other.1)));
        };
        worst_first(&mut order);
        let mut chosen: Vec<usize> = order.iter().take(CONES).map(|(_, j)| *j).collect();
        for round in 0..CONE_ROUNDS {
            chosen.sort_unstable();
            let step = self.solve_with(curvature, price, &chosen)?;
            if chosen.len() == n || round + 1 == CONE_ROUNDS {
                return Some(step);
            }
            let top = chosen.iter().map(|&j| size(j, &step.dx)).fold(0.0, f64::max);
            let top = if self.is_minimax() { top } else { top.max(1.0) };
            let mut above: Vec<(f64, usize)> = (0..n)
                .filter(|j| chosen.binary_search(j).is_err())
                .map(|j| (size(j, &step.dx), j))
                .filter(|(size, _)| *size > top * (1.0 + 1e-9))
                .collect();
            if above.is_empty() {
                return Some(step);
            }
            worst_first(&mut above);
            chosen.extend(above.iter().take(CONES).map(|(_, j)| *j));
        }
        None
    }

    /// Computes 2 J^T W J over the components that count of each point, and the gradient of the sum of squares.
    fn least_squares(&self) -> (SMatrix<f64, N, N>, SVector<f64, N>) {
        let (mut matrix, mut gradient) = (SMatrix::<f64, N, N>::zeros(), SVector::<f64, N>::zeros());
        for point in &self.points {
            let across = point.across();
            let mut add = |row: &dyn Fn(usize) -> f64, residual: f64| {
                for &i in &self.free {
                    let w = 2.0 * point.weight * row(i);
                    gradient[i] += w * residual;
                    for &k in self.free.iter().take_while(|&&k| k <= i) {
                        matrix[(i, k)] += w * row(k);
                    }
                }
            };
            let (r, j) = (&point.residual, &point.jacobian);
            match across {
                Some(n) => add(&|i| n[0] * j[0][i] + n[1] * j[1][i], n[0] * r[0] + n[1] * r[1]),
                None => (0..2).for_each(|axis| add(&|i| j[axis][i], r[axis])),
            }
        }
        matrix.fill_upper_triangle_with_lower_triangle();
        (matrix, gradient)
    }

    fn is_minimax(&self) -> bool {
        matches!(self.goal, Goal::MaxDeviation { .. })
    }

    /// Minimises the model with cones for the chosen points only.
    ///
    /// The variables are v = (y, theta where there is one, sigma) with dx_i = widths_i y_i, T = `unit` times theta, and sigma the slack.
    fn solve_with(&self, curvature: &Curvature<N>, price: f64, chosen: &[usize]) -> Option<Step<N>> {
        let theta = self.free.len();
        let sigma = theta + usize::from(self.is_minimax());
        let mut linear = vec![0.0; sigma + 1];
        linear[sigma] = price;
        let learnt = curvature.matrix * (self.trust * self.trust / self.unit);
        let mut gradient = None;
        let quadratic = if self.is_minimax() {
            linear[theta] = 1.0;
            positive_part(learnt)
        } else {
            let (matrix, of_squares) = self.least_squares();
            for (at, &i) in self.free.iter().enumerate() {
                linear[at] = of_squares[i] * self.widths[i] / self.unit;
            }
            gradient = Some(of_squares);
            let widths = SVector::<f64, N>::from_fn(|i, _| self.widths[i]);
            positive_part(matrix.component_mul(&(widths * widths.transpose())) / self.unit + learnt)
        };
        let mut program = ConicProgram { linear, ..ConicProgram::default() };
        for (row, &i) in self.free.iter().enumerate() {
            for (column, &k) in self.free.iter().enumerate().take(row + 1) {
                program.quadratic.push((column, row, quadratic[(i, k)]));
            }
        }
        let near = self.near_rows();
        self.add_rows(&mut program, &near, sigma);
        self.add_points(&mut program, chosen, theta);
        let solution = program.solve()?;

        let mut dx = [0.0; N];
        let mut reach: f64 = 0.0;
        for (at, &i) in self.free.iter().enumerate() {
            dx[i] = (solution.v[at] * self.widths[i]).clamp(self.sides[i].0, self.sides[i].1);
            reach = reach.max((dx[i] / self.widths[i]).abs());
        }
        let (multipliers, forces) = self.duals(&solution, &near, chosen)?;
        self.predicted(
            Step { dx, tau: Vec::new(), objective: 0.0, lack: 0.0, reach, multipliers, forces },
            &quadratic,
            gradient,
        )
    }

    /// Returns the terms of a row by the free unknowns, in half widths of the trust box.
    fn terms(&self, row: &dyn Fn(usize) -> f64, factor: f64) -> Vec<(usize, f64)> {
        let scaled = |(at, &i): (usize, &usize)| (at, factor * row(i) * self.widths[i]);
        self.free.iter().enumerate().map(scaled).collect()
    }

    /// Adds the sides of the trust box, the slack and the inequalities near their limits.
    fn add_rows(&self, program: &mut ConicProgram, near: &[usize], sigma: usize) {
        for (at, &i) in self.free.iter().enumerate() {
            let (down, up) = (self.sides[i].0 / self.widths[i], self.sides[i].1 / self.widths[i]);
            program.rows.push(LinearForm { terms: vec![(at, 1.0)], constant: -down });
            program.rows.push(LinearForm { terms: vec![(at, -1.0)], constant: up });
        }
        program.rows.push(LinearForm { terms: vec![(sigma, 1.0)], constant: 0.0 });
        for &i in near {
            let row = &self.rows[i];
            let mut terms = self.terms(&|k| row.gradient[k], 1.0 / self.length);
            terms.push((sigma, 1.0));
            program.rows.push(LinearForm { terms, constant: row.value / self.length });
        }
    }

    /// Returns the factor of a point's residual in its cone.
    fn factor(&self, j: usize) -> f64 {
        let tolerances = self.goal.tolerances().unwrap_or(&[]);
        1.0 / (tolerances[j] * if self.is_minimax() { self.unit } else { 1.0 })
    }

    /// Adds the cones |r + J dx| <= unit theta tol, or <= tol (1 + sigma), of the chosen points; `top` is the variable
    /// theta or sigma.
    fn add_points(&self, program: &mut ConicProgram, chosen: &[usize], top: usize) {
        let constant = if self.is_minimax() { 0.0 } else { 1.0 };
        let ceiling = LinearForm { terms: vec![(top, 1.0)], constant };
        for &j in chosen {
            let (point, factor) = (&self.points[j], self.factor(j));
            let component = |n: [f64; 2]| {
                let row = |i: usize| n[0] * point.jacobian[0][i] + n[1] * point.jacobian[1][i];
                let constant = factor * (n[0] * point.residual[0] + n[1] * point.residual[1]);
                LinearForm { terms: self.terms(&row, factor), constant }
            };
            match point.across() {
                None => program.cones.push([ceiling.clone(), component([1.0, 0.0]), component([0.0, 1.0])]),
                Some(n) => {
                    for n in [n, [-n[0], -n[1]]] {
                        let across = component(n);
                        let mut form = ceiling.clone();
                        form.terms.extend(across.terms.iter().map(|(at, v)| (*at, -v)));
                        form.constant -= across.constant;
                        program.rows.push(form);
                    }
                }
            }
        }
    }

    /// Returns the multipliers, and the derivative of the Lagrangian by each residual without the squares' own, from
    /// the dual variables of a program in the order of its rows and cones.
    fn duals(
        &self,
        solution: &ConicSolution,
        near: &[usize],
        chosen: &[usize],
    ) -> Option<(Multipliers<N>, Vec<[f64; 2]>)> {
        let mut multipliers = Multipliers {
            rows: vec![0.0; self.rows.len()],
            lower: [0.0; N],
            upper: [0.0; N],
            points: vec![0.0; if chosen.is_empty() { 0 } else { self.points.len() }],
        };
        for (at, &i) in self.free.iter().enumerate() {
            let rate = self.unit / self.widths[i];
            if self.bound[i].0 {
                multipliers.lower[i] = rate * solution.rows[2 * at];
            }
            if self.bound[i].1 {
                multipliers.upper[i] = rate * solution.rows[2 * at + 1];
            }
        }
        let mut rows = solution.rows[2 * self.free.len() + 1..].iter();
        for &i in near {
            multipliers.rows[i] = rows.next()? * self.unit / self.length;
        }
        let mut forces = vec![[0.0; 2]; self.points.len()];
        let mut cones = solution.cones.iter();
        let unit = if self.is_minimax() { 1.0 } else { self.unit };
        for &j in chosen {
            let per_residual = self.factor(j) * self.unit;
            match self.points[j].across() {
                None => {
                    let [z, x, y] = *cones.next()?;
                    multipliers.points[j] = z * unit;
                    forces[j] = [-x * per_residual, -y * per_residual];
                }
                Some(n) => {
                    let (above, below) = (rows.next()?, rows.next()?);
                    multipliers.points[j] = (above + below) * unit;
                    forces[j] = n.map(|c| c * (above - below) * per_residual);
                }
            }
        }
        Some((multipliers, forces))
    }

    /// Completes a step by the points' own steps, the squares' own forces, and the objective and lack that the model
    /// predicts; `gradient` is that of the sum of squares. `None` if a number is not finite.
    fn predicted(
        &self,
        mut step: Step<N>,
        quadratic: &SMatrix<f64, N, N>,
        gradient: Option<SVector<f64, N>>,
    ) -> Option<Step<N>> {
        let tolerances = self.goal.tolerances().unwrap_or(&[]);
        let dx = &step.dx;
        let (mut deviation, mut lack) = (0.0_f64, 0.0_f64);
        for (j, point) in self.points.iter().enumerate() {
            let (r, own) = point.after(dx, self.tau_limit);
            step.tau.push(self.taken[j] + own);
            if let Some(tolerance) = tolerances.get(j) {
                deviation = deviation.max(norm(r) / tolerance);
            }
            if !self.is_minimax() {
                step.forces[j] = [0, 1].map(|axis| step.forces[j][axis] + 2.0 * point.weight * r[axis]);
            }
        }
        for row in &self.rows {
            let value: f64 = row.gradient.iter().zip(dx).map(|(g, d)| g * d).sum();
            lack = lack.max(-(row.value + value) / self.length);
        }
        let y = SVector::<f64, N>::from_fn(|i, _| dx[i] / self.widths[i]);
        let bent = 0.5 * self.unit * y.dot(&(quadratic * y));
        step.objective = match gradient {
            None => deviation + bent,
            Some(gradient) => {
                if !tolerances.is_empty() {
                    lack = lack.max(deviation - 1.0);
                }
                // The component along the tangents is taken up for any dx.
                let along: f64 = self
                    .points
                    .iter()
                    .filter_map(|p| {
                        let (t, t_sq) = p.tangent?;
                        Some(p.weight * (t[0] * p.residual[0] + t[1] * p.residual[1]).powi(2) / t_sq)
                    })
                    .sum();
                let slope: f64 = gradient.iter().zip(dx).map(|(g, d)| g * d).sum();
                self.objective - along + slope + bent
            }
        };
        step.lack = lack;
        let finite = step.objective.is_finite() && lack.is_finite() && step.tau.iter().all(|t| t.is_finite());
        finite.then_some(step)
    }
}
