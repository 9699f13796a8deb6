//! The derivatives that the local searches use, by the public check, on random starts of every kind of task.

use crate::common::parse;
use linkwright::internals::numbers::arithmetic::streams::stream;
use linkwright::internals::numbers::optimise::levenberg_marquardt::{
    BlockLeastSquares, EachConstraint, LmOptions, LmOutcome, PointBlock, derivative_error, solve,
};
use linkwright::internals::synthesis::starts::Starts;
use linkwright::internals::task::Problem;
use linkwright::internals::task::forms::start::Start;
use linkwright::internals::task::forms::timed::TimedPathFit;
use linkwright::internals::task::forms::torus::PathFit;

/// Differences of 1e-6 of a number near 1 carry 1e-10 of rounding and 1e-12 of curvature; starts near a toggle
/// have third derivatives of up to some thousands.
const STEP: f64 = 1e-6;
const CLOSE: f64 = 2e-5;

const POINTS: &str = "points = [[0, 0], [1, 0.4], [1.6, 1.1], [1.2, 1.9], [0.3, 2], [-0.5, 1.2]]";

fn problem(tables: &str) -> Problem {
    let text = format!("format = 1\n[task.path]\n{POINTS}\nclosed = true\n{tables}");
    Problem::new(parse(&text).spec).expect("it is one")
}

/// The same points as an open path: its ends are positions of their own.
fn open_problem(tables: &str) -> Problem {
    let text = format!("format = 1\n[task.path]\n{POINTS}\n{tables}");
    Problem::new(parse(&text).spec).expect("it is one")
}

/// The same points in cm, of a linkage that carries 1 kg in P and pulls on a spring, with a torque below any that it needs.
fn loaded(closed: bool, tables: &str) -> Problem {
    let loads = "[require]\npeak_torque_max = 1e-3\n[loads]\ngravity = [0, -9.81]\nspeed_rpm = 90\n\
        [loads.body.coupler]\nmass_kg = 1\nat = \"P\"\ninertia_kg_m2 = 1e-5\n\
        [loads.body.follower]\nmass_kg = 0.1\ncenter = [0.5, 0.2]\n\
        [[loads.spring]]\nfrom = \"C\"\nto = [3, 5]\nrate_N_per_m = 40\nfree_length = 1\n";
    let text =
        format!("format = 1\nunit = \"cm\"\n[task.path]\n{POINTS}\nclosed = {closed}\n{tables}{loads}");
    Problem::new(parse(&text).spec).expect("it is one")
}

const REQUIRE: &str =
    "[require]\ntransmission_deg_min = 35\npivots_in = [-3, -3, 3, 3]\nlink_ratio_max = 5\n";

