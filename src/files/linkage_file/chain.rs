//! The `[chain]` form of linkage files: pivots, a crank and stages by name, the stages in the order of the file.

use crate::files::diagnostic::{Checked, Diagnostic, quoted};
use crate::files::toml_text::{TomlText, nearest};
use crate::files::toml_values::{Number, OnlyTable, XY, list_of};
use crate::mechanism::chain::{
    Attachment, Chain, ChainBuilder, ChainError, ChainFault, ChainPlace, SliderLine, Stage,
};
use crate::mechanism::{AssemblyMode, CouplerSide};
use schemars::JsonSchema;
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use toml::Spanned;

/// Two names of points.
#[derive(JsonSchema)]
#[schemars(inline)]
struct Names([String; 2]);

impl<'de> Deserialize<'de> for Names {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        list_of(from, "two names of points [\"B\", \"D\"]").map(Names)
    }
}

/// Two lengths.
#[derive(JsonSchema)]
#[schemars(inline)]
struct Lengths([f64; 2]);

impl<'de> Deserialize<'de> for Lengths {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        list_of(from, "two lengths [from the first point, from the second]")
            .map(|lengths: [Number; 2]| Lengths(lengths.map(|n| n.0)))
    }
}

/// A driven crank and stages, each hung on points that stand above it.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Chain")]
pub(super) struct RawChain {
    /// The point whose path is drawn; the last that is made where this is missing.
    trace: Option<String>,
    /// Fixed pivots: a name and a point each.
    pivots: OnlyTable<BTreeMap<String, XY>>,
    /// The driven crank.
    crank: OnlyTable<RawCrank>,
    /// Two links that meet in a new joint.
    #[serde(default)]
    #[schemars(with = "Vec<RawDyad>")]
    dyad: Vec<Spanned<OnlyTable<RawDyad>>>,
    /// Points attached to links.
    #[serde(default)]
    #[schemars(with = "Vec<RawPoint>")]
    point: Vec<Spanned<OnlyTable<RawPoint>>>,
    /// Links whose end slides along a line.
    #[serde(default)]
    #[schemars(with = "Vec<RawSlider>")]
    slider: Vec<Spanned<OnlyTable<RawSlider>>>,
    /// Links that turn about a point while a block slides along them.
    #[serde(default)]
    #[schemars(with = "Vec<RawGuide>")]
    guide: Vec<Spanned<OnlyTable<RawGuide>>>,
}

/// The driven crank.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ChainCrank")]
struct RawCrank {
    /// The name of its fixed pivot.
    pivot: String,
    /// The name of the joint that it carries.
    joint: String,
    /// From pivot to joint.
    length: Number,
}

/// Two links from two points to a new joint.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ChainDyad")]
struct RawDyad {
    /// The name of the new joint.
    joint: String,
    /// The two points that it hangs on.
    from: Names,
    /// The two links.
    lengths: Lengths,
    /// 1: the joint lies left of the line from the first point to the second; -1: right.
    #[schemars(with = "i64")]
    side: AssemblyMode,
}

/// A point attached to a link: at, or distances and side.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ChainPoint")]
struct RawPoint {
    /// The name of the new point.
    name: String,
    /// Two points of the link.
    on: Names,
    /// Along the line from the first point to the second, and to its left, from the first point.
    at: Option<XY>,
    /// From the first point, from the second.
    distances: Option<Lengths>,
    /// With distances; 1: left of the line from the first point to the second; -1: right.
    #[schemars(with = "Option<i64>")]
    side: Option<CouplerSide>,
}

/// A link whose end slides along a line: through and angle_deg, or along.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ChainSlider")]
struct RawSlider {
    /// The name of the joint that slides.
    joint: String,
    /// The point that the link hangs on.
    from: String,
    /// The link.
    length: Number,
    /// A point of a fixed line.
    through: Option<XY>,
    /// The direction of that line, from the x axis.
    angle_deg: Option<Number>,
    /// Two points of a link that carries the line.
    along: Option<Names>,
    /// With along: how far the line lies to the left of these points; 0 where this is missing.
    offset: Option<Number>,
    /// Of the two places on the line, 1: the one further along it; -1: the other.
    #[schemars(with = "i64")]
    side: AssemblyMode,
}

