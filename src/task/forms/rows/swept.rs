//! The joints over a motion with their extremes and derivatives, for the rows of the footprint.

use super::{Motion, Place, Side};
use crate::mechanism::four_bar::gradient::{Frame, shape_gradient};
use crate::mechanism::{AssemblyMode, Complex, FourBar};
use crate::task::forms::design_space::{SHAPE, Shape, unit};

/// The joints over a motion, without allocation.
#[expect(clippy::large_enum_variant, reason = "one at a time, on the stack, so that nothing is allocated")]
pub(super) enum Swept<'a> {
    Samples {
        linkage: FourBar,
        assembly: AssemblyMode,
        step: f64,
        found: usize,
        at: [SweptPosition; SAMPLES + 1],
    },
    Points {
        shape: &'a Shape,
        positions: &'a [[Complex; 2]],
    },
}

/// Number of samples of an interval from which parabolas through neighbours find its extremes.
const SAMPLES: usize = 96;

/// A position of the motion.
#[derive(Clone, Copy)]
pub(super) struct SweptPosition {
    pub(super) place: Place,
    angle: f64,
    frame: Frame,
    /// C, D, P.
    pub(super) joints: [Complex; 3],
}

impl<'a> Swept<'a> {
    /// Returns the joints over a motion; `None` if the shape is no linkage.
    pub(super) fn of(shape: &'a Shape, motion: &Motion<'a>) -> Option<Swept<'a>> {
        match *motion {
            Motion::Positions(positions) => Some(Swept::Points { shape, positions }),
            Motion::Stretch(from, to, assembly) => {
                let linkage = shape.linkage(assembly).ok()?;
                let step = (to - from) / SAMPLES as f64;
                let zero = Complex::new(0.0, 0.0);
                let nowhere = SweptPosition {
                    place: Place::Anywhere,
                    angle: 0.0,
                    frame: Frame { crank: zero, coupler: zero, follower: zero },
                    joints: [zero; 3],
                };
                let (mut at, mut found) = ([nowhere; SAMPLES + 1], 0);
                for i in 0..=SAMPLES {
                    if let Some(mut position) = SweptPosition::at(&linkage, assembly, from + step * i as f64)
                    {
                        position.place = match i {
                            0 => Place::First,
                            SAMPLES => Place::Last,
                            _ => Place::Anywhere,
                        };
                        at[found] = position;
                        found += 1;
                    }
                }
                Some(Swept::Samples { linkage, assembly, step, found, at })
            }
        }
    }

    /// Returns the position at which a joint (C, D, P) comes nearest to a side of a box around all positions; `None` if
    /// the loop closes nowhere.
    pub(super) fn extreme(&self, joint: usize, side: Side) -> Option<SweptPosition> {
        let value = |p: &SweptPosition| side.inwards(p.joints[joint]);
        match self {
            Swept::Points { shape, positions } => positions
                .iter()
                .enumerate()
                .map(|(j, p)| SweptPosition::of_directions(shape, p, Place::Position(j)))
                .min_by(|p, q| value(p).total_cmp(&value(q))),
            Swept::Samples { linkage, assembly, step, found, at } => {
                let at = &at[..*found];
                let mut best = *at.iter().min_by(|p, q| value(p).total_cmp(&value(q)))?;
                let (low, high) = (at[0].angle, at[*found - 1].angle);
                let mut step = step.abs();
                for _ in 0..4 {
                    let at = |angle: f64| SweptPosition::at(linkage, *assembly, angle.clamp(low, high));
                    let (Some(before), Some(after)) = (at(best.angle - step), at(best.angle + step)) else {
                        break;
                    };
                    let (l, m, r) = (value(&before), value(&best), value(&after));
                    let curvature = l - 2.0 * m + r;
                    let shift =
                        if curvature > 0.0 { (0.5 * (l - r) / curvature).clamp(-1.0, 1.0) } else { 0.0 };
                    for candidate in
                        [Some(before), Some(after), at(best.angle + shift * step)].into_iter().flatten()
                    {
                        if value(&candidate) < value(&best) {
                            best = candidate;
                        }
                    }
                    step *= 0.1;
                }
                Some(best)
            }
        }
    }
}

impl SweptPosition {
    fn of_directions(shape: &Shape, [crank, coupler]: &[Complex; 2], place: Place) -> SweptPosition {
        let c = shape.crank_pivot + crank * shape.crank;
        let d = c + coupler * shape.coupler;
        SweptPosition {
            place,
            angle: crank.arg(),
            frame: Frame { crank: *crank, coupler: *coupler, follower: unit(d - shape.follower_pivot) },
            joints: [c, d, c + coupler * shape.offset],
        }
    }

    fn at(linkage: &FourBar, assembly: AssemblyMode, angle: f64) -> Option<SweptPosition> {
        let frame = linkage.frame(angle, assembly)?;
        Some(SweptPosition { place: Place::Anywhere, angle, frame, joints: linkage.joints_of(&frame) })
    }

    /// Returns the derivative of a joint's coordinate inwards from a side, by the shape and by the crank angle.
    pub(super) fn derivative(&self, shape: &Shape, joint: usize, side: Side) -> ([f64; SHAPE], f64) {
        // C is the coupler point at offset 0, D the one at offset b (which grows with b).
        let offset = match joint {
            0 => Complex::new(0.0, 0.0),
            1 => Complex::new(shape.coupler, 0.0),
            _ => shape.offset,
        };
        let Some(gradient) = shape_gradient(&self.frame, shape.crank, shape.coupler, offset) else {
            return ([0.0; SHAPE], 0.0);
        };
        let mut row = gradient.shape.map(|z| side.inwards(z));
        match joint {
            0 => (row[7], row[8]) = (0.0, 0.0),
            1 => {
                row[5] += row[7];
                (row[7], row[8]) = (0.0, 0.0);
            }
            _ => {}
        }
        (row, side.inwards(gradient.crank_angle))
    }
}
