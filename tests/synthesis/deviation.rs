//! The least largest deviation, tolerances that are met or said not to be, and the polish of answers that a limit
//! holds.

use crate::common::thorough::cases;
use crate::common::{bytes, literature, parse, run_on};
use crate::reduced::free;
use linkwright::internals::files::problem_file::ProblemFile;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::judge::warm::start_at;
use linkwright::internals::record::{Candidate, Figure, Record};
use linkwright::internals::report::Colour;
use linkwright::internals::report::table::candidates_table;
use linkwright::internals::synthesis::multistart::{LONG_FIT, judged, polish};
use linkwright::internals::synthesis::polish::finish;
use linkwright::internals::synthesis::{Budget, Context};
use linkwright::internals::task::Problem;
use linkwright::internals::task::forms::fitness::PathFitness;
use linkwright::internals::task::forms::genes::DesignFitness;
use std::sync::atomic::AtomicBool;

const LARGEST: (&str, &str) = ("solve.objective", "max-deviation");

fn true_record(file: ProblemFile) -> Record {
    let record = run_on(2, file);
    assert_eq!(verify(&record).expect("the problem is one"), Vec::new());
    record
}

/// The errors at the points, largest first.
fn errors(record: &Record, candidate: &Candidate) -> Vec<f64> {
    let task = record.problem.resolved.task.to_task().expect("it is one");
    let radians: Vec<f64> = candidate.crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let error = task.errors(candidate.linkage, &radians, &candidate.t1_at, None).expect("it closes");
    let mut list: Vec<f64> = error.structural.iter().map(|e| e.norm()).collect();
    list.sort_by(|one, other| other.total_cmp(one));
    list
}

