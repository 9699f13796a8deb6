//! The tuning constants of the searches, by search.
//!
//! Each constant has its purpose beside it, each group the benchmark that chooses it. Constants of the stopping rules
//! are in [`super::belief`]. Tolerances of an algorithm, indices of random streams and the tables of the atlas, of
//! starts and of the reassignment are beside their code.

/// The effort of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Most steps.
    pub steps: usize,
    /// Most rounds of the multipliers.
    pub rounds: usize,
    /// The relative reduction of the cost at which it counts as converged.
    pub relative_reduction: f64,
    /// Whether the points of a motion are held on the branch on which they all start.
    pub on_branch: bool,
}

impl Effort {
    /// Creates the effort of a fit that goes on to the last digits.
    pub const fn of(steps: usize, rounds: usize) -> Self {
        Effort { steps, rounds, relative_reduction: 1e-12, on_branch: false }
    }

    /// Returns the effort of a fit that counts as converged at this relative reduction of the cost.
    pub const fn until(self, relative_reduction: f64) -> Self {
        Effort { relative_reduction, ..self }
    }

    /// Returns the effort of a fit that holds the points of a motion on the branch on which they all start.
    pub const fn on_branch(self) -> Self {
        Effort { on_branch: true, ..self }
    }
}

/// When a multistart search believes its best answer ([`super::repeated`]).
pub struct Stopping {
    /// Rounds that have to reach the best answer.
    pub hits: usize,
    /// Rounds that suffice if they only come near it.
    pub near_hits: usize,
    /// It also ends after so many independent rounds, if it has gone on for `quiet_times` as long as it took to come within
    /// a thousandth of its best answer.
    pub quiet_rounds: u64,
    /// See `quiet_rounds`.
    pub quiet_times: u64,
    /// Least number of batches.
    pub least_batches: u64,
    /// Batches without a new answer that end a search for further distinct answers.
    pub quiet_batches: u64,
}

/// Linkages with a slider; chosen by `cargo bench --bench sliders`.
pub mod sliders {
    use super::{Effort, Stopping};
    /// Rounds that run in parallel before any is read.
    pub const BATCH: u64 = 4;
    /// Batches that run before any search for four-bars, few since a batch without an exact answer takes four times as long as
    /// one with it; and before the whole search, which such an answer makes needless.
    pub const FIRST: u64 = 1;
    pub const GLIMPSE: u64 = 6;
    /// Shapes drawn in a round, the part of them whose crank turns fully, those fitted for a few steps, and to convergence.
    pub const DRAWS: usize = 240;
    pub const TURNING: f64 = 0.6;
    pub const SHORT: usize = 6;
    pub const LONG: usize = 2;
    pub const SHORT_FIT: Effort = Effort::of(15, 2);
    pub const LONG_FIT: Effort = Effort::of(200, 12);
    /// The mean square of the errors, in sizes of the target, below which a fit that has ended is led on to its last digits.
    pub const NEARLY: f64 = 1e-10;
    /// The part of their size by which the unknowns of starts that are fitted to convergence differ.
    pub const APART: f64 = 0.1;
    /// The mean square of the errors, in sizes of the target, at which a short fit is led to its end before others begin.
    pub const PROMISING: f64 = 1e-8;
    /// After the first batch one round in so many begins near known answers: the best of them, how many changes are drawn, and
    /// the least and largest relative change of an unknown.
    pub const HOP_EVERY: u64 = 4;
    pub const HOP_FROM: usize = 12;
    pub const HOPS: usize = 60;
    pub const HOP: (f64, f64) = (0.03, 0.8);
    /// Of a motion: sets of four poses whose slider is taken in a round, and lines that are drawn.
    pub const FOURS: usize = 6;
    pub const ACROSS: usize = 6;
    /// Of a function: offsets that are drawn in a round, and the crank's offsets of the first one.
    pub const OFFSETS: usize = 40;
    pub const TURNS: usize = 12;
    /// Scales of a function that a round draws where one of its ranges is free.
    pub const SCALES: usize = 8;
    /// Batches of families of exact answers.
    pub const FAMILY_BATCHES: u64 = 6;
    /// Candidates fitted on to the last digit at the end, at least, and the effort of each.
    pub const LEAST_POLISHED: usize = 8;
    pub const POLISH: Effort = Effort::of(5000, 40);
    /// When the best answer is believed. Arcs of sliders resemble each other: with eight hits 4 in 100 open curves end at a
    /// false optimum, with sixteen 1 (`cargo bench --bench sliders -- open`).
    pub const STOPPING: Stopping = Stopping {
        hits: 16,
        near_hits: 32,
        quiet_rounds: 60,
        quiet_times: 4,
        least_batches: 6,
        quiet_batches: 6,
    };
    /// Candidates kept.
    pub const KEPT: usize = 64;
}

