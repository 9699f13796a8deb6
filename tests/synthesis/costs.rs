//! What requirements cost: the multipliers against solving again at moved limits, and what the record says.

use crate::common::{bytes, literature, load, root, run_on};
use linkwright::internals::files::problem_file::ProblemFile;
use linkwright::internals::judge::costs::weighted_rms;
use linkwright::internals::judge::loosen::Demand;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::judge::warm::start_at;
use linkwright::internals::record::{Candidate, Cost, Figure};
use linkwright::internals::synthesis::multistart::{Effort, judged, polish};
use linkwright::internals::synthesis::{Budget, Context};
use linkwright::internals::task::Problem;
use std::sync::atomic::AtomicBool;

/// The error where the limit of a cost has been moved outward by `room`, fitted from the candidate, and the end of the fit.
fn moved(problem: &Problem, candidate: &Candidate, cost: &Cost, room: f64) -> (f64, Candidate) {
    let demand = Demand::named(&cost.name).expect("it has a name");
    let mut spec = problem.spec().clone();
    let limits = demand.limits(&spec).expect("it has limits");
    let place = match cost.side.as_deref() {
        None | Some("xmin") => 0,
        Some("ymin") => 1,
        Some("xmax") => 2,
        Some("ymax") => 3,
        Some(side) => {
            2 * usize::from(cost.name.ends_with("Ay") || cost.name.ends_with("By"))
                + usize::from(side == "max")
        }
    };
    let mut values: Vec<f64> = limits.iter().map(|l| l.value).collect();
    assert_eq!(values[place], cost.limit);
    values[place] += limits[place].outward * room;
    spec = demand.with_limits(spec, &values);
    let near = Problem::new(spec).expect("it is one");
    let budget = Budget { cancel: &AtomicBool::new(false), deadline: None };
    let start = start_at(&near, candidate).expect("it closes");
    let (context, effort) = (Context::new(&near, &budget), Effort::of(2000, 40));
    let end = polish(context, start, effort, u64::MAX).end.expect("it ends");
    let end = polish(context, end, effort, u64::MAX).end.expect("it ends");
    let found = judged(&near, &end).expect("it closes");
    assert!(found.requirements.iter().all(|r| r.met), "{cost:?}: {:?}", found.requirements);
    (weighted_rms(&near, found.error.objective), found)
}

/// The least error where the limit has been moved by `room`, fitted from the candidate and from its fits further out and in,
/// which are `step` apart or more: at the corner of several limits a fit may stay where it begins.
fn solved_again(problem: &Problem, candidate: &Candidate, cost: &Cost, (room, step): (f64, f64)) -> f64 {
    let others = [-3.0, -1.0, 3.0, 10.0].map(|far| moved(problem, candidate, cost, far * step).1);
    let starts = [candidate].into_iter().chain(&others);
    starts.map(|from| moved(problem, from, cost, room).0).fold(f64::INFINITY, f64::min)
}

/// Each rate of the two best candidates within 10 % of the change on solving again; gives the names that have one.
fn rates_agree(file: ProblemFile) -> Vec<String> {
    let problem = Problem::new(file.spec.clone()).expect("it is one");
    let name = file.name.clone();
    let record = run_on(2, file);
    assert_eq!(verify(&record).expect("the problem is one"), Vec::new(), "{name}");
    let mut seen = Vec::new();
    for candidate in record.candidates.iter().take(2) {
        for cost in &candidate.costs {
            let Some(rate) = cost.rms_per_unit.filter(|_| cost.name != "type") else { continue };
            assert!(rate < 0.0, "{name}: room never costs");
            let rms = weighted_rms(&problem, candidate.error.objective);
            // A change of a thousandth of the error, within what the limit allows.
            let step = (1e-3 * rms / -rate).min(1e-2 * cost.limit.abs().max(0.1 * problem.task().size()));
            let [out, inward] =
                [step, -step].map(|room| solved_again(&problem, candidate, cost, (room, step)));
            let solved = (out - inward) / (2.0 * step);
            assert!((rate - solved).abs() <= 0.1 * solved.abs(), "{name} {cost:?}: solved again {solved:e}");
            seen.push(format!("{} {}", cost.name, cost.side.as_deref().unwrap_or("")).trim().to_owned());
        }
    }
    seen
}

#[test]
fn rates_of_published_problems_agree_with_solving_again_at_moved_limits() {
    let on_bounds = rates_agree(literature("a6", &[]));
    assert!(on_bounds.contains(&"design.a min".into()) && on_bounds.contains(&"design.ground max".into()));
    assert!(rates_agree(literature("l10", &[])).contains(&"design.ground max".into()));
    let tight = [("require.transmission_deg_min", "35")];
    assert!(rates_agree(literature("k18", &tight)).contains(&"transmission_deg_min".into()));
    let tight = [("require.link_ratio_max", "2"), ("require.pivots_in", "[-1, -1, 1.2, 0.7]")];
    let timed = rates_agree(literature("k18", &tight));
    assert!(timed.contains(&"link_ratio_max".into()), "{timed:?}");
    let timed = rates_agree(literature("k18", &[("require.pivots_in", "[-1, -1, 1.2, 0.7]")]));
    assert!(timed.iter().any(|name| name.starts_with("pivots_in")), "{timed:?}");
    let timed = rates_agree(literature("k18", &[("require.footprint_in", "[-0.1, -1, 1.2, 1.3]")]));
    assert!(timed.iter().any(|name| name.starts_with("footprint_in")), "{timed:?}");
}

