//! Velocities and accelerations: the seed's tables, central differences, analytic cases, and toggles.

use crate::reference::{cases, closed_position, linkage, position, scale, shipped_linkage, transmission};
use linkwright::internals::mechanism::four_bar::gradient::TOGGLE_SINE;
use linkwright::internals::mechanism::four_bar::mobility::wrapped;
use linkwright::internals::mechanism::four_bar::motion::{CrankMotion, LinkageMotion, Motion};
use linkwright::internals::mechanism::{AssemblyMode, Complex, FourBar, Position, VectorLoop};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

fn lift() -> FourBar {
    // De Castro, example 2.2: a parallelogram.
    FourBar::from_vector_loop(VectorLoop {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [1000.0, 0.0],
        crank: 500.0,
        coupler: 1000.0,
        follower: 500.0,
        coupler_point: 200.0,
        beta_deg: 30.0,
        assembly: AssemblyMode::Plus,
    })
    .expect("a linkage")
}

fn definite(l: &FourBar, phi: f64, input: CrankMotion) -> LinkageMotion {
    l.motion(phi, input).definite().expect("a definite motion")
}

/// Whether a value rounds to the printed one: half a unit of its last digit.
fn prints(value: f64, printed: f64, digits: i32) -> bool {
    (value - printed).abs() <= 0.5 * 10f64.powi(-digits) * (1.0 + 1e-9)
}

#[test]
fn de_castros_examples_3_1_and_4_1_are_right_to_every_printed_digit() {
    let m = definite(&shipped_linkage("de-castro-2-1"), 120f64.to_radians(), CrankMotion::steady(5.0));
    let rows = [
        (m.coupler.speed_rad_s, 10.10, 2),
        (m.follower.speed_rad_s, 2.99, 2),
        (m.crank_pin.velocity.re / 1000.0, -3.03, 2),
        (m.crank_pin.velocity.im / 1000.0, -1.75, 2),
        (m.follower_pin.velocity.re / 1000.0, -1.30, 2),
        (m.follower_pin.velocity.im / 1000.0, 0.74, 2),
        (m.coupler_point.velocity.re / 1000.0, -2.86, 2),
        (m.coupler_point.velocity.im / 1000.0, 0.26, 2),
        (m.coupler.acceleration_rad_s2, 5.31, 2),
        (m.follower.acceleration_rad_s2, 30.46, 2),
        (m.crank_pin.acceleration.re / 1000.0, 8.8, 1),
        (m.crank_pin.acceleration.im / 1000.0, -15.2, 1),
        (m.follower_pin.acceleration.re / 1000.0, -15.5, 1),
        (m.follower_pin.acceleration.im / 1000.0, 3.6, 1),
        (m.coupler_point.acceleration.re / 1000.0, -11.5, 1),
        (m.coupler_point.acceleration.im / 1000.0, -12.4, 1),
        // With more digits, from an independent computation by angles.
        (m.coupler.speed_rad_s, 10.0973, 4),
        (m.follower.speed_rad_s, 2.99489, 5),
        (m.coupler_point.velocity.re / 1000.0, -2.86268, 5),
        (m.coupler_point.velocity.im / 1000.0, 0.26243, 5),
        (m.coupler.acceleration_rad_s2, 5.31281, 5),
        (m.follower.acceleration_rad_s2, 30.45945, 5),
        (m.coupler_point.acceleration.re / 1000.0, -11.4816, 4),
        (m.coupler_point.acceleration.im / 1000.0, -12.3961, 4),
    ];
    for (i, (value, printed, digits)) in rows.into_iter().enumerate() {
        assert!(prints(value, printed, digits), "figure {i}: {value} for {printed}");
    }
    assert!(prints(m.posture.coupler_angle.to_degrees(), -34.8, 1));
    assert!(prints(m.posture.follower_angle.to_degrees(), 60.5, 1));
}

