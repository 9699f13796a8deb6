//! Small drawings of every real linkage through nine points, side by side.

use super::canvas::{Anchor, Area, Canvas, Spot, View, bold, font, outline, palette};
use super::contact_sheet::{Layout, MARGIN};
use super::exact::ability;
use super::figure::{Detail, draw};
use super::scene::{Bounds, Scene, positions_at};
use super::text::{plural, shortened, significant, text_width};
use super::words;
use crate::record::{ExactLinkage, Record};

const MOST_COLUMNS: usize = 6;
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
    let (columns, head, drawing, lines) = (n.clamp(3, MOST_COLUMNS), 72.0, 150.0, [14.0, 30.0]);
    let layout =
        Layout { columns, cell: 190.0, gap: 12.0, head, drawing, inset: 8.0, lines, font_size: 10.5 };
    let mut canvas = Canvas::default();
    let name = words::problem_name(record);
    let free = linkages.iter().filter(|l| l.free_of_defects).count();
    let counted = format!("{}, {free} free of defects", plural(linkages.len(), "real linkage"));
    let room = ((layout.width() - 2.0 * MARGIN) / text_width("x", 19.0)) as usize;
    let bold = bold(19, palette::INK);
    canvas.text(Spot::new(MARGIN, 36.0), Anchor::Start, &bold, &shortened(&name, room));
    let muted = font(13, palette::MUTED);
    canvas.text(Spot::new(MARGIN, 57.0), Anchor::Start, &muted, &counted);
    for (i, linkage) in linkages.iter().take(n).enumerate() {
        cell(&mut canvas, record, linkage, &layout, i);
    }
    canvas.document(layout.width(), layout.height(n), &name, &counted)
}

fn cell(canvas: &mut Canvas, record: &Record, linkage: &ExactLinkage, layout: &Layout, index: usize) {
    let (frame, number) = (layout.frame(index), (index + 1).to_string());
    let drawing = Area { height: layout.drawing, ..frame };
    let positions = positions_at(&linkage.crank_deg, &linkage.t1_at);
    let scene = Scene::of(record, &linkage.linkage, &positions, None, SAMPLES);
    let view = View::fit(&seen(&scene), drawing.shrunk(12.0));
    let Area { x, y, width, height } = drawing;
    canvas.raw(&format!(
        r#"<clipPath id="cell-{number}"><rect x="{x}" y="{y}" width="{width}" height="{height}"/></clipPath>"#
    ));
    canvas.raw(&format!(r##"<g clip-path="url(#cell-{number})">"##));
    draw(canvas, &scene, &view, Detail { target_weight: 0.5, ..Detail::small(0.45) });
    canvas.raw("</g>");
    let (edge, weight, colour) = match linkage.free_of_defects {
        true => (palette::FOLLOWER, 2, palette::INK),
        false => (palette::FAINT, 1, palette::MUTED),
    };
    canvas.area(frame, &(outline(edge, weight) + r#" rx="4""#));
    let worst = format!("{}°", significant(linkage.transmission_worst_deg, 3));
    let first = [(number.as_str(), 600, palette::INK), (linkage.type_name(), 400, palette::INK)];
    let second = [(ability(linkage), 400, colour), (worst.as_str(), 400, palette::MUTED)];
    layout.words(canvas, frame, [first, second]);
}

/// Returns the box of the whole motion; of a motion that reaches far, the part around the target.
fn seen(scene: &Scene) -> Bounds {
    let (all, target) = (scene.bounds(), scene.target_bounds());
    if all.extent() <= REACH * target.extent() { all } else { target.padded(0.5 * (REACH - 1.0)) }
}
