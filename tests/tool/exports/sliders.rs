//! Exports and `build` of linkages with a slider: the slot in every format, refusals in words.

use super::dxf::tags;
use super::{every_format, exported, program};
use crate::common::root;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

const KINDS: [&str; 2] = ["slider-crank", "inverted-slider-crank"];

fn file(kind: &str) -> String {
    root().join("problems/linkages").join(format!("{kind}.toml")).display().to_string()
}

#[test]
fn every_format_of_both_kinds_is_written_and_written_the_same_again() {
    KINDS.iter().for_each(|kind| every_format(&file(kind)));
}

#[test]
fn drawings_show_the_rail_or_the_rod_the_slot_and_the_block() {
    let folder = TempDir::new().expect("a folder");
    for (kind, line, joints) in [(KINDS[0], "rail", "ACDP"), (KINDS[1], "rod", "ABCP")] {
        let svg = exported(folder.path(), &file(kind), "svg", &[]);
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let has = |id: &str| document.descendants().any(|n| n.attribute("id") == Some(id));
        assert!(has(line) && has("slot") && has("block") && has("crank") && has("coupler"), "{svg}");
        assert!(joints.chars().all(|joint| has(&joint.to_string())), "{svg}");
        assert_eq!((has("B"), has("D")), (kind == KINDS[1], kind == KINDS[0]));
        let dxf = exported(folder.path(), &file(kind), "dxf", &[]);
        let on_slider = tags(&dxf).iter().filter(|tag| **tag == (8, "SLIDER".into())).count();
        assert_eq!(on_slider, 3, "the line, the slot and the block");
    }
}

#[test]
fn the_slotted_plate_has_a_second_closed_contour_as_wide_as_a_hole_less_the_kerf() {
    let folder = TempDir::new().expect("a folder");
    for (kind, layer) in [(KINDS[0], "GROUND"), (KINDS[1], "COUPLER")] {
        let more = ["--set", "hole_mm=4", "--set", "kerf_mm=0.2", "--set", "marks=no"];
        let dxf = exported(folder.path(), &file(kind), "dxf-plates", &more);
        let tags = tags(&dxf);
        let mut contours: Vec<(String, Vec<f64>)> = Vec::new();
        let mut current = None;
        for (code, value) in &tags {
            match (code, value.as_str()) {
                (0, kind) => current = Some(kind.to_owned()),
                (8, on) if current.as_deref() == Some("LWPOLYLINE") => {
                    contours.push((on.to_owned(), Vec::new()))
                }
                (20, y) if current.as_deref() == Some("LWPOLYLINE") => {
                    contours.last_mut().expect("a layer").1.push(y.parse().expect("a number"));
                }
                _ => {}
            }
        }
        for (plate, count) in
            ["GROUND", "CRANK", "COUPLER", "BLOCK"].map(|plate| (plate, 1 + usize::from(plate == layer)))
        {
            assert_eq!(contours.iter().filter(|(on, _)| on == plate).count(), count, "{plate} of a {kind}");
        }
        // The rail and the rod lie along the sheet.
        let slot = &contours.iter().filter(|(on, _)| on == layer).nth(1).expect("a slot").1;
        let high = slot.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let low = slot.iter().copied().fold(f64::INFINITY, f64::min);
        assert!((high - low - 3.8).abs() < 1e-9, "{} wide", high - low);
    }
}

#[test]
fn the_cut_list_gives_the_slot_by_its_ends() {
    let folder = TempDir::new().expect("a folder");
    let list = exported(folder.path(), &file(KINDS[0]), "cut-list", &["--set", "hole_mm=4"]);
    // a = 30, b = 90, 10 from the line: sqrt(120^2 - 10^2) - sqrt(60^2 - 10^2) of travel, and 20 for the block.
    let slot = (120f64.powi(2) - 100.0).sqrt() - (60f64.powi(2) - 100.0).sqrt() + 20.0;
    assert!(list.contains(&format!("S to T {slot:.3}")), "{list}");
    assert!(list.contains("E to F 16.000") && list.contains("5 pins of 4.000 mm"), "{list}");
    assert!(list.contains("slot in the ground: 4.000 mm wide"), "{list}");
    let list = exported(folder.path(), &file(KINDS[1]), "cut-list", &[]);
    assert!(
        list.contains("slot in the coupler") && list.contains("P lies in the slot and has no hole"),
        "{list}"
    );
}

