//! Speeds over the crank angle: closed forms of a crank with inertia, a table that is constant, and the agreement of power balance,
//! Newton-Euler and energy on random linkages of each kind.

use super::draws::{KINDS, linkage, loads};
use super::examples::{mass, romero};
use super::{fitting, is_well_placed};
use linkwright::internals::mechanism::loads::{Couple, CrankSpeed, Drive, LoadedLinkage, Loads, Quantity};
use linkwright::internals::mechanism::{Linkage, Unit};
use std::f64::consts::{PI, TAU};

/// The mean of the table of [`wave`] over the crank angle, rad/s, and the part by which the speed changes.
const SPEED: f64 = 8.0;
const PART: f64 = 0.4;
/// The rows of that table: the spline's slope is then within h^3/24 of the wave's, 2e-6 of its size.
const ROWS: u32 = 180;

/// Returns rows of omega = w (1 + k cos phi).
fn wave() -> CrankSpeed {
    let angles = (0..ROWS).map(|i| TAU * f64::from(i) / f64::from(ROWS));
    CrankSpeed::Table(angles.map(|angle| (angle, SPEED * (1.0 + PART * angle.cos()))).collect())
}

/// Returns a table of a few rows, in either sense.
fn drawn(seed: u64) -> CrankSpeed {
    let sway = |k: f64| (seed as f64 * 0.37 + k).sin();
    let sense = if seed.is_multiple_of(2) { 1.0 } else { -1.0 };
    let rows = (0..5).map(|i| {
        let at = 1.2 * f64::from(i) + 0.2 * sway(f64::from(i));
        (at, sense * (10.0 + 2.0 * sway(10.0 + 3.0 * f64::from(i))))
    });
    CrankSpeed::Table(rows.collect())
}

#[test]
fn a_crank_with_inertia_alone_needs_its_inertia_times_its_acceleration() {
    let inertia = 3e-4;
    let bodies = vec![mass("crank", 0.0, [0.0; 2], inertia)];
    let loads = Loads { bodies, speed_rad_s: Some(wave()), ..Loads::default() };
    let loaded = LoadedLinkage::new(&Linkage::FourBar(romero()), Unit::Cm, &loads).expect("names");
    let scratch = &mut loaded.scratch();
    let closed = |angle: f64| -inertia * SPEED * SPEED * PART * angle.sin() * (1.0 + PART * angle.cos());
    let size = inertia * SPEED * SPEED * PART;
    for i in 0..48 {
        let angle = TAU * f64::from(i) / 48.0 + 0.013;
        let input = loaded.drive().motion(angle);
        loaded.balance(angle, input, scratch).expect("it closes");
        let newton = scratch.torque();
        let power = loaded.torque(angle, input, scratch).expect("it closes");
        let exact = inertia * input.acceleration_rad_s2;
        assert!((newton - exact).abs() < 1e-14 && (power - exact).abs() < 1e-14);
        assert!((newton - closed(angle)).abs() < 1e-5 * size, "{angle}: {newton} {}", closed(angle));
    }
    let figures = loaded.figures(loaded.drive()).expect("it turns");
    // What speeds the crank up over one half of the turn comes back over the other.
    assert!(figures.torque_mean.abs() < 1e-10 * size && figures.power_mean.abs() < 1e-10 * size * SPEED);
    assert!(figures.fluctuation.is_none());
    let range = figures.speed_over_turn.expect("a table");
    assert!((range.turn_s - TAU / (SPEED * (1.0 - PART * PART).sqrt())).abs() < 1e-7);
    // T^2 over time: the integral of T^2/omega dphi is I^2 w^3 k^2 times that of sin^2 phi (1 + k cos phi), which is pi.
    let mean_sq = inertia * inertia * SPEED.powi(3) * PART * PART * PI / range.turn_s;
    assert!((figures.torque_rms - mean_sq.sqrt()).abs() < 1e-5 * size);
}

