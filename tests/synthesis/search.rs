//! The main job on the published problems: what is found, from which seeds, and that nothing but the problem
//! and the seed decides it.

use crate::common::{bytes, literature, load, parse, root, run_on};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::LinkageType;
use linkwright::internals::record::{Reason, Record};

fn best(record: &Record) -> f64 {
    record.candidates.first().filter(|c| c.accepted).map_or(f64::INFINITY, |c| c.error.sum_sq)
}

/// The best known sum of squares, one seed after the other.
fn finds_from_every_seed(name: &str, seeds: std::ops::Range<u64>, at_most: f64) {
    for seed in seeds {
        let seed_text = seed.to_string();
        let set = [("solve.seed", seed_text.as_str()), ("solve.candidates", "1")];
        let record = run_on(2, literature(name, &set));
        assert!(best(&record) <= at_most, "{name}, seed {seed}: {} > {at_most}", best(&record));
        assert_eq!(verify(&record).expect("the problem is one"), Vec::new(), "{name}, seed {seed}");
    }
}

#[test]
fn the_eighteen_point_problem_is_solved_from_twenty_seeds() {
    finds_from_every_seed("k18", 1..21, 0.009_028_884_7);
    finds_from_every_seed("k18b", 1..6, 0.009_911_927_5);
}

#[test]
fn the_other_published_problems_are_solved_from_five_seeds() {
    finds_from_every_seed("e5", 1..6, 7.41576e-7);
    finds_from_every_seed("a6", 1..6, 2.58036);
    finds_from_every_seed("l10", 1..6, 4.019_922e-4);
    finds_from_every_seed("p12", 1..6, 7.6090e-5);
    finds_from_every_seed("v6", 1..6, 1e-18);
}

/// On a sparse target of few points a search for one answer ends after half of a batch of 8 rounds if these are enough: of
/// its first batch all rounds are independent of others, of half the second 3.
#[test]
fn half_of_the_second_batch_is_enough_where_the_best_answer_has_come_often() {
    let starts = |candidates: &str| {
        let set = [("solve.candidates", candidates)];
        let record = run_on(2, literature("p12", &set));
        assert!(best(&record) <= 7.609e-5 && record.termination.reason == Reason::Converged);
        record.repeats.expect("they are counted").starts
    };
    assert_eq!(starts("1"), 11);
    assert!(starts("3") >= 14, "further answers are looked for in whole batches");
}

#[test]
fn the_answer_to_eighteen_points_is_a_crank_rocker_without_defects() {
    let record = run_on(2, literature("k18", &[]));
    let first = &record.candidates[0];
    assert_eq!(first.linkage_type.expect("a type"), LinkageType::CrankRocker);
    assert!(first.accepted && first.defects.is_empty());
    assert_eq!(record.termination.reason, Reason::Converged);
    assert!(record.termination.reproducible);
    for (rank, candidate) in (1..).zip(&record.candidates) {
        assert_eq!(candidate.rank, rank);
        assert!(candidate.error.objective >= first.error.objective);
    }
}

/// Targets of so many points are compared with the curve on all threads within one evaluation.
#[test]
fn thousands_of_points_give_the_same_bytes_on_any_number_of_threads() {
    let points: Vec<[f64; 2]> = (0..4200)
        .map(|j| {
            let t = std::f64::consts::TAU * f64::from(j) / 4200.0;
            [3.0 * t.cos() + 0.3 * (2.0 * t).sin(), 1.5 * t.sin()]
        })
        .collect();
    let text = format!(
        "format = 1\n[task.path]\npoints = {points:?}\nclosed = true\n[solve]\nmethod = \"genetic\"\n\
         evaluations = 40\ncandidates = 1\nadvice = false\n[solve.genetic]\npopulation = 20\nelites = 2\n"
    );
    assert_eq!(bytes(&run_on(1, parse(&text))), bytes(&run_on(2, parse(&text))));
}

