//! SHADE: differential evolution that adapts its parameters F and CR from the history of successful steps.
//!
//! For each individual x_i of a population of N, with differences of other individuals as steps:
//!
//! ```text
//!     CR_i ~ normal(M_CR[k], 0.1) cut to [0, 1],   F_i ~ Cauchy(M_F[k], 0.1), redrawn if <= 0, cut to 1,   k random
//!     v_i  = x_i + F_i (x_pbest - x_i) + F_i (x_r1 - x_r2)          "current-to-pbest/1"
//!     u_ij = v_ij  if a uniform draw < CR_i or j is one gene chosen at random, else x_ij       "binomial"
//! ```
//!
//! x_pbest is one of the best p N individuals, p uniform in [2 / N, p_max]; x_r1 is of the population, x_r2 of the
//! population or of the archive, which holds parents that a better trial replaced. A gene that leaves the box is put
//! halfway between x_i and the bound it crossed. A trial that isn't worse replaces its parent; all parents of a
//! generation are the population before it.
//!
//! After each generation the F and CR of the trials that were better enter the history, weighted by what they gained:
//!
//! ```text
//!     M_CR[k] = sum w CR,      M_F[k] = sum w F^2 / sum w F  (Lehmer mean),      k = k + 1 mod H
//! ```
//!
//! Here the gain is one of cost between feasible points and one of violation otherwise. The two have different units,
//! so each kind's weights are made to sum to the kind's share of the successes.
//!
//! The population keeps its size. Reducing it along the budget (L-SHADE) makes the course of a search depend on where
//! it will be stopped; without, a longer search begins with the shorter one and is never worse.
//!
//! Sources: J. Zhang & A. C. Sanderson, "JADE: adaptive differential evolution with optional external archive", IEEE
//! Transactions on Evolutionary Computation 13 (2009); R. Tanabe & A. Fukunaga, "Success-history based parameter
//! adaptation for differential evolution", IEEE Congress on Evolutionary Computation (2013).

use super::population::{
    Fitness, Generations, Individual, PopulationError, StallWatch, best_of, lie_in, lies_in, resized, spread,
};
use linkwright_arithmetic::streams::{Stream, below, cauchy, normal, stream, uniform, unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The parameters of [`DifferentialEvolution`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct DifferentialEvolutionParameters {
    /// N, the number of individuals; at least 4, the number that one step is made from.
    pub population: usize,
    /// p_max, the largest share of the population that counts as its best; in (0, 1].
    pub best_share: f64,
    /// The size of the archive as a multiple of the population; in [0, 10], zero for no archive.
    pub archive_share: f64,
    /// H, the length of the history of successful F and CR; at least 1.
    pub history: usize,
    /// The search has converged when the best has gained less than one part in a million over this many generations;
    /// at least 1.
    pub stall_generations: u64,
}

impl Default for DifferentialEvolutionParameters {
    /// Returns the defaults. The best share and the archive are those of the sources. The other three were chosen
    /// among N = 30 to 100, H = 6 and 20, and 50 to 200 generations by the ten lengths and angles of a four-bar with
    /// a known answer: of 21 seeds with 100 000 evaluations and restarts each, these found it for three in four and
    /// N = 100 for fewer than half. A small population that gives up early and starts again does better there than a
    /// large one.
    fn default() -> Self {
        Self { population: 50, best_share: 0.2, archive_share: 1.0, history: 20, stall_generations: 50 }
    }
}

impl DifferentialEvolutionParameters {
    /// Checks that every parameter is in its domain.
    ///
    /// # Errors
    /// [`PopulationError::Parameter`] for the first one found.
    pub fn check(&self) -> Result<(), PopulationError> {
        let require = PopulationError::require;
        let (size, share) = (self.population, self.best_share);
        let archive = self.archive_share;
        require(size >= SMALLEST, "population", size as f64, "at least 4")?;
        require(share > 0.0 && share <= 1.0, "best_share", share, "a number in (0, 1]")?;
        require((0.0..=10.0).contains(&archive), "archive_share", archive, "a number in [0, 10]")?;
        require(self.history >= 1, "history", self.history as f64, "at least 1")?;
        let stall = self.stall_generations;
        require(stall >= 1, "stall_generations", stall as f64, "at least 1")
    }
}

/// The smallest population: a step is made from x_i, x_r1 and x_r2, all different, and one more that x_pbest can be.
const SMALLEST: usize = 4;
/// The width of the distributions that F and CR are drawn from (Zhang & Sanderson 2009, eqs. 8 and 11).
const SCATTER: f64 = 0.1;
/// The first entries of the history (Tanabe & Fukunaga 2013).
const FIRST_GUESS: Strategy = Strategy { step: 0.5, crossover: 0.5 };
/// The largest extent of a collapsed population, as a share of the box: steps are differences of individuals, and ten
/// digits of every gene agree. The last digits are left to a local solver.
const COLLAPSED_SPREAD: f64 = 1e-10;

/// The two parameters that a trial is made with.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Strategy {
    /// F, in (0, 1].
    step: f64,
    /// CR, in [0, 1].
    crossover: f64,
}

/// The gain of a trial over its parent, in cost (kind 0) or in violation (kind 1), whichever decided.
#[derive(Clone, Copy, Debug)]
struct Gain {
    kind: usize,
    size: f64,
}

impl Gain {
    /// Returns the gain of a trial. One from infinity or NaN has no size, and would outweigh all others: it counts as
    /// zero.
    fn between(parent: &Fitness, trial: &Fitness) -> Self {
        let (kind, gain) = if parent.is_feasible() {
            (0, parent.cost - trial.cost)
        } else {
            (1, parent.violation - trial.violation)
        };
        Gain { kind, size: if gain.is_finite() { gain.max(0.0) } else { 0.0 } }
    }
}

/// The SHADE search, as the module describes.
#[derive(Clone, Debug)]
pub struct DifferentialEvolution {
    parameters: DifferentialEvolutionParameters,
    pub(super) state: EvolutionState,
    trials: Vec<Individual>,
    /// The strategy of each trial.
    strategies: Vec<Strategy>,
    /// The indices of the population, best first.
    ranking: Vec<usize>,
    archive_size: usize,
    successes: Vec<(Strategy, Gain)>,
}

/// The state of a [`DifferentialEvolution`] search between two generations, for a checkpoint.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct EvolutionState {
    stream: Stream,
    population: Vec<Individual>,
    archive: Vec<Vec<f64>>,
    history: Vec<Strategy>,
    /// The index in the history that is written next.
    cursor: usize,
    watch: StallWatch,
    collapsed: bool,
}

