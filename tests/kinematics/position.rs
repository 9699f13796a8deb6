//! Positions: what holds for every four-bar, and what happens at the edges.

use crate::coupler_points::CouplerPoints;
use crate::reference::{
    any_linkage, cases, closed_position, joints_by_angles, linkage, nine, rounding, scale,
};
use linkwright::internals::mechanism::four_bar::position::Kernel;
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CouplerSide, FourBar, LinkageError, MAX_MAGNITUDE, NaturalCoordinates, Position,
    VectorLoop, cross,
};
use linkwright::internals::numbers::arithmetic::lane::{F64x8, LANES};
use linkwright::internals::numbers::arithmetic::sine::sin_cos;
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI, TAU};

fn mirrored(linkage: &FourBar) -> FourBar {
    let p = linkage.natural_coordinates();
    FourBar::new(NaturalCoordinates {
        crank_pivot: [p.crank_pivot[0], -p.crank_pivot[1]],
        follower_pivot: [p.follower_pivot[0], -p.follower_pivot[1]],
        assembly: p.assembly.opposite(),
        side: p.side.opposite(),
        ..p
    })
    .expect("a mirrored linkage")
}

fn scaled(linkage: &FourBar, by: f64) -> FourBar {
    let p = linkage.natural_coordinates();
    FourBar::new(NaturalCoordinates {
        crank_pivot: p.crank_pivot.map(|x| by * x),
        follower_pivot: p.follower_pivot.map(|x| by * x),
        crank: by * p.crank,
        coupler: by * p.coupler,
        follower: by * p.follower,
        crank_side: by * p.crank_side,
        follower_side: by * p.follower_side,
        ..p
    })
    .expect("a scaled linkage")
}

