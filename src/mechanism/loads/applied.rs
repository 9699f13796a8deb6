//! Forces, couples and springs at one position: the wrench that they put on each body, their virtual work for a turn of the
//! crank, and the potential energy of gravity and springs.
//!
//! ```text
//! gravity   F = m g                                          at G            V = -m <g, G>
//! spring    F = -k (l - l0) (p - q)/l, l = |p - q|           at p, -F at q   V = k (l - l0)^2/2
//! torsion   M = -k w, w = theta_i - theta_j - theta_0        on i, -M on j   V = k w^2/2
//! ```
//!
//! w lies in (-pi, pi]. A spring of length 0 has no direction, and no force.

use super::kinematics::{BodyState, Kinematics, Moving};
use super::resolve::{Resolved, Spot, SpringOn, Support, Vector};
use crate::mechanism::{Complex, cross, dot};

/// Force and moment on a body, the moment about the body's origin.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Wrench {
    pub(super) force: Complex,
    pub(super) moment: f64,
}

impl Wrench {
    /// Adds a force at a point, `arm` from the origin.
    pub(super) fn add(&mut self, force: Complex, arm: Complex) {
        self.force += force;
        self.moment += cross(arm, force);
    }
}

/// Sums over all applied loads at one position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Applied {
    /// The virtual work for a turn of the crank by dphi, over dphi: sum F . z' + sum M omega', N m.
    pub(super) work: f64,
    /// The sum of the magnitudes of its terms, against which rounding is judged.
    pub(super) size: f64,
    /// The potential energy of gravity and springs, J.
    pub(super) potential: f64,
}

impl Applied {
    fn count(&mut self, term: f64) {
        self.work += term;
        self.size += term.abs();
    }
}

/// Returns the motion of a place.
fn moving(at: &Support, places: &Kinematics) -> Moving {
    match at.spot {
        Spot::Joint(joint) => places.joints[joint],
        Spot::Fixed(at) => Moving::still(at),
        Spot::OnBody(place) => places.bodies[at.body].point(place),
    }
}

/// Returns the angle of one body's direction from another's beyond a free angle, in (-pi, pi].
pub(super) fn deflection(of: &BodyState, from: &BodyState, free_angle: f64) -> f64 {
    (of.direction * from.direction.conj() * Complex::from_polar(1.0, -free_angle)).arg()
}

impl Resolved {
    /// Adds all applied loads at a crank angle to the wrenches of the bodies. `sense` is the sign of the crank's speed.
    pub(super) fn apply(
        &self,
        crank_angle: f64,
        sense: f64,
        places: &Kinematics,
        wrenches: &mut [Wrench],
    ) -> Applied {
        let mut sums = Applied::default();
        let mut push = |body: usize, force: Complex, point: &Moving, sums: &mut Applied| {
            wrenches[body].add(force, point.at - places.bodies[body].origin.at);
            sums.count(dot(force, point.first));
        };
        for mass in &self.masses {
            let center = places.bodies[mass.body].point(mass.center);
            let weight = self.gravity * mass.mass;
            push(mass.body, weight, &center, &mut sums);
            sums.potential -= dot(weight, center.at);
        }
        for force in &self.forces {
            let point = moving(&force.at, places);
            let vector = match &force.vector {
                Vector::Along(value, body) => {
                    let [along, across] = value.at(crank_angle);
                    places.bodies[*body].direction * Complex::new(along, across)
                }
                Vector::Opposing(value) => {
                    let (speed, [size]) = (point.first.norm(), value.at(crank_angle));
                    if speed > 0.0 { -point.first * (sense * size / speed) } else { Complex::new(0.0, 0.0) }
                }
            };
            push(force.at.body, vector, &point, &mut sums);
        }
        for spring in &self.springs {
            if let SpringOn::Extension { ends, rate, free_length } = spring {
                let [p, q] = ends.map(|end| moving(&end, places));
                let between = p.at - q.at;
                let length = between.norm();
                let extension = length - free_length;
                sums.potential += 0.5 * rate * extension * extension;
                if length > 0.0 {
                    let force = -between * (rate * extension / length);
                    push(ends[0].body, force, &p, &mut sums);
                    push(ends[1].body, -force, &q, &mut sums);
                }
            }
        }
        self.turn(crank_angle, places, wrenches, &mut sums);
        sums
    }

    /// Adds couples and torsion springs.
    fn turn(&self, crank_angle: f64, places: &Kinematics, wrenches: &mut [Wrench], sums: &mut Applied) {
        let mut twist = |body: usize, moment: f64, sums: &mut Applied| {
            wrenches[body].moment += moment;
            sums.count(moment * places.bodies[body].first);
        };
        for (body, moment) in &self.couples {
            let [moment] = moment.at(crank_angle);
            twist(*body, moment, sums);
        }
        for spring in &self.springs {
            if let SpringOn::Torsion { bodies: [one, two], rate, free_angle } = *spring {
                let wound = deflection(&places.bodies[one], &places.bodies[two], free_angle);
                sums.potential += 0.5 * rate * wound * wound;
                twist(one, -rate * wound, sums);
                twist(two, rate * wound, sums);
            }
        }
    }
}
