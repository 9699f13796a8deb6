//! `export`: every format in millimetres, closed bodies, hostile names, refusals.

mod dxf;
mod motor;
mod several_loops;
mod sliders;

use self::dxf::tags;
use crate::common::root;
use assert_cmd::Command;
use linkwright::internals::mechanism::Unit;
use linkwright::internals::mechanism::plates::{Link, Plate};
use linkwright::internals::mechanism::{AssemblyMode, CouplerSide, FourBar, NaturalCoordinates};
use linkwright::internals::report::export::{Format, Settings, Subject, export};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::path::Path;

const HOSTILE: &str =
    "</title><script>alert(1)</script>\n  0\nEOF\r\n\"]; cube(9); // */ \u{202e}\u{7}é𝄞 ${x}";

fn linkage(numbers: [f64; 9], side: CouplerSide) -> FourBar {
    let [ax, ay, bx, by, crank, coupler, follower, crank_side, follower_side] = numbers;
    FourBar::new(NaturalCoordinates {
        crank_pivot: [ax, ay],
        follower_pivot: [bx, by],
        crank,
        coupler,
        follower,
        crank_side,
        follower_side,
        assembly: AssemblyMode::Plus,
        side,
    })
    .expect("a linkage")
}

fn subject(linkage: FourBar, unit: Option<Unit>) -> Subject {
    Subject {
        name: "test".into(),
        standing: "a linkage file".into(),
        unit,
        linkage: linkage.into(),
        target: vec![[1.0, 2.0], [3.0, 2.5], [4.0, 1.0]],
        closed: true,
        positions: vec![(0.4, AssemblyMode::Plus)],
        motion: Vec::new(),
        frame_deg: None,
        carried: None,
        body_deg: Vec::new(),
        shop: None,
    }
}

/// Ordinary, right-handed, P in line, P on C, coincident pivots.
fn subjects() -> Vec<Subject> {
    let plus = CouplerSide::Plus;
    vec![
        subject(linkage([0.0, 0.0, 40.0, 10.0, 20.0, 50.0, 45.0, 30.0, 35.0], plus), Some(Unit::Mm)),
        subject(
            linkage([-1.0, 0.5, 2.0, 1.0, 1.0, 2.5, 2.75, 1.5, 2.25], CouplerSide::Minus),
            Some(Unit::In),
        ),
        subject(linkage([0.0, 0.0, 4.0, 1.0, 2.0, 5.0, 4.5, 3.0, 2.0], plus), Some(Unit::Cm)),
        subject(linkage([0.0, 0.0, 4.0, 1.0, 2.0, 5.0, 4.5, 0.0, 5.0], plus), None),
        subject(linkage([3.0, 3.0, 3.0, 3.0, 30.0, 10.0, 32.0, 12.0, 9.0], plus), None),
    ]
}

fn settings(format: Format, set: &[(&str, &str)]) -> Settings {
    let pairs: Vec<_> = set
        .iter()
        .filter(|(key, _)| format.settings().contains(key))
        .map(|(k, v)| ((*k).to_owned(), (*v).to_owned()))
        .collect();
    Settings::parse(format, &pairs).expect("settings")
}

fn text(subject: &Subject, format: Format, set: &[(&str, &str)]) -> String {
    let exported = export(subject, format, &settings(format, set)).unwrap_or_else(|e| panic!("{e}"));
    String::from_utf8(exported.bytes).expect("text")
}

fn mm(unit: Option<Unit>) -> f64 {
    match unit {
        Some(Unit::Cm) => 10.0,
        Some(Unit::M) => 1000.0,
        Some(Unit::In) => 25.4,
        Some(Unit::Mm) | None => 1.0,
    }
}

/// The linkage's own size times `factor`, computed apart from the program.
fn plates_of(subject: &Subject, factor: f64, radius: f64) -> Vec<Plate> {
    let plates = Plate::all(subject.linkage.four_bar().expect("a four-bar"), 0.0).map(|plate| {
        let mut holes = plate.holes;
        holes.iter_mut().for_each(|hole| hole.at *= factor);
        Plate::new(plate.link, holes, radius)
    });
    plates.to_vec()
}

