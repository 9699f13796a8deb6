//! Live exact synthesis for nine points, poses and points, or eight points of linkages with a slider, that the user moves: every real
//! linkage through them, followed from the solutions before by continuation.

use crate::judge::certified::target;
use crate::numbers::nine_point::{Completeness, Options, Solved, resolve_from, solve};
use crate::synthesis::continuation::{Exact, glanced};
use crate::task::Problem;
use std::sync::atomic::{AtomicBool, Ordering};

/// The solutions of nine points, kept to be followed when a point moves.
#[derive(Clone, Debug, Default)]
pub struct Nine {
    solved: Option<Solved>,
}

impl Nine {
    /// Returns all real linkages through the points of a problem, judged by its requirements, better first; from the
    /// solutions before if there are any ([`resolve_from`]), else from the start set ([`solve()`]). Nothing is
    /// certified, and no distance to a whole curve is computed ([`glanced`]): that is left to a run. `None` if the
    /// problem does not have as many points and poses as have finitely many linkages, or it was cancelled.
    pub fn follow(&mut self, problem: &Problem, cancel: &AtomicBool) -> Option<Exact> {
        let precise = target(problem)?;
        let target = precise.target;
        let options = Options::default();
        let solved = match self.solved.take() {
            // Only a requirement has changed, not a point.
            Some(before) if before.target == target => before,
            Some(before) if before.target.displacements.kind == target.displacements.kind => {
                resolve_from(&before, &target, &options, cancel).solved
            }
            _ => solve(&target, &options, &|_, _| {}, cancel),
        };
        if cancel.load(Ordering::Relaxed) || solved.cancelled {
            return None;
        }
        let exact = glanced(problem, &precise, &solved);
        // Points in special position lose classes: after that the start set is needed again.
        self.solved = (solved.completeness() == Completeness::Complete).then_some(solved);
        Some(exact)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::job::run::{Context, Job, run};
    use crate::files::problem_file::parse;
    use crate::judge::certified::same;
    use crate::record::Census;

    const NINE: &str = include_str!("../../../problems/exact/crank-rocker.toml");
    const EIGHT: &str = include_str!("../../../problems/sliders/slider-exact.toml");

    fn points(text: &str, moved: f64) -> Problem {
        let mut spec = parse("nine", text, None, &[]).expect("a problem").spec;
        spec.task.points[4][0] += moved;
        Problem::new(spec).expect("a task")
    }

    #[test]
    fn moved_points_have_the_linkages_that_a_run_of_their_own_finds() {
        follows(NINE, 1442, 0.01);
        follows(EIGHT, 279, 0.2);
    }

    fn follows(text: &str, classes: usize, by: f64) {
        let cancel = AtomicBool::new(false);
        let mut nine = Nine::default();
        let first = nine.follow(&points(text, 0.0), &cancel).expect("exact answers");
        assert!(first.record.census.classes == classes && first.record.linkages.len() > 3);
        let moved = nine.follow(&points(text, by), &cancel).expect("exact answers");
        let job = Job {
            name: "n".into(),
            source: None,
            unit: None,
            spec: points(text, by).spec().clone(),
            front: None,
        };
        let record = run(&job, &Context { cancel: &cancel, observer: &|_| {} }).expect("it runs").record;
        let afresh = record.exact.expect("exact answers");
        let counts = |c: &Census| (c.classes, c.real, c.one_circuit, c.in_order, c.free_of_defects);
        assert_eq!(counts(&moved.record.census), counts(&afresh.census));
        // Equals may come in another order, and of six equal mechanisms another may come first.
        for followed in &moved.record.linkages {
            let found = afresh.linkages.iter().find(|found| {
                let others = found.others.iter().map(|form| &form.linkage);
                std::iter::once(&found.linkage).chain(others).any(|form| same(form, &followed.linkage))
            });
            let found = found.expect("the run has it too");
            assert_eq!((followed.accepted, followed.in_order), (found.accepted, found.in_order));
            assert!(followed.certified.is_none() && found.certified.is_some());
        }
        // One point more is not accepted.
        let mut spec = points(text, 0.0).spec().clone();
        spec.task.points.push([9.0, 9.0]);
        assert!(nine.follow(&Problem::new(spec).expect("a task"), &cancel).is_none());
    }
}
