//! The sections of a one-parameter family of targets by (t - t0) L(q) = s, and homotopy path tracking between them.
//!
//! The displacements move along a complex line, D(t) = D_0 + t V, and the solutions of all its targets form a curve. On it
//! t and the coordinates q_1 .. q_4 are functions, and L(q) = c_0 + c_1 q_1 + .. + c_4 q_4. With n Newton's step at fixed t and
//! w = dz/dt, both from the 8x8 system of a fixed target ([`steps`]), Newton's step of the system with the equation
//! h = (t - t0) L - s = 0 and the unknown t is
//!
//! ```text
//! dt = -(h + dh(n)) / dh(w)      dz = n + w dt      dh(n) = (t - t0) dL(n)      dh(w) = (t - t0) dL(w) + L
//! ```

use linkwright::internals::numbers::arithmetic::Complex;
use linkwright::internals::numbers::arithmetic::complex_lanes::{ComplexLanes, ORDER};
use linkwright::internals::numbers::arithmetic::dispatch::vectorised;
use linkwright::internals::numbers::arithmetic::lane::LANES;
use linkwright::internals::numbers::arithmetic::operators;
use linkwright::internals::numbers::nine_point::equations::{UNKNOWNS, Unknowns, steps};
use linkwright::internals::numbers::nine_point::target::{Closure, Displacements, Kind};
use linkwright::internals::numbers::nine_point::tracker::{NODES, Parameters, continuation};
use rayon::prelude::*;

/// The number of coordinates q.
pub const COORDINATES: usize = 4;

/// A target that moves along a complex line: D(t) = at_zero + t velocity.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// The displacements at t = 0.
    pub at_zero: Displacements,
    /// Their derivative by t.
    pub velocity: Displacements,
}

/// A section (t - t0) (c_0 + c_1 q_1 + ..) = s of the curve.
#[derive(Clone, Copy, Debug)]
pub struct Section {
    /// The coefficients c_0, c_1, ..
    pub form: [Complex; COORDINATES + 1],
    /// t0.
    pub t: Complex,
    /// s.
    pub s: Complex,
}

impl Section {
    /// Returns the section at `by` of the straight way to another.
    fn towards(&self, other: &Section, by: f64) -> Section {
        let between = |one: Complex, other: Complex| one * (1.0 - by) + other * by;
        Section {
            form: std::array::from_fn(|i| between(self.form[i], other.form[i])),
            t: between(self.t, other.t),
            s: between(self.s, other.s),
        }
    }
}

/// A point of the curve: the unknowns of a solution in the order of [`Unknowns`], and t.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// The solution.
    pub unknowns: [Complex; UNKNOWNS],
    /// The place of its target on the line.
    pub t: Complex,
}

/// A number of each lane with its derivatives along two directions.
#[derive(Clone, Copy)]
struct Dual {
    value: ComplexLanes,
    along: [ComplexLanes; 2],
}

impl Dual {
    #[inline(always)]
    fn product(self, other: Dual) -> Dual {
        let of = |k: usize| self.value * other.along[k] + self.along[k] * other.value;
        Dual { value: self.value * other.value, along: [of(0), of(1)] }
    }

    #[inline(always)]
    fn quotient(self, other: Dual) -> Dual {
        let inverse = other.value.recip();
        let value = self.value * inverse;
        let of = |k: usize| (self.along[k] - value * other.along[k]) * inverse;
        Dual { value, along: [of(0), of(1)] }
    }
}

operators! { Dual:
    Add add(x, y) {
        Dual { value: x.value + y.value, along: [x.along[0] + y.along[0], x.along[1] + y.along[1]] }
    }
    Sub sub(x, y) {
        Dual { value: x.value - y.value, along: [x.along[0] - y.along[0], x.along[1] - y.along[1]] }
    }
    Mul mul(x, y) { x.product(y) }
    Div div(x, y) { x.quotient(y) }
}

