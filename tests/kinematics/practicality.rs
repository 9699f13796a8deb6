//! Layers and least distances against a brute-force sweep of the plates' outlines; sensitivities against Monte Carlo.

use crate::random::{TYPES, linkage};
use crate::thorough;
use linkwright::internals::judge::practicality::clearance::{Workpieces, pivot_distances};
use linkwright::internals::judge::practicality::closest::{MARGIN, RELATIVE};
use linkwright::internals::judge::practicality::layers::{FREE_PAIRS, clear, layering};
use linkwright::internals::judge::practicality::sensitivity::{
    At, Crank, Sensitivity, along, is_flat, sensitivity,
};
use linkwright::internals::judge::practicality::sweep::Stretch;
use linkwright::internals::judge::practicality::{Build, Joint, Sweep};
use linkwright::internals::mechanism::plates::{Edge, Link, Pin, Plate};
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CouplerCurve, CouplerSide, FourBar, Joints, LinkageType, NaturalCoordinates,
    cross, dot,
};
use linkwright::internals::numbers::arithmetic::streams::{Stream, normal, stream, uniform};
use std::f64::consts::TAU;

/// The hole centres of a link at a position.
fn holes(l: &FourBar, link: Link, j: &Joints) -> Vec<Complex> {
    match link {
        Link::Ground => vec![l.crank_pivot(), l.follower_pivot()],
        Link::Crank => vec![l.crank_pivot(), j.crank_pin],
        Link::Coupler => vec![j.crank_pin, j.follower_pin, j.coupler_point],
        _ => vec![l.follower_pivot(), j.follower_pin],
    }
}

/// The place of a joint of a four-bar.
fn joint(l: &FourBar, joint: Joint, j: &Joints) -> Complex {
    match joint {
        Joint::A => l.crank_pivot(),
        Joint::B => l.follower_pivot(),
        Joint::C => j.crank_pin,
        Joint::D => j.follower_pin,
        _ => j.coupler_point,
    }
}

/// The distance from a point to the convex hull of two or three points, 0 inside.
fn to_hull(p: Complex, hull: &[Complex]) -> f64 {
    let to_segment = |a: Complex, b: Complex| {
        let along = b - a;
        let t = (dot(p - a, along) / along.norm_sqr().max(1e-300)).clamp(0.0, 1.0);
        (a + along * t - p).norm()
    };
    if let [a, b, c] = *hull {
        let sides = [cross(b - a, p - a), cross(c - b, p - b), cross(a - c, p - c)];
        if sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0) {
            let flat = cross(b - a, c - a).abs() < 1e-12 * (b - a).norm() * (c - a).norm();
            if !flat {
                return 0.0;
            }
        }
        return to_segment(a, b).min(to_segment(b, c)).min(to_segment(c, a));
    }
    to_segment(hull[0], hull[1])
}

/// Points along a plate's outline, at most `step` apart, in its own frame.
fn outline(plate: &Plate, step: f64) -> Vec<Complex> {
    let mut points = Vec::new();
    for edge in plate.outline() {
        match edge {
            Edge::Line { from, to } => {
                let n = ((to - from).norm() / step).ceil().max(1.0) as usize;
                points.extend((0..n).map(|i| from + (to - from) * (i as f64 / n as f64)));
            }
            Edge::Arc { from, centre, turn, .. } => {
                let n = (turn * plate.radius / step).ceil().max(1.0) as usize;
                points.extend((0..n).map(|i| {
                    centre + (from - centre) * Complex::from_polar(1.0, turn * i as f64 / n as f64)
                }));
            }
        }
    }
    points
}

/// `n` + 1 positions of each stretch, evenly spaced in the crank angle: crank angle, assembly mode, joints.
fn positions(sweep: &Sweep, n: usize) -> Vec<(f64, AssemblyMode, Joints)> {
    let of = |stretch: &Stretch| {
        let Stretch { from, to, assembly } = *stretch;
        (0..=n).filter_map(move |i| {
            let angle = from + (to - from) * i as f64 / n as f64;
            Some((angle, assembly, sweep.linkage.joints_with(angle, assembly)?.joints))
        })
    };
    sweep.stretches.iter().flat_map(of).collect()
}

