//! Verification of the picks: each has an error that is allowed, and is no worse in its wish than the candidates.
//!
//! Whether a search could have found a smaller or better transmitting linkage is not seen.

use super::{Comparison, RELATIVE};
use crate::judge::figures::extent;
use crate::judge::rank::exact_objective;
use crate::record::{Candidate, Pick, Record};
use crate::task::Problem;
use crate::task::spec::Objective;

/// The relative difference in extent, and the difference in degrees, below which a pick is no worse than a candidate: a
/// pick is fitted once more at its own extent or angle, for the least error there.
const SAME_EXTENT: f64 = 1e-6;
const SAME_DEG: f64 = 1e-4;

impl Comparison<'_> {
    /// Checks the picks of a record, if there are any.
    pub(super) fn picks(&mut self, record: &Record) {
        let Some(picks) = &record.picks else { return };
        let problem = self.problem;
        let mut own = self.under("picks.");
        let Some(closest) = record.candidates.first().filter(|closest| closest.accepted) else {
            return own.differ("within", "there", "not called for: no candidate is accepted");
        };
        let most = greatest_objective(problem, closest);
        let within = most.map(|most| as_error(problem, most));
        match (picks.within, within) {
            (Some(recorded), Some(found)) => {
                own.number("within", recorded, found, problem.task().error_size())
            }
            (recorded, found) => {
                let word = |there: bool| if there { "there" } else { "absent" };
                own.same("within", word(recorded.is_some()), word(found.is_some()));
            }
        }
        let most = most.unwrap_or(f64::INFINITY);
        let n = problem.task().len();
        let near = |c: &&Candidate| {
            c.accepted && c.error.objective <= most && c.crank_deg.len() == n && c.t1_at.len() == n
        };
        let near: Vec<&Candidate> = record.candidates.iter().filter(near).collect();
        for (name, which) in [("smallest: ", Pick::Smallest), ("best_transmission: ", Pick::BestTransmission)]
        {
            if let Some(pick) = record.pick(which) {
                let mut own = own.under(name);
                own.rank_beside(record, pick);
                if own.pick(pick, most) {
                    own.is_best(pick, which, &near);
                }
            }
        }
    }

    /// Checks every figure of a pick, that it is accepted, and that its error is allowed; returns whether it could be
    /// judged.
    fn pick(&mut self, pick: &Candidate, most: f64) -> bool {
        self.same("accepted", pick.accepted, true);
        if !self.candidate(pick) {
            return false;
        }
        self.annotations(pick);
        if pick.error.objective > most * (1.0 + RELATIVE) {
            let found = format!("more than is allowed, {most:e}");
            self.differ("error.objective", format!("{:e}", pick.error.objective), found);
        }
        true
    }

    /// Checks that no candidate with an allowed error is smaller, or transmits better.
    fn is_best(&mut self, pick: &Candidate, which: Pick, near: &[&Candidate]) {
        let problem = self.problem;
        let own = extent(problem, pick);
        for other in near {
            let (what, beaten) = match which {
                Pick::Smallest => ("extent", extent(problem, other) < own * (1.0 - SAME_EXTENT)),
                _ => {
                    let better = other.transmission_deg.worst - pick.transmission_deg.worst;
                    ("transmission_deg.worst", better > SAME_DEG)
                }
            };
            if beaten {
                let found = format!("worse than that of candidate {}", other.rank);
                self.differ(what, "the best of those with an allowed error", found);
            }
        }
    }
}

/// Returns the greatest objective of a pick; `None` if the tolerances of the problem are the limit.
fn greatest_objective(problem: &Problem, closest: &Candidate) -> Option<f64> {
    let solve = &problem.spec().solve;
    let (within, least) = (solve.picks_within, closest.error.objective.max(exact_objective(problem)));
    (!problem.task().has_tolerances()).then_some(match solve.objective {
        Objective::SumOfSquares => within * within * least,
        Objective::MaxDeviation => within * least,
    })
}

/// Returns an objective as an rms error, or as the largest deviation if that is the objective.
fn as_error(problem: &Problem, objective: f64) -> f64 {
    match problem.spec().solve.objective {
        Objective::SumOfSquares => (objective / problem.task().weights().iter().sum::<f64>()).sqrt(),
        Objective::MaxDeviation => objective,
    }
}