/// z -> turn z + shift for both pivots.
fn moved(linkage: &FourBar, turn: Complex, shift: Complex) -> FourBar {
    let p = linkage.natural_coordinates();
    let image = |xy: [f64; 2]| {
        let z = turn * Complex::new(xy[0], xy[1]) + shift;
        [z.re, z.im]
    };
    FourBar::new(NaturalCoordinates {
        crank_pivot: image(p.crank_pivot),
        follower_pivot: image(p.follower_pivot),
        ..p
    })
    .expect("a moved linkage")
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn every_distance_of_the_linkage_is_kept_at_every_closed_position((l, phi) in closed_position(1e-4)) {
        // |D-B|^2 = c^2 is met to eps scale^2, so |D-B| to that over 2 c; the others alike.
        let p = l.natural_coordinates();
        let j = l.position(phi).joints().expect("closed");
        let (a, b) = (l.crank_pivot(), l.follower_pivot());
        let unit = 16.0 * f64::EPSILON * scale(&l).powi(2);
        for (got, wanted) in [
            (j.crank_pin - a, p.crank),
            (j.follower_pin - j.crank_pin, p.coupler),
            (j.follower_pin - b, p.follower),
            (j.coupler_point - j.crank_pin, p.crank_side),
            (j.coupler_point - j.follower_pin, p.follower_side),
        ] {
            prop_assert!((got.norm() - wanted).abs() <= unit / wanted * (1.0 + p.crank_side / p.coupler),
                "{} for {wanted}", got.norm());
        }
    }

    #[test]
    fn the_signs_tell_the_sides_of_both_pins((l, phi) in closed_position(1e-4)) {
        let j = l.position(phi).joints().expect("closed");
        let (d, b) = (j.follower_pin - j.crank_pin, l.follower_pivot() - j.crank_pin);
        prop_assert!(cross(b, d) * l.assembly().sign() > 0.0);
        prop_assert!(cross(d, j.coupler_point - j.crank_pin) * l.side().sign() > 0.0);
    }

    #[test]
    fn natural_coordinates_agree_with_the_angles_of_the_vector_loop((l, phi) in closed_position(1e-3)) {
        let wanted = joints_by_angles(nine(&l), phi, l.assembly().sign(), l.side().sign())
            .map(|[x, y]| Complex::new(x, y));
        let j = l.position(phi).joints().expect("closed");
        let [pin, point] = rounding(&l, phi, l.assembly());
        prop_assert!((j.crank_pin - wanted[0]).norm() <= 8.0 * f64::EPSILON * scale(&l));
        prop_assert!((j.follower_pin - wanted[1]).norm() <= pin);
        prop_assert!((j.coupler_point - wanted[2]).norm() <= point);
    }

    #[test]
    fn the_loop_closes_exactly_where_the_triangle_inequality_says_so(
        l in any_linkage(),
        phi in -7.0..7.0f64,
    ) {
        // Within 1e-10 of a toggle the two may differ: FLAT_TOLERANCE takes 1e-12 of b^2/s^2 as flat.
        let s = crate::reference::diagonal(&l, phi);
        let (b, c) = (l.coupler(), l.follower());
        let slack = (s - (b - c).abs()).abs().min((b + c - s).abs());
        prop_assume!(slack > 1e-10 * scale(&l));
        prop_assert_eq!(l.position(phi).is_closed(), crate::reference::closes(&l, phi));
    }

    #[test]
    fn eight_lanes_give_the_bits_of_one(
        l in any_linkage(),
        angles in prop::collection::vec(-7.0..7.0f64, 24),
    ) {
        let (sin, cos): (Vec<f64>, Vec<f64>) = angles.iter().map(|phi| sin_cos(*phi)).unzip();
        let kernel = Kernel::new(&l);
        let mut points = CouplerPoints::with_room(angles.len());
        points.fill(&kernel, &cos, &sin);
        for (i, &phi) in angles.iter().enumerate() {
            let one = kernel.at(cos[i], sin[i]);
            prop_assert_eq!(points.x[i].to_bits(), one.coupler_point[0].to_bits());
            prop_assert_eq!(points.y[i].to_bits(), one.coupler_point[1].to_bits());
            prop_assert_eq!(points.gap[i].to_bits(), one.gap.to_bits());
            let eight = kernel.at(F64x8::load(&cos, i / LANES * LANES), F64x8::load(&sin, i / LANES * LANES));
            prop_assert_eq!(eight.follower_pin[1].0[i % LANES].to_bits(), one.follower_pin[1].to_bits());
            let both = kernel.at_both(cos[i], sin[i]);
            for (t1, at) in [AssemblyMode::Plus, AssemblyMode::Minus].into_iter().zip(both) {
                let alone = Kernel::new(&l.with_assembly(t1)).at(cos[i], sin[i]);
                for axis in 0..2 {
                    let (x, y) = (at.coupler_point[axis], alone.coupler_point[axis]);
                    prop_assert_eq!(x.to_bits(), y.to_bits());
                }
                prop_assert_eq!(at.gap.to_bits(), alone.gap.to_bits());
            }
            match l.position(phi) {
                Position::Closed(j) => {
                    prop_assert!(one.gap >= 0.0);
                    prop_assert_eq!(j.coupler_point.re.to_bits(), points.x[i].to_bits());
                    prop_assert_eq!(j.coupler_point.im.to_bits(), points.y[i].to_bits());
                    prop_assert_eq!(j.crank_pin.re.to_bits(), one.crank_pin[0].to_bits());
                    prop_assert_eq!(j.follower_pin.re.to_bits(), one.follower_pin[0].to_bits());
                }
                _ => prop_assert!(points.gap[i] < 0.0 || points.gap[i].is_nan()),
            }
        }
    }

    #[test]
    fn a_mirror_about_the_x_axis_flips_both_signs_and_the_angle_to_the_bit(
        l in any_linkage(),
        phi in -7.0..7.0f64,
    ) {
        let image = mirrored(&l).position(-phi).joints();
        let wanted = l.position(phi).joints();
        prop_assert_eq!(image.is_some(), wanted.is_some());
        if let (Some(image), Some(j)) = (image, wanted) {
            prop_assert_eq!(image.crank_pin.conj(), j.crank_pin);
            prop_assert_eq!(image.follower_pin.conj(), j.follower_pin);
            prop_assert_eq!(image.coupler_point.conj(), j.coupler_point);
        }
    }

    #[test]
    fn a_power_of_two_scales_the_curve_to_the_bit(l in any_linkage(), phi in -7.0..7.0f64, k in -20..20i32) {
        let by = 2f64.powi(k);
        let image = scaled(&l, by).position(phi).joints();
        let wanted = l.position(phi).joints();
        prop_assert_eq!(image.map(|j| j.coupler_point), wanted.map(|j| j.coupler_point * by));
    }

    #[test]
    fn any_factor_and_any_motion_of_the_frame_carry_the_curve_along(
        (l, phi) in closed_position(1e-2),
        turn in -3.0..3.0f64,
        shift in [-5.0..5.0f64, -5.0..5.0f64],
        by in 0.1..10.0f64,
    ) {
        let (direction, shift) = (Complex::from_polar(1.0, turn), Complex::new(shift[0], shift[1]));
        let image = moved(&scaled(&l, by), direction, shift);
        let j = l.position(phi).joints().expect("closed");
        let got = image.position(phi + turn).joints().expect("closed as well");
        // The pivots themselves are rounded by the motion: `rounding` of the image, whose scale holds the
        // shift.
        let [pin, point] = rounding(&image, phi + turn, image.assembly());
        prop_assert!((direction * j.follower_pin * by + shift - got.follower_pin).norm() <= pin);
        prop_assert!((direction * j.coupler_point * by + shift - got.coupler_point).norm() <= point);
    }

    #[test]
    fn a_coupler_offset_comes_back_as_it_was_given(l in any_linkage()) {
        let again = FourBar::with_coupler_offset(
            [l.crank_pivot(), l.follower_pivot()],
            [l.crank(), l.coupler(), l.follower()],
            l.coupler_offset(),
            l.assembly(),
        ).expect("a linkage");
        // The height of the triangle comes back from the sides d and e: eps scale^2 over the height and over
        // b.
        let offset = l.coupler_offset();
        let slack = 16.0 * f64::EPSILON * scale(&l).powi(2) * (1.0 + offset.re.abs() / l.coupler())
            * (1.0 / offset.im.abs() + 1.0 / l.coupler());
        prop_assert!((again.coupler_offset() - offset).norm() <= slack);
        prop_assert_eq!(again.side(), l.side());
    }
}

