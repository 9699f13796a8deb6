//! Multistart search for free timing: starts by arc length or from the atlas, joint Levenberg-Marquardt fits on the
//! torus, and a stopping rule by repeated hits of the best answer.
//!
//! A *round* takes `SCREEN` drawn starts, or matches of the atlas if the target has points enough; the last of every
//! `HOP_EVERY` rounds takes starts near known ends and along the differences between them. It fits the `SHORT` most
//! promising for a few steps, fits the best `MIDDLE` of those further, and finishes those that can still matter. Targets of
//! few points have fewer starts drawn (`FEW_SCREEN`) and fewer rounds near known ends (`FEW_HOP_EVERY`). On a dense
//! target starts near known ends are fitted whatever they promise, since the most promising lead back to their end; and if
//! errors are not noise the last of the fits that go further is not the next best, but one of the others in turn.
//!
//! Dense targets are explored in groups of points ([`super::coarse`]); now and then all points are explored, or one point
//! of each group, to find detail that the groups' means blur. The correspondence between the points and the curve is
//! recomputed for their ends (`reassign`), and these are fitted again for as long as that gains. The ends of a batch are
//! finished on all points after it, each of them once however many rounds reached it; only those that can be the best, or
//! may be on their way to an exact answer, are led to their last digits. So are the ends of a sparse target of `STRICT_LEAST`
//! points or more once an answer is known that is far from exact; those of other sparse targets are finished in their
//! rounds. Ends whose points have strayed to a circuit or branch that the referee will refuse are led back (`required`).
//! Rounds run in parallel in batches of `BATCH` and are read in their order: the number of threads changes nothing but the
//! time. Ends are judged by the referee in order of increasing error until enough of them are accepted.
//!
//! Some batches explore a stricter problem ([`mod@stricter`]) as a search of that problem would, with the same starts. Their
//! ends are finished with the stricter requirement and without it, and either can be an answer: so a looser problem
//! meets the answers of a tighter one. If the errors are neither noise nor nearly exact, each of the explorations
//! ([`mod@explorations`]) is given its share of the evaluations.
//!
//! *Stopping rule*: as many independent rounds as [`super::belief::FreeHits`] gives (rounds that start near known ends do
//! not count) have reached the best error within `SAME_OPTIMUM`, or four or more times as many within `NEARLY`, for an
//! optimum that is approached and hardly reached; and either as many distinct answers as were asked for are known or
//! `QUIET_BATCHES` batches brought no new one. Unless the errors are exact or noise, the stricter problems confirm it
//! with batches of their own. Sparse targets are searched through `LEAST_BATCHES` batches at least, so that rounds
//! near known ends get their turn; if points are few and one answer is wanted, the last of them and later ones may end
//! after half of their rounds. On a dense target the rule depends on the residuals. If they are noise, uncorrelated
//! from point to point, `NOISE_HITS` answers within `IN_NOISE` of each other are enough, after `NOISE_EVALUATIONS` at least,
//! among them a batch on all points with a crank that turns fully, as a search under that requirement has one: so the best of
//! several answers is worth comparing with that of another problem. If one answer is wanted, fewer are
//! enough, and the first batch may end after half of its rounds. The points of a group then scatter about their mean
//! nearly alike for all linkages ([`mod@noise`]), so that the error of an end on all points can be expected from that on the
//! groups: few ends are finished, and the others are counted with the error that is expected. If neighbouring residuals are correlated, the linkage misses a shape that another linkage may have. The search
//! then ends when the error has kept its level (within a factor `LEVEL`) for several times as many evaluations as it took
//! to reach it: `LEVEL_TIMES` if `LEVEL_HITS` independent rounds came to that level, `QUIET_TIMES` if one did; so does a
//! search of a sparse target of `STRICT_LEAST` points or more. An error below `SMALL` sizes may be that of a clean curve
//! whose own linkage is still to be found: `PATIENT_BATCHES` batches are searched at least. An exact
//! answer needs no second hit.

pub use super::constants::free::LEAST_MATCHED;

