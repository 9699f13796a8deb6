//! Describes, exports and compares linkages: of saved results, or under the hand. Details, files and comparisons are
//! made from the record to which a linkage belongs, by the functions that the command line calls.

use super::asked::AskError;
use super::house::House;
use super::messages::{Ask, Shown, Target};
use super::shelf::ShelfError;
use super::workshop;
use crate::app::comparison::{NotCompared, compared};
use crate::app::inputs::{Given, Run, Which};
use crate::app::job::run::Job;
use crate::files::name::{self, NameError};
use crate::judge::assess::{assess, measure_beside};
use crate::judge::verify::{Mismatch, verify};
use crate::mechanism::loads::LoadError;
use crate::mechanism::{AssemblyMode, CrankLinkage, LinkageKeys, NoLinkage};
use crate::record::digest::ProblemError;
use crate::record::{Candidate, Evaluations, ProblemRecord, Reason, Record};
use crate::report::compare::{SortKey, UnknownKey};
use crate::report::export::{Format, Refusal, Settings, Subject, UnknownFormat, export};
use crate::report::{csv, html, svg};
use crate::synthesis::answers::annotate;
use crate::synthesis::nearest::nearest_positions;
use crate::synthesis::{Budget, Context, SearchOutcome, errors_without};
use crate::task::Problem;
use crate::task::spec::ProblemSpec;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, VecDeque};
use std::path::Path;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

/// Records of ended searches that are kept.
const KEPT: usize = 16;
/// The time for the costs of a linkage under the hand, seconds.
const PATIENCE_S: f64 = 1.5;
/// The budget for these costs, evaluations.
const EFFORT: u64 = 40_000;
/// The most linkages of a comparison.
pub(super) const MOST_COMPARED: usize = 20;

/// The source of a linkage.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Source {
    /// A candidate of a saved result.
    Job(OfJob),
    /// A linkage that the studio has shown for an edit.
    Drawn(Box<Drawn>),
}

/// A candidate of a saved result.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct OfJob {
    /// The result.
    pub name: String,
    /// The candidate's rank, from 1.
    pub rank: usize,
}

/// A linkage under the hand: the parts of an answer's `Shown` that determine it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drawn {
    /// The edit that it answers.
    pub ask: Ask,
    /// The linkage.
    pub linkage: LinkageKeys,
    /// The crank angle at each target point, degrees.
    pub crank_deg: Vec<f64>,
    /// The assembly (1 or -1) at each point.
    pub t1_at: Vec<i64>,
}

/// A linkage whose details are wanted.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DetailsAsk {
    /// The linkage.
    pub of: Source,
}

/// The report's text on a linkage, with its figures.
#[derive(Clone, Debug, Serialize, JsonSchema)]
pub struct Details {
    /// The problem that it was found for.
    #[serde(flatten)]
    pub target: Target,
    /// The tolerance at each point.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tolerance: Option<Vec<f64>>,
    /// The least transmission angle that was asked for, degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub transmission_deg_min: Option<f64>,
    /// The number of candidates of the result.
    pub candidates: usize,
    /// The linkage.
    pub shown: Shown,
    /// The outcome of the search, as markup without scripts.
    pub summary: String,
    /// Figures, mobility, warnings, requirements with what they cost, dimensions: as markup without scripts.
    pub words: String,
}

/// A linkage that was changed by hand, over the target of an edit.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JudgeAsk {
    /// The edit.
    pub ask: Ask,
    /// The linkage.
    pub linkage: LinkageKeys,
}

/// A linkage that is wanted as a file.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ExportAsk {
    /// The linkage.
    pub of: Source,
    /// A format of `linkwright export`, or `html` (the report), `sheet` (its drawing), `points` (CSV along the
    /// points), `layers` (what `linkwright build` prints), `archive` (a zip of everything that it takes to build it).
    pub format: String,
    /// Settings, as `linkwright export --set` takes them: `{"hole_mm": "4"}`. For an archive and for layers: of all its
    /// files.
    #[serde(default)]
    pub set: BTreeMap<String, String>,
    /// With which the names in an archive begin; absent: the problem's name.
    #[serde(default)]
    pub name: Option<String>,
}

