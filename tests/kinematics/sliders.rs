//! Slider-cranks and inverted slider-cranks against chains, dual numbers, central differences and dense samples.

use linkwright::internals::mechanism::chain::Outcome;
use linkwright::internals::mechanism::four_bar::motion::CrankMotion;
use linkwright::internals::mechanism::four_bar::positions::JointColumns;
use linkwright::internals::mechanism::slider::SliderMotion;
use linkwright::internals::mechanism::slider::motion::motion;
use linkwright::internals::mechanism::{
    AssemblyMode, Chain, ChainBuilder, Circuit, Complex, CouplerCurve, FourBar, InputRange,
    InvertedSliderCrank, InvertedSliderCrankParameters, Linkage, LinkageError, Mechanism, SliderCrank,
    SliderCrankParameters, SliderLinkage, SliderPosition, Status, cross, dot, xy,
};
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use num_dual::{Dual64, DualNum};
use rand_xoshiro::Xoshiro256PlusPlus;
use std::f64::consts::{PI, TAU};

use AssemblyMode::{Minus, Plus};

const LINKAGES: u64 = 10_000;

/// The least |sin mu| at which a position counts: its rounding grows with the inverse.
const SINE: f64 = 1e-2;

fn random_point(draws: &mut Xoshiro256PlusPlus) -> Complex {
    Complex::new(uniform(draws, -5.0, 5.0), uniform(draws, -5.0, 5.0))
}

fn random_sign(draws: &mut Xoshiro256PlusPlus) -> AssemblyMode {
    AssemblyMode::of(uniform(draws, -1.0, 1.0))
}

fn slider_crank(index: u64) -> (SliderCrank, f64) {
    let draws = &mut stream(16, index);
    let lengths = [uniform(draws, 0.1, 4.0), uniform(draws, 0.1, 9.0)];
    let line = (random_point(draws), uniform(draws, -TAU, TAU));
    let (pivot, offset, sign) = (random_point(draws), random_point(draws), random_sign(draws));
    let linkage = SliderCrank::from_parts(pivot, lengths, line, offset, sign).expect("lengths");
    (linkage, uniform(draws, -TAU, TAU))
}

fn inverted(index: u64) -> (InvertedSliderCrank, f64) {
    let draws = &mut stream(17, index);
    let (pivots, crank) = ([random_point(draws), random_point(draws)], uniform(draws, 0.1, 6.0));
    let (h, z, sign) = (uniform(draws, -3.0, 3.0), random_point(draws), random_sign(draws));
    let linkage = InvertedSliderCrank::from_parts(pivots, crank, h, z, sign).expect("lengths");
    (linkage, uniform(draws, -TAU, TAU))
}

/// The largest coordinate or length of the random linkages.
const SCALE: f64 = 15.0;

/// Compares positions with those of the chain at a few angles; returns how many were closed.
fn agrees_with_chain<L: SliderLinkage>(linkage: &L, chain: &Chain, phi: f64) -> usize {
    let mut pose = chain.pose();
    let mut closed = 0;
    for k in 0..4 {
        let phi = phi + f64::from(k) * 1.3;
        let outcome = chain.position(phi, &mut pose);
        let Some(joints) = linkage.position(phi).joints() else {
            // Within rounding of a toggle the two may differ.
            assert!(outcome != Outcome::Closed || chain_is_flat(chain, phi), "{linkage:?} {phi} {outcome:?}");
            continue;
        };
        let (sine, _) = linkage.sine(&joints);
        if sine.abs() < SINE {
            continue;
        }
        assert_eq!(outcome, Outcome::Closed, "{linkage:?} {phi}");
        closed += 1;
        for (name, at) in [("C", joints.crank_pin), ("D", joints.slider_pin), ("P", joints.coupler_point)] {
            let Some(id) = chain.point_id(name) else { continue };
            let off = (pose.point(id).expect("closed") - at).norm();
            assert!(off <= 1e-12, "{linkage:?} {phi} {name} {off:e}");
        }
    }
    closed
}

fn chain_is_flat(chain: &Chain, phi: f64) -> bool {
    let mut motion = chain.motion();
    !matches!(chain.move_at(phi, 1.0, 0.0, &mut motion), Outcome::Closed)
}

