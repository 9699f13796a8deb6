//! Complex numbers side by side in lanes, and the 8x8 linear systems that eight paths solve at once.
//!
//! Every operation is one IEEE-754 operation a lane, so a path's digits depend neither on its lane nor on what the
//! other lanes hold. Wide instructions come from the function that encloses the loops
//! ([`vectorised`](crate::dispatch::vectorised)).

use crate::Complex;
use crate::lane::{F64x8, LANES, Lane};

/// One complex number a lane: real parts together, imaginary parts together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComplexLanes<L = F64x8> {
    /// Real parts.
    pub re: L,
    /// Imaginary parts.
    pub im: L,
}

impl<L: Lane> ComplexLanes<L> {
    /// Returns the same number in every lane.
    #[inline(always)]
    pub fn splat(value: Complex) -> Self {
        ComplexLanes { re: L::splat(value.re), im: L::splat(value.im) }
    }

    /// Returns |z|^2.
    #[inline(always)]
    pub fn norm_sq(self) -> L {
        self.re * self.re + self.im * self.im
    }

    /// Multiplies each lane by a real number.
    #[inline(always)]
    pub fn scale(self, by: L) -> Self {
        ComplexLanes { re: self.re * by, im: self.im * by }
    }

    /// Returns 1 / z; not finite if z = 0.
    #[inline(always)]
    pub fn recip(self) -> Self {
        let inverse = self.norm_sq().recip();
        ComplexLanes { re: self.re * inverse, im: -self.im * inverse }
    }

    /// Returns conj(self) other.
    #[inline(always)]
    pub fn dot(self, other: Self) -> Self {
        ComplexLanes {
            re: self.re * other.re + self.im * other.im,
            im: self.re * other.im - self.im * other.re,
        }
    }

    /// Selects `yes` in the lanes with left >= right, `no` elsewhere.
    #[inline(always)]
    pub fn where_at_least(left: L, right: L, yes: Self, no: Self) -> Self {
        ComplexLanes { re: left.at_least(right, yes.re, no.re), im: left.at_least(right, yes.im, no.im) }
    }
}

impl ComplexLanes {
    /// Zero in every lane.
    pub const ZERO: ComplexLanes = ComplexLanes { re: F64x8([0.0; LANES]), im: F64x8([0.0; LANES]) };

    /// Loads the eight numbers that start at index `at` of a column of real parts and one of imaginary parts.
    ///
    /// # Panics
    /// When fewer than eight are left.
    #[inline(always)]
    pub fn load([re, im]: &Column, at: usize) -> Self {
        ComplexLanes { re: F64x8::load(re, at), im: F64x8::load(im, at) }
    }

    /// Writes the eight numbers to index `at` of a column of real parts and one of imaginary parts.
    ///
    /// # Panics
    /// When there is no room for eight.
    #[inline(always)]
    pub fn store(self, [re, im]: &mut Column, at: usize) {
        self.re.store(re, at);
        self.im.store(im, at);
    }

    /// Returns the sum of the lanes, in the order of [`F64x8::sum`].
    #[inline(always)]
    pub fn sum(self) -> Complex {
        Complex::new(self.re.sum(), self.im.sum())
    }

    /// Returns the number in one lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Complex {
        Complex::new(self.re.0[lane], self.im.0[lane])
    }

    /// Puts a number into one lane.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, value: Complex) {
        self.re.0[lane] = value.re;
        self.im.0[lane] = value.im;
    }

    /// Selects `yes` in the lanes with left = right, `no` elsewhere.
    #[inline(always)]
    pub fn where_equal(left: F64x8, right: F64x8, yes: Self, no: Self) -> Self {
        let mut out = no;
        for lane in 0..LANES {
            out.re.0[lane] = if left.0[lane] == right.0[lane] { yes.re.0[lane] } else { no.re.0[lane] };
        }
        for lane in 0..LANES {
            out.im.0[lane] = if left.0[lane] == right.0[lane] { yes.im.0[lane] } else { no.im.0[lane] };
        }
        out
    }
}

