//! Conflict analysis: which requirements cannot be met together, and the least relaxation after which an answer is
//! acceptable.
//!
//! A demand *helps* if a search without it ends with something acceptable. Every set of demands that cannot be met
//! together (a conflict) contains all that help. A minimal conflict is found by deletion: each demand that can be left
//! out without ending the conflict is left out, one after the other. Before it is named, its demands alone are searched
//! with as many evaluations as several trials have: what that finds refutes it and counts in the trials before, and the
//! next claim is made with it. Demands of the conflict that did not help are tried again at that length.
//!
//! For each demand that helps the smallest loosening is looked for between its limits and the values attained without
//! it: steps inward, each taken if a fit from known candidates, or else a short search, ends acceptable there. The limits
//! are then rounded outward to few digits, and proposed only if the search itself, run with them as it would be when they
//! are typed, ends with an accepted candidate. If no single demand helps, pairs are tried.
//!
//! Every design that a trial finds is also judged by the problem itself, and the nearest ones are fitted under all of
//! its requirements. An acceptable one refutes the conflict: it becomes an answer, and nothing is explained.
//!
//! The results are findings, not proofs: a search that finds nothing does not prove that there is nothing to find.

use super::constants::conflicts::{
    ALLOWANCE, CONFIRMING, FIT_SHARE, LED_IN, LONGER, LONGER_TRIALS, PROPOSALS, SEARCHED_STEP, SHORTER,
    SHORTEST_STEP, STEPS, TRIAL, TRIAL_SHARE, WARM,
};
use super::multistart::{LONG_FIT, judged, polish};
use super::relaxed::led_in;
use super::{Context, Progress, SearchOutcome, offered_cognates, plan};
use crate::judge::error::rms;
use crate::judge::loosen::{Demand, changes, judged_under, rounded_outward};
use crate::judge::warm::start_at;
use crate::numbers::optimise::population::PopulationError;
use crate::record::{Candidate, Conflict, RELAXED, Relaxation};
use crate::task::Problem;
use crate::task::requirement::Limit;
use crate::task::spec::{Method, ProblemSpec};
use std::mem;

/// Distance from a bound, in parts of its scale, within which the bound is active.
const ACTIVE: f64 = 1e-6;
/// The distance counted for a change that has no measure (another type, any order): one of the whole.
const WHOLE: f64 = 1.0;

/// The conflict and the relaxations found.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Explained {
    /// Requirements that cannot be met together.
    pub conflict: Option<Conflict>,
    /// Changes that help, nearest first.
    pub relaxations: Vec<Relaxation>,
}

/// Explains a search that found nothing acceptable; returns nothing if it found something or the budget has stopped.
///
/// If a trial finds a design that is acceptable after all, there is nothing to explain, and if the method is `auto` the
/// outcome's candidates are chosen anew with it.
///
/// If the time limit or a cancellation ends it early there is no explanation, and that becomes the reason why the
/// search ended: the record cannot be repeated then.
///
/// # Errors
/// As [`plan::search`].
pub fn explain(context: Context<'_>, outcome: &mut SearchOutcome) -> Result<Explained, PopulationError> {
    let problem = context.problem;
    // All exact linkages are known, each with the requirements that it does not meet.
    let listed = problem.spec().solve.method == Method::Continuation;
    // A short search for six-bars says little about what they could do.
    let listed = listed || problem.spec().design.searches_several_loops();
    if listed || context.stopped() || outcome.candidates.iter().any(|c| c.accepted) {
        return Ok(Explained::default());
    }
    let trial = (problem.spec().solve.evaluations / TRIAL_SHARE).clamp(1, TRIAL);
    let (allowance, known) = (ALLOWANCE * trial, outcome.candidates.clone());
    let (met, tried) = (Vec::new(), Vec::new());
    let mut inquiry = Inquiry { context, problem, trial, spent: 0, allowance, known, met, tried };
    let explained = inquiry.explain()?;
    let Inquiry { met, .. } = inquiry;
    if let Some(reason) = context.stop_reason() {
        outcome.reason = reason;
    }
    if met.is_empty() && !context.stopped() {
        return Ok(explained);
    }
    // Where the problem asks for a method, only answers of that method are listed.
    if !met.is_empty() && problem.spec().solve.method == Method::Auto {
        outcome.choose_anew(context, Vec::new(), met);
        offered_cognates::offer(context, &mut outcome.candidates);
        // The repeated hits were counted for another best answer.
        outcome.repeats = None;
        if !outcome.used.iter().any(|used| used == RELAXED) {
            outcome.used.push(RELAXED.into());
        }
    }
    Ok(Explained::default())
}

