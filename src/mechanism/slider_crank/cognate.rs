//! The cognate of a slider-crank: the other one that traces the same coupler curve.
//!
//! With e the crank's direction, u the coupler's and zeta = Z/|Z|, the coupler point is the same sum read in the other order,
//!
//! ```text
//! P = A + a e + Z u = A + |Z| e' + Z' u',   e' = zeta u,  u' = zeta e,  Z' = a/zeta
//! ```
//!
//! and the closure Im((A + a e + b u - Q) conj s) = 0, multiplied by |Z|/b, is that of a slider-crank with
//!
//! | | cognate |
//! |---|---|
//! | crank pivot | A |
//! | crank, coupler | a' = \|Z\|, b' = a \|Z\|/b |
//! | line | s' = zeta s through Q' = A + (\|Z\|/b) zeta (Q - A) |
//! | coupler point | Z' = a conj(zeta) |
//!
//! Its crank turns in step with the original's coupler, and its coupler with the original's crank; b'/a' = a/b. With h the
//! distance of A from the line, one of the two cranks turns fully and the other rocks if h <= |b - a|; else both rock. An inverted slider-crank has no such
//! cognate: read in the other order its closure has a term in the crank's direction alone, which the closure of a block has not.

use super::SliderCrank;
use crate::mechanism::{AssemblyMode, Complex, LinkageError, SliderLinkage, point};

impl SliderCrank {
    /// Returns the cognate, with t1 as it is at the crank angle `crank_angle` (radians) of this linkage.
    ///
    /// # Errors
    /// [`LinkageError`] if P lies on C, so that there is none, or a length leaves the allowed range.
    pub fn cognate(&self, crank_angle: f64) -> Result<SliderCrank, LinkageError> {
        let (a, b) = (self.crank(), self.coupler());
        let (pivot, z) = (point(self.parameters.crank_pivot), self.coupler_offset());
        let length = z.norm();
        let zeta = if length > 0.0 { z / length } else { Complex::new(1.0, 0.0) };
        let line_point = pivot + (self.line_point() - pivot) * zeta * (length / b);
        let line_angle = (self.line_direction() * zeta).arg();
        // The coupler u' = zeta e lies along the line s' = zeta s as e does along s.
        let along = (Complex::from_polar(1.0, crank_angle) * self.line_direction().conj()).re;
        let assembly = if along >= 0.0 { AssemblyMode::Plus } else { AssemblyMode::Minus };
        let lengths = [length, a * length / b];
        SliderCrank::from_parts(pivot, lengths, (line_point, line_angle), zeta.conj() * a, assembly)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::SliderCrankParameters;
    use crate::numbers::arithmetic::streams::{stream, uniform};
    use std::f64::consts::TAU;

    fn random(index: u64) -> SliderCrank {
        let mut draws = stream(5, index);
        let mut next = |low: f64, high: f64| uniform(&mut draws, low, high);
        let (pivot, line) = (Complex::new(next(-2.0, 2.0), next(-2.0, 2.0)), next(-3.0, 3.0));
        let through = pivot + Complex::new(next(-1.0, 1.0), next(-1.0, 1.0));
        let (lengths, offset) =
            ([next(0.3, 2.0), next(0.5, 4.0)], Complex::new(next(-3.0, 3.0), next(-3.0, 3.0)));
        let assembly = if index.is_multiple_of(2) { AssemblyMode::Plus } else { AssemblyMode::Minus };
        SliderCrank::from_parts(pivot, lengths, (through, line), offset, assembly).expect("a linkage")
    }

    #[test]
    fn every_position_is_one_of_the_cognate_with_the_same_coupler_point() {
        let mut compared = 0;
        for index in 0..500 {
            let linkage = random(index);
            for k in 0..24 {
                let angle = TAU * f64::from(k) / 24.0;
                let Some(joints) = linkage.position(angle).joints() else { continue };
                let cognate = linkage.cognate(angle).expect("a cognate");
                let zeta = linkage.coupler_offset() / linkage.coupler_offset().norm();
                let there = cognate.position((joints.coupler * zeta).arg()).joints().expect("it closes");
                assert!((there.coupler_point - joints.coupler_point).norm() < 1e-9, "{index} {k}");
                compared += 1;
            }
            // The cognate of the cognate is the linkage itself.
            let angle = linkage.line_angle();
            if let Some(joints) = linkage.position(angle).joints() {
                let zeta = linkage.coupler_offset() / linkage.coupler_offset().norm();
                let again = linkage.cognate(angle).and_then(|one| one.cognate((joints.coupler * zeta).arg()));
                let (one, other) = (again.expect("a cognate").parameters(), linkage.parameters());
                assert!((one.crank - other.crank).abs() + (one.coupler - other.coupler).abs() < 1e-12);
                assert!(
                    (one.coupler_x - other.coupler_x).abs() + (one.coupler_y - other.coupler_y).abs() < 1e-12
                );
                assert_eq!(one.assembly, other.assembly, "{index}");
            }
        }
        assert!(compared > 5000, "{compared}");
    }

    #[test]
    fn a_coupler_point_on_the_crank_pin_has_no_cognate() {
        let mut parameters: SliderCrankParameters = random(1).parameters();
        (parameters.coupler_x, parameters.coupler_y) = (0.0, 0.0);
        assert!(SliderCrank::new(parameters).expect("a linkage").cognate(0.0).is_err());
    }
}
