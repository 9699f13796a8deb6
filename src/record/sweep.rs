//! Sweeps: many problems that are one problem with different values of some keys.
//!
//! A [`Plan`] holds everything that decides the rows of a sweep: the texts of the problem and of the files that it names,
//! and the varied keys. It describes the product of the values and lists no jobs, so that it stays small. Job number
//! `i` (from 0) has the values of the mixed-radix digits of `i`: the last key varies fastest. A [`Row`] is the outcome of
//! a job.

use crate::mechanism::{CrankLinkage, LinkageType};
use crate::record::digest::{NotWritten, hex};
use crate::record::{ErrorRecord, Reason, Record, Tool};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use sha2::{Digest, Sha256};

/// The format of plans and shards that this program writes and reads.
pub const FORMAT: u32 = 1;

/// The most jobs of a sweep.
pub const MAX_JOBS: u64 = 100_000_000;

/// The plan of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// [`FORMAT`].
    pub format: u32,
    /// The program that made the plan, and that its shards are run with.
    pub tool: Tool,
    /// SHA-256 of all other keys: shards bear it, and one with another digest is of another plan.
    pub digest: String,
    /// The name of the sweep.
    pub name: String,
    /// The number of jobs.
    pub jobs: u64,
    /// The number of jobs of a shard; the last may have fewer.
    pub shard_size: u64,
    /// The number of shards.
    pub shards: u64,
    /// Whether rows hold the whole record of their job.
    pub records: bool,
    /// The varied keys; the last varies fastest.
    pub vary: Vec<Varied>,
    /// The problem file.
    pub problem: PlannedFile,
    /// The points files and drawings that the problem names.
    pub beside: Vec<PlannedFile>,
}

/// A file with its text, as it was when the sweep was planned.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedFile {
    /// The name by which it is asked for.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// A varied key with its values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Varied {
    /// The key of the problem file, such as `solve.seed`.
    pub key: String,
    /// Its values.
    pub values: Values,
}

/// The values of a varied key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Values {
    /// Each of a list.
    List(Vec<Value>),
    /// Evenly spaced numbers.
    Range(Range),
}

/// Evenly spaced numbers, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(inline)]
pub struct Range {
    /// The first.
    pub from: f64,
    /// The last.
    pub to: f64,
    /// How many: 2 or more.
    pub steps: u64,
}

impl Range {
    /// Returns the number with this index. It is rounded to 15 digits, so that tenths are 0.1, 0.2, 0.3; the ends are exact.
    pub fn at(&self, index: u64) -> f64 {
        let last = self.steps.saturating_sub(1);
        if index == 0 || last == 0 {
            return self.from;
        }
        if index >= last {
            return self.to;
        }
        let share = index as f64 / last as f64;
        let value = self.from * (1.0 - share) + self.to * share;
        format!("{value:.14e}").parse().unwrap_or(value)
    }
}

impl Values {
    /// Returns the number of values.
    pub fn count(&self) -> u64 {
        match self {
            Values::List(list) => list.len() as u64,
            Values::Range(range) => range.steps,
        }
    }

    /// Returns the value with this index, `null` beyond the last. A whole number of a range is written as one.
    pub fn at(&self, index: u64) -> Value {
        match self {
            Values::List(list) => {
                usize::try_from(index).ok().and_then(|i| list.get(i)).cloned().unwrap_or_default()
            }
            Values::Range(range) => number(range.at(index)),
        }
    }
}

/// Returns a number as data: whole where it is whole and exact.
pub(crate) fn number(value: f64) -> Value {
    /// 2^53: from here on not every whole number is a double.
    const EXACT: f64 = 9_007_199_254_740_992.0;
    if value.fract() == 0.0 && value.abs() < EXACT { Value::from(value as i64) } else { Value::from(value) }
}

impl Plan {
    /// Returns the plan with the digest of everything else in it.
    ///
    /// # Errors
    /// [`NotWritten`] if it cannot be written as data.
    pub fn sealed(mut self) -> Result<Plan, NotWritten> {
        self.digest = String::new();
        let text = serde_json::to_vec(&self).map_err(NotWritten::from)?;
        self.digest = hex(&Sha256::digest(&text));
        Ok(self)
    }

    /// Returns the number of combinations of the values; `None` if it is above [`MAX_JOBS`].
    pub fn product(vary: &[Varied]) -> Option<u64> {
        let mut jobs: u64 = 1;
        for varied in vary {
            jobs = jobs.checked_mul(varied.values.count()).filter(|jobs| *jobs <= MAX_JOBS)?;
        }
        Some(jobs)
    }

    /// Returns the index of the value of each key in a job.
    pub fn indices(&self, job: u64) -> Vec<u64> {
        let mut rest = job;
        let mut indices = vec![0; self.vary.len()];
        for (index, varied) in indices.iter_mut().zip(&self.vary).rev() {
            let count = varied.values.count().max(1);
            (*index, rest) = (rest % count, rest / count);
        }
        indices
    }

