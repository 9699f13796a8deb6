//! Population searches of poses and functions: their fitness is what the judge measures, and what they find is true.

use crate::common::parse;
use crate::common::thorough::cases;
use crate::motion::{assert_true, problem, solved, wrapped};
use crate::poses::{taken, wide};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use linkwright::internals::numbers::optimise::population::PopulationProblem;
use linkwright::internals::synthesis::multistart::{judged, settle_positions};
use linkwright::internals::synthesis::{Budget, Context as SearchContext};
use linkwright::internals::task::forms::body_fitness::BodyFitness;
use linkwright::internals::task::forms::design_space::Shape;
use linkwright::internals::task::forms::genes::DesignFitness;
use linkwright::internals::task::forms::start::{AS_WRITTEN, Start};
use linkwright::spec::{Method, Objective, ProblemSpec};
use linkwright::{Problem, load_problem};
use std::path::Path;
use std::sync::atomic::AtomicBool;

const FUNCTION: &str = "format = 1\n[task.function]\nof = \"x^2\"\nover = [0, 1]\ninput_range_deg = 70\noutput_range_deg = 50\n\
                        samples = 13\n";

/// Draws genes until the design closes at every target; `None` after many.
fn closed(
    fitness: &BodyFitness<'_>,
    draws: &mut linkwright::internals::numbers::arithmetic::streams::Stream,
) -> Option<Vec<f64>> {
    (0..20_000).find_map(|_| {
        let genes: Vec<f64> = fitness.bounds().iter().map(|&(low, high)| uniform(draws, low, high)).collect();
        let reading = fitness.read(&genes);
        (reading.fitness.violation < 1.0 && reading.fitness.cost.is_finite()).then_some(genes)
    })
}

#[test]
fn the_fitness_of_functions_and_timed_poses_is_the_objective_of_the_judge() {
    let timed = "format = 1\n[task.motion]\nposes = [[0, 0, 0], [20, 10, 15], [40, 12], [60, 8, 30]]\n\
                 [task.motion.timing]\ncrank_deg = [0, 20, 35, 60]\noffset = ";
    let texts = [
        FUNCTION.to_owned(),
        format!("{FUNCTION}input_offset = \"ground\"\noutput_offset = \"ground\"\nsense = \"opposite\"\n"),
        format!("{timed}\"free\"\n"),
        format!("{timed}\"fixed\"\n"),
        format!("{timed}\"ground\"\n"),
    ];
    for (text, objective) in
        texts.iter().flat_map(|text| [Objective::SumOfSquares, Objective::MaxDeviation].map(|o| (text, o)))
    {
        let mut spec = parse(text).spec;
        spec.solve.objective = objective;
        let problem = Problem::new(spec).expect("a problem");
        let fitness = BodyFitness::new(&problem).expect("it has angles");
        let draws = &mut stream(141, 0);
        for _ in 0..20 {
            let genes = closed(&fitness, draws).expect("some close");
            let reading = fitness.read(&genes);
            if reading.fitness.violation >= 1e-3 {
                continue;
            }
            let design = fitness.genes().space(reading.setting.side).from_free(&genes);
            let start = Start { design, setting: reading.setting, positions: Vec::new(), scales: AS_WRITTEN };
            let Some(candidate) = judged(&problem, &start) else { continue };
            let (cost, objective) = (reading.fitness.cost, candidate.error.objective);
            assert!((cost - objective).abs() <= 1e-7 * objective, "{text}: {cost} {objective}");
        }
    }
}

#[test]
fn the_positions_of_the_fitness_lead_back_to_the_linkage_that_took_the_poses() {
    let draws = &mut stream(142, 0);
    let (mut exact, cases) = (0, 30);
    for _ in 0..cases {
        let taken = taken(draws, 6, 0.0);
        let size = taken.poses.iter().map(|(p, _)| (p - taken.poses[0].0).norm()).fold(0.0, f64::max);
        let far = 6.0 * (size + taken.linkage.longest_link());
        let lines = format!("{}[require]\nlink_ratio_max = 100\n", wide(taken.poses[0].0, far));
        let problem = Problem::new(problem(&taken.poses, &lines)).expect("a problem");
        let fitness = BodyFitness::new(&problem).expect("it has angles");
        let space = fitness.genes().space(taken.linkage.side());
        let shape = Shape::from(&taken.linkage);
        // Every number of the design is free here.
        let design = space.design(&shape, wrapped(taken.frame));
        let reading = fitness.read(&design);
        let positions = fitness.positions(&shape, wrapped(taken.frame), &reading).expect("it closes");
        let (cancel, setting) = (AtomicBool::new(false), reading.setting);
        let budget = Budget::new(&cancel, None);
        let context = SearchContext::new(&problem, &budget);
        let Some(positions) = settle_positions(context, &design, setting, positions) else { continue };
        let start = Start { design, setting, positions, scales: AS_WRITTEN };
        let candidate = judged(&problem, &start).expect("it closes");
        exact += usize::from(candidate.error.objective.sqrt() < 1e-6 * size);
    }
    assert!(exact >= 27, "{exact} of {cases}");
}

#[test]
fn populations_solve_functions_and_poses_and_their_records_are_true() {
    let of = |file: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems").join(file);
        load_problem(&path, &[]).expect("a problem")
    };
    let run = |mut spec: ProblemSpec, method: Method, evaluations: u64| {
        spec.solve.method = method;
        spec.solve.evaluations = evaluations;
        spec.solve.candidates = 1;
        spec.solve.advice = false;
        solved(spec)
    };
    let methods = [Method::DifferentialEvolution, Method::Genetic];
    for method in methods.into_iter().take(cases(1, 2)) {
        let file = of("function/square.toml");
        let record = run(file.spec, method, 20_000);
        assert_eq!(verify(&record).expect("a record"), []);
        assert_eq!(record.method.used, [method.name()]);
        let best = &record.candidates[0];
        assert!(best.accepted && best.error.rms < 1.0, "{method:?}: {}", best.error.rms);
        let file = of("motion/crank-rocker-12.toml");
        let record = run(file.spec, method, 20_000);
        assert_true(&record);
        let best = &record.candidates[0];
        // A linkage that is drawn is off by several sizes.
        assert!(best.error.rms_over_size < 0.5, "{method:?}: {}", best.error.rms_over_size);
        let file = of("motion/crank-rocker-timed.toml");
        let record = run(file.spec, method, 20_000);
        assert_true(&record);
        let part = record.candidates[0].error.rms_over_size;
        assert!(part < 0.5, "{method:?}: {part}");
    }
}
