//! Trade-offs between figures: dominance, the choice of the members of a front by hypervolume, and its knees.
//!
//! A linkage *dominates* another if it is at least as good on every axis and better on one; figures within
//! [`EQUAL_FIGURES`] of each other are equal, and so are errors that are rounding alone: where exact answers form a family,
//! which of them has the least error says nothing. For choices the axes are scaled to [0, 1] over the set, small is good,
//! with errors, lengths and ratios as logarithms and angles as they are. The *hypervolume* of a set is the volume that
//! its members dominate below the point (1.1, .., 1.1) (Zitzler and Thiele 1999). Members are chosen one after the
//! other, each the one that adds most to it, after the best on every axis.

use crate::judge::rank::exact_error;
use crate::record::{Axis, EQUAL_FIGURES, Figures};
use crate::task::Problem;

/// The coordinate, on every axis, of the point up to which volumes count.
const REFERENCE: f64 = 1.1;
/// Errors below this part of the largest error of a set are equally small: logarithms end there.
const LEAST_ERROR: f64 = 1e-9;
/// Distance of a member from the line through its neighbours, on scaled axes, from which it is a knee.
const KNEE: f64 = 0.06;

/// The axes of a front, with the errors up to which a linkage is exact.
#[derive(Clone, Debug, PartialEq)]
pub struct Wishes {
    /// The axes.
    pub axes: Vec<Axis>,
    /// The rms error, and the largest error, that are rounding alone.
    pub exact: [f64; 2],
}

impl Wishes {
    /// Returns the axes of a front of a problem.
    pub fn of(problem: &Problem, axes: &[Axis]) -> Wishes {
        let rms = exact_error(problem);
        Wishes { axes: axes.to_vec(), exact: [rms, rms * (problem.task().len() as f64).sqrt()] }
    }

    /// Returns a figure as a loss: small is good.
    pub fn loss(&self, figures: &Figures, axis: Axis) -> f64 {
        let value = figures.of(axis);
        match axis {
            Axis::Transmission => -value,
            Axis::Rms => value.max(self.exact[0]),
            Axis::Max => value.max(self.exact[1]),
            _ => value,
        }
    }

    /// Returns the gain of one linkage over another on each axis; 0 where they are equal.
    fn gains<'a>(&'a self, one: &'a Figures, other: &'a Figures) -> impl Iterator<Item = f64> + 'a {
        self.axes.iter().map(|&axis| gain(self.loss(one, axis), self.loss(other, axis)))
    }
}

/// Returns how far one loss is below another, in parts of the larger; 0 if they are equal.
fn gain(better: f64, worse: f64) -> f64 {
    let room = EQUAL_FIGURES * better.abs().max(worse.abs());
    if (worse - better).abs() <= room { 0.0 } else { worse - better }
}

/// Returns whether `one` dominates `other`.
pub fn dominates(wishes: &Wishes, one: &Figures, other: &Figures) -> bool {
    let gains = wishes.gains(one, other);
    let (mut worse, mut better) = (false, false);
    for gain in gains {
        worse |= gain < 0.0 || gain.is_nan();
        better |= gain > 0.0;
    }
    better && !worse
}

/// Returns whether all figures of two linkages are equal.
pub fn are_equal(wishes: &Wishes, one: &Figures, other: &Figures) -> bool {
    wishes.gains(one, other).all(|gain| gain == 0.0)
}

/// Returns the indices of those that none dominates, in their order; of equal ones the first.
pub fn undominated(wishes: &Wishes, all: &[Figures]) -> Vec<usize> {
    let beaten = |i: usize| {
        let one = &all[i];
        all.iter().enumerate().any(|(j, other)| {
            j != i && (dominates(wishes, other, one) || (j < i && are_equal(wishes, one, other)))
        })
    };
    (0..all.len()).filter(|&i| !beaten(i)).collect()
}

/// Scales of the axes of a set.
#[derive(Clone, Debug)]
pub struct Scales {
    axes: Vec<(Axis, f64, f64)>,
    least_error: f64,
}

impl Scales {
    /// Creates the scales of a set of figures.
    pub fn of(axes: &[Axis], all: &[Figures]) -> Scales {
        let errors = all.iter().map(|f| f.max.max(f.rms)).fold(0.0, f64::max);
        let mut scales = Scales { axes: Vec::new(), least_error: LEAST_ERROR * errors };
        for &axis in axes {
            let losses = all.iter().map(|figures| scales.unscaled(figures, axis));
            let (low, high) =
                losses.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), z| (low.min(z), high.max(z)));
            scales.axes.push((axis, low, high));
        }
        scales
    }

    fn unscaled(&self, figures: &Figures, axis: Axis) -> f64 {
        match axis {
            Axis::Transmission => -figures.transmission_deg,
            Axis::Rms | Axis::Max => figures.of(axis).max(self.least_error).max(f64::MIN_POSITIVE).ln(),
            _ => figures.of(axis).max(f64::MIN_POSITIVE).ln(),
        }
    }

    /// Returns figures on the scaled axes; 0 on an axis on which all are equal.
    pub fn scaled(&self, figures: &Figures) -> Vec<f64> {
        let at = |&(axis, low, high): &(Axis, f64, f64)| {
            if high > low { (self.unscaled(figures, axis) - low) / (high - low) } else { 0.0 }
        };
        self.axes.iter().map(at).collect()
    }
}

