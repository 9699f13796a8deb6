//! The referee against a brute-force judge, and by cases that can be checked by hand.
//!
//! The brute-force judge floods the configuration curve on a grid and calls points in order when, read once
//! around, the way along the circuit falls (or rises) at most once.

mod closed_paths;

use crate::reference::{Draws, Flooded, linkage, position, transmission};
use linkwright::internals::judge::referee::{UsedMotion, Verdict, judge};
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CouplerSide, FourBar, InputRange, Joints, LinkageType, NaturalCoordinates,
};
use linkwright::internals::task::{AngleOffset, Defect, Task, TaskOptions, Timing};
use std::f64::consts::{PI, TAU};

/// n distinct points; with `repeated` the last is the first.
fn task(n: usize, timing: Timing, repeated: bool) -> Task {
    let mut points: Vec<[f64; 2]> = (0..n).map(|j| [j as f64, 0.5 * (j * j) as f64]).collect();
    if repeated {
        points[n - 1] = points[0];
    }
    Task::new(points, timing, TaskOptions::default()).expect("a task")
}

fn free(n: usize) -> Task {
    task(n, Timing::Free, false)
}

fn prescribed(crank_angles: &[f64]) -> Task {
    let timing = Timing::Prescribed { crank_angles: crank_angles.to_vec(), offset: AngleOffset::Fixed };
    task(crank_angles.len(), timing, false)
}

fn verdict(task: &Task, l: &FourBar, places: &[(f64, AssemblyMode)]) -> Verdict {
    let (angles, assemblies): (Vec<f64>, Vec<AssemblyMode>) = places.iter().copied().unzip();
    judge(task, l, &angles, &assemblies)
}

fn names(verdict: &Verdict) -> Vec<&'static str> {
    verdict.defects.iter().map(Defect::name).collect()
}

/// The defects of free places by brute force: points off the circuit, points off the branch, out of order.
fn brute_force(flooded: &Flooded, places: &[(f64, AssemblyMode)]) -> (Vec<usize>, Vec<usize>, bool) {
    let found: Vec<_> = places.iter().map(|&(phi, t1)| flooded.place(phi, t1)).collect();
    let all = 0..places.len();
    let off_circuit: Vec<usize> = all.clone().filter(|&j| found[j].0 != found[0].0).collect();
    let off_branch = all.filter(|&j| found[j].0 == found[0].0 && places[j].1 != places[0].1).collect();
    let ways: Vec<f64> = found.iter().map(|f| f.1).collect();
    let turns =
        |rising: bool| (0..ways.len()).filter(|&j| (ways[(j + 1) % ways.len()] < ways[j]) == rising).count();
    let out_of_order = off_circuit.is_empty() && turns(true) > 1 && turns(false) > 1;
    (off_circuit, off_branch, out_of_order)
}

/// Linkages of every type but the change point with their flooded curves.
fn of_every_type(seed: u64, each: usize) -> Vec<(FourBar, Flooded)> {
    let mut draws = Draws(seed);
    let mut linkages: Vec<FourBar> = Vec::new();
    while linkages.len() < 5 * each {
        let l = draws.clear_linkage();
        if linkages.iter().filter(|other| other.linkage_type() == l.linkage_type()).count() < each {
            linkages.push(l);
        }
    }
    linkages.into_iter().map(|l| (l, Flooded::of(&l))).collect()
}

