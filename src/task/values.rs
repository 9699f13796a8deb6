//! The value types of our TOML files, with errors that state the expected value in a designer's words.
//!
//! Each type here refuses values that are not finite numbers below 1e12, and lists of the wrong length, which serde's
//! own arrays would cut without an error. A custom error is `message` or `message\nhelp`.

use crate::mechanism::MAX_MAGNITUDE;
use crate::task::limits::Limits;
use crate::task::region::Region;
use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{self, Deserializer, IntoDeserializer, MapAccess, SeqAccess, Unexpected, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// The remedy for a number that is too large, of an unknown key.
pub(crate) const TOO_LARGE: &str = "write a number of at most 1e12 in magnitude";

/// Returns an error with a remedy.
pub(crate) fn refuse<E: de::Error>(message: impl fmt::Display, help: impl fmt::Display) -> E {
    E::custom(format_args!("{message}\n{help}"))
}

fn usable<E: de::Error>(value: f64) -> Result<f64, E> {
    if value.abs() <= MAX_MAGNITUDE {
        Ok(value)
    } else if value.is_finite() {
        Err(refuse(format_args!("{value:e} is too large: numbers go up to {MAX_MAGNITUDE:e}"), TOO_LARGE))
    } else {
        let name = if value.is_nan() { "nan".to_owned() } else { value.to_string() };
        Err(refuse(format_args!("{name} is not a number that can be used"), "write a finite number"))
    }
}

/// Defines the visitor's functions for numbers; integers are numbers too.
macro_rules! visit_numbers {
    ($make:expr) => {
        fn visit_f64<E: de::Error>(self, value: f64) -> Result<Self::Value, E> {
            usable(value).map($make)
        }
        fn visit_i64<E: de::Error>(self, value: i64) -> Result<Self::Value, E> {
            self.visit_f64(value as f64)
        }
        fn visit_u64<E: de::Error>(self, value: u64) -> Result<Self::Value, E> {
            self.visit_f64(value as f64)
        }
        fn visit_i128<E: de::Error>(self, value: i128) -> Result<Self::Value, E> {
            self.visit_f64(value as f64)
        }
    };
}

/// A finite number below 1e12 in magnitude.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema)]
#[schemars(inline)]
pub(crate) struct Number(pub f64);

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberVisitor;
        impl Visitor<'_> for NumberVisitor {
            type Value = Number;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number")
            }
            visit_numbers!(Number);
        }
        deserializer.deserialize_any(NumberVisitor)
    }
}

/// Returns the values of numbers.
pub(crate) fn numbers(list: &[Number]) -> Vec<f64> {
    list.iter().map(|number| number.0).collect()
}

/// 2^53: up to this value, a float distinguishes neighbouring whole numbers.
const LARGEST_WHOLE: f64 = 9_007_199_254_740_992.0;

/// A whole number that is not negative.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema)]
#[schemars(inline)]
pub(crate) struct Count(pub u64);

impl<'de> Deserialize<'de> for Count {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct CountVisitor;
        impl Visitor<'_> for CountVisitor {
            type Value = Count;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a whole number, 0 or more")
            }
            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Count, E> {
                Ok(Count(value))
            }
            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Count, E> {
                u64::try_from(value)
                    .map(Count)
                    .map_err(|_| E::invalid_value(Unexpected::Signed(value), &self))
            }
            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Count, E> {
                // 1e6 is a whole number to a person and a float to TOML.
                if (0.0..=LARGEST_WHOLE).contains(&value) && value.fract() == 0.0 {
                    Ok(Count(value as u64))
                } else {
                    Err(E::invalid_value(Unexpected::Float(value), &self))
                }
            }
        }
        deserializer.deserialize_any(CountVisitor)
    }
}

/// Reads a list of exactly N values; `expected` describes it.
pub(crate) fn list_of<'de, T, D, const N: usize>(from: D, expected: &'static str) -> Result<[T; N], D::Error>
where
    T: Deserialize<'de>,
    D: Deserializer<'de>,
{
    struct ListVisitor<T, const N: usize>(&'static str, PhantomData<T>);
    impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for ListVisitor<T, N> {
        type Value = [T; N];
        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str(self.0)
        }
        fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<[T; N], A::Error> {
            exactly(seq, self.0)
        }
    }
    from.deserialize_any(ListVisitor(expected, PhantomData))
}

