//! Starts of linkages with a slider that generate a function: linear solutions of its pairs.
//!
//! From A, with the line along the x axis at the height h0, and with B on the x axis at the distance g, the closures are, at
//! the crank's angle phi = phi0 + delta and the output s = s0 + o, or psi = psi0 + o,
//!
//! ```text
//! place of a slider-crank's slider   s^2 = 2a s cos phi + 2a h0 sin phi + b^2 - a^2 - h0^2
//! place of an inverted one's block   s^2 = g^2 + a^2 - h^2 - 2 a g cos phi
//! angle of the block                 sin psi + (a/g) sin(phi - psi) + h/g = 0
//! ```
//!
//! At given offsets (phi0, s0 or psi0) each is linear in what is left. The offsets themselves follow from the equations with
//! both multiplied out, whose products are taken for unknowns of their own, or they are drawn. The place of a block depends on
//! a g and g^2 + a^2 - h^2 alone: h is drawn.

use super::starts::{Start, Target, log_uniform};
use crate::mechanism::{AssemblyMode, Complex, LinkageKind};
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use crate::synthesis::constants::sliders::{OFFSETS, SCALES, TURNS};
use crate::task::forms::slider::ends::best_transmitting;
use crate::task::forms::slider::limits::Limited;
use crate::task::forms::slider::output::Outputs;
use crate::task::forms::slider::shape::{Closure, FRAME, SliderShape};
use crate::task::ranges::Scales;
use crate::task::{AngleOffset, Output, Problem, Timing};
use nalgebra::{SMatrix, SVector, SymmetricEigen};
use std::f64::consts::{FRAC_PI_2, PI};

/// The range of drawn offsets of a place, and of the offset of a block, in ranges of the places.
const REACH: f64 = 3.0;

/// A pair: the crank's turn, the output in the sense of a sign, and the weight.
type Pair = (f64, f64, f64);

/// Returns the starts of a round for a function; in the `first` round also those whose offsets the pairs themselves suggest.
pub(super) fn output_starts(
    problem: &Problem,
    (target, outputs): (&Target, &Outputs),
    (kind, limits): (LinkageKind, &Limited),
    first: bool,
    stream: &mut Stream,
) -> Vec<Start> {
    let Timing::Prescribed { crank_angles, offset } = problem.task().timing() else { return Vec::new() };
    // A slider that moves the other way is the same linkage turned by half a turn, if the input has no reference.
    let signs = match (kind, offset) {
        (LinkageKind::SliderCrank, AngleOffset::Free) => &[1.0],
        _ => problem.directions(),
    };
    let is_free = [*offset == AngleOffset::Free, limits.bounds[FRAME].0 < limits.bounds[FRAME].1];
    let mut starts = Vec::new();
    let place = Placing::of(limits, kind, outputs.kind);
    let ranges = problem.task().ranges();
    let drawn_scales = if ranges.are_written() { 1 } else { SCALES };
    let scaled = |stream: &mut Stream| {
        ranges.bounds().map(|(low, high)| if low < high { log_uniform(stream, low, high) } else { low })
    };
    let at = signs.iter().flat_map(|sign| (0..drawn_scales).map(move |_| sign));
    for sign in at {
        let scales = scaled(stream);
        let [h, k] = scales;
        let given = crank_angles.iter().zip(&outputs.wanted).zip(&target.weights);
        let pairs: Vec<Pair> = given.map(|((delta, o), weight)| (h * delta, sign * k * o, *weight)).collect();
        if first
            && let Some(ends) = problem.spec().require.ends().filter(|_| kind == LinkageKind::SliderCrank)
        {
            for solution in of_ends(&pairs, ends, target.size) {
                starts.extend(place.start(kind, (*sign, scales), is_free, solution));
            }
        }
        let mut solve = |offsets: [f64; 2], stream: &mut Stream| {
            let solutions = match (outputs.kind, kind) {
                (Output::Place, LinkageKind::SliderCrank) => of_line(&pairs, offsets).into_iter().collect(),
                (Output::Place, _) => of_block(&pairs, offsets, stream),
                (Output::Angle, _) => of_angle(&pairs, offsets).into_iter().collect(),
            };
            starts
                .extend(solutions.into_iter().filter_map(|s| place.start(kind, (*sign, scales), is_free, s)));
        };
        if first && is_free == [true; 2] {
            let suggested = match (outputs.kind, kind) {
                (Output::Place, LinkageKind::SliderCrank) => offsets_of_line(&pairs),
                (Output::Place, _) => offsets_of_block(&pairs),
                (Output::Angle, _) => offsets_of_angle(&pairs),
            };
            suggested.into_iter().for_each(|offsets| solve(offsets, stream));
        }
        for _ in 0..OFFSETS / drawn_scales {
            let mut draw =
                |is_free: bool, reach: f64| if is_free { uniform(stream, -reach, reach) } else { 0.0 };
            let phi0 = draw(is_free[0], PI);
            let drawn = draw(is_free[1], if outputs.kind == Output::Place { REACH } else { PI });
            let of_line = outputs.kind == Output::Place && kind == LinkageKind::SliderCrank && is_free[1];
            let s0 = if of_line && below(stream, 2) == 0 { place_at(&pairs, phi0) } else { Some(drawn) };
            if let Some(s0) = s0 {
                solve([phi0, s0], stream);
            }
        }
    }
    starts
}