// ---- SVG ----

fn attribute(node: roxmltree::Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name).unwrap_or_else(|| panic!("{name}")).parse().expect("a number")
}

#[test]
fn svg_dimensions_are_true_millimetres() {
    for subject in subjects() {
        let factor = 2.0 * mm(subject.unit);
        let svg = text(&subject, Format::Svg, &[("scale", "2"), ("hole_mm", "1.5")]);
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let page = document.root_element();
        let size = |name: &str| -> f64 {
            let text = page.attribute(name).expect("a size");
            text.strip_suffix("mm").expect("in mm").parse().expect("a number")
        };
        let view: Vec<f64> =
            page.attribute("viewBox").expect("a view").split(' ').map(|x| x.parse().expect("x")).collect();
        assert_eq!(view, [0.0, 0.0, size("width"), size("height")]);
        let at = |id: &str| {
            let node = document.descendants().find(|n| n.attribute("id") == Some(id)).expect("a joint");
            assert!((attribute(node, "r") - 0.75).abs() < 1e-9);
            let (x, y) = (attribute(node, "cx"), attribute(node, "cy"));
            assert!(x > 0.0 && x < view[2] && y > 0.0 && y < view[3]);
            (x, y)
        };
        let apart = |p: &str, q: &str| (at(p).0 - at(q).0).hypot(at(p).1 - at(q).1);
        let n = subject.linkage.four_bar().expect("a four-bar").natural_coordinates();
        let expected = [
            ("A", "B", subject.linkage.ground().expect("a four-bar has one")),
            ("A", "C", n.crank),
            ("C", "D", n.coupler),
            ("B", "D", n.follower),
            ("C", "P", n.crank_side),
            ("D", "P", n.follower_side),
        ];
        for (p, q, length) in expected {
            assert!((apart(p, q) - factor * length).abs() < 1e-6, "{p}{q}");
        }
        // y is turned: the sign of the turn from C -> D to C -> P is the other one on the page.
        let ((cx, cy), (dx, dy), (px, py)) = (at("C"), at("D"), at("P"));
        let turn = (dx - cx) * (py - cy) - (dy - cy) * (px - cx);
        assert!(turn * n.side.sign() < 1e-6);
    }
}

#[test]
fn plates_on_a_sheet_lie_within_it_and_apart() {
    for subject in subjects() {
        let free = [("hole_mm", "0.5"), ("margin_mm", "1"), ("gap_mm", "2")];
        let size = |svg: &str| {
            let document = roxmltree::Document::parse(svg).expect("XML");
            let side = |name| {
                let text = document.root_element().attribute(name).expect("a size").trim_end_matches("mm");
                text.parse::<f64>().expect("a number")
            };
            (side("width"), side("height"))
        };
        let boxes = |svg: &str| -> Vec<kurbo::Rect> {
            let document = roxmltree::Document::parse(svg).expect("XML");
            let data = document.descendants().filter_map(|node| node.attribute("d"));
            let path = |data| kurbo::BezPath::from_svg(data).expect("path data");
            data.map(|data| kurbo::Shape::bounding_box(&path(data))).collect()
        };
        // Around the plates the gap is free.
        let (width, height) = size(&text(&subject, Format::SvgPlates, &free));
        let (width, height) = (width - 4.0, height - 4.0);
        // Less high than one column: in more of them, none wider than the widest plate.
        let room = (4.0 * width + 12.0, 0.97 * height);
        let sheet = format!("{}x{}", room.0, room.1);
        let mut set = free.to_vec();
        set.push(("sheet_mm", sheet.as_str()));
        let svg = text(&subject, Format::SvgPlates, &set);
        // The page is the sheet: its corner is the layout's.
        let page = size(&svg);
        assert!((page.0 - room.0).abs() < 1e-6 && (page.1 - room.1).abs() < 1e-6, "{page:?} of {room:?}");
        let plates = boxes(&svg);
        let sheet_at = kurbo::Rect::new(-1e-3, -1e-3, room.0 + 1e-3, room.1 + 1e-3);
        let all = plates.iter().copied().reduce(|one, other| one.union(other)).expect("plates");
        assert!(sheet_at.union(all) == sheet_at && all.width() > width + 1.0, "{all:?} of {room:?}");
        assert!(all.x0.abs() < 1e-3 && (all.y1 - room.1).abs() < 1e-3, "{all:?} of {room:?}");
        for (i, one) in plates.iter().enumerate() {
            for other in &plates[..i] {
                let apart = (one.x0 - other.x1).max(other.x0 - one.x1);
                let above = (one.y0 - other.y1).max(other.y0 - one.y1);
                assert!(apart.max(above) > 2.0 - 1e-3, "{one:?} {other:?}");
            }
        }
        set[3].1 = "3x2";
        let settings = settings(Format::SvgPlates, &set);
        let refused = export(&subject, Format::SvgPlates, &settings).expect_err("too small");
        assert!(refused.message.contains("3 x 2 mm") && refused.help.contains("would do"), "{refused}");
    }
}

