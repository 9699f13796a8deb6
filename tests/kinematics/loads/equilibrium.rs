//! Every moving body of every kind is in equilibrium: the forces of its pairs are its mass times its acceleration, which is taken from
//! differences of positions, and their moment about a point of the plane is the change of its angular momentum.

use super::draws::{KINDS, linkage};
use super::is_well_placed;
use linkwright::internals::mechanism::four_bar::motion::CrankMotion;
use linkwright::internals::mechanism::loads::{BodyMass, LoadedLinkage, Loads, Mass};
use linkwright::internals::mechanism::structure::{Frame, Line, PairKind, Structure};
use linkwright::internals::mechanism::{Complex, Linkage, Mechanism, Unit, cross, turned};

/// The step of differences by the crank angle, radians.
const STEP: f64 = 2e-4;
const OMEGA: f64 = 5.0;
/// Metres in the unit of the linkages.
const SCALE: f64 = 0.01;

/// Joints in metres, and the direction of each body.
fn state(mechanism: &dyn Mechanism, structure: &Structure, angle: f64) -> (Vec<Complex>, Vec<Complex>) {
    let pose = mechanism.pose_at(angle);
    let joints: Vec<Complex> = pose.joints.iter().map(|z| z.expect("it closes") * SCALE).collect();
    let mut directions: Vec<Complex> = Vec::new();
    for body in &structure.bodies {
        directions.push(match body.frame {
            Frame::Ground => Complex::new(1.0, 0.0),
            Frame::Joints([from, to]) => (joints[to] - joints[from]) / (joints[to] - joints[from]).norm(),
            Frame::Coupler(_) => pose.coupler.expect("one coupler"),
            Frame::Block { line: Line::Fixed(u), .. } => u,
            Frame::Block { line: Line::OnBody { body, turn }, .. } => directions[body] * turn,
        });
    }
    (joints, directions)
}

fn origin(frame: Frame) -> usize {
    match frame {
        Frame::Ground => 0,
        Frame::Joints([from, _]) | Frame::Coupler(from) | Frame::Block { at: from, .. } => from,
    }
}

/// The second derivative from five values a step apart.
fn second(values: [Complex; 5]) -> Complex {
    let [a, b, c, d, e] = values;
    (-a + b * 16.0 - c * 30.0 + d * 16.0 - e) / (12.0 * STEP * STEP)
}

/// Returns the largest residual of all equations of all moving bodies, in parts of the largest force.
fn residual(linkage: &Linkage, angle: f64) -> f64 {
    let mechanism = linkage.mechanism();
    let structure = mechanism.structure();
    let (mass, center, inertia) = (0.8, Complex::new(0.02, -0.01), 2e-4);
    let given = Mass::Given { mass_kg: mass, center: [center.re, center.im], inertia_kg_m2: inertia };
    let gravity = Complex::new(1.0, -9.81);
    let names = structure.bodies.iter().skip(1);
    let loads = Loads {
        gravity: [gravity.re, gravity.im],
        bodies: names.map(|body| BodyMass { body: body.name.clone(), mass: given.clone() }).collect(),
        ..Loads::default()
    };
    let loaded = LoadedLinkage::new(linkage, Unit::Cm, &loads).expect("names");
    let scratch = &mut loaded.scratch();
    loaded.balance(angle, CrankMotion::steady(OMEGA), scratch).expect("it closes");
    let states = [-2.0, -1.0, 0.0, 1.0, 2.0].map(|k| state(mechanism, &structure, angle + k * STEP));
    let (joints, directions) = &states[2];
    let mut worst = 0.0_f64;
    let mut size = 0.0_f64;
    for (i, body) in structure.bodies.iter().enumerate().skip(1) {
        let place = |k: usize| {
            let (joints, directions) = &states[k];
            joints[origin(body.frame)] + directions[i] * center
        };
        let acceleration = second([0, 1, 2, 3, 4].map(place)) * (OMEGA * OMEGA);
        // The angle from where the body is now.
        let angle_of = |k: usize| Complex::new((states[k].1[i] * directions[i].conj()).arg(), 0.0);
        let turning = second([0, 1, 2, 3, 4].map(angle_of)).re * OMEGA * OMEGA;
        let g = place(2);
        let (mut force, mut moment) = (gravity * mass, if i == 1 { scratch.torque() } else { 0.0 });
        for (pair, [x, y]) in loaded.pairs().iter().zip(scratch.reactions()) {
            let Some(side) = pair.bodies.iter().position(|of| *of == i) else { continue };
            let sign = if side == 0 { 1.0 } else { -1.0 };
            let (push, twist) = match pair.kind {
                PairKind::Revolute => (Complex::new(*x, *y), 0.0),
                PairKind::Prismatic => (turned(directions[pair.bodies[1]]) * *x, *y),
            };
            force += push * sign;
            moment += sign * (cross(joints[pair.joint] - g, push) + twist);
            size = size.max(push.norm());
        }
        worst = worst.max((force - acceleration * mass).norm());
        // A moment of a force at 5 cm counts as the force.
        worst = worst.max((moment - turning * inertia).abs() / 0.05);
    }
    worst / size
}

#[test]
fn every_body_of_every_kind_is_in_equilibrium() {
    for kind in KINDS {
        let (mut found, mut seed, mut worst) = (0, 0, 0.0_f64);
        while found < 100 {
            seed += 1;
            let (linkage, angle) = linkage(kind, seed);
            let closes = |by: f64| is_well_placed(&linkage, angle + by);
            if !(closes(-2.0 * STEP) && closes(0.0) && closes(2.0 * STEP)) {
                continue;
            }
            found += 1;
            worst = worst.max(residual(&linkage, angle));
        }
        // Differences of fourth order with this step leave about eps/STEP^2 = 6e-9 to rounding, times a few for the fastest.
        assert!(worst < 1e-6, "{kind}: {worst:e}");
    }
}