/// The phases of a plan. No benchmark chooses them: they divide the budget of a problem for which the local searches
/// find nothing acceptable.
pub mod plan {
    /// The part of the budget that `auto` gives to local searches if these find nothing acceptable.
    pub const LOCAL_SHARE: f64 = 0.6;
    /// If local searches end with nothing acceptable, one part in this many of the evaluations left goes to searches
    /// without one of the requirements (`relaxed`), and the rest to differential evolution.
    pub const RELAXED_SHARE: u64 = 2;
    /// One part in this many of the evaluations for differential evolution goes to the polish of its best.
    pub const POLISH_SHARE: u64 = 5;
    /// A search for several kinds first looks for an exact four-bar with so many evaluations, and for an exact linkage with a
    /// slider with one part in `GLIMPSE_SHARE` of its evaluations. `cargo bench --bench sliders -- mixed` chooses them.
    pub const GLIMPSE: u64 = 6000;
    pub const GLIMPSE_SHARE: u64 = 4;
    /// Number of the other candidates found around a far target's own centre that are brought back to the target.
    pub const FAR_OTHERS: usize = 32;
    /// The part of the patience for the reduced form of prescribed timing, before rounds in the physical parameters.
    pub const REDUCED_SHARE: f64 = 0.5;
}

/// The canonical frame of free timing; no benchmark chooses them.
pub mod frame {
    /// Number of the other candidates that are taken back to the caller's frame.
    pub const OTHERS: usize = 48;
    /// Root mean square of the errors, in sizes of the target, up to which a candidate is fitted again to the target
    /// as it was given: beyond it the grid costs less than a part in 1e12 of the sum of squares.
    pub const NOTICED: f64 = 1e-5;
    /// Most evaluations of such a fit.
    pub const POLISH: u64 = 40;
    /// At most one part in this many of a budget is kept for them.
    pub const SHARE: u64 = 50;
}

/// Fits, and the rounds of prescribed timing in the physical parameters. `benches/recovery` has no prescribed timing:
/// no benchmark chooses them.
pub mod multistart {
    use super::Effort;

    /// Starts drawn and screened in a round.
    pub const SCREEN: usize = 160;
    /// Starts fitted for a few steps.
    pub const SHORT: usize = 8;
    /// Starts fitted to convergence.
    pub const LONG: usize = 3;
    /// The same of the starts that the task suggests.
    pub const SUGGESTED_SHORT: usize = 32;
    pub const SUGGESTED_LONG: usize = 8;
    /// The effort of a short fit.
    pub const SHORT_FIT: Effort = Effort::of(24, 2);
    /// The effort of a long fit.
    pub const LONG_FIT: Effort = Effort::of(300, 14);
    /// The effort that brings positions to their nearest points at a fixed design.
    pub const SETTLING: Effort = Effort::of(60, 1);
}

/// The batches of rounds in the physical parameters; no benchmark chooses them.
pub mod rounds {
    /// Rounds that run in parallel before any is read: the same number for any number of threads.
    pub const BATCH: u64 = 8;
    /// The same of a function, whose starts are better.
    pub const FUNCTION_BATCH: u64 = 2;
    /// Rounds that have to reach the best answer of a function: the first round has starts near all of them.
    pub const FUNCTION_HITS: usize = 4;
    /// Least number of batches, so that rarer answers have their chance, and batches without a new answer that end a
    /// search for further distinct answers.
    pub const LEAST_BATCHES: u64 = 3;
    pub const QUIET_BATCHES: u64 = 6;
    /// Number of candidates kept while searching; the worst are dropped beyond it.
    pub const KEPT: usize = 400;
}

/// Poses of a body with free timing: `benches/motion` chooses them.
pub mod motion {
    use super::Stopping;

