//! Taylor models of second degree: functions over a box, enclosed by a polynomial and an interval for the remainder
//! (the rest).
//!
//! A [`Model`] represents every function of e in [-1, 1]^4 that differs from
//! `c[0] + sum c[k] e_k + sum c[kl] e_k e_l` by no more than `rest`. The parts that an operation leaves out (terms of
//! third degree and above, the ends of series, rounding) go into the rest; its sums are of non-negative numbers, at
//! most 64 of them, and are enlarged by [`UP`].

use super::interval::Interval;

/// The number of terms: 1, four linear ones, ten of second degree: 00 01 02 03 11 12 13 22 23 33.
const TERMS: usize = 15;
/// Indices of the terms of second degree.
const PLACE: [[usize; 4]; 4] = [[5, 6, 7, 8], [6, 9, 10, 11], [7, 10, 12, 13], [8, 11, 13, 14]];
/// A factor above the rounding of a sum of 64 non-negative numbers.
pub const UP: f64 = 1.0 + 1e-13;
/// Twice the unit roundoff.
const EPS: f64 = f64::EPSILON;
/// A bound above everything that underflow can do.
const TINY: f64 = 1e-290;

/// A polynomial of second degree with a bound of the remainder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Model {
    c: [f64; TERMS],
    rest: f64,
}

/// The sizes of a model's parts, rounded up.
#[derive(Clone, Copy)]
struct Sizes {
    linear: f64,
    second: f64,
    /// The size of the whole polynomial.
    all: f64,
}

impl Model {
    /// Returns the model of a constant.
    pub fn constant(x: Interval) -> Self {
        let mut c = [0.0; TERMS];
        c[0] = x.middle();
        Model { c, rest: x.radius() }
    }

    /// Returns the model of anything within `rest` of 0.
    pub fn within(rest: f64) -> Self {
        Model { c: [0.0; TERMS], rest }
    }

    /// Returns the model of centre + half * e_k, with an allowance for rounding.
    pub fn variable(centre: f64, half: f64, k: usize) -> Self {
        let mut c = [0.0; TERMS];
        c[0] = centre;
        c[1 + k] = half;
        Model { c, rest: TINY }
    }

    /// Returns the models of cos and sin of centre + half * e_k: cos(x + y) = cos x - y sin x - y^2/2 cos x + .., the
    /// rest below |y|^3/6.
    pub fn cos_sin(centre: f64, half: f64, k: usize) -> [Self; 2] {
        let [cos, sin] = Interval::exact(centre).cos_sin();
        let curve = 0.5 * half * half;
        let one = |value: Interval, slope: Interval| {
            let mut c = [0.0; TERMS];
            c[0] = value.middle();
            c[1 + k] = half * slope.middle();
            c[PLACE[k][k]] = -curve * c[0];
            let known = value.radius() * (1.0 + curve) + half * slope.radius();
            let rounding = EPS * (1.0 + half + 4.0 * curve) + TINY;
            Model { c, rest: (known + half * half * half / 6.0 + rounding) * UP }
        };
        [one(cos, -sin), one(sin, cos)]
    }

    fn sizes(&self) -> Sizes {
        let linear: f64 = self.c[1..5].iter().map(|c| c.abs()).sum();
        let second: f64 = self.c[5..].iter().map(|c| c.abs()).sum();
        Sizes { linear, second, all: (self.c[0].abs() + linear + second) * UP }
    }

    /// Returns an upper bound of every absolute value.
    pub fn size(&self) -> f64 {
        (self.sizes().all + self.rest) * UP
    }

    /// Returns the value in the middle, up to the rest.
    pub fn middle(&self) -> f64 {
        self.c[0]
    }

    /// Returns the bound of the distance from the polynomial.
    pub fn rest(&self) -> f64 {
        self.rest
    }

    /// Returns whether the rest is small enough for the model to be of use.
    pub fn is_known(&self) -> bool {
        self.rest < 1e3
    }

    /// Returns the size of its change along axis `k`.
    pub fn change(&self, k: usize) -> f64 {
        let second: f64 = PLACE[k].iter().map(|place| self.c[*place].abs()).sum();
        self.c[1 + k].abs() + second
    }

    /// Returns the size of its terms of second degree along axis `k`.
    pub fn curve(&self, k: usize) -> f64 {
        PLACE[k].iter().map(|place| self.c[*place].abs()).sum()
    }

    /// Returns x + y.
    pub fn plus(&self, y: &Model) -> Self {
        let mut c = self.c;
        let mut size = 0.0;
        for (c, y) in c.iter_mut().zip(&y.c) {
            *c += y;
            size += c.abs();
        }
        Model { c, rest: (self.rest + y.rest + EPS * size + TINY) * UP }
    }

    /// Returns x - y.
    pub fn minus(&self, y: &Model) -> Self {
        self.plus(&Model { c: y.c.map(|c| -c), rest: y.rest })
    }

    /// Returns 1 - x.
    pub fn from_one(&self) -> Self {
        Model::constant(Interval::exact(1.0)).minus(self)
    }