/// A solution from A, with the ground along the x axis.
#[derive(Clone, Copy, Debug)]
struct Solution {
    offsets: [f64; 2],
    shape: SliderShape,
    assembly: AssemblyMode,
}

/// The place of a solution: the pivot A, and the direction of the line or of the ground with the length of the latter, where
/// the bounds give them.
struct Placing {
    pivot: Complex,
    ground: Complex,
    is_ground_given: bool,
    output: Output,
}

impl Placing {
    fn of(limits: &Limited, kind: LinkageKind, output: Output) -> Placing {
        let middle = |k: usize| {
            let (low, high) = limits.bounds[k];
            if low.is_finite() && high.is_finite() { 0.5 * (low + high) } else { 0.0 }
        };
        let pivot = Complex::new(middle(0), middle(1));
        let ground = match kind {
            LinkageKind::SliderCrank => Complex::from_polar(1.0, middle(5)),
            _ => Complex::new(middle(3), middle(4)) - pivot,
        };
        let is_fixed = |k: usize| limits.bounds[k].0 == limits.bounds[k].1;
        let is_ground_given = kind == LinkageKind::InvertedSliderCrank && is_fixed(3) && is_fixed(4);
        Placing { pivot, ground, is_ground_given, output }
    }

    /// Returns the start at a solution; `None` if its numbers are of no use.
    fn start(
        &self,
        kind: LinkageKind,
        (sign, scales): (f64, Scales),
        [is_input_free, is_output_free]: [bool; 2],
        Solution { offsets: [phi0, beta], shape, assembly }: Solution,
    ) -> Option<Start> {
        let turn = self.ground / self.ground.norm();
        let own = match shape.closure {
            Closure::Block { pivot, .. } if self.is_ground_given => pivot.norm(),
            _ => 1.0,
        };
        let length = if self.is_ground_given { self.ground.norm() / own } else { 1.0 };
        let shape = shape.carried(turn * length, self.pivot);
        let mut x = shape.unknowns(if is_input_free { phi0 + turn.arg() } else { 0.0 }, 0.0);
        // A free angle counts from the x axis, that of the solution from the ground line.
        x[FRAME] = match (is_output_free, self.output) {
            (false, _) => 0.0,
            (true, Output::Angle) => -beta - turn.arg(),
            (true, Output::Place) => -beta,
        };
        let turns = shape.linkage(assembly).ok()?.mobility().input_turns_fully();
        let is_usable = x.iter().all(|x| x.is_finite());
        let positions = Vec::new();
        is_usable.then_some(Start { kind, x, positions, assembly, direction: sign, turns, scales })
    }
}

/// Returns the slider-crank with the offsets given.
fn of_line(pairs: &[Pair], [phi0, s0]: [f64; 2]) -> Option<Solution> {
    let row = |&(delta, o, weight): &Pair| {
        let (s, (sin, cos)) = (s0 + o, (phi0 + delta).sin_cos());
        ([s * cos, sin, 1.0], s * s, weight)
    };
    let [p, q, r] = solved(pairs.iter().map(row))?;
    let (crank, height) = (0.5 * p.abs(), q / p);
    // A negative crank is one that points the other way.
    let phi0 = if p < 0.0 { phi0 + PI } else { phi0 };
    let coupler_sq = r + crank * crank + height * height;
    if !(coupler_sq > 0.0 && crank > 0.0) {
        return None;
    }
    let along = |&(delta, o, weight): &Pair| weight * (s0 + o - crank * (phi0 + delta).cos()).signum();
    let assembly = AssemblyMode::of(pairs.iter().map(along).sum());
    let zero = Complex::new(0.0, 0.0);
    let closure = Closure::Line { coupler: coupler_sq.sqrt(), height, direction: Complex::new(1.0, 0.0) };
    Some(Solution {
        offsets: [phi0, s0],
        shape: SliderShape { crank_pivot: zero, crank, offset: zero, closure },
        assembly,
    })
}

