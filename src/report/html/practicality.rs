//! The practicality of a linkage on the page: of the best candidate, and of the buildable one if that is another.

use super::Extent;
use super::page::{list, paragraph, section};
use super::table::{Cell, Column, tabulated};
use crate::judge::practicality::clearance::PivotDistance;
use crate::judge::practicality::sensitivity::{Dimension, Sensitivity};
use crate::judge::practicality::{Build, Practicality, Sweep, usual_tolerance};
use crate::record::{Candidate, Record};
use crate::report::Colour;
use crate::report::practicality::{Words, degrees, held, objection, shift};
use crate::report::text::significant;
use crate::task::Problem;
use maud::{Markup, html};

/// The number of significant digits of distances and of rates.
const DIGITS: usize = 4;

/// Returns the section; empty if there is no linkage to build.
pub(super) fn practicality(record: &Record, extent: Extent) -> Markup {
    let buildable = record.buildable.as_ref().filter(|c| c.rank != 1);
    let subjects = record.candidates.first().into_iter().chain(buildable);
    let found: Vec<Markup> = match extent {
        Extent::Brief => vec![paragraph("notes", BRIEF)],
        Extent::Full => {
            let problem = Problem::new(record.problem.resolved.clone()).ok();
            problem.map_or(Vec::new(), |p| subjects.filter_map(|c| subject(record, &p, c)).collect())
        }
    };
    if record.candidates.is_empty() || found.is_empty() {
        return Markup::default();
    }
    section("build", "To build it", html! { @for part in found { (part) } })
}

const BRIEF: &str = "linkwright report RESULT writes this page anew with layers, clearances and what a wrong dimension \
    does to the path; linkwright build RESULT prints them.";

const NOTES: &str = "linkwright build RESULT says the same of other candidates, holes, margins and tolerances; linkwright snap \
    RESULT brings the hole distances to stock sizes.";

fn subject(record: &Record, problem: &Problem, c: &Candidate) -> Option<Markup> {
    let unit = record.problem.unit;
    let hole = Build::usual_hole_of(&Sweep::of_candidate(problem, c)?, unit)?;
    let found = Practicality::of_candidate(problem, c, Build::new(hole, hole))?;
    let words = Words { unit, colour: Colour::Never };
    let title = match c.rank {
        0 => "The buildable answer".to_owned(),
        rank => format!("Candidate {rank}"),
    };
    Some(html! {
        h3 { (title) }
        (paragraph("", &words.made(&found)))
        @match &found.layering {
            Some(layering) => (list(words.layers(&found, layering))),
            None => (paragraph("bad", "The loop is open somewhere in the motion.")),
        }
        @if let Some(distances) = &found.distances { (joints(distances, hole)) }
        @if let Some(felt) = &found.sensitivity {
            (sensitivities(felt, &found))
            (paragraph("", &words.together(felt, &found, usual_tolerance(c.linkage, unit))))
        }
        (paragraph("notes", NOTES))
    })
}

/// Returns the table of the least distances between joints.
fn joints(distances: &[PivotDistance], hole: f64) -> Markup {
    let columns: [Column<&PivotDistance>; 3] = [
        ("least distance", true, &|d| Cell::figure(d.closest.value, DIGITS)),
        ("at crank", true, &|d| {
            Cell::number(d.closest.crank_angle.to_degrees(), degrees(d.closest.crank_angle))
        }),
        ("", false, &|d| match objection(d, hole) {
            "" => Cell::words(""),
            note => Cell::verdict(note, false),
        }),
    ];
    let moving = distances.iter().filter(|d| !d.fixed);
    let rows = moving.map(|d| (None, Cell::words(d.between.join("-")), d));
    html! {
        (tabulated(("Least distances of joints", "tight"), ("joints", false), &columns, rows))
        (paragraph("notes", &held(distances)))
    }
}

/// Returns the table of each dimension's effect on the path.
fn sensitivities(felt: &Sensitivity, found: &Practicality) -> Markup {
    let columns: [Column<&Dimension>; 2] = [
        ("rms", true, &|d| Cell::number(None, significant(d.rms, 3))),
        ("most", true, &|d| Cell::number(None, significant(d.worst, 3))),
    ];
    let all = felt.dimensions.iter().chain(&felt.ground);
    let rows = all.map(|d| (None, Cell::words(d.name), d));
    html! {
        details {
            summary { "What an error of each dimension does" }
            (paragraph("notes", &shift(felt, found)))
            (tabulated(("Sensitivities", "tight"), ("dimension", false), &columns, rows))
        }
    }
}
