//! Counter-masses on bodies that turn about fixed pivots, for an even torque over a turn, a quiet frame, or both.
//!
//! Masses m_k >= 0 at a given radius, in [`DIRECTIONS`] directions of each body, add their torque and their force on the ground in
//! proportion to m_k at a given motion of the crank. With T - T_m the torque less its mean, and S - S_m the shaking force likewise
//! (weights press evenly, and do not shake), the masses make
//!
//! ```text
//! sum |T - T_m|^2 / sum |T_0 - T_m0|^2          or   sum |S - S_m|^2 / sum |S_0 - S_m0|^2,   or the sum of both,
//! ```
//!
//! least: non-negative least squares. Means and sums are over time: of a table of speeds over the crank angle each sample counts by
//! 1/|omega|. Masses in neighbouring directions of one body are then one: of their mass, their centre and
//! their inertia (R. S. Berkof and G. G. Lowen, A new method for completely force balancing simple linkages, ASME J. Eng. Ind. 91
//! (1969) 21-26, balance the shaking force of a four-bar by counter-masses on crank and follower: exactly, if the coupler's centre
//! lies on its line).

use super::{BalanceError, percent};
use crate::mechanism::loads::drive::Drive;
use crate::mechanism::loads::loaded::LoadedLinkage;
use crate::mechanism::loads::resolve::BodyInertia;
use crate::mechanism::loads::{BodyMass, Loads, Mass};
use crate::mechanism::structure::{GROUND, PairKind};
use crate::mechanism::{Complex, Linkage, Unit};
use crate::numbers::optimise::nonnegative::nonnegative_least_squares;
use serde::Serialize;
use std::f64::consts::TAU;

/// The directions in which masses can be put on a body.
pub const DIRECTIONS: usize = 24;
/// The number of crank angles over a turn.
const SAMPLES: usize = 360;
/// The number when a balance is verified.
const VERIFIED: usize = 1440;
/// A mass below this part of all is left out.
const LEAST_PART: f64 = 1e-6;
/// The part of a force below which it is rounding.
const ROUNDING: f64 = 1e-12;
/// The part of the unevenness that masses have to take off, at least, to be any use.
const LEAST_USE: f64 = 1e-9;

/// The quantity that counter-masses make even.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum MassAim {
    /// The torque on the crank.
    Torque,
    /// The shaking force on the ground.
    ShakingForce,
    /// Both, each in parts of its own unevenness.
    Both,
}

/// The balance that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct MassRequest {
    /// The names of the bodies: the crank, the follower, or both.
    pub bodies: Vec<String>,
    /// The distance of the masses from the fixed pivots, m.
    pub radius: f64,
    /// The quantity to be made even.
    pub aim: MassAim,
    /// The motion of the crank: a speed, or a table of speeds over its angle.
    pub drive: Drive,
}

/// A counter-mass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CounterMass {
    /// The body that carries it.
    pub body: String,
    /// The mass, kg.
    pub mass_kg: f64,
    /// The distance of its centre from the fixed pivot, m: the radius, or less where two neighbouring directions are mixed.
    pub distance_m: f64,
    /// The direction of its centre from the pivot, degrees from the body's line.
    pub direction_deg: f64,
}

/// The unevenness of torque and shaking force over a turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Unevenness {
    /// The torque of largest size, N m.
    #[serde(rename = "torque_peak_N_m")]
    pub torque_peak: f64,
    /// The root mean square of the torque less its mean, N m.
    #[serde(rename = "torque_ripple_N_m")]
    pub torque_ripple: f64,
    /// The largest shaking force less its mean, N.
    #[serde(rename = "shaking_force_N")]
    pub shaking_force: f64,
    /// The root mean square of the shaking force less its mean, N.
    #[serde(rename = "shaking_force_rms_N")]
    pub shaking_force_rms: f64,
}

