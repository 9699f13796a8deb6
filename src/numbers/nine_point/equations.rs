//! The sixteen equations, their derivatives, and the 8x8 system that is left when the rotations are eliminated.
//!
//! With u = x - a and tau = T - 1 in place of a and T, M = x tau + delta, sigma = 1 / T - 1 = -tau / T and
//! M* = x* sigma + delta* the equation of one leg at one point is
//!
//! ```text
//! f = (u + M)(u* + M*) - u u* = u M* + u* M + M M*
//! df/dx = tau R    df/du = M*    df/dx* = sigma L    df/du* = M        L = u + M,  R = u* + M*
//! p = df/dlog T = x T R - (x* / T) L      df/ddelta = R      df/ddelta* = L
//! ```
//!
//! No large terms cancel in this form: it serves links of ten thousand times the points' extent, whose u is large or
//! whose tau is small, as well as others.
//!
//! The T_j of a pose is given: both its rows stay as they are, with p times its own change on the right. A given pivot has
//! two rows, x - u = a and its twin. The second leg of a slider-crank has the same M and M*, and L = v, R = v* without them:
//! f = v M* + v* M. That of an inverted slider-crank (y slides in it, b = y - v) is, with N = b sigma - delta / T and
//! N* = b* tau - delta* T,
//!
//! ```text
//! f = v N* + v* N     df/db = sigma v*     df/db* = tau v     df/dv at fixed b = N*     df/dv* at fixed b* = N
//! p = v (b* - delta*) T - v* (b - delta) / T     df/ddelta = -v* / T     df/ddelta* = -v T
//! ```
//!
//! and the eighth row of both that of n* v + n v* = 1. The T_j of a
//! point occurs in two equations, one per leg, so that p_2 (row of leg 1) - p_1 (row of leg 2) is free of it: eight
//! rows in the eight pivots. dlog T_j follows from the leg with the larger |p|. The rows are scaled to a largest
//! entry of one before the elimination.

use super::target::{Closure, Displacements, MOST_POSES, STEPS, Solution};
use linkwright_arithmetic::Complex;
use linkwright_arithmetic::complex_lanes::{ComplexLanes, ORDER, larger, solve};
use linkwright_arithmetic::lane::{F64x8, Lane};
use std::ops::{Add, Sub};

/// The number of unknowns.
pub const UNKNOWNS: usize = ORDER + STEPS;
/// The number of unknowns of one leg: x, u, x*, u*.
pub(super) const LEG: usize = 4;

/// Sixteen numbers, eight paths each: [x, u, x*, u*, y, v, y*, v*, tau_1 .. tau_8] with u = x - a, v = y - b,
/// tau = T - 1, or their changes.
pub type Unknowns = [ComplexLanes; UNKNOWNS];

/// Returns the unknowns of a solution in the order of [`Unknowns`].
pub fn unknowns(of: &Solution) -> [Complex; UNKNOWNS] {
    let mut all = [Complex::default(); UNKNOWNS];
    for leg in 0..2 {
        all[LEG * leg..LEG * (leg + 1)].copy_from_slice(&[
            of.pins[leg],
            of.pins[leg] - of.grounds[leg],
            of.pins_starred[leg],
            of.pins_starred[leg] - of.grounds_starred[leg],
        ]);
    }
    all[ORDER..].copy_from_slice(&of.rotations.map(|t| t - 1.0));
    all
}

/// Returns the solution with these unknowns.
pub fn solution(of: &[Complex; UNKNOWNS]) -> Solution {
    rounded(of, |z| z)
}

/// Returns the solution with these unknowns, rounded after the ground pivots and the rotations have been computed.
pub(super) fn rounded<Z>(of: &[Z; UNKNOWNS], round: impl Fn(Z) -> Complex) -> Solution
where
    Z: Copy + Add<Output = Z> + Sub<Output = Z> + From<Complex>,
{
    let pins = |place: usize| [of[place], of[LEG + place]].map(&round);
    let grounds =
        |place: usize| [of[place] - of[place + 1], of[LEG + place] - of[LEG + place + 1]].map(&round);
    Solution {
        pins: pins(0),
        grounds: grounds(0),
        pins_starred: pins(2),
        grounds_starred: grounds(2),
        rotations: std::array::from_fn(|j| round(of[ORDER + j] + Complex::ONE.into())),
    }
}