    /// Returns x times a number.
    pub fn times(&self, factor: Interval) -> Self {
        let by = factor.middle();
        let c = self.c.map(|c| c * by);
        let size = self.sizes().all;
        let off = factor.radius();
        let rest = by.abs() * self.rest + off * (size + self.rest) + EPS * by.abs() * size + TINY;
        Model { c, rest: rest * UP }
    }

    /// Returns x y.
    pub fn by(&self, y: &Model) -> Self {
        let (a, b) = (&self.c, &y.c);
        let mut c = [0.0; TERMS];
        for i in 0..TERMS {
            c[i] = a[0] * b[i] + a[i] * b[0];
        }
        c[0] = a[0] * b[0];
        for k in 0..4 {
            for l in 0..4 {
                c[PLACE[k][l]] += a[1 + k] * b[1 + l];
            }
        }
        let (s, t) = (self.sizes(), y.sizes());
        let left_out = s.linear * t.second + s.second * (t.linear + t.second);
        let known = self.rest * (t.all + y.rest) + s.all * y.rest;
        // Each coefficient is a sum of at most four products: within 4 half-units of the sum of their sizes.
        let rounding = 4.0 * EPS * s.all * t.all;
        Model { c, rest: (left_out + known + rounding + TINY) * UP }
    }

    /// Returns x^2.
    pub fn square(&self) -> Self {
        self.by(self)
    }

    /// Returns x / c_0 - 1 with its size; `None` unless c_0 is positive (above 1e-12).
    fn relative(&self) -> Option<(Model, f64)> {
        let centre = self.c[0];
        if centre.is_nan() || centre <= 1e-12 {
            return None;
        }
        let mut rest = *self;
        rest.c[0] = 0.0;
        let x = rest.times(Interval::exact(1.0).over(Interval::exact(centre)));
        let size = x.size();
        Some((x, size))
    }

    /// Returns 1/sqrt x: the series of (1 + y)^(-1/2) to y^2, the rest below 5/16 |y|^3/(1 - |y|), its coefficients
    /// decreasing.
    pub fn inverse_root(&self) -> Option<Self> {
        let (y, size) = self.relative()?;
        if size.is_nan() || size > 0.8 {
            return None;
        }
        let series = y
            .times(Interval::exact(-0.5))
            .plus(&y.square().times(Interval::exact(0.375)))
            .plus(&Model::constant(Interval::exact(1.0)));
        let rest = 0.3125 * size * size * size / (1.0 - size) * UP;
        let root = Interval::exact(self.c[0]).root();
        Some(series.plus(&Model::within(rest * UP)).times(Interval::exact(1.0).over(root)))
    }

    /// Returns sqrt x of a number that is known to lie in [0, 1].
    ///
    /// The series of (1 + y)^(1/2) to y^2, the rest below |y|^3/16/(1 - |y|); or, if y is large, the line that is
    /// best over [A^2, B^2]: s/(A + B) + (A + B)/8 + A B/(2 (A + B)), within (B - A)^2/(8 (A + B)).
    pub fn root(&self) -> Self {
        if let Some((y, size)) = self.relative()
            && size < 0.5
        {
            let series = y
                .times(Interval::exact(0.5))
                .plus(&y.square().times(Interval::exact(-0.125)))
                .plus(&Model::constant(Interval::exact(1.0)));
            let rest = size * size * size / 16.0 / (1.0 - size) * UP;
            return series.plus(&Model::within(rest * UP)).times(Interval::exact(self.c[0]).root());
        }
        let sizes = self.sizes();
        let spread = (sizes.linear + sizes.second + self.rest) * UP + EPS * self.c[0].abs();
        let low = (self.c[0] - spread).next_down().clamp(0.0, 1.0);
        let high = (self.c[0] + spread).next_up().clamp(0.0, 1.0);
        if spread.is_nan() || high <= 0.0 {
            return Model::within(1.0);
        }
        let (a, b) = (Interval::exact(low).root(), Interval::exact(high).root());
        let sum = a + b;
        let eighth = Interval::exact(0.125);
        let between = (a * b).over(sum + sum) + sum * eighth;
        let off = (b - a).square().over(sum) * eighth;
        let line = self.times(Interval::exact(1.0).over(sum)).plus(&Model::constant(between));
        Model { c: line.c, rest: (line.rest + off.high) * UP }
    }

    /// Returns a lower bound of every value: each axis alone exactly, mixed terms by their sizes.
    pub fn lowest(&self) -> f64 {
        let mut low = self.c[0];
        let mut size = self.c[0].abs();
        for (k, places) in PLACE.iter().enumerate() {
            let (slope, curve) = (self.c[1 + k].abs(), self.c[places[k]]);
            // The least of curve e^2 - slope e over [0, 1].
            low += if slope < 2.0 * curve { -slope * slope / (4.0 * curve) } else { curve - slope };
            size += slope + curve.abs();
            for mixed in &places[k + 1..] {
                low -= self.c[*mixed].abs();
                size += self.c[*mixed].abs();
            }
        }
        low - self.rest * UP - 32.0 * EPS * size - TINY
    }

