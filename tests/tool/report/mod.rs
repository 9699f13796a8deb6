//! What a person sees of a record: figures that agree with it, nothing raw from its names, no panic.

mod motions;
pub mod records;

use crate::corpora::readers::entry;
use linkwright::internals::mechanism::AssemblyMode;
use linkwright::internals::mechanism::Unit;
use linkwright::internals::record::{
    Change, Conflict, Cost, Figure, LimitUnit, Reason, Record, Relaxation, Requirement, TypedValue,
};
use linkwright::internals::report::Colour;
use linkwright::internals::report::compare::{Entry, SortKey, compare};
use linkwright::internals::report::contact_sheet::contact_sheet_svg;
use linkwright::internals::report::csv::{candidates_csv, curve_csv};
use linkwright::internals::report::html::report_html;
use linkwright::internals::report::plot::{Glyphs, terminal_plot};
use linkwright::internals::report::svg::candidate_svg;
use linkwright::internals::report::table::{BatchRow, batch_summary, candidates_table};
use records::{detail, ellipse, k18, motion, rocking, shapes};
use std::collections::HashMap;

fn all_records() -> Vec<Record> {
    vec![k18(), ellipse(), rocking(), shapes(), detail(), motion()]
}

/// Everything that is made of a record, as text.
fn everything(record: &Record) -> Vec<(&'static str, String)> {
    let entries: Vec<Entry> = (0..3).filter_map(|i| entry(&record.problem.name, record, i)).collect();
    let comparison = compare(&entries, &[SortKey::Max], None);
    let name = record.problem.name.as_str();
    let files = [BatchRow { name, outcome: Ok(record) }, BatchRow { name, outcome: Err(name) }];
    let mut all = vec![
        ("table", candidates_table(record, Colour::Never)),
        ("batch", batch_summary(&files, Colour::Never)),
        ("plot", terminal_plot(record, 0, 80, 24, Glyphs::Braille)),
        ("plot", terminal_plot(record, 0, 0, 0, Glyphs::Ascii)),
        ("csv", candidates_csv(record)),
        ("table", comparison.table(Colour::Never)),
        ("csv", comparison.csv()),
        ("svg", comparison.svg()),
        ("svg", contact_sheet_svg(record)),
        // Without the player, whose words are its own.
        ("html", report_html(record, 0).split("<script>").next().unwrap().to_owned()),
    ];
    for i in 0..=record.candidates.len() {
        all.push(("svg", candidate_svg(record, i)));
        all.push(("csv", curve_csv(record, i)));
    }
    all
}

fn parsed(svg: &str) -> roxmltree::Document<'_> {
    roxmltree::Document::parse(svg).unwrap_or_else(|error| panic!("{error}\n{svg}"))
}

fn table_of(csv_text: &str) -> (Vec<String>, Vec<HashMap<String, String>>) {
    let mut reader = csv::Reader::from_reader(csv_text.as_bytes());
    let head: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let rows = reader
        .records()
        .map(|row| head.iter().cloned().zip(row.unwrap().iter().map(str::to_owned)).collect())
        .collect();
    (head, rows)
}

#[test]
fn the_table_of_eighteen_points_reads_as_it_should() {
    let text = candidates_table(&k18(), Colour::Never);
    let expected_head = "\
eighteen-point
  18 points, size 1.082 m, prescribed timing, offset free, closed
  Kunjur & Krishnamurty, 1997

  #   sum of sq      rms      max  at  to curve  type          transmission  ratio  verdict
  1  0.00902888  0.02240  0.03678  12   0.01630  crank-rocker   25.4° cycle   2.49  accepted
";
    assert!(text.starts_with(expected_head), "{text}");
    assert!(text.contains("no: transmission\n"), "{text}");
    assert!(text.contains("#4: worst transmission angle 39.777°, at least 45° asked"), "{text}");
    assert!(text.contains("12,345 evaluations of the objective, 222,210 positions"), "{text}");
}

