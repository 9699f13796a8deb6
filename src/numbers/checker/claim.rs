//! The claim that a box is checked for, and linear functionals of the directions u over a box.

use super::frame::{Complex, Frame, conjugate, times, turn};
use super::interval::Interval;
use super::model::{Model, Sum, UP};
use linkwright_leaves::{Axis, Class, Line};

/// A claim about one class in one direction: no linkage with |Z| <= cap has a sum of squares below `claim`.
#[derive(Clone, Debug)]
pub struct Claim {
    pub(super) class: Class,
    pub(super) turns: Vec<[Interval; 2]>,
    pub(super) whole: Frame,
    /// The frames of all points but one; `None` if the others are too much alike.
    pub(super) fewer: Vec<Option<Frame>>,
    pub(super) cap: f64,
    pub(super) claim: f64,
    /// The known pivots, directions and limits if crank angles are from the x axis.
    pub(super) axis: Option<Axis>,
}

/// The direction u at a point, with bounds of the sizes of its parts.
pub(super) struct Direction {
    pub(super) u: [Model; 2],
    pub(super) size: [f64; 2],
}

impl Claim {
    /// Creates the claim; `None` if the target's figures are too much alike to bound anything.
    pub fn new(
        class: Class,
        direction: f64,
        points: &[[f64; 2]],
        turns_deg: &[f64],
        cap: f64,
        claim: f64,
    ) -> Option<Self> {
        let points: Vec<Complex> = points.iter().map(|p| p.map(Interval::exact)).collect();
        let turns = turns_deg.iter().map(|deg| turn(*deg, direction)).collect();
        Claim::of(class, points, turns, cap, claim, None)
    }

    /// Creates the claim for crank angles from the x axis; `None` as in [`Claim::new`].
    pub fn on_axis(
        class: Class,
        points: &[[f64; 2]],
        angles_deg: &[f64],
        cap: f64,
        claim: f64,
        axis: &Axis,
    ) -> Option<Self> {
        let [a_x, a_y] = axis.pivot.unwrap_or_default().map(Interval::exact);
        let from_pivot = |p: &[f64; 2]| [Interval::exact(p[0]) - a_x, Interval::exact(p[1]) - a_y];
        let back = match &axis.line {
            None => [Interval::exact(1.0), Interval::exact(0.0)],
            Some(Line::Angle(angle)) => conjugate(turn(*angle, 1.0)),
            Some(Line::To(b)) => {
                let [x, y] = from_pivot(b);
                let length = (x.square() + y.square()).root();
                [x.over(length), -y.over(length)]
            }
        };
        let points = points.iter().map(|p| times(from_pivot(p), back)).collect();
        let turns = angles_deg.iter().map(|deg| times(turn(*deg, 1.0), back)).collect();
        Claim::of(class, points, turns, cap, claim, Some(*axis))
    }

    fn of(
        class: Class,
        points: Vec<Complex>,
        turns: Vec<Complex>,
        cap: f64,
        claim: f64,
        axis: Option<Axis>,
    ) -> Option<Self> {
        let all: Vec<usize> = (0..points.len()).collect();
        let at_origin = axis.is_some_and(|axis| axis.pivot.is_some());
        let whole = Frame::new(&points, &turns, all.clone(), at_origin)?;
        let but = |j: usize| all.iter().copied().filter(|i| *i != j).collect();
        let fewer = all.iter().map(|j| Frame::new(&points, &turns, but(*j), at_origin)).collect();
        Some(Claim { class, turns, whole, fewer, cap, claim, axis })
    }
}

/// Computes the inner product <b, v> = sum conj(b) v.
fn product(b: &[[f64; 2]], v: &[[f64; 2]]) -> [f64; 2] {
    b.iter()
        .zip(v)
        .fold([0.0; 2], |[re, im], (b, v)| [re + b[0] * v[0] + b[1] * v[1], im + b[0] * v[1] - b[1] * v[0]])
}

/// Returns a bound of the share of <y, u> that is due to the parts of y along the frame's exact directions.
pub(super) fn witness_slack(frame: &Frame, y: &[[f64; 2]]) -> f64 {
    let n = y.len() as f64;
    // <b, y> with its rounding and that of b; |<b, u>| <= sqrt n.
    let rounding = (2.0 * n + 4.0) * f64::EPSILON;
    let along = |b: &Vec<[f64; 2]>| {
        let [re, im] = product(b, y);
        re.abs() + im.abs() + rounding + 1.01 * frame.error
    };
    frame.basis.iter().map(along).sum::<f64>() * n.sqrt() * UP * UP
}

/// Returns the witness y: u in the middle of the box, projected off the frame's directions and scaled to length 1.
/// Any vector would be valid.
pub(super) fn witness(frame: &Frame, at: &[&Option<Direction>]) -> Vec<[f64; 2]> {
    let mut y: Vec<[f64; 2]> =
        at.iter().map(|d| d.as_ref().map_or([0.0; 2], |d| [d.u[0].middle(), d.u[1].middle()])).collect();
    for _ in 0..2 {
        for b in &frame.basis {
            let [re, im] = product(b, &y);
            for (b, y) in b.iter().zip(&mut y) {
                *y = [y[0] - (b[0] * re - b[1] * im), y[1] - (b[0] * im + b[1] * re)];
            }
        }
        let length = y.iter().flatten().map(|y| y * y).sum::<f64>().sqrt();
        let scale = if length > 0.0 { 1.0 / length } else { 0.0 };
        for y in &mut y {
            *y = [y[0] * scale, y[1] * scale];
        }
    }
    y
}

/// Encloses the real and the imaginary part of <v, u> over the box.
pub(super) fn functional(v: &[[f64; 2]], at: &[&Option<Direction>], slack: f64) -> [Model; 2] {
    let (mut re, mut im) = (Sum::EMPTY, Sum::EMPTY);
    for (v, direction) in v.iter().zip(at) {
        match direction {
            Some(Direction { u, size }) => {
                re.add(v[0], &u[0], size[0]);
                re.add(v[1], &u[1], size[1]);
                im.add(v[0], &u[1], size[1]);
                im.add(-v[1], &u[0], size[0]);
            }
            None => {
                let size = (v[0] * v[0] + v[1] * v[1]).sqrt() * UP;
                re.add_unknown(size);
                im.add_unknown(size);
            }
        }
    }
    [re.model(slack), im.model(slack)]
}
