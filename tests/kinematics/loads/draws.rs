//! Random linkages of every kind, each with a crank angle at which it closes well, and random loads on them.

use crate::dyad_chains::drawn;
use linkwright::internals::mechanism::chain::{SliderLine, Stage};
use linkwright::internals::mechanism::loads::{
    BodyMass, Couple, Force, ForceVector, Loads, Mass, Place, Quantity, Spring,
};
use linkwright::internals::mechanism::{
    AssemblyMode, ChainBuilder, Complex, CouplerSide, DyadChainKind, FourBar, InvertedSliderCrank, Linkage,
    MultiLoop, NaturalCoordinates, SliderCrank, cross, dot, xy,
};
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use rand_xoshiro::Xoshiro256PlusPlus as Draws;
use std::f64::consts::{PI, TAU};

pub const KINDS: [&str; 6] =
    ["four-bar", "slider-crank", "inverted slider-crank", "six-bar", "eight-bar", "chain"];

fn point(draws: &mut Draws) -> Complex {
    Complex::new(uniform(draws, -5.0, 5.0), uniform(draws, -5.0, 5.0))
}

fn sign(draws: &mut Draws) -> AssemblyMode {
    AssemblyMode::of(uniform(draws, -1.0, 1.0))
}

fn index(draws: &mut Draws, count: usize) -> usize {
    (uniform(draws, 0.0, count as f64) as usize).min(count - 1)
}

/// A random linkage of a kind and a crank angle; lengths are about 1 to 10.
pub fn linkage(kind: &str, seed: u64) -> (Linkage, f64) {
    let draws = &mut stream(23, seed);
    let angle = uniform(draws, -PI, PI);
    match kind {
        "four-bar" => (Linkage::FourBar(four_bar(draws)), angle),
        "slider-crank" => {
            let lengths = [uniform(draws, 0.5, 4.0), uniform(draws, 4.0, 9.0)];
            let line = (point(draws), uniform(draws, -TAU, TAU));
            let made = SliderCrank::from_parts(point(draws), lengths, line, point(draws), sign(draws));
            (Linkage::SliderCrank(made.expect("lengths")), angle)
        }
        "inverted slider-crank" => {
            let (pivots, crank) = ([point(draws), point(draws)], uniform(draws, 0.5, 4.0));
            let (offset, at) = (uniform(draws, -2.0, 2.0), point(draws));
            let made = InvertedSliderCrank::from_parts(pivots, crank, offset, at, sign(draws));
            (Linkage::InvertedSliderCrank(made.expect("lengths")), angle)
        }
        "six-bar" | "eight-bar" => {
            let kinds = match kind {
                "six-bar" => DyadChainKind::SIX_BARS.to_vec(),
                _ => DyadChainKind::eight_bars(),
            };
            let kind = kinds[index(draws, kinds.len())];
            loop {
                let made = MultiLoop::of_dyad_chain(&drawn(kind, draws)).expect("its lengths are positive");
                if made.link_ratio() < 30.0 {
                    return (Linkage::MultiLoop(Box::new(made)), angle);
                }
            }
        }
        _ => chain(draws, angle),
    }
}

fn four_bar(draws: &mut Draws) -> FourBar {
    loop {
        let mut length = |least: f64| uniform(draws, least, 6.0);
        let (crank, coupler, follower) = (length(0.5), length(1.0), length(1.0));
        let [apart, turn] = [uniform(draws, 0.2, 3.0), uniform(draws, 0.2, 3.0)];
        let made = FourBar::new(NaturalCoordinates {
            crank_pivot: xy(point(draws)),
            follower_pivot: xy(point(draws)),
            crank,
            coupler,
            follower,
            crank_side: coupler * apart,
            follower_side: coupler * turn,
            assembly: sign(draws),
            side: if uniform(draws, -1.0, 1.0) > 0.0 { CouplerSide::Plus } else { CouplerSide::Minus },
        });
        if let Ok(made) = made {
            return made;
        }
    }
}

