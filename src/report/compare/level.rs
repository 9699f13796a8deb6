//! Levels: figures that are equal within the margin of limits get one common value before they are ordered.
//!
//! "Within a margin of each other" is not an order: x may be near y and y near z without x being near z. So figures are
//! sorted as they are, better first; the best is the first level, and all that lie within [`MET_TOLERANCE`] of it
//! belong to it; the best of the rest is the next level, and so on. Ranks, the front and differences from the best are
//! computed from levels.

use super::{Entry, SortKey};
use crate::mechanism::point;
use crate::record::{EXACT_MEAN_SQ, MET_TOLERANCE};
use crate::report::scene::Bounds;
use crate::task::spec::Measure;

/// Returns whether two figures of one kind are equal to a reader; `nothing` is the value below which they count as 0.
pub(super) fn equal(x: f64, y: f64, nothing: f64) -> bool {
    x == y || (x - y).abs() <= (MET_TOLERANCE * x.abs().max(y.abs())).max(nothing)
}

/// Returns the value below which an error of an entry is only rounding; the other figures have no such floor.
pub(super) fn nothing(entry: &Entry, key: SortKey) -> f64 {
    let outputs = || entry.pairs.iter().map(|[_, output]| *output);
    let range = outputs().fold(f64::NEG_INFINITY, f64::max) - outputs().fold(f64::INFINITY, f64::min);
    let (size, n) = match entry.pairs.len() {
        0 => (Bounds::of(entry.target.iter().map(|p| point(*p))).diagonal(), entry.target.len()),
        n => (range, n),
    };
    let mean_sq = EXACT_MEAN_SQ * size.powi(2);
    match key {
        SortKey::SumSq => mean_sq * n as f64,
        SortKey::Rms | SortKey::Max | SortKey::ToCurve => mean_sq.sqrt(),
        SortKey::Objective => match entry.measure {
            Measure::Sum | Measure::WeightedSum | Measure::SumInRange => mean_sq * n as f64,
            Measure::Largest | Measure::LargestInRange => mean_sq.sqrt(),
            Measure::LargestPart => EXACT_MEAN_SQ.sqrt(),
        },
        SortKey::AngleRms | SortKey::AngleMax => EXACT_MEAN_SQ.sqrt().to_degrees(),
        SortKey::Transmission | SortKey::LinkRatio | SortKey::Size | SortKey::Extent => 0.0,
    }
}

/// Returns the level of each figure: the best figure that it is equal to.
pub(super) fn levels(figures: &[Option<f64>], key: SortKey, nothing: f64) -> Vec<Option<f64>> {
    let mut order: Vec<(usize, f64)> =
        figures.iter().enumerate().filter_map(|(i, figure)| Some((i, (*figure)?))).collect();
    order.sort_by(|x, y| key.order(x.1, y.1));
    let mut levels = vec![None; figures.len()];
    let mut level = f64::NAN;
    for (i, figure) in order {
        if !equal(level, figure, nothing) {
            level = figure;
        }
        // Adding 0 turns -0 into 0.
        levels[i] = Some(level + 0.0);
    }
    levels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_within_the_margin_of_the_best_of_them_are_one_level() {
        let all = [Some(35.0 + 3e-6), None, Some(35.0), Some(34.9), Some(35.0 + 1e-6), Some(-0.0), Some(0.0)];
        let best = Some(35.0 + 3e-6);
        assert_eq!(
            levels(&all, SortKey::Transmission, 0.0),
            [best, None, best, Some(34.9), best, Some(0.0), Some(0.0)]
        );
        // A chain of neighbours ends at the first that is not equal to the best.
        let chain: Vec<Option<f64>> = (0..4).map(|i| Some(1.0 + 6e-8 * f64::from(i))).collect();
        assert_eq!(levels(&chain, SortKey::Rms, 0.0), [chain[0], chain[0], chain[2], chain[2]]);
        assert_eq!(
            levels(&[Some(1e-30), Some(3e-29), Some(1e-9)], SortKey::Rms, 1e-24),
            [Some(1e-30), Some(1e-30), Some(1e-9)]
        );
    }
}
