//! Plates of six-bars and eight-bars: holes where the joints are, bounds of motions, stackings without crossings.

use crate::dyad_chains::drawn;
use crate::slider_plates::{layered, positions};
use crate::thorough::cases;
use linkwright::internals::judge::practicality::clearance::pivot_distances;
use linkwright::internals::judge::practicality::layers::{Layering, can_be_stacked, layering};
use linkwright::internals::judge::practicality::sweep::Stretch;
use linkwright::internals::judge::practicality::{Build, Joint, Sweep};
use linkwright::internals::mechanism::plates::{Link, Parts};
use linkwright::internals::mechanism::{DyadChainKind, MultiLoop};
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};

/// Linkages of every kind that a workshop could build: links of similar lengths, transmission angles of 15 degrees or more.
fn linkages(seed: u64, wanted: usize) -> Vec<MultiLoop> {
    let draws = &mut stream(seed, 0);
    let kinds: Vec<DyadChainKind> = DyadChainKind::SIX_BARS
        .into_iter()
        .chain(DyadChainKind::eight_bars().into_iter().step_by(5))
        .collect();
    let mut all = Vec::new();
    for kind in kinds.iter().cycle().take(200 * wanted) {
        if all.len() == wanted {
            break;
        }
        let made = MultiLoop::of_dyad_chain(&drawn(*kind, draws)).expect("its lengths are positive");
        let flattest = made.transmissions_between([0.0, std::f64::consts::TAU]);
        let worst = flattest.iter().map(|of| of.worst()).fold(4.0, f64::min);
        if made.link_ratio() < 15.0 && worst > 0.26 {
            all.push(made);
        }
    }
    assert_eq!(all.len(), wanted);
    all
}

/// The parts, of which no slot depends on the sizes.
fn parts(linkage: &MultiLoop, sweep: &Sweep) -> Parts {
    Build::new(0.01 * linkage.longest(), 0.01 * linkage.longest()).parts(sweep).expect("it closes")
}

#[test]
fn holes_lie_where_the_joints_are_and_every_pin_has_one_in_both_of_its_plates() {
    for linkage in linkages(61, 40) {
        let sweep = Sweep::of_linkage(linkage).expect("its crank turns fully");
        let parts = parts(&linkage, &sweep);
        let plates = parts.plates(|_| 0.1);
        assert_eq!(plates.len(), 2 + 2 * linkage.dyad_count());
        assert_eq!(parts.pins().len(), 1 + 3 * linkage.dyad_count());
        for at in positions(&sweep, 24) {
            for plate in &plates {
                let placed = parts.placement(plate.link, &at);
                for hole in &plate.holes {
                    let apart = (placed.of(hole.at) - parts.joint(hole.joint, &at)).norm();
                    assert!(apart < 1e-11 * linkage.longest(), "{hole:?} of {}: {apart}", plate.link.name());
                }
            }
            // The general chain agrees on the places of all joints.
            let chain = linkage.to_chain().expect("a chain");
            let angle = (at.joints.crank_pin - linkage.crank_pivot()).arg();
            let pose = linkwright::internals::mechanism::Mechanism::pose_at(&chain, angle);
            for (name, place) in chain.names().iter().zip(&pose.joints) {
                let joint = Joint::named(name).expect("a joint");
                let apart = (place.expect("it closes") - parts.joint(joint, &at)).norm();
                assert!(apart < 1e-8 * linkage.longest(), "{name}: {apart}");
            }
        }
        for pin in parts.pins() {
            for link in pin.joins {
                let plate = plates.iter().find(|plate| plate.link == link).expect("a plate");
                assert!(plate.holes.iter().any(|hole| hole.joint == pin.joint), "{pin:?} in {}", link.name());
            }
        }
        let with_point: Vec<Link> = plates
            .iter()
            .filter(|plate| plate.holes.iter().any(|hole| hole.joint == Joint::P))
            .map(|plate| plate.link)
            .collect();
        assert_eq!(with_point, [parts.traced()]);
        assert_eq!(parts.undrilled(), None);
    }
}

