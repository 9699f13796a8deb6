//! Screening of starts: the reduced cost of many draws, eight at a time in vector lanes.
//!
//! Only sums over the points are needed: with <x, y> = sum w conj(x) y (centred if A is free), M_aa = <a, a>, M_au =
//! <a, u>, M_uu = <u, u>, r_a = <a, T>, r_u = <u, T>, the column u is eliminated first,
//!
//! ```text
//! N = M_aa - |M_au|^2/M_uu,   s = r_a - M_au r_u/M_uu,   S = <T, T> - |r_u|^2/M_uu
//! cost = S - 2 |K| h + |K|^2 N     h = |s|, or Re(e^{-i theta} s) if K has a known direction
//! |K| = h/N brought into its limits, or known
//! ```
//!
//! The column of u is q u, which needs no division; both assemblies come from one root. Through differences of sums the
//! cost is accurate to 1e-15 <T, T>: enough to choose starts, not to end a fit.
//!
//! In a motion the angle's errors enter by their chords, which need no angle: W^2 sum w |e^{i (theta - beta)} - u|^2 is
//! 2 W^2 (sum w - |sum w e^{-i theta} u|) at the best frame beta.

use super::{GroundKnown, Origin, Projection, Reduced, SINGULAR};
use crate::mechanism::effort::computed;
use crate::mechanism::{AssemblyMode, Complex};
use crate::numbers::arithmetic::complex_lanes::{Column, ComplexLanes, larger};
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};

/// Draws as columns: ratios and the angle's sine and cosine, padded to whole lanes.
#[derive(Clone, Debug, Default)]
pub struct Batch {
    draws: Vec<Reduced>,
    ratio: [Vec<f64>; 3],
    angle: Column,
}

impl Batch {
    /// Prepares draws for screening.
    pub fn new(draws: Vec<Reduced>) -> Self {
        let padded = draws.len().next_multiple_of(LANES);
        let column = |of: &dyn Fn(&Reduced) -> f64| -> Vec<f64> {
            (0..padded).map(|i| draws.get(i).or(draws.last()).map_or(1.0, of)).collect()
        };
        Batch {
            ratio: [0, 1, 2].map(|k| column(&|x| x[k].exp())),
            angle: [column(&|x| x[3].cos()), column(&|x| x[3].sin())],
            draws,
        }
    }

    /// Returns the draws.
    pub fn draws(&self) -> &[Reduced] {
        &self.draws
    }

    /// Returns the number of draws.
    pub fn len(&self) -> usize {
        self.draws.len()
    }

    /// Returns whether there are no draws.
    pub fn is_empty(&self) -> bool {
        self.draws.is_empty()
    }
}

/// The sums of one assembly.
#[derive(Clone, Copy)]
struct Sums<L> {
    /// The sum of w u.
    u: ComplexLanes<L>,
    /// The sum of w conj(phase) u.
    phase_u: ComplexLanes<L>,
    /// The sum of w conj(u) T.
    u_target: ComplexLanes<L>,
    /// The sum of w e^{-i theta} u over the targets with an angle.
    turned: ComplexLanes<L>,
}

impl<L: Lane> Sums<L> {
    #[inline(always)]
    fn add(&mut self, u: ComplexLanes<L>, weight: L, phase: ComplexLanes<L>, target: ComplexLanes<L>) {
        self.u = self.u + u.scale(weight);
        self.phase_u = self.phase_u + phase.dot(u);
        self.u_target = self.u_target + u.dot(target);
    }
}

/// A draw in lanes.
struct Drawn<L> {
    ratio: [L; 3],
    /// The turn e^{i turn}: the crank from the ground line against the prescribed angle.
    turn: ComplexLanes<L>,
    /// The ground's direction e^{i theta}.
    direction: ComplexLanes<L>,
}

