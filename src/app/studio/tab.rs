//! One tab's work, on a thread of its own: a mailbox of one, the answers that follow the hand, the search behind them.
//!
//! The latest edit wins: one that comes before the last was looked at takes its place. An edit cancels the search for
//! the one before. Every tab has at most one search, and all searches together as many threads as there are cores.

use super::details::Finished;
use super::messages::{Answer, Ask, Counted, Doing, Shown};
use super::status::{ended, under_way};
use crate::app::job::run::{Context, Job, run};
use crate::record::{Candidate, ExactRecord, Record, Relaxation};
use crate::synthesis::continuation::Exact;
use crate::synthesis::live::nine::Nine;
use crate::synthesis::live::{Session, first_look};
use crate::synthesis::{Budget, HitsSoFar, Progress};
use crate::task::Problem;
use crate::task::spec::Method;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tokio::sync::watch;

/// A hand that rests for so long lets the search begin though it has not let go.
const REST: Duration = Duration::from_millis(150);
/// Progress is told at most so often.
const TELL_EVERY: Duration = Duration::from_millis(120);

/// The message after a thread has panicked.
pub(super) const BUG: &str = "this is a bug of linkwright: please report it";

/// What a tab is told: the latest answer as JSON.
pub(super) type Told = Option<Arc<str>>;

/// Where the server leaves what a tab has sent.
#[derive(Default)]
pub(super) struct Mailbox {
    waiting: Mutex<Waiting>,
    bell: Condvar,
    /// Set with [`close`](Mailbox::close): what is under way ends early.
    closed: AtomicBool,
}

#[derive(Default)]
struct Waiting {
    edit: Option<String>,
    news: Vec<News>,
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
        // Under the lock: whoever is about to wait has seen it.
        let waiting = self.lock();
        self.closed.store(true, Ordering::SeqCst);
        drop(waiting);
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
            if self.closed.load(Ordering::SeqCst) {
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
    job: Job,
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
    let mut tab = Tab::new(mail, told, searches);
    loop {
        // A search that was cancelled has to end before the next begins.
        let until = tab.begin.filter(|_| tab.running.is_none());
        let Some((edit, news)) = tab.mail.wait(until) else { break };
        for news in news {
            tab.surviving(|tab| tab.hear(news));
        }
        if let Some(edit) = edit {
            tab.surviving(|tab| tab.take(&edit));
        }
        if tab.running.is_none() && tab.begin.is_some_and(|begin| begin <= Instant::now()) {
            tab.search();
        }
    }
    tab.cancel();
}

impl Tab {
    fn new(mail: Arc<Mailbox>, told: watch::Sender<Told>, searches: Arc<Searches>) -> Tab {
        Tab {
            mail,
            told,
            searches,
            session: Session::default(),
            nine: Nine::default(),
            exact: None,
            helps: Vec::new(),
            current: None,
            edits: 0,
            begin: None,
            running: None,
        }
    }

    /// Does what must not end the tab: a panic is told, and everything that it may have left half done is forgotten.
    fn surviving(&mut self, act: impl FnOnce(&mut Tab)) {
        if catch_unwind(AssertUnwindSafe(|| act(self))).is_err() {
            self.cancel();
            self.edits += 1;
            self.nine = Nine::default();
            self.helps.clear();
            let version = self.current.as_ref().map_or(0, |current| current.version);
            self.refuse(version, BUG.into());
        }
    }

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
            let problem = Problem::new(file.spec.clone())?;
            Ok(Current { version: ask.version, job: Job::from(file), problem })
        });
        match read {
            Err(why) => self.refuse(ask.version, why.to_string()),
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
        let closed = &self.mail.closed;
        self.exact = None;
        if problem.spec().solve.method == Method::Continuation {
            match self.nine.follow(problem, closed) {
                Some(exact) => self.exact = Some(all_followed(&exact)),
                // What was found for other points is nothing for these.
                None => self.session.clear(),
            }
        } else {
            self.nine = Nine::default();
            self.session.follow(problem, &Budget::new(closed, None));
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
        let job = current.job.clone();
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
                mail.tell(edit, What::Failed(BUG.into()));
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

/// The same of those that follow the hand, which are judged already.
fn all_followed(exact: &Exact) -> (Counted, Vec<Shown>) {
    let judged = exact.classes.iter().map(|class| &class.best).zip(&exact.record.linkages);
    let shown = (1..).zip(judged).map(|(rank, (best, linkage))| Shown::judged(best, rank, linkage));
    (Counted::of(&exact.record), shown.collect())
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

    fn answer(told: &watch::Receiver<Told>) -> serde_json::Value {
        serde_json::from_str(told.borrow().as_deref().expect("an answer")).expect("JSON")
    }

    fn tab() -> (Tab, watch::Receiver<Told>) {
        let (tell, told) = watch::channel::<Told>(None);
        (Tab::new(Arc::default(), tell, Arc::default()), told)
    }

    #[test]
    fn a_panic_is_told_and_the_next_edit_is_taken() {
        let (mut tab, told) = tab();
        tab.surviving(|_| panic!("on purpose"));
        let said = answer(&told);
        assert_eq!((said["doing"].as_str(), said["said"].as_str()), (Some("refused"), Some(BUG)));
        tab.surviving(|tab| tab.take(r#"{"version":7,"points":[[0,0],[1,1],[2,0]]}"#));
        let said = answer(&told);
        assert_eq!((said["doing"].as_str(), said["version"].as_u64()), (Some("following"), Some(7)));
    }

    /// Nine points of which the last two lie `apart`.
    fn nine(version: u64, apart: f64) -> String {
        let mut points: Vec<[f64; 2]> =
            (0..8).map(f64::from).map(|i| [4.0 * (0.5 * i).cos(), 3.0 * (0.55 * i).sin()]).collect();
        points.push([points[7][0] + apart, points[7][1]]);
        serde_json::json!({ "version": version, "points": points, "method": "continuation" }).to_string()
    }

    #[test]
    fn points_without_exact_linkages_show_none_of_other_points_and_a_closed_tab_follows_no_more() {
        let (mut tab, told) = tab();
        tab.take(r#"{"version":1,"points":[[0,0],[1,1],[2,1.5],[3,1],[2,-1]],"closed":true}"#);
        let current = tab.current.as_ref().expect("a problem");
        let found = first_look(&current.problem, &Budget::new(&AtomicBool::new(false), None));
        tab.session.join(&current.problem, found);
        assert!(!tab.session.candidates().is_empty());
        tab.take(&nine(2, 0.0));
        let said = answer(&told);
        assert!(said["nine"].is_null() && said["candidates"].as_array().is_some_and(Vec::is_empty), "{said}");
        tab.mail.close();
        tab.take(&nine(3, 1.0));
        assert!(tab.exact.is_none());
    }
}
