//! Converts a shape into the curve that it draws, in its own coordinates: lines and cubic curves.

use super::element::Element;
use super::pen::{Pen, arc_to, tolerance};
use crate::files::diagnostic::{Checked, Diagnostic};
use crate::mechanism::MAX_MAGNITUDE;
use kurbo::{Arc, BezPath, PathEl, Point, Shape, Vec2};
use std::f64::consts::TAU;
use svgtypes::{NumberListParser, PathParser};

/// The largest number of segments of a shape, arcs counted once.
const MAX_SEGMENTS: usize = 100_000;
/// The help text for lists of points.
const PAIRS: &str = "write pairs of numbers: 0,0 10,5 20,0";

impl Element<'_, '_> {
    /// Returns the curve of a shape; `None` if it draws nothing.
    pub fn outline(&self) -> Checked<Option<BezPath>> {
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
                let help = format!("use numbers up to {MAX_MAGNITUDE:e}");
                Err(self.refuse("a number of this shape is too large", &help))
            }
            other => Ok(other.filter(|outline| outline.segments().next().is_some())),
        }
    }

    fn line(&self) -> Checked<Option<BezPath>> {
        let from = Point::new(self.or_zero("x1", 'x')?, self.or_zero("y1", 'y')?);
        let to = Point::new(self.or_zero("x2", 'x')?, self.or_zero("y2", 'y')?);
        Ok((from != to).then(|| BezPath::from_vec(vec![PathEl::MoveTo(from), PathEl::LineTo(to)])))
    }

    fn ellipse(&self, x_radius: &str, y_radius: &str) -> Checked<Option<BezPath>> {
        let axis = |key: &str, own: char| if key == "r" { 'r' } else { own };
        let rx = self.size(x_radius, axis(x_radius, 'x'))?;
        let ry = self.size(y_radius, axis(y_radius, 'y'))?;
        let (rx, ry) = (rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
        if rx == 0.0 || ry == 0.0 {
            return Ok(None);
        }
        let centre = Point::new(self.or_zero("cx", 'x')?, self.or_zero("cy", 'y')?);
        let arc = Arc::new(centre, (rx, ry), 0.0, TAU, 0.0);
        Ok(Some(arc.to_path(tolerance(&arc))))
    }

    /// Returns the outline of a rectangle, from the end of its upper left corner, clockwise with y down (SVG 1.1, 9.2).
    fn rect(&self) -> Checked<Option<BezPath>> {
        let (x, y) = (self.or_zero("x", 'x')?, self.or_zero("y", 'y')?);
        let (w, h) = (self.size("width", 'x')?.unwrap_or(0.0), self.size("height", 'y')?.unwrap_or(0.0));
        if w == 0.0 || h == 0.0 {
            return Ok(None);
        }
        let (rx, ry) = (self.size("rx", 'x')?, self.size("ry", 'y')?);
        let rx_used = rx.or(ry).unwrap_or(0.0).min(0.5 * w);
        let ry_used = ry.or(rx).unwrap_or(0.0).min(0.5 * h);
        let r = if rx_used == 0.0 || ry_used == 0.0 { Vec2::ZERO } else { Vec2::new(rx_used, ry_used) };
        let mut at = Point::new(x + r.x, y);
        let mut outline = BezPath::new();
        outline.move_to(at);
        let sides = [
            (Point::new(x + w - r.x, y), Point::new(x + w, y + r.y)),
            (Point::new(x + w, y + h - r.y), Point::new(x + w - r.x, y + h)),
            (Point::new(x + r.x, y + h), Point::new(x, y + h - r.y)),
            (Point::new(x, y + r.y), Point::new(x + r.x, y)),
        ];
        for (side, corner) in sides {
            if side != at {
                outline.line_to(side);
            }
            arc_to(&mut outline, side, corner, r, 0.0, false, true);
            at = corner;
        }
        Ok(Some(outline))
    }

    fn polyline(&self, closed: bool) -> Checked<Option<BezPath>> {
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
        let corners = numbers.chunks_exact(2).map(|pair| Point::new(pair[0], pair[1]));
        let mut outline: BezPath = corners
            .enumerate()
            .map(|(i, p)| if i == 0 { PathEl::MoveTo(p) } else { PathEl::LineTo(p) })
            .collect();
        if closed && !outline.is_empty() {
            outline.close_path();
        }
        Ok(Some(outline))
    }

    fn too_many(&self) -> Box<Diagnostic> {
        self.refuse(
            format!("this shape has more than {MAX_SEGMENTS} segments"),
            "simplify the path in your editor",
        )
    }

    fn path(&self) -> Checked<Option<BezPath>> {
        let text = self.node.attribute("d").unwrap_or("");
        let mut pen = Pen::default();
        for (i, segment) in PathParser::from(text).enumerate() {
            if i >= MAX_SEGMENTS {
                return Err(self.too_many());
            }
            let segment = segment.map_err(|error| self.at_error("d", "path", &error, "M 0 0 L 10 5 z"))?;
            pen.draw(segment);
        }
        let (outline, strokes) = pen.drawn();
        if strokes > 1 {
            return Err(self.refuse(
                format!("this path has {strokes} separate strokes; a coupler curve is one"),
                "break the path apart in your editor (Inkscape: Path > Break Apart) and name one with svg_id",
            ));
        }
        Ok(Some(outline))
    }
}
