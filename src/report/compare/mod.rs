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
use crate::mechanism::Unit;
use crate::record::{Candidate, Record};
use crate::task::spec::Measure;
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
    /// The target to which the errors are measured.
    pub target: Vec<[f64; 2]>,
    /// Whether the target is a closed curve.
    pub closed: bool,
    /// The unit of the lengths.
    pub unit: Option<Unit>,
    /// The measure by which the candidates of that problem are ranked.
    pub measure: Measure,
    /// Whether it is a candidate of a run; otherwise it is a linkage file.
    pub of_run: bool,
    /// The false statements of its record; the figures here are the recomputed ones.
    pub untrue: Vec<String>,
}

impl Entry {
    /// Returns `record.candidates[index]`, if it exists, with the figures of the record.
    pub fn from_record(label: &str, record: &Record, index: usize) -> Option<Entry> {
        record.candidates.get(index).map(|candidate| Entry::of(label, record, candidate.clone()))
    }

    /// Returns a candidate measured on the problem of a record.
    pub fn of(label: &str, record: &Record, candidate: Candidate) -> Entry {
        let path = &record.problem.resolved.task.path;
        Entry {
            label: label.to_owned(),
            candidate,
            target_name: record.problem.name.clone(),
            target: path.points.clone(),
            closed: path.closed,
            unit: record.problem.unit,
            measure: record.problem.resolved.measure(),
            of_run: true,
            untrue: Vec::new(),
        }
    }

    /// Returns the size: the diagonal of the box that A, B and the moving joints sweep over the circuits used (half a
    /// degree apart); NaN if the links cannot be joined.
    pub fn size(&self) -> f64 {
        let mut bounds = Bounds::default();
        for joints in circuits(&self.candidate, SAMPLES).iter().flatten() {
            for p in [joints.crank_pin, joints.follower_pin, joints.coupler_point] {
                bounds.hold(p);
            }
        }
        if bounds.width() == 0.0 && bounds.height() == 0.0 {
            return f64::NAN;
        }
        bounds.hold(self.candidate.linkage.crank_pivot());
        bounds.hold(self.candidate.linkage.follower_pivot());
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
            SortKey::Objective => error.objective,
        }
    }
}

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
    /// The figure of the first key; `None` if it is not finite.
    pub figure: Option<f64>,
    /// The difference between the figure and the best one, in per cent of the best; `None` if the best is 0 and this is
    /// not.
    pub behind_percent: Option<f64>,
    /// The difference between each figure and the reference's, in per cent of the reference's, in the order of
    /// [`SortKey::ALL`]: see [`percent_above`]. Empty without a reference.
    pub difference_percent: Vec<Option<f64>>,
    /// Whether it is on the Pareto front: see [`front()`]. Of rows with equal figures only the first is marked.
    pub on_front: bool,
    /// The size: see [`Entry::size`].
    pub size: f64,
    figures: [Option<f64>; SortKey::ALL.len()],
    levels: [Option<f64>; SortKey::ALL.len()],
}

impl Ranked {
    /// Returns the best figure among the rows whose figures are equal to this one's within the margin of limits.
    fn level_of(&self, key: SortKey) -> Option<f64> {
        self.levels[key as usize]
    }

    /// Returns a figure; `None` if it is not finite.
    pub fn figure_of(&self, key: SortKey) -> Option<f64> {
        self.figures[key as usize]
    }
}

/// An input without figures.
#[derive(Clone, Debug, PartialEq, Eq)]
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

/// Compares two figures: the better one first, a missing one last.
fn order(x: Option<f64>, y: Option<f64>, key: SortKey) -> Ordering {
    match (x, y) {
        (Some(x), Some(y)) => {
            if key.greatest_first() {
                y.total_cmp(&x)
            } else {
                x.total_cmp(&y)
            }
        }
        (Some(_), None) => Ordering::Less,
        (None, Some(_)) => Ordering::Greater,
        (None, None) => Ordering::Equal,
    }
}

/// Returns the rank of each: one more than the number of better ones.
fn ranked<T>(sorted: &[T], equal: impl Fn(&T, &T) -> bool) -> Vec<usize> {
    let mut ranks = Vec::with_capacity(sorted.len());
    for i in 0..sorted.len() {
        let shared = i > 0 && equal(&sorted[i - 1], &sorted[i]);
        ranks.push(if shared { ranks[i - 1] } else { i + 1 });
    }
    ranks
}

/// Returns the default key: the objective that all the entries' problems minimise, if it is the same for all and not
/// the plain sum; otherwise the sum of squared errors.
fn usual_key(entries: &[Entry]) -> SortKey {
    let one = entries.windows(2).all(|w| {
        w[0].measure == w[1].measure && w[0].unit == w[1].unit && same_points(&w[0].target, &w[1].target)
    });
    match entries.first() {
        Some(first) if one && first.measure != Measure::Sum => SortKey::Objective,
        _ => SortKey::default(),
    }
}

