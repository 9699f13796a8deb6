//! The start sets: one solution of each class at a fixed complex target in general position, of nine points, of each
//! mixture of points and poses that has a finite number of answers, and of eight points where there is a slider.
//!
//! The file holds single-precision pivots; the T_j follow from them (each leg gives a quadratic, the legs share one
//! root; that of a pose is given) and Newton's method restores full precision. `cargo run --release --example
//! nine-point-start-set -- FILE KIND` makes it anew from nothing, by monodromy.
//!
//! | bytes | content (little endian) |
//! |---|---|
//! | 0..4 | "LWNP" |
//! | 4..8 | version, u32: 1 |
//! | 8..12 | number of classes n, u32 |
//! | 12..14 | number of poses beyond the first, u16 |
//! | 14 | number of given ground pivots, u8 |
//! | 15 | closure, u8: 0 four-bar, 1 slider-crank, 2 inverted slider-crank |
//! | 16..272 | delta_1 .. delta_8, delta*_1 .. delta*_8: real and imaginary part, f64 |
//! | 272.. | n times x, x - a, x*, x* - a*, y, y - b, y*, y* - b*: real and imaginary part, f32 |

use super::correction::correct;
use super::equations::{UNKNOWNS, solution};
use super::target::{Closure, Displacements, Kind, MOST_POSES, STEPS, Solution};
use super::tracker::Segment;
use linkwright_arithmetic::Complex;
use linkwright_arithmetic::complex_lanes::ORDER;
use linkwright_arithmetic::once::once;
use std::sync::OnceLock;
use thiserror::Error;

/// A kind of problem with its start set.
struct Known {
    kind: Kind,
    /// The number of classes of a target in general position.
    classes: usize,
    /// The bytes of the embedded file.
    bytes: &'static [u8],
}

/// The kinds that have a start set.
///
/// Nine points: 8652 solutions (Wampler, Morgan & Sommese 1992) over the six images. Two, three and four poses with six,
/// four and two points: 2224, 402 and 60 solutions (D. A. Brake, J. D. Hauenstein, A. P. Murray, D. H. Myszka,
/// C. W. Wampler, "The complete solution of Alt-Burmester synthesis problems for four-bar linkages", ASME J. Mech. Robot. 8
/// (2016) 041018) over the two labels. Five poses: four dyads in pairs (Burmester). Five points with both pivots: 36
/// solutions (A. P. Morgan, C. W. Wampler, "Solving a planar four-bar design problem using continuation", ASME J. Mech. Des.
/// 112 (1990) 544-550). Eight points of a slider-crank: 558 solutions in pairs of cognates (H. Tari, H.-J. Su, "Complete
/// solution to the eight-point path generation of slider-crank four-bar linkages", ASME J. Mech. Des. 132 (2010) 081003). The
/// counts of the other kinds were found by the generator: monodromy from two seeds, eight loops
/// without a new solution at the end of each. With three poses and a pivot more the links would not be determined.
const KNOWN: [Known; 13] = [
    Known { kind: Kind::new(0, 0), classes: 1442, bytes: include_bytes!("start-set.bin") },
    Known { kind: Kind::new(1, 0), classes: 1112, bytes: include_bytes!("start-set-1-0.bin") },
    Known { kind: Kind::new(2, 0), classes: 201, bytes: include_bytes!("start-set-2-0.bin") },
    Known { kind: Kind::new(3, 0), classes: 30, bytes: include_bytes!("start-set-3-0.bin") },
    Known { kind: Kind::new(4, 0), classes: 6, bytes: include_bytes!("start-set-4-0.bin") },
    Known { kind: Kind::new(0, 1), classes: 243, bytes: include_bytes!("start-set-0-1.bin") },
    Known { kind: Kind::new(0, 2), classes: 36, bytes: include_bytes!("start-set-0-2.bin") },
    Known { kind: Kind::new(1, 1), classes: 94, bytes: include_bytes!("start-set-1-1.bin") },
    Known { kind: Kind::new(1, 2), classes: 6, bytes: include_bytes!("start-set-1-2.bin") },
    Known { kind: Kind::new(2, 1), classes: 12, bytes: include_bytes!("start-set-2-1.bin") },
    Known { kind: Kind::new(2, 2), classes: 1, bytes: include_bytes!("start-set-2-2.bin") },
    Known {
        kind: Kind::of_points(Closure::SliderCrank),
        classes: 279,
        bytes: include_bytes!("start-set-slider-crank.bin"),
    },
    Known {
        kind: Kind::of_points(Closure::InvertedSliderCrank),
        classes: 2220,
        bytes: include_bytes!("start-set-inverted-slider-crank.bin"),
    },
];

