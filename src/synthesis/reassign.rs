//! Correspondence between target points and coupler curve: assigns the points to curve samples in their order, by
//! dynamic programming.
//!
//! A joint fit moves each position along its curve to the nearest local minimum of its distance. If the curve has a
//! corner, a cusp or two strands close together, another place may be nearer, and every such choice is a local optimum
//! of its own that no descent leaves. On samples of the curve the globally best assignment is found at once, by dynamic
//! programming over the samples in the order of the motion:
//!
//! ```text
//! V_j(m) = w_j |T_j - P_m|^2 + min over m' <= m of V_j-1(m'),   least V_n-1(m) by going back
//! ```
//!
//! On a closed circuit the first point is pinned, in turn, to its present place and to the places where it would be
//! nearest. The present places are among the samples, so that the result is never worse than the start.

use super::coarse::points_of;
use crate::mechanism::four_bar::mobility::ways_round;
use crate::mechanism::{AssemblyMode, Complex, FourBar, InputArc, Mobility};
use crate::numbers::optimise::levenberg_marquardt::BlockLeastSquares;
use crate::task::Problem;
use crate::task::forms::rows::assembly_of;
use crate::task::forms::start::Start;
use crate::task::forms::torus::{PathFit, Positions};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Number of samples around a circuit, evenly in its parameter.
const EVEN: usize = 240;
/// Greatest number of parts into which a chord between samples is divided if it is longer than the mean one.
const DIVIDED: usize = 8;
/// Number of places to which the first point is pinned.
const PINS: usize = 3;
/// Number of points above which a target is left as it is.
const MOST: usize = 400;
/// Least relative gain of the cost for which a new assignment is taken.
const GAIN: f64 = 1e-3;

/// The result of a reassignment on the same linkage.
#[derive(Clone, Debug)]
pub struct Reassigned {
    /// The start with its points at their best places; `None` if they are there already.
    pub better: Option<Start>,
    /// Number of positions computed.
    pub positions: u64,
}

/// A sample of the curve.
#[derive(Clone, Copy)]
struct Place {
    parameter: f64,
    point: Complex,
    position: [Complex; 2],
}

/// The circuit of a start's first point.
struct Track {
    linkage: FourBar,
    arc: Option<InputArc>,
    assembly: AssemblyMode,
}

impl Track {
    fn place(&self, parameter: f64) -> Option<Place> {
        let (angle, assembly) = match self.arc {
            None => (parameter, self.assembly),
            Some(arc) => (arc.crank_angle(parameter), AssemblyMode::of(parameter.cos())),
        };
        let joints = self.linkage.position_with(angle, assembly).joints()?;
        let coupler = (joints.follower_pin - joints.crank_pin) / self.linkage.coupler();
        Some(Place {
            parameter,
            point: joints.coupler_point,
            position: [Complex::from_polar(1.0, angle), coupler],
        })
    }

    fn parameter(&self, crank: Complex, assembly: AssemblyMode) -> f64 {
        self.arc.map_or(crank.arg(), |arc| arc.parameter(crank.arg(), assembly))
    }
}

/// Finds the best places of the points of a target of free timing along the curve of a start's linkage: on the circuit
/// of its first point; in their order and at most once around if the problem requires an order; on its branch if one is
/// required.
pub fn reassigned(problem: &Problem, start: &Start) -> Reassigned {
    let nothing = Reassigned { better: None, positions: 0 };
    let task = problem.task();
    if task.len() > MOST || task.len() < 2 {
        return nothing;
    }
    let space = problem.space(start.setting.side);
    let Some(shape) = space.shape(&start.design) else { return nothing };
    let assemblies: Vec<AssemblyMode> =
        start.positions.iter().map(|[e, u]| assembly_of(&shape, *e, *u)).collect();
    let Ok(linkage) = shape.linkage(assemblies[0]) else { return nothing };
    let mobility: Mobility = linkage.mobility();
    let arc = mobility.arc(mobility.branch(start.positions[0][0].arg(), assemblies[0]).circuit);
    let track = Track { linkage, arc, assembly: assemblies[0] };
    let own: Vec<f64> =
        start.positions.iter().zip(&assemblies).map(|([e, _], t)| track.parameter(*e, *t)).collect();

    // The closing point has the place of the first one.
    let n = points_of(problem);
    let [forward, backward] = ways_round(own[..n].windows(2).map(|w| w[1] - w[0]), 0.0);
    let direction = if backward < forward { -1.0 } else { 1.0 };
    let one_branch = arc.is_some() && !problem.branch_any();
    let places = sampled(&track, &own[..n], direction, one_branch);
    let count = places.len() as u64;
    if places.len() < 2 {
        return nothing;
    }
    let target = Target { points: &task.points()[..n], weights: &task.weights()[..n] };
    let mut positions: Positions = if !problem.order_required() {
        target.nearest(&places)
    } else if one_branch {
        // A rocking motion may run either way.
        let ahead = target.along(&places, None);
        let mut back = places.clone();
        back.reverse();
        let behind = target.along(&back, None);
        if behind.0 < ahead.0 { behind.1 } else { ahead.1 }
    } else {
        let first = own[0].rem_euclid(TAU);
        let pinned = target.pins(&places, first).into_iter().map(|pin| {
            let mut around = places.clone();
            around.rotate_left(pin);
            target.along(&around, Some(0))
        });
        pinned.min_by(|one, other| one.0.total_cmp(&other.0)).map_or(Vec::new(), |(_, positions)| positions)
    };
    let fit = PathFit::new(problem, start.setting);
    let cost = |positions: &Positions| fit.cost(&start.design, positions);
    let Some(now) = cost(&start.positions) else { return Reassigned { better: None, positions: count } };
    let mut better = None;
    if positions.len() == n {
        if task.repeats_first() {
            positions.push(positions[0]);
        }
        let settled = fit.settle(&start.design, &mut positions);
        if settled && cost(&positions).is_some_and(|cost| cost < (1.0 - GAIN) * now) {
            better = Some(Start { positions, ..start.clone() });
        }
    }
    Reassigned { better, positions: count }
}

