//! A curve measured by its arc length: s(t) = integral of |r'|, and the points at given s.

use kurbo::{Affine, BezPath, ParamCurve, ParamCurveArclen, PathSeg, Point};

/// The relative distance below which two ends are one point: drawings are written with six digits.
const SAME_END: f64 = 1e-5;
/// The accuracy of the length of all segments, relative to the size.
const ACCURACY: f64 = 1e-9;
/// The finest accuracy of a segment's length: parameters have to stay apart from their neighbours in f64.
const FINEST: f64 = 1e-12;

/// The segments of a curve with their lengths.
pub(super) struct Measured {
    /// The segments in the target's own coordinates.
    segments: Vec<PathSeg>,
    /// The segments moved and scaled into the unit square, in which no square overflows or vanishes.
    unit: Vec<PathSeg>,
    /// The arc length at which each segment of the unit curve starts, and the total; one more than segments.
    starts: Vec<f64>,
    accuracy: f64,
    size: f64,
    closed: bool,
}

impl Measured {
    /// Measures a curve; `None` if it has no extent. `closed`: whether it is closed, if not by where its ends lie.
    pub fn new(outline: &BezPath, closed: Option<bool>) -> Option<Measured> {
        let mut segments: Vec<PathSeg> = outline.segments().collect();
        let corners = outline.control_box();
        let size = corners.width().hypot(corners.height());
        if !(size.is_finite() && size > crate::task::SMALLEST_SIZE) {
            return None;
        }
        let (first, last) = (segments.first()?.start(), segments.last()?.end());
        let meets = last.distance(first) <= SAME_END * size;
        let closed = closed.unwrap_or(meets);
        if closed && !meets {
            segments.push(PathSeg::Line(kurbo::Line::new(last, first)));
        }
        let into_unit = Affine::scale(1.0 / size) * Affine::translate(-corners.center().to_vec2());
        let unit: Vec<PathSeg> = segments.iter().map(|s| into_unit * *s).collect();
        let accuracy = (ACCURACY / unit.len() as f64).max(FINEST);
        let mut starts = Vec::with_capacity(unit.len() + 1);
        let mut length = 0.0;
        starts.push(length);
        for segment in &unit {
            length += segment.arclen(accuracy);
            starts.push(length);
        }
        let measured = Measured { segments, unit, starts, accuracy, size, closed };
        (length.is_finite() && length > 0.0).then_some(measured)
    }

    pub fn closed(&self) -> bool {
        self.closed
    }

    fn unit_length(&self) -> f64 {
        self.starts.last().copied().unwrap_or(0.0)
    }

    pub fn length(&self) -> f64 {
        self.unit_length() * self.size
    }

    /// Returns `count` points evenly by arc length: of a closed curve from its start, without its start again at the
    /// end.
    pub fn samples(&self, count: usize) -> Vec<[f64; 2]> {
        let intervals = if self.closed { count } else { count.saturating_sub(1) };
        let step = self.unit_length() / intervals.max(1) as f64;
        (0..count).map(|i| self.at(step * i as f64)).map(|p| [p.x, p.y]).collect()
    }

    /// Returns the point at arc length s of the unit curve.
    fn at(&self, s: f64) -> Point {
        let after = self.starts.partition_point(|start| *start <= s);
        let index = after.saturating_sub(1).min(self.segments.len() - 1);
        let (start, end) = (self.starts[index], self.starts[index + 1]);
        let t = match &self.unit[index] {
            // Segments without length are allowed, and must not lead to a division by zero.
            _ if end <= start => 0.0,
            PathSeg::Line(_) => ((s - start) / (end - start)).clamp(0.0, 1.0),
            segment => segment.inv_arclen(s - start, self.accuracy),
        };
        self.segments[index].eval(t)
    }
}
