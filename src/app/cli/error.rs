//! Errors of commands, apart from those that another layer names.

use crate::app::job::folder::FolderError;
use crate::files::diagnostic::Diagnostic;
use crate::synthesis::front::AxesError;

/// The reason why a command cannot be carried out.
#[derive(Debug, thiserror::Error)]
pub enum CommandError {
    /// A file may not be replaced or cannot be written, or a folder cannot be read.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The file in the place of a batch's summary is no summary; there is no `--force` for it.
    #[error(
        "{path} is no summary of a batch of this version: move it away, or give another folder with --out"
    )]
    NotASummary { path: String },
    /// A folder holds too many problem files.
    #[error("{folder} holds more than {most} problem files; give some of them")]
    TooMany { folder: String, most: usize },
    /// A folder holds no problem file.
    #[error("the folder {0} holds no problem file (*.toml with a [task])")]
    NoProblems(String),
    /// Two problems have one folder for their results.
    #[error("{one} and {other} would both write to {place}; give them different names (key `name`)")]
    SamePlace { one: String, other: String, place: String },
    /// The axes of a front do not go with the problem.
    #[error(transparent)]
    Axes(#[from] AxesError),
    /// A problem file is invalid.
    #[error("{}", .0.message)]
    Problem(#[from] Box<Diagnostic>),
}
