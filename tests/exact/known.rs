//! Known answers: every real linkage of two nine-point problems, from an independent complete solution.

use linkwright::exact::{Solution, Target};
use linkwright::linkage::{Complex, point};
use nalgebra::{SMatrix, SVector};

/// A row of `data/*-real.csv`.
#[derive(Debug)]
pub struct Known {
    /// A, B.
    pub grounds: [Complex; 2],
    /// Their pins at the first point.
    pub pins: [Complex; 2],
    /// The third pivot.
    pub third: Complex,
    /// grashof, one_circuit, in_order, one_branch.
    pub flags: [bool; 4],
}

/// Problem 3 of Wampler, Morgan and Sommese.
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

/// Nine points drawn from a normal distribution.
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

pub fn wms3() -> (Target, Vec<Known>) {
    (target(WMS3), read(include_str!("data/wms3-real.csv")))
}

pub fn gaussian() -> (Target, Vec<Known>) {
    (target(GAUSSIAN), read(include_str!("data/gaussian-real.csv")))
}

pub fn target(points: [[f64; 2]; 9]) -> Target {
    Target::new(points.map(point)).expect("nine different points")
}

fn read(text: &str) -> Vec<Known> {
    let rows = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    rows.map(|line| {
        let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let at = |i: usize| Complex::new(numbers[2 * i], numbers[2 * i + 1]);
        Known {
            grounds: [at(0), at(1)],
            pins: [at(2), at(3)],
            third: at(4),
            flags: std::array::from_fn(|i| numbers[10 + i] == 1.0),
        }
    })
    .collect()
}

impl Known {
    /// The solution: the turns T_j from |x T_j + delta_j - a| = |x - a|, which has two roots for each link (the one
    /// that they share), then Newton's method on the sixteen real equations.
    pub fn solution(&self, target: &Target) -> Solution {
        let relative = |z: Complex| (z - target.points[0]) / target.scale;
        let mut pins = self.pins.map(relative);
        let mut grounds = self.grounds.map(relative);
        let delta = target.displacements.delta;
        let length_sq = |k: usize, x: [Complex; 2], a: [Complex; 2]| (x[k] - a[k]).norm_sqr();
        let lack = |k: usize, j: usize, t: Complex, x: [Complex; 2], a: [Complex; 2]| {
            (x[k] * t + delta[j] - a[k]).norm_sqr() - length_sq(k, x, a)
        };
        let mut turns = delta.map(|_| 0.0);
        for j in 0..8 {
            // Re(T w) = m with w = x conj(delta - a).
            let w = pins[0] * (delta[j] - grounds[0]).conj();
            let m =
                (length_sq(0, pins, grounds) - pins[0].norm_sqr() - (delta[j] - grounds[0]).norm_sqr()) / 2.0;
            let half = (m / w.norm()).clamp(-1.0, 1.0).acos();
            let roots = [half - w.arg(), -half - w.arg()];
            let off = |angle: f64| lack(1, j, Complex::from_polar(1.0, angle), pins, grounds).abs();
            turns[j] = if off(roots[1]) < off(roots[0]) { roots[1] } else { roots[0] };
        }
        for _ in 0..4 {
            let mut rows = SMatrix::<f64, 16, 16>::zeros();
            let mut rest = SVector::<f64, 16>::zeros();
            for k in 0..2 {
                for j in 0..8 {
                    let (row, t) = (8 * k + j, Complex::from_polar(1.0, turns[j]));
                    let (link, first) = (pins[k] * t + delta[j] - grounds[k], pins[k] - grounds[k]);
                    let by_pin = (link * t.conj() - first) * 2.0;
                    let by_ground = (first - link) * 2.0;
                    let by_turn = link.conj() * pins[k] * t * Complex::new(0.0, 1.0) * 2.0;
                    rest[row] = lack(k, j, t, pins, grounds);
                    (rows[(row, 4 * k)], rows[(row, 4 * k + 1)]) = (by_pin.re, by_pin.im);
                    (rows[(row, 4 * k + 2)], rows[(row, 4 * k + 3)]) = (by_ground.re, by_ground.im);
                    rows[(row, 8 + j)] = by_turn.re;
                }
            }
            let step = rows.lu().solve(&rest).expect("a regular solution");
            for k in 0..2 {
                pins[k] -= Complex::new(step[4 * k], step[4 * k + 1]);
                grounds[k] -= Complex::new(step[4 * k + 2], step[4 * k + 3]);
            }
            for j in 0..8 {
                turns[j] -= step[8 + j];
            }
        }
        Solution {
            pins,
            grounds,
            pins_starred: pins.map(|z| z.conj()),
            grounds_starred: grounds.map(|z| z.conj()),
            rotations: turns.map(|angle| Complex::from_polar(1.0, angle)),
        }
    }
}
