//! Tests of the plates of linkages with a slider: the block stays in its slot, holes lie where joints are, outlines close.

use super::*;
use crate::mechanism::{
    AssemblyMode, InputRange, InvertedSliderCrank, InvertedSliderCrankParameters, LinkageKind, SliderCrank,
    SliderCrankParameters, cross, dot,
};
use crate::numbers::arithmetic::streams::{stream, uniform};
use std::f64::consts::TAU;

const SIZES: Sizes = Sizes { hole: 4.0, margin: 3.0 };

fn slider_crank(
    [a, b, height]: [f64; 3],
    line_deg: f64,
    [x, y]: [f64; 2],
    assembly: AssemblyMode,
) -> CrankLinkage {
    let normal = Complex::from_polar(height, line_deg.to_radians()) * Complex::i();
    SliderCrank::new(SliderCrankParameters {
        crank_pivot: [3.0, -2.0],
        crank: a,
        coupler: b,
        line_point: [3.0 + normal.re, -2.0 + normal.im],
        line_deg,
        coupler_x: x,
        coupler_y: y,
        assembly,
    })
    .expect("lengths")
    .into()
}

fn inverted([g, a, h]: [f64; 3], [x, y]: [f64; 2], assembly: AssemblyMode) -> CrankLinkage {
    InvertedSliderCrank::new(InvertedSliderCrankParameters {
        crank_pivot: [3.0, -2.0],
        block_pivot: [3.0 + 0.6 * g, -2.0 + 0.8 * g],
        crank: a,
        offset: h,
        coupler_x: x,
        coupler_y: y,
        assembly,
    })
    .expect("lengths")
    .into()
}

/// Linkages of both kinds with a motion: cranks that turn fully and that rock, in line and offset, either assembly.
fn linkages() -> Vec<(CrankLinkage, Vec<Stretch>)> {
    let (plus, minus) = (AssemblyMode::Plus, AssemblyMode::Minus);
    let full = [
        slider_crank([30.0, 90.0, 10.0], 0.0, [40.0, 15.0], plus),
        slider_crank([30.0, 90.0, -25.0], 130.0, [-20.0, -35.0], minus),
        slider_crank([30.0, 90.0, 0.0], -50.0, [120.0, 0.0], plus),
        inverted([80.0, 20.0, 5.0], [95.0, 0.0], plus),
        inverted([80.0, 20.0, 0.0], [150.0, 40.0], plus),
        inverted([90.0, 30.0, -35.0], [40.0, -60.0], minus),
        inverted([20.0, 90.0, 0.0], [150.0, 40.0], plus),
    ];
    let rocking = [
        (slider_crank([70.0, 60.0, 30.0], 20.0, [30.0, 10.0], plus), [2.2, 3.4]),
        (inverted([80.0, 70.0, 30.0], [60.0, 50.0], minus), [2.5, 4.6]),
    ];
    let turn = |linkage: CrankLinkage| {
        (linkage, vec![Stretch { from: 0.4, to: 0.4 + TAU, assembly: linkage.assembly() }])
    };
    let part = |(linkage, [from, to]): (CrankLinkage, [f64; 2])| {
        (linkage, vec![Stretch { from, to, assembly: linkage.assembly() }])
    };
    full.into_iter().map(turn).chain(rocking.into_iter().map(part)).collect()
}

/// Positions of a motion, 360 of each stretch and its ends.
fn positions(linkage: &CrankLinkage, motion: &[Stretch]) -> Vec<LoopJoints> {
    let at = |stretch: &Stretch, i: u32| {
        let angle = stretch.from + (stretch.to - stretch.from) * f64::from(i) / 360.0;
        linkage.joints_with(angle, stretch.assembly).expect("it closes")
    };
    motion.iter().flat_map(|stretch| (0..=360).map(move |i| at(stretch, i))).collect()
}

#[test]
fn guide_pins_stay_in_the_slot_with_room_at_its_ends_and_no_more_of_it_than_that() {
    for (linkage, motion) in linkages() {
        let parts = Parts::new(linkage, SIZES, &motion).expect("it closes");
        let (guide, slot) = (*parts.guide().expect("a slider"), parts.slot().expect("a slider"));
        let size = linkage.longest();
        let along = (slot.ends[1] - slot.ends[0]) / slot.length();
        let mut least = [f64::INFINITY; 2];
        for at in positions(&linkage, &motion) {
            let placed = parts.placement(slot.link, &at);
            for pin in [Joint::E, Joint::F] {
                let own = (parts.joint(pin, &at) - placed.origin) * placed.direction.conj();
                assert!(slot.distance(own) < 1e-12 * size, "{pin:?} leaves the slot of {linkage:?}");
                least[0] = least[0].min(dot(along, own - slot.ends[0]));
                least[1] = least[1].min(dot(along, slot.ends[1] - own));
            }
        }
        // Half a hole at either end, of which a degree of the crank beside the turning point takes little.
        for room in least {
            assert!(room >= guide.end - 1e-12 * size, "{room} of {} in {linkage:?}", guide.end);
            assert!(room <= guide.end + 1e-3 * size, "{room} of {} in {linkage:?}", guide.end);
        }
        assert_eq!(guide.width, SIZES.hole);
        assert!(guide.half >= SIZES.hole + SIZES.margin);
    }
}

