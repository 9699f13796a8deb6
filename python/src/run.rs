//! Runs: a record with everything that is derived from it.

use crate::chain::Chain;
use crate::errors::{bug, guarded, refused};
use crate::linkage::FourBar;
use crate::problem::{Problem, overrides};
use crate::slider::SliderLinkage;
use crate::waiting::{Ended, Talk, carrying, run};
use crate::{pools, values};
use linkwright::internals::app::certificates::{self, Unusable};
use linkwright::internals::app::inputs::{self, Given, Which};
use linkwright::internals::app::job::files::{self, Timing};
use linkwright::internals::app::job::folder::{
    CERTIFICATE_CHECKPOINT, LEAVES, ResultsFolder, TIMING, parse_record, read_record,
};
use linkwright::internals::app::job::run::{Context, Finished, Job, prove, run as search};
use linkwright::internals::app::job::save::{self, Listener, Options, Ran};
use linkwright::internals::files::linkage_file::{AnyLinkageFile, LinkageFile};
use linkwright::internals::judge::certificate;
use linkwright::internals::mechanism::CrankLinkage;
use linkwright::internals::report::html::Shown;
use linkwright::internals::report::html::{candidate_markup, report_showing, summary_markup};
use linkwright::internals::report::svg::drawing_svg;
use linkwright::internals::report::table::candidates_table;
use linkwright::internals::report::{Colour, csv};
use linkwright::internals::synthesis::Progress;
use linkwright::internals::synthesis::front::FrontRequest;
use linkwright::{Candidate, Record};
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde_json::json;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// A record with everything that follows from it; :class:`linkwright.Result` is the class to use.
#[pyclass(frozen, module = "linkwright._linkwright")]
#[derive(Clone)]
pub struct Run {
    pub record: Arc<Record>,
    pub timing: Option<Timing>,
    /// The folder that it was written to or read from.
    pub folder: Option<PathBuf>,
    /// The leaves of its certificate, if it was proved here.
    pub leaves: Option<Arc<Vec<u8>>>,
    /// The checkpoint of its proof, if it was begun here and can go on.
    pub checkpoint: Option<Arc<Vec<u8>>>,
}

/// The run's folder and how it is used.
#[derive(Clone)]
pub struct Place {
    folder: PathBuf,
    resume: bool,
}

/// Returns a search's progress by name.
fn told(progress: &Progress) -> serde_json::Value {
    let Progress { phase, evaluations, budget, best_sum_sq, accepted, .. } = progress;
    json!({
        "phase": phase, "evaluations": evaluations, "budget": budget,
        "best_sum_sq": best_sum_sq, "accepted": accepted,
    })
}

/// Returns a certificate's progress by name.
pub fn told_of_proof(progress: &certificate::Progress) -> serde_json::Value {
    let certificate::Progress { boxes, decided, lower_bound, gap } = progress;
    json!({ "phase": "certificate", "boxes": boxes, "decided": decided, "lower_bound": lower_bound, "gap": gap })
}

/// Runs a job, in its folder if it has one.
fn searched(job: &Job, place: Option<&Place>, talk: &Talk) -> Result<Run, String> {
    let begun = Instant::now();
    let observer = |progress: &Progress| talk.tell(|| told(progress));
    let proving = |progress: &certificate::Progress| talk.tell(|| told_of_proof(progress));
    let threads = rayon::current_num_threads();
    let Some(Place { folder, resume }) = place else {
        let context = Context { cancel: &talk.cancel, observer: &observer };
        let Finished { mut record, search_s, beside_s, advice_s } =
            search(job, &context).map_err(|why| format!("{}: {why}", job.name))?;
        prove(&mut record, &talk.cancel, &mut |progress| proving(progress));
        let advice_s = Some(advice_s).filter(|_| job.spec.solve.advice);
        let total_s = begun.elapsed().as_secs_f64();
        let timing = Some(Timing { search_s, beside_s, advice_s, total_s, threads });
        return Ok(Run { record: Arc::new(record), timing, folder: None, leaves: None, checkpoint: None });
    };
    let listener = Listener { observer: &observer, proving: &proving, tell: &|_| {} };
    let how = Options { resume: *resume, ..Options::default() };
    let ran = save::run(job, folder, how, listener, &talk.cancel, begun).map_err(|why| why.to_string())?;
    let done = match ran {
        Ran::Before(done) => done,
        Ran::Written(written) => {
            let mut put = save::put_in_place(vec![written]);
            put.pop().ok_or("nothing was written")?.map_err(|why| why.to_string())?
        }
    };
    Ok(Run {
        record: Arc::new(done.record),
        timing: done.timing,
        folder: Some(done.folder),
        leaves: None,
        checkpoint: None,
    })
}

