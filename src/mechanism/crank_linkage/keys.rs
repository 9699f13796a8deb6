//! How a linkage is written and read: a four-bar by its keys alone, other kinds with their name under `kind`.

use super::{CrankLinkage, LinkageKind};
use crate::mechanism::{
    AssemblyMode, ChainKeys, CouplerSide, FourBar, InvertedSliderCrank, InvertedSliderCrankParameters,
    LinkageError, MultiLoop, NaturalCoordinates, NoMultiLoop, SliderCrank, SliderCrankParameters,
};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use std::borrow::Cow;

/// The keys of a linkage, without its kind.
#[derive(Serialize)]
#[serde(untagged)]
enum Keys {
    FourBar(NaturalCoordinates),
    SliderCrank(SliderCrankParameters),
    InvertedSliderCrank(InvertedSliderCrankParameters),
    MultiLoop { chain: ChainKeys },
}

/// A linkage as it stands in records.
#[derive(Serialize)]
struct Written {
    /// The kind; absent of a four-bar.
    #[serde(skip_serializing_if = "Option::is_none")]
    kind: Option<LinkageKind>,
    #[serde(flatten)]
    keys: Keys,
}

impl Serialize for CrankLinkage {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let keys = match self {
            CrankLinkage::FourBar(linkage) => Keys::FourBar(linkage.natural_coordinates()),
            CrankLinkage::SliderCrank(linkage) => Keys::SliderCrank(linkage.parameters()),
            CrankLinkage::InvertedSliderCrank(linkage) => Keys::InvertedSliderCrank(linkage.parameters()),
            CrankLinkage::MultiLoop(linkage) => Keys::MultiLoop { chain: linkage.keys() },
        };
        let kind = Some(self.kind()).filter(|kind| *kind != LinkageKind::FourBar);
        Written { kind, keys }.serialize(serializer)
    }
}

/// A linkage by its keys, which may be no linkage: every key of every kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "CrankLinkage")]
pub struct LinkageKeys {
    /// The kind; absent of a four-bar.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub kind: Option<LinkageKind>,
    /// The fixed pivot of the crank, of every kind but those of several loops.
    #[serde(rename = "A", default, skip_serializing_if = "Option::is_none")]
    pub crank_pivot: Option<[f64; 2]>,
    /// The fixed pivot of a four-bar's follower, or of the block of an inverted slider-crank.
    #[serde(rename = "B", default, skip_serializing_if = "Option::is_none")]
    pub second_pivot: Option<[f64; 2]>,
    /// |AC|, of every kind but those of several loops.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub a: Option<f64>,
    /// |CD| of a four-bar and of a slider-crank.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub b: Option<f64>,
    /// |BD| of a four-bar.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub c: Option<f64>,
    /// |CP| of a four-bar.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub d: Option<f64>,
    /// |DP| of a four-bar.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub e: Option<f64>,
    /// Q, a point of a slider-crank's line, from which the slider's place counts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line_point: Option<[f64; 2]>,
    /// The direction of a slider-crank's line from the x axis, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub line_deg: Option<f64>,
    /// The distance of B to the left of the rod's line through C, of an inverted slider-crank.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub offset: Option<f64>,
    /// P along the coupler from C, of kinds with a slider.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coupler_x: Option<f64>,
    /// P to the left of the coupler, of kinds with a slider.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub coupler_y: Option<f64>,
    /// The assembly: of a four-bar 1 where D lies left of the line from C to B; of a slider-crank where D is the one of two
    /// places that lies further along the line; of an inverted one where the block is ahead of C along the rod.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<i64>")]
    pub t1: Option<AssemblyMode>,
    /// The side of a four-bar's coupler point: 1 where P lies left of the line from C to D.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Option<i64>")]
    pub t2: Option<CouplerSide>,
    /// The chain of a six-bar or an eight-bar.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub chain: Option<ChainKeys>,
}

