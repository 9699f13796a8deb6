//! Linkages with a slider: their curves are found again, their records verify, joints recomputed by other code, and what is
//! not searched for is said.

use crate::common::parse;
use crate::motion::solved;
use linkwright::internals::app::job::run::{Context, Job, run};
use linkwright::internals::files::generator::FileKind;
use linkwright::internals::files::linkage_file::{any_to_toml, parse_any};
use linkwright::internals::judge::assess::assess;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CrankLinkage, InvertedSliderCrank, LinkageKind, SliderCrank, dot, xy,
};
use linkwright::internals::record::{Candidate, Record};
use linkwright::internals::report::html::report_html;
use linkwright::internals::synthesis::nearest::nearest_positions;
use linkwright::internals::task::Problem;
use linkwright::load_problem;
use std::f64::consts::TAU;
use std::path::Path;
use std::sync::atomic::AtomicBool;

pub fn slider_crank() -> CrankLinkage {
    let direction = 0.3;
    let line = (Complex::new(1.1, 1.6), direction);
    let offset = Complex::new(2.0, 1.0);
    let made = SliderCrank::from_parts(Complex::new(1.0, 2.0), [1.0, 3.0], line, offset, AssemblyMode::Plus);
    CrankLinkage::SliderCrank(made.expect("a linkage"))
}

pub fn inverted() -> CrankLinkage {
    let pivots = [Complex::new(0.0, 0.0), Complex::new(2.5, 0.5)];
    let made = InvertedSliderCrank::from_parts(pivots, 1.0, 0.4, Complex::new(3.0, 1.0), AssemblyMode::Plus);
    CrankLinkage::InvertedSliderCrank(made.expect("a linkage"))
}

/// Points of a linkage's curve at crank angles, radians.
fn points(linkage: &CrankLinkage, angles: &[f64]) -> String {
    let point = |angle: &f64| {
        let at = linkage.joints_with(*angle, linkage.assembly()).expect("it closes");
        let [x, y] = xy(at.joints.coupler_point);
        format!("[{x:?}, {y:?}]")
    };
    angles.iter().map(point).collect::<Vec<_>>().join(", ")
}

/// A problem file of points of a linkage's curve.
fn problem(linkage: &CrankLinkage, angles: &[f64], closed: bool, more: &str) -> String {
    format!("format = 1\n[task.path]\nclosed = {closed}\npoints = [{}]\n{more}", points(linkage, angles))
}

/// Recomputes what holds at every target from the record's numbers alone: the lengths of crank and coupler, the slider on
/// its line or the rod past its block, and the place of P.
fn assert_closed(candidate: &Candidate, targets: &[[f64; 2]], size: f64) {
    let mut sum = 0.0;
    for (([x, y], deg), t1) in targets.iter().zip(&candidate.crank_deg).zip(&candidate.t1_at) {
        let at = candidate.linkage.joints_with(deg.to_radians(), *t1).expect("it closes").joints;
        let (c, d, p) = (at.crank_pin, at.follower_pin, at.coupler_point);
        let near = |one: f64, other: f64| assert!((one - other).abs() < 1e-10 * size, "{one} {other}");
        let a = candidate.linkage.crank_pivot();
        near((c - a).norm(), candidate.linkage.crank());
        near(((c - a).arg() - deg.to_radians()).sin(), 0.0);
        let along = match &candidate.linkage {
            CrankLinkage::SliderCrank(l) => {
                near((d - c).norm(), l.coupler());
                let s = Complex::from_polar(1.0, l.parameters().line_deg.to_radians());
                near(((d - l.line_point()) * s.conj()).im, 0.0);
                (d - c) / l.coupler()
            }
            CrankLinkage::InvertedSliderCrank(l) => {
                let arm = l.block_pivot() - d;
                near(arm.norm(), l.offset().abs());
                near(dot(arm, d - c), 0.0);
                // B lies to the left of the coupler where the offset is positive.
                let u = (d - c) * t1.sign() / (d - c).norm();
                near((arm * u.conj()).im, l.offset());
                u
            }
            CrankLinkage::FourBar(_) | CrankLinkage::MultiLoop(_) => panic!("not a four-bar"),
        };
        let offset = candidate.linkage.coupler_offset();
        near((p - c - along * offset).norm(), 0.0);
        sum += (Complex::new(*x, *y) - p).norm_sqr();
    }
    assert!((sum - candidate.error.sum_sq).abs() <= 1e-10 * sum.max(size * size * 1e-12));
}