#[test]
fn a_crank_pin_on_the_follower_pivot_leaves_the_follower_free_or_the_loop_open() {
    let at_b = |coupler, follower| {
        linkage([[0.0, 0.0], [1.0, 0.0]], [1.0, coupler, follower, coupler, coupler], 1, 1)
    };
    assert_eq!(at_b(2.0, 2.0).position(0.0), Position::Undetermined);
    assert_eq!(at_b(2.0, 1.5).position(0.0), Position::Open);
    assert_eq!(at_b(1.5, 2.0).position(0.0), Position::Open);
}

#[test]
fn an_undetermined_position_is_not_closed_in_lanes_either() {
    let kernel = Kernel::new(&linkage([[0.0, 0.0], [1.0, 0.0]], [1.0, 2.0, 2.0, 2.0, 2.0], 1, 1));
    let mut points = CouplerPoints::with_room(8);
    points.fill(&kernel, &[1.0; 8], &[0.0; 8]);
    assert!(points.gap.iter().all(|gap| *gap < 0.0 || gap.is_nan()));
}

#[test]
fn a_coupler_point_on_the_line_of_the_pins_stays_on_it() {
    // (a, b, c, d, e) with d + b = e, d + e = b, b + e = d: in a third of such cases the height rounds below
    // 0.
    for t in [0.1, 0.3, 0.7, 1.1, 1.9, 2.3] {
        for [d, e] in [[t, 2.7 + t], [2.7 * t / 3.0, 2.7 - 2.7 * t / 3.0], [2.7 + t, t]] {
            for (t1, t2) in [(1, 1), (1, -1), (-1, 1), (-1, -1)] {
                let l = linkage([[0.1, -0.2], [3.0, 0.4]], [1.0, 2.7, 2.5, d, e], t1, t2);
                let j = l.position(0.8).joints().expect("closed");
                let u = (j.follower_pin - j.crank_pin) / l.coupler();
                let off = cross(u, j.coupler_point - j.crank_pin).abs();
                // h2^2 is known to a few eps scale^2, so h2 = 0 to its root only.
                assert!(
                    off <= (16.0 * f64::EPSILON).sqrt() * scale(&l),
                    "{off} off the line at d {d}, e {e}"
                );
                assert!(((j.coupler_point - j.crank_pin).norm() - d).abs() <= 1e-12, "d {d}");
                assert!(((j.coupler_point - j.follower_pin).norm() - e).abs() <= 1e-12, "e {e}");
            }
        }
    }
}

#[test]
fn a_coupler_point_on_a_pin_moves_with_that_pin() {
    let at_c = linkage([[0.0, 0.0], [3.0, 0.5]], [1.0, 2.7, 2.5, 0.0, 2.7], 1, 1);
    let at_d = linkage([[0.0, 0.0], [3.0, 0.5]], [1.0, 2.7, 2.5, 2.7, 0.0], -1, -1);
    for i in 0..24 {
        let phi = TAU * f64::from(i) / 24.0;
        let (c, d) = (at_c.position(phi).joints().unwrap(), at_d.position(phi).joints().unwrap());
        assert_eq!(c.coupler_point, c.crank_pin);
        assert!((d.coupler_point - d.follower_pin).norm() <= 8.0 * f64::EPSILON * scale(&at_d));
    }
}

