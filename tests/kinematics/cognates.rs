//! The Roberts-Chebyshev cognates: three linkages, one curve.

use crate::reference::{Draws, Flooded, linkage, rounding, scale, shipped_linkage, transmission};
use linkwright::internals::mechanism::four_bar::cognate::{Cognate, CognateError, OriginalLink, SharedPivot};
use linkwright::internals::mechanism::four_bar::mobility::wrapped;
use linkwright::internals::mechanism::{AssemblyMode, Complex, FourBar, Joints, LinkageType, point};
use std::f64::consts::PI;

const BOTH: [AssemblyMode; 2] = [AssemblyMode::Plus, AssemblyMode::Minus];

fn sine(l: &FourBar, phi: f64, t1: AssemblyMode) -> Option<f64> {
    let [c, d, _] = crate::reference::position(l, phi, t1)?;
    Some(transmission(c, d, l.follower_pivot()).sin())
}

/// How far P of the cognate may be off: its own rounding and the original's, and the rounding of the crank
/// angle that was read off the original's joints, magnified by (b + c)/(b c sin mu) and by the coupler.
fn slack(
    l: &FourBar,
    phi: f64,
    t1: AssemblyMode,
    cognate: &Cognate,
    angle: f64,
    theirs: AssemblyMode,
) -> f64 {
    let [pin, own] = rounding(l, phi, t1);
    let k = cognate.linkage;
    let [_, other] = rounding(&k, angle, theirs);
    let (b, c) = (k.coupler(), k.follower());
    let sine = sine(&k, angle, theirs).expect("closed");
    let size = k.links().iter().sum::<f64>() / l.links().iter().sum::<f64>();
    let magnified = scale(&k) * (b + c) / (b * c * sine) * (1.0 + 2.0 * k.coupler_offset().norm() / b);
    own + other + 8.0 * pin * size * (1.0 + magnified)
}

fn links_of(j: Joints, l: &FourBar, link: OriginalLink) -> Complex {
    match link {
        OriginalLink::Crank => j.crank_pin - l.crank_pivot(),
        OriginalLink::Coupler => j.follower_pin - j.crank_pin,
        OriginalLink::Follower => j.follower_pin - l.follower_pivot(),
    }
}

#[test]
fn all_three_trace_one_curve_on_every_circuit_and_branch_of_every_type() {
    let mut draws = Draws(1875);
    let mut seen = [0usize; 6];
    for _ in 0..120 {
        let l = draws.clear_linkage();
        let kind = l.linkage_type().expect("joined");
        let cognates = l.cognates().map(|c| c.expect("P is off the pins"));
        for i in 0..60 {
            let phi = 0.013 + f64::from(i) * PI / 30.0;
            for t1 in BOTH {
                if sine(&l, phi, t1).is_none_or(|s| s < 0.02) {
                    continue;
                }
                let ours = l.position_with(phi, t1).joints().expect("closed");
                for cognate in &cognates {
                    let (angle, theirs) = cognate.position_of(phi, t1).expect("closed");
                    let k = cognate.linkage;
                    if sine(&k, angle, theirs).is_none_or(|s| s < 0.02) {
                        continue;
                    }
                    let j = k.position_with(angle, theirs).joints().expect("closed");
                    let off = (j.coupler_point - ours.coupler_point).norm();
                    let slack = slack(&l, phi, t1, cognate, angle, theirs);
                    assert!(off <= slack, "{off:e} > {slack:e} for {l} and {k}");
                    for (link, step) in [
                        (OriginalLink::Crank, cognate.crank),
                        (OriginalLink::Coupler, cognate.coupler),
                        (OriginalLink::Follower, cognate.follower),
                    ] {
                        let turned = links_of(j, &k, link).arg() - links_of(ours, &l, step.with).arg();
                        let length = links_of(j, &k, link).norm();
                        assert!(wrapped(turned - step.phase).abs() <= 4.0 * slack / length.min(1.0));
                    }
                    seen[LinkageType::ALL.iter().position(|t| *t == kind).expect("a type")] += 1;
                }
            }
        }
    }
    assert!(seen[..5].iter().all(|n| *n > 500), "{seen:?}");
}