/// Returns the volume that points dominate below the reference point; the points have one coordinate per axis.
pub fn hypervolume(points: &[Vec<f64>]) -> f64 {
    let inside = |p: &&Vec<f64>| p.iter().all(|z| *z < REFERENCE);
    let mut points: Vec<&[f64]> = points.iter().filter(inside).map(Vec::as_slice).collect();
    volume(&mut points)
}

/// Slices along the last axis: between two of its values the section is the volume of the points before them.
fn volume(points: &mut Vec<&[f64]>) -> f64 {
    let Some(last) = points.first().map(|p| p.len()).and_then(|n| n.checked_sub(1)) else { return 0.0 };
    if last == 0 {
        let least = points.iter().map(|p| p[0]).fold(REFERENCE, f64::min);
        return REFERENCE - least;
    }
    points.sort_by(|p, q| p[last].total_cmp(&q[last]));
    let mut sum = 0.0;
    let mut staircase = Staircase::default();
    for i in 0..points.len() {
        let above = points.get(i + 1).map_or(REFERENCE, |next| next[last]);
        let height = above - points[i][last];
        if last == 2 {
            staircase.add([points[i][0], points[i][1]]);
        }
        if height > 0.0 {
            let section = match last {
                2 => staircase.area(),
                _ => volume(&mut points[..=i].iter().map(|p| &p[..last]).collect()),
            };
            sum += height * section;
        }
    }
    sum
}

/// The points of a plane that none dominates, by increasing first and decreasing second coordinate.
#[derive(Default)]
struct Staircase(Vec<[f64; 2]>);

impl Staircase {
    fn add(&mut self, [x, y]: [f64; 2]) {
        let place = self.0.partition_point(|step| step[0] < x);
        let before = place.checked_sub(1).map(|i| self.0[i][1]);
        let here = self.0.get(place).filter(|step| step[0] == x).map(|step| step[1]);
        if before.into_iter().chain(here).any(|lower| lower <= y) {
            return;
        }
        let beaten = self.0[place..].iter().take_while(|step| step[1] >= y).count();
        self.0.splice(place..place + beaten, [[x, y]]);
    }

    /// Returns the area that the points dominate below the reference point.
    fn area(&self) -> f64 {
        let mut above = REFERENCE;
        self.0.iter().fold(0.0, |sum, &[x, y]| {
            let height = above - y;
            above = y;
            sum + (REFERENCE - x) * height
        })
    }
}

/// Returns the indices of at most `wanted` members: the best on every axis, then those that add most to the
/// hypervolume, in the order in which they were chosen. `all` should hold no dominated ones.
pub fn members(axes: &[Axis], all: &[Figures], wanted: usize) -> Vec<usize> {
    let scales = Scales::of(axes, all);
    let places: Vec<Vec<f64>> = all.iter().map(|figures| scales.scaled(figures)).collect();
    let mut chosen: Vec<usize> = Vec::new();
    for axis in 0..axes.len() {
        let sum = |i: usize| places[i].iter().sum::<f64>();
        let best = (0..all.len())
            .min_by(|&i, &j| places[i][axis].total_cmp(&places[j][axis]).then(sum(i).total_cmp(&sum(j))));
        chosen.extend(best.filter(|best| !chosen.contains(best)));
    }
    chosen.truncate(wanted);
    // The volume that a member adds never grows as others are chosen: the last known one is an upper bound.
    let mut bound: Vec<f64> = vec![f64::INFINITY; all.len()];
    while chosen.len() < wanted.min(all.len()) {
        let mut with: Vec<Vec<f64>> = chosen.iter().map(|&i| places[i].clone()).collect();
        let now = hypervolume(&with);
        let mut order: Vec<usize> = (0..all.len()).filter(|i| !chosen.contains(i)).collect();
        order.sort_by(|&i, &j| bound[j].total_cmp(&bound[i]).then(i.cmp(&j)));
        let mut best: Option<(f64, usize)> = None;
        for i in order {
            if best.is_some_and(|(most, _)| most >= bound[i]) {
                break;
            }
            with.push(places[i].clone());
            bound[i] = hypervolume(&with) - now;
            with.pop();
            if best.is_none_or(|(most, which)| bound[i] > most || (bound[i] == most && i < which)) {
                best = Some((bound[i], i));
            }
        }
        let Some((_, i)) = best else { break };
        chosen.push(i);
    }
    chosen
}

