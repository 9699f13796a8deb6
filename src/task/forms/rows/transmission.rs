//! Rows of the transmission angle, cos mu = (b^2 + c^2 - s^2)/(2 b c) at the extremes of the diagonal s = |CB|.

use super::{At, Motion, Place, Row, RowKind, Turn};
use crate::mechanism::four_bar::mobility::linkage_type;
use crate::mechanism::{Complex, LinkageType, dot, length, turned, unit_vector};
use crate::task::forms::design_space::SHAPE;
use crate::task::requirement::RequirementKind;
use crate::task::spec::TransmissionOver;
use std::f64::consts::PI;

/// The margin aimed at inside angle limits, radians.
const ANGLE_MARGIN: f64 = 1e-9;

/// Adds the rows of the transmission angle, at the diagonals at which it is extreme: s^2 with its derivatives.
pub(super) fn rows(at: &At<'_>, each: &mut dyn FnMut(&Row)) {
    let Some(least) = at.require.transmission_deg_min.map(f64::to_radians) else { return };
    let limit = least + ANGLE_MARGIN;
    let (size, shape, motion, g) = (at.size, at.shape, at.motion, at.ground);
    let by_room = size * least.sin() * 1f64.to_radians();
    let kind = RowKind::Limit { of: RequirementKind::Transmission, side: None, by_room };
    let links = at.links;
    let [ground, a, b, c] = links;
    let turns = linkage_type(links).is_some_and(LinkageType::input_turns_fully);
    let over = at.require.transmission_over.unwrap_or(if turns {
        TransmissionOver::Cycle
    } else {
        TransmissionOver::Used
    });
    // (s, ds by ground and a, or by the shape at a crank angle, that angle)
    let aligned = |sign: f64| {
        let s = ground + sign * a;
        let mut row = [0.0; SHAPE];
        let flip = s.signum();
        (row[0], row[1], row[2], row[3]) = (-g.re * flip, -g.im * flip, g.re * flip, g.im * flip);
        row[4] = sign * flip;
        (s.abs(), row, 0.0, Place::Anywhere)
    };
    let at = |crank: Complex, place: Place| {
        let v = shape.follower_pivot - shape.crank_pivot - crank * a;
        let along = unit_vector(v);
        let mut row = [0.0; SHAPE];
        (row[0], row[1], row[2], row[3]) = (-along.re, -along.im, along.re, along.im);
        row[4] = -dot(along, crank);
        (length(v), row, -dot(along, turned(crank)) * a, place)
    };
    let extremes = match (over, motion) {
        (TransmissionOver::Cycle, _) => [aligned(-1.0), aligned(1.0)],
        (TransmissionOver::Used, Motion::Positions(positions)) => {
            let mut found = [at(positions[0][0], Place::Position(0)); 2];
            for (j, p) in positions.iter().enumerate() {
                let s = at(p[0], Place::Position(j));
                if s.0 < found[0].0 {
                    found[0] = s;
                }
                if s.0 > found[1].0 {
                    found[1] = s;
                }
            }
            found
        }
        (TransmissionOver::Used, Motion::Stretch(from, to, _)) => {
            let (low, high) = (from.min(*to), from.max(*to));
            let (first, last) = (
                at(Complex::from_polar(1.0, low), Place::First),
                at(Complex::from_polar(1.0, high), Place::Last),
            );
            let (mut least, mut greatest) = if first.0 < last.0 { (first, last) } else { (last, first) };
            let holds = |angle: f64| (angle - low).rem_euclid(2.0 * PI) <= high - low;
            if holds(g.arg()) {
                least = aligned(-1.0);
            }
            if holds(g.arg() + PI) {
                greatest = aligned(1.0);
            }
            [least, greatest]
        }
    };
    for (sign, (s, by, by_crank, place)) in [1.0, -1.0].into_iter().zip(extremes) {
        // least s: cos mu <= cos limit; greatest s: cos mu >= -cos limit
        let cos = (b * b + c * c - s * s) / (2.0 * b * c);
        let mut row = Row {
            kind,
            value: size * (limit.cos() - sign * cos),
            shape: by.map(|d| size * sign * s / (b * c) * d),
            turns: Turn::at(place, size * sign * s / (b * c) * by_crank),
            by_frame: 0.0,
        };
        row.shape[5] -= size * sign * (1.0 / c - cos / b);
        row.shape[6] -= size * sign * (1.0 / b - cos / c);
        each(&row);
    }
}
