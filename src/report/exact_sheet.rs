//! Small drawings of every real linkage through nine points, side by side.

use super::canvas::{Anchor, Area, Canvas, Spot, View, bold, font, palette, text_width};
use super::exact::ability;
use super::figure::{Detail, draw};
use super::scene::{Bounds, Scene, positions_at};
use super::text::{shortened, significant};
use super::words;
use crate::record::{ExactLinkage, Record};

const MARGIN: f64 = 24.0;
const GAP: f64 = 12.0;
const CELL: f64 = 190.0;
/// The height at which the drawing of a cell ends and its words begin.
const CELL_DRAWING: f64 = 150.0;
const HEAD: f64 = 72.0;
const COLUMNS: usize = 6;
const MOST_CELLS: usize = 200;
/// The number of positions of a circuit: one degree of the crank is below a pixel here.
const SAMPLES: usize = 360;
/// The number of extents of the target beyond which a curve is cut off, because the points would run together
/// otherwise.
const REACH: f64 = 5.0;

/// Returns the listed linkages with curve, type and abilities (at most two hundred).
pub fn exact_svg(record: &Record) -> String {
    let linkages = record.exact.as_ref().map_or(&[][..], |exact| &exact.linkages);
    let n = linkages.len().min(MOST_CELLS);
    let columns = n.clamp(3, COLUMNS);
    let width = 2.0 * MARGIN + columns as f64 * (CELL + GAP) - GAP;
    let mut canvas = Canvas::default();
    let name = words::problem_name(record);
    let free = linkages.iter().filter(|l| l.free_of_defects).count();
    let counted = match linkages.len() {
        1 => "1 real linkage".to_owned(),
        n => format!("{n} real linkages"),
    };
    let counted = format!("{counted}, {free} free of defects");
    let room = ((width - 2.0 * MARGIN) / text_width("x", 19.0)) as usize;
    let bold = bold(19, palette::INK);
    canvas.text(Spot::new(MARGIN, 36.0), Anchor::Start, &bold, &shortened(&name, room));
    let muted = font(13, palette::MUTED);
    canvas.text(Spot::new(MARGIN, 57.0), Anchor::Start, &muted, &counted);
    for (i, linkage) in linkages.iter().take(n).enumerate() {
        let corner = Spot::new(
            MARGIN + (i % columns) as f64 * (CELL + GAP),
            HEAD + (i / columns) as f64 * (CELL + GAP),
        );
        cell(&mut canvas, record, linkage, i + 1, corner);
    }
    let rows = n.div_ceil(columns);
    let height = HEAD + rows as f64 * (CELL + GAP) - GAP + MARGIN;
    canvas.document(width, height.max(HEAD + MARGIN), &name, &counted)
}

fn cell(canvas: &mut Canvas, record: &Record, linkage: &ExactLinkage, number: usize, corner: Spot) {
    let frame = Area { x: corner.x, y: corner.y, width: CELL, height: CELL };
    let edge = if linkage.free_of_defects { palette::FOLLOWER } else { palette::FAINT };
    let weight = if linkage.free_of_defects { 2.0 } else { 1.0 };
    let drawing = Area { height: CELL_DRAWING, ..frame };
    let positions = positions_at(&linkage.crank_deg, &linkage.t1_at);
    let scene = Scene::of(record, &linkage.linkage, &positions, SAMPLES);
    let view = View::fit(&seen(&scene), drawing.shrunk(12.0));
    canvas.raw(&format!(
        r#"<clipPath id="cell-{number}"><rect x="{}" y="{}" width="{CELL}" height="{CELL_DRAWING}"/></clipPath>"#,
        corner.x, corner.y
    ));
    canvas.raw(&format!(r##"<g clip-path="url(#cell-{number})">"##));
    draw(canvas, &scene, &view, Detail { target_weight: 0.5, ..Detail::small(0.45) });
    canvas.raw("</g>");
    canvas.area(frame, &format!(r#"fill="none" stroke="{edge}" stroke-width="{weight}" rx="4""#));
    let (left, right) = (corner.x + 8.0, corner.x + CELL - 8.0);
    let text =
        |weight: u16, colour: &str| format!(r#"font-size="10.5" font-weight="{weight}" fill="{colour}""#);
    let first = corner.y + CELL_DRAWING + 14.0;
    canvas.text(Spot::new(left, first), Anchor::Start, &text(600, palette::INK), &number.to_string());
    canvas.text(Spot::new(right, first), Anchor::End, &text(400, palette::INK), linkage.linkage_type.name());
    let colour = if linkage.free_of_defects { palette::INK } else { palette::MUTED };
    canvas.text(Spot::new(left, first + 16.0), Anchor::Start, &text(400, colour), ability(linkage));
    let worst = format!("{}°", significant(linkage.transmission_worst_deg, 3));
    canvas.text(Spot::new(right, first + 16.0), Anchor::End, &text(400, palette::MUTED), &worst);
}

/// Returns the box of the whole motion; of a motion that reaches far, the part around the target.
fn seen(scene: &Scene) -> Bounds {
    let (all, target) = (scene.bounds(), scene.target_bounds());
    if all.extent() <= REACH * target.extent() { all } else { target.padded(0.5 * (REACH - 1.0)) }
}
