//! One tab's work, on a thread of its own: a mailbox of one, the answers that follow the hand, the search behind them.
//!
//! The latest edit wins: one that comes before the last was looked at takes its place. An edit cancels the search for
//! the one before. Every tab has at most one search, and all searches together as many threads as there are cores.

use super::details::Finished;
use super::messages::{Answer, Ask, Counted, Doing, Shown};
use super::status::{ended, under_way};
use crate::live::nine::Nine;
use crate::live::{Session, first_look};
use crate::problem::Problem;
use crate::problem::spec::Method;
use crate::problem_file::ProblemFile;
use crate::record::{Candidate, ExactRecord, Record, Relaxation};
use crate::run::{Context, Job, run};
use crate::search::{Budget, HitsSoFar, Progress};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tokio::sync::watch;

/// A hand that rests for so long lets the search begin though it has not let go.
const REST: Duration = Duration::from_millis(150);
/// Progress is told at most so often.
const TELL_EVERY: Duration = Duration::from_millis(120);

/// What a tab is told: the latest answer as JSON.
pub(super) type Told = Option<Arc<str>>;

/// Where the server leaves what a tab has sent.
#[derive(Default)]
pub(super) struct Mailbox {
    waiting: Mutex<Waiting>,
    bell: Condvar,
}

#[derive(Default)]
struct Waiting {
    edit: Option<String>,
    news: Vec<News>,
    closed: bool,
}

/// What a search tells, with the number of the edit that it is for.
struct News {
    edit: u64,
    what: What,
}

enum What {
    /// How far it is, and what it is doing.
    Progress(f64, String),
    First(Vec<Candidate>),
    /// What was found, and how often the best of it came back.
    Finished(Box<Record>, Option<HitsSoFar>),
    Failed(String),
    /// The search's thread is about to end.
    Left,
}

impl Mailbox {
    fn lock(&self) -> MutexGuard<'_, Waiting> {
        self.waiting.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Leaves an edit; one that was not looked at is dropped.
    pub(super) fn put(&self, edit: String) {
        self.lock().edit = Some(edit);
        self.bell.notify_one();
    }

    /// Ends the tab's work.
    pub(super) fn close(&self) {
        self.lock().closed = true;
        self.bell.notify_one();
    }

    fn tell(&self, edit: u64, what: What) {
        let mut waiting = self.lock();
        if let What::Progress(..) = what {
            waiting.news.retain(|news| !matches!(news.what, What::Progress(..)));
        }
        waiting.news.push(News { edit, what });
        self.bell.notify_one();
    }

    fn has_edit(&self) -> bool {
        self.lock().edit.is_some()
    }

    /// Waits for something to do, until `until`. `None`: the tab is closed.
    fn wait(&self, until: Option<Instant>) -> Option<(Option<String>, Vec<News>)> {
        let mut waiting = self.lock();
        loop {
            if waiting.closed {
                return None;
            }
            let left = until.map(|until| until.saturating_duration_since(Instant::now()));
            if waiting.edit.is_some() || !waiting.news.is_empty() || left == Some(Duration::ZERO) {
                return Some((waiting.edit.take(), std::mem::take(&mut waiting.news)));
            }
            waiting = match left {
                None => self.bell.wait(waiting).unwrap_or_else(PoisonError::into_inner),
                Some(left) => self.bell.wait_timeout(waiting, left).unwrap_or_else(PoisonError::into_inner).0,
            };
        }
    }
}

/// Searches that run now, of all tabs.
#[derive(Default)]
pub(super) struct Searches {
    running: AtomicUsize,
    finished: Finished,
}

impl Searches {
    /// The records of the latest that have ended.
    pub(super) fn finished(&self) -> &Finished {
        &self.finished
    }
}

/// One search among them, counted as long as it lives.
struct OneSearch(Arc<Searches>);

impl OneSearch {
    /// One more, with its share of the cores.
    fn new(searches: &Arc<Searches>) -> (Self, usize) {
        let running = 1 + searches.running.fetch_add(1, Ordering::SeqCst);
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        (OneSearch(Arc::clone(searches)), (cores / running).max(1))
    }
}

impl Drop for OneSearch {
    fn drop(&mut self) {
        self.0.running.fetch_sub(1, Ordering::SeqCst);
    }
}

/// What is asked now.
struct Current {
    version: u64,
    file: ProblemFile,
    problem: Problem,
}