/// How far the outline of one plate stays from another plate at a position; 0 or less where it enters it.
fn entered(l: &FourBar, points: &[Complex], plate: &Plate, other: &Plate, j: &Joints) -> f64 {
    let at = plate.placement(l, j);
    let hull = holes(l, other.link, j);
    points.iter().map(|p| to_hull(at.of(*p), &hull) - other.radius).fold(f64::INFINITY, f64::min)
}

fn swept(seed: u64, count: u64) -> impl Iterator<Item = (FourBar, Sweep, Build)> {
    (0..count).map(move |i| {
        let mut draws = stream(seed, i);
        let l = linkage(&mut draws, TYPES[(i % 5) as usize]);
        let radius = uniform(&mut draws, 0.02, 0.12) * l.longest_link();
        let build = Build::of_radii(radius, 0.4 * radius);
        (l, Sweep::of_linkage(l).expect("it can be joined"), build)
    })
}

#[test]
fn plates_that_share_a_plane_are_those_whose_outlines_never_meet_in_a_brute_force_sweep() {
    let (mut apart, mut met) = (0, 0);
    for (i, (l, sweep, build)) in swept(41, thorough::cases(100, 250)).enumerate() {
        let pieces = Workpieces::new(&sweep, &build).expect("it closes");
        let plates = Plate::all(&l, build.plate_radius);
        let positions = positions(&sweep, 600);
        let step = 0.5 * build.plate_radius;
        for [one, other] in FREE_PAIRS {
            let closest = pieces.between_plates(one, other).expect("it closes");
            let (one, other) = (&plates[one as usize], &plates[other as usize]);
            let (of_one, of_other) = (outline(one, step), outline(other, step));
            let least = positions
                .iter()
                .map(|(_, _, j)| {
                    let here = entered(&l, &of_one, one, other, j);
                    here.min(entered(&l, &of_other, other, one, j))
                })
                .fold(f64::INFINITY, f64::min);
            let rounding = 1e-9 * l.longest_link();
            if clear(&closest) {
                // Nothing that is proved apart is seen to meet.
                assert!(least > 0.0, "{i}: outlines meet ({least}), {closest:?}");
                assert!(closest.bound <= least + rounding, "{i}");
                apart += 1;
            } else if closest.value > 0.0 {
                assert!(closest.value - closest.bound <= MARGIN * l.longest_link() + rounding, "{i}");
            } else {
                // What is said to meet meets at the place that is told.
                let there = l.position_with(closest.crank_angle, closest.assembly).joints().expect("closed");
                let deep = entered(&l, &of_one, one, other, &there);
                let deep = deep.min(entered(&l, &of_other, other, one, &there));
                let sampled = step * step / (4.0 * build.plate_radius) + step;
                assert!(deep <= sampled, "{i}: {deep} apart where they are said to meet, {closest:?}");
                met += 1;
            }
        }
    }
    assert!(apart > thorough::cases(24, 60) && met > thorough::cases(24, 60), "{apart} apart, {met} met");
}

