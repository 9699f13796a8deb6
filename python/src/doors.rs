//! Everything else that the command line does but proofs: compare, analyze, cognates, build, snap, export, suite.

use crate::chain::Chain;
use crate::errors::{guarded, refused};
use crate::linkage::FourBar;
use crate::problem::Problem;
use crate::run::Run;
use crate::slider::SliderLinkage;
use crate::waiting::{Ended, carrying, run, run_whole};
use crate::{pools, values};
use linkwright::internals::app::balancing::{Asked, Means, NotBalanced, Subject as Balancing};
use linkwright::internals::app::building::Sizes;
use linkwright::internals::app::comparison::{self, NotCompared, Target};
use linkwright::internals::app::inputs::{self, Given};
use linkwright::internals::app::snapping::{
    NoKey, Subject as Snapping, fixed, kept_key, length_key, pitches as read_pitches, set_key, to_snap,
};
use linkwright::internals::app::suite::choice::{chosen, collection};
use linkwright::internals::app::suite::{Options as SuiteOptions, Step, suite as run_suite};
use linkwright::internals::files::linkage_file::{self, AnyLinkageFile, LinkageFile};
use linkwright::internals::files::schema::{SchemaKind, schema as schema_of};
use linkwright::internals::files::{loads_file, name, shop_file};
use linkwright::internals::mechanism::analysis::driven::{MechanismRequest, analyze_mechanism};
use linkwright::internals::mechanism::analysis::{
    PositionMethod, Request as Analysis, analyze as analyze_four_bar, full_turn,
};
use linkwright::internals::mechanism::loads::balance::MassAim;
use linkwright::internals::mechanism::loads::{Drive, LoadFault, Loads};
use linkwright::internals::mechanism::plates::Shop;
use linkwright::internals::mechanism::{CrankLinkage, Linkage, Unit};
use linkwright::internals::report::Colour;
use linkwright::internals::report::analysis_csv::analysis_csv;
use linkwright::internals::report::analysis_sheets::analysis_svg;
use linkwright::internals::report::analysis_text::analysis_table;
use linkwright::internals::report::compare::SortKey;
use linkwright::internals::report::mechanism_sheet::mechanism_svg;
use linkwright::internals::report::mechanism_text::{mechanism_csv, mechanism_table};
use linkwright::internals::report::snap::snap_text;
use linkwright::internals::report::suite::{suite_markdown, suite_text};
use linkwright::internals::synthesis::snap::{
    Request as SnapRequest, Stock, record as snap_record, snap as snapped,
};
use linkwright::internals::synthesis::{Budget, Context};
use linkwright::internals::task::spec::CertifySpec;
use linkwright::{ExportFormat, ExportSettings, ExportSubject, export as write_export};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Returns what an argument names: a path, a linkage, or a run with the choice of its linkages.
pub fn given(subject: &Bound<'_, PyAny>, which: Option<&str>) -> PyResult<Given> {
    if let Ok(run) = subject.cast::<Run>() {
        return run.get().given(which);
    }
    if let Ok(linkage) = subject.cast::<FourBar>() {
        let LinkageFile { name, unit, linkage } = linkage.get().file.clone();
        return Ok(Given::Linkage(Box::new(LinkageFile { name, unit, linkage: linkage.into() })));
    }
    if let Ok(chain) = subject.cast::<Chain>() {
        let Chain { name, text, .. } = chain.get();
        return Ok(Given::Linkage(Box::new(linkage_file::parse_crank_linkage(name, text).map_err(refused)?)));
    }
    if let Ok(linkage) = subject.cast::<SliderLinkage>() {
        let SliderLinkage { name, unit, linkage } = linkage.get().clone();
        return Ok(Given::Linkage(Box::new(LinkageFile { name, unit, linkage })));
    }
    let path: PathBuf = subject.extract().map_err(|_| unfit(subject))?;
    inputs::read(&path).map_err(refused)
}