impl EvolutionState {
    fn begun(stream: Stream, population: Vec<Individual>, history: Vec<Strategy>) -> Self {
        let best = best_of(&population).map_or(Fitness::UNKNOWN, |best| best.fitness);
        let watch = StallWatch::new(best);
        EvolutionState {
            stream,
            population,
            archive: Vec::new(),
            history,
            cursor: 0,
            watch,
            collapsed: false,
        }
    }
}

impl DifferentialEvolution {
    /// Creates a search that has not begun.
    ///
    /// # Errors
    /// [`PopulationError::Parameter`] if a parameter is outside its domain.
    pub fn new(parameters: DifferentialEvolutionParameters) -> Result<Self, PopulationError> {
        parameters.check()?;
        Ok(Self {
            parameters,
            state: EvolutionState::begun(stream(0, 0), Vec::new(), Vec::new()),
            trials: Vec::new(),
            strategies: Vec::new(),
            ranking: Vec::new(),
            archive_size: (parameters.archive_share * parameters.population as f64) as usize,
            successes: Vec::new(),
        })
    }

    /// Returns whether a search with these parameters in this box can continue from a state.
    pub(super) fn fits(&self, state: &EvolutionState, bounds: &[(f64, f64)]) -> bool {
        let archived = state.archive.len() <= self.archive_size;
        let remembered = state.history.len() == self.parameters.history && state.cursor < state.history.len();
        // Steps drawn around anything else may never be positive.
        let likely =
            |one: &Strategy| one.step > 0.0 && one.step <= 1.0 && (0.0..=1.0).contains(&one.crossover);
        let whole = lie_in(&state.population, self.size(), bounds)
            && state.archive.iter().all(|x| lies_in(x, bounds));
        whole && archived && remembered && state.history.iter().all(likely)
    }

    fn rank(&mut self) {
        let population = &self.state.population;
        self.ranking.clear();
        self.ranking.extend(0..population.len());
        self.ranking.sort_by(|&one, &other| population[one].fitness.compare(&population[other].fitness));
    }

    /// Draws F and CR for one trial.
    fn draw_strategy(&mut self) -> Strategy {
        let EvolutionState { stream, history, .. } = &mut self.state;
        let middle = history[below(stream, history.len())];
        let crossover = normal(stream, middle.crossover, SCATTER).clamp(0.0, 1.0);
        // The history's F are means of numbers in (0, 1], so that at least half of the draws are positive.
        loop {
            let step = cauchy(stream, middle.step, SCATTER);
            if step > 0.0 {
                return Strategy { step: step.min(1.0), crossover };
            }
        }
    }

