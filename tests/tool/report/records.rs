//! Records made by hand, with the referee's figures.

use linkwright::internals::judge::error::distances_to_curve;
use linkwright::internals::judge::error::rms;
use linkwright::internals::judge::referee::judge;
use linkwright::internals::mechanism::Unit;
use linkwright::internals::mechanism::{AssemblyMode, CouplerSide, FourBar, NaturalCoordinates};
use linkwright::internals::record::*;
use linkwright::internals::task::spec::*;
use linkwright::internals::task::{AngleOffset, Task};

/// The 18 points of Kunjur and Krishnamurty (1997).
pub const K18: [[f64; 2]; 18] = [
    [0.5, 1.1],
    [0.4, 1.1],
    [0.3, 1.1],
    [0.2, 1.0],
    [0.1, 0.9],
    [0.05, 0.75],
    [0.02, 0.6],
    [0.0, 0.5],
    [0.0, 0.4],
    [0.03, 0.3],
    [0.1, 0.25],
    [0.15, 0.2],
    [0.2, 0.3],
    [0.3, 0.4],
    [0.4, 0.5],
    [0.5, 0.7],
    [0.6, 0.9],
    [0.6, 1.0],
];

pub fn linkage(a: [f64; 2], b: [f64; 2], lengths: [f64; 5], t1: i64, t2: i64) -> FourBar {
    FourBar::new(NaturalCoordinates {
        crank_pivot: a,
        follower_pivot: b,
        crank: lengths[0],
        coupler: lengths[1],
        follower: lengths[2],
        crank_side: lengths[3],
        follower_side: lengths[4],
        assembly: AssemblyMode::try_from(t1).unwrap(),
        side: CouplerSide::try_from(t2).unwrap(),
    })
    .unwrap()
}

/// The best known linkage for K18 (sum of squares 0.009028884631).
pub fn k18_optimum() -> FourBar {
    linkage(
        [0.5483085928380659, 0.7165120992749661],
        [1.2791366906661708, 0.45079620415323596],
        [
            0.31274881685597095,
            0.44190041062522994,
            0.6745635568571409,
            0.3569014735710573,
            0.5989168228431991,
        ],
        -1,
        -1,
    )
}

pub const K18_FIRST_ANGLE: f64 = 0.542832786236755;

pub fn candidate(
    rank: usize,
    linkage: FourBar,
    task: &Task,
    crank_angles: &[f64],
    t1: &[AssemblyMode],
) -> Candidate {
    let error = task.errors(linkage, crank_angles, t1, None).expect("closes at every point");
    let to_curve = distances_to_curve(task.points(), linkage, crank_angles[0], t1[0]).expect("has a curve");
    let verdict = judge(task, linkage, crank_angles, t1);
    let mobility = linkage.mobility();
    let (extremes, over) = if mobility.input_turns_fully() {
        (linkage.transmission_over_cycle(), TransmissionOver::Cycle)
    } else {
        (verdict.motion.transmission(), TransmissionOver::Used)
    };
    let accepted = verdict.defects.is_empty();
    Candidate {
        rank,
        linkage: linkage.into(),
        crank_deg: crank_angles.iter().map(|a| a.to_degrees()).collect(),
        t1_at: t1.to_vec().into(),
        frame_deg: error.angle.as_ref().map(|angle| angle.frame.to_degrees()),
        input_offset_deg: None,
        output_offset_deg: None,
        output_offset: None,
        input_range_deg: None,
        output_range_deg: None,
        sense: None,
        error: ErrorRecord {
            objective: error.objective,
            sum_sq: error.sum_sq,
            rms: rms(error.sum_sq, task.len()),
            max: error.max,
            max_at: error.max_at,
            rms_over_size: rms(error.sum_sq, task.len()) / task.size(),
            to_curve: CurveErrorRecord {
                sum_sq: to_curve.sum_sq,
                rms: rms(to_curve.sum_sq, task.len()),
                max: to_curve.max,
            },
            angle: error.angle.as_ref().map(|angle| AngleErrorRecord {
                rms_deg: angle.rms.to_degrees(),
                max_deg: angle.max.to_degrees(),
                max_at: angle.max_at,
            }),
            output: None,
            to_raw: None,
            two_sided: None,
        },
        linkage_type: Some(mobility.linkage_type.expect("can be joined")),
        grashof_margin: mobility.grashof_margin,
        transmission_deg: TransmissionRecord {
            min: extremes.min.to_degrees(),
            max: extremes.max.to_degrees(),
            worst: extremes.worst().to_degrees(),
            over,
        },
        link_ratio: linkage.link_ratio(),
        peak_torque: None,
        defects: verdict.defects,
        warnings: Vec::new(),
        alternatives: Vec::new(),
        requirements: vec![Requirement {
            name: "link_ratio_max".into(),
            value: Figure::Number(linkage.link_ratio()),
            limit: Figure::Number(20.0),
            met: true,
        }],
        accepted,
        certified: None,
        mirror_serves: false,
        costs: Vec::new(),
    }
}

