//! The contact sheet: small drawings of all candidates side by side.

use super::canvas::{Anchor, Area, Canvas, Spot, View, outline, palette};
use super::figure::{Detail, draw};
use super::scene::Scene;
use super::text::{plural, shortened, significant};
use super::words;
use crate::record::{Candidate, Record};

/// The margin of a contact sheet.
pub(super) const MARGIN: f64 = 24.0;
const MOST_COLUMNS: usize = 4;
const MOST_CELLS: usize = 100;

/// The layout of a contact sheet: square cells in rows, each with a drawing above two lines of words.
pub(super) struct Layout {
    pub(super) columns: usize,
    /// The side of a cell.
    pub(super) cell: f64,
    /// The distance between cells.
    pub(super) gap: f64,
    /// The height at which the first cells begin.
    pub(super) head: f64,
    /// The height at which the drawing of a cell ends and its words begin.
    pub(super) drawing: f64,
    /// The distance of the words from the sides of their cell.
    pub(super) inset: f64,
    /// The heights of the two lines below the drawing.
    pub(super) lines: [f64; 2],
    pub(super) font_size: f64,
}

/// A word below a drawing: its text, font weight and colour.
pub(super) type Word<'a> = (&'a str, u16, &'static str);

impl Layout {
    pub(super) fn width(&self) -> f64 {
        2.0 * MARGIN + self.columns as f64 * (self.cell + self.gap) - self.gap
    }

    /// Returns the height of a sheet with `n` cells.
    pub(super) fn height(&self, n: usize) -> f64 {
        let rows = n.div_ceil(self.columns) as f64;
        (self.head + rows * (self.cell + self.gap) - self.gap + MARGIN).max(self.head + MARGIN)
    }

    /// Returns the cell with an index.
    pub(super) fn frame(&self, index: usize) -> Area {
        let at = |start: f64, i: usize| start + i as f64 * (self.cell + self.gap);
        let (x, y) = (at(MARGIN, index % self.columns), at(self.head, index / self.columns));
        Area { x, y, width: self.cell, height: self.cell }
    }

    /// Writes the words below a drawing: in each line one at the left and one at the right.
    pub(super) fn words(&self, canvas: &mut Canvas, frame: Area, lines: [[Word<'_>; 2]; 2]) {
        let (left, right) = (frame.x + self.inset, frame.x + frame.width - self.inset);
        for (line, below) in lines.iter().zip(self.lines) {
            let y = frame.y + self.drawing + below;
            for ((text, weight, colour), (x, anchor)) in
                line.iter().zip([(left, Anchor::Start), (right, Anchor::End)])
            {
                let size = self.font_size;
                let face = format!(r#"font-size="{size}" font-weight="{weight}" fill="{colour}""#);
                canvas.text(Spot::new(x, y), anchor, &face, text);
            }
        }
    }
}

/// Returns every candidate with its rank, error, type and verdict (at most a hundred).
pub fn contact_sheet_svg(record: &Record) -> String {
    let n = record.candidates.len().min(MOST_CELLS);
    let columns = match n {
        0..=3 => n.max(2),
        4 => 2,
        5 | 6 | 9 => 3,
        _ => MOST_COLUMNS,
    };
    let (head, drawing, lines) = (56.0, 216.0, [22.0, 42.0]);
    let layout =
        Layout { columns, cell: 276.0, gap: 16.0, head, drawing, inset: 12.0, lines, font_size: 12.5 };
    let mut canvas = Canvas::default();
    let name = words::problem_name(record);
    let counted = match record.candidates.len() {
        0 => "no candidate".to_owned(),
        n => plural(n, "candidate"),
    };
    canvas.title([MARGIN, layout.width() - MARGIN], 38.0, (&name, 19.0), (&counted, 13.0));
    for (i, candidate) in record.candidates.iter().take(n).enumerate() {
        cell(&mut canvas, record, candidate, &layout, layout.frame(i));
    }
    canvas.document(layout.width(), layout.height(n), &name, &counted)
}

/// The width and the height of a thumbnail, in pixels.
const THUMBNAIL: [f64; 2] = [276.0, 210.0];

/// Returns a small drawing of a candidate without words: linkage, coupler curve and target.
pub(super) fn thumbnail_svg(record: &Record, candidate: &Candidate, title: &str) -> String {
    let [width, height] = THUMBNAIL;
    let mut canvas = Canvas::default();
    thumbnail(&mut canvas, record, candidate, Area { x: 0.0, y: 0.0, width, height });
    canvas.document(width, height, title, candidate.type_name())
}

/// Draws a candidate small into an area.
fn thumbnail(canvas: &mut Canvas, record: &Record, candidate: &Candidate, area: Area) {
    let scene = Scene::new(record, Some(candidate));
    let view = View::fit(&scene.bounds(), area.shrunk(20.0));
    draw(canvas, &scene, &view, Detail::small(0.6));
}

fn cell(canvas: &mut Canvas, record: &Record, candidate: &Candidate, layout: &Layout, frame: Area) {
    canvas.area(frame, &(outline(palette::FAINT, 1) + r#" rx="4""#));
    thumbnail(canvas, record, candidate, Area { height: layout.drawing, ..frame });

    let (rms, unit) = (significant(candidate.error.rms, 4), words::error_unit(record));
    let angle = candidate.error.angle.map_or(String::new(), |a| format!(", {}°", significant(a.rms_deg, 3)));
    let rms = format!("#{}   rms {rms}{unit}{angle}", candidate.rank);
    // Beside an error of an angle "worst angle" would be taken for one.
    let worst = if angle.is_empty() { "worst angle" } else { "transmission" };
    let worst = format!("{worst} {}°", significant(candidate.transmission_deg.worst, 3));
    let verdict = shortened(&words::verdict(record, candidate), 20);
    let colour = if candidate.accepted { palette::MUTED } else { palette::TARGET_TEXT };
    let kind = candidate.type_name();
    let first = [(rms.as_str(), 600, palette::INK), (kind, 400, palette::INK)];
    layout.words(canvas, frame, [first, [(&worst, 400, palette::MUTED), (&verdict, 400, colour)]]);
}
