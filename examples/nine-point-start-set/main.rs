//! Makes a start set of exact synthesis from nothing and writes it to a file, or makes the trace test of a set.
//!
//! ```text
//! cargo run --release --example nine-point-start-set -- src/numbers/nine_point/start-set.bin [KIND [SEED]]
//! cargo run --release --example nine-point-start-set -- trace [KIND [SEED]]
//! ```
//!
//! KIND is POSES PIVOTS, the number of poses beyond the first place and that of given ground pivots: 0 0 (the default) for nine
//! points, 3 0 for four poses and two points, 0 2 for five points and both pivots; or it is slider-crank or
//! inverted-slider-crank, for eight points. Monodromy from one random complex linkage until eight loops in a row find no new class,
//! four of nine points. It refuses to write a set that has not as many classes as are known ([`Kind::classes`]), if that is known,
//! or does not come back whole from the file.
//!
//! `trace` makes no set: it makes the trace test of the one within the program ([`trace`]) and prints its figures.

#![expect(clippy::print_stdout, reason = "it says what it found")]

mod conic;
mod monodromy;
mod trace;

use linkwright::internals::numbers::arithmetic::complex_lanes::ORDER;
use linkwright::internals::numbers::arithmetic::streams::{stream, unit};
use linkwright::internals::numbers::nine_point::classes::first_of_class;
use linkwright::internals::numbers::nine_point::equations::unknowns;
use linkwright::internals::numbers::nine_point::start::StartSet;
use linkwright::internals::numbers::nine_point::target::{Closure, Kind, MOST_POSES};
use monodromy::{Limits, index, limits_of, orbit};
use std::sync::atomic::AtomicBool;
use trace::trace;

/// Returns the bytes of a set's file, as `src/numbers/nine_point/start.rs` describes them.
fn bytes_of(set: &StartSet) -> Vec<u8> {
    let mut bytes = b"LWNP".to_vec();
    let kind = set.displacements.kind;
    for word in [
        1,
        set.solutions.len() as u32,
        (kind.poses | kind.pivots << 16 | (kind.closure as usize) << 24) as u32,
    ] {
        bytes.extend(word.to_le_bytes());
    }
    for z in set.displacements.delta.iter().chain(&set.displacements.starred) {
        bytes.extend(z.re.to_le_bytes());
        bytes.extend(z.im.to_le_bytes());
    }
    for solution in &set.solutions {
        for z in &unknowns(solution)[..ORDER] {
            bytes.extend((z.re as f32).to_le_bytes());
            bytes.extend((z.im as f32).to_le_bytes());
        }
    }
    bytes
}

/// The embedded set's.
const SEED: u64 = 1;

/// The largest number of loops of the trace test.
const LOOPS: u32 = 120;

/// Reads a kind of targets and a seed.
fn asked(arguments: &mut impl Iterator<Item = String>) -> Result<(Kind, u64), Box<dyn std::error::Error>> {
    let first = arguments.next().unwrap_or_else(|| "0".into());
    let mut number = |or: u64| arguments.next().map_or(Ok(or), |word| word.parse());
    let kind = match first.as_str() {
        "slider-crank" => Kind::of_points(Closure::SliderCrank),
        "inverted-slider-crank" => Kind::of_points(Closure::InvertedSliderCrank),
        poses => Kind::new(poses.parse()?, number(0)? as usize),
    };
    if kind.pivots > 2 || kind.poses + kind.pivots > MOST_POSES {
        return Err("at most two given pivots, and four of them and of the poses beyond the first".into());
    }
    Ok((kind, number(SEED)?))
}

/// Makes the trace test of an embedded set and prints its figures.
fn traced(kind: Kind, seed: u64) -> Result<(), Box<dyn std::error::Error>> {
    let (set, mut numbers) = (StartSet::embedded(kind), stream(seed, 0));
    let began = std::time::Instant::now();
    let found = trace(set, &mut || unit(&mut numbers), LOOPS)?;
    let Kind { poses, pivots, closure } = kind;
    println!(
        "{closure:?}, {poses} poses beyond the first place, {} points, {pivots} given pivots, seed {seed}",
        kind.points()
    );
    println!("at t = t0: {} classes, {} of {} of the set", found.at_t, found.known, set.solutions.len());
    println!("at L = 0: {}", found.others);
    println!(
        "loops: {}, the last {} without a further point, {} paths lost",
        found.loops.0, found.loops.1, found.lost
    );
    println!("departure from linear: {:.1e}", found.departure);
    println!("the same without one class: {:.1e} at least", found.without_one);
    println!("a sum's departure grows without one class by {:.1e} at least", found.factor);
    println!("{:.1} s", began.elapsed().as_secs_f64());
    Ok(())
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("which file shall the start set be written to?")?;
    let (kind, seed) = asked(&mut arguments)?;
    if path == "trace" {
        return traced(kind, seed);
    }
    let mut numbers = stream(seed, index(kind));
    let (few, idle) = limits_of(kind);
    let limits = Limits { idle, ..Limits::default() };
    let orbit = orbit(&mut || unit(&mut numbers), (kind, few), &limits, &AtomicBool::new(false));
    let found = orbit.solutions.len();
    println!("{found} classes in {} loops; the last {} found none", orbit.loops, orbit.idle);
    let classes = match kind.classes() {
        0 => found,
        known => known,
    };
    if found != classes {
        return Err(format!("{found} classes, not {classes}: try another seed").into());
    }
    let set = StartSet { displacements: orbit.displacements, solutions: orbit.solutions };
    let bytes = bytes_of(&set);
    let back = StartSet::parse(&bytes)?;
    let firsts = first_of_class(&[set.solutions, back.solutions].concat(), kind.closure, 1e-7);
    if (0..classes).any(|at| firsts[at] != at || firsts[classes + at] != at) {
        return Err("the set does not survive single precision: try another seed".into());
    }
    std::fs::write(&path, &bytes)?;
    println!("{} bytes to {path}", bytes.len());
    Ok(())
}
