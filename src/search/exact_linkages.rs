//! Real solutions as candidates: of each class the best of its six mechanisms, judged as every candidate is.
//!
//! The better first: accepted, then lighter defects, then fewer requirements unmet, the better worst transmission
//! angle, the smaller linkage. That is the order of ranks ([`super::rank`]), for exact errors are equal.

use super::cognates::{Merit, not_met};
use super::multistart::unwrapped;
use super::rank::compare;
use crate::assess::{assess, assess_on_curve};
use crate::exact::mechanisms::solution_of;
use crate::exact::{Mechanism, Solution, Target, mechanisms};
use crate::linkage::{AssemblyMode, FourBar};
use crate::problem::Problem;
use crate::record::{Candidate, Certified, CurveErrorRecord, ExactForm, ExactLinkage};
use crate::task::error::rms;
use crate::task::referee::judge;
use rayon::prelude::*;

/// A real class with its mechanisms judged.
#[derive(Clone, Debug)]
pub struct Class {
    /// The best of the six.
    pub best: Candidate,
    /// Whether one of the six stays on one circuit.
    pub one_circuit: bool,
    /// Whether one of the six passes the points in order.
    pub in_order: bool,
    /// Whether one of the six has no defect.
    pub free_of_defects: bool,
    /// The other five, better first.
    pub others: Vec<ExactForm>,
}

/// How much is found out of a class.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// Every figure.
    Whole,
    /// All but the distances to the whole curve, most of the cost, in whose place those at the points stand: of an exact
    /// linkage both are rounding, and the curve is nowhere farther from a point.
    Glance,
}

/// The classes of real solutions, better first. One that makes no linkage (a link of no length, or of one too large)
/// is left out.
pub fn classes(problem: &Problem, target: &Target, real: &[Solution], depth: Depth) -> Vec<Class> {
    let judged: Vec<Option<Class>> =
        real.par_iter().map(|solution| class(problem, target, solution, depth)).collect();
    let mut classes: Vec<Class> = judged.into_iter().flatten().collect();
    // Stable: equals stay in the order of the solver.
    classes.sort_by(|one, other| compare(problem, &one.best, &other.best));
    classes
}

/// A real solution's class; `None` where none of the six is a linkage that passes the points.
pub fn class(problem: &Problem, target: &Target, solution: &Solution, depth: Depth) -> Option<Class> {
    let list = mechanisms(problem.task(), target, solution);
    let any = |of: fn(&Mechanism) -> bool| list.iter().any(of);
    let mut to_curve = None;
    let mut forms = Vec::with_capacity(list.len());
    for mechanism in list.iter().filter(|m| m.passes) {
        let (angles, assemblies) = (mechanism.crank_angles.to_vec(), mechanism.assemblies.to_vec());
        let (crank_deg, t1_at) = unwrapped(problem, &mechanism.linkage, angles, assemblies);
        // One curve, and on it one circuit through the first point: its distances are known after the first.
        if depth == Depth::Glance {
            to_curve = at_points(problem, &mechanism.linkage, &crank_deg, &t1_at);
        }
        let judged = assess_on_curve(problem, &mechanism.linkage, &crank_deg, &t1_at, to_curve);
        if let Some(form) = judged {
            to_curve.get_or_insert(form.error.to_curve);
            forms.push(form);
        }
    }
    forms.sort_by_cached_key(Merit::of);
    let mut forms = forms.into_iter();
    let mut best = forms.next()?;
    if depth == Depth::Whole {
        // Its figures are its own.
        best = assess(problem, &best.linkage, &best.crank_deg, &best.t1_at)?;
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

/// The errors at the points, as those to the curve.
fn at_points(
    problem: &Problem,
    linkage: &FourBar,
    crank_deg: &[f64],
    t1_at: &[AssemblyMode],
) -> Option<CurveErrorRecord> {
    let angles: Vec<f64> = crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let error = problem.task().errors(linkage, &angles, t1_at)?;
    Some(CurveErrorRecord {
        sum_sq: error.sum_sq,
        rms: rms(error.sum_sq, problem.task().len()),
        max: error.max,
    })
}

impl Class {
    /// The class as it stands in the record.
    pub fn listed(&self, certified: Option<Certified>) -> ExactLinkage {
        let best = &self.best;
        ExactLinkage {
            rank: 0,
            linkage: best.linkage,
            crank_deg: best.crank_deg.clone(),
            t1_at: best.t1_at.clone(),
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

/// Whether a class can do something, as far as that is known from one linkage of it with its rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ability {
    /// A mechanism that passes the points beyond doubt can.
    pub certain: bool,
    /// A mechanism that may pass them can.
    pub possible: bool,
}

/// What is found again of a listed class.
#[derive(Clone, Debug)]
pub struct Recomputed {
    /// The listed linkage, judged; `None` where it cannot be.
    pub judged: Option<Candidate>,
    /// On one circuit, in order, free of defects, by one of the six.
    pub abilities: [Ability; 3],
    /// All mechanisms of the class, each with whether it passes the points beyond doubt.
    pub forms: Vec<(ExactForm, bool)>,
}

/// A mechanism that misses the points by at most this part of what it may passes them whatever rounding does; beyond the
/// other it does not. (A class is found again from a rounded linkage, which may be worse conditioned than the others.)
const BEYOND_DOUBT: f64 = 0.1;
const IN_DOUBT: f64 = 100.0;

/// The class of a linkage at its positions, found from these alone; `None` where it does not pass the points.
pub fn class_at(
    problem: &Problem,
    target: &Target,
    (linkage, crank_deg, t1_at): (&FourBar, &[f64], &[AssemblyMode]),
) -> Option<Recomputed> {
    let angles: Vec<f64> = crank_deg.iter().map(|deg| deg.to_radians()).collect();
    let given = solution_of(target, linkage, &angles, t1_at)?;
    let mut list = mechanisms(problem.task(), target, &given);
    list.retain(|m| m.miss_over_limit <= IN_DOUBT);
    if list.is_empty() {
        return None;
    }
    let certain = |m: &&Mechanism| m.miss_over_limit <= BEYOND_DOUBT;
    let ability = |defects: &[&str]| {
        let can = |m: &Mechanism| !m.defects.iter().any(|defect| defects.contains(&defect.name()));
        Ability { certain: list.iter().filter(certain).any(can), possible: list.iter().any(can) }
    };
    Some(Recomputed {
        judged: assess(problem, linkage, crank_deg, t1_at),
        abilities: [
            ability(&["circuit"]),
            ability(&["circuit", "order"]),
            ability(&["circuit", "order", "branch"]),
        ],
        forms: list
            .iter()
            .filter_map(|m| Some((form(problem, m)?, m.miss_over_limit <= BEYOND_DOUBT)))
            .collect(),
    })
}

/// A mechanism with its type and its defects; `None` where its links are those of no type.
fn form(problem: &Problem, mechanism: &Mechanism) -> Option<ExactForm> {
    let (angles, assemblies) = (mechanism.crank_angles.to_vec(), mechanism.assemblies.to_vec());
    let (crank_deg, t1_at) = unwrapped(problem, &mechanism.linkage, angles, assemblies);
    let radians: Vec<f64> = crank_deg.iter().map(|deg| deg.to_radians()).collect();
    Some(ExactForm {
        linkage: mechanism.linkage,
        linkage_type: mechanism.linkage.linkage_type()?,
        defects: judge(problem.task(), &mechanism.linkage, &radians, &t1_at).defects,
    })
}