#[test]
fn no_distance_is_below_its_bound_and_each_is_near_the_least_of_a_fine_sweep() {
    for (i, (l, sweep, build)) in swept(42, thorough::cases(40, 100)).enumerate() {
        let found = layering(&sweep, &build).expect("it closes");
        let positions = positions(&sweep, 2000);
        let size = l.longest_link();
        let pieces = Workpieces::new(&sweep, &build).expect("it closes");
        let least = |of: &dyn Fn(&Joints) -> f64| {
            positions.iter().map(|(_, _, j)| of(j)).fold(f64::INFINITY, f64::min)
        };
        let check =
            |what: &str, closest: &linkwright::internals::judge::practicality::Closest, sampled: f64| {
                let slack = 1e-9 * size;
                let margin = (MARGIN * size).max(RELATIVE * closest.value.abs()) + slack;
                assert!(closest.bound <= sampled + slack, "{i} {what}: {closest:?}, sampled {sampled}");
                assert!(closest.value <= sampled + margin, "{i} {what}: {closest:?}, sampled {sampled}");
                assert!(closest.value - closest.bound <= 1.01 * margin, "{i} {what}: {closest:?}");
            };
        for pair in &found.free_pairs {
            let [one, other] = pair.plates;
            check("plates", &pair.closest, least(&|j| pieces.between_plates_at(one, other, j)));
        }
        for p in &found.pins_plates {
            let sampled = least(&|j| {
                to_hull(joint(&l, p.pin, j), &holes(&l, p.plate, j)) - build.plate_radius - build.pin_radius
            });
            // Inside a hull the library tells how deep, the brute force only that it is.
            if sampled > -build.plate_radius {
                check("pin and plate", &p.closest, sampled);
            } else {
                assert!(p.closest.value < 0.0, "{i}: {p:?}");
            }
        }
        for ([one, other], closest) in &found.pins {
            let of = |j: &Joints| (joint(&l, *one, j) - joint(&l, *other, j)).norm() - 2.0 * build.pin_radius;
            check("pins", closest, least(&of));
        }
    }
}

#[test]
fn pivots_are_as_near_as_the_closed_forms_say() {
    for (l, sweep, _) in swept(43, 100) {
        let distances = pivot_distances(&sweep).expect("it closes");
        assert_eq!(distances.len(), 10);
        let of = |between: [&str; 2]| distances.iter().find(|d| d.between == between).expect("all pairs");
        let slack = 1e-7 * l.longest_link();
        if sweep.full_turn {
            let wanted = (l.ground() - l.crank()).abs();
            assert!((of(["B", "C"]).closest.value - wanted).abs() <= slack);
        } else if l.linkage_type() != Some(LinkageType::TripleRocker) {
            // A rocking Grashof linkage reaches both toggles, the nearer one with C |b - c| from B.
            let wanted = (l.coupler() - l.follower()).abs();
            assert!((of(["B", "C"]).closest.value - wanted).abs() <= slack);
        }
        for (between, wanted) in [
            (["A", "C"], l.crank()),
            (["B", "D"], l.follower()),
            (["C", "D"], l.coupler()),
            (["A", "B"], l.ground()),
        ] {
            assert!(of(between).fixed && (of(between).closest.value - wanted).abs() <= slack);
        }
    }
}

/// The layers of a stacking by the brute-force distances; [ground, crank, coupler, follower].
fn fewest_by_brute_force(l: &FourBar, sweep: &Sweep, build: Build) -> Option<usize> {
    let positions = positions(sweep, 2000);
    let least =
        |of: &dyn Fn(&Joints) -> f64| positions.iter().map(|(_, _, j)| of(j)).fold(f64::INFINITY, f64::min);
    let pieces = Workpieces::new(sweep, &build).expect("it closes");
    let plate_clear = |one: Link, other: Link| least(&|j| pieces.between_plates_at(one, other, j)) > 0.0;
    let free = [plate_clear(Link::Crank, Link::Follower), plate_clear(Link::Coupler, Link::Ground)];
    let ends: [[usize; 2]; 4] = [[0, 1], [0, 3], [1, 2], [2, 3]];
    let mut pin_plate = [[false; 4]; 4];
    for (p, pin) in Joint::PINS.into_iter().enumerate() {
        for (q, plate) in Link::ALL.into_iter().enumerate() {
            pin_plate[p][q] = least(&|j| {
                to_hull(joint(l, pin, j), &holes(l, plate, j)) - build.plate_radius - build.pin_radius
            }) > 0.0;
        }
    }
    let pin_pin = |p: usize, q: usize| {
        least(&|j| {
            (joint(l, Joint::PINS[p], j) - joint(l, Joint::PINS[q], j)).norm() - 2.0 * build.pin_radius
        }) > 0.0
    };
    let mut fewest = None;
    for code in 0..256_usize {
        let places = [code & 3, (code >> 2) & 3, (code >> 4) & 3, code >> 6];
        let count = places.iter().max().expect("four") + 1;
        if (0..count).any(|l| !places.contains(&l)) || ends.iter().any(|[p, q]| places[*p] == places[*q]) {
            continue;
        }
        if (places[1] == places[3] && !free[0]) || (places[0] == places[2] && !free[1]) {
            continue;
        }
        let passes = |p: usize, l: usize| {
            let [one, other] = ends[p].map(|link| places[link]);
            one.min(other) < l && l < one.max(other)
        };
        let blocked = (0..count).any(|l| {
            (0..4).any(|p| {
                passes(p, l)
                    && ((0..4).any(|link| places[link] == l && !pin_plate[p][link])
                        || (p + 1..4).any(|q| passes(q, l) && !pin_pin(p, q)))
            })
        });
        if !blocked {
            fewest = Some(fewest.map_or(count, |n: usize| n.min(count)));
        }
    }
    fewest
}

