//! The output of `synth`: the candidates of a run, or one line for each file of a batch.

use super::beside;
use super::grid::Align::{Left, Right};
use super::grid::{Cell, Colour, Column, Grid, Ink, plain, verdict};
use super::text::{
    COLUMNS, NO_NUMBER, brief, clean, exact, grouped, indented, shortened, significant, wrapped,
};
use super::{output, price, words};
use crate::mechanism::multi_loop::keys::{DyadKeys, PointKeys, StageKeys};
use crate::mechanism::{CrankLinkage, LinkageKind, MultiLoop, Unit};
use crate::record::{AngleErrorRecord, BestOfKind, Candidate, ErrorRecord, Reason, Record};
use crate::task::spec::{Measure, ProblemSpec, TaskSpec};
use crate::task::{Defect, TaskKind};

/// The largest number of candidates whose distances from the given points are stated.
const RAW_NAMED: usize = 3;

/// Returns the candidates of a run: the problem, a row for each candidate, the reasons why the others were not
/// accepted, the best linkage to copy, and the end of the search.
pub fn candidates_table(record: &Record, colour: Colour) -> String {
    let mut out = heading(record, colour);
    out.push('\n');
    if record.candidates.is_empty() {
        out.push_str("  No candidate was found.\n");
    } else {
        out.push_str(&match record.problem.resolved.task.kind() {
            TaskKind::Motion => rows_of_motion(record, colour),
            TaskKind::Function => rows_of_function(record, colour),
            TaskKind::Path => rows(record, colour),
        });
        out.push_str(&notes(record));
        out.push_str(&torques(record));
        out.push_str(&beside::lines(record));
        out.push_str(&best(record));
        out.push_str(&price::costs(record));
    }
    out.push_str(&price::relaxations(record));
    if let Some(said) = words::without_advice(record) {
        out.push('\n');
        out.push_str(&indented(said));
    }
    out.push('\n');
    out.push_str(&indented(&ending_sentences(record)));
    out
}

/// The largest number of candidates whose torques are stated.
const TORQUES_NAMED: usize = 10;

/// Returns a line on the peak torques of the candidates under the loads of the problem; empty without loads.
fn torques(record: &Record) -> String {
    if record.problem.resolved.loads.is_none() {
        return String::new();
    }
    let torque = |c: &Candidate| c.peak_torque.map_or(NO_NUMBER.to_owned(), |torque| significant(torque, 4));
    let shown = record.candidates.iter().take(TORQUES_NAMED);
    let all: Vec<String> = shown.map(|c| format!("{} ({})", torque(c), c.rank)).collect();
    let more = if record.candidates.len() > TORQUES_NAMED { ", .." } else { "" };
    indented(&format!("Peak torque on the crank under the loads, N m (candidate): {}{more}.", all.join(", ")))
}

/// Returns name, source, points, size and timing.
pub(super) fn heading(record: &Record, colour: Colour) -> String {
    let mut out = colour.paint(Ink::Strong, &shortened(&words::problem_name(record), COLUMNS));
    out.push('\n');
    out.push_str(&indented(&facts(record)));
    if let Some(source) = record.problem.source.as_deref().map(clean).filter(|s| !s.is_empty()) {
        out.push_str(&indented(&source));
    }
    out
}

/// Returns a text such as `18 points, size 1.082 m, prescribed timing, offset free, closed`.
pub(super) fn facts(record: &Record) -> String {
    let path = &record.problem.resolved.task;
    let mut facts = vec![count(path.len(), path.noun())];
    facts.extend(without_angle(path));
    facts.extend(ranges(&record.problem.resolved, &words::unit_suffix(record)));
    if let Ok(task) = path.to_task()
        && !path.is_function()
    {
        facts.push(format!("size {}{}", brief(task.size(), 4), words::unit_suffix(record)));
    }
    facts.push(words::timing(record).to_owned());
    if path.closed {
        facts.push("closed".to_owned());
    }
    if let Some(raw) = &path.raw {
        let unit = words::unit_suffix(record);
        facts.extend(
            raw.samples.map(|_| format!("taken along {} given points", grouped(raw.points.len() as u64))),
        );
        facts.extend(raw.smooth.map(|deviation| format!("smoothed over {}{unit}", brief(deviation, 4))));
    }
    facts.join(", ")
}

