//! Mobility and defects in words.

use super::page::list;
use crate::mechanism::four_bar::transmission::ForceTransmission;
use crate::mechanism::{InputRange, LinkageType};
use crate::record::{Candidate, Record};
use crate::report::text::{brief, capitalised, significant};
use crate::report::{exact, table, words};
use crate::task::spec::TransmissionOver;
use maud::Markup;

/// Returns the linkage's mobility and its motion along the points, as a list.
pub(super) fn mobility(record: &Record, c: &Candidate) -> Markup {
    let task = &record.problem.resolved.task;
    let noun = task.noun();
    let mut said = vec![of_type(c), range(c)];
    said.extend(table::motion(c).map(|motion| format!("Along the {noun}s: {motion}.")));
    said.push(transmission(c));
    said.extend(c.error.two_sided.map(|both| {
        let unit = words::unit_suffix(record);
        format!(
            "Path and curve, each from the other: {}{unit} in the mean of both ways together ({} % of the path's radius), {}{unit} at \
             most.",
            significant(both.mean, 3),
            significant(100.0 * both.mean_over_radius, 3),
            significant(both.worst, 3)
        )
    }));
    if c.defects.is_empty() {
        said.push(format!("No defect: the {noun}s are passed in order, on one circuit and on one branch."));
    }
    for defect in &c.defects {
        let forbidden = record.problem.resolved.require.forbids(defect);
        let verdict = if forbidden { "not allowed here" } else { "allowed here" };
        said.push(format!(
            "{} defect ({verdict}): {}.",
            capitalised(defect.name()),
            words::of_defect(task, defect)
        ));
    }
    if let Some(proof) = c.certified {
        let unit = words::unit_suffix(record);
        said.push(format!(
            "Proved: one {}, and only one, passes exactly through all {} within {}{unit} of this one.",
            record.exact.as_ref().map_or("linkage", exact::noun),
            record.exact.as_ref().map_or_else(|| "nine points".to_owned(), exact::targets),
            significant(proof.radius, 2)
        ));
    }
    list(said.iter().map(|sentence| sentence.replace(" -", " \u{2212}")))
}

fn of_type(c: &Candidate) -> String {
    let Some(linkage_type) = c.linkage_type else {
        let kind = capitalised(
            &c.type_name()
                .replacen("slider-crank", "slider\u{2011}crank", 1)
                .replace("inverted-", "inverted "),
        );
        let turns = if c.linkage.mobility().input_turns_fully() { "turns fully" } else { "rocks" };
        return format!(
            "{kind}: the crank {turns} (margin of a full turn {}).",
            significant(c.grashof_margin, 3)
        );
    };
    let words = match linkage_type {
        LinkageType::CrankRocker => "Crank-rocker: the crank turns fully, the follower rocks",
        LinkageType::RockerCrank => "Rocker-crank: the driven link A-C rocks, the follower B-D turns fully",
        LinkageType::DoubleCrank => "Double-crank: crank and follower both turn fully",
        LinkageType::DoubleRocker => "Double-rocker: crank and follower both rock",
        LinkageType::TripleRocker => "Triple-rocker: no link turns fully",
        LinkageType::ChangePoint => "Change point: it can lie flat, and leaves that position either way",
    };
    format!("{words} (Grashof margin {}).", significant(c.grashof_margin, 3))
}

/// Returns the range of the input.
fn range(c: &Candidate) -> String {
    let mobility = c.linkage.mobility();
    let of = |arc: &crate::mechanism::InputArc| {
        let (low, high) = (arc.middle - arc.half_width, arc.middle + arc.half_width);
        format!("between {}° and {}°", brief(low.to_degrees(), 5), brief(high.to_degrees(), 5))
    };
    match mobility.input {
        InputRange::Full => "A motor on the crank can run through.".to_owned(),
        InputRange::One(arc) => {
            format!("The crank can move {}; at both ends coupler and follower are in line.", of(&arc))
        }
        InputRange::Two([left, right]) => format!(
            "The crank can move {} or, assembled anew, {}; at the ends coupler and follower are in line.",
            of(&left),
            of(&right)
        ),
        InputRange::None => "The links cannot be joined.".to_owned(),
    }
}

fn transmission(c: &Candidate) -> String {
    let t = &c.transmission_deg;
    let over = match t.over {
        TransmissionOver::Cycle => "over the full turn",
        TransmissionOver::Used => "over the part used",
    };
    let verdict = ForceTransmission::of(t.worst).words();
    format!(
        "Transmission angle from {}° to {}° {over}: {}° from 0° or 180° at its worst; {verdict}.",
        significant(t.min, 4),
        significant(t.max, 4),
        significant(t.worst, 4),
    )
}