#[test]
fn holes_lie_where_the_joints_are_and_pins_have_one_in_both_plates_or_run_in_the_slot() {
    for (linkage, motion) in linkages() {
        let parts = Parts::new(linkage, SIZES, &motion).expect("it closes");
        let plates = parts.plates(|_| 5.0);
        let links = parts.links();
        for at in positions(&linkage, &motion).into_iter().step_by(7) {
            for plate in &plates {
                let placed = parts.placement(plate.link, &at);
                for hole in &plate.holes {
                    let apart = (placed.of(hole.at) - parts.joint(hole.joint, &at)).norm();
                    assert!(apart < 1e-12 * linkage.longest().max(100.0), "{hole:?} of {plate:?}: {apart}");
                }
            }
        }
        for pin in parts.pins() {
            let [one, other] = pin.joins.map(|link| {
                let plate = &plates[links.iter().position(|other| *other == link).expect("a link")];
                plate.holes.iter().any(|hole| hole.joint == pin.joint) || plate.slot.is_some()
            });
            assert!(one && other, "{pin:?} of {linkage:?}");
        }
    }
}

#[test]
fn outlines_and_slots_are_closed_run_once_around_and_keep_their_margin() {
    for (linkage, motion) in linkages() {
        let parts = Parts::new(linkage, SIZES, &motion).expect("it closes");
        let radius = 0.5 * SIZES.hole + SIZES.margin;
        for plate in parts.plates(|_| radius) {
            for edges in [plate.outline(), plate.slot_outline(SIZES.hole)] {
                let (mut turned, mut area, n) = (0.0, 0.0, edges.len());
                for (i, edge) in edges.iter().enumerate() {
                    let next = edges[(i + 1) % n];
                    let (Edge::Line { to, .. } | Edge::Arc { to, .. }) = *edge;
                    assert!((to - next.from()).norm() < 1e-11, "{plate:?}");
                    area += 0.5 * cross(edge.from(), to);
                    if let Edge::Arc { from, to, centre, turn } = *edge {
                        turned += turn;
                        area += 0.5 * (from - centre).norm_sqr() * (turn - turn.sin());
                        assert!(((to - centre).norm() - (from - centre).norm()).abs() < 1e-11);
                    }
                }
                // Turning left all the way round once: convex, so that no edge meets another.
                assert!(edges.is_empty() || ((turned - TAU).abs() < 1e-12 && area > 0.0), "{plate:?}");
                if plate.slot.is_none() || edges == plate.outline() {
                    assert!(edges.is_empty() || (area - plate.area()).abs() < 1e-9 * plate.area());
                }
            }
            for edge in plate.slot_outline(SIZES.hole) {
                assert!(plate.distance(&Placement::HOME, edge.from()) <= -SIZES.margin + 1e-11, "{plate:?}");
            }
        }
    }
}

#[test]
fn joints_and_corners_of_plates_move_no_farther_than_their_bounds() {
    for (k, (linkage, motion)) in linkages().into_iter().enumerate() {
        let parts = Parts::new(linkage, SIZES, &motion).expect("it closes");
        let mut draws = stream(3, k as u64);
        for _ in 0..300 {
            let Stretch { from, to, assembly } = motion[0];
            let ends = [uniform(&mut draws, from, to), uniform(&mut draws, from, to)];
            let width = 10f64.powf(uniform(&mut draws, -3.0, 0.0));
            let low = ends[0].min(ends[1]);
            let stretch = Stretch { from: low, to: low + (ends[0] - ends[1]).abs() * width, assembly };
            let (middle, reach) = parts::reach(&linkage, &stretch).expect("it closes");
            for at in positions(&linkage, &[stretch]) {
                let slack = 1e-10 * linkage.longest();
                let moved = |joint: Joint| (parts.joint(joint, &at) - parts.joint(joint, &middle)).norm();
                assert!(moved(Joint::C) <= reach.of(Joint::C) + slack);
                assert!(moved(Joint::D) <= reach.of(Joint::D) + slack, "{linkage:?} {stretch:?}");
                assert!(moved(Joint::P) <= reach.of(Joint::P) + slack, "{linkage:?} {stretch:?}");
                for (link, origin, chord) in [
                    (Link::Coupler, reach.of(Joint::C), reach.coupler_chord),
                    (Link::Block, reach.of(Joint::D), reach.block_chord),
                ] {
                    let plate = parts.plate(link, 0.0);
                    let [before, after] = [&middle, &at].map(|at| parts.placement(link, at));
                    for corner in &plate.corners {
                        let moved = (after.of(*corner) - before.of(*corner)).norm();
                        assert!(moved <= origin + corner.norm() * chord + slack, "{link:?} {linkage:?}");
                    }
                }
            }
        }
    }
}

