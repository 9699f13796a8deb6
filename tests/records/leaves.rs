//! Every figure of real records changed, one at a time: `verify` finds it out, or does not, as the table in
//! docs/results.md says of its key.
//!
//! `EVERY_LEAF=1` changes each of them. Without it one of each key is changed, in the first record that holds it, and of the
//! linkages beside the candidates a fourth of the keys; with `THOROUGH=1` two of each key, in every record.

use crate::common::thorough::is_thorough;
use crate::common::{job, load, parse, root};
use crate::front::with_front;
use linkwright::internals::app::job::folder::parse_record;
use linkwright::internals::app::job::run::{Context, prove, run};
use linkwright::internals::files::problem_file::ProblemFile;
use linkwright::internals::judge::certificate::{Proof, Request};
use linkwright::internals::judge::verify::{Checked, UNCHECKED, unchecked, verify};
use linkwright::internals::record::Record;
use linkwright::internals::synthesis::several_loops::beside_four_bars;
use linkwright::internals::synthesis::{self, Budget};
use linkwright::internals::task::Problem;
use rayon::prelude::*;
use serde_json::{Map, Value};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::sync::atomic::{AtomicBool, Ordering};

/// Returns how many leaves of each key in each record are changed, evenly taken from all.
fn leaves_of_a_key() -> usize {
    if is_thorough() { 2 } else { 1 }
}

/// Whether a key is changed in every record, or in the first one that holds it.
fn in_every_record() -> bool {
    is_thorough() || std::env::var_os("EVERY_LEAF").is_some()
}

/// Returns whether a key is changed every day: of the keys of linkages beside the candidates, which are checked as those of a
/// candidate, a fourth, chosen by the length of their names.
fn is_of_every_day(key: &str) -> bool {
    BESIDE.iter().all(|beside| !key.starts_with(beside)) || key.len().is_multiple_of(4)
}

fn run_all(file: ProblemFile) -> Record {
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    let mut record = run(&job(file), &context).expect("it runs").record;
    prove(&mut record, &AtomicBool::new(false), &mut |_| {});
    record
}

fn shipped(name: &str, set: &[(&str, &str)]) -> Record {
    run_all(load(&root().join(format!("problems/{name}.toml")), set))
}

/// The record with a certificate; `batches`: stopped after so many.
fn certified(mut record: Record, gap: f64, batches: usize) -> Record {
    let mut proof = Proof::new(&record, &Request { gap }).expect("there is a certificate");
    let (cancel, mut seen) = (AtomicBool::new(false), 0);
    proof.run(&cancel, None, &mut |_| {
        seen += 1;
        cancel.store(seen >= batches, Ordering::Relaxed);
    });
    record.certificate = Some(proof.certificate());
    record
}

