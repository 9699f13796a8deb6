//! What a tab asks as the text of a problem file, and a problem file as what a tab asks.

use super::messages::{Ask, Known};
use crate::files::problem_file;
use crate::files::problem_file::{Expect, ProblemFile};
use crate::mechanism::MAX_MAGNITUDE;
use crate::task::requirement::RequirementKind;
use crate::task::spec::{DesignSpec, ProblemSpec, RawPoints, RequireSpec, SolveSpec};
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::{self, Display, Write};

/// The most points of a target in the studio.
pub const MOST_POINTS: usize = 1000;
/// The most points that are carried along as what the target was smoothed or resampled from.
const MOST_RAW: usize = 2000;
/// The fewest.
const FEWEST_POINTS: usize = 3;

/// Why a problem cannot be opened in the studio.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotHere {
    /// Too few points or too many.
    #[error(
        "this target has {0} points and the studio shows {FEWEST_POINTS} to {MOST_POINTS}: run it with `linkwright \
         synth`, or write `samples = 60` in [task.path] to take that many along it"
    )]
    Points(usize),
    /// The problem is not the same when it is read back from what the studio would ask.
    #[error("the studio cannot hold all of this problem ({0}): run it with `linkwright synth`")]
    Other(String),
}

/// A number as problem files have it.
struct Typed(f64);

impl Display for Typed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let size = self.0.abs();
        // Long whole numbers are integers to TOML, and do not fit.
        if size != 0.0 && !(1e-6..1e15).contains(&size) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}

/// `[1, 2]`
fn list(values: &[f64]) -> String {
    let values: Vec<String> = values.iter().map(|value| Typed(*value).to_string()).collect();
    format!("[{}]", values.join(", "))
}

fn quoted(text: &str) -> String {
    toml::Value::String(text.to_owned()).to_string()
}

/// A value that is not the default, as it is typed.
fn typed<T: Serialize + PartialEq>(value: &T, default: &T) -> Option<String> {
    let value = (value != default).then(|| toml::Value::try_from(value).ok())?;
    value.map(|value| value.to_string())
}

/// One value of TOML, written anew: a text that holds more than one, or none, is refused.
fn one_value(key: &str, text: &str) -> Result<String, String> {
    let parsed: Result<toml::Table, _> = format!("value = {text}").parse();
    match parsed.ok().filter(|table| table.len() == 1).and_then(|mut table| table.remove("value")) {
        Some(value) => Ok(value.to_string()),
        None => Err(format!("{key} is kept with a value that is none of a problem file: {text:.60}")),
    }
}

impl Ask {
    /// The text of the problem file that asks the same.
    ///
    /// # Errors
    /// What of [`kept`](Ask::kept) is no key and value under `design`, `require` or `solve`, in words.
    pub fn problem_text(&self) -> Result<String, String> {
        let mut text =
            format!("# Drawn in linkwright's studio.\nformat = 1\nname = {}\n", quoted(&self.name));
        let [design, require, solve] = self.kept_lines()?;
        // Writing to a String cannot fail.
        let _ = self.write_head(&mut text);
        let _ = self.write_path(&mut text);
        if !design.is_empty() {
            text.push_str(&format!("\n[design]\n{design}"));
        }
        let _ = self.write_require(&mut text);
        text.push_str(&require);
        let _ = self.write_solve(&mut text);
        text.push_str(&solve);
        if let Some(expect) = self.expect_text(&text) {
            text.push_str(&expect);
        }
        Ok(text)
    }

