//! A suite for the terminal and as Markdown: the same tables in two formats.
//!
//! Paths, whose answers are compared by a sum of squares, have the tables of this file; motions, whose objective counts
//! angles too, and functions, whose errors are of one output alone, have those of the module `sections`.

mod sections;

use super::grid::Align::{Left, Right};
use super::grid::{Cell, Colour, Column, Grid, Ink, plain};
use super::text::{
    COLUMNS, NO_NUMBER, brief, clean, clean_sentence, grouped, markdown, percent_up, significant, wrapped,
};
use crate::record::TwoSidedRecord;
use crate::record::suite::{MethodResult, ProblemResult, PublishedResult, Suite};
use sections::sections;

/// The mark of a problem with a sum that is smaller than the best known.
const SMALLER: &str = " *";
/// The number of digits of figures that are stated one by one.
const DIGITS: usize = 10;
/// The width of a problem's name on a terminal, in columns.
const NAME: usize = 30;

const WHAT: &str = "sum of sq: the least sum of squared distances at the crank angles, of all seeds; median: \
    of the accepted answers of all seeds; to curve: the sum of squared distances of the points to the best \
    answer's whole curve; hits: seeds whose answer is accepted and reaches the best known sum, or the goal \
    where one is set, within 1e-6 of it; evaluations: of the objective, median.";
const STRAYS: &str = "both ways: the mean distance of the path and the best answer's curve from each other, there and back \
    added, over 2,000 points of equal arcs each; farthest: the largest such distance. Both over the root mean square radius of \
    the path: a curve that meets its points and goes astray between them has a large one.";
const TIMES: &str = "ms: the median and the worst time of a search, of one thread, from the checked problem \
    to ranked, refereed candidates; times depend on the machine, the other figures do not.";
const PROVED: &str = "proved gap: no linkage of the kind that is told below has a sum of squares more than this below the \
    least one found.";
const BESIDE: &str = "printed, re-evaluated: the best published answer's sum as printed (where that could be \
    read in the source) and by our referee; genetic, diff. evolution: their median sum over accepted answers, \
    after as many evaluations as the search above used in the median, and how many seeds had one.";

/// Returns a suite as text: the answers, the comparisons, and the notes.
pub fn suite_text(suite: &Suite, colour: Colour) -> String {
    let said = |text: &str| wrapped("  ", "    ", text, COLUMNS);
    let mut out = String::new();
    let (paths, motions, functions) = by_kind(suite);
    if !paths.is_empty() {
        out.push_str(&answers(&paths).shortened(NAME).render(colour));
        out.push('\n');
        out.push_str(&beside(&paths).shortened(NAME).render(colour));
        out.push('\n');
        out.push_str(&strays(&paths).shortened(NAME).render(colour));
        out.push('\n');
        out.extend([WHAT, TIMES, BESIDE, STRAYS].map(said));
        out.extend(is_certified(&paths).then(|| said(PROVED)));
    }
    for section in sections(motions, functions) {
        let is_first = out.is_empty();
        if !is_first {
            out.push('\n');
        }
        out.push_str(&format!("  {}\n\n", colour.paint(Ink::Strong, section.heading)));
        for table in section.tables() {
            out.push_str(&table.shortened(NAME).render(colour));
            out.push('\n');
        }
        out.push_str(&said(section.meaning));
        out.extend(section.beside().map(said));
        out.extend(is_first.then(|| said(TIMES)));
        out.extend(without_populations(&section.problems).iter().map(|why| said(why)));
    }
    out.extend(proofs(suite).iter().map(|proof| said(proof)));
    let notes = notes(suite);
    if !notes.is_empty() {
        out.push('\n');
    }
    out.extend(notes.iter().map(|note| said(note)));
    out
}

/// Returns a suite as a Markdown page, with the command that makes it again and every published figure with its source.
pub fn suite_markdown(suite: &Suite) -> String {
    let paragraph = |text: &str| wrapped("", "", text, COLUMNS + 10) + "\n";
    let (paths, motions, functions) = by_kind(suite);
    let whose = match &suite.collection {
        None => "of the literature".to_owned(),
        Some(folder) => format!("in {}", markdown(&clean(folder))),
    };
    let mut out = format!("# Problems {whose}: what is found\n\n");
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
    let has_paths = !paths.is_empty() || (motions.is_empty() && functions.is_empty());
    if has_paths {
        out.push_str("## The answers\n\n");
        out.push_str(&answers(&paths).markdown());
        out.push('\n');
        out.push_str(&paragraph(WHAT));
    }
    for section in sections(motions, functions) {
        out.push_str(&format!("## {}\n\n", section.heading));
        for table in section.tables() {
            out.push_str(&table.markdown());
            out.push('\n');
        }
        out.push_str(&paragraph(section.meaning));
        out.extend(section.beside().map(paragraph));
        out.extend(without_populations(&section.problems).iter().map(|why| paragraph(why)));
    }
    out.push_str(&paragraph(TIMES));
    out.extend(is_certified(&paths).then(|| paragraph(PROVED)));
    out.push_str(&bullets(&proofs(suite)));
    out.push_str(&bullets(&notes(suite)));
    if has_paths {
        out.push_str("## Beside them\n\n");
        out.push_str(&beside(&paths).markdown());
        out.push('\n');
        out.push_str(&paragraph(BESIDE));
        out.push_str("## The whole curve\n\n");
        out.push_str(&strays(&paths).markdown());
        out.push('\n');
        out.push_str(&paragraph(STRAYS));
    }
    if !has_paths && suite.problems.iter().all(|problem| problem.published.is_empty()) {
        return out.trim_end().to_owned() + "\n";
    }
    out.push_str("## What was published\n\n");
    out.push_str(&paragraph(
        "Each vector as it is stored in the problem file, evaluated by our referee under the problem's timing. A \
         printed figure stands only where it could be read in the source.",
    ));
    out.push_str(&published(suite).markdown());
    out
}