    /// Writes the trial vector of individual `index` and appends its strategy.
    fn cross(&mut self, index: usize, bounds: &[(f64, f64)]) {
        let strategy = self.draw_strategy();
        self.strategies.push(strategy);
        let EvolutionState { stream, population, archive, .. } = &mut self.state;
        let size = population.len();

        let least = 2.0 / size as f64;
        let share = uniform(stream, least.min(self.parameters.best_share), self.parameters.best_share);
        let leaders = ((share * size as f64) as usize).clamp(2, size);
        let best = &population[self.ranking[below(stream, leaders)]].x;
        let first = draw_other(stream, size, &[index]);
        let second = draw_other(stream, size + archive.len(), &[index, first]);
        let ahead = &population[first].x;
        let behind = match second.checked_sub(size) {
            None => &population[second].x,
            Some(archived) => &archive[archived],
        };

        let parent = &population[index].x;
        let certain = below(stream, bounds.len());
        for (gene, value) in self.trials[index].x.iter_mut().enumerate() {
            let from = parent[gene];
            *value = from;
            if unit(stream) < strategy.crossover || gene == certain {
                let (lower, upper) = bounds[gene];
                let step = (best[gene] - from) + (ahead[gene] - behind[gene]);
                *value = returned(from + strategy.step * step, from, lower, upper);
            }
        }
    }

    /// Replaces parents by those trials that are not worse, and records the successful strategies.
    fn replace(&mut self) {
        self.successes.clear();
        let EvolutionState { stream, population, archive, .. } = &mut self.state;
        for ((parent, trial), strategy) in population.iter_mut().zip(&mut self.trials).zip(&self.strategies) {
            let order = trial.fitness.compare(&parent.fitness);
            if order.is_gt() {
                continue;
            }
            if order.is_lt() {
                let gain = Gain::between(&parent.fitness, &trial.fitness);
                self.successes.push((*strategy, gain));
            }
            std::mem::swap(parent, trial);
            // The parent is now where the trial was.
            if order.is_lt() && self.archive_size > 0 {
                if archive.len() < self.archive_size {
                    archive.push(trial.x.clone());
                } else {
                    let place = below(stream, self.archive_size);
                    archive[place].clone_from(&trial.x);
                }
            }
        }
    }

    /// Writes the means of the successful strategies into the history (Tanabe & Fukunaga 2013).
    fn learn(&mut self) {
        if self.successes.is_empty() {
            return;
        }
        let (mut sums, mut counts) = ([0.0; 2], [0.0; 2]);
        for (_, gain) in &self.successes {
            sums[gain.kind] += gain.size;
            counts[gain.kind] += 1.0;
        }
        let (mut total, mut crossovers, mut steps, mut squares) = (0.0, 0.0, 0.0, 0.0);
        for (strategy, gain) in &self.successes {
            let weight = weight_within(gain.size, sums[gain.kind], counts[gain.kind]);
            total += weight;
            crossovers += weight * strategy.crossover;
            steps += weight * strategy.step;
            squares += weight * strategy.step * strategy.step;
        }
        let EvolutionState { history, cursor, .. } = &mut self.state;
        history[*cursor] =
            Strategy { step: squares / steps, crossover: (crossovers / total).clamp(0.0, 1.0) };
        *cursor = (*cursor + 1) % history.len();
    }
}

/// Computes the weight of a gain among `count` gains that sum to `total`: the weights sum to `count`. If no gain has
/// a size, all weigh the same.
fn weight_within(gain: f64, total: f64, count: f64) -> f64 {
    if total > 0.0 && total.is_finite() { gain / total * count } else { 1.0 }
}

/// Draws a whole number below `count` that is none of `taken`, which must leave one.
fn draw_other(stream: &mut Stream, count: usize, taken: &[usize]) -> usize {
    loop {
        let index = below(stream, count);
        if !taken.contains(&index) {
            return index;
        }
    }
}

/// Returns `value`, or, if it left the box, the middle between the parent's gene and the bound it crossed.
fn returned(value: f64, parent: f64, lower: f64, upper: f64) -> f64 {
    if value < lower {
        0.5 * (lower + parent)
    } else if value > upper {
        0.5 * (upper + parent)
    } else {
        value
    }
}

