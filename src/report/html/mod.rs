//! A run as an HTML page in one file: the linkage moving over its target, with every figure and verdict.
//!
//! ```text
//! page.rs         the file: policy, style, script, data; sections, paragraphs, lists
//! data.rs         the data of the player, as JSON; motion.rs: the drive of each mechanism; track.rs: samples of several loops
//! body.rs         the page's sections in their order; a new section is a line there
//! table.rs        candidates side by side
//! candidate.rs    one candidate in words: mobility.rs, requirements.rs, dimensions.rs
//! loads.rs        the torque on the crank of one candidate, and the forces of its joints
//! function.rs     the function of one candidate: its graph, the error, the pairs
//! picks.rs        the closest, the smallest, the best transmitting and the buildable linkage side by side
//! extras.rs       the linkages that the page shows beside the ranked candidates
//! practicality.rs layers, clearances and sensitivities of the linkages that one would build
//! exact.rs        every linkage through nine points
//! proof.rs        the certificate, and the number of times the best answer was found
//! front.rs        the page of a front, with its scatter plot in scatter.rs
//! player/body.mjs the body of a motion over the player's drawing
//! player/*.mjs    position solver, drawing, charts, transport: independent of this page
//! report.mjs, report.css    the page around the player
//! ```
//!
//! All words are written here, for every candidate, so that the page can be read without its script too. The script
//! draws, plays, sorts and shows one candidate at a time. Nothing in the page refers to a place on a network.

use crate::mechanism::LinkageKeys;
use crate::record::{ProblemRecord, Record};
use serde::Deserialize;

mod body;
mod candidate;
mod data;
mod dimensions;
mod exact;
mod extras;
mod front;
mod function;
mod loads;
mod mobility;
mod motion;
pub(super) mod page;
mod picks;
mod practicality;
mod proof;
mod requirements;
mod scatter;
pub(super) mod table;
mod track;

pub use extras::Shown;
pub use front::front_html;
pub use motion::{Drive, DriveKind};
pub use track::Track;

/// The player's modules, each after those that it imports.
pub(super) const PLAYER: [&str; 9] = [
    include_str!("player/kinematics.mjs"),
    include_str!("player/sliders.mjs"),
    include_str!("player/drive.mjs"),
    include_str!("player/svg.mjs"),
    include_str!("player/tracks.mjs"),
    include_str!("player/cycle.mjs"),
    include_str!("player/stage.mjs"),
    include_str!("player/chart.mjs"),
    include_str!("player/player.mjs"),
];
/// The modules of the report alone: drawings of sliders and of several loops, the body of a motion, the page.
const REPORT: [&str; 5] = [
    include_str!("player/guide.mjs"),
    include_str!("player/slider_stage.mjs"),
    include_str!("player/loops.mjs"),
    include_str!("player/body.mjs"),
    include_str!("report.mjs"),
];
/// The style sheet of the player, with its colours.
pub(super) const PLAYER_STYLE: &str = include_str!("player/player.css");

/// Returns the report of a record as [`report_showing`] does, with its candidate `first` (counted from 0) shown first.
pub fn report_html(record: &Record, first: usize) -> String {
    report_showing(record, Shown::Candidate(first))
}

/// Returns the report of a record: a whole HTML file.
///
/// It is a pure function of the record. It is made for records that [`verify`](crate::judge::verify::verify) accepts and shows
/// any other without harm. Of more than 400 target points the player gets 400; there are drawings for readers without a
/// script for the first ten candidates.
pub fn report_showing(record: &Record, shown: Shown) -> String {
    let drawn: Vec<String> =
        (0..candidate::drawn(record)).map(|i| super::svg::candidate_svg(record, i)).collect();
    let drawn: Vec<&str> = drawn.iter().map(String::as_str).collect();
    page_with_drawings(record, shown, &drawn, Extent::Full)
}

/// The extent of a page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The whole page.
    Full,
    /// The page without the parts that take milliseconds to compute (layers, clearances): for one job of many.
    Brief,
}

