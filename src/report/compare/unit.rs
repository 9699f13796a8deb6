//! Conversion of the lengths of several results to one unit.

use super::{Entry, first_few};
use crate::mechanism::{LinkageError, Unit};
use crate::report::text::clean;
use crate::task::spec::Measure;

impl Entry {
    /// Returns the entry with its lengths and errors in another unit; unchanged if it has no unit.
    fn converted(&self, to: Unit) -> Result<Entry, LinkageError> {
        let mut entry = self.clone();
        let Some(from) = self.unit.filter(|from| *from != to) else { return Ok(entry) };
        let factor = from.factor_to(to);
        entry.unit = Some(to);
        entry.target.iter_mut().flatten().for_each(|x| *x *= factor);
        if entry.pairs.is_empty() {
            entry.body.iter_mut().for_each(|body| body.angle_weight *= factor);
        }
        entry.extent = entry.extent.map(|extent| extent * factor);
        let candidate = &mut entry.candidate;
        candidate.linkage = candidate.linkage.scaled(factor)?;
        candidate.grashof_margin *= factor;
        if !entry.pairs.is_empty() {
            // Errors of a function are degrees.
            return Ok(entry);
        }
        let error = &mut candidate.error;
        error.sum_sq *= factor * factor;
        error.objective *= match self.measure {
            Measure::Sum | Measure::WeightedSum => factor * factor,
            Measure::Largest => factor,
            Measure::LargestPart | Measure::SumInRange | Measure::LargestInRange => 1.0,
        };
        for length in [&mut error.rms, &mut error.max] {
            *length *= factor;
        }
        if let Some(both) = &mut error.two_sided {
            for length in [&mut both.mean, &mut both.worst] {
                *length *= factor;
            }
        }
        for curve in std::iter::once(&mut error.to_curve).chain(&mut error.to_raw) {
            curve.sum_sq *= factor * factor;
            curve.rms *= factor;
            curve.max *= factor;
        }
        Ok(entry)
    }
}

/// Returns the entries with all lengths in one unit: lengths without a unit are taken to be in it; unchanged if `unit`
/// is `None`.
///
/// The requirements and the costs of a candidate keep the values of its own problem.
///
/// # Errors
/// As [`FourBar::new`](crate::mechanism::FourBar::new), if a length leaves the allowed range.
pub fn in_one_unit(entries: &[Entry], unit: Option<Unit>) -> Result<Vec<Entry>, LinkageError> {
    let Some(unit) = unit else { return Ok(entries.to_vec()) };
    entries.iter().map(|entry| Ok(Entry { unit: Some(unit), ..entry.converted(unit)? })).collect()
}

/// Returns a sentence on each unit from which lengths were converted, and on lengths without a unit; `units` are labels
/// with their units.
pub fn unit_remarks(units: &[(String, Option<Unit>)], to: Unit) -> Vec<String> {
    let labels = |has: Option<Unit>| {
        let having = units.iter().filter(|(_, unit)| *unit == has);
        let labels: Vec<String> = having.map(|(label, _)| clean(label)).collect();
        (!labels.is_empty()).then(|| first_few(&labels))
    };
    let converted = |from: Unit| {
        let labels = labels(Some(from))?;
        Some(format!("Lengths converted from {} to {}: {labels}.", from.label(), to.label()))
    };
    let taken =
        labels(None).map(|labels| format!("Without a unit, taken to be in {}: {labels}.", to.label()));
    Unit::ALL.into_iter().filter(|from| *from != to).filter_map(converted).chain(taken).collect()
}