    /// Returns the keys and values of a job.
    pub fn values(&self, job: u64) -> Map<String, Value> {
        let values = self.vary.iter().zip(self.indices(job));
        values.map(|(varied, index)| (varied.key.clone(), varied.values.at(index))).collect()
    }

    /// Returns the numbers of the jobs of a shard; empty beyond the last shard.
    pub fn jobs_of(&self, shard: u64) -> std::ops::Range<u64> {
        let first = shard.saturating_mul(self.shard_size).min(self.jobs);
        first..first.saturating_add(self.shard_size).min(self.jobs)
    }
}

/// The outcome of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Status {
    /// It ran, and a candidate is accepted.
    Accepted,
    /// It ran, and nothing is acceptable.
    NothingAcceptable,
    /// Its values contradict each other, or it cannot be searched: nothing was run.
    Refused,
    /// A bug of linkwright stopped it.
    Bug,
}

impl Status {
    /// Returns the name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Status::Accepted => "accepted",
            Status::NothingAcceptable => "nothing-acceptable",
            Status::Refused => "refused",
            Status::Bug => "bug",
        }
    }
}

/// A job and its outcome: a line of a shard and of the merged file. `R` is the type of its record, if it holds one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row<R = Box<Record>> {
    /// The number of the job, from 0.
    pub job: u64,
    /// The varied keys with their values.
    pub values: Map<String, Value>,
    /// The outcome.
    pub status: Status,
    /// The reason why it was refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub message: Option<String>,
    /// The reason why the search ended.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub termination: Option<Reason>,
    /// The number of candidates.
    pub candidates: usize,
    /// How many of them are accepted.
    pub accepted: usize,
    /// The evaluations of the objective.
    pub evaluations: u64,
    /// The figures of the first candidate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub best: Option<Best>,
    /// The whole record, where the plan asks for it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub record: Option<R>,
}

/// The figures of the first candidate of a job.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Best {
    /// Whether it is accepted.
    pub accepted: bool,
    /// Its errors.
    pub error: ErrorRecord,
    /// Its type; absent of other kinds than four-bars.
    #[serde(rename = "type", default, skip_serializing_if = "Option::is_none")]
    pub linkage_type: Option<LinkageType>,
    /// min(mu, 180 - mu) of the transmission angle at its worst, degrees.
    pub transmission_worst_deg: f64,
    /// Longest over shortest link.
    pub link_ratio: f64,
    /// The diagonal of the box of A, B, C, D and P over the motion used.
    pub extent: f64,
    /// The longest of ground, a, b, c, d and e.
    pub longest: f64,
    /// The linkage.
    pub linkage: CrankLinkage,
}

impl Best {
    /// Returns the type of a four-bar, of other kinds the kind.
    pub fn type_name(&self) -> &'static str {
        super::type_name(self.linkage_type, &self.linkage)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tenths_are_tenths_and_the_ends_are_exact() {
        let range = Range { from: 0.1, to: 1.0, steps: 10 };
        let values: Vec<f64> = (0..10).map(|i| range.at(i)).collect();
        assert_eq!(values, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]);
        let range = Range { from: 1.0 / 3.0, to: 2.0 / 3.0, steps: 2 };
        assert_eq!((range.at(0), range.at(1)), (1.0 / 3.0, 2.0 / 3.0));
        let down = Range { from: 5.0, to: 1.0, steps: 5 };
        assert_eq!(Values::Range(down).at(3), Value::from(2));
    }

    #[test]
    fn the_last_key_varies_fastest_and_shards_cover_every_job_once() {
        let list = |values: &[i64]| Values::List(values.iter().map(|v| Value::from(*v)).collect());
        let vary = vec![
            Varied { key: "a".into(), values: list(&[1, 2]) },
            Varied { key: "b".into(), values: list(&[3, 4, 5]) },
        ];
        assert_eq!(Plan::product(&vary), Some(6));
        let file = PlannedFile { name: String::new(), text: String::new() };
        let plan = Plan {
            format: FORMAT,
            tool: Tool::this(),
            digest: String::new(),
            name: "it".into(),
            jobs: 6,
            shard_size: 4,
            shards: 2,
            records: false,
            vary,
            problem: file,
            beside: Vec::new(),
        };
        let pairs: Vec<(Value, Value)> = (0..6)
            .map(|job| {
                let values = plan.values(job);
                (values["a"].clone(), values["b"].clone())
            })
            .collect();
        let expected = [(1, 3), (1, 4), (1, 5), (2, 3), (2, 4), (2, 5)];
        assert_eq!(pairs, expected.map(|(a, b)| (Value::from(a), Value::from(b))));
        assert_eq!([0, 1, 2].map(|shard| plan.jobs_of(shard)), [0..4, 4..6, 6..6]);
        let many = Values::Range(Range { from: 0.0, to: 1.0, steps: MAX_JOBS });
        let both =
            [Varied { key: "a".into(), values: many }, Varied { key: "b".into(), values: list(&[1, 2]) }];
        assert_eq!(Plan::product(&both), None);
    }
}
