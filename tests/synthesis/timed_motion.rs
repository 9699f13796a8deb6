//! Poses of a body at prescribed crank angles: derivatives, the reduced form, and what the search finds.

use crate::common::parse;
use crate::common::thorough::cases;
use crate::motion::{ALONE, TO_THE_END, assert_mostly_small, assert_true, is_as_good, problem, solved};
use crate::poses::{Taken, taken, wide};
use linkwright::internals::judge::assess::assess;
use linkwright::internals::judge::rank::is_exact;
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use linkwright::internals::numbers::optimise::compact_lm::CompactLeastSquares;
use linkwright::internals::numbers::optimise::levenberg_marquardt::{
    BlockLeastSquares, derivative_error, solve,
};
use linkwright::internals::synthesis::multistart::judged;
use linkwright::internals::task::Setting;
use linkwright::internals::task::forms::design_space::Shape;
use linkwright::internals::task::forms::fits::design_of;
use linkwright::internals::task::forms::projection::{Batch, ProjectedFit, Projection};
use linkwright::internals::task::forms::start::{AS_WRITTEN, Start};
use linkwright::internals::task::forms::timed::TimedMotionFit;
use linkwright::internals::task::similarity::{Numbering, Similarity};
use linkwright::{AssemblyMode, Complex, Problem};

const OFFSETS: [&str; 3] = ["free", "ground", "fixed"];

/// The table of the crank angles at which a linkage takes its body through the poses.
fn timing(taken: &Taken, offset: &str) -> String {
    let base = match offset {
        "ground" => taken.linkage.ground_angle(),
        "fixed" => 0.0,
        _ => 0.3,
    };
    let deg: Vec<f64> = taken.positions.iter().map(|(angle, _)| (angle - base).to_degrees()).collect();
    format!("[task.motion.timing]\ncrank_deg = {deg:?}\noffset = \"{offset}\"\n")
}

/// The setting and the design of the linkage that the poses were taken from.
fn truth(problem: &Problem, taken: &Taken, offset: &str) -> (Setting, [f64; 10]) {
    let side = taken.linkage.side();
    let setting = Setting { aim: None, assembly: taken.positions[0].1, direction: 1.0, side };
    let offset = if offset == "free" { 0.3 } else { 0.0 };
    (setting, problem.space(side).design(&Shape::from(&taken.linkage), offset))
}

/// The objective that a fit from the truth reaches; infinite if its end is not accepted.
fn from_the_truth(problem: &Problem, taken: &Taken, offset: &str) -> f64 {
    let (setting, design) = truth(problem, taken, offset);
    let fit = TimedMotionFit::new(problem, setting).expect("the timing is prescribed");
    let end = solve(&fit, fit.unknowns(&design, AS_WRITTEN), Vec::new(), &TO_THE_END, &|| false);
    let start = Start { design: design_of(&end.x), setting, positions: Vec::new(), scales: AS_WRITTEN };
    let candidate = judged(problem, &start).filter(|candidate| candidate.accepted);
    candidate.map_or(f64::INFINITY, |candidate| candidate.error.objective)
}

/// A problem of a random linkage's poses, with bounds that hold it.
fn drawn(taken: &Taken, offset: &str, lines: &str) -> linkwright::spec::ProblemSpec {
    let far = 12.0 * taken.linkage.longest_link().max(taken.linkage.crank_side());
    let bounds = wide(taken.poses[0].0, far);
    problem(&taken.poses, &(timing(taken, offset) + &bounds + "[require]\nlink_ratio_max = 200\n" + lines))
}

#[test]
fn timed_poses_of_random_linkages_are_met_and_noisy_ones_fitted_as_well_as_from_the_truth() {
    let draws = &mut stream(81, 0);
    let (cases, mut worse) = (60, Vec::new());
    for case in 0..cases {
        let noise = [0.0, 0.005, 0.02][case / 3 % 3];
        let offset = OFFSETS[case % 3];
        let taken = taken(draws, [6, 8, 12, 30][case % 4], noise);
        let spec = drawn(&taken, offset, ALONE);
        let record = solved(spec.clone());
        assert_true(&record);
        let best = &record.candidates[0];
        let checked = Problem::new(spec.clone()).expect("a problem");
        // The crank stands where it was asked to.
        let asked = &spec.task.timing.as_ref().expect("timing").crank_deg;
        let turned = |deg: &[f64]| deg.iter().map(|d| d - deg[0]).collect::<Vec<f64>>();
        let (has, wants) = (turned(&best.crank_deg), turned(asked));
        let off = |by: f64| has.iter().zip(&wants).map(|(h, w)| (h - by * w).abs()).fold(0.0, f64::max);
        let senses: &[f64] = if offset == "free" { &[1.0, -1.0] } else { &[1.0] };
        assert!(senses.iter().any(|by| off(*by) < 1e-9), "{has:?} {wants:?}");
        if offset == "fixed" {
            assert!((best.crank_deg[0] - asked[0]).abs() < 1e-9);
        }
        let truth = from_the_truth(&checked, &taken, offset);
        if !is_as_good(&record, truth) {
            worse.push((case, best.error.objective, truth));
        }
    }
    assert!(worse.len() * 30 <= cases, "{worse:?}");
}