#[test]
fn svg_plates_have_the_outline_of_the_plates() {
    for subject in subjects() {
        let set = [("hole_mm", "0.5"), ("margin_mm", "1"), ("kerf_mm", "0.1"), ("gap_mm", "2")];
        let svg = text(&subject, Format::SvgPlates, &set);
        let document = roxmltree::Document::parse(&svg).expect("XML");
        for plate in plates_of(&subject, mm(subject.unit), 1.3) {
            let name = plate.link.name();
            let group = document.descendants().find(|n| n.attribute("id") == Some(name)).expect("a group");
            let holes: Vec<_> = group.children().filter(|n| n.has_tag_name("circle")).collect();
            assert_eq!(holes.len(), plate.distinct_holes().len());
            let place = |i: usize| (attribute(holes[i], "cx"), attribute(holes[i], "cy"));
            for (i, hole) in holes.iter().enumerate() {
                assert!((attribute(*hole, "r") - 0.2).abs() < 1e-9);
                let wanted = (plate.distinct_holes()[i].1 - plate.distinct_holes()[0].1).norm();
                let apart = (place(i).0 - place(0).0).hypot(place(i).1 - place(0).1);
                assert!((apart - wanted).abs() < 1e-6);
            }
            // The path's length by its own commands is the perimeter.
            let data = group.children().find_map(|n| n.attribute("d")).expect("a path");
            let path = kurbo::BezPath::from_svg(data).expect("path data");
            use kurbo::{ParamCurveArclen, Shape};
            let length: f64 = path.segments().map(|segment| segment.arclen(1e-7)).sum();
            assert!((length - plate.perimeter()).abs() < 2e-3 * plate.perimeter(), "{name} {length}");
            assert!((path.area().abs() - plate.area()).abs() < 2e-3 * plate.area(), "{name}");
        }
    }
}

// ---- STL ----

/// A solid: name and triangles, corners as they are written.
type Solid = (String, Vec<[[String; 3]; 3]>);

/// The solids of a file.
fn solids(stl: &str) -> Vec<Solid> {
    let mut found: Vec<Solid> = Vec::new();
    let mut corners: Vec<[String; 3]> = Vec::new();
    for line in stl.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["solid", name, ..] => found.push((name.to_owned(), Vec::new())),
            ["vertex", x, y, z] => corners.push([x.to_owned(), y.to_owned(), z.to_owned()]),
            ["endfacet"] => {
                let triangle: [[String; 3]; 3] =
                    std::mem::take(&mut corners).try_into().expect("three corners");
                found.last_mut().expect("a solid").1.push(triangle);
            }
            _ => {}
        }
    }
    found
}

