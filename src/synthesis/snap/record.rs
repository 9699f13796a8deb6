//! The record of a snap, and a problem for a linkage that has none.

use super::search::{Request, Snapped};
use crate::judge::assess::{assess, measure_beside};
use crate::judge::costs::marginal;
use crate::judge::family::family;
use crate::judge::practicality::Sweep;
use crate::judge::practicality::sensitivity::along;
use crate::mechanism::{CrankLinkage, LinkageKind, Unit, xy};
use crate::record::digest::NotWritten;
use crate::record::{Candidate, ProblemRecord, Record};
use crate::synthesis::answers::annotate;
use crate::task::Problem;
use crate::task::spec::{DesignSpec, ProblemSpec, RequireSpec, SolveSpec, TaskSpec};

/// Number of points on a linkage's own curve.
const OWN_POINTS: usize = 36;

/// Returns a record of the snapped linkages, under the original problem: `verify` recomputes every figure, `compare`
/// puts it beside the run that it came from.
///
/// # Errors
/// As [`ProblemRecord::new`].
pub fn record(
    problem: &Problem,
    name: &str,
    source: Option<String>,
    unit: Option<Unit>,
    request: &Request,
    snapped: &Snapped,
) -> Result<Record, NotWritten> {
    let mut candidates = snapped.candidates.clone();
    for candidate in &mut candidates {
        candidate.costs = marginal(problem, candidate);
        measure_beside(problem, candidate);
        annotate(problem, candidate);
    }
    let keys: Vec<String> = snapped.lengths.iter().map(|length| length.key()).collect();
    let used = vec![format!("snap {} to {}", keys.join(", "), request.stock.words())];
    let asked = ProblemRecord::new(name.into(), source, unit, problem.spec().clone())?;
    let family = candidates.first().and_then(|best| family(problem, best));
    let record = Record::new(asked, used, snapped.reason, snapped.evaluations, candidates);
    Ok(Record { family, ..record })
}

/// Returns the problem that a linkage solves by itself: points of its own coupler curve over its whole range of motion,
/// with free timing and without limits; and the linkage as its candidate. `None` if it cannot be assembled.
pub fn own_curve(linkage: &CrankLinkage) -> Option<(Problem, Candidate)> {
    let sweep = Sweep::of_linkage(*linkage)?;
    let at = along(&sweep, OWN_POINTS);
    let points = at
        .iter()
        .map(|at| Some(xy(linkage.joints_with(at.crank_angle, at.assembly)?.joints.coupler_point)))
        .collect::<Option<Vec<_>>>()?;
    let require = RequireSpec {
        link_ratio_max: RequireSpec::default().link_ratio_max.max(2.0 * linkage.link_ratio()),
        ..RequireSpec::default()
    };
    let kind = linkage.kind();
    let mechanism = if kind == LinkageKind::FourBar { Vec::new() } else { vec![kind] };
    let spec = ProblemSpec {
        task: TaskSpec::path(points, sweep.full_turn),
        design: DesignSpec { mechanism, ..DesignSpec::default() },
        require,
        solve: SolveSpec::default(),
        loads: None,
    };
    let problem = Problem::new(spec).ok()?;
    let crank_deg: Vec<f64> = at.iter().map(|at| at.crank_angle.to_degrees()).collect();
    let assemblies: Vec<_> = at.iter().map(|at| at.assembly).collect();
    let candidate = assess(&problem, *linkage, &crank_deg, &assemblies)?;
    Some((problem, candidate))
}
