//! Converts a tab's edit to the text of a problem file, and a problem file to an edit.

use super::kept::{POLYGON, kept};
use super::messages::{Ask, Known};
use super::tables::{ASKED, HEAD, RENAMED, Typed, tables_of};
use super::targets::{BodyAsk, FunctionAsk};
use crate::files::diagnostic::Diagnostic;
use crate::files::problem_file::{self, ProblemFile};
use crate::mechanism::MAX_MAGNITUDE;
use crate::task::region::Region;
use crate::task::spec::{ProblemSpec, RawPoints};
use crate::task::{AngleOffset, TaskError, TaskKind};
use std::collections::BTreeMap;

/// The most points of a target in the studio.
pub const MOST_POINTS: usize = 1000;
/// The most digitised points that are carried along with the target that was made from them.
const MOST_RAW: usize = 2000;
/// The fewest points of a path in the studio.
const FEWEST_POINTS: usize = 3;
/// The fewest poses of a motion and pairs of a function.
const FEWEST_TARGETS: usize = 2;

/// The reason why a problem cannot be opened in the studio.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NotHere {
    /// Too few points or too many.
    #[error(
        "this target has {0} points and the studio shows {FEWEST_POINTS} to {MOST_POINTS}: run it with `linkwright \
         synth`, or write `samples = 60` in [task.path] to take that many along it"
    )]
    Points(usize),
    /// Too few poses of a motion, or pairs of a function, or too many.
    #[error(
        "this target has {0} {1}s and the studio shows {FEWEST_TARGETS} to {MOST_POINTS}: run it with `linkwright synth`"
    )]
    Targets(usize, &'static str),
    /// Some crank angles are prescribed and others free.
    #[error("the studio has no free crank angles among given ones: run it with `linkwright synth`")]
    PartlyTimed,
    /// A function of linkages with a slider.
    #[error("the studio draws functions of four-bars alone: run it with `linkwright synth`")]
    OfSliders,
    /// The ranges of a function are free.
    #[error("the studio has no free ranges of functions: run it with `linkwright synth`")]
    FreeRanges,
    /// The problem has loads.
    #[error("the studio has no loads: run it with `linkwright synth`")]
    Loads,
    /// The problem is another one after it is converted to an edit and back.
    #[error("the studio cannot hold all of this problem ({0}): run it with `linkwright synth`")]
    Other(String),
}