impl Projection {
    /// Returns the costs of a batch on both assemblies, t1 = +1 first: infinite if the loop does not close at a point,
    /// the linear system is singular or the ground comes out reversed. Two evaluations per draw. `None` if `stop`
    /// returns true; it is called before every `LANES` draws.
    pub fn screen_unless(&self, batch: &Batch, stop: &dyn Fn() -> bool) -> Option<[Vec<f64>; 2]> {
        let padded = batch.ratio[0].len();
        let mut costs = [vec![0.0; padded], vec![0.0; padded]];
        let [plus, minus] = &mut costs;
        let all = vectorised(
            #[inline(always)]
            || {
                for at in (0..padded).step_by(LANES) {
                    if stop() {
                        return false;
                    }
                    computed(2 * LANES * self.points);
                    let ratio = [0, 1, 2].map(|k| F64x8::load(&batch.ratio[k], at));
                    let angle = ComplexLanes::load(&batch.angle, at);
                    let [p, m] = self.cost_of(&self.drawn(ratio, angle));
                    p.store(plus, at);
                    m.store(minus, at);
                }
                true
            },
        );
        if !all {
            return None;
        }
        for column in &mut costs {
            column.truncate(batch.len());
        }
        Some(costs)
    }

    /// Returns the cost of [`Projection::screen_unless`] for a single draw, in scalar arithmetic: the same bits.
    pub fn screen_one(&self, x: &Reduced, assembly: AssemblyMode) -> f64 {
        let ratio = [0, 1, 2].map(|k: usize| x[k].exp());
        let angle = ComplexLanes { re: x[3].cos(), im: x[3].sin() };
        let [plus, minus] = self.cost_of::<f64>(&self.drawn(ratio, angle));
        if assembly == AssemblyMode::Plus { plus } else { minus }
    }

    #[inline(always)]
    fn drawn<L: Lane>(&self, ratio: [L; 3], angle: ComplexLanes<L>) -> Drawn<L> {
        use super::AngleRole;
        let known = |angle: f64| ComplexLanes::splat(Complex::from_polar(1.0, angle));
        let back = ComplexLanes { re: angle.re, im: -angle.im };
        let (turn, direction) = match self.role {
            AngleRole::None => (known(self.turn), known(self.theta)),
            AngleRole::Crank => (angle, known(self.theta)),
            AngleRole::Ground => (known(0.0), angle),
            AngleRole::Both => (back, angle),
        };
        Drawn { ratio, turn, direction }
    }

    #[inline(always)]
    fn cost_of<L: Lane>(&self, drawn: &Drawn<L>) -> [L; 2] {
        let s = L::splat;
        let [p, q, r] = drawn.ratio;
        let q_sq = q * q;
        let half = s(0.5) * (q_sq - r * r);
        let mut gap = s(f64::INFINITY);
        let zero = ComplexLanes::splat(Complex::new(0.0, 0.0));
        let mut sums = [Sums { u: zero, phase_u: zero, u_target: zero, turned: zero }; 2];
        let c = &self.columns;
        for j in 0..self.points {
            let phase = Complex::new(c.phase[0][j], c.phase[1][j]);
            let target = Complex::new(c.target[0][j], c.target[1][j]);
            let weight = c.weight[j];
            let e = ComplexLanes::splat(phase) * drawn.turn;
            let w = ComplexLanes { re: s(1.0) - p * e.re, im: -(p * e.im) };
            let f2 = w.norm_sq();
            let sigma = half + s(0.5) * f2;
            let height_sq = q_sq * f2 - sigma * sigma;
            gap = height_sq.min(gap);
            let root = height_sq.positive_part().sqrt();
            let v = w.scale(f2.recip());
            let (along, across) = (v.scale(sigma), v.scale(root));
            let up = ComplexLanes { re: along.re - across.im, im: along.im + across.re };
            let down = ComplexLanes { re: along.re + across.im, im: along.im - across.re };
            let (phase, target) = (ComplexLanes::splat(phase * weight), ComplexLanes::splat(target * weight));
            sums[0].add(up, s(weight), phase, target);
            sums[1].add(down, s(weight), phase, target);
            if let Some(body) = &self.body {
                let back = ComplexLanes::splat(body.back[j]);
                sums[0].turned = sums[0].turned + back * up;
                sums[1].turned = sums[1].turned + back * down;
            }
        }
        sums.map(|sums| self.reduced_cost(drawn, &sums, gap))
    }