/// Evaluates f of both legs at all points, in the units of the solution squared: `[leg][j]`.
pub fn residuals(of: &Solution, at: &Displacements) -> [[Complex; STEPS]; 2] {
    std::array::from_fn(|leg| {
        let (x, a) = (of.pins[leg], of.grounds[leg]);
        let (x_s, a_s) = (of.pins_starred[leg], of.grounds_starred[leg]);
        std::array::from_fn(|j| {
            let kind = at.kind;
            if kind.is_normal(j) && leg == 1 {
                return at.starred[j] * (x - a) + at.delta[j] * (x_s - a_s) - 1.0;
            }
            if j >= kind.lengths() {
                return of.rotations[kind.spare(j)[leg]] * at.starred[j] - at.delta[j];
            }
            if let Some(link) = j.checked_sub(kind.places()) {
                let pairs = [(of.grounds, at.delta), (of.grounds_starred, at.starred)];
                return pairs[leg].0[link] - pairs[leg].1[j];
            }
            let (t, v, v_s) = (of.rotations[j], x - a, x_s - a_s);
            if leg == 1 && kind.closure == Closure::SliderCrank {
                return v * (x_s * (t.inv() - 1.0) + at.starred[j]) + v_s * (x * (t - 1.0) + at.delta[j]);
            }
            if leg == 1 && kind.closure == Closure::InvertedSliderCrank {
                return v * ((a_s - at.starred[j]) * t - a_s) + v_s * ((a - at.delta[j]) / t - a);
            }
            (x * t + at.delta[j] - a) * (x_s / t + at.starred[j] - a_s) - (x - a) * (x_s - a_s)
        })
    })
}

/// The displacements of eight paths.
pub type DisplacementLanes = Displacements<ComplexLanes>;

/// The linearised equation of one leg at one point: f = value + row . d(leg) + p dlog T.
#[derive(Clone, Copy)]
struct Linearised {
    row: [ComplexLanes; LEG],
    p: ComplexLanes,
    value: ComplexLanes,
    by_delta: ComplexLanes,
    by_starred: ComplexLanes,
}

#[inline(always)]
fn linearised(
    z: &Unknowns,
    at: &DisplacementLanes,
    leg: usize,
    j: usize,
    inverse: ComplexLanes,
) -> Linearised {
    let [x, u, x_s, u_s] = [z[LEG * leg], z[LEG * leg + 1], z[LEG * leg + 2], z[LEG * leg + 3]];
    let tau = z[ORDER + j];
    let sigma = -tau * inverse;
    let closure = if leg == 0 { Closure::FourBar } else { at.kind.closure };
    if closure == Closure::InvertedSliderCrank {
        let t = tau + ComplexLanes::splat(Complex::ONE);
        let (b, b_s) = (x - u, x_s - u_s);
        let (n, n_s) = (b * sigma - at.delta[j] * inverse, b_s * tau - at.starred[j] * t);
        let (by_b, by_b_s) = (u_s * sigma, u * tau);
        return Linearised {
            row: [by_b, n_s - by_b, by_b_s, n - by_b_s],
            p: u * ((b_s - at.starred[j]) * t) - u_s * ((b - at.delta[j]) * inverse),
            value: u * n_s + u_s * n,
            by_delta: -(u_s * inverse),
            by_starred: -(u * t),
        };
    }
    let (m, m_s) = (x * tau + at.delta[j], x_s * sigma + at.starred[j]);
    let (l, r) = if closure == Closure::SliderCrank { (u, u_s) } else { (u + m, u_s + m_s) };
    Linearised {
        row: [tau * r, m_s, sigma * l, m],
        p: (x + x * tau) * r - (x_s * inverse) * l,
        value: u * m_s + m * r,
        by_delta: r,
        by_starred: l,
    }
}

/// Returns Newton's change of the rotation T of a pose, delta / starred - T, and with R = 2 the one along the velocity.
#[inline(always)]
fn turned<const R: usize>(
    t: ComplexLanes,
    at: &DisplacementLanes,
    velocity: &DisplacementLanes,
    place: usize,
) -> [ComplexLanes; R] {
    let below = at.starred[place].recip();
    let mut changes = [at.delta[place] * below - t; R];
    if R == 2 {
        changes[R - 1] = (velocity.delta[place] - t * velocity.starred[place]) * below;
    }
    changes
}

/// Returns |re| + |im|.
#[inline(always)]
fn size(z: ComplexLanes) -> F64x8 {
    larger(z.re, -z.re) + larger(z.im, -z.im)
}