#[test]
fn the_fewest_layers_are_those_of_every_stacking_tried_by_brute_force() {
    let mut seen = std::collections::BTreeMap::new();
    for (i, (l, sweep, build)) in swept(44, thorough::cases(50, 150)).enumerate() {
        let found = layering(&sweep, &build).expect("it closes");
        let near =
            found.free_pairs.iter().map(|p| p.closest).chain(found.pins_plates.iter().map(|p| p.closest));
        if near
            .chain(found.pins.iter().map(|(_, closest)| *closest))
            .any(|c| c.value.abs() < 2.0 * MARGIN * l.longest_link())
        {
            continue;
        }
        let count = found.stack.as_ref().map(|stack| stack.layers.len());
        assert_eq!(count, fewest_by_brute_force(&l, &sweep, build), "{i}: {found:?}");
        *seen.entry(count).or_insert(0) += 1;
    }
    // 3 layers, 4 layers and none.
    assert_eq!(seen.len(), 3, "{seen:?}");
}

#[test]
fn a_drag_link_stands_on_its_ground_from_both_sides_and_a_small_crank_takes_three_layers() {
    let drag = |offset: Complex| {
        FourBar::with_coupler_offset(
            [Complex::new(0.0, 0.0), Complex::new(10.0, 0.0)],
            [40.0, 35.0, 38.0],
            offset,
            AssemblyMode::Plus,
        )
        .expect("a linkage")
    };
    let stack = |l: &FourBar, sweep: &Sweep, build: Build| {
        let found = layering(sweep, &build).expect("closed");
        assert_eq!(sweep.linkage, (*l).into());
        found.stack
    };
    let slim = Build::of_radii(6.0, 3.0);
    // The coupler turns around its ground and never comes over it: crank below, follower above, both beside it.
    let l = drag(Complex::new(15.0, 10.0));
    let found = stack(&l, &Sweep::of_linkage(l).expect("joined"), slim.clone()).expect("there is one");
    assert_eq!(found.layers, [vec![Link::Crank], vec![Link::Ground, Link::Coupler], vec![Link::Follower]]);
    // A coupler that reaches over it lies above everything, on a crank pin that goes round outside.
    let l = drag(Complex::new(15.0, -60.0));
    let found = stack(&l, &Sweep::of_linkage(l).expect("joined"), slim).expect("there is one");
    assert_eq!(
        found.layers,
        [[Link::Crank], [Link::Ground], [Link::Follower], [Link::Coupler]].map(Vec::from)
    );
    assert_eq!(found.through, [(Joint::C, 1), (Joint::C, 2)]);
    // With plates so broad that this pin, never more than 30 from B, cannot pass, nothing works.
    let broad = Build::of_radii(24.0, 8.0);
    assert_eq!(stack(&l, &Sweep::of_linkage(l).expect("joined"), broad), None);
    // Over a short motion two layers may do.
    let l = drag(Complex::new(15.0, 10.0));
    let mut short = Sweep::of_linkage(l).expect("joined");
    short.full_turn = false;
    short.stretches[0].from = 1.9;
    short.stretches[0].to = 2.2;
    let slimmer = Build::of_radii(2.0, 1.0);
    let found = stack(&l, &short, slimmer).expect("there is one");
    assert_eq!(found.layers.len(), 2, "{found:?}");
    let crank_rocker = FourBar::with_coupler_offset(
        [Complex::new(0.0, 0.0), Complex::new(80.0, 0.0)],
        [20.0, 70.0, 50.0],
        Complex::new(35.0, 30.0),
        AssemblyMode::Plus,
    )
    .expect("a linkage");
    let build = Build::of_radii(4.0, 2.0);
    let found = layering(&Sweep::of_linkage(crank_rocker).expect("joined"), &build).expect("closed");
    let stack = found.stack.expect("there is one");
    assert_eq!(stack.layers, [vec![Link::Ground], vec![Link::Crank, Link::Follower], vec![Link::Coupler]]);
    assert!(stack.through.is_empty());
}