/// Returns the number of the poses of a motion that ask for the place alone, if there are any: `9 of them without an
/// angle`.
fn without_angle(task: &TaskSpec) -> Option<String> {
    let without = task.body.as_ref()?.angle_deg.iter().filter(|angle| angle.is_none()).count();
    (without > 0).then(|| format!("{} of them without an angle", grouped(without as u64)))
}

/// Returns how far the links of a function turn: `log10(x) over 1 to 2, crank 60°, follower 30 to 180°`.
fn ranges(spec: &ProblemSpec, unit: &str) -> Option<String> {
    let output = spec.task.output.as_ref()?;
    let task = &spec.task;
    let units = ["°", if task.is_of_places() { unit } else { "°" }];
    let [input, moved] = [0, 1].map(|which: usize| match output.ranges.bounds_deg()[which] {
        Some([low, high]) => format!("{} to {}°", brief(low, 5), brief(high, 5)),
        None => format!("{}{}", brief(task.written_ranges_deg()[which], 5), units[which]),
    });
    let formula = output.of.as_ref().map_or(String::new(), |of| {
        format!("{} over {} to {}, ", clean(&of.formula), brief(of.over[0], 5), brief(of.over[1], 5))
    });
    Some(format!("{formula}crank {input}, {} {moved}", output::link(spec)))
}

pub(super) fn count(n: usize, noun: &str) -> String {
    format!("{} {noun}{}", grouped(n as u64), if n == 1 { "" } else { "s" })
}

fn rows(record: &Record, colour: Colour) -> String {
    let measure = record.problem.resolved.measure();
    let ranks = words::minimised_in(record);
    // Beside the largest part of the tolerances the table shows that part's point, which need not be that of the
    // largest error.
    let parts = measure == Measure::LargestPart;
    let at: Column<'_, Candidate> = (Right, "at", &|c| plain(worst_at(record, c).to_string()));
    let rms: Column<'_, Candidate> = (Right, "rms", &|c| plain(significant(c.error.rms, 4)));
    let max: Column<'_, Candidate> = (Right, "max", &|c| plain(significant(c.error.max, 4)));
    let [first, second, third] = if parts { [at, rms, max] } else { [rms, max, at] };
    let objective = |c: &Candidate| if ranks.is_some() { c.error.objective } else { c.error.sum_sq };
    let grid = Grid::of(
        &record.candidates,
        &[
            (Right, "#", &|c| (c.rank.to_string(), Ink::Strong)),
            (Right, ranks.as_ref().map_or("sum of sq", |(head, _)| head), &|c| {
                plain(significant(objective(c), 6))
            }),
            first,
            second,
            third,
            (Right, "to curve", &|c| plain(significant(c.error.to_curve.rms, 4))),
            (Left, "type", &|c| plain(c.type_name())),
            (Right, "transmission", &|c| plain(transmission(c))),
            (Right, "ratio", &|c| plain(significant(c.link_ratio, 3))),
            (Left, "verdict", &|c| verdict(shortened(&words::verdict(record, c), 24), c.accepted)),
        ],
    );
    grid.render(colour)
}

/// The error in parts of the target's size, or in degrees, below which an answer is exact to a reader.
const EXACT: f64 = 1e-7;

