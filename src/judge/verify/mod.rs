//! Verification of a record: every figure and verdict is recomputed from its problem and its linkages.
//!
//! | module | holds |
//! |---|---|
//! | [`certificate`] | verification of a recorded certificate: the statements that follow from its bounds, and the bounds recomputed box by box |
//! | [`coverage`] | coverage of the verification of a record: each key is recomputed, held to limits, or not checked |
//! | [`exact`] | verification of exact linkages: the census adds up, and each linkage passes the points, has the stated abilities, and is proved again |
//! | [`extras`] | verification of the other parts of a record: warnings, alternatives, the family, the buildable candidate |
//! | [`searched`] | verification of a record's statements about its search |
//! | [`mod@verdict`] | verdicts on requirements, compared exactly except for those whose figure lies within rounding of the limit |

use crate::judge::assess::{assess, to_raw};
use crate::judge::costs::{marginal, weighted_rms};
use crate::judge::loosen::Demand;
use crate::judge::rank::{compare, exact_objective};
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{AssemblyMode, FourBar};
use crate::record::digest::{ProblemError, digest};
use crate::record::{Candidate, Cost, FORMAT, Figure, Record};
use crate::task::Problem;
use crate::task::spec::Objective;
use crate::task::{AngleOffset, Timing};

mod certificate;
mod coverage;
mod exact;
mod extras;
mod searched;
mod verdict;

pub use certificate::verify_certificate;
pub use coverage::{Checked, UNCHECKED, checked, unchecked};
use verdict::{is_doubtful, scale, verdict};

/// The relative part of the tolerance of figures ..
pub const RELATIVE: f64 = 1e-9;
/// .. and its absolute part, as a share of the target's size (for sums of squares, of its square).
pub const ABSOLUTE: f64 = 1e-12;
/// The tolerance of crank angles of prescribed timing, in degrees.
const TIMING_DEG: f64 = 1e-9;
/// The relative tolerance of the rates of costs: they are solutions of small systems of equations.
const RATE: f64 = 1e-6;

/// A mismatch: a value in a record that differs from the recomputed one.
#[derive(Clone, Debug, PartialEq)]
pub struct Mismatch {
    /// The candidate's rank; 0: the buildable candidate; `None`: the record as a whole.
    pub rank: Option<usize>,
    /// The name of the figure or verdict.
    pub what: String,
    /// The recorded value, in words.
    pub recorded: String,
    /// The recomputed value, in words.
    pub found: String,
}

impl std::fmt::Display for Mismatch {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.rank {
            None => {}
            Some(0) => write!(f, "buildable: ")?,
            Some(rank) => write!(f, "candidate {rank}: ")?,
        }
        write!(f, "{} is recorded as {}, but it is {}", self.what, self.recorded, self.found)
    }
}

/// Recomputes the record's figures and verdicts and returns the mismatches; an empty list if the record is true.
///
/// # Errors
/// [`ProblemError`] if the record's problem is not a valid problem.
pub fn verify(record: &Record) -> Result<Vec<Mismatch>, ProblemError> {
    let spec = &record.problem.resolved;
    let problem = Problem::new(spec.clone())?;
    let mut mismatches = Vec::new();
    let mut whole = |what: &str, recorded: String, found: String| {
        if recorded != found {
            mismatches.push(Mismatch { rank: None, what: what.into(), recorded, found });
        }
    };
    whole("format", record.format.to_string(), FORMAT.to_string());
    whole("problem.digest", record.problem.digest.clone(), digest(spec)?);
    whole("seed", record.seed.to_string(), spec.solve.seed.to_string());
    whole("tool.name", record.tool.name.clone(), env!("CARGO_PKG_NAME").to_string());
    whole("method.asked", record.method.asked.name().into(), spec.solve.method.name().into());
    for (i, candidate) in record.candidates.iter().enumerate() {
        whole("rank", candidate.rank.to_string(), (i + 1).to_string());
    }
    for pair in record.candidates.windows(2) {
        if compare(&problem, &pair[0], &pair[1]).is_gt() {
            let names = |a: usize, b: usize| format!("{a} before {b}");
            whole("the order of ranks", names(pair[0].rank, pair[1].rank), names(pair[1].rank, pair[0].rank));
        }
    }
    searched::searched(&problem, record, &mut whole);
    explanation(record, &problem, &mut whole);
    digitised(&problem, &mut whole);
    for candidate in &record.candidates {
        let mut against = Against { rank: candidate.rank, mismatches: &mut mismatches };
        against.candidate(&problem, candidate);
    }
    extras::extras(&problem, record, &mut mismatches);
    exact::exact(&problem, record, &mut mismatches);
    certificate::stated(record, &mut mismatches);
    Ok(mismatches)
}

