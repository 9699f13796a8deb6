//! The mechanism at several positions and the path of P over its circuit (De Castro, figure 2.2).

use super::{as_joints, closed, degrees, pivots, positions_of};
use crate::mechanism::Complex;
use crate::mechanism::analysis::{Analysis, Configuration, Row};
use crate::report::canvas::{Anchor, Canvas, Corners, Spot, View, font, haloed, palette};
use crate::report::figure::{Detail, draw_among};
use crate::report::labels::Labels;
use crate::report::parts::{away, mark_joints, point_mark, triangle};
use crate::report::scene::{Pose, SAMPLES, Scene, circuits_through, middle_position};
use crate::report::sheet::{Sheet, fitted, scale_bar};

/// The largest number of positions that are drawn.
const MOST: usize = 8;

pub(super) fn sheet(analysis: &Analysis, configuration: &Configuration, width: f64) -> Option<Sheet> {
    let linkage = &configuration.linkage;
    let all = closed(configuration);
    let mut circuits = circuits_through(linkage, positions_of(configuration, &all), SAMPLES);
    if circuits.is_empty() {
        circuits = circuits_through(linkage, [middle_position(linkage)], SAMPLES);
    }
    let shown = thinned(&all);
    let pose = shown.first().map(|(_, joints)| Pose { target: None, joints: as_joints(*joints) });
    let scene = Scene { linkage: Some(*linkage), targets: Vec::new(), circuits, pose };
    let mut bounds = scene.bounds();
    all.iter().flat_map(|(_, joints)| joints).for_each(|p| bounds.hold(*p));
    if all.is_empty() {
        let arm = Complex::new(linkage.crank(), linkage.crank());
        bounds.hold(linkage.crank_pivot() + arm);
        bounds.hold(linkage.crank_pivot() - arm);
    }

    let (view, bottom) = fitted(&bounds, width);
    let mut body = Canvas::default();
    let mut labels = Labels::default();
    for (_, joints) in shown.iter().skip(1) {
        ghost(&mut body, &mut labels, joints.map(|p| view.spot(p)));
    }
    draw_among(&mut body, &mut labels, &scene, &view, Detail::lettered(0.85));
    if scene.pose.is_none() {
        pivots(&mut body, &mut labels, &view, linkage, 0.85);
    }
    angles(&mut body, &mut labels, &view, &shown);
    scale_bar(&mut body, &view, analysis.unit, width, bottom);
    let note = match (shown.as_slice(), configuration.rows.as_slice()) {
        ([], []) => "the path of P; no crank angle was asked".to_owned(),
        ([], _) if scene.circuits.is_empty() => "the loop closes at no crank angle".to_owned(),
        ([], _) => "the path of P; no position at the crank angles asked".to_owned(),
        ([(row, _)], _) => format!("crank at {}, and the path of P over its circuit", degrees(row.crank_deg)),
        ([(row, _), ..], _) => {
            let of = if shown.len() < all.len() { format!(" of {}", all.len()) } else { String::new() };
            let first = degrees(row.crank_deg);
            format!("{}{of} positions, {first} in full, and the path of P over its circuit", shown.len())
        }
    };
    Some(Sheet { title: "Positions".to_owned(), note, body, foot: Vec::new(), width, bottom })
}

/// Returns all positions if they are few, otherwise [`MOST`] evenly chosen, including the first.
fn thinned<'a>(all: &[(&'a Row, [Complex; 5])]) -> Vec<(&'a Row, [Complex; 5])> {
    let n = all.len();
    if n <= MOST { all.to_vec() } else { (0..MOST).map(|i| all[i * n / MOST]).collect() }
}

fn ghost(canvas: &mut Canvas, labels: &mut Labels, joints: [Spot; 5]) {
    let [a, b, c, d, p] = joints;
    canvas.raw(r#"<g opacity="0.5">"#);
    triangle(canvas, [c, d, p], palette::COUPLER, palette::MUTED, 0.55);
    let bar = format!(r#"stroke="{}" stroke-width="2" stroke-linecap="round""#, palette::MUTED);
    for (from, to) in [(a, c), (c, d), (b, d)] {
        canvas.line(from, to, &bar);
    }
    let pin = format!(r#"fill="{}" stroke="{}" stroke-width="1.2""#, palette::PAPER, palette::MUTED);
    for pin_at in [c, d] {
        canvas.circle(pin_at, 2.6, &pin);
    }
    canvas.raw("</g>");
    mark_joints(labels, joints);
}

/// Draws the crank angle at each P.
fn angles(canvas: &mut Canvas, labels: &mut Labels, view: &View, shown: &[(&Row, [Complex; 5])]) {
    let attributes = haloed(&font(11, palette::CURVE), "2.5", Corners::Round);
    for (_, joints) in shown {
        point_mark(canvas, view.spot(joints[4]), 0.85);
    }
    for (row, joints) in shown {
        let [_, _, c, d, p] = joints.map(|p| view.spot(p));
        let text = degrees(row.crank_deg);
        if let Some(at) = labels.place(&text, 11.0, p, 6.0, away(p, &[c, d]), false) {
            canvas.text(at, Anchor::Middle, &attributes, &text);
        }
    }
}
