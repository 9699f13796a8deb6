//! The contact sheet: small drawings of all candidates side by side.

use super::canvas::{Anchor, Area, Canvas, Spot, View, bold, font, palette, text_width};
use super::figure::{Detail, draw};
use super::scene::Scene;
use super::text::{shortened, significant};
use super::words;
use crate::record::{Candidate, Record};

const MARGIN: f64 = 24.0;
const GAP: f64 = 16.0;
const CELL: f64 = 276.0;
/// The height at which the drawing of a cell ends and its figures begin.
const CELL_DRAWING: f64 = 216.0;
const MOST_COLUMNS: usize = 4;
const MOST_CELLS: usize = 100;

/// Returns every candidate with its rank, error, type and verdict (at most a hundred).
pub fn contact_sheet_svg(record: &Record) -> String {
    let n = record.candidates.len().min(MOST_CELLS);
    let columns = match n {
        0..=3 => n.max(2),
        4 => 2,
        5 | 6 | 9 => 3,
        _ => MOST_COLUMNS,
    };
    let rows = n.div_ceil(columns);
    let width = 2.0 * MARGIN + columns as f64 * (CELL + GAP) - GAP;
    let mut canvas = Canvas::default();
    let name = words::problem_name(record);
    let counted = match record.candidates.len() {
        0 => "no candidate".to_owned(),
        1 => "1 candidate".to_owned(),
        n => format!("{n} candidates"),
    };
    let room = ((width - 2.0 * MARGIN - text_width(&counted, 13.0) - 20.0) / text_width("x", 19.0)) as usize;
    let bold = bold(19, palette::INK);
    canvas.text(Spot::new(MARGIN, 38.0), Anchor::Start, &bold, &shortened(&name, room));
    let muted = font(13, palette::MUTED);
    canvas.text(Spot::new(width - MARGIN, 38.0), Anchor::End, &muted, &counted);
    for (i, candidate) in record.candidates.iter().take(n).enumerate() {
        let corner = Spot::new(
            MARGIN + (i % columns) as f64 * (CELL + GAP),
            56.0 + (i / columns) as f64 * (CELL + GAP),
        );
        cell(&mut canvas, record, candidate, corner);
    }
    let height = 56.0 + rows as f64 * (CELL + GAP) - GAP + MARGIN;
    canvas.document(width, height.max(80.0), &name, &counted)
}

fn cell(canvas: &mut Canvas, record: &Record, candidate: &Candidate, corner: Spot) {
    let frame = Area { x: corner.x, y: corner.y, width: CELL, height: CELL };
    canvas.area(frame, &format!(r#"fill="none" stroke="{}" stroke-width="1" rx="4""#, palette::FAINT));
    let scene = Scene::new(record, Some(candidate));
    let view = View::fit(&scene.bounds(), Area { height: CELL_DRAWING, ..frame }.shrunk(20.0));
    draw(canvas, &scene, &view, Detail::small(0.6));

    let (left, right) = (corner.x + 12.0, corner.x + CELL - 12.0);
    let ink =
        |weight: u16, colour: &str| format!(r#"font-size="12.5" font-weight="{weight}" fill="{colour}""#);
    let first = corner.y + CELL_DRAWING + 22.0;
    let rms = format!(
        "#{}   rms {}{}",
        candidate.rank,
        significant(candidate.error.rms, 4),
        words::unit_suffix(record)
    );
    canvas.text(Spot::new(left, first), Anchor::Start, &ink(600, palette::INK), &rms);
    let kind = ink(400, palette::INK);
    canvas.text(Spot::new(right, first), Anchor::End, &kind, candidate.linkage_type.name());
    let worst = format!("worst angle {}°", significant(candidate.transmission_deg.worst, 3));
    canvas.text(Spot::new(left, first + 20.0), Anchor::Start, &ink(400, palette::MUTED), &worst);
    let colour = if candidate.accepted { palette::MUTED } else { palette::TARGET_TEXT };
    let verdict = shortened(&words::verdict(record, candidate), 20);
    canvas.text(Spot::new(right, first + 20.0), Anchor::End, &ink(400, colour), &verdict);
}
