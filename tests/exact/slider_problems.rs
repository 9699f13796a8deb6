//! Eight points of linkages with a slider, from file to record: the shipped problems and random ones, beside a computation of their
//! own.

use crate::common::thorough::cases;
use crate::common::{bytes, load, parse, root, run_on};
use crate::sliders::Linkage;
use linkwright::internals::judge::certified::{certified, same, target};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::{Complex, CrankLinkage, InvertedSliderCrank, SliderCrank, point};
use linkwright::internals::numbers::arithmetic::streams::stream;
use linkwright::internals::numbers::nine_point::target::{Closure, Kind, STEPS};
use linkwright::internals::record::{Completeness, ExactLinkage, ExactRecord, Reason, Record};
use linkwright::internals::report::Colour;
use linkwright::internals::report::exact::exact_text;
use linkwright::internals::report::exact_sheet::exact_svg;
use linkwright::internals::task::Problem;
use linkwright::{AssemblyMode, InvertedSliderCrankParameters, SliderCrankParameters};

fn run(name: &str, threads: usize) -> Record {
    run_on(threads, load(&root().join(format!("problems/sliders/{name}.toml")), &[]))
}

fn exact(record: &Record) -> &ExactRecord {
    record.exact.as_ref().expect("exact answers")
}

/// The linkages from which the shipped problems were drawn.
fn drew(closure: Closure) -> CrankLinkage {
    match closure {
        Closure::SliderCrank => SliderCrank::new(SliderCrankParameters {
            crank_pivot: [12.0, 8.0],
            crank: 40.0,
            coupler: 110.0,
            line_point: [15.0, -22.0],
            line_deg: 8.0,
            coupler_x: 95.0,
            coupler_y: 35.0,
            assembly: AssemblyMode::Plus,
        })
        .map(CrankLinkage::from),
        _ => InvertedSliderCrank::new(InvertedSliderCrankParameters {
            crank_pivot: [-20.0, 10.0],
            block_pivot: [75.0, -5.0],
            crank: 38.0,
            offset: 12.0,
            coupler_x: 150.0,
            coupler_y: 28.0,
            assembly: AssemblyMode::Plus,
        })
        .map(CrankLinkage::from),
    }
    .expect("a linkage")
}

/// The linkage of a class in the terms of the other computation.
fn lengths(linkage: &CrankLinkage) -> Linkage {
    let pivot = linkage.crank_pivot();
    let common = |slider, line, at, offset| Linkage {
        closure: if linkage.slider_crank().is_some() {
            Closure::SliderCrank
        } else {
            Closure::InvertedSliderCrank
        },
        pivot,
        crank: linkage.crank(),
        slider,
        line,
        at,
        offset,
        point: linkage.coupler_offset(),
    };
    match linkage {
        CrankLinkage::SliderCrank(own) => {
            common(Complex::new(own.coupler(), 0.0), own.line_direction(), own.line_point(), 0.0)
        }
        CrankLinkage::InvertedSliderCrank(own) => {
            common(Complex::ONE, Complex::ONE, own.block_pivot(), own.offset())
        }
        other => panic!("no slider: {other}"),
    }
}

/// Checks that a listed linkage passes the points at its crank angles, by the other computation.
fn passes(points: &[Complex], class: &ExactLinkage) {
    let own = lengths(&class.linkage);
    for (wanted, deg) in points.iter().zip(&class.crank_deg) {
        let nearest = own
            .places(deg.to_radians())
            .into_iter()
            .map(|(place, sine)| (place - wanted).norm() * sine.max(1e-6))
            .fold(f64::INFINITY, f64::min);
        assert!(nearest <= 1e-10 * own.extent(), "{nearest:e}: {}", class.linkage);
    }
}

fn points_of(record: &Record) -> Vec<Complex> {
    record.problem.resolved.task.points.iter().map(|p| point(*p)).collect()
}

/// Returns the class that has a linkage among its mechanisms.
fn class_of<'a>(record: &'a Record, linkage: &CrankLinkage) -> &'a ExactLinkage {
    let near = |own: &CrankLinkage| {
        let reach = 1e-6 * linkage.longest_link();
        let marks = |l: &CrankLinkage| {
            let second = l.slider_crank().map_or_else(
                || l.second_pivot().expect("a block's pivot"),
                |own| {
                    let height = own.pivot_height();
                    l.crank_pivot() - own.line_direction() * Complex::I * height
                },
            );
            [l.crank_pivot(), second, Complex::new(l.crank(), l.crank_side())]
        };
        marks(own).iter().zip(marks(linkage)).all(|(one, other)| (one - other).norm() < reach)
    };
    let mut found = exact(record)
        .linkages
        .iter()
        .filter(|class| near(&class.linkage) || class.others.iter().any(|form| near(&form.linkage)));
    let class = found.next().expect("the linkage that drew the points");
    assert!(found.next().is_none());
    class
}