/// Returns the linkage, of any kind, that an argument names.
fn any_linkage(subject: &Bound<'_, PyAny>, which: Option<&str>) -> PyResult<AnyLinkageFile> {
    if let Ok(chain) = subject.cast::<Chain>() {
        let Chain { name, unit, chain, .. } = chain.get();
        let linkage = Linkage::Chain(Box::new(chain.clone()));
        return Ok(LinkageFile { name: name.clone(), unit: *unit, linkage });
    }
    if let Ok(run) = subject.cast::<Run>() {
        return run.get().any_linkage(which.unwrap_or("1"));
    }
    if let Ok(linkage) = subject.cast::<FourBar>() {
        let LinkageFile { name, unit, linkage } = linkage.get().file.clone();
        return Ok(LinkageFile { name, unit, linkage: Linkage::FourBar(linkage) });
    }
    if let Ok(linkage) = subject.cast::<SliderLinkage>() {
        let SliderLinkage { name, unit, linkage } = linkage.get().clone();
        return Ok(LinkageFile { name, unit, linkage: linkage.into() });
    }
    let path: PathBuf = subject.extract().map_err(|_| unfit(subject))?;
    inputs::read_linkage(&path).map_err(refused)
}

/// Returns the loads of a linkage: a dict with the keys of `[loads]`, or a path; of a linkage file without either its own.
fn loads_of(
    subject: &Bound<'_, PyAny>,
    loads: Option<&Bound<'_, PyAny>>,
    file: &AnyLinkageFile,
) -> PyResult<Option<Loads>> {
    let Some(given) = loads else {
        let Ok(path) = subject.extract::<PathBuf>() else { return Ok(None) };
        return inputs::read_loaded_linkage(&path).map(|(_, loads)| loads).map_err(refused);
    };
    if let Ok(path) = given.extract::<PathBuf>() {
        return loads_file::load(&path, file).map(Some).map_err(refused);
    }
    let unit = file
        .unit
        .ok_or_else(|| refused("loads: the linkage has no unit of length; give unit=\"mm\" with it"))?;
    let text = file_text("loads", given, Some(unit))?;
    loads_file::parse("loads", &text, file).map(Some).map_err(refused)
}

/// Returns the one linkage of an input, with its unit.
fn one_linkage(given: &Given) -> PyResult<(CrankLinkage, Option<Unit>)> {
    Ok(match given {
        Given::Linkage(file) => (file.linkage, file.unit),
        Given::Run(run) => (run.one().map_err(refused)?.candidate.linkage, run.record.problem.unit),
    })
}

/// Returns the shop data of a linkage: a dict with the keys of `[shop]`, or a path; of a linkage file without either its own.
fn shop_of(
    subject: &Bound<'_, PyAny>,
    shop: Option<&Bound<'_, PyAny>>,
    linkage: &CrankLinkage,
    unit: Option<Unit>,
) -> PyResult<Option<Shop>> {
    let Some(given) = shop else {
        let Ok(path) = subject.extract::<PathBuf>() else { return Ok(None) };
        return inputs::read_shop(&path).map_err(refused);
    };
    if let Ok(path) = given.extract::<PathBuf>() {
        return shop_file::load(&path, linkage).map(Some).map_err(refused);
    }
    let text = file_text("shop", given, unit)?;
    shop_file::parse("shop", &text, Some(linkage)).map(Some).map_err(refused)
}

/// Returns a dict as the text of a file with one table.
fn file_text(table: &str, given: &Bound<'_, PyAny>, unit: Option<Unit>) -> PyResult<String> {
    let mut whole = toml::Table::new();
    whole.insert("format".into(), 1.into());
    if let Some(unit) = unit {
        whole.insert("unit".into(), unit.label().into());
    }
    whole.insert(table.into(), toml::Value::Table(values::table(given)?));
    toml::to_string(&whole).map_err(refused)
}

