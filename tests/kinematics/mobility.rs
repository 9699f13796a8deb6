//! What a linkage can do, against brute force: a flood fill of its configuration curve and dense samples.

use crate::reference::{Draws, Flooded, linkage, position, shipped_linkage, transmission};
use linkwright::internals::mechanism::four_bar::mobility::{
    CHANGE_POINT_TOLERANCE, grashof_margin, linkage_type, wrapped,
};
use linkwright::internals::mechanism::four_bar::transmission::angle_opposite;
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CouplerCurve, FourBar, InputRange, LinkageType, cross,
};
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Linkages of every type but the change point, at least `each` of each.
fn of_every_type(seed: u64, each: usize) -> Vec<FourBar> {
    let mut draws = Draws(seed);
    let mut seen: BTreeMap<LinkageType, usize> = BTreeMap::new();
    let mut linkages = Vec::new();
    while linkages.len() < 5 * each {
        let l = draws.clear_linkage();
        let count = seen.entry(l.linkage_type().expect("it closes somewhere")).or_default();
        if *count < each {
            *count += 1;
            linkages.push(l);
        }
    }
    assert_eq!(seen.len(), 5);
    linkages
}

#[test]
fn the_type_is_what_the_links_do_when_they_are_turned() {
    // Which links turn fully is asked of the triangle inequality alone, with each of crank and follower
    // driving.
    for l in of_every_type(1, 40) {
        let p = l.natural_coordinates();
        let from_the_follower = FourBar::with_coupler_offset(
            [l.follower_pivot(), l.crank_pivot()],
            [p.follower, p.coupler, p.crank],
            l.coupler_offset(),
            AssemblyMode::Plus,
        )
        .unwrap();
        let turns =
            |l: &FourBar| (0..1440).all(|i| crate::reference::closes(l, TAU * (f64::from(i) + 0.5) / 1440.0));
        let (crank, follower) = (turns(&l), turns(&from_the_follower));
        // Take the crank as the ground: the coupler turns relative to it exactly when it turns fully there.
        let on_the_crank = FourBar::with_coupler_offset(
            [Complex::new(0.0, 0.0), Complex::new(p.crank, 0.0)],
            [p.coupler, p.follower, l.ground()],
            Complex::new(1.0, 1.0),
            AssemblyMode::Plus,
        )
        .unwrap();
        let coupler = turns(&on_the_crank);
        let wanted = match (crank, follower, coupler) {
            (true, true, _) => LinkageType::DoubleCrank,
            (true, false, _) => LinkageType::CrankRocker,
            (false, true, _) => LinkageType::RockerCrank,
            (false, false, true) => LinkageType::DoubleRocker,
            (false, false, false) => LinkageType::TripleRocker,
        };
        assert_eq!(l.linkage_type(), Some(wanted), "{l}");
        assert_eq!(l.mobility().input_turns_fully(), crank, "{l}");
    }
}

#[test]
fn the_margin_is_that_of_the_sorted_lengths() {
    assert_eq!(grashof_margin([2.0, 1.0, 2.5, 2.5]), 1.0);
    assert_eq!(grashof_margin([4.0, 5.0, 2.0, 5.0]), 2.0);
    assert_eq!(grashof_margin([2.0, 1.25, 1.0, 1.25]), -0.5);
    assert_eq!(grashof_margin([3.0, 1.0, 3.0, 1.0]), 0.0);
    for l in of_every_type(2, 10) {
        let [g, a, b, c] = l.links();
        for shuffled in [[a, g, c, b], [c, b, a, g], [b, c, g, a]] {
            assert_eq!(grashof_margin(shuffled), l.grashof_margin(), "the order of the links is no matter");
        }
    }
}

#[test]
fn a_change_point_is_told_within_a_part_of_the_longest_link() {
    for size in [1e-6, 1.0, 1e6] {
        let with_margin = |m: f64| linkage_type([3.0, 1.0, 4.0, 2.0 + m].map(|x| x * size));
        let inside = 0.5 * CHANGE_POINT_TOLERANCE * 4.0;
        assert_eq!(with_margin(0.0), Some(LinkageType::ChangePoint));
        assert_eq!(with_margin(inside), Some(LinkageType::ChangePoint));
        assert_eq!(with_margin(-inside), Some(LinkageType::ChangePoint));
        assert_eq!(with_margin(4.0 * inside), Some(LinkageType::CrankRocker));
        assert_eq!(with_margin(-4.0 * inside), Some(LinkageType::TripleRocker));
    }
}

