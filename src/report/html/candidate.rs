//! One candidate in words: figures, mobility and defects, requirements, dimensions, other linkages with the same curve.

use super::body::paragraph;
use super::data::{BUILDABLE_KEY, MOST_ALTERNATIVES, candidate_key};
use super::page::escaped;
use super::table::{Cell, head, minus, scrolling};
use super::{dimensions, mobility, requirements};
use crate::record::{Alternative, Candidate, Record};
use crate::report::text::{clean, significant};
use crate::report::words;

/// The largest number of candidates with a drawing for readers without a script.
const MOST_DRAWN: usize = 10;

/// Returns the number of candidates that are drawn.
pub(super) fn drawn(record: &Record) -> usize {
    record.candidates.len().min(MOST_DRAWN)
}

/// Returns an article for each candidate, and for the buildable candidate if it is not among them.
pub(super) fn articles(record: &Record, drawings: &[&str]) -> String {
    let mut out: String = record
        .candidates
        .iter()
        .enumerate()
        .map(|(i, c)| ranked(record, i, c, drawings.get(i).copied().filter(|_| i < MOST_DRAWN)))
        .collect();
    if let Some(c) = record.buildable.as_ref().filter(|c| c.rank == 0) {
        out.push_str(&article(record, c, (BUILDABLE_KEY, "buildable", "The buildable answer"), None));
    }
    out
}

/// Returns the article of one candidate, without a drawing.
pub(super) fn one(record: &Record, index: usize) -> String {
    record.candidates.get(index).map_or(String::new(), |c| ranked(record, index, c, None))
}

fn ranked(record: &Record, i: usize, c: &Candidate, drawing: Option<&str>) -> String {
    let title = format!("Candidate {}", i + 1);
    article(record, c, (&candidate_key(i), &(i + 1).to_string(), &title), drawing)
}

fn article(
    record: &Record,
    c: &Candidate,
    (key, short, title): (&str, &str, &str),
    drawing: Option<&str>,
) -> String {
    let still =
        drawing.map_or(String::new(), |d| format!("<figure class=\"still\">{}</figure>\n", inline(d)));
    let best = record.buildable.as_ref().is_some_and(|b| b.rank == c.rank && b.rank > 0);
    let mut words = format!("<h3>What it can do</h3>\n{}", mobility::mobility(record, c));
    words.push_str(&warnings(c));
    if best {
        words.push_str(&paragraph("", "It is the best one without the warnings of the first."));
    }
    words.push_str(&requirements::requirements(record, c));
    let mut build = format!("<h3>Dimensions</h3>\n{}", dimensions::dimensions(record, c, short));
    build.push_str(&alternatives(c, key));
    format!(
        "<article class=\"card\" data-key=\"{key}\" data-short=\"{short}\" aria-labelledby=\"{key}-title\">\n\
         <h2 id=\"{key}-title\">{title}</h2>\n{still}{}<div class=\"columns\">\n<div>\n{words}</div>\n<div>\n{build}</div>\n</div>\n</article>\n",
        figures(record, c)
    )
}

/// Returns a drawing as it is embedded in a page, which needs no name space.
pub(super) fn inline(drawing: &str) -> String {
    drawing.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1)
}

/// Returns the most important figures.
fn figures(record: &Record, c: &Candidate) -> String {
    let unit = words::unit_suffix(record);
    let length = |value: f64| format!("{}<small>{unit}</small>", minus(&significant(value, 4)));
    let verdict = if c.accepted {
        "<span class=\"good\">accepted</span>"
    } else {
        "<span class=\"bad\">not accepted</span>"
    };
    let pairs = [
        ("rms error", length(c.error.rms)),
        ("largest error", format!("{} <small>at point {}</small>", length(c.error.max), c.error.max_at)),
        ("worst transmission angle", format!("{}°", significant(c.transmission_deg.worst, 4))),
        ("longest to shortest link", significant(c.link_ratio, 4)),
        ("verdict", verdict.to_owned()),
    ];
    let pairs: String =
        pairs.iter().map(|(key, value)| format!("<div><dt>{key}</dt><dd>{value}</dd></div>\n")).collect();
    format!("<dl class=\"figures\">\n{pairs}</dl>\n")
}

fn warnings(c: &Candidate) -> String {
    if c.warnings.is_empty() {
        return String::new();
    }
    let items: String = c
        .warnings
        .iter()
        .map(|w| format!("<li class=\"warning\">{}</li>\n", escaped(&clean(&w.text))))
        .collect();
    format!("<h3>Look twice</h3>\n<ul class=\"said-list\">\n{items}</ul>\n")
}

/// Returns the cognates.
fn alternatives(c: &Candidate, key: &str) -> String {
    if c.alternatives.is_empty() {
        return String::new();
    }
    let row = |(i, a): (usize, &Alternative)| {
        let not_met: Vec<String> = a.not_met.iter().take(4).map(|name| clean(name)).collect();
        let verdict = if a.accepted { "accepted".to_owned() } else { format!("not: {}", not_met.join(", ")) };
        let cells = [
            Cell::words(a.linkage_type.name()),
            Cell::number(a.transmission_worst_deg, format!("{}°", significant(a.transmission_worst_deg, 3))),
            Cell::figure(a.link_ratio, 3),
            Cell::verdict(&verdict, a.accepted),
        ];
        let cells: String = cells.iter().map(Cell::markup).collect();
        format!("<tr data-key=\"{key}a{}\"><th scope=\"row\">cognate {}</th>{cells}</tr>\n", i + 1, i + 1)
    };
    let rows: String = c.alternatives.iter().take(MOST_ALTERNATIVES).enumerate().map(row).collect();
    let columns = [("", false), ("type", false), ("transmission", true), ("ratio", true), ("verdict", false)];
    let table = format!("{}<tbody>\n{rows}</tbody>\n", head(&columns));
    format!(
        "<h3>The same curve by other linkages</h3>\n{}{}",
        scrolling("Cognates", "wide tight", &table),
        dimensions::of_alternatives(c)
    )
}