/// Returns a list in Markdown; nothing for an empty one.
fn bullets(texts: &[String]) -> String {
    let end = if texts.is_empty() { "" } else { "\n" };
    texts.iter().map(|text| wrapped("- ", "  ", &markdown(text), COLUMNS + 10)).collect::<String>() + end
}

/// Returns the paths, the motions and the functions of a suite.
fn by_kind(suite: &Suite) -> (Vec<&ProblemResult>, Vec<&ProblemResult>, Vec<&ProblemResult>) {
    let (functions, others): (Vec<_>, Vec<_>) = suite.problems.iter().partition(|p| p.is_function());
    let (motions, paths) = others.into_iter().partition(|p| p.is_motion());
    (paths, motions, functions)
}

/// Returns whether certificates were asked for.
fn is_certified(problems: &[&ProblemResult]) -> bool {
    problems.iter().any(|p| p.certificate.is_some() || p.no_certificate.is_some())
}

/// Returns the sentences that say why no population search is shown beside some of these problems.
fn without_populations(problems: &[&ProblemResult]) -> Vec<String> {
    let why = |problem: &&ProblemResult| Some((problem.name.clone(), problem.no_populations.clone()?));
    let sentences = by_reason(problems.iter().filter_map(why));
    sentences
        .into_iter()
        .map(|sentence| format!("No genetic algorithm and no differential evolution beside {sentence}"))
        .collect()
}

/// Returns a sentence for each certificate, and for each one that is not possible; motions with one reason together.
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
    let (paths, mut motions, functions) = by_kind(suite);
    motions.extend(functions);
    let mut sentences: Vec<String> = paths.into_iter().filter_map(told).collect();
    let why = |problem: &&ProblemResult| Some((problem.name.clone(), problem.no_certificate.clone()?));
    sentences.extend(by_reason(motions.iter().filter_map(why)));
    sentences
}

/// Returns a sentence for each reason, after the names of the problems that have it.
fn by_reason(problems: impl IntoIterator<Item = (String, String)>) -> Vec<String> {
    let mut reasons: Vec<(String, Vec<String>)> = Vec::new();
    for (name, why) in problems {
        match reasons.iter_mut().find(|(reason, _)| *reason == why) {
            Some((_, names)) => names.push(clean(&name)),
            None => reasons.push((why, vec![clean(&name)])),
        }
    }
    reasons.iter().map(|(why, names)| format!("{}: {}.", names.join(", "), clean_sentence(why))).collect()
}

/// Returns the cell of a problem's name, with the mark of one whose best known answer is beaten.
fn marked(problem: &ProblemResult) -> Cell {
    match problem.smaller_than_best_known {
        Some(_) => (format!("{}{SMALLER}", clean(&problem.name)), Ink::Good),
        None => plain(clean(&problem.name)),
    }
}

fn hits(problem: &ProblemResult) -> Cell {
    plain(format!("{}/{}", problem.search.summary.hits, problem.search.runs.len()))
}

/// Returns the cell of a time, in milliseconds.
fn milliseconds(seconds: Option<f64>) -> Cell {
    number(seconds.map(|s| 1e3 * s), 3)
}

fn evaluations(problem: &ProblemResult) -> Cell {
    plain(problem.search.summary.median_evaluations.map_or(NO_NUMBER.into(), grouped))
}

fn answers(problems: &[&ProblemResult]) -> Grid {
    let to_curve = |p: &ProblemResult| p.search.summary.best.as_ref().and_then(|best| best.to_curve_sum_sq);
    let gap = |p: &ProblemResult| {
        let proof = p.certificate.as_ref().filter(|proof| proof.lower_bound > 0.0);
        proof.map_or(NO_NUMBER.into(), |proof| format!("{} %", percent_up(proof.gap)))
    };
    let columns: [Column<'_, &ProblemResult>; 10] = [
        (Left, "problem", &|p| marked(p)),
        (Right, "sum of sq", &|p| number(p.search.summary.best.as_ref().map(|best| best.sum_sq), 6)),
        (Right, "best known", &|p| number(Some(p.known.best()), 6)),
        (Right, "median", &|p| number(p.search.summary.median_sum_sq, 6)),
        (Right, "to curve", &|p| number(to_curve(p), 4)),
        (Right, "hits", &|p| hits(p)),
        (Right, "median ms", &|p| milliseconds(p.search.summary.median_search_s)),
        (Right, "worst ms", &|p| milliseconds(p.search.summary.worst_search_s)),
        (Right, "evaluations", &|p| evaluations(p)),
        (Right, "proved gap", &|p| plain(gap(p))),
    ];
    Grid::of(problems, if is_certified(problems) { &columns } else { &columns[..9] })
}

