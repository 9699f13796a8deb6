//! Test fixtures: a linkage, a problem with points on its curve, and a start there.

#![cfg(test)]

use crate::mechanism::{AssemblyMode, CouplerSide, FourBar, NaturalCoordinates};
use crate::task::forms::design_space::Shape;
use crate::task::forms::start::{AS_WRITTEN, Start};
use crate::task::forms::torus::Positions;
use crate::task::{Problem, Setting};

/// Returns a linkage of these lengths, its ground line on the x axis and its coupler point to the left of C D.
pub(crate) fn linkage([ground, crank, coupler, follower]: [f64; 4]) -> FourBar {
    FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [ground, 0.0],
        crank,
        coupler,
        follower,
        crank_side: 0.6 * coupler,
        follower_side: 0.7 * coupler,
        assembly: AssemblyMode::Plus,
        side: CouplerSide::Plus,
    })
    .expect("a linkage")
}

/// Returns a problem of these points with free timing and these lines under `[require]`.
pub(crate) fn problem(points: &[[f64; 2]], closed: bool, require: &str) -> Problem {
    let text =
        format!("format = 1\n[task.path]\npoints = {points:?}\nclosed = {closed}\n[require]\n{require}\n");
    let file = crate::files::problem_file::parse("it.toml", &text, None, &[]).expect("a problem");
    Problem::new(file.spec).expect("a problem")
}

/// Returns the linkage as a start for the problem, at these positions.
pub(crate) fn start(problem: &Problem, linkage: &FourBar, positions: Positions) -> Start {
    let setting =
        Setting { aim: None, assembly: AssemblyMode::Plus, direction: 1.0, side: problem.sides()[0] };
    let design = problem.space(setting.side).design(&Shape::from(linkage), 0.0);
    Start { design, setting, positions, scales: AS_WRITTEN }
}
