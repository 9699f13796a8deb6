//! Verdicts, requirements and endings in plain words.

use super::body::{self, Part};
use super::text::{brief, clean, exact, significant};
use crate::mechanism::Unit;
use crate::record::{Candidate, Figure, Pick, Reason, Record, Requirement};
use crate::task::requirement::RequirementKind;
use crate::task::spec::{BodySpec, Measure, TaskSpec, TransmissionOver};
use crate::task::{AngleOffset, Defect, Output, Sense, TaskKind};

/// An objection: one reason why a candidate is not accepted.
pub(super) struct Objection {
    /// A word for a narrow column: `transmission`.
    pub(super) key: String,
    /// A sentence part: `worst transmission angle 12.3°, at least 30° asked`.
    pub(super) sentence: String,
}

/// Returns the reasons why a candidate is not accepted, in the order: requirements, defects, tolerance. Empty for an
/// accepted one.
pub(super) fn objections(record: &Record, candidate: &Candidate) -> Vec<Objection> {
    if candidate.accepted {
        return Vec::new();
    }
    let task = &record.problem.resolved.task;
    let of_defect = |d: &Defect| Objection { key: d.name().to_owned(), sentence: of_defect(task, d) };
    let unmet = candidate.requirements.iter().filter(|r| !r.met);
    let mut list: Vec<Objection> = unmet
        .filter(|r| !forbidden(record, candidate).any(|defect| defect.name() == r.name))
        .map(|r| {
            let pointed = part_of(&record.problem.resolved.task, r)
                .and_then(|part| of_tolerance(record, candidate, part));
            pointed.unwrap_or_else(|| of_requirement(r))
        })
        .collect();
    list.extend(forbidden(record, candidate).map(of_defect));
    if !candidate.requirements.iter().any(is_tolerance) {
        list.extend(Part::ALL.into_iter().filter_map(|part| of_tolerance(record, candidate, part)));
    }
    if list.is_empty() {
        list.push(Objection { key: "reason not recorded".into(), sentence: "reason not recorded".into() });
    }
    list
}

/// Returns the defects for which a candidate is not accepted.
fn forbidden<'a>(record: &Record, candidate: &'a Candidate) -> impl Iterator<Item = &'a Defect> {
    candidate.defects.iter().filter(|defect| record.problem.resolved.require.forbids(defect))
}

fn is_tolerance(requirement: &Requirement) -> bool {
    RequirementKind::names_tolerance(&requirement.name)
}

/// Returns the part of the error that a tolerance limits; `None` for any other requirement.
fn part_of(task: &TaskSpec, requirement: &Requirement) -> Option<Part> {
    Part::ALL.into_iter().find(|part| part.tolerance(task).name() == requirement.name)
}

/// Returns a text on the targets of a task: its word "point" is "pose" in a motion.
pub(super) fn of_targets(task: &TaskSpec, text: &str) -> String {
    if task.body.is_some() { text.replace("point", task.noun()) } else { text.to_owned() }
}

/// Returns a defect as a sentence part.
pub(super) fn of_defect(task: &TaskSpec, defect: &Defect) -> String {
    let said = match defect {
        Defect::Order { .. } if defect.is_to_and_fro() => {
            "runs to and fro: back to point 0 only through all other points in reverse".to_owned()
        }
        Defect::Order { at } => format!("out of order at {}", points(at)),
        Defect::Branch { at } => format!("passes a toggle: {} on another branch than point 0", points(at)),
        Defect::Circuit { at } => {
            format!("{} out of reach from point 0 without taking the linkage apart", points(at))
        }
    };
    of_targets(task, &said)
}

/// Returns a list of points such as `point 3`, `points 3, 7 and 9`, `points 1 to 17`, `points 0, 2, 5, 8, 11 and 4
/// more`.
fn points(at: &[usize]) -> String {
    const SHOWN: usize = 5;
    match at {
        [] => "some point".to_owned(),
        [only] => format!("point {only}"),
        [first, .., last] if at.len() > 2 && at.windows(2).all(|w| w[0].checked_add(1) == Some(w[1])) => {
            format!("points {first} to {last}")
        }
        [most @ .., last] if at.len() <= SHOWN => format!("points {} and {last}", joined(most)),
        _ => format!("points {} and {} more", joined(&at[..SHOWN]), at.len() - SHOWN),
    }
}

