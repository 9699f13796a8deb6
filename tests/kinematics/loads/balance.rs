//! Springs and counter-masses against textbook balances and against dense evaluation.

use linkwright::internals::mechanism::four_bar::motion::CrankMotion;
use linkwright::internals::mechanism::loads::balance::{
    BalanceError, MassAim, MassRequest, SpringEnds, SpringRequest, balance_by_masses, balance_by_spring,
};
use linkwright::internals::mechanism::loads::{
    BodyMass, CrankSpeed, Drive, LoadedLinkage, Loads, Mass, Place, Spring,
};
use linkwright::internals::mechanism::{AssemblyMode, Complex, FourBar, Linkage, Unit};
use std::f64::consts::{PI, TAU};

const G: f64 = 9.81;

/// A four-bar in mm whose crank turns fully.
fn four_bar() -> Linkage {
    let pivots = [Complex::new(0.0, 0.0), Complex::new(400.0, 0.0)];
    let offset = Complex::new(200.0, 50.0);
    let found = FourBar::with_coupler_offset(pivots, [100.0, 350.0, 300.0], offset, AssemblyMode::Plus);
    Linkage::FourBar(found.expect("a linkage"))
}

fn mass(body: &str, mass_kg: f64, center: [f64; 2], inertia_kg_m2: f64) -> BodyMass {
    BodyMass { body: body.into(), mass: Mass::Given { mass_kg, center, inertia_kg_m2 } }
}

/// A lamp of 2 kg at 80 mm on the crank, which is the arm.
fn lamp() -> Loads {
    Loads { gravity: [0.0, -G], bodies: vec![mass("crank", 2.0, [0.08, 0.0], 0.0)], ..Loads::default() }
}

fn places(from: Place, to: Place, range_deg: [f64; 2]) -> SpringRequest {
    let range = range_deg.map(f64::to_radians);
    SpringRequest { ends: SpringEnds::Places([from, to]), range, rates: Vec::new(), least_free_length: 0.0 }
}

#[test]
fn a_lamp_arm_is_balanced_exactly_by_the_textbooks_spring_without_a_free_length() {
    // From b = 100 mm on the arm to a = 60 mm above the pivot: k a b = m g r.
    let request = places(Place::Joint("C".into()), Place::Fixed([0.0, 0.06]), [-60.0, 80.0]);
    let found = balance_by_spring(&four_bar(), Unit::Mm, &lamp(), &request).expect("a spring");
    let Spring::Extension { rate, free_length, .. } = &found.spring else { panic!("an extension spring") };
    let exact = 2.0 * G * 0.08 / (0.1 * 0.06);
    assert!((rate / exact - 1.0).abs() < 1e-9 && *free_length < 1e-9, "{rate} of {exact}, {free_length}");
    assert!(found.residual_percent < 1e-6, "{}", found.residual_percent);
    assert!((found.before.peak.value.abs() - 2.0 * G * 0.08).abs() < 1e-6, "at 0 degrees the arm lies level");
    assert!(found.span[0] > 0.0 && found.largest > 0.0);
}

#[test]
fn a_hinge_with_a_spring_that_can_be_bought_holds_within_five_percent_over_ninety_degrees() {
    // A spring whose free length is at least 60 mm, to a point far above.
    let range = [-45.0, 45.0];
    let mut request = places(Place::Joint("C".into()), Place::Fixed([0.0, 0.3]), range);
    request.least_free_length = 0.06;
    let found = balance_by_spring(&four_bar(), Unit::Mm, &lamp(), &request).expect("a spring");
    assert!(found.residual_percent < 5.0, "{}", found.residual_percent);
    let Spring::Extension { free_length, .. } = &found.spring else { panic!("an extension spring") };
    assert!(*free_length >= 0.06 - 1e-12, "{free_length}");
    // Against the torque at 90,001 crank angles.
    let loaded = LoadedLinkage::new(&four_bar(), Unit::Mm, &found.loads).expect("names");
    let mut scratch = loaded.scratch();
    let worst = (0..=90_000).map(|i| {
        let angle = (-45.0 + f64::from(i) * 1e-3).to_radians();
        loaded.torque(angle, CrankMotion::steady(0.0), &mut scratch).expect("closed").abs()
    });
    let worst = worst.fold(0.0, f64::max);
    assert!((worst - found.after.peak.value.abs()).abs() < 1e-6 * worst, "{worst} {:?}", found.after);
    assert!(worst < 0.05 * 2.0 * G * 0.08);
}

