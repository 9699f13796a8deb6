//! The digest of the data that determine a search.

use crate::task::TaskError;
use crate::task::spec::ProblemSpec;
use serde::Serialize;
use sha2::{Digest, Sha256};

/// The problem cannot be written as data.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the problem cannot be written as JSON: {0}")]
pub struct NotWritten(String);

impl From<serde_json::Error> for NotWritten {
    fn from(error: serde_json::Error) -> Self {
        NotWritten(error.to_string())
    }
}

/// The reason why a record's problem cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ProblemError {
    /// The task is invalid.
    #[error(transparent)]
    Task(#[from] TaskError),
    /// It cannot be written as data.
    #[error(transparent)]
    NotWritten(#[from] NotWritten),
}

/// Returns the SHA-256 digest of the data that determine a search: task, design, require, objective, variables, method
/// with its parameters, seed.
///
/// # Errors
/// [`NotWritten`] if the problem cannot be written as data.
pub fn digest(spec: &ProblemSpec) -> Result<String, NotWritten> {
    #[derive(Serialize)]
    struct Decides<'a> {
        task: &'a crate::task::spec::TaskSpec,
        design: &'a crate::task::spec::DesignSpec,
        require: &'a crate::task::spec::RequireSpec,
        objective: crate::task::spec::Objective,
        // Absent if it is the default: records from before there was a choice keep their digest.
        #[serde(skip_serializing_if = "Option::is_none")]
        variables: Option<crate::task::spec::Variables>,
        method: crate::task::spec::Method,
        genetic: &'a crate::numbers::optimise::genetic::GeneticParameters,
        differential_evolution:
            &'a crate::numbers::optimise::differential_evolution::DifferentialEvolutionParameters,
        seed: u64,
        #[serde(skip_serializing_if = "Option::is_none")]
        loads: Option<&'a crate::task::spec::LoadsSpec>,
    }
    let solve = &spec.solve;
    let text = serde_json::to_vec(&Decides {
        task: &spec.task,
        design: &spec.design,
        require: &spec.require,
        objective: solve.objective,
        variables: Some(solve.variables).filter(|v| !v.is_nine()),
        method: solve.method,
        genetic: &solve.genetic,
        differential_evolution: &solve.differential_evolution,
        seed: solve.seed,
        loads: spec.loads.as_ref(),
    })
    .map_err(NotWritten::from)?;
    Ok(hex(&Sha256::digest(&text)))
}

/// Returns bytes as lower-case hexadecimal digits.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