#[test]
fn links_that_cannot_be_joined_have_no_type_and_no_motion() {
    for links in [[10.0, 1.0, 2.0, 3.0], [1.0, 10.0, 2.0, 3.0], [1.0, 2.0, 10.0, 3.0], [1.0, 2.0, 3.0, 10.0]]
    {
        assert_eq!(linkage_type(links), None);
        let l = linkage([[0.0, 0.0], [links[0], 0.0]], [links[1], links[2], links[3], links[2], 0.0], 1, 1);
        let mobility = l.mobility();
        assert_eq!(mobility.input, InputRange::None);
        assert_eq!((mobility.circuits(), mobility.branches_per_circuit()), (0, 0));
        assert!(mobility.toggles().is_empty());
    }
    assert_eq!(linkage_type([1.0, f64::NAN, 2.0, 2.0]), None);
    assert_eq!(linkage_type([1.0, f64::INFINITY, 2.0, 2.0]), None);
}

#[test]
fn a_pivot_pair_in_one_place_is_a_double_crank_where_it_closes() {
    assert_eq!(linkage_type([0.0, 1.0, 1.5, 1.2]), Some(LinkageType::DoubleCrank));
    assert_eq!(linkage_type([0.0, 3.0, 1.2, 1.2]), None);
    let l = linkage([[0.0, 0.0], [0.0, 0.0]], [1.0, 1.5, 1.2, 1.0, 1.0], 1, 1);
    assert!(l.mobility().input_turns_fully());
    let mu = l.transmission_over_cycle();
    assert!((mu.max - mu.min).abs() <= 8.0 * f64::EPSILON);
}

#[test]
fn change_points_turn_as_their_links_let_them() {
    // A parallelogram, an antiparallelogram's lengths and two kites turn fully, in one circuit of two
    // branches.
    for links in [[2.0, 1.0, 2.0, 1.0], [1.0, 2.0, 1.0, 2.0], [1.0, 1.0, 2.0, 2.0], [1.0, 2.0, 2.0, 1.0]] {
        let l = linkage([[0.0, 0.0], [links[0], 0.0]], [links[1], links[2], links[3], links[2], 0.0], 1, 1);
        let mobility = l.mobility();
        assert_eq!(mobility.linkage_type, Some(LinkageType::ChangePoint));
        assert_eq!(mobility.input, InputRange::Full, "{links:?}");
        assert_eq!((mobility.circuits(), mobility.branches_per_circuit()), (1, 2));
        let branches = [AssemblyMode::Plus, AssemblyMode::Minus].map(|t1| mobility.branch(1.0, t1));
        assert_eq!(branches[0].circuit, branches[1].circuit);
        assert_ne!(branches[0], branches[1]);
    }
    // g + b = a + c with the coupler longest: |CB| >= b - c = 3 holds the crank off the ground line on one
    // side.
    let l = linkage([[0.0, 0.0], [2.0, 0.0]], [3.0, 4.0, 1.0, 4.0, 0.0], 1, 1);
    let InputRange::One(arc) = l.mobility().input else { panic!("{:?}", l.mobility().input) };
    let limit = ((4.0f64 + 9.0 - 9.0) / 12.0).acos();
    assert!((wrapped(arc.middle - PI)).abs() <= 1e-15);
    assert!((arc.half_width - (PI - limit)).abs() <= 8.0 * f64::EPSILON * PI);
}

#[test]
fn the_input_range_is_where_samples_close() {
    for l in of_every_type(3, 60) {
        let mobility = l.mobility();
        let arcs = match mobility.input {
            InputRange::Full => Vec::new(),
            InputRange::One(arc) => vec![arc],
            InputRange::Two(arcs) => arcs.to_vec(),
            InputRange::None => panic!("{l} closes somewhere"),
        };
        let runs = Flooded::of(&l).runs();
        assert_eq!(runs.len(), arcs.len(), "{l}");
        for [before, first, last, after] in runs {
            let found = arcs.iter().any(|arc| {
                let (from, to) = (arc.middle - arc.half_width, arc.middle + arc.half_width);
                let turns = TAU * ((before - from) / TAU).round();
                (before..=first).contains(&(from + turns)) && (last..=after).contains(&(to + turns))
            });
            assert!(found, "{l}: no arc from {before}..{first} to {last}..{after} in {arcs:?}");
        }
        if let [left, right] = arcs[..] {
            let b = l.follower_pivot() - l.crank_pivot();
            assert!(
                cross(b, Complex::from_polar(1.0, left.middle)) > 0.0,
                "the first arc lies left of the ground"
            );
            assert!(cross(b, Complex::from_polar(1.0, right.middle)) < 0.0);
        }
    }
}