#[test]
fn a_toggle_is_closed_and_both_assemblies_meet_there() {
    // g = 5, a = 4, b + c = 6: coupler and follower are in line at cos phi = (25 + 16 - 36)/40.
    let l = linkage([[0.0, 0.0], [5.0, 0.0]], [4.0, 3.5, 2.5, 1.0, 3.0], 1, 1);
    let toggle = (5.0f64 / 40.0).acos();
    for phi in [toggle, -toggle] {
        let plus = l.position_with(phi, AssemblyMode::Plus).joints().expect("closed at the toggle");
        let minus = l.position_with(phi, AssemblyMode::Minus).joints().expect("closed at the toggle");
        // The gap is the root of a difference that is zero to a few eps: b sqrt(16 eps) at most.
        assert!((plus.follower_pin - minus.follower_pin).norm() <= 3.5 * (16.0 * f64::EPSILON).sqrt());
        let straight = plus.crank_pin + (l.follower_pivot() - plus.crank_pin) * (3.5 / 6.0);
        assert!((plus.follower_pin - straight).norm() <= 3.5 * (16.0 * f64::EPSILON).sqrt());
    }
    assert_eq!(l.position(toggle + 1e-9), Position::Open);
    assert!(l.position(toggle - 1e-9).is_closed());
}

#[test]
fn a_parallelogram_carries_its_coupler_without_turning_it() {
    // De Castro, example 2.2: L2 = L4 = 500, L3 = |O1 O2| = 1000, P at 200 mm and 30 degrees.
    let l = FourBar::from_vector_loop(VectorLoop {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [1000.0, 0.0],
        crank: 500.0,
        coupler: 1000.0,
        follower: 500.0,
        coupler_point: 200.0,
        beta_deg: 30.0,
        assembly: AssemblyMode::Plus,
    })
    .unwrap();
    for (deg, x, y) in [(30.0f64, 606.2, 350.0), (90.0, 173.2, 600.0), (150.0, -259.8, 350.0)] {
        let j = l.position(deg.to_radians()).joints().unwrap();
        assert!((j.coupler_point.re - x).abs() <= 0.05 && (j.coupler_point.im - y).abs() <= 0.05);
        assert!((j.follower_pin - j.crank_pin - 1000.0).norm() <= 64.0 * f64::EPSILON * scale(&l));
    }
    // Flat at 0: closed, and P where the table has it; D is known to the root of the rounding.
    let flat = l.position(0.0).joints().expect("the flat position closes").coupler_point;
    assert!((flat - Complex::new(673.2, 100.0)).norm() <= 0.05);
    let far = l.position(PI).joints().expect("the other flat position closes").follower_pin;
    assert!((far - 500.0).norm() <= (16.0 * f64::EPSILON).sqrt() * scale(&l));
}

#[test]
fn pivots_in_one_place_turn_the_linkage_as_a_whole() {
    let l = linkage([[1.0, 2.0], [1.0, 2.0]], [1.0, 1.5, 1.2, 0.8, 1.0], -1, 1);
    let first = l.position(0.0).joints().unwrap().coupler_point - l.crank_pivot();
    for i in 1..12 {
        let phi = f64::from(i) * 0.5;
        let p = l.position(phi).joints().expect("closed all the way").coupler_point - l.crank_pivot();
        assert!((p - first * Complex::from_polar(1.0, phi)).norm() <= 64.0 * f64::EPSILON * scale(&l));
    }
    assert_eq!(l.ground(), 0.0);
    assert_eq!(l.ground_angle(), 0.0);
    assert_eq!(l.link_ratio(), f64::INFINITY);
}

#[test]
fn links_that_cannot_be_joined_are_open_everywhere() {
    let l = linkage([[0.0, 0.0], [10.0, 0.0]], [1.0, 2.0, 3.0, 1.0, 2.0], 1, 1);
    for i in 0..64 {
        assert_eq!(l.position(f64::from(i) * 0.1), Position::Open);
    }
    assert_eq!(l.linkage_type(), None);
}

#[test]
fn a_crank_angle_that_is_no_number_closes_nothing() {
    let l = crate::reference::shipped_linkage("romero");
    for phi in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        assert!(!l.position(phi).is_closed());
        assert!(l.transmission_angle(phi).is_none());
        assert!(l.gradient(phi).is_none());
    }
}

