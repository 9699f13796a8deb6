//! Tests against known optima; no derivative is taken from the solver itself.

use super::super::levenberg_marquardt::{EachConstraint, MOST_OWN};
use super::*;

/// Returns the length |r|.
fn norm(r: [f64; 2]) -> f64 {
    r[0].hypot(r[1])
}

type Residual<'a> = Box<dyn Fn(&[f64; 2]) -> [f64; 2] + 'a>;
type Inequality<'a> = Box<dyn Fn(&[f64; 2]) -> f64 + 'a>;

/// Residuals and inequalities as plain functions of x in R^2, differentiated by central differences.
struct Plain<'a> {
    bounds: [(f64, f64); 2],
    residuals: Vec<Residual<'a>>,
    rows: Vec<Inequality<'a>>,
}

const H: f64 = 1e-6;

fn shifted(x: &[f64; 2], i: usize, by: f64) -> [f64; 2] {
    let mut to = *x;
    to[i] += by;
    to
}

impl BlockLeastSquares<2> for Plain<'_> {
    type State = ();
    fn points(&self) -> usize {
        self.residuals.len()
    }
    fn bounds(&self) -> &[(f64, f64); 2] {
        &self.bounds
    }
    fn cost(&self, x: &[f64; 2], (): &()) -> Option<f64> {
        let sum: f64 = self.residuals.iter().map(|r| norm(r(x)).powi(2)).sum();
        sum.is_finite().then_some(sum)
    }
    fn linearise(&self, x: &[f64; 2], (): &(), each: &mut dyn FnMut(&PointBlock<2>)) -> bool {
        for r in &self.residuals {
            let by = |i, axis: usize| (r(&shifted(x, i, H))[axis] - r(&shifted(x, i, -H))[axis]) / (2.0 * H);
            let jacobian = [0, 1].map(|axis| [by(0, axis), by(1, axis)]);
            each(&PointBlock { residual: r(x), jacobian, tangent: [0.0; 2], weight: 1.0 });
        }
        true
    }
    fn retract(&self, _: &[f64; 2], (): &(), _: &[f64], _: &[f64; 2], (): &mut ()) -> bool {
        true
    }
    fn constraints(&self, x: &[f64; 2], (): &(), each: &mut EachConstraint<'_, 2>) {
        for g in &self.rows {
            let by = |i| (g(&shifted(x, i, H)) - g(&shifted(x, i, -H))) / (2.0 * H);
            let value = g(x);
            each(value, &|| ConstraintRow { value, gradient: [by(0), by(1)], own: [None; MOST_OWN] });
        }
    }
}

const ANYWHERE: [(f64, f64); 2] = [(f64::NEG_INFINITY, f64::INFINITY); 2];

fn options() -> ConvexOptions<2> {
    ConvexOptions {
        max_steps: 200,
        max_evaluations: 1000,
        trust: [0.5; 2],
        length: 1.0,
        relative_reduction: 1e-11,
        feasibility: 1e-9,
        good_enough: 0.0,
    }
}

fn solved(problem: &Plain<'_>, goal: &Goal<'_>, start: [f64; 2]) -> ConvexResult<2, ()> {
    let result = solve(problem, goal, start, (), &options(), &|| false);
    assert!(
        matches!(result.outcome, ConvexOutcome::Converged | ConvexOutcome::Stalled),
        "{:?} after {} steps",
        result.outcome,
        result.steps
    );
    result
}

/// Builds a line fit: values f(t) - x0 - x1 t at evenly spaced t in [0, 1] as residuals along the x axis.
fn line_fit(n: usize, f: impl Fn(f64) -> f64) -> Plain<'static> {
    let values: Vec<(f64, f64)> = (0..n).map(|i| i as f64 / (n - 1) as f64).map(|t| (t, f(t))).collect();
    let residual =
        |(t, value): (f64, f64)| -> Residual<'static> { Box::new(move |x| [value - x[0] - x[1] * t, 0.0]) };
    Plain { bounds: ANYWHERE, residuals: values.into_iter().map(residual).collect(), rows: Vec::new() }
}

#[test]
fn the_best_line_to_a_parabola_is_chebyshevs() {
    // t^2 on [0, 1]: t - 1/8, deviation 1/8 at 0, 1/2 and 1 (Chebyshev 1854).
    for n in [11, 1001] {
        let ones = vec![1.0; n];
        let result = solved(&line_fit(n, |t| t * t), &Goal::MaxDeviation { tolerances: &ones }, [0.3, -0.7]);
        assert!((result.objective - 0.125).abs() < 1e-9, "{result:?}");
        assert!((result.x[0] + 0.125).abs() < 1e-7 && (result.x[1] - 1.0).abs() < 1e-7, "{:?}", result.x);
        let shares = result.multipliers.expect("a program was solved").points;
        assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-6);
        // De la Vallee-Poussin's weights of the alternation 0, 1/2, 1.
        for (at, share) in [(0, 0.25), ((n - 1) / 2, 0.5), (n - 1, 0.25)] {
            assert!((shares[at] - share).abs() < 1e-4, "{at}: {}", shares[at]);
        }
    }
}