#[test]
fn de_castros_examples_2_2_3_2_and_4_2_are_right_to_every_printed_digit() {
    let l = lift();
    for (deg, x, y) in [(30.0f64, 606.2, 350.0), (90.0, 173.2, 600.0), (150.0, -259.8, 350.0)] {
        let posture = l.motion(deg.to_radians(), CrankMotion::steady(1.0)).posture().expect("closed");
        assert!(
            prints(posture.joints.coupler_point.re, x, 1) && prints(posture.joints.coupler_point.im, y, 1)
        );
        assert!(prints(posture.coupler_angle.to_degrees(), 0.0, 1));
        assert!(prints(posture.follower_angle.to_degrees(), deg, 1));
    }
    let m = definite(&l, 60f64.to_radians(), CrankMotion::steady(5.0));
    assert!(prints(m.coupler.speed_rad_s, 0.0, 2) && prints(m.follower.speed_rad_s, 5.0, 2));
    assert!(prints(m.coupler.acceleration_rad_s2, 0.0, 2) && prints(m.follower.acceleration_rad_s2, 0.0, 2));
    for point in [m.crank_pin, m.follower_pin, m.coupler_point] {
        assert!(prints(point.velocity.re / 1000.0, -2.17, 2) && prints(point.velocity.im / 1000.0, 1.25, 2));
        // -6.25 is printed -6.3, half away from zero.
        assert!((point.acceleration.re / 1000.0 + 6.25).abs() <= 1e-12);
        assert!(prints(point.acceleration.im / 1000.0, -10.8, 1));
    }
}

#[test]
fn a_parallelogram_moves_every_point_of_its_coupler_alike() {
    let l = lift();
    let input = CrankMotion { speed_rad_s: -3.0, acceleration_rad_s2: 7.0 };
    for deg in [10, 45, 90, 135, 170] {
        let m = definite(&l, f64::from(deg).to_radians(), input);
        // 1/sin^3 of at least 0.17: 200 times the rounding of (3^2 + 7) 500.
        let slack = 200.0 * 16.0 * f64::EPSILON * 16.0 * scale(&l);
        for point in [m.follower_pin, m.coupler_point] {
            assert!((point.velocity - m.crank_pin.velocity).norm() <= slack);
            assert!((point.acceleration - m.crank_pin.acceleration).norm() <= slack);
        }
        assert!((m.follower.speed_rad_s + 3.0).abs() <= slack / 500.0);
        assert!((m.follower.acceleration_rad_s2 - 7.0).abs() <= slack / 500.0);
    }
}

