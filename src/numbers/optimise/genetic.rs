//! A real-coded genetic algorithm: tournament selection, simulated binary crossover, polynomial mutation, elitism.
//!
//! Two parents y1 < y2 of a gene, in the interval [l, h], have two children around them (simulated binary crossover,
//! index n_c; u uniform in [0, 1)):
//!
//! ```text
//!     c1 = (y1 + y2 - b(u, B1) (y2 - y1)) / 2,     B1 = 1 + 2 (y1 - l) / (y2 - y1)
//!     c2 = (y1 + y2 + b(u, B2) (y2 - y1)) / 2,     B2 = 1 + 2 (h - y2) / (y2 - y1)
//!     b(u, B) = (a u)^(1 / (n_c + 1))                if a u <= 1,        a = 2 - B^-(n_c + 1)
//!             = (1 / (2 - a u))^(1 / (n_c + 1))      else
//! ```
//!
//! b is the ratio of the children's distance to the parents'; b <= B keeps the children in the box without piling them
//! up on its faces. A mutated gene moves by a share d of the box's width w (polynomial mutation, index n_m; y has the
//! distance r w to the bound it moves towards):
//!
//! ```text
//!     d = 1 - (t + (1 - t) (1 - r)^(n_m + 1))^(1 / (n_m + 1)),     t uniform in (0, 1],  either way equally likely
//! ```
//!
//! Of each generation the best few survive; the children replace the rest. Comparisons follow the feasibility rules of
//! [`Fitness`], so that a tournament is Deb's (2000).
//!
//! Sources: K. Deb & R. B. Agrawal, "Simulated binary crossover for continuous search space", Complex Systems 9 (1995);
//! K. Deb & M. Goyal, "A combined genetic adaptive search (GeneAS) for engineering design", Computer Science and
//! Informatics 26 (1996); the form with bounds: K. Deb, Computer Methods in Applied Mechanics and Engineering 186
//! (2000).

use super::population::{
    Fitness, Generations, Individual, PopulationError, StallWatch, lie_in, resized, sort_best_first,
};
use linkwright_arithmetic::streams::{Stream, below, stream, unit};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The parameters of [`Genetic`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct GeneticParameters {
    /// The number of individuals; at least 2.
    pub population: usize,
    /// How many of the best survive into the next generation; from 1 to one less than the population.
    pub elites: usize,
    /// How many individuals a parent has to beat; at least 1, which means no selection.
    pub tournament: usize,
    /// The probability that two parents are crossed rather than copied; in [0, 1].
    pub crossover_probability: f64,
    /// n_c: the larger, the closer are children to their parents; in [0, 1000].
    pub crossover_index: f64,
    /// The probability that a gene mutates, in [0, 1]; one gene in an individual on the average if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mutation_probability: Option<f64>,
    /// n_m: the larger, the smaller are mutations; in [0, 1000].
    pub mutation_index: f64,
    /// The search has converged when the best has gained less than one part in a million over this many generations;
    /// at least 1.
    pub stall_generations: u64,
}

impl Default for GeneticParameters {
    /// Returns the defaults. The probabilities and n_m are Deb's. The elite, the tournament and n_c are a compromise
    /// among elites of 1 to 100, tournaments of 2 and 4, and n_c = 2 and 15: near the best on the sphere and on
    /// Rastrigin's function with ten genes after 20 000 and 100 000 evaluations. Rosenbrock's valley prefers n_c =
    /// 15; on a four-bar's ten lengths and angles the choices differ by less than the seeds do.
    fn default() -> Self {
        Self {
            population: 200,
            elites: 20,
            tournament: 4,
            crossover_probability: 0.9,
            crossover_index: 2.0,
            mutation_probability: None,
            mutation_index: 20.0,
            stall_generations: 100,
        }
    }
}

impl GeneticParameters {
    /// Checks that every parameter is in its domain.
    ///
    /// # Errors
    /// [`PopulationError::Parameter`] for the first one found.
    pub fn check(&self) -> Result<(), PopulationError> {
        let require = PopulationError::require;
        let probability =
            |name, value| require((0.0..=1.0).contains(&value), name, value, "a probability in [0, 1]");
        let index =
            |name, value| require((0.0..=1000.0).contains(&value), name, value, "a number in [0, 1000]");
        require(self.population >= 2, "population", self.population as f64, "at least 2")?;
        require(
            (1..self.population).contains(&self.elites),
            "elites",
            self.elites as f64,
            "at least 1 and less than the population",
        )?;
        require(self.tournament >= 1, "tournament", self.tournament as f64, "at least 1")?;
        probability("crossover_probability", self.crossover_probability)?;
        index("crossover_index", self.crossover_index)?;
        if let Some(value) = self.mutation_probability {
            probability("mutation_probability", value)?;
        }
        index("mutation_index", self.mutation_index)?;
        let stall = self.stall_generations;
        require(stall >= 1, "stall_generations", stall as f64, "at least 1")
    }
}

/// The genetic algorithm, as the module describes.
#[derive(Clone, Debug)]
pub struct Genetic {
    parameters: GeneticParameters,
    pub(super) state: GeneticState,
    children: Vec<Individual>,
}

/// The state of a [`Genetic`] search between two generations, for a checkpoint.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GeneticState {
    stream: Stream,
    /// The population, best first.
    population: Vec<Individual>,
    watch: StallWatch,
}

