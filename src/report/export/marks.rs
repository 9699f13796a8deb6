//! Names on plates as strokes to engrave: the link's name between two of its holes, a joint's letter beside its hole.
//!
//! Strokes, not texts: programs of laser cutters often leave texts out, and none needs a font for lines.

use crate::mechanism::plates::{Placement, Plate};
use crate::mechanism::{Complex, cross, dot};
use std::f64::consts::TAU;

/// Heights are tried from the largest on, each this part of the one before, down to this part of the largest.
const SMALLER: f64 = 0.8;
const SMALLEST: f64 = 0.2;
/// Height of a letter beside a hole and of the link's name, as parts of the margin around holes.
const LETTER: f64 = 0.5;
const NAME: f64 = 0.9;
/// The largest height of a name, in mm.
const HIGHEST_MM: f64 = 6.0;
/// The distance to keep from holes, edges and other marks, as a part of the height.
const CLEAR: f64 = 0.25;
/// Directions from a hole in which a place for its letter is looked for.
const DIRECTIONS: usize = 16;

/// Size of a letter's cell, in which strokes are given, and from one letter to the next.
const CELL: [f64; 2] = [4.0, 6.0];
const ADVANCE: f64 = 5.5;

type Stroke = &'static [[f64; 2]];

/// Returns the strokes of a capital letter in its cell; none of one that no name has.
fn strokes(letter: char) -> &'static [Stroke] {
    const BOWL: Stroke =
        &[[0.0, 0.0], [0.0, 6.0], [3.0, 6.0], [4.0, 5.0], [4.0, 4.0], [3.0, 3.0], [0.0, 3.0]];
    match letter {
        'A' => &[&[[0.0, 0.0], [2.0, 6.0], [4.0, 0.0]], &[[0.7, 2.1], [3.3, 2.1]]],
        'B' => &[BOWL, &[[3.0, 3.0], [4.0, 2.0], [4.0, 1.0], [3.0, 0.0], [0.0, 0.0]]],
        'C' => &[&[
            [4.0, 5.0],
            [3.0, 6.0],
            [1.0, 6.0],
            [0.0, 5.0],
            [0.0, 1.0],
            [1.0, 0.0],
            [3.0, 0.0],
            [4.0, 1.0],
        ]],
        'D' => &[&[[0.0, 0.0], [0.0, 6.0], [2.5, 6.0], [4.0, 4.5], [4.0, 1.5], [2.5, 0.0], [0.0, 0.0]]],
        'E' => &[&[[4.0, 6.0], [0.0, 6.0], [0.0, 0.0], [4.0, 0.0]], &[[0.0, 3.0], [3.0, 3.0]]],
        'F' => &[&[[4.0, 6.0], [0.0, 6.0], [0.0, 0.0]], &[[0.0, 3.0], [3.0, 3.0]]],
        'G' => &[&[
            [4.0, 5.0],
            [3.0, 6.0],
            [1.0, 6.0],
            [0.0, 5.0],
            [0.0, 1.0],
            [1.0, 0.0],
            [3.0, 0.0],
            [4.0, 1.0],
            [4.0, 3.0],
            [2.5, 3.0],
        ]],
        'I' => &[&[[1.0, 0.0], [3.0, 0.0]], &[[2.0, 0.0], [2.0, 6.0]], &[[1.0, 6.0], [3.0, 6.0]]],
        'K' => &[&[[0.0, 0.0], [0.0, 6.0]], &[[4.0, 6.0], [0.0, 2.0]], &[[1.5, 3.5], [4.0, 0.0]]],
        'L' => &[&[[0.0, 6.0], [0.0, 0.0], [4.0, 0.0]]],
        'N' => &[&[[0.0, 0.0], [0.0, 6.0], [4.0, 0.0], [4.0, 6.0]]],
        'O' => &[&[
            [1.0, 0.0],
            [0.0, 1.0],
            [0.0, 5.0],
            [1.0, 6.0],
            [3.0, 6.0],
            [4.0, 5.0],
            [4.0, 1.0],
            [3.0, 0.0],
            [1.0, 0.0],
        ]],
        'P' => &[BOWL],
        'R' => &[BOWL, &[[2.0, 3.0], [4.0, 0.0]]],
        'U' => &[&[[0.0, 6.0], [0.0, 1.0], [1.0, 0.0], [3.0, 0.0], [4.0, 1.0], [4.0, 6.0]]],
        'W' => &[&[[0.0, 6.0], [1.0, 0.0], [2.0, 4.0], [3.0, 0.0], [4.0, 6.0]]],
        'X' => &[&[[0.0, 0.0], [4.0, 6.0]], &[[0.0, 6.0], [4.0, 0.0]]],
        'Y' => &[&[[0.0, 6.0], [2.0, 3.0], [4.0, 6.0]], &[[2.0, 3.0], [2.0, 0.0]]],
        '2' => &[&[[0.0, 5.0], [1.0, 6.0], [3.0, 6.0], [4.0, 5.0], [4.0, 4.0], [0.0, 0.0], [4.0, 0.0]]],
        '3' => &[&[
            [0.0, 6.0],
            [4.0, 6.0],
            [2.0, 3.5],
            [3.0, 3.5],
            [4.0, 2.5],
            [4.0, 1.0],
            [3.0, 0.0],
            [0.0, 0.0],
        ]],
        '5' => &[&[
            [4.0, 6.0],
            [0.0, 6.0],
            [0.0, 3.5],
            [3.0, 3.5],
            [4.0, 2.5],
            [4.0, 1.0],
            [3.0, 0.0],
            [0.0, 0.0],
        ]],
        '6' => &[&[
            [4.0, 6.0],
            [2.0, 6.0],
            [0.0, 4.0],
            [0.0, 1.0],
            [1.0, 0.0],
            [3.0, 0.0],
            [4.0, 1.0],
            [4.0, 2.5],
            [3.0, 3.5],
            [0.0, 3.5],
        ]],
        '7' => &[&[[0.0, 6.0], [4.0, 6.0], [1.5, 0.0]]],
        '8' => &[&[
            [1.0, 3.0],
            [0.0, 4.0],
            [0.0, 5.0],
            [1.0, 6.0],
            [3.0, 6.0],
            [4.0, 5.0],
            [4.0, 4.0],
            [3.0, 3.0],
            [1.0, 3.0],
            [0.0, 2.0],
            [0.0, 1.0],
            [1.0, 0.0],
            [3.0, 0.0],
            [4.0, 1.0],
            [4.0, 2.0],
            [3.0, 3.0],
        ]],
        _ => &[],
    }
}

