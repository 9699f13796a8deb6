//! Monodromy: finds all classes of a target in general position, without a start set.
//!
//! A random complex four-bar solves some target G. Carried around a closed loop in the space of displacements a
//! solution of G comes back as a solution of G, as a rule another one; the loops act on the 1442 classes as one
//! orbit. A loop leads from G straight to (u D, u* D*), D a random target, jumps by a change of units (the equations
//! keep their form under delta -> m delta, delta* -> m* delta* with x, y, a, b -> m .., starred alike) to (v D, v*
//! D*), and goes straight back. The images of a solution move as one, so that one of them is carried for all. Turns of
//! poses have no unit; they move with the displacements, as do given pivots.

use linkwright::internals::numbers::arithmetic::Complex;
use linkwright::internals::numbers::nine_point::classes::first_of_class;
use linkwright::internals::numbers::nine_point::correction::correct;
use linkwright::internals::numbers::nine_point::target::{Closure, Displacements, Kind, STEPS, Solution};
use linkwright::internals::numbers::nine_point::tracker::{Ending, Parameters, Segment, track};
use std::sync::atomic::AtomicBool;

/// A source of numbers uniform in [0, 1).
pub type Uniform<'a> = &'a mut dyn FnMut() -> f64;

/// The orbit of a solution under the loops: the result of monodromy.
#[derive(Clone, Debug, PartialEq)]
pub struct Orbit {
    /// The displacements of the target: complex, in general position.
    pub displacements: Displacements,
    /// One solution per class, in the order in which they were found.
    pub solutions: Vec<Solution>,
    /// The number of loops tracked.
    pub loops: u32,
    /// The number of last loops in a row that found nothing new.
    pub idle: u32,
}

/// The stopping criteria of [`orbit`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The largest number of loops.
    pub loops: u32,
    /// The number of loops in a row that find nothing new after which all classes are taken to be found.
    pub idle: u32,
    /// The number of classes that is enough, without idle loops.
    pub enough: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Limits { loops: 60, idle: 4, enough: usize::MAX }
    }
}

/// The index of a kind's stream of random numbers.
pub fn index(kind: Kind) -> u64 {
    (kind.poses + 8 * kind.pivots + 64 * kind.closure as usize) as u64
}

/// Returns the number of solutions below which a loop may well find no new one, and the number of idle loops after which all are
/// taken to be found.
pub fn limits_of(kind: Kind) -> (usize, u32) {
    match kind.closure {
        Closure::FourBar if kind == Kind::default() => (50, 4),
        Closure::FourBar => (0, 8),
        _ => (20, 8),
    }
}

/// The tolerance within which two solutions are of one class.
const SAME: f64 = 1e-6;

/// Draws a complex number in the ring between the radii 1/2 and 3/2.
pub fn ring(uniform: Uniform) -> Complex {
    Complex::from_polar(0.5 + uniform(), std::f64::consts::TAU * uniform())
}

