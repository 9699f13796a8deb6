//! Closed targets: which motions come back to the first point, and how.

use super::{free, names, of_every_type, task, triple_rocker, verdict};
use linkwright::internals::mechanism::{AssemblyMode, CouplerSide, FourBar, InputRange, NaturalCoordinates};
use linkwright::internals::task::{AngleOffset, Defect, Return, Task, TaskOptions, Timing};
use std::f64::consts::TAU;

/// Closed, with a rule for the way back.
fn closed(n: usize, timing: Timing, comes_back: Return) -> Task {
    let points = task(n, Timing::Free, false).points().iter().map(|p| [p.re, p.im]).collect();
    let options = TaskOptions { closed: true, ..TaskOptions::default() };
    Task::new(points, timing, options).expect("a task").coming_back(comes_back)
}

#[test]
fn a_rocker_that_goes_back_the_way_it_came_does_not_close_a_path() {
    use AssemblyMode::{Minus, Plus};
    let l = triple_rocker();
    let InputRange::One(arc) = l.mobility().input else { panic!("one arc") };
    let places = |assembly| [-0.8, -0.3, 0.1, 0.6].map(|u| (arc.middle + u * arc.half_width, assembly));
    let around = [
        (arc.middle + 0.1 * arc.half_width, Plus),
        (arc.middle + 0.7 * arc.half_width, Plus),
        (arc.middle + 0.5 * arc.half_width, Minus),
        (arc.middle - 0.6 * arc.half_width, Minus),
    ];
    for assembly in [Plus, Minus] {
        let mut places = places(assembly).to_vec();
        for _ in 0..2 {
            let open = verdict(&free(4), &l, &places);
            assert!(open.defects.is_empty() && !open.to_and_fro);
            let strict = verdict(&closed(4, Timing::Free, Return::TurningOn), &l, &places);
            assert_eq!(strict.defects, [Defect::to_and_fro()]);
            assert!(strict.to_and_fro);
            // Through both toggles it comes back without reversing, and the whole circuit is the motion.
            let circuit = verdict(&closed(4, Timing::Free, Return::AroundTheCircuit), &l, &places);
            assert_eq!(circuit.defects, [Defect::Branch { at: vec![0] }]);
            assert!(!circuit.to_and_fro);
            let [low, high] = circuit.motion.range;
            assert!((high - low - TAU).abs() < 1e-12, "{low} {high}");
            let any = verdict(&closed(4, Timing::Free, Return::Any), &l, &places);
            assert!(any.defects.is_empty() && any.to_and_fro);
            assert_eq!(any.motion.range, open.motion.range);
            assert_eq!(any.direction, open.direction);
            places.reverse();
        }
    }
    // Points on both branches: the circuit is closed by going on.
    for rule in [Return::TurningOn, Return::AroundTheCircuit, Return::Any] {
        let verdict = verdict(&closed(4, Timing::Free, rule), &l, &around);
        assert_eq!(names(&verdict), ["branch"]);
        assert!(!verdict.to_and_fro);
    }
    // A last point that repeats the first closes a path too.
    let mut repeated = places(Plus).to_vec();
    repeated.push(repeated[0]);
    assert_eq!(verdict(&task(5, Timing::Free, true), &l, &repeated).defects, [Defect::to_and_fro()]);
}

#[test]
fn a_crank_that_turns_fully_closes_a_path_by_turning_on() {
    for (l, _) in of_every_type(41, 3) {
        if l.mobility().input != InputRange::Full {
            continue;
        }
        let places: Vec<_> = (0..6).map(|j| (0.4 + 0.9 * f64::from(j), AssemblyMode::Plus)).collect();
        for rule in [Return::TurningOn, Return::AroundTheCircuit, Return::Any] {
            let verdict = verdict(&closed(6, Timing::Free, rule), &l, &places);
            assert!(verdict.defects.is_empty() && !verdict.to_and_fro);
        }
    }
}

#[test]
fn prescribed_angles_of_a_closed_path_run_one_way_and_the_crank_turns_on() {
    let turning = FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [4.0, 0.0],
        crank: 1.0,
        coupler: 3.5,
        follower: 3.0,
        crank_side: 2.0,
        follower_side: 2.5,
        assembly: AssemblyMode::Plus,
        side: CouplerSide::Plus,
    })
    .expect("a crank-rocker");
    let defects = |l: &FourBar, angles: &[f64], rule| {
        let timing = Timing::Prescribed { crank_angles: angles.to_vec(), offset: AngleOffset::Fixed };
        let places: Vec<_> = angles.iter().map(|a| (*a, AssemblyMode::Plus)).collect();
        verdict(&closed(angles.len(), timing, rule), l, &places).defects
    };
    let forth_and_back = [0.0, 0.4, 0.8, 0.5];
    assert!(defects(&turning, &[0.0, 1.0, 2.0, 4.0], Return::TurningOn).is_empty());
    assert!(defects(&turning, &[4.0, 2.0, 1.0, 0.0], Return::TurningOn).is_empty());
    assert_eq!(defects(&turning, &forth_and_back, Return::TurningOn), [Defect::Order { at: vec![3] }]);
    assert!(defects(&turning, &forth_and_back, Return::Any).is_empty());
    let rocker = triple_rocker();
    let InputRange::One(arc) = rocker.mobility().input else { panic!("one arc") };
    let angles = [-0.5, 0.0, 0.5].map(|u| arc.middle + u * arc.half_width);
    assert_eq!(defects(&rocker, &angles, Return::TurningOn), [Defect::to_and_fro()]);
    assert!(defects(&rocker, &angles, Return::Any).is_empty());
}