#[test]
fn the_fit_is_the_least_of_its_neighbours() {
    let request = places(Place::Joint("D".into()), Place::Fixed([0.1, 0.6]), [20.0, 110.0]);
    let loads = Loads {
        gravity: [0.0, -G],
        bodies: vec![mass("coupler", 1.0, [0.1, 0.02], 0.0), mass("follower", 0.5, [0.15, 0.0], 0.0)],
        ..Loads::default()
    };
    let found = balance_by_spring(&four_bar(), Unit::Mm, &loads, &request).expect("a spring");
    let Spring::Extension { ends, rate, free_length } = found.spring.clone() else { panic!("extension") };
    let rms = |rate: f64, free_length: f64| {
        let mut with = loads.clone();
        with.springs.push(Spring::Extension { ends: ends.clone(), rate, free_length });
        let loaded = LoadedLinkage::new(&four_bar(), Unit::Mm, &with).expect("names");
        let mut scratch = loaded.scratch();
        let sum: f64 = (0..=180)
            .map(|i| {
                let angle = (20.0 + 0.5 * f64::from(i)).to_radians();
                loaded.torque(angle, CrankMotion::steady(0.0), &mut scratch).expect("closed").powi(2)
            })
            .sum();
        sum.sqrt()
    };
    let best = rms(rate, free_length);
    for (more, longer) in [(1e-3, 0.0), (-1e-3, 0.0), (0.0, 1e-4), (0.0, -1e-4)] {
        let free = free_length + longer;
        if free >= 0.0 {
            assert!(rms(rate * (1.0 + more), free) >= best * (1.0 - 1e-12), "{more} {longer}");
        }
    }
    // Of the rates that can be bought the best is taken, with a free length of its own.
    let of = |rates: Vec<f64>| {
        let bought = SpringRequest { rates, ..request.clone() };
        let found = balance_by_spring(&four_bar(), Unit::Mm, &loads, &bought).ok()?;
        let Spring::Extension { rate, free_length, .. } = found.spring else { panic!("an extension spring") };
        Some((rate, rms(rate, free_length)))
    };
    let all = [0.2 * rate, 1.1 * rate, 5.0 * rate];
    let (taken, left) = of(all.to_vec()).expect("one of them helps");
    assert!(all.contains(&taken) && left >= best * (1.0 - 1e-12), "{taken} of {rate}");
    assert!(all.iter().filter_map(|one| of(vec![*one])).all(|(_, other)| other >= left * (1.0 - 1e-12)));
}

#[test]
fn a_torsion_spring_balances_what_one_can() {
    // The moment of a torsion spring of 0.5 N m/rad that is at rest at 30 degrees.
    let own = Spring::Torsion {
        bodies: ["follower".into(), "ground".into()],
        rate: 0.5,
        free_angle: 30_f64.to_radians(),
    };
    let mut loads = Loads { springs: vec![own], ..Loads::default() };
    // It is a load here: the spring that undoes it would be one of -0.5 N m/rad.
    let request = SpringRequest {
        ends: SpringEnds::Bodies(["follower".into(), "ground".into()]),
        range: [0.0, PI],
        rates: Vec::new(),
        least_free_length: 0.0,
    };
    let refused = balance_by_spring(&four_bar(), Unit::Mm, &loads, &request);
    assert_eq!(refused.expect_err("none helps"), BalanceError::NoSpringHelps);
    // A door that its weight pulls down from upright: the torque of the lamp near the top is nearly linear in the angle.
    loads = lamp();
    let request = SpringRequest {
        ends: SpringEnds::Bodies(["crank".into(), "ground".into()]),
        range: [70_f64.to_radians(), 110_f64.to_radians()],
        ..request
    };
    let found = balance_by_spring(&four_bar(), Unit::Mm, &loads, &request).expect("a spring");
    let Spring::Torsion { rate, free_angle, .. } = found.spring else { panic!("a torsion spring") };
    assert!((free_angle - 0.5 * PI).abs() < 1e-6, "{free_angle}");
    assert!((rate / (2.0 * G * 0.08) - 1.0).abs() < 0.03, "{rate}");
    assert!(found.residual_percent < 5.0, "{}", found.residual_percent);
    let wide = SpringRequest { range: [0.0, TAU], ..request };
    let refused = balance_by_spring(&four_bar(), Unit::Mm, &loads, &wide);
    assert_eq!(refused.expect_err("a full turn"), BalanceError::TurnsTooFar);
}

#[test]
fn what_makes_no_balance_is_refused() {
    let linkage = four_bar();
    let request = places(Place::Joint("C".into()), Place::Fixed([0.0, 0.06]), [0.0, 90.0]);
    let of = |loads: &Loads, request: &SpringRequest| {
        balance_by_spring(&linkage, Unit::Mm, loads, request).expect_err("refused")
    };
    assert_eq!(of(&Loads::default(), &request), BalanceError::NothingToBalance);
    assert_eq!(of(&lamp(), &SpringRequest { range: [1.0, 1.0], ..request.clone() }), BalanceError::BadRange);
    let unknown = places(Place::Joint("Q".into()), Place::Fixed([0.0, 0.06]), [0.0, 90.0]);
    assert!(of(&lamp(), &unknown).to_string().contains("joints and points of this linkage: A, B, C, D, P"));
    let rates = SpringRequest { rates: vec![-1.0], ..request };
    assert!(matches!(of(&lamp(), &rates), BalanceError::BadNumber { .. }));
}

