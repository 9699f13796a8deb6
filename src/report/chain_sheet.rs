//! A drawing of a compound mechanism at one position, with other positions drawn faintly and the path of its traced
//! point.

use super::canvas::{Canvas, ROUND_ENDS, Spot, filled, outline, palette, stroke};
use super::parts::{away, letter, plate, point_mark, stand};
use super::scene::Bounds;
use super::sheet::{FULL, Sheet, page};
use super::text::{plural, significant};
use crate::mechanism::analysis::Status;
use crate::mechanism::analysis::chain::{CYCLE_SAMPLES, ChainAnalysis};
use crate::mechanism::{Chain, Complex};

/// The largest number of positions that are drawn faintly besides the first.
const GHOSTS: usize = 5;

/// Returns the page of a chain's analysis: one self-contained SVG.
pub fn chain_svg(analysis: &ChainAnalysis, chain: &Chain) -> String {
    let path: Vec<Option<Complex>> = chain.path(chain.trace(), CYCLE_SAMPLES);
    let closed: Vec<f64> =
        analysis.rows.iter().filter(|r| r.status != Status::Open).map(|r| r.crank_deg).collect();
    let poses: Vec<Vec<Complex>> = closed.iter().filter_map(|deg| pose(chain, *deg)).collect();
    let start = chain.pose();
    let all = path.iter().flatten().chain(poses.iter().flatten()).chain(start.known());
    let (mut sheet, view) = Sheet::fitted("Positions", &Bounds::of(all.copied()), FULL);
    let body = &mut sheet.body;
    let step = poses.len().div_ceil(GHOSTS + 1).max(1);
    for ghost in poses.iter().step_by(step).skip(1) {
        body.raw(r#"<g opacity="0.28">"#);
        links(body, chain, &view.spots(ghost));
        body.raw("</g>");
    }
    // A path with gaps is drawn in parts; without one it is closed.
    for run in path.split(Option::is_none).filter(|run| !run.is_empty()) {
        body.path(&view.spots(run.iter().flatten()), run.len() == path.len(), &outline(palette::CURVE, 2.2));
    }
    if let Some(first) = poses.first() {
        let spots = view.spots(first);
        let pivots = chain.names().len() - chain.stages() - 1;
        spots[..pivots].iter().for_each(|spot| stand(body, *spot, 0.9));
        links(body, chain, &spots);
        let pin = filled(palette::PAPER, palette::INK, 1.4);
        spots.iter().for_each(|spot| body.circle(*spot, 3.4, &pin));
        point_mark(body, spots[chain.trace().index()], 1.0);
        for (name, spot) in chain.names().iter().zip(&spots) {
            let others: Vec<Spot> = spots.iter().filter(|s| s.distance(*spot) > 1.0).copied().collect();
            letter(body, name, *spot, away(*spot, &others));
        }
    }
    sheet.scale_bar(&view, analysis.unit, FULL);
    sheet.note = match closed.first() {
        Some(deg) => format!("crank at {}°, and the path of {}", significant(*deg, 5), analysis.trace),
        None => "it closes at none of the crank angles asked".to_owned(),
    };
    let input = if analysis.input_turns_fully { "the crank turns fully" } else { "the crank rocks" };
    let mut lines = vec![format!("{} after the crank", plural(analysis.stages, "stage"))];
    if let Some(stroke) = analysis.stroke {
        let [w, h] = [0, 1].map(|axis| significant(stroke.high[axis] - stroke.low[axis], 5));
        lines.push(format!("{} moves {w} in x and {h} in y over a turn", analysis.trace));
    }
    page(&analysis.name, input, &lines, vec![sheet])
}

/// Returns every point at a crank angle; `None` if a stage does not close.
fn pose(chain: &Chain, crank_deg: f64) -> Option<Vec<Complex>> {
    let mut pose = chain.pose();
    chain.position(crank_deg.to_radians(), &mut pose);
    (pose.known().len() == chain.names().len()).then(|| pose.known().to_vec())
}

/// Draws the moving links: a bar for two points, a shaded plate for more.
fn links(canvas: &mut Canvas, chain: &Chain, spots: &[Spot]) {
    for link in chain.links().iter().skip(1) {
        let corners: Vec<Spot> = link.iter().filter_map(|id| spots.get(id.index())).copied().collect();
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