#[test]
fn derivatives_of_a_timed_motion_agree_with_central_differences() {
    let draws = &mut stream(82, 0);
    for offset in OFFSETS {
        let mut errors = Vec::new();
        for _ in 0..30 {
            let taken = taken(draws, 7, 0.02);
            // Slanted lines through its own pivots.
            let [a, b] = [taken.linkage.crank_pivot(), taken.linkage.follower_pivot()];
            let line = |p: Complex, x: f64, y: f64| [[p.re, p.im], [p.re + x, p.im + y]];
            let lines = format!(
                "type = [\"crank-rocker\"]\ntransmission_deg_min = 30\npins_in = [[-2, -1], [3, -2], [1, 4]]\n\
                 pivot_on = {{ A = {:?}, B = {:?} }}\n",
                line(a, 3.0, 1.0),
                line(b, -1.0, 2.0)
            );
            let problem = Problem::new(drawn(&taken, offset, &lines)).expect("a problem");
            let (setting, design) = truth(&problem, &taken, offset);
            let fit = TimedMotionFit::new(&problem, setting).expect("the timing is prescribed");
            let mut x = fit.unknowns(&design, AS_WRITTEN);
            x[10] += 0.1;
            let size = problem.task().size();
            let mut steps = [1e-5 * size; 11];
            (steps[9], steps[10]) = (if offset == "free" { 1e-5 } else { 0.0 }, 1e-5);
            let error = derivative_error(&fit, &x, &Vec::new(), &steps, 1e-5);
            errors.extend(error.map(|error| error / (1.0 + size)));
        }
        assert_mostly_small(errors);
    }
}

#[test]
fn the_reduced_form_of_a_motion_has_the_cost_of_its_linkage_and_the_gradient_of_that_cost() {
    let draws = &mut stream(83, 0);
    let mut checked = [0; 3];
    for case in 0..90 {
        let offset = OFFSETS[case % 3];
        let taken = taken(draws, 8, 0.01);
        let mut spec = drawn(&taken, offset, ALONE);
        if case % 2 == 1 {
            // A place among the poses.
            spec.task.body.as_mut().expect("a motion").angle_deg[3] = None;
        }
        let problem = Problem::new(spec).expect("a problem");
        let form = Projection::new(&problem, 1.0).expect("it has a reduced form");
        let (setting, _) = truth(&problem, &taken, offset);
        let turn = if offset == "free" { 0.3 } else { 0.0 };
        let mut x = form.at(&Shape::from(&taken.linkage), turn);
        for value in &mut x {
            *value += uniform(draws, -0.01, 0.01) * if *value == 0.0 { 0.0 } else { 1.0 };
        }
        let mut fit = ProjectedFit::new(&form, setting.assembly);
        let Some(solution) = fit.solution(&x) else { continue };
        // The cost is that of the linkage, by another form.
        let side = linkwright::CouplerSide::of(solution.shape.offset.im);
        let space = problem.space(side);
        let timed =
            TimedMotionFit::new(&problem, Setting { side, ..setting }).expect("the timing is prescribed");
        let there = timed.unknowns(&space.design(&solution.shape, solution.offset), AS_WRITTEN);
        let Some(cost) = timed.cost(&there, &Vec::new()) else { continue };
        let size = problem.task().size();
        assert!(
            (cost - solution.cost).abs() <= 1e-9 * (cost + 1e-6 * size * size),
            "{cost} {}",
            solution.cost
        );
        // The screening takes chords for angles: close where errors are small.
        let screened = form.screen_one(&x, setting.assembly);
        assert!((screened - cost).abs() <= 0.05 * cost + 1e-9 * size * size, "{screened} {cost}");
        let [plus, minus] = form.screen_unless(&Batch::new(vec![x]), &|| false).expect("it was not stopped");
        let of = if setting.assembly == AssemblyMode::Plus { plus } else { minus };
        assert_eq!(of[0].to_bits(), screened.to_bits());
        // J^T r is half the gradient.
        fit.cost(&x).expect("a cost");
        let gradient = fit.normal().gradient;
        for i in 0..4 {
            if form.bounds()[i].0 == form.bounds()[i].1 {
                continue;
            }
            let mut at = |by: f64| {
                let mut moved = x;
                moved[i] += by;
                fit.cost(&moved)
            };
            let step = 1e-6;
            let (Some(up), Some(down)) = (at(step), at(-step)) else { continue };
            let difference = (up - down) / (2.0 * step);
            let scale = difference.abs() + 1e-3 * size * size;
            assert!(
                (2.0 * gradient[i] - difference).abs() <= 1e-4 * scale,
                "{offset} {i}: {} {difference}",
                2.0 * gradient[i]
            );
        }
        checked[case % 3] += 1;
    }
    assert!(checked.iter().all(|n| *n >= 20), "{checked:?}");
}

