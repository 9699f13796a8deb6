//! The page of a sweep: the plot, the best jobs with the commands that run them alone, and the reasons of refusals.

use super::plot::plot_svg;
use super::summary::{Summary, values_in_words};
use super::table::value;
use crate::files::sweep_file::typed;
use crate::record::sweep::{Best, Plan, Row, Status};
use crate::report::html::PLAYER_STYLE;
use crate::report::html::page::{Page, paragraph, section};
use crate::report::html::table::{Cell, scrolling};
use crate::report::text::{clean, grouped, significant};
use maud::{Markup, PreEscaped, html};

/// Returns the page: a whole HTML file, which needs no script and no network.
pub fn sweep_html(plan: &Plan, summary: &Summary) -> String {
    Page {
        title: &format!("{}: sweep", clean(&plan.name)),
        styles: &[PLAYER_STYLE, include_str!("../html/report.css")],
        body: body(plan, summary),
        data: "{}",
        modules: &[],
    }
    .render()
}

fn body(plan: &Plan, summary: &Summary) -> Markup {
    let chart = plot_svg(plan, summary).replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    html! {
        a.skip href="#best" { "To the best jobs" }
        header {
            h1 { (clean(&plan.name)) ": the sweep" }
            (paragraph("facts", &facts(plan, summary)))
        }
        main {
            section.card id="plot" aria-label="The outcome over the varied keys" {
                figure.chart { (PreEscaped(chart)) }
            }
            (section("keys", "What varies", keys(plan)))
            (section("best", "The best jobs", best(plan, summary)))
            @if !summary.reasons.is_empty() { (section("refused", "What was refused", reasons(summary))) }
        }
        footer {
            p {
                "Written by linkwright " (env!("CARGO_PKG_VERSION"))
                ". sweep.csv holds every job as a row, sweep.jsonl the same as data."
            }
        }
    }
}

/// Returns the counts in words.
fn facts(plan: &Plan, summary: &Summary) -> String {
    let some = |status, words: &str| {
        let count = summary.count(status);
        if count > 0 { format!(", {} {words}", grouped(count)) } else { String::new() }
    };
    format!(
        "{} jobs of {}: {} with something acceptable{}{}{}.",
        grouped(summary.rows),
        clean(&plan.problem.name),
        grouped(summary.count(Status::Accepted)),
        some(Status::NothingAcceptable, "with nothing acceptable"),
        some(Status::Refused, "refused, as their values contradict each other"),
        some(Status::Bug, "stopped by a bug of linkwright"),
    )
}

fn keys(plan: &Plan) -> Markup {
    let rows = plan.vary.iter().map(|varied| {
        html! { tr { th scope="row" { (clean(&varied.key)) } td { (clean(&values_in_words(&varied.values))) } } }
    });
    scrolling("What varies", "", &[("key", false), ("values", false)], rows)
}

/// A column of the best jobs: its name, and the cell of a job.
type Column = (&'static str, fn(&Best) -> Cell);

const FIGURES: [Column; 7] = [
    ("rms error", |b| Cell::figure(b.error.rms, 4)),
    ("largest", |b| Cell::figure(b.error.max, 4)),
    ("type", |b| Cell::words(b.type_name())),
    ("transmission", |b| {
        Cell::number(b.transmission_worst_deg, format!("{}°", significant(b.transmission_worst_deg, 3)))
    }),
    ("link ratio", |b| Cell::figure(b.link_ratio, 3)),
    ("extent", |b| Cell::figure(b.extent, 4)),
    ("longest", |b| Cell::figure(b.longest, 4)),
];

fn best(plan: &Plan, summary: &Summary) -> Markup {
    let Some(first) = summary.best.first() else {
        return html! { p { "No job has an answer." } };
    };
    let mut columns: Vec<(&str, bool)> = vec![("job", true)];
    columns.extend(plan.vary.iter().map(|varied| (varied.key.as_str(), false)));
    columns.push(("acceptable", false));
    columns.extend(FIGURES.map(|(name, _)| (name, name != "type")));
    let row = |row: &Row<()>| {
        let accepted = row.best.as_ref().is_some_and(|best| best.accepted);
        html! { tr {
            td.n { (row.job) }
            @for varied in &plan.vary { td { (clean(&row.values.get(&varied.key).map_or(String::new(), value))) } }
            (Cell::verdict(if accepted { "yes" } else { "no" }, accepted))
            @if let Some(best) = &row.best { @for (_, cell) in FIGURES { (cell(best)) } }
        } }
    };
    html! {
        (scrolling("The best jobs", "wide", &columns, summary.best.iter().map(row)))
        p { "This command runs the first of them alone:" }
        pre { code { (clean(&command(plan, first))) } }
    }
}

/// Returns the command that runs a job by itself.
fn command(plan: &Plan, row: &Row<()>) -> String {
    let set = plan.vary.iter().filter_map(|varied| {
        let typed = typed(row.values.get(&varied.key)?);
        let pair = format!("{}={typed}", varied.key);
        let plain = pair.chars().all(|c| c.is_ascii_alphanumeric() || "._-=+".contains(c));
        Some(if plain {
            format!(" --set {pair}")
        } else {
            format!(" --set '{}'", pair.replace('\'', r"'\''"))
        })
    });
    format!("linkwright synth {}{}", plan.problem.name, set.collect::<String>())
}

fn reasons(summary: &Summary) -> Markup {
    let mut reasons: Vec<(&String, &u64)> = summary.reasons.iter().collect();
    reasons.sort_by_key(|(reason, count)| (std::cmp::Reverse(**count), *reason));
    let rows = reasons.iter().map(|(reason, count)| {
        html! { tr { (Cell::number(**count as f64, grouped(**count))) td { (clean(reason)) } } }
    });
    scrolling("What was refused", "", &[("jobs", true), ("reason", false)], rows)
}
