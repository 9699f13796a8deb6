//! Limits to fit under next: pushes along the axes, and gaps between neighbours.

use super::archive::Entry;
use crate::judge::trade_off::Scales;
use crate::record::{Axis, Figures};
use crate::synthesis::constants::front::{
    ANCHOR_DEG, ANCHOR_PARTS, COMPACT, GAPS, LEAST_GAP, LEAST_PUSH, PUSH_DEG, PUSH_PART, STEEP_DEG,
    STEEPEST_DEG,
};
use crate::synthesis::tightened::Tighter;
use serde::{Deserialize, Serialize};

/// Limits to fit under, with the places of the linkages to start from in the archive.
pub(super) struct Target {
    /// The limits.
    pub(super) limits: Tighter,
    /// The linkages to start from.
    pub(super) from: Vec<usize>,
}

/// The push along an axis: its next step, the best value so far, and the limit that is being tried.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Push {
    axis: Axis,
    step: f64,
    aim: Option<[f64; 2]>,
}

impl Push {
    pub(super) fn new(axis: Axis) -> Self {
        Push { axis, step: if axis == Axis::Transmission { PUSH_DEG } else { PUSH_PART }, aim: None }
    }

    /// Returns the next limit beyond the best value on the axis; `None` if no step is left.
    fn next(&mut self, best: f64) -> Option<f64> {
        self.aim = None;
        let of_first = self.step / Push::new(self.axis).step;
        if of_first < LEAST_PUSH {
            return None;
        }
        let aim = match self.axis {
            Axis::Transmission => Some(best + self.step).filter(|aim| *aim < 90.0),
            Axis::LinkRatio => Some(1.0 + (best - 1.0) * (-self.step).exp()),
            _ => Some(best * (-self.step).exp()),
        };
        self.aim = aim.map(|aim| [best, aim]);
        aim
    }

    /// Shortens the step if no linkage came half of the way to the limit, and lengthens it if one did.
    pub(super) fn after(&mut self, reached: &[Figures]) {
        let Some(aim) = self.aim.take() else { return };
        let [best, aim] = aim;
        let limits = Tighter::default().with(self.axis, between(self.axis, best, aim));
        self.step *= if reached.iter().any(|figures| limits.holds(figures)) { 1.3 } else { 0.4 };
    }
}

/// Returns the value between two on the scale of their axis.
fn between(axis: Axis, one: f64, other: f64) -> f64 {
    match axis {
        Axis::Transmission => 0.5 * (one + other),
        Axis::LinkRatio => 1.0 + ((one - 1.0).max(0.0) * (other - 1.0).max(0.0)).sqrt(),
        _ => (one * other).sqrt(),
    }
}

/// Returns the tighter of two values.
fn tighter(axis: Axis, one: f64, other: f64) -> f64 {
    if axis == Axis::Transmission { one.max(other) } else { one.min(other) }
}

/// Returns the first combinations of limits: some angles, and lengths as parts of those of the closest linkage.
pub(super) fn anchors(limited: &[Axis], closest: &Figures) -> Vec<Tighter> {
    let mut all = vec![Tighter::default()];
    for &axis in limited {
        let values: Vec<f64> = match axis {
            Axis::Transmission => {
                ANCHOR_DEG.into_iter().filter(|deg| *deg > closest.transmission_deg).collect()
            }
            Axis::LinkRatio => ANCHOR_PARTS.map(|part| 1.0 + (closest.link_ratio - 1.0) * part).into(),
            _ => ANCHOR_PARTS.map(|part| closest.of(axis) * part).into(),
        };
        let before = all.clone();
        all.extend(
            values.iter().flat_map(|&value| before.iter().map(move |limits| limits.with(axis, value))),
        );
    }
    all.split_off(1)
}

/// Returns the limits under which linkages are searched for anew: other basins than that of the closest linkage are small
/// or transmit well.
pub(super) fn searched(limited: &[Axis], size: f64) -> Vec<Tighter> {
    let lengths = [Axis::Extent, Axis::Longest].into_iter().find(|axis| limited.contains(axis));
    let steep = limited.contains(&Axis::Transmission);
    let compact: Vec<Tighter> = lengths
        .map_or(Vec::new(), |axis| COMPACT.map(|part| Tighter::default().with(axis, part * size)).into());
    let all = compact.iter().copied().chain([Tighter::default()]);
    let angles: Vec<Tighter> =
        all.filter(|_| steep).map(|limits| limits.with(Axis::Transmission, STEEP_DEG)).collect();
    let longest = compact.last().copied();
    let steepest = longest.into_iter().chain([Tighter::default()]).filter(|_| steep);
    let steepest: Vec<Tighter> =
        steepest.map(|limits| limits.with(Axis::Transmission, STEEPEST_DEG)).collect();
    compact.into_iter().chain(angles).chain(steepest).collect()
}