use super::atlas::Matches;
use super::belief::{DENSE_HITS, FreeHits, NEARLY, SAME_OPTIMUM, SPARSE_HITS};
use super::driver::{Allowance, Found, Standing, Strategy, are_enough, drive};
use super::polish::{basins_wanted, promising};
use super::required::cost_of;
use super::starts::Starts;
use super::states::{Counts, End, FreeState, Level, SearchState, StageState};
use super::{Context, HitsSoFar, repeats};
use crate::judge::rank::{exact_cost, searched};
use crate::numbers::optimise::exact_float::Exact;
use crate::record::Candidate;
use crate::synthesis::constants::free::{
    BATCH, CONFIRMING, CORNERS_AT, CORNERS_EVERY, DENSE_CONFIRMING, DENSE_STRICTER, IN_NOISE, KEPT,
    LEAST_BATCHES, LEVEL, LEVEL_HITS, LEVEL_LEAST, LEVEL_TIMES, MANY_HITS, MANY_LEAST, NEARLY_EXACT,
    NOISE_EVALUATIONS, NOISE_HITS, NOISE_HITS_FOR_ONE, NOISE_LEAST, NOISE_ROUNDS_FOR_ONE, PATIENT_BATCHES,
    QUIET_BATCHES, QUIET_LEAST, QUIET_TIMES, SMALL, STRICTER, TURNING_IN_NOISE, TURNING_WHOLE_IN_NOISE,
    WHOLE_ELSE, WHOLE_EVERY, WHOLE_IN_NOISE,
};
use crate::task::Problem;
use batch::{Batch, Known, SoFar};
use explorations::{Exploration, Explored, Points, explorations};
use noise::{Scatter, is_noise};
use round::Setup;
use std::cell::OnceCell;
use stricter::{Kind, has_many_points, stricter};

mod batch;
pub(super) mod explorations;
mod noise;
mod parts;
mod round;
mod state;
mod stricter;

/// Judges ends in order of increasing merit: until the first accepted one if one answer is wanted, else all that can be
/// among the best. Returns the best of them.
fn judge_from_the_best(
    context: Context<'_>,
    ends: &mut [End],
    wanted: usize,
    exact: f64,
) -> Option<Candidate> {
    let problem = context.problem;
    let judging = context.judging();
    let mut best: Option<Candidate> = None;
    let mut count = 0;
    let enough = if wanted == 1 { 1 } else { 8 * wanted };
    for end in ends {
        if count >= enough {
            break;
        }
        if !end.judged && !judging.may_go_on() {
            continue;
        }
        end.judge(problem);
        let Some(candidate) = end.verdict.as_ref().filter(|c| promising(problem, c)) else { continue };
        count += 1;
        let better = best
            .as_ref()
            .is_none_or(|b| searched(problem, candidate).max(exact) < searched(problem, b).max(exact));
        if better {
            best = Some(candidate.clone());
        }
    }
    best
}

/// The search with its state.
struct Free<'a> {
    problem: &'a Problem,
    /// The explorations that the problem has, each of them a stage, and their starts.
    explorations: &'a [Exploration<'a>],
    starts: &'a [Starts<'a>],
    /// Number of distinct answers wanted.
    wanted: usize,
    exact: f64,
    /// The setups of the stages, made when they begin: the atlas takes its time.
    setups: Vec<OnceCell<Setup<'a>>>,
    at: FreeState,
    /// The best of the judged ends that is acceptable, or would be after its polish.
    best: Option<Candidate>,
    /// Whether the evaluations left did not suffice for the last batch.
    is_cut: bool,
}