fn unfit(subject: &Bound<'_, PyAny>) -> PyErr {
    let kind = subject.get_type().name().map_or_else(|_| "that".into(), |name| name.to_string());
    PyTypeError::new_err(format!("a result, a candidate, a linkage or a path is needed, not {kind}"))
}

/// Reads the linkage of a file: a four-bar or a chain.
///
/// Raises ProblemError: the file is refused; the text names the line, the fault and the remedy.
#[pyfunction]
pub fn load<'py>(py: Python<'py>, path: PathBuf) -> PyResult<Bound<'py, PyAny>> {
    guarded(|| {
        let file = linkage_file::load_any(&path).map_err(refused)?;
        let text = std::fs::read_to_string(&path).map_err(refused)?;
        of_file(py, file, text)
    })
}

/// Reads the linkage of a text in the format of a linkage file.
#[pyfunction]
pub fn parse_linkage<'py>(py: Python<'py>, text: String) -> PyResult<Bound<'py, PyAny>> {
    guarded(|| of_file(py, linkage_file::parse_any("linkage", &text).map_err(refused)?, text))
}

fn of_file<'py>(py: Python<'py>, file: AnyLinkageFile, text: String) -> PyResult<Bound<'py, PyAny>> {
    let LinkageFile { name, unit, linkage } = file;
    Ok(match linkage {
        Linkage::FourBar(linkage) => {
            Bound::new(py, FourBar { file: LinkageFile { name, unit, linkage } })?.into_any()
        }
        Linkage::MultiLoop(linkage) => Bound::new(py, Chain::of(name, unit, &linkage)?)?.into_any(),
        Linkage::Chain(chain) => Bound::new(py, Chain { name, unit, chain: *chain, text })?.into_any(),
        Linkage::SliderCrank(linkage) => {
            let linkage = CrankLinkage::SliderCrank(linkage);
            Bound::new(py, SliderLinkage { name, unit, linkage })?.into_any()
        }
        Linkage::InvertedSliderCrank(linkage) => {
            let linkage = CrankLinkage::InvertedSliderCrank(linkage);
            Bound::new(py, SliderLinkage { name, unit, linkage })?.into_any()
        }
    })
}

/// Puts results and linkages side by side: JSON, table, CSV, SVG and page.
#[pyfunction]
#[pyo3(signature = (subjects, target = None, sort = Vec::new(), reference = None))]
pub fn compare<'py>(
    py: Python<'py>,
    subjects: Vec<(Bound<'py, PyAny>, Option<String>, String)>,
    target: Option<&Bound<'py, Problem>>,
    sort: Vec<String>,
    reference: Option<usize>,
) -> PyResult<[String; 5]> {
    guarded(|| {
        let read = subjects
            .iter()
            .map(|(subject, which, label)| Ok((PathBuf::from(label), given(subject, which.as_deref())?)));
        let given = read.collect::<PyResult<Vec<(PathBuf, Given)>>>()?;
        let target =
            target.map(|problem| Target::new(problem.get().file().clone())).transpose().map_err(refused)?;
        let keys =
            sort.iter().map(|key| key.parse()).collect::<Result<Vec<SortKey>, _>>().map_err(refused)?;
        if reference.is_some_and(|i| i >= given.len()) {
            return Err(refused("the reference is none of the inputs"));
        }
        let compared = run_whole(py, move |_| {
            let given: Vec<(&Path, Given)> =
                given.iter().map(|(path, one)| (path.as_path(), one.clone())).collect();
            let reference = reference.map(|i| match &given[i].1 {
                Given::Run(run) => run.one().map(|chosen| chosen.label).map_err(|e| e.to_string()),
                Given::Linkage(_) => Ok(comparison::label_of_file(&given, i)),
            });
            let reference = reference.transpose()?;
            let found = comparison::compared(&given, target.as_ref(), &keys, reference.as_deref());
            let found = found.map_err(|why| match why {
                NotCompared::Nothing(left_out) => {
                    let mut lines: Vec<String> =
                        left_out.iter().map(|out| format!("{}: {}", out.label, out.why)).collect();
                    lines.push("none of these results has a candidate to compare".to_owned());
                    lines.join("\n")
                }
                why => why.to_string(),
            })?;
            Ok::<_, String>([
                found.json(),
                found.table(Colour::Never),
                found.csv(),
                found.svg(),
                found.html(),
            ])
        })?;
        compared.map_err(refused)
    })
}