fn is_complete(record: &Record, closure: Closure) {
    let own = exact(record);
    assert_eq!(own.census.classes, Kind::of_points(closure).classes());
    assert_eq!((own.completeness, own.generic), (Completeness::Complete, true));
    for class in &own.linkages {
        passes(&points_of(record), class);
        assert!(class.others.len() <= usize::from(closure == Closure::SliderCrank));
    }
    assert_eq!(verify(record).expect("a problem"), []);
}

#[test]
fn the_linkage_with_a_slider_that_drew_the_points_is_among_the_answers() {
    for (name, closure) in
        [("slider-exact", Closure::SliderCrank), ("inverted-exact", Closure::InvertedSliderCrank)]
    {
        let record = run(name, 2);
        is_complete(&record, closure);
        let expect = load(&root().join(format!("problems/sliders/{name}.toml")), &[]).expect;
        let expect = expect.and_then(|e| e.exact).expect("a census is expected");
        let census = exact(&record).census;
        let found =
            [census.classes, census.real, census.one_circuit, census.in_order, census.free_of_defects];
        let known =
            [expect.classes, expect.real, expect.one_circuit, expect.in_order, expect.free_of_defects];
        assert_eq!(known, found.map(Some), "{name}");
        assert_eq!(census.not_told_apart, 0);
        let class = class_of(&record, &drew(closure));
        assert!(class.free_of_defects && class.accepted && class.certified.is_some_and(|c| c.radius < 1e-7));
        let best = &record.candidates[0];
        assert!(best.accepted && best.certified.is_some());
        assert_eq!((record.termination.reason, exact(&record).linkages[0].rank), (Reason::TargetReached, 1));
        assert_eq!(bytes(&run(name, 1)), bytes(&record));
    }
}

#[test]
fn eight_points_of_random_linkages_have_all_of_their_kind() {
    for (kind, closure, count) in [
        ("slider-crank", Closure::SliderCrank, cases(2, 6)),
        ("inverted-slider-crank", Closure::InvertedSliderCrank, cases(1, 3)),
    ] {
        for index in 0..count {
            let mut draws = stream(73 + closure as u64, index);
            let (own, angles) = Linkage::with_eight_places(&mut draws, closure);
            let points: Vec<String> = angles
                .iter()
                .map(|angle| own.places(*angle)[0].0)
                .map(|p| format!("[{:?}, {:?}]", p.re, p.im))
                .collect();
            assert_eq!(points.len(), STEPS);
            let text = format!(
                "format = 1\n[task.path]\npoints = [{}]\n[design]\nmechanism = [\"{kind}\"]\n[solve]\nmethod = \
                 \"continuation\"\n",
                points.join(", ")
            );
            let record = run_on(2, parse(&text));
            is_complete(&record, closure);
            class_of(&record, &own.linkage());
        }
    }
}

#[test]
fn a_record_of_sliders_that_claims_more_than_is_so_is_found_out() {
    let record = run("slider-exact", 2);
    let found = |change: &dyn Fn(&mut Record)| {
        let mut record = record.clone();
        change(&mut record);
        verify(&record).expect("a problem").iter().map(|m| m.what.clone()).collect::<Vec<_>>().join("; ")
    };
    let of_exact = |change: fn(&mut ExactRecord)| found(&|record| record.exact.iter_mut().for_each(change));
    assert!(of_exact(|e| e.kind = linkwright::LinkageKind::FourBar).contains("exact.kind"));
    assert!(of_exact(|e| e.census.classes -= 1).contains("exact.census.finite"));
    assert!(of_exact(|e| e.linkages[0].others.clear()).contains("linkages 1: others"));
    assert!(of_exact(|e| e.linkages[1].crank_deg[3] += 1.0).contains("linkages 2"));
    assert!(of_exact(|e| e.linkages[0].linkage = e.linkages[1].linkage).contains("linkages 1"));
    let closer = |record: &mut Record| {
        record.candidates[0].certified.iter_mut().for_each(|c| c.radius /= 100.0);
    };
    assert!(found(&closer).contains("certified.radius"));
    let bent = |record: &mut Record| {
        let own = record.candidates[0].linkage;
        let parameters = own.slider_crank().expect("a slider-crank").parameters();
        let moved = SliderCrankParameters { line_deg: parameters.line_deg + 1e-3, ..parameters };
        record.candidates[0].linkage = SliderCrank::new(moved).expect("a linkage").into();
    };
    assert!(!found(&bent).is_empty());
}

