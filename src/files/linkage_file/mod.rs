//! Linkage files: a four-bar in natural coordinates or as a vector loop, a linkage with a slider, or a chain of stages.

mod chain;
mod multi_loop;
mod sliders;

pub use multi_loop::multi_loop_to_toml;
pub use sliders::{inverted_slider_crank_to_toml, slider_crank_to_toml};

use crate::files::diagnostic::{Checked, Diagnostic};
use crate::files::input_text;
use crate::files::loads_file::{RawLoads, of_linkage_file};
use crate::files::name;
use crate::files::shop_file::{self, RawShop};
use crate::files::toml_text::TomlText;
use crate::files::toml_values::{Count, Number, OnlyTable, XY};
use crate::mechanism::loads::Loads;
use crate::mechanism::plates::Shop;
use crate::mechanism::{
    AssemblyMode, CouplerSide, CrankLinkage, FourBar, InvertedSliderCrank, Linkage, LinkageError,
    MAX_MAGNITUDE, MultiLoop, NaturalCoordinates, NoMultiLoop, SliderCrank, Unit, VectorLoop,
};
use crate::record::Candidate;
use crate::task::Sense;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::Path;

/// The format of linkage files that this program reads and writes.
pub const FORMAT: u64 = 1;

/// A linkage with its name and the unit of its lengths.
#[derive(Clone, Debug, PartialEq)]
pub struct LinkageFile<L = FourBar> {
    /// Its name; the file stem if the file has none.
    pub name: String,
    /// The unit that labels lengths.
    pub unit: Option<Unit>,
    /// The linkage.
    pub linkage: L,
}

/// A linkage of any kind with its name and the unit of its lengths.
pub type AnyLinkageFile = LinkageFile<Linkage>;

/// A linkwright linkage file.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "LinkageFile")]
pub(crate) struct RawLinkageFile {
    /// 1.
    #[schemars(required)]
    format: Option<Count>,
    /// 1 to 64 letters, digits, blanks and - _ .
    name: Option<String>,
    /// The unit of lengths.
    unit: Option<Unit>,
    /// A four-bar in natural coordinates.
    linkage: Option<OnlyTable<RawLinkage>>,
    /// A four-bar as a vector loop.
    vector_loop: Option<OnlyTable<RawVectorLoop>>,
    /// A slider-crank.
    slider_crank: Option<OnlyTable<sliders::RawSliderCrank>>,
    /// An inverted slider-crank.
    inverted_slider_crank: Option<OnlyTable<sliders::RawInvertedSliderCrank>>,
    /// A compound mechanism, stage by stage.
    chain: Option<OnlyTable<chain::RawChain>>,
    /// Masses, forces, couples and springs, with which `analyze` finds torques and joint forces; `unit` is required then.
    loads: Option<OnlyTable<RawLoads>>,
    /// Sizes of holes, pins, plates and rims, with which `build` and `export` make plates.
    shop: Option<OnlyTable<RawShop>>,
}

/// Pivots A and B, lengths and two signs.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Linkage")]
struct RawLinkage {
    /// The fixed pivot of the crank.
    #[serde(rename = "A")]
    crank_pivot: XY,
    /// The fixed pivot of the follower.
    #[serde(rename = "B")]
    follower_pivot: XY,
    /// |AC|, the crank.
    a: Number,
    /// |CD|, the coupler.
    b: Number,
    /// |BD|, the follower.
    c: Number,
    /// |CP|.
    d: Number,
    /// |DP|.
    e: Number,
    /// 1: D lies left of the line from C to B; -1: right.
    #[schemars(with = "i64")]
    t1: AssemblyMode,
    /// 1: P lies left of the line from C to D; -1: right.
    #[schemars(with = "i64")]
    t2: CouplerSide,
}

