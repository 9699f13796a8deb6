//! What is certified, and what must not be.

use crate::common::thorough::cases;
use crate::known::{
    GAUSSIAN, Known, WMS3, random_complex, random_real, random_real_curve, real_linkages, target,
};
use linkwright::internals::mechanism::Complex;
use linkwright::internals::numbers::arithmetic::streams::{Stream, normal, stream};
use linkwright::internals::numbers::nine_point::certificate::{
    Certificate, Refused, certify, certify_all, certify_displacements, check,
};
use linkwright::internals::numbers::nine_point::conjugation::Reality;
use linkwright::internals::numbers::nine_point::distinct::not_proved_distinct;
use linkwright::internals::numbers::nine_point::refinement::refine;
use linkwright::internals::numbers::nine_point::target::Kind;
use linkwright::internals::numbers::nine_point::{Displacements, Solution, Target};

fn certificates(target: &Target, known: &[Known]) -> Vec<Certificate> {
    let solutions: Vec<Solution> = known.iter().map(|known| known.solution).collect();
    certify_all(target, &solutions)
        .into_iter()
        .enumerate()
        .map(|(i, one)| one.unwrap_or_else(|refused| panic!("class {}: {refused}", known[i].class)))
        .collect()
}

/// Every unknown in a row.
fn flat(of: &Solution) -> Vec<Complex> {
    [of.pins, of.grounds, of.pins_starred, of.grounds_starred]
        .concat()
        .into_iter()
        .chain(of.rotations)
        .collect()
}

fn perturbed(stream: &mut Stream, of: &Solution, by: f64) -> Solution {
    let mut move_ = |z: Complex| z + Complex::new(normal(stream, 0.0, by), normal(stream, 0.0, by));
    Solution {
        pins: of.pins.map(&mut move_),
        grounds: of.grounds.map(&mut move_),
        pins_starred: of.pins_starred.map(&mut move_),
        grounds_starred: of.grounds_starred.map(&mut move_),
        rotations: of.rotations.map(&mut move_),
    }
}

#[test]
fn the_published_real_linkages_are_proved_real_and_their_classes_distinct() {
    for (name, points, classes) in [("wms3", WMS3, 64), ("gaussian", GAUSSIAN, 8)] {
        let target = target(points);
        let known = real_linkages(name, &target);
        assert_eq!(known.len(), 3 * classes);
        let certificates = certificates(&target, &known);
        for (certificate, known) in certificates.iter().zip(&known) {
            assert!(certificate.is_real(), "{name} class {}: {certificate:?}", known.class);
            let largest = flat(&certificate.refined).into_iter().map(Complex::norm).fold(0.0, f64::max);
            assert!(
                certificate.radius <= f64::EPSILON * largest,
                "{name} class {}: {certificate:?}",
                known.class
            );
            // Twelve digits were given, of the points' unit; the rotations follow from them.
            assert!(certificate.moved < 1e-6, "{name} class {}: {:e}", known.class, certificate.moved);
        }
        // The cognates of a class cannot be told apart; all others are.
        let mut cognates = Vec::new();
        for first in (0..known.len()).step_by(3) {
            cognates.extend([[first, first + 1], [first, first + 2], [first + 1, first + 2]]);
        }
        assert_eq!(not_proved_distinct(&certificates), cognates);
        let one_each: Vec<Certificate> = certificates.iter().step_by(3).copied().collect();
        assert_eq!(not_proved_distinct(&one_each), Vec::<[usize; 2]>::new());
    }
}

#[test]
fn the_linkage_that_drew_the_points_is_proved_real() {
    // The points are the kernel's, rounded: an exact solution lies near, as far as its condition carries the rounding.
    let mut certified = 0;
    for index in 0..150 {
        let Some((target, solution)) = random_real(&mut stream(11, index)) else { continue };
        match certify(&target, &solution) {
            Ok(certificate) => {
                assert!(certificate.is_real(), "{index}: {certificate:?}");
                certified += 1;
            }
            Err(refused) => panic!("{index}: {refused}"),
        }
    }
    assert!(certified > 140, "{certified}");
}

#[test]
fn random_complex_solutions_are_certified_and_their_reality_left_open() {
    for index in 0..200 {
        let (displacements, solution) = random_complex(&mut stream(12, index));
        let certificate = certify_displacements(&displacements, &solution).expect("a generic solution");
        assert_eq!(certificate.reality, Reality::Undecided);
        let refined = refine(&displacements, &solution).expect("a generic solution");
        assert_eq!(refined.solution, certificate.refined);
        assert!(refined.last_step < 1e-16, "{index}: {:e}", refined.last_step);
        assert_eq!(refined.moved, certificate.moved);
    }
}

