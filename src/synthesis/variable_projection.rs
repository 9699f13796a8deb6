//! Multistart search for prescribed timing by variable projection (the reduced form).
//!
//! A batch draws `DRAWS` ratios and angles from its own stream of the seed, screens them in every allowed direction
//! on both assemblies, fits the `SHORT` most promising for a few steps and the best `LONG` of them to convergence
//! ([`crate::task::forms::projection`]). An end that meets every bound and requirement is taken as it is. One that does
//! not, and has a lower objective than the best that does, is a lower bound for its basin: it is polished in the
//! physical parameters under all requirements ([`super::multistart::polish`]).
//!
//! If such ends occur, requirements are active, and later waves also fit under all requirements from the first step on:
//! from the screened draws of least cost and violation, and in rounds of [`super::multistart`], in turn.
//!
//! `WAVE` batches run in parallel and are read in their order; the work that a wave may skip (polishes of ends that are
//! no better than the best so far) depends on earlier waves only. So the number of threads changes no digit.
//!
//! In a motion a batch also takes the linkages of the driving dyad, which is linear ([`super::dyads::driving_dyad`]), with
//! the follower's dyads that the poses suggest ([`DyadStarts`]).
//!
//! *Stopping rule.* Independent batches have to reach the best objective repeatedly ([`super::belief`]). If
//! requirements are active, at least `BINDING_WAVES` waves have to fit under them; if several answers are wanted, the
//! search goes on until as many distinct ones are known or `QUIET_WAVES` waves brought no further one.

use super::belief::{Belief, HITS, SAME_OPTIMUM};
use super::constants::variable_projection::{
    BINDING_WAVES, CONSTRAINED_LONG, CONSTRAINED_SHORT, DRAWS, KEPT, LEAST_WAVES, LONG, LONG_EVALUATIONS,
    POLISHES, PROMISING, QUIET_WAVES, SHORT, SHORT_EVALUATIONS, WAVE,
};
use super::driver::{Allowance, Found, Standing, Strategy, are_enough, drive, in_parallel};
use super::dyads::{Driving, driving_dyad, pair};
use super::motion::DyadStarts;
use super::multistart::{LONG_FIT, SHORT_FIT, Spender, by_merit, glanced, promise, round};
use super::polish::{basins_wanted, promising};
use super::starts::{SLACK_RANGE, Starts, draw_ratios};
use super::states::{Judged, SearchState, TimedState, of_as_many_points};
use super::{Context, HitsSoFar, Judging};
use crate::judge::rank::{exact_cost, searched, sort};
use crate::mechanism::{AssemblyMode, Pose};
use crate::numbers::arithmetic::streams::{Stream, below, stream, uniform};
use crate::numbers::optimise::compact_lm::{CompactOptions, solve};
use crate::record::{Candidate, Evaluations, Repeats};
use crate::task::forms::fits::own_frame;
use crate::task::forms::projection::{Batch, ProjectedFit, Projection, Reduced, Solution};
use crate::task::forms::rows::{Motion, Requirements, nearest_type};
use crate::task::forms::start::{AS_WRITTEN, Start};
use crate::task::forms::timed::TimedMotionFit;
use crate::task::{AngleOffset, Problem, Setting, Timing};
use std::f64::consts::{PI, TAU};

/// Difference of designs, in parts of the target's size, within which they are judged once.
const SAME_NUMBERS: f64 = 1e-6;

/// The end of a fit in physical parameters, with its objective.
type End = (f64, Start);

/// The outcome of a batch.
#[derive(Clone, Debug, Default)]
struct BatchOutcome {
    /// Ends that meet every bound and requirement the search knows, best first.
    ends: Vec<End>,
    /// Ends of a round in the physical parameters, judged.
    judged: Vec<Candidate>,
    evaluations: Evaluations,
    draws: u64,
    polished: bool,
    /// Whether an end that violates a bound or a requirement was better than all that meet them.
    binding: bool,
}

