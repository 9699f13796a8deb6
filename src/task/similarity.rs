//! Similarities that map the axes of coordinates to themselves, and renumberings of a path's points: a problem in another
//! place, size, quarter turn or mirror image, or told from another point or in the reversed order.
//!
//! A similarity takes z to
//!
//! ```text
//! to + scale i^turns (z - from)          or, as a mirror image,     to + scale i^turns conj(z - from)
//! ```
//!
//! These keep boxes along the axes boxes along the axes, so every key of a problem has its image.

use crate::task::limits::Limits;
use crate::task::pivot_on::PivotOn;
use crate::task::region::Region;
use crate::task::spec::{DesignSpec, DirectionPolicy, ProblemSpec};

/// A similarity that maps the axes of coordinates to themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// The point that goes to `to`.
    pub from: [f64; 2],
    /// Whether it is a mirror image: y changes its sign before the turn.
    pub mirrors: bool,
    /// Quarter turns counter-clockwise, 0 to 3.
    pub turns: u8,
    /// The factor of every length; positive.
    pub scale: f64,
    /// The image of `from`.
    pub to: [f64; 2],
}

impl Similarity {
    /// The identity.
    pub const IDENTITY: Similarity =
        Similarity { from: [0.0; 2], mirrors: false, turns: 0, scale: 1.0, to: [0.0; 2] };

    /// Returns the move by a vector.
    pub fn shift(by: [f64; 2]) -> Similarity {
        Similarity { to: by, ..Similarity::IDENTITY }
    }

    /// Returns the image of a point.
    pub fn point(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.turned([(x - self.from[0]) * self.scale, (y - self.from[1]) * self.scale]);
        [x + self.to[0], y + self.to[1]]
    }

    /// Returns the image of a vector, not scaled.
    pub fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let y = if self.mirrors { -y } else { y };
        match self.turns % 4 {
            0 => [x, y],
            1 => [-y, x],
            2 => [-x, -y],
            _ => [y, -x],
        }
    }

    /// Returns the image of a direction, in degrees.
    pub fn degrees(&self, direction: f64) -> f64 {
        90.0 * f64::from(self.turns) + if self.mirrors { -direction } else { direction }
    }

    /// Returns the image of a body's angle, in degrees within half a turn.
    pub fn direction(&self, angle: f64) -> f64 {
        let image = self.degrees(angle);
        image - 360.0 * (image / 360.0).round()
    }

    /// Returns the similarity that takes every image back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        // A mirror image followed by a turn is its own inverse.
        let turns = if self.mirrors { self.turns } else { (4 - self.turns % 4) % 4 };
        Similarity { from: self.to, turns, scale: 1.0 / self.scale, to: self.from, ..*self }
    }

    /// Returns the image of a box [xmin, ymin, xmax, ymax].
    fn corners(&self, [x0, y0, x1, y1]: [f64; 4]) -> [f64; 4] {
        let ([a, b], [c, d]) = (self.point([x0, y0]), self.point([x1, y1]));
        [a.min(c), b.min(d), a.max(c), b.max(d)]
    }

    /// Returns the image of a region in the frame of a body, which turns and moves with the body.
    fn in_the_body(&self, region: &Region) -> Region {
        let across = if self.mirrors { -self.scale } else { self.scale };
        let place = |[x, y]: [f64; 2]| [x * self.scale, y * across];
        match region {
            Region::Box([x0, y0, x1, y1]) => {
                let ([a, b], [c, d]) = (place([*x0, *y0]), place([*x1, *y1]));
                Region::Box([a, b.min(d), c, b.max(d)])
            }
            Region::Polygon(points) => Region::Polygon(points.iter().copied().map(place).collect()),
        }
    }

    fn pivot(&self, [x, y]: [Limits; 2]) -> [Limits; 2] {
        let [x0, y0, x1, y1] = self.corners([x.0, y.0, x.1, y.1]);
        [Limits(x0, x1), Limits(y0, y1)]
    }

    fn length(&self, Limits(low, high): Limits) -> Limits {
        Limits(low * self.scale, high * self.scale)
    }

    fn across(&self, limits: Limits) -> Limits {
        let Limits(low, high) = self.length(limits);
        if self.mirrors { Limits(0.0 - high, 0.0 - low) } else { Limits(low, high) }
    }

    /// Returns the image of limits of a direction in degrees, their middle within half a turn of the x axis.
    fn directions(&self, Limits(low, high): Limits) -> Limits {
        let (one, other) = (self.degrees(low), self.degrees(high));
        let whole = 360.0 * ((0.5 * (one + other)) / 360.0).round();
        Limits(one.min(other) - whole, one.max(other) - whole)
    }

    fn design(&self, design: &DesignSpec) -> DesignSpec {
        let length = |limits: Option<Limits>| limits.map(|limits| self.length(limits));
        DesignSpec {
            mechanism: design.mechanism.clone(),
            crank_pivot: design.crank_pivot.map(|pivot| self.pivot(pivot)),
            follower_pivot: design.follower_pivot.map(|pivot| self.pivot(pivot)),
            a: length(design.a),
            b: length(design.b),
            c: length(design.c),
            d: length(design.d),
            e: length(design.e),
            ground: length(design.ground),
            ground_angle_deg: design.ground_angle_deg.map(|limits| self.directions(limits)),
            line_deg: design.line_deg.map(|limits| self.directions(limits)),
            line_point: design.line_point.map(|place| self.pivot(place)),
            coupler_x: length(design.coupler_x),
            coupler_y: design.coupler_y.map(|limits| self.across(limits)),
        }
    }
}

