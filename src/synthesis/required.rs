//! Ends whose points have strayed to circuits or branches that the referee will refuse, and starts that lead back.
//!
//! A joint fit does not fix the linkage type unless the problem does. By way of a change point positions then come to
//! lie on two circuits, or on both branches of a rocking motion, and such an end may well have the least error of all.
//! The requirements are best met near it by a linkage that cannot stray: with one circuit if branches are free, with an
//! input that turns fully if one branch is required. The fit there holds its points on the branch from which they start; of
//! a motion it can do so whatever the type, be the crank the one dyad or the other. The best acceptable linkage is often at
//! a toggle of one of its points or at a change point.

use super::constants::free::{GOES_ON, LED_BACK_MOST, NEARLY_EXACT, SHORT_FIT, WORTH_LEADING_BACK};
use super::motion::swapped;
use super::multistart::{Effort, Spender, by_merit};
use crate::mechanism::four_bar::mobility::linkage_type;
use crate::mechanism::{AssemblyMode, Branch, Complex, LinkageType};
use crate::task::Problem;
use crate::task::forms::rows::assembly_of;
use crate::task::forms::start::Start;
use crate::task::forms::torus::mirrored;

/// Types whose circuits are branches: the input turns fully.
pub(in crate::synthesis) const ONE_BRANCH: [LinkageType; 2] =
    [LinkageType::CrankRocker, LinkageType::DoubleCrank];

/// Returns the cost of an rms error given in sizes of the target.
pub(super) fn cost_of(problem: &Problem, rms: f64) -> f64 {
    let task = problem.task();
    (rms * task.size()).powi(2) * task.weights().iter().sum::<f64>()
}

/// Returns the most evaluations that a fit from a start is worth: few if it was led back, for then it ends at a change
/// point or a toggle, and creeps along it. If one branch is required and no type, only a start that was led back, or is
/// near an end that was, aims at a type; on a path only such a fit holds its points on one branch.
fn worth_spending(problem: &Problem, start: &Start, effort: Effort) -> u64 {
    let aims = !problem.branch_any() && start.setting.aim.is_some() && !problem.aims_at_types();
    let holds = effort.on_branch && problem.task().body().is_none();
    if aims || holds { LED_BACK_MOST } else { u64::MAX }
}

/// Returns whether the points of a start lie on circuits or branches that the problem does not allow together, or its
/// crank rocks although it has to turn fully.
pub(super) fn strayed(problem: &Problem, start: &Start) -> bool {
    if problem.circuit_any() && problem.branch_any() {
        return false;
    }
    let Some(shape) = problem.space(start.setting.side).shape(&start.design) else { return false };
    let turns = || linkage_type(shape.links()).is_some_and(LinkageType::input_turns_fully);
    if problem.has_to_turn_on() && !problem.aims_at_types() && !turns() {
        return true;
    }
    let Some(first) = start.positions.first() else { return false };
    let Ok(linkage) = shape.linkage(assembly_of(&shape, first[0], first[1])) else { return false };
    let mobility = linkage.mobility();
    let branch =
        |[e, u]: &[crate::mechanism::Complex; 2]| mobility.branch(e.arg(), assembly_of(&shape, *e, *u));
    let home = branch(first);
    let allowed = |other: Branch| {
        (problem.circuit_any() || other.circuit == home.circuit) && (problem.branch_any() || other == home)
    };
    !start.positions.iter().map(branch).all(allowed)
}

impl Spender<'_> {
    /// Fits from a start with as many evaluations as it is worth, and on from there if its end is nearly exact or as good as
    /// the best error known.
    pub(super) fn fit_its_worth(
        &mut self,
        problem: &Problem,
        start: Start,
        effort: Effort,
    ) -> Option<(f64, Start)> {
        let most = worth_spending(problem, &start, effort);
        let (merit, end) = self.fit(problem, start, effort, most)?;
        if most < u64::MAX && merit <= cost_of(problem, NEARLY_EXACT).max(GOES_ON * self.best) {
            return self.fit(problem, end.clone(), effort, u64::MAX).or(Some((merit, end)));
        }
        Some((merit, end))
    }

    /// As `fit`; if the points end on circuits or branches that the problem does not allow together, also fits from
    /// there to the nearest ends that it allows.
    pub(super) fn fit_as_required(
        &mut self,
        problem: &Problem,
        start: Start,
        effort: Effort,
    ) -> Option<(f64, Start)> {
        let (merit, end) = self.fit_its_worth(problem, start, effort)?;
        if !strayed(problem, &end) {
            return Some((merit, end));
        }
        let mut back = led_back(problem, &end);
        if back.len() > 1 {
            // The more promising one first.
            let mut tried: Vec<(f64, Start)> = Vec::with_capacity(back.len());
            for start in back {
                tried.extend(self.fit_its_worth(problem, start, SHORT_FIT.on_branch()));
            }
            tried.retain(|(again, _)| *again <= WORTH_LEADING_BACK * merit);
            by_merit(&mut tried, usize::MAX);
            back = tried.into_iter().map(|(_, start)| start).collect();
        }
        for start in back {
            let again = self.fit_its_worth(problem, start, effort.on_branch());
            let again = again.filter(|(_, end)| !strayed(problem, end));
            if again.is_some() {
                return again;
            }
        }
        // If that fails: the end that the referee will refuse.
        Some((merit, end))
    }
}

