//! The links of a six-bar or an eight-bar in drawings: plates in one colour a dyad, bars, pins, stands and letters.

use super::canvas::{
    Canvas, ROUND_CORNERS, ROUND_ENDS, Spot, View, filled, outline, palette, stroke, weighted,
};
use super::parts::{UP, away, letter, plate, point_mark, stand};
use super::scene::Scene;
use crate::mechanism::dyad_chain::kinds::{CRANK, GROUND};
use crate::mechanism::plates::convex_hull;
use crate::mechanism::{Complex, MultiLoop};

/// The colours of the plates, by dyad.
const DYADS: [&str; 3] = [palette::COUPLER, palette::FOLLOWER, palette::SECOND];

/// One in so many samples of a joint's faint path is drawn.
const PIN_STEP: usize = 4;

/// A linkage of several loops at one position.
pub(super) struct Loops {
    linkage: MultiLoop,
    /// The joints, the fixed pivots first, P the last.
    joints: Vec<(&'static str, Complex)>,
    pivots: usize,
}

impl Loops {
    /// Returns the linkage of a scene at its pose; `None` of one loop.
    pub(super) fn of(scene: &Scene) -> Option<Loops> {
        let (linkage, pose) = (scene.linkage.as_ref()?.multi_loop()?, scene.pose.as_ref()?);
        let [a, _, c, ..] = pose.joints;
        let bodies = linkage.bodies((c - a).arg())?;
        let all = linkage.joints();
        let pivots = all.iter().filter(|joint| joint.body == GROUND).count();
        let joints = all.iter().map(|joint| (joint.name, bodies.place(joint.body, joint.at))).collect();
        Some(Loops { linkage: *linkage, joints, pivots })
    }

    fn place(&self, name: &str) -> Option<Complex> {
        self.joints.iter().find(|(other, _)| *other == name).map(|(_, at)| *at)
    }

    /// Draws the stands, and the line between the fixed pivots.
    pub(super) fn ground(&self, canvas: &mut Canvas, view: &View, w: f64) {
        let pivots: Vec<Spot> = self.joints[..self.pivots].iter().map(|(_, at)| view.spot(*at)).collect();
        let faint = stroke(palette::MUTED, weighted(w)) + r#" stroke-dasharray="2 5""#;
        for pair in pivots.windows(2) {
            canvas.line(pair[0], pair[1], &faint);
        }
        pivots.iter().for_each(|pivot| stand(canvas, *pivot, w));
    }

    /// Draws the paths of the moving joints.
    pub(super) fn pin_paths(&self, canvas: &mut Canvas, view: &View, w: f64) {
        let attributes = outline(palette::FAINT, weighted(1.1 * w));
        for path in paths(&self.linkage) {
            let every: Vec<Complex> = path.into_iter().step_by(PIN_STEP).collect();
            canvas.path(&view.spots(&every), true, &attributes);
        }
    }

    /// Marks the links as occupied for labels.
    pub(super) fn mark(&self, canvas: &mut Canvas, view: &View) {
        for (_, at) in &self.joints {
            canvas.labels.mark(view.spot(*at));
        }
        for body in self.linkage.links().iter().skip(1) {
            let at: Vec<Spot> =
                body.joints.iter().filter_map(|(name, _)| Some(view.spot(self.place(name)?))).collect();
            for pair in at.windows(2) {
                canvas.labels.mark_line(pair[0], pair[1]);
            }
        }
    }

    /// Draws the links: a plate for three joints or more, a bar for two.
    pub(super) fn links(&self, canvas: &mut Canvas, view: &View, w: f64) {
        for body in self.linkage.links().into_iter().skip(1) {
            let at: Vec<Complex> = body.joints.iter().filter_map(|(name, _)| self.place(name)).collect();
            let near = 1e-9 * self.linkage.longest();
            let corners = convex_hull(&at, near);
            let spots = view.spots(&corners);
            let colour = DYADS[(body.body.max(CRANK + 1) - 2) / 2 % DYADS.len()];
            if at.len() > 2 && body.body != CRANK {
                plate(canvas, &spots, colour, palette::BAR_EDGE, &weighted(1.8 * w));
                continue;
            }
            if at.len() > 2 {
                canvas.path(
                    &spots,
                    true,
                    &(filled(palette::BAR, palette::BAR_EDGE, weighted(1.8 * w)) + ROUND_CORNERS),
                );
                continue;
            }
            if let [from, to] = spots[..] {
                for (colour, width) in [(palette::BAR_EDGE, 8.5 * w), (palette::BAR, 5.8 * w)] {
                    canvas.line(from, to, &(stroke(colour, weighted(width)) + ROUND_ENDS));
                }
            }
        }
        let pin = filled(palette::PAPER, palette::BAR_EDGE, weighted(1.8 * w));
        for (i, (name, at)) in self.joints.iter().enumerate() {
            if *name != "P" {
                canvas.circle(view.spot(*at), w * if i < self.pivots { 5.2 } else { 4.2 }, &pin);
            }
        }
    }

    /// Draws the mark of P and, if wanted, the letters of the joints.
    pub(super) fn marks(&self, canvas: &mut Canvas, view: &View, w: f64, letters: bool) {
        if let Some(p) = self.place("P") {
            point_mark(canvas, view.spot(p), w);
        }
        if !letters {
            return;
        }
        let links = self.linkage.links();
        for (i, (name, at)) in self.joints.iter().enumerate() {
            let beside =
                links.iter().skip(1).filter(|body| body.joints.iter().any(|(other, _)| other == name));
            let neighbours: Vec<Spot> = beside
                .flat_map(|body| &body.joints)
                .filter(|(other, _)| other != name)
                .filter_map(|(other, _)| Some(view.spot(self.place(other)?)))
                .collect();
            let towards = away(view.spot(*at), &neighbours);
            letter(canvas, name, view.spot(*at), if i < self.pivots { towards + UP } else { towards });
        }
    }
}

/// Returns the paths of the moving joints over a turn, P the last.
pub(super) fn paths(linkage: &MultiLoop) -> Vec<Vec<Complex>> {
    let mut paths: Vec<Vec<Complex>> = Vec::new();
    for i in 0..super::scene::SAMPLES {
        let angle = std::f64::consts::TAU * i as f64 / super::scene::SAMPLES as f64;
        let Some(bodies) = linkage.bodies(angle) else { continue };
        for (j, at) in linkage.moving(&bodies).enumerate() {
            if paths.len() <= j {
                paths.push(Vec::new());
            }
            paths[j].push(at);
        }
    }
    paths
}
