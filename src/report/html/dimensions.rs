//! The exact dimensions, as they are written in a linkage file.

use super::data::MOST_ALTERNATIVES;
use super::page::paragraph;
use super::table::minus;
use crate::files::linkage_file::any_to_toml;
use crate::mechanism::Unit;
use crate::mechanism::four_bar::transmission::TransmissionExtremes;
use crate::mechanism::{CrankLinkage, LinkageKind, MultiLoop};
use crate::record::{Candidate, Record};
use crate::report::text::{clean, significant};
use crate::report::{output, words};
use maud::{Markup, html};
use std::f64::consts::TAU;

/// The largest number of characters of a name in a linkage file.
const MOST_NAME: usize = 50;

/// Returns a linkage file to copy, and the dimensions that it does not contain: the ground and the place of P along and
/// across the coupler.
pub(super) fn dimensions(record: &Record, c: &Candidate, short: &str) -> Markup {
    let unit = words::unit_suffix(record);
    let offset = c.linkage.coupler_offset();
    let [ground, along, across] =
        [c.linkage.ground().unwrap_or(0.0), offset.re, offset.im].map(|value| minus(&significant(value, 6)));
    let place = format!("P lies {along}{unit} along and {across}{unit} across");
    let text = match c.linkage.kind() {
        LinkageKind::FourBar => {
            format!("Ground AB {ground}{unit}; {place} from C to D (positive: to the left).")
        }
        LinkageKind::SliderCrank => format!("{place} from C to D (positive: to the left)."),
        LinkageKind::InvertedSliderCrank => {
            format!("Ground AB {ground}{unit}; {place} from C, along the rod (positive: to the left).")
        }
        LinkageKind::SixBar | LinkageKind::EightBar => several_loops(c, &unit),
    };
    let body = c.frame_deg.map(|frame_deg| {
        format!(
            "The body: P is its origin; its x axis lies {}° from the line from C to D (positive: counter-clockwise).",
            minus(&significant(frame_deg, 6))
        )
    });
    let function = output::offsets(c, &words::unit_suffix(record))
        .map(|offsets| format!("At an input and an output of 0: {offsets}."));
    let text = match function {
        // P is the follower's pin.
        Some(function) => format!("Ground AB {ground}{unit}. {function}"),
        None => text,
    };
    html! {
        (block(&named(record, short), record.problem.unit, &c.linkage))
        (paragraph("notes", &text))
        @if let Some(body) = body { (paragraph("notes", &body)) }
    }
}

/// Returns the dimensions of the alternatives, folded away.
pub(super) fn of_alternatives(c: &Candidate) -> Markup {
    html! {
        details {
            summary { "Dimensions of the cognates" }
            @for (i, a) in c.alternatives.iter().take(MOST_ALTERNATIVES).enumerate() {
                (block(&format!("cognate {}", i + 1), None, &a.linkage))
            }
        }
    }
}

/// Returns the kind of a linkage of several loops and the least transmission angle of each of its dyads.
fn several_loops(c: &Candidate, unit: &str) -> String {
    let Some(linkage) = c.linkage.multi_loop() else { return String::new() };
    let longest = significant(linkage.longest(), 5);
    format!(
        "{}. Longest distance of two joints of one link {longest}{unit}. Transmission angles: {}.",
        linkage.chain_kind().name(),
        transmissions(linkage)
    )
}

/// Returns the least distance from flat of the transmission angle of each dyad over the turn: `41.2° at D, 33.0° at F2`.
fn transmissions(linkage: &MultiLoop) -> String {
    let joints = ["D", "F2", "F3"];
    let all = linkage.transmissions_between([0.0, TAU]);
    let of = |(extremes, joint): (&TransmissionExtremes, &str)| {
        format!("{}° at {joint}", significant(extremes.worst().to_degrees(), 3))
    };
    all.iter().zip(joints).map(of).collect::<Vec<_>>().join(", ")
}

fn block(name: &str, unit: Option<Unit>, linkage: &CrankLinkage) -> Markup {
    html! { pre.dimensions { (without_comments(&any_to_toml(name, unit, linkage))) } }
}

/// Returns the file without its comments: the drawing on the page explains the letters.
fn without_comments(toml: &str) -> String {
    toml.lines().filter(|line| !line.starts_with('#')).map(|line| format!("{line}\n")).collect()
}

/// Returns a name that is legal in a linkage file.
fn named(record: &Record, short: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || " -_.".contains(c) { c } else { '-' };
    let name: String = clean(&record.problem.name).chars().take(MOST_NAME).map(plain).collect();
    let name = name.trim_matches([' ', '.', '-']);
    if name.is_empty() { format!("linkage-{short}") } else { format!("{name}-{short}") }
}