/// Another numbering of a path's points: point k of the new path is point `first` + k of the old one, or `first` - k if it
/// is reversed, modulo their number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Numbering {
    /// The index of the point that comes first.
    pub first: usize,
    /// Whether the order is reversed.
    pub reversed: bool,
}

impl Numbering {
    /// The numbering of the path as it is.
    pub const IDENTITY: Numbering = Numbering { first: 0, reversed: false };

    /// Returns the index in the old path of point `k` of `n`.
    pub fn place(&self, k: usize, n: usize) -> usize {
        (self.first + if self.reversed { n - k } else { k }) % n
    }

    /// Returns a list, one item a point, in the new order.
    pub fn list<T: Clone>(&self, items: &[T]) -> Vec<T> {
        (0..items.len()).map(|k| items[self.place(k, items.len())].clone()).collect()
    }

    /// Returns the numbering that restores the old order of `n` points.
    #[must_use]
    pub fn inverse(&self, n: usize) -> Self {
        let first = if self.reversed { self.first } else { (n - self.first % n) % n };
        Numbering { first, ..*self }
    }
}

/// Returns the direction seen in a mirror, or run in the reversed order.
fn opposite(direction: DirectionPolicy) -> DirectionPolicy {
    match direction {
        DirectionPolicy::Any => DirectionPolicy::Any,
        DirectionPolicy::Ccw => DirectionPolicy::Cw,
        DirectionPolicy::Cw => DirectionPolicy::Ccw,
    }
}

impl ProblemSpec {
    /// Returns the image of the problem under a similarity: of its points, tolerances, limits and boxes. Prescribed crank
    /// angles have no image and stay as they are.
    #[must_use]
    pub fn placed(&self, by: &Similarity) -> Self {
        let mut spec = self.clone();
        let path = &mut spec.task;
        for point in path.points.iter_mut().chain(path.raw.iter_mut().flat_map(|raw| &mut raw.points)) {
            *point = by.point(*point);
        }
        if let Some(deviation) = path.raw.as_mut().and_then(|raw| raw.smooth.as_mut()) {
            *deviation *= by.scale;
        }
        path.tolerance.iter_mut().flatten().for_each(|tolerance| *tolerance *= by.scale);
        if let Some(body) = path.body.as_mut().filter(|_| path.output.is_none()) {
            body.angle_weight *= by.scale;
            body.angle_deg.iter_mut().flatten().for_each(|angle| *angle = by.direction(*angle));
        }
        spec.design = by.design(&self.design);
        let require = &mut spec.require;
        match &mut require.pivots_in {
            Some(Region::Box(corners)) => *corners = by.corners(*corners),
            Some(Region::Polygon(points)) => points.iter_mut().for_each(|point| *point = by.point(*point)),
            None => {}
        }
        for place in require.pivot_on.iter_mut().flat_map(PivotOn::points_mut) {
            *place = by.point(*place);
        }
        if let Some(region) = &mut require.pins_in {
            *region = by.in_the_body(region);
        }
        if let Some(corners) = &mut require.footprint_in {
            *corners = by.corners(*corners);
        }
        for length in [&mut require.extent_max, &mut require.longest_max].into_iter().flatten() {
            *length *= by.scale;
        }
        if let Some(stroke) = &mut require.stroke {
            *stroke = Limits(by.scale * stroke.0, by.scale * stroke.1);
        }
        if by.mirrors {
            require.direction = opposite(require.direction);
        }
        spec.loads = self.loads.as_ref().map(|loads| loads.placed(by));
        spec
    }

