//! Islands of starts and hops, in rounds of jobs that each have a random stream of their own.
//!
//! ```text
//! until the evaluations are spent, the caller stops, or an exact answer is found:
//!     an island:  draw chains, fit those that resemble the target, in three stages
//!                 hop from its best ends, in rounds, as long as that gains
//!     keep its ends beside those of the islands before
//! ```
//!
//! One pool for all starts is soon filled by the offspring of its best end: of five searches for the square, three ended at
//! 0.031 to 0.033 of its radius; with islands of the same evaluations four ended at 0.014 to 0.016, and one at 0.020.

use super::answers::{DyadChainAnswer, DyadChainOutcome, End, Pool, rank};
use super::atlas::Atlas;
use super::checkpoint::{DyadChainState, Resumed};
use super::constants::{
    CASCADE, DRAWS, DRAWS_PER_EVALUATION, ENOUGH, FEW, FOUNDING, HOPS, IMPROVED, JOBS, LAST_STEPS,
    LEAST_SHARE, PATIENCE, POOL, PREFILTERED, ROUND, SAME, SECOND_STEPS,
};
use super::curve::EVEN;
use super::fit::State;
use super::limits::Limits;
use super::request::{DyadChainProgress, Request, Watch};
use super::stages::{Bench, Setup};
use super::target::{Target, Variant};
use crate::numbers::arithmetic::streams::stream;
use rayon::prelude::*;

/// Items of one job in each stage of an island's start.
const STAGE_CHUNKS: [usize; 3] = [16, 4, 2];

/// Searches for dyad chains whose P draws a path, with free or with prescribed timing.
///
/// The answers are the same on any number of threads, and whenever a search is repeated with the same request, unless
/// `watch` stops it. With `earlier`, a state that `watch` was given by a search of the same request with any budget, it goes on
/// from there; a state of another request is ignored. Memory: a few megabytes and about a megabyte a job that runs. `None` for fewer than three points, points
/// that coincide, or numbers that are not usable.
///
/// ```
/// use linkwright::internals::mechanism::{Complex, DyadChainKind};
/// use linkwright::internals::synthesis::dyad_chains::{DyadChainLimits, Request, Watch, search};
/// let square: Vec<Complex> = (0..40)
///     .map(|i| {
///         let (side, along) = (i / 10, 0.2 * f64::from(i % 10) - 1.0);
///         Complex::new(along, -1.0) * Complex::i().powi(side)
///     })
///     .collect();
/// let limits = DyadChainLimits {
///     transmission_min: 30f64.to_radians(),
///     longest_max: 9.0,
///     link_ratio_max: 100.0,
///     pivots_in: [None; 3],
///     footprint_in: None,
///     extent_max: f64::INFINITY,
/// };
/// let request = Request {
///     points: &square,
///     closed: true,
///     timing: None,
///     kinds: &DyadChainKind::SIX_BARS,
///     counter_clockwise: false,
///     limits,
///     seed: 1,
///     evaluations: 26_000,
///     enough: 0.0,
///     repeats: None,
///     answers: 1,
/// };
/// let found = search(&request, Watch::silent(), None).ok_or("not usable")?;
/// let best = found.answers.first().ok_or("none")?;
/// // The best four-bar within these limits misses a square by a tenth of its radius.
/// assert!(best.accepted && best.rms < 0.1);
/// # Ok::<(), &str>(())
/// ```
pub fn search(
    request: &Request<'_>,
    watch: Watch<'_>,
    earlier: Option<&DyadChainState>,
) -> Option<DyadChainOutcome> {
    if !request.is_usable() {
        return None;
    }
    let target = Target::of((request.points, request.closed), request.timing, FEW, EVEN)?
        .turning(request.counter_clockwise);
    let limits = [false, true].map(|mirrored| Limits::of(&request.limits, &target, mirrored));
    let setup = Setup { target: &target, limits: &limits };
    let mut search = Search {
        request,
        watch,
        setup,
        archive: Pool::new(POOL.max(request.answers)),
        of_kinds: request.kinds.iter().map(|_| Pool::new(1)).collect(),
        next_stream: 0,
        done: DyadChainOutcome::default(),
    };
    if let Some(earlier) = earlier.and_then(|state| state.resumed(request.kinds, request.points.len())) {
        search.resume(earlier);
        if search.is_over(&search.archive) {
            return Some(search.finished());
        }
    }
    while search.run_island() {
        (search.watch.keeper)(&search.state());
        if search.is_over(&search.archive) {
            break;
        }
    }
    Some(search.finished())
}

