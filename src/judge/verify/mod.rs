//! Verification of a record: every figure and verdict is recomputed from its problem and its linkages.
//!
//! | module | holds |
//! |---|---|
//! | [`certificate`] | verification of a recorded certificate: the statements that follow from its bounds, and the bounds recomputed box by box |
//! | [`comparison`] | comparison of recorded values with recomputed ones |
//! | [`coverage`] | coverage of the verification of a record: each key is recomputed, held to limits, or not checked |
//! | [`exact`] | verification of exact linkages: the census adds up, and each linkage passes the points, has the stated abilities, and is proved again |
//! | [`extras`] | verification of the other parts of a record: warnings, alternatives, the family, the buildable candidate |
//! | [`front`] | verification of a front: every figure of its members, that none dominates another, and its knees |
//! | [`picks`] | verification of the picks: each has an error that is allowed, and is no worse in its wish than the candidates |
//! | [`searched`] | verification of a record's statements about its search |
//! | [`mod@verdict`] | verdicts on requirements, compared exactly except for those whose figure lies within rounding of the limit |

use crate::judge::assess::to_raw;
use crate::judge::costs::{marginal, weighted_rms};
use crate::judge::error::{StructuralError, structural_error};
use crate::judge::loosen::Demand;
use crate::judge::rank::{compare, exact_objective};
use crate::judge::two_sided::two_sided;
use crate::mechanism::CrankLinkage;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::record::digest::{ProblemError, digest};
use crate::record::{AngleErrorRecord, Candidate, Cost, CurveErrorRecord, FORMAT, MET_TOLERANCE, Record};
use crate::task::Problem;
use crate::task::spec::Objective;
use crate::task::{AngleOffset, Timing};

mod certificate;
mod comparison;
mod coverage;
mod exact;
mod extras;
mod front;
mod picks;
mod searched;
mod verdict;

pub use certificate::verify_certificate;
use comparison::Comparison;
pub use comparison::{ABSOLUTE, RELATIVE};
pub use coverage::{Checked, UNCHECKED, unchecked};
use verdict::{is_doubtful, scale};

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
    let mut whole = Comparison::new(&problem, &mut mismatches);
    whole.same("format", record.format, FORMAT);
    whole.same("problem.digest", &record.problem.digest, &digest(spec)?);
    whole.same("seed", record.seed, spec.solve.seed);
    whole.same("tool.name", record.tool.name.as_str(), env!("CARGO_PKG_NAME"));
    whole.same("method.asked", record.method.asked.name(), spec.solve.method.name());
    for (i, candidate) in record.candidates.iter().enumerate() {
        whole.same("rank", candidate.rank, i + 1);
    }
    for pair in record.candidates.windows(2) {
        if compare(&problem, &pair[0], &pair[1]).is_gt() {
            let [first, second] = [pair[0].rank, pair[1].rank];
            let names = |a: usize, b: usize| format!("{a} before {b}");
            whole.same("the order of ranks", names(first, second), names(second, first));
        }
    }
    whole.search(record);
    whole.explanation(record);
    whole.digitised();
    for candidate in &record.candidates {
        whole.of_candidate(candidate.rank).candidate(candidate);
    }
    whole.extras(record);
    whole.picks(record);
    whole.front(record);
    whole.exact(record);
    whole.certificate(record);
    Ok(mismatches)
}

/// Recomputes the figures and verdicts of one candidate of a problem; an empty list if they are true.
pub fn verify_candidate(problem: &Problem, candidate: &Candidate) -> Vec<Mismatch> {
    let mut mismatches = Vec::new();
    Comparison::new(problem, &mut mismatches).of_candidate(candidate.rank).candidate(candidate);
    mismatches
}