#[test]
fn circuits_and_branches_are_those_of_a_flood_fill() {
    for l in of_every_type(4, 60) {
        let mobility = l.mobility();
        let mut circuits: BTreeMap<usize, BTreeSet<u8>> = BTreeMap::new();
        let mut told: BTreeMap<u8, BTreeSet<usize>> = BTreeMap::new();
        let mut branches: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
        let mut of_branch: BTreeMap<usize, BTreeSet<String>> = BTreeMap::new();
        for (phi, assembly, circuit, branch) in Flooded::of(&l).nodes() {
            let got = mobility.branch(phi, assembly);
            circuits.entry(circuit).or_default().insert(got.circuit.index);
            told.entry(got.circuit.index).or_default().insert(circuit);
            branches.entry(circuit).or_default().insert(branch);
            of_branch.entry(branch).or_default().insert(format!("{got:?}"));
            // The same position one turn on.
            assert_eq!(mobility.branch(phi + TAU, assembly), got);
            assert_eq!(mobility.branch(phi - TAU, assembly), got);
        }
        assert!(circuits.values().all(|c| c.len() == 1) && told.values().all(|c| c.len() == 1), "{l}");
        assert_eq!(circuits.len(), usize::from(mobility.circuits()), "{l}");
        for b in branches.values() {
            assert_eq!(b.len(), usize::from(mobility.branches_per_circuit()), "{l}");
        }
        let names: BTreeSet<&String> = of_branch.values().flatten().collect();
        assert!(of_branch.values().all(|b| b.len() == 1) && names.len() == of_branch.len(), "{l}");
    }
}

#[test]
fn a_rocker_crank_has_two_circuits_of_two_branches() {
    for l in of_every_type(5, 5) {
        let m = l.mobility();
        let wanted = match m.linkage_type.unwrap() {
            LinkageType::CrankRocker | LinkageType::DoubleCrank => (2, 1, 0),
            LinkageType::RockerCrank | LinkageType::DoubleRocker => (2, 2, 4),
            LinkageType::TripleRocker => (1, 2, 2),
            LinkageType::ChangePoint => panic!("the margin is clear of zero"),
        };
        assert_eq!((m.circuits(), m.branches_per_circuit(), m.toggles().len()), wanted, "{l}");
    }
}

#[test]
fn toggles_stand_where_coupler_and_follower_are_in_line() {
    for l in of_every_type(6, 60) {
        let mobility = l.mobility();
        for toggle in mobility.toggles() {
            let phi = toggle.crank_angle;
            assert!(-PI < phi && phi <= PI);
            assert!(l.position(phi).is_closed(), "{l}: the toggle itself closes");
            // |CB| is b + c or |b - c| to the rounding of the lengths and of the angle: s ds = g a sin theta
            // dphi.
            let s = crate::reference::diagonal(&l, phi);
            let (b, c) = (l.coupler(), l.follower());
            let off = (s - (b - c).abs()).abs().min((s - b - c).abs());
            assert!(
                off <= 32.0 * f64::EPSILON * crate::reference::scale(&l).powi(2) / s,
                "{l}: {off:e} at {phi}"
            );
            assert_eq!(mobility.branch(phi, AssemblyMode::Plus).circuit, toggle.circuit, "{l}");
            // Closed on one side, open on the other.
            let [inside, outside] =
                if l.position(phi + 1e-6).is_closed() { [1e-6, -1e-6] } else { [-1e-6, 1e-6] };
            assert!(l.position(phi + inside).is_closed() && !l.position(phi + outside).is_closed(), "{l}");
            // There the sine of the transmission angle goes to zero as the root of the way to the toggle.
            let [pin, follower_pin, _] = position(&l, phi + inside, AssemblyMode::Plus).unwrap();
            let sine = transmission(pin, follower_pin, l.follower_pivot()).sin();
            let limit = (2.0 * l.ground() * l.crank() / (b * c) * 1e-6f64).sqrt() * 2.0;
            assert!(sine <= limit, "{l}: sin mu = {sine:e}");
        }
    }
}

