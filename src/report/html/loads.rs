//! The loads of a candidate on the page: a chart of the torque on the crank, and the largest force of each joint.

use super::page::{drawn, paragraph};
use super::table::{minus, scrolling};
use crate::mechanism::loads::figures::JointPeak;
use crate::mechanism::loads::{LoadFigures, Peak};
use crate::record::{Candidate, Record};
use crate::report::loads::{rounded, torque_svg};
use crate::report::text::{brief, clean, significant};
use maud::{Markup, html};

/// Returns the torque over the crank angle and the joints' forces, folded away; nothing of a problem without loads.
pub(super) fn loads(record: &Record, c: &Candidate, title: &str) -> Markup {
    let figures = record.problem.resolved.loads.as_ref().and_then(|loads| {
        let loaded = loads.on(&c.linkage).ok()?;
        loaded.figures(loaded.drive())
    });
    let Some(figures) = figures else { return Markup::default() };
    let heads = [
        ("joint", false),
        ("on", false),
        ("from", false),
        ("largest force, N", true),
        ("at crank angle", true),
    ];
    let row = |joint: &JointPeak| {
        let slides = if joint.slides { " (slider)" } else { "" };
        html! {
            tr {
                th scope="row" { (clean(&joint.at)) (slides) }
                td { (clean(&joint.on)) }
                td { (clean(&joint.from)) }
                td class="n" { (minus(&significant(joint.force.value.abs(), 4))) }
                td class="n" { (minus(&brief(joint.force.crank_deg, 5))) "°" }
            }
        }
    };
    html! {
        h3 { "Loads" }
        @if let Some(chart) = torque_svg(&figures) { (drawn(&chart)) }
        (paragraph("", &words(&figures)))
        details {
            summary { "Largest force of every joint" }
            (scrolling(&format!("Joint forces of {title}"), "", &heads, figures.joints.iter().map(row)))
        }
    }
}

/// Returns the figures of the torque in sentences.
fn words(figures: &LoadFigures) -> String {
    let at = |peak: &Peak, unit: &str| {
        format!("{} {unit} at {}°", significant(peak.value, 4), brief(peak.crank_deg, 5))
    };
    let range =
        if figures.full_turn { "a turn" } else { "all that the crank reaches, 1° short of each toggle" };
    let mean = rounded(figures.torque_mean, figures.torque_rms);
    let power = if mean == 0.0 || figures.power_mean == 0.0 {
        String::new()
    } else {
        format!(" {} W on average.", significant(figures.power_mean, 4))
    };
    minus(&format!(
        "Torque on the crank over {range}: peak {}, {} N m rms.{power} Largest shaking force {}. Friction is left out.",
        at(&figures.torque_peak, "N m"),
        significant(figures.torque_rms, 4),
        at(&figures.shaking_force, "N"),
    ))
}
