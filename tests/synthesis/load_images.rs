//! Loads of a problem in other places, sizes and senses, and as they are recorded.

use linkwright::internals::mechanism::loads::{
    BodyMass, Couple, CrankSpeed, Force, ForceVector, Loads, Mass, Place, Quantity, Spring,
};
use linkwright::internals::mechanism::{AssemblyMode, Complex, FourBar};
use linkwright::internals::task::loads::LoadsSpec;
use linkwright::internals::task::similarity::Similarity;

const GROUND: &str = "ground";

fn loads() -> Loads {
    let mass = |body: &str, mass| BodyMass { body: body.into(), mass };
    let row = |angle: f64, x: f64| (angle, [x]);
    Loads {
        gravity: [0.5, -9.81],
        speed_rad_s: Some(CrankSpeed::Steady(7.0)),
        bodies: vec![
            mass("crank", Mass::Given { mass_kg: 0.3, center: [0.02, 0.01], inertia_kg_m2: 1e-4 }),
            mass("coupler", Mass::AtJoint { mass_kg: 1.0, joint: "P".into(), inertia_kg_m2: 2e-4 }),
        ],
        forces: vec![
            Force {
                at: Place::Joint("P".into()),
                body: None,
                vector: ForceVector::Vector(Quantity::Constant([3.0, -2.0]), None),
            },
            Force {
                at: Place::OnBody("follower".into(), [0.01, 0.02]),
                body: None,
                vector: ForceVector::Vector(Quantity::Constant([1.0, 2.0]), Some("coupler".into())),
            },
            Force {
                at: Place::Joint("D".into()),
                body: None,
                vector: ForceVector::Opposing(Quantity::Constant([4.0])),
            },
        ],
        couples: vec![Couple {
            body: "follower".into(),
            moment: Quantity::Table(vec![row(0.1, 0.2), row(2.0, 0.5), row(4.0, -0.3)]),
        }],
        springs: vec![
            Spring::Extension {
                ends: [Place::Joint("D".into()), Place::Fixed([0.05, 0.09])],
                rate: 300.0,
                free_length: 0.02,
            },
            Spring::Torsion { bodies: ["follower".into(), GROUND.into()], rate: 0.05, free_angle: 1.2 },
            Spring::Torsion { bodies: [GROUND.into(), "coupler".into()], rate: 0.02, free_angle: 0.3 },
        ],
    }
}

#[test]
fn the_torque_of_an_image_is_that_of_the_linkage_with_the_sense_of_its_image() {
    images_have_its_torque(loads());
    let table = CrankSpeed::Table(vec![(0.4, -7.0), (1.9, -9.0), (3.0, -6.5)]);
    images_have_its_torque(Loads { speed_rad_s: Some(table), ..loads() });
}

fn images_have_its_torque(applied: Loads) {
    let four_bar = |a: [f64; 2], b: [f64; 2], y: f64, assembly| {
        let pivots = [Complex::new(a[0], a[1]), Complex::new(b[0], b[1])];
        FourBar::with_coupler_offset(pivots, [2.0, 5.0, 5.5], Complex::new(3.0, y), assembly)
    };
    let spec = LoadsSpec { metres: 0.01, applied: applied.clone() };
    let ([a, b], y) = ([[0.5, -0.3], [4.5, 1.0]], 2.0);
    let own = four_bar(a, b, y, AssemblyMode::Plus).expect("a linkage");
    let own = spec.on(&own.into()).expect("its names are known");
    for (mirrors, turns) in (0..8).map(|i| (i > 3, i % 4)) {
        let by = Similarity { from: [1.0, 2.0], mirrors, turns, scale: 1.0, to: [-3.0, 0.5] };
        let assembly = if mirrors { AssemblyMode::Minus } else { AssemblyMode::Plus };
        let y = if mirrors { -y } else { y };
        let image = four_bar(by.point(a), by.point(b), y, assembly).expect("a linkage");
        let placed = spec.placed(&by);
        let image = placed.on(&image.into()).expect("its names are known");
        for i in 0..40 {
            let angle = 0.157 * f64::from(i);
            let there = by.degrees(angle.to_degrees()).to_radians();
            let torque = own.torque_and_size(angle, own.drive().motion(angle), &mut own.scratch());
            let of_image = image.torque_and_size(there, image.drive().motion(there), &mut image.scratch());
            let ((torque, size), (of_image, _)) = (torque.expect("closed"), of_image.expect("closed"));
            let sign = if mirrors { -1.0 } else { 1.0 };
            assert!((torque - sign * of_image).abs() < 1e-11 * size, "{by:?} {angle}: {torque} {of_image}");
        }
    }
    let by = Similarity { scale: 4.0, ..Similarity::IDENTITY };
    assert_eq!(spec.placed(&by), LoadsSpec { metres: 0.0025, applied });
}

#[test]
fn loads_come_back_from_their_record() {
    let table = CrankSpeed::Table(vec![(0.4, 7.0), (1.9, 9.0)]);
    let spec = LoadsSpec { metres: 0.001, applied: Loads { speed_rad_s: Some(table), ..loads() } };
    let text = serde_json::to_string(&spec).expect("JSON");
    assert_eq!(serde_json::from_str::<LoadsSpec>(&text).expect("loads"), spec);
    let bad = text.replace("[3.0,-2.0]", "[3.0]");
    assert!(serde_json::from_str::<LoadsSpec>(&bad).is_err());
}
