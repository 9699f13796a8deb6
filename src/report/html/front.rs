//! The page of a front: a scatter plot of two or three wishes, a table of all members, and a drawing of each.

use super::PLAYER_STYLE;
use super::page::{Page, paragraph, section};
use super::picks::{figures, thumbnail};
use super::scatter::scatter_svg;
use super::table::{Cell, Column, scrolling};
use crate::record::{Front, Member, Record};
use crate::report::contact_sheet::thumbnail_svg;
use crate::report::front::{LIMITS, TORQUE_MEANS, has_torque, meaning};
use crate::report::text::{capitalised, clean, grouped, significant};
use crate::report::{table as text_table, words};
use maud::{Markup, html};

/// The largest number of members that are drawn.
const MOST_DRAWN: usize = 60;

/// Returns the page of a record's front: a whole HTML file, which needs no script. A record without a front has a page
/// that says so.
pub fn front_html(record: &Record) -> String {
    let name = words::problem_name(record);
    Page {
        title: &format!("{name}: front"),
        styles: &[PLAYER_STYLE, include_str!("report.css")],
        body: body(record),
        data: "{}",
        modules: &[],
    }
    .render()
}

fn body(record: &Record) -> Markup {
    let source = record.problem.source.as_deref().map(clean).filter(|source| !source.is_empty());
    let front = record.front.as_ref().filter(|front| !front.members.is_empty());
    html! {
        a.skip href="#members" { "To the linkages" }
        header {
            h1 { (words::problem_name(record)) ": the front" }
            @if let Some(source) = source { (paragraph("source", &source)) }
            (paragraph("facts", &capitalised(&text_table::facts(record))))
            @match front {
                Some(front) => {
                    (paragraph("lead", &meaning(front)))
                    (paragraph("facts", &about(record, front)))
                }
                None => (paragraph("lead", "The front is empty: no acceptable linkage was found.")),
            }
        }
        main { @if let Some(front) = front { (sections(record, front)) } }
        footer {
            p { "Written by linkwright " (env!("CARGO_PKG_VERSION")) " from the record alone. report.html shows the candidates of the search." }
        }
    }
}

/// Returns the limits that hold for all members, the knees, and the cost.
fn about(record: &Record, front: &Front) -> String {
    let knees: Vec<String> = numbered(front).filter(|(_, m)| m.knee).map(|(n, _)| n.to_string()).collect();
    let knees = match knees.as_slice() {
        [] => String::new(),
        [only] => format!(
            " Linkage {only} is at a knee: a little more of one wish costs much of another on either side."
        ),
        [first @ .., last] => format!(
            " Linkages {} and {last} are at knees: a little more of one wish costs much of another on either side.",
            first.join(", ")
        ),
    };
    format!(
        "{LIMITS}{knees} It took {} evaluations beside those of the search.{}",
        grouped(front.evaluations),
        ending(record)
    )
}

fn ending(record: &Record) -> &'static str {
    if record.termination.reproducible { "" } else { " The run was cut short: a longer one may find more." }
}

fn numbered(front: &Front) -> impl Iterator<Item = (usize, &Member)> {
    (1..).zip(&front.members)
}

fn sections(record: &Record, front: &Front) -> Markup {
    let chart = scatter_svg(record, front);
    let inline = chart.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    html! {
        section.card id="plot" aria-label="The trade-off" {
            figure.chart { (maud::PreEscaped(inline)) }
        }
        (section("members", "The linkages side by side", members(record, front)))
        (section("drawings", "Drawings", drawings(record, front)))
    }
}

fn members(record: &Record, front: &Front) -> Markup {
    let mut columns: Vec<Column<&Member>> = vec![
        ("rms error", true, &|m| Cell::figure(m.figures.rms, 4)),
        ("largest", true, &|m| Cell::figure(m.figures.max, 4)),
        ("transmission", true, &|m| Cell::degrees(m.figures.transmission_deg)),
        ("extent", true, &|m| Cell::figure(m.figures.extent, 4)),
        ("longest length", true, &|m| Cell::figure(m.figures.longest, 4)),
        ("link ratio", true, &|m| Cell::figure(m.figures.link_ratio, 3)),
        ("sensitivity", true, &|m| Cell::figure(m.figures.sensitivity, 3)),
        ("type", false, &|m| Cell::words(m.candidate.type_name())),
        ("", false, &|m| Cell { class: Some("knee"), ..Cell::words(if m.knee { "knee" } else { "" }) }),
    ];
    let has_torque = has_torque(front);
    if has_torque {
        let torque: Column<&Member> = ("peak torque, N m", true, &|m| {
            m.figures.peak_torque.map_or(Cell::words(""), |t| Cell::figure(t, 4))
        });
        columns.insert(7, torque);
    }
    let torque = if has_torque { TORQUE_MEANS } else { "" };
    let heads: Vec<(&str, bool)> =
        std::iter::once(("#", true)).chain(columns.iter().map(|column| (column.0, column.1))).collect();
    let rows = numbered(front).map(|(n, member)| {
        html! {
            tr {
                th.n scope="row" {
                    @if n <= MOST_DRAWN { a href={ "#linkage-" (n) } { (n) } } @else { (n) }
                }
                @for (_, _, cell) in &columns { (cell(&member)) }
            }
        }
    });
    let lengths = match words::unit_suffix(record).trim() {
        "" => String::new(),
        "in" => "Lengths in inches. ".to_owned(),
        unit => format!("Lengths in {unit}. "),
    };
    html! {
        (scrolling("Members of the front", "wide tight", &heads, rows))
        (paragraph("notes", &format!("{lengths}{NOTES}{torque}")))
    }
}

const NOTES: &str = "transmission: the worst angle, 0 to 90°; large is good. extent: the diagonal of the box of all joints \
    and P over the motion used. longest length: of ground, a, b, c, d and e. link ratio: longest to shortest link. \
    sensitivity: how far the path moves (rms; of a function: how much the output changes, in degrees) for independent errors of all dimensions, per unit of their standard deviation. \
    linkage-1.toml is the first of these linkages, and RESULT:front-1 names it in other commands.";

fn drawings(record: &Record, front: &Front) -> Markup {
    let more = front.members.len().saturating_sub(MOST_DRAWN);
    html! {
        ul.gallery {
            @for (n, member) in numbered(front).take(MOST_DRAWN) {
                @let f = &member.figures;
                @let title = format!("Linkage {n}");
                li id={ "linkage-" (n) } {
                    (thumbnail(&thumbnail_svg(record, &member.candidate, &title)))
                    h3 {
                        (title) " " small { (member.candidate.type_name()) }
                        @if member.knee { " " small.knee { "knee" } }
                    }
                    (figures(record, [f.rms, f.max], f.transmission_deg, [Some(f.extent), Some(f.longest)]))
                }
            }
        }
        @if more > 0 {
            (paragraph("notes", &format!("{} more are in the table alone.", significant(more as f64, 3))))
        }
    }
}
