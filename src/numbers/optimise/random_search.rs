//! Uniform random sampling of the box: the baseline that every other search has to beat.
//!
//! Each point is drawn independently and uniformly; nothing is learnt. The best points are remembered, so that the
//! result has the same form as that of the population algorithms and can be compared with it evaluation by
//! evaluation.

use super::population::{
    Generations, Individual, PopulationError, draw_uniform, lie_in, resized, sort_best_first,
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
    pub(super) state: SamplingState,
    drawn: Vec<Individual>,
}

/// The state of [`UniformSampling`] between two generations, for a checkpoint.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SamplingState {
    stream: Stream,
    /// The best points so far, best first; of equal points the one drawn earlier comes first.
    best: Vec<Individual>,
}

impl UniformSampling {
    /// Creates a sampler that has not drawn anything yet.
    ///
    /// # Errors
    /// [`PopulationError::Parameter`] if a parameter is outside its domain.
    pub fn new(parameters: UniformSamplingParameters) -> Result<Self, PopulationError> {
        parameters.check()?;
        let state = SamplingState { stream: stream(0, 0), best: Vec::new() };
        Ok(Self { parameters, state, drawn: Vec::new() })
    }

    /// Returns whether a search with these parameters in this box can continue from a state.
    pub(super) fn fits(&self, state: &SamplingState, bounds: &[(f64, f64)]) -> bool {
        lie_in(&state.best, self.size(), bounds)
    }
}

impl Generations for UniformSampling {
    fn name(&self) -> &'static str {
        "uniform sampling"
    }

    fn size(&self) -> usize {
        self.parameters.population
    }

    fn begin(&mut self, stream: Stream, mut best: Vec<Individual>) {
        sort_best_first(&mut best);
        self.state = SamplingState { stream, best };
    }

    fn propose(&mut self, count: usize, bounds: &[(f64, f64)]) -> &mut [Individual] {
        let drawn = resized(&mut self.drawn, count, bounds.len());
        for individual in drawn.iter_mut() {
            draw_uniform(&mut self.state.stream, bounds, &mut individual.x);
        }
        drawn
    }

    fn select(&mut self, _: &[(f64, f64)]) {
        let best = &mut self.state.best;
        let last = best.len() - 1;
        for newcomer in &mut self.drawn {
            // A newcomer that beats the worst remembered one takes its place and moves up behind its equals.
            let order = newcomer.fitness;
            if order.compare(&best[last].fitness).is_lt() {
                std::mem::swap(newcomer, &mut best[last]);
                let place = best[..last].partition_point(|one| one.fitness.compare(&order).is_le());
                best[place..].rotate_right(1);
            }
        }
    }

    fn population(&self) -> &[Individual] {
        &self.state.best
    }

    /// Returns false: a restarted sampler is the same sampler.
    fn converged(&self) -> bool {
        false
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
            all.extend(sampler.state.best.iter().cloned());
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