#[test]
fn timed_poses_and_places_are_fitted_together() {
    let draws = &mut stream(84, 0);
    let mut as_good = 0;
    for case in 0..12 {
        let taken = taken(draws, 12, [0.0, 0.005][case % 2]);
        let mut spec = drawn(&taken, OFFSETS[case % 3], ALONE);
        let angles = &mut spec.task.body.as_mut().expect("a motion").angle_deg;
        (0..12).filter(|j| j % 3 != 0).for_each(|j| angles[j] = None);
        let record = solved(spec.clone());
        assert_true(&record);
        let checked = Problem::new(spec).expect("a problem");
        let truth = from_the_truth(&checked, &taken, OFFSETS[case % 3]);
        as_good += usize::from(is_as_good(&record, truth));
    }
    assert!(as_good >= 11, "{as_good}");
}

#[test]
fn tolerances_and_the_largest_deviation_count_for_timed_poses() {
    let draws = &mut stream(85, 0);
    for case in 0..cases(2, 6) {
        let taken = taken(draws, 10, 0.01);
        let spec = drawn(&taken, OFFSETS[case % 3], ALONE);
        let squares = solved(spec.clone());
        let least = &squares.candidates[0].error;
        let weight = spec.task.body.as_ref().expect("a motion").angle_weight;
        let deviation = |error: &linkwright::internals::record::ErrorRecord| {
            error.max.max(weight * error.angle.expect("a motion").max_deg.to_radians())
        };
        let mut largest = spec.clone();
        largest.solve.objective = linkwright::spec::Objective::MaxDeviation;
        let record = solved(largest);
        let best = &record.candidates[0];
        assert!(best.accepted);
        assert!((deviation(&best.error) - best.error.objective).abs() <= 1e-9 * best.error.objective);
        assert!(best.error.objective <= deviation(least) * (1.0 + 1e-9), "{case}");
        // Tolerances between the two can be met, and the sum of squares pays for it.
        let between = 0.5 * (best.error.objective + deviation(least));
        let mut within = spec;
        within.task.tolerance = Some(vec![between; 10]);
        within.task.body.as_mut().expect("a motion").tolerance_deg =
            Some(vec![(between / weight).to_degrees(); 10]);
        let record = solved(within);
        let met = &record.candidates[0];
        assert!(met.accepted, "{case}");
        assert!(deviation(&met.error) <= between * (1.0 + 1e-6), "{case}");
        assert!(met.error.objective >= least.objective * (1.0 - 1e-9), "{case}");
    }
}

#[test]
fn a_timed_motion_in_another_place_and_size_has_the_same_answer() {
    let draws = &mut stream(86, 0);
    for case in 0..6 {
        let taken = taken(draws, 9, 0.01);
        let offset = OFFSETS[case % 2];
        let spec = problem(&taken.poses, &(timing(&taken, offset) + ALONE));
        let record = solved(spec.clone());
        let Some(best) = record.candidates.first() else { continue };
        // A mirror image turns the other way, which given angles from the ground line do not allow.
        for (mirrors, turns) in [(false, 1), (case % 2 == 0, 2), (false, 3)] {
            let by = Similarity { from: [1.0, 2.0], mirrors, turns, scale: 3.7, to: [-20.0, 7.0] };
            let image = solved(spec.placed(&by).renumbered(Numbering { first: 0, reversed: false }));
            let there = &image.candidates[0];
            let (one, other) = (best.error.objective * 3.7 * 3.7, there.error.objective);
            assert!((one - other).abs() <= 1e-6 * one.max(1e-18), "case {case}: {one} {other}");
            assert_eq!(best.linkage_type, there.linkage_type, "case {case}");
        }
    }
}

