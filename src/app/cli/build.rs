//! `build`: layers, distances and sensitivities of a linkage that is to be built.

use super::arguments::Build as Options;
use super::result;
use super::result::Given;
use super::{Ended, refuse, terminal};
use crate::files::diagnostic::escaped;
use crate::judge::practicality::Practicality;
pub use crate::judge::practicality::{Build, usual_tolerance};
use crate::mechanism::FourBar;
use crate::mechanism::Unit;
use crate::report::practicality::practicality_text;
use crate::report::text::clean;
use crate::task::Problem;

/// Runs the command.
pub fn run(options: &Options) -> Result<Ended, Ended> {
    let made = |linkage: &FourBar, unit: Option<Unit>| {
        let hole = options.hole.unwrap_or_else(|| Build::usual_hole(linkage, unit));
        Build::new(hole, options.margin.unwrap_or(hole)).with_motor(options.motor_hole, options.boss_hole)
    };
    let (title, linkage, unit, practicality) = match result::read(&options.result)? {
        Given::Linkage(file) => {
            let found = Practicality::of_linkage(&file.linkage, made(&file.linkage, file.unit));
            (clean(&file.name), file.linkage, file.unit, found)
        }
        Given::Run(run) => {
            let chosen = run.one()?;
            let problem = Problem::new(run.record.problem.resolved.clone()).map_err(refuse)?;
            let kind = chosen.candidate.linkage.kind();
            let unit = run.record.problem.unit;
            let Some(&linkage) = chosen.candidate.linkage.four_bar() else {
                return Err(refuse(format!(
                    "{} is a {kind}, and plates and layers are computed for four-bars alone: \
                     linkwright analyze draws it and prints its motion",
                    escaped(&chosen.label)
                )));
            };
            let found = Practicality::of_candidate(&problem, chosen.candidate, made(&linkage, unit));
            (escaped(&chosen.label), linkage, unit, found)
        }
    };
    let Some(practicality) = practicality else {
        terminal::complain(&format!("{title} cannot be assembled, so there is nothing to build"));
        return Err(Ended::Bad);
    };
    let tolerance = options.tolerance.unwrap_or_else(|| usual_tolerance(&linkage, unit));
    terminal::answer(&format!("{title}\n  {linkage}\n\n"));
    terminal::answer(&practicality_text(&practicality, unit, tolerance, terminal::colour()));
    Ok(Ended::Good)
}
