//! Numbers in the prose of the documents are those of the program.

use crate::common::root;
use linkwright::internals::mechanism::four_bar::transmission::POOR_DEG;
use linkwright::internals::numbers::arithmetic::lane::LANES;
use linkwright::internals::record::GENERIC_CLASSES;
use linkwright::internals::synthesis::atlas::ENTRIES;
use linkwright::internals::synthesis::free::LEAST_MATCHED;
use linkwright::internals::task::spec::SolveSpec;
use std::fs;

/// With commas between thousands.
fn number(n: usize) -> String {
    let digits = n.to_string();
    let mut out = String::new();
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            out.push(',');
        }
        out.push(digit);
    }
    out
}

/// A document on one line.
fn prose(place: &str) -> String {
    let text = fs::read_to_string(root().join(place)).expect("it is there");
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_documents_have_the_numbers_of_the_program() {
    let lanes = LANES;
    assert_eq!(lanes, 8, "the words below say eight");
    let (atlas, least) = (number(ENTRIES), LEAST_MATCHED);
    let poor = format!("below {POOR_DEG} a loaded linkage may jam");
    let evaluations = SolveSpec::default().evaluations;
    for (place, said) in [
        (
            "docs/how-it-works.md",
            format!("an atlas of {atlas} coupler curves for targets of {least} points and more"),
        ),
        (
            "README.md",
            format!("for targets of {least} points and more also from an atlas of {atlas} coupler curves"),
        ),
        ("docs/how-it-works.md", "screened, eight at a time".to_owned()),
        (
            "docs/how-it-works.md",
            format!("the equations have {} different solutions", number(GENERIC_CLASSES)),
        ),
        ("README.md", poor.clone()),
        ("docs/guide.md", poor),
        (
            "docs/problem-file.md",
            format!("The largest number of evaluations of the objective; {evaluations} where silent."),
        ),
        ("docs/certificate.md", "used on boxes with f >= 1e-4 only".to_owned()),
    ] {
        assert!(prose(place).contains(&said), "{place} does not say: {said}");
    }
}
