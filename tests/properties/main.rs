//! What is called accepted is acceptable: random targets under random requirements, each record verified and
//! each accepted candidate checked again by code that shares nothing with the judge.

#[path = "../common/mod.rs"]
mod common;
mod plain;
mod problems;
#[path = "../common/random.rs"]
mod random;

use common::{bytes, run_on};
use linkwright::verify::verify;
use problems::case;

const SEED: u64 = 20_261_121;
const CASES: u64 = 400;

/// A range of cases from the environment, to look at one alone: `PROPERTY_CASES=17..18`.
fn cases() -> std::ops::Range<u64> {
    let Ok(asked) = std::env::var("PROPERTY_CASES") else { return 0..CASES };
    let (from, to) = asked.split_once("..").expect("FROM..TO");
    from.parse().expect("a number")..to.parse().expect("a number")
}

#[test]
fn whatever_is_called_accepted_is_acceptable() {
    let (mut problems, mut accepted, mut wrong) = (0, 0, Vec::new());
    for index in cases() {
        let Some(case) = case(SEED, index) else { continue };
        problems += 1;
        let text = case.text.clone();
        let spec = case.file.spec.clone();
        let record = run_on(1, case.file);
        let mut complaints: Vec<String> =
            verify(&record).expect("the problem is one").iter().map(ToString::to_string).collect();
        if record.candidates.iter().any(|c| c.accepted) {
            accepted += 1;
        }
        for candidate in record.candidates.iter().filter(|c| c.accepted) {
            let found = plain::complaints(&spec, candidate);
            complaints
                .extend(found.into_iter().map(|c| format!("accepted candidate {}: {c}", candidate.rank)));
        }
        if !complaints.is_empty() {
            let beside = [("weight", &spec.task.path.weight), ("tolerance", &spec.task.path.tolerance)];
            complaints.truncate(5);
            wrong.push(format!("case {index}: {}\n{text}{beside:?}", complaints.join("\n")));
        }
    }
    assert!(wrong.is_empty(), "seed {SEED}, {} of {problems}:\n{}", wrong.len(), wrong.join("\n\n"));
    println!("{problems} problems, {accepted} with an accepted answer");
    if cases() == (0..CASES) {
        // A test of accepted candidates needs some.
        assert!(problems * 10 >= CASES * 8, "{problems} problems of {CASES} draws");
        assert!(accepted * 4 >= problems, "{accepted} of {problems} problems have an accepted answer");
    }
}

#[test]
fn one_and_two_threads_give_equal_bytes() {
    let twice = |index| Some((case(SEED, index)?, case(SEED, index)?));
    let mut seen = 0;
    for (one, two) in (0..).step_by(7).filter_map(twice).take(10) {
        seen += 1;
        assert_eq!(
            bytes(&run_on(1, one.file)),
            bytes(&run_on(2, two.file)),
            "case {}:\n{}",
            one.index,
            one.text
        );
    }
    assert_eq!(seen, 10);
}
