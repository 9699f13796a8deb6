//! Positions at many crank angles, in blocks of lanes: the same digits as [`FourBar::position`], one at a time.

use super::position::{Kernel, LanePosition};
use crate::mechanism::FourBar;
use crate::numbers::arithmetic::dispatch::vectorised;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};
use crate::numbers::arithmetic::sine::sin_cos_block;

/// The places for x and y of the moving joints at each crank angle.
#[derive(Debug)]
pub struct JointColumns<'a> {
    /// C, the crank pin.
    pub crank_pin: &'a mut [[f64; 2]],
    /// D, the follower pin.
    pub follower_pin: &'a mut [[f64; 2]],
    /// P, the coupler point.
    pub coupler_point: &'a mut [[f64; 2]],
}

impl FourBar {
    /// Computes the position at each of many crank angles (radians from the x axis). Where [`FourBar::position`] is open
    /// or undetermined, C, D and P are NaN; elsewhere they have the digits that it gives.
    ///
    /// ```
    /// # use linkwright::internals::mechanism::*;
    /// # use linkwright::internals::mechanism::four_bar::positions::JointColumns;
    /// let linkage = FourBar::new(NaturalCoordinates {
    ///     crank_pivot: [0.0, 0.0], follower_pivot: [4.0, 1.0], crank: 2.0, coupler: 5.0, follower: 5.0,
    ///     crank_side: 5.0, follower_side: 5.0, assembly: AssemblyMode::Plus, side: CouplerSide::Plus })?;
    /// let [mut c, mut d, mut p] = [[[0.0; 2]; 2]; 3];
    /// linkage.positions(&[0.3, f64::NAN], JointColumns {
    ///     crank_pin: &mut c, follower_pin: &mut d, coupler_point: &mut p });
    /// assert_eq!(xy(linkage.position(0.3).joints().unwrap().coupler_point), p[0]);
    /// assert!(p[1][0].is_nan());
    /// # Ok::<(), LinkageError>(())
    /// ```
    ///
    /// # Panics
    /// If there are fewer places than crank angles.
    pub fn positions(&self, crank_angles: &[f64], joints: JointColumns<'_>) {
        positions_of(&Kernel::new(self), crank_angles, joints);
    }
}

/// The position equations of a linkage with its coefficients, for one number or for eight side by side.
pub trait LaneKernel {
    /// Computes the position at a crank angle given by its cosine and sine.
    fn at<L: Lane>(&self, cos: L, sin: L) -> LanePosition<L>;
}

impl LaneKernel for Kernel {
    #[inline(always)]
    fn at<L: Lane>(&self, cos: L, sin: L) -> LanePosition<L> {
        Kernel::at(self, cos, sin)
    }
}

/// Computes the positions of a kernel at many crank angles, NaN where the loop is open: see [`FourBar::positions`].
///
/// # Panics
/// If there are fewer places than crank angles.
pub(in crate::mechanism) fn positions_of(
    kernel: &(impl LaneKernel + Copy),
    crank_angles: &[f64],
    joints: JointColumns<'_>,
) {
    let n = crank_angles.len();
    let JointColumns { crank_pin, follower_pin, coupler_point } = joints;
    let columns = [&mut crank_pin[..n], &mut follower_pin[..n], &mut coupler_point[..n]];
    vectorised(
        #[inline(always)]
        || {
            // A copy that nothing else refers to stays in registers.
            let kernel = *kernel;
            let [c, d, p] = columns.map(|column| column.as_chunks_mut::<LANES>());
            let (blocks, rest) = crank_angles.as_chunks::<LANES>();
            for (angles, ((c, d), p)) in blocks.iter().zip(c.0.iter_mut().zip(d.0).zip(p.0)) {
                block(&kernel, angles, [c, d, p]);
            }
            let (mut angles, mut last) = ([0.0; LANES], [[[0.0; 2]; LANES]; 3]);
            angles[..rest.len()].copy_from_slice(rest);
            let [ends_c, ends_d, ends_p] = &mut last;
            block(&kernel, &angles, [ends_c, ends_d, ends_p]);
            for (place, ends) in [c.1, d.1, p.1].into_iter().zip(&last) {
                place.copy_from_slice(&ends[..place.len()]);
            }
        },
    );
}

/// Computes C, D and P at a block of crank angles, NaN where the loop is open.
#[inline(always)]
fn block(kernel: &impl LaneKernel, angles: &[f64; LANES], places: [&mut [[f64; 2]; LANES]; 3]) {
    let (sin, cos) = sin_cos_block(angles);
    let at = kernel.at(F64x8(cos), F64x8(sin));
    let [px, py] = at.coupler_point;
    let zero = F64x8::splat(0.0);
    // 0 x is NaN for infinities and NaN, zero for all other numbers.
    let finite = zero * px + zero * py;
    let lost = at.gap.at_least(zero, finite, F64x8::splat(f64::NAN));
    for (place, [x, y]) in places.into_iter().zip([at.crank_pin, at.follower_pin, at.coupler_point]) {
        let (x, y) = (x + lost, y + lost);
        for (i, at) in place.iter_mut().enumerate() {
            *at = [x.0[i], y.0[i]];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::{AssemblyMode, Complex, xy};

    #[test]
    fn many_positions_have_the_digits_of_each_alone() {
        for lengths in [[2.0, 5.0, 5.0], [5.0, 4.0, 4.0], [4.0, 4.0, 4.0]] {
            let pivots = [Complex::new(1.0, -2.0), Complex::new(5.0, -2.0)];
            let offset = Complex::new(2.5, 4.3);
            let linkage = FourBar::with_coupler_offset(pivots, lengths, offset, AssemblyMode::Minus)
                .expect("a linkage");
            for n in [0, 1, 7, 8, 9, 1000] {
                let mut angles: Vec<f64> = (0..n).map(|i| 0.01 * i as f64 - 3.0).collect();
                angles.extend([f64::NAN, f64::INFINITY, 0.0, 1e300]);
                let mut columns = [(); 3].map(|()| vec![[0.0; 2]; angles.len()]);
                let [c, d, p] = &mut columns;
                let places = JointColumns { crank_pin: c, follower_pin: d, coupler_point: p };
                linkage.positions(&angles, places);
                for (i, angle) in angles.iter().enumerate() {
                    let alone = linkage.position(*angle).joints();
                    let [c, d, p] = columns.each_ref().map(|column| column[i]);
                    match alone {
                        Some(joints) => assert_eq!(
                            [c, d, p],
                            [joints.crank_pin, joints.follower_pin, joints.coupler_point].map(xy)
                        ),
                        None => assert!([c, d, p].iter().flatten().all(|x| x.is_nan()), "{angle}"),
                    }
                }
            }
        }
    }
}
