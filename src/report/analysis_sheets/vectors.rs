//! Velocities and accelerations of C, D and P at an instant (De Castro, figures 3.2 and 4.1).

use super::{closed, degrees, scene};
use crate::mechanism::Unit;
use crate::mechanism::analysis::{Analysis, Configuration, Rates};
use crate::mechanism::{Complex, point};
use crate::report::canvas::{Anchor, Canvas, SHARP_CORNERS, Spot, Vec2, View, bold, font, haloed, palette};
use crate::report::figure::{Detail, draw};
use crate::report::labels::Beside;
use crate::report::practicality::degrees as direction;
use crate::report::scene::{Bounds, SAMPLES, Scene, round_length};
use crate::report::sheet::{INSET, Sheet, arrow};
use crate::report::text::brief;

/// The length of the longest arrow, as a fraction of the drawing's extent without arrows.
const LONGEST: f64 = 0.5;

/// A kind of vectors that are drawn as arrows.
pub(super) struct Kind {
    title: &'static str,
    /// The names of the vectors of C, D, P.
    names: [&'static str; 3],
    pub(super) vectors: fn(&Rates) -> [[f64; 2]; 3],
    /// The angular rates of coupler and follower.
    pub(super) turning: fn(&Rates) -> [f64; 2],
    pub(super) turning_names: [&'static str; 2],
    /// The unit of time by which the length is divided.
    pub(super) per: &'static str,
    colour: &'static str,
    /// The titles of the charts over the cycle: that of the links, and that of P.
    pub(super) charts: [&'static str; 2],
    /// The name of the length of P's vector.
    pub(super) of_p: &'static str,
}

pub(super) const VELOCITIES: Kind = Kind {
    title: "Velocities",
    names: ["vC", "vD", "vP"],
    vectors: |r| [r.vC, r.vD, r.vP],
    turning: |r| [r.omega3_rad_s, r.omega4_rad_s],
    turning_names: ["ω3", "ω4"],
    per: "s",
    colour: palette::FOLLOWER,
    charts: ["Angular velocities", "Speed of P"],
    of_p: "|vP|",
};

pub(super) const ACCELERATIONS: Kind = Kind {
    title: "Accelerations",
    names: ["aC", "aD", "aP"],
    vectors: |r| [r.aC, r.aD, r.aP],
    turning: |r| [r.alpha3_rad_s2, r.alpha4_rad_s2],
    turning_names: ["α3", "α4"],
    per: "s²",
    colour: palette::TARGET,
    charts: ["Angular accelerations", "Acceleration of P"],
    of_p: "|aP|",
};

/// Draws the arrows of a kind; `None` if there are none.
pub(super) fn sheet(
    analysis: &Analysis,
    configuration: &Configuration,
    width: f64,
    kind: &Kind,
) -> Option<Sheet> {
    if analysis.omega2_rad_s == 0.0 && analysis.alpha2_rad_s2 == 0.0 {
        return None;
    }
    let all = closed(configuration);
    let (at, rates) = all.iter().find_map(|at| Some((*at, at.0.rates?)))?;
    let (row, joints) = at;
    let vectors = (kind.vectors)(&rates).map(point);
    let greatest = vectors.iter().map(|v| v.norm()).fold(0.0, f64::max);
    if !(greatest > 0.0 && greatest.is_finite()) {
        return None;
    }
    let mut scene = scene(&configuration.linkage, &[at], SAMPLES);
    // Only the part of the path beside the linkage is shown.
    let path = Scene { circuits: std::mem::take(&mut scene.circuits), ..Scene::default() };
    let mut bounds = Bounds::of(joints);
    // The length of an arrow per unit of velocity.
    let stretch = LONGEST * bounds.extent() / greatest;
    let arrows: Vec<(Complex, Complex)> =
        joints[2..].iter().zip(vectors).map(|(p, v)| (*p, p + v * stretch)).collect();
    arrows.iter().for_each(|(_, tip)| bounds.hold(*tip));

    let (mut sheet, view) = Sheet::fitted(kind.title, &bounds, width);
    let body = &mut sheet.body;
    let ends: Vec<(Spot, Spot)> =
        arrows.iter().map(|(from, to)| (view.spot(*from), view.spot(*to))).collect();
    ends.iter().for_each(|(from, to)| body.labels.mark_line(*from, *to));
    let detail = Detail::lettered(0.8);
    let clip = Some(bounds.padded(0.04));
    draw(body, &path, &view, Detail { clip, weight: 0.5, ..detail });
    draw(body, &scene, &view, detail);
    for ((from, to), name) in ends.into_iter().zip(kind.names) {
        arrow(body, from, to, kind.colour);
        let tip = haloed(&bold(13, kind.colour), "2.5", SHARP_CORNERS);
        body.label(name, 13.0, &tip, Beside { point: to, distance: 5.0, towards: to - from, needed: true });
    }
    let unit = per_time(analysis.unit, kind.per);
    let corner = Spot::new(width - INSET, sheet.bottom - 12.0);
    sheet.scale_bar(&view, analysis.unit, width);
    scale_arrow(&mut sheet.body, &view, stretch, &unit, kind.colour, corner);

    let listed: Vec<String> = kind
        .names
        .iter()
        .zip(vectors)
        .map(|(name, v)| {
            let towards = if v.norm() > 0.0 { format!(" at {}", direction(v.arg())) } else { String::new() };
            format!("{name} {}{towards}", brief(v.norm(), 5))
        })
        .collect();
    let [of_coupler, of_follower] = (kind.turning)(&rates).map(|x| brief(x, 5));
    let [coupler, follower] = kind.turning_names;
    sheet.note = format!("crank at {}, {}", degrees(row.crank_deg), super::input(analysis));
    sheet.foot = vec![
        format!("{} ({unit})", listed.join(", ")),
        format!("{coupler} = {of_coupler}, {follower} = {of_follower} (rad/{})", kind.per),
    ];
    Some(sheet)
}

/// Returns a unit such as `mm/s`; `length/s` without a unit of length.
pub(super) fn per_time(unit: Option<Unit>, per: &str) -> String {
    format!("{}/{per}", unit.map_or("length", |unit| unit.label()))
}

/// Draws an arrow of a round value with its label above, its right end at `right`.
fn scale_arrow(canvas: &mut Canvas, view: &View, stretch: f64, unit: &str, colour: &str, right: Spot) {
    let value = round_length(120.0 / (stretch * view.scale));
    let length = value * stretch * view.scale;
    if !(1.0..=200.0).contains(&length) {
        return;
    }
    arrow(canvas, right - Vec2::new(length, 0.0), right, colour);
    let text = format!("{} {unit}", brief(value, 3));
    canvas.text(right - Vec2::new(0.0, 9.0), Anchor::End, &font(12, palette::INK), &text);
}
