//! What an accepted candidate must satisfy, by plain code: lengths between joints, signs of cross products,
//! comparisons with the numbers in the problem, and the circuit followed step by step. Of the library only the
//! position kernel is used, and each position that it gives is checked by its distances.

use linkwright::internals::mechanism::{AssemblyMode, Complex, FourBar, Joints, LinkageType};
use linkwright::internals::record::Candidate;
use linkwright::internals::task::AngleOffset;
use linkwright::internals::task::spec::{
    ClosingPolicy, DirectionPolicy, Limits, OnePolicy, OrderPolicy, ProblemSpec, TransmissionOver,
};
use std::f64::consts::TAU;

/// A requirement is met within 1e-7 max(1, |limit|); twice that, since both sides round.
const MET: f64 = 2e-7;
/// Figures of the record agree within this part.
const FIGURES: f64 = 1e-9;

/// Everything that is not so; empty: the candidate is what it claims to be.
pub fn complaints(spec: &ProblemSpec, candidate: &Candidate) -> Vec<String> {
    let mut look = Look { spec, candidate, found: Vec::new() };
    match look.positions() {
        None => look.say("the loop is open at a point"),
        Some(joints) => {
            look.errors(&joints);
            look.design(&joints[0]);
            look.links();
            look.timing();
            look.order_and_circuit(&joints);
            look.motion(&joints);
        }
    }
    look.found
}

struct Look<'a> {
    spec: &'a ProblemSpec,
    candidate: &'a Candidate,
    found: Vec<String>,
}

fn cross(x: Complex, y: Complex) -> f64 {
    x.re * y.im - x.im * y.re
}

/// The angle between two vectors, degrees in [0, 180].
fn between(x: Complex, y: Complex) -> f64 {
    cross(x, y).abs().atan2(x.re * y.re + x.im * y.im).to_degrees()
}

fn span(list: &[f64]) -> (f64, f64) {
    list.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(*v), high.max(*v)))
}

