//! Loads: torques by power balance and by Newton-Euler, energy, closed forms, a textbook's example, and a free-body computation
//! of its own.

mod balance;
mod draws;
mod equilibrium;
mod examples;
mod names;
mod speeds;

use crate::thorough::cases;
use draws::{KINDS, linkage, loads};
use linkwright::internals::mechanism::four_bar::motion::CrankMotion;
use linkwright::internals::mechanism::loads::{LoadFault, LoadedLinkage, Loads, Spring};
use linkwright::internals::mechanism::{Linkage, Status, Unit};
use std::f64::consts::TAU;

/// Linkages of each kind that are compared.
const LINKAGES: usize = 1000;

/// The largest velocity coefficient of a joint, in lengths of the longest: below it no toggle is near enough that rounding counts.
const FASTEST: f64 = 20.0;

/// The peak over the rms of a torque above which it is a spike of a linkage next to a change point, narrower than half a degree.
const SPIKE: f64 = 20.0;

/// Drops the springs that the linkage refuses: between two places of one body.
fn fitting(linkage: &Linkage, mut loads: Loads) -> (LoadedLinkage, Loads) {
    loop {
        match LoadedLinkage::new(linkage, Unit::Cm, &loads) {
            Ok(loaded) => return (loaded, loads),
            Err(error) => {
                let at = match (&error.key, &error.fault) {
                    (linkwright::internals::mechanism::loads::LoadKey::Spring(i, _), LoadFault::SameEnds) => {
                        *i
                    }
                    (linkwright::internals::mechanism::loads::LoadKey::Force(i, _), LoadFault::OnGround) => {
                        loads.forces.remove(*i);
                        continue;
                    }
                    other => panic!("{other:?}"),
                };
                loads.springs.remove(at);
            }
        }
    }
}

/// Returns whether a linkage closes at an angle, with every joint slower than [`FASTEST`] lengths for a radian.
fn is_well_placed(linkage: &Linkage, angle: f64) -> bool {
    let motion = linkage.mechanism().motion_at(angle, CrankMotion::steady(1.0));
    let usual = |z: &Option<linkwright::Complex>| z.is_some_and(|z| z.norm() < FASTEST);
    motion.pose.status == Status::Ok
        && motion.velocities.iter().all(usual)
        && motion.accelerations.iter().all(|z| z.is_some_and(|z| z.norm() < FASTEST * FASTEST))
}

#[test]
fn torques_by_power_and_by_newton_euler_agree_on_random_linkages_of_each_kind() {
    for kind in KINDS {
        let (mut found, mut seed, mut worst) = (0, 0, 0.0_f64);
        while found < LINKAGES {
            seed += 1;
            assert!(seed < 40_000, "{kind}: only {found}");
            let (linkage, angle) = linkage(kind, seed);
            if !is_well_placed(&linkage, angle) {
                continue;
            }
            let (loaded, _) = fitting(&linkage, loads(&linkage, seed, false));
            let scratch = &mut loaded.scratch();
            let sway = (seed as f64 * 0.37).sin();
            let moving = CrankMotion { speed_rad_s: 12.0 * sway, acceleration_rad_s2: 40.0 * (1.0 - sway) };
            for input in [moving, CrankMotion::steady(0.0)] {
                let power = loaded.torque_and_size(angle, input, scratch);
                let newton = loaded.balance(angle, input, scratch);
                let ((power, size), Ok(())) = (power.expect("it closes"), newton) else {
                    panic!("{kind} {seed}")
                };
                // The torque is what is left of terms of this size.
                let off = (scratch.torque() - power).abs();
                worst = worst.max(off / (power.abs().max(1e-3 * size)));
            }
            found += 1;
        }
        assert!(worst < 1e-10, "{kind}: {worst:e}");
    }
}

#[test]
fn the_change_of_energy_is_the_torques_work() {
    for kind in KINDS {
        let (mut found, mut seed) = (0, 0);
        while found < 100 {
            seed += 1;
            let (linkage, angle) = linkage(kind, seed);
            if !is_well_placed(&linkage, angle) {
                continue;
            }
            found += 1;
            let (loaded, _) = fitting(&linkage, loads(&linkage, seed, true));
            let scratch = &mut loaded.scratch();
            // omega^2 = omega_0^2 + 2 alpha (phi - phi_0).
            let (speed, acceleration) = (3.0, 5.0);
            let mut energy = |by: f64| {
                let input = CrankMotion {
                    speed_rad_s: (speed * speed + 2.0 * acceleration * by).sqrt(),
                    acceleration_rad_s2: acceleration,
                };
                let at = loaded.at(angle + by, input, scratch).expect("it closes");
                (at.kinetic + at.potential, at.torque)
            };
            let (whole, torque) = energy(0.0);
            // The difference of fourth order: its error is 4 h^4/5! of the fifth derivative, and rounding over h.
            let h = 1e-4;
            let mut slope = |h: f64| (energy(h).0 - energy(-h).0) / (2.0 * h);
            let rate = (4.0 * slope(h) - slope(2.0 * h)) / 3.0;
            let size = whole.abs() + torque.abs();
            assert!((rate - torque).abs() < 1e-7 * size, "{kind} {seed}: {rate} {torque} {whole}");
        }
    }
}