/// A balance by counter-masses.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MassBalance {
    /// The counter-masses.
    pub masses: Vec<CounterMass>,
    /// Without them.
    pub before: Unevenness,
    /// With them, from the mechanics of the balanced loads.
    pub after: Unevenness,
    /// The torque's ripple that is left, percent.
    pub ripple_percent: f64,
    /// The root mean square of the shaking force that is left, percent.
    pub shaking_percent: f64,
    /// The loads with the counter-masses.
    #[serde(skip)]
    pub loads: Loads,
}

/// Torque and shaking force over a turn, each with the part of the time that the crank spends there.
struct Turn {
    torques: Vec<f64>,
    forces: Vec<Complex>,
    shares: Vec<f64>,
}

impl Turn {
    fn of(loaded: &LoadedLinkage, drive: &Drive, samples: usize) -> Result<Turn, BalanceError> {
        let mut scratch = loaded.scratch();
        let mut turn = Turn { torques: Vec::new(), forces: Vec::new(), shares: Vec::new() };
        for i in 0..samples {
            let angle = TAU * i as f64 / samples as f64;
            let balanced = loaded.balance(angle, drive.motion(angle), &mut scratch);
            balanced.map_err(|_| BalanceError::NotClosed { crank_deg: angle.to_degrees() })?;
            turn.torques.push(scratch.torque());
            turn.forces.push(scratch.shaking().0);
            turn.shares.push(drive.dwell(angle));
        }
        let time: f64 = turn.shares.iter().sum();
        turn.shares.iter_mut().for_each(|share| *share /= time);
        Ok(turn)
    }

    fn uneven_torques(&self) -> Vec<f64> {
        let mean: f64 = self.torques.iter().zip(&self.shares).map(|(torque, share)| torque * share).sum();
        self.torques.iter().map(|torque| torque - mean).collect()
    }

    /// Returns the components of the forces less their mean.
    fn uneven_forces(&self) -> Vec<f64> {
        let mean: Complex = self.forces.iter().zip(&self.shares).map(|(force, share)| force * share).sum();
        self.forces.iter().flat_map(|force| [force.re - mean.re, force.im - mean.im]).collect()
    }

    fn unevenness(&self) -> Unevenness {
        let (torques, forces) = (self.uneven_torques(), self.uneven_forces());
        // Each share is of one torque, or of the two components of a force.
        let rms = |values: &[f64]| {
            let squares = values.chunks_exact(values.len() / self.shares.len());
            let square = |values: &[f64]| values.iter().map(|x| x * x).sum::<f64>();
            squares.zip(&self.shares).map(|(values, share)| share * square(values)).sum::<f64>().sqrt()
        };
        // The force of weights alone is constant but for rounding.
        let whole = self.forces.iter().map(|force| force.norm()).fold(0.0, f64::max);
        let shakes = |force: f64| if force < ROUNDING * whole { 0.0 } else { force };
        Unevenness {
            torque_peak: self.torques.iter().fold(0.0, |most, torque| torque.abs().max(most)),
            torque_ripple: rms(&torques),
            shaking_force: shakes(
                forces.chunks_exact(2).map(|force| force[0].hypot(force[1])).fold(0.0, f64::max),
            ),
            shaking_force_rms: shakes(rms(&forces)),
        }
    }

    /// Returns what is to be made even, each quantity in parts of `scales`, so that the sum of squares is over time.
    fn rows(&self, aim: MassAim, scales: &Unevenness) -> Vec<f64> {
        let part = |values: Vec<f64>, scale: f64| {
            let each = values.len() / self.shares.len();
            let weighted = move |(i, x): (usize, f64)| x / scale * self.shares[i / each].sqrt();
            values.into_iter().enumerate().map(move |x| if scale > 0.0 { weighted(x) } else { 0.0 })
        };
        let torques = || part(self.uneven_torques(), scales.torque_ripple);
        let forces = || part(self.uneven_forces(), scales.shaking_force_rms);
        match aim {
            MassAim::Torque => torques().collect(),
            MassAim::ShakingForce => forces().collect(),
            MassAim::Both => torques().chain(forces()).collect(),
        }
    }
}