pub fn record(name: &str, path: TaskSpec) -> Record {
    Record {
        format: FORMAT,
        tool: Tool { name: "linkwright".into(), version: "0.1.0".into() },
        problem: ProblemRecord {
            name: name.into(),
            source: None,
            unit: None,
            digest: "0".repeat(64),
            resolved: ProblemSpec {
                loads: None,
                task: path,
                design: DesignSpec::default(),
                require: RequireSpec::default(),
                solve: SolveSpec::default(),
            },
        },
        seed: 1,
        method: MethodRecord { asked: Method::Auto, used: vec!["variable-projection".into()] },
        termination: Termination { reason: Reason::Converged, reproducible: true },
        evaluations: Evaluations { objective: 12_345, positions: 222_210 },
        family: None,
        other_kind: None,
        of_kinds: Vec::new(),
        buildable: None,
        picks: None,
        front: None,
        candidates: Vec::new(),
        conflict: None,
        relaxations: Vec::new(),
        certificate: None,
        no_certificate: None,
        repeats: None,
        exact: None,
    }
}

pub fn path(points: &[[f64; 2]], closed: bool) -> TaskSpec {
    TaskSpec::path(points.to_vec(), closed)
}

/// K18 with its optimum and three worse answers, the last one refused.
pub fn k18() -> Record {
    let mut spec = path(&K18, true);
    let crank_deg: Vec<f64> = (0..18).map(|i| 20.0 * f64::from(i)).collect();
    spec.timing = Some(TimingSpec { crank_deg, offset: AngleOffset::Free, free: Vec::new() });
    let mut record = record("eighteen-point", spec);
    record.problem.source = Some("Kunjur & Krishnamurty, 1997".into());
    record.problem.unit = Some(Unit::M);
    let task = record.problem.resolved.task.to_task().unwrap();
    let best = k18_optimum();
    for (i, stretch) in [1.0, 1.03, 1.07, 1.12].into_iter().enumerate() {
        let mut parts = NaturalCoordinates::from(best);
        parts.crank *= 2.0 - stretch;
        parts.crank_side *= stretch;
        let angles: Vec<f64> = (0..18).map(|i| K18_FIRST_ANGLE + f64::from(20 * i).to_radians()).collect();
        let t1 = vec![AssemblyMode::Minus; 18];
        record.candidates.push(candidate(i + 1, FourBar::new(parts).unwrap(), &task, &angles, &t1));
    }
    let last = record.candidates.last_mut().unwrap();
    last.accepted = false;
    last.requirements.push(Requirement {
        name: "transmission_deg_min".into(),
        value: Figure::Number(last.transmission_deg.worst),
        limit: Figure::Number(45.0),
        met: false,
    });
    record
}

/// The ten-point ellipse: a linkage many times as large as its target, the last point the first again.
pub fn ellipse() -> Record {
    let best = linkage(
        [8.49444014241005, -0.7579575962945292],
        [-50.16775390870027, -55.152323013218705],
        [8.04568331202292, 50.81911017625806, 42.208049816053105, 10.880960120007188, 61.498984057032416],
        1,
        -1,
    );
    let mut angles = vec![
        0.055468113591,
        0.760003238553,
        1.443150150854,
        2.126206624522,
        2.810834246351,
        3.504569410119,
        4.205421576935,
        4.912770663027,
        5.628207526376,
    ];
    angles.push(angles[0] + std::f64::consts::TAU);
    let generated = |angle: &f64| best.position(*angle).joints().unwrap().coupler_point;
    // The target is the curve itself to two digits.
    let mut points: Vec<[f64; 2]> = angles
        .iter()
        .map(|a| [(generated(a).re * 100.0).round() / 100.0, (generated(a).im * 100.0).round() / 100.0])
        .collect();
    points[9] = points[0];
    let mut record = record("ten-point ellipse", path(&points, true));
    record.problem.unit = Some(Unit::Mm);
    let task = record.problem.resolved.task.to_task().unwrap();
    record.candidates.push(candidate(1, best, &task, &angles, &[AssemblyMode::Plus; 10]));
    record
}