#[test]
fn over_a_turn_at_constant_speed_conservative_loads_take_no_work() {
    for kind in ["four-bar", "slider-crank", "inverted slider-crank", "six-bar", "eight-bar"] {
        let (mut found, mut seed) = (0, 0);
        while found < 30 {
            seed += 1;
            let (linkage, _) = linkage(kind, seed);
            let range = linkage.mechanism().crank_range();
            let smooth = (0..72).all(|i| {
                let motion =
                    linkage.mechanism().motion_at(TAU * f64::from(i) / 72.0, CrankMotion::steady(1.0));
                let usual = |z: &Option<linkwright::Complex>| z.is_some_and(|z| z.norm() < 60.0);
                motion.pose.status == Status::Ok && motion.accelerations.iter().all(usual)
            });
            if !range.turns_fully || !smooth {
                continue;
            }
            found += 1;
            let (loaded, _) = fitting(&linkage, loads(&linkage, seed, true));
            let scratch = &mut loaded.scratch();
            let (count, mut sum, mut size) = (7200_i32, 0.0, 0.0);
            for i in 0..count {
                let angle = TAU * f64::from(i) / f64::from(count);
                let torque = loaded.torque(angle, CrankMotion::steady(4.0), scratch).expect("it closes");
                (sum, size) = (sum + torque, size + torque.abs());
            }
            assert!(sum.abs() < 1e-9 * size, "{kind} {seed}: {sum:e} of {size:e}");
            let figures = loaded.figures(&CrankMotion::steady(4.0).into()).expect("it closes");
            assert!(figures.full_turn && figures.torque_mean.abs() < 1e-6 * figures.torque_rms);
        }
    }
}

#[test]
fn peaks_are_not_below_any_of_dense_samples_and_close_to_the_largest() {
    let mut compared = 0;
    for (i, kind) in KINDS.into_iter().enumerate() {
        for seed in 1..cases(120, 400) {
            let (linkage, angle) = linkage(kind, seed);
            let well = is_well_placed(&linkage, angle) && linkage.mechanism().crank_range().turns_fully;
            if !well || seed as usize % 7 != i {
                continue;
            }
            let (loaded, _) = fitting(&linkage, loads(&linkage, seed, true));
            let scratch = &mut loaded.scratch();
            let input = CrankMotion::steady(2.0);
            let figures = loaded.figures(&input.into()).expect("it closes");
            let (mut torque, mut forces) = (0.0_f64, vec![0.0_f64; figures.joints.len()]);
            for k in 0..20_000 {
                if loaded.balance(TAU * f64::from(k) / 20_000.0, input, scratch).is_err() {
                    continue;
                }
                torque = torque.max(scratch.torque().abs());
                for ((force, joint), [x, y]) in
                    forces.iter_mut().zip(&figures.joints).zip(scratch.reactions())
                {
                    *force = force.max(if joint.slides { x.abs() } else { x.hypot(*y) });
                }
            }
            let near = |peak: f64, dense: f64| {
                // Twenty thousand samples miss a smooth peak by about (pi/20000)^2/2 of its bend.
                assert!(peak.abs() >= dense * (1.0 - 1e-9), "{kind} {seed}: {peak} {dense}");
                assert!(peak.abs() <= dense * (1.0 + 1e-3), "{kind} {seed}: {peak} {dense}");
            };
            if torque > SPIKE * figures.torque_rms {
                continue;
            }
            compared += 1;
            near(figures.torque_peak.value, torque);
            for (joint, force) in figures.joints.iter().zip(forces) {
                near(joint.force.value, force);
            }
        }
    }
    assert!(compared > cases(25, 100), "{compared}");
}

#[test]
fn a_spring_that_is_wound_past_half_a_turn_is_named() {
    let linkage = examples::slider_crank(20.0, 60.0);
    let torsion = |body: &str| Spring::Torsion {
        bodies: [body.to_owned(), "ground".to_owned()],
        rate: 1.0,
        free_angle: 0.0,
    };
    let loads = Loads { springs: vec![torsion("crank"), torsion("coupler")], ..Loads::default() };
    let loaded = LoadedLinkage::new(&linkage, Unit::Mm, &loads).expect("its names are known");
    let figures = loaded.figures(&CrankMotion::steady(1.0).into()).expect("it closes");
    // The coupler rocks.
    assert_eq!(figures.overwound_springs, [1]);
}

#[test]
fn thousands_of_angles_of_a_six_bar_take_milliseconds() {
    let (linkage, _) = (1..)
        .map(|seed| linkage("six-bar", seed))
        .find(|(linkage, _)| linkage.mechanism().crank_range().turns_fully)
        .expect("one turns fully");
    let (loaded, _) = fitting(&linkage, loads(&linkage, 5, false));
    let scratch = &mut loaded.scratch();
    let mut best = std::time::Duration::MAX;
    for _ in 0..5 {
        let begun = std::time::Instant::now();
        for i in 0..3600 {
            let angle = TAU * f64::from(i) / 3600.0;
            loaded.balance(angle, CrankMotion::steady(3.0), scratch).expect("it turns");
        }
        best = best.min(begun.elapsed());
    }
    // 20 ms are asked for of a release build on a machine of its own (benches/loads.rs); here others are building.
    assert!(best.as_millis() < 200, "{best:?}");
}