impl Generations for DifferentialEvolution {
    fn name(&self) -> &'static str {
        "differential evolution"
    }

    fn size(&self) -> usize {
        self.parameters.population
    }

    fn begin(&mut self, stream: Stream, population: Vec<Individual>) {
        self.state = EvolutionState::begun(stream, population, vec![FIRST_GUESS; self.parameters.history]);
    }

    fn propose(&mut self, count: usize, bounds: &[(f64, f64)]) -> &mut [Individual] {
        self.rank();
        self.strategies.clear();
        resized(&mut self.trials, count, bounds.len());
        for index in 0..count {
            self.cross(index, bounds);
        }
        &mut self.trials
    }

    fn select(&mut self, bounds: &[(f64, f64)]) {
        self.replace();
        self.learn();
        let EvolutionState { population, watch, collapsed, .. } = &mut self.state;
        if let Some(best) = best_of(population) {
            watch.note(best.fitness);
        }
        *collapsed = spread(population, bounds) <= COLLAPSED_SPREAD;
    }

    fn population(&self) -> &[Individual] {
        &self.state.population
    }

    fn converged(&self) -> bool {
        self.state.collapsed || self.state.watch.idle_generations() >= self.parameters.stall_generations
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_functions::{Constrained, Sphere};

    fn search(parameters: DifferentialEvolutionParameters) -> DifferentialEvolution {
        DifferentialEvolution::new(parameters).unwrap()
    }

    #[test]
    fn a_file_may_name_any_parameter_and_no_other() {
        let some: DifferentialEvolutionParameters = toml::from_str("population = 30").unwrap();
        let default = DifferentialEvolutionParameters::default();
        assert_eq!(some, DifferentialEvolutionParameters { population: 30, ..default });
        assert!(toml::from_str::<DifferentialEvolutionParameters>("popluation = 30").is_err());
    }

    #[test]
    fn a_parameter_outside_its_domain_is_named() {
        let default = DifferentialEvolutionParameters::default();
        let wrong = [
            ("population", DifferentialEvolutionParameters { population: 3, ..default }),
            ("best_share", DifferentialEvolutionParameters { best_share: 0.0, ..default }),
            ("archive_share", DifferentialEvolutionParameters { archive_share: f64::NAN, ..default }),
            ("history", DifferentialEvolutionParameters { history: 0, ..default }),
            ("stall_generations", DifferentialEvolutionParameters { stall_generations: 0, ..default }),
        ];
        for (expected, parameters) in wrong {
            match DifferentialEvolution::new(parameters) {
                Err(PopulationError::Parameter { name, .. }) => assert_eq!(name, expected),
                other => panic!("{expected}: {other:?}"),
            }
        }
    }

    #[test]
    fn no_individual_ever_gets_worse() {
        let mut search = search(DifferentialEvolutionParameters::default());
        search.initialise(&Constrained, &[], stream(3, 0), 1000);
        for _ in 0..30 {
            let before = search.state.population.clone();
            search.advance(&Constrained, 33);
            for (now, then) in search.state.population.iter().zip(&before) {
                assert!(now.fitness.compare(&then.fitness).is_le());
            }
            let mut rest = search.state.population.iter().zip(&before).skip(33);
            assert!(rest.all(|(now, then)| now.x == then.x), "a cut generation");
        }
    }

    #[test]
    fn the_smallest_population_without_an_archive_finds_the_bottom_of_a_bowl() {
        let smallest = DifferentialEvolutionParameters {
            population: SMALLEST,
            archive_share: 0.0,
            ..DifferentialEvolutionParameters::default()
        };
        let (problem, mut search) = (Sphere::new(1), search(smallest));
        search.initialise(&problem, &[], stream(0, 0), 1000);
        let first = best_of(search.population()).unwrap().fitness.cost;
        while !search.converged() {
            search.advance(&problem, 1000);
        }
        assert!(best_of(search.population()).unwrap().fitness.cost < 1e-3 * first);
        assert!(search.state.archive.is_empty());
    }

    #[test]
    fn the_archive_and_the_history_stay_within_their_sizes_and_domains() {
        let mut search = search(DifferentialEvolutionParameters::default());
        search.initialise(&Constrained, &[], stream(4, 0), 1000);
        for _ in 0..100 {
            search.advance(&Constrained, 1000);
            assert!(search.state.archive.len() <= 50);
            for Strategy { step, crossover } in &search.state.history {
                assert!(*step > 0.0 && *step <= 1.0 && (0.0..=1.0).contains(crossover));
            }
        }
        assert_eq!(search.state.archive.len(), 50);
    }

    #[test]
    fn gains_of_cost_and_of_violation_have_the_same_say_whatever_their_units() {
        let mut search = search(DifferentialEvolutionParameters::default());
        search.state.history = vec![FIRST_GUESS];
        let strategy = |step| Strategy { step, crossover: step };
        search.successes =
            vec![(strategy(0.2), Gain { kind: 0, size: 1e-9 }), (strategy(0.6), Gain { kind: 1, size: 1e9 })];
        search.learn();
        let Strategy { step, crossover } = search.state.history[0];
        assert!((crossover - 0.4).abs() < 4.0 * f64::EPSILON);
        assert!((step - (0.04 + 0.36) / 0.8).abs() < 4.0 * f64::EPSILON);
    }

    #[test]
    fn a_gene_that_leaves_the_box_comes_back_halfway() {
        assert_eq!(returned(-3.0, 1.0, 0.0, 4.0), 0.5);
        assert_eq!(returned(9.0, 1.0, 0.0, 4.0), 2.5);
        assert_eq!(returned(4.0, 1.0, 0.0, 4.0), 4.0);
    }
}
