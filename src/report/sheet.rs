//! Sheets: framed drawings with a title each, laid out on one page.

use super::canvas::{
    Anchor, Area, Canvas, Frame, ROUND_ENDS, Spot, Vec2, View, bold, font, outline, palette, px, stroke,
};
use super::scene::Bounds;
use super::text::{brief, shortened, text_width};
use super::words;
use crate::mechanism::{Complex, FourBar, Unit};

/// The width of a page and of the sheets on it, in pixels.
const WIDTH: f64 = 1080.0;
const MARGIN: f64 = 28.0;
const GAP: f64 = 18.0;
pub(super) const FULL: f64 = WIDTH - 2.0 * MARGIN;
pub(super) const HALF: f64 = 0.5 * (FULL - GAP);

/// The height at which the drawing of a sheet begins, below its title and note.
pub(super) const HEAD: f64 = 54.0;
/// The height of a line below the drawing.
const LINE: f64 = 17.0;
/// The inner margin of a sheet.
pub(super) const INSET: f64 = 16.0;

/// The padding for letters, stands and labels around the geometry.
const PADDING: f64 = 40.0;
/// The space for scale bars below the geometry.
pub(super) const FOOTER: f64 = 40.0;
/// The allowed heights of a drawing, which follows its shape.
const HEIGHTS: std::ops::RangeInclusive<f64> = 230.0..=440.0;

/// A sheet: one framed drawing.
pub(super) struct Sheet {
    title: &'static str,
    /// A line below the title.
    pub(super) note: String,
    /// The drawing, with the origin at the sheet's corner.
    pub(super) body: Canvas,
    /// The lines below the drawing.
    pub(super) foot: Vec<String>,
    width: f64,
    /// The height at which the drawing ends.
    pub(super) bottom: f64,
}

impl Sheet {
    /// Returns an empty sheet for a drawing that ends at `bottom`.
    pub(super) fn new(title: &'static str, width: f64, bottom: f64) -> Sheet {
        Sheet { title, note: String::new(), body: Canvas::default(), foot: Vec::new(), width, bottom }
    }

    /// Returns an empty sheet of this width with a view of the box (and space for scale bars below).
    pub(super) fn fitted(title: &'static str, bounds: &Bounds, width: f64) -> (Sheet, View) {
        let frame = Frame { width, padding: PADDING, heights: HEIGHTS };
        let (view, height) = frame.fit(bounds, Spot::new(0.0, HEAD));
        (Sheet::new(title, width, HEAD + height + FOOTER), view)
    }

    /// Draws the scale bar of a drawing of a width at the sheet's lower left.
    pub(super) fn scale_bar(&mut self, view: &View, unit: Option<Unit>, width: f64) {
        let at = Spot::new(INSET + 2.0, self.bottom - 12.0);
        self.body.scale_bar(at, view, 0.22 * width, &words::length_suffix(unit));
    }

    fn height(&self) -> f64 {
        self.bottom + LINE * self.foot.len() as f64 + 10.0
    }

