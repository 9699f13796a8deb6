//! The error of the point that comes nearest to missing its tolerance.

use super::{Finding, Judged, at_most};

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let tolerances = judged.problem.task().tolerances()?;
    let structural = judged.structural;
    // The point whose error is the largest part of its own tolerance: the quantity that the largest deviation minimises
    // and that ranks. A point that is missed goes before one that is met only by the margin of a very small tolerance.
    let error = |k: usize| structural[k].norm();
    let missed = |k: usize| !at_most(error(k), tolerances[k]);
    let part = |k: usize| if error(k) == 0.0 { 0.0 } else { error(k) / tolerances[k] };
    let worst = (0..structural.len())
        .max_by(|&i, &j| missed(i).cmp(&missed(j)).then(part(i).total_cmp(&part(j))).then(j.cmp(&i)))
        .unwrap_or(0);
    Some(Finding::most(structural[worst].norm(), tolerances[worst]))
}
