//! Words for a search: what it is doing, how it ended, how sure its answer is, and which requirements conflict.

use super::messages::Sure;
use crate::record::{Completeness, ExactRecord, Reason, Record};
use crate::report::{exact, table};
use crate::synthesis::{HitsSoFar, Progress};
use crate::task::requirement::RequirementKind;

/// Describes the activity of a search.
pub(super) fn under_way(progress: &Progress) -> String {
    match (progress.phase, progress.accepted) {
        ("what would help", _) => "Nothing acceptable was found: trying which change would help.".into(),
        ("continuation", _) => "Following the solution paths to their ends.".into(),
        (_, false) if progress.best_sum_sq.is_some() => "Searching: nothing acceptable yet.".into(),
        _ => match progress.hits {
            Some(HitsSoFar { came, wanted }) => {
                format!("Searching for better ones; the best came {} of {wanted} times.", came.min(wanted))
            }
            None => "Searching for better ones.".into(),
        },
    }
}

/// Describes how a search ended and how sure its best answer is.
pub(super) fn ended(record: &Record, hits: Option<HitsSoFar>) -> (Option<Sure>, String) {
    let end = table::ending_sentences(record);
    let (level, said) = match record.candidates.first() {
        None => (None, "Nothing was found.".to_owned()),
        Some(best) if best.accepted => {
            let (level, said) = sure(record, hits);
            (Some(level), said)
        }
        // The hits of attempts with other requirements say nothing about this one.
        Some(_) => (None, format!("{} {}", in_the_way(record), sure(record, None).1)),
    };
    (level, format!("{said}\n{end}"))
}

/// Describes how sure it is that nothing better was missed.
fn sure(record: &Record, hits: Option<HitsSoFar>) -> (Sure, String) {
    if let Some(of_record) = record.exact.as_ref().filter(|_| record.method.used == ["continuation"]) {
        let (noun, targets) = (exact::noun(of_record), exact::targets(of_record));
        return match of_record.completeness {
            Completeness::Complete => {
                let why = "by the count of targets in general position";
                (Sure::Sure, format!("These are all {noun}s through the {targets}, {why}."))
            }
            _ => (Sure::Fairly, format!("Some {noun}s through the {targets} may be missing.")),
        };
    }
    let came = match hits {
        Some(HitsSoFar { came, .. }) => format!("came from {came} independent rounds of starts"),
        None => "was found again and again from different starts".into(),
    };
    let fairly = |why: &str| (Sure::Fairly, format!("Fairly sure: {why}."));
    let not = |why: &str| (Sure::Not, format!("Not sure: {why}."));
    match record.termination.reason {
        Reason::Converged => (Sure::Sure, format!("Sure as far as sampling can be: the best {came}.")),
        Reason::TargetReached => (
            Sure::Sure,
            "Sure: the points are met to the last digit, and nothing is better than that.".into(),
        ),
        Reason::Stalled => fairly("every kind of start was tried, and the last of them gave nothing better"),
        Reason::EvaluationLimit => match hits {
            Some(HitsSoFar { came, wanted }) if came >= wanted => {
                fairly(&format!("the best came {came} times; the budget ended before the search was done"))
            }
            Some(HitsSoFar { came, wanted }) => {
                not(&format!("the budget ended when the best had come {came} of {wanted} times"))
            }
            None => not("the budget of evaluations ended"),
        },
        Reason::TimeLimit | Reason::Cancelled => not("it was cut short"),
        Reason::Snapped => not("its lengths were brought to stock sizes, nothing else was searched for"),
        Reason::ByHand => not("it was fitted under the hand, no search has looked for anything better"),
    }
}

/// Returns a requirement as the page calls it: by the label of its control.
pub(super) fn plain(key: &str) -> String {
    let bounds = || key.strip_prefix("design.").map_or(key.to_owned(), |key| format!("the bounds of {key}"));
    RequirementKind::with_key(key).map_or_else(bounds, |kind| format!("“{}”", kind.definition().plain))
}

/// Names the requirements that are not met together, and says whether a change helps.
fn in_the_way(record: &Record) -> String {
    let among = record.conflict.as_ref().map_or(&[][..], |conflict| &conflict.among);
    let named: Vec<String> = among.iter().map(|key| plain(key)).collect();
    let way = match named.as_slice() {
        [] => "Nothing acceptable was found.".to_owned(),
        [only] => format!("Nothing acceptable was found: {only} asks for too much."),
        [most @ .., last] => {
            format!("Nothing acceptable was found: {} and {last} conflict.", most.join(", "))
        }
    };
    let help = match record.relaxations.as_slice() {
        [] => "No single change that helps was found.",
        [_] => "One change was found that helps: see below.",
        _ => "Changes were found that help: see below.",
    };
    format!("{way} {help}")
}

/// Counts all linkages through nine points in words, with proofs if there are any.
pub(super) fn census(record: &ExactRecord) -> Vec<String> {
    if record.completeness == Completeness::NonGeneric && record.census.classes == 0 {
        return vec![format!(
            "No {} was found that passes all {}: they are in special position, such as on one line.",
            exact::noun(record),
            exact::targets(record)
        )];
    }
    let [found, real, paths, proof] = exact::sentences(record);
    let counted = &record.census;
    // Solutions are known to be isolated by their proofs.
    match (counted.certified, record.completeness) {
        (0, Completeness::Complete) => vec![found, real],
        (0, _) => vec![format!("{} solutions so far, not yet proved.", counted.classes), real],
        _ => vec![found, real, paths, proof],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::job::run::{Context, Job, run};
    use crate::files::problem_file::parse;
    use std::sync::atomic::AtomicBool;

    #[test]
    fn a_budget_that_ends_after_the_best_came_often_enough_is_told_as_that() {
        let text = "format = 1\n[task.path]\npoints = [[0, 0], [1, 1], [2, 1.2], [3, 1], [2, -1], [1, -1]]\nclosed = true\n\
            [solve]\nevaluations = 300\n";
        let job = Job::from(parse("egg", text, None, &[]).expect("a problem"));
        let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
        let record = run(&job, &context).expect("it runs").record;
        assert_eq!(record.termination.reason, Reason::EvaluationLimit);
        let said = |came| sure(&record, Some(HitsSoFar { came, wanted: 4 })).1;
        assert_eq!(said(3), "Not sure: the budget ended when the best had come 3 of 4 times.");
        assert_eq!(
            said(15),
            "Fairly sure: the best came 15 times; the budget ended before the search was done."
        );
    }
}
