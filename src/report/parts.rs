//! The parts of drawings of linkages: stands, bars, the coupler's triangle, letters.

use super::canvas::{
    Canvas, ROUND_CORNERS, ROUND_ENDS, Spot, Vec2, bold, filled, haloed, palette, stroke, weighted,
};
use super::labels::{Beside, Labels};

/// The direction up, in which a label is clear of a stand.
pub(super) const UP: Vec2 = Vec2::new(0.0, -1.0);

/// Draws the hatched stand of a fixed pivot.
pub(super) fn stand(canvas: &mut Canvas, pivot: Spot, w: f64) {
    let (half, base) = (11.0 * w, pivot + Vec2::new(0.0, 16.0 * w));
    let width = weighted(1.4 * w);
    let stand = [pivot, base + Vec2::new(half, 0.0), base - Vec2::new(half, 0.0)];
    canvas.path(&stand, true, &(filled(palette::PAPER, palette::BAR_EDGE, &width) + ROUND_CORNERS));
    let line = stroke(palette::BAR_EDGE, &width) + ROUND_ENDS;
    canvas.line(base - Vec2::new(1.5 * half, 0.0), base + Vec2::new(1.5 * half, 0.0), &line);
    for i in 0..6 {
        let top = base + Vec2::new(half * (-1.3 + 0.56 * f64::from(i)), 0.0);
        canvas.line(top, top + Vec2::new(-4.5 * w, 5.5 * w), &line);
    }
}

/// Draws a plate, filled faintly with one colour and edged in another.
pub(super) fn plate(canvas: &mut Canvas, corners: &[Spot], fill: &str, edge: &str, width: &str) {
    let edge = stroke(edge, width);
    canvas.path(corners, true, &format!(r#"fill="{fill}" fill-opacity="0.22" {edge}{ROUND_CORNERS}"#));
}

/// Draws a triangle C, D, P, filled with one colour and edged in another.
pub(super) fn triangle(canvas: &mut Canvas, corners: [Spot; 3], fill: &str, edge: &str, w: f64) {
    plate(canvas, &corners, fill, edge, &weighted(1.8 * w));
}

/// Draws bars A-C, C-D and B-D edged in a colour, with pins on top.
pub(super) fn bars(canvas: &mut Canvas, [a, b, c, d]: [Spot; 4], edge: &str, w: f64) {
    for (from, to) in [(a, c), (c, d), (b, d)] {
        for (colour, width) in [(edge, 9.5 * w), (palette::BAR, 6.5 * w)] {
            canvas.line(from, to, &(stroke(colour, weighted(width)) + ROUND_ENDS));
        }
    }
    let pin = filled(palette::PAPER, edge, weighted(1.8 * w));
    for (joint, radius) in [(a, 5.2), (b, 5.2), (c, 4.2), (d, 4.2)] {
        canvas.circle(joint, radius * w, &pin);
    }
}

/// Draws the mark of a coupler point.
pub(super) fn point_mark(canvas: &mut Canvas, at: Spot, w: f64) {
    canvas.circle(at, 4.4 * w, &filled(palette::CURVE, palette::PAPER, weighted(1.2 * w)));
}

/// Marks the links and stands of A, B, C, D, P as occupied for labels.
pub(super) fn mark_joints(labels: &mut Labels, [a, b, c, d, p]: [Spot; 5]) {
    for (from, to) in [(a, c), (c, d), (b, d), (c, p), (d, p)] {
        labels.mark_line(from, to);
        labels.mark_line(from, to);
    }
    for pivot in [a, b] {
        for y in [8.0, 16.0, 20.0] {
            labels.mark_line(pivot + Vec2::new(-y, y), pivot + Vec2::new(y, y));
        }
    }
}

/// Draws the letter of a joint beside it.
pub(super) fn letter(canvas: &mut Canvas, name: &str, joint: Spot, towards: Vec2) {
    let attributes = haloed(&bold(15, palette::INK), "3", ROUND_CORNERS);
    canvas.label(name, 15.0, &attributes, Beside { point: joint, distance: 9.0, towards, needed: true });
}

/// Returns the direction away from the neighbours, or straight up if they cancel each other.
pub(super) fn away(joint: Spot, neighbours: &[Spot]) -> Vec2 {
    let mut sum = Vec2::ZERO;
    for neighbour in neighbours {
        let (from, distance) = (joint - *neighbour, joint.distance(*neighbour));
        if distance > 0.0 {
            sum += Vec2::new(from.x / distance, from.y / distance);
        }
    }
    if sum.hypot() < 0.2 { UP } else { sum }
}
