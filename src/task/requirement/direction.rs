//! The sense in which the crank turns along the points.

use super::{Choice, Definition, Refusal, RequireSpec, Words};
use crate::task::spec::{DirectionPolicy, ProblemSpec, TimingSpec};
use crate::task::{AngleOffset, Problem};

pub(super) struct Direction;

impl Definition for Direction {
    fn key(&self) -> &'static str {
        "require.direction"
    }

    fn is_asked(&self, problem: &Problem) -> bool {
        problem.spec().require.direction != DirectionPolicy::Any
    }

    fn check(&self, require: &RequireSpec, timing: Option<&TimingSpec>) -> Result<(), Refusal> {
        match timing.map(|timing| timing.offset) {
            None | Some(AngleOffset::Free) => Ok(()),
            Some(_) if require.direction == DirectionPolicy::Any => Ok(()),
            Some(offset) => {
                let offset = if offset == AngleOffset::Fixed { "fixed" } else { "ground" };
                Refusal::because(
                    format!(
                        "the direction is already told by crank_deg, which is meant as written \
                         with offset = \"{offset}\""
                    ),
                    "remove direction; to turn the other way, change the signs of crank_deg",
                )
            }
        }
    }

    fn template(&self) -> &'static str {
        "# direction = \"ccw\"             # or \"cw\": which way the crank turns\n"
    }

    fn drop_from(&self, spec: &mut ProblemSpec) {
        spec.require.direction = DirectionPolicy::Any;
    }

    fn choice(&self, require: &RequireSpec) -> Option<Choice> {
        Some(Choice::Word(match require.direction {
            DirectionPolicy::Any => "any",
            DirectionPolicy::Ccw => "ccw",
            DirectionPolicy::Cw => "cw",
        }))
    }

    fn words(&self) -> Words {
        Words { short: "direction", label: "direction", relation: "", plain: "the direction of the crank" }
    }

    fn objection(&self, value: &str, limit: &str) -> Option<String> {
        Some(format!("turns {value}, {limit} asked"))
    }
}