/// The linkage with errors of the nine dimensions.
fn with_errors(l: &FourBar, errors: &[f64; 9]) -> FourBar {
    let [ax, ay, bx, by, a, b, c, q, r] = *errors;
    if is_flat(l) {
        return FourBar::with_coupler_offset(
            [l.crank_pivot() + Complex::new(ax, ay), l.follower_pivot() + Complex::new(bx, by)],
            [l.crank() + a, l.coupler() + b, l.follower() + c],
            l.coupler_offset() + Complex::new(q, r),
            l.assembly(),
        )
        .expect("a linkage");
    }
    let n = l.natural_coordinates();
    FourBar::new(NaturalCoordinates {
        crank_pivot: [n.crank_pivot[0] + ax, n.crank_pivot[1] + ay],
        follower_pivot: [n.follower_pivot[0] + bx, n.follower_pivot[1] + by],
        crank: n.crank + a,
        coupler: n.coupler + b,
        follower: n.follower + c,
        crank_side: n.crank_side + q,
        follower_side: n.follower_side + r,
        ..n
    })
    .expect("a linkage")
}

/// How far each point of the path moves, by the positions alone.
fn shifts(l: &FourBar, wrong: &FourBar, at: &[At], crank: Crank) -> Vec<f64> {
    let place = |l: &FourBar, at: &At, turned: f64| {
        l.position_with(at.crank_angle + turned, at.assembly).joints().expect("closed").coupler_point
    };
    let turned_by = |turned: f64| -> Vec<f64> {
        at.iter().map(|at| (place(wrong, at, turned) - place(l, at, 0.0)).norm()).collect()
    };
    match crank {
        Crank::Stays => turned_by(0.0),
        Crank::TurnsWithGround => turned_by(wrong.ground_angle() - l.ground_angle()),
        Crank::OffsetIsSet => {
            let sum = |turned: f64| turned_by(turned).iter().map(|s| s * s).sum::<f64>();
            let (mut low, mut high) = (-0.01, 0.01);
            for _ in 0..80 {
                let third = (high - low) / 3.0;
                if sum(low + third) <= sum(high - third) { high -= third } else { low += third }
            }
            turned_by(0.5 * (low + high))
        }
        Crank::Settles => {
            let curve = CouplerCurve::through(wrong, at[0].crank_angle, at[0].assembly, 2000);
            at.iter().map(|at| curve.nearest(place(l, at, 0.0)).expect("a point").distance).collect()
        }
    }
}

