//! One candidate in words: figures, mobility and defects, requirements, dimensions, other linkages with the same curve.

use super::data::{MOST_ALTERNATIVES, candidate_key};
use super::extras::{Shown, extras};
use super::page::{paragraph, still};
use super::table::{Cell, Column, minus, tabulated};
use super::{dimensions, function, loads, mobility, page, requirements};
use crate::record::{Alternative, Candidate, Pick, Record};
use crate::report::text::{clean, significant};
use crate::report::{picks, words};
use maud::{Markup, html};

/// The largest number of candidates with a drawing for readers without a script.
const MOST_DRAWN: usize = 10;

/// Returns the number of candidates that are drawn.
pub(super) fn drawn(record: &Record) -> usize {
    record.candidates.len().min(MOST_DRAWN)
}

/// Returns an article for each candidate, and for each other linkage that the page shows.
pub(super) fn articles(record: &Record, drawings: &[&str], shown: Shown) -> Markup {
    html! {
        @for (i, c) in record.candidates.iter().enumerate() {
            (ranked(record, i, c, drawings.get(i).copied().filter(|_| i < MOST_DRAWN)))
        }
        @for extra in extras(record, shown) {
            (article(record, extra.candidate, (&extra.key, &extra.short, &extra.title()), None))
        }
    }
}

/// Returns the article of one candidate, without a drawing.
pub(super) fn one(record: &Record, index: usize) -> Option<Markup> {
    record.candidates.get(index).map(|c| ranked(record, index, c, None))
}

fn ranked(record: &Record, i: usize, c: &Candidate, drawing: Option<&str>) -> Markup {
    let title = format!("Candidate {}", i + 1);
    article(record, c, (&candidate_key(i), &(i + 1).to_string(), &title), drawing)
}

fn article(
    record: &Record,
    c: &Candidate,
    (key, short, title): (&str, &str, &str),
    drawing: Option<&str>,
) -> Markup {
    let is = |pick| record.pick(pick).is_some_and(|p| p.rank == c.rank && p.rank > 0);
    html! {
        article.card data-key=(key) data-short=(short) aria-labelledby={ (key) "-title" } {
            h2 id={ (key) "-title" } { (title) }
            @if let Some(drawing) = drawing { (still(drawing)) }
            (figures(record, c))
            (function::function(record, c, title))
            @if drawing.is_some() { (loads::loads(record, c, title)) }
            div.columns {
                div {
                    h3 { "What it can do" }
                    (mobility::mobility(record, c))
                    (warnings(c))
                    @if is(Pick::Buildable) {
                        (paragraph("", "It is the best one without the warnings of the first."))
                    }
                    @for pick in picks::BOTH.into_iter().filter(|pick| is(*pick)) {
                        (paragraph("", &format!("It is the {} one {}.", pick.words(), picks::within(record))))
                    }
                    (requirements::requirements(record, c))
                }
                div {
                    h3 { "Dimensions" }
                    (dimensions::dimensions(record, c, short))
                    (alternatives(c, key))
                }
            }
        } "\n"
    }
}

/// Returns the most important figures.
fn figures(record: &Record, c: &Candidate) -> Markup {
    let unit = words::error_unit(record);
    let length = |value: f64| html! { (minus(&significant(value, 4))) small { (unit) } };
    let (class, verdict) = if c.accepted { ("good", "accepted") } else { ("bad", "not accepted") };
    let noun = record.problem.resolved.task.noun();
    let mut list = vec![
        ("rms error", length(c.error.rms)),
        ("largest error", html! { (length(c.error.max)) " " small { "at " (noun) " " (c.error.max_at) } }),
    ];
    if let Some(angle) = &c.error.angle {
        let largest = html! {
            (significant(angle.max_deg, 4)) "° " small { "at " (noun) " " (angle.max_at) }
        };
        list.push(("rms angle error", html! { (significant(angle.rms_deg, 4)) "°" }));
        list.push(("largest angle error", largest));
    }
    list.extend([
        ("worst transmission angle", html! { (significant(c.transmission_deg.worst, 4)) "°" }),
        ("longest to shortest link", html! { (significant(c.link_ratio, 4)) }),
        ("verdict", html! { span class=(class) { (verdict) } }),
    ]);
    if let Some(torque) = c.peak_torque {
        let place = list.len() - 1;
        list.insert(place, ("peak torque", html! { (significant(torque, 4)) small { " N m" } }));
    }
    page::figures(list)
}

fn warnings(c: &Candidate) -> Markup {
    html! {
        @if !c.warnings.is_empty() {
            h3 { "Look twice" }
            ul.said-list { @for warning in &c.warnings { li.warning { (clean(&warning.text)) } } }
        }
    }
}

/// Returns the cognates.
fn alternatives(c: &Candidate, key: &str) -> Markup {
    if c.alternatives.is_empty() {
        return Markup::default();
    }
    let verdict = |a: &Alternative| {
        let not_met: Vec<String> = a.not_met.iter().take(4).map(|name| clean(name)).collect();
        if a.accepted { "accepted".to_owned() } else { format!("not: {}", not_met.join(", ")) }
    };
    let columns: [Column<&Alternative>; 4] = [
        ("type", false, &|a| Cell::words(a.type_name())),
        ("transmission", true, &|a| Cell::degrees(a.transmission_worst_deg)),
        ("ratio", true, &|a| Cell::figure(a.link_ratio, 3)),
        ("verdict", false, &|a| Cell::verdict(verdict(a), a.accepted)),
    ];
    let shown = c.alternatives.iter().take(MOST_ALTERNATIVES).zip(1..);
    let rows = shown.map(|(a, i)| (Some(format!("{key}a{i}")), Cell::words(format!("cognate {i}")), a));
    html! {
        h3 { "The same curve by other linkages" }
        (tabulated(("Cognates", "wide tight"), ("", false), &columns, rows))
        (dimensions::of_alternatives(c))
    }
}
