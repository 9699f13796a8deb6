//! Shop data: the table `[shop]` of a linkage file, and files of shop data alone, read by the same code.
//!
//! A shop file has `format`, `unit` and `[shop]`, and is about the linkage that it is read for, against which its names of joints
//! and bodies are checked.

use super::diagnostic::{Checked, Diagnostic};
use super::input_text;
use super::linkage_file::{FORMAT, check_format, checked_name};
use super::toml_text::{TomlText, nearest};
use super::toml_values::{Count, Number, OnlyTable};
use crate::mechanism::plates::Shop;
use crate::mechanism::plates::shop::{BodySizes, JointSizes, Key, Names, ShopFault};
use crate::mechanism::{CrankLinkage, Unit};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Sizes of holes, pins, plates and rims, in the file's unit; `scale` does not change them.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Shop")]
pub(crate) struct RawShop {
    /// The diameter of every hole without one of its own, and the width of a slot; as hole_mm of export.
    hole: Option<Number>,
    /// The distance from a hole's edge to the edge of a plate without a width; as margin_mm of export.
    margin: Option<Number>,
    /// The thickness of every plate without one of its own; as thickness_mm of export.
    thickness: Option<Number>,
    /// The least rim around every hole, of which build warns: to the edge, to the slot and to other holes; 0.7 of a hole's diameter
    /// where this is missing.
    rim: Option<Number>,
    /// The sizes of a joint, by its name: A, B, C, D, P, of a slider's block E and F, of six-bars and eight-bars also X2, Y2, F2, X3, Y3, F3.
    #[schemars(with = "Option<BTreeMap<String, RawJoint>>")]
    joint: Option<OnlyTable<BTreeMap<String, OnlyTable<RawJoint>>>>,
    /// The sizes of a body's plate, by its name: ground, crank, coupler, follower, block, link5 and so on.
    #[schemars(with = "Option<BTreeMap<String, RawBody>>")]
    body: Option<OnlyTable<BTreeMap<String, OnlyTable<RawBody>>>>,
}

/// The sizes of a joint.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ShopJoint")]
struct RawJoint {
    /// The diameter of its hole in every plate.
    hole: Option<Number>,
    /// The diameter of its hole in single plates, by the bodies' names: { ground = 22, crank = 8 }.
    #[schemars(with = "Option<BTreeMap<String, Number>>")]
    hole_in: Option<OnlyTable<BTreeMap<String, Number>>>,
    /// The diameter of its pin; that of its smaller hole where this is missing.
    pin: Option<Number>,
    /// The least rim around its holes.
    rim: Option<Number>,
}

/// The sizes of a body's plate.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "ShopBody")]
struct RawBody {
    /// Its thickness.
    thickness: Option<Number>,
    /// Its width across the line of two joints, and its rounding about each; the largest hole with the margin on both sides where this
    /// is missing.
    width: Option<Number>,
}

/// A file of shop data.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RawShopFile {
    format: Option<Count>,
    name: Option<String>,
    unit: Option<Unit>,
    shop: Option<OnlyTable<RawShop>>,
}

/// Reads a file of shop data for a linkage.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault: a key, a number, or a name that the linkage does not have; a hole wider than its plate.
pub fn load(path: &Path, linkage: &CrankLinkage) -> Checked<Shop> {
    let text = input_text::read(path)?;
    parse(&path.display().to_string(), &text, Some(linkage))
}

/// Reads a file of shop data without a linkage, so that its names of joints and bodies are not checked.
///
/// # Errors
/// A [`Diagnostic`] that points at the fault.
pub fn check_alone(path: &Path) -> Checked<[usize; 2]> {
    let text = input_text::read(path)?;
    let file = path.display().to_string();
    let toml = TomlText { file: &file, text: input_text::without_mark(&text) };
    let (raw, _) = table(&toml)?;
    check_lengths(&toml, &raw)?;
    Ok(counts(&raw))
}

/// Reads the text of a file of shop data; `file_name` is shown in diagnostics.
///
/// # Errors
/// As [`load`].
pub fn parse(file_name: &str, text: &str, linkage: Option<&CrankLinkage>) -> Checked<Shop> {
    let toml = TomlText { file: file_name, text: input_text::without_mark(text) };
    let (raw, unit) = table(&toml)?;
    of_linkage_file(&toml, raw, unit, linkage)
}

/// Reads the table and the unit of a file of shop data.
fn table(toml: &TomlText<'_>) -> Checked<(RawShop, Option<Unit>)> {
    let raw: RawShopFile = toml.read()?;
    check_format(toml, raw.format, FORMAT)?;
    checked_name(toml, raw.name, "shop")?;
    match raw.shop {
        Some(OnlyTable(shop)) => Ok((shop, raw.unit)),
        None => toml.refuse_file("there is no shop data in this file", "a shop file has a table [shop]"),
    }
}

/// Returns the numbers of joints and of bodies with sizes.
fn counts(raw: &RawShop) -> [usize; 2] {
    let joints = raw.joint.as_ref().map_or(0, |OnlyTable(joints)| joints.len());
    [joints, raw.body.as_ref().map_or(0, |OnlyTable(bodies)| bodies.len())]
}

