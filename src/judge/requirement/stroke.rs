//! The stroke of a slider-crank's slider and its time ratio, from the two positions in which crank and coupler lie on one line.

use super::{Finding, Judged, at_least, at_most};
use crate::mechanism::{Complex, CrankLinkage, cross, dot};
use crate::record::Figure;
use crate::task::spec::Limits;
use std::f64::consts::{PI, TAU};

pub(super) fn length(judged: &Judged<'_>) -> Option<Finding> {
    Some(within(ends(&judged.candidate.linkage).map(|[length, _]| length), judged.require().stroke?))
}

pub(super) fn time_ratio(judged: &Judged<'_>) -> Option<Finding> {
    Some(within(ends(&judged.candidate.linkage).map(|[_, ratio]| ratio), judged.require().time_ratio?))
}

/// Returns the finding of a value that is to lie between two limits; without a value, of a slider that has no ends.
fn within(value: Option<f64>, Limits(low, high): Limits) -> Finding {
    let limit = if low == high { Figure::Number(low) } else { Figure::Numbers(vec![low, high]) };
    match value {
        Some(value) => {
            let met = at_least(value, low) && at_most(value, high);
            Finding { value: Figure::Number(value), limit, met }
        }
        None => Finding { value: Figure::Word("none".into()), limit, met: false },
    }
}

/// Returns the stroke and the time ratio; `None` unless the crank of a slider-crank turns fully.
fn ends(linkage: &CrankLinkage) -> Option<[f64; 2]> {
    let slider = linkage.slider_crank()?;
    if !linkage.mobility().input_turns_fully() {
        return None;
    }
    let (crank, coupler) = (linkage.crank(), linkage.coupler()?);
    let (along, from) = (slider.line_direction(), slider.line_point() - linkage.crank_pivot());
    let height = cross(along, from);
    // The slider in the distances b + a and b - a of A, on the side of the line on which t1 puts it.
    let side = linkage.assembly().sign();
    let at = |reach: f64| {
        let sq = (reach - height) * (reach + height);
        (sq > 0.0).then(|| Complex::new(side * sq.sqrt(), height))
    };
    let (far, near) = (at(coupler + crank)?, at(coupler - crank)?);
    // There the crank points to the slider, here away from it.
    let turned = (near.arg() + PI - far.arg()).rem_euclid(TAU);
    let quick = turned.min(TAU - turned);
    let length = dot(far - near, Complex::new(1.0, 0.0)).abs();
    (quick > 0.0).then(|| [length, (TAU - quick) / quick])
}
