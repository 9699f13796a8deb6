//! Poses of a body: what the search finds, and that every figure of a record is that of the linkage.

use crate::common::parse;
use crate::common::thorough::cases;
use crate::poses::{Taken, taken, text, wide};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::{Complex, cross};
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use linkwright::internals::numbers::optimise::levenberg_marquardt::{
    BlockLeastSquares, LmOptions, derivative_error, solve,
};
use linkwright::internals::report::pose_curves::pose_curves_svg;
use linkwright::internals::synthesis::multistart::judged;
use linkwright::internals::synthesis::pose_curves::pose_curves;
use linkwright::internals::task::Setting;
use linkwright::internals::task::forms::design_space::Shape;
use linkwright::internals::task::forms::start::{AS_WRITTEN, Start};
use linkwright::internals::task::forms::torus::{MotionFit, Positions};
use linkwright::internals::task::similarity::{Numbering, Similarity};
use linkwright::spec::ProblemSpec;
use linkwright::{Candidate, Context, CouplerSide, Job, Problem, Record, run};
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

pub(crate) fn solved(spec: ProblemSpec) -> Record {
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    run(&Job::new("motion", spec), &context).expect("a run").record
}

pub(crate) fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// The problem of these poses.
pub(crate) fn problem(poses: &[(Complex, f64)], lines: &str) -> ProblemSpec {
    parse(&text(poses, lines)).spec
}

pub(crate) const ALONE: &str = "[solve]\ncandidates = 1\nadvice = false\n";

/// The errors of a candidate by circles that meet, without any of the library's kinematics.
fn recomputed(candidate: &Candidate, spec: &ProblemSpec) -> (f64, f64, f64) {
    let l = candidate.linkage.four_bar().expect("a four-bar");
    let (a, b) = (l.crank_pivot(), l.follower_pivot());
    let frame = candidate.frame_deg.expect("a motion has a frame").to_radians();
    let body = spec.task.body.as_ref().expect("a motion");
    let (mut places, mut angles, mut count) = (0.0, 0.0, 0);
    for (j, target) in spec.task.points.iter().enumerate() {
        let phi = candidate.crank_deg[j].to_radians();
        let c = a + Complex::new(l.crank() * phi.cos(), l.crank() * phi.sin());
        // D by the law of cosines at C.
        let to_b = b - c;
        let (s, q, r) = (to_b.norm(), l.coupler(), l.follower());
        let at_c = ((q * q + s * s - r * r) / (2.0 * q * s)).clamp(-1.0, 1.0).acos();
        let theta = to_b.arg() + candidate.t1_at[j].sign() * at_c;
        let (d, e) = (l.crank_side(), l.follower_side());
        let at_p = ((d * d + q * q - e * e) / (2.0 * d * q)).clamp(-1.0, 1.0).acos();
        let side = if l.side() == CouplerSide::Plus { 1.0 } else { -1.0 };
        let p = c + Complex::from_polar(d, theta + side * at_p);
        places += (p - Complex::new(target[0], target[1])).norm_sqr();
        if let Some(angle) = body.angle_deg[j] {
            angles += wrapped(angle.to_radians() - theta - frame).powi(2);
            count += 1;
        }
    }
    let objective = places + body.angle_weight.powi(2) * angles;
    (objective, (places / spec.task.points.len() as f64).sqrt(), (angles / f64::from(count)).sqrt())
}

/// Checks the figures of a record's candidates against [`recomputed`], and the record by `verify`.
pub(crate) fn assert_true(record: &Record) {
    let spec = &record.problem.resolved;
    let size = spec.task.to_task().expect("a task").size();
    for candidate in &record.candidates {
        let (objective, rms, angle_rms) = recomputed(candidate, spec);
        let error = &candidate.error;
        let near = |one: f64, other: f64, scale: f64| (one - other).abs() <= 1e-7 * scale + 1e-9 * one.abs();
        assert!(near(error.objective.sqrt(), objective.sqrt(), size), "{} {objective}", error.objective);
        assert!(near(error.rms, rms, size), "{} {rms}", error.rms);
        let of_angle = error.angle.expect("a motion");
        assert!(near(of_angle.rms_deg, angle_rms.to_degrees(), 57.3), "{} {angle_rms}", of_angle.rms_deg);
    }
    assert_eq!(verify(record).expect("a record"), []);
}

/// The options of a fit that goes on to the last digits.
pub(crate) const TO_THE_END: LmOptions = LmOptions {
    max_steps: 400,
    max_rounds: 14,
    max_evaluations: 4000,
    relative_reduction: 1e-13,
    exact_cost: 0.0,
    feasibility: 1e-9,
    hopeless_cost: f64::INFINITY,
};

