//! The sections of the report page, in their order.

use super::page::{drawn, list, paragraph, section};
use super::{Extent, Shown, candidate, data, exact, picks, practicality, proof, table};
use crate::files::name;
use crate::mechanism::article;
use crate::record::{Candidate, Record};
use crate::report::certificate as certificate_words;
use crate::report::pose_curves::pose_curves_svg;
use crate::report::text::{capitalised, clean, significant};
use crate::report::{price, table as text_table, words};
use maud::{Markup, PreEscaped, html};

/// Returns everything that is visible on the page, section by section.
pub(super) fn body(record: &Record, drawings: &[&str], extent: Extent, shown: Shown) -> Markup {
    let found = !record.candidates.is_empty();
    html! {
        (header(record))
        main {
            @if found { (LIVE) }
            (table::candidates(record, shown))
            (picks::picks(record, extent))
            (candidate::articles(record, drawings, shown))
            (pose_curves(record, extent))
            (practicality::practicality(record, extent))
            (proof::proof(record))
            (exact::exact(record))
            @if found && !record.problem.resolved.task.is_function() { (points(record)) }
            (reproduction(record))
        }
        footer {
            p.screen-only {
                "Keys: " kbd { "space" } " play and pause, " kbd { "," } " " kbd { "." } " " (record.problem.resolved.task.noun()) " before and next, "
                kbd { "1" } " to " kbd { "9" }
                " candidate; arrow keys turn the crank while it or the slider has the focus."
            }
            p.screen-only { "To go on with its problem: " code { "linkwright studio report.html" } " opens this file." }
            p { "Written by linkwright " (env!("CARGO_PKG_VERSION")) " from the record alone." }
        }
    }
}

/// The place in which the script puts the player; hidden without the script.
const LIVE: PreEscaped<&str> = PreEscaped(
    r#"<section id="live" hidden aria-label="The linkage in motion">
<div class="card stage-card"><div class="choices"><fieldset id="choices"><legend>Candidate</legend></fieldset><span class="played" id="played" role="status"></span></div><div id="stage"></div></div>
<div class="card" id="charts"></div>
</section>
"#,
);

/// Returns the curves of pins and pivots of a motion of four poses; nothing of other tasks, and of a brief page.
fn pose_curves(record: &Record, extent: Extent) -> Markup {
    let drawing = if extent == Extent::Full { pose_curves_svg(record) } else { None };
    let Some(drawing) = drawing else { return Markup::default() };
    html! {
        section.card id="pose-curves" {
            h2 { "Where pins and pivots can go" }
            (drawn(&drawing))
        } "\n"
    }
}

/// Returns the table of the targets, filled by the script.
fn points(record: &Record) -> Markup {
    let task = &record.problem.resolved.task;
    let (noun, of_motion) = (task.noun(), task.is_motion());
    let heads = [noun, "crank °", "desired x", "desired y", "generated x", "generated y", "error"];
    let of_angle = ["desired angle °", "generated angle °", "angle error °"];
    let heads = heads.into_iter().chain(of_angle.into_iter().filter(|_| of_motion));
    html! {
        section.card.screen-only id="points" {
            details {
                summary { "Every " (noun) ": desired, generated, error" } "\n"
                div.scroll tabindex="0" role="region" aria-label={ (capitalised(noun)) "s" } {
                    table {
                        thead { tr { @for head in heads { th scope="col" class="n" { (head) } } } }
                        tbody {}
                    }
                }
            }
        } "\n"
    }
}

