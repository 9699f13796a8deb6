//! Comparison of linkages from several results: ranked by chosen figures, with the Pareto front of error, worst
//! transmission angle and size marked, and differences from a chosen one in per cent.
//!
//! | for | call |
//! |---|---|
//! | a terminal | [`Comparison::table`] |
//! | a spreadsheet, a script | [`Comparison::csv`], [`Comparison::json`] |
//! | a page | [`Comparison::svg`], [`Comparison::html`] |

use super::scene::{Bounds, SAMPLES, circuits};
use super::text::clean;
use crate::mechanism::{CrankLinkage, Unit};
use crate::record::Candidate;
use crate::task::TaskKind;
use crate::task::spec::{BodySpec, Measure};
use serde::Serialize;
use std::cmp::Ordering;

mod data;
mod front;
mod key;
mod level;
mod overlay;
mod page;
mod strokes;
mod tables;
mod trade_off;
mod unit;

pub use data::JSON_FORMAT;
pub use front::{Point, front};
pub use key::{SortKey, UnknownKey};
pub use unit::{in_one_unit, unit_remarks};

/// An entry of a comparison: a linkage with its figures on a target, from a record or evaluated on one.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The name of the entry.
    pub label: String,
    /// The linkage, its figures and verdicts.
    pub candidate: Candidate,
    /// The name of the problem to whose target the errors are measured.
    pub target_name: String,
    /// The target to which the errors are measured: places, none of a function.
    pub target: Vec<[f64; 2]>,
    /// The input and the output of each pair of a function, degrees; empty for other tasks.
    pub pairs: Vec<[f64; 2]>,
    /// The kind of the task whose target it is.
    pub kind: TaskKind,
    /// The angles of the body at the target in a motion, of the follower in a function.
    pub body: Option<BodySpec>,
    /// The unit of the lengths.
    pub unit: Option<Unit>,
    /// The measure by which the candidates of that problem are ranked.
    pub measure: Measure,
    /// The extent: the diagonal of the box of all joints and P over the motion that the points use; `None` if it is not
    /// known.
    pub extent: Option<f64>,
    /// Whether it is a candidate of a run; otherwise it is a linkage file.
    pub of_run: bool,
    /// The false statements of its record; the figures here are the recomputed ones.
    pub untrue: Vec<String>,
}

impl Entry {
    /// Returns whether the targets of both are the same, up to the rounding of a change of units: points, and the angles
    /// of a body and their weight.
    fn has_target_of(&self, other: &Entry) -> bool {
        same_points(&self.target, &other.target)
            && self.pairs == other.pairs
            && same_body(self.body.as_ref(), other.body.as_ref())
    }

    /// Returns the unit of its errors: that of lengths, of a function degrees.
    fn error_unit(&self) -> String {
        if self.pairs.is_empty() { super::words::length_suffix(self.unit) } else { "°".to_owned() }
    }

    /// Returns the size: the diagonal of the box that A, B and the moving joints sweep over the circuits used (half a
    /// degree apart); NaN if the links cannot be joined.
    pub fn size(&self) -> f64 {
        let circuits = circuits(&self.candidate, SAMPLES);
        let moving = circuits.iter().flatten();
        let mut bounds = Bounds::of(
            moving.flat_map(|joints| [joints.crank_pin, joints.follower_pin, joints.coupler_point]),
        );
        if bounds.width() == 0.0 && bounds.height() == 0.0 {
            return f64::NAN;
        }
        self.candidate.linkage.pivots().for_each(|pivot| bounds.hold(pivot));
        bounds.diagonal()
    }

    fn figure(&self, key: SortKey) -> f64 {
        let error = &self.candidate.error;
        match key {
            SortKey::SumSq => error.sum_sq,
            SortKey::Rms => error.rms,
            SortKey::Max => error.max,
            SortKey::ToCurve => error.to_curve.rms,
            SortKey::Transmission => self.candidate.transmission_deg.worst,
            SortKey::LinkRatio => self.candidate.link_ratio,
            SortKey::Size => self.size(),
            SortKey::Extent => self.extent.unwrap_or(f64::NAN),
            SortKey::Objective => error.objective,
            SortKey::AngleRms => error.angle.map_or(f64::NAN, |angle| angle.rms_deg),
            SortKey::AngleMax => error.angle.map_or(f64::NAN, |angle| angle.max_deg),
        }
    }
}

