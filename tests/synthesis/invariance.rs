//! The same problem in another place, size, quarter turn or mirror image, with its points in the reversed order or from
//! another start, has the same answers.

#![allow(clippy::print_stdout, reason = "the slow test prints where answers differ")]

use crate::random::{ROCKING, TURNING, log_uniform, one_of, trace};
use linkwright::internals::mechanism::{Complex, CouplerCurve};
use linkwright::internals::numbers::arithmetic::streams::{Stream, below, normal, stream, uniform};
use linkwright::internals::record::{Candidate, Record};
use linkwright::internals::task::similarity::{Numbering, Similarity};
use linkwright::spec::ProblemSpec;
use linkwright::{Context, Job, run};
use std::f64::consts::TAU;
use std::sync::atomic::AtomicBool;

/// Distance of curves, in sizes of the target, within which they are the same.
const SAME: f64 = 1e-6;
/// Number of points of a curve that are compared.
const COMPARED: usize = 48;

/// The points of a drawn shape: an ellipse, an egg, a bean or a D, drawn by an unsteady hand.
fn drawn(draws: &mut Stream, which: u64, n: usize) -> Vec<Complex> {
    let (width, height) = (uniform(draws, 1.0, 4.0), uniform(draws, 0.4, 2.0));
    let phases = [(); 4].map(|()| uniform(draws, 0.0, TAU));
    let turn = Complex::from_polar(1.0, uniform(draws, 0.0, TAU));
    let at = |j: usize| {
        let t = TAU * j as f64 / n as f64;
        let (sin, cos) = t.sin_cos();
        let point = match which % 4 {
            0 => Complex::new(width * cos, height * sin),
            1 => Complex::new(width * cos, height * sin * (1.0 + 0.25 * cos)),
            2 => Complex::new(width * cos, height * sin + 0.35 * height * (2.0 * t).cos()),
            _ => Complex::new(width * cos.max(-0.3), height * sin),
        };
        let wobble: f64 = (0..4).map(|k| ((k + 2) as f64 * t + phases[k]).cos()).sum();
        turn * point * (1.0 + 0.006 * wobble)
    };
    (0..n).map(at).collect()
}

/// Target `index`: a coupler curve of a crank that turns fully, an arc of a coupler curve, or a drawn shape, with its
/// name.
pub fn target(index: u64, evaluations: u64) -> (&'static str, ProblemSpec) {
    let draws = &mut stream(11, index);
    let (name, closed, points) = match index % 4 {
        0 | 1 => loop {
            let closed = index.is_multiple_of(4);
            let of = if closed || index % 8 == 1 { one_of(draws, &TURNING) } else { one_of(draws, &ROCKING) };
            let linkage = crate::random::linkage(draws, of);
            let n = if index.is_multiple_of(3) { 60 } else { 16 + below(draws, 20) };
            let span = (!closed).then(|| uniform(draws, 120.0, 240.0).to_radians());
            if let Some(traced) = trace(draws, &linkage, n, span) {
                let sigma = if index.is_multiple_of(5) { 0.0 } else { 0.005 * traced.size() };
                let noise =
                    |draws: &mut Stream| Complex::new(normal(draws, 0.0, sigma), normal(draws, 0.0, sigma));
                let points: Vec<Complex> = traced.points.iter().map(|p| p + noise(draws)).collect();
                break (if closed { "curve" } else { "arc" }, closed, points);
            }
        },
        _ => {
            let n = 24 + below(draws, 40);
            ("drawn", true, drawn(draws, index / 4, n))
        }
    };
    let points: Vec<[f64; 2]> = points.iter().map(|p| [p.re, p.im]).collect();
    let text = format!(
        "format = 1\n[task.path]\npoints = {points:?}\nclosed = {closed}\n[solve]\nadvice = false\n\
         evaluations = {evaluations}\n"
    );
    (name, crate::common::parse(&text).spec)
}

/// The names and the images in which a problem is solved again.
fn images(index: u64, spec: &ProblemSpec) -> Vec<(&'static str, Similarity, Numbering)> {
    let draws = &mut stream(12, index);
    let path = &spec.task;
    let task = path.to_task().expect("a path");
    let (n, size) = (path.points.len(), task.size());
    let shift = [(); 2].map(|()| uniform(draws, -10.0, 10.0) * size);
    let (scale, turns) = (log_uniform(draws, 0.01, 100.0), 1 + below(draws, 3) as u8);
    let first = if path.closed { 1 + below(draws, n - 1) } else { 0 };
    let reversed = Numbering { first: if path.closed { 0 } else { n - 1 }, reversed: true };
    let everything = Numbering { first: if path.closed { first } else { n - 1 }, reversed: true };
    let (same, as_before) = (Similarity::IDENTITY, Numbering::IDENTITY);
    let mut images = vec![
        (
            "everything",
            Similarity { mirrors: true, turns, scale, to: shift.map(|by| by * scale), ..same },
            everything,
        ),
        ("shift", Similarity { to: shift, ..same }, as_before),
        ("scale", Similarity { scale, ..same }, as_before),
        ("mirror image", Similarity { mirrors: true, ..same }, as_before),
        ("turn", Similarity { turns, ..same }, as_before),
        ("reversed", same, reversed),
    ];
    if path.closed {
        images.push(("start", same, Numbering { first, reversed: false }));
    }
    images
}