#[test]
fn one_and_two_threads_write_the_same_bytes() {
    let cases = [
        ("k18", "auto"),
        ("k18", "differential-evolution"),
        ("k18", "genetic"),
        ("l10", "auto"),
        ("l10", "differential-evolution"),
        ("a6b", "least-squares"),
    ];
    for (name, method) in cases {
        let set = [("solve.method", method), ("solve.evaluations", "20000")];
        let [one, two] = [1, 2].map(|threads| bytes(&run_on(threads, literature(name, &set))));
        assert_eq!(one, two, "{name} by {method}");
    }
}

#[test]
fn a_generation_that_is_evaluated_in_parallel_writes_the_same_bytes() {
    // 400 individuals of 180 points cost more than the threshold below which threads are left alone.
    let points: Vec<String> = (0..180)
        .map(|i| {
            let t = (2.0 * f64::from(i)).to_radians();
            format!("[{}, {}]", 3.0 * t.cos() + 0.4 * (2.0 * t).sin(), t.sin())
        })
        .collect();
    let angles: Vec<String> = (0..180).map(|i| (2 * i).to_string()).collect();
    let text = format!(
        "format = 1\n[task.path]\npoints = [{}]\nclosed = true\n[task.path.timing]\ncrank_deg = [{}]\n\
         [solve]\nmethod = \"genetic\"\nevaluations = 8000\n[solve.genetic]\npopulation = 400\n",
        points.join(", "),
        angles.join(", ")
    );
    let [one, two] = [1, 2].map(|threads| bytes(&run_on(threads, parse(&text))));
    assert_eq!(one, two);
}

#[test]
fn what_is_expected_changes_nothing_in_the_record() {
    let path = root().join("problems/literature/k18.toml");
    let text = std::fs::read_to_string(&path).expect("it is there");
    let without = &text[..text.find("[expect]").expect("it expects something")];
    let with = run_on(2, parse(&text));
    assert_eq!(bytes(&with), bytes(&run_on(2, parse(without))));
}

#[test]
fn the_seed_decides_the_digits_and_the_name_does_not() {
    let short = |seed: &str| {
        let set =
            [("solve.seed", seed), ("solve.method", "differential-evolution"), ("solve.evaluations", "3000")];
        run_on(1, literature("k18", &set))
    };
    assert_eq!(bytes(&short("7")), bytes(&short("7")));
    assert_ne!(short("7").candidates, short("8").candidates);
    let renamed = run_on(1, literature("k18", &[("name", "other")]));
    let plain = run_on(1, literature("k18", &[]));
    assert_eq!(renamed.problem.digest, plain.problem.digest);
    assert_eq!(renamed.candidates, plain.candidates);
}

#[test]
fn a_budget_of_evaluations_is_kept() {
    for method in ["differential-evolution", "genetic"] {
        let set = [("solve.method", method), ("solve.evaluations", "12345")];
        let record = run_on(2, literature("k18", &set));
        assert_eq!(record.evaluations.objective, 12345, "{method}");
        assert_eq!(record.termination.reason, Reason::EvaluationLimit);
    }
    for method in ["auto", "least-squares"] {
        for budget in [1u64, 7, 100, 2345] {
            let budget_text = budget.to_string();
            let tight = [("task.path.tolerance", "0.0001"), ("solve.evaluations", budget_text.as_str())];
            let set = [tight[0], tight[1], ("solve.method", method)];
            let record = run_on(2, literature("k18", &set));
            assert!(record.evaluations.objective <= budget, "{method}, {budget}: {:?}", record.evaluations);
        }
    }
}

/// The README's batch of all examples says daily that each has an accepted answer.
#[test]
#[ignore = "slow: .ci/run runs it"]
fn every_example_has_an_accepted_answer_that_verifies() {
    for path in
        crate::common::shipped("toml").iter().filter(|p| p.parent().is_some_and(|d| d.ends_with("examples")))
    {
        let record = run_on(2, load(path, &[]));
        assert!(best(&record).is_finite(), "{}", path.display());
        assert_eq!(verify(&record).expect("the problem is one"), Vec::new(), "{}", path.display());
    }
}

