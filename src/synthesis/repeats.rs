//! Repeated hits of the best answer, counted over independent rounds.

use super::belief::{NEARLY, SAME_OPTIMUM};
use crate::record::Repeats;

/// Returns the number of rounds whose objective lies within a relative distance `part` of the best; objectives up to
/// `exact` are exact, and equal. An objective lower than the best is that of an end that cannot be accepted, and does
/// not count.
pub(super) fn came(objectives: impl Iterator<Item = f64>, best: f64, part: f64, exact: f64) -> usize {
    let room = (part * best).max(exact);
    objectives.filter(|objective| (objective - best).abs() <= room).count()
}

/// Counts the repeated hits of `best` among rounds with these objectives, infinite for a round that was given up.
pub(super) fn counted(objectives: &[f64], best: f64, exact: f64) -> Repeats {
    let within = |part: f64| came(objectives.iter().copied(), best, part, exact) as u64;
    let mut ends: Vec<f64> = objectives.iter().copied().filter(|o| o.is_finite()).collect();
    ends.sort_by(f64::total_cmp);
    let followed = ends.len() as u64;
    ends.dedup_by(|end, first| *end - *first <= (SAME_OPTIMUM * *first).max(exact));
    let (hits, near) = (within(SAME_OPTIMUM), within(NEARLY));
    Repeats::new(objectives.len() as u64, hits, near).with_basins(followed, ends.len() as u64)
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