/// Analyses a linkage: JSON, table, CSV and sheets as SVG.
#[pyfunction]
#[pyo3(signature = (subject, which, crank_deg, cycle, omega, alpha, methods, all_configurations, loads = None))]
#[expect(clippy::too_many_arguments, reason = "the options of the command")]
pub fn analyze<'py>(
    py: Python<'py>,
    subject: &Bound<'py, PyAny>,
    which: Option<&str>,
    crank_deg: Option<Vec<f64>>,
    cycle: usize,
    omega: Option<f64>,
    alpha: f64,
    methods: Vec<String>,
    all_configurations: bool,
    loads: Option<&Bound<'py, PyAny>>,
) -> PyResult<[String; 4]> {
    guarded(|| {
        let file = any_linkage(subject, which)?;
        let loads = loads_of(subject, loads, &file)?;
        let LinkageFile { name, unit, linkage } = file;
        if !(1..=100_000).contains(&cycle) {
            return Err(refused(format!("cycle = {cycle}: 1 to 100000 are possible")));
        }
        let crank_deg = crank_deg.unwrap_or_else(|| full_turn(cycle));
        let told = |fault: LoadFault| refused(format!("{fault}; {}", fault.remedy()));
        let input = Drive::chosen(omega, alpha, loads.as_ref()).map_err(told)?;
        let methods: Result<Vec<PositionMethod>, _> = methods.iter().map(|m| m.parse()).collect();
        let methods = methods.map_err(refused)?;
        match linkage {
            Linkage::FourBar(linkage) => {
                let request = Analysis { name, unit, linkage, crank_deg, input, methods, all_configurations };
                run_whole(py, move |_| {
                    let mut found = analyze_four_bar(&request);
                    if let Some(loads) = &loads {
                        found.add_loads(loads).map_err(|e| e.to_string())?;
                    }
                    let json = serde_json::to_string(&found).map_err(|e| e.to_string())?;
                    Ok::<_, String>([
                        json,
                        analysis_table(&found, Colour::Never),
                        analysis_csv(&found),
                        analysis_svg(&found),
                    ])
                })?
                .map_err(refused)
            }
            other if all_configurations || !methods.is_empty() => Err(refused(format!(
                "all_configurations and method are for four-bars; this is {}, whose signs stand in its file",
                linkage_file::kind_in_words(&other)
            ))),
            linkage => {
                let request = MechanismRequest { name, unit, linkage, crank_deg, input };
                run_whole(py, move |_| {
                    let mut found = analyze_mechanism(&request);
                    if let Some(loads) = &loads {
                        found.add_loads(&request.linkage, loads).map_err(|e| e.to_string())?;
                    }
                    let json = serde_json::to_string(&found).map_err(|e| e.to_string())?;
                    let svg = mechanism_svg(&found, &request.linkage);
                    Ok::<_, String>([
                        json,
                        mechanism_table(&found, Colour::Never),
                        mechanism_csv(&found),
                        svg,
                    ])
                })?
                .map_err(refused)
            }
        }
    })
}

