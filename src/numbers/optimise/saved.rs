//! The states of all population searches as one type, for checkpoints.

use super::differential_evolution::{DifferentialEvolution, EvolutionState};
use super::genetic::{Genetic, GeneticState};
use super::population::Generations;
use super::random_search::{SamplingState, UniformSampling};
use serde::{Deserialize, Serialize};

/// The state of an algorithm between two generations, from which [`Resumable::restore`] continues.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GenerationsState {
    /// The state of the genetic algorithm.
    Genetic(GeneticState),
    /// The state of differential evolution.
    DifferentialEvolution(EvolutionState),
    /// The state of uniform sampling.
    UniformSampling(SamplingState),
}

/// A population algorithm that can continue from a saved state.
pub trait Resumable: Generations {
    /// Returns the state that the next generations depend on, after a whole generation.
    fn state(&self) -> GenerationsState;

    /// Continues from a state of the same algorithm with the same parameters on a problem with the same box, in place
    /// of [`initialise`](Generations::initialise). Returns `false` and changes nothing if it is no such state.
    fn restore(&mut self, bounds: &[(f64, f64)], state: GenerationsState) -> bool;
}

macro_rules! resumable {
    ($($algorithm:ident)*) => {$(
        impl Resumable for $algorithm {
            fn state(&self) -> GenerationsState {
                GenerationsState::$algorithm(self.state.clone())
            }

            fn restore(&mut self, bounds: &[(f64, f64)], state: GenerationsState) -> bool {
                match state {
                    GenerationsState::$algorithm(state) if self.fits(&state, bounds) => {
                        self.state = state;
                        true
                    }
                    _ => false,
                }
            }
        }
    )*};
}

resumable!(Genetic DifferentialEvolution UniformSampling);