impl Genetic {
    /// Creates a search that has not begun.
    ///
    /// # Errors
    /// [`PopulationError::Parameter`] if a parameter is outside its domain.
    pub fn new(parameters: GeneticParameters) -> Result<Self, PopulationError> {
        parameters.check()?;
        let watch = StallWatch::new(Fitness::UNKNOWN);
        let state = GeneticState { stream: stream(0, 0), population: Vec::new(), watch };
        Ok(Self { parameters, state, children: Vec::new() })
    }

    /// Returns whether a search with these parameters in this box can continue from a state.
    pub(super) fn fits(&self, state: &GeneticState, bounds: &[(f64, f64)]) -> bool {
        lie_in(&state.population, self.size(), bounds)
    }

    /// Selects by tournament: returns the index of the best of a few individuals drawn at random, which is the least
    /// index as the population is sorted.
    fn win_tournament(&mut self) -> usize {
        let GeneticState { stream, population, .. } = &mut self.state;
        let mut winner = below(stream, population.len());
        for _ in 1..self.parameters.tournament {
            winner = winner.min(below(stream, population.len()));
        }
        winner
    }

    /// Writes the children with the indices `pair` and `pair` + 1, the second one if there is room for it.
    fn breed(&mut self, pair: usize, bounds: &[(f64, f64)]) {
        let (mother, father) = (self.win_tournament(), self.win_tournament());
        let parameters = &self.parameters;
        let GeneticState { stream, population, .. } = &mut self.state;
        let (mother, father) = (&population[mother].x, &population[father].x);
        let (written, unwritten) = self.children[pair..].split_at_mut(1);
        let daughter = &mut written[0].x;
        let mut son = unwritten.first_mut();
        let crossed = unit(stream) < parameters.crossover_probability;
        let mutation = parameters.mutation_probability.unwrap_or(1.0 / bounds.len() as f64);
        for (gene, &interval) in bounds.iter().enumerate() {
            let (mut one, mut other) = (mother[gene], father[gene]);
            // Each gene is crossed with probability one half (Deb & Agrawal 1995).
            if crossed && unit(stream) < 0.5 {
                (one, other) = cross(stream, one, other, interval, parameters.crossover_index);
            }
            for child in [&mut one, &mut other] {
                if unit(stream) < mutation {
                    *child = mutate(stream, *child, interval, parameters.mutation_index);
                }
            }
            daughter[gene] = one;
            if let Some(son) = &mut son {
                son.x[gene] = other;
            }
        }
    }
}

/// Computes b(u, B): the children's distance as a multiple of the parents', for parents from which the bound is at B.
fn spread_factor(u: f64, bound: f64, index: f64) -> f64 {
    let power = 1.0 / (index + 1.0);
    let mass = (2.0 - bound.powf(-(index + 1.0))) * u;
    if mass <= 1.0 { mass.powf(power) } else { (2.0 - mass).powf(-power) }
}

/// Crosses one gene by simulated binary crossover: returns two children, in an order drawn at random.
fn cross(stream: &mut Stream, one: f64, other: f64, (lower, upper): (f64, f64), index: f64) -> (f64, f64) {
    let (near, far) = (one.min(other), one.max(other));
    let distance = far - near;
    let u = unit(stream);
    let swapped = unit(stream) < 0.5;
    // Parents that agree to the last digits have children that do; the ratio to their distance means nothing then.
    if distance <= f64::EPSILON * (upper - lower) {
        return (one, other);
    }
    let below_them = spread_factor(u, 1.0 + 2.0 * (near - lower) / distance, index);
    let above_them = spread_factor(u, 1.0 + 2.0 * (upper - far) / distance, index);
    let low = (0.5 * (near + far - below_them * distance)).clamp(lower, upper);
    let high = (0.5 * (near + far + above_them * distance)).clamp(lower, upper);
    if swapped { (high, low) } else { (low, high) }
}

/// Moves one gene by polynomial mutation.
fn mutate(stream: &mut Stream, value: f64, (lower, upper): (f64, f64), index: f64) -> f64 {
    let width = upper - lower;
    let upwards = unit(stream) < 0.5;
    let t = 1.0 - unit(stream);
    let room = if upwards { upper - value } else { value - lower } / width;
    let step = 1.0 - (t + (1.0 - t) * (1.0 - room).powf(index + 1.0)).powf(1.0 / (index + 1.0));
    let moved = if upwards { value + step * width } else { value - step * width };
    moved.clamp(lower, upper)
}