/// Solves the linearised equations; the changes of tau_j are dT_j (not dlog T_j).
///
/// The first right-hand side is Newton's, -f. With R = 2 the second is Davidenko's, -(df/ddelta delta' + df/ddelta*
/// delta*') for the velocity given: its answer is dz/dt along the path on which the displacements move so. The
/// smallest pivot, squared, is returned as well.
#[expect(clippy::needless_range_loop, reason = "indices follow the equations and the lanes")]
#[inline(always)]
pub fn steps<const R: usize>(
    z: &Unknowns,
    at: &DisplacementLanes,
    velocity: &DisplacementLanes,
) -> ([Unknowns; R], F64x8) {
    let zero = ComplexLanes::ZERO;
    let mut matrix = [[zero; ORDER]; ORDER];
    let mut right = [[zero; R]; ORDER];
    let mut legs = [[[zero; LEG]; STEPS]; 2];
    let mut sides = [[[zero; R]; STEPS]; 2];
    let mut turns = [[zero; STEPS]; 2];
    let mut given = [[zero; R]; MOST_POSES];
    let kind = at.kind;
    let points = kind.points();
    for j in 0..kind.places() {
        let t = z[ORDER + j] + ComplexLanes::splat(Complex::ONE);
        let inverse = t.recip();
        for leg in 0..2 {
            let at_leg = linearised(z, at, leg, j, inverse);
            legs[leg][j] = at_leg.row;
            turns[leg][j] = at_leg.p;
            sides[leg][j][0] = -at_leg.value;
            if R == 2 {
                sides[leg][j][R - 1] =
                    -(at_leg.by_delta * velocity.delta[j] + at_leg.by_starred * velocity.starred[j]);
            }
        }
        if let Some(pose) = j.checked_sub(points) {
            given[pose] = turned::<R>(t, at, velocity, kind.turn(pose));
            for leg in 0..2 {
                let row = points + 2 * pose + leg;
                let largest = legs[leg][j].iter().map(|z| size(*z)).reduce(larger);
                let scale = largest.unwrap_or(F64x8::splat(1.0)).recip();
                for i in 0..LEG {
                    matrix[row][LEG * leg + i] = legs[leg][j][i].scale(scale);
                }
                for r in 0..R {
                    let by_turn = turns[leg][j] * (given[pose][r] * inverse);
                    right[row][r] = (sides[leg][j][r] - by_turn).scale(scale);
                }
            }
            continue;
        }
        let (p, q) = (turns[1][j], -turns[0][j]);
        let mut largest = F64x8::splat(0.0);
        for i in 0..LEG {
            matrix[j][i] = p * legs[0][j][i];
            matrix[j][LEG + i] = q * legs[1][j][i];
            largest = larger(largest, larger(size(matrix[j][i]), size(matrix[j][LEG + i])));
        }
        let scale = largest.recip();
        for i in 0..ORDER {
            matrix[j][i] = matrix[j][i].scale(scale);
        }
        for r in 0..R {
            right[j][r] = (p * sides[0][j][r] + q * sides[1][j][r]).scale(scale);
        }
    }
    for link in 0..kind.pivots {
        let entry = kind.places() + link;
        let given = [(at.delta, velocity.delta), (at.starred, velocity.starred)];
        for (twin, (given, moved)) in given.iter().enumerate() {
            let (row, first) = (points + 2 * (kind.poses + link) + twin, LEG * link + 2 * twin);
            let one = ComplexLanes::splat(Complex::ONE);
            (matrix[row][first], matrix[row][first + 1]) = (one, -one);
            right[row][0] = given[entry] - (z[first] - z[first + 1]);
            if R == 2 {
                right[row][R - 1] = moved[entry];
            }
        }
    }
    if kind.slides() {
        let (row, [v, v_s]) = (ORDER - 1, [LEG + 1, LEG + 3]);
        let of = |n_s: ComplexLanes, n: ComplexLanes| n_s * z[v] + n * z[v_s];
        (matrix[row][v], matrix[row][v_s]) = (at.starred[row], at.delta[row]);
        right[row][0] = ComplexLanes::splat(Complex::ONE) - of(at.starred[row], at.delta[row]);
        if R == 2 {
            right[row][R - 1] = -of(velocity.starred[row], velocity.delta[row]);
        }
    }
    let smallest = solve(&mut matrix, &mut right);
    let mut answer = [[zero; UNKNOWNS]; R];
    for (r, answer) in answer.iter_mut().enumerate() {
        for i in 0..ORDER {
            answer[i] = right[i][r];
        }
        for j in kind.lengths()..STEPS {
            for own in kind.spare(j).map(|own| ORDER + own) {
                let t = z[own] + ComplexLanes::splat(Complex::ONE);
                answer[own] = turned::<R>(t, at, velocity, j)[r];
            }
        }
        for j in 0..points {
            let mut left = [sides[0][j][r], sides[1][j][r]];
            for (leg, left) in left.iter_mut().enumerate() {
                for i in 0..LEG {
                    *left = *left - legs[leg][j][i] * right[LEG * leg + i][r];
                }
            }
            let (one, other) = (turns[0][j].norm_sq(), turns[1][j].norm_sq());
            let above = ComplexLanes::where_at_least(one, other, left[0], left[1]);
            let below = ComplexLanes::where_at_least(one, other, turns[0][j], turns[1][j]);
            let t = z[ORDER + j] + ComplexLanes::splat(Complex::ONE);
            answer[ORDER + j] = t * above * below.recip();
        }
    }
    (answer, smallest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::start::StartSet;
    use crate::target::Kind;
    use linkwright_arithmetic::streams::{Stream, stream, uniform};

    fn number(draws: &mut Stream) -> Complex {
        Complex::new(uniform(draws, -1.0, 1.0), uniform(draws, -1.0, 1.0))
    }

    /// Returns the largest residual, relative to the size of its leg's equation.
    fn off(of: &Solution, at: &Displacements) -> f64 {
        let pivots = [of.pins, of.grounds, of.pins_starred, of.grounds_starred];
        let turns = of.rotations.iter().map(|t| t.norm().max(t.inv().norm())).fold(1.0, f64::max);
        let all = residuals(of, at);
        let of_leg = |leg: usize| {
            let size = 1.0 + pivots.iter().map(|pair| pair[leg].norm_sqr()).sum::<f64>();
            all[leg].iter().map(|f| f.norm() / (size * turns)).fold(0.0, f64::max)
        };
        of_leg(0).max(of_leg(1))
    }

    #[test]
    fn newtons_step_and_the_tangent_are_those_of_the_residuals() {
        let h = 1e-5;
        let mut compared = 0;
        for kind in Kind::known() {
            let set = StartSet::embedded(kind);
            let mut draws = stream(6, kind.classes() as u64);
            for start in set.solutions.iter().take(20) {
                let exact = unknowns(start);
                let mut near = exact;
                near.iter_mut().for_each(|z| *z += number(&mut draws) * h);
                let velocity = Displacements {
                    delta: std::array::from_fn(|_| number(&mut draws)),
                    starred: std::array::from_fn(|_| number(&mut draws)),
                    kind,
                };
                let (at, moving) =
                    (set.displacements.map(ComplexLanes::splat), velocity.map(ComplexLanes::splat));
                let both =
                    |from: &[Complex; UNKNOWNS]| steps::<2>(&from.map(ComplexLanes::splat), &at, &moving).0;
                let moved = |from: &[Complex; UNKNOWNS], step: &Unknowns, by: f64| {
                    solution(&std::array::from_fn(|i| from[i] + step[i].get(0) * by))
                };
                let ([newton, _], [_, tangent]) = (both(&near), both(&exact));
                let size = tangent.iter().map(|z| z.get(0).norm_sqr()).sum::<f64>();
                // Steps that are short beside the solution's own distance from the next singular one.
                if size > 1e4 {
                    continue;
                }
                compared += 1;
                let (before, after) = (
                    off(&solution(&near), &set.displacements),
                    off(&moved(&near, &newton, 1.0), &set.displacements),
                );
                assert!(after < 1e-3 * before, "{kind:?}: {before:e} {after:e}");
                let there = set.displacements.zip(&velocity, |d, v| d + v * h);
                let (still, along) = (off(start, &there), off(&moved(&exact, &tangent, h), &there));
                assert!(along < 1e-2 * still, "{kind:?}: {still:e} {along:e}");
            }
        }
        assert!(compared > 100, "{compared}");
    }

    #[test]
    fn all_images_of_a_solution_solve_the_equations() {
        for kind in Kind::known() {
            let set = StartSet::embedded(kind);
            for solution in set.solutions.iter().take(50) {
                for image in solution.images(&set.displacements) {
                    let off = off(&image, &set.displacements);
                    assert!(off < 1e-9, "{kind:?}: {off:e}");
                    assert!(image.is_in_class_of(solution, kind.closure, 1e-7), "{kind:?}");
                }
            }
        }
    }
}
