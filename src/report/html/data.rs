//! The data of the player: the target and the mechanisms, each with its motion, as JSON.

use super::extras::{Shown, extras, first_key};
use super::motion::Drive;
use super::track::Track;
use crate::mechanism::{AssemblyMode, CrankLinkage, MAX_MAGNITUDE};
use crate::record::{Candidate, ProblemRecord, Record};
use serde::Serialize;

/// The largest number of target points on the page; of more, this many are evenly chosen, and the worst of each
/// candidate is added.
const MOST_POINTS: usize = 400;
/// The largest number of points, with those that they were digitised from, of a problem that is on the page.
const MOST_HELD: usize = 2000;
/// The largest number of alternatives of a candidate that can be played.
pub(super) const MOST_ALTERNATIVES: usize = 6;
/// The largest number of linkages through nine points that can be played.
pub(super) const MOST_EXACT: usize = 100;

/// The data that the player reads.
#[derive(Serialize)]
pub(super) struct Data<'a> {
    /// The unit of lengths, as a label.
    unit: Option<&'static str>,
    target: Target,
    /// The least transmission angle asked for, in degrees.
    transmission_deg_min: Option<f64>,
    /// The key of the mechanism shown first.
    first: String,
    mechanisms: Vec<Mechanism<'a>>,
    /// The problem, so that the studio can go on with it; absent if it has too many points.
    #[serde(skip_serializing_if = "Option::is_none")]
    problem: Option<&'a ProblemRecord>,
}

/// The target's points, or the chosen ones.
#[derive(Serialize)]
struct Target {
    points: Vec<[f64; 2]>,
    /// The numbers of the points in the problem; absent if all are here.
    #[serde(skip_serializing_if = "Option::is_none")]
    numbers: Option<Vec<usize>>,
    closed: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<Vec<f64>>,
    /// The word for one of them, if they are no points.
    #[serde(skip_serializing_if = "Option::is_none")]
    noun: Option<&'static str>,
    /// The angles of the body of a motion, in degrees; null where only the place counts.
    #[serde(skip_serializing_if = "Option::is_none")]
    angle_deg: Option<Vec<Option<f64>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance_deg: Option<Vec<f64>>,
}

/// A linkage that can be played.
#[derive(Serialize)]
struct Mechanism<'a> {
    /// The key: `c1`: candidate 1; `b`: the buildable one (or
    /// another of [`extras`]); `c1a2`: its second alternative; `x7`: the seventh exact
    /// linkage.
    key: String,
    /// The name for readers.
    name: String,
    linkage: &'a CrankLinkage,
    /// The motion of a linkage of several loops.
    #[serde(skip_serializing_if = "Option::is_none")]
    track: Option<Track>,
    drive: Drive,
    /// The angle from C -> D to the body's x axis, in degrees.
    #[serde(skip_serializing_if = "Option::is_none")]
    frame_deg: Option<f64>,
    /// The crank angle at each point, in degrees.
    crank_deg: Vec<f64>,
    /// The assembly at each point; absent if all are equal to that of the drive.
    #[serde(skip_serializing_if = "Option::is_none")]
    t1_at: Option<Vec<AssemblyMode>>,
    /// The number of the worst point.
    #[serde(skip_serializing_if = "Option::is_none")]
    worst: Option<usize>,
}

/// Returns the key of a candidate's mechanism; `index` counts from 0.
pub(super) fn candidate_key(index: usize) -> String {
    format!("c{}", index + 1)
}

