//! Fits a dyad chain to points by Levenberg and Marquardt's method, with the phases eliminated and in order.
//!
//! Unknowns are the parameters of the shape, T, S, Z, and a phase for each point. With g = S o' + Z v' (by the phase) and
//! the residual r = P - T_j, each point's phase is eliminated: its row along g has the weight lt/(|g|^2 + lt), the row
//! normal to g the weight 1, and
//!
//! ```text
//! tau = -<g, r + J dx> / (|g|^2 + lt),   lt = min(lambda, 1) mean |g|^2
//! ```
//!
//! (derived here: a Schur complement.) After each step the phases are projected onto the nearest sequence in order, and
//! T, S, Z are solved anew unless a limit of size is active; a step is kept if the sum of squares falls. Hinges hold the
//! transmission angles, the lengths, and the curve between two neighbouring points.
//!
//! Of prescribed phases only a common offset is an unknown, if that is free, and is eliminated likewise; they have no order to
//! be projected onto. Where they count from the x axis they fall as S turns, so that S is a step's and not solved anew.

use super::constants::HELD_STEPS;
use super::held::AllHeld;
use super::limits::{Bodies, Limits};
use super::normal_equations::{MAX_COLUMNS, Matrix, add, gram, solve};
use super::order::Order;
use super::rows::Rows;
use super::target::{Points, Times};
use super::trial::Trial;
use crate::mechanism::dyad_chain::{DyadChain, DyadChainKind, Frames, Placement};
use crate::numbers::arithmetic::Complex;
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};
use crate::task::AngleOffset;

/// Greatest change of a phase (radians) and of a parameter in a step.
const MOST_PHASE: f64 = 0.3;
const MOST_PARAMETER: f64 = 0.8;
/// Damping: at first, its factors after a step that is kept and after one that is not, its bounds.
const DAMPING: f64 = 1e-2;
const SOFTER: f64 = 0.25;
const HARDER: f64 = 4.0;
const LEAST_DAMPING: f64 = 1e-9;
const MOST_DAMPING: f64 = 1e6;
/// Damping above which a step that is not kept is idle.
const STIFF: f64 = 1.0;
/// Idle steps in a row after which a fit ends.
const IDLE_STEPS: usize = 3;
/// Mean square, of the mean square radius, below which a fit is exact.
const EXACT: f64 = 1e-26;
/// Added to the diagonal, a point, for parameters that move nothing; and relative to it, of T, S and Z.
const FLOOR: f64 = 1e-12;
const LINEAR_FLOOR: f64 = 1e-13;

/// A chain with the phases of the points that it is fitted to.
#[derive(Clone, Debug)]
pub(super) struct State {
    pub(super) chain: DyadChain,
    pub(super) phases: Vec<f64>,
    /// Mean square with the hinges, and without; infinite before a fit.
    pub(super) value: f64,
    pub(super) misfit: f64,
}

/// The end of a fit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ending {
    /// Most trial steps.
    pub(super) steps: usize,
    /// Relative fall of the value below which a step is idle.
    pub(super) idle: f64,
}

/// Whether T, S and Z are known before a fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Linear {
    /// They are solved first.
    Unknown,
    /// They are kept where a limit of size is active.
    Known,
}

/// The elimination of the common offset of prescribed phases: tau = -along . (dx, 1) / whole.
struct CommonOffset {
    along: [f64; MAX_COLUMNS],
    whole: f64,
}

/// Buffers of fits, of one thread.
#[derive(Debug)]
pub(super) struct Fitter {
    now: Trial,
    next: Trial,
    frames: Frames<F64x8>,
    rows: Rows,
    order: Order,
    bodies: Bodies,
    weighted: Vec<f64>,
    moving: Box<Matrix>,
    step: [f64; MAX_COLUMNS],
    tau: Vec<f64>,
    /// Trial steps so far.
    pub(super) evaluations: u64,
}

impl Default for Fitter {
    fn default() -> Self {
        Fitter {
            now: Trial::default(),
            next: Trial::default(),
            frames: Frames::of(ComplexLanes::ZERO),
            rows: Rows::default(),
            order: Order::default(),
            bodies: Bodies::default(),
            weighted: Vec::new(),
            moving: Box::new([[0.0; MAX_COLUMNS]; MAX_COLUMNS]),
            step: [0.0; MAX_COLUMNS],
            tau: Vec::new(),
            evaluations: 0,
        }
    }
}

