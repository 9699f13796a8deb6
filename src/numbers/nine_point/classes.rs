//! The six images of a solution, and the grouping of solutions into classes of images.
//!
//! The equations keep their form when the legs change places, (x, a) <-> (y, b), and when a linkage is replaced by a
//! Roberts cognate,
//!
//! ```text
//! (x, a, y, b) -> ((x - a) y / (x - y), (b x - a y) / (x - y), a - x, a),    T_j -> (x T_j + delta_j - a) / (x - a)
//! ```
//!
//! starred alike: a group of order six. All six have two of the same three foci a, b, c = (b x - a y) / (x - y) as
//! ground pivots. To a focus a belong two pins, x and in another cognate a - x; their product x (a - x) belongs to
//! the focus. So the set of the three (focus, product), with their starred twins, identifies a class. The foci alone
//! do so in general: linkages that are mirror images, of foci on a symmetric target's axis, share them.
//!
//! A slider-crank has one cognate: the crank x - a and the arm -x from pin to coupler point change places,
//!
//! ```text
//! x -> a - x    y -> a - x + k (x - a)    v -> k v    v* -> k* v*    k = x / (x - y)    v = y - b
//! T_j -> (x T_j + delta_j - a) / (x - a)
//! ```
//!
//! starred alike, since delta_j = (x - a)(T'_j - 1) - x (T_j - 1) with T'_j the crank's turn, and the displacement of the sliding
//! pin, (y - x)(T_j - 1) + (x - a)(T'_j - 1), is multiplied by k. An inverted slider-crank has none, and legs of two kinds do not
//! change places: such a class has two solutions or one.
//!
//! With poses a class has two solutions: a cognate turns the coupler differently; with both
//! pivots given it has one, with one and no poses two cognates. Foci and
//! products tell such classes apart as well.

use super::conjugation::Reality;
use super::target::{Closure, Displacements, STEPS, Solution};
use linkwright_arithmetic::Complex;

/// One class of six solutions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Class {
    /// One of the six solutions.
    pub solution: Solution,
    /// The reality of the class, found to rounding.
    pub reality: Reality,
    /// Relative size of the last Newton step: the uncertainty that rounding leaves.
    pub newton_step: f64,
    /// Relative speed of the solution as the target comes in along the path: large near a singularity.
    pub speed: f64,
}

/// The permutations of three foci.
const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

impl Solution {
    /// Returns the same linkage with its legs exchanged.
    pub fn swapped(&self) -> Solution {
        let swap = |[one, other]: [Complex; 2]| [other, one];
        Solution {
            pins: swap(self.pins),
            grounds: swap(self.grounds),
            pins_starred: swap(self.pins_starred),
            grounds_starred: swap(self.grounds_starred),
            rotations: self.rotations,
        }
    }

    /// Returns a Roberts cognate. Applied three times it gives the solution again; it is not finite if a leg or the
    /// coupler has no length.
    pub fn cognate(&self, at: &Displacements) -> Solution {
        let image = |[x, y]: [Complex; 2], [a, b]: [Complex; 2]| {
            let coupler = (x - y).inv();
            ([(x - a) * y * coupler, a - x], [(b * x - a * y) * coupler, a])
        };
        let (pins, grounds) = image(self.pins, self.grounds);
        let (pins_starred, grounds_starred) = image(self.pins_starred, self.grounds_starred);
        let (x, a) = (self.pins[0], self.grounds[0]);
        let length = (x - a).inv();
        let mut rotations = self.rotations;
        for (j, t) in rotations.iter_mut().enumerate().take(at.kind.places()) {
            *t = (x * *t + at.delta[j] - a) * length;
        }
        Solution { pins, grounds, pins_starred, grounds_starred, rotations }
    }

    /// Returns the six solutions of the class: this one, its two cognates, and the three with their legs swapped. Of a
    /// target with poses, which has no cognates, there are two: this one and the one with its legs swapped, in turn. Of one
    /// with both pivots given there is this one alone; with one there are two cognates.
    pub fn images(&self, at: &Displacements) -> [Solution; 6] {
        let cognates = self.cognates(at);
        let all: Vec<Solution> = match at.kind.pivots {
            0 if !at.kind.slides() => {
                cognates.iter().copied().chain(cognates.iter().map(Solution::swapped)).collect()
            }
            _ => cognates,
        };
        std::array::from_fn(|i| all[i % all.len()])
    }

    /// Returns this solution and those of its cognates that solve the equations too, with the first link on the given pivot:
    /// through points alone all three, with one given pivot the two that have it, else this one.
    pub fn cognates(&self, at: &Displacements) -> Vec<Solution> {
        match (at.kind.poses, at.kind.pivots) {
            (0, 0) if at.kind.closure == Closure::SliderCrank => vec![*self, self.slider_cognate(at)],
            _ if at.kind.slides() => vec![*self],
            (0, 0) => {
                let first = self.cognate(at);
                vec![*self, first, first.cognate(at)]
            }
            (0, 1) => vec![*self, self.cognate(at).swapped()],
            _ => vec![*self],
        }
    }