/// Returns the targets of the next generation; empty if nothing is left to try.
pub(super) fn next(
    members: &[(Entry, Figures)],
    (axes, limited): (&[Axis], &[Axis]),
    pushes: &mut [Push],
    tried: &[Tighter],
) -> Vec<Target> {
    let mut targets: Vec<Target> = Vec::new();
    for push in pushes.iter_mut() {
        let axis = push.axis;
        let sign = if axis == Axis::Transmission { -1.0 } else { 1.0 };
        let order = |i: usize| sign * members[i].1.of(axis);
        let mut places: Vec<usize> = (0..members.len()).collect();
        places.sort_by(|&i, &j| order(i).total_cmp(&order(j)));
        let Some(&best) = places.first() else { continue };
        if let Some(aim) = push.next(members[best].1.of(axis)) {
            places.truncate(2);
            targets.push(Target { limits: Tighter::default().with(axis, aim), from: places });
        }
    }
    let is_tried = |limits: &Tighter, targets: &[Target]| {
        let others = tried.iter().chain(targets.iter().map(|target| &target.limits));
        others.into_iter().any(|other| is_near(limited, limits, other))
    };
    let mut filled = 0;
    for (i, j) in gaps(axes, members) {
        let (one, other) = (&members[i].1, &members[j].1);
        let (mut middle, mut corner) = (Tighter::default(), Tighter::default());
        for &axis in limited {
            middle = middle.with(axis, between(axis, one.of(axis), other.of(axis)));
            corner = corner.with(axis, tighter(axis, one.of(axis), other.of(axis)));
        }
        let before = targets.len();
        for limits in [middle, corner] {
            if !is_tried(&limits, &targets) {
                targets.push(Target { limits, from: vec![i, j] });
            }
        }
        filled += usize::from(targets.len() > before);
        if filled == GAPS {
            break;
        }
    }
    targets
}

/// Returns whether two sets of limits hardly differ.
fn is_near(limited: &[Axis], one: &Tighter, other: &Tighter) -> bool {
    limited.iter().all(|&axis| {
        let (mut one, mut other) = (*one, *other);
        let (one, other) = (one.place(axis).and_then(|v| *v), other.place(axis).and_then(|v| *v));
        match (one, other) {
            (None, None) => true,
            (Some(one), Some(other)) if axis == Axis::Transmission => (one - other).abs() < 0.5,
            (Some(one), Some(other)) => (one / other).ln().abs() < 0.01,
            _ => false,
        }
    })
}

/// Returns the pairs of neighbours that differ by more than [`LEAST_GAP`] on the scaled axes, the widest first. Two
/// linkages are neighbours if no third one is nearer to both of them than they are to each other (the relative
/// neighbourhood graph, Toussaint 1980).
fn gaps(axes: &[Axis], members: &[(Entry, Figures)]) -> Vec<(usize, usize)> {
    let figures: Vec<Figures> = members.iter().map(|(_, figures)| *figures).collect();
    let scales = Scales::of(axes, &figures);
    let places: Vec<Vec<f64>> = figures.iter().map(|figures| scales.scaled(figures)).collect();
    let apart = |i: usize, j: usize| -> f64 {
        places[i].iter().zip(&places[j]).map(|(one, other)| (one - other).powi(2)).sum()
    };
    let n = members.len();
    let distance: Vec<Vec<f64>> = (0..n).map(|i| (0..n).map(|j| apart(i, j)).collect()).collect();
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for i in 0..n {
        for j in i + 1..n {
            let d = distance[i][j];
            let both = distance[i].iter().zip(&distance[j]);
            let lonely = d > LEAST_GAP * LEAST_GAP
                && both.fold(true, |far, (one, other)| far & (one.max(*other) >= d));
            if lonely {
                pairs.push((d, i, j));
            }
        }
    }
    pairs.sort_by(|one, other| other.0.total_cmp(&one.0).then((one.1, one.2).cmp(&(other.1, other.2))));
    pairs.into_iter().map(|(_, i, j)| (i, j)).collect()
}