/// Evaluates the coordinates q: functions of a solution that the other solutions of its class share, two and their starred
/// twins.
///
/// Of four-bars with cognates: the sum of the three foci, and that of the products of the two pins at each. Of others: x + y and
/// a + b. Of slider-cranks, whose cognates exchange x and a - x: a and x (x - a). Of inverted slider-cranks: x and a.
#[inline(always)]
fn coordinates(kind: Kind, z: &Unknowns, along: [&Unknowns; 2]) -> [Dual; COORDINATES] {
    let dual = |i: usize| Dual { value: z[i], along: [along[0][i], along[1][i]] };
    let twins: [[Dual; 2]; 2] = std::array::from_fn(|twin| {
        let [x, u, y, v] = [0, 1, 4, 5].map(|i| dual(i + 2 * twin));
        let (a, b) = (x - u, y - v);
        match kind.closure {
            Closure::FourBar if kind.poses == 0 && kind.pivots < 2 => {
                let (p, c) = (u * y / (x - y), (b * x - a * y) / (x - y));
                [a + b + c, p * (c - p) - x * u - y * v]
            }
            Closure::FourBar => [x + y, a + b],
            Closure::SliderCrank => [a, x * u],
            Closure::InvertedSliderCrank => [x, a],
        }
    });
    [twins[0][0], twins[0][1], twins[1][0], twins[1][1]]
}

/// Returns the coordinates q of a point.
pub fn coordinates_of(kind: Kind, point: &Point) -> [Complex; COORDINATES] {
    let z: Unknowns = point.unknowns.map(ComplexLanes::splat);
    coordinates(kind, &z, [&z, &z]).map(|q| q.value.get(0))
}

/// Seventeen unknowns, t the last, of eight points.
type Lanes = [ComplexLanes; UNKNOWNS + 1];

/// Computes Newton's step at the section of each lane, and the derivative along the way with the velocity `moving`.
#[inline(always)]
fn newton(z: &Lanes, line: &Line, at: &[Section; LANES], moving: &Section) -> [Lanes; 2] {
    let lanes = |of: &dyn Fn(&Section) -> Complex| {
        let mut all = ComplexLanes::ZERO;
        at.iter().enumerate().for_each(|(lane, section)| all.set(lane, of(section)));
        all
    };
    let t = z[UNKNOWNS];
    let velocity = line.velocity.map(ComplexLanes::splat);
    let displaced =
        line.at_zero.zip(&line.velocity, |d, v| ComplexLanes::splat(d) + ComplexLanes::splat(v) * t);
    let mut unknowns = [ComplexLanes::ZERO; UNKNOWNS];
    unknowns.copy_from_slice(&z[..UNKNOWNS]);
    let ([fixed, by_t], _) = steps::<2>(&unknowns, &displaced, &velocity);
    let q = coordinates(line.at_zero.kind, &unknowns, [&fixed, &by_t]);
    let (mut form, mut along) = (lanes(&|section| section.form[0]), [ComplexLanes::ZERO; 2]);
    let mut moved = ComplexLanes::splat(moving.form[0]);
    for (i, q) in q.iter().enumerate() {
        let c = lanes(&|section| section.form[i + 1]);
        form = form + c * q.value;
        along = [along[0] + c * q.along[0], along[1] + c * q.along[1]];
        moved = moved + ComplexLanes::splat(moving.form[i + 1]) * q.value;
    }
    let away = t - lanes(&|section| section.t);
    let per_t = (away * along[1] + form).recip();
    let dt = -(away * form - lanes(&|section| section.s) + away * along[0]) * per_t;
    let by_way = away * moved - ComplexLanes::splat(moving.t) * form - ComplexLanes::splat(moving.s);
    let rate = -by_way * per_t;
    let all = |of: &dyn Fn(usize) -> ComplexLanes| std::array::from_fn(of);
    [
        all(&|i| if i < UNKNOWNS { fixed[i] + by_t[i] * dt } else { dt }),
        all(&|i| if i < UNKNOWNS { by_t[i] * rate } else { rate }),
    ]
}