impl Look<'_> {
    fn say(&mut self, what: impl Into<String>) {
        self.found.push(what.into());
    }

    fn at_most(&mut self, name: &str, value: f64, limit: f64) {
        if value.is_nan() || value > limit + MET * limit.abs().max(1.0) {
            self.say(format!("{name} is {value:e}, above {limit:e}"));
        }
    }

    fn at_least(&mut self, name: &str, value: f64, limit: f64) {
        if value.is_nan() || value < limit - MET * limit.abs().max(1.0) {
            self.say(format!("{name} is {value:e}, below {limit:e}"));
        }
    }

    fn within(&mut self, name: &str, value: f64, limits: Option<Limits>) {
        if let Some(Limits(low, high)) = limits {
            self.at_least(name, value, low);
            self.at_most(name, value, high);
        }
    }

    fn inside(&mut self, name: &str, p: Complex, b: [f64; 4]) {
        self.at_least(name, p.re, b[0]);
        self.at_least(name, p.im, b[1]);
        self.at_most(name, p.re, b[2]);
        self.at_most(name, p.im, b[3]);
    }

    fn linkage(&self) -> &FourBar {
        self.candidate.linkage.four_bar().expect("a four-bar")
    }

    /// The joints at an angle (degrees), if the loop closes.
    fn at(&self, deg: f64, t1: AssemblyMode) -> Option<Joints> {
        self.linkage().position_with(deg.to_radians(), t1).joints()
    }

    /// The joints at every point, checked by their distances.
    fn positions(&mut self) -> Option<Vec<Joints>> {
        let n = self.spec.task.points.len();
        let (angles, signs) = (&self.candidate.crank_deg, &self.candidate.t1_at);
        if angles.len() != n || signs.len() != n {
            self.say(format!("{} angles and {} signs for {n} points", angles.len(), signs.len()));
            return None;
        }
        let joints: Option<Vec<Joints>> = angles.iter().zip(signs).map(|(d, t)| self.at(*d, *t)).collect();
        let joints = joints?;
        let l = *self.linkage();
        let (a_0, b_0) = (l.crank_pivot(), l.follower_pivot());
        let scale = l.longest_link() + l.crank_side() + a_0.norm() + b_0.norm();
        for (j, at) in joints.iter().enumerate() {
            let lengths = [
                ("a", (at.crank_pin - a_0).norm(), l.crank()),
                ("b", (at.follower_pin - at.crank_pin).norm(), l.coupler()),
                ("c", (at.follower_pin - b_0).norm(), l.follower()),
                ("d", (at.coupler_point - at.crank_pin).norm(), l.crank_side()),
                ("e", (at.coupler_point - at.follower_pin).norm(), l.follower_side()),
            ];
            for (name, is, should) in lengths {
                // A flat position is closed within the kernel's tolerance of 1e-9 or so of the lengths.
                if (is - should).abs() > 1e-8 * scale {
                    self.say(format!("{name} at point {j} is {is:e} instead of {should:e}"));
                }
            }
            let turned = (at.crank_pin - a_0).arg() - self.candidate.crank_deg[j].to_radians();
            if l.crank() * (turned - TAU * (turned / TAU).round()).abs() > 1e-8 * scale {
                self.say(format!("the crank at point {j} is not where it is said to be"));
            }
            let side = cross(b_0 - at.crank_pin, at.follower_pin - at.crank_pin);
            if side * self.candidate.t1_at[j].sign() < -1e-7 * scale * scale {
                self.say(format!("the assembly at point {j} is the other one"));
            }
        }
        Some(joints)
    }

    fn errors(&mut self, joints: &[Joints]) {
        let path = &self.spec.task;
        let errors: Vec<f64> = path
            .points
            .iter()
            .zip(joints)
            .map(|([x, y], j)| (Complex::new(*x, *y) - j.coupler_point).norm())
            .collect();
        let sum: f64 = errors.iter().map(|e| e * e).sum();
        let weighted: f64 = match &path.weight {
            None => sum,
            Some(weights) => errors.iter().zip(weights).map(|(e, w)| w * e * e).sum(),
        };
        let (_, max) = span(&errors);
        let (x, y): (Vec<f64>, Vec<f64>) = path.points.iter().map(|[x, y]| (*x, *y)).unzip();
        let size = (span(&x).1 - span(&x).0).hypot(span(&y).1 - span(&y).0);
        let rms = (sum / errors.len() as f64).sqrt();
        let e = &self.candidate.error;
        // An error near zero is the difference of coordinates: their rounding is its floor.
        let floor = 1e-12 * size + 1e-14 * joints[0].coupler_point.norm();
        let figures = [
            ("sum_sq", e.sum_sq.sqrt(), sum.sqrt()),
            ("objective", e.objective.sqrt(), weighted.sqrt()),
            ("max", e.max, max),
            ("rms", e.rms, rms),
            ("rms_over_size", e.rms_over_size * size, rms),
        ];
        for (name, recorded, is) in figures {
            if (recorded - is).abs() > FIGURES * is + 10.0 * floor {
                self.say(format!("error.{name} is recorded as {recorded:e}, it is {is:e}"));
            }
        }
        if let Some(tolerances) = &path.tolerance {
            for (j, (error, tolerance)) in errors.iter().zip(tolerances).enumerate() {
                self.at_most(&format!("the error at point {j}"), *error, *tolerance);
            }
        }
    }

    fn design(&mut self, at: &Joints) {
        let (l, d) = (*self.linkage(), self.spec.design.clone());
        let (a, b) = (l.crank_pivot(), l.follower_pivot());
        let ground = b - a;
        for (name, p, limits) in [("A", a, d.crank_pivot), ("B", b, d.follower_pivot)] {
            self.within(&format!("{name}.x"), p.re, limits.map(|l| l[0]));
            self.within(&format!("{name}.y"), p.im, limits.map(|l| l[1]));
        }
        self.within("a", l.crank(), d.a);
        self.within("b", l.coupler(), d.b);
        self.within("c", l.follower(), d.c);
        self.within("d", l.crank_side(), d.d);
        self.within("e", l.follower_side(), d.e);
        self.within("ground", ground.norm(), d.ground);
        if let Some(Limits(low, high)) = d.ground_angle_deg {
            let angle = ground.arg().to_degrees();
            let nearest = (-3..=3).map(|k| angle + 360.0 * f64::from(k)).min_by(|x, y| {
                let off = |v: f64| (low - v).max(v - high);
                off(*x).total_cmp(&off(*y))
            });
            self.within("ground_angle_deg", nearest.unwrap_or(angle), d.ground_angle_deg);
        }
        // The coupler's frame as it stands at the first point: its rounding is that of the joints.
        let along = (at.follower_pin - at.crank_pin) / (at.follower_pin - at.crank_pin).norm();
        let offset = (at.coupler_point - at.crank_pin) * along.conj();
        let slack = 1e-9 * (l.longest_link() + l.crank_side()) * (1.0 + l.crank_side() / l.coupler());
        for (name, value, limits) in
            [("coupler_x", offset.re, d.coupler_x), ("coupler_y", offset.im, d.coupler_y)]
        {
            self.within(name, value, limits.map(|Limits(low, high)| Limits(low - slack, high + slack)));
        }
        if let Some(b_) = self.spec.require.pivots_in.as_ref().and_then(|region| region.as_box()) {
            self.inside("A in pivots_in", a, b_);
            self.inside("B in pivots_in", b, b_);
        }
    }

    /// Type and ratio from four lengths.
    fn links(&mut self) {
        let l = *self.linkage();
        let links = [(l.follower_pivot() - l.crank_pivot()).norm(), l.crank(), l.coupler(), l.follower()];
        let (least, most) = span(&links);
        self.at_most("the link ratio", most / least, self.spec.require.link_ratio_max);
        if let Some(limit) = self.spec.require.longest_max {
            self.at_most("the longest link", most.max(l.crank_side()).max(l.follower_side()), limit);
        }
        let margin = links.iter().sum::<f64>() - 2.0 * (least + most);
        let shortest = links.iter().position(|v| *v == least);
        let kind = match shortest {
            _ if margin.abs() <= 1e-6 * most => None,
            _ if margin < 0.0 => Some(LinkageType::TripleRocker),
            Some(0) => Some(LinkageType::DoubleCrank),
            Some(1) => Some(LinkageType::CrankRocker),
            Some(2) => Some(LinkageType::DoubleRocker),
            _ => Some(LinkageType::RockerCrank),
        };
        let types = &self.spec.require.types;
        if let Some(kind) = kind {
            if !types.is_empty() && !types.contains(&kind) {
                self.say(format!("a {kind}, which is not asked for"));
            }
            if kind != self.candidate.linkage_type.expect("a type") {
                self.say(format!("a {kind}, recorded as a {}", self.candidate.linkage_type.expect("a type")));
            }
        }
    }

    /// Prescribed crank angles are the prescribed ones.
    fn timing(&mut self) {
        let Some(timing) = &self.spec.task.timing else { return };
        let (has, wants) = (&self.candidate.crank_deg, &timing.crank_deg);
        let off = |way: f64| {
            let steps = has.iter().zip(wants).map(|(h, w)| ((h - has[0]) - way * (w - wants[0])).abs());
            steps.fold(0.0, f64::max)
        };
        let free = timing.offset == AngleOffset::Free;
        let worst = if free { off(1.0).min(off(-1.0)) } else { off(1.0) };
        if worst > 1e-8 {
            self.say(format!("the steps of the crank are off by {worst:e} degrees"));
        }
        let from = match timing.offset {
            AngleOffset::Free => return,
            AngleOffset::Fixed => 0.0,
            AngleOffset::Ground => {
                (self.linkage().follower_pivot() - self.linkage().crank_pivot()).arg().to_degrees()
            }
        };
        let turns = (has[0] - from - wants[0]) / 360.0;
        if (turns - turns.round()).abs() > 1e-10 * (1.0 + turns.abs()) {
            self.say(format!("the crank starts {} turns off", turns - turns.round()));
        }
        if self.candidate.t1_at.iter().any(|t| *t != self.candidate.t1_at[0]) {
            self.say("timed points on two assemblies");
        }
    }

    /// How many points say something of the order: a last point that repeats the first says nothing.
    fn ordered(&self) -> usize {
        let points = &self.spec.task.points;
        let repeats = points.len() > 2 && points[0] == points[points.len() - 1];
        if repeats { points.len() - 1 } else { points.len() }
    }

    /// Every point on the circuit that is followed from the first, and passed in order.
    fn order_and_circuit(&mut self, joints: &[Joints]) {
        let require = &self.spec.require;
        let circuit_one = require.circuit == OnePolicy::One;
        if require.branch == OnePolicy::One
            && circuit_one
            && self.candidate.t1_at.iter().any(|t| *t != self.candidate.t1_at[0])
        {
            self.say("points on two branches");
        }
        if !circuit_one || self.near_change_point() {
            return;
        }
        let places = Circuit::through(self.linkage(), &joints[0]).map(|circuit| {
            let at = joints.iter().map(|j| circuit.place(j));
            (at.collect::<Vec<_>>(), circuit.steps.len() as f64)
        });
        let Some((places, around)) = places else { return };
        if let Some(j) = places.iter().position(Option::is_none) {
            self.say(format!("point {j} is not on the circuit of point 0"));
            return;
        }
        if self.spec.task.timing.is_some() || require.order == OrderPolicy::Any {
            return;
        }
        let along: Vec<f64> = places.into_iter().flatten().take(self.ordered()).collect();
        // Forth and back in steps of the circuit; two steps are the trace's own resolution.
        let total = |way: f64| -> f64 {
            let step = |w: &[f64]| {
                let step = (way * (w[1] - w[0])).rem_euclid(around);
                if step > around - 2.0 { 0.0 } else { step }
            };
            along.windows(2).map(step).sum()
        };
        if total(1.0).min(total(-1.0)) > around + 2.0 {
            self.say("the points are not passed in order");
        }
    }

    fn near_change_point(&self) -> bool {
        self.candidate.grashof_margin.abs() < 1e-3 * self.linkage().longest_link()
    }

    /// Between the points, where the motion stays on one branch: closed, inside the footprint, at a good
    /// transmission angle, the right way round.
    fn motion(&mut self, joints: &[Joints]) {
        let require = self.spec.require.clone();
        let (l, t1) = (*self.linkage(), self.candidate.t1_at[0]);
        let deg = self.candidate.crank_deg[..self.ordered()].to_vec();
        let angle_of = |j: &Joints| {
            let mu = between(j.crank_pin - j.follower_pin, l.follower_pivot() - j.follower_pin);
            mu.min(180.0 - mu)
        };
        let mut corners = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
        let hold = |[x0, y0, x1, y1]: &mut [f64; 4], p: Complex| {
            (*x0, *y0) = (x0.min(p.re), y0.min(p.im));
            (*x1, *y1) = (x1.max(p.re), y1.max(p.im));
        };
        [l.crank_pivot(), l.follower_pivot()].into_iter().for_each(|p| hold(&mut corners, p));
        for j in joints {
            [j.crank_pin, j.follower_pin, j.coupler_point].into_iter().for_each(|p| hold(&mut corners, p));
        }
        let extent = |[x0, y0, x1, y1]: [f64; 4]| (x1 - x0).hypot(y1 - y0);
        if let Some(limit) = require.extent_max {
            self.at_most("the extent at the points", extent(corners), limit);
        }
        if let Some(b) = require.footprint_in {
            self.inside("A in footprint_in", l.crank_pivot(), b);
            self.inside("B in footprint_in", l.follower_pivot(), b);
            for j in joints {
                for p in [j.crank_pin, j.follower_pin, j.coupler_point] {
                    self.inside("a joint at a point in footprint_in", p, b);
                }
            }
        }
        let turns = matches!(
            self.candidate.linkage_type.expect("a type"),
            LinkageType::CrankRocker | LinkageType::DoubleCrank
        );
        let over = require.transmission_over.unwrap_or(if turns {
            TransmissionOver::Cycle
        } else {
            TransmissionOver::Used
        });
        let limit = require.transmission_deg_min.unwrap_or(0.0);
        if over == TransmissionOver::Cycle {
            for i in 0..720 {
                if let Some(j) = self.at(0.5 * f64::from(i), t1) {
                    // Samples lie inside the range: what they show is no worse than the worst.
                    self.at_least("the transmission angle over the turn", angle_of(&j), limit - 1e-5);
                }
            }
        } else {
            for j in joints {
                self.at_least("the transmission angle at a point", angle_of(j), limit - 1e-5);
            }
        }
        let one = require.branch == OnePolicy::One && require.circuit == OnePolicy::One;
        if !one || self.near_change_point() || (require.order == OrderPolicy::Any && turns) {
            return;
        }
        let timed = self.spec.task.timing.is_some();
        let (low, high) = span(&deg);
        if !timed && require.order == OrderPolicy::Required {
            let rises = deg[deg.len() - 1] >= deg[0];
            let way = if rises { 1.0 } else { -1.0 };
            if deg.windows(2).any(|w| way * (w[1] - w[0]) < -1e-6) {
                self.say(format!("crank angles go forth and back: {deg:?}"));
            }
            self.at_most("the turn of the crank", high - low, 360.0 + 1e-6);
        }
        // Points in any order have no plain direction.
        let one_way = if timed { turns } else { require.order == OrderPolicy::Required };
        if require.direction != DirectionPolicy::Any && one_way {
            let rises = deg[deg.len() - 1] >= deg[0];
            if rises != (require.direction == DirectionPolicy::Ccw) {
                self.say(format!("the crank turns the wrong way: {deg:?}"));
            }
        }
        let closed = self.spec.task.closed || self.ordered() < joints.len();
        let returns = self.spec.task.closed || (!timed && self.ordered() < joints.len());
        if returns
            && !turns
            && require.order == OrderPolicy::Required
            && require.closing == ClosingPolicy::OneWay
        {
            self.say("the crank does not turn fully, and the path ends where it begins");
        }
        let high = if turns && closed { high.max(low + 360.0) } else { high.min(low + 360.0) };
        for i in 0..=400 {
            let angle = low + (high - low) * f64::from(i) / 400.0;
            let Some(j) = self.at(angle, t1) else {
                self.say(format!("the loop is open on the way, at {angle} degrees"));
                return;
            };
            if over == TransmissionOver::Used {
                self.at_least("the transmission angle on the way", angle_of(&j), limit - 1e-5);
            }
            [j.crank_pin, j.follower_pin, j.coupler_point].into_iter().for_each(|p| hold(&mut corners, p));
            if let Some(b) = require.footprint_in {
                for p in [j.crank_pin, j.follower_pin, j.coupler_point] {
                    self.inside("a joint on the way in footprint_in", p, b);
                }
            }
        }
        if let Some(limit) = require.extent_max {
            self.at_most("the extent on the way", extent(corners), limit);
        }
    }
}

