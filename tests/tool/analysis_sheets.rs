//! The drawings of analyses and of cognates: which sheets there are, sound markup, no number that isn't one.

use crate::common::root;
use linkwright::internals::files::linkage_file;
use linkwright::internals::mechanism::Unit;
use linkwright::internals::mechanism::analysis::{Analysis, PositionMethod, Request, analyze, full_turn};
use linkwright::internals::mechanism::four_bar::motion::CrankMotion;
use linkwright::internals::mechanism::{AssemblyMode, FourBar, point};
use linkwright::internals::report::analysis_sheets::{CYCLE_ROWS, analysis_svg};
use linkwright::internals::report::cognates_sheet::cognates_svg;

const POSITIONS: &str = "Positions";
const CONSTRUCTION: &str = "Construction by arcs";
const VELOCITIES: &str = "Velocities";
const ACCELERATIONS: &str = "Accelerations";
const CONFIGURATIONS: &str = "The four configurations";
const CYCLE: &str = "Over the cycle";

fn shipped(name: &str) -> FourBar {
    let folders = ["linkages", "seeds"].map(|folder| root().join(format!("problems/{folder}/{name}.toml")));
    let path = folders.iter().find(|path| path.is_file()).unwrap_or_else(|| panic!("no linkage file {name}"));
    linkage_file::load(path).unwrap_or_else(|e| panic!("{e}")).linkage
}

fn linkage(ground: f64, links: [f64; 3], offset: [f64; 2]) -> FourBar {
    let pivots = [point([0.0, 0.0]), point([ground, 0.0])];
    FourBar::with_coupler_offset(pivots, links, point(offset), AssemblyMode::Plus).unwrap()
}

fn request(linkage: FourBar, crank_deg: Vec<f64>, speed_rad_s: f64) -> Request {
    Request {
        name: "a linkage".to_owned(),
        unit: Some(Unit::Mm),
        linkage,
        crank_deg,
        input: CrankMotion::steady(speed_rad_s).into(),
        methods: vec![PositionMethod::Natural],
        all_configurations: false,
    }
}

/// The texts of a drawing that is sound: well-formed, by itself, every number finite.
fn texts(svg: &str) -> Vec<String> {
    let document = roxmltree::Document::parse(svg).unwrap_or_else(|error| panic!("{error}\n{svg}"));
    assert_eq!(document.root_element().tag_name().name(), "svg");
    for node in document.descendants().filter(|node| node.is_element()) {
        assert!(!["script", "image", "use", "a", "style", "foreignObject"].contains(&node.tag_name().name()));
        for attribute in node.attributes() {
            let value = attribute.value();
            assert!(!attribute.name().starts_with("on") && attribute.name() != "href", "{value}");
            for word in ["NaN", "inf", "url("] {
                assert!(!value.contains(word), "{} = {value}", attribute.name());
            }
        }
    }
    let texts = document.descendants().filter(|node| node.is_text()).filter_map(|node| node.text());
    texts.map(str::trim).filter(|text| !text.is_empty()).map(str::to_owned).collect()
}

/// Which sheets an analysis has.
fn sheets(analysis: &Analysis) -> Vec<&'static str> {
    let texts = texts(&analysis_svg(analysis));
    [POSITIONS, CONSTRUCTION, VELOCITIES, ACCELERATIONS, CONFIGURATIONS, CYCLE]
        .into_iter()
        .filter(|title| texts.iter().any(|text| text == title))
        .collect()
}

#[test]
fn the_example_of_de_castro_has_his_figures() {
    let analysis = analyze(&request(shipped("de-castro-2-1"), vec![90.0, 120.0, 150.0, 180.0], 5.0));
    assert_eq!(sheets(&analysis), [POSITIONS, CONSTRUCTION, VELOCITIES, ACCELERATIONS]);
    let texts = texts(&analysis_svg(&analysis));
    for angle in ["90°", "120°", "150°", "180°"] {
        assert!(texts.iter().any(|text| text == angle), "{angle}");
    }
    // |vC| = a omega = 700 * 5, |aC| = a omega^2.
    assert!(texts.iter().any(|text| text.starts_with("vC 3500 at 180°")), "{texts:?}");
    assert!(texts.iter().any(|text| text.starts_with("aC 17500 at 270°")), "{texts:?}");
}