#[test]
fn both_kinds_have_the_positions_of_their_chain() {
    let mut closed = [0; 2];
    for index in 0..LINKAGES {
        let (linkage, phi) = slider_crank(index);
        closed[0] += agrees_with_chain(&linkage, &linkage.to_chain().expect("a chain"), phi);
        let (linkage, phi) = inverted(index);
        closed[1] += agrees_with_chain(&linkage, &linkage.to_chain().expect("a chain"), phi);
    }
    assert!(closed.iter().all(|count| *count > 20_000), "{closed:?}");
}

#[test]
fn a_chain_gives_back_the_linkage_that_it_is() {
    for index in 0..1000 {
        let (linkage, phi) = slider_crank(index);
        let back = SliderCrank::from_chain(&linkage.to_chain().expect("a chain")).expect("of this form");
        let off = |p: fn(&SliderCrank) -> f64| (p(&back) - p(&linkage)).abs();
        assert!(off(|l| l.line_angle()) <= 4.0 * f64::EPSILON * TAU);
        assert_eq!(
            SliderCrankParameters { line_deg: 0.0, ..back.parameters() },
            SliderCrankParameters { line_deg: 0.0, ..linkage.parameters() }
        );
        let (linkage, _) = inverted(index);
        let chain = linkage.to_chain().expect("a chain");
        assert_eq!(InvertedSliderCrank::from_chain(&chain), Some(linkage));
        assert_eq!(SliderCrank::from_chain(&chain), None);
        // A point from D towards C, and the pin itself.
        let p = linkage_chain(index).point("P", ["D", "C"], [0.5, 0.25]);
        let seen = SliderCrank::from_chain(&p.clone().build().expect("a chain")).expect("of this form");
        let b = seen.coupler();
        assert_eq!(xy(seen.coupler_offset()), [b - 0.5, -0.25]);
        let pose = |chain: &Chain| {
            let mut pose = chain.pose();
            chain.position(phi, &mut pose).is_closed().then(|| pose.point(chain.trace()).expect("closed"))
        };
        let (one, two) = (pose(&p.build().expect("a chain")), seen.position(phi).joints());
        if let (Some(one), Some(two)) = (one, two) {
            assert!((one - two.coupler_point).norm() <= 1e-9, "{one} {two:?}");
        }
        let pin = SliderCrank::from_chain(&linkage_chain(index).build().expect("a chain"));
        assert_eq!(pin.map(|l| xy(l.coupler_offset())), Some([b, 0.0]));
    }
    // A dyad is no slider.
    let four_bar = ChainBuilder::new()
        .pivot("A", [0.0, 0.0])
        .pivot("B", [4.0, 0.0])
        .crank("A", "C", 1.0)
        .dyad("D", ["C", "B"], [4.0, 3.0], Plus)
        .build()
        .expect("a chain");
    assert_eq!(SliderCrank::from_chain(&four_bar), None);
    assert_eq!(InvertedSliderCrank::from_chain(&four_bar), None);
}

fn linkage_chain(index: u64) -> ChainBuilder {
    let (linkage, _) = slider_crank(index);
    let p = linkage.parameters();
    ChainBuilder::new().pivot("A", p.crank_pivot).crank("A", "C", p.crank).slider(
        "D",
        "C",
        p.coupler,
        p.line_point,
        linkage.line_angle(),
        p.assembly,
    )
}

type Dual = [Dual64; 2];

fn add([a, b]: Dual, [c, d]: Dual) -> Dual {
    [a + c, b + d]
}

fn times([a, b]: Dual, [c, d]: Dual) -> Dual {
    [a * c - b * d, a * d + b * c]
}

fn polar(length: Dual64, angle: Dual64) -> Dual {
    [length * angle.cos(), length * angle.sin()]
}

/// Derivatives of C, D, u, P and the slider's place by dual numbers, through angles.
fn parts([c, d, u, p]: [Dual; 4], place: Dual64) -> [f64; 9] {
    let [c, d, u, p] = [c, d, u, p].map(|[x, y]| [x.eps, y.eps]);
    [c[0], c[1], d[0], d[1], u[0], u[1], p[0], p[1], place.eps]
}

