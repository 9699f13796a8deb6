//! Known solutions as the record lists them.

use crate::known::{GAUSSIAN, WMS3, target};
use crate::verdicts::verdicts;
use linkwright::internals::files::problem_file;
use linkwright::internals::judge::exact_linkages::Depth;
use linkwright::internals::numbers::nine_point::{Solution, Target};
use linkwright::internals::record::{Census, Completeness, ExactLinkage};
use linkwright::internals::synthesis::continuation::{Exact, listed};
use linkwright::internals::task::Defect;
use linkwright::internals::task::Problem;
use linkwright::internals::task::forms::precision::Precise;

fn problem(target: &Target, more: &str) -> Problem {
    let points: Vec<String> = target.points.iter().map(|p| format!("[{}, {}]", p.re, p.im)).collect();
    let points = points.join(", ");
    let text =
        format!("format = 1\n[task.path]\npoints = [{points}]\n[solve]\nmethod = \"continuation\"\n{more}");
    let file = problem_file::parse("nine.toml", &text, None, &[]).unwrap_or_else(|e| panic!("{e}"));
    Problem::new(file.spec).expect("a problem")
}

fn census(real: usize, real_curve: usize) -> Census {
    Census {
        tracked: 1442,
        finite: 1442,
        classes: 1442,
        real,
        real_curve,
        complex: 1442 - real - real_curve,
        certified: 1442,
        ..Census::default()
    }
}

fn listing(name: &str, points: [[f64; 2]; 9], real_curve: usize, more: &str) -> Exact {
    let target = target(points);
    let real: Vec<Solution> = verdicts(name, &target).iter().map(|class| class.solution).collect();
    let counted = (census(real.len(), real_curve), Completeness::Complete);
    listed(&problem(&target, more), &Precise::from(target), counted, &real, Depth::Whole)
}

fn free(list: &[ExactLinkage]) -> usize {
    list.iter().filter(|l| l.defects.is_empty()).count()
}

#[test]
fn problem_3_lists_64_linkages_and_the_one_without_defects_first() {
    let exact = listing("wms3", WMS3, 116, "");
    let (census, list) = (exact.record.census, &exact.record.linkages);
    assert!(exact.record.generic);
    assert_eq!((census.one_circuit, census.in_order, census.free_of_defects), (30, 3, 1));
    assert_eq!((list.len(), census.degenerate, free(list)), (64, 0, 1));
    // Its links are within the defaults or not; free of defects is what comes first among the refused too.
    assert!(list[0].defects.is_empty(), "{:?}", list[0]);
    assert!(list.iter().all(|l| l.others.len() == 5 && l.t1_at.len() == 9));
    for pair in list.windows(2) {
        let grave = |defect: &Defect| match defect {
            Defect::Branch { .. } => 1,
            Defect::Order { .. } => 2,
            Defect::Circuit { .. } => 4,
        };
        let severity = |l: &ExactLinkage| l.defects.iter().map(grave).sum::<usize>();
        let key = |l: &ExactLinkage| (!l.accepted, severity(l), l.not_met.len());
        assert!(key(&pair[0]) <= key(&pair[1]), "{pair:?}");
    }
}

#[test]
fn what_is_required_orders_the_list_and_takes_nothing_from_it() {
    let any = "[require]\norder = \"any\"\nbranch = \"any\"\nlink_ratio_max = 1000";
    let loose = listing("wms3", WMS3, 116, any);
    let strict = listing("wms3", WMS3, 116, "");
    assert_eq!((loose.record.linkages.len(), strict.record.linkages.len()), (64, 64));
    assert_eq!(loose.record.census, strict.record.census);
    let accepted = |exact: &Exact| exact.record.linkages.iter().filter(|l| l.accepted).count();
    assert!(accepted(&loose) > accepted(&strict));
}

#[test]
fn the_gaussian_points_have_nothing_to_build() {
    let exact = listing("gaussian", GAUSSIAN, 122, "");
    let census = exact.record.census;
    assert_eq!((census.one_circuit, census.in_order, census.free_of_defects), (6, 0, 0));
    assert!(exact.record.linkages.iter().all(|l| !l.accepted));
}
