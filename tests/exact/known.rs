//! Solutions of known targets: published ones, random real and random complex four-bars.

use crate::random;
use linkwright::internals::mechanism::Complex;
use linkwright::internals::numbers::arithmetic::streams::{Stream, normal, uniform, unit};
use linkwright::internals::numbers::nine_point::target::Kind;
use linkwright::internals::numbers::nine_point::target::STEPS;
use linkwright::internals::numbers::nine_point::{Displacements, Solution, Target};
use std::f64::consts::PI;

/// Problem 3 of Wampler, Morgan and Sommese (1992).
pub const WMS3: [[f64; 2]; 9] = [
    [0.25, 0.0],
    [0.52, 0.1],
    [0.8, 0.7],
    [1.2, 1.0],
    [1.4, 1.3],
    [1.1, 1.48],
    [0.7, 1.4],
    [0.2, 1.0],
    [0.02, 0.4],
];
/// Nine points of a normal distribution.
pub const GAUSSIAN: [[f64; 2]; 9] = [
    [0.563696, 0.819245],
    [-0.407692, -1.159878],
    [-1.19531, 0.456999],
    [-0.217442, -0.520968],
    [-0.048303, -0.43511],
    [-0.434687, -1.074071],
    [0.467106, 0.909502],
    [0.458237, -0.185112],
    [0.321842, 1.703739],
];

pub fn target(points: [[f64; 2]; 9]) -> Target {
    Target::new(points.map(|[x, y]| Complex::new(x, y))).expect("nine points")
}

/// A real linkage of the data file.
pub struct Known {
    pub class: usize,
    pub solution: Solution,
}

/// All real linkages through the points of a problem, three cognates a class.
pub fn real_linkages(problem: &str, target: &Target) -> Vec<Known> {
    include_str!("data/real_linkages.csv")
        .lines()
        .filter_map(|line| line.strip_prefix(problem)?.strip_prefix(','))
        .map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|n| n.parse().expect("a number")).collect();
            let place = |i: usize| Complex::new(numbers[i], numbers[i + 1]);
            let solution = with_rotations(target, [place(2), place(4)], [place(6), place(8)]);
            Known { class: numbers[0] as usize, solution }
        })
        .collect()
}

/// The real solution with ground pivots A, B and moving pins D, C: at each point the coupler's rotation of the two that
/// keep |A D| which keeps |B C| better.
///
/// With w = delta - a: |x T + w| = |x - a|  <=>  2 Re(x T conj w) = |x - a|^2 - |x|^2 - |w|^2.
fn with_rotations(target: &Target, grounds: [Complex; 2], pins: [Complex; 2]) -> Solution {
    let inside = |p: Complex| (p - target.points[0]) / target.scale;
    let (grounds, pins) = (grounds.map(inside), pins.map(inside));
    let rotations = target.displacements.delta.map(|delta| {
        let w = delta - grounds[0];
        let side = (pins[0] - grounds[0]).norm_sqr() - pins[0].norm_sqr() - w.norm_sqr();
        let toward = pins[0] * w.conj();
        let turn = (side / (2.0 * toward.norm())).clamp(-1.0, 1.0).acos();
        let miss = |t: Complex| {
            let moved = pins[1] * t + delta - grounds[1];
            (moved.norm_sqr() - (pins[1] - grounds[1]).norm_sqr()).abs()
        };
        let both = [turn, -turn].map(|turn| Complex::from_polar(1.0, turn - toward.arg()));
        if miss(both[0]) < miss(both[1]) { both[0] } else { both[1] }
    });
    real(pins, grounds, rotations)
}

/// A solution whose twins are conjugates.
pub fn real(pins: [Complex; 2], grounds: [Complex; 2], rotations: [Complex; STEPS]) -> Solution {
    let conj = |both: [Complex; 2]| both.map(|z| z.conj());
    Solution { pins, grounds, pins_starred: conj(pins), grounds_starred: conj(grounds), rotations }
}

