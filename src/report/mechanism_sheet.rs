//! A drawing of a linkage of any kind at one position, with other positions drawn faintly and the path of its traced point.

use super::canvas::{Canvas, ROUND_ENDS, Spot, filled, outline, palette, stroke};
use super::guide::{Drawn, Guide};
use super::loads;
use super::mechanism_text::{dimensions, in_words};
use super::parts::{away, letter, plate, point_mark, stand};
use super::scene::Bounds;
use super::sheet::{FULL, Sheet, page};
use super::text::{plural, significant};
use crate::mechanism::analysis::Status;
use crate::mechanism::analysis::driven::{CYCLE_SAMPLES, MechanismAnalysis};
use crate::mechanism::{Complex, Link, Linkage, Mechanism, MechanismPose};

/// The largest number of positions that are drawn faintly besides the first.
const GHOSTS: usize = 5;

/// Returns the page of an analysis: one self-contained SVG.
pub fn mechanism_svg(analysis: &MechanismAnalysis, linkage: &Linkage) -> String {
    let mechanism = linkage.mechanism();
    let path: Vec<Option<Complex>> = mechanism.path(CYCLE_SAMPLES);
    let closed: Vec<f64> =
        analysis.rows.iter().filter(|r| r.status != Status::Open).map(|r| r.crank_deg).collect();
    let poses: Vec<Drawn> = closed.iter().filter_map(|deg| pose(mechanism, *deg)).collect();
    let start = mechanism.pose_at(f64::NAN).joints;
    let guide = Guide::of(mechanism);
    let rails = poses.iter().filter_map(|pose| guide.as_ref().map(|guide| guide.ends(pose)));
    let rails: Vec<[Complex; 2]> = rails.collect();
    let drawn = poses
        .iter()
        .flat_map(|pose| &pose.joints)
        .chain(start.iter().flatten())
        .chain(rails.iter().flatten());
    let (mut sheet, view) =
        Sheet::fitted("Positions", &Bounds::of(path.iter().flatten().chain(drawn).copied()), FULL);
    let body = &mut sheet.body;
    let step = poses.len().div_ceil(GHOSTS + 1).max(1);
    let moving = mechanism.moving_links();
    for ghost in poses.iter().step_by(step).skip(1) {
        body.raw(r#"<g opacity="0.28">"#);
        if let Some(guide) = guide.as_ref().filter(|guide| guide.moves()) {
            guide.rail(body, &view, ghost, 1.0);
        }
        links(body, &moving, &view.spots(&ghost.joints));
        if let Some(guide) = &guide {
            guide.block(body, &view, ghost, 1.0);
        }
        body.raw("</g>");
    }
    // A path with gaps is drawn in parts; without one it is closed.
    for run in path.split(Option::is_none).filter(|run| !run.is_empty()) {
        body.path(&view.spots(run.iter().flatten()), run.len() == path.len(), &outline(palette::CURVE, 2.2));
    }
    if let Some(first) = poses.first() {
        let spots = view.spots(&first.joints);
        spots[..mechanism.pivots()].iter().for_each(|spot| stand(body, *spot, 0.9));
        if let Some(guide) = &guide {
            guide.rail(body, &view, first, 1.0);
        }
        links(body, &moving, &spots);
        if let Some(guide) = &guide {
            guide.block(body, &view, first, 1.0);
        }
        let pin = filled(palette::PAPER, palette::INK, 1.4);
        let foot = guide.as_ref().and_then(Guide::foot);
        // The foot of a perpendicular is no pin.
        let pins = spots.iter().enumerate().filter(|(i, _)| Some(*i) != foot);
        pins.clone().for_each(|(_, spot)| body.circle(*spot, 3.4, &pin));
        point_mark(body, spots[mechanism.traced()], 1.0);
        let names = mechanism.joint_names();
        for (i, spot) in pins {
            let others: Vec<Spot> = spots.iter().filter(|s| s.distance(*spot) > 1.0).copied().collect();
            letter(body, names[i], *spot, away(*spot, &others));
        }
    }
    sheet.scale_bar(&view, analysis.unit, FULL);
    sheet.note = match closed.first() {
        Some(deg) => format!("crank at {}°, and the path of {}", significant(*deg, 5), analysis.trace),
        None => "it closes at none of the crank angles asked".to_owned(),
    };
    let input = if analysis.input_turns_fully { "the crank turns fully" } else { "the crank rocks" };
    let mut lines = vec![match analysis.stages {
        Some(stages) => format!("{} after the crank", plural(stages, "stage")),
        None => format!("{}: {}", in_words(mechanism.kind()), dimensions(linkage)),
    }];
    if let Some(stroke) = analysis.stroke {
        let [w, h] = [0, 1].map(|axis| significant(stroke.high[axis] - stroke.low[axis], 5));
        lines.push(format!("{} moves {w} in x and {h} in y over a turn", analysis.trace));
    }
    let toggles = analysis.mobility.as_ref().map_or(&[][..], |mobility| &mobility.toggles_deg);
    let of_loads = analysis.loads.as_ref().and_then(|record| loads::sheet(record, toggles));
    page(&analysis.name, input, &lines, [sheet].into_iter().chain(of_loads).collect())
}

/// Returns the position at a crank angle; `None` if the mechanism does not close.
fn pose(mechanism: &dyn Mechanism, crank_deg: f64) -> Option<Drawn> {
    let MechanismPose { joints, coupler, .. } = mechanism.pose_at(crank_deg.to_radians());
    Some(Drawn { joints: joints.into_iter().collect::<Option<_>>()?, coupler })
}

/// Draws the moving links: a bar for two joints, a shaded plate for more.
fn links(canvas: &mut Canvas, links: &[Link], spots: &[Spot]) {
    for link in links {
        let corners: Vec<Spot> = link.joints.iter().filter_map(|i| spots.get(*i)).copied().collect();
        match corners.as_slice() {
            [] | [_] => {}
            [from, to] => {
                for (colour, width) in [(palette::BAR_EDGE, 7.0), (palette::BAR, 4.6)] {
                    canvas.line(*from, *to, &(stroke(colour, width) + ROUND_ENDS));
                }
            }
            corners => plate(canvas, corners, palette::COUPLER, palette::BAR_EDGE, "2"),
        }
    }
}
