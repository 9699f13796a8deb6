//! Every file in `problems/` loads, says the same again, and can be written and read back.

use crate::common::{bytes, load, run_on, shipped};
use linkwright::internals::files::linkage_file;
use linkwright::internals::record::Record;
use linkwright::internals::task::spec::ProblemSpec;

#[test]
fn every_problem_loads_without_a_warning_and_survives_a_round_trip() {
    for path in shipped("toml")
        .iter()
        .filter(|p| !p.parent().is_some_and(|d| d.ends_with("linkages") || d.ends_with("seeds")))
    {
        let file = load(path, &[]);
        assert!(file.warnings.is_empty(), "{}: {:?}", path.display(), file.warnings);
        assert_eq!(path.file_stem().and_then(|s| s.to_str()), Some(file.name.as_str()));
        let text = serde_json::to_string(&file.spec).expect("it is data");
        let again: ProblemSpec = serde_json::from_str(&text).expect("it reads back");
        assert_eq!(again, file.spec, "{}", path.display());
    }
}

#[test]
fn every_published_problem_has_a_source_and_an_expectation() {
    for path in shipped("toml").iter().filter(|p| p.parent().is_some_and(|d| d.ends_with("literature"))) {
        let file = load(path, &[]);
        assert!(file.source.is_some(), "{}", path.display());
        let expect = file.expect.unwrap_or_else(|| panic!("{} expects nothing", path.display()));
        assert!(expect.best_known_sum_sq.is_some(), "{}", path.display());
    }
}

#[test]
fn every_four_bar_linkage_file_survives_a_round_trip() {
    for path in shipped("toml")
        .iter()
        .filter(|p| p.parent().is_some_and(|d| d.ends_with("linkages") || d.ends_with("seeds")))
    {
        let Ok(file) = linkage_file::load(path) else { continue };
        let text = linkage_file::to_toml(&file.name, file.unit, &file.linkage);
        let again = linkage_file::parse("again.toml", &text).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(again.linkage, file.linkage, "{}", path.display());
    }
}

#[test]
fn a_record_reads_back_to_the_same_bytes() {
    let record = run_on(1, crate::common::literature("e5", &[]));
    let text = bytes(&record);
    let again: Record = serde_json::from_str(&text).expect("it reads back");
    assert_eq!(bytes(&again), text);
    assert_eq!(again, record);
}