#[test]
fn joints_move_no_farther_than_their_bounds_which_close_in_with_the_stretch() {
    for (k, linkage) in linkages(62, cases(6, 40)).into_iter().enumerate() {
        let sweep = Sweep::of_linkage(linkage).expect("its crank turns fully");
        let parts = parts(&linkage, &sweep);
        let draws = &mut stream(63, k as u64);
        let whole = sweep.stretches[0];
        for _ in 0..60 {
            let from = uniform(draws, whole.from, whole.to);
            let width = 6.3 * 10f64.powf(uniform(draws, -5.0, 0.0));
            let stretch = Stretch { from, to: from + width, ..whole };
            let (middle, reach) = sweep.reach(&stretch).expect("it closes");
            let within = Sweep { stretches: vec![stretch], ..sweep.clone() };
            let (mut most, mut bound) = (0.0, 0.0_f64);
            for at in positions(&within, 60) {
                for pin in parts.pins().iter().map(|pin| pin.joint).chain([Joint::P]) {
                    let moved = (parts.joint(pin, &at) - parts.joint(pin, &middle)).norm();
                    assert!(moved <= reach.of(pin) + 1e-10 * linkage.longest(), "{pin:?} of {linkage}");
                    most = f64::max(most, moved);
                    bound = bound.max(reach.of(pin));
                }
            }
            // The bounds follow the true motion.
            assert!(width > 1e-3 || bound < 1.5 * most, "{bound} for {most} in {width} of {linkage}");
        }
    }
}

#[test]
fn distances_of_several_loops_are_bounded_and_near_the_least_of_a_fine_sweep() {
    let (wanted, mut stacked) = (cases(3, 20), 0);
    for (i, linkage) in linkages(64, wanted).into_iter().enumerate() {
        let sweep = Sweep::of_linkage(linkage).expect("its crank turns fully");
        let found = layered(i, &sweep);
        let joints = 2 + 3 * linkage.dyad_count();
        let distances = pivot_distances(&sweep).expect("it closes");
        assert_eq!(distances.len(), joints * (joints - 1) / 2);
        let links = 2 + 2 * linkage.dyad_count();
        let pairs = found.free_pairs.len() + found.all_pins.len();
        assert_eq!(pairs, links * (links - 1) / 2, "every two plates are joined by a pin or free");
        stacked += usize::from(found.stack.is_some());
        nothing_crosses(&found);
        // As quickly as it can be decided, with the same holes.
        let build = Build::new(0.01 * linkage.longest(), 0.01 * linkage.longest());
        let decided = can_be_stacked(&sweep, &build).expect("it closes");
        assert_eq!(decided, layering(&sweep, &build).expect("it closes").stack.is_some());
    }
    assert!(4 * stacked > wanted, "{stacked} of {wanted} can be stacked");
}

/// Checks a stacking by the words of its rules.
fn nothing_crosses(found: &Layering) {
    let Some(stack) = &found.stack else { return };
    let layer = |link: Link| stack.layers.iter().position(|all| all.contains(&link)).expect("a layer");
    let all: usize = stack.layers.iter().map(Vec::len).sum();
    assert_eq!(all, found.links.len());
    let span = |joint: Joint| {
        let pin = found.all_pins.iter().find(|pin| pin.joint == joint).expect("a pin");
        let [one, other] = pin.joins.map(layer);
        (one.min(other), one.max(other))
    };
    for pin in &found.all_pins {
        assert_ne!(layer(pin.joins[0]), layer(pin.joins[1]), "{pin:?}");
    }
    for pair in &found.free_pairs {
        assert!(layer(pair.plates[0]) != layer(pair.plates[1]) || pair.closest.bound > 0.0, "{pair:?}");
    }
    for p in &found.pins_plates {
        let (low, high) = span(p.pin);
        let is_between = (low + 1..high).contains(&layer(p.plate));
        assert!(!is_between || p.closest.bound > 0.0, "{p:?} in {stack:?}");
        assert!(!is_between || stack.through.contains(&(p.pin, layer(p.plate))));
    }
    for ([one, other], closest) in &found.pins {
        let (one, other) = (span(*one), span(*other));
        let together = one.0.max(other.0) + 1 < one.1.min(other.1);
        assert!(!together || closest.bound > 0.0, "{found:?}");
    }
}
