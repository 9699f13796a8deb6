//! A bar on a terminal, plain lines otherwise; nothing for work that is over before one could read it.

use super::terminal::tell;
use crate::app::suite::Step;
use crate::judge::certificate;
use crate::report::text::{at_most, brief, clean, grouped, percent_up};
use crate::synthesis::Progress;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::{IsTerminal, stderr};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

/// Work shorter than this shows no bar.
const QUIET_FOR: Duration = Duration::from_millis(700);
/// Plain lines come at most this often.
const LINE_EVERY: Duration = Duration::from_secs(5);
/// A bar moves at most this often.
const BAR_EVERY: Duration = Duration::from_millis(100);

/// Shows the progress of one piece of work.
pub struct Shown {
    name: String,
    start: Instant,
    last: Mutex<Instant>,
    bar: Option<ProgressBar>,
    silent: bool,
    /// Evaluations at the first word of a search: those of an earlier run whose checkpoint this one goes on from.
    before: OnceLock<u64>,
    /// The jobs of a batch that are done.
    done: AtomicU64,
}

impl Shown {
    fn new(name: &str, silent: bool, style: Option<&str>) -> Self {
        let style = style.filter(|_| stderr().is_terminal() && !silent);
        let bar = style.map(|style| {
            let style = ProgressStyle::with_template(style).unwrap_or_else(|_| ProgressStyle::default_bar());
            ProgressBar::hidden().with_style(style).with_prefix(clean(name))
        });
        let now = Instant::now();
        Shown {
            name: clean(name),
            start: now,
            last: Mutex::new(now),
            bar,
            silent,
            before: OnceLock::new(),
            done: AtomicU64::new(0),
        }
    }

    /// Returns the progress of the search of the problem `name`.
    pub fn of_search(name: &str, silent: bool) -> Self {
        let style = "{prefix} [{bar:24}] {percent}% of {len} evaluations, {eta} left, {msg}";
        Shown::new(name, silent, Some(style))
    }

    /// Returns the progress of a batch whose jobs run side by side.
    pub fn of_batch(silent: bool) -> Self {
        Shown::new("", silent, Some("[{bar:24}] {pos} of {len} jobs, {per_sec}, {eta} left"))
    }

    /// Returns the progress of a suite.
    pub fn of_suite() -> Self {
        Shown::new("", false, Some("[{bar:24}] {pos} of {len} runs, {msg}"))
    }

    /// Returns the progress of a certificate or of its check: plain lines alone.
    pub fn of_proof(name: &str, silent: bool) -> Self {
        Shown::new(name, silent, None)
    }

    /// Moves the bar, or writes a line without one. Reports come many times during work whose time is measured: most are
    /// dropped at once.
    fn show(&self, [done, total]: [u64; 2], beside: impl FnOnce() -> String, line: impl FnOnce() -> String) {
        let every = if self.bar.is_some() { BAR_EVERY } else { LINE_EVERY };
        if self.silent || self.start.elapsed() < QUIET_FOR {
            return;
        }
        let Ok(mut last) = self.last.lock() else { return };
        if last.elapsed() < every {
            return;
        }
        *last = Instant::now();
        let Some(bar) = &self.bar else { return tell(&line()) };
        if bar.is_hidden() {
            bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(10));
        }
        bar.set_length(total);
        bar.set_position(done);
        bar.set_message(beside());
    }

    /// Takes a word from a search.
    pub fn search(&self, progress: &Progress) {
        let before = *self.before.get_or_init(|| progress.evaluations);
        let rate = || rate(progress, before, self.start.elapsed());
        let at = [progress.evaluations.min(progress.budget), progress.budget];
        self.show(at, || beside_the_bar(progress, rate()), || line(&self.name, progress, rate()));
    }

    /// Takes a word from a suite.
    pub fn suite(&self, step: &Step<'_>) {
        let Step { done, total, .. } = *step;
        let run = || format!("{}: {}, seed {}", clean(step.problem), step.method.name(), step.seed);
        self.show([done, total], run, || format!("{}, {done} of {total} runs done", run()));
    }

    /// One more job of a batch of `total` is done.
    pub fn one_more(&self, total: u64) {
        let done = 1 + self.done.fetch_add(1, Ordering::Relaxed);
        self.show([done, total], String::new, || of_jobs(done, total, self.start.elapsed()));
    }

    /// Takes a word from a certificate.
    pub fn proof(&self, progress: &certificate::Progress) {
        self.show([0; 2], String::new, || proved(&self.name, self.start.elapsed(), progress));
    }

    /// Takes the number of leaves of a certificate that are checked.
    pub fn leaves(&self, file: &str, checked: u64) {
        let seconds = self.start.elapsed().as_secs_f64();
        let line = || format!("{file}: {seconds:.0} s: {checked} leaves checked");
        self.show([0; 2], String::new, line);
    }

    /// Takes the bar away.
    pub fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// A time as one says it: `40 s`, `12 min`, `3.4 h`.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6000.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

/// Describes the state of a batch in a line, with its rate and the time left.
fn of_jobs(done: u64, total: u64, elapsed: Duration) -> String {
    let rate = done as f64 / elapsed.as_secs_f64();
    let left = duration(total.saturating_sub(done) as f64 / rate);
    format!("{} of {} jobs done, {}/s, about {left} left", grouped(done), grouped(total), brief(rate, 3))
}

