//! The reduced form of prescribed timing: its costs are those of real linkages, its linear unknowns are the
//! best ones, its Jacobian gives the gradient, and eight lanes give the bits of one.

use crate::common::parse;
use linkwright::internals::mechanism::{AssemblyMode, Complex};
use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, uniform};
use linkwright::internals::numbers::optimise::compact_lm::CompactLeastSquares;
use linkwright::internals::task::Problem;
use linkwright::internals::task::forms::projection::{Batch, ProjectedFit, Projection, Reduced, UNKNOWNS};
use linkwright::internals::task::{AngleOffset, Timing};
use std::f64::consts::PI;

const POINTS: &str =
    "points = [[0, 0], [1, 0.4], [1.6, 1.1], [1.2, 1.9], [0.3, 2], [-0.5, 1.2], [-0.4, 0.5]]";
const WEIGHTED: &str = "weight = [1, 2, 0.5, 1, 3, 1, 0.25]\n";

fn problem(offset: &str, design: &str) -> Problem {
    let text = format!(
        "format = 1\n[task.path]\n{POINTS}\n[task.path.timing]\ncrank_deg = [0, 35, 88, 122, 171, 203, 250]\n\
         offset = \"{offset}\"\n[design]\n{design}\n[require]\nlink_ratio_max = 1000\n"
    );
    let mut spec = parse(&text).spec;
    let weights = WEIGHTED.trim_start_matches("weight = [").trim_end_matches("]\n");
    spec.task.weight = Some(weights.split(", ").map(|w| w.parse().expect("a number")).collect());
    Problem::new(spec).expect("it is one")
}

/// Every way in which linear unknowns can be complex, real or known.
fn cases() -> Vec<(String, Problem)> {
    let designs = [
        "",
        "A = [0.3, -0.4]",
        "B = [2.3, 0.7]",
        "A = [0.3, -0.4]\nB = [2.3, 0.7]",
        "ground_angle_deg = 25",
        "ground_angle_deg = 25\nground = 2.5",
        "A = [0.3, -0.4]\nground_angle_deg = 25",
        "A = [0.3, -0.4]\nground_angle_deg = 25\nground = 2.5",
        "B = [2.3, 0.7]\nground_angle_deg = 25",
        "B = [2.3, 0.7]\nground_angle_deg = 25\nground = 2.5",
        "ground = 2.5",
        "A = [0.3, -0.4]\nground = 2.5",
        "B = [2.3, 0.7]\nground = 2.5",
        "a = [0.8, 1.6]\nground = [1, 2]\nb = [1, 1.2]",
        "B = [2.3, 0.7]\nground_angle_deg = 25\na = [0.8, 1.6]\nground = [1, 2]\nb = [1, 1.2]",
    ];
    let mut cases = Vec::new();
    for offset in ["free", "fixed", "ground"] {
        for design in designs {
            cases.push((format!("{offset}, {}", design.replace('\n', ", ")), problem(offset, design)));
        }
    }
    cases
}

fn draw(stream: &mut Stream, form: &Projection) -> Reduced {
    let mut x = [0.0; UNKNOWNS];
    for value in &mut x[..3] {
        *value = uniform(stream, -1.5, 1.5);
    }
    x[3] = if form.has_angle() { uniform(stream, -PI, PI) } else { 0.0 };
    x
}

/// Points of the form that have a cost on the assembly.
fn usable(form: &Projection, assembly: AssemblyMode, wanted: usize) -> Vec<Reduced> {
    let mut draws = stream(5, 0);
    let mut fit = ProjectedFit::new(form, assembly);
    let found: Vec<Reduced> =
        (0..200_000).map(|_| draw(&mut draws, form)).filter(|x| fit.cost(x).is_some()).take(wanted).collect();
    assert_eq!(found.len(), wanted);
    found
}

/// The weighted sum of squares of a linkage at crank angles offset + direction psi, by the task's own evaluation.
fn direct(
    problem: &Problem,
    fit: &mut ProjectedFit<'_>,
    x: &Reduced,
    assembly: AssemblyMode,
    direction: f64,
) -> f64 {
    let solution = fit.solution(x).expect("it has one");
    let linkage = solution.shape.linkage(assembly).expect("it is one");
    let Timing::Prescribed { crank_angles, offset } = problem.task().timing() else { panic!("prescribed") };
    let base = match offset {
        AngleOffset::Free => solution.offset,
        AngleOffset::Fixed => 0.0,
        AngleOffset::Ground => linkage.ground_angle(),
    };
    let angles: Vec<f64> = crank_angles.iter().map(|psi| base + direction * psi).collect();
    problem
        .task()
        .errors(linkage, &angles, &vec![assembly; angles.len()], None)
        .map_or(f64::NAN, |e| e.objective)
}

const BOTH: [AssemblyMode; 2] = [AssemblyMode::Plus, AssemblyMode::Minus];

