//! Verification of the other parts of a record: warnings, alternatives, the family, the buildable candidate.

use super::Comparison;
use super::comparison::RELATIVE;
use crate::judge::cognates::{first_apart, has_error_of};
use crate::judge::family::family;
use crate::judge::symmetry::mirror_image_serves;
use crate::judge::warnings::{is_serious, warnings};
use crate::record::{Alternative, BestOfKind, Candidate, Family, Record, Warning};

impl Comparison<'_> {
    /// Checks everything in the record apart from the candidates' figures.
    pub(super) fn extras(&mut self, record: &Record) {
        for candidate in record.candidates.iter().chain(&record.buildable).chain(&record.other_kind) {
            self.of_candidate(candidate.rank).annotations(candidate);
        }
        let words = |family: Option<&Family>| {
            family.map_or("none".to_string(), |f| format!("{}, exact {}: {}", f.dimension, f.exact, f.text))
        };
        let first = record.candidates.first();
        let found = first.and_then(|best| family(self.problem, best));
        self.same("family", words(record.family.as_ref()), words(found.as_ref()));
        if let Some(buildable) = &record.buildable {
            self.buildable(record, buildable);
        }
        if let Some(other) = &record.other_kind {
            self.other_kind(record, other);
        }
        self.of_kinds(record);
    }

    /// Checks that a linkage of another kind is offered only where no candidate is accepted, and all of its figures.
    fn other_kind(&mut self, record: &Record, other: &Candidate) {
        if record.candidates.iter().any(|c| c.accepted) {
            self.differ("other_kind", "there", "not called for: there is an accepted candidate");
        }
        if self.problem.spec().design.searches(other.linkage.kind()) {
            self.differ("other_kind", other.linkage.kind(), "a kind that is searched for");
        }
        self.same("other_kind.rank", other.rank, 0);
        self.same("other_kind.accepted", other.accepted, true);
        let mut own = self.of_candidate(0);
        own.candidate(other);
    }

    /// Checks that the best of each kind are kinds that are searched for, and no worse than the candidates.
    fn of_kinds(&mut self, record: &Record) {
        if !record.of_kinds.is_empty() && !record.problem.resolved.design.compares_kinds() {
            return self.differ("of_kinds", "there", "not called for: one kind is searched for");
        }
        for (i, best) in record.of_kinds.iter().enumerate() {
            let mut own = self.under(&format!("of_kinds.{}.", best.kind));
            let twice = record.of_kinds[..i].iter().any(|other| other.kind >= best.kind);
            if twice || !own.problem.spec().design.searches(best.kind) {
                own.differ("kind", best.kind, "each kind that is searched for once, the simplest first");
            }
            let mut of_kind = record.candidates.iter().filter(|c| c.linkage.kind() == best.kind);
            match of_kind.next().map(BestOfKind::of) {
                // Its figures are recomputed where it is listed.
                Some(first) if first != *best => own.differ("rms", best.rms, first.rms),
                _ => {}
            }
            if best.max < best.rms * (1.0 - RELATIVE) {
                own.differ("max", best.max, format!("at least the rms error, {:e}", best.rms));
            }
        }
    }

    /// Checks the warnings of a candidate, whether its mirror image serves, and its alternatives.
    pub(super) fn annotations(&mut self, candidate: &Candidate) {
        self.warnings(candidate);
        let serves = mirror_image_serves(self.problem, candidate);
        self.same("mirror_serves", candidate.mirror_serves, serves);
        for (i, alternative) in candidate.alternatives.iter().enumerate() {
            self.under(&format!("alternative {}: ", i + 1)).alternative(candidate, alternative);
        }
    }

    /// Checks that a candidate beside the ranked ones has the rank of the equal one, 0 if there is none.
    pub(super) fn rank_beside(&mut self, record: &Record, candidate: &Candidate) {
        let known = record.candidates.iter().find(|c| {
            (c.linkage, &c.crank_deg, &c.t1_at) == (candidate.linkage, &candidate.crank_deg, &candidate.t1_at)
        });
        self.same("rank", candidate.rank, known.map_or(0, |c| c.rank));
    }

    fn buildable(&mut self, record: &Record, buildable: &Candidate) {
        self.under("buildable.").rank_beside(record, buildable);
        self.same("buildable.accepted", buildable.accepted, true);
        let warned = record.candidates.first().map_or(&[][..], |best| &best.warnings);
        if warned.is_empty() {
            self.differ("buildable", "there", "not called for: the first candidate has no warnings");
        }
        let serious = warned.iter().any(is_serious);
        let mut own = self.of_candidate(buildable.rank);
        own.candidate(buildable);
        if let Some(w) = warnings(own.problem, buildable).iter().find(|w| is_serious(w) || !serious) {
            own.differ("buildable", "free of what the first candidate is warned of", &w.text);
        }
    }

    /// Checks that the warnings are exactly those of the recorded figures.
    fn warnings(&mut self, recorded: &Candidate) {
        let found = warnings(self.problem, recorded);
        if recorded.warnings != found {
            let word =
                |w: &Warning| format!("{} {}: {} ({} / {})", w.kind.name(), w.key, w.text, w.value, w.limit);
            let words = |list: &[Warning]| {
                let texts: Vec<String> = list.iter().map(word).collect();
                if texts.is_empty() { "none".to_string() } else { texts.join("; ") }
            };
            self.differ("warnings", words(&recorded.warnings), words(&found));
        }
    }

    fn alternative(&mut self, candidate: &Candidate, recorded: &Alternative) {
        let at = (&recorded.linkage, recorded.crank_deg.as_slice(), recorded.t1_at.as_slice());
        let Some(found) = self.judged(at, None, "open at one") else { return };
        let (size, n) = (self.problem.task().size(), self.problem.task().len());
        let sum = found.error.sum_sq;
        self.sum_sq("sum_sq", recorded.sum_sq, sum, n);
        if !has_error_of(self.problem, candidate, (&recorded.linkage, sum), 2.0) {
            self.differ("the error", "the candidate's", format!("{sum:e}"));
        }
        self.number("link_ratio", recorded.link_ratio, found.link_ratio, 1.0);
        let worst = found.transmission_deg.worst;
        self.transmission("transmission_worst_deg", recorded.transmission_worst_deg, worst);
        self.same("type", recorded.type_name(), found.type_name());
        self.verdict(&found, recorded.accepted, &recorded.not_met);
        // The curve is the same if the coupler point is the same at every point of the target.
        let of_candidate = (&candidate.linkage, candidate.crank_deg.as_slice(), candidate.t1_at.as_slice());
        if let Some(i) = first_apart(size, of_candidate, at) {
            self.differ("the coupler point", "the candidate's", format!("elsewhere at point {i}"));
        }
        self.assembly(&recorded.linkage, &recorded.t1_at);
        // A function has no cognates.
        self.timing(&recorded.linkage, &recorded.crank_deg, 1.0);
    }
}
