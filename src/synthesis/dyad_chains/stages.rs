//! Stages of fits: from a start to an end on all points, and hops from known ends.

use super::answers::{End, Pool};
use super::atlas::Start;
use super::constants::{
    ASSIGNMENT_COSTS, FIRST_STEPS, FULL_STEPS, HOP_REACH, HOP_STEPS, HOPELESS, IDLE, IDLE_FULL, IDLE_LAST,
    LAST_STEPS, NEAR, PROMISING,
};
use super::fit::{Ending, Fitter, Linear, State};
use super::held::AllHeld;
use super::limits::Limits;
use super::rematch::Rematch;
use super::target::{Points, Target, Variant};
use crate::mechanism::DyadChainKind;
use crate::numbers::arithmetic::streams::{Stream, below, normal, uniform, unit};
use std::f64::consts::TAU;

/// The target and the limits, which all fits share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setup<'a> {
    pub(super) target: &'a Target,
    /// The limits of fits to the target, and to its mirror image.
    pub(super) limits: &'a [Limits; 2],
}

/// The buffers of one job.
#[derive(Debug, Default)]
pub(super) struct Bench {
    fitter: Fitter,
    rematch: Rematch,
    assignments: u64,
}

impl Bench {
    /// Makes all further fits of chains of a kind hold dimensions.
    pub(super) fn hold(&mut self, kind: DyadChainKind, held: AllHeld) {
        self.fitter.hold(kind, held);
    }

    /// Assigns points anew to the phases of a state, unless they are prescribed.
    fn assign(&mut self, points: &Points, state: &mut State) {
        if points.timing.is_none() {
            self.rematch.assign(points, &state.chain, &mut state.phases);
            self.assignments += 1;
        }
    }

    /// Returns the evaluations so far.
    pub(super) fn evaluations(&self) -> u64 {
        self.fitter.evaluations + ASSIGNMENT_COSTS * self.assignments
    }
}

/// Returns whether two states are of one kind and assembly, with nearly the same parameters.
fn is_near(one: &State, other: &State) -> bool {
    let (a, b) = (&one.chain.shape, &other.chain.shape);
    let dyads = a.kind.dyads();
    let parameters = || a.parameters.iter().zip(&b.parameters);
    a.kind == b.kind
        && a.assembly[..dyads] == b.assembly[..dyads]
        && parameters().all(|(a, b)| (a - b).abs() <= NEAR * (1.0 + a.abs()))
}

impl<'a> Setup<'a> {
    /// Returns whether T, S and Z of a new start are known: those of prescribed phases are.
    fn linear(&self) -> Linear {
        if self.target.timed.is_some() { Linear::Known } else { Linear::Unknown }
    }