fn beside(problems: &[&ProblemResult]) -> Grid {
    let heads = ["median", "printed", "re-evaluated", "genetic", "accepted", "diff. evolution", "accepted"];
    let mut grid = Grid::new(&[(Left, &["problem"]), (Right, &heads)]);
    for problem in problems {
        let best = problem.best_published.as_ref();
        let mut cells = vec![
            plain(clean(&problem.name)),
            number(problem.search.summary.median_sum_sq, 6),
            plain(best.map_or(NO_NUMBER.into(), printed)),
            number(best.and_then(|entry| entry.sum_sq), 6),
        ];
        for population in &problem.populations {
            cells.push(number(population.summary.median_sum_sq, 6));
            cells.push(plain(format!("{}/{}", population.summary.accepted, population.runs.len())));
        }
        grid.row(cells);
    }
    grid
}

/// Returns the table of the distances of paths and curves from each other.
fn strays(problems: &[&ProblemResult]) -> Grid {
    let of = |p: &ProblemResult, figure: fn(&TwoSidedRecord) -> f64| {
        let best = p.search.summary.best.as_ref();
        number(best.and_then(|best| best.two_sided.as_ref()).map(figure), 3)
    };
    Grid::of(
        problems,
        &[
            (Left, "problem", &|p| plain(clean(&p.name))),
            (Right, "both ways", &|p| of(p, |distance| distance.mean_over_radius)),
            (Right, "farthest", &|p| {
                of(p, |distance| distance.worst / distance.mean * distance.mean_over_radius)
            }),
        ],
    )
}

fn published(suite: &Suite) -> Grid {
    let verdict = |entry: &PublishedResult| match entry.accepted {
        None => "cannot be evaluated".to_owned(),
        Some(true) => "accepted".to_owned(),
        Some(false) => format!("no: {}", entry.unmet.join(", ")),
    };
    let entries: Vec<(&str, &PublishedResult)> = suite
        .problems
        .iter()
        .flat_map(|p| p.published.iter().map(|entry| (p.name.as_str(), entry)))
        .collect();
    Grid::of(
        &entries,
        &[
            (Left, "problem", &|(name, _)| plain(clean(name))),
            (Left, "source", &|(_, entry)| plain(entry.source.clone())),
            (Right, "printed", &|(_, entry)| plain(printed(entry))),
            (Right, "re-evaluated", &|(_, entry)| number(entry.sum_sq, DIGITS)),
            (Right, "to curve", &|(_, entry)| number(entry.to_curve_sum_sq, 4)),
            (Left, "our referee", &|(_, entry)| plain(verdict(entry))),
        ],
    )
}

/// Returns the notes that a reader must not miss: a goal that is not the best known sum, a sum smaller than the best
/// known, seeds without an answer, problems that are left out, an interruption.
fn notes(suite: &Suite) -> Vec<String> {
    let mut notes = Vec::new();
    for problem in &suite.problems {
        let (name, of) = (clean(&problem.name), problem.search.runs.len());
        let known = brief(problem.known.best(), DIGITS);
        let summary = &problem.search.summary;
        if problem.known.goal() != problem.known.best() {
            notes.push(format!(
                "{name}: hits are of its goal, {}; the best known, {known}, was reached from {} of {of} seeds.",
                brief(problem.known.goal(), DIGITS),
                summary.hits_of_best_known,
            ));
        }
        if let Some(smaller) = &problem.smaller_than_best_known {
            notes.push(format!(
                "{name}{SMALLER}: smaller than the best known! {} by {} from seed {}, accepted by the referee; \
                 {known} was the best known.",
                brief(smaller.figure(), DIGITS),
                smaller.method.name(),
                smaller.seed,
            ));
        }
        if summary.accepted < of {
            notes.push(format!("{name}: an accepted answer from {} of {of} seeds only.", summary.accepted));
        }
    }
    let left_out = suite.left_out.iter().map(|one| (one.name.clone(), one.why.clone()));
    notes.extend(by_reason(left_out).iter().map(|sentence| format!("Left out: {sentence}")));
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

fn number(value: Option<f64>, digits: usize) -> Cell {
    plain(value.map_or(NO_NUMBER.into(), |value| significant(value, digits)))
}

/// Returns the printed sum with the printed digits.
fn printed(entry: &PublishedResult) -> String {
    entry.printed_sum_sq.map_or(NO_NUMBER.into(), |sum_sq| brief(sum_sq, DIGITS))
}