    /// Returns an upper bound of every value.
    pub fn highest(&self) -> f64 {
        -Model { c: self.c.map(|c| -c), rest: self.rest }.lowest()
    }
}

/// Sums of models times numbers, with the rounding of all counted at the end.
#[derive(Clone, Copy, Debug)]
pub struct Sum {
    c: [f64; TERMS],
    rest: f64,
    size: f64,
    terms: f64,
}

impl Sum {
    /// The empty sum.
    pub const EMPTY: Sum = Sum { c: [0.0; TERMS], rest: 0.0, size: 0.0, terms: 0.0 };

    /// Adds `factor` x, where |x| <= `size`.
    pub fn add(&mut self, factor: f64, x: &Model, size: f64) {
        for (c, x) in self.c.iter_mut().zip(&x.c) {
            *c += factor * x;
        }
        self.rest += factor.abs() * x.rest;
        self.size += factor.abs() * size;
        self.terms += 1.0;
    }

    /// Adds an unknown function whose size is at most `rest`.
    pub fn add_unknown(&mut self, rest: f64) {
        self.rest += rest;
        self.terms += 1.0;
    }

    /// Returns the model of the sum, moved by no more than `slack`.
    pub fn model(&self, slack: f64) -> Model {
        // A sum of m products is within (m + 1) half-units of the sum of their sizes, a sum of m sizes likewise.
        let up = 1.0 + (self.terms + 8.0) * EPS;
        let rounding = (self.terms + 2.0) * EPS * self.size;
        Model { c: self.c, rest: (self.rest + rounding + slack + TINY) * up * UP }
    }
}

#[cfg(test)]
mod tests {
    use super::{Model, PLACE, Sum};
    use crate::interval::Interval;

    /// Returns whether `value` is within the rest of the polynomial at e, and within the bounds.
    fn holds(model: &Model, e: [f64; 4], value: f64) -> bool {
        let mut sum = model.c[0];
        for k in 0..4 {
            sum += model.c[1 + k] * e[k];
            for l in k..4 {
                sum += model.c[PLACE[k][l]] * e[k] * e[l];
            }
        }
        (value - sum).abs() <= model.rest + 1e-13
            && (model.lowest() <= value + 1e-13 && value <= model.highest() + 1e-13)
            && value.abs() <= model.size() + 1e-13
    }

    #[test]
    fn every_operation_encloses_the_function() {
        // A sequence of numbers in [-1, 1] that fills the box.
        let mut state = 0.5_f64;
        let mut draw = move || {
            state = (state + 0.618_033_988_749_894_9).fract();
            let x = (state * 7919.0).fract();
            2.0 * x - 1.0
        };
        let mut lines = 0;
        for round in 0..400 {
            let half = [0, 1, 2, 3].map(|_| 10.0_f64.powf(-1.5 - draw()));
            let centre = [0, 1, 2, 3].map(|_| 1.5 * draw());
            let x = Model::variable(centre[0], half[0], 0);
            let y = Model::variable(centre[3], half[3], 3);
            let [cos_1, sin_1] = Model::cos_sin(centre[1], half[1], 1);
            let [cos_2, sin_2] = Model::cos_sin(centre[2], half[2], 2);
            let factor = Interval { low: 1.9, high: 2.1 };
            let mixed = x.by(&cos_1).plus(&y.times(factor)).minus(&sin_2.square());
            let positive = mixed.square().plus(&Model::constant(Interval::exact(0.3)));
            let unit = cos_1.by(&cos_2).square();
            let hidden = unit.root();
            let nearly = sin_1.square().from_one().root();
            lines += usize::from(unit.middle() < 0.02);
            for _ in 0..20 {
                let e = if round % 2 == 0 { [0; 4].map(|_| draw()) } else { [0; 4].map(|_| draw().signum()) };
                let at = |k: usize| centre[k] + half[k] * e[k];
                let (a, b, c, d) = (at(0), at(1), at(2), at(3));
                for by in [1.9, 2.0, 2.1] {
                    let value = a * b.cos() + d * by - c.sin() * c.sin();
                    assert!(holds(&mixed, e, value), "{centre:?} {half:?}");
                    assert!(holds(&positive, e, value * value + 0.3), "{centre:?} {half:?}");
                    if let Some(root) = positive.inverse_root() {
                        assert!(holds(&root, e, 1.0 / (value * value + 0.3).sqrt()), "{centre:?} {half:?}");
                    }
                }
                assert!(holds(&hidden, e, (b.cos() * c.cos()).abs()), "{centre:?} {half:?}");
                assert!(holds(&nearly, e, b.cos().abs()), "{centre:?} {half:?}");
                let mut sum = Sum::EMPTY;
                sum.add(3.0, &x, x.size());
                sum.add(-2.0, &cos_1, cos_1.size());
                sum.add_unknown(0.5);
                let sum = sum.model(0.1);
                for more in [-0.6, 0.0, 0.6] {
                    assert!(holds(&sum, e, 3.0 * a - 2.0 * b.cos() + more), "{centre:?} {half:?}");
                }
            }
        }
        assert!(lines > 5, "{lines}: roots near 0 were among them");
    }
}
