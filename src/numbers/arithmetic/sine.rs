//! Sine and cosine together, for one angle and for a block of them, with the same digits.
//!
//! An angle x is reduced to y = x - n pi/2 in [-pi/4, pi/4] with n the nearest whole number to 2x/pi (Cody & Waite 1980):
//! pi/2 = P1 + P2 + P3, where n P1 and n P2 are exact, so that y is known with a correction e. Then
//!
//! ```text
//! sin(y + e) = y + (y z S(z) + e)               z = y^2,  |sin y - y - y z S(z)| < 1.6e-18
//! cos(y + e) = 1 - z/2 + (z^2 C(z) - y e)                 |cos y - 1 + z/2 - z^2 C(z)| < 5e-20
//! ```
//!
//! with polynomials of least largest error, found by the exchange algorithm of Remez (1934) with 60 digits; the quadrant
//! n mod 4 exchanges the two and sets their signs. The error is at most 1.1e-16: that of rounding to the nearest number
//! and a little more. Angles beyond [`FARTHEST`], infinities and NaN are left to the standard library.
//!
//! Nothing branches on the angle, so that a loop over a block becomes vector instructions.

use crate::lane::LANES;

/// The largest angle that is reduced here, radians: n P1 and n P2 are exact far beyond it.
pub const FARTHEST: f64 = 1e4;

/// pi/2 in parts: 33 bits, the next 33 bits, and the rest.
const PARTS: [f64; 3] = [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];
/// 1.5 * 2^52: adding it leaves a whole number in the last bits.
const WHOLE: f64 = 6_755_399_441_055_744.0;

/// S of the module, the constant first.
const SINE: [f64; 6] = [
    -0.166_666_666_666_666,
    0.008_333_333_333_316_465,
    -0.000_198_412_698_259_218_73,
    2.755_731_254_077_632_5e-6,
    -2.505_059_963_733_828_3e-8,
    1.588_855_201_775_475_5e-10,
];
/// C of the module, the constant first.
const COSINE: [f64; 6] = [
    0.041_666_666_666_666_6,
    -0.001_388_888_888_887_412_5,
    2.480_158_728_948_217_4e-5,
    -2.755_731_435_232_828_6e-7,
    2.087_572_327_250_189_7e-9,
    -1.135_964_776_172_529_5e-11,
];

/// Returns sine and cosine of an angle in radians; those of the standard library beyond [`FARTHEST`], NaN for NaN and
/// infinities.
///
/// ```
/// use linkwright_arithmetic::sine::sin_cos;
/// let (sin, cos) = sin_cos(std::f64::consts::FRAC_PI_6);
/// assert!((sin - 0.5).abs() < 1.2e-16 && (cos - 0.75f64.sqrt()).abs() < 1.2e-16);
/// ```
#[inline(always)]
pub fn sin_cos(angle: f64) -> (f64, f64) {
    if angle.abs() <= FARTHEST { reduced(angle) } else { angle.sin_cos() }
}

/// Returns the sines and the cosines of a block of angles, with the digits of [`sin_cos`].
#[inline(always)]
pub fn sin_cos_block(angles: &[f64; LANES]) -> ([f64; LANES], [f64; LANES]) {
    let (mut sin, mut cos) = ([0.0; LANES], [0.0; LANES]);
    let mut near = true;
    for i in 0..LANES {
        (sin[i], cos[i]) = reduced(angles[i]);
        near &= angles[i].abs() <= FARTHEST;
    }
    if !near {
        for i in 0..LANES {
            (sin[i], cos[i]) = sin_cos(angles[i]);
        }
    }
    (sin, cos)
}

