//! Derivatives of the coupler point against two independent ones: dual numbers through the vector loop's
//! angles, and central differences of the position solver.

use crate::reference::{
    cases, closed_position, joints_by_angles, linkage, nine, position, scale, transmission,
};
use linkwright::internals::mechanism::four_bar::gradient::{Frame, shape_gradient};
use linkwright::internals::mechanism::{AssemblyMode, Complex, CouplerSide, FourBar, NaturalCoordinates};
use num_dual::{Dual64, DualNum};
use proptest::prelude::*;

/// dP by the k-th of the nine natural coordinates, k = 9: by the crank angle; by dual numbers.
fn by_dual_numbers(l: &FourBar, phi: f64, k: usize) -> Complex {
    let seed = |i: usize, value: f64| Dual64::new(value, if i == k { 1.0 } else { 0.0 });
    let values = nine(l);
    let parameters = std::array::from_fn(|i| seed(i, values[i]));
    let [_, _, [x, y]] = joints_by_angles(parameters, seed(9, phi), l.assembly().sign(), l.side().sign());
    Complex::new(x.eps, y.eps)
}

/// dP by the k-th of (Ax, Ay, Bx, By, a, b, c, coupler_x, coupler_y): d and e follow from the offset.
fn by_dual_numbers_in_the_couplers_frame(l: &FourBar, phi: f64, k: usize) -> Complex {
    let offset = l.coupler_offset();
    let seed = |i: usize, value: f64| Dual64::new(value, if i == k { 1.0 } else { 0.0 });
    let mut parameters: [Dual64; 9] = std::array::from_fn(|i| seed(i, nine(l)[i]));
    let (x, y, b) = (seed(7, offset.re), seed(8, offset.im), parameters[5]);
    parameters[7] = (x * x + y * y).sqrt();
    parameters[8] = ((x - b) * (x - b) + y * y).sqrt();
    let phi = seed(9, phi);
    let [_, _, [x, y]] = joints_by_angles(parameters, phi, l.assembly().sign(), l.side().sign());
    Complex::new(x.eps, y.eps)
}

/// How far a gradient may be off: the second derivative times the rounding of the lengths. Each derivative
/// brings one factor (scale / least length) / sin mu, and the height of the coupler triangle counts as a
/// length.
fn slack(l: &FourBar, phi: f64, largest: f64) -> f64 {
    let [c, d, _] = position(l, phi, l.assembly()).expect("closed");
    let sine = transmission(c, d, l.follower_pivot()).sin();
    let least = l.coupler().min(l.follower()).min(l.coupler_offset().im.abs());
    64.0 * f64::EPSILON * (1.0 + largest) * (scale(l) / least / sine).powi(2)
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn the_gradient_by_natural_coordinates_is_that_of_dual_numbers((l, phi) in closed_position(0.02)) {
        let (shape, crank_angle) = l.gradient(phi).expect("a gradient");
        let largest = shape.iter().map(|c| c.norm()).fold(crank_angle.norm(), f64::max);
        let slack = slack(&l, phi, largest);
        for (k, got) in shape.into_iter().chain([crank_angle]).enumerate() {
            let wanted = by_dual_numbers(&l, phi, k);
            prop_assert!((got - wanted).norm() <= slack, "column {k}: {got} for {wanted}, slack {slack:e}");
        }
    }

    #[test]
    fn the_gradient_by_the_shape_is_that_of_dual_numbers((l, phi) in closed_position(0.02)) {
        let frame = l.frame(phi, l.assembly()).expect("closed");
        let gradient = shape_gradient(&frame, l.crank(), l.coupler(), l.coupler_offset());
        let gradient = gradient.expect("a gradient");
        let columns = gradient.shape.into_iter().chain([gradient.crank_angle]);
        let largest = columns.clone().map(|c| c.norm()).fold(0.0, f64::max);
        let slack = slack(&l, phi, largest);
        for (k, got) in columns.enumerate() {
            let wanted = by_dual_numbers_in_the_couplers_frame(&l, phi, k);
            prop_assert!((got - wanted).norm() <= slack, "column {k}: {got} for {wanted}, slack {slack:e}");
        }
    }

    #[test]
    fn a_motion_of_both_pivots_moves_the_point_along((l, phi) in closed_position(0.02)) {
        // Sum of the columns of Ax and Bx = 1, of Ay and By = i; the columns of a and of phi are at right
        // angles before the coupler turns them: dP/dphi = a dP/d(A in direction i e^{i phi}).
        let (shape, crank_angle) = l.gradient(phi).expect("a gradient");
        let slack = slack(&l, phi, shape.iter().map(|c| c.norm()).fold(1.0, f64::max));
        prop_assert!((shape[0] + shape[2] - 1.0).norm() <= slack);
        prop_assert!((shape[1] + shape[3] - Complex::new(0.0, 1.0)).norm() <= slack);
        let (sin, cos) = phi.sin_cos();
        let along = (shape[1] * cos - shape[0] * sin) * l.crank();
        prop_assert!((crank_angle - along).norm() <= slack * l.crank());
    }
}