fn cases() -> Vec<(FourBar, Vec<At>)> {
    let mut cases = Vec::new();
    for i in 0..5 {
        let mut draws = stream(45, i);
        let l = linkage(&mut draws, [LinkageType::CrankRocker, LinkageType::DoubleCrank][(i % 2) as usize]);
        let at = along(&Sweep::of_linkage(l).expect("joined"), 14);
        cases.push((l, at));
    }
    // Hoeken's: P in line with C and D.
    let hoeken = FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [2.0, 0.0],
        crank: 1.0,
        coupler: 2.5,
        follower: 2.5,
        crank_side: 5.0,
        follower_side: 2.5,
        assembly: AssemblyMode::Plus,
        side: CouplerSide::Plus,
    })
    .expect("a linkage");
    let at = along(&Sweep::of_linkage(hoeken).expect("joined"), 14);
    cases.push((hoeken, at));
    cases
}

#[test]
fn each_dimension_moves_the_path_as_much_as_when_it_is_changed_by_a_little() {
    for (l, at) in cases() {
        let step = 1e-6 * l.crank().min(l.ground());
        for crank in [Crank::Settles, Crank::OffsetIsSet, Crank::Stays, Crank::TurnsWithGround] {
            let found = sensitivity(l, &at, crank).expect("derivatives");
            for k in 0..9 {
                let mut errors = [0.0; 9];
                errors[k] = step;
                let moved = shifts(&l, &with_errors(&l, &errors), &at, crank);
                let rms = (moved.iter().map(|s| s * s).sum::<f64>() / at.len() as f64).sqrt() / step;
                let worst = moved.iter().copied().fold(0.0, f64::max) / step;
                let Sensitivity { dimensions, .. } = &found;
                let slack = 2e-3 * found.band.max(found.worst);
                assert!((dimensions[k].rms - rms).abs() <= slack, "{crank:?} {:?} {rms}", dimensions[k]);
                assert!(
                    (dimensions[k].worst - worst).abs() <= slack,
                    "{crank:?} {:?} {worst}",
                    dimensions[k]
                );
            }
        }
    }
}

/// The root of the mean square, over many random errors, of what each point moves.
fn monte_carlo(draws: &mut Stream, l: &FourBar, at: &[At], crank: Crank, sigma: f64, n: usize) -> Vec<f64> {
    let mut sums = vec![0.0; at.len()];
    for _ in 0..n {
        let errors: [f64; 9] = std::array::from_fn(|_| normal(draws, 0.0, sigma));
        for (sum, shift) in sums.iter_mut().zip(shifts(l, &with_errors(l, &errors), at, crank)) {
            *sum += shift * shift;
        }
    }
    sums.into_iter().map(|sum| (sum / n as f64).sqrt()).collect()
}

#[test]
fn the_band_is_that_of_monte_carlo() {
    for (i, (l, at)) in cases().into_iter().enumerate() {
        let sigma = 1e-5 * l.crank().min(l.ground());
        for (crank, n) in [(Crank::Settles, 400), (Crank::OffsetIsSet, 400), (Crank::TurnsWithGround, 1500)] {
            let found = sensitivity(l, &at, crank).expect("derivatives");
            let mut draws = stream(46, i as u64);
            let each = monte_carlo(&mut draws, &l, &at, crank, sigma, n);
            let rms = (each.iter().map(|s| s * s).sum::<f64>() / at.len() as f64).sqrt() / sigma;
            let worst = each[found.worst_at] / sigma;
            // The standard error of a root mean square of n draws is at most its part 1 / sqrt(2 n): three of them.
            let slack = 3.0 / (2.0 * n as f64).sqrt();
            assert!((rms / found.band - 1.0).abs() <= slack, "{i} {crank:?}: {rms} for {}", found.band);
            assert!((worst / found.worst - 1.0).abs() <= slack, "{i} {crank:?}: {worst} for {}", found.worst);
        }
    }
}