crate::operators! { impl<L: Lane> ComplexLanes<L>:
    Add add(z, w) { ComplexLanes { re: z.re + w.re, im: z.im + w.im } }
    Sub sub(z, w) { ComplexLanes { re: z.re - w.re, im: z.im - w.im } }
    Neg neg(z) { ComplexLanes { re: -z.re, im: -z.im } }
    Mul mul(z, w) { ComplexLanes { re: z.re * w.re - z.im * w.im, im: z.re * w.im + z.im * w.re } }
}

/// A column of complex numbers: real parts and imaginary parts.
pub type Column = [Vec<f64>; 2];

/// Returns complex numbers as a column, padded to whole lanes with the last one.
pub fn column(of: &[Complex]) -> Column {
    let part = |part: fn(&Complex) -> f64| {
        let mut column: Vec<f64> = of.iter().map(part).collect();
        column.resize(of.len().next_multiple_of(LANES), of.last().map_or(0.0, part));
        column
    };
    [part(|z| z.re), part(|z| z.im)]
}

/// Returns the larger of two real numbers, lane by lane.
#[inline(always)]
pub fn larger<L: Lane>(one: L, other: L) -> L {
    one.at_least(other, one, other)
}

/// The number of rows, and of columns, of the systems that are solved here.
pub const ORDER: usize = 8;

/// Solves A x = b for `R` right-hand sides a lane by elimination with row pivoting, each lane with its own pivots.
///
/// `matrix[i][j]` is a_ij and `right[i][r]` is b_i of the r-th side; x_i replaces b_i. A lane whose matrix is
/// singular gets numbers that are not finite. It returns the smallest pivot of each lane, squared: with rows whose
/// largest entry is about one, a measure of the distance of the matrix from a singular one.
#[expect(clippy::needless_range_loop, reason = "indices follow the equations and the lanes")]
#[inline(always)]
pub fn solve<const R: usize>(
    matrix: &mut [[ComplexLanes; ORDER]; ORDER],
    right: &mut [[ComplexLanes; R]; ORDER],
) -> F64x8 {
    let mut smallest = F64x8::splat(f64::INFINITY);
    for k in 0..ORDER {
        // The row with the largest entry in this column, and that entry's inverse.
        let mut best = matrix[k][k].norm_sq();
        let mut place = F64x8::splat(k as f64);
        for (i, row) in matrix.iter().enumerate().skip(k + 1) {
            let size = row[k].norm_sq();
            place = best.at_least(size, place, F64x8::splat(i as f64));
            best = best.at_least(size, best, size);
        }
        smallest = smallest.min(best);
        let (old, old_right) = (matrix[k], right[k]);
        let mut pivot = old;
        let mut pivot_right = old_right;
        for i in k + 1..ORDER {
            let here = F64x8::splat(i as f64);
            for j in k..ORDER {
                pivot[j] = ComplexLanes::where_equal(place, here, matrix[i][j], pivot[j]);
            }
            for r in 0..R {
                pivot_right[r] = ComplexLanes::where_equal(place, here, right[i][r], pivot_right[r]);
            }
        }
        let inverse = pivot[k].recip();
        for j in k + 1..ORDER {
            pivot[j] = pivot[j] * inverse;
        }
        for value in &mut pivot_right {
            *value = *value * inverse;
        }
        for i in k + 1..ORDER {
            let here = F64x8::splat(i as f64);
            // The row that gave the pivot takes the old row k in exchange.
            let equal =
                |new: ComplexLanes, kept: ComplexLanes| ComplexLanes::where_equal(place, here, new, kept);
            let factor = equal(old[k], matrix[i][k]);
            for j in k + 1..ORDER {
                matrix[i][j] = equal(old[j], matrix[i][j]) - factor * pivot[j];
            }
            for r in 0..R {
                right[i][r] = equal(old_right[r], right[i][r]) - factor * pivot_right[r];
            }
        }
        matrix[k] = pivot;
        right[k] = pivot_right;
    }
    for k in (0..ORDER).rev() {
        for j in k + 1..ORDER {
            for r in 0..R {
                right[k][r] = right[k][r] - matrix[k][j] * right[j][r];
            }
        }
    }
    smallest
}
