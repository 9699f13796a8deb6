//! Path data: each command draws from the current point of the pen (SVG 1.1, 8.3).

use super::shape::Outline;
use kurbo::{CubicBez, Line, PathSeg, Point, QuadBez, Vec2};
use svgtypes::PathSegment;

/// A pen, which draws the segments of path data.
#[derive(Default)]
pub(super) struct Pen {
    /// The strokes drawn so far; some may be empty.
    pub strokes: Vec<Outline>,
    start: Point,
    at: Point,
    /// The last control point of a cubic and of a quadratic curve.
    cubic: Option<Point>,
    quadratic: Option<Point>,
    /// Whether the next command begins a stroke.
    lifted: bool,
}

impl Pen {
    fn stroke(&mut self) -> &mut Outline {
        if self.lifted || self.strokes.is_empty() {
            self.strokes.push(Outline::default());
            self.lifted = false;
        }
        let last = self.strokes.len() - 1;
        &mut self.strokes[last]
    }

    fn push(&mut self, segment: PathSeg, to: Point) {
        self.stroke().segments.push(segment);
        self.at = to;
    }

    fn line(&mut self, to: Point) {
        let from = self.at;
        if to != from {
            self.push(PathSeg::Line(Line::new(from, to)), to);
        }
    }

    fn curve(&mut self, p1: Point, p2: Point, to: Point) {
        self.push(PathSeg::Cubic(CubicBez::new(self.at, p1, p2, to)), to);
        self.cubic = Some(p2);
    }

    fn quad(&mut self, p1: Point, to: Point) {
        // Raised to a cubic, which is exact: one formula for arc lengths.
        self.push(PathSeg::Cubic(QuadBez::new(self.at, p1, to).raise()), to);
        self.quadratic = Some(p1);
    }

    /// Draws one segment.
    pub fn draw(&mut self, segment: PathSegment) {
        let base = self.at;
        let place = |abs: bool, x: f64, y: f64| {
            if abs { Point::new(x, y) } else { Point::new(base.x + x, base.y + y) }
        };
        let (cubic, quadratic) = (self.cubic.take(), self.quadratic.take());
        let mirrored = |control: Option<Point>| control.map_or(base, |c| base + (base - c));
        match segment {
            PathSegment::MoveTo { abs, x, y } => {
                self.at = place(abs, x, y);
                self.start = self.at;
                self.lifted = true;
            }
            PathSegment::LineTo { abs, x, y } => self.line(place(abs, x, y)),
            PathSegment::HorizontalLineTo { abs, x } => {
                self.line(Point::new(if abs { x } else { base.x + x }, base.y));
            }
            PathSegment::VerticalLineTo { abs, y } => {
                self.line(Point::new(base.x, if abs { y } else { base.y + y }));
            }
            PathSegment::CurveTo { abs, x1, y1, x2, y2, x, y } => {
                self.curve(place(abs, x1, y1), place(abs, x2, y2), place(abs, x, y));
            }
            PathSegment::SmoothCurveTo { abs, x2, y2, x, y } => {
                self.curve(mirrored(cubic), place(abs, x2, y2), place(abs, x, y));
            }
            PathSegment::Quadratic { abs, x1, y1, x, y } => self.quad(place(abs, x1, y1), place(abs, x, y)),
            PathSegment::SmoothQuadratic { abs, x, y } => self.quad(mirrored(quadratic), place(abs, x, y)),
            PathSegment::EllipticalArc { abs, rx, ry, x_axis_rotation, large_arc, sweep, x, y } => {
                let to = place(abs, x, y);
                if to != base {
                    self.stroke().arc_to(base, to, Vec2::new(rx, ry), x_axis_rotation, large_arc, sweep);
                }
                self.at = to;
            }
            PathSegment::ClosePath { .. } => {
                let start = self.start;
                self.line(start);
                if let (false, Some(stroke)) = (self.lifted, self.strokes.last_mut()) {
                    stroke.closed = true;
                }
                self.at = start;
                self.lifted = true;
            }
        }
    }
}
