//! The design vector and its coordinates; only this file knows the meaning of each component.
//!
//! x = (Ax, Ay, G1, G2, a, b, c, Q1, Q2, o). The ground (G1, G2) is B itself or, if the problem gives `ground` or
//! `ground_angle_deg` and not B, the length and direction from A to B. The coupler point (Q1, Q2) is (coupler_x,
//! coupler_y) or, if the problem gives d or e only, those distances with the side t2 kept separately. o is the crank
//! angle's offset if the timing leaves it free; in a motion with free timing it is the frame, the angle from the coupler's
//! direction to the body's x axis. Any other quantity that the problem bounds becomes an inequality (a
//! derived bound).

use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::four_bar::position::Kernel;
use crate::mechanism::{AssemblyMode, Complex, CouplerSide, FourBar, LinkageError, length, point, xy};
use crate::task::Task;
use crate::task::pivot_on::{Locus, PivotOn};
use crate::task::spec::{DEFAULT_REACH, DesignSpec, Limits};
use std::f64::consts::PI;

/// Dimension of a design vector; fixed numbers keep their place.
pub const DESIGN: usize = 10;

/// A design vector.
pub type Design = [f64; DESIGN];

/// Number of parameters of a shape: Ax, Ay, Bx, By, a, b, c, coupler_x, coupler_y.
pub const SHAPE: usize = 9;

/// Least length searched, in parts of the target's size. A bound of zero on a length means "any positive length", but a
/// linkage of size zero fits any circular arc.
pub const SHORTEST_LINK: f64 = 1e-4;

#[derive(Clone, Copy, Debug, PartialEq)]
enum GroundChart {
    Pivot,
    Polar,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum CouplerChart {
    Offset,
    Distances(CouplerSide),
    /// P in D: its offset is b along the coupler, and there is nothing to choose.
    FollowerPin,
}

/// The parameters of a linkage that the search varies: pivots, links and the coupler point in the coupler's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// The crank's pivot A.
    pub crank_pivot: Complex,
    /// The follower's pivot B.
    pub follower_pivot: Complex,
    /// The crank length a.
    pub crank: f64,
    /// The coupler length b.
    pub coupler: f64,
    /// The follower length c.
    pub follower: f64,
    /// The coupler point P along and across C -> D from C, as lengths.
    pub offset: Complex,
}

impl Shape {
    /// Returns the linkage with an assembly.
    ///
    /// # Errors
    /// As [`FourBar::new`].
    pub fn linkage(&self, assembly: AssemblyMode) -> Result<FourBar, LinkageError> {
        FourBar::with_coupler_offset(
            [self.crank_pivot, self.follower_pivot],
            [self.crank, self.coupler, self.follower],
            self.offset,
            assembly,
        )
    }

    /// Returns the position solver of the shape in an assembly.
    #[inline]
    pub fn kernel(&self, assembly: AssemblyMode) -> Kernel {
        Kernel::from_parts(
            xy(self.crank_pivot),
            xy(self.follower_pivot),
            [self.crank, self.coupler, self.follower],
            xy(self.offset / self.coupler),
            assembly,
        )
    }

    /// Returns the lengths ground, a, b, c.
    pub fn links(&self) -> [f64; 4] {
        [length(self.follower_pivot - self.crank_pivot), self.crank, self.coupler, self.follower]
    }
}

impl From<&FourBar> for Shape {
    fn from(linkage: &FourBar) -> Self {
        Shape {
            crank_pivot: linkage.crank_pivot(),
            follower_pivot: linkage.follower_pivot(),
            crank: linkage.crank(),
            coupler: linkage.coupler(),
            follower: linkage.follower(),
            offset: linkage.coupler_offset(),
        }
    }
}

/// A bound on a quantity that is not a coordinate of the design vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DerivedBound {
    /// The bounded quantity.
    pub quantity: Derived,
    /// Its limits; an angle's in radians.
    pub limits: Limits,
}

/// The quantities that can be bounded besides the coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Derived {
    /// The ground length |AB|.
    Ground,
    /// The direction of the ground line, arg(B - A), in radians.
    GroundAngle,
    /// The coupler side |CP|.
    CrankSide,
    /// The coupler side |DP|.
    FollowerSide,
}

