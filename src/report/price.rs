//! The costs of requirements and the relaxations that would help, in words.

use super::text::{COLUMNS, clean, significant, wrapped};
use super::words;
use crate::mechanism::Unit;
use crate::record::{Candidate, Change, Cost, LimitUnit, Record, Relaxation, TypedValue};
use crate::task::requirement::RequirementKind;

/// The largest relative change of the error by a step for which rates are stated.
const SMALL_STEP: f64 = 0.5;

/// Returns the costs of the limits of the best candidate, one line for each requirement; empty if no limit is active.
pub(super) fn costs(record: &Record) -> String {
    let Some(best) = record.candidates.first() else { return String::new() };
    if best.costs.is_empty() {
        return String::new();
    }
    let of_motion = record.problem.resolved.task.is_motion();
    let with_angles = if of_motion { "; angle errors times angle_weight are part of the rms" } else { "" };
    let mut out = format!("\n  What the limits cost (#{}{with_angles})\n", best.rank);
    for (i, cost) in best.costs.iter().enumerate() {
        if best.costs[..i].iter().all(|other| other.name != cost.name) {
            out.push_str(&wrapped("    ", "      ", &sentence(record, best, &cost.name), COLUMNS));
        }
    }
    out
}

/// Returns the error in which costs are stated: rms, weighted if the points are; in a motion with the errors of the
/// angle as lengths.
fn rms(record: &Record, candidate: &Candidate) -> f64 {
    let task = &record.problem.resolved.task;
    let ones = || task.body.as_ref().map(|body| vec![1.0; body.angle_deg.len()]);
    task.weight
        .clone()
        .or_else(ones)
        .map_or(candidate.error.rms, |w| (candidate.error.objective / w.iter().sum::<f64>()).sqrt())
}

/// Returns the cost of an active limit: `costs 0.80 mm of rms; 1 mm more at xmax gives back 0.10 mm`.
pub(super) fn clause(record: &Record, candidate: &Candidate, name: &str) -> Option<String> {
    candidate.costs.iter().find(|cost| cost.name == name)?;
    let text = sentence(record, candidate, name);
    let head = named(record, name);
    Some(text.strip_prefix(&head).unwrap_or(&text).trim_start_matches([':', ' ']).to_owned())
}

/// Returns a sentence such as `pivots_in costs 0.80 mm of rms; 1 mm more at xmax gives back 0.10 mm`.
fn sentence(record: &Record, candidate: &Candidate, name: &str) -> String {
    let unit = words::error_unit(record);
    let with = rms(record, candidate);
    let own = || candidate.costs.iter().filter(|cost| cost.name == name);
    let rates: Vec<String> =
        own().filter_map(|cost| rate((record.problem.unit, &unit), with, cost)).collect();
    let without = own().find_map(|cost| cost.rms_without);
    let name = named(record, name);
    let total = without.map(|least| format!("costs {}{unit} of rms", significant(with - least, 2)));
    match (total, rates.is_empty()) {
        (Some(total), false) => format!("{name} {total}; {}", rates.join(", ")),
        (Some(total), true) => format!("{name} {total}"),
        (None, false) => format!("{name}: {} of rms", rates.join(", ")),
        (None, true) => format!("{name} binds"),
    }
}

/// Returns the name of a requirement, with a remark where it is a default that nobody may have typed.
fn named(record: &Record, name: &str) -> String {
    let longest = name == RequirementKind::LongestMax.name() && record.problem.resolved.has_default_longest();
    let remark = if longest { " (3 sizes, the default)" } else { "" };
    format!("{}{remark}", clean(name))
}

/// Returns a clause such as `1 mm more at xmax gives back 0.10 mm`.
fn rate((unit, of_errors): (Option<Unit>, &str), rms: f64, cost: &Cost) -> Option<String> {
    let rate = -cost.rms_per_unit?;
    if !(rate > 0.0 && rate.is_finite() && rms > 0.0) {
        return None;
    }
    let mut step = 1.0;
    while rate * step > SMALL_STEP * rms && step > 1e-12 {
        step /= 10.0;
    }
    let shown = significant(step, 1);
    let length = match unit {
        Some(unit) => format!("{shown} {}", unit.label()),
        None if step == 1.0 => "one unit".to_owned(),
        None => shown.clone(),
    };
    // A type and a crank that turns fully have no limit of their own.
    let of_margin = cost.limit == 0.0;
    let room = match (cost.unit_of_limit, cost.side.as_deref()) {
        (LimitUnit::Length, None) if RequirementKind::names_line(&cost.name) => {
            format!("{length} off the line")
        }
        (LimitUnit::Length, None) if of_margin => format!("{length} of Grashof margin"),
        (LimitUnit::Length, None) => format!("{length} more than {}", significant(cost.limit, 4)),
        (LimitUnit::Length, Some("min")) => format!("{length} less than {}", significant(cost.limit, 4)),
        (LimitUnit::Length, Some("max")) => format!("{length} more than {}", significant(cost.limit, 4)),
        (LimitUnit::Length, Some(side)) => format!("{length} more at {}", clean(side)),
        (LimitUnit::Degree, Some("max")) => format!("{shown}° more than {}°", significant(cost.limit, 4)),
        (LimitUnit::Degree, _) => format!("{shown}° less than {}°", significant(cost.limit, 4)),
        (LimitUnit::Torque, _) => format!("{shown} N m more than {}", significant(cost.limit, 4)),
        (LimitUnit::Ratio, _) => format!("{shown} more than {}", significant(cost.limit, 4)),
    };
    Some(format!("{room} gives back {}{}", significant(rate * step, 2), of_errors))
}

