//! Second-order cone programs with a convex quadratic objective, in a few dozen variables; the only file that names
//! the library that solves them.
//!
//! ```text
//! minimise    1/2 v'P v + q'v
//! subject to  a_i'v + b_i >= 0                              a row
//!             |(c_2'v + d_2, c_3'v + d_3)| <= c_1'v + d_1   a cone
//! ```
//!
//! with P positive semidefinite. Solved by Clarabel (Goulart and Chen 2024, *Clarabel: an interior-point solver
//! for conic programs with quadratic objectives*), on one thread and with no clock: the same program gives the
//! same digits. A dual is the rate at which the least value falls when a row's constant b_i grows.

use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT, SolverStatus,
};

/// A linear form with a constant: the sum of value v_column over its terms, plus the constant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinearForm {
    /// The coefficients, as (column, value).
    pub terms: Vec<(usize, f64)>,
    /// The constant term.
    pub constant: f64,
}

/// A convex program.
#[derive(Clone, Debug, Default)]
pub struct ConicProgram {
    /// The linear objective q, one number for each variable.
    pub linear: Vec<f64>,
    /// The upper triangle of P as (i, k, value) with i <= k; values of one place add up.
    pub quadratic: Vec<(usize, usize, f64)>,
    /// The constraints form >= 0.
    pub rows: Vec<LinearForm>,
    /// The constraints |(second, third)| <= first.
    pub cones: Vec<[LinearForm; 3]>,
}

/// The minimum of a program with its dual variables.
#[derive(Clone, Debug, PartialEq)]
pub struct ConicSolution {
    /// The values of the variables.
    pub v: Vec<f64>,
    /// The dual variable of each row, not negative.
    pub rows: Vec<f64>,
    /// The dual variables of each cone, a triple in the cone: the rates at which the least value falls as each
    /// constant grows.
    pub cones: Vec<[f64; 3]>,
}

/// Duality gap and infeasibility at which a program counts as solved: four digits above rounding.
const ACCURACY: f64 = 1e-12;
/// The accuracy that is still of use to a caller who checks every step; a worse result is no solution.
const REDUCED_ACCURACY: f64 = 1e-6;
/// The largest number of interior-point iterations; 10 to 25 are usual.
const ITERATIONS: u32 = 100;