/// Reads the shop data of a linkage; of one that is not made of plates here there are none.
pub(crate) fn of_linkage_file(
    toml: &TomlText<'_>,
    raw: RawShop,
    unit: Option<Unit>,
    linkage: Option<&CrankLinkage>,
) -> Checked<Shop> {
    check_lengths(toml, &raw)?;
    let Some(linkage) = linkage else {
        let help =
            "remove the table: it goes with four-bars, linkages with one slider, six-bars and eight-bars";
        return toml.refuse_key(
            "shop",
            "no plates are made of this chain, so that it has no shop data",
            help,
        );
    };
    let names = Names::of(linkage);
    let at = |key: &[&str], fault: ShopFault| explain(toml, owned(key), &fault);
    let of = |length: Option<Number>| length.map(|length| length.0);
    let mut shop = Shop {
        unit,
        hole: of(raw.hole),
        margin: of(raw.margin),
        thickness: of(raw.thickness),
        rim: of(raw.rim),
        ..Shop::default()
    };
    for (name, OnlyTable(raw)) in raw.joint.map_or_else(BTreeMap::new, |joints| joints.0) {
        let joint = names.joint(&name).map_err(|fault| at(&["joint", &name], fault))?;
        let mut hole_in = Vec::new();
        for (body, hole) in raw.hole_in.map_or_else(BTreeMap::new, |holes| holes.0) {
            let found = names.drilled(joint, &body);
            hole_in.push((found.map_err(|fault| at(&["joint", &name, "hole_in", &body], fault))?, hole.0));
        }
        let sizes = JointSizes { hole: of(raw.hole), hole_in, pin: of(raw.pin), rim: of(raw.rim) };
        shop.joints.push((joint, sizes));
    }
    for (name, OnlyTable(raw)) in raw.body.map_or_else(BTreeMap::new, |bodies| bodies.0) {
        let link = names.body(&name).map_err(|fault| at(&["body", &name], fault))?;
        shop.bodies.push((link, BodySizes { thickness: of(raw.thickness), width: of(raw.width) }));
    }
    let bores = shop.bores(&names, shop.hole.unwrap_or(f64::NAN));
    shop.check(&names, &bores).map_err(|(key, fault)| explain(toml, key, &fault))?;
    Ok(shop)
}

fn owned(key: &[&str]) -> Key {
    key.iter().map(|part| (*part).to_owned()).collect()
}

/// Checks that every length is above 0.
fn check_lengths(toml: &TomlText<'_>, raw: &RawShop) -> Checked<()> {
    let positive = |key: &[&str], length: Option<Number>| match length {
        Some(Number(length)) if length <= 0.0 => {
            let parts: Key = std::iter::once("shop").chain(key.iter().copied()).map(str::to_owned).collect();
            let name = key.last().copied().unwrap_or_default();
            let message = format!("{name} = {length}: a size must be positive");
            Err(Box::new(
                toml.at_path(&parts, message).with_help("write a length above 0, or remove the key"),
            ))
        }
        _ => Ok(()),
    };
    positive(&["hole"], raw.hole)?;
    positive(&["margin"], raw.margin)?;
    positive(&["thickness"], raw.thickness)?;
    positive(&["rim"], raw.rim)?;
    for (name, OnlyTable(joint)) in raw.joint.iter().flat_map(|joints| &joints.0) {
        for (key, length) in [("hole", joint.hole), ("pin", joint.pin), ("rim", joint.rim)] {
            positive(&["joint", name, key], length)?;
        }
        for (body, hole) in joint.hole_in.iter().flat_map(|holes| &holes.0) {
            positive(&["joint", name, "hole_in", body], Some(*hole))?;
        }
    }
    for (name, OnlyTable(body)) in raw.body.iter().flat_map(|bodies| &bodies.0) {
        for (key, length) in [("thickness", body.thickness), ("width", body.width)] {
            positive(&["body", name, key], length)?;
        }
    }
    Ok(())
}

/// Returns the diagnostic of a size that does not fit, at the key that it is about.
fn explain(toml: &TomlText<'_>, key: Key, fault: &ShopFault) -> Box<Diagnostic> {
    let parts: Key = std::iter::once("shop".to_owned()).chain(key).collect();
    let is_name = matches!(
        fault,
        ShopFault::UnknownJoint { .. } | ShopFault::UnknownBody { .. } | ShopFault::NoHole { .. }
    );
    let message = fault.to_string();
    let diagnostic = if is_name { toml.at_key_path(&parts, message) } else { toml.at_path(&parts, message) };
    Box::new(diagnostic.with_help(hint(fault) + &fault.remedy()))
}

/// Returns the name that an unknown one is nearest to, as a question.
fn hint(fault: &ShopFault) -> String {
    let (ShopFault::UnknownBody { name, known } | ShopFault::UnknownJoint { name, known }) = fault else {
        return String::new();
    };
    nearest(name, known).map_or_else(String::new, |name| format!("did you mean \"{name}\"? "))
}
