//! Path data: each command draws from the current point of the pen (SVG 1.1, 8.3).

use super::shape::arc_to;
use kurbo::{BezPath, PathEl, Point, QuadBez, Vec2};
use svgtypes::PathSegment;

/// A pen, which draws the segments of path data.
#[derive(Default)]
pub(super) struct Pen {
    /// The strokes drawn so far, none of them empty.
    path: BezPath,
    start: Point,
    at: Point,
    /// The last control point of a cubic and of a quadratic curve.
    cubic: Option<Point>,
    quadratic: Option<Point>,
    /// Whether a stroke has begun, which the next command continues.
    is_down: bool,
}

impl Pen {
    /// Returns what was drawn, and the number of its strokes.
    pub fn drawn(self) -> (BezPath, usize) {
        let strokes = self.path.iter().filter(|element| matches!(element, PathEl::MoveTo(_))).count();
        (self.path, strokes)
    }

    /// Returns the path with a stroke begun where the pen is.
    fn down(&mut self) -> &mut BezPath {
        if !self.is_down {
            self.path.move_to(self.at);
            self.is_down = true;
        }
        &mut self.path
    }

    fn line(&mut self, to: Point) {
        if to != self.at {
            self.down().line_to(to);
            self.at = to;
        }
    }

    fn curve(&mut self, p1: Point, p2: Point, to: Point) {
        self.down().curve_to(p1, p2, to);
        self.at = to;
        self.cubic = Some(p2);
    }

    fn quad(&mut self, p1: Point, to: Point) {
        // Raised to a cubic, which is exact: one formula for arc lengths.
        let cubic = QuadBez::new(self.at, p1, to).raise();
        self.curve(cubic.p1, cubic.p2, to);
        (self.cubic, self.quadratic) = (None, Some(p1));
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
                self.is_down = false;
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
                if to.distance(base) > 0.0 {
                    arc_to(self.down(), base, to, Vec2::new(rx, ry), x_axis_rotation, large_arc, sweep);
                }
                self.at = to;
            }
            PathSegment::ClosePath { .. } => {
                if self.is_down {
                    self.path.close_path();
                }
                (self.at, self.is_down) = (self.start, false);
            }
        }
    }
}