/// A body with the place of its fixed pivot in its own frame, m.
struct Pivoted {
    body: usize,
    pivot: Complex,
}

/// Computes the counter-masses that make the torque or the shaking force as even as they can.
///
/// # Errors
/// [`BalanceError`]: loads or bodies that do not fit the linkage, a crank that does not turn fully, nothing to balance, or masses
/// that are no use.
pub fn balance_by_masses(
    linkage: &Linkage,
    unit: Unit,
    loads: &Loads,
    request: &MassRequest,
) -> Result<MassBalance, BalanceError> {
    if !(request.radius > 0.0 && request.radius.is_finite()) {
        let (what, value) = ("the radius", request.radius);
        return Err(BalanceError::BadNumber { what, value, must: "above 0" });
    }
    let loaded = LoadedLinkage::new(linkage, unit, loads)?;
    if !loaded.crank_range().turns_fully {
        return Err(BalanceError::NoFullTurn);
    }
    let bodies = pivoted(&loaded, linkage, unit, request)?;
    let drive = &request.drive;
    let own = Turn::of(&loaded, drive, SAMPLES)?;
    let scales = own.unevenness();
    let rows = own.rows(request.aim, &scales);
    if rows.iter().all(|x| x.abs() < LEAST_USE) {
        return Err(BalanceError::NothingToBalance);
    }
    let mut columns = Vec::new();
    let mut sizes = Vec::new();
    for body in &bodies {
        for k in 0..DIRECTIONS {
            let center = place(body, request.radius, k);
            let name = loaded.structure().bodies[body.body].name.clone();
            let mass = Mass::Given { mass_kg: 1.0, center: [center.re, center.im], inertia_kg_m2: 0.0 };
            let bodies = vec![BodyMass { body: name, mass }];
            let alone = Loads { gravity: loads.gravity, bodies, ..Loads::default() };
            let turn = Turn::of(&LoadedLinkage::new(linkage, unit, &alone)?, drive, SAMPLES)?;
            let column = turn.rows(request.aim, &scales);
            let size = super::length(&column);
            sizes.push(size);
            columns.push(column.into_iter().map(|x| if size > 0.0 { x / size } else { 0.0 }).collect());
        }
    }
    let right: Vec<f64> = rows.iter().map(|x| -x).collect();
    let found = nonnegative_least_squares(&columns, &right);
    if found.residual >= (1.0 - LEAST_USE) * super::length(&rows) {
        return Err(BalanceError::NoMassHelps);
    }
    let masses: Vec<f64> =
        found.values.iter().zip(&sizes).map(|(m, size)| if *size > 0.0 { m / size } else { 0.0 }).collect();
    let (masses, balanced) = added(&loaded, loads, &bodies, request.radius, &masses);
    let before = Turn::of(&loaded, drive, VERIFIED)?.unevenness();
    let after = Turn::of(&LoadedLinkage::new(linkage, unit, &balanced)?, drive, VERIFIED)?.unevenness();
    Ok(MassBalance {
        masses,
        before,
        after,
        ripple_percent: percent(after.torque_ripple, before.torque_ripple),
        shaking_percent: percent(after.shaking_force_rms, before.shaking_force_rms),
        loads: balanced,
    })
}

/// Returns the place of direction `k` in the frame of a body.
fn place(body: &Pivoted, radius: f64, k: usize) -> Complex {
    body.pivot + Complex::from_polar(radius, TAU * k as f64 / DIRECTIONS as f64)
}