#[test]
fn a_perturbed_solution_is_no_midpoint_of_a_proof() {
    let target = target(WMS3);
    let known = real_linkages("wms3", &target);
    let mut stream = stream(13, 0);
    for known in &known {
        let refined = certify(&target, &known.solution).expect("a solution").refined;
        for by in [1e-3, 1e-5, 1e-7, 1e-9] {
            let midpoint = perturbed(&mut stream, &refined, by);
            // A polydisc that does not hold the solution, as at least one unknown is off by more than a hundredth of
            // the deviation.
            let refused = check(&target, &midpoint, by / 100.0).expect_err("no solution within");
            assert!(
                matches!(refused, Refused::NotContained { residual, .. } if residual > by / 100.0),
                "{by:e}: {refused}"
            );
        }
    }
}

#[test]
fn a_disc_too_small_or_too_large_is_refused_and_one_between_is_not() {
    for (name, points) in [("wms3", WMS3), ("gaussian", GAUSSIAN)] {
        let target = target(points);
        for known in real_linkages(name, &target) {
            let refined = certify(&target, &known.solution).expect("a solution").refined;
            let certificate = check(&target, &refined, 1e-10).expect("a solution lies within");
            assert!(certificate.radius < 1e-10 && certificate.alone_within == 1e-10);
            // The midpoint is a solution to rounding only.
            assert!(matches!(check(&target, &refined, 1e-18), Err(Refused::NotContained { .. })));
            // In units of the scale: other solutions are as near as that, or a rotation may vanish.
            for large in [0.1, 0.3, 1.0, 1e3, f64::INFINITY] {
                assert!(check(&target, &refined, large).is_err(), "{large}");
            }
            for senseless in [0.0, -1e-10, f64::NAN] {
                let refused = check(&target, &refined, senseless);
                assert!(matches!(refused, Err(Refused::Radius { .. })), "{refused:?}");
            }
        }
    }
}

#[test]
fn a_solution_of_other_points_is_refused() {
    let (one, two) = (target(WMS3), target(GAUSSIAN));
    for known in real_linkages("wms3", &one) {
        assert!(certify(&two, &known.solution).is_err());
        assert!(check(&two, &known.solution, 1e-6).is_err());
        // One point moved by a part in a million: the solution moves along, and only the refined one is certified.
        let mut points = WMS3;
        points[4][0] += 1e-6;
        let moved = target(points);
        assert!(check(&moved, &known.solution, 1e-9).is_err());
        if let Ok(certificate) = certify(&moved, &known.solution) {
            assert!(certificate.moved > 1e-8, "{:e}", certificate.moved);
        }
    }
}

#[test]
fn numbers_that_are_none_are_refused() {
    let target = target(WMS3);
    let good = real_linkages("wms3", &target)[0].solution;
    for bad in [f64::NAN, f64::INFINITY, 1e40, 1e300] {
        let mut solution = good;
        solution.grounds_starred[1].re = bad;
        assert!(matches!(certify(&target, &solution), Err(Refused::NotRefined(_))), "{bad}");
    }
    let mut solution = good;
    solution.rotations[3] = Complex::ZERO;
    assert!(matches!(certify(&target, &solution), Err(Refused::NotRefined(_))));
    // Both links the same: the equations repeat each other.
    let mut solution = good;
    solution.pins[1] = solution.pins[0];
    solution.pins_starred[1] = solution.pins_starred[0];
    solution.grounds[1] = solution.grounds[0];
    solution.grounds_starred[1] = solution.grounds_starred[0];
    assert!(certify(&target, &solution).is_err());
}

/// The other two cognates, by Roberts' map and once more.
fn cognates(target: &Target, of: &Solution) -> [Solution; 2] {
    let next = |of: &Solution| {
        let map = |[x, y]: [Complex; 2], [a, b]: [Complex; 2]| {
            ([(x - a) * y / (x - y), a - x], [(b * x - a * y) / (x - y), a])
        };
        let (pins, grounds) = map(of.pins, of.grounds);
        let (pins_starred, grounds_starred) = map(of.pins_starred, of.grounds_starred);
        let ([x, _], [a, _]) = (of.pins, of.grounds);
        let rotations =
            std::array::from_fn(|j| (x * of.rotations[j] + target.displacements.delta[j] - a) / (x - a));
        Solution { pins, grounds, pins_starred, grounds_starred, rotations }
    };
    let second = next(of);
    [second, next(&second)]
}

