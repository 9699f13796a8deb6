//! The suite: published vectors by our referee, figures of many seeds, the command, what it writes.

use crate::common::thorough::cases;
use crate::common::{job, literature, load, parse, root};
use assert_cmd::Command;
use linkwright::internals::app::job::run::{Context, run};
use linkwright::internals::app::suite::published;
use linkwright::internals::app::suite::{Options, Step, suite};
use linkwright::internals::files::problem_file::{ProblemFile, Published};
use linkwright::internals::mechanism::AssemblyMode;
use linkwright::internals::record;
use linkwright::internals::record::suite::{Known, Suite};
use linkwright::internals::report::Colour;
use linkwright::internals::report::suite::{suite_markdown, suite_text};
use linkwright::internals::task::Problem;
use linkwright::internals::task::spec::{CertifySpec, Method};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::AtomicBool;
use tempfile::TempDir;

const PROBLEMS: [&str; 10] = ["a6", "a6b", "e5", "e5-free", "k18", "k18b", "k18f", "l10", "p12", "v6"];

#[test]
fn every_published_vector_gives_its_recomputed_sum_by_our_referee() {
    let mut seen = 0;
    for name in PROBLEMS {
        let file = literature(name, &[]);
        let problem = Problem::new(file.spec).expect("a task");
        for entry in file.expect.expect("it expects something").published {
            let candidate = published::evaluate(&problem, &entry).expect("it closes at every point");
            let (got, wanted) =
                (candidate.error.sum_sq, entry.recomputed_sum_sq.expect("every shipped vector has one"));
            // Ten digits are stored. Coordinates near 60 are good to 1e-14, so that an exact answer's sum is
            // rounding only.
            let slack = 1e-9 * wanted + 1e-14 * wanted.sqrt() * 60.0f64.sqrt();
            let same = (got - wanted).abs() <= slack || (wanted < 1e-15 && got < 1e-18);
            assert!(same, "{name}, {}: {got:e} for {wanted:e}", entry.source);
            seen += 1;
        }
    }
    assert_eq!(seen, 17);
}

#[test]
fn a_published_vector_that_cannot_be_evaluated_has_no_figure() {
    let file = literature("e5", &[]);
    let problem = Problem::new(file.spec).expect("a task");
    let good = file.expect.expect("it expects something").published.remove(3);
    let with = |vector: &[f64]| Published { vector: vector.to_vec(), ..good.clone() };
    assert!(published::evaluate(&problem, &good).is_some());
    assert!(published::evaluate(&problem, &with(&[])).is_none(), "no vector");
    let mut negative = good.vector.clone();
    negative[1] = -2.0;
    assert!(published::evaluate(&problem, &with(&negative)).is_none(), "a negative crank");
    let mut open = good.vector.clone();
    open[0] = 40.0;
    assert!(published::evaluate(&problem, &with(&open)).is_none(), "the ground is longer than all the rest");
}

#[test]
fn without_a_published_assembly_the_better_one_counts() {
    let file = literature("e5", &[]);
    let problem = Problem::new(file.spec).expect("a task");
    let entry = file.expect.expect("it expects something").published.remove(3);
    let sum = |t1: Option<AssemblyMode>| {
        published::evaluate(&problem, &Published { t1, ..entry.clone() }).expect("it closes").error.sum_sq
    };
    let (plus, minus) = (sum(Some(AssemblyMode::Plus)), sum(Some(AssemblyMode::Minus)));
    assert!(plus < 1e-5 && minus > 1.0, "{plus:e}, {minus:e}");
    assert_eq!(sum(None), plus);
}

fn figures(problems: &[ProblemFile], seeds: u64) -> Suite {
    let options = Options { seeds, ..Options::default() };
    suite(problems, &options, &AtomicBool::new(false), &|_| {}).expect("it runs")
}

/// The same without the times.
fn timeless(mut suite: Suite) -> Suite {
    for problem in &mut suite.problems {
        for method in std::iter::once(&mut problem.search).chain(&mut problem.populations) {
            (method.summary.median_search_s, method.summary.worst_search_s) = (None, None);
            method.runs.iter_mut().for_each(|run| run.search_s = 0.0);
        }
    }
    suite
}

