//! The curve that an element draws, in its own coordinates: line segments, quadratic and cubic curves.
//!
//! Arcs become cubics whose distance from the ellipse is below 1e-11 of its radius.

use super::MAX_SEGMENTS;
use super::arc_length::hull;
use super::pen::Pen;
use super::viewport::px_of;
use crate::files::diagnostic::{Checked, Diagnostic, quoted};
use kurbo::{Affine, Arc, CubicBez, Line, PathSeg, Point, SvgArc, Vec2};
use roxmltree::Node;
use std::f64::consts::TAU;
use svgtypes::{Length, LengthUnit, NumberListParser, PathParser};

/// The largest distance of a cubic from its ellipse, in radii.
const ARC_TOLERANCE: f64 = 1e-11;
/// The help text for lists of points.
const PAIRS: &str = "write pairs of numbers: 0,0 10,5 20,0";

/// One stroke of a pen.
#[derive(Clone, Debug, Default)]
pub(super) struct Outline {
    pub segments: Vec<PathSeg>,
    /// Whether it is drawn as closed.
    pub closed: bool,
}

impl Outline {
    pub fn transformed(&self, by: Affine) -> Outline {
        Outline { segments: self.segments.iter().map(|s| by * *s).collect(), closed: self.closed }
    }

    /// Returns the largest coordinate of its control points; not finite if one of them is not.
    pub fn reach(&self) -> f64 {
        let of = |p: &Point| if p.is_finite() { p.x.abs().max(p.y.abs()) } else { f64::INFINITY };
        self.segments.iter().map(hull).fold(0.0, |reach, b| {
            let corners = [Point::new(b.x0, b.y0), Point::new(b.x1, b.y1)];
            // A box of NaN is hidden by min and max: the ends are not.
            corners.iter().map(of).fold(reach, f64::max)
        })
    }

    /// Returns whether every control point is finite.
    fn is_finite(&self) -> bool {
        self.segments.iter().all(|segment| {
            let cubic = segment.to_cubic();
            [cubic.p0, cubic.p1, cubic.p2, cubic.p3].iter().all(|p| p.is_finite())
        })
    }

    fn line_to(&mut self, from: Point, to: Point) {
        self.segments.push(PathSeg::Line(Line::new(from, to)));
    }

    fn arc(&mut self, arc: &Arc) {
        let mut from = arc.center + ellipse_point(arc.radii, arc.x_rotation, arc.start_angle);
        let tolerance = ARC_TOLERANCE * arc.radii.x.abs().max(arc.radii.y.abs());
        arc.to_cubic_beziers(tolerance, |p1, p2, p3| {
            self.segments.push(PathSeg::Cubic(CubicBez::new(from, p1, p2, p3)));
            from = p3;
        });
    }

    /// Adds an elliptical arc of a path (SVG 1.1, F.6): scaled so that its chord is 1, because kurbo's tests for
    /// straight arcs are absolute.
    pub fn arc_to(
        &mut self,
        from: Point,
        to: Point,
        radii: Vec2,
        rotation_deg: f64,
        large_arc: bool,
        sweep: bool,
    ) {
        let chord = to.distance(from);
        let (rx, ry) = (radii.x.abs(), radii.y.abs());
        if chord == 0.0 {
            return;
        }
        if rx == 0.0 || ry == 0.0 {
            return self.line_to(from, to);
        }
        // The standard scales up radii that are too small to reach; only their ratio matters then.
        let largest = rx.max(ry);
        let scale = if largest < 0.5 * chord { 0.5 / largest } else { 1.0 / chord };
        let unit = SvgArc {
            from: Point::ORIGIN,
            to: ((to - from) / chord).to_point(),
            radii: Vec2::new(rx, ry) * scale,
            x_rotation: rotation_deg.rem_euclid(360.0).to_radians(),
            large_arc,
            sweep,
        };
        let Some(arc) = Arc::from_svg_arc(&unit) else { return self.line_to(from, to) };
        let mut one = Outline::default();
        one.arc(&arc);
        let back = Affine::translate(from.to_vec2()) * Affine::scale(chord);
        let first = self.segments.len();
        self.segments.extend(one.segments.iter().map(|s| back * *s));
        // The ends are exactly as they were written.
        if let Some(PathSeg::Cubic(cubic)) = self.segments.get_mut(first) {
            cubic.p0 = from;
        }
        if let Some(PathSeg::Cubic(cubic)) = self.segments.last_mut() {
            cubic.p3 = to;
        }
    }
}

fn ellipse_point(radii: Vec2, rotation: f64, angle: f64) -> Vec2 {
    let (u, v) = (radii.x * angle.cos(), radii.y * angle.sin());
    let (sin, cos) = rotation.sin_cos();
    Vec2::new(u * cos - v * sin, u * sin + v * cos)
}