    /// What is known of the answer, where `text` asks the problem that it is known of.
    fn expect_text(&self, text: &str) -> Option<String> {
        #[derive(Serialize)]
        struct Table<'a> {
            expect: &'a Expect,
        }
        let known = self.expect.as_ref()?;
        let asked = problem_file::parse("drawing", text, None, &[]).ok()?;
        let table = Table { expect: &known.answer };
        let text = (told(&asked.spec) == known.of).then(|| toml::to_string(&table).ok())??;
        Some(format!("\n{text}"))
    }

    /// The lines of what is kept, under `design`, under `require` and under `solve`.
    fn kept_lines(&self) -> Result<[String; 3], String> {
        let mut lines = [const { String::new() }; 3];
        for (key, value) in &self.kept {
            let plain = |key: &str| {
                !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || "._-".contains(c))
            };
            let tables = [(0, "design."), (1, "require."), (2, "solve.")];
            let mut within =
                tables.iter().filter_map(|(place, table)| Some((*place, key.strip_prefix(table)?)));
            let Some((place, rest)) = within.next().filter(|(_, rest)| plain(rest)) else {
                return Err(format!("{key:.60} cannot be kept: keys under design, require and solve can"));
            };
            lines[place].push_str(&format!("{rest} = {}\n", one_value(key, value)?));
        }
        Ok(lines)
    }

    fn write_head(&self, text: &mut String) -> fmt::Result {
        if let Some(source) = &self.source {
            writeln!(text, "source = {}", quoted(source))?;
        }
        if let Some(unit) = self.unit {
            writeln!(text, "unit = \"{}\"", unit.label())?;
        }
        Ok(())
    }

    /// What the points were made from, where they still are.
    fn raw_of_points(&self) -> Option<&RawPoints> {
        let within = |raw: &&RawPoints| {
            let smooth = raw.smooth.is_none_or(|deviation| deviation > 0.0 && deviation.is_finite());
            let samples = raw.samples.is_none_or(|samples| (2..=MOST_POINTS).contains(&samples));
            let finite = raw.points.iter().flatten().all(|value| value.abs() <= MAX_MAGNITUDE);
            smooth && samples && finite && (2..=MOST_RAW).contains(&raw.points.len())
        };
        self.raw.as_ref().filter(within).filter(|raw| raw.target(self.closed) == self.points)
    }

    fn write_path(&self, text: &mut String) -> fmt::Result {
        let raw = self.raw_of_points();
        writeln!(text, "\n[task.path]\npoints = [")?;
        for point in raw.map_or(&self.points, |raw| &raw.points) {
            writeln!(text, "    {},", list(point))?;
        }
        writeln!(text, "]\nclosed = {}", self.closed)?;
        if let Some(smooth) = raw.and_then(|raw| raw.smooth) {
            writeln!(text, "smooth = {}", Typed(smooth))?;
        }
        if let Some(samples) = raw.and_then(|raw| raw.samples) {
            writeln!(text, "samples = {samples}")?;
        }
        match (&self.tolerances, self.tolerance) {
            (Some(each), _) => writeln!(text, "tolerance = {}", list(each))?,
            (None, Some(tolerance)) => writeln!(text, "tolerance = {}", Typed(tolerance))?,
            (None, None) => {}
        }
        if let Some(weights) = &self.weights {
            writeln!(text, "weight = {}", list(weights))?;
        }
        if let Some(timing) = &self.timing {
            writeln!(text, "\n[task.path.timing]\ncrank_deg = {}", list(&timing.crank_deg))?;
            if let Some(offset) = typed(&timing.offset, &Default::default()) {
                writeln!(text, "offset = {offset}")?;
            }
        }
        Ok(())
    }

    fn write_require(&self, text: &mut String) -> fmt::Result {
        writeln!(text, "\n[require]")?;
        if !self.types.is_empty() {
            let names: Vec<_> = self.types.iter().map(|t| format!("\"{}\"", t.name())).collect();
            writeln!(text, "type = [{}]", names.join(", "))?;
        }
        let numbers =
            [("transmission_deg_min", self.transmission_deg_min), ("link_ratio_max", self.link_ratio_max)];
        for (key, value) in numbers {
            if let Some(value) = value {
                writeln!(text, "{key} = {}", Typed(value))?;
            }
        }
        for (key, corners) in [("pivots_in", self.pivots_in), ("footprint_in", self.footprint_in)] {
            if let Some(corners) = corners {
                writeln!(text, "{key} = {}", list(&corners))?;
            }
        }
        let words = [
            ("transmission_over", typed(&self.transmission_over, &None)),
            ("order", typed(&self.order, &Default::default())),
            ("direction", typed(&self.direction, &Default::default())),
            ("circuit", typed(&self.circuit, &Default::default())),
            ("branch", typed(&self.branch, &Default::default())),
            ("closing", typed(&self.closing, &Default::default())),
        ];
        for (key, word) in words {
            if let Some(word) = word {
                writeln!(text, "{key} = {word}")?;
            }
        }
        Ok(())
    }

    fn write_solve(&self, text: &mut String) -> fmt::Result {
        writeln!(text, "\n[solve]\nseed = {}", self.seed)?;
        if let Some(method) = typed(&self.method, &Default::default()) {
            writeln!(text, "method = {method}")?;
        }
        if let Some(objective) = typed(&self.objective, &Default::default()) {
            writeln!(text, "objective = {objective}")?;
        }
        Ok(())
    }

    /// The problem that is asked, read as every problem file is.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn problem(&self) -> Result<ProblemFile, String> {
        let n = self.points.len();
        if !(FEWEST_POINTS..=MOST_POINTS).contains(&n) {
            return Err(format!(
                "a target has {FEWEST_POINTS} to {MOST_POINTS} points here, and this one has {n}"
            ));
        }
        if self.seed > i64::MAX as u64 {
            return Err(format!("the seed is at most {}", i64::MAX));
        }
        problem_file::parse("drawing", &self.problem_text()?, None, &[]).map_err(|e| match &e.help {
            Some(help) => format!("{}: {help}", e.message),
            None => e.message.clone(),
        })
    }

    /// What to ask for a problem: everything that its file says.
    ///
    /// # Errors
    /// [`NotHere`] where the studio cannot hold it.
    pub fn of(problem: &ProblemFile) -> Result<Ask, NotHere> {
        let ProblemSpec { task, design, require, solve } = &problem.spec;
        let path = &task.path;
        let n = path.points.len();
        if !(FEWEST_POINTS..=MOST_POINTS).contains(&n) {
            return Err(NotHere::Points(n));
        }
        let all = path.tolerance.as_ref().and_then(|each| each.first().copied());
        let tolerance = all.filter(|all| path.tolerance.iter().flatten().all(|t| t == all));
        let mut kept = design_lines(design, &problem.spec);
        kept.extend(solve_lines(solve));
        let mut ask = Ask {
            version: 0,
            name: problem.name.clone(),
            source: problem.source.clone(),
            unit: problem.unit,
            points: path.points.clone(),
            closed: path.closed,
            tolerance,
            tolerances: path.tolerance.clone().filter(|_| tolerance.is_none()),
            weights: path.weight.clone(),
            timing: path.timing.clone(),
            raw: path.raw.clone().filter(|raw| raw.points.len() <= MOST_RAW),
            types: require.types.clone(),
            transmission_deg_min: require.transmission_deg_min,
            transmission_over: require.transmission_over,
            link_ratio_max: Some(require.link_ratio_max),
            pivots_in: require.pivots_in,
            footprint_in: require.footprint_in,
            order: require.order,
            direction: require.direction,
            circuit: require.circuit,
            branch: require.branch,
            closing: require.closing,
            method: solve.method,
            objective: solve.objective,
            kept,
            expect: problem.expect.clone().map(|answer| Known { of: told(&problem.spec), answer }),
            seed: solve.seed,
            moving: false,
            fresh: false,
        };
        let others = require_lines(require, &ask);
        ask.kept.extend(others);
        match ask.problem() {
            Ok(again) if again.expect != problem.expect => {
                Err(NotHere::Other("what is known of its answer is another when it is read back".into()))
            }
            Ok(again) if again.spec == problem.spec => Ok(ask),
            // Digitised points that are too many to be carried along: what was made of them is the target all the same.
            Ok(again) if without_raw(&again.spec) == without_raw(&problem.spec) => Ok(ask),
            Ok(_) => Err(NotHere::Other("it is another when it is read back".into())),
            Err(why) => Err(NotHere::Other(why)),
        }
    }
}

