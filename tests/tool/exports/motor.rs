//! Holes for a motor at A: their sizes in every format, wider plates around them, and refusals.

use super::{attribute, mm, settings, solids, subjects, tags, text};
use linkwright::internals::mechanism::plates::{Link, Plate};
use linkwright::internals::report::export::{Format, Subject, export};
use std::f64::consts::PI;

/// A shaft of 0.7 mm in the crank and a boss of 1.6 mm in the ground, pins of 0.5 mm.
const SET: [(&str, &str); 6] = [
    ("hole_mm", "0.5"),
    ("motor_hole_mm", "0.7"),
    ("boss_hole_mm", "1.6"),
    ("margin_mm", "1"),
    ("gap_mm", "2"),
    ("thickness_mm", "2"),
];

/// The diameter that a hole must have, from its plate and its letters.
fn wanted(link: Link, joints: &str) -> f64 {
    match link {
        Link::Crank if joints.contains('A') => 0.7,
        Link::Ground if joints.contains('A') => 1.6,
        _ => 0.5,
    }
}

/// The plates in millimetres, each with a margin of 1 around its largest hole.
fn plates(subject: &Subject) -> Vec<Plate> {
    let factor = mm(subject.unit);
    let plate = |plate: Plate| {
        let radius = match plate.link {
            Link::Ground => 1.8,
            Link::Crank => 1.35,
            _ => 1.25,
        };
        let mut holes = plate.holes;
        holes.iter_mut().for_each(|hole| hole.at *= factor);
        Plate::new(plate.link, holes, radius)
    };
    Plate::all(subject.linkage.four_bar().expect("a four-bar"), 0.0).map(plate).to_vec()
}

#[test]
fn the_holes_of_a_motor_are_in_every_drawing_with_plates_as_wide_as_they_need() {
    for subject in subjects() {
        let svg = text(&subject, Format::SvgPlates, &SET);
        let document = roxmltree::Document::parse(&svg).expect("XML");
        let dxf = text(&subject, Format::DxfPlates, &SET);
        let solids = solids(&text(&subject, Format::Stl, &SET));
        let csv = text(&subject, Format::CutListCsv, &SET);
        let mut rows = csv::Reader::from_reader(csv.as_bytes());
        let rows: Vec<csv::StringRecord> = rows.records().map(|row| row.expect("a row")).collect();
        for plate in plates(&subject) {
            let (link, name) = (plate.link, plate.link.name());
            let holes = plate.distinct_holes();
            for (joints, _) in &holes {
                let id = format!("{name}-{joints}");
                let circle = document.descendants().find(|n| n.attribute("id") == Some(&id)).expect("a hole");
                assert!((2.0 * attribute(circle, "r") - wanted(link, joints)).abs() < 1e-9, "{id}");
            }
            let group = document.descendants().find(|n| n.attribute("id") == Some(name)).expect("a group");
            let outline = group.children().find_map(|n| n.attribute("d")).expect("a path");
            let area = kurbo::Shape::area(&kurbo::BezPath::from_svg(outline).expect("path data")).abs();
            assert!((area - plate.area()).abs() < 2e-3 * plate.area(), "{name} {area}");

            // The radii of the circles on the plate's layer.
            let layer = name.to_uppercase();
            let mut radii: Vec<f64> = Vec::new();
            let (mut kind, mut on) = (String::new(), String::new());
            for (code, value) in tags(&dxf) {
                match code {
                    0 => (kind, on) = (value.to_owned(), String::new()),
                    8 => on = value.to_owned(),
                    40 if kind == "CIRCLE" && on == layer => radii.push(value.parse().expect("a radius")),
                    _ => {}
                }
            }
            let all: Vec<f64> = holes.iter().map(|(joints, _)| 0.5 * wanted(link, joints)).collect();
            assert_eq!(radii, all, "{name}");

            let bare: f64 = holes.iter().map(|(joints, _)| PI * (0.5 * wanted(link, joints)).powi(2)).sum();
            let net = plate.area() - bare;
            for row in rows.iter().filter(|row| &row[0] == name) {
                let number = |i: usize| row[i].parse::<f64>().expect("a number");
                assert!((number(9) - net).abs() < 1e-9 * net, "{name}");
                assert_eq!(
                    (number(10), number(11)),
                    (wanted(link, &row[2]), wanted(link, &row[3])),
                    "{name}"
                );
            }
            let (_, triangles) = solids.iter().find(|(solid, _)| solid == name).expect("a solid");
            let volume: f64 = triangles
                .iter()
                .map(|corners| {
                    let [u, v, w] =
                        corners.each_ref().map(|v| v.each_ref().map(|x| x.parse::<f64>().expect("x")));
                    (u[0] * (v[1] * w[2] - v[2] * w[1])
                        + u[1] * (v[2] * w[0] - v[0] * w[2])
                        + u[2] * (v[0] * w[1] - v[1] * w[0]))
                        / 6.0
                })
                .sum();
            assert!((volume - 2.0 * net).abs() < 5e-3 * volume, "{name} {volume} {net}");
        }
        let scad = text(&subject, Format::Scad, &SET);
        assert!(scad.contains("\nmotor_hole = 0.7;") && scad.contains("\nboss_hole = 1.6;"), "{scad}");
        let list = text(&subject, Format::CutList, &SET);
        assert!(list.contains(", at A 0.7 mm in the crank and 1.6 mm in the ground,"), "{list}");
        assert!(
            list.contains(" 3 pins ") != (subject.linkage.four_bar().expect("a four-bar").ground() == 0.0),
            "{list}"
        );
        // The boss is as wide as the shaft where nothing else is said, and what is not set follows the others.
        let shaft = text(&subject, Format::CutList, &SET[..2]);
        assert!(shaft.contains(", at A 0.7 mm in the crank and 0.7 mm in the ground,"), "{shaft}");
        assert!(text(&subject, Format::Scad, &SET[..1]).contains("\nmotor_hole = hole;"));
    }
}

