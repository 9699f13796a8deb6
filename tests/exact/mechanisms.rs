//! What mechanisms the known solutions are: counts as published, flags class by class, and the way back.

use crate::known::{self, Known};
use linkwright::exact::mechanisms::{mechanisms, solution_of};
use linkwright::exact::{Mechanism, Target};
use linkwright::linkage::{Complex, xy};
use linkwright::task::{PathOptions, PathTask, Timing};

fn task(target: &Target) -> PathTask {
    let points = target.points.iter().map(|p| xy(*p)).collect();
    PathTask::new(points, Timing::Free, PathOptions::default()).expect("a path")
}

/// The mechanisms of each known class.
fn all(target: &Target, known: &[Known]) -> Vec<Vec<Mechanism>> {
    let task = task(target);
    known.iter().map(|class| mechanisms(&task, target, &class.solution(target))).collect()
}

fn verdicts(list: &[Mechanism]) -> [bool; 3] {
    let any = |of: fn(&Mechanism) -> bool| list.iter().any(of);
    [any(Mechanism::on_one_circuit), any(Mechanism::in_order), any(Mechanism::is_free_of_defects)]
}

fn holds_the_known_verdicts((target, known): (Target, Vec<Known>), counts: [usize; 4]) {
    let found = all(&target, &known);
    assert_eq!(found.len(), counts[0]);
    for (class, list) in known.iter().zip(&found) {
        assert_eq!(list.len(), 6);
        assert!(list.iter().all(|m| m.passes), "{list:?}");
        assert_eq!(verdicts(list), class.flags[1..], "{class:?}");
    }
    for verdict in 0..3 {
        let count = found.iter().filter(|list| verdicts(list)[verdict]).count();
        assert_eq!(count, counts[verdict + 1]);
    }
}

#[test]
fn problem_3_has_64_real_classes_30_on_one_circuit_3_in_order_and_1_free_of_defects() {
    holds_the_known_verdicts(known::wms3(), [64, 30, 3, 1]);
}

#[test]
fn the_gaussian_points_have_8_real_classes_6_on_one_circuit_and_none_in_order() {
    holds_the_known_verdicts(known::gaussian(), [8, 6, 0, 0]);
}

#[test]
fn the_generating_positions_meet_the_points_to_rounding() {
    let (target, known) = known::wms3();
    let mut misses: Vec<f64> = all(&target, &known).iter().flatten().map(|m| m.miss / target.scale).collect();
    misses.sort_by(f64::total_cmp);
    // Closure near a toggle magnifies rounding; half of them are far from one.
    assert!(misses[misses.len() / 2] < 64.0 * f64::EPSILON, "{misses:?}");
    assert!(misses[misses.len() - 1] < 1e-10, "{misses:?}");
}

#[test]
fn grashof_is_a_property_of_the_curve() {
    let (target, known) = known::wms3();
    for (class, list) in known.iter().zip(all(&target, &known)) {
        assert!(list.iter().all(|m| (m.linkage.grashof_margin() > 0.0) == class.flags[0]), "{class:?}");
    }
}

#[test]
fn the_three_cognates_stand_on_the_three_pivots_and_each_link_drives_once() {
    let (target, known) = known::wms3();
    let near = |z: Complex, w: Complex| (z - w).norm() < 1e-9;
    for (class, list) in known.iter().zip(all(&target, &known)) {
        let pivots = [class.grounds[0], class.grounds[1], class.third];
        let mut pairs: Vec<(usize, usize)> = list
            .iter()
            .map(|m| {
                let place =
                    |z: Complex| pivots.iter().position(|p| near(*p, z)).expect("one of the three pivots");
                (place(m.linkage.crank_pivot()), place(m.linkage.follower_pivot()))
            })
            .collect();
        pairs.sort_unstable();
        assert_eq!(pairs, [(0, 1), (0, 2), (1, 0), (1, 2), (2, 0), (2, 1)]);
    }
}

#[test]
fn a_mechanism_leads_back_to_its_solution() {
    let (target, known) = known::wms3();
    let task = task(&target);
    for class in &known {
        let solution = class.solution(&target);
        let list = mechanisms(&task, &target, &solution);
        let first = &list[0];
        let back =
            solution_of(&target, &first.linkage, &first.crank_angles, &first.assemblies).expect("closed");
        let span = first.linkage.longest_link() / target.scale + 1.0;
        // A position near a toggle is known to the root of rounding.
        for (z, w) in back.pins.iter().chain(&back.grounds).zip(solution.pins.iter().chain(&solution.grounds))
        {
            assert!((z - w).norm() < 1e-6 * span, "{z} {w}");
        }
    }
}
