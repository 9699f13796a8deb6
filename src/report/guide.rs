//! The guide of a slider in drawings: the rail with its block, or the rod that slides through a block at a pivot.

use super::canvas::{Canvas, ROUND_CORNERS, ROUND_ENDS, Vec2, View, filled, palette, stroke, weighted};
use super::scene::{Pose, Scene};
use crate::mechanism::analysis::driven::slider_range;
use crate::mechanism::{Complex, Mechanism, Slide, dot};

/// The part of the slider's range that its rail reaches beyond it at either end.
const BEYOND: f64 = 0.12;

/// A position in which every joint is known.
pub(super) struct Drawn {
    pub(super) joints: Vec<Complex>,
    /// The unit direction of the coupler, of kinds that have one.
    pub(super) coupler: Option<Complex>,
}

/// The guide of a slider with the range that its block uses: a line for the rail or the rod, a rectangle for the block.
pub(super) struct Guide {
    slide: Slide,
    /// The least and the greatest place along the line, with room beyond.
    reach: [f64; 2],
}

impl Guide {
    pub(super) fn of(mechanism: &dyn Mechanism) -> Option<Guide> {
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
    pub(super) fn moves(&self) -> bool {
        matches!(self.slide, Slide::Rod { .. })
    }

    /// Returns the index of the foot of the perpendicular on a rod, which is no pin.
    pub(super) fn foot(&self) -> Option<usize> {
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
    pub(super) fn ends(&self, pose: &Drawn) -> [Complex; 2] {
        let (origin, direction) = self.line(pose);
        self.reach.map(|place| origin + direction * place)
    }

    /// Draws the rail or the rod, in lines of this scale.
    pub(super) fn rail(&self, canvas: &mut Canvas, view: &View, pose: &Drawn, weight: f64) {
        let [from, to] = self.ends(pose).map(|end| view.spot(end));
        match self.slide {
            Slide::Rail { .. } => {
                canvas.line(from, to, &(stroke(palette::BAR_EDGE, weighted(2.0 * weight)) + ROUND_ENDS))
            }
            Slide::Rod { .. } => {
                for (colour, width) in [(palette::BAR_EDGE, 5.0), (palette::BAR, 2.8)] {
                    canvas.line(from, to, &(stroke(colour, weighted(width * weight)) + ROUND_ENDS));
                }
            }
        }
    }

    /// Draws the block as a rectangle along the line, and the arm that joins it to its pivot.
    pub(super) fn block(&self, canvas: &mut Canvas, view: &View, pose: &Drawn, weight: f64) {
        const HALF: [f64; 2] = [11.0, 6.5];
        let (_, direction) = self.line(pose);
        let at = match self.slide {
            Slide::Rail { block, .. } => pose.joints[block],
            Slide::Rod { foot, pivot, .. } => {
                let arm = pose.joints[foot] - pose.joints[pivot];
                if dot(arm, arm) > 0.0 {
                    let bar = stroke(palette::BAR_EDGE, weighted(4.0 * weight)) + ROUND_ENDS;
                    canvas.line(view.spot(pose.joints[pivot]), view.spot(pose.joints[foot]), &bar);
                }
                pose.joints[foot]
            }
        };
        let centre = view.spot(at);
        // Pixels have y down.
        let (along, across) = (Vec2::new(direction.re, -direction.im), Vec2::new(direction.im, direction.re));
        let corner =
            |x: f64, y: f64| centre + along * (x * HALF[0] * weight) + across * (y * HALF[1] * weight);
        let corners = [corner(1.0, 1.0), corner(-1.0, 1.0), corner(-1.0, -1.0), corner(1.0, -1.0)];
        canvas.path(
            &corners,
            true,
            &(filled(palette::PAPER, palette::BAR_EDGE, weighted(2.0 * weight)) + ROUND_CORNERS),
        );
    }
}

/// The slider of a scene at its position.
pub(super) struct Sliding {
    guide: Guide,
    at: Drawn,
}

impl Sliding {
    /// Returns the slider of a scene; `None` of a four-bar.
    pub(super) fn of(scene: &Scene, pose: &Pose) -> Option<Sliding> {
        let linkage = scene.linkage.as_ref()?;
        let guide = Guide::of(linkage.mechanism())?;
        let [a, b, c, d, p] = pose.joints;
        let second = scene.has_two_pivots().then_some(b);
        let joints = std::iter::once(a).chain(second).chain([c, d, p]).collect();
        let length = pose.coupler.norm();
        let coupler = (length > 0.0).then(|| pose.coupler / length);
        Some(Sliding { guide, at: Drawn { joints, coupler } })
    }

    /// Returns the two ends of the rail or the rod.
    pub(super) fn ends(&self) -> [Complex; 2] {
        self.guide.ends(&self.at)
    }

    /// Returns the foot of the perpendicular from P on a rod; `None` of a rail.
    pub(super) fn below_point(&self) -> Option<Complex> {
        let direction = self.at.coupler.filter(|_| self.guide.moves())?;
        let (Some(c), Some(p)) = (self.at.joints.get(2), self.at.joints.last()) else { return None };
        Some(c + direction * dot(direction, p - c))
    }

    /// Draws the rail or the rod.
    pub(super) fn rail(&self, canvas: &mut Canvas, view: &View, weight: f64) {
        self.guide.rail(canvas, view, &self.at, weight);
    }

    /// Draws the block.
    pub(super) fn block(&self, canvas: &mut Canvas, view: &View, weight: f64) {
        self.guide.block(canvas, view, &self.at, weight);
    }
}