/// A link that turns about a point while a block slides along it.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ChainGuide")]
struct RawGuide {
    /// The name of the new joint on the link.
    joint: String,
    /// The point that the link turns about.
    pivot: String,
    /// The point of the block.
    block: String,
    /// The joint along the guide and to its left, from the pivot.
    at: XY,
    /// The distance at which the block slides to the left of the line through the pivot; 0 where this is missing.
    offset: Option<Number>,
    /// 1 (default): the block is ahead of the pivot along the guide; -1: behind it.
    #[schemars(with = "Option<i64>")]
    side: Option<AssemblyMode>,
}

/// A stage with the path of its table and the table's start in the text.
struct Placed {
    start: usize,
    path: String,
    stage: Checked<Stage>,
}

/// Builds the chain of a file's table.
pub(super) fn chain(toml: &TomlText<'_>, raw: RawChain) -> Checked<Chain> {
    let mut placed = Vec::new();
    place(&mut placed, "dyad", raw.dyad, |_, d| {
        Ok(Stage::Dyad { joint: d.joint, from: d.from.0, lengths: d.lengths.0, side: d.side })
    });
    place(&mut placed, "point", raw.point, |path, p| attached(toml, path, p));
    place(&mut placed, "slider", raw.slider, |path, s| sliding(toml, path, s));
    place(&mut placed, "guide", raw.guide, |_, g| {
        Ok(Stage::Guide {
            joint: g.joint,
            pivot: g.pivot,
            block: g.block,
            at: g.at.0,
            offset: g.offset.map_or(0.0, |n| n.0),
            side: g.side.unwrap_or(AssemblyMode::Plus),
        })
    });
    placed.sort_by_key(|p| p.start);
    let (paths, stages): (Vec<String>, Vec<_>) = placed.into_iter().map(|p| (p.path, p.stage)).unzip();
    let OnlyTable(crank) = raw.crank;
    let builder = ChainBuilder {
        pivots: raw.pivots.0.into_iter().map(|(name, at)| (name, at.0)).collect(),
        crank_pivot: crank.pivot,
        crank_joint: crank.joint,
        crank: crank.length.0,
        stages: stages.into_iter().collect::<Result<_, _>>()?,
        trace: raw.trace,
    };
    builder.build().map_err(|error| explain(toml, &error, &paths))
}

/// Adds the stages of one kind.
fn place<T>(
    placed: &mut Vec<Placed>,
    kind: &str,
    raw: Vec<Spanned<OnlyTable<T>>>,
    stage: impl Fn(&str, T) -> Checked<Stage>,
) {
    for (i, spanned) in raw.into_iter().enumerate() {
        let path = format!("chain.{kind}.{i}");
        let start = spanned.span().start;
        let stage = stage(&path, spanned.into_inner().0);
        placed.push(Placed { start, path, stage });
    }
}

fn attached(toml: &TomlText<'_>, path: &str, raw: RawPoint) -> Checked<Stage> {
    let refuse =
        |key: &str, message: &str, help: &str| toml.refuse_key(&format!("{path}.{key}"), message, help);
    let at = match (raw.at, raw.distances, raw.side) {
        (Some(at), None, None) => Attachment::Offset(at.0),
        (None, Some(distances), Some(side)) => Attachment::Distances(distances.0, side),
        (Some(_), Some(_), _) => {
            return refuse("distances", "two places: at and distances", "keep one of the two keys");
        }
        (Some(_), None, Some(_)) => {
            let help = "remove side: the sign of the second number of at tells the side";
            return refuse("side", "side goes with distances", help);
        }
        (None, Some(_), None) => {
            let help = "add side = 1 (left of the line from the first point to the second) or side = -1";
            return refuse("distances", "distances alone fit on either side of the link", help);
        }
        (None, None, _) => {
            let help = "add at = [along, across], or distances = [from first, from second] with side";
            return refuse("name", "this point has no place on its link", help);
        }
    };
    Ok(Stage::Point { name: raw.name, on: raw.on.0, at })
}

