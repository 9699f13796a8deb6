//! The parts of a population search: a problem, individuals, their order, and generations of them.
//!
//! The problem is: minimise f(x) over the box `lower_j <= x_j <= upper_j`, subject to constraints that the problem has
//! gathered into one number, the violation v(x) >= 0, zero where all hold. Two points are compared by the feasibility
//! rules of Deb (2000), which need no penalty weight:
//!
//! 1. a feasible point (v = 0) is better than an infeasible one;
//! 2. of two feasible points, the one with the lower f is better;
//! 3. of two infeasible points, the one with the lower v is better, whatever f is.
//!
//! Ties fall to the lower index. With that, and with every random number drawn before a generation is evaluated,
//! a search gives the same digits on any number of threads.
//!
//! Source: K. Deb, "An efficient constraint handling method for genetic algorithms", Computer Methods in Applied
//! Mechanics and Engineering 186 (2000).

use super::exact_float;
use linkwright_arithmetic::streams::{Stream, uniform};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::cmp::Ordering;

/// An optimisation problem for population searches.
pub trait PopulationProblem: Sync {
    /// Returns the box: one pair (lower, upper) per gene, finite, lower < upper. It must not change during a search.
    fn bounds(&self) -> &[(f64, f64)];

    /// Computes the fitness at `x`, which has as many genes as the box and lies in it.
    ///
    /// A pure function, called from several threads at once; it should not allocate.
    fn evaluate(&self, x: &[f64]) -> Fitness;

    /// Returns a rough time for one evaluation in nanoseconds, which decides whether a generation is shared among
    /// threads. Zero, the default, means never. It changes the time but no digit of a result.
    fn cost_hint_ns(&self) -> f64 {
        0.0
    }
}

/// The fitness of a point: its violation of the constraints and its cost.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Fitness {
    /// The violation of the constraints, >= 0; zero means feasible. The unit is the problem's.
    #[serde(with = "exact_float")]
    pub violation: f64,
    /// The cost, which is minimised. It is ignored if the point is infeasible, and may then be NaN.
    #[serde(with = "exact_float")]
    pub cost: f64,
}

impl Fitness {
    /// The worst fitness, which an individual has before it is evaluated.
    pub const UNKNOWN: Self = Self { violation: f64::NAN, cost: f64::NAN };

    /// Creates the fitness of a feasible point.
    pub const fn feasible(cost: f64) -> Self {
        Self { violation: 0.0, cost }
    }

    /// Returns whether the point obeys all constraints. A NaN violation does not.
    pub fn is_feasible(&self) -> bool {
        self.violation <= 0.0
    }

    /// Returns the rank of a fitness, feasible before infeasible before unknown, and the number that decides within it:
    /// the cost of a feasible point, the violation of another.
    fn rank(&self) -> (u8, f64) {
        match (self.is_feasible(), self.violation.is_nan()) {
            (true, _) if !self.cost.is_nan() => (0, self.cost),
            (false, false) => (1, self.violation),
            _ => (2, 0.0),
        }
    }

    /// Compares by Deb's order, `Less` being better: feasible before infeasible, by cost among the feasible, by
    /// violation among the infeasible. A fitness whose deciding number is NaN comes after all others. A total order.
    ///
    /// ```
    /// # use linkwright_optimise::population::Fitness;
    /// let costly = Fitness { violation: 0.0, cost: 900.0 };
    /// let infeasible = Fitness { violation: 1e-3, cost: 1.0 };
    /// assert!(costly.compare(&infeasible).is_lt());
    /// assert!(infeasible.compare(&Fitness::feasible(f64::NAN)).is_lt());
    /// ```
    pub fn compare(&self, other: &Self) -> Ordering {
        let ((rank, number), (others, other)) = (self.rank(), other.rank());
        rank.cmp(&others).then(number.total_cmp(&other))
    }

    /// Returns whether `self` is better than `reference` by more than the share `relative` of the reference's
    /// deciding number.
    ///
    /// Becoming feasible, or known, or finite, always counts.
    pub fn improves_on(&self, reference: &Self, relative: f64) -> bool {
        let ((rank, new), (was, old)) = (self.rank(), reference.rank());
        self.compare(reference).is_lt()
            && (rank != was || !old.is_finite() || old - new > relative * old.abs())
    }
}

