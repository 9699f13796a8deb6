//! Closed forms, a textbook's example, and forces against a computation written here alone.

use linkwright::internals::mechanism::four_bar::motion::CrankMotion;
use linkwright::internals::mechanism::loads::{
    BodyMass, Couple, Force, ForceVector, LoadedLinkage, Loads, Mass, Place, Quantity, Spring,
};
use linkwright::internals::mechanism::{
    AssemblyMode, ChainBuilder, Complex, CouplerSide, FourBar, Linkage, NaturalCoordinates, SliderCrank,
    SliderCrankParameters, Status, Unit, cross, dot, turned,
};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::{PI, TAU};

pub(super) fn mass(body: &str, mass_kg: f64, center: [f64; 2], inertia_kg_m2: f64) -> BodyMass {
    BodyMass { body: body.to_owned(), mass: Mass::Given { mass_kg, center, inertia_kg_m2 } }
}

fn push(at: Place, force: [f64; 2]) -> Force {
    Force { at, body: None, vector: ForceVector::Vector(Quantity::Constant(force), None) }
}

/// N. N. Romero's four-bar, in cm.
pub(super) fn romero() -> FourBar {
    FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [4.0, 1.0],
        crank: 2.0,
        coupler: 5.0,
        follower: 5.0,
        crank_side: 5.0,
        follower_side: 5.0,
        assembly: AssemblyMode::Plus,
        side: CouplerSide::Plus,
    })
    .expect("lengths")
}

pub fn slider_crank(crank: f64, coupler: f64) -> Linkage {
    let parameters = SliderCrankParameters {
        crank_pivot: [0.0, 0.0],
        crank,
        coupler,
        line_point: [0.0, 0.0],
        line_deg: 0.0,
        coupler_x: coupler,
        coupler_y: 0.0,
        assembly: AssemblyMode::Plus,
    };
    Linkage::SliderCrank(SliderCrank::new(parameters).expect("lengths"))
}

#[test]
fn a_crank_that_alone_has_mass_is_a_pendulum() {
    let loads = Loads {
        gravity: [0.0, -9.81],
        bodies: vec![mass("crank", 2.0, [0.01, 0.0], 3e-4)],
        ..Loads::default()
    };
    let loaded = LoadedLinkage::new(&Linkage::FourBar(romero()), Unit::Cm, &loads).expect("names");
    let scratch = &mut loaded.scratch();
    for i in 0..24 {
        let angle = TAU * f64::from(i) / 24.0 + 0.01;
        let input = CrankMotion { speed_rad_s: 7.0, acceleration_rad_s2: 11.0 };
        let at = loaded.at(angle, input, scratch).expect("it closes");
        // T = m g r cos(phi) + (I + m r^2) alpha.
        let torque = 2.0 * 9.81 * 0.01 * angle.cos() + (3e-4 + 2.0 * 1e-4) * 11.0;
        assert!((at.torque - torque).abs() < 1e-14, "{} {torque}", at.torque);
        assert!((at.kinetic - 0.5 * 5e-4 * 49.0).abs() < 1e-15);
        // Nothing but the crank's pivot bears a load.
        assert!(at.forces[1..].iter().all(|f| f.force.is_some_and(|[x, y]| x.hypot(y) < 1e-12)));
    }
    let figures = loaded.figures(&CrankMotion::steady(7.0).into()).expect("it turns");
    assert!((figures.torque_peak.value.abs() - 0.1962).abs() < 1e-14);
    assert!((figures.torque_rms - 0.1962 / 2_f64.sqrt()).abs() < 1e-14 && figures.torque_mean.abs() < 1e-15);
    let swing = figures.fluctuation.expect("a full turn");
    // The integral of m g r cos(phi) runs from -m g r to m g r.
    assert!((swing.energy - 2.0 * 0.1962).abs() < 1e-8, "{}", swing.energy);
    assert!((swing.reflected_inertia - 5e-4).abs() < 1e-16);
    assert!((swing.coefficient.expect("it turns") - 2.0 * 0.1962 / (5e-4 * 49.0)).abs() < 1e-4);
}