/// Computes sine and cosine of an angle of at most [`FARTHEST`].
#[inline(always)]
fn reduced(x: f64) -> (f64, f64) {
    let shifted = x * std::f64::consts::FRAC_2_PI + WHOLE;
    let n = shifted - WHOLE;
    let quadrant = shifted.to_bits();
    let near = x - n * PARTS[0];
    let small = n * PARTS[1];
    let y = near - small;
    let e = ((near - y) - small) - n * PARTS[2];
    let z = y * y;
    let zz = z * z;
    let s = (SINE[0] + z * SINE[1]) + zz * ((SINE[2] + z * SINE[3]) + zz * (SINE[4] + z * SINE[5]));
    let c =
        (COSINE[0] + z * COSINE[1]) + zz * ((COSINE[2] + z * COSINE[3]) + zz * (COSINE[4] + z * COSINE[5]));
    let sine = y + (y * z * s + e);
    let half = 0.5 * z;
    let rest = 1.0 - half;
    let cosine = rest + (((1.0 - rest) - half) + (zz * c - y * e));
    // All ones in odd quadrants, where sine and cosine change places.
    let odd = (quadrant & 1).wrapping_neg();
    let (a, b) = (sine.to_bits(), cosine.to_bits());
    let change = (a ^ b) & odd;
    let sign = |quadrant: u64| (quadrant & 2) << 62;
    (
        f64::from_bits((a ^ change) ^ sign(quadrant)),
        f64::from_bits((b ^ change) ^ sign(quadrant.wrapping_add(1))),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::double_double::DoubleDouble;
    use crate::streams::{stream, uniform};

    /// The error that the module states.
    const MOST: f64 = 1.1e-16;

    /// Returns sine and cosine of an angle to about 30 digits: reduced by pi/2 with 32 digits, then Taylor's series.
    fn exact(x: f64) -> [DoubleDouble; 2] {
        let quarter = DoubleDouble { hi: std::f64::consts::FRAC_PI_2, lo: 6.123_233_995_736_766e-17 };
        let n = (x / quarter.hi).round();
        let y = DoubleDouble::from(x) - DoubleDouble::from(n) * quarter;
        let square = -(y * y);
        let series = |first: DoubleDouble, start: f64| {
            let (mut term, mut sum) = (first, first);
            for k in 1..15 {
                let at = start + 2.0 * f64::from(k);
                term = term * square / DoubleDouble::from(at * (at - 1.0));
                sum = sum + term;
            }
            sum
        };
        let (sine, cosine) = (series(y, 1.0), series(DoubleDouble::from(1.0), 0.0));
        match n.rem_euclid(4.0) as u8 {
            0 => [sine, cosine],
            1 => [cosine, -sine],
            2 => [-sine, -cosine],
            _ => [-cosine, sine],
        }
    }

    fn error(x: f64) -> f64 {
        let (sine, cosine) = sin_cos(x);
        let [exact_sine, exact_cosine] = exact(x);
        let off = |found: f64, exact: DoubleDouble| (exact - DoubleDouble::from(found)).to_f64().abs();
        off(sine, exact_sine).max(off(cosine, exact_cosine))
    }

    #[test]
    fn the_error_is_that_of_rounding_and_a_little_more() {
        let draws = &mut stream(11, 0);
        let mut worst: f64 = 0.0;
        for reach in [1.0, 10.0, 1e3, FARTHEST] {
            for _ in 0..100_000 {
                worst = worst.max(error(uniform(draws, -reach, reach)));
            }
        }
        // Next to the multiples of pi/4, where the reduction cancels or the polynomials end.
        for n in -12_000..=12_000 {
            let near = f64::from(n) * std::f64::consts::FRAC_PI_4;
            for x in [near, near.next_up(), near.next_down(), near + 1e-9, near - 1e-9] {
                worst = worst.max(error(x));
            }
        }
        assert!(worst <= MOST, "{worst:e}");
    }

    #[test]
    fn small_angles_keep_their_relative_digits() {
        for exponent in 1..300 {
            let x = 10f64.powi(-exponent) * 1.234_567;
            let (sine, cosine) = sin_cos(x);
            assert!((sine - x.sin()).abs() <= f64::EPSILON * x, "{x:e}");
            assert!((cosine - x.cos()).abs() <= MOST);
        }
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
    }

    #[test]
    fn a_block_has_the_digits_of_each_alone_and_of_the_library_far_away() {
        let draws = &mut stream(12, 0);
        let bits = |(sine, cosine): (f64, f64)| (sine.to_bits(), cosine.to_bits());
        let far = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e4, 10_000.1, -1e300, 1e22, 0.0];
        for round in 0..1000 {
            let mut block = [0.0; LANES];
            block.fill_with(|| uniform(draws, -2e4, 2e4));
            if round % 2 == 1 {
                block[round % LANES] = far[(round / LANES) % far.len()];
            }
            let (sine, cosine) = sin_cos_block(&block);
            let in_lanes = crate::dispatch::vectorised(
                #[inline(always)]
                || sin_cos_block(&block),
            );
            for i in 0..LANES {
                let alone = bits(sin_cos(block[i]));
                let nan = block[i].is_nan() || block[i].is_infinite();
                assert!(nan || bits((sine[i], cosine[i])) == alone, "{}", block[i]);
                assert!(nan || bits((in_lanes.0[i], in_lanes.1[i])) == alone, "{}", block[i]);
                assert_eq!(nan, sine[i].is_nan() && cosine[i].is_nan());
                if block[i].abs() > FARTHEST {
                    assert_eq!(bits(block[i].sin_cos()), alone);
                }
            }
        }
    }
}