/// Searches until the best is believed, the limit is reached, or the patience is at an end.
pub(super) fn search(context: Context<'_>, allowance: Allowance) -> Option<Found> {
    let problem = context.problem;
    let stricter = stricter(problem);
    let wanted = basins_wanted(problem);
    let explorations = explorations(problem, &stricter, wanted);
    let starts: Vec<Starts<'_>> = explorations.iter().map(|e| Starts::new(e.problem())).collect();
    let mut free = Free {
        problem,
        explorations: &explorations,
        starts: &starts,
        wanted,
        exact: exact_cost(problem),
        setups: explorations.iter().map(|_| OnceCell::new()).collect(),
        at: FreeState { stages: vec![StageState::BEGUN; explorations.len()], ..FreeState::default() },
        best: None,
        is_cut: false,
    };
    let points: Vec<usize> = explorations.iter().map(|e| e.problem().task().len()).collect();
    let earlier = context.keeper.and_then(|keeper| keeper.earlier().free.clone());
    if let Some(state) = earlier.filter(|state| state.is_of(problem, &points)) {
        free.at = state.judged_again(problem);
        free.best = judge_from_the_best(context, &mut free.at.ends, free.wanted, free.exact);
    }
    let reason = drive(context, allowance, &mut free);
    let best = free.accepted().iter().map(|c| searched(problem, c)).min_by(f64::total_cmp);
    let merits: Vec<f64> = free.at.best_merits.iter().map(|merit| merit.0).collect();
    Some(Found {
        repeats: best.map(|best| repeats::counted(&merits, best, free.exact)),
        candidates: free.at.ends.into_iter().filter_map(|end| end.verdict).collect(),
        evaluations: free.at.evaluations,
        reason,
        used: vec![Free::PHASE.into()],
    })
}

impl<'a> Free<'a> {
    /// Returns whether the target is explored in groups of points.
    fn is_dense(&self) -> bool {
        self.explorations[0].coarse.is_some()
    }

