//! What mechanisms the known solutions are: counts as published, abilities class by class, and the way back.

use crate::known::{GAUSSIAN, WMS3, target};
use crate::verdicts::{Verdict, verdicts};
use linkwright::internals::judge::mechanisms::Mechanism;
use linkwright::internals::judge::mechanisms::{mechanisms, solution_of};
use linkwright::internals::mechanism::{Complex, FourBar, xy};
use linkwright::internals::numbers::nine_point::Target;
use linkwright::internals::task::forms::precision::Precise;
use linkwright::internals::task::{Task, TaskOptions, Timing};

fn wms3() -> (Target, Vec<Verdict>) {
    let target = target(WMS3);
    (target, verdicts("wms3", &target))
}

fn task(target: &Target) -> Task {
    let points = target.points.iter().map(|p| xy(*p)).collect();
    Task::new(points, Timing::Free, TaskOptions::default()).expect("a path")
}

/// The mechanisms of each known class.
fn all(target: &Target, known: &[Verdict]) -> Vec<Vec<Mechanism>> {
    let task = task(target);
    let precise = Precise::from(*target);
    known.iter().map(|class| mechanisms(&task, &precise, &class.solution)).collect()
}

fn four_bar(mechanism: &Mechanism) -> &FourBar {
    mechanism.linkage.four_bar().expect("a four-bar")
}

fn abilities(list: &[Mechanism]) -> [bool; 3] {
    let any = |of: fn(&Mechanism) -> bool| list.iter().any(of);
    [any(Mechanism::on_one_circuit), any(Mechanism::in_order), any(Mechanism::is_free_of_defects)]
}

fn holds_the_known_verdicts(target: &Target, known: &[Verdict], counts: [usize; 4]) {
    let found = all(target, known);
    assert_eq!(found.len(), counts[0]);
    for (i, (class, list)) in known.iter().zip(&found).enumerate() {
        assert_eq!(list.len(), 6);
        assert!(list.iter().all(|m| m.passes), "{list:?}");
        assert_eq!(abilities(list), class.abilities, "class {i}");
    }
    for ability in 0..3 {
        let count = found.iter().filter(|list| abilities(list)[ability]).count();
        assert_eq!(count, counts[ability + 1]);
    }
}

#[test]
fn problem_3_has_64_real_classes_30_on_one_circuit_3_in_order_and_1_free_of_defects() {
    let (target, known) = wms3();
    holds_the_known_verdicts(&target, &known, [64, 30, 3, 1]);
}

#[test]
fn the_gaussian_points_have_8_real_classes_6_on_one_circuit_and_none_in_order() {
    let target = target(GAUSSIAN);
    holds_the_known_verdicts(&target, &verdicts("gaussian", &target), [8, 6, 0, 0]);
}

#[test]
fn the_generating_positions_meet_the_points_to_rounding() {
    let (target, known) = wms3();
    let mut misses: Vec<f64> = all(&target, &known).iter().flatten().map(|m| m.miss / target.scale).collect();
    misses.sort_by(f64::total_cmp);
    // Closure near a toggle magnifies rounding; half of them are far from one.
    assert!(misses[misses.len() / 2] < 64.0 * f64::EPSILON, "{misses:?}");
    assert!(misses[misses.len() - 1] < 1e-10, "{misses:?}");
}

#[test]
fn grashof_is_a_property_of_the_curve() {
    let (target, known) = wms3();
    for (i, (class, list)) in known.iter().zip(all(&target, &known)).enumerate() {
        assert!(list.iter().all(|m| (four_bar(m).grashof_margin() > 0.0) == class.grashof), "class {i}");
    }
}

#[test]
fn the_three_cognates_stand_on_the_three_pivots_and_each_link_drives_once() {
    let (target, known) = wms3();
    let near = |z: Complex, w: Complex| (z - w).norm() < 1e-9;
    for (class, list) in known.iter().zip(all(&target, &known)) {
        let mut pivots: Vec<Complex> = Vec::new();
        for ground in class.cognates.iter().flat_map(|known| known.solution.grounds) {
            let at = target.points[0] + ground * target.scale;
            if !pivots.iter().any(|other| near(*other, at)) {
                pivots.push(at);
            }
        }
        assert_eq!(pivots.len(), 3);
        let place = |z: Complex| pivots.iter().position(|p| near(*p, z)).expect("one of the three pivots");
        let pair = |m: &Mechanism| (place(m.linkage.crank_pivot()), place(four_bar(m).follower_pivot()));
        let mut pairs: Vec<(usize, usize)> = list.iter().map(pair).collect();
        pairs.sort_unstable();
        assert_eq!(pairs, [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)]);
    }
}

#[test]
fn a_mechanism_leads_back_to_its_solution() {
    let (target, known) = wms3();
    for (class, list) in known.iter().zip(all(&target, &known)) {
        let first = &list[0];
        let back =
            solution_of(&Precise::from(target), &first.linkage, &first.crank_angles, &first.assemblies)
                .expect("closed");
        let span = first.linkage.longest_link() / target.scale + 1.0;
        let pairs = back.pins.iter().zip(&class.solution.pins);
        // A position near a toggle is known to the root of rounding.
        for (z, w) in pairs.chain(back.grounds.iter().zip(&class.solution.grounds)) {
            assert!((z - w).norm() < 1e-6 * span, "{z} {w}");
        }
    }
}
