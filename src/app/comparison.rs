//! Measuring the inputs of a comparison: every figure is computed again, and none is taken from a record unchecked.

use crate::app::inputs::{Chosen, Given, Run};
use crate::files::diagnostic::escaped;
use crate::files::linkage_file::LinkageFile;
use crate::files::problem_file::ProblemFile;
use crate::judge::assess::{assess, assess_again};
use crate::judge::figures::extent;
use crate::judge::verify::verify_candidate;
use crate::mechanism::{CrankLinkage, LinkageError, LinkageKind, Unit};
use crate::record::Candidate;
use crate::record::digest::digest;
use crate::report::certificate::headline;
use crate::report::compare::{
    Comparison, Entry, LeftOut, SortKey, compare, in_one_unit, same_body, same_points, unit_remarks,
};
use crate::synthesis::nearest::nearest_positions;
use crate::task::{Problem, TaskError};
use std::path::Path;

/// The reason why there is no comparison.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotCompared {
    /// No input has figures; the reason for each.
    #[error("none of these can be compared")]
    Nothing(Vec<LeftOut>),
    /// The problem of a record is invalid.
    #[error("{named}: the recorded problem is none: {source}")]
    Problem {
        /// The result as it was named.
        named: String,
        /// The reason.
        source: TaskError,
    },
    /// A linkage without a run has no target.
    #[error("{0} is a linkage without a target: say which with --target PROBLEM.toml")]
    NoTarget(String),
    /// The reference of the differences has no figures.
    #[error("{0} has no figures that others could be compared with")]
    NoReference(String),
    /// A linkage cannot be converted to the common unit.
    #[error("a linkage cannot be converted to another unit: {0}")]
    Unit(LinkageError),
}