#[test]
fn circuits_go_to_circuits() {
    let mut draws = Draws(77);
    for _ in 0..20 {
        let l = draws.clear_linkage();
        let flooded = Flooded::of(&l);
        for cognate in l.cognates().map(|c| c.expect("P is off the pins")) {
            let theirs = cognate.linkage.mobility();
            assert_eq!(theirs.circuits(), l.mobility().circuits());
            let mut image = std::collections::BTreeMap::new();
            for (phi, t1, circuit, _) in flooded.nodes().step_by(7) {
                let (angle, assembly) = cognate.position_of(phi, t1).expect("closed");
                let to = theirs.branch(angle, assembly).circuit.index;
                assert_eq!(*image.entry(circuit).or_insert(to), to, "{l}");
            }
            let distinct: std::collections::BTreeSet<u8> = image.values().copied().collect();
            assert_eq!(distinct.len(), image.len(), "two circuits fall together: {l}");
        }
    }
}

#[test]
fn the_type_of_a_cognate_follows_from_that_of_the_original() {
    use LinkageType::{CrankRocker, DoubleCrank, DoubleRocker, RockerCrank, TripleRocker};
    use OriginalLink::{Coupler, Crank, Follower};
    let mut draws = Draws(9);
    for _ in 0..300 {
        let l = draws.clear_linkage();
        let [first, second] = l.cognates().map(|c| c.expect("P is off the pins"));
        let found = [first, second].map(|c| (c.linkage.linkage_type().expect("joined"), c.crank.with));
        let wanted = match l.linkage_type().expect("joined") {
            CrankRocker => [(DoubleRocker, Coupler), (CrankRocker, Crank)],
            RockerCrank => [(CrankRocker, Follower), (DoubleRocker, Crank)],
            DoubleCrank => [(DoubleCrank, Coupler), (DoubleCrank, Crank)],
            DoubleRocker => [(CrankRocker, Coupler), (CrankRocker, Coupler)],
            TripleRocker => [(TripleRocker, Coupler), (TripleRocker, Crank)],
            LinkageType::ChangePoint => continue,
        };
        assert_eq!(found, wanted, "{l}");
        assert_eq!([first.shared, second.shared], [SharedPivot::Crank, SharedPivot::Follower]);
    }
}

/// The same linkage, perhaps driven at its other pivot.
fn same(l: &FourBar, k: &FourBar, slack: f64) -> bool {
    let [g, a, b, c] = l.links();
    let ends = |l: &FourBar| [l.crank_pivot(), l.follower_pivot()];
    let near = |x: [Complex; 2], y: [Complex; 2], links: [f64; 4], sides: [f64; 2]| {
        (x[0] - y[0]).norm() <= slack
            && (x[1] - y[1]).norm() <= slack
            && links.iter().zip(k.links()).all(|(p, q)| (p - q).abs() <= slack)
            && (sides[0] - k.crank_side()).abs() <= slack
            && (sides[1] - k.follower_side()).abs() <= slack
    };
    let [p, q] = ends(l);
    near([p, q], ends(k), [g, a, b, c], [l.crank_side(), l.follower_side()]) && l.side() == k.side()
        // Seen from the other end the triangle keeps its orientation and C -> D turns round.
        || near([q, p], ends(k), [g, c, b, a], [l.follower_side(), l.crank_side()]) && l.side() != k.side()
}

#[test]
fn the_cognates_of_a_cognate_are_the_original_and_the_other() {
    let mut draws = Draws(3);
    for _ in 0..100 {
        let l = draws.clear_linkage();
        let [first, second] = l.cognates().map(|c| c.expect("P is off the pins").linkage);
        for (one, other) in [(first, second), (second, first)] {
            let again = one.cognates().map(|c| c.expect("P is off the pins").linkage);
            // Sizes |z| and |1 - z| are multiplied and divided: the ratio of the sizes is lost, and the height
            // of a flat triangle to its own rounding.
            let z = l.coupler_ratio();
            let sizes = (z.norm() + (1.0 - z).norm() + 1.0) / z.norm().min((1.0 - z).norm()).min(1.0);
            let flat = sizes / z.im.abs().min(1.0);
            let slack = 256.0 * f64::EPSILON * scale(&l) * (sizes * flat).powi(2);
            assert!(slack < 1e-3 * l.longest_link());
            for wanted in [l, other] {
                assert!(
                    again.iter().any(|k| same(&wanted, k, slack)),
                    "{wanted}\nnot in {}\n{}",
                    again[0],
                    again[1]
                );
            }
        }
    }
}