impl Kind {
    /// Returns the kinds that have a start set.
    pub fn known() -> impl Iterator<Item = Kind> {
        KNOWN.iter().map(|known| known.kind)
    }

    /// Returns the number of classes of a target of this kind in general position; 0 for a kind without a start set.
    pub fn classes(self) -> usize {
        KNOWN.iter().find(|known| known.kind == self).map_or(0, |known| known.classes)
    }

    /// Returns the bytes of the embedded start set, none for a kind without one.
    pub fn embedded(self) -> &'static [u8] {
        KNOWN.iter().find(|known| known.kind == self).map_or(&[], |known| known.bytes)
    }
}

const MAGIC: &[u8; 4] = b"LWNP";
const VERSION: u32 = 1;
const HEADER: usize = 16;
const PIVOTS: usize = HEADER + 32 * 8;
const ENTRY: usize = 2 * ORDER * 4;

/// The start solutions for homotopy path tracking: solutions of one target, from which paths lead to any other.
#[derive(Clone, Debug, PartialEq)]
pub struct StartSet {
    /// The displacements of the target.
    pub displacements: Displacements,
    /// One solution per class.
    pub solutions: Vec<Solution>,
}

/// The reason for which bytes are no start set.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum StartSetError {
    /// The bytes do not begin as such a file does.
    #[error("this is no start set of exact synthesis of version {VERSION}")]
    Header,
    /// The number of bytes is wrong.
    #[error("a start set of {classes} classes has {wanted} bytes, not {found}")]
    Length {
        /// The number of classes in the header.
        classes: usize,
        /// The number of bytes for these classes.
        wanted: usize,
        /// The number of bytes found.
        found: usize,
    },
    /// An entry is no solution, and Newton's method does not converge from it to one.
    #[error("entry {0} of the start set is no solution")]
    Entry(usize),
}

impl StartSet {
    /// Returns the embedded set of a kind of targets, which is read once. A test checks that the files are whole.
    ///
    /// # Panics
    /// When the bytes within the program are damaged, or the kind has no set: an empty set would pass for "no linkage goes
    /// through the points".
    pub fn embedded(kind: Kind) -> &'static StartSet {
        static SETS: [OnceLock<StartSet>; KNOWN.len()] = [const { OnceLock::new() }; KNOWN.len()];
        match KNOWN.iter().position(|known| known.kind == kind) {
            Some(at) => once(&SETS[at], || StartSet::built_in(KNOWN[at].bytes)),
            None => panic!("no start set for {kind:?}"),
        }
    }

    /// Reads the set within the program.
    fn built_in(bytes: &[u8]) -> StartSet {
        match StartSet::parse(bytes) {
            Ok(set) => set,
            Err(why) => panic!("a start set within the program is damaged: {why}"),
        }
    }

    /// Reads the bytes of a start set and corrects its solutions by Newton's method.
    ///
    /// # Errors
    ///
    /// When the bytes are no such file or an entry is no solution.
    pub fn parse(bytes: &[u8]) -> Result<StartSet, StartSetError> {
        let word = |at: usize| Some(u32::from_le_bytes(*bytes.get(at..at + 4)?.first_chunk()?));
        if bytes.get(..4) != Some(MAGIC) || word(4) != Some(VERSION) {
            return Err(StartSetError::Header);
        }
        let kind = word(12).ok_or(StartSetError::Header)? as usize;
        let closure = match kind >> 24 {
            0 => Closure::FourBar,
            1 => Closure::SliderCrank,
            2 => Closure::InvertedSliderCrank,
            _ => return Err(StartSetError::Header),
        };
        let kind = Kind { poses: kind & 0xffff, pivots: kind >> 16 & 0xff, closure };
        if kind.slides() && (kind.poses, kind.pivots) != (0, 0)
            || kind.pivots > 2
            || kind.poses + kind.pivots > MOST_POSES
        {
            return Err(StartSetError::Header);
        }
        let classes = word(8).ok_or(StartSetError::Header)? as usize;
        let wanted = PIVOTS + classes * ENTRY;
        if bytes.len() != wanted {
            return Err(StartSetError::Length { classes, wanted, found: bytes.len() });
        }
        let doubles: Vec<f64> =
            bytes[HEADER..PIVOTS].as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect();
        let singles: Vec<f64> =
            bytes[PIVOTS..].as_chunks::<4>().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect();
        let number = |from: &[f64], at: usize| Complex::new(from[2 * at], from[2 * at + 1]);
        let displacements = Displacements {
            delta: std::array::from_fn(|j| number(&doubles, j)),
            starred: std::array::from_fn(|j| number(&doubles, STEPS + j)),
            kind,
        };
        let rough: Vec<Solution> = singles
            .chunks_exact(2 * ORDER)
            .map(|entry| {
                let mut all = [Complex::default(); UNKNOWNS];
                for (i, z) in all.iter_mut().take(ORDER).enumerate() {
                    *z = number(entry, i);
                }
                with_rotations(solution(&all), &displacements)
            })
            .collect();
        let stay = Segment { from: displacements, to: displacements };
        let exact = correct(&rough, &stay, NEWTON_STEPS);
        match exact.iter().position(|c| !(c.newton_step < 1e-9 && c.solution.is_finite())) {
            Some(entry) => Err(StartSetError::Entry(entry)),
            None => Ok(StartSet { displacements, solutions: exact.iter().map(|c| c.solution).collect() }),
        }
    }
}

