//! Names of bodies and joints resolved against a linkage, and masses of plates from their outlines.

use super::drive::Drive;
use super::error::{LoadError, LoadFault, LoadKey};
use super::{Couple, Force, ForceVector, Loads, Mass, Place, Quantity, Spring};
use crate::mechanism::plates::moments::Moments;
use crate::mechanism::structure::{GROUND, Structure};
use crate::mechanism::{Complex, point};

/// A body's mass, m and I in kg and kg m^2, with the centre along and across the body in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BodyInertia {
    pub(super) body: usize,
    pub(super) mass: f64,
    pub(super) center: Complex,
    pub(super) inertia: f64,
}

/// A place on a body, or fixed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Spot {
    Joint(usize),
    Fixed(Complex),
    OnBody(Complex),
}

/// A place and the body that bears the force there; the ground of a fixed one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Support {
    pub(super) body: usize,
    pub(super) spot: Spot,
}

/// A force with its body.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ForceOn {
    pub(super) at: Support,
    pub(super) vector: Vector,
}

/// A force's direction.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Vector {
    /// Along and across a body: x and y of the ground.
    Along(Quantity<2>, usize),
    /// Against the velocity.
    Opposing(Quantity<1>),
}

/// A spring with its bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SpringOn {
    Extension { ends: [Support; 2], rate: f64, free_length: f64 },
    Torsion { bodies: [usize; 2], rate: f64, free_angle: f64 },
}

/// Loads with indices of bodies and joints.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Resolved {
    pub(super) drive: Drive,
    pub(super) gravity: Complex,
    pub(super) masses: Vec<BodyInertia>,
    pub(super) forces: Vec<ForceOn>,
    pub(super) couples: Vec<(usize, Quantity<1>)>,
    pub(super) springs: Vec<SpringOn>,
}

/// The names of a linkage.
pub(super) struct Names<'a> {
    pub(super) structure: &'a Structure,
    pub(super) joints: &'a [String],
    /// The names that the bodies have beside their own, in their order: those of a six-bar's plates of a chain that is one.
    pub(super) others: &'a [&'static str],
    /// Metres in the linkage's unit.
    pub(super) scale: f64,
}

type Checked<T> = Result<T, LoadError>;

fn error<T>(key: LoadKey, fault: LoadFault) -> Checked<T> {
    Err(LoadError { key, fault })
}

fn finite(key: LoadKey, values: &[f64]) -> Checked<()> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(value) => error(key, LoadFault::NotFinite(*value)),
        None => Ok(()),
    }
}

fn not_negative(key: LoadKey, value: f64) -> Checked<()> {
    finite(key.clone(), &[value])?;
    if value < 0.0 { error(key, LoadFault::Negative(value)) } else { Ok(()) }
}

fn quantity<const N: usize>(key: &LoadKey, value: &Quantity<N>) -> Checked<()> {
    value.check().or_else(|fault| error(key.clone(), fault))
}

