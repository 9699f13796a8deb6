//! Six-bars that draw a path: verdicts by an independent simulation, the same digits on any number of threads.

use crate::common::root;
use crate::common::thorough::cases;
use linkwright::internals::mechanism::chain::{Attachment, Stage};
use linkwright::internals::mechanism::{Chain, Complex, DyadChainKind, Mechanism};
use linkwright::internals::synthesis::dyad_chains::{
    DyadChainAnswer, DyadChainLimits, DyadChainOutcome, DyadChainState, DyadChainTiming, Request, Watch,
    search,
};
use linkwright::internals::task::AngleOffset;
use std::collections::HashMap;
use std::f64::consts::{PI, TAU};
use std::sync::Mutex;

/// Evaluations that suffice for the start of one island.
const ONE_ISLAND: u64 = 26_000;

fn shape(name: &str) -> Vec<Complex> {
    let file = root().join(format!("problems/literature/shapes/{name}.csv"));
    let text = std::fs::read_to_string(file).expect("it is there");
    let row = |line: &str| {
        let (x, y) = line.split_once(',').expect("two columns");
        Complex::new(x.parse().expect("a number"), y.parse().expect("a number"))
    };
    text.lines().filter(|line| line.starts_with(|c: char| c.is_ascii_digit() || c == '-')).map(row).collect()
}

fn extent(points: &[Complex]) -> (f64, f64) {
    let n = points.len() as f64;
    let centre = points.iter().sum::<Complex>() / n;
    let radius = (points.iter().map(|p| (p - centre).norm_sqr()).sum::<f64>() / n).sqrt();
    let range = |part: fn(&Complex) -> f64| {
        let values = || points.iter().map(part);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    (radius, range(|p| p.re).hypot(range(|p| p.im)))
}

fn limits(points: &[Complex]) -> DyadChainLimits {
    DyadChainLimits {
        transmission_min: 30_f64.to_radians(),
        longest_max: 3.0 * extent(points).1,
        link_ratio_max: 100.0,
        pivots_in: [None; 3],
        footprint_in: None,
        extent_max: f64::INFINITY,
    }
}

fn request<'a>(points: &'a [Complex], closed: bool, evaluations: u64) -> Request<'a> {
    Request {
        points,
        closed,
        timing: None,
        kinds: &DyadChainKind::SIX_BARS,
        counter_clockwise: false,
        limits: limits(points),
        seed: 1,
        evaluations,
        enough: 0.0,
        repeats: None,
        answers: 8,
    }
}

fn found(request: &Request<'_>) -> DyadChainOutcome {
    search(request, Watch::silent(), None).expect("a request that can be used")
}

/// The joints of a chain at a crank angle, by the angles of triangles from the lengths of its stages; `None` if a dyad does not
/// close. Nothing of the program's kinematics is used.
fn simulated(chain: &Chain, crank_angle: f64) -> Option<HashMap<String, (f64, f64)>> {
    let source = chain.source();
    let mut at: HashMap<String, (f64, f64)> =
        source.pivots.iter().map(|(name, [x, y])| (name.clone(), (*x, *y))).collect();
    let (x, y) = at[&source.crank_pivot];
    let joint = (x + source.crank * crank_angle.cos(), y + source.crank * crank_angle.sin());
    at.insert(source.crank_joint.clone(), joint);
    for stage in &source.stages {
        let (name, place) = match stage {
            Stage::Dyad { joint, from: [p, q], lengths: [r, s], side } => {
                let ((px, py), (qx, qy)) = (at[p], at[q]);
                let (dx, dy) = (qx - px, qy - py);
                let apart = dx.hypot(dy);
                // The angle at p of the triangle with the sides r, s and |pq|.
                let cosine = (r * r + apart * apart - s * s) / (2.0 * r * apart);
                if cosine.abs() > 1.0 {
                    return None;
                }
                let angle = dy.atan2(dx) + side.sign() * cosine.acos();
                (joint, (px + r * angle.cos(), py + r * angle.sin()))
            }
            Stage::Point { name, on: [p, q], at: Attachment::Offset([along, across]) } => {
                let ((px, py), (qx, qy)) = (at[p], at[q]);
                let angle = (qy - py).atan2(qx - px);
                let (cos, sin) = (angle.cos(), angle.sin());
                (name, (px + along * cos - across * sin, py + along * sin + across * cos))
            }
            _ => return None,
        };
        at.insert(name.clone(), place);
    }
    Some(at)
}

