//! Verification of the other parts of a record: warnings, alternatives, the family, the buildable candidate.

use super::{ABSOLUTE, Against, Mismatch, verdict};
use crate::judge::assess::assess;
use crate::judge::cognates::{first_apart, has_error_of};
use crate::judge::family::family;
use crate::judge::symmetry::mirror_image_serves;
use crate::judge::warnings::{is_serious, warnings};
use crate::record::{Alternative, Candidate, Record};
use crate::task::Problem;

/// Checks everything in the record apart from the candidates' figures.
pub(super) fn extras(problem: &Problem, record: &Record, mismatches: &mut Vec<Mismatch>) {
    for candidate in record.candidates.iter().chain(&record.buildable) {
        let mut against = Against { rank: candidate.rank, mismatches };
        against.warnings(problem, candidate);
        let serves = mirror_image_serves(problem, candidate);
        if candidate.mirror_serves != serves {
            against.differ("mirror_serves", candidate.mirror_serves.to_string(), serves.to_string());
        }
        for (i, alternative) in candidate.alternatives.iter().enumerate() {
            against.alternative(problem, candidate, alternative, i + 1);
        }
    }
    let mut whole = |what: &str, recorded: String, found: String| {
        if recorded != found {
            mismatches.push(Mismatch { rank: None, what: what.into(), recorded, found });
        }
    };
    let words = |family: Option<&crate::record::Family>| {
        family.map_or("none".to_string(), |f| format!("{}, exact {}: {}", f.dimension, f.exact, f.text))
    };
    let first = record.candidates.first();
    let found = first.and_then(|best| family(problem, best));
    whole("family", words(record.family.as_ref()), words(found.as_ref()));
    let Some(buildable) = &record.buildable else { return };
    let known = record.candidates.iter().find(|c| {
        (c.linkage, &c.crank_deg, &c.t1_at) == (buildable.linkage, &buildable.crank_deg, &buildable.t1_at)
    });
    let rank = known.map_or(0, |c| c.rank);
    whole("buildable.rank", buildable.rank.to_string(), rank.to_string());
    whole("buildable.accepted", buildable.accepted.to_string(), "true".into());
    let needed = first.is_some_and(|best| !best.warnings.is_empty());
    if !needed {
        whole("buildable", "there".into(), "not called for: the first candidate has no warnings".into());
    }
    let serious = first.is_some_and(|best| best.warnings.iter().any(is_serious));
    let mut against = Against { rank: buildable.rank, mismatches };
    against.candidate(problem, buildable);
    if let Some(w) = warnings(problem, buildable).iter().find(|w| is_serious(w) || !serious) {
        against.differ("buildable", "free of what the first candidate is warned of".into(), w.text.clone());
    }
}

impl Against<'_> {
    /// Checks that the warnings are exactly those of the recorded figures.
    fn warnings(&mut self, problem: &Problem, recorded: &Candidate) {
        let found = warnings(problem, recorded);
        if recorded.warnings != found {
            let words = |list: &[crate::record::Warning]| {
                let texts: Vec<String> = list
                    .iter()
                    .map(|w| format!("{} {}: {} ({} / {})", w.kind.name(), w.key, w.text, w.value, w.limit))
                    .collect();
                if texts.is_empty() { "none".to_string() } else { texts.join("; ") }
            };
            self.differ("warnings", words(&recorded.warnings), words(&found));
        }
    }

    fn alternative(&mut self, problem: &Problem, candidate: &Candidate, recorded: &Alternative, nth: usize) {
        let what = |figure: &str| format!("alternative {nth}: {figure}");
        let n = problem.task().len();
        if recorded.crank_deg.len() != n || recorded.t1_at.len() != n {
            let has = format!("{} and {}", recorded.crank_deg.len(), recorded.t1_at.len());
            self.differ(&what("the number of crank_deg and t1_at"), has, format!("{n} points"));
            return;
        }
        let found = assess(problem, &recorded.linkage, &recorded.crank_deg, &recorded.t1_at);
        let Some(mut found) = found else {
            self.differ(&what("the linkage"), "closed at every point".into(), "open at one".into());
            return;
        };
        let size = problem.task().size();
        let sum = found.error.sum_sq;
        let slack = size * size * ABSOLUTE + 2.0 * size * sum.sqrt() * (n as f64).sqrt();
        self.number(&what("sum_sq"), recorded.sum_sq, sum, slack);
        if !has_error_of(problem, candidate, (&recorded.linkage, sum), 2.0) {
            self.differ(&what("the error"), "the candidate's".into(), format!("{sum:e}"));
        }
        self.number(&what("link_ratio"), recorded.link_ratio, found.link_ratio, 1.0);
        let worst = found.transmission_deg.worst;
        let from_flat = worst.max(1e-5).to_radians().sin();
        self.number(
            &what("transmission_worst_deg"),
            recorded.transmission_worst_deg,
            worst,
            180.0 / from_flat,
        );
        if recorded.linkage_type != found.linkage_type {
            self.differ(&what("type"), recorded.linkage_type.to_string(), found.linkage_type.to_string());
        }
        let said = |name: &str| recorded.not_met.iter().any(|not_met| not_met == name);
        let (not_met, accepted) = verdict(problem, &found, &said);
        if recorded.accepted != accepted {
            self.differ(&what("accepted"), recorded.accepted.to_string(), accepted.to_string());
        }
        if recorded.not_met != not_met {
            self.differ(&what("not_met"), recorded.not_met.join(", "), not_met.join(", "));
        }
        // The curve is the same if the coupler point is the same at every point of the target.
        let apart = first_apart(
            problem.task().size(),
            (&candidate.linkage, &candidate.crank_deg, &candidate.t1_at),
            (&recorded.linkage, &recorded.crank_deg, &recorded.t1_at),
        );
        if let Some(i) = apart {
            self.differ(
                &what("the coupler point"),
                "the candidate's".into(),
                format!("elsewhere at point {i}"),
            );
        }
        self.assembly(&what("linkage.t1"), &recorded.linkage, &recorded.t1_at);
        found.rank = candidate.rank;
        self.timing(problem, &found);
    }
}
