//! The choice of a suite's problems: from a folder, or from the literature that the program holds.

use super::literature;
use crate::app::inputs::toml_files;
use crate::files::diagnostic::Diagnostic;
use crate::files::name;
use crate::files::problem_file;
use crate::files::problem_file::ProblemFile;
use std::io;
use std::path::Path;

/// The reason why a suite has no problems.
#[derive(Debug, thiserror::Error)]
pub enum NoProblems {
    /// Problem files are refused.
    #[error("{}", texts(.0))]
    Files(Vec<Box<Diagnostic>>),
    /// The folder cannot be read.
    #[error(
        "the folder of problems {folder} cannot be read: {source}; name another with --problems, or leave it out for the \
         problems that linkwright has in it"
    )]
    Folder {
        /// The folder.
        folder: String,
        /// The error of the system.
        source: io::Error,
    },
    /// No answer is known of any problem.
    #[error(
        "no problem in {0} has an [expect] table with best_known_sum_sq (of a path) or objective (of a motion or a function)"
    )]
    NoneKnown(String),
    /// No answer is known of the problems that are asked for.
    #[error(
        "{names}: nothing to compare with; give a problem an [expect] table with best_known_sum_sq (of a path) or objective \
         (of a motion or a function)"
    )]
    NoneKnownOf {
        /// The names of the problems.
        names: String,
    },
    /// No problem has the name that is asked for.
    #[error("no problem in {place} has {filter:?} in its name; there are {names}")]
    NoneNamed {
        /// The folder, in words.
        place: String,
        /// The text that is to be in the name.
        filter: String,
        /// The names that there are.
        names: String,
    },
}

fn texts(faults: &[Box<Diagnostic>]) -> String {
    faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
}

/// Problems with the names of their files.
type Named = Vec<(String, ProblemFile)>;

/// Returns the problems whose name or file name holds `filter`, by file name: those of a folder, or those of the
/// literature, which the program holds. Of at least one an answer is known.
///
/// # Errors
/// [`NoProblems`].
pub fn chosen(folder: Option<&Path>, filter: &str) -> Result<Vec<ProblemFile>, NoProblems> {
    let place = folder.map_or("the literature".into(), |folder| folder.display().to_string());
    let mut named = folder.map_or_else(built_in, of_folder)?;
    if !named.iter().any(is_known) {
        return Err(NoProblems::NoneKnown(place));
    }
    let names = |named: &[&(String, ProblemFile)]| {
        named.iter().map(|(_, problem)| problem.name.as_str()).collect::<Vec<_>>().join(", ")
    };
    let known = names(&named.iter().filter(|one| is_known(one)).collect::<Vec<_>>());
    named.retain(|(stem, problem)| problem.name.contains(filter) || stem.contains(filter));
    if named.is_empty() {
        return Err(NoProblems::NoneNamed { place, filter: filter.to_owned(), names: known });
    }
    if !named.iter().any(is_known) {
        return Err(NoProblems::NoneKnownOf { names: names(&named.iter().collect::<Vec<_>>()) });
    }
    Ok(named.into_iter().map(|(_, problem)| problem).collect())
}

/// Returns whether an answer is known that others can be compared with.
fn is_known((_, problem): &(String, ProblemFile)) -> bool {
    super::known(problem).is_ok()
}

/// The name of the folder of the literature's problems.
pub const LITERATURE: &str = "literature";

/// Returns the name of a folder of problems, which a suite and its files bear; `None` for the literature's.
pub fn collection(folder: &Path) -> Option<String> {
    // Of `.` and `..` too.
    let whole = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
    let name = whole.file_name().unwrap_or_default().to_string_lossy();
    (name != LITERATURE).then(|| name::legal(&name, "problems"))
}

/// Reads the problems of a folder, by file name; every file is read, so that the faults of all are shown.
fn of_folder(folder: &Path) -> Result<Named, NoProblems> {
    let unreadable = |source| NoProblems::Folder { folder: folder.display().to_string(), source };
    let mut files = toml_files(folder).map_err(unreadable)?;
    // By the name without its ending, so that a.toml comes before a-b.toml.
    files.sort_by(|one, other| one.file_stem().cmp(&other.file_stem()));
    let (mut read, mut faults) = (Vec::new(), Vec::new());
    for path in files {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        match problem_file::load(&path, &[]) {
            Ok(problem) => read.push((stem, problem)),
            Err(fault) => faults.push(fault),
        }
    }
    if faults.is_empty() { Ok(read) } else { Err(NoProblems::Files(faults)) }
}

fn built_in() -> Result<Named, NoProblems> {
    let problems = literature::problems().map_err(|fault| NoProblems::Files(vec![fault]))?.into_iter();
    Ok(problems.map(|(name, problem)| (name.trim_end_matches(".toml").to_owned(), problem)).collect())
}