/// Returns the diameter of a hole by the letters of its joints.
type Hole<'a> = &'a dyn Fn(&str) -> f64;

/// A word at a place of a plate.
struct Mark {
    word: String,
    centre: Complex,
    /// The direction of writing, a unit vector.
    along: Complex,
    height: f64,
}

impl Mark {
    /// Returns half the width and half the height.
    fn half(&self) -> [f64; 2] {
        let letters = self.word.chars().count() as f64;
        let width = CELL[0] + ADVANCE * (letters - 1.0).max(0.0);
        [0.5 * width * self.height / CELL[1], 0.5 * self.height]
    }

    fn corners(&self, around: f64) -> [Complex; 4] {
        let [wide, high] = self.half().map(|half| half + around);
        [[-wide, -high], [wide, -high], [wide, high], [-wide, high]]
            .map(|[x, y]| self.centre + self.along * Complex::new(x, y))
    }

    /// Returns the distance of a point from its box, 0 inside.
    fn distance(&self, to: Complex) -> f64 {
        let [x, y] = [dot(self.along, to - self.centre), cross(self.along, to - self.centre)];
        let [wide, high] = self.half();
        (x.abs() - wide).max(0.0).hypot((y.abs() - high).max(0.0))
    }

    /// Returns whether it lies on the plate, clear of the edge, of the holes and of other marks.
    fn fits(&self, plate: &Plate, hole: Hole<'_>, others: &[Mark]) -> bool {
        let clear = CLEAR * self.height;
        self.corners(clear).iter().all(|corner| plate.distance(&Placement::HOME, *corner) <= 0.0)
            && plate
                .distinct_holes()
                .iter()
                .all(|(joints, at)| self.distance(*at) >= 0.5 * hole(joints) + clear)
            && plate.distance_from_slot(&self.corners(0.0)) >= 0.5 * hole("") + clear
            && others.iter().all(|other| {
                // Boxes apart: none has a corner or its centre line near the other.
                let points = |mark: &Mark| mark.corners(0.0).into_iter().chain([mark.centre]);
                points(self).all(|at| other.distance(at) >= clear)
                    && points(other).all(|at| self.distance(at) >= clear)
            })
    }

    /// Returns the strokes on the sheet.
    fn strokes(&self, at: &Placement) -> Vec<Vec<Complex>> {
        let scale = self.height / CELL[1];
        let corner = self.centre - self.along * Complex::new(self.half()[0], self.half()[1]);
        let mut found = Vec::new();
        for (i, letter) in self.word.chars().enumerate() {
            let origin = corner + self.along * (scale * ADVANCE * i as f64);
            for stroke in strokes(letter) {
                let on_sheet = |p: &[f64; 2]| at.of(origin + self.along * scale * Complex::new(p[0], p[1]));
                found.push(stroke.iter().map(on_sheet).collect());
            }
        }
        found
    }
}

/// Returns the largest mark that fits of those that `of` makes of heights from `largest` down.
fn largest_that_fits(
    largest: f64,
    of: impl Fn(f64) -> Vec<Mark>,
    fits: impl Fn(&Mark) -> bool,
) -> Option<Mark> {
    let mut height = largest;
    while height >= SMALLEST * largest {
        if let Some(mark) = of(height).into_iter().find(&fits) {
            return Some(mark);
        }
        height *= SMALLER;
    }
    None
}

