//! Assessment of a candidate: every figure and verdict, from nothing but the problem, the linkage and its positions.
//!
//! Searches call it to rank, `run` to write the record and `verify` to check one: there is one judge, and it uses no
//! optimiser.

use crate::judge::error::{StructuralError, distances_to_curve, rms};
use crate::judge::loosen::design_limits;
use crate::judge::referee::judge;
use crate::judge::requirement::{Judged, at_least, at_most};
use crate::judge::torque::peak_torque;
use crate::judge::two_sided::two_sided;
use crate::mechanism::{AssemblyMode, Complex, CrankLinkage, FourBar, InputRange, SliderCrank, point};
use crate::record::{
    AngleErrorRecord, Assemblies, Candidate, CurveErrorRecord, ErrorRecord, Figure, Requirement,
    TransmissionRecord,
};
use crate::task::ranges::Reference;
use crate::task::requirement::RequirementKind;
use crate::task::spec::{Limits, Objective, TransmissionOver};
use crate::task::{AngleOffset, Body, Problem, Sense};

pub use crate::record::MET_TOLERANCE;

/// Judges a linkage at crank angles given in degrees, one per target point (as in the record).
///
/// `None` if the loop is open at a point or the pivots coincide: then there is no error to report. The rank is left at
/// 0. The body of a motion lies on the coupler where its errors are least.
///
/// # Panics
/// If there are fewer angles or assemblies than points.
pub fn assess(
    problem: &Problem,
    linkage: impl Into<CrankLinkage>,
    crank_deg: &[f64],
    assemblies: &[AssemblyMode],
) -> Option<Candidate> {
    assess_on_curve(problem, linkage, (crank_deg, assemblies), None, None)
}

/// Judges a candidate anew, by this problem; the body of a motion keeps its place on the coupler.
pub fn assess_again(problem: &Problem, candidate: &Candidate) -> Option<Candidate> {
    let Candidate { linkage, crank_deg, t1_at, .. } = candidate;
    assess_on_curve(
        problem,
        linkage,
        (crank_deg, t1_at.as_slice()),
        candidate.own_reference(&problem.spec().task),
        None,
    )
}

/// Computes the distances of a candidate to its whole curve anew. Those of the candidates that a search does not list are
/// carried over from the frame in which it searched, and differ in the last digits.
pub fn measure_curve(problem: &Problem, candidate: &mut Candidate) {
    if let Some(anew) = assess_again(problem, candidate) {
        candidate.error.to_curve = anew.error.to_curve;
    }
}

/// As [`assess`] at the positions `at`, for a link whose angles count from `own` ([`Candidate::own_reference`];
/// without it: where the errors are least) and for a linkage whose distances to its whole curve may be known: a cognate has those of the
/// linkage that it is a cognate of. They are most of the cost.
///
/// # Panics
/// If there are fewer angles or assemblies than points.
pub fn assess_on_curve(
    problem: &Problem,
    linkage: impl Into<CrankLinkage>,
    at: (&[f64], &[AssemblyMode]),
    own: Option<Reference>,
    to_curve: Option<CurveErrorRecord>,
) -> Option<Candidate> {
    let (linkage, (crank_deg, assemblies)) = (linkage.into(), at);
    let linkage = &linkage;
    let task = problem.task();
    let crank_angles: Vec<f64> = crank_deg.iter().map(|d| d.to_radians()).collect();
    let mobility = linkage.mobility();
    if mobility.input == InputRange::None {
        return None;
    }
    // Coincident pivots do not give a linkage to build: there is no ratio and no ground line.
    if !linkage.link_ratio().is_finite() {
        return None;
    }
    let error = task.errors(linkage, &crank_angles, assemblies, own)?;
    let to_curve = match to_curve {
        Some(known) => known,
        None => distances_to_curve(task.points(), linkage, crank_angles[0], assemblies[0])?,
    };
    let verdict = judge(task, linkage, &crank_angles, assemblies);
    let over = problem.spec().require.transmission_over.unwrap_or(if mobility.input_turns_fully() {
        TransmissionOver::Cycle
    } else {
        TransmissionOver::Used
    });
    let extremes = match over {
        TransmissionOver::Cycle => linkage.transmission_over_cycle()?,
        TransmissionOver::Used => verdict.motion.transmission(),
    };
    let rms = rms(error.sum_sq, task.len());
    let of_link = error.angle.as_ref().map(|angle| AngleErrorRecord {
        rms_deg: angle.rms.to_degrees(),
        max_deg: angle.max.to_degrees(),
        max_at: angle.max_at,
    });
    let is_function = task.is_function();
    let is_of_places = task.body().is_some_and(Body::is_of_places);
    let given_frame =
        || error.angle.as_ref().map(|angle| own.map_or(angle.frame.to_degrees(), |own| own.frame_deg));
    let [input_range_deg, output_range_deg] = ranges_deg(problem, crank_deg, &error);
    let offsets_deg = is_function.then(|| offsets_deg(problem, linkage, crank_deg, &error)).flatten();
    let mut candidate = Candidate {
        rank: 0,
        linkage: *linkage,
        crank_deg: crank_deg.to_vec(),
        t1_at: Assemblies::of(linkage, assemblies.to_vec()),
        frame_deg: given_frame().filter(|_| !is_function),
        input_offset_deg: offsets_deg.map(|[input, _]| input),
        output_offset_deg: offsets_deg.map(|[_, output]| output).filter(|_| !is_of_places),
        output_offset: offsets_deg.map(|[_, output]| output).filter(|_| is_of_places),
        input_range_deg,
        output_range_deg,
        sense: error.angle.as_ref().filter(|_| is_function).map(|angle| Sense::of(angle.sign)),
        error: ErrorRecord {
            objective: match problem.spec().solve.objective {
                Objective::SumOfSquares => error.objective,
                Objective::MaxDeviation => error.deviation(task),
            },
            sum_sq: error.sum_sq,
            rms,
            max: error.max,
            max_at: error.max_at,
            rms_over_size: rms / (error.scale() * task.error_size()),
            to_curve,
            angle: of_link.filter(|_| !is_function),
            output: of_link.filter(|_| is_function && !is_of_places),
            to_raw: None,
            two_sided: None,
        },
        linkage_type: mobility.linkage_type,
        grashof_margin: mobility.margin,
        transmission_deg: TransmissionRecord {
            min: extremes.min.to_degrees(),
            max: extremes.max.to_degrees(),
            worst: extremes.worst().to_degrees(),
            over,
        },
        link_ratio: linkage.link_ratio(),
        peak_torque: peak_torque(problem, linkage, &crank_angles, assemblies),
        warnings: Vec::new(),
        alternatives: Vec::new(),
        requirements: Vec::new(),
        accepted: false,
        certified: None,
        mirror_serves: false,
        defects: verdict.defects.clone(),
        costs: Vec::new(),
    };
    let judged = Judged { problem, candidate: &candidate, verdict: &verdict, error: &error };
    candidate.requirements = requirements(&judged);
    candidate.accepted = candidate.requirements.iter().all(|r| r.met)
        && !candidate.defects.iter().any(|d| problem.spec().require.forbids(d));
    Some(candidate)
}