/// Reads a list of exactly N values.
fn exactly<'de, T, A, const N: usize>(mut seq: A, expected: &str) -> Result<[T; N], A::Error>
where
    T: Deserialize<'de>,
    A: SeqAccess<'de>,
{
    let mut list = Vec::with_capacity(N);
    while list.len() < N
        && let Some(value) = seq.next_element()?
    {
        list.push(value);
    }
    let mut count = list.len();
    while seq.next_element::<de::IgnoredAny>()?.is_some() {
        count += 1;
    }
    let wrong = || de::Error::custom(format_args!("expected {expected}, found a list of {count}"));
    if count == N { list.try_into().map_err(|_| wrong()) } else { Err(wrong()) }
}

/// A point.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema)]
#[schemars(inline)]
pub(crate) struct XY(#[schemars(with = "[Number; 2]")] pub [f64; 2]);

impl<'de> Deserialize<'de> for XY {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        list_of(from, "a point [x, y]").map(|point: [Number; 2]| XY(point.map(|n| n.0)))
    }
}

/// A pose: a place and an angle in degrees, or a place alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PoseNumbers {
    pub place: [f64; 2],
    pub angle_deg: Option<f64>,
}

impl<'de> Deserialize<'de> for PoseNumbers {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct PoseVisitor;
        const EXPECTED: &str = "a pose [x, y, angle in degrees], or [x, y] for its place alone";
        impl<'de> Visitor<'de> for PoseVisitor {
            type Value = PoseNumbers;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<PoseNumbers, A::Error> {
                let list = numbers(&Vec::deserialize(SeqAccessDeserializer::new(seq))?);
                match *list.as_slice() {
                    [x, y] => Ok(PoseNumbers { place: [x, y], angle_deg: None }),
                    [x, y, angle] => Ok(PoseNumbers { place: [x, y], angle_deg: Some(angle) }),
                    _ => {
                        let count = list.len();
                        Err(de::Error::custom(format_args!("expected {EXPECTED}, found a list of {count}")))
                    }
                }
            }
        }
        from.deserialize_any(PoseVisitor)
    }
}

impl JsonSchema for PoseNumbers {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "PoseNumbers".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!(
            {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 3}
        )
    }
}

/// A crank angle in degrees, or the word `free`: `None`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CrankAngle(pub Option<f64>);

impl<'de> Deserialize<'de> for CrankAngle {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct AngleVisitor;
        impl<'de> Visitor<'de> for AngleVisitor {
            type Value = CrankAngle;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an angle in degrees, or \"free\"")
            }
            visit_numbers!(|angle| CrankAngle(Some(angle)));
            fn visit_str<E: de::Error>(self, word: &str) -> Result<CrankAngle, E> {
                if word == "free" {
                    return Ok(CrankAngle(None));
                }
                Err(E::invalid_value(de::Unexpected::Str(word), &self))
            }
        }
        deserializer.deserialize_any(AngleVisitor)
    }
}

impl JsonSchema for CrankAngle {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "CrankAngle".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({"anyOf": [{"type": "number"}, {"const": "free"}]})
    }
}

/// A rectangle, given by four numbers.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema)]
#[schemars(inline)]
pub(crate) struct Corners(#[schemars(with = "[Number; 4]")] pub [f64; 4]);

impl<'de> Deserialize<'de> for Corners {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        list_of(from, "a box [xmin, ymin, xmax, ymax]")
            .map(|corners: [Number; 4]| Corners(corners.map(|n| n.0)))
    }
}

/// An item of a region: a number of a box, or a corner of a polygon.
enum NumberOrCorner {
    Number(f64),
    Corner([f64; 2]),
}

impl<'de> Deserialize<'de> for NumberOrCorner {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ItemVisitor;
        impl<'de> Visitor<'de> for ItemVisitor {
            type Value = NumberOrCorner;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number of a box, or a corner [x, y] of a polygon")
            }
            visit_numbers!(NumberOrCorner::Number);
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<NumberOrCorner, A::Error> {
                let corner: [Number; 2] = exactly(seq, "a corner [x, y]")?;
                Ok(NumberOrCorner::Corner(corner.map(|n| n.0)))
            }
        }
        deserializer.deserialize_any(ItemVisitor)
    }
}