/// Whether the best candidate is accepted and as good as an objective that another fit reached, or exact.
pub(crate) fn is_as_good(record: &Record, other: f64) -> bool {
    let size = record.problem.resolved.task.to_task().expect("a task").size();
    let best = &record.candidates[0];
    best.accepted && best.error.objective <= (other * (1.0 + 1e-6)).max((1e-9 * size).powi(2))
}

/// Checks that four fifths of the errors of derivatives are small: near a toggle a difference says nothing.
pub(crate) fn assert_mostly_small(mut errors: Vec<f64>) {
    errors.sort_by(f64::total_cmp);
    assert!(errors.len() >= 25, "{}", errors.len());
    assert!(errors[errors.len() * 4 / 5] < 1e-6, "{errors:?}");
}

/// The objective that a fit from the truth reaches, the linkage that the poses were taken from; infinite if its end is not
/// accepted.
fn from_the_truth(problem: &Problem, taken: &Taken) -> f64 {
    let shape = Shape::from(&taken.linkage);
    let position = |(angle, t): &(f64, linkwright::AssemblyMode)| {
        let joints = taken.linkage.position_with(*angle, *t).joints().expect("it closes");
        [Complex::from_polar(1.0, *angle), (joints.follower_pin - joints.crank_pin) / shape.coupler]
    };
    let positions = taken.positions.iter().map(position).collect();
    let side = taken.linkage.side();
    let setting = Setting { aim: None, assembly: taken.linkage.assembly(), direction: 1.0, side };
    let design = problem.space(side).design(&shape, taken.frame);
    let fit = MotionFit::new(problem, setting).in_order(&design, &positions);
    let end = solve(&fit, design, positions, &TO_THE_END, &|| false);
    let end = Start { design: end.x, setting, positions: end.state, scales: AS_WRITTEN };
    let candidate = judged(problem, &end).filter(|candidate| candidate.accepted);
    candidate.map_or(f64::INFINITY, |candidate| candidate.error.objective)
}

#[test]
fn poses_of_random_linkages_are_met_and_noisy_ones_fitted_as_well_as_from_the_truth() {
    let draws = &mut stream(71, 0);
    let (mut worse, mut refused) = (Vec::new(), 0);
    let cases = cases(12, 60);
    for case in 0..cases {
        let n = [6, 8, 12, 30][case % 4];
        let noise = [0.0, 0.005, 0.02][case % 3];
        let taken = taken(draws, n, noise);
        let far = 12.0 * taken.linkage.longest_link().max(taken.linkage.crank_side());
        let lines = wide(taken.poses[0].0, far) + "[require]\nlink_ratio_max = 200\n" + ALONE;
        let spec = problem(&taken.poses, &lines);
        let record = solved(spec.clone());
        assert_true(&record);
        let best = &record.candidates[0];
        let checked = Problem::new(spec).expect("a problem");
        let size = checked.task().size();
        let truth = from_the_truth(&checked, &taken);
        refused += usize::from(!best.accepted);
        if noise == 0.0 {
            if best.error.objective.sqrt() > 1e-9 * size {
                worse.push((case, best.error.objective.sqrt() / size));
            }
        } else if best.error.objective > truth * (1.0 + 1e-6) {
            worse.push((case, best.error.objective / truth));
        }
    }
    assert!(worse.len() * 50 <= cases, "{worse:?}");
    assert!(refused * 20 <= cases, "{refused}");
}

#[test]
fn derivatives_of_a_motion_agree_with_central_differences() {
    let draws = &mut stream(72, 0);
    let mut errors = Vec::new();
    for case in 0..40 {
        let taken = taken(draws, 7, 0.02);
        let pins = ["[-2, -1, 3, 2]", "[[-2, -1], [3, -2], [2, 3], [0, 1]]"][case % 2];
        let spec = problem(
            &taken.poses,
            &format!(
                "[require]\ntype = [\"crank-rocker\"]\ntransmission_deg_min = 30\nfootprint_in = [-90, -90, 90, 90]\n\
                 pins_in = {pins}\n"
            ),
        );
        let problem = Problem::new(spec).expect("a problem");
        let shape = Shape::from(&taken.linkage);
        let position = |(angle, t): &(f64, linkwright::AssemblyMode)| {
            let joints = taken.linkage.position_with(*angle, *t).joints().expect("it closes");
            [Complex::from_polar(1.0, *angle), (joints.follower_pin - joints.crank_pin) / shape.coupler]
        };
        let mut positions = taken.positions.iter().map(position).collect();
        let side = taken.linkage.side();
        let setting = Setting {
            aim: Some(linkwright::LinkageType::CrankRocker),
            assembly: taken.linkage.assembly(),
            direction: 1.0,
            side,
        };
        let fit = MotionFit::new(&problem, setting);
        let design = problem.space(side).design(&shape, taken.frame + 0.1);
        if !fit.settle(&design, &mut positions) {
            continue;
        }
        let fit = fit.on_its_branch(&design, &positions);
        let size = problem.task().size();
        let mut steps = [1e-5 * size; 10];
        steps[9] = 1e-5;
        for (step, (value, (low, high))) in steps.iter_mut().zip(design.iter().zip(fit.bounds())) {
            if value - low < 10.0 * *step || high - value < 10.0 * *step {
                *step = 0.0;
            }
        }
        let error = derivative_error(&fit, &design, &positions, &steps, 1e-5);
        errors.extend(error.map(|error| error / (1.0 + size)));
    }
    assert_mostly_small(errors);
}