    /// Rounds that run in parallel before any is read.
    pub const BATCH: u64 = 2;
    /// Places a side of the map of circle errors, and its reach in sizes of the target; the most minima taken.
    pub const GRID: usize = 61;
    pub const REACH: f64 = 2.5;
    pub const MINIMA: usize = 6;
    /// Places along a line of pivots at which the best dyad is compared with its neighbours.
    pub const ON_LINE: usize = 200;
    /// Sets of five poses in the first round and in a later one.
    pub const SETS_FIRST: usize = 3;
    pub const SETS_LATER: usize = 2;
    /// Dyads of a round at least; what is missing is drawn.
    pub const PINS: usize = 7;
    /// Starts fitted for a few steps, and to convergence.
    pub const SHORT: usize = 8;
    pub const LONG: usize = 3;
    /// Ends beyond these fitted to convergence whose points have strayed, if they are better.
    pub const ASTRAY: usize = 1;
    /// When the best answer is believed.
    pub const STOPPING: Stopping = Stopping {
        hits: 6,
        near_hits: 12,
        quiet_rounds: 40,
        quiet_times: 5,
        least_batches: 3,
        quiet_batches: 8,
    };
    /// One round in so many starts near the best known answers: so many of them, and so many starts.
    pub const NEAR_EVERY: u64 = 4;
    pub const LEADERS: usize = 4;
    pub const NEAR: usize = 12;
    /// Of the others one in so many crosses dyads of known answers with others: the pairs drawn, of which `SHORT` are
    /// fitted.
    pub const CROSSED_EVERY: u64 = 3;
    pub const CROSSED: usize = 24;
    /// The other dyads of a crossing: pins drawn, pins beside known ones with the least and greatest distance in sizes, and
    /// the most minima of the map of a known answer's own poses with its places a side.
    pub const CROSSED_PINS: usize = 6;
    pub const BESIDE: usize = 6;
    pub const BESIDE_BETWEEN: (f64, f64) = (0.02, 2.0);
    pub const CROSSED_MINIMA: usize = 6;
    pub const CROSSED_GRID: usize = 41;
    /// The weight of a pose that has to be met exactly, in parts of its own.
    pub const EXACT_WEIGHT: f64 = 3e4;
    /// Number of candidates kept while searching.
    pub const KEPT: usize = 200;
    /// Families of exact answers: dyads of a round, and batches.
    pub const FAMILY_PINS: usize = 40;
    pub const FAMILY_BATCHES: u64 = 6;
    /// The most exact answers that are led to better transmission angles; the first and the least step, degrees.
    pub const CLIMBED: usize = 8;
    pub const CLIMB_DEG: f64 = 8.0;
    pub const CLIMB_LEAST_DEG: f64 = 0.01;
}

/// Prescribed timing by variable projection, in its reduced form; no benchmark chooses them.
pub mod variable_projection {
    /// Draws in a batch.
    pub const DRAWS: usize = 128;
    /// Draws fitted for a few steps.
    pub const SHORT: usize = 8;
    /// Draws fitted to convergence.
    pub const LONG: usize = 3;
    /// Most evaluations of a short and of a long fit.
    pub const SHORT_EVALUATIONS: u32 = 10;
    pub const LONG_EVALUATIONS: u32 = 100;
    /// Most ends polished in a batch.
    pub const POLISHES: usize = 2;
    /// Draws screened with their violation, fitted for a few steps and fitted to convergence under all requirements, if
    /// requirements are active.
    pub const PROMISING: usize = 256;
    pub const CONSTRAINED_SHORT: usize = 6;
    pub const CONSTRAINED_LONG: usize = 2;
    /// Least number of waves with such fits, if requirements are active.
    pub const BINDING_WAVES: u64 = 4;
    /// Batches that run in parallel.
    pub const WAVE: u64 = 2;
    /// Least number of waves if several answers are wanted, and waves without a new answer that end the search for
    /// more.
    pub const LEAST_WAVES: u64 = 12;
    pub const QUIET_WAVES: u64 = 24;
    /// Number of candidates kept while searching.
    pub const KEPT: usize = 400;
}

/// Free timing: chosen by `benches/recovery`, whose targets are dense; those for sparse targets have no benchmark.
pub mod free {
    use super::Effort;
    use crate::synthesis::free::explorations::PerPoints;