    /// Returns the setup of a stage.
    fn setup(&self, stage: usize) -> &Setup<'a> {
        self.setups[stage].get_or_init(|| {
            let exploration = &self.explorations[stage];
            let starts = &self.starts[stage];
            Setup {
                problem: self.problem,
                coarse: exploration.coarse.as_ref(),
                stricter: exploration.explored.stricter.map(|_| exploration.of),
                starts,
                first_stream: exploration.first_stream(),
                matches: (starts.arc.len() >= LEAST_MATCHED).then(|| Matches::of(starts)),
                single: self.wanted == 1,
                exact: self.exact,
                nearly_exact: self.nearly_exact(),
            }
        })
    }

    /// Returns the index of the stage of the next batch: one that is to confirm the best answer once the stopping rule
    /// is met, else the stage in turn.
    fn next_stage(&self) -> usize {
        let stage = if self.at.confirming { self.to_confirm() } else { None };
        stage.unwrap_or_else(|| self.stage_in_turn())
    }

    /// Returns the indices of the stages that are given a share of the evaluations.
    fn sharing(&self) -> impl Iterator<Item = usize> {
        (0..self.explorations.len()).filter(|i| self.explorations[*i].explored.share() > 0)
    }

    /// Returns the index of the stage whose turn it is.
    ///
    /// If the errors of the best answer are neither noise nor nearly exact each stage is given its share of the
    /// evaluations. All points and corners tell what grouping blurs; under stricter requirements fits keep away from change
    /// points, where they are long and lead to linkages that jam. Else all points, or a stricter problem, are explored now
    /// and then.
    fn stage_in_turn(&self) -> usize {
        let batch = self.at.counts.batch;
        let is_noise = self.is_noise();
        if self.best.is_some() && self.best_error() > self.nearly_exact() && !is_noise {
            let part =
                |i: &usize| self.at.stages[*i].spent as f64 / self.explorations[*i].explored.share() as f64;
            return self.sharing().min_by(|i, j| part(i).total_cmp(&part(j))).unwrap_or(0);
        }
        let on_all_at = if is_noise { WHOLE_IN_NOISE } else { WHOLE_ELSE };
        let (every, strict_at, turning_at) = if self.is_dense() { DENSE_STRICTER } else { STRICTER };
        let own = |points: Points| Explored { points, stricter: None };
        let under = |kind: Kind| Explored { points: Points::First, stricter: Some(kind) };
        let wanted = [
            (own(Points::Whole), batch % WHOLE_EVERY == on_all_at),
            (own(Points::Corners), !is_noise && batch % CORNERS_EVERY == CORNERS_AT),
            (under(Kind::Strict), !is_noise && batch % every == strict_at),
            (under(Kind::Turning), !is_noise && batch % every == turning_at),
            (under(Kind::Turning), is_noise && batch == TURNING_IN_NOISE),
            (Explored::TURNING_WHOLE, is_noise && batch == TURNING_WHOLE_IN_NOISE),
        ];
        let place = |explored: Explored| self.explorations.iter().position(|e| e.explored == explored);
        let stage = wanted.into_iter().filter(|(_, now)| *now).find_map(|(explored, _)| place(explored));
        stage.unwrap_or(0)
    }

    /// Returns the index of a stricter stage that is still to confirm the best answer: the one with fewer rounds of
    /// those that have neither found their own best often enough nor had their most rounds.
    fn to_confirm(&self) -> Option<usize> {
        let rounds = |i: usize| self.at.stages[i].index;
        let is_open = |i: usize| {
            let stage = &self.at.stages[i];
            let merits = || stage.round_merits.iter().map(|merit| merit.0);
            let hits = self.hits_wanted();
            let believed = repeats::came(merits(), stage.bar, SAME_OPTIMUM, self.exact) >= hits.same
                || repeats::came(merits(), stage.bar, NEARLY, self.exact) >= hits.near;
            let batches = stage.index / BATCH;
            let (least, most) = if self.is_dense() {
                let least = DENSE_CONFIRMING.of(self.explorations[i].explored.points);
                (least, least)
            } else {
                CONFIRMING
            };
            batches < least || (!believed && batches < most)
        };
        let is_stricter = |i: &usize| self.explorations[*i].explored.stricter.is_some();
        let open = self.sharing().filter(is_stricter).filter(|i| is_open(*i));
        open.min_by_key(|i| rounds(*i))
    }

    /// Returns whether an error that is not small has kept its level for so long that more rounds will hardly lower it.
    fn keeps_its_level(&mut self, error: f64) -> bool {
        let spent = self.at.evaluations.objective;
        let reached = self.at.reached.filter(|level| error >= level.cost.0 / LEVEL);
        let reached = reached.unwrap_or(Level { cost: Exact(error), evaluations: spent });
        self.at.reached = Some(reached);
        let after = |least: u64, times: u64| spent >= least.max(times * reached.evaluations);
        let again = self.within(error, LEVEL - 1.0);
        let many = again >= MANY_HITS && after(MANY_LEAST, LEVEL_TIMES);
        let several = again >= LEVEL_HITS && after(LEVEL_LEAST, LEVEL_TIMES);
        let once = again > 0 && after(QUIET_LEAST, QUIET_TIMES);
        error > self.cost_of(SMALL) && (many || several || once)
    }

    /// Returns whether enough of some independent rounds have come to equally good answers, the errors of the best being
    /// noise; `merits` are the least of each round.
    fn is_believed_in_noise(&self, error: f64, merits: impl ExactSizeIterator<Item = f64>) -> bool {
        let rounds = merits.len();
        let hits = repeats::came(merits, error, IN_NOISE, self.exact);
        if self.wanted > 1 {
            return hits >= NOISE_HITS;
        }
        hits >= NOISE_HITS_FOR_ONE || (hits > 1 && rounds >= NOISE_ROUNDS_FOR_ONE)
    }

    /// Judges the first rounds of a batch of a search for one answer: whether its errors are noise, and enough rounds have
    /// come to equally good answers.
    fn so_far(&self, context: Context<'_>, batch: &mut Batch) -> SoFar {
        let of = |is_noise: bool, is_enough: bool| SoFar { is_noise, is_enough };
        if self.may_end_after_half() {
            return of(false, self.is_believed_with(context, batch));
        }
        if Scatter::of(self.problem, &batch.stage).is_none() {
            return of(false, false);
        }
        batch.ends.sort_by(|one, other| one.merit.total_cmp(&other.merit));
        let best = judge_from_the_best(context, &mut batch.ends, self.wanted, self.exact);
        let Some(error) = best.map(|best| searched(self.problem, &best)) else { return of(false, false) };
        let is_noise =
            error > self.cost_of(NOISE_LEAST).max(self.exact) && is_noise(self.problem, &batch.ends);
        of(is_noise, is_noise && self.is_believed_in_noise(error, batch.best_merits.iter().copied()))
    }

    /// Returns whether half of the next batch may be enough: the last ones of a search for one answer on a sparse target of few
    /// points.
    fn may_end_after_half(&self) -> bool {
        let has_few = !self.is_dense() && !has_many_points(self.problem);
        has_few && self.wanted == 1 && self.best.is_some() && self.at.counts.batch + 1 >= LEAST_BATCHES
    }

    /// Returns whether the best answer is believed with the rounds of a batch that have been read.
    fn is_believed_with(&self, context: Context<'_>, batch: &mut Batch) -> bool {
        let known = self.best_error();
        batch.ends.sort_by(|one, other| one.merit.total_cmp(&other.merit));
        let better = batch.ends.partition_point(|end| end.merit < known);
        let best = judge_from_the_best(context, &mut batch.ends[..better], self.wanted, self.exact);
        let error = best.map_or(known, |best| searched(self.problem, &best).min(known));
        let merits =
            || self.at.best_merits.iter().map(|merit| merit.0).chain(batch.best_merits.iter().copied());
        self.has_hits(error, merits)
    }

    /// Returns whether as many independent rounds as are wanted have come to an error; `merits` are the least of each round.
    fn has_hits<I: Iterator<Item = f64>>(&self, error: f64, merits: impl Fn() -> I) -> bool {
        let wanted = self.hits_wanted();
        let came = |part: f64| repeats::came(merits(), error, part, self.exact);
        came(SAME_OPTIMUM) >= wanted.same || came(NEARLY) >= wanted.near
    }

    /// Returns whether a search whose errors are noise has had the evaluations that several answers are worth.
    fn is_long_enough_in_noise(&self) -> bool {
        self.wanted == 1 || self.at.evaluations.objective >= NOISE_EVALUATIONS
    }

    /// Returns what is known before a batch.
    fn known(&self) -> Known {
        let in_groups = |(e, _): &(&Exploration<'_>, &StageState)| e.explored.points == Points::First;
        let stages = self.explorations.iter().zip(&self.at.stages).filter(in_groups);
        let shown = stages.filter_map(|(_, stage)| Scatter::of(self.problem, stage));
        let scatter = shown.min_by(|one, other| one.best.total_cmp(&other.best));
        let in_halves = self.may_end_after_half();
        Known { best: self.best_error(), in_noise: self.is_noise(), scatter, in_halves }
    }

    /// Returns whether the target is dense and the errors of the best acceptable end are noise.
    fn is_noise(&self) -> bool {
        self.is_dense() && is_noise(self.problem, &self.at.ends)
    }

    /// Sorts the ends and drops the worst. Only some of the refused ends are kept: they must not crowd out the accepted.
    fn sort_ends(&mut self) {
        let ends = &mut self.at.ends;
        ends.sort_by(|one, other| one.merit.total_cmp(&other.merit));
        let mut refused = 0;
        ends.retain(|end| {
            let unfit = end.judged && !end.verdict.as_ref().is_some_and(|c| promising(self.problem, c));
            refused += usize::from(unfit);
            !unfit || refused <= KEPT / 4
        });
        ends.truncate(KEPT);
    }

    /// Returns the judged candidates that are acceptable, or would be after their polish.
    fn accepted(&self) -> Vec<Candidate> {
        let judged = self.at.ends.iter().filter_map(|end| end.verdict.as_ref());
        judged.filter(|c| promising(self.problem, c)).cloned().collect()
    }

    /// Returns the cost of an rms error given in sizes of the target.
    fn cost_of(&self, rms: f64) -> f64 {
        cost_of(self.problem, rms)
    }

    /// Returns the error up to which an answer is nearly exact.
    fn nearly_exact(&self) -> f64 {
        self.cost_of(NEARLY_EXACT).max(self.exact)
    }

    /// Returns the error of the best answer, infinite if there is none.
    fn best_error(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |best| searched(self.problem, best))
    }

    fn hits_wanted(&self) -> FreeHits {
        if self.is_dense() { DENSE_HITS } else { SPARSE_HITS }
    }

    /// Returns the number of independent rounds within a relative distance `part` of an error.
    fn within(&self, error: f64, part: f64) -> usize {
        let merits = self.at.best_merits.iter().map(|merit| merit.0);
        repeats::came(merits, error, part, self.exact)
    }
}