/// Places on a linkage's curve: anywhere, or along one circuit in order, or that with two places exchanged.
fn places(draws: &mut Draws, flooded: &Flooded, kind: usize) -> Vec<(f64, AssemblyMode)> {
    let nodes: Vec<_> = flooded.nodes().collect();
    let n = 3 + draws.below(6);
    let start = nodes[draws.below(nodes.len())];
    let mut chosen: Vec<(f64, AssemblyMode)> = Vec::new();
    while chosen.len() < n {
        let (phi, t1, circuit, _) = nodes[draws.below(nodes.len())];
        let turns = TAU * (draws.below(3) as f64 - 1.0);
        let fits = kind == 0 || circuit == start.2;
        if fits
            && chosen
                .iter()
                .all(|c| c.1 != t1 || (c.0 - phi).rem_euclid(TAU).min((phi - c.0).rem_euclid(TAU)) > 1e-6)
        {
            chosen.push((phi + turns, t1));
        }
    }
    if kind > 0 {
        let way = |place: &(f64, AssemblyMode)| flooded.place(place.0, place.1).1;
        chosen.sort_by(|x, y| way(x).total_cmp(&way(y)));
        let first = draws.below(n);
        chosen.rotate_left(first);
        if draws.below(2) == 0 {
            chosen.reverse();
        }
    }
    if kind == 2 {
        let (i, j) = (draws.below(n), draws.below(n));
        chosen.swap(i, j);
    }
    chosen
}

#[test]
fn free_points_are_judged_as_by_brute_force() {
    let mut draws = Draws(21);
    let mut seen = [0; 4];
    for (l, flooded) in of_every_type(21, 25) {
        for round in 0..24 {
            let places = places(&mut draws, &flooded, round % 3);
            let (off_circuit, off_branch, out_of_order) = brute_force(&flooded, &places);
            let got = verdict(&free(places.len()), &l, &places);
            let story = || format!("{l}\n{places:?}\n{:?}", got.defects);
            let circuit = got.defects.iter().find_map(|d| match d {
                Defect::Circuit { at } => Some(at.clone()),
                _ => None,
            });
            let branch = got.defects.iter().find_map(|d| match d {
                Defect::Branch { at } => Some(at.clone()),
                _ => None,
            });
            assert_eq!(circuit.unwrap_or_default(), off_circuit, "{}", story());
            if off_circuit.is_empty() && off_branch.is_empty() && !out_of_order {
                // Places of one branch in order: round by way of the toggles, unless the crank goes one way.
                let arc = l.mobility().arc(l.mobility().branch(places[0].0, places[0].1).circuit);
                let back_and_forth = arc.is_some_and(|arc| {
                    let offsets: Vec<f64> = places.iter().map(|(phi, _)| arc.offset(*phi)).collect();
                    !offsets.is_sorted() && !offsets.iter().rev().is_sorted()
                });
                assert_eq!(branch.is_some(), back_and_forth, "{}", story());
            } else if !off_branch.is_empty() {
                assert_eq!(branch.unwrap_or_default(), off_branch, "{}", story());
            }
            if off_circuit.is_empty() {
                assert_eq!(names(&got).contains(&"order"), out_of_order, "{}", story());
            }
            seen[0] += usize::from(got.defects.is_empty());
            seen[1] += usize::from(!off_circuit.is_empty());
            seen[2] += usize::from(!off_branch.is_empty());
            seen[3] += usize::from(out_of_order);
        }
    }
    assert!(seen.iter().all(|count| *count > 100), "too few of a kind to mean anything: {seen:?}");
}

#[test]
fn places_along_a_circuit_are_in_order_whichever_way_and_wherever_they_begin() {
    let mut draws = Draws(22);
    for (l, flooded) in of_every_type(22, 20) {
        for _ in 0..8 {
            let forward = places(&mut draws, &flooded, 1);
            let mut backward = forward.clone();
            backward.reverse();
            let task = free(forward.len());
            let (there, back) = (verdict(&task, &l, &forward), verdict(&task, &l, &backward));
            for v in [&there, &back] {
                assert!(!names(v).contains(&"order") && !names(v).contains(&"circuit"), "{l}\n{forward:?}");
            }
            let whole_turns: Vec<_> = forward.iter().map(|&(phi, t1)| (phi + 3.0 * TAU, t1)).collect();
            assert_eq!(verdict(&task, &l, &whole_turns).defects, there.defects, "whole turns are no matter");
        }
    }
}

/// A crank-rocker, g 4, a 1, b 3.5, c 3, pivots on a slanting line.
fn crank_rocker() -> FourBar {
    linkage([[0.5, -0.3], [3.7, 2.1]], [1.0, 3.5, 3.0, 2.0, 2.5], 1, 1)
}