/// Ax, Ay, a, b, Qx, Qy, line, Zx, Zy, phi: the coupler's angle is line + asin(-h) or line + pi - asin(-h).
fn slider_by_angles(x: [Dual64; 10], sign: AssemblyMode) -> [f64; 9] {
    let [ax, ay, a, b, qx, qy, line, zx, zy, phi] = x;
    let c = add([ax, ay], polar(a, phi));
    let h = ((c[1] - qy) * line.cos() - (c[0] - qx) * line.sin()) / b;
    let tilt = -h.asin();
    let psi = if sign == Plus { line + tilt } else { line - tilt + PI };
    let u = polar(Dual64::from(1.0), psi);
    let d = add(c, polar(b, psi));
    let place = (d[0] - qx) * line.cos() + (d[1] - qy) * line.sin();
    parts([c, d, u, add(c, times([zx, zy], u))], place)
}

/// Ax, Ay, Bx, By, a, h, Zx, Zy, phi: the coupler's angle is arg V - asin(h/|V|) or arg V - pi + asin(h/|V|).
fn inverted_by_angles(x: [Dual64; 9], sign: AssemblyMode) -> [f64; 9] {
    let [ax, ay, bx, by, a, h, zx, zy, phi] = x;
    let c = add([ax, ay], polar(a, phi));
    let v = [bx - c[0], by - c[1]];
    let distance = (v[0] * v[0] + v[1] * v[1]).sqrt();
    let tilt = (h / distance).asin();
    let psi = if sign == Plus { v[1].atan2(v[0]) - tilt } else { v[1].atan2(v[0]) + tilt - PI };
    let u = polar(Dual64::from(1.0), psi);
    let along = v[0] * u[0] + v[1] * u[1];
    parts([c, add(c, polar(along, psi)), u, add(c, times([zx, zy], u))], along)
}

fn columns<const N: usize>(
    values: [f64; N],
    of: impl Fn([Dual64; N]) -> [f64; 9],
) -> impl Iterator<Item = [f64; 9]> {
    (0..N).map(move |k| of(std::array::from_fn(|i| Dual64::new(values[i], if i == k { 1.0 } else { 0.0 }))))
}

#[test]
fn gradients_are_those_of_dual_numbers() {
    let mut compared = [0; 2];
    let flat = |column: linkwright::internals::mechanism::slider::SliderColumn| {
        let [c, d, u, p] =
            [column.crank_pin, column.slider_pin, column.coupler, column.coupler_point].map(xy);
        [c[0], c[1], d[0], d[1], u[0], u[1], p[0], p[1], column.place]
    };
    let same = |got: &[[f64; 9]], wanted: Vec<[f64; 9]>, sine: f64| {
        assert_eq!(got.len(), wanted.len());
        let largest = wanted.as_flattened().iter().fold(1.0_f64, |most, x| most.max(x.abs()));
        for (k, (got, wanted)) in got.iter().zip(&wanted).enumerate() {
            for (got, wanted) in got.iter().zip(wanted) {
                let slack = 1e-12 * largest / (sine * sine);
                assert!((got - wanted).abs() <= slack, "column {k}: {got} for {wanted}, sine {sine}");
            }
        }
    };
    for index in 0..LINKAGES {
        let (linkage, phi) = slider_crank(index);
        if let Some(joints) = linkage.position(phi).joints().filter(|j| linkage.sine(j).0.abs() > SINE) {
            let (shape, angle) = linkage.gradient(phi).expect("not at a toggle");
            let got: Vec<[f64; 9]> = shape.into_iter().chain([angle]).map(flat).collect();
            let p = linkage.parameters();
            let ([ax, ay], [qx, qy]) = (p.crank_pivot, p.line_point);
            let (line, z) = (linkage.line_angle(), [p.coupler_x, p.coupler_y]);
            let values = [ax, ay, p.crank, p.coupler, qx, qy, line, z[0], z[1], phi];
            let wanted = columns(values, |x| slider_by_angles(x, p.assembly)).collect();
            same(&got, wanted, linkage.sine(&joints).0);
            compared[0] += 1;
        }
        let (linkage, phi) = inverted(index);
        if let Some(joints) = linkage.position(phi).joints().filter(|j| linkage.sine(j).0.abs() > SINE) {
            let (shape, angle) = linkage.gradient(phi).expect("not at a toggle");
            let got: Vec<[f64; 9]> = shape.into_iter().chain([angle]).map(flat).collect();
            let p = linkage.parameters();
            let ([ax, ay], [bx, by]) = (p.crank_pivot, p.block_pivot);
            let values = [ax, ay, bx, by, p.crank, p.offset, p.coupler_x, p.coupler_y, phi];
            let wanted = columns(values, |x| inverted_by_angles(x, p.assembly)).collect();
            same(&got, wanted, linkage.sine(&joints).0);
            compared[1] += 1;
        }
    }
    assert!(compared.iter().all(|count| *count > 5_000), "{compared:?}");
}

