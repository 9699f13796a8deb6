//! What requirements cost: the multipliers against solving again at moved limits, and what the record says.

mod common;

use common::{literature, load, parse, root, run_on};
use linkwright::problem::Problem;
use linkwright::problem_file::ProblemFile;
use linkwright::record::{Candidate, Cost};
use linkwright::search::Budget;
use linkwright::search::costs::{marginal, weighted_rms};
use linkwright::search::loosen::Demand;
use linkwright::search::multistart::{judged, polish};
use linkwright::search::warm::start_at;
use linkwright::verify::verify;
use std::sync::atomic::AtomicBool;

/// The error where the limit of a cost has been moved outward by `room`, fitted from the candidate.
fn moved(problem: &Problem, candidate: &Candidate, cost: &Cost, room: f64) -> f64 {
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
    let end = polish(&near, start, 2000, 40, u64::MAX, &budget).end.expect("it ends");
    let end = polish(&near, end, 2000, 40, u64::MAX, &budget).end.expect("it ends");
    let found = judged(&near, &end).expect("it closes");
    assert!(found.requirements.iter().all(|r| r.met), "{cost:?}: {:?}", found.requirements);
    weighted_rms(&near, found.error.objective)
}

/// Each rate of the best candidate within 10 % of the change on solving again, and the names that have one.
fn rates_agree(file: ProblemFile) -> Vec<String> {
    let problem = Problem::new(file.spec.clone()).expect("it is one");
    let name = file.name.clone();
    let record = run_on(2, file);
    assert_eq!(verify(&record).expect("the problem is one"), Vec::new(), "{name}");
    let mut seen = Vec::new();
    for candidate in record.candidates.iter().take(2) {
        for cost in &candidate.costs {
            println!("{name} #{} {cost:?} rms {}", candidate.rank, candidate.error.rms);
            let Some(rate) = cost.rms_per_unit.filter(|_| cost.name != "type") else { continue };
            let rms = weighted_rms(&problem, candidate.error.objective);
            // A change of a thousandth of the error, within what the limit allows.
            let step = (1e-3 * rms / -rate).min(1e-2 * cost.limit.abs().max(0.1 * problem.task().size()));
            let [out, inward] = [step, -step].map(|room| moved(&problem, candidate, cost, room));
            let solved = (out - inward) / (2.0 * step);
            println!(
                "   {rate:e} solved again {solved:e} {:.3} {:.3} {:.3}",
                solved / rate,
                (out - rms) / step / rate,
                (rms - inward) / step / rate
            );
            seen.push(format!("{} {}", cost.name, cost.side.as_deref().unwrap_or("")).trim().to_owned());
        }
    }
    seen
}

#[test]
fn rates_agree_with_solving_again_at_moved_limits() {
    for name in ["k18", "a6", "e5", "p12", "l10", "e5-free", "a6b", "k18f"] {
        rates_agree(literature(name, &[]));
    }
    for name in ["pivot-box", "walking-stride", "csv-tolerances", "straight-line"] {
        rates_agree(load(&root().join(format!("problems/examples/{name}.toml")), &[]));
    }
}