/// The same with the crank as follower: the input rocks, two circuits.
fn rocker_crank() -> FourBar {
    linkage([[3.7, 2.1], [0.5, -0.3]], [3.0, 3.5, 1.0, 2.0, 2.5], 1, 1)
}

/// g 3, a 2, b 1.2, c 1.5: 3 + 1.2 is more than 2 + 1.5; the input rocks on one arc about the ground line.
fn triple_rocker() -> FourBar {
    linkage([[0.0, 0.0], [3.0, 0.0]], [2.0, 1.2, 1.5, 1.0, 1.0], 1, 1)
}

#[test]
fn the_linkages_of_these_tests_are_what_they_are_called() {
    assert_eq!(crank_rocker().linkage_type(), Some(LinkageType::CrankRocker));
    assert_eq!(rocker_crank().linkage_type(), Some(LinkageType::RockerCrank));
    assert_eq!(triple_rocker().linkage_type(), Some(LinkageType::TripleRocker));
    assert!(matches!(triple_rocker().mobility().input, InputRange::One(_)));
}

use AssemblyMode::{Minus, Plus};

#[test]
fn two_points_that_change_places_are_an_order_defect() {
    let l = crank_rocker();
    let in_order = [0.1, 0.8, 1.7, 3.0, 4.4, 5.9].map(|phi| (phi, Plus));
    assert!(verdict(&free(6), &l, &in_order).defects.is_empty());
    let mut exchanged = in_order;
    exchanged.swap(2, 3);
    assert_eq!(names(&verdict(&free(6), &l, &exchanged)), ["order"]);
    let v = verdict(&free(6), &l, &exchanged);
    assert_eq!(v.defects, [Defect::Order { at: vec![3] }], "the crank would have to go back for point 3");
}

#[test]
fn the_direction_is_the_one_in_which_the_points_are_passed() {
    let l = crank_rocker();
    let ccw = [5.5, 6.1, 0.4, 1.5].map(|phi| (phi, Plus));
    let cw = [1.5, 0.4, 6.1, 5.5].map(|phi| (phi, Plus));
    let (v, w) = (verdict(&free(4), &l, &ccw), verdict(&free(4), &l, &cw));
    assert_eq!((v.direction, w.direction), (1.0, -1.0));
    assert!(v.defects.is_empty() && w.defects.is_empty());
    let up = [0.0, 1.0, 2.0];
    assert_eq!(verdict(&prescribed(&up), &l, &up.map(|phi| (phi, Plus))).direction, 1.0);
    let down = [0.0, -1.0, -2.0];
    assert_eq!(verdict(&prescribed(&down), &l, &down.map(|phi| (phi, Plus))).direction, -1.0);
}

#[test]
fn a_closing_point_is_no_order_defect_whatever_turn_it_is_on() {
    let l = crank_rocker();
    let task = task(6, Timing::Free, true);
    for direction in [1.0, -1.0] {
        for closing in [-TAU, 0.0, TAU] {
            let places = [0.2, 1.4, 2.7, 3.9, 5.2, 0.2 + closing].map(|phi| (direction * phi, Plus));
            let v = verdict(&task, &l, &places);
            assert!(v.defects.is_empty(), "{:?}", v.defects);
            assert_eq!(v.direction, direction);
        }
    }
    // A closing point excuses nothing else.
    let places = [0.2, 2.7, 1.4, 3.9, 5.2, 0.2 + TAU].map(|phi| (phi, Plus));
    assert_eq!(names(&verdict(&task, &l, &places)), ["order"]);
}

#[test]
fn both_assemblies_of_a_turning_crank_are_two_circuits() {
    let l = crank_rocker();
    let places = [(0.1, Plus), (0.8, Plus), (1.7, Minus), (3.0, Plus), (4.0, Minus)];
    let v = verdict(&free(5), &l, &places);
    assert_eq!(v.defects, [Defect::Circuit { at: vec![2, 4] }]);
}

