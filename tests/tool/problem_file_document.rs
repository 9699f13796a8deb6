//! `docs/problem-file.md` is what `linkwright schema problem --markdown` prints. To write it after a change of the keys:
//! `LINKWRIGHT_WRITE_DOCS=1 cargo test --test tool problem_file_document`.

use crate::common::root;
use linkwright::schema::{SchemaKind, reference, schema};
use std::fs;

#[test]
fn the_reference_of_the_problem_file_is_made_from_the_schema() {
    let place = root().join("docs/problem-file.md");
    let page = reference(SchemaKind::Problem);
    if std::env::var_os("LINKWRIGHT_WRITE_DOCS").is_some() {
        fs::write(&place, &page).expect("it can be written");
    }
    let kept = fs::read_to_string(&place).expect("it is there");
    assert!(
        kept == page,
        "write it anew: LINKWRIGHT_WRITE_DOCS=1 cargo test --test tool problem_file_document"
    );
}

#[test]
fn the_references_hold_every_key_with_a_meaning() {
    for kind in SchemaKind::ALL {
        let page = reference(kind);
        let schema = schema(kind);
        let tables = schema["$defs"].as_object().into_iter().flatten().map(|(_, table)| table);
        for key in
            tables.chain([&schema]).filter_map(|table| table["properties"].as_object()).flat_map(|k| k.keys())
        {
            let row = page.lines().find(|line| line.starts_with(&format!("| `{key}` |")));
            let heading = page.lines().any(|line| {
                let path = line.trim_start_matches("## `").trim_end_matches('`').trim_matches(['[', ']']);
                line.starts_with("## ") && path.rsplit('.').next() == Some(key)
            });
            assert!(row.is_some() || heading, "{}: {key}", kind.name());
            assert!(row.is_none_or(|row| !row.ends_with("|  |")), "{key} has no meaning");
        }
    }
}
