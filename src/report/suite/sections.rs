//! The tables of motions, of functions and of functions with places in a suite, with the words about them.

use super::{evaluations, hits, marked, milliseconds, number};
use crate::record::suite::{MotionErrors, ProblemResult};
use crate::report::grid::Align::{Left, Right};
use crate::report::grid::{Column, Grid, plain};
use crate::report::text::clean;

/// The number of digits of a motion's objectives in a table.
const DIGITS_OF_OBJECTIVES: usize = 8;
/// The heading of the motions.
const MOTIONS: &str = "Motions: poses of a body";
/// The meaning of the columns of motions, of functions and of functions with places.
const WHAT_OF_MOTIONS: &str = "objective: the least one of all seeds, the sum over the poses of weight times (squared \
    distance of the place + (angle_weight times the error of the angle in radians) squared); median: of the accepted \
    answers of all seeds; hits: seeds whose answer is accepted and reaches the best known objective within 1e-6 of it \
    (where that is 0: up to rounding); rms, rms deg: the root of the mean squared distance of the places and error of \
    the angle, in degrees, of the best answer; poses: how many, with those that are a place alone; evaluations: of the \
    objective, median.";
/// The headings of functions.
const FUNCTIONS: &str = "Functions: an angle turned into another";
const WHAT_OF_FUNCTIONS: &str = "objective: the least one of all seeds, the sum over the pairs of weight times squared error \
    of the follower's angle, in degrees squared; median: of the accepted answers of all seeds; hits: seeds whose answer is \
    accepted and reaches the best known objective within 1e-6 of it; rms deg: the root of the mean squared error of the \
    best answer, degrees; evaluations: of the objective, median.";
const PLACES: &str = "Functions: an angle turned into a slider's place";
const WHAT_OF_PLACES: &str = "objective: the least one of all seeds, the sum over the pairs of weight times squared error \
    of the place; median: of the accepted answers of all seeds; hits: seeds whose answer is accepted and reaches the best \
    known objective within 1e-6 of it (where that is 0: up to rounding); rms: the root of the mean squared error of the best \
    answer; evaluations: of the objective, median.";
const BESIDE_OBJECTIVES: &str = "genetic, diff. evolution: the median objective of their accepted answers, after as many \
    evaluations as the search above used in the median, and how many seeds had one.";

/// The motions or the functions of a suite, with the words about them.
pub struct Section<'a> {
    pub problems: Vec<&'a ProblemResult>,
    pub heading: &'static str,
    /// The meaning of the columns.
    pub meaning: &'static str,
    /// The word for their targets.
    nouns: &'static str,
    /// The errors that they have.
    shown: Errors,
}

/// The columns of errors in a table of answers.
#[derive(Clone, Copy)]
struct Errors {
    of_places: bool,
    of_angles: bool,
}

impl Section<'_> {
    /// Returns the table of the answers, that of the population searches beside them if there are any, and that of the effort.
    pub fn tables(&self) -> Vec<Grid> {
        let mut tables = vec![answers_of_motions(&self.problems, self.shown)];
        tables.extend(self.has_populations().then(|| beside_objectives(&self.problems)));
        tables.push(effort(&self.problems, self.nouns));
        tables
    }

    /// Returns the meaning of the table of population searches, if there is one.
    pub fn beside(&self) -> Option<&'static str> {
        self.has_populations().then_some(BESIDE_OBJECTIVES)
    }

    fn has_populations(&self) -> bool {
        self.problems.iter().any(|problem| !problem.populations.is_empty())
    }
}

/// Returns the sections of a suite that are not empty.
pub fn sections<'a>(
    motions: Vec<&'a ProblemResult>,
    functions: Vec<&'a ProblemResult>,
) -> impl Iterator<Item = Section<'a>> {
    let section =
        |problems, [heading, meaning, nouns]: [&'static str; 3], [of_places, of_angles]: [bool; 2]| Section {
            problems,
            heading,
            meaning,
            nouns,
            shown: Errors { of_places, of_angles },
        };
    let (places, functions) = functions.into_iter().partition(|problem| problem.is_of_places());
    let sections = [
        section(motions, [MOTIONS, WHAT_OF_MOTIONS, "poses"], [true, true]),
        section(functions, [FUNCTIONS, WHAT_OF_FUNCTIONS, "pairs"], [false, true]),
        section(places, [PLACES, WHAT_OF_PLACES, "pairs"], [true, false]),
    ];
    sections.into_iter().filter(|section| !section.problems.is_empty())
}

/// Returns the table of the answers of motions or of functions, with the errors that they have.
fn answers_of_motions(problems: &[&ProblemResult], shown: Errors) -> Grid {
    const OF_PLACES: usize = 5;
    const OF_ANGLES: usize = 6;
    let best = |p: &ProblemResult, of: fn(&MotionErrors) -> f64| {
        p.search.summary.best.as_ref().and_then(|best| best.motion.as_ref()).map(of)
    };
    // Beside an exact answer there is rounding alone.
    let digits = |p: &ProblemResult| if p.known.best() > 0.0 { DIGITS_OF_OBJECTIVES } else { 3 };
    let objective = |p: &ProblemResult, value: Option<f64>| number(value, digits(p));
    let columns: [Column<'_, &ProblemResult>; 7] = [
        (Left, "problem", &|p| marked(p)),
        (Right, "objective", &|p| objective(p, best(p, |errors| errors.objective))),
        (Right, "best known", &|p| objective(p, Some(p.known.best()))),
        (Right, "median", &|p| objective(p, p.search.summary.median_objective)),
        (Right, "hits", &|p| hits(p)),
        (Right, "rms", &|p| number(best(p, |errors| errors.rms), 4)),
        (Right, "rms deg", &|p| number(best(p, |errors| errors.rms_deg.unwrap_or(f64::NAN)), 4)),
    ];
    let is_shown = |i: usize| (i != OF_PLACES || shown.of_places) && (i != OF_ANGLES || shown.of_angles);
    let shown = columns.iter().enumerate().filter(|(i, _)| is_shown(*i));
    Grid::of(problems, &shown.map(|(_, column)| *column).collect::<Vec<_>>())
}

/// Returns the table of the times and evaluations of the searches for motions or functions; `targets` heads their number.
fn effort(problems: &[&ProblemResult], targets: &'static str) -> Grid {
    let columns: [Column<'_, &ProblemResult>; 5] = [
        (Left, "problem", &|p| plain(clean(&p.name))),
        (Right, targets, &|p| plain(p.points.to_string())),
        (Right, "median ms", &|p| milliseconds(p.search.summary.median_search_s)),
        (Right, "worst ms", &|p| milliseconds(p.search.summary.worst_search_s)),
        (Right, "evaluations", &|p| evaluations(p)),
    ];
    Grid::of(problems, &columns)
}

/// Returns the table of the population searches beside those of motions or functions.
fn beside_objectives(problems: &[&ProblemResult]) -> Grid {
    let heads = ["median", "genetic", "accepted", "diff. evolution", "accepted"];
    let mut grid = Grid::new(&[(Left, &["problem"]), (Right, &heads)]);
    for problem in problems.iter().filter(|problem| !problem.populations.is_empty()) {
        let mut cells = vec![
            plain(clean(&problem.name)),
            number(problem.search.summary.median_objective, DIGITS_OF_OBJECTIVES),
        ];
        for population in &problem.populations {
            cells.push(number(population.summary.median_objective, 6));
            cells.push(plain(format!("{}/{}", population.summary.accepted, population.runs.len())));
        }
        grid.row(cells);
    }
    grid
}