/// Returns the rows of a motion: beside the errors of the place, those of the angle.
fn rows_of_motion(record: &Record, colour: Colour) -> String {
    let head = words::minimised_in(record).map_or("objective", |(head, _)| head);
    let size = record.problem.resolved.task.to_task().map_or(1.0, |task| task.size());
    // Of an exact answer only the power of ten matters.
    let short = |value: f64, scale: f64, digits: usize| {
        significant(value, if value < EXACT * scale { 1 } else { digits })
    };
    let length = |value: f64| plain(short(value, size, 4));
    let angle = |c: &Candidate, of: fn(&AngleErrorRecord) -> f64| {
        plain(c.error.angle.as_ref().map_or(NO_NUMBER.to_owned(), |a| format!("{}°", short(of(a), 1.0, 3))))
    };
    let grid = Grid::of(
        &record.candidates,
        &[
            (Right, "#", &|c| (c.rank.to_string(), Ink::Strong)),
            (Right, head, &|c| plain(short(c.error.objective, EXACT * size * size, 5))),
            (Right, "rms", &|c| length(c.error.rms)),
            (Right, "max", &|c| length(c.error.max)),
            (Right, "at", &|c| plain(worst_at(record, c).to_string())),
            (Right, "angle", &|c| angle(c, |angle| angle.rms_deg)),
            (Right, "max", &|c| angle(c, |angle| angle.max_deg)),
            (Left, "type", &|c| plain(c.type_name())),
            (Right, "transm.", &|c| plain(transmission(c))),
            (Right, "ratio", &|c| plain(significant(c.link_ratio, 3))),
            (Left, "verdict", &|c| verdict(shortened(&words::verdict(record, c), 18), c.accepted)),
        ],
    );
    grid.render(colour)
}

/// Returns the rows of a function: the errors of the output in degrees, and the angles from which both links start.
fn rows_of_function(record: &Record, colour: Colour) -> String {
    let ranks = words::minimised_in(record);
    let size = record.problem.resolved.task.to_task().map_or(1.0, |task| task.error_size());
    let error = |value: f64, digits| significant(value, if value < EXACT * size { 1 } else { digits });
    let (spec, unit) = (&record.problem.resolved, words::error_unit(record));
    let of_output = |value: f64| plain(error(value, 4) + &unit);
    let from = |deg: Option<f64>, through: Option<f64>| {
        let through = through.map_or_else(String::new, |range| format!(" +{range:.2}°"));
        plain(deg.map_or(NO_NUMBER.to_owned(), |deg| format!("{deg:.2}°{through}")))
    };
    let objective = |c: &Candidate| if ranks.is_some() { c.error.objective } else { c.error.sum_sq };
    let grid = Grid::of(
        &record.candidates,
        &[
            (Right, "#", &|c| (c.rank.to_string(), Ink::Strong)),
            (Right, ranks.as_ref().map_or("sum of sq", |(head, _)| head), &|c| {
                let value = objective(c);
                plain(significant(value, if value < EXACT * size * size * EXACT { 1 } else { 5 }))
            }),
            (Right, "rms", &|c| of_output(c.error.rms)),
            (Right, "max", &|c| of_output(c.error.max)),
            (Right, "at", &|c| plain(worst_at(record, c).to_string())),
            (Right, "crank", &|c| from(c.input_offset_deg, c.input_range_deg)),
            (Right, output::link(spec), &|c| match c.output_offset {
                Some(place) => plain(significant(place, 5) + &unit),
                None => from(c.output_offset_deg, c.output_range_deg),
            }),
            (Left, "type", &|c| plain(c.type_name())),
            (Right, "transm.", &|c| plain(transmission(c))),
            (Right, "ratio", &|c| plain(significant(c.link_ratio, 3))),
            (Left, "verdict", &|c| verdict(shortened(&words::verdict(record, c), 18), c.accepted)),
        ],
    );
    grid.render(colour)
}

/// Returns the worst transmission angle with the motion over which it was taken: `45.1° cycle`.
fn transmission(candidate: &Candidate) -> String {
    let (worst, over) = (candidate.transmission_deg.worst, words::over(candidate.transmission_deg.over));
    format!("{}° {over:<5}", significant(worst, 3))
}

/// Returns the point that decides the rank: that of the largest error, or of the largest in parts of the tolerances if
/// these are minimised.
pub(super) fn worst_at(record: &Record, candidate: &Candidate) -> usize {
    let parts = record.problem.resolved.measure() == Measure::LargestPart;
    let worst = if parts { words::worst_in_parts(record, candidate) } else { None };
    worst.unwrap_or(candidate.error.max_at)
}