struct Inquiry<'a> {
    context: Context<'a>,
    problem: &'a Problem,
    /// Evaluations of a trial.
    trial: u64,
    spent: u64,
    allowance: u64,
    /// The candidates of the search that is explained, and those that refuted a claim.
    known: Vec<Candidate>,
    /// Designs that are acceptable after all.
    met: Vec<Candidate>,
    /// Acceptable candidates found without these demands, for each set tried.
    tried: Vec<(Vec<Demand>, Vec<Candidate>)>,
}

impl Inquiry<'_> {
    fn exhausted(&self) -> bool {
        self.spent >= self.allowance || self.context.stopped() || !self.met.is_empty()
    }

    fn explain(&mut self) -> Result<Explained, PopulationError> {
        let demands = self.demands();
        let (mut helping, mut found) = (Vec::new(), Vec::new());
        let among = self.confirmed(&demands, &mut helping, &mut found)?;
        // A limit of the conflict that does not help by itself may only have been tried too briefly. The search that is
        // explained has looked for the least error already.
        let is_brief = |demand: &&Demand| !helping.contains(*demand) && **demand != Demand::TOLERANCE;
        let brief: Vec<Demand> = among.iter().filter(is_brief).take(LONGER_TRIALS).copied().collect();
        for demand in brief {
            if !self.exhausted() && self.search_longer(&[demand])? {
                helping.push(demand);
                found.extend(self.relaxation(&[demand])?);
            }
        }
        if helping.is_empty() {
            for (i, &one) in among.iter().enumerate() {
                for &other in demands.iter().filter(|other| !among[..=i].contains(other)) {
                    if found.len() < PROPOSALS && !self.exhausted() {
                        found.extend(self.relaxation(&[one, other])?);
                    }
                }
            }
        }
        // A stable sort: equally near ones in the order of the demands.
        found.sort_by(|one, other| one.0.total_cmp(&other.0));
        found.truncate(PROPOSALS);
        let spec = self.problem.spec();
        let among: Vec<String> = among.into_iter().map(|demand| demand.key_in(spec)).collect();
        Ok(Explained {
            conflict: (!among.is_empty()).then_some(Conflict { among }),
            relaxations: found.into_iter().map(|(_, relaxation)| relaxation).collect(),
        })
    }

    /// Returns a conflict that a longer search does not refute; none if as many are refuted as there are demands. What
    /// refutes one counts in the next. Adds the demands that help and the least loosening of each.
    fn confirmed(
        &mut self,
        demands: &[Demand],
        helping: &mut Vec<Demand>,
        found: &mut Vec<(f64, Relaxation)>,
    ) -> Result<Vec<Demand>, PopulationError> {
        for _ in demands {
            let before = helping.len();
            for &demand in demands {
                if !helping.contains(&demand) && !self.without(&[demand])?.is_empty() {
                    helping.push(demand);
                }
            }
            for &demand in &helping[before..] {
                found.extend(self.relaxation(&[demand])?);
            }
            let among = self.conflict(demands, helping)?;
            if among.is_empty() || !self.is_refuted(demands, &among)? {
                return Ok(among);
            }
        }
        Ok(Vec::new())
    }

    /// Returns the demands of the problem; of the design's bounds only those that are active at a refused candidate or
    /// exceeded by it, since an inactive bound does not restrict.
    fn demands(&self) -> Vec<Demand> {
        let spec = self.problem.spec();
        let is_active = |demand: &Demand, candidate: &Candidate| {
            let (Some(limits), Some(values)) = (demand.limits(spec), demand.attained(candidate)) else {
                return true;
            };
            let scale = scale(*demand, spec).max(ACTIVE * self.problem.task().size());
            limits.iter().zip(values).any(|(l, v)| l.outward * (v - l.value) >= -ACTIVE * scale)
        };
        let keep = |demand: &Demand| {
            !matches!(demand, Demand::Design(_))
                || self.known.is_empty()
                || self.known.iter().any(|candidate| is_active(demand, candidate))
        };
        Demand::of(self.problem).into_iter().filter(keep).collect()
    }

    /// Returns acceptable candidates of the problem without some demands.
    fn without(&mut self, demands: &[Demand]) -> Result<Vec<Candidate>, PopulationError> {
        if let Some((_, found)) = self.tried.iter().find(|(tried, _)| tried == demands) {
            return Ok(found.clone());
        }
        if self.exhausted() {
            return Ok(Vec::new());
        }
        let mut spec = self.dropped(demands);
        spec.solve.candidates = WARM;
        let mut found = self.acceptable_under(&spec, &self.known);
        // A tolerance does not guide a fit: the search that is explained has already looked for the nearest to it.
        if found.is_empty() || demands != [Demand::TOLERANCE] {
            found.extend(self.short_search(spec, self.trial, WARM)?);
        }
        self.tried.push((demands.to_vec(), found.clone()));
        Ok(found)
    }

    /// Returns the problem without some demands.
    fn dropped(&self, demands: &[Demand]) -> ProblemSpec {
        demands.iter().fold(self.problem.spec().clone(), |spec, demand| demand.dropped(self.problem, spec))
    }

    /// Returns the candidates that are acceptable under a looser specification.
    fn acceptable_under(&self, spec: &ProblemSpec, candidates: &[Candidate]) -> Vec<Candidate> {
        let Ok(problem) = Problem::new(spec.clone()) else { return Vec::new() };
        let asked = candidates.iter().take_while(|_| !self.context.stopped());
        let judged = asked.filter_map(|c| judged_under(&problem, c));
        judged.filter(|c| c.accepted).take(WARM).collect()
    }

    /// Runs a search of `auto` with a budget of its own and returns the candidates that it accepts. `fits` as for
    /// [`Inquiry::outcome`].
    fn short_search(
        &mut self,
        mut spec: ProblemSpec,
        evaluations: u64,
        fits: usize,
    ) -> Result<Vec<Candidate>, PopulationError> {
        spec.solve.evaluations = evaluations.max(1);
        spec.solve.method = Method::Auto;
        let (accepted, spent) = self.outcome(spec, fits)?;
        self.spent += spent;
        Ok(accepted)
    }

    /// Returns the candidates of a problem that the search accepts, and its evaluations. All that it finds are judged
    /// by the problem itself, and `fits` of its ends are fitted under all of its requirements.
    fn outcome(&mut self, spec: ProblemSpec, fits: usize) -> Result<(Vec<Candidate>, u64), PopulationError> {
        let Ok(problem) = Problem::new(spec) else { return Ok((Vec::new(), 0)) };
        (self.context.observer)(&Progress::of("what would help", self.spent, self.allowance));
        let context = self.context.of(&problem).silent();
        let mut outcome = plan::approximate(context)?;
        // As a run does: a cognate may take its candidate's place.
        offered_cognates::offer(context, &mut outcome.candidates);
        if self.met.is_empty() {
            let mut ends = outcome.candidates.clone();
            ends.append(&mut outcome.others);
            let each = (self.trial / FIT_SHARE).clamp(1, LED_IN);
            let (met, spent) = led_in(self.context, &ends, (fits, each));
            self.spent += spent.objective;
            self.met.extend(met.into_iter().filter(|c| c.accepted));
        }
        let accepted = outcome.candidates.into_iter().filter(|c| c.accepted).collect();
        Ok((accepted, outcome.evaluations.objective))
    }

    /// Returns a minimal set of demands that cannot be met together; `helping` are in every such set.
    fn conflict(&mut self, demands: &[Demand], helping: &[Demand]) -> Result<Vec<Demand>, PopulationError> {
        // Bounds and policies are left out first: they often are defaults that nobody has asked for.
        let others: Vec<Demand> = demands.iter().copied().filter(|d| !helping.contains(d)).rev().collect();
        if self.without(&others)?.is_empty() {
            if helping.is_empty() {
                // Nothing is acceptable even without all of them, so they are not in conflict.
                return Ok(Vec::new());
            }
            if !self.exhausted() {
                return Ok(demands.iter().copied().filter(|d| helping.contains(d)).collect());
            }
        }
        let mut left_out: Vec<Demand> = Vec::new();
        for &demand in &others {
            let tried: Vec<Demand> =
                others.iter().copied().filter(|d| *d == demand || left_out.contains(d)).collect();
            if self.without(&tried)?.is_empty() && !self.exhausted() {
                left_out.push(demand);
            }
        }
        if self.exhausted() {
            // Those that help belong to every conflict; it was not found out if they are one by themselves.
            return Ok(Vec::new());
        }
        Ok(demands.iter().copied().filter(|d| !left_out.contains(d)).collect())
    }

    /// Searches the problem with the demands `among` alone, which are said not to be met together, and returns whether
    /// it finds that they are.
    fn is_refuted(&mut self, demands: &[Demand], among: &[Demand]) -> Result<bool, PopulationError> {
        let others: Vec<Demand> = demands.iter().copied().filter(|d| !among.contains(d)).collect();
        // All demands together are what the search that is explained has looked for.
        if others.is_empty() { Ok(false) } else { self.search_longer(&others) }
    }

    /// Searches the problem without some demands with as many evaluations as several trials have, and returns whether it
    /// finds something acceptable. What it finds becomes known, and counts in every trial that found nothing.
    fn search_longer(&mut self, without: &[Demand]) -> Result<bool, PopulationError> {
        if self.context.stopped() || !self.met.is_empty() {
            return Ok(false);
        }
        let mut spec = self.dropped(without);
        spec.solve.candidates = 1;
        let evaluations = CONFIRMING * self.trial;
        self.allowance += evaluations;
        let found = self.short_search(spec, evaluations, WARM)?;
        let mut tried = mem::take(&mut self.tried);
        for (without, known) in tried.iter_mut().filter(|(_, known)| known.is_empty()) {
            *known = self.acceptable_under(&self.dropped(without), &found);
        }
        self.tried = tried;
        let is_found = !found.is_empty();
        self.known.extend(found);
        Ok(is_found)
    }

    /// Returns the least loosening of some demands together, with its distance.
    fn relaxation(&mut self, demands: &[Demand]) -> Result<Option<(f64, Relaxation)>, PopulationError> {
        let found = self.without(demands)?;
        let mut types = Vec::new();
        for candidate in &found {
            if !types.contains(&candidate.linkage_type) {
                types.push(candidate.linkage_type);
            }
        }
        if !demands.contains(&Demand::TYPE) {
            types.truncate(1);
        }
        for linkage_type in types {
            let of_type = |c: &&Candidate| c.linkage_type == linkage_type || !demands.contains(&Demand::TYPE);
            let warm: Vec<Candidate> = found.iter().filter(of_type).cloned().collect();
            let mut base = self.problem.spec().clone();
            for demand in demands {
                if *demand == Demand::TYPE {
                    base.require.types.extend(linkage_type);
                    base.require.types.sort_unstable();
                    base.require.types.dedup();
                } else if demand.is_policy() {
                    base = demand.dropped(self.problem, base);
                }
            }
            if let Some(relaxation) = self.least(demands, &base, warm)? {
                return Ok(Some(relaxation));
            }
        }
        Ok(None)
    }

    /// Returns the least loosening of the limits of `demands` from `base`, in which their other parts are loosened.
    fn least(
        &mut self,
        demands: &[Demand],
        base: &ProblemSpec,
        warm: Vec<Candidate>,
    ) -> Result<Option<(f64, Relaxation)>, PopulationError> {
        let has_measure = |d: &Demand| !d.is_policy();
        let measured: Vec<Demand> = demands.iter().copied().filter(has_measure).collect();
        let Some(ladder) = Ladder::new(self.problem, &measured) else { return Ok(None) };
        let reached = |c: Candidate| Some((ladder.reached(self.problem, &c)?, c));
        let asked = warm.into_iter().take_while(|_| !self.context.stopped());
        let mut reached: Vec<(Vec<f64>, Candidate)> = asked.filter_map(reached).collect();
        let distance = |i: &usize| ladder.distance(&reached[*i].0);
        let nearest = (0..reached.len()).min_by(|one, other| distance(one).total_cmp(&distance(other)));
        let Some(nearest) = nearest else { return Ok(None) };
        reached.swap(0, nearest);
        let outermost = reached[0].0.clone();
        let mut warm: Vec<Candidate> = reached.into_iter().map(|(_, candidate)| candidate).collect();
        let mut outer = outermost.clone();
        // The tolerance judges the error but does not guide a fit: the error found is the best known. Beside other
        // limits it follows: it becomes the error that the last fit leaves.
        if measured != [Demand::TOLERANCE] && !measured.is_empty() {
            let mut step: f64 = 0.5;
            for _ in 0..STEPS {
                if step < SHORTEST_STEP || self.exhausted() {
                    break;
                }
                let between = ladder.without_tolerance(&ladder.between(1.0 - step, &outer));
                match self.accepted_at(ladder.spec(base, &between), &warm, step >= SEARCHED_STEP)? {
                    Some(candidate) => {
                        let limits = ladder.reached(self.problem, &candidate);
                        outer = limits.map_or(between.clone(), |limits| ladder.inner(&between, &limits));
                        warm.insert(0, candidate);
                        warm.truncate(WARM);
                        step = (LONGER * step).min(0.5);
                    }
                    None => step *= SHORTER,
                }
            }
        }
        // A fit from nearby may attain more than a search from anywhere: allow a little more room, then all of it.
        let tries = [outer.clone(), ladder.between(1.1, &outer), outermost];
        let mut before: Option<Vec<f64>> = None;
        for limits in tries {
            if self.context.stopped() {
                break;
            }
            let limits = ladder.rounded(&limits);
            if before.as_ref() == Some(&limits) {
                continue;
            }
            let spec = ladder.spec(base, &limits);
            before = Some(limits.clone());
            let Some(set) = changes(self.problem, &spec, demands) else { return Ok(None) };
            // With the settings of the problem: the result is the one obtained when the change is typed.
            let (accepted, _) = self.outcome(spec, 0)?;
            if let Some(best) = accepted.first() {
                let without_measure = (demands.len() - measured.len()) as f64 * WHOLE;
                let sum_sq = best.error.sum_sq;
                let relaxation = Relaxation { set, sum_sq, rms: rms(sum_sq, self.problem.task().len()) };
                return Ok(Some((ladder.distance(&limits) + without_measure, relaxation)));
            }
        }
        Ok(None)
    }

    /// Returns a candidate that is acceptable under other limits: by fits from known candidates, else (`search`) by a
    /// short search.
    fn accepted_at(
        &mut self,
        spec: ProblemSpec,
        warm: &[Candidate],
        search: bool,
    ) -> Result<Option<Candidate>, PopulationError> {
        let Ok(problem) = Problem::new(spec) else { return Ok(None) };
        let each = (self.trial / FIT_SHARE).max(1);
        for candidate in warm {
            let Some(start) = start_at(&problem, candidate) else { continue };
            let fit = polish(self.context.of(&problem), start, LONG_FIT, each);
            self.spent += fit.evaluations;
            let end = fit.end.and_then(|end| judged(&problem, &end)).filter(|c| c.accepted);
            if end.is_some() {
                return Ok(end);
            }
        }
        if !search {
            return Ok(None);
        }
        let mut spec = problem.spec().clone();
        spec.solve.candidates = 1;
        Ok(self.short_search(spec, self.trial / TRIAL_SHARE, 0)?.into_iter().next())
    }
}

