//! A suite for the terminal and as Markdown: the same tables in two formats.

use super::grid::{Align, Colour, Grid, Ink};
use super::table::COLUMNS;
use super::text::{brief, clean, clean_sentence, grouped, percent_up, shortened, significant, wrapped};
use crate::record::suite::{MethodResult, ProblemResult, PublishedResult, Suite};

/// The mark of a problem with a sum that is smaller than the best known.
const SMALLER: &str = " *";
/// The number of digits of figures that are stated one by one.
const DIGITS: usize = 10;
/// The text for a missing figure.
const NOTHING: &str = "-";
/// The width of a problem's name on a terminal, in columns.
const NAME: usize = 30;

const WHAT: &str = "sum of sq: the least sum of squared distances at the crank angles, of all seeds; median: \
    of the accepted answers of all seeds; to curve: the sum of squared distances of the points to the best \
    answer's whole curve; hits: seeds whose answer is accepted and reaches the best known sum, or the goal \
    where one is set, within 1e-6 of it; evaluations: of the objective, median.";
const TIMES: &str = "ms: the median and the worst time of a search, of one thread, from the checked problem \
    to ranked, refereed candidates; times depend on the machine, the other figures do not.";
const PROVED: &str = "proved gap: no linkage of the kind that is told below has a sum of squares more than this below the \
    least one found.";
const BESIDE: &str = "printed, re-evaluated: the best published answer's sum as printed (where that could be \
    read in the source) and by our referee; genetic, diff. evolution: their median sum over accepted answers, \
    after as many evaluations as the search above used in the median, and how many seeds had one.";

/// A table before it is formatted.
struct Sheet {
    heads: &'static [(&'static str, Align)],
    rows: Vec<Vec<String>>,
}

impl Sheet {
    fn text(self, colour: Colour) -> String {
        let mut grid = Grid::new(self.heads);
        for row in self.rows {
            let ink = |cell: &String| if cell.ends_with(SMALLER) { Ink::Good } else { Ink::Plain };
            grid.row(row.into_iter().map(|cell| (shortened(&cell, NAME), ink(&cell))).collect());
        }
        grid.render(colour)
    }

    fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut out = line(self.heads.iter().map(|(head, _)| (*head).to_owned()).collect());
        let rule = |align: &Align| if *align == Align::Right { "---:" } else { "---" };
        out.push_str(&line(self.heads.iter().map(|(_, align)| rule(align).to_owned()).collect()));
        for row in &self.rows {
            out.push_str(&line(row.iter().map(|cell| markdown(cell)).collect()));
        }
        out
    }
}

/// Returns foreign text as Markdown on one line, with its markup characters escaped.
fn markdown(text: &str) -> String {
    unmarked(&clean(text))
}

/// Returns clean text with its markup characters escaped.
fn unmarked(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        if matches!(c, '|' | '*' | '_' | '`' | '<' | '[' | '\\' | '#') {
            out.push('\\');
        }
        out.push(c);
    }
    out
}

/// Returns a suite as text: the answers, the comparisons, and the notes.
pub fn suite_text(suite: &Suite, colour: Colour) -> String {
    let mut out = String::new();
    if !suite.problems.is_empty() {
        out.push_str(&answers(suite).text(colour));
        out.push('\n');
        out.push_str(&beside(suite).text(colour));
        out.push('\n');
        for what in [WHAT, TIMES, BESIDE] {
            out.push_str(&wrapped("  ", "    ", what, COLUMNS));
        }
        let proofs = proofs(suite);
        let first = Some(PROVED.to_owned()).filter(|_| !proofs.is_empty());
        for told in first.into_iter().chain(proofs) {
            out.push_str(&wrapped("  ", "    ", &told, COLUMNS));
        }
    }
    let notes = notes(suite);
    if !notes.is_empty() {
        out.push('\n');
    }
    for note in notes {
        out.push_str(&wrapped("  ", "    ", &note, COLUMNS));
    }
    out
}

