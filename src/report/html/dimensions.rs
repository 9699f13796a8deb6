//! The exact dimensions, as they are written in a linkage file.

use super::page::escaped;
use crate::files::linkage_file::to_toml;
use crate::mechanism::FourBar;
use crate::mechanism::Unit;
use crate::record::{Candidate, Record};
use crate::report::text::{clean, significant};
use crate::report::words;

/// The largest number of characters of a name in a linkage file.
const MOST_NAME: usize = 50;

/// Returns a linkage file to copy, and the dimensions that it does not contain: the ground and the place of P along and
/// across the coupler.
pub(super) fn dimensions(record: &Record, c: &Candidate, short: &str) -> String {
    let unit = words::unit_suffix(record);
    let offset = c.linkage.coupler_offset();
    let digits = |value: f64| super::table::minus(&significant(value, 6));
    let name = named(record, short);
    format!(
        "{}<p class=\"notes\">Ground AB {}{unit}; P lies {}{unit} along and {}{unit} across from C to D (positive: to the left).</p>\n",
        block(&name, record.problem.unit, &c.linkage),
        digits(c.linkage.ground()),
        digits(offset.re),
        digits(offset.im)
    )
}

/// Returns the dimensions of the alternatives, folded away.
pub(super) fn of_alternatives(c: &Candidate) -> String {
    let list: String = c
        .alternatives
        .iter()
        .take(super::data::MOST_ALTERNATIVES)
        .enumerate()
        .map(|(i, a)| {
            let file = to_toml(&format!("cognate {}", i + 1), None, &a.linkage);
            format!("<pre class=\"dimensions\">{}</pre>\n", escaped(&without_comments(&file)))
        })
        .collect();
    format!("<details><summary>Dimensions of the cognates</summary>\n{list}</details>\n")
}

fn block(name: &str, unit: Option<Unit>, linkage: &FourBar) -> String {
    format!("<pre class=\"dimensions\">{}</pre>\n", escaped(&without_comments(&to_toml(name, unit, linkage))))
}

/// Returns the file without its comments: the drawing on the page explains the letters.
fn without_comments(toml: &str) -> String {
    toml.lines().filter(|line| !line.starts_with('#')).map(|line| format!("{line}\n")).collect()
}

/// Returns a name that is legal in a linkage file.
fn named(record: &Record, short: &str) -> String {
    let plain = |c: char| if c.is_alphanumeric() || " -_.".contains(c) { c } else { '-' };
    let name: String = clean(&record.problem.name).chars().take(MOST_NAME).map(plain).collect();
    let name = name.trim_matches([' ', '.', '-']);
    if name.is_empty() { format!("linkage-{short}") } else { format!("{name}-{short}") }
}
