//! What a person sees of a motion: the errors of its body's angle, its frames, and no word of points.

use super::records::{FRAME_DEG, TURNED_DEG, k18, motion};
use super::{everything, parsed, table_of};
use crate::corpora::readers::entry;
use linkwright::internals::record::{Figure, Requirement};
use linkwright::internals::report::Colour;
use linkwright::internals::report::compare::{Entry, SortKey, compare};
use linkwright::internals::report::csv::{candidates_csv, curve_csv};
use linkwright::internals::report::html::report_html;
use linkwright::internals::report::svg::candidate_svg;
use linkwright::internals::report::table::candidates_table;
use linkwright::{ExportFormat, ExportSettings, ExportSubject, export};

/// The errors of the angles that are given, of which the best frame leaves the mean out.
fn errors_deg() -> Vec<f64> {
    TURNED_DEG.into_iter().flatten().collect()
}

#[test]
fn the_table_of_a_motion_has_the_errors_of_the_angle() {
    let text = candidates_table(&motion(), Colour::Never);
    assert!(text.contains("6 poses, 1 of them without an angle, size "), "{text}");
    let errors = errors_deg();
    assert!(errors.iter().sum::<f64>().abs() < 1e-12, "the frame is the one of the record");
    let rms = (errors.iter().map(|e| e * e).sum::<f64>() / 5.0).sqrt();
    let row = text.lines().find(|line| line.trim_start().starts_with("1 ")).expect("a row");
    let [rms, most] = [rms, 0.9].map(|degrees| format!("{degrees:.3}\u{b0}"));
    // sqrt of the mean of squares 0.01 .. 0.36, worst at place 5.
    assert!(row.contains(&format!("{rms}  {most}")), "{row}");
    assert!(text.contains("angle_weight = 50 mm"), "{text}");
}

#[test]
fn nothing_that_is_said_of_a_motion_is_of_points() {
    for (kind, text) in everything(&motion()) {
        if kind == "csv" {
            continue;
        }
        // Outside of what the words mean elsewhere, and of markup and keys of data.
        let known =
            ["curve of its point", "of the body's point", "data-point", "change-point", "change point"];
        let mut text = known.iter().fold(text, |text, known| text.replace(known, ""));
        if let Some(at) = text.find("<style>") {
            let end = text.find("</style>").expect("an end");
            text.replace_range(at..end, "");
        }
        if let Some(at) = text.find("id=\"data\"") {
            text.truncate(at);
        }
        let text = text.replace("id=\"points\"", "").replace("coupler point", "");
        let found =
            text.find("point").map(|at| text[at.saturating_sub(60)..].chars().take(140).collect::<String>());
        assert_eq!(found, None, "{kind}");
    }
}

#[test]
fn the_csv_files_of_a_motion_have_its_angles() {
    let record = motion();
    let (_, rows) = table_of(&candidates_csv(&record));
    let read = |name: &str| rows[0][name].parse::<f64>().expect("a number");
    assert!((read("frame_deg") - FRAME_DEG).abs() < 1e-9);
    assert!((read("angle_max_deg") - 0.9).abs() < 1e-9);
    assert_eq!(rows[0]["angle_max_at"], "3");
    let (head, rows) = table_of(&curve_csv(&record, 0));
    assert_eq!(head.last().map(String::as_str), Some("angle_deg"));
    for row in &rows {
        let [cx, cy, dx, dy, angle] =
            ["Cx", "Cy", "Dx", "Dy", "angle_deg"].map(|name| row[name].parse::<f64>().expect("a number"));
        let off = (dy - cy).atan2(dx - cx).to_degrees() + FRAME_DEG - angle;
        assert!((off - 360.0 * (off / 360.0).round()).abs() < 1e-9, "{row:?}");
        assert!(angle.abs() <= 180.0);
    }
    // Paths have none of these columns.
    let (head, _) = table_of(&candidates_csv(&k18()));
    assert!(!head.iter().any(|name| name.starts_with("angle") || name == "frame_deg"));
    assert!(curve_csv(&k18(), 0).lines().next().is_some_and(|head| head.ends_with("transmission_deg")));
}

#[test]
fn a_missed_tolerance_of_the_angle_is_named_with_its_pose() {
    let mut record = motion();
    let task = &mut record.problem.resolved.task;
    task.tolerance = Some(vec![10.0; 6]);
    task.body.as_mut().expect("a body").tolerance_deg = Some(vec![0.5; 6]);
    let row = |name: &str, value, limit, met| Requirement {
        name: name.into(),
        value: Figure::Number(value),
        limit: Figure::Number(limit),
        met,
    };
    let best = &mut record.candidates[0];
    best.accepted = false;
    best.requirements.extend([row("tolerance", 0.6, 10.0, true), row("tolerance_deg", 0.9, 0.5, false)]);
    record.candidates.truncate(1);
    let text = candidates_table(&record, Colour::Never).split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("#1: angle error 0.9\u{b0} at pose 3, tolerance 0.5\u{b0}"), "{text}");
    assert!(
        text.contains("Tolerances not met by 0.4\u{b0} at pose 3: the nearest, #1, has an angle error"),
        "{text}"
    );
    assert!(text.contains("The narrowest band found is 1.80"), "{text}");
}