/// Pivots, link lengths and a polar coupler point.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "VectorLoop")]
struct RawVectorLoop {
    /// The fixed pivot of the crank.
    #[serde(rename = "O1")]
    crank_pivot: XY,
    /// The fixed pivot of the follower.
    #[serde(rename = "O2")]
    follower_pivot: XY,
    /// The crank.
    #[serde(rename = "L2")]
    crank: Number,
    /// The coupler.
    #[serde(rename = "L3")]
    coupler: Number,
    /// The follower.
    #[serde(rename = "L4")]
    follower: Number,
    /// From the crank pin to the coupler point.
    #[serde(rename = "Z1")]
    coupler_point: Number,
    /// From the coupler's line to the coupler point, degrees.
    beta_deg: Number,
    /// 1: D lies left of the line from C to B; -1: right.
    #[schemars(with = "i64")]
    t1: AssemblyMode,
}

/// Help for a file without a linkage.
const KINDS: &str = "a linkage file has a table [linkage] with A, B, a, b, c, d, e, t1, t2, or [vector_loop], \
                     [slider_crank], [inverted_slider_crank] or [chain]";

/// Returns the kind of a linkage with its article: `a slider-crank`.
pub fn kind_in_words(linkage: &Linkage) -> String {
    match linkage {
        Linkage::FourBar(_) => "a four-bar",
        Linkage::SliderCrank(_) => "a slider-crank",
        Linkage::InvertedSliderCrank(_) => "an inverted slider-crank",
        Linkage::MultiLoop(linkage) => return linkage.linkage_kind().with_article(),
        Linkage::Chain(_) => "a chain",
    }
    .to_owned()
}

/// Reads the four-bar of a file.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault; linkages of other kinds are refused, see [`load_any`].
pub fn load(path: &Path) -> Result<LinkageFile, Box<Diagnostic>> {
    let text = input_text::read(path)?;
    parse(&path.display().to_string(), &text)
}

/// Reads the linkage of a file, of any kind.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault.
pub fn load_any(path: &Path) -> Result<AnyLinkageFile, Box<Diagnostic>> {
    let text = input_text::read(path)?;
    parse_any(&path.display().to_string(), &text)
}

/// Reads the four-bar of a text; `file_name` is shown in diagnostics and gives the default name.
///
/// # Errors
/// As [`load`].
pub fn parse(file_name: &str, text: &str) -> Result<LinkageFile, Box<Diagnostic>> {
    let AnyLinkageFile { name, unit, linkage } = parse_any(file_name, text)?;
    match linkage {
        Linkage::FourBar(linkage) => Ok(LinkageFile { name, unit, linkage }),
        other => {
            let message =
                format!("{} is not a four-bar, and a four-bar is needed here", kind_in_words(&other));
            let help = "give a linkage file with [linkage] or [vector_loop]";
            refuse_kind((file_name, text), &other, message, help)
        }
    }
}

/// Refuses the linkage of a text because of its kind, at its table.
fn refuse_kind<T>(
    (file, text): (&str, &str),
    linkage: &Linkage,
    message: String,
    help: &str,
) -> Result<T, Box<Diagnostic>> {
    let toml = TomlText { file, text: input_text::without_mark(text) };
    let table = match linkage {
        Linkage::SliderCrank(_) => "slider_crank",
        Linkage::InvertedSliderCrank(_) => "inverted_slider_crank",
        Linkage::Chain(_) | Linkage::MultiLoop(_) | Linkage::FourBar(_) => "chain",
    };
    toml.refuse_key(table, message, help)
}

/// Reads a file with a linkage of a kind that synthesis finds: a four-bar, a linkage with a slider, a six-bar or an
/// eight-bar, also as the chain that it is.
///
/// # Errors
/// As [`load`].
pub fn load_crank_linkage(path: &Path) -> Result<LinkageFile<CrankLinkage>, Box<Diagnostic>> {
    let text = input_text::read(path)?;
    parse_crank_linkage(&path.display().to_string(), &text)
}

