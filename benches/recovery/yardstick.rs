//! The best fit in the neighbourhood of a known linkage, with the points in order.
//!
//! Points that want to overtake one another share a position at the constrained optimum, and m points T_j at
//! one position P are one point of weight m:
//!
//! ```text
//! sum_j |T_j - P|^2 = m |mean T - P|^2 + sum_j |T_j - mean T|^2
//! ```
//!
//! So: fit freely, pool neighbours that are out of order into one weighted point, fit again, until the order
//! holds (pool adjacent violators; Ayer et al. 1955). Nothing of a search's own handling of order is used.

use crate::random::Traced;
use linkwright::internals::judge::assess::assess;
use linkwright::internals::mechanism::four_bar::mobility::wrapped;
use linkwright::internals::mechanism::{AssemblyMode, Complex, FourBar, LinkageType, Mobility};
use linkwright::internals::record::Candidate;
use linkwright::internals::synthesis::multistart::{LONG_FIT, polish, settle_positions};
use linkwright::internals::synthesis::{Budget, Context};
use linkwright::internals::task::forms::design_space::{Design, Shape};
use linkwright::internals::task::forms::start::{AS_WRITTEN, Start};
use linkwright::internals::task::forms::torus::Positions;
use linkwright::internals::task::spec::OrderPolicy;
use linkwright::internals::task::{Problem, Setting};
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

/// Rounds of fitting and pooling; each pools at least one pair.
const ROUNDS: usize = 60;
/// Where the last points would overtake the first, they stop this much (radians) short of a whole turn.
const SHORT_OF_A_TURN: f64 = 1e-7;

/// Neighbouring points that share a position.
#[derive(Clone)]
struct Pool {
    members: Vec<usize>,
    position: [Complex; 2],
}

/// The best candidate that fits from the generating linkage at its own positions end in: one fit is free to
/// change the type, one keeps it (a crank-rocker that becomes a triple-rocker may pass toggles). `None` where
/// the referee accepts neither.
pub fn from_the_truth(problem: &Problem, traced: &Traced) -> Option<Candidate> {
    let generating = traced.linkage.linkage_type();
    let ends = [None, generating].into_iter().filter_map(|aim| fit_in_order(problem, traced, aim));
    ends.min_by(|one, other| one.error.objective.total_cmp(&other.error.objective))
}

fn fit_in_order(problem: &Problem, traced: &Traced, aim: Option<LinkageType>) -> Option<Candidate> {
    let linkage = &traced.linkage;
    let side = problem.sides()[0];
    let setting = Setting { aim, assembly: linkage.assembly(), direction: 1.0, side };
    let mut pools = Vec::new();
    for (j, &(angle, t1)) in traced.positions.iter().enumerate() {
        let joints = linkage.position_with(angle, t1).joints()?;
        let along = joints.follower_pin - joints.crank_pin;
        let position = [Complex::from_polar(1.0, angle), along / along.norm()];
        pools.push(Pool { members: vec![j], position });
    }
    let parameters: Vec<f64> = traced.positions.iter().map(|&(a, t1)| parameter(linkage, a, t1)).collect();
    let way = wrapped(parameters[1] - parameters[0]).signum();
    let ordered = problem.order_required();
    let mut design = problem.space(side).design(&Shape::from(linkage), 0.0);
    // First the positions alone, so that most pools are known before the linkage moves.
    for moves in [false, true] {
        for _ in 0..ROUNDS {
            let pooled = pooled(problem, aim, &pools)?;
            let positions: Positions = pools.iter().map(|p| p.position).collect();
            let (to, at) = fit(&pooled, design, setting, positions, moves)?;
            design = to;
            for (pool, position) in pools.iter_mut().zip(at) {
                pool.position = position;
            }
            let shape = problem.space(side).shape(&design)?;
            if !(ordered && pool_violators(&mut pools, &shape, way)?) {
                break;
            }
        }
    }
    let shape = problem.space(side).shape(&design)?;
    read(problem, &shape, &pools, way).filter(|candidate| candidate.accepted)
}

fn fit(
    problem: &Problem,
    design: Design,
    setting: Setting,
    positions: Positions,
    moves: bool,
) -> Option<(Design, Positions)> {
    let cancel = AtomicBool::new(false);
    let budget = Budget::new(&cancel, None);
    let context = Context::new(problem, &budget);
    if moves {
        let start = Start { design, setting, positions, scales: AS_WRITTEN };
        let end = polish(context, start, LONG_FIT, u64::MAX).end?;
        Some((end.design, end.positions))
    } else {
        let positions = settle_positions(context, &design, setting, positions)?;
        Some((design, positions))
    }
}

