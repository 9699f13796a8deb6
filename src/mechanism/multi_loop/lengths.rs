//! The lengths of a linkage of several loops, which fix the shape of each body, and linkages with given ones.

use super::MultiLoop;
use crate::mechanism::dyad_chain::kinds::{CRANK, GROUND};
use crate::mechanism::{Complex, dot};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::FRAC_PI_2;

/// The distance of two joints of one body, P among them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkLength {
    /// The body.
    pub body: usize,
    /// The places of the two in the list of the body's joints ([`MultiLoop::links`]).
    pub places: [usize; 2],
    /// Their names.
    pub joints: [&'static str; 2],
    /// Their distance.
    pub length: f64,
}

impl MultiLoop {
    /// Returns the lengths of all bodies: of each the distance of its first two joints, and that of every further joint from these
    /// two. None follows from the others, and together with the sides on which further joints lie they fix the body.
    pub fn lengths(&self) -> Vec<LinkLength> {
        let mut lengths = Vec::new();
        for body in self.links() {
            let of = |one: usize, other: usize| {
                let [(first, from), (second, to)] = [body.joints[one], body.joints[other]];
                LinkLength {
                    body: body.body,
                    places: [one, other],
                    joints: [first, second],
                    length: (to - from).norm(),
                }
            };
            lengths.push(of(0, 1));
            for other in 2..body.joints.len() {
                lengths.extend([of(0, other), of(1, other)]);
            }
        }
        lengths
    }

    /// Returns the linkage with lengths, fixed pivots (by name) and the direction from A to B (radians) at given values, of which it is
    /// near: the joints of each body move as little as that takes. `None` where there is no such body near.
    pub fn holding(
        &self,
        lengths: &[(LinkLength, f64)],
        pivots: &[(&str, Complex)],
        ground_angle: Option<f64>,
    ) -> Option<Self> {
        let mut made = *self;
        for body in self.links() {
            let own =
                |(of, length): &(LinkLength, f64)| (of.body == body.body).then_some((of.places, *length));
            let mut held: Vec<Held> =
                lengths.iter().filter_map(own).map(|(places, length)| Held::Length(places, length)).collect();
            if body.body == GROUND {
                let place = |name: &str| body.joints.iter().position(|joint| joint.0 == name);
                for (name, at) in pivots {
                    held.push(Held::Pivot(place(name)?, *at));
                }
                held.extend(ground_angle.map(Held::Direction));
            }
            if !held.is_empty() {
                let mut joints: Vec<Complex> = body.joints.iter().map(|joint| joint.1).collect();
                hold(&mut joints, &held)?;
                for one in &held {
                    if let Held::Pivot(place, at) = one {
                        joints[*place] = *at;
                    }
                }
                // The last digit of the line's own length, which is a number of the linkage.
                let base = lengths.iter().filter_map(own).find(|(places, _)| *places == [0, 1]);
                made = made.with_joints(body.body, &joints, base.map(|(_, length)| length))?;
            }
        }
        Some(made)
    }

    /// Returns the linkage with the joints of a body at other places in the plane, and its line at this length, which it has up to
    /// rounding.
    fn with_joints(&self, body: usize, joints: &[Complex], base: Option<f64>) -> Option<Self> {
        let mut made = *self;
        let line = joints[1] - joints[0];
        let length = base.unwrap_or(line.norm());
        let along = line.conj() / line.norm();
        let own = |p: &Complex| if body == GROUND { *p } else { (p - joints[0]) * along };
        match body {
            GROUND => (made.crank_pivot, made.dyads[0].ends[1]) = (joints[0], joints[1]),
            CRANK => made.crank = length,
            link => made.dyads[(link - 2) / 2].lengths[(link - 2) % 2] = length,
        }
        let mut further = joints[2..].iter().map(own);
        for dyad in 1..made.kind.dyads() {
            for (end, on) in made.kind.anchors(dyad).into_iter().enumerate() {
                if on == body {
                    made.dyads[dyad].ends[end] = further.next()?;
                }
            }
        }
        if made.kind.traced() == body {
            made.coupler_point = further.next()?;
        }
        let parts = (made.crank_pivot, made.crank);
        MultiLoop::new(made.kind, parts, made.dyads(), made.coupler_point).ok()
    }
}