fn cases() -> Vec<(&'static str, Problem)> {
    let timing = |offset: &str| {
        format!("[task.path.timing]\ncrank_deg = [0, 55, 118, 182, 241, 303]\noffset = \"{offset}\"\n")
    };
    let cycle = "transmission_over = \"cycle\"\n";
    vec![
        ("offset free", problem(&(timing("free") + REQUIRE + cycle))),
        ("offset fixed", problem(&(timing("fixed") + REQUIRE + cycle))),
        ("offset ground", problem(&(timing("ground") + REQUIRE + cycle))),
        (
            "polar ground",
            problem(
                &(timing("ground")
                    + "[design]\nground = [0.5, 9]\nd = [0.1, 9]\ncoupler_x = [-9, 9]\n"
                    + REQUIRE
                    + cycle),
            ),
        ),
        (
            "distances",
            problem(&(timing("free") + "[design]\nd = [0.1, 9]\ne = [0.1, 9]\n" + REQUIRE + cycle)),
        ),
        ("footprint", problem(&(timing("free") + "[require]\nfootprint_in = [-2, -2, 3, 3]\n"))),
        ("extent", problem(&(timing("free") + "[require]\nextent_max = 4\n"))),
        ("extent, ground", problem(&(timing("ground") + "[require]\nextent_max = 4\n"))),
        ("longest", problem(&(timing("free") + "[require]\nlongest_max = 3\n"))),
        ("used", problem(&(timing("free") + REQUIRE + "transmission_over = \"used\"\n"))),
        ("free timing", problem(&(REQUIRE.to_string() + cycle))),
        ("free timing, used", open_problem(&(REQUIRE.to_string() + "transmission_over = \"used\"\n"))),
        (
            "free timing, footprint",
            open_problem(
                "[require]\nfootprint_in = [-2, -2, 3, 3]\ntype = [\"crank-rocker\", \"double-crank\"]\n",
            ),
        ),
        (
            "free timing, footprint of a rocker",
            open_problem(
                "[require]\nfootprint_in = [-2, -2, 3, 3]\ntype = [\"double-rocker\", \"rocker-crank\"]\n",
            ),
        ),
        (
            "free timing, footprint past toggles",
            open_problem(
                "[require]\nfootprint_in = [-2, -2, 3, 3]\ntype = [\"triple-rocker\"]\nbranch = \"any\"\n",
            ),
        ),
        (
            "free timing, extent",
            open_problem("[require]\nextent_max = 4\ntype = [\"crank-rocker\", \"double-crank\"]\n"),
        ),
        (
            "free timing, extent of a rocker",
            open_problem("[require]\nextent_max = 4\ntype = [\"double-rocker\", \"rocker-crank\"]\n"),
        ),
        (
            "free timing, extent past toggles",
            open_problem("[require]\nextent_max = 4\ntype = [\"triple-rocker\"]\nbranch = \"any\"\n"),
        ),
        ("peak torque", loaded(true, &timing("free"))),
        ("peak torque, ground", loaded(true, &timing("ground"))),
        ("free timing, peak torque", loaded(true, "")),
        ("free timing, peak torque over an arc", loaded(false, "")),
        ("free timing, longest", open_problem("[require]\nlongest_max = 3\n")),
        (
            "free timing, types",
            problem("[require]\ntype = [\"double-rocker\", \"rocker-crank\"]\nbranch = \"any\"\n"),
        ),
        (
            "free timing, polar",
            problem(
                "[design]\nground = [0.5, 9]\nground_angle_deg = [-80, 80]\ne = [0.5, 9]\ncoupler_y = [-9, 9]\n",
            ),
        ),
    ]
}

/// Steps in the numbers that are free and not at a bound.
fn steps<const N: usize>(fit: &impl BlockLeastSquares<N>, x: &[f64; N]) -> [f64; N] {
    let mut steps = [0.0; N];
    for (step, (value, (low, high))) in steps.iter_mut().zip(x.iter().zip(fit.bounds())) {
        if value - low > 10.0 * STEP && high - value > 10.0 * STEP {
            *step = STEP;
        }
    }
    steps
}

#[test]
fn residuals_tangents_and_constraints_agree_with_central_differences() {
    for (name, problem) in cases() {
        let starts = Starts::new(&problem);
        let mut draws = stream(11, 0);
        let mut errors = Vec::new();
        for _ in 0..4000 {
            if errors.len() == 60 {
                break;
            }
            let Some(Start { design, setting, mut positions, .. }) = starts.draw(&mut draws) else {
                continue;
            };
            let error = if positions.is_empty() {
                let fit = TimedPathFit::new(&problem, setting).expect("the timing is prescribed");
                if fit.cost(&design, &Vec::new()).is_none() {
                    continue;
                }
                derivative_error(&fit, &design, &Vec::new(), &steps(&fit, &design), STEP)
            } else {
                let fit = PathFit::new(&problem, setting);
                if !fit.settle(&design, &mut positions) {
                    continue;
                }
                derivative_error(&fit, &design, &positions, &steps(&fit, &design), STEP)
            };
            errors.extend(error);
        }
        assert_eq!(errors.len(), 60, "{name}");
        errors.sort_by(f64::total_cmp);
        // A few starts lie so near a toggle, or have two joints so nearly extreme together, that a difference
        // says nothing; a wrong derivative is wrong everywhere.
        assert!(errors[50] <= CLOSE, "{name}: {:e}", errors[50]);
    }
}