#[test]
fn rates_of_extent_and_longest_link_agree_with_solving_again_at_moved_limits() {
    for name in ["extent_max", "longest_max"] {
        let key = format!("require.{name}");
        let loose = run_on(2, literature("k18", &[(key.as_str(), "1e6")]));
        let row = loose.candidates[0].requirements.iter().find(|r| r.name == name).expect("it is asked for");
        let Figure::Number(value) = row.value else { panic!("{name} is a number") };
        let tight = (0.9 * value).to_string();
        let priced = rates_agree(literature("k18", &[(key.as_str(), tight.as_str())]));
        assert!(priced.contains(&name.to_owned()), "{name}: {priced:?}");
    }
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn rates_of_the_examples_agree_with_solving_again_at_moved_limits() {
    let example = |name: &str, set: &[(&str, &str)]| {
        rates_agree(load(&root().join(format!("problems/examples/{name}.toml")), set))
    };
    assert!(example("pivot-box", &[]).contains(&"pivots_in ymax".into()));
    assert!(example("walking-stride", &[]).contains(&"transmission_deg_min".into()));
    let tight = [("require.link_ratio_max", "2.2")];
    assert!(example("walking-stride", &tight).contains(&"link_ratio_max".into()));
    let held = [("require.footprint_in", "[-300, -30, 200, 450]"), ("task.path.tolerance", "40")];
    let held = example("walking-stride", &held);
    assert!(held.iter().any(|name| name.starts_with("footprint_in")), "{held:?}");
    // Between the ends of an open path: told where it can be told, and then right.
    let used = [("require.transmission_over", "used"), ("require.transmission_deg_min", "75")];
    example("pivot-box", &used);
    example("csv-tolerances", &[]);
    example("straight-line", &[]);
}

#[test]
fn what_stands_on_no_limit_costs_nothing() {
    let record = run_on(2, literature("k18", &[]));
    assert!(record.candidates[0].costs.is_empty());
    assert!(!bytes(&record).contains("costs"), "absent where there is nothing to say");
    assert!(!bytes(&record).contains("relaxations") && !bytes(&record).contains("conflict"));
}

#[test]
fn an_exact_answer_pays_for_nothing() {
    let record = run_on(2, literature("v6", &[]));
    assert!(record.candidates.iter().all(|c| c.costs.is_empty()));
}

#[test]
fn the_first_candidate_says_what_is_left_without_each_requirement() {
    let record = run_on(2, literature("a6", &[]));
    let best = &record.candidates[0];
    assert!(!best.costs.is_empty());
    for cost in &best.costs {
        let without = cost.rms_without.expect("there is less without it");
        assert!(without < best.error.rms, "{cost:?}");
    }
    // Without the lower bound of the crank it is problem a6b, up to the other bounds: 0.4848 at most.
    let crank = best.costs.iter().find(|c| c.name == "design.a").expect("the crank is on its bound");
    assert!(crank.rms_without.expect("it is there") < 0.9 * best.error.rms);
    assert!(record.candidates[1..].iter().flat_map(|c| &c.costs).all(|c| c.rms_without.is_none()));
}

#[test]
fn a_weighted_problem_is_priced_in_weighted_errors() {
    let text = |weights: &str| {
        format!(
            "format = 1\n[task.path]\nfile = \"points.csv\"\n[task.path.timing]\ncrank_deg = [30, 60, 90, 120, 150, 180]\n\
             offset = \"ground\"\n[design]\nA = [[-50, 50], [-50, 50]]\nground = [5, 50]\na = [5, 50]\nb = [5, 50]\n\
             c = [5, 50]\ncoupler_x = [-50, 50]\ncoupler_y = [-50, 50]\n[require]\ntype = [\"crank-rocker\"]\n\
             link_ratio_max = 1000\n# {weights}\n"
        )
    };
    let folder = tempfile::tempdir().expect("a folder");
    let points =
        [(0.0, 0.0), (1.9098, 5.8779), (6.9098, 9.5106), (13.09, 9.5106), (18.09, 5.8779), (20.0, 0.0)];
    let rows: Vec<String> =
        points.iter().zip([1, 2, 3, 1, 5, 1]).map(|((x, y), w)| format!("{x},{y},{w}")).collect();
    std::fs::write(folder.path().join("points.csv"), format!("x,y,weight\n{}\n", rows.join("\n")))
        .expect("it can be written");
    let file = linkwright::internals::files::problem_file::parse(
        "weighted.toml",
        &text("weighted"),
        Some(folder.path()),
        &[],
    );
    let seen = rates_agree(file.unwrap_or_else(|e| panic!("{e}")));
    assert!(!seen.is_empty());
}

#[test]
fn a_changed_rate_or_a_flattering_total_is_found_out() {
    let honest = run_on(2, literature("a6", &[]));
    let mut record = honest.clone();
    record.candidates[0].costs[0].rms_per_unit =
        record.candidates[0].costs[0].rms_per_unit.map(|r| 1.001 * r);
    assert_eq!(verify(&record).expect("the problem is one").len(), 1);
    let mut record = honest.clone();
    record.candidates[0].costs[0].rms_without = Some(1e3);
    assert_eq!(verify(&record).expect("the problem is one").len(), 1);
    let mut record = honest.clone();
    record.candidates[0].costs.remove(0);
    assert_eq!(verify(&record).expect("the problem is one").len(), 1);
}

#[test]
fn records_without_costs_still_read() {
    let record = run_on(2, literature("k18", &[("solve.candidates", "1")]));
    let text = bytes(&record);
    let read: linkwright::internals::record::Record = serde_json::from_str(&text).expect("it reads");
    assert_eq!(read, record);
    let with = run_on(2, literature("a6", &[]));
    let read: linkwright::internals::record::Record = serde_json::from_str(&bytes(&with)).expect("it reads");
    assert_eq!(read, with);
}
