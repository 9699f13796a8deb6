//! What the folder of results holds: read anew for every list, whoever made it. Nothing outside of it is read, links
//! lead nowhere.

use super::job_messages::{JobList, JobResult, JobShown, JobState};
use super::jobs::Jobs;
use crate::app::results_folder::{CHECKPOINT, MAX_RECORD_BYTES, is_in_use, is_result_file, read_record};
use crate::files::name;
use crate::record::{Reason, Record};
use crate::report::table;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

/// The most jobs in a list.
const MOST_LISTED: usize = 500;
/// The largest file of a result that is handed out.
const MOST_BYTES: u64 = 64 << 20;

/// A folder of results.
pub(super) struct Shelf {
    folder: PathBuf,
    /// What was read of each record, as long as its file is the same.
    read: Mutex<BTreeMap<String, (Stamp, Reading)>>,
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
    /// Why there is none, in words.
    pub(super) fn record(&self, name: &str) -> Result<Record, String> {
        let place = self.place(name).ok_or_else(|| format!("there is no result named {name}"))?;
        if is_link(&place.join("record.json")) {
            return Err(format!("the record of {name} is a link, which the studio does not follow"));
        }
        read_record(&place).map_err(|e| e.to_string())
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
        let file = place.join("record.json");
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
            Err(why) => Reading::Unreadable(why),
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
    fn shown(&self, name: &str, begun: bool) -> Option<JobShown> {
        let place = self.place(name)?;
        let half_done = place.join(CHECKPOINT).is_file();
        let reading = self.reading(name, &place);
        let shown = |state, said: String, resumable, result| {
            Some(JobShown { name: name.to_owned(), state, said, resumable, progress: None, result })
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

impl Jobs {
    /// All jobs and results, by name.
    pub(super) fn list(&self) -> JobList {
        let (running, failed) = self.now();
        let mut names: BTreeSet<String> = running.keys().chain(failed.keys()).cloned().collect();
        names.extend(names_in(self.shelf().folder()));
        names.extend(
            names_in(&self.shelf().folder().join(".studio"))
                .iter()
                .filter_map(|name| name.strip_suffix(".json").map(str::to_owned)),
        );
        names.retain(|name| name::check(name).is_ok());
        let mut jobs = Vec::new();
        let mut more = 0;
        for name in names {
            if jobs.len() >= MOST_LISTED && !running.contains_key(&name) {
                more += 1;
            } else {
                jobs.extend(self.one(&name));
            }
        }
        JobList { folder: self.shelf().folder().display().to_string(), jobs, more }
    }

    /// One job; `None` where there is none of that name.
    pub(super) fn one(&self, name: &str) -> Option<JobShown> {
        let (running, failed) = self.now();
        if let Some(job) = running.get(name) {
            let said = match (job.is_stopping(), job.said()) {
                (true, _) => "Stopping; what was found is being saved.".to_owned(),
                (false, said) if said.is_empty() => "Searching.".to_owned(),
                (false, said) => said,
            };
            let progress = job.progress();
            let name = name.to_owned();
            return Some(JobShown {
                name,
                state: JobState::Running,
                said,
                resumable: false,
                progress,
                result: None,
            });
        }
        let begun = self.begun(name).is_some();
        let shown = self.shelf().shown(name, begun).or_else(|| {
            begun.then(|| JobShown {
                name: name.to_owned(),
                state: JobState::BrokenOff,
                said: "The studio ended before it did. It can go on from the beginning.".to_owned(),
                resumable: true,
                progress: None,
                result: None,
            })
        });
        match failed.get(name) {
            None => shown,
            Some(why) => Some(JobShown {
                name: name.to_owned(),
                state: JobState::Failed,
                said: why.clone(),
                resumable: begun,
                progress: None,
                result: shown.and_then(|shown| shown.result),
            }),
        }
    }
}

fn is_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_dir())
}

fn is_link(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_symlink())
}

fn names_in(folder: &Path) -> Vec<String> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect()
}