#[test]
fn a_suite_holds_what_each_run_by_itself_gives() {
    let files = [literature("e5", &[])];
    let figures = timeless(figures(&files, 3));
    assert!(figures.complete && figures.is_accepted());
    let problem = &figures.problems[0];
    assert_eq!((problem.points, problem.search.method, problem.search.runs.len()), (5, Method::Auto, 3));
    assert_eq!((problem.search.summary.hits, problem.search.summary.hits_of_best_known), (3, 3));
    assert_eq!(problem.smaller_than_best_known, None);
    for entry in &problem.search.runs {
        let seed = entry.seed.to_string();
        let file = literature("e5", &[("solve.seed", &seed), ("solve.candidates", "1")]);
        let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
        let record: record::Record = run(&job(file), &context).expect("it runs").record;
        let first = &record.candidates[0];
        assert_eq!((entry.sum_sq, entry.accepted), (Some(first.error.sum_sq), first.accepted));
        assert_eq!(entry.to_curve_sum_sq, Some(first.error.to_curve.sum_sq));
        assert!(entry.two_sided.is_some() && entry.two_sided == first.error.two_sided);
        assert_eq!(
            (entry.evaluations, entry.reason),
            (record.evaluations.objective, record.termination.reason)
        );
    }
    let mut evaluations: Vec<u64> = problem.search.runs.iter().map(|run| run.evaluations).collect();
    evaluations.sort_unstable();
    let methods: Vec<Method> = problem.populations.iter().map(|p| p.method).collect();
    assert_eq!(methods, [Method::Genetic, Method::DifferentialEvolution]);
    for population in &problem.populations {
        assert_eq!((population.evaluations_at_most, population.runs.len()), (evaluations[1], 3));
        assert!(population.runs.iter().all(|run| run.evaluations <= evaluations[1]));
    }
    let best = problem.best_published.as_ref().expect("four were published");
    assert!(best.source.starts_with("MUMSA") && best.printed_sum_sq.is_none());
}

#[test]
fn a_suite_says_what_is_proved_and_what_cannot_be() {
    let files = [literature("k18", &[]), literature("l10", &[])];
    let certify = Some(CertifySpec { gap: 0.5, time_limit_s: 0.2 });
    let options = Options { seeds: 1, certify, ..Options::default() };
    let mut figures = suite(&files, &options, &AtomicBool::new(false), &|_| {}).expect("it runs");
    assert!(figures.complete);
    let [k18, l10] = figures.problems.as_mut_slice() else { panic!("two problems") };
    let proof = k18.certificate.as_mut().expect("a certificate");
    let least = k18.search.summary.best.as_ref().expect("an answer").sum_sq;
    assert!(proof.boxes > 0 && proof.lower_bound <= least && proof.wanted_gap == 0.5);
    assert!((proof.gap - (1.0 - proof.lower_bound / least)).abs() < 1e-12, "of the answer that is shown");
    assert!(
        l10.certificate.is_none() && l10.no_certificate.as_ref().expect("a reason").contains("free timing")
    );
    // As it stands when the time is enough.
    (proof.lower_bound, proof.gap, proof.closed) = (0.99992 * least, 8e-5, true);
    let statement = proof.statement.clone();
    let (text, page) = (suite_text(&figures, Colour::Never), suite_markdown(&figures));
    for said in ["proved gap", "0.008 %", "k18: proved. ", "l10: no certificate is available for free timing"]
    {
        assert!(text.contains(said) && page.contains(said), "{said}\n{text}\n{page}");
    }
    assert!(page.replace("\n  ", " ").contains(&statement), "{page}");
    let json = serde_json::to_value(&figures).expect("JSON");
    assert_eq!(json["problems"][0]["certificate"]["closed"], true);
    let plain = timeless(self::figures(&files[1..], 1));
    assert!(
        !suite_text(&plain, Colour::Never).contains("proved") && !suite_markdown(&plain).contains("proved")
    );
    assert!(serde_json::to_value(&plain).expect("JSON")["problems"][0].get("no_certificate").is_none());
}