/// A point of the box with its fitness.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Individual {
    /// The genes, one for each pair of the problem's box.
    pub x: Vec<f64>,
    /// The fitness at `x`.
    pub fitness: Fitness,
}

impl Individual {
    /// Creates an individual of `genes` zeros, not evaluated, to write into.
    pub fn blank(genes: usize) -> Self {
        Self { x: vec![0.0; genes], fitness: Fitness::UNKNOWN }
    }
}

/// A mistake of the caller: an invalid box, start, limit or parameter.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PopulationError {
    /// The box has no genes.
    #[error("the box has no genes")]
    EmptyBox,
    /// A pair of the box is not an interval, or is out of range.
    #[error("gene {gene} has bounds [{lower}, {upper}]: need lower < upper, both within +-{WIDEST_BOUND:e}")]
    Bounds {
        /// Index of the gene, from zero.
        gene: usize,
        /// Its lower bound.
        lower: f64,
        /// Its upper bound.
        upper: f64,
    },
    /// A starting point has the wrong number of genes.
    #[error("start {start} has {genes} genes, the box has {expected}")]
    StartLength {
        /// Index of the start, from zero.
        start: usize,
        /// The number of its genes.
        genes: usize,
        /// The number of genes that it should have.
        expected: usize,
    },
    /// A starting point has a gene that is not finite.
    #[error("start {start} has {value} for gene {gene}: need a finite number")]
    StartNotFinite {
        /// Index of the start, from zero.
        start: usize,
        /// Index of the gene, from zero.
        gene: usize,
        /// Its value.
        value: f64,
    },
    /// The problem cannot be expressed in the variables that were asked for.
    #[error("{why}")]
    Form {
        /// The reason.
        why: String,
    },
    /// The executor of the search failed.
    #[error("{why}")]
    Executor {
        /// Its message.
        why: String,
    },
    /// The limit allows no evaluation at all.
    #[error("a limit of zero evaluations leaves nothing to search with")]
    NoEvaluations,
    /// A parameter of an algorithm is outside its domain.
    #[error("{name} = {value}: need {requirement}")]
    Parameter {
        /// The parameter's name, as it is written in a file.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Its domain.
        requirement: &'static str,
    },
}

impl PopulationError {
    /// Returns `Ok` if `holds`, else the error for the parameter `name`.
    ///
    /// # Errors
    /// [`PopulationError::Parameter`] if `holds` is false.
    pub fn require(
        holds: bool,
        name: &'static str,
        value: f64,
        requirement: &'static str,
    ) -> Result<(), Self> {
        if holds { Ok(()) } else { Err(Self::Parameter { name, value, requirement }) }
    }
}

/// The largest magnitude of a bound that is accepted: sums of a few differences of genes must not overflow.
pub const WIDEST_BOUND: f64 = 1e300;

/// Checks a box and the points that a search shall start from.
///
/// # Errors
/// [`PopulationError::EmptyBox`], [`Bounds`](PopulationError::Bounds),
/// [`StartLength`](PopulationError::StartLength) or [`StartNotFinite`](PopulationError::StartNotFinite), for the first
/// mistake found. A start outside the box is no mistake: it is moved to the nearest point of the box.
pub fn check_box(bounds: &[(f64, f64)], starts: &[Vec<f64>]) -> Result<(), PopulationError> {
    if bounds.is_empty() {
        return Err(PopulationError::EmptyBox);
    }
    let reach = -WIDEST_BOUND..=WIDEST_BOUND;
    for (gene, &(lower, upper)) in bounds.iter().enumerate() {
        if !(lower < upper && reach.contains(&lower) && reach.contains(&upper)) {
            return Err(PopulationError::Bounds { gene, lower, upper });
        }
    }
    for (start, x) in starts.iter().enumerate() {
        if x.len() != bounds.len() {
            return Err(PopulationError::StartLength { start, genes: x.len(), expected: bounds.len() });
        }
        if let Some((gene, &value)) = x.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(PopulationError::StartNotFinite { start, gene, value });
        }
    }
    Ok(())
}