/// Describes the state of a proof in a line.
fn proved(name: &str, elapsed: Duration, progress: &certificate::Progress) -> String {
    format!(
        "{name}: certificate, {:.0} s: {} boxes, {:.3} % of the linkages decided, no sum below {} (gap {} %)",
        elapsed.as_secs_f64(),
        progress.boxes,
        100.0 * progress.decided,
        at_most(progress.lower_bound, 7),
        percent_up(progress.gap),
    )
}

/// Returns the evaluations a second of a search that has run for `elapsed` here, and had made `before` evaluations when
/// it began.
fn rate(progress: &Progress, before: u64, elapsed: Duration) -> f64 {
    progress.evaluations.saturating_sub(before) as f64 / elapsed.as_secs_f64()
}

/// Describes the best answer of a search.
fn best(progress: &Progress) -> String {
    match progress.best_sum_sq {
        Some(sum) if progress.accepted => format!("best {sum:.4e}"),
        Some(sum) => format!("best {sum:.4e} (not acceptable yet)"),
        // The front, which has no single best answer.
        None if progress.accepted => "from acceptable answers".into(),
        None => "nothing acceptable yet".into(),
    }
}

/// Describes a search beside its bar, which shows the share and the time left.
fn beside_the_bar(progress: &Progress, rate: f64) -> String {
    format!("{}/s, {}", grouped(rate as u64), best(progress))
}

/// Describes a search in a line, with the longest time that its budget leaves it.
fn line(name: &str, progress: &Progress, rate: f64) -> String {
    let Progress { phase, evaluations, budget, .. } = progress;
    let left_s = budget.saturating_sub(*evaluations) as f64 / rate;
    let left =
        if left_s.is_finite() { format!("at most {} left, ", duration(left_s)) } else { String::new() };
    let (name, rate, best) = (clean(name), grouped(rate as u64), best(progress));
    format!("{name}: {phase} {evaluations} of {budget} evaluations, {rate}/s, {left}{best}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(evaluations: u64, best_sum_sq: Option<f64>, accepted: bool) -> Progress {
        Progress { phase: "least-squares", evaluations, budget: 1_000_000, best_sum_sq, accepted, hits: None }
    }

    fn after(progress: &Progress, before: u64, seconds: u64) -> String {
        line("leg", progress, rate(progress, before, Duration::from_secs(seconds)))
    }

    #[test]
    fn a_line_says_the_best_the_rate_and_the_time_left() {
        assert_eq!(
            after(&at(200_000, Some(0.0123456), true), 0, 10),
            "leg: least-squares 200000 of 1000000 evaluations, 20,000/s, at most 40 s left, best 1.2346e-2"
        );
        let progress = at(200_000, Some(0.5), true);
        let rate = rate(&progress, 0, Duration::from_secs(10));
        assert_eq!(beside_the_bar(&progress, rate), "20,000/s, best 5.0000e-1");
    }

    #[test]
    fn an_answer_that_is_not_acceptable_is_told_apart_from_one_that_is_and_from_none() {
        let told = |sum, accepted| best(&at(10, sum, accepted));
        assert_eq!(told(Some(2.0), true), "best 2.0000e0");
        assert_eq!(told(Some(2.0), false), "best 2.0000e0 (not acceptable yet)");
        assert_eq!(told(None, false), "nothing acceptable yet");
        assert_eq!(told(None, true), "from acceptable answers");
    }

    #[test]
    fn the_rate_counts_what_was_done_here_and_not_what_a_checkpoint_brought() {
        let text = after(&at(600_000, None, false), 500_000, 100);
        assert!(text.contains("600000 of 1000000 evaluations, 1,000/s, at most 7 min left"), "{text}");
    }

    #[test]
    fn nothing_is_foretold_before_anything_was_done_and_nothing_is_left_beyond_the_budget() {
        let text = after(&at(500_000, None, false), 500_000, 3);
        assert!(text.ends_with("evaluations, 0/s, nothing acceptable yet"), "{text}");
        let text = after(&at(1_000_001, None, false), 0, 1);
        assert!(text.contains("at most 0 s left"), "{text}");
    }

    #[test]
    fn a_batch_says_its_rate_and_the_time_left() {
        let text = of_jobs(1500, 6000, Duration::from_secs(40));
        assert_eq!(text, "1,500 of 6,000 jobs done, 37.5/s, about 2 min left");
    }

    #[test]
    fn a_certificate_says_what_is_proved_by_now() {
        let progress = certificate::Progress { boxes: 1200, decided: 0.25, lower_bound: 0.009, gap: 0.05 };
        assert_eq!(
            proved("leg", Duration::from_secs(10), &progress),
            "leg: certificate, 10 s: 1200 boxes, 25.000 % of the linkages decided, no sum below 0.009000000 (gap 5 %)"
        );
    }

    #[test]
    fn a_name_cannot_move_the_cursor() {
        let progress = at(10, None, false);
        let text = line("\u{1b}[2Jleg", &progress, 10.0);
        assert!(!text.contains('\u{1b}'), "{text:?}");
    }

    #[test]
    fn times_are_said_in_the_unit_one_would_use() {
        let said = [0.2, 99.0, 100.0, 5999.0, 6000.0, 86_400.0].map(duration);
        assert_eq!(said, ["0 s", "99 s", "2 min", "100 min", "1.7 h", "24.0 h"]);
    }
}