/// Returns the slider-cranks with a stroke and a time ratio that transmit best, with their line on either side of A, at their
/// ends and at offsets of the crank all around.
fn of_ends(pairs: &[Pair], [stroke, ratio]: [f64; 2], size: f64) -> Vec<Solution> {
    let Some([crank, coupler, offset]) = best_transmitting([stroke / size, ratio]) else { return Vec::new() };
    let zero = Complex::new(0.0, 0.0);
    let mut solutions = Vec::new();
    for side in [1.0, -1.0] {
        let height = side * offset;
        let closure = Closure::Line { coupler, height, direction: Complex::new(1.0, 0.0) };
        let shape = SliderShape { crank_pivot: zero, crank, offset: zero, closure };
        let end = |reach: f64| (height / reach).asin();
        let around = (0..2 * TURNS).map(|k| PI * k as f64 / TURNS as f64);
        for phi0 in [end(coupler + crank), end(coupler - crank) + PI].into_iter().chain(around) {
            for assembly in [AssemblyMode::Plus, AssemblyMode::Minus] {
                // Seen from behind, the ends lie half a turn further.
                let phi0 = if assembly == AssemblyMode::Plus { phi0 } else { PI - phi0 };
                let place = |&(delta, o, weight): &Pair| {
                    let e = Complex::from_polar(1.0, phi0 + delta);
                    let u = shape.coupler_direction(e, assembly.sign())?;
                    Some([weight * ((e * crank + u * coupler).re - o), weight])
                };
                let Some(places) = pairs.iter().map(place).collect::<Option<Vec<_>>>() else { continue };
                let [moved, weight] = places.iter().fold([0.0; 2], |[x, w], [y, v]| [x + y, w + v]);
                solutions.push(Solution { offsets: [phi0, moved / weight], shape, assembly });
            }
        }
    }
    solutions
}

/// Returns inverted slider-cranks whose block has the places wanted, with the offsets given: crank and ground of drawn offsets
/// of the block, the shorter one and the longer one of both kinds.
fn of_block(pairs: &[Pair], [phi0, s0]: [f64; 2], stream: &mut Stream) -> Vec<Solution> {
    let row = |&(delta, o, weight): &Pair| ([1.0, (phi0 + delta).cos()], (s0 + o).powi(2), weight);
    let Some([n, m]) = solved(pairs.iter().map(row)) else { return Vec::new() };
    let phi0 = if m > 0.0 { phi0 + PI } else { phi0 };
    let product = 0.5 * m.abs();
    let least_sq = (2.0 * product - n).max(0.0);
    let drawn = uniform(stream, -REACH, REACH);
    let zero = Complex::new(0.0, 0.0);
    let mut solutions = Vec::new();
    for offset_sq in [least_sq, least_sq + drawn * drawn] {
        let sum_sq = n + offset_sq;
        let (sum, apart) = ((sum_sq + 2.0 * product).sqrt(), (sum_sq - 2.0 * product).max(0.0).sqrt());
        for apart in [apart, -apart] {
            let (ground, crank) = (0.5 * (sum + apart), 0.5 * (sum - apart));
            if !(crank > 0.0 && ground > 0.0) {
                continue;
            }
            let offset = offset_sq.sqrt() * if drawn < 0.0 { -1.0 } else { 1.0 };
            let closure = Closure::Block { pivot: Complex::new(ground, 0.0), offset };
            let shape = SliderShape { crank_pivot: zero, crank, offset: zero, closure };
            solutions.push(Solution { offsets: [phi0, s0], shape, assembly: AssemblyMode::Plus });
        }
    }
    solutions
}