/// Returns the meaning of the columns and the reasons why candidates were not accepted.
fn notes(record: &Record) -> String {
    let unit = record.problem.unit.map_or(String::new(), |unit| {
        // "in in" would look like a mistake.
        format!(" Lengths in {}.", if unit == Unit::In { "inches" } else { unit.label() })
    });
    let mut out = String::from("\n");
    let first = words::minimised_in(record).map_or(String::new(), |(_, sentence)| format!("{sentence} "));
    out.push_str(&indented(&format!("{first}{} ratio: longest to shortest link.{unit}", columns(record))));
    let more = [words::tolerances(record), against_raw(record), of_kinds(record), words::fewer(record)];
    for sentence in more.into_iter().flatten() {
        out.push('\n');
        out.push_str(&indented(&sentence));
    }
    // A hundred refusals for the same reason are combined into one line.
    let mut refusals: Vec<(Vec<usize>, String)> = Vec::new();
    for candidate in record.candidates.iter().filter(|c| !c.accepted) {
        let objections = words::objections(record, candidate);
        let text = objections.into_iter().map(|o| o.sentence).collect::<Vec<_>>().join("; ");
        match refusals.iter_mut().find(|(_, other)| *other == text) {
            Some((ranks, _)) => ranks.push(candidate.rank),
            None => refusals.push((vec![candidate.rank], text)),
        }
    }
    if !refusals.is_empty() {
        out.push_str("\n  Not accepted\n");
    }
    for (ranks, text) in refusals {
        let lead = ranks.iter().map(|rank| format!("#{rank}")).collect::<Vec<_>>().join(" ");
        out.push_str(&wrapped("    ", "      ", &format!("{lead}: {text}"), COLUMNS));
    }
    out
}

/// Returns the meaning of the columns but the objective and the ratio.
fn columns(record: &Record) -> &'static str {
    if record.problem.resolved.task.is_of_places() {
        return "rms, max: errors of the slider's place, at which pair (from 0) the largest. crank: its angle from the line of \
                the slider, or A-B, at an input of 0; then the slider's place at an output of 0, from the foot of the \
                perpendicular from A on its line; of an inverted slider-crank the block's along the rod from C. transm.: the \
                worst transmission angle, from 0 to 90°, over the crank's full turn (cycle) or between the pairs (used).";
    }
    if record.problem.resolved.design.searches(LinkageKind::InvertedSliderCrank)
        && record.problem.resolved.task.is_function()
    {
        return "rms, max: errors of the angle of the follower, or of the block, degrees, at which pair (from 0) the largest. \
                crank and the next: their angles from the line A-B at an input and an output of 0. transm.: the worst \
                transmission angle, from 0 to 90°, over the crank's full turn (cycle) or between the pairs (used).";
    }
    if record.problem.resolved.task.is_function() {
        return "rms, max: errors of the follower's angle, degrees, at which pair (from 0) the largest. crank, follower: \
                their angles from the line A-B at an input and an output of 0, + the range that they turn through where it is \
                free. transm.: the worst transmission angle, from \
                0 to 90°, over the crank's full turn (cycle) or between the pairs (used).";
    }
    if record.problem.resolved.task.body.is_some() {
        return "rms, max: errors of the place, at which pose (from 0) the largest. angle, max: rms and largest error \
                of the body's angle, degrees. transm.: the worst transmission angle, from 0 to 90°, over the crank's \
                full turn (cycle) or between the poses (used).";
    }
    if record.problem.resolved.measure() == Measure::LargestPart {
        "at: at which point (from 0). max: the largest error. to curve: rms distance to the whole coupler curve. \
         transmission: the worst angle, from 0 to 90°, over the crank's full turn (cycle) or between the points (used)."
    } else {
        "max: the largest error, at which point (from 0). to curve: rms distance to the whole coupler curve. \
         transmission: the worst angle, from 0 to 90°, over the crank's full turn (cycle) or between the points (used)."
    }
}

