//! Exports and `build` of six-bars and eight-bars: every format, all plates, a stacking in words.

use super::dxf::tags;
use super::program;
use crate::common::root;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The second dyad hangs on the crank and the coupler, the third on the second and on a pivot of its own.
const EIGHT_BAR: &str = r#"format = 1
unit = "mm"
[chain]
trace = "P"
pivots = { A = [0, 0], B = [60, 10], G = [40, -70] }
crank = { pivot = "A", joint = "C", length = 15 }
[[chain.dyad]]
joint = "D"
from = ["C", "B"]
lengths = [50, 40]
side = 1
[[chain.point]]
name = "S"
on = ["A", "C"]
at = [5, -12]
[[chain.point]]
name = "T"
on = ["C", "D"]
at = [25, -20]
[[chain.dyad]]
joint = "F"
from = ["S", "T"]
lengths = [45, 50]
side = -1
[[chain.point]]
name = "U"
on = ["S", "F"]
at = [55, 6]
[[chain.dyad]]
joint = "H"
from = ["U", "G"]
lengths = [60, 55]
side = 1
[[chain.point]]
name = "P"
on = ["U", "H"]
at = [20, -30]
"#;

/// Writes the eight-bar; returns it and the shipped six-bar, each with its number of links.
fn files(folder: &Path) -> [(String, usize); 2] {
    fs::write(folder.join("eight-bar.toml"), EIGHT_BAR).expect("there is room");
    [
        (root().join("problems/linkages/watt-six-bar.toml").display().to_string(), 6),
        ("eight-bar.toml".to_owned(), 8),
    ]
}

fn exported(folder: &Path, linkage: &str, format: &str, more: &[&str]) -> String {
    let mut arguments = vec!["export", linkage, "--format", format];
    arguments.extend(more);
    let (code, out, complaints) = program(folder, &arguments);
    assert_eq!(code, 0, "{linkage} {format}: {complaints}");
    out
}

#[test]
fn every_format_of_several_loops_is_written_and_written_the_same_again() {
    let folder = TempDir::new().expect("a folder");
    for (file, _) in files(folder.path()) {
        for format in [
            "svg",
            "svg-plates",
            "dxf",
            "dxf-plates",
            "stl",
            "scad",
            "csv",
            "toml",
            "json",
            "cut-list",
            "cut-list-csv",
        ] {
            let out = exported(folder.path(), &file, format, &[]);
            assert!(out.len() > 100 && !out.contains("NaN") && !out.contains("inf"), "{file} {format}");
            assert_eq!(exported(folder.path(), &file, format, &[]), out, "{file} {format}");
        }
    }
}

#[test]
fn every_link_is_a_plate_with_a_hole_for_each_of_its_joints() {
    let folder = TempDir::new().expect("a folder");
    for (file, links) in files(folder.path()) {
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
    for (file, links) in files(folder.path()) {
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
    let [(file, _), _] = files(folder.path());
    let (code, _, complaints) =
        program(folder.path(), &["export", &file, "--format", "dxf-plates", "--set", "hole_mm=30"]);
    assert_eq!(code, 2, "{complaints}");
    assert!(
        complaints.contains("run into each other") && complaints.contains("choose hole_mm below"),
        "{complaints}"
    );
}
