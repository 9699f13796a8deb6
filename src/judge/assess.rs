//! Assessment of a candidate: every figure and verdict, from nothing but the problem, the linkage and its positions.
//!
//! Searches call it to rank, `run` to write the record and `verify` to check one: there is one judge, and it uses no
//! optimiser.

use crate::judge::error::{distances_to_curve, rms};
use crate::judge::referee::{Verdict, judge};
use crate::mechanism::{AssemblyMode, Complex, FourBar};
use crate::record::{
    Candidate, CurveErrorRecord, ErrorRecord, Figure, Requirement, TO_AND_FRO, TransmissionRecord,
};
use crate::task::Defect;
use crate::task::Problem;
use crate::task::spec::{DirectionPolicy, Limits, Objective, OnePolicy, OrderPolicy, TransmissionOver};

pub use crate::record::MET_TOLERANCE;

/// Returns whether `value` reaches at least `limit`, within the tolerance.
fn at_least(value: f64, limit: f64) -> bool {
    value >= limit - MET_TOLERANCE * limit.abs().max(1.0)
}

fn at_most(value: f64, limit: f64) -> bool {
    value <= limit + MET_TOLERANCE * limit.abs().max(1.0)
}

/// Judges a linkage at crank angles given in degrees, one per target point (as in the record).
///
/// `None` if the loop is open at a point or the pivots coincide: then there is no error to report. The rank is left at
/// 0.
///
/// # Panics
/// If there are fewer angles or assemblies than points.
pub fn assess(
    problem: &Problem,
    linkage: &FourBar,
    crank_deg: &[f64],
    assemblies: &[AssemblyMode],
) -> Option<Candidate> {
    assess_on_curve(problem, linkage, crank_deg, assemblies, None)
}

/// As [`assess`], for a linkage whose distances to its whole curve are known: a cognate has those of the linkage that
/// it is a cognate of. They are most of the cost.
///
/// # Panics
/// If there are fewer angles or assemblies than points.
pub fn assess_on_curve(
    problem: &Problem,
    linkage: &FourBar,
    crank_deg: &[f64],
    assemblies: &[AssemblyMode],
    to_curve: Option<CurveErrorRecord>,
) -> Option<Candidate> {
    let task = problem.task();
    let crank_angles: Vec<f64> = crank_deg.iter().map(|d| d.to_radians()).collect();
    let linkage_type = linkage.linkage_type()?;
    // Coincident pivots do not give a linkage to build: there is no ratio and no ground line.
    if !linkage.link_ratio().is_finite() {
        return None;
    }
    let error = task.errors(linkage, &crank_angles, assemblies)?;
    let n = task.len();
    let to_curve = match to_curve {
        Some(known) => known,
        None => {
            let found = task.errors_to_curve(linkage, crank_angles[0], assemblies[0])?;
            CurveErrorRecord { sum_sq: found.sum_sq, rms: rms(found.sum_sq, n), max: found.max }
        }
    };
    let verdict = judge(task, linkage, &crank_angles, assemblies);
    let over = problem.spec().require.transmission_over.unwrap_or(if linkage_type.input_turns_fully() {
        TransmissionOver::Cycle
    } else {
        TransmissionOver::Used
    });
    let extremes = match over {
        TransmissionOver::Cycle => linkage.transmission_over_cycle(),
        TransmissionOver::Used => verdict.motion.transmission(),
    };
    let mut candidate = Candidate {
        rank: 0,
        linkage: *linkage,
        crank_deg: crank_deg.to_vec(),
        t1_at: assemblies.to_vec(),
        error: ErrorRecord {
            objective: match problem.spec().solve.objective {
                Objective::SumOfSquares => error.objective,
                Objective::MaxDeviation => error.deviation(task.tolerances()),
            },
            sum_sq: error.sum_sq,
            rms: rms(error.sum_sq, n),
            max: error.max,
            max_at: error.max_at,
            rms_over_size: rms(error.sum_sq, n) / task.size(),
            to_curve,
            to_raw: None,
        },
        linkage_type,
        grashof_margin: linkage.grashof_margin(),
        transmission_deg: TransmissionRecord {
            min: extremes.min.to_degrees(),
            max: extremes.max.to_degrees(),
            worst: extremes.worst().to_degrees(),
            over,
        },
        link_ratio: linkage.link_ratio(),
        warnings: Vec::new(),
        alternatives: Vec::new(),
        requirements: Vec::new(),
        accepted: false,
        certified: None,
        mirror_serves: false,
        defects: verdict.defects.clone(),
        costs: Vec::new(),
    };
    candidate.requirements = requirements(problem, &candidate, &verdict);
    if let Some(tolerances) = task.tolerances() {
        candidate.requirements.push(tolerance_row(tolerances, &error.structural));
    }
    candidate.accepted = candidate.requirements.iter().all(|r| r.met)
        && !candidate.defects.iter().any(|d| problem.spec().require.forbids(d));
    Some(candidate)
}

