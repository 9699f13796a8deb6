//! Symmetries of a target, and the images of a linkage under them.
//!
//! An isometry z -> s + w z or z -> s + w conj(z), |w| = 1, that carries point j of the target to point pi(j) carries a
//! linkage at its positions to another one: the positions at j become those at pi(j), and every error keeps its length.
//! pi keeps the order of the points or turns it round; of a path that ends where it begins it may also start elsewhere.
//! w is the least-squares fit to the points about their mean,
//!
//! ```text
//! w = sum_j y_j conj(z_j) / |..|    (a turn),     w = sum_j y_j z_j / |..|    (a mirror)
//! ```
//!
//! with z_j = T_j - T, y_j = T_pi(j) - T.

use super::look::{Look, NEAR};
use super::unwrapped::unwrapped;
use crate::judge::assess::assess_again;
use crate::mechanism::{AssemblyMode, Complex, CrankLinkage};
use crate::record::{Assemblies, Candidate};
use crate::task::Problem;
use crate::task::{AngleOffset, Timing};
use std::borrow::Cow;

/// Tolerance of a symmetry, in parts of the target's size: typed points have few digits.
const TYPED: f64 = 1e-5;
/// Number of points above which symmetries are not looked for: n points have 2 n orders of n points each.
const MOST_POINTS: usize = 200;
/// Tolerance for prescribed angles, in degrees.
const ANGLE_DEG: f64 = 1e-7;
/// Greatest relative increase of the rms error at which an image serves as well.
const AS_GOOD: f64 = 1e-2;

/// An isometry that carries the target's points to each other.
#[derive(Clone, Debug)]
struct Symmetry {
    mirrors: bool,
    /// The rotation w.
    turn: Complex,
    /// The translation s.
    shift: Complex,
    /// The permutation pi of the points.
    order: Vec<usize>,
}

/// The isometries of a target, except the identity.
#[derive(Clone, Debug, Default)]
pub struct Symmetries(Vec<Symmetry>);

impl Symmetries {
    /// Finds the symmetries of a problem's target: of its points, weights and tolerances. None are looked for in a motion, nor under
    /// loads, which have a direction of their own.
    pub fn of(problem: &Problem) -> Self {
        let task = problem.task();
        let all = task.points();
        if all.len() > MOST_POINTS || task.body().is_some() || problem.spec().loads.is_some() {
            return Symmetries::default();
        }
        // The closing point is the first one again.
        let points = if task.repeats_first() { &all[..all.len() - 1] } else { all };
        let n = points.len();
        let starts = if task.closed() || task.repeats_first() { n } else { 1 };
        let mut found = Vec::new();
        for start in 0..starts {
            for back in [false, true] {
                let place = |j: usize| if back { (start + n - 1 - j) % n } else { (start + j) % n };
                let order: Vec<usize> = (0..n).map(place).collect();
                for mirrors in [false, true] {
                    let nothing = !mirrors && order.iter().enumerate().all(|(j, to)| j == *to);
                    if !nothing {
                        found.extend(Symmetry::fitted(problem, points, &order, mirrors));
                    }
                }
            }
        }
        Symmetries(found)
    }

    /// Returns the images of a candidate: for each symmetry a linkage at its positions, with the candidate's own
    /// figures and verdicts. Images that prescribed angles do not allow are left out.
    pub fn images<'a>(
        &'a self,
        problem: &'a Problem,
        candidate: &'a Candidate,
    ) -> impl Iterator<Item = Candidate> + 'a {
        self.0.iter().filter_map(|symmetry| symmetry.image(problem, candidate))
    }
}

/// Returns whether the target is symmetric and the mirror image of an accepted candidate, if it is a different linkage,
/// is accepted too and as good.
pub fn mirror_image_serves(problem: &Problem, candidate: &Candidate) -> bool {
    if !candidate.accepted {
        return false;
    }
    let size = problem.task().size();
    let own = Look::of(Cow::Borrowed(candidate));
    let mut mirrors = Symmetries::of(problem);
    mirrors.0.retain(|symmetry| symmetry.mirrors);
    mirrors.images(problem, candidate).any(|image| {
        // A different linkage, even of the same curve: a good fit of a symmetric target is nearly symmetric itself.
        let another = own.difference(&Look::of(Cow::Borrowed(&image))) >= NEAR;
        let bar = candidate.error.rms * (1.0 + AS_GOOD) + TYPED * size;
        let serves = |c: Candidate| c.accepted && c.error.rms <= bar;
        another && assess_again(problem, &image).is_some_and(serves)
    })
}

impl Symmetry {
    /// Fits the isometry for a permutation of the points; `None` if it does not carry each point to its image.
    fn fitted(problem: &Problem, points: &[Complex], order: &[usize], mirrors: bool) -> Option<Symmetry> {
        let task = problem.task();
        let mean = points.iter().sum::<Complex>() / points.len() as f64;
        let from = |j: usize| if mirrors { (points[j] - mean).conj() } else { points[j] - mean };
        let to = |j: usize| points[order[j]] - mean;
        let sum: Complex = (0..points.len()).map(|j| to(j) * from(j).conj()).sum();
        let turn = Some(sum / sum.norm()).filter(|turn| turn.is_finite())?;
        let fits = (0..points.len()).all(|j| (turn * from(j) - to(j)).norm() <= TYPED * task.size());
        let same = |list: &[f64]| (0..points.len()).all(|j| list[j] == list[order[j]]);
        let of_point = same(task.weights()) && task.tolerances().is_none_or(same);
        let as_timed = (0..points.len()).all(|j| task.is_untimed(j) == task.is_untimed(order[j]));
        let shift = mean - turn * if mirrors { mean.conj() } else { mean };
        let mut order = order.to_vec();
        if task.repeats_first() {
            order.push(order[0]);
        }
        (fits && of_point && as_timed).then_some(Symmetry { mirrors, turn, shift, order })
    }