#[test]
fn both_assemblies_of_a_rocking_input_are_two_branches_of_a_circuit() {
    let l = rocker_crank();
    let InputRange::Two([left, right]) = l.mobility().input else { panic!("two arcs") };
    let at = |u: f64| left.middle + u * left.half_width;
    let places = [(at(-0.5), Plus), (at(0.0), Plus), (at(0.9), Plus), (at(0.8), Minus), (at(0.1), Minus)];
    let v = verdict(&free(5), &l, &places);
    assert_eq!(v.defects, [Defect::Branch { at: vec![3, 4] }], "in order by the circuit, past one toggle");
    let elsewhere = [(at(-0.5), Plus), (at(0.0), Plus), (right.middle, Plus)];
    let v = verdict(&free(3), &l, &elsewhere);
    assert_eq!(v.defects, [Defect::Circuit { at: vec![2] }], "the other arc is another circuit");
}

#[test]
fn a_last_point_where_the_first_one_is_stands_in_order_however_it_is_rounded() {
    let turning = [0.2, 1.4, 2.7, 3.9, 5.2].map(|phi| (phi, Plus));
    let l = triple_rocker();
    let InputRange::One(arc) = l.mobility().input else { panic!("one arc") };
    let at = |u: f64| arc.middle + u * arc.half_width;
    let rocking = [(at(0.1), Plus), (at(0.7), Plus), (at(0.5), Minus), (at(-0.6), Minus), (at(-0.8), Plus)];
    for (l, places, others) in
        [(crank_rocker(), turning, Vec::new()), (l, rocking, vec!["branch"])] as [(_, _, Vec<&str>); 2]
    {
        for off in [-1e-12, 0.0, 1e-12] {
            let mut places = places.to_vec();
            places.push((places[0].0 + off, places[0].1));
            assert_eq!(names(&verdict(&free(6), &l, &places)), others, "{off}");
        }
        // Clearly past the first one it has been around once already.
        let mut past = places.to_vec();
        past.push((places[0].0 + 1e-3, places[0].1));
        assert!(names(&verdict(&free(6), &l, &past)).contains(&"order"));
    }
}

#[test]
fn a_motion_past_toggles_is_in_order_by_the_circuit_and_not_by_the_crank_angle() {
    let l = triple_rocker();
    let InputRange::One(arc) = l.mobility().input else { panic!("one arc") };
    let at = |u: f64| arc.middle + u * arc.half_width;
    // Out on one branch, over the toggle, back on the other, over the second toggle: once around.
    let around = [
        (at(0.1), Plus),
        (at(0.7), Plus),
        (at(0.5), Minus),
        (at(-0.6), Minus),
        (at(-0.8), Plus),
        (at(-0.1), Plus),
    ];
    assert_eq!(names(&verdict(&free(6), &l, &around)), ["branch"]);
    // The same crank angles with the Minus points in the order of the crank angle jump back.
    let mut wrong = around;
    wrong.swap(2, 3);
    assert_eq!(names(&verdict(&free(6), &l, &wrong)), ["branch", "order"]);
}

#[test]
fn an_open_position_is_a_circuit_defect() {
    let l = triple_rocker();
    let InputRange::One(arc) = l.mobility().input else { panic!("one arc") };
    let open = arc.middle + 1.5 * arc.half_width;
    assert!(!l.position(open).is_closed());
    let places = [(arc.middle, Plus), (arc.middle + 0.1, Plus), (open, Plus)];
    assert_eq!(verdict(&free(3), &l, &places).defects, [Defect::Circuit { at: vec![2] }]);
    let first = [(open, Plus), (arc.middle, Plus), (arc.middle + 0.1, Plus)];
    assert!(names(&verdict(&free(3), &l, &first)).contains(&"circuit"));
}

#[test]
fn prescribed_angles_of_a_turning_crank_are_an_order_by_themselves() {
    let l = crank_rocker();
    for angles in [[0.0, 2.0, 1.0, 5.0], [0.0, 4.0, 8.0, 12.0], [3.0, -1.0, 7.0, -9.0]] {
        let v = verdict(&prescribed(&angles), &l, &angles.map(|phi| (phi, Plus)));
        assert!(v.defects.is_empty(), "{angles:?}: {:?}", v.defects);
    }
}