#[test]
fn the_reduced_cost_is_the_cost_of_the_linkage_that_it_stands_for() {
    let mut forms = 0;
    for (name, problem) in cases() {
        for &direction in problem.directions() {
            // Two angles would be needed where increments count and the ground has a length and no direction.
            let Some(form) = Projection::new(&problem, direction) else {
                assert!(name.starts_with("free") && name.contains("ground = 2.5"), "{name}");
                assert!(!name.contains("angle"), "{name}");
                continue;
            };
            forms += 1;
            for assembly in BOTH {
                let mut fit = ProjectedFit::new(&form, assembly);
                for x in usable(&form, assembly, 12) {
                    let cost = fit.cost(&x).expect("usable");
                    let direct = direct(&problem, &mut fit, &x, assembly, direction);
                    // Lengths of up to some hundred for a target of 3.
                    assert!((cost - direct).abs() <= 1e-9 * (1.0 + cost), "{name}: {cost} {direct}");
                }
            }
        }
    }
    // 15 designs with 2, 1 and 1 directions, less three without a form in both directions.
    assert_eq!(forms, 15 * 4 - 6);
}

#[test]
fn what_the_design_fixes_is_kept_by_the_linear_part() {
    for (name, problem) in cases() {
        let Some(form) = Projection::new(&problem, 1.0) else { continue };
        let mut fit = ProjectedFit::new(&form, AssemblyMode::Plus);
        for x in usable(&form, AssemblyMode::Plus, 10) {
            let shape = fit.solution(&x).expect("usable").shape;
            let ground = shape.follower_pivot - shape.crank_pivot;
            let size = 1.0 + shape.crank_pivot.norm() + ground.norm();
            let near = |p: Complex, q: Complex| (p - q).norm() <= 1e-12 * size;
            if name.contains("A =") {
                assert!(near(shape.crank_pivot, Complex::new(0.3, -0.4)), "{name}");
            }
            if name.contains("B =") {
                assert!(near(shape.follower_pivot, Complex::new(2.3, 0.7)), "{name}");
            }
            if name.contains("ground = 2.5") {
                assert!((ground.norm() - 2.5).abs() <= 1e-12 * size, "{name}");
            }
            if name.contains("ground_angle_deg") {
                assert!((ground.arg() - 25f64.to_radians()).abs() <= 1e-12, "{name}");
            }
            for (k, length) in [shape.crank, shape.coupler, shape.follower].into_iter().enumerate() {
                assert!((length / ground.norm() - x[k].exp()).abs() <= 1e-12 * x[k].exp(), "{name}");
            }
        }
    }
}

#[test]
fn no_neighbouring_coupler_point_or_pivot_fits_better() {
    let problem = problem("free", "a = [0, 1e6]\nb = [0, 1e6]\nc = [0, 1e6]\nground = [0, 1e6]");
    let form = Projection::new(&problem, 1.0).expect("prescribed");
    let mut fit = ProjectedFit::new(&form, AssemblyMode::Minus);
    for x in usable(&form, AssemblyMode::Minus, 20) {
        let solution = fit.solution(&x).expect("usable");
        let Timing::Prescribed { crank_angles, .. } = problem.task().timing() else { panic!("prescribed") };
        let cost_of = |shape: &linkwright::internals::task::forms::design_space::Shape, offset: f64| {
            let linkage = shape.linkage(AssemblyMode::Minus).expect("it is one");
            let angles: Vec<f64> = crank_angles.iter().map(|psi| offset + psi).collect();
            problem
                .task()
                .errors(linkage, &angles, &[AssemblyMode::Minus; 7], None)
                .expect("closed")
                .objective
        };
        let best = cost_of(&solution.shape, solution.offset);
        let step = 1e-3;
        for turn in 0..8 {
            let by = Complex::from_polar(step, PI * f64::from(turn) / 4.0);
            let mut moved = solution.shape;
            moved.crank_pivot += by;
            moved.follower_pivot += by;
            assert!(cost_of(&moved, solution.offset) > best, "A");
            moved = solution.shape;
            moved.offset += by;
            assert!(cost_of(&moved, solution.offset) > best, "Z");
            // K: the whole linkage but its coupler point turned and scaled about A.
            moved = solution.shape;
            let grown = Complex::new(1.0, 0.0) + by;
            let ground = (moved.follower_pivot - moved.crank_pivot) * grown;
            moved.follower_pivot = moved.crank_pivot + ground;
            let size = grown.norm();
            (moved.crank, moved.coupler, moved.follower) =
                (moved.crank * size, moved.coupler * size, moved.follower * size);
            moved.offset *= grown.conj() / size;
            assert!(cost_of(&moved, solution.offset + grown.arg()) > best, "K");
        }
    }
}

