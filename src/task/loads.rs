//! Loads of a problem: the same for every candidate, by the names that the bodies and joints of its kind have.

use super::similarity::Similarity;
use crate::mechanism::loads::{
    Couple, CrankSpeed, Force, ForceVector, LoadError, LoadedLinkage, Loads, Mass, Place, Quantity, Spring,
};
use crate::mechanism::{CrankLinkage, Linkage};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The name of the ground as a body.
const GROUND: &str = "ground";

/// The loads of a problem, with the length of its unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LoadsSpec {
    /// The problem's unit of length, in metres.
    #[serde(rename = "unit_m")]
    pub metres: f64,
    /// The loads, in SI units.
    #[serde(flatten)]
    pub applied: Loads,
}

impl LoadsSpec {
    /// Returns a linkage of the problem under these loads.
    ///
    /// # Errors
    /// [`LoadError`] if the linkage lacks a body or a joint that they name.
    pub fn on(&self, linkage: &CrankLinkage) -> Result<LoadedLinkage, LoadError> {
        LoadedLinkage::scaled(&Linkage::from(*linkage), self.metres, &self.applied)
    }

    /// Returns the loads of the problem's image under a similarity: its lengths in metres, masses and torques are the same, a
    /// mirror image turns the sense of rotation.
    #[must_use]
    pub fn placed(&self, by: &Similarity) -> Self {
        let image = Image { by, from: self.metres, to: self.metres / by.scale };
        let Loads { gravity, speed_rad_s, bodies, forces, couples, springs } = &self.applied;
        let mut bodies = bodies.clone();
        for body in &mut bodies {
            if let Mass::Given { center, .. } = &mut body.mass {
                *center = image.across(*center);
            }
        }
        let applied = Loads {
            gravity: by.turned(*gravity),
            speed_rad_s: image.speed(speed_rad_s.as_ref(), forces),
            bodies,
            forces: forces.iter().map(|force| image.force(force)).collect(),
            couples: couples.iter().map(|couple| image.couple(couple)).collect(),
            springs: springs.iter().map(|spring| image.spring(spring)).collect(),
        };
        LoadsSpec { metres: image.to, applied }
    }
}

/// A similarity with the lengths of the unit before and after it, in metres.
struct Image<'a> {
    by: &'a Similarity,
    from: f64,
    to: f64,
}

impl Image<'_> {
    /// Returns the image of a vector in the frame of a body that moves.
    fn across(&self, [along, across]: [f64; 2]) -> [f64; 2] {
        [along, if self.by.mirrors { -across } else { across }]
    }

    /// Returns the image of an angle or a moment, counter-clockwise positive.
    fn sense(&self, value: f64) -> f64 {
        if self.by.mirrors { -value } else { value }
    }

    /// Returns the image of a fixed point, both in metres.
    fn fixed(&self, point: [f64; 2]) -> [f64; 2] {
        self.by.point(point.map(|x| x / self.from)).map(|x| x * self.to)
    }

    /// Returns the image of the speed. Forces that oppose a velocity take a crank that stands still for one that turns
    /// counter-clockwise; its mirror image turns clockwise, at a speed whose square is 0.
    fn speed(&self, speed: Option<&CrankSpeed>, forces: &[Force]) -> Option<CrankSpeed> {
        let has_sense = forces.iter().any(|force| matches!(force.vector, ForceVector::Opposing(_)));
        match speed.filter(|speed| **speed != CrankSpeed::Steady(0.0)) {
            None if self.by.mirrors && has_sense => Some(CrankSpeed::Steady(-f64::MIN_POSITIVE)),
            None => speed.cloned(),
            Some(speed) => Some(speed.turned(self.by.degrees(0.0).to_radians(), self.by.mirrors)),
        }
    }

    fn place(&self, place: &Place) -> Place {
        match place {
            Place::Joint(_) => place.clone(),
            Place::Fixed(at) => Place::Fixed(self.fixed(*at)),
            Place::OnBody(body, at) if body == GROUND => Place::OnBody(body.clone(), self.fixed(*at)),
            Place::OnBody(body, at) => Place::OnBody(body.clone(), self.across(*at)),
        }
    }

    /// Returns the image of a quantity over the crank angle.
    fn over<const N: usize>(
        &self,
        quantity: &Quantity<N>,
        value: impl FnMut([f64; N]) -> [f64; N],
    ) -> Quantity<N> {
        quantity.map(value).turned(self.by.degrees(0.0).to_radians(), self.by.mirrors)
    }

    fn force(&self, force: &Force) -> Force {
        let vector = match &force.vector {
            ForceVector::Vector(value, along) => {
                let on_ground = along.as_deref().is_none_or(|body| body == GROUND);
                let turn = |v| if on_ground { self.by.turned(v) } else { self.across(v) };
                ForceVector::Vector(self.over(value, turn), along.clone())
            }
            ForceVector::Opposing(value) => ForceVector::Opposing(self.over(value, |v| v)),
        };
        Force { at: self.place(&force.at), body: force.body.clone(), vector }
    }

    fn couple(&self, Couple { body, moment }: &Couple) -> Couple {
        Couple { body: body.clone(), moment: self.over(moment, |[m]| [self.sense(m)]) }
    }

    fn spring(&self, spring: &Spring) -> Spring {
        match spring {
            Spring::Extension { ends, rate, free_length } => Spring::Extension {
                ends: ends.each_ref().map(|end| self.place(end)),
                rate: *rate,
                free_length: *free_length,
            },
            Spring::Torsion { bodies, rate, free_angle } => {
                // The ground's direction does not turn with the plane.
                let turn = self.by.degrees(0.0).to_radians();
                let of_ground = |i: usize| if bodies[i] == GROUND { turn } else { 0.0 };
                let free_angle = self.sense(*free_angle) + of_ground(1) - of_ground(0);
                Spring::Torsion { bodies: bodies.clone(), rate: *rate, free_angle }
            }
        }
    }
}
