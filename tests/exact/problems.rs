//! The shipped problems of exact synthesis from file to record.

use crate::common::{bytes, load, parse, root, run_on};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::point;
use linkwright::internals::record::{Completeness, Record};
use linkwright::internals::report::Colour;
use linkwright::internals::report::exact::exact_text;
use linkwright::internals::report::exact_sheet::exact_svg;

fn run(name: &str, threads: usize) -> Record {
    run_on(threads, load(&root().join(format!("problems/exact/{name}.toml")), &[]))
}

fn holds_its_expectation(name: &str, record: &Record) {
    let expect = load(&root().join(format!("problems/exact/{name}.toml")), &[]).expect;
    let expect = expect.and_then(|e| e.exact).expect("a census is expected");
    let census = record.exact.as_ref().expect("a census").census;
    let pairs = [
        (expect.classes, census.classes),
        (expect.real, census.real),
        (expect.one_circuit, census.one_circuit),
        (expect.in_order, census.in_order),
        (expect.free_of_defects, census.free_of_defects),
    ];
    for (expected, found) in pairs {
        assert!(expected.is_none_or(|n| n == found), "{name}: {expected:?} {found}");
    }
    assert_eq!(verify(record).expect("a problem"), []);
}

#[test]
fn problem_3_is_solved_certified_and_the_same_on_any_number_of_threads() {
    let record = run("wms3", 2);
    holds_its_expectation("wms3", &record);
    let exact = record.exact.as_ref().expect("exact answers");
    assert_eq!((exact.census.certified, exact.census.not_told_apart), (1442, 0));
    assert!(exact.linkages.iter().all(|l| l.certified.is_some_and(|c| c.radius < 1e-9)));
    let best = &record.candidates[0];
    assert!(best.accepted && best.certified.is_some() && exact.linkages[0].rank == 1);
    assert_eq!(bytes(&run("wms3", 1)), bytes(&record));
}

#[test]
fn five_points_on_given_pivots_have_36_linkages_two_of_them_to_be_built() {
    let record = run("bolt-holes", 2);
    holds_its_expectation("bolt-holes", &record);
    let exact = record.exact.as_ref().expect("exact answers");
    assert_eq!((exact.pivots, exact.census.certified, exact.census.not_told_apart), (2, 36, 0));
    let accepted: Vec<_> = record.candidates.iter().filter(|c| c.accepted).collect();
    assert_eq!(accepted.len(), 2);
    assert!(
        accepted
            .iter()
            .all(|c| c.linkage.four_bar().expect("a four-bar").follower_pivot() == point([4.0, 0.5])
                && c.certified.is_some())
    );
    assert_eq!(bytes(&run("bolt-holes", 1)), bytes(&record));
}

#[test]
fn a_record_that_claims_more_than_is_so_is_found_out() {
    let record = run("wms3", 2);
    let tampered = |change: &dyn Fn(&mut Record)| {
        let mut record = record.clone();
        change(&mut record);
        verify(&record).expect("a problem").iter().map(|m| m.what.clone()).collect::<Vec<_>>().join("; ")
    };
    let exact = |change: fn(&mut linkwright::internals::record::ExactRecord)| {
        tampered(&|record| record.exact.iter_mut().for_each(change))
    };
    assert!(exact(|e| e.census.failed = 1).contains("exact.census.tracked"));
    assert!(exact(|e| e.census.real += 1).contains("exact.census.real"));
    assert!(exact(|e| e.generic = false).contains("exact.generic"));
    assert!(exact(|e| e.linkages[3].free_of_defects = true).contains("linkages 4: what the class can do"));
    assert!(exact(|e| e.linkages[5].accepted = true).contains("linkages 6: accepted"));
    assert!(exact(|e| e.linkages[7].crank_deg[2] += 1.0).contains("linkages 8"));
    assert!(exact(|e| e.linkages[1].rank = 1).contains("linkages 2: rank"));
    let closer = |record: &mut Record| {
        record.candidates[0].certified.iter_mut().for_each(|c| c.radius /= 100.0);
    };
    assert!(tampered(&closer).contains("certified.radius"));
}

#[test]
fn the_gaussian_points_have_real_linkages_and_none_to_use() {
    let record = run("gaussian", 2);
    holds_its_expectation("gaussian", &record);
    assert!(record.candidates.iter().all(|c| !c.accepted));
    assert!(record.conflict.is_none() && record.relaxations.is_empty());
}

#[test]
fn the_linkage_that_drew_the_points_is_among_the_answers() {
    let record = run("crank-rocker", 2);
    holds_its_expectation("crank-rocker", &record);
    let exact = record.exact.as_ref().expect("exact answers");
    let drew = [point([0.0, 0.0]), point([4.0, 1.0])];
    let near = |l: &linkwright::internals::mechanism::FourBar| {
        let apart = (l.crank_pivot() - drew[0]).norm() + (l.follower_pivot() - drew[1]).norm();
        apart < 1e-9 && (l.crank() - 1.3).abs() < 1e-9 && (l.follower() - 3.6).abs() < 1e-9
    };
    let found = exact.linkages.iter().filter(|class| {
        near(class.linkage.four_bar().expect("a four-bar"))
            || class.others.iter().any(|form| near(form.linkage.four_bar().expect("a four-bar")))
    });
    let found: Vec<_> = found.collect();
    assert_eq!(found.len(), 1);
    assert!(found[0].free_of_defects);
}

#[test]
fn text_and_sheet_speak_of_every_linkage() {
    let record = run("gaussian", 2);
    let (few, all) = (exact_text(&record, false, Colour::Never), exact_text(&record, true, Colour::Never));
    assert!(all.contains("8 are linkages, 122 more have a real curve"), "{all}");
    assert!(all.contains("Not proved: that there are no others"), "{all}");
    assert!(few.lines().count() <= all.lines().count());
    let sheet = exact_svg(&record);
    let drawing = roxmltree::Document::parse(&sheet).expect("XML");
    let cells = drawing.descendants().filter(|node| node.has_tag_name("clipPath")).count();
    assert_eq!(cells, 8);
}

#[test]
fn points_on_a_circle_are_said_to_be_non_generic() {
    let record = run_on(
        2,
        parse(
            "format = 1\n[task.path]\npoints = [[1.0, 0.0], [0.8, 0.6], [0.28, 0.96], [-0.28, 0.96], [-0.8, 0.6], \
             [-1.0, 0.0], [-0.6, -0.8], [0.0, -1.0], [0.6, -0.8]]\n[solve]\nmethod = \"continuation\"\n",
        ),
    );
    let exact = record.exact.as_ref().expect("exact answers");
    assert!(!exact.generic);
    assert_eq!(exact.completeness, Completeness::NonGeneric);
    assert!(exact_text(&record, false, Colour::Never).contains("non-generic"));
    assert_eq!(verify(&record).expect("a problem"), []);
}