/// Sum of w_j |T_j - P_j|^2 with unequal weights along x and y, so that no two swapped terms cancel.
fn objective(l: &FourBar, angles: &[f64]) -> f64 {
    angles
        .iter()
        .enumerate()
        .map(|(j, &phi)| {
            let p = l.position(phi).joints().expect("closed").coupler_point;
            let (x, y) = (p.re - 0.3 * j as f64, p.im + 0.7 - 0.1 * j as f64);
            (1.0 + 0.37 * j as f64) * (x * x + 1.9 * y * y)
        })
        .sum()
}

#[test]
fn central_differences_of_a_weighted_error_find_the_same_slopes() {
    let linkages = [
        linkage([[0.3, -0.2], [3.9, 1.1]], [2.0, 4.7, 5.1, 4.3, 5.6], 1, 1),
        linkage([[0.3, -0.2], [3.9, 1.1]], [2.0, 4.7, 5.1, 4.3, 5.6], -1, 1),
        linkage([[0.3, -0.2], [3.9, 1.1]], [2.0, 4.7, 5.1, 4.3, 5.6], 1, -1),
        linkage([[-1.1, 0.4], [0.2, 0.9]], [2.4, 2.1, 2.9, 1.7, 3.0], -1, -1),
    ];
    let angles = [0.1, 0.9, 1.7, 2.6, 3.8, 5.2];
    for l in linkages {
        let build = |v: [f64; 9]| {
            FourBar::new(NaturalCoordinates {
                crank_pivot: [v[0], v[1]],
                follower_pivot: [v[2], v[3]],
                crank: v[4],
                coupler: v[5],
                follower: v[6],
                crank_side: v[7],
                follower_side: v[8],
                ..l.natural_coordinates()
            })
            .expect("a linkage next to a sound one")
        };
        let mut slope = [0.0; 9];
        for (j, &phi) in angles.iter().enumerate() {
            let p = l.position(phi).joints().expect("closed").coupler_point;
            let (x, y) = (p.re - 0.3 * j as f64, p.im + 0.7 - 0.1 * j as f64);
            let (shape, _) = l.gradient(phi).expect("a gradient");
            for (slope, column) in slope.iter_mut().zip(shape) {
                *slope += 2.0 * (1.0 + 0.37 * j as f64) * (x * column.re + 1.9 * y * column.im);
            }
        }
        // A step of eps^(1/3) leaves eps^(2/3) of the third derivative and of the value: 4e-11 of about 1e4.
        let step = f64::EPSILON.cbrt();
        for (k, slope) in slope.into_iter().enumerate() {
            let at = |by: f64| {
                let mut values = nine(&l);
                values[k] += by;
                objective(&build(values), &angles)
            };
            let difference = (at(step) - at(-step)) / (2.0 * step);
            assert!((difference - slope).abs() <= 1e-6, "parameter {k}: {slope} for {difference}");
        }
    }
}

#[test]
fn no_gradient_is_made_up_where_there_is_none() {
    let open = linkage([[0.0, 0.0], [5.0, 0.0]], [4.0, 3.5, 2.5, 2.0, 3.0], 1, 1);
    assert!(open.gradient(3.0).is_none());
    assert!(open.frame(3.0, AssemblyMode::Plus).is_none());
    // On the line C-D the height of the triangle has no derivative by b, d and e.
    assert!(crate::reference::shipped_linkage("hoeken").gradient(2.0).is_none());
    // But by the offset in the coupler's frame it has.
    let hoeken = crate::reference::shipped_linkage("hoeken");
    let frame = hoeken.frame(2.0, AssemblyMode::Plus).unwrap();
    let gradient = shape_gradient(&frame, 1.0, 2.5, hoeken.coupler_offset()).unwrap();
    assert_eq!(gradient.shape[7], frame.coupler);
    // At a toggle the coupler's direction turns infinitely fast.
    let one = Complex::new(1.0, 0.0);
    let flat = Frame { crank: one, coupler: one, follower: one };
    assert!(shape_gradient(&flat, 1.0, 1.0, one).is_none());
    let folded = Frame { crank: one, coupler: one, follower: -one };
    assert!(shape_gradient(&folded, 1.0, 1.0, one).is_none());
}

#[test]
fn the_side_of_the_coupler_point_turns_the_columns_of_its_height_only() {
    let up = linkage([[0.3, -0.2], [3.9, 1.1]], [2.0, 4.7, 5.1, 4.3, 5.6], 1, 1);
    let down =
        FourBar::new(NaturalCoordinates { side: CouplerSide::Minus, ..up.natural_coordinates() }).unwrap();
    let ((a, _), (b, _)) = (up.gradient(0.7).unwrap(), down.gradient(0.7).unwrap());
    let u = up.frame(0.7, AssemblyMode::Plus).unwrap().coupler;
    // d and e move P in the coupler's frame only: mirror images about the line C-D.
    for k in [7, 8] {
        let image = (b[k] / u).conj() * u;
        assert!((a[k] - image).norm() <= 64.0 * f64::EPSILON * a[k].norm());
    }
}