/// A region: a box by four numbers, or a polygon by its corners.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RegionNumbers(pub Region);

impl<'de> Deserialize<'de> for RegionNumbers {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct RegionVisitor;
        const EXPECTED: &str = "a box [xmin, ymin, xmax, ymax] or a polygon [[x, y], ...]";
        impl<'de> Visitor<'de> for RegionVisitor {
            type Value = RegionNumbers;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<RegionNumbers, A::Error> {
                let (mut corners, mut numbers) = (Vec::new(), Vec::new());
                while let Some(item) = seq.next_element::<NumberOrCorner>()? {
                    match item {
                        NumberOrCorner::Corner(corner) => corners.push(corner),
                        NumberOrCorner::Number(number) => numbers.push(number),
                    }
                }
                let count = corners.len() + numbers.len();
                match (<[f64; 4]>::try_from(numbers), corners.is_empty()) {
                    (Ok(numbers), true) => Ok(RegionNumbers(Region::Box(numbers))),
                    (Err(numbers), false) if numbers.is_empty() => {
                        Ok(RegionNumbers(Region::Polygon(corners)))
                    }
                    _ => Err(de::Error::custom(format_args!("expected {EXPECTED}, found a list of {count}"))),
                }
            }
        }
        from.deserialize_any(RegionVisitor)
    }
}

impl JsonSchema for RegionNumbers {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "RegionNumbers".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({"anyOf": [
            {"type": "array", "items": {"type": "number"}, "minItems": 4, "maxItems": 4},
            {"type": "array", "minItems": 3, "items":
                {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}}
        ]})
    }
}

/// A point, each coordinate fixed or bounded.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema)]
#[schemars(inline)]
pub(crate) struct BoundedXY(#[schemars(with = "[Bounds; 2]")] pub [Limits; 2]);

impl<'de> Deserialize<'de> for BoundedXY {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        list_of(from, "a point [x, y], each a number or bounds [min, max]")
            .map(|point: [Bounds; 2]| BoundedXY(point.map(|bounds| bounds.0)))
    }
}

/// The bounds of a number: a number, which fixes the value, or [min, max].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bounds(pub Limits);

impl<'de> Deserialize<'de> for Bounds {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        const EXPECTED: &str = "a number, which fixes the value, or bounds [min, max]";
        struct BoundsVisitor;
        impl<'de> Visitor<'de> for BoundsVisitor {
            type Value = Bounds;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(EXPECTED)
            }
            visit_numbers!(|v| Bounds(Limits(v, v)));
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Bounds, A::Error> {
                let [Number(low), Number(high)] = exactly(seq, EXPECTED)?;
                if low > high {
                    return Err(refuse(
                        format_args!("the bounds are the wrong way round: {low} is above {high}"),
                        format_args!("write [{high}, {low}]"),
                    ));
                }
                Ok(Bounds(Limits(low, high)))
            }
        }
        deserializer.deserialize_any(BoundsVisitor)
    }
}

impl JsonSchema for Bounds {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Bounds".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({
            "description": "A number fixes the value; [min, max] bounds it.",
            "anyOf": [
                {"type": "number"},
                {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
            ]
        })
    }
}

/// The most characters of a faulty word that a message repeats.
const MOST_QUOTED: usize = 60;

/// A length, or the word "any" for no limit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LengthOrAny {
    Length(f64),
    Any,
}

impl LengthOrAny {
    /// Returns the length; `None` if any length will do.
    pub(crate) fn length(self) -> Option<f64> {
        match self {
            LengthOrAny::Length(length) => Some(length),
            LengthOrAny::Any => None,
        }
    }
}

impl<'de> Deserialize<'de> for LengthOrAny {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct LengthOrAnyVisitor;
        impl Visitor<'_> for LengthOrAnyVisitor {
            type Value = LengthOrAny;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a length, or \"any\" for no limit")
            }
            visit_numbers!(LengthOrAny::Length);
            fn visit_str<E: de::Error>(self, value: &str) -> Result<LengthOrAny, E> {
                match value {
                    "any" => Ok(LengthOrAny::Any),
                    number if number.parse::<f64>().is_ok() => {
                        Err(E::invalid_type(Unexpected::Str(value), &self))
                    }
                    _ => {
                        let given: String = value.chars().take(MOST_QUOTED).collect();
                        let message = format_args!("{given:?} is neither a length nor \"any\"");
                        Err(refuse(message, "write a length above 0, or \"any\" for no limit"))
                    }
                }
            }
        }
        deserializer.deserialize_any(LengthOrAnyVisitor)
    }
}