#[test]
fn tables_fit_a_hundred_columns() {
    for record in all_records() {
        for (kind, text) in everything(&record) {
            if kind == "table" || kind == "batch" || kind == "plot" {
                for line in text.lines() {
                    assert!(line.chars().count() <= 100, "{}: {line}", record.problem.name);
                    assert_eq!(line, line.trim_end());
                }
            }
        }
    }
}

#[test]
fn the_best_linkage_can_be_copied_into_a_linkage_file() {
    let text = candidates_table(&k18(), Colour::Never);
    let start = text.find("linkage = {").unwrap();
    let end = start + text[start..].find('}').unwrap() + 1;
    let copied: toml::Table = text[start..end].parse().unwrap();
    let linkage: linkwright::internals::mechanism::FourBar = copied["linkage"].clone().try_into().unwrap();
    assert_eq!(linkage, records::k18_optimum());
}

#[test]
fn colour_adds_escapes_and_changes_no_word() {
    let plain = candidates_table(&k18(), Colour::Never);
    let coloured = candidates_table(&k18(), Colour::Always);
    assert!(!plain.contains('\x1b') && coloured.contains("\x1b[32maccepted\x1b[0m"));
    let mut stripped = coloured;
    for code in ["\x1b[0m", "\x1b[1m", "\x1b[2m", "\x1b[31m", "\x1b[32m"] {
        stripped = stripped.replace(code, "");
    }
    assert_eq!(plain, stripped);
}

#[test]
fn defects_are_told_in_words() {
    let text = candidates_table(&rocking(), Colour::Never);
    assert!(text.contains("no: branch"), "{text}");
    assert!(text.contains("passes a toggle: point 2 on another branch than point 0"), "{text}");
}

#[test]
fn rounding_never_makes_a_missed_limit_look_met() {
    let mut record = k18();
    let requirement = &mut record.candidates[3].requirements[1];
    requirement.value = Figure::Number(29.9999999);
    requirement.limit = Figure::Number(30.0);
    let text = candidates_table(&record, Colour::Never);
    assert!(text.contains("worst transmission angle 29.9999999°, at least 30° asked"), "{text}");
}

#[test]
fn a_missed_tolerance_is_named_with_its_point() {
    let mut record = k18();
    record.problem.resolved.task.tolerance = Some(vec![0.03; 18]);
    record.candidates[0].accepted = false;
    let text = candidates_table(&record, Colour::Never);
    assert!(text.contains("#1: error 0.036777 at point 12, tolerance 0.03"), "{text}");
    assert_eq!(table_of(&candidates_csv(&record)).1[0]["unmet"], "tolerance");
}

#[test]
fn costs_are_told_for_a_step_that_the_error_can_bear() {
    let mut record = k18();
    record.problem.unit = Some(Unit::Mm);
    let rms = record.candidates[0].error.rms;
    let cost = |name: &str, side: Option<&str>, limit: f64, rate: f64, unit_of_limit| Cost {
        name: name.into(),
        side: side.map(str::to_owned),
        limit,
        rms_per_unit: Some(rate),
        unit_of_limit,
        rms_without: Some(rms - 0.0042),
    };
    record.candidates[0].costs = vec![
        cost("pivots_in", Some("xmax"), 12.0, -0.002, LimitUnit::Length),
        cost("pivots_in", Some("ymin"), -3.0, -0.2, LimitUnit::Length),
        cost("transmission_deg_min", None, 40.0, -0.0013, LimitUnit::Degree),
        cost("link_ratio_max", None, 4.0, -0.003, LimitUnit::Ratio),
        Cost { rms_per_unit: None, ..cost("type", None, 0.0, 0.0, LimitUnit::Length) },
    ];
    let table = candidates_table(&record, Colour::Never).split_whitespace().collect::<Vec<_>>().join(" ");
    for line in [
        "pivots_in costs 0.0042 mm of rms; 1 mm more at xmax gives back 0.0020 mm, 0.01 mm more at ymin gives back 0.0020 mm",
        "transmission_deg_min costs 0.0042 mm of rms; 1° less than 40.00° gives back 0.0013 mm",
        "link_ratio_max costs 0.0042 mm of rms; 1 more than 4.000 gives back 0.0030 mm",
        "type costs 0.0042 mm of rms",
    ] {
        assert!(table.contains(line), "{line}\n{table}");
    }
}

