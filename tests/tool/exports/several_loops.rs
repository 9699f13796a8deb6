//! Exports and `build` of six-bars and eight-bars: every format, all plates, a stacking in words.

use super::dxf::tags;
use super::{every_format, exported, program};
use crate::common::root;
use std::collections::BTreeSet;
use tempfile::TempDir;

/// The shipped six-bar and an eight-bar, each with its number of links.
fn files() -> [(String, usize); 2] {
    let at = |path: &str| root().join(path).display().to_string();
    [(at("problems/linkages/watt-six-bar.toml"), 6), (at("tests/corpora/linkage/eight-bar.toml"), 8)]
}

#[test]
fn every_format_of_several_loops_is_written_and_written_the_same_again() {
    files().iter().for_each(|(file, _)| every_format(file));
}

#[test]
fn every_link_is_a_plate_with_a_hole_for_each_of_its_joints() {
    let folder = TempDir::new().expect("a folder");
    for (file, links) in files() {
        let names: Vec<&str> =
            ["ground", "crank", "coupler", "follower", "link5", "link6", "link7", "link8"][..links].to_vec();
        let svg = exported(folder.path(), &file, "svg-plates", &[]);
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let groups: Vec<&str> = document
            .descendants()
            .filter(|node| node.has_tag_name("g"))
            .filter_map(|node| node.attribute("id"))
            .filter(|id| *id != "labels")
            .collect();
        assert_eq!(groups, names);
        let dxf = exported(folder.path(), &file, "dxf-plates", &["--set", "marks=no"]);
        let layers: BTreeSet<String> = tags(&dxf)
            .iter()
            .filter(|(code, value)| *code == 8 && value.as_str() != "0")
            .map(|(_, value)| value.to_lowercase())
            .collect();
        assert_eq!(layers, names.iter().map(|name| (*name).to_owned()).collect());
        // Each pin has a hole in both of its plates, and P has one.
        let pins = 3 * (links / 2 - 1) + 1;
        let circles = tags(&dxf).iter().filter(|tag| **tag == (0, "CIRCLE".into())).count();
        assert_eq!(circles, 2 * pins + 1);
        let list = exported(folder.path(), &file, "cut-list", &[]);
        assert!(
            list.contains(&format!("{links} plates, {pins} pins of")) && list.contains("a pen or a pin at P"),
            "{list}"
        );
        let skeleton = exported(folder.path(), &file, "svg", &[]);
        let document = roxmltree::Document::parse(&skeleton).expect("XML");
        let has = |id: &str| document.descendants().any(|node| node.attribute("id") == Some(id));
        assert!(
            names[4..].iter().chain(&["A", "B", "C", "D", "X2", "Y2", "F2", "P"]).all(|id| has(id)),
            "{skeleton}"
        );
        assert_eq!((has("F3"), has("crank-plate")), (links == 8, links == 8));
    }
}

#[test]
fn the_answer_of_build_names_the_layers_of_all_links_and_their_joints() {
    let folder = TempDir::new().expect("a folder");
    for (file, links) in files() {
        let (code, out, complaints) = program(folder.path(), &["build", &file]);
        assert_eq!(code, 0, "{complaints}");
        assert!(out.contains("over the full turn of the crank"), "{out}");
        assert!(out.contains("layers, from below: ") || out.contains("No stacking of the"), "{out}");
        assert!(out.contains("link5-link6") && out.contains("X2-F2"), "{out}");
        assert_eq!(out.contains("link7-link8"), links == 8);
        assert!(!out.contains("five layers"), "{out}");
    }
}

#[test]
fn holes_that_run_into_each_other_are_refused_with_a_size_that_would_do() {
    let folder = TempDir::new().expect("a folder");
    let [(file, _), _] = files();
    let (code, _, complaints) =
        program(folder.path(), &["export", &file, "--format", "dxf-plates", "--set", "hole_mm=30"]);
    assert_eq!(code, 2, "{complaints}");
    assert!(
        complaints.contains("run into each other") && complaints.contains("choose hole_mm below"),
        "{complaints}"
    );
}