#[test]
fn the_ground_row_is_b_moved_along_the_ground_and_the_worst_dimension_has_the_largest_rms() {
    for (l, at) in cases() {
        let found = sensitivity(l, &at, Crank::Stays).expect("derivatives");
        let step = 1e-6 * l.ground();
        let along = Complex::from_polar(step, l.ground_angle());
        let mut errors = [0.0; 9];
        (errors[2], errors[3]) = (along.re, along.im);
        let moved = shifts(&l, &with_errors(&l, &errors), &at, Crank::Stays);
        let rms = (moved.iter().map(|s| s * s).sum::<f64>() / at.len() as f64).sqrt() / step;
        assert!((found.ground.expect("a four-bar has one").rms - rms).abs() <= 2e-3 * found.band);
        let largest = found.dimensions.iter().map(|d| d.rms).fold(0.0, f64::max);
        assert_eq!(found.worst_dimension().rms, largest);
    }
}

#[test]
fn a_motion_past_a_toggle_is_split_there() {
    let mut draws = stream(47, 0);
    for of in [LinkageType::TripleRocker, LinkageType::DoubleRocker] {
        let l = linkage(&mut draws, of);
        let sweep = Sweep::of_linkage(l).expect("joined");
        let both = Sweep {
            stretches: [AssemblyMode::Plus, AssemblyMode::Minus]
                .map(|assembly| Stretch { assembly, ..sweep.stretches[0] })
                .to_vec(),
            ..sweep.clone()
        };
        let build = Build::of_radii(0.05 * l.longest_link(), 0.02 * l.longest_link());
        let one = Workpieces::new(&sweep, &build)
            .expect("closed")
            .between_plates(Link::Crank, Link::Follower)
            .expect("closed");
        let all = Workpieces::new(&both, &build)
            .expect("closed")
            .between_plates(Link::Crank, Link::Follower)
            .expect("closed");
        assert!(all.value <= one.value + 1e-12 * TAU);
    }
}

#[test]
fn a_motor_widens_the_plates_at_its_holes_and_stands_at_a() {
    let l = FourBar::with_coupler_offset(
        [Complex::new(0.0, 0.0), Complex::new(80.0, 0.0)],
        [20.0, 70.0, 50.0],
        Complex::new(35.0, 30.0),
        AssemblyMode::Plus,
    )
    .expect("a linkage");
    let sweep = Sweep::of_linkage(l).expect("joined");
    let tolerance = 4.0 * MARGIN * l.longest_link();
    let pins = Build::new(4.0, 3.0);
    let motor = pins.clone().with_motor(Some(6.0), Some(20.0));
    let [plain, wide] = [pins.clone(), motor].map(|build| layering(&sweep, &build).expect("it closes"));
    // Each distance less by what the two parts have become wider: 1 of the crank and its shaft, 8 of the ground.
    let wider = |link| match link {
        Link::Ground => 8.0,
        Link::Crank => 1.0,
        _ => 0.0,
    };
    let shaft = |pin| if pin == Joint::A { 1.0 } else { 0.0 };
    for (one, other) in plain.free_pairs.iter().zip(&wide.free_pairs) {
        let more: f64 = one.plates.iter().map(|link| wider(*link)).sum();
        assert!((one.closest.value - other.closest.value - more).abs() < tolerance, "{:?}", one.plates);
    }
    for (one, other) in plain.pins_plates.iter().zip(&wide.pins_plates) {
        let more = wider(one.plate) + shaft(one.pin);
        assert!((one.closest.value - other.closest.value - more).abs() < tolerance, "{one:?} {other:?}");
    }
    // One of the two alone: the boss is as the shaft, and a smaller shaft narrows no plate.
    let thin = pins.clone().with_motor(Some(2.0), None);
    assert_eq!(thin.bores.own(Link::Ground, Joint::A), Some(2.0));
    assert_eq!(
        (thin.radius_of(Link::Crank), thin.radius_at(&Pin::new(Joint::A, Link::Ground, Link::Crank))),
        (5.0, 1.0)
    );
    assert_eq!(pins.clone().with_motor(None, None), pins);
}