/// Balances a loaded linkage by a spring, a torsion spring or counter-masses: JSON, text, and the balanced loads as a file.
#[pyfunction]
#[pyo3(signature = (subject, which, means, names, over_deg, rates, least_free_length, radius, even, omega, loads = None))]
#[expect(clippy::too_many_arguments, reason = "the options of the command")]
pub fn balance<'py>(
    py: Python<'py>,
    subject: &Bound<'py, PyAny>,
    which: Option<&str>,
    means: &str,
    names: Vec<String>,
    over_deg: Option<[f64; 2]>,
    rates: Vec<f64>,
    least_free_length: f64,
    radius: Option<f64>,
    even: &str,
    omega: Option<f64>,
    loads: Option<&Bound<'py, PyAny>>,
) -> PyResult<([String; 2], Bound<'py, PyAny>)> {
    guarded(|| {
        let told = |why: NotBalanced| match why.option() {
            Some(option) => refused(format!("{option}: {why}")),
            None => refused(why),
        };
        let file = any_linkage(subject, which)?;
        let loads = loads_of(subject, loads, &file)?;
        let means = match (means, names.as_slice()) {
            ("spring", [from, to]) => Means::Spring([from.clone(), to.clone()]),
            ("torsion", [body]) => Means::Torsion([body.clone(), "ground".to_owned()]),
            ("torsion", [body, against]) => Means::Torsion([body.clone(), against.clone()]),
            ("masses", _) => Means::Masses(names),
            (means, _) => {
                return Err(refused(format!("{means}: give two ends of a spring, or one or two bodies")));
            }
        };
        let aim = match even {
            "torque" => MassAim::Torque,
            "shaking-force" => MassAim::ShakingForce,
            "both" => MassAim::Both,
            _ => return Err(refused(format!("even = {even:?}: choose from torque, shaking-force, both"))),
        };
        let asked = Asked { means, over_deg, rates, least_free_length, radius, aim, speed_rad_s: omega };
        let subject = Balancing::new(file, loads).map_err(told)?;
        let (found, subject) = run_whole(py, move |_| (subject.balance(&asked), subject))?;
        let found = found.map_err(told)?;
        let texts = [found.json().map_err(refused)?, subject.text(&found, Colour::Never)];
        let file: toml::Table = toml::from_str(&subject.loads_file(&found)).map_err(refused)?;
        let loads = serde_json::to_value(file.get("loads")).map_err(refused)?;
        Ok((texts, values::to_python(py, &loads)?))
    })
}

/// Returns what it takes to build a linkage: figures and text.
#[pyfunction]
#[pyo3(signature = (subject, which = None, hole = None, margin = None, tolerance = None, shop = None))]
pub fn build<'py>(
    py: Python<'py>,
    subject: &Bound<'py, PyAny>,
    which: Option<&str>,
    hole: Option<f64>,
    margin: Option<f64>,
    tolerance: Option<f64>,
    shop: Option<&Bound<'py, PyAny>>,
) -> PyResult<(Bound<'py, PyAny>, String)> {
    guarded(|| {
        for (key, size) in [("hole", hole), ("margin", margin), ("tolerance", tolerance)] {
            if let Some(size) = size.filter(|size| !(*size > 0.0 && size.is_finite())) {
                return Err(refused(format!("{key} = {size}: a number above 0 is needed")));
            }
        }
        let given = given(subject, which)?;
        let linkage = one_linkage(&given)?;
        let shop = shop_of(subject, shop, &linkage.0, linkage.1)?;
        let sizes = Sizes { hole, margin, ..Sizes::default() };
        let found = run_whole(py, move |_| crate::building::built(given, shop, &sizes, tolerance))?;
        let (figures, text) = found.map_err(refused)?;
        Ok((values::to_python(py, &figures)?, text))
    })
}