#[test]
fn a_rocking_crank_cannot_get_to_the_next_turn() {
    let l = rocker_crank();
    let InputRange::Two([left, _]) = l.mobility().input else { panic!("two arcs") };
    let near = [left.middle - 0.1, left.middle, left.middle + 0.1];
    assert!(verdict(&prescribed(&near), &l, &near.map(|phi| (phi, Plus))).defects.is_empty());
    let far = [near[0], near[1], near[2] + TAU];
    let v = verdict(&prescribed(&far), &l, &far.map(|phi| (phi, Plus)));
    assert_eq!(v.defects, [Defect::Circuit { at: vec![2] }]);
}

/// The extremes of the transmission angle between neighbouring crank angles of one branch, sampled.
fn sampled(l: &FourBar, from: f64, to: f64, t1: AssemblyMode) -> [f64; 2] {
    let mu: Vec<f64> = (0..=2000)
        .filter_map(|i| position(l, from + (to - from) * f64::from(i) / 2000.0, t1))
        .map(|[c, d, _]| transmission(c, d, l.follower_pivot()))
        .collect();
    [mu.iter().copied().fold(f64::MAX, f64::min), mu.iter().copied().fold(f64::MIN, f64::max)]
}

/// Samples 2000 to a stretch of a turn miss an extreme of mu by (pi/1000)^2 of g a/(b c sin mu): below 1e-4
/// for the linkages here, whose angles stay 5 degrees and more off flat where this is asked.
const SAMPLED: f64 = 1e-4;

#[test]
fn the_transmission_angle_is_judged_over_the_crank_angles_between_the_points() {
    let l = crank_rocker();
    for (places, [from, to]) in [
        ([0.3, 0.9, 1.4], [0.3, 1.4]),
        ([1.4, 0.9, 0.3], [0.3, 1.4]),
        ([5.5, 6.1, 0.9], [5.5, 0.9 + TAU]),
        ([2.0, 4.0, 6.0], [2.0, 6.0]),
        ([6.0, 2.0, 4.0], [6.0, 4.0 + TAU]),
    ] {
        for t1 in [Plus, Minus] {
            let v = verdict(&free(3), &l, &places.map(|phi| (phi, t1)));
            assert!(v.defects.is_empty());
            let (got, [min, max]) = (v.motion.transmission(), sampled(&l, from, to, t1));
            assert!((got.min - min).abs() <= SAMPLED && (got.max - max).abs() <= SAMPLED, "{places:?}");
        }
    }
}

#[test]
fn the_transmission_angle_of_a_rocking_input_is_judged_on_either_branch() {
    for l in [rocker_crank(), triple_rocker()] {
        let arc = match l.mobility().input {
            InputRange::Two([_, right]) => right,
            InputRange::One(arc) => arc,
            other => panic!("{other:?}"),
        };
        for [from, to] in [[-0.7, -0.2], [-0.5, 0.6], [0.1, 0.8], [-0.9, 0.9]] {
            let [from, to] = [from, to].map(|u| arc.middle + u * arc.half_width);
            for t1 in [Plus, Minus] {
                let places = [(from, t1), (0.4 * from + 0.6 * to, t1), (to, t1)];
                let v = verdict(&free(3), &l, &places);
                assert!(v.defects.is_empty(), "{l}: {:?}", v.defects);
                let (got, [min, max]) = (v.motion.transmission(), sampled(&l, from, to, t1));
                assert!((got.min - min).abs() <= SAMPLED && (got.max - max).abs() <= SAMPLED, "{l}: {got:?}");
            }
        }
    }
}