#[test]
fn a_tolerance_a_point_scales_its_deviation() {
    // Values 0 at t = 0 and 1 at t = 1, a constant to fit: the deviations are proportional to the tolerances.
    let problem = Plain { bounds: [(-9.0, 9.0), (0.0, 0.0)], ..line_fit(2, |t| t) };
    let result = solved(&problem, &Goal::MaxDeviation { tolerances: &[1.0, 3.0] }, [5.0, 0.0]);
    assert!((result.x[0] - 0.25).abs() < 1e-8 && (result.objective - 0.25).abs() < 1e-8, "{result:?}");
}

/// Builds a problem with curved residuals: distances to four places minus given ranges.
fn ranges() -> Plain<'static> {
    let places = [([0.0, 0.0], 2.0), ([4.0, 0.0], 3.0), ([0.0, 3.0], 2.2), ([5.0, 4.0], 3.1)];
    let residual = |(at, range): ([f64; 2], f64)| -> Residual<'static> {
        Box::new(move |x| [(x[0] - at[0]).hypot(x[1] - at[1]) - range, 0.0])
    };
    Plain { bounds: ANYWHERE, residuals: places.into_iter().map(residual).collect(), rows: Vec::new() }
}

/// Finds the least value of a function of two variables by a grid that is refined around its best point.
fn by_grid(f: impl Fn(&[f64; 2]) -> f64, mut centre: [f64; 2], mut half: f64) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..60 {
        let from = centre;
        for i in -10..=10 {
            for k in -10..=10 {
                let at = [from[0] + half * f64::from(i) / 10.0, from[1] + half * f64::from(k) / 10.0];
                if f(&at) < best {
                    (best, centre) = (f(&at), at);
                }
            }
        }
        half *= 0.6;
    }
    best
}

#[test]
fn curved_residuals_end_where_a_search_without_derivatives_does() {
    let problem = ranges();
    let ones = [1.0; 4];
    let deviation = |x: &[f64; 2]| problem.residuals.iter().map(|r| norm(r(x))).fold(0.0, f64::max);
    let result = solved(&problem, &Goal::MaxDeviation { tolerances: &ones }, [1.0, 2.5]);
    let known = by_grid(deviation, [1.5, 1.5], 2.0);
    assert!((result.objective - known).abs() < 1e-7, "{} {known}", result.objective);
    let sum = |x: &[f64; 2]| problem.cost(x, &()).expect("finite");
    let result = solved(&problem, &Goal::SumOfSquares, [1.0, 2.5]);
    let known = by_grid(sum, [1.5, 1.5], 2.0);
    assert!((result.objective - known).abs() < 1e-9 * known, "{} {known}", result.objective);
    assert!(result.evaluations < 25, "{}", result.evaluations);
}

/// Few of many points decide, and these change from step to step.
#[test]
fn of_three_hundred_points_those_that_decide_are_found() {
    let place = |i: usize| {
        let t = i as f64;
        [4.0 * (0.7 * t).cos() + 0.3 * (1.3 * t).sin(), 3.0 * (0.7 * t).sin() + 0.2 * (2.9 * t).cos()]
    };
    let residual = |at: [f64; 2]| -> Residual<'static> {
        Box::new(move |x| [(x[0] - at[0]).hypot(x[1] - at[1]) - 3.4, 0.0])
    };
    let residuals = (0..300).map(|i| residual(place(i))).collect();
    let problem = Plain { bounds: ANYWHERE, residuals, rows: Vec::new() };
    let tolerances: Vec<f64> = (0..300).map(|i| 1.0 + 0.2 * (0.37 * f64::from(i)).sin()).collect();
    let deviation = |x: &[f64; 2]| {
        let parts = problem.residuals.iter().zip(&tolerances).map(|(r, tolerance)| norm(r(x)) / tolerance);
        parts.fold(0.0, f64::max)
    };
    let goal = Goal::MaxDeviation { tolerances: &tolerances };
    let result = solved(&problem, &goal, [1.5, -2.5]);
    // A grid may come to rest on a kink: it finds nothing smaller, neither from afar nor from there.
    for (centre, half) in [([0.0, 0.0], 3.0), (result.x, 0.1)] {
        let known = by_grid(deviation, centre, half);
        assert!(result.objective < known + 1e-7, "{} {known}", result.objective);
    }
    // A wider band: the least sum of squares in it is at its edge.
    let band = 1.02 * result.objective;
    let wide: Vec<f64> = tolerances.iter().map(|tolerance| band * tolerance).collect();
    let within = solved(&problem, &Goal::SumOfSquaresWithin { tolerances: &wide }, result.x);
    let sum = |x: &[f64; 2]| problem.cost(x, &()).expect("finite");
    let inside = |x: &[f64; 2]| if deviation(x) <= band { sum(x) } else { f64::INFINITY };
    for (centre, half) in [(result.x, 0.5), (within.x, 0.1)] {
        let known = by_grid(inside, centre, half);
        assert!(within.objective < known * (1.0 + 1e-6), "{} {known}", within.objective);
    }
    assert!(within.deviation < 1.0 + 1e-9 && within.objective < sum(&result.x), "{within:?}");
}