/// Returns the scale by which a change of a demand's limits is measured: the limit itself, or the extent of its bounds.
fn scale(demand: Demand, spec: &ProblemSpec) -> f64 {
    let limits = demand.limits(spec).unwrap_or_default();
    let largest = limits.iter().map(|l| l.value.abs()).fold(0.0, f64::max);
    match limits.as_slice() {
        [_] => largest,
        [x0, y0, x1, y1] if !matches!(demand, Demand::Design(_)) => {
            (x1.value - x0.value).max(y1.value - y0.value)
        }
        several => {
            several.chunks(2).map(|pair| pair[pair.len() - 1].value - pair[0].value).fold(largest, f64::max)
        }
    }
}

/// A limit of a demand.
struct Rung {
    asked: f64,
    outward: f64,
    scale: f64,
    is_length: bool,
    is_tolerance: bool,
}

impl Rung {
    /// Returns a limit as it may be asked for: a length is never below 0.
    fn allowed(&self, limit: f64) -> f64 {
        if self.is_length { limit.max(0.0) } else { limit }
    }

    fn is_outside(&self, one: f64, other: f64) -> bool {
        self.outward * (one - other) > 0.0
    }
}

/// The limits of several demands, in their order.
struct Ladder {
    demands: Vec<Demand>,
    rungs: Vec<Rung>,
}

