//! Problems: from a file, or from a dict with the keys of a problem file.

use crate::errors::{guarded, refused};
use crate::values;
use linkwright::ProblemFile;
use linkwright::internals::app::job::run::Job;
use linkwright::internals::files::diagnostic::Diagnostic;
use linkwright::internals::files::problem_file;
use linkwright::internals::record::digest::digest;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

/// The name of a problem without a file, as errors show it.
const NOWHERE: &str = "problem";

/// The origin of a problem, from which it is read again with overrides.
#[derive(Clone, Debug)]
enum Origin {
    File(PathBuf),
    Text(String),
}

/// A checked problem, from :func:`linkwright.path` and its like or from a file.
#[pyclass(frozen, module = "linkwright._linkwright")]
pub struct Problem {
    origin: Origin,
    file: ProblemFile,
}

impl Origin {
    fn read(&self, overrides: &[(String, String)]) -> Result<ProblemFile, Box<Diagnostic>> {
        match self {
            Origin::File(path) => problem_file::load_any(path, overrides),
            // Files that it names are looked for in the working folder.
            Origin::Text(text) => problem_file::parse_own(NOWHERE, text, Path::new(""), overrides),
        }
    }
}

impl Problem {
    /// Returns the job of the problem, with overrides.
    pub fn job(&self, overrides: &[(String, String)]) -> PyResult<Job> {
        let file = if overrides.is_empty() {
            self.file.clone()
        } else {
            self.origin.read(overrides).map_err(refused)?
        };
        Ok(file.into())
    }

    /// Returns the problem as it was read.
    pub fn file(&self) -> &ProblemFile {
        &self.file
    }
}

/// Returns the overrides of a dict of dotted keys.
pub fn overrides(set: Option<&Bound<'_, PyDict>>) -> PyResult<Vec<(String, String)>> {
    let pair = |(key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let key: String = key.extract()?;
        let value = values::text(&value, &key)?;
        Ok((key, value))
    };
    set.map_or(Ok(Vec::new()), |set| set.iter().map(pair).collect())
}

#[pymethods]
impl Problem {
    /// Reads the problem of a file.
    #[staticmethod]
    fn load(path: PathBuf) -> PyResult<Self> {
        guarded(|| {
            let origin = Origin::File(path);
            let file = origin.read(&[]).map_err(refused)?;
            Ok(Problem { origin, file })
        })
    }

    /// Reads the problem of a dict with the keys of a problem file.
    #[staticmethod]
    fn of(keys: &Bound<'_, PyAny>) -> PyResult<Self> {
        guarded(|| {
            let text = toml::to_string(&values::table(keys)?).map_err(refused)?;
            Problem::parse(text)
        })
    }

    /// Reads the problem of a text in the format of a problem file.
    #[staticmethod]
    fn parse(text: String) -> PyResult<Self> {
        guarded(|| {
            let origin = Origin::Text(text);
            let file = origin.read(&[]).map_err(refused)?;
            Ok(Problem { origin, file })
        })
    }

    /// The name.
    #[getter]
    fn name(&self) -> &str {
        &self.file.name
    }

    /// The source of the problem, in words.
    #[getter]
    fn source(&self) -> Option<&str> {
        self.file.source.as_deref()
    }

    /// The unit of its lengths: mm, cm, m or in.
    #[getter]
    fn unit(&self) -> Option<&'static str> {
        self.file.unit.map(|unit| unit.label())
    }

    /// Returns the points of the target; none of a function.
    fn points(&self) -> Vec<[f64; 2]> {
        self.file.spec.task.points.clone()
    }

    /// Every key with its default filled in.
    #[getter]
    fn resolved<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        values::data(py, &self.file.spec)
    }

    /// The least sum of squares known, of a problem that states it.
    #[getter]
    fn best_known_sum_sq(&self) -> Option<f64> {
        self.file.expect.as_ref()?.best_known_sum_sq
    }

    /// The least objective known, of a motion or a function that states it.
    #[getter]
    fn best_known_objective(&self) -> Option<f64> {
        self.file.expect.as_ref()?.objective
    }

    /// Warnings about values that are ignored or cannot succeed.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.file.warnings.iter().map(ToString::to_string).collect()
    }

    /// SHA-256 of everything that determines a search.
    #[getter]
    fn digest(&self) -> PyResult<String> {
        digest(&self.file.spec).map_err(refused)
    }

    /// The text of its file.
    #[getter]
    fn text(&self) -> PyResult<String> {
        match &self.origin {
            Origin::Text(text) => Ok(text.clone()),
            Origin::File(path) => std::fs::read_to_string(path).map_err(refused),
        }
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let class = py.get_type::<Problem>();
        Ok(match &self.origin {
            Origin::Text(text) => (class.getattr("parse")?, (text.clone(),)),
            Origin::File(path) => (class.getattr("load")?, (path.display().to_string(),)),
        })
    }

    fn __repr__(&self) -> String {
        format!("<Problem {:?}: {} points>", self.file.name, self.file.spec.task.points.len())
    }
}
