//! Makes a start set of exact synthesis from nothing and writes it to a file.
//!
//! ```text
//! cargo run --release --example nine-point-start-set -- src/numbers/nine_point/start-set.bin [POSES [SEED]]
//! ```
//!
//! POSES is the number of poses beyond the first place: 0 (the default) for nine points, 1 to 4 for two to five poses with
//! 6, 4, 2 and no points. Monodromy from one random complex four-bar until four loops in a row find no new class. It
//! refuses to write a set that has not as many classes as are known ([`CLASSES`]) or does not come back whole from the
//! file.

#![expect(clippy::print_stdout, reason = "it says what it found")]

mod monodromy;

use linkwright::internals::numbers::arithmetic::complex_lanes::ORDER;
use linkwright::internals::numbers::arithmetic::streams::{stream, unit};
use linkwright::internals::numbers::nine_point::classes::first_of_class;
use linkwright::internals::numbers::nine_point::equations::unknowns;
use linkwright::internals::numbers::nine_point::start::{CLASSES, StartSet};
use monodromy::{Limits, orbit};
use std::sync::atomic::AtomicBool;

/// Returns the bytes of a set's file, as `src/numbers/nine_point/start.rs` describes them.
fn bytes_of(set: &StartSet) -> Vec<u8> {
    let mut bytes = b"LWNP".to_vec();
    for word in [1, set.solutions.len() as u32, set.displacements.poses as u32] {
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

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut arguments = std::env::args().skip(1);
    let path = arguments.next().ok_or("which file shall the start set be written to?")?;
    let poses: usize = arguments.next().map_or(Ok(0), |word| word.parse())?;
    let classes = *CLASSES.get(poses).ok_or("at most four poses beyond the first")?;
    let seed: u64 = arguments.next().map_or(Ok(SEED), |word| word.parse())?;
    let mut numbers = stream(seed, poses as u64);
    let orbit = orbit(&mut || unit(&mut numbers), poses, &Limits::default(), &AtomicBool::new(false));
    let found = orbit.solutions.len();
    println!("{found} classes in {} loops; the last {} found none", orbit.loops, orbit.idle);
    if found != classes {
        return Err(format!("{found} classes, not {classes}: try another seed").into());
    }
    let set = StartSet { displacements: orbit.displacements, solutions: orbit.solutions };
    let bytes = bytes_of(&set);
    let back = StartSet::parse(&bytes)?;
    let firsts = first_of_class(&[set.solutions, back.solutions].concat(), 1e-7);
    if (0..classes).any(|at| firsts[at] != at || firsts[classes + at] != at) {
        return Err("the set does not survive single precision: try another seed".into());
    }
    std::fs::write(&path, &bytes)?;
    println!("{} bytes to {path}", bytes.len());
    Ok(())
}