/// Returns the best of each kind that was searched for: `Best of each kind: four-bar rms 0.1, largest error 0.3, not accepted; ..`.
pub(super) fn of_kinds(record: &Record) -> Option<String> {
    let unit = words::unit_suffix(record);
    let of = |best: &BestOfKind| {
        let [rms, max] = [best.rms, best.max].map(|error| significant(error, 3));
        let verdict = if best.accepted { "" } else { ", not accepted" };
        format!("{} rms {rms}{unit}, largest error {max}{unit}{verdict}", best.kind)
    };
    let list: Vec<String> = record.of_kinds.iter().map(of).collect();
    // A kind is searched for only where no simpler one meets the tolerance.
    let simplest = record.of_kinds.iter().find(|best| best.accepted).map(|best| best.kind);
    let spec = &record.problem.resolved;
    let is_enough = spec.task.tolerance.is_some() || record.termination.reason == Reason::TargetReached;
    let is_needed = |kind: &LinkageKind| !is_enough || simplest.is_none_or(|simplest| *kind < simplest);
    let is_absent = |kind: &LinkageKind| record.of_kinds.iter().all(|best| best.kind != *kind);
    let absent = |wanted: bool, words: &str| {
        let kinds = spec.design.mechanism.iter().filter(|kind| is_absent(kind) && is_needed(kind) == wanted);
        let kinds: Vec<&str> = kinds.map(|kind| kind.name()).collect();
        if kinds.is_empty() { String::new() } else { format!(" ({words}: {})", kinds.join(", ")) }
    };
    let without = absent(true, "none found") + &absent(false, "not needed");
    (!list.is_empty()).then(|| format!("Best of each kind: {}{without}.", list.join("; ")))
}

/// Returns the distances of the curves from the points as they were given, before smoothing and resampling.
pub(super) fn against_raw(record: &Record) -> Option<String> {
    let raw = record.problem.resolved.task.raw.as_ref()?;
    let unit = words::unit_suffix(record);
    let of = |c: &Candidate| {
        let error = c.error.to_raw?;
        Some(format!(
            "#{} rms {}{unit}, max {}{unit}",
            c.rank,
            significant(error.rms, 4),
            significant(error.max, 4)
        ))
    };
    let list: Vec<String> = record.candidates.iter().take(RAW_NAMED).filter_map(of).collect();
    let points = count(raw.points.len(), "point");
    (!list.is_empty())
        .then(|| format!("From the {points} as given to the whole coupler curve: {}.", list.join("; ")))
}

/// Returns the best linkage: its motion in words, and its parameters as TOML.
fn best(record: &Record) -> String {
    let Some(candidate) = record.candidates.first() else { return String::new() };
    let motion = motion(candidate).map_or(String::new(), |motion| format!(": {motion}"));
    let follower = output::starts_from(candidate, &words::unit_suffix(record))
        .map_or(String::new(), |said| format!("; {said}"));
    let motion = motion + &follower;
    format!("\n  Best linkage (#{}){motion}\n{}", candidate.rank, linkage_toml(&candidate.linkage))
}

/// Returns the motion of the crank: `crank from 31.102° to 371.1°, counter-clockwise`, `crank from 31.1° to 141°,
/// clockwise, and back the same way`, or `crank between 11.459° and 51.566°, to and fro`.
pub(super) fn motion(candidate: &Candidate) -> Option<String> {
    let angles = &candidate.crank_deg;
    let (first, last) = (*angles.first()?, *angles.last()?);
    if !angles.iter().all(|angle| angle.is_finite()) {
        return None;
    }
    let degrees = |angle: f64| format!("{}°", brief(angle, 5));
    let reverses = candidate.goes_to_and_fro() || candidate.defects.iter().any(Defect::is_to_and_fro);
    let way_back = if reverses { ", and back the same way" } else { "" };
    let way = match (angles.is_sorted(), angles.iter().rev().is_sorted()) {
        (true, true) => return Some(format!("crank at {}", degrees(first))),
        (true, false) => "counter-clockwise",
        (false, true) => "clockwise",
        (false, false) => {
            let least = angles.iter().copied().fold(f64::INFINITY, f64::min);
            let greatest = angles.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            return Some(format!("crank between {} and {}, to and fro", degrees(least), degrees(greatest)));
        }
    };
    Some(format!("crank from {} to {}, {way}{way_back}", degrees(first), degrees(last)))
}

