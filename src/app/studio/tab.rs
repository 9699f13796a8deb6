//! Works for one tab, on a thread of its own: a mailbox for one edit, answers that follow the hand, the search behind
//! them.
//!
//! The latest edit wins: one that comes before the last was looked at takes its place. An edit cancels the search for
//! the one before. Every tab has at most one search, and all searches together as many threads as there are cores.

use super::details::Finished;
use super::messages::{Answer, Ask, Counted, Doing, Shown, Sure};
use super::pin_map::PinMap;
use super::status::{ended, under_way};
use crate::app::job::run::{Context, Job, run};
use crate::judge::assess::assess;
use crate::mechanism::CrankLinkage;
use crate::record::{Candidate, ExactRecord, Record, Relaxation};
use crate::synthesis::continuation::Exact;
use crate::synthesis::live::nine::Nine;
use crate::synthesis::live::{Session, first_look, second_look};
use crate::synthesis::{Budget, HitsSoFar, Progress};
use crate::task::spec::Method;
use crate::task::{Problem, TaskKind};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};
use tokio::sync::watch;

/// The time of rest after which the search begins though the hand has not let go.
const REST: Duration = Duration::from_millis(150);
/// The least time between two messages of progress.
const TELL_EVERY: Duration = Duration::from_millis(120);

const LOOKING: &str = "Looking for the first linkages.";
const SEARCHING: &str = "Searching for better ones.";
/// The end of a search that found nothing acceptable while a linkage that followed the hand is.
const FOLLOWED_ONLY: &str = "Not sure: the linkages that followed your hand are all that meet what was asked; the search \
                             from new starts found none.";
/// The message after a thread has panicked.
pub(super) const BUG: &str = "this is a bug of linkwright: please report it";

/// The latest answer for a tab, as JSON.
pub(super) type Told = Arc<str>;

/// The mailbox in which the server leaves what a tab has sent, and a search what it has found.
#[derive(Default)]
pub(super) struct Mailbox {
    waiting: Mutex<Waiting>,
    bell: Condvar,
    /// Set with [`close`](Mailbox::close): work under way ends early.
    closed: AtomicBool,
}

#[derive(Default)]
struct Waiting {
    edit: Option<String>,
    /// News of searches, each with the number of the edit that it is for.
    news: Vec<(u64, News)>,
}

/// News of a search.
enum News {
    /// The part of its budget that is used, and its activity in words.
    Progress(f64, String),
    First(Vec<Candidate>),
    /// The record, and how often the best of it came back.
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
        // Under the lock, so that a thread that is about to wait sees it.
        let _waiting = self.lock();
        self.closed.store(true, Ordering::SeqCst);
        self.bell.notify_one();
    }

    fn tell(&self, edit: u64, news: News) {
        let mut waiting = self.lock();
        if let News::Progress(..) = news {
            waiting.news.retain(|(_, news)| !matches!(news, News::Progress(..)));
        }
        waiting.news.push((edit, news));
        self.bell.notify_one();
    }

    /// Waits for something to do, until `until`. `None`: the tab is closed.
    fn wait(&self, until: Option<Instant>) -> Option<Waiting> {
        let is_closed = || self.closed.load(Ordering::SeqCst);
        let idle = |waiting: &mut Waiting| !is_closed() && waiting.edit.is_none() && waiting.news.is_empty();
        let left = until.map_or(Duration::MAX, |until| until.saturating_duration_since(Instant::now()));
        let woken = self.bell.wait_timeout_while(self.lock(), left, idle);
        let mut waiting = woken.unwrap_or_else(PoisonError::into_inner).0;
        (!is_closed()).then(|| std::mem::take(&mut *waiting))
    }
}

/// The searches of all tabs.
#[derive(Default)]
pub(super) struct Searches {
    /// Held once more by every search that runs.
    running: Arc<()>,
    /// The records of the latest that have ended.
    pub(super) finished: Finished,
}