impl Fitter {
    /// Makes all further fits of chains of a kind hold dimensions.
    pub(super) fn hold(&mut self, kind: DyadChainKind, held: AllHeld) {
        self.bodies.of(kind);
        self.bodies.held = held;
    }

    /// Fits a state to points.
    pub(super) fn fit(
        &mut self,
        points: &Points,
        limits: &Limits,
        state: &mut State,
        ending: Ending,
        linear: Linear,
    ) {
        let padded = points.mask.len();
        self.now.resize(padded);
        self.next.resize(padded);
        self.rows.resize(padded);
        self.weighted.resize(MAX_COLUMNS * padded, 0.0);
        self.tau.resize(padded, 0.0);
        self.bodies.of(state.chain.shape.kind);
        self.next.shape = state.chain.shape;
        self.next.phases[..points.count].copy_from_slice(&state.phases);
        let placement = (linear == Linear::Known).then_some(state.chain.placement);
        match placement.map(|at| self.held(at, HELD_STEPS[0])) {
            Some(None) => self.next.value = f64::INFINITY,
            at => self.time_and_evaluate(points, limits, at.flatten()),
        }
        std::mem::swap(&mut self.now, &mut self.next);
        if self.now.value.is_finite() {
            self.descend(points, limits, ending);
        }
        state.chain = DyadChain { shape: self.now.shape, placement: self.now.at };
        state.phases.copy_from_slice(&self.now.phases[..points.count]);
        (state.value, state.misfit) = (self.now.value, self.now.misfit);
    }

    /// Takes steps until they are idle.
    fn descend(&mut self, points: &Points, limits: &Limits, ending: Ending) {
        let (mut damping, mut is_fresh, mut idle) = (DAMPING, true, 0);
        for _ in 0..ending.steps {
            if is_fresh {
                vectorised(
                    #[inline(always)]
                    || self.rows.derive(&self.now, points, limits, &self.bodies, &mut self.frames),
                );
            }
            self.evaluations += 1;
            let is_solved = vectorised(
                #[inline(always)]
                || self.solve(points, damping),
            );
            is_fresh = is_solved && {
                self.advance(points);
                let at = self.held(self.stepped(), HELD_STEPS[1]);
                if at.is_some() {
                    self.time_and_evaluate(points, limits, at);
                }
                at.is_some() && self.next.value < self.now.value
            };
            if is_fresh {
                let fall = (self.now.value - self.next.value) / self.now.value;
                idle = if fall < ending.idle { idle + 1 } else { 0 };
                std::mem::swap(&mut self.now, &mut self.next);
                damping = (damping * SOFTER).max(LEAST_DAMPING);
            } else {
                damping *= HARDER;
                idle += usize::from(damping > STIFF);
            }
            if idle >= IDLE_STEPS || damping > MOST_DAMPING || self.now.value < EXACT {
                break;
            }
        }
    }

    /// Brings the shape of the next trial and a placement to what is held; returns the placement, `None` where that fails.
    fn held(&mut self, at: Placement, steps: usize) -> Option<Placement> {
        if self.bodies.held.is_empty() {
            return Some(at);
        }
        self.next.at = at;
        self.bodies.held.restore(&mut self.next, steps).then_some(self.next.at)
    }

    /// Puts prescribed phases in their place for a placement, and computes the value of the next trial.
    fn time_and_evaluate(&mut self, points: &Points, limits: &Limits, at: Option<Placement>) {
        if let Some(times) = &points.timing {
            let ground = at.map_or(Complex::new(1.0, 0.0), |at| at.ground);
            times.put(ground, &mut self.next.phases[..points.count]);
        }
        self.evaluate(points, limits, at);
    }

    /// Computes the value of the next trial.
    fn evaluate(&mut self, points: &Points, limits: &Limits, stepped: Option<Placement>) {
        vectorised(
            #[inline(always)]
            || self.next.evaluate(points, limits, &self.bodies, &mut self.frames, stepped),
        );
    }

    /// Moves shape and phases by the step, from this trial to the next one.
    fn advance(&mut self, points: &Points) {
        let (now, next) = (&self.now, &mut self.next);
        next.shape = now.shape;
        for (parameter, step) in next.shape.parameters.iter_mut().zip(&self.step).take(now.shape.count()) {
            *parameter += step;
        }
        let n = points.count;
        for ((next, now), tau) in next.phases[..n].iter_mut().zip(&now.phases[..n]).zip(&self.tau) {
            *next = now + tau.clamp(-MOST_PHASE, MOST_PHASE);
        }
        if points.timing.is_none() {
            self.order.project(&mut next.phases[..n], points.closed);
        }
    }

