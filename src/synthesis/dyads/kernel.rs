//! RR dyads through five poses, and near dyads of more, from the kernel of one linear row a pose.
//!
//! |P + Q m - G|^2 = R^2 is linear in eight real numbers q = (q0, q1, m q0, G q0, conj(m) G q0) with
//! q1/q0 = (|m|^2 + |G|^2 - R^2)/2:
//!
//! ```text
//! |P|^2/2 q0 + q1 + Re(conj(P) Q q23) - Re(conj(P) q45) - Re(conj(Q) q67) = 0
//! q0 q67 = conj(q23) q45                                  (one complex relation)
//! ```
//!
//! Five rows leave a kernel of three dimensions, q = N x, in which the relation's real and imaginary parts are two conics:
//! four common points, of which 0, 2 or 4 are real. More rows have no kernel, and their three smallest singular
//! directions serve in its place.

use super::circle::circle_fit;
use super::conics::Conics;
use super::scale::Scale;
use crate::mechanism::{Complex, Dyad, Pose, dot};
use crate::numbers::arithmetic::streams::{Stream, below};
use nalgebra::{DMatrix, Matrix3, Matrix4, SMatrix, Vector3, Vector4};

/// The rows' numbers, a pose each, padded to eight rows.
type Rows = SMatrix<f64, 8, 8>;

/// Three directions in the space of q, as columns.
type Directions = SMatrix<f64, 8, 3>;

/// Least ratio of the fifth singular value to the first: below it the poses are fewer than five different ones, or those of
/// a pure turn or shift, and infinitely many dyads meet them.
const RANK: f64 = 1e-13;

/// Greatest distance from pose 0's circle, in parts of size and length, of a dyad that meets five poses.
const EXACT: f64 = 1e-10;

/// Greatest link, in sizes: a longer one is a slider to the rounding of its circle.
const LONGEST: f64 = 1e6;

/// Dyads whose pins and pivots are nearer than this, in parts of size and reach, are the same one.
const SAME: f64 = 1e-6;

/// Steps of Newton's iteration on the four differences of squared distances.
const STEPS: usize = 12;

/// Returns all real RR dyads through five poses, in no particular order: 0, 2 or 4, and fewer where two coincide or one
/// is a slider. Links longer than a million sizes count as sliders, and sliders are left out.
///
/// If infinitely many dyads meet the poses (equal ones among them, equal angles at all of them, turning about one point),
/// there are none.
pub fn through_five(poses: &[Pose; 5]) -> Vec<Dyad> {
    let Some(scale) = Scale::of(poses) else { return Vec::new() };
    let found = through_rows(&poses.map(|pose| scale.pose(&pose)), None);
    found.into_iter().map(|dyad| scale.back(dyad)).collect()
}

/// A line on which the pivot lies: a place of it, and its normal of length 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub place: Complex,
    pub normal: Complex,
}

impl Line {
    /// Returns its linear row: <n, q45> - h q0 = 0.
    fn row(&self) -> [f64; 8] {
        [-dot(self.normal, self.place), 0.0, 0.0, 0.0, self.normal.re, self.normal.im, 0.0, 0.0]
    }
}

/// Returns the real RR dyads through five poses of size one, or through four whose pivot lies on a line.
pub(super) fn through_rows(poses: &[Pose], line: Option<Line>) -> Vec<Dyad> {
    let mut found: Vec<Dyad> = Vec::new();
    let rows: Vec<[f64; 8]> = poses.iter().map(row).chain(line.map(|line| line.row())).collect();
    let Some(directions) = smallest_directions(&rows) else { return found };
    let Some(conics) = conics_of(&directions) else { return found };
    let in_charts = (0..Conics::charts()).flat_map(|chart| conics.in_chart(chart));
    let beside = conics.beside_line(directions.row(0).transpose());
    for point in in_charts.chain(beside).filter_map(|x| conics.common_point(x)) {
        let Some([pin, pivot]) = pin_and_pivot(&directions, &point) else { continue };
        let Some(dyad) = met_exactly(poses, line, [pin, pivot]) else { continue };
        if !found.iter().any(|other| is_same(other, &dyad)) {
            found.push(dyad);
        }
    }
    found
}

