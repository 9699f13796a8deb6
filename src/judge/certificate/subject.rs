//! The subject of a certificate: the points, the crank's increments, the cap and the best sum of a record; and the
//! statement of a certificate once each part is bounded.

use super::axis::axis_of;
use crate::mechanism::LinkageType;
use crate::numbers::bound::target::{MAX_POINTS, TargetError};
use crate::numbers::leaves::{Angles, Leaves, OPEN, ROOT, root};
use crate::numbers::leaves::{Axis, Cell, Class, Line};
use crate::record::digest::hex;
use crate::record::{Certificate, CertificatePart, Record};
use crate::task::AngleOffset;
use crate::task::spec::{Limits, Objective, OnePolicy};
use sha2::{Digest, Sha256};

/// The factor of the wanted gap: a little less is searched for, so that the gap from the rounded bound is not above
/// it.
const WITHIN: f64 = 1.0 - 1e-9;

/// The reason for which a result has no certificate.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoCertificate {
    /// The result has no candidate to compare with.
    #[error("the result has no candidate")]
    NoCandidate,
    /// The best linkage has several loops.
    #[error("no certificate is available for the first candidate, a {kind}: the proof covers four-bars")]
    SeveralLoops {
        /// Its kind.
        kind: &'static str,
    },
    /// The timing is free: each point is met at the nearest crank angle.
    #[error("no certificate is available for free timing: give the points crank angles (task.path.timing)")]
    FreeTiming,
    /// The task is a motion: a body's angles count beside its places.
    #[error(
        "no certificate is available for poses of a body: the proof covers the places of a path alone, without angles"
    )]
    Motion,
    /// The objective is not the plain sum of squares.
    #[error("no certificate is available yet for weighted points or for objective = \"max-deviation\"")]
    OtherObjective,
    /// A linkage may be taken apart between two points.
    #[error(
        "no certificate is available where points may lie on different circuits: it needs require.circuit = \"one\""
    )]
    AnyCircuit,
    /// The recorded problem is not valid.
    #[error("the recorded problem is none: {0}")]
    Problem(String),
    /// The best candidate meets the points exactly.
    #[error("the best candidate meets the points exactly: nothing can be below it")]
    Exact,
    /// The gap is not between 0 and 1.
    #[error("the gap is {gap}; it lies between 0 and 1, such as 1e-4")]
    Gap {
        /// The gap that was given.
        gap: f64,
    },
    /// The coupler point has no limits.
    #[error("the coupler point has no limits: give design.coupler_x and coupler_y, or design.d")]
    NoLimits,
    /// The figures are too few or too much alike.
    #[error(transparent)]
    Target(#[from] TargetError),
}

/// The figures of a record that its certificate rests on.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    /// The points.
    pub points: Vec<[f64; 2]>,
    /// The crank's increments, degrees; its angles if these are from the ground line or the x axis.
    pub turns_deg: Vec<f64>,
    /// The reference direction of the crank angles.
    pub angles: Angles,
    /// The classes of linkages covered.
    pub classes: Vec<Class>,
    /// The directions of the crank: 1, -1.
    pub directions: Vec<f64>,
    /// The problem's own limit of |Z|, the distance of the coupler point from the crank pin.
    pub limit: f64,
    /// The cap R, a little above the limit: no linkage with a larger |Z| is covered.
    pub cap: f64,
    /// The sum of squares of the best candidate.
    pub best: f64,
    /// The wanted gap.
    pub gap: f64,
}

impl Subject {
    /// Reads the subject of a record.
    ///
    /// # Errors
    /// [`NoCertificate`].
    pub fn new(record: &Record, gap: f64) -> Result<Self, NoCertificate> {
        if !(gap > 0.0 && gap < 1.0) {
            return Err(NoCertificate::Gap { gap });
        }
        let spec = &record.problem.resolved;
        let first = record.candidates.first().ok_or(NoCertificate::NoCandidate)?;
        if first.linkage.multi_loop().is_some() {
            return Err(NoCertificate::SeveralLoops { kind: first.linkage.kind().name() });
        }
        let best = first.error.sum_sq;
        let path = &spec.task;
        if path.body.is_some() {
            return Err(NoCertificate::Motion);
        }
        let timing = path.timing.as_ref().filter(|timing| timing.free.is_empty());
        let timing = timing.ok_or(NoCertificate::FreeTiming)?;
        let problem =
            crate::task::Problem::new(spec.clone()).map_err(|e| NoCertificate::Problem(e.to_string()))?;
        let task = problem.task();
        if !(5..=MAX_POINTS).contains(&task.len()) {
            return Err(TargetError::Points { points: task.len() }.into());
        }
        let first = task.weights().first().copied().unwrap_or(1.0);
        let weighted = task.weights().iter().any(|w| *w != first);
        if weighted || spec.solve.objective != Objective::SumOfSquares {
            return Err(NoCertificate::OtherObjective);
        }
        if spec.require.circuit != OnePolicy::One {
            return Err(NoCertificate::AnyCircuit);
        }
        if best.is_nan() || best <= 0.0 {
            return Err(NoCertificate::Exact);
        }
        let design = &spec.design;
        let largest = |limits: Limits| limits.0.abs().max(limits.1.abs());
        let by_box = design.coupler_x.zip(design.coupler_y).map(|(x, y)| largest(x).hypot(largest(y)));
        let by_length = design.d.map(largest);
        let limits = [by_box, by_length].into_iter().flatten();
        let limit = limits.reduce(f64::min).ok_or(NoCertificate::NoLimits)?;
        let (angles, classes) = match timing.offset {
            AngleOffset::Free => (Angles::Increments, Class::ALL.to_vec()),
            AngleOffset::Ground => (Angles::Ground, Class::ALL.to_vec()),
            AngleOffset::Fixed => (Angles::Axis(axis_of(design)), classes(&spec.require.types)),
        };
        Ok(Subject {
            points: task.points().iter().map(|p| [p.re, p.im]).collect(),
            turns_deg: timing.crank_deg.clone(),
            angles,
            classes,
            directions: problem.directions().to_vec(),
            limit,
            cap: limit * (1.0 + 1e-9),
            best,
            gap,
        })
    }