/// Twelve points of an egg-shaped curve with extra tables.
fn egg(tables: &str) -> String {
    let points: Vec<String> = (0..12)
        .map(|i| {
            let t = (30.0 * f64::from(i)).to_radians();
            let (x, y) = (40.0 * t.cos() + 6.0 * (2.0 * t).cos(), 22.0 * t.sin() + 5.0 * (2.0 * t).sin());
            format!("[{x:.4}, {y:.4}]")
        })
        .collect();
    format!("format = 1\n[task.path]\npoints = [{}]\nclosed = true\n{tables}", points.join(", "))
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn the_largest_error_is_attained_at_many_points_and_by_every_seed() {
    let least_squares = true_record(literature("k18", &[]));
    let mut known: Option<f64> = None;
    for seed in 1..=10 {
        let seed = seed.to_string();
        let record = true_record(literature("k18", &[LARGEST, ("solve.seed", &seed)]));
        let best = &record.candidates[0];
        assert!(best.accepted);
        assert_eq!(best.error.objective, best.error.max);
        assert!(best.error.max <= least_squares.candidates[0].error.max);
        assert!(best.error.sum_sq >= least_squares.candidates[0].error.sum_sq);
        let known = *known.get_or_insert(best.error.max);
        assert!((best.error.max - known).abs() <= 3e-6 * known, "seed {seed}: {}", best.error.max);
        // The optimum lies in a long flat valley: 3e-6 is what it leaves.
        // Ten unknowns and the maximum, eighteen planar errors: at least eight of them are equal.
        let list = errors(&record, best);
        let equal = list.iter().filter(|e| **e >= list[0] * (1.0 - 1e-6)).count();
        assert!(equal >= 8, "seed {seed}: {equal} of {list:?}");
    }
}

#[test]
fn no_small_change_of_the_linkage_lessens_the_largest_error() {
    // Free timing, and a limit that binds.
    let text = egg(
        "[require]\ntype = [\"crank-rocker\"]\ntransmission_deg_min = 45\n[solve]\nobjective = \"max-deviation\"\n",
    );
    let record = true_record(parse(&text));
    let best = &record.candidates[0];
    assert!(best.accepted);
    let list = errors(&record, best);
    let equal = list.iter().filter(|e| **e >= list[0] * (1.0 - 1e-6)).count();
    assert!(equal >= 6, "{list:?}");
    let squares = true_record(parse(&text.replace("objective = \"max-deviation\"", "")));
    assert!(best.error.max < squares.candidates[0].error.max);
    // Derivative-free: random small changes, each point at its nearest on the changed curve.
    let problem = Problem::new(parse(&text).spec).expect("it is one");
    let start = start_at(&problem, best).expect("it closes");
    let budget = Budget { cancel: &AtomicBool::new(false), deadline: None };
    let mut stream = linkwright::internals::numbers::arithmetic::streams::stream(3, 0);
    for _ in 0..200 {
        let mut moved = start.clone();
        for value in &mut moved.design {
            *value += 1e-3
                * linkwright::internals::numbers::arithmetic::streams::uniform(&mut stream, -1.0, 1.0)
                * value.abs();
        }
        let settled = linkwright::internals::synthesis::multistart::settle_positions(
            Context::new(&problem, &budget),
            &moved.design,
            moved.setting,
            moved.positions.clone(),
        );
        let Some(positions) = settled else { continue };
        moved.positions = positions;
        let Some(candidate) = judged(&problem, &moved) else { continue };
        assert!(!candidate.accepted || candidate.error.max >= best.error.max * (1.0 - 1e-9));
    }
}

#[test]
fn tolerances_are_the_unit_of_the_deviation() {
    let mut file = literature("k18", &[LARGEST]);
    let tolerances: Vec<f64> = (0..18).map(|j| if j < 9 { 0.02 } else { 0.06 }).collect();
    file.spec.task.tolerance = Some(tolerances.clone());
    let record = true_record(file);
    let best = &record.candidates[0];
    let task = record.problem.resolved.task.to_task().expect("it is one");
    let radians: Vec<f64> = best.crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let error = task.errors(best.linkage, &radians, &best.t1_at, None).expect("it closes");
    let parts: Vec<f64> = error.structural.iter().zip(&tolerances).map(|(e, t)| e.norm() / t).collect();
    let most = parts.iter().copied().fold(0.0, f64::max);
    assert!((best.error.objective - most).abs() <= 1e-12);
    assert_eq!(best.accepted, most <= 1.0 + 1e-7);
    let equal = parts.iter().filter(|p| **p >= most * (1.0 - 1e-6)).count();
    assert!(equal >= 7, "{parts:?}");
}

#[test]
fn candidates_are_in_the_order_of_the_largest_part_of_a_tolerance_and_that_is_what_is_shown() {
    // Six tight points and five loose ones, too tight for any linkage: nothing is accepted, and the deviation ranks.
    let points: Vec<String> = (0..11)
        .map(|i| {
            let x = 10.0 * f64::from(i);
            format!("[{x}, {}]", if i % 2 == 0 { 0.0 } else { 14.0 } + 0.02 * (x - 50.0).powi(2))
        })
        .collect();
    let tolerances: Vec<f64> = (0..11).map(|i| if i % 2 == 0 { 0.5 } else { 10.0 }).collect();
    let text = format!(
        "format = 1\n[task.path]\npoints = [{}]\ntolerance = {tolerances:?}\n[solve]\nobjective = \"max-deviation\"\n\
         evaluations = 6000\n",
        points.join(", ")
    );
    let record = true_record(parse(&text));
    let mut before = 0.0_f64;
    for candidate in &record.candidates {
        let row = candidate.requirements.iter().find(|r| r.name == "tolerance").expect("it is asked");
        let (Figure::Number(value), Figure::Number(limit)) = (&row.value, &row.limit) else {
            panic!("numbers")
        };
        let deviation = candidate.error.objective;
        assert!(
            (value / limit - deviation).abs() <= 1e-9 * deviation,
            "{value} / {limit} is not {deviation}"
        );
        assert!(
            deviation >= before || candidate.requirements.iter().any(|r| !r.met && r.name != "tolerance")
        );
        before = before.max(deviation);
    }
    let page = candidates_table(&record, Colour::Never);
    assert!(page.contains("deviation  at") && page.contains("parts of its point's tolerance"), "{page}");
}

#[test]
fn a_weighted_sum_that_ranks_is_shown() {
    let mut file = literature("k18", &[("solve.evaluations", "20000")]);
    file.spec.task.weight = Some((0..18).map(|j| 1.0 + f64::from(j)).collect());
    let record = true_record(file);
    let page = candidates_table(&record, Colour::Never);
    assert!(page.contains("weighted sq") && !page.contains("sum of sq  "), "{page}");
    let shown: Vec<f64> = record.candidates.iter().map(|c| c.error.objective).collect();
    assert!(shown.is_sorted(), "{shown:?}");
}

#[test]
fn weights_do_not_enter_the_largest_deviation() {
    let set =
        [LARGEST, ("solve.candidates", cases("1", "3")), ("solve.evaluations", cases("30000", "200000"))];
    let plain = literature("k18", &set);
    let mut weighted = literature("k18", &set);
    weighted.spec.task.weight = Some((0..18).map(|j| 1.0 + f64::from(j)).collect());
    assert_eq!(run_on(2, plain).candidates, true_record(weighted).candidates);
}

#[test]
fn a_tolerance_that_least_squares_breaks_is_met_where_a_linkage_meets_it() {
    // Least squares leaves more than 0.034 at a point; 0.0301 is possible.
    let squares = run_on(2, literature("k18", &[]));
    for tolerance in ["0.0302", "0.032"].into_iter().take(cases(1, 2)) {
        assert!(squares.candidates[0].error.max > 0.032);
        for method in ["auto", "least-squares"] {
            let set = [("task.path.tolerance", tolerance), ("solve.method", method)];
            let record = true_record(literature("k18", &set));
            let best = &record.candidates[0];
            assert!(best.accepted, "{tolerance} by {method}: {}", best.error.max);
            assert!(best.error.sum_sq > squares.candidates[0].error.sum_sq);
            let page = candidates_table(&record, Colour::Never);
            assert!(page.contains("Tolerances met"), "{page}");
        }
    }
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn a_tolerance_that_no_linkage_meets_is_said_to_be_missed_where_and_by_how_much() {
    // The least largest error that is known is 0.0300417.
    let record = true_record(literature("k18", &[("task.path.tolerance", "0.03")]));
    assert!(record.candidates.iter().all(|c| !c.accepted));
    let page = candidates_table(&record, Colour::Never);
    let flat = page.split_whitespace().collect::<Vec<_>>().join(" ");
    let missed = flat.split_once("Tolerances not met by ").and_then(|(_, rest)| rest.split(' ').next());
    let missed: f64 = missed.and_then(|text| text.parse().ok()).expect("a number");
    assert!((4.16e-5..4.18e-5).contains(&missed), "{page}");
    assert!(flat.contains("The narrowest band found is 1.0014 times the tolerances."), "{page}");
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn records_repeat_on_any_number_of_threads_and_keep_their_budgets() {
    for set in [LARGEST, ("task.path.tolerance", "0.0302")] {
        let [one, two] = [1, 2].map(|threads| bytes(&run_on(threads, literature("k18", &[set]))));
        assert_eq!(one, two);
        for budget in [1_u64, 7, 100, 2345] {
            for method in ["auto", "least-squares", "genetic", "differential-evolution"] {
                let text = budget.to_string();
                let set = [set, ("solve.evaluations", text.as_str()), ("solve.method", method)];
                let record = true_record(literature("k18", &set));
                let for_picks = record.picks.as_ref().map_or(0, |picks| picks.evaluations);
                assert!(
                    record.evaluations.objective <= budget + for_picks,
                    "{method}, {budget}: {:?}",
                    record.evaluations
                );
            }
        }
    }
}

#[test]
fn population_searches_lessen_the_largest_deviation_too() {
    let least = run_on(2, literature("k18", &[LARGEST])).candidates[0].error.max;
    for method in ["differential-evolution", "genetic"] {
        let set = [LARGEST, ("solve.method", method), ("solve.evaluations", "60000")];
        let record = true_record(literature("k18", &set));
        let best = &record.candidates[0];
        assert!(best.error.objective >= least * (1.0 - 1e-9) && best.error.objective < 10.0 * least);
        // What the search compared is what the referee found.
        let problem = Problem::new(literature("k18", &set).spec).expect("it is one");
        let fitness = PathFitness::new(&problem);
        let start = start_at(&problem, best).expect("it closes");
        let read = fitness.read(&free(fitness.genes().space(start.setting.side), &start.design)).fitness;
        assert!((read.cost - best.error.objective).abs() <= 1e-9 * read.cost, "{read:?}");
    }
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn a_candidate_starts_where_it_stands() {
    let texts = [
        egg("[solve]\nseed = 2\n"),
        egg("[require]\ntype = [\"rocker-crank\"]\n"),
        egg("[design]\nb = 80\nd = [20, 90]\ne = [20, 90]\n"),
        egg("[design]\nground = 70\nground_angle_deg = 0\n"),
        egg("[task.path.timing]\ncrank_deg = [0, 30, 60, 90, 120, 150, 180, 210, 240, 270, 300, 330]\n"),
        egg(
            "[task.path.timing]\ncrank_deg = [0, 30, 60, 90, 120, 150, 180, 210, 240, 270, 300, 330]\noffset = \"ground\"\n",
        ),
    ];
    for text in texts {
        let record = run_on(2, parse(&text));
        let problem = Problem::new(parse(&text).spec).expect("it is one");
        for candidate in &record.candidates {
            let start = start_at(&problem, candidate).expect("it closes");
            let again = judged(&problem, &start).expect("it closes");
            assert_eq!(again.accepted, candidate.accepted);
            let (one, other) = (again.error.sum_sq, candidate.error.sum_sq);
            assert!((one - other).abs() <= 1e-9 * other.max(1e-12), "{one} {other} {text}");
        }
    }
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn convex_programs_and_the_augmented_lagrangian_end_at_the_same_optimum() {
    let (mut fewer, mut cases) = (0, 0);
    for line in [
        "transmission_deg_min = 45",
        "link_ratio_max = 2.5",
        "pivots_in = [-60, -60, 60, 0]",
        "footprint_in = [-90, -90, 90, 90]",
    ] {
        for timing in
            ["", "[task.path.timing]\ncrank_deg = [0, 30, 60, 90, 120, 150, 180, 210, 240, 270, 300, 330]\n"]
        {
            let text = egg(&format!("{timing}[require]\ntype = [\"crank-rocker\"]\n{line}\n"));
            let record = run_on(2, parse(&text));
            let best = &record.candidates[0];
            let problem = Problem::new(parse(&text).spec).expect("it is one");
            let budget = Budget { cancel: &AtomicBool::new(false), deadline: None };
            let mut start = start_at(&problem, best).expect("it closes");
            for (i, value) in start.design.iter_mut().enumerate().take(9) {
                *value *= 1.0 + 0.004 * ((i % 3) as f64 - 1.0);
            }
            let context = Context::new(&problem, &budget);
            let lagrangian = polish(context, start.clone(), LONG_FIT, 100_000);
            let convex = finish(context, &start, 100_000);
            let [one, other] = [&lagrangian, &convex]
                .map(|fit| judged(&problem, fit.end.as_ref().expect("it ended")).expect("it closes"));
            assert!(other.accepted, "{text}");
            assert!(other.error.sum_sq <= one.error.sum_sq.max(best.error.sum_sq) * (1.0 + 1e-6), "{line}");
            cases += 1;
            fewer += usize::from(convex.evaluations < lagrangian.evaluations);
        }
    }
    assert!(2 * fewer > cases, "{fewer} of {cases}");
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn thousands_of_points_have_a_least_largest_error_too() {
    let points = |n: usize| -> String {
        let list: Vec<String> = (0..n)
            .map(|i| {
                let t = std::f64::consts::TAU * i as f64 / n as f64;
                format!("[{}, {}]", 3.0 * t.cos() + 0.4 * (2.0 * t).sin(), t.sin())
            })
            .collect();
        let angles: Vec<String> = (0..n).map(|i| format!("{}", 360.0 * i as f64 / n as f64)).collect();
        format!(
            "format = 1\n[task.path]\npoints = [{}]\nclosed = true\n[task.path.timing]\ncrank_deg = [{}]\n\
             [solve]\nobjective = \"max-deviation\"\nevaluations = 6000\n",
            list.join(", "),
            angles.join(", ")
        )
    };
    // Finer samples of one curve: the largest errors agree to the square of the spacing.
    let [coarse, fine] = [60, 600].map(|n| {
        let record = true_record(parse(&points(n)));
        let list = errors(&record, &record.candidates[0]);
        assert!(list.iter().filter(|e| **e >= list[0] * (1.0 - 1e-5)).count() >= 4);
        record.candidates[0].error.max
    });
    assert!((coarse - fine).abs() <= 5e-3 * fine, "{coarse} {fine}");
}