/// The reason why a message or a text asks no problem.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AskError {
    /// Too few points or too many in an edit.
    #[error("a target has {FEWEST_POINTS} to {MOST_POINTS} points here, and this one has {0}")]
    Points(usize),
    /// Too few poses or pairs in an edit, or too many.
    #[error("a target has {FEWEST_TARGETS} to {MOST_POINTS} {1}s here, and this one has {0}")]
    Targets(usize, &'static str),
    /// An edit asks for a function of linkages with a slider.
    #[error("the studio draws functions of four-bars alone: leave `mechanism` out")]
    OfSliders,
    /// An edit with a body has another number of angles than of points.
    #[error("{0} poses have {1} angles: `body.angle_deg` has one for each, null where only the place counts")]
    Angles(usize, usize),
    /// An edit with a body and a function.
    #[error("an edit has a `body` or a `function`, not both")]
    TwoKinds,
    /// Too many points in the text of a problem.
    #[error("at most {MOST_POINTS} points: this target has more")]
    TooManyPoints,
    /// A text is no report with a problem in it.
    #[error("this is no report that holds its problem: `linkwright report RESULT` writes one")]
    NoReport,
    /// Too few samples along a drawing or too many.
    #[error("{0} points along a drawing: 3 to {MOST_POINTS} can be taken")]
    Samples(usize),
    /// The seed is too large for a problem file.
    #[error("the seed is at most {}", i64::MAX)]
    Seed,
    /// A kept key is under another table than `design`, `require` and `solve`.
    #[error("{0:.60} cannot be kept: keys under design, require and solve can")]
    KeptKey(String),
    /// The text of a kept key is not a single value.
    #[error("{key} is kept with a value that is none of a problem file: {text:.60}")]
    KeptValue {
        /// The key.
        key: String,
        /// The text.
        text: String,
    },
    /// The edit cannot be written as a problem file.
    #[error(transparent)]
    NotWritten(#[from] toml::ser::Error),
    /// The problem of an edit is invalid; it has no lines.
    #[error("{}", without_line(.0))]
    Problem(Box<Diagnostic>),
    /// A text is invalid.
    #[error("{}", said(.0))]
    Text(Box<Diagnostic>),
    /// The task is invalid.
    #[error(transparent)]
    Task(#[from] TaskError),
    /// The studio cannot hold the problem of a text.
    #[error(transparent)]
    NotHere(#[from] NotHere),
    /// A job is asked for by an edit and by a text, or by neither.
    #[error("give either `ask` or `problem`")]
    NotOne,
    /// A key is set that is not under `solve`.
    #[error("`set` takes keys of [solve] such as solve.evaluations, not {0:?}")]
    Set(String),
}

/// `line 3: the cell of y is empty: give its value or leave the row out`
pub(super) fn said(diagnostic: &Diagnostic) -> String {
    let line = diagnostic.line_column().map_or(String::new(), |(line, _)| format!("line {line}: "));
    line + &without_line(diagnostic)
}

fn without_line(Diagnostic { message, help, .. }: &Diagnostic) -> String {
    help.as_ref().map_or_else(|| message.clone(), |help| format!("{message}: {help}"))
}

/// Returns the pairs of the text of a problem with a function.
fn pairs_of(text: &str) -> Option<Vec<[f64; 2]>> {
    Some(problem_file::parse("drawing", text, None, &[]).ok()?.spec.task.pairs())
}

/// Returns whether pairs are the same up to rounding: the last digit of a function is not the same in a browser and here.
fn agree(pairs: &[[f64; 2]], others: &[[f64; 2]]) -> bool {
    let largest = others.iter().flatten().fold(0.0_f64, |most, x| most.max(x.abs()));
    let mut both = pairs.iter().flatten().zip(others.iter().flatten());
    pairs.len() == others.len() && both.all(|(x, y)| (x - y).abs() <= 1e-12 * largest)
}

/// Writes one value of TOML anew; a text that is not exactly one value is refused.
fn one_value(key: &str, text: &str) -> Result<String, AskError> {
    let parsed: Result<toml::Table, _> = format!("value = {text}").parse();
    let value = parsed.ok().filter(|table| table.len() == 1).and_then(|mut table| table.remove("value"));
    let refused = || AskError::KeptValue { key: key.to_owned(), text: text.to_owned() };
    value.map(|value| value.to_string()).ok_or_else(refused)
}

impl Ask {
    /// Returns the text of the problem file that asks the same.
    ///
    /// # Errors
    /// [`AskError`] if a part of it cannot be written there: of [`kept`](Ask::kept) everything but keys and values under
    /// `design`, `require` and `solve`.
    pub fn problem_text(&self) -> Result<String, AskError> {
        let mut text = None;
        if let Some(by_formula) =
            self.function.as_ref().and_then(|function| function.by_formula(&self.points))
        {
            // The formula is written where it still gives the pairs.
            text = by_formula
                .into_iter()
                .filter_map(|keys| self.text_with(keys).ok())
                .find(|text| pairs_of(text).is_some_and(|pairs| agree(&pairs, &self.points)));
        }
        let mut text = text.map_or_else(|| self.text_with(self.target_keys()), Ok)?;
        text.extend(self.expect_text(&text));
        Ok(text)
    }

    /// Returns the kind of the task.
    fn kind(&self) -> TaskKind {
        match (&self.body, &self.function) {
            (_, Some(_)) => TaskKind::Function,
            (Some(_), None) => TaskKind::Motion,
            (None, None) => TaskKind::Path,
        }
    }

    /// Returns the keys of the targets of a motion or of a function; none of a path.
    fn target_keys(&self) -> toml::Table {
        let of_body = || self.body.as_ref().map(|body| body.keys(&self.points));
        let of_function = self.function.as_ref().map(|function| function.keys(&self.points));
        of_function.or_else(of_body).unwrap_or_default()
    }

    /// Returns the text of the problem without its known answer, with these keys of its targets.
    fn text_with(&self, targets: toml::Table) -> Result<String, AskError> {
        let kept = self.kept_lines()?;
        let mut table = self.as_table()?;
        table.extend(targets);
        let given = toml::Value::Table(table);
        let mut text = String::from("# Drawn in linkwright's studio.\nformat = 1\n");
        for (table, keys) in [HEAD].into_iter().chain(tables_of(self.kind())).chain(ASKED) {
            let typed = keys.iter().filter_map(|path| {
                let value = path.split('.').try_fold(&given, |value, key| value.get(key))?;
                let (_, key) = path.rsplit_once('.').unwrap_or(("", path));
                Some(format!("{key} = {}\n", Typed(value)))
            });
            let kept = kept.iter().filter(|(place, _)| *place == table).map(|(_, line)| line.clone());
            let lines: String = typed.chain(kept).collect();
            if !table.is_empty() && (!lines.is_empty() || table == "require") {
                text.push_str(&format!("\n[{table}]\n"));
            }
            text.push_str(&lines);
        }
        Ok(text)
    }

    /// Returns the edit under the names of a problem file, without values that a file need not give.
    fn as_table(&self) -> Result<toml::Table, toml::ser::Error> {
        let raw = self.raw_of_points().cloned();
        let points = raw.as_ref().map_or(&self.points, |raw| &raw.points).clone();
        let (body, function) = (None, None);
        let mut table =
            toml::Table::try_from(Ask { version: 0, points, raw, body, function, ..self.clone() })?;
        for (asked, key) in RENAMED {
            if let Some(value) = table.remove(asked) {
                table.insert(key.to_owned(), value);
            }
        }
        if self.types.is_empty() {
            table.remove("type");
        }
        let timing = table.get_mut("timing").and_then(toml::Value::as_table_mut);
        if self.timing.as_ref().is_some_and(|timing| timing.offset == AngleOffset::default()) {
            timing.map(|timing| timing.remove("offset"));
        }
        Ok(table)
    }

    /// Returns the table of the known answer if `text` asks the problem that it belongs to.
    fn expect_text(&self, text: &str) -> Option<String> {
        let known = self.expect.as_ref()?;
        let asked = problem_file::parse("drawing", text, None, &[]).ok()?;
        let table = BTreeMap::from([("expect", &known.answer)]);
        let text = (told(&asked.spec) == known.of).then(|| toml::to_string(&table).ok())??;
        Some(format!("\n{text}"))
    }

    /// Returns the lines of the kept keys, each with its table.
    fn kept_lines(&self) -> Result<Vec<(&'static str, String)>, AskError> {
        let plain = |key: &&str| {
            !key.is_empty() && key.chars().all(|c| c.is_ascii_alphanumeric() || "._-".contains(c))
        };
        let line = |(key, value): (&String, &String)| {
            let mut places = ["design", "require", "solve"].into_iter();
            let found = places.find_map(|table| Some((table, key.strip_prefix(table)?.strip_prefix('.')?)));
            let (table, rest) =
                found.filter(|(_, rest)| plain(rest)).ok_or_else(|| AskError::KeptKey(key.clone()))?;
            Ok((table, format!("{rest} = {}\n", one_value(key, value)?)))
        };
        // A box takes the place of a polygon.
        let stays = |(key, _): &(&String, &String)| self.pivots_in.is_none() || *key != POLYGON;
        self.kept.iter().filter(stays).map(line).collect()
    }

    /// Returns the digitised points if the target is still what smoothing and resampling make of them.
    fn raw_of_points(&self) -> Option<&RawPoints> {
        let within = |raw: &&RawPoints| {
            let smooth = raw.smooth.is_none_or(|deviation| deviation > 0.0 && deviation.is_finite());
            let samples = raw.samples.is_none_or(|samples| (2..=MOST_POINTS).contains(&samples));
            let finite = raw.points.iter().flatten().all(|value| value.abs() <= MAX_MAGNITUDE);
            smooth && samples && finite && (2..=MOST_RAW).contains(&raw.points.len())
        };
        self.raw.as_ref().filter(within).filter(|raw| raw.target(self.closed) == self.points)
    }

    /// Returns the problem that is asked, read as every problem file is.
    ///
    /// # Errors
    /// [`AskError`].
    pub fn problem(&self) -> Result<ProblemFile, AskError> {
        self.problem_with_text().map(|(problem, _)| problem)
    }

    /// Returns the problem that is asked with the text of its file.
    ///
    /// # Errors
    /// [`AskError`].
    pub fn problem_with_text(&self) -> Result<(ProblemFile, String), AskError> {
        let (n, kind) = (self.points.len(), self.kind());
        match (&self.body, kind) {
            (Some(_), TaskKind::Function) => return Err(AskError::TwoKinds),
            (_, TaskKind::Path) if !(FEWEST_POINTS..=MOST_POINTS).contains(&n) => {
                return Err(AskError::Points(n));
            }
            (_, TaskKind::Path) => {}
            _ if !(FEWEST_TARGETS..=MOST_POINTS).contains(&n) => {
                return Err(AskError::Targets(n, kind.noun()));
            }
            (Some(body), _) if body.angle_deg.len() != n => {
                return Err(AskError::Angles(n, body.angle_deg.len()));
            }
            _ => {}
        }
        if self.seed > i64::MAX as u64 {
            return Err(AskError::Seed);
        }
        let text = self.problem_text()?;
        let problem = problem_file::parse("drawing", &text, None, &[]).map_err(AskError::Problem)?;
        if problem.spec.task.output.is_some() && !problem.spec.design.is_of_four_bars() {
            return Err(AskError::OfSliders);
        }
        Ok((problem, text))
    }

    /// Returns the edit that asks a problem, with everything that its file says.
    ///
    /// # Errors
    /// [`NotHere`] if the studio cannot hold it.
    pub fn of(problem: &ProblemFile) -> Result<Ask, NotHere> {
        let ProblemSpec { task: path, require, solve, design, loads: _ } = &problem.spec;
        if path.output.is_some() && !design.is_of_four_bars() {
            return Err(NotHere::OfSliders);
        }
        if problem.spec.loads.is_some() {
            return Err(NotHere::Loads);
        }
        if path.timing.as_ref().is_some_and(|timing| !timing.free.is_empty()) {
            return Err(NotHere::PartlyTimed);
        }
        if path.output.as_ref().is_some_and(|output| output.ranges.is_free()) {
            return Err(NotHere::FreeRanges);
        }
        let (n, kind) = (path.len(), path.kind());
        let fewest = if kind == TaskKind::Path { FEWEST_POINTS } else { FEWEST_TARGETS };
        if !(fewest..=MOST_POINTS).contains(&n) {
            return Err(match kind {
                TaskKind::Path => NotHere::Points(n),
                TaskKind::Motion | TaskKind::Function => NotHere::Targets(n, kind.noun()),
            });
        }
        let tolerance = same(path.tolerance.as_deref());
        let is_function = kind == TaskKind::Function;
        let ask = Ask {
            name: problem.name.clone(),
            source: problem.source.clone(),
            unit: problem.unit,
            points: if is_function { path.pairs() } else { path.points.clone() },
            closed: path.closed,
            body: BodyAsk::of(path),
            function: FunctionAsk::of(path),
            tolerance,
            tolerances: path.tolerance.clone().filter(|_| tolerance.is_none()),
            weights: path.weight.clone(),
            timing: path.timing.clone().filter(|_| !is_function),
            raw: path.raw.clone().filter(|raw| raw.points.len() <= MOST_RAW),
            mechanism: design.mechanism.clone(),
            types: require.types.clone(),
            input: require.input,
            stroke: require.stroke,
            time_ratio: require.time_ratio,
            transmission_deg_min: require.transmission_deg_min,
            transmission_over: require.transmission_over,
            link_ratio_max: Some(require.link_ratio_max),
            pivots_in: require.pivots_in.as_ref().and_then(Region::as_box),
            footprint_in: require.footprint_in,
            order: require.order,
            direction: require.direction,
            circuit: require.circuit,
            branch: require.branch,
            closing: require.closing,
            method: solve.method,
            objective: solve.objective,
            kept: kept(&problem.spec),
            expect: problem.expect.clone().map(|answer| Known { of: told(&problem.spec), answer }),
            seed: solve.seed,
            ..Ask::default()
        };
        match ask.problem() {
            Ok(again) if again.expect != problem.expect => {
                Err(NotHere::Other("what is known of its answer is another when it is read back".into()))
            }
            Ok(again) if again.spec == problem.spec => Ok(ask),
            // Too many digitised points to be carried along: the target that was made of them is the same.
            Ok(again) if without_raw(&again.spec) == without_raw(&problem.spec) => Ok(ask),
            // The same pairs, whose formula is not found again in their ranges.
            Ok(again) if without_formula(&again.spec) == without_formula(&problem.spec) => Ok(ask),
            Ok(_) => Err(NotHere::Other("it is another when it is read back".into())),
            Err(why) => Err(NotHere::Other(why.to_string())),
        }
    }
}

/// Returns a hash that differs for problems whose best answers may differ: by target, bounds, requirements, objective.
fn told(spec: &ProblemSpec) -> String {
    let ProblemSpec { task, design, require, solve, loads } = &without_raw(spec);
    let mut text = serde_json::to_string(&(task, design, require, solve.objective)).unwrap_or_default();
    text.extend(loads.as_ref().and_then(|loads| serde_json::to_string(loads).ok()));
    // FNV-1a.
    let hash = text.bytes().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}

/// Returns the value that all of a list have.
pub(super) fn same(list: Option<&[f64]>) -> Option<f64> {
    let all = list?.first().copied()?;
    Some(all).filter(|all| list.into_iter().flatten().all(|value| value == all))
}

fn without_formula(spec: &ProblemSpec) -> ProblemSpec {
    let mut spec = spec.clone();
    if let Some(output) = &mut spec.task.output {
        output.of = None;
    }
    spec
}

fn without_raw(spec: &ProblemSpec) -> ProblemSpec {
    let mut spec = spec.clone();
    spec.task.raw = None;
    spec
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
        let (mut count, mut known, mut sliders, mut kinds) = (0, 0, 0, [0; 3]);
        for folder in ["examples", "literature", "exact", "motion", "function", "sliders"] {
            for entry in std::fs::read_dir(root().join("problems").join(folder)).expect("a folder") {
                let path = entry.expect("an entry").path();
                if !path.extension().is_some_and(|e| e == "toml" || e == "csv") {
                    continue;
                }
                let problem = load_any(&path, &[]).expect("a problem");
                if problem.spec.task.timing.as_ref().is_some_and(|timing| !timing.free.is_empty()) {
                    assert!(matches!(Ask::of(&problem), Err(NotHere::PartlyTimed)), "{}", path.display());
                    continue;
                }
                if problem.spec.task.output.as_ref().is_some_and(|output| output.ranges.is_free()) {
                    assert!(matches!(Ask::of(&problem), Err(NotHere::FreeRanges)), "{}", path.display());
                    continue;
                }
                if problem.spec.loads.is_some() {
                    assert!(matches!(Ask::of(&problem), Err(NotHere::Loads)), "{}", path.display());
                    continue;
                }
                let has_sliders = !problem.spec.design.is_of_four_bars();
                sliders += usize::from(has_sliders);
                if has_sliders && problem.spec.task.output.is_some() {
                    assert!(matches!(Ask::of(&problem), Err(NotHere::OfSliders)), "{}", path.display());
                    continue;
                }
                let ask = Ask::of(&problem).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
                // Over the wire and back.
                let wire: Ask =
                    serde_json::from_str(&serde_json::to_string(&ask).expect("JSON")).expect("JSON");
                assert_eq!(wire, ask);
                let again = wire.problem().expect("a problem");
                assert_eq!(again.spec, problem.spec, "{}", path.display());
                assert_eq!(again.expect, problem.expect, "{}", path.display());
                known += usize::from(again.expect.is_some());
                kinds[again.spec.task.kind() as usize] += 1;
                assert_eq!(
                    (again.name, again.source, again.unit),
                    (problem.name, problem.source, problem.unit)
                );
                count += 1;
            }
        }
        assert!(count > 20 && known > 10, "{count} {known}");
        assert!(kinds[1] >= 14 && kinds[2] >= 7 && sliders >= 3, "{kinds:?} {sliders}");
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
        assert!(ask.problem().expect("a problem").spec.task.raw.is_some());
        ask.points[0][0] += 1.0;
        let moved = ask.problem().expect("a problem").spec.task;
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
    fn the_longest_link_is_kept_only_where_it_is_not_the_default() {
        let of = |lines: &str| {
            let text = format!("format = 1\n[task.path]\npoints = [[0, 0], [3, 4], [3, 1]]\n{lines}");
            let problem = parse("arm", &text, None, &[]).expect("a problem");
            let ask = Ask::of(&problem).expect("it fits");
            assert_eq!(ask.problem().expect("a problem").spec, problem.spec);
            (ask.kept.get("require.longest_max").cloned(), problem.spec.require.longest_max, ask)
        };
        let (kept, longest, mut ask) = of("");
        assert_eq!((kept, longest), (None, Some(15.0)));
        ask.points[1] = [6.0, 8.0];
        assert_eq!(
            ask.problem().expect("a problem").spec.require.longest_max,
            Some(30.0),
            "it follows the size"
        );
        let any = Some("\"any\"".to_owned());
        assert_eq!(of("[require]\nlongest_max = \"any\"\n").0, any);
        assert_eq!(of("[require]\nlongest_max = 7\n").0, Some("7.0".to_owned()));
        assert_eq!(of("[require]\nlongest_max = 15\n").0, None);
        // Bounds that a file gives although they are the usual ones leave it without a limit.
        assert_eq!(of("[design]\na = [0.1, 25]\n").0, any);
        assert_eq!(of("[design]\na = [0.2, 25]\n").0, None);
        assert_eq!(of("[require]\nextent_max = 90\n").0, None);
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
}
