//! What the folder of results holds: read anew for every list, whoever made it. Nothing outside of it is read, links
//! lead nowhere.

use super::job_messages::{JobResult, JobShown, JobState};
use crate::app::job::folder::{
    CHECKPOINT, FolderError, MAX_RECORD_BYTES, RECORD, is_in_use, is_result_file, read_record,
};
use crate::files::name;
use crate::record::{Reason, Record};
use crate::report::table;
use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

/// The largest file of a result that is handed out.
const MOST_BYTES: u64 = 64 << 20;

/// A folder of results.
pub(super) struct Shelf {
    folder: PathBuf,
    /// What was read of each record, as long as its file is the same.
    read: Mutex<BTreeMap<String, (Stamp, Reading)>>,
}

/// Why a result has no record that can be read.
#[derive(Debug, thiserror::Error)]
pub(super) enum ShelfError {
    #[error("there is no result named {0}")]
    Absent(String),
    #[error("the record of {0} is a link, which the studio does not follow")]
    Link(String),
    #[error(transparent)]
    Folder(#[from] FolderError),
}

/// Tells whether a file is the one that was read.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stamp {
    bytes: u64,
    changed: Option<SystemTime>,
}

/// What a record says, as far as a list needs it.
#[derive(Clone, Debug)]
enum Reading {
    Whole { result: Box<JobResult>, stopped: bool, ending: String, name: String },
    Unreadable(String),
}

impl Shelf {
    pub(super) fn new(folder: &Path) -> Self {
        Shelf { folder: folder.to_path_buf(), read: Mutex::default() }
    }

    /// The folder.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// The folder of a result, where there is one.
    pub(super) fn place(&self, name: &str) -> Option<PathBuf> {
        name::check(name).ok()?;
        let place = self.folder.join(name);
        is_folder(&place).then_some(place)
    }

    /// Whether there is anything of that name.
    pub(super) fn holds(&self, name: &str) -> bool {
        fs::symlink_metadata(self.folder.join(name)).is_ok()
    }

    /// The record of a result.
    ///
    /// # Errors
    /// [`ShelfError`].
    pub(super) fn record(&self, name: &str) -> Result<Record, ShelfError> {
        let place = self.place(name).ok_or_else(|| ShelfError::Absent(name.to_owned()))?;
        if is_link(&place.join(RECORD)) {
            return Err(ShelfError::Link(name.to_owned()));
        }
        Ok(read_record(&place)?)
    }

    /// A file of a result; `None` where it has none of that name.
    pub(super) fn file(&self, name: &str, file: &str) -> Option<Vec<u8>> {
        let place = self.place(name).filter(|_| is_result_file(file))?.join(file);
        let found = fs::symlink_metadata(&place).ok()?;
        if !found.is_file() || found.len() > MOST_BYTES {
            return None;
        }
        let mut bytes = Vec::new();
        fs::File::open(&place).ok()?.take(MOST_BYTES).read_to_end(&mut bytes).ok()?;
        Some(bytes)
    }

    /// The names of a result's files, sorted.
    pub(super) fn files(&self, name: &str) -> Vec<String> {
        let Some(Ok(entries)) = self.place(name).map(fs::read_dir) else { return Vec::new() };
        let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        let mut names: Vec<String> = names.filter(|name| is_result_file(name)).collect();
        names.sort();
        names
    }

    fn reading(&self, name: &str, place: &Path) -> Option<Reading> {
        let file = place.join(RECORD);
        let found = fs::symlink_metadata(&file).ok()?;
        let stamp = Stamp { bytes: found.len(), changed: found.modified().ok() };
        let mut read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((then, reading)) = read.get(name)
            && *then == stamp
        {
            return Some(reading.clone());
        }
        drop(read);
        let reading = match self.record(name) {
            _ if found.len() > MAX_RECORD_BYTES => Reading::Unreadable("its record is too large".to_owned()),
            Err(why) => Reading::Unreadable(why.to_string()),
            Ok(record) => Reading::Whole {
                result: Box::new(JobResult::from(&record)),
                stopped: matches!(record.termination.reason, Reason::Cancelled | Reason::TimeLimit),
                ending: table::ending_sentences(&record),
                name: record.problem.name.clone(),
            },
        };
        read = self.read.lock().unwrap_or_else(PoisonError::into_inner);
        read.insert(name.to_owned(), (stamp, reading.clone()));
        Some(reading)
    }

    /// A result as its folder shows it; `None` where it holds nothing of ours.
    pub(super) fn shown(&self, name: &str, begun: bool) -> Option<JobShown> {
        let place = self.place(name)?;
        let half_done = place.join(CHECKPOINT).is_file();
        let reading = self.reading(name, &place);
        let shown = |state, said: String, resumable, result| {
            Some(JobShown { result, ..JobShown::new(name, state, said, resumable) })
        };
        let result = |reading: &Option<Reading>| match reading {
            Some(Reading::Whole { result, .. }) => Some(result.as_ref().clone()),
            _ => None,
        };
        if is_in_use(&place) {
            let said = "Another program, such as linkwright synth or another studio, works in its folder."
                .to_owned();
            return shown(JobState::Elsewhere, said, false, result(&reading));
        }
        if begun {
            let from = if half_done { "from its checkpoint" } else { "from the beginning" };
            let said = format!("The studio ended before it did. It can go on {from}.");
            return shown(JobState::BrokenOff, said, true, result(&reading));
        }
        match reading {
            Some(Reading::Whole { result, stopped, ending, name: named }) => {
                let (state, resumable) = match stopped {
                    true => (JobState::Stopped, named == name),
                    false => (JobState::Done, false),
                };
                let way = match (stopped, half_done) {
                    (false, _) => String::new(),
                    (true, _) if !resumable => format!(
                        " It is the result of {named}: run that problem with linkwright synth --resume."
                    ),
                    (true, true) => " It can go on from its checkpoint.".to_owned(),
                    (true, false) => " There is no checkpoint: it would begin anew.".to_owned(),
                };
                shown(state, ending + &way, resumable, Some(*result))
            }
            Some(Reading::Unreadable(why)) => shown(JobState::Unreadable, why, false, None),
            None if half_done => {
                let said = "A search half done, without its problem: linkwright synth PROBLEM --resume goes on with it.";
                shown(JobState::Unreadable, said.to_owned(), false, None)
            }
            None => None,
        }
    }
}

fn is_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_dir())
}

fn is_link(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink())
}
