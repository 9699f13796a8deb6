//! The reference page of a file's keys, generated from its schema: a section for each table, a row for each key.

use super::{SchemaKind, schema};
use crate::mechanism::MAX_MAGNITUDE;
use serde_json::{Map, Value};
use std::fmt::Write;

/// The order of the tables at the top of a problem file; the others follow by name.
const ORDER: [&str; 6] = ["task", "design", "require", "solve", "certify", "expect"];

/// The beginning of the page of linkage files: a whole file of each kind.
const LINKAGE_EXAMPLES: &str = r#"
`linkwright check FILE` reads such a file and says what is wrong with it; `analyze`, `cognates`, `build`, `snap`,
`export` and `compare --target PROBLEM` take it as their LINKAGE or RESULT, and every result holds its candidates as
such files (`linkage-1.toml`, ..). A file holds exactly one of `[linkage]`, `[vector_loop]`, `[slider_crank]`,
`[inverted_slider_crank]` and `[chain]`; the last three are for `check` and `analyze`, those with a slider also for `export` and
`build`.

A four-bar: crank A-C, coupler C-D with the coupler point P, follower B-D.

```toml
format = 1
name = "four-bar"
unit = "mm"

[linkage]
A = [0.0, 0.0]
B = [4.0, 1.0]
a = 2.0
b = 5.0
c = 5.0
d = 5.0
e = 5.0
t1 = 1
t2 = -1
```

The same kind of linkage as textbooks write it, a vector loop with a polar coupler point:

```toml
format = 1
name = "vector-loop"

[vector_loop]
O1 = [0.0, 0.0]
O2 = [-350.0, 0.0]
L2 = 700.0
L3 = 300.0
L4 = 500.0
Z1 = 200.0
beta_deg = 30.0
t1 = 1
```

A slider-crank: crank A-C, coupler C-D with the coupler point P, 5 along it and 1 to its left, and D slides along the line
through (0, 1) in the direction of the x axis. The slider's place counts from that point.

```toml
format = 1
name = "slider-crank"

[slider_crank]
A = [0.0, 0.0]
a = 2.0
b = 5.0
line_point = [0.0, 1.0]
line_deg = 0.0
coupler_x = 5.0
coupler_y = 1.0
t1 = 1
```

An inverted slider-crank: the coupler is a rod from C that slides through a block at the fixed pivot B, which lies 0.5 to the
left of the rod's line; P is 5 along the rod and 1 to its left. In analyses D is the foot of the perpendicular from B on the
rod, and the slider's place its distance from C.

```toml
format = 1
name = "inverted-slider-crank"

[inverted_slider_crank]
A = [0.0, 0.0]
B = [4.0, 1.0]
a = 2.0
offset = 0.5
coupler_x = 5.0
coupler_y = 1.0
t1 = 1
```

A compound mechanism, stage by stage: a crank turns the joint C about A, a dyad hangs the joint D between C and the fixed
pivot B, and P is a point of the link C-D, 2 along it and 1 to its left. Further `[[chain.dyad]]`, `[[chain.slider]]` and
`[[chain.guide]]` add stages; `problems/linkages/` has six-bars, a walking leg and a quick-return drive.

```toml
format = 1
name = "chain"

[chain]
trace = "P"

[chain.pivots]
A = [0.0, 0.0]
B = [4.0, 0.0]

[chain.crank]
pivot = "A"
joint = "C"
length = 1.0

[[chain.dyad]]
joint = "D"
from = ["C", "B"]
lengths = [4.0, 3.0]
side = 1

[[chain.point]]
name = "P"
on = ["C", "D"]
at = [2.0, 1.0]
```

Loads, in the table `[loads]` below the linkage or in a file of their own (`format`, `unit` and `[loads]`; `analyze LINKAGE --loads
FILE`), need `unit`. Masses are in kg, forces in N, moments in N m, rates in N/m and N m/rad, lengths in the file's unit. A body is
named `crank`, `coupler`, `follower`, `block` or `link5` to `link8`; of a chain it is two joints of the link (`B-C`), and `block-D` is the block
of the stage that makes D; `P` is what the body that carries P bears beside its own mass. Places on a body count along the line from
its first joint to its second, and to the left of it. Friction is left out: joints and sliders bear forces without loss. A speed that
changes over the turn is a table, `speed_rpm = [[0, 60], [120, 90], [240, 75]]`: the periodic cubic spline through rows of degrees and
rpm, whose derivative is continuous; the acceleration of the crank is omega d omega/d phi. Its speeds have one sign and are nowhere 0.