/// Returns the strokes of a plate's marks on the sheet: the name of its link and the letters of its holes, as large as
/// there is room for; what has no room is left out. `hole` gives the diameter of a hole by its letters, `margin` is the
/// material around them.
pub(super) fn marks(plate: &Plate, at: &Placement, (hole, margin): (Hole<'_>, f64)) -> Vec<Vec<Complex>> {
    let holes = plate.distinct_holes();
    // Not upside down on the sheet.
    let upright = |along: Complex| if (at.direction * along).re < -1e-9 { -along } else { along };
    let pairs = holes
        .iter()
        .enumerate()
        .flat_map(|(i, (_, one))| holes[..i].iter().map(move |(_, other)| (one, other)));
    let mut pairs: Vec<(Complex, Complex)> = pairs.map(|(one, other)| (*one, *other)).collect();
    // Towards the slot, too.
    let ends = plate
        .slot
        .map_or(Vec::new(), |slot| vec![slot.ends[0], slot.ends[1], 0.5 * (slot.ends[0] + slot.ends[1])]);
    pairs.extend(holes.iter().flat_map(|(_, hole)| ends.iter().map(|end| (*hole, *end))));
    pairs.sort_by(|one, other| (other.1 - other.0).norm().total_cmp(&(one.1 - one.0).norm()));
    let names = |height: f64| -> Vec<Mark> {
        let word = plate.link.name().to_uppercase();
        let between = |(one, other): &(Complex, Complex)| {
            let along = upright((other - one) / (other - one).norm());
            Mark { word: word.clone(), centre: 0.5 * (one + other), along, height }
        };
        pairs.iter().map(between).collect()
    };
    let name = largest_that_fits((NAME * margin).min(HIGHEST_MM), names, |mark| mark.fits(plate, hole, &[]));
    let mut placed: Vec<Mark> = name.into_iter().collect();
    let along = placed.first().map_or(at.direction.conj(), |name| name.along);
    let middle = holes.iter().map(|(_, hole)| hole).sum::<Complex>() / (holes.len().max(1) as f64);
    for (word, centre) in &holes {
        let outward = centre - middle;
        let outward = if outward.norm() > 0.0 { outward / outward.norm() } else { along };
        let beside = |height: f64| -> Vec<Mark> {
            let mark = |turn: usize| {
                // To both sides in turn, outward first.
                let turns = turn.div_ceil(2) as f64 * if turn.is_multiple_of(2) { 1.0 } else { -1.0 };
                let to = outward * Complex::from_polar(1.0, TAU * turns / DIRECTIONS as f64);
                let mark = Mark { word: word.clone(), centre: *centre, along, height };
                let [wide, high] = mark.half();
                let aside = wide * dot(to, along).abs() + high * cross(to, along).abs();
                Mark { centre: centre + to * (0.5 * hole(word) + 1.5 * CLEAR * height + aside), ..mark }
            };
            (0..DIRECTIONS).map(mark).collect()
        };
        placed.extend(largest_that_fits(LETTER * margin, beside, |mark| mark.fits(plate, hole, &placed)));
    }
    placed.iter().flat_map(|mark| mark.strokes(at)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::plates::Link;
    use crate::synthesis::fixture::linkage;

    #[test]
    fn names_and_letters_lie_on_the_plate_clear_of_its_holes() {
        let (hole, margin) = (4.0, 4.0);
        for lengths in [[40.0, 20.0, 50.0, 50.0], [400.0, 100.0, 350.0, 300.0], [9.0, 6.0, 10.0, 8.0]] {
            for plate in Plate::all(&linkage(lengths), 0.5 * hole + margin) {
                let at = Placement::between(Complex::new(3.0, 4.0), Complex::new(-5.0, 10.0));
                let found = marks(&plate, &at, (&|_| hole, margin));
                for point in found.iter().flatten() {
                    assert!(plate.distance(&at, *point) < 0.0, "{plate:?}");
                    assert!(
                        plate.holes.iter().all(|h| (at.of(h.at) - point).norm() > 0.5 * hole),
                        "{plate:?}"
                    );
                }
                let of_letters: usize = plate
                    .holes
                    .iter()
                    .flat_map(|hole| hole.joint.name().chars())
                    .map(|c| strokes(c).len())
                    .sum();
                assert!(found.len() >= of_letters, "a letter of {plate:?} is missing");
                let of_name: usize = plate.link.name().to_uppercase().chars().map(|c| strokes(c).len()).sum();
                if lengths[0] > 10.0 {
                    assert_eq!(found.len(), of_letters + of_name, "{plate:?}");
                }
            }
        }
    }

    #[test]
    fn every_letter_of_every_name_has_strokes_in_its_cell() {
        let links = Link::OF_BODIES.into_iter().chain([Link::Block]);
        let letters = links.flat_map(|link| link.name().to_uppercase().chars().collect::<Vec<_>>());
        for letter in letters.chain("X2Y2F2X3Y3F3".chars()) {
            assert!(!strokes(letter).is_empty(), "{letter}");
            for [x, y] in strokes(letter).iter().copied().flatten() {
                assert!((0.0..=CELL[0]).contains(x) && (0.0..=CELL[1]).contains(y), "{letter}");
            }
        }
    }
}