/// The search with its state.
struct Timed<'a> {
    context: Context<'a>,
    problem: &'a Problem,
    forms: Vec<(f64, Projection)>,
    starts: Starts<'a>,
    /// In a motion, the dyads that its poses suggest.
    dyads: Option<DyadStarts<'a>>,
    requirements: Requirements,
    /// The least and the greatest prescribed angle as written, radians; the full turn of a closed target.
    span: (f64, f64),
    exact: f64,
    /// Number of distinct answers wanted.
    wanted: usize,
    at: TimedState,
}

/// Searches until the best is believed, the limit is reached, or the patience is at an end; `None` if the problem has no
/// reduced form.
pub(super) fn search(context: Context<'_>, allowance: Allowance) -> Option<Found> {
    let problem = context.problem;
    let mut timed = Timed::new(context)?;
    let earlier = context.keeper.and_then(|keeper| keeper.earlier().timed.clone());
    if let Some(state) = earlier.filter(|state| of_as_many_points(problem, &state.found, &state.best)) {
        timed.at = state;
    }
    let reason = drive(context, allowance, &mut timed);
    let at = timed.at;
    let (hits, near) = at.belief.hits();
    let repeats = || Repeats::new(at.wave * WAVE, hits as u64, near as u64);
    let mut used = vec![Timed::PHASE.into()];
    if at.polished {
        used.push("least-squares".into());
    }
    Some(Found {
        repeats: at.best.is_some().then(repeats),
        candidates: at.found,
        evaluations: at.evaluations,
        reason,
        used,
    })
}

impl Timed<'_> {
    /// Judges an end, unless it cannot matter or an equal one has been judged before.
    fn read_end(&mut self, (cost, end): End, judging: &Judging<'_>) {
        if self.wanted == 1 && cost > self.exact && !self.at.belief.would_improve(cost) {
            // One answer is wanted, and this is not a better one.
            self.at.belief.came_back_to(cost);
            return;
        }
        if let Some(accepted) = self.judged_before(&end) {
            if accepted {
                self.at.belief.came_back_to(cost);
            }
            return;
        }
        if !judging.may_go_on() {
            return;
        }
        let problem = self.problem;
        let Some(candidate) = glanced(problem, &end) else { return };
        let Start { setting, design, .. } = end;
        self.at.seen.push(Judged { setting, design, accepted: promising(problem, &candidate) });
        self.take(candidate);
    }

    fn take(&mut self, candidate: Candidate) {
        let problem = self.problem;
        if promising(problem, &candidate) {
            let cost = searched(problem, &candidate);
            self.at.belief.came_to(cost);
            if self.at.best.as_ref().is_none_or(|b| cost < searched(problem, b)) {
                self.at.best = Some(candidate.clone());
            }
        }
        self.at.found.push(candidate);
    }
}