#[test]
fn the_mechanical_advantage_follows_from_instant_centres() {
    let linkage = romero();
    let force = Complex::new(-3.0, -10.0);
    let loads = Loads { forces: vec![push(Place::Joint("P".into()), [-3.0, -10.0])], ..Loads::default() };
    let loaded = LoadedLinkage::new(&Linkage::FourBar(linkage), Unit::Cm, &loads).expect("names");
    let scratch = &mut loaded.scratch();
    for i in 0..48 {
        let angle = TAU * f64::from(i) / 48.0 + 0.02;
        let joints = linkage.position(angle).joints().expect("it closes");
        let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
        let (c, d, p) = (joints.crank_pin, joints.follower_pin, joints.coupler_point);
        // I, where the lines A-C and B-D meet: the coupler turns about it (Kennedy). omega3/omega2 = |AC|/|IC| with signs.
        let along = c - a;
        let centre = a + along * (cross(b - a, d - b) / cross(along, d - b));
        let ratio = dot(along, c - centre) / (c - centre).norm_sqr();
        let velocity = turned(p - centre) * ratio / 100.0;
        let torque = -dot(force, velocity);
        let at = loaded.at(angle, CrankMotion::steady(0.0), scratch).expect("it closes");
        assert!((at.torque - torque).abs() < 1e-12, "{} {torque}", at.torque);
        assert!((at.advantage.expect("P moves") * velocity.norm() - 1.0).abs() < 1e-12);
        // At the follower: omega_crank/omega_follower, both from the instant centre of crank and follower on A-B.
        let on_ground = a + (b - a) * (cross(c - a, d - c) / cross(b - a, d - c));
        let advantage = (on_ground - b).norm() / (on_ground - a).norm();
        assert!((at.output_advantage.expect("it moves") / advantage - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_piston_has_the_inertia_torque_of_the_literature() {
    // x = r cos(phi) + l cos(psi), sin(psi) = r sin(phi)/l: T = m x'' x' (omega^2), exactly; textbooks print its first terms,
    // -m r^2 omega^2/2 (r/(2 l) sin phi - sin 2 phi - 3 r/(2 l) sin 3 phi), of the opposite torque that the piston puts on the crank.
    let (r, l, m, omega) = (0.05_f64, 0.2_f64, 1.5, 100.0);
    let loads = Loads { bodies: vec![mass("block", m, [0.0, 0.0], 0.0)], ..Loads::default() };
    let loaded = LoadedLinkage::new(&slider_crank(50.0, 200.0), Unit::Mm, &loads).expect("names");
    let scratch = &mut loaded.scratch();
    for i in 0..36 {
        let angle = TAU * f64::from(i) / 36.0 + 0.013;
        let (sin, cos) = angle.sin_cos();
        let root = (l * l - r * r * sin * sin).sqrt();
        let first = -r * sin - r * r * sin * cos / root;
        let second = -r * cos
            - r * r * (cos * cos - sin * sin) / root
            - r.powi(4) * sin * sin * cos * cos / root.powi(3);
        let torque = m * first * second * omega * omega;
        let at = loaded.at(angle, CrankMotion::steady(omega), scratch).expect("it closes");
        assert!((at.torque - torque).abs() < 1e-12 * m * r * r * omega * omega, "{} {torque}", at.torque);
        let share = r / l;
        let printed = -0.5
            * m
            * r
            * r
            * omega
            * omega
            * (0.5 * share * sin - (2.0 * angle).sin() - 1.5 * share * (3.0 * angle).sin());
        assert!((at.torque - printed).abs() < share * share * m * r * r * omega * omega);
        // The rod without mass pushes along itself, and the wall bears what is across the line: N = F tan(psi).
        let wall = at.forces.iter().find_map(|f| f.normal).expect("a slider");
        let push = m * second * omega * omega;
        assert!((wall.abs() - (push * r * sin / root).abs()).abs() < 1e-9 * push.abs().max(1.0));
        assert!(at.forces.iter().find_map(|f| f.moment).expect("a slider").abs() < 1e-10);
    }
}

/// F. P. Beer, E. R. Johnston, D. Mazurek, Vector Mechanics for Engineers: Statics, 12th edition, problems 10.21 (a force of 4 kN on
/// the piston takes a couple of 121.8 N m at 30 degrees) and 10.22 (a couple of 100 N m at 60 degrees takes 2.05 kN), crank 50 mm,
/// rod 200 mm.
#[test]
fn the_engine_of_beer_and_johnston_is_held_by_its_printed_couples() {
    let torque = |force: f64, deg: f64| {
        let loads = Loads { forces: vec![push(Place::Joint("D".into()), [-force, 0.0])], ..Loads::default() };
        let loaded = LoadedLinkage::new(&slider_crank(50.0, 200.0), Unit::Mm, &loads).expect("names");
        let still = CrankMotion::steady(0.0);
        loaded.at(deg.to_radians(), still, &mut loaded.scratch()).expect("it closes").torque
    };
    assert!((torque(4000.0, 30.0).abs() - 121.8).abs() < 0.05, "{}", torque(4000.0, 30.0));
    let force = 100.0 / torque(1000.0, 60.0).abs();
    assert!((force - 2.05).abs() < 0.005, "{force}");
}

/// D. B. Marghitu, Mechanisms and Robots Analysis with MATLAB (Springer 2009), section 4.6: a slider-crank of twice 1 m at 45 degrees and
/// 1 rad/s, 1 kg each, g = 10 m/s^2, 100 N on the slider. The rod bears F12 = (-(400 + 7 sqrt 2)/4, 5 (84 + sqrt 2)/4) N from the crank.
#[test]
fn marghitus_slider_crank_has_its_printed_force() {
    let inertia = 0.083_341_7;
    let loads = Loads {
        gravity: [0.0, -10.0],
        bodies: vec![
            mass("crank", 1.0, [0.5, 0.0], inertia),
            mass("coupler", 1.0, [0.5, 0.0], inertia),
            mass("block", 1.0, [0.0, 0.0], 1.666_67e-5),
        ],
        forces: vec![push(Place::Joint("D".into()), [100.0, 0.0])],
        ..Loads::default()
    };
    let loaded = LoadedLinkage::new(&slider_crank(1.0, 1.0), Unit::M, &loads).expect("names");
    let at = loaded.at(PI / 4.0, CrankMotion::steady(1.0), &mut loaded.scratch()).expect("it closes");
    let of_pin = at.forces.iter().find(|force| force.at == "C").expect("a pin");
    assert_eq!((of_pin.on.as_str(), of_pin.from.as_str()), ("crank", "coupler"));
    let [x, y] = of_pin.force.expect("a force");
    let root = 2_f64.sqrt();
    assert!((-x + (400.0 + 7.0 * root) / 4.0).abs() < 1e-10, "{x}");
    assert!((-y - 1.25 * (84.0 + root)).abs() < 1e-10, "{y}");
}

/// R. L. Norton, Design of Machinery, example 11-3: forces and torque of a four-bar in inches, pounds and blobs (lb s^2/in). Quoted
/// from memory of the printed table (F12 = -117.65, -107.84; F43x = -1.34 lb; T12 = 243.23 lb in), as the book was not at hand; a
/// computation with the accelerations that it prints in four or five digits gives -117.66, -107.84, -1.34 and 243.27.
#[test]
fn nortons_example_has_its_printed_forces() {
    const POUND: f64 = 4.448_221_615_260_5;
    const INCH: f64 = 0.0254;
    let blob = POUND / INCH;
    let polar = |r: f64, deg: f64| Complex::from_polar(r * INCH, deg.to_radians());
    let linkage = FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [19.0, 0.0],
        crank: 5.0,
        coupler: 15.0,
        follower: 10.0,
        crank_side: 5.0,
        follower_side: 15.0,
        assembly: AssemblyMode::Plus,
        side: CouplerSide::Plus,
    })
    .expect("lengths");
    let center = |z: Complex| [z.re, z.im];
    let inertia = POUND * INCH;
    let of_coupler = polar(9.0, 45.0);
    let applied = Complex::from_polar(80.0 * POUND, 330_f64.to_radians());
    let loads = Loads {
        bodies: vec![
            mass("crank", 0.004 * blob, center(polar(3.0, 30.0)), 0.4 * inertia),
            mass("coupler", 0.020 * blob, center(of_coupler), 1.5 * inertia),
            mass("follower", 0.015 * blob, center(polar(5.0, 0.0)), 0.8 * inertia),
        ],
        forces: vec![push(
            Place::OnBody("coupler".into(), center(of_coupler + polar(3.0, 100.0))),
            center(applied),
        )],
        couples: vec![Couple { body: "follower".into(), moment: Quantity::Constant([120.0 * inertia]) }],
        ..Loads::default()
    };
    let loaded = LoadedLinkage::new(&Linkage::FourBar(linkage), Unit::In, &loads).expect("names");
    let input = CrankMotion { speed_rad_s: 25.0, acceleration_rad_s2: -40.0 };
    let at = loaded.at(60_f64.to_radians(), input, &mut loaded.scratch()).expect("it closes");
    let near = |value: f64, printed: f64| assert!((value - printed).abs() < 0.005, "{value} {printed}");
    near(at.torque / inertia, 243.23);
    // On the ground from the crank: the opposite of his F12.
    let pound = |i: usize| at.forces[i].force.expect("a pin").map(|x| x / POUND);
    near(-pound(0)[0], -117.65);
    near(-pound(0)[1], -107.84);
    // D, on the coupler from the follower: his F43.
    near(pound(3)[0], -1.34);
}

/// The joint forces of a four-bar from nine equations written out here: three of each body, about its centre of mass, with
/// accelerations by differences of positions.
#[test]
fn joint_forces_are_those_of_a_free_body_computation() {
    let linkage = romero();
    let masses = [(0.7, [0.012, -0.004], 2e-5), (1.1, [0.02, 0.015], 3e-4), (0.9, [0.03, 0.002], 1e-4)];
    let bodies = ["crank", "coupler", "follower"];
    let spring = Spring::Extension {
        ends: [Place::Joint("D".into()), Place::Fixed([0.05, 0.08])],
        rate: 400.0,
        free_length: 0.03,
    };
    let loads = Loads {
        gravity: [0.5, -9.81],
        bodies: bodies.iter().zip(masses).map(|(body, (m, at, i))| mass(body, m, at, i)).collect(),
        forces: vec![push(Place::Joint("P".into()), [4.0, -10.0])],
        couples: vec![Couple { body: "follower".into(), moment: Quantity::Constant([0.3]) }],
        springs: vec![spring],
        ..Loads::default()
    };
    let loaded = LoadedLinkage::new(&Linkage::FourBar(linkage), Unit::Cm, &loads).expect("names");
    let scratch = &mut loaded.scratch();
    let omega = 9.0;
    for i in 0..12 {
        let angle = TAU * f64::from(i) / 12.0 + 0.1;
        // [A, C, D, B, P] in metres, at an angle.
        let points = |angle: f64| {
            let joints = linkage.position(angle).joints().expect("it closes");
            let own =
                [linkage.crank_pivot(), joints.crank_pin, joints.follower_pin, linkage.follower_pivot()];
            let [a, c, d, b] = own.map(|z| z / 100.0);
            [a, c, d, b, joints.coupler_point / 100.0]
        };
        // Centre and direction of each body.
        let state = |angle: f64| {
            let [a, c, d, b, _] = points(angle);
            [(a, c), (c, d), (b, d)].map(|(from, to)| (from, (to - from) / (to - from).norm()))
        };
        let center = |body: usize, angle: f64| {
            let (from, along) = state(angle)[body];
            from + along * Complex::new(masses[body].1[0], masses[body].1[1])
        };
        let h = 1e-3;
        let second = |at: &dyn Fn(f64) -> Complex| {
            let [two, one, here, next, after] = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| at(angle + k * h));
            (-after + next * 16.0 - here * 30.0 + one * 16.0 - two) / (12.0 * h * h)
        };
        let [a, c, d, b, p] = points(angle);
        // Forces in the order A on crank, C on coupler from the crank, D on coupler from the follower, B on follower, torque.
        let (mut matrix, mut right) = (DMatrix::zeros(9, 9), DVector::zeros(9));
        let stretch = d - Complex::new(0.05, 0.08);
        let pull = -stretch * (400.0 * (stretch.norm() - 0.03) / stretch.norm());
        for body in 0..3 {
            let (m, _, inertia) = masses[body];
            let g = center(body, angle);
            let acceleration = second(&|angle| center(body, angle)) * (omega * omega);
            let turning =
                second(&|at| (state(at)[body].1 * state(angle)[body].1.conj()).ln()).im * omega * omega;
            let pins: &[(usize, Complex, f64)] = match body {
                0 => &[(0, a, 1.0), (1, c, -1.0)],
                1 => &[(1, c, 1.0), (2, d, 1.0)],
                _ => &[(2, d, -1.0), (3, b, 1.0)],
            };
            for (pin, at, sign) in pins {
                let arm = at - g;
                matrix[(3 * body, 2 * pin)] = *sign;
                matrix[(3 * body + 1, 2 * pin + 1)] = *sign;
                matrix[(3 * body + 2, 2 * pin)] = -sign * arm.im;
                matrix[(3 * body + 2, 2 * pin + 1)] = sign * arm.re;
            }
            // The spring pulls at D, on the coupler, the force at P too.
            let applied: &[(Complex, Complex)] =
                if body == 1 { &[(p, Complex::new(4.0, -10.0)), (d, pull)] } else { &[] };
            let weight = Complex::new(0.5, -9.81) * m;
            let force = acceleration * m - weight - applied.iter().map(|(_, f)| f).sum::<Complex>();
            let moment: f64 = applied.iter().map(|(at, f)| cross(at - g, *f)).sum();
            right[3 * body] = force.re;
            right[3 * body + 1] = force.im;
            right[3 * body + 2] = inertia * turning - moment - if body == 2 { 0.3 } else { 0.0 };
        }
        matrix[(2, 8)] = 1.0;
        let found = matrix.lu().solve(&right).expect("no toggle");
        let at = loaded.at(angle, CrankMotion::steady(omega), scratch).expect("it closes");
        let pins: Vec<[f64; 2]> = at.forces.iter().map(|f| f.force.expect("a pin")).collect();
        // Ours: A on the ground, C on the crank, B on the ground, D on the coupler.
        let expected = [(0, 0, -1.0), (1, 1, -1.0), (2, 3, -1.0), (3, 2, 1.0)];
        let size = found.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        for (ours, theirs, sign) in expected {
            for axis in 0..2 {
                let off = pins[ours][axis] - sign * found[2 * theirs + axis];
                assert!(off.abs() < 1e-7 * size, "{i}: {} {off}", at.forces[ours].at);
            }
        }
        assert!((at.torque - found[8]).abs() < 1e-7 * size);
        // The ground bears the pins and the spring; the sum of all outer forces is m a.
        let sum: Complex =
            [0, 2].map(|k| Complex::new(pins[k][0], pins[k][1])).iter().sum::<Complex>() - pull;
        let shaking = Complex::new(at.shaking_force[0], at.shaking_force[1]);
        assert!((sum - shaking).norm() < 1e-10 * size);
    }
}

#[test]
fn a_table_is_linear_between_its_rows_and_periodic() {
    let rows = vec![(PI / 2.0, [10.0]), (PI, [20.0]), (1.5 * PI, [0.0])];
    let couple = Couple { body: "crank".into(), moment: Quantity::Table(rows) };
    let loads = Loads { couples: vec![couple], ..Loads::default() };
    let loaded = LoadedLinkage::new(&Linkage::FourBar(romero()), Unit::Cm, &loads).expect("names");
    let scratch = &mut loaded.scratch();
    let still = CrankMotion::steady(0.0);
    for (deg, moment) in
        [(90.0, 10.0), (135.0, 15.0), (180.0, 20.0), (225.0, 10.0), (270.0, 0.0), (0.0, 5.0), (-270.0, 10.0)]
    {
        let torque = loaded.torque(f64::to_radians(deg), still, scratch).expect("it closes");
        assert!((torque + moment).abs() < 1e-12, "{deg}: {torque}");
    }
}

#[test]
fn a_toggle_has_a_status_and_no_number() {
    let linkage =
        FourBar::new(NaturalCoordinates { follower: 1.0, coupler: 2.0, ..romero().natural_coordinates() });
    let Ok(linkage) = linkage else { panic!("a linkage") };
    let any = Linkage::FourBar(linkage);
    let loads = Loads { forces: vec![push(Place::Joint("P".into()), [0.0, -10.0])], ..Loads::default() };
    let loaded = LoadedLinkage::new(&any, Unit::Cm, &loads).expect("names");
    let scratch = &mut loaded.scratch();
    let still = CrankMotion::steady(0.0);
    for toggle in linkage.mobility().toggles() {
        assert_eq!(loaded.at(toggle.crank_angle, still, scratch).unwrap_err(), Status::Singular);
        assert_eq!(loaded.torque(toggle.crank_angle, still, scratch).unwrap_err(), Status::Singular);
    }
    assert_eq!(loaded.torque(PI, still, scratch).unwrap_err(), Status::Open);
    let figures = loaded.figures(&still.into()).expect("it closes somewhere");
    assert!(!figures.full_turn && figures.arcs_deg.len() == 1 && figures.fluctuation.is_none());
    assert!(figures.torque_peak.value.is_finite());
}

#[test]
fn a_plate_has_the_mass_of_its_outline() {
    let plate = Mass::Plate { density_kg_m3: 7850.0, thickness: 0.003, width: 0.02 };
    let bodies = vec![BodyMass { body: "crank".into(), mass: plate.clone() }];
    let loads = Loads { gravity: [0.0, -9.81], bodies, ..Loads::default() };
    let loaded = LoadedLinkage::new(&slider_crank(50.0, 200.0), Unit::Mm, &loads).expect("names");
    // A stadium 50 mm long and 20 mm wide: its centre is in its middle.
    let area = 0.05 * 0.02 + PI * 0.01 * 0.01;
    let torque = loaded.torque(0.0, CrankMotion::steady(0.0), &mut loaded.scratch()).expect("it closes");
    assert!((torque / (7850.0 * 0.003 * area * 9.81 * 0.025) - 1.0).abs() < 1e-12);
    let bodies = vec![BodyMass { body: "block".into(), mass: plate }];
    let refused =
        LoadedLinkage::new(&slider_crank(50.0, 200.0), Unit::Mm, &Loads { bodies, ..Loads::default() });
    let words = refused.expect_err("a block has no outline").to_string();
    assert!(words.contains("the outline of block does not follow from its joints"), "{words}");
}

#[test]
fn a_chain_bears_its_loads_as_the_same_slider_crank_does() {
    let chain = ChainBuilder::new()
        .pivot("A", [0.0, 0.0])
        .crank("A", "C", 50.0)
        .slider("D", "C", 200.0, [0.0, 0.0], 0.0, AssemblyMode::Plus)
        .build()
        .expect("a chain");
    let of = |crank: &str, coupler: &str, block: &str| Loads {
        gravity: [0.3, -9.81],
        bodies: vec![
            mass(crank, 0.5, [0.02, 0.004], 1e-4),
            mass(coupler, 0.9, [0.08, -0.01], 2e-3),
            mass(block, 0.4, [0.01, 0.02], 3e-4),
        ],
        forces: vec![push(Place::Joint("D".into()), [-20.0, 5.0])],
        couples: vec![Couple { body: coupler.into(), moment: Quantity::Constant([0.2]) }],
        ..Loads::default()
    };
    let one = LoadedLinkage::new(&slider_crank(50.0, 200.0), Unit::Mm, &of("crank", "coupler", "block"));
    let two = LoadedLinkage::new(&Linkage::Chain(Box::new(chain)), Unit::Mm, &of("A-C", "C-D", "block-D"));
    let (one, two) = (one.expect("names"), two.expect("names"));
    let (first, second) = (&mut one.scratch(), &mut two.scratch());
    for i in 0..24 {
        let (angle, input) =
            (TAU * f64::from(i) / 24.0, CrankMotion { speed_rad_s: 20.0, acceleration_rad_s2: -7.0 });
        one.balance(angle, input, first).expect("it closes");
        two.balance(angle, input, second).expect("it closes");
        assert!((first.torque() - second.torque()).abs() < 1e-11);
        for (a, b) in first.reactions().iter().flatten().zip(second.reactions().iter().flatten()) {
            assert!((a - b).abs() < 1e-10, "{a} {b}");
        }
    }
}
