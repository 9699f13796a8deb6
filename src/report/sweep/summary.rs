//! The summary of a sweep, gathered row by row in bounded memory: the best figures of each cell of a grid over one or two
//! varied keys, the best rows of all, and the reasons why jobs were refused.

use super::table::value;
use crate::record::sweep::{Plan, Row, Status, Values};
use crate::report::text::brief;
use serde_json::Value;
use std::collections::BTreeMap;

/// The most cells of an axis; a key with more values has several of them in a cell.
const MOST_CELLS: u64 = 150;
/// The number of best rows that are kept.
const BEST_ROWS: usize = 20;
/// The most different reasons that are kept.
const MOST_REASONS: usize = 50;

/// An axis of the grid: a varied key.
#[derive(Clone, Debug, PartialEq)]
pub struct GridAxis {
    /// The place of the key in the plan.
    pub index: usize,
    /// The key.
    pub key: String,
    /// The values, the first of each cell.
    pub values: Vec<Value>,
    /// The number of values of a cell: 1, but for a key with very many.
    pub a_cell: u64,
}

impl GridAxis {
    fn of(plan: &Plan, index: usize) -> GridAxis {
        let varied = &plan.vary[index];
        let count = varied.values.count();
        let a_cell = count.div_ceil(MOST_CELLS).max(1);
        let firsts = (0..count.div_ceil(a_cell)).map(|cell| varied.values.at(cell * a_cell));
        GridAxis { index, key: varied.key.clone(), values: firsts.collect(), a_cell }
    }

    /// Returns the numbers of the cells, if all are numbers, each larger or each smaller than the one before.
    pub fn numbers(&self) -> Option<Vec<f64>> {
        let numbers: Vec<f64> = self.values.iter().map(Value::as_f64).collect::<Option<_>>()?;
        let rising = numbers.is_sorted_by(|one, next| one < next);
        let falling = numbers.is_sorted_by(|one, next| one > next);
        (rising || falling).then_some(numbers)
    }

    /// Returns the value of a cell as text, a number with five digits at most.
    pub fn label(&self, cell: usize) -> String {
        self.values.get(cell).map_or(String::new(), |given| match (given.as_i64(), given.as_f64()) {
            (None, Some(number)) => brief(number, 5),
            _ => value(given),
        })
    }
}

/// A cell of the grid: the jobs with these values.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct GridCell {
    /// The number of jobs.
    pub jobs: u64,
    /// How many of them have an accepted candidate.
    pub accepted: u64,
    /// The least rms error of their accepted candidates.
    pub rms: Option<f64>,
    /// The least rms error of the first candidates that are not accepted.
    pub rms_unaccepted: Option<f64>,
}

/// The summary of a sweep.
#[derive(Clone, Debug)]
pub struct Summary {
    /// The axes of the grid: one, or two of which the second lies across.
    pub axes: Vec<GridAxis>,
    /// The cells, those of the last axis one after the other.
    pub cells: Vec<GridCell>,
    /// The number of rows.
    pub rows: u64,
    /// The number of rows of each outcome.
    pub outcomes: [(Status, u64); 4],
    /// The best rows: accepted ones first, then by rms.
    pub best: Vec<Row<()>>,
    /// The reasons why jobs were refused, each with the number of jobs.
    pub reasons: BTreeMap<String, u64>,
}

/// Returns the place of the keys that are plotted: the first two with several values, those of `[solve]` only where there
/// is no other.
fn plotted(plan: &Plan) -> Vec<usize> {
    let several = |i: &usize| plan.vary[*i].values.count() > 1;
    let of_search = |i: &usize| plan.vary[*i].key.starts_with("solve.");
    let (search, others): (Vec<usize>, Vec<usize>) =
        (0..plan.vary.len()).filter(several).partition(of_search);
    let chosen = if others.is_empty() { search } else { others };
    chosen.into_iter().take(2).collect()
}