/// The derivatives of the shape by the design vector, at one design.
#[derive(Clone, Copy, Debug)]
pub struct ChainRule {
    /// The ground length, and the cosine and sine of its direction, if these are the coordinates.
    ground: Option<[f64; 3]>,
    /// The derivatives of (coupler_x, coupler_y) by b, d and e, if d and e are the coordinates.
    coupler: Option<[[f64; 2]; 3]>,
    /// The directions of the slanted lines along which A and B have their coordinates.
    along: [Option<Complex>; 2],
}

impl ChainRule {
    /// Returns the derivative by the design vector from the one by the shape (Ax, Ay, Bx, By, a, b, c, coupler_x,
    /// coupler_y) and by the crank angle's offset.
    #[inline]
    pub fn by_design(&self, row: &[f64; SHAPE], by_offset: f64) -> Design {
        let mut out = [0.0; DESIGN];
        out[..SHAPE].copy_from_slice(row);
        out[OFFSET] = by_offset;
        if let Some([ground, cos, sin]) = self.ground {
            out[0] = row[0] + row[2];
            out[1] = row[1] + row[3];
            out[2] = row[2] * cos + row[3] * sin;
            out[3] = ground * (row[3] * cos - row[2] * sin);
        }
        if let Some(columns) = self.coupler {
            let [by_b, by_d, by_e] = columns.map(|[x, y]| row[7] * x + row[8] * y);
            (out[5], out[7], out[8]) = (row[5] + by_b, by_d, by_e);
        }
        for (along, first) in self.along.iter().zip([0, 2]) {
            if let Some(along) = along {
                let (x, y) = (out[first], out[first + 1]);
                (out[first], out[first + 1]) = (x * along.re + y * along.im, y * along.re - x * along.im);
            }
        }
        out
    }
}

/// The set of admissible designs: coordinates, bounds and derived bounds.
#[derive(Clone, Debug)]
pub struct DesignSpace {
    ground: GroundChart,
    coupler: CouplerChart,
    bounds: [(f64, f64); DESIGN],
    derived: Vec<DerivedBound>,
    free: Vec<usize>,
    /// The slanted lines on which A and B lie: a place and the direction. Their coordinates are then those along the line and
    /// across it.
    slanted: [Option<(Complex, Complex)>; 2],
    /// Whether each number is fixed by the line of a pivot.
    held: [bool; DESIGN],
    /// The lines of pivots that are no coordinates, with the distance within which a pivot is put on its line.
    loci: [Option<(Locus, f64)>; 2],
}

const OFFSET: usize = DESIGN - 1;

/// The distance from its line, in parts of the target's size, within which a pivot is put on it.
const LINE_SLACK: f64 = 1e-7;

