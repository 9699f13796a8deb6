//! Are slider-cranks and inverted slider-cranks found again from points of their curves, and the right kind among several?
//!
//! ```text
//! cargo bench --bench sliders                  every class, 200 curves each; 40 of mixed kinds
//! cargo bench --bench sliders -- closed 20     classes whose name contains the word, 20 curves
//!     --seed N        of the curves (1)
//!     --show          every curve that was missed
//!     --only N        the curve with that number alone
//! ```
//!
//! | class | targets |
//! |---|---|
//! | closed-60 | 60 points of the whole curve of a crank that turns fully |
//! | open-30 | 30 points over 90 to 300 degrees of such a crank |
//! | timed-18 | 18 points over a whole turn, with their crank angles |
//! | poses-8 | 8 poses of the coupler over 90 to 300 degrees of such a crank |
//! | timed-poses-8 | such poses with their crank angles |
//! | places-12 | 12 places of the slider, or of the block along the rod, at crank angles over 90 to 300 degrees |
//! | angles-12 | 12 angles of the block of an inverted slider-crank, likewise |
//! | mixed | half by four-bars and half by sliders, all three kinds searched for; closed, 60 points |
//!
//! Linkages are drawn whose lengths, pivots and rail lie within the default bounds of their target. *Recovered* is an
//! accepted first candidate with rms/size below 1e-9 (of poses also in radians; of angles and places over their range; in the
//! mixed class: of the kind that drew the target). One thread, one
//! answer asked for, `longest_max = "any"`. Times are those of the search.

#![expect(clippy::print_stdout, reason = "the table is what this program is for")]

use linkwright::Problem;
use linkwright::internals::app::job::run::{Context, Job, run};
use linkwright::internals::files::problem_file::parse;
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CrankLinkage, FourBar, InvertedSliderCrank, LinkageKind, LoopJoints, SliderCrank,
    bounding_box, xy,
};
use linkwright::internals::numbers::arithmetic::streams::{Stream, below, stream, uniform};
use linkwright::internals::record::Candidate;
use linkwright::internals::record::statistics::median;
use linkwright::internals::task::AngleOffset;
use linkwright::internals::task::spec::{DesignSpec, ProblemSpec, SolveSpec};
use std::f64::consts::{PI, TAU};
use std::sync::atomic::AtomicBool;

/// rms over size below which a curve counts as recovered.
const RECOVERED: f64 = 1e-9;
/// The default reach of pivots, links and rails, in sizes.
const REACH: f64 = 5.0;
/// The default least length, and the greatest ratio of links.
const SHORTEST: f64 = 0.02;
const RATIO: f64 = 20.0;

#[derive(Clone, Copy, PartialEq)]
enum Points {
    Closed,
    Open,
    Timed,
    Poses,
    TimedPoses,
    Places,
    Angles,
}

impl Points {
    const ALL: [(&str, Points); 7] = [
        ("closed-60", Points::Closed),
        ("open-30", Points::Open),
        ("timed-18", Points::Timed),
        ("poses-8", Points::Poses),
        ("timed-poses-8", Points::TimedPoses),
        ("places-12", Points::Places),
        ("angles-12", Points::Angles),
    ];

    fn is_timed(self) -> bool {
        matches!(self, Points::Timed | Points::TimedPoses)
    }

    fn is_function(self) -> bool {
        matches!(self, Points::Places | Points::Angles)
    }

    /// Returns whether a kind has such targets: the slider of a slider-crank does not turn.
    fn suits(self, kind: LinkageKind) -> bool {
        self != Points::Angles || kind != LinkageKind::SliderCrank
    }

    fn is_motion(self) -> bool {
        matches!(self, Points::Poses | Points::TimedPoses)
    }
}

/// A target holds points, the angles of the body there and those of the crank, in degrees, the outputs of a function, and the
/// linkage that made them.
struct Asked {
    linkage: CrankLinkage,
    points: Vec<Complex>,
    body_deg: Vec<f64>,
    crank_deg: Vec<f64>,
    outputs: Vec<f64>,
}

