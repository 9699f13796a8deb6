//! A builder of problems from points, with the defaults of a problem file.

use super::spec::{DesignSpec, ProblemSpec, RequireSpec, SolveSpec, TaskSpec, TimingSpec};
use super::{AngleOffset, Problem, TaskError};

/// A problem that is put together from its points; every part that is left out has the default of a problem file.
///
/// Lengths are in the unit of the points, angles in degrees. Limits of the design and requirements are taken as they
/// are: [`parse_problem`](crate::parse_problem) checks those that a person wrote.
///
/// ```
/// use linkwright::Problem;
/// let spec = Problem::builder(vec![[0.0, 0.0], [1.0, 1.0], [2.0, 1.5], [3.0, 1.0]]).tolerance(0.1).spec()?;
/// assert_eq!((spec.solve.candidates, spec.require.link_ratio_max), (5, 20.0));
/// assert!(spec.design.a.is_some_and(|limits| limits.0 > 0.0));
/// assert!(spec.require.longest_max.is_some_and(|longest| longest > 3.0 * 3.0));
/// let job = linkwright::Job::new("arc", spec);
/// # Ok::<(), linkwright::TaskError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ProblemBuilder {
    spec: ProblemSpec,
    any_longest: bool,
}

impl Problem {
    /// Begins a problem: a path through these points, open, with free timing.
    pub fn builder(points: Vec<[f64; 2]>) -> ProblemBuilder {
        let spec = ProblemSpec {
            task: TaskSpec::path(points, false),
            design: DesignSpec::default(),
            require: RequireSpec::default(),
            solve: SolveSpec::default(),
            loads: None,
        };
        ProblemBuilder { spec, any_longest: false }
    }
}

impl ProblemBuilder {
    /// Makes the target a closed curve, or an open one.
    #[must_use]
    pub fn closed(mut self, closed: bool) -> Self {
        self.spec.task.closed = closed;
        self
    }

    /// Sets the weights of the squared errors, one for each point, above 0.
    #[must_use]
    pub fn weights(mut self, weights: Vec<f64>) -> Self {
        self.spec.task.weight = Some(weights);
        self
    }

    /// Sets the largest error accepted at every point, 0 or more.
    #[must_use]
    pub fn tolerance(self, tolerance: f64) -> Self {
        let points = self.spec.task.points.len();
        self.tolerances(vec![tolerance; points])
    }

    /// Sets the largest error accepted at each point, 0 or more.
    #[must_use]
    pub fn tolerances(mut self, tolerances: Vec<f64>) -> Self {
        self.spec.task.tolerance = Some(tolerances);
        self
    }

    /// Prescribes the timing: the crank angle at each point, degrees, counter-clockwise positive, measured from `offset`.
    #[must_use]
    pub fn timing(mut self, crank_deg: Vec<f64>, offset: AngleOffset) -> Self {
        self.spec.task.timing = Some(TimingSpec { crank_deg, offset, free: Vec::new() });
        self
    }

    /// Sets the limits of the parameters; those that are `None` get their defaults from the points.
    #[must_use]
    pub fn design(mut self, design: DesignSpec) -> Self {
        self.spec.design = design;
        self
    }

    /// Sets the requirements. A `longest_max` of `None` gets the default of a problem file: with free timing 3 sizes of
    /// the target, where neither a length of the design nor `extent_max` is bounded.
    #[must_use]
    pub fn require(mut self, require: RequireSpec) -> Self {
        self.spec.require = require;
        self
    }

    /// Lets links be of any length where the requirements set no `longest_max`: `longest_max = "any"` in a problem file.
    #[must_use]
    pub fn any_longest(mut self) -> Self {
        self.any_longest = true;
        self
    }

    /// Sets the options of the search.
    #[must_use]
    pub fn solve(mut self, solve: SolveSpec) -> Self {
        self.spec.solve = solve;
        self
    }

    /// Returns the problem as data, with every default filled in.
    ///
    /// # Errors
    /// [`TaskError`] if the points with their lists make no task.
    pub fn spec(mut self) -> Result<ProblemSpec, TaskError> {
        let ProblemSpec { task, design, require, .. } = &mut self.spec;
        let task = task.to_task()?;
        if require.longest_max.is_none() && !self.any_longest {
            require.longest_max = require.default_longest(design, &task);
        }
        design.resolve(&task);
        Ok(self.spec)
    }

    /// Returns the checked problem.
    ///
    /// # Errors
    /// [`TaskError`] if the points with their lists make no task.
    pub fn build(self) -> Result<Problem, TaskError> {
        Problem::new(self.spec()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::task::spec::Limits;

    #[test]
    fn a_built_problem_is_that_of_a_file_with_the_same_keys() {
        let points = vec![[0.0, 0.0], [1.0, 1.0], [2.0, 1.5], [3.0, 1.0]];
        let text = "format = 1\n[task.path]\npoints = [[0, 0], [1, 1], [2, 1.5], [3, 1]]\ntolerance = 0.1\n\
                    weight = [1, 2, 1, 1]\n[task.path.timing]\ncrank_deg = [0, 20, 40, 60]\noffset = \"ground\"\n\
                    [require]\nlink_ratio_max = 8\n[solve]\nseed = 7\n";
        let file = crate::parse_problem("it.toml", text, None, &[]).expect("a problem");
        let built = Problem::builder(points)
            .tolerance(0.1)
            .weights(vec![1.0, 2.0, 1.0, 1.0])
            .timing(vec![0.0, 20.0, 40.0, 60.0], AngleOffset::Ground)
            .require(RequireSpec { link_ratio_max: 8.0, ..RequireSpec::default() })
            .solve(SolveSpec { seed: 7, ..SolveSpec::default() });
        assert_eq!(built.clone().spec(), Ok(file.spec));
        assert!(built.build().is_ok());
    }

    #[test]
    fn a_built_problem_has_the_longest_link_of_a_file() {
        let points = || vec![[0.0, 0.0], [3.0, 4.0]];
        let of_file = |lines: &str| {
            let text = format!("format = 1\n[task.path]\npoints = [[0, 0], [3, 4]]\n{lines}");
            crate::parse_problem("it.toml", &text, None, &[]).expect("a problem").spec
        };
        let built = |builder: ProblemBuilder| builder.spec().expect("a problem");
        let plain = built(Problem::builder(points()));
        assert_eq!((plain.require.longest_max, &plain), (Some(15.0), &of_file("")));
        let any = built(Problem::builder(points()).any_longest());
        assert_eq!((any.require.longest_max, &any), (None, &of_file("[require]\nlongest_max = \"any\"\n")));
        let design = || DesignSpec { a: Some(Limits(1.0, 2.0)), ..DesignSpec::default() };
        let bounded = built(Problem::builder(points()).design(design()));
        assert_eq!((bounded.require.longest_max, &bounded), (None, &of_file("[design]\na = [1, 2]\n")));
        let asked = RequireSpec { longest_max: Some(7.0), ..RequireSpec::default() };
        let asked = built(Problem::builder(points()).require(asked).any_longest());
        assert_eq!(asked, of_file("[require]\nlongest_max = 7\n"));
        // What is resolved stays what it is.
        for spec in [plain, any, bounded] {
            let again = Problem::builder(points()).design(spec.design.clone()).require(spec.require.clone());
            assert_eq!(built(again), spec);
        }
    }

    #[test]
    fn points_that_make_no_task_are_refused() {
        assert!(Problem::builder(vec![[0.0, 0.0]]).build().is_err());
        assert!(Problem::builder(vec![[0.0, 0.0], [1.0, 0.0]]).tolerances(vec![0.1]).spec().is_err());
    }
}