    /// Number of different ends near which later rounds start.
    pub const LEADING: usize = 12;
    /// Relative difference of merits below which ends on the explored points are the same.
    pub const DIFFERENT: f64 = 1e-3;
    /// Rounds that run in parallel before any is read.
    pub const BATCH: u64 = 8;
    /// Rounds of a batch after which a search for one answer may end: of the first if the errors are noise, and of the last of
    /// `LEAST_BATCHES` and later ones if the target is sparse and of few points.
    pub const HALF_BATCH: u64 = 4;
    /// Relative difference below which errors of noise are equally good: the noise of n points has a sum of squares
    /// with a relative spread of (2/n)^(1/2).
    pub const IN_NOISE: f64 = 1.5e-2;
    /// Rounds with equally good answers that suffice if the errors are noise and several answers are wanted, and the least
    /// number of evaluations then. Chosen by the ladder test.
    pub const NOISE_HITS: usize = 4;
    pub const NOISE_EVALUATIONS: u64 = 60_000;
    /// Such rounds if one answer is wanted; two suffice if so many independent rounds have run.
    pub const NOISE_HITS_FOR_ONE: usize = 3;
    pub const NOISE_ROUNDS_FOR_ONE: usize = 16;
    /// The share of the sum of squares that is the scatter of the points about the means of their groups: above it the
    /// scatter is noise. And the most ends that are finished after a wave of rounds then. Chosen by `benches/recovery`.
    pub const NOISE_SCATTER: f64 = 0.3;
    pub const FINISHED_IN_NOISE: usize = 3;
    /// The part of the evaluations of a round that is cut short, one in so many, that its ends are finished with.
    pub const FINISHING: u64 = 4;
    /// Least number of batches for a sparse target.
    pub const LEAST_BATCHES: u64 = 2;
    /// Batches in which a round on a dense target fits only its best start further.
    pub const DENSE_BATCHES: u64 = 4;
    /// Least number of batches for a dense target whose errors are small and not noise.
    pub const PATIENT_BATCHES: u64 = 60;
    /// The rms error, in sizes of the target, up to which errors are small.
    pub const SMALL: f64 = 3e-5;
    /// The factor of sums of squares up to which they are on one level: errors that differ by 1 %. Chosen by
    /// `benches/strokes`, as those that follow.
    pub const LEVEL: f64 = 1.02;
    /// Independent rounds that came to the level; least number of evaluations, and evaluations as a multiple of those that
    /// it took to reach the level.
    pub const LEVEL_HITS: usize = 4;
    pub const LEVEL_LEAST: u64 = 120_000;
    pub const LEVEL_TIMES: u64 = 3;
    /// Rounds that came to the level with which this least number of evaluations is enough.
    pub const MANY_HITS: usize = 12;
    pub const MANY_LEAST: u64 = 80_000;
    /// The least number of evaluations and their multiple if few rounds came to the level.
    pub const QUIET_LEAST: u64 = 160_000;
    pub const QUIET_TIMES: u64 = 4;
    /// The rms error, in sizes of the target, below which errors that look like noise may be a small misfit.
    pub const NOISE_LEAST: f64 = 2e-3;
    /// Correlation of the errors of neighbouring points above which they are not noise.
    pub const ALIKE: f64 = 0.3;
    /// Of `WHOLE_EVERY` batches on a dense target of at most `WHOLE_MOST` points one explores all of its points: the
    /// fourth if the errors are noise, else the second.
    pub const WHOLE_EVERY: u64 = 8;
    pub const WHOLE_IN_NOISE: u64 = 3;
    pub const WHOLE_ELSE: u64 = 1;
    pub const WHOLE_MOST: usize = 200;
    /// Of `CORNERS_EVERY` batches on a dense target one, this one, explores a point of each group in place of the means,
    /// unless the errors are noise.
    pub const CORNERS_EVERY: u64 = 4;
    pub const CORNERS_AT: u64 = 2;
    /// The least number of points of a target of which linkages under stricter requirements are explored.
    pub const STRICT_LEAST: usize = 16;
    /// Of so many batches one, at its place in them, explores linkages with at least the worst transmission angle
    /// [`STRICT_DEG`], and one linkages whose crank turns fully, unless the errors are noise: (how many, both places).
    pub const STRICTER: (u64, u64, u64) = (4, 3, 1);
    pub const DENSE_STRICTER: (u64, u64, u64) = (8, 3, 7);
    pub const STRICT_DEG: f64 = 30.0;
    /// The batch that explores linkages whose crank turns fully if the errors are noise.
    pub const TURNING_IN_NOISE: u64 = 1;
    /// The batch that explores all points of them then, if several answers are wanted. Chosen by the ladder test.
    pub const TURNING_WHOLE_IN_NOISE: u64 = 5;
    /// The shares of the evaluations if the errors are neither noise nor nearly exact: of the explorations under the
    /// problem's own requirements, with at least [`STRICT_DEG`], and with a crank that turns fully. Chosen by
    /// `benches/strokes` and the ladder test.
    pub const SHARES: PerPoints = PerPoints { first: 3, corners: 2, whole: 1 };
    pub const STRICT_SHARES: PerPoints = PerPoints { first: 5, corners: 3, whole: 3 };
    pub const TURNING_SHARES: PerPoints = PerPoints { first: 1, corners: 0, whole: 0 };
    /// Batches of each stricter exploration, before a search whose errors are neither exact nor noise may end: at least, and
    /// at most if their own best is not believed. Of a dense target so many. Chosen by the ladder test, and for dense
    /// targets by `benches/strokes`.
    pub const CONFIRMING: (u64, u64) = (3, 12);
    pub const DENSE_CONFIRMING: PerPoints = PerPoints { first: 2, corners: 1, whole: 1 };
    /// Batches without a new distinct answer that end a search for further ones.
    pub const QUIET_BATCHES: u64 = 6;
    /// Number of ends kept.
    pub const KEPT: usize = 400;
    /// Number of points below which a target is not matched with the atlas.
    pub const LEAST_MATCHED: usize = 24;
    /// Of so many rounds the last starts near known ends, and on a target of fewer than `STRICT_LEAST` points, where it was
    /// chosen, as the number of starts drawn, by the time of L10 and P12. `benches/sparse` tells what it does to errors:
    /// with more points it is paid for with wrong beliefs.
    pub const HOP_EVERY: u64 = 2;
    pub const FEW_HOP_EVERY: u64 = 4;
    /// Starts drawn and screened in a round.
    pub const SCREEN: usize = 160;
    pub const FEW_SCREEN: usize = 64;
    /// Matches of the atlas taken in a round.
    pub const MATCHED: usize = 48;
    /// Starts near a known end taken in a round.
    pub const JITTERED: usize = 40;
    /// Starts fitted for a few steps.
    pub const SHORT: usize = 16;
    pub const DENSE_SHORT: usize = 10;
    /// Starts fitted further. On a dense target most lead to the same end: at first one per round, and more rounds.
    pub const MIDDLE: usize = 3;
    pub const DENSE_MIDDLE: usize = 1;
    /// The same after the first batch of a dense target whose errors are not noise. Chosen by `benches/strokes`.
    pub const SHAPE_MIDDLE: usize = 2;
    /// Most passes that reassign the points of an end to the curve and fit again.
    pub const REASSIGNED: usize = 6;
    /// Greatest merit after a few steps, in units of the strayed end's merit, at which such a fit is continued.
    pub const WORTH_LEADING_BACK: f64 = 16.0;
    /// The factor of the best merit on the explored points above which an end is not finished if one answer is wanted.
    pub const WORTH_FINISHING: f64 = 4.0;
    pub const DENSE_WORTH_FINISHING: f64 = 2.0;
    /// The same if several answers are wanted.
    pub const SEVERAL_WORTH_FINISHING: f64 = 9.0;
    /// The factor of the best merit above which the last digits of an end do not matter, unless its rms error is below
    /// `NEARLY_EXACT` sizes: it may be on its way to an exact answer.
    pub const WORTH_DIGITS: f64 = 4.0;
    pub const DENSE_WORTH_DIGITS: f64 = 1.3;
    pub const NEARLY_EXACT: f64 = 1e-3;
    /// Relative differences of merits on the explored points, which are found within some 1e-5, below which an end is counted
    /// as another one, and below which it is not finished beside it.
    pub const SAME_END: f64 = 3e-5;
    pub const ALIKE_ENDS: f64 = 3e-4;
    /// The efforts of short fits and of longer ones; ends are finished by [`super::multistart::LONG_FIT`].
    pub const SHORT_FIT: Effort = Effort::of(16, 2).until(1e-4);
    /// The effort of fits further to an end on the explored points.
    pub const MIDDLE_FIT: Effort = Effort::of(100, 6).until(1e-6);
    /// Range of random steps away from a known end, in parts of a length or of the target's size.
    pub const JITTER: (f64, f64) = (0.01, 0.5);
    /// Range of the factor of the difference that is added.
    pub const DIFFERENCE: (f64, f64) = (-1.0, 1.0);
    /// Most evaluations of a fit from a start that was led back to a type whose points cannot stray: if the type binds,
    /// the linkage is almost a change point, and not worth more.
    pub const LED_BACK_MOST: u64 = 600;
    /// The factor of the best error up to which such a fit goes on.
    pub const GOES_ON: f64 = 1.02;
}