impl<'a> Data<'a> {
    /// Returns the data of a record, of which `shown` is shown first.
    pub(super) fn new(record: &'a Record, shown: Shown) -> Self {
        let path = &record.problem.resolved.task;
        let chosen = chosen(record);
        let of_candidate = |key, name, c: &'a Candidate| {
            let passed = (&c.linkage, c.crank_deg.as_slice(), c.t1_at.as_slice());
            let mechanism = Mechanism::new(key, name, passed, Some(c.error.max_at), &chosen);
            Mechanism { frame_deg: c.frame_deg, ..mechanism }
        };
        let mut mechanisms = Vec::new();
        for (c, i) in record.candidates.iter().zip(1..) {
            mechanisms.push(of_candidate(format!("c{i}"), format!("candidate {i}"), c));
            for (a, j) in c.alternatives.iter().take(MOST_ALTERNATIVES).zip(1..) {
                let (key, name) = (format!("c{i}a{j}"), format!("cognate {j} of candidate {i}"));
                let passed = (&a.linkage, a.crank_deg.as_slice(), a.t1_at.as_slice());
                mechanisms.push(Mechanism::new(key, name, passed, Some(c.error.max_at), &chosen));
            }
        }
        for extra in extras(record, shown) {
            mechanisms.push(of_candidate(extra.key, format!("the {}", extra.name), extra.candidate));
        }
        for (x, i) in record.exact.iter().flat_map(|exact| &exact.linkages).take(MOST_EXACT).zip(1..) {
            let (key, name) = (format!("x{i}"), format!("exact linkage {i}"));
            mechanisms.push(Mechanism::new(key, name, (&x.linkage, &x.crank_deg, &x.t1_at), None, &chosen));
        }
        let pick =
            |values: &Vec<f64>| chosen.iter().map(|i| values.get(*i).copied().unwrap_or(0.0)).collect();
        let body = path.body.as_ref().filter(|_| !path.is_function());
        let held = path.points.len() + path.raw.as_ref().map_or(0, |raw| raw.points.len());
        Data {
            unit: record.problem.unit.map(crate::mechanism::Unit::label),
            target: Target {
                points: chosen.iter().map(|i| path.points[*i]).collect(),
                numbers: (chosen.len() < path.points.len()).then(|| chosen.clone()),
                closed: path.closed,
                tolerance: path.tolerance.as_ref().map(pick),
                noun: path.body.as_ref().map(|_| path.noun()),
                angle_deg: body
                    .map(|body| chosen.iter().map(|i| body.angle_deg.get(*i).copied().flatten()).collect()),
                tolerance_deg: body.and_then(|body| body.tolerance_deg.as_ref()).map(pick),
            },
            transmission_deg_min: record.problem.resolved.require.transmission_deg_min,
            first: first_key(record, shown),
            mechanisms,
            problem: Some(&record.problem).filter(|_| held <= MOST_HELD),
        }
    }
}

impl<'a> Mechanism<'a> {
    fn new(
        key: String,
        name: String,
        (linkage, crank_deg, t1_at): (&'a CrankLinkage, &[f64], &[AssemblyMode]),
        worst: Option<usize>,
        chosen: &[usize],
    ) -> Self {
        let drive = Drive::new(linkage, crank_deg, t1_at);
        // Lists may be shorter than the target in a record from elsewhere: the existing entries are shown.
        let there: Vec<usize> =
            chosen.iter().copied().take_while(|i| *i < crank_deg.len() && *i < t1_at.len()).collect();
        let t1: Vec<AssemblyMode> = there.iter().map(|i| t1_at[*i]).collect();
        let same = t1.iter().all(|t1| i64::from(*t1) == drive.t1);
        Mechanism {
            key,
            name,
            linkage,
            track: linkage.multi_loop().map(Track::of),
            drive,
            frame_deg: None,
            crank_deg: there.iter().map(|i| crank_deg[*i]).collect(),
            t1_at: (!same).then_some(t1),
            worst,
        }
    }
}

/// Returns the numbers of the points that the page contains.
fn chosen(record: &Record) -> Vec<usize> {
    let points = &record.problem.resolved.task.points;
    let usable = |i: &usize| points[*i].iter().all(|x| x.abs() <= MAX_MAGNITUDE);
    let n = points.len();
    if n <= MOST_POINTS {
        return (0..n).filter(usable).collect();
    }
    let worst = record.candidates.iter().map(|c| c.error.max_at).filter(|i| *i < n);
    let mut chosen: Vec<usize> =
        (0..MOST_POINTS).map(|i| i * n / MOST_POINTS).chain(worst).chain([n - 1]).collect();
    chosen.sort_unstable();
    chosen.dedup();
    chosen.into_iter().filter(usable).collect()
}

/// Returns the number of points on the page and of all points, if these differ.
pub(super) fn thinned(record: &Record) -> Option<(usize, usize)> {
    let all = record.problem.resolved.task.points.len();
    (all > MOST_POINTS).then(|| (chosen(record).len(), all))
}
