//! Draws path data: each command draws from the current point of the pen (SVG 1.1, 8.3).
//!
//! Arcs become cubics whose distance from the ellipse is below 1e-11 of its radius.

use kurbo::{Affine, Arc, BezPath, PathEl, Point, QuadBez, SvgArc, Vec2};
use svgtypes::PathSegment;

/// The largest distance of a cubic from its ellipse, in radii.
const ARC_TOLERANCE: f64 = 1e-11;

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

/// Adds an elliptical arc of a path (SVG 1.1, F.6): scaled so that its chord is 1, because kurbo's tests for straight
/// arcs are absolute. The path ends at `from`.
pub(super) fn arc_to(
    path: &mut BezPath,
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
        return path.line_to(to);
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
    let Some(arc) = Arc::from_svg_arc(&unit) else { return path.line_to(to) };
    let back = Affine::translate(from.to_vec2()) * Affine::scale(chord);
    path.extend(arc.append_iter(tolerance(&arc)).map(|curve| back * curve));
    // The end is exactly as it was written.
    if let Some(PathEl::CurveTo(_, _, end)) = path.elements_mut().last_mut() {
        *end = to;
    }
}

/// Returns the tolerance of an arc's cubics.
pub(super) fn tolerance(arc: &Arc) -> f64 {
    ARC_TOLERANCE * arc.radii.x.abs().max(arc.radii.y.abs())
}