/// Returns the distances from the points as they were given, before smoothing and resampling, to the coupler curve of a
/// candidate; `None` if the target is those points themselves.
pub fn to_raw(problem: &Problem, candidate: &Candidate) -> Option<CurveErrorRecord> {
    let raw = &problem.spec().task.path.raw.as_ref()?.points;
    let points: Vec<Complex> = raw.iter().map(|[x, y]| Complex::new(*x, *y)).collect();
    let (first, assembly) = (candidate.crank_deg.first()?, candidate.t1_at.first()?);
    let found = distances_to_curve(&points, &candidate.linkage, first.to_radians(), *assembly)?;
    Some(CurveErrorRecord { sum_sq: found.sum_sq, rms: rms(found.sum_sq, points.len()), max: found.max })
}

fn tolerance_row(tolerances: &[f64], structural: &[crate::mechanism::Complex]) -> Requirement {
    // The point whose error is the largest part of its own tolerance: the quantity that the largest deviation minimises
    // and that ranks. A point that is missed goes before one that is met only by the margin of a very small tolerance.
    let error = |k: usize| structural[k].norm();
    let missed = |k: usize| !at_most(error(k), tolerances[k]);
    let part = |k: usize| if error(k) == 0.0 { 0.0 } else { error(k) / tolerances[k] };
    let worst = (0..structural.len())
        .max_by(|&i, &j| missed(i).cmp(&missed(j)).then(part(i).total_cmp(&part(j))).then(j.cmp(&i)))
        .unwrap_or(0);
    let (value, limit) = (structural[worst].norm(), tolerances[worst]);
    Requirement {
        name: "tolerance".into(),
        value: Figure::Number(value),
        limit: Figure::Number(limit),
        met: at_most(value, limit),
    }
}

