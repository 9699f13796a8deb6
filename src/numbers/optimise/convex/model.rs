//! The convex model of a step: its linear and quadratic terms, and the points and rows that enter it.

use super::curvature::{Curvature, positive_part};
use super::point::{ModelPoint, deviation, parts};
use super::{At, ConvexOptions, Goal, Multipliers};
use crate::conic::{ConicProgram, ConicSolution, LinearForm};
use crate::levenberg_marquardt::block::{column, dot};
use crate::levenberg_marquardt::{BlockLeastSquares, ConstraintRow, MAX_TAU, PointBlock};
use nalgebra::{SMatrix, SVector};
use std::array::from_fn;

/// The largest number of points that get a cone of their own in the first program because they are the worst, and the
/// largest number added in a later round. An optimum of N unknowns has some N active ones; the time of a program grows
/// with all.
const CONES: usize = 10;
/// The largest number of rounds in which points that the model puts above the maximum are added.
const CONE_ROUNDS: usize = 30;

/// A step with the predictions of the model.
#[derive(Clone, Debug)]
pub(super) struct Step<const N: usize, const R: usize> {
    pub dx: [f64; N],
    /// The steps of the points' own unknowns.
    pub tau: Vec<f64>,
    /// The deviation of each point that the model predicts; empty if the goal has no tolerances.
    pub deviations: Vec<f64>,
    /// The objective that the model predicts.
    pub objective: f64,
    /// The lack that the model predicts, dimensionless.
    pub lack: f64,
    /// The largest component of dx in half widths of the trust box, and of the own steps that are variables in their
    /// limit: 1 on the boundary.
    pub reach: f64,
    pub multipliers: Multipliers<N>,
    /// The derivative of the Lagrangian by each residual.
    pub forces: Vec<[f64; R]>,
}

/// The places of the variables in a program: the shared unknowns come first.
struct Columns {
    /// The bound of the deviations where there is one, else the slack.
    theta: usize,
    sigma: usize,
    /// The points with an own step among the variables, ascending, each with its place.
    own: Vec<(usize, usize)>,
}

impl Columns {
    fn count(&self) -> usize {
        self.sigma + 1 + self.own.len()
    }

    /// Returns the place of a point's own step; `None` if it is no variable.
    fn of(&self, point: usize) -> Option<usize> {
        self.own.binary_search_by_key(&point, |own| own.0).ok().map(|i| self.own[i].1)
    }
}

/// The convex model at an iterate, inside a trust box.
pub(super) struct Model<'a, const N: usize, const R: usize> {
    goal: &'a Goal<'a>,
    length: f64,
    unit: f64,
    points: Vec<ModelPoint<N, R>>,
    rows: Vec<ConstraintRow<N>>,
    /// The points on whose own unknowns the rows depend, ascending.
    depended: Vec<usize>,
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

