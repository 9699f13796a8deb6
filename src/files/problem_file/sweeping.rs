//! Reads the problem of a sweep: as a text with the files that it names, so that a plan holds all that its jobs need.

use super::raw::RawProblem;
use super::target::Whereabouts;
use super::{folder_of, is_bare_target, kind_of_bare, overrides, text_about};
use crate::files::diagnostic::{Checked, Diagnostic};
use crate::files::input_text;
use crate::files::linkage_file::check_format;
use crate::files::toml_text::TomlText;
use crate::record::sweep::PlannedFile;
use std::path::Path;

/// The problem of a sweep, before any key is varied.
#[derive(Clone, Debug)]
pub(crate) struct Template {
    /// The problem file.
    pub problem: PlannedFile,
    /// The points file or the drawing that it names, if any.
    pub beside: Vec<PlannedFile>,
}

impl Template {
    /// Reads a problem file, a bare points file or a bare drawing. Its syntax and the types of its values are checked, and
    /// that a run of it can be repeated; its meaning is left to the jobs, whose keys differ.
    pub fn load(path: &Path) -> Checked<Template> {
        let shown = path.display().to_string();
        let Some(name) = path.file_name().and_then(|name| name.to_str()).map(str::to_owned) else {
            let diagnostic = Diagnostic::new(shown, "", "the name of this file is not text");
            return Err(Box::new(diagnostic.with_help("rename the file")));
        };
        let text = if is_bare_target(path) {
            text_about(&name, kind_of_bare(path))
        } else {
            input_text::read(path)?
        };
        let toml = TomlText { file: &shown, text: &text };
        let raw: RawProblem = toml.read()?;
        check_format(&toml, raw.format, super::FORMAT)?;
        let solve = &raw.solve.0;
        if solve.time_limit_s.is_some() {
            return refuse_clock(&toml, "solve.time_limit_s");
        }
        if solve.certify {
            return refuse_clock(&toml, "solve.certify");
        }
        let task = raw.task.as_ref().map(|task| &task.0);
        let of_path = task.and_then(|task| task.path.as_ref()).map(|path| &path.0);
        let of_motion = task.and_then(|task| task.motion.as_ref()).map(|motion| &motion.0);
        let named = [
            ("task.path.file", of_path.and_then(|path| path.file.as_deref())),
            ("task.path.svg", of_path.and_then(|path| path.svg.as_deref())),
            ("task.motion.file", of_motion.and_then(|motion| motion.file.as_deref())),
        ];
        let mut beside = Vec::new();
        for (key, file) in named {
            if let Some(file) = file {
                beside.push(named_file(&toml, path, key, file)?);
            }
        }
        Ok(Template { problem: PlannedFile { name, text }, beside })
    }

    /// Reads a file that a value of `task.path.file`, `task.path.svg` or `task.motion.file` names, unless it is held already.
    pub fn add_named(&mut self, path: &Path, key: &str, file: &str) -> Checked<()> {
        if self.beside.iter().all(|held| held.name != file) {
            let toml = TomlText { file: &self.problem.name, text: "" };
            self.beside.push(named_file(&toml, path, key, file)?);
        }
        Ok(())
    }
}

/// Refuses a key of a problem whose runs the clock may end.
fn refuse_clock<T>(toml: &TomlText<'_>, key: &str) -> Checked<T> {
    let (message, help) = clock(key);
    toml.refuse_key(key, message, help)
}

/// Returns the fault of a key that lets the clock decide, with its remedy.
fn clock(key: &str) -> (String, &'static str) {
    if key == "solve.time_limit_s" {
        let message = "a run that the clock ends cannot be repeated, so that a sweep has no time_limit_s";
        (message.into(), "remove the key; `evaluations` limits a search by its work")
    } else {
        let message =
            format!("a sweep proves nothing: the clock may end a certificate, so that {key} is refused");
        (message, "remove the key; `linkwright certify` proves a result of `synth`")
    }
}

/// Reads a points file or a drawing that a problem file names.
fn named_file(toml: &TomlText<'_>, problem: &Path, key: &str, file: &str) -> Checked<PlannedFile> {
    let whereabouts = Whereabouts { folder: Some(folder_of(problem)), anywhere: false, beside: &[] };
    let place = whereabouts.find(toml, key, file)?;
    Ok(PlannedFile { name: file.to_owned(), text: input_text::read(&place)? })
}

/// Checks that a key exists in a problem and takes values of this type; its meaning is left to the jobs. `problem` is a
/// text that has been read before.
///
/// # Errors
/// The fault and its remedy.
pub(crate) fn check_value(
    problem: &PlannedFile,
    key: &str,
    value: &str,
) -> Result<(), (String, Option<String>)> {
    if key == "solve.time_limit_s" || key == "solve.certify" || key.starts_with("certify.") {
        let (message, help) = clock(key);
        return Err((message, Some(help.into())));
    }
    let toml = TomlText { file: &problem.name, text: &problem.text };
    let (file, text) =
        overrides::apply(&toml, &[(key.to_owned(), value.to_owned())]).map_err(|d| (d.message, d.help))?;
    let read = TomlText { file: &file, text: &text }.read::<RawProblem>();
    read.map(drop).map_err(|d| (d.message, d.help))
}