/// Returns starts near a strayed one that aim at types whose points cannot stray, and of a motion those on one branch,
/// driven from either side, which a fit can hold there; empty if the problem allows no such type.
pub(super) fn led_back(problem: &Problem, end: &Start) -> Vec<Start> {
    let types = problem.types();
    let allowed = |kind: &LinkageType| match end.setting.aim {
        Some(aim) => aim == *kind,
        None => types.is_empty() || types.contains(kind),
    };
    if problem.branch_any() {
        let kind =
            Some(LinkageType::TripleRocker).filter(allowed).filter(|kind| Some(*kind) != end.setting.aim);
        return kind.map(|kind| aimed_at(end, kind)).into_iter().collect();
    }
    let Some(start) = on_one_branch(problem, end) else { return Vec::new() };
    let mut back: Vec<Start> =
        ONE_BRANCH.into_iter().filter(allowed).map(|kind| aimed_at(&start, kind)).collect();
    if problem.task().body().is_some() && problem.types().is_empty() && !problem.is_function() {
        let other = swapped(problem, end).and_then(|drive| on_one_branch(problem, &drive));
        back.push(start);
        back.extend(other);
    }
    back
}

fn aimed_at(start: &Start, kind: LinkageType) -> Start {
    let mut start = start.clone();
    start.setting.aim = Some(kind);
    start
}

