//! The population searches in reduced variables: what is found, how much cheaper, and when they are refused.

use crate::common::{bytes, literature, parse, run_on};
use linkwright::internals::files::problem_file;
use linkwright::internals::files::problem_file::ProblemFile;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::four_bar::mobility::wrapped;
use linkwright::internals::mechanism::{AssemblyMode, CouplerSide};
use linkwright::internals::numbers::arithmetic::streams::stream;
use linkwright::internals::numbers::optimise::population::{PopulationProblem, draw_uniform};
use linkwright::internals::record::Record;
use linkwright::internals::record::digest::digest;
use linkwright::internals::synthesis::reduced_fitness::{ReducedFitness, forms};
use linkwright::internals::task::Problem;
use linkwright::internals::task::forms::design_space::{DESIGN, Design, DesignSpace, Shape};
use linkwright::internals::task::forms::fitness::PathFitness;
use linkwright::internals::task::forms::genes::DesignFitness;
use linkwright::internals::task::forms::projection::{ProjectedFit, Projection};
use linkwright::internals::task::forms::reduced::{Refusal, refusal};
use linkwright::internals::task::spec::Variables;
use std::f64::consts::TAU;

/// Returns the numbers of a design that are not fixed, angles within half a turn.
pub fn free(space: &DesignSpace, x: &Design) -> Vec<f64> {
    let free = (0..DESIGN).filter(|&i| space.bounds()[i].0 < space.bounds()[i].1);
    let within = |(i, (low, high)): (usize, (f64, f64))| {
        let value = if space.is_angle(i) && high - low >= TAU { wrapped(x[i]) } else { x[i] };
        value.max(low).min(high)
    };
    free.zip(space.free_box()).map(within).collect()
}

const DE: &str = "differential-evolution";

fn asked(name: &str, method: &str, variables: &str, evaluations: u64, seed: u64) -> ProblemFile {
    let (evaluations, seed) = (evaluations.to_string(), seed.to_string());
    let set = [
        ("solve.method", method),
        ("solve.variables", variables),
        ("solve.evaluations", evaluations.as_str()),
        ("solve.seed", seed.as_str()),
        ("solve.candidates", "1"),
    ];
    literature(name, &set)
}

fn best(record: &Record) -> f64 {
    record.candidates.first().filter(|c| c.accepted).map_or(f64::INFINITY, |c| c.error.sum_sq)
}

fn verified(record: &Record, what: &str) {
    assert_eq!(verify(record).expect("the problem is one"), Vec::new(), "{what}");
}

#[test]
fn differential_evolution_solves_the_eighteen_points_within_ten_thousand_evaluations() {
    let mut hits = 0;
    for seed in 1..=10 {
        let record = run_on(2, asked("k18", DE, "reduced", 10_000, seed));
        assert!(record.evaluations.objective <= 10_000);
        verified(&record, &format!("seed {seed}"));
        hits += u32::from(best(&record) <= 0.009_028_884_7 * 1.001);
    }
    assert!(hits >= 8, "{hits} of 10");
}

#[test]
fn reduced_variables_are_better_than_nine_at_equal_evaluations() {
    for (name, method) in
        [("k18", "genetic"), ("k18", DE), ("a6", "genetic"), ("e5", "genetic"), ("l10", "genetic")]
    {
        let median = |variables: &str| {
            let mut sums: Vec<f64> =
                (1..=5).map(|seed| best(&run_on(2, asked(name, method, variables, 10_000, seed)))).collect();
            sums.sort_by(f64::total_cmp);
            sums[2]
        };
        let (reduced, nine) = (median("reduced"), median("nine"));
        assert!(reduced < 0.5 * nine, "{name} by {method}: reduced {reduced:e}, nine {nine:e}");
    }
}

#[test]
fn free_timing_works_in_reduced_variables() {
    for (name, method) in [("k18f", DE), ("v6", DE), ("v6", "genetic")] {
        for seed in 1..=3 {
            let record = run_on(2, asked(name, method, "reduced", 10_000, seed));
            let nine = run_on(2, asked(name, method, "nine", 10_000, seed));
            assert!(best(&record).is_finite(), "{name} by {method}, seed {seed}: nothing accepted");
            assert!(best(&record) < best(&nine), "{name} by {method}, seed {seed}: {:e}", best(&record));
            verified(&record, name);
        }
    }
}