#[test]
fn a_fit_on_its_branch_ends_on_it() {
    let draws = &mut stream(76, 0);
    let (mut ended, mut strayed) = (0, 0);
    for _ in 0..40 {
        let taken = taken(draws, 8, 0.05);
        let far = 12.0 * taken.linkage.longest_link().max(taken.linkage.crank_side());
        let problem = Problem::new(problem(&taken.poses, &wide(taken.poses[0].0, far))).expect("a problem");
        let shape = Shape::from(&taken.linkage);
        let position = |(angle, t): &(f64, linkwright::AssemblyMode)| {
            let joints = taken.linkage.position_with(*angle, *t).joints().expect("it closes");
            [Complex::from_polar(1.0, *angle), (joints.follower_pin - joints.crank_pin) / shape.coupler]
        };
        let positions: Positions = taken.positions.iter().map(position).collect();
        let side = taken.linkage.side();
        let setting = Setting { aim: None, assembly: taken.linkage.assembly(), direction: 1.0, side };
        let space = problem.space(side);
        let design = space.design(&shape, taken.frame);
        // The least distance of B from the line C D, on the side on which it was.
        let least_at = |design: &[f64; 10], positions: &Positions| {
            let shape = space.shape(design).expect("a shape");
            let to_pivot = |e: &Complex| shape.follower_pivot - shape.crank_pivot - e * shape.crank;
            let side = |[e, u]: &[Complex; 2]| taken.positions[0].1.sign() * cross(to_pivot(e), *u);
            positions.iter().map(side).fold(f64::INFINITY, f64::min)
        };
        let least = |fit: &MotionFit<'_>| {
            let end = solve(fit, design, positions.clone(), &TO_THE_END, &|| false);
            (end.violation < 1e-6 * problem.task().size()).then(|| least_at(&end.x, &end.state))
        };
        let free = MotionFit::new(&problem, setting);
        let held = free.clone().on_its_branch(&design, &positions);
        if let Some(least) = least(&held) {
            ended += 1;
            assert!(least > -1e-6 * problem.task().size(), "{least}");
        }
        strayed += usize::from(least(&free).is_some_and(|least| least < -1e-3 * problem.task().size()));
    }
    assert!(ended >= 30, "{ended}");
    assert!(strayed >= 3, "without it {strayed} stray");
}

#[test]
fn a_motion_in_another_place_size_and_order_has_the_same_answer() {
    let draws = &mut stream(73, 0);
    for case in 0..cases(2, 8) {
        let taken = taken(draws, 9, 0.01);
        let wish = if case % 2 == 0 { "" } else { "[require]\npins_in = [-4, -3, 5, 2]\n" };
        let spec = problem(&taken.poses, &format!("{wish}[solve]\ncandidates = 3\nadvice = false\n"));
        let record = solved(spec.clone());
        let Some(best) = record.candidates.first() else { continue };
        for (mirrors, turns, reversed) in
            [(true, 1, true), (false, 2, false), (false, 3, true), (true, 0, false)]
                .into_iter()
                .take(cases(1, 4))
        {
            let by = Similarity {
                from: [1.0, 2.0],
                mirrors,
                turns,
                scale: 3.7,
                to: [uniform(draws, -50.0, 50.0), 7.0],
            };
            let numbering = Numbering { first: if reversed { 8 } else { 0 }, reversed };
            let image = solved(spec.placed(&by).renumbered(numbering));
            let there = &image.candidates[0];
            let same = |one: f64, other: f64| (one - other).abs() <= 1e-6 * one.abs().max(1e-18);
            assert!(
                same(best.error.objective * 3.7 * 3.7, there.error.objective),
                "case {case}: {} {}",
                best.error.objective * 3.7 * 3.7,
                there.error.objective
            );
            assert_eq!(best.linkage_type, there.linkage_type, "case {case}");
            assert_eq!(best.accepted, there.accepted, "case {case}");
        }
    }
}