/// The masses of a four-bar whose coupler's centre lies on its line, without gravity.
fn moving() -> Loads {
    Loads {
        bodies: vec![
            mass("crank", 0.2, [0.05, 0.0], 1e-4),
            mass("coupler", 0.6, [0.14, 0.0], 5e-3),
            mass("follower", 0.5, [0.15, 0.0], 4e-3),
        ],
        ..Loads::default()
    }
}

#[test]
fn counter_masses_on_crank_and_follower_take_away_the_shaking_force() {
    // Berkof and Lowen 1969: the mass moments of crank and follower that make the linkage's centre of mass stand still are
    // m_2 r_2 + m_3 (1 - s/b) a and m_4 r_4 + m_3 (s/b) c, against the links' own lines.
    let request = MassRequest {
        bodies: vec!["crank".into(), "follower".into()],
        radius: 0.06,
        aim: MassAim::ShakingForce,
        drive: CrankMotion::steady(20.0).into(),
    };
    let found = balance_by_masses(&four_bar(), Unit::Mm, &moving(), &request).expect("masses");
    assert!(found.shaking_percent < 1e-6, "{}", found.shaking_percent);
    let [crank, follower] = found.masses.as_slice() else { panic!("two masses: {:?}", found.masses) };
    let share = 0.14 / 0.35;
    for (mass, moment) in
        [(crank, 0.2 * 0.05 + 0.6 * (1.0 - share) * 0.1), (follower, 0.5 * 0.15 + 0.6 * share * 0.3)]
    {
        assert!((mass.mass_kg * mass.distance_m / moment - 1.0).abs() < 1e-6, "{mass:?} {moment}");
        assert!((mass.direction_deg.abs() - 180.0).abs() < 1e-4, "{mass:?}");
    }
    assert!(
        found.before.shaking_force > 1.0 && found.after.shaking_force < 1e-6 * found.before.shaking_force
    );
    // The centre of mass stands still at any speed.
    let table = CrankSpeed::Table(vec![(0.0, 20.0), (1.0, 28.0), (4.0, 17.0)]);
    let drive = Drive::of(&table).expect("a table");
    let over_turn = balance_by_masses(&four_bar(), Unit::Mm, &moving(), &MassRequest { drive, ..request });
    let over_turn = over_turn.expect("masses");
    assert!(over_turn.shaking_percent < 1e-6, "{}", over_turn.shaking_percent);
    let pairs = found.masses.iter().zip(&over_turn.masses);
    assert!(pairs.into_iter().all(|(one, other)| (one.mass_kg - other.mass_kg).abs() < 1e-6));
    assert!((over_turn.before.torque_peak - found.before.torque_peak).abs() > 0.1 * found.before.torque_peak);
}

#[test]
fn counter_masses_even_the_torque_of_a_weight() {
    // The weight of the crank alone: a counter-mass of the same moment takes all of it.
    let request = MassRequest {
        bodies: vec!["crank".into()],
        radius: 0.05,
        aim: MassAim::Torque,
        drive: CrankMotion::steady(0.0).into(),
    };
    let found = balance_by_masses(&four_bar(), Unit::Mm, &lamp(), &request).expect("masses");
    assert!(found.ripple_percent < 1e-6, "{found:?}");
    let [mass] = found.masses.as_slice() else { panic!("one mass: {:?}", found.masses) };
    assert!((mass.mass_kg * mass.distance_m - 2.0 * 0.08).abs() < 1e-7, "{mass:?}");
    // Of a whole linkage a part stays, and both aims are heard.
    let mut loads = moving();
    loads.gravity = [0.0, -G];
    let both = ["crank".to_owned(), "follower".to_owned()].to_vec();
    let ripple = |aim| {
        let request =
            MassRequest { bodies: both.clone(), radius: 0.06, aim, drive: CrankMotion::steady(3.0).into() };
        balance_by_masses(&four_bar(), Unit::Mm, &loads, &request).expect("masses")
    };
    let (torque, all) = (ripple(MassAim::Torque), ripple(MassAim::Both));
    assert!(torque.ripple_percent < 100.0 && torque.ripple_percent <= all.ripple_percent + 1e-9);
    assert!(all.shaking_percent < 100.0);
    let coupler = MassRequest {
        bodies: vec!["coupler".into()],
        radius: 0.06,
        aim: MassAim::Both,
        drive: CrankMotion::steady(3.0).into(),
    };
    let refused = balance_by_masses(&four_bar(), Unit::Mm, &loads, &coupler).expect_err("no pivot");
    assert!(refused.to_string().contains("crank, follower do"), "{refused}");
}
