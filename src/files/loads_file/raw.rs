//! The keys of `[loads]`.

use crate::files::toml_values::{Number, OnlyTable, XY, list_of};
use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{self, Deserializer, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use std::collections::BTreeMap;
use std::fmt;

/// Masses, forces, couples and springs; friction is left out. Lengths are in the file's unit.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Loads")]
pub(crate) struct RawLoads {
    /// The acceleration of free fall [x, y], m/s^2; none where this is missing.
    pub(super) gravity: Option<XY>,
    /// The speed of the crank in turns a minute, where the command gives none: a number, or rows [crank angle in degrees, rpm] in
    /// ascending order within one turn, all of one sign and none 0. Between them the speed is the periodic cubic spline through them,
    /// so that the acceleration, omega d omega/d phi, is continuous.
    pub(super) speed_rpm: Option<RawSpeed>,
    /// The mass of a body, by its name: crank, coupler, follower, block, link5 and so on; of a chain B-C, two joints of a link, or
    /// block-D, the block of the stage that makes D. Of every kind, P: what the body that carries P bears beside its own mass, in P where
    /// neither center nor at is given. Bodies without a table have no mass.
    #[serde(default)]
    #[schemars(with = "BTreeMap<String, RawBody>")]
    pub(super) body: Option<OnlyTable<BTreeMap<String, OnlyTable<RawBody>>>>,
    /// Forces at joints, at P and at other places of bodies.
    #[serde(default)]
    #[schemars(with = "Vec<RawForce>")]
    pub(super) force: Vec<OnlyTable<RawForce>>,
    /// Couples on bodies.
    #[serde(default)]
    #[schemars(with = "Vec<RawCouple>")]
    pub(super) couple: Vec<OnlyTable<RawCouple>>,
    /// Springs without mass: from and to, along a line; or body and against, by an angle.
    #[serde(default)]
    #[schemars(with = "Vec<RawSpring>")]
    pub(super) spring: Vec<OnlyTable<RawSpring>>,
}

/// The mass of a body: mass_kg, or density_kg_m3 with thickness and width.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "BodyMass")]
pub(super) struct RawBody {
    /// The mass.
    pub(super) mass_kg: Option<Number>,
    /// The centre of mass along and across (to the left of) the line from the body's first joint to its second (crank A-C, coupler
    /// C-D, follower B-D; of a block and of a rod that slides along the slider's line); [0, 0] where this is missing.
    pub(super) center: Option<XY>,
    /// In place of center: the joint or point of the body at which its centre of mass lies, such as P.
    pub(super) at: Option<String>,
    /// The moment of inertia about the centre of mass; 0 where this is missing.
    pub(super) inertia_kg_m2: Option<Number>,
    /// In place of the mass: the density of a flat plate around the body's joints and points, such as 7850 of steel.
    pub(super) density_kg_m3: Option<Number>,
    /// With density_kg_m3: the thickness of the plate.
    pub(super) thickness: Option<Number>,
    /// With density_kg_m3: the width of the plate across the line of two joints, and its rounding about each.
    pub(super) width: Option<Number>,
}

/// A force: force_N, table or opposing_N.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Force")]
pub(super) struct RawForce {
    /// A joint's or point's name, or a place on a body: { body = "coupler", at = [20, 5] }.
    pub(super) at: RawPlace,
    /// The body on which the force acts, of those that the joint connects; the first that moves where this is missing.
    pub(super) body: Option<String>,
    /// The force along x and y.
    #[serde(rename = "force_N")]
    pub(super) force: Option<XY>,
    /// In place of force_N: rows [crank angle in degrees, N, N] in ascending order within one turn; linear between them.
    #[schemars(with = "Option<Vec<[Number; 3]>>")]
    pub(super) table: Option<Vec<Row<3>>>,
    /// A body that the force turns with: force_N and table are then along and across its line.
    pub(super) along: Option<String>,
    /// In place of force_N: the size of a force against the velocity of its point, N.
    #[serde(rename = "opposing_N")]
    pub(super) opposing: Option<Number>,
}

/// A couple: moment_N_m or table.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Couple")]
pub(super) struct RawCouple {
    /// The body on which it acts.
    pub(super) body: String,
    /// The moment, counter-clockwise positive.
    #[serde(rename = "moment_N_m")]
    pub(super) moment: Option<Number>,
    /// In place of moment_N_m: rows [crank angle in degrees, N m] in ascending order within one turn; linear between them.
    #[schemars(with = "Option<Vec<[Number; 2]>>")]
    pub(super) table: Option<Vec<Row<2>>>,
}

/// A spring.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Spring")]
pub(super) struct RawSpring {
    /// One end: a joint's or point's name, a fixed point [x, y], or a place on a body { body = "coupler", at = [20, 5] }.
    pub(super) from: Option<RawPlace>,
    /// The other end.
    pub(super) to: Option<RawPlace>,
    /// The rate of a spring between two ends.
    #[serde(rename = "rate_N_per_m")]
    pub(super) rate: Option<Number>,
    /// The length at which it bears no force.
    pub(super) free_length: Option<Number>,
    /// In place of from and to: the body on which a torsion spring acts.
    pub(super) body: Option<String>,
    /// With body: the body that bears the torsion spring; the ground where this is missing.
    pub(super) against: Option<String>,
    /// The rate of a torsion spring.
    #[serde(rename = "rate_N_m_per_rad")]
    pub(super) torsion_rate: Option<Number>,
    /// The angle of the body's line from that of the other (of the ground, the x axis) at which a torsion spring bears no moment.
    pub(super) free_angle_deg: Option<Number>,
}

/// A speed: constant, or a table.
#[derive(JsonSchema)]
#[serde(untagged)]
#[schemars(inline)]
pub(super) enum RawSpeed {
    Steady(Number),
    Table(#[schemars(with = "Vec<[Number; 2]>")] Vec<Row<2>>),
}

impl<'de> Deserialize<'de> for RawSpeed {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct SpeedVisitor;
        impl<'de> Visitor<'de> for SpeedVisitor {
            type Value = RawSpeed;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, or a list of rows [degrees, rpm]")
            }
            fn visit_i64<E: de::Error>(self, rpm: i64) -> Result<RawSpeed, E> {
                Number::deserialize(rpm.into_deserializer()).map(RawSpeed::Steady)
            }
            fn visit_f64<E: de::Error>(self, rpm: f64) -> Result<RawSpeed, E> {
                Number::deserialize(rpm.into_deserializer()).map(RawSpeed::Steady)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<RawSpeed, A::Error> {
                let mut rows = Vec::new();
                while let Some(SpeedRow(row)) = seq.next_element()? {
                    rows.push(row);
                }
                Ok(RawSpeed::Table(rows))
            }
        }
        from.deserialize_any(SpeedVisitor)
    }
}

/// A row of a table of speeds.
struct SpeedRow(Row<2>);

impl<'de> Deserialize<'de> for SpeedRow {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        list_of(from, "a row [degrees, rpm]").map(|row: [Number; 2]| SpeedRow(Row(row.map(|n| n.0))))
    }
}