/// An element with the context in which its attributes are read.
pub(super) struct Scope<'a, 'input> {
    pub file: &'a str,
    pub text: &'a str,
    pub node: Node<'a, 'input>,
    /// The width and height to which percentages refer.
    pub extent: Option<Vec2>,
}

impl Scope<'_, '_> {
    /// Returns the curve of a shape; `None` if it draws nothing.
    pub fn outline(&self) -> Checked<Option<Outline>> {
        let outline = match self.node.tag_name().name() {
            "path" => self.path()?,
            "polyline" => self.polyline(false)?,
            "polygon" => self.polyline(true)?,
            "circle" => self.ellipse("r", "r")?,
            "ellipse" => self.ellipse("rx", "ry")?,
            "rect" => self.rect()?,
            "line" => self.line()?,
            _ => None,
        };
        match outline {
            Some(outline) if !outline.is_finite() => {
                Err(self.refuse("a number of this shape is too large", "use numbers up to 1e12"))
            }
            other => Ok(other.filter(|o| !o.segments.is_empty())),
        }
    }

    fn refuse(&self, message: impl Into<String>, help: &str) -> Box<Diagnostic> {
        let range = self.node.range();
        let own = self.text.get(range.clone()).unwrap_or("");
        let end = range.start + own.find([' ', '\n', '\r', '\t', '>', '/']).unwrap_or(own.len());
        Box::new(Diagnostic::new(self.file, self.text, message).at(range.start..end).with_help(help))
    }

    fn at(&self, key: &str, message: String, help: &str) -> Box<Diagnostic> {
        let diagnostic = self.refuse(message, help);
        match self.node.attribute_node(key) {
            Some(attribute) => Box::new(diagnostic.at(attribute.range_value())),
            None => diagnostic,
        }
    }

    /// Returns a diagnostic about an unreadable attribute, at the character at which the reading stopped.
    pub fn at_error(&self, key: &str, what: &str, error: &svgtypes::Error, example: &str) -> Box<Diagnostic> {
        use svgtypes::Error::{InvalidChar, InvalidNumber, InvalidString, UnexpectedData};
        let help = format!("export the drawing again; this is how a {what} is written: {example}");
        let value = self.node.attribute_node(key).map(|a| (a.value(), a.range_value()));
        let position = match error {
            UnexpectedData(at) | InvalidChar(_, at) | InvalidString(_, at) | InvalidNumber(at) => Some(*at),
            _ => None,
        };
        // If the text is the same in the file as in the value; positions count characters from 1.
        if let (Some(position), Some((value, range))) = (position, value)
            && self.text.get(range.clone()) == Some(value)
            && let Some((start, c)) = value.char_indices().nth(position.saturating_sub(1))
        {
            let start = range.start + start;
            let diagnostic =
                Diagnostic::new(self.file, self.text, format!("this {what} cannot be read from here on"));
            return Box::new(diagnostic.at(start..start + c.len_utf8()).with_help(help));
        }
        self.at(key, format!("this {what} cannot be read: {error}"), &help)
    }

    /// Returns a length in user units; `axis` is the axis to which a percentage refers: x, y or r.
    pub fn length(&self, key: &str, axis: char) -> Checked<Option<f64>> {
        let Some(text) = self.node.attribute(key).filter(|text| text.trim() != "auto") else {
            return Ok(None);
        };
        let refuse = |help: &str| Err(self.at(key, format!("{key} = {} is no length", quoted(text)), help));
        let Ok(length) = text.trim().parse::<Length>() else { return refuse("write a number such as 12.5") };
        let of = |e: Vec2| match axis {
            'x' => e.x,
            'y' => e.y,
            _ => (0.5 * (e.x * e.x + e.y * e.y)).sqrt(),
        };
        let value = match (length.unit, self.extent) {
            (LengthUnit::Percent, Some(extent)) => length.number / 100.0 * of(extent),
            (LengthUnit::Percent, None) => {
                return refuse("of what? give the drawing a viewBox, or write a number");
            }
            (unit, _) => match px_of(unit) {
                Some(px) => px * length.number,
                None => return refuse("lengths in em and ex are not read; write a number"),
            },
        };
        if value.is_finite() { Ok(Some(value)) } else { refuse("write a finite number") }
    }

    fn or_zero(&self, key: &str, axis: char) -> Checked<f64> {
        Ok(self.length(key, axis)?.unwrap_or(0.0))
    }

    /// Returns a length that must not be negative.
    fn size(&self, key: &str, axis: char) -> Checked<Option<f64>> {
        match self.length(key, axis)? {
            Some(value) if value < 0.0 => {
                Err(self.at(key, format!("{key} = {value} is negative"), "write 0 or more"))
            }
            other => Ok(other),
        }
    }