fn turn(n: usize) -> Vec<f64> {
    (0..n).map(|j| TAU * j as f64 / n as f64).collect()
}

#[test]
fn curves_of_both_kinds_are_found_again_closed_open_and_timed() {
    let open: Vec<f64> = (0..24).map(|j| 0.3 + 0.1 * f64::from(j)).collect();
    let timed: Vec<f64> = (0..18).map(|j| 0.5 + 0.3 * f64::from(j)).collect();
    for (linkage, kind) in [(slider_crank(), "slider-crank"), (inverted(), "inverted-slider-crank")] {
        let design = format!("[design]\nmechanism = \"{kind}\"\n[solve]\ncandidates = 1\nadvice = false\n");
        let degrees: Vec<String> = timed.iter().map(|a| format!("{:?}", (a - 0.5).to_degrees())).collect();
        let timing = format!("[task.path.timing]\ncrank_deg = [{}]\n{design}", degrees.join(", "));
        let texts = [
            problem(&linkage, &turn(40), true, &design),
            problem(&linkage, &open, false, &design),
            problem(&linkage, &timed, false, &timing),
        ];
        for text in texts {
            let record = solved(parse(&text).spec);
            let best = &record.candidates[0];
            assert!(best.accepted && best.error.rms_over_size < 1e-12, "{kind}: {}", best.error.rms);
            assert_eq!(best.linkage.kind().name(), kind);
            assert_closed(best, &record.problem.resolved.task.points, 5.0);
            assert!(verify(&record).is_ok_and(|found| found.is_empty()));
            assert!(report_html(&record, 0).contains(kind));
        }
    }
}

/// A problem file of poses of a linkage's coupler, without the angle of those in `without`.
fn motion(linkage: &CrankLinkage, angles: &[f64], without: &[usize], more: &str) -> String {
    let pose = |(j, angle): (usize, &f64)| {
        let at = linkage.joints_with(*angle, linkage.assembly()).expect("it closes");
        let ([x, y], deg) = (xy(at.joints.coupler_point), (at.coupler.arg() + 0.4).to_degrees());
        if without.contains(&j) { format!("[{x:?}, {y:?}]") } else { format!("[{x:?}, {y:?}, {deg:?}]") }
    };
    let poses: Vec<String> = angles.iter().enumerate().map(pose).collect();
    format!("format = 1\n[task.motion]\nposes = [{}]\n{more}", poses.join(", "))
}

#[test]
fn motions_of_both_kinds_are_found_again_free_timed_and_mixed() {
    let angles: Vec<f64> = (0..8).map(|j| 0.3 + 0.35 * f64::from(j)).collect();
    let degrees: Vec<String> = angles.iter().map(|a| format!("{:?}", (a - 0.3).to_degrees())).collect();
    for (linkage, kind) in [(slider_crank(), "slider-crank"), (inverted(), "inverted-slider-crank")] {
        let design = format!("[design]\nmechanism = \"{kind}\"\n[solve]\ncandidates = 1\nadvice = false\n");
        let timing = format!("[task.motion.timing]\ncrank_deg = [{}]\n{design}", degrees.join(", "));
        let texts = [
            motion(&linkage, &angles, &[], &design),
            motion(&linkage, &angles, &[2, 5], &design),
            motion(&linkage, &angles, &[], &timing),
        ];
        for text in texts {
            let record = solved(parse(&text).spec);
            let best = &record.candidates[0];
            let angle = best.error.angle.as_ref().expect("the body's angles");
            assert!(best.accepted && best.error.rms_over_size < 1e-11, "{kind}: {}", best.error.rms);
            assert!(angle.max_deg < 1e-8, "{kind}: {}", angle.max_deg);
            assert_eq!(best.linkage.kind().name(), kind);
            assert_closed(best, &record.problem.resolved.task.points, 5.0);
            // The frame is the angle from the coupler to the body's x axis, up to half a turn of an inverted coupler.
            let apart = (best.frame_deg.expect("a frame").to_radians() - 0.4).sin().abs();
            assert!(apart < 1e-9, "{kind}: {apart}");
            assert!(verify(&record).is_ok_and(|found| found.is_empty()));
            assert!(report_html(&record, 0).contains(kind));
        }
    }
}

/// Solves an example whose first answer is an accepted slider-crank, and returns its true record.
fn led_by_a_slider_crank(name: &str) -> Record {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/examples").join(name).with_extension("toml");
    let mut spec = load_problem(&path, &[]).expect("a problem").spec;
    spec.solve.advice = false;
    let record = solved(spec);
    assert!(verify(&record).is_ok_and(|found| found.is_empty()));
    let best = &record.candidates[0];
    assert!(best.accepted && best.linkage.kind() == LinkageKind::SliderCrank);
    record
}

