//! `verify` agrees with every record that a run writes: random problems with all requirements, near the origin and up to
//! 1e10 sizes away, read back from their bytes.
//!
//! `AGREEMENT_CASES=FROM..TO` runs other cases than the few of every day, such as 0..2000; it prints where it is.

#![expect(clippy::print_stderr, reason = "a run of many cases tells where it is")]

use crate::common::thorough::cases;
use crate::common::{bytes, job, parse};
use crate::problems::wide_case;
use linkwright::internals::app::job::folder::parse_record;
use linkwright::internals::app::job::run::{Context, run};
use linkwright::internals::files::problem_file::ProblemFile;
use linkwright::internals::judge::verify::{Mismatch, verify};
use linkwright::internals::record::{Reason, Record};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

const SEED: u64 = 20_261_122;
/// Cases of every day.
const CASES: u64 = 24;
/// After so many cases a line says how far it is.
const LINE_EVERY: u64 = 100;

fn asked() -> Option<Range<u64>> {
    let asked = std::env::var("AGREEMENT_CASES").ok()?;
    let (from, to) = asked.split_once("..").expect("FROM..TO");
    Some(from.parse().expect("a number")..to.parse().expect("a number"))
}

/// The record of a run.
fn recorded(file: ProblemFile) -> Record {
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    run(&job(file), &context).expect("it runs").record
}

/// What `verify` finds in a record as it is read back from disk.
fn mismatches(record: &Record) -> Vec<Mismatch> {
    let text = bytes(record);
    let read = parse_record("record.json", text.as_bytes()).unwrap_or_else(|e| panic!("{e:?}\n{text}"));
    verify(&read).expect("the problem is one")
}

#[test]
fn verify_agrees_with_every_record_that_a_run_writes() {
    let cases = asked().unwrap_or(0..CASES);
    let [done, problems, accepted, conflicts, buildable] = [(); 5].map(|()| AtomicU64::new(0));
    let count = |of: &AtomicU64, is: bool| of.fetch_add(u64::from(is), Ordering::Relaxed) + u64::from(is);
    let complaint = |index: u64| {
        let done = count(&done, true);
        if asked().is_some() && done.is_multiple_of(LINE_EVERY) {
            eprintln!("{done} of {} cases", cases.end - cases.start);
        }
        let case = wide_case(SEED, index)?;
        count(&problems, true);
        let spec = &case.file.spec;
        let [weight, tolerance] = [&spec.task.weight, &spec.task.tolerance];
        let beside = format!(
            "weight {weight:?}, tolerance {tolerance:?}, advice {}, closing {:?}",
            spec.solve.advice, spec.require.closing
        );
        let record = recorded(case.file);
        count(&accepted, record.candidates.iter().any(|c| c.accepted));
        count(&conflicts, record.conflict.is_some());
        count(&buildable, record.buildable.is_some());
        let found = mismatches(&record);
        let words: Vec<String> = found.iter().take(5).map(ToString::to_string).collect();
        let told = || format!("case {}: {}\n{}{beside}", case.index, words.join("\n"), case.text);
        let complaint = (!found.is_empty()).then(told);
        if let Some(complaint) = complaint.as_ref().filter(|_| asked().is_some()) {
            // At once: a long run may be stopped.
            eprintln!("{complaint}");
        }
        complaint
    };
    let wrong: Vec<String> = cases.clone().into_par_iter().filter_map(complaint).collect();
    let [problems, accepted, conflicts, buildable] =
        [problems, accepted, conflicts, buildable].map(AtomicU64::into_inner);
    if asked().is_some() {
        eprintln!(
            "{problems} problems, {} not verified; {accepted} with an accepted answer, {conflicts} with a conflict, \
             {buildable} with a buildable one beside the first",
            wrong.len()
        );
    }
    assert!(wrong.is_empty(), "seed {SEED}, {} of {problems}:\n{}", wrong.len(), wrong.join("\n\n"));
    // A test of records needs some of each kind.
    assert!(cases.end - cases.start < CASES || (accepted > 0 && conflicts > 0), "{accepted} and {conflicts}");
    assert!(problems * 2 > cases.end - cases.start, "{problems} problems");
}

/// Cases of the sweep that were not verified: nine points whose mechanisms have a point at a toggle, or steps of half a
/// turn, and a list of exact linkages whose ranks were those before a design met under way took the first place.
#[test]
fn verify_agrees_where_it_once_did_not() {
    for index in [8376, 13_947, 9962, 12_808].into_iter().take(cases(2, 4)) {
        let case = wide_case(SEED, index).expect("a problem");
        let record = recorded(case.file);
        assert!(record.exact.as_ref().is_some_and(|exact| !exact.linkages.is_empty()), "case {index}");
        let found = mismatches(&record);
        assert!(found.is_empty(), "case {index}: {found:?}");
    }
}

/// Three points 1e8 sizes from the origin: a search around their centre meets them, and out there rounding is more than
/// what counts as exact.
#[test]
fn points_that_are_met_around_their_centre_alone_are_no_target_reached() {
    let text = "format = 1\n[task.path]\npoints = [[9935951.20506579, 2829747.87739839], [9935951.178817904, \
                2829747.881385801], [9935951.183649616, 2829747.9040952353]]\ntolerance = [0.00013436449566465845, \
                0.017994329360168208, 0.0019980034215379733]\n[require]\ntype = [\"double-crank\", \
                \"crank-rocker\"]\ntransmission_deg_min = 15.973317189664494\ntransmission_over = \
                \"used\"\nlink_ratio_max = 19.073332882511384\norder = \"any\"\ndirection = \"ccw\"\nbranch = \
                \"any\"\n[solve]\nevaluations = 15708\ncandidates = 3\nseed = 31\nadvice = false\n";
    let record = recorded(parse(text));
    assert!(record.candidates.iter().any(|c| c.accepted), "{:?}", record.termination);
    assert_eq!(mismatches(&record), Vec::new());
    assert_ne!(record.termination.reason, Reason::TargetReached);
}