#[test]
fn what_is_called_accepted_meets_every_requirement() {
    let draws = &mut stream(74, 0);
    for case in 0..cases(4, 24) {
        let taken = taken(draws, 6 + case % 5, 0.01);
        let at = taken.poses[0].0;
        let size = taken.poses.iter().map(|(p, _)| (p - at).norm()).fold(0.0, f64::max);
        let wish = [
            "transmission_deg_min = 25\n".to_owned(),
            "link_ratio_max = 6\n".to_owned(),
            format!(
                "pivots_in = [{}, {}, {}, {}]\n",
                at.re - 2.0 * size,
                at.im - 2.0 * size,
                at.re + 2.0 * size,
                at.im + 2.0 * size
            ),
            "type = [\"crank-rocker\", \"double-rocker\", \"triple-rocker\"]\n".to_owned(),
        ];
        let record = solved(problem(&taken.poses, &format!("[require]\n{}{ALONE}", wish[case % 4])));
        assert_true(&record);
        for candidate in record.candidates.iter().filter(|candidate| candidate.accepted) {
            assert!(candidate.defects.is_empty());
            let links = candidate.linkage.four_bar().expect("a four-bar").links();
            let ratio =
                links.iter().copied().fold(0.0, f64::max) / links.iter().copied().fold(f64::MAX, f64::min);
            match case % 4 {
                0 => assert!(candidate.transmission_deg.worst >= 25.0 - 1e-5),
                1 => assert!(ratio <= 6.0 + 1e-5),
                2 => {
                    for pivot in [
                        candidate.linkage.four_bar().expect("a four-bar").crank_pivot(),
                        candidate.linkage.four_bar().expect("a four-bar").follower_pivot(),
                    ] {
                        let off = pivot - at;
                        assert!(off.re.abs().max(off.im.abs()) <= 2.0 * size * (1.0 + 1e-6));
                    }
                }
                _ => assert!(
                    ["crank-rocker", "double-rocker", "triple-rocker"].contains(&candidate.type_name())
                ),
            }
        }
    }
}

#[test]
fn a_search_for_poses_is_repeatable_on_any_number_of_threads() {
    let draws = &mut stream(75, 0);
    let taken = taken(draws, 12, 0.02);
    let spec = problem(&taken.poses, "[solve]\ncandidates = 4\n");
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        serde_json::to_string(&pool.install(|| solved(spec.clone()))).expect("JSON")
    };
    assert_eq!(on(1), on(2));
    assert_eq!(on(2), on(3));
}

#[test]
fn poses_and_places_are_fitted_together() {
    let draws = &mut stream(76, 0);
    let mut as_good = 0;
    for case in 0..20 {
        let taken = taken(draws, 13, [0.0, 0.005][case % 2]);
        let rows: Vec<String> = taken
            .poses
            .iter()
            .enumerate()
            .map(|(j, (p, angle))| match j % 3 {
                0 => format!("[{}, {}, {}]", p.re, p.im, angle.to_degrees()),
                _ => format!("[{}, {}]", p.re, p.im),
            })
            .collect();
        let far = 12.0 * taken.linkage.longest_link().max(taken.linkage.crank_side());
        let text = format!(
            "format = 1\n[task.motion]\nposes = [{}]\n{}[require]\nlink_ratio_max = 200\n{ALONE}",
            rows.join(", "),
            wide(taken.poses[0].0, far)
        );
        let spec = parse(&text).spec;
        let record = solved(spec.clone());
        assert_true(&record);
        let checked = Problem::new(spec).expect("a problem");
        let truth = from_the_truth(&checked, &taken);
        as_good += usize::from(is_as_good(&record, truth));
    }
    assert!(as_good >= 19, "{as_good}");
}

#[test]
fn few_poses_leave_a_family_whose_best_transmitting_member_comes_first() {
    let text = "format = 1\n[task.motion]\nposes = [[0, 0, 0], [10, 5, 20], [15, 15, 60]]\n[require]\npivots_in = \
                [-10, -15, 25, 20]\n";
    let record = solved(parse(&format!("{text}{ALONE}")).spec);
    assert_true(&record);
    let best = &record.candidates[0];
    assert!(best.accepted && best.error.rms < 1e-10);
    assert!(best.transmission_deg.worst > 60.0, "{}", best.transmission_deg.worst);
    assert!(record.family.is_some_and(|family| family.dimension > 0));
}