fn apart(a: (f64, f64), b: (f64, f64)) -> f64 {
    (a.0 - b.0).hypot(a.1 - b.1)
}

/// Checks every figure of an answer by the simulation of its chain.
fn check(answer: &DyadChainAnswer, request: &Request<'_>) {
    let chain = answer.chain.to_chain().expect("it is a chain");
    let ground = answer.chain.ground_angle();
    let (_, diagonal) = extent(request.points);
    // It closes all around, and its transmission angles are at least those that are stated.
    let mut least = f64::INFINITY;
    for i in 0..5000 {
        let at = simulated(&chain, TAU * f64::from(i) / 5000.0).expect("the crank turns fully");
        let dyads = [("C", "B", "D"), ("X2", "Y2", "F2"), ("X3", "Y3", "F3")];
        for (x, y, f) in dyads.into_iter().take(answer.chain.shape.kind.dyads()) {
            let (x, y, f) = (at[x], at[y], at[f]);
            let [a, b] = [x, y].map(|end| (end.1 - f.1).atan2(end.0 - f.0));
            let angle = (a - b).rem_euclid(PI);
            least = least.min(angle.min(PI - angle));
        }
    }
    assert!(answer.transmission <= least + 1e-9 && least - answer.transmission < 1e-3);
    // The general chain says so, too, and puts P where the simulation does.
    let analysed = Mechanism::crank_range(&chain);
    assert!(analysed.turns_fully);
    for phase in answer.phases.iter().step_by(7) {
        let pose = chain.pose_at(phase + ground);
        let p = pose.joints[Mechanism::traced(&chain)].expect("it closes");
        let expected = simulated(&chain, phase + ground).expect("it closes")["P"];
        assert!(apart((p.re, p.im), expected) < 1e-9 * diagonal);
    }
    // In order, within one turn.
    let steps: Vec<f64> = answer.phases.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(steps.iter().all(|step| *step >= 0.0) || steps.iter().all(|step| *step <= 0.0));
    assert!(steps.iter().sum::<f64>().abs() <= TAU + 1e-12);
    // The distances at the stated phases.
    let errors: Vec<f64> = (answer.phases.iter().zip(request.points))
        .map(|(phase, t)| apart(simulated(&chain, phase + ground).expect("it closes")["P"], (t.re, t.im)))
        .collect();
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len() as f64).sqrt();
    assert!((rms - answer.rms).abs() < 1e-9 * diagonal, "{rms} {}", answer.rms);
    assert!((errors.iter().copied().fold(0.0, f64::max) - answer.max).abs() < 1e-9 * diagonal);
    // Distances of the joints of each body, P only in the largest.
    let at = simulated(&chain, 0.3).expect("it closes");
    let (mut longest, mut range) = (0.0_f64, (f64::INFINITY, 0.0_f64));
    for link in chain.links() {
        let names: Vec<&String> = link.iter().map(|id| &chain.names()[id.index()]).collect();
        for (i, one) in names.iter().enumerate() {
            for other in &names[..i] {
                let distance = apart(at[*one], at[*other]);
                longest = longest.max(distance);
                if *one != "P" && *other != "P" {
                    range = (range.0.min(distance), range.1.max(distance));
                }
            }
        }
    }
    assert!((longest - answer.longest).abs() < 1e-9 * longest, "{longest} {}", answer.longest);
    let ratio = range.1 / range.0;
    assert!((ratio - answer.link_ratio).abs() < 1e-6 * ratio, "{ratio} {}", answer.link_ratio);
    let DyadChainLimits { transmission_min, longest_max, link_ratio_max, .. } = request.limits;
    let is_within = answer.transmission >= transmission_min
        && answer.longest <= longest_max
        && answer.link_ratio <= link_ratio_max;
    assert_eq!(answer.accepted, is_within);
}

