//! How a linkage is written and read: a four-bar by its keys alone, other kinds with their name under `kind`.

use super::{CrankLinkage, LinkageKind};
use crate::mechanism::{
    AssemblyMode, ChainKeys, CouplerSide, FourBar, InvertedSliderCrank, InvertedSliderCrankParameters,
    LinkageError, MultiLoop, NaturalCoordinates, NoMultiLoop, SliderCrank, SliderCrankParameters,
};
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use std::borrow::Cow;

/// The name of the kind, as the key `kind` of a slider-crank.
#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
enum SliderCrankKind {
    SliderCrank,
}

/// The name of the kind, as the key `kind` of an inverted slider-crank.
#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
enum InvertedSliderCrankKind {
    InvertedSliderCrank,
}

/// The name of the kind, as the key `kind` of a linkage of several loops.
#[derive(Serialize)]
#[serde(rename_all = "kebab-case")]
enum MultiLoopKind {
    SixBar,
    EightBar,
}

/// A linkage as it stands in records: a four-bar by its keys alone, other kinds with their name under `kind`.
#[derive(Serialize)]
#[serde(untagged)]
enum Written {
    /// A four-bar.
    FourBar(NaturalCoordinates),
    /// A slider-crank.
    SliderCrank {
        /// The kind.
        kind: SliderCrankKind,
        #[serde(flatten)]
        parameters: SliderCrankParameters,
    },
    /// An inverted slider-crank.
    InvertedSliderCrank {
        /// The kind.
        kind: InvertedSliderCrankKind,
        #[serde(flatten)]
        parameters: InvertedSliderCrankParameters,
    },
    /// A six-bar or an eight-bar.
    MultiLoop {
        /// The kind.
        kind: MultiLoopKind,
        /// Its chain.
        chain: ChainKeys,
    },
}

impl Serialize for CrankLinkage {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let written = match self {
            CrankLinkage::FourBar(linkage) => Written::FourBar(linkage.natural_coordinates()),
            CrankLinkage::SliderCrank(linkage) => {
                Written::SliderCrank { kind: SliderCrankKind::SliderCrank, parameters: linkage.parameters() }
            }
            CrankLinkage::InvertedSliderCrank(linkage) => Written::InvertedSliderCrank {
                kind: InvertedSliderCrankKind::InvertedSliderCrank,
                parameters: linkage.parameters(),
            },
            CrankLinkage::MultiLoop(linkage) => Written::MultiLoop {
                kind: match linkage.dyad_count() {
                    2 => MultiLoopKind::SixBar,
                    _ => MultiLoopKind::EightBar,
                },
                chain: linkage.keys(),
            },
        };
        written.serialize(serializer)
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
    #[error("a {0} has no key `{1}`")]
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
    #[error("this chain is not that of a {0}")]
    OtherKind(LinkageKind),
}

impl LinkageKeys {
    /// Returns the keys that are there although the kind has none of them.
    fn stray(&self, kind: LinkageKind) -> Option<&'static str> {
        let (four_bar, slider, inverted) = (
            kind == LinkageKind::FourBar,
            kind == LinkageKind::SliderCrank,
            kind == LinkageKind::InvertedSliderCrank,
        );
        let several = kind.dyads().is_some();
        [
            ("A", self.crank_pivot.is_some() && several),
            ("a", self.a.is_some() && several),
            ("t1", self.t1.is_some() && several),
            ("chain", self.chain.is_some() && !several),
            ("B", self.second_pivot.is_some() && (slider || several)),
            ("b", self.b.is_some() && (inverted || several)),
            ("c", self.c.is_some() && !four_bar),
            ("d", self.d.is_some() && !four_bar),
            ("e", self.e.is_some() && !four_bar),
            ("t2", self.t2.is_some() && !four_bar),
            ("line_point", self.line_point.is_some() && !slider),
            ("line_deg", self.line_deg.is_some() && !slider),
            ("offset", self.offset.is_some() && !inverted),
            ("coupler_x", self.coupler_x.is_some() && (four_bar || several)),
            ("coupler_y", self.coupler_y.is_some() && (four_bar || several)),
        ]
        .into_iter()
        .find_map(|(key, strays)| strays.then_some(key))
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
        if let Some(dyads) = kind.dyads() {
            let linkage = MultiLoop::from_keys(&given(keys.chain, "chain")?)?;
            return match linkage.dyad_count() == dyads {
                true => Ok(linkage.into()),
                false => Err(NoLinkage::OtherKind(kind)),
            };
        }
        let crank_pivot = given(keys.crank_pivot, "A")?;
        let (crank, assembly) = (given(keys.a, "a")?, given(keys.t1, "t1")?);
        Ok(match kind {
            LinkageKind::FourBar => FourBar::new(NaturalCoordinates {
                crank_pivot,
                follower_pivot: given(keys.second_pivot, "B")?,
                crank,
                coupler: given(keys.b, "b")?,
                follower: given(keys.c, "c")?,
                crank_side: given(keys.d, "d")?,
                follower_side: given(keys.e, "e")?,
                assembly,
                side: given(keys.t2, "t2")?,
            })?
            .into(),
            LinkageKind::SliderCrank => SliderCrank::new(SliderCrankParameters {
                crank_pivot,
                crank,
                coupler: given(keys.b, "b")?,
                line_point: given(keys.line_point, "line_point")?,
                line_deg: given(keys.line_deg, "line_deg")?,
                coupler_x: given(keys.coupler_x, "coupler_x")?,
                coupler_y: given(keys.coupler_y, "coupler_y")?,
                assembly,
            })?
            .into(),
            LinkageKind::InvertedSliderCrank => InvertedSliderCrank::new(InvertedSliderCrankParameters {
                crank_pivot,
                block_pivot: given(keys.second_pivot, "B")?,
                crank,
                offset: given(keys.offset, "offset")?,
                coupler_x: given(keys.coupler_x, "coupler_x")?,
                coupler_y: given(keys.coupler_y, "coupler_y")?,
                assembly,
            })?
            .into(),
            // Read above.
            LinkageKind::SixBar | LinkageKind::EightBar => return Err(NoLinkage::Missing("chain")),
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