/// Compares the motion with central differences of the position along phi(t) = phi + omega t + alpha t^2/2.
fn moves_as_positions_do<L: SliderLinkage>(linkage: &L, phi: f64) -> bool {
    let input = CrankMotion { speed_rad_s: 1.7, acceleration_rad_s2: -0.9 };
    let Some(at) = motion(linkage, phi, input).definite() else { return false };
    if linkage.sine(&at.joints).0.abs() < 0.2 {
        return false;
    }
    let step = 1e-4;
    let when = |t: f64| {
        linkage.position(phi + input.speed_rad_s * t + 0.5 * input.acceleration_rad_s2 * t * t).joints()
    };
    let (Some(before), Some(after)) = (when(-step), when(step)) else { return false };
    let turn = |one: Complex, other: Complex| cross(one, other).atan2(dot(one, other));
    let (mid, rates) = (at.joints, at.rates);
    let speed = |x: f64, y: f64| (y - x) / (2.0 * step);
    let bend = |x: f64, m: f64, y: f64| (y - 2.0 * m + x) / (step * step);
    let mut pairs = vec![
        (rates.sliding.speed, speed(before.place, after.place)),
        (rates.sliding.acceleration, bend(before.place, mid.place, after.place)),
        (rates.coupler.speed_rad_s, turn(before.coupler, after.coupler) / (2.0 * step)),
        (
            rates.coupler.acceleration_rad_s2,
            (turn(mid.coupler, after.coupler) + turn(mid.coupler, before.coupler)) / (step * step),
        ),
    ];
    let points = [
        (at.crank_pin, before.crank_pin, mid.crank_pin, after.crank_pin),
        (rates.slider_pin, before.slider_pin, mid.slider_pin, after.slider_pin),
        (at.coupler_point, before.coupler_point, mid.coupler_point, after.coupler_point),
    ];
    for (at, before, mid, after) in points {
        for part in [|z: Complex| z.re, |z: Complex| z.im] {
            pairs.push((part(at.velocity), speed(part(before), part(after))));
            pairs.push((part(at.acceleration), bend(part(before), part(mid), part(after))));
        }
    }
    let largest = pairs.iter().fold(1.0_f64, |most, (x, _)| most.max(x.abs()));
    for (k, (got, wanted)) in pairs.into_iter().enumerate() {
        // The fourth derivative grows with the fifth power of 1/sine = 5 at most; rounding gives 1e-7.
        let slack = 1e-5 * largest.powi(3);
        assert!((got - wanted).abs() <= slack, "{linkage:?} {phi} {k}: {got} {wanted}");
    }
    true
}

#[test]
fn velocities_and_accelerations_are_differences_of_positions() {
    let of_sliders = (0..2000)
        .filter(|i| {
            let (l, phi) = slider_crank(*i);
            moves_as_positions_do(&l, phi)
        })
        .count();
    let of_inverted = (0..2000)
        .filter(|i| {
            let (l, phi) = inverted(*i);
            moves_as_positions_do(&l, phi)
        })
        .count();
    assert!(of_sliders > 900 && of_inverted > 900, "{of_sliders} {of_inverted}");
}

