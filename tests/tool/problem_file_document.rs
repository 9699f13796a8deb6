//! `docs/problem-file.md`, `docs/linkage-file.md` and `docs/sweep-file.md` are what `linkwright schema problem --markdown`
//! and so on print. To write them after a change of the keys:
//! `LINKWRIGHT_WRITE_DOCS=1 cargo test --test tool problem_file_document`.

use crate::common::root;
use linkwright::internals::files::schema::{SchemaKind, reference, schema};
use std::fs;

#[test]
fn the_references_of_the_files_are_made_from_their_schemas() {
    for (kind, page_of) in [
        (SchemaKind::Problem, "docs/problem-file.md"),
        (SchemaKind::Linkage, "docs/linkage-file.md"),
        (SchemaKind::Sweep, "docs/sweep-file.md"),
    ] {
        let place = root().join(page_of);
        let page = reference(kind);
        if std::env::var_os("LINKWRIGHT_WRITE_DOCS").is_some() {
            fs::write(&place, &page).expect("it can be written");
        }
        let kept = fs::read_to_string(&place).unwrap_or_default();
        assert!(
            kept == page,
            "write {page_of} anew: LINKWRIGHT_WRITE_DOCS=1 cargo test --test tool problem_file_document"
        );
    }
}

#[test]
fn the_examples_of_the_linkage_file_are_linkage_files() {
    let page = reference(SchemaKind::Linkage);
    let blocks: Vec<&str> =
        page.split("```toml\n").skip(1).filter_map(|part| part.split("```").next()).collect();
    assert_eq!(blocks.len(), 7);
    let tables = [
        "[linkage]",
        "[vector_loop]",
        "[slider_crank]",
        "[inverted_slider_crank]",
        "[chain]",
        "[loads]",
        "[shop]",
    ];
    for table in tables {
        assert!(blocks.iter().any(|block| block.contains(table)), "an example of {table}");
    }
    for block in blocks {
        linkwright::internals::files::linkage_file::parse_any("example.toml", block)
            .expect("it is a linkage file");
    }
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
