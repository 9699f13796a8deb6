//! Bounds of the displacements of the links of a six-bar or an eight-bar on a stretch, from dyad to dyad.
//!
//! On a stretch from phi - h to phi + h, all is measured from its middle, where positions and their derivatives by the crank angle
//! (velocities v of points, rates q of links) are known. The crank turns by at most h. Of a dyad whose ends move by at most r_X and
//! r_Y, with V = Y - X, s = |V|, l1 = |XF|, l2 = |YF| and e1, e2 the directions X-F and Y-F, the link X-F
//!
//! ```text
//! turns by at most      w = asin((r_X + r_Y)/s) + max |delta - delta_middle|
//! has the rate          q = ((v_Y - v_X) . e2) / (l1 e1 x e2)
//! changes that by at most
//!     dq = (d(v_Y - v_X) + |v_Y - v_X| k2 + |q| l1 (k1 + k2)) / (l1 (|e1 x e2| - k1 - k2)),   k = 2 sin(min(pi, w)/2)
//! and so turns by at most  h (|q| + dq)
//! ```
//!
//! and so for Y-F. A place z in the frame of a link moves by at most each of
//!
//! ```text
//! r_X + |z| k,   |1 - z/l1| r_X + |z/l1| r_F,   h (|v| + dv),   dv = dv_X + |z| (dq + (|q| + dq) k)
//! ```
//!
//! The first bounds hold where links are nearly in line and rates are without bound; the second follow the true motion as the
//! stretch becomes short. delta is the angle at X between V and the link (law of cosines), a function of s, which changes by at most
//! r_X + r_Y and stays between |l1 - l2| and l1 + l2; delta has its one extreme at s^2 = l1^2 - l2^2. Derived here.

use crate::mechanism::dyad_chain::kinds::{CRANK, MAX_BODIES};
use crate::mechanism::four_bar::transmission::angle_opposite;
use crate::mechanism::multi_loop::Bodies;
use crate::mechanism::{Complex, MultiLoop, cross, dot, turned};
use std::f64::consts::PI;

/// Rounds in which the turns of a dyad's links are bounded by each other.
const ROUNDS: usize = 2;

/// Bounds of the displacements of all links on a stretch.
pub(super) struct Displacements {
    links: [OfLink; MAX_BODIES],
    half: f64,
}

/// The motion of a link in the middle of a stretch, and bounds of its changes.
#[derive(Clone, Copy)]
struct OfLink {
    /// The direction of its frame.
    direction: Complex,
    /// The derivative of the origin of its frame by the crank angle.
    velocity: Complex,
    /// The derivative of its angle by the crank angle.
    rate: f64,
    /// Bound of the displacement of the origin.
    origin: f64,
    /// Bound of the displacement of a place at 1 from the origin about it.
    chord: f64,
    /// Bound of the change of the velocity.
    velocity_change: f64,
    /// Bound of the change of the rate.
    rate_change: f64,
    /// The distance of the joint at its far end, with the bound of that joint.
    far: Option<(f64, f64)>,
}

/// The motion of a place in the middle of a stretch, and bounds of its changes.
#[derive(Clone, Copy)]
struct OfPlace {
    velocity: Complex,
    velocity_change: f64,
    displacement: f64,
}

impl OfLink {
    const STILL: OfLink = OfLink {
        direction: Complex::new(1.0, 0.0),
        velocity: Complex::new(0.0, 0.0),
        rate: 0.0,
        origin: 0.0,
        chord: 0.0,
        velocity_change: 0.0,
        rate_change: 0.0,
        far: None,
    };

    /// Returns the bounds of a place in the frame of the link, on a stretch of half the length `half`.
    fn place(&self, at: Complex, half: f64) -> OfPlace {
        let distance = at.norm();
        let about = self.rate_change + (self.rate.abs() + self.rate_change) * self.chord;
        let velocity = self.velocity + turned(self.direction * at) * self.rate;
        // No place but the origin of a link of unbounded rate is bounded by it.
        let velocity_change = self.velocity_change + if distance > 0.0 { distance * about } else { 0.0 };
        let mut displacement =
            (self.origin + distance * self.chord).min(half * (velocity.norm() + velocity_change));
        if let Some((length, end)) = self.far {
            let share = at / length;
            let between = (Complex::new(1.0, 0.0) - share).norm() * self.origin + share.norm() * end;
            displacement = displacement.min(between);
        }
        OfPlace { velocity, velocity_change, displacement }
    }
}