/// Draws a linkage of a kind whose crank turns fully, with joints within a few cranks of each other.
fn drawn(kind: LinkageKind, draws: &mut Stream) -> Option<CrankLinkage> {
    let turn = Complex::from_polar(1.0, uniform(draws, -PI, PI));
    let assembly = if below(draws, 2) == 0 { AssemblyMode::Plus } else { AssemblyMode::Minus };
    let place = |draws: &mut Stream, reach: f64| {
        Complex::new(uniform(draws, -reach, reach), uniform(draws, -reach, reach))
    };
    let (pivot, offset) = (place(draws, 2.0), place(draws, 4.0));
    let crank = uniform(draws, 0.3, 2.0);
    let linkage = match kind {
        LinkageKind::FourBar | LinkageKind::SixBar | LinkageKind::EightBar => {
            let ground = turn * uniform(draws, 1.0, 4.0);
            let (coupler, follower) = (uniform(draws, 1.0, 4.0), uniform(draws, 1.0, 4.0));
            let links = [crank, coupler, follower];
            CrankLinkage::FourBar(
                FourBar::with_coupler_offset([pivot, pivot + ground], links, offset, assembly).ok()?,
            )
        }
        LinkageKind::SliderCrank => {
            let coupler = uniform(draws, 1.0, 5.0);
            let line = (pivot + place(draws, 2.0), turn.arg());
            CrankLinkage::SliderCrank(
                SliderCrank::from_parts(pivot, [crank, coupler], line, offset, assembly).ok()?,
            )
        }
        LinkageKind::InvertedSliderCrank => {
            let block = pivot + turn * uniform(draws, 0.3, 5.0);
            let h = uniform(draws, -1.5, 1.5);
            CrankLinkage::InvertedSliderCrank(
                InvertedSliderCrank::from_parts([pivot, block], crank, h, offset, assembly).ok()?,
            )
        }
    };
    let mobility = linkage.mobility();
    let worst = linkage.transmission_over_cycle()?.worst().to_degrees();
    (mobility.input_turns_fully() && worst >= 5.0 && linkage.link_ratio() <= RATIO).then_some(linkage)
}

/// Returns whether a linkage lies within the default bounds of its target.
fn within_bounds(linkage: &CrankLinkage, points: &[Complex]) -> bool {
    let [low, high] = bounding_box(points.iter().copied());
    let (centre, size) = (0.5 * (low + high), (high - low).norm());
    let near = |p: Complex| (p - centre).re.abs() <= REACH * size && (p - centre).im.abs() <= REACH * size;
    let lengths: Vec<f64> =
        [Some(linkage.crank()), linkage.coupler(), linkage.ground()].into_iter().flatten().collect();
    let follower = linkage.four_bar().map_or(SHORTEST * size, FourBar::follower);
    let rail = linkage.slider_crank().map_or(0.0, |l| {
        let s = l.line_direction();
        ((centre - l.line_point()) * s.conj()).im.abs()
    });
    let z = linkage.coupler_offset();
    lengths.iter().chain([&follower]).all(|l| (SHORTEST * size..=REACH * size).contains(l))
        && linkage.pivots().all(near)
        && rail <= REACH * size
        && z.re.abs().max(z.im.abs()) <= REACH * size
}

/// Returns whether a linkage lies within the default bounds of the function that it generates.
fn generates_within_bounds(linkage: &CrankLinkage, of: Points, outputs: &[f64]) -> bool {
    let [low, high] = outputs.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], output| {
        [low.min(*output), high.max(*output)]
    });
    let ground = linkage.ground();
    let size = if of == Points::Places { high - low } else { ground.unwrap_or(1.0) };
    let lengths = [Some(linkage.crank()), linkage.coupler(), ground];
    let offset = match linkage {
        CrankLinkage::InvertedSliderCrank(l) => l.offset(),
        CrankLinkage::SliderCrank(l) => {
            ((l.line_point() - linkage.crank_pivot()) * l.line_direction().conj()).im
        }
        CrankLinkage::FourBar(_) | CrankLinkage::MultiLoop(_) => 0.0,
    };
    // Outputs are wrapped to half a turn.
    let turns = of == Points::Angles && outputs.windows(2).any(|w| (w[1] - w[0]).abs() > 180.0);
    !turns
        && lengths.into_iter().flatten().all(|l| (0.1 * size..=10.0 * size).contains(&l))
        && offset.abs() <= REACH * size
}