/// Coarsening of dense targets with free timing: chosen by `benches/recovery`, whose targets have 60 and 360 points.
pub mod coarse {
    /// The number of points above which a target is explored in groups.
    pub const DENSE: usize = 48;
    /// Number of groups.
    pub const GROUPS: usize = 32;
    /// Distance of a point of a group from the chord between the group's neighbours, in parts of the chord, from which it
    /// is a corner.
    pub const CORNER: f64 = 0.2;
}

/// Population searches. `benches/population` compares them; no benchmark chooses these constants.
pub mod population {
    /// Number of points from which a stop is checked before each evaluation. With fewer, a generation takes a fraction
    /// of a second, and a stop waits for its end.
    pub const LONG_TARGET: usize = 1000;
    /// Number of individuals of the last population that are examined for distinct answers.
    pub const KEPT: usize = 20;
}

/// The polish of candidates; no benchmark chooses them.
pub mod polish {
    /// Number of different optima of the sum of squares that are polished: the best largest deviation need not lie in
    /// the best of them.
    pub const BASINS: usize = 24;
    /// The same of a function, whose basins are few; and the optima around which hops start.
    pub const FUNCTION_BASINS: usize = 5;
    pub const FUNCTION_HOPPED: usize = 1;
    /// Least number of distinct optima to find before they are polished.
    pub const LEAST_BASINS: usize = 8;
    /// Most steps of a polish.
    pub const STEPS: usize = 150;
    /// Local random restarts (hops) for the largest deviation: the optima around which they start, starts around each,
    /// their reach (in trust boxes; for a long link a tenth of it counts), the most rounds, and the rounds without
    /// improvement that end them.
    pub const HOPPED: usize = 3;
    pub const HOPS: usize = 4;
    pub const HOP: f64 = 0.4;
    pub const MAX_HOPS: u64 = 4;
    pub const QUIET_HOPS: usize = 2;
    /// Relative difference of largest deviation and link ratio below which starts are the same.
    pub const SAME_START: f64 = 1e-2;
    /// Relative difference of largest deviations below which they are the same optimum.
    pub const SAME_DEVIATION: f64 = 1e-6;
    /// Most evaluations of a polish.
    pub const EVALUATIONS: u64 = 400;
    /// One part in this many of a budget is reserved for polishing, if the objective or the tolerances need it.
    pub const SHARE: u64 = 5;
    /// Largest deviation, in parts of the tolerances, below which least squares has enough room between them.
    pub const INSIDE: f64 = 0.98;
}