/// Returns up to four RR dyads near to five poses or more: the pins from the three smallest singular directions of the
/// poses' rows, each with its best circle. A pair of conjugate pins gives its real part.
///
/// None for fewer than five poses, and for those of [`through_five`] that have infinitely many dyads.
pub fn nearest_in_kernel(poses: &[Pose]) -> Vec<Dyad> {
    near_dyads(poses).unwrap_or_default()
}

fn near_dyads(poses: &[Pose]) -> Option<Vec<Dyad>> {
    let scale = Scale::of(poses).filter(|_| poses.len() >= 5)?;
    let scaled = scale.poses(poses);
    let rows: Vec<[f64; 8]> = scaled.iter().map(row).collect();
    let directions = smallest_directions(&rows)?;
    let conics = conics_of(&directions)?;
    let points = conics.in_chart(0).into_iter().map(|x| conics.common_point(x).unwrap_or(x));
    let mut found: Vec<Dyad> = Vec::new();
    for [pin, _] in points.filter_map(|x| pin_and_pivot(&directions, &x)) {
        let Some(fit) = circle_fit(&scaled, pin, None) else { continue };
        let dyad = fit.dyad(pin);
        if fit.length < LONGEST && !found.iter().any(|other| is_same(other, &dyad)) {
            found.push(dyad);
        }
    }
    Some(found.into_iter().map(|dyad| scale.back(dyad)).collect())
}

/// Returns the real RR dyads through five poses drawn from many; none for fewer than five.
pub fn through_random_five(poses: &[Pose], stream: &mut Stream) -> Vec<Dyad> {
    if poses.len() < 5 {
        return Vec::new();
    }
    let mut order: Vec<usize> = (0..poses.len()).collect();
    for k in 0..5 {
        let other = k + below(stream, order.len() - k);
        order.swap(k, other);
    }
    // In the order of the poses, so that one set has one list of dyads however it was drawn.
    order[..5].sort_unstable();
    through_five(&std::array::from_fn(|k| poses[order[k]]))
}

/// Returns the linear row of a pose.
fn row(pose: &Pose) -> [f64; 8] {
    let (p, q) = (pose.position, pose.direction);
    let turned = p.conj() * q;
    [0.5 * p.norm_sqr(), 1.0, turned.re, -turned.im, -p.re, -p.im, -q.re, -q.im]
}

/// Returns the three smallest singular directions of rows; `None` if there are more than three that vanish.
fn smallest_directions(given: &[[f64; 8]]) -> Option<Directions> {
    let mut rows = Rows::zeros();
    if given.len() <= 8 {
        given.iter().enumerate().for_each(|(j, row)| rows.set_row(j, &(*row).into()));
    } else {
        // The triangular factor has the singular values and directions of the whole.
        let all = DMatrix::from_row_iterator(given.len(), 8, given.iter().flatten().copied());
        rows.copy_from(&all.qr().r());
    }
    let svd = rows.try_svd(false, true, f64::EPSILON, 10_000)?;
    let axes = svd.v_t?;
    let mut order: [usize; 8] = std::array::from_fn(|k| k);
    order.sort_by(|&i, &k| svd.singular_values[k].total_cmp(&svd.singular_values[i]));
    let directions = Directions::from_fn(|i, column| axes[(order[5 + column], i)]);
    let [largest, fifth] = [order[0], order[4]].map(|k| svd.singular_values[k]);
    (fifth > RANK * largest && directions.iter().all(|x| x.is_finite())).then_some(directions)
}

/// Returns the complex number at two rows of a column.
fn complex(directions: &Directions, row: usize, column: usize) -> Complex {
    Complex::new(directions[(row, column)], directions[(row + 1, column)])
}