#[test]
fn the_figures_of_answers_are_those_of_an_independent_simulation() {
    let eight_bars: Vec<DyadChainKind> = DyadChainKind::eight_bars().into_iter().step_by(9).collect();
    let mut checked = 0;
    for (name, closed, most, seeds) in [
        ("square", true, 0.06, 3),
        ("S", false, 0.01, 3),
        ("heart", true, 0.05, 3),
        ("figure-8", true, 0.05, 2),
        ("letter-D", true, 0.05, 2),
        ("L", true, 0.1, 2),
    ]
    .into_iter()
    .take(cases(2, 6))
    {
        let points = shape(name);
        let six = (1..=cases(1, seeds)).map(|seed| (&DyadChainKind::SIX_BARS[..], seed));
        for (kinds, seed) in six.chain([(&eight_bars[..], 1)]) {
            let request = Request { kinds, seed, ..request(&points, closed, ONE_ISLAND) };
            let found = found(&request);
            let best = &found.answers[0];
            assert!(best.accepted, "{name}");
            if seed == 1 && kinds.len() == DyadChainKind::SIX_BARS.len() {
                assert!(best.rms < most * extent(&points).0, "{name}: {}", best.rms / extent(&points).0);
            }
            for answer in found.answers.iter().chain(&found.best_of_kinds) {
                check(answer, &request);
                checked += 1;
            }
            let accepted = found.answers.iter().filter(|answer| answer.accepted).count();
            assert!(2 * accepted >= found.answers.len(), "{name}: {accepted}");
        }
    }
    assert!(checked >= cases(33, 200), "{checked}");
}

#[test]
fn a_search_has_the_same_digits_twice_and_on_any_number_of_threads() {
    let points = shape("square");
    let request = Request { seed: 3, ..request(&points, true, 20_000) };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| found(&request))
    };
    let first = on(1);
    assert!((10_000..=20_000).contains(&first.evaluations) && first.ends > 0);
    for threads in [1, 2, 5] {
        assert_eq!(on(threads), first, "{threads} threads");
    }
}

#[test]
fn a_resumed_search_has_the_digits_of_one_that_was_not_interrupted() {
    let points = shape("S");
    // Four-bars: their islands end soon.
    let whole = Request { kinds: &[DyadChainKind::FOUR_BAR], ..request(&points, false, 100_000) };
    let states = Mutex::new(Vec::new());
    let keeper = |state: &DyadChainState| states.lock().expect("no thread panics").push(state.clone());
    let uninterrupted = search(&whole, Watch { keeper: &keeper, ..Watch::silent() }, None);
    let states = states.into_inner().expect("no thread panics");
    assert!(states.len() >= 2);
    let text = serde_json::to_string(&states[0]).expect("it is data");
    let state: DyadChainState = serde_json::from_str(&text).expect("it was written");
    assert_eq!(state, states[0]);
    assert_eq!(search(&whole, Watch::silent(), Some(&state)), uninterrupted);
}

#[test]
fn a_search_that_is_stopped_at_once_has_an_answer_within_the_limits_or_none() {
    let points = shape("heart");
    let request = request(&points, true, 1_000_000_000);
    let watch = Watch { stopped: &|| true, ..Watch::silent() };
    let found = search(&request, watch, None).expect("it can be used");
    for answer in &found.answers {
        check(answer, &request);
    }
    assert!(found.evaluations < 20_000);
}

