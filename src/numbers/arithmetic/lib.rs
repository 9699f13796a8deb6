//! Numbers: points of the plane as complex numbers, eight numbers side by side, double-double numbers,
//! streams of pseudo-random numbers.
//!
//! | module | holds |
//! |---|---|
//! | [`complex_lanes`] | complex numbers side by side in lanes, and the 8x8 linear systems that eight paths solve at once |
//! | [`dispatch`] | run-time choice of vector instructions: the one file of this crate that may use `unsafe` |
//! | [`double_double`] | real and complex numbers as unevaluated sums of two doubles, about 32 digits |
//! | [`lane`] | SIMD lanes: the arithmetic of the position solver, written once for one `f64` and for eight of them side by side |
//! | [`mod@once`] | values that are made once, in parallel, and used by all threads |
//! | [`mod@operators`] | operators of number types, written as functions of their operands |
//! | [`sine`] | sine and cosine together, for one angle and for a block of them, with the same digits |
//! | [`streams`] | streams of pseudo-random numbers, each determined by a seed and an index, and the draws made from them |

pub mod complex_lanes;
pub mod dispatch;
pub mod double_double;
pub mod lane;
pub mod once;
mod operators;
pub mod sine;
pub mod streams;

/// A point or a vector of the plane, x + i y.
pub type Complex = num_complex::Complex<f64>;

/// Returns the point (x, y) as a complex number.
#[inline(always)]
pub fn point(xy: [f64; 2]) -> Complex {
    Complex::new(xy[0], xy[1])
}

/// Returns the complex number as (x, y).
#[inline(always)]
pub fn xy(z: Complex) -> [f64; 2] {
    [z.re, z.im]
}

/// Returns <x, y>, the scalar product of two vectors.
#[inline(always)]
pub fn dot(x: Complex, y: Complex) -> f64 {
    x.re * y.re + x.im * y.im
}

/// Returns the cross product x cross y, positive if y lies to the left of x.
#[inline(always)]
pub fn cross(x: Complex, y: Complex) -> f64 {
    x.re * y.im - x.im * y.re
}

/// Returns |z| = sqrt(x^2 + y^2), for components between 1e-150 and 1e150; faster than `norm`, which also handles all
/// others.
#[inline(always)]
pub fn length(z: Complex) -> f64 {
    z.norm_sqr().sqrt()
}

/// Returns i z, the vector turned by +90 degrees.
#[inline(always)]
pub fn turned(z: Complex) -> Complex {
    Complex::new(-z.im, z.re)
}

/// Returns z / |z|, the unit vector along z; 1, along the x axis, for zero.
#[inline]
pub fn unit_vector(z: Complex) -> Complex {
    let long = length(z);
    if long > 0.0 { z / long } else { Complex::new(1.0, 0.0) }
}

/// Returns the share s in [0, 1] for which from + s (to - from) is the point of a segment that is nearest to z; 0 if the
/// segment is a point.
#[inline]
pub fn nearest_share(z: Complex, [from, to]: [Complex; 2]) -> f64 {
    let along = to - from;
    let length_sq = along.norm_sqr();
    if length_sq > 0.0 { (dot(z - from, along) / length_sq).clamp(0.0, 1.0) } else { 0.0 }
}

/// Returns the least and the greatest of the values; [inf, -inf] if there are none.
pub fn least_and_greatest(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// Returns the centroid of points and the root of the mean square of their distances from it, their rms radius; not a number if
/// there are none.
pub fn centroid_and_radius(points: &[Complex]) -> (Complex, f64) {
    let n = points.len() as f64;
    let centre = points.iter().sum::<Complex>() / n;
    (centre, (points.iter().map(|p| (p - centre).norm_sqr()).sum::<f64>() / n).sqrt())
}

/// Returns the lower left and the upper right corner of the box around points; [inf, -inf] if there are none.
pub fn bounding_box(points: impl Iterator<Item = Complex> + Clone) -> [Complex; 2] {
    let [left, right] = least_and_greatest(points.clone().map(|z| z.re));
    let [low, high] = least_and_greatest(points.map(|z| z.im));
    [Complex::new(left, low), Complex::new(right, high)]
}