impl Strategy for Timed<'_> {
    /// The outcomes of a wave's batches, and whether they fitted under all requirements.
    type Batch = (Vec<BatchOutcome>, bool);
    const PHASE: &'static str = "variable-projection";

    fn save(&self, state: &mut SearchState) {
        state.timed = Some(self.at.clone());
    }

    fn standing(&self) -> Standing<'_> {
        let TimedState { ref found, ref best, ref belief, evaluations, draws, .. } = self.at;
        Standing {
            evaluations: evaluations.objective,
            draws,
            best: best.as_ref(),
            nearest: found.first(),
            hits: best.as_ref().map(|_| HitsSoFar { came: belief.hits().0, wanted: HITS }),
            is_cut: false,
        }
    }

    fn run(&mut self, _: Context<'_>, left: u64) -> (Self::Batch, bool) {
        let (first, bar, binding) = (self.at.wave * WAVE, self.at.belief.best(), self.at.binding);
        let run = |i, allowance| self.batch(first + i, allowance, bar, binding);
        let (wave, ample) = in_parallel((left, WAVE), run, |batch| batch.evaluations.objective);
        ((wave, binding), ample)
    }

    fn read(&mut self, context: Context<'_>, (wave, binding): Self::Batch) {
        let judging = context.judging();
        self.at.wave += 1;
        self.at.binding_waves += u64::from(binding);
        for batch in wave {
            self.at.binding |= batch.binding;
            self.at.draws += batch.draws;
            self.at.polished |= batch.polished;
            self.at.evaluations += batch.evaluations;
            for end in batch.ends {
                self.read_end(end, &judging);
            }
            for candidate in batch.judged {
                self.take(candidate);
            }
            self.at.belief.end_batch();
        }
        sort(context.problem, &mut self.at.found);
        self.at.found.truncate(KEPT);
    }

    fn is_done(&mut self, context: Context<'_>) -> bool {
        let at = &mut self.at;
        let explored = !at.binding || at.binding_waves >= BINDING_WAVES;
        let enough = self.wanted == 1 || at.wave >= LEAST_WAVES;
        at.belief.is_firm()
            && explored
            && enough
            && are_enough(context, &at.found, self.wanted, (&mut at.known, &mut at.quiet), QUIET_WAVES)
    }
}

impl<'a> Timed<'a> {
    fn new(context: Context<'a>) -> Option<Self> {
        let problem = context.problem;
        let Timing::Prescribed { crank_angles, .. } = problem.task().timing() else { return None };
        let forms = problem
            .directions()
            .iter()
            .map(|&direction| Some((direction, Projection::new(problem, direction)?)))
            .collect::<Option<Vec<_>>>()?;
        let low = crank_angles.iter().copied().fold(f64::INFINITY, f64::min);
        let high = crank_angles.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let high = if problem.task().closed() { high.max(low + TAU) } else { high };
        let starts = Starts::new(problem);
        let exact = exact_cost(problem);
        Some(Timed {
            requirements: problem.requirements(&starts.spaces[0].1),
            starts,
            dyads: problem.task().body().map(|_| DyadStarts::new(problem)),
            forms,
            span: (low, high),
            exact,
            wanted: basins_wanted(problem),
            at: TimedState { belief: Belief::new(exact), ..TimedState::default() },
            context,
            problem,
        })
    }

    /// Returns the verdict on an end if an equal one has been judged before.
    fn judged_before(&self, end: &Start) -> Option<bool> {
        let near = SAME_NUMBERS * self.problem.task().size();
        let same = |(x, y): (&f64, &f64)| (x - y).abs() <= near;
        let equal = |judged: &&Judged| {
            judged.setting == end.setting && judged.design.iter().zip(&end.design).all(same)
        };
        self.at.seen.iter().find(equal).map(|judged| judged.accepted)
    }

    fn draw(&self, draws: &mut Stream) -> Option<Reduced> {
        let types = &self.starts.types;
        let kind = types[below(draws, types.len())];
        let ratios = draw_ratios(draws, kind, SLACK_RANGE)?;
        let angle = uniform(draws, -PI, PI);
        let form = &self.forms[0].1;
        let angle = if form.has_angle() { angle } else { 0.0 };
        let mut x = [ratios.crank.ln(), ratios.coupler.ln(), ratios.follower.ln(), angle];
        for (value, (low, high)) in x.iter_mut().zip(form.bounds()) {
            *value = value.max(*low).min(*high);
        }
        Some(x)
    }