/// Returns the start with all points in the assembly that most of them have. The others are mirrored
/// ([`mirrored`]); on a path they may join the point before or after them instead, if that lies nearer to their targets.
fn on_one_branch(problem: &Problem, end: &Start) -> Option<Start> {
    let shape = problem.space(end.setting.side).shape(&end.design)?;
    let assemblies: Vec<AssemblyMode> =
        end.positions.iter().map(|[e, u]| assembly_of(&shape, *e, *u)).collect();
    let n = assemblies.len();
    let plus = assemblies.iter().filter(|t| **t == AssemblyMode::Plus).count();
    let most = if 2 * plus >= n { AssemblyMode::Plus } else { AssemblyMode::Minus };
    let task = problem.task();
    let miss = |j: usize, [e, u]: [Complex; 2]| {
        (task.points()[j] - (shape.crank_pivot + e * shape.crank + u * shape.offset)).norm_sqr()
    };
    let mut start = end.clone();
    for j in (0..n).filter(|j| assemblies[*j] != most) {
        let at_home = |i: &usize| assemblies[*i] == most;
        let neighbours = [(0..j).rev().find(at_home), (j + 1..n).find(at_home)].into_iter().flatten();
        let places = neighbours.filter(|_| task.body().is_none()).map(|i| end.positions[i]);
        start.positions[j] = places.fold(mirrored(&shape, end.positions[j]), |best, place| {
            if miss(j, place) < miss(j, best) { place } else { best }
        });
    }
    Some(start)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synthesis::{Budget, Context, fixture};
    use std::f64::consts::TAU;
    use std::sync::atomic::AtomicBool;

    /// Returns points all around the curve of a linkage, and a start there in the given assemblies.
    fn start(links: [f64; 4], require: &str, assemblies: impl Fn(usize) -> AssemblyMode) -> (Problem, Start) {
        let linkage = fixture::linkage(links);
        let (mut points, mut positions) = (Vec::new(), Vec::new());
        for j in 0..24 {
            // If the crank rocks, on an arc that it reaches.
            let turns = linkage.linkage_type().is_some_and(LinkageType::input_turns_fully);
            let angle = if turns { TAU * j as f64 / 24.0 } else { 0.6 + 0.02 * j as f64 };
            let joints = linkage.position_with(angle, assemblies(j)).joints().expect("it closes");
            points.push([joints.coupler_point.re, joints.coupler_point.im]);
            let coupler = (joints.follower_pin - joints.crank_pin) / linkage.coupler();
            positions.push([Complex::from_polar(1.0, angle), coupler]);
        }
        let problem = fixture::problem(&points, false, require);
        let start = fixture::start(&problem, &linkage, positions);
        (problem, start)
    }

    fn mostly_plus(j: usize) -> AssemblyMode {
        if j % 5 == 1 { AssemblyMode::Minus } else { AssemblyMode::Plus }
    }

    const CRANK_ROCKER: [f64; 4] = [4.0, 1.5, 3.5, 3.2];
    const TRIPLE_ROCKER: [f64; 4] = [3.0, 2.0, 2.1, 2.4];

    #[test]
    fn what_the_problem_allows_has_not_strayed() {
        let plus = |_| AssemblyMode::Plus;
        for (links, require, mixed, wanted) in [
            (CRANK_ROCKER, "", false, false),
            (CRANK_ROCKER, "", true, true),
            (CRANK_ROCKER, "branch = \"any\"", true, true),
            (CRANK_ROCKER, "branch = \"any\"\ncircuit = \"any\"", true, false),
            (TRIPLE_ROCKER, "", false, false),
            (TRIPLE_ROCKER, "", true, true),
            (TRIPLE_ROCKER, "branch = \"any\"", true, false),
        ] {
            let (problem, start) =
                if mixed { start(links, require, mostly_plus) } else { start(links, require, plus) };
            assert_eq!(strayed(&problem, &start), wanted, "{links:?} {require} {mixed}");
        }
    }

    #[test]
    fn the_way_back_keeps_the_loop_closed_in_one_assembly() {
        let (problem, start) = start(CRANK_ROCKER, "", mostly_plus);
        let back = led_back(&problem, &start);
        let aims: Vec<_> = back.iter().map(|start| start.setting.aim).collect();
        assert_eq!(aims, ONE_BRANCH.map(Some));
        let shape = problem.space(start.setting.side).shape(&start.design).expect("a shape");
        for start in back {
            assert!(!strayed(&problem, &start));
            for [e, u] in &start.positions {
                let d = shape.crank_pivot + *e * shape.crank + *u * shape.coupler;
                assert!(((d - shape.follower_pivot).norm() - shape.follower).abs() < 1e-12);
                assert!((u.norm() - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_point_on_the_way_back_joins_its_neighbour_where_that_lies_nearer_to_its_target() {
        let plus = |_| AssemblyMode::Plus;
        let (problem, mut start) = start(CRANK_ROCKER, "", plus);
        let shape = problem.space(start.setting.side).shape(&start.design).expect("a shape");
        let all_at_home = start.positions.clone();
        start.positions[7] = mirrored(&shape, all_at_home[9]);
        let back = on_one_branch(&problem, &start).expect("a start");
        // At its own target neither neighbour is as far away as the place at the crank angle of point 9.
        let neighbours = [all_at_home[6], all_at_home[8]];
        assert!(neighbours.contains(&back.positions[7]), "{:?} of {neighbours:?}", back.positions[7]);
        start.positions[7] = mirrored(&shape, all_at_home[7]);
        let back = on_one_branch(&problem, &start).expect("a start");
        assert!(
            (back.positions[7][1] - all_at_home[7][1]).norm() < 1e-12,
            "the mirrored place is its target"
        );
    }

    #[test]
    fn a_fit_on_one_branch_lets_no_point_leave_it() {
        // Drawn by both circuits of a double-crank that is almost a change point: no linkage draws it on one of them.
        let double_crank = [3.0, 3.05, 3.02, 3.04];
        let (problem, start) = start(double_crank, "", |j| {
            if (9..14).contains(&j) { AssemblyMode::Minus } else { AssemblyMode::Plus }
        });
        let cancel = AtomicBool::new(false);
        let budget = Budget::new(&cancel, None);
        let context = Context::new(&problem, &budget);
        let start = on_one_branch(&problem, &start).expect("a start");
        let mut spender = Spender::new(context, 5000);
        let (_, end) = spender.fit(&problem, start, SHORT_FIT.on_branch(), u64::MAX).expect("an end");
        let shape = problem.space(end.setting.side).shape(&end.design).expect("a shape");
        let plus = |[e, u]: &[Complex; 2]| assembly_of(&shape, *e, *u) == AssemblyMode::Plus;
        assert!(end.positions.iter().all(plus));
    }

    #[test]
    fn the_way_back_aims_at_nothing_that_is_not_allowed() {
        let (problem, strayed_start) = start(CRANK_ROCKER, "type = [\"double-crank\"]", mostly_plus);
        let aims: Vec<_> = led_back(&problem, &strayed_start).iter().map(|start| start.setting.aim).collect();
        assert_eq!(aims, [Some(LinkageType::DoubleCrank)]);
        let (problem, strayed_start) =
            start(CRANK_ROCKER, "branch = \"any\"\ntype = [\"double-crank\"]", mostly_plus);
        assert!(led_back(&problem, &strayed_start).is_empty());
        let (problem, mut strayed_start) = start(CRANK_ROCKER, "branch = \"any\"", mostly_plus);
        strayed_start.setting.aim = Some(LinkageType::TripleRocker);
        assert!(led_back(&problem, &strayed_start).is_empty(), "it has been tried");
    }
}