/// Tells problems apart whose best answers may differ: by target, bounds, requirements and objective.
fn told(spec: &ProblemSpec) -> String {
    let ProblemSpec { task, design, require, solve } = &without_raw(spec);
    let text = serde_json::to_string(&(task, design, require, solve.objective)).unwrap_or_default();
    // FNV-1a.
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}

fn without_raw(spec: &ProblemSpec) -> ProblemSpec {
    let mut spec = spec.clone();
    spec.task.path.raw = None;
    spec
}

/// The keys of a table whose values are not among the defaults, dotted, with their values as they are typed.
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

/// The bounds that a problem gives, without those that the target gives by itself.
fn design_lines(design: &DesignSpec, spec: &ProblemSpec) -> BTreeMap<String, String> {
    let all = table(design);
    let Ok(task) = spec.task.path.to_task() else { return BTreeMap::new() };
    let mut usual = DesignSpec::default();
    usual.resolve(&task);
    let given: toml::Table = {
        let usual = table(&usual);
        all.iter()
            .filter(|(key, value)| usual.get(*key) != Some(value))
            .map(|(k, v)| (k.clone(), v.clone()))
            .collect()
    };
    let again = given.clone().try_into::<DesignSpec>().map(|mut again| {
        again.resolve(&task);
        again
    });
    // Where leaving out what is usual changes something, everything is written.
    let written = if again.as_ref() == Ok(design) { given } else { all };
    differing("design", &written, &toml::Table::new())
}

