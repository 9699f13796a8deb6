//! The figures of what it takes to build a linkage, as data.

use linkwright::internals::app::building::{self, Sizes};
use linkwright::internals::app::inputs::Given;
use linkwright::internals::judge::practicality::sensitivity::Dimension;
use linkwright::internals::judge::practicality::{Closest, Practicality, Sweep, usual_tolerance};
use linkwright::internals::mechanism::CrankLinkage;
use linkwright::internals::mechanism::plates::Shop;
use linkwright::internals::report::Colour;
use linkwright::internals::report::practicality::practicality_text;
use linkwright::{Problem, Unit};
use serde_json::{Value, json};

/// Examines a linkage; sizes that are not given are those of the shop data, else the usual ones.
///
/// # Errors
/// The reason why there is nothing to build.
pub fn built(
    given: Given,
    shop: Option<Shop>,
    sizes: &Sizes,
    tolerance: Option<f64>,
) -> Result<(Value, String), String> {
    let made = |title: &str, sweep: Option<Sweep>, linkage: &CrankLinkage, unit: Option<Unit>| {
        let sweep = sweep.ok_or_else(|| nothing(title))?;
        building::build((linkage, unit), &sweep, shop, sizes).map_err(|why| format!("{title}: {why}"))
    };
    let (title, linkage, unit, found) = match given {
        Given::Linkage(file) => {
            let linkage = file.linkage;
            let build = made(&file.name, Sweep::of_linkage(linkage), &linkage, file.unit)?;
            let found = Practicality::of_linkage(linkage, build);
            (file.name.clone(), linkage, file.unit, found)
        }
        Given::Run(run) => {
            let chosen = run.one().map_err(|e| e.to_string())?;
            let problem = Problem::new(run.record.problem.resolved.clone()).map_err(|e| e.to_string())?;
            let unit = run.record.problem.unit;
            let linkage = chosen.candidate.linkage;
            let build = made(&chosen.label, Sweep::of_candidate(&problem, chosen.candidate), &linkage, unit)?;
            let found = Practicality::of_candidate(&problem, chosen.candidate, build);
            (chosen.label.clone(), linkage, unit, found)
        }
    };
    let found = found.ok_or_else(|| nothing(&title))?;
    let tolerance = tolerance.unwrap_or_else(|| usual_tolerance(linkage, unit));
    let text = practicality_text(&found, unit, tolerance, Colour::Never);
    Ok((figures(&found, tolerance), text))
}

/// Returns the refusal of a linkage without a position.
fn nothing(title: &str) -> String {
    format!("{title} cannot be assembled, so there is nothing to build")
}

fn figures(found: &Practicality, tolerance: f64) -> Value {
    let closest = |closest: &Closest| {
        json!({ "value": closest.value, "crank_deg": closest.crank_angle.to_degrees(),
                "t1": i64::from(closest.assembly) })
    };
    let distances = found.distances.as_ref().map(|all| {
        all.iter()
            .map(
                |one| json!({ "between": one.between, "fixed": one.fixed, "closest": closest(&one.closest) }),
            )
            .collect::<Vec<_>>()
    });
    let layers = found.layering.as_ref().and_then(|layering| layering.stack.as_ref()).map(|stack| {
        stack
            .layers
            .iter()
            .map(|layer| layer.iter().map(|link| link.name()).collect::<Vec<_>>())
            .collect::<Vec<_>>()
    });
    let dimension = |one: &Dimension| json!({ "name": one.name, "rms": one.rms, "worst": one.worst, "worst_at": one.worst_at });
    let sensitivity = found.sensitivity.as_ref().map(|felt| {
        json!({
            "dimensions": felt.dimensions.iter().map(dimension).collect::<Vec<_>>(),
            "ground": felt.ground.as_ref().map(dimension),
            "band": felt.band, "worst": felt.worst, "worst_at": felt.worst_at, "at_toggles": felt.at_toggles,
        })
    });
    json!({
        "hole": 2.0 * found.build.pin_radius, "margin": found.build.plate_radius - found.build.pin_radius,
        "tolerance": tolerance, "layers": layers, "distances": distances, "sensitivity": sensitivity,
    })
}