/// Reads such a linkage of a text, as [`load_crank_linkage`] does.
///
/// # Errors
/// As [`load`].
pub fn parse_crank_linkage(
    file_name: &str,
    text: &str,
) -> Result<LinkageFile<CrankLinkage>, Box<Diagnostic>> {
    let AnyLinkageFile { name, unit, linkage } = parse_any(file_name, text)?;
    match crank_linkage(&linkage) {
        Ok(linkage) => Ok(LinkageFile { name, unit, linkage }),
        Err(error) => {
            let message = format!(
                "this chain is none of the linkages that are searched for, drawn and compared: as a six-bar, {error}"
            );
            let help = "give a linkage file with [linkage], [vector_loop], [slider_crank] or [inverted_slider_crank]";
            refuse_kind((file_name, text), &linkage, message, help)
        }
    }
}

/// Returns a linkage as one of a kind that synthesis finds.
fn crank_linkage(linkage: &Linkage) -> Result<CrankLinkage, NoMultiLoop> {
    match linkage {
        Linkage::FourBar(linkage) => Ok(CrankLinkage::FourBar(*linkage)),
        Linkage::SliderCrank(linkage) => Ok(CrankLinkage::SliderCrank(*linkage)),
        Linkage::InvertedSliderCrank(linkage) => Ok(CrankLinkage::InvertedSliderCrank(*linkage)),
        Linkage::MultiLoop(linkage) => Ok(CrankLinkage::MultiLoop(**linkage)),
        Linkage::Chain(chain) => SliderCrank::from_chain(chain)
            .map(CrankLinkage::SliderCrank)
            .or_else(|| InvertedSliderCrank::from_chain(chain).map(CrankLinkage::InvertedSliderCrank))
            .map_or_else(|| MultiLoop::from_chain(chain).map(CrankLinkage::MultiLoop), Ok),
    }
}

/// Reads the linkage of a text, of any kind; its loads are checked.
///
/// # Errors
/// As [`load_any`].
pub fn parse_any(file_name: &str, text: &str) -> Result<AnyLinkageFile, Box<Diagnostic>> {
    parse_loaded(file_name, text).map(|(file, _)| file)
}

/// Reads the linkage of a file, of any kind, and its loads if it has the table `[loads]`.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault.
pub fn load_loaded(path: &Path) -> Result<(AnyLinkageFile, Option<Loads>), Box<Diagnostic>> {
    let text = input_text::read(path)?;
    parse_loaded(&path.display().to_string(), &text)
}

/// Reads the linkage of a text, of any kind, and its loads if it has the table `[loads]`.
///
/// # Errors
/// As [`load_loaded`].
pub fn parse_loaded(file_name: &str, text: &str) -> Result<(AnyLinkageFile, Option<Loads>), Box<Diagnostic>> {
    parse_tables(file_name, text).map(|(file, loads, _)| (file, loads))
}

/// Reads the shop data of a linkage file; `None` without a table `[shop]`.
///
/// # Errors
/// As [`load_loaded`].
pub fn load_shop(path: &Path) -> Result<Option<Shop>, Box<Diagnostic>> {
    let text = input_text::read(path)?;
    parse_tables(&path.display().to_string(), &text).map(|(.., shop)| shop)
}

/// A linkage with its loads and its shop data.
type Tables = (AnyLinkageFile, Option<Loads>, Option<Shop>);