    /// Returns the linkages of the driving dyad in each direction with followers that the poses suggest; none for a path.
    fn driven(&self, first: bool, stream: &mut Stream) -> Vec<Reduced> {
        let Some(dyads) = &self.dyads else { return Vec::new() };
        let followers = dyads.dyads(first, stream);
        let task = self.problem.task();
        let Timing::Prescribed { crank_angles, .. } = task.timing() else { return Vec::new() };
        let angles = task.body().map_or(&[][..], |body| &body.angles);
        let mut driven = Vec::new();
        for (direction, form) in &self.forms {
            let given = task.points().iter().zip(angles).zip(crank_angles).zip(task.weights());
            let given = given.filter_map(|(((point, angle), turn), weight)| {
                Some(((Pose::new(*point, (*angle)?), direction * turn), *weight))
            });
            let ((poses, turns), weights): ((Vec<Pose>, Vec<f64>), Vec<f64>) = given.unzip();
            let Some(Driving { dyad, angle }) = driving_dyad(&poses, &turns, &weights) else { continue };
            let pairs = followers.iter().filter_map(|follower| pair(&dyad, follower));
            driven.extend(pairs.map(|pair| form.at(&pair.shape, angle)));
        }
        driven
    }

    /// Returns whether the loop stays closed between the points too, on one assembly: |CB|^2 between (b - c)^2 and (b +
    /// c)^2 over the whole range of crank angles.
    fn stays_closed(&self, form: usize, x: &Reduced) -> bool {
        if self.problem.circuit_any() {
            return true;
        }
        let (direction, form) = &self.forms[form];
        let [p, q, r] = [x[0].exp(), x[1].exp(), x[2].exp()];
        let turn = form.crank_turn(x);
        let (one, other) = (direction * self.span.0 + turn, direction * self.span.1 + turn);
        let (low, high) = (one.min(other), one.max(other));
        let holds = |angle: f64| (angle - low).rem_euclid(TAU) <= high - low;
        let diagonal = |cos: f64| 1.0 + p * p - 2.0 * p * cos;
        let ends = [diagonal(low.cos()), diagonal(high.cos())];
        let least = if holds(0.0) { diagonal(1.0) } else { ends[0].min(ends[1]) };
        let greatest = if holds(PI) { diagonal(-1.0) } else { ends[0].max(ends[1]) };
        least >= (q - r) * (q - r) && greatest <= (q + r) * (q + r)
    }

    /// Runs batch `index`: its draws screened, fitted in the reduced form, and under all requirements where that is
    /// needed. `bar` is the best objective so far; `thorough`: fits under all requirements from the first step on too.
    fn batch(&self, index: u64, allowance: u64, bar: f64, thorough: bool) -> BatchOutcome {
        let mut out = BatchOutcome::default();
        let mut stream = stream(self.problem.spec().solve.seed, index);
        let readings = 2 * self.forms.len() as u64;
        let affordable = (allowance / readings).min(DRAWS as u64) as usize;
        out.draws = DRAWS as u64;
        let mut draws = self.driven(index == 0, &mut stream);
        draws.extend((0..DRAWS).filter_map(|_| self.draw(&mut stream)));
        draws.truncate(affordable);
        if draws.is_empty() {
            return out;
        }
        let batch = Batch::new(draws);
        let mut spender = Spender::new(self.context, allowance);
        spender.spend(self.problem, readings * batch.len() as u64);
        let Some(screened) = self.screened(&batch) else { return BatchOutcome::default() };
        let forms = self.forms.iter();
        let fits = forms.map(|(_, form)| ProjectedFit::new(form, AssemblyMode::Plus)).collect();
        let mut fitting = Fitting { search: self, fits, spender, out };
        let ends = fitting.reduced(&screened, &batch);
        fitting.divide(ends, bar);
        if thorough && index.is_multiple_of(2) {
            let round = round(self.context, &self.starts, index, fitting.spender.left());
            fitting.spender.cost += round.evaluations;
            fitting.out.polished = true;
            fitting.out.judged = round.found;
        } else if thorough {
            fitting.constrained(&screened, &batch);
        }
        let mut out = BatchOutcome { evaluations: fitting.spender.cost, ..fitting.out };
        by_merit(&mut out.ends, usize::MAX);
        out
    }

