//! The certificate of a result, and the number of times its best answer was found, in words.

use super::grid::{Colour, Ink};
use super::text::{
    COLUMNS, at_most, capitalised, clean, clean_sentence, grouped, indented, percent_up, significant, wrapped,
};
use crate::record::{Certificate, CertificatePart, Record, Repeats};

/// The largest gap with which a best answer is called a proved optimum.
const NARROW: f64 = 1e-2;
/// The largest number of entries of a list that are written.
const TOLD: usize = 12;

/// The largest number of classes of a certificate that are shown; it has at most four.
pub(super) const PARTS: usize = 8;

/// Returns the result for each class of a certificate, for a terminal.
pub fn parts_text(certificate: &Certificate) -> String {
    let lines = certificate.parts.iter().take(PARTS).map(part_words);
    lines.map(|words| wrapped("    ", "      ", &words, COLUMNS)).collect()
}

/// Returns the certificate, or the reason why there is none and the statement about repeated hits; empty if no
/// certificate was asked for.
pub fn certificate_text(record: &Record, colour: Colour) -> String {
    let head = |text: &str| format!("\n  {}\n", colour.paint(Ink::Strong, text));
    let lines = |sentences: &[String]| -> String {
        sentences.iter().map(|sentence| wrapped("    ", "    ", sentence, COLUMNS)).collect()
    };
    match (&record.certificate, &record.no_certificate) {
        (Some(certificate), _) => {
            let mut sentences = proof_sentences(certificate);
            sentences.extend(unused_limits(record));
            head(&headline(certificate)) + &lines(&sentences)
        }
        (None, Some(why)) => {
            let mut out = head("No certificate") + &lines(&[reason(why)]);
            if let Some(repeats) = &record.repeats {
                out.push_str(&lines(&repeats_sentences(repeats)));
            }
            out
        }
        (None, None) => String::new(),
    }
}

/// Returns the statement about the number of times the best answer was found, for a terminal.
pub fn repeats_text(repeats: &Repeats) -> String {
    repeats_sentences(repeats).iter().map(|sentence| indented(sentence)).collect()
}

/// Returns the reason why there is no certificate, as a sentence.
pub(super) fn reason(why: &str) -> String {
    format!("{}.", capitalised(&clean_sentence(why)).trim_end_matches('.'))
}

/// Returns `Proved optimum: no linkage that the proof covers is better by more than 0.01 %`, or the state of an open
/// proof.
pub fn headline(certificate: &Certificate) -> String {
    let proved = match (certificate.closed, certificate.lower_bound > 0.0) {
        (true, _) if certificate.gap <= NARROW => "Proved optimum",
        (true, _) => "Proved",
        (false, true) => "Proved so far",
        (false, false) => return "Nothing is proved yet".to_owned(),
    };
    let gap = percent_up(certificate.gap);
    format!("{proved}: no linkage that the proof covers is better by more than {gap} %")
}

/// Returns a clause such as `crank-rocker, crank as prescribed: no sum below 0.009, 1,200 boxes`.
pub(super) fn part_words(part: &CertificatePart) -> String {
    format!(
        "{}, crank {}: no sum below {}, {} boxes{}",
        clean(&part.linkage_type),
        if part.direction < 0 { "the other way" } else { "as prescribed" },
        at_most(part.lower_bound, 10),
        grouped(part.boxes),
        if part.closed { "" } else { ", not closed" },
    )
}

/// Returns the statement of the proof, and the linkages that it covers and does not cover.
pub(super) fn proof_sentences(certificate: &Certificate) -> Vec<String> {
    let list = |entries: &[String]| {
        let told: Vec<String> = entries.iter().take(TOLD).map(|entry| clean(entry)).collect();
        told.join("; ")
    };
    let mut sentences = vec![clean_sentence(&certificate.statement)];
    let looked = grouped(certificate.boxes);
    sentences.push(if certificate.closed {
        format!("Every box of the {looked} looked at is decided.")
    } else {
        format!(
            "It ended before the wanted gap of {} % was reached, after {looked} boxes; the bound holds all the same.",
            percent_up(certificate.wanted_gap)
        )
    });
    let lists = [("Covered", &certificate.covered), ("Not covered", &certificate.not_covered)];
    let lists = lists.into_iter().filter(|(_, entries)| !entries.is_empty());
    sentences.extend(lists.map(|(word, entries)| format!("{word}: {}.", list(entries))));
    sentences
}

/// The limits on lengths that a proof uses too.
const USED_LIMITS: [&str; 3] = ["design.coupler_x", "design.coupler_y", "design.d"];

/// Returns the reason why an open proof may never close: limits and requirements at the best answer that it does not
/// use.
pub(super) fn unused_limits(record: &Record) -> Option<String> {
    let open = record.certificate.as_ref().is_some_and(|certificate| !certificate.closed);
    let costs = record.candidates.first().filter(|_| open).map_or(&[][..], |best| &best.costs);
    let names: Vec<String> = costs
        .iter()
        .filter(|cost| !USED_LIMITS.contains(&cost.name.as_str()))
        .take(TOLD)
        .map(|cost| clean(&cost.name))
        .collect();
    (!names.is_empty()).then(|| {
        format!(
            "The best answer lies on limits that the proof does not use ({}): where linkages beyond them are better, the \
             gap cannot close.",
            names.join(", ")
        )
    })
}

/// Returns the number of times the best answer was found and the estimate that follows from it, each figure with its
/// assumption.
pub(super) fn repeats_sentences(repeats: &Repeats) -> Vec<String> {
    let starts = grouped(repeats.starts);
    let near = match repeats.near.checked_sub(repeats.hits) {
        Some(more @ 1..) => format!(" ({} more came within a part in 1000)", grouped(more)),
        _ => String::new(),
    };
    let mut sentences = vec![format!(
        "The best answer came from {} of {starts} independent starts{near}.",
        grouped(repeats.hits)
    )];
    if repeats.hits > 0 {
        sentences.push(format!(
            "A better one that starts come to as often would have stayed unseen with a probability of {} (one half for \
             each hit).",
            significant(repeats.as_likely, 2)
        ));
    }
    if repeats.starts > 0 {
        sentences.push(format!(
            "A better one that {} % of the starts or more come to would have been seen with a probability of 95 %.",
            percent_up(repeats.share_seen)
        ));
    }
    if let (Some(followed), Some(basins), Some(unseen)) =
        (repeats.followed, repeats.basins, repeats.unseen_better)
    {
        sentences.push(format!(
            "The {} starts that were followed to an end came to {}: the probability that a better one has not been seen \
             is {}, if nothing is known of how many there are and how often starts come to each (Boender and Rinnooy Kan \
             1987).",
            grouped(followed),
            if basins == 1 { "the same one".to_owned() } else { format!("{} different ones", grouped(basins)) },
            significant(unseen, 2)
        ));
    }
    sentences.push("These are probabilities under assumptions, not a proof.".to_owned());
    sentences
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_figure_of_repeated_hits_stands_with_what_it_assumes() {
        let text = repeats_sentences(&Repeats::new(40, 6, 9).with_basins(34, 5)).join(" ");
        for words in [
            "from 6 of 40 independent starts (3 more came within",
            "probability of 0.016 (one half",
            "7.3 % of the starts or more",
            "34 starts that were followed to an end came to 5 different ones",
            "not been seen is 0.15, if nothing is known",
            "not a proof",
        ] {
            assert!(text.contains(words), "{words}: {text}");
        }
        let few = repeats_sentences(&Repeats::new(4, 0, 0)).join(" ");
        assert!(!few.contains("one half") && !few.contains("Boender"), "{few}");
    }
}