impl DesignSpace {
    /// Creates the space of a resolved design table; `offset_free`: whether the crank angle's offset is unknown, or the
    /// frame of a body; `pivot_box` tightens the pivots' bounds; a line of `pivot_on` fixes a coordinate; `side` is t2, used if d and e are the coordinates.
    pub fn new(
        spec: &DesignSpec,
        task: &Task,
        offset_free: bool,
        (pivot_box, pivot_on): (Option<[f64; 4]>, Option<&PivotOn>),
        side: CouplerSide,
    ) -> Self {
        let far = 2.0 * DEFAULT_REACH * task.size();
        let shortest = SHORTEST_LINK * task.size();
        let any = Limits(f64::NEG_INFINITY, f64::INFINITY);
        let length = |l: Option<Limits>| {
            let l = l.unwrap_or(Limits(0.0, far));
            if l.is_fixed() { l } else { Limits(l.0.max(shortest.min(l.1)), l.1) }
        };
        let within = |l: Limits, axis: usize| match pivot_box {
            Some(b) if !l.is_fixed() => {
                let inside = Limits(l.0.max(b[axis]), l.1.min(b[axis + 2]));
                // An empty intersection is left to the requirement, which is then not met.
                if inside.0 < inside.1 { inside } else { l }
            }
            _ => l,
        };
        // A line along an axis fixes a coordinate.
        let at = |l: Limits, value: Option<f64>| match value {
            Some(value) if l.0 <= value && value <= l.1 => Limits(value, value),
            _ => l,
        };
        let loci = pivot_on.map_or([None; 2], PivotOn::both);
        let mut slanted = [None; 2];
        let mut pivot = |p: Option<[Limits; 2]>, which: usize| {
            let [x, y] = p.unwrap_or([any, any]);
            let (x, y) = (within(x, 0), within(y, 1));
            let Some(locus) = loci[which] else { return [x, y] };
            if let Some((from, along)) = locus.line().filter(|_| locus.is_slanted()) {
                slanted[which] = Some((from, along));
                return [stretch(from, along, [x, y]), Limits(0.0, 0.0)];
            }
            let fixed = locus.fixed();
            [at(x, fixed[0]), at(y, fixed[1])]
        };
        let mut derived = Vec::new();
        let mut derive = |quantity, limits: Option<Limits>| {
            if let Some(limits) = limits {
                derived.push(DerivedBound { quantity, limits });
            }
        };
        let radians = |l: Limits| Limits(l.0.to_radians(), l.1.to_radians());
        let [a_x, a_y] = pivot(spec.crank_pivot, 0);
        let (ground, [g_1, g_2]) = match spec.follower_pivot {
            Some(_) => {
                derive(Derived::Ground, spec.ground);
                derive(Derived::GroundAngle, spec.ground_angle_deg.map(radians));
                (GroundChart::Pivot, pivot(spec.follower_pivot, 1))
            }
            None => {
                let angle = spec.ground_angle_deg.map_or(any, radians);
                (GroundChart::Polar, [length(spec.ground), angle])
            }
        };
        let on_crank_pin = spec.d.is_some_and(|d| d.is_fixed() && d.0 == 0.0);
        let on_follower_pin = spec.e.is_some_and(|e| e.is_fixed() && e.0 == 0.0);
        let (coupler, [q_1, q_2]) = if on_crank_pin && spec.coupler_x.is_none() && spec.coupler_y.is_none() {
            // P on C: its offset is zero, and e equals b for every b.
            derive(Derived::FollowerSide, spec.e);
            (CouplerChart::Offset, [Limits(0.0, 0.0), Limits(0.0, 0.0)])
        } else if on_follower_pin && spec.coupler_x.is_none() && spec.coupler_y.is_none() {
            derive(Derived::CrankSide, spec.d);
            (CouplerChart::FollowerPin, [Limits(0.0, 0.0), Limits(0.0, 0.0)])
        } else if spec.coupler_x.is_none() && spec.coupler_y.is_none() {
            let distance = |l: Option<Limits>| l.unwrap_or(Limits(0.0, far));
            (CouplerChart::Distances(side), [distance(spec.d), distance(spec.e)])
        } else {
            derive(Derived::CrankSide, spec.d);
            derive(Derived::FollowerSide, spec.e);
            let offset = |l: Option<Limits>| l.unwrap_or(Limits(-far, far));
            (CouplerChart::Offset, [offset(spec.coupler_x), offset(spec.coupler_y)])
        };
        let offset = if offset_free { any } else { Limits(0.0, 0.0) };
        let bounds = [a_x, a_y, g_1, g_2, length(spec.a), length(spec.b), length(spec.c), q_1, q_2, offset]
            .map(|l| (l.0, l.1));
        let free = (0..DESIGN).filter(|&i| bounds[i].0 < bounds[i].1).collect();
        let mut held = [false; DESIGN];
        for (first, locus) in [0, 2].into_iter().zip(loci) {
            let Some(locus) = locus.filter(|_| first == 0 || ground == GroundChart::Pivot) else { continue };
            let fixed = locus.fixed().map(|value| value.is_some());
            (held[first], held[first + 1]) =
                if locus.is_slanted() { (false, true) } else { (fixed[0], fixed[1]) };
        }
        let mut loci = loci.map(|locus| locus.cloned().map(|locus| (locus, LINE_SLACK * task.size())));
        loci[0] = None;
        if ground == GroundChart::Pivot {
            loci[1] = None;
        }
        DesignSpace { ground, coupler, bounds, derived, free, slanted, held, loci }
    }

    /// Returns whether a number is fixed by the line of a pivot.
    pub fn is_held(&self, i: usize) -> bool {
        self.held[i]
    }

    /// Returns whether t2 has to be chosen separately (d and e are the coordinates).
    pub fn has_side(spec: &DesignSpec) -> bool {
        spec.coupler_x.is_none() && spec.coupler_y.is_none()
    }