#[test]
fn the_slot_of_a_crank_that_turns_fully_is_as_long_whatever_part_of_the_turn_is_used() {
    for (linkage, motion) in linkages() {
        if linkage.mobility().input != InputRange::Full {
            continue;
        }
        let short = [Stretch { from: 1.0, to: 1.5, assembly: linkage.assembly() }];
        let [all, part] = [&motion[..], &short].map(|motion| Parts::new(linkage, SIZES, motion));
        let [all, part] = [all, part].map(|parts| parts.and_then(|parts| parts.slot()).expect("a slot"));
        assert!((all.length() - part.length()).abs() < 1e-9 * all.length(), "{linkage:?}");
    }
}

#[test]
fn the_travel_of_a_centric_slider_crank_is_twice_its_crank() {
    let linkage = slider_crank([30.0, 90.0, 0.0], 0.0, [40.0, 15.0], AssemblyMode::Plus);
    let motion = [Stretch { from: 0.3, to: 0.3 + TAU, assembly: AssemblyMode::Plus }];
    let parts = Parts::new(linkage, SIZES, &motion).expect("it closes");
    let [low, high] = parts.guide().expect("a slider").travel;
    assert!((low - 60.0).abs() < 1e-12 && (high - 120.0).abs() < 1e-12, "{low} to {high}");
    // 60 of travel, 7 and 2 at either end.
    assert!((parts.slot().expect("a slot").length() - 78.0).abs() < 1e-12);
}

#[test]
fn a_long_lever_lengthens_the_block_and_a_point_in_the_slot_has_no_hole() {
    let turn = |linkage: CrankLinkage| [Stretch { from: 0.0, to: TAU, assembly: linkage.assembly() }];
    let arm = inverted([200.0, 20.0, 100.0], [95.0, 60.0], AssemblyMode::Plus);
    let parts = Parts::new(arm, SIZES, &turn(arm)).expect("it closes");
    assert_eq!(parts.guide().map(|guide| 2.0 * guide.half), Some(50.0));
    assert_eq!(parts.undrilled(), None);
    let piston = inverted([80.0, 20.0, 5.0], [95.0, 0.0], AssemblyMode::Plus);
    let parts = Parts::new(piston, SIZES, &turn(piston)).expect("it closes");
    assert_eq!(parts.undrilled(), Some(Joint::P));
    assert_eq!(parts.plate(Link::Coupler, 5.0).distinct_holes().len(), 1);
}

#[test]
fn holes_shrink_where_the_slot_comes_near_them_and_vanish_where_it_meets_them() {
    let turn = |linkage: CrankLinkage| [Stretch { from: 0.0, to: TAU, assembly: linkage.assembly() }];
    for b in [90.0, 40.0, 31.0] {
        let linkage = slider_crank([30.0, b, 0.0], 0.0, [10.0, 15.0], AssemblyMode::Plus);
        let hole = parts::largest_hole(&linkage, &turn(linkage), (4.0, 3.0)).expect("it closes");
        // D comes within b - a of A, and 2.5 holes of slot and 3 holes apart go into that.
        assert!((hole - 4f64.min((b - 30.0) / 5.5)).abs() < 1e-9, "{hole}");
        let parts = Parts::new(linkage, Sizes { hole, margin: hole }, &turn(linkage)).expect("it closes");
        assert_eq!(parts.hole_in_slot(|_, _| hole), None);
    }
    let over = slider_crank([30.0, 30.0, 0.0], 0.0, [10.0, 15.0], AssemblyMode::Plus);
    assert_eq!(parts::largest_hole(&over, &turn(over), (4.0, 3.0)), Some(0.0));
    let parts = Parts::new(over, SIZES, &turn(over)).expect("it closes");
    let (link, joints, distance) = parts.hole_in_slot(|_, _| 4.0).expect("it meets A");
    assert!((link, joints.as_str()) == (Link::Ground, "A") && distance < 1e-9);
}

#[test]
fn a_loop_that_is_open_in_the_motion_has_no_parts() {
    for linkage in [
        slider_crank([70.0, 20.0, 0.0], 0.0, [10.0, 5.0], AssemblyMode::Plus),
        inverted([80.0, 70.0, 60.0], [60.0, 50.0], AssemblyMode::Plus),
    ] {
        let whole = [Stretch { from: 0.0, to: TAU, assembly: AssemblyMode::Plus }];
        assert_eq!(Parts::new(linkage, SIZES, &whole), None);
        assert_eq!(Parts::new(linkage, SIZES, &[]), None);
        assert_ne!(linkage.kind(), LinkageKind::FourBar);
    }
}
