//! A record in, its certificate out; a recorded certificate worked out again.

use super::chart::Class;
use super::search::{Question, Search};
use super::target::TargetError;
use crate::record::{Certificate, CertificatePart, Record};
use crate::task::AngleOffset;
use sha2::{Digest, Sha256};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// The gap that is asked for unless another is given.
pub const DEFAULT_GAP: f64 = 1e-4;

/// A little less than the wanted gap is searched for, so that the gap from the rounded bound is not above it.
const WITHIN: f64 = 1.0 - 1e-9;

/// What is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Request {
    /// The relative gap between the best candidate and the bound, in (0, 1).
    pub gap: f64,
}

/// How far a search for a certificate is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Boxes looked at.
    pub boxes: u64,
    /// The share of the charts that is decided.
    pub decided: f64,
    /// What is certified by now.
    pub lower_bound: f64,
    /// Relative to the best candidate.
    pub gap: f64,
}

/// Why a result has no certificate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoCertificate {
    /// Nothing to compare with.
    #[error("the result has no candidate")]
    NoCandidate,
    /// The points are met at whatever crank angle is nearest.
    #[error("no certificate is available for free timing: give the points crank angles (task.path.timing)")]
    FreeTiming,
    /// The crank angles are not increments.
    #[error("no certificate is available yet for crank angles from a fixed line: it needs offset = \"free\"")]
    FixedOffset,
    /// The sum is not the plain one.
    #[error("no certificate is available yet for weighted points or for objective = \"max-deviation\"")]
    OtherObjective,
    /// The best candidate meets the points exactly.
    #[error("the best candidate meets the points exactly: nothing can be below it")]
    Exact,
    /// A gap that is none.
    #[error("the gap is {gap}; it lies between 0 and 1, such as 1e-4")]
    Gap {
        /// What was given.
        gap: f64,
    },
    /// The coupler point may be anywhere.
    #[error("the coupler point has no limits: give design.coupler_x and coupler_y, or design.d")]
    NoLimits,
    /// The figures are too few or too much alike.
    #[error(transparent)]
    Target(#[from] TargetError),
}

/// Everything that a certificate is about.
struct Subject {
    searches: Vec<(Class, f64, Search)>,
    best: f64,
    cap: f64,
    points: usize,
}

impl Subject {
    fn new(record: &Record, gap: f64) -> Result<Self, NoCertificate> {
        if !(gap > 0.0 && gap < 1.0) {
            return Err(NoCertificate::Gap { gap });
        }
        let spec = &record.problem.resolved;
        let best = record.candidates.first().ok_or(NoCertificate::NoCandidate)?.error.sum_sq;
        let path = &spec.task.path;
        let timing = path.timing.as_ref().ok_or(NoCertificate::FreeTiming)?;
        if timing.offset != AngleOffset::Free {
            return Err(NoCertificate::FixedOffset);
        }
        let problem = crate::problem::Problem::new(spec.clone()).map_err(|_| NoCertificate::NoCandidate)?;
        let task = problem.task();
        let first = task.weights().first().copied().unwrap_or(1.0);
        let weighted = task.weights().iter().any(|w| *w != first);
        if weighted || spec.solve.objective != crate::problem::spec::Objective::SumOfSquares {
            return Err(NoCertificate::OtherObjective);
        }
        if best.is_nan() || best <= 0.0 {
            return Err(NoCertificate::Exact);
        }
        let design = &spec.design;
        let largest = |limits: crate::problem::spec::Limits| limits.0.abs().max(limits.1.abs());
        let by_box = design.coupler_x.zip(design.coupler_y).map(|(x, y)| largest(x).hypot(largest(y)));
        let by_length = design.d.map(largest);
        let cap = match (by_box, by_length) {
            (Some(x), Some(y)) => x.min(y),
            (Some(x), None) | (None, Some(x)) => x,
            (None, None) => return Err(NoCertificate::NoLimits),
        } * (1.0 + 1e-9);
        let points: Vec<[f64; 2]> = task.points().iter().map(|p| [p.re, p.im]).collect();
        let mut searches = Vec::new();
        for class in Class::ALL {
            for &direction in problem.directions() {
                let question = Question::new(class, direction, &points, &timing.crank_deg, cap)?;
                searches.push((class, direction, Search::new(question, best * (1.0 - gap * WITHIN))));
            }
        }
        Ok(Subject { searches, best, cap, points: points.len() })
    }