/// Returns the linkage as an inline table of TOML, to the last digit.
fn linkage_toml(linkage: &CrankLinkage) -> String {
    // A tilde is a space at which no line is broken.
    let pair = |[x, y]: [f64; 2]| format!("[{},~{}]", exact(x), exact(y));
    let t1 = i64::from(linkage.assembly());
    let (table, parts) = match linkage {
        CrankLinkage::FourBar(linkage) => {
            let p = linkage.natural_coordinates();
            let lengths = [p.crank, p.coupler, p.follower, p.crank_side, p.follower_side].map(exact);
            let ([a, b, c, d, e], t2) = (lengths, i64::from(p.side));
            let (pivot, other) = (pair(p.crank_pivot), pair(p.follower_pivot));
            let lengths = format!("a~=~{a}, b~=~{b}, c~=~{c}, d~=~{d}, e~=~{e}");
            ("linkage", format!("A~=~{pivot}, B~=~{other}, {lengths}, t1~=~{t1}, t2~=~{t2}~}}"))
        }
        CrankLinkage::SliderCrank(linkage) => {
            let p = linkage.parameters();
            let [a, b, deg, x, y] = [p.crank, p.coupler, p.line_deg, p.coupler_x, p.coupler_y].map(exact);
            let (pivot, line) = (pair(p.crank_pivot), pair(p.line_point));
            let line = format!("line_point~=~{line}, line_deg~=~{deg}");
            let p = format!("coupler_x~=~{x}, coupler_y~=~{y}");
            ("slider_crank", format!("A~=~{pivot}, a~=~{a}, b~=~{b}, {line}, {p}, t1~=~{t1}~}}"))
        }
        CrankLinkage::InvertedSliderCrank(linkage) => {
            let p = linkage.parameters();
            let [a, offset, x, y] = [p.crank, p.offset, p.coupler_x, p.coupler_y].map(exact);
            let (pivot, block) = (pair(p.crank_pivot), pair(p.block_pivot));
            let p = format!("coupler_x~=~{x}, coupler_y~=~{y}");
            let parts = format!("A~=~{pivot}, B~=~{block}, a~=~{a}, offset~=~{offset}, {p}, t1~=~{t1}~}}");
            ("inverted_slider_crank", parts)
        }
        CrankLinkage::MultiLoop(linkage) => return multi_loop_in_words(linkage),
    };
    wrapped(&format!("    {table} = {{ "), "      ", &parts, COLUMNS).replace('~', " ")
}

/// Returns a linkage of several loops link by link, to the last digit.
fn multi_loop_in_words(linkage: &MultiLoop) -> String {
    let pair = |[x, y]: [f64; 2]| format!("[{},~{}]", exact(x), exact(y));
    let keys = linkage.keys();
    let pivots = keys.pivots.iter().map(|(name, at)| format!("{name}~=~{}", pair(*at)));
    let mut parts: Vec<String> = pivots.collect();
    parts.push(format!("crank A-C~{}", exact(keys.crank.length)));
    parts.extend(linkage.stages().into_iter().map(|stage| match stage {
        StageKeys::Dyad(DyadKeys { joint, from: [x, y], lengths, side }) => {
            let ([l1, l2], side) = (lengths.map(exact), i64::from(side));
            format!("{x}-{joint}~{l1}, {y}-{joint}~{l2}, side~{side}")
        }
        StageKeys::Point(PointKeys { name, on: [p, q], at }) => format!("{name} on {p}-{q} at~{}", pair(at)),
    }));
    let lead = format!("    {}: ", linkage.chain_kind().name());
    wrapped(&lead, "      ", &parts.join("; "), COLUMNS).replace('~', " ")
}