#[test]
fn hits_are_of_the_goal_and_something_smaller_than_the_best_known_is_said_everywhere() {
    let mut file = literature("e5", &[]);
    let mut with = |best_known: f64, goal: Option<f64>| {
        let expect = file.expect.as_mut().expect("it expects something");
        (expect.best_known_sum_sq, expect.goal_sum_sq) = (Some(best_known), goal);
        figures(&[file.clone()], 1)
    };
    let easy = with(5e-7, Some(8e-7));
    let summary = &easy.problems[0].search.summary;
    assert_eq!((summary.hits, summary.hits_of_best_known), (1, 0));
    assert!(
        suite_text(&easy, Colour::Never).contains("e5: hits are of its goal, 8e-7; the best known, 5e-7")
    );
    assert_eq!(easy.problems[0].smaller_than_best_known, None);

    let beaten = with(1e-6, None);
    let summary = &beaten.problems[0].search.summary;
    assert_eq!((summary.hits, summary.hits_of_best_known), (1, 1));
    let smaller = beaten.problems[0].smaller_than_best_known.as_ref().expect("7.4e-7 is smaller than 1e-6");
    assert_eq!((smaller.method, smaller.seed), (Method::Auto, 1));
    assert!((smaller.sum_sq - 7.415751307e-7).abs() < 1e-15);
    let (text, page) = (suite_text(&beaten, Colour::Never), suite_markdown(&beaten));
    assert!(text.contains("e5 *: smaller than the best known! 7.415751307e-7 by auto from seed 1"), "{text}");
    assert!(page.contains(r"| e5 \* |") && page.contains("smaller than the best known!"), "{page}");
    let json = serde_json::to_value(&beaten).expect("data");
    assert_eq!(json["problems"][0]["smaller_than_best_known"]["seed"], 1);
}

#[test]
fn the_same_suite_gives_the_same_figures_and_tells_every_run() {
    let files = [
        literature("k18", &[("solve.evaluations", "3000")]),
        parse("format = 1\n[task.path]\npoints = [[0, 0], [2, 1], [4, 0]]\n"),
    ];
    let told = Mutex::new(Vec::new());
    let observer = |step: &Step<'_>| {
        let mut told = told.lock().expect("no panic");
        if told.last() != Some(&(step.method, step.seed)) {
            told.push((step.method, step.seed));
        }
        assert_eq!((step.problem, step.total), ("k18", 6));
    };
    let options = Options { seeds: 2, ..Options::default() };
    let one = suite(&files, &options, &AtomicBool::new(false), &observer).expect("it runs");
    assert_eq!(one.problems.len(), 1, "what expects nothing is left out");
    let (genetic, evolution) = (Method::Genetic, Method::DifferentialEvolution);
    let runs =
        [(Method::Auto, 1), (Method::Auto, 2), (genetic, 1), (genetic, 2), (evolution, 1), (evolution, 2)];
    assert_eq!(*told.lock().expect("no panic"), runs);
    assert_eq!(timeless(figures(&files, 2)), timeless(one));
}

#[test]
fn a_cancelled_suite_counts_no_run_that_was_cut_short() {
    let files = [literature("e5", &[])];
    let cancel = AtomicBool::new(false);
    let observer = |step: &Step<'_>| {
        if step.done == 1 {
            cancel.store(true, std::sync::atomic::Ordering::Relaxed);
        }
    };
    let cut = suite(&files, &Options::default(), &cancel, &observer).expect("it runs");
    assert!(!cut.complete && !cut.is_accepted());
    assert_eq!(cut.problems[0].search.runs.len(), 1);
    assert!(cut.problems[0].populations.is_empty());
    assert!(suite_text(&cut, Colour::Never).contains("Interrupted: all 10 seeds of 0 problems"));
}