#[test]
fn a_crank_at_rest_has_no_vectors_and_one_that_starts_only_accelerations() {
    let mut start = request(shipped("romero"), vec![60.0], 0.0);
    assert_eq!(sheets(&analyze(&start)), [POSITIONS, CONSTRUCTION]);
    start.input =
        CrankMotion { speed_rad_s: start.input.mean().speed_rad_s, acceleration_rad_s2: 2.0 }.into();
    assert_eq!(sheets(&analyze(&start)), [POSITIONS, CONSTRUCTION, ACCELERATIONS]);
}

#[test]
fn four_configurations_are_drawn_only_where_all_were_asked_for() {
    let mut all = request(shipped("romero"), vec![60.0], 0.0);
    all.all_configurations = true;
    let analysis = analyze(&all);
    assert_eq!(sheets(&analysis), [POSITIONS, CONSTRUCTION, CONFIGURATIONS]);
    let texts = texts(&analysis_svg(&analysis));
    for signs in ["t1 = +1, t2 = +1", "t1 = +1, t2 = −1", "t1 = −1, t2 = +1", "t1 = −1, t2 = −1"] {
        assert_eq!(texts.iter().filter(|text| *text == signs).count(), 1, "{signs}");
    }
}

#[test]
fn curves_over_the_cycle_need_enough_rows_that_differ_and_close() {
    let with = |rows: Vec<f64>| sheets(&analyze(&request(shipped("hoeken"), rows, 1.0)));
    assert!(with(full_turn(CYCLE_ROWS)).contains(&CYCLE));
    assert!(!with(full_turn(CYCLE_ROWS - 1)).contains(&CYCLE));
    assert!(!with(vec![10.0; 100]).contains(&CYCLE));
    let apart = linkage(100.0, [1.0, 2.0, 3.0], [1.0, 1.0]);
    assert_eq!(sheets(&analyze(&request(apart, full_turn(60), 1.0))), [POSITIONS]);
}

#[test]
fn open_stretches_and_toggles_are_marked() {
    // g 10, a 6, b 7, c 5: g + a > b + c, the input stops before it is stretched out.
    let triple_rocker = linkage(10.0, [6.0, 7.0, 5.0], [4.0, 3.0]);
    let texts_rocker = texts(&analysis_svg(&analyze(&request(triple_rocker, full_turn(360), 2.0))));
    assert!(texts_rocker.iter().any(|text| text == "open"));
    assert!(texts_rocker.iter().any(|text| text.contains("dashed: toggles")));
    assert!(texts_rocker.iter().any(|text| text.contains("cut off")));
    let texts_crank = texts(&analysis_svg(&analyze(&request(shipped("hoeken"), full_turn(360), 2.0))));
    assert!(
        !texts_crank.iter().any(|text| text == "open" || text.contains("toggles") || text.contains("cut"))
    );
}

#[test]
fn a_row_that_is_open_leaves_the_others_to_be_drawn() {
    let rocker = linkage(10.0, [6.0, 7.0, 5.0], [4.0, 3.0]);
    let some = analyze(&request(rocker, vec![180.0, 40.0], 2.0));
    let texts = texts(&analysis_svg(&some));
    assert!(texts.iter().any(|text| text == "the first position that closes, crank at 40°"), "{texts:?}");
    assert!(texts.iter().any(|text| text.starts_with("2 positions: 1 ok, 1 open")), "{texts:?}");
    assert_eq!(sheets(&analyze(&request(rocker, vec![180.0], 2.0))), [POSITIONS]);
    assert_eq!(sheets(&analyze(&request(rocker, Vec::new(), 2.0))), [POSITIONS]);
}

