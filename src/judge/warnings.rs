//! Warnings: reasons against building a linkage although it meets every requirement.
//!
//! The figures and limits are the candidate's own, as the referee judged them: the same record always has the
//! same warnings.

use crate::judge::practicality::layers::can_be_stacked;
use crate::judge::practicality::{Build, Sweep};
use crate::mechanism::four_bar::transmission::{ForceTransmission, JAM_UNDER_LOAD_DEG};
use crate::mechanism::{LinkageType, least_and_greatest};
use crate::record::{Candidate, Figure, ON_BOUND_TEXT, Requirement, Warning, WarningKind};
use crate::task::Problem;
use crate::task::requirement::{LimitUnit, RequirementKind};

/// The worst transmission angle, in degrees, below which a loaded linkage may jam.
pub const LEAST_TRANSMISSION_DEG: f64 = JAM_UNDER_LOAD_DEG;
/// The ratio of the longest to the shortest link beyond which a linkage is hard to build.
pub const GREATEST_LINK_RATIO: f64 = 20.0;
/// The Grashof margin, in parts of the longest link, below which a linkage is almost a change point: play and
/// tolerances decide which way it turns.
pub const LEAST_MARGIN: f64 = 1e-3;
/// Distance of a value from its limit, in parts of the limit or of the target's size, within which it is on it.
pub const ON_BOUND: f64 = 1e-6;
/// Relative tolerance for rounding when a figure is compared with a limit, as for requirements.
const ROUNDING: f64 = 1e-7;

/// Returns the warnings of a candidate: transmission angle, link ratio, change point, plates that cannot be stacked, a closed path that
/// is run to and fro, then each limit that it lies on.
pub fn warnings(problem: &Problem, candidate: &Candidate) -> Vec<Warning> {
    let mut list = Vec::new();
    let mut push = |kind, key: &str, value: f64, limit: f64, text: String| {
        list.push(Warning { kind, text, key: key.into(), value, limit });
    };
    let worst = candidate.transmission_deg.worst;
    let force = ForceTransmission::of(worst);
    if matches!(force, ForceTransmission::MayJamUnderLoad | ForceTransmission::Jams) {
        let text = format!("worst transmission angle {} deg: {}", shown(worst), force.words());
        push(WarningKind::TransmissionAngle, "transmission_deg.worst", worst, LEAST_TRANSMISSION_DEG, text);
    }
    let ratio = candidate.link_ratio;
    if ratio > GREATEST_LINK_RATIO + ROUNDING * GREATEST_LINK_RATIO {
        let text = format!("longest link {} times the shortest: hard to build", shown(ratio));
        push(WarningKind::LinkRatio, "link_ratio", ratio, GREATEST_LINK_RATIO, text);
    }
    let least = LEAST_MARGIN * candidate.linkage.longest_link();
    let asked = problem.types().contains(&LinkageType::ChangePoint);
    if candidate.grashof_margin.abs() < least && !asked {
        let margin = candidate.grashof_margin;
        let text = format!("Grashof margin {}: almost a change point", shown(margin));
        push(WarningKind::ChangePoint, "grashof_margin", margin, least, text);
    }
    if let Some((plates, hole)) = unstackable(problem, candidate) {
        let hole = shown(hole);
        let text =
            format!("its plates cannot be stacked, each in one layer, with holes of {hole}: see build");
        push(WarningKind::Stacking, "layers", 0.0, plates as f64, text);
    }
    if candidate.goes_to_and_fro() {
        let [least, greatest] = least_and_greatest(candidate.crank_deg.iter().copied());
        let swept = greatest - least;
        let text = format!(
            "the crank goes to and fro over {} deg: the motion returns to its first {} back through all others",
            shown(swept),
            problem.spec().task.noun()
        );
        push(WarningKind::ToAndFro, "require.closing", swept, 360.0, text);
    }
    for requirement in &candidate.requirements {
        on_bound(problem, requirement, &mut |key, side, value, limit| {
            let text = format!("{key}{side} = {}{ON_BOUND_TEXT}", shown(limit));
            push(WarningKind::OnBound, key, value, limit, text);
        });
    }
    list
}

/// Returns the number of plates of a six-bar or an eight-bar that cannot be stacked, each in one layer, over the motion of a candidate,
/// with the diameter of their holes: the default one without a unit. The plates of linkages of one loop are not tried.
fn unstackable(problem: &Problem, candidate: &Candidate) -> Option<(usize, f64)> {
    let linkage = candidate.linkage.multi_loop()?;
    let sweep = Sweep::of_candidate(problem, candidate)?;
    let hole = Build::usual_hole_of(&sweep, None)?;
    let can = can_be_stacked(&sweep, &Build::new(hole, hole))?;
    (!can).then(|| (linkage.links().len(), hole))
}

/// Returns whether a warning is about the linkage itself, and not about the problem's limits or a motion that the
/// problem allows.
pub fn is_serious(warning: &Warning) -> bool {
    !matches!(warning.kind, WarningKind::OnBound | WarningKind::ToAndFro)
}

/// The sides of a box.
const SIDES: [&str; 4] = [" xmin", " ymin", " xmax", " ymax"];

/// Calls `each` with key, side of a box, value and limit for every limit of a requirement that the value lies on. Fixed
/// values, and coordinates that a box or a line fixes, have none.
fn on_bound(problem: &Problem, requirement: &Requirement, each: &mut dyn FnMut(&str, &str, f64, f64)) {
    let name = requirement.name.as_str();
    let unit = match RequirementKind::named(name) {
        Some(kind) => kind.definition().unit,
        None if ["design.ground_angle_deg", "design.line_deg"].contains(&name) => LimitUnit::Degree,
        None => LimitUnit::Length,
    };
    let unit = unit.whole(problem.task().size());
    let on = |value: f64, limit: f64| (value - limit).abs() <= ON_BOUND * limit.abs().max(unit);
    match (&requirement.value, &requirement.limit) {
        (Figure::Number(value), Figure::Numbers(limits)) if name.starts_with("design.") => {
            let [low, high] = limits[..] else { return };
            if low < high {
                for limit in [low, high].into_iter().filter(|limit| on(*value, *limit)) {
                    each(name, "", *value, limit);
                }
            }
        }
        (Figure::Number(value), Figure::Number(limit))
            if !(RequirementKind::names_tolerance(name) || RequirementKind::names_equality(name))
                && on(*value, *limit) =>
        {
            each(name, "", *value, *limit);
        }
        (Figure::Numbers(values), Figure::Numbers(limits)) if values.len() == 4 && limits.len() == 4 => {
            for (i, (value, limit)) in values.iter().zip(limits).enumerate() {
                let open = limits[i % 2] < limits[i % 2 + 2];
                if open && on(*value, *limit) {
                    each(name, SIDES[i], *value, *limit);
                }
            }
        }
        _ => {}
    }
}

/// Formats a value with three significant digits.
fn shown(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let exponent = value.abs().log10().floor() as i32;
    if !(-4..6).contains(&exponent) {
        return format!("{value:.2e}");
    }
    let text = format!("{value:.*}", (2 - exponent).max(0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}
