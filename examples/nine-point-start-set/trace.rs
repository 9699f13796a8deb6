//! The trace test: evidence that a start set lacks no solution, independent of published counts.
//!
//! Let the target move along a general complex line, D(t) = D_0 + t V. The solutions form a curve, and t, q_1 .. q_4 are rational
//! functions on it. With L(q) = c_0 + c_1 q_1 + .. put h = (t - t0) L(q). For c and t0 in general position
//!
//! - the section h = 0 consists of the solutions at t = t0, which are those that the start set claims to be all, and of the
//!   points with L = 0;
//! - at a place where t has a pole of order k, or the q have poles of order up to m, h has one of order k + m. So none of
//!   1, t, q_i, t q_i has a pole of higher order than h anywhere, and they are finite where h is.
//!
//! So the sum of such a function over all points with h = s, counted with their orders, is a rational function of s that has no
//! pole at finite s and grows no faster than s: it is linear in s. The sum over fewer points is not: as s turns around branch
//! points, the points of an irreducible curve exchange their places, and with them would the sum. If the sums over
//! the points found are linear, the points are all on their components of the curve; and that is one component, if the
//! set of all pairs of a solution and its target is irreducible, as a general line's part of it then is (Bertini). It is for points:
//! given the pins, the pivots and the turns of the coupler, each displacement solves a quadratic equation of its own.
//!
//! The points are found by monodromy: the start set leads from s = 0 to the section h = s_1; loops through random sections lead back
//! to it, until no further point is found.
//!
//! Source: A. Leykin, J. I. Rodriguez, F. Sottile, "Trace test", Arnold Math. J. 4 (2018) 113-125 (section 4: sections of
//! curves in products of spaces by the product of two linear forms).

use crate::conic::{COORDINATES, Line, Point, Section, coordinates_of, track_points};
use crate::monodromy::{Uniform, random_displacements, ring};
use linkwright::internals::numbers::arithmetic::Complex;
use linkwright::internals::numbers::nine_point::equations::unknowns;
use linkwright::internals::numbers::nine_point::start::StartSet;
use linkwright::internals::numbers::nine_point::target::Kind;

/// The functions whose sums are compared: t, the q_i and the t q_i.
const FUNCTIONS: usize = 1 + 2 * COORDINATES;
/// The number of sections over which the sums are compared: two determine the linear function.
const SECTIONS: usize = 4;
/// The tolerance within which two points are one, relative to 1 + the size of each coordinate.
const SAME: f64 = 1e-6;

/// The result of the trace test.
#[derive(Clone, Debug)]
pub struct Traced {
    /// The number of points of the section at t = t0: classes of solutions of one target.
    pub at_t: usize,
    /// The number of those that belong to the start set.
    pub known: usize,
    /// The number of points of the section with L = 0.
    pub others: usize,
    /// The number of loops, and that of the last ones that found nothing new.
    pub loops: (u32, u32),
    /// The number of paths that were lost on loops.
    pub lost: usize,
    /// The largest departure of a sum from a linear function of s, relative to the sum of the magnitudes.
    pub departure: f64,
    /// The same with one class of the section left out, the least over all classes.
    pub without_one: f64,
    /// The factor by which leaving out one class raises the departure of some sum, the least over all classes.
    pub factor: f64,
}

/// The reason for which the sums could not be compared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Failed {
    /// Paths from section to section were lost, or ended together: so many.
    Lost(usize),
}

impl std::fmt::Display for Failed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Failed::Lost(paths) = self;
        write!(f, "{paths} paths between the sections of the trace were lost or ended together")
    }
}

impl std::error::Error for Failed {}

/// Returns the points without those that an earlier one repeats.
fn distinct(kind: Kind, points: Vec<Point>) -> Vec<Point> {
    let numbers = |point: &Point| {
        let q = coordinates_of(kind, point);
        [point.t, q[0], q[1], q[2], q[3]]
    };
    let all: Vec<[Complex; COORDINATES + 1]> = points.iter().map(numbers).collect();
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&i, &j| all[i][0].re.total_cmp(&all[j][0].re).then(i.cmp(&j)));
    let close = |a: Complex, b: Complex| (a - b).norm() <= SAME * (1.0 + a.norm());
    let mut is_new = vec![true; points.len()];
    for (at, &i) in order.iter().enumerate() {
        let window = SAME * (1.0 + all[i][0].norm());
        for &j in order[at + 1..].iter().take_while(|&&j| all[j][0].re - all[i][0].re <= window) {
            if all[i].iter().zip(&all[j]).all(|(a, b)| close(*a, *b)) {
                is_new[i.max(j)] = false;
            }
        }
    }
    points.into_iter().zip(is_new).filter(|(_, new)| *new).map(|(point, _)| point).collect()
}

/// Evaluates the functions whose sums are compared.
fn functions(kind: Kind, point: &Point) -> [Complex; FUNCTIONS] {
    let q = coordinates_of(kind, point);
    std::array::from_fn(|i| match i {
        0 => point.t,
        _ if i <= COORDINATES => q[i - 1],
        _ => point.t * q[i - 1 - COORDINATES],
    })
}

/// The largest departure from linear that is rounding.
const LINEAR: f64 = 1e-11;
/// The size of s in the sections that are compared: the farther apart they are, the more a sum departs from linear.
const FAR: f64 = 4.0;
/// The number of other ways that are tried between two sections.
const DETOURS: usize = 4;
/// The decimal logarithm of the largest size of the numbers of a loop's section, and of the inverse of the smallest.
const SPREAD: f64 = 1.0;