#[test]
fn the_third_pivot_makes_a_triangle_like_the_coupler() {
    let l = shipped_linkage("romero");
    let third = l.cognate_pivot();
    let [g, _, b, _] = l.links();
    assert!(((third - l.crank_pivot()).norm() - g * l.crank_side() / b).abs() <= 1e-14);
    assert!(((third - l.follower_pivot()).norm() - g * l.follower_side() / b).abs() <= 1e-14);
    for cognate in l.cognates().map(|c| c.expect("P is off the pins")) {
        let k = cognate.linkage;
        assert!([k.crank_pivot(), k.follower_pivot()].contains(&third));
        assert_eq!(cognate.original(), l);
    }
}

#[test]
fn a_cognate_in_step_with_the_crank_counts_full_turns() {
    let l = shipped_linkage("hoeken");
    let [_, second] = l.cognates().map(|c| c.expect("P is off the pins"));
    assert_eq!(second.crank.with, OriginalLink::Crank);
    let [one, two] =
        [0.4, 0.4 + 20.0 * PI].map(|phi| second.position_of(phi, l.assembly()).expect("closed").0);
    assert!((two - one - 20.0 * PI).abs() <= 1e-13);
}

#[test]
fn the_cognate_of_hoekens_linkage_is_chebyshevs_straight_line_linkage() {
    // Hoeken 2 : 1 : 2.5 : 2.5 with P twice as far (z = 2): the first cognate has ground 4, rockers 5, coupler
    // 2 and P in the middle of the coupler (Chebyshev's lambda and his table are cognates).
    let l = shipped_linkage("hoeken");
    let [first, _] = l.cognates().map(|c| c.expect("P is off the pins"));
    let k = first.linkage;
    assert_eq!(k.linkage_type(), Some(LinkageType::DoubleRocker));
    for (got, wanted) in k.links().into_iter().zip([4.0, 5.0, 2.0, 5.0]) {
        assert!((got - wanted).abs() <= 1e-14, "{got}");
    }
    assert!((k.crank_side() - 1.0).abs() <= 1e-14 && (k.follower_side() - 1.0).abs() <= 1e-14);
}

#[test]
fn a_coupler_point_on_a_pin_leaves_one_cognate_with_two_links_exchanged() {
    let at_c = linkage([[0.0, 0.0], [3.0, 0.5]], [1.0, 2.7, 2.5, 0.0, 2.7], 1, 1);
    let [first, second] = at_c.cognates();
    assert_eq!(first.unwrap_err(), CognateError::CouplerPointOnPin);
    let second = second.expect("coupler and follower exchanged").linkage;
    let [g, a, b, c] = at_c.links();
    assert_eq!(second.links(), [g, a, c, b]);
    assert_eq!([second.crank_side(), second.follower_side()], [0.0, c]);
    assert_eq!([second.crank_pivot(), second.follower_pivot()], [at_c.crank_pivot(), at_c.follower_pivot()]);
    let at_d = linkage([[0.0, 0.0], [3.0, 0.5]], [1.0, 2.7, 2.5, 2.7, 0.0], 1, 1);
    let [first, second] = at_d.cognates();
    assert_eq!(second.unwrap_err(), CognateError::CouplerPointOnPin);
    let first = first.expect("crank and coupler exchanged").linkage;
    assert_eq!(first.links(), [g, b, a, c]);
    assert_eq!(first.follower_side(), 0.0);
}