pub fn solved(spec: &ProblemSpec) -> Record {
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    run(&Job::new("it", spec.clone()), &context).expect("it runs").record
}

fn curve(candidate: &Candidate) -> CouplerCurve {
    CouplerCurve::through(
        candidate.linkage.four_bar().expect("a four-bar"),
        candidate.crank_deg[0].to_radians(),
        candidate.t1_at[0],
        240,
    )
}

/// The largest distance of points of one curve, taken back, from the other.
fn apart(one: &CouplerCurve, back: &Similarity, other: &CouplerCurve) -> f64 {
    let points: Vec<Complex> = one.points().collect();
    let every = points.len().div_ceil(COMPARED).max(1);
    let off = |p: &Complex| {
        let [x, y] = back.point([p.re, p.im]);
        other.nearest(Complex::new(x, y)).map_or(f64::INFINITY, |nearest| nearest.distance)
    };
    points.iter().step_by(every).map(off).fold(0.0, f64::max)
}

/// Whether the first candidates draw the same curve, and whether all do, as sets.
fn alike(one: &Record, other: &Record, by: &Similarity) -> (bool, bool) {
    let size = one.problem.resolved.task.to_task().expect("a path").size();
    let [ones, others] = [one, other].map(|record| record.candidates.iter().map(curve).collect::<Vec<_>>());
    let same = |one: &CouplerCurve, other: &CouplerCurve| {
        apart(other, &by.inverse(), one) <= SAME * size && apart(one, by, other) <= SAME * size * by.scale
    };
    let first = ones.first().zip(others.first()).is_some_and(|(one, other)| same(one, other));
    let all = ones.len() == others.len()
        && ones.iter().all(|one| others.iter().any(|other| same(one, other)))
        && others.iter().all(|other| ones.iter().any(|one| same(one, other)));
    (first || (ones.is_empty() && others.is_empty()), all)
}

/// The number of targets whose first candidate, and whose whole list, is the same in so many of their images.
fn compared(targets: std::ops::Range<u64>, evaluations: u64, most: usize, show: bool) -> (usize, usize) {
    let (mut first, mut whole) = (0, 0);
    let mut tally: Vec<(&str, usize, usize, usize)> = Vec::new();
    for index in targets {
        let (kind, spec) = target(index, evaluations);
        let record = solved(&spec);
        let (mut firsts, mut lists) = (true, true);
        for (name, by, numbering) in images(index, &spec).into_iter().take(most) {
            let other = solved(&spec.placed(&by).renumbered(numbering));
            let (same_first, same_list) = alike(&record, &other, &by);
            firsts &= same_first;
            lists &= same_list;
            if !tally.iter().any(|row| row.0 == name) {
                tally.push((name, 0, 0, 0));
            }
            for row in tally.iter_mut().filter(|row| row.0 == name) {
                *row = (name, row.1 + 1, row.2 + usize::from(same_first), row.3 + usize::from(same_list));
            }
            if show && !same_list {
                let rms = |record: &Record| -> Vec<String> {
                    let all = record.candidates.iter();
                    all.map(|c| format!("{:.9e} {:.6}", c.error.rms_over_size, c.transmission_deg.worst))
                        .collect()
                };
                println!(
                    "{kind} {index}, {name}: first {same_first}\n  {:?}\n  {:?}",
                    rms(&record),
                    rms(&other)
                );
            }
        }
        first += usize::from(firsts);
        whole += usize::from(lists);
    }
    if show {
        for (name, of, first, list) in tally {
            println!("{name}: first {first} of {of}, list {list} of {of}");
        }
    }
    (first, whole)
}

#[test]
fn images_of_a_problem_have_the_same_answers() {
    assert_eq!(compared(0..16, 1500, 1, false), (16, 16));
}

#[test]
#[ignore = "some 1,400 searches; in a release build"]
fn invariance_of_two_hundred_targets() {
    let begun = std::time::Instant::now();
    let (first, whole) = compared(0..200, 20_000, usize::MAX, true);
    println!("of 200 targets: first {first}, whole list {whole}; {:.0} s", begun.elapsed().as_secs_f64());
    assert!(first == 200 && whole >= 190, "first {first}, whole list {whole}");
}