/// Returns numbers in a row: `2, 5, 8`.
pub(super) fn joined(at: &[usize]) -> String {
    at.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

fn of_requirement(requirement: &Requirement) -> Objection {
    let (mut value, mut limit) = (figure(&requirement.value, short), figure(&requirement.limit, short));
    if value == limit {
        // Rounding must not make a missed limit look met.
        (value, limit) = (figure(&requirement.value, exact), figure(&requirement.limit, exact));
    }
    let name = Some(clean(&requirement.name)).filter(|name| !name.is_empty());
    let name = name.unwrap_or("a requirement".to_owned());
    let plain = format!("{name}: {value}, limit {limit}");
    let kind = RequirementKind::named(&requirement.name).map(RequirementKind::definition);
    let (key, sentence) = match (kind, name.strip_prefix("design."), &requirement.limit) {
        (Some(kind), ..) => (kind.short, (kind.objection)(&value, &limit).unwrap_or(plain)),
        (None, Some(key), Figure::Numbers(_)) => {
            (key, format!("{key} = {value}, outside of its bounds [{limit}]"))
        }
        _ => (name.as_str(), plain),
    };
    Objection { key: key.to_owned(), sentence }
}

fn short(value: f64) -> String {
    brief(value, 5)
}

pub(super) fn figure(figure: &Figure, number: fn(f64) -> String) -> String {
    match figure {
        Figure::Number(value) => number(*value),
        Figure::Numbers(values) => values.iter().take(8).map(|v| number(*v)).collect::<Vec<_>>().join(", "),
        Figure::Word(word) => clean(word),
        Figure::Words(words) => {
            clean(&words.iter().take(8).map(|w| clean(w)).collect::<Vec<_>>().join(" or "))
        }
    }
}

/// A deviation: the error at a target, with the tolerance there.
struct Deviation {
    point: usize,
    part: Part,
    error: f64,
    tolerance: f64,
}

impl Deviation {
    /// Returns the deviation of a candidate that is the largest part of its tolerance, of equal ones the first; `None` if
    /// no tolerances were asked for.
    fn worst(record: &Record, candidate: &Candidate) -> Option<Deviation> {
        let each = Part::ALL.into_iter().filter_map(|part| Self::worst_of(record, candidate, part));
        // Of equal ones that of the place.
        each.rev().max_by(|x, y| x.in_parts().total_cmp(&y.in_parts()))
    }

    /// Returns the worst deviation of one part of the error.
    fn worst_of(record: &Record, candidate: &Candidate, part: Part) -> Option<Deviation> {
        let task = &record.problem.resolved.task;
        let tolerances = match part {
            Part::Place => task.tolerance.as_ref()?,
            Part::Angle => task.body.as_ref()?.tolerance_deg.as_ref()?,
        };
        let deviations = tolerances.iter().enumerate().filter_map(|(point, tolerance)| {
            let error = body::error(task, candidate, point, part)?;
            Some(Deviation { point, part, error, tolerance: *tolerance })
        });
        deviations.max_by(|x, y| x.in_parts().total_cmp(&y.in_parts()).then(y.point.cmp(&x.point)))
    }

    /// Returns the error in parts of its tolerance; 0 if there is no error.
    fn in_parts(&self) -> f64 {
        if self.error == 0.0 { 0.0 } else { self.error / self.tolerance }
    }
}

/// Returns whether a candidate keeps to the tolerances, and if none does, by how much and at which point the nearest
/// one exceeds them: a sentence or two; `None` if no tolerance was asked for.
pub(super) fn tolerances(record: &Record) -> Option<String> {
    let band =
        |c: &Candidate| Deviation::worst(record, c).map_or(f64::NEG_INFINITY, |worst| worst.in_parts());
    // Among the candidates that meet everything else, if there are any.
    let otherwise_good = |c: &Candidate| {
        forbidden(record, c).next().is_none() && c.requirements.iter().all(|r| r.met || is_tolerance(r))
    };
    let nearest = |is_good: &dyn Fn(&Candidate) -> bool| {
        let measured = record.candidates.iter().filter(|c| is_good(c)).map(|c| (band(c), c));
        measured.min_by(|x, y| x.0.total_cmp(&y.0).then(x.1.rank.cmp(&y.1.rank))).map(|(_, c)| c)
    };
    let first = record.candidates.first()?;
    let best =
        if first.accepted { first } else { nearest(&otherwise_good).or_else(|| nearest(&|_| true))? };
    let mut rows = best.requirements.iter().filter(|r| is_tolerance(r)).peekable();
    rows.peek()?;
    let met = rows.all(|row| row.met);
    let worst = Deviation::worst(record, best)?;
    let (rank, noun, point) = (best.rank, record.problem.resolved.task.noun(), worst.point);
    let (an_error, unit) = match worst.part {
        Part::Place => ("an error", unit_suffix(record)),
        Part::Angle if record.problem.resolved.task.is_function() => ("an error", error_unit(record)),
        Part::Angle => ("an angle error", "°".to_owned()),
    };
    let [error, allowed, excess] =
        [worst.error, worst.tolerance, worst.error - worst.tolerance].map(|value| short(value) + &unit);
    if met {
        return Some(format!(
            "Tolerances met: #{rank} comes nearest to one at {noun} {point}, with {an_error} of {error} where {allowed} is \
             allowed."
        ));
    }
    let mut text = format!(
        "Tolerances not met by {excess} at {noun} {point}: the nearest, #{rank}, has {an_error} of {error} there and \
         {allowed} is allowed."
    );
    let least = worst.in_parts();
    if least.is_finite() {
        // Rounded up, so that the text never promises a narrower band than was found.
        let shown = brief((least * 1e4).ceil() / 1e4, 6);
        text.push_str(&format!(" The narrowest band found is {shown} times the tolerances."));
    }
    Some(text)
}

/// Returns the objection about the target whose error is the largest part of its tolerance, if tolerances were asked for
/// and are exceeded.
fn of_tolerance(record: &Record, candidate: &Candidate, part: Part) -> Option<Objection> {
    let Deviation { point, error, tolerance, .. } = Deviation::worst_of(record, candidate, part)?;
    let (mut shown, mut allowed) = (short(error), short(tolerance));
    if shown == allowed {
        (shown, allowed) = (exact(error), exact(tolerance));
    }
    let noun = record.problem.resolved.task.noun();
    let sentence = match part {
        Part::Place => format!("error {shown} at {noun} {point}, tolerance {allowed}"),
        Part::Angle if record.problem.resolved.task.is_function() => {
            let unit = error_unit(record);
            format!("error {shown}{unit} at {noun} {point}, tolerance {allowed}{unit}")
        }
        Part::Angle => format!("angle error {shown}° at {noun} {point}, tolerance {allowed}°"),
    };
    let key = part.tolerance(&record.problem.resolved.task).definition().short.to_owned();
    (error - tolerance > 0.0).then_some(Objection { key, sentence })
}

/// Returns the unit of errors: that of lengths, and of a function of angles degrees.
pub(super) fn error_unit(record: &Record) -> String {
    let task = &record.problem.resolved.task;
    if task.is_function() && !task.is_of_places() { "°".to_owned() } else { unit_suffix(record) }
}

/// Returns the objective if it is not the plain sum of squares: the heading of its column and a sentence on it. `unit`
/// follows lengths.
pub(super) fn minimised(
    measure: Measure,
    (kind, body): (TaskKind, Option<&BodySpec>),
    unit: &str,
) -> Option<(&'static str, String)> {
    let Some(body) = body.filter(|_| kind == TaskKind::Motion) else {
        let (head, sentence) = minimised_in_a_path(measure)?;
        return Some((head, sentence.replace("point", kind.noun())));
    };
    let weight = format!("angle_weight = {}{unit}", brief(body.angle_weight, 4));
    let sum = |each: &str| {
        let sentence = format!(
            "objective: the sum of squared errors of the place and of (angle_weight times the angle's error in radians), \
             squared{each}; {weight}. It was minimised and ranks; rms and max are of the place{}.",
            if each.is_empty() { "" } else { " and without weights" }
        );
        ("objective", sentence)
    };
    Some(match measure {
        Measure::Sum | Measure::SumInRange => sum(""),
        Measure::WeightedSum => sum(", each times its pose's weight"),
        Measure::Largest | Measure::LargestInRange => (
            "deviation",
            format!(
                "deviation: the largest error, of the place or of the angle in radians times angle_weight, which was \
                 minimised and ranks; {weight}."
            ),
        ),
        Measure::LargestPart => (
            "deviation",
            "deviation: the largest error of place or angle in parts of its pose's tolerance, which was minimised and \
             ranks; 1 is just met."
                .to_owned(),
        ),
    })
}

/// Returns the objective of a record as [`minimised`] does.
pub(super) fn minimised_in(record: &Record) -> Option<(&'static str, String)> {
    let spec = &record.problem.resolved;
    minimised(spec.measure(), (spec.task.kind(), spec.task.body.as_ref()), &unit_suffix(record))
}

fn minimised_in_a_path(measure: Measure) -> Option<(&'static str, &'static str)> {
    match measure {
        Measure::Sum => None,
        Measure::WeightedSum => Some((
            "weighted sq",
            "weighted sq: the sum of squared errors, each times its point's weight, which was minimised and ranks; rms and \
             max are without weights.",
        )),
        Measure::Largest => {
            Some(("deviation", "deviation: the largest error, which was minimised and ranks."))
        }
        Measure::SumInRange => Some((
            "sq in range",
            "sq in range: the weighted sum of squared errors in degrees of the outputs as they are written, which was minimised \
             and ranks: errors count in parts of the output's range, which is free; rms and max are in true degrees.",
        )),
        Measure::LargestInRange => Some((
            "in range",
            "in range: the largest error in degrees of the outputs as they are written, which was minimised and ranks: errors \
             count in parts of the output's range, which is free; rms and max are in true degrees.",
        )),
        Measure::LargestPart => Some((
            "deviation",
            "deviation: the largest error in parts of its point's tolerance, which was minimised and ranks; 1 is just met.",
        )),
    }
}

/// Returns the name of a sense in files.
pub(super) fn sense(sense: Sense) -> &'static str {
    match sense {
        Sense::Any => "any",
        Sense::Same => "same",
        Sense::Opposite => "opposite",
    }
}

