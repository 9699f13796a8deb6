//! The list of jobs: those that run and all results of the folder, as they are shown.

use super::job_messages::{JobList, JobShown, JobState};
use super::jobs::{Jobs, STARTED};
use super::shelf::names_in;
use crate::files::name;
use std::collections::BTreeSet;

/// The most jobs in a list.
const MOST_LISTED: usize = 500;

impl Jobs {
    /// All jobs and results, by name.
    pub(super) fn list(&self) -> JobList {
        let (running, failed) = self.now();
        let mut names: BTreeSet<String> = running.keys().chain(failed.keys()).cloned().collect();
        names.extend(names_in(&self.shelf.folder));
        let begun = names_in(&self.shelf.folder.join(STARTED));
        names.extend(begun.iter().filter_map(|file| file.strip_suffix(".json")).map(str::to_owned));
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
        JobList { folder: self.shelf.folder.display().to_string(), jobs, more }
    }

    /// One job; `None` where there is none of that name.
    pub(super) fn one(&self, name: &str) -> Option<JobShown> {
        let (running, failed) = self.now();
        if let Some(job) = running.get(name) {
            return Some(job.shown(name));
        }
        let begun = self.begun(name).is_some();
        let shown = self.shelf.shown(name, begun).or_else(|| {
            let said = "The studio ended before it did. It can go on from the beginning.".to_owned();
            begun.then(|| JobShown::new(name, JobState::BrokenOff, said, true))
        });
        match failed.get(name) {
            None => shown,
            Some(why) => {
                let result = shown.and_then(|shown| shown.result);
                Some(JobShown { result, ..JobShown::new(name, JobState::Failed, why.clone(), begun) })
            }
        }
    }
}