/// The size below which the change of an unknown is not measured relative to it.
const FLOOR: f64 = 1e-2;
/// The change below which a second Newton step need not be smaller than the first.
const ROUNDING: f64 = 1e-6;

/// Returns the change of one lane's point, relative to its unknowns.
fn change(step: &Lanes, of: &Lanes, lane: usize) -> f64 {
    let relative = |i: usize| {
        let z = of[i].get(lane) + if (ORDER..UNKNOWNS).contains(&i) { 1.0 } else { 0.0 };
        step[i].get(lane).norm_sqr() / (z.norm_sqr() + FLOOR * FLOOR)
    };
    (0..=UNKNOWNS).map(relative).sum::<f64>().sqrt()
}

/// A point and its derivative on the way, at a place of the way.
type Node = (f64, [Complex; UNKNOWNS + 1], [Complex; UNKNOWNS + 1]);

/// The state of one path: the last nodes, the newest first, and the length of the next step.
struct Path {
    nodes: Vec<Node>,
    h: f64,
    steps: u32,
    is_started: bool,
}

impl Path {
    fn from(point: &Point) -> Path {
        let z = std::array::from_fn(|i| if i < UNKNOWNS { point.unknowns[i] } else { point.t });
        Path { nodes: vec![(0.0, z, [Complex::ZERO; UNKNOWNS + 1])], h: 0.0, steps: 0, is_started: false }
    }

    fn is_open(&self, with: &Parameters) -> bool {
        self.nodes[0].0 < 1.0 && self.steps < with.most_steps
    }

    fn predicted(&self) -> [Complex; UNKNOWNS + 1] {
        let at: Vec<f64> = self.nodes.iter().map(|node| node.0).collect();
        let (of_value, of_tangent) = continuation(at[0] + self.h, &at);
        std::array::from_fn(|i| {
            let terms = self.nodes.iter().enumerate();
            terms.map(|(k, node)| node.1[i] * of_value[k] + node.2[i] * of_tangent[k]).sum()
        })
    }

    /// Accepts or rejects a step after its two Newton steps `e`, and chooses the length of the next.
    fn judge(&mut self, node: Node, e: [f64; 2], with: &Parameters) {
        self.steps += 1;
        let order = 2 * self.nodes.len();
        let wanted = (with.aim / e[0].max(1e-12)).powf(1.0 / order as f64);
        if e[0] <= with.accept && (!self.is_started || e[1] <= (with.contraction * e[0]).max(ROUNDING)) {
            if self.is_started {
                self.h = (self.h * wanted.clamp(0.4, 2.5)).min(with.longest_step);
                self.nodes.insert(0, node);
                self.nodes.truncate(NODES);
            } else {
                (self.nodes[0], self.h, self.is_started) = (node, with.first_step, true);
            }
        } else {
            self.h *= if wanted.is_finite() { wanted.clamp(0.2, 0.6) } else { 0.3 };
        }
        let left = 1.0 - self.nodes[0].0;
        if self.h >= left {
            self.h = left;
        } else if 2.0 * self.h > left {
            self.h = 0.5 * left;
        }
        if !self.is_started || (self.h < 1e-13 && left > 0.0) {
            self.steps = with.most_steps;
        }
    }
}

