//! A linkage with its loads, prepared for many positions.

use super::Loads;
use super::applied::{Applied, Wrench};
use super::drive::Drive;
use super::error::{LoadError, LoadFault, LoadKey};
use super::instant::{Instant, JointForce};
use super::kinematics::{Kinematics, Source};
use super::newton::{Reaction, balance};
use super::resolve::{BodyInertia, Names, Resolved, SpringOn};
use crate::mechanism::any::{CrankRange, Mechanism, Status};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::structure::{Body, GROUND, OutputBody, Pair, PairKind, Structure};
use crate::mechanism::{Complex, Linkage, MultiLoop, Unit, dot, multi_loop, plates};

/// A linkage with its loads: names are resolved, lengths in metres.
///
/// ```
/// use linkwright::internals::mechanism::loads::{BodyMass, LoadedLinkage, Loads, Mass};
/// use linkwright::analysis::CrankMotion;
/// use linkwright::{AssemblyMode, Linkage, SliderCrank, SliderCrankParameters, Unit};
/// let linkage = Linkage::SliderCrank(SliderCrank::new(SliderCrankParameters {
///     crank_pivot: [0.0, 0.0], crank: 20.0, coupler: 60.0, line_point: [0.0, 0.0], line_deg: 0.0,
///     coupler_x: 60.0, coupler_y: 0.0, assembly: AssemblyMode::Plus,
/// })?);
/// // A crank of 2 kg with its centre 10 mm from A: it takes m g r cos(phi) to hold it.
/// let mass = Mass::Given { mass_kg: 2.0, center: [0.01, 0.0], inertia_kg_m2: 0.0 };
/// let bodies = vec![BodyMass { body: "crank".into(), mass }];
/// let loads = Loads { gravity: [0.0, -9.81], bodies, ..Loads::default() };
/// let loaded = LoadedLinkage::new(&linkage, Unit::Mm, &loads)?;
/// let still = CrankMotion::steady(0.0);
/// let torque = loaded.torque(1.0, still, &mut loaded.scratch()).expect("a definite position");
/// assert!((torque - 2.0 * 9.81 * 0.01 * 1f64.cos()).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LoadedLinkage {
    source: Source,
    structure: Structure,
    pairs: Vec<Pair>,
    joints: Vec<String>,
    traced: usize,
    scale: f64,
    loads: Resolved,
}

/// Buffers for one position, from [`LoadedLinkage::scratch`].
#[derive(Clone, Debug)]
pub struct Scratch {
    places: Kinematics,
    wrenches: Vec<Wrench>,
    reactions: Vec<Reaction>,
    torque: f64,
    applied: Applied,
}

impl Scratch {
    /// Returns the torque on the crank by Newton-Euler, N m.
    pub fn torque(&self) -> f64 {
        self.torque
    }

    /// Returns the forces of all pairs on their first bodies, in the order of [`LoadedLinkage::pairs`].
    pub fn reactions(&self) -> &[Reaction] {
        &self.reactions
    }

    /// Returns joints and bodies at the position.
    pub(super) fn places(&self) -> &Kinematics {
        &self.places
    }

    /// Returns the shaking force (N), and the shaking moment about the crank's pivot with the motor's own (N m).
    pub fn shaking(&self) -> (Complex, f64) {
        let Wrench { force, moment } = self.wrenches[GROUND];
        (force, moment - self.torque)
    }
}

/// The virtual work of masses for a turn of the crank, over that turn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Inertial {
    /// sum m a . z' + I alpha omega', N m.
    work: f64,
    /// The sum of the magnitudes of its terms.
    size: f64,
    /// sum m |z'|^2 + I omega'^2, kg m^2.
    reflected: f64,
}

/// Returns the names of the plates of a chain that is a six-bar or an eight-bar, in the order of its bodies, so that loads of a problem
/// also fit the files of its results; empty for others.
fn plate_names(linkage: &Linkage, structure: &Structure, joints: &[String]) -> Vec<&'static str> {
    let Linkage::Chain(chain) = linkage else { return Vec::new() };
    let Ok(known) = MultiLoop::from_chain(chain) else { return Vec::new() };
    let links = known.links();
    let name = |body: &Body| {
        let carries = |name: &str| body.joints.iter().any(|(joint, _)| joints[*joint] == name);
        let is_it = |link: &&multi_loop::Body| {
            link.joints.len() == body.joints.len() && link.joints.iter().all(|(name, _)| carries(name))
        };
        links.iter().find(is_it).map_or("", |link| plates::Link::OF_BODIES[link.body].name())
    };
    structure.bodies.iter().map(name).collect()
}