/// A dimension of a body at a given value.
enum Held {
    /// The distance of two joints.
    Length([usize; 2], f64),
    /// The place of a joint.
    Pivot(usize, Complex),
    /// The direction from the first joint to the second.
    Direction(f64),
}

/// Moves joints to where all is held that they nearly have, each step as little as it takes: Newton's method with the least-norm
/// solution of its linear equations, shortened where it overshoots (at three joints in line, where lengths are stationary). `None`
/// if that does not come to an end.
fn hold(joints: &mut Vec<Complex>, held: &[Held]) -> Option<()> {
    const STEPS: usize = 60;
    const HALVINGS: i32 = 20;
    /// Relative residuals at which all is held, and at which it is where no step gains any more.
    const ROUNDING: f64 = 4.0 * f64::EPSILON;
    const HAIR: f64 = 1e-12;
    /// Singular values that count as none.
    const RANK: f64 = 1e-9;
    let farthest = joints.iter().flat_map(|p| [p.norm(), (p - joints[0]).norm()]).fold(0.0, f64::max);
    let mut residual = largest(&rows(joints, held));
    for _ in 0..STEPS {
        if residual <= ROUNDING * farthest {
            return Some(());
        }
        let rows = rows(joints, held);
        let mut matrix = DMatrix::zeros(rows.len(), 2 * joints.len());
        for (row, (_, slopes)) in rows.iter().enumerate() {
            for (joint, slope) in slopes {
                (matrix[(row, 2 * joint)], matrix[(row, 2 * joint + 1)]) = (slope.re, slope.im);
            }
        }
        let wanted = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.0));
        let step = matrix.svd(true, true).solve(&wanted, RANK).ok()?;
        let moved = |share: f64| -> Vec<Complex> {
            let steps = step.as_slice().chunks(2).map(|step| Complex::new(step[0], step[1]) * share);
            joints.iter().zip(steps).map(|(joint, step)| joint + step).collect()
        };
        let better = (0..HALVINGS).map(|halvings| moved(0.5_f64.powi(halvings))).find_map(|moved| {
            let after = largest(&self::rows(&moved, held));
            (after < residual).then_some((moved, after))
        });
        match better {
            Some((moved, after)) => (*joints, residual) = (moved, after),
            // Rounding is left, or what is held contradicts itself.
            None => break,
        }
    }
    (residual <= HAIR * farthest).then_some(())
}

/// An equation: how much is missing, and the slopes by the joints.
type Row = (f64, Vec<(usize, Complex)>);

/// Returns the equations of all that is held.
fn rows(joints: &[Complex], held: &[Held]) -> Vec<Row> {
    let mut rows = Vec::new();
    for one in held {
        match one {
            Held::Length([i, j], length) => {
                let apart = joints[*j] - joints[*i];
                let unit = apart / apart.norm();
                rows.push((length - apart.norm(), vec![(*i, -unit), (*j, unit)]));
            }
            Held::Pivot(i, at) => {
                let away = at - joints[*i];
                rows.push((away.re, vec![(*i, Complex::new(1.0, 0.0))]));
                rows.push((away.im, vec![(*i, Complex::new(0.0, 1.0))]));
            }
            Held::Direction(angle) => {
                let normal = Complex::from_polar(1.0, angle + FRAC_PI_2);
                let line = joints[1] - joints[0];
                rows.push((-dot(line, normal), vec![(0, -normal), (1, normal)]));
            }
        }
    }
    rows
}