/// Returns the errors of the body's angle in a motion: `angle error 0.31° rms, largest 0.8° at pose 3`.
pub(super) fn angle_errors(candidate: &Candidate) -> Option<String> {
    let angle = candidate.error.angle.as_ref()?;
    let [rms, max] = [angle.rms_deg, angle.max_deg].map(|degrees| significant(degrees, 3));
    Some(format!("angle error {rms}° rms, largest {max}° at pose {}", angle.max_at))
}

/// Returns the point whose error is the largest in parts of its tolerance, if tolerances were asked for.
pub(super) fn worst_in_parts(record: &Record, candidate: &Candidate) -> Option<usize> {
    Deviation::worst(record, candidate).map(|worst| worst.point)
}

/// Returns the reason why fewer candidates are listed than were asked for; `None` if there are as many, or none at all.
pub(super) fn fewer(record: &Record) -> Option<String> {
    let (listed, asked) = (record.candidates.len(), record.problem.resolved.solve.candidates);
    // Snapped and hand-made linkages come from no search.
    let searched = !matches!(record.termination.reason, Reason::Snapped | Reason::ByHand);
    if listed == 0 || listed >= asked || !searched {
        return None;
    }
    let accepted = record.candidates.iter().any(|c| c.accepted);
    let mut text = format!("{listed} of the {asked} candidates that were asked for: ");
    let task = &record.problem.resolved.task;
    let (is_motion, is_function) = (task.is_motion(), task.is_function());
    text.push_str(match (record.method.used == ["continuation"], accepted) {
        (false, true) if is_function => {
            "whatever else the search judged is one of these again, or is not accepted."
        }
        (false, false) if is_function => "whatever else the search judged is one of these again.",
        (false, true) if is_motion => {
            "whatever else the search judged takes the body the way of one of these, or is not accepted."
        }
        (false, false) if is_motion => {
            "whatever else the search judged takes the body the way of one of these."
        }
        (true, true) if is_motion => "no other linkage through these poses and points is accepted.",
        (true, false) if is_motion => "no other linkage passes these poses and points.",
        (true, true) => "no other linkage through these points is accepted.",
        (true, false) => "no other linkage passes these points.",
        (false, true) => {
            "whatever else the search judged draws one of these curves again, mirrored where the target is symmetric, or \
             is not accepted."
        }
        (false, false) => "whatever else the search judged draws one of these curves again.",
    });
    match record.termination.reason {
        Reason::EvaluationLimit => {
            text.push_str(" More evaluations may find others: the budget ended the search.")
        }
        Reason::TimeLimit | Reason::Cancelled => {
            text.push_str(" It was cut short: a longer search may find others.")
        }
        Reason::Converged | Reason::TargetReached | Reason::Stalled | Reason::Snapped | Reason::ByHand => {}
    }
    Some(text)
}

