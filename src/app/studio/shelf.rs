//! Reads the folder of results, anew for every list, whoever wrote to it. Nothing outside of it is read, and no link is
//! followed.

use super::job_messages::{JobResult, JobShown, JobState};
use crate::app::job::folder::{
    CHECKPOINT, FolderError, MAX_RECORD_BYTES, RECORD, is_in_use, is_result_file, read_file_at_most,
    read_record,
};
use crate::files::name;
use crate::record::{Reason, Record};
use crate::report::table;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

/// The largest file of a result that is handed out, and the largest problem of a job, bytes.
const MOST_BYTES: u64 = 64 << 20;

/// A folder of results.
pub(super) struct Shelf {
    pub(super) folder: PathBuf,
    /// The reading of each record, kept as long as its file is the same.
    read: Mutex<BTreeMap<String, (Stamp, Reading)>>,
}

/// The reason why a result has no record that can be read.
#[derive(Debug, thiserror::Error)]
pub(super) enum ShelfError {
    #[error("there is no result named {0}")]
    Absent(String),
    #[error("the record of {0} is a link, which the studio does not follow")]
    Link(String),
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// The size and the time of a file: it is the one that was read if both are the same.
type Stamp = (u64, Option<SystemTime>);

/// A record as far as a list needs it, or the reason why it cannot be read.
type Reading = Result<Whole, String>;

#[derive(Clone)]
struct Whole {
    /// The name of its problem.
    name: String,
    result: JobResult,
    /// Whether it can go on: it was stopped, or its time was over.
    stopped: bool,
    /// The end of its search, in sentences.
    ending: String,
}

impl Shelf {
    pub(super) fn new(folder: &Path) -> Self {
        Shelf { folder: folder.to_path_buf(), read: Mutex::default() }
    }

    /// Returns the folder of a result, if there is one.
    pub(super) fn place(&self, name: &str) -> Option<PathBuf> {
        name::check(name).ok()?;
        let place = self.folder.join(name);
        fs::symlink_metadata(&place).is_ok_and(|found| found.is_dir()).then_some(place)
    }

    /// Returns whether there is anything of that name.
    pub(super) fn holds(&self, name: &str) -> bool {
        fs::symlink_metadata(self.folder.join(name)).is_ok()
    }

    /// Returns the record of a result.
    ///
    /// # Errors
    /// [`ShelfError`].
    pub(super) fn record(&self, name: &str) -> Result<Record, ShelfError> {
        let place = self.place(name).ok_or_else(|| ShelfError::Absent(name.to_owned()))?;
        if fs::symlink_metadata(place.join(RECORD)).is_ok_and(|found| found.is_symlink()) {
            return Err(ShelfError::Link(name.to_owned()));
        }
        Ok(read_record(&place)?)
    }

    /// Returns a file of a result; `None` if it has none of that name.
    pub(super) fn file(&self, name: &str, file: &str) -> Option<Vec<u8>> {
        plain_file(&self.place(name).filter(|_| is_result_file(file))?.join(file))
    }

    /// Returns the names of a result's files, sorted.
    pub(super) fn files(&self, name: &str) -> Vec<String> {
        let mut names = self.place(name).map_or_else(Vec::new, |place| names_in(&place));
        names.retain(|name| is_result_file(name));
        names.sort();
        names
    }

    fn reading(&self, name: &str, place: &Path) -> Option<Reading> {
        let file = place.join(RECORD);
        let found = fs::symlink_metadata(&file).ok()?;
        let stamp = (found.len(), found.modified().ok());
        let read = || self.read.lock().unwrap_or_else(PoisonError::into_inner);
        let before = read().get(name).filter(|(then, _)| *then == stamp).map(|(_, reading)| reading.clone());
        if before.is_some() {
            return before;
        }
        let whole = |record: Record| Whole {
            result: JobResult::from(&record),
            stopped: matches!(record.termination.reason, Reason::Cancelled | Reason::TimeLimit),
            ending: table::ending_sentences(&record),
            name: record.problem.name,
        };
        let reading = match found.len() {
            0..=MAX_RECORD_BYTES => self.record(name).map(whole).map_err(|why| why.to_string()),
            _ => Err("its record is too large".to_owned()),
        };
        read().insert(name.to_owned(), (stamp, reading.clone()));
        Some(reading)
    }

    /// Returns a result as its folder shows it; `None` if the folder holds nothing of ours.
    pub(super) fn shown(&self, name: &str, begun: bool) -> Option<JobShown> {
        let place = self.place(name)?;
        let half_done = place.join(CHECKPOINT).is_file();
        let reading = self.reading(name, &place);
        let from = if half_done { "from its checkpoint" } else { "from the beginning" };
        let (state, said, resumable) = match &reading {
            _ if is_in_use(&place) => {
                let said =
                    "Another program, such as linkwright synth or another studio, works in its folder.";
                (JobState::Elsewhere, said.to_owned(), false)
            }
            _ if begun => {
                let said = format!("The studio ended before it did. It can go on {from}.");
                (JobState::BrokenOff, said, true)
            }
            Some(Ok(Whole { stopped: false, ending, .. })) => (JobState::Done, ending.clone(), false),
            Some(Ok(Whole { name: named, ending, .. })) => {
                let way = match half_done {
                    _ if named != name => &format!(
                        "It is the result of {named}: run that problem with linkwright synth --resume."
                    ),
                    true => "It can go on from its checkpoint.",
                    false => "There is no checkpoint: it would begin anew.",
                };
                (JobState::Stopped, format!("{ending} {way}"), named == name)
            }
            Some(Err(why)) => (JobState::Unreadable, why.clone(), false),
            None if half_done => {
                let said = "A search half done, without its problem: linkwright synth PROBLEM --resume goes on with it.";
                (JobState::Unreadable, said.to_owned(), false)
            }
            None => return None,
        };
        let result = reading.and_then(Result::ok).map(|whole| whole.result);
        Some(JobShown { result, ..JobShown::new(name, state, said, resumable) })
    }
}

/// Returns the names in a folder; none if it cannot be read.
pub(super) fn names_in(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect()
}

/// Returns the bytes of a file; `None` if it is a link, no file or too large.
pub(super) fn plain_file(path: &Path) -> Option<Vec<u8>> {
    if !fs::symlink_metadata(path).ok()?.is_file() {
        return None;
    }
    read_file_at_most(path, MOST_BYTES).ok()?
}
