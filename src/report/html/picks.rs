//! The closest, the smallest, the best transmitting and the buildable linkage side by side.

use super::Extent;
use super::page::{paragraph, section};
use super::table::minus;
use crate::record::{Candidate, Pick, Record};
use crate::report::contact_sheet::thumbnail_svg;
use crate::report::picks::{extent_of, within};
use crate::report::text::{NO_NUMBER, capitalised, significant};
use crate::report::words;
use crate::task::Problem;
use maud::{Markup, PreEscaped, html};

/// A linkage with everything that it is best at.
struct Card<'a> {
    names: Vec<&'static str>,
    candidate: &'a Candidate,
}

/// Returns the section; empty if nothing was picked.
pub(super) fn picks(record: &Record, extent: Extent) -> Markup {
    let (Some(_), Some(closest)) = (&record.picks, record.candidates.first()) else {
        return Markup::default();
    };
    let mut cards = vec![Card { names: vec!["closest"], candidate: closest }];
    for pick in [Pick::Smallest, Pick::BestTransmission, Pick::Buildable] {
        let Some(candidate) = record.pick(pick) else { continue };
        let is_same = |card: &&mut Card<'_>| card.candidate.linkage == candidate.linkage;
        match cards.iter_mut().find(is_same) {
            Some(card) => card.names.push(pick.words()),
            None => cards.push(Card { names: vec![pick.words()], candidate }),
        }
    }
    let problem = Problem::new(record.problem.resolved.clone()).ok();
    let lead = format!("The smallest and the best transmitting linkage have an error {}.", within(record));
    let inside = html! {
        (paragraph("notes", &lead))
        ul.gallery {
            @for card in &cards { (card.markup(record, problem.as_ref(), extent)) }
        }
    };
    section("picks", "Picks", inside)
}

impl Card<'_> {
    fn markup(&self, record: &Record, problem: Option<&Problem>, extent: Extent) -> Markup {
        let c = self.candidate;
        let title = capitalised(&self.names.join(", "));
        let place = if c.rank > 0 { format!("candidate {}", c.rank) } else { String::new() };
        let drawn = (extent == Extent::Full).then(|| thumbnail_svg(record, c, &title));
        let size = problem.map(|problem| extent_of(problem, c));
        html! {
            li {
                @if let Some(drawn) = drawn { (thumbnail(&drawn)) }
                h3 { (title) " " small { (place) } }
                (figures(record, [c.error.rms, c.error.max], c.transmission_deg.worst, [size, Some(c.linkage.longest())]))
            }
        }
    }
}

/// Returns a small drawing as it is embedded in a page.
pub(super) fn thumbnail(drawing: &str) -> Markup {
    let inline = drawing.replacen(" xmlns=\"http://www.w3.org/2000/svg\"", "", 1);
    html! { figure { (PreEscaped(inline)) } }
}

/// Returns the figures of a card: errors, worst transmission angle, extent and longest link.
pub(super) fn figures(
    record: &Record,
    [rms, max]: [f64; 2],
    transmission_deg: f64,
    [extent, longest]: [Option<f64>; 2],
) -> Markup {
    let (unit, of_errors) = (words::unit_suffix(record), words::error_unit(record));
    let figure = |value: Option<f64>, unit: &str| match value.map(|value| significant(value, 4)) {
        None => NO_NUMBER.to_owned(),
        Some(text) if text == NO_NUMBER => text,
        Some(text) => minus(&text) + unit,
    };
    let error = |value: f64| figure(Some(value), &of_errors);
    let length = |value: Option<f64>| figure(value, &unit);
    html! {
        dl {
            dt { "rms error" } dd { (error(rms)) }
            dt { "largest error" } dd { (error(max)) }
            dt { "transmission" } dd { (significant(transmission_deg, 3)) "°" }
            dt { "extent" } dd { (length(extent)) }
            dt { "longest length" } dd { (length(longest)) }
        }
    }
}