#[test]
fn prescribed_angles_of_a_rocking_input_use_the_stretch_between_them_on_either_branch() {
    // The stretch holds the middle of the arc, where psi passes pi on the branch t1 = -1.
    let l = rocker_crank();
    let InputRange::Two([_, right]) = l.mobility().input else { panic!("two arcs") };
    let angles = [-0.5, 0.1, 0.6].map(|u| right.middle + u * right.half_width);
    for t1 in [Plus, Minus] {
        let v = verdict(&prescribed(&angles), &l, &angles.map(|phi| (phi, t1)));
        assert!(v.defects.is_empty(), "{:?}", v.defects);
        let (got, [min, max]) = (v.motion.transmission(), sampled(&l, angles[0], angles[2], t1));
        assert!(
            (got.min - min).abs() <= SAMPLED && (got.max - max).abs() <= SAMPLED,
            "t1 {t1:?}: {got:?}, not {min} to {max}"
        );
    }
}

#[test]
fn prescribed_angles_past_a_toggle_use_the_stretch_around_that_toggle() {
    // Out on t1 = +1, over one end of the arc, back on t1 = -1 and past the middle. At one end of a
    // rocker-crank's arc mu is 0, at the other pi: the motion meets exactly one of them.
    let l = rocker_crank();
    let InputRange::Two([left, _]) = l.mobility().input else { panic!("two arcs") };
    for end in [1.0, -1.0] {
        let at = |u: f64| left.middle + end * u * left.half_width;
        for back in [0.4, -0.3] {
            let angles = [at(0.3), at(0.8), at(back)];
            let places = [(angles[0], Plus), (angles[1], Plus), (angles[2], Minus)];
            let v = verdict(&prescribed(&angles), &l, &places);
            assert_eq!(v.defects, [Defect::Branch { at: vec![2] }]);
            let got = v.motion.transmission();
            let [min, max] = sampled(&l, at(1.0), at(f64::min(0.3, back)), Plus);
            let told = format!("end {end}, back to {back}: {got:?}, not {min} to {max}");
            // Flat at that toggle, as sampled at the far end.
            if got.min == 0.0 {
                assert!((got.max - max).abs() <= SAMPLED, "{told}");
            } else {
                assert!(got.max == PI && (got.min - min).abs() <= SAMPLED, "{told}");
            }
        }
    }
}

#[test]
fn a_rocking_crank_turns_the_way_its_angle_goes_whatever_the_assembly() {
    for l in [rocker_crank(), triple_rocker()] {
        let arc = match l.mobility().input {
            InputRange::Two([left, _]) => left,
            InputRange::One(arc) => arc,
            other => panic!("{other:?}"),
        };
        for t1 in [Plus, Minus] {
            let rising = [-0.6, 0.1, 0.5].map(|u| (arc.middle + u * arc.half_width, t1));
            let falling = [rising[2], rising[1], rising[0]];
            let directions = [rising, falling].map(|places| verdict(&free(3), &l, &places).direction);
            assert_eq!(directions, [1.0, -1.0], "{l}: t1 {t1:?}");
        }
    }
}

#[test]
fn a_target_that_ends_where_it_began_uses_the_whole_turn() {
    // The closing point is the first one a turn on: the motion between first and last target point is the
    // turn.
    let l = crank_rocker();
    let task = task(5, Timing::Free, true);
    let first = l.ground_angle() + 0.3;
    // Between the last distinct point and the first lies the ground line, where mu is least.
    let places = [0.0, 1.0, 2.5, 4.0, TAU].map(|by| (first + by, Plus));
    let got = verdict(&task, &l, &places).motion.transmission();
    let wanted = l.transmission_over_cycle();
    assert!(
        (got.min - wanted.min).abs() <= 1e-12 && (got.max - wanted.max).abs() <= 1e-12,
        "{got:?} for {wanted:?}"
    );
}

/// The joints at `n` + 1 evenly spaced positions of a motion, without open ones.
fn joints(motion: &UsedMotion, n: usize) -> Vec<Joints> {
    let [low, high] = motion.range;
    (0..=n).filter_map(|i| motion.on.joints_at(low + (high - low) * i as f64 / n as f64)).collect()
}