    /// Returns T, S and Z moved by the step.
    fn stepped(&self) -> Placement {
        let (at, count) = (&self.now.at, self.now.shape.count());
        let step = |i: usize| Complex::new(self.step[count + i], self.step[count + i + 1]);
        Placement { origin: at.origin + step(0), ground: at.ground + step(2), pointer: at.pointer + step(4) }
    }

    /// Returns the sums of all rows along the common offset of prescribed phases, by which it is eliminated; zeros where it is none.
    fn common_offset(&self, points: &Points, times: &Times, damping: f64) -> CommonOffset {
        let (speeds, tangent) = (&self.rows.speed_sq[..points.count], &self.rows.tangent);
        let whole = speeds.iter().sum::<f64>() * (1.0 + damping.min(1.0)) + f64::MIN_POSITIVE;
        let mut along = [0.0; MAX_COLUMNS];
        if times.offset == AngleOffset::Free {
            let rows = tangent.chunks_exact(points.mask.len());
            for (along, own) in along.iter_mut().zip(rows).take(self.now.shape.count() + 7) {
                *along = own.iter().zip(speeds).map(|(entry, speed)| entry * speed.sqrt()).sum();
            }
        }
        CommonOffset { along, whole }
    }

    /// Solves for the step of the unknowns and of the phases; returns whether there is one.
    #[inline(always)]
    fn solve(&mut self, points: &Points, damping: f64) -> bool {
        let padded = points.mask.len();
        let count = self.now.shape.count();
        let (unknowns, columns) = (count + 6, count + 7);
        let (speeds, tangent) = (&self.rows.speed_sq, &self.rows.tangent);
        let mean = speeds[..points.count].iter().sum::<f64>() / points.count as f64;
        let slack = F64x8::splat(damping.min(1.0) * mean + f64::MIN_POSITIVE);
        for at in (0..padded).step_by(LANES) {
            let weight = match points.timing {
                None => (slack * (F64x8::load(speeds, at) + slack).recip()).sqrt(),
                Some(_) => F64x8::splat(1.0),
            };
            for column in 0..columns {
                let place = column * padded + at;
                (F64x8::load(tangent, place) * weight).store(&mut self.weighted, place);
            }
        }
        gram(&self.weighted, padded, columns, &mut self.moving);
        let offset = points.timing.as_ref().map(|times| self.common_offset(points, times, damping));
        if let Some(CommonOffset { along, whole }) = &offset {
            for (row, one) in self.moving.iter_mut().zip(along).take(columns) {
                for (entry, other) in row.iter_mut().zip(along).take(columns) {
                    *entry -= one * other / whole;
                }
            }
        }
        let mut matrix = *self.rows.fixed;
        add(&mut matrix, &self.moving, columns);
        for (k, row) in matrix.iter_mut().enumerate().take(unknowns) {
            // S is as little linear as the shape is where phases depend on it.
            let is_damped = k < count || (points.follow_the_ground() && (count + 2..count + 4).contains(&k));
            row[k] += if is_damped {
                damping * row[k] + FLOOR * points.count as f64
            } else {
                LINEAR_FLOOR * row[k]
            };
        }
        if !self.bodies.held.is_empty() {
            // Not damped: beside their weights nothing else would move.
            add(&mut matrix, &self.rows.held, columns);
        }
        if !solve(&mut matrix, unknowns, &mut self.step) {
            return false;
        }
        let largest = self.step[..count].iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        if !largest.is_finite() {
            return false;
        }
        if largest > MOST_PARAMETER {
            let factor = MOST_PARAMETER / largest;
            self.step[..unknowns].iter_mut().for_each(|x| *x *= factor);
        }
        self.step[unknowns] = 1.0;
        if let Some(CommonOffset { along, whole }) = offset {
            let sum: f64 = along.iter().zip(&self.step).take(columns).map(|(a, b)| a * b).sum();
            self.tau.fill(-sum / whole);
            return true;
        }
        for at in (0..padded).step_by(LANES) {
            let speed = F64x8::load(speeds, at);
            let mut sum = F64x8::splat(0.0);
            for column in 0..columns {
                sum = sum + F64x8::load(tangent, column * padded + at) * F64x8::splat(self.step[column]);
            }
            let tau = -sum * speed.sqrt() * (speed + slack).recip();
            tau.store(&mut self.tau, at);
        }
        true
    }
}