    fn lower_bound(&self) -> f64 {
        self.searches.iter().map(|(_, _, search)| search.lower_bound()).fold(f64::INFINITY, f64::min)
    }

    fn gap(&self) -> f64 {
        (1.0 - self.lower_bound() / self.best).max(0.0)
    }

    fn certificate(&self, request: &Request) -> Certificate {
        let part = |(class, direction, search): &(Class, f64, Search)| CertificatePart {
            linkage_type: class.name().to_owned(),
            direction: if *direction > 0.0 { 1 } else { -1 },
            lower_bound: search.lower_bound(),
            closed: search.closed(),
            boxes: search.boxes(),
            leaves_sha256: hex(&search.leaves_sha256()),
        };
        let parts: Vec<CertificatePart> = self.searches.iter().map(part).collect();
        let mut all = Sha256::new();
        for (_, _, search) in &self.searches {
            all.update(search.leaves_sha256());
        }
        let (bound, points, cap, best) = (self.lower_bound(), self.points, self.cap, self.best);
        // Rounded down to the digits that are shown.
        let below = bound * (1.0 - 1e-12);
        let either = if self.searches.len() == 4 { "either way" } else { "the way that is asked for" };
        Certificate {
            statement: format!(
                "No four-bar linkage whose input turns fully and whose coupler point is at most {cap:.6} from the \
                 crank pin has a sum of squared errors below {below:.12e} at these {points} points and increments \
                 of the crank; the best one found has {best:.12e}."
            ),
            lower_bound: bound,
            gap: self.gap(),
            closed: parts.iter().all(|part| part.closed),
            boxes: parts.iter().map(|part| part.boxes).sum(),
            covered: vec![
                "crank-rockers and double-cranks, change points included".into(),
                "both assemblies".into(),
                format!("the crank turning {either}, any first crank angle"),
                format!(
                    "any pivots and lengths of links, the coupler point at most {cap:.6} from the crank pin"
                ),
            ],
            not_covered: vec![
                "linkages whose input rocks".into(),
                "coupler points farther from the crank pin".into(),
            ],
            leaves_sha256: hex(&all.finalize()),
            wanted_gap: request.gap,
            parts,
        }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Bounds the sum of squares of every linkage whose input turns fully, for the task of a result.
///
/// It ends when the gap is reached, when `cancel` is set or at the deadline: what is certified by then is valid.
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
    let mut subject = Subject::new(record, request.gap)?;
    loop {
        let stopped = cancel.load(Ordering::Relaxed) || deadline.is_some_and(|end| Instant::now() >= end);
        let open =
            subject.searches.iter_mut().map(|(_, _, search)| search).filter(|s| !s.closed() && !s.full());
        let lowest = open.min_by(|a, b| a.lower_bound().total_cmp(&b.lower_bound()));
        let Some(search) = lowest.filter(|_| !stopped) else { break };
        search.step();
        let searches = || subject.searches.iter().map(|(_, _, search)| search);
        progress(&Progress {
            boxes: searches().map(Search::boxes).sum(),
            decided: searches().map(Search::decided).sum::<f64>() / subject.searches.len() as f64,
            lower_bound: subject.lower_bound(),
            gap: subject.gap(),
        });
    }
    Ok(subject.certificate(request))
}

/// Works out a recorded certificate again, with as many boxes of each part as it has: the same, where it is true.
///
/// # Errors
/// [`NoCertificate`] where the record has a task for which there is none.
pub fn recheck(record: &Record, recorded: &Certificate) -> Result<Certificate, NoCertificate> {
    let request = Request { gap: recorded.wanted_gap };
    let mut subject = Subject::new(record, request.gap)?;
    for ((_, _, search), part) in subject.searches.iter_mut().zip(&recorded.parts) {
        while search.boxes() < part.boxes && !search.closed() && !search.full() {
            search.step();
        }
    }
    Ok(subject.certificate(&request))
}