```toml
format = 1
name = "loaded"
unit = "mm"

[linkage]
A = [0.0, 0.0]
B = [40.0, 10.0]
a = 20.0
b = 50.0
c = 50.0
d = 50.0
e = 50.0
t1 = 1
t2 = 1

[loads]
gravity = [0, -9.81]

[loads.body.coupler]
mass_kg = 0.2
center = [20, 5]
inertia_kg_m2 = 1e-4

[loads.body.follower]
density_kg_m3 = 2700
thickness = 5
width = 20

[[loads.force]]
at = "P"
force_N = [0, -10]

[[loads.force]]
at = { body = "follower", at = [25, 0] }
along = "follower"
table = [[0, 0, 2], [180, 0, 6]]

[[loads.couple]]
body = "follower"
moment_N_m = 0.3

[[loads.spring]]
from = "D"
to = [50, 80]
rate_N_per_m = 400
free_length = 30

[[loads.spring]]
body = "follower"
rate_N_m_per_rad = 0.5
free_angle_deg = 90
```

Shop data, in the table `[shop]` below the linkage or in a file of their own (`format`, `unit` and `[shop]`; `build` and `export` with
`--shop FILE`), are the sizes of holes, pins, plates and rims. Lengths are in the file's unit, without one in that of the linkage, and
are those of the finished parts: `scale` of `export` leaves them. Joints and bodies are named as in cut lists, also those of a six-bar
that a `[chain]` describes. A hole of `hole_in` goes before that of `hole`; what is set with `--set` or an option of `build` goes before
both. The pin of a joint is as thick as its smaller hole: the follower below runs on a bearing of 10 mm around a pin of 4 mm.

```toml
format = 1
name = "with-bearings"
unit = "mm"

[linkage]
A = [0.0, 0.0]
B = [80.0, 20.0]
a = 30.0
b = 90.0
c = 80.0
d = 60.0
e = 60.0
t1 = 1
t2 = 1

[shop]
hole = 4
margin = 5
thickness = 3

[shop.joint.A]
hole_in = { crank = 6, ground = 22 }

[shop.joint.B]
hole_in = { follower = 10 }
rim = 4

[shop.body.ground]
thickness = 6

[shop.body.coupler]
width = 16
```

A file that linkwright wrote says so in its first line, "written by linkwright", whatever is edited below it: such a
file may be replaced by a command that writes a linkage file under the same name. Without that line, and where it is the
command's own input, it is replaced with `--force` alone.
"#;

/// The text around the keys of sweep files: an example and the rules, then the files of a sweep's folder.
const SWEEP_FORMATS: &str = include_str!("sweep_formats.md");

/// Returns the reference of a kind of file as a page of Markdown: every table with its keys, their allowed values,
/// defaults and meanings.
///
/// ```
/// use linkwright::internals::files::schema::{SchemaKind, reference};
/// assert!(reference(SchemaKind::Problem).contains("| `transmission_deg_min` | number |"));
/// ```
pub fn reference(kind: SchemaKind) -> String {
    let schema = schema(kind);
    let mut page = Page { schema: &schema, text: String::new() };
    let name = kind.name();
    let read =
        format!("Unknown keys are refused. All numbers are finite and below {MAX_MAGNITUDE:e} in magnitude.");
    // What comes before the table of keys, and what comes after it.
    let sweep = SWEEP_FORMATS.split_at(SWEEP_FORMATS.find("\n## ").unwrap_or(SWEEP_FORMATS.len()));
    let (title, rules) = match kind {
        SchemaKind::Problem => ("problem file", read.as_str()),
        SchemaKind::Linkage => ("linkage file", read.as_str()),
        SchemaKind::Sweep => ("sweep file", read.as_str()),
        SchemaKind::Record => {
            ("record (record.json)", "All numbers are finite; keys that do not apply are absent.")
        }
    };
    // Writing to a string never fails, so the results of `write!` below are ignored.
    let _ = write!(
        page.text,
        "# The {title}\n\n\
         This page is made from the program's own schema: `linkwright schema {name} --markdown` prints it. {rules} \
         Angles are in degrees, lengths in the file's unit.\n{examples}",
        examples = match kind {
            SchemaKind::Linkage => LINKAGE_EXAMPLES,
            SchemaKind::Sweep => sweep.0,
            SchemaKind::Problem | SchemaKind::Record => "",
        },
    );
    page.table("", &schema);
    if kind == SchemaKind::Sweep {
        page.text.push_str(sweep.1);
    }
    page.text
}

/// The page that is being written.
struct Page<'a> {
    schema: &'a Value,
    text: String,
}