#[test]
fn degenerate_linkages_and_sizes_give_sound_drawings() {
    let scaled = |s: f64| linkage(4.0 * s, [2.0 * s, 5.0 * s, 5.0 * s], [2.0 * s, 4.0 * s]);
    let linkages = [
        scaled(1e11),
        scaled(1e-11),
        scaled(1e-300),
        // A parallelogram at its change point, a flat change point, P on C, P on D, coincident pivots.
        linkage(4.0, [2.0, 4.0, 2.0], [2.0, 1.0]),
        linkage(6.0, [1.0, 2.0, 3.0], [1.0, 0.0]),
        linkage(4.0, [2.0, 5.0, 5.0], [0.0, 0.0]),
        linkage(4.0, [2.0, 5.0, 5.0], [5.0, 0.0]),
        linkage(0.0, [2.0, 5.0, 5.0], [1.0, 1.0]),
        linkage(2.0, [2.0, 5.0, 5.0], [1.0, 1.0]),
    ];
    for linkage in linkages {
        for angles in [full_turn(72), vec![0.0], vec![180.0, 1e9, -1e12], vec![f64::NAN, 1e300, 30.0]] {
            for speed in [5.0, 1e300, -1e-300] {
                let mut request = request(linkage, angles.clone(), speed);
                request.all_configurations = true;
                texts(&analysis_svg(&analyze(&request)));
            }
        }
        let cognates: Vec<FourBar> =
            linkage.cognates().into_iter().filter_map(|cognate| Some(cognate.ok()?.linkage)).collect();
        texts(&cognates_svg("degenerate", None, &linkage, &cognates));
    }
}

#[test]
fn hostile_names_are_text() {
    let name = "</text><script>alert(1)</script>&\u{0}\u{202e}\" onload=\"x";
    let mut request = request(shipped("hoeken"), full_turn(30), 1.0);
    request.name = name.to_owned();
    let hoeken = shipped("hoeken");
    for svg in [analysis_svg(&analyze(&request)), cognates_svg(name, None, &hoeken, &[])] {
        assert!(texts(&svg).iter().any(|text| text.contains("<script>alert(1)</script>&\" onload")));
    }
}

#[test]
fn the_same_analysis_gives_the_same_bytes() {
    let request = request(shipped("chebyshev"), full_turn(48), 1.0);
    assert_eq!(analysis_svg(&analyze(&request)), analysis_svg(&analyze(&request)));
}

#[test]
fn an_analysis_without_a_configuration_is_a_page_with_its_name() {
    let mut analysis = analyze(&request(shipped("hoeken"), vec![0.0], 1.0));
    analysis.configurations.clear();
    assert_eq!(sheets(&analysis), [""; 0]);
    assert!(texts(&analysis_svg(&analysis)).iter().any(|text| text == "a linkage"));
}

#[test]
fn cognates_stand_on_three_pivots_with_one_coupler_point() {
    for name in ["hoeken", "romero", "de-castro-2-1", "chebyshev", "roberts"] {
        let original = shipped(name);
        let cognates: Vec<FourBar> =
            original.cognates().into_iter().filter_map(|cognate| Some(cognate.ok()?.linkage)).collect();
        assert_eq!(cognates.len(), 2);
        let texts = texts(&cognates_svg(name, Some(Unit::Cm), &original, &cognates));
        for (letter, count) in [("P", 1), ("A", 1), ("B", 1), ("G", 1), ("C", 1), ("C1", 1), ("D2", 1)] {
            assert_eq!(texts.iter().filter(|text| *text == letter).count(), count, "{name}: {letter}");
        }
        assert!(!texts.iter().any(|text| text.contains("not drawn")), "{name}");
    }
}

#[test]
fn what_is_no_cognate_is_not_drawn() {
    let other = linkage(40.0, [1.0, 50.0, 50.0], [20.0, 2.0]);
    let texts = texts(&cognates_svg("x", None, &shipped("hoeken"), &[other]));
    assert!(texts.iter().any(|text| text.contains("not drawn: it does not reach P")), "{texts:?}");
    assert!(!texts.iter().any(|text| text == "C1"));
}
