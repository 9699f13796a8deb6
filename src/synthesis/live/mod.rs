//! Live fitting to a target that the user moves: known candidates follow it by warm starts, and the answers of a search
//! join them.
//!
//! A [`Session`] keeps a few candidates. After every move of the target each of them starts a short fit of its own (a
//! warm start: design, assemblies and the position at each point), is judged by the same
//! [referee](crate::judge::referee) as every other answer, and is ranked by the same rules. Nothing here reads a clock,
//! so the same moves give the same candidates.

pub mod nine;

use crate::judge::assess::assess;
use crate::judge::loosen::judged_under;
use crate::judge::rank::{compare, distinct, distinct_places};
use crate::judge::warm::start_at;
use crate::mechanism::CrankLinkage;
use crate::record::{Assemblies, Candidate};
use crate::synthesis::constants::live::{
    EFFORT, EVALUATIONS, FIRST_LOOK, FIRST_LOOKS_OF_SEVERAL_LOOPS, FOLLOWING,
};
use crate::synthesis::multistart::{judged, polish};
use crate::synthesis::nearest::nearest_positions;
use crate::synthesis::{Budget, Context, plan, several_loops, sliders};
use crate::task::{Problem, Timing};

/// The candidates that follow a target. Each has a number of its own, which it keeps while it follows.
#[derive(Clone, Debug, Default)]
pub struct Session {
    kept: Vec<Candidate>,
    /// The number of each.
    numbers: Vec<u64>,
    /// Numbers given so far.
    given: u64,
    held: Option<u64>,
}

impl Session {
    /// Returns the candidates, better first, ranked from 1.
    pub fn candidates(&self) -> &[Candidate] {
        &self.kept
    }

    /// Returns the number of each candidate.
    pub fn numbers(&self) -> &[u64] {
        &self.numbers
    }

    /// Removes all candidates: for a target that is unrelated to the one before.
    pub fn clear(&mut self) {
        self.kept.clear();
        self.numbers.clear();
    }

    /// Holds the candidate with this number: it stays among the candidates however good the others are, as long as it
    /// can follow. `None`: none is held.
    pub fn hold(&mut self, number: Option<u64>) {
        self.held = number;
    }

    /// Begins anew with a linkage, each point met where it comes nearest, and holds it. Without effect if it cannot be
    /// assembled.
    pub fn begin(&mut self, problem: &Problem, linkage: &CrankLinkage) {
        let positions = nearest_positions(problem, linkage);
        let judged = positions.and_then(|(crank_deg, t1_at)| assess(problem, linkage, &crank_deg, &t1_at));
        if let Some(candidate) = judged {
            self.given += 1;
            self.held = Some(self.given);
            self.keep(vec![(self.given, candidate)]);
        }
    }

    /// Fits the candidates again, each from its present parameters, to a problem whose target or limits have moved.
    ///
    /// A candidate with another number of positions than there are points is placed anew on its own curve. One that
    /// cannot follow (its loop opens at a point), or is of a kind that is not searched for, is left out. The candidates are
    /// ranked anew, better first.
    pub fn follow(&mut self, problem: &Problem, budget: &Budget<'_>) -> &[Candidate] {
        let kept = self.take_all();
        let follow = |(number, candidate): &(u64, Candidate)| {
            followed(problem, candidate, budget).map(|candidate| (*number, candidate))
        };
        let mut all: Vec<(u64, Candidate)> = kept.iter().filter_map(follow).collect();
        all.sort_by(|(_, one), (_, other)| compare(problem, one, other));
        self.keep(all)
    }

    /// Adds the candidates of a search and keeps the best distinct ones of all, at most [`FOLLOWING`], and behind them
    /// the one that is held.
    ///
    /// If one is accepted, only accepted ones stay, and the one that is held.
    pub fn join(&mut self, problem: &Problem, found: Vec<Candidate>) -> &[Candidate] {
        let mut all: Vec<(u64, Candidate)> = Vec::with_capacity(found.len() + self.kept.len());
        for candidate in found {
            self.given += 1;
            all.push((self.given, candidate));
        }
        all.append(&mut self.take_all());
        let (numbers, candidates): (Vec<u64>, Vec<Candidate>) = all.into_iter().unzip();
        let mut places = distinct_places(problem, &candidates, FOLLOWING);
        let held = numbers.iter().position(|number| Some(*number) == self.held);
        places.extend(held.filter(|held| !places.contains(held)));
        self.keep(places.into_iter().map(|place| (numbers[place], candidates[place].clone())).collect())
    }

