//! The seeds' other position methods beside the natural coordinates, and where each of them ends.

use crate::reference::{
    Draws, any_linkage, cases, closed_position, linkage, rounding, scale, shipped_linkage,
};
use linkwright::internals::mechanism::four_bar::assembly_condition::AssemblyCondition;
use linkwright::internals::mechanism::four_bar::loop_closure::{
    Arctangent, Iteration, IterationOptions, IterationVerdict, LoopRoots, Singularity,
};
use linkwright::internals::mechanism::four_bar::mobility::wrapped;
use linkwright::internals::mechanism::{AssemblyMode, Complex, FourBar, LinkageType, cross};
use proptest::prelude::*;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

const BOTH: [AssemblyMode; 2] = [AssemblyMode::Plus, AssemblyMode::Minus];

fn iterate(l: &FourBar, phi: f64, start_deg: f64) -> Iteration {
    let start_coupler_angle = start_deg.to_radians();
    l.close_by_iteration(phi, &IterationOptions { start_coupler_angle, ..Default::default() })
}

/// s/|Ax - d| of the algebraic method: what it loses beside the others.
fn loss(l: &FourBar, phi: f64) -> f64 {
    let v = l.follower_pivot() - l.crank_pivot() - Complex::from_polar(l.crank(), phi);
    v.norm() / (v * Complex::from_polar(1.0, -l.ground_angle())).re.abs()
}

proptest! {
    #![proptest_config(cases(400))]

    #[test]
    fn all_methods_agree_with_natural_coordinates((l, phi) in closed_position(0.02)) {
        let algebra = l.close_by_algebra(phi);
        let complex = l.close_by_complex_numbers(phi);
        for assembly in BOTH {
            let wanted = l.position_with(phi, assembly).joints().expect("closed");
            let [pin, point] = rounding(&l, phi, assembly);
            let root = complex.root(assembly).expect("closed");
            prop_assert_eq!(root.assembly, assembly);
            prop_assert!((root.joints.follower_pin - wanted.follower_pin).norm() <= pin);
            prop_assert!((root.joints.coupler_point - wanted.coupler_point).norm() <= point);
            prop_assert!(wrapped(root.coupler_angle
                - (wanted.follower_pin - wanted.crank_pin).arg()).abs() <= 2.0 * pin / l.coupler());
            prop_assert!(wrapped(root.follower_angle
                - (wanted.follower_pin - l.follower_pivot()).arg()).abs() <= 2.0 * pin / l.follower());
            let worse = loss(&l, phi).powi(2);
            if let Some(root) = algebra.root(assembly) {
                prop_assert!((root.joints.follower_pin - wanted.follower_pin).norm() <= pin * worse);
                prop_assert!((root.joints.coupler_point - wanted.coupler_point).norm() <= point * worse);
                prop_assert!(root.residual <= pin * worse);
            } else {
                prop_assert_eq!(algebra, LoopRoots::Singular(Singularity::CrankPinOverFollowerPivot));
                prop_assert!(worse > 1e7);
            }
        }
    }

    #[test]
    fn the_iteration_is_where_it_says_it_is((l, phi) in closed_position(0.1), start in -PI..PI) {
        let options = IterationOptions { start_coupler_angle: start, ..Default::default() };
        let run = l.close_by_iteration(phi, &options);
        let Some(root) = run.root() else { return Err(TestCaseError::fail(format!("{run:?}"))) };
        let wanted = l.position_with(phi, root.assembly).joints().expect("closed");
        let sine = crate::reference::transmission(wanted.crank_pin, wanted.follower_pin, l.follower_pivot()).sin();
        let slack = rounding(&l, phi, root.assembly)[0] + 2.0 * l.coupler() * 1e-12 / (sine * sine);
        prop_assert!((root.joints.follower_pin - wanted.follower_pin).norm() <= slack);
        prop_assert!(run.iterations < 10_000 && run.step <= 1e-12);
    }

    #[test]
    fn no_method_closes_a_loop_that_is_open(l in any_linkage(), phi in -7.0..7.0f64) {
        let s = crate::reference::diagonal(&l, phi);
        let (b, c) = (l.coupler(), l.follower());
        let missing = ((b - c).abs() - s).max(s - b - c);
        prop_assume!(missing > 1e-3 * scale(&l));
        prop_assert_eq!(l.close_by_complex_numbers(phi), LoopRoots::Open);
        let algebra = l.close_by_algebra(phi);
        prop_assert!(algebra == LoopRoots::Open || loss(&l, phi) > 1e3, "{algebra:?}");
        let run = l.close_by_iteration(phi, &IterationOptions::default());
        prop_assert!(matches!(run.verdict, IterationVerdict::FalsePoint | IterationVerdict::Cycling
            | IterationVerdict::NotConverged), "{run:?}");
        prop_assert!(run.residual > 0.9 * missing);
    }

    #[test]
    fn the_sufficient_condition_is_the_one_that_closes(l in any_linkage(), phi in -7.0..7.0f64) {
        let s = crate::reference::diagonal(&l, phi);
        let (b, c) = (l.coupler(), l.follower());
        prop_assume!((s - (b - c).abs()).abs().min((b + c - s).abs()) > 1e-10 * scale(&l));
        let condition = l.assembly_condition(phi).expect("C is off B");
        prop_assert!(condition.triangle_closes);
        prop_assert_eq!(condition.sufficient(), l.position(phi).is_closed());
        prop_assert!(condition.necessary() || !condition.sufficient());
    }
}