const SOUND: NaturalCoordinates = NaturalCoordinates {
    crank_pivot: [0.0, 0.0],
    follower_pivot: [4.0, 1.0],
    crank: 2.0,
    coupler: 5.0,
    follower: 5.0,
    crank_side: 5.0,
    follower_side: 5.0,
    assembly: AssemblyMode::Plus,
    side: CouplerSide::Plus,
};

#[test]
fn numbers_that_are_not_finite_or_too_large_are_refused_with_their_letter() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 2.0 * MAX_MAGNITUDE] {
        let wrong = [
            ("A", NaturalCoordinates { crank_pivot: [bad, 0.0], ..SOUND }),
            ("A", NaturalCoordinates { crank_pivot: [0.0, bad], ..SOUND }),
            ("B", NaturalCoordinates { follower_pivot: [bad, 0.0], ..SOUND }),
            ("B", NaturalCoordinates { follower_pivot: [0.0, bad], ..SOUND }),
            ("a", NaturalCoordinates { crank: bad, ..SOUND }),
            ("b", NaturalCoordinates { coupler: bad, ..SOUND }),
            ("c", NaturalCoordinates { follower: bad, ..SOUND }),
            ("d", NaturalCoordinates { crank_side: bad, ..SOUND }),
            ("e", NaturalCoordinates { follower_side: bad, ..SOUND }),
        ];
        for (letter, parameters) in wrong {
            match FourBar::new(parameters) {
                Err(LinkageError::NotFinite { key, value }) => {
                    assert_eq!(key, letter);
                    assert!(value == bad || (value.is_nan() && bad.is_nan()));
                }
                other => panic!("{letter} = {bad} gave {other:?}"),
            }
        }
    }
}

#[test]
fn lengths_that_are_zero_or_negative_are_refused() {
    for bad in [0.0, -0.0, -1.0] {
        for (letter, parameters) in [
            ("a", NaturalCoordinates { crank: bad, ..SOUND }),
            ("b", NaturalCoordinates { coupler: bad, ..SOUND }),
            ("c", NaturalCoordinates { follower: bad, ..SOUND }),
        ] {
            assert_eq!(
                FourBar::new(parameters),
                Err(LinkageError::LengthNotPositive { key: letter, value: bad })
            );
        }
    }
    for (letter, parameters) in [
        ("d", NaturalCoordinates { crank_side: -1.0, ..SOUND }),
        ("e", NaturalCoordinates { follower_side: -1.0, ..SOUND }),
    ] {
        assert_eq!(
            FourBar::new(parameters),
            Err(LinkageError::DistanceNegative { key: letter, value: -1.0 })
        );
    }
}

#[test]
fn a_coupler_triangle_that_cannot_close_is_refused() {
    for [b, d, e] in [[5.0, 1.0, 7.0], [5.0, 1.0, 3.0], [1.0, 5.0, 3.0], [1.0, 3.0, 5.0], [5.0, 0.0, 4.9]] {
        assert_eq!(
            FourBar::new(NaturalCoordinates { coupler: b, crank_side: d, follower_side: e, ..SOUND }),
            Err(LinkageError::NoCouplerTriangle { b, d, e })
        );
    }
}

#[test]
fn other_constructors_refuse_what_is_not_a_number() {
    let pivots = [Complex::new(0.0, 0.0), Complex::new(4.0, 1.0)];
    for bad in [f64::NAN, f64::INFINITY] {
        let offset = Complex::new(1.0, bad);
        let made = FourBar::with_coupler_offset(pivots, [2.0, 5.0, 5.0], offset, AssemblyMode::Plus);
        assert!(matches!(made, Err(LinkageError::NotFinite { .. })));
        let sound = VectorLoop {
            crank_pivot: [0.0, 0.0],
            follower_pivot: [-350.0, 0.0],
            crank: 700.0,
            coupler: 300.0,
            follower: 500.0,
            coupler_point: 200.0,
            beta_deg: 30.0,
            assembly: AssemblyMode::Plus,
        };
        for wrong in [
            VectorLoop { coupler_point: bad, ..sound },
            VectorLoop { beta_deg: bad, ..sound },
            VectorLoop { coupler: bad, ..sound },
            VectorLoop { crank_pivot: [bad, 0.0], ..sound },
        ] {
            assert!(matches!(FourBar::from_vector_loop(wrong), Err(LinkageError::NotFinite { .. })));
        }
        let negative = VectorLoop { coupler_point: -1.0, ..sound };
        assert_eq!(
            FourBar::from_vector_loop(negative),
            Err(LinkageError::DistanceNegative { key: "Z1", value: -1.0 })
        );
    }
}

