//! The requirements: the limit, the candidate's value, the verdict and the cost of each.

use super::page::paragraph;
use super::table::{minus, scrolling};
use crate::record::{Candidate, Figure, Record, Requirement};
use crate::report::text::{brief, clean, exact};
use crate::report::{price, words};
use crate::task::requirement::RequirementKind;
use maud::{Markup, html};

/// Returns the requirements as tables: those of `[require]` and the tolerance at once, the bounds of `[design]` folded
/// away unless the candidate is at a bound or misses it.
pub(super) fn requirements(record: &Record, c: &Candidate) -> Markup {
    let matters = |r: &Requirement| {
        !r.name.starts_with("design.") || !r.met || c.costs.iter().any(|cost| cost.name == r.name)
    };
    let (shown, folded): (Vec<_>, Vec<_>) = c.requirements.iter().partition(|r| matters(r));
    // Limits that are not among the requirements, such as the Grashof margin of a type.
    let mut others: Vec<&str> = Vec::new();
    for cost in &c.costs {
        if !others.contains(&cost.name.as_str()) && c.requirements.iter().all(|r| r.name != cost.name) {
            others.push(&cost.name);
        }
    }
    let other = |name: &str| {
        let text = price::clause(record, c, name).unwrap_or_default();
        paragraph("", &format!("{}: {text}", clean(name)))
    };
    html! {
        h3 { "Requirements" }
        @if let Some(objections) = refusal(record, c) { (paragraph("bad", &objections)) }
        @if !shown.is_empty() { (table("Requirements", record, c, &shown)) }
        @if !folded.is_empty() {
            details {
                summary { (folded.len()) " bounds of the design, all met with room" }
                (table("Bounds of the design", record, c, &folded))
            }
        }
        @for name in others { (other(name)) }
    }
}

/// Returns the reason why the candidate is not accepted.
fn refusal(record: &Record, c: &Candidate) -> Option<String> {
    let objections = words::objections(record, c);
    let list: Vec<String> = objections.into_iter().map(|o| o.sentence).collect();
    (!list.is_empty()).then(|| format!("Not accepted: {}.", list.join("; ")))
}

fn table(name: &str, record: &Record, c: &Candidate, list: &[&Requirement]) -> Markup {
    let columns = [("requirement", false), ("asked", true), ("has", true), ("", false)];
    scrolling(name, "wide requirements", &columns, list.iter().map(|r| row(record, c, r)))
}

/// Returns a row for the requirement, and if the candidate is at its limit one for the cost of that.
fn row(record: &Record, c: &Candidate, r: &Requirement) -> Markup {
    let (mut asked, mut has) = (words::figure(&r.limit, short), words::figure(&r.value, short));
    if asked == has && !r.met {
        // Rounding must not make a missed limit look met.
        (asked, has) = (words::figure(&r.limit, exact), words::figure(&r.value, exact));
    }
    let asked = format!("{}{}", relation(r), signed(&asked, &r.limit));
    let has = signed(&has, &r.value);
    let (colour, verdict) = if r.met { ("good", "met") } else { ("bad", "not met") };
    let cost = price::clause(record, c, &r.name);
    html! {
        tr class=[cost.is_some().then_some("has-cost")] {
            th scope="row" { (words::of_targets(&record.problem.resolved.task, &label(&r.name))) }
            td.n { (asked) }
            td.n { (has) }
            td class=(colour) { (verdict) }
        }
        @if let Some(text) = cost { tr.cost { td colspan="4" { (text) } } }
    }
}

fn short(value: f64) -> String {
    brief(value, 4)
}

fn signed(text: &str, figure: &Figure) -> String {
    match figure {
        Figure::Number(_) => minus(text),
        Figure::Numbers(_) => format!("[{}]", text.replace('-', "\u{2212}")),
        Figure::Word(_) | Figure::Words(_) => text.to_owned(),
    }
}

/// Returns the relation between value and limit.
fn relation(r: &Requirement) -> &'static str {
    match (RequirementKind::named(&r.name), &r.limit) {
        (Some(kind), _) => kind.definition().relation,
        (None, Figure::Numbers(_)) => "in ",
        (None, _) => "",
    }
}

/// Returns the name for readers; the problem file's key if there is no word for it.
fn label(name: &str) -> String {
    if let Some(kind) = RequirementKind::named(name) {
        return kind.definition().label.to_owned();
    }
    let plain = clean(name.strip_prefix("design.").unwrap_or(name));
    if plain.is_empty() { "a requirement".to_owned() } else { plain }
}