/// Returns the requirements that conflict and the relaxations that would help; empty if a candidate is acceptable or
/// none was found.
pub(super) fn relaxations(record: &Record) -> String {
    let mut out = String::new();
    if let Some(text) = conflict(record) {
        out.push('\n');
        out.push_str(&wrapped("  ", "  ", &text, COLUMNS));
    }
    for (options, rms) in changes(record) {
        // Not broken into lines, so that it can be copied.
        out.push_str(&format!("    {options}   ({rms})\n"));
    }
    if let Some(text) = other_kind(record) {
        out.push('\n');
        out.push_str(&wrapped("  ", "  ", &text, COLUMNS));
    }
    out
}

/// Returns the linkage of another kind that is acceptable where no four-bar is, and the key that asks for it.
pub(super) fn other_kind(record: &Record) -> Option<String> {
    let other = record.other_kind.as_ref()?;
    let unit = words::error_unit(record);
    let kind = other.type_name();
    Some(format!(
        "No four-bar that was found meets it; this {kind} does: rms {}{unit}, largest error {}{unit}, worst transmission angle {}°; \
         linkage-other-kind.toml. --set design.mechanism={kind} looks for more of them.",
        significant(other.error.rms, 3),
        significant(other.error.max, 3),
        significant(other.transmission_deg.worst, 3),
    ))
}

/// Returns the changes that help, in the form in which they are typed, each with the resulting error.
pub(super) fn changes(record: &Record) -> Vec<(String, String)> {
    let unit = words::error_unit(record);
    let of = |relaxation: &Relaxation| {
        let options: Vec<String> = relaxation.set.iter().map(option).collect();
        (options.join(" "), format!("rms {}{unit}", significant(relaxation.rms, 3)))
    };
    record.relaxations.iter().map(of).collect()
}

/// Returns the requirements that conflict, and the beginning of the list of relaxations.
pub(super) fn conflict(record: &Record) -> Option<String> {
    let among = record.conflict.as_ref().map(|conflict| &conflict.among);
    let among: Option<Vec<String>> = among.map(|keys| keys.iter().map(|key| demand(record, key)).collect());
    let conflict = match among.as_deref() {
        None if record.relaxations.is_empty() => return None,
        None => "Nothing acceptable.".to_owned(),
        Some([]) => String::new(),
        Some([only]) => format!("Nothing acceptable: {only} asks for more than was found."),
        Some([most @ .., last]) => format!("Nothing acceptable: {} and {last} conflict.", most.join(", ")),
    };
    let help = if record.relaxations.is_empty() {
        "No single change that helps was found."
    } else if record.relaxations.iter().any(|relaxation| changed(relaxation) == 1) {
        "It works with"
    } else {
        "No single change helps; it works with"
    };
    Some(format!("{conflict} {help}"))
}

/// Returns the number of keys that change; a key with its old value does not count.
fn changed(relaxation: &Relaxation) -> usize {
    relaxation.set.iter().filter(|change| change.from != change.to).count()
}

/// Returns `--set require.transmission_deg_min=32.1`, in quotes if a shell would split it.
fn option(change: &Change) -> String {
    let typed = clean(&format!("{}={}", change.key, change.to));
    let plain = typed.chars().all(|c| c.is_ascii_alphanumeric() || "._=-".contains(c));
    if plain { format!("--set {typed}") } else { format!("--set '{typed}'") }
}

/// Returns a requirement such as `transmission_deg_min = 40`; only the key if its value would be long.
fn demand(record: &Record, key: &str) -> String {
    let short = clean(key.rsplit_once("require.").map_or(key, |(_, name)| name));
    let from = |relaxation: &Relaxation| {
        relaxation.set.iter().find(|change| change.key == key).map(|change| change.from.clone())
    };
    let required = RequirementKind::with_key(key).filter(|kind| !kind.is_tolerance());
    let limit = required.and_then(|kind| kind.only_limit(&record.problem.resolved));
    let value = limit.map(TypedValue::Number).or_else(|| record.relaxations.iter().find_map(from));
    match value {
        Some(value @ (TypedValue::Number(_) | TypedValue::Word(_) | TypedValue::Words(_))) => {
            format!("{short} = {}", clean(&value.to_string()))
        }
        _ => short,
    }
}