    /// Returns [low, high] of each number.
    pub fn bounds(&self) -> &[(f64, f64); DESIGN] {
        &self.bounds
    }

    /// Fixes the linkage at its value in `x`; the frame of a body stays free.
    pub fn fix(&mut self, x: &Design) {
        for (bounds, value) in self.bounds.iter_mut().zip(x).take(SHAPE) {
            *bounds = (*value, *value);
        }
        self.free.clear();
        self.derived.clear();
    }

    /// Returns the derived bounds.
    pub fn derived(&self) -> &[DerivedBound] {
        &self.derived
    }

    /// Returns the limits of ground, a, b and c.
    pub fn link_limits(&self) -> [Limits; 4] {
        let of = |i: usize| Limits(self.bounds[i].0, self.bounds[i].1);
        let ground = match self.ground {
            GroundChart::Polar => of(2),
            GroundChart::Pivot => self
                .derived
                .iter()
                .find(|bound| bound.quantity == Derived::Ground)
                .map_or(Limits(0.0, f64::INFINITY), |bound| bound.limits),
        };
        [ground, of(4), of(5), of(6)]
    }

    /// Returns the name of number `i` of a design in the file (a pivot's by its coordinate, such as Ax), and whether it
    /// is an angle; `None` for the crank angle's offset.
    pub fn coordinate(&self, i: usize) -> Option<(&'static str, bool)> {
        let [g_1, g_2] = match self.ground {
            GroundChart::Pivot => ["Bx", "By"],
            GroundChart::Polar => ["ground", "ground_angle_deg"],
        };
        let [q_1, q_2] = match self.coupler {
            CouplerChart::Offset => ["coupler_x", "coupler_y"],
            CouplerChart::Distances(_) | CouplerChart::FollowerPin => ["d", "e"],
        };
        let names = ["Ax", "Ay", g_1, g_2, "a", "b", "c", q_1, q_2];
        names.get(i).map(|&name| (name, self.is_angle(i)))
    }

    /// Returns the box of the numbers that are not fixed, for a population search: angles within half a turn.
    pub fn free_box(&self) -> Vec<(f64, f64)> {
        let finite = |(low, high): (f64, f64)| low.is_finite() && high.is_finite();
        self.free.iter().map(|&i| Some(self.bounds[i]).filter(|&b| finite(b)).unwrap_or((-PI, PI))).collect()
    }

    /// Returns the design vector with the numbers that are not fixed taken from `genes`.
    pub fn from_free(&self, genes: &[f64]) -> Design {
        let mut x = self.bounds.map(|(low, _)| low);
        for (&i, &gene) in self.free.iter().zip(genes) {
            x[i] = gene;
        }
        x
    }

    /// Returns whether a number of the design vector is the length of a link or of a side.
    pub fn is_length(&self, i: usize) -> bool {
        (4..7).contains(&i)
            || (i == 2 && self.ground == GroundChart::Polar)
            || ((7..9).contains(&i) && matches!(self.coupler, CouplerChart::Distances(_)))
    }

    /// Returns the trust region within which linear models are useful, for a target of this size: a tenth of it for
    /// lengths, a tenth of a radian for angles.
    pub fn trust(&self, size: f64) -> Design {
        std::array::from_fn(|i| if self.is_angle(i) { 0.1 } else { 0.1 * size })
    }

    /// Returns whether a number is an angle, in radians; the others are lengths.
    pub fn is_angle(&self, i: usize) -> bool {
        i == OFFSET || (i == 3 && self.ground == GroundChart::Polar)
    }

    /// Returns the crank angle's offset, or the frame of a body in a motion.
    pub fn offset(&self, x: &Design) -> f64 {
        x[OFFSET]
    }

