//! SVG drawings in true millimetres: width and height in mm, one unit of the view box a millimetre, y turned down.

use super::model::Model;
use crate::mechanism::plates::{Edge, Placement, Plate};
use crate::mechanism::{Complex, Joints};
use crate::report::scene::{Bounds, all_joints};
use crate::report::text::xml;
use std::fmt::Write;

const LINKS: &str = "#34495e";
const CURVE: &str = "#c0392b";
const TARGET: &str = "#2471a3";

/// A page: a rectangle of the plane with its drawing.
struct Page {
    low: Complex,
    high: Complex,
    body: String,
}

impl Page {
    /// Returns an empty page around the points with a margin `room`.
    fn around(points: impl IntoIterator<Item = Complex>, room: f64) -> Self {
        let [low, high] = Bounds::of(points).corners();
        let room = Complex::new(room, room);
        Page { low: low - room, high: high + room, body: String::new() }
    }

    fn size(&self) -> Complex {
        self.high - self.low
    }

    /// Returns the coordinates `x y` on the page.
    fn at(&self, p: Complex) -> String {
        format!("{} {}", mm(p.re - self.low.re), mm(self.high.im - p.im))
    }

    fn push(&mut self, line: &str) {
        self.body.push_str(line);
        self.body.push('\n');
    }