/// The requirements that a problem gives and the studio has no control for.
fn require_lines(require: &RequireSpec, ask: &Ask) -> BTreeMap<String, String> {
    let shown = table(ask);
    let mut others = table(require);
    others.retain(|key, _| key != RequirementKind::Type.name() && !shown.contains_key(key));
    differing("require", &others, &table(&RequireSpec::default()))
}

/// What a problem says of the search beside method, objective and seed.
fn solve_lines(solve: &SolveSpec) -> BTreeMap<String, String> {
    let default = SolveSpec {
        method: solve.method,
        objective: solve.objective,
        seed: solve.seed,
        ..SolveSpec::default()
    };
    differing("solve", &table(solve), &table(&default))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::problem_file::{load, load_any, parse};
    use crate::mechanism::Unit;
    use std::path::Path;

    fn root() -> &'static Path {
        Path::new(env!("CARGO_MANIFEST_DIR"))
    }

    #[test]
    fn every_problem_of_the_collection_is_carried_through() {
        let (mut count, mut known) = (0, 0);
        for folder in ["examples", "literature", "exact"] {
            for entry in std::fs::read_dir(root().join("problems").join(folder)).expect("a folder") {
                let path = entry.expect("an entry").path();
                if !path.extension().is_some_and(|e| e == "toml" || e == "csv") {
                    continue;
                }
                let problem = load_any(&path, &[]).expect("a problem");
                let ask = Ask::of(&problem).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
                // Over the wire and back.
                let wire: Ask =
                    serde_json::from_str(&serde_json::to_string(&ask).expect("JSON")).expect("JSON");
                assert_eq!(wire, ask);
                let again = wire.problem().expect("a problem");
                assert_eq!(again.spec, problem.spec, "{}", path.display());
                assert_eq!(again.expect, problem.expect, "{}", path.display());
                known += usize::from(again.expect.is_some());
                assert_eq!(
                    (again.name, again.source, again.unit),
                    (problem.name, problem.source, problem.unit)
                );
                count += 1;
            }
        }
        assert!(count > 20 && known > 10, "{count} {known}");
    }

    #[test]
    fn every_key_is_carried_and_only_what_is_given_is_kept() {
        let text = "format = 1\nname = \"all\"\nsource = \"a \\\"book\\\"\"\nunit = \"in\"\n[task.path]\n\
            points = [[0, 0], [1, 1], [2, 1.5], [3, 1]]\ntolerance = [0.1, 0.2, 0.3, 1e-9]\nweight = [1, 2, 1, 1]\n\
            closed = true\ntiming = { crank_deg = [0, 90, 180, 270.5], offset = \"ground\" }\n[design]\nA = [[0, 1], 2]\n\
            a = 1\nb = [1, 2]\nground_angle_deg = [10, 20]\n[require]\ntype = [\"crank-rocker\"]\norder = \"any\"\n\
            circuit = \"any\"\nbranch = \"any\"\nfootprint_in = [-9, -9, 9, 9]\ntransmission_over = \"used\"\n\
            transmission_deg_min = 30\nextent_max = 12\n[solve]\nmethod = \"genetic\"\nobjective = \"max-deviation\"\ncandidates = 3\n\
            evaluations = 1e4\ntime_limit_s = 5\ngenetic.population = 60\n";
        let problem = parse("all", text, None, &[]).expect("a problem");
        let ask = Ask::of(&problem).expect("it fits");
        assert_eq!(ask.problem().expect("a problem").spec, problem.spec);
        let kept: Vec<&str> = ask.kept.keys().map(String::as_str).collect();
        assert_eq!(
            kept,
            [
                "design.A",
                "design.a",
                "design.b",
                "design.ground_angle_deg",
                "require.extent_max",
                "solve.candidates",
                "solve.evaluations",
                "solve.genetic.population",
                "solve.time_limit_s"
            ]
        );
        assert_eq!((ask.kept["design.b"].as_str(), ask.tolerance), ("[1.0, 2.0]", None));
        // Digitised points stay what they were as long as nobody moves one.
        let digitised = load(&root().join("problems/examples/digitised.toml"), &[]).expect("a problem");
        let mut ask = Ask::of(&digitised).expect("it fits");
        assert!(ask.problem().expect("a problem").spec.task.path.raw.is_some());
        ask.points[0][0] += 1.0;
        let moved = ask.problem().expect("a problem").spec.task.path;
        assert!(moved.raw.is_none() && moved.points == ask.points);
    }

    #[test]
    fn what_is_known_of_an_answer_holds_for_its_problem_alone() {
        let problem = load(&root().join("problems/literature/k18.toml"), &[]).expect("a problem");
        let ask = Ask::of(&problem).expect("it fits");
        let expect = |ask: &Ask| ask.problem().expect("a problem").expect;
        assert!(problem.expect.as_ref().is_some_and(|known| known.published.len() == 3));
        // Of how it is searched, and of what it is called, the answer does not depend.
        let mut same = Ask { name: "other".into(), seed: 9, unit: Some(Unit::Mm), ..ask.clone() };
        same.kept.insert("solve.evaluations".into(), "1000".into());
        assert_eq!(expect(&same), problem.expect);
        let mut moved = ask.clone();
        moved.points[3][0] += 1e-9;
        let mut bounded = ask.clone();
        bounded.kept.insert("design.a".into(), "[0, 40]".into());
        let required = Ask { transmission_deg_min: Some(30.0), ..ask.clone() };
        let untimed = Ask { timing: None, ..ask.clone() };
        for other in [&moved, &bounded, &required, &untimed] {
            assert_eq!(expect(other), None);
            assert!(!other.problem_text().expect("a text").contains("expect"));
        }
        // And back.
        moved.points = ask.points;
        assert_eq!(expect(&moved), problem.expect);
        // What it says is written as what it is.
        let known = moved.expect.as_mut().expect("known");
        known.answer.published[0].source = "x\"\n[task.path]\nfile = \"/etc/passwd".into();
        let again = expect(&moved).expect("known");
        assert!(again.published[0].source.starts_with("x\"\n[task"));
        moved.expect.as_mut().expect("known").answer.best_known_sum_sq = Some(-1.0);
        assert!(moved.problem().is_err());
    }

    #[test]
    fn what_is_kept_says_nothing_else() {
        let problem = load(&root().join("problems/examples/pivot-box.toml"), &[]).expect("a problem");
        let ask = Ask::of(&problem).expect("it fits");
        for (key, value) in [
            ("task.path.file", "\"/etc/passwd\""),
            ("design.a", "1\n[task.path]\nfile = \"/etc/passwd\""),
            ("design.a]\n[x", "1"),
            ("design.", "1"),
            ("design.a", ""),
            ("solve.seed", "7"),
            ("design.nonsense", "1"),
            ("design.a", "-1"),
        ] {
            let mut asked = ask.clone();
            asked.kept.insert(key.into(), value.into());
            assert!(asked.problem().is_err(), "{key} = {value}");
        }
    }

    #[test]
    fn numbers_of_any_size_come_back() {
        for value in [0.0, -0.0, 1.5, 1e-7, -3e11, 1e12 / 3.0, 5e-324, 123_456_789.125] {
            let text = format!("x = {}", Typed(value));
            let table: toml::Table = text.parse().expect("TOML");
            let again = table["x"].as_float().or_else(|| table["x"].as_integer().map(|i| i as f64));
            assert_eq!(again, Some(value), "{text}");
        }
    }
}