#[test]
fn stl_plates_are_closed_oriented_and_have_their_volume() {
    for subject in subjects() {
        for (hole, chord) in [(0.5, 0.002), (1.2, 0.0005)] {
            let (h, c) = (hole.to_string(), chord.to_string());
            let set =
                [("hole_mm", h.as_str()), ("margin_mm", "1"), ("thickness_mm", "2.5"), ("chord_mm", &c)];
            let stl = text(&subject, Format::Stl, &set);
            let plates = plates_of(&subject, mm(subject.unit), 0.5 * hole + 1.0);
            let solids = solids(&stl);
            assert_eq!(solids.len(), 4);
            for ((name, triangles), plate) in solids.iter().zip(plates) {
                assert_eq!(name, plate.link.name());
                let mut edges: BTreeMap<(&[String; 3], &[String; 3]), i32> = BTreeMap::new();
                let mut volume = 0.0;
                let (mut vertices, mut faces) = (std::collections::BTreeSet::new(), 0);
                for triangle in triangles {
                    for i in 0..3 {
                        *edges.entry((&triangle[i], &triangle[(i + 1) % 3])).or_default() += 1;
                        vertices.insert(&triangle[i]);
                    }
                    faces += 1;
                    let p = triangle.each_ref().map(|v| v.each_ref().map(|x| x.parse::<f64>().expect("x")));
                    let [u, v, w] = p;
                    volume += (u[0] * (v[1] * w[2] - v[2] * w[1])
                        + u[1] * (v[2] * w[0] - v[0] * w[2])
                        + u[2] * (v[0] * w[1] - v[1] * w[0]))
                        / 6.0;
                }
                for ((from, to), count) in &edges {
                    assert_eq!((*count, edges.get(&(*to, *from))), (1, Some(&1)), "{name}");
                }
                let holes = plate.distinct_holes().len();
                // V - E + F = 2 - 2 holes.
                let euler = vertices.len() as i64 - edges.len() as i64 / 2 + faces;
                assert_eq!(euler, 2 - 2 * holes as i64, "{name}");
                let expected = 2.5 * (plate.area() - holes as f64 * PI * (0.5 * hole).powi(2));
                let slack = 2.5 * chord * 2.0 * PI * (plate.radius + hole * holes as f64);
                assert!((volume - expected).abs() < slack + 1e-5 * expected, "{name} {volume} {expected}");
            }
        }
    }
}

// ---- the others ----

#[test]
fn scad_parameters_are_the_linkage_in_millimetres() {
    for subject in subjects() {
        let scad = text(&subject, Format::Scad, &[("hole_mm", "0.75"), ("scale", "3")]);
        let number = |name: &str| -> f64 {
            let head = format!("{name} = ");
            let line = scad.lines().find(|line| line.starts_with(&head)).expect("a parameter");
            line[head.len()..].split(';').next().expect("a value").parse().expect("a number")
        };
        let (factor, n) =
            (3.0 * mm(subject.unit), subject.linkage.four_bar().expect("a four-bar").natural_coordinates());
        for (name, value) in [("a", n.crank), ("b", n.coupler), ("c", n.follower), ("Ax", n.crank_pivot[0])] {
            assert_eq!(number(name), value * factor, "{name}");
        }
        assert!((number("Px").hypot(number("Py")) - n.crank_side * factor).abs() < 1e-12 * factor);
        assert_eq!((number("hole"), number("t1")), (0.75, 1.0));
    }
}

#[test]
fn linkage_files_read_back_and_scale() {
    let subject = &subjects()[1];
    let toml = text(subject, Format::Toml, &[("scale", "2")]);
    let read = linkwright::internals::files::linkage_file::parse("x.toml", &toml).expect("a linkage file");
    let n = subject.linkage.four_bar().expect("a four-bar").natural_coordinates();
    assert_eq!((read.unit, read.name.as_str()), (Some(Unit::In), "test"));
    assert_eq!(read.linkage.natural_coordinates().crank, 2.0 * n.crank);
    let json: serde_json::Value = serde_json::from_str(&text(subject, Format::Json, &[])).expect("JSON");
    let linkage: FourBar = serde_json::from_value(json["linkage"].clone()).expect("a linkage");
    assert_eq!(
        (&linkage, json["unit"].as_str()),
        (subject.linkage.four_bar().expect("a four-bar"), Some("in"))
    );
    let csv = text(subject, Format::Csv, &[("positions", "24")]);
    assert_eq!(csv.lines().count(), 25);
    assert!(csv.starts_with("crank_deg,t1,t2,Cx,Cy,Dx,Dy,Px,Py,"));
}