    /// Returns the problem with its points in another order, with their weights and tolerances. Prescribed crank angles
    /// stay in their order. Points as they were given before smoothing or resampling are reversed, if they are, and
    /// begin as before.
    #[must_use]
    pub fn renumbered(&self, by: Numbering) -> Self {
        let mut spec = self.clone();
        let path = &mut spec.task;
        path.points = by.list(&path.points);
        for list in [&mut path.weight, &mut path.tolerance].into_iter().flatten() {
            *list = by.list(list);
        }
        if let Some(body) = &mut path.body {
            body.angle_deg = by.list(&body.angle_deg);
            body.tolerance_deg = body.tolerance_deg.as_ref().map(|list| by.list(list));
        }
        if by.reversed {
            if let Some(raw) = &mut path.raw {
                raw.points.reverse();
            }
            spec.require.direction = opposite(spec.require.direction);
        }
        spec
    }

    /// Returns the problem with every coordinate rounded to a multiple of `grid`, and every length, direction and
    /// tolerance to a part of itself of about `grid`: what differs by rounding alone is equal then, but for what lies
    /// between two multiples.
    #[must_use]
    pub fn rounded(&self, grid: f64) -> Self {
        let at = |x: f64| rounded_to(x, grid);
        let of_itself = |x: f64| rounded_to(x, grid * power_of_two(x));
        let both =
            |of: &dyn Fn(f64) -> f64, limits: &mut Limits| *limits = Limits(of(limits.0), of(limits.1));
        let mut spec = self.clone();
        let path = &mut spec.task;
        path.points.iter_mut().flatten().for_each(|x| *x = at(*x));
        path.tolerance.iter_mut().flatten().for_each(|x| *x = of_itself(*x));
        if let Some(body) = path.body.as_mut().filter(|_| path.output.is_none()) {
            body.angle_weight = of_itself(body.angle_weight);
            // A radian has 64 degrees, roughly.
            body.angle_deg.iter_mut().flatten().for_each(|angle| *angle = rounded_to(*angle, 64.0 * grid));
        }
        let DesignSpec {
            mechanism: _,
            crank_pivot,
            follower_pivot,
            a,
            b,
            c,
            d,
            e,
            ground,
            ground_angle_deg,
            line_deg,
            line_point,
            coupler_x,
            coupler_y,
        } = &mut spec.design;
        for limits in [crank_pivot, follower_pivot, line_point].into_iter().flatten().flatten() {
            both(&at, limits);
        }
        for limits in
            [a, b, c, d, e, ground, ground_angle_deg, line_deg, coupler_x, coupler_y].into_iter().flatten()
        {
            both(&of_itself, limits);
        }
        let require = &mut spec.require;
        let region = require.pivots_in.iter_mut().flat_map(Region::points_mut);
        region.chain(require.footprint_in.iter_mut().flatten()).for_each(|x| *x = at(*x));
        require.pivot_on.iter_mut().flat_map(PivotOn::points_mut).flatten().for_each(|x| *x = at(*x));
        require.pins_in.iter_mut().flat_map(Region::points_mut).for_each(|x| *x = at(*x));
        for x in [&mut require.extent_max, &mut require.longest_max].into_iter().flatten() {
            *x = of_itself(*x);
        }
        if let Some(stroke) = &mut require.stroke {
            both(&of_itself, stroke);
        }
        spec
    }