/// Returns the angles of crank and follower from the line A-B at an input and an output of 0 in a function, degrees; of a
/// slider the place at an output of 0, in the sense of the outputs, in place of the second. `None` of another task.
fn offsets_deg(
    problem: &Problem,
    linkage: &CrankLinkage,
    crank_deg: &[f64],
    error: &StructuralError,
) -> Option<[f64; 2]> {
    let (given, angle) = (problem.spec().task.timing.as_ref()?, error.angle.as_ref()?);
    let ground_deg = linkage.ground_angle().to_degrees();
    let input = match given.offset {
        AngleOffset::Ground => 0.0,
        AngleOffset::Free | AngleOffset::Fixed => {
            let scale = input_scale(problem, crank_deg);
            within_half_a_turn(crank_deg[0] - scale * given.crank_deg[0] - ground_deg)
        }
    };
    if problem.task().body()?.is_of_places() {
        return Some([input, -angle.frame.to_degrees() * angle.sign]);
    }
    let output_from_ground = problem.task().body()?.given_frame(0.0).is_some();
    let output =
        if output_from_ground { 0.0 } else { within_half_a_turn(-angle.frame.to_degrees() - ground_deg) };
    Some([input, output])
}

/// Returns the scale of the written inputs of a function at crank angles (degrees); 1 unless their range is free.
fn input_scale(problem: &Problem, crank_deg: &[f64]) -> f64 {
    let is_free = problem.task().ranges().free()[0];
    let Some(written) = problem.spec().task.timing.as_ref().filter(|_| is_free) else { return 1.0 };
    let order = |one: &(usize, &f64), other: &(usize, &f64)| one.1.total_cmp(other.1);
    let least = written.crank_deg.iter().enumerate().min_by(order);
    let greatest = written.crank_deg.iter().enumerate().max_by(order);
    let (Some((i, low)), Some((j, high))) = (least, greatest) else { return 1.0 };
    (crank_deg[j] - crank_deg[i]) / (high - low)
}

/// Returns the ranges of the inputs and the outputs of a function, degrees, each if it is free.
fn ranges_deg(problem: &Problem, crank_deg: &[f64], error: &StructuralError) -> [Option<f64>; 2] {
    let free = problem.task().ranges().free();
    if free == [false; 2] {
        return [None; 2];
    }
    let [input, output] = problem.spec().task.written_ranges_deg();
    [free[0].then(|| input_scale(problem, crank_deg) * input), free[1].then(|| error.scale() * output)]
}

/// Returns an angle in degrees within half a turn.
fn within_half_a_turn(deg: f64) -> f64 {
    deg - 360.0 * (deg / 360.0).round()
}

