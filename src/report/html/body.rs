//! The sections of the report page, in their order.

use super::page::escaped;
use super::{Extent, candidate, data, exact, practicality, proof, table};
use crate::record::{Candidate, Record};
use crate::report::certificate as certificate_words;
use crate::report::text::{clean, significant};
use crate::report::{price, table as text_table, words};

/// Returns everything that is visible on the page. Each section is one line at the end of this function.
pub(super) fn body(record: &Record, drawings: &[&str], extent: Extent) -> String {
    let mut out = String::new();
    out.push_str(&header(record));
    out.push_str("<main>\n");
    if !record.candidates.is_empty() {
        out.push_str(LIVE);
    }
    out.push_str(&table::candidates(record));
    out.push_str(&candidate::articles(record, drawings));
    out.push_str(&practicality::practicality(record, extent));
    out.push_str(&proof::proof(record));
    out.push_str(&exact::exact(record));
    if !record.candidates.is_empty() {
        out.push_str(POINTS);
    }
    out.push_str(&reproduction(record));
    out.push_str("</main>\n");
    out.push_str(&footer());
    out
}

/// Returns a section with a heading, as a card.
pub(super) fn section(id: &str, title: &str, inside: &str) -> String {
    format!(
        "<section class=\"card\" id=\"{id}\" aria-labelledby=\"{id}-title\">\n<h2 id=\"{id}-title\">{title}</h2>\n{inside}</section>\n"
    )
}

/// Returns a paragraph of our own words and cleaned foreign ones.
pub(super) fn paragraph(class: &str, text: &str) -> String {
    match class {
        "" => format!("<p>{}</p>\n", escaped(text)),
        class => format!("<p class=\"{class}\">{}</p>\n", escaped(text)),
    }
}

/// The place in which the script puts the player; hidden without the script.
const LIVE: &str = r#"<section id="live" hidden aria-label="The linkage in motion">
<div class="card stage-card"><div class="choices"><fieldset id="choices"><legend>Candidate</legend></fieldset><span class="played" id="played" role="status"></span></div><div id="stage"></div></div>
<div class="card" id="charts"></div>
</section>
"#;

/// The table of points, filled by the script.
const POINTS: &str = r#"<section class="card screen-only" id="points"><details><summary>Every point: desired, generated, error</summary>
<div class="scroll" tabindex="0" role="region" aria-label="Points"><table><thead><tr><th scope="col" class="n">point</th><th scope="col" class="n">crank °</th><th scope="col" class="n">desired x</th><th scope="col" class="n">desired y</th><th scope="col" class="n">generated x</th><th scope="col" class="n">generated y</th><th scope="col" class="n">error</th></tr></thead><tbody></tbody></table></div></details></section>
"#;

pub(super) fn header(record: &Record) -> String {
    let mut out = String::from("<a class=\"skip\" href=\"#candidates\">To the candidates</a>\n<header>\n");
    out.push_str(&format!("<h1>{}</h1>\n", escaped(&words::problem_name(record))));
    let source = record.problem.source.as_deref().map(clean).filter(|source| !source.is_empty());
    if let Some(source) = source {
        out.push_str(&paragraph("source", &source));
    }
    out.push_str(&paragraph("facts", &capital(&text_table::facts(record))));
    out.push_str(&paragraph("lead", &verdict(record)));
    if let Some(certificate) = record.certificate.as_ref().filter(|proof| proof.lower_bound > 0.0) {
        let class = if certificate.closed { "lead good" } else { "lead" };
        out.push_str(&paragraph(class, &format!("{}.", certificate_words::headline(certificate))));
    }
    if let Some((shown, all)) = data::thinned(record) {
        let text = format!(
            "The drawing and the charts show {shown} of the {all} points; all figures are of all points."
        );
        out.push_str(&paragraph("facts", &text));
    }
    for sentence in
        [words::tolerances(record), text_table::against_raw(record), family(record)].into_iter().flatten()
    {
        out.push_str(&paragraph("facts", &sentence));
    }
    if let Some(said) = words::without_advice(record) {
        out.push_str(&paragraph("facts", said));
    }
    if let Some(text) = price::conflict(record) {
        out.push_str(&paragraph("lead bad", &text));
        let changes = price::changes(record);
        if !changes.is_empty() {
            let items: String = changes
                .iter()
                .map(|(options, rms)| {
                    format!("<li><code>{}</code> ({})</li>\n", escaped(options), escaped(rms))
                })
                .collect();
            out.push_str(&format!("<ul class=\"said-list\">\n{items}</ul>\n"));
        }
    }
    out + "</header>\n"
}

