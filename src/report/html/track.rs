//! The motion of a linkage of several loops as samples over a turn, which the player interpolates.

use crate::mechanism::dyad_chain::kinds::{CRANK, GROUND};
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::{Complex, Mechanism, MultiLoop, xy};
use serde::Serialize;
use std::f64::consts::TAU;

/// Samples of a turn.
const SAMPLES: usize = 180;
/// Significant digits of a sample, in parts of the largest one.
const DIGITS: i32 = 6;

/// The motion of a linkage of several loops.
#[derive(Clone, Debug, Serialize, schemars::JsonSchema)]
pub struct Track {
    /// The names of the joints, the fixed pivots first, P the last.
    names: Vec<&'static str>,
    /// The fixed pivots.
    pivots: Vec<[f64; 2]>,
    /// The joints of each moving link, as indices of their names.
    links: Vec<Vec<usize>>,
    /// The dyad of each link, counted from 1; 0 of the crank.
    dyads: Vec<usize>,
    /// Evenly over a turn from a crank angle of 0: x and y of each moving joint, the transmission angle of each dyad
    /// (radians), velocity and acceleration of P at a crank of one radian a second.
    rows: Vec<Vec<f64>>,
}

impl Track {
    /// Returns the motion of a linkage.
    pub fn of(linkage: &MultiLoop) -> Self {
        let joints = linkage.joints();
        let names: Vec<&'static str> = joints.iter().map(|joint| joint.name).collect();
        let links = linkage.links().into_iter().skip(1);
        let index = |name: &str| names.iter().position(|other| *other == name);
        let (indices, dyads) = links
            .map(|body| {
                let joints: Vec<usize> = body.joints.iter().filter_map(|(name, _)| index(name)).collect();
                (joints, if body.body == CRANK { 0 } else { body.body / 2 })
            })
            .unzip();
        let chain = linkage.to_chain().ok();
        let scale = 10f64.powi(DIGITS - linkage.longest().log10().floor() as i32);
        let rounded = |x: f64| if x.is_finite() { (x * scale).round() / scale } else { 0.0 };
        let row = |i: usize| {
            let angle = TAU * i as f64 / SAMPLES as f64;
            let mut row: Vec<f64> = match linkage.bodies(angle) {
                Some(bodies) => linkage.moving(&bodies).flat_map(xy).map(rounded).collect(),
                None => vec![0.0; 2 * joints.iter().filter(|joint| joint.body != GROUND).count()],
            };
            let mut angles = linkage.transmissions_at(angle);
            angles.resize(linkage.dyad_count(), 0.0);
            row.extend(angles.into_iter().map(|angle| (angle * 1e6).round() / 1e6));
            let motion = chain.as_ref().map(|chain| chain.motion_at(angle, CrankMotion::steady(1.0)));
            let of_point = |list: &Vec<Option<Complex>>| list.last().copied().flatten();
            for list in [motion.as_ref().map(|m| &m.velocities), motion.as_ref().map(|m| &m.accelerations)] {
                let vector = list.and_then(of_point).unwrap_or(Complex::new(0.0, 0.0));
                row.extend(xy(vector).map(rounded));
            }
            row
        };
        Track {
            names,
            pivots: linkage.pivots().into_iter().map(xy).collect(),
            links: indices,
            dyads,
            rows: (0..SAMPLES).map(row).collect(),
        }
    }
}