#[test]
fn cut_lists_have_every_distance() {
    for subject in subjects() {
        let set = [("hole_mm", "0.5"), ("margin_mm", "1"), ("thickness_mm", "2")];
        let csv = text(&subject, Format::CutListCsv, &set);
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let rows: Vec<csv::StringRecord> = reader.records().map(|row| row.expect("a row")).collect();
        for plate in plates_of(&subject, mm(subject.unit), 1.25) {
            let of: Vec<_> = rows.iter().filter(|row| &row[0] == plate.link.name()).collect();
            let holes = plate.distinct_holes();
            assert_eq!(of.len(), (holes.len() * (holes.len() - 1) / 2).max(1));
            let place = |name: &str| holes.iter().find(|h| h.0 == name).expect("a hole").1;
            for row in of {
                let number = |i: usize| row[i].parse::<f64>().expect("a number");
                assert!((number(4) - (place(&row[2]) - place(&row[3])).norm()).abs() < 1e-9);
                let area = plate.area() - holes.len() as f64 * PI * 0.0625;
                assert!((number(9) - area).abs() < 1e-9 * area);
                assert_eq!((number(5), number(8)), (0.5, 2.0));
            }
        }
        let list = text(&subject, Format::CutList, &set);
        let pins =
            if subject.linkage.four_bar().expect("a four-bar").ground() == 0.0 { "3 pins" } else { "4 pins" };
        assert!(list.contains(pins) && list.contains("material 2.000 mm thick"), "{list}");
        assert_eq!(list.contains("P is on a pin"), subject.linkage.crank_side() == 0.0);
    }
}

#[test]
fn hostile_names_break_out_of_no_format() {
    let mut subject = subjects().remove(0);
    subject.name = HOSTILE.into();
    for format in Format::ALL.iter().copied().filter(|format| format.is_text()) {
        let out = text(&subject, format, &[]);
        assert!(!out.contains('\r') && !out.contains('\u{7}') && !out.contains('\u{202e}'), "{format:?}");
        match format {
            Format::Svg | Format::SvgPlates => {
                let document = roxmltree::Document::parse(&out).expect("XML");
                assert!(!document.descendants().any(|n| n.has_tag_name("script")));
            }
            Format::Dxf | Format::DxfPlates => {
                assert!(out.is_ascii() && out.contains("\\U+00E9\\U+D834\\U+DD1E"));
                assert_eq!(tags(&out).iter().filter(|t| *t == &(0, "EOF".into())).count(), 1);
                assert!(tags(&out).last() == Some(&(0, "EOF".into())));
            }
            Format::Scad => {
                let first = out.lines().next().expect("a line");
                assert!(first.starts_with("// ") && first.contains("cube(9)"));
                assert_eq!(out.matches("cube").count(), 1);
            }
            Format::Toml => {
                linkwright::internals::files::linkage_file::parse("x.toml", &out).expect("a linkage file");
            }
            Format::Json => {
                let json: serde_json::Value = serde_json::from_str(&out).expect("JSON");
                assert!(
                    linkwright::internals::files::name::check(json["name"].as_str().expect("a name")).is_ok()
                );
            }
            _ => {}
        }
    }
}

