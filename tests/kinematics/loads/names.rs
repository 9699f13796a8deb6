//! Names of bodies: what the link that carries P bears, and the plates of a six-bar in the file of its chain.

use super::draws::{KINDS, linkage};
use super::is_well_placed;
use linkwright::internals::files::linkage_file::{any_to_toml, parse_any};
use linkwright::internals::mechanism::loads::{BodyMass, LoadError, LoadFault, LoadedLinkage, Loads, Mass};
use linkwright::internals::mechanism::{CrankLinkage, Linkage, Unit};

fn at_joint(body: &str, joint: &str, mass_kg: f64) -> BodyMass {
    BodyMass { body: body.into(), mass: Mass::AtJoint { mass_kg, joint: joint.into(), inertia_kg_m2: 0.0 } }
}

fn loads(bodies: Vec<BodyMass>) -> Loads {
    Loads { gravity: [1.0, -9.81], bodies, ..Loads::default() }
}

/// Returns the torque of a linkage at an angle and 5 rad/s.
fn torque(linkage: &Linkage, bodies: Vec<BodyMass>, angle: f64) -> Result<f64, LoadError> {
    let loaded = LoadedLinkage::new(linkage, Unit::Cm, &loads(bodies))?;
    let input = linkwright::analysis::CrankMotion::steady(5.0);
    Ok(loaded.torque(angle, input, &mut loaded.scratch()).expect("it closes"))
}

#[test]
fn the_body_of_p_is_what_hangs_there_beside_the_mass_of_its_link() {
    for kind in KINDS.iter().filter(|kind| **kind != "chain") {
        let found = (1..).map(|seed| linkage(kind, seed)).find(|(of, angle)| is_well_placed(of, *angle));
        let (linkage, angle) = found.expect("there are many");
        let structure = linkage.mechanism().structure();
        let traced = linkage.mechanism().traced();
        let carrier = structure.carriers(traced).map(|body| structure.bodies[body].name.clone()).last();
        let carrier = carrier.expect("a link carries P");
        let hung = torque(&linkage, vec![at_joint("P", "P", 2.0)], angle).expect("names");
        let own = torque(&linkage, vec![at_joint(&carrier, "P", 2.0)], angle).expect("names");
        let both = vec![at_joint("P", "P", 2.0), at_joint(&carrier, "P", 3.0)];
        let both = torque(&linkage, both, angle).expect("names");
        assert!((hung - own).abs() < 1e-12 * own.abs() && (both - 2.5 * own).abs() < 1e-12 * both.abs());
        // A pin of two links names neither.
        let fault = torque(&linkage, vec![at_joint("C", "C", 1.0)], angle).expect_err("two links").fault;
        assert!(matches!(fault, LoadFault::UnknownBody { .. }), "{kind}: {fault:?}");
    }
}

#[test]
fn the_chain_of_a_six_bar_knows_the_names_of_its_plates() {
    for kind in ["six-bar", "eight-bar"] {
        for seed in 1..40 {
            let (linkage, angle) = linkage(kind, seed);
            if !is_well_placed(&linkage, angle) {
                continue;
            }
            let Linkage::MultiLoop(own) = &linkage else { panic!("a {kind}") };
            let text = any_to_toml("a", Some(Unit::Cm), &CrankLinkage::MultiLoop(**own));
            let chain = parse_any("a.toml", &text).expect("it reads back").linkage;
            assert!(matches!(chain, Linkage::Chain(_)));
            let structure = linkage.mechanism().structure();
            for body in &structure.bodies[1..] {
                let center = [0.3, -0.2];
                let mass = Mass::Given { mass_kg: 1.0, center, inertia_kg_m2: 0.1 };
                let bodies = || vec![BodyMass { body: body.name.clone(), mass: mass.clone() }];
                let one = torque(&linkage, bodies(), angle).expect("names");
                let other = torque(&chain, bodies(), angle).expect("names");
                assert!((one - other).abs() < 1e-8 * (1.0 + one.abs()), "{kind} {seed} {}", body.name);
            }
        }
    }
}
