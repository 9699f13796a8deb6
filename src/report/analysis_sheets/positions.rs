//! The mechanism at several positions and the path of P over its circuit (De Castro, figure 2.2).

use super::{closed, degrees, pivots, scene};
use crate::mechanism::Complex;
use crate::mechanism::analysis::{Analysis, Configuration, Row};
use crate::report::canvas::{
    Canvas, ROUND_CORNERS, ROUND_ENDS, Spot, View, filled, font, haloed, palette, stroke,
};
use crate::report::figure::{Detail, draw};
use crate::report::labels::Beside;
use crate::report::parts::{away, mark_joints, point_mark, triangle};
use crate::report::scene::SAMPLES;
use crate::report::sheet::Sheet;

/// The largest number of positions that are drawn.
const MOST: usize = 8;

pub(super) fn sheet(analysis: &Analysis, configuration: &Configuration, width: f64) -> Option<Sheet> {
    let linkage = &configuration.linkage;
    let all = closed(configuration);
    let scene = scene(linkage, &all, SAMPLES);
    let shown = thinned(&all);
    let mut bounds = scene.bounds();
    all.iter().flat_map(|(_, joints)| joints).for_each(|p| bounds.hold(*p));
    if all.is_empty() {
        let arm = Complex::new(linkage.crank(), linkage.crank());
        bounds.hold(linkage.crank_pivot() + arm);
        bounds.hold(linkage.crank_pivot() - arm);
    }

    let (mut sheet, view) = Sheet::fitted("Positions", &bounds, width);
    for (_, joints) in shown.iter().skip(1) {
        ghost(&mut sheet.body, joints.map(|p| view.spot(p)));
    }
    draw(&mut sheet.body, &scene, &view, Detail::lettered(0.85));
    if scene.pose.is_none() {
        pivots(&mut sheet.body, &view, linkage, 0.85);
    }
    angles(&mut sheet.body, &view, &shown);
    sheet.scale_bar(&view, analysis.unit, width);
    sheet.note = match (shown.as_slice(), configuration.rows.as_slice()) {
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
    Some(sheet)
}

/// Returns all positions if they are few, otherwise [`MOST`] evenly chosen, including the first.
fn thinned<'a>(all: &[(&'a Row, [Complex; 5])]) -> Vec<(&'a Row, [Complex; 5])> {
    let n = all.len();
    if n <= MOST { all.to_vec() } else { (0..MOST).map(|i| all[i * n / MOST]).collect() }
}

fn ghost(canvas: &mut Canvas, joints: [Spot; 5]) {
    let [a, b, c, d, p] = joints;
    canvas.raw(r#"<g opacity="0.5">"#);
    triangle(canvas, [c, d, p], palette::COUPLER, palette::MUTED, 0.55);
    let bar = stroke(palette::MUTED, 2) + ROUND_ENDS;
    for (from, to) in [(a, c), (c, d), (b, d)] {
        canvas.line(from, to, &bar);
    }
    let pin = filled(palette::PAPER, palette::MUTED, 1.2);
    for pin_at in [c, d] {
        canvas.circle(pin_at, 2.6, &pin);
    }
    canvas.raw("</g>");
    mark_joints(&mut canvas.labels, joints);
}

/// Draws the crank angle at each P.
fn angles(canvas: &mut Canvas, view: &View, shown: &[(&Row, [Complex; 5])]) {
    let attributes = haloed(&font(11, palette::CURVE), "2.5", ROUND_CORNERS);
    for (_, joints) in shown {
        point_mark(canvas, view.spot(joints[4]), 0.85);
    }
    for (row, joints) in shown {
        let [_, _, c, d, p] = joints.map(|p| view.spot(p));
        let beside = Beside { point: p, distance: 6.0, towards: away(p, &[c, d]), needed: false };
        canvas.label(&degrees(row.crank_deg), 11.0, &attributes, beside);
    }
}