impl ConicProgram {
    /// Solves the program; `None` if it has no minimum, if its numbers are unusable or if the solver does not
    /// converge.
    pub fn solve(&self) -> Option<ConicSolution> {
        let columns = self.linear.len();
        let forms: Vec<&LinearForm> = self.rows.iter().chain(self.cones.iter().flatten()).collect();
        let usable = |form: &&LinearForm| {
            form.constant.is_finite() && form.terms.iter().all(|(c, v)| *c < columns && v.is_finite())
        };
        let quadratic_usable = self.quadratic.iter().all(|(_, k, v)| *k < columns && v.is_finite());
        if !forms.iter().all(usable) || !quadratic_usable || !self.linear.iter().all(|v| v.is_finite()) {
            return None;
        }
        // A v + s = b with s in the cones: A is the negative of the forms.
        let (mut at_row, mut at_column, mut value) = (Vec::new(), Vec::new(), Vec::new());
        for (i, form) in forms.iter().enumerate() {
            for &(column, v) in form.terms.iter().filter(|(_, v)| *v != 0.0) {
                at_row.push(i);
                at_column.push(column);
                value.push(-v);
            }
        }
        let a = CscMatrix::new_from_triplets(forms.len(), columns, at_row, at_column, value);
        let b: Vec<f64> = forms.iter().map(|form| form.constant).collect();
        let p = CscMatrix::new_from_triplets(
            columns,
            columns,
            self.quadratic.iter().map(|q| q.0).collect(),
            self.quadratic.iter().map(|q| q.1).collect(),
            self.quadratic.iter().map(|q| q.2).collect(),
        );
        let mut cones = vec![NonnegativeConeT(self.rows.len())];
        cones.extend(self.cones.iter().map(|_| SecondOrderConeT(3)));
        let settings = DefaultSettings {
            verbose: false,
            max_iter: ITERATIONS,
            time_limit: f64::INFINITY,
            max_threads: 1,
            direct_solve_method: "qdldl".into(),
            tol_gap_abs: ACCURACY,
            tol_gap_rel: ACCURACY,
            tol_feas: ACCURACY,
            reduced_tol_gap_abs: REDUCED_ACCURACY,
            reduced_tol_gap_rel: REDUCED_ACCURACY,
            reduced_tol_feas: REDUCED_ACCURACY,
            ..DefaultSettings::default()
        };
        let mut solver = DefaultSolver::new(&p, &self.linear, &a, &b, &cones, settings).ok()?;
        solver.solve();
        let solution = &solver.solution;
        match solution.status {
            SolverStatus::Solved | SolverStatus::AlmostSolved => {}
            SolverStatus::Unsolved
            | SolverStatus::PrimalInfeasible
            | SolverStatus::DualInfeasible
            | SolverStatus::AlmostPrimalInfeasible
            | SolverStatus::AlmostDualInfeasible
            | SolverStatus::MaxIterations
            | SolverStatus::MaxTime
            | SolverStatus::NumericalError
            | SolverStatus::InsufficientProgress
            | SolverStatus::CallbackTerminated => return None,
        }
        if !solution.x.iter().chain(&solution.z).all(|v| v.is_finite()) {
            return None;
        }
        let (rows, cones) = solution.z.split_at(self.rows.len());
        Some(ConicSolution {
            v: solution.x.clone(),
            rows: rows.iter().map(|z| z.max(0.0)).collect(),
            cones: cones.chunks_exact(3).map(|z| [z[0], z[1], z[2]]).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn form(terms: &[(usize, f64)], constant: f64) -> LinearForm {
        LinearForm { terms: terms.to_vec(), constant }
    }

    #[test]
    fn a_quadratic_program_stops_at_its_row_and_tells_what_the_row_costs() {
        // (x - 3)^2 + (y - 1)^2 with x + y <= 2: the foot of the perpendicular, (2, 0), multiplier 2.
        let mut program = ConicProgram { linear: vec![-6.0, -2.0], ..ConicProgram::default() };
        program.quadratic.push((0, 0, 2.0));
        program.quadratic.push((1, 1, 2.0));
        program.rows.push(form(&[(0, -1.0), (1, -1.0)], 2.0));
        let solution = program.solve().expect("it is convex");
        assert!((solution.v[0] - 2.0).abs() < 1e-9 && solution.v[1].abs() < 1e-9, "{solution:?}");
        assert!((solution.rows[0] - 2.0).abs() < 1e-8, "{solution:?}");
    }

    #[test]
    fn the_smallest_circle_round_three_points_is_a_cone_program() {
        // A right triangle: the middle of its hypotenuse. Across it the radius grows with the square, so the
        // middle is known to the root of the accuracy.
        let points: [[f64; 2]; 3] = [[0.0, 0.0], [6.0, 0.0], [0.0, 8.0]];
        let mut program = ConicProgram { linear: vec![0.0, 0.0, 1.0], ..ConicProgram::default() };
        for p in points {
            let at = |axis: usize| form(&[(axis, 1.0)], -p[axis]);
            program.cones.push([form(&[(2, 1.0)], 0.0), at(0), at(1)]);
        }
        let solution = program.solve().expect("it is convex");
        for (has, wants, within) in [(0, 3.0, 1e-5), (1, 4.0, 1e-5), (2, 5.0, 1e-10)] {
            assert!((solution.v[has] - wants).abs() < within, "{solution:?}");
        }
    }

    #[test]
    fn a_program_without_a_solution_or_with_broken_numbers_has_none() {
        let mut empty = ConicProgram { linear: vec![1.0], ..ConicProgram::default() };
        empty.rows.push(form(&[(0, 1.0)], -1.0));
        empty.rows.push(form(&[(0, -1.0)], 0.0));
        assert_eq!(empty.solve(), None);
        let mut broken = ConicProgram { linear: vec![1.0], ..ConicProgram::default() };
        broken.rows.push(form(&[(0, f64::NAN)], 0.0));
        assert_eq!(broken.solve(), None);
    }
}