#[test]
fn a_real_curve_of_complex_linkages_is_told_from_a_real_linkage_at_every_cognate() {
    let mut found = 0;
    for index in 0..400 {
        let Some((target, solution)) = random_real_curve(&mut stream(15, index)) else { continue };
        let [second, third] = cognates(&target, &solution);
        let all = [solution, second, third].map(|one| certify(&target, &one).expect("a solution"));
        for certificate in &all {
            assert_eq!(certificate.reality, Reality::RealCurve, "{index}: {certificate:?}");
        }
        assert_eq!(not_proved_distinct(&all), [[0, 1], [0, 2], [1, 2]]);
        found += 1;
    }
    assert!(found > 30, "{found}");
}

/// Follows a solution from one target to another, in steps that Newton's method follows closely.
fn carried(mut solution: Solution, from: &Displacements, to: &Displacements) -> Option<Solution> {
    let (mut done, mut step) = (0.0, 0.01);
    while done < 1.0 {
        let share = if done + step < 1.0 { done + step } else { 1.0 };
        let between = |a: [Complex; 8], b: [Complex; 8]| {
            std::array::from_fn(|j| if share < 1.0 { a[j] + (b[j] - a[j]) * share } else { b[j] })
        };
        let there = Displacements {
            delta: between(from.delta, to.delta),
            starred: between(from.starred, to.starred),
            kind: Kind::default(),
        };
        match refine(&there, &solution) {
            Ok(refined) if refined.moved < 0.05 => {
                (solution, done, step) = (refined.solution, share, 1.5 * step);
            }
            _ => step *= 0.5,
        }
        if step < 1e-6 {
            return None;
        }
    }
    Some(solution)
}

#[test]
fn solutions_that_are_not_their_own_conjugates_are_proved_complex() {
    // A real solution carried around a triangle of complex targets comes back as another one, mostly complex.
    let target = target(WMS3);
    let mut counts = [0; 3];
    for (index, known) in real_linkages("wms3", &target).iter().step_by(cases(18, 9)).enumerate() {
        let start = target.displacements;
        let mut stream = stream(16, index as u64);
        let mut near = |of: [Complex; 8]| {
            of.map(|z| z + Complex::new(normal(&mut stream, 0.0, 0.4), normal(&mut stream, 0.0, 0.4)))
        };
        let [one, two] = [(); 2].map(|()| Displacements {
            delta: near(start.delta),
            starred: near(start.starred),
            kind: Kind::default(),
        });
        let around = carried(known.solution, &start, &one)
            .and_then(|solution| carried(solution, &one, &two))
            .and_then(|solution| carried(solution, &two, &start));
        let Some(solution) = around else { continue };
        let certificate = certify(&target, &solution).expect("a solution of generic points");
        let conjugate = Solution {
            pins: certificate.refined.pins_starred.map(|z| z.conj()),
            grounds: certificate.refined.grounds_starred.map(|z| z.conj()),
            pins_starred: certificate.refined.pins.map(|z| z.conj()),
            grounds_starred: certificate.refined.grounds.map(|z| z.conj()),
            rotations: certificate.refined.rotations.map(|t| t.conj().inv()),
        };
        let conjugate = certify(&target, &conjugate).expect("the conjugate of a solution");
        assert_eq!(conjugate.reality, certificate.reality);
        let apart = not_proved_distinct(&[certificate, conjugate]).is_empty();
        assert_eq!(apart, certificate.reality == Reality::Complex, "{certificate:?}");
        counts[match certificate.reality {
            Reality::Real => 0,
            Reality::RealCurve => 1,
            Reality::Complex => 2,
            Reality::Undecided => panic!("{certificate:?}"),
        }] += 1;
    }
    assert!(counts[2] > cases(5, 10), "{counts:?}");
}

#[test]
fn the_same_digits_on_any_number_of_threads() {
    let target = target(WMS3);
    let solutions: Vec<Solution> =
        real_linkages("wms3", &target).iter().map(|known| known.solution).collect();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| certify_all(&target, &solutions))
    };
    assert_eq!(on(1), on(3));
}