    fn path(&mut self, points: &[Complex], closed: bool, attributes: &str) {
        let mut data = String::new();
        for (i, p) in points.iter().enumerate() {
            data.push_str(if i == 0 { "M" } else { "L" });
            data.push_str(&self.at(*p));
        }
        data.push_str(if closed { "Z" } else { "" });
        self.push(&format!(r#"<path {attributes} d="{data}"/>"#));
    }

    fn outline(&mut self, edges: &[Edge]) {
        let mut data = String::new();
        for (i, edge) in edges.iter().enumerate() {
            if i == 0 {
                let _ = write!(data, "M{}", self.at(edge.from()));
            }
            match *edge {
                Edge::Line { to, .. } => {
                    let _ = write!(data, "L{}", self.at(to));
                }
                // At most half a turn, counter-clockwise, which it also looks like after y is turned down.
                Edge::Arc { from, to, centre, .. } => {
                    let r = mm((from - centre).norm());
                    let _ = write!(data, "A{r} {r} 0 0 0 {}", self.at(to));
                }
            }
        }
        self.push(&format!(r#"<path d="{data}Z"/>"#));
    }

    fn circle(&mut self, id: &str, centre: Complex, radius: f64) {
        let id = if id.is_empty() { String::new() } else { format!(r#"id="{id}" "#) };
        let (x, y) = (mm(centre.re - self.low.re), mm(self.high.im - centre.im));
        self.push(&format!(r#"<circle {id}cx="{x}" cy="{y}" r="{}"/>"#, mm(radius)));
    }

    fn text(&mut self, at: Complex, text: &str) {
        let (x, y) = (mm(at.re - self.low.re), mm(self.high.im - at.im));
        self.push(&format!(r#"<text x="{x}" y="{y}">{}</text>"#, xml(text)));
    }

    /// Returns the whole document; foreign text is escaped here.
    fn document(self, title: &str, description: &str) -> String {
        let size = self.size();
        let (width, height) = (mm(size.re), mm(size.im));
        format!(
            concat!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" version="1.1" "#,
                r#"width="{w}mm" height="{h}mm" viewBox="0 0 {w} {h}">"#,
                "\n<!-- {m} -->\n<title>{t}</title>\n<desc>{d}</desc>\n{b}</svg>\n"
            ),
            w = width,
            h = height,
            m = crate::files::generator::mark(),
            t = xml(title),
            d = xml(description),
            b = self.body
        )
    }
}

/// Returns a length in millimetres with nine decimals at most, without an exponent.
fn mm(x: f64) -> String {
    let text = format!("{x:.9}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Draws the skeleton, coupler curve, joints and target.
pub(super) fn drawing(model: &Model<'_>, joints: &Joints) -> String {
    let linkage = &model.linkage;
    let [a, b, c, d, p] = all_joints(linkage, joints);
    let all = [a, b, c, d, p].into_iter();
    let all: Vec<Complex> =
        all.chain(model.curves.iter().flatten().copied()).chain(model.target.iter().copied()).collect();
    let bare = Page::around(all.iter().copied(), 0.0).size();
    let extent = bare.re.max(bare.im);
    let mut page = Page::around(all, 0.04 * extent + model.hole);
    let (thin, thick, letter) = (mm(0.002 * extent), mm(0.004 * extent), 0.03 * extent);
    let group = |id: &str, rest: &str| format!(r#"<g id="{id}" {rest} stroke-linejoin="round">"#);
    let line = |colour: &str, width: &str| {
        format!(r#"fill="none" stroke="{colour}" stroke-width="{width}" stroke-linecap="round""#)
    };

    page.push(&group("skeleton", &line(LINKS, &thick)));
    page.path(&[a, b], false, &format!(r#"id="ground" stroke-dasharray="{0} {0}""#, mm(0.012 * extent)));
    page.path(&[a, c], false, r#"id="crank""#);
    page.path(&[b, d], false, r#"id="follower""#);
    page.path(&[c, d, p], true, r#"id="coupler""#);
    page.push("</g>");
    page.push(&group("curve", &line(CURVE, &thin)));
    for curve in &model.curves {
        page.path(curve, true, "");
    }
    page.push("</g>");
    page.push(&group("joints", &line(LINKS, &thin)));
    for (name, at) in [("A", a), ("B", b), ("C", c), ("D", d), ("P", p)] {
        page.circle(name, at, 0.5 * model.hole);
    }
    page.push("</g>");
    if !model.target.is_empty() {
        page.push(&group("target", &line(TARGET, &thin)));
        for at in &model.target {
            page.circle("", *at, 0.006 * extent);
        }
        page.push("</g>");
    }
    page.push(&format!(
        r#"<g id="labels" font-family="sans-serif" font-size="{}" fill="{LINKS}">"#,
        mm(letter)
    ));
    let aside = Complex::new(0.5 * model.hole + 0.2 * letter, 0.5 * model.hole + 0.2 * letter);
    for (name, at) in [("A", a), ("B", b), ("C", c), ("D", d), ("P", p)] {
        page.text(at + aside, name);
    }
    page.push("</g>");
    page.document(&model.subject.title(), &model.heading())
}

/// Draws the plates side by side, each in its own group.
pub(super) fn plates(model: &Model<'_>, plates: &[(Plate, Placement)]) -> String {
    let corners = plates.iter().flat_map(|(plate, at)| model.cut(plate).bounds().map(|corner| at.of(corner)));
    let corners: Vec<Complex> = corners.collect();
    let mut page = Page::around(corners, model.gap);
    let size = page.size();
    let thin = mm(0.001 * size.re.max(size.im));
    for (plate, at) in plates {
        let name = plate.link.name();
        page.push(&format!(r#"<g id="{name}" fill="none" stroke="{CURVE}" stroke-width="{thin}">"#));
        let edges: Vec<Edge> = model.cut(plate).outline().iter().map(|edge| edge.placed(at)).collect();
        page.outline(&edges);
        for (joints, hole) in plate.distinct_holes() {
            page.circle(&format!("{name}-{joints}"), at.of(hole), model.cut_hole());
        }
        page.push("</g>");
    }
    let letter = (0.6 * model.margin).min(0.05 * size.re.max(size.im));
    page.push(&format!(
        r#"<g id="labels" font-family="sans-serif" font-size="{}" fill="{LINKS}" text-anchor="middle">"#,
        mm(letter)
    ));
    for (plate, at) in plates {
        for (joints, hole) in plate.distinct_holes() {
            let above = Complex::new(0.0, 0.5 * model.hole + 0.25 * letter);
            page.text(at.of(hole) + above, &joints);
        }
    }
    page.push("</g>");
    let heading = format!("{}, plates cut with a kerf of {} mm", model.heading(), mm(model.kerf));
    page.document(&model.subject.title(), &heading)
}