/// Returns `accepted`, or `no: transmission, order`, or `no: transmission +2`.
pub(super) fn verdict(record: &Record, candidate: &Candidate) -> String {
    let objections = objections(record, candidate);
    match objections.as_slice() {
        [] if candidate.goes_to_and_fro() => "accepted (to and fro)".to_owned(),
        [] if candidate.defects.is_empty() => "accepted".to_owned(),
        [] => format!("accepted ({})", defect_names(candidate)),
        [only] => format!("no: {}", only.key),
        [first, second] if first.key.len() + second.key.len() <= 16 => {
            format!("no: {}, {}", first.key, second.key)
        }
        [first, rest @ ..] => format!("no: {} +{}", first.key, rest.len()),
    }
}

/// Returns the names of the defects: `order, branch`.
pub(super) fn defect_names(candidate: &Candidate) -> String {
    candidate.defects.iter().map(Defect::name).collect::<Vec<_>>().join(", ")
}

/// Returns the motion over which a transmission angle was judged.
pub(super) fn over(over: TransmissionOver) -> &'static str {
    match over {
        TransmissionOver::Cycle => "cycle",
        TransmissionOver::Used => "used",
    }
}

/// Returns the reason as it is written in records: `time-limit`.
pub(super) fn reason_name(reason: Reason) -> &'static str {
    match reason {
        Reason::Converged => "converged",
        Reason::TargetReached => "target-reached",
        Reason::Stalled => "stalled",
        Reason::EvaluationLimit => "evaluation-limit",
        Reason::TimeLimit => "time-limit",
        Reason::Cancelled => "cancelled",
        Reason::Snapped => "snapped",
        Reason::ByHand => "by-hand",
    }
}

