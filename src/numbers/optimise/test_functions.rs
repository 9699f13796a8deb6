//! Problems with known answers, for the tests of the population searches.

use super::population::{Fitness, PopulationProblem};
use std::sync::atomic::{AtomicU64, Ordering};

/// The sphere function f = sum (x_j - 1/j)^2 in [-5, 5]^n: minimum 0 at x_j = 1/j, which is off the middle of the
/// box.
pub struct Sphere {
    bounds: Vec<(f64, f64)>,
}

impl Sphere {
    pub fn new(genes: usize) -> Self {
        Self { bounds: vec![(-5.0, 5.0); genes] }
    }
}

impl PopulationProblem for Sphere {
    fn bounds(&self) -> &[(f64, f64)] {
        &self.bounds
    }

    fn evaluate(&self, x: &[f64]) -> Fitness {
        let off = |(j, x): (usize, &f64)| (x - 1.0 / (j + 1) as f64).powi(2);
        Fitness::feasible(x.iter().enumerate().map(off).sum())
    }
}

/// Rosenbrock's valley (1960) in [-5, 10]^n: minimum 0 at (1, ..., 1).
pub struct Rosenbrock {
    bounds: Vec<(f64, f64)>,
}

impl Rosenbrock {
    pub fn new(genes: usize) -> Self {
        Self { bounds: vec![(-5.0, 10.0); genes] }
    }
}

impl PopulationProblem for Rosenbrock {
    fn bounds(&self) -> &[(f64, f64)] {
        &self.bounds
    }

    fn evaluate(&self, x: &[f64]) -> Fitness {
        let step = |w: &[f64]| 100.0 * (w[1] - w[0] * w[0]).powi(2) + (1.0 - w[0]).powi(2);
        Fitness::feasible(x.windows(2).map(step).sum())
    }

    /// Returns a cost so high that every generation is shared among the threads of the pool.
    fn cost_hint_ns(&self) -> f64 {
        1e6
    }
}

/// The minimisation of x + y in [-3, 3]^2 on the disc x^2 + y^2 <= 2 above the parabola y >= x^2 - 1.
///
/// On the parabola x + y = x^2 + x - 1 is least at x = -1/2: the minimum is -5/4 at (-1/2, -3/4), inside the disc.
pub struct Constrained;

impl PopulationProblem for Constrained {
    fn bounds(&self) -> &[(f64, f64)] {
        &[(-3.0, 3.0), (-3.0, 3.0)]
    }

    fn evaluate(&self, x: &[f64]) -> Fitness {
        let (x, y) = (x[0], x[1]);
        let violation = (x * x + y * y - 2.0).max(0.0) + (x * x - 1.0 - y).max(0.0);
        // The cost is undefined at infeasible points, where it must not be used.
        Fitness { violation, cost: if violation > 0.0 { f64::NAN } else { x + y } }
    }
}

/// A wrapper that counts the evaluations of a problem and checks every point against the box.
pub struct Counted<P> {
    problem: P,
    evaluations: AtomicU64,
}

impl<P> Counted<P> {
    pub fn new(problem: P) -> Self {
        Self { problem, evaluations: AtomicU64::new(0) }
    }

    pub fn evaluations(&self) -> u64 {
        self.evaluations.load(Ordering::Relaxed)
    }
}

impl<P: PopulationProblem> PopulationProblem for Counted<P> {
    fn bounds(&self) -> &[(f64, f64)] {
        self.problem.bounds()
    }

    fn evaluate(&self, x: &[f64]) -> Fitness {
        self.evaluations.fetch_add(1, Ordering::Relaxed);
        assert_eq!(x.len(), self.bounds().len());
        for (value, (lower, upper)) in x.iter().zip(self.bounds()) {
            assert!((lower..=upper).contains(&value), "{value} outside [{lower}, {upper}]");
        }
        self.problem.evaluate(x)
    }

    fn cost_hint_ns(&self) -> f64 {
        self.problem.cost_hint_ns()
    }
}