impl JsonSchema for LengthOrAny {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "LengthOrAny".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({"anyOf": [{"type": "number"}, {"const": "any"}]})
    }
}

/// One number for all points, or a list of one for each.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum OneOrEach {
    One(f64),
    Each(Vec<f64>),
}

impl<'de> Deserialize<'de> for OneOrEach {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrEachVisitor;
        impl<'de> Visitor<'de> for OneOrEachVisitor {
            type Value = OneOrEach;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number for all points, or a list of one for each")
            }
            visit_numbers!(OneOrEach::One);
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<OneOrEach, A::Error> {
                let list = Vec::deserialize(SeqAccessDeserializer::new(seq))?;
                Ok(OneOrEach::Each(numbers(&list)))
            }
        }
        deserializer.deserialize_any(OneOrEachVisitor)
    }
}

impl JsonSchema for OneOrEach {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "OneOrEach".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({"anyOf": [{"type": "number"}, {"type": "array", "items": {"type": "number"}}]})
    }
}

/// A table and nothing else: serde's own structs would accept a list as their fields in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct OnlyTable<T>(pub T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OnlyTable<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct TableVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for TableVisitor<T> {
            type Value = OnlyTable<T>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table")
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                T::deserialize(MapAccessDeserializer::new(map)).map(OnlyTable)
            }
        }
        deserializer.deserialize_any(TableVisitor(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for OnlyTable<T> {
    fn inline_schema() -> bool {
        T::inline_schema()
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        T::schema_name()
    }
    fn schema_id() -> std::borrow::Cow<'static, str> {
        T::schema_id()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        T::json_schema(generator)
    }
}

/// A list of names, or one name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OneOrMore<T>(pub Vec<T>);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for OneOrMore<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListVisitor<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for ListVisitor<T> {
            type Value = OneOrMore<T>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list of names in quotes")
            }
            fn visit_str<E: de::Error>(self, value: &str) -> Result<Self::Value, E> {
                T::deserialize(value.into_deserializer()).map(|one| OneOrMore(vec![one]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                Vec::deserialize(SeqAccessDeserializer::new(seq)).map(OneOrMore)
            }
        }
        deserializer.deserialize_any(ListVisitor(PhantomData))
    }
}

impl<T: JsonSchema> JsonSchema for OneOrMore<T> {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("OneOrMore{}", T::schema_name()).into()
    }
    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let one = generator.subschema_for::<T>();
        schemars::json_schema!({"anyOf": [one.clone(), {"type": "array", "items": one}]})
    }
}

/// Functions that read fields of plain types as strictly as the types here.
pub(crate) mod plain {
    use super::{Count, Deserialize, Deserializer, Number, OnlyTable};

    /// Reads a number.
    pub fn number<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
        Ok(Option::<Number>::deserialize(from)?.map(|number| number.0))
    }

    /// Reads a list of numbers.
    pub fn numbers<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
        Ok(super::numbers(&Vec::deserialize(from)?))
    }

    /// Reads a list of numbers that may be absent.
    pub fn list<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Vec<f64>>, D::Error> {
        Ok(Option::<Vec<Number>>::deserialize(from)?.as_deref().map(super::numbers))
    }

    /// Reads a whole number.
    pub fn count<'de, D: Deserializer<'de>>(from: D) -> Result<Option<usize>, D::Error> {
        Ok(Option::<Count>::deserialize(from)?.map(|count| count.0 as usize))
    }

    /// Reads a table.
    pub fn table<'de, T: Deserialize<'de>, D: Deserializer<'de>>(from: D) -> Result<Option<T>, D::Error> {
        Ok(Option::<OnlyTable<T>>::deserialize(from)?.map(|table| table.0))
    }

    /// Reads a list of tables.
    pub fn tables<'de, T: Deserialize<'de>, D: Deserializer<'de>>(from: D) -> Result<Vec<T>, D::Error> {
        Ok(Vec::<OnlyTable<T>>::deserialize(from)?.into_iter().map(|table| table.0).collect())
    }
}
