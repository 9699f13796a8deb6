//! Running: the jobs of one shard or of all that are missing, on all cores.
//!
//! Workers take one job after the other, in the order of their numbers; whoever finishes the last row of a shard writes
//! its file. A slow job holds back its own shard alone.

use super::error::SweepError;
use super::job::Jobs;
use super::plan::open;
use super::shard;
use super::shard::ShardDone;
use crate::app::job::workers::pools;
use crate::record::digest::NotWritten;
use crate::record::sweep::{Plan, Status};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The inputs of a run from its caller.
#[derive(Clone, Copy)]
pub struct How<'a> {
    /// The number of threads; by default that of the current rayon pool. It changes the time, never a byte.
    pub threads: Option<usize>,
    /// The cancellation flag: shards that are complete stay.
    pub cancel: &'a AtomicBool,
    /// The callback that receives the number of jobs done in this run and the number of all that it has to do.
    pub observer: &'a (dyn Fn(u64, u64) + Sync),
}

/// The outcome of a run of all shards.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Ran {
    /// The number of shards that were there before.
    pub before: u64,
    /// The shards that were run, by number.
    pub done: Vec<ShardDone>,
    /// The number of rows of all complete shards.
    pub rows: u64,
    /// How many of them have an accepted candidate.
    pub accepted: u64,
    /// How many met a bug of linkwright.
    pub bugs: u64,
    /// Whether it was cancelled before all shards were complete.
    pub cancelled: bool,
}

impl Ran {
    fn count(&mut self, done: &ShardDone) {
        self.before += u64::from(done.before);
        self.rows += done.rows;
        self.accepted += done.accepted;
        self.bugs += done.bugs;
    }
}

/// Runs a shard of the plan in a folder, unless its file is there and whole.
///
/// # Errors
/// [`SweepError`]; [`SweepError::Cancelled`] if it was cancelled before the shard was complete.
pub fn run_shard(folder: &Path, shard: u64, how: &How<'_>) -> Result<ShardDone, SweepError> {
    let plan = open(folder)?;
    if shard >= plan.shards {
        return Err(SweepError::NoShard { shard, shards: plan.shards });
    }
    if let Some(done) = shard::find(folder, &plan, shard)? {
        return Ok(done);
    }
    match run_these(folder, &plan, vec![shard], how)?.pop() {
        Some(done) => Ok(done),
        // Another process wrote it meanwhile, or the work was cancelled.
        None => shard::find(folder, &plan, shard)?.ok_or(SweepError::Cancelled),
    }
}

/// Runs all shards of the plan in a folder whose files are missing or damaged.
///
/// # Errors
/// [`SweepError`]; [`SweepError::OtherPlan`] before anything is run if there is a shard of another plan.
pub fn run_missing(folder: &Path, how: &How<'_>) -> Result<Ran, SweepError> {
    let plan = open(folder)?;
    let mut ran = Ran::default();
    let mut missing = Vec::new();
    for shard in 0..plan.shards {
        match shard::find(folder, &plan, shard)? {
            Some(done) => ran.count(&done),
            None => missing.push(shard),
        }
    }
    let wanted = missing.clone();
    ran.done = run_these(folder, &plan, missing, how)?;
    ran.done.sort_by_key(|done| done.shard);
    for done in ran.done.clone() {
        ran.count(&done);
    }
    // The others were written by another process meanwhile, or were cancelled.
    for shard in wanted {
        if ran.done.binary_search_by_key(&shard, |done| done.shard).is_err() {
            match shard::find(folder, &plan, shard)? {
                Some(done) => ran.count(&done),
                None => ran.cancelled = true,
            }
        }
    }
    Ok(ran)
}

/// Runs jobs without keeping their rows, and returns how many positions of a linkage each computed; `None` for one that was
/// refused. The numbers are sorted.
pub(super) fn sample(plan: &Plan, numbers: &[u64], how: &How<'_>) -> Result<Vec<Option<u64>>, SweepError> {
    let jobs = Jobs::of(plan);
    let next = AtomicU64::new(0);
    let costs = Mutex::new(Vec::new());
    let work = |pool: &rayon::ThreadPool| {
        while let Some(number) = numbers.get(next.fetch_add(1, Ordering::Relaxed) as usize) {
            let Some((row, cost)) = pool.install(|| jobs.run(*number, how.cancel)) else { return };
            locked(&costs).push(row.termination.map(|_| cost.positions));
        }
    };
    side_by_side(&pools(numbers.len(), how.threads)?, &work);
    let mut costs = costs.into_inner().unwrap_or_else(PoisonError::into_inner);
    // In an order that does not depend on the threads.
    costs.sort_unstable();
    if how.cancel.load(Ordering::Relaxed) { Err(SweepError::Cancelled) } else { Ok(costs) }
}

