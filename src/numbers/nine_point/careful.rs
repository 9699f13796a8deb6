//! Homotopy path tracking of one path in double-double, for a solution nearer to infinity than doubles can follow.
//!
//! Equations, elimination, predictor and step control are those of [`super::equations`] and [`super::tracker`]. A
//! solution with links of a million times the points' extent loses twelve digits of sixteen in doubles, and with them
//! its direction; of the thirty-two here twenty are left.

use super::classes::Class;
use super::conjugation::Reality;
use super::equations::{LEG, UNKNOWNS, rounded, unknowns};
use super::target::{Closure, Displacements, MOST_POSES, STEPS, Solution};
use super::tracker::{Ending, NODES, Parameters, Segment, add, continuation};
use linkwright_arithmetic::Complex;
use linkwright_arithmetic::complex_lanes::ORDER;
use linkwright_arithmetic::double_double::DoubleComplex;
use std::sync::atomic::{AtomicBool, Ordering};

/// [x, x - a, x*, x* - a*, y, .., tau_1 .. tau_8].
type Unknowns = [DoubleComplex; UNKNOWNS];

/// The end of a tracked path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Followed {
    pub(super) ending: Ending,
    /// The solution at the end, rounded to doubles, with its last Newton step and dz/dt.
    pub(super) end: Class,
}

/// The size below which the change of an unknown is not measured relative to it.
const FLOOR: f64 = 1e-6;
/// The number of Newton steps on arrival, and before the first step.
const CORRECTIONS: usize = 4;
/// The shortest step in t, which is a double.
const SHORTEST: f64 = 1e-14;

/// Tracks a solution along a segment.
pub(super) fn follow(start: &Solution, along: &Segment, with: &Parameters, cancel: &AtomicBool) -> Followed {
    let mut z = unknowns(start).map(DoubleComplex::from);
    let mut tangent = corrected(&mut z, along, 0.0).1;
    // The newest node first.
    let mut nodes = vec![(0.0, z, tangent)];
    let (mut t, mut h) = (0.0, with.first_step);
    let ended = |ending: Ending, z: &Unknowns, newton_step: f64, tangent: &Unknowns| Followed {
        ending,
        end: Class {
            solution: rounded(z, DoubleComplex::to_complex),
            reality: Reality::Complex,
            newton_step,
            speed: change(tangent, z),
        },
    };
    for _ in 0..with.most_steps {
        if cancel.load(Ordering::Relaxed) {
            return ended(Ending::Cancelled, &z, f64::INFINITY, &tangent);
        }
        let to = if h >= 1.0 - t { 1.0 } else { t + h };
        let mut next = predicted(&nodes, to);
        let (first, _) = steps(&next, along, to);
        let e_1 = change(&first, &next);
        add(&mut next, &first);
        let (second, direction) = steps(&next, along, to);
        let e_2 = change(&second, &next);
        add(&mut next, &second);
        let wanted = (with.aim / e_1.max(1e-12)).powf(0.5 / nodes.len() as f64);
        if e_1 <= with.accept && e_2 <= with.contraction * e_1 {
            (t, z, tangent) = (to, next, direction);
            if t >= 1.0 {
                let (newton_step, tangent) = corrected(&mut z, along, 1.0);
                return ended(Ending::Arrived, &z, newton_step, &tangent);
            }
            nodes.insert(0, (t, z, tangent));
            nodes.truncate(NODES);
            h = (h * wanted.clamp(0.4, 2.5)).min(with.longest_step);
        } else {
            h *= if wanted.is_finite() { wanted.clamp(0.2, 0.6) } else { 0.3 };
        }
        if h < SHORTEST {
            return ended(Ending::Stalled { t }, &z, f64::INFINITY, &tangent);
        }
        if h < 1.0 - t && 2.0 * h > 1.0 - t {
            h = 0.5 * (1.0 - t);
        }
    }
    ended(Ending::OutOfSteps { t }, &z, f64::INFINITY, &tangent)
}

/// Applies a few Newton steps at t; returns the relative size of the last, and dz/dt before it.
fn corrected(z: &mut Unknowns, along: &Segment, t: f64) -> (f64, Unknowns) {
    let mut last = (f64::INFINITY, [DoubleComplex::default(); UNKNOWNS]);
    for _ in 0..CORRECTIONS {
        let (step, tangent) = steps(z, along, t);
        add(z, &step);
        last = (change(&step, z), tangent);
    }
    last
}

fn predicted(nodes: &[(f64, Unknowns, Unknowns)], to: f64) -> Unknowns {
    let at: Vec<f64> = nodes.iter().map(|node| node.0).collect();
    let (of_value, of_tangent) = continuation(to, &at);
    let mut z = [DoubleComplex::default(); UNKNOWNS];
    for (k, (_, value, tangent)) in nodes.iter().enumerate() {
        let (v, w) = (real(of_value[k]), real(of_tangent[k]));
        for i in 0..UNKNOWNS {
            z[i] = z[i] + value[i] * v + tangent[i] * w;
        }
    }
    z
}

