//! The overlay of a comparison: its coupler curves over the target.

use super::{Comparison, Entry, Ranked, SortKey, strokes, tables};
use crate::mechanism::{Complex, point};
use crate::report::bodies::{self, Posed};
use crate::report::canvas::{Anchor, Area, Canvas, Frame, Spot, View, bold, font, palette, px};
use crate::report::scene::{Bounds, circuits};
use crate::report::text::{clean, shortened, shortened_in_front, text_width, wrapped};
use crate::report::words::length_suffix;

/// The width of the drawing.
pub(super) const WIDTH: f64 = 760.0;
const HEIGHTS: std::ops::RangeInclusive<f64> = 260.0..=560.0;
const PADDING: f64 = 26.0;
const MARGIN: f64 = 30.0;
/// The largest number of target points that are drawn as rings; more are plain dots.
const MARKED: usize = 150;
const LINE: f64 = 20.0;

/// The drawing without heading and legend.
pub(super) struct Overlay {
    pub(super) canvas: Canvas,
    pub(super) height: f64,
    /// Whether some curves leave the frame.
    pub(super) cut: bool,
    /// The number of rows that are drawn, the best first.
    pub(super) drawn: usize,
}

/// The number of samples of a curve: a degree of the crank, below a tenth of a pixel of the arc.
const OF_A_CURVE: usize = 360;

/// Returns the coupler curves of a row, one for each circuit used.
fn curves(row: &Ranked) -> Vec<Vec<Complex>> {
    let circuits = circuits(&row.entry.candidate, OF_A_CURVE);
    circuits.iter().map(|joints| joints.iter().map(|j| j.coupler_point).collect()).collect()
}

