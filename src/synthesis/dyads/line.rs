//! Dyads whose pivot lies on a line: one linear row more beside those of the poses ([`super::kernel`]), or the best pin of a
//! pivot that is given.
//!
//! A pivot G on the line <n, G> = h is <n, q45> - h q0 = 0. With four poses that makes five rows: three finite dyads, of which
//! one or three are real. Seen from the body the ground moves, and the best pin of a given pivot is the best circle of that
//! pivot.

use super::circle::circle_fit;
use super::kernel::{Line, through_rows};
use super::scale::Scale;
use super::three::through_three_from_pivot;
use crate::mechanism::{Complex, Dyad, Pose};

/// Returns all real RR dyads through four poses whose pivot lies on the line through a place with this normal of length 1: 1 or
/// 3, and fewer where two coincide or one is a slider.
///
/// None if infinitely many dyads meet the poses.
pub fn through_four_on_line(poses: &[Pose; 4], place: Complex, normal: Complex) -> Vec<Dyad> {
    let Some(scale) = Scale::of(poses) else { return Vec::new() };
    let line = Line { place: scale.place(place), normal };
    let found = through_rows(&scale.poses(poses), Some(line));
    found.into_iter().map(|dyad| scale.back(dyad)).collect()
}

/// Returns the dyad of a pivot that meets the poses best, and the rms distance of the pin from its circle: exactly through
/// three poses. `None` for fewer, and if the body's points that lie on the pivot are on a line.
pub fn best_from_pivot(poses: &[Pose], pivot: Complex, weights: Option<&[f64]>) -> Option<(Dyad, f64)> {
    if let Ok(three) = <&[Pose; 3]>::try_from(poses) {
        return Some((through_three_from_pivot(three, pivot)?, 0.0));
    }
    let from_body: Vec<Pose> = poses.iter().map(Pose::inverse).collect();
    let fit = circle_fit(&from_body, pivot, weights)?;
    Some((fit.dyad(pivot).inverse(), fit.rms))
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{Moved, error, nearest, random_point, random_poses, size};
    use super::*;
    use crate::mechanism::dot;
    use crate::numbers::arithmetic::streams::{stream, uniform};

    #[test]
    fn four_poses_and_a_line_have_one_or_three_dyads_and_those_of_a_linkage_are_among_them() {
        let draws = &mut stream(31, 0);
        let (mut worst, mut off, mut odd): (f64, f64, usize) = (0.0, 0.0, 0);
        for _ in 0..100 {
            let poses: [Pose; 4] = random_poses(draws, 4).try_into().expect("four");
            let (place, normal) =
                (random_point(draws, 3.0), Complex::from_polar(1.0, uniform(draws, -3.0, 3.0)));
            let found = through_four_on_line(&poses, place, normal);
            odd += found.len() % 2;
            for dyad in &found {
                let Dyad::RR { pivot, length, .. } = *dyad else { panic!("{dyad:?}") };
                worst = worst.max(error(dyad, &poses));
                off = off.max(dot(normal, pivot - place).abs() / (1.0 + pivot.norm() + length));
            }
        }
        assert!(worst < 1e-10 && off < 1e-12 && odd >= 97, "{worst:e} {off:e} {odd}");
        let mut missed = 0;
        for _ in 0..60 {
            let moved = Moved::random(draws, 4);
            let poses: [Pose; 4] = moved.poses.clone().try_into().expect("four");
            for own in moved.dyads() {
                let Dyad::RR { pivot, .. } = own else { panic!("{own:?}") };
                let normal = Complex::from_polar(1.0, uniform(draws, -3.0, 3.0));
                let along = Complex::new(-normal.im, normal.re);
                let found = through_four_on_line(&poses, pivot + along * uniform(draws, -2.0, 2.0), normal);
                missed += usize::from(nearest(&own, &found) > 1e-6 * (1.0 + size(&poses)));
            }
        }
        assert!(missed <= 3, "{missed} of 120");
    }

    #[test]
    fn the_best_dyad_of_a_pivot_meets_three_poses_and_those_of_its_own_linkage() {
        let draws = &mut stream(32, 0);
        for _ in 0..50 {
            let three = random_poses(draws, 3);
            let pivot = random_point(draws, 3.0);
            let (dyad, rms) = best_from_pivot(&three, pivot, None).expect("a triangle");
            assert!(rms == 0.0 && error(&dyad, &three) < 1e-9);
            let moved = Moved::random(draws, 7);
            for own in moved.dyads() {
                let Dyad::RR { pivot, .. } = own else { panic!("{own:?}") };
                let (dyad, rms) = best_from_pivot(&moved.poses, pivot, None).expect("a circle");
                assert!(rms < 1e-10 && nearest(&own, &[dyad]) < 1e-6, "{rms:e}");
            }
        }
    }
}