/// Returns method, seed, cost and the reason why the search ended, on one line.
pub fn ending_sentences(record: &Record) -> String {
    let reason = if record.method.used == ["continuation"] && record.termination.reproducible {
        "every solution path was followed to its end".to_owned()
    } else {
        words::ended(record)
    };
    let used: Vec<String> =
        record.method.used.iter().map(|m| clean(m)).filter(|m| !m.is_empty()).take(12).collect();
    let used = if used.is_empty() { String::new() } else { format!(" by {}", used.join(", ")) };
    let picks = record.picks.as_ref().map_or(0, |picks| picks.evaluations);
    let front = record.front.as_ref().map_or(0, |front| front.evaluations);
    // The budget is that of the search alone.
    let others: Vec<String> = [(picks, "for the picks"), (front, "for the front")]
        .into_iter()
        .filter(|(evaluations, _)| *evaluations > 0)
        .map(|(evaluations, of)| format!("{} {of}", grouped(evaluations)))
        .collect();
    let among =
        if others.is_empty() { String::new() } else { format!(", among them {}", others.join(" and ")) };
    let mut text = format!(
        "Search{used} (seed {}) ended: {}. {} of the objective{among}, {}.",
        record.seed,
        reason,
        count(record.evaluations.objective as usize, "evaluation"),
        count(record.evaluations.positions as usize, "position"),
    );
    if !record.termination.reproducible {
        text.push_str(" A run that is cut short by the clock or by hand cannot be repeated to the digit.");
    }
    text
}

/// One file of a batch.
#[derive(Clone, Copy, Debug)]
pub struct BatchRow<'a> {
    /// The name of the file or problem.
    pub name: &'a str,
    /// The record; or the reason why the file could not be run.
    pub outcome: Result<&'a Record, &'a str>,
}

impl BatchRow<'_> {
    /// Returns the number of accepted candidates; 0 for a refused file.
    pub(super) fn accepted(&self) -> usize {
        self.outcome.map_or(0, |record| record.candidates.iter().filter(|c| c.accepted).count())
    }

    /// Returns the errors of the best candidate.
    pub(super) fn best(&self) -> Option<&ErrorRecord> {
        self.outcome.ok()?.candidates.first().map(|c| &c.error)
    }
}

/// Returns a row for each file of a batch and a line with the counts.
pub fn batch_summary(files: &[BatchRow<'_>], colour: Colour) -> String {
    let ran = |file: &BatchRow<'_>, of: &dyn Fn(&Record) -> String| -> Cell {
        plain(file.outcome.map_or_else(|_| String::new(), of))
    };
    let figure = |file: &BatchRow<'_>, of: fn(&ErrorRecord) -> f64, digits| {
        plain(file.best().map_or(String::new(), |error| significant(of(error), digits)))
    };
    let mut nouns = files.iter().filter_map(|file| Some(file.outcome.ok()?.problem.resolved.task.noun()));
    let noun = match nouns.next() {
        Some(first) if nouns.any(|noun| noun != first) => "targets",
        Some("pose") => "poses",
        Some("pair") => "pairs",
        _ => "points",
    };
    let grid = Grid::of(
        files,
        &[
            (Left, "problem", &|file| plain(shortened(&clean(file.name), 30))),
            (Right, noun, &|file| ran(file, &|r| grouped(r.problem.resolved.task.len() as u64))),
            (Right, "best sum of sq", &|file| figure(file, |e| e.sum_sq, 6)),
            (Right, "rms", &|file| figure(file, |e| e.rms, 4)),
            (Right, "max", &|file| figure(file, |e| e.max, 4)),
            (Right, "accepted", &|file| {
                let (of, _) = ran(file, &|r| format!("{} of {}", file.accepted(), r.candidates.len()));
                verdict(of, file.accepted() > 0)
            }),
            (Left, "status", &|file| {
                let ended = |r: &Record| plain(words::reason_name(r.termination.reason));
                file.outcome.map_or_else(|_| verdict("refused", false), ended)
            }),
        ],
    );
    let good = files.iter().filter(|file| file.accepted() > 0).count();
    let refused: Vec<String> = files
        .iter()
        .filter_map(|file| Some(format!("{}: {}", clean(file.name), clean(file.outcome.err()?))))
        .collect();
    let without = files.len() - good - refused.len();
    let mut out = if files.is_empty() { String::new() } else { grid.render(colour) + "\n" };
    let mut parts = vec![format!("{good} with an accepted linkage")];
    if without > 0 {
        parts.push(format!("{without} without"));
    }
    if !refused.is_empty() {
        parts.push(format!("{} refused", refused.len()));
        out.extend(refused.iter().map(|said| wrapped("  ", "    ", said, COLUMNS)));
        out.push('\n');
    }
    out.push_str(&format!("  {}: {}.\n", count(files.len(), "file"), parts.join(", ")));
    out
}