#[test]
fn a_circuits_parameter_runs_through_both_branches_and_back() {
    for l in of_every_type(7, 20) {
        let mobility = l.mobility();
        for (phi, assembly, ..) in Flooded::of(&l).nodes().step_by(7) {
            let Some(arc) = mobility.arc(mobility.branch(phi, assembly).circuit) else { continue };
            let psi = arc.parameter(phi, assembly);
            assert_eq!(AssemblyMode::of(psi.cos()), assembly);
            let again = arc.crank_angle(psi);
            assert!(wrapped(again - phi).abs() <= 16.0 * f64::EPSILON * TAU, "{again} for {phi}");
        }
    }
}

#[test]
fn a_triangle_gives_its_angle_to_the_last_digits_near_flat() {
    for (s, b, c) in [(3.0f64, 2.0, 2.5), (0.6, 2.0, 2.5), (4.4, 2.0, 2.5), (1.0, 1.0, 1.0)] {
        let wanted = ((b * b + c * c - s * s) / (2.0 * b * c)).acos();
        assert!((angle_opposite(s, b, c) - wanted).abs() <= 1e-14);
    }
    // Near flat acos loses half its digits; there mu = sqrt((s^2 - (b-c)^2)/(b c)) to its own square.
    let delta = 2f64.powi(-40);
    let mu = angle_opposite(0.5 + delta, 2.5, 2.0);
    assert!((mu / (delta * (1.0 + delta) / 5.0).sqrt() - 1.0).abs() <= 1e-12);
    assert_eq!(angle_opposite(0.1, 2.5, 2.0), 0.0);
    assert_eq!(angle_opposite(9.0, 2.5, 2.0), PI);
}

/// The extremes of the transmission angle over crank angles, sampled; and the width of a sample.
fn sampled(l: &FourBar, from: f64, to: f64, t1: AssemblyMode) -> ([f64; 2], f64) {
    let n = 4000;
    let mu: Vec<f64> = (0..=n)
        .filter_map(|i| position(l, from + (to - from) * f64::from(i) / f64::from(n), t1))
        .map(|[c, d, _]| transmission(c, d, l.follower_pivot()))
        .collect();
    let extremes = [mu.iter().copied().fold(f64::MAX, f64::min), mu.iter().copied().fold(f64::MIN, f64::max)];
    (extremes, (to - from).abs() / f64::from(n))
}

/// Half a sample away from an extreme, mu differs by mu'' step^2/8 with mu'' = g a/(b c sin mu) there, and
/// twice that covers the growth of sin mu.
fn missed(l: &FourBar, mu: f64, step: f64) -> f64 {
    let per = l.ground() * l.crank() / (l.coupler() * l.follower());
    // Close to flat it is mu^2 that is smooth, and mu misses at most the root of that.
    let smooth = per / mu.sin().abs().max(1e-9) * step * step / 4.0;
    smooth.min(per.sqrt() * step) + 1e-12
}

#[test]
fn the_extremes_of_the_transmission_angle_are_those_of_dense_samples() {
    let mut draws = Draws(8);
    for l in of_every_type(8, 20) {
        if l.mobility().input_turns_fully() {
            let got = l.transmission_over_cycle();
            let ([min, max], step) = sampled(&l, 0.0, TAU, l.assembly());
            assert!(got.min <= min + 1e-7 && min - got.min <= missed(&l, got.min, step), "{l}: {got:?}");
            assert!(got.max >= max - 1e-7 && got.max - max <= missed(&l, got.max, step), "{l}: {got:?}");
            assert!((got.worst() - got.min.min(PI - got.max)).abs() <= f64::EPSILON * PI);
            let turn = l.transmission_over(-1.0, TAU - 1.0);
            assert!((turn.min - got.min).abs() <= 1e-7 && (turn.max - got.max).abs() <= 1e-7);
        } else {
            let got = l.transmission_over_cycle();
            assert!(got.min == 0.0 || got.max == PI, "{l}: an input that rocks meets a toggle: {got:?}");
            assert_eq!(got.worst(), 0.0);
        }
        for _ in 0..8 {
            // A stretch that closes all along: any for a full turn, inside one arc otherwise.
            let mobility = l.mobility();
            let nodes: Vec<_> = Flooded::of(&l).nodes().collect();
            let (phi, t1, ..) = nodes[draws.below(nodes.len())];
            let (from, to) = match mobility.arc(mobility.branch(phi, t1).circuit) {
                None => (draws.between(-9.0, 9.0), draws.between(-9.0, 9.0)),
                Some(arc) => {
                    let turns = TAU * (draws.below(3) as f64 - 1.0);
                    let at = |u: f64| turns + arc.middle + 0.999 * u * arc.half_width;
                    (at(draws.between(-1.0, 1.0)), at(draws.between(-1.0, 1.0)))
                }
            };
            let got = l.transmission_over(from, to);
            let ([min, max], step) = sampled(&l, from, to, t1);
            assert!(got.min <= min + 1e-7 && min - got.min <= missed(&l, got.min, step), "{l}: {from}..{to}");
            assert!(got.max >= max - 1e-7 && got.max - max <= missed(&l, got.max, step), "{l}: {from}..{to}");
            let back = l.transmission_over(to, from);
            assert_eq!(back, got, "either order");
        }
    }
}