/// Searches without one of the requirements; no benchmark chooses them.
pub mod relaxed {
    /// Ends of a relaxed search that are judged by the problem itself: judging takes the whole curve of each.
    pub const JUDGED: usize = 48;
    /// Ends of a relaxed search that are fitted under all requirements, the most promising first.
    pub const FITTED: usize = 12;
    /// One part in this many of the evaluations of a relaxed search goes to those fits.
    pub const FIT_SHARE: u64 = 4;
    /// Least evaluations of a relaxed search: with fewer it finds nothing.
    pub const LEAST_SEARCH: u64 = 1000;
}

/// The search for a buildable candidate; no benchmark chooses them.
pub mod buildable {
    use super::Effort;

    /// The second search uses one part in `SHARE` of the evaluations of the first, or `LEAST` if that is more, but never
    /// more than the first.
    pub const SHARE: u64 = 8;
    pub const LEAST: u64 = 20_000;
    /// The most evaluations of the search for linkages with a slider beside a four-bar on the limit of its link ratio.
    pub const SLIDERS: u64 = 20_000;
    /// Rounds that have to reach the best answer of the second search.
    pub const HITS: usize = 4;
    /// Rounds without a better answer after which the second search ends.
    pub const QUIET: usize = 24;
    /// Rounds per parallel batch: the same number for any number of threads.
    pub const BATCH: u64 = 8;
    /// Distinct answers of the main search that the second one starts from.
    pub const WARM: usize = 8;
    /// Factors of the shortest link for the starts from each answer. On the boundary between two types, where the links
    /// align, there is no derivative, and a solver does not move from there.
    pub const SHORTER: [f64; 3] = [1.0, 0.9, 0.5];
    /// The transmission angle (degrees; or the problem's limit, if that is larger) that starts with a shorter link meet
    /// first, so that they approach the limit from inside.
    pub const STRICT_DEG: f64 = 30.0;
    /// The effort of that first fit.
    pub const STRICT_FIT: Effort = Effort::of(100, 6);
    /// The share of the allowed evaluations for the warm starts, and the share reserved for the move away from a change
    /// point.
    pub const WARM_SHARE: f64 = 0.5;
    pub const LAST_SHARE: f64 = 0.1;
    /// Degrees by which the limit of the transmission angle is raised in that move, and the number of bisections of the
    /// least raise that suffices.
    pub const RAISES: [f64; 5] = [1.0, 3.0, 8.0, 18.0, 35.0];
    pub const HALVINGS: usize = 5;
    /// Number of the best candidates from which that move is made, until one of them needs no move.
    pub const MOST_FROM: usize = 3;
}