#[test]
fn pivots_in_one_place_turn_every_link_with_the_crank() {
    let l = linkage([[1.0, 2.0], [1.0, 2.0]], [1.0, 1.5, 1.2, 0.8, 1.0], -1, 1);
    let input = CrankMotion { speed_rad_s: 2.0, acceleration_rad_s2: -5.0 };
    let m = definite(&l, 0.7, input);
    let slack = 256.0 * f64::EPSILON * scale(&l);
    for link in [m.coupler, m.follower] {
        assert!((link.speed_rad_s - 2.0).abs() <= slack && (link.acceleration_rad_s2 + 5.0).abs() <= slack);
    }
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn central_differences_find_the_same_velocities_and_accelerations(
        (l, phi) in closed_position(0.05),
        omega in -4.0..4.0f64,
        alpha in -9.0..9.0f64,
    ) {
        // phi(t) = phi + omega t + alpha t^2/2. Positions are differenced for velocities, velocities for
        // accelerations. A quantity of order n by time varies on the scale sin^2 mu / K, K = scale/least
        // length times the speed: truncation h^2 times its third derivative, rounding eps/(h sin mu) more.
        let [c, d, _] = position(&l, phi, l.assembly()).expect("closed");
        let sine = transmission(c, d, l.follower_pivot()).sin();
        let least = l.coupler().min(l.follower());
        let rate = 1.0 + omega.abs() + alpha.abs().sqrt();
        let shape = scale(&l) / least / (sine * sine);
        let h = f64::EPSILON.cbrt() / (rate * shape);
        let at = |t: f64| phi + omega * t + 0.5 * alpha * t * t;
        let input = |t: f64| CrankMotion { speed_rad_s: omega + alpha * t, acceleration_rad_s2: alpha };
        let [before, now, after] = [-h, 0.0, h].map(|t| definite(&l, at(t), input(t)));
        let relative = 64.0 * f64::EPSILON.cbrt().powi(2) * shape;
        let slope = |a: f64, b: f64| (a - b) / (2.0 * h);
        let turn = |a: f64, b: f64| wrapped(a - b) / (2.0 * h);
        let (v_slack, a_slack) = (relative * rate * shape, relative * (rate * shape).powi(2));
        let points = |m: &LinkageMotion| [
            (m.posture.joints.crank_pin, m.crank_pin),
            (m.posture.joints.follower_pin, m.follower_pin),
            (m.posture.joints.coupler_point, m.coupler_point),
        ];
        for ((b, n), a) in points(&before).into_iter().zip(points(&now)).zip(points(&after)) {
            let v = (a.0 - b.0) / (2.0 * h);
            let acc = (a.1.velocity - b.1.velocity) / (2.0 * h);
            prop_assert!((v - n.1.velocity).norm() <= v_slack * scale(&l), "{v} for {}", n.1.velocity);
            prop_assert!((acc - n.1.acceleration).norm() <= a_slack * scale(&l), "{acc} for {:?}", n.1);
        }
        let links = |m: &LinkageMotion| [
            (m.posture.coupler_angle, m.coupler),
            (m.posture.follower_angle, m.follower),
        ];
        for ((b, n), a) in links(&before).into_iter().zip(links(&now)).zip(links(&after)) {
            prop_assert!((turn(a.0, b.0) - n.1.speed_rad_s).abs() <= v_slack * scale(&l));
            prop_assert!((slope(a.1.speed_rad_s, b.1.speed_rad_s) - n.1.acceleration_rad_s2).abs()
                <= a_slack * scale(&l));
        }
    }

    #[test]
    fn de_castros_formulas_with_angles_give_the_same((l, phi) in closed_position(0.02), omega in -4.0..4.0f64,
        alpha in -9.0..9.0f64) {
        let m = definite(&l, phi, CrankMotion { speed_rad_s: omega, acceleration_rad_s2: alpha });
        let (t3, t4) = (m.posture.coupler_angle, m.posture.follower_angle);
        let (l2, l3, l4) = (l.crank(), l.coupler(), l.follower());
        let va = [-omega * l2 * phi.sin(), omega * l2 * phi.cos()];
        let sine = (t3 - t4).sin();
        let w3 = (va[0] * t4.cos() + va[1] * t4.sin()) / (l3 * sine);
        let w4 = (va[0] * t3.cos() + va[1] * t3.sin()) / (l4 * sine);
        let vb = [-w4 * l4 * t4.sin(), w4 * l4 * t4.cos()];
        let aa = [-alpha * l2 * phi.sin() - omega * va[1], alpha * l2 * phi.cos() + omega * va[0]];
        let a1 = aa[0] - w3 * (vb[1] - va[1]) + w4 * vb[1];
        let a2 = aa[1] + w3 * (vb[0] - va[0]) - w4 * vb[0];
        let a3 = (a1 * t4.cos() + a2 * t4.sin()) / (l3 * sine);
        let a4 = (a1 * t3.cos() + a2 * t3.sin()) / (l4 * sine);
        let shape = scale(&l) / l3.min(l4) / (sine * sine);
        let unit = 64.0 * f64::EPSILON * shape * scale(&l);
        let rate = 1.0 + omega.abs() + alpha.abs().sqrt();
        prop_assert!((m.posture.sine - sine).abs() <= unit);
        prop_assert!((m.coupler.speed_rad_s - w3).abs() <= unit * rate * shape);
        prop_assert!((m.follower.speed_rad_s - w4).abs() <= unit * rate * shape);
        prop_assert!((m.coupler.acceleration_rad_s2 - a3).abs() <= unit * (rate * shape).powi(2));
        prop_assert!((m.follower.acceleration_rad_s2 - a4).abs() <= unit * (rate * shape).powi(2));
    }

    #[test]
    fn the_velocity_of_the_point_is_its_gradient_by_the_crank_angle((l, phi) in closed_position(0.02)) {
        let m = definite(&l, phi, CrankMotion::steady(1.0));
        let (_, by_angle) = l.gradient(phi).expect("a gradient");
        let slack = 64.0 * f64::EPSILON * scale(&l) * (scale(&l) / l.coupler() / m.posture.sine).powi(2);
        prop_assert!((m.coupler_point.velocity - by_angle).norm() <= slack);
    }

    #[test]
    fn a_toggle_has_no_velocity_and_nothing_next_to_it_is_huge(
        l in crate::reference::any_linkage(),
        k in -3..=3i64,
    ) {
        // The toggles themselves, and their neighbours among the doubles: a velocity is never above what
        // sin^2 mu = 64 eps (..) allows, 1e7 times the crank's pin speed over the shortest link.
        for toggle in l.mobility().toggles() {
            let phi = f64::from_bits((toggle.crank_angle.to_bits() as i64 + k) as u64);
            match l.motion(phi, CrankMotion::steady(1.0)) {
                Motion::Definite(m) => {
                    prop_assert!(m.posture.sine.abs() > 1e-7);
                    prop_assert!(m.coupler.speed_rad_s.abs() <= 1.1e7 * l.crank() / l.coupler());
                }
                Motion::Singular(posture) => prop_assert!(posture.sine.abs() <= 1e-3),
                Motion::Open => {}
                other => prop_assert!(false, "{other:?}"),
            }
        }
    }
}

