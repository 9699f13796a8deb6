//! Reads `[task.motion]`: the poses from their source, with weights, tolerances and crank angles.

use super::lists::Lists;
use super::path::{TaskRead, task_read};
use super::raw::RawMotion;
use super::target::{Source, Target, Whereabouts};
use crate::files::diagnostic::Checked;
use crate::files::toml_text::TomlText;
use crate::files::toml_values::numbers;
use crate::task::corners;
use crate::task::spec::{BodySpec, TaskSpec};

/// Returns the motion with its lists, and the task that it is. A tolerance that is set on the command line takes the place
/// of the column of a poses file.
pub(super) fn motion_of(
    toml: &TomlText<'_>,
    motion: &RawMotion,
    whereabouts: &Whereabouts<'_>,
    is_set: impl Fn(&str) -> bool,
) -> Checked<TaskRead> {
    let (mut target, angle_deg) = Target::of_motion(toml, motion, whereabouts)?;
    let mut columns = [None, None, None, None];
    if let Source::Csv(csv) = &mut target.source {
        columns = [&mut csv.crank_deg, &mut csv.weight, &mut csv.tolerance, &mut csv.tolerance_deg]
            .map(Option::take);
    }
    let [crank_deg, weight, tolerance, tolerance_deg] = columns;
    let unless_set = |key: &str, column: Option<Vec<f64>>| column.filter(|_| !is_set(key));
    let tolerance = unless_set("task.motion.tolerance", tolerance);
    let tolerance_deg = unless_set("task.motion.tolerance_deg", tolerance_deg);
    let lists = Lists { toml, target: &target, file: motion.file.as_deref() };
    let words = ["tolerance", "a distance"];
    let tolerance = lists.tolerances("tolerance", words, motion.tolerance.as_ref(), tolerance)?;
    let words = ["tolerance of the angle", "an angle's error"];
    let tolerance_deg =
        lists.tolerances("tolerance_deg", words, motion.tolerance_deg.as_ref(), tolerance_deg)?;
    let weight = lists.weights(motion.weight.as_deref().map(numbers), weight)?;
    let timing = lists.timing(motion.timing.as_ref(), crank_deg)?;
    let angle_weight = match motion.angle_weight {
        Some(given) => given.0,
        None => {
            let (low, high) = corners(&target.points);
            let size = (high[0] - low[0]).hypot(high[1] - low[1]);
            if size == 0.0 && target.points.len() > 1 {
                let message = "the body only turns: nothing says what length an angle error counts like";
                let help = "give angle_weight, the length that an error of one radian counts like, such as the size of \
                            the body";
                return Err(Box::new(target.at_all(toml, message.into()).with_help(help)));
            }
            size
        }
    };
    let body = Some(BodySpec { angle_deg, angle_weight, tolerance_deg });
    let points = std::mem::take(&mut target.points);
    let closed = target.closed;
    task_read(
        toml,
        target,
        TaskSpec { points, closed, weight, tolerance, timing, raw: None, body, output: None },
    )
}