impl Strategy for Free<'_> {
    /// The results of the batch, and the index of its stage.
    type Batch = (Batch, usize);
    const PHASE: &'static str = "least-squares";

    fn save(&self, state: &mut SearchState) {
        debug_assert!(self.at.is_counted(), "a state in the middle of a batch");
        state.free = Some(self.at.clone());
    }

    fn standing(&self) -> Standing<'_> {
        let best = self.best.as_ref();
        let hits = best.filter(|b| b.accepted).map(|best| HitsSoFar {
            came: self.within(searched(self.problem, best), SAME_OPTIMUM),
            wanted: self.hits_wanted().same,
        });
        Standing {
            evaluations: self.at.evaluations.objective,
            draws: self.at.counts.draws,
            best,
            nearest: self.at.ends.iter().find_map(|end| end.verdict.as_ref()),
            hits,
            is_cut: self.is_cut && best.is_some(),
        }
    }

    fn run(&mut self, context: Context<'_>, left: u64) -> (Self::Batch, bool) {
        let now = self.next_stage();
        let first = self.at.counts.batch * BATCH;
        let (setup, known) = (self.setup(now), self.known());
        let so_far = |batch: &mut Batch| self.so_far(context, batch);
        let batch = Batch::run(context, setup, &self.at.stages[now], first, known, left, so_far);
        let whole = batch.whole;
        self.is_cut = !whole;
        ((batch, now), whole)
    }

    fn read(&mut self, context: Context<'_>, (batch, stage): Self::Batch) {
        let at = &mut self.at;
        at.stages[stage] = batch.stage;
        at.stages[stage].spent += batch.cost.objective;
        at.counts.batch += 1;
        at.counts.draws += batch.draws;
        at.evaluations += batch.cost;
        at.best_merits.extend(batch.best_merits.into_iter().map(Exact));
        at.ends.extend(batch.ends);
        self.sort_ends();
        self.best = judge_from_the_best(context, &mut self.at.ends, self.wanted, self.exact);
    }

    fn is_done(&mut self, context: Context<'_>) -> bool {
        let Some(best) = &self.best else { return false };
        let error = searched(self.problem, best);
        let is_exact = error <= self.exact;
        let is_noise = self.is_noise();
        let merits = || self.at.best_merits.iter().map(|merit| merit.0);
        let believed =
            self.has_hits(error, merits) || (is_noise && self.is_believed_in_noise(error, merits()));
        let batches = self.at.counts.batch;
        let ripe = match self.is_dense() {
            _ if is_exact => believed,
            false if believed && batches >= LEAST_BATCHES => true,
            false if !has_many_points(self.problem) => false,
            true if is_noise && error > self.cost_of(NOISE_LEAST) => {
                believed && self.is_long_enough_in_noise()
            }
            _ => (believed && batches >= PATIENT_BATCHES) || self.keeps_its_level(error),
        };
        self.at.confirming = false;
        if !(ripe || (is_exact && self.wanted == 1)) {
            return false;
        }
        let accepted = if self.wanted == 1 { Vec::new() } else { self.accepted() };
        let Counts { known, quiet, .. } = &mut self.at.counts;
        if !are_enough(context, &accepted, self.wanted, (known, quiet), QUIET_BATCHES) {
            return false;
        }
        self.at.confirming = !is_exact && !is_noise && self.to_confirm().is_some();
        !self.at.confirming
    }
}