#[test]
fn what_would_help_can_be_copied_into_a_shell() {
    let mut record = k18();
    record.problem.unit = None;
    let change = |key: &str, from: TypedValue, to: TypedValue| Change { key: key.into(), from, to };
    let number = TypedValue::Number;
    record.conflict = Some(Conflict { among: vec!["require.link_ratio_max".into(), "require.type".into()] });
    record.relaxations = vec![
        Relaxation {
            set: vec![change("require.link_ratio_max", number(20.0), number(24.5))],
            sum_sq: 0.18,
            rms: 0.1,
        },
        Relaxation {
            set: vec![change(
                "require.type",
                TypedValue::Words(vec!["crank-rocker".into()]),
                TypedValue::Words(vec!["crank-rocker".into(), "double-crank".into()]),
            )],
            sum_sq: 0.72,
            rms: 0.2,
        },
    ];
    let table = candidates_table(&record, Colour::Never);
    for line in [
        "  Nothing acceptable: link_ratio_max = 20 and type = [\"crank-rocker\"] conflict. It works with\n",
        "    --set require.link_ratio_max=24.5   (rms 0.100)\n",
        "    --set 'require.type=[\"crank-rocker\", \"double-crank\"]'   (rms 0.200)\n",
    ] {
        assert!(table.contains(line), "{line}\n{table}");
    }
}

#[test]
fn a_run_that_cannot_be_repeated_says_so() {
    let mut record = k18();
    record.termination.reason = Reason::TimeLimit;
    record.termination.reproducible = false;
    let text = candidates_table(&record, Colour::Never).replace("\n ", "");
    assert!(text.contains("the time limit was reached") && text.contains("cannot be repeated"), "{text}");
}

#[test]
fn the_same_record_gives_the_same_bytes() {
    for record in all_records() {
        assert_eq!(everything(&record), everything(&record.clone()));
    }
}

#[test]
fn drawings_are_well_formed_and_name_what_they_show() {
    for record in all_records() {
        for (kind, text) in everything(&record) {
            if kind == "svg" {
                let document = parsed(&text);
                assert_eq!(document.root_element().tag_name().name(), "svg");
                assert!(!text.contains("NaN") && !text.contains("inf"), "a coordinate is no number");
            }
        }
    }
    let svg = candidate_svg(&k18(), 0);
    let document = parsed(&svg);
    let texts: Vec<&str> = document.descendants().filter_map(|node| node.text()).collect();
    for expected in ["A", "B", "C", "D", "P", "0", "17", "0.2 m", "eighteen-point", "candidate 1 of 4"] {
        assert!(texts.contains(&expected), "{expected} is missing from {texts:?}");
    }
    assert!(svg.contains("rms error 0.02240 m, largest 0.03678 m at point 12"));
}

#[test]
fn y_points_up_and_both_axes_have_one_scale() {
    let svg = candidate_svg(&k18(), 0);
    let document = parsed(&svg);
    let rings: Vec<[f64; 2]> = document
        .descendants()
        .filter(|node| node.has_tag_name("circle") && node.attribute("fill-opacity") == Some("0.75"))
        .map(|node| ["cx", "cy"].map(|key| node.attribute(key).unwrap().parse().unwrap()))
        .collect();
    assert_eq!(rings.len(), 18);
    let scale = (rings[17][0] - rings[7][0]) / 0.6;
    for (ring, point) in rings.iter().zip(&records::K18) {
        // Coordinates are written to a hundredth of a pixel.
        assert!((ring[0] - rings[7][0] - scale * (point[0] - 0.0)).abs() < 0.03, "{ring:?}");
        assert!((rings[7][1] - ring[1] - scale * (point[1] - 0.5)).abs() < 0.03, "{ring:?}");
    }
}