/// A search between two rounds.
struct Search<'a> {
    request: &'a Request<'a>,
    watch: Watch<'a>,
    setup: Setup<'a>,
    /// The best ends of all islands that have ended, and of each kind.
    archive: Pool,
    of_kinds: Vec<Pool>,
    next_stream: u64,
    /// Counts so far.
    done: DyadChainOutcome,
}

impl Search<'_> {
    /// Returns whether the search ends, with a pool that has ends not yet in the archive.
    fn is_over(&self, pool: &Pool) -> bool {
        let best = pool.best().min(self.archive.best());
        let enough = self.request.enough / self.setup.target.radius;
        let came = self.done.islands.iter().filter(|rms| **rms <= (1.0 + SAME) * self.rms(best)).count();
        self.left() < ROUND
            || best <= ENOUGH.max(enough * enough)
            || self.request.repeats.is_some_and(|wanted| came >= wanted.max(1))
            || (self.watch.stopped)()
    }

    /// Returns the evaluations that are left beside those of the last fits.
    fn left(&self) -> u64 {
        let last = (self.request.answers + self.request.kinds.len()) * LAST_STEPS;
        self.request.evaluations.saturating_sub(self.done.evaluations + last as u64)
    }

    /// Returns the rms distance of a value, in the unit of the target.
    fn rms(&self, value: f64) -> f64 {
        value.sqrt() * self.setup.target.radius
    }

    fn tell(&self, pool: &Pool) {
        (self.watch.observer)(&DyadChainProgress {
            evaluations: self.done.evaluations,
            islands: self.done.islands.len(),
            best_rms: self.rms(pool.best().min(self.archive.best())),
        });
    }

    /// Goes on from the parts of an earlier state.
    fn resume(&mut self, earlier: Resumed) {
        let Resumed { archive, of_kinds, next_stream, done } = earlier;
        (self.next_stream, self.done) = (next_stream, done);
        // In the order in which they were kept.
        self.archive.ends = archive;
        of_kinds.into_iter().for_each(|end| self.add_to_kind(end));
    }

    fn state(&self) -> DyadChainState {
        let archive: Vec<&End> = self.archive.ends.iter().collect();
        let of_kinds: Vec<&End> = self.of_kinds.iter().flat_map(|pool| &pool.ends).collect();
        DyadChainState::of(self.request.kinds, [&archive, &of_kinds], self.next_stream, &self.done)
    }

    fn add_to_kind(&mut self, end: End) {
        if let Some(i) = self.request.kinds.iter().position(|kind| *kind == end.kind()) {
            self.of_kinds[i].add(end);
        }
    }

    /// Runs an island and keeps its ends; returns whether it came to its own end, before the search is over.
    fn run_island(&mut self) -> bool {
        let from = self.done.evaluations;
        if self.left() < FOUNDING && !self.archive.ends.is_empty() {
            return false;
        }
        let mut island = self.founded();
        let (mut record, mut improved) = (island.best(), self.done.evaluations);
        let is_whole = loop {
            self.tell(&island);
            if self.is_over(&island) {
                break false;
            }
            let idle = self.done.evaluations - improved;
            if island.ends.is_empty() || idle > PATIENCE.max(improved - from) {
                break true;
            }
            let ends = self.hops(&island);
            self.keep(ends, &mut island);
            if island.best() < (1.0 - IMPROVED) * record {
                (record, improved) = (island.best(), self.done.evaluations);
            }
        };
        if !island.ends.is_empty() {
            self.done.islands.push(self.rms(island.best()));
        }
        island.ends.into_iter().for_each(|end| self.archive.add(end));
        is_whole
    }

    /// Adds ends to an island, and to those of their kinds.
    fn keep(&mut self, ends: Vec<End>, island: &mut Pool) {
        self.done.ends += ends.len() as u64;
        for end in ends {
            self.add_to_kind(end.clone());
            island.add(end);
        }
    }

    /// Draws chains and fits those that resemble the target, in three stages. A search that is stopped meanwhile, and has no
    /// answer yet, takes the best of each stage alone to the end.
    fn founded(&mut self) -> Pool {
        let setup = self.setup;
        // Of few evaluations the first island takes what there is.
        let share = (self.left() as f64 / FOUNDING as f64).clamp(LEAST_SHARE, 1.0);
        let of = |all: usize| ((all as f64 * share) as usize).max(1);
        let atlas = Atlas {
            kinds: self.request.kinds,
            seed: self.request.seed,
            stream: self.next_stream,
            draws: of(DRAWS),
            prefiltered: of(PREFILTERED),
            limits: &setup.limits[0],
        };
        self.next_stream += atlas.streams();
        let mut starts = match setup.target.timed {
            None => atlas.starts(setup.target, of(CASCADE[0])),
            Some(_) => atlas.timed_starts(setup.target, of(CASCADE[0])),
        };
        self.done.draws += of(DRAWS) as u64;
        self.done.evaluations += of(DRAWS) as u64 / DRAWS_PER_EVALUATION;
        starts.truncate(self.most(of(CASCADE[0])));
        let [first, second, third] = STAGE_CHUNKS;
        let fitted = self
            .in_parallel(&starts, first, |bench, start| Some((setup.first_fit(bench, start), start.variant)));
        let states = self.best_states(fitted, of(CASCADE[1]));
        let fitted = self.in_parallel(&states, second, |bench, (state, variant)| {
            let mut state = state.clone();
            setup.second_fit(bench, &mut state, *variant, SECOND_STEPS);
            Some((state, *variant))
        });
        let states = self.best_states(fitted, of(CASCADE[2]));
        let ends = self.in_parallel(&states, third, |bench, (state, variant)| {
            Some(setup.full_fit(bench, state, *variant))
        });
        let mut island = Pool::new(POOL);
        self.keep(ends, &mut island);
        island
    }

    /// Returns how many of the best are fitted on.
    fn most(&self, most: usize) -> usize {
        match (self.watch.stopped)() {
            false => most,
            true => usize::from(self.archive.ends.is_empty()),
        }
    }

    fn best_states(&self, mut states: Vec<(State, Variant)>, most: usize) -> Vec<(State, Variant)> {
        states.retain(|(state, _)| state.value.is_finite());
        states.sort_by(|(a, _), (b, _)| a.value.total_cmp(&b.value));
        states.truncate(self.most(most));
        states
    }

    /// Runs a round of hops.
    fn hops(&mut self, pool: &Pool) -> Vec<End> {
        let (setup, seed) = (self.setup, self.request.seed);
        let streams: Vec<u64> = (self.next_stream..self.next_stream + JOBS).collect();
        self.next_stream += JOBS;
        let ends = self.in_parallel(&streams, 1, |bench, index| {
            let draws = &mut stream(seed, *index);
            Some((0..HOPS).filter_map(|_| setup.hop(bench, pool, draws)).collect::<Vec<End>>())
        });
        ends.into_iter().flatten().collect()
    }

    /// Runs jobs of `chunk` items each in parallel, counts their evaluations, and returns their results in order.
    fn in_parallel<S: Sync, T: Send>(
        &mut self,
        items: &[S],
        chunk: usize,
        run: impl Fn(&mut Bench, &S) -> Option<T> + Sync,
    ) -> Vec<T> {
        let done: Vec<(Vec<T>, u64)> = items
            .par_chunks(chunk)
            .map(|chunk| {
                let mut bench = Bench::default();
                let out = chunk.iter().filter_map(|item| run(&mut bench, item)).collect();
                (out, bench.evaluations())
            })
            .collect();
        self.done.evaluations += done.iter().map(|(_, evaluations)| evaluations).sum::<u64>();
        done.into_iter().flat_map(|(out, _)| out).collect()
    }

    /// Fits the best ends once more, with strict limits, and measures them.
    fn finished(mut self) -> DyadChainOutcome {
        let setup = self.setup;
        let best: Vec<End> = self.archive.ends.iter().take(self.request.answers).cloned().collect();
        let of_kinds: Vec<End> = self.of_kinds.iter().filter_map(|pool| pool.ends.first()).cloned().collect();
        let [answers, best_of_kinds] = [best, of_kinds].map(|ends| {
            let request = self.request;
            let mut answers = self.in_parallel(&ends, 1, |bench, end| {
                Some(DyadChainAnswer::of(&setup.last_fit(bench, end), setup.target, request))
            });
            rank(&mut answers);
            answers
        });
        DyadChainOutcome { answers, best_of_kinds, ..self.done }
    }
}