    fn limits(&self, variant: Variant) -> &'a Limits {
        &self.limits[usize::from(variant.mirrored)]
    }

    /// Fits a start to few points with a few steps.
    pub(super) fn first_fit(&self, bench: &mut Bench, start: &Start) -> State {
        let points = &self.target.few[start.variant.index()];
        let phases = start.phases(points);
        let mut state = State { chain: start.chain, phases, value: f64::INFINITY, misfit: f64::INFINITY };
        let ending = Ending { steps: FIRST_STEPS, idle: IDLE };
        bench.fitter.fit(points, self.limits(start.variant), &mut state, ending, self.linear());
        state
    }

    /// Assigns the few points anew and fits on, where that gains.
    pub(super) fn second_fit(&self, bench: &mut Bench, state: &mut State, variant: Variant, steps: usize) {
        let points = &self.target.few[variant.index()];
        let mut other = state.clone();
        bench.assign(points, &mut other);
        let ending = Ending { steps, idle: IDLE };
        bench.fitter.fit(points, self.limits(variant), &mut other, ending, Linear::Known);
        if other.value < state.value {
            *state = other;
        }
    }

    /// Fits a state of few points to all of them, assigns them anew and fits on.
    pub(super) fn full_fit(&self, bench: &mut Bench, state: &State, variant: Variant) -> End {
        let points = &self.target.all[variant.index()];
        let limits = self.limits(variant);
        let phases = match &points.timing {
            None => self.spread(&state.phases, points.count),
            Some(times) => {
                let mut phases = vec![state.phases[0]; points.count];
                times.put(state.chain.placement.ground, &mut phases);
                phases
            }
        };
        let mut all = State { phases, ..*state };
        let ending = |steps| Ending { steps, idle: IDLE_FULL };
        bench.fitter.fit(points, limits, &mut all, ending(FULL_STEPS[0]), Linear::Known);
        let mut other = all.clone();
        bench.assign(points, &mut other);
        bench.fitter.fit(points, limits, &mut other, ending(FULL_STEPS[1]), Linear::Known);
        let state = if other.value < all.value { other } else { all };
        End { state, variant, hits: 1 }
    }

    /// Returns phases of all points from those of few, in proportion to their numbers.
    fn spread(&self, phases: &[f64], count: usize) -> Vec<f64> {
        let chosen = &self.target.chosen;
        let mut i = 0;
        let at = |point: usize| {
            while i + 1 < chosen.len() && chosen[i + 1] <= point {
                i += 1;
            }
            let (to, next) = match chosen.get(i + 1) {
                Some(to) => (*to, phases[i + 1]),
                None => (count, phases[0] + TAU),
            };
            phases[i] + (next - phases[i]) * (point - chosen[i]) as f64 / (to - chosen[i]) as f64
        };
        (0..count).map(at).collect()
    }

    /// Perturbs one of the best ends, fits it to few points, and to all where that promises a new end.
    pub(super) fn hop(&self, bench: &mut Bench, pool: &Pool, draws: &mut Stream) -> Option<End> {
        let rank = unit(draws);
        let parent = pool.ends.get((rank * rank * pool.ends.len() as f64) as usize)?;
        let points = &self.target.few[parent.variant.index()];
        let mut chain = parent.state.chain;
        let reach = uniform(draws, HOP_REACH.0.ln(), HOP_REACH.1.ln()).exp();
        // All parameters, or each with a chance of a third.
        let all = below(draws, 2) == 0;
        let count = chain.shape.count();
        for parameter in &mut chain.shape.parameters[..count] {
            let step = reach * normal(draws, 0.0, 1.0);
            if all || below(draws, 3) == 0 {
                *parameter += step;
            }
        }
        let phases = self.target.chosen.iter().map(|i| parent.state.phases[*i]).collect();
        let mut state = State { chain, phases, value: f64::INFINITY, misfit: f64::INFINITY };
        let ending = Ending { steps: HOP_STEPS, idle: IDLE };
        bench.fitter.fit(points, self.limits(parent.variant), &mut state, ending, self.linear());
        let within = |state: &State, factor: f64| state.value < factor * pool.best();
        if !within(&state, HOPELESS) {
            return None;
        }
        self.second_fit(bench, &mut state, parent.variant, HOP_STEPS);
        let is_new = || !pool.ends.iter().any(|end| is_near(&end.state, &state));
        (within(&state, PROMISING) && is_new()).then(|| self.full_fit(bench, &state, parent.variant))
    }

    /// Fits an end once more, with limits that are held strictly.
    pub(super) fn last_fit(&self, bench: &mut Bench, end: &End) -> End {
        self.strict_fit(bench, end, Ending { steps: LAST_STEPS, idle: IDLE_LAST })
    }

    /// Fits an end with limits that are held strictly.
    pub(super) fn strict_fit(&self, bench: &mut Bench, end: &End, ending: Ending) -> End {
        let points = &self.target.all[end.variant.index()];
        let limits = self.limits(end.variant).strictly();
        let mut out = end.clone();
        bench.fitter.fit(points, &limits, &mut out.state, ending, Linear::Known);
        out
    }
}