/// Returns samples around the circuit in the direction of the motion, or along the branch of the first point; the
/// points' `own` places are among them.
fn sampled(track: &Track, own: &[f64], direction: f64, one_branch: bool) -> Vec<Place> {
    let (low, span) = if one_branch {
        let middle = if track.assembly == AssemblyMode::Plus { 0.0 } else { TAU / 2.0 };
        (middle - FRAC_PI_2, TAU / 2.0)
    } else {
        (0.0, TAU)
    };
    // Half a step off, so that no sample lies on a toggle.
    let at = |i: f64| low + span * (i + 0.5) / EVEN as f64;
    let even: Vec<Place> = (0..EVEN).filter_map(|i| track.place(at(i as f64))).collect();
    let chord = |w: &[Place]| (w[1].point - w[0].point).norm();
    let mean = even.windows(2).map(chord).sum::<f64>() / EVEN as f64;
    let mut places = even.clone();
    for w in even.windows(2) {
        let parts = if mean > 0.0 { (chord(w) / mean).ceil().min(DIVIDED as f64) as usize } else { 1 };
        let step = (w[1].parameter - w[0].parameter) / parts.max(1) as f64;
        places.extend((1..parts).filter_map(|k| track.place(w[0].parameter + step * k as f64)));
    }
    let inside = |parameter: &f64| low + (parameter - low).rem_euclid(TAU);
    places.extend(own.iter().map(inside).filter(|p| *p <= low + span).filter_map(|p| track.place(p)));
    places.sort_by(|one, other| (direction * one.parameter).total_cmp(&(direction * other.parameter)));
    places
}

/// The target points with their weights.
struct Target<'a> {
    points: &'a [Complex],
    weights: &'a [f64],
}