/// Linkages that are to be compared.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CompareAsk {
    /// The linkages: 1 to 20.
    pub of: Vec<Source>,
    /// The figures that they are ranked by, as `linkwright compare --sort` takes them; empty: the sum of squared errors.
    #[serde(default)]
    pub sort: Vec<String>,
    /// `json`, or `html`, `csv`, `svg` for a file.
    #[serde(default)]
    pub form: Form,
}

/// The form of a comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Form {
    /// As `linkwright compare --json` prints it.
    #[default]
    Json,
    /// A page.
    Html,
    /// A table.
    Csv,
    /// The linkages over their target.
    Svg,
}

/// A file to hand out.
pub(super) struct Handed {
    /// The ending of its name, after the dot.
    pub(super) ending: &'static str,
    /// Whether it is to be saved; else it is shown.
    pub(super) saved: bool,
    /// Its bytes.
    pub(super) bytes: Vec<u8>,
}

impl Handed {
    /// Returns a file that is to be saved.
    fn saved(ending: &'static str, bytes: impl Into<Vec<u8>>) -> Handed {
        Handed { ending, saved: true, bytes: bytes.into() }
    }

    /// Returns a text that is shown.
    pub(super) fn shown(ending: &'static str, text: String) -> Handed {
        Handed { saved: false, ..Handed::saved(ending, text) }
    }

    /// Returns a file of a result, under the ending of its name if results have such files.
    pub(super) fn named(name: &str, bytes: Vec<u8>) -> Handed {
        let given = name.rsplit_once('.').map_or("", |(_, ending)| ending);
        let ending = ["json", "csv", "svg", "toml", "html"].into_iter().find(|ending| *ending == given);
        Handed::saved(ending.unwrap_or("bin"), bytes)
    }

    /// Returns its media type.
    pub(super) fn media_type(&self) -> &'static str {
        match self.ending {
            "csv" => "text/csv; charset=utf-8",
            "dxf" => "image/vnd.dxf",
            "gif" => "image/gif",
            "html" => "text/html; charset=utf-8",
            "json" => "application/json",
            "png" => "image/png",
            "scad" => "application/x-openscad",
            "stl" => "model/stl",
            "svg" => "image/svg+xml",
            "toml" => "application/toml; charset=utf-8",
            "txt" => "text/plain; charset=utf-8",
            "zip" => "application/zip",
            _ => "application/octet-stream",
        }
    }
}

/// The records of the latest searches of all tabs.
#[derive(Default)]
pub(super) struct Finished(Mutex<VecDeque<Arc<Record>>>);

impl Finished {
    /// Keeps a record; the oldest goes.
    pub(super) fn keep(&self, record: &Record) {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.retain(|other| other.problem.digest != record.problem.digest);
        kept.push_back(Arc::new(record.clone()));
        if kept.len() > KEPT {
            kept.pop_front();
        }
    }

    fn of(&self, digest: &str) -> Option<Arc<Record>> {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        kept.iter().find(|record| record.problem.digest == digest).cloned()
    }
}