/// Returns the bodies that are named, each with its fixed pivot.
fn pivoted(
    loaded: &LoadedLinkage,
    linkage: &Linkage,
    unit: Unit,
    request: &MassRequest,
) -> Result<Vec<Pivoted>, BalanceError> {
    let structure = loaded.structure();
    let scale = unit.factor_to(Unit::M);
    let fixed = |body: usize| {
        let joints = structure.bodies[body].joints.iter();
        let is_pivot = |joint: usize| {
            let of_crank = body == 1 && joint == structure.crank_pivot;
            let by_pair = loaded.pairs().iter().any(|pair| {
                pair.kind == PairKind::Revolute && pair.joint == joint && pair.bodies == [GROUND, body]
            });
            of_crank || by_pair
        };
        joints.filter(|(joint, _)| is_pivot(*joint)).map(|(_, at)| at * scale).next()
    };
    let known = || {
        let all = (1..structure.bodies.len()).filter(|body| fixed(*body).is_some());
        all.map(|body| structure.bodies[body].name.clone()).collect::<Vec<_>>().join(", ")
    };
    let mut found: Vec<Pivoted> = Vec::new();
    for name in &request.bodies {
        // The name is resolved as that of a mass.
        let mass = Mass::Given { mass_kg: 0.0, center: [0.0; 2], inertia_kg_m2: 0.0 };
        let bodies = vec![BodyMass { body: name.clone(), mass }];
        let named = LoadedLinkage::new(linkage, unit, &Loads { bodies, ..Loads::default() })?;
        let Some(BodyInertia { body, .. }) = named.masses().first().copied() else { continue };
        let not_pivoted = || BalanceError::NotPivoted { name: name.clone(), known: known() };
        let pivot = fixed(body).ok_or_else(not_pivoted)?;
        if found.iter().any(|other| other.body == body) {
            return Err(BalanceError::BadBodies);
        }
        found.push(Pivoted { body, pivot });
    }
    if found.is_empty() { Err(BalanceError::BadBodies) } else { Ok(found) }
}

/// Returns the counter-masses, those of one body as one, and the loads with them.
fn added(
    loaded: &LoadedLinkage,
    loads: &Loads,
    bodies: &[Pivoted],
    radius: f64,
    masses: &[f64],
) -> (Vec<CounterMass>, Loads) {
    let least = LEAST_PART * masses.iter().sum::<f64>();
    let (mut list, mut balanced) = (Vec::new(), loads.clone());
    for (i, body) in bodies.iter().enumerate() {
        let own = masses[i * DIRECTIONS..(i + 1) * DIRECTIONS].iter().enumerate();
        let points: Vec<(f64, Complex)> =
            own.filter(|(_, m)| **m > least).map(|(k, m)| (*m, place(body, radius, k))).collect();
        let Some((mass, center, _)) = combined(&points, None) else { continue };
        let name = loaded.structure().bodies[body.body].name.clone();
        let arm = center - body.pivot;
        list.push(CounterMass {
            body: name.clone(),
            mass_kg: mass,
            distance_m: arm.norm(),
            direction_deg: arm.arg().to_degrees(),
        });
        let carried = loaded.masses().iter().position(|mass| mass.body == body.body);
        let before = carried.map(|place| loaded.masses()[place]);
        let Some((mass, center, inertia)) = combined(&points, before) else { continue };
        let all = Mass::Given { mass_kg: mass, center: [center.re, center.im], inertia_kg_m2: inertia };
        match carried {
            // Masses are resolved in their order.
            Some(place) => balanced.bodies[place].mass = all,
            None => balanced.bodies.push(BodyMass { body: name, mass: all }),
        }
    }
    (list, balanced)
}

/// Returns mass, centre and inertia of points and a body together; `None` of nothing.
fn combined(points: &[(f64, Complex)], body: Option<BodyInertia>) -> Option<(f64, Complex, f64)> {
    let mut all: Vec<(f64, Complex, f64)> = points.iter().map(|(m, at)| (*m, *at, 0.0)).collect();
    all.extend(body.map(|body| (body.mass, body.center, body.inertia)));
    let mass: f64 = all.iter().map(|(m, ..)| m).sum();
    if mass <= 0.0 {
        return None;
    }
    let center = all.iter().map(|(m, at, _)| at * *m).sum::<Complex>() / mass;
    let inertia = all.iter().map(|(m, at, inertia)| inertia + m * (at - center).norm_sqr()).sum();
    Some((mass, center, inertia))
}
