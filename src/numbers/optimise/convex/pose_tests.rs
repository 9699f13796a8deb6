//! Tests with three rows a point: poses, whose place and angle have a tolerance each, against nested line searches.

use super::*;
use crate::levenberg_marquardt::EachConstraint;
use crate::test_poses::{Limit, Poses, Shared};
use linkwright_arithmetic::streams::{below, stream, uniform};

const COUNT: usize = 7;
const NOISE: f64 = 0.08;

fn options() -> ConvexOptions<4> {
    ConvexOptions {
        max_steps: 200,
        max_evaluations: 1000,
        trust: [0.3; 4],
        length: 1.0,
        relative_reduction: 1e-11,
        feasibility: 1e-9,
        good_enough: 0.0,
    }
}

fn solved(problem: &Poses, goal: &Goal<'_>) -> ConvexResult<4, Vec<f64>> {
    let (x, state) = problem.start();
    let result = solve(problem, goal, x, state, &options(), &|| false);
    assert!(
        matches!(result.outcome, ConvexOutcome::Converged | ConvexOutcome::Stalled),
        "{:?} after {} steps",
        result.outcome,
        result.steps
    );
    assert!(result.evaluations < 60, "{}", result.evaluations);
    result
}

/// Repeats the tolerances of place and angle for each pose.
fn tolerances(count: usize, place: f64, angle: f64) -> Vec<f64> {
    [place, angle].repeat(count)
}

/// The least largest deviation by line searches.
fn least_deviation(problem: &Poses, tolerances: &[f64]) -> f64 {
    problem.by_line_searches(|x, j, s| problem.deviation(x, j, s, tolerances), f64::max)
}

/// The least sum of squares within tolerances by line searches, by an exact penalty.
fn least_within(problem: &Poses, tolerances: &[f64], price: f64) -> f64 {
    let part = |x: &Shared, j, s| {
        problem.squares(x, j, s) + price * (problem.deviation(x, j, s, tolerances) - 1.0).max(0.0)
    };
    problem.by_line_searches(part, |sum, part| sum + part)
}

/// Returns the residual of each pose along its tangent over the tangent's length, zero at a foot.
fn off_foot(problem: &Poses, result: &ConvexResult<4, Vec<f64>>) -> f64 {
    let mut most: f64 = 0.0;
    problem.linearise(&result.x, &result.state, &mut |block| {
        let along: f64 = block.tangent.iter().zip(&block.residual).map(|(t, r)| t * r).sum();
        most = most.max(along.abs() / block.tangent_sq().sqrt());
    });
    most
}

#[test]
fn the_sum_of_squares_ends_where_line_searches_do() {
    let problem = Poses::drawn(COUNT, NOISE);
    let result = solved(&problem, &Goal::SumOfSquares);
    let known = problem.by_line_searches(|x, j, s| problem.squares(x, j, s), |sum, cost| sum + cost);
    assert!((result.objective - known).abs() < 1e-9 * known, "{} {known}", result.objective);
    assert!(result.multipliers.expect("a program was solved").points.is_empty());
}

#[test]
fn the_largest_deviation_of_place_and_angle_ends_where_line_searches_do() {
    let problem = Poses::drawn(COUNT, NOISE);
    for (place, angle) in [(1.0, 1.0), (1.0, 0.2), (0.1, 3.0), (1.0, f64::INFINITY), (f64::INFINITY, 1.0)] {
        let list = tolerances(COUNT, place, angle);
        let result = solved(&problem, &Goal::MaxDeviation { tolerances: &list });
        let known = least_deviation(&problem, &list);
        // An angle alone is met exactly by the own unknowns.
        let close = if place.is_finite() { 1e-7 * known } else { 1e-9 };
        assert!((result.objective - known).abs() < close, "{place} {angle}: {} {known}", result.objective);
        assert_eq!(result.deviation, result.objective);
        let shares = result.multipliers.expect("a program was solved").points;
        assert_eq!(shares.len(), 2 * COUNT);
        if place.is_finite() {
            assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-6, "{shares:?}");
        }
        if angle.is_infinite() {
            assert!(shares.iter().skip(1).step_by(2).all(|share| *share == 0.0), "{shares:?}");
        }
    }
}