    /// Returns the cognate of a slider-crank. Applied twice it gives the solution again; it is not finite if a leg has no length or
    /// the sliding pin lies on the crank's.
    fn slider_cognate(&self, at: &Displacements) -> Solution {
        let mut image = self.turned_slider();
        let [n, n_s] = [at.delta[STEPS - 1], at.starred[STEPS - 1]];
        let (v, v_s) = (image.pins[1] - image.grounds[1], image.pins_starred[1] - image.grounds_starred[1]);
        let size = (n_s * v + n * v_s).inv();
        image.grounds[1] = image.pins[1] - v * size;
        image.grounds_starred[1] = image.pins_starred[1] - v_s * size;
        let (x, a) = (self.pins[0], self.grounds[0]);
        let length = (x - a).inv();
        for (j, t) in image.rotations.iter_mut().enumerate().take(at.kind.places()) {
            *t = (x * *t + at.delta[j] - a) * length;
        }
        image
    }

    /// Returns the pivots of a slider-crank's cognate, v of any size; its rotations are left as they are.
    fn turned_slider(&self) -> Solution {
        let image = |[x, y]: [Complex; 2], [a, b]: [Complex; 2]| {
            let k = x / (x - y);
            let sliding = a - x + k * (x - a);
            ([a - x, sliding], [a, sliding - k * (y - b)])
        };
        let (pins, grounds) = image(self.pins, self.grounds);
        let (pins_starred, grounds_starred) = image(self.pins_starred, self.grounds_starred);
        Solution { pins, grounds, pins_starred, grounds_starred, rotations: self.rotations }
    }

    /// Returns whether another solution has the same crank, to rounding, and the same sliding pin and line, or, of an inverted
    /// slider-crank, the same fixed pivot and coupler line.
    fn has_pivots_of(&self, other: &Solution, closure: Closure, tolerance: f64) -> bool {
        let numbers = |of: &Solution| {
            let second = if closure == Closure::SliderCrank {
                [of.pins[1], of.pins_starred[1]]
            } else {
                [of.grounds[1], of.grounds_starred[1]]
            };
            [of.pins[0], of.pins_starred[0], of.grounds[0], of.grounds_starred[0], second[0], second[1]]
        };
        let normal = |of: &Solution| [of.pins[1] - of.grounds[1], of.pins_starred[1] - of.grounds_starred[1]];
        let ([v, v_s], [w, w_s]) = (normal(self), normal(other));
        let crossed = (v * w_s - w * v_s).norm() / ((v * w_s).norm() + (w * v_s).norm());
        let (one, two) = (numbers(self), numbers(other));
        (0..4).all(|i| distance(one[i], two[i]) <= tolerance)
            && (4..6).all(|i| distance(one[i], two[i]) <= tolerance.sqrt())
            && crossed <= tolerance.sqrt()
    }

    /// Returns the conjugate solution, which is one of the same target if that is real.
    pub fn conjugate(&self) -> Solution {
        let conj = |pair: [Complex; 2]| pair.map(|z| z.conj());
        Solution {
            pins: conj(self.pins_starred),
            grounds: conj(self.grounds_starred),
            pins_starred: conj(self.pins),
            grounds_starred: conj(self.grounds),
            rotations: self.rotations.map(|t| t.inv().conj()),
        }
    }

    /// Returns the solution when delta is multiplied by `by` and delta* by `by_starred`. The quotient of n and n*, which is none
    /// of a length, is as before.
    pub fn in_other_units(&self, by: Complex, by_starred: Complex) -> Solution {
        Solution {
            pins: self.pins.map(|z| z * by),
            grounds: self.grounds.map(|z| z * by),
            pins_starred: self.pins_starred.map(|z| z * by_starred),
            grounds_starred: self.grounds_starred.map(|z| z * by_starred),
            rotations: self.rotations,
        }
    }

    /// Returns the three foci, each with its starred twin: the two ground pivots and the third of the cognates.
    pub fn foci(&self) -> [[Complex; 2]; 3] {
        let third = |[x, y]: [Complex; 2], [a, b]: [Complex; 2]| (b * x - a * y) / (x - y);
        let (a, b) = (self.grounds, self.grounds_starred);
        [[a[0], b[0]], [a[1], b[1]], [third(self.pins, a), third(self.pins_starred, b)]]
    }

    /// Returns x (a - x) for the pins x at the foci a, in the order of the foci, each with its starred twin.
    fn products(&self) -> [[Complex; 2]; 3] {
        let of = |[x, y]: [Complex; 2], [a, b]: [Complex; 2]| {
            let coupler = (x - y).inv();
            let (p, c) = ((x - a) * y * coupler, (b * x - a * y) * coupler);
            [x * (a - x), y * (b - y), p * (c - p)]
        };
        let (one, starred) = (of(self.pins, self.grounds), of(self.pins_starred, self.grounds_starred));
        std::array::from_fn(|i| [one[i], starred[i]])
    }