/// Tracks eight points from one section to another; `None` in place of a path that is lost.
fn track_eight(
    starts: &[Point],
    line: &Line,
    way: (&Section, &Section),
    with: &Parameters,
) -> Vec<Option<Point>> {
    let (from, to) = way;
    let moving = Section {
        form: std::array::from_fn(|i| to.form[i] - from.form[i]),
        t: to.t - from.t,
        s: to.s - from.s,
    };
    let mut paths: Vec<Path> = starts.iter().map(Path::from).collect();
    while paths.iter().any(|path| path.is_open(with)) {
        let (mut z, mut places) = ([ComplexLanes::ZERO; UNKNOWNS + 1], [0.0; LANES]);
        let mut sections = [*from; LANES];
        for lane in 0..LANES {
            let path = &paths[lane.min(paths.len() - 1)];
            places[lane] = if path.is_open(with) { path.nodes[0].0 + path.h } else { path.nodes[0].0 };
            let at = if path.is_open(with) { path.predicted() } else { path.nodes[0].1 };
            z.iter_mut().zip(at).for_each(|(z, at)| z.set(lane, at));
            sections[lane] = from.towards(to, places[lane]);
        }
        let [first, _] = newton(&z, line, &sections, &moving);
        let e_1: [f64; LANES] = std::array::from_fn(|lane| change(&first, &z, lane));
        add(&mut z, &first);
        let [second, tangent] = newton(&z, line, &sections, &moving);
        let e_2: [f64; LANES] = std::array::from_fn(|lane| change(&second, &z, lane));
        add(&mut z, &second);
        for (lane, path) in paths.iter_mut().enumerate().filter(|(_, path)| path.is_open(with)) {
            let values = |of: &Lanes| std::array::from_fn(|i| of[i].get(lane));
            path.judge((places[lane], values(&z), values(&tangent)), [e_1[lane], e_2[lane]], with);
        }
    }
    polished(&paths, line, (to, &moving))
}

/// Applies Newton's method to the ends of eight paths, at the section `to`; `None` for a path that did not arrive, or does not
/// converge.
fn polished(paths: &[Path], line: &Line, (to, moving): (&Section, &Section)) -> Vec<Option<Point>> {
    let mut z = [ComplexLanes::ZERO; UNKNOWNS + 1];
    for lane in 0..LANES {
        let at = paths[lane.min(paths.len() - 1)].nodes[0].1;
        z.iter_mut().zip(at).for_each(|(z, at)| z.set(lane, at));
    }
    let mut last = [f64::INFINITY; LANES];
    for _ in 0..POLISHING {
        let [step, _] = newton(&z, line, &[*to; LANES], moving);
        last = std::array::from_fn(|lane| change(&step, &z, lane));
        add(&mut z, &step);
    }
    let ended = |(lane, path): (usize, &Path)| {
        let point = Point { unknowns: std::array::from_fn(|i| z[i].get(lane)), t: z[UNKNOWNS].get(lane) };
        (path.nodes[0].0 >= 1.0 && last[lane] < CONVERGED).then_some(point)
    };
    paths.iter().enumerate().map(ended).collect()
}

/// The number of Newton steps on arrival.
const POLISHING: usize = 4;
/// The largest last step of a path that has arrived.
const CONVERGED: f64 = 1e-9;

fn add(z: &mut Lanes, step: &Lanes) {
    z.iter_mut().zip(step).for_each(|(z, step)| *z = *z + *step);
}

/// Tracks points from one section to another, lost ones again with tighter tolerances.
pub fn track_points(starts: &[Point], line: &Line, way: (&Section, &Section)) -> Vec<Option<Point>> {
    let mut ends: Vec<Option<Point>> = vec![None; starts.len()];
    for round in 0..4 {
        let with = Parameters { longest_step: 0.2, ..Parameters::default() }.tightened(round);
        let open: Vec<usize> = (0..starts.len()).filter(|&path| ends[path].is_none()).collect();
        let chunks: Vec<Vec<Option<Point>>> = open
            .par_chunks(LANES)
            .map(|chunk| {
                let starts: Vec<Point> = chunk.iter().map(|&path| starts[path]).collect();
                vectorised(|| track_eight(&starts, line, way, &with))
            })
            .collect();
        for (path, end) in open.into_iter().zip(chunks.into_iter().flatten()) {
            ends[path] = end;
        }
    }
    ends
}