/// Returns the report as [`report_html`] does, for a caller who has the candidates' drawings already:
/// [`candidate_svg`](super::svg::candidate_svg) of each, in their order, is most of the work.
pub fn report_with_drawings(record: &Record, first: usize, drawings: &[&str], extent: Extent) -> String {
    page_with_drawings(record, Shown::Candidate(first), drawings, extent)
}

fn page_with_drawings(record: &Record, shown: Shown, drawings: &[&str], extent: Extent) -> String {
    let modules = [&PLAYER[..], &REPORT[..]].concat();
    page::Page {
        title: &format!("{}: linkages", super::words::problem_name(record)),
        styles: &[PLAYER_STYLE, include_str!("report.css")],
        body: body::body(record, drawings, extent, shown),
        data: &page::embedded(&data::Data::new(record, shown)),
        modules: &modules,
    }
    .render()
}

/// A report's problem, and the linkage that it shows first.
#[derive(Clone, Debug)]
pub struct Held {
    /// The problem; `None` if it has more than 1000 points, of which the report holds some.
    pub problem: Option<ProblemRecord>,
    /// The linkage; `None` if nothing was found.
    pub linkage: Option<LinkageKeys>,
}

/// Returns what a report holds; `None` if the text is no report, nor the data of one.
pub fn held(text: &str) -> Option<Held> {
    #[derive(Deserialize)]
    struct Shown {
        key: String,
        linkage: LinkageKeys,
    }
    #[derive(Deserialize)]
    struct Data {
        first: String,
        mechanisms: Vec<Shown>,
        problem: Option<ProblemRecord>,
    }
    // The last element of this kind: no text of a record can write markup, and none stands behind.
    let data = match text.rsplit_once(r#"<script type="application/json" id="data">"#) {
        Some((_, after)) => after.split_once("</script>")?.0,
        None => text,
    };
    let Data { first, mechanisms, problem } = serde_json::from_str(data).ok()?;
    let linkage = mechanisms.into_iter().find(|one| one.key == first).map(|one| one.linkage);
    Some(Held { problem, linkage })
}

/// Returns the report's header on the whole run, as markup: the outcome, the obstacles, and the changes that would
/// help.
pub fn summary_markup(record: &Record) -> String {
    page::visible(body::header(record))
}

/// Returns the report on one candidate, as markup: figures, mobility, warnings, requirements with their costs,
/// dimensions, cognates. `index` counts from 0.
pub fn candidate_markup(record: &Record, index: usize) -> Option<String> {
    candidate::one(record, index).map(page::visible)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn all_modules() -> Vec<&'static str> {
        PLAYER.into_iter().chain(REPORT).collect()
    }

    /// The modules are joined into one scope, in which two declarations of one name would silently shadow each other.
    #[test]
    fn no_name_is_declared_twice_at_the_top_of_the_modules() {
        let script = page::joined(&all_modules());
        let mut names = BTreeSet::new();
        for line in script.lines() {
            let mut words = line.split([' ', '(', '=', ';']).filter(|word| !word.is_empty());
            if let Some("function" | "const" | "let" | "class") = line.split(' ').next() {
                let name = words.nth(1).expect("a name");
                assert!(names.insert(name.to_owned()), "{name} is declared twice");
            }
        }
        assert!(names.contains("positionAt") && names.contains("Player"));
    }

    #[test]
    fn scripts_and_styles_can_stand_in_a_page() {
        for text in all_modules().into_iter().chain([PLAYER_STYLE, include_str!("report.css")]) {
            for end in
                ["</script", "</style", "<!--", "innerHTML", "outerHTML", "insertAdjacentHTML", "eval("]
            {
                assert!(!text.contains(end), "{end}");
            }
        }
        // The conditions on which the joining relies.
        for line in all_modules().into_iter().flat_map(str::lines) {
            let trimmed = line.trim_start();
            assert!(!trimmed.starts_with("import ") || (line == trimmed && line.ends_with(';')), "{line}");
            let export = line.strip_prefix("export ").unwrap_or("function");
            assert!(["function", "const", "class"].iter().any(|word| export.starts_with(word)), "{line}");
        }
    }
}