#[test]
fn a_small_target_is_drawn_again_enlarged() {
    assert!(candidate_svg(&detail(), 0).contains("times as large"));
    assert!(!candidate_svg(&k18(), 0).contains("times as large"));
}

#[test]
fn a_hundred_thousand_points_make_no_gigantic_drawing() {
    let mut record = k18();
    let n = 100_000;
    let circle = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / n as f64;
        [angle.cos(), angle.sin()]
    };
    record.problem.resolved.task.points = (0..n).map(circle).collect();
    assert!(candidate_svg(&record, 0).len() < 300_000);
    assert!(contact_sheet_svg(&record).len() < 600_000);
}

const HOSTILE: [&str; 5] = [
    "<script>alert(1)</script>",
    "\x1b]0;owned\x07\x1b[2J\u{9b}31m\r\nback\u{8}",
    "\"><svg onload='x'>&amp;&#0;]]>",
    "\u{202e}desrever\u{2066}\u{0}\u{ffff}",
    "=cmd|' /C calc'!A0,\"\n;",
];

#[test]
fn hostile_names_reach_no_output_raw() {
    for hostile in HOSTILE {
        let mut record = k18();
        record.problem.name = hostile.to_owned();
        record.problem.source = Some(hostile.to_owned());
        record.method.used = vec![hostile.to_owned(); 3];
        record.candidates[0].accepted = false;
        record.candidates[0].requirements.push(Requirement {
            name: hostile.to_owned(),
            value: Figure::Word(hostile.to_owned()),
            limit: Figure::Words(vec![hostile.to_owned(), String::new()]),
            met: false,
        });
        for (kind, text) in everything(&record) {
            let raw = text.chars().find(|c| {
                c.is_control() && *c != '\n' || matches!(c, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
            });
            assert_eq!(raw, None, "{kind} of {hostile:?}: {text}");
            match kind {
                "svg" => {
                    let document = parsed(&text);
                    let tags: Vec<&str> = document.descendants().map(|node| node.tag_name().name()).collect();
                    assert!(!tags.contains(&"script"));
                    assert!(!document.descendants().any(|node| node.has_attribute("onload")));
                    // Only the panel of an enlarged target is a drawing inside the drawing.
                    assert!(tags.iter().filter(|tag| **tag == "svg").count() <= 2);
                }
                "csv" => {
                    let (head, rows) = table_of(&text);
                    assert!(rows.iter().all(|row| row.len() == head.len()));
                    for value in rows.iter().flat_map(|row| row.values()) {
                        assert!(!value.starts_with(['=', '+', '@']), "{value}");
                    }
                }
                _ => {}
            }
        }
    }
}

#[test]
fn a_name_of_a_megabyte_is_cut() {
    let mut record = k18();
    record.problem.name = "long ".repeat(200_000);
    assert!(candidates_table(&record, Colour::Never).len() < 4_000);
    parsed(&candidate_svg(&record, 0));
}

#[test]
fn a_record_without_candidates_or_points_is_shown_as_such() {
    let mut record = k18();
    record.candidates.clear();
    assert!(candidates_table(&record, Colour::Never).contains("No candidate was found."));
    assert_eq!(table_of(&candidates_csv(&record)).1.len(), 0);
    assert_eq!(curve_csv(&record, 0).lines().count(), 1);
    assert!(candidate_svg(&record, 0).contains("no linkage to draw"));
    assert!(terminal_plot(&record, 0, 60, 20, Glyphs::Braille).contains('●'));
    everything(&record);
    record.problem.resolved.task.points.clear();
    everything(&record);
    assert_eq!(compare(&[], &[SortKey::Rms], None).table(Colour::Never), "  Nothing to compare.\n");
    assert!(batch_summary(&[], Colour::Never).contains("0 files"));
}

#[test]
fn lists_of_the_wrong_length_and_numbers_that_are_none_do_not_panic() {
    for record in all_records() {
        for breakage in 0..6 {
            let mut record = record.clone();
            let candidate = &mut record.candidates[0];
            let path = &mut record.problem.resolved.task;
            match breakage {
                0 => candidate.crank_deg.clear(),
                1 => candidate.t1_at = candidate.t1_at[..1].to_vec().into(),
                2 => candidate.crank_deg.iter_mut().for_each(|angle| *angle = f64::NAN),
                3 => path.points = vec![[f64::INFINITY, 0.0], [1e300, f64::NAN]],
                4 => path.points = vec![[3.0, 4.0]; 2],
                _ => {
                    candidate.error.rms = f64::NAN;
                    candidate.error.max_at = usize::MAX;
                    candidate.link_ratio = f64::INFINITY;
                    candidate.accepted = false;
                    path.tolerance = Some(vec![1e-9]);
                    candidate.defects = vec![linkwright::internals::task::Defect::Order { at: Vec::new() }];
                }
            }
            for (kind, text) in everything(&record) {
                assert!(!text.contains("NaN"), "{kind}, breakage {breakage}: {text}");
                if kind == "svg" {
                    parsed(&text);
                }
            }
        }
    }
}

#[test]
fn links_that_cannot_be_joined_are_not_drawn_joined() {
    let mut record = k18();
    record.candidates[0].linkage =
        records::linkage([0.0, 0.0], [10.0, 0.0], [1.0, 1.0, 1.0, 1.0, 1.0], 1, 1).into();
    let svg = candidate_svg(&record, 0);
    parsed(&svg);
    assert!(svg.contains("cannot be joined"));
    assert_eq!(curve_csv(&record, 0).lines().count(), 1);
    everything(&record);
}

#[test]
fn extreme_sizes_are_drawn_within_the_page() {
    let mut record = k18();
    record.candidates[0].linkage =
        records::linkage([-9e11, 0.0], [9e11, 1e3], [4e11, 9.5e11, 9.2e11, 1.0, 9.5e11], 1, 1).into();
    for (kind, text) in everything(&record) {
        if kind == "svg" {
            parsed(&text);
        }
    }
    for point in &mut record.problem.resolved.task.points {
        *point = point.map(|x| x * 1e-300);
    }
    everything(&record);
}

#[test]
fn the_candidates_csv_reads_back_the_same_numbers() {
    for record in all_records() {
        let (_, rows) = table_of(&candidates_csv(&record));
        assert_eq!(rows.len(), record.candidates.len());
        for (row, candidate) in rows.iter().zip(&record.candidates) {
            let linkage = candidate.linkage.four_bar().expect("a four-bar");
            let number =
                |key: &str| row[key].parse::<f64>().unwrap_or_else(|_| panic!("{key}: {}", row[key]));
            for (key, value) in [
                ("sum_sq", candidate.error.sum_sq),
                ("rms", candidate.error.rms),
                ("max", candidate.error.max),
                ("to_curve_max", candidate.error.to_curve.max),
                ("grashof_margin", candidate.grashof_margin),
                ("transmission_worst_deg", candidate.transmission_deg.worst),
                ("link_ratio", candidate.link_ratio),
                ("Ax", linkage.crank_pivot().re),
                ("By", linkage.follower_pivot().im),
                ("a", linkage.crank()),
                ("b", linkage.coupler()),
                ("c", linkage.follower()),
                ("d", linkage.crank_side()),
                ("e", linkage.follower_side()),
                ("t1", linkage.assembly().sign()),
                ("t2", linkage.side().sign()),
            ] {
                assert_eq!(number(key), value, "{key}");
            }
            assert_eq!(row["type"], candidate.type_name());
            assert_eq!(row["accepted"], candidate.accepted.to_string());
        }
    }
    assert_eq!(table_of(&candidates_csv(&rocking())).1[0]["defects"], "branch:2");
}

#[test]
fn the_curve_csv_gives_positions_of_the_linkage_to_the_last_digit() {
    for (record, expected) in [(k18(), 360), (rocking(), 720)] {
        let linkage = record.candidates[0].linkage.four_bar().expect("a four-bar");
        let (_, rows) = table_of(&curve_csv(&record, 0));
        assert_eq!(rows.len(), expected);
        let modes: std::collections::BTreeSet<&str> = rows.iter().map(|row| row["t1"].as_str()).collect();
        assert_eq!(modes.len(), if expected == 720 { 2 } else { 1 }, "a rocking circuit has both assemblies");
        for row in rows {
            let number = |key: &str| row[key].parse::<f64>().unwrap();
            let assembly = AssemblyMode::of(number("t1"));
            let angle = number("crank_deg").to_radians();
            let Some(joints) = linkage.position_with(angle, assembly).joints() else { continue };
            // Near a toggle a rounding of the angle is its square root in D: 1e-7 of the lengths.
            let tolerance = 1e-6 * linkage.longest_link();
            assert!((joints.coupler_point.re - number("Px")).abs() < tolerance, "{row:?}");
            assert!((joints.coupler_point.im - number("Py")).abs() < tolerance, "{row:?}");
            assert!((0.0..=180.0).contains(&number("transmission_deg")));
        }
    }
}

#[test]
fn a_comparison_ranks_by_its_key() {
    let record = k18();
    let entries: Vec<Entry> = (0..4).filter_map(|i| entry(&format!("k18:{}", i + 1), &record, i)).collect();
    let labels = |key| {
        compare(&entries, &[key], None)
            .rows
            .iter()
            .map(|row| row.entry.label.clone())
            .collect::<Vec<_>>()
            .join(" ")
    };
    assert_eq!(labels(SortKey::SumSq), "k18:1 k18:2 k18:3 k18:4");
    assert_eq!(labels(SortKey::Transmission), "k18:4 k18:3 k18:2 k18:1");
    let by_sum = compare(&entries, &[SortKey::SumSq], None);
    let (best, second) = (entries[0].candidate.error.sum_sq, entries[1].candidate.error.sum_sq);
    assert_eq!(by_sum.rows[0].behind_percent, Some(0.0));
    assert_eq!(by_sum.rows[1].behind_percent, Some(100.0 * (second - best) / best));
    assert!(by_sum.same_target() && by_sum.same_unit());
    assert_eq!(table_of(&by_sum.csv()).1[2]["label"], "k18:3");
    assert!(entry("none", &record, 4).is_none());
}

#[test]
fn equal_figures_share_a_rank_and_missing_ones_come_last() {
    let record = k18();
    let mut entries: Vec<Entry> = [0, 0, 1].iter().filter_map(|i| entry("x", &record, *i)).collect();
    entries[0].candidate.error.rms = f64::NAN;
    entries.push(entries[1].clone());
    let rows = compare(&entries, &[SortKey::Rms], None).rows;
    assert_eq!(rows.iter().map(|row| row.rank).collect::<Vec<_>>(), [1, 1, 3, 4]);
    assert_eq!((rows[3].figure_of(SortKey::Rms), rows[3].behind_percent), (None, None));
}

#[test]
fn different_targets_and_units_are_said_to_differ() {
    let mut other = ellipse();
    other.problem.unit = Some(Unit::In);
    let entries: Vec<Entry> = [k18(), other].iter().filter_map(|record| entry("x", record, 0)).collect();
    let text = compare(&entries, &[SortKey::default()], None).table(Colour::Never);
    assert!(text.contains("The targets differ") && text.contains("The units differ"), "{text}");
}

#[test]
fn an_unknown_key_lists_the_keys() {
    let error = "speed\x1b".parse::<SortKey>().unwrap_err().to_string();
    let expected = "no figure is called \"speed\": sort by sum_sq, rms, max, to_curve, transmission, link_ratio, size, extent, objective, angle_rms, angle_max";
    assert_eq!(error, expected);
    for key in SortKey::ALL {
        assert_eq!(key.name().parse(), Ok(key));
    }
}