/// The problem with each pool as one weighted point, in any order, of a type where one is aimed at.
fn pooled(problem: &Problem, aim: Option<LinkageType>, pools: &[Pool]) -> Option<Problem> {
    let mut spec = problem.spec().clone();
    spec.require.order = OrderPolicy::Any;
    spec.require.types = aim.into_iter().collect();
    let all = problem.task().points();
    let mean = |pool: &Pool| {
        let mean = pool.members.iter().map(|&j| all[j]).sum::<Complex>() / pool.members.len() as f64;
        [mean.re, mean.im]
    };
    spec.task.points = pools.iter().map(mean).collect();
    spec.task.weight = Some(pools.iter().map(|p| p.members.len() as f64).collect());
    Problem::new(spec).ok()
}

/// The parameter of the circuit: the crank angle, or psi where the crank rocks.
fn parameter(linkage: &FourBar, angle: f64, t1: AssemblyMode) -> f64 {
    let mobility = linkage.mobility();
    match mobility.arc(mobility.branch(angle, t1).circuit) {
        Some(arc) => arc.parameter(angle, t1),
        None => angle,
    }
}

fn assembly(shape: &Shape, [e, u]: [Complex; 2]) -> AssemblyMode {
    let to_follower_pivot = shape.follower_pivot - (shape.crank_pivot + e * shape.crank);
    AssemblyMode::of((to_follower_pivot.conj() * u).im)
}

/// The linkage of a shape, its mobility and the parameter of each pool, unwrapped.
fn parameters(shape: &Shape, pools: &[Pool]) -> Option<(FourBar, Mobility, Vec<f64>)> {
    let linkage = shape.linkage(assembly(shape, pools[0].position)).ok()?;
    let at = |pool: &Pool| parameter(&linkage, pool.position[0].arg(), assembly(shape, pool.position));
    let mut along = vec![at(&pools[0])];
    for pool in &pools[1..] {
        let last = along[along.len() - 1];
        along.push(last + wrapped(at(pool) - last));
    }
    Some((linkage, linkage.mobility(), along))
}

/// Pools neighbours that do not follow one another in the way of the motion; whether any did not.
fn pool_violators(pools: &mut Vec<Pool>, shape: &Shape, way: f64) -> Option<bool> {
    let (_, _, along) = parameters(shape, pools)?;
    let before = pools.len();
    let mut kept: Vec<(Pool, f64)> = Vec::new();
    for (mut pool, mut at) in std::mem::take(pools).into_iter().zip(along) {
        while let Some((last, there)) = kept.pop_if(|(_, there)| way * (at - *there) <= 0.0) {
            let (m, n) = (last.members.len() as f64, pool.members.len() as f64);
            at = (m * there + n * at) / (m + n);
            let position = if m >= n { last.position } else { pool.position };
            pool = Pool { members: [last.members, pool.members].concat(), position };
        }
        kept.push((pool, at));
    }
    if kept.len() > 2 && way * (kept[kept.len() - 1].1 - kept[0].1) >= TAU {
        // The end has overtaken the start.
        let (last, _) = kept.pop()?;
        let first = &mut kept[0].0;
        first.members = [last.members, std::mem::take(&mut first.members)].concat();
    }
    pools.extend(kept.into_iter().map(|(pool, _)| pool));
    Some(pools.len() < before)
}

/// Every point at its pool's position, judged.
fn read(problem: &Problem, shape: &Shape, pools: &[Pool], way: f64) -> Option<Candidate> {
    let (linkage, mobility, along) = parameters(shape, pools)?;
    let circuit = mobility.branch(pools[0].position[0].arg(), linkage.assembly()).circuit;
    let n = problem.task().len();
    let (mut crank_deg, mut t1_at) = (vec![0.0; n], vec![linkage.assembly(); n]);
    // Members of the first pool that stand at the end of the path come round to it.
    let wraps = pools[0].members.windows(2).any(|w| w[1] < w[0]);
    for (i, (pool, at)) in pools.iter().zip(along).enumerate() {
        for &j in &pool.members {
            let round = i == 0 && wraps && j >= pool.members[0];
            let at = if round { at - way * SHORT_OF_A_TURN } else { at };
            let (angle, t1) = match mobility.arc(circuit) {
                Some(arc) => (arc.crank_angle(at), AssemblyMode::of(at.cos())),
                None => (at, linkage.assembly()),
            };
            crank_deg[j] = angle.to_degrees();
            t1_at[j] = t1;
        }
    }
    assess(problem, linkage.with_assembly(t1_at[0]), &crank_deg, &t1_at)
}