#[test]
fn kinds_are_ranked_together_and_the_stride_is_drawn_by_a_slider_crank() {
    let record = led_by_a_slider_crank("walking-stride-slider");
    let best = &record.candidates[0];
    assert!(best.error.rms < 0.345 && best.transmission_deg.worst > 39.0, "{}", best.error.rms);
    let four_bar = record.candidates.iter().find(|c| c.linkage.kind() == LinkageKind::FourBar);
    assert!(four_bar.is_some_and(|c| c.error.rms > 1.6), "the four-bar is listed behind it");
    for candidate in record.candidates.iter().filter(|c| c.linkage.kind() != LinkageKind::FourBar) {
        assert_closed(candidate, &record.problem.resolved.task.points, 500.0);
    }
}

#[test]
fn a_door_on_a_rail_is_nearer_to_its_poses_than_on_two_arms() {
    let record = led_by_a_slider_crank("up-and-over-door");
    let best = &record.candidates[0];
    assert!(best.error.objective < 557.3 && best.transmission_deg.worst > 38.0, "{}", best.error.objective);
    assert_closed(best, &record.problem.resolved.task.points, 1500.0);
    let four_bar = record.candidates.iter().find(|c| c.linkage.kind() == LinkageKind::FourBar);
    assert!(four_bar.is_none_or(|c| c.error.rms > 50.0));
}

#[test]
fn a_rail_is_horizontal_and_passes_where_it_is_wanted() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/examples/walking-stride-slider.toml");
    let set = [
        ("design.mechanism", "slider-crank"),
        ("design.line_deg", "180"),
        ("design.line_point", "[0, [200, 300]]"),
        ("solve.candidates", "1"),
        ("solve.advice", "false"),
    ]
    .map(|(key, value)| (key.to_owned(), value.to_owned()));
    let spec = load_problem(&path, &set).expect("a problem").spec;
    let record = solved(spec);
    assert!(verify(&record).is_ok_and(|found| found.is_empty()));
    let best = &record.candidates[0];
    assert!(best.accepted, "{:?}", best.requirements);
    let rail = best.linkage.slider_crank().expect("a slider-crank");
    let s = rail.line_direction();
    assert!(s.im.abs() < 1e-9);
    let height = rail.line_point().im - rail.line_point().re * s.im / s.re;
    assert!((200.0 - 1e-6..=300.0 + 1e-6).contains(&height), "{height}");
    let rows: Vec<&str> = best.requirements.iter().map(|row| row.name.as_str()).collect();
    assert!(rows.contains(&"design.line_deg") && rows.contains(&"design.line_y"), "{rows:?}");
}

fn on_threads(spec: &linkwright::spec::ProblemSpec, threads: usize) -> Record {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    pool.install(|| run(&Job::new("it", spec.clone()), &context).expect("a search").record)
}

#[test]
fn records_are_the_same_on_one_thread_and_on_three_and_read_back_to_the_same_bytes() {
    let noisy = "format = 1\n[task.path]\nclosed = true\npoints = [[0, 0], [1, 0.1], [2, 0], [2.6, 0.8], [2, 1.5], \
                 [1, 1.3], [0.1, 1.6], [-0.5, 0.7]]\n\
                 [design]\nmechanism = [\"inverted-slider-crank\", \"slider-crank\"]\n[require]\ntransmission_deg_min = 25\n";
    let spec = parse(noisy).spec;
    let (one, three) = (on_threads(&spec, 1), on_threads(&spec, 3));
    let [one, three] = [one, three].map(|r| serde_json::to_string(&r).expect("JSON"));
    assert_eq!(one, three);
    let read: Record = serde_json::from_str(&one).expect("a record");
    assert_eq!(serde_json::to_string(&read).expect("JSON"), one);
    assert!(read.candidates.iter().any(|c| c.accepted && c.transmission_deg.worst > 25.0 - 1e-6));
    assert!(verify(&read).is_ok_and(|found| found.is_empty()));
}

#[test]
fn a_linkage_file_of_each_kind_is_known_as_written_by_the_program_and_reads_back() {
    for linkage in [slider_crank(), inverted()] {
        let text = any_to_toml("it", None, &linkage);
        assert!(FileKind::Linkage.is_written_by_us(text.as_bytes(), b""));
        let read = parse_any("it.toml", &text).expect("a linkage");
        assert_eq!(read.linkage, linkage.into());
    }
}