pub(super) fn header(record: &Record) -> Markup {
    let source = record.problem.source.as_deref().map(clean).filter(|source| !source.is_empty());
    let certificate = record.certificate.as_ref().filter(|proof| proof.lower_bound > 0.0);
    let thinned = data::thinned(record).map(|(shown, all)| {
        let noun = record.problem.resolved.task.noun();
        format!(
            "The drawing and the charts show {shown} of the {all} {noun}s; all figures are of all {noun}s."
        )
    });
    let family = record.family.as_ref().map(|family| format!("{}.", capitalised(&clean(&family.text))));
    let without_advice = words::without_advice(record).map(str::to_owned);
    let facts = [thinned, words::tolerances(record), text_table::against_raw(record), family, without_advice];
    html! {
        a.skip href="#candidates" { "To the candidates" }
        header {
            h1 { (words::problem_name(record)) }
            @if let Some(source) = source { (paragraph("source", &source)) }
            (paragraph("facts", &capitalised(&text_table::facts(record))))
            (paragraph("lead", &verdict(record)))
            @if let Some(certificate) = certificate {
                @let class = if certificate.closed { "lead good" } else { "lead" };
                (paragraph(class, &format!("{}.", certificate_words::headline(certificate))))
            }
            @for sentence in facts.into_iter().flatten() { (paragraph("facts", &sentence)) }
            @if let Some(text) = text_table::of_kinds(record) { (paragraph("facts", &text)) }
            @if let Some(text) = price::other_kind(record) { (paragraph("lead", &text)) }
            @if let Some(text) = price::conflict(record) {
                (paragraph("lead bad", &text))
                @let changes = price::changes(record);
                @if !changes.is_empty() {
                    (list(changes.iter().map(|(options, rms)| html! { code { (options) } " (" (rms) ")" })))
                }
            }
        }
    }
}

/// Returns the outcome of the run, in a sentence.
fn verdict(record: &Record) -> String {
    let unit = words::error_unit(record);
    let noun = record.problem.resolved.task.noun();
    let figures = |c: &Candidate| {
        format!(
            "{} {}, rms error {}{unit}, largest {}{unit} at {noun} {}{}, worst transmission angle {}°",
            article(c.type_name()),
            c.type_name(),
            significant(c.error.rms, 4),
            significant(c.error.max, 4),
            c.error.max_at,
            words::angle_errors(c).map_or(String::new(), |said| format!(", {said}")),
            significant(c.transmission_deg.worst, 3)
        )
    };
    let accepted = record.candidates.iter().filter(|c| c.accepted).count();
    match (record.candidates.first(), accepted, record.candidates.len()) {
        (None, ..) => "No linkage was found.".to_owned(),
        (Some(best), 0, _) => format!("No candidate is accepted. The nearest is {}.", figures(best)),
        (Some(best), _, 1) => format!("One linkage, accepted: {}.", figures(best)),
        (Some(best), n, all) if n == all => {
            format!("{all} linkages, all accepted. The best is {}.", figures(best))
        }
        (Some(best), n, all) => format!("{all} linkages, {n} accepted. The best is {}.", figures(best)),
    }
}

/// Returns the commands that reproduce the same digits.
fn reproduction(record: &Record) -> Markup {
    let name = name::legal(&record.problem.name, "problem");
    let quoted = |path: String| if path.contains(' ') { format!("\"{path}\"") } else { path };
    let (file, result) = (quoted(format!("{name}.toml")), quoted(format!("results/{name}")));
    let method = record.method.asked.name();
    let commands = format!(
        "linkwright synth {file} --method {method} --seed {}\nlinkwright verify {result}\nlinkwright report {result}\n",
        record.seed
    );
    let again = if record.termination.reproducible {
        "The same program, problem file and seed write the same record to the last digit, whatever the number of threads. \
         The digest tells whether a file asks for the same: it stands in record.json as problem.digest, and every key of \
         the problem as it was run stands there as problem.resolved."
    } else {
        "This search was cut short, so that another run may end elsewhere; the figures of this one can still be verified."
    };
    let inside = html! {
        dl.facts-list {
            dt { "Program" }
            dd { (clean(&record.tool.name)) " " (clean(&record.tool.version)) }
            dt { "Seed" }
            dd { (record.seed) }
            dt { "Digest of the problem" }
            dd { (clean(&record.problem.digest)) }
            dt { "Search" }
            dd { (text_table::ending_sentences(record)) }
        }
        pre { (commands) }
        (paragraph("notes", again))
    };
    section("reproduce", "How to reproduce", inside)
}