fn family(record: &Record) -> Option<String> {
    record.family.as_ref().map(|family| format!("{}.", capital(&clean(&family.text))))
}

/// Returns the outcome of the run, in a sentence.
fn verdict(record: &Record) -> String {
    let unit = words::unit_suffix(record);
    let figures = |c: &Candidate| {
        format!(
            "{}, rms error {}{unit}, largest {}{unit} at point {}, worst transmission angle {}°",
            c.linkage_type.name(),
            significant(c.error.rms, 4),
            significant(c.error.max, 4),
            c.error.max_at,
            significant(c.transmission_deg.worst, 3)
        )
    };
    let accepted = record.candidates.iter().filter(|c| c.accepted).count();
    match (record.candidates.first(), accepted, record.candidates.len()) {
        (None, ..) => "No linkage was found.".to_owned(),
        (Some(best), 0, _) => format!("No candidate is accepted. The nearest is a {}.", figures(best)),
        (Some(best), _, 1) => format!("One linkage, accepted: a {}.", figures(best)),
        (Some(best), n, all) if n == all => {
            format!("{all} linkages, all accepted. The best is a {}.", figures(best))
        }
        (Some(best), n, all) => format!("{all} linkages, {n} accepted. The best is a {}.", figures(best)),
    }
}

/// Returns the text with a capital first letter.
pub(super) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Returns the commands that reproduce the same digits.
fn reproduction(record: &Record) -> String {
    let name = file_stem(&record.problem.name);
    let method = record.method.asked.name();
    let commands = format!(
        "linkwright synth {name}.toml --method {method} --seed {}\nlinkwright verify results/{name}\nlinkwright report results/{name}\n",
        record.seed
    );
    let version = format!("{} {}", clean(&record.tool.name), clean(&record.tool.version));
    let pairs = [
        ("Program", version),
        ("Seed", record.seed.to_string()),
        ("Digest of the problem", clean(&record.problem.digest)),
        ("Search", text_table::ending_sentences(record)),
    ];
    let pairs: String =
        pairs.iter().map(|(key, value)| format!("<dt>{key}</dt><dd>{}</dd>\n", escaped(value))).collect();
    let again = if record.termination.reproducible {
        "The same program, problem file and seed write the same record to the last digit, whatever the number of threads. \
         The digest tells whether a file asks for the same: it stands in record.json as problem.digest, and every key of \
         the problem as it was run stands there as problem.resolved."
    } else {
        "This search was cut short, so that another run may end elsewhere; the figures of this one can still be verified."
    };
    let inside = format!(
        "<dl class=\"facts-list\">\n{pairs}</dl>\n<pre>{}</pre>\n{}",
        escaped(&commands),
        paragraph("notes", again)
    );
    section("reproduce", "How to reproduce", &inside)
}

/// Returns the name in a form that is safe in a command: letters, digits, dots, dashes; never empty.
fn file_stem(name: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || "._-".contains(c) { c } else { '-' };
    let stem: String = clean(name).chars().take(crate::report::text::LONGEST_TEXT).map(plain).collect();
    let stem = stem.trim_matches(['-', '.']).to_owned();
    if stem.is_empty() { "problem".to_owned() } else { stem }
}

fn footer() -> String {
    format!(
        "<footer>\n<p class=\"screen-only\">Keys: <kbd>space</kbd> play and pause, <kbd>,</kbd> <kbd>.</kbd> point before and next, \
         <kbd>1</kbd> to <kbd>9</kbd> candidate; arrow keys turn the crank while it or the slider has the focus.</p>\n\
         <p>Written by linkwright {} from the record alone.</p>\n</footer>\n",
        env!("CARGO_PKG_VERSION")
    )
}