    /// Returns the draws that close in each form and assembly, least cost first; `None` if the search was stopped.
    fn screened(&self, batch: &Batch) -> Option<Vec<Screened>> {
        let mut screened: Vec<Screened> = Vec::new();
        for (form, (_, projection)) in self.forms.iter().enumerate() {
            let costs = projection.screen_unless(batch, &|| self.context.stopped())?;
            for (assembly, costs) in [AssemblyMode::Plus, AssemblyMode::Minus].into_iter().zip(costs) {
                let costs = costs.iter().enumerate().filter(|(_, c)| c.is_finite());
                screened.extend(costs.map(|(i, &c)| (c, i, form, assembly)));
            }
        }
        screened.sort_unstable_by(|x, y| {
            let places = (x.1, x.2).cmp(&(y.1, y.2));
            x.0.total_cmp(&y.0).then(places).then(x.3.sign().total_cmp(&y.3.sign()))
        });
        Some(screened)
    }

    /// Returns a solution as a start of the physical fit, and its violation of bounds and requirements in sizes of the
    /// target.
    fn physical(&self, solution: &Solution, direction: f64, assembly: AssemblyMode) -> Option<(Start, f64)> {
        let problem = self.problem;
        let Solution { shape, offset, .. } = solution;
        let (side, space) = self.starts.space_of(shape);
        let aim =
            if problem.types().is_empty() { None } else { nearest_type(shape.links(), problem.types()) };
        let setting = Setting { aim, assembly, direction, side: *side };
        let base = match problem.task().timing() {
            Timing::Prescribed { offset: AngleOffset::Ground, .. } => {
                (shape.follower_pivot - shape.crank_pivot).arg()
            }
            _ => *offset,
        };
        let (one, other) = (direction * self.span.0 + base, direction * self.span.1 + base);
        let motion = Motion::Stretch(one.min(other), one.max(other), assembly);
        let start = Start {
            design: space.design(shape, *offset),
            setting,
            positions: Vec::new(),
            scales: AS_WRITTEN,
        };
        let pins = problem.spec().require.pins_in.as_ref();
        let frame = pins.and_then(|_| {
            own_frame(&TimedMotionFit::new(problem, setting)?.unknowns(&start.design, start.scales))
        });
        let lack = self.requirements.lack(aim, shape, &motion, frame);
        let outside = space.excess(shape) / problem.task().size();
        Some((start, outside + lack))
    }
}

/// A screened draw: its cost, its index, the form and the assembly.
type Screened = (f64, usize, usize, AssemblyMode);
/// A point of the reduced form: its unknowns, the form and the assembly.
type Point = (Reduced, usize, AssemblyMode);

/// The fits of one batch within its allowance.
struct Fitting<'a> {
    search: &'a Timed<'a>,
    /// One fit per form.
    fits: Vec<ProjectedFit<'a>>,
    spender: Spender<'a>,
    out: BatchOutcome,
}