#[test]
fn fixed_pivots_stay_in_their_box() {
    let points = shape("letter-D");
    let mut request = request(&points, true, ONE_ISLAND);
    request.limits.pivots_in = [Some([Complex::new(-1.0, -2.0), Complex::new(2.5, 0.0)]); 3];
    let found = found(&request);
    let best = &found.answers[0];
    assert!(best.accepted);
    for p in best.chain.pivots() {
        assert!((-1.0..=2.5).contains(&p.re) && (-2.0..=0.0).contains(&p.im), "{p}");
    }
}

#[test]
fn requests_that_cannot_be_used_have_no_outcome() {
    let points = shape("heart");
    let usable = request(&points, true, ONE_ISLAND);
    let with = |limits| Request { limits, ..usable };
    let limits = usable.limits;
    for refused in [
        Request { points: &points[..2], ..usable },
        Request { points: &[Complex::new(1.0, 1.0); 5], ..usable },
        Request { points: &[Complex::new(f64::NAN, 1.0); 5], ..usable },
        Request { kinds: &[], ..usable },
        with(DyadChainLimits { transmission_min: f64::NAN, ..limits }),
        with(DyadChainLimits { longest_max: 0.0, ..limits }),
        with(DyadChainLimits { link_ratio_max: 1.0, ..limits }),
    ] {
        assert!(search(&refused, Watch::silent(), None).is_none());
    }
}

/// The points of a chain at crank angles `offset + run angles[j]`, from where these count.
fn at_angles(answer: &DyadChainAnswer, angles: &[f64], (offset, run): (f64, f64)) -> Vec<Complex> {
    let (of, ground) = (answer.chain.proportions(), answer.chain.ground_angle());
    angles.iter().map(|angle| answer.chain.point(&of, offset + run * angle - ground)).collect()
}

#[test]
fn a_six_bar_comes_back_from_points_of_its_own_at_given_crank_angles() {
    let target = shape("letter-D");
    let drawn = found(&request(&target, true, ONE_ISLAND));
    let angles: Vec<f64> = (0..24).map(|i| TAU * f64::from(i) / 24.0).collect();
    let mut exact = 0;
    for (i, of) in drawn.answers.iter().take(cases(2, 4)).enumerate() {
        let ground = of.chain.ground_angle();
        for (offset, from) in
            [(AngleOffset::Free, 0.7), (AngleOffset::Fixed, 0.0), (AngleOffset::Ground, ground)]
        {
            // Every other one with the crank turning clockwise.
            let run = if i % 2 == 0 { 1.0 } else { -1.0 };
            let points = at_angles(of, &angles, (from, run));
            let written: Vec<f64> = angles.iter().map(|angle| run * angle).collect();
            let timing = DyadChainTiming { angles: &written, offset, runs: &[1.0] };
            let limits = DyadChainLimits { transmission_min: 0.5, ..limits(&target) };
            let asked = Request {
                timing: Some(timing),
                limits,
                answers: 2,
                enough: 1e-9,
                ..request(&points, true, 80_000)
            };
            let outcome = found(&asked);
            let best = &outcome.answers[0];
            assert!(best.accepted && best.rms < 0.05 * extent(&points).0, "{} {offset:?}", best.rms);
            // At the angles that were given, in the sense that was given.
            let own = best.chain.ground_angle();
            let base = match offset {
                AngleOffset::Free => best.phases[0] + own,
                AngleOffset::Fixed => 0.0,
                AngleOffset::Ground => own,
            };
            let there = at_angles(best, &written, (base, 1.0));
            let apart = there.iter().zip(&points).map(|(p, t)| (p - t).norm_sqr()).sum::<f64>();
            let rms = (apart / points.len() as f64).sqrt();
            assert!((rms - best.rms).abs() < 1e-9, "{rms} {} {offset:?}", best.rms);
            exact += usize::from(best.rms < 1e-6 * extent(&points).0);
        }
    }
    assert!(exact >= cases(4, 9), "{exact} of {} come back", 3 * cases(2, 4));
}
