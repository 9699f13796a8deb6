//! Real solutions of the continuation as candidates: of each class the best of its mechanisms ([`super::mechanisms`]), judged as
//! every candidate is.
//!
//! They are ordered better first: accepted, then lighter defects, then fewer requirements unmet, the better worst
//! transmission angle, the smaller linkage. That is the order of ranks ([`super::rank`]), since exact errors are equal.

use super::cognates::{Merit, not_met};
use super::mechanisms::{Mechanism, mechanisms, solution_of};
use super::rank::compare;
use super::unwrapped::unwrapped;
use crate::judge::assess::{assess, assess_on_curve};
use crate::judge::error::rms;
use crate::judge::referee::judge;
use crate::mechanism::{AssemblyMode, CrankLinkage, FourBar};
use crate::numbers::nine_point::Solution;
use crate::record::{Candidate, Certified, CurveErrorRecord, ExactForm, ExactLinkage};
use crate::task::Problem;
use crate::task::forms::precision::Precise;
use rayon::prelude::*;

/// A class of real solutions with its mechanisms judged.
#[derive(Clone, Debug)]
pub struct Class {
    /// The best of the mechanisms.
    pub best: Candidate,
    /// Whether one of the mechanisms stays on one circuit.
    pub one_circuit: bool,
    /// Whether one of them passes the points in order.
    pub in_order: bool,
    /// Whether one of them has no defect.
    pub free_of_defects: bool,
    /// The other mechanisms, better first.
    pub others: Vec<ExactForm>,
}

/// The amount of computation for a class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// All figures are computed.
    Whole,
    /// All figures but the distances to the whole curve, which are most of the cost; the distances at the points are
    /// used instead: for an exact linkage both are rounding, and the curve is nowhere farther from a point.
    Glance,
}

/// Returns the classes of real solutions, better first. One that gives no linkage (a link of no length, or one too
/// large) is left out.
pub fn classes(problem: &Problem, target: &Precise, real: &[Solution], depth: Depth) -> Vec<Class> {
    let judged: Vec<Option<Class>> =
        real.par_iter().map(|solution| class(problem, target, solution, depth)).collect();
    let mut classes: Vec<Class> = judged.into_iter().flatten().collect();
    // Stable: equals stay in the order of the solver.
    classes.sort_by(|one, other| compare(problem, &one.best, &other.best));
    classes
}

/// Returns a real solution's class; `None` if none of its mechanisms passes the points.
pub fn class(problem: &Problem, target: &Precise, solution: &Solution, depth: Depth) -> Option<Class> {
    let list = mechanisms(problem.task(), target, solution);
    let any = |of: fn(&Mechanism) -> bool| list.iter().any(of);
    let mut to_curve = None;
    let mut forms = Vec::with_capacity(list.len());
    for mechanism in list.iter().filter(|m| m.passes) {
        let (crank_deg, t1_at) = positions(problem, mechanism);
        // All draw one curve, and on it one circuit through the first point: its distances are known after the first.
        if depth == Depth::Glance {
            to_curve = at_points(problem, mechanism.linkage, &crank_deg, &t1_at);
        }
        let judged = assess_on_curve(problem, mechanism.linkage, (&crank_deg, &t1_at), None, to_curve);
        if let Some(form) = judged {
            to_curve.get_or_insert(form.error.to_curve);
            forms.push(form);
        }
    }
    forms.sort_by_cached_key(Merit::of);
    let mut forms = forms.into_iter();
    let mut best = forms.next()?;
    if depth == Depth::Whole {
        // The best gets its own figures.
        best = assess(problem, best.linkage, &best.crank_deg, &best.t1_at)?;
    }
    let other =
        |c: Candidate| ExactForm { linkage: c.linkage, linkage_type: c.linkage_type, defects: c.defects };
    Some(Class {
        best,
        one_circuit: any(Mechanism::on_one_circuit),
        in_order: any(Mechanism::in_order),
        free_of_defects: any(Mechanism::is_free_of_defects),
        others: forms.map(other).collect(),
    })
}

/// Returns the errors at the points, in place of those to the curve.
fn at_points(
    problem: &Problem,
    linkage: CrankLinkage,
    crank_deg: &[f64],
    t1_at: &[AssemblyMode],
) -> Option<CurveErrorRecord> {
    let angles: Vec<f64> = crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let error = problem.task().errors(linkage, &angles, t1_at, None)?;
    Some(CurveErrorRecord {
        sum_sq: error.sum_sq,
        rms: rms(error.sum_sq, problem.task().len()),
        max: error.max,
    })
}

/// Returns the crank angles, degrees, and the assemblies of a mechanism as a candidate has them.
fn positions(problem: &Problem, mechanism: &Mechanism) -> (Vec<f64>, Vec<AssemblyMode>) {
    let (angles, assemblies) = (mechanism.crank_angles.clone(), mechanism.assemblies.clone());
    unwrapped(problem, mechanism.linkage, angles, assemblies)
}

