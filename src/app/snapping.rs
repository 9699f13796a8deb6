//! The subject of a snap: a linkage with the problem on which it is measured, the dimensions that stay as they are, and
//! the stock of a file.

use crate::app::inputs::{Given, NoCandidate};
use crate::files::diagnostic::{Diagnostic, escaped};
use crate::files::input_text;
use crate::mechanism::{Complex, CrankLinkage, LinkageKind, Unit, xy};
use crate::record::{Candidate, ProblemRecord};
use crate::report::text::clean;
use crate::synthesis::snap::{Fixed, JointName, Length, Stock, own_curve};
use crate::task::{Problem, TaskError};
use std::path::Path;

/// The longest text of a list of pitches, in bytes.
const MAX_PITCHES: u64 = 1 << 20;

/// The direction from A to B.
const ANGLE: &str = "ground_angle_deg";
/// What can be kept beside lengths.
const KEPT: [&str; 7] = ["A", "B", "X2", "Y2", "X3", "Y3", ANGLE];

/// A key that names nothing of any linkage.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoKey {
    /// It is no hole distance.
    #[error("a hole distance is one of ground, a, b, c, d, e, or of a six-bar two joints, such as X2F2")]
    Length,
    /// It cannot be kept.
    #[error(
        "what can be kept is one of ground, a, b, c, d, e, A, B, ground_angle_deg, or of a six-bar two joints or a third pivot, such as X2F2 or Y2"
    )]
    Kept,
    /// It cannot be set.
    #[error(
        "what can be set is one of ground, a, b, c, d, e, ground_angle_deg, or of a six-bar two joints, such as X2F2"
    )]
    Set,
}

/// Returns the hole distance of a key.
///
/// # Errors
/// [`NoKey`].
pub fn length_key(text: &str) -> Result<Length, NoKey> {
    Length::named(text.trim()).ok_or(NoKey::Length)
}

/// Returns the key of a dimension that can be kept.
///
/// # Errors
/// [`NoKey`].
pub fn kept_key(text: &str) -> Result<String, NoKey> {
    let key = text.trim();
    (Length::named(key).is_some() || KEPT.contains(&key)).then(|| key.to_owned()).ok_or(NoKey::Kept)
}

/// Returns whether the key of a dimension that can be set names a length, which is above 0, and not an angle.
///
/// # Errors
/// [`NoKey`].
pub fn set_key(key: &str) -> Result<bool, NoKey> {
    let is_length = Length::named(key).is_some();
    (is_length || key == ANGLE).then_some(is_length).ok_or(NoKey::Set)
}

/// The linkage to snap, with its problem.
#[derive(Clone, Debug)]
pub struct Subject {
    /// Its label, in words.
    pub label: String,
    /// The name of its problem or file.
    pub name: String,
    /// The source of the problem.
    pub source: Option<String>,
    /// The unit of its lengths.
    pub unit: Option<Unit>,
    /// The problem.
    pub problem: Problem,
    /// The linkage, judged on the problem.
    pub candidate: Candidate,
}