#[test]
fn the_mean_power_is_the_work_of_a_turn_over_its_time() {
    let moment = Quantity::Constant([-0.7]);
    let couples = vec![Couple { body: "crank".into(), moment }];
    for sense in [1.0, -1.0] {
        let CrankSpeed::Table(rows) = wave() else { panic!("a table") };
        let speed = CrankSpeed::Table(rows.into_iter().map(|(at, speed)| (at, sense * speed)).collect());
        let loads = Loads { couples: couples.clone(), speed_rad_s: Some(speed), ..Loads::default() };
        let loaded = LoadedLinkage::new(&Linkage::FourBar(romero()), Unit::Cm, &loads).expect("names");
        let figures = loaded.figures(loaded.drive()).expect("it turns");
        let turn_s = figures.speed_over_turn.expect("a table").turn_s;
        // A motor that turns backwards is driven by the couple that it holds.
        let power = sense * 0.7 * TAU / turn_s;
        assert!((figures.power_mean - power).abs() < 1e-9, "{} {power}", figures.power_mean);
        assert!((figures.torque_rms - 0.7).abs() < 1e-13);
    }
}

#[test]
fn a_table_of_one_speed_is_that_speed() {
    let linkage = Linkage::FourBar(romero());
    let own = loads(&linkage, 3, false);
    let of = |speed: CrankSpeed| {
        let (loaded, _) = fitting(&linkage, Loads { speed_rad_s: Some(speed), ..own.clone() });
        loaded.figures(loaded.drive()).expect("it turns")
    };
    let steady = of(CrankSpeed::Steady(6.0));
    let table = of(CrankSpeed::Table(vec![(0.0, 6.0), (1.0, 6.0), (4.0, 6.0)]));
    let pairs = [
        (steady.torque_peak.value, table.torque_peak.value),
        (steady.torque_rms, table.torque_rms),
        (steady.torque_mean, table.torque_mean),
        (steady.power_mean, table.power_mean),
        (steady.shaking_force.value, table.shaking_force.value),
    ];
    for (one, other) in pairs {
        assert!((one - other).abs() < 1e-11 * one.abs(), "{one} {other}");
    }
    assert!(steady.fluctuation.is_some() && table.fluctuation.is_none());
}

#[test]
fn both_torques_and_the_change_of_energy_agree_at_speeds_over_the_crank_angle() {
    for kind in KINDS {
        let (mut found, mut seed, mut worst) = (0, 0, 0.0_f64);
        while found < 300 {
            seed += 1;
            assert!(seed < 20_000, "{kind}: only {found}");
            let (linkage, angle) = linkage(kind, seed);
            if !is_well_placed(&linkage, angle) {
                continue;
            }
            found += 1;
            let speed_rad_s = Some(drawn(seed));
            // Forces and springs without losses alone keep energy.
            let (loaded, _) = fitting(&linkage, Loads { speed_rad_s, ..loads(&linkage, seed, true) });
            let scratch = &mut loaded.scratch();
            let drive: Drive = loaded.drive().clone();
            let input = drive.motion(angle);
            let (power, size) = loaded.torque_and_size(angle, input, scratch).expect("it closes");
            loaded.balance(angle, input, scratch).expect("it closes");
            worst = worst.max((scratch.torque() - power).abs() / power.abs().max(1e-3 * size));
            let mut energy = |by: f64| {
                let at = loaded.at(angle + by, drive.motion(angle + by), scratch).expect("it closes");
                at.kinetic + at.potential
            };
            let whole = energy(0.0);
            // The difference of fourth order; where a spline's third derivative jumps, of third.
            let h = 1e-4;
            let mut slope = |h: f64| (energy(h) - energy(-h)) / (2.0 * h);
            let rate = (4.0 * slope(h) - slope(2.0 * h)) / 3.0;
            assert!((rate - power).abs() < 1e-6 * (whole.abs() + size), "{kind} {seed}: {rate} {power}");
        }
        assert!(worst < 1e-10, "{kind}: {worst:e}");
    }
}