    fn take_all(&mut self) -> Vec<(u64, Candidate)> {
        std::mem::take(&mut self.numbers).into_iter().zip(std::mem::take(&mut self.kept)).collect()
    }

    fn keep(&mut self, all: Vec<(u64, Candidate)>) -> &[Candidate] {
        (self.numbers, self.kept) = all.into_iter().unzip();
        for (rank, candidate) in (1..).zip(&mut self.kept) {
            candidate.rank = rank;
        }
        &self.kept
    }
}

/// Runs a quick search of a problem: the search that every run begins with, with a small budget and without tolerances,
/// whose polish takes long. Its answers are judged by the whole problem. Empty for a problem that cannot be searched.
pub fn first_look(problem: &Problem, budget: &Budget<'_>) -> Vec<Candidate> {
    let several = problem.spec().design.searches_several_loops();
    look(problem, budget, if several { FIRST_LOOKS_OF_SEVERAL_LOOPS[0] } else { FIRST_LOOK })
}

/// Runs a second look for six-bars and eight-bars, whose whole search takes seconds; empty for a problem without them.
pub fn second_look(problem: &Problem, budget: &Budget<'_>) -> Vec<Candidate> {
    match problem.spec().design.searches_several_loops() {
        true => look(problem, budget, FIRST_LOOKS_OF_SEVERAL_LOOPS[1]),
        false => Vec::new(),
    }
}

/// Runs a search of at most so many evaluations.
fn look(problem: &Problem, budget: &Budget<'_>, evaluations: u64) -> Vec<Candidate> {
    let mut spec = problem.spec().clone();
    spec.solve.evaluations = spec.solve.evaluations.min(evaluations);
    spec.task.tolerance = None;
    let Ok(easier) = Problem::new(spec) else { return Vec::new() };
    let Ok(outcome) = plan::search(Context::new(&easier, budget)) else { return Vec::new() };
    let found = outcome.candidates.iter().filter_map(|c| judged_under(problem, c)).collect();
    distinct(problem, found, FOLLOWING)
}

/// Returns a candidate adapted to a problem: placed, fitted, judged.
fn followed(problem: &Problem, candidate: &Candidate, budget: &Budget<'_>) -> Option<Candidate> {
    if !problem.spec().design.searches(candidate.linkage.kind()) {
        return None;
    }
    let (placed, context) = (placed(problem, candidate)?, Context::new(problem, budget));
    let (fitted, unfitted) = if placed.linkage.four_bar().is_some() {
        let fit = polish(context, start_at(problem, &placed)?, EFFORT, EVALUATIONS);
        let fitted = fit.end.and_then(|end| judged(problem, &end));
        (fitted, judged(problem, &start_at(problem, &placed)?))
    } else if placed.linkage.multi_loop().is_some() {
        // Angles of another timing are none of this problem.
        let again = match problem.task().timing() {
            Timing::Free => assess(problem, placed.linkage, &placed.crank_deg, &placed.t1_at),
            Timing::Prescribed { .. } => nearest_positions(problem, placed.linkage)
                .and_then(|(crank_deg, t1_at)| assess(problem, placed.linkage, &crank_deg, &t1_at)),
        };
        (several_loops::refitted(context, &placed, EVALUATIONS).0, again)
    } else {
        let (fitted, _) = sliders::refit(context, &placed, (EFFORT, EVALUATIONS, 0.0));
        (fitted, sliders::unfitted(context, &placed))
    };
    // A fit that was cut short may have given up an acceptable linkage for a nearer one that is not.
    [fitted, unfitted].into_iter().flatten().min_by(|one, other| compare(problem, one, other))
}

