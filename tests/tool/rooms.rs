//! The house as `src/lib.rs` shows it: which storey may use which, and which file alone names a library.

use crate::common::root;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};

fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).expect("it is there") {
        let path = entry.expect("it can be read").path();
        if path.is_dir() {
            files.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            files.push(path);
        }
    }
    files
}

/// All paths that a file names outside its tests, as lists of names.
#[derive(Default)]
struct Paths(Vec<Vec<String>>);

impl Paths {
    fn of(text: &str) -> Self {
        let file = syn::parse_file(text).expect("it is Rust");
        let mut paths = Paths::default();
        if !is_test(&file.attrs) {
            paths.visit_file(&file);
        }
        paths
    }

    fn tree(&mut self, before: &[String], tree: &syn::UseTree) {
        let and = |name: &syn::Ident| before.iter().cloned().chain([name.to_string()]).collect::<Vec<_>>();
        match tree {
            syn::UseTree::Path(path) => self.tree(&and(&path.ident), &path.tree),
            syn::UseTree::Name(name) => self.0.push(and(&name.ident)),
            syn::UseTree::Rename(name) => self.0.push(and(&name.ident)),
            syn::UseTree::Glob(_) => self.0.push(before.to_vec()),
            syn::UseTree::Group(group) => group.items.iter().for_each(|tree| self.tree(before, tree)),
        }
    }
}

/// Whether an item is compiled for tests alone.
fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        attribute.path().is_ident("test")
            || (attribute.path().is_ident("cfg")
                && attribute.parse_args::<syn::Ident>().is_ok_and(|what| what == "test"))
    })
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if !is_test(&item.attrs) {
            self.tree(&[], &item.tree);
        }
    }

    fn visit_item_mod(&mut self, item: &'ast syn::ItemMod) {
        if !is_test(&item.attrs) {
            visit::visit_item_mod(self, item);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.0.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, item: &'ast syn::Macro) {
        // The arguments of a macro are no syntax tree: their names are read one after the other.
        let mut names: Vec<String> = Vec::new();
        let mut open = false;
        for word in item.tokens.to_string().split_whitespace() {
            match word {
                "::" => open = !names.is_empty(),
                name if open => {
                    names.push(name.trim_end_matches([',', ')']).to_owned());
                    open = false;
                }
                name => {
                    self.0.push(std::mem::take(&mut names));
                    names.push(name.trim_start_matches('(').to_owned());
                }
            }
        }
        self.0.push(names);
        visit::visit_macro(self, item);
    }
}

/// The table of `src/lib.rs`: each storey with the storeys that it may use; `None`: all.
fn table() -> BTreeMap<String, Option<BTreeSet<String>>> {
    let text = std::fs::read_to_string(root().join("src/lib.rs")).expect("it is text");
    let rows = text.lines().filter_map(|line| line.strip_prefix("//! | `"));
    rows.map(|row| {
        let cells: Vec<&str> = row.split(" |").collect();
        let storey = cells[0].trim_end_matches('`').to_owned();
        let uses = cells[2].trim();
        let list = uses.split(", ").filter(|name| !name.is_empty()).map(str::to_owned).collect();
        (storey, (uses != "everything").then_some(list))
    })
    .collect()
}

/// The storey of a file below `src`; `None` for `lib.rs` and `main.rs`.
fn storey(file: &Path) -> Option<String> {
    let below = file.strip_prefix(root().join("src")).expect("below src");
    let first = below.components().next()?.as_os_str().to_str()?.to_owned();
    (!first.ends_with(".rs")).then_some(first)
}

/// How many modules lie around what a file of `src` holds, its own counted: 1 for `judge/mod.rs`, 2 for `judge/rank.rs`.
fn depth(file: &Path) -> usize {
    let below = file.strip_prefix(root().join("src")).expect("below src");
    below.components().count() - usize::from(file.ends_with("mod.rs"))
}

/// The storeys that a file of this [`depth`] uses, by absolute paths or by so many `super` that they lead to the crate.
fn used(text: &str, depth: usize, storeys: &BTreeSet<String>) -> BTreeSet<String> {
    let mut used = BTreeSet::new();
    for names in Paths::of(text).0 {
        let up = names.iter().take_while(|name| *name == "super").count();
        let first = if up >= depth { names.get(up) } else { names.get(1).filter(|_| names[0] == "crate") };
        used.extend(first.and_then(|first| storeys.get(first)).cloned());
    }
    used
}

