//! Shop data as a person meets them: `export` and `build` with `[shop]` and with `--shop FILE`.

use crate::common::root;
use assert_cmd::Command;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn linkwright(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("linkwright").expect("it is built");
    let output = command.current_dir(folder).env("NO_COLOR", "1").args(arguments).output().expect("it runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (output.status.code().expect("it ends by itself"), text(output.stdout), text(output.stderr))
}

/// Runs a command that has to end well, and returns what it prints.
fn printed(folder: &Path, arguments: &[&str]) -> String {
    let (code, stdout, stderr) = linkwright(folder, arguments);
    assert_eq!(code, 0, "{arguments:?}: {stderr}");
    stdout
}

const LINKAGE: &str = "format = 1\nname = \"arm\"\nunit = \"mm\"\n[linkage]\nA = [0, 0]\nB = [80, 0]\na = 20\nb = 70\nc = 60\n\
    d = 60\ne = 50\nt1 = 1\nt2 = 1\n";
const SHOP: &str = "[shop]\nhole = 4\nmargin = 4\nthickness = 3\n[shop.joint.A]\nhole_in = { crank = 6, ground = 22 }\n\
    [shop.joint.B]\nhole_in = { follower = 10 }\n[shop.body.ground]\nthickness = 6\n";

/// A linkage file `arm.toml` without shop data, one `with.toml` with them, and `shop.toml` with them alone, in inches.
fn written(folder: &Path) {
    fs::write(folder.join("arm.toml"), LINKAGE).expect("written");
    fs::write(folder.join("with.toml"), format!("{LINKAGE}{SHOP}")).expect("written");
    let inches: String = SHOP
        .split_inclusive(|c: char| !c.is_ascii_digit())
        .map(|part| {
            let end = part.trim_end_matches(|c: char| !c.is_ascii_digit()).len();
            let (number, rest) = part.split_at(end);
            number.parse::<f64>().map_or_else(|_| part.to_owned(), |mm| format!("{:?}{rest}", mm / 25.4))
        })
        .collect();
    fs::write(folder.join("shop.toml"), format!("format = 1\nunit = \"in\"\n{inches}")).expect("written");
}

#[test]
fn shop_data_that_repeat_the_settings_change_no_byte_of_a_drawing() {
    let folder = TempDir::new().expect("a folder");
    let shop = "[shop]\nhole = 5\nmargin = 6\nthickness = 2\n[shop.joint.C]\nhole = 5\n[shop.body.crank]\nwidth = 17\n";
    fs::write(folder.path().join("arm.toml"), LINKAGE).expect("written");
    fs::write(folder.path().join("with.toml"), format!("{LINKAGE}{shop}")).expect("written");
    let set = ["--set", "hole_mm=5", "--set", "margin_mm=6"];
    for (format, more) in [
        ("dxf-plates", &set[..]),
        ("svg-plates", &set[..]),
        ("stl", &["--set", "hole_mm=5", "--set", "margin_mm=6", "--set", "thickness_mm=2"][..]),
        ("dxf", &set[..2]),
        ("svg", &set[..2]),
    ] {
        let plain: Vec<&str> =
            ["export", "arm.toml", "--format", format].into_iter().chain(more.iter().copied()).collect();
        let with = printed(folder.path(), &["export", "with.toml", "--format", format]);
        assert_eq!(printed(folder.path(), &plain), with, "{format}");
    }
}

#[test]
fn a_file_of_shop_data_in_another_unit_gives_the_same_cut_list_as_the_table() {
    let folder = TempDir::new().expect("a folder");
    written(folder.path());
    let own = printed(folder.path(), &["export", "with.toml", "--format", "cut-list"]);
    let alone = ["export", "arm.toml", "--format", "cut-list", "--shop", "shop.toml"];
    let rows = |text: &str| -> Vec<String> { text.lines().skip(4).map(str::to_owned).collect() };
    assert_eq!(rows(&own), rows(&printed(folder.path(), &alone)));
    // The stack from below: ground 6, crank and follower 3, coupler 3.
    for words in [
        "layers, from below: ground, crank and follower, coupler",
        "A                6.000       9.000   ground, crank\n",
        "B                4.000       9.000   ground, follower\n",
        "C                4.000       6.000   crank, coupler\n",
        "4 pins, 0 spacers",
    ] {
        assert!(own.contains(words), "{words} in\n{own}");
    }
    let csv = printed(folder.path(), &["export", "with.toml", "--format", "cut-list-csv"]);
    let pin = csv.lines().find(|line| line.starts_with("pin A,")).expect("a row");
    assert_eq!(pin, "pin A,,ground,crank,,,9,6,,,,");
    let ground = csv.lines().find(|line| line.starts_with("ground,2,A,B,")).expect("a row");
    assert_eq!(ground.split(',').skip(10).collect::<Vec<_>>(), ["22", "4"]);
    assert_eq!(ground.split(',').nth(8), Some("6"));
}

#[test]
fn build_warns_of_thin_rims_and_the_rule_can_be_set() {
    let folder = TempDir::new().expect("a folder");
    written(folder.path());
    let told = printed(folder.path(), &["build", "with.toml"]);
    let told = told.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "Holes 4 mm, at A 6 mm in the crank and 22 mm in the ground, at B 10 mm in the follower and 4 mm in the ground",
        "Plates 3 mm thick, the ground 6 mm; pins end flush with their plates.",
        "Rims are to be 0.7 of the hole's diameter wide",
        "Thin rim: the ground is 4 mm wide between the hole at A and the edge, where the hole of 22 mm at A needs 15.4 mm",
        "Thin rim: the follower is 4 mm wide between the hole at B and the edge, where the hole of 10 mm at B needs 7 mm",
    ] {
        assert!(told.contains(words), "{words} in\n{told}");
    }
    assert_eq!(told.matches("Thin rim").count(), 3, "{told}");
    let eased = SHOP.replace("thickness = 3\n", "thickness = 3\nrim = 3\n");
    fs::write(folder.path().join("eased.toml"), format!("format = 1\nunit = \"mm\"\n{eased}"))
        .expect("written");
    let told = printed(folder.path(), &["build", "arm.toml", "--shop", "eased.toml"]);
    assert!(
        told.contains("Rims are to be 3 mm wide (rim of [shop]).") && !told.contains("Thin rim"),
        "{told}"
    );
    // Without shop data nothing is said of rims, however thin they are.
    let told = printed(folder.path(), &["build", "arm.toml", "--hole", "4", "--margin", "0.5"]);
    assert!(!told.contains("rim") && !told.contains("Rims"), "{told}");
}