#[test]
fn holes_of_a_motor_that_have_no_room_are_refused_with_what_would_do() {
    // A and C are 20 apart, A and B 41.2.
    let subject = &subjects()[0];
    let refused = |format, set: &[(&str, &str)]| {
        export(subject, format, &settings(format, set)).expect_err("a refusal")
    };
    for format in [Format::SvgPlates, Format::DxfPlates, Format::Stl, Format::Scad, Format::CutList] {
        let refusal = refused(format, &[("hole_mm", "4"), ("motor_hole_mm", "36")]);
        assert_eq!(refusal.setting, Some(("motor_hole_mm".to_owned(), "36".to_owned())));
        assert_eq!(
            refusal.message,
            "a hole of 36 mm at A and one of 4 mm at C of the crank run into each other: they are 20 mm apart"
        );
        assert_eq!(refusal.help, "choose motor_hole_mm below 36, or a larger scale");
    }
    let boss = refused(Format::Stl, &[("hole_mm", "4"), ("motor_hole_mm", "6"), ("boss_hole_mm", "90")]);
    assert!(boss.help.starts_with("choose boss_hole_mm below 78.5"), "{}", boss.help);
    let both = refused(Format::Stl, &[("hole_mm", "41"), ("motor_hole_mm", "42")]);
    assert_eq!(both.help, "choose smaller holes (hole_mm, motor_hole_mm), or a larger scale");
    let kerf = refused(Format::DxfPlates, &[("hole_mm", "4"), ("motor_hole_mm", "1"), ("kerf_mm", "1")]);
    assert_eq!(kerf.help, "choose kerf_mm below motor_hole_mm");
    // As large as there is room for.
    assert!(
        export(subject, Format::Stl, &settings(Format::Stl, &[("hole_mm", "4"), ("motor_hole_mm", "35.9")]))
            .is_ok()
    );
}