impl Fitting<'_> {
    /// Returns the start and the violation of unknowns of the reduced form ([`Timed::physical`]).
    fn physical(&mut self, x: &Reduced, form: usize, assembly: AssemblyMode) -> Option<(Start, f64)> {
        let fit = &mut self.fits[form];
        fit.set_assembly(assembly);
        self.search.physical(&fit.solution(x)?, self.search.forms[form].0, assembly)
    }

    /// Fits in the reduced form with at most `most` evaluations.
    fn fit(&mut self, (x, form, assembly): Point, most: u32) -> Option<(f64, Point)> {
        let left = u32::try_from(self.spender.left()).unwrap_or(u32::MAX);
        if left == 0 {
            return None;
        }
        let search = self.search;
        let options = CompactOptions {
            max_evaluations: most.min(left),
            relative_reduction: 1e-10,
            exact_cost: 1e-6 * search.exact,
            hopeless_cost: f64::INFINITY,
            patience: u32::MAX,
        };
        let fit = &mut self.fits[form];
        fit.set_assembly(assembly);
        let stop = || search.context.stopped();
        let end = solve(fit, x, search.forms[form].1.bounds(), &options, &stop);
        self.spender.spend(search.problem, u64::from(end.evaluations));
        end.cost.is_finite().then_some((end.cost, (end.x, form, assembly)))
    }

    /// Fits the most promising draws for a few steps and the best of them to convergence, in the reduced form.
    fn reduced(&mut self, screened: &[Screened], batch: &Batch) -> Vec<(f64, Point)> {
        let search = self.search;
        let promising =
            screened.iter().filter(|(_, i, form, _)| search.stays_closed(*form, &batch.draws()[*i]));
        let mut short = Vec::with_capacity(SHORT);
        for &(_, i, form, assembly) in promising.take(SHORT) {
            short.extend(self.fit((batch.draws()[i], form, assembly), SHORT_EVALUATIONS));
        }
        by_merit(&mut short, LONG);
        let mut long = Vec::with_capacity(LONG);
        for (cost, point) in short {
            if search.context.stopped() {
                // Taken as it is: the best so far.
                long.push((cost, point));
                break;
            }
            long.extend(self.fit(point, LONG_EVALUATIONS));
        }
        by_merit(&mut long, LONG);
        long
    }

    /// Takes the ends that meet every bound and requirement, and polishes those that do not and are better than all that
    /// do.
    fn divide(&mut self, ends: Vec<(f64, Point)>, bar: f64) {
        let search = self.search;
        let task = search.problem.task();
        let scale = task.weights().iter().sum::<f64>() * task.size().powi(2);
        let mut broken: Vec<(f64, End)> = Vec::new();
        for (cost, (x, form, assembly)) in ends {
            let Some((start, lack)) = self.physical(&x, form, assembly) else { continue };
            if lack != 0.0 {
                broken.push((cost + scale * lack * lack, (cost, start)));
            } else if search.stays_closed(form, &x) {
                self.out.ends.push((cost, start));
            }
        }
        by_merit(&mut broken, usize::MAX);
        if search.context.stopped() && self.out.ends.is_empty() {
            self.out.ends.extend(broken.drain(..).take(1).map(|(_, end)| end));
        }
        let mut polishes = 0;
        for (_, (cost, start)) in broken {
            let bar = self.out.ends.iter().map(|end| end.0).fold(bar, f64::min);
            if polishes >= POLISHES || self.spender.is_at_its_end() {
                break;
            }
            if cost >= bar * (1.0 - SAME_OPTIMUM) {
                continue;
            }
            polishes += 1;
            self.out.binding = true;
            self.polished(start);
        }
    }

    /// Fits to convergence under all requirements and adds the end.
    fn polished(&mut self, start: Start) {
        let fitted = self.spender.fit(self.search.problem, start, LONG_FIT, u64::MAX);
        self.out.polished = true;
        self.out.ends.extend(fitted);
    }

    /// Fits under all requirements from the first step on, from the draws of least cost and violation.
    fn constrained(&mut self, screened: &[Screened], batch: &Batch) {
        let search = self.search;
        let problem = search.problem;
        let mut starts = Vec::new();
        for &(_, i, form, assembly) in screened.iter().take(PROMISING) {
            let x = &batch.draws()[i];
            if self.spender.is_at_its_end() {
                break;
            }
            if !search.stays_closed(form, x) {
                continue;
            }
            self.spender.spend(problem, 1);
            let Some((mut start, _)) = self.physical(x, form, assembly) else { continue };
            // The promise of the start as the fit takes it: clamped to the bounds.
            starts.extend(promise(problem, &mut start).map(|promise| (promise, start)));
        }
        by_merit(&mut starts, CONSTRAINED_SHORT);
        let fit = |(_, start)| self.spender.fit(problem, start, SHORT_FIT, u64::MAX);
        let mut short: Vec<(f64, Start)> = starts.into_iter().filter_map(fit).collect();
        by_merit(&mut short, CONSTRAINED_LONG);
        for (_, start) in short {
            if self.spender.is_at_its_end() {
                break;
            }
            self.polished(start);
        }
    }
}