/// The number of Newton steps: from single precision, a few are enough.
const NEWTON_STEPS: usize = 5;

/// Computes the T_j that pivots imply: x beta T^2 + (x x* + alpha beta - U V) T + alpha x* = 0 with
/// alpha = delta_j - a, beta = delta*_j - a*, for either leg; the leg of a slider has the quadratic of its own line. Of the roots of both legs the pair that is nearest to
/// being one is taken. The T_j of a pose is given.
fn with_rotations(pivots: Solution, at: &Displacements) -> Solution {
    let mut answer = pivots;
    for j in at.kind.lengths()..STEPS {
        for own in at.kind.spare(j) {
            answer.rotations[own] = at.delta[j] / at.starred[j];
        }
    }
    for j in 0..at.kind.points() {
        let roots: [[Complex; 2]; 2] = std::array::from_fn(|leg| {
            let (x, a) = (pivots.pins[leg], pivots.grounds[leg]);
            let (x_s, a_s) = (pivots.pins_starred[leg], pivots.grounds_starred[leg]);
            let (delta, starred, v, v_s) = (at.delta[j], at.starred[j], x - a, x_s - a_s);
            let (alpha, beta) = (delta - a, starred - a_s);
            let (square, half, constant) = match if leg == 0 { Closure::FourBar } else { at.kind.closure } {
                Closure::FourBar => (x * beta, (x * x_s + alpha * beta - v * v_s) * 0.5, alpha * x_s),
                Closure::SliderCrank => (v_s * x, (v * (starred - x_s) + v_s * (delta - x)) * 0.5, v * x_s),
                Closure::InvertedSliderCrank => (-v * beta, (v * a_s + v_s * a) * -0.5, -v_s * alpha),
            };
            let root = (half * half - square * constant).sqrt();
            let sum = if (half.conj() * root).re >= 0.0 { -(half + root) } else { root - half };
            [sum / square, constant / sum]
        });
        let mut nearest = f64::INFINITY;
        for one in roots[0] {
            for other in roots[1] {
                let gap = (one - other).norm() / (one.norm() + other.norm());
                if gap < nearest {
                    nearest = gap;
                    answer.rotations[j] = (one + other) * 0.5;
                }
            }
        }
    }
    answer
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_damaged_set_within_the_program_is_our_own_bug_and_never_an_empty_list() {
        let whole = Kind::default().embedded();
        for damaged in [&whole[..whole.len() - 1], &whole[1..], &[][..]] {
            let made = std::panic::catch_unwind(|| StartSet::built_in(damaged));
            assert!(made.is_err(), "{} bytes", damaged.len());
        }
    }
}