/// A population algorithm, one generation at a time.
///
/// Everything between [`initialise`](Self::initialise) and the next one is determined by the problem, the starts and
/// the stream. An algorithm never evaluates more often than it is allowed to, and returns the number of evaluations;
/// a generation that the allowance cuts short evaluates its first members. The best individual never gets worse.
pub trait Generations {
    /// Returns a short name for people: "differential evolution".
    fn name(&self) -> &'static str;

    /// Returns the number of individuals of a whole population.
    fn size(&self) -> usize;

    /// Returns the number of individuals that a whole generation evaluates.
    fn offspring(&self) -> usize {
        self.size()
    }

    /// Begins a search at an evaluated population and forgets everything before it.
    fn begin(&mut self, stream: Stream, population: Vec<Individual>);

    /// Returns the next `count` individuals for evaluation.
    fn propose(&mut self, count: usize, bounds: &[(f64, f64)]) -> &mut [Individual];

    /// Selects the next population from the present one and the individuals proposed.
    fn select(&mut self, bounds: &[(f64, f64)]);

    /// Returns the present population, in no particular order; empty before [`initialise`](Self::initialise).
    fn population(&self) -> &[Individual];

    /// Returns whether the search has converged: the best has stalled or the population has collapsed.
    fn converged(&self) -> bool;

    /// Forgets everything and draws the first population: the `starts`, moved into the box, as far as they fit into
    /// a population, then points uniform in the box. Returns the number of evaluations, from 1 to `allowance`.
    ///
    /// # Panics
    /// If `allowance` is zero, or if [`check_box`] refuses the box or the starts.
    fn initialise(
        &mut self,
        problem: &dyn PopulationProblem,
        starts: &[Vec<f64>],
        mut stream: Stream,
        allowance: u64,
    ) -> u64 {
        let count = admitted(self.size(), allowance);
        let population = scatter(problem, starts, &mut stream, count);
        self.begin(stream, population);
        count as u64
    }

    /// Makes one generation. Returns the number of evaluations, from 1 to `allowance`.
    ///
    /// # Panics
    /// If `allowance` is zero, or if [`initialise`](Self::initialise) has not made a whole population.
    fn advance(&mut self, problem: &dyn PopulationProblem, allowance: u64) -> u64 {
        assert!(self.population().len() == self.size(), "advance needs a whole population");
        let count = admitted(self.offspring(), allowance);
        evaluate_generation(problem, self.propose(count, problem.bounds()));
        self.select(problem.bounds());
        count as u64
    }
}

/// Returns whether these are `size` points of the box.
pub fn lie_in(individuals: &[Individual], size: usize, bounds: &[(f64, f64)]) -> bool {
    individuals.len() == size && individuals.iter().all(|individual| lies_in(&individual.x, bounds))
}

/// Returns whether this is a point of the box.
pub fn lies_in(x: &[f64], bounds: &[(f64, f64)]) -> bool {
    x.len() == bounds.len() && x.iter().zip(bounds).all(|(x, (lower, upper))| (lower..=upper).contains(&x))
}

/// The amount of work, in nanoseconds, above which a generation is shared among threads; below it, waking the other
/// threads costs more than they save.
const PARALLEL_FROM_NS: f64 = 300_000.0;
/// The least work, in nanoseconds, that a thread takes at once: some ten times the cost of handing it over.
const PIECE_NS: f64 = 20_000.0;

/// Evaluates every individual in place, on the calling thread or, if the problem's hint says that it pays, on the
/// threads of the current rayon pool. The result is the same.
pub fn evaluate_generation(problem: &dyn PopulationProblem, generation: &mut [Individual]) {
    let hint_ns = problem.cost_hint_ns();
    let evaluate = |individual: &mut Individual| individual.fitness = problem.evaluate(&individual.x);
    if generation.len() as f64 * hint_ns > PARALLEL_FROM_NS && rayon::current_num_threads() > 1 {
        let piece = (PIECE_NS / hint_ns).ceil().max(1.0) as usize;
        generation.par_iter_mut().with_min_len(piece).for_each(evaluate);
    } else {
        generation.iter_mut().for_each(evaluate);
    }
}

/// Returns the best individual, the first in the order by (fitness, index); `None` for an empty slice.
pub fn best_of(individuals: &[Individual]) -> Option<&Individual> {
    // Of equal elements `min_by` returns the first.
    individuals.iter().min_by(|one, other| one.fitness.compare(&other.fitness))
}