/// Fits under tightened limits; chosen by `benches/strokes`, which compares the picks with fronts.
pub mod tightened {
    /// Most evaluations of a fit.
    pub const EVALUATIONS: u64 = 600;
    /// Most evaluations of its polish for the largest deviation or for tolerances.
    pub const FINISH: u64 = 60;
    /// The largest error, in parts of the largest tolerance, above which the polish for tolerances does not begin.
    pub const HOPELESS: f64 = 5.0;
}

/// The picks beside the closest candidate; chosen by `benches/strokes`.
pub mod picks {
    /// The most distinct candidates from which limits are tightened, and how many of them run before their results are
    /// read.
    pub const STARTS: usize = 4;
    pub const WAVE: usize = 2;
    /// First steps: of the logarithm of the extent, and of the transmission angle in degrees.
    pub const STEP_PART: f64 = 0.2;
    pub const STEP_DEG: f64 = 8.0;
    /// The step, in parts of the first, at which bisection ends; and most steps from one start.
    pub const LEAST_STEP: f64 = 0.1;
    pub const STEPS: usize = 10;
    /// The evaluations of a search anew beyond the best one, the number of its answers, and the most such searches.
    pub const SEARCH: u64 = 2000;
    pub const ANSWERS: usize = 3;
    pub const ANEW: usize = 2;
    /// Differences of the logarithm of the extent, and of the transmission angle in degrees, up to which they are the same:
    /// less than `verify` tells apart.
    pub const SAME_PART: f64 = 5e-7;
    pub const SAME_DEG: f64 = 5e-5;
    /// The smallest leaves one part in this many of the evaluations to the best transmitting one, and that one to the
    /// fits without limits.
    pub const FOR_TRANSMISSION: u64 = 2;
    pub const FOR_LOOSENED: u64 = 8;
}

/// The front; chosen by `benches/front`.
pub mod front {
    use super::Effort;

    /// The rms error of a member at most, in sizes of the target: beyond it a curve is no drawing of the target.
    pub const MOST_ERROR: f64 = 0.3;
    /// Distinct answers of the search that are fitted under the first combinations of limits: these angles, and these
    /// parts of the closest linkage's lengths.
    pub const SEEDS: usize = 3;
    pub const ANCHOR_DEG: [f64; 3] = [25.0, 40.0, 55.0];
    pub const ANCHOR_PARTS: [f64; 3] = [0.7, 0.5, 0.35];
    /// Searches anew under tightened limits: lengths at most these parts of the target's size, angles at least this, both
    /// together, and a large angle with the greater length and alone; the evaluations of each, and how many of its answers are kept.
    pub const COMPACT: [f64; 2] = [1.1, 1.7];
    pub const STEEP_DEG: f64 = 45.0;
    pub const STEEPEST_DEG: f64 = 75.0;
    pub const SEARCH: u64 = 4000;
    pub const ANSWERS: usize = 6;
    /// Gaps filled in a generation, and the distance on the scaled axes below which a gap is left.
    pub const GAPS: usize = 4;
    pub const LEAST_GAP: f64 = 0.08;
    /// The effort of fits before the last ones.
    pub const EFFORT: Effort = Effort::of(40, 5).until(1e-4);
    /// The effort of the last fits of the members.
    pub const LAST: Effort = Effort::of(120, 8).until(1e-9);
    /// Starts of a fit.
    pub const NEAREST: usize = 2;
    /// First steps of a push: in degrees, and of the logarithm of other figures; a push ends at this part of its first
    /// step.
    pub const PUSH_DEG: f64 = 6.0;
    pub const PUSH_PART: f64 = 0.2;
    pub const LEAST_PUSH: f64 = 0.05;
    /// Generations in a row that add at most this volume that end a front.
    pub const QUIET_GENERATIONS: u64 = 3;
    pub const QUIET_VOLUME: f64 = 1e-3;
    /// The most linkages kept.
    pub const MOST_KEPT: usize = 200;
    /// The least number of members fitted to the last digit, how many more than are asked for, and how often.
    pub const LEAST_MEMBERS: usize = 10;
    pub const SPARE: usize = 4;
    pub const FITS: usize = 1;
}

