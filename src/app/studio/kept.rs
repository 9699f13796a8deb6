//! The keys of a problem file for which the studio has no control: they are kept beside an edit.

use super::tables::ASKED;
use crate::task::Task;
use crate::task::region::Region;
use crate::task::spec::{DesignSpec, ProblemSpec, RequireSpec, SolveSpec};
use serde::Serialize;
use std::collections::BTreeMap;

/// The key of a polygon for the pivots, which the studio keeps: a box is drawn.
pub(super) const POLYGON: &str = "require.pivots_in";

/// Returns the dotted keys of a table whose values differ from the defaults, with their values as they are typed.
fn differing(prefix: &str, table: &toml::Table, default: &toml::Table) -> BTreeMap<String, String> {
    let mut lines = BTreeMap::new();
    for (key, value) in table {
        let key_here = format!("{prefix}.{key}");
        match (value, default.get(key)) {
            (same, Some(default)) if same == default => {}
            (toml::Value::Table(inner), Some(toml::Value::Table(default))) => {
                lines.extend(differing(&key_here, inner, default));
            }
            _ => {
                lines.insert(key_here, value.to_string());
            }
        }
    }
    lines
}

fn table<T: Serialize>(value: &T) -> toml::Table {
    toml::Table::try_from(value).unwrap_or_default()
}

/// Returns the keys that a problem gives and the studio has no control for.
pub(super) fn kept(spec: &ProblemSpec) -> BTreeMap<String, String> {
    let ProblemSpec { task, design, require, solve, loads: _ } = spec;
    let (mut kept, mut usual) = (BTreeMap::new(), RequireSpec::default());
    if let Ok(task) = task.to_task() {
        let given = bounds(design, &task);
        let mut others = given.clone();
        others.remove("mechanism");
        kept = differing("design", &others, &toml::Table::new());
        usual.longest_max = given.try_into().ok().and_then(|given| require.default_longest(&given, &task));
        if usual.longest_max.is_some() && require.longest_max.is_none() {
            kept.insert("require.longest_max".into(), "\"any\"".into());
        }
    }
    let others =
        [("require", table(require), table(&usual)), ("solve", table(solve), table(&SolveSpec::default()))];
    for (name, mut given, usual) in others {
        let shown = ASKED.iter().filter(|(table, _)| *table == name).flat_map(|(_, keys)| *keys);
        let is_polygon =
            |key: &str| key == "pivots_in" && matches!(require.pivots_in, Some(Region::Polygon(_)));
        given.retain(|key, _| is_polygon(key) || !shown.clone().any(|shown| *shown == key));
        kept.extend(differing(name, &given, &usual));
    }
    kept
}

/// Returns the bounds that a problem gives, without those that the target gives by itself.
fn bounds(design: &DesignSpec, task: &Task) -> toml::Table {
    let resolved = |mut design: DesignSpec| {
        design.resolve(task);
        design
    };
    let (all, usual) = (table(design), table(&resolved(DesignSpec::default())));
    let mut given = all.clone();
    given.retain(|key, value| usual.get(key) != Some(value));
    // If leaving out the usual bounds changes others, everything is written.
    let again = given.clone().try_into().map(resolved);
    if again.as_ref() == Ok(design) { given } else { all }
}
