//! Verification of exact linkages: the census adds up, and each linkage passes the points, has the stated abilities,
//! and is proved again. (Whether the census is complete takes a search of its own: run it.)

use super::{Against, Mismatch, verdict};
use crate::judge::assess::assess;
use crate::judge::certified::{certified, nearly_exact, same, target};
use crate::judge::exact_linkages::class_at;
use crate::mechanism::AssemblyMode;
use crate::record::{
    Candidate, Certified, Completeness, ExactForm, ExactLinkage, ExactRecord, GENERIC_CLASSES, Reason, Record,
};
use crate::task::Problem;

/// The factor by which the radius of a recomputed proof may differ: it is an upper bound that depends on rounding.
const WIDER: f64 = 1.5;

/// The distance of a target from the origin, in its sizes, beyond which the class of a listed linkage cannot be found
/// again: so far away, coordinates are rounded to 1e-10 of its size, by which a mechanism may miss the points.
const FOUND_AGAIN: f64 = 2e4;

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
    census(exact, record.termination.reason == Reason::Cancelled, &mut whole);
    let Some(target) = target else {
        whole("exact", "nine points and what passes through them".into(), "not nine points".into());
        return;
    };
    let places = nearly_exact(problem);
    let far = target.points.iter().map(|point| point.norm()).fold(0.0, f64::max);
    let found_again = far <= FOUND_AGAIN * problem.task().size();
    for (i, listed) in exact.linkages.iter().enumerate() {
        let mut whole = |figure: &str, recorded: String, found: String| {
            whole(&format!("exact.linkages {}: {figure}", i + 1), recorded, found);
        };
        if !found_again {
            // The linkage itself is judged nevertheless.
            let n = problem.task().len();
            let counts = listed.crank_deg.len() == n && listed.t1_at.len() == n;
            let judged = || assess(problem, &listed.linkage, &listed.crank_deg, &listed.t1_at);
            match counts.then(judged).flatten() {
                Some(found) => figures(problem, listed, &found, &mut whole),
                None => whole("the linkage", "closed at every point".into(), "not that".into()),
            }
            continue;
        }
        let at = (&listed.linkage, listed.crank_deg.as_slice(), listed.t1_at.as_slice());
        let Some(class) = class_at(problem, &target, at) else {
            whole("the linkage", "one that passes all points".into(), "not that".into());
            continue;
        };
        if let Some(found) = class.judged {
            figures(problem, listed, &found, &mut whole);
            if let Some(recorded) = listed.certified
                && let Some((recorded, found)) = proof(recorded, certified(&target, &found))
            {
                whole("certified.radius", recorded, found);
            }
        }
        let sign = |t: AssemblyMode| format!("{:+}", t.sign());
        let first = listed.t1_at.first().copied().map_or("none".into(), sign);
        whole("linkage.t1", sign(listed.linkage.assembly()), first);
        let all = [listed.one_circuit, listed.in_order, listed.free_of_defects];
        // An ability in doubt keeps its recorded value.
        let pairs = || all.into_iter().zip(class.abilities);
        let found: Vec<bool> = pairs().map(|(is, can)| can.certain || is && can.possible).collect();
        whole("what the class can do", format!("{all:?}"), format!("{found:?}"));
        others(listed, &class.forms, &mut whole);
        let of_class = |c: &&Candidate| {
            c.error.sum_sq <= places && class.forms.iter().any(|(form, _)| same(&form.linkage, &c.linkage))
        };
        let rank = record.candidates.iter().rfind(of_class).map_or(0, |c| c.rank);
        whole("rank", listed.rank.to_string(), rank.to_string());
    }
}

/// Checks the other mechanisms of a class: all that pass the points beyond doubt are listed, each with its type and
/// defects.
fn others(listed: &ExactLinkage, forms: &[(ExactForm, bool)], whole: &mut dyn FnMut(&str, String, String)) {
    for (i, other) in listed.others.iter().enumerate() {
        let what = |figure: &str| format!("others {}: {figure}", i + 1);
        let Some((found, certain)) = forms.iter().find(|(form, _)| same(&form.linkage, &other.linkage))
        else {
            whole(&what("the linkage"), "a mechanism of the class".into(), "none of them".into());
            continue;
        };
        let t1 = |form: &ExactForm| format!("{:+}", form.linkage.assembly().sign());
        whole(&what("linkage.t1"), t1(other), t1(found));
        whole(&what("type"), other.linkage_type.to_string(), found.linkage_type.to_string());
        if *certain {
            whole(&what("defects"), format!("{:?}", other.defects), format!("{:?}", found.defects));
        }
    }
    let recorded = || listed.others.iter().map(|form| &form.linkage).chain([&listed.linkage]);
    let missing = |(form, beyond_doubt): &&(ExactForm, bool)| {
        *beyond_doubt && !recorded().any(|linkage| same(linkage, &form.linkage))
    };
    let count = listed.others.len();
    whole("others", count.to_string(), (count + forms.iter().filter(missing).count()).to_string());
}

/// Returns the recorded and the recomputed proof in words if they differ.
fn proof(recorded: Certified, found: Option<Certified>) -> Option<(String, String)> {
    let near = |one: f64, other: f64| one <= WIDER * other;
    let holds =
        found.is_some_and(|found| near(found.radius, recorded.radius) && near(recorded.radius, found.radius));
    let words = |c: Certified| format!("{:e}", c.radius);
    (!holds).then(|| (words(recorded), found.map_or("no proof".into(), words)))
}

fn census(exact: &ExactRecord, cancelled: bool, whole: &mut dyn FnMut(&str, String, String)) {
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
    // A search that was cancelled records only that.
    let found = if cancelled && exact.completeness == Completeness::Cancelled {
        Completeness::Cancelled
    } else if c.classes == GENERIC_CLASSES {
        Completeness::Complete
    } else if c.failed == 0 && c.singular > 0 && c.singular >= c.duplicate {
        Completeness::NonGeneric
    } else {
        Completeness::Incomplete
    };
    whole("exact.completeness", format!("{:?}", exact.completeness), format!("{found:?}"));
    whole("exact.generic", exact.generic.to_string(), (c.classes == GENERIC_CLASSES).to_string());
}

fn figures(
    problem: &Problem,
    listed: &ExactLinkage,
    found: &Candidate,
    whole: &mut dyn FnMut(&str, String, String),
) {
    let mut number = |what: &str, recorded: f64, found: f64, slack: f64| {
        let near = (recorded - found).abs() <= super::RELATIVE * found.abs() + slack;
        if !near {
            whole(what, format!("{recorded:e}"), format!("{found:e}"));
        }
    };
    let span = found.linkage.longest_link();
    number("miss", listed.miss, found.error.max, super::ABSOLUTE * span);
    // The angle is in degrees, and near a toggle position it follows from a small difference.
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
    let said = |name: &str| listed.not_met.iter().any(|not_met| not_met == name);
    let (not_met, accepted) = verdict(problem, found, &said);
    whole("accepted", listed.accepted.to_string(), accepted.to_string());
    whole("not_met", listed.not_met.join(", "), not_met.join(", "));
}