/// Calls a function once for each pool, each call on a thread of its own.
fn side_by_side(pools: &[rayon::ThreadPool], work: &(impl Fn(&rayon::ThreadPool) + Sync)) {
    std::thread::scope(|scope| {
        for pool in pools {
            scope.spawn(|| work(pool));
        }
    });
}

/// The jobs that no worker has taken yet.
struct Queue {
    /// The shards that are left, the next last.
    shards: Vec<u64>,
    shard: u64,
    jobs: Range<u64>,
}

/// The rows of a shard that is being run.
struct Rows {
    lines: Vec<String>,
    left: usize,
    accepted: u64,
    bugs: u64,
}

/// A run of some shards, shared by its workers.
struct Work<'a> {
    folder: &'a Path,
    plan: &'a Plan,
    jobs: Jobs<'a>,
    how: &'a How<'a>,
    queue: Mutex<Queue>,
    open: Mutex<BTreeMap<u64, Rows>>,
    written: Mutex<Result<Vec<ShardDone>, SweepError>>,
    done: AtomicU64,
    total: u64,
}

/// Runs shards, which are not empty, and returns those that were completed.
fn run_these(
    folder: &Path,
    plan: &Plan,
    mut shards: Vec<u64>,
    how: &How<'_>,
) -> Result<Vec<ShardDone>, SweepError> {
    let total = shards.iter().map(|shard| plan.jobs_of(*shard)).map(|jobs| jobs.end - jobs.start).sum();
    shards.reverse();
    let work = Work {
        folder,
        plan,
        jobs: Jobs::of(plan),
        how,
        queue: Mutex::new(Queue { shards, shard: 0, jobs: 0..0 }),
        open: Mutex::new(BTreeMap::new()),
        written: Mutex::new(Ok(Vec::new())),
        done: AtomicU64::new(0),
        total,
    };
    let pools = pools(usize::try_from(total).unwrap_or(usize::MAX), how.threads)?;
    side_by_side(&pools, &|pool| work.jobs(pool));
    work.written.into_inner().unwrap_or_else(PoisonError::into_inner)
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Work<'_> {
    /// Takes one job after the other until all are taken, or a file cannot be written, or the run is cancelled.
    fn jobs(&self, pool: &rayon::ThreadPool) {
        while !self.how.cancel.load(Ordering::Relaxed)
            && locked(&self.written).is_ok()
            && let Some((shard, number)) = self.take()
        {
            let Some((row, _)) = pool.install(|| self.jobs.run(number, self.how.cancel)) else { return };
            let line = serde_json::to_string(&row).map(|line| line + "\n");
            let kept = line
                .map_err(|e| NotWritten::from(e).into())
                .and_then(|line| self.keep(shard, number, line, row.status));
            if let Err(why) = kept {
                let mut written = locked(&self.written);
                if written.is_ok() {
                    *written = Err(why);
                }
                return;
            }
            let done = 1 + self.done.fetch_add(1, Ordering::Relaxed);
            (self.how.observer)(done, self.total);
        }
    }

    /// Takes the next job and its shard. A shard that another process has written since is left out.
    fn take(&self) -> Option<(u64, u64)> {
        let mut queue = locked(&self.queue);
        loop {
            if let Some(job) = queue.jobs.next() {
                return Some((queue.shard, job));
            }
            let shard = queue.shards.pop()?;
            if shard::exists(self.folder, shard)
                && matches!(shard::find(self.folder, self.plan, shard), Ok(Some(_)))
            {
                continue;
            }
            (queue.shard, queue.jobs) = (shard, self.plan.jobs_of(shard));
            let count = (queue.jobs.end - queue.jobs.start) as usize;
            let rows = Rows { lines: vec![String::new(); count], left: count, accepted: 0, bugs: 0 };
            locked(&self.open).insert(shard, rows);
        }
    }

    /// Keeps the row of a job, and writes its shard if it was the last.
    fn keep(&self, shard: u64, number: u64, line: String, status: Status) -> Result<(), SweepError> {
        let complete = {
            let mut open = locked(&self.open);
            // The shard is open until its last row is kept.
            let Some(rows) = open.get_mut(&shard) else { return Ok(()) };
            rows.lines[(number - self.plan.jobs_of(shard).start) as usize] = line;
            rows.left -= 1;
            rows.accepted += u64::from(status == Status::Accepted);
            rows.bugs += u64::from(status == Status::Bug);
            if rows.left > 0 {
                return Ok(());
            }
            open.remove(&shard)
        };
        let Some(rows) = complete else { return Ok(()) };
        let done = shard::write(self.folder, self.plan, shard, &rows.lines, [rows.accepted, rows.bugs])?;
        if let Ok(written) = &mut *locked(&self.written) {
            written.push(done);
        }
        Ok(())
    }
}
