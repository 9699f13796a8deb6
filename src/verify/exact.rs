//! Exact answers, recomputed: the census adds up, each linkage passes the points, can do what is said of it, and is
//! proved again. (That the census is complete is a search of its own: run it.)

use super::{Against, Mismatch};
use crate::problem::Problem;
use crate::record::{Candidate, Certified, Completeness, ExactLinkage, ExactRecord, GENERIC_CLASSES, Record};
use crate::search::continuation::{certified, same, target};
use crate::search::exact_linkages::class_at;

/// A proof found again may be wider by this factor.
const WIDER: f64 = 1.5;

pub(super) fn exact(problem: &Problem, record: &Record, mismatches: &mut Vec<Mismatch>) {
    let target = target(problem);
    for candidate in record.candidates.iter().chain(&record.buildable) {
        let Some(recorded) = candidate.certified else { continue };
        let found = target.as_ref().and_then(|target| certified(target, candidate));
        let mut against = Against { rank: candidate.rank, mismatches };
        if let Some((recorded, found)) = proof(recorded, found) {
            against.differ("certified.radius", recorded, found);
        }
    }
    let Some(exact) = &record.exact else { return };
    let mut whole = |what: &str, recorded: String, found: String| {
        if recorded != found {
            mismatches.push(Mismatch { rank: None, what: what.into(), recorded, found });
        }
    };
    census(exact, &mut whole);
    let Some(target) = target else {
        whole("exact", "nine points and what passes through them".into(), "not nine points".into());
        return;
    };
    for (i, listed) in exact.linkages.iter().enumerate() {
        let mut whole = |figure: &str, recorded: String, found: String| {
            whole(&format!("exact.linkages {}: {figure}", i + 1), recorded, found);
        };
        let at = (&listed.linkage, listed.crank_deg.as_slice(), listed.t1_at.as_slice());
        let Some(class) = class_at(problem, &target, at) else {
            whole("the linkage", "one that passes all points".into(), "not that".into());
            continue;
        };
        if let Some(found) = class.judged {
            figures(listed, &found, &mut whole);
            if let Some(recorded) = listed.certified
                && let Some((recorded, found)) = proof(recorded, certified(&target, &found))
            {
                whole("certified.radius", recorded, found);
            }
        }
        let all = [listed.one_circuit, listed.in_order, listed.free_of_defects];
        whole("what the class can do", format!("{all:?}"), format!("{:?}", class.abilities));
        let known = |form: &crate::linkage::FourBar| class.forms.iter().any(|other| same(other, form));
        let count = listed.others.iter().filter(|form| known(&form.linkage)).count();
        whole("others", listed.others.len().to_string(), count.to_string());
        let ranked = record.candidates.iter().find(|c| class.forms.iter().any(|form| same(form, &c.linkage)));
        let near = record.candidates.get(listed.rank.wrapping_sub(1));
        if listed.rank > 0 && !near.is_some_and(|c| class.forms.iter().any(|form| same(form, &c.linkage))) {
            whole("rank", listed.rank.to_string(), ranked.map_or(0, |c| c.rank).to_string());
        }
    }
}

/// Both in words where the recorded proof says more than is found.
fn proof(recorded: Certified, found: Option<Certified>) -> Option<(String, String)> {
    let holds = found.is_some_and(|found| found.radius <= WIDER * recorded.radius);
    let words = |c: Certified| format!("{:e}", c.radius);
    (!holds).then(|| (words(recorded), found.map_or("no proof".into(), words)))
}

fn census(exact: &ExactRecord, whole: &mut dyn FnMut(&str, String, String)) {
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
        whole(&format!("exact.census.{name}"), recorded.to_string(), found.to_string());
    }
    let complete = exact.completeness == Completeness::Complete;
    whole("exact.completeness", format!("complete: {complete}"), format!("complete: {}", exact.generic));
    if exact.completeness == Completeness::NonGeneric && c.failed + c.duplicate > 0 {
        whole(
            "exact.completeness",
            "non-generic".into(),
            "incomplete: paths were lost or ended together".into(),
        );
    }
    whole("exact.generic", exact.generic.to_string(), (c.classes == GENERIC_CLASSES).to_string());
}

fn figures(listed: &ExactLinkage, found: &Candidate, whole: &mut dyn FnMut(&str, String, String)) {
    let mut number = |what: &str, recorded: f64, found: f64, slack: f64| {
        let near = (recorded - found).abs() <= super::RELATIVE * found.abs() + slack;
        if !near {
            whole(what, format!("{recorded:e}"), format!("{found:e}"));
        }
    };
    let span = found.linkage.longest_link();
    number("miss", listed.miss, found.error.max, super::ABSOLUTE * span);
    // Degrees, and near a toggle those of a small difference.
    let from_flat = found.transmission_deg.worst.max(1e-5).to_radians().sin();
    let worst = found.transmission_deg.worst;
    number(
        "transmission_worst_deg",
        listed.transmission_worst_deg,
        worst,
        super::ABSOLUTE * 180.0 / from_flat,
    );
    number("link_ratio", listed.link_ratio, found.link_ratio, super::ABSOLUTE);
    whole("type", listed.linkage_type.to_string(), found.linkage_type.to_string());
    whole("defects", format!("{:?}", listed.defects), format!("{:?}", found.defects));
    if !found.requirements.iter().any(super::within_margin) {
        whole("accepted", listed.accepted.to_string(), found.accepted.to_string());
        let not_met = crate::search::cognates::not_met(found);
        whole("not_met", listed.not_met.join(", "), not_met.join(", "));
    }
}