/// The reason why a linkage cannot be described, exported or compared.
#[derive(Debug, thiserror::Error)]
pub(super) enum DetailsError {
    #[error(transparent)]
    Ask(#[from] AskError),
    #[error(transparent)]
    Shelf(#[from] ShelfError),
    /// The recorded problem is invalid.
    #[error(transparent)]
    Problem(#[from] ProblemError),
    #[error("the record of {name} is not true: {first}")]
    Untrue { name: String, first: Mismatch },
    #[error("{name} has no candidate {rank}: it has {n}")]
    NoRank { name: String, rank: usize, n: usize },
    #[error(transparent)]
    Linkage(#[from] NoLinkage),
    #[error("`crank_deg` and `t1_at` have one value for each of the {0} points")]
    Positions(usize),
    #[error("`t1_at` holds 1 and -1 alone")]
    Assembly,
    #[error("this linkage cannot be assembled at every point")]
    NotAssembled,
    #[error("{0} takes no settings")]
    NoSettings(String),
    #[error("{0}, html, sheet, points, layers or archive")]
    Format(#[from] UnknownFormat),
    #[error("{}: {}", .0.message, .0.help)]
    Export(Refusal),
    #[error("the files cannot be packed: {0}")]
    NotPacked(String),
    #[error(transparent)]
    Name(#[from] NameError),
    #[error("forces need a unit of length: choose mm, cm, m or in under Points")]
    NoUnit,
    #[error(transparent)]
    Loads(#[from] LoadError),
    #[error("compare 1 to {MOST_COMPARED} linkages")]
    HowMany,
    #[error(transparent)]
    Sort(#[from] UnknownKey),
    #[error(transparent)]
    NotCompared(#[from] NotCompared),
}

/// A record and one of its candidates, counted from 0.
pub(super) struct Found {
    pub(super) record: Record,
    index: usize,
}

impl Found {
    pub(super) fn candidate(&self) -> &Candidate {
        &self.record.candidates[self.index]
    }
}

impl House {
    pub(super) fn find(&self, source: &Source, with_costs: bool) -> Result<Found, DetailsError> {
        match source {
            Source::Job(OfJob { name, rank }) => {
                let record = self.jobs.shelf.record(name)?;
                if let Some(first) = verify(&record)?.into_iter().next() {
                    return Err(DetailsError::Untrue { name: name.clone(), first });
                }
                let n = record.candidates.len();
                if *rank == 0 || *rank > n {
                    return Err(DetailsError::NoRank { name: name.clone(), rank: *rank, n });
                }
                Ok(Found { record, index: rank - 1 })
            }
            Source::Drawn(drawn) => self.drawn(drawn, with_costs),
        }
    }

    fn drawn(&self, drawn: &Drawn, with_costs: bool) -> Result<Found, DetailsError> {
        let file = drawn.ask.problem()?;
        let problem = Problem::new(file.spec.clone()).map_err(AskError::Task)?;
        let linkage = CrankLinkage::try_from(drawn.linkage.clone())?;
        let n = problem.task().len();
        if drawn.crank_deg.len() != n || drawn.t1_at.len() != n {
            return Err(DetailsError::Positions(n));
        }
        let assembly = |t1: &i64| serde_json::from_value((*t1).into()).map_err(|_| DetailsError::Assembly);
        let t1_at: Vec<AssemblyMode> = drawn.t1_at.iter().map(assembly).collect::<Result<_, _>>()?;
        let asked = ProblemRecord::try_from(Job::from(file)).map_err(ProblemError::from)?;
        if let Some(record) = self.searches.finished.of(&asked.digest) {
            let same = |c: &Candidate| c.linkage == linkage && c.crank_deg == drawn.crank_deg;
            if let Some(index) = record.candidates.iter().position(same) {
                let mut record = (*record).clone();
                (record.problem.name, record.problem.unit) = (asked.name, asked.unit);
                return Ok(Found { record, index });
            }
        }
        let mut candidate =
            assess(&problem, linkage, &drawn.crank_deg, &t1_at).ok_or(DetailsError::NotAssembled)?;
        candidate.rank = 1;
        let mut candidates = if with_costs { priced(&problem, candidate) } else { vec![candidate] };
        for candidate in &mut candidates {
            annotate(&problem, candidate);
            measure_beside(&problem, candidate);
        }
        // No search ended with it: it was fitted under the hand, and that was ended by hand.
        let used = vec!["following-the-hand".into()];
        let record = Record::new(asked, used, Reason::ByHand, Evaluations::default(), candidates);
        Ok(Found { record, index: 0 })
    }

    /// Judges a linkage over the target of an edit, each point met where the linkage comes nearest to it.
    ///
    /// # Errors
    /// [`DetailsError`].
    pub(super) fn judged(&self, JudgeAsk { ask, linkage }: &JudgeAsk) -> Result<Shown, DetailsError> {
        let problem = Problem::new(ask.problem()?.spec).map_err(AskError::Task)?;
        let linkage = CrankLinkage::try_from(linkage.clone())?;
        let positions = nearest_positions(&problem, linkage);
        let judged = positions.and_then(|(crank_deg, t1_at)| assess(&problem, linkage, &crank_deg, &t1_at));
        let candidate = judged.ok_or(DetailsError::NotAssembled)?;
        Ok(Shown { rank: 1, ..Shown::of(&candidate) })
    }

    /// Returns the details of a linkage.
    ///
    /// # Errors
    /// [`DetailsError`].
    pub(super) fn details(&self, ask: &DetailsAsk) -> Result<Details, DetailsError> {
        let found = self.find(&ask.of, true)?;
        let Found { record, index } = &found;
        let ProblemSpec { task: path, require, .. } = &record.problem.resolved;
        Ok(Details {
            target: Target::from(&record.problem),
            tolerance: path.tolerance.clone(),
            transmission_deg_min: require.transmission_deg_min,
            candidates: record.candidates.len(),
            shown: Shown::of(found.candidate()),
            summary: html::summary_markup(record),
            words: html::candidate_markup(record, *index).unwrap_or_default(),
        })
    }

    /// Returns a linkage as a file.
    ///
    /// # Errors
    /// [`DetailsError`].
    pub(super) fn file(&self, ask: &ExportAsk) -> Result<Handed, DetailsError> {
        let plain = ["html", "sheet", "points"].contains(&ask.format.as_str());
        if plain && !ask.set.is_empty() {
            return Err(DetailsError::NoSettings(ask.format.clone()));
        }
        let found = self.find(&ask.of, ask.format == "html")?;
        let Found { record, index } = &found;
        Ok(match ask.format.as_str() {
            "html" => Handed::saved("html", html::report_html(record, *index)),
            "sheet" => Handed::saved("svg", svg::candidate_svg(record, *index)),
            "points" => Handed::saved("csv", csv::candidate_curve_csv(found.candidate())),
            "layers" => Handed::saved("txt", workshop::layers(record, found.candidate(), &ask.set)?),
            "archive" => {
                let name = ask.name.as_ref().unwrap_or(&record.problem.name);
                name::check(name)?;
                let problem = match &ask.of {
                    Source::Job(_) => None,
                    Source::Drawn(drawn) => Some(drawn.ask.problem_with_text()?.1),
                };
                Handed::saved("zip", workshop::archive(record, *index, (name, problem), &ask.set)?)
            }
            other => {
                let format: Format = other.parse()?;
                let set: Vec<_> = ask.set.iter().map(|(k, v)| (k.clone(), v.clone())).collect();
                let settings = Settings::parse(format, &set).map_err(DetailsError::Export)?;
                let subject = Subject::of_candidate(record, found.candidate());
                let bytes = export(&subject, format, &settings).map_err(DetailsError::Export)?.bytes;
                Handed::saved(ending_of(format), bytes)
            }
        })
    }

    /// Compares linkages side by side.
    ///
    /// # Errors
    /// [`DetailsError`].
    pub(super) fn compared(&self, ask: &CompareAsk) -> Result<Handed, DetailsError> {
        if ask.of.is_empty() || ask.of.len() > MOST_COMPARED {
            return Err(DetailsError::HowMany);
        }
        let keys = ask.sort.iter().map(|key| key.parse()).collect::<Result<Vec<SortKey>, _>>()?;
        let mut given = Vec::new();
        for (i, source) in ask.of.iter().enumerate() {
            // With costs: they are worked out again where the record is proved.
            let Found { record, index } = self.find(source, true)?;
            let named = match source {
                Source::Job(of) => self.jobs.shelf.folder.join(&of.name).display().to_string(),
                Source::Drawn(_) => format!("drawing {}", i + 1),
            };
            let run = Run { named, record, which: Which::Rank(index + 1) };
            given.push((Path::new(""), Given::Run(Box::new(run))));
        }
        let comparison = compared(&given, None, &keys, None)?;
        Ok(match ask.form {
            Form::Json => Handed::shown("json", comparison.json()),
            Form::Html => Handed::saved("html", comparison.html()),
            Form::Csv => Handed::saved("csv", comparison.csv()),
            Form::Svg => Handed::saved("svg", comparison.svg()),
        })
    }
}

/// Returns a candidate with the costs of its limits.
fn priced(problem: &Problem, candidate: Candidate) -> Vec<Candidate> {
    let mut outcome = SearchOutcome {
        candidates: vec![candidate],
        others: Vec::new(),
        used: Vec::new(),
        reason: Reason::ByHand,
        evaluations: Evaluations { objective: EFFORT, positions: 0 },
        exact: None,
        repeats: None,
    };
    let cancel = AtomicBool::new(false);
    let budget = Budget::new(&cancel, Some(PATIENCE_S));
    errors_without::attach(Context::new(problem, &budget), &mut outcome);
    outcome.candidates
}

/// Returns the ending of the files of a format.
fn ending_of(format: Format) -> &'static str {
    match format {
        Format::SvgPlates => "svg",
        Format::DxfPlates => "dxf",
        Format::CutListCsv => "csv",
        Format::CutList => "txt",
        other => other.name(),
    }
}