/// Recomputes the figures and verdicts of one candidate of a problem; an empty list if they are true.
pub fn verify_candidate(problem: &Problem, candidate: &Candidate) -> Vec<Mismatch> {
    let mut mismatches = Vec::new();
    Against { rank: candidate.rank, mismatches: &mut mismatches }.candidate(problem, candidate);
    mismatches
}

/// Checks that the target's points are the raw points after smoothing and resampling.
fn digitised(problem: &Problem, differ: &mut dyn FnMut(&str, String, String)) {
    let path = &problem.spec().task.path;
    let Some(raw) = &path.raw else { return };
    let found = raw.target(path.closed);
    let count = |points: &[[f64; 2]]| format!("{} points", points.len());
    if found.len() != path.points.len() {
        return differ("problem.resolved.task.path.points", count(&path.points), count(&found));
    }
    let reach = path.points.iter().flatten().fold(problem.task().size(), |reach, v| reach.max(v.abs()));
    let apart = |(p, q): (&[f64; 2], &[f64; 2])| (p[0] - q[0]).hypot(p[1] - q[1]);
    let worst = path.points.iter().zip(&found).map(apart).fold(0.0, f64::max);
    if worst > RELATIVE * reach {
        let recorded = "the raw points, smoothed and resampled".into();
        differ("problem.resolved.task.path.points", recorded, format!("up to {worst:e} away from them"));
    }
}

/// Checks that a conflict and its relaxations are recorded only if no candidate is acceptable, and that they describe
/// the problem as it is. (Whether each relaxation helps takes a search of its own: run the problem with it.)
fn explanation(record: &Record, problem: &Problem, differ: &mut dyn FnMut(&str, String, String)) {
    let explains = record.conflict.is_some() || !record.relaxations.is_empty();
    if explains && record.candidates.iter().any(|c| c.accepted) {
        let recorded = "something that conflicts".into();
        differ("conflict", recorded, "nothing: there is an accepted candidate".into());
    }
    let of = |key: &str| Demand::of(problem).into_iter().find(|demand| demand.key() == key);
    if let Some(conflict) = &record.conflict {
        for (i, key) in conflict.among.iter().enumerate() {
            if of(key).is_none() {
                differ("conflict.among", key.clone(), "no demand of the problem".into());
            } else if conflict.among[..i].contains(key) {
                differ("conflict.among", format!("{key} twice"), "each demand once".into());
            }
        }
        if conflict.among.is_empty() {
            differ("conflict.among", "nothing".into(), "one demand at least".into());
        }
    }
    for relaxation in &record.relaxations {
        let found = (relaxation.sum_sq / problem.task().len() as f64).sqrt();
        if (relaxation.rms - found).abs() > RELATIVE * found {
            differ("relaxations.rms", format!("{:e}", relaxation.rms), format!("{found:e}"));
        }
        if relaxation.set.is_empty() {
            differ("relaxations.set", "nothing".into(), "one change at least".into());
        }
        for change in &relaxation.set {
            let from = of(&change.key).and_then(|demand| demand.typed(problem.spec()));
            if from.as_ref() != Some(&change.from) {
                let found = from.map_or("no demand of the problem".into(), |from| from.to_string());
                differ(&format!("relaxations.{}.from", change.key), change.from.to_string(), found);
            } else if let Some(demand) = of(&change.key)
                && !demand.is_no_tighter(problem.spec(), &change.to)
            {
                let found = format!("not a value that leaves more room than {}", change.from);
                differ(&format!("relaxations.{}.to", change.key), change.to.to_string(), found);
            }
        }
    }
}