/// Compares velocities and accelerations of C, D and P with those of the chain.
fn moves_as_chain_does<L: SliderLinkage>(linkage: &L, chain: &Chain, phi: f64) -> bool {
    let input = CrankMotion { speed_rad_s: -2.1, acceleration_rad_s2: 0.6 };
    let Some(at) = motion(linkage, phi, input).definite() else { return false };
    let sine = linkage.sine(&at.joints).0.abs();
    if sine < SINE {
        return false;
    }
    let mut moved = chain.motion();
    assert_eq!(chain.move_at(phi, -2.1, 0.6, &mut moved), Outcome::Closed);
    let points = [("C", at.crank_pin), ("D", at.rates.slider_pin), ("P", at.coupler_point)];
    let largest = points.iter().fold(1.0_f64, |most, (_, p)| most.max(p.acceleration.norm()));
    for (name, point) in points {
        let Some(id) = chain.point_id(name) else { continue };
        let (v, a) = (moved.velocity(id).expect("moving"), moved.acceleration(id).expect("moving"));
        let slack = 1e-12 * largest * SCALE / (sine * sine);
        assert!((v - point.velocity).norm() <= slack, "{linkage:?} {phi} {name} {v} {point:?}");
        assert!((a - point.acceleration).norm() <= slack, "{linkage:?} {phi} {name} {a} {point:?}");
    }
    true
}

#[test]
fn both_kinds_move_as_their_chain_does() {
    let mut moved = [0; 2];
    for index in 0..LINKAGES {
        let (linkage, phi) = slider_crank(index);
        moved[0] += usize::from(moves_as_chain_does(&linkage, &linkage.to_chain().expect("a chain"), phi));
        let (linkage, phi) = inverted(index);
        moved[1] += usize::from(moves_as_chain_does(&linkage, &linkage.to_chain().expect("a chain"), phi));
    }
    assert!(moved.iter().all(|count| *count > 5_000), "{moved:?}");
}

/// Compares mobility with dense samples of the position, and the extremes of the transmission angle too.
fn has_its_range<L: SliderLinkage>(linkage: &L) -> (u8, u8) {
    const SAMPLES: i32 = 3600;
    let mobility = linkage.mobility();
    let inside = |phi: f64| match mobility.input {
        InputRange::Full => true,
        InputRange::None => false,
        _ => mobility.input.arcs().iter().any(|arc| arc.offset(phi).abs() <= arc.half_width),
    };
    let (mut least, mut greatest) = (f64::INFINITY, 0.0_f64);
    for i in 0..SAMPLES {
        let phi = TAU * f64::from(i) / f64::from(SAMPLES);
        let closed = linkage.position(phi).joints().is_some();
        let near_end = mobility.toggles().iter().any(|t| cross_angle(t.crank_angle, phi).abs() < 1e-6);
        assert!(closed == inside(phi) || near_end, "{linkage:?} {phi} {mobility:?}");
        if let Some(mu) = linkage.transmission_angle(phi) {
            let sine = linkage.sine(&linkage.position(phi).joints().expect("closed")).0.abs();
            assert!((mu.sin() - sine).abs() <= 1e-7, "{linkage:?} {phi} {mu} {sine}");
            (least, greatest) = (least.min(mu), greatest.max(mu));
        }
    }
    match linkage.transmission_over_range() {
        None => assert_eq!(mobility.circuits(), 0),
        Some(extremes) => {
            assert!(extremes.min <= least + 1e-9 && extremes.max >= greatest - 1e-9, "{linkage:?}");
            // The samples come within a step of the extremes; where mu falls as a root, within that of a step.
            assert!(extremes.max <= greatest + 0.1 || least.is_infinite(), "{linkage:?} {extremes:?}");
        }
    }
    for toggle in mobility.toggles() {
        // Inside the range, close to its end, mu is small; both signs give all but one position.
        let mu = {
            let (sin, cos) = toggle.crank_angle.sin_cos();
            linkage.transmission_toward(Complex::new(cos, sin))
        };
        assert!(mu < 1e-6, "{linkage:?} {toggle:?} {mu}");
        let at = |by: f64| {
            [Plus, Minus].map(|sign| linkage.position_with(toggle.crank_angle + by, sign).joints().is_some())
        };
        let closed = [1e-7, -1e-7].map(at);
        assert!(
            closed.contains(&[true; 2]) && closed.contains(&[false; 2]),
            "{linkage:?} {toggle:?} {closed:?}"
        );
    }
    (mobility.circuits(), mobility.branches_per_circuit())
}

fn cross_angle(one: f64, other: f64) -> f64 {
    (one - other).sin().atan2((one - other).cos())
}

