//! A drawing of a linkage of any kind at one position, with other positions drawn faintly and the path of its traced point.

use super::canvas::{Canvas, ROUND_CORNERS, ROUND_ENDS, Spot, Vec2, View, filled, outline, palette, stroke};
use super::mechanism_text::{dimensions, in_words};
use super::parts::{away, letter, plate, point_mark, stand};
use super::scene::Bounds;
use super::sheet::{FULL, Sheet, page};
use super::text::{plural, significant};
use crate::mechanism::analysis::Status;
use crate::mechanism::analysis::driven::{CYCLE_SAMPLES, MechanismAnalysis, slider_range};
use crate::mechanism::{Complex, Link, Linkage, Mechanism, MechanismPose, Slide, dot};

/// The largest number of positions that are drawn faintly besides the first.
const GHOSTS: usize = 5;
/// The part of the slider's range that its rail reaches beyond it at either end.
const BEYOND: f64 = 0.12;

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
            guide.rail(body, &view, ghost);
        }
        links(body, &moving, &view.spots(&ghost.joints));
        if let Some(guide) = &guide {
            guide.block(body, &view, ghost);
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
            guide.rail(body, &view, first);
        }
        links(body, &moving, &spots);
        if let Some(guide) = &guide {
            guide.block(body, &view, first);
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
    page(&analysis.name, input, &lines, vec![sheet])
}

/// A position in which every joint is known.
struct Drawn {
    joints: Vec<Complex>,
    /// The unit direction of the coupler, of kinds that have one.
    coupler: Option<Complex>,
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

/// The guide of a slider with the range that its block uses: a line for the rail or the rod, a rectangle for the block.
struct Guide {
    slide: Slide,
    /// The least and the greatest place along the line, with room beyond.
    reach: [f64; 2],
}

impl Guide {
    fn of(mechanism: &dyn Mechanism) -> Option<Guide> {
        let slide = mechanism.slide()?;
        let [low, high] = slider_range(mechanism)?;
        let beyond = BEYOND * (high - low);
        let reach = match slide {
            Slide::Rail { .. } => [low - beyond, high + beyond],
            // A rod goes from its joint to the farthest place of the block, whichever way that lies.
            Slide::Rod { .. } if high > 0.0 => [0.0, high + beyond],
            Slide::Rod { .. } => [low - beyond, 0.0],
        };
        Some(Guide { slide, reach })
    }

    /// Returns whether the line moves with a link.
    fn moves(&self) -> bool {
        matches!(self.slide, Slide::Rod { .. })
    }

    /// Returns the index of the foot of the perpendicular on a rod, which is no pin.
    fn foot(&self) -> Option<usize> {
        match self.slide {
            Slide::Rod { foot, .. } => Some(foot),
            Slide::Rail { .. } => None,
        }
    }

    /// Returns a point of the line, from which places count, and the line's direction.
    fn line(&self, pose: &Drawn) -> (Complex, Complex) {
        match self.slide {
            Slide::Rail { through, direction, .. } => (through, direction),
            Slide::Rod { from, .. } => (pose.joints[from], pose.coupler.unwrap_or(Complex::new(1.0, 0.0))),
        }
    }

    /// Returns the two ends of the drawn line.
    fn ends(&self, pose: &Drawn) -> [Complex; 2] {
        let (origin, direction) = self.line(pose);
        self.reach.map(|place| origin + direction * place)
    }

    fn rail(&self, canvas: &mut Canvas, view: &View, pose: &Drawn) {
        let [from, to] = self.ends(pose).map(|end| view.spot(end));
        match self.slide {
            Slide::Rail { .. } => canvas.line(from, to, &(stroke(palette::BAR_EDGE, 2) + ROUND_ENDS)),
            Slide::Rod { .. } => {
                for (colour, width) in [(palette::BAR_EDGE, 5.0), (palette::BAR, 2.8)] {
                    canvas.line(from, to, &(stroke(colour, width) + ROUND_ENDS));
                }
            }
        }
    }

    /// Draws the block as a rectangle along the line, and the arm that joins it to its pivot.
    fn block(&self, canvas: &mut Canvas, view: &View, pose: &Drawn) {
        const HALF: [f64; 2] = [11.0, 6.5];
        let (_, direction) = self.line(pose);
        let at = match self.slide {
            Slide::Rail { block, .. } => pose.joints[block],
            Slide::Rod { foot, pivot, .. } => {
                let arm = pose.joints[foot] - pose.joints[pivot];
                if dot(arm, arm) > 0.0 {
                    let bar = stroke(palette::BAR_EDGE, 4) + ROUND_ENDS;
                    canvas.line(view.spot(pose.joints[pivot]), view.spot(pose.joints[foot]), &bar);
                }
                pose.joints[foot]
            }
        };
        let centre = view.spot(at);
        // Pixels have y down.
        let (along, across) = (Vec2::new(direction.re, -direction.im), Vec2::new(direction.im, direction.re));
        let corner = |x: f64, y: f64| centre + along * (x * HALF[0]) + across * (y * HALF[1]);
        let corners = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
        canvas.path(&corners, true, &(filled(palette::PAPER, palette::BAR_EDGE, 2) + ROUND_CORNERS));
    }
}