/// Ranks the entries by the first key, and equal ones by the next keys (without keys, by the objective of their
/// problems); `reference` is the index of the entry from which differences are taken. Figures are ordered by their
/// levels (`level`): figures within the margin of limits count as equal.
pub fn compare(entries: &[Entry], keys: &[SortKey], reference: Option<usize>) -> Comparison {
    let keys = if keys.is_empty() { vec![usual_key(entries)] } else { keys.to_vec() };
    let mut rows: Vec<(usize, Ranked)> = entries
        .iter()
        .map(|entry| {
            let figures = SortKey::ALL.map(|key| Some(entry.figure(key)).filter(|f| f.is_finite()));
            Ranked {
                rank: 0,
                ranks: vec![0; keys.len()],
                entry: entry.clone(),
                figure: figures[keys[0] as usize],
                behind_percent: None,
                difference_percent: Vec::new(),
                on_front: false,
                size: figures[SortKey::Size as usize].unwrap_or(f64::NAN),
                figures,
                levels: figures,
            }
        })
        .enumerate()
        .collect();
    for key in SortKey::ALL {
        let figures: Vec<Option<f64>> = rows.iter().map(|row| row.1.figure_of(key)).collect();
        let nothing = entries.iter().map(|entry| level::nothing(entry, key)).fold(f64::INFINITY, f64::min);
        let levels = level::levels(&figures, key.greatest_first(), nothing);
        rows.iter_mut().zip(levels).for_each(|(row, level)| row.1.levels[key as usize] = level);
    }
    for (k, key) in keys.iter().enumerate() {
        let by = |x: &Ranked, y: &Ranked| order(x.level_of(*key), y.level_of(*key), *key);
        rows.sort_by(|x, y| by(&x.1, &y.1));
        let ranks = ranked(&rows, |x, y| by(&x.1, &y.1).is_eq());
        rows.iter_mut().zip(ranks).for_each(|(row, rank)| row.1.ranks[k] = rank);
    }
    let by_all = |x: &Ranked, y: &Ranked| {
        let by = |key: &SortKey| order(x.level_of(*key), y.level_of(*key), *key);
        keys.iter().map(by).find(|order| order.is_ne()).unwrap_or(Ordering::Equal)
    };
    rows.sort_by(|x, y| by_all(&x.1, &y.1).then(x.0.cmp(&y.0)));
    let ranks = ranked(&rows, |x, y| by_all(&x.1, &y.1).is_eq());
    let reference = reference.and_then(|index| rows.iter().position(|row| row.0 == index));
    let mut rows: Vec<Ranked> = rows.into_iter().map(|row| row.1).collect();
    let best = rows.first().and_then(|row| row.level_of(keys[0]));
    let from = reference.map(|row| rows[row].figures);
    for (row, rank) in rows.iter_mut().zip(ranks) {
        row.rank = rank;
        let level = row.level_of(keys[0]);
        row.behind_percent =
            level.zip(best).and_then(|(level, best)| percent_above(level, best)).map(f64::abs);
        if let Some(from) = from {
            let above = |(x, from): (&Option<f64>, &Option<f64>)| percent_above((*x)?, (*from)?);
            row.difference_percent = row.figures.iter().zip(&from).map(above).collect();
        }
    }
    let mut comparison = Comparison { keys, rows, reference, left_out: Vec::new(), remarks: Vec::new() };
    if comparison.same_target() && comparison.same_unit() {
        let points = comparison.rows.iter().map(|row| front::Point {
            accepted: row.entry.candidate.accepted,
            error: row.level_of(SortKey::Rms),
            angle: row.level_of(SortKey::Transmission),
            size: row.level_of(SortKey::Size),
        });
        let points: Vec<Point> = points.collect();
        let marks = front(&points);
        for (i, row) in comparison.rows.iter_mut().enumerate() {
            row.on_front = marks[i] && !points[..i].contains(&points[i]);
        }
    }
    comparison
}

impl Comparison {
    /// Returns whether all errors are measured to the same target.
    pub fn same_target(&self) -> bool {
        self.rows.windows(2).all(|w| same_points(&w[0].entry.target, &w[1].entry.target))
    }

    /// Returns whether all lengths have the same unit.
    pub fn same_unit(&self) -> bool {
        self.rows.windows(2).all(|w| w[0].entry.unit == w[1].entry.unit)
    }

    /// Returns the objective, if all rows minimised the same one and it is not the plain sum: the word for its column,
    /// and a sentence on it.
    pub(super) fn minimised(&self) -> Option<(&'static str, &'static str)> {
        let measure = self.rows.first()?.entry.measure;
        let one = self.rows.iter().all(|row| row.entry.measure == measure);
        super::words::minimised(measure).filter(|_| one && self.same_target())
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
        if !self.same_target() {
            notes.push(
                "The targets differ: errors to different targets say little beside each other, and no front is marked."
                    .to_owned(),
            );
        }
        if !self.same_unit() {
            notes.push(
                "The units differ: lengths are as they stand in each result, and no front is marked."
                    .to_owned(),
            );
        }
        notes.extend(self.minimised().map(|(_, sentence)| sentence.to_owned()));
        notes.extend(self.remarks.iter().cloned());
        notes.extend(
            self.left_out.iter().map(|out| format!("Left out: {}: {}.", clean(&out.label), clean(&out.why))),
        );
        notes
    }

    /// Returns the meaning of the marks of the front; `None` if no row is marked.
    pub fn front_words(&self) -> Option<String> {
        let n = self.rows.iter().filter(|row| row.on_front).count();
        (n > 0).then(|| {
            "on the Pareto front: no other is at least as good in rms error, worst transmission angle and size and \
             better in one (what is not accepted never beats what is; of those that are equal the first is marked)"
                .to_owned()
        })
    }

    /// Returns the label of the row from which differences are taken.
    pub fn reference_label(&self) -> Option<&str> {
        Some(&self.rows.get(self.reference?)?.entry.label)
    }
}
