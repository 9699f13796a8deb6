//! Interval arithmetic with outward rounding: every end is moved to the next number outwards.

use std::ops::{Add, Mul, Neg, Sub};

/// The interval of all x with low <= x <= high.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

/// The enclosure of pi, which lies between these neighbouring doubles.
const PI: Interval = Interval { low: std::f64::consts::PI, high: 3.141_592_653_589_793_6 };

fn outward(low: f64, high: f64) -> Interval {
    if low <= high { Interval { low: low.next_down(), high: high.next_up() } } else { Interval::EVERYTHING }
}

impl Interval {
    /// The interval of all numbers: no knowledge.
    pub const EVERYTHING: Interval = Interval { low: f64::NEG_INFINITY, high: f64::INFINITY };

    /// Returns the interval of an exact number.
    pub const fn exact(x: f64) -> Self {
        Interval { low: x, high: x }
    }

    /// Returns the enclosure of pi.
    pub const fn pi() -> Self {
        PI
    }

    /// Returns a number in the middle.
    pub fn middle(self) -> f64 {
        0.5 * (self.low + self.high)
    }

    /// Returns an upper bound of the distance of every x from [`Interval::middle`].
    pub fn radius(self) -> f64 {
        let middle = self.middle();
        (self.high - middle).max(middle - self.low).next_up()
    }

    /// Returns an upper bound of every |x|.
    pub fn size(self) -> f64 {
        self.low.abs().max(self.high.abs())
    }

    /// Returns x^2.
    pub fn square(self) -> Self {
        let product = self * self;
        Interval { low: product.low.max(0.0), high: product.high }
    }

    /// Returns x / y; everything if y may be 0.
    pub fn over(self, y: Interval) -> Self {
        if y.low > 0.0 || y.high < 0.0 {
            let ends = [self.low / y.low, self.low / y.high, self.high / y.low, self.high / y.high];
            outward(ends.into_iter().fold(f64::INFINITY, f64::min), largest(&ends))
        } else {
            Interval::EVERYTHING
        }
    }

    /// Returns the root of max(x, 0).
    pub fn root(self) -> Self {
        // NaN stays NaN, of which `outward` makes everything.
        let [low, high] = [self.low, self.high].map(|end| if end < 0.0 { 0.0 } else { end.sqrt() });
        let root = outward(low, high);
        Interval { low: root.low.max(0.0), high: root.high }
    }

    /// Returns cos x and sin x for |x| <= 4, within [-1, 1]; all of [-1, 1] beyond.
    ///
    /// The Taylor series to x^33 at the middle, by Horner; the remainder is below 4^34/34! < 1.1e-18. Both functions
    /// move by no more than their argument.
    pub fn cos_sin(self) -> [Self; 2] {
        let (x, off) = (self.middle(), self.radius());
        if x.is_nan() || x.abs() > 4.0 || off.is_nan() {
            return [Interval { low: -1.0, high: 1.0 }; 2];
        }
        let one = Interval::exact(1.0);
        let square = Interval::exact(x).square();
        let (mut cos, mut sin) = (one, one);
        for k in (1..=16).rev() {
            let k = f64::from(2 * k);
            cos = one - (square * cos).over(Interval::exact(k * (k - 1.0)));
            sin = one - (square * sin).over(Interval::exact(k * (k + 1.0)));
        }
        let off = off + 2e-18;
        [cos, sin * Interval::exact(x)].map(|y| {
            let wide = outward(y.low - off, y.high + off);
            Interval { low: wide.low.next_down().max(-1.0), high: wide.high.next_up().min(1.0) }
        })
    }
}

/// Returns the largest end, or NaN if there is one: [`outward`] makes everything of it.
fn largest(ends: &[f64]) -> f64 {
    ends.iter().fold(f64::NEG_INFINITY, |a, b| if b.is_nan() || *b > a { *b } else { a })
}

impl Add for Interval {
    type Output = Interval;
    fn add(self, y: Interval) -> Interval {
        outward(self.low + y.low, self.high + y.high)
    }
}

impl Sub for Interval {
    type Output = Interval;
    fn sub(self, y: Interval) -> Interval {
        outward(self.low - y.high, self.high - y.low)
    }
}

impl Mul for Interval {
    type Output = Interval;
    fn mul(self, y: Interval) -> Interval {
        let ends = [self.low * y.low, self.low * y.high, self.high * y.low, self.high * y.high];
        if ends.iter().any(|end| end.is_nan()) {
            return Interval::EVERYTHING;
        }
        outward(ends.into_iter().fold(f64::INFINITY, f64::min), largest(&ends))
    }
}

impl Neg for Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        Interval { low: -self.high, high: -self.low }
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;

    #[test]
    fn what_is_not_a_number_is_known_of_nothing() {
        let unknown = Interval::exact(f64::NAN);
        let one = Interval::exact(1.0);
        for x in [unknown.root(), unknown * one, one.over(unknown), unknown - one] {
            assert!(x.high == f64::INFINITY && x.low <= 0.0, "{x:?}");
        }
        assert!((Interval { low: -1.0, high: 4.0 }).root().high >= 2.0);
    }

    #[test]
    fn pi_and_the_functions_are_within() {
        // pi to 21 digits is 3.14159265358979323846: the double below it is 3.141592653589793115997963..
        let pi = Interval::pi();
        assert!(pi.low < pi.high && pi.low.next_up() == pi.high);
        for k in -400..=400 {
            let x = f64::from(k) * 0.01;
            let [cos, sin] = Interval::exact(x).cos_sin();
            assert!(cos.low <= x.cos() && x.cos() <= cos.high && cos.high - cos.low < 1e-13, "{x}: {cos:?}");
            assert!(sin.low <= x.sin() && x.sin() <= sin.high && sin.high - sin.low < 1e-13, "{x}: {sin:?}");
            let [cos, sin] = Interval { low: x - 0.1, high: x + 0.1 }.cos_sin();
            for y in [x - 0.1, x + 0.03, x + 0.1] {
                assert!((cos.low..=cos.high).contains(&y.cos()) || y.abs() > 4.0);
                assert!((sin.low..=sin.high).contains(&y.sin()) || y.abs() > 4.0);
            }
        }
    }

    #[test]
    fn ends_lie_outside_and_nothing_known_stays_so() {
        let third = Interval::exact(1.0).over(Interval::exact(3.0));
        assert!(third.low < 1.0 / 3.0 && 1.0 / 3.0 < third.high);
        let wide = Interval { low: -2.0, high: 3.0 };
        let product = wide * Interval { low: -5.0, high: 1.0 };
        assert!(product.low <= -15.0 && product.high >= 10.0 && product.high < 10.1);
        assert_eq!(Interval::exact(1.0).over(wide), Interval::EVERYTHING);
        assert_eq!(Interval::EVERYTHING * Interval::exact(0.0), Interval::EVERYTHING);
        let root = Interval { low: -1.0, high: 2.0 }.root();
        assert!(root.low == 0.0 && root.high >= 2.0_f64.sqrt());
    }
}