/// Returns a suite as a Markdown page, with the command that makes it again and every published figure with its source.
pub fn suite_markdown(suite: &Suite) -> String {
    let paragraph = |text: &str| wrapped("", "", text, COLUMNS + 10) + "\n";
    let mut out = String::from("# Problems of the literature: what is found\n\n");
    out.push_str(&paragraph(&format!(
        "Written by linkwright {}; to make this page and its JSON again:",
        clean(&suite.tool.version)
    )));
    out.push_str(&format!("```sh\n{}\n```\n\n", clean(&suite.command)));
    out.push_str(&paragraph(&format!(
        "Each problem from seeds 1 to {}, one candidate asked for, everything else as its file says. Every sum \
         is our referee's, of answers that meet the problem's bounds and requirements. Times are of one thread \
         of whatever machine this ran on.",
        suite.seeds
    )));
    out.push_str("## The answers\n\n");
    out.push_str(&answers(suite).markdown());
    out.push('\n');
    out.push_str(&paragraph(WHAT));
    out.push_str(&paragraph(TIMES));
    if is_certified(suite) {
        out.push_str(&paragraph(PROVED));
        for proof in proofs(suite) {
            out.push_str(&wrapped("- ", "  ", &unmarked(&proof), COLUMNS + 10));
        }
        out.push('\n');
    }
    let notes = notes(suite);
    for note in &notes {
        out.push_str(&wrapped("- ", "  ", &markdown(note), COLUMNS + 10));
    }
    if !notes.is_empty() {
        out.push('\n');
    }
    out.push_str("## Beside them\n\n");
    out.push_str(&beside(suite).markdown());
    out.push('\n');
    out.push_str(&paragraph(BESIDE));
    out.push_str("## What was published\n\n");
    out.push_str(&paragraph(
        "Each vector as it is stored in the problem file, evaluated by our referee under the problem's timing. A \
         printed figure stands only where it could be read in the source.",
    ));
    out.push_str(&published(suite).markdown());
    out
}

/// Returns whether certificates were asked for.
fn is_certified(suite: &Suite) -> bool {
    suite.problems.iter().any(|p| p.certificate.is_some() || p.no_certificate.is_some())
}

/// Returns a sentence for each certificate, and for each one that is not possible.
fn proofs(suite: &Suite) -> Vec<String> {
    let told = |problem: &ProblemResult| {
        let name = clean(&problem.name);
        match (&problem.certificate, &problem.no_certificate) {
            (Some(proof), _) if proof.lower_bound > 0.0 => Some(format!(
                "{name}: {}. {}",
                if proof.closed { "proved" } else { "proved so far" },
                clean_sentence(&proof.statement)
            )),
            (Some(_), _) => Some(format!("{name}: nothing is proved yet; the time was over.")),
            (None, Some(why)) => Some(format!("{name}: {}.", clean_sentence(why))),
            (None, None) => None,
        }
    };
    suite.problems.iter().filter_map(told).collect()
}

fn answers(suite: &Suite) -> Sheet {
    use Align::{Left, Right};
    let row = |problem: &ProblemResult| {
        let summary = &problem.search.summary;
        let best = summary.best.as_ref();
        let gap = problem.certificate.as_ref().filter(|proof| proof.lower_bound > 0.0);
        let mark = if problem.smaller_than_best_known.is_some() { SMALLER } else { "" };
        let of = problem.search.runs.len();
        let mut cells = vec![
            format!("{}{mark}", clean(&problem.name)),
            number(best.map(|best| best.sum_sq), 6),
            significant(problem.best_known_sum_sq, 6),
            number(summary.median_sum_sq, 6),
            number(best.and_then(|best| best.to_curve_sum_sq), 4),
            format!("{}/{of}", summary.hits),
            number(summary.median_search_s.map(|s| 1e3 * s), 3),
            number(summary.worst_search_s.map(|s| 1e3 * s), 3),
            summary.median_evaluations.map_or(NOTHING.into(), grouped),
        ];
        if is_certified(suite) {
            cells.push(gap.map_or(NOTHING.into(), |proof| format!("{} %", percent_up(proof.gap))));
        }
        cells
    };
    const HEADS: [(&str, Align); 10] = [
        ("problem", Left),
        ("sum of sq", Right),
        ("best known", Right),
        ("median", Right),
        ("to curve", Right),
        ("hits", Right),
        ("median ms", Right),
        ("worst ms", Right),
        ("evaluations", Right),
        ("proved gap", Right),
    ];
    Sheet {
        heads: if is_certified(suite) { &HEADS } else { &HEADS[..HEADS.len() - 1] },
        rows: suite.problems.iter().map(row).collect(),
    }
}