    /// Returns the shape of a design; `None` if d and e form no triangle with b.
    pub fn shape(&self, x: &Design) -> Option<Shape> {
        let pivot = |which: usize, at: Complex| match self.slanted[which] {
            Some((from, along)) => from + along * at,
            None => at,
        };
        let crank_pivot = pivot(0, Complex::new(x[0], x[1]));
        let follower_pivot = match self.ground {
            GroundChart::Pivot => pivot(1, Complex::new(x[2], x[3])),
            GroundChart::Polar => crank_pivot + Complex::from_polar(x[2], x[3]),
        };
        let offset = match self.coupler {
            CouplerChart::Offset => Complex::new(x[7], x[8]),
            CouplerChart::FollowerPin => Complex::new(x[5], 0.0),
            CouplerChart::Distances(side) => {
                let (b, d, e) = (x[5], x[7], x[8]);
                let along = (d * d + b * b - e * e) / (2.0 * b);
                let height_sq = d * d - along * along;
                if height_sq < -crate::mechanism::FLAT_TOLERANCE * (d * d + b * b) {
                    return None;
                }
                Complex::new(along, side.sign() * height_sq.max(0.0).sqrt())
            }
        };
        Some(Shape { crank_pivot, follower_pivot, crank: x[4], coupler: x[5], follower: x[6], offset })
    }

    /// Returns the design of a shape, clamped to the bounds.
    pub fn design(&self, shape: &Shape, offset: f64) -> Design {
        let mut x = self.coordinates(shape, offset);
        for (value, &(low, high)) in x.iter_mut().zip(&self.bounds) {
            *value = value.max(low).min(high);
        }
        x
    }

    /// Returns the distance of a shape from the bounds: the distances of its coordinates from them, added up (a
    /// direction as an arc of the ground); 0 if it is only rounding, which [`DesignSpace::project`] would undo.
    pub fn excess(&self, shape: &Shape) -> f64 {
        let x = self.coordinates(shape, 0.0);
        let mut excess = 0.0;
        for (i, (value, &(low, high))) in x.iter().zip(&self.bounds).enumerate().take(SHAPE) {
            let out = (low - value).max(value - high);
            if out > 1e-9 * (1.0 + value.abs()) {
                excess += if self.is_angle(i) { out * x[2] } else { out };
            }
        }
        excess
    }

    /// Returns the design vector of a shape, inside the bounds or not.
    pub fn coordinates(&self, shape: &Shape, offset: f64) -> Design {
        let ground = shape.follower_pivot - shape.crank_pivot;
        let (g_1, g_2) = match self.ground {
            GroundChart::Pivot => {
                let b = self.on_line(1, shape.follower_pivot);
                (b.re, b.im)
            }
            GroundChart::Polar => {
                let (low, high) = self.bounds[3];
                let middle = if low.is_finite() { 0.5 * (low + high) } else { 0.0 };
                (length(ground), middle + wrapped(ground.arg() - middle))
            }
        };
        let (q_1, q_2) = match self.coupler {
            CouplerChart::Offset => (shape.offset.re, shape.offset.im),
            CouplerChart::FollowerPin => (0.0, 0.0),
            CouplerChart::Distances(_) => (length(shape.offset), length(shape.offset - shape.coupler)),
        };
        let a = self.on_line(0, shape.crank_pivot);
        [a.re, a.im, g_1, g_2, shape.crank, shape.coupler, shape.follower, q_1, q_2, offset]
    }

    /// Returns a pivot's coordinates along its slanted line and across it; its own without one.
    fn on_line(&self, which: usize, pivot: Complex) -> Complex {
        match self.slanted[which] {
            Some((from, along)) => (pivot - from) * along.conj(),
            None => pivot,
        }
    }

    /// Returns the chain rule from the shape to the design vector, at a design.
    pub fn chain_rule(&self, x: &Design, shape: &Shape) -> ChainRule {
        let ground = match self.ground {
            GroundChart::Pivot => None,
            GroundChart::Polar => {
                let (sin, cos) = x[3].sin_cos();
                Some([x[2], cos, sin])
            }
        };
        let coupler = match self.coupler {
            CouplerChart::Offset => None,
            // coupler_x = b
            CouplerChart::FollowerPin => Some([[1.0, 0.0], [0.0; 2], [0.0; 2]]),
            CouplerChart::Distances(_) => {
                // coupler_x = (d^2 + b^2 - e^2)/(2b), coupler_y = t2 sqrt(d^2 - coupler_x^2)
                let (b, d, e) = (x[5], x[7], x[8]);
                let z = shape.offset;
                let floor = 1e-9 * (d + b);
                let z_y = if z.im.abs() < floor { floor.copysign(z.im) } else { z.im };
                let column = |along: f64, d_d: f64| [along, (d * d_d - z.re * along) / z_y];
                let by_b = column((b * b - d * d + e * e) / (2.0 * b * b), 0.0);
                Some([by_b, column(d / b, 1.0), column(-e / b, 0.0)])
            }
        };
        let along = self.slanted.map(|line| line.map(|(_, along)| along));
        ChainRule { ground, coupler, along }
    }