impl Displacements {
    /// Returns the bounds on a stretch of half the length `half`, for the bodies in its middle.
    pub(super) fn new(linkage: &MultiLoop, bodies: &Bodies, half: f64) -> Self {
        let mut all = Displacements { links: [OfLink::STILL; MAX_BODIES], half };
        let direction = bodies.directions[CRANK];
        all.links[CRANK] = OfLink { direction, rate: 1.0, chord: chord(half), ..OfLink::STILL };
        for dyad in 0..linkage.dyad_count() {
            [all.links[2 + 2 * dyad], all.links[3 + 2 * dyad]] = all.of_dyad(linkage, bodies, dyad);
        }
        all
    }

    /// Returns the bound of the displacement of a place in the frame of a body.
    pub(super) fn of(&self, body: usize, at: Complex) -> f64 {
        self.links[body].place(at, self.half).displacement
    }

    /// Returns the bounds of the two links of a dyad.
    fn of_dyad(&self, linkage: &MultiLoop, bodies: &Bodies, dyad: usize) -> [OfLink; 2] {
        let (on, pair) = (linkage.chain_kind().anchors(dyad), linkage.dyads()[dyad]);
        let ends = [0, 1].map(|end| self.links[on[end]].place(pair.ends[end], self.half));
        let places = [0, 1].map(|end| bodies.place(on[end], pair.ends[end]));
        let directions = [bodies.directions[2 + 2 * dyad], bodies.directions[3 + 2 * dyad]];
        let lengths = pair.lengths;
        let (apart, moves) = ((places[1] - places[0]).norm(), ends[0].displacement + ends[1].displacement);
        let between = if moves < apart { (moves / apart).asin() } else { PI };
        let mut turns = [[0, 1], [1, 0]].map(|[own, other]| {
            between + change_of_angle([lengths[own], lengths[other]], [apart - moves, apart, apart + moves])
        });
        let relative = [ends[1].velocity - ends[0].velocity, ends[0].velocity - ends[1].velocity];
        let (speed, speed_change) = (relative[0].norm(), ends[0].velocity_change + ends[1].velocity_change);
        let crossed = cross(directions[0], directions[1]);
        let rates = [0, 1].map(|own| {
            let sign = if own == 0 { 1.0 } else { -1.0 };
            dot(relative[own], directions[1 - own]) / (sign * lengths[own] * crossed)
        });
        let mut changes = [f64::INFINITY; 2];
        for _ in 0..ROUNDS {
            let chords = turns.map(chord);
            let left = crossed.abs() - chords[0] - chords[1];
            if left > 0.0 {
                changes = [0, 1].map(|own| {
                    let of_rate = rates[own].abs() * lengths[own] * (chords[0] + chords[1]);
                    (speed_change + speed * chords[1 - own] + of_rate) / (lengths[own] * left)
                });
                turns = [0, 1].map(|own| turns[own].min(self.half * (rates[own].abs() + changes[own])));
            }
        }
        let own = |i: usize| OfLink {
            direction: directions[i],
            velocity: ends[i].velocity,
            rate: if changes[i].is_finite() { rates[i] } else { 0.0 },
            origin: ends[i].displacement,
            chord: chord(turns[i]),
            velocity_change: ends[i].velocity_change,
            rate_change: changes[i],
            far: None,
        };
        let links = [own(0), own(1)];
        let far = |i: usize| links[i].place(Complex::new(lengths[i], 0.0), self.half).displacement;
        let joint = far(0).min(far(1));
        [0, 1].map(|i| OfLink { far: Some((lengths[i], joint)), ..links[i] })
    }
}

/// Returns the chord of a turn about a place at 1.
fn chord(turn: f64) -> f64 {
    2.0 * (0.5 * turn.min(PI)).sin()
}

/// Computes max |delta - delta(s)| over low <= s <= high, delta the angle between a link and the line to the far end of the other.
pub(super) fn change_of_angle([own, other]: [f64; 2], [low, apart, high]: [f64; 3]) -> f64 {
    let (low, high) = (low.max((own - other).abs()), high.min(own + other));
    let delta = |s: f64| angle_opposite(other, s, own);
    let here = delta(apart);
    let mut change = (delta(low) - here).abs().max((delta(high) - here).abs());
    let extreme = ((own - other) * (own + other)).max(0.0).sqrt();
    if extreme > low && extreme < high {
        change = change.max((delta(extreme) - here).abs());
    }
    change
}
