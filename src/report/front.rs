//! The front as text: a row for each member.

use super::grid::Align::{Left, Right};
use super::grid::{Cell, Colour, Column, Grid, Ink, plain};
use super::table::{count, heading};
use super::text::{brief, indented, significant};
use super::words;
use crate::mechanism::Unit;
use crate::record::{Axis, Front, Member, Record};

/// Returns the page of `front` on a terminal: the problem, a row for each member, the meaning of the columns, the
/// closest candidate, and the cost. Empty if the record has no front, or a front without members.
pub fn front_text(record: &Record, colour: Colour) -> String {
    let Some(front) = record.front.as_ref().filter(|front| !front.members.is_empty()) else {
        return String::new();
    };
    let mut out = heading(record, colour);
    out.push('\n');
    out.push_str(&rows(front, colour));
    out.push('\n');
    out.push_str(&indented(&format!("{} {LIMITS}", meaning(front))));
    out.push('\n');
    let lengths = match record.problem.unit {
        None => String::new(),
        // "in in" would look like a mistake.
        Some(Unit::In) => " Lengths in inches.".to_owned(),
        Some(unit) => format!(" Lengths in {}.", unit.label()),
    };
    let torque = if has_torque(front) { TORQUE_MEANS } else { "" };
    out.push_str(&indented(&format!("{COLUMNS_MEAN}{torque}{lengths}")));
    if let Some(closest) = closest(record) {
        out.push('\n');
        out.push_str(&indented(&closest));
    }
    out.push('\n');
    out.push_str(&indented(&cost(record, front)));
    out
}

/// The meaning of the columns.
const COLUMNS_MEAN: &str = "rms, max: the error. transmission: the worst angle, from 0 to 90°; large is good. extent: the \
    diagonal of the box of all joints and P over the motion used. longest: the longest of ground, a, b, c, d and e. ratio: \
    longest to shortest link. sensitivity: how far the path moves (rms; of a function: how much the output changes, in \
    degrees) for independent errors of all dimensions, per unit of their standard deviation. knee: a little more of one wish costs much of another on either side.";

/// The meaning of the column of torques.
pub(super) const TORQUE_MEANS: &str = " peak torque: the largest on the crank under the loads, in N m.";

/// The limits that hold for all members.
pub(super) const LIMITS: &str = "Every one meets all requirements of the problem.";

/// Returns the meaning of the front, as a sentence or two: the axes on which none is beaten, and how many were found.
pub(super) fn meaning(front: &Front) -> String {
    let axes = axes(front);
    match front.members.len() {
        1 => format!("No other linkage that was found beats this one in any of {axes}."),
        n if n < front.points => format!(
            "None of these linkages is beaten by another in all of {axes}; {n} of the {} that were asked for were found.",
            front.points
        ),
        _ => format!("None of these linkages is beaten by another in all of {axes}."),
    }
}

/// Returns the names of the axes in words: `rms error, transmission angle and extent`.
pub(super) fn axes(front: &Front) -> String {
    let names: Vec<&str> = front.axes.iter().map(|axis| in_words(*axis)).collect();
    match names.as_slice() {
        [] => "nothing".to_owned(),
        [only] => (*only).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// Returns the name of an axis in words.
pub(super) fn in_words(axis: Axis) -> &'static str {
    match axis {
        Axis::Rms => "rms error",
        Axis::Max => "largest error",
        Axis::Transmission => "transmission angle",
        Axis::Extent => "extent",
        Axis::Longest => "longest link",
        Axis::LinkRatio => "link ratio",
        Axis::Sensitivity => "sensitivity",
        Axis::PeakTorque => "peak torque",
    }
}

/// Returns whether a member has a peak torque: of a problem with loads.
pub(super) fn has_torque(front: &Front) -> bool {
    front.members.iter().any(|member| member.figures.peak_torque.is_some())
}

fn rows(front: &Front, colour: Colour) -> String {
    let numbered: Vec<(usize, &Member)> = (1..).zip(&front.members).collect();
    type Row<'a> = (usize, &'a Member);
    let number =
        |figure: fn(&Member) -> f64, digits| move |row: &Row<'_>| plain(significant(figure(row.1), digits));
    let knee = |row: &Row<'_>| -> Cell { (if row.1.knee { "knee" } else { "" }.to_owned(), Ink::Good) };
    let angle = |row: &Row<'_>| plain(format!("{}°", significant(row.1.figures.transmission_deg, 3)));
    let (rms, max) = (number(|m| m.figures.rms, 4), number(|m| m.figures.max, 4));
    let (extent, longest) = (number(|m| m.figures.extent, 4), number(|m| m.figures.longest, 4));
    let (ratio, sensitivity) = (number(|m| m.figures.link_ratio, 3), number(|m| m.figures.sensitivity, 3));
    let torque =
        |row: &Row<'_>| plain(row.1.figures.peak_torque.map_or(String::new(), |t| significant(t, 4)));
    let mut columns: Vec<Column<'_, Row<'_>>> = vec![
        (Right, "#", &|row| plain(row.0.to_string())),
        (Right, "rms", &rms),
        (Right, "max", &max),
        (Right, "transmission", &angle),
        (Right, "extent", &extent),
        (Right, "longest", &longest),
        (Right, "ratio", &ratio),
        (Right, "sensitivity", &sensitivity),
        (Left, "", &knee),
    ];
    if has_torque(front) {
        columns.insert(columns.len() - 1, (Right, "peak torque", &torque));
    }
    Grid::of(&numbered, &columns).render(colour)
}

/// Returns a line on the closest candidate of the search before the front.
fn closest(record: &Record) -> Option<String> {
    let best = record.candidates.first()?;
    let unit = words::error_unit(record);
    let others = match record.candidates.len() {
        1 => String::new(),
        n => {
            format!(" The search found {}: candidates.csv and report.html have them.", count(n, "candidate"))
        }
    };
    Some(format!(
        "Closest candidate of the search: rms {}{unit}, {}, worst transmission angle {}°.{others}",
        significant(best.error.rms, 4),
        best.type_name(),
        brief(best.transmission_deg.worst, 3),
    ))
}

/// Returns the evaluations of the front and of all, and whether the run can be repeated.
fn cost(record: &Record, front: &Front) -> String {
    let mut text = format!(
        "{} for the front, {} in all (seed {}).",
        count(front.evaluations as usize, "evaluation"),
        count(record.evaluations.objective as usize, "evaluation"),
        record.seed,
    );
    if !record.termination.reproducible {
        text.push_str(
            " It was cut short, so that it cannot be repeated to the digit; a longer run may find more.",
        );
    }
    text
}