/// Returns the distances from the points as they were given, before smoothing and resampling, to the coupler curve of a
/// candidate; `None` if the target is those points themselves.
pub fn to_raw(problem: &Problem, candidate: &Candidate) -> Option<CurveErrorRecord> {
    let raw = &problem.spec().task.raw.as_ref()?.points;
    let points: Vec<Complex> = raw.iter().copied().map(point).collect();
    let (first, assembly) = (candidate.crank_deg.first()?, candidate.t1_at.first()?);
    distances_to_curve(&points, candidate.linkage, first.to_radians(), *assembly)
}

/// Computes the distances of a listed candidate that its search did not need: from the points as they were given, and between path
/// and curve both ways.
pub fn measure_beside(problem: &Problem, candidate: &mut Candidate) {
    candidate.error.to_raw = to_raw(problem, candidate);
    candidate.error.two_sided = two_sided(problem, candidate);
}

/// Returns the rows of the requirements and of the design's bounds, in the order of a record.
fn requirements(judged: &Judged<'_>) -> Vec<Requirement> {
    let of = |kind: &RequirementKind| judged.row(*kind);
    let before = |kind: &&RequirementKind| !kind.is_tolerance();
    let mut rows: Vec<Requirement> = RequirementKind::all().iter().filter(before).filter_map(of).collect();
    rows.extend(design_rows(judged.problem, &judged.candidate.linkage));
    rows.extend(RequirementKind::TOLERANCES.iter().filter_map(of));
    rows
}

/// Returns the place in a box that a slider-crank's line passes, in the middle of what the box cuts out of it; of a line
/// that passes beside, its place nearest to the middle of the box.
fn passed_place(rail: &SliderCrank, [x, y]: [Limits; 2]) -> Complex {
    let (from, s) = (rail.line_point(), rail.line_direction());
    let middle = Complex::new(0.5 * (x.0 + x.1), 0.5 * (y.0 + y.1));
    let foot = ((middle - from) * s.conj()).re;
    let mut inside = [f64::NEG_INFINITY, f64::INFINITY];
    for (at, along, Limits(low, high)) in [(from.re, s.re, x), (from.im, s.im, y)] {
        if along == 0.0 {
            continue;
        }
        let (one, other) = ((low - at) / along, (high - at) / along);
        inside = [inside[0].max(one.min(other)), inside[1].min(one.max(other))];
    }
    let place = if inside[0] < inside[1] && inside.iter().all(|t| t.is_finite()) {
        0.5 * (inside[0] + inside[1])
    } else {
        foot
    };
    from + s * place
}

/// Returns the design table's limits, each with the linkage's own value.
fn design_rows(problem: &Problem, linkage: &CrankLinkage) -> Vec<Requirement> {
    let (a, offset) = (linkage.crank_pivot(), linkage.coupler_offset());
    let (four_bar, second) = (linkage.four_bar(), linkage.second_pivot());
    let rail = linkage.slider_crank();
    let passed = rail.zip(problem.spec().design.line_point).map(|(rail, place)| passed_place(rail, place));
    // The keys of other kinds bound nothing of this one.
    let values = [
        ("design.Ax", Some(a.re)),
        ("design.Ay", Some(a.im)),
        ("design.Bx", second.map(|b| b.re)),
        ("design.By", second.map(|b| b.im)),
        ("design.a", Some(linkage.crank())),
        ("design.b", linkage.coupler()),
        ("design.c", four_bar.map(FourBar::follower)),
        ("design.d", Some(linkage.crank_side())),
        ("design.e", linkage.second_side()),
        ("design.ground", linkage.ground()),
        ("design.ground_angle_deg", second.map(|_| linkage.ground_angle().to_degrees())),
        ("design.line_deg", rail.map(|rail| rail.parameters().line_deg)),
        ("design.line_x", passed.map(|p| p.re)),
        ("design.line_y", passed.map(|p| p.im)),
        ("design.coupler_x", Some(offset.re)),
        ("design.coupler_y", Some(offset.im)),
    ];
    // Of several loops the fixed pivots A and B alone are bounded.
    let bounds = |name: &str| {
        linkage.multi_loop().is_none()
            || matches!(name, "design.Ax" | "design.Ay" | "design.Bx" | "design.By")
    };
    let row = |(name, value): (&str, Option<f64>)| {
        let value = value.filter(|_| bounds(name))?;
        let Limits(low, high) = design_limits(&problem.spec().design, name)?;
        let value = match name {
            // A line has no sense.
            "design.line_deg" => value + 180.0 * ((0.5 * (low + high) - value) / 180.0).round(),
            // The angle nearest to the middle of its limits.
            "design.ground_angle_deg" => value + 360.0 * ((0.5 * (low + high) - value) / 360.0).round(),
            _ => value,
        };
        Some(Requirement {
            name: name.into(),
            value: Figure::Number(value),
            limit: Figure::Numbers(vec![low, high]),
            met: at_least(value, low) && at_most(value, high),
        })
    };
    values.into_iter().filter_map(row).collect()
}