fn written(folder: &TempDir, name: &str, text: &str) -> PathBuf {
    let path = folder.path().join(name);
    fs::write(&path, format!("format = 1\nunit = \"mm\"\n{text}")).expect("written");
    path
}

#[test]
fn sliders_that_cannot_be_cut_are_refused_in_words() {
    let folder = TempDir::new().expect("a folder");
    let over = "[slider_crank]\nA = [0, 0]\na = 30\nb = 30\nline_point = [0, 0]\nline_deg = 0\ncoupler_x = 9\ncoupler_y = 9\nt1 = 1\n";
    let apart = "[slider_crank]\nA = [0, 0]\na = 10\nb = 20\nline_point = [0, 99]\nline_deg = 0\ncoupler_x = 9\ncoupler_y = 9\nt1 = 1\n";
    let toggle = "[inverted_slider_crank]\nA = [0, 0]\nB = [80, 0]\na = 60\noffset = 30\ncoupler_x = 99\ncoupler_y = 40\nt1 = 1\n";
    for (name, text, words) in [
        ("over.toml", over, "the slot of the ground runs into its hole at A"),
        ("apart.toml", apart, "is open in its motion"),
        ("toggle.toml", toggle, "the slot of the coupler runs into its hole at C"),
    ] {
        let path = written(&folder, name, text).display().to_string();
        for format in ["svg-plates", "dxf-plates", "stl", "scad", "cut-list", "cut-list-csv"] {
            let (code, _, complaints) = program(folder.path(), &["export", &path, "--format", format]);
            assert_eq!(code, 2, "{name} {format}");
            assert!(
                complaints.contains(words) && complaints.contains("help:"),
                "{name} {format}: {complaints}"
            );
        }
        let (code, _, complaints) = program(folder.path(), &["build", &path]);
        assert_eq!(code, 1, "{name}: {complaints}");
        let remedy = complaints.contains("nothing to build") || complaints.contains("no plates to build");
        assert!(remedy, "{name}: {complaints}");
    }
    // Drawings need no slot of a length that can be cut.
    let over = folder.path().join("over.toml").display().to_string();
    assert_eq!(program(folder.path(), &["export", &over, "--format", "svg"]).0, 0);
    let large = ["export", &file(KINDS[0]), "--format", "stl", "--set", "hole_mm=40"];
    let (code, _, complaints) = program(folder.path(), &large);
    assert!(code == 2 && complaints.contains("hole_mm=40"), "{complaints}");
}

#[test]
fn chains_of_one_loop_are_exported_as_what_they_are_and_others_are_refused() {
    let folder = TempDir::new().expect("a folder");
    let chain = root().join("problems/linkages/slider-crank-offset.toml").display().to_string();
    assert!(exported(folder.path(), &chain, "cut-list", &[]).contains("slot in the ground"));
    let leg = root().join("problems/linkages/jansen-leg.toml").display().to_string();
    for arguments in [&["export", leg.as_str(), "--format", "dxf"][..], &["build", &leg]] {
        let (code, _, complaints) = program(folder.path(), arguments);
        assert_eq!(code, 2, "{complaints}");
        assert!(
            complaints.contains("none of the linkages that are") && complaints.contains("help:"),
            "{complaints}"
        );
    }
}

#[test]
fn build_says_how_the_block_runs_how_plates_stack_and_what_errors_do() {
    let folder = TempDir::new().expect("a folder");
    for (kind, words) in [
        (
            KINDS[0],
            [
                "in a slot of the ground",
                "1 ground; 2 crank and block; 3 coupler",
                "rail_from",
                "the eight above",
            ],
        ),
        (
            KINDS[1],
            [
                "in a slot of the coupler",
                "1 ground; 2 crank and block; 3 coupler",
                "offset",
                "P lies in the slot",
            ],
        ),
    ] {
        let (code, out, complaints) = program(folder.path(), &["build", &file(kind)]);
        assert_eq!(code, 0, "{complaints}");
        let out = out.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(words.iter().all(|words| out.contains(words)), "{out}");
        assert!(!out.contains("follower"), "{out}");
    }
    let (code, out, _) = program(folder.path(), &["build", &file(KINDS[0]), "--hole", "30"]);
    let out = out.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(code == 0 && out.contains("The slot runs into the hole at A of the ground"), "{out}");
}
