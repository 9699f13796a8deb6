//! The limits of the best answer: the certificate, and the number of times the best answer was found.

use super::body::{paragraph, section};
use super::page::escaped;
use crate::record::{Certificate, Record};
use crate::report::certificate::{
    PARTS, headline, part_words, proof_sentences, reason, repeats_sentences, unused_limits,
};
use crate::report::text::{at_most, grouped, percent_up};

/// Returns the section; empty for a record without either.
pub(super) fn proof(record: &Record) -> String {
    let mut inside = String::new();
    match (&record.certificate, &record.no_certificate) {
        (Some(certificate), _) => inside.push_str(&proved(certificate, unused_limits(record))),
        (None, Some(why)) => inside.push_str(&paragraph("", &reason(why))),
        (None, None) => {}
    }
    if let Some(repeats) = &record.repeats {
        inside.push_str("<h3>How often it came back</h3>\n");
        inside.push_str(&repeats_sentences(repeats).iter().map(|s| paragraph("", s)).collect::<String>());
    }
    if inside.is_empty() { inside } else { section("proof", "Can it be better?", &inside) }
}

fn proved(certificate: &Certificate, unused: Option<String>) -> String {
    let pairs = [
        ("no sum of squares below", at_most(certificate.lower_bound, 10)),
        ("gap to the best found", format!("{} %", percent_up(certificate.gap))),
        ("boxes looked at", grouped(certificate.boxes)),
    ];
    let pairs: String =
        pairs.iter().map(|(key, value)| format!("<div><dt>{key}</dt><dd>{value}</dd></div>\n")).collect();
    let class = if certificate.closed { "good" } else { "" };
    let mut out = paragraph(class, &format!("{}.", headline(certificate)));
    out.push_str(&format!("<dl class=\"figures\">\n{pairs}</dl>\n"));
    let sentences = proof_sentences(certificate).into_iter().chain(unused);
    out.push_str(&sentences.map(|s| paragraph("", &s)).collect::<String>());
    let item = |words: String| format!("<li>{}</li>\n", escaped(&words));
    let items: String = certificate.parts.iter().take(PARTS).map(part_words).map(item).collect();
    if !items.is_empty() {
        out.push_str(&format!("<ul class=\"said-list\">\n{items}</ul>\n"));
    }
    let check = "linkwright verify RESULT --certificate works it out again, box by box.";
    out + &paragraph("notes", check)
}