impl Class {
    /// Returns the class as it is written to the record.
    pub fn listed(&self, certified: Option<Certified>) -> ExactLinkage {
        let best = &self.best;
        ExactLinkage {
            rank: 0,
            linkage: best.linkage,
            crank_deg: best.crank_deg.clone(),
            t1_at: best.t1_at.to_vec(),
            miss: best.error.max,
            linkage_type: best.linkage_type,
            defects: best.defects.clone(),
            transmission_worst_deg: best.transmission_deg.worst,
            link_ratio: best.link_ratio,
            accepted: best.accepted,
            not_met: not_met(best),
            one_circuit: self.one_circuit,
            in_order: self.in_order,
            free_of_defects: self.free_of_defects,
            certified,
            others: self.others.clone(),
        }
    }
}

/// Whether some mechanism of a class has a property, as far as that is known from one rounded linkage of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ability {
    /// Whether a mechanism that certainly passes the points has it.
    pub certain: bool,
    /// Whether a mechanism that possibly passes them has it.
    pub possible: bool,
}

/// A listed class, computed again from its linkage.
#[derive(Clone, Debug)]
pub struct Recomputed {
    /// The listed linkage, judged; `None` if it cannot be.
    pub judged: Option<Candidate>,
    /// The properties of the class: on one circuit, in order, free of defects.
    pub abilities: [Ability; 3],
    /// All mechanisms of the class, each with whether it passes the points beyond doubt.
    pub forms: Vec<(ExactForm, bool)>,
}

/// Bounds of a mechanism's miss in units of its limit: up to `BEYOND_DOUBT` it passes the points whatever rounding
/// does, beyond `IN_DOUBT` it does not. (A class is found again from a rounded linkage, which may be worse conditioned
/// than the others.)
const BEYOND_DOUBT: f64 = 0.1;
const IN_DOUBT: f64 = 100.0;
/// The least sine of the transmission angle at which a point's assembly is beyond doubt.
const CLEAR_OF_TOGGLES: f64 = 1e-4;

/// The change of crank angles (radians) that leaves the defects as they are, unless the order hangs on rounding: on a step
/// of half a turn, or on two ways round of one length.
const NUDGE: f64 = 1e-7;

/// Computes the class of a linkage from its positions alone; `None` if it does not pass the points.
pub fn class_at(
    problem: &Problem,
    target: &Precise,
    (linkage, crank_deg, t1_at): (&CrankLinkage, &[f64], &[AssemblyMode]),
) -> Option<Recomputed> {
    let angles: Vec<f64> = crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let given = solution_of(target, linkage, &angles, t1_at)?;
    let mut list = mechanisms(problem.task(), target, &given);
    list.retain(|m| m.miss_over_limit <= IN_DOUBT);
    if list.is_empty() {
        return None;
    }
    let settled: Vec<bool> = list.iter().map(|m| is_settled(problem, m)).collect();
    let all = || list.iter().zip(settled.iter().copied());
    let beyond_doubt = |m: &Mechanism, settled: bool| settled && m.miss_over_limit <= BEYOND_DOUBT;
    let ability = |defects: &[&str]| {
        let can = |m: &Mechanism| !m.defects.iter().any(|defect| defects.contains(&defect.name()));
        Ability {
            certain: all().any(|(m, settled)| beyond_doubt(m, settled) && can(m)),
            possible: all().any(|(m, settled)| !settled || can(m)),
        }
    };
    Some(Recomputed {
        judged: assess(problem, linkage, crank_deg, t1_at),
        abilities: [
            ability(&["circuit"]),
            ability(&["circuit", "order"]),
            ability(&["circuit", "order", "branch"]),
        ],
        forms: all().map(|(m, settled)| (form(problem, m, 0.0), beyond_doubt(m, settled))).collect(),
    })
}

/// Returns whether the defects of a mechanism are beyond rounding: no point lies at a toggle, and a small change of the
/// crank angles leaves them as they are.
fn is_settled(problem: &Problem, mechanism: &Mechanism) -> bool {
    let defects = |by: f64| form(problem, mechanism, by).defects;
    let found = defects(0.0);
    mechanism.least_sine >= CLEAR_OF_TOGGLES && defects(NUDGE) == found && defects(-NUDGE) == found
}

/// Returns a mechanism with its type and its defects, its crank angles moved by `by` (radians) to and fro from point to
/// point.
fn form(problem: &Problem, mechanism: &Mechanism, by: f64) -> ExactForm {
    let (crank_deg, t1_at) = positions(problem, mechanism);
    let signs = [1.0, -1.0].into_iter().cycle();
    let radians: Vec<f64> =
        crank_deg.iter().zip(signs).map(|(deg, sign)| deg.to_radians() + sign * by).collect();
    let linkage = mechanism.linkage;
    ExactForm {
        linkage,
        linkage_type: linkage.four_bar().and_then(FourBar::linkage_type),
        defects: judge(problem.task(), linkage, &radians, &t1_at).defects,
    }
}