/// Reads all tables of a text.
fn parse_tables(file_name: &str, text: &str) -> Result<Tables, Box<Diagnostic>> {
    let toml = TomlText { file: file_name, text: input_text::without_mark(text) };
    if toml.text.trim().is_empty() {
        return toml.refuse_file("the file is empty", KINDS);
    }
    let raw: RawLinkageFile = toml.read()?;
    check_format(&toml, raw.format, FORMAT)?;
    let name = checked_name(&toml, raw.name, "linkage")?;
    let given = [
        ("linkage", raw.linkage.is_some()),
        ("vector_loop", raw.vector_loop.is_some()),
        ("slider_crank", raw.slider_crank.is_some()),
        ("inverted_slider_crank", raw.inverted_slider_crank.is_some()),
        ("chain", raw.chain.is_some()),
    ];
    let given: Vec<&str> = given.into_iter().filter(|(_, there)| *there).map(|(table, _)| table).collect();
    if let [first, .., last] = given[..] {
        let message = format!("two linkages: [{first}] and [{last}]");
        return toml.refuse_key(last, message, "keep one of the two tables");
    }
    let linkage = if let Some(OnlyTable(natural)) = raw.linkage {
        Linkage::FourBar(natural_linkage(natural).map_err(|e| explain(&toml, &e, "linkage"))?)
    } else if let Some(OnlyTable(vector_loop)) = raw.vector_loop {
        Linkage::FourBar(from_vector_loop(&vector_loop).map_err(|e| explain(&toml, &e, "vector_loop"))?)
    } else if let Some(OnlyTable(raw)) = raw.slider_crank {
        let read = sliders::slider_crank(raw).map_err(|e| explain(&toml, &e, "slider_crank"))?;
        Linkage::SliderCrank(read)
    } else if let Some(OnlyTable(raw)) = raw.inverted_slider_crank {
        let read =
            sliders::inverted_slider_crank(raw).map_err(|e| explain(&toml, &e, "inverted_slider_crank"))?;
        Linkage::InvertedSliderCrank(read)
    } else if let Some(OnlyTable(chain)) = raw.chain {
        Linkage::Chain(Box::new(chain::chain(&toml, chain)?))
    } else {
        return toml.refuse_file("there is no linkage in this file", KINDS);
    };
    let unit = raw.unit;
    let loads =
        raw.loads.map(|OnlyTable(loads)| of_linkage_file(&toml, loads, unit, &linkage)).transpose()?;
    let read = |OnlyTable(shop)| {
        shop_file::of_linkage_file(&toml, shop, unit, crank_linkage(&linkage).ok().as_ref())
    };
    let shop = raw.shop.map(read).transpose()?;
    Ok((LinkageFile { name, unit, linkage }, loads, shop))
}

fn natural_linkage(raw: RawLinkage) -> Result<FourBar, LinkageError> {
    FourBar::new(NaturalCoordinates {
        crank_pivot: raw.crank_pivot.0,
        follower_pivot: raw.follower_pivot.0,
        crank: raw.a.0,
        coupler: raw.b.0,
        follower: raw.c.0,
        crank_side: raw.d.0,
        follower_side: raw.e.0,
        assembly: raw.t1,
        side: raw.t2,
    })
}

fn from_vector_loop(raw: &RawVectorLoop) -> Result<FourBar, LinkageError> {
    FourBar::from_vector_loop(VectorLoop {
        crank_pivot: raw.crank_pivot.0,
        follower_pivot: raw.follower_pivot.0,
        crank: raw.crank.0,
        coupler: raw.coupler.0,
        follower: raw.follower.0,
        coupler_point: raw.coupler_point.0,
        beta_deg: raw.beta_deg.0,
        assembly: raw.t1,
    })
}

/// Returns the diagnostic of a linkage's error, at the key of the file's table that it is about.
fn explain(toml: &TomlText<'_>, error: &LinkageError, table: &str) -> Box<Diagnostic> {
    let name = |key: &'static str| if table == "vector_loop" { vector_loop_key(key) } else { key };
    let path = |key: &'static str| format!("{table}.{}", name(key));
    Box::new(match error {
        LinkageError::NotFinite { key, value } => toml
            .at(&path(key), format!("{} = {value} is not a finite number below {MAX_MAGNITUDE:e}", name(key)))
            .with_help(match *key {
                "line_deg" => "write a direction in degrees, such as 30",
                _ => "use a larger unit, such as m for mm",
            }),
        LinkageError::LengthNotPositive { key, value } => toml
            .at(&path(key), format!("{} = {value}: a link's length must be positive", name(key)))
            .with_help("write a length above 0"),
        LinkageError::DistanceNegative { key, value } => toml
            .at(&path(key), format!("{} = {value}: a distance cannot be negative", name(key)))
            .with_help("write a distance of 0 or more; t2, or beta_deg, tells the side of the coupler point"),
        LinkageError::NoCouplerTriangle { b, d, e } => {
            toml.at(&path("d"), no_triangle(*b, *d, *e)).with_help(triangle_remedy(*b, *d, *e))
        }
    })
}