#[test]
fn de_castros_example_gives_the_table_with_the_coupler_points_put_right() {
    // Angles as printed to 0.1 degree; P of rows 2 to 4 as corrected (the table reuses row 1's coupler
    // angle).
    let l = crate::reference::shipped_linkage("de-castro-2-1");
    let rows = [
        (90.0f64, 258.9, 54.2, 64.893, 510.820),
        (120.0, -34.8, 60.5, -150.697, 589.540),
        (150.0, 30.0, 89.6, -506.209, 523.200),
        (180.0, 100.3, 143.8, -829.322, 152.564),
    ];
    for (crank_deg, coupler_deg, follower_deg, x, y) in rows {
        let j = l.position(crank_deg.to_radians()).joints().unwrap();
        let coupler = (j.follower_pin - j.crank_pin).arg().to_degrees();
        let follower = (j.follower_pin - l.follower_pivot()).arg().to_degrees();
        let apart = |a: f64, b: f64| ((a - b + 180.0).rem_euclid(360.0) - 180.0).abs();
        assert!(apart(coupler, coupler_deg) <= 0.06, "theta3 at {crank_deg}: {coupler}");
        assert!(apart(follower, follower_deg) <= 0.06, "theta4 at {crank_deg}: {follower}");
        assert!((j.coupler_point.re - x).abs() <= 5e-4 && (j.coupler_point.im - y).abs() <= 5e-4);
    }
    // Row 2 as printed is the crank pin of row 2 with the coupler angle of row 1.
    let wrong = l.position(120f64.to_radians()).joints().unwrap().crank_pin
        + (l.position(FRAC_PI_2).joints().unwrap().coupler_point
            - l.position(FRAC_PI_2).joints().unwrap().crank_pin);
    assert!((wrong - Complex::new(-285.1, 417.0)).norm() <= 0.1);
}

#[test]
fn romeros_four_configurations_meet_his_constraints() {
    let example = crate::reference::shipped_linkage("romero").natural_coordinates();
    let mut points = Vec::new();
    for assembly in [AssemblyMode::Plus, AssemblyMode::Minus] {
        for side in [CouplerSide::Plus, CouplerSide::Minus] {
            let l = FourBar::new(NaturalCoordinates { assembly, side, ..example }).unwrap();
            for i in 0..72 {
                let phi = TAU * f64::from(i) / 72.0;
                let j = l.position(phi).joints().expect("a crank-rocker closes everywhere");
                // Equations (5) to (8): squared distances, to eps of the scale squared.
                for (side, length) in [
                    (j.follower_pin - j.crank_pin, 5.0),
                    (j.follower_pin - l.follower_pivot(), 5.0),
                    (j.coupler_point - j.crank_pin, 5.0),
                    (j.coupler_point - j.follower_pin, 5.0f64),
                ] {
                    let residual = side.norm_sqr() - length * length;
                    assert!(residual.abs() <= 16.0 * f64::EPSILON * scale(&l).powi(2), "{residual}");
                }
            }
            points.push(l.position(FRAC_PI_3).joints().unwrap().coupler_point);
        }
    }
    for i in 0..4 {
        for j in 0..i {
            assert!((points[i] - points[j]).norm() > 0.5, "configurations {j} and {i} are one");
        }
    }
}

#[test]
fn the_complex_number_example_has_its_two_pairs_of_angles() {
    // a = 2, b = 3, c = 4, d = 5 (ground), theta2 = 60 degrees.
    let wanted = [(1, 39.27505, 114.79753), (-1, -86.10149, -161.62398)];
    for (t1, coupler_deg, follower_deg) in wanted {
        let l = linkage([[0.0, 0.0], [5.0, 0.0]], [2.0, 3.0, 4.0, 3.0, 0.0], t1, 1);
        let j = l.position(FRAC_PI_3).joints().unwrap();
        let coupler = (j.follower_pin - j.crank_pin).arg().to_degrees();
        let follower = (j.follower_pin - l.follower_pivot()).arg().to_degrees();
        assert!((coupler - coupler_deg).abs() <= 5.1e-6, "{coupler}");
        assert!((follower - follower_deg).abs() <= 5.1e-6, "{follower}");
    }
}