/// Records of every kind, with a name; those that take long to verify last.
fn records() -> Vec<(&'static str, Record)> {
    let ground: &[(&str, &str)] = &[("task.path.timing.offset", "ground"), ("solve.candidates", "1")];
    let timed = shipped("literature/k18", ground);
    let short = [("solve.evaluations", "4000"), ("solve.candidates", "2")];
    let family = shipped("literature/v6", &short);
    let without = [("solve.certify", "true"), ("solve.evaluations", "3000"), ("solve.time_limit_s", "1000")];
    let no_certificate = shipped("literature/l10", &without);
    let tight = [("require.link_ratio_max", "1.5"), ("require.transmission_deg_min", "50")];
    let conflict = [&tight[..], &[("solve.evaluations", "20000"), ("solve.candidates", "2")]].concat();
    let costs = [("require.footprint_in", "[-300, -30, 200, 450]"), ("task.path.tolerance", "40")];
    let costs = [&costs[..], &[("solve.evaluations", "8000"), ("solve.candidates", "2")]].concat();
    let nearly_exact = "format = 1\nname = \"flat\"\n[task.path]\npoints = [[0, 0], [10, 0], [20, 0], [30, 5], [40, 5], \
                        [50, 0], [60, 0], [70, 0]]\n[require]\nlink_ratio_max = 5\n[solve]\nevaluations = 20000\n";
    let digitised = "format = 1\nname = \"drawn\"\nunit = \"mm\"\nsource = \"by hand\"\n[task.path]\npoints = [[0, 0], \
                     [3, 1], [7, 4], [12, 4], [16, 1], [18, -3], [13, -6], [6, -4]]\nclosed = true\nsmooth = 1.0\n\
                     samples = 10\ntolerance = 3\n[require]\npivots_in = [-30, -30, 30, 30]\ndirection = \"ccw\"\n[solve]\n\
                     evaluations = 12000\ncandidates = 2\n";
    let unmet = "format = 1\n[task.path]\npoints = [[0, 0], [3, 1], [7, 4], [12, 4], [16, 1]]\ntolerance = [1, 1, 2, 1, \
                 1]\n[task.path.timing]\ncrank_deg = [0, 10, 20, 30, 40]\noffset = \"free\"\n[require]\ntype = \
                 [\"double-crank\"]\ntransmission_deg_min = 80\n[solve]\nmethod = \"differential-evolution\"\n\
                 objective = \"max-deviation\"\nevaluations = 2000\ncandidates = 2\n";
    let kinds = [
        ("design.mechanism", r#"["four-bar", "six-bar"]"#),
        ("task.path.tolerance", "0.14"),
        ("solve.evaluations", "30000"),
        ("solve.candidates", "1"),
    ];
    let of_kinds = shipped("shapes/heart", &kinds);
    assert!(of_kinds.of_kinds.len() == 2 && of_kinds.candidates[0].accepted);
    let mut four_bars = kinds[1..].to_vec();
    four_bars.extend([("design.mechanism", "four-bar"), ("solve.advice", "false")]);
    let mut offered = shipped("shapes/heart", &four_bars);
    // As it is where advice is worked out: the explanation beside it takes long.
    offered.problem.resolved.solve.advice = true;
    let problem = Problem::new(offered.problem.resolved.clone()).expect("a problem");
    let never = AtomicBool::new(false);
    let budget = Budget { cancel: &never, deadline: None };
    offered.other_kind = beside_four_bars(synthesis::Context::new(&problem, &budget));
    assert!(offered.other_kind.is_some());
    vec![
        ("proved", certified(timed.clone(), 0.9, usize::MAX)),
        ("proved in part", certified(timed, 1e-3, 3)),
        ("a family", family),
        ("without a certificate", no_certificate),
        ("in conflict", shipped("literature/k18", &conflict)),
        ("with costs", shipped("examples/walking-stride", &costs)),
        ("with one to build", run_all(parse(nearly_exact))),
        ("digitised", run_all(parse(digitised))),
        ("unmet", run_all(parse(unmet))),
        ("exact", shipped("exact/gaussian", &[])),
        ("with a front", with_front(&[("solve.picks_within", "2")])),
        ("of several kinds", of_kinds),
        ("with another kind", offered),
    ]
}

/// How docs/results.md says that a key is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Said {
    Recomputed,
    Bounded,
    Not,
}

/// The rows of the table in docs/results.md: each key with how it is checked.
fn table() -> BTreeMap<String, Said> {
    let page = fs::read_to_string(root().join("docs/results.md")).expect("the page");
    let section = page.split_once("\n## What `verify` checks").expect("a section").1;
    let section = section.split("\n## ").next().expect("a section");
    let mut rows = BTreeMap::new();
    for line in section.lines().filter(|line| line.starts_with("| `")) {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        let said = match cells[1] {
            "recomputed" => Said::Recomputed,
            "bounded" => Said::Bounded,
            "not checked" => Said::Not,
            other => panic!("{other} in {line}"),
        };
        for key in cells[0].split(", ") {
            let key = key.trim_matches('`').to_owned();
            assert!(rows.insert(key.clone(), said).is_none(), "{key} stands there twice");
        }
    }
    rows
}

/// The row that a key belongs to: its own, else the one with the longest beginning.
fn row<'a>(table: &'a BTreeMap<String, Said>, key: &str) -> Option<(&'a str, Said)> {
    let own = table.get_key_value(key);
    let wide = || {
        let covers =
            |row: &&(&String, &Said)| row.0.strip_suffix('*').is_some_and(|start| key.starts_with(start));
        table.iter().filter(|entry| covers(&entry)).max_by_key(|(row, _)| row.len())
    };
    own.or_else(wide).map(|(row, said)| (row.as_str(), *said))
}

/// The beginnings of keys of linkages beside the candidates.
const BESIDE: [&str; 5] = [
    "buildable.",
    "other_kind.",
    "picks.smallest.",
    "picks.best_transmission.",
    "front.members[].candidate.",
];

/// A step into a document.
#[derive(Clone, Debug)]
enum Step {
    Key(String),
    Place(usize),
}

/// One change of a document: where, and what stands there then.
struct Change {
    /// The key, as the table has it.
    key: String,
    path: Vec<Step>,
    to: Value,
}