#[test]
fn every_motion_of_the_collection_comes_to_its_best_known_objective() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/motion");
    let mut known = 0;
    for entry in std::fs::read_dir(folder).expect("the folder") {
        let path = entry.expect("a file").path();
        let set = [("solve.candidates", "1"), ("solve.advice", "false")];
        let set: Vec<_> = set.map(|(key, value)| (key.to_owned(), value.to_owned())).to_vec();
        let problem = linkwright::load_problem(&path, &set).unwrap_or_else(|why| panic!("{why}"));
        let size = problem.spec.task.to_task().expect("a task").size();
        for seed in 1..=cases(1, 2) {
            let mut spec = problem.spec.clone();
            spec.solve.seed = seed;
            let record = solved(spec);
            assert_true(&record);
            let best = &record.candidates[0];
            assert!(best.accepted, "{}", path.display());
            let exact = (1e-9 * size).powi(2);
            match problem.expect.as_ref().and_then(|expect| expect.objective) {
                Some(objective) => assert!(
                    best.error.objective <= (objective * (1.0 + 1e-6)).max(exact),
                    "{}: {}",
                    path.display(),
                    best.error.objective
                ),
                None => assert!(best.error.objective <= exact, "{}", path.display()),
            }
        }
        known += 1;
    }
    assert!(known >= 12, "{known}");
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn exact_poses_are_met_and_the_others_approached() {
    let text = |lines: &str| {
        format!(
            "format = 1\n[task.motion]\nposes = [[600, 0, 0], [560, 170, 17], [542, 284, 27], [520, 381, 37], [433, 483, 50], \
             [380, 540, 62], [300, 580, 80]]\n{lines}\n{ALONE}"
        )
    };
    let of = |lines: &str| {
        let record = solved(parse(&text(lines)).spec);
        assert_true(&record);
        record.candidates[0].clone()
    };
    let (near, exact) = (of(""), of("exact = [0, 6]"));
    // Both ends met exactly cost no more than a part of the error.
    assert!(exact.accepted && exact.error.objective <= 1.2 * near.error.objective);
    let problem = Problem::new(parse(&text("exact = [0, 6]")).spec).expect("a problem");
    let errors = linkwright::internals::judge::error::structural_error(&problem, &exact).expect("it closes");
    let angle = errors.angle.expect("a motion");
    for j in [0, 6] {
        assert!(errors.structural[j].norm() < 1e-6, "{}", errors.structural[j]);
        assert!(angle.structural[j].expect("a pose").abs() < 1e-8);
    }
    // The five others are not all met.
    assert!(errors.structural.iter().any(|error| error.norm() > 1.0));
    // A body that only turns has no size of its own.
    let text = format!(
        "format = 1\n[task.motion]\nposes = [[1, 2, 0], [1, 2, 20], [1, 2, 50]]\nangle_weight = 3\nexact = [0]\n{ALONE}"
    );
    assert_eq!(parse(&text).spec.task.tolerance, Some(vec![0.0, 300.0, 300.0]));
    // A looser ask for one pose alone is at least as near to the others.
    let (one, both) = (of("exact = [0]").error.objective, exact.error.objective);
    assert!(one <= both * 1.01, "{one} {both}");
}

#[test]
fn four_poses_have_curves_of_pins_and_pivots_and_five_have_none() {
    let poses = ["[0, 0, 0]", "[10, 12, 12]", "[22, 20, 31]", "[38, 22, 49]", "[55, 18, 66]"];
    let of = |n: usize| {
        solved(
            parse(&format!("format = 1\n[task.motion]\nposes = [{}]\n{ALONE}", poses[..n].join(", "))).spec,
        )
    };
    let record = of(4);
    let problem = Problem::new(record.problem.resolved.clone()).expect("a problem");
    let places = pose_curves(&problem, 60).expect("curves").concat();
    let best = places.iter().filter_map(|place| place.transmission_deg).fold(0.0, f64::max);
    let found = record.candidates[0].transmission_deg.worst;
    // The marks are of samples: the search climbs on from there.
    assert!(best > 0.8 * found && best <= 90.0, "{best} {found}");
    // A dyad of the answer lies on the curve.
    let pivot = record.candidates[0].linkage.crank_pivot();
    let near = places.iter().map(|place| (place.pivot - pivot).norm()).fold(f64::INFINITY, f64::min);
    assert!(near < 0.1 * 55.0_f64.max(pivot.norm()), "{near}");
    let svg = pose_curves_svg(&record).expect("a drawing");
    assert!(svg.contains("centre points") && svg.contains("circle points"));
    assert_eq!(pose_curves_svg(&of(5)), None);
}