impl Ladder {
    /// Collects the limits; `None` if one of the demands has no limits as numbers.
    fn new(problem: &Problem, demands: &[Demand]) -> Option<Ladder> {
        let mut rungs = Vec::new();
        for demand in demands {
            let measure = scale(*demand, problem.spec());
            let rung = |limit: Limit| Rung {
                asked: limit.value,
                outward: limit.outward,
                scale: if measure > 0.0 { measure } else { problem.task().size() },
                is_length: matches!(demand, Demand::Design(key) if key.is_length()),
                is_tolerance: *demand == Demand::TOLERANCE,
            };
            rungs.extend(demand.limits(problem.spec())?.into_iter().map(rung));
        }
        Some(Ladder { demands: demands.to_vec(), rungs })
    }

    fn each(&self, limits: &[f64], to: impl Fn(&Rung, f64) -> f64) -> Vec<f64> {
        self.rungs.iter().zip(limits).map(|(rung, limit)| to(rung, *limit)).collect()
    }

    /// Returns the limits that a candidate just meets, none stricter than asked.
    fn reached(&self, problem: &Problem, candidate: &Candidate) -> Option<Vec<f64>> {
        let judged = judged_under(problem, candidate)?;
        let mut limits = Vec::new();
        for demand in &self.demands {
            limits.extend(demand.attained(&judged)?);
        }
        let outer =
            |rung: &Rung, limit: f64| if rung.is_outside(limit, rung.asked) { limit } else { rung.asked };
        (limits.len() == self.rungs.len()).then(|| self.each(&limits, outer))
    }