/// The work for one tab.
struct Tab {
    mail: Arc<Mailbox>,
    told: watch::Sender<Told>,
    searches: Arc<Searches>,
    session: Session,
    nine: Nine,
    /// In exact mode: all real linkages through the nine points.
    exact: Option<(Counted, Vec<Shown>)>,
    /// What would help where nothing is acceptable.
    helps: Vec<Relaxation>,
    current: Option<Current>,
    /// Counts edits, whatever version they say that they are.
    edits: u64,
    /// When the search for the current edit is to begin.
    begin: Option<Instant>,
    /// Ends the search that runs.
    running: Option<Arc<AtomicBool>>,
}

/// Works for a tab until its mailbox is closed.
pub(super) fn work(mail: Arc<Mailbox>, told: watch::Sender<Told>, searches: Arc<Searches>) {
    let session = Session::new();
    let mut tab = Tab {
        mail,
        told,
        searches,
        session,
        nine: Nine::new(),
        exact: None,
        helps: Vec::new(),
        current: None,
        edits: 0,
        begin: None,
        running: None,
    };
    loop {
        // A search that was cancelled has to end before the next begins.
        let until = tab.begin.filter(|_| tab.running.is_none());
        let Some((edit, news)) = tab.mail.wait(until) else { break };
        for news in news {
            tab.hear(news);
        }
        if let Some(edit) = edit {
            tab.take(&edit);
        }
        if tab.running.is_none() && tab.begin.is_some_and(|begin| begin <= Instant::now()) {
            tab.search();
        }
    }
    tab.cancel();
}

impl Tab {
    fn cancel(&mut self) {
        self.begin = None;
        if let Some(running) = &self.running {
            running.store(true, Ordering::SeqCst);
        }
    }

    fn tell(&self, version: u64, doing: Doing, said: String, progress: Option<f64>) {
        let (nine, candidates) = match &self.exact {
            Some((counted, shown)) => (Some(counted.clone()), shown.clone()),
            None => (None, self.session.candidates().iter().map(Shown::from).collect()),
        };
        let relaxations = self.helps.clone();
        let answer = Answer { version, doing, said, progress, candidates, nine, relaxations };
        if let Ok(text) = serde_json::to_string(&answer) {
            self.told.send_replace(Some(text.into()));
        }
    }

    /// Takes an edit.
    fn take(&mut self, text: &str) {
        self.cancel();
        self.edits += 1;
        self.helps.clear();
        let ask: Ask = match serde_json::from_str(text) {
            Ok(ask) => ask,
            Err(e) => {
                self.refuse(0, format!("this is no edit that the studio understands: {e}"));
                return;
            }
        };
        let read = ask.problem().and_then(|file| {
            let problem = Problem::new(file.spec.clone()).map_err(|e| e.to_string())?;
            Ok(Current { version: ask.version, file, problem })
        });
        match read {
            Err(why) => self.refuse(ask.version, why),
            Ok(current) => {
                if ask.fresh {
                    self.session.clear();
                }
                self.follow(&current.problem);
                self.current = Some(current);
                self.begin = Some(Instant::now() + if ask.moving { REST } else { Duration::ZERO });
                let said = match (&self.exact, self.session.candidates().first()) {
                    (Some(_), _) => {
                        "All linkages through the nine points follow your hand; proofs when it rests.".into()
                    }
                    (None, None) => "Looking for the first linkages.".into(),
                    (None, Some(_)) => {
                        "The linkages follow your hand; the search goes on when it rests.".into()
                    }
                };
                self.tell(ask.version, Doing::Following, said, None);
            }
        }
    }

    /// Brings what is there to a problem: all linkages through nine points, or the few that follow the hand.
    fn follow(&mut self, problem: &Problem) {
        let never = AtomicBool::new(false);
        self.exact = None;
        if problem.spec().solve.method == Method::Continuation {
            if let Some(exact) = self.nine.follow(problem, &never) {
                self.exact = Some(all_of(problem, &exact.record));
            }
        } else {
            self.nine = Nine::new();
            self.session.follow(problem, &Budget::new(&never, None));
        }
    }

    fn refuse(&mut self, version: u64, why: String) {
        self.current = None;
        self.exact = None;
        self.session.clear();
        self.tell(version, Doing::Refused, why, None);
    }