/// Returns the relation q0 q67 - conj(q23) q45 in the directions: its real and imaginary parts.
fn conics_of(directions: &Directions) -> Option<Conics> {
    let relation = |i: usize, k: usize| {
        directions[(0, i)] * complex(directions, 6, k)
            - complex(directions, 2, i).conj() * complex(directions, 4, k)
    };
    let both = |i: usize, k: usize| (relation(i, k) + relation(k, i)) * 0.5;
    Conics::new([Matrix3::from_fn(|i, k| both(i, k).re), Matrix3::from_fn(|i, k| both(i, k).im)])
}

/// Returns m and G of a point of the directions; `None` if q0 is zero beside the rest.
fn pin_and_pivot(directions: &Directions, point: &Vector3<f64>) -> Option<[Complex; 2]> {
    let q = directions * point;
    let pin = Complex::new(q[2], q[3]) / q[0];
    let pivot = Complex::new(q[4], q[5]) / q[0];
    (pin.norm() + pivot.norm() < LONGEST).then_some([pin, pivot])
}

/// Returns whether two RR dyads of poses of size one are the same.
fn is_same(one: &Dyad, other: &Dyad) -> bool {
    match (one, other) {
        (Dyad::RR { pin: m1, pivot: g1, .. }, Dyad::RR { pin: m2, pivot: g2, .. }) => {
            (m1 - m2).norm() + (g1 - g2).norm() < SAME * (1.0 + m1.norm() + g1.norm())
        }
        _ => one == other,
    }
}

/// Returns the dyad that Newton's iteration reaches from a pin and a pivot, if it meets the poses, of size one. The line of the
/// pivot is linear, and met after one step.
fn met_exactly(poses: &[Pose], line: Option<Line>, from: [Complex; 2]) -> Option<Dyad> {
    let [pin, pivot] = newton(poses, line, from);
    let distances = poses.iter().map(|pose| (pose.at(pin) - pivot).norm());
    let length = distances.sum::<f64>() / poses.len() as f64;
    let dyad = Dyad::RR { pin, pivot, length };
    let meets = dyad.largest_residual(poses) <= EXACT * (1.0 + length);
    // A pin that rests on the pivot at all poses is a pure turn to the rounding.
    (meets && length < LONGEST && length > EXACT).then_some(dyad)
}

/// Solves |X_j - G|^2 = |X_0 - G|^2, X_j = P_j + Q_j m, j = 1, 2 .., and the line of the pivot where there is one, four
/// equations, by Newton's iteration, while the differences fall.
///
/// The difference is <X_j - X_0, X_j + X_0 - 2 G>, which does not cancel for pivots far away.
fn newton(poses: &[Pose], line: Option<Line>, from: [Complex; 2]) -> [Complex; 2] {
    let system = |[pin, pivot]: [Complex; 2]| {
        let place = |j: usize| poses[j].at(pin);
        let (mut slopes, mut value) = (Matrix4::zeros(), Vector4::zeros());
        for j in 1..poses.len() {
            let apart = place(j) - place(0);
            let middle = place(j) + place(0) - pivot * 2.0;
            let (here, first) = (poses[j].direction, poses[0].direction);
            let by_pin = (here - first).conj() * middle + (here + first).conj() * apart;
            slopes.set_row(j - 1, &[by_pin.re, by_pin.im, -2.0 * apart.re, -2.0 * apart.im].into());
            value[j - 1] = dot(apart, middle);
        }
        if let Some(Line { place, normal }) = line {
            slopes.set_row(3, &[0.0, 0.0, normal.re, normal.im].into());
            value[3] = dot(normal, pivot - place);
        }
        (slopes, value)
    };
    let mut best = from;
    let (mut slopes, mut value) = system(best);
    for _ in 0..STEPS {
        let Some(step) = slopes.lu().solve(&value) else { break };
        let next = [best[0] - Complex::new(step[0], step[1]), best[1] - Complex::new(step[2], step[3])];
        let there = system(next);
        let falls = there.1.amax() < value.amax();
        if !falls {
            break;
        }
        best = next;
        (slopes, value) = there;
    }
    best
}
