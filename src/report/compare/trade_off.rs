//! The trade-off chart: error across, worst transmission angle up, size as the size of the mark.

use super::{Comparison, Ranked, SortKey, strokes};
use crate::report::canvas::{Anchor, Canvas, Spot, bold, font, palette, px};
use crate::report::scale::{LOGARITHMIC, Scale};
use crate::report::text::brief;

pub(super) const WIDTH: f64 = 640.0;
pub(super) const HEIGHT: f64 = 330.0;
const LEFT: f64 = 66.0;
const RIGHT: f64 = 30.0;
const TOP: f64 = 22.0;
const BOTTOM: f64 = 52.0;
const RADII: [f64; 2] = [7.0, 17.0];

/// Draws the marks of all rows that have the three figures; `None` if fewer than two have.
pub(super) fn trade_off<'c>(comparison: &'c Comparison) -> Option<Canvas> {
    let of = |(i, row): (usize, &'c Ranked)| {
        let [x, y, size] = [SortKey::Rms, SortKey::Transmission, SortKey::Size].map(|key| row.figure_of(key));
        Some((i, row, [x?, y?, size?]))
    };
    let mut rows: Vec<_> = comparison.rows.iter().enumerate().filter_map(of).collect();
    if rows.len() < 2 || !comparison.same_target() || !comparison.same_unit() {
        return None;
    }
    let values = |k: usize| rows.iter().map(|row| row.2[k]).collect::<Vec<f64>>();
    let (across, up) = (Scale::new(&values(0), LOGARITHMIC), Scale::new(&values(1), f64::INFINITY));
    let largest = values(2).into_iter().fold(f64::MIN_POSITIVE, f64::max);
    let spot = |x: f64, y: f64| {
        Spot::new(
            LEFT + (WIDTH - LEFT - RIGHT) * across.part(x),
            HEIGHT - BOTTOM - (HEIGHT - TOP - BOTTOM) * up.part(y),
        )
    };
    let mut canvas = Canvas::default();
    axes(&mut canvas, comparison, &across, &up);
    // Small marks are drawn above large ones.
    rows.sort_by(|x, y| y.2[2].total_cmp(&x.2[2]).then(y.0.cmp(&x.0)));
    for (i, row, [x, y, size]) in rows {
        let at = spot(x, y);
        let radius = (RADII[1] * (size / largest).sqrt()).max(RADII[0]);
        let colour = if i < strokes::MOST { strokes::colour(i) } else { palette::MUTED };
        let (opacity, width) = if row.on_front { (0.34, 2.6) } else { (0.06, 1.2) };
        canvas.raw(&format!(r#"<g class="curve" data-row="{i}">"#));
        canvas.circle(
            at,
            radius,
            &format!(r#"fill="{colour}" fill-opacity="{opacity}" stroke="{colour}" stroke-width="{width}""#),
        );
        let text = bold(12, palette::INK);
        canvas.text(Spot::new(at.x, at.y + 4.2), Anchor::Middle, &text, &row.rank.to_string());
        canvas.raw("</g>");
    }
    Some(canvas)
}

fn axes(canvas: &mut Canvas, comparison: &Comparison, across: &Scale, up: &Scale) {
    let faint = format!(r#"stroke="{}" stroke-width="1""#, palette::FAINT);
    let muted = font(12, palette::MUTED);
    let (left, right, top, bottom) = (LEFT, WIDTH - RIGHT, TOP, HEIGHT - BOTTOM);
    for tick in across.ticks() {
        let x = left + (right - left) * across.part(tick);
        canvas.line(Spot::new(x, top), Spot::new(x, bottom), &faint);
        canvas.text(Spot::new(x, bottom + 18.0), Anchor::Middle, &muted, &brief(tick, 4));
    }
    for tick in up.ticks() {
        let y = bottom - (bottom - top) * up.part(tick);
        canvas.line(Spot::new(left, y), Spot::new(right, y), &faint);
        canvas.text(Spot::new(left - 8.0, y + 4.0), Anchor::End, &muted, &format!("{}°", brief(tick, 4)));
    }
    let scale = if across.logarithmic { ", logarithmic" } else { "" };
    let unit = comparison.unit().map_or(String::new(), |unit| format!(", {}", unit.label()));
    let label = format!("rms error{unit}{scale}");
    canvas.text(Spot::new(right, HEIGHT - 10.0), Anchor::End, &muted, &label);
    canvas.raw(&format!(
        r#"<text transform="translate(14 {}) rotate(-90)" text-anchor="middle" {muted}>worst transmission angle</text>"#,
        px(0.5 * (top + bottom))
    ));
}