    fn image(&self, problem: &Problem, candidate: &Candidate) -> Option<Candidate> {
        let n = self.order.len();
        if candidate.crank_deg.len() != n || candidate.t1_at.len() != n {
            return None;
        }
        let mut linkage = candidate.linkage.carried(self.mirrors, self.turn, self.shift).ok()?;
        let turned = self.turn.arg().to_degrees();
        let (mut crank_deg, mut t1_at) = (vec![0.0; n], vec![AssemblyMode::Plus; n]);
        for (j, &to) in self.order.iter().enumerate() {
            let (deg, t1) = (candidate.crank_deg[j], candidate.t1_at[j]);
            crank_deg[to] = turned + if self.mirrors { -deg } else { deg };
            t1_at[to] = linkage.carried_assembly(self.mirrors, t1);
        }
        linkage = linkage.with_assembly(*t1_at.first()?);
        match problem.task().timing() {
            Timing::Free => {
                let radians = crank_deg.iter().map(|deg| deg.to_radians()).collect();
                (crank_deg, t1_at) = unwrapped(problem, linkage, radians, t1_at);
            }
            Timing::Prescribed { offset, .. } => crank_deg = in_step(problem, &linkage, *offset, &crank_deg)?,
        }
        let t1_at = Assemblies::of(&linkage, t1_at);
        Some(Candidate { linkage, crank_deg, t1_at, ..candidate.clone() })
    }
}

/// Returns the prescribed angles of a linkage, if the angles that it has are equal to them up to whole turns.
fn in_step(problem: &Problem, linkage: &CrankLinkage, offset: AngleOffset, has: &[f64]) -> Option<Vec<f64>> {
    let (task, written) = (problem.task(), &problem.spec().task.timing.as_ref()?.crank_deg);
    let timed = (0..has.len()).find(|j| !task.is_untimed(*j))?;
    let (first, asked) = (*has.get(timed)?, *written.get(timed)?);
    problem.directions().iter().find_map(|direction| {
        let base = match offset {
            AngleOffset::Free => first - direction * asked,
            AngleOffset::Fixed => 0.0,
            AngleOffset::Ground => linkage.ground_angle().to_degrees(),
        };
        // An angle that is free is that of the image, on the turn of its neighbours.
        let off = |has: f64, asked: f64| has - asked - 360.0 * ((has - asked) / 360.0).round();
        let angle = |(j, (has, written)): (usize, (&f64, &f64))| {
            let asked = base + direction * written;
            let off = off(*has, asked);
            if task.is_untimed(j) { Some(asked + off) } else { (off.abs() <= ANGLE_DEG).then_some(asked) }
        };
        has.iter().zip(written).enumerate().map(angle).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthesis::fixture;

    fn symmetries(points: &[[f64; 2]], closed: bool) -> (usize, usize) {
        let problem = fixture::problem(points, closed, "");
        let all = Symmetries::of(&problem);
        let mirrors = all.0.iter().filter(|symmetry| symmetry.mirrors).count();
        (mirrors, all.0.len() - mirrors)
    }

    #[test]
    fn targets_have_the_symmetries_that_are_seen_in_them() {
        // A line: mirrored in itself and in its middle, and turned about that.
        assert_eq!(symmetries(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [3.0, 3.0]], false), (2, 1));
        // An arch: mirrored in its middle.
        assert_eq!(symmetries(&[[-2.0, 0.0], [-1.0, 1.0], [1.0, 1.0], [2.0, 0.0]], false), (1, 0));
        // A rectangle of other sides as a closed path: two mirrors and half a turn.
        assert_eq!(symmetries(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0]], true), (2, 1));
        // The first point again at the end makes no difference.
        assert_eq!(symmetries(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.0], [0.0, 0.0]], false), (2, 1));
        assert_eq!(symmetries(&[[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [0.0, 1.1]], true), (0, 0));
    }

    #[test]
    fn an_image_passes_the_points_as_its_original_does() {
        let linkage = fixture::linkage([4.0, 1.5, 3.5, 3.2]);
        let points: Vec<[f64; 2]> = (0..12)
            .map(|j| {
                let t = (30.0 * f64::from(j)).to_radians();
                [7.0 + 2.0 * t.cos(), 1.0 + t.sin()]
            })
            .collect();
        let problem = fixture::problem(&points, true, "");
        let (deg, t1): (Vec<f64>, Vec<AssemblyMode>) =
            (0..12).map(|j| (20.0 + 29.0 * f64::from(j), linkage.assembly())).unzip();
        let candidate = crate::judge::assess::assess(&problem, linkage, &deg, &t1).expect("it closes");
        let all = Symmetries::of(&problem);
        assert_eq!(all.0.len(), 3);
        for image in all.images(&problem, &candidate) {
            let judged = assess_again(&problem, &image).expect("it closes");
            let (one, other) = (candidate.error.sum_sq, judged.error.sum_sq);
            assert!((one - other).abs() <= 1e-9 * one, "{one} {other}");
            assert_eq!(judged.defects, candidate.defects);
            let apart = (judged.transmission_deg.worst - candidate.transmission_deg.worst).abs();
            assert!(apart < 1e-9 && judged.linkage_type == candidate.linkage_type);
        }
    }
}