struct Against<'a> {
    rank: usize,
    mismatches: &'a mut Vec<Mismatch>,
}

impl Against<'_> {
    fn differ(&mut self, what: &str, recorded: String, found: String) {
        self.mismatches.push(Mismatch { rank: Some(self.rank), what: what.into(), recorded, found });
    }

    fn number(&mut self, what: &str, recorded: f64, found: f64, scale: f64) {
        let near = (recorded - found).abs() <= RELATIVE * found.abs() + ABSOLUTE * scale;
        if !(near || recorded == found) {
            self.differ(what, format!("{recorded:e}"), format!("{found:e}"));
        }
    }

    fn candidate(&mut self, problem: &Problem, recorded: &Candidate) {
        let n = problem.task().len();
        if recorded.crank_deg.len() != n || recorded.t1_at.len() != n {
            let has = format!("{} and {}", recorded.crank_deg.len(), recorded.t1_at.len());
            self.differ("the number of crank_deg and t1_at", has, format!("{n} points"));
            return;
        }
        let found = assess(problem, &recorded.linkage, &recorded.crank_deg, &recorded.t1_at);
        let Some(found) = found else {
            self.differ("the linkage", "closed at every point".into(), "open at one of them".into());
            return;
        };
        let size = problem.task().size();
        // A sum of squares of errors near e changes by 2 e times the change of e.
        let sq = |sum: f64| size * size * ABSOLUTE + 2.0 * size * sum.sqrt() * (n as f64).sqrt();
        let raws = problem.spec().task.path.raw.as_ref().map_or(0, |raw| raw.points.len());
        let raw_sq = |sum: f64| size * size * ABSOLUTE + 2.0 * size * sum.sqrt() * (raws as f64).sqrt();
        let (r, f) = (&recorded.error, &found.error);
        let objective_scale = match problem.spec().solve.objective {
            Objective::SumOfSquares => sq(f.objective),
            Objective::MaxDeviation => exact_objective(problem) / ABSOLUTE,
        };
        self.number("error.objective", r.objective, f.objective, objective_scale);
        self.number("error.sum_sq", r.sum_sq, f.sum_sq, sq(f.sum_sq));
        self.number("error.rms", r.rms, f.rms, size);
        self.number("error.max", r.max, f.max, size);
        self.number("error.rms_over_size", r.rms_over_size, f.rms_over_size, 1.0);
        self.number("error.to_curve.sum_sq", r.to_curve.sum_sq, f.to_curve.sum_sq, sq(f.to_curve.sum_sq));
        self.number("error.to_curve.rms", r.to_curve.rms, f.to_curve.rms, size);
        self.number("error.to_curve.max", r.to_curve.max, f.to_curve.max, size);
        match (&r.to_raw, to_raw(problem, recorded)) {
            (Some(r), Some(f)) => {
                self.number("error.to_raw.sum_sq", r.sum_sq, f.sum_sq, raw_sq(f.sum_sq));
                self.number("error.to_raw.rms", r.rms, f.rms, size);
                self.number("error.to_raw.max", r.max, f.max, size);
            }
            (None, None) => {}
            (r, f) => {
                let word = |there: bool| if there { "there" } else { "absent" };
                self.differ("error.to_raw", word(r.is_some()).into(), word(f.is_some()).into());
            }
        }
        if r.max_at != f.max_at {
            // The largest error may be at another point with an equal error.
            let angles = (&recorded.crank_deg, &recorded.t1_at);
            let radians: Vec<f64> = angles.0.iter().map(|d| d.to_radians()).collect();
            let equal = problem
                .task()
                .errors(&recorded.linkage, &radians, angles.1)
                .and_then(|e| e.structural.get(r.max_at).map(|s| s.norm()))
                .is_some_and(|there| f.max - there <= RELATIVE * f.max + ABSOLUTE * size);
            if !equal {
                self.differ("error.max_at", r.max_at.to_string(), f.max_at.to_string());
            }
        }
        self.number("grashof_margin", recorded.grashof_margin, found.grashof_margin, size);
        self.number("link_ratio", recorded.link_ratio, found.link_ratio, 1.0);
        let (r, f) = (&recorded.transmission_deg, &found.transmission_deg);
        // Near 0 and 180 degrees an angle moves as the root of the lengths' rounding.
        for (what, r, f) in [
            ("transmission_deg.min", r.min, f.min),
            ("transmission_deg.max", r.max, f.max),
            ("transmission_deg.worst", r.worst, f.worst),
        ] {
            let from_flat = f.min(180.0 - f).max(1e-5).to_radians().sin();
            self.number(what, r, f, 180.0 / from_flat);
        }
        if r.over != f.over {
            self.differ("transmission_deg.over", format!("{:?}", r.over), format!("{:?}", f.over));
        }
        if recorded.linkage_type != found.linkage_type {
            self.differ("type", recorded.linkage_type.to_string(), found.linkage_type.to_string());
        }
        if recorded.defects != found.defects {
            let names = |c: &Candidate| {
                let list: Vec<String> =
                    c.defects.iter().map(|d| format!("{} at {:?}", d.name(), d.at())).collect();
                if list.is_empty() { "none".to_string() } else { list.join(", ") }
            };
            self.differ("defects", names(recorded), names(&found));
        }
        self.assembly("linkage.t1", &recorded.linkage, &recorded.t1_at);
        self.costs(problem, recorded, &found);
        self.timing(problem, recorded);
        self.requirements(problem, recorded, &found);
    }

    /// Checks that a linkage is recorded as it is assembled at the first point.
    fn assembly(&mut self, what: &str, linkage: &FourBar, t1_at: &[AssemblyMode]) {
        let sign = |t: AssemblyMode| format!("{:+}", t.sign());
        if let Some(&first) = t1_at.first().filter(|first| **first != linkage.assembly()) {
            self.differ(what, sign(linkage.assembly()), sign(first));
        }
    }

    fn requirements(&mut self, problem: &Problem, recorded: &Candidate, found: &Candidate) {
        let size = problem.task().size();
        let names = |c: &Candidate| c.requirements.iter().map(|r| r.name.clone()).collect::<Vec<_>>();
        if names(recorded) != names(found) {
            self.differ("the list of requirements", names(recorded).join(", "), names(found).join(", "));
            return;
        }
        for (r, f) in recorded.requirements.iter().zip(&found.requirements) {
            if r.limit != f.limit {
                self.differ(&format!("{}.limit", r.name), r.limit.to_string(), f.limit.to_string());
            }
            match (&r.value, &f.value) {
                (Figure::Number(r_value), Figure::Number(f_value)) => {
                    self.number(&format!("{}.value", r.name), *r_value, *f_value, scale(f, size));
                }
                (Figure::Numbers(r_values), Figure::Numbers(f_values))
                    if r_values.len() == f_values.len() =>
                {
                    for (r_value, f_value) in r_values.iter().zip(f_values) {
                        self.number(&format!("{}.value", r.name), *r_value, *f_value, scale(f, size));
                    }
                }
                (r_value, f_value) if r_value == f_value => {}
                (r_value, f_value) => {
                    self.differ(&format!("{}.value", r.name), r_value.to_string(), f_value.to_string());
                }
            }
            if r.met != f.met && !is_doubtful(f, size) {
                let word = |met| if met { "met" } else { "not met" };
                self.differ(&r.name, word(r.met).into(), word(f.met).into());
            }
        }
        // If a verdict depends on rounding, the record has to agree with itself.
        let not_met = |name: &str| recorded.requirements.iter().any(|r| r.name == name && !r.met);
        let (_, accepted) = verdict(problem, found, &not_met);
        if recorded.accepted != accepted {
            self.differ("accepted", recorded.accepted.to_string(), accepted.to_string());
        }
    }

    /// Checks that the rates are those of the recorded linkage, and that the error without a requirement is below the
    /// error with it.
    fn costs(&mut self, problem: &Problem, recorded: &Candidate, found: &Candidate) {
        // If a verdict depends on rounding, the recorded one decides whether there are costs to compute.
        let priced = Candidate { accepted: recorded.accepted, ..found.clone() };
        let costs = marginal(problem, &priced);
        let names = |costs: &[Cost]| {
            let name = |c: &Cost| format!("{} {}", c.name, c.side.as_deref().unwrap_or_default());
            costs.iter().map(|c| name(c).trim().to_owned()).collect::<Vec<_>>().join(", ")
        };
        if names(&recorded.costs) != names(&costs) {
            self.differ("the list of costs", names(&recorded.costs), names(&costs));
            return;
        }
        let rms = weighted_rms(problem, found.error.objective);
        for (r, f) in recorded.costs.iter().zip(&costs) {
            if r.limit != f.limit {
                self.differ(&format!("costs.{}.limit", r.name), r.limit.to_string(), f.limit.to_string());
            }
            if r.unit_of_limit != f.unit_of_limit {
                let words = [r, f].map(|cost| format!("{:?}", cost.unit_of_limit).to_lowercase());
                let [r_unit, f_unit] = words;
                self.differ(&format!("costs.{}.unit_of_limit", r.name), r_unit, f_unit);
            }
            let rates = (r.rms_per_unit, f.rms_per_unit);
            let near = match rates {
                (Some(r), Some(f)) => (r - f).abs() <= RATE * f.abs(),
                (r, f) => r == f,
            };
            if !near {
                let word = |rate: Option<f64>| rate.map_or("absent".into(), |rate| format!("{rate:e}"));
                self.differ(&format!("costs.{}.rms_per_unit", r.name), word(rates.0), word(rates.1));
            }
            if r.rms_without.is_some_and(|least| !(least >= 0.0 && least <= rms * (1.0 + RATE))) {
                let least = r.rms_without.unwrap_or_default();
                self.differ(
                    &format!("costs.{}.rms_without", r.name),
                    format!("{least:e}"),
                    format!("at most {rms:e}, the error with it"),
                );
            }
        }
    }

    /// Checks that the crank angles are the prescribed ones, in whichever direction the timing lets them run.
    fn timing(&mut self, problem: &Problem, recorded: &Candidate) {
        let Timing::Prescribed { offset, .. } = problem.task().timing() else { return };
        let Some(written) = &problem.spec().task.path.timing else { return };
        let Some((first, written_first)) = recorded.crank_deg.first().zip(written.crank_deg.first()) else {
            return;
        };
        let base = match offset {
            AngleOffset::Free => 0.0,
            AngleOffset::Fixed => *written_first,
            AngleOffset::Ground => written_first + recorded.linkage.ground_angle().to_degrees(),
        };
        let off = |direction: f64| {
            let worst = recorded
                .crank_deg
                .iter()
                .zip(&written.crank_deg)
                .map(|(has, wants)| ((has - first) - direction * (wants - written_first)).abs());
            worst.fold(0.0, f64::max)
        };
        let either = *offset == AngleOffset::Free;
        let mut worst = if either { off(1.0).min(off(-1.0)) } else { off(1.0) };
        if *offset != AngleOffset::Free {
            worst = worst.max(wrapped((first - base).to_radians()).to_degrees().abs());
        }
        let slack = TIMING_DEG * (1.0 + first.abs() + written_first.abs());
        if worst > slack {
            self.differ("crank_deg", "the prescribed angles".into(), format!("off by {worst:e} degrees"));
        }
    }
}