/// The figures of an entry in the order of [`SortKey::ALL`]; `None` if one is not finite.
type Figures = [Option<f64>; SortKey::ALL.len()];

/// A ranked entry.
#[derive(Clone, Debug, PartialEq)]
pub struct Ranked {
    /// The rank, 1 for the best; figures that are equal within the margin of limits share a rank. With several keys, a
    /// later one decides between equals.
    pub rank: usize,
    /// The ranks by each key alone, in the order of the keys.
    pub ranks: Vec<usize>,
    /// The entry.
    pub entry: Entry,
    /// The difference between the figure of the first key and the best one, in per cent of the best; `None` if the best
    /// is 0 and this is not.
    pub behind_percent: Option<f64>,
    /// The difference between each figure and the reference's, in per cent of the reference's, in the order of
    /// [`SortKey::ALL`]: see [`percent_above`]. Empty without a reference.
    pub difference_percent: Vec<Option<f64>>,
    /// Whether it is on the Pareto front: see [`front()`]. Of rows with equal figures only the first is marked.
    pub on_front: bool,
    figures: Figures,
}

impl Ranked {
    /// Returns a figure; `None` if it is not finite.
    pub fn figure_of(&self, key: SortKey) -> Option<f64> {
        self.figures[key as usize]
    }
}

/// An input without figures.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, schemars::JsonSchema)]
pub struct LeftOut {
    /// The name of the input.
    pub label: String,
    /// The reason why it has no figures.
    pub why: String,
}

/// A comparison: entries in the order of the chosen figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// The figures by which the entries are ranked; never empty.
    pub keys: Vec<SortKey>,
    /// The rows, best first; those without the figure last, equal ones in the given order.
    pub rows: Vec<Ranked>,
    /// The index of the row from which differences are taken.
    pub reference: Option<usize>,
    /// The inputs without figures.
    pub left_out: Vec<LeftOut>,
    /// Remarks on the conversions that made the entries comparable, in sentences.
    pub remarks: Vec<String>,
}

/// Returns 100 (value - reference)/|reference|; 0 if the two are equal within the margin of limits, also if both are 0;
/// `None` if only the reference is 0.
pub fn percent_above(value: f64, reference: f64) -> Option<f64> {
    if level::equal(value, reference, 0.0) {
        return Some(0.0);
    }
    Some(100.0 * (value - reference) / reference.abs()).filter(|p| p.is_finite())
}

/// Returns whether two targets are the same, up to the rounding of a change of units.
pub fn same_points(one: &[[f64; 2]], other: &[[f64; 2]]) -> bool {
    const ROUNDING: f64 = 8.0 * f64::EPSILON;
    let near = |x: f64, y: f64| x == y || (x - y).abs() <= ROUNDING * x.abs().max(y.abs());
    one.len() == other.len() && one.iter().flatten().zip(other.iter().flatten()).all(|(x, y)| near(*x, *y))
}

/// Returns whether two bodies are wanted at the same angles, which count alike.
pub fn same_body(one: Option<&BodySpec>, other: Option<&BodySpec>) -> bool {
    match (one, other) {
        (None, None) => true,
        (Some(one), Some(other)) => {
            one.angle_deg == other.angle_deg
                && same_points(&[[one.angle_weight, 0.0]], &[[other.angle_weight, 0.0]])
        }
        _ => false,
    }
}

/// Returns the first of several names: `a, b, c and 2 more`.
fn first_few<T: AsRef<str>>(names: &[T]) -> String {
    const NAMED: usize = 3;
    let few: Vec<&str> = names.iter().take(NAMED).map(AsRef::as_ref).collect();
    let more = names.len() - few.len();
    few.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}

