//! The practicality of a linkage on the page: of the best candidate, and of the buildable one if that is another.

use super::Extent;
use super::body::{paragraph, section};
use super::page::escaped;
use super::table::{Cell, head, scrolling};
use crate::judge::practicality::clearance::PivotDistance;
use crate::judge::practicality::sensitivity::{Dimension, Sensitivity};
use crate::judge::practicality::{Build, Practicality, millimetre, usual_tolerance};
use crate::record::{Candidate, Record};
use crate::report::Colour;
use crate::report::practicality::{Words, degrees, held, objection, shift};
use crate::report::text::significant;
use crate::task::Problem;

/// The number of significant digits of distances and of rates.
const DIGITS: usize = 4;

/// Returns the section; empty if there is no linkage to build.
pub(super) fn practicality(record: &Record, extent: Extent) -> String {
    let buildable = record.buildable.as_ref().filter(|c| c.rank != 1);
    let subjects = record.candidates.first().into_iter().chain(buildable);
    let inside: String = match extent {
        Extent::Brief => paragraph("notes", BRIEF),
        Extent::Full => match Problem::new(record.problem.resolved.clone()) {
            Ok(problem) => subjects.filter_map(|c| subject(record, &problem, c)).collect(),
            Err(_) => String::new(),
        },
    };
    if record.candidates.is_empty() || inside.is_empty() {
        return String::new();
    }
    section("build", "To build it", &inside)
}

const BRIEF: &str = "linkwright report RESULT writes this page anew with layers, clearances and what a wrong dimension \
    does to the path; linkwright build RESULT prints them.";

const NOTES: &str = "linkwright build RESULT says the same of other candidates, holes, margins and tolerances; linkwright snap \
    RESULT brings the hole distances to stock sizes.";

fn subject(record: &Record, problem: &Problem, c: &Candidate) -> Option<String> {
    let unit = record.problem.unit;
    let hole = Build::usual_hole(&c.linkage, unit.map(millimetre));
    let found = Practicality::of_candidate(problem, c, Build::new(hole, hole))?;
    let words = Words { unit, colour: Colour::Never };
    let title = match c.rank {
        0 => "The buildable answer".to_owned(),
        rank => format!("Candidate {rank}"),
    };
    let mut out = format!("<h3>{title}</h3>\n{}", paragraph("", &words.made(&found)));
    match &found.layering {
        Some(layering) => {
            let items: String =
                words.layers(layering).iter().map(|line| format!("<li>{}</li>\n", escaped(line))).collect();
            out.push_str(&format!("<ul class=\"said-list\">\n{items}</ul>\n"));
        }
        None => out.push_str(&paragraph("bad", "The loop is open somewhere in the motion.")),
    }
    if let Some(distances) = &found.distances {
        out.push_str(&joints(distances, hole));
    }
    if let Some(felt) = &found.sensitivity {
        let tolerance = usual_tolerance(&c.linkage, unit);
        out.push_str(&sensitivities(felt));
        out.push_str(&paragraph("", &words.together(felt, found.at_points, tolerance)));
    }
    Some(out + &paragraph("notes", NOTES))
}

/// Returns the table of the least distances between joints.
fn joints(distances: &[PivotDistance], hole: f64) -> String {
    let row = |d: &PivotDistance| {
        let note = objection(d, hole);
        let cells = [
            Cell::figure(d.closest.value, DIGITS),
            Cell::number(d.closest.crank_angle.to_degrees(), degrees(d.closest.crank_angle)),
            if note.is_empty() { Cell::words("") } else { Cell::verdict(note, false) },
        ];
        let cells: String = cells.iter().map(Cell::markup).collect();
        format!("<tr><th scope=\"row\">{}-{}</th>{cells}</tr>\n", d.between[0], d.between[1])
    };
    let rows: String = distances.iter().filter(|d| !d.fixed).map(row).collect();
    let columns = [("joints", false), ("least distance", true), ("at crank", true), ("", false)];
    let table = format!("{}<tbody>\n{rows}</tbody>\n", head(&columns));
    scrolling("Least distances of joints", "tight", &table) + &paragraph("notes", &held(distances))
}

/// Returns the table of each dimension's effect on the path.
fn sensitivities(felt: &Sensitivity) -> String {
    let row = |d: &Dimension| {
        let rates = [significant(d.rms, 3), significant(d.worst, 3)]
            .map(|rate| format!("<td class=\"n\">{rate}</td>"));
        format!("<tr><th scope=\"row\">{}</th>{}</tr>\n", d.name, rates.concat())
    };
    let rows: String = felt.dimensions.iter().chain(std::iter::once(&felt.ground)).map(row).collect();
    let columns = [("dimension", false), ("rms", true), ("most", true)];
    let table = format!("{}<tbody>\n{rows}</tbody>\n", head(&columns));
    format!(
        "<details><summary>What an error of each dimension does</summary>\n{}{}</details>\n",
        paragraph("notes", &shift(felt)),
        scrolling("Sensitivities", "tight", &table)
    )
}