#[test]
fn a_record_with_a_stray_key_of_another_kind_is_refused() {
    let text = r#"{"kind": "slider-crank", "A": [0, 0], "B": [1, 0], "a": 1, "b": 3, "line_point": [0, 0], "line_deg": 0,
        "coupler_x": 1, "coupler_y": 0, "t1": 1}"#;
    let refused = serde_json::from_str::<CrankLinkage>(text).expect_err("B is no key").to_string();
    assert!(refused.contains("a slider-crank has no key `B`"), "{refused}");
    let missing = serde_json::from_str::<CrankLinkage>(
        &text.replace(r#""B": [1, 0], "#, "").replace(r#""b": 3, "#, ""),
    );
    assert!(missing.expect_err("b is missing").to_string().contains("missing field `b`"));
}

#[test]
fn crank_angles_from_a_line_keep_the_root_of_its_sense() {
    let line = (Complex::new(0.5, -0.7), 0.4);
    let (pivot, offset) = (Complex::new(1.0, 2.0), Complex::new(2.0, 1.0));
    let made = SliderCrank::from_parts(pivot, [1.0, 4.0], line, offset, AssemblyMode::Minus);
    let linkage = CrankLinkage::SliderCrank(made.expect("a linkage"));
    let angles: Vec<f64> = (0..18).map(|j| 0.4 + 5.0 * f64::from(j) / 17.0).collect();
    let crank_deg: Vec<f64> = (0..18).map(|j| (5.0 * f64::from(j) / 17.0).to_degrees()).collect();
    let more = format!(
        "[task.path.timing]\ncrank_deg = {crank_deg:?}\noffset = \"ground\"\n[design]\nmechanism = \"slider-crank\"\n\
         [solve]\ncandidates = 1\nadvice = false\n"
    );
    let record = solved(parse(&problem(&linkage, &angles, false, &more)).spec);
    let best = &record.candidates[0];
    assert!(best.accepted && best.error.rms_over_size < 1e-9, "{}", best.error.rms_over_size);
    assert_eq!(verify(&record).expect("a record"), []);
}

#[test]
fn a_four_bar_on_the_limit_of_its_link_ratio_has_a_slider_beside_it() {
    let linkage = slider_crank();
    let angles: Vec<f64> = (0..30).map(|j| 0.4 + 4.4 * f64::from(j) / 29.0).collect();
    // Bounds so wide that the ratio of 20 is what decides.
    let more = "[design]\nA = [[-100, 100], [-100, 100]]\nB = [[-100, 100], [-100, 100]]\nground = [0.1, 200]\na = [0.1, 200]\n\
                b = [0.1, 200]\nc = [0.1, 200]\n[require]\nlongest_max = \"any\"\n[solve]\ncandidates = 1\n\
                evaluations = 1000000\n";
    let record = solved(parse(&problem(&linkage, &angles, false, more)).spec);
    let first = &record.candidates[0];
    assert_eq!(first.linkage.kind(), LinkageKind::FourBar);
    assert!(first.warnings.iter().any(|warning| warning.key == "link_ratio_max"), "{:?}", first.warnings);
    let beside = record.buildable.as_ref().expect("a slider beside it");
    assert_eq!(beside.linkage.kind(), LinkageKind::SliderCrank);
    assert!(beside.accepted && beside.error.rms_over_size < 1e-9, "{}", beside.error.rms_over_size);
    assert_eq!(verify(&record).expect("a record"), []);
}

#[test]
fn a_linkage_is_placed_where_it_comes_nearest_to_the_targets_of_its_own_curve() {
    let angles: Vec<f64> = (0..24).map(|i| 0.3 + TAU * f64::from(i) / 24.0).collect();
    for linkage in [slider_crank(), inverted()] {
        let rms = |text: &str| {
            let problem = Problem::new(parse(text).spec).expect("a task");
            let (crank_deg, t1_at) = nearest_positions(&problem, linkage).expect("it closes");
            assess(&problem, linkage, &crank_deg, &t1_at).expect("it closes").error.rms
        };
        let free = rms(&problem(&linkage, &angles, true, ""));
        assert!(free < 1e-9, "{free}");
        let degrees: Vec<f64> = angles.iter().map(|angle| angle.to_degrees() - 20.0).collect();
        let timing = format!("timing = {{ crank_deg = {degrees:?}, offset = \"free\" }}\n");
        let timed = rms(&problem(&linkage, &angles, true, &timing));
        assert!(timed < 1e-9, "{timed}");
        // A body that lies on the coupler at an angle of its own.
        let pose = |angle: &f64| {
            let at = linkage.joints_with(*angle, linkage.assembly()).expect("it closes");
            let [x, y] = xy(at.joints.coupler_point);
            format!("[{x:?}, {y:?}, {:?}]", at.coupler.arg().to_degrees() + 33.0)
        };
        let poses: Vec<String> = angles.iter().take(8).map(pose).collect();
        let moved = rms(&format!("format = 1\n[task.motion]\nposes = [{}]\n", poses.join(", ")));
        assert!(moved < 1e-6, "{moved}");
    }
}