#[test]
fn limits_of_the_lengths_are_kept_and_the_best_within_them_is_taken() {
    let limits = [(1.0, 2.0), (0.8, 1.6), (0.5, 3.0), (0.5, 2.5)];
    let text = "ground = [1, 2]\na = [0.8, 1.6]\nb = [0.5, 3]\nc = [0.5, 2.5]";
    let (mut binding, mut inside) = (0, 0);
    for design in [text.to_string(), format!("{text}\nground_angle_deg = 25")] {
        for offset in ["free", "ground"] {
            let problem = problem(offset, &design);
            let form = Projection::new(&problem, 1.0).expect("prescribed");
            let mut fit = ProjectedFit::new(&form, AssemblyMode::Plus);
            for x in usable(&form, AssemblyMode::Plus, 60) {
                let [p, q, r] = [x[0].exp(), x[1].exp(), x[2].exp()];
                let solution = fit.solution(&x).expect("usable");
                let links = solution.shape.links();
                let by_crank = [1.0 / p, 1.0, q / p, r / p];
                let low = limits.iter().zip(by_crank).map(|(l, k)| l.0 / k).fold(0.0, f64::max);
                let high = limits.iter().zip(by_crank).map(|(l, k)| l.1 / k).fold(f64::INFINITY, f64::min);
                if low > high {
                    assert!((links[1] - (low * high).sqrt()).abs() <= 1e-7 * links[1]);
                    continue;
                }
                for (length, (low, high)) in links.iter().zip(limits) {
                    // The ground's limits are taken with the margin of a requirement.
                    assert!(*length >= low - 1e-7 && *length <= high + 1e-7, "{length} in [{low}, {high}]");
                }
                let at_limit = (links[1] - low).abs() <= 1e-7 || (links[1] - high).abs() <= 1e-7;
                *(if at_limit { &mut binding } else { &mut inside }) += 1;
            }
        }
    }
    assert!(binding > 20 && inside > 5, "{binding} at a limit, {inside} inside");
}

#[test]
fn kaufmans_jacobian_gives_the_gradient_of_the_reduced_cost() {
    for (name, problem) in cases() {
        for &direction in problem.directions() {
            let Some(form) = Projection::new(&problem, direction) else { continue };
            for assembly in BOTH {
                let mut fit = ProjectedFit::new(&form, assembly);
                let mut errors = Vec::new();
                for x in usable(&form, assembly, 15) {
                    fit.cost(&x).expect("usable");
                    let normal = fit.normal();
                    let mut worst: f64 = 0.0;
                    for k in 0..UNKNOWNS {
                        if k == 3 && !form.has_angle() {
                            assert_eq!(normal.gradient[k], 0.0, "no angle, no slope");
                            continue;
                        }
                        let step = 1e-6;
                        let mut at = |by: f64| {
                            let mut to = x;
                            to[k] += by;
                            fit.cost(&to)
                        };
                        let (Some(up), Some(down)) = (at(step), at(-step)) else { continue };
                        let difference = (up - down) / (2.0 * step);
                        let scale = 1.0 + normal.gradient[k].abs();
                        worst = worst.max((2.0 * normal.gradient[k] - difference).abs() / scale);
                    }
                    errors.push(worst);
                }
                errors.sort_by(f64::total_cmp);
                // A start or two lies next to a toggle, where differences say nothing.
                assert!(errors[11] <= 1e-5, "{name}, {direction}, {assembly:?}: {errors:?}");
            }
        }
    }
}

#[test]
fn eight_lanes_give_the_bits_of_one_and_the_cost_of_the_fit() {
    for (name, problem) in cases() {
        let Some(form) = Projection::new(&problem, 1.0) else { continue };
        let mut draws = stream(6, 0);
        let batch = Batch::new((0..203).map(|_| draw(&mut draws, &form)).collect());
        let costs = form.screen_unless(&batch, &|| false).expect("nothing stops it");
        let mut closed = 0;
        for (assembly, costs) in BOTH.into_iter().zip(&costs) {
            assert_eq!(costs.len(), batch.len());
            let mut fit = ProjectedFit::new(&form, assembly);
            for (x, cost) in batch.draws().iter().zip(costs) {
                assert_eq!(cost.to_bits(), form.screen_one(x, assembly).to_bits(), "{name}");
                match fit.cost(x) {
                    Some(fitted) => {
                        closed += 1;
                        assert!((fitted - cost).abs() <= 1e-9 * (1.0 + fitted), "{name}: {fitted} {cost}");
                    }
                    None => assert!(cost.is_infinite(), "{name}: {cost}"),
                }
            }
        }
        assert!(closed > 0, "{name}");
    }
}

#[test]
fn a_coupler_that_turns_with_the_crank_is_refused_as_singular() {
    // p = r, q = 1: between its flat positions a parallelogram keeps its coupler still; u is constant and
    // cannot be told from A.
    let text = format!(
        "format = 1\n[task.path]\n{POINTS}\n[task.path.timing]\ncrank_deg = [10, 35, 58, 82, 101, 123, 150]\n\
         offset = \"ground\"\n"
    );
    let problem = Problem::new(parse(&text).spec).expect("it is one");
    let form = Projection::new(&problem, 1.0).expect("prescribed");
    let still = [-1.0, 0.0, -1.0, 0.0];
    let fits = BOTH.map(|t| ProjectedFit::new(&form, t).cost(&still).is_some());
    assert!(fits.contains(&false), "on one assembly the coupler stands still");
    let screened = BOTH.map(|t| form.screen_one(&still, t).is_finite());
    assert_eq!(fits, screened);
}