#[test]
fn a_toggle_is_singular_with_its_position_and_no_number() {
    let l = linkage([[0.0, 0.0], [5.0, 0.0]], [4.0, 3.5, 2.5, 1.0, 3.0], 1, 1);
    let toggle = (5.0f64 / 40.0).acos();
    for assembly in [AssemblyMode::Plus, AssemblyMode::Minus] {
        let motion = l.motion_with(toggle, assembly, CrankMotion::steady(5.0));
        assert!(matches!(motion, Motion::Singular(_)) && motion.definite().is_none());
        let posture = motion.posture().expect("the position is known");
        assert!(posture.sine.abs() <= 1e-6);
    }
    assert_eq!(l.motion(toggle + 1e-6, CrankMotion::steady(5.0)), Motion::Open);
    assert!(l.motion(toggle - 1e-6, CrankMotion::steady(5.0)).definite().is_some());
    // The two flat positions of the parallelogram.
    for phi in [0.0, PI, TAU] {
        assert!(matches!(lift().motion(phi, CrankMotion::steady(5.0)), Motion::Singular(_)));
    }
    const { assert!(TOGGLE_SINE < 1e-7) };
}

#[test]
fn open_undetermined_and_infinite_are_told_apart() {
    let steady = CrankMotion::steady(1.0);
    let on_b = |follower| linkage([[0.0, 0.0], [1.0, 0.0]], [1.0, 2.0, follower, 2.0, 2.0], 1, 1);
    assert_eq!(on_b(2.0).position(0.0), Position::Undetermined);
    assert_eq!(on_b(2.0).motion(0.0, steady), Motion::Undetermined);
    assert_eq!(on_b(1.5).motion(0.0, steady), Motion::Open);
    let l = shipped_linkage("romero");
    assert_eq!(l.motion(f64::NAN, steady), Motion::Open);
    for speed in [f64::NAN, f64::INFINITY, 1e200] {
        assert_eq!(l.motion(1.0, CrankMotion::steady(speed)), Motion::NotFinite);
    }
    assert_eq!(
        l.motion(1.0, CrankMotion { speed_rad_s: 0.0, acceleration_rad_s2: f64::NAN }),
        Motion::NotFinite
    );
    // A crank that stands still holds everything still.
    let still = definite(&l, 1.0, CrankMotion::steady(0.0));
    assert_eq!(still.coupler_point.velocity.norm() + still.coupler_point.acceleration.norm(), 0.0);
    assert_eq!(Complex::new(CrankMotion::steady_rpm(60.0).speed_rad_s, 0.0), Complex::new(TAU, 0.0));
}