/// Draws a linkage and places of its coupler.
fn target(kind: LinkageKind, of: Points, draws: &mut Stream) -> Asked {
    loop {
        let Some(linkage) = drawn(kind, draws) else { continue };
        let from = uniform(draws, -PI, PI);
        let (n, span) = match of {
            Points::Closed => (60, TAU * 59.0 / 60.0),
            Points::Open => (30, uniform(draws, 0.5 * PI, 300.0_f64.to_radians())),
            Points::Timed => (18, TAU * 17.0 / 18.0),
            Points::Poses | Points::TimedPoses => (8, uniform(draws, 0.5 * PI, 300.0_f64.to_radians())),
            Points::Places | Points::Angles => (12, uniform(draws, 0.5 * PI, 300.0_f64.to_radians())),
        };
        let angles: Vec<f64> = (0..n).map(|j| from + span * f64::from(j) / f64::from(n - 1)).collect();
        let at = |angle: &f64| linkage.joints_with(*angle, linkage.assembly());
        let Some(places) = angles.iter().map(at).collect::<Option<Vec<_>>>() else { continue };
        let points: Vec<Complex> = places.iter().map(|at| at.joints.coupler_point).collect();
        let output = |at: &LoopJoints| match of {
            Points::Places => linkage.slider_place(at),
            Points::Angles => linkage.output_angle(at).map(f64::to_degrees),
            _ => None,
        };
        let outputs: Vec<f64> = places.iter().filter_map(output).collect();
        let is_within = match of.is_function() {
            true => generates_within_bounds(&linkage, of, &outputs),
            false => within_bounds(&linkage, &points),
        };
        if is_within {
            let frame = if of.is_motion() { uniform(draws, -PI, PI) } else { 0.0 };
            return Asked {
                linkage,
                points,
                body_deg: places.iter().map(|at| (at.coupler.arg() + frame).to_degrees()).collect(),
                crank_deg: angles.iter().map(|a| (a - from).to_degrees()).collect(),
                outputs: outputs.iter().map(|output| output - outputs[0]).collect(),
            };
        }
    }
}

/// Returns the problem of a path.
fn path(asked: &Asked, of: Points, mechanism: &[LinkageKind], seed: u64) -> ProblemSpec {
    let points: Vec<[f64; 2]> = asked.points.iter().copied().map(xy).collect();
    let design = DesignSpec { mechanism: mechanism.to_vec(), ..DesignSpec::default() };
    let mut builder = Problem::builder(points).closed(of == Points::Closed).any_longest().design(design);
    if of.is_timed() {
        builder = builder.timing(asked.crank_deg.clone(), AngleOffset::Free);
    }
    let solve = SolveSpec { candidates: 1, seed, ..SolveSpec::default() };
    builder.solve(solve).spec().expect("a problem")
}

/// Returns the problem of a motion.
fn motion(asked: &Asked, of: Points, mechanism: &[LinkageKind], seed: u64) -> ProblemSpec {
    let pose = |(point, deg): (&Complex, &f64)| format!("[{:?}, {:?}, {deg:?}]", point.re, point.im);
    let poses: Vec<String> = asked.points.iter().zip(&asked.body_deg).map(pose).collect();
    let timing = if of.is_timed() {
        format!("[task.motion.timing]\ncrank_deg = {:?}\n", asked.crank_deg)
    } else {
        String::new()
    };
    let kinds: Vec<&str> = mechanism.iter().map(|kind| kind.name()).collect();
    let text = format!(
        "format = 1\n[task.motion]\nposes = [{}]\n{timing}[design]\nmechanism = {kinds:?}\n[require]\nlongest_max = \"any\"\n\
         [solve]\nseed = {seed}\ncandidates = 1\nadvice = false\n",
        poses.join(", ")
    );
    parse("motion.toml", &text, None, &[]).unwrap_or_else(|why| panic!("{why}")).spec
}

/// Returns the problem of a function.
fn function(asked: &Asked, of: Points, mechanism: &[LinkageKind], seed: u64) -> ProblemSpec {
    let kinds: Vec<&str> = mechanism.iter().map(|kind| kind.name()).collect();
    let key = if of == Points::Places { "output" } else { "output_deg" };
    let text = format!(
        "format = 1\n[task.function]\ninput_deg = {:?}\n{key} = {:?}\n[design]\nmechanism = {kinds:?}\n[solve]\n\
         seed = {seed}\ncandidates = 1\nadvice = false\n",
        asked.crank_deg, asked.outputs
    );
    parse("function.toml", &text, None, &[]).unwrap_or_else(|why| panic!("{why}")).spec
}