    /// Returns every limit that a similarity changes, in a fixed order: of an image of the problem, to compare it with
    /// another image.
    pub fn limits_of_place(&self) -> Vec<f64> {
        let design = &self.design;
        let pivots = [design.crank_pivot, design.follower_pivot].into_iter().flatten().flatten();
        let lengths = [
            design.a,
            design.b,
            design.c,
            design.d,
            design.e,
            design.ground,
            design.ground_angle_deg,
            design.coupler_x,
            design.coupler_y,
        ];
        let region = self.require.pivots_in.iter().flat_map(Region::numbers);
        let boxes = region.chain(self.require.pins_in.iter().flat_map(Region::numbers));
        let boxes = boxes.chain(self.require.footprint_in.into_iter().flatten());
        let mut limits: Vec<f64> =
            pivots.chain(lengths.into_iter().flatten()).flat_map(|Limits(low, high)| [low, high]).collect();
        limits.extend(boxes);
        limits.extend(self.require.pivot_on.iter().flat_map(PivotOn::points).flatten());
        limits.extend([self.require.extent_max, self.require.longest_max].into_iter().flatten());
        limits.extend(self.require.stroke.iter().flat_map(|Limits(low, high)| [*low, *high]));
        limits.push(match self.require.direction {
            DirectionPolicy::Any => 0.0,
            DirectionPolicy::Ccw => 1.0,
            DirectionPolicy::Cw => -1.0,
        });
        limits
    }
}

/// Returns the nearest multiple of a power of two; the number itself if it has none nearby.
fn rounded_to(x: f64, grid: f64) -> f64 {
    let steps = (x / grid).round();
    // Adding zero takes the sign off a zero.
    if steps.is_finite() { steps * grid + 0.0 } else { x }
}

