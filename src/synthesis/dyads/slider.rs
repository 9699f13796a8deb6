//! Sliders through poses: the PR dyad whose line the pin's places are nearest to, and the RP dyad by inversion.
//!
//! <n, P_j + Q_j m> = h is linear in n, in w = conj(n) m and in h:
//!
//! ```text
//! <n, P_j> + Re(Q_j w) - h = 0
//! ```
//!
//! For a unit normal n, the best w and h are a linear fit, and what the fit cannot reach of the columns P_x and P_y leaves
//! a symmetric 2 x 2 form in n: its smaller eigenvector is the best of all. Four poses are met exactly, by one PR and one
//! RP dyad.

use super::scale::Scale;
use crate::mechanism::{Complex, Dyad, Pose, dot};
use nalgebra::{DVector, Dyn, OMatrix, SVD, U2, U3, Vector2};

/// Least ratio of singular values that count: of the columns of w and h, and of the two columns that they leave.
const RANK: f64 = 1e-12;

/// Returns the PR dyad with the least sum of squared distances of its pin from its line; `None` for fewer than four poses,
/// or if it is not unique (a body that only shifts or only turns, poses that repeat each other).
pub fn pin_on_line(poses: &[Pose]) -> Option<Dyad> {
    let scale = Scale::of(poses).filter(|_| poses.len() >= 4)?;
    let scaled = scale.poses(poses);
    slider(&scaled).map(|dyad| scale.back(dyad))
}

/// Returns the RP dyad with the least sum of squared distances of its fixed pin from its line of the body; `None` as for
/// [`pin_on_line`].
pub fn line_over_pivot(poses: &[Pose]) -> Option<Dyad> {
    let from_body: Vec<Pose> = poses.iter().map(Pose::inverse).collect();
    pin_on_line(&from_body).map(|dyad| dyad.inverse())
}

/// Returns the PR dyad with a line of this unit normal and the least sum of squared distances of its pin from it; `None` for
/// fewer than three poses, which one such dyad meets exactly, or if it is not unique.
pub fn pin_on_line_across(poses: &[Pose], normal: Complex) -> Option<Dyad> {
    let scale = Scale::of(poses).filter(|_| poses.len() >= 3)?;
    let scaled = scale.poses(poses);
    let fitted = Fitted::of(&scaled)?;
    let along = DVector::from_iterator(scaled.len(), scaled.iter().map(|pose| dot(normal, pose.position)));
    Some(scale.back(fitted.dyad(normal, &along)?))
}

/// The columns of w and h with their decomposition.
struct Fitted {
    svd: SVD<f64, Dyn, U3>,
    /// The mean direction, which the columns of w leave out.
    mean: Complex,
}

impl Fitted {
    /// Decomposes the columns of poses; `None` if w and h are not unique.
    fn of(poses: &[Pose]) -> Option<Fitted> {
        let mean = poses.iter().map(|pose| pose.direction).sum::<Complex>() / poses.len() as f64;
        let columns: OMatrix<f64, Dyn, U3> = OMatrix::<f64, Dyn, U3>::from_fn(poses.len(), |j, column| {
            let turn = poses[j].direction - mean;
            [turn.re, -turn.im, 1.0][column]
        });
        let svd = columns.svd(true, true);
        let largest = svd.singular_values.max();
        svd.singular_values.iter().all(|&value| value > RANK * largest).then_some(Fitted { svd, mean })
    }

    /// Returns the best dyad with a line of a unit normal, along which the positions lie at `along`.
    fn dyad(&self, normal: Complex, along: &DVector<f64>) -> Option<Dyad> {
        let fit = self.svd.solve(&-along, 0.0).ok()?;
        let w = Complex::new(fit[0], fit[1]);
        // <n, P> + Re((Q - mean) w) + constant = 0
        let distance = -fit[2] + (self.mean * w).re;
        let dyad = Dyad::PR { pin: w * normal, normal, distance };
        dyad.is_finite().then_some(dyad)
    }
}