/// Searches for a target, and returns the kind, the rms over the size (of poses with their angles) and the milliseconds of
/// the search.
fn search(
    asked: &Asked,
    of: Points,
    mechanism: &[LinkageKind],
    seed: u64,
) -> (Option<LinkageKind>, f64, f64) {
    let of_task = match (of.is_motion(), of.is_function()) {
        (true, _) => motion,
        (_, true) => function,
        _ => path,
    };
    let spec = of_task(asked, of, mechanism, seed);
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    let finished = run(&Job::new("sliders", spec), &context).expect("a search");
    let ms = 1e3 * finished.search_s;
    let best = finished.record.candidates.first().filter(|c| c.accepted);
    let error = |c: &Candidate| {
        c.error.rms_over_size.max(c.error.angle.as_ref().map_or(0.0, |angle| angle.rms_deg.to_radians()))
    };
    (best.map(|c| c.linkage.kind()), best.map_or(f64::INFINITY, error), ms)
}

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    let value = |name: &str| arguments.iter().position(|a| a == name).and_then(|i| arguments.get(i + 1));
    let seed: u64 = value("--seed").and_then(|s| s.parse().ok()).unwrap_or(1);
    let only: Option<usize> = value("--only").and_then(|n| n.parse().ok());
    let of_options = [value("--seed"), value("--only")];
    let cases = |count: usize| only.map_or(0..count, |n| n..n + 1);
    let show = arguments.iter().any(|a| a == "--show");
    let plain: Vec<&String> =
        arguments.iter().filter(|a| !a.starts_with("--") && !of_options.contains(&Some(a))).collect();
    let filter = plain.iter().find(|a| a.parse::<usize>().is_err()).map_or("", |a| a.as_str());
    let count: Option<usize> = plain.iter().find_map(|a| a.parse().ok());
    rayon::ThreadPoolBuilder::new().num_threads(1).build_global().expect("a pool");
    let sliders = [LinkageKind::SliderCrank, LinkageKind::InvertedSliderCrank];
    println!("{:<34} {:>10} {:>10} {:>10} {:>10}", "class", "recovered", "median ms", "90 %", "largest");
    let mut seen = 0;
    for (name, of) in Points::ALL {
        for kind in sliders {
            let class = format!("{name} {kind}");
            if class.contains(filter) && of.suits(kind) {
                seen += 1;
                let each = cases(count.unwrap_or(200)).map(|case| {
                    let mut draws = stream(seed, case as u64);
                    (kind, target(kind, of, &mut draws))
                });
                row(&class, each, of, &[kind], show);
            }
        }
    }
    if "mixed".contains(filter) {
        seen += 1;
        let kinds = [
            LinkageKind::FourBar,
            LinkageKind::SliderCrank,
            LinkageKind::FourBar,
            LinkageKind::InvertedSliderCrank,
        ];
        let each = |case: usize| {
            let kind = kinds[case % 4];
            (kind, target(kind, Points::Closed, &mut stream(seed, 1000 + case as u64)))
        };
        let mixed = || cases(count.unwrap_or(40));
        let alone = row("mixed, their own kind alone", mixed().map(each), Points::Closed, &[], show);
        let all = row("mixed, all kinds", mixed().map(each), Points::Closed, &LinkageKind::ALL, show);
        let ratios: Vec<f64> = all.iter().zip(&alone).map(|(all, alone)| all / alone).collect();
        println!(
            "  all kinds over the own kind, target by target: median {:.2}, largest {:.2}; in sum {:.2}",
            median(&ratios).unwrap_or(f64::NAN),
            ratios.iter().copied().fold(f64::NAN, f64::max),
            all.iter().sum::<f64>() / alone.iter().sum::<f64>()
        );
    }
    assert!(seen > 0, "no class has {filter} in its name");
}

/// Searches for each target, among `mechanism` or, if that is empty, among its own kind alone, prints a row, and returns the
/// milliseconds of each.
fn row(
    class: &str,
    each: impl Iterator<Item = (LinkageKind, Asked)>,
    of: Points,
    mechanism: &[LinkageKind],
    show: bool,
) -> Vec<f64> {
    let (mut recovered, mut all, mut times) = (0, 0, Vec::new());
    for (case, (kind, asked)) in each.enumerate() {
        let own = [kind];
        let (found, error, ms) = search(&asked, of, if mechanism.is_empty() { &own } else { mechanism }, 1);
        let is_it = error < RECOVERED && found == Some(kind);
        all += 1;
        recovered += usize::from(is_it);
        times.push(ms);
        if show && !is_it {
            println!("  {case}: {error:.2e} in {ms:.0} ms, {}", asked.linkage);
        }
    }
    let in_order = times.clone();
    times.sort_by(f64::total_cmp);
    let tenth = times.get(times.len() * 9 / 10).copied().unwrap_or(f64::NAN);
    println!(
        "{class:<34} {:>10} {:>10.1} {:>10.1} {:>10.1}",
        format!("{recovered}/{all}"),
        median(&times).unwrap_or(f64::NAN),
        tenth,
        times.last().copied().unwrap_or(f64::NAN)
    );
    in_order
}