/// Words that stand for each other in a record.
const WORDS: [&[&str]; 13] = [
    &["crank-rocker", "double-crank", "rocker-crank", "double-rocker", "triple-rocker", "change-point"],
    &["converged", "target-reached", "stalled", "evaluation-limit", "time-limit", "cancelled"],
    &["auto", "genetic", "differential-evolution", "least-squares", "continuation"],
    &["variable-projection", "least-squares", "following-the-hand"],
    &["cycle", "used"],
    &["order", "branch", "circuit"],
    &["transmission-angle", "link-ratio", "change-point", "on-bound"],
    &["length", "degree", "ratio"],
    &["complete", "non-generic", "incomplete", "cancelled"],
    &["required", "one", "any"],
    &["ccw", "cw", "any"],
    &["require.type", "require.link_ratio_max", "require.transmission_deg_min", "require.branch", "no.such"],
    &["mm", "cm", "m", "in"],
];

/// What a leaf is changed to: well beyond every margin.
fn others(value: &Value) -> Vec<Value> {
    match value {
        Value::Bool(is) => vec![(!is).into()],
        Value::Number(number) => match (number.as_i64(), number.as_u64()) {
            (None, None) => {
                let x = number.as_f64().expect("a number");
                vec![(1.5 * x + 1.0).into(), (-1.5 * x - 1.0).into(), (1e6 * x.abs() + 1e6).into()]
            }
            (Some(n @ (1 | -1)), _) => vec![(-n).into(), (n + 1).into(), 1_000_000_000_u64.into()],
            (n, _) => vec![(n.unwrap_or(i64::MAX - 1) + 1).into(), 0.into(), 1_000_000_000_u64.into()],
        },
        Value::String(text) => {
            let sets = WORDS.iter().filter(|set| set.contains(&text.as_str()));
            let words = sets.flat_map(|set| set.iter()).map(|word| (*word).to_owned());
            words.chain([format!("{text} indeed"), String::new()]).map(Value::from).collect()
        }
        _ => Vec::new(),
    }
}

/// All changes of single leaves below a value, and of lists by an entry.
fn changes(value: &Value, key: &str, path: &[Step], found: &mut Vec<Change>) {
    let mut push = |key: &str, to: Value| found.push(Change { key: key.to_owned(), path: path.to_vec(), to });
    match value {
        Value::Object(table) => {
            for (name, below) in table {
                let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                let path = [path, &[Step::Key(name.clone())]].concat();
                changes(below, &key, &path, found);
            }
        }
        Value::Array(list) => {
            let below = if list.iter().any(Value::is_object) { format!("{key}[]") } else { key.to_owned() };
            if let [_, rest @ ..] = &list[..] {
                push(&below, rest.to_vec().into());
                push(&below, list[..rest.len()].to_vec().into());
            }
            for (place, entry) in list.iter().enumerate() {
                changes(entry, &below, &[path, &[Step::Place(place)]].concat(), found);
            }
        }
        leaf => others(leaf).into_iter().filter(|to| to != leaf).for_each(|to| push(key, to)),
    }
}

fn changed(document: &Value, change: &Change) -> Value {
    let mut document = document.clone();
    let at = change.path.iter().fold(&mut document, |value, step| match step {
        Step::Key(name) => &mut value[name.as_str()],
        Step::Place(place) => &mut value[*place],
    });
    *at = change.to.clone();
    document
}

/// Whether a record is found out: as it is read, or as it is verified.
fn is_caught(document: &Value) -> bool {
    let text = serde_json::to_vec(document).expect("JSON");
    let Ok(record) = parse_record("record.json", &text) else { return true };
    verify(&record).map_or(true, |mismatches| !mismatches.is_empty())
}

/// The changes to try: of each key and each place in its list of changes the same number, spread over all.
fn some(changes: Vec<Change>) -> Vec<Change> {
    if std::env::var_os("EVERY_LEAF").is_some() {
        return changes;
    }
    let mut by_key: BTreeMap<String, BTreeMap<String, Vec<Change>>> = BTreeMap::new();
    for change in changes {
        let at = format!("{:?}", change.path);
        by_key.entry(change.key.clone()).or_default().entry(at).or_default().push(change);
    }
    let few = |leaves: BTreeMap<String, Vec<Change>>| {
        let every = leaves.len().div_ceil(leaves_of_a_key());
        leaves.into_values().step_by(every).flatten().collect::<Vec<_>>()
    };
    by_key.into_values().flat_map(few).collect()
}