    /// Returns whether another solution is an image of this one, to rounding: foci within `tolerance` of one another,
    /// each relative to 1 + its size, and in the same order the products of the pins within the root of it. Where there is a
    /// slider pivots are compared, with those of the cognate too if there is one.
    pub fn is_in_class_of(&self, other: &Solution, closure: Closure, tolerance: f64) -> bool {
        if closure != Closure::FourBar {
            return self.has_pivots_of(other, closure, tolerance)
                || closure == Closure::SliderCrank
                    && self.has_pivots_of(&other.turned_slider(), closure, tolerance);
        }
        let (one, two) = (self.foci(), other.foci());
        let (products, others) = (self.products(), other.products());
        ORDERS.iter().any(|order| {
            (0..3).all(|i| {
                (0..2).all(|k| {
                    let (a, b) = (one[i][k], two[order[i]][k]);
                    let (n, m) = (products[i][k], others[order[i]][k]);
                    // The rounding of a product is that of a square of the numbers subtracted.
                    let scale = 1.0 + n.norm().min(m.norm()) + a.norm_sqr();
                    distance(a, b) <= tolerance && (n - m).norm() <= tolerance.sqrt() * scale
                })
            })
        })
    }

    /// Returns whether every number is finite.
    pub fn is_finite(&self) -> bool {
        super::equations::unknowns(self).iter().all(|z| z.re.is_finite() && z.im.is_finite())
    }

    /// Returns the distance of the solution from a real linkage: the largest of |x* - conj x| and so on, relative to
    /// 1 + its size, and of |1 - |T_j||.
    pub fn imaginary_part(&self) -> f64 {
        let pair = |one: [Complex; 2], starred: [Complex; 2]| {
            (0..2).map(|i| distance(one[i].conj(), starred[i])).fold(0.0, f64::max)
        };
        let turns = self.rotations.iter().map(|t| (1.0 - t.norm()).abs()).fold(0.0, f64::max);
        pair(self.pins, self.pins_starred).max(pair(self.grounds, self.grounds_starred)).max(turns)
    }
}

/// Returns |one - other| relative to 1 + the smaller size; infinity in place of NaN.
fn distance(one: Complex, other: Complex) -> f64 {
    let distance = (one - other).norm() / (1.0 + one.norm().min(other.norm()));
    if distance.is_nan() { f64::INFINITY } else { distance }
}

/// Computes a number that the images of a solution share and that stays of moderate size when foci go to infinity:
/// sum 1 / (focus - z0) over the foci and their twins, z0 in general position. Where there is a slider the two pins that the crank
/// pivot has in cognates take the place of foci, or those two points of the linkage that are left without cognates.
pub(super) fn key(of: &Solution, closure: Closure) -> f64 {
    let (x, a, b) = ([of.pins[0], of.pins_starred[0]], [of.grounds[0], of.grounds_starred[0]], of.grounds[1]);
    let foci = match closure {
        Closure::FourBar => of.foci(),
        Closure::SliderCrank => [x, [a[0] - x[0], a[1] - x[1]], [Complex::ZERO; 2]],
        Closure::InvertedSliderCrank => [x, a, [b, of.grounds_starred[1]]],
    };
    const POLES: [Complex; 2] =
        [Complex::new(0.372_119_4, 1.719_302_7), Complex::new(-1.130_472_1, -0.926_381_2)];
    foci.iter().map(|[a, b]| ((a - POLES[0]).inv() + (b - POLES[1]).inv()).re).sum()
}

/// Groups solutions by class: returns for each the index of the first one of its class.
///
/// Two are of one class if [`Solution::is_in_class_of`] returns true. The answer does not depend on more than the
/// solutions and their order.
pub fn first_of_class(solutions: &[Solution], closure: Closure, tolerance: f64) -> Vec<usize> {
    let keys: Vec<f64> = solutions.iter().map(|solution| key(solution, closure)).collect();
    let mut order: Vec<usize> = (0..solutions.len()).collect();
    order.sort_by(|&i, &j| keys[i].total_cmp(&keys[j]).then(i.cmp(&j)));
    let mut first: Vec<usize> = (0..solutions.len()).collect();
    for (at, &i) in order.iter().enumerate() {
        // The key's own error: its derivative by a focus is at most |key|^2, roughly.
        let window = 100.0 * tolerance * (1.0 + keys[i] * keys[i]);
        for &j in order[at + 1..].iter().take_while(|&&j| keys[j] - keys[i] <= window) {
            if solutions[i].is_in_class_of(&solutions[j], closure, tolerance) {
                let (one, other) = (root(&first, i), root(&first, j));
                first[one.max(other)] = one.min(other);
            }
        }
    }
    (0..solutions.len()).map(|i| root(&first, i)).collect()
}

fn root(first: &[usize], mut at: usize) -> usize {
    while first[at] != at {
        at = first[at];
    }
    at
}
