//! Tests of how much a search computes between two checks for a stop, and after one.

#![cfg(test)]

use super::{Budget, JUDGED_AFTER_STOP};
use crate::app::job::run::{Context, Job, run};
use crate::files::problem_file::parse;
use crate::mechanism::effort::counted::{Counts, begin, counts};
use crate::record::{Reason, Record};
use crate::thorough::is_thorough;
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

/// Number of points of the targets: as many as need checks for a stop within a generation.
const POINTS: usize = 1200;
/// Greatest number of positions per point between two checks: the longest step is the judging of a candidate, with its
/// distances to the whole curve and those of its cognates.
const BETWEEN: u64 = 1500;
/// Positions per point of one judged candidate with its alternatives.
const JUDGED: u64 = 700;

fn job(closed: bool, timed: bool, set: &[(&str, &str)]) -> Job {
    let turn = if closed { TAU } else { 2.8 };
    let at = |j: usize| turn * j as f64 / POINTS as f64;
    let points: Vec<[f64; 2]> = (0..POINTS)
        .map(|j| {
            let t = at(j);
            [3.0 * t.cos() + 0.3 * (2.0 * t).sin(), 1.5 * t.sin() + 0.2 * (3.0 * t).cos()]
        })
        .collect();
    let timing = if timed {
        let angles: Vec<f64> = (0..POINTS).map(|j| at(j).to_degrees()).collect();
        format!("timing = {{ crank_deg = {angles:?}, offset = \"free\" }}\n")
    } else {
        String::new()
    };
    let text = format!("format = 1\n[task.path]\npoints = {points:?}\nclosed = {closed}\n{timing}");
    let set: Vec<(String, String)> = set.iter().map(|(k, v)| ((*k).into(), (*v).into())).collect();
    let file = parse("it.toml", &text, None, &set).expect("a problem");
    Job { name: "it".into(), source: None, unit: None, spec: file.spec, front: None }
}

/// Runs a job on one thread, stopped at the check `stop_at`.
fn counted(job: &Job, stop_at: Option<u64>) -> (Record, Counts) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    let flag = AtomicBool::new(false);
    pool.install(|| {
        begin(stop_at);
        let done = run(job, &Context { cancel: &flag, observer: &|_| {} }).expect("it runs");
        let counts = counts();
        begin(None);
        (done.record, counts)
    })
}

/// Returns the evaluations of a job: `of_every_day`, or four times as many with `THOROUGH=1`.
fn evaluations(of_every_day: u32) -> String {
    let times = if is_thorough() { 4 } else { 1 };
    (times * of_every_day).to_string()
}

/// Stops a job at some of its questions, spread over the run; with `THOROUGH=1`, at more.
fn asks_often_enough(name: &str, job: &Job) {
    let stops = if is_thorough() { 6 } else { 2 };
    let n = POINTS as u64;
    let (_, whole) = counted(job, None);
    assert!(whole.asked > 3, "{name}: {whole:?}");
    assert!(whole.most <= BETWEEN * n, "{name}: {} positions a point without a question", whole.most / n);
    for part in 0..stops {
        let at = 1 + whole.asked * part / stops;
        let (record, counts) = counted(job, Some(at));
        assert_eq!(
            record.termination.reason,
            Reason::Cancelled,
            "{name}, stopped at {at} of {}",
            whole.asked
        );
        assert!(!record.termination.reproducible);
        // The candidates that may still be judged, and the work under way.
        let most = JUDGED * (JUDGED_AFTER_STOP as u64 + n) + BETWEEN * n;
        assert!(counts.after <= most, "{name}: {} positions after a stop at {at}", counts.after);
        assert!(counts.most <= BETWEEN * n, "{name}: {counts:?}");
    }
}

#[test]
fn a_search_by_least_squares_asks_about_a_stop_often_enough() {
    for (name, closed, timed) in [("closed", true, false), ("open", false, false)] {
        asks_often_enough(name, &job(closed, timed, &[("solve.evaluations", &evaluations(750))]));
    }
    for (name, closed) in [("closed, timed", true), ("open, timed", false)] {
        asks_often_enough(name, &job(closed, true, &[("solve.evaluations", &evaluations(750))]));
    }
    let few = evaluations(750);
    let limits = [
        ("solve.evaluations", few.as_str()),
        ("require.transmission_deg_min", "60"),
        ("require.footprint_in", "[-4, -4, 4, 4]"),
    ];
    asks_often_enough("timed, with limits", &job(true, true, &limits));
}

#[test]
fn a_population_search_asks_about_a_stop_before_each_long_evaluation() {
    for method in ["genetic", "differential-evolution"] {
        for timed in [false, true] {
            let set = [
                ("solve.method", method),
                ("solve.evaluations", &evaluations(200)),
                ("solve.advice", "false"),
            ];
            asks_often_enough(method, &job(true, timed, &set));
        }
    }
}

#[test]
fn one_candidate_is_judged_after_a_stop_whatever_its_points_and_more_where_they_are_few() {
    let flag = AtomicBool::new(true);
    let stopped = Budget { cancel: &flag, deadline: None };
    let judged = |points: usize| {
        let judging = stopped.judging(points);
        (0..1000).take_while(|_| judging.may_go_on()).count()
    };
    assert_eq!(judged(100_000), 1);
    assert_eq!(judged(JUDGED_AFTER_STOP), 1);
    assert_eq!(judged(JUDGED_AFTER_STOP / 7), 7);
    let flag = AtomicBool::new(false);
    let going_on = Budget { cancel: &flag, deadline: None };
    let judging = going_on.judging(100_000);
    assert!((0..1000).all(|_| judging.may_go_on()));
}