impl Target<'_> {
    /// Returns the positions at the samples nearest to the points.
    fn nearest(&self, places: &[Place]) -> Positions {
        let nearest = |point: &Complex| {
            let apart = places.iter().map(|place| ((place.point - point).norm_sqr(), place.position));
            apart.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, position)| position)
        };
        self.points.iter().filter_map(nearest).collect()
    }

    /// Returns the indices of the samples of a closed circuit at which the first point may begin: its present place,
    /// and the nearest local minima of its distance.
    fn pins(&self, places: &[Place], own: f64) -> Vec<usize> {
        let count = places.len();
        let square: Vec<f64> = places.iter().map(|place| (place.point - self.points[0]).norm_sqr()).collect();
        let off = |m: &usize| (places[*m].parameter.rem_euclid(TAU) - own).abs();
        let here = (0..count).min_by(|one, other| off(one).total_cmp(&off(other)));
        let mut lowest: Vec<usize> = (0..count)
            .filter(|&m| square[m] <= square[(m + 1) % count] && square[m] < square[(m + count - 1) % count])
            .collect();
        lowest.sort_by(|one, other| square[*one].total_cmp(&square[*other]));
        let mut pins: Vec<usize> = here.into_iter().collect();
        pins.extend(lowest.into_iter().filter(|m| Some(*m) != here));
        pins.truncate(PINS);
        pins
    }

    /// Returns the least weighted sum of squares over non-decreasing assignments of points to samples, and the
    /// positions that attain it; the first point is pinned to a sample, or free.
    fn along(&self, places: &[Place], pinned: Option<usize>) -> (f64, Positions) {
        let (n, count) = (self.points.len(), places.len());
        let mut back = vec![0_u32; n * count];
        let mut value = vec![0.0; count];
        for (j, (point, weight)) in self.points.iter().zip(self.weights).enumerate() {
            let (mut least, mut from) = (f64::INFINITY, 0_u32);
            for (m, place) in places.iter().enumerate() {
                let square = weight * (place.point - point).norm_sqr();
                if j == 0 {
                    value[m] = if pinned.is_none_or(|pin| pin == m) { square } else { f64::INFINITY };
                    continue;
                }
                if value[m] < least {
                    (least, from) = (value[m], m as u32);
                }
                value[m] = least + square;
                back[j * count + m] = from;
            }
        }
        let Some(mut at) = (0..count).min_by(|one, other| value[*one].total_cmp(&value[*other])) else {
            return (f64::INFINITY, Positions::new());
        };
        let sum = value[at];
        let mut positions = vec![places[at].position; n];
        for j in (1..n).rev() {
            at = back[j * count + at] as usize;
            positions[j - 1] = places[at].position;
        }
        (sum, positions)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::arithmetic::streams::{below, stream, uniform};
    use crate::synthesis::fixture;

    fn random_places(count: usize, random: &mut crate::numbers::arithmetic::streams::Stream) -> Vec<Place> {
        let one = Complex::new(1.0, 0.0);
        (0..count)
            .map(|m| Place {
                parameter: m as f64,
                point: Complex::new(uniform(random, -1.0, 1.0), uniform(random, -1.0, 1.0)),
                position: [one * m as f64, one],
            })
            .collect()
    }

    /// Returns the least sum over all non-decreasing sequences of places, by trying each.
    fn by_trying_all(target: &Target<'_>, places: &[Place], from: usize, point: usize) -> f64 {
        if point == target.points.len() {
            return 0.0;
        }
        (from..places.len())
            .map(|m| {
                let square = target.weights[point] * (places[m].point - target.points[point]).norm_sqr();
                square + by_trying_all(target, places, m, point + 1)
            })
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn the_choice_is_the_best_of_all_in_order() {
        let mut random = stream(11, 0);
        for _ in 0..300 {
            let places = random_places(1 + below(&mut random, 7), &mut random);
            let n = 1 + below(&mut random, 5);
            let points: Vec<Complex> = random_places(n, &mut random).iter().map(|p| p.point).collect();
            let weights: Vec<f64> = (0..n).map(|_| uniform(&mut random, 0.1, 3.0)).collect();
            let target = Target { points: &points, weights: &weights };
            let (sum, positions) = target.along(&places, None);
            assert!((sum - by_trying_all(&target, &places, 0, 0)).abs() < 1e-12);
            let at: Vec<usize> = positions.iter().map(|[e, _]| e.re as usize).collect();
            assert!(at.is_sorted());
            let again: f64 = (0..n).map(|j| weights[j] * (places[at[j]].point - points[j]).norm_sqr()).sum();
            assert!((sum - again).abs() < 1e-12);
            // With the first point at the first place.
            let (pinned, positions) = target.along(&places, Some(0));
            assert_eq!(positions[0][0].re, 0.0);
            let first = weights[0] * (places[0].point - points[0]).norm_sqr();
            assert!((pinned - first - by_trying_all(&target, &places, 0, 1)).abs() < 1e-12);
        }
    }

    /// Returns points of a linkage's curve, and a start on it with its points at other places.
    fn displaced(links: [f64; 4], order: bool, closed: bool) -> (Problem, Start, f64) {
        let linkage = fixture::linkage(links);
        let mobility = linkage.mobility();
        let begin = match mobility.input {
            crate::mechanism::InputRange::One(arc) | crate::mechanism::InputRange::Two([arc, _]) => {
                arc.middle
            }
            _ => 0.3,
        };
        let circuit = mobility.branch(begin, AssemblyMode::Plus).circuit;
        let track = Track { linkage, arc: mobility.arc(circuit), assembly: AssemblyMode::Plus };
        let n = 40;
        let span = if closed { TAU } else { 4.0 };
        let own: Vec<Place> =
            (0..n).filter_map(|j| track.place(0.2 + span * f64::from(j) / f64::from(n))).collect();
        let points: Vec<[f64; 2]> = own.iter().map(|p| [p.point.re, p.point.im]).collect();
        let order = if order { "required" } else { "any" };
        let require = format!("order = \"{order}\"\nbranch = \"any\"");
        let problem = fixture::problem(&points, closed, &require);
        // All of them crowd together in the first fifth of their way.
        let positions = (0..n)
            .filter_map(|j| track.place(0.2 + 0.2 * span * f64::from(j) / f64::from(n)))
            .map(|place| place.position)
            .collect();
        let size = problem.task().size();
        let start = fixture::start(&problem, &linkage, positions);
        (problem, start, size)
    }

    #[test]
    fn points_find_their_own_stretch_of_every_kind_of_curve() {
        // Crank-rocker, double-crank, rocker-crank, triple-rocker.
        for links in [[4.0, 1.5, 3.5, 3.2], [1.0, 2.0, 1.8, 2.2], [4.0, 3.2, 3.5, 1.5], [3.0, 2.0, 2.1, 2.4]]
        {
            for (order, closed) in [(true, true), (true, false), (false, true)] {
                let (problem, start, size) = displaced(links, order, closed);
                let better = reassigned(&problem, &start).better.expect("they are not at their places");
                let fit = PathFit::new(&problem, start.setting);
                let cost = fit.cost(&better.design, &better.positions).expect("a cost");
                // Samples are about a hundredth of the curve apart.
                assert!(cost < 40.0 * (0.02 * size).powi(2), "{links:?} {order:?} {closed}: {cost}");
                assert!(reassigned(&problem, &better).better.is_none(), "nothing is left to gain");
            }
        }
    }
}
