//! Comparison of recorded values with recomputed ones.

use super::{Mismatch, verdict};
use crate::judge::assess::assess_on_curve;
use crate::mechanism::{AssemblyMode, CrankLinkage};
use crate::record::Candidate;
use crate::task::Problem;
use crate::task::ranges::Reference;
use std::fmt::{Debug, Display};

/// The relative part of the tolerance of figures ..
pub const RELATIVE: f64 = 1e-9;
/// .. and its absolute part, as a share of the target's size (for sums of squares, of its square).
pub const ABSOLUTE: f64 = 1e-12;

/// A part of a record that is compared with the same part recomputed: it collects the mismatches.
pub(super) struct Comparison<'a> {
    /// The problem of the record.
    pub problem: &'a Problem,
    /// The rank of the candidate; `None` for the record as a whole.
    rank: Option<usize>,
    /// The beginning of the names of the part's figures.
    prefix: String,
    mismatches: &'a mut Vec<Mismatch>,
}

impl<'a> Comparison<'a> {
    /// Begins the comparison of a record as a whole.
    pub fn new(problem: &'a Problem, mismatches: &'a mut Vec<Mismatch>) -> Self {
        Comparison { problem, rank: None, prefix: String::new(), mismatches }
    }

    /// Returns the comparison of a candidate, which collects into the same list.
    pub fn of_candidate(&mut self, rank: usize) -> Comparison<'_> {
        Comparison { rank: Some(rank), ..Comparison::new(self.problem, self.mismatches) }
    }

    /// Returns the comparison of a part of this part: the names of its figures begin with `prefix`.
    pub fn under(&mut self, prefix: &str) -> Comparison<'_> {
        let prefix = format!("{}{prefix}", self.prefix);
        Comparison { rank: self.rank, prefix, ..Comparison::new(self.problem, self.mismatches) }
    }

    /// Records a mismatch.
    pub fn differ(&mut self, what: &str, recorded: impl Display, found: impl Display) {
        self.mismatches.push(Mismatch {
            rank: self.rank,
            what: format!("{}{what}", self.prefix),
            recorded: recorded.to_string(),
            found: found.to_string(),
        });
    }

    /// Compares two values exactly.
    pub fn same<T: Display + PartialEq<U>, U: Display>(&mut self, what: &str, recorded: T, found: U) {
        if recorded != found {
            self.differ(what, recorded, found);
        }
    }

    /// Compares two values by their representation for programmers.
    pub fn alike<T: Debug>(&mut self, what: &str, recorded: &T, found: &T) {
        self.same(what, format!("{recorded:?}"), format!("{found:?}"));
    }

    /// Compares two numbers, whose rounding is [`RELATIVE`] of the number and [`ABSOLUTE`] of `scale`.
    pub fn number(&mut self, what: &str, recorded: f64, found: f64, scale: f64) {
        let near = (recorded - found).abs() <= RELATIVE * found.abs() + ABSOLUTE * scale;
        if !(near || recorded == found) {
            self.differ(what, format!("{recorded:e}"), format!("{found:e}"));
        }
    }

    /// Compares two transmission angles, in degrees: near 0 and 180 such an angle moves as the root of the lengths'
    /// rounding.
    pub fn transmission(&mut self, what: &str, recorded: f64, found: f64) {
        let from_flat = found.min(180.0 - found).max(1e-5).to_radians().sin();
        self.number(what, recorded, found, 180.0 / from_flat);
    }

    /// Compares two sums of squared errors of `n` points: a sum of squares of errors near e changes by 2 e times the
    /// change of e.
    pub fn sum_sq(&mut self, what: &str, recorded: f64, found: f64, n: usize) {
        let size = self.problem.task().size();
        let scale = size * size * ABSOLUTE + 2.0 * size * found.sqrt() * (n as f64).sqrt();
        self.number(what, recorded, found, scale);
    }

    /// Checks that a linkage is recorded as it is assembled at the first point.
    pub fn assembly(&mut self, linkage: &CrankLinkage, t1_at: &[AssemblyMode]) {
        let sign = |t: AssemblyMode| format!("{:+}", t.sign());
        if let Some(&first) = t1_at.first() {
            self.same("linkage.t1", sign(linkage.assembly()), sign(first));
        }
    }

    /// Compares the requirements that are recorded as not met, and the acceptance. If a verdict depends on rounding, the
    /// recorded one counts.
    pub fn verdict(&mut self, found: &Candidate, accepted: bool, not_met: &[String]) {
        let said = |name: &str| not_met.iter().any(|not_met| not_met == name);
        let (found_not_met, found_accepted) = verdict::verdict(self.problem, found, &said);
        self.same("accepted", accepted, found_accepted);
        if not_met != found_not_met {
            self.differ("not_met", not_met.join(", "), found_not_met.join(", "));
        }
    }

    /// Judges a recorded linkage anew; `None`, with a mismatch, if the counts are not those of the points or the linkage
    /// does not close at every point, which `open` says.
    pub fn judged(
        &mut self,
        (linkage, crank_deg, t1_at): (&CrankLinkage, &[f64], &[AssemblyMode]),
        own: Option<Reference>,
        open: &str,
    ) -> Option<Candidate> {
        let n = self.problem.task().len();
        if crank_deg.len() != n || t1_at.len() != n {
            let has = format!("{} and {}", crank_deg.len(), t1_at.len());
            self.differ("the number of crank_deg and t1_at", has, format!("{n} points"));
            return None;
        }
        let found = assess_on_curve(self.problem, linkage, (crank_deg, t1_at), own, None);
        if found.is_none() {
            self.differ("the linkage", "closed at every point", open);
        }
        found
    }
}