#[test]
fn tolerances_move_own_unknowns_off_their_feet_and_cost_what_they_say() {
    let problem = Poses::drawn(COUNT, NOISE);
    let plain = solved(&problem, &Goal::SumOfSquares);
    assert!(off_foot(&problem, &plain) < 1e-6);
    // The angles of the plain fit are off by more than 0.02: the tolerance takes them on at some cost of place.
    let within = |place: f64, angle: f64| {
        let list = tolerances(COUNT, place, angle);
        let result = solved(&problem, &Goal::SumOfSquaresWithin { tolerances: &list });
        (result, list)
    };
    let (result, list) = within(1.0, 0.02);
    let known = least_within(&problem, &list, 10.0);
    assert!((result.objective - known).abs() < 1e-7 * known, "{} {known}", result.objective);
    assert!(result.objective > 1.05 * plain.objective && result.deviation < 1.0 + 1e-8, "{result:?}");
    assert!(off_foot(&problem, &result) > 0.01);
    let multipliers = result.multipliers.expect("a program was solved").points;
    assert!(multipliers.iter().sum::<f64>() < 10.0 && multipliers[0] < 1e-6, "{multipliers:?}");
    let step = 1e-3;
    let objective = |by: f64| within(1.0, 0.02 * (1.0 + by)).0.objective;
    let rate = (objective(-step) - objective(step)) / (2.0 * step);
    let said: f64 = multipliers.iter().skip(1).step_by(2).sum();
    assert!((said - rate).abs() < 2e-3 * rate && rate > 0.0, "{said} {rate}");
    // Tolerances that are met anyway change nothing; of both kinds at once the line searches know the optimum.
    let (loose, _) = within(1.0, 1.0);
    assert!((loose.objective - plain.objective).abs() < 1e-9 * plain.objective);
    let most = least_deviation(&problem, &tolerances(COUNT, 1.0, 0.5));
    let (both, list) = within(1.02 * most, 0.51 * most);
    let known = least_within(&problem, &list, 10.0);
    assert!((both.objective - known).abs() < 1e-6 * known, "{} {known}", both.objective);
    let multipliers = both.multipliers.expect("a program was solved").points;
    let sums = [0, 1].map(|kind| multipliers.iter().skip(kind).step_by(2).sum::<f64>());
    assert!(sums.iter().all(|sum| *sum > 1e-4) && sums[0] + sums[1] < 10.0, "{sums:?}");
}

#[test]
fn inequalities_of_traded_own_unknowns_hold_at_the_optimum() {
    let limits = || {
        vec![
            Limit { constant: -0.3, gradient: [0.0; 4], own: Some((0, 1.0)) },
            Limit { constant: 3.3, gradient: [0.0, 0.0, -1.0, 0.0], own: Some((COUNT - 1, -1.0)) },
        ]
    };
    let list = tolerances(COUNT, 1.0, 0.6);
    let free = solved(&Poses::drawn(COUNT, NOISE), &Goal::MaxDeviation { tolerances: &list });
    assert!(free.state[0] < 0.3 && free.x[2] + free.state[COUNT - 1] > 3.3, "{free:?}");
    let problem = Poses { limits: limits(), ..Poses::drawn(COUNT, NOISE) };
    for goal in [
        Goal::MaxDeviation { tolerances: &list },
        Goal::SumOfSquaresWithin { tolerances: &tolerances(COUNT, 0.2, 0.12) },
    ] {
        let result = solved(&problem, &goal);
        assert!(result.violation < 1e-9, "{result:?}");
        let known = match goal {
            Goal::SumOfSquaresWithin { tolerances } => least_within(&problem, tolerances, 10.0),
            _ => least_deviation(&problem, &list),
        };
        assert!((result.objective - known).abs() < 1e-6 * known, "{} {known}", result.objective);
    }
}

#[test]
fn of_many_poses_those_above_the_maximum_join_the_program() {
    let problem = Poses::drawn(130, NOISE);
    let list = tolerances(130, 1.0, 0.5);
    let result = solved(&problem, &Goal::MaxDeviation { tolerances: &list });
    let known = least_deviation(&problem, &list);
    assert!((result.objective - known).abs() < 1e-6 * known, "{} {known}", result.objective);
}

/// Poses at own unknowns that are given: their tangents are zero.
struct Timed(Poses, Vec<f64>);