impl Generations for Genetic {
    fn name(&self) -> &'static str {
        "genetic algorithm"
    }

    fn size(&self) -> usize {
        self.parameters.population
    }

    fn offspring(&self) -> usize {
        self.parameters.population - self.parameters.elites
    }

    fn begin(&mut self, stream: Stream, mut population: Vec<Individual>) {
        sort_best_first(&mut population);
        let watch = StallWatch::new(population[0].fitness);
        self.state = GeneticState { stream, population, watch };
    }

    fn propose(&mut self, count: usize, bounds: &[(f64, f64)]) -> &mut [Individual] {
        resized(&mut self.children, count, bounds.len());
        for pair in (0..count).step_by(2) {
            self.breed(pair, bounds);
        }
        &mut self.children
    }

    fn select(&mut self, _: &[(f64, f64)]) {
        let GeneticState { population, watch, .. } = &mut self.state;
        let kept = population.len() - self.children.len();
        // The elite is in front; a generation that was cut short replaces the worst only.
        population[kept..].swap_with_slice(&mut self.children);
        sort_best_first(population);
        watch.note(population[0].fitness);
    }

    fn population(&self) -> &[Individual] {
        &self.state.population
    }

    fn converged(&self) -> bool {
        self.state.watch.idle_generations() >= self.parameters.stall_generations
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_functions::Constrained;
    use linkwright_arithmetic::streams::uniform;

    #[test]
    fn a_file_may_name_any_parameter_and_no_other() {
        let default = GeneticParameters::default();
        let some: GeneticParameters = toml::from_str("mutation_probability = 0.5").unwrap();
        assert_eq!(some, GeneticParameters { mutation_probability: Some(0.5), ..default });
        assert!(toml::from_str::<GeneticParameters>("mutation = 0.5").is_err());
        let text = toml::to_string(&default).unwrap();
        assert_eq!(toml::from_str::<GeneticParameters>(&text).unwrap(), default);
    }

    #[test]
    fn a_parameter_outside_its_domain_is_named() {
        let default = GeneticParameters::default();
        let wrong = [
            ("population", GeneticParameters { population: 1, ..default }),
            ("elites", GeneticParameters { elites: 0, ..default }),
            ("elites", GeneticParameters { elites: 200, ..default }),
            ("tournament", GeneticParameters { tournament: 0, ..default }),
            ("crossover_probability", GeneticParameters { crossover_probability: 1.5, ..default }),
            ("crossover_index", GeneticParameters { crossover_index: f64::INFINITY, ..default }),
            ("mutation_probability", GeneticParameters { mutation_probability: Some(-0.1), ..default }),
            ("mutation_index", GeneticParameters { mutation_index: f64::NAN, ..default }),
            ("stall_generations", GeneticParameters { stall_generations: 0, ..default }),
        ];
        for (expected, parameters) in wrong {
            match Genetic::new(parameters) {
                Err(PopulationError::Parameter { name, .. }) => assert_eq!(name, expected),
                other => panic!("{expected}: {other:?}"),
            }
        }
    }

    #[test]
    fn far_from_the_bounds_children_have_the_mean_of_their_parents() {
        let draws = &mut stream(11, 0);
        for _ in 0..1000 {
            let (one, other) = (uniform(draws, -1.0, 1.0), uniform(draws, -1.0, 1.0));
            // At a distance of a thousand widths the bounds weigh less than the last digit.
            let (son, daughter) = cross(draws, one, other, (-1e9, 1e9), 15.0);
            assert!((son + daughter - one - other).abs() < 1e-12, "{one} {other}: {son} {daughter}");
        }
    }

    #[test]
    fn half_of_the_children_lie_between_their_parents() {
        // Contracting and expanding crossovers are equally likely (Deb & Agrawal 1995).
        let draws = &mut stream(12, 0);
        let count = 10_000;
        let inside =
            (0..count).filter(|_| (0.0..=1.0).contains(&cross(draws, 0.0, 1.0, (-1e6, 1e6), 2.0).0)).count();
        assert!((inside as f64 / f64::from(count) - 0.5).abs() < 5.0 * 0.5 / f64::from(count).sqrt());
    }

    #[test]
    fn children_and_mutants_of_genes_on_the_bounds_stay_in_the_box() {
        let draws = &mut stream(13, 0);
        let interval = (-2.0, 3.0);
        for (one, other) in [(-2.0, 3.0), (-2.0, -2.0), (3.0, 3.0 - 1e-15), (-2.0, -2.0 + 1e-15)] {
            for index in [0.0, 2.0, 1000.0] {
                for _ in 0..1000 {
                    let (son, daughter) = cross(draws, one, other, interval, index);
                    let mutant = mutate(draws, one, interval, index);
                    for value in [son, daughter, mutant] {
                        assert!((-2.0..=3.0).contains(&value), "{value}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_elite_survives_even_a_generation_that_is_cut_short() {
        let mut search = Genetic::new(GeneticParameters::default()).unwrap();
        search.initialise(&Constrained, &[], stream(14, 0), 1000);
        for allowance in [1000, 1, 7, 180, 1000] {
            let before = search.state.population.clone();
            let spent = search.advance(&Constrained, allowance);
            assert_eq!(spent, allowance.min(180));
            for survivor in &before[..20] {
                assert!(search.state.population.contains(survivor));
            }
        }
    }
}