fn beside(suite: &Suite) -> Sheet {
    use Align::{Left, Right};
    let row = |problem: &ProblemResult| {
        let best = problem.best_published.as_ref();
        let mut cells = vec![
            clean(&problem.name),
            number(problem.search.summary.median_sum_sq, 6),
            best.map_or(NOTHING.into(), printed),
            number(best.and_then(|entry| entry.sum_sq), 6),
        ];
        for population in &problem.populations {
            cells.push(number(population.summary.median_sum_sq, 6));
            cells.push(format!("{}/{}", population.summary.accepted, population.runs.len()));
        }
        cells
    };
    Sheet {
        heads: &[
            ("problem", Left),
            ("median", Right),
            ("printed", Right),
            ("re-evaluated", Right),
            ("genetic", Right),
            ("accepted", Right),
            ("diff. evolution", Right),
            ("accepted", Right),
        ],
        rows: suite.problems.iter().map(row).collect(),
    }
}

fn published(suite: &Suite) -> Sheet {
    use Align::{Left, Right};
    let row = |problem: &ProblemResult, entry: &PublishedResult| {
        let verdict = match entry.accepted {
            None => "cannot be evaluated".to_owned(),
            Some(true) => "accepted".to_owned(),
            Some(false) => format!("no: {}", entry.unmet.join(", ")),
        };
        vec![
            clean(&problem.name),
            entry.source.clone(),
            printed(entry),
            number(entry.sum_sq, DIGITS),
            number(entry.to_curve_sum_sq, 4),
            verdict,
        ]
    };
    Sheet {
        heads: &[
            ("problem", Left),
            ("source", Left),
            ("printed", Right),
            ("re-evaluated", Right),
            ("to curve", Right),
            ("our referee", Left),
        ],
        rows: suite
            .problems
            .iter()
            .flat_map(|problem| problem.published.iter().map(move |entry| row(problem, entry)))
            .collect(),
    }
}

/// Returns the notes that a reader must not miss: a goal that is not the best known sum, a sum smaller than the best
/// known, seeds without an answer, an interruption.
fn notes(suite: &Suite) -> Vec<String> {
    let mut notes = Vec::new();
    for problem in &suite.problems {
        let (name, of) = (clean(&problem.name), problem.search.runs.len());
        let known = brief(problem.best_known_sum_sq, DIGITS);
        let summary = &problem.search.summary;
        if problem.goal_sum_sq != problem.best_known_sum_sq {
            notes.push(format!(
                "{name}: hits are of its goal, {}; the best known, {known}, was reached from {} of {of} seeds.",
                brief(problem.goal_sum_sq, DIGITS),
                summary.hits_of_best_known,
            ));
        }
        if let Some(smaller) = &problem.smaller_than_best_known {
            notes.push(format!(
                "{name}{SMALLER}: smaller than the best known! {} by {} from seed {}, accepted by the referee; \
                 {known} was the best known.",
                brief(smaller.sum_sq, DIGITS),
                smaller.method.name(),
                smaller.seed,
            ));
        }
        if summary.accepted < of {
            notes.push(format!("{name}: an accepted answer from {} of {of} seeds only.", summary.accepted));
        }
    }
    if !suite.complete {
        let whole = |m: &MethodResult| m.runs.len() as u64 == suite.seeds;
        let done = suite.problems.iter().filter(|p| whole(&p.search)).count();
        notes.push(format!(
            "Interrupted: all {} seeds of {done} problem{}; the figures are of the runs that were over.",
            suite.seeds,
            if done == 1 { "" } else { "s" },
        ));
    }
    notes
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or(NOTHING.into(), |value| significant(value, digits))
}

/// Returns the printed sum with the printed digits.
fn printed(entry: &PublishedResult) -> String {
    entry.printed_sum_sq.map_or(NOTHING.into(), |sum_sq| brief(sum_sq, DIGITS))
}