/// The keys that place a linkage, each moved by so much of the target's size.
fn moved(linkage: &CrankLinkage, size: f64, by: f64) -> Vec<CrankLinkage> {
    let length = by * size;
    let shifted = |[x, y]: [f64; 2]| [x + length, y];
    match linkage {
        CrankLinkage::SliderCrank(own) => {
            let p = own.parameters();
            [
                SliderCrankParameters { crank_pivot: shifted(p.crank_pivot), ..p },
                SliderCrankParameters { line_deg: p.line_deg + by.to_degrees(), ..p },
            ]
            .map(|p| SliderCrank::new(p).expect("a linkage").into())
            .to_vec()
        }
        CrankLinkage::InvertedSliderCrank(own) => {
            let p = own.parameters();
            [
                InvertedSliderCrankParameters { crank_pivot: shifted(p.crank_pivot), ..p },
                InvertedSliderCrankParameters { block_pivot: shifted(p.block_pivot), ..p },
            ]
            .map(|p| InvertedSliderCrank::new(p).expect("a linkage").into())
            .to_vec()
        }
        other => panic!("no slider: {other}"),
    }
}

#[test]
fn the_radius_of_a_proof_bounds_pivots_and_the_direction_of_the_line() {
    for name in ["slider-exact", "inverted-exact"] {
        let record = run(name, 2);
        let problem = Problem::new(record.problem.resolved.clone()).expect("a problem");
        let (of, size) = (target(&problem).expect("a target"), problem.task().size());
        let best = &record.candidates[0];
        let own = best.certified.expect("a proof").radius;
        assert!(own < 1e-9 * size, "{own:e}");
        // The turn of the line about Q moves its point at the target's size from D by at least that less the travel's part.
        let proved = |by: f64| {
            let all = moved(&best.linkage, size, by).into_iter().map(|linkage| {
                let mut candidate = best.clone();
                candidate.linkage = linkage;
                certified(&problem, &of, &candidate).map(|proof| proof.radius)
            });
            all.collect::<Vec<_>>()
        };
        for by in [1e-13, 1e-12] {
            for radius in proved(by) {
                let radius = radius.expect("a proof");
                assert!(radius >= 0.9 * by * size && radius < 100.0 * by * size, "{name}: {radius:e}");
            }
        }
        // That far away it is not proved that there is no other one.
        assert!(proved(1e-8).iter().all(Option::is_none), "{name}");
    }
}

#[test]
fn a_linkage_with_a_slider_is_the_same_whichever_way_its_line_points() {
    for closure in [Closure::SliderCrank, Closure::InvertedSliderCrank] {
        let own = drew(closure);
        let turned = own.reversed().expect("it has a slider");
        assert!(same(&own, &turned) && same(&turned, &own) && own.assembly() != turned.assembly());
        for deg in [0.0_f64, 100.0, 250.0] {
            let place =
                |l: &CrankLinkage| l.joints_with(deg.to_radians(), l.assembly()).expect("closed").joints;
            assert!((place(&own).coupler_point - place(&turned).coupler_point).norm() < 1e-10);
        }
        let other = moved(&own, 100.0, 1e-5);
        assert!(other.iter().all(|other| !same(&own, other)));
    }
}

#[test]
fn text_and_sheet_speak_of_every_slider_crank() {
    let record = run("slider-exact", 2);
    let (few, all) = (exact_text(&record, false, Colour::Never), exact_text(&record, true, Colour::Never));
    let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    for words in [
        "Every slider-crank through the eight points",
        "279 solutions up to cognates: as many as eight points in general position have",
        "that rests on the count published by Tari and Su (2010)",
        "the better of its two mechanisms (two cognates)",
    ] {
        assert!(flat(&few).contains(words) && flat(&all).contains(words), "{words}: {few}");
    }
    let drawing = exact_svg(&record);
    let drawing = roxmltree::Document::parse(&drawing).expect("XML");
    let cells = drawing.descendants().filter(|node| node.has_tag_name("clipPath")).count();
    assert_eq!(cells, exact(&record).linkages.len());
}

#[test]
fn eight_points_on_a_circle_or_a_line_are_said_to_be_non_generic() {
    let on_circle = "[1.0, 0.0], [0.8, 0.6], [0.28, 0.96], [-0.28, 0.96], [-0.8, 0.6], [-1.0, 0.0], [-0.6, -0.8], [0.6, -0.8]";
    let on_line = "[0, 0], [1, 0.5], [2, 1], [3.5, 1.75], [4, 2], [5.5, 2.75], [7, 3.5], [8, 4]";
    for (points, kind) in
        [(on_circle, "slider-crank"), (on_line, "slider-crank"), (on_line, "inverted-slider-crank")]
    {
        let text = format!(
            "format = 1\n[task.path]\npoints = [{points}]\n[design]\nmechanism = \"{kind}\"\n[solve]\nmethod = \
             \"continuation\"\n"
        );
        let record = run_on(2, parse(&text));
        assert!(!exact(&record).generic);
        assert_eq!(
            exact(&record).completeness,
            Completeness::NonGeneric,
            "{points}: {:?}",
            exact(&record).census
        );
        assert!(exact_text(&record, false, Colour::Never).contains("non-generic"));
        assert_eq!(verify(&record).expect("a problem"), []);
    }
}