    /// Draws the sheet with its corner at `at`, in a frame of the height of its row.
    fn put(self, canvas: &mut Canvas, at: Spot, row_height: f64) {
        canvas.raw(&format!(r#"<g transform="translate({} {})">"#, px(at.x), px(at.y)));
        let frame = Area { x: 0.0, y: 0.0, width: self.width, height: row_height };
        canvas.area(frame, &(outline(palette::FAINT, 1) + r#" rx="4""#));
        let write = |canvas: &mut Canvas, y: f64, attributes: &str, text: &str, size: f64| {
            let text = fitting(text, size, self.width - 2.0 * INSET);
            canvas.text(Spot::new(INSET, y), Anchor::Start, attributes, &text);
        };
        write(canvas, 26.0, &bold(15, palette::INK), self.title, 15.0);
        write(canvas, 44.0, &font(12, palette::MUTED), &self.note, 12.0);
        canvas.body.push_str(&self.body.body);
        let first = row_height - 10.0 - LINE * self.foot.len() as f64 + 12.0;
        for (i, line) in self.foot.iter().enumerate() {
            write(canvas, first + LINE * i as f64, &font(12, palette::INK), line, 12.0);
        }
        canvas.raw("</g>");
    }
}

/// Returns the text, cut to the width.
pub(super) fn fitting(text: &str, font_size: f64, width: f64) -> String {
    // Running text is narrower than its widest letters.
    shortened(text, (1.04 * width / text_width("x", font_size)) as usize)
}

/// Returns one page with the sheets from left to right and from top to bottom, below a title with a note at its right
/// and more lines.
pub(super) fn page(title: &str, note: &str, lines: &[String], sheets: Vec<Sheet>) -> String {
    let mut canvas = Canvas::default();
    canvas.title([MARGIN, MARGIN + FULL], 42.0, (title, 21.0), (note, 14.0));
    let muted = font(13, palette::MUTED);
    let mut y = 64.0;
    for line in lines {
        canvas.text(Spot::new(MARGIN, y), Anchor::Start, &muted, &fitting(line, 13.0, FULL));
        y += 18.0;
    }
    let mut row: Vec<Sheet> = Vec::new();
    let mut taken = 0.0;
    for sheet in sheets {
        // Half a pixel of slack: two halves and their gap make a full width up to rounding.
        if !row.is_empty() && taken + sheet.width > FULL + 0.5 {
            y = put_row(&mut canvas, std::mem::take(&mut row), y);
            taken = 0.0;
        }
        taken += sheet.width + GAP;
        row.push(sheet);
    }
    y = put_row(&mut canvas, row, y);
    canvas.document(WIDTH, y - GAP + MARGIN, title, &lines.join("; "))
}

/// Draws a row of sheets, all in frames of the same height; returns the height at which the next one starts.
fn put_row(canvas: &mut Canvas, row: Vec<Sheet>, y: f64) -> f64 {
    if row.is_empty() {
        return y;
    }
    let height = row.iter().map(Sheet::height).fold(0.0, f64::max);
    let mut x = MARGIN;
    for sheet in row {
        let width = sheet.width;
        sheet.put(canvas, Spot::new(x, y), height);
        x += width + GAP;
    }
    y + height + GAP
}

/// Returns the dimensions, such as `A (0, 0), B (4, 1), a 2, b 5 ..`.
pub(super) fn dimensions(linkage: &FourBar) -> String {
    let [ax, ay, bx, by, a, b, c, d, e] =
        linkage.natural_coordinates().numbers().map(|number| brief(number, 6));
    let [t1, t2] = [linkage.assembly().sign(), linkage.side().sign()].map(sign);
    format!("A ({ax}, {ay}), B ({bx}, {by}), a {a}, b {b}, c {c}, d {d}, e {e}, t1 {t1}, t2 {t2}")
}

/// Returns a sign as `+1`, or as `−1` with a true minus.
pub(super) fn sign(value: f64) -> &'static str {
    if value < 0.0 { "−1" } else { "+1" }
}

/// Draws an arrow whose head ends at `to`; nothing if it is too short to be seen.
pub(super) fn arrow(canvas: &mut Canvas, from: Spot, to: Spot, colour: &str) {
    let length = from.distance(to);
    // NaN counts as too short as well.
    if length.is_nan() || length < 1.0 {
        return;
    }
    let along = Vec2::new((to.x - from.x) / length, (to.y - from.y) / length);
    let head = (0.45 * length).min(11.0);
    let neck = to - head * along;
    canvas.line(from, neck, &(stroke(colour, 2.4) + ROUND_ENDS));
    let barb = 0.36 * head * along.turn_90();
    canvas.path(&[to, neck + barb, neck - barb], true, &format!(r#"fill="{colour}""#));
}

/// Returns points of an arc about a centre, radians from `from` to `to`.
pub(super) fn arc(centre: Complex, radius: f64, from: f64, to: f64) -> impl Iterator<Item = Complex> {
    const STEPS: usize = 64;
    (0..=STEPS).map(move |i| {
        let angle = from + (to - from) * i as f64 / STEPS as f64;
        centre + Complex::from_polar(radius, angle)
    })
}
