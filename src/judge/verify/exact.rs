//! Verification of exact linkages: the census adds up, and each linkage passes the points, has the stated abilities,
//! and is proved again. (Whether the census is complete takes a search of its own: run it.)

use super::Comparison;
use crate::judge::assess::assess;
use crate::judge::certified::{certified, nearly_exact, same, target};
use crate::judge::exact_linkages::{Recomputed, class_at};
use crate::record::{
    Candidate, Certified, Completeness, ExactForm, ExactLinkage, ExactRecord, Reason, Record,
};
use crate::task::forms::precision::counted;

/// The factor by which the radius of a recomputed proof may differ: it is an upper bound that depends on rounding.
const WIDER: f64 = 1.5;

/// The distance of a target from the origin, in its sizes, beyond which the class of a listed linkage cannot be found
/// again: so far away, coordinates are rounded to 1e-10 of its size, by which a mechanism may miss the points.
const FOUND_AGAIN: f64 = 2e4;

impl Comparison<'_> {
    /// Checks the proofs of the candidates, the census, and every exact linkage.
    pub(super) fn exact(&mut self, record: &Record) {
        let problem = self.problem;
        let target = target(problem);
        for candidate in record.candidates.iter().chain(&record.buildable) {
            let found = || target.as_ref().and_then(|target| certified(problem, target, candidate));
            self.of_candidate(candidate.rank).proof(candidate.certified, found);
        }
        let Some(exact) = &record.exact else { return };
        self.census(exact, record.termination.reason == Reason::Cancelled);
        let counted = counted(problem);
        self.same("exact.kind", exact.kind, counted.kind);
        self.same("exact.poses", exact.poses, counted.poses);
        self.same("exact.pivots", exact.pivots, counted.pivots);
        let Some(target) = target else {
            let wanted = "points and poses that have finitely many answers";
            return self.differ("exact", wanted, "a task without");
        };
        let far = target.target.points.iter().map(|point| point.norm()).fold(0.0, f64::max);
        let found_again = far <= FOUND_AGAIN * problem.task().size();
        for (i, listed) in exact.linkages.iter().enumerate() {
            let mut own = self.under(&format!("exact.linkages {}: ", i + 1));
            let at = (&listed.linkage, listed.crank_deg.as_slice(), listed.t1_at.as_slice());
            if !found_again {
                // The linkage itself is judged nevertheless.
                let n = problem.task().len();
                let counts = listed.crank_deg.len() == n && listed.t1_at.len() == n;
                match counts.then(|| assess(problem, at.0, at.1, at.2)).flatten() {
                    Some(found) => own.figures(listed, &found),
                    None => own.differ("the linkage", "closed at every point", "not that"),
                }
                continue;
            }
            let Some(class) = class_at(problem, &target, at) else {
                own.differ("the linkage", "one that passes all points", "not that");
                continue;
            };
            if let Some(found) = &class.judged {
                own.figures(listed, found);
                own.proof(listed.certified, || certified(problem, &target, found));
            }
            own.class(listed, &class, &record.candidates);
        }
    }

    /// Checks the abilities of a class, its other mechanisms, and the rank of the candidate that is one of them.
    fn class(&mut self, listed: &ExactLinkage, class: &Recomputed, candidates: &[Candidate]) {
        self.assembly(&listed.linkage, &listed.t1_at);
        let all = [listed.one_circuit, listed.in_order, listed.free_of_defects];
        // An ability in doubt keeps its recorded value.
        let [first, second, third] = class.abilities;
        let found = [(all[0], first), (all[1], second), (all[2], third)]
            .map(|(is, can)| can.certain || is && can.possible);
        self.alike("what the class can do", &all, &found);
        self.others(listed, &class.forms);
        let places = nearly_exact(self.problem);
        let of_class = |c: &&Candidate| {
            c.error.sum_sq <= places && class.forms.iter().any(|(form, _)| same(&form.linkage, &c.linkage))
        };
        self.same("rank", listed.rank, candidates.iter().rfind(of_class).map_or(0, |c| c.rank));
    }

    /// Checks the other mechanisms of a class: all that pass the points beyond doubt are listed, each with its type and
    /// defects.
    fn others(&mut self, listed: &ExactLinkage, forms: &[(ExactForm, bool)]) {
        for (i, other) in listed.others.iter().enumerate() {
            let mut own = self.under(&format!("others {}: ", i + 1));
            let Some((found, certain)) = forms.iter().find(|(form, _)| same(&form.linkage, &other.linkage))
            else {
                own.differ("the linkage", "a mechanism of the class", "none of them");
                continue;
            };
            own.assembly(&other.linkage, &[found.linkage.assembly()]);
            own.same("type", other.type_name(), found.type_name());
            if *certain {
                own.alike("defects", &other.defects, &found.defects);
            }
        }
        let recorded = || listed.others.iter().map(|form| &form.linkage).chain([&listed.linkage]);
        let missing = |(form, beyond_doubt): &&(ExactForm, bool)| {
            *beyond_doubt && !recorded().any(|linkage| same(linkage, &form.linkage))
        };
        let count = listed.others.len();
        self.same("others", count, count + forms.iter().filter(missing).count());
    }

    /// Compares a recorded proof, if there is one, with the recomputed one.
    fn proof(&mut self, recorded: Option<Certified>, found: impl FnOnce() -> Option<Certified>) {
        let Some(recorded) = recorded else { return };
        let found = found();
        let near = |one: f64, other: f64| one <= WIDER * other;
        let holds = found
            .is_some_and(|found| near(found.radius, recorded.radius) && near(recorded.radius, found.radius));
        if !holds {
            let words = |c: Certified| format!("{:e}", c.radius);
            self.differ("certified.radius", words(recorded), found.map_or("no proof".into(), words));
        }
    }

    fn census(&mut self, exact: &ExactRecord, cancelled: bool) {
        let c = &exact.census;
        let list = &exact.linkages;
        let many = |of: fn(&ExactLinkage) -> bool| list.iter().filter(|l| of(l)).count();
        let sums = [
            ("tracked", c.tracked, c.finite + c.singular + c.failed),
            ("finite", c.finite, c.classes + c.duplicate),
            ("classes", c.classes, c.real + c.real_curve + c.complex),
            ("certified", c.certified, c.classes.saturating_sub(c.not_certified)),
            ("reality_proved", c.reality_proved, c.reality_proved.min(c.certified)),
            ("real", c.real, c.degenerate + list.len()),
            ("one_circuit", c.one_circuit, many(|l| l.one_circuit)),
            ("in_order", c.in_order, many(|l| l.in_order)),
            ("free_of_defects", c.free_of_defects, many(|l| l.free_of_defects)),
        ];
        for (name, recorded, found) in sums {
            self.under("exact.census.").same(name, recorded, found);
        }
        // A search that was cancelled records only that.
        let found = if cancelled && exact.completeness == Completeness::Cancelled {
            Completeness::Cancelled
        } else if c.classes == exact.generic_classes() {
            Completeness::Complete
        } else if c.failed == 0 && c.singular > 0 && c.singular >= c.duplicate {
            Completeness::NonGeneric
        } else {
            Completeness::Incomplete
        };
        self.alike("exact.completeness", &exact.completeness, &found);
        self.same("exact.generic", exact.generic, c.classes == exact.generic_classes());
    }

    fn figures(&mut self, listed: &ExactLinkage, found: &Candidate) {
        self.number("miss", listed.miss, found.error.max, found.linkage.longest_link());
        let worst = found.transmission_deg.worst;
        self.transmission("transmission_worst_deg", listed.transmission_worst_deg, worst);
        self.number("link_ratio", listed.link_ratio, found.link_ratio, 1.0);
        self.same("type", listed.type_name(), found.type_name());
        self.alike("defects", &listed.defects, &found.defects);
        self.verdict(found, listed.accepted, &listed.not_met);
    }
}