#[test]
fn every_folder_of_src_is_a_storey_of_the_table_and_uses_only_what_its_row_names() {
    let table = table();
    let storeys: BTreeSet<String> = table.keys().cloned().collect();
    assert_eq!(storeys.len(), 9, "{storeys:?}");
    let mut seen = BTreeSet::new();
    for file in sources(&root().join("src")) {
        let Some(own) = storey(&file) else { continue };
        let may = table.get(&own).unwrap_or_else(|| panic!("{own} has no row in src/lib.rs"));
        seen.insert(own.clone());
        // Packages of their own: the compiler holds what they use.
        if own == "numbers" {
            continue;
        }
        let text = std::fs::read_to_string(&file).expect("it is text");
        for name in used(&text, depth(&file), &storeys) {
            let allowed = may.as_ref().is_none_or(|may| may.contains(&name)) || name == own;
            assert!(allowed, "{} uses {name}", file.display());
        }
    }
    assert_eq!(seen, storeys);
}

#[test]
fn a_storey_that_uses_another_is_seen() {
    let storeys: BTreeSet<String> = ["judge", "synthesis"].map(str::to_owned).into();
    for (text, depth, sees) in [
        ("use crate::{\n    synthesis::plan,\n    record::Record,\n};", 3, true),
        ("fn f() { let x = crate::synthesis::plan(); }", 2, true),
        ("fn f() { println!(\"{}\", crate::synthesis::NAME); }", 2, true),
        ("use super::super::synthesis::plan;", 2, true),
        ("use super::super::synthesis::plan;", 3, false),
        ("use super::synthesis;", 1, true),
        ("use super::synthesis;", 2, false),
        ("// crate::synthesis\n#[cfg(test)]\nmod tests { use crate::synthesis::plan; }", 2, false),
    ] {
        assert_eq!(!used(text, depth, &storeys).is_empty(), sees, "{text} at depth {depth}");
    }
    assert_eq!(depth(&root().join("src/judge/mod.rs")), 1);
    assert_eq!(depth(&root().join("src/judge/rank.rs")), 2);
    assert_eq!(depth(&root().join("src/judge/verify/mod.rs")), 2);
}

/// The dependencies of a package below `src/numbers` on others of this repository, but for its tests.
fn packages(name: &str) -> BTreeSet<String> {
    let path = root().join("src/numbers").join(name).join("Cargo.toml");
    let text = std::fs::read_to_string(path).expect("it is text");
    let manifest: toml::Table = text.parse().expect("it is TOML");
    let own = manifest["dependencies"].as_table().expect("a table").keys();
    own.filter(|key| key.starts_with("linkwright")).cloned().collect()
}

#[test]
fn the_checker_shares_nothing_with_the_search_but_the_file_of_the_leaves() {
    let leaves: BTreeSet<String> = ["linkwright-leaves".to_owned()].into();
    assert_eq!(packages("checker"), leaves);
    assert_eq!(packages("bound"), leaves);
    assert!(packages("leaves").is_empty());
}

#[test]
fn a_library_that_could_be_exchanged_is_named_in_one_place() {
    let places: &[(&str, &[&str])] = &[
        ("argmin", &["numbers/optimise/argmin_bridge.rs", "numbers/optimise/population_tests.rs"]),
        ("clarabel", &["numbers/optimise/conic.rs"]),
        ("clap", &["app/cli"]),
        ("indicatif", &["app/cli"]),
        ("ctrlc", &["app/cli"]),
        ("ariadne", &["app/cli"]),
        ("axum", &["app/studio"]),
        ("roxmltree", &["files/svg_file"]),
    ];
    let src = root().join("src");
    for file in sources(&src) {
        let text = std::fs::read_to_string(&file).expect("it is text");
        let below = file.strip_prefix(&src).expect("below src");
        for names in Paths::of(&text).0 {
            for (library, allowed) in places {
                let names_it = names.first().is_some_and(|name| name == library) && names.len() > 1;
                let inside = allowed.iter().any(|place| below.starts_with(place));
                assert!(inside || !names_it, "{} names {library}", file.display());
            }
        }
        let is_unsafe = text.lines().any(|l| !l.trim_start().starts_with("//") && l.contains("unsafe "));
        assert!(!is_unsafe || file.ends_with("dispatch.rs"), "{} has unsafe code", file.display());
    }
    let main = std::fs::read_to_string(root().join("src/main.rs")).expect("it is text");
    assert!(main.lines().count() < 40);
}