/// Returns the largest that is missing of an equation; infinite where one is no number.
fn largest(rows: &[Row]) -> f64 {
    rows.iter().map(|row| if row.0.is_nan() { f64::INFINITY } else { row.0.abs() }).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::multi_loop::LinkPair;
    use crate::mechanism::{AssemblyMode, DyadChainKind};
    use crate::numbers::arithmetic::streams::{Stream, stream, uniform};

    fn drawn(draws: &mut Stream, kind: DyadChainKind) -> MultiLoop {
        let mut place = || Complex::new(uniform(draws, -1.0, 1.0), uniform(draws, -1.0, 1.0));
        let dyads: Vec<LinkPair> = (0..kind.dyads())
            .map(|_| LinkPair { ends: [place(), place()], lengths: [1.3, 0.7], side: AssemblyMode::Minus })
            .collect();
        MultiLoop::new(kind, (place(), 0.4), &dyads, place()).expect("a linkage")
    }

    #[test]
    fn every_length_can_be_held_and_what_is_not_held_moves_little() {
        let draws = &mut stream(73, 0);
        let (mut all, mut flat) = (0, 0);
        for kind in DyadChainKind::SIX_BARS.into_iter().chain(DyadChainKind::eight_bars()) {
            let linkage = drawn(draws, kind);
            let before = linkage.lengths();
            all += 1;
            // Every body is fixed: two coordinates a joint less three.
            let fixed: usize = linkage.links().iter().map(|body| 2 * body.joints.len() - 3).sum();
            assert_eq!(before.len(), fixed);
            let wanted: Vec<_> =
                before.iter().map(|one| (*one, one.length * uniform(draws, 0.999, 1.001))).collect();
            // Three sides of a flat triangle are none any more where they change.
            let Some(made) = linkage.holding(&wanted, &[], None) else {
                flat += 1;
                continue;
            };
            for (after, (before, wanted)) in made.lengths().iter().zip(&wanted) {
                assert_eq!(after.joints, before.joints);
                assert!((after.length - wanted).abs() < 1e-11, "{kind:?} {after:?} {wanted}");
            }
            assert_eq!(made.crank(), wanted.iter().find(|(of, _)| of.joints == ["A", "C"]).expect("a").1);
            for (one, other) in linkage.joints().iter().zip(made.joints()) {
                assert!((one.at - other.at).norm() < 0.2, "{kind:?} {one:?} {other:?}");
            }
        }
        assert!(20 * flat < all, "{flat} of {all}");
    }

    #[test]
    fn three_joints_are_brought_into_line() {
        let mut joints = vec![Complex::new(0.0, 0.0), Complex::new(44.01, 0.0), Complex::new(59.98, 0.2)];
        let held = [([0, 1], 44.0), ([0, 2], 60.0), ([1, 2], 16.0)];
        let held = held.map(|(places, length)| Held::Length(places, length));
        hold(&mut joints, &held).expect("they can be in line");
        assert!(largest(&rows(&joints, &held)) < 1e-10);
        let apart = [Held::Length([0, 1], 44.0), Held::Length([0, 2], 61.0), Held::Length([1, 2], 16.0)];
        assert_eq!(hold(&mut joints, &apart), None, "no triangle");
    }

    #[test]
    fn pivots_and_the_ground_s_direction_are_held_beside_its_length() {
        let draws = &mut stream(74, 0);
        let linkage = drawn(draws, DyadChainKind::SIX_BARS[0]);
        let ground = linkage.lengths()[0];
        let at = linkage.follower_pivot() + Complex::new(1e-3, -2e-3);
        let direction = (linkage.follower_pivot() - linkage.crank_pivot()).arg() + 1e-3;
        let made = linkage
            .holding(&[(ground, ground.length + 2e-3)], &[("B", at)], Some(direction))
            .expect("all are held");
        assert!((made.follower_pivot() - at).norm() < 1e-15);
        let line = made.follower_pivot() - made.crank_pivot();
        assert!((line.norm() - ground.length - 2e-3).abs() < 1e-14);
        assert!((line.arg() - direction).abs() < 1e-14);
        // A ground that both pivots contradict.
        let pivots = [("A", linkage.crank_pivot()), ("B", at)];
        assert_eq!(linkage.holding(&[(ground, 2.0 * ground.length)], &pivots, None), None);
    }
}