/// Draws a random complex four-bar and computes displacements that it solves.
///
/// The line of a slider is linear in both, so that R = c_1 / L leaves a quadratic too. With random pivots and T_j each pair (delta_j, delta*_j) solves L_1 R_1 = c_1, L_2 R_2 = c_2, where L_2 = L_1 + d,
/// R_2 = R_1 + d*: a quadratic in L_1.
fn random_answer(uniform: Uniform, kind: Kind) -> (Displacements, Solution) {
    let [x, y, a, b, x_s, y_s, a_s, b_s] = [(); 8].map(|()| ring(uniform));
    let mut rotations: [Complex; STEPS] = [(); STEPS].map(|()| ring(uniform));
    let (c_1, c_2) = ((x - a) * (x_s - a_s), (y - b) * (y_s - b_s));
    let mut displacements =
        Displacements { delta: [Complex::default(); STEPS], starred: [Complex::default(); STEPS], kind };
    for j in kind.lengths()..STEPS {
        let [one, other] = kind.spare(j);
        rotations[other] = rotations[one];
        displacements.starred[j] = ring(uniform);
        displacements.delta[j] = rotations[one] * displacements.starred[j];
    }
    for link in 0..kind.pivots {
        let entry = kind.places() + link;
        (displacements.delta[entry], displacements.starred[entry]) = ([a, b][link], [a_s, b_s][link]);
    }
    let (v, v_s) = (y - b, y_s - b_s);
    for (j, &t) in rotations.iter().enumerate().take(kind.places()) {
        let (l, r) = match kind.closure {
            Closure::FourBar => {
                let (d, d_s) = ((y - x) * t - (b - a), (y_s - x_s) / t - (b_s - a_s));
                // c_1 + d* L + d R + d d* = c_2 with R = c_1 / L.
                let (half, product) = ((c_1 + d * d_s - c_2) / (d_s * 2.0), d * c_1 / d_s);
                let l = -half + (half * half - product).sqrt();
                (l, c_1 / l)
            }
            closure => {
                // With delta = L - d and delta* = R - d* the line is e + f delta + g delta* = 0.
                let (d, d_s) = (x * t - a, x_s / t - a_s);
                let (e, f, g) = if closure == Closure::SliderCrank {
                    (v * y_s * (t.inv() - 1.0) + v_s * y * (t - 1.0), v_s, v)
                } else {
                    (v * b_s * (t - 1.0) + v_s * b * (t.inv() - 1.0), -v_s / t, -v * t)
                };
                // f L^2 + (e - f d - g d*) L + g c_1 = 0.
                let half = (e - f * d - g * d_s) / (f * 2.0);
                let l = -half + (half * half - g * c_1 / f).sqrt();
                (l, c_1 / l)
            }
        };
        displacements.delta[j] = l - x * t + a;
        displacements.starred[j] = r - x_s / t + a_s;
    }
    if kind.slides() {
        // n* v + n v* = 1 and n / n* = T, which the last entry has chosen.
        let (n, n_s) = (displacements.delta[STEPS - 1], displacements.starred[STEPS - 1]);
        let size = (n_s * v + n * v_s).inv();
        displacements.delta[STEPS - 1] = n * size;
        displacements.starred[STEPS - 1] = n_s * size;
    }
    let solution = Solution {
        pins: [x, y],
        grounds: [a, b],
        pins_starred: [x_s, y_s],
        grounds_starred: [a_s, b_s],
        rotations,
    };
    (displacements, solution)
}

/// Draws random displacements of moderate size.
pub fn random_displacements(uniform: Uniform, kind: Kind) -> Displacements {
    let mut draw = || [(); STEPS].map(|()| ring(uniform));
    Displacements { delta: draw(), starred: draw(), kind }
}

/// Tracks monodromy loops until a limit is reached.
///
/// The first solution is tracked from the target that its linkage happens to solve to one of moderate size. `few` is the
/// number of solutions below which a loop may well find no new one.
pub fn orbit(uniform: Uniform, (kind, few): (Kind, usize), limits: &Limits, cancel: &AtomicBool) -> Orbit {
    let (from, first) = random_answer(uniform, kind);
    let home = random_displacements(uniform, kind);
    let solutions = arrived(&[first], &Segment { from, to: home }, cancel);
    let mut orbit = Orbit { displacements: home, solutions, loops: 0, idle: 0 };
    let stay = Segment { from: home, to: home };
    while orbit.loops < limits.loops && orbit.idle < limits.idle && orbit.solutions.len() < limits.enough {
        let away = random_displacements(uniform, kind);
        let [v, v_s] = [(); 2].map(|()| ring(uniform));
        let out = Segment { from: home, to: away };
        let back = Segment { from: away.in_other_units(v, v_s), to: home };
        let there: Vec<Solution> = arrived(&orbit.solutions, &out, cancel)
            .iter()
            .map(|solution| {
                let mut other = solution.in_other_units(v, v_s);
                if kind.slides() {
                    other.rotations[STEPS - 1] = back.from.delta[STEPS - 1] / back.from.starred[STEPS - 1];
                }
                other
            })
            .collect();
        let returned = arrived(&there, &back, cancel);
        let known = orbit.solutions.len();
        for end in correct(&returned, &stay, 2) {
            if end.newton_step < 1e-9 && end.solution.is_finite() {
                orbit.solutions.push(end.solution);
            }
        }
        let mut firsts = first_of_class(&orbit.solutions, kind.closure, SAME).into_iter().enumerate();
        orbit.solutions.retain(|_| firsts.next().is_some_and(|(at, first)| at == first));
        orbit.loops += 1;
        // A loop of few solutions that finds no new one is no sign that all are found.
        let new = orbit.solutions.len() > known;
        orbit.idle = if new || known < few { 0 } else { orbit.idle + 1 };
    }
    orbit
}

fn arrived(starts: &[Solution], along: &Segment, cancel: &AtomicBool) -> Vec<Solution> {
    let ends = track(starts, along, &Parameters::default(), cancel);
    ends.into_iter().filter(|end| end.ending == Ending::Arrived).map(|end| end.solution).collect()
}
