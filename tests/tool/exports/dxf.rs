//! Exported DXF, read back tag by tag.

use super::{mm, plates_of, subjects, text};
use linkwright::internals::mechanism::{FourBar, NaturalCoordinates};
use linkwright::internals::report::export::Format;

/// Pairs of code and value.
pub(super) fn tags(dxf: &str) -> Vec<(u16, String)> {
    let lines: Vec<&str> = dxf.lines().collect();
    assert!(lines.len().is_multiple_of(2));
    lines.chunks(2).map(|pair| (pair[0].trim().parse().expect("a code"), pair[1].to_owned())).collect()
}

/// An entity: kind, layer, tags.
type Entity = (String, String, Vec<(u16, String)>);

/// The entities of a drawing.
fn entities(dxf: &str) -> Vec<Entity> {
    let tags = tags(dxf);
    let start = tags.iter().position(|t| *t == (2, "ENTITIES".into())).expect("entities");
    let mut found: Vec<Entity> = Vec::new();
    for (code, value) in &tags[start + 1..] {
        match (code, value.as_str()) {
            (0, "ENDSEC") => break,
            (0, kind) => found.push((kind.to_owned(), String::new(), Vec::new())),
            (code, value) => {
                let entity = found.last_mut().expect("an entity");
                if *code == 8 {
                    entity.1 = value.to_owned();
                }
                entity.2.push((*code, value.to_owned()));
            }
        }
    }
    found
}

fn values(entity: &[(u16, String)], code: u16) -> Vec<f64> {
    entity.iter().filter(|(c, _)| *c == code).map(|(_, v)| v.parse().expect("a number")).collect()
}

#[test]
fn dxf_numbers_read_back_to_the_same_digits_on_named_layers() {
    for subject in subjects() {
        let factor = mm(subject.unit);
        let dxf = text(&subject, Format::Dxf, &[("hole_mm", "1.5")]);
        let entities = entities(&dxf);
        let on = |layer: &str, kind: &str| -> Vec<_> {
            entities.iter().filter(|e| e.1 == layer && e.0 == kind).map(|e| &e.2).collect()
        };
        let n = subject.linkage.natural_coordinates();
        let scaled = FourBar::new(NaturalCoordinates {
            crank_pivot: n.crank_pivot.map(|x| x * factor),
            follower_pivot: n.follower_pivot.map(|x| x * factor),
            crank: n.crank * factor,
            coupler: n.coupler * factor,
            follower: n.follower * factor,
            crank_side: n.crank_side * factor,
            follower_side: n.follower_side * factor,
            ..n
        })
        .expect("a linkage");
        let joints = scaled.position(0.4).joints().expect("it closes");
        let (a, b) = (scaled.crank_pivot(), scaled.follower_pivot());
        let circles = on("JOINTS", "CIRCLE");
        assert_eq!(circles.len(), 5);
        let all = [a, b, joints.crank_pin, joints.follower_pin, joints.coupler_point];
        for (circle, at) in circles.iter().zip(all) {
            assert_eq!((values(circle, 10)[0], values(circle, 20)[0]), (at.re, at.im));
            assert_eq!(values(circle, 40), [0.75]);
        }
        assert!(on("SKELETON", "LINE").len() >= 4);
        let targets = on("TARGET", "POINT");
        for (point, at) in targets.iter().zip(&subject.target) {
            assert_eq!((values(point, 10)[0], values(point, 20)[0]), (at[0] * factor, at[1] * factor));
        }
        assert_eq!((targets.len(), on("TARGET", "LWPOLYLINE").len()), (3, 1));
        let curve = on("CURVE", "LWPOLYLINE");
        assert!(
            curve.iter().all(|c| values(c, 70) == [1.0] && values(c, 90) == [values(c, 10).len() as f64])
        );
        assert!(!curve.is_empty());
        assert!(tags(&dxf).windows(2).any(|w| w[0].1 == "$INSUNITS" && w[1] == (70, "4".into())));
        // Handles are unique.
        let mut handles: Vec<String> =
            tags(&dxf).into_iter().filter(|t| t.0 == 5 || t.0 == 105).map(|t| t.1).collect();
        let before = handles.len();
        handles.sort();
        handles.dedup();
        // $HANDSEED is one above the last.
        assert_eq!(handles.len(), before);
    }
}

#[test]
fn dxf_plates_are_closed_contours_moved_by_half_the_kerf() {
    for subject in subjects() {
        for kerf in ["0", "0.2"] {
            let set = [("hole_mm", "0.5"), ("margin_mm", "1"), ("kerf_mm", kerf), ("gap_mm", "3")];
            let dxf = text(&subject, Format::DxfPlates, &set);
            let half: f64 = 0.5 * kerf.parse::<f64>().expect("a number");
            let entities = entities(&dxf);
            let mut boxes: Vec<[f64; 4]> = Vec::new();
            for plate in plates_of(&subject, mm(subject.unit), 1.25 + half) {
                let layer = plate.link.name().to_uppercase();
                let on = |kind: &str| -> Vec<_> {
                    entities.iter().filter(|e| e.1 == layer && e.0 == kind).map(|e| &e.2).collect()
                };
                let (contours, circles) = (on("LWPOLYLINE"), on("CIRCLE"));
                assert_eq!((contours.len(), circles.len()), (1, plate.distinct_holes().len()));
                assert!(circles.iter().all(|c| (values(c, 40)[0] - (0.25 - half)).abs() < 1e-12));
                // The area by the polygon and the segments of its arcs, bulge = tan(turn/4).
                let (xs, ys) = (values(contours[0], 10), values(contours[0], 20));
                let mut bulges = vec![0.0_f64; xs.len()];
                let mut vertex = 0;
                for (code, value) in contours[0] {
                    match code {
                        10 => vertex += 1,
                        42 => bulges[vertex - 1] = value.parse().expect("a number"),
                        _ => {}
                    }
                }
                let n = xs.len();
                let area: f64 = (0..n)
                    .map(|i| {
                        let j = (i + 1) % n;
                        let chord = (xs[j] - xs[i]).hypot(ys[j] - ys[i]);
                        let turn = 4.0 * bulges[i].atan();
                        let radius = if turn > 0.0 { chord / (2.0 * (0.5 * turn).sin()) } else { 0.0 };
                        0.5 * (xs[i] * ys[j] - xs[j] * ys[i]) + 0.5 * radius * radius * (turn - turn.sin())
                    })
                    .sum();
                assert!((area - plate.area()).abs() < 1e-9 * plate.area(), "{area} {}", plate.area());
                let place = |v: &[f64], f: fn(f64, f64) -> f64| v.iter().copied().fold(f64::NAN, f);
                boxes.push([
                    place(&xs, f64::min),
                    place(&ys, f64::min),
                    place(&xs, f64::max),
                    place(&ys, f64::max),
                ]);
            }
            // One above the other, apart by the gap (vertices of arcs lie inside of their boxes by at most the radius).
            for pair in boxes.windows(2) {
                assert!(pair[1][1] - pair[0][3] >= 3.0 - 1e-9, "{boxes:?}");
            }
        }
    }
}