fn real(x: f64) -> DoubleComplex {
    Complex::new(x, 0.0).into()
}

/// Computes the relative change, the root of the sum of squares, with T_j in place of tau_j. It is not finite if a
/// step is not.
fn change(step: &Unknowns, of: &Unknowns) -> f64 {
    let relative = |i: usize| {
        let z = if i < ORDER { of[i] } else { of[i] + real(1.0) };
        step[i].to_complex().norm_sqr() / (z.to_complex().norm_sqr() + FLOOR * FLOOR)
    };
    (0..UNKNOWNS).map(relative).sum::<f64>().sqrt()
}

/// Computes delta_j and delta*_j at t, each with its derivative by t.
fn displaced(along: &Segment, t: f64) -> Displacements<(DoubleComplex, DoubleComplex)> {
    let (t, left) = (real(t), real(1.0) - real(t));
    along.from.zip(&along.to, |from, to| {
        let (from, to) = (from.into(), to.into());
        (left * from + t * to, to - from)
    })
}

/// Computes Newton's step at t and dz/dt.
fn steps(z: &Unknowns, along: &Segment, t: f64) -> (Unknowns, Unknowns) {
    let zero = DoubleComplex::default();
    let at = displaced(along, t);
    let kind = at.kind;
    let points = kind.points();
    let Displacements { delta, starred, .. } = at;
    let mut matrix = [[zero; ORDER]; ORDER];
    let mut right = [[zero; 2]; ORDER];
    let mut legs = [[[zero; LEG]; STEPS]; 2];
    let mut sides = [[[zero; 2]; STEPS]; 2];
    let mut turns = [[zero; STEPS]; 2];
    let mut given = [[zero; 2]; MOST_POSES];
    for j in 0..kind.places() {
        let tau = z[ORDER + j];
        let t = tau + real(1.0);
        let inverse = real(1.0) / t;
        let sigma = -(tau * inverse);
        for leg in 0..2 {
            let [x, u, x_s, u_s] = [0, 1, 2, 3].map(|i| z[LEG * leg + i]);
            let closure = if leg == 0 { Closure::FourBar } else { kind.closure };
            if closure == Closure::InvertedSliderCrank {
                let (b, b_s) = (x - u, x_s - u_s);
                let (n, n_s) = (b * sigma - delta[j].0 * inverse, b_s * tau - starred[j].0 * t);
                let (by_b, by_b_s) = (u_s * sigma, u * tau);
                legs[leg][j] = [by_b, n_s - by_b, by_b_s, n - by_b_s];
                turns[leg][j] = u * ((b_s - starred[j].0) * t) - u_s * ((b - delta[j].0) * inverse);
                sides[leg][j] = [-(u * n_s + u_s * n), u_s * inverse * delta[j].1 + u * t * starred[j].1];
                continue;
            }
            let (m, m_s) = (x * tau + delta[j].0, x_s * sigma + starred[j].0);
            let (l, r) = if closure == Closure::SliderCrank { (u, u_s) } else { (u + m, u_s + m_s) };
            legs[leg][j] = [tau * r, m_s, sigma * l, m];
            turns[leg][j] = x * t * r - x_s * inverse * l;
            sides[leg][j] = [-(u * m_s + m * r), -(r * delta[j].1 + l * starred[j].1)];
        }
        if let Some(pose) = j.checked_sub(points) {
            given[pose] = turned(t, delta[kind.turn(pose)], starred[kind.turn(pose)]);
            for leg in 0..2 {
                let row = points + 2 * pose + leg;
                matrix[row][LEG * leg..LEG * (leg + 1)].copy_from_slice(&legs[leg][j]);
                for side in 0..2 {
                    right[row][side] = sides[leg][j][side] - turns[leg][j] * (given[pose][side] * inverse);
                }
            }
            continue;
        }
        let (p, q) = (turns[1][j], -turns[0][j]);
        for i in 0..LEG {
            matrix[j][i] = p * legs[0][j][i];
            matrix[j][LEG + i] = q * legs[1][j][i];
        }
        for (right, (one, other)) in right[j].iter_mut().zip(sides[0][j].iter().zip(sides[1][j])) {
            *right = p * *one + q * other;
        }
    }
    for link in 0..kind.pivots {
        let entry = kind.places() + link;
        for (twin, given) in [delta[entry], starred[entry]].into_iter().enumerate() {
            let (row, first) = (points + 2 * (kind.poses + link) + twin, LEG * link + 2 * twin);
            (matrix[row][first], matrix[row][first + 1]) = (real(1.0), real(-1.0));
            right[row] = [given.0 - (z[first] - z[first + 1]), given.1];
        }
    }
    if kind.slides() {
        let (row, [v, v_s]) = (ORDER - 1, [LEG + 1, LEG + 3]);
        (matrix[row][v], matrix[row][v_s]) = (starred[row].0, delta[row].0);
        right[row] = [
            real(1.0) - (starred[row].0 * z[v] + delta[row].0 * z[v_s]),
            -(starred[row].1 * z[v] + delta[row].1 * z[v_s]),
        ];
    }
    eliminate(&mut matrix, &mut right);
    let answer = |side: usize| {
        let mut answer = [zero; UNKNOWNS];
        for i in 0..ORDER {
            answer[i] = right[i][side];
        }
        for j in kind.lengths()..STEPS {
            for own in kind.spare(j).map(|own| ORDER + own) {
                answer[own] = turned(z[own] + real(1.0), delta[j], starred[j])[side];
            }
        }
        for j in 0..points {
            let larger = usize::from(magnitude(turns[1][j]) > magnitude(turns[0][j]));
            let known = (0..LEG).map(|i| legs[larger][j][i] * right[LEG * larger + i][side]);
            let left = known.fold(sides[larger][j][side], |sum, term| sum - term);
            answer[ORDER + j] = (z[ORDER + j] + real(1.0)) * left / turns[larger][j];
        }
        answer
    };
    (answer(0), answer(1))
}