#[test]
fn the_transmission_angle_at_a_position_is_the_angle_at_the_follower_pin() {
    let mut draws = Draws(9);
    for l in of_every_type(9, 20) {
        for _ in 0..20 {
            let phi = draws.between(-7.0, 7.0);
            let wanted =
                position(&l, phi, l.assembly()).map(|[c, d, _]| transmission(c, d, l.follower_pivot()));
            match (l.transmission_angle(phi), wanted) {
                (Some(got), Some(wanted)) => {
                    // d mu = s ds/(b c sin mu), s known to eps scale.
                    let slack = 32.0 * f64::EPSILON * crate::reference::scale(&l).powi(2)
                        / (l.coupler() * l.follower() * wanted.sin());
                    assert!((got - wanted).abs() <= slack, "{l} at {phi}: {got} for {wanted}");
                }
                (got, wanted) => assert_eq!(got.is_some(), wanted.is_some(), "{l} at {phi}"),
            }
        }
    }
}

#[test]
fn the_nearest_point_of_a_curve_is_that_of_dense_samples() {
    let mut draws = Draws(10);
    for l in of_every_type(10, 12) {
        let flooded = Flooded::of(&l);
        let nodes: Vec<_> = flooded.nodes().collect();
        let (phi, t1, circuit, _) = nodes[draws.below(nodes.len())];
        let curve = CouplerCurve::through(&l, phi, t1, 720);
        // The whole circuit, sampled by angles: every closed grid point of the flood and ten points in
        // between.
        let dense: Vec<Complex> = nodes
            .iter()
            .filter(|node| node.2 == circuit)
            .flat_map(|&(phi, t1, ..)| (0..10).map(move |k| (phi + TAU / 14_400.0 * f64::from(k), t1)))
            .filter_map(|(phi, t1)| position(&l, phi, t1).map(|[.., p]| p))
            .collect();
        for _ in 0..20 {
            let to = Complex::new(draws.between(-6.0, 6.0), draws.between(-6.0, 6.0));
            let wanted = dense.iter().map(|p| (p - to).norm()).fold(f64::MAX, f64::min);
            let got = curve.nearest(to).expect("a curve");
            let (phi, t1) = curve.position_at(got.parameter);
            let p = l.position_with(phi, t1).joints().expect("a point of the curve").coupler_point;
            assert_eq!(p, got.point);
            assert!(((got.point - to).norm() - got.distance).abs() <= 8.0 * f64::EPSILON * got.distance);
            // Never farther than any sample; nearer by at most what lies between samples: the last grid step
            // next to a toggle, where P goes as the root of the angle.
            assert!(got.distance <= wanted + 1e-9, "{l}: {} for {wanted}", got.distance);
            let root = (2.0 * TAU / 1440.0f64).sqrt() * crate::reference::scale(&l);
            let gap = if curve.position_at(0.0) == (0.0, l.assembly()) { 0.02 } else { root };
            assert!(wanted - got.distance <= gap, "{l}: {} for {wanted}", got.distance);
        }
    }
}

#[test]
fn a_point_of_the_curve_is_at_distance_zero() {
    let mut draws = Draws(11);
    for l in of_every_type(11, 12) {
        let nodes: Vec<_> = Flooded::of(&l).nodes().collect();
        for _ in 0..10 {
            let (phi, t1, ..) = nodes[draws.below(nodes.len())];
            let p = l.position_with(phi, t1).joints().unwrap().coupler_point;
            let nearest = CouplerCurve::through(&l, phi, t1, 720).nearest(p).unwrap();
            // Golden section, where interpolation does not settle, leaves rounding of the parameter times the curve's
            // speed, which is great next to a toggle.
            assert!(
                nearest.distance <= 1e-9 * crate::reference::scale(&l),
                "{l} at {phi}: {:e}",
                nearest.distance
            );
        }
    }
}

