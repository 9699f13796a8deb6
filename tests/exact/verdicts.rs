//! What each known real class can do.

use crate::known::{Known, real_linkages};
use linkwright::internals::numbers::nine_point::certificate::certify;
use linkwright::internals::numbers::nine_point::{Solution, Target};

/// A row of `data/verdicts.csv`.
pub struct Verdict {
    /// One of its solutions, to the last digits.
    pub solution: Solution,
    /// Its three cognates, to twelve digits.
    pub cognates: Vec<Known>,
    pub grashof: bool,
    /// On one circuit, in order, on one branch.
    pub abilities: [bool; 3],
}

/// The known classes of a problem.
pub fn verdicts(problem: &str, target: &Target) -> Vec<Verdict> {
    let mut linkages = real_linkages(problem, target);
    let rows = include_str!("data/verdicts.csv").lines();
    let rows = rows.filter_map(|line| line.strip_prefix(problem)?.strip_prefix(','));
    rows.map(|row| {
        let cells: Vec<usize> = row.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let (cognates, others) = linkages.drain(..).partition(|known: &Known| known.class == cells[0]);
        linkages = others;
        let cognates: Vec<Known> = cognates;
        let solution = certify(target, &cognates[0].solution).expect("a solution").refined;
        let abilities = [cells[2] == 1, cells[3] == 1, cells[4] == 1];
        Verdict { solution, cognates, grashof: cells[1] == 1, abilities }
    })
    .collect()
}
