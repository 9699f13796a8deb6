//! Repeated hits, counted from what independent rounds came to.

use crate::record::Repeats;

/// Objectives that differ by less than this part are the same optimum.
const SAME: f64 = 1e-6;
/// Objectives that differ by less than this part are near the same optimum.
const NEAR: f64 = 1e-3;

/// Of rounds that came to these objectives, infinite where a round was given up, those that came to `best`.
/// Objectives up to `exact` are exact, and equal. An objective below the best is that of an end that cannot be
/// accepted: a basin like any other, and no hit.
pub(super) fn counted(objectives: &[f64], best: f64, exact: f64) -> Repeats {
    let room = |part: f64, of: f64| (part * of).max(exact);
    let within =
        |part: f64| objectives.iter().filter(|o| (**o - best).abs() <= room(part, best)).count() as u64;
    let mut ends: Vec<f64> = objectives.iter().copied().filter(|o| o.is_finite()).collect();
    ends.sort_by(f64::total_cmp);
    let mut basins = 0;
    let mut last: Option<f64> = None;
    for end in &ends {
        if last.is_none_or(|first| end - first > room(SAME, first)) {
            basins += 1;
            last = Some(*end);
        }
    }
    Repeats::new(objectives.len() as u64, within(SAME), within(NEAR)).with_basins(ends.len() as u64, basins)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hits_near_ones_basins_and_rounds_that_were_given_up_are_told_apart() {
        let up = f64::INFINITY;
        let objectives = [2.0, 1.0, up, 1.0 + 5e-7, 1.0005, 3.0, up, 1.0, 2.0, 0.5];
        let found = counted(&objectives, 1.0, 1e-20);
        assert_eq!((found.starts, found.hits, found.near), (10, 3, 4));
        assert_eq!((found.followed, found.basins), (Some(8), Some(5)));
        assert_eq!(found.unseen_better, Some(5.0 / 7.0));
        assert!(found.is_possible());
    }

    #[test]
    fn exact_answers_are_one_basin() {
        let found = counted(&[1e-22, 3e-21, 0.0, 1.0], 0.0, 1e-20);
        assert_eq!((found.hits, found.near, found.basins), (3, 3, Some(2)));
    }
}