/// Returns the message about sides b, d, e that make no triangle.
pub(crate) fn no_triangle(b: f64, d: f64, e: f64) -> String {
    format!("impossible triangle: no coupler has the sides b = {b}, d = {d}, e = {e}")
}

/// Returns help for sides b, d, e that make no triangle.
pub(crate) fn triangle_remedy(b: f64, d: f64, e: f64) -> String {
    let [(first, x), (second, y), (longest, z)] = {
        let mut sides = [("b", b), ("d", d), ("e", e)];
        sides.sort_by(|l, r| l.1.total_cmp(&r.1));
        sides
    };
    format!(
        "each side is at most the sum of the other two: {longest} = {z} against {first} + {second} = {}",
        x + y
    )
}

fn vector_loop_key(key: &str) -> &'static str {
    match key {
        "A" => "O1",
        "B" => "O2",
        "a" => "L2",
        "b" => "L3",
        "c" => "L4",
        "beta_deg" => "beta_deg",
        _ => "Z1",
    }
}

/// Refuses a file of another format.
pub(crate) fn check_format(toml: &TomlText<'_>, format: Option<Count>, read: u64) -> Checked<()> {
    match format {
        Some(Count(version)) if version == read => Ok(()),
        Some(Count(version)) => toml.refuse(
            "format",
            format!("this program reads format {read}, this file has format {version}"),
            if version > read {
                "install a newer linkwright".to_owned()
            } else {
                format!("write format = {read}")
            },
        ),
        None => toml.refuse_file(
            format!("the key `format` is missing: this program reads format {read}"),
            format!("write format = {read} as the first line"),
        ),
    }
}

/// Returns the name in the file, or one made from the file's name.
pub(crate) fn checked_name(toml: &TomlText<'_>, given: Option<String>, fallback: &str) -> Checked<String> {
    let Some(given) = given else { return Ok(name::from_file(toml.file, fallback)) };
    match name::check(&given) {
        Ok(()) => Ok(given),
        Err(error) => toml.refuse("name", error.to_string(), error.remedy()),
    }
}

/// Returns the text of a linkage file; every number reads back to the same digits.
pub fn to_toml(name: &str, unit: Option<Unit>, linkage: &FourBar) -> String {
    let p = linkage.natural_coordinates();
    let ([ax, ay], [bx, by]) = (p.crank_pivot, p.follower_pivot);
    let table = format!(
        "[linkage]\n\
         A = [{ax:?}, {ay:?}]\n\
         B = [{bx:?}, {by:?}]\n\
         a = {:?}\nb = {:?}\nc = {:?}\nd = {:?}\ne = {:?}\nt1 = {}\nt2 = {}\n",
        p.crank,
        p.coupler,
        p.follower,
        p.crank_side,
        p.follower_side,
        i64::from(p.assembly),
        i64::from(p.side),
    );
    let letters = "# A, B: fixed pivots of crank and follower. C, D: moving pins. P: coupler point.\n\
                   # a = |AC| crank, b = |CD| coupler, c = |BD| follower, d = |CP|, e = |DP|.\n\
                   # t1 = 1: D lies left of the line from C to B; t2 = 1: P lies left of the line from C to D.\n";
    text_of("A four-bar linkage", letters, name, unit, &table)
}

