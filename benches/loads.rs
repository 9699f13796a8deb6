//! Loads of a six-bar: torque and all joint forces at 3,600 crank angles, and the figures over a turn. Torques by power balance and
//! by Newton-Euler are asserted to agree before they are timed. The spring that balances an arm over 90 degrees is asserted to be the
//! textbook's.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use linkwright::analysis::CrankMotion;
use linkwright::internals::files::linkage_file;
use linkwright::internals::mechanism::loads::balance::{SpringEnds, SpringRequest, balance_by_spring};
use linkwright::internals::mechanism::loads::{
    BodyMass, Force, ForceVector, LoadedLinkage, Loads, Mass, Place, Quantity, Spring,
};
use linkwright::internals::mechanism::{
    AssemblyMode, CouplerSide, FourBar, Linkage, NaturalCoordinates, Unit,
};
use std::f64::consts::TAU;
use std::hint::black_box;
use std::path::Path;

const POSITIONS: usize = 3600;

fn loads(c: &mut Criterion) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/linkages/watt-six-bar.toml");
    let linkage = linkage_file::load_any(&path).expect("it is shipped").linkage;
    let mechanism = linkage.mechanism();
    let (structure, joints) = (mechanism.structure(), mechanism.joint_names());
    let traced = joints[mechanism.traced()].to_owned();
    let mass = Mass::Given { mass_kg: 0.3, center: [0.02, 0.005], inertia_kg_m2: 1e-4 };
    let of_body = |name: &String| BodyMass { body: name.clone(), mass: mass.clone() };
    let push = ForceVector::Vector(Quantity::Constant([0.0, -10.0]), None);
    let ends = [Place::Joint(traced.clone()), Place::Fixed([0.1, 0.2])];
    let loads = Loads {
        gravity: [0.0, -9.81],
        bodies: structure.bodies.iter().skip(1).map(|body| of_body(&body.name)).collect(),
        forces: vec![Force { at: Place::Joint(traced), body: None, vector: push }],
        springs: vec![Spring::Extension { ends, rate: 400.0, free_length: 0.03 }],
        ..Loads::default()
    };
    let loaded = LoadedLinkage::new(&linkage, Unit::Cm, &loads).expect("its names are known");
    let scratch = &mut loaded.scratch();
    let input = CrankMotion::steady(10.0);
    let angles: Vec<f64> = (0..POSITIONS).map(|i| TAU * i as f64 / POSITIONS as f64).collect();
    let mut closed = 0;
    for angle in &angles {
        let Ok((power, size)) = loaded.torque_and_size(*angle, input, scratch) else { continue };
        loaded.balance(*angle, input, scratch).expect("it closes");
        assert!((scratch.torque() - power).abs() <= 1e-10 * size, "{angle}: {power}");
        closed += 1;
    }
    assert!(closed > POSITIONS / 2, "{closed}");

    let mut group = c.benchmark_group("loads of a six-bar");
    group.throughput(Throughput::Elements(POSITIONS as u64));
    group.bench_function("3,600 angles, all joint forces", |b| {
        b.iter(|| {
            let mut sum = 0.0;
            for angle in &angles {
                if loaded.balance(black_box(*angle), input, scratch).is_ok() {
                    sum += scratch.torque();
                }
            }
            sum
        });
    });
    group.bench_function("3,600 angles, torque alone", |b| {
        b.iter(|| {
            let torque = |angle: &f64| loaded.torque(black_box(*angle), input, scratch).unwrap_or_default();
            angles.iter().map(torque).sum::<f64>()
        });
    });
    group.finish();
    c.bench_function("figures of a six-bar over a turn", |b| {
        b.iter(|| black_box(&loaded).figures(&input.into()))
    });
}

/// An arm of 300 mm with 1 kg at its end, as the crank of a four-bar, in a spring between its middle and a point 120 mm above its pivot:
/// k a b = m g r.
fn balance(c: &mut Criterion) {
    let linkage = FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [500.0, 0.0],
        crank: 300.0,
        coupler: 520.0,
        follower: 400.0,
        crank_side: 100.0,
        follower_side: 450.0,
        assembly: AssemblyMode::Plus,
        side: CouplerSide::Plus,
    });
    let linkage = Linkage::FourBar(linkage.expect("lengths"));
    let mass = Mass::Given { mass_kg: 1.0, center: [0.3, 0.0], inertia_kg_m2: 0.0 };
    let bodies = vec![BodyMass { body: "crank".into(), mass }];
    let loads = Loads { gravity: [0.0, -9.81], bodies, ..Loads::default() };
    let request = SpringRequest {
        ends: SpringEnds::Places([Place::OnBody("crank".into(), [0.15, 0.0]), Place::Fixed([0.0, 0.12])]),
        range: [-20.0, 70.0].map(f64::to_radians),
        rates: Vec::new(),
        least_free_length: 0.0,
    };
    let spring = || balance_by_spring(&linkage, Unit::Mm, &loads, &request).expect("a spring");
    let Spring::Extension { rate, .. } = spring().spring else { panic!("an extension spring") };
    assert!((rate - 9.81 * 0.3 / (0.15 * 0.12)).abs() < 1e-6, "{rate}");
    c.bench_function("a spring over 90 degrees", |b| b.iter(spring));
}

criterion_group!(benches, loads, balance);
criterion_main!(benches);