/// A drawing shows a frame in outline and one filled at each pose that has an angle, turned as the body is.
#[test]
fn a_drawing_has_a_frame_at_every_pose() {
    let record = motion();
    let svg = candidate_svg(&record, 0);
    let document = parsed(&svg);
    // A frame has seven corners; two more are in the legend.
    let frames = |fill: &str| {
        let paths = document.descendants().filter(|node| node.attribute("fill") == Some(fill));
        let data: Vec<&str> = paths.filter_map(|node| node.attribute("d")).collect();
        data.into_iter()
            .filter(|d| d.matches('L').count() == 6 && d.ends_with('Z'))
            .map(str::to_owned)
            .collect::<Vec<_>>()
    };
    let (wanted, filled) = (frames("none"), frames("#0072b2"));
    assert_eq!((wanted.len(), filled.len()), (6, 6), "{svg}");
    let angle_deg = &record.problem.resolved.task.body.as_ref().expect("a body").angle_deg;
    for (frame, angle) in wanted.iter().zip(angle_deg.iter().flatten()) {
        let numbers: Vec<f64> = frame
            .split(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'))
            .filter_map(|number| number.parse().ok())
            .collect();
        // Corner 2 is the end of the x axis; corners 1 and 3 lie on either side of it.
        let corner = |i: usize| [numbers[2 * i], numbers[2 * i + 1]];
        let [tip, one, other] = [2, 1, 3].map(corner);
        let from = [0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])];
        let drawn = (from[1] - tip[1]).atan2(tip[0] - from[0]).to_degrees();
        let off = drawn - angle;
        // Coordinates are rounded to a hundredth of a pixel.
        assert!((off - 360.0 * (off / 360.0).round()).abs() < 0.3, "{drawn} for {angle}");
    }
}

#[test]
fn the_page_hands_the_body_to_its_player() {
    let page = report_html(&motion(), 0);
    let start = page.find("id=\"data\">").expect("data") + "id=\"data\">".len();
    let data = &page[start..start + page[start..].find("</script>").expect("an end")];
    let data: serde_json::Value = serde_json::from_str(data).expect("JSON");
    assert_eq!(data["target"]["noun"], "pose");
    assert!(data["target"]["angle_deg"][2].is_null() && data["target"]["angle_deg"][0].is_number());
    assert!((data["mechanisms"][0]["frame_deg"].as_f64().expect("a number") - FRAME_DEG).abs() < 1e-9);
    for expected in
        ["largest angle error", "angle rms", "desired angle \u{b0}", "its x axis lies 25.0000\u{b0}"]
    {
        assert!(page.contains(expected), "{expected}");
    }
    let of_path = report_html(&k18(), 0);
    let markup = of_path.split("<script>").next().expect("markup");
    assert!(!markup.contains("angle rms") && !markup.contains("desired angle"));
}

#[test]
fn motions_are_compared_by_their_angles_and_beside_paths_with_a_remark() {
    let record = motion();
    let entries: Vec<Entry> = (0..2).filter_map(|i| entry(&format!("m:{}", i + 1), &record, i)).collect();
    let comparison = compare(&entries, &[], None);
    assert_eq!(comparison.keys, [SortKey::Objective]);
    assert!(comparison.same_target());
    let (_, rows) = table_of(&comparison.csv());
    assert!(rows[0]["angle_max_deg"].parse::<f64>().is_ok_and(|degrees| (degrees - 0.9).abs() < 1e-9));
    // Another angle is another target.
    let mut other = entries.clone();
    other[1].body.as_mut().expect("a body").angle_deg[0] = Some(1.0);
    assert!(!compare(&other, &[], None).same_target());
    let mixed: Vec<Entry> = entries.into_iter().chain(entry("k18", &k18(), 0)).collect();
    let mixed = compare(&mixed, &[], None);
    let notes = mixed.notes().join(" ");
    assert!(
        notes.contains("Paths and motions stand side by side") && notes.contains("The targets differ"),
        "{notes}"
    );
    assert!(mixed.front_words().is_none());
    let json: serde_json::Value = serde_json::from_str(&mixed.json()).expect("JSON");
    let of_k18 =
        json["rows"].as_array().expect("rows").iter().find(|row| row["label"] == "k18").expect("a row");
    assert!(of_k18["figures"]["angle_rms"].is_null());
}

#[test]
fn exports_of_a_motion_have_the_body() {
    let record = motion();
    let subject = ExportSubject::of_candidate(&record, &record.candidates[0]);
    let text = |format| {
        let exported = export(&subject, format, &ExportSettings::default()).expect("a file");
        (String::from_utf8(exported.bytes).expect("text"), exported.notes.join(" "))
    };
    let (dxf, _) = text(ExportFormat::Dxf);
    // The layer itself, and the two arms of the body in the position drawn.
    assert_eq!(dxf.lines().filter(|line| line.trim() == "BODY").count(), 3, "{dxf}");
    let (svg, _) = text(ExportFormat::Svg);
    assert!(parsed(&svg).descendants().any(|node| node.attribute("id") == Some("body")));
    let (toml, _) = text(ExportFormat::Toml);
    assert!(
        toml.contains("its x axis lies 2")
            && toml.contains("degrees counter-clockwise from the line from C to D")
    );
    let (json, _) = text(ExportFormat::Json);
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert!((json["frame_deg"].as_f64().expect("a number") - FRAME_DEG).abs() < 1e-9);
    let (_, notes) = text(ExportFormat::Csv);
    assert!(notes.contains("the body's angle is coupler_deg + 2"), "{notes}");
}