/// Adds the constraint of the disc |x - (2, 1)| <= radius.
fn in_disc(mut problem: Plain<'_>, radius: f64) -> Plain<'_> {
    problem.rows.push(Box::new(move |x| radius - (x[0] - 2.0).hypot(x[1] - 1.0)));
    problem
}

#[test]
fn a_start_outside_first_gets_inside_and_multipliers_are_rates() {
    // The residuals pull to (5, 5); the disc constraint is active.
    let pull = || Plain {
        bounds: [(f64::NEG_INFINITY, f64::INFINITY), (f64::NEG_INFINITY, 1.4)],
        residuals: vec![Box::new(|x| [x[0] - 5.0, x[1] - 5.0]), Box::new(|x| [0.5 * x[0] - 1.0, 0.1 * x[1]])],
        rows: Vec::new(),
    };
    for goal in [Goal::SumOfSquares, Goal::MaxDeviation { tolerances: &[1.0, 1.0] }] {
        let at = |radius: f64| solved(&in_disc(pull(), radius), &goal, [30.0, -8.0]);
        let (middle, step) = (at(1.0), 1e-3);
        assert!(middle.violation <= 1e-9, "{middle:?}");
        let rate = (at(1.0 - step).objective - at(1.0 + step).objective) / (2.0 * step);
        let multipliers = middle.multipliers.as_ref().expect("a program was solved");
        assert!((multipliers.rows[0] - rate).abs() < 1e-3 * rate, "{multipliers:?} {rate}");
        let capped = |cap: f64| {
            let mut problem = in_disc(pull(), 1.0);
            problem.bounds[1].1 = cap;
            solved(&problem, &goal, [30.0, -8.0]).objective
        };
        let rate = (capped(1.4 - step) - capped(1.4 + step)) / (2.0 * step);
        assert!((multipliers.upper[1] - rate).abs() < 1e-3 * rate, "{multipliers:?} {rate}");
        assert_eq!(multipliers.upper[0], 0.0);
    }
}

#[test]
fn tolerances_bend_a_least_squares_fit_and_cost_what_they_say() {
    // Ten zeros and a one: least squares leaves 10/11 at the last.
    let problem =
        || Plain { bounds: [(-9.0, 9.0), (0.0, 0.0)], ..line_fit(11, |t| if t == 1.0 { 1.0 } else { 0.0 }) };
    let at = |tolerance: f64| {
        let mut tolerances = vec![1.0; 11];
        tolerances[10] = tolerance;
        solved(&problem(), &Goal::SumOfSquaresWithin { tolerances: &tolerances }, [-3.0, 0.0])
    };
    let result = at(0.6);
    assert!((result.x[0] - 0.4).abs() < 1e-8, "{result:?}");
    let rate = (at(0.6 * (1.0 - 1e-4)).objective - at(0.6 * (1.0 + 1e-4)).objective) / 2e-4;
    let said = result.multipliers.expect("a program was solved").points[10];
    assert!((said - rate).abs() < 1e-3 * rate, "{said} {rate}");
    assert!((at(0.95).x[0] - 1.0 / 11.0).abs() < 1e-7);
}

#[test]
fn what_cannot_be_met_is_called_infeasible() {
    let mut problem = in_disc(ranges(), 1.0);
    problem.rows.push(Box::new(|x| x[0] - 4.0));
    let ones = [1.0; 4];
    let result =
        solve(&problem, &Goal::MaxDeviation { tolerances: &ones }, [0.0, 0.0], (), &options(), &|| false);
    assert_eq!(result.outcome, ConvexOutcome::Infeasible, "{result:?}");
    // Half the gap of 1 between the disc and the half plane is the least lack.
    assert!((result.violation - 0.5).abs() < 1e-6, "{}", result.violation);
}

#[test]
fn evaluations_are_kept_and_a_stop_is_a_stop() {
    let problem = ranges();
    let few = ConvexOptions { max_evaluations: 3, ..options() };
    let result = solve(&problem, &Goal::SumOfSquares, [9.0, 9.0], (), &few, &|| false);
    assert!(result.evaluations <= 3 && result.outcome == ConvexOutcome::StepLimit, "{result:?}");
    let result = solve(&problem, &Goal::SumOfSquares, [9.0, 9.0], (), &options(), &|| true);
    assert_eq!((result.evaluations, result.outcome), (1, ConvexOutcome::Stopped));
}