/// Three points on a non-Grashof linkage whose motion passes a toggle.
pub fn rocking() -> Record {
    let rocker = linkage([0.0, 0.0], [40.0, 0.0], [30.0, 20.0, 25.0, 18.0, 22.0], 1, 1);
    let points = [[30.0, 30.0], [20.0, 38.0], [35.0, 10.0]];
    let mut record = record("rocking", path(&points, false));
    let task = record.problem.resolved.task.to_task().unwrap();
    let t1 = [AssemblyMode::Plus, AssemblyMode::Plus, AssemblyMode::Minus];
    record.candidates.push(candidate(1, rocker, &task, &[0.5, 0.9, 0.2], &t1));
    record
}

/// Two hundred points near the curve of a crank-rocker, and three linkages of different kinds.
pub fn shapes() -> Record {
    let rocker = linkage([10.0, 20.0], [90.0, 30.0], [25.0, 70.0, 55.0, 60.0, 65.0], 1, 1);
    let angles: Vec<f64> = (0..200).map(|i| 0.3 + f64::from(i) / 200.0 * std::f64::consts::TAU).collect();
    let points: Vec<[f64; 2]> = angles
        .iter()
        .map(|a| {
            let p = rocker.position(*a).joints().unwrap().coupler_point;
            [p.re + 1.5 * (5.0 * a).sin(), p.im + 1.5 * (3.0 * a).cos()]
        })
        .collect();
    let mut record = record("two hundred points", path(&points, true));
    record.problem.unit = Some(Unit::Mm);
    let task = record.problem.resolved.task.to_task().unwrap();
    let t1 = vec![AssemblyMode::Plus; 200];
    record.candidates.push(candidate(1, rocker, &task, &angles, &t1));
    let double = linkage([40.0, 60.0], [60.0, 70.0], [45.0, 50.0, 42.0, 30.0, 40.0], 1, 1);
    record.candidates.push(candidate(2, double, &task, &angles, &t1));
    record
}

/// Eight points on a short stretch of a large curve, off by a fiftieth.
pub fn detail() -> Record {
    let big = *ellipse().candidates[0].linkage.four_bar().expect("a four-bar");
    let angles: Vec<f64> = (0..8).map(|i| 1.2 + 0.06 * f64::from(i)).collect();
    let points: Vec<[f64; 2]> = angles
        .iter()
        .enumerate()
        .map(|(i, a)| {
            let p = big.position(*a).joints().unwrap().coupler_point;
            [p.re, p.im + [0.1, -0.1, 0.15][i % 3]]
        })
        .collect();
    let mut record = record("detail", path(&points, false));
    record.problem.unit = Some(Unit::In);
    let task = record.problem.resolved.task.to_task().unwrap();
    record.candidates.push(candidate(1, big, &task, &angles, &[AssemblyMode::Plus; 8]));
    record
}

/// The angles by which the body of [`motion`] is off at its poses, degrees; without one only the place counts.
pub const TURNED_DEG: [Option<f64>; 6] = [Some(0.4), Some(-0.3), None, Some(0.9), Some(-0.6), Some(-0.4)];
/// The angle from the direction C -> D to the body of [`motion`], degrees: the errors above have the mean 0.
pub const FRAME_DEG: f64 = 25.0;

/// A body that a crank-rocker takes through six poses, off by known lengths and angles, and the same by a wider crank.
pub fn motion() -> Record {
    let rocker = linkage([10.0, 20.0], [90.0, 30.0], [25.0, 70.0, 55.0, 60.0, 65.0], 1, 1);
    let angles: Vec<f64> = (0..6).map(|i| 0.3 + 0.9 * f64::from(i)).collect();
    let joints: Vec<_> = angles.iter().map(|a| rocker.position(*a).joints().unwrap()).collect();
    let places: Vec<[f64; 2]> = joints
        .iter()
        .zip(1..)
        .map(|(j, k)| [j.coupler_point.re, j.coupler_point.im + 0.1 * f64::from(k)])
        .collect();
    let angle_deg = joints
        .iter()
        .zip(TURNED_DEG)
        .map(|(j, off)| Some((j.follower_pin - j.crank_pin).arg().to_degrees() + FRAME_DEG + off?))
        .collect();
    let mut spec = path(&places, false);
    spec.body = Some(BodySpec { angle_deg, angle_weight: 50.0, tolerance_deg: None });
    let mut record = record("six poses", spec);
    record.problem.unit = Some(Unit::Mm);
    let task = record.problem.resolved.task.to_task().unwrap();
    let t1 = [AssemblyMode::Plus; 6];
    record.candidates.push(candidate(1, rocker, &task, &angles, &t1));
    let wider = linkage([10.0, 20.0], [90.0, 30.0], [26.0, 70.0, 55.0, 60.0, 65.0], 1, 1);
    record.candidates.push(candidate(2, wider, &task, &angles, &t1));
    record
}