#[test]
fn methods_agree_on_linkages_of_every_type() {
    let mut draws = Draws(41);
    let mut seen = [0; 6];
    for _ in 0..400 {
        let l = draws.clear_linkage();
        let kind = l.linkage_type().expect("joined");
        for i in 0..36 {
            let phi = f64::from(i) * PI / 18.0 + 0.011;
            for assembly in BOTH {
                let Some(wanted) = l.position_with(phi, assembly).joints() else { continue };
                let Some([c, d, _]) = crate::reference::position(&l, phi, assembly) else { continue };
                if crate::reference::transmission(c, d, l.follower_pivot()).sin() < 0.01 {
                    continue;
                }
                let [pin, _] = rounding(&l, phi, assembly);
                let complex = l.close_by_complex_numbers(phi).root(assembly).expect("closed").joints;
                assert!((complex.follower_pin - wanted.follower_pin).norm() <= pin);
                if let Some(root) = l.close_by_algebra(phi).root(assembly) {
                    let slack = pin * loss(&l, phi).powi(2);
                    assert!((root.joints.follower_pin - wanted.follower_pin).norm() <= slack);
                }
                seen[LinkageType::ALL.iter().position(|t| *t == kind).expect("a type")] += 1;
            }
        }
    }
    assert!(seen[..5].iter().all(|n| *n > 200), "{seen:?}");
}

#[test]
fn the_complex_number_example_has_the_printed_roots() {
    // UTP: a = 2, b = 3, c = 4, d = 5, theta2 = 60 degrees, to the four decimals of the slides.
    let l = linkage([[0.0, 0.0], [5.0, 0.0]], [2.0, 3.0, 4.0, 3.0, 0.0], 1, 1);
    let printed = [
        (AssemblyMode::Plus, 39.2750, 114.7975, [-0.4194, 0.9078], [0.7741, 0.6330]),
        (AssemblyMode::Minus, -86.1015, -161.6240, [-0.9490, -0.3153], [0.0680, -0.9977]),
    ];
    for roots in [l.close_by_complex_numbers(FRAC_PI_3), l.close_by_algebra(FRAC_PI_3)] {
        for (assembly, coupler_deg, follower_deg, t, s) in printed {
            let root = roots.root(assembly).expect("closed");
            assert!((root.coupler_angle.to_degrees() - coupler_deg).abs() <= 0.5001e-4);
            assert!((root.follower_angle.to_degrees() - follower_deg).abs() <= 0.5001e-4);
            for (angle, [x, y]) in [(root.follower_angle, t), (root.coupler_angle, s)] {
                assert!((angle.cos() - x).abs() <= 0.5001e-4 && (angle.sin() - y).abs() <= 0.5001e-4);
            }
        }
    }
}

#[test]
fn romeros_example_closes_alike_by_every_method_at_every_angle() {
    let l = shipped_linkage("romero");
    for i in 0..360 {
        let phi = f64::from(i).to_radians();
        for assembly in BOTH {
            let wanted = l.position_with(phi, assembly).joints().expect("closed").follower_pin;
            let [pin, _] = rounding(&l, phi, assembly);
            for roots in [l.close_by_algebra(phi), l.close_by_complex_numbers(phi)] {
                let got = roots.root(assembly).expect("closed").joints.follower_pin;
                assert!((got - wanted).norm() <= pin * loss(&l, phi).powi(2));
            }
        }
    }
}

#[test]
fn de_castros_iteration_finds_his_angles() {
    let l = shipped_linkage("de-castro-2-1");
    let table = [(90.0f64, 258.9, 54.2), (120.0, -34.8, 60.5), (150.0, 30.0, 89.6), (180.0, 100.3, 143.8)];
    for (crank_deg, coupler_deg, follower_deg) in table {
        let run = iterate(&l, crank_deg.to_radians(), coupler_deg + 20.0);
        let root = run.root().expect("converged");
        assert_eq!(root.assembly, AssemblyMode::Plus);
        let apart = |angle: f64, deg: f64| wrapped(angle - deg.to_radians()).to_degrees().abs();
        assert!(apart(root.coupler_angle, coupler_deg) <= 0.0501, "{}", root.coupler_angle.to_degrees());
        assert!(apart(root.follower_angle, follower_deg) <= 0.0501, "{}", root.follower_angle.to_degrees());
        assert!(run.iterations < 400, "{}", run.iterations);
    }
}