fn sliding(toml: &TomlText<'_>, path: &str, raw: RawSlider) -> Checked<Stage> {
    let refuse =
        |key: &str, message: &str, help: &str| toml.refuse_key(&format!("{path}.{key}"), message, help);
    let line = match (raw.through, raw.angle_deg, raw.along) {
        (Some(through), Some(angle), None) if raw.offset.is_none() => {
            SliderLine::Fixed { through: through.0, angle: angle.0.to_radians() }
        }
        (None, None, Some(along)) => {
            SliderLine::OnLink { along: along.0, offset: raw.offset.map_or(0.0, |n| n.0) }
        }
        (_, _, Some(_)) => {
            let help = "keep through and angle_deg (a fixed line), or along (a line on a link)";
            return refuse("along", "two lines: one that is fixed and one on a link", help);
        }
        (Some(_), Some(_), None) => {
            let help = "remove offset: a fixed line goes through the point that you choose";
            return refuse("offset", "offset goes with along", help);
        }
        (through, _, None) => {
            let key = if through.is_some() { "through" } else { "joint" };
            let help = "add through = [x, y] and angle_deg (a fixed line), or along = [\"D\", \"E\"] (a line \
                        on a link)";
            return refuse(key, "this slider has no line to slide along", help);
        }
    };
    Ok(Stage::Slider { joint: raw.joint, from: raw.from, length: raw.length.0, line, side: raw.side })
}

/// Returns the diagnostic of a chain's error, at the value that it is about.
fn explain(toml: &TomlText<'_>, error: &ChainError, paths: &[String]) -> Box<Diagnostic> {
    let base = match &error.place {
        ChainPlace::Pivot(name) => format!("chain.pivots.{name}"),
        ChainPlace::Crank => format!("chain.crank.{}", error.key),
        ChainPlace::Chain => format!("chain.{}", error.key),
        ChainPlace::Stage(i) => match paths.get(*i) {
            Some(path) => format!("{path}.{}", error.key),
            None => "chain".to_owned(),
        },
    };
    let path = error.index.map_or(base.clone(), |i| format!("{base}.{i}"));
    let fault = &error.fault;
    let message = match fault {
        // A name may be any text, so it is quoted.
        ChainFault::UnknownPoint { name, .. } => format!("there is no point {}", quoted(name)),
        ChainFault::BadName(name) => format!("{} is no name of a point", quoted(name)),
        ChainFault::NotAPivot { name, .. } => format!("{} is not a fixed pivot", quoted(name)),
        other => other.to_string(),
    };
    let diagnostic = match (&error.place, fault) {
        (ChainPlace::Pivot(_), ChainFault::BadName { .. } | ChainFault::DuplicateName { .. }) => {
            toml.at_key(&path, message)
        }
        _ => toml.at(&path, message),
    };
    Box::new(diagnostic.with_help(remedy(fault)))
}

fn remedy(fault: &ChainFault) -> String {
    match fault {
        ChainFault::UnknownPoint { name, known } => meant(name, known, "points"),
        ChainFault::NotAPivot { name, known } if known.is_empty() => {
            format!("name it in [chain.pivots]: {} = [0, 0]", if name.is_empty() { "A" } else { name })
        }
        ChainFault::NotAPivot { name, known } => meant(name, known, "pivots"),
        ChainFault::ForwardReference { itself: true, .. } => {
            "a stage hangs on points that are known before it".into()
        }
        ChainFault::ForwardReference { name, .. } => {
            format!("stages are assembled as they stand: move this table below the one that makes {name}")
        }
        ChainFault::DuplicateName { .. } => "give each point its own name".into(),
        ChainFault::BadName { .. } => "a point's name is 1 to 16 letters, digits, _ and -".into(),
        ChainFault::NotFinite { .. } => "use a larger unit, such as m for mm".into(),
        ChainFault::LengthNotPositive { .. } => "write a length above 0".into(),
        ChainFault::DistanceNegative { .. } => "write a distance of 0 or more; side tells the side".into(),
        ChainFault::SamePoint { .. } => "name two points".into(),
        ChainFault::NotOnOneLink { .. } => {
            "a link carries the two ends that a stage gives it, and every point attached to it".into()
        }
        ChainFault::Coincident { .. } => "name two points of the link that are apart".into(),
        ChainFault::NoLength => "write at = [length, 0]".into(),
        ChainFault::NoTriangle { .. } => "each side is at most the sum of the other two".into(),
        ChainFault::TooManyStages(_) => "leave out what the traced point doesn't need".into(),
    }
}

/// Returns a hint with the nearest name, and the list of known names.
fn meant(name: &str, known: &[String], kind: &str) -> String {
    /// Maximum number of names in the list; more are no help.
    const LISTED: usize = 24;
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let hint = nearest(name, &known).map_or(String::new(), |n| format!("did you mean \"{n}\"? "));
    let more = if known.len() > LISTED { ", .." } else { "" };
    format!("{hint}{kind} of this chain: {}{more}", known[..known.len().min(LISTED)].join(", "))
}