/// Runs a problem; `front` names the axes and the number of members of a front.
#[pyfunction]
#[pyo3(signature = (problem, set = None, threads = None, progress = None, out = None, resume = false, front = None))]
#[expect(clippy::too_many_arguments, reason = "the options of a search")]
pub fn synth<'py>(
    py: Python<'py>,
    problem: &Bound<'py, Problem>,
    set: Option<&Bound<'py, PyDict>>,
    threads: Option<i64>,
    progress: Option<&Bound<'py, PyAny>>,
    out: Option<PathBuf>,
    resume: bool,
    front: Option<(Vec<String>, usize)>,
) -> PyResult<Run> {
    guarded(|| {
        let job = problem.get().job(&overrides(set)?)?;
        let front = front.map(|(axes, points)| request(&axes, points)).transpose()?;
        let job = Job { front, ..job };
        let place = out.map(|folder| Place { folder, resume });
        let threads = pools::threads(threads)?;
        let Ended { value, interrupt } =
            run(py, threads, progress, move |talk| searched(&job, place.as_ref(), talk))?;
        let found = value.map_err(refused)?;
        match interrupt {
            None => Ok(found),
            Some(interrupt) => Err(carrying(py, interrupt, Bound::new(py, found)?.into_any())),
        }
    })
}

fn request(axes: &[String], points: usize) -> PyResult<FrontRequest> {
    use linkwright::internals::record::{Axis, MOST_MEMBERS};
    let axis = |name: &String| {
        let names = || Axis::ALL.map(Axis::name).join(", ");
        Axis::named(name).ok_or_else(|| refused(format!("--axes {name}: write two to four of {}", names())))
    };
    let axes = axes.iter().map(axis).collect::<PyResult<Vec<_>>>()?;
    if !(1..=MOST_MEMBERS).contains(&points) {
        return Err(refused(format!("--points {points}: 1 to {MOST_MEMBERS} are possible")));
    }
    let request = FrontRequest { axes, points };
    request.check().map_err(refused)?;
    Ok(request)
}

/// Opens a result: a folder, or its record.json.
#[pyfunction]
pub fn open(path: PathBuf) -> PyResult<Run> {
    guarded(|| {
        let record = read_record(&path).map_err(refused)?;
        Ok(Run { record: Arc::new(record), timing: None, folder: Some(path), leaves: None, checkpoint: None })
    })
}

/// Returns whether a result, a folder or its `record.json`, lies in a folder.
fn is_same(result: &Path, folder: &Path) -> bool {
    let of = |path: &Path| std::fs::canonicalize(path).ok();
    let own = if result.is_dir() { of(result) } else { result.parent().and_then(of) };
    own.is_some() && own == of(folder)
}

/// Reads the text of a record.json.
#[pyfunction]
pub fn parse_run(text: &[u8]) -> PyResult<Run> {
    guarded(|| {
        let record = parse_record("record.json", text).map_err(refused)?;
        Ok(Run { record: Arc::new(record), timing: None, folder: None, leaves: None, checkpoint: None })
    })
}

impl Run {
    /// Returns a run of a record that was computed here.
    pub fn of(record: Record) -> Self {
        Run { record: Arc::new(record), timing: None, folder: None, leaves: None, checkpoint: None }
    }

    /// Returns the run with the choice of one of its linkages, or of all: as after the colon of a RESULT.
    ///
    /// # Errors
    /// `ProblemError` if it has no such linkage.
    pub fn given(&self, which: Option<&str>) -> PyResult<Given> {
        let named =
            self.folder.as_ref().map_or(self.record.problem.name.clone(), |f| f.display().to_string());
        let record = (*self.record).clone();
        let which = which
            .map_or(Ok(Which::All), |name| Which::named(name).ok_or_else(|| refused(inputs::choices())))?;
        if let Some(why) = inputs::missing(&record, which) {
            return Err(refused(format!("{named}: {why}")));
        }
        Ok(Given::Run(Box::new(inputs::Run { named, record, which })))
    }

    /// Returns one of its linkages, of any kind.
    pub fn any_linkage(&self, which: &str) -> PyResult<AnyLinkageFile> {
        let (candidate, name) = self.chosen(which)?;
        Ok(AnyLinkageFile { name, unit: self.record.problem.unit, linkage: candidate.linkage.into() })
    }

    fn chosen(&self, which: &str) -> PyResult<(Candidate, String)> {
        let Given::Run(run) = self.given(Some(which))? else { return Err(bug(&"a linkage")) };
        let chosen = run.one().map_err(refused)?;
        Ok((chosen.candidate.clone(), files::linkage_name(&self.record, &chosen.suffix)))
    }