#[test]
fn the_printed_arctan_settles_on_a_point_that_closes_nothing() {
    // Example 2.1 at 90 degrees with arctangents of quotients: 63.43, 63.43, the line C-B.
    let l = shipped_linkage("de-castro-2-1");
    for start_deg in [0.0f64, 20.0, -40.0, 60.0] {
        let options = IterationOptions {
            start_coupler_angle: start_deg.to_radians(),
            arctangent: Arctangent::OfQuotient,
            ..Default::default()
        };
        let run = l.close_by_iteration(FRAC_PI_2, &options);
        assert_eq!(run.verdict, IterationVerdict::FalsePoint, "{run:?}");
        assert!((run.coupler_angle.to_degrees() - 63.43).abs() <= 0.005);
        assert!((run.follower_angle.to_degrees() - 63.43).abs() <= 0.005);
        assert!(run.residual > 100.0);
    }
}

#[test]
fn a_start_on_the_line_of_crank_pin_and_pivot_is_a_false_point() {
    // Pins and pivot on the x axis: s = 3, b = c = 5; theta3 = 0 stays there for ever.
    let l = linkage([[0.0, 0.0], [4.0, 0.0]], [1.0, 5.0, 5.0, 5.0, 5.0], 1, 1);
    let run = iterate(&l, 0.0, 0.0);
    assert_eq!(run.verdict, IterationVerdict::FalsePoint);
    assert!(run.residual > 1.0 && run.root().is_none());
    assert!(iterate(&l, 0.0, 1.0).root().is_some());
}

#[test]
fn a_loop_that_cannot_close_settles_on_a_false_point() {
    let l = linkage([[0.0, 0.0], [5.0, 0.0]], [4.0, 3.5, 2.5, 2.0, 3.0], 1, 1);
    let run = iterate(&l, 3.0, 50.0);
    assert_eq!(run.verdict, IterationVerdict::FalsePoint, "{run:?}");
    // s = |CB| is about 9; b + c = 6: three units are missing.
    assert!((run.residual - (crate::reference::diagonal(&l, 3.0) - 6.0)).abs() <= 1e-9);
}

#[test]
fn next_to_a_toggle_the_iteration_is_slow_and_says_so() {
    let l = linkage([[0.0, 0.0], [5.0, 0.0]], [4.0, 3.5, 2.5, 1.0, 3.0], 1, 1);
    let toggle = (5.0f64 / 40.0).acos();
    let run = iterate(&l, toggle - 1e-9, 80.0);
    assert_eq!(run.verdict, IterationVerdict::NotConverged, "{run:?}");
    assert_eq!(run.iterations, 10_000);
    // The factor a round is cos^2(theta3 - theta4): fewer rounds far away than near.
    let rounds = |off: f64| iterate(&l, toggle - off, 80.0).iterations;
    assert!(rounds(0.5) < rounds(0.05) && rounds(0.05) < rounds(0.005));
}

#[test]
fn no_rounds_no_start_and_no_direction_have_verdicts() {
    let l = shipped_linkage("romero");
    let none = l.close_by_iteration(1.0, &IterationOptions { iterations: 0, ..Default::default() });
    assert_eq!((none.verdict, none.iterations), (IterationVerdict::NotConverged, 0));
    assert_eq!(iterate(&l, 1.0, f64::NAN).verdict, IterationVerdict::NoDirection);
    assert_eq!(iterate(&l, f64::NAN, 1.0).verdict, IterationVerdict::NoDirection);
    // D starts on B: the follower has no direction. b = s = 3 and theta3 = 0.
    let on_b = linkage([[0.0, 0.0], [4.0, 0.0]], [1.0, 3.0, 2.0, 3.0, 3.0], 1, 1);
    assert_eq!(iterate(&on_b, 0.0, 0.0).verdict, IterationVerdict::NoDirection);
}

