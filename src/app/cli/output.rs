//! Output files at places that a user names: files of other origin are kept, unless `--force`.

use super::{Ended, refuse, result, terminal};
use crate::app::job::folder::{FolderError, OutputFile, Replace, check_files, write_files};
use crate::files::generator::FileKind;
use std::path::{Path, PathBuf};

/// A form in which an answer can be written: the path that was given for it, if any, and its text, made when it is
/// wanted.
pub type Form<'a> = (&'a Option<PathBuf>, FileKind, &'a dyn Fn() -> String);

/// The rule by which a command's files replace others.
pub struct Output {
    /// The files that the command reads; they are replaced with `--force` alone.
    inputs: Vec<PathBuf>,
    force: bool,
}

impl Output {
    /// The rule for a command that reads these files or RESULTs.
    pub fn new<'p>(inputs: impl IntoIterator<Item = &'p PathBuf>, force: bool) -> Self {
        Output { inputs: inputs.into_iter().map(|input| result::file_of(input)).collect(), force }
    }

    /// Refuses places that may not be written to, before the work. A table needs its header row for that.
    ///
    /// # Errors
    /// [`Ended::Refused`]; the reason has been reported.
    pub fn check(&self, files: &[(impl AsRef<Path>, FileKind, impl AsRef<[u8]>)]) -> Result<(), Ended> {
        self.act(files, check_files)
    }

    /// Writes all the files, or refuses before the first.
    ///
    /// # Errors
    /// [`Ended::Refused`]; the reason has been reported.
    pub fn write(&self, files: &[(impl AsRef<Path>, FileKind, impl AsRef<[u8]>)]) -> Result<(), Ended> {
        self.act(files, write_files)
    }

    /// Makes and writes the files whose paths were given, and returns these paths as they are shown.
    ///
    /// # Errors
    /// [`Ended::Refused`]; the reason has been reported.
    pub fn write_asked(&self, forms: &[Form<'_>]) -> Result<Vec<String>, Ended> {
        let asked = forms.iter().filter_map(|(path, kind, text)| Some((path.as_deref()?, *kind, text())));
        let asked: Vec<_> = asked.collect();
        self.write(&asked)?;
        Ok(asked.iter().map(|(path, ..)| terminal::shown(path)).collect())
    }

    fn act(
        &self,
        files: &[(impl AsRef<Path>, FileKind, impl AsRef<[u8]>)],
        act: fn(&[OutputFile<'_>], Replace<'_>) -> Result<(), FolderError>,
    ) -> Result<(), Ended> {
        let files = files.iter().map(|(path, kind, bytes)| OutputFile {
            path: path.as_ref(),
            kind: *kind,
            bytes: bytes.as_ref(),
        });
        let inputs: Vec<&Path> = self.inputs.iter().map(PathBuf::as_path).collect();
        let replace = if self.force { Replace::Anything } else { Replace::Ours(&inputs) };
        act(&files.collect::<Vec<_>>(), replace).map_err(refuse)
    }
}
