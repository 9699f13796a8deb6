//! The SVG shapes of the drawings, in pixels with y down, and the view that maps the plane to the canvas, with y up.

use super::labels::{Beside, Labels};
use super::scene::{Bounds, round_length};
use super::text::{brief, shortened, text_width, xml};
use crate::mechanism::Complex;
use std::fmt::{Display, Write};

/// A place on the canvas and a displacement on it, in pixels, y down.
pub(super) use kurbo::{Point as Spot, Vec2};

/// Colours that colour-blind readers can distinguish (Okabe and Ito 2008) on a light ground.
pub(super) mod palette {
    pub(in crate::report) const PAPER: &str = "#ffffff";
    pub(in crate::report) const INK: &str = "#1f2a36";
    pub(in crate::report) const MUTED: &str = "#66717d";
    pub(in crate::report) const FAINT: &str = "#c3cad2";
    pub(in crate::report) const CURVE: &str = "#0072b2";
    pub(in crate::report) const TARGET: &str = "#d55e00";
    pub(in crate::report) const TARGET_TEXT: &str = "#a34700";
    pub(in crate::report) const COUPLER: &str = "#e69f00";
    pub(in crate::report) const FOLLOWER: &str = "#009e73";
    pub(in crate::report) const SECOND: &str = "#cc79a7";
    pub(in crate::report) const BAR: &str = "#d6dde4";
    pub(in crate::report) const BAR_EDGE: &str = "#45525f";
}

/// A rectangle on the canvas.
#[derive(Clone, Copy, Debug)]
pub(super) struct Area {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) width: f64,
    pub(super) height: f64,
}

impl Area {
    pub(super) fn shrunk(self, by: f64) -> Area {
        Area {
            x: self.x + by,
            y: self.y + by,
            width: (self.width - 2.0 * by).max(1.0),
            height: (self.height - 2.0 * by).max(1.0),
        }
    }
}

/// A view: the map from the plane to the canvas, with one scale for both axes and y up.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub(super) scale: f64,
    from: Complex,
    to: Spot,
}

impl View {
    /// Returns the view with the box in the middle of the area, as large as it fits.
    pub(super) fn fit(bounds: &Bounds, area: Area) -> View {
        let by_width = area.width / bounds.width();
        let by_height = area.height / bounds.height();
        let scale = by_width.min(by_height);
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        let to = Spot::new(area.x + 0.5 * area.width, area.y + 0.5 * area.height);
        View { scale, from: bounds.centre(), to }
    }

    pub(super) fn spot(&self, p: Complex) -> Spot {
        self.to + Vec2::new(self.scale * (p.re - self.from.re), -(self.scale * (p.im - self.from.im)))
    }

    /// Returns the places of points.
    pub(super) fn spots<'a>(&self, points: impl IntoIterator<Item = &'a Complex>) -> Vec<Spot> {
        points.into_iter().map(|p| self.spot(*p)).collect()
    }
}

/// A frame for a drawing: its height follows from the shape of what is drawn, within a range.
pub(super) struct Frame {
    pub(super) width: f64,
    pub(super) padding: f64,
    pub(super) heights: std::ops::RangeInclusive<f64>,
}

impl Frame {
    /// Returns the view of the box in the frame with its corner at `at`, and the height of the frame.
    pub(super) fn fit(&self, bounds: &Bounds, at: Spot) -> (View, f64) {
        let wanted =
            (self.width - 2.0 * self.padding) * bounds.height() / bounds.width().max(f64::MIN_POSITIVE);
        let height = (wanted + 2.0 * self.padding).clamp(*self.heights.start(), *self.heights.end());
        let area = Area { x: at.x, y: at.y, width: self.width, height };
        (View::fit(bounds, area.shrunk(self.padding)), height)
    }
}

