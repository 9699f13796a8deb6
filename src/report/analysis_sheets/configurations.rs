//! The four configurations (t1, t2) side by side, each with its coupler curve (Romero, figure 3).

use super::{as_joints, closed, degrees, pivots, positions_of, sign};
use crate::mechanism::analysis::{Analysis, Configuration};
use crate::report::canvas::{Anchor, Area, Canvas, Spot, View, bold, font, palette};
use crate::report::figure::{Detail, draw};
use crate::report::labels::Labels;
use crate::report::scene::{Bounds, Pose, Scene, circuits_through, middle_position};
use crate::report::sheet::{FULL, HEAD, INSET, Sheet, scale_bar};

/// The number of samples of a circuit: a degree of the crank, in a small drawing.
const SAMPLES: usize = 360;
const GAP: f64 = 26.0;
const CELL: f64 = (FULL - 2.0 * INSET - 3.0 * GAP) / 4.0;
/// The height of the line above each drawing.
const CELL_HEAD: f64 = 24.0;
/// The allowed heights of a drawing, which follows the common shape.
const HEIGHTS: std::ops::RangeInclusive<f64> = 150.0..=330.0;

pub(super) fn sheet(analysis: &Analysis) -> Option<Sheet> {
    let all: &[Configuration; 4] = analysis.configurations.as_slice().try_into().ok()?;
    let scenes = all.each_ref().map(scene);
    // One frame and one scale, so that the four can be compared.
    let mut bounds = Bounds::default();
    scenes.iter().for_each(|(scene, _)| bounds.hold_all(&scene.bounds()));
    let wanted = CELL * bounds.height() / bounds.width().max(f64::MIN_POSITIVE) + 40.0;
    let height = wanted.clamp(*HEIGHTS.start(), *HEIGHTS.end());
    let mut body = Canvas::default();
    let top = HEAD + CELL_HEAD;
    let mut scale = None;
    for (i, (configuration, (scene, crank_deg))) in all.iter().zip(&scenes).enumerate() {
        let x = INSET + i as f64 * (CELL + GAP);
        let view = View::fit(&bounds, Area { x, y: top, width: CELL, height }.shrunk(20.0));
        draw(&mut body, scene, &view, Detail { letters: scene.pose.is_some(), ..Detail::small(0.62) });
        if scene.pose.is_none() {
            pivots(&mut body, &mut Labels::default(), &view, &configuration.linkage, 0.62);
        }
        heading(&mut body, configuration, *crank_deg, x, i == 0);
        scale.get_or_insert(view);
    }
    let bottom = top + height + 30.0;
    if let Some(view) = &scale {
        scale_bar(&mut body, view, analysis.unit, CELL, bottom);
    }
    Some(Sheet {
        title: "The four configurations".to_owned(),
        note: "t1 = +1: D left of the line C→B; t2 = +1: P left of the line C→D".to_owned(),
        body,
        foot: Vec::new(),
        width: FULL,
        bottom,
    })
}

/// Returns the scene of the first position that closes, with its crank angle; otherwise only the curve.
fn scene(configuration: &Configuration) -> (Scene, Option<f64>) {
    let linkage = &configuration.linkage;
    let all = closed(configuration);
    let mut circuits = circuits_through(linkage, positions_of(configuration, &all).take(1), SAMPLES);
    if circuits.is_empty() {
        circuits = circuits_through(linkage, [middle_position(linkage)], SAMPLES);
    }
    let first = all.first();
    let pose = first.map(|(_, joints)| Pose { target: None, joints: as_joints(*joints) });
    let scene = Scene { linkage: Some(*linkage), targets: Vec::new(), circuits, pose };
    (scene, first.map(|(row, _)| row.crank_deg))
}

fn heading(canvas: &mut Canvas, configuration: &Configuration, crank_deg: Option<f64>, x: f64, own: bool) {
    let linkage = &configuration.linkage;
    let signs = format!("t1 = {}, t2 = {}", sign(linkage.assembly().sign()), sign(linkage.side().sign()));
    let bold = bold(12.5, palette::INK);
    let y = HEAD + 14.0;
    canvas.text(Spot::new(x, y), Anchor::Start, &bold, &signs);
    let at = crank_deg.map_or("open".to_owned(), |deg| format!("at {}", degrees(deg)));
    let text = if own { format!("as given, {at}") } else { at };
    let muted = font(12, palette::MUTED);
    canvas.text(Spot::new(x + CELL, y), Anchor::End, &muted, &text);
}