/// Returns which members are knees: they lie below the plane through their nearest neighbours, as many as there are
/// axes, by more than the depth [`KNEE`], and no neighbour lies deeper.
pub fn knees(axes: &[Axis], members: &[Figures]) -> Vec<bool> {
    let scales = Scales::of(axes, members);
    let places: Vec<Vec<f64>> = members.iter().map(|figures| scales.scaled(figures)).collect();
    let apart = |i: usize, j: usize| -> f64 {
        places[i].iter().zip(&places[j]).map(|(one, other)| (one - other).powi(2)).sum()
    };
    let neighbours: Vec<Vec<usize>> = (0..members.len())
        .map(|i| {
            let mut others: Vec<usize> = (0..members.len()).filter(|&j| j != i).collect();
            others.sort_by(|&j, &k| apart(i, j).total_cmp(&apart(i, k)));
            others.truncate(2 * (axes.len() - 1));
            others
        })
        .collect();
    // The depth along (1, .., 1) below the mean of the neighbours.
    let sum = |i: usize| places[i].iter().sum::<f64>();
    let depth: Vec<f64> = neighbours
        .iter()
        .enumerate()
        .map(|(i, near)| {
            let mean = near.iter().map(|&j| sum(j)).sum::<f64>() / near.len().max(1) as f64;
            if near.is_empty() { 0.0 } else { (mean - sum(i)) / (axes.len() as f64).sqrt() }
        })
        .collect();
    let is_knee = |i: usize| depth[i] > KNEE && neighbours[i].iter().all(|&j| depth[j] <= depth[i]);
    (0..members.len()).map(is_knee).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const AXES: [Axis; 2] = [Axis::Rms, Axis::Extent];

    fn figures(rms: f64, extent: f64) -> Figures {
        Figures {
            rms,
            max: 2.0 * rms,
            transmission_deg: 30.0,
            extent,
            longest: extent,
            link_ratio: 2.0,
            sensitivity: 1.0,
            peak_torque: None,
        }
    }

    #[test]
    fn better_on_one_axis_and_worse_on_none_dominates() {
        let wishes = Wishes { axes: AXES.into(), exact: [0.0; 2] };
        let one = figures(1.0, 10.0);
        assert!(
            dominates(&wishes, &one, &figures(1.0, 11.0)) && !dominates(&wishes, &figures(1.0, 11.0), &one)
        );
        assert!(!dominates(&wishes, &one, &figures(0.9, 11.0)) && !dominates(&wishes, &one, &one));
        let nearly = figures(1.0 + 1e-10, 10.0);
        assert!(!dominates(&wishes, &one, &nearly) && are_equal(&wishes, &one, &nearly));
        assert_eq!(undominated(&wishes, &[nearly, one, figures(2.0, 9.0), figures(2.0, 9.5)]), [0, 2]);
    }

    #[test]
    fn of_exact_linkages_the_error_says_nothing() {
        let wishes = Wishes { axes: AXES.into(), exact: [1e-11, 2e-11] };
        let (one, other) = (figures(9e-13, 10.0), figures(2e-14, 11.0));
        assert!(dominates(&wishes, &one, &other) && !dominates(&wishes, &other, &one));
        assert!(are_equal(&wishes, &one, &figures(3e-15, 10.0)));
        assert!(!dominates(&wishes, &figures(1e-9, 10.0), &other));
    }

    #[test]
    fn the_angle_is_large_where_it_is_good() {
        let wishes = Wishes { axes: vec![Axis::Rms, Axis::Transmission], exact: [0.0; 2] };
        let steep = Figures { transmission_deg: 50.0, ..figures(1.0, 1.0) };
        assert!(dominates(&wishes, &steep, &figures(1.0, 1.0)));
    }

    #[test]
    fn volumes_are_those_of_boxes() {
        let unit = |p: &[f64]| p.iter().map(|z| REFERENCE - z).product::<f64>();
        for p in [vec![0.3], vec![0.2, 0.7], vec![0.1, 0.5, 0.9], vec![0.0, 0.5, 0.2, 1.0]] {
            assert!((hypervolume(std::slice::from_ref(&p)) - unit(&p)).abs() < 1e-15);
        }
        let both = hypervolume(&[vec![0.0, 1.0, 0.5], vec![1.0, 0.0, 0.5]]);
        let boxes = 2.0 * 1.1 * 0.1 * 0.6 - 0.1 * 0.1 * 0.6;
        assert!((both - boxes).abs() < 1e-15, "{both} {boxes}");
        assert_eq!(hypervolume(&[]), 0.0);
        assert_eq!(hypervolume(&[vec![1.2, 0.0]]), 0.0);
    }

    #[test]
    fn the_best_on_every_axis_and_then_the_largest_volumes_are_chosen() {
        let all: Vec<Figures> = [(1.0, 100.0), (1.1, 90.0), (3.0, 30.0), (9.0, 11.0), (10.0, 10.0)]
            .map(|(r, e)| figures(r, e))
            .into();
        assert_eq!(members(&AXES, &all, 3), [0, 4, 2]);
        assert_eq!(members(&AXES, &all, 9).len(), 5);
        assert_eq!(members(&AXES, &all, 1), [0]);
    }

    #[test]
    fn a_knee_lies_below_its_neighbours() {
        let straight: Vec<Figures> = (0..6).map(|i| figures(10f64.powi(i), 10f64.powi(5 - i))).collect();
        assert!(knees(&AXES, &straight).iter().all(|knee| !knee));
        let mut bent = straight;
        bent[2] = figures(30.0, 100.0);
        assert_eq!(knees(&AXES, &bent), [false, false, true, false, false, false]);
    }
}
