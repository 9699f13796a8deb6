//! The certification of a record, and the recomputation of a recorded certificate.

use super::subject::{NoCertificate, Subject};
use crate::numbers::bound::search::{Question, Search};
use crate::numbers::leaves::Class;
use crate::numbers::leaves::{Angles, Leaves, LeavesPart};
use crate::record::{Certificate, Record};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// The request for a certificate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// The relative gap between the best candidate and the bound, in (0, 1).
    pub gap: f64,
}

/// The progress of a search for a certificate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The number of boxes evaluated.
    pub boxes: u64,
    /// The share of the charts that is decided.
    pub decided: f64,
    /// The lower bound certified by now.
    pub lower_bound: f64,
    /// The gap of the bound below the best candidate, relative to the candidate.
    pub gap: f64,
}

/// A search for a certificate: it can be stopped at any time, and the bound certified by then is valid.
#[derive(Clone, Debug)]
pub struct Proof {
    pub(super) subject: Subject,
    pub(super) searches: Vec<(Class, f64, Search)>,
}

impl Proof {
    /// Creates the search for the task of a result.
    ///
    /// # Errors
    /// [`NoCertificate`].
    pub fn new(record: &Record, request: &Request) -> Result<Self, NoCertificate> {
        let subject = Subject::new(record, request.gap)?;
        let mut searches = Vec::new();
        for (class, direction) in subject.parts() {
            let (points, turns, cap) = (&subject.points, &subject.turns_deg, subject.cap);
            let question = match subject.angles {
                Angles::Increments => Question::new(class, direction, points, turns, cap)?,
                Angles::Ground => Question::new(class, direction, points, turns, cap)?.from_ground(),
                Angles::Axis(axis) => Question::from_axis(class, points, turns, cap, axis)?,
            };
            searches.push((class, direction, Search::new(question, subject.wanted())));
        }
        Ok(Proof { subject, searches })
    }

    /// Continues the search until the gap is reached, `cancel` is set or the deadline is over.
    pub fn run(
        &mut self,
        cancel: &AtomicBool,
        deadline: Option<Instant>,
        progress: &mut dyn FnMut(&Progress),
    ) {
        loop {
            let stopped = cancel.load(Ordering::Relaxed) || deadline.is_some_and(|end| Instant::now() >= end);
            let open =
                self.searches.iter_mut().map(|(_, _, search)| search).filter(|s| !s.closed() && !s.full());
            let lowest = open.min_by(|a, b| a.lower_bound().total_cmp(&b.lower_bound()));
            let Some(search) = lowest.filter(|_| !stopped) else { break };
            search.step();
            progress(&self.progress());
        }
    }

    fn progress(&self) -> Progress {
        let searches = || self.searches.iter().map(|(_, _, search)| search);
        let lower_bound = searches().map(Search::lower_bound).fold(f64::INFINITY, f64::min);
        Progress {
            boxes: searches().map(Search::boxes).sum(),
            decided: searches().map(Search::decided).sum::<f64>() / self.searches.len() as f64,
            lower_bound,
            gap: self.subject.gap_of(lower_bound),
        }
    }

    /// Returns whether more time would change nothing: the gap is reached, or no more boxes can be kept.
    pub fn ended(&self) -> bool {
        self.searches.iter().all(|(_, _, search)| search.closed() || search.full())
    }

    /// Returns the trees of all parts: a file for a checker, whose digest is in the certificate.
    pub fn leaves(&self) -> Leaves {
        let part = |(class, direction, search): &(Class, f64, Search)| LeavesPart {
            class: *class,
            direction: if *direction > 0.0 { 1 } else { -1 },
            origin: self.subject.angles.origin(),
            lower_bound: search.lower_bound(),
            nodes: search.nodes(),
        };
        Leaves { parts: self.searches.iter().map(part).collect() }
    }

    /// Returns the certificate for the bound reached by now.
    pub fn certificate(&self) -> Certificate {
        self.certificate_of(&self.leaves())
    }

    /// Returns the certificate for `leaves`, those of [`Proof::leaves`], if these are at hand.
    pub fn certificate_of(&self, leaves: &Leaves) -> Certificate {
        self.subject.certificate(leaves)
    }
}

/// Bounds the sum of squares of every linkage whose input turns fully, for the task of a result.
///
/// It ends when the gap is reached, when `cancel` is set or at the deadline: the bound certified by then is valid.
///
/// # Errors
/// [`NoCertificate`].
pub fn certify(
    record: &Record,
    request: &Request,
    cancel: &AtomicBool,
    deadline: Option<Instant>,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Certificate, NoCertificate> {
    let mut proof = Proof::new(record, request)?;
    proof.run(cancel, deadline, progress);
    Ok(proof.certificate())
}

/// Recomputes a recorded certificate with as many boxes of each part as it has: the result is the same if the
/// recorded one is true; `None` if `cancel` was set before the end.
///
/// # Errors
/// [`NoCertificate`] if no certificate is available for the record's task.
pub fn recheck(
    record: &Record,
    recorded: &Certificate,
    cancel: &AtomicBool,
    progress: &mut dyn FnMut(&Progress),
) -> Result<Option<Certificate>, NoCertificate> {
    let mut proof = Proof::new(record, &Request { gap: recorded.wanted_gap })?;
    for (i, part) in recorded.parts.iter().enumerate().take(proof.searches.len()) {
        loop {
            let (_, _, search) = &mut proof.searches[i];
            if search.boxes() >= part.boxes || search.closed() || search.full() {
                break;
            }
            search.step();
            progress(&proof.progress());
            if cancel.load(Ordering::Relaxed) {
                return Ok(None);
            }
        }
    }
    Ok(Some(proof.certificate()))
}
