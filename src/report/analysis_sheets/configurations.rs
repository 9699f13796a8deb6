//! The four configurations (t1, t2) side by side, each with its coupler curve (Romero, figure 3).

use super::{closed, degrees, pivots, scene};
use crate::mechanism::analysis::{Analysis, Configuration};
use crate::report::canvas::{Anchor, Area, Canvas, Spot, View, bold, font, palette};
use crate::report::figure::{Detail, draw};
use crate::report::labels::Labels;
use crate::report::scene::Bounds;
use crate::report::sheet::{FULL, HEAD, INSET, Sheet, sign};

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
    let positions = all.each_ref().map(closed);
    let scenes: Vec<_> = all
        .iter()
        .zip(&positions)
        .map(|(c, closed)| scene(&c.linkage, closed.get(..1).unwrap_or_default(), SAMPLES))
        .collect();
    // One frame and one scale, so that the four can be compared.
    let bounds = Bounds::of(scenes.iter().flat_map(|scene| scene.bounds().corners()));
    let wanted = CELL * bounds.height() / bounds.width().max(f64::MIN_POSITIVE) + 40.0;
    let height = wanted.clamp(*HEIGHTS.start(), *HEIGHTS.end());
    let top = HEAD + CELL_HEAD;
    let mut sheet = Sheet::new("The four configurations", FULL, top + height + 30.0);
    let body = &mut sheet.body;
    let view = |i: usize| {
        let x = INSET + i as f64 * (CELL + GAP);
        View::fit(&bounds, Area { x, y: top, width: CELL, height }.shrunk(20.0))
    };
    for (i, (configuration, scene)) in all.iter().zip(&scenes).enumerate() {
        // Labels avoid only the drawing that they belong to.
        body.labels = Labels::default();
        draw(body, scene, &view(i), Detail { letters: scene.pose.is_some(), ..Detail::small(0.62) });
        if scene.pose.is_none() {
            body.labels = Labels::default();
            pivots(body, &view(i), &configuration.linkage, 0.62);
        }
        heading(body, configuration, positions[i].first().map(|(row, _)| row.crank_deg), i);
    }
    sheet.scale_bar(&view(0), analysis.unit, CELL);
    sheet.note = "t1 = +1: D left of the line C→B; t2 = +1: P left of the line C→D".to_owned();
    Some(sheet)
}

/// Writes the signs and the crank angle of the configuration at an index above its drawing.
fn heading(canvas: &mut Canvas, configuration: &Configuration, crank_deg: Option<f64>, index: usize) {
    let x = INSET + index as f64 * (CELL + GAP);
    let linkage = &configuration.linkage;
    let signs = format!("t1 = {}, t2 = {}", sign(linkage.assembly().sign()), sign(linkage.side().sign()));
    let bold = bold(12.5, palette::INK);
    let y = HEAD + 14.0;
    canvas.text(Spot::new(x, y), Anchor::Start, &bold, &signs);
    let at = crank_deg.map_or("open".to_owned(), |deg| format!("at {}", degrees(deg)));
    let text = if index == 0 { format!("as given, {at}") } else { at };
    let muted = font(12, palette::MUTED);
    canvas.text(Spot::new(x + CELL, y), Anchor::End, &muted, &text);
}
