//! The drawing of a motion's body: a frame at each pose, in outline where it is wanted and filled where the linkage takes
//! it. The long arm, with a point, is the body's x axis, the short arm its y axis.

use super::canvas::{Canvas, ROUND_CORNERS, Spot, Vec2, View, outline, palette, px, weighted};
use super::scene::{Bounds, Scene};

/// The poses that are drawn strongly; of more, this many evenly chosen. In a small drawing half as many.
const STRONG: usize = 12;
/// The weight below which a drawing is small.
const SMALL: f64 = 0.8;
/// The length of a frame: a part of the diagonal of the targets' box, within these pixels.
const PART: f64 = 0.11;
const LENGTHS: (f64, f64) = (24.0, 44.0);
/// The corners of a frame of length 1 around the body's origin, in its own axes.
const CORNERS: [[f64; 2]; 7] =
    [[-0.07, -0.07], [0.76, -0.07], [1.0, 0.0], [0.76, 0.07], [0.07, 0.07], [0.07, 0.56], [-0.07, 0.56]];

/// The place and the angle (radians) of a body on the canvas.
#[derive(Clone, Copy)]
pub(super) struct Posed {
    pub(super) at: Spot,
    pub(super) angle: f64,
}

impl Posed {
    /// Returns the corners of its frame.
    fn corners(self, length: f64) -> [Spot; 7] {
        let (sin, cos) = self.angle.sin_cos();
        CORNERS.map(|[x, y]| self.at + length * Vec2::new(cos * x - sin * y, -(sin * x + cos * y)))
    }

    /// Draws its frame in outline.
    pub(super) fn outlined(self, canvas: &mut Canvas, length: f64, colour: &str, w: f64) {
        canvas.path(&self.corners(length), true, &(outline(colour, weighted(1.1 * w)) + ROUND_CORNERS));
    }

    /// Draws its frame filled.
    pub(super) fn filled(self, canvas: &mut Canvas, length: f64, colour: &str) {
        canvas.path(&self.corners(length), true, &format!(r#"fill="{colour}" fill-opacity="0.7""#));
    }

    /// Returns the end of its long arm, or of a part of it.
    fn tip(self, length: f64) -> Spot {
        self.at + length * Vec2::new(self.angle.cos(), -self.angle.sin())
    }
}

/// Returns the length of frames at these places.
pub(super) fn length(places: &[Spot]) -> f64 {
    let bounds = Bounds::of(places.iter().map(|at| crate::mechanism::Complex::new(at.x, at.y)));
    (PART * bounds.diagonal()).clamp(LENGTHS.0, LENGTHS.1)
}

/// Returns whether the `i`-th of `n` poses is drawn strongly in a drawing of weight `w`.
pub(super) fn is_strong(i: usize, n: usize, w: f64) -> bool {
    let most = if w < SMALL { STRONG / 2 } else { STRONG };
    n <= most || (0..most).any(|k| k * (n - 1) / (most - 1) == i)
}

/// Draws the body at the targets that have an angle.
pub(super) fn draw(canvas: &mut Canvas, scene: &Scene, view: &View, w: f64) {
    let places: Vec<Spot> = scene.targets.iter().map(|target| view.spot(target.at)).collect();
    let with_angle: Vec<_> = scene
        .targets
        .iter()
        .zip(&places)
        .filter_map(|(target, at)| Some((target, *at, target.angle?)))
        .collect();
    let (n, length) = (with_angle.len(), length(&places) * w);
    let mut faint = String::new();
    for (i, (target, at, angle)) in with_angle.iter().enumerate() {
        let wanted = Posed { at: *at, angle: *angle };
        if !is_strong(i, n, w) {
            let tip = wanted.tip(0.7 * length);
            let [x, y, to_x, to_y] = [at.x, at.y, tip.x, tip.y].map(px);
            faint.push_str(&format!("M{x} {y}L{to_x} {to_y}"));
            continue;
        }
        if let (Some(reached), Some(angle)) = (target.reached, target.reached_angle) {
            Posed { at: view.spot(reached), angle }.filled(canvas, length, palette::CURVE);
        }
        wanted.outlined(canvas, length, palette::TARGET, w);
        let [.., end, _] = wanted.corners(length);
        canvas.labels.mark_line(*at, wanted.tip(length));
        canvas.labels.mark_line(*at, end);
    }
    if !faint.is_empty() && w >= SMALL {
        let line = outline(palette::TARGET, weighted(w));
        canvas.raw(&format!(r#"<path d="{faint}" {line} stroke-opacity="0.5"/>"#));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_many_poses_a_dozen_are_drawn_strongly_the_first_and_the_last_among_them() {
        for n in 1..200 {
            let strong: Vec<usize> = (0..n).filter(|i| is_strong(*i, n, 1.0)).collect();
            assert_eq!(strong.len(), n.min(STRONG), "{n}");
            assert_eq!((strong[0], strong[strong.len() - 1]), (0, n - 1));
        }
    }

    #[test]
    fn the_long_arm_points_along_the_body_and_the_short_one_to_its_left() {
        let corners = Posed { at: Spot::new(100.0, 50.0), angle: std::f64::consts::FRAC_PI_2 }.corners(10.0);
        // Up on the page, where y points down; the short arm then points left.
        assert!((corners[2] - Spot::new(100.0, 40.0)).hypot() < 1e-12, "{corners:?}");
        assert!(corners[5].x < 95.0 && (corners[5].y - 50.0).abs() < 1.0, "{corners:?}");
    }
}