#[test]
fn settings_that_do_not_fit_are_refused_with_a_remedy() {
    let subject = &subjects()[0];
    let refused = |format: Format, key: &str, value: &str| {
        let pairs = [(key.to_owned(), value.to_owned())];
        let refusal = Settings::parse(format, &pairs)
            .and_then(|settings| export(subject, format, &settings))
            .expect_err("it is refused");
        assert_eq!(refusal.setting, Some((key.to_owned(), value.to_owned())));
        assert!(!refusal.help.is_empty());
        refusal.message
    };
    for (key, value) in [
        ("hole_mm", "0"),
        ("hole_mm", "NaN"),
        ("hole_mm", "-1"),
        ("hole_mm", "1e300"),
        ("hole_mm", "4,5"),
        ("kerf_mm", "-0.1"),
        ("kerf_mm", "1e6"),
        ("margin_mm", "x"),
        ("unit", "furlong"),
        ("unit", "cm"),
        ("scale", "1e8"),
        ("scale", "1e-8"),
        ("hole", "4"),
        ("thickness_mm", "3"),
    ] {
        let message = refused(Format::DxfPlates, key, value);
        assert!(message.contains(key) || key == "kerf_mm" || key == "unit" || key == "scale", "{message}");
    }
    assert!(refused(Format::DxfPlates, "hole_mm", "25").contains("A and C of the crank are 20"));
    assert!(refused(Format::Csv, "hole_mm", "4").contains("means nothing for csv"));
    assert!(refused(Format::Svg, "samples", "1").contains("samples"));
    // A crank angle that a rocker does not reach.
    let rocker = Subject {
        linkage: linkage([0.0, 0.0, 5.0, 0.0, 4.0, 2.0, 2.5, 1.0, 1.5], CouplerSide::Plus).into(),
        ..subject.clone()
    };
    let away = settings(Format::Svg, &[("crank_deg", "180")]);
    assert!(export(&rocker, Format::Svg, &away).expect_err("open").message.contains("cannot be joined"));
    // Links that never meet: no drawing, but plates.
    let apart = Subject {
        linkage: linkage([0.0, 0.0, 50.0, 0.0, 4.0, 2.0, 2.5, 1.0, 1.5], CouplerSide::Plus).into(),
        positions: Vec::new(),
        ..subject.clone()
    };
    let none = settings(Format::Dxf, &[]);
    assert!(export(&apart, Format::Dxf, &none).expect_err("no position").help.contains("dxf-plates"));
    assert!(export(&apart, Format::DxfPlates, &none).is_ok());
}

#[test]
fn defaults_fit_every_linkage_and_are_stated() {
    for subject in subjects() {
        for format in Format::ALL {
            let exported =
                export(&subject, *format, &settings(*format, &[])).unwrap_or_else(|e| panic!("{e}"));
            let notes = exported.notes.join("; ");
            if format.settings().contains(&"hole_mm") {
                assert!(notes.contains("hole_mm = "), "{notes}");
                assert_eq!(notes.contains("no unit is given"), subject.unit.is_none(), "{notes}");
            }
            // The same again, byte for byte.
            let again = export(&subject, *format, &settings(*format, &[])).expect("again");
            assert_eq!(again, exported);
        }
    }
    assert!(
        Plate::of(subjects()[4].linkage.four_bar().expect("a four-bar"), Link::Ground, 1.0)
            .distinct_holes()
            .len()
            == 1
    );
}

fn program(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_linkwright"))
        .args(arguments)
        .current_dir(folder)
        .env("NO_COLOR", "1")
        .output()
        .expect("it runs");
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    (output.status.code().expect("it ends"), text(output.stdout), text(output.stderr))
}

/// Exports a linkage in a format by the command.
fn exported(folder: &Path, linkage: &str, format: &str, more: &[&str]) -> String {
    let mut arguments = vec!["export", linkage, "--format", format];
    arguments.extend(more);
    let (code, out, complaints) = program(folder, &arguments);
    assert_eq!(code, 0, "{linkage} {format}: {complaints}");
    out
}

/// Checks that a linkage is written in every format that is text, and written the same again.
fn every_format(linkage: &str) {
    const FORMATS: [&str; 11] = [
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
    ];
    let folder = tempfile::TempDir::new().expect("a folder");
    for format in FORMATS {
        let out = exported(folder.path(), linkage, format, &[]);
        assert!(out.len() > 100 && !out.contains("NaN") && !out.contains("inf"), "{linkage} {format}");
        assert_eq!(exported(folder.path(), linkage, format, &[]), out, "{linkage} {format}");
    }
}