    /// Begins the search for what is asked now.
    fn search(&mut self) {
        self.begin = None;
        let Some(current) = &self.current else { return };
        if self.mail.has_edit() {
            return;
        }
        let cancel = Arc::new(AtomicBool::new(false));
        let file = &current.file;
        let job = Job {
            name: file.name.clone(),
            source: file.source.clone(),
            unit: file.unit,
            spec: file.spec.clone(),
        };
        let (one, threads) = OneSearch::new(&self.searches);
        let (mail, token, edit) = (Arc::clone(&self.mail), Arc::clone(&cancel), self.edits);
        let problem = current.problem.clone();
        let first = self.session.candidates().is_empty() && self.exact.is_none();
        let thread = std::thread::Builder::new().name("search".into()).spawn(move || {
            let _one = one;
            let searched = catch_unwind(AssertUnwindSafe(|| {
                searched(&job, &problem, first, threads, &token, |what| mail.tell(edit, what));
            }));
            if searched.is_err() {
                mail.tell(edit, What::Failed("this is a bug of linkwright: please report it".into()));
            }
            mail.tell(edit, What::Left);
        });
        let version = current.version;
        match thread {
            Ok(_) => {
                self.running = Some(cancel);
                let said =
                    if first { "Looking for the first linkages." } else { "Searching for better ones." };
                self.tell(version, Doing::Searching, said.into(), Some(0.0));
            }
            Err(e) => self.tell(version, Doing::Refused, format!("no thread to search with: {e}"), None),
        }
    }

    /// Takes a word from a search.
    fn hear(&mut self, news: News) {
        if let What::Left = news.what {
            self.running = None;
            return;
        }
        let Some(current) = self.current.as_ref().filter(|_| news.edit == self.edits) else { return };
        let version = current.version;
        let searching = "Searching for better ones.".to_owned();
        match news.what {
            What::Progress(part, said) => self.tell(version, Doing::Searching, said, Some(part)),
            What::First(found) => {
                self.session.join(&current.problem, found);
                self.tell(version, Doing::Searching, searching, Some(0.0));
            }
            What::Finished(record, hits) => {
                let said = ended(&record, hits);
                self.searches.finished.keep(&record);
                if let Some(exact) = record.exact.as_ref().filter(|_| self.exact.is_some()) {
                    self.exact = Some(all_of(&current.problem, exact));
                }
                self.helps = record.relaxations;
                self.session.join(&current.problem, record.candidates);
                self.tell(version, Doing::Done, said, None);
            }
            What::Failed(why) => self.tell(version, Doing::Refused, why, None),
            What::Left => {}
        }
    }
}

/// All real linkages of an exact solution, ready to be shown.
fn all_of(problem: &Problem, exact: &ExactRecord) -> (Counted, Vec<Shown>) {
    let shown = |(rank, linkage)| Shown::exact(problem, rank, linkage);
    (Counted::of(exact), (1..).zip(&exact.linkages).filter_map(shown).collect())
}

/// Searches: a first look where nothing is there yet, then a whole run, the same as on the command line.
fn searched(
    job: &Job,
    problem: &Problem,
    first: bool,
    threads: usize,
    cancel: &AtomicBool,
    tell: impl Fn(What) + Sync,
) {
    let pool = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool,
        Err(e) => return tell(What::Failed(format!("no threads to search with: {e}"))),
    };
    if first {
        let found = pool.install(|| first_look(problem, &Budget::new(cancel, None)));
        if !found.is_empty() && !cancel.load(Ordering::Relaxed) {
            tell(What::First(found));
        }
    }
    let last = Mutex::new(Instant::now());
    let hits = Mutex::new(None);
    let observer = |progress: &Progress| {
        if progress.hits.is_some() {
            *hits.lock().unwrap_or_else(PoisonError::into_inner) = progress.hits;
        }
        let mut last = last.lock().unwrap_or_else(PoisonError::into_inner);
        if last.elapsed() >= TELL_EVERY {
            *last = Instant::now();
            let part = progress.evaluations as f64 / progress.budget.max(1) as f64;
            tell(What::Progress(part.min(1.0), under_way(progress)));
        }
    };
    match pool.install(|| run(job, &Context { cancel, observer: &observer })) {
        // What was cancelled is not what was asked.
        Ok(_) if cancel.load(Ordering::Relaxed) => {}
        Ok(finished) => {
            let hits = *hits.lock().unwrap_or_else(PoisonError::into_inner);
            tell(What::Finished(Box::new(finished.record), hits));
        }
        Err(e) => tell(What::Failed(e.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_latest_edit_wins_and_progress_does_not_pile_up() {
        let mail = Mailbox::default();
        for i in 0..1000 {
            mail.put(format!("{i}"));
            mail.tell(1, What::Progress(f64::from(i), String::new()));
        }
        let (edit, news) = mail.wait(None).expect("open");
        assert_eq!((edit.as_deref(), news.len()), (Some("999"), 1));
        mail.close();
        assert!(mail.wait(None).is_none());
    }
}
