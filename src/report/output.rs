//! The words for the output of a function: the angle of a follower or of a block, or the place of a slider.

use super::text::{brief, significant};
use crate::mechanism::LinkageKind;
use crate::record::{Candidate, Record};
use crate::task::Sense;
use crate::task::spec::ProblemSpec;

/// Returns the name of the unit of lengths, `length` without one.
pub(super) fn length_name(record: &Record) -> String {
    record.problem.unit.map_or_else(|| "length".to_owned(), |unit| unit.label().to_owned())
}

/// Returns the name of the output link of a function: `follower`, `block` or `slider` where all kinds that are searched for
/// have the same, else `output`.
pub(super) fn link(spec: &ProblemSpec) -> &'static str {
    let links: Vec<&str> = LinkageKind::ALL
        .into_iter()
        .filter(|kind| spec.design.searches(*kind))
        .map(|kind| link_of(kind, spec.task.is_of_places()))
        .collect();
    match links.as_slice() {
        [first, rest @ ..] if rest.iter().all(|link| link == first) => first,
        _ => "output",
    }
}

fn link_of(kind: LinkageKind, is_of_places: bool) -> &'static str {
    match (kind, is_of_places) {
        (LinkageKind::FourBar, _) => "follower",
        (LinkageKind::SliderCrank, _) => "slider",
        (LinkageKind::SixBar | LinkageKind::EightBar, _) => "output",
        (LinkageKind::InvertedSliderCrank, true) => "rod",
        (LinkageKind::InvertedSliderCrank, false) => "block",
    }
}

/// Returns the output of a candidate of a function: `follower's angle`, `slider's place`.
pub(super) fn of(candidate: &Candidate) -> String {
    let what = if candidate.output_offset.is_some() { "place" } else { "angle" };
    format!("{}'s {what}", own_link(candidate))
}

/// Returns the title of a chart of the outputs of a candidate.
pub(super) fn title(candidate: &Candidate) -> &'static str {
    match (candidate.linkage.kind(), candidate.output_offset.is_some()) {
        (LinkageKind::FourBar, _) => "Follower",
        (LinkageKind::SliderCrank, _) => "Slider",
        (LinkageKind::SixBar | LinkageKind::EightBar, _) => "Output",
        (LinkageKind::InvertedSliderCrank, true) => "Rod",
        (LinkageKind::InvertedSliderCrank, false) => "Block",
    }
}

/// Returns the name of the output link of a candidate.
fn own_link(candidate: &Candidate) -> &'static str {
    link_of(candidate.linkage.kind(), candidate.output_offset.is_some())
}

/// Returns the starting angles of a function's links, with the ranges that are free: `the crank from 31.8° and the follower
/// from 61.5° through 88.2°, in the same sense`.
pub(super) fn offsets(candidate: &Candidate, unit: &str) -> Option<String> {
    if let Some(place) = candidate.output_offset {
        return Some(offsets_of_places(candidate, place, unit));
    }
    let [input, output] =
        [candidate.input_offset_deg?, candidate.output_offset_deg?].map(|deg| significant(deg, 6));
    let sense = match candidate.sense? {
        Sense::Opposite => "opposite senses",
        Sense::Same | Sense::Any => "the same sense",
    };
    let through = |range: Option<f64>| {
        range.map_or_else(String::new, |range| format!(" through {}°", significant(range, 6)))
    };
    let [of_crank, of_follower] = [candidate.input_range_deg, candidate.output_range_deg].map(through);
    let link = own_link(candidate);
    Some(format!(
        "from the line A-B, the crank from {input}°{of_crank} and the {link} from {output}°{of_follower}, in {sense}"
    ))
}

/// Returns the crank's angle and the slider's place at an input and an output of 0.
fn offsets_of_places(candidate: &Candidate, place: f64, unit: &str) -> String {
    let input = significant(candidate.input_offset_deg.unwrap_or(0.0), 6);
    let place = significant(place, 6);
    let is_opposite = candidate.sense == Some(Sense::Opposite);
    match candidate.linkage.kind() {
        LinkageKind::InvertedSliderCrank => {
            let way = if is_opposite { "from the pin C back" } else { "from the pin C" };
            format!(
                "the crank from {input}° off the line A-B, the block from {place}{unit} along the rod {way}"
            )
        }
        _ => {
            let way = if is_opposite { "against the line" } else { "along the line" };
            format!(
                "the crank from {input}° off the slider's line, the slider from {place}{unit} {way}, counted from the foot of the \
                 perpendicular from A"
            )
        }
    }
}

/// Returns where the output link of a function starts: `follower from 61.5°, counter-clockwise as its outputs rise`.
pub(super) fn starts_from(candidate: &Candidate, unit: &str) -> Option<String> {
    if let Some(place) = candidate.output_offset {
        let way = match (candidate.linkage.kind(), candidate.sense? == Sense::Opposite) {
            (LinkageKind::InvertedSliderCrank, false) => "block from C along the rod",
            (LinkageKind::InvertedSliderCrank, true) => "block from C back along the rod",
            (_, false) => "slider along its line",
            (_, true) => "slider against its line",
        };
        return Some(format!("{way} from {}{unit}", brief(place, 5)));
    }
    let from = candidate.output_offset_deg? + candidate.linkage.ground_angle().to_degrees();
    let way = if candidate.sense? == Sense::Opposite { "clockwise" } else { "counter-clockwise" };
    let through =
        candidate.output_range_deg.map_or_else(String::new, |range| format!(" through {}°", brief(range, 5)));
    let link = own_link(candidate);
    Some(format!("{link} from {}°{through}, {way} as outputs rise", brief(from, 5)))
}