/// A circuit, followed by small steps: directions of crank and coupler.
struct Circuit {
    pivots: [Complex; 2],
    steps: Vec<[Complex; 2]>,
}

/// Radians a step of (crank, coupler).
const STEP: f64 = 8e-3;

impl Circuit {
    /// The circuit through a position: along the curve |A + a e + b u - B| = c in the angles of e and u.
    /// `None` where it does not come round: too near to a change point to be followed.
    fn through(linkage: &FourBar, from: &Joints) -> Option<Circuit> {
        let (a, b, c) = (linkage.crank(), linkage.coupler(), linkage.follower());
        let pivots = [linkage.crank_pivot(), linkage.follower_pivot()];
        let ground = pivots[1] - pivots[0];
        let polar = Complex::from_polar;
        // F = (|Y|^2 - c^2)/2 and its derivatives by the two angles.
        let value = |[phi, theta]: [f64; 2]| {
            let (e, u) = (polar(a, phi), polar(b, theta));
            let y = e + u - ground;
            (0.5 * (y.norm_sqr() - c * c), [cross(e, y), cross(u, y)])
        };
        let start = [(from.crank_pin - pivots[0]).arg(), (from.follower_pin - from.crank_pin).arg()];
        let mut at = start;
        let mut last: Option<[f64; 2]> = None;
        let mut steps = Vec::new();
        for count in 0..(8.0 * TAU / STEP) as usize {
            for _ in 0..4 {
                let (miss, g) = value(at);
                let sq = g[0] * g[0] + g[1] * g[1];
                if sq == 0.0 {
                    return None;
                }
                at = [at[0] - miss * g[0] / sq, at[1] - miss * g[1] / sq];
            }
            let away = [0, 1].map(|i| {
                let d = at[i] - start[i];
                d - TAU * (d / TAU).round()
            });
            if count > 8 && away[0].hypot(away[1]) < 0.75 * STEP {
                return Some(Circuit { pivots, steps });
            }
            steps.push([polar(1.0, at[0]), polar(1.0, at[1])]);
            let (_, g) = value(at);
            let norm = g[0].hypot(g[1]);
            let mut along = [-g[1] / norm, g[0] / norm];
            if last.is_some_and(|l| l[0] * along[0] + l[1] * along[1] < 0.0) {
                along = along.map(|v| -v);
            }
            last = Some(along);
            at = [at[0] + STEP * along[0], at[1] + STEP * along[1]];
        }
        None
    }

    /// Where a position stands along the circuit, in steps; `None` where it is on none of them.
    fn place(&self, joints: &Joints) -> Option<f64> {
        let unit = |z: Complex| z / z.norm();
        let (e, u) = (unit(joints.crank_pin - self.pivots[0]), unit(joints.follower_pin - joints.crank_pin));
        let off = |i: usize| (self.steps[i][0] - e).norm().hypot((self.steps[i][1] - u).norm());
        let nearest = (0..self.steps.len()).min_by(|i, j| off(*i).total_cmp(&off(*j)))?;
        (off(nearest) < 2.0 * STEP).then_some(nearest as f64)
    }
}
