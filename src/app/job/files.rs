//! The files of a result's folder, as bytes: pure functions of the record, apart from its times.
//!
//! `linkage-N.toml` and `curve-N.csv` belong to the candidate of rank N; if the record has a front, to its N-th member
//! instead. The picks' files have their names in place of a number. `candidate-N.svg` is always the drawing of the
//! candidate of rank N.

use crate::app::inputs::MEMBER;
use crate::app::job::folder::{FRONT_CSV, FRONT_HTML, RECORD, TIMING};
use crate::app::job::run::AdviceSeconds;
use crate::files::linkage_file;
use crate::files::name;
use crate::record::{Candidate, Pick, Record};
use crate::report::html::Extent;
use crate::report::{contact_sheet, csv, exact_sheet, html, svg};

/// The contents of `timing.json`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Timing {
    /// The time of the search, in seconds.
    pub search_s: f64,
    /// The time for everything that is computed beside the candidates, in seconds.
    pub beside_s: f64,
    /// The times of the parts of `beside_s`, in seconds; `None` if no advice was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub advice_s: Option<AdviceSeconds>,
    /// The total time, in seconds.
    pub total_s: f64,
    /// The number of threads.
    pub threads: usize,
}

impl Timing {
    /// Returns the total time, the time of the search, and that of each other part that took a millisecond or more, in
    /// words.
    ///
    /// ```
    /// use linkwright::internals::app::job::files::Timing;
    /// use linkwright::internals::app::job::run::AdviceSeconds;
    /// let advice_s = AdviceSeconds { conflicts: 85.5, ..AdviceSeconds::default() };
    /// let timing = Timing { search_s: 13.189, beside_s: 85.5, advice_s: Some(advice_s), total_s: 98.9, threads: 2 };
    /// let words = "98.900 s in all: 13.189 s of search, 85.500 s for what conflicts, 0.211 s for reading and writing";
    /// assert_eq!(timing.words(), words);
    /// ```
    pub fn words(&self) -> String {
        let advice = self.advice_s.unwrap_or_default();
        let others = [
            (advice.picks, "picks"),
            (advice.costs, "what limits cost"),
            (advice.conflicts, "what conflicts"),
            (advice.buildable, "what can be built"),
            (advice.front, "the front"),
            (self.total_s - self.search_s - self.beside_s, "reading and writing"),
        ];
        let others = others.into_iter().filter(|(seconds, _)| *seconds >= WORTH_SAYING_S);
        let mut parts = vec![format!("{:.3} s of search", self.search_s)];
        parts.extend(others.map(|(seconds, name)| format!("{seconds:.3} s for {name}")));
        format!("{:.3} s in all: {}", self.total_s, parts.join(", "))
    }
}

/// The shortest time of a part that is mentioned in words, in seconds.
const WORTH_SAYING_S: f64 = 1e-3;

/// The error of a record that cannot be written as data.
#[derive(Debug, thiserror::Error)]
#[error("the record cannot be written as JSON: {0}")]
pub struct NotJson(#[from] serde_json::Error);

/// Returns the contents of `record.json`.
///
/// # Errors
/// [`NotJson`] if the record cannot be written as data.
pub fn record_json(record: &Record) -> Result<Vec<u8>, NotJson> {
    json(record)
}

fn json(data: &impl serde::Serialize) -> Result<Vec<u8>, NotJson> {
    Ok((serde_json::to_string_pretty(data)? + "\n").into_bytes())
}

/// Returns the name and the contents of every file of a result's folder.
///
/// # Errors
/// [`NotJson`] if the record cannot be written as data.
pub fn files(record: &Record, timing: &Timing) -> Result<Vec<(String, Vec<u8>)>, NotJson> {
    files_of(record, timing, Extent::Full)
}

/// Returns the files as [`files`] does, with a page of this extent.
///
/// # Errors
/// As [`files`].
pub fn files_of(record: &Record, timing: &Timing, extent: Extent) -> Result<Vec<(String, Vec<u8>)>, NotJson> {
    let mut files = vec![
        (RECORD.to_string(), record_json(record)?),
        (TIMING.to_string(), json(timing)?),
        ("candidates.csv".to_string(), csv::candidates_csv(record).into_bytes()),
    ];
    for Listed { file, name, candidate } in listed(record) {
        let (named, unit) = (linkage_name(record, &name), record.problem.unit);
        let toml = linkage_file::to_toml_with(
            &named,
            unit,
            &candidate.linkage,
            linkage_file::Carried::of(candidate),
        );
        files.push((format!("linkage-{file}.toml"), toml.into_bytes()));
        files.push((format!("curve-{file}.csv"), csv::candidate_curve_csv(candidate).into_bytes()));
    }
    let drawings: Vec<String> = (0..record.candidates.len()).map(|i| svg::candidate_svg(record, i)).collect();
    if record.candidates.len() > 1 {
        let sheet = contact_sheet::contact_sheet_svg(record);
        files.push(("contact-sheet.svg".into(), sheet.into_bytes()));
    }
    if record.exact.as_ref().is_some_and(|exact| !exact.linkages.is_empty()) {
        files.push(("exact.svg".into(), exact_sheet::exact_svg(record).into_bytes()));
    }
    let drawn: Vec<&str> = drawings.iter().map(String::as_str).collect();
    files.push(("report.html".into(), html::report_with_drawings(record, 0, &drawn, extent).into_bytes()));
    files
        .extend((1..).zip(drawings).map(|(n, drawing)| (format!("candidate-{n}.svg"), drawing.into_bytes())));
    for (pick, candidate) in picks(record) {
        let drawing = svg::drawing_svg(record, Some(candidate));
        files.push((format!("candidate-{}.svg", pick.name()), drawing.into_bytes()));
    }
    if record.front.is_some() {
        files.push((FRONT_CSV.into(), csv::front_csv(record).into_bytes()));
        files.push((FRONT_HTML.into(), html::front_html(record).into_bytes()));
    }
    Ok(files)
}

/// A linkage with files of its own.
struct Listed<'a> {
    /// The part of the names of its files: `2` or `smallest`.
    file: String,
    /// The part of its own name, as after the colon in `results/egg:front-2`.
    name: String,
    candidate: &'a Candidate,
}

/// Returns the linkages with files of their own.
fn listed(record: &Record) -> Vec<Listed<'_>> {
    let numbered = |(candidate, n): (_, usize), prefix: &str| Listed {
        file: n.to_string(),
        name: format!("{prefix}{n}"),
        candidate,
    };
    let mut listed: Vec<Listed<'_>> = match &record.front {
        Some(front) => {
            let members = front.members.iter().map(|member| &member.candidate);
            members.zip(1..).map(|member| numbered(member, MEMBER)).collect()
        }
        None => record.candidates.iter().zip(1..).map(|ranked| numbered(ranked, "")).collect(),
    };
    listed.extend(picks(record).map(|(pick, candidate)| {
        let name = pick.name().to_owned();
        Listed { file: name.clone(), name, candidate }
    }));
    listed
}

/// Returns the picks that are not the closest candidate itself.
fn picks(record: &Record) -> impl Iterator<Item = (Pick, &Candidate)> {
    let all = Pick::ALL.into_iter().filter_map(|pick| Some((pick, record.pick(pick)?)));
    all.filter(|(_, candidate)| candidate.rank != 1)
}

/// Returns the name in the linkage file of a candidate: the problem's name with the candidate's rank (or
/// `buildable`, `front-2`).
pub fn linkage_name(record: &Record, which: &str) -> String {
    name::with_suffix(&name::legal(&record.problem.name, "linkage"), &format!("-{which}"))
}
