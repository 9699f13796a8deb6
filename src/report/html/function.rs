//! The function of a candidate on the page: its graph, the error, and a table of the pairs.

use super::page::drawn;
use super::table::{minus, scrolling};
use crate::record::{Candidate, Record};
use crate::report::function::{GeneratedPair, chart_svg, pairs};
use crate::report::text::{NO_NUMBER, significant};
use crate::report::words;
use maud::{Markup, html};

/// The most pairs in the table.
const MOST_PAIRS: usize = 400;

/// Returns the graph of a candidate's function with its error, and the pairs, folded away; nothing for another task.
pub(super) fn function(record: &Record, c: &Candidate, title: &str) -> Markup {
    let Some(chart) = chart_svg(record, c) else { return Markup::default() };
    let all = pairs(&record.problem.resolved.task, c);
    let unit = words::error_unit(record).trim().to_owned();
    let [wanted, generated, error] =
        ["output wanted", "generated", "error"].map(|head| format!("{head} {unit}").trim_end().to_owned());
    let heads = [("pair", true), ("input °", true), (&wanted, true), (&generated, true), (&error, true)];
    let number = |value: f64| minus(&significant(value, 6));
    let row = |(i, pair): (usize, &GeneratedPair)| {
        let of = |value: Option<f64>, digits: usize| {
            value.map_or(NO_NUMBER.to_owned(), |value| minus(&significant(value, digits)))
        };
        html! {
            tr {
                th scope="row" class="n" { (i) }
                td class="n" { (number(pair.input)) }
                td class="n" { (number(pair.wanted)) }
                td class="n" { (of(pair.generated, 6)) }
                td class="n" { (of(pair.error(), 4)) }
            }
        }
    };
    let every = all.len().div_ceil(MOST_PAIRS).max(1);
    let rows: Vec<Markup> = all.iter().enumerate().step_by(every).map(row).collect();
    html! {
        (drawn(&chart))
        details {
            summary { "Every pair: wanted, generated, error" }
            (scrolling(&format!("Pairs of {title}"), "", &heads, rows))
        }
    }
}