/// Returns a candidate with a position for each point of the problem.
fn placed(problem: &Problem, candidate: &Candidate) -> Option<Candidate> {
    if candidate.crank_deg.len() == problem.task().len() {
        return Some(candidate.clone());
    }
    let (crank_deg, t1_at) = nearest_positions(problem, candidate.linkage)?;
    let t1_at = Assemblies::of(&candidate.linkage, t1_at);
    Some(Candidate { crank_deg, t1_at, ..candidate.clone() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::app::job::run::{Context, Job, run};
    use crate::files::problem_file::parse;
    use crate::mechanism::LinkageKind;
    use crate::task::AngleOffset;
    use crate::task::spec::TimingSpec;
    use std::sync::atomic::AtomicBool;

    /// Returns an egg of `n` points whose point `moved` lies `by` off.
    fn egg(n: usize, moved: usize, by: f64) -> Problem {
        let points: Vec<[f64; 2]> = (0..n)
            .map(|i| {
                let angle = std::f64::consts::TAU * i as f64 / n as f64;
                let off = if i == moved { by } else { 0.0 };
                [3.0 * angle.cos() + off, 2.0 * angle.sin() + 0.3 * (2.0 * angle).cos()]
            })
            .collect();
        let text =
            format!("format = 1\n[task.path]\npoints = {points:?}\nclosed = true\n[solve]\nseed = 3\n");
        Problem::new(parse("egg", &text, None, &[]).expect("a problem").spec).expect("a task")
    }

    fn searched(problem: &Problem) -> Vec<Candidate> {
        let mut spec = problem.spec().clone();
        (spec.solve.evaluations, spec.solve.advice) = (30_000, false);
        let job = Job { name: "egg".into(), source: None, unit: None, spec, front: None };
        let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
        run(&job, &context).expect("it runs").record.candidates
    }

    #[test]
    fn a_moved_point_is_followed_to_what_a_fit_of_its_own_would_find() {
        let cancel = AtomicBool::new(false);
        let budget = Budget::new(&cancel, None);
        let before = egg(24, 0, 0.0);
        let mut session = Session::default();
        session.join(&before, searched(&before));
        let stale = session.candidates()[0].clone();
        for step in 1..=10 {
            let by = 0.05 * f64::from(step);
            let moved = egg(24, 4, by);
            let first = session.follow(&moved, &budget)[0].clone();
            assert_eq!(first.rank, 1);
            // Judged by the referee of the moved problem, and no worse than the linkage that stayed behind.
            let again = crate::judge::assess::assess(&moved, first.linkage, &first.crank_deg, &first.t1_at);
            assert_eq!(again.expect("closed").error.sum_sq, first.error.sum_sq);
            let behind = judged(&moved, &start_at(&moved, &stale).expect("a start")).expect("closed");
            assert!(first.error.sum_sq <= behind.error.sum_sq, "{by}");
        }
        let moved = egg(24, 4, 0.5);
        let afresh = searched(&moved);
        let followed = session.candidates()[0].error.sum_sq;
        assert!(followed <= 1.5 * afresh[0].error.sum_sq, "{followed} beside {}", afresh[0].error.sum_sq);
    }

    #[test]
    fn sliders_follow_and_go_where_they_are_not_searched_for() {
        let cancel = AtomicBool::new(false);
        let budget = Budget::new(&cancel, None);
        let of_kind = |problem: &Problem, kind: &[LinkageKind]| {
            let mut spec = problem.spec().clone();
            spec.design.mechanism = kind.to_vec();
            Problem::new(spec).expect("a task")
        };
        for kind in [LinkageKind::SliderCrank, LinkageKind::InvertedSliderCrank] {
            let before = of_kind(&egg(24, 0, 0.0), &[kind]);
            let mut session = Session::default();
            session.join(&before, searched(&before));
            for step in 1..=5 {
                let moved = of_kind(&egg(24, 4, 0.05 * f64::from(step)), &[kind]);
                let first = session.follow(&moved, &budget)[0].clone();
                assert_eq!(first.linkage.kind(), kind);
                let again = assess(&moved, first.linkage, &first.crank_deg, &first.t1_at).expect("closed");
                assert_eq!(again.error.sum_sq, first.error.sum_sq);
            }
            let moved = of_kind(&egg(24, 4, 0.25), &[kind]);
            let afresh = searched(&moved)[0].error.sum_sq;
            let followed = session.candidates()[0].error.sum_sq;
            assert!(followed <= 1.5 * afresh, "{kind}: {followed} beside {afresh}");
            // Under a timing it stands at the crank angles that are prescribed.
            let mut timed = of_kind(&egg(24, 4, 0.25), &[kind]).spec().clone();
            let crank_deg: Vec<f64> = (0..24).map(|i| 15.0 * f64::from(i)).collect();
            timed.task.timing = Some(TimingSpec { crank_deg, offset: AngleOffset::Fixed, free: Vec::new() });
            let timed = Problem::new(timed).expect("a task");
            let mut beside = session.clone();
            for candidate in beside.follow(&timed, &budget) {
                let steps = candidate.crank_deg.windows(2).map(|two| (two[1] - two[0]).abs());
                assert!(
                    steps.clone().all(|step| (step - 15.0).abs() < 1e-9),
                    "{kind}: {:?}",
                    candidate.crank_deg
                );
            }
            // A point more is met where the linkage comes nearest to it.
            assert!(!session.follow(&of_kind(&egg(25, 4, 0.25), &[kind]), &budget).is_empty());
            assert!(session.follow(&egg(24, 4, 0.25), &budget).is_empty());
        }
    }

    #[test]
    fn one_that_is_held_stays_under_its_number_whatever_is_found() {
        let cancel = AtomicBool::new(false);
        let budget = Budget::new(&cancel, None);
        let before = egg(24, 0, 0.0);
        let found = searched(&before);
        let last = found.last().expect("several").clone();
        let mut session = Session::default();
        session.join(&before, vec![last]);
        let number = session.numbers()[0];
        let moved = egg(24, 4, 0.1);
        session.follow(&moved, &budget);
        assert_eq!(session.numbers(), [number]);
        session.hold(Some(number));
        session.join(&moved, searched(&moved));
        assert!(session.candidates().len() > 1 && session.numbers().contains(&number));
        session.follow(&egg(24, 4, 0.2), &budget);
        assert!(session.numbers().contains(&number));
        let ranks: Vec<usize> = session.candidates().iter().map(|c| c.rank).collect();
        assert_eq!(ranks, (1..=ranks.len()).collect::<Vec<_>>());
        // Let go, it has to be among the best.
        session.hold(None);
        let best = searched(&moved);
        session.join(&moved, best);
        assert!(session.candidates().len() <= FOLLOWING);
    }

    #[test]
    fn a_linkage_to_begin_with_is_fitted_from_where_it_is_and_stays() {
        let cancel = AtomicBool::new(false);
        let problem = egg(24, 0, 0.0);
        let found = searched(&problem);
        let linkage = found[0].linkage.scaled(1.01).expect("a linkage");
        let mut session = Session::default();
        session.begin(&problem, &linkage);
        let before = session.candidates()[0].error.sum_sq;
        let after = session.follow(&problem, &Budget::new(&cancel, None))[0].error.sum_sq;
        assert!(after < before, "{after} {before}");
        let number = session.numbers()[0];
        session.join(&problem, found);
        assert!(session.numbers().contains(&number));
    }

    #[test]
    fn a_first_look_finds_something_and_judges_it_by_the_whole_problem() {
        let cancel = AtomicBool::new(false);
        let mut spec = egg(24, 0, 0.0).spec().clone();
        spec.task.tolerance = Some(vec![1e-9; 24]);
        let problem = Problem::new(spec).expect("a task");
        let found = first_look(&problem, &Budget::new(&cancel, None));
        assert!(!found.is_empty() && found.iter().all(|c| !c.accepted));
        assert!(found[0].requirements.iter().any(|r| r.name == "tolerance" && !r.met));
        assert!(found[0].error.rms_over_size < 0.05);
        cancel.store(true, std::sync::atomic::Ordering::Relaxed);
        assert!(first_look(&problem, &Budget::new(&cancel, None)).len() <= found.len());
    }

    #[test]
    fn another_number_of_points_is_followed_too_and_the_same_moves_give_the_same_digits() {
        let cancel = AtomicBool::new(false);
        let budget = Budget::new(&cancel, None);
        let found = searched(&egg(24, 0, 0.0));
        let ends: Vec<String> = (0..2)
            .map(|_| {
                let mut session = Session::default();
                session.join(&egg(24, 0, 0.0), found.clone());
                session.follow(&egg(30, 2, 0.1), &budget);
                assert!(session.candidates().iter().all(|c| c.crank_deg.len() == 30));
                serde_json::to_string(session.candidates()).expect("JSON")
            })
            .collect();
        assert!(ends[0].len() > 100 && ends[0] == ends[1]);
        assert!(Session::default().follow(&egg(24, 0, 0.0), &budget).is_empty());
    }
}