/// Builds a chain of dyads, attached points, sliders on fixed and moving lines, and guides around random places at one angle.
fn chain(draws: &mut Draws, angle: f64) -> (Linkage, f64) {
    let fixed = [point(draws), point(draws), point(draws)];
    let crank = uniform(draws, 0.5, 3.0);
    let mut places = fixed.to_vec();
    places.push(fixed[0] + Complex::from_polar(crank, angle));
    let names: Vec<String> =
        ["A", "B", "E", "C"].map(str::to_owned).into_iter().chain((0..8).map(|i| format!("N{i}"))).collect();
    let mut builder = ChainBuilder::new()
        .pivot("A", xy(fixed[0]))
        .pivot("B", xy(fixed[1]))
        .pivot("E", xy(fixed[2]))
        .crank("A", "C", crank);
    // Pairs of points on one link that moves.
    let mut links = vec![[0, 3]];
    let stages = 2 + index(draws, 4);
    for stage in 0..stages {
        let n = places.len();
        // The first stage moves: it hangs on the crank.
        let p = if stage == 0 { 3 } else { index(draws, n) };
        let q = (p + 1 + index(draws, n - 1)) % n;
        let at = point(draws);
        let name = |i: usize| names[i].clone();
        let made = match index(draws, 5) {
            0 => {
                let side = AssemblyMode::of(cross(places[q] - places[p], at - places[p]));
                let lengths = [(at - places[p]).norm(), (at - places[q]).norm()];
                builder = builder.dyad(&names[n], [&names[p], &names[q]], lengths, side);
                links.extend([[p, n], [q, n]]);
                at
            }
            1 => {
                let [p, q] = links[index(draws, links.len())];
                let offset = [uniform(draws, -3.0, 3.0), uniform(draws, -3.0, 3.0)];
                builder = builder.point(&names[n], [&names[p], &names[q]], offset);
                links.push([p, n]);
                let along = (places[q] - places[p]) / (places[q] - places[p]).norm();
                places[p] + along * Complex::new(offset[0], offset[1])
            }
            2 => {
                let line = uniform(draws, -PI, PI);
                let u = Complex::from_polar(1.0, line);
                let side = AssemblyMode::of(dot(u, at - places[p]));
                builder = builder.slider(
                    &names[n],
                    &names[p],
                    (at - places[p]).norm(),
                    xy(at + u * 0.7),
                    line,
                    side,
                );
                links.push([p, n]);
                at
            }
            3 => {
                let [from, to] = links[index(draws, links.len())];
                let u = (places[to] - places[from]) / (places[to] - places[from]).norm();
                let offset = cross(u, at - places[from]);
                builder = builder.stage(Stage::Slider {
                    joint: name(n),
                    from: name(p),
                    length: (at - places[p]).norm(),
                    line: SliderLine::OnLink { along: [name(from), name(to)], offset },
                    side: AssemblyMode::of(dot(u, at - places[p])),
                });
                links.push([p, n]);
                at
            }
            _ => {
                let u = Complex::from_polar(1.0, uniform(draws, -PI, PI));
                let (to_block, to_joint) = ((places[q] - places[p]) * u.conj(), (at - places[p]) * u.conj());
                builder = builder.stage(Stage::Guide {
                    joint: name(n),
                    pivot: name(p),
                    block: name(q),
                    at: xy(to_joint),
                    offset: to_block.im,
                    side: AssemblyMode::of(to_block.re),
                });
                links.push([p, n]);
                at
            }
        };
        places.push(made);
    }
    (Linkage::Chain(Box::new(builder.build().expect("a chain"))), angle)
}

fn quantity<const N: usize>(draws: &mut Draws, low: f64, high: f64) -> Quantity<N> {
    let value = |draws: &mut Draws| std::array::from_fn(|_| uniform(draws, low, high));
    if uniform(draws, 0.0, 1.0) < 0.7 {
        return Quantity::Constant(value(draws));
    }
    let begin = uniform(draws, -PI, PI);
    Quantity::Table((0..5).map(|i| (begin + f64::from(i) * 1.1, value(draws))).collect())
}

fn place(draws: &mut Draws, joints: &[&str], bodies: &[String]) -> Place {
    match index(draws, 3) {
        0 => Place::Fixed(xy(point(draws) * 0.1)),
        1 => Place::OnBody(bodies[index(draws, bodies.len())].clone(), xy(point(draws) * 0.1)),
        _ => Place::Joint(joints[index(draws, joints.len())].to_owned()),
    }
}

/// Random loads: a mass on every moving body, and, unless they are to be conservative, forces and couples of every kind.
pub fn loads(linkage: &Linkage, seed: u64, conservative: bool) -> Loads {
    let draws = &mut stream(2300, seed);
    let mechanism = linkage.mechanism();
    let structure = mechanism.structure();
    let bodies: Vec<String> = structure.bodies.iter().skip(1).map(|body| body.name.clone()).collect();
    let joints = mechanism.joint_names();
    let mass = |draws: &mut Draws, body: &String| BodyMass {
        body: body.clone(),
        mass: Mass::Given {
            mass_kg: uniform(draws, 0.1, 3.0),
            center: xy(point(draws) * 0.1),
            inertia_kg_m2: uniform(draws, 0.0, 0.1),
        },
    };
    let mut loads = Loads { gravity: xy(point(draws) * 2.0), ..Loads::default() };
    loads.bodies = bodies.iter().map(|body| mass(draws, body)).collect();
    for _ in 0..2 {
        let ends = [place(draws, &joints, &bodies), place(draws, &joints, &bodies)];
        let (rate, free_length) = (uniform(draws, 1.0, 200.0), uniform(draws, 0.0, 0.5));
        loads.springs.push(Spring::Extension { ends, rate, free_length });
    }
    if conservative {
        return loads;
    }
    let bodies_of_springs = [bodies[index(draws, bodies.len())].clone(), "ground".to_owned()];
    let (rate, free_angle) = (uniform(draws, 0.1, 5.0), uniform(draws, -PI, PI));
    loads.springs.push(Spring::Torsion { bodies: bodies_of_springs, rate, free_angle });
    for kind in 0..4 {
        let at = match place(draws, &joints, &bodies) {
            Place::Fixed(at) => Place::OnBody(bodies[0].clone(), at),
            other => other,
        };
        let along = (kind == 1).then(|| bodies[index(draws, bodies.len())].clone());
        let vector = match kind {
            0 | 1 => ForceVector::Vector(quantity(draws, -30.0, 30.0), along),
            2 => ForceVector::Opposing(quantity(draws, 0.0, 10.0)),
            _ => ForceVector::Vector(quantity(draws, -30.0, 30.0), None),
        };
        loads.forces.push(Force { at, body: None, vector });
    }
    for _ in 0..2 {
        let body = bodies[index(draws, bodies.len())].clone();
        loads.couples.push(Couple { body, moment: quantity(draws, -3.0, 3.0) });
    }
    loads
}