/// Returns the text of the linkage file of a linkage of any kind; every number reads back to the same digits.
pub fn any_to_toml(name: &str, unit: Option<Unit>, linkage: &CrankLinkage) -> String {
    match linkage {
        CrankLinkage::FourBar(linkage) => to_toml(name, unit, linkage),
        CrankLinkage::SliderCrank(linkage) => slider_crank_to_toml(name, unit, linkage),
        CrankLinkage::InvertedSliderCrank(linkage) => inverted_slider_crank_to_toml(name, unit, linkage),
        CrankLinkage::MultiLoop(linkage) => multi_loop::multi_loop_to_toml(name, unit, linkage),
    }
}

/// Returns the text of a linkage file: its kind, the comment on its letters, the keys at the top and its table.
fn text_of(kind: &str, letters: &str, name: &str, unit: Option<Unit>, table: &str) -> String {
    let name = toml::Value::String(name.to_owned());
    let unit = unit.map_or(String::new(), |u| format!("unit = \"{}\"\n", u.label()));
    let mark = crate::files::generator::mark();
    format!("# {kind}, {mark}.\n{letters}format = {FORMAT}\nname = {name}\n{unit}\n{table}")
}

/// An addition to a linkage that moves with its links: a body on the coupler, or the scales of a function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Carried {
    /// A body whose x axis lies so many degrees from the line from C to D.
    Body(f64),
    /// A function, with the angles of crank and follower from the line from A to B at an input and an output of 0, degrees,
    /// and the sense in which outputs count.
    Function([f64; 2], Sense),
    /// A function of a slider's places, with the crank's angle from the ground line, degrees, and the slider's place in the
    /// sense of the outputs at an input and an output of 0, and that sense.
    Places([f64; 2], Sense),
}

impl Carried {
    /// Returns the body or the function of a candidate; `None` in a path.
    pub fn of(candidate: &Candidate) -> Option<Carried> {
        let Candidate { frame_deg, input_offset_deg, output_offset_deg, sense, .. } = candidate;
        let function = || Some(Carried::Function([(*input_offset_deg)?, (*output_offset_deg)?], (*sense)?));
        let places =
            || Some(Carried::Places([(*input_offset_deg)?, candidate.output_offset?], candidate.sense?));
        frame_deg.map(Carried::Body).or_else(function).or_else(places)
    }
}

/// Returns the linkage file of a linkage as [`to_toml`] does, with a comment on the body or the function.
pub fn to_toml_with(
    name: &str,
    unit: Option<Unit>,
    linkage: &CrankLinkage,
    carried: Option<Carried>,
) -> String {
    let text = any_to_toml(name, unit, linkage);
    let comment = match carried {
        None => return text,
        Some(Carried::Body(frame_deg)) => format!(
            "# The body: P is its origin, and its x axis lies {frame_deg:?} degrees counter-clockwise from the line from C to D.\n"
        ),
        Some(Carried::Places([input, output], sense)) => {
            let (line, zero) = match linkage {
                CrankLinkage::InvertedSliderCrank(_) => ("line from A to B", "pin C, along the rod"),
                _ => ("slider's line", "foot of the perpendicular from A, along the line"),
            };
            let way = if sense == Sense::Opposite { " backwards" } else { "" };
            format!(
                "# The function: from the {line}, the crank stands at {input:?} degrees plus the input, and the\n\
                 # slider at {output:?} plus the output from the {zero}{way}.\n"
            )
        }
        Some(Carried::Function([input, output], sense)) => {
            let way = if sense == Sense::Opposite { "clockwise" } else { "counter-clockwise" };
            format!(
                "# The function: from the line from A to B, the crank stands at {input:?} degrees plus the input, and the\n\
                 # follower at {output:?} degrees, from which outputs count {way}.\n"
            )
        }
    };
    text.replacen("format = ", &format!("{comment}format = "), 1)
}
