//! Uniform random sampling of the box: the baseline that every other search has to beat.
//!
//! Each point is drawn independently and uniformly; nothing is learnt. The best points are remembered, so that the
//! result has the same form as that of the population algorithms and can be compared with it evaluation by
//! evaluation.

use super::population::{
    Generations, GenerationsState, Individual, PopulationError, PopulationProblem, admitted, draw_uniform,
    evaluate_generation, lie_in, scatter, sort_best_first,
};
use linkwright_arithmetic::streams::{Stream, stream};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The parameters of [`UniformSampling`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct UniformSamplingParameters {
    /// How many points are drawn before they are evaluated together, and how many of the best are remembered; at
    /// least 1.
    pub population: usize,
}

impl Default for UniformSamplingParameters {
    fn default() -> Self {
        // A generation as large as that of differential evolution, so that limits cut both at the same counts.
        Self { population: 100 }
    }
}

impl UniformSamplingParameters {
    /// Checks that every parameter is in its domain.
    ///
    /// # Errors
    /// [`PopulationError::Parameter`] if the population is empty.
    pub fn check(&self) -> Result<(), PopulationError> {
        let population = self.population;
        PopulationError::require(population >= 1, "population", population as f64, "at least 1")
    }
}

/// Uniform random sampling of the box, as the module describes.
#[derive(Clone, Debug)]
pub struct UniformSampling {
    parameters: UniformSamplingParameters,
    stream: Stream,
    /// The best points so far, best first; of equal points the one drawn earlier comes first.
    best: Vec<Individual>,
    drawn: Vec<Individual>,
}

/// The state of [`UniformSampling`] between two generations, for a checkpoint.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SamplingState {
    stream: Stream,
    best: Vec<Individual>,
}

impl UniformSampling {
    /// Creates a sampler that has not drawn anything yet.
    ///
    /// # Errors
    /// [`PopulationError::Parameter`] if a parameter is outside its domain.
    pub fn new(parameters: UniformSamplingParameters) -> Result<Self, PopulationError> {
        parameters.check()?;
        Ok(Self { parameters, stream: stream(0, 0), best: Vec::new(), drawn: Vec::new() })
    }
}

impl Generations for UniformSampling {
    fn name(&self) -> &'static str {
        "uniform sampling"
    }

    fn initialise(
        &mut self,
        problem: &dyn PopulationProblem,
        starts: &[Vec<f64>],
        stream: Stream,
        allowance: u64,
    ) -> u64 {
        self.stream = stream;
        let size = self.parameters.population;
        let spent = scatter(problem, starts, &mut self.stream, allowance, size, &mut self.best);
        sort_best_first(&mut self.best);
        self.drawn.clear();
        self.drawn.resize(size, Individual::blank(problem.bounds().len()));
        spent
    }

    fn advance(&mut self, problem: &dyn PopulationProblem, allowance: u64) -> u64 {
        let kept = self.best.len();
        assert!(kept == self.parameters.population, "advance needs a whole population");
        let drawn = &mut self.drawn[..admitted(kept, allowance)];
        for individual in drawn.iter_mut() {
            draw_uniform(&mut self.stream, problem.bounds(), &mut individual.x);
        }
        evaluate_generation(problem, drawn);
        for newcomer in drawn.iter_mut() {
            // A newcomer that beats the worst remembered one takes its place and moves up behind its equals.
            let order = newcomer.fitness;
            if order.compare(&self.best[kept - 1].fitness).is_lt() {
                std::mem::swap(newcomer, &mut self.best[kept - 1]);
                let place = self.best[..kept - 1].partition_point(|one| one.fitness.compare(&order).is_le());
                self.best[place..].rotate_right(1);
            }
        }
        drawn.len() as u64
    }

    fn population(&self) -> &[Individual] {
        &self.best
    }

    /// Returns false: a restarted sampler is the same sampler.
    fn converged(&self) -> bool {
        false
    }

    fn state(&self) -> GenerationsState {
        let (stream, best) = (self.stream.clone(), self.best.clone());
        GenerationsState::UniformSampling(SamplingState { stream, best })
    }

    fn restore(&mut self, problem: &dyn PopulationProblem, state: GenerationsState) -> bool {
        let GenerationsState::UniformSampling(SamplingState { stream, best }) = state else { return false };
        let size = self.parameters.population;
        if !lie_in(&best, size, problem.bounds()) {
            return false;
        }
        self.drawn.clear();
        self.drawn.resize(size, Individual::blank(problem.bounds().len()));
        (self.stream, self.best) = (stream, best);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::population::best_of;
    use crate::test_functions::{Counted, Sphere};

    #[test]
    fn the_remembered_points_are_the_best_of_all_points_drawn() {
        let problem = Sphere::new(3);
        let mut sampler = UniformSampling::new(UniformSamplingParameters { population: 8 }).unwrap();
        sampler.initialise(&problem, &[], stream(5, 0), 8);
        let mut all = sampler.population().to_vec();
        for _ in 0..40 {
            sampler.advance(&problem, u64::MAX);
            // The buffer of newcomers also holds the points pushed out: none of them may be better than those kept.
            all.extend(sampler.drawn.iter().cloned());
            all.extend(sampler.best.iter().cloned());
        }
        sort_best_first(&mut all);
        all.dedup();
        assert_eq!(sampler.population(), &all[..8]);
        assert_eq!(best_of(&all), sampler.population().first());
    }

    #[test]
    fn a_cut_generation_draws_only_what_is_allowed() {
        let problem = Counted::new(Sphere::new(2));
        let mut sampler = UniformSampling::new(UniformSamplingParameters::default()).unwrap();
        assert_eq!(sampler.initialise(&problem, &[], stream(0, 0), 1000), 100);
        assert_eq!(sampler.advance(&problem, 7), 7);
        assert_eq!(problem.evaluations(), 107);
    }
}