/// A row of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row<const N: usize>(pub(super) [f64; N]);

impl<'de, const N: usize> Deserialize<'de> for Row<N> {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let expected = match N {
            2 => "a row [degrees, N m]",
            _ => "a row [degrees, N, N]",
        };
        list_of(from, expected).map(|row: [Number; N]| Row(row.map(|n| n.0)))
    }
}

/// A place at which a force or a spring acts.
pub(super) enum RawPlace {
    Joint(String),
    Fixed([f64; 2]),
    OnBody(RawOnBody),
}

/// A place on a body.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RawOnBody {
    pub(super) body: String,
    pub(super) at: XY,
}

impl<'de> Deserialize<'de> for RawPlace {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct PlaceVisitor;
        impl<'de> Visitor<'de> for PlaceVisitor {
            type Value = RawPlace;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a joint's name, a point [x, y], or { body = \"coupler\", at = [x, y] }")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> Result<RawPlace, E> {
                Ok(RawPlace::Joint(name.to_owned()))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<RawPlace, A::Error> {
                XY::deserialize(SeqAccessDeserializer::new(seq)).map(|at| RawPlace::Fixed(at.0))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<RawPlace, A::Error> {
                RawOnBody::deserialize(MapAccessDeserializer::new(map)).map(RawPlace::OnBody)
            }
        }
        from.deserialize_any(PlaceVisitor)
    }
}

impl JsonSchema for RawPlace {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Place".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({"anyOf": [
            {"type": "string"},
            {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2},
            {"type": "object"}
        ]})
    }
}
