//! The distances of the fixed pivots from their lines or points.

use super::{Finding, Judged};
use crate::mechanism::Complex;
use crate::task::pivot_on::Locus;

/// The greater of both distances.
pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    let pivot_on = judged.require().pivot_on.as_ref()?;
    let linkage = &judged.candidate.linkage;
    let pivots = [Some(linkage.crank_pivot()), linkage.second_pivot()];
    let distance = |(pivot, locus): (Option<Complex>, Option<&Locus>)| {
        let pivot = pivot?;
        let points = locus?.0.as_slice();
        let [x0, y0] = *points.first()?;
        let (x, y) = (pivot.re - x0, pivot.im - y0);
        let [x1, y1] = *points.last()?;
        let (u, v) = (x1 - x0, y1 - y0);
        let length = u.hypot(v);
        // Twice the area of the triangle over its base.
        Some(if length > 0.0 { (u * y - v * x).abs() / length } else { x.hypot(y) })
    };
    let farthest = pivots.into_iter().zip(pivot_on.both()).filter_map(distance).fold(0.0, f64::max);
    Some(Finding::most(farthest, 0.0))
}