#[test]
fn the_range_of_the_crank_is_that_of_dense_samples() {
    let mut seen = [[0; 5]; 2];
    for index in 0..600 {
        let found = [has_its_range(&slider_crank(index).0), has_its_range(&inverted(index).0)];
        for (seen, (circuits, branches)) in seen.iter_mut().zip(found) {
            seen[usize::from(2 * circuits.min(2)).min(4) - usize::from(branches == 2 && circuits == 2)] += 1;
        }
    }
    // None; one circuit of two branches; two of two; two of one.
    let [sliders, inverted] = seen;
    assert!([0, 2, 3, 4].iter().all(|i| sliders[*i] > 10), "{sliders:?}");
    assert!([2, 4].iter().all(|i| inverted[*i] > 10), "{inverted:?}");
    assert!(inverted[0] > 0 && inverted[3] == 0, "{inverted:?}");
}

#[test]
fn a_change_point_has_one_circuit_of_two_branches() {
    let line = (Complex::new(0.0, 0.0), 0.0);
    let z = Complex::new(1.0, 1.0);
    let isosceles = SliderCrank::from_parts(Complex::new(0.0, 0.0), [2.0, 2.0], line, z, Plus).expect("one");
    let through_b =
        InvertedSliderCrank::from_parts([Complex::new(0.0, 0.0), Complex::new(2.0, 0.0)], 2.0, 0.0, z, Plus)
            .expect("one");
    for mobility in [isosceles.mobility(), through_b.mobility()] {
        assert!(mobility.input_turns_fully() && mobility.change_point);
        assert_eq!((mobility.circuits(), mobility.branches_per_circuit()), (1, 2));
    }
    assert_eq!(through_b.position(0.0), SliderPosition::Undetermined);
    assert!(matches!(motion(&through_b, 0.0, CrankMotion::steady(1.0)), SliderMotion::Undetermined));
    let toggle = motion(&isosceles, 0.5 * PI, CrankMotion::steady(1.0));
    assert!(matches!(toggle, SliderMotion::Singular(_)), "{toggle:?}");
    let apart =
        InvertedSliderCrank::from_parts([Complex::new(0.0, 0.0), Complex::new(2.0, 0.0)], 2.0, 0.5, z, Plus)
            .expect("one");
    assert_eq!(apart.position(0.0), SliderPosition::Open);
    assert_eq!(apart.mobility().circuits(), 1);
}

#[test]
fn many_positions_have_the_digits_of_each_alone() {
    fn check<L: SliderLinkage>(linkage: &L) {
        let mut angles: Vec<f64> = (0..101).map(|i| 0.07 * f64::from(i) - 3.0).collect();
        angles.extend([f64::NAN, f64::INFINITY, 1e300]);
        let mut columns = [(); 3].map(|()| vec![[0.0; 2]; angles.len()]);
        let [c, d, p] = &mut columns;
        linkage.positions(&angles, JointColumns { crank_pin: c, follower_pin: d, coupler_point: p });
        for (i, angle) in angles.iter().enumerate() {
            let got = columns.each_ref().map(|column| column[i]);
            match linkage.position(*angle).joints() {
                Some(at) => {
                    assert_eq!(got, [at.crank_pin, at.slider_pin, at.coupler_point].map(xy), "{linkage:?}");
                }
                None => assert!(got.iter().flatten().all(|x| x.is_nan()), "{linkage:?} {angle}"),
            }
        }
    }
    for index in 0..200 {
        check(&slider_crank(index).0);
        check(&inverted(index).0);
    }
}

