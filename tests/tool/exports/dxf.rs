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

/// The bulge after each vertex of a polyline.
fn bulges(polyline: &[(u16, String)]) -> Vec<f64> {
    let mut bulges: Vec<f64> = Vec::new();
    for (code, value) in polyline {
        match code {
            10 => bulges.push(0.0),
            42 => *bulges.last_mut().expect("a vertex") = value.parse().expect("a number"),
            _ => {}
        }
    }
    bulges
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
        let n = subject.linkage.four_bar().expect("a four-bar").natural_coordinates();
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
                let bulges = bulges(contours[0]);
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

/// The box of all entities, by points on them: a polyline's arcs in a thousand parts.
fn extents(dxf: &str) -> [f64; 4] {
    let mut found = [f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY];
    let mut hold = |x: f64, y: f64| {
        found = [found[0].min(x), found[1].min(y), found[2].max(x), found[3].max(y)];
    };
    for (kind, _, tags) in entities(dxf) {
        let (xs, ys) = (values(&tags, 10), values(&tags, 20));
        match kind.as_str() {
            "CIRCLE" => {
                let radius = values(&tags, 40)[0];
                hold(xs[0] - radius, ys[0] - radius);
                hold(xs[0] + radius, ys[0] + radius);
            }
            "LINE" => {
                hold(xs[0], ys[0]);
                hold(values(&tags, 11)[0], values(&tags, 21)[0]);
            }
            "LWPOLYLINE" => {
                let bulges = bulges(&tags);
                for i in 0..xs.len() {
                    let j = (i + 1) % xs.len();
                    let (across, along) = ([xs[j] - xs[i], ys[j] - ys[i]], 1000);
                    for k in 0..=along {
                        // A point of the arc sees its chord's ends under angles that share half of its turn.
                        let (half, part) = (2.0 * bulges[i].atan(), f64::from(k) / f64::from(along));
                        let reach = if half == 0.0 { part } else { (half * part).sin() / half.sin() };
                        let (sin, cos) = (-half * (1.0 - part)).sin_cos();
                        hold(
                            xs[i] + reach * (across[0] * cos - across[1] * sin),
                            ys[i] + reach * (across[0] * sin + across[1] * cos),
                        );
                    }
                }
            }
            _ => hold(xs[0], ys[0]),
        }
    }
    found
}

#[test]
fn dxf_headers_tell_the_extents_of_all_entities_with_their_arcs() {
    for subject in subjects() {
        for (format, kerf) in
            [(Format::Dxf, None), (Format::DxfPlates, Some("0")), (Format::DxfPlates, Some("0.15"))]
        {
            let set =
                kerf.map_or(vec![], |kerf| vec![("kerf_mm", kerf), ("hole_mm", "0.5"), ("margin_mm", "1")]);
            let dxf = text(&subject, format, &set);
            let tags = tags(&dxf);
            let header = |name: &str| -> [f64; 2] {
                let at = tags.iter().position(|t| *t == (9, name.to_owned())).expect("it is in the header");
                [&tags[at + 1], &tags[at + 2]].map(|(_, value)| value.parse().expect("a number"))
            };
            let ([left, low], [right, high]) = (header("$EXTMIN"), header("$EXTMAX"));
            if format == Format::DxfPlates {
                assert!(left >= -1e-9 && low >= -1e-9 && left.max(low) < 1e-9, "{left} {low}");
            }
            for (told, drawn) in [left, low, right, high].into_iter().zip(extents(&dxf)) {
                assert!((told - drawn).abs() < 1e-5 * (right - left), "{format:?}: {told} {drawn}");
            }
        }
    }
}