#[test]
fn a_coupler_point_on_the_crank_pin_draws_a_circle() {
    let l = linkage([[0.0, 0.0], [2.0, 0.0]], [1.0, 2.5, 2.5, 0.0, 2.5], 1, 1);
    for n in [8, 720, 1000] {
        let curve = CouplerCurve::through(&l, 0.0, AssemblyMode::Plus, n);
        let polygon = 2.0 * n as f64 * (PI / n as f64).sin();
        assert!((curve.length() - polygon).abs() <= 8.0 * f64::EPSILON * n as f64, "{n} sides");
    }
    let length = CouplerCurve::through(&l, 0.0, AssemblyMode::Plus, 720).length();
    // Chords are short of the circle by (step)^2/24.
    assert!((length / TAU - 1.0).abs() <= (TAU / 720.0).powi(2) / 24.0 * 1.01);
    let nearest =
        CouplerCurve::through(&l, 0.0, AssemblyMode::Plus, 720).nearest(Complex::new(3.0, 4.0)).unwrap();
    assert!((nearest.distance - 4.0).abs() <= 1e-13);
    assert!(wrapped(nearest.parameter - 4.0f64.atan2(3.0)).abs() <= 1e-7);
}

#[test]
fn a_rocking_crank_pin_goes_over_its_arc_and_back() {
    for l in of_every_type(12, 4) {
        let p = l.natural_coordinates();
        let on_the_pin = linkage(
            [p.crank_pivot, p.follower_pivot],
            [p.crank, p.coupler, p.follower, 0.0, p.coupler],
            1,
            1,
        );
        let mobility = on_the_pin.mobility();
        let (phi, t1, ..) = Flooded::of(&on_the_pin).nodes().next().unwrap();
        let Some(arc) = mobility.arc(mobility.branch(phi, t1).circuit) else { continue };
        let curve = CouplerCurve::through(&on_the_pin, phi, t1, 2000);
        assert_eq!(curve.points().count(), 2000, "{on_the_pin}: open within rounding of a toggle");
        let wanted = 4.0 * arc.half_width * p.crank;
        // Chords are short by (step)^2/24, step at most half_width 2 pi/2000.
        let short = (arc.half_width * TAU / 2000.0).powi(2) / 24.0;
        let got = curve.length();
        assert!(got <= wanted * (1.0 + 1e-12) && got >= wanted * (1.0 - short) - 1e-12, "{got} for {wanted}");
    }
}

#[test]
fn a_circuit_comes_round_to_where_it_began() {
    for l in of_every_type(13, 20) {
        for (phi, t1) in [
            (l.ground_angle() + FRAC_PI_2, AssemblyMode::Plus),
            (l.ground_angle() - 2.0, AssemblyMode::Minus),
        ] {
            if !l.position_with(phi, t1).is_closed() {
                continue;
            }
            let curve = CouplerCurve::through(&l, phi, t1, 64);
            let circuit = l.mobility().branch(phi, t1).circuit;
            for i in 0..64 {
                let tau = TAU * f64::from(i) / 64.0;
                let (at, assembly) = curve.position_at(tau);
                assert_eq!(l.mobility().branch(at, assembly).circuit, circuit, "{l} stays on its circuit");
                let (here, again) = (curve.point_at(tau), curve.point_at(tau + TAU));
                if let (Some(here), Some(again)) = (here, again) {
                    assert!((here - again).norm() <= 1e-6 * crate::reference::scale(&l), "{l} at {tau}");
                }
            }
        }
    }
}

#[test]
fn the_classical_linkages_have_their_types() {
    for (name, wanted) in [
        ("hoeken", LinkageType::CrankRocker),
        ("chebyshev", LinkageType::DoubleRocker),
        ("roberts", LinkageType::TripleRocker),
        ("watt", LinkageType::TripleRocker),
        ("romero", LinkageType::CrankRocker),
    ] {
        assert_eq!(shipped_linkage(name).linkage_type(), Some(wanted), "{name}");
    }
    // Ground 10, three links of 5: 5 + 10 is more than 5 + 5.
    assert_eq!(shipped_linkage("evans").linkage_type(), Some(LinkageType::TripleRocker));
    // De Castro's example: 300 + 700 is more than 350 + 500.
    assert_eq!(linkage_type([350.0, 700.0, 300.0, 500.0]), Some(LinkageType::TripleRocker));
}