#[test]
fn the_coupler_curve_of_a_circuit_passes_its_own_points() {
    fn check<L: SliderLinkage>(linkage: &L) {
        let mobility = linkage.mobility();
        if mobility.circuits() == 0 {
            return;
        }
        let start = mobility.arc(Circuit { index: 0 }).map_or(0.3, |arc| arc.middle);
        let curve = CouplerCurve::through(linkage, start, linkage.assembly(), 720);
        for i in 0..10 {
            let tau = 0.6 * f64::from(i) + 0.123;
            let Some(point) = curve.point_at(tau) else { continue };
            let distance = curve.nearest(point).expect("a curve").distance;
            assert!(distance <= 1e-9, "{linkage:?} {tau} {distance:e}");
        }
    }
    for index in 0..200 {
        check(&slider_crank(index).0);
        check(&inverted(index).0);
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    let good = SliderCrankParameters {
        crank_pivot: [0.0, 0.0],
        crank: 2.0,
        coupler: 5.0,
        line_point: [0.0, 1.0],
        line_deg: 0.0,
        coupler_x: 5.0,
        coupler_y: 1.0,
        assembly: Plus,
    };
    assert!(SliderCrank::new(good).is_ok());
    let key = |parameters| match SliderCrank::new(parameters) {
        Err(LinkageError::NotFinite { key, .. } | LinkageError::LengthNotPositive { key, .. }) => key,
        other => panic!("{other:?}"),
    };
    assert_eq!(key(SliderCrankParameters { crank: 0.0, ..good }), "a");
    assert_eq!(key(SliderCrankParameters { coupler: -1.0, ..good }), "b");
    assert_eq!(key(SliderCrankParameters { line_deg: f64::NAN, ..good }), "line_deg");
    assert_eq!(key(SliderCrankParameters { line_point: [1e13, 0.0], ..good }), "line_point");
    assert_eq!(key(SliderCrankParameters { coupler_y: f64::INFINITY, ..good }), "coupler_y");
    let good = InvertedSliderCrankParameters {
        crank_pivot: [0.0, 0.0],
        block_pivot: [4.0, 1.0],
        crank: 2.0,
        offset: 0.5,
        coupler_x: 5.0,
        coupler_y: 1.0,
        assembly: Plus,
    };
    assert!(InvertedSliderCrank::new(good).is_ok());
    let key = |parameters| match InvertedSliderCrank::new(parameters) {
        Err(LinkageError::NotFinite { key, .. } | LinkageError::LengthNotPositive { key, .. }) => key,
        other => panic!("{other:?}"),
    };
    assert_eq!(key(InvertedSliderCrankParameters { crank: 0.0, ..good }), "a");
    assert_eq!(key(InvertedSliderCrankParameters { offset: f64::NAN, ..good }), "offset");
    assert_eq!(key(InvertedSliderCrankParameters { block_pivot: [0.0, 1e13], ..good }), "B");
    // Records and requests carry the same keys, checked in the same way.
    let text = serde_json::to_string(&InvertedSliderCrank::new(good).expect("good")).expect("JSON");
    assert_eq!(serde_json::from_str::<InvertedSliderCrank>(&text).expect("it reads").parameters(), good);
    assert!(serde_json::from_str::<InvertedSliderCrank>(&text.replace("\"a\":2.0", "\"a\":-2.0")).is_err());
}

#[test]
fn the_smallest_and_the_largest_numbers_give_no_false_position() {
    let z = Complex::new(1.0, 0.0);
    for scale in [1e-320, 1e-300, 1e-150, 1e11] {
        let line = (Complex::new(0.0, 0.3 * scale), 0.4);
        let linkage =
            SliderCrank::from_parts(Complex::new(0.0, 0.0), [scale, 2.0 * scale], line, z * scale, Plus);
        let linkage = linkage.expect("lengths");
        for i in 0..12 {
            if let SliderPosition::Closed(joints) = linkage.position(f64::from(i)) {
                assert!((joints.coupler.norm() - 1.0).abs() < 1e-9, "{scale:e} {joints:?}");
            }
        }
        let pivots = [Complex::new(0.0, 0.0), Complex::new(3.0 * scale, 0.0)];
        let linkage = InvertedSliderCrank::from_parts(pivots, scale, 0.3 * scale, z * scale, Plus);
        let linkage = linkage.expect("lengths");
        for i in 0..12 {
            if let SliderPosition::Closed(joints) = linkage.position(f64::from(i)) {
                assert!((joints.coupler.norm() - 1.0).abs() < 1e-9, "{scale:e} {joints:?}");
            }
        }
    }
}

/// Compares what two mechanisms tell of the joints that both have, at an angle away from toggles.
fn tell_the_same(one: &dyn Mechanism, other: &dyn Mechanism, phi: f64, sine: f64) {
    let input = CrankMotion { speed_rad_s: 1.1, acceleration_rad_s2: 0.4 };
    let [at, its] = [one.motion_at(phi, input), other.motion_at(phi, input)];
    assert_eq!((at.pose.status, its.pose.status), (Status::Ok, Status::Ok), "{}", one.kind());
    assert_eq!(one.pose_at(phi).joints, at.pose.joints);
    let names = other.joint_names();
    let largest = its.accelerations.iter().flatten().fold(1.0_f64, |most, a| most.max(a.norm()));
    let slack = 1e-12 * largest * SCALE / (sine * sine);
    for (i, name) in one.joint_names().into_iter().enumerate() {
        let Some(j) = names.iter().position(|n| *n == name) else { continue };
        let pairs = [
            (&at.pose.joints, &its.pose.joints),
            (&at.velocities, &its.velocities),
            (&at.accelerations, &its.accelerations),
        ];
        for (k, (here, there)) in pairs.into_iter().enumerate() {
            let off = (here[i].expect("known") - there[j].expect("known")).norm();
            assert!(off <= slack, "{} {phi} {name} {k}: {off:e}", one.kind());
        }
    }
    let (mine, its) = (one.crank_range(), other.crank_range());
    let wide = mine.arcs.iter().all(|[from, to]| to - from > 0.05);
    if !wide || mine.margin.is_some_and(|margin| margin.abs() < 0.05) {
        return;
    }
    assert_eq!(mine.turns_fully, its.turns_fully, "{}", one.kind());
    let mut ends = its.arcs.as_flattened().iter();
    assert!(mine.arcs.len() == its.arcs.len(), "{mine:?} {its:?}");
    for end in mine.arcs.as_flattened() {
        assert!(ends.clone().any(|e| cross_angle(*e, *end).abs() < 1e-5), "{mine:?} {its:?}");
    }
    assert!(ends.all(|e| mine.toggles.iter().any(|t| cross_angle(*e, *t).abs() < 1e-5)), "{mine:?} {its:?}");
}

#[test]
fn every_kind_tells_what_its_chain_tells() {
    let mut compared = [0; 2];
    for index in 0..400 {
        let (linkage, phi) = slider_crank(index);
        let chain = linkage.to_chain().expect("a chain");
        let sine = |joints| linkage.sine(&joints).0.abs();
        if let Some(sine) = linkage.position(phi).joints().map(sine).filter(|sine| *sine > SINE) {
            let linkage = Linkage::SliderCrank(linkage);
            tell_the_same(linkage.mechanism(), Linkage::Chain(Box::new(chain)).mechanism(), phi, sine);
            compared[0] += 1;
        }
        let (linkage, phi) = inverted(index);
        let chain = linkage.to_chain().expect("a chain");
        let sine = |joints| linkage.sine(&joints).0.abs();
        if let Some(sine) = linkage.position(phi).joints().map(sine).filter(|sine| *sine > SINE) {
            let linkage = Linkage::InvertedSliderCrank(linkage);
            tell_the_same(linkage.mechanism(), Linkage::Chain(Box::new(chain)).mechanism(), phi, sine);
            compared[1] += 1;
        }
    }
    assert!(compared.iter().all(|count| *count > 200), "{compared:?}");
    let four_bar = FourBar::with_coupler_offset(
        [Complex::new(0.0, 0.0), Complex::new(4.0, 1.0)],
        [2.0, 5.0, 5.0],
        Complex::new(2.5, 4.0),
        Plus,
    )
    .expect("lengths");
    let chain = ChainBuilder::new()
        .pivot("A", [0.0, 0.0])
        .pivot("B", [4.0, 1.0])
        .crank("A", "C", 2.0)
        .dyad("D", ["C", "B"], [5.0, 5.0], Plus)
        .point("P", ["C", "D"], [2.5, 4.0])
        .build()
        .expect("a chain");
    for i in 0..36 {
        let (one, other) = (Linkage::FourBar(four_bar), Linkage::Chain(Box::new(chain.clone())));
        tell_the_same(one.mechanism(), other.mechanism(), f64::from(i) * 0.17, 0.5);
    }
    assert_eq!(Mechanism::moving_links(&four_bar).len(), 3);
    assert_eq!(chain.moving_links()[0].length, Some(2.0));
}