/// The trials of a conflict analysis; no benchmark chooses them.
pub mod conflicts {
    /// Most evaluations of a trial.
    pub const TRIAL: u64 = 20_000;
    /// A trial also uses at most one part in this many of the problem's own budget.
    pub const TRIAL_SHARE: u64 = 4;
    /// Budget of all trials, in trials: no new one begins once it is spent. (A proof is the whole search, and counted
    /// apart.)
    pub const ALLOWANCE: u64 = 40;
    /// A fit from a known candidate gets one part in this many of a trial: one that succeeds does so soon.
    pub const FIT_SHARE: u64 = 16;
    /// Most evaluations of a fit that starts from a design of a trial under all requirements of the problem: each is a
    /// convex program.
    pub const LED_IN: u64 = 150;
    /// Number of answers of a trial from which further fits start.
    pub const WARM: usize = 4;
    /// Most limits tried between the asked and the attained ones.
    pub const STEPS: usize = 30;
    /// Relative step below which the steps inward end.
    pub const SHORTEST_STEP: f64 = 0.02;
    /// Least relative step at which a short search is worth its cost.
    pub const SEARCHED_STEP: f64 = 0.2;
    /// Factor of the next step after one that succeeded, and after one that did not.
    pub const LONGER: f64 = 1.5;
    pub const SHORTER: f64 = 0.5;
    /// Evaluations of a search that confirms or refutes what trials found, in trials: at most those of the search that is
    /// explained.
    pub const CONFIRMING: u64 = TRIAL_SHARE;
    /// Most demands of a conflict that are tried at that length.
    pub const LONGER_TRIALS: usize = 3;
    /// Most proposals.
    pub const PROPOSALS: usize = 5;
}

/// The errors without a requirement; no benchmark chooses them.
pub mod errors_without {
    /// Most evaluations of the search without a requirement; one part in `SHORT_SHARE` of the evaluations of the search
    /// itself.
    pub const SHORT_SEARCH: u64 = 40_000;
    pub const SHORT_SHARE: u64 = 2;
}

/// Live fitting; no benchmark chooses them.
pub mod live {
    use super::Effort;

    /// The most candidates that follow the target.
    pub const FOLLOWING: usize = 5;
    /// The effort of a fit while the target moves: from so near a start, a few steps are enough to converge.
    pub const EFFORT: Effort = Effort::of(24, 4);
    /// Most evaluations of the cost in such a fit.
    pub const EVALUATIONS: u64 = 120;
    /// Most evaluations of a first look.
    pub const FIRST_LOOK: u64 = 3000;
    /// Evaluations of the first and of the second look for six-bars and eight-bars.
    pub const FIRST_LOOKS_OF_SEVERAL_LOOPS: [u64; 2] = [24_000, 80_000];
}

/// Snapping; no benchmark chooses them.
pub mod snap {
    /// Number of stock sizes tried for a length, the nearest to its fitted value.
    pub const NEAR: usize = 4;
    /// Width of the beam: partial choices kept in parallel.
    pub const BEAM: usize = 12;
    /// Number of complete choices whose neighbours are tried, and the most rounds of that.
    pub const IMPROVED: usize = 2;
    pub const ROUNDS: usize = 12;
    /// Most evaluations of a fit while choices are compared, and of the final ones.
    pub const QUICK: u64 = 60;
    pub const THOROUGH: u64 = 400;
    /// Number of answers that are fitted thoroughly besides those that are wanted.
    pub const SPARE: usize = 4;
}