    fn line(&self) -> Checked<Option<Outline>> {
        let from = Point::new(self.or_zero("x1", 'x')?, self.or_zero("y1", 'y')?);
        let to = Point::new(self.or_zero("x2", 'x')?, self.or_zero("y2", 'y')?);
        let mut outline = Outline::default();
        if from != to {
            outline.line_to(from, to);
        }
        Ok(Some(outline))
    }

    fn ellipse(&self, x_radius: &str, y_radius: &str) -> Checked<Option<Outline>> {
        let axis = |key: &str, own: char| if key == "r" { 'r' } else { own };
        let rx = self.size(x_radius, axis(x_radius, 'x'))?;
        let ry = self.size(y_radius, axis(y_radius, 'y'))?;
        let (rx, ry) = (rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
        if rx == 0.0 || ry == 0.0 {
            return Ok(None);
        }
        let centre = Point::new(self.or_zero("cx", 'x')?, self.or_zero("cy", 'y')?);
        let mut outline = Outline { closed: true, ..Outline::default() };
        outline.arc(&Arc::new(centre, (rx, ry), 0.0, TAU, 0.0));
        Ok(Some(outline))
    }

    /// Returns the outline of a rectangle, from the end of its upper left corner, clockwise with y down (SVG 1.1, 9.2).
    fn rect(&self) -> Checked<Option<Outline>> {
        let (x, y) = (self.or_zero("x", 'x')?, self.or_zero("y", 'y')?);
        let (w, h) = (self.size("width", 'x')?.unwrap_or(0.0), self.size("height", 'y')?.unwrap_or(0.0));
        if w == 0.0 || h == 0.0 {
            return Ok(None);
        }
        let (rx, ry) = (self.size("rx", 'x')?, self.size("ry", 'y')?);
        let rx_used = rx.or(ry).unwrap_or(0.0).min(0.5 * w);
        let ry_used = ry.or(rx).unwrap_or(0.0).min(0.5 * h);
        let r = if rx_used == 0.0 || ry_used == 0.0 { Vec2::ZERO } else { Vec2::new(rx_used, ry_used) };
        let mut outline = Outline { closed: true, ..Outline::default() };
        let mut at = Point::new(x + r.x, y);
        let sides = [
            (Point::new(x + w - r.x, y), Point::new(x + w, y + r.y)),
            (Point::new(x + w, y + h - r.y), Point::new(x + w - r.x, y + h)),
            (Point::new(x + r.x, y + h), Point::new(x, y + h - r.y)),
            (Point::new(x, y + r.y), Point::new(x + r.x, y)),
        ];
        for (side, corner) in sides {
            if side != at {
                outline.line_to(at, side);
            }
            outline.arc_to(side, corner, r, 0.0, false, true);
            at = corner;
        }
        Ok(Some(outline))
    }

    fn polyline(&self, closed: bool) -> Checked<Option<Outline>> {
        let text = self.node.attribute("points").unwrap_or("");
        let mut numbers = Vec::new();
        for number in NumberListParser::from(text) {
            if numbers.len() > 2 * MAX_SEGMENTS {
                return Err(self.too_many());
            }
            let Ok(number) = number else {
                let message = format!("these points cannot be read after {} numbers", numbers.len());
                return Err(self.at("points", message, PAIRS));
            };
            numbers.push(number);
        }
        if numbers.len() % 2 == 1 {
            let message = format!("there are {} numbers here: a point has two", numbers.len());
            return Err(self.at("points", message, PAIRS));
        }
        let points: Vec<Point> = numbers.chunks_exact(2).map(|pair| Point::new(pair[0], pair[1])).collect();
        let mut outline = Outline { closed, ..Outline::default() };
        for pair in points.windows(2) {
            outline.line_to(pair[0], pair[1]);
        }
        if let (true, [first, .., last]) = (closed, points.as_slice()) {
            outline.line_to(*last, *first);
        }
        Ok(Some(outline))
    }

    fn too_many(&self) -> Box<Diagnostic> {
        self.refuse(
            format!("this shape has more than {MAX_SEGMENTS} segments"),
            "simplify the path in your editor",
        )
    }

    fn path(&self) -> Checked<Option<Outline>> {
        let text = self.node.attribute("d").unwrap_or("");
        let mut pen = Pen::default();
        for (i, segment) in PathParser::from(text).enumerate() {
            if i >= MAX_SEGMENTS {
                return Err(self.too_many());
            }
            let segment = segment.map_err(|error| self.at_error("d", "path", &error, "M 0 0 L 10 5 z"))?;
            pen.draw(segment);
        }
        let mut strokes = pen.strokes.into_iter().filter(|stroke| !stroke.segments.is_empty());
        let first = strokes.next();
        match strokes.count() {
            0 => Ok(first),
            more => Err(self.refuse(
                format!("this path has {} separate strokes; a coupler curve is one", more + 1),
                "break the path apart in your editor (Inkscape: Path > Break Apart) and name one with svg_id",
            )),
        }
    }
}
