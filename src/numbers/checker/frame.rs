//! The target in intervals: the directions 1, e and T' with bounds of their errors.

use super::interval::Interval;

pub(super) type Complex = [Interval; 2];

/// The frame of some of the points, in one direction of the crank.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Indices of these points in the whole target.
    pub points: Vec<usize>,
    /// 1/sqrt n, e' and tau = T'/|T'|: orthonormal, rounded.
    pub basis: [Vec<[f64; 2]>; 3],
    /// An upper bound of the distance of a rounded direction from the exact one.
    pub error: f64,
    /// The squared length |T'|^2.
    pub size_sq: Interval,
    /// <e'/|e'|, T>: the target's part along e'.
    pub(super) along: Complex,
    /// The length |e'|.
    pub crank: Interval,
}

pub(super) fn times(x: Complex, y: Complex) -> Complex {
    [x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]]
}

pub(super) fn conjugate(x: Complex) -> Complex {
    [x[0], -x[1]]
}

fn norm_sq(v: &[Complex]) -> Interval {
    v.iter().fold(Interval::exact(0.0), |sum, x| sum + x[0].square() + x[1].square())
}

/// Computes the inner product <b, v>.
fn product(b: &[Complex], v: &[Complex]) -> Complex {
    b.iter().zip(v).fold([Interval::exact(0.0); 2], |sum, (b, v)| {
        let product = times(conjugate(*b), *v);
        [sum[0] + product[0], sum[1] + product[1]]
    })
}

/// Computes v less its part along the unit vector b.
fn off(v: &[Complex], b: &[Complex]) -> Vec<Complex> {
    let along = product(b, v);
    b.iter()
        .zip(v)
        .map(|(b, v)| {
            let part = times(*b, along);
            [v[0] - part[0], v[1] - part[1]]
        })
        .collect()
}

fn unit(v: &[Complex]) -> Vec<Complex> {
    let length = norm_sq(v).root();
    v.iter().map(|x| x.map(|x| x.over(length))).collect()
}

/// Encloses e^{i direction delta} for an increment in degrees.
pub fn turn(delta_deg: f64, direction: f64) -> Complex {
    // The remainder is exact, and so is taking off a whole turn.
    let rest = delta_deg % 360.0;
    let rest = if rest > 180.0 { rest - 360.0 } else { rest };
    let rest = if rest < -180.0 { rest + 360.0 } else { rest };
    let angle = Interval::exact(rest) * Interval::pi().over(Interval::exact(180.0));
    (if direction < 0.0 { -angle } else { angle }).cos_sin()
}

impl Frame {
    /// Creates the frame of the points `which`, whose crank turns are given, with A free or (`at_origin`) 0; `None`
    /// if they are too much alike.
    pub fn new(all: &[Complex], turns: &[Complex], which: Vec<usize>, at_origin: bool) -> Option<Self> {
        let zero = Interval::exact(0.0);
        let ones = vec![[Interval::exact(1.0), zero]; which.len()];
        let crank: Vec<Complex> = which.iter().filter_map(|j| turns.get(*j).copied()).collect();
        let target: Vec<Complex> = which.iter().filter_map(|j| all.get(*j).copied()).collect();
        let first = if at_origin { vec![[zero; 2]; which.len()] } else { unit(&ones) };
        let crank = off(&crank, &first);
        let second = unit(&crank);
        let target = off(&target, &first);
        let along = product(&second, &target);
        let rest = off(&target, &second);
        let size_sq = norm_sq(&rest);
        let basis = [first, second, unit(&rest)];
        let error = basis.iter().map(|b| {
            let sum: f64 = b.iter().flatten().map(|x| x.radius() * x.radius()).sum();
            sum.sqrt() * 1.001
        });
        let error = error.fold(0.0, |worst: f64, e| if e <= worst { worst } else { e });
        (error < 1e-9 && size_sq.low > 0.0).then(|| Frame {
            points: which,
            basis: basis.map(|b| b.iter().map(|x| x.map(Interval::middle)).collect()),
            error,
            size_sq,
            along,
            crank: norm_sq(&crank).root(),
        })
    }
}