/// Compares two figures: the better one first, a missing one last.
fn order(x: Option<f64>, y: Option<f64>, key: SortKey) -> Ordering {
    x.zip(y).map_or_else(|| x.is_none().cmp(&y.is_none()), |(x, y)| key.order(x, y))
}

/// Returns the default key: the objective that all the entries' problems minimise, if it is the same for all and not
/// the plain sum; otherwise the sum of squared errors.
fn usual_key(entries: &[Entry]) -> SortKey {
    let one = entries
        .windows(2)
        .all(|w| w[0].measure == w[1].measure && w[0].unit == w[1].unit && w[0].has_target_of(&w[1]));
    match entries.first() {
        Some(first) if one && (first.measure != Measure::Sum || first.kind == TaskKind::Motion) => {
            SortKey::Objective
        }
        _ => SortKey::default(),
    }
}

/// Ranks the entries by the first key, and equal ones by the next keys (without keys, by the objective of their
/// problems); `reference` is the index of the entry from which differences are taken. Figures are ordered by their
/// levels (`level`): figures within the margin of limits count as equal.
pub fn compare(entries: &[Entry], keys: &[SortKey], reference: Option<usize>) -> Comparison {
    let keys = if keys.is_empty() { vec![usual_key(entries)] } else { keys.to_vec() };
    let figures_of =
        |entry| SortKey::ALL.map(|key| Some(Entry::figure(entry, key)).filter(|f| f.is_finite()));
    let figures: Vec<Figures> = entries.iter().map(figures_of).collect();
    let mut levels = figures.clone();
    for key in SortKey::ALL {
        let of_key: Vec<_> = figures.iter().map(|figures| figures[key as usize]).collect();
        let nothing = entries.iter().map(|entry| level::nothing(entry, key)).fold(f64::INFINITY, f64::min);
        for (levels, level) in levels.iter_mut().zip(level::levels(&of_key, key, nothing)) {
            levels[key as usize] = level;
        }
    }
    let mut ranks = vec![Vec::new(); entries.len()];
    for key in &keys {
        let mut sorted: Vec<_> = levels.iter().map(|levels| levels[*key as usize]).collect();
        sorted.sort_by(|x, y| order(*x, *y, *key));
        for (ranks, levels) in ranks.iter_mut().zip(&levels) {
            let is_better = |other: &Option<f64>| order(*other, levels[*key as usize], *key).is_lt();
            ranks.push(1 + sorted.partition_point(is_better));
        }
    }
    let mut sorted: Vec<usize> = (0..entries.len()).collect();
    sorted.sort_by_key(|i| &ranks[*i]);
    let best = sorted.first().and_then(|first| levels[*first][keys[0] as usize]);
    let from = reference.and_then(|reference| figures.get(reference));
    let row = |&i: &usize| {
        let behind =
            levels[i][keys[0] as usize].zip(best).and_then(|(level, best)| percent_above(level, best));
        let above = |(x, from): (&Option<f64>, &Option<f64>)| percent_above((*x)?, (*from)?);
        Ranked {
            rank: 1 + sorted.partition_point(|other| ranks[*other] < ranks[i]),
            ranks: ranks[i].clone(),
            entry: entries[i].clone(),
            behind_percent: behind.map(f64::abs),
            difference_percent: from
                .iter()
                .flat_map(|from| figures[i].iter().zip(*from))
                .map(above)
                .collect(),
            on_front: false,
            figures: figures[i],
        }
    };
    let mut comparison = Comparison {
        rows: sorted.iter().map(row).collect(),
        reference: reference.and_then(|reference| sorted.iter().position(|i| *i == reference)),
        keys,
        left_out: Vec::new(),
        remarks: Vec::new(),
    };
    if comparison.same_target() && comparison.same_unit() {
        let point = |&i: &usize| {
            let [error, angle, size] =
                [SortKey::Rms, SortKey::Transmission, SortKey::Size].map(|key| levels[i][key as usize]);
            Point { accepted: entries[i].candidate.accepted, error, angle, size }
        };
        let points: Vec<Point> = sorted.iter().map(point).collect();
        for (i, is_on_front) in front(&points).into_iter().enumerate() {
            comparison.rows[i].on_front = is_on_front && !points[..i].contains(&points[i]);
        }
    }
    comparison
}