/// Returns the inverted slider-crank whose block has the angles wanted, with the offsets given.
fn of_angle(pairs: &[Pair], [phi0, psi0]: [f64; 2]) -> Option<Solution> {
    let row = |&(delta, o, weight): &Pair| {
        let (phi, psi) = (phi0 + delta, psi0 + o);
        ([(phi - psi).sin(), 1.0], -psi.sin(), weight)
    };
    let [ratio, offset] = solved(pairs.iter().map(row))?;
    let (crank, phi0) = (ratio.abs(), if ratio < 0.0 { phi0 + PI } else { phi0 });
    // The coupler points to the block.
    let along = |&(delta, o, weight): &Pair| {
        let (phi, psi) = (phi0 + delta, psi0 + o);
        weight * (psi.cos() - crank * (phi - psi).cos()).signum()
    };
    let is_ahead = pairs.iter().map(along).sum::<f64>() >= 0.0;
    let (psi0, offset) = if is_ahead { (psi0, offset) } else { (psi0 + PI, -offset) };
    let zero = Complex::new(0.0, 0.0);
    let closure = Closure::Block { pivot: Complex::new(1.0, 0.0), offset };
    let shape = SliderShape { crank_pivot: zero, crank, offset: zero, closure };
    let solution = Solution { offsets: [phi0, psi0], shape, assembly: AssemblyMode::Plus };
    (crank > 0.0).then_some(solution)
}

/// Returns the offset of a slider-crank's places that goes with the crank's offset.
fn place_at(pairs: &[Pair], phi0: f64) -> Option<f64> {
    let row = |&(delta, o, weight): &Pair| {
        let (sin, cos) = (phi0 + delta).sin_cos();
        ([o, o * cos, cos, sin, 1.0], o * o, weight)
    };
    let [twice, ..] = solved(pairs.iter().map(row))?;
    Some(-0.5 * twice)
}

/// Returns the offsets of a slider-crank with all products of the closure taken for unknowns; those of its crank a twelfth of a
/// turn apart with fewer pairs.
fn offsets_of_line(pairs: &[Pair]) -> Vec<[f64; 2]> {
    let row = |&(delta, o, weight): &Pair| {
        let (sin, cos) = delta.sin_cos();
        ([o, o * cos, o * sin, cos, sin, 1.0], o * o, weight)
    };
    let of_all = if pairs.len() >= 6 { solved(pairs.iter().map(row)) } else { None };
    let mut offsets: Vec<[f64; 2]> =
        of_all.into_iter().map(|[twice, x, y, ..]| [(-y).atan2(x), -0.5 * twice]).collect();
    let around = (0..TURNS).map(|k| FRAC_PI_2 + PI * k as f64 / TURNS as f64);
    offsets.extend(around.filter_map(|phi0| Some([phi0, place_at(pairs, phi0)?])));
    offsets
}

/// Returns the offsets of an inverted slider-crank for the places of its block.
fn offsets_of_block(pairs: &[Pair]) -> Vec<[f64; 2]> {
    let row = |&(delta, o, weight): &Pair| {
        let (sin, cos) = delta.sin_cos();
        ([o, cos, sin, 1.0], o * o, weight)
    };
    let found = solved(pairs.iter().map(row));
    found.into_iter().map(|[twice, x, y, _]| [y.atan2(-x), -0.5 * twice]).collect()
}

/// Returns the offsets of an inverted slider-crank for the angles of its block: the vector that all pairs are orthogonal to.
fn offsets_of_angle(pairs: &[Pair]) -> Vec<[f64; 2]> {
    let mut matrix = SMatrix::<f64, 5, 5>::zeros();
    for &(delta, o, weight) in pairs {
        let ((s1, c1), (s2, c2)) = (o.sin_cos(), (delta - o).sin_cos());
        let row = SVector::from([c1, s1, c2, s2, 1.0]);
        matrix += row * row.transpose() * weight;
    }
    let eigen = SymmetricEigen::new(matrix);
    let least = eigen.eigenvalues.imin();
    let v = eigen.eigenvectors.column(least);
    let psi0 = v[0].atan2(v[1]);
    let phi0 = psi0 + v[2].atan2(v[3]);
    if phi0.is_finite() { vec![[phi0, psi0]] } else { Vec::new() }
}

/// Returns the weighted least-squares solution of linear equations; `None` if they do not determine it.
fn solved<const K: usize>(rows: impl Iterator<Item = ([f64; K], f64, f64)>) -> Option<[f64; K]> {
    let (mut matrix, mut right) = (SMatrix::<f64, K, K>::zeros(), SVector::<f64, K>::zeros());
    for (row, value, weight) in rows {
        let row = SVector::from(row);
        matrix += row * row.transpose() * weight;
        right += row * (value * weight);
    }
    let found = matrix.cholesky()?.solve(&right);
    found.iter().all(|x| x.is_finite()).then(|| found.into())
}
