//! The limits of the best answer: the certificate, and the number of times the best answer was found.

use super::page::{figures, list, paragraph, section};
use crate::record::{Certificate, Record};
use crate::report::certificate::{
    PARTS, headline, part_words, proof_sentences, reason, repeats_sentences, unused_limits,
};
use crate::report::text::{at_most, grouped, percent_up};
use maud::{Markup, html};

/// Returns the section; empty for a record without either.
pub(super) fn proof(record: &Record) -> Markup {
    if record.certificate.is_none() && record.no_certificate.is_none() && record.repeats.is_none() {
        return Markup::default();
    }
    let inside = html! {
        @match (&record.certificate, &record.no_certificate) {
            (Some(certificate), _) => (proved(certificate, unused_limits(record))),
            (None, Some(why)) => (paragraph("", &reason(why))),
            (None, None) => {}
        }
        @if let Some(repeats) = &record.repeats {
            h3 { "How often it came back" }
            @for sentence in repeats_sentences(repeats) { (paragraph("", &sentence)) }
        }
    };
    section("proof", "Can it be better?", inside)
}

fn proved(certificate: &Certificate, unused: Option<String>) -> Markup {
    let class = if certificate.closed { "good" } else { "" };
    html! {
        (paragraph(class, &format!("{}.", headline(certificate))))
        (figures([
            ("no sum of squares below", at_most(certificate.lower_bound, 10)),
            ("gap to the best found", format!("{} %", percent_up(certificate.gap))),
            ("boxes looked at", grouped(certificate.boxes)),
        ]))
        @for sentence in proof_sentences(certificate).into_iter().chain(unused) { (paragraph("", &sentence)) }
        @if !certificate.parts.is_empty() { (list(certificate.parts.iter().take(PARTS).map(part_words))) }
        (paragraph("notes", "linkwright verify RESULT --certificate works it out again, box by box."))
    }
}
