//! The files of a result's folder, as bytes: pure functions of the record, apart from its times.

use crate::app::job::folder::BUILDABLE;
use crate::app::job::run::AdviceSeconds;
use crate::files::linkage_file;
use crate::files::name;
use crate::record::Record;
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
            (advice.costs, "what limits cost"),
            (advice.conflicts, "what conflicts"),
            (advice.buildable, "what can be built"),
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
    let json = |text: Result<String, serde_json::Error>| text.map(|text| (text + "\n").into_bytes());
    let mut files = vec![
        ("record.json".to_string(), json(serde_json::to_string_pretty(record))?),
        ("timing.json".to_string(), json(serde_json::to_string_pretty(timing))?),
        ("candidates.csv".to_string(), csv::candidates_csv(record).into_bytes()),
    ];
    let ranked = record.candidates.iter().zip(1..).map(|(c, n): (_, usize)| (n.to_string(), c));
    let buildable = record.buildable.iter().map(|c| (BUILDABLE.to_owned(), c));
    for (which, c) in ranked.chain(buildable) {
        let toml = linkage_file::to_toml(&linkage_name(record, &which), record.problem.unit, &c.linkage);
        files.push((format!("linkage-{which}.toml"), toml.into_bytes()));
        files.push((format!("curve-{which}.csv"), csv::candidate_curve_csv(c).into_bytes()));
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
    Ok(files)
}

/// Returns the name in the linkage file of a candidate: the problem's name with the candidate's rank (or `buildable`).
pub fn linkage_name(record: &Record, which: &str) -> String {
    name::with_suffix(&name::legal(&record.problem.name, "linkage"), &format!("-{which}"))
}