#[test]
fn a_coupler_point_on_the_line_of_the_pins_is_no_exception() {
    for (d, e) in [(1.0, 1.7), (5.4, 2.7), (0.5, 3.2)] {
        let l = linkage([[0.1, -0.2], [3.0, 0.4]], [1.0, 2.7, 2.5, d, e], -1, 1);
        for cognate in l.cognates().map(|c| c.expect("P is off the pins")) {
            for i in 0..24 {
                let phi = f64::from(i) * 0.26;
                let (angle, t1) = cognate.position_of(phi, l.assembly()).expect("closed");
                let ours = l.position(phi).joints().expect("closed").coupler_point;
                let theirs = cognate.linkage.position_with(angle, t1).joints().expect("closed").coupler_point;
                // The height of a flat triangle is known to the root of the rounding only.
                assert!((ours - theirs).norm() <= 8.0 * (64.0 * f64::EPSILON).sqrt() * scale(&l));
            }
        }
    }
}

#[test]
fn a_parallelogram_has_kites_for_cognates() {
    let l = FourBar::with_coupler_offset(
        [point([0.0, 0.0]), point([4.0, 0.0])],
        [2.0, 4.0, 2.0],
        point([1.0, 1.5]),
        AssemblyMode::Plus,
    )
    .expect("a linkage");
    let [first, second] = l.cognates().map(|c| c.expect("P is off the pins"));
    for cognate in [first, second] {
        assert_eq!(cognate.linkage.linkage_type(), Some(LinkageType::ChangePoint));
    }
    // The first cognate's crank stands still with its pin on G.
    let angle = |phi: f64| first.position_of(phi, AssemblyMode::Plus).expect("closed").0;
    assert!(wrapped(angle(0.5) - angle(2.5)).abs() <= 1e-14);
    let pin = first.linkage.crank_pivot() + Complex::from_polar(first.linkage.crank(), angle(1.0));
    assert!((pin - first.linkage.follower_pivot()).norm() <= 1e-14);
    // The second traces the circle on.
    for i in 1..12 {
        let phi = f64::from(i) * 0.25;
        let (angle, t1) = second.position_of(phi, AssemblyMode::Plus).expect("closed");
        let theirs = second.linkage.position_with(angle, t1).joints().expect("closed").coupler_point;
        let ours = l.position(phi).joints().expect("closed").coupler_point;
        assert!((theirs - ours).norm() <= 1e-12, "{theirs} for {ours}");
    }
}

#[test]
fn open_and_coincident_are_answered() {
    let apart = linkage([[0.0, 0.0], [10.0, 0.0]], [1.0, 2.0, 3.0, 1.0, 2.0], 1, 1);
    for cognate in apart.cognates() {
        assert!(matches!(cognate, Err(CognateError::Open { .. })));
    }
    let rocks = linkage([[0.0, 0.0], [5.0, 0.0]], [4.0, 3.5, 2.5, 2.0, 3.0], 1, 1);
    assert!(
        rocks.cognates_at(3.0).iter().all(|c| c == &Err(CognateError::Open { crank_deg: 3f64.to_degrees() }))
    );
    assert!(rocks.cognates().iter().all(|c| c.is_ok()));
    let one_place = linkage([[1.0, 2.0], [1.0, 2.0]], [1.0, 1.5, 1.2, 0.8, 1.0], -1, 1);
    for cognate in one_place.cognates().map(|c| c.expect("P is off the pins")) {
        assert_eq!(cognate.linkage.ground(), 0.0);
    }
}

#[test]
fn the_signs_belong_to_the_position_that_was_asked_for() {
    let mut draws = Draws(12);
    for _ in 0..200 {
        let l = draws.clear_linkage();
        let phi = draws.between(-PI, PI);
        if sine(&l, phi, l.assembly()).is_none_or(|s| s < 0.05) {
            continue;
        }
        let wanted = l.position(phi).joints().expect("closed").coupler_point;
        for cognate in l.cognates_at(phi).map(|c| c.expect("P is off the pins")) {
            let (angle, t1) = cognate.position_of(phi, l.assembly()).expect("closed");
            assert_eq!(t1, cognate.linkage.assembly());
            if sine(&cognate.linkage, angle, t1).is_some_and(|s| s > 0.05) {
                let got = cognate.linkage.position(angle).joints().expect("closed").coupler_point;
                assert!((got - wanted).norm() <= slack(&l, phi, l.assembly(), &cognate, angle, t1));
            }
        }
    }
}
