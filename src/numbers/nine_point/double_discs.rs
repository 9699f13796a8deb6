//! Discs with double-double midpoints: enclosures that stay narrow where differences cancel.
//!
//! As [`super::discs`], with the rounding of the midpoints below e = [`RELATIVE_ERROR`] an operation: a sum errs by
//! at most e |z + w|, a product by at most 4 e |z| |w| (two products of parts and their sum, both parts), and by less
//! than 2^-1022 where parts underflow. Twice that also covers the use of the rounded result's magnitude in place of
//! the exact one's.

use super::discs::{Disc, Upper};
use linkwright_arithmetic::Complex;
use linkwright_arithmetic::double_double::{DoubleComplex, RELATIVE_ERROR};
use linkwright_arithmetic::operators;

/// The disc |z - mid| <= radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoubleDisc {
    /// Its midpoint.
    pub mid: DoubleComplex,
    /// Its radius.
    pub radius: Upper,
}

impl DoubleDisc {
    /// Returns the disc of one number, of radius zero.
    pub fn point(mid: DoubleComplex) -> Self {
        DoubleDisc { mid, radius: Upper::ZERO }
    }

    /// Returns a disc of doubles that contains it.
    pub fn rounded(&self) -> Disc {
        Disc::about(self.mid, self.radius)
    }

    /// Returns the disc of the conjugates.
    pub fn conj(self) -> Self {
        DoubleDisc { mid: self.mid.conj(), radius: self.radius }
    }

    /// Returns a disc that contains 1/z for every member z; `None` when the disc contains or all but contains zero.
    /// As [`Disc::inverse`].
    pub fn inverse(self) -> Option<Self> {
        let least = self.rounded().least_magnitude();
        let one = DoubleComplex::from(Complex::ONE);
        let near = one / self.mid;
        if least <= 0.0 || !near.to_complex().is_finite() {
            return None;
        }
        let rest = DoubleDisc::point(one) - DoubleDisc::point(near) * DoubleDisc::point(self.mid);
        let spread = rest.rounded().magnitude() + Upper::magnitude_of_double(near) * self.radius;
        Some(DoubleDisc { mid: near, radius: spread.over(least) })
    }
}

operators! { DoubleDisc:
    Add add(z, w) {
        let mid = z.mid + w.mid;
        let rounding = Upper::exactly(2.0 * RELATIVE_ERROR) * Upper::magnitude_of_double(mid);
        DoubleDisc { mid, radius: z.radius + w.radius + rounding }
    }
    Sub sub(z, w) { z + DoubleDisc { mid: -w.mid, radius: w.radius } }
    Mul mul(z, w) {
        let [one, two] = [z, w].map(|d| Upper::magnitude_of_double(d.mid));
        let rounding = Upper::exactly(8.0 * RELATIVE_ERROR) * one * two + Upper::exactly(f64::MIN_POSITIVE);
        let spread = one * w.radius + two * z.radius + z.radius * w.radius;
        DoubleDisc { mid: z.mid * w.mid, radius: spread + rounding }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use linkwright_arithmetic::streams::{Stream, stream, uniform};

    /// Draws a disc and a member just within its rim.
    fn disc_with_member(stream: &mut Stream) -> (DoubleDisc, DoubleComplex) {
        let mut part = || uniform(stream, -1.0, 1.0) * 2.0_f64.powf(uniform(stream, -9.0, 9.0));
        let mid = DoubleComplex::from(Complex::new(part(), part()))
            + DoubleComplex::from(Complex::new(part(), part())).times_power_of_two(f64::EPSILON);
        let radius = mid.to_complex().norm() * 2.0_f64.powf(uniform(stream, -80.0, -1.0));
        let off = Complex::from_polar(radius * (1.0 - 1e-15), uniform(stream, -3.0, 3.0));
        (DoubleDisc { mid, radius: Upper::exactly(radius) }, mid + off.into())
    }

    fn holds(disc: DoubleDisc, z: DoubleComplex) -> bool {
        // The member's own operation errs by 2^-100 of it, the disc allows for more than that.
        (z - disc.mid).to_complex().norm() <= disc.radius.get() * (1.0 + 1e-15)
    }

    #[test]
    fn a_disc_holds_the_results_of_its_members_and_little_more() {
        for index in 0..4000 {
            let mut stream = stream(5, index);
            let ((a, z), (b, w)) = (disc_with_member(&mut stream), disc_with_member(&mut stream));
            assert!(holds(a + b, z + w) && holds(a - b, z - w) && holds(a * b, z * w), "{index}");
            let inverse = a.inverse().expect("the radius is at most half of the midpoint's magnitude");
            assert!(holds(inverse, DoubleComplex::from(Complex::ONE) / z), "{index}");
            let sizes = [a, b].map(|d| d.mid.to_complex().norm());
            let spread =
                sizes[0] * b.radius.get() + sizes[1] * a.radius.get() + a.radius.get() * b.radius.get();
            assert!((a * b).radius.get() <= spread * (1.0 + 1e-14) + 1e-29 * sizes[0] * sizes[1], "{index}");
        }
    }
}