#[test]
fn a_changed_leaf_is_found_out_as_far_as_the_table_says() {
    let table = table();
    let mut outcomes: BTreeMap<String, (u64, u64)> = BTreeMap::new();
    let mut wrong: BTreeSet<String> = BTreeSet::new();
    let mut met: BTreeSet<&str> = BTreeSet::new();
    let mut done: BTreeSet<String> = BTreeSet::new();
    for (name, record) in records() {
        assert_eq!(verify(&record).expect("a problem"), Vec::new(), "{name}");
        let document = serde_json::to_value(&record).expect("JSON");
        let mut all = Vec::new();
        changes(&document, "", &[], &mut all);
        all.retain(|change| in_every_record() || is_of_every_day(&change.key) && !done.contains(&change.key));
        done.extend(all.iter().map(|change| change.key.clone()));
        let tried: Vec<(Change, bool)> = some(all)
            .into_par_iter()
            .map(|change| {
                let caught = is_caught(&changed(&document, &change));
                (change, caught)
            })
            .collect();
        for (change, caught) in tried {
            // The one to build, the picks and the members of a front have the keys of a candidate.
            let key = BESIDE.iter().find_map(|beside| change.key.strip_prefix(beside));
            let key = key.map_or(change.key.clone(), |rest| format!("candidates[].{rest}"));
            let Some((row, said)) = row(&table, &key) else {
                wrong.insert(format!("{name}: docs/results.md does not say how `{key}` is checked"));
                continue;
            };
            met.insert(row);
            let seen = outcomes.entry(row.to_owned()).or_default();
            *(if caught { &mut seen.0 } else { &mut seen.1 }) += 1;
            let at = || {
                let steps = change.path.iter().map(|step| match step {
                    Step::Key(name) => format!(".{name}"),
                    Step::Place(place) => format!("[{place}]"),
                });
                format!("{name}: {} to {}", steps.collect::<String>(), change.to)
            };
            match (said, caught) {
                (Said::Recomputed, false) => wrong.insert(format!("{}: not found out", at())),
                (Said::Not, true) => {
                    wrong.insert(format!("{}: found out, though `{row}` is not checked", at()))
                }
                _ => false,
            };
        }
    }
    for (row, said) in &table {
        let (caught, passed) = outcomes.get(row).copied().unwrap_or_default();
        if *said == Said::Bounded && caught == 0 {
            wrong.insert(format!("`{row}` is said to be bounded: {caught} changes found out, {passed} not"));
        }
        if !met.contains(row.as_str()) {
            wrong.insert(format!("no record holds `{row}`"));
        }
    }
    let wrong: Vec<String> = wrong.into_iter().collect();
    assert!(wrong.is_empty(), "{}:\n{}", wrong.len(), wrong.join("\n"));
}

/// Returns the extent to which a key, written as in [`UNCHECKED`], is checked; `None` if it is recomputed.
fn checked(key: &str) -> Option<Checked> {
    let covers = |row: &str| row == key || row.strip_suffix('*').is_some_and(|start| key.starts_with(start));
    UNCHECKED.iter().find(|(row, _)| covers(row)).map(|(_, how)| *how)
}

/// What the program prints as not recomputed is what the table says.
#[test]
fn the_program_and_the_table_name_the_same_keys() {
    let said: BTreeSet<(String, Checked)> = table()
        .into_iter()
        .filter_map(|(key, said)| match said {
            Said::Recomputed => None,
            Said::Bounded => Some((key, Checked::Bounded)),
            Said::Not => Some((key, Checked::Not)),
        })
        .collect();
    let named: BTreeSet<(String, Checked)> =
        UNCHECKED.iter().map(|(key, how)| ((*key).to_owned(), *how)).collect();
    assert_eq!(said, named);
    assert_eq!(checked("evaluations.positions"), Some(Checked::Bounded));
    assert_eq!(checked("candidates[].error.rms"), None);
}

#[test]
fn the_keys_that_a_record_lacks_are_not_named() {
    let text = "format = 1\n[task.path]\npoints = [[0, 0], [3, 1], [7, 4], [12, 4]]\n[solve]\nmethod = \"genetic\"\n\
                evaluations = 500\n";
    let record = run_all(parse(text));
    let keys = unchecked(&record, Checked::Not);
    assert!(keys.contains(&"tool.version") && !keys.contains(&"problem.source"), "{keys:?}");
    assert!(!unchecked(&record, Checked::Bounded).contains(&"repeats.near"));
    assert!(
        serde_json::to_value(&record)
            .expect("JSON")
            .as_object()
            .is_some_and(|table: &Map<_, _>| !table.is_empty())
    );
}