#[test]
fn every_kind_of_linkage_takes_shop_data_and_names_its_joints() {
    let folder = TempDir::new().expect("a folder");
    fs::write(
        folder.path().join("shop.toml"),
        "format = 1\n[shop.joint.C]\nhole_in = { coupler = 7 }\npin = 3\n[shop.body.coupler]\nthickness = 5\n",
    )
    .expect("written");
    fs::write(folder.path().join("unknown.toml"), "format = 1\n[shop.joint.Z9]\nhole = 3\n")
        .expect("written");
    for (name, joints) in [
        ("hoeken", "A, B, C, D, P"),
        ("slider-crank", "A, C, D, E, F, P"),
        ("inverted-slider-crank", "A, B, C, E, F, P"),
        ("watt-six-bar", "A, B, C, D, X2, Y2, F2, P"),
    ] {
        let linkage = root().join(format!("problems/linkages/{name}.toml")).display().to_string();
        let scale = format!("scale={}", if name == "hoeken" { 30 } else { 4 });
        for format in ["dxf-plates", "svg-plates", "dxf", "svg", "stl", "scad", "cut-list", "cut-list-csv"] {
            let arguments = [
                "export",
                &linkage,
                "--format",
                format,
                "--shop",
                "shop.toml",
                "--set",
                &scale,
                "--set",
                "hole_mm=4",
            ];
            printed(folder.path(), &arguments);
        }
        let unknown = ["export", &linkage, "--format", "stl", "--shop", "unknown.toml"];
        let (code, _, stderr) = linkwright(folder.path(), &unknown);
        assert_eq!(code, 2, "{stderr}");
        assert!(stderr.contains(&format!("joints of this linkage: {joints}\n")), "{stderr}");
    }
}

#[test]
fn sizes_that_do_not_fit_are_refused_with_place_and_remedy() {
    let folder = TempDir::new().expect("a folder");
    written(folder.path());
    let shop = |name: &str, text: &str| {
        fs::write(folder.path().join(name), format!("format = 1\n{text}")).expect("written");
    };
    shop("narrow.toml", "[shop.body.crank]\nwidth = 9\n");
    shop("near.toml", "[shop.joint.C]\nhole_in = { crank = 40 }\n");
    shop("empty.toml", "");
    fs::write(folder.path().join("bare.toml"), LINKAGE.replace("unit = \"mm\"\n", "")).expect("written");
    for (arguments, words) in [
        (
            vec!["build", "arm.toml", "--shop", "narrow.toml", "--hole", "9"],
            "[shop] body.crank.width: a hole of 9 at A",
        ),
        (vec!["build", "bare.toml", "--shop", "shop.toml"], "the linkage has no unit"),
        (vec!["build", "arm.toml", "--shop", "none.toml"], "there is no such file"),
        (vec!["build", "arm.toml", "--shop", "empty.toml"], "a shop file has a table [shop]"),
        (
            vec!["build", "arm.toml", "--shop", "narrow.toml", "--hole", "4", "--motor-hole", "9"],
            "a hole of 9 at A",
        ),
        (vec!["export", "arm.toml", "--format", "csv", "--shop", "narrow.toml"], "means nothing for csv"),
        (
            vec![
                "export",
                "arm.toml",
                "--format",
                "dxf-plates",
                "--shop",
                "narrow.toml",
                "--set",
                "motor_hole_mm=10",
            ],
            "a hole of 10 at A does not fit into the crank, which is 9 wide (mm)",
        ),
        (
            vec!["export", "arm.toml", "--format", "stl", "--shop", "narrow.toml", "--set", "hole_mm=9"],
            "a hole of 9 at A does not fit into the crank, which is 9 wide (mm)",
        ),
        (
            vec!["export", "arm.toml", "--format", "dxf-plates", "--shop", "near.toml"],
            "choose the hole of [shop.joint.C] below 36, or a larger scale",
        ),
    ] {
        let (code, _, stderr) = linkwright(folder.path(), &arguments);
        assert_eq!(code, 2, "{arguments:?}: {stderr}");
        assert!(stderr.contains(words), "{words} in\n{stderr}");
    }
    let told = printed(folder.path(), &["check", "with.toml", "shop.toml"]);
    assert!(told.contains("; shop: sizes of 2 joints and 1 body\n"), "{told}");
    assert!(
        told.contains("shop.toml: shop: sizes of 2 joints and 1 body; `build RESULT --shop FILE`"),
        "{told}"
    );
}