#[test]
fn rocking_cranks_closed_targets_and_the_largest_deviation_are_searched_too() {
    let rocking = [("require.type", "[\"double-rocker\", \"triple-rocker\", \"rocker-crank\"]")];
    let any = [rocking[0], ("require.branch", "any"), ("task.path.closed", "true")];
    let deviation = [("solve.objective", "max-deviation"), ("task.path.closed", "true")];
    for more in [&rocking[..], &any[..], &deviation[..]] {
        let mut set =
            vec![("solve.method", DE), ("solve.variables", "reduced"), ("solve.evaluations", "4000")];
        set.extend(more);
        let record = run_on(2, literature("v6", &set));
        assert!(record.candidates.iter().any(|c| c.accepted), "{more:?}");
        verified(&record, &format!("{more:?}"));
    }
}

#[test]
fn one_and_two_threads_write_the_same_bytes_in_reduced_variables() {
    for (name, method) in
        [("k18", DE), ("k18", "genetic"), ("a6", "genetic"), ("v6", "genetic"), ("k18f", DE)]
    {
        let [one, two] = [1, 2].map(|threads| {
            let mut file = asked(name, method, "reduced", 5000, 3);
            // Large enough that generations are shared among threads.
            file.spec.solve.genetic.population = 1000;
            bytes(&run_on(threads, file))
        });
        assert_eq!(one, two, "{name} by {method}");
    }
}

#[test]
fn a_budget_is_kept_to_the_evaluation() {
    for budget in [1, 3, 4321] {
        let record = run_on(1, asked("k18", DE, "reduced", budget, 1));
        assert_eq!(record.evaluations.objective, budget);
    }
}

#[test]
fn the_cost_is_that_of_the_linear_fit_and_of_the_nine_parameters_at_its_shape() {
    let problem = Problem::new(asked("k18", DE, "reduced", 1, 1).spec).expect("it is one");
    let forms = forms(&problem);
    let (reduced, nine) = (ReducedFitness::new(&problem, &forms), PathFitness::new(&problem));
    let mut draws = stream(11, 0);
    let mut x = vec![0.0; reduced.bounds().len()];
    assert_eq!(x.len(), 5);
    let mut feasible = 0;
    for _ in 0..20_000 {
        draw_uniform(&mut draws, reduced.bounds(), &mut x);
        let fitness = reduced.evaluate(&x);
        if !fitness.is_feasible() || x[..3].iter().any(|v| v.abs() > 20f64.ln()) {
            continue;
        }
        feasible += 1;
        let (direction, assembly) = match x[4] as usize {
            0 => (0, AssemblyMode::Plus),
            1 => (0, AssemblyMode::Minus),
            2 => (1, AssemblyMode::Plus),
            _ => (1, AssemblyMode::Minus),
        };
        let form: &Projection = &forms[direction];
        let solution =
            ProjectedFit::new(form, assembly).solution(&[x[0], x[1], x[2], x[3]]).expect("it closes");
        assert!((fitness.cost - solution.cost).abs() <= 1e-9 * (1e-3 + solution.cost));
        // The nine parameters take the best of both assemblies and directions.
        let space = nine.genes().space(CouplerSide::Plus);
        let shape: Shape = solution.shape;
        let genes = free(space, &space.design(&shape, solution.offset));
        let read = nine.read(&genes).fitness;
        assert!(read.is_feasible() && read.cost <= fitness.cost * (1.0 + 1e-9));
    }
    assert!(feasible > 50, "only {feasible}");
}