/// Brings lengths to stock sizes; the run of the snapped linkages, and the text.
#[pyfunction]
#[pyo3(signature = (subject, which, grid, lengths, pitches, snap, keep, set, threads = None))]
#[expect(clippy::too_many_arguments, reason = "the options of the command")]
pub fn snap<'py>(
    py: Python<'py>,
    subject: &Bound<'py, PyAny>,
    which: Option<&str>,
    grid: Option<f64>,
    lengths: Option<Vec<f64>>,
    pitches: Option<PathBuf>,
    snap: Option<Vec<String>>,
    keep: Vec<String>,
    set: Vec<(String, f64)>,
    threads: Option<i64>,
) -> PyResult<(Run, String)> {
    guarded(|| {
        let stock = match (grid, &lengths, &pitches) {
            (Some(step), None, None) => Stock::grid(step).map_err(refused)?,
            (None, Some(lengths), None) => Stock::list(lengths).map_err(refused)?,
            (None, None, Some(file)) => read_pitches(file).map_err(refused)?,
            _ => return Err(refused("give the stock: one of grid, lengths and pitches")),
        };
        let of_key = |key: &str, why: NoKey| refused(format!("{key}: {why}"));
        let named = |key: &String| length_key(key).map_err(|why| of_key(key, why));
        let asked = snap.map(|snap| snap.iter().map(named).collect::<PyResult<Vec<_>>>()).transpose()?;
        for key in &keep {
            kept_key(key).map_err(|why| of_key(key, why))?;
        }
        for (key, value) in &set {
            let length = set_key(key).map_err(|why| of_key(key, why))?;
            if !value.is_finite() || (length && *value <= 0.0) {
                return Err(refused(format!("{key} = {value}: a number above 0 is needed")));
            }
        }
        let subject = Snapping::of(given(subject, which)?).map_err(refused)?;
        let linkage = &subject.candidate.linkage;
        let fixed = fixed(linkage, &keep, &set).map_err(refused)?;
        let lengths = to_snap(linkage, asked.as_deref()).map_err(refused)?;
        let wanted = subject.problem.spec().solve.candidates;
        let request = SnapRequest { stock, lengths, fixed, wanted };
        let Ended { value, interrupt } = run(py, pools::threads(threads)?, None, move |talk| {
            let budget = Budget::new(&talk.cancel, None);
            let found = snapped(Context::new(&subject.problem, &budget), &subject.candidate, &request)
                .map_err(|e| e.to_string())?;
            let named = name::with_suffix(&name::legal(&subject.name, "linkage"), "-snapped");
            let Snapping { source, unit, .. } = subject;
            let record = snap_record(&subject.problem, &named, source, unit, &request, &found)
                .map_err(|e| e.to_string())?;
            let text = snap_text(&subject.candidate, &request, &found, unit, Colour::Never);
            Ok::<_, String>((record, text))
        })?;
        match (value, interrupt) {
            (Err(_), Some(interrupt)) => Err(interrupt),
            (Err(why), None) => Err(refused(why)),
            (Ok((record, _)), Some(interrupt)) => {
                Err(carrying(py, interrupt, Bound::new(py, Run::of(record))?.into_any()))
            }
            (Ok((record, text)), None) => Ok((Run::of(record), text)),
        }
    })
}

/// Writes a linkage in a format: the bytes, and the assumptions that were made.
#[pyfunction]
#[pyo3(signature = (subject, which, format, settings, shop = None))]
pub fn export<'py>(
    py: Python<'py>,
    subject: &Bound<'py, PyAny>,
    which: Option<&str>,
    format: &str,
    settings: Vec<(String, String)>,
    shop: Option<&Bound<'py, PyAny>>,
) -> PyResult<(Bound<'py, PyBytes>, Vec<String>)> {
    guarded(|| {
        let format: ExportFormat = format.parse().map_err(refused)?;
        let helped = |refusal: linkwright::ExportRefusal| {
            let place = refusal.setting.map_or(String::new(), |(key, value)| format!("{key}={value}: "));
            refused(format!("{place}{}\nhelp: {}", refusal.message, refusal.help))
        };
        let settings = ExportSettings::parse(format, &settings).map_err(helped)?;
        if shop.is_some() && !format.settings().contains(&"hole_mm") {
            let name = format.name();
            return Err(refused(format!("shop means nothing for {name}, which has no holes: leave it out")));
        }
        let given = given(subject, which)?;
        let linkage = one_linkage(&given)?;
        let shop = shop_of(subject, shop, &linkage.0, linkage.1)?;
        let subject = match given {
            Given::Linkage(file) => ExportSubject { shop, ..ExportSubject::of_linkage(&file) },
            Given::Run(run) => {
                let candidate = run.one().map_err(refused)?.candidate;
                ExportSubject::of_candidate_for_shop(&run.record, candidate, shop)
            }
        };
        let made = run_whole(py, move |_| write_export(&subject, format, &settings))?.map_err(helped)?;
        Ok((PyBytes::new(py, &made.bytes), made.notes))
    })
}

