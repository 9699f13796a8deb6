//! Constants of the search for dyad chains. Counts were tuned on six curves (square, heart, figure-8, D, L, S) over several
//! seeds at 400,000 evaluations.

/// Points of a short fit; a target with at most half as many again is never thinned out.
pub(super) const FEW: usize = 48;

/// Chains drawn for an island. With 6,000 the square's median of six seeds was 0.024 of its radius, with these 0.014.
pub(super) const DRAWS: usize = 20_000;
/// Draws that are correlated exactly with the target.
pub(super) const PREFILTERED: usize = 3200;
/// Starts that are fitted briefly, those that are fitted on, and those that are fitted to all points.
pub(super) const CASCADE: [usize; 3] = [400, 67, 22];
/// Trial steps of the first two stages.
pub(super) const FIRST_STEPS: usize = 15;
pub(super) const SECOND_STEPS: usize = 60;
/// Trial steps of a fit to all points, before and after its points are assigned anew.
pub(super) const FULL_STEPS: [usize; 2] = [60, 30];
/// Draws that count as one evaluation: about the ratio of their times.
pub(super) const DRAWS_PER_EVALUATION: u64 = 2;
/// Evaluations that an assignment of all points counts for, likewise.
pub(super) const ASSIGNMENT_COSTS: u64 = 3;

/// Evaluations that an island's start costs at most, in full; the last fits of a search, each; and a round of hops.
pub(super) const FOUNDING: u64 = DRAWS as u64 / DRAWS_PER_EVALUATION
    + (CASCADE[0] * FIRST_STEPS
        + CASCADE[1] * (SECOND_STEPS + ASSIGNMENT_COSTS as usize)
        + CASCADE[2] * (FULL_STEPS[0] + FULL_STEPS[1] + ASSIGNMENT_COSTS as usize)) as u64;
pub(super) const ROUND: u64 =
    JOBS * (HOPS * (2 * HOP_STEPS + 2 * ASSIGNMENT_COSTS as usize + FULL_STEPS[0] + FULL_STEPS[1])) as u64;
/// The least share of an island's start that is run where the evaluations do not suffice for all of it.
pub(super) const LEAST_SHARE: f64 = 0.01;

/// Distinct ends that an island keeps, and hops start from.
pub(super) const POOL: usize = 24;
/// Jobs of a round, which may run on as many threads, and hops of each.
pub(super) const JOBS: u64 = 16;
pub(super) const HOPS: usize = 2;
/// Trial steps of a hop before and after its points are assigned anew.
pub(super) const HOP_STEPS: usize = 12;
/// Range of the deviation of a hop's parameters, drawn evenly in the logarithm.
pub(super) const HOP_REACH: (f64, f64) = (0.03, 0.8);
/// A hop is given up if its value is more than this many times the best one's, after its first and after its second fit.
pub(super) const HOPELESS: f64 = 30.0;
pub(super) const PROMISING: f64 = 2.0;
/// Relative difference of all parameters below which a hop fell back to a known end.
pub(super) const NEAR: f64 = 0.03;
/// An island ends after as many evaluations without a fall of the value by [`IMPROVED`], or after as many again as it took
/// to its last improvement.
pub(super) const PATIENCE: u64 = 20_000;
pub(super) const IMPROVED: f64 = 0.02;

/// Relative fall of the value below which a step is idle, of fits to few and to all points, and of the last fit.
pub(super) const IDLE: f64 = 1e-3;
pub(super) const IDLE_FULL: f64 = 1e-4;
pub(super) const IDLE_LAST: f64 = 1e-7;
/// Trial steps of the last fit.
pub(super) const LAST_STEPS: usize = 100;

/// Weights a point of the squares of cosines beyond their limit, of logarithms of lengths, and of distances of pivots from
/// their box; and what they are multiplied by in the last fit, so that the limits are met.
pub(super) const COSINE_WEIGHT: f64 = 4.0;
pub(super) const SIZE_WEIGHT: f64 = 0.05;
pub(super) const PIVOT_WEIGHT: f64 = 0.05;
pub(super) const LAST_COSINES: f64 = 300.0;
pub(super) const LAST_SIZES: f64 = 30_000.0;
/// Weight a point of the squares of what is held, to which each trial is brought back before it is valued.
pub(super) const HELD_WEIGHT: f64 = 1e6;
/// Newton steps by which a start, and each trial, are brought to what is held.
pub(super) const HELD_STEPS: [usize; 2] = [40, 4];
/// Fits keep this far within the limits: radians, logarithms of lengths, shares of the rms radius.
pub(super) const WITHIN_ANGLE: f64 = 2e-3;
pub(super) const WITHIN_SIZE: f64 = 1e-3;

/// Relative difference of values below which ends of one kind are one.
pub(super) const SAME: f64 = 1e-3;
/// Mean squares below which ends are exact, and equal if of one kind; in units of the mean square radius.
pub(super) const EXACT: f64 = 1e-20;
/// Mean square below which the search ends.
pub(super) const ENOUGH: f64 = 1e-24;
