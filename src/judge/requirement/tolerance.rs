//! The errors of the targets that come nearest to missing their tolerances: of the place, of the angle of a link, and of a slider's place.

use super::{Finding, Judged, at_most};

pub(super) fn judged(judged: &Judged<'_>) -> Option<Finding> {
    if judged.problem.spec().task.is_of_places() {
        return of_link(judged);
    }
    let tolerances = judged.problem.task().tolerances()?;
    let structural = &judged.error.structural;
    let errors: Vec<f64> = structural.iter().map(|error| error.norm()).collect();
    worst(&errors, tolerances)
}

pub(super) fn of_angles(judged: &Judged<'_>) -> Option<Finding> {
    if judged.problem.spec().task.is_of_places() { None } else { of_link(judged) }
}

/// Returns the finding on the angles of a link, or on the places of a slider, which stand for degrees.
fn of_link(judged: &Judged<'_>) -> Option<Finding> {
    let tolerances = judged.problem.task().body()?.tolerances.as_ref()?;
    let given = judged.error.angle.as_ref()?.structural.iter().zip(tolerances);
    let given =
        given.filter_map(|(error, tolerance)| Some(((*error)?.abs().to_degrees(), tolerance.to_degrees())));
    let (errors, tolerances): (Vec<f64>, Vec<f64>) = given.unzip();
    worst(&errors, &tolerances)
}

/// Returns the row of the target whose error is the largest part of its own tolerance: the quantity that the largest
/// deviation minimises and that ranks. A target that is missed goes before one that is met only by the margin of a very
/// small tolerance.
fn worst(errors: &[f64], tolerances: &[f64]) -> Option<Finding> {
    let missed = |k: usize| !at_most(errors[k], tolerances[k]);
    let part = |k: usize| if errors[k] == 0.0 { 0.0 } else { errors[k] / tolerances[k] };
    let worst = (0..errors.len())
        .max_by(|&i, &j| missed(i).cmp(&missed(j)).then(part(i).total_cmp(&part(j))).then(j.cmp(&i)))?;
    Some(Finding::most(errors[worst], tolerances[worst]))
}