/// A random real four-bar and nine points of its curve; `None` where the loop does not close at one of them.
pub fn random_real(stream: &mut Stream) -> Option<(Target, Solution)> {
    let kind = random::one_of(stream, &random::TYPES);
    let linkage = random::linkage(stream, kind);
    let traced = random::trace(stream, &linkage, STEPS + 1, None)?;
    let target = Target::new(traced.points.clone().try_into().expect("nine points")).ok()?;
    let inside = |p: Complex| (p - target.points[0]) / target.scale;
    let joints: Vec<_> = traced
        .positions
        .iter()
        .map(|&(angle, assembly)| traced.linkage.position_with(angle, assembly).joints())
        .collect::<Option<_>>()?;
    let coupler = |i: usize| joints[i].follower_pin - joints[i].crank_pin;
    let pins = [joints[0].crank_pin, joints[0].follower_pin].map(inside);
    let grounds = [traced.linkage.crank_pivot(), traced.linkage.follower_pivot()].map(inside);
    let rotations = std::array::from_fn(|j| coupler(j + 1) / coupler(0));
    Some((target, real(pins, grounds, rotations)))
}

/// Nine real points on a real curve whose linkages are complex: x* = conj y, a* = conj b, |T| = 1. `None` where the
/// random numbers allow no such points.
///
/// With u = x T + delta - a, v = y T + delta - b and d = u - v the equation u conj(v) = k is u = d (p + i q) with |d|^2
/// q = -Im k and |d|^2 (p^2 - p + q^2) = Re k.
pub fn random_real_curve(stream: &mut Stream) -> Option<(Target, Solution)> {
    let [x, y, a, b] = [(); 4].map(|()| gaussian(stream));
    let k = (x - a) * (y - b).conj();
    let (mut points, mut rotations) = ([Complex::ZERO; STEPS + 1], [Complex::ZERO; STEPS]);
    for j in 0..STEPS {
        let t = Complex::from_polar(1.0, uniform(stream, -PI, PI));
        let d = (x - y) * t - (a - b);
        let (q, re) = (-k.im / d.norm_sqr(), k.re / d.norm_sqr());
        let under = 0.25 - q * q + re;
        if under < 0.0 {
            return None;
        }
        let root = if unit(stream) < 0.5 { under.sqrt() } else { -under.sqrt() };
        points[j + 1] = d * Complex::new(0.5 + root, q) - x * t + a;
        rotations[j] = t;
    }
    let target = Target::new(points).ok()?;
    let scaled = |both: [Complex; 2]| both.map(|z| z / target.scale);
    let (pins, grounds) = (scaled([x, y]), scaled([a, b]));
    let exchanged = |[one, two]: [Complex; 2]| [two.conj(), one.conj()];
    let (pins_starred, grounds_starred) = (exchanged(pins), exchanged(grounds));
    Some((target, Solution { pins, grounds, pins_starred, grounds_starred, rotations }))
}

fn gaussian(stream: &mut Stream) -> Complex {
    Complex::new(normal(stream, 0.0, 1.0), normal(stream, 0.0, 1.0))
}

/// Random complex pivots and rotations, and displacements that they solve to rounding.
///
/// With alpha_k = p_k T - g_k, beta_k = p*_k / T - g*_k and K_k = (p_k - g_k)(p*_k - g*_k) the difference of the two
/// equations (delta + alpha_k)(delta* + beta_k) = K_k is linear: delta* = e - f delta. The first is then a quadratic.
pub fn random_complex(stream: &mut Stream) -> (Displacements, Solution) {
    let mut two = || [gaussian(stream), gaussian(stream)];
    let (pins, grounds, pins_starred, grounds_starred) = (two(), two(), two(), two());
    let rotations: [Complex; STEPS] = std::array::from_fn(|_| gaussian(stream));
    let both = rotations.map(|t| {
        let alpha = [0, 1].map(|k| pins[k] * t - grounds[k]);
        let beta = [0, 1].map(|k| pins_starred[k] / t - grounds_starred[k]);
        let k = [0, 1].map(|k| (pins[k] - grounds[k]) * (pins_starred[k] - grounds_starred[k]));
        let across = alpha[0] - alpha[1];
        let e = (k[0] - k[1] - alpha[0] * beta[0] + alpha[1] * beta[1]) / across;
        let f = (beta[0] - beta[1]) / across;
        // (delta + alpha)(e + beta - f delta) = K: f delta^2 - (e + beta - f alpha) delta + K - alpha (e + beta) = 0.
        let (linear, constant) = (e + beta[0] - f * alpha[0], k[0] - alpha[0] * (e + beta[0]));
        let delta = (linear + (linear * linear - f * constant * 4.0).sqrt()) / (f * 2.0);
        (delta, e - f * delta)
    });
    let displacements =
        Displacements { delta: both.map(|b| b.0), starred: both.map(|b| b.1), kind: Kind::default() };
    (displacements, Solution { pins, grounds, pins_starred, grounds_starred, rotations })
}