/// Returns the reason why the search of a record ended, as a clause after "ended:".
pub(super) fn ended(record: &Record) -> String {
    let few = record.repeats.as_ref().filter(|repeats| repeats.hits < MANY_HITS);
    match few {
        Some(repeats) if record.termination.reason == Reason::Converged => {
            let chance = repeats.unseen_better.map_or(String::new(), |chance| {
                format!("; a better one was not seen with a chance of {} %", significant(100.0 * chance, 2))
            });
            format!(
                "converged, the error kept its level through several times as many starts as it took to reach it \
                 (the best answer came from {} of {} independent starts{chance})",
                repeats.hits, repeats.starts
            )
        }
        _ => reason(record.termination.reason).to_owned(),
    }
}

/// Hits from which an answer counts as found again and again.
const MANY_HITS: u64 = 4;

/// Returns the reason why the search ended, as a clause after "ended:".
pub(super) fn reason(reason: Reason) -> &'static str {
    match reason {
        Reason::Converged => "converged, the best answer was found again and again from different starts",
        Reason::TargetReached => "target reached, as many good enough answers as were asked for",
        Reason::Stalled => "stalled, out of ideas before the budget was used up",
        Reason::EvaluationLimit => "the budget of evaluations was used up",
        Reason::TimeLimit => "the time limit was reached",
        Reason::Cancelled => "cancelled, these are the best answers until then",
        Reason::Snapped => {
            "snapped, an answer's lengths were brought to stock sizes and nothing else was searched for"
        }
        Reason::ByHand => "fitted under the hand, no search has looked for anything better",
    }
}

/// Returns the sentence for a run without advice: its missing parts were not looked for.
pub(super) fn without_advice(record: &Record) -> Option<&'static str> {
    let said = "No advice was asked for (solve.advice = false): what conflicts, what can be built and what limits cost \
                was not looked for.";
    (!record.problem.resolved.solve.advice).then_some(said)
}