impl Comparison<'_> {
    /// Checks that the target's points are the raw points after smoothing and resampling.
    fn digitised(&mut self) {
        const POINTS: &str = "problem.resolved.task.path.points";
        let path = &self.problem.spec().task;
        let Some(raw) = &path.raw else { return };
        let found = raw.target(path.closed);
        let count = |points: &[[f64; 2]]| format!("{} points", points.len());
        if found.len() != path.points.len() {
            return self.differ(POINTS, count(&path.points), count(&found));
        }
        let size = self.problem.task().size();
        let reach = path.points.iter().flatten().fold(size, |reach, v| reach.max(v.abs()));
        let apart = |(p, q): (&[f64; 2], &[f64; 2])| (p[0] - q[0]).hypot(p[1] - q[1]);
        let worst = path.points.iter().zip(&found).map(apart).fold(0.0, f64::max);
        if worst > RELATIVE * reach {
            let found = format!("up to {worst:e} away from them");
            self.differ(POINTS, "the raw points, smoothed and resampled", found);
        }
    }

    /// Checks that a conflict and its relaxations are recorded only if no candidate is acceptable, and that they
    /// describe the problem as it is. (Whether each relaxation helps takes a search of its own: run the problem with
    /// it.)
    fn explanation(&mut self, record: &Record) {
        let explains = record.conflict.is_some() || !record.relaxations.is_empty();
        if explains && record.candidates.iter().any(|c| c.accepted) {
            self.differ("conflict", "something that conflicts", "nothing: there is an accepted candidate");
        }
        let problem = self.problem;
        let of =
            |key: &str| Demand::of(problem).into_iter().find(|demand| demand.key_in(problem.spec()) == key);
        if let Some(conflict) = &record.conflict {
            for (i, key) in conflict.among.iter().enumerate() {
                if of(key).is_none() {
                    self.differ("conflict.among", key, "no demand of the problem");
                } else if conflict.among[..i].contains(key) {
                    self.differ("conflict.among", format!("{key} twice"), "each demand once");
                }
            }
            if conflict.among.is_empty() {
                self.differ("conflict.among", "nothing", "one demand at least");
            }
        }
        for relaxation in &record.relaxations {
            let found = (relaxation.sum_sq / problem.task().len() as f64).sqrt();
            if (relaxation.rms - found).abs() > RELATIVE * found {
                self.differ("relaxations.rms", format!("{:e}", relaxation.rms), format!("{found:e}"));
            }
            if relaxation.set.is_empty() {
                self.differ("relaxations.set", "nothing", "one change at least");
            }
            for change in &relaxation.set {
                let mut set = self.under(&format!("relaxations.{}.", change.key));
                let demand = of(&change.key);
                let from = demand.and_then(|demand| demand.typed(problem.spec()));
                if from.as_ref() != Some(&change.from) {
                    let found = from.map_or("no demand of the problem".into(), |from| from.to_string());
                    set.differ("from", &change.from, found);
                } else if demand.is_some_and(|demand| !demand.is_no_tighter(problem.spec(), &change.to)) {
                    let found = format!("not a value that leaves more room than {}", change.from);
                    set.differ("to", &change.to, found);
                }
            }
        }
    }

    /// Checks every figure and verdict of a candidate; returns whether it could be judged.
    fn candidate(&mut self, recorded: &Candidate) -> bool {
        let at = (&recorded.linkage, recorded.crank_deg.as_slice(), recorded.t1_at.as_slice());
        let Some(found) =
            self.judged(at, recorded.own_reference(&self.problem.spec().task), "open at one of them")
        else {
            return false;
        };
        self.alike("t1_at", &recorded.t1_at, &found.t1_at);
        let word = |there: bool| if there { "there" } else { "absent" };
        self.same("frame_deg", word(recorded.frame_deg.is_some()), word(found.frame_deg.is_some()));
        self.offsets(recorded, &found);
        self.errors(recorded, &found);
        self.number(
            "grashof_margin",
            recorded.grashof_margin,
            found.grashof_margin,
            self.problem.task().size(),
        );
        self.number("link_ratio", recorded.link_ratio, found.link_ratio, 1.0);
        self.peak_torque(recorded.peak_torque, found.peak_torque);
        let (r, f) = (&recorded.transmission_deg, &found.transmission_deg);
        self.transmission("transmission_deg.min", r.min, f.min);
        self.transmission("transmission_deg.max", r.max, f.max);
        self.transmission("transmission_deg.worst", r.worst, f.worst);
        self.alike("transmission_deg.over", &r.over, &f.over);
        self.same("type", recorded.type_name(), found.type_name());
        let defects = |c: &Candidate| {
            let list: Vec<String> =
                c.defects.iter().map(|d| format!("{} at {:?}", d.name(), d.at())).collect();
            if list.is_empty() { "none".to_string() } else { list.join(", ") }
        };
        self.same("defects", defects(recorded), defects(&found));
        self.assembly(&recorded.linkage, &recorded.t1_at);
        self.costs(recorded, &found);
        let [scale, _] = recorded.scales(&self.problem.spec().task);
        self.timing(&recorded.linkage, &recorded.crank_deg, scale);
        self.requirements(recorded, &found);
        true
    }

    /// Compares torques of largest size, each if there is one.
    fn peak_torque(&mut self, recorded: Option<f64>, found: Option<f64>) {
        match (recorded, found) {
            (Some(recorded), Some(found)) => self.number("peak_torque_N_m", recorded, found, found.abs()),
            (recorded, found) => {
                let word = |torque: Option<f64>| if torque.is_some() { "there" } else { "absent" };
                self.same("peak_torque_N_m", word(recorded), word(found));
            }
        }
    }

    /// Compares the offsets and the sense of a function.
    fn offsets(&mut self, recorded: &Candidate, found: &Candidate) {
        let offsets = [
            ("input_offset_deg", recorded.input_offset_deg, found.input_offset_deg),
            ("output_offset_deg", recorded.output_offset_deg, found.output_offset_deg),
        ];
        let ranges = [
            ("input_range_deg", recorded.input_range_deg, found.input_range_deg),
            ("output_range_deg", recorded.output_range_deg, found.output_range_deg),
        ];
        match (recorded.output_offset, found.output_offset) {
            (Some(one), Some(other)) => {
                self.number("output_offset", one, other, self.problem.task().error_size());
            }
            (one, other) => {
                let word = |there: bool| if there { "there" } else { "absent" };
                self.same("output_offset", word(one.is_some()), word(other.is_some()));
            }
        }
        for (name, recorded, found) in offsets {
            match (recorded, found) {
                (Some(recorded), Some(found)) => {
                    // Half a turn is the same either way.
                    let turns = ((recorded - found) / 360.0).round();
                    self.number(name, recorded, found + 360.0 * turns, 360.0);
                }
                (recorded, found) => {
                    let word = |there: bool| if there { "there" } else { "absent" };
                    self.same(name, word(recorded.is_some()), word(found.is_some()));
                }
            }
        }
        self.ranges(ranges);
        self.alike("sense", &recorded.sense, &found.sense);
    }

    /// Compares the free ranges of a function, and checks that each lies within its bounds.
    fn ranges(&mut self, ranges: [(&str, Option<f64>, Option<f64>); 2]) {
        let bounds =
            self.problem.spec().task.output.as_ref().map_or([None; 2], |output| output.ranges.bounds_deg());
        for ((name, recorded, found), bounds) in ranges.into_iter().zip(bounds) {
            match (recorded, found, bounds) {
                (Some(recorded), Some(found), Some([low, high])) => {
                    self.number(name, recorded, found, 360.0);
                    let slack = MET_TOLERANCE * high;
                    if !(low - slack..=high + slack).contains(&recorded) {
                        self.differ(name, recorded, format!("from {low} to {high}"));
                    }
                }
                (recorded, found, _) => {
                    let word = |there: bool| if there { "there" } else { "absent" };
                    self.same(name, word(recorded.is_some()), word(found.is_some()));
                }
            }
        }
    }

    fn errors(&mut self, recorded: &Candidate, found: &Candidate) {
        let problem = self.problem;
        let (n, size) = (problem.task().len(), problem.task().error_size());
        let (r, f) = (&recorded.error, &found.error);
        match problem.spec().solve.objective {
            Objective::SumOfSquares => self.sum_sq("error.objective", r.objective, f.objective, n),
            Objective::MaxDeviation => {
                let scale = exact_objective(problem) / ABSOLUTE;
                self.number("error.objective", r.objective, f.objective, scale);
            }
        }
        self.sum_sq("error.sum_sq", r.sum_sq, f.sum_sq, n);
        self.number("error.rms", r.rms, f.rms, size);
        self.number("error.max", r.max, f.max, size);
        self.number("error.rms_over_size", r.rms_over_size, f.rms_over_size, 1.0);
        self.angles("error.angle", (r.angle.as_ref(), f.angle.as_ref()), recorded);
        self.angles("error.output", (r.output.as_ref(), f.output.as_ref()), recorded);
        self.under("error.to_curve.").curve(&r.to_curve, &f.to_curve, n);
        // Records of earlier versions do not have it.
        if let Some(r) = &r.two_sided {
            match two_sided(problem, recorded) {
                Some(f) => {
                    let mut part = self.under("error.two_sided.");
                    part.number("mean", r.mean, f.mean, size);
                    part.number("mean_over_radius", r.mean_over_radius, f.mean_over_radius, 1.0);
                    part.number("worst", r.worst, f.worst, size);
                }
                None => self.same("error.two_sided", "there", "absent"),
            }
        }
        match (&r.to_raw, to_raw(problem, recorded)) {
            (Some(r), Some(f)) => {
                let raw = problem.spec().task.raw.as_ref().map_or(0, |raw| raw.points.len());
                self.under("error.to_raw.").curve(r, &f, raw);
            }
            (r, f) => {
                let word = |there: bool| if there { "there" } else { "absent" };
                self.same("error.to_raw", word(r.is_some()), word(f.is_some()));
            }
        }
        if r.max_at != f.max_at {
            // The largest error may be at another point with an equal error.
            let there = |e: StructuralError| match problem.is_function() {
                false => e.structural.get(r.max_at).map(|s| s.norm()),
                true => Some((*e.angle?.structural.get(r.max_at)?)?.abs().to_degrees()),
            };
            let equal = structural_error(problem, recorded)
                .and_then(there)
                .is_some_and(|there| f.max - there <= RELATIVE * f.max + ABSOLUTE * size);
            if !equal {
                self.differ("error.max_at", r.max_at, f.max_at);
            }
        }
    }

    /// Compares the errors of the body's or the follower's angle, degrees.
    fn angles(
        &mut self,
        name: &str,
        (recorded, found): (Option<&AngleErrorRecord>, Option<&AngleErrorRecord>),
        candidate: &Candidate,
    ) {
        let (Some(r), Some(f)) = (recorded, found) else {
            let word = |there: bool| if there { "there" } else { "absent" };
            return self.same(name, word(recorded.is_some()), word(found.is_some()));
        };
        self.number(&format!("{name}.rms_deg"), r.rms_deg, f.rms_deg, 360.0);
        self.number(&format!("{name}.max_deg"), r.max_deg, f.max_deg, 360.0);
        if r.max_at != f.max_at {
            // The largest error may be at another pose with an equal error.
            let there = structural_error(self.problem, candidate)
                .and_then(|error| Some((*error.angle?.structural.get(r.max_at)?)?.abs().to_degrees()));
            if !there.is_some_and(|there| f.max_deg - there <= RELATIVE * f.max_deg + ABSOLUTE * 360.0) {
                self.differ(&format!("{name}.max_at"), r.max_at, f.max_at);
            }
        }
    }

    fn curve(&mut self, r: &CurveErrorRecord, f: &CurveErrorRecord, n: usize) {
        let size = self.problem.task().size();
        self.sum_sq("sum_sq", r.sum_sq, f.sum_sq, n);
        self.number("rms", r.rms, f.rms, size);
        self.number("max", r.max, f.max, size);
    }

    fn requirements(&mut self, recorded: &Candidate, found: &Candidate) {
        let size = self.problem.task().size();
        let names = |c: &Candidate| c.requirements.iter().map(|r| r.name.clone()).collect::<Vec<_>>();
        if names(recorded) != names(found) {
            return self.differ(
                "the list of requirements",
                names(recorded).join(", "),
                names(found).join(", "),
            );
        }
        for (r, f) in recorded.requirements.iter().zip(&found.requirements) {
            let mut row = self.under(&r.name);
            row.same(".limit", &r.limit, &f.limit);
            let same_kind = std::mem::discriminant(&r.value) == std::mem::discriminant(&f.value);
            let (r_values, f_values) = (r.value.numbers(), f.value.numbers());
            if same_kind && !f_values.is_empty() && r_values.len() == f_values.len() {
                for (r_value, f_value) in r_values.iter().zip(f_values) {
                    row.number(".value", *r_value, *f_value, scale(f, size));
                }
            } else {
                row.same(".value", &r.value, &f.value);
            }
            if r.met != f.met && !is_doubtful(f, size) {
                let word = |met| if met { "met" } else { "not met" };
                row.differ("", word(r.met), word(f.met));
            }
        }
        // If a verdict depends on rounding, the record has to agree with itself.
        let not_met = |name: &str| recorded.requirements.iter().any(|r| r.name == name && !r.met);
        let (_, accepted) = verdict::verdict(self.problem, found, &not_met);
        self.same("accepted", recorded.accepted, accepted);
    }

    /// Checks that the rates are those of the recorded linkage, and that the error without a requirement is below the
    /// error with it.
    fn costs(&mut self, recorded: &Candidate, found: &Candidate) {
        // If a verdict depends on rounding, the recorded one decides whether there are costs to compute.
        let priced = Candidate { accepted: recorded.accepted, ..found.clone() };
        let costs = marginal(self.problem, &priced);
        let names = |costs: &[Cost]| {
            let name = |c: &Cost| format!("{} {}", c.name, c.side.as_deref().unwrap_or_default());
            costs.iter().map(|c| name(c).trim().to_owned()).collect::<Vec<_>>().join(", ")
        };
        if names(&recorded.costs) != names(&costs) {
            return self.differ("the list of costs", names(&recorded.costs), names(&costs));
        }
        let rms = weighted_rms(self.problem, found.error.objective);
        for (r, f) in recorded.costs.iter().zip(&costs) {
            let mut cost = self.under(&format!("costs.{}.", r.name));
            cost.same("limit", r.limit, f.limit);
            let unit = |cost: &Cost| format!("{:?}", cost.unit_of_limit).to_lowercase();
            cost.same("unit_of_limit", unit(r), unit(f));
            let near = match (r.rms_per_unit, f.rms_per_unit) {
                (Some(r), Some(f)) => (r - f).abs() <= RATE * f.abs(),
                (r, f) => r == f,
            };
            if !near {
                let word = |rate: Option<f64>| rate.map_or("absent".into(), |rate| format!("{rate:e}"));
                cost.differ("rms_per_unit", word(r.rms_per_unit), word(f.rms_per_unit));
            }
            if let Some(least) = r.rms_without.filter(|least| !(0.0..=rms * (1.0 + RATE)).contains(least)) {
                let most = format!("at most {rms:e}, the error with it");
                cost.differ("rms_without", format!("{least:e}"), most);
            }
        }
    }

    /// Checks that the crank angles are the prescribed ones, in whichever direction the timing lets them run.
    fn timing(&mut self, linkage: &CrankLinkage, crank_deg: &[f64], scale: f64) {
        let Timing::Prescribed { offset, .. } = self.problem.task().timing() else { return };
        let Some(written) = &self.problem.spec().task.timing else { return };
        let task = self.problem.task();
        let timed = || {
            let all = crank_deg.iter().zip(&written.crank_deg).enumerate();
            all.filter_map(|(j, pair)| (!task.is_untimed(j)).then_some(pair))
        };
        let Some((first, written_first)) = timed().next() else { return };
        let off = |direction: f64| {
            let off = timed().map(|(has, wants)| ((has - first) - direction * (wants - written_first)).abs());
            off.fold(0.0, f64::max)
        };
        let off_base = |ground: f64| {
            off(scale)
                .max(wrapped((first - (scale * written_first + ground)).to_radians()).to_degrees().abs())
        };
        let worst = match offset {
            AngleOffset::Free if task.is_function() => off(scale),
            AngleOffset::Free => off(1.0).min(off(-1.0)),
            AngleOffset::Fixed => off_base(0.0),
            AngleOffset::Ground => off_base(linkage.ground_angle().to_degrees()),
        };
        let slack = TIMING_DEG * (1.0 + first.abs() + written_first.abs());
        if worst > slack {
            self.differ("crank_deg", "the prescribed angles", format!("off by {worst:e} degrees"));
        }
    }
}
