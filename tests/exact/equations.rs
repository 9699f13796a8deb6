//! The linearised equations beside dual numbers, the symmetries, the elimination.

use linkwright::internals::mechanism::Complex;
use linkwright::internals::numbers::arithmetic::complex_lanes::ComplexLanes;
use linkwright::internals::numbers::nine_point::equations::{UNKNOWNS, residuals, solution, steps, unknowns};
use linkwright::internals::numbers::nine_point::start::StartSet;
use linkwright::internals::numbers::nine_point::target::{Closure, Kind};
use linkwright::internals::numbers::nine_point::{Displacements, Solution};
use nalgebra::{DMatrix, DVector};
use num_dual::Dual64;

/// A complex number of dual numbers.
#[derive(Clone, Copy)]
struct Dual {
    re: Dual64,
    im: Dual64,
}

impl Dual {
    fn new(z: Complex, moved: bool) -> Dual {
        let re = if moved { Dual64::from_re(z.re).derivative() } else { Dual64::from_re(z.re) };
        Dual { re, im: Dual64::from_re(z.im) }
    }
    fn slope(self) -> Complex {
        Complex::new(self.re.eps, self.im.eps)
    }
    fn plus(self, o: Dual) -> Dual {
        Dual { re: self.re + o.re, im: self.im + o.im }
    }
    fn minus(self, o: Dual) -> Dual {
        Dual { re: self.re - o.re, im: self.im - o.im }
    }
    fn times(self, o: Dual) -> Dual {
        Dual { re: self.re * o.re - self.im * o.im, im: self.re * o.im + self.im * o.re }
    }
    fn inverse(self) -> Dual {
        let size = self.re * self.re + self.im * self.im;
        Dual { re: self.re / size, im: -(self.im / size) }
    }
}

/// The sixteen equations as the module's first lines print them, with the unknown or displacement `moved` moved along
/// its real part: holomorphic functions need no more. Numbers: x, x - a, .. as in `Unknowns`, then delta, delta*.
fn slopes(of: &Solution, at: &Displacements, moved: usize) -> [Complex; UNKNOWNS] {
    let z = unknowns(of);
    let number = |i: usize| match i {
        i if i < UNKNOWNS => Dual::new(z[i], i == moved),
        i if i < UNKNOWNS + 8 => Dual::new(at.delta[i - UNKNOWNS], i == moved),
        i => Dual::new(at.starred[i - UNKNOWNS - 8], i == moved),
    };
    std::array::from_fn(|row| {
        let (leg, j) = (row / 8, row % 8);
        let kind = at.kind;
        if let Some(link) = j.checked_sub(kind.places()).filter(|link| *link < kind.pivots) {
            let [pin, arm] = [0, 1].map(|i| number(4 * link + 2 * leg + i));
            return pin.minus(arm).minus(number(UNKNOWNS + 8 * leg + j)).slope();
        }
        if kind.is_normal(j) && leg == 1 {
            let (n, n_s) = (number(UNKNOWNS + j), number(UNKNOWNS + 8 + j));
            return n_s.times(number(5)).plus(n.times(number(7))).slope();
        }
        if j >= kind.lengths() {
            let t = number(8 + kind.spare(j)[leg]).plus(Dual::new(Complex::ONE, false));
            return t.times(number(UNKNOWNS + 8 + j)).minus(number(UNKNOWNS + j)).slope();
        }
        let [x, u, x_s, u_s] = [0, 1, 2, 3].map(|i| number(4 * leg + i));
        let (a, a_s) = (x.minus(u), x_s.minus(u_s));
        let t = number(8 + j).plus(Dual::new(Complex::ONE, false));
        let (delta, starred, one) =
            (number(UNKNOWNS + j), number(UNKNOWNS + 8 + j), Dual::new(Complex::ONE, false));
        if leg == 1 && kind.closure == Closure::SliderCrank {
            let m = x.times(t.minus(one)).plus(delta);
            let m_s = x_s.times(t.inverse().minus(one)).plus(starred);
            return u.times(m_s).plus(u_s.times(m)).slope();
        }
        if leg == 1 && kind.closure == Closure::InvertedSliderCrank {
            let n = a.minus(delta).times(t.inverse()).minus(a);
            let n_s = a_s.minus(starred).times(t).minus(a_s);
            return u.times(n_s).plus(u_s.times(n)).slope();
        }
        let l = x.times(t).plus(number(UNKNOWNS + j)).minus(a);
        let r = x_s.times(t.inverse()).plus(number(UNKNOWNS + 8 + j)).minus(a_s);
        l.times(r).minus(x.minus(a).times(x_s.minus(a_s))).slope()
    })
}

