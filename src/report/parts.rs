//! The parts of drawings of linkages: stands, bars, the coupler's triangle, letters.

use super::canvas::{Anchor, Canvas, Corners, Spot, bold, haloed, palette};
use super::labels::Labels;

/// Marks points of a path, a few pixels apart, as occupied for labels.
pub(super) fn mark_path(labels: &mut Labels, spots: &[Spot]) {
    let mut last: Option<Spot> = None;
    for &spot in spots {
        if last.is_none_or(|last| last.distance(spot) >= 4.0) {
            labels.mark(spot);
            last = Some(spot);
        }
    }
}

/// Draws the hatched stand of a fixed pivot.
pub(super) fn stand(canvas: &mut Canvas, pivot: Spot, w: f64) {
    let (half, top, base) = (11.0 * w, pivot.y, pivot.y + 16.0 * w);
    let stand = [Spot::new(pivot.x, top), Spot::new(pivot.x + half, base), Spot::new(pivot.x - half, base)];
    let edge = format!(
        r#"fill="{}" stroke="{}" stroke-width="{:.2}" stroke-linejoin="round""#,
        palette::PAPER,
        palette::BAR_EDGE,
        1.4 * w
    );
    canvas.path(&stand, true, &edge);
    let stroke =
        format!(r#"stroke="{}" stroke-width="{:.2}" stroke-linecap="round""#, palette::BAR_EDGE, 1.4 * w);
    canvas.line(Spot::new(pivot.x - 1.5 * half, base), Spot::new(pivot.x + 1.5 * half, base), &stroke);
    for i in 0..6 {
        let x = pivot.x + half * (-1.3 + 0.56 * f64::from(i));
        canvas.line(Spot::new(x, base), Spot::new(x - 4.5 * w, base + 5.5 * w), &stroke);
    }
}

/// Draws a triangle C, D, P, filled with one colour and edged in another.
pub(super) fn triangle(canvas: &mut Canvas, corners: [Spot; 3], fill: &str, edge: &str, w: f64) {
    let attributes = format!(
        concat!(
            r#"fill="{}" fill-opacity="0.22" stroke="{}" "#,
            r#"stroke-width="{:.2}" stroke-linejoin="round""#
        ),
        fill,
        edge,
        1.8 * w
    );
    canvas.path(&corners, true, &attributes);
}

/// Draws bars A-C, C-D and B-D filled with one colour and edged in another, with pins on top.
pub(super) fn bars(canvas: &mut Canvas, [a, b, c, d]: [Spot; 4], fill: &str, edge: &str, w: f64) {
    for (from, to) in [(a, c), (c, d), (b, d)] {
        for (colour, width) in [(edge, 9.5 * w), (fill, 6.5 * w)] {
            canvas.line(
                from,
                to,
                &format!(r#"stroke="{colour}" stroke-width="{width:.2}" stroke-linecap="round""#),
            );
        }
    }
    for (joint, radius) in [(a, 5.2), (b, 5.2), (c, 4.2), (d, 4.2)] {
        let pin = format!(r#"fill="{}" stroke="{}" stroke-width="{:.2}""#, palette::PAPER, edge, 1.8 * w);
        canvas.circle(joint, radius * w, &pin);
    }
}

/// Draws the mark of a coupler point.
pub(super) fn point_mark(canvas: &mut Canvas, at: Spot, w: f64) {
    let attributes =
        format!(r#"fill="{}" stroke="{}" stroke-width="{:.2}""#, palette::CURVE, palette::PAPER, 1.2 * w);
    canvas.circle(at, 4.4 * w, &attributes);
}

/// Marks the links and stands of A, B, C, D, P as occupied for labels.
pub(super) fn mark_joints(labels: &mut Labels, [a, b, c, d, p]: [Spot; 5]) {
    for (from, to) in [(a, c), (c, d), (b, d), (c, p), (d, p)] {
        labels.mark_line(from, to);
        labels.mark_line(from, to);
    }
    for pivot in [a, b] {
        for y in [8.0, 16.0, 20.0] {
            labels.mark_line(Spot::new(pivot.x - y, pivot.y + y), Spot::new(pivot.x + y, pivot.y + y));
        }
    }
}

/// Draws the letter of a joint beside it.
pub(super) fn letter(canvas: &mut Canvas, labels: &mut Labels, name: &str, joint: Spot, towards: Spot) {
    if let Some(at) = labels.place(name, 15.0, joint, 9.0, towards, true) {
        canvas.text(at, Anchor::Middle, &haloed(&bold(15, palette::INK), "3", Corners::Round), name);
    }
}

/// Returns the direction away from the neighbours, or straight up if they cancel each other.
pub(super) fn away(joint: Spot, neighbours: &[Spot]) -> Spot {
    let mut sum = Spot::new(0.0, 0.0);
    for neighbour in neighbours {
        let distance = joint.distance(*neighbour);
        if distance > 0.0 {
            sum =
                plus(sum, Spot::new((joint.x - neighbour.x) / distance, (joint.y - neighbour.y) / distance));
        }
    }
    if sum.x.hypot(sum.y) < 0.2 { Spot::new(0.0, -1.0) } else { sum }
}

/// Returns the sum of two vectors.
pub(super) fn plus(a: Spot, b: Spot) -> Spot {
    Spot::new(a.x + b.x, a.y + b.y)
}