impl LoadedLinkage {
    /// Resolves the names of loads against a linkage whose lengths are in a unit.
    ///
    /// # Errors
    /// [`LoadError`] with the load, the key and the fault: a name that the linkage does not have, a mass on the ground, a number
    /// that is not finite or may not be negative, a spring between two places of one body, a table out of order.
    pub fn new(linkage: &Linkage, unit: Unit, loads: &Loads) -> Result<Self, LoadError> {
        LoadedLinkage::scaled(linkage, unit.factor_to(Unit::M), loads)
    }

    /// Resolves the names of loads against a linkage whose unit of length is so many metres.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn scaled(linkage: &Linkage, metres: f64, loads: &Loads) -> Result<Self, LoadError> {
        let no_chain = || LoadError { key: LoadKey::Top("linkage"), fault: LoadFault::NoChain };
        let source = Source::of(linkage).ok_or_else(no_chain)?;
        let mechanism = linkage.mechanism();
        let structure = mechanism.structure();
        let joints: Vec<String> = mechanism.joint_names().into_iter().map(str::to_owned).collect();
        let scale = metres;
        let others = plate_names(linkage, &structure, &joints);
        let loads =
            Names { structure: &structure, joints: &joints, others: &others, scale }.resolve(loads)?;
        let (pairs, traced) = (structure.pairs().collect(), mechanism.traced());
        Ok(LoadedLinkage { source, structure, pairs, joints, traced, scale, loads })
    }

    /// Allocates buffers for positions.
    pub fn scratch(&self) -> Scratch {
        Scratch {
            places: Kinematics::new(&self.source, &self.structure, self.joints.len()),
            wrenches: vec![Wrench::default(); self.structure.bodies.len()],
            reactions: vec![[0.0; 2]; self.pairs.len()],
            torque: 0.0,
            applied: Applied::default(),
        }
    }

    /// Returns the pairs, in the order of [`Scratch::reactions`].
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Returns the springs.
    pub(super) fn springs(&self) -> &[SpringOn] {
        &self.loads.springs
    }

    /// Returns the masses, in the order of [`Loads::bodies`].
    pub(super) fn masses(&self) -> &[BodyInertia] {
        &self.loads.masses
    }

    /// Returns the bodies and pairs of the linkage.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Returns the range of the crank.
    pub fn crank_range(&self) -> CrankRange {
        match &self.source {
            Source::Loop(linkage) => linkage.mechanism().crank_range(),
            Source::Chain(chain) => chain.crank_range(),
        }
    }

    /// Returns the motion of the crank at the speed of the loads; it stands still without one.
    pub fn drive(&self) -> &Drive {
        &self.loads.drive
    }

    /// Returns the output; `None` of kinds without a certain one.
    pub fn output(&self) -> Option<OutputBody> {
        self.structure.output
    }

    /// Places the linkage and adds all loads but inertia to the wrenches.
    fn load(&self, crank_angle: f64, input: CrankMotion, scratch: &mut Scratch) -> Result<(), Status> {
        scratch.places.place(&self.source, &self.structure, self.scale, crank_angle)?;
        scratch.wrenches.fill(Wrench::default());
        let sense = if input.speed_rad_s < 0.0 { -1.0 } else { 1.0 };
        scratch.applied = self.loads.apply(crank_angle, sense, &scratch.places, &mut scratch.wrenches);
        Ok(())
    }

    /// Computes the virtual work of the masses at a position.
    fn inertial(&self, input: CrankMotion, places: &Kinematics) -> Inertial {
        let mut sums = Inertial::default();
        for mass in &self.loads.masses {
            let body = &places.bodies[mass.body];
            let center = body.point(mass.center);
            let terms = [
                mass.mass * dot(center.acceleration(input), center.first),
                mass.inertia * body.acceleration(input) * body.first,
            ];
            sums.work += terms[0] + terms[1];
            sums.size += terms[0].abs() + terms[1].abs();
            sums.reflected += mass.mass * center.first.norm_sqr() + mass.inertia * body.first * body.first;
        }
        sums
    }

    /// Computes the torque on the crank (N m, counter-clockwise positive) by the power balance, without any joint force, at a crank
    /// angle (radians) and the crank's motion (0: statics).
    ///
    /// # Errors
    /// The status of a position that is open, undetermined or at a toggle.
    pub fn torque(&self, crank_angle: f64, input: CrankMotion, scratch: &mut Scratch) -> Result<f64, Status> {
        self.torque_and_size(crank_angle, input, scratch).map(|(torque, _)| torque)
    }

    /// Computes the torque as [`torque`](Self::torque) does, with the sum of the magnitudes of its terms, of which the torque can be
    /// a small rest.
    ///
    /// # Errors
    /// As [`torque`](Self::torque).
    pub fn torque_and_size(
        &self,
        crank_angle: f64,
        input: CrankMotion,
        scratch: &mut Scratch,
    ) -> Result<(f64, f64), Status> {
        self.load(crank_angle, input, scratch)?;
        let (inertial, applied) = (self.inertial(input, &scratch.places), scratch.applied);
        let torque = inertial.work - applied.work;
        torque.is_finite().then_some((torque, inertial.size + applied.size)).ok_or(Status::NotFinite)
    }

    /// Computes torque and joint forces by Newton-Euler at a crank angle (radians) and the crank's motion; they are then in the
    /// buffers. Allocates nothing for chains and linkages of several loops.
    ///
    /// # Errors
    /// As [`torque`](Self::torque).
    pub fn balance(&self, crank_angle: f64, input: CrankMotion, scratch: &mut Scratch) -> Result<(), Status> {
        self.load(crank_angle, input, scratch)?;
        for mass in &self.loads.masses {
            let body = &scratch.places.bodies[mass.body];
            let center = body.point(mass.center);
            let wrench = &mut scratch.wrenches[mass.body];
            wrench.add(-center.acceleration(input) * mass.mass, center.at - body.origin.at);
            wrench.moment -= mass.inertia * body.acceleration(input);
        }
        let Scratch { places, wrenches, reactions, .. } = scratch;
        scratch.torque = balance(&self.structure, places, wrenches, reactions).ok_or(Status::Singular)?;
        Ok(())
    }

    /// Computes the inertia of all bodies reflected to the crank, twice the kinetic energy at 1 rad/s (kg m^2), at the position in
    /// the buffers.
    pub fn reflected_inertia(&self, scratch: &Scratch) -> f64 {
        self.inertial(CrankMotion::steady(0.0), &scratch.places).reflected
    }

    /// Returns the potential energy (J) of gravity and springs at the position in the buffers.
    pub fn potential(&self, scratch: &Scratch) -> f64 {
        scratch.applied.potential
    }

    /// Returns the mechanical advantage at the traced point (1/m) and at the output at the position in the buffers; `None` where
    /// they stand still.
    ///
    /// Without loss T_crank omega = F v, so that F/T is 1/|dP/dphi|; of the output 1/|dtheta/dphi|, or 1/|ds/dphi| of a slider.
    pub fn advantage(&self, scratch: &Scratch) -> [Option<f64>; 2] {
        let places = &scratch.places;
        let output = self.structure.output.map(|output| match output {
            OutputBody::Turns(body) => places.bodies[body].first,
            OutputBody::Slides(body) => dot(places.bodies[body].origin.first, places.bodies[body].direction),
        });
        let rates = [Some(places.joints[self.traced].first.norm()), output.map(f64::abs)];
        rates.map(|rate| rate.map(|rate| 1.0 / rate).filter(|advantage| advantage.is_finite()))
    }

    /// Returns the names of a pair's joint, of the body on which its force acts, and of the other body.
    pub fn names(&self, pair: &Pair) -> [&str; 3] {
        let body = |i: usize| self.structure.bodies[pair.bodies[i]].name.as_str();
        [self.joints[pair.joint].as_str(), body(0), body(1)]
    }

    /// Computes everything at a crank angle (radians), as data.
    ///
    /// # Errors
    /// As [`torque`](Self::torque).
    pub fn at(&self, crank_angle: f64, input: CrankMotion, scratch: &mut Scratch) -> Result<Instant, Status> {
        self.balance(crank_angle, input, scratch)?;
        let force = |(pair, [x, y]): (&Pair, &Reaction)| {
            let [at, on, from] = self.names(pair).map(str::to_owned);
            let is_pin = pair.kind == PairKind::Revolute;
            JointForce {
                at,
                on,
                from,
                force: is_pin.then_some([*x, *y]),
                normal: (!is_pin).then_some(*x),
                moment: (!is_pin).then_some(*y),
            }
        };
        let (shaking, shaking_moment) = scratch.shaking();
        let [advantage, output_advantage] = self.advantage(scratch);
        let kinetic = 0.5 * self.reflected_inertia(scratch) * input.speed_rad_s * input.speed_rad_s;
        Ok(Instant {
            input: None,
            torque: scratch.torque,
            power: scratch.torque * input.speed_rad_s,
            forces: self.pairs.iter().zip(&scratch.reactions).map(force).collect(),
            shaking_force: [shaking.re, shaking.im],
            shaking_moment,
            kinetic,
            potential: scratch.applied.potential,
            advantage,
            output_advantage,
        })
    }
}
