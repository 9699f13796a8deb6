//! The `[slider_crank]` and `[inverted_slider_crank]` forms of linkage files.

use super::text_of;
use crate::files::toml_values::{Number, XY};
use crate::mechanism::{
    AssemblyMode, InvertedSliderCrank, InvertedSliderCrankParameters, LinkageError, SliderCrank,
    SliderCrankParameters, Unit,
};
use schemars::JsonSchema;
use serde::Deserialize;

/// Crank A-C, coupler C-D, whose pin D slides along a fixed line.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "SliderCrank")]
pub(super) struct RawSliderCrank {
    /// The fixed pivot of the crank.
    #[serde(rename = "A")]
    crank_pivot: XY,
    /// |AC|, the crank.
    a: Number,
    /// |CD|, the coupler.
    b: Number,
    /// A point of the line, from which the slider's place counts.
    line_point: XY,
    /// The direction of the line from the x axis, degrees.
    line_deg: Number,
    /// P along the line from C to D, from C.
    coupler_x: Number,
    /// P to the left of the line from C to D.
    coupler_y: Number,
    /// Of the two places of D on its line, 1: the one further along it; -1: the other.
    #[schemars(with = "i64")]
    t1: AssemblyMode,
}

/// Crank A-C, and a coupler from C that slides through a block at the fixed pivot B.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "InvertedSliderCrank")]
pub(super) struct RawInvertedSliderCrank {
    /// The fixed pivot of the crank.
    #[serde(rename = "A")]
    crank_pivot: XY,
    /// The fixed pivot of the block.
    #[serde(rename = "B")]
    block_pivot: XY,
    /// |AC|, the crank.
    a: Number,
    /// B lies this far to the left of the coupler's line through C.
    offset: Number,
    /// P along the coupler's line, from C.
    coupler_x: Number,
    /// P to the left of the coupler's line.
    coupler_y: Number,
    /// 1: the block is ahead of C along the coupler; -1: behind it.
    #[schemars(with = "i64")]
    t1: AssemblyMode,
}

pub(super) fn slider_crank(raw: RawSliderCrank) -> Result<SliderCrank, LinkageError> {
    SliderCrank::new(SliderCrankParameters {
        crank_pivot: raw.crank_pivot.0,
        crank: raw.a.0,
        coupler: raw.b.0,
        line_point: raw.line_point.0,
        line_deg: raw.line_deg.0,
        coupler_x: raw.coupler_x.0,
        coupler_y: raw.coupler_y.0,
        assembly: raw.t1,
    })
}

pub(super) fn inverted_slider_crank(
    raw: RawInvertedSliderCrank,
) -> Result<InvertedSliderCrank, LinkageError> {
    InvertedSliderCrank::new(InvertedSliderCrankParameters {
        crank_pivot: raw.crank_pivot.0,
        block_pivot: raw.block_pivot.0,
        crank: raw.a.0,
        offset: raw.offset.0,
        coupler_x: raw.coupler_x.0,
        coupler_y: raw.coupler_y.0,
        assembly: raw.t1,
    })
}

/// Returns the text of the linkage file of a slider-crank; every number reads back to the same digits.
pub fn slider_crank_to_toml(name: &str, unit: Option<Unit>, linkage: &SliderCrank) -> String {
    let p = linkage.parameters();
    let ([ax, ay], [qx, qy]) = (p.crank_pivot, p.line_point);
    let table = format!(
        "[slider_crank]\n\
         A = [{ax:?}, {ay:?}]\n\
         a = {:?}\nb = {:?}\n\
         line_point = [{qx:?}, {qy:?}]\n\
         line_deg = {:?}\ncoupler_x = {:?}\ncoupler_y = {:?}\nt1 = {}\n",
        p.crank,
        p.coupler,
        p.line_deg,
        p.coupler_x,
        p.coupler_y,
        i64::from(p.assembly),
    );
    let letters = "# A: fixed pivot of the crank. C: moving pin. D: pin of the slider, on its line. P: coupler point.\n\
                   # a = |AC| crank, b = |CD| coupler; P lies coupler_x along and coupler_y to the left of C -> D, from C.\n\
                   # t1 = 1: of the two places of D on its line, the one further along it.\n";
    text_of("A slider-crank", letters, name, unit, &table)
}

/// Returns the text of the linkage file of an inverted slider-crank; every number reads back to the same digits.
pub fn inverted_slider_crank_to_toml(
    name: &str,
    unit: Option<Unit>,
    linkage: &InvertedSliderCrank,
) -> String {
    let p = linkage.parameters();
    let ([ax, ay], [bx, by]) = (p.crank_pivot, p.block_pivot);
    let table = format!(
        "[inverted_slider_crank]\n\
         A = [{ax:?}, {ay:?}]\n\
         B = [{bx:?}, {by:?}]\n\
         a = {:?}\noffset = {:?}\ncoupler_x = {:?}\ncoupler_y = {:?}\nt1 = {}\n",
        p.crank,
        p.offset,
        p.coupler_x,
        p.coupler_y,
        i64::from(p.assembly),
    );
    let letters = "# A: fixed pivot of the crank. B: fixed pivot of the block through which the coupler slides. C: moving pin.\n\
                   # a = |AC| crank; B lies offset to the left of the coupler's line through C, and P, the coupler point,\n\
                   # coupler_x along and coupler_y to the left of that line, from C. t1 = 1: the block is ahead of C.\n";
    text_of("An inverted slider-crank", letters, name, unit, &table)
}