impl Comparison {
    /// Iterates over the linkages, best first.
    fn linkages(&self) -> impl Iterator<Item = &CrankLinkage> {
        self.rows.iter().map(|row| &row.entry.candidate.linkage)
    }

    /// Returns whether all errors are measured to the same target.
    pub fn same_target(&self) -> bool {
        self.rows.windows(2).all(|w| w[0].entry.has_target_of(&w[1].entry))
    }

    /// Returns the unit of all lengths, if they have the same one.
    fn unit(&self) -> Option<Unit> {
        self.rows.first().and_then(|row| row.entry.unit).filter(|_| self.same_unit())
    }

    /// Returns whether all lengths have the same unit.
    pub fn same_unit(&self) -> bool {
        self.rows.windows(2).all(|w| w[0].entry.unit == w[1].entry.unit)
    }

    /// Returns the objective, if all rows minimised the same one and it is not the plain sum: the word for its column,
    /// and a sentence on it.
    pub(super) fn minimised(&self) -> Option<(&'static str, String)> {
        let Entry { measure, body, unit, kind, .. } = &self.rows.first()?.entry;
        let one = self.rows.iter().all(|row| row.entry.measure == *measure) && self.same_target();
        let unit = super::words::length_suffix(*unit);
        one.then(|| super::words::minimised(*measure, (*kind, body.as_ref()), &unit)).flatten()
    }

    /// Returns whether a row is of a motion, so that there are errors of the body's angle.
    pub(super) fn has_angles(&self) -> bool {
        self.rows.iter().any(|row| row.entry.kind == TaskKind::Motion)
    }

    /// Returns whether every record is true.
    pub fn is_true(&self) -> bool {
        self.rows.iter().all(|row| row.entry.untrue.is_empty())
    }

    /// Returns the remarks that a reader needs beside the figures, in sentences.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        for row in self.rows.iter().filter(|row| !row.entry.untrue.is_empty()) {
            let (label, n) = (clean(&row.entry.label), row.entry.untrue.len());
            let more = if n > 1 { format!(" (and {} more)", n - 1) } else { String::new() };
            notes.push(format!(
                "The record of {label} is not true: {}{more}. The figures here are those found.",
                clean(&row.entry.untrue[0])
            ));
        }
        let targets = "The targets differ: errors to different targets say little beside each other, and no front is marked.";
        let kinds = "Paths and motions stand side by side: a path has no errors of an angle, and objectives of the two are \
                     not alike.";
        let units = "The units differ: lengths are as they stand in each result, and no front is marked.";
        let sentences = [
            (!self.same_target()).then_some(targets),
            (self.has_angles() && self.rows.iter().any(|row| row.entry.body.is_none())).then_some(kinds),
            (!self.same_unit()).then_some(units),
        ];
        notes.extend(sentences.into_iter().flatten().map(str::to_owned));
        notes.extend(self.minimised().map(|(_, sentence)| sentence));
        notes.extend(self.remarks.iter().cloned());
        notes.extend(
            self.left_out.iter().map(|out| format!("Left out: {}: {}.", clean(&out.label), clean(&out.why))),
        );
        notes
    }

    /// Returns the meaning of the marks of the front; `None` if no row is marked.
    pub fn front_words(&self) -> Option<&'static str> {
        let words = "on the Pareto front: no other is at least as good in rms error, worst transmission angle and size and \
                     better in one (what is not accepted never beats what is; of those that are equal the first is marked)";
        self.rows.iter().any(|row| row.on_front).then_some(words)
    }

    /// Returns the label of the row from which differences are taken.
    pub fn reference_label(&self) -> Option<&str> {
        Some(&self.rows.get(self.reference?)?.entry.label)
    }
}