    /// Clamps a linkage's pivots and lengths exactly to their bounds if rounding took them out.
    pub fn project(&self, linkage: &FourBar) -> Result<FourBar, LinkageError> {
        self.project_off_grid(linkage, 0.0, 0.0)
    }

    /// As [`DesignSpace::project`], for numbers that were found on a grid, in parts of `size`: what lies within it of a
    /// bound, inside or outside, was on the bound there.
    pub fn project_off_grid(&self, linkage: &FourBar, grid: f64, size: f64) -> Result<FourBar, LinkageError> {
        let mut p = linkage.natural_coordinates();
        let snap = |value: &mut f64, (low, high): (f64, f64)| {
            let off = grid * size.max(value.abs());
            let slack = off.max(1e-9 * (1.0 + value.abs()));
            if *value != low && low - *value <= slack && *value - low <= off {
                *value = low;
            } else if *value != high && *value - high <= slack && high - *value <= off {
                *value = high;
            }
        };
        let b = &self.bounds;
        // Of a slanted line only the place across it is fixed: a pivot that has been moved off by rounding goes back.
        let onto = |pivot: &mut [f64; 2], (from, along): (Complex, Complex)| {
            let off = (point(*pivot) - from) * along.conj();
            let rounding = grid.max(1e-9) * (size + 1.0 + off.norm());
            if off.im != 0.0 && off.im.abs() <= rounding {
                *pivot = xy(from + along * off.re);
            }
        };
        match self.slanted[0] {
            Some(line) => onto(&mut p.crank_pivot, line),
            None => {
                snap(&mut p.crank_pivot[0], b[0]);
                snap(&mut p.crank_pivot[1], b[1]);
            }
        }
        if self.ground == GroundChart::Pivot {
            match self.slanted[1] {
                Some(line) => onto(&mut p.follower_pivot, line),
                None => {
                    snap(&mut p.follower_pivot[0], b[2]);
                    snap(&mut p.follower_pivot[1], b[3]);
                }
            }
        } else if b[3].0 == b[3].1 && b[3].0 == 0.0 {
            // A horizontal ground is kept horizontal to the last bit.
            p.follower_pivot[1] = p.crank_pivot[1];
        }
        for (pivot, locus) in [&mut p.crank_pivot, &mut p.follower_pivot].into_iter().zip(&self.loci) {
            let Some((locus, slack)) = locus else { continue };
            let nearest = locus.nearest(point(*pivot));
            if (nearest - point(*pivot)).norm() <= *slack {
                *pivot = xy(nearest);
            }
        }
        snap(&mut p.crank, b[4]);
        snap(&mut p.coupler, b[5]);
        snap(&mut p.follower, b[6]);
        match self.coupler {
            CouplerChart::Offset => {}
            CouplerChart::Distances(_) => {
                snap(&mut p.crank_side, b[7]);
                snap(&mut p.follower_side, b[8]);
            }
            CouplerChart::FollowerPin => (p.crank_side, p.follower_side) = (p.coupler, 0.0),
        }
        FourBar::new(p)
    }
}

/// Returns the part of a line that a box of limits holds, from a place along a direction of length 1; all between its ends on the
/// axes if the box holds none of it.
fn stretch(from: Complex, along: Complex, [x, y]: [Limits; 2]) -> Limits {
    let part = |Limits(low, high): Limits, from: f64, by: f64| {
        let ends = [(low - from) / by, (high - from) / by];
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    };
    let ([x0, x1], [y0, y1]) = (part(x, from.re, along.re), part(y, from.im, along.im));
    let (low, high) = (x0.max(y0), x1.min(y1));
    if low <= high { Limits(low, high) } else { Limits(x0.min(y0), x1.max(y1)) }
}

/// Returns the pivots of a shape as coordinate pairs.
pub fn pivots(shape: &Shape) -> [[f64; 2]; 2] {
    [xy(shape.crank_pivot), xy(shape.follower_pivot)]
}