/// Returns the attributes of a line of a colour and width.
pub(super) fn stroke(colour: &str, width: impl Display) -> String {
    format!(r#"stroke="{colour}" stroke-width="{width}""#)
}

/// Returns the attributes of a shape that is filled with one colour and edged in another.
pub(super) fn filled(fill: &str, edge: &str, width: impl Display) -> String {
    format!(r#"fill="{fill}" {}"#, stroke(edge, width))
}

/// Returns the attributes of a curve, which encloses nothing.
pub(super) fn outline(colour: &str, width: impl Display) -> String {
    filled("none", colour, width)
}

/// Returns a width that follows from a drawing's weight, to a hundredth of a pixel.
pub(super) fn weighted(width: f64) -> String {
    format!("{width:.2}")
}

/// The attributes of lines with round ends, and of shapes with round and with sharp corners.
pub(super) const ROUND_ENDS: &str = r#" stroke-linecap="round""#;
pub(super) const ROUND_CORNERS: &str = r#" stroke-linejoin="round""#;
pub(super) const SHARP_CORNERS: &str = "";

/// Returns the attributes of a text of a size and colour.
pub(super) fn font(size: impl Display, colour: &str) -> String {
    format!(r#"font-size="{size}" fill="{colour}""#)
}

/// Returns the attributes of a bold text of a size and colour.
pub(super) fn bold(size: impl Display, colour: &str) -> String {
    format!(r#"font-size="{size}" font-weight="600" fill="{colour}""#)
}

/// Returns the attributes of a text with paper of a width around its letters, so that it is legible on lines.
pub(super) fn haloed(text: &str, width: &str, corners: &str) -> String {
    format!(r#"{text} {}{corners} paint-order="stroke""#, stroke(palette::PAPER, width))
}

/// Returns a coordinate to a hundredth of a pixel, kept within the range that viewers can read.
pub(super) fn px(value: f64) -> String {
    let mut text = String::new();
    push_px(&mut text, value);
    text
}

/// Appends a number as [`px`] writes it.
fn push_px(text: &mut String, value: f64) {
    let value = if value.is_finite() { value.clamp(-1e6, 1e6) } else { 0.0 };
    // The error of the product is below 2e-8: if the product is farther than that from a half, the rounding is right.
    let hundredths = value.abs() * 100.0;
    let whole = hundredths.round();
    if ((hundredths - whole).abs() - 0.5).abs() < 1e-6 {
        let exact = format!("{value:.2}");
        let short = exact.trim_end_matches('0').trim_end_matches('.');
        text.push_str(if short == "-0" { "0" } else { short });
        return;
    }
    let whole = whole as u32;
    if value < 0.0 && whole > 0 {
        text.push('-');
    }
    // Writing to a String cannot fail.
    let _ = match (whole / 100, whole % 100) {
        (ones, 0) => write!(text, "{ones}"),
        (ones, part) if part % 10 == 0 => write!(text, "{ones}.{}", part / 10),
        (ones, part) => write!(text, "{ones}.{part:02}"),
    };
}

/// Appends a command of a path with its place.
fn push_spot(data: &mut String, command: char, spot: Spot) {
    data.push(command);
    push_px(data, spot.x);
    data.push(' ');
    push_px(data, spot.y);
}

/// The part of a text that is at its place: start, middle or end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// A canvas: SVG elements, one after the other, and the places that they occupy for labels.
#[derive(Default)]
pub(super) struct Canvas {
    pub(super) body: String,
    pub(super) labels: Labels,
}

// Writing to a String cannot fail, so the results of `write!` are dropped.
impl Canvas {
    pub(super) fn raw(&mut self, element: &str) {
        self.body.push_str(element);
        self.body.push('\n');
    }

    /// Draws within an area, cut off at its edges; its corner is the origin.
    pub(super) fn clipped(&mut self, area: Area, draw: impl FnOnce(&mut Canvas)) {
        let [x, y, width, height] = [area.x, area.y, area.width, area.height].map(px);
        self.raw(&format!(r#"<svg x="{x}" y="{y}" width="{width}" height="{height}" overflow="hidden">"#));
        draw(self);
        self.raw("</svg>");
    }

    pub(super) fn line(&mut self, a: Spot, b: Spot, attributes: &str) {
        let [x1, y1, x2, y2] = [a.x, a.y, b.x, b.y].map(px);
        let _ = writeln!(self.body, r#"<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" {attributes}/>"#);
    }

    pub(super) fn circle(&mut self, at: Spot, radius: f64, attributes: &str) {
        let [x, y, radius] = [at.x, at.y, radius].map(px);
        let _ = writeln!(self.body, r#"<circle cx="{x}" cy="{y}" r="{radius}" {attributes}/>"#);
    }

    pub(super) fn area(&mut self, area: Area, attributes: &str) {
        let [x, y, width, height] = [area.x, area.y, area.width, area.height].map(px);
        let _ =
            writeln!(self.body, r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" {attributes}/>"#);
    }

    /// Draws a polyline through the places; those nearer than a third of a pixel to the one before are left out.
    pub(super) fn path(&mut self, spots: &[Spot], closed: bool, attributes: &str) {
        const STEP: f64 = 0.33;
        let Some(&first) = spots.first() else { return };
        let mut data = String::new();
        push_spot(&mut data, 'M', first);
        let mut last = first;
        for (i, &spot) in spots.iter().enumerate().skip(1) {
            if spot.distance(last) >= STEP || (i + 1 == spots.len() && !closed) {
                push_spot(&mut data, 'L', spot);
                last = spot;
            }
        }
        data.push_str(if closed { "Z" } else { "" });
        let _ = writeln!(self.body, r#"<path d="{data}" {attributes}/>"#);
    }

    /// Draws dots of one colour in one element.
    pub(super) fn dots(&mut self, spots: &[Spot], diameter: f64, colour: &str) {
        if spots.is_empty() {
            return;
        }
        let mut data = String::new();
        for &spot in spots {
            push_spot(&mut data, 'M', spot);
            data.push_str("h0");
        }
        let _ = writeln!(self.body, r#"<path d="{data}" {}{ROUND_ENDS}/>"#, outline(colour, px(diameter)));
    }

    /// Writes a text. Foreign text is cleaned and escaped here and nowhere else.
    pub(super) fn text(&mut self, at: Spot, anchor: Anchor, attributes: &str, text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
            Anchor::End => "end",
        };
        let ([x, y], text) = ([at.x, at.y].map(px), xml(text));
        let _ =
            writeln!(self.body, r#"<text x="{x}" y="{y}" text-anchor="{anchor}" {attributes}>{text}</text>"#);
    }

    /// Writes a title at the left and a note at the right of a line, each with its size; the title is cut to the space
    /// that is left.
    pub(super) fn title(&mut self, [left, right]: [f64; 2], y: f64, title: (&str, f64), note: (&str, f64)) {
        let room = right - left - text_width(note.0, note.1) - 20.0;
        let shown = shortened(title.0, (room / text_width("x", title.1)) as usize);
        self.text(Spot::new(left, y), Anchor::Start, &bold(title.1, palette::INK), &shown);
        self.text(Spot::new(right, y), Anchor::End, &font(note.1, palette::MUTED), note.0);
    }

    /// Writes a text of a size beside a point, where it hides least.
    pub(super) fn label(&mut self, text: &str, font_size: f64, attributes: &str, beside: Beside) {
        if let Some(at) = self.labels.place(text, font_size, beside) {
            self.text(at, Anchor::Middle, attributes, text);
        }
    }

    /// Draws a bar of a round length, at most `most` pixels long, with its label above and its left end at `at`.
    pub(super) fn scale_bar(&mut self, at: Spot, view: &View, most: f64, unit: &str) {
        let length = round_length(most / view.scale);
        let label = format!("{}{unit}", brief(length, 3));
        let ink = stroke(palette::INK, 1.5);
        let ends = [at, at + Vec2::new(length * view.scale, 0.0)];
        self.line(ends[0], ends[1], &ink);
        let tick = Vec2::new(0.0, 4.0);
        ends.into_iter().for_each(|end| self.line(end - tick, end + tick, &ink));
        let middle = ends[0].midpoint(ends[1]) - Vec2::new(0.0, 7.0);
        self.text(middle, Anchor::Middle, &font(12, palette::INK), &label);
    }

    /// Returns the whole document. `title` and `description` are read by screen readers.
    pub(super) fn document(self, width: f64, height: f64, title: &str, description: &str) -> String {
        format!(
            concat!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" width="{w}" height="{h}" viewBox="0 0 {w} {h}" "#,
                r#"role="img" font-family="Inter, 'Helvetica Neue', Helvetica, Arial, 'DejaVu Sans', sans-serif">"#,
                "\n<!-- {mark} -->\n<title>{title}</title>\n<desc>{description}</desc>\n",
                r#"<rect width="{w}" height="{h}" fill="{paper}"/>"#,
                "\n{body}</svg>\n"
            ),
            w = px(width),
            h = px(height),
            mark = crate::files::generator::mark(),
            title = xml(title),
            description = xml(description),
            paper = palette::PAPER,
            body = self.body
        )
    }
}

#[cfg(test)]
mod tests {
    use super::px;
    use crate::numbers::arithmetic::streams::{stream, unit};

    #[test]
    fn pixels_are_rounded_as_the_language_does() {
        let mut random = stream(5, 0);
        let halves = (-400..400).map(|i| f64::from(i) * 0.005);
        let drawn = (0..100_000).map(|i| (unit(&mut random) - 0.5) * [10.0, 2000.0, 3e6][i % 3]);
        for value in halves.chain(drawn.collect::<Vec<_>>()) {
            let exact = format!("{:.2}", value.clamp(-1e6, 1e6));
            let short = exact.trim_end_matches('0').trim_end_matches('.');
            assert_eq!(px(value), if short == "-0" { "0" } else { short }, "{value}");
        }
        assert_eq!((px(f64::NAN), px(1e300)), ("0".into(), "1000000".into()));
    }
}