impl Overlay {
    /// Draws the rows over their target, at the top of a canvas. Each row is a group `curve` with its number as
    /// `data-row`, from 0.
    pub(super) fn new(comparison: &Comparison) -> Self {
        let drawn = comparison.rows.len().min(strokes::MOST);
        let all: Vec<Vec<Vec<Complex>>> = comparison.rows[..drawn].iter().map(curves).collect();
        let target = comparison.bounds();
        // A curve far larger than the target would make the target too small to see.
        let limit = (target.extent() > 0.0).then(|| target.padded(1.0));
        let (mut frame, mut cut) = (target, false);
        for p in all.iter().flatten().flatten() {
            match limit.is_none_or(|limit| limit.holds(*p)) {
                true => frame.hold(*p),
                false => cut = true,
            }
        }
        let frame = frame.padded(0.0);
        let (view, height) =
            Frame { width: WIDTH, padding: PADDING, heights: HEIGHTS }.fit(&frame, Spot::new(0.0, 0.0));
        let mut canvas = Canvas::default();
        let one_target = comparison.same_target();
        canvas.clipped(Area { x: 0.0, y: 0.0, width: WIDTH, height }, |canvas| {
            // The best is drawn last, above the others.
            for (i, curves) in all.iter().enumerate().rev() {
                canvas.raw(&format!(r#"<g class="curve" data-row="{i}">"#));
                for curve in curves {
                    let spots: Vec<Spot> = curve.iter().map(|p| view.spot(*p)).collect();
                    canvas.path(&spots, true, &strokes::stroke(i));
                }
                if !one_target {
                    targets(canvas, &view, &comparison.rows[i].entry, strokes::colour(i));
                }
                canvas.raw("</g>");
            }
            if let Some(first) = comparison.rows.first().filter(|_| one_target) {
                targets(canvas, &view, &first.entry, palette::TARGET);
            }
        });
        let unit = comparison.rows.first().and_then(|row| row.entry.unit);
        canvas.scale_bar(Spot::new(14.0, height + 22.0), &view, 0.2 * WIDTH, &length_suffix(unit));
        Overlay { canvas, height: height + 34.0, cut, drawn }
    }

    /// Returns remarks on the parts that the drawing does not show, in sentences.
    pub(super) fn remarks(&self, comparison: &Comparison) -> Vec<String> {
        let mut remarks = Vec::new();
        if self.cut {
            remarks.push("Curves that reach far beyond the target are cut at the frame.".to_owned());
        }
        if self.drawn < comparison.rows.len() {
            remarks.push(format!("The best {} of {} are drawn.", self.drawn, comparison.rows.len()));
        }
        remarks
    }
}

/// Draws the target's points, the first filled; as dots if they are many; in a motion the frames of the body too.
fn targets(canvas: &mut Canvas, view: &View, entry: &Entry, colour: &str) {
    let points = &entry.target;
    let spots: Vec<Spot> =
        points.iter().filter(|p| p.iter().all(|x| x.is_finite())).map(|p| view.spot(point(*p))).collect();
    if let Some(body) = &entry.body {
        let given = points.iter().zip(&body.angle_deg).filter_map(|(p, angle)| Some((*p, (*angle)?)));
        let given: Vec<_> = given.filter(|(p, _)| p.iter().all(|x| x.is_finite())).collect();
        for (i, (p, angle)) in
            given.iter().enumerate().filter(|(i, _)| bodies::is_strong(*i, given.len(), 1.0))
        {
            let posed = Posed { at: view.spot(point(*p)), angle: angle.to_radians() };
            posed.outlined(canvas, bodies::length(&spots), colour, if i == 0 { 1.2 } else { 1.0 });
        }
    }
    if spots.len() > MARKED {
        return canvas.dots(&spots, 3.4, colour);
    }
    for (i, spot) in spots.iter().enumerate() {
        let fill = if i == 0 { colour } else { "none" };
        canvas.circle(*spot, 4.2, &format!(r#"fill="{fill}" stroke="{colour}" stroke-width="1.6""#));
    }
}

impl Comparison {
    /// Returns the coupler curves over the target as a self-contained SVG, with a legend.
    pub fn svg(&self) -> String {
        let overlay = Overlay::new(self);
        let mut canvas = Canvas::default();
        let title = self.title();
        let bold = bold(21, palette::INK);
        canvas.text(Spot::new(MARGIN, 42.0), Anchor::Start, &bold, &shortened(&title, 60));
        let muted = font(13, palette::MUTED);
        let ranked = format!("ranked by {}", tables::keys_in_words(self));
        canvas.text(Spot::new(MARGIN, 63.0), Anchor::Start, &muted, &ranked);
        let top = 78.0;
        canvas.raw(&format!(r#"<g transform="translate({} {})">"#, px(MARGIN), px(top)));
        canvas.body.push_str(&overlay.canvas.body);
        canvas.raw("</g>");
        let width = WIDTH + 2.0 * MARGIN;
        let ink = font(13, palette::INK);
        let (mut y, column) = (top + overlay.height + 24.0, WIDTH / 2.0);
        let half = overlay.drawn.div_ceil(2);
        for (i, row) in self.rows[..overlay.drawn].iter().enumerate() {
            let x = MARGIN + column * (i / half) as f64;
            let y = y + LINE * (i % half) as f64;
            canvas.line(Spot::new(x, y - 4.0), Spot::new(x + 34.0, y - 4.0), &strokes::stroke(i));
            let figures = self.legend_figures(row);
            let room = column - 60.0 - text_width(&figures, 13.0);
            let name = shortened_in_front(&clean(&row.entry.label), (room / text_width("x", 13.0)) as usize);
            let text = format!("{}  {name}  {figures}", tables::marked_rank(row));
            canvas.text(Spot::new(x + 42.0, y), Anchor::Start, &ink, &text);
        }
        y += LINE * half as f64;
        let mut notes = overlay.remarks(self);
        if self.same_target() && !self.rows.is_empty() {
            let name = clean(&self.rows[0].entry.target_name);
            notes.insert(0, format!("{}.", self.circles(&format!("the target {name}"))));
        }
        notes.extend(self.notes());
        if self.rows.iter().any(|row| row.on_front) {
            notes.push("* on the Pareto front of rms error, worst transmission angle and size".to_owned());
        }
        for note in &notes {
            for line in wrapped("", "", note, (1.06 * WIDTH / text_width("x", 13.0)) as usize).lines() {
                canvas.text(Spot::new(MARGIN, y + 6.0), Anchor::Start, &muted, line);
                y += LINE - 2.0;
            }
        }
        canvas.document(width, y + 14.0, &title, &self.description())
    }

    /// Returns the meaning of the marks of the target.
    pub(super) fn circles(&self, target: &str) -> String {
        match self.has_angles() {
            false if self.rows.iter().all(|row| !row.entry.pairs.is_empty()) => {
                format!("Curves: the way of the follower's pin; errors of its angle to {target}")
            }
            false => format!("Circles: {target}, its point 0 filled"),
            true => format!(
                "Circles: {target}, its pose 0 filled; the arms are the body's x (long) and y (short) axis"
            ),
        }
    }

    /// Returns a title such as `4 linkages on k18`.
    pub(super) fn title(&self) -> String {
        let n = self.rows.len();
        let counted = if n == 1 { "1 linkage".to_owned() } else { format!("{n} linkages") };
        match self.rows.first().filter(|_| self.same_target()) {
            Some(row) => format!("{counted} on {}", clean(&row.entry.target_name)),
            None if n == 0 => "nothing to compare".to_owned(),
            None => format!("{counted} on different targets"),
        }
    }

    /// Returns the figures of the legend, such as `rms 0.0224 mm`.
    pub(super) fn legend_figures(&self, row: &Ranked) -> String {
        let rms = tables::shown(row, SortKey::Rms, 3);
        let accepted = if row.entry.candidate.accepted { "" } else { ", not accepted" };
        format!("rms {rms}{}{accepted}", row.entry.error_unit())
    }

    /// Returns a description of the drawing in words, for those who do not see it.
    pub(super) fn description(&self) -> String {
        const NAMED: usize = 6;
        let one =
            |row: &Ranked| format!("{}. {}: {}", row.rank, clean(&row.entry.label), self.legend_figures(row));
        let mut text = self.rows.iter().take(NAMED).map(one).collect::<Vec<_>>().join("; ");
        if self.rows.len() > NAMED {
            text.push_str(&format!("; and {} more", self.rows.len() - NAMED));
        }
        text
    }

    /// Returns the box of all targets; of functions, that of the pivots and of the circles of the pins.
    fn bounds(&self) -> Bounds {
        let reached = |row: &Ranked| {
            let linkage = &row.entry.candidate.linkage;
            let follower = linkage.four_bar().map(|l| (l.follower_pivot(), l.follower()));
            let circles = [(linkage.crank_pivot(), linkage.crank())].into_iter().chain(follower);
            let is_drawn = !row.entry.pairs.is_empty();
            let ends = circles.map(|(pivot, r)| [pivot - Complex::new(r, r), pivot + Complex::new(r, r)]);
            ends.flatten().filter(move |_| is_drawn)
        };
        let targets = self.rows.iter().flat_map(|row| &row.entry.target).map(|p| point(*p));
        Bounds::of(targets.chain(self.rows.iter().flat_map(reached)))
    }
}