impl<'a, const N: usize, const R: usize> Model<'a, N, R> {
    pub fn new<P: BlockLeastSquares<N, R>>(
        problem: &P,
        goal: &'a Goal<'a>,
        options: &ConvexOptions<N>,
        at: &At<N, R, P::State>,
        trust: f64,
        unit: f64,
    ) -> Self {
        let tau_limit = MAX_TAU * trust.min(1.0);
        let point = |(j, block)| ModelPoint::new(block, goal.tolerances_of(j, R));
        let points = at.blocks.iter().enumerate().map(point).collect();
        let mut depended: Vec<usize> =
            at.rows.iter().flat_map(|row| row.own.iter().flatten()).map(|(j, _)| *j).collect();
        depended.sort_unstable();
        depended.dedup();
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
            depended,
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
    pub fn correct(&mut self, blocks: &[PointBlock<N, R>], rows: &[ConstraintRow<N>], step: &Step<N, R>) {
        let dot = |row: &[f64; N]| row.iter().zip(&step.dx).map(|(j, d)| j * d).sum::<f64>();
        for (point, block) in self.points.iter_mut().zip(blocks) {
            for axis in 0..R {
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
            let own = |fall: f64, by: f64| fall - by.abs() * self.tau_limit;
            row.value + row.own.iter().flatten().map(|(_, by)| *by).fold(fall, own) <= 0.0
        };
        (0..self.rows.len()).filter(|&i| can_break(&self.rows[i])).collect()
    }

    /// Returns the tolerances of a point's parts; empty if the goal has none.
    fn tolerances(&self, j: usize) -> &'a [f64] {
        self.goal.tolerances_of(j, R).unwrap_or(&[])
    }

    /// Computes a point's residual after a shared step and its own step: the one that is `given`, else the best one.
    fn after(&self, j: usize, dx: &[f64; N], given: Option<f64>) -> ([f64; R], f64) {
        let point = &self.points[j];
        let r = point.moved(dx);
        let tau = match given {
            Some(tau) => tau,
            None if point.traded && self.is_minimax() => {
                point.nearest(&r, self.tolerances(j), self.tau_limit)
            }
            None if point.takes_up => point.foot(&r, self.tau_limit),
            None => return (r, 0.0),
        };
        (point.along(&r, tau), tau)
    }

    /// Minimises the model with a slack at this price; `None` if the program has no solution. `active` are points that are
    /// likely to be active: those of an earlier program.
    pub fn solve(&self, curvature: &Curvature<N>, price: f64, active: &[usize]) -> Option<Step<N, R>> {
        if self.goal.tolerances().is_none() {
            return self.solve_with(curvature, price, &[]);
        }
        let n = self.points.len();
        let worst_first = |list: &mut Vec<(f64, usize)>| {
            list.sort_by(|one, other| other.0.total_cmp(&one.0).then(one.1.cmp(&other.1)));
        };
        let mut order = self.possible();
        worst_first(&mut order);
        let mut chosen: Vec<usize> = order.iter().take(CONES).map(|(_, j)| *j).collect();
        chosen.extend(active);
        chosen.extend(&self.depended);
        for round in 0..CONE_ROUNDS {
            chosen.sort_unstable();
            chosen.dedup();
            let step = self.solve_with(curvature, price, &chosen)?;
            if chosen.len() == n || round + 1 == CONE_ROUNDS {
                return Some(step);
            }
            let top = chosen.iter().map(|&j| step.deviations[j]).fold(0.0, f64::max);
            let top = if self.is_minimax() { top } else { top.max(1.0) };
            let mut above: Vec<(f64, usize)> = (0..n)
                .filter(|j| chosen.binary_search(j).is_err())
                .map(|j| (step.deviations[j], j))
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

    /// Returns the points that can be active inside the box, each with its deviation now: above 1, or above what is left of
    /// the largest one wherever the step leads.
    fn possible(&self) -> Vec<(f64, usize)> {
        let now = |j: usize| deviation(&self.after(j, &[0.0; N], None).0, self.tolerances(j));
        let all: Vec<(f64, f64)> = (0..self.points.len()).map(|j| (now(j), self.reach(j))).collect();
        let least = match self.is_minimax() {
            true => all.iter().map(|(now, reach)| now - reach).fold(0.0, f64::max),
            false => 1.0,
        };
        // A little less: rounding must not leave out the largest one itself.
        let least = least * (1.0 - 1e-9);
        let possible = all.iter().enumerate().filter(|(_, (now, reach))| now + reach >= least);
        possible.map(|(j, (now, _))| (*now, j)).collect()
    }

    /// Returns a bound of the change of a point's deviation inside the box.
    fn reach(&self, j: usize) -> f64 {
        let point = &self.points[j];
        let own = if point.traded { 2.0 * self.tau_limit } else { 0.0 };
        let of = |part: usize| {
            let rows = if part == 0 { 0..2 } else { part + 1..part + 2 };
            let size =
                |at: &dyn Fn(usize) -> f64| rows.clone().map(|row| at(row).powi(2)).sum::<f64>().sqrt();
            let by_shared = self.free.iter().map(|&i| {
                let (down, up) = self.sides[i];
                size(&|row| point.jacobian[row][i]) * up.max(-down)
            });
            by_shared.sum::<f64>() + size(&|row| point.tangent[row]) * own
        };
        let reaches = self.tolerances(j).iter().enumerate().map(|(part, tolerance)| of(part) / tolerance);
        reaches.fold(0.0, f64::max)
    }

    /// Computes 2 J^T W J over the components that count of each point, those across the tangent if the own step is a
    /// variable or takes up the rest, and the gradient of the sum of squares.
    fn least_squares(&self, columns: &Columns) -> (SMatrix<f64, N, N>, SVector<f64, N>) {
        let (mut matrix, mut gradient) = (SMatrix::<f64, N, N>::zeros(), SVector::<f64, N>::zeros());
        for (point, across) in self.points.iter().enumerate().map(|(j, p)| (p, self.is_across(j, columns))) {
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
            if across {
                for n in &point.basis()[..R - 1] {
                    add(&|i| column(n, j, i), dot(n, r));
                }
            } else {
                (0..R).for_each(|axis| add(&|i| j[axis][i], r[axis]));
            }
        }
        matrix.fill_upper_triangle_with_lower_triangle();
        (matrix, gradient)
    }

    /// Returns whether the component along a point's tangent is apart from the sum of squares of [`Self::least_squares`].
    fn is_across(&self, j: usize, columns: &Columns) -> bool {
        self.points[j].takes_up || columns.of(j).is_some()
    }

    fn is_minimax(&self) -> bool {
        matches!(self.goal, Goal::MaxDeviation { .. })
    }

    /// Minimises the model with cones for the chosen points only.
    ///
    /// The variables are v = (y, theta where there is one, sigma, u) with dx_i = widths_i y_i, T = `unit` times theta,
    /// sigma the slack, and tau_j = `tau_limit` u_j for the chosen points with a traded own unknown.
    fn solve_with(&self, curvature: &Curvature<N>, price: f64, chosen: &[usize]) -> Option<Step<N, R>> {
        let columns = self.columns(chosen);
        let (theta, sigma) = (columns.theta, columns.sigma);
        let mut linear = vec![0.0; columns.count()];
        linear[sigma] = price;
        let learnt = curvature.matrix * (self.trust * self.trust / self.unit);
        let mut gradient = None;
        let quadratic = if self.is_minimax() {
            linear[theta] = 1.0;
            positive_part(learnt)
        } else {
            let (matrix, of_squares) = self.least_squares(&columns);
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
        if !self.is_minimax() {
            self.add_along(&mut program, &columns);
        }
        let near = self.near_rows();
        self.add_rows(&mut program, &near, &columns);
        self.add_points(&mut program, chosen, &columns);
        let solution = program.solve()?;

        let mut dx = [0.0; N];
        let mut reach: f64 = 0.0;
        for (at, &i) in self.free.iter().enumerate() {
            dx[i] = (solution.v[at] * self.widths[i]).clamp(self.sides[i].0, self.sides[i].1);
            reach = reach.max((dx[i] / self.widths[i]).abs());
        }
        let (multipliers, forces) = self.duals(&solution, &near, chosen, &columns)?;
        let own = |column: usize| self.tau_limit * solution.v[column].clamp(-1.0, 1.0);
        let given = columns.own.iter().map(|&(j, column)| (j, own(column))).collect();
        let (tau, deviations) = (Vec::new(), Vec::new());
        let step = Step { dx, tau, deviations, objective: 0.0, lack: 0.0, reach, multipliers, forces };
        self.predicted(step, &quadratic, gradient, &columns, given)
    }

    /// Returns the variables of a program with cones for the chosen points.
    fn columns(&self, chosen: &[usize]) -> Columns {
        let theta = self.free.len();
        let sigma = theta + usize::from(self.is_minimax());
        let traded = chosen.iter().filter(|&&j| self.points[j].traded);
        Columns { theta, sigma, own: traded.enumerate().map(|(at, &j)| (j, sigma + 1 + at)).collect() }
    }

    /// Adds the squares of the components along the tangents of the points whose own steps are variables.
    fn add_along(&self, program: &mut ConicProgram, columns: &Columns) {
        for &(j, place) in &columns.own {
            let point = &self.points[j];
            let along = &point.basis()[R - 1];
            let mut terms = self.terms(&|i| column(along, &point.jacobian, i), 1.0);
            terms.push((place, point.tangent_sq.sqrt() * self.tau_limit));
            let (w, constant) = (2.0 * point.weight / self.unit, dot(along, &point.residual));
            for (at, &(i, value)) in terms.iter().enumerate() {
                program.linear[i] += w * constant * value;
                program.quadratic.extend(terms[..=at].iter().map(|(k, other)| (*k, i, w * value * other)));
            }
        }
    }

    /// Returns the terms of a row by the free unknowns, in half widths of the trust box.
    fn terms(&self, row: &dyn Fn(usize) -> f64, factor: f64) -> Vec<(usize, f64)> {
        let scaled = |(at, &i): (usize, &usize)| (at, factor * row(i) * self.widths[i]);
        self.free.iter().enumerate().map(scaled).collect()
    }

    /// Adds the sides of the trust box, the slack, the inequalities near their limits, and the limits of the own steps.
    fn add_rows(&self, program: &mut ConicProgram, near: &[usize], columns: &Columns) {
        for (at, &i) in self.free.iter().enumerate() {
            let (down, up) = (self.sides[i].0 / self.widths[i], self.sides[i].1 / self.widths[i]);
            program.rows.push(LinearForm { terms: vec![(at, 1.0)], constant: -down });
            program.rows.push(LinearForm { terms: vec![(at, -1.0)], constant: up });
        }
        program.rows.push(LinearForm { terms: vec![(columns.sigma, 1.0)], constant: 0.0 });
        for &i in near {
            let row = &self.rows[i];
            let mut terms = self.terms(&|k| row.gradient[k], 1.0 / self.length);
            terms.push((columns.sigma, 1.0));
            for &(j, by) in row.own.iter().flatten() {
                terms.extend(columns.of(j).map(|place| (place, by * self.tau_limit / self.length)));
            }
            program.rows.push(LinearForm { terms, constant: row.value / self.length });
        }
        for &(_, place) in &columns.own {
            for side in [1.0, -1.0] {
                program.rows.push(LinearForm { terms: vec![(place, side)], constant: 1.0 });
            }
        }
    }

    /// Returns the factor of a part of a point's residual in its cone or rows.
    fn factor(&self, j: usize, part: usize) -> f64 {
        1.0 / (self.tolerances(j)[part] * if self.is_minimax() { self.unit } else { 1.0 })
    }

    /// Returns the parts of a point that are limited.
    fn limited(&self, j: usize) -> impl Iterator<Item = usize> {
        let tolerances = self.tolerances(j);
        (0..tolerances.len()).filter(|&part| tolerances[part].is_finite())
    }

    /// Returns the direction whose component alone is limited in a part of a point, both ways; `None` if the part has
    /// a cone.
    fn single(&self, j: usize, part: usize) -> Option<[f64; R]> {
        let point = &self.points[j];
        match part {
            0 if R == 2 && point.takes_up => Some(point.basis()[0]),
            0 => None,
            _ => Some(unit_vector(part + 1)),
        }
    }

    /// Adds the cones |r + J dx + t tau| <= unit theta tol, or <= tol (1 + sigma), of the chosen points' parts; a part
    /// of one component gets two rows. Theta or sigma is the variable `columns.theta`.
    fn add_points(&self, program: &mut ConicProgram, chosen: &[usize], columns: &Columns) {
        let constant = if self.is_minimax() { 0.0 } else { 1.0 };
        let ceiling = LinearForm { terms: vec![(columns.theta, 1.0)], constant };
        for (j, part) in chosen.iter().flat_map(|&j| self.limited(j).map(move |part| (j, part))) {
            let (point, factor, own) = (&self.points[j], self.factor(j, part), columns.of(j));
            let component = |n: [f64; R]| {
                let mut terms = self.terms(&|i| column(&n, &point.jacobian, i), factor);
                terms.extend(own.map(|place| (place, factor * dot(&n, &point.tangent) * self.tau_limit)));
                LinearForm { terms, constant: factor * dot(&n, &point.residual) }
            };
            let Some(n) = self.single(j, part) else {
                program.cones.push([ceiling.clone(), component(unit_vector(0)), component(unit_vector(1))]);
                continue;
            };
            for n in [n, n.map(|c| -c)] {
                let single = component(n);
                let mut form = ceiling.clone();
                form.terms.extend(single.terms.iter().map(|(at, v)| (*at, -v)));
                form.constant -= single.constant;
                program.rows.push(form);
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
        columns: &Columns,
    ) -> Option<(Multipliers<N>, Vec<[f64; R]>)> {
        let mut multipliers = Multipliers {
            rows: vec![0.0; self.rows.len()],
            lower: [0.0; N],
            upper: [0.0; N],
            points: vec![0.0; if chosen.is_empty() { 0 } else { parts(R) * self.points.len() }],
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
        let mut rows = rows.skip(2 * columns.own.len());
        let mut forces = vec![[0.0; R]; self.points.len()];
        let mut cones = solution.cones.iter();
        let unit = if self.is_minimax() { 1.0 } else { self.unit };
        for (j, part) in chosen.iter().flat_map(|&j| self.limited(j).map(move |part| (j, part))) {
            let per_residual = self.factor(j, part) * self.unit;
            let multiplier = &mut multipliers.points[parts(R) * j + part];
            match self.single(j, part) {
                None => {
                    let [z, x, y] = *cones.next()?;
                    *multiplier = z * unit;
                    (forces[j][0], forces[j][1]) = (-x * per_residual, -y * per_residual);
                }
                Some(n) => {
                    let (above, below) = (rows.next()?, rows.next()?);
                    *multiplier = (above + below) * unit;
                    for (force, c) in forces[j].iter_mut().zip(n).filter(|(_, c)| *c != 0.0) {
                        *force = c * (above - below) * per_residual;
                    }
                }
            }
        }
        Some((multipliers, forces))
    }

    /// Completes a step by the points' own steps, the squares' own forces, and the objective and lack that the model
    /// predicts; `gradient` is that of the sum of squares, `given` are the own steps among the variables. `None` if a
    /// number is not finite.
    fn predicted(
        &self,
        mut step: Step<N, R>,
        quadratic: &SMatrix<f64, N, N>,
        gradient: Option<SVector<f64, N>>,
        columns: &Columns,
        mut given: Vec<(usize, f64)>,
    ) -> Option<Step<N, R>> {
        if self.is_minimax() {
            // An own step that holds neither the maximum nor a row may be anything in between: the nearest is better.
            given.retain(|(j, _)| self.depended.binary_search(j).is_ok());
        }
        let mut given = given.into_iter().peekable();
        let dx = &step.dx;
        let (mut deviation_most, mut lack, mut along) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut own_steps = Vec::with_capacity(self.points.len());
        for (j, point) in self.points.iter().enumerate() {
            let own = given.next_if(|(of, _)| *of == j).map(|(_, tau)| tau);
            let (r, own) = self.after(j, dx, own);
            own_steps.push(own);
            if self.goal.tolerances().is_some() {
                let deviation = deviation(&r, self.tolerances(j));
                deviation_most = deviation_most.max(deviation);
                step.deviations.push(deviation);
            }
            if point.traded {
                step.reach = step.reach.max(own.abs() / self.tau_limit);
            }
            if !self.is_minimax() {
                step.forces[j] = from_fn(|axis| step.forces[j][axis] + 2.0 * point.weight * r[axis]);
            }
            if columns.of(j).is_some() {
                along += point.weight * dot(&point.tangent, &r).powi(2) / point.tangent_sq;
            }
        }
        for row in &self.rows {
            let value: f64 = row.gradient.iter().zip(dx).map(|(g, d)| g * d).sum();
            let value = row.own.iter().flatten().fold(value, |sum, (j, by)| sum + by * own_steps[*j]);
            lack = lack.max(-(row.value + value) / self.length);
        }
        step.tau = self.taken.iter().zip(&own_steps).map(|(taken, own)| taken + own).collect();
        let y = SVector::<f64, N>::from_fn(|i, _| dx[i] / self.widths[i]);
        let bent = 0.5 * self.unit * y.dot(&(quadratic * y));
        step.objective = match gradient {
            None => deviation_most + bent,
            Some(gradient) => {
                if self.goal.tolerances().is_some() {
                    lack = lack.max(deviation_most - 1.0);
                }
                // The component along the tangents is taken up for any dx, or changes to that of the own step.
                let before: f64 = (0..self.points.len())
                    .filter(|&j| self.is_across(j, columns))
                    .map(|j| &self.points[j])
                    .map(|p| p.weight * dot(&p.tangent, &p.residual).powi(2) / p.tangent_sq)
                    .sum();
                let slope: f64 = gradient.iter().zip(dx).map(|(g, d)| g * d).sum();
                self.objective - before + slope + bent + along
            }
        };
        step.lack = lack;
        let finite = step.objective.is_finite() && lack.is_finite() && step.tau.iter().all(|t| t.is_finite());
        finite.then_some(step)
    }
}

/// Returns the unit vector of a row of the residuals.
fn unit_vector<const R: usize>(row: usize) -> [f64; R] {
    from_fn(|axis| if axis == row { 1.0 } else { 0.0 })
}
