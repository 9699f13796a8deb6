//! Reads `[task.motion]`: the poses from their source, with weights, tolerances and crank angles.

use super::lists::Lists;
use super::path::{TaskRead, task_read};
use super::raw::RawMotion;
use super::target::{Source, Target, Whereabouts};
use crate::files::diagnostic::{Checked, counted};
use crate::files::toml_text::TomlText;
use crate::files::toml_values::numbers;
use crate::task::corners;
use crate::task::spec::{BodySpec, TaskSpec};

/// The tolerances of poses beside exact ones that have none of their own: so many sizes of the target, and the largest
/// error that an angle can have. They limit nothing.
const ANY_SIZES: f64 = 100.0;
const ANY_DEG: f64 = 180.0;

/// Returns the poses that are to be met exactly, of `n`.
fn exact_of(toml: &TomlText<'_>, motion: &RawMotion, n: usize) -> Checked<Vec<usize>> {
    let mut exact: Vec<usize> = Vec::new();
    for (i, count) in motion.exact.iter().flatten().enumerate() {
        let key = format!("task.motion.exact.{i}");
        let Some(j) = usize::try_from(count.0).ok().filter(|j| *j < n) else {
            let message =
                format!("there is no pose {}: there are {}, counted from 0", count.0, counted(n, "pose"));
            return toml.refuse(&key, message, format!("write numbers from 0 to {}", n.saturating_sub(1)));
        };
        if exact.contains(&j) {
            return toml.refuse(&key, format!("pose {j} is named twice"), "name each pose once");
        }
        exact.push(j);
    }
    Ok(exact)
}

/// Returns the motion with its lists, and the task that it is. A tolerance that is set on the command line takes the place
/// of the column of a poses file.
pub(super) fn motion_of(
    toml: &TomlText<'_>,
    motion: &RawMotion,
    whereabouts: &Whereabouts<'_>,
    is_set: impl Fn(&str) -> bool,
) -> Checked<TaskRead> {
    let (mut target, angle_deg) = Target::of_motion(toml, motion, whereabouts)?;
    let (mut crank_deg, mut columns) = (None, [None, None, None]);
    if let Source::Csv(csv) = &mut target.source {
        crank_deg = csv.crank_deg.take();
        columns = [&mut csv.weight, &mut csv.tolerance, &mut csv.tolerance_deg].map(Option::take);
    }
    let [weight, tolerance, tolerance_deg] = columns;
    let unless_set = |key: &str, column: Option<Vec<f64>>| column.filter(|_| !is_set(key));
    let tolerance = unless_set("task.motion.tolerance", tolerance);
    let tolerance_deg = unless_set("task.motion.tolerance_deg", tolerance_deg);
    let lists = Lists { toml, target: &target, file: motion.file.as_deref() };
    let words = ["tolerance", "a distance"];
    let tolerance = lists.tolerances("tolerance", words, motion.tolerance.as_ref(), tolerance)?;
    let words = ["tolerance of the angle", "an angle's error"];
    let tolerance_deg =
        lists.tolerances("tolerance_deg", words, motion.tolerance_deg.as_ref(), tolerance_deg)?;
    let size = {
        let (low, high) = corners(&target.points);
        (high[0] - low[0]).hypot(high[1] - low[1])
    };
    let exact = exact_of(toml, motion, target.points.len())?;
    let unless_exact = |given: Option<Vec<f64>>, any: f64| match exact.as_slice() {
        [] => given,
        exact => {
            let mut list = given.unwrap_or_else(|| vec![any; target.points.len()]);
            exact.iter().for_each(|j| list[*j] = 0.0);
            Some(list)
        }
    };
    let weight = lists.weights(motion.weight.as_deref().map(numbers), weight)?;
    let timing = lists.timing(motion.timing.as_ref(), crank_deg)?;
    let angle_weight = match motion.angle_weight {
        Some(given) => given.0,
        None => {
            if size == 0.0 && target.points.len() > 1 {
                let message = "the body only turns: nothing says what length an angle error counts like";
                let help = "give angle_weight, the length that an error of one radian counts like, such as the size of \
                            the body";
                return Err(Box::new(target.at_all(toml, message.into()).with_help(help)));
            }
            size
        }
    };
    // A body that only turns has the size of its angles.
    let tolerance = unless_exact(tolerance, ANY_SIZES * if size > 0.0 { size } else { angle_weight });
    let tolerance_deg = unless_exact(tolerance_deg, ANY_DEG);
    let body = Some(BodySpec { angle_deg, angle_weight, tolerance_deg });
    let points = std::mem::take(&mut target.points);
    let closed = target.closed;
    task_read(
        toml,
        target,
        TaskSpec { points, closed, weight, tolerance, timing, raw: None, body, output: None },
    )
}