/// The trace test of a start set: loops until the sums over the points found are linear, at most `most`.
///
/// # Errors
///
/// When paths between the sections are lost.
pub fn trace(set: &StartSet, uniform: Uniform, most: u32) -> Result<Traced, Failed> {
    let kind = set.displacements.kind;
    let line = Line { at_zero: set.displacements, velocity: random_displacements(uniform, kind) };
    let form = [(); COORDINATES + 1].map(|()| ring(uniform));
    let section = |s: Complex| Section { form, t: Complex::ZERO, s };
    let sections: [Section; SECTIONS] = [(); SECTIONS].map(|()| section(ring(uniform) * FAR));
    let home = sections[0];
    let starts: Vec<Point> =
        set.solutions.iter().map(|s| Point { unknowns: unknowns(s), t: Complex::ZERO }).collect();
    let arrived = |starts: &[Point], way: (&Section, &Section)| -> Vec<Point> {
        track_points(starts, &line, way).into_iter().flatten().collect()
    };
    let over = |points: &[Point], to: &Section, uniform: Uniform| -> Result<Vec<Point>, Failed> {
        let mut ends = distinct(kind, arrived(points, (&home, to)));
        // Another way for all, if one of them meets an obstacle: the sums do not depend on it.
        for _ in 0..DETOURS {
            if ends.len() == points.len() {
                break;
            }
            let aside = section(ring(uniform) * FAR);
            ends = distinct(kind, arrived(&arrived(points, (&home, &aside)), (&aside, to)));
        }
        if ends.len() < points.len() { Err(Failed::Lost(points.len() - ends.len())) } else { Ok(ends) }
    };
    let mut points = distinct(kind, arrived(&starts, (&section(Complex::ZERO), &home)));
    let (mut loops, mut unfruitful, mut lost) = (0, 0, starts.len() - points.len());
    let (mut departure, mut without_one, mut factor) = (f64::INFINITY, 0.0, 0.0);
    while departure > LINEAR && loops < most {
        // Of all sizes: some points exchange their places only far from where most do.
        let mut number = || ring(uniform) * 10.0_f64.powf(SPREAD * (2.0 * uniform() - 1.0));
        let there = Section { form: [(); COORDINATES + 1].map(|()| number()), t: number(), s: number() };
        let multiple = ring(uniform);
        // The same section, written in another way: a way to it and back is no way to and fro.
        let again = Section { form: there.form.map(|c| c * multiple), t: there.t, s: there.s * multiple };
        let returned = arrived(&arrived(&points, (&home, &there)), (&again, &home));
        lost += points.len() - returned.len();
        let known = points.len();
        points.extend(returned);
        points = distinct(kind, points);
        loops += 1;
        unfruitful = if points.len() > known { 0 } else { unfruitful + 1 };
        if unfruitful >= 2 || loops == most {
            // Of each section and point, in the order of the points at home.
            let mut values: Vec<Vec<[Complex; FUNCTIONS]>> = Vec::with_capacity(SECTIONS);
            for to in &sections {
                values.push(over(&points, to, uniform)?.iter().map(|point| functions(kind, point)).collect());
            }
            (departure, without_one, factor) = departures(&sections, &values);
        }
    }
    let mut at_zero = over(&points, &section(Complex::ZERO), uniform)?;
    // At t = t0 to rounding, where the other points have L = 0.
    let is_at_t = |point: &Point| point.t.norm() < 1e-9;
    let others = at_zero.iter().filter(|point| !is_at_t(point)).count();
    at_zero.retain(is_at_t);
    let together: Vec<Point> = starts.iter().chain(&at_zero).copied().collect();
    let union = distinct(kind, together).len();
    Ok(Traced {
        at_t: at_zero.len(),
        known: starts.len() + at_zero.len() - union,
        others,
        loops: (loops, unfruitful),
        lost,
        departure,
        without_one,
        factor,
    })
}

/// Returns the largest departure of the sums from linear functions of s through the first two sections, the least that is left
/// when one point is left out, and the least factor by which the departure of some sum grows then.
#[expect(clippy::needless_range_loop, reason = "indices follow the functions and the sections")]
fn departures(sections: &[Section; SECTIONS], values: &[Vec<[Complex; FUNCTIONS]>]) -> (f64, f64, f64) {
    let mut departure = 0.0_f64;
    let (mut without, mut factors) = (vec![0.0_f64; values[0].len()], vec![0.0_f64; values[0].len()]);
    for third in 2..SECTIONS {
        let by = (sections[third].s - sections[0].s) / (sections[1].s - sections[0].s);
        for i in 0..FUNCTIONS {
            let of = |point: usize| {
                let [a, b, c] = [0, 1, third].map(|section| values[section][point][i]);
                (c - a - (b - a) * by, a.norm() + c.norm())
            };
            let (mut sum, mut size) = (Complex::ZERO, 0.0);
            for point in 0..without.len() {
                let (off, magnitude) = of(point);
                (sum, size) = (sum + off, size + magnitude);
            }
            departure = departure.max(sum.norm() / size);
            // No sum is known better than to its last digit.
            let known = sum.norm().max(f64::EPSILON * size);
            for point in 0..without.len() {
                let left = (sum - of(point).0).norm();
                without[point] = without[point].max(left / size);
                factors[point] = factors[point].max(left / known);
            }
        }
    }
    let least = |of: Vec<f64>| of.into_iter().fold(f64::INFINITY, f64::min);
    (departure, least(without), least(factors))
}