impl<'a> Page<'a> {
    /// Returns a value's schema, with references followed and the alternative `null` (key absent) left out.
    fn resolved(&self, value: &'a Value) -> &'a Value {
        if let Some(place) = value["$ref"].as_str() {
            return self.schema.pointer(place.trim_start_matches('#')).unwrap_or(value);
        }
        match value["anyOf"].as_array().map(Vec::as_slice) {
            Some([one, null]) if null["type"] == "null" => self.resolved(one),
            _ => value,
        }
    }

    /// Writes a table's rows, then the tables in it, each under its name.
    fn table(&mut self, name: &str, table: &'a Value) {
        let Some(keys) = table["properties"].as_object() else { return };
        let required: Vec<&str> =
            table["required"].as_array().into_iter().flatten().filter_map(Value::as_str).collect();
        let (mut inner, rows): (Vec<_>, Vec<_>) =
            keys.iter().partition(|(_, value)| self.inner(value).is_some());
        inner.sort_by_key(|(key, _)| ORDER.iter().position(|first| first == key).unwrap_or(ORDER.len()));
        if !rows.is_empty() {
            self.text.push_str("\n| key | what | default | meaning |\n|---|---|---|---|\n");
        }
        let mut words = Vec::new();
        for (key, value) in rows {
            let default = match &value["default"] {
                Value::Null if required.contains(&key.as_str()) => "required".to_owned(),
                Value::Null => String::new(),
                default => format!("`{default}`").replace('"', ""),
            };
            let (what, meaning) = (self.what(value), description(value));
            let _ = writeln!(self.text, "| `{key}` | {what} | {default} | {meaning} |");
            words.extend(self.words(value).map(|choices| (key, choices)));
        }
        for (key, choices) in words {
            let _ = write!(self.text, "\n`{key}`:\n\n");
            for choice in choices {
                let word = choice["const"].as_str().unwrap_or_default();
                let _ = writeln!(self.text, "- `{word}`: {}", description(choice));
            }
        }
        for (key, value) in inner {
            let path = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
            let Some((table, list)) = self.inner(value) else { continue };
            let path = if self.is_by_name(value) { format!("{path}.NAME") } else { path };
            let heading = if list { format!("[[{path}]]") } else { format!("[{path}]") };
            let _ = write!(self.text, "\n## `{heading}`\n\n{}\n", description(value));
            self.table(&path, table);
        }
    }

    /// Returns the table that a key holds, and whether it holds a list of such tables.
    fn inner(&self, value: &'a Value) -> Option<(&'a Value, bool)> {
        let value = self.resolved(value);
        let (value, list) = match &value["items"] {
            Value::Null => (value, false),
            items => (self.resolved(items), true),
        };
        let value =
            if self.is_by_name(value) { self.resolved(&value["additionalProperties"]) } else { value };
        value["properties"].is_object().then_some((value, list))
    }

    /// Returns whether a key holds tables by names that are free.
    fn is_by_name(&self, value: &'a Value) -> bool {
        let tables = self.resolved(&self.resolved(value)["additionalProperties"]);
        tables["properties"].is_object()
    }

    /// Returns the allowed words of a key, if its value is one of several words or a list of such.
    fn words(&self, value: &'a Value) -> Option<&'a Vec<Value>> {
        let value = self.resolved(value);
        if let Some(alternatives) = value["anyOf"].as_array() {
            return alternatives.iter().find_map(|one| self.words(one));
        }
        value["oneOf"].as_array().filter(|choices| choices.iter().all(|choice| choice["const"].is_string()))
    }

    /// Returns the allowed values of a key, in words.
    fn what(&self, value: &'a Value) -> String {
        let value = self.resolved(value);
        if let Some(alternatives) = value["anyOf"].as_array() {
            let several: Vec<String> = alternatives.iter().map(|one| self.what(one)).collect();
            return several.join(" or ").replace("number or [number, number]", "number or [min, max]");
        }
        if let Some(choices) = self.words(value) {
            return if choices.is_empty() { "text".into() } else { "a word".into() };
        }
        if let Some(word) = value["const"].as_str() {
            return format!("`\"{word}\"`");
        }
        match kind(value).as_deref() {
            Some("number") => "number".into(),
            Some("integer") => "whole number".into(),
            Some("boolean") => "true or false".into(),
            Some("string") => "text".into(),
            Some("array") => self.list(value.as_object()),
            _ => "table".into(),
        }
    }

    /// Returns the contents of a list, in words.
    fn list(&self, value: Option<&'a Map<String, Value>>) -> String {
        let Some(value) = value else { return "list".into() };
        let item = value.get("items").map_or("anything".into(), |items| self.what(items));
        match value.get("minItems").and_then(Value::as_u64) {
            Some(n) if value.get("maxItems").and_then(Value::as_u64) == Some(n) => match (n, item.as_str()) {
                (2, "number") => "[number, number]".into(),
                (3, "number") => "[number, number, number]".into(),
                _ => format!("list of {n}: {item} each"),
            },
            _ => format!("list: {item} each"),
        }
    }
}

/// Returns the JSON type of a value that may be absent.
fn kind(value: &Value) -> Option<String> {
    match &value["type"] {
        Value::String(one) => Some(one.clone()),
        Value::Array(several) => {
            several.iter().filter_map(Value::as_str).find(|t| *t != "null").map(str::to_owned)
        }
        _ => None,
    }
}

/// Returns the description in one line, fit for a cell of a table; names of Rust items lose their brackets.
fn description(value: &Value) -> String {
    let text = value["description"].as_str().unwrap_or_default();
    let text = text.replace('\n', " ").replace("[`", "`").replace("`]", "`");
    text.replace('|', "\\|")
}
