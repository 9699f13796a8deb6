//! The least transmission angle min(mu, 180 - mu) over the motion.

use super::{Definition, Limit, LimitUnit, Refusal, RequireSpec, Words};
use crate::task::Problem;
use crate::task::spec::{ProblemSpec, TimingSpec};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Over which motion the transmission angle is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum TransmissionOver {
    /// The full turn of the crank.
    Cycle,
    /// The crank angles between the target points.
    Used,
}

pub(super) struct Transmission;

impl Definition for Transmission {
    fn key(&self) -> &'static str {
        "require.transmission_deg_min"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        problem.spec().require.transmission_deg_min.is_some()
    }

    fn check(&self, require: &RequireSpec, _: Option<&TimingSpec>) -> Result<(), Refusal> {
        match require.transmission_deg_min {
            Some(least) if !(0.0..=90.0).contains(&least) => Refusal::because(
                format!("transmission_deg_min = {least} is not between 0 and 90 degrees"),
                "the angle meant is min(mu, 180 - mu): 90 is best, 30 to 40 is usual",
            ),
            _ => Ok(()),
        }
    }

    fn limits(&self, spec: &ProblemSpec) -> Option<Vec<Limit>> {
        Limit::least(spec.require.transmission_deg_min)
    }

    fn set_limits(&self, spec: &mut ProblemSpec, limits: &[f64]) {
        spec.require.transmission_deg_min = limits.first().copied();
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.transmission_deg_min = None;
    }

    fn is_left_out_in_turn(&self) -> bool {
        true
    }

    fn unit(&self) -> LimitUnit {
        LimitUnit::Degree
    }

    fn rounding(&self, value: Option<f64>, size: f64) -> f64 {
        value.map_or(size, |value| 180.0 / value.min(180.0 - value).max(1e-5).to_radians().sin())
    }

    fn template(&self) -> &'static str {
        "transmission_deg_min = 30       # how well the coupler pushes the follower: 90 is best, below 30 it may jam\n"
    }

    fn words(&self) -> Words {
        Words {
            short: "transmission",
            label: "worst transmission angle, °",
            relation: "at least ",
            plain: "the least transmission angle",
        }
    }

    fn objection(&self, value: &str, limit: &str) -> Option<String> {
        Some(format!("worst transmission angle {value}°, at least {limit}° asked"))
    }
}