#[test]
fn candidates_are_distinct_curves() {
    let record = run_on(2, literature("k18", &[("solve.candidates", "5")]));
    assert!(record.candidates.len() >= 3);
    for (i, one) in record.candidates.iter().enumerate() {
        for other in &record.candidates[..i] {
            let apart = one.crank_deg.iter().zip(&other.crank_deg).any(|(a, b)| {
                let at = |c: &linkwright::internals::record::Candidate, deg: f64| {
                    c.linkage
                        .four_bar()
                        .expect("a four-bar")
                        .position(deg.to_radians())
                        .joints()
                        .map(|j| j.coupler_point)
                };
                match (at(one, *a), at(other, *b)) {
                    (Some(p), Some(q)) => (p - q).norm() > 1e-3,
                    _ => true,
                }
            });
            assert!(apart, "candidates {} and {} draw the same points", one.rank, other.rank);
        }
    }
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn impossible_requirements_end_with_the_nearest_and_why() {
    let set = [("task.path.tolerance", "0.001"), ("solve.evaluations", "30000")];
    let record = run_on(2, literature("k18", &set));
    assert!(!record.candidates.is_empty());
    for candidate in &record.candidates {
        assert!(!candidate.accepted);
        assert!(candidate.requirements.iter().any(|r| !r.met) || !candidate.defects.is_empty());
    }
    assert!(record.method.used.contains(&"differential-evolution".to_string()), "auto tried both ways");
    assert_eq!(verify(&record).expect("the problem is one"), Vec::new());
}

/// The value that a share of a sorted list lies below.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    0.5 * (values[(values.len() - 1) / 2] + values[values.len() / 2])
}

#[test]
fn population_searches_beat_uniform_sampling_tenfold_at_equal_evaluations() {
    use linkwright::internals::synthesis::population::{Population, search};
    use linkwright::internals::synthesis::{Budget, Context};
    use linkwright::internals::task::Problem;
    use std::sync::atomic::AtomicBool;
    const EVALUATIONS: u64 = 20_000;
    let median_of = |which: Population| {
        let sums = (1..=20).map(|seed| {
            let seed = format!("{seed}");
            let file = literature("k18", &[("solve.seed", &seed)]);
            let problem = Problem::new(file.spec).expect("it is one");
            let budget = Budget { cancel: &AtomicBool::new(false), deadline: None };
            let (end, _) = search(Context::new(&problem, &budget), which, EVALUATIONS).expect("it runs");
            assert!(end.evaluations.objective <= EVALUATIONS);
            end.candidates.iter().filter(|c| c.accepted).map(|c| c.error.sum_sq).fold(f64::INFINITY, f64::min)
        });
        median(sums.collect())
    };
    let uniform = median_of(Population::UniformSampling);
    for which in [Population::DifferentialEvolution, Population::Genetic] {
        let found = median_of(which);
        assert!(10.0 * found <= uniform, "{}: {found:e}, uniform sampling {uniform:e}", which.name());
    }
}

#[test]
fn a_problem_with_everything_fixed_has_the_one_answer_that_it_leaves() {
    let fixed = "format = 1\n[task.path]\npoints = [[0, 4.9], [1, 4.8], [2, 4.6]]\n[task.path.timing]\n\
                 crank_deg = [90, 60, 30]\noffset = \"fixed\"\n[design]\nA = [0, 0]\nB = [2, 0]\na = 1\nb = 2.5\nc = 2.5\n\
                 coupler_x = 5\ncoupler_y = 0\n[solve]\nmethod = \"METHOD\"\n";
    for method in ["auto", "genetic", "differential-evolution", "least-squares"] {
        let record = run_on(1, parse(&fixed.replace("METHOD", method)));
        let linkage = record.candidates[0].linkage.four_bar().expect("a four-bar");
        assert_eq!((linkage.crank(), linkage.coupler(), linkage.follower()), (1.0, 2.5, 2.5), "{method}");
        assert_eq!(verify(&record).expect("the problem is one"), Vec::new());
    }
}