/// Sorts individuals by (fitness, index), the best first.
pub fn sort_best_first(individuals: &mut [Individual]) {
    // A stable sort keeps equals in the order of their indices.
    individuals.sort_by(|one, other| one.fitness.compare(&other.fitness));
}

/// Returns the number of evaluations that an allowance admits, of `wanted`.
///
/// # Panics
/// If the allowance is zero.
fn admitted(wanted: usize, allowance: u64) -> usize {
    assert!(allowance > 0, "a generation needs an allowance of at least one evaluation");
    usize::try_from(allowance).map_or(wanted, |allowance| wanted.min(allowance))
}

/// Returns `count` evaluated individuals: first the starts, moved into the box, then points drawn uniformly from it.
fn scatter(
    problem: &dyn PopulationProblem,
    starts: &[Vec<f64>],
    stream: &mut Stream,
    count: usize,
) -> Vec<Individual> {
    let bounds = problem.bounds();
    let mut population = vec![Individual::blank(bounds.len()); count];
    for (index, individual) in population.iter_mut().enumerate() {
        match starts.get(index) {
            Some(start) => {
                for ((gene, &value), &(lower, upper)) in individual.x.iter_mut().zip(start).zip(bounds) {
                    *gene = value.clamp(lower, upper);
                }
            }
            None => draw_uniform(stream, bounds, &mut individual.x),
        }
    }
    evaluate_generation(problem, &mut population);
    population
}

/// Returns `count` individuals of `genes` genes to write into, in a buffer that is kept between generations.
pub fn resized(buffer: &mut Vec<Individual>, count: usize, genes: usize) -> &mut [Individual] {
    buffer.retain(|individual| individual.x.len() == genes);
    buffer.resize(count, Individual::blank(genes));
    buffer
}

/// Draws `x` uniformly from the box, gene by gene.
pub fn draw_uniform(stream: &mut Stream, bounds: &[(f64, f64)], x: &mut [f64]) {
    for (gene, &(lower, upper)) in x.iter_mut().zip(bounds) {
        *gene = uniform(stream, lower, upper);
    }
}

/// Computes the largest extent of a population along any gene, as a share of the box's width there: 0 when all
/// individuals are one point, 1 when they span the box.
pub fn spread(population: &[Individual], bounds: &[(f64, f64)]) -> f64 {
    let share = |(gene, (lower, upper)): (usize, &(f64, f64))| {
        let ends = population.iter().map(|individual| individual.x[gene]);
        let (least, most) = ends.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, m), x| (l.min(x), m.max(x)));
        (most - least) / (upper - lower)
    };
    bounds.iter().enumerate().map(share).fold(0.0, f64::max)
}

/// The least share by which the best must improve to count as progress: an answer that changes in the seventh digit
/// only is left to a local solver, which gains digits far more cheaply.
pub const STALL_IMPROVEMENT: f64 = 1e-6;

/// Stall detection: a counter of the generations since the best last made progress.
///
/// Progress is measured from the fitness at the last progress, so many small steps add up.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct StallWatch {
    reference: Fitness,
    idle_generations: u64,
}

impl StallWatch {
    /// Creates a watch that begins at the fitness `best`.
    pub const fn new(best: Fitness) -> Self {
        Self { reference: best, idle_generations: 0 }
    }

    /// Records the best fitness after one more generation.
    pub fn note(&mut self, best: Fitness) {
        if best.improves_on(&self.reference, STALL_IMPROVEMENT) {
            *self = Self::new(best);
        } else {
            self.idle_generations += 1;
        }
    }