/// Returns the timing of the target.
pub(super) fn timing(record: &Record) -> &'static str {
    if let Some(output) = &record.problem.resolved.task.output {
        let input = record.problem.resolved.task.timing.as_ref().map(|timing| timing.offset);
        if output.output == Output::Place {
            return match (input == Some(AngleOffset::Ground), output.offset == AngleOffset::Ground) {
                (false, false) => "both offsets free",
                (true, false) => "inputs from the ground's line, outputs' offset free",
                (false, true) => {
                    "inputs' offset free, outputs from A's foot on the line, or from C along the rod"
                }
                (true, true) => {
                    "inputs from the ground's line, outputs from A's foot on it, or from C along the rod"
                }
            };
        }
        return match (input == Some(AngleOffset::Ground), output.offset == AngleOffset::Ground) {
            (false, false) => "both offsets free",
            (true, false) => "inputs from the line A-B, outputs' offset free",
            (false, true) => "inputs' offset free, outputs from the line A-B",
            (true, true) => "both from the line A-B",
        };
    }
    let timing = record.problem.resolved.task.timing.as_ref();
    let is_partly = timing.is_some_and(|timing| !timing.free.is_empty());
    match timing.map(|timing| timing.offset) {
        None => "free timing",
        Some(AngleOffset::Free) if is_partly => "partly prescribed timing, offset free",
        Some(AngleOffset::Fixed) if is_partly => "partly prescribed timing, from the x axis",
        Some(AngleOffset::Ground) if is_partly => "partly prescribed timing, from the line A-B",
        Some(AngleOffset::Free) => "prescribed timing, offset free",
        Some(AngleOffset::Fixed) => "prescribed timing, from the x axis",
        Some(AngleOffset::Ground) => "prescribed timing, from the line A-B",
    }
}

/// Returns the place of a candidate in its record: `candidate 2 of 5`, `the smallest candidate`, `linkage 3 of 20 in the
/// front`.
pub(super) fn standing(record: &Record, candidate: &Candidate) -> String {
    let ranked = || format!("candidate {} of {}", candidate.rank, record.candidates.len());
    if candidate.rank > 0 {
        return ranked();
    }
    if let Some(pick) = Pick::ALL.into_iter().find(|pick| record.pick(*pick) == Some(candidate)) {
        return match pick {
            Pick::OtherKind => format!("the {} beside the candidates", candidate.type_name()),
            _ => format!("the {} candidate", pick.words()),
        };
    }
    let members = record.front.as_ref().map_or(&[][..], |front| &front.members);
    let place = members.iter().position(|member| member.candidate == *candidate);
    place.map_or_else(ranked, |i| format!("linkage {} of {} in the front", i + 1, members.len()))
}

/// Returns the problem's name; never empty.
pub(super) fn problem_name(record: &Record) -> String {
    named(&record.problem.name, "unnamed problem")
}

/// Returns a foreign name, or other words if it is empty.
pub(super) fn named(name: &str, otherwise: &str) -> String {
    let name = clean(name);
    if name.is_empty() { otherwise.to_owned() } else { name }
}

/// Returns ` mm`, or nothing if lengths have no unit.
pub(super) fn unit_suffix(record: &Record) -> String {
    length_suffix(record.problem.unit)
}

/// Returns ` mm`, or nothing without a unit.
pub(super) fn length_suffix(unit: Option<Unit>) -> String {
    unit.map_or(String::new(), |unit| format!(" {}", unit.label()))
}

/// Returns the names of the obstacles to acceptance, for files: the problem file's keys if there are any.
pub(super) fn unmet(record: &Record, candidate: &Candidate) -> Vec<String> {
    let mut names: Vec<String> =
        forbidden(record, candidate).map(|defect| defect.name().to_owned()).collect();
    for requirement in candidate.requirements.iter().filter(|r| !r.met) {
        let name = clean(&requirement.name).replace(';', ",");
        if !names.contains(&name) {
            names.push(name);
        }
    }
    if !candidate.accepted && !candidate.requirements.iter().any(is_tolerance) {
        let missed = Part::ALL.into_iter().filter_map(|part| of_tolerance(record, candidate, part));
        names.extend(missed.map(|objection| objection.key));
    }
    names
}
