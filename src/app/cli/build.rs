//! `build`: layers, distances and sensitivities of a linkage that is to be built.

use super::arguments::Build as Options;
use super::result;
use super::result::Given;
use super::{Ended, refuse, terminal};
use crate::app::building::{self, NotBuilt, Sizes};
use crate::files::diagnostic::escaped;
pub use crate::judge::practicality::{Build, usual_tolerance};
use crate::judge::practicality::{Practicality, Sweep};
use crate::mechanism::{CrankLinkage, LinkageKind, Unit};
use crate::record::Candidate;
use crate::report::practicality::practicality_text;
use crate::report::text::clean;
use crate::task::Problem;

/// Runs the command.
pub fn run(options: &Options) -> Result<Ended, Ended> {
    let given = Subject::of(options)?;
    let Some(sweep) = &given.sweep else { return Err(nothing(&given.title)) };
    let shop = result::read_shop(&options.result, options.shop.as_ref(), &given.linkage)?;
    let Options { hole, margin, motor_hole, boss_hole, .. } = *options;
    let sizes = Sizes { hole, margin, motor_hole, boss_hole };
    let build =
        building::build((&given.linkage, given.unit), sweep, shop, &sizes).map_err(|why| match why {
            NotBuilt::NoRoom => no_room(&given),
            why => refuse(why),
        })?;
    let Some(practicality) = given.practicality(build) else { return Err(nothing(&given.title)) };
    let tolerance = options.tolerance.unwrap_or_else(|| usual_tolerance(given.linkage, given.unit));
    terminal::answer(&format!("{}\n  {}\n\n", given.title, given.linkage));
    terminal::answer(&practicality_text(&practicality, given.unit, tolerance, terminal::colour()));
    Ok(Ended::Good)
}

/// The linkage that is to be built.
struct Subject {
    title: String,
    linkage: CrankLinkage,
    unit: Option<Unit>,
    /// The motion over which it is examined; `None` if it cannot be assembled.
    sweep: Option<Sweep>,
    /// The candidate of a run, with its problem.
    run: Option<(Problem, Candidate)>,
}

impl Subject {
    fn of(options: &Options) -> Result<Self, Ended> {
        Ok(match result::read(&options.result)? {
            Given::Linkage(file) => Subject {
                title: clean(&file.name),
                linkage: file.linkage,
                unit: file.unit,
                sweep: Sweep::of_linkage(file.linkage),
                run: None,
            },
            Given::Run(run) => {
                let chosen = run.one()?;
                let problem = Problem::new(run.record.problem.resolved.clone()).map_err(refuse)?;
                let candidate = chosen.candidate;
                Subject {
                    title: escaped(&chosen.label),
                    linkage: candidate.linkage,
                    unit: run.record.problem.unit,
                    sweep: Sweep::of_candidate(&problem, candidate),
                    run: Some((problem, candidate.clone())),
                }
            }
        })
    }

    fn practicality(&self, build: Build) -> Option<Practicality> {
        match &self.run {
            None => Practicality::of_linkage(self.linkage, build),
            Some((problem, candidate)) => Practicality::of_candidate(problem, candidate, build),
        }
    }
}

/// Reports a linkage without a position.
fn nothing(title: &str) -> Ended {
    terminal::complain(&format!("{title} cannot be assembled, so there is nothing to build"));
    Ended::Bad
}

/// Reports a slider whose slot leaves no room for any hole.
fn no_room(given: &Subject) -> Ended {
    terminal::complain(&format!(
        "{}: the slot of its block runs through {}, so there are no plates to build: build a result whose motion keeps \
         clear of that, or give the holes' diameter with --hole for the rest",
        given.title,
        slot_end(&given.linkage)
    ));
    Ended::Bad
}

/// Returns the place that the slot of a linkage with a slider can run into, in words.
fn slot_end(linkage: &CrankLinkage) -> &'static str {
    match linkage.kind() {
        LinkageKind::InvertedSliderCrank => "the crank pin C, which the block reaches at a toggle",
        _ => "the crank's pivot A, which the block reaches",
    }
}