#[test]
fn every_problem_of_known_linkages_is_met_exactly() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/sliders");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        let file = load_problem(&path, &[]).expect("a problem");
        let size = Problem::new(file.spec.clone()).expect("a task").task().size();
        let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
        let record = run(&Job::from(file), &context).expect("a run").record;
        let best = &record.candidates[0];
        assert!(best.accepted && best.error.rms < 1e-9 * size, "{}: {}", path.display(), best.error.rms);
        assert!(verify(&record).expect("a problem").is_empty(), "{}", path.display());
        count += 1;
    }
    assert_eq!(count, 12);
}

#[test]
fn an_extent_and_a_footprint_are_held_within_the_search() {
    for kind in ["slider-crank", "inverted-slider-crank"] {
        let more = |require: &str| {
            format!(
                "[design]\nmechanism = \"{kind}\"\n[require]\n{require}\n[solve]\ncandidates = 1\nadvice = false\n\
                 evaluations = 30000\n"
            )
        };
        // An egg that neither kind draws exactly.
        let egg: Vec<String> = turn(24)
            .into_iter()
            .map(|t| format!("[{:?}, {:?}]", 1.5 * t.cos(), t.sin() + 0.25 * (2.0 * t).cos()))
            .collect();
        let text = |require: &str| {
            format!(
                "format = 1\n[task.path]\nclosed = true\npoints = [{}]\n{}",
                egg.join(", "),
                more(require)
            )
        };
        let extent = |record: &Record| {
            let problem = Problem::new(record.problem.resolved.clone()).expect("a problem");
            linkwright::internals::judge::figures::extent(&problem, &record.candidates[0])
        };
        let free = solved(parse(&text("input = \"full-turn\"")).spec);
        let wide = extent(&free);
        let most = 0.8 * wide;
        let held = solved(parse(&text(&format!("input = \"full-turn\"\nextent_max = {most:?}"))).spec);
        let best = &held.candidates[0];
        assert!(best.accepted, "{kind}: {:?}", best.requirements);
        assert!(extent(&held) <= most * (1.0 + 1e-9), "{kind}: {} {most}", extent(&held));
        assert!(best.error.rms >= free.candidates[0].error.rms * (1.0 - 1e-6));
        let boxed = "input = \"full-turn\"\nfootprint_in = [-3.0, -4.0, 5.0, 4.5]";
        let boxed = solved(parse(&text(boxed)).spec);
        assert!(boxed.candidates[0].accepted, "{kind}: {:?}", boxed.candidates[0].requirements);
        assert_eq!(verify(&boxed).expect("a problem"), []);
    }
}

#[test]
fn a_slider_that_draws_nearly_what_a_four_bar_draws_is_listed_beside_it() {
    let bean: Vec<String> = turn(40)
        .into_iter()
        .map(|t| {
            let r = 40.0 * (1.0 + 0.25 * (2.0 * t).cos() + 0.12 * (3.0 * t).sin());
            format!("[{:.2}, {:.2}]", 100.0 + r * t.cos(), 60.0 + 0.7 * r * t.sin())
        })
        .collect();
    let text = format!(
        "format = 1\n[task.path]\nclosed = true\npoints = [{}]\n[design]\nmechanism = [\"four-bar\", \
         \"inverted-slider-crank\"]\n[require]\ninput = \"full-turn\"\ntransmission_deg_min = 30\n[solve]\nadvice = false\n",
        bean.join(", ")
    );
    let record = solved(parse(&text).spec);
    let kinds: Vec<LinkageKind> = record.candidates.iter().map(|c| c.linkage.kind()).collect();
    assert!(kinds[..2].contains(&LinkageKind::FourBar), "{kinds:?}");
    assert!(kinds[..2].contains(&LinkageKind::InvertedSliderCrank), "{kinds:?}");
    assert!(record.candidates.windows(2).all(|c| c[0].error.rms <= c[1].error.rms));
    assert_eq!(verify(&record).expect("a problem"), []);
}
