//! Velocities and accelerations of C, D and P at an instant (De Castro, figures 3.2 and 4.1).

use super::{as_joints, closed, degrees};
use crate::mechanism::Unit;
use crate::mechanism::analysis::{Analysis, Configuration, Rates};
use crate::mechanism::{Complex, point};
use crate::report::canvas::{Anchor, Canvas, Corners, Spot, View, bold, font, haloed, palette};
use crate::report::figure::{Detail, draw_among};
use crate::report::labels::Labels;
use crate::report::scene::{Bounds, Pose, SAMPLES, Scene, circuits_through, round_length};
use crate::report::sheet::{INSET, Sheet, arrow, fitted, scale_bar};
use crate::report::text::brief;

/// The length of the longest arrow, as a fraction of the drawing's extent without arrows.
const LONGEST: f64 = 0.5;

/// The kind of vectors that are drawn as arrows.
struct Kind {
    title: &'static str,
    /// The names of the vectors of C, D, P.
    names: [&'static str; 3],
    vectors: fn(&Rates) -> [[f64; 2]; 3],
    /// The angular rates of coupler and follower.
    turning: fn(&Rates) -> [f64; 2],
    turning_names: [&'static str; 2],
    /// The unit of time by which the length is divided.
    per: &'static str,
    colour: &'static str,
}

/// Draws the arrows of the velocities; `None` if nothing moves.
pub(super) fn velocities(analysis: &Analysis, configuration: &Configuration, width: f64) -> Option<Sheet> {
    let kind = Kind {
        title: "Velocities",
        names: ["vC", "vD", "vP"],
        vectors: |r| [r.vC, r.vD, r.vP],
        turning: |r| [r.omega3_rad_s, r.omega4_rad_s],
        turning_names: ["ω3", "ω4"],
        per: "s",
        colour: palette::FOLLOWER,
    };
    sheet(analysis, configuration, width, &kind)
}

/// Draws the arrows of the accelerations; `None` if there are none.
pub(super) fn accelerations(analysis: &Analysis, configuration: &Configuration, width: f64) -> Option<Sheet> {
    let kind = Kind {
        title: "Accelerations",
        names: ["aC", "aD", "aP"],
        vectors: |r| [r.aC, r.aD, r.aP],
        turning: |r| [r.alpha3_rad_s2, r.alpha4_rad_s2],
        turning_names: ["α3", "α4"],
        per: "s²",
        colour: palette::TARGET,
    };
    sheet(analysis, configuration, width, &kind)
}

fn sheet(analysis: &Analysis, configuration: &Configuration, width: f64, kind: &Kind) -> Option<Sheet> {
    if analysis.omega2_rad_s == 0.0 && analysis.alpha2_rad_s2 == 0.0 {
        return None;
    }
    let linkage = &configuration.linkage;
    let all = closed(configuration);
    let (row, joints, rates) = all.iter().find_map(|(row, joints)| Some((*row, *joints, row.rates?)))?;
    let vectors = (kind.vectors)(&rates).map(point);
    let greatest = vectors.iter().map(|v| v.norm()).fold(0.0, f64::max);
    if !(greatest > 0.0 && greatest.is_finite()) {
        return None;
    }
    let circuits = circuits_through(linkage, [(row.crank_deg.to_radians(), linkage.assembly())], SAMPLES);
    let pose = Some(Pose { target: None, joints: as_joints(joints) });
    let scene = Scene { linkage: Some(*linkage), pose, ..Scene::default() };
    // Only the part of the path beside the linkage is shown.
    let path = Scene { circuits, ..Scene::default() };
    let mut bounds = Bounds::default();
    joints.iter().for_each(|p| bounds.hold(*p));
    // The length of an arrow per unit of velocity.
    let stretch = LONGEST * bounds.extent() / greatest;
    let arrows: Vec<(Complex, Complex)> =
        joints[2..].iter().zip(vectors).map(|(p, v)| (*p, p + v * stretch)).collect();
    arrows.iter().for_each(|(_, tip)| bounds.hold(*tip));

    let (view, bottom) = fitted(&bounds, width);
    let mut body = Canvas::default();
    let mut labels = Labels::default();
    let ends: Vec<(Spot, Spot)> =
        arrows.iter().map(|(from, to)| (view.spot(*from), view.spot(*to))).collect();
    ends.iter().for_each(|(from, to)| labels.mark_line(*from, *to));
    let detail = Detail::lettered(0.8);
    let clip = Some(bounds.padded(0.04));
    draw_among(&mut body, &mut labels, &path, &view, Detail { clip, weight: 0.5, ..detail });
    draw_among(&mut body, &mut labels, &scene, &view, detail);
    for ((from, to), name) in ends.iter().zip(kind.names) {
        arrow(&mut body, *from, *to, kind.colour);
        tip_name(&mut body, &mut labels, name, *from, *to, kind.colour);
    }
    scale_bar(&mut body, &view, analysis.unit, width, bottom);
    let suffix = per_time(analysis.unit, kind.per);
    scale_arrow(&mut body, &view, stretch, &suffix, kind.colour, Spot::new(width - INSET, bottom - 12.0));

    let listed: Vec<String> = kind
        .names
        .iter()
        .zip(vectors)
        .map(|(name, v)| {
            let towards = if v.norm() > 0.0 { format!(" at {}°", direction(v)) } else { String::new() };
            format!("{name} {}{towards}", brief(v.norm(), 5))
        })
        .collect();
    let [of_coupler, of_follower] = (kind.turning)(&rates).map(|x| brief(x, 5));
    let [coupler, follower] = kind.turning_names;
    Some(Sheet {
        title: kind.title.to_owned(),
        note: format!("crank at {}, {}", degrees(row.crank_deg), super::input(analysis)),
        body,
        foot: vec![
            format!("{} ({})", listed.join(", "), suffix.trim_start()),
            format!("{coupler} = {of_coupler}, {follower} = {of_follower} (rad/{})", kind.per),
        ],
        width,
        bottom,
    })
}

/// Returns the direction of a vector in degrees, to a tenth, in [0, 360).
fn direction(v: Complex) -> String {
    let tenths = (v.arg().to_degrees().rem_euclid(360.0) * 10.0).round();
    brief(if tenths >= 3600.0 { 0.0 } else { tenths / 10.0 }, 5)
}

/// Returns a unit such as ` mm/s`; ` length/s` without a unit of length.
pub(super) fn per_time(unit: Option<Unit>, per: &str) -> String {
    format!(" {}/{per}", unit.map_or("length", |unit| unit.label()))
}

fn tip_name(canvas: &mut Canvas, labels: &mut Labels, name: &str, from: Spot, to: Spot, colour: &str) {
    let towards = Spot::new(to.x - from.x, to.y - from.y);
    if let Some(at) = labels.place(name, 13.0, to, 5.0, towards, true) {
        canvas.text(at, Anchor::Middle, &haloed(&bold(13, colour), "2.5", Corners::Sharp), name);
    }
}

/// Draws an arrow of a round value with its label above, its right end at `right`.
fn scale_arrow(canvas: &mut Canvas, view: &View, stretch: f64, suffix: &str, colour: &str, right: Spot) {
    let value = round_length(120.0 / (stretch * view.scale));
    let length = value * stretch * view.scale;
    if !(1.0..=200.0).contains(&length) {
        return;
    }
    let from = Spot::new(right.x - length, right.y);
    arrow(canvas, from, right, colour);
    let text = format!("{}{suffix}", brief(value, 3));
    let attributes = font(12, palette::INK);
    canvas.text(Spot::new(right.x, right.y - 9.0), Anchor::End, &attributes, &text);
}