/// The reason why keys are no linkage.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoLinkage {
    /// The kind has no such key.
    #[error("{} has no key `{}`", .0.with_article(), .1)]
    Stray(LinkageKind, &'static str),
    /// A key of the kind is absent.
    #[error("missing field `{0}`")]
    Missing(&'static str),
    /// The values are those of no linkage.
    #[error(transparent)]
    Linkage(#[from] LinkageError),
    /// The chain is that of no six-bar or eight-bar.
    #[error(transparent)]
    MultiLoop(#[from] NoMultiLoop),
    /// The chain has another number of dyads than the kind.
    #[error("this chain is not that of {}", .0.with_article())]
    OtherKind(LinkageKind),
}

impl LinkageKeys {
    /// Returns the keys that are there although the kind has none of them.
    fn stray(&self, kind: LinkageKind) -> Option<&'static str> {
        use LinkageKind::{EightBar, FourBar, InvertedSliderCrank, SixBar, SliderCrank};
        let keys: [(&str, bool, &[LinkageKind]); 15] = [
            ("A", self.crank_pivot.is_some(), &[FourBar, SliderCrank, InvertedSliderCrank]),
            ("a", self.a.is_some(), &[FourBar, SliderCrank, InvertedSliderCrank]),
            ("t1", self.t1.is_some(), &[FourBar, SliderCrank, InvertedSliderCrank]),
            ("chain", self.chain.is_some(), &[SixBar, EightBar]),
            ("B", self.second_pivot.is_some(), &[FourBar, InvertedSliderCrank]),
            ("b", self.b.is_some(), &[FourBar, SliderCrank]),
            ("c", self.c.is_some(), &[FourBar]),
            ("d", self.d.is_some(), &[FourBar]),
            ("e", self.e.is_some(), &[FourBar]),
            ("t2", self.t2.is_some(), &[FourBar]),
            ("line_point", self.line_point.is_some(), &[SliderCrank]),
            ("line_deg", self.line_deg.is_some(), &[SliderCrank]),
            ("offset", self.offset.is_some(), &[InvertedSliderCrank]),
            ("coupler_x", self.coupler_x.is_some(), &[SliderCrank, InvertedSliderCrank]),
            ("coupler_y", self.coupler_y.is_some(), &[SliderCrank, InvertedSliderCrank]),
        ];
        keys.into_iter().find_map(|(key, given, of)| (given && !of.contains(&kind)).then_some(key))
    }
}

impl TryFrom<LinkageKeys> for CrankLinkage {
    type Error = NoLinkage;

    fn try_from(keys: LinkageKeys) -> Result<Self, NoLinkage> {
        fn given<T>(value: Option<T>, key: &'static str) -> Result<T, NoLinkage> {
            value.ok_or(NoLinkage::Missing(key))
        }
        let kind = keys.kind.unwrap_or(LinkageKind::FourBar);
        if let Some(key) = keys.stray(kind) {
            return Err(NoLinkage::Stray(kind, key));
        }
        let crank_pivot = || given(keys.crank_pivot, "A");
        let (crank, assembly) = (|| given(keys.a, "a"), || given(keys.t1, "t1"));
        Ok(match kind {
            LinkageKind::FourBar => FourBar::new(NaturalCoordinates {
                crank_pivot: crank_pivot()?,
                crank: crank()?,
                assembly: assembly()?,
                follower_pivot: given(keys.second_pivot, "B")?,
                coupler: given(keys.b, "b")?,
                follower: given(keys.c, "c")?,
                crank_side: given(keys.d, "d")?,
                follower_side: given(keys.e, "e")?,
                side: given(keys.t2, "t2")?,
            })?
            .into(),
            LinkageKind::SliderCrank => SliderCrank::new(SliderCrankParameters {
                crank_pivot: crank_pivot()?,
                crank: crank()?,
                assembly: assembly()?,
                coupler: given(keys.b, "b")?,
                line_point: given(keys.line_point, "line_point")?,
                line_deg: given(keys.line_deg, "line_deg")?,
                coupler_x: given(keys.coupler_x, "coupler_x")?,
                coupler_y: given(keys.coupler_y, "coupler_y")?,
            })?
            .into(),
            LinkageKind::InvertedSliderCrank => InvertedSliderCrank::new(InvertedSliderCrankParameters {
                crank_pivot: crank_pivot()?,
                crank: crank()?,
                assembly: assembly()?,
                block_pivot: given(keys.second_pivot, "B")?,
                offset: given(keys.offset, "offset")?,
                coupler_x: given(keys.coupler_x, "coupler_x")?,
                coupler_y: given(keys.coupler_y, "coupler_y")?,
            })?
            .into(),
            LinkageKind::SixBar | LinkageKind::EightBar => {
                let linkage = MultiLoop::from_keys(&given(keys.chain, "chain")?)?;
                if linkage.linkage_kind() != kind {
                    return Err(NoLinkage::OtherKind(kind));
                }
                linkage.into()
            }
        })
    }
}

impl<'de> Deserialize<'de> for CrankLinkage {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        LinkageKeys::deserialize(deserializer)?.try_into().map_err(D::Error::custom)
    }
}

impl schemars::JsonSchema for CrankLinkage {
    fn schema_name() -> Cow<'static, str> {
        "CrankLinkage".into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        LinkageKeys::json_schema(generator)
    }
}