    #[inline(always)]
    fn reduced_cost<L: Lane>(&self, drawn: &Drawn<L>, sums: &Sums<L>, gap: L) -> L {
        let s = L::splat;
        let [p, q, _] = drawn.ratio;
        let q_sq = q * q;
        let turned_sum = drawn.turn * ComplexLanes::splat(self.phase_sum);
        let raw_au = drawn.turn.dot(sums.phase_u);
        let raw_at = drawn.turn.dot(ComplexLanes::splat(self.phase_target));
        let (m_aa, m_au, m_uu, r_a) = match self.origin {
            Origin::Mean(_) => (
                s(1.0) - turned_sum.norm_sq(),
                raw_au - turned_sum.dot(sums.u),
                q_sq - sums.u.norm_sq(),
                raw_at,
            ),
            Origin::CrankPivot(_) => (s(1.0), raw_au, q_sq, raw_at),
            Origin::FollowerPivot(_) => {
                let back = p.recip();
                (
                    s(1.0) + back * back - s(2.0) * back * turned_sum.re,
                    raw_au - sums.u.scale(back),
                    q_sq,
                    raw_at - ComplexLanes::splat(self.target_sum).scale(back),
                )
            }
        };
        let by_u = m_uu.recip();
        let left = m_aa - m_au.norm_sq() * by_u;
        let right = r_a - (m_au * sums.u_target).scale(by_u);
        let rest = s(self.target_sq) - sums.u_target.norm_sq() * by_u;
        let along = match self.ground {
            GroundKnown::Nothing => right.norm_sq().sqrt(),
            GroundKnown::Direction | GroundKnown::Both(_) => drawn.direction.dot(right).re,
        };
        let length = match self.ground {
            GroundKnown::Both(length) => p * s(length),
            GroundKnown::Nothing | GroundKnown::Direction => self.limited(drawn.ratio, along * left.recip()),
        };
        let cost = rest - s(2.0) * length * along + length * length * left;
        let cost = match &self.body {
            None => cost.positive_part(),
            Some(body) => {
                let along = sums.turned.norm_sq().sqrt() * q.recip();
                let chords = (s(body.weight) - along).positive_part();
                cost.positive_part() + s(2.0 * body.length * body.length) * chords
            }
        };
        let cost = cost * s(self.total_weight);
        let never = s(f64::INFINITY);
        let least = s(f64::MIN_POSITIVE);
        let cost = gap.at_least(least, cost, never);
        let cost = m_uu.at_least(s(SINGULAR) * q_sq, cost, never);
        let cost = match self.ground {
            GroundKnown::Both(_) => cost,
            _ => left.at_least(s(SINGULAR) * m_aa, cost, never),
        };
        length.at_least(least, cost, never)
    }

    /// Clamps a length of the crank to its limits.
    #[inline(always)]
    fn limited<L: Lane>(&self, [p, q, r]: [L; 3], length: L) -> L {
        let s = L::splat;
        let [a, g, b, c] = self.limits;
        let (by_q, by_r) = (p * q.recip(), p * r.recip());
        let low = larger(larger(s(a.0), p * s(g.0)), larger(by_q * s(b.0), by_r * s(c.0)));
        let high = s(a.1).min(p * s(g.1)).min((by_q * s(b.1)).min(by_r * s(c.1)));
        let inside = larger(length, low).min(high);
        high.at_least(low, inside, (low * high).sqrt())
    }
}