#[test]
fn the_crank_angles_of_poses_come_from_a_table_or_a_column() {
    let text = "format = 1\n[task.motion]\nposes = [[0, 0, 0], [1, 2, 10], [3, 2, 25]]\n[task.motion.timing]\ncrank_deg = \
                [0, 30, 70]\noffset = \"ground\"\n";
    let spec = parse(text).spec;
    let read = spec.task.timing.as_ref().expect("timing");
    assert_eq!(read.crank_deg, [0.0, 30.0, 70.0]);
    let written = serde_json::to_string(&spec.task).expect("JSON");
    assert!(written.contains(r#""timing":{"crank_deg":[0.0,30.0,70.0],"offset":"ground"}"#), "{written}");
    assert_eq!(serde_json::from_str::<linkwright::spec::TaskSpec>(&written).expect("a task"), spec.task);
}

#[test]
fn the_pins_of_a_body_lie_in_their_region() {
    let draws = &mut stream(87, 0);
    let (mut met, mut moved) = (0, 0);
    for case in 0..cases(4, 16) {
        let taken = taken(draws, 7, 0.005);
        let size = taken.poses.iter().map(|(p, _)| (p - taken.poses[0].0).norm()).fold(0.0, f64::max);
        let (x, y) = (0.9 * size, 0.7 * size);
        let region = match case % 2 {
            0 => format!("[{}, {}, {x}, {y}]", -x, -y),
            _ => format!("[[{x}, {y}], [{}, {y}], [{}, {}], [{x}, {}]]", -x, -x, -y, -y),
        };
        let timing = if case % 4 < 2 { String::new() } else { timing(&taken, OFFSETS[case % 3]) };
        let bounds = wide(taken.poses[0].0, 12.0 * taken.linkage.longest_link());
        let free = problem(&taken.poses, &format!("{timing}{bounds}{ALONE}"));
        let held = problem(&taken.poses, &format!("{timing}{bounds}[require]\npins_in = {region}\n{ALONE}"));
        let (free, held) = (solved(free), solved(held));
        assert_true(&held);
        // C and D by their distances, in the body's own directions at the first pose.
        let pins = |candidate: &linkwright::Candidate| {
            let l = candidate.linkage.four_bar().expect("a four-bar");
            let joints = l
                .position_with(candidate.crank_deg[0].to_radians(), candidate.t1_at[0])
                .joints()
                .expect("it closes");
            let axis = (joints.follower_pin - joints.crank_pin).arg()
                + candidate.frame_deg.expect("a frame").to_radians();
            [joints.crank_pin, joints.follower_pin].map(|pin| {
                let off = pin - joints.coupler_point;
                (off.re * axis.cos() + off.im * axis.sin(), off.im * axis.cos() - off.re * axis.sin())
            })
        };
        let inside = |(u, v): (f64, f64)| u.abs() <= x * (1.0 + 1e-6) && v.abs() <= y * (1.0 + 1e-6);
        if let Some(best) = held.candidates.first().filter(|best| best.accepted) {
            met += 1;
            assert!(pins(best).into_iter().all(inside), "{case}: {:?}", pins(best));
            let least = free.candidates[0].error.objective;
            assert!(best.error.objective >= least * (1.0 - 1e-6), "{case}");
            moved += usize::from(!pins(&free.candidates[0]).into_iter().all(inside));
        }
        // What lies outside is not accepted.
        for other in held.candidates.iter().filter(|other| !pins(other).into_iter().all(inside)) {
            assert!(!other.accepted, "{case}");
        }
    }
    assert!(met >= cases(3, 12) && moved >= cases(1, 4), "{met} {moved}");
}

#[test]
fn places_that_are_met_do_not_make_a_motion_exact_whose_angles_are_missed() {
    let taken = taken(&mut stream(88, 0), 6, 0.0);
    let of = |poses: &[(linkwright::internals::mechanism::Complex, f64)]| {
        let problem = Problem::new(problem(poses, ALONE)).expect("a problem");
        let (angles, assemblies): (Vec<f64>, Vec<AssemblyMode>) =
            taken.positions.iter().map(|(angle, t)| (angle.to_degrees(), *t)).unzip();
        let candidate = assess(&problem, taken.linkage, &angles, &assemblies).expect("it closes");
        assert!(candidate.error.rms < 1e-12 * problem.task().size());
        is_exact(&problem, &candidate)
    };
    assert!(of(&taken.poses));
    let mut turned = taken.poses.clone();
    turned[2].1 += 0.1;
    assert!(!of(&turned));
}
