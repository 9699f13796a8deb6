//! Warns of closed targets that no linkage can close as asked, before a search looks for one in vain.

use crate::files::diagnostic::Diagnostic;
use crate::files::toml_text::TomlText;
use crate::mechanism::LinkageType;
use crate::task::Problem;
use crate::task::defect::ORDER_TOLERANCE;
use crate::task::spec::{OrderPolicy, ProblemSpec};

/// Returns a warning if the motion has to come back to the first point without reversing, and the types required or the
/// prescribed crank angles do not let it.
pub(super) fn against(toml: &TomlText<'_>, spec: &ProblemSpec) -> Option<Diagnostic> {
    let require = &spec.require;
    let path = &spec.task;
    if path.closed
        && require.order == OrderPolicy::Required
        && require.closing.is_one_way()
        && let Some(angles) =
            path.timing.as_ref().filter(|timing| timing.free.is_empty()).map(|timing| &timing.crank_deg)
        && let Some(turn) = reversal(angles)
    {
        let message =
            format!("closed = true, and crank_deg turns back at point {turn}: nothing can be accepted");
        return Some(toml.at(&format!("task.path.timing.crank_deg.{turn}"), message).with_help(
            "a closed path is run one way: give angles that only rise or only fall, or closed = false, or \
             closing = \"any\" in [require]",
        ));
    }
    // What is wrong with the task itself has been said before.
    let problem = Problem::new(spec.clone()).ok()?;
    let turns = |kind: &LinkageType| kind.input_turns_fully() || *kind == LinkageType::ChangePoint;
    if !problem.has_to_turn_on() || require.types.is_empty() || problem.types().iter().any(turns) {
        return None;
    }
    let message =
        "the path ends where it begins, and no crank of these types turns fully: nothing can be accepted";
    Some(toml.at("require.type", message).with_help(
        "allow crank-rocker or double-crank; or write branch = \"any\" for a motion through the toggles, or \
         closing = \"any\" for one that goes to and fro",
    ))
}

/// Returns the first point whose angle lies the other way than those before it.
fn reversal(angles: &[f64]) -> Option<usize> {
    let (first, last) = (angles.first()?, angles.last()?);
    let way = if last < first { -1.0 } else { 1.0 };
    angles
        .windows(2)
        .zip(1..)
        .find(|(w, _)| way * (w[1] - w[0]) < -ORDER_TOLERANCE.to_degrees())
        .map(|(_, j)| j)
}