/// The reason why there is nothing to snap.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoSubject {
    /// The linkage has no position.
    #[error("{0} cannot be assembled, so it has no curve to keep")]
    NotAssembled(String),
    /// The result has no candidate.
    #[error(transparent)]
    NoCandidate(#[from] NoCandidate),
    /// The problem of the record is invalid.
    #[error(transparent)]
    Problem(#[from] TaskError),
    /// The candidate lacks a position.
    #[error("{0} has no position for each of the target's points")]
    Positions(String),
}

impl Subject {
    /// Returns the subject of an input: of a result the candidate that is named, else the first; a linkage without a run
    /// is measured on its own coupler curve.
    ///
    /// # Errors
    /// [`NoSubject`].
    pub fn of(given: Given) -> Result<Self, NoSubject> {
        match given {
            Given::Linkage(file) => {
                let found = own_curve(&file.linkage);
                let (problem, candidate) = found.ok_or_else(|| NoSubject::NotAssembled(clean(&file.name)))?;
                let label = format!("{}, measured on its own coupler curve", clean(&file.name));
                Ok(Subject { label, name: file.name, source: None, unit: file.unit, problem, candidate })
            }
            Given::Run(run) => {
                let chosen = run.one()?;
                let (label, candidate) = (escaped(&chosen.label), chosen.candidate.clone());
                let ProblemRecord { name, source, unit, resolved, .. } = run.record.problem;
                let problem = Problem::new(resolved)?;
                let points = problem.task().len();
                if candidate.crank_deg.len() != points || candidate.t1_at.len() != points {
                    return Err(NoSubject::Positions(label));
                }
                Ok(Subject { label, name, source, unit, problem, candidate })
            }
        }
    }
}

/// A dimension that a linkage of this kind does not have.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{key}: {} has no such dimension; it has {}", kind.with_article(), has.join(", "))]
pub struct NoDimension {
    key: String,
    kind: LinkageKind,
    has: Vec<String>,
}

impl NoDimension {
    fn of(linkage: &CrankLinkage, key: &str) -> Self {
        let lengths = Length::all(linkage).into_iter().map(Length::key);
        let pivots = pivots(linkage).into_iter().map(|(name, _)| name.to_owned());
        NoDimension { key: key.to_owned(), kind: linkage.kind(), has: lengths.chain(pivots).collect() }
    }
}

/// Returns the fixed pivots of a linkage, by name.
fn pivots(linkage: &CrankLinkage) -> Vec<(&'static str, Complex)> {
    match linkage.multi_loop() {
        Some(linkage) => linkage.named_pivots(),
        None => {
            let second = linkage.second_pivot().map(|at| ("B", at));
            [("A", linkage.crank_pivot())].into_iter().chain(second).collect()
        }
    }
}

/// Returns the lengths that are to be snapped: those that are asked for, else all that the linkage has.
///
/// # Errors
/// [`NoDimension`].
pub fn to_snap(linkage: &CrankLinkage, asked: Option<&[Length]>) -> Result<Vec<Length>, NoDimension> {
    let all = Length::all(linkage);
    let Some(asked) = asked else { return Ok(all) };
    match asked.iter().find(|length| !all.contains(length)) {
        Some(missing) => Err(NoDimension::of(linkage, &missing.key())),
        None => Ok(asked.to_vec()),
    }
}

/// Returns the dimensions that are fixed: those of the linkage that are kept (lengths and fixed pivots by their names, or
/// `ground_angle_deg`), and those that are put at a value of their own.
///
/// # Errors
/// [`NoDimension`].
pub fn fixed(linkage: &CrankLinkage, keep: &[String], set: &[(String, f64)]) -> Result<Fixed, NoDimension> {
    let mut fixed = Fixed::default();
    let missing = |key: &str| NoDimension::of(linkage, key);
    for key in keep {
        let pivot = pivots(linkage).into_iter().find(|(name, _)| name == key);
        match (Length::named(key), pivot, JointName::named(key)) {
            (Some(length), ..) => {
                let value = length.of(*linkage).ok_or_else(|| missing(key))?;
                fixed = fixed.with(length, value);
            }
            (None, Some(("A", at)), _) => fixed.crank_pivot = Some(xy(at)),
            (None, Some(("B", at)), _) => fixed.follower_pivot = Some(xy(at)),
            (None, Some((_, at)), Some(joint)) => fixed.further_pivots.push((joint, xy(at))),
            (None, ..) if key == ANGLE && linkage.second_pivot().is_some() => {
                fixed.ground_angle_deg = Some(linkage.ground_angle().to_degrees());
            }
            (None, ..) => return Err(missing(key)),
        }
    }
    for (key, value) in set {
        match Length::named(key) {
            Some(length) => {
                length.of(*linkage).ok_or_else(|| missing(key))?;
                fixed = fixed.with(length, *value);
            }
            None => {
                linkage.second_pivot().ok_or_else(|| missing(key))?;
                fixed.ground_angle_deg = Some(*value);
            }
        }
    }
    Ok(fixed)
}

/// Reads a stock from a text file: its lengths, one a line or separated by commas.
///
/// # Errors
/// A diagnostic about the file: it cannot be read, is too large, or holds something that is no length.
pub fn pitches(path: &Path) -> Result<Stock, Box<Diagnostic>> {
    let refused = |why: String| Box::new(Diagnostic::new(path.display().to_string(), "", why));
    if std::fs::metadata(path).is_ok_and(|found| found.len() > MAX_PITCHES) {
        return Err(refused("a list of lengths of more than 1 MB is refused".to_owned()));
    }
    Stock::parse(&input_text::read(path)?).map_err(|why| refused(why.to_string()))
}