/// The work for one tab.
#[derive(Default)]
struct Tab {
    mail: Arc<Mailbox>,
    told: watch::Sender<Told>,
    searches: Arc<Searches>,
    session: Session,
    nine: Nine,
    /// In exact mode: all real linkages through the nine points.
    exact: Option<(Counted, Vec<Shown>)>,
    /// The changes that would help if nothing is acceptable.
    helps: Vec<Relaxation>,
    /// The map of the places of a pin, where it is asked for.
    map: Option<PinMap>,
    /// The version that the latest edit says that it is; 0: it cannot be read.
    version: u64,
    /// The latest edit, if it makes a problem.
    asked: Option<(Job, Problem)>,
    /// The number of edits so far, whatever their versions.
    edits: u64,
    /// The time at which the search for the latest edit is to begin.
    begin: Option<Instant>,
    /// Cancels the search that runs.
    running: Option<Arc<AtomicBool>>,
}

/// Works for a tab until its mailbox is closed.
pub(super) fn work(mail: Arc<Mailbox>, told: watch::Sender<Told>, searches: Arc<Searches>) {
    let mut tab = Tab { mail, told, searches, ..Tab::default() };
    loop {
        // A search that was cancelled has to end before the next begins.
        let until = tab.begin.filter(|_| tab.running.is_none());
        let Some(Waiting { edit, news }) = tab.mail.wait(until) else { break };
        for (edit, news) in news {
            tab.surviving(|tab| tab.hear(edit, news));
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
    /// Does what must not end the tab: a panic is reported, and everything that may be half done is forgotten.
    fn surviving(&mut self, act: impl FnOnce(&mut Tab)) {
        if catch_unwind(AssertUnwindSafe(|| act(self))).is_err() {
            self.cancel();
            self.edits += 1;
            self.nine = Nine::default();
            self.helps.clear();
            self.refuse(BUG.into());
        }
    }

    fn cancel(&mut self) {
        self.begin = None;
        if let Some(running) = &self.running {
            running.store(true, Ordering::SeqCst);
        }
    }

    fn tell(&self, doing: Doing, said: impl Into<String>, progress: Option<f64>) {
        self.answer(doing, said, progress, None);
    }

    fn answer(&self, doing: Doing, said: impl Into<String>, progress: Option<f64>, sure: Option<Sure>) {
        let (nine, candidates) = match &self.exact {
            Some((counted, shown)) => (Some(counted.clone()), shown.clone()),
            None => {
                let all = self.session.numbers().iter().zip(self.session.candidates());
                (None, all.map(Shown::numbered).collect())
            }
        };
        let (version, said) = (self.version, said.into());
        let (relaxations, map) = (self.helps.clone(), self.map.clone());
        let answer = Answer { version, doing, said, sure, progress, candidates, nine, relaxations, map };
        if let Ok(text) = serde_json::to_string(&answer) {
            self.told.send_replace(text.into());
        }
    }

    /// Takes an edit.
    fn take(&mut self, text: &str) {
        self.cancel();
        self.edits += 1;
        self.helps.clear();
        self.map = None;
        self.version = 0;
        let ask: Ask = match serde_json::from_str(text) {
            Ok(ask) => ask,
            Err(e) => return self.refuse(format!("this is no edit that the studio understands: {e}")),
        };
        self.version = ask.version;
        let read = ask.problem().and_then(|file| Ok((Problem::new(file.spec.clone())?, Job::from(file))));
        let (problem, job) = match read {
            Ok(read) => read,
            Err(why) => return self.refuse(why.to_string()),
        };
        self.map = if ask.map { PinMap::of(&problem) } else { None };
        if ask.fresh {
            self.session.clear();
        }
        self.session.hold(ask.held);
        if let Some(linkage) = ask.from.and_then(|from| CrankLinkage::try_from(from).ok()) {
            self.session.begin(&problem, &linkage);
        }
        self.follow(&problem);
        self.asked = Some((job, problem));
        self.begin = Some(Instant::now() + if ask.moving { REST } else { Duration::ZERO });
        let said = match (&self.exact, self.session.candidates()) {
            (Some(_), _) => "All linkages through these targets follow your hand; proofs when it rests.",
            (None, []) => LOOKING,
            (None, _) => "The linkages follow your hand; the search goes on when it rests.",
        };
        self.tell(Doing::Following, said, None);
    }

    /// Brings what is there to a problem: all linkages through nine points, or the few that follow the hand.
    fn follow(&mut self, problem: &Problem) {
        let closed = &self.mail.closed;
        self.exact = None;
        if problem.spec().solve.method == Method::Continuation {
            match self.nine.follow(problem, closed) {
                Some(exact) => self.exact = Some(all_followed(&exact)),
                // Linkages for other points are no answers for these.
                None => self.session.clear(),
            }
        } else {
            self.nine = Nine::default();
            self.session.follow(problem, &Budget::new(closed, None));
        }
    }

    fn refuse(&mut self, why: String) {
        self.asked = None;
        self.exact = None;
        self.session.clear();
        self.tell(Doing::Refused, why, None);
    }

    /// Begins the search for the latest edit.
    fn search(&mut self) {
        self.begin = None;
        let Some((job, problem)) = self.asked.clone().filter(|_| self.mail.lock().edit.is_none()) else {
            return;
        };
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let share = Arc::clone(&self.searches.running);
        let threads = (cores / (Arc::strong_count(&share) - 1)).max(1);
        let cancel = Arc::new(AtomicBool::new(false));
        let (mail, token, edit) = (Arc::clone(&self.mail), Arc::clone(&cancel), self.edits);
        let first = self.session.candidates().is_empty() && self.exact.is_none();
        let thread = std::thread::Builder::new().name("search".into()).spawn(move || {
            let _share = share;
            let searched = catch_unwind(AssertUnwindSafe(|| {
                searched(&job, &problem, first, threads, &token, |news| mail.tell(edit, news));
            }));
            if searched.is_err() {
                mail.tell(edit, News::Failed(BUG.into()));
            }
            mail.tell(edit, News::Left);
        });
        match thread {
            Ok(_) => {
                self.running = Some(cancel);
                self.tell(Doing::Searching, if first { LOOKING } else { SEARCHING }, Some(0.0));
            }
            Err(e) => self.tell(Doing::Refused, format!("no thread to search with: {e}"), None),
        }
    }

    /// Takes news of the search for an edit; of an earlier one than the latest only that it has ended.
    fn hear(&mut self, edit: u64, news: News) {
        if let News::Left = news {
            self.running = None;
        }
        let Some((_, problem)) = self.asked.as_ref().filter(|_| edit == self.edits) else { return };
        match news {
            News::Progress(part, said) => self.tell(Doing::Searching, said, Some(part)),
            News::First(found) => {
                self.session.join(problem, found);
                self.tell(Doing::Searching, SEARCHING, Some(0.0));
            }
            News::Finished(record, hits) => {
                let (sure, said) = ended(&record, hits);
                self.searches.finished.keep(&record);
                if let Some(exact) = record.exact.as_ref().filter(|_| self.exact.is_some()) {
                    self.exact = Some(all_of(problem, exact));
                }
                let is_path = problem.spec().task.kind() == TaskKind::Path;
                let found = record.candidates.first().is_some_and(|best| best.accepted);
                self.helps = record.relaxations;
                let best = self.session.join(problem, record.candidates).first();
                if !is_path && !found && best.is_some_and(|best| best.accepted) {
                    self.helps.clear();
                    return self.answer(Doing::Done, FOLLOWED_ONLY, None, Some(Sure::Not));
                }
                self.answer(Doing::Done, said, None, sure);
            }
            News::Failed(why) => self.tell(Doing::Refused, why, None),
            News::Left => {}
        }
    }
}

/// Returns all real linkages that follow the hand, with their counts; they are judged already.
fn all_followed(exact: &Exact) -> (Counted, Vec<Shown>) {
    let judged = exact.classes.iter().map(|class| &class.best).zip(&exact.record.linkages);
    let shown = (1..).zip(judged).map(|(rank, (best, linkage))| Shown::exact(best, rank, linkage));
    (Counted::of(&exact.record), shown.collect())
}

/// Judges all real linkages of an exact solution and returns them with their counts.
fn all_of(problem: &Problem, exact: &ExactRecord) -> (Counted, Vec<Shown>) {
    let shown = (1..).zip(&exact.linkages).filter_map(|(rank, one)| {
        let judged = assess(problem, one.linkage, &one.crank_deg, &one.t1_at)?;
        Some(Shown::exact(&judged, rank, one))
    });
    (Counted::of(exact), shown.collect())
}

/// Searches: a first look if nothing is there yet, then a whole run, the same as on the command line.
fn searched(
    job: &Job,
    problem: &Problem,
    first: bool,
    threads: usize,
    cancel: &AtomicBool,
    tell: impl Fn(News) + Sync,
) {
    let pool = match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        Ok(pool) => pool,
        Err(e) => return tell(News::Failed(format!("no threads to search with: {e}"))),
    };
    if first {
        let looks: [fn(&Problem, &Budget<'_>) -> Vec<Candidate>; 2] = [first_look, second_look];
        for look in looks {
            let found = pool.install(|| look(problem, &Budget::new(cancel, None)));
            if !found.is_empty() && !cancel.load(Ordering::Relaxed) {
                tell(News::First(found));
            }
        }
    }
    // The time of the last word, and how often the best came back.
    let heard = Mutex::new((Instant::now(), None));
    let observer = |progress: &Progress| {
        let mut heard = heard.lock().unwrap_or_else(PoisonError::into_inner);
        heard.1 = progress.hits.or(heard.1);
        if heard.0.elapsed() >= TELL_EVERY {
            heard.0 = Instant::now();
            let part = progress.evaluations as f64 / progress.budget.max(1) as f64;
            tell(News::Progress(part.min(1.0), under_way(progress)));
        }
    };
    match pool.install(|| run(job, &Context { cancel, observer: &observer })) {
        // A cancelled search does not answer the edit.
        Ok(_) if cancel.load(Ordering::Relaxed) => {}
        Ok(finished) => {
            let (_, hits) = *heard.lock().unwrap_or_else(PoisonError::into_inner);
            tell(News::Finished(Box::new(finished.record), hits));
        }
        Err(e) => tell(News::Failed(e.to_string())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Evaluations, ProblemRecord, Reason};

    #[test]
    fn the_latest_edit_wins_and_progress_does_not_pile_up() {
        let mail = Mailbox::default();
        for i in 0..1000 {
            mail.put(format!("{i}"));
            mail.tell(1, News::Progress(f64::from(i), String::new()));
        }
        let Waiting { edit, news } = mail.wait(None).expect("open");
        assert_eq!((edit.as_deref(), news.len()), (Some("999"), 1));
        mail.close();
        assert!(mail.wait(None).is_none());
    }

    fn answer(told: &watch::Receiver<Told>) -> serde_json::Value {
        serde_json::from_str(&told.borrow()).expect("JSON")
    }

    fn tab() -> (Tab, watch::Receiver<Told>) {
        let (tell, told) = watch::channel(Told::default());
        (Tab { told: tell, ..Tab::default() }, told)
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

    #[test]
    fn the_poses_of_a_body_are_followed_with_the_map_of_its_pins_where_it_is_asked_for() {
        let (mut tab, told) = tab();
        let ask = |version: u64, x: f64, map: bool| {
            serde_json::json!({
                "version": version,
                "points": [[-150.0 + x, 0.0], [-86.0, 40.0], [-21.0, 82.0], [62.0, 125.0]],
                "body": { "angle_deg": [0.0, -12.0, -30.0, -53.0] },
                "map": map,
            })
            .to_string()
        };
        tab.take(&ask(1, 0.0, false));
        assert!(answer(&told)["map"].is_null());
        let (_, problem) = tab.asked.as_ref().expect("a problem");
        let found = first_look(problem, &Budget::new(&AtomicBool::new(false), None));
        tab.session.join(problem, found);
        tab.take(&ask(2, 1.0, true));
        let said = answer(&told);
        let best = &said["candidates"][0];
        assert!(best["angle"]["max_deg"].as_f64().is_some_and(|deg| deg < 0.1), "{best}");
        assert!(best["frame_deg"].is_number());
        assert_eq!(said["map"]["levels"].as_str().map(str::len), Some(81 * 81));
    }

    #[test]
    fn a_search_of_poses_that_finds_nothing_says_that_what_followed_the_hand_is_acceptable() {
        let (mut tab, told) = tab();
        tab.take(
            r#"{"version":1,"points":[[-150,0],[-86,40],[-21,82],[62,125]],"body":{"angle_deg":[0,-12,-30,-53]}}"#,
        );
        let (job, problem) = tab.asked.clone().expect("a problem");
        let found = first_look(&problem, &Budget::new(&AtomicBool::new(false), None));
        assert!(found[0].accepted);
        let refused = Candidate { accepted: false, ..found[0].clone() };
        let ended = |candidates| {
            let asked = ProblemRecord::try_from(job.clone()).expect("a problem's record");
            let record = Record::new(asked, Vec::new(), Reason::Stalled, Evaluations::default(), candidates);
            News::Finished(Box::new(record), None)
        };
        tab.hear(tab.edits, ended(vec![refused.clone()]));
        assert!(answer(&told)["said"].as_str().is_some_and(|said| said.starts_with("Nothing acceptable")));
        tab.session.clear();
        tab.session.join(&problem, found);
        tab.hear(tab.edits, ended(vec![refused]));
        assert_eq!(answer(&told)["said"].as_str(), Some(FOLLOWED_ONLY));
    }

    #[test]
    fn the_pairs_of_a_function_are_followed() {
        let (mut tab, told) = tab();
        tab.take(r#"{"version":1,"points":[[0,0],[20,5],[40,15],[60,40]],"function":{"sense":"same"}}"#);
        let (_, problem) = tab.asked.as_ref().expect("a problem");
        let found = first_look(problem, &Budget::new(&AtomicBool::new(false), None));
        tab.session.join(problem, found);
        tab.take(r#"{"version":2,"points":[[0,0],[20,6],[40,15],[60,40]],"function":{"sense":"same"}}"#);
        let best = &answer(&told)["candidates"][0];
        assert!(best["output_offset_deg"].is_number() && best["sense"] == "same", "{best}");
        tab.take(r#"{"version":3,"points":[[0,0]],"function":{}}"#);
        assert!(answer(&told)["said"].as_str().is_some_and(|said| said.contains("2 to 1000 pairs")));
    }

    /// Nine points of which the last two lie `apart`.
    fn nine(version: u64, apart: f64) -> String {
        let mut points: Vec<[f64; 2]> =
            (0..8).map(f64::from).map(|i| [4.0 * (0.5 * i).cos(), 3.0 * (0.55 * i).sin()]).collect();
        points.push([points[7][0] + apart, points[7][1]]);
        serde_json::json!({ "version": version, "points": points, "method": "continuation" }).to_string()
    }

    #[test]
    fn poses_and_points_have_all_their_linkages_counted_and_these_follow() {
        let (mut tab, told) = tab();
        // Those of problems/motion/four-poses-two-points.toml, of which one place is moved.
        let ask = |version: u64, moved: f64| {
            let points = [
                [0.72787, -0.1739],
                [0.523672 + moved, -0.207845],
                [0.029195, -0.498199],
                [-0.577544, -0.703682],
                [-0.141316, -1.121787],
                [0.293103, -1.140891],
            ];
            let angle_deg =
                [Some(-122.350967), None, None, Some(-154.25972), Some(178.888372), Some(-179.674256)];
            let body = serde_json::json!({ "angle_deg": angle_deg });
            serde_json::json!({ "version": version, "points": points, "body": body, "method": "continuation" }).to_string()
        };
        for (version, moved) in [(1, 0.0), (2, 1e-4)] {
            tab.take(&ask(version, moved));
            let said = answer(&told);
            let counted = &said["nine"];
            assert_eq!((&counted["classes"], &counted["real"]), (&30.into(), &12.into()), "{said}");
            assert!(said["candidates"].as_array().is_some_and(|all| all.len() == 12), "{said}");
        }
    }

    #[test]
    fn points_without_exact_linkages_show_none_of_other_points_and_a_closed_tab_follows_no_more() {
        let (mut tab, told) = tab();
        tab.take(r#"{"version":1,"points":[[0,0],[1,1],[2,1.5],[3,1],[2,-1]],"closed":true}"#);
        let (_, problem) = tab.asked.as_ref().expect("a problem");
        let found = first_look(problem, &Budget::new(&AtomicBool::new(false), None));
        tab.session.join(problem, found);
        assert!(!tab.session.candidates().is_empty());
        tab.take(&nine(2, 0.0));
        let said = answer(&told);
        assert!(said["nine"].is_null() && said["candidates"].as_array().is_some_and(Vec::is_empty), "{said}");
        tab.mail.close();
        tab.take(&nine(3, 1.0));
        assert!(tab.exact.is_none());
    }
}