/// The reason why a linkage has no figures on a target.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
enum NotMeasured {
    #[error(transparent)]
    Linkage(#[from] LinkageError),
    /// The outputs of the function are none that the kind has.
    #[error("{} has {what}", kind.with_article())]
    WithoutOutput { kind: LinkageKind, what: &'static str },
    #[error("it cannot be assembled at every {noun} of {name}")]
    NotAssembled { name: String, noun: &'static str },
}

/// The target that errors are measured against, with the problem that it belongs to.
#[derive(Clone)]
pub struct Target {
    /// The name of the problem.
    pub name: String,
    problem: Problem,
    /// The unit of the problem's lengths.
    pub unit: Option<Unit>,
}

impl Target {
    /// Returns the target of a problem file.
    ///
    /// # Errors
    /// The reason why the file states no valid problem.
    pub fn new(file: ProblemFile) -> Result<Self, TaskError> {
        let problem = Problem::new(file.spec.clone())?;
        Ok(Target { name: file.name, problem, unit: file.unit })
    }

    /// Returns the target of a run.
    fn of_run(run: &Run, unit: Option<Unit>) -> Result<Self, NotCompared> {
        let asked = &run.record.problem;
        let problem = Problem::new(asked.resolved.clone())
            .map_err(|source| NotCompared::Problem { named: run.named.clone(), source })?;
        Ok(Target { name: asked.name.clone(), problem, unit: asked.unit.or(unit) })
    }

    /// Returns whether points, timing and unit are the same, so that positions on one target are positions on the
    /// other.
    fn is(&self, other: &Target) -> bool {
        let (one, other_path) = (&self.problem.spec().task, &other.problem.spec().task);
        let one_unit = self.unit.zip(other.unit).is_none_or(|(one, other)| one == other);
        one_unit
            && same_points(&one.points, &other_path.points)
            && same_body(one.body.as_ref(), other_path.body.as_ref())
            && one.timing == other_path.timing
    }

    fn entry(&self, label: String, candidate: Candidate, unit: Option<Unit>, of_run: bool) -> Entry {
        let path = &self.problem.spec().task;
        Entry {
            label,
            extent: Some(extent(&self.problem, &candidate)),
            candidate,
            target_name: self.name.clone(),
            target: path.points.clone(),
            pairs: path.pairs(),
            kind: path.kind(),
            body: path.body.clone(),
            unit: self.unit.or(unit),
            measure: self.problem.spec().measure(),
            of_run,
            untrue: Vec::new(),
        }
    }

    /// Returns the linkage in this target's unit, measured at the positions nearest to its points or at its angles.
    fn nearest(&self, linkage: CrankLinkage, unit: Option<Unit>) -> Result<Candidate, NotMeasured> {
        let factor = unit.zip(self.unit).map_or(1.0, |(from, to)| from.factor_to(to));
        let linkage = linkage.scaled(factor)?;
        let kind = linkage.kind();
        let output = self.problem.spec().task.output.as_ref().map(|output| output.output);
        if let Some(output) = output.filter(|output| !output.is_of(kind)) {
            return Err(NotMeasured::WithoutOutput { kind, what: output.missing() });
        }
        nearest_positions(&self.problem, linkage)
            .and_then(|(crank_deg, assemblies)| assess(&self.problem, linkage, &crank_deg, &assemblies))
            .ok_or_else(|| NotMeasured::NotAssembled {
                name: self.name.clone(),
                noun: self.problem.spec().task.noun(),
            })
    }

    /// Returns a candidate judged at its own positions and in its own frame.
    fn at(&self, candidate: &Candidate) -> Option<Candidate> {
        let n = self.problem.task().len();
        let has_all = candidate.crank_deg.len() == n && candidate.t1_at.len() == n;
        has_all.then(|| assess_again(&self.problem, candidate)).flatten()
    }
}

/// The inputs of a comparison, measured.
#[derive(Default)]
struct Measured {
    /// The entries with figures.
    entries: Vec<Entry>,
    /// The inputs without figures.
    left_out: Vec<LeftOut>,
    /// The name of the target and the label of each input with the unit of its file.
    units: Vec<(String, Option<Unit>)>,
    /// Remarks on how the figures were measured, in sentences.
    remarks: Vec<String>,
}

/// Compares the inputs side by side: in the unit of the target, otherwise of the first input that has a unit, ranked by
/// `keys`. `reference` is the label of the entry from which differences are taken.
///
/// # Errors
/// [`NotCompared`].
pub fn compared(
    given: &[(&Path, Given)],
    target: Option<&Target>,
    keys: &[SortKey],
    reference: Option<&str>,
) -> Result<Comparison, NotCompared> {
    let unit_of = |one: &Given| match one {
        Given::Run(run) => run.record.problem.unit,
        Given::Linkage(file) => file.unit,
    };
    let unit = target.and_then(|target| target.unit);
    let unit = unit.or_else(|| given.iter().find_map(|(_, one)| unit_of(one)));
    let measured = Measured::of(given, target, unit)?;
    if measured.entries.is_empty() {
        return Err(NotCompared::Nothing(measured.left_out));
    }
    let position = |label: &str| {
        let found = measured.entries.iter().position(|entry| entry.label == label);
        found.ok_or_else(|| NotCompared::NoReference(label.to_owned()))
    };
    let reference = reference.map(position).transpose()?;
    let entries = in_one_unit(&measured.entries, unit).map_err(NotCompared::Unit)?;
    let mut comparison = compare(&entries, keys, reference);
    comparison.remarks.extend(measured.remarks);
    comparison.remarks.extend(unit.iter().flat_map(|unit| unit_remarks(&measured.units, *unit)));
    comparison.left_out = measured.left_out;
    Ok(comparison)
}

/// Returns the label of a linkage file: its name, or its path if another file has the same name.
pub fn label_of_file(given: &[(&Path, Given)], index: usize) -> String {
    let (path, Given::Linkage(file)) = &given[index] else { return String::new() };
    let same = |other: &Given| matches!(other, Given::Linkage(other) if other.name == file.name);
    let alone = given.iter().enumerate().all(|(i, (_, other))| i == index || !same(other));
    if alone { file.name.clone() } else { escaped(&path.display().to_string()) }
}

impl Measured {
    /// Measures the inputs: candidates of runs on their own problems, or everything on `target`. Linkage files without
    /// a target are measured on the problem of the runs beside them, if these have the same problem. Lengths without a
    /// unit, also those of a target, are taken to be in `unit`.
    ///
    /// # Errors
    /// [`NotCompared`].
    fn of(
        given: &[(&Path, Given)],
        target: Option<&Target>,
        unit: Option<Unit>,
    ) -> Result<Self, NotCompared> {
        let mut measured = Measured::default();
        measured.units.extend(target.map(|target| (target.name.clone(), target.unit)));
        let target = target.map(|target| Target { unit: target.unit.or(unit), ..target.clone() });
        let target = target.as_ref();
        let own = |(_, one): &(&Path, Given)| match one {
            Given::Run(run) => Target::of_run(run, unit).map(Some),
            Given::Linkage(_) => Ok(None),
        };
        let of_runs: Vec<Option<Target>> = given.iter().map(own).collect::<Result<_, _>>()?;
        let mut runs = of_runs.iter().flatten();
        let first = runs.next();
        let common = target.or(first.filter(|first| runs.all(|other| first.is(other))));
        for (i, ((path, one), own)) in given.iter().zip(&of_runs).enumerate() {
            match (one, own) {
                (Given::Run(run), Some(own)) => {
                    let untrue = digest_of(run);
                    let proved = run.record.certificate.as_ref().filter(|proof| proof.lower_bound > 0.0);
                    if let (Some(proof), None, true) = (proved, target, untrue.is_empty()) {
                        let named = escaped(&run.named);
                        measured.remarks.push(format!("{named}, as its record says: {}.", headline(proof)));
                    }
                    for chosen in run.chosen() {
                        measured.units.push((chosen.label.clone(), run.record.problem.unit));
                        measured.candidate(&chosen, own, target, &untrue);
                    }
                }
                (Given::Linkage(file), _) => {
                    let shown = || escaped(&path.display().to_string());
                    let on = common.ok_or_else(|| NotCompared::NoTarget(shown()))?;
                    let label = label_of_file(given, i);
                    measured.units.push((label.clone(), file.unit));
                    measured.file(label, file, on);
                }
                (Given::Run(_), None) => {}
            }
        }
        let beside =
            common.filter(|_| target.is_none() && measured.entries.iter().any(|entry| !entry.of_run));
        measured.remarks.extend(
            beside.map(|on| format!("Linkage files are measured on {}, the problem of the runs.", on.name)),
        );
        Ok(measured)
    }

    fn put(&mut self, label: String, entry: Result<Entry, NotMeasured>) {
        match entry {
            Ok(entry) => self.entries.push(entry),
            Err(why) => self.left_out.push(LeftOut { label, why: why.to_string() }),
        }
    }

    /// Measures a linkage without a run.
    fn file(&mut self, label: String, file: &LinkageFile<CrankLinkage>, on: &Target) {
        let entry = on
            .nearest(file.linkage, file.unit)
            .map(|candidate| on.entry(label.clone(), candidate, file.unit, false));
        self.put(label, entry);
    }

    /// Measures a candidate of a run: at its own positions if the target is its own, otherwise as a linkage without a
    /// run.
    fn candidate(&mut self, chosen: &Chosen<'_>, own: &Target, target: Option<&Target>, untrue: &[String]) {
        let (label, recorded) = (chosen.label.clone(), chosen.candidate);
        let on = target.unwrap_or(own);
        let mut found: Vec<String> = untrue.to_vec();
        found.extend(verify_candidate(&own.problem, recorded).into_iter().map(|mismatch| {
            let as_recorded = format!("{} is recorded as {}", mismatch.what, mismatch.recorded);
            format!("{as_recorded}, but it is {}", mismatch.found)
        }));
        let same = on.is(own);
        let measured = if same && found.is_empty() && target.is_none() {
            // Checked a moment ago. If a verdict depends on rounding, the recorded one is kept.
            Ok(recorded.clone())
        } else {
            let there = same.then(|| on.at(recorded)).flatten();
            there.map_or_else(|| on.nearest(recorded.linkage, own.unit), Ok)
        };
        let entry = measured
            .map(|candidate| Entry { untrue: found, ..on.entry(label.clone(), candidate, own.unit, true) });
        self.put(label, entry);
    }
}

/// Returns a message if the problem was changed after the run.
fn digest_of(run: &Run) -> Vec<String> {
    let asked = &run.record.problem;
    match digest(&asked.resolved) {
        Ok(found) if found == asked.digest => Vec::new(),
        _ => vec!["the problem is not the one that was run (problem.digest)".to_owned()],
    }
}