#[test]
fn the_command_writes_whole_files_or_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let linkage = root().join("problems/linkages/hoeken.toml");
    let linkage = linkage.to_str().expect("a path");
    let run = |arguments: &[&str]| program(folder.path(), arguments);
    let (code, out, err) = run(&["export", linkage, "--format", "dxf-plates", "--out", "h.dxf"]);
    assert_eq!(code, 0, "{err}");
    assert!(out.starts_with("Wrote h.dxf: ") && err.contains("note: by default hole_mm = "), "{out}{err}");
    let (code, out, _) = run(&["export", linkage, "--format", "dxf-plates"]);
    assert_eq!((code, out), (0, std::fs::read_to_string(folder.path().join("h.dxf")).expect("a file")));
    // What is refused leaves the file as it was.
    let before = std::fs::read(folder.path().join("h.dxf")).expect("a file");
    let (code, _, err) =
        run(&["export", linkage, "--format", "dxf-plates", "--set", "hole_mm=1e6", "--out", "h.dxf"]);
    assert!(
        code == 2 && err.contains("--set hole_mm=1e6") && err.contains("help: choose hole_mm below"),
        "{err}"
    );
    assert_eq!(std::fs::read(folder.path().join("h.dxf")).expect("a file"), before);
    let (code, _, err) = run(&["export", linkage, "--format", "dwg"]);
    assert!(code == 2 && err.contains("choose from svg, svg-plates, dxf"), "{err}");
    let (code, _, err) = run(&["export", linkage, "--format", "svg", "--out", "no/such/folder.svg"]);
    assert!(code == 2 && err.contains("folder.svg"), "{err}");
    let (code, _, err) = run(&["export", "nothing-here", "--format", "svg"]);
    assert!(code == 2 && err.contains("nothing-here"), "{err}");
    // A chain is no four-bar.
    let chain = root().join("problems/linkages/jansen-leg.toml");
    let (code, _, _) = run(&["export", chain.to_str().expect("a path"), "--format", "svg"]);
    assert_eq!(code, 2);
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 1);
}

#[test]
fn a_record_alone_is_enough() {
    let folder = tempfile::tempdir().expect("a folder");
    let problem = root().join("problems/examples/straight-line.toml");
    let (code, _, err) =
        program(folder.path(), &["synth", problem.to_str().expect("a path"), "--out", "r", "--quiet"]);
    assert_eq!(code, 0, "{err}");
    std::fs::copy(folder.path().join("r/record.json"), folder.path().join("alone.json")).expect("a copy");
    for format in Format::ALL {
        let name = format.name();
        let export = |of: &str, to: &str| {
            // A file of another format stays.
            let to = &format!("{to}.{name}");
            let (code, _, err) = program(folder.path(), &["export", of, "--format", name, "--out", to]);
            assert_eq!(code, 0, "{name} {err}");
            std::fs::read(folder.path().join(to)).expect("a file")
        };
        assert!(export("r", "x") == export("alone.json", "y"), "{name}");
        assert!(export("r:1", "x") == export("alone.json:1", "y"), "{name}");
    }
}

#[cfg(feature = "images")]
#[test]
fn pictures_have_their_size_their_colours_and_their_frames() {
    let subject = &subjects()[0];
    let bytes = |format: Format, set: &[(&str, &str)]| {
        export(subject, format, &settings(format, set)).unwrap_or_else(|e| panic!("{e}")).bytes
    };
    let png = bytes(Format::Png, &[("size_px", "400")]);
    let picture = tiny_skia::Pixmap::decode_png(&png).expect("a PNG");
    assert_eq!(picture.width().max(picture.height()), 400);
    let of = |rgb: [u8; 3]| {
        let same = |p: &&tiny_skia::PremultipliedColorU8| [p.red(), p.green(), p.blue()] == rgb;
        picture.pixels().iter().filter(same).count()
    };
    // Paper, links, curve and P, target.
    let all = picture.pixels().len();
    assert!(of([0xff, 0xff, 0xff]) > all / 2 && of([0x34, 0x49, 0x5e]) > all / 200);
    assert!(of([0xc0, 0x39, 0x2b]) > 100 && of([0x24, 0x71, 0xa3]) > 5);

    let moving = bytes(Format::Gif, &[("size_px", "200"), ("frames", "12")]);
    let mut reader = gif::DecodeOptions::new().read_info(moving.as_slice()).expect("a GIF");
    assert_eq!(reader.width().max(reader.height()), 200);
    let (mut frames, mut different) = (0, 0);
    let mut before: Vec<u8> = Vec::new();
    while let Some(frame) = reader.read_next_frame().expect("a frame") {
        frames += 1;
        different += usize::from(before != *frame.buffer);
        before = frame.buffer.to_vec();
    }
    assert_eq!((frames, different), (12, 12));
}