/// A problem of `problems/motion`.
fn motion(name: &str) -> ProblemFile {
    load(&root().join(format!("problems/motion/{name}.toml")), &[])
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn answers_of_a_motion_are_compared_by_their_objective_beside_the_population_searches() {
    let seeds = cases(1, 2);
    let figures = figures(&[motion("lwg-36"), motion("hsieh-20"), motion("bulldozer-blade")], seeds);
    assert!(figures.complete && figures.is_accepted());
    let [lwg, hsieh] = figures.problems.as_slice() else { panic!("two of three have something to compare") };
    assert!(matches!(lwg.known, Known::Motion { best_known_objective, .. } if best_known_objective > 104.25));
    for problem in [lwg, hsieh] {
        let summary = &problem.search.summary;
        assert_eq!(
            (summary.hits as u64, summary.hits_of_best_known as u64),
            (seeds, seeds),
            "{}",
            problem.name
        );
        assert_eq!(problem.smaller_than_best_known, None);
        // After as many evaluations, the same objective of other answers, none of them better.
        assert_eq!((problem.populations.len(), problem.no_populations.as_ref()), (2, None));
        for population in &problem.populations {
            assert_eq!(Some(population.evaluations_at_most), summary.median_evaluations);
            let least = population.runs.iter().filter(|run| run.accepted).filter_map(|run| run.figure());
            assert!(
                least.fold(f64::INFINITY, f64::min) >= problem.known.best() * (1.0 - 1e-6),
                "{}",
                problem.name
            );
        }
    }
    let best = lwg.search.summary.best.as_ref().expect("an answer");
    let errors = best.motion.expect("a motion");
    assert!((best.figure() - 104.250_851_098_746).abs() < 1e-9);
    // The objective from the figures of the record alone: all poses have an angle and the weight 1.
    let Known::Motion { angle_weight, .. } = lwg.known else { panic!("a motion") };
    let of_angles =
        (angle_weight * errors.rms_deg.expect("of poses").to_radians()).powi(2) * lwg.points as f64;
    assert!((best.sum_sq + of_angles - errors.objective).abs() < 1e-9 * errors.objective);
    assert!((errors.rms - (best.sum_sq / lwg.points as f64).sqrt()).abs() < 1e-12);
    assert_eq!((figures.left_out.len(), figures.left_out[0].name.as_str()), (1, "bulldozer-blade"));

    let (text, page) = (suite_text(&figures, Colour::Never), suite_markdown(&figures));
    for said in [
        "Motions: poses of a body",
        "104.25085",
        "rms deg",
        "genetic, diff. evolution: the median objective",
        "Left out: bulldozer-blade: no objective under",
    ] {
        assert!(text.contains(said) && page.contains(said), "{said}\n{text}\n{page}");
    }
    assert!(page.trim_end().ends_with("to compare)."), "no sentence is cut: {page}");
    for other in ["sum of sq", "to curve", "printed"] {
        assert!(!text.contains(other) && !page.contains(other), "{other}\n{text}\n{page}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
}

#[test]
fn paths_and_motions_of_one_suite_have_tables_of_their_own() {
    let figures = figures(&[literature("e5", &[]), motion("triple-rocker-8")], 1);
    let (text, page) = (suite_text(&figures, Colour::Never), suite_markdown(&figures));
    for table in [&text, &page] {
        let place = |words: &str| table.find(words).unwrap_or_else(|| panic!("{words} in\n{table}"));
        assert!(place("sum of sq") < place("Motions: poses of a body"), "{table}");
        assert!(place("Motions: poses of a body") < place("rms deg"), "{table}");
        assert_eq!(table.matches("ms: the median and the worst time").count(), 1, "{table}");
    }
    let shown = page.split("## Motions").next().expect("the first part");
    assert!(shown.contains("| e5 |") && !shown.contains("triple-rocker-8"), "{page}");
}

#[test]
fn an_objective_smaller_than_the_best_known_is_said() {
    let mut file = motion("lwg-36");
    file.expect.as_mut().expect("it expects something").objective = Some(200.0);
    let options = Options { seeds: 1, population_seeds: 0, ..Options::default() };
    let beaten = suite(&[file], &options, &AtomicBool::new(false), &|_| {}).expect("it runs");
    let smaller = beaten.problems[0].smaller_than_best_known.as_ref().expect("104.25 is smaller than 200");
    assert!((smaller.figure() - 104.250_851_098_746).abs() < 1e-9 && smaller.sum_sq < 20.0);
    let text = suite_text(&beaten, Colour::Never);
    assert!(
        text.contains("lwg-36 *: smaller than the best known! 104.2508511 by auto from seed 1"),
        "{text}"
    );
}

#[test]
fn there_is_no_certificate_of_a_motion_and_the_suite_says_why() {
    let certify = Some(CertifySpec::default());
    let options = Options { seeds: 1, population_seeds: 0, certify, ..Options::default() };
    let mut files = [motion("lwg-36"), motion("kinzel-5")];
    files.iter_mut().for_each(|file| file.spec.solve.evaluations = 2000);
    let figures = suite(&files, &options, &AtomicBool::new(false), &|_| {}).expect("it runs");
    for problem in &figures.problems {
        assert!(problem.certificate.is_none());
        assert!(problem.no_certificate.as_ref().expect("a reason").contains("poses of a body"));
    }
    let text = suite_text(&figures, Colour::Never);
    let said = "lwg-36, kinzel-5: no certificate is available for poses of a body: the proof covers";
    assert!(text.contains(said), "{text}");
    assert!(!text.contains("proved gap"), "{text}");
}

/// The paths of all keys of a JSON value, the entries of a list together.
fn keys(value: &Value, place: &str, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(table) => {
            for (key, value) in table {
                let place = format!("{place}.{key}");
                keys(value, &place, found);
                found.insert(place);
            }
        }
        Value::Array(list) => list.iter().for_each(|value| keys(value, place, found)),
        _ => {}
    }
}

#[test]
fn the_json_of_paths_has_the_keys_that_it_has_in_the_repository_and_no_others() {
    let all = |of: &Value| {
        let mut found = BTreeSet::new();
        keys(of, "", &mut found);
        found
    };
    let text = fs::read_to_string(root().join("results/literature.json")).expect("there");
    let mut kept: Value = serde_json::from_str(&text).expect("JSON");
    let problems = kept["problems"].as_array_mut().expect("a list");
    problems.retain(|problem| problem["name"] == "e5");
    let made = serde_json::to_value(figures(&[literature("e5", &[])], 1)).expect("JSON");
    assert_eq!(all(&made), all(&kept));
}

/// The command in a folder of its own.
fn linkwright(folder: &Path) -> Command {
    let mut command = Command::cargo_bin("linkwright").expect("it is built");
    command.current_dir(folder).env("NO_COLOR", "1");
    command
}

fn answer(command: &mut Command) -> (Option<i32>, String, String) {
    let output = command.output().expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code(), text(output.stdout), text(output.stderr))
}

/// A folder with `problems/literature` that holds these problems, each a name and what is put for `[solve]`.
fn house(problems: &[(&str, &str)]) -> TempDir {
    let folder = TempDir::new().expect("a folder");
    let place = folder.path().join("problems/literature");
    fs::create_dir_all(&place).expect("made");
    for (name, solve) in problems {
        let text =
            fs::read_to_string(root().join(format!("problems/literature/{name}.toml"))).expect("there");
        let text = text.replace("[solve]\n", &format!("[solve]\n{solve}\n"));
        fs::write(place.join(format!("{name}.toml")), text).expect("written");
    }
    folder
}

#[test]
fn the_command_runs_what_the_filter_names() {
    let house = house(&[("e5", ""), ("k18", ""), ("k18b", ""), ("k18f", "evaluations = 30000")]);
    let (code, stdout, stderr) =
        answer(linkwright(house.path()).args(["suite", "k18", "--seeds", "1", "--json"]));
    assert_eq!(code, Some(0), "{stderr}");
    let json: Value = serde_json::from_str(&stdout).expect("a JSON document alone");
    assert_eq!((&json["complete"], &json["seeds"], &json["threads"]), (&true.into(), &1.into(), &1.into()));
    assert_eq!(json["command"], "cargo run --release -- suite k18 --seeds 1");
    let problems = json["problems"].as_array().expect("a list");
    let names: Vec<&str> = problems.iter().filter_map(|p| p["name"].as_str()).collect();
    assert_eq!(names, ["k18", "k18b", "k18f"]);
    for problem in problems {
        assert_eq!(problem["search"]["summary"]["hits"], 1, "{}", problem["name"]);
        assert_eq!(problem["search"]["runs"].as_array().map(Vec::len), Some(1));
        assert_eq!(problem["populations"].as_array().map(Vec::len), Some(2));
    }
    assert_eq!(problems[2]["goal_sum_sq"], 0.00315);
    let published = problems[0]["best_published"]["sum_sq"].as_f64().expect("MUMSA's");
    assert!((published - 0.01937062464).abs() < 1e-11);
}

#[test]
fn what_cannot_be_run_is_said_with_exit_2() {
    let house = house(&[("e5", ""), ("k18", "")]);
    let (code, stdout, stderr) = answer(linkwright(house.path()).args(["suite", "watt"]));
    assert_eq!((code, stdout.as_str()), (Some(2), ""));
    assert!(stderr.contains(r#"has "watt" in its name; there are e5, k18"#), "{stderr}");
    let (code, stdout, stderr) = answer(linkwright(house.path()).args(["suite", "--problems", "no/where"]));
    assert_eq!((code, stdout.as_str()), (Some(2), ""));
    assert!(stderr.contains("no/where cannot be read"), "{stderr}");
    let (code, _, stderr) = answer(linkwright(house.path()).args(["suite", "e5", "--write"]));
    assert_eq!(code, Some(2));
    assert!(stderr.contains("--write") && stderr.contains("FILTER"), "{stderr}");
    let (code, ..) = answer(linkwright(house.path()).args(["suite", "--seeds", "0"]));
    assert_eq!(code, Some(2));

    let place = house.path().join("problems/literature");
    fs::write(place.join("broken.toml"), "format = 1\n[expect]\ngoal_sum_sq = -1\n").expect("written");
    let (code, _, stderr) = answer(linkwright(house.path()).arg("suite"));
    assert_eq!(code, Some(2));
    assert!(stderr.contains("broken.toml"), "{stderr}");

    fs::create_dir(house.path().join("bare")).expect("made");
    let plain = "format = 1\n[task.path]\npoints = [[0, 0], [2, 1], [4, 0]]\n";
    fs::write(house.path().join("bare/plain.toml"), plain).expect("written");
    let (code, _, stderr) = answer(linkwright(house.path()).args(["suite", "--problems", "bare"]));
    assert_eq!(code, Some(2));
    assert!(
        stderr.contains("best_known_sum_sq (of a path) or objective (of a motion or a function)"),
        "{stderr}"
    );
}

#[test]
fn the_page_and_its_data_are_written_together_and_nothing_else() {
    let house = house(&[("e5", ""), ("e5-free", "evaluations = 4000")]);
    let results = house.path().join("results");
    let run = || answer(linkwright(house.path()).args(["suite", "--seeds", "1", "--write"]));
    let (code, stdout, stderr) = run();
    assert_eq!(code, Some(0), "{stderr}");
    assert!(stdout.contains("Written to results/literature.md and results/literature.json"), "{stdout}");
    assert!(stdout.lines().all(|line| line.chars().count() <= 100), "{stdout}");
    let names = || {
        let mut names: Vec<_> =
            fs::read_dir(&results).expect("there").map(|e| e.expect("an entry").file_name()).collect();
        names.sort();
        names
    };
    assert_eq!(names(), ["literature.json", "literature.md"]);
    let read = |name: &str| fs::read_to_string(results.join(name)).expect("written");
    let json: Value = serde_json::from_str(&read("literature.json")).expect("JSON");
    assert_eq!(json["command"], "cargo run --release -- suite --seeds 1 --write");
    let page = read("literature.md");
    for part in [
        "cargo run --release -- suite --seeds 1 --write",
        env!("CARGO_PKG_VERSION"),
        "seeds 1 to 1",
        "of one thread",
        "| e5 | 7.41575e-7 | 7.41575e-7 |",
        "| e5 | MUMSA, vector as stored with its code | - | 1.284000744e-6 |",
    ] {
        assert!(page.contains(part), "{part} in\n{page}");
    }
    let e5 = page.find("\n| e5 |").expect("a row");
    assert!(e5 < page.find("\n| e5-free |").expect("a row"), "by name");
    fs::write(results.join("literature.md"), format!("{page}old")).expect("written");
    fs::write(results.join("mine.txt"), "kept").expect("written");
    assert_eq!(run().0, Some(0));
    assert!(!read("literature.md").ends_with("old"), "replaced");
    fs::write(results.join("literature.md"), "my own notes").expect("written");
    let (code, _, stderr) = run();
    assert_eq!(code, Some(2));
    assert!(stderr.contains("literature.md") && stderr.contains("--force"), "{stderr}");
    assert_eq!(read("literature.md"), "my own notes");
    assert_eq!(names(), ["literature.json", "literature.md", "mine.txt"]);
}

#[test]
fn a_place_that_is_no_folder_is_refused_before_anything_runs() {
    let house = house(&[("k18", "method = \"genetic\"\nevaluations = 100000000000")]);
    fs::write(house.path().join("results"), "a file").expect("written");
    let (code, stdout, stderr) = answer(linkwright(house.path()).args(["suite", "--write"]));
    assert_eq!((code, stdout.as_str()), (Some(2), ""));
    assert!(stderr.contains("results"), "{stderr}");
}

#[test]
fn a_seed_without_an_accepted_answer_is_exit_1() {
    let house = house(&[("k18", "")]);
    let path = house.path().join("problems/literature/k18.toml");
    let text = fs::read_to_string(&path).expect("there");
    // No crank-rocker has a right angle between coupler and follower all the way round.
    let text = text.replace("[require]\n", "[require]\ntransmission_deg_min = 89.9\n");
    fs::write(&path, text.replace("[solve]\n", "[solve]\nevaluations = 2000\n")).expect("written");
    let (code, stdout, stderr) = answer(linkwright(house.path()).args(["suite", "--seeds", "2"]));
    assert_eq!(code, Some(1), "{stderr}");
    assert!(stdout.contains("k18: an accepted answer from 0 of 2 seeds only."), "{stdout}");
    assert!(stdout.contains("0/2"), "{stdout}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_the_suite_and_says_what_is_done() {
    use std::process::{Command as Process, Stdio};
    let method = "method = \"differential-evolution\"";
    let house = house(&[
        ("e5", &format!("{method}\nevaluations = 300")),
        ("k18", &format!("{method}\nevaluations = 100000000000")),
    ]);
    let child = Process::new(assert_cmd::cargo::cargo_bin("linkwright"))
        .args(["suite", "--seeds", "1", "--write", "--json"])
        .current_dir(house.path())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    std::thread::sleep(std::time::Duration::from_millis(2500));
    let sent = Process::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(sent.success());
    let output = child.wait_with_output().expect("it ends");
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(130), "{stderr}");
    assert!(stderr.contains("3 of 6 runs are done; nothing was written"), "{stderr}");
    let json: Value = serde_json::from_slice(&output.stdout).expect("a JSON document alone");
    assert_eq!(json["complete"], false);
    assert_eq!(json["problems"].as_array().map(Vec::len), Some(1));
    assert!(!house.path().join("results").exists(), "no folder is left behind");
}

#[test]
fn the_page_of_another_folder_bears_its_name_and_names_what_is_left_out() {
    let folder = TempDir::new().expect("a folder");
    let place = folder.path().join("my-motions");
    fs::create_dir(&place).expect("made");
    for name in ["triple-rocker-8.toml", "folding-bed.toml"] {
        fs::copy(root().join("problems/motion").join(name), place.join(name)).expect("copied");
    }
    let run = |words: &[&str]| {
        let words = [&["suite", "--problems", "my-motions/", "--seeds", "1"], words].concat();
        answer(linkwright(folder.path()).args(words))
    };
    let (code, stdout, stderr) = run(&["--write"]);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(stdout.contains("Written to results/my-motions.md and results/my-motions.json"), "{stdout}");
    assert!(stdout.contains("Left out: folding-bed: no objective under [expect]"), "{stdout}");
    let results = folder.path().join("results");
    let page = fs::read_to_string(results.join("my-motions.md")).expect("written");
    assert!(page.starts_with("# Problems in my-motions: what is found\n"), "{page}");
    assert!(page.contains("suite --problems my-motions/ --seeds 1 --write"), "{page}");
    let text = fs::read_to_string(results.join("my-motions.json")).expect("written");
    let json: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(
        (&json["collection"], &json["left_out"][0]["name"]),
        (&"my-motions".into(), &"folding-bed".into())
    );
    let problem = &json["problems"][0];
    assert_eq!(
        (&problem["best_known_objective"], &problem["search"]["summary"]["hits"]),
        (&0.0.into(), &1.into())
    );
    assert!(problem["search"]["runs"][0]["objective"].as_f64().is_some_and(|objective| objective < 1e-20));
    assert!(problem.get("best_known_sum_sq").is_none() && problem.get("goal_sum_sq").is_none());
    assert_eq!(run(&["--write"]).0, Some(0), "its own files are replaced");

    let (code, _, stderr) = run(&["folding"]);
    assert_eq!(code, Some(2));
    assert!(stderr.contains("folding-bed: nothing to compare with"), "{stderr}");
    let (code, _, stderr) = run(&["watt"]);
    assert_eq!(code, Some(2));
    assert!(stderr.contains("has \"watt\" in its name; there are triple-rocker-8"), "{stderr}");
}