#[test]
fn the_footprint_holds_every_joint_of_the_motion_and_no_more() {
    let mut draws = Draws(23);
    for (l, flooded) in of_every_type(23, 4) {
        for _ in 0..2 {
            let mut chosen = places(&mut draws, &flooded, 1);
            chosen.truncate(3);
            let v = verdict(&free(3), &l, &chosen);
            let got = v.motion.footprint();
            let mut wanted = [f64::MAX, f64::MAX, f64::MIN, f64::MIN];
            let mut hold = |p: Complex| {
                wanted = [wanted[0].min(p.re), wanted[1].min(p.im), wanted[2].max(p.re), wanted[3].max(p.im)];
            };
            hold(l.crank_pivot());
            hold(l.follower_pivot());
            let joints = joints(&v.motion, 5000);
            assert!(joints.len() > 4990, "{l}: closed all along");
            for j in joints {
                [j.crank_pin, j.follower_pin, j.coupler_point].into_iter().for_each(&mut hold);
            }
            for side in 0..4 {
                let outward = if side < 2 { -1.0 } else { 1.0 };
                let more = outward * (got[side] - wanted[side]);
                // Never inside of a sample, and outside of all by what lies between five thousand of them.
                assert!(
                    (-1e-9..=1e-4 * crate::reference::scale(&l)).contains(&more),
                    "{l}: side {side}: {more:e}"
                );
            }
        }
    }
}

#[test]
fn the_motion_passes_the_points_and_stays_between_them() {
    let mut draws = Draws(24);
    for (l, flooded) in of_every_type(24, 6) {
        let chosen = places(&mut draws, &flooded, 1);
        let v = verdict(&free(chosen.len()), &l, &chosen);
        assert!(!names(&v).contains(&"order"), "{l}");
        assert_eq!(v.motion.on.arc.is_none(), l.mobility().input_turns_fully());
        let joints = joints(&v.motion, 20_000);
        // 20,000 steps of at most a turn, with P at most three times as fast as the longest reach suggests,
        // and near a toggle as the root of the step.
        for &(phi, t1) in &chosen {
            let p = l.position_with(phi, t1).joints().unwrap().coupler_point;
            let nearest = joints.iter().map(|j| (j.coupler_point - p).norm()).fold(f64::MAX, f64::min);
            assert!(nearest <= 0.01 * crate::reference::scale(&l), "{l}: the motion misses {p} by {nearest}");
        }
    }
}

#[test]
fn a_crank_that_stands_still_has_no_direction() {
    for (l, _) in of_every_type(7, 2) {
        let directions = |angles: &[f64]| {
            let places: Vec<_> = angles.iter().map(|angle| (*angle, AssemblyMode::Plus)).collect();
            verdict(&free(3), &l, &places).direction
        };
        let arc = l.mobility().arc(l.mobility().branch(0.5, AssemblyMode::Plus).circuit);
        let place = arc.map_or(0.5, |arc| arc.middle);
        assert_eq!(directions(&[place; 3]), 0.0);
        assert_eq!(directions(&[place, place + 0.01, place + 0.02]), 1.0);
    }
}

#[test]
fn a_rocking_crank_that_keeps_its_order_only_through_toggles_has_a_branch_defect() {
    // The points could only be passed in this order by way of both toggles and the other branch.
    let linkage = FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [4.0, 0.0],
        crank: 3.0,
        coupler: 2.0,
        follower: 2.5,
        crank_side: 1.5,
        follower_side: 1.5,
        assembly: AssemblyMode::Plus,
        side: CouplerSide::Plus,
    })
    .expect("a linkage");
    let at = [0.0f64, 5.0, -50.0].map(f64::to_radians);
    let points = at.map(|a| {
        let p = linkage.position(a).joints().expect("within reach").coupler_point;
        [p.re, p.im]
    });
    let task = Task::new(points.to_vec(), Timing::Free, TaskOptions::default()).expect("a path");
    let verdict = judge(&task, linkage, &at, &[AssemblyMode::Plus; 3]);
    assert_eq!(names(&verdict), ["branch"]);
    assert!(verdict.motion.transmission().worst() < 1e-6, "the toggles are part of the motion");
}