#[test]
fn the_variables_arrive_are_recorded_and_decide_the_digest() {
    let text = "format = 1\n[task.path]\npoints = [[0, 0], [3, 4], [5, 5]]\n[solve]\nmethod = \"genetic\"\n";
    let silent = parse(text);
    assert_eq!(silent.spec.solve.variables, Variables::Nine);
    let nine = parse(&format!("{text}variables = \"nine\"\n"));
    let reduced = parse(&format!("{text}variables = \"reduced\"\nevaluations = 200\n"));
    assert_eq!(reduced.spec.solve.variables, Variables::Reduced);
    let digest = |file: &ProblemFile| digest(&file.spec).expect("it is data");
    assert_eq!(digest(&silent), digest(&nine));
    assert_ne!(digest(&silent), digest(&reduced));
    let written = serde_json::to_string(&reduced.spec).expect("it is data");
    assert!(written.contains("\"variables\":\"reduced\""));
    assert_eq!(
        serde_json::from_str::<linkwright::internals::task::spec::ProblemSpec>(&written).expect("it is one"),
        reduced.spec
    );
    let before = written.replace("\"variables\":\"reduced\",", "");
    let old: linkwright::internals::task::spec::ProblemSpec =
        serde_json::from_str(&before).expect("older records are read");
    assert_eq!(old.solve.variables, Variables::Nine);
    let record = run_on(1, reduced);
    assert_eq!(record.problem.resolved.solve.variables, Variables::Reduced);
    verified(&record, "as recorded");
}

#[test]
fn the_other_methods_do_not_read_the_variables_and_say_so() {
    for method in ["auto", "least-squares"] {
        let text = format!(
            "format = 1\n[task.path]\npoints = [[0, 0], [3, 4]]\n[solve]\nmethod = \"{method}\"\nvariables = \"reduced\"\n"
        );
        let file = parse(&text);
        assert_eq!(file.warnings.len(), 1);
        assert!(file.warnings[0].message.contains(method), "{}", file.warnings[0].message);
    }
}

#[test]
fn what_a_linear_fit_cannot_hold_is_refused_and_what_it_can_is_not() {
    let timed = "[task.path.timing]\ncrank_deg = [0, 30, 70, 90]\noffset = \"OFFSET\"\n";
    let refused = |timing: &str, design: &str| -> Option<String> {
        let text = format!(
            "format = 1\n[task.path]\npoints = [[0, 0], [3, 4], [6, 5], [8, 3]]\n{timing}[design]\n{design}\n\
             [solve]\nmethod = \"genetic\"\nvariables = \"reduced\"\nevaluations = 2000\n"
        );
        match problem_file::parse("test.toml", &text, None, &[]) {
            Ok(file) => {
                let record = run_on(1, file);
                verified(&record, design);
                None
            }
            Err(diagnostic) => {
                assert!(diagnostic.help.as_deref().is_some_and(|help| help.contains("nine")));
                Some(diagnostic.message)
            }
        }
    };
    let [free, fixed, ground] = ["free", "fixed", "ground"].map(|offset| timed.replace("OFFSET", offset));
    for (timing, design, key) in [
        ("", "coupler_y = 0", "coupler_y"),
        ("", "a = 3", "hold a "),
        ("", "ground = 8", "ground"),
        ("", "A = [0, [-5, 5]]", "hold A "),
        (free.as_str(), "ground = 8", "ground"),
        (free.as_str(), "a = 2\nb = 8", "hold b "),
        (fixed.as_str(), "d = 4", "hold d "),
    ] {
        let message = refused(timing, design).unwrap_or_default();
        assert!(message.contains(key), "{design}: {message}");
    }
    for (timing, design) in [
        ("", "A = [0, -5]"),
        ("", "A = [0, -5]\nB = [8, -5]\na = 3"),
        ("", "ground = 8\nground_angle_deg = 10\nc = 6"),
        (free.as_str(), "a = 2"),
        (fixed.as_str(), "ground = 8"),
        (ground.as_str(), "ground = 8\na = 2\nb = 7"),
        (free.as_str(), "A = [0, -5]\nB = [8, -5]\na = 3"),
    ] {
        assert_eq!(refused(timing, design), None, "{design}");
    }
}

#[test]
fn a_caller_without_a_file_gets_the_refusal_as_an_error() {
    use linkwright::internals::synthesis::{Budget, Context, plan};
    let mut spec = asked("k18", DE, "nine", 100, 1).spec;
    spec.solve.variables = Variables::Reduced;
    spec.design.coupler_x = Some(linkwright::internals::task::spec::Limits(0.5, 0.5));
    let problem = Problem::new(spec).expect("it is one");
    assert_eq!(refusal(&problem), Some(Refusal::Fixed { key: "coupler_x" }));
    let cancel = std::sync::atomic::AtomicBool::new(false);
    let budget = Budget { cancel: &cancel, deadline: None };
    let error = plan::search(Context::new(&problem, &budget)).expect_err("there is no such form");
    assert!(error.to_string().contains("coupler_x"));
}