#[test]
fn the_algebraic_method_says_where_it_is_singular_and_the_complex_one_does_not_care() {
    // C straight over B: Ax = d = 1 at 60 degrees with a = 2.
    let l = linkage([[0.0, 0.0], [1.0, 0.0]], [2.0, 2.5, 2.0, 1.0, 2.0], 1, 1);
    let over = FRAC_PI_3;
    let singular = LoopRoots::Singular(Singularity::CrankPinOverFollowerPivot);
    assert_eq!(l.close_by_algebra(over), singular);
    assert_eq!(l.close_by_algebra(over + 1e-6), singular);
    assert!(matches!(l.close_by_algebra(over + 1e-2), LoopRoots::Closed(_)));
    let root = l.close_by_complex_numbers(over).root(AssemblyMode::Plus).expect("closed");
    let wanted = l.position(over).joints().expect("closed").follower_pin;
    assert!((root.joints.follower_pin - wanted).norm() <= rounding(&l, over, AssemblyMode::Plus)[0]);
    // Both are singular with C on B.
    let on_b = linkage([[0.0, 0.0], [1.0, 0.0]], [1.0, 2.0, 2.0, 2.0, 2.0], 1, 1);
    let singular = LoopRoots::Singular(Singularity::CrankPinOnFollowerPivot);
    assert_eq!(on_b.close_by_algebra(0.0), singular);
    assert_eq!(on_b.close_by_complex_numbers(0.0), singular);
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(l.close_by_algebra(bad), LoopRoots::Open);
        assert_eq!(l.close_by_complex_numbers(bad), LoopRoots::Open);
    }
}

#[test]
fn at_a_toggle_both_roots_are_one_and_close() {
    let l = linkage([[0.0, 0.0], [5.0, 0.0]], [4.0, 3.5, 2.5, 1.0, 3.0], 1, 1);
    let toggle = (5.0f64 / 40.0).acos();
    let slack = 3.5 * (64.0 * f64::EPSILON).sqrt();
    for roots in [l.close_by_algebra(toggle), l.close_by_complex_numbers(toggle)] {
        let [plus, minus] = BOTH.map(|t1| roots.root(t1).expect("closed").joints.follower_pin);
        assert!((plus - minus).norm() <= 10.0 * slack, "{plus} {minus}");
    }
}

#[test]
fn both_roots_lie_on_their_sides_wherever_the_ground_points() {
    for turn in 0..12 {
        let b = Complex::from_polar(4.0, f64::from(turn) * 0.5);
        let l = linkage([[0.3, -0.2], [0.3 + b.re, b.im - 0.2]], [2.0, 5.0, 4.5, 3.0, 3.0], 1, 1);
        for i in 0..24 {
            let phi = f64::from(i) * 0.26;
            for roots in [l.close_by_algebra(phi), l.close_by_complex_numbers(phi)] {
                let LoopRoots::Closed(pair) = roots else { continue };
                for root in pair {
                    let v = l.follower_pivot() - root.joints.crank_pin;
                    let side = cross(v, root.joints.follower_pin - root.joints.crank_pin);
                    assert!(side * root.assembly.sign() > 0.0);
                }
            }
        }
    }
}

#[test]
fn condition_20_holds_where_no_loop_closes() {
    let l = linkage([[0.0, 0.0], [5.0, 0.0]], [1.0, 2.0, 2.0, 5.0, 5.0], 1, 1);
    let at = l.assembly_condition(PI).expect("C is off B");
    assert!((at.l1 - 3.0).abs() <= 1e-15 && (at.l2 - 1.0).abs() <= 1e-15);
    assert!((at.ratio.expect("a ratio") - 2.9).abs() <= 1e-14);
    assert!((at.loop_gap + 5.0).abs() <= 1e-14 && (at.triangle_gap - 24.0).abs() <= 1e-14);
    assert!(at.necessary() && !at.sufficient() && !at.loop_closes && at.triangle_closes);
    assert!(!l.position(PI).is_closed());
    // The other way round: the loop closes, the triangle b = 5, d = 1, e = 4.5 + 2 doesn't.
    let triangle = AssemblyCondition::of_lengths(4.0, 5.0, 5.0, 1.0, 6.5).expect("lengths");
    assert!(triangle.necessary() && triangle.loop_closes && !triangle.triangle_closes);
}

#[test]
fn the_condition_of_romeros_example_holds_all_round_and_degenerate_lengths_have_none() {
    let l = shipped_linkage("romero");
    for i in 0..360 {
        let at = l.assembly_condition(f64::from(i).to_radians()).expect("C is off B");
        assert!(at.necessary() && at.sufficient());
    }
    assert_eq!(AssemblyCondition::of_lengths(0.0, 1.0, 1.0, 1.0, 1.0), None);
    assert_eq!(AssemblyCondition::of_lengths(1.0, 0.0, 1.0, 1.0, 1.0), None);
    assert_eq!(AssemblyCondition::of_lengths(f64::NAN, 1.0, 1.0, 1.0, 1.0), None);
    // l1 = l2 = 0: nothing to divide by, and it holds.
    let right = AssemblyCondition::of_lengths(3.0, 4.0, 5.0, 3.0, 5.0).expect("lengths");
    assert_eq!((right.l1, right.l2, right.ratio), (0.0, 0.0, None));
    assert!(right.necessary() && right.sufficient());
}