/// Returns the largest power of two that is at most |x|; 1 for zero, subnormal and infinite numbers.
fn power_of_two(x: f64) -> f64 {
    if x.is_normal() { f64::from_bits(x.to_bits() & (0x7ff << 52)) } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::arithmetic::streams::{Stream, below, stream, uniform};
    use crate::task::spec::RawPoints;
    use serde_json::Value;

    /// Returns a problem that gives every key that has an image.
    fn problem(draws: &mut Stream) -> ProblemSpec {
        let n = 8 + below(draws, 9);
        let mut pair = |from: f64, to: f64| {
            let (one, other) = (uniform(draws, from, to), uniform(draws, from, to));
            Limits(one.min(other), one.max(other))
        };
        let points: Vec<[f64; 2]> = (0..n).map(|_| pair(-3.0, 3.0)).map(|Limits(x, y)| [x, y]).collect();
        let design = DesignSpec {
            mechanism: Vec::new(),
            crank_pivot: Some([pair(-3.0, 3.0), Limits(0.5, 0.5)]),
            follower_pivot: Some([pair(-3.0, 3.0), pair(-3.0, 3.0)]),
            a: Some(pair(0.1, 3.0)),
            b: Some(Limits(2.25, 2.25)),
            c: Some(pair(0.1, 3.0)),
            d: Some(pair(0.1, 3.0)),
            e: Some(pair(0.1, 3.0)),
            ground: Some(pair(0.1, 3.0)),
            ground_angle_deg: Some(pair(-80.0, 80.0)),
            line_deg: Some(pair(-80.0, 80.0)),
            line_point: Some([pair(-3.0, 3.0), Limits(0.25, 0.25)]),
            coupler_x: Some(pair(-3.0, 3.0)),
            coupler_y: Some(pair(-3.0, 3.0)),
        };
        let require = "pivots_in = [-3.5, -2.5, 3.25, 4.0]\npivot_on = { A = [[1.0, 0.5], [-2.5, 1.5]], B = [[2.0, 3.0]] }\nfootprint_in = [-9.0, -8.0, 7.0, 6.0]\n\
                       extent_max = 17.5\nlongest_max = 11.0\ndirection = \"ccw\"\ntransmission_deg_min = 20";
        let mut spec = crate::synthesis::fixture::problem(&points, true, require).spec().clone();
        spec.design = design;
        let mut list = || -> Option<Vec<f64>> { Some((0..n).map(|_| uniform(draws, 0.1, 2.0)).collect()) };
        let path = &mut spec.task;
        (path.weight, path.tolerance) = (list(), list());
        let points = points.iter().map(|[x, y]| [x + 0.1, y - 0.1]).collect();
        path.raw = Some(RawPoints { points, smooth: Some(0.3), samples: None });
        spec
    }

    /// Returns the place at which two values differ by more than rounding.
    fn apart(one: &Value, other: &Value) -> Option<String> {
        match (one, other) {
            (Value::Number(x), Value::Number(y)) => {
                let (x, y) = (x.as_f64()?, y.as_f64()?);
                ((x - y).abs() > 1e-11 * (1.0 + x.abs())).then(|| format!(" {x} is not {y}"))
            }
            (Value::Array(x), Value::Array(y)) if x.len() == y.len() => {
                x.iter().zip(y).enumerate().find_map(|(i, (x, y))| Some(format!(".{i}{}", apart(x, y)?)))
            }
            (Value::Object(x), Value::Object(y)) if x.len() == y.len() => {
                x.iter().find_map(|(key, x)| Some(format!(".{key}{}", apart(x, y.get(key)?)?)))
            }
            _ => (one != other).then(|| format!(" {one} is not {other}")),
        }
    }

    #[test]
    fn a_problem_with_every_key_comes_back_from_its_image() {
        let draws = &mut stream(3, 0);
        for case in 0..48 {
            let spec = problem(draws);
            let n = spec.task.points.len();
            let mut vector = || [uniform(draws, -9.0, 9.0), uniform(draws, -9.0, 9.0)];
            let (from, to) = (vector(), vector());
            let (mirrors, turns) = (case & 1 != 0, (case / 2 % 4) as u8);
            let by = Similarity { from, mirrors, turns, scale: uniform(draws, 0.1, 9.0), to };
            let numbering = Numbering { first: below(draws, n), reversed: case & 8 != 0 };
            let image = spec.placed(&by).renumbered(numbering);
            assert_ne!(image, spec);
            let back = image.placed(&by.inverse()).renumbered(numbering.inverse(n));
            let [one, other] = [&spec, &back].map(|spec| serde_json::to_value(spec).expect("JSON"));
            assert_eq!(apart(&one, &other), None, "{by:?} {numbering:?}");
            assert!(
                image.design.b.is_some_and(|b| b.is_fixed())
                    && image.design.crank_pivot != spec.design.crank_pivot
            );
        }
    }

    #[test]
    fn limits_keep_their_order_and_change_with_the_axes() {
        let mut spec = problem(&mut stream(4, 0));
        spec.design.ground_angle_deg = Some(Limits(100.0, 130.0));
        spec.design.coupler_y = Some(Limits(1.0, 2.0));
        let by = Similarity { mirrors: true, turns: 1, scale: 2.0, ..Similarity::IDENTITY };
        let image = spec.placed(&by);
        // The mirror takes 100 .. 130 to -130 .. -100, a quarter turn that to -40 .. -10.
        assert_eq!(image.design.ground_angle_deg, Some(Limits(-40.0, -10.0)));
        assert_eq!(image.design.coupler_y, Some(Limits(-4.0, -2.0)));
        assert_eq!(image.design.b, Some(Limits(4.5, 4.5)));
        // (x, y) goes to (y, x) twice as large.
        assert_eq!(image.require.pivots_in, Some(Region::Box([-5.0, -7.0, 8.0, 6.5])));
        assert_eq!(image.design.crank_pivot.map(|[x, _]| x), Some(Limits(1.0, 1.0)));
        assert_eq!(image.require.direction, DirectionPolicy::Cw);
        let reversed = image.renumbered(Numbering { first: 3, reversed: true });
        assert_eq!(reversed.require.direction, DirectionPolicy::Ccw);
        assert_eq!(reversed.task.points[1], image.task.points[2]);
    }

    #[test]
    fn rounding_takes_differences_of_rounding_away() {
        let mut spec = problem(&mut stream(5, 0));
        spec.task.raw = None;
        let grid = 2.0_f64.powi(-36);
        let by = Similarity { from: [0.3, 0.7], scale: 1.7, to: [11.0, 3.1], ..Similarity::IDENTITY };
        let again = spec.placed(&by).placed(&by.inverse());
        assert_ne!(again, spec);
        assert_eq!(again.rounded(grid), spec.rounded(grid));
        assert_eq!(rounded_to(-1e-12, grid).to_bits(), 0);
        assert_eq!(power_of_two(-5.0), 4.0);
        assert_eq!(rounded_to(f64::INFINITY, grid), f64::INFINITY);
    }
}
