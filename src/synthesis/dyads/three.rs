//! Dyads through three poses: a circle through the three places of a pin, seen from the ground or from the body.

use crate::mechanism::{Complex, Dyad, Pose, cross, turned};

/// Least sine of the angle between two sides of a triangle; flatter ones are lines.
const FLAT: f64 = 1e-12;

/// Returns the RR dyad of a pin through three poses; `None` if the pin's three places lie on a line or two of them
/// coincide.
pub fn through_three_from_pin(poses: &[Pose; 3], pin: Complex) -> Option<Dyad> {
    let places = poses.map(|pose| pose.at(pin));
    let pivot = circumcentre(places)?;
    let length = places.iter().map(|place| (place - pivot).norm()).sum::<f64>() / 3.0;
    let dyad = Dyad::RR { pin, pivot, length };
    dyad.is_finite().then_some(dyad)
}

/// Returns the RR dyad of a pivot through three poses; `None` if the body's points that lie on the pivot are on a line, or
/// two of them coincide.
pub fn through_three_from_pivot(poses: &[Pose; 3], pivot: Complex) -> Option<Dyad> {
    let from_body = poses.map(|pose| pose.inverse());
    through_three_from_pin(&from_body, pivot).map(|dyad| dyad.inverse())
}

/// Returns the centre of the circle through three points; `None` if they are on a line or two of them coincide.
///
/// With u and v the sides from the first point, <u, g> = |u|^2/2 and <v, g> = |v|^2/2.
fn circumcentre([from, one, other]: [Complex; 3]) -> Option<Complex> {
    let (u, v) = (one - from, other - from);
    let area = cross(u, v);
    let third = (v - u).norm();
    let sides = [u.norm() * v.norm(), u.norm() * third, v.norm() * third];
    let is_triangle = sides.iter().all(|sides| area.abs() > FLAT * sides);
    is_triangle.then(|| from + (turned(u) * v.norm_sqr() - turned(v) * u.norm_sqr()) / (2.0 * area))
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{error, nearest, random_point, random_poses};
    use super::*;
    use crate::numbers::arithmetic::streams::stream;

    #[test]
    fn three_poses_have_a_dyad_for_each_pin_and_each_pivot() {
        let draws = &mut stream(30, 0);
        for _ in 0..200 {
            let poses: [Pose; 3] = random_poses(draws, 3).try_into().expect("three");
            let at = random_point(draws, 3.0);
            let from_pin = through_three_from_pin(&poses, at).expect("a circle");
            let from_pivot = through_three_from_pivot(&poses, at).expect("a circle");
            assert!(matches!(from_pin, Dyad::RR { pin, .. } if pin == at));
            assert!(matches!(from_pivot, Dyad::RR { pivot, .. } if pivot == at));
            for dyad in [from_pin, from_pivot] {
                assert!(error(&dyad, &poses) < 1e-13, "{dyad:?}");
            }
            // One way and back.
            let Dyad::RR { pivot, .. } = from_pin else { panic!("{from_pin:?}") };
            let back = through_three_from_pivot(&poses, pivot).expect("a circle");
            let Dyad::RR { length, .. } = back else { panic!("{back:?}") };
            assert!(nearest(&from_pin, &[back]) < 1e-9 * (1.0 + length).powi(2), "{from_pin:?}, {back:?}");
        }
        let shifted = [0.0, 1.0, 2.0].map(|x| Pose::new(Complex::new(x, -x), 0.4));
        assert_eq!(through_three_from_pin(&shifted, Complex::new(2.0, 1.0)), None);
    }
}