    /// Returns the number of generations in which the best gained less than [`STALL_IMPROVEMENT`] altogether.
    pub const fn idle_generations(&self) -> u64 {
        self.idle_generations
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn any_fitness() -> impl Strategy<Value = Fitness> {
        let number = prop_oneof![Just(0.0), Just(f64::NAN), Just(f64::INFINITY), 0.0..2.0];
        (number.clone(), number).prop_map(|(violation, cost)| Fitness { violation, cost })
    }

    proptest! {
        #[test]
        fn the_order_of_fitnesses_is_total(a in any_fitness(), b in any_fitness(), c in any_fitness()) {
            prop_assert_eq!(a.compare(&b), b.compare(&a).reverse());
            if a.compare(&b).is_le() && b.compare(&c).is_le() {
                prop_assert!(a.compare(&c).is_le());
            }
        }
    }

    #[test]
    fn the_feasibility_rules_hold_and_nan_comes_last() {
        let infeasible = |violation| Fitness { violation, cost: f64::NAN };
        let mut ordered = [
            Fitness::UNKNOWN,
            infeasible(f64::INFINITY),
            infeasible(2.0),
            Fitness { violation: 1.0, cost: -1e9 },
            Fitness::feasible(f64::INFINITY),
            Fitness::feasible(3.0),
            Fitness::feasible(-3.0),
        ];
        let expected: Vec<_> = ordered.iter().rev().map(|fitness| format!("{fitness:?}")).collect();
        ordered.sort_by(Fitness::compare);
        let sorted: Vec<_> = ordered.iter().map(|fitness| format!("{fitness:?}")).collect();
        assert_eq!(sorted, expected);
        assert!(infeasible(5.0).compare(&Fitness::feasible(f64::NAN)).is_lt());
    }

    #[test]
    fn of_equals_the_first_is_best() {
        let at = |x: f64, cost| Individual { x: vec![x], fitness: Fitness::feasible(cost) };
        let individuals = [at(0.0, 2.0), at(1.0, 1.0), at(2.0, 1.0)];
        assert_eq!(best_of(&individuals), Some(&individuals[1]));
        assert_eq!(best_of(&[]), None);
    }

    #[test]
    fn small_gains_add_up_to_progress_and_none_at_all_to_a_stall() {
        let mut watch = StallWatch::new(Fitness::feasible(1.0));
        for step in 1..=10 {
            watch.note(Fitness::feasible(1.0 - 0.3e-6 * f64::from(step)));
        }
        // Progress at steps 4 and 8, since the gain must exceed one part in a million.
        assert_eq!(watch.idle_generations(), 2);
        watch.note(Fitness::feasible(1.0 - 3.0e-6));
        assert_eq!(watch.idle_generations(), 3);
    }

    #[test]
    fn becoming_feasible_or_finite_is_progress_at_any_cost() {
        let infeasible = Fitness { violation: 1e-12, cost: 0.0 };
        assert!(Fitness::feasible(1e300).improves_on(&infeasible, 0.5));
        assert!(Fitness::feasible(1.0).improves_on(&Fitness::feasible(f64::INFINITY), 0.5));
        assert!(infeasible.improves_on(&Fitness::UNKNOWN, 0.5));
        assert!(!Fitness::UNKNOWN.improves_on(&infeasible, 0.5));
    }

    #[test]
    fn mistakes_in_the_box_and_the_starts_are_named() {
        let unit = [(0.0, 1.0)];
        assert_eq!(check_box(&[], &[]), Err(PopulationError::EmptyBox));
        for (lower, upper) in [(1.0, 1.0), (0.0, f64::INFINITY), (-1e301, 0.0)] {
            let error = PopulationError::Bounds { gene: 1, lower, upper };
            assert_eq!(check_box(&[unit[0], (lower, upper)], &[]), Err(error));
        }
        assert!(check_box(&[(f64::NAN, 1.0)], &[]).is_err());
        let length = PopulationError::StartLength { start: 1, genes: 2, expected: 1 };
        assert_eq!(check_box(&unit, &[vec![0.5], vec![0.5, 0.5]]), Err(length));
        let infinite = PopulationError::StartNotFinite { start: 0, gene: 0, value: f64::INFINITY };
        assert_eq!(check_box(&unit, &[vec![f64::INFINITY]]), Err(infinite));
        assert_eq!(check_box(&unit, &[vec![7.0]]), Ok(()));
    }

    #[test]
    fn the_spread_is_the_widest_share_of_the_box() {
        let at = |x: [f64; 2]| Individual { x: x.to_vec(), fitness: Fitness::UNKNOWN };
        let population = [at([0.0, 5.0]), at([1.0, 5.5])];
        assert_eq!(spread(&population, &[(0.0, 4.0), (5.0, 6.0)]), 0.5);
        assert_eq!(spread(&population[..1], &[(0.0, 4.0), (5.0, 6.0)]), 0.0);
    }
}