/// Entries of the start set, moved a little so that they are no solutions.
fn places(kind: Kind) -> (Displacements, Vec<Solution>) {
    let set = StartSet::embedded(kind);
    let move_ =
        |(i, z): (usize, &Complex)| z * Complex::new(1.0 + 1e-3 * (i as f64).sin(), 1e-3 * (i as f64).cos());
    let places = set.solutions.iter().step_by(set.solutions.len().div_ceil(8)).map(|s| {
        let z: Vec<Complex> = unknowns(s).iter().enumerate().map(move_).collect();
        solution(&std::array::from_fn(|i| z[i]))
    });
    (set.displacements, places.collect())
}

#[test]
fn both_steps_solve_the_equations_that_dual_numbers_linearise() {
    Kind::known().for_each(both_steps_of);
}

fn both_steps_of(kind: Kind) {
    let (at, places) = places(kind);
    assert!((kind.classes().min(6)..=8).contains(&places.len()), "{kind:?}: {}", places.len());
    let velocity = Displacements {
        delta: std::array::from_fn(|j| Complex::new(0.3 + j as f64, (j as f64).sin())),
        starred: std::array::from_fn(|j| Complex::new((j as f64).cos(), 1.7 - j as f64)),
        kind,
    };
    let mut lanes = [ComplexLanes::ZERO; UNKNOWNS];
    for (lane, place) in places.iter().enumerate() {
        for (z, value) in lanes.iter_mut().zip(unknowns(place)) {
            z.set(lane, value);
        }
    }
    let ([newton, tangent], smallest) =
        steps::<2>(&lanes, &at.map(ComplexLanes::splat), &velocity.map(ComplexLanes::splat));
    for (lane, place) in places.iter().enumerate() {
        let columns: Vec<_> = (0..UNKNOWNS + 16).map(|i| slopes(place, &at, i)).collect();
        let jacobian = DMatrix::from_fn(UNKNOWNS, UNKNOWNS, |row, column| columns[column][row]);
        let f = residuals(place, &at);
        let moving = |row: usize| -> Complex {
            let by_delta = (0..8).map(|j| columns[UNKNOWNS + j][row] * velocity.delta[j]).sum::<Complex>();
            by_delta + (0..8).map(|j| columns[UNKNOWNS + 8 + j][row] * velocity.starred[j]).sum::<Complex>()
        };
        let sides = [
            DVector::from_fn(UNKNOWNS, |row, _| -f[row / 8][row % 8]),
            DVector::from_fn(UNKNOWNS, |row, _| -moving(row)),
        ];
        for (side, answer) in sides.iter().zip([&newton, &tangent]) {
            let answer = DVector::from_fn(UNKNOWNS, |i, _| answer[i].get(lane));
            let left = (&jacobian * &answer - side).norm();
            // Backward stability: the residual is rounding of the terms that were added up.
            let terms = jacobian.norm() * answer.norm() + side.norm();
            assert!(left < 1e-11 * terms, "lane {lane}: {left:e} of {terms:e}");
            assert!(answer.norm() > 0.0);
        }
        assert!(smallest.0[lane] > 0.0);
    }
}

#[test]
fn the_six_images_of_a_solution_are_solutions() {
    let set = StartSet::embedded(Kind::default());
    for entry in set.solutions.iter().step_by(97) {
        for (which, image) in entry.images(&set.displacements).iter().enumerate() {
            let size = unknowns(image).iter().map(|z| z.norm()).fold(1.0, f64::max);
            let left =
                residuals(image, &set.displacements).iter().flatten().map(|f| f.norm()).fold(0.0, f64::max);
            assert!(left < 1e-9 * size * size, "image {which}: {left:e}, size {size:e}");
        }
        let [_, _, second, ..] = entry.images(&set.displacements);
        let back = second.cognate(&set.displacements);
        for (z, w) in unknowns(entry).iter().zip(unknowns(&back)) {
            assert!((z - w).norm() < 1e-9 * (1.0 + z.norm()), "{z} is not {w}");
        }
    }
}