#[test]
fn a_step_never_leaves_the_bounds_and_the_best_point_is_returned() {
    for (name, problem) in cases() {
        let starts = Starts::new(&problem);
        let mut draws = stream(12, 0);
        let options = LmOptions {
            max_steps: 60,
            max_rounds: 4,
            max_evaluations: 1000,
            relative_reduction: 1e-10,
            exact_cost: 0.0,
            feasibility: 1e-9,
            hopeless_cost: f64::INFINITY,
        };
        for start in std::iter::repeat_with(|| starts.draw(&mut draws)).take(400).flatten().take(20) {
            let (x, cost, before, outcome, bounds) = if start.positions.is_empty() {
                let fit = TimedPathFit::new(&problem, start.setting).expect("the timing is prescribed");
                let before = fit.cost(&start.design, &start.positions);
                let end = solve(&fit, start.design, Vec::new(), &options, &|| false);
                (end.x, end.cost, before, end.outcome, *fit.bounds())
            } else {
                let fit = PathFit::new(&problem, start.setting);
                let before = fit.cost(&start.design, &start.positions);
                let end = solve(&fit, start.design, start.positions, &options, &|| false);
                (end.x, end.cost, before, end.outcome, *fit.bounds())
            };
            for (value, (low, high)) in x.iter().zip(bounds) {
                assert!((low..=high).contains(value), "{name}: {value} outside [{low}, {high}]");
            }
            assert_eq!(before.is_none(), outcome == LmOutcome::NoStart, "{name}");
            assert!(outcome == LmOutcome::NoStart || cost.is_finite(), "{name}");
        }
    }
}

/// One unknown, one residual |x| + 1 whose derivative is missing, or is claimed to be 1 on both sides of its kink.
struct Kink {
    has_derivative: bool,
    bounds: [(f64, f64); 1],
}

impl BlockLeastSquares<1> for Kink {
    type State = ();

    fn points(&self) -> usize {
        1
    }

    fn bounds(&self) -> &[(f64, f64); 1] {
        &self.bounds
    }

    fn cost(&self, x: &[f64; 1], _: &()) -> Option<f64> {
        Some((x[0].abs() + 1.0).powi(2))
    }

    fn linearise(&self, x: &[f64; 1], _: &(), each: &mut dyn FnMut(&PointBlock<1>)) -> bool {
        let jacobian = [[1.0], [0.0]];
        each(&PointBlock { residual: [x[0].abs() + 1.0, 0.0], jacobian, tangent: [0.0, 0.0], weight: 1.0 });
        self.has_derivative
    }

    fn retract(&self, _: &[f64; 1], _: &(), _: &[f64], _: &[f64; 1], _: &mut ()) -> bool {
        true
    }

    fn constraints(&self, _: &[f64; 1], _: &(), _: &mut EachConstraint<'_, 1>) {}
}

#[test]
fn a_dead_end_is_not_called_convergence() {
    let options = LmOptions {
        max_steps: 1000,
        max_rounds: 1,
        max_evaluations: 1000,
        relative_reduction: 0.0,
        exact_cost: 0.0,
        feasibility: 1e-9,
        hopeless_cost: f64::INFINITY,
    };
    for (has_derivative, outcome) in [(false, LmOutcome::NoDerivative), (true, LmOutcome::Stalled)] {
        let kink = Kink { has_derivative, bounds: [(-5.0, 5.0)] };
        let end = solve(&kink, [0.0], (), &options, &|| false);
        assert_eq!((end.outcome, end.x, end.cost), (outcome, [0.0], 1.0));
    }
}