/// Returns the best PR dyad of poses of size one.
fn slider(poses: &[Pose]) -> Option<Dyad> {
    let count = poses.len();
    let fitted = Fitted::of(poses)?;
    let left: OMatrix<f64, Dyn, U2> = OMatrix::<f64, Dyn, U2>::from_fn(count, |j, column| {
        let Complex { re, im } = poses[j].position;
        [re, im][column]
    });
    let basis = fitted.svd.u.as_ref()?;
    let beyond = &left - basis * (basis.transpose() * &left);
    let form = beyond.svd(false, true);
    let (values, axes) = (&form.singular_values, form.v_t.as_ref()?);
    // Both zero: every normal fits.
    let is_unique = values.max() > RANK * (count as f64).sqrt();
    if !is_unique {
        return None;
    }
    let row = values.imin();
    let normal = Complex::new(axes[(row, 0)], axes[(row, 1)]);
    let normal = normal / normal.norm();
    let along = &left * Vector2::new(normal.re, normal.im);
    fitted.dyad(normal, &along)
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{FOUR, Four, error, poses_deg, random_point, random_poses};
    use super::*;
    use crate::numbers::arithmetic::streams::{stream, uniform};
    use std::f64::consts::PI;

    #[test]
    fn four_poses_have_one_slider_of_each_kind() {
        for Four { poses: rows, pin_on_line: pr, line_over_pivot: rp } in FOUR {
            let poses = poses_deg(rows);
            let (pin, pivot) = (Complex::new(pr[0], pr[1]), Complex::new(rp[0], rp[1]));
            let (found, other) =
                (pin_on_line(&poses).expect("a slider"), line_over_pivot(&poses).expect("another"));
            let is = |normal: [f64; 2], distance: f64, wanted: [f64; 5]| {
                // A line has two unit normals.
                let sign = (normal[0] * wanted[2] + normal[1] * wanted[3]).signum();
                let apart = (normal[0] - sign * wanted[2]).abs() + (normal[1] - sign * wanted[3]).abs();
                apart < 1e-9 && (distance - sign * wanted[4]).abs() < 1e-8
            };
            assert!(
                matches!(found, Dyad::PR { pin: at, normal, distance }
                if (at - pin).norm() < 1e-8 && is([normal.re, normal.im], distance, pr)),
                "{found:?}"
            );
            assert!(
                matches!(other, Dyad::RP { pivot: at, normal, distance }
                if (at - pivot).norm() < 1e-8 && is([normal.re, normal.im], distance, rp)),
                "{other:?}"
            );
        }
        let draws = &mut stream(28, 0);
        for case in 0..50 {
            let poses = random_poses(draws, 4);
            for dyad in [pin_on_line(&poses), line_over_pivot(&poses)] {
                let dyad = dyad.expect("a slider");
                assert!(error(&dyad, &poses) < 1e-13, "case {case}: {dyad:?}, {:e}", error(&dyad, &poses));
            }
        }
    }

    #[test]
    fn three_poses_have_a_slider_along_every_line() {
        let draws = &mut stream(31, 0);
        for _ in 0..50 {
            let normal = Complex::from_polar(1.0, uniform(draws, -PI, PI));
            let poses = random_poses(draws, 3);
            let dyad = pin_on_line_across(&poses, normal).expect("a slider");
            assert!(error(&dyad, &poses) < 1e-12, "{dyad:?}, {:e}", error(&dyad, &poses));
            // Of many poses none is better than the best of all normals.
            let poses = random_poses(draws, 7);
            let sum_sq = |dyad: &Dyad| poses.iter().map(|pose| dyad.residual(pose).powi(2)).sum::<f64>();
            let across = pin_on_line_across(&poses, normal).expect("a slider");
            assert!(sum_sq(&across) >= (1.0 - 1e-9) * sum_sq(&pin_on_line(&poses).expect("a slider")));
        }
    }

    #[test]
    fn the_slider_of_many_poses_is_the_best_of_its_neighbours() {
        let draws = &mut stream(29, 0);
        for _ in 0..50 {
            let poses = random_poses(draws, 9);
            let sum_sq = |dyad: &Dyad| poses.iter().map(|pose| dyad.residual(pose).powi(2)).sum::<f64>();
            let best = pin_on_line(&poses).expect("a slider");
            let Dyad::PR { pin, normal, distance } = best else { panic!("{best:?}") };
            let inverse =
                line_over_pivot(&poses.iter().map(Pose::inverse).collect::<Vec<_>>()).expect("a slider");
            assert!((sum_sq(&inverse.inverse()) - sum_sq(&best)).abs() < 1e-9 * sum_sq(&best));
            for _ in 0..20 {
                let other = Dyad::PR {
                    pin: pin + random_point(draws, 0.1),
                    normal: normal * Complex::from_polar(1.0, uniform(draws, -0.3, 0.3)),
                    distance: distance + uniform(draws, -0.1, 0.1),
                };
                assert!(sum_sq(&other) > sum_sq(&best), "{other:?}");
            }
            // A slider that made the poses is found.
            let line = Complex::from_polar(1.0, uniform(draws, -PI, PI));
            let made: Vec<Pose> = (0..9)
                .map(|_| {
                    let (along, angle) = (uniform(draws, -3.0, 3.0), uniform(draws, -PI, PI));
                    let direction = Complex::from_polar(1.0, angle);
                    let place = line * Complex::new(1.5, along);
                    Pose { position: place - direction * Complex::new(0.4, -0.7), direction }
                })
                .collect();
            let Some(Dyad::PR { pin, .. }) = pin_on_line(&made) else { panic!("no slider") };
            assert!((pin - Complex::new(0.4, -0.7)).norm() < 1e-10);
        }
    }
}
