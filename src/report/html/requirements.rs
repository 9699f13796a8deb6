//! The requirements: the limit, the candidate's value, the verdict and the cost of each.

use super::page::escaped;
use super::table::{head, minus, scrolling};
use crate::record::{Candidate, Figure, Record, Requirement};
use crate::report::text::{brief, clean, exact};
use crate::report::{price, words};
use crate::task::requirement::RequirementKind;

/// Returns the requirements as tables: those of `[require]` and the tolerance at once, the bounds of `[design]` folded
/// away unless the candidate is at a bound or misses it.
pub(super) fn requirements(record: &Record, c: &Candidate) -> String {
    let matters = |r: &Requirement| {
        !r.name.starts_with("design.") || !r.met || c.costs.iter().any(|cost| cost.name == r.name)
    };
    let (shown, folded): (Vec<_>, Vec<_>) = c.requirements.iter().partition(|r| matters(r));
    let mut out = String::from("<h3>Requirements</h3>\n");
    if let Some(objections) = refusal(record, c) {
        out.push_str(&super::body::paragraph("bad", &objections));
    }
    if !shown.is_empty() {
        out.push_str(&table("Requirements", record, c, &shown));
    }
    if !folded.is_empty() {
        out.push_str(&format!(
            "<details><summary>{} bounds of the design, all met with room</summary>\n{}</details>\n",
            folded.len(),
            table("Bounds of the design", record, c, &folded)
        ));
    }
    // Limits that are not among the requirements, such as the Grashof margin of a type.
    let mut told: Vec<&str> = c.requirements.iter().map(|r| r.name.as_str()).collect();
    for cost in &c.costs {
        if !told.contains(&cost.name.as_str()) {
            told.push(&cost.name);
            let text = price::clause(record, c, &cost.name).unwrap_or_default();
            out.push_str(&super::body::paragraph("", &format!("{}: {text}", clean(&cost.name))));
        }
    }
    out
}

/// Returns the reason why the candidate is not accepted.
fn refusal(record: &Record, c: &Candidate) -> Option<String> {
    let objections = words::objections(record, c);
    let list: Vec<String> = objections.into_iter().map(|o| o.sentence).collect();
    (!list.is_empty()).then(|| format!("Not accepted: {}.", list.join("; ")))
}

fn table(name: &str, record: &Record, c: &Candidate, list: &[&Requirement]) -> String {
    let columns = [("requirement", false), ("asked", true), ("has", true), ("", false)];
    let rows: String = list.iter().map(|r| row(record, c, r)).collect();
    scrolling(name, "wide requirements", &format!("{}<tbody>\n{rows}</tbody>\n", head(&columns)))
}

/// Returns a row for the requirement, and if the candidate is at its limit one for the cost of that.
fn row(record: &Record, c: &Candidate, r: &Requirement) -> String {
    let (mut asked, mut has) = (words::figure(&r.limit, short), words::figure(&r.value, short));
    if asked == has && !r.met {
        // Rounding must not make a missed limit look met.
        (asked, has) = (words::figure(&r.limit, exact), words::figure(&r.value, exact));
    }
    let asked = format!("{}{}", relation(r), signed(&asked, &r.limit));
    let has = signed(&has, &r.value);
    let (colour, verdict) = if r.met { ("good", "met") } else { ("bad", "not met") };
    let cost = price::clause(record, c, &r.name);
    let class = if cost.is_some() { " class=\"has-cost\"" } else { "" };
    let cost = cost.map_or(String::new(), |text| {
        format!("<tr class=\"cost\"><td colspan=\"4\">{}</td></tr>\n", escaped(&text))
    });
    format!(
        "<tr{class}><th scope=\"row\">{}</th><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"{colour}\">{verdict}</td></tr>\n{cost}",
        escaped(&label(&r.name)),
        escaped(&asked),
        escaped(&has),
    )
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
        (Some(kind), _) => kind.definition().words().relation,
        (None, Figure::Numbers(_)) => "in ",
        (None, _) => "",
    }
}

/// Returns the name for readers; the problem file's key if there is no word for it.
fn label(name: &str) -> String {
    if let Some(kind) = RequirementKind::named(name) {
        return kind.definition().words().label.to_owned();
    }
    let plain = clean(name.strip_prefix("design.").unwrap_or(name));
    if plain.is_empty() { "a requirement".to_owned() } else { plain }
}