    /// Returns the greatest relative change of the limits.
    fn distance(&self, limits: &[f64]) -> f64 {
        let each = self.each(limits, |rung, limit| (limit - rung.asked).abs() / rung.scale);
        each.into_iter().fold(0.0, f64::max)
    }

    /// Returns limits at a fraction of the way from the asked to the `outer` ones; lengths never below 0.
    fn between(&self, share: f64, outer: &[f64]) -> Vec<f64> {
        self.each(outer, |rung, outer| rung.allowed(rung.asked + share * (outer - rung.asked)))
    }

    /// Returns the same limits with a tolerance that everything meets.
    fn without_tolerance(&self, limits: &[f64]) -> Vec<f64> {
        self.each(limits, |rung, limit| if rung.is_tolerance { f64::MAX } else { limit })
    }

    /// Returns the stricter limit of two in each place.
    fn inner(&self, one: &[f64], other: &[f64]) -> Vec<f64> {
        let pairs = self.rungs.iter().zip(one.iter().zip(other));
        pairs.map(|(rung, (one, other))| if rung.is_outside(*one, *other) { *other } else { *one }).collect()
    }

    fn rounded(&self, limits: &[f64]) -> Vec<f64> {
        self.each(limits, |rung, limit| rung.allowed(rounded_outward(limit, rung.asked, rung.outward)))
    }

    fn spec(&self, base: &ProblemSpec, limits: &[f64]) -> ProblemSpec {
        let mut spec = base.clone();
        let mut rest = limits;
        for demand in &self.demands {
            let count = demand.limits(&spec).map_or(0, |l| l.len());
            let (own, others) = rest.split_at(count);
            spec = demand.with_limits(spec, own);
            rest = others;
        }
        spec
    }
}