impl Summary {
    /// Returns the empty summary of a plan.
    pub fn of(plan: &Plan) -> Summary {
        let axes: Vec<GridAxis> = plotted(plan).into_iter().map(|i| GridAxis::of(plan, i)).collect();
        let cells = axes.iter().map(|axis| axis.values.len()).product();
        let outcomes =
            [Status::Accepted, Status::NothingAcceptable, Status::Refused, Status::Bug].map(|s| (s, 0));
        let (rows, best, reasons) = (0, Vec::new(), BTreeMap::new());
        Summary { axes, cells: vec![GridCell::default(); cells], rows, outcomes, best, reasons }
    }

    /// Takes a row.
    pub fn take<R>(&mut self, plan: &Plan, row: &Row<R>) {
        self.rows += 1;
        if let Some((_, count)) = self.outcomes.iter_mut().find(|(status, _)| *status == row.status) {
            *count += 1;
        }
        let indices = plan.indices(row.job);
        let place = self.axes.iter().fold(0, |place, axis| {
            let cell = indices[axis.index] / axis.a_cell;
            place * axis.values.len() + cell as usize
        });
        if let Some(cell) = self.cells.get_mut(place) {
            cell.jobs += 1;
            cell.accepted += u64::from(row.status == Status::Accepted);
            if let Some(best) = &row.best {
                let least = if best.accepted { &mut cell.rms } else { &mut cell.rms_unaccepted };
                *least = Some(least.map_or(best.error.rms, |least| least.min(best.error.rms)));
            }
        }
        if let Some(message) = &row.message
            && (self.reasons.len() < MOST_REASONS || self.reasons.contains_key(message))
        {
            *self.reasons.entry(message.clone()).or_default() += 1;
        }
        self.keep(row);
    }

    /// Keeps a row if it is among the best.
    fn keep<R>(&mut self, row: &Row<R>) {
        let key = |best: &crate::record::sweep::Best| (!best.accepted, best.error.rms);
        let Some(figures) = row.best.as_ref().map(key) else { return };
        let is_better = |kept: &Row<()>| match kept.best.as_ref().map(key) {
            Some(other) => (other.0, other.1).partial_cmp(&figures).is_none_or(std::cmp::Ordering::is_le),
            None => false,
        };
        let place = self.best.partition_point(is_better);
        if place < BEST_ROWS {
            self.best.insert(place, without_record(row));
            self.best.truncate(BEST_ROWS);
        }
    }

    /// Returns the number of rows of an outcome.
    pub fn count(&self, status: Status) -> u64 {
        self.outcomes.iter().find(|(of, _)| *of == status).map_or(0, |(_, count)| *count)
    }

    /// Returns the keys with several values that the grid does not show.
    pub fn others<'p>(&self, plan: &'p Plan) -> Vec<&'p str> {
        let shown = |i: &usize| self.axes.iter().any(|axis| axis.index == *i);
        let hidden = (0..plan.vary.len()).filter(|i| plan.vary[*i].values.count() > 1 && !shown(i));
        hidden.map(|i| plan.vary[i].key.as_str()).collect()
    }
}

/// Returns a row without its record.
fn without_record<R>(row: &Row<R>) -> Row<()> {
    Row {
        job: row.job,
        values: row.values.clone(),
        status: row.status,
        message: row.message.clone(),
        termination: row.termination,
        candidates: row.candidates,
        accepted: row.accepted,
        evaluations: row.evaluations,
        best: row.best.clone(),
        record: None,
    }
}

/// Returns the values of a key in words: `7 from 20 to 50`, or the list.
pub(super) fn values_in_words(values: &Values) -> String {
    /// The most values of a list that are all named.
    const FEW: usize = 6;
    match values {
        Values::Range(range) => {
            let [first, last] = [0, range.steps - 1].map(|i| value(&values.at(i)));
            format!("{} from {first} to {last}", range.steps)
        }
        Values::List(list) if list.len() <= FEW => list.iter().map(value).collect::<Vec<_>>().join(", "),
        Values::List(list) => {
            let ends = [list.first(), list.last()].map(|end| end.map_or(String::new(), value));
            format!("{}, .., {} ({} values)", ends[0], ends[1], list.len())
        }
    }
}
