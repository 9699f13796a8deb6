//! Computes the torque on a linkage's crank with a weight at P and springs, for a chart under the board.

use super::details::{DetailsError, Source};
use super::house::House;
use crate::mechanism::analysis::loaded::load_record;
use crate::mechanism::four_bar::motion::CrankMotion;
use crate::mechanism::loads::{BodyMass, Loads, Mass, Place, Spring};
use crate::mechanism::{Linkage, Unit, xy};
use crate::report::loads::words;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The acceleration of free fall, m/s^2: the drawing stands upright.
const FREE_FALL: f64 = 9.81;
/// Newtons per metre in one newton per millimetre.
const PER_MM: f64 = 1000.0;

/// A linkage with what loads it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadsAsk {
    /// The linkage; its drawing has a unit.
    pub of: Source,
    /// The mass at P, kg, which gravity pulls down along -y.
    #[serde(default)]
    pub weight_kg: f64,
    /// The speed of the crank, counter-clockwise, turns a minute; 0: it stands still.
    #[serde(default)]
    pub rpm: f64,
    /// The springs.
    #[serde(default)]
    pub springs: Vec<SpringAsk>,
}

/// An extension spring.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringAsk {
    /// Its two ends.
    pub ends: [End; 2],
    /// N/mm.
    #[serde(rename = "rate_N_per_mm")]
    pub rate: f64,
    /// The length at which it bears no force, in the drawing's unit.
    pub free_length: f64,
}

/// An end of a spring.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// At a joint, by its name.
    Joint(String),
    /// At a fixed point of the drawing.
    Point([f64; 2]),
}

/// The loads of a linkage over the range of its crank.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Loaded {
    /// The sentences of `linkwright analyze` on them, on one line.
    pub words: String,
    /// The torque on the crank, N m, at crank angles in degrees: [angle, torque] along each stretch without a gap.
    pub torque: Vec<Vec<[f64; 2]>>,
}

impl House {
    /// Computes what turns a linkage with a weight at P and springs.
    ///
    /// # Errors
    /// [`DetailsError`] of a linkage that is not there, a drawing without a unit, and loads that do not fit the linkage.
    pub(super) fn loaded(&self, ask: &LoadsAsk) -> Result<Loaded, DetailsError> {
        let found = self.find(&ask.of, false)?;
        let unit = found.record.problem.unit.ok_or(DetailsError::NoUnit)?;
        let linkage = Linkage::from(found.candidate().linkage);
        let input = CrankMotion::steady_rpm(ask.rpm);
        let record = load_record(&linkage, Some(unit), &loads(ask, &linkage, unit), &input.into())?;
        let strands = record.figures.iter().flat_map(|figures| &figures.torque_strands);
        let torque =
            strands.map(|strand| strand.iter().map(|(deg, torque)| [*deg, *torque]).collect()).collect();
        Ok(Loaded { words: of_the_page(&words(&record, input)), torque })
    }
}

/// Returns sentences of the command line without its lines, with the page's field in place of its option.
fn of_the_page(words: &str) -> String {
    let words: Vec<&str> = words.split_whitespace().collect();
    words.join(" ").replace("--rpm", "“Crank turns”")
}

/// Returns what is asked for as loads in SI units: the mass is on the last body that carries P.
fn loads(ask: &LoadsAsk, linkage: &Linkage, unit: Unit) -> Loads {
    let metres = unit.factor_to(Unit::M);
    let mechanism = linkage.mechanism();
    let (structure, traced) = (mechanism.structure(), mechanism.traced());
    let carrier = structure.carriers(traced).last().map(|body| &structure.bodies[body]);
    let mass = carrier.filter(|_| ask.weight_kg != 0.0).and_then(|body| {
        let (_, place) = body.joints.iter().find(|(joint, _)| *joint == traced)?;
        let center = xy(place * metres);
        Some(BodyMass {
            body: body.name.clone(),
            mass: Mass::Given { mass_kg: ask.weight_kg, center, inertia_kg_m2: 0.0 },
        })
    });
    let end = |end: &End| match end {
        End::Joint(name) => Place::Joint(name.clone()),
        End::Point(point) => Place::Fixed(point.map(|x| x * metres)),
    };
    let spring = |spring: &SpringAsk| Spring::Extension {
        ends: spring.ends.each_ref().map(end),
        rate: spring.rate * PER_MM,
        free_length: spring.free_length * metres,
    };
    Loads {
        gravity: [0.0, -FREE_FALL],
        bodies: mass.into_iter().collect(),
        springs: ask.springs.iter().map(spring).collect(),
        ..Loads::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanism::{AssemblyMode, SliderCrank, SliderCrankParameters};

    #[test]
    fn a_weight_at_p_is_on_the_coupler_and_lengths_are_in_metres() {
        let linkage = Linkage::SliderCrank(
            SliderCrank::new(SliderCrankParameters {
                crank_pivot: [0.0, 0.0],
                crank: 20.0,
                coupler: 60.0,
                line_point: [0.0, 0.0],
                line_deg: 0.0,
                coupler_x: 30.0,
                coupler_y: 10.0,
                assembly: AssemblyMode::Plus,
            })
            .expect("a slider-crank"),
        );
        let text = r#"{"of": {"job": {"name": "x", "rank": 1}}, "weight_kg": 2,
            "springs": [{"ends": [{"joint": "D"}, {"point": [100, 50]}], "rate_N_per_mm": 0.4, "free_length": 30}]}"#;
        let ask: LoadsAsk = serde_json::from_str(text).expect("a message");
        let loads = loads(&ask, &linkage, Unit::Mm);
        let mass = Mass::Given { mass_kg: 2.0, center: [0.03, 0.01], inertia_kg_m2: 0.0 };
        assert_eq!(loads.bodies, [BodyMass { body: "coupler".into(), mass }]);
        let ends = [Place::Joint("D".into()), Place::Fixed([0.1, 0.05])];
        assert_eq!(loads.springs, [Spring::Extension { ends, rate: 400.0, free_length: 0.03 }]);
        assert!(load_record(&linkage, Some(Unit::Mm), &loads, &CrankMotion::steady(0.0).into()).is_ok());
    }
}