/// Computes Newton's change of the rotation T of a pose, above / below - T, and the one along the derivatives.
fn turned(
    t: DoubleComplex,
    above: (DoubleComplex, DoubleComplex),
    below: (DoubleComplex, DoubleComplex),
) -> [DoubleComplex; 2] {
    [above.0 / below.0 - t, (above.1 - t * below.1) / below.0]
}

fn magnitude(z: DoubleComplex) -> f64 {
    z.to_complex().norm_sqr()
}

/// Solves A x = b with row pivoting, rows weighted by their largest entries; x replaces b.
#[expect(clippy::needless_range_loop, reason = "indices follow the equations")]
fn eliminate(matrix: &mut [[DoubleComplex; ORDER]; ORDER], right: &mut [[DoubleComplex; 2]; ORDER]) {
    let mut weights = matrix.map(|row| row.into_iter().map(magnitude).fold(0.0, f64::max));
    for k in 0..ORDER {
        let size = |i: usize| magnitude(matrix[i][k]) / weights[i];
        let best = (k..ORDER).max_by(|&i, &j| size(i).total_cmp(&size(j))).unwrap_or(k);
        matrix.swap(k, best);
        right.swap(k, best);
        weights.swap(k, best);
        let inverse = real(1.0) / matrix[k][k];
        let (pivot, sides) = (matrix[k], right[k]);
        for i in k + 1..ORDER {
            let factor = matrix[i][k] * inverse;
            for j in k + 1..ORDER {
                matrix[i][j] = matrix[i][j] - factor * pivot[j];
            }
            for (right, side) in right[i].iter_mut().zip(sides) {
                *right = *right - factor * side;
            }
        }
    }
    for k in (0..ORDER).rev() {
        let inverse = real(1.0) / matrix[k][k];
        let row = matrix[k];
        for side in 0..2 {
            let left = (k + 1..ORDER).fold(right[k][side], |sum, j| sum - row[j] * right[j][side]);
            right[k][side] = left * inverse;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::start::StartSet;
    use crate::tracker::track;

    #[test]
    fn it_ends_where_the_tracker_in_doubles_does() {
        let set = StartSet::embedded(crate::target::Kind::default());
        let turned = |of: [Complex; STEPS], by: f64| of.map(|z| z * Complex::from_polar(1.1, by) + by);
        let to = Displacements {
            delta: turned(set.displacements.delta, 0.5),
            starred: turned(set.displacements.starred, -0.3),
            kind: crate::target::Kind::default(),
        };
        let along = Segment { from: set.displacements, to };
        let starts: Vec<Solution> = set.solutions.iter().step_by(200).copied().collect();
        let (with, cancel) = (Parameters::default(), AtomicBool::new(false));
        let ends = track(&starts, &along, &with, &cancel);
        for (start, end) in starts.iter().zip(&ends) {
            let followed = follow(start, &along, &with, &cancel);
            assert_eq!((followed.ending, end.ending), (Ending::Arrived, Ending::Arrived));
            assert!(followed.end.newton_step < 1e-20, "{:e}", followed.end.newton_step);
            assert!(followed.end.solution.is_in_class_of(&end.solution, Closure::FourBar, 1e-8));
        }
    }
}
