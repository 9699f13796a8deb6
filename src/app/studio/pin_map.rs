//! The map of the places of a pin: how nearly each point of the body moves on a circle about a fixed pivot; and of four poses
//! the curves of the pins that stay on circles, and of their pivots.

use crate::mechanism::{Dyad, Pose, xy};
use crate::synthesis::dyads::{CircleMap, circle_minima};
use crate::synthesis::pose_curves::{PAIRED_LIVE, PosePlace, pose_curves};
use crate::task::Problem;
use schemars::JsonSchema;
use serde::Serialize;

/// Places a side.
const GRID: usize = 81;
/// Half the side, in sizes of the poses.
const REACH: f64 = 2.0;
/// The fewest poses that leave places out: through three any pin moves on a circle.
const FEWEST: usize = 4;
/// The most of the best places that are named.
const BEST: usize = 8;
/// The errors of the lowest and the highest level in sizes of the poses, as powers of ten, and the levels between them.
const RANGE: [f64; 2] = [-3.0, -0.5];
const LEVELS: u8 = 56;
/// The parts of the poses' size to which places of the curves are rounded.
const DIGITS: f64 = 1e5;
/// The letter of the lowest level; the others follow it, and none of them is a quote or a backslash.
const LOWEST: u8 = b'#';

/// How nearly the points of a body move on circles while it takes its poses. A fixed pivot is the centre of the circle.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PinMap {
    /// Places a side of the square.
    pub grid: usize,
    /// Half the side, a length: the square lies about the body's origin, along its axes.
    pub half: f64,
    /// One letter a place, row by row from the least y, each from the least x: `#` where the rms distance from the best
    /// circle is a thousandth of the poses' size or less, the next 56 letters of ASCII (to `[`) for errors up to a third
    /// of the size, evenly in their logarithms.
    pub levels: String,
    /// The places of least error, the best first: the pin in the body's frame and the fixed pivot of its circle.
    pub best: Vec<[[f64; 2]; 2]>,
    /// Of four poses the circle-point and centre-point curves, in stretches without a gap.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curves: Vec<Vec<CurvePlace>>,
}

/// A place of the circle-point and centre-point curves of four poses.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct CurvePlace {
    /// The circle point: the pin in the body's frame.
    pub pin: [f64; 2],
    /// The centre point: its fixed pivot.
    pub pivot: [f64; 2],
    /// The worst transmission angle between the poses, in degrees, of the best linkage without defects that has its pin here;
    /// absent if there is none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub deg: Option<f64>,
}

/// Returns the curves of a problem; empty where there are none.
fn curves(problem: &Problem) -> Vec<Vec<CurvePlace>> {
    let size = problem.task().size();
    let rounded = |x: f64| (x / size * DIGITS).round() / DIGITS * size;
    let place = |place: &PosePlace| CurvePlace {
        pin: xy(place.pin).map(rounded),
        pivot: xy(place.pivot).map(rounded),
        deg: place.transmission_deg.map(|deg| (10.0 * deg).round() / 10.0),
    };
    let stretches = pose_curves(problem, PAIRED_LIVE).unwrap_or_default();
    stretches.iter().map(|stretch| stretch.iter().map(place).collect()).collect()
}

impl PinMap {
    /// Returns the map of a motion's poses; `None` of another task, of fewer than four poses, and of a body that only turns.
    pub(super) fn of(problem: &Problem) -> Option<PinMap> {
        let task = problem.task();
        let body = task.body().filter(|_| problem.spec().task.is_motion())?;
        let given = task.points().iter().zip(&body.angles).zip(task.weights());
        let (poses, weights): (Vec<Pose>, Vec<f64>) = given
            .filter_map(|((point, angle), weight)| Some((Pose::new(*point, (*angle)?), *weight)))
            .unzip();
        if poses.len() < FEWEST {
            return None;
        }
        let map = CircleMap::new(&poses, Some(&weights), GRID, REACH)?;
        let size = task.size();
        let letter = |rms: &f64| {
            let part = ((rms / size).log10() - RANGE[0]) / (RANGE[1] - RANGE[0]);
            char::from(LOWEST + (part.clamp(0.0, 1.0) * f64::from(LEVELS)).round() as u8)
        };
        let half = map.pin(GRID - 1, 0).re;
        let minima = circle_minima(&poses, Some(&weights), GRID, REACH);
        let best = minima.iter().take(BEST).filter_map(|dyad| match dyad {
            Dyad::RR { pin, pivot, .. } => Some([[pin.re, pin.im], [pivot.re, pivot.im]]),
            _ => None,
        });
        Some(PinMap {
            grid: GRID,
            half,
            levels: map.rms().iter().map(letter).collect(),
            best: best.collect(),
            curves: curves(problem),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::problem_file::{load, parse};
    use std::path::Path;

    #[test]
    fn the_pins_of_a_linkage_lie_at_the_lowest_level() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR"));
        let file = load(&root.join("problems/motion/crank-rocker-12.toml"), &[]).expect("a problem");
        let problem = Problem::new(file.spec).expect("a task");
        let map = PinMap::of(&problem).expect("a map");
        assert_eq!(map.levels.len(), map.grid * map.grid);
        assert!(map.levels.bytes().all(|letter| (b'#'..=b'[').contains(&letter)));
        // The place of the map that is nearest to the best pin is lower than the mean.
        let near = |v: f64| ((v / map.half + 1.0) / 2.0 * (map.grid - 1) as f64).round() as usize;
        let [x, y] = map.best[0][0];
        let level = map.levels.as_bytes()[near(y) * map.grid + near(x)];
        let mean = map.levels.bytes().map(u64::from).sum::<u64>() / map.levels.len() as u64;
        assert!(u64::from(level) + 10 < mean, "{level} beside {mean}");
    }

    #[test]
    fn four_poses_have_their_curves_and_five_have_none() {
        let poses = ["[0, 0, 0]", "[10, 12, 12]", "[22, 20, 31]", "[38, 22, 49]", "[55, 18, 66]"];
        let map = |n: usize| {
            let text = format!("format = 1\n[task.motion]\nposes = [{}]\n", poses[..n].join(", "));
            let file = parse("p", &text, None, &[]).expect("a problem");
            PinMap::of(&Problem::new(file.spec).expect("a task")).expect("a map")
        };
        assert!(map(5).curves.is_empty());
        let curves = map(4).curves;
        let places: Vec<&CurvePlace> = curves.iter().flatten().collect();
        assert!(places.len() > 100, "{}", places.len());
        assert!(places.iter().any(|place| place.deg.is_some_and(|deg| deg > 20.0)));
        assert!(places.iter().any(|place| place.deg.is_none()));
    }

    #[test]
    fn three_poses_and_a_path_have_no_map() {
        for task in [
            "[task.motion]\nposes = [[0, 0, 0], [1, 1, 20], [2, 1, 50]]\n",
            "[task.path]\npoints = [[0, 0], [1, 1], [2, 1], [3, 0]]\n",
        ] {
            let file = parse("p", &format!("format = 1\n{task}"), None, &[]).expect("a problem");
            assert_eq!(PinMap::of(&Problem::new(file.spec).expect("a task")), None, "{task}");
        }
    }
}