    /// Returns the files that belong to the run beside what its record gives: the leaves and the checkpoint of its proof and
    /// its times, those that it holds, else those in the folder that it was read from.
    ///
    /// # Errors
    /// [`Unusable`] for a file that cannot be read.
    fn beside(&self) -> Result<Vec<(&'static str, Vec<u8>)>, Unusable> {
        let from = self.folder.as_deref();
        let leaves = match (&self.leaves, from.filter(|_| self.record.certificate.is_some())) {
            (Some(leaves), _) => Some(leaves.to_vec()),
            (None, Some(from)) => match certificates::read_leaves(from) {
                Err(Unusable::NoLeaves(_)) => None,
                read => Some(read?),
            },
            (None, None) => None,
        };
        let checkpoint = match (&self.checkpoint, from) {
            (Some(checkpoint), _) => Some(checkpoint.to_vec()),
            (None, Some(from)) => certificates::read_checkpoint(from)?,
            (None, None) => None,
        };
        let timing = from.filter(|_| self.timing.is_none());
        let timing = timing.and_then(|from| std::fs::read(certificates::beside(from, TIMING)).ok());
        let all = [(LEAVES, leaves), (CERTIFICATE_CHECKPOINT, checkpoint), (TIMING, timing)];
        Ok(all.into_iter().filter_map(|(name, bytes)| Some((name, bytes?))).collect())
    }

    fn timing(&self) -> Timing {
        let unknown = Timing { search_s: 0.0, beside_s: 0.0, advice_s: None, total_s: 0.0, threads: 0 };
        self.timing.unwrap_or(unknown)
    }
}

#[pymethods]
impl Run {
    /// The name.
    #[getter]
    fn name(&self) -> &str {
        &self.record.problem.name
    }

    #[getter]
    fn folder(&self) -> Option<PathBuf> {
        self.folder.clone()
    }

    #[getter]
    fn candidates(&self) -> usize {
        self.record.candidates.len()
    }

    #[getter]
    fn members(&self) -> usize {
        self.record.front.as_ref().map_or(0, |front| front.members.len())
    }

    /// The bytes of record.json.
    fn record_json<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        guarded(|| Ok(PyBytes::new(py, &files::record_json(&self.record).map_err(refused)?)))
    }

    /// The times of the run.
    #[getter(timing)]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.timing.map(|timing| values::data(py, &timing)).transpose()
    }

    /// The linkage of a candidate (`"1"`), a pick (`"smallest"`) or a member of the front (`"front-2"`).
    pub fn linkage<'py>(&self, py: Python<'py>, which: &str) -> PyResult<Bound<'py, PyAny>> {
        guarded(|| {
            let (candidate, name) = self.chosen(which)?;
            let unit = self.record.problem.unit;
            Ok(match candidate.linkage {
                CrankLinkage::FourBar(linkage) => {
                    Bound::new(py, FourBar { file: LinkageFile { name, unit, linkage } })?.into_any()
                }
                CrankLinkage::MultiLoop(linkage) => {
                    Bound::new(py, Chain::of(name, unit, &linkage)?)?.into_any()
                }
                linkage => Bound::new(py, SliderLinkage { name, unit, linkage })?.into_any(),
            })
        })
    }

    /// The drawing of one of its linkages as SVG.
    fn svg(&self, which: &str) -> PyResult<String> {
        guarded(|| Ok(drawing_svg(&self.record, Some(&self.chosen(which)?.0))))
    }

    /// The table that `synth` prints.
    fn text(&self) -> String {
        candidates_table(&self.record, Colour::Never)
    }

    /// The report's header on the whole run, as markup.
    fn summary_html(&self) -> String {
        summary_markup(&self.record)
    }

    /// The report on a candidate, counted from 0, as markup.
    fn candidate_html(&self, index: usize) -> PyResult<String> {
        candidate_markup(&self.record, index)
            .ok_or_else(|| PyIndexError::new_err("there is no such candidate"))
    }

    /// The page of the report, with the motion.
    fn report_html(&self, py: Python<'_>) -> String {
        py.detach(|| report_showing(&self.record, Shown::Candidate(0)))
    }

    /// The table of the candidates as CSV.
    fn candidates_csv(&self) -> String {
        csv::candidates_csv(&self.record)
    }

    /// The table of the front as CSV; empty without a front.
    fn front_csv(&self) -> String {
        if self.record.front.is_some() { csv::front_csv(&self.record) } else { String::new() }
    }

    /// Writes the folder that `synth` writes.
    fn save(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        guarded(|| {
            let taken = self.clone();
            let written = crate::waiting::run_whole(py, move |_| {
                let mut place = ResultsFolder::take(&folder).map_err(|why| why.to_string())?;
                let mut all = files::files(&taken.record, &taken.timing()).map_err(|why| why.to_string())?;
                let beside = taken.beside().map_err(|why| why.to_string())?;
                for (name, bytes) in beside {
                    all.retain(|(other, _)| other != name);
                    all.push((name.into(), bytes));
                }
                if taken.folder.as_ref().is_some_and(|from| is_same(from, &folder)) && place.has_checkpoint()
                {
                    place.keep_checkpoint();
                }
                place.replace(&all).map_err(|why| why.to_string())
            })?;
            written.map_err(refused)
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let read = py.import("linkwright._linkwright")?.getattr("parse_run")?;
        Ok((read, (self.record_json(py)?,)))
    }
}