impl BlockLeastSquares<4, 3> for Timed {
    type State = ();
    fn points(&self) -> usize {
        self.1.len()
    }
    fn bounds(&self) -> &[(f64, f64); 4] {
        &self.0.bounds
    }
    fn cost(&self, x: &Shared, (): &()) -> Option<f64> {
        self.0.cost(x, &self.1)
    }
    fn linearise(&self, x: &Shared, (): &(), each: &mut dyn FnMut(&PointBlock<4, 3>)) -> bool {
        self.0.linearise(x, &self.1, &mut |block| each(&PointBlock { tangent: [0.0; 3], ..*block }))
    }
    fn retract(&self, _: &Shared, (): &(), _: &[f64], _: &Shared, (): &mut ()) -> bool {
        true
    }
    fn constraints(&self, _: &Shared, (): &(), _: &mut EachConstraint<'_, 4>) {}
}

#[test]
fn poses_without_own_unknowns_have_a_cone_and_two_rows() {
    let (problem, list) = (Poses::drawn(COUNT, NOISE), tolerances(COUNT, 1.0, 0.7));
    let given = problem.start().1;
    let part = |x: &Shared, j: usize, _: f64| problem.deviation(x, j, given[j], &list);
    let known = problem.by_line_searches(part, f64::max);
    let timed = Timed(Poses::drawn(COUNT, NOISE), given.clone());
    let goal = Goal::MaxDeviation { tolerances: &list };
    let result = solve(&timed, &goal, problem.start().0, (), &options(), &|| false);
    assert_eq!(result.outcome, ConvexOutcome::Converged);
    assert!((result.objective - known).abs() < 1e-8, "{} {known}", result.objective);
    let squares = solve(&timed, &Goal::SumOfSquares, problem.start().0, (), &options(), &|| false);
    let part = |x: &Shared, j: usize, _: f64| problem.squares(x, j, given[j]);
    let known = problem.by_line_searches(part, |sum, cost| sum + cost);
    assert!((squares.objective - known).abs() < 1e-9 * known, "{} {known}", squares.objective);
}

/// The places of poses alone, as residuals of two rows, or of three with an empty last one.
struct Places<const R: usize>(Poses);

impl<const R: usize> BlockLeastSquares<4, R> for Places<R> {
    type State = Vec<f64>;
    fn points(&self) -> usize {
        self.0.points()
    }
    fn bounds(&self) -> &[(f64, f64); 4] {
        self.0.bounds()
    }
    fn cost(&self, x: &Shared, state: &Vec<f64>) -> Option<f64> {
        let place = |(j, s): (usize, &f64)| {
            let r = self.0.residual(x, j, *s);
            self.0.weights[j] * (r[0] * r[0] + r[1] * r[1])
        };
        Some(state.iter().enumerate().map(place).sum())
    }
    fn linearise(&self, x: &Shared, state: &Vec<f64>, each: &mut dyn FnMut(&PointBlock<4, R>)) -> bool {
        self.0.linearise(x, state, &mut |block| {
            let row = |axis: usize, value: f64| if axis < 2 { value } else { 0.0 };
            each(&PointBlock {
                residual: std::array::from_fn(|axis| row(axis, block.residual[axis])),
                jacobian: std::array::from_fn(|axis| block.jacobian[axis].map(|value| row(axis, value))),
                tangent: std::array::from_fn(|axis| row(axis, block.tangent[axis])),
                weight: block.weight,
            });
        })
    }
    fn retract(&self, from: &Shared, state: &Vec<f64>, tau: &[f64], to: &Shared, out: &mut Vec<f64>) -> bool {
        self.0.retract(from, state, tau, to, out)
    }
    fn constraints(&self, _: &Shared, _: &Vec<f64>, _: &mut EachConstraint<'_, 4>) {}
}

#[test]
fn an_empty_third_row_leaves_the_answers_of_two() {
    let poses = || Poses::drawn(COUNT, NOISE);
    let (x, state) = poses().start();
    let ones = vec![1.0; COUNT];
    for angle in [f64::INFINITY, 1e-3] {
        let list = tolerances(COUNT, 1.0, angle);
        for (two, three) in [
            (Goal::SumOfSquares, Goal::SumOfSquares),
            (Goal::MaxDeviation { tolerances: &ones }, Goal::MaxDeviation { tolerances: &list }),
        ] {
            let two = solve(&Places::<2>(poses()), &two, x, state.clone(), &options(), &|| false);
            let three = solve(&Places::<3>(poses()), &three, x, state.clone(), &options(), &|| false);
            assert_eq!(two.outcome, ConvexOutcome::Converged);
            let close = 1e-8 * two.objective;
            assert!((two.objective - three.objective).abs() < close, "{two:?}\n{three:?}");
        }
    }
}

#[test]
fn drawn_tolerances_of_every_part_end_where_line_searches_do() {
    let mut draws = stream(99, 0);
    for case in 0..10 {
        let count = 3 + below(&mut draws, 9);
        let problem = Poses::drawn(count, uniform(&mut draws, 0.005, 0.12));
        let list: Vec<f64> = (0..2 * count).map(|_| uniform(&mut draws, 0.1, 1.0)).collect();
        let nearest = solved(&problem, &Goal::MaxDeviation { tolerances: &list });
        let known = least_deviation(&problem, &list);
        assert!((nearest.objective - known).abs() < 1e-7 * known, "{case}: {} {known}", nearest.objective);
        let list: Vec<f64> = list.iter().map(|tol| 1.05 * known * tol).collect();
        let within = solved(&problem, &Goal::SumOfSquaresWithin { tolerances: &list });
        let multipliers = within.multipliers.expect("a program was solved").points;
        let known = least_within(&problem, &list, 0.1 + 2.0 * multipliers.iter().sum::<f64>());
        assert!((within.objective - known).abs() < 1e-7 * known, "{case}: {} {known}", within.objective);
        assert!(within.deviation < 1.0 + 1e-8, "{case}: {}", within.deviation);
    }
}