    /// Returns the bound that closes the gap.
    pub fn wanted(&self) -> f64 {
        self.best * (1.0 - self.gap * WITHIN)
    }

    /// Returns the parts of the proof: each class in each direction, in the order of the record.
    pub fn parts(&self) -> Vec<(Class, f64)> {
        self.classes.iter().flat_map(|class| self.directions.iter().map(|way| (*class, *way))).collect()
    }

    /// Returns the gap of a bound below the best sum, relative to that sum.
    pub fn gap_of(&self, lower_bound: f64) -> f64 {
        (1.0 - lower_bound / self.best).max(0.0)
    }

    /// Returns the SHA-256 of all figures: two subjects with one digest have the same searches.
    pub fn sha256(&self) -> [u8; 32] {
        let mut sum = Sha256::new();
        let points = self.points.iter().flatten();
        let ground = f64::from(u8::from(self.angles == Angles::Ground));
        let rest = [self.cap, self.best, self.gap, self.points.len() as f64, ground];
        for number in rest.iter().chain(points).chain(&self.turns_deg).chain(&self.directions) {
            sum.update(number.to_le_bytes());
        }
        if let Angles::Axis(Axis { pivot, line, lengths, phi, .. }) = self.angles {
            let (line, to) = match line {
                None => (0.0, [0.0; 2]),
                Some(Line::Angle(angle)) => (1.0, [angle, 0.0]),
                Some(Line::To(b)) => (2.0, b),
            };
            let known = f64::from(u8::from(pivot.is_some()));
            let [crank, double] = Class::ALL.map(|class| f64::from(u8::from(self.classes.contains(&class))));
            let limits = [lengths.crank, lengths.ground, phi, pivot.unwrap_or_default(), to];
            for number in [2.0, known, line, crank, double].iter().chain(limits.as_flattened()) {
                sum.update(number.to_le_bytes());
            }
        }
        sum.finalize().into()
    }

    /// Returns the part of the chart that is covered.
    pub fn root(&self) -> Cell {
        match self.angles {
            Angles::Increments => ROOT,
            Angles::Ground => root([0.0; 2]),
            Angles::Axis(axis) => root(axis.phi),
        }
    }

    /// Returns the certificate whose parts have these trees.
    pub fn certificate(&self, leaves: &Leaves) -> Certificate {
        let parts: Vec<CertificatePart> = leaves
            .parts
            .iter()
            .map(|part| CertificatePart {
                linkage_type: part.class.name().to_owned(),
                direction: part.direction,
                lower_bound: part.lower_bound,
                closed: part.nodes.codes().all(|code| code != OPEN),
                // The first box is the whole chart, which is not evaluated.
                boxes: part.nodes.len().saturating_sub(1),
                leaves_sha256: hex(&part.nodes.sha256()),
            })
            .collect();
        self.stated(parts, hex(&leaves.sha256()))
    }

    /// Returns the certificate whose parts have these bounds: everything in it but the parts themselves and the
    /// digest of its leaves follows from them and the problem.
    pub fn stated(&self, parts: Vec<CertificatePart>, leaves_sha256: String) -> Certificate {
        let bound = parts.iter().map(|part| part.lower_bound).fold(f64::INFINITY, f64::min);
        let (points, best) = (self.points.len(), self.best);
        let limit = self.limit;
        // Rounded down to the digits that are shown.
        let below = bound * (1.0 - 1e-12);
        let gap = self.gap_of(bound);
        let words = self.words();
        Certificate {
            statement: format!(
                "No {}, in one assembly at all points and with its coupler point at most {limit} from the crank pin, has \
                 a sum of squared errors below {below:.12e} at these {points} points and {}; the best one found has \
                 {best:.12e}.",
                words.linkage, words.angles
            ),
            lower_bound: bound,
            gap,
            closed: parts.iter().all(|part| part.closed) && gap <= self.gap,
            boxes: parts.iter().fold(0, |sum: u64, part| sum.saturating_add(part.boxes)),
            covered: words.covered,
            not_covered: words.not_covered,
            leaves_sha256,
            wanted_gap: self.gap,
            parts,
        }
    }
}

/// Returns the classes that contain linkages of these types; all if none does.
fn classes(types: &[LinkageType]) -> Vec<Class> {
    let holds = |class: &Class| {
        types.iter().any(|kind| *kind == LinkageType::ChangePoint || kind.name() == class.name())
    };
    let some: Vec<Class> = Class::ALL.into_iter().filter(holds).collect();
    if some.is_empty() { Class::ALL.to_vec() } else { some }
}