impl Names<'_> {
    /// Resolves all names of loads.
    ///
    /// # Errors
    /// [`LoadError`], the first in the order of [`Loads`].
    pub(super) fn resolve(&self, loads: &Loads) -> Checked<Resolved> {
        finite(LoadKey::Top("gravity"), &loads.gravity)?;
        let drive = match loads.speed_rad_s.as_ref().map_or_else(|| Ok(Drive::still()), Drive::of) {
            Ok(drive) => drive,
            Err(fault) => return error(LoadKey::Top("speed"), fault),
        };
        let mut found = Resolved {
            drive,
            gravity: point(loads.gravity),
            masses: Vec::new(),
            forces: Vec::new(),
            couples: Vec::new(),
            springs: Vec::new(),
        };
        let mut named: Vec<usize> = Vec::new();
        for load in &loads.bodies {
            let key = |key| LoadKey::Body(load.body.clone(), key);
            let body = self.moving_body(key(""), &load.body)?;
            // A mass under the name of a point is beside that of the body that carries it.
            let of_point = self.names_its_body(&load.body);
            if !of_point && named.contains(&body) {
                return error(key(""), LoadFault::SecondMass(load.body.clone()));
            }
            if !of_point {
                named.push(body);
            }
            found.masses.push(self.inertia(&load.body, body, &load.mass)?);
        }
        for (i, force) in loads.forces.iter().enumerate() {
            found.forces.push(self.force(i, force)?);
        }
        for (i, Couple { body, moment }) in loads.couples.iter().enumerate() {
            let body = self.moving_body(LoadKey::Couple(i, "body"), body)?;
            quantity(&LoadKey::Couple(i, "moment_N_m"), moment)?;
            found.couples.push((body, moment.clone()));
        }
        for (i, spring) in loads.springs.iter().enumerate() {
            found.springs.push(self.spring(i, spring)?);
        }
        Ok(found)
    }

    fn body_names(&self) -> Vec<String> {
        self.structure.bodies.iter().map(|body| body.name.clone()).collect()
    }

    /// Returns the body of a name: its own, `crank`, `ground`, two joints of it such as C-D, or a point that it alone carries such as
    /// P.
    fn body(&self, key: LoadKey, name: &str) -> Checked<usize> {
        let bodies = &self.structure.bodies;
        let own = bodies.iter().position(|body| body.name == name);
        if let Some(body) =
            own.or_else(|| self.others.iter().position(|other| !name.is_empty() && *other == name))
        {
            return Ok(body);
        }
        if name == "crank" && bodies.len() > 1 {
            return Ok(1);
        }
        let names_it = |body: usize| {
            let joints: Vec<&str> =
                bodies[body].joints.iter().map(|(joint, _)| self.joints[*joint].as_str()).collect();
            let is_pair = |p: &&str| joints.iter().any(|q| p != q && format!("{p}-{q}") == name);
            let carries = |p: &&str| *p == name && self.names_its_body(name);
            joints.join("-") == name || joints.iter().any(is_pair) || joints.iter().any(carries)
        };
        let mut found = (1..bodies.len()).filter(|body| names_it(*body));
        match (found.next(), found.next()) {
            (Some(body), None) => Ok(body),
            _ => error(key, LoadFault::UnknownBody { name: name.to_owned(), known: self.body_names() }),
        }
    }

    /// Returns whether a name is that of a point which one body alone carries.
    fn names_its_body(&self, name: &str) -> bool {
        let joint = self.joints.iter().position(|joint| joint == name);
        joint.is_some_and(|joint| self.structure.carriers(joint).count() == 1)
    }

    fn moving_body(&self, key: LoadKey, name: &str) -> Checked<usize> {
        match self.body(key.clone(), name)? {
            GROUND => error(key, LoadFault::OnGround),
            body => Ok(body),
        }
    }

    fn joint(&self, key: LoadKey, name: &str) -> Checked<usize> {
        let found = self.joints.iter().position(|joint| joint == name);
        let fault = || LoadFault::UnknownJoint { name: name.to_owned(), known: self.joints.to_vec() };
        found.map_or_else(|| error(key, fault()), Ok)
    }

    fn inertia(&self, name: &str, body: usize, mass: &Mass) -> Checked<BodyInertia> {
        let key = |key| LoadKey::Body(name.to_owned(), key);
        match *mass {
            Mass::AtJoint { mass_kg, ref joint, inertia_kg_m2 } => {
                not_negative(key("mass_kg"), mass_kg)?;
                not_negative(key("inertia_kg_m2"), inertia_kg_m2)?;
                let place = self.joint(key("at"), joint)?;
                let own = self.structure.bodies[body].joints.iter().find(|(joint, _)| *joint == place);
                let Some((_, center)) = own else {
                    let names = self.body_names();
                    let carriers = self.structure.carriers(place).map(|body| names[body].clone()).collect();
                    let (joint, body) = (joint.clone(), name.to_owned());
                    return error(key("at"), LoadFault::NotOnBody { joint, body, carriers });
                };
                Ok(BodyInertia { body, mass: mass_kg, center: center * self.scale, inertia: inertia_kg_m2 })
            }
            Mass::Given { mass_kg, center, inertia_kg_m2 } => {
                not_negative(key("mass_kg"), mass_kg)?;
                finite(key("center"), &center)?;
                not_negative(key("inertia_kg_m2"), inertia_kg_m2)?;
                Ok(BodyInertia { body, mass: mass_kg, center: point(center), inertia: inertia_kg_m2 })
            }
            Mass::Plate { density_kg_m3, thickness, width } => {
                not_negative(key("density_kg_m3"), density_kg_m3)?;
                not_negative(key("thickness"), thickness)?;
                not_negative(key("width"), width)?;
                let shape = &self.structure.bodies[body];
                if !shape.is_plain {
                    return error(key("density_kg_m3"), LoadFault::NoPlate(name.to_owned()));
                }
                let places: Vec<Complex> = shape.joints.iter().map(|(_, at)| at * self.scale).collect();
                let Moments { area, centroid, polar } = Moments::around(&places, 0.5 * width);
                let per_area = density_kg_m3 * thickness;
                Ok(BodyInertia { body, mass: per_area * area, center: centroid, inertia: per_area * polar })
            }
        }
    }

    /// Returns a place, and the body that bears a force there: the first that moves, or the one of a name.
    fn support(&self, key: &LoadKey, place: &Place, on: Option<(LoadKey, &str)>) -> Checked<Support> {
        match place {
            Place::Fixed(at) => {
                finite(key.clone(), at)?;
                Ok(Support { body: GROUND, spot: Spot::Fixed(point(*at)) })
            }
            Place::OnBody(name, at) => {
                finite(key.clone(), at)?;
                let body = self.body(key.clone(), name)?;
                // The ground's own frame is the plane's.
                let spot = if body == GROUND { Spot::Fixed(point(*at)) } else { Spot::OnBody(point(*at)) };
                Ok(Support { body, spot })
            }
            Place::Joint(name) => {
                let joint = self.joint(key.clone(), name)?;
                let carriers: Vec<usize> = self.structure.carriers(joint).collect();
                let body = match on {
                    None => carriers.iter().copied().find(|body| *body != GROUND).unwrap_or(GROUND),
                    Some((on_key, on)) => {
                        let body = self.body(on_key.clone(), on)?;
                        if !carriers.contains(&body) {
                            let names = self.body_names();
                            let carriers = carriers.iter().map(|body| names[*body].clone()).collect();
                            let (joint, body) = (name.clone(), on.to_owned());
                            return error(on_key, LoadFault::NotOnBody { joint, body, carriers });
                        }
                        body
                    }
                };
                Ok(Support { body, spot: Spot::Joint(joint) })
            }
        }
    }

    fn force(&self, i: usize, force: &Force) -> Checked<ForceOn> {
        let key = LoadKey::Force(i, "at");
        if matches!(force.at, Place::Fixed(_)) {
            return error(key, LoadFault::ForceAtFixedPoint);
        }
        let on = force.body.as_deref().map(|body| (LoadKey::Force(i, "body"), body));
        let at = self.support(&key, &force.at, on)?;
        if at.body == GROUND {
            return error(key, LoadFault::OnGround);
        }
        let vector = match &force.vector {
            ForceVector::Vector(value, along) => {
                quantity(&LoadKey::Force(i, "force_N"), value)?;
                let along = along.as_ref().map(|name| self.body(LoadKey::Force(i, "along"), name));
                Vector::Along(value.clone(), along.transpose()?.unwrap_or(GROUND))
            }
            ForceVector::Opposing(value) => {
                let key = LoadKey::Force(i, "opposing_N");
                quantity(&key, value)?;
                let sizes: Vec<f64> = match value {
                    Quantity::Constant([size]) => vec![*size],
                    Quantity::Table(rows) => rows.iter().map(|(_, [size])| *size).collect(),
                };
                sizes.into_iter().try_for_each(|size| not_negative(key.clone(), size))?;
                Vector::Opposing(value.clone())
            }
        };
        Ok(ForceOn { at, vector })
    }

    fn spring(&self, i: usize, spring: &Spring) -> Checked<SpringOn> {
        match spring {
            Spring::Extension { ends, rate, free_length } => {
                not_negative(LoadKey::Spring(i, "rate_N_per_m"), *rate)?;
                not_negative(LoadKey::Spring(i, "free_length"), *free_length)?;
                let from = self.support(&LoadKey::Spring(i, "from"), &ends[0], None)?;
                let to = self.support(&LoadKey::Spring(i, "to"), &ends[1], None)?;
                let carriers = |end: &Support| match end.spot {
                    Spot::Joint(joint) => self.structure.carriers(joint).collect(),
                    Spot::Fixed(_) | Spot::OnBody(_) => vec![end.body],
                };
                let on = [carriers(&from), carriers(&to)];
                if on[0].iter().any(|body| on[1].contains(body)) {
                    return error(LoadKey::Spring(i, "to"), LoadFault::SameEnds);
                }
                // A force at a fixed pivot goes straight to the ground.
                let mut ends = [from, to];
                for (end, _) in ends.iter_mut().zip(&on).filter(|(_, on)| on.contains(&GROUND)) {
                    end.body = GROUND;
                }
                Ok(SpringOn::Extension { ends, rate: *rate, free_length: *free_length })
            }
            Spring::Torsion { bodies, rate, free_angle } => {
                not_negative(LoadKey::Spring(i, "rate_N_m_per_rad"), *rate)?;
                finite(LoadKey::Spring(i, "free_angle_deg"), &[*free_angle])?;
                let body = self.body(LoadKey::Spring(i, "body"), &bodies[0])?;
                let against = self.body(LoadKey::Spring(i, "against"), &bodies[1])?;
                if body == against {
                    return error(LoadKey::Spring(i, "against"), LoadFault::SameBodies);
                }
                let (rate, free_angle) = (*rate, *free_angle);
                Ok(SpringOn::Torsion { bodies: [body, against], rate, free_angle })
            }
        }
    }
}