fn requirements(problem: &Problem, candidate: &Candidate, verdict: &Verdict) -> Vec<Requirement> {
    let require = &problem.spec().require;
    let mut rows = Vec::new();
    let mut push = |name: &str, value: Figure, limit: Figure, met: bool| {
        rows.push(Requirement { name: name.into(), value, limit, met });
    };
    if !require.types.is_empty() {
        push(
            "type",
            Figure::Word(candidate.linkage_type.name().into()),
            Figure::Words(require.types.iter().map(|t| t.name().into()).collect()),
            require.types.contains(&candidate.linkage_type),
        );
    }
    if let Some(limit) = require.transmission_deg_min {
        let value = candidate.transmission_deg.worst;
        push("transmission_deg_min", Figure::Number(value), Figure::Number(limit), at_least(value, limit));
    }
    let limit = require.link_ratio_max;
    push(
        "link_ratio_max",
        Figure::Number(candidate.link_ratio),
        Figure::Number(limit),
        at_most(candidate.link_ratio, limit),
    );
    let inside = |held: [f64; 4], limit: [f64; 4]| {
        (0..2).all(|i| at_least(held[i], limit[i]) && at_most(held[i + 2], limit[i + 2]))
    };
    let boxed = |b: [f64; 4]| Figure::Numbers(b.to_vec());
    if let Some(limit) = require.pivots_in {
        let (a, b) = (candidate.linkage.crank_pivot(), candidate.linkage.follower_pivot());
        let held = [a.re.min(b.re), a.im.min(b.im), a.re.max(b.re), a.im.max(b.im)];
        push("pivots_in", boxed(held), boxed(limit), inside(held, limit));
    }
    if let Some(limit) = require.footprint_in {
        let held = verdict.motion.footprint();
        push("footprint_in", boxed(held), boxed(limit), inside(held, limit));
    }
    if require.direction != DirectionPolicy::Any {
        let word = |ccw: bool| if ccw { "ccw" } else { "cw" };
        let (has, wants) = (verdict.direction > 0.0, require.direction == DirectionPolicy::Ccw);
        push("direction", Figure::Word(word(has).into()), Figure::Word(word(wants).into()), has == wants);
    }
    for defect in ["order", "branch", "circuit"] {
        let policy = match defect {
            "order" => require.order == OrderPolicy::Required,
            "branch" => require.branch == OnePolicy::One,
            _ => require.circuit == OnePolicy::One,
        };
        if policy {
            let found = candidate.defects.iter().any(|d| d.name() == defect);
            let wants = if defect == "order" { "required" } else { "one" };
            let has = match (found, defect) {
                (false, _) => wants,
                (true, "order") if candidate.defects.iter().any(Defect::is_to_and_fro) => TO_AND_FRO,
                (true, "order") => "broken",
                (true, _) => "several",
            };
            push(defect, Figure::Word(has.into()), Figure::Word(wants.into()), !found);
        }
    }
    if !require.closing.is_one_way() && problem.task().returns() {
        let has = if verdict.to_and_fro { TO_AND_FRO } else { "one-way" };
        push("closing", Figure::Word(has.into()), Figure::Word("any".into()), true);
    }
    rows.extend(design_rows(problem, &candidate.linkage));
    rows
}

/// Returns the design table's limits, each with the linkage's own value.
fn design_rows(problem: &Problem, linkage: &FourBar) -> Vec<Requirement> {
    let design = &problem.spec().design;
    let offset = linkage.coupler_offset();
    let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
    let mut rows = Vec::new();
    let mut push = |name: &str, value: f64, limits: Option<Limits>| {
        if let Some(Limits(low, high)) = limits {
            rows.push(Requirement {
                name: format!("design.{name}"),
                value: Figure::Number(value),
                limit: Figure::Numbers(vec![low, high]),
                met: at_least(value, low) && at_most(value, high),
            });
        }
    };
    let axis = |p: Option<[Limits; 2]>, i: usize| p.map(|p| p[i]);
    push("Ax", a.re, axis(design.crank_pivot, 0));
    push("Ay", a.im, axis(design.crank_pivot, 1));
    push("Bx", b.re, axis(design.follower_pivot, 0));
    push("By", b.im, axis(design.follower_pivot, 1));
    push("a", linkage.crank(), design.a);
    push("b", linkage.coupler(), design.b);
    push("c", linkage.follower(), design.c);
    push("d", linkage.crank_side(), design.d);
    push("e", linkage.follower_side(), design.e);
    push("ground", linkage.ground(), design.ground);
    if let Some(Limits(low, high)) = design.ground_angle_deg {
        // The turn of the ground line that lies nearest to the limits.
        let middle = 0.5 * (low + high);
        let angle = linkage.ground_angle().to_degrees();
        let value = angle + 360.0 * ((middle - angle) / 360.0).round();
        push("ground_angle_deg", value, Some(Limits(low, high)));
    }
    push("coupler_x", offset.re, design.coupler_x);
    push("coupler_y", offset.im, design.coupler_y);
    rows
}
