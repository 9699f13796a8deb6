//! SVG drawings in true millimetres: width and height in mm, one unit of the view box a millimetre, y turned down.

use super::model::Model;
use super::skeleton::Skeleton;
use crate::mechanism::plates::{Edge, Placement, Plate, Slot};
use crate::mechanism::{Complex, LoopJoints};
use crate::report::scene::Bounds;
use crate::report::text::xml;

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
        self.spot(p).join(" ")
    }

    fn spot(&self, p: Complex) -> [String; 2] {
        [mm(p.re - self.low.re), mm(self.high.im - p.im)]
    }

    fn push(&mut self, line: &str) {
        self.body.push_str(line);
        self.body.push('\n');
    }

    fn path(&mut self, points: &[Complex], closed: bool, attributes: &str) {
        let points: Vec<String> = points.iter().map(|p| self.at(*p)).collect();
        let close = if closed { "Z" } else { "" };
        self.push(&format!(r#"<path {attributes} d="M{}{close}"/>"#, points.join("L")));
    }

    fn outline(&mut self, id: &str, edges: &[Edge]) {
        let id = if id.is_empty() { String::new() } else { format!(r#"id="{id}" "#) };
        let start = edges.first().map(|edge| format!("M{}", self.at(edge.from())));
        let step = |edge: &Edge| match *edge {
            Edge::Line { to, .. } => format!("L{}", self.at(to)),
            // At most half a turn, counter-clockwise, which it also looks like after y is turned down.
            Edge::Arc { from, to, centre, .. } => {
                let r = mm((from - centre).norm());
                format!("A{r} {r} 0 0 0 {}", self.at(to))
            }
        };
        let data: String = start.into_iter().chain(edges.iter().map(step)).collect();
        self.push(&format!(r#"<path {id}d="{data}Z"/>"#));
    }

    fn circle(&mut self, id: &str, centre: Complex, radius: f64) {
        let id = if id.is_empty() { String::new() } else { format!(r#"id="{id}" "#) };
        let [x, y] = self.spot(centre);
        self.push(&format!(r#"<circle {id}cx="{x}" cy="{y}" r="{}"/>"#, mm(radius)));
    }

    /// Draws texts in letters of a height, each at its place.
    fn labels(&mut self, letter: f64, attributes: &str, texts: impl IntoIterator<Item = (Complex, String)>) {
        let height = mm(letter);
        self.push(&format!(
            r#"<g id="labels" font-family="sans-serif" font-size="{height}" fill="{LINKS}"{attributes}>"#
        ));
        for (at, text) in texts {
            let [x, y] = self.spot(at);
            self.push(&format!(r#"<text x="{x}" y="{y}">{}</text>"#, xml(&text)));
        }
        self.push("</g>");
    }

    /// Returns the whole document; foreign text is escaped here.
    fn document(self, title: &str, description: &str) -> String {
        let size = self.size();
        format!(
            concat!(
                r#"<svg xmlns="http://www.w3.org/2000/svg" version="1.1" "#,
                r#"width="{w}mm" height="{h}mm" viewBox="0 0 {w} {h}">"#,
                "\n<!-- {m} -->\n<title>{t}</title>\n<desc>{d}</desc>\n{b}</svg>\n"
            ),
            w = mm(size.re),
            h = mm(size.im),
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
pub(super) fn drawing(model: &Model<'_>, at: &LoopJoints) -> String {
    let skeleton = Skeleton::of(model, at);
    let all: Vec<Complex> = skeleton
        .points()
        .chain(model.curves.iter().flatten().copied())
        .chain(model.target.iter().copied())
        .collect();
    let bare = Page::around(all.iter().copied(), 0.0).size();
    let extent = bare.re.max(bare.im);
    let mut page = Page::around(all, 0.04 * extent + model.holes.pins);
    let (thin, thick, letter) = (mm(0.002 * extent), mm(0.004 * extent), 0.03 * extent);
    let group = |id: &str, rest: &str| format!(r#"<g id="{id}" {rest} stroke-linejoin="round">"#);
    let line = |colour: &str, width: &str| {
        format!(r#"fill="none" stroke="{colour}" stroke-width="{width}" stroke-linecap="round""#)
    };

    page.push(&group("skeleton", &line(LINKS, &thick)));
    let dashes = mm(0.012 * extent);
    if !skeleton.ground.is_empty() {
        page.path(&skeleton.ground, false, &format!(r#"id="ground" stroke-dasharray="{dashes} {dashes}""#));
    }
    page.path(&skeleton.crank, false, r#"id="crank""#);
    let is_arm = skeleton.line.is_some();
    if let Some(follower) = skeleton.follower {
        page.path(&follower, false, if is_arm { r#"id="arm""# } else { r#"id="follower""# });
    }
    if !skeleton.coupler.is_empty() {
        page.path(&skeleton.coupler, true, r#"id="coupler""#);
    }
    for (name, corners) in &skeleton.links {
        page.path(corners, corners.len() > 2, &format!(r#"id="{name}""#));
    }
    page.push("</g>");
    if let Some(line_ends) = skeleton.line {
        page.push(&group("slider", &line(LINKS, &thin)));
        let id = if skeleton.ground.is_empty() { "rail" } else { "rod" };
        page.path(
            &line_ends,
            false,
            &format!(r#"id="{id}" stroke-dasharray="{dashes} {}""#, mm(0.004 * extent)),
        );
        page.outline("slot", &skeleton.slot);
        page.path(&skeleton.block, true, r#"id="block""#);
        page.push("</g>");
    }
    page.push(&group("curve", &line(CURVE, &thin)));
    for curve in &model.curves {
        page.path(curve, true, "");
    }
    page.push("</g>");
    page.push(&group("joints", &line(LINKS, &thin)));
    for (name, at) in &skeleton.joints {
        page.circle(name, *at, 0.5 * model.holes.drawn(name));
    }
    page.push("</g>");
    if !model.target.is_empty() {
        page.push(&group("target", &line(TARGET, &thin)));
        for at in &model.target {
            page.circle("", *at, 0.006 * extent);
        }
        for frame in &model.wanted {
            page.path(frame, false, "");
        }
        page.push("</g>");
    }
    if let Some(frame) = model.body(at) {
        page.push(&group("body", &line(CURVE, &thick)));
        page.path(&frame, false, "");
        page.push("</g>");
    }
    let aside = 0.5 * model.holes.pins + 0.2 * letter;
    let label = |(name, at): &(&str, Complex)| (at + Complex::new(aside, aside), (*name).to_owned());
    page.labels(letter, "", skeleton.joints.iter().map(label));
    page.document(&model.subject.title(), &model.heading())
}

/// Draws the plates side by side, each in its own group; the page is the sheet, if there is one.
pub(super) fn plates(model: &Model<'_>, plates: &[(Plate, Placement)]) -> String {
    let corners = plates.iter().flat_map(|(plate, at)| model.cut(plate).bounds().map(|corner| at.of(corner)));
    let mut page = match model.settings.sheet_mm {
        Some([width, height]) => Page::around([Complex::default(), Complex::new(width, height)], 0.0),
        None => Page::around(corners, model.gap),
    };
    let size = page.size();
    let thin = mm(0.001 * size.re.max(size.im));
    for (plate, at) in plates {
        let name = plate.link.name();
        page.push(&format!(r#"<g id="{name}" fill="none" stroke="{CURVE}" stroke-width="{thin}">"#));
        let edges: Vec<Edge> = model.cut(plate).outline().iter().map(|edge| edge.placed(at)).collect();
        page.outline("", &edges);
        let slot = plate.slot_outline(model.cut_slot());
        if !slot.is_empty() {
            let placed: Vec<Edge> = slot.iter().map(|edge| edge.placed(at)).collect();
            page.outline(&format!("{name}-slot"), &placed);
        }
        for (joints, hole) in plate.distinct_holes() {
            page.circle(&format!("{name}-{joints}"), at.of(hole), model.cut_hole(plate.link, &joints));
        }
        page.push("</g>");
    }
    let letter = (0.6 * model.margin).min(0.05 * size.re.max(size.im));
    let holes = plates.iter().flat_map(|(plate, at)| {
        plate.distinct_holes().into_iter().map(|(joints, hole)| {
            let above = 0.5 * model.holes.of(plate.link, &joints) + 0.25 * letter;
            (at.of(hole) + Complex::new(0.0, above), joints)
        })
    });
    let ends = plates.iter().flat_map(|(plate, at)| {
        let above = Complex::new(0.0, 0.5 * model.holes.pins + 0.25 * letter);
        let ends = plate.slot.into_iter().flat_map(|slot| slot.ends.into_iter().zip(Slot::LETTERS));
        ends.map(move |(end, name)| (at.of(end) + above, name.to_owned()))
    });
    page.labels(letter, r#" text-anchor="middle""#, holes.chain(ends));
    let heading = format!("{}, plates cut with a kerf of {} mm", model.heading(), mm(model.kerf));
    page.document(&model.subject.title(), &heading)
}