/// The names of the export formats.
#[pyfunction]
pub fn export_formats() -> Vec<&'static str> {
    ExportFormat::ALL.iter().map(|format| format.name()).collect()
}

/// Runs the suite: JSON, text and Markdown.
#[pyfunction]
#[pyo3(signature = (filter, seeds, problems = None, certify = false, progress = None))]
pub fn suite<'py>(
    py: Python<'py>,
    filter: String,
    seeds: u64,
    problems: Option<PathBuf>,
    certify: bool,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<[String; 3]> {
    guarded(|| {
        if !(1..=100_000).contains(&seeds) {
            return Err(refused(format!("seeds = {seeds}: 1 to 100000 are possible")));
        }
        let known = chosen(problems.as_deref(), &filter).map_err(refused)?;
        let Ended { value, interrupt } = run(py, 1, progress, move |talk| {
            let certify = certify.then(CertifySpec::default);
            let filter = if filter.is_empty() { String::new() } else { format!("{filter:?}, ") };
            let folder =
                problems.as_ref().map(|folder| format!(", problems={:?}", folder.display().to_string()));
            let command = format!("linkwright.suite({filter}seeds={seeds}{})", folder.unwrap_or_default());
            let collection = problems.as_deref().and_then(collection);
            let options = SuiteOptions { seeds, command, collection, certify, ..SuiteOptions::default() };
            let observer = |step: &Step<'_>| {
                talk.tell(|| {
                    json!({ "phase": step.problem, "method": step.method.name(), "seed": step.seed,
                            "done": step.done, "total": step.total })
                });
            };
            let found = run_suite(&known, &options, &talk.cancel, &observer).map_err(|e| e.to_string())?;
            let json = serde_json::to_string(&found).map_err(|e| e.to_string())?;
            Ok::<_, String>([json, suite_text(&found, Colour::Never), suite_markdown(&found)])
        })?;
        match interrupt {
            None => value.map_err(refused),
            Some(interrupt) => match value {
                Ok(found) => Err(carrying(py, interrupt, found.into_pyobject(py)?.into_any())),
                Err(_) => Err(interrupt),
            },
        }
    })
}

/// The JSON Schema of a kind of file: problem, linkage or record.
#[pyfunction]
pub fn schema<'py>(py: Python<'py>, kind: &str) -> PyResult<Bound<'py, PyAny>> {
    guarded(|| {
        let kind: SchemaKind = kind.parse().map_err(refused)?;
        values::to_python(py, &schema_of(kind))
    })
}

/// Runs the command line with these words, the first of which is the program's name; the exit code.
#[cfg(feature = "command")]
#[pyfunction]
pub fn main(py: Python<'_>, words: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| linkwright::internals::app::cli::main_of(words))
}

/// Panics inside of the search's thread pool, for a test that the border holds.
#[pyfunction]
pub fn _panic(py: Python<'_>) -> PyResult<()> {
    guarded(|| run_whole(py, |_| -> () { std::panic::panic_any("a test of the border") }))
}

/// Panics on the calling thread, likewise.
#[pyfunction]
pub fn _panic_here() -> PyResult<()> {
    guarded(|| std::panic::panic_any("a test of the border"))
}
