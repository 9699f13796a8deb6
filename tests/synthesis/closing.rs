//! Closed paths: the motion comes back to the first point without reversing, unless the problem allows that.

use crate::common::{parse, run_on};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::record::{Figure, Record, TO_AND_FRO, WarningKind};
use linkwright::internals::report::Colour;
use linkwright::internals::report::table::candidates_table;
use linkwright::internals::task::Defect;
use linkwright::internals::task::Problem;

/// `n` points of an ellipse or an egg, `k` of its second harmonic.
fn oval(n: usize, k: f64, tables: &str) -> String {
    let points: Vec<String> = (0..n)
        .map(|i| {
            let t = std::f64::consts::TAU * i as f64 / n as f64;
            format!("[{:.4}, {:.4}]", 40.0 * t.cos() + 40.0 * k * (2.0 * t).cos(), 22.0 * t.sin())
        })
        .collect();
    format!("format = 1\n[task.path]\npoints = [{}]\nclosed = true\n{tables}", points.join(", "))
}

fn true_record(text: &str) -> Record {
    let record = run_on(2, parse(text));
    assert_eq!(verify(&record).expect("the problem is one"), Vec::new());
    record
}

fn flat(record: &Record) -> String {
    candidates_table(record, Colour::Never).split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn what_is_accepted_of_a_closed_path_turns_fully_whether_or_not_a_type_is_asked_for() {
    for (n, k, require) in [
        (12, 0.0, ""),
        (10, 0.15, ""),
        (24, 0.1, ""),
        (12, 0.1, "[require]\ntype = [\"crank-rocker\", \"rocker-crank\", \"triple-rocker\"]\n"),
    ] {
        let record = true_record(&oval(n, k, &format!("{require}[solve]\nevaluations = 30000\n")));
        assert!(record.candidates[0].accepted, "{n} {k} {require}");
        for candidate in &record.candidates {
            assert!(candidate.linkage_type.expect("a type").input_turns_fully(), "{n} {k} {require}");
            assert!(
                candidate.defects.is_empty()
                    && candidate.warnings.iter().all(|w| w.kind != WarningKind::ToAndFro)
            );
        }
    }
}

#[test]
fn a_rocker_is_refused_for_a_closed_path_and_accepted_in_words_where_the_way_back_is_any() {
    let rocker = "[require]\ntype = [\"triple-rocker\"]\nlongest_max = \"any\"\n";
    let budget = "[solve]\nevaluations = 12000\ncandidates = 30\n";
    let file = parse(&oval(12, 0.0, &format!("{rocker}{budget}")));
    assert!(file.warnings[0].message.contains("no crank of these types turns fully"), "{}", file.warnings[0]);
    let strict = true_record(&oval(12, 0.0, &format!("{rocker}{budget}")));
    assert!(!strict.candidates.is_empty());
    for candidate in &strict.candidates {
        assert!(!candidate.accepted && !candidate.goes_to_and_fro());
    }
    let refused = strict
        .candidates
        .iter()
        .find(|c| c.defects == [Defect::to_and_fro()])
        .expect("a rocker on one branch");
    let order = refused.requirements.iter().find(|r| r.name == "order").expect("it is asked");
    assert!(order.value == Figure::Word(TO_AND_FRO.into()) && !order.met);
    assert!(
        flat(&strict).contains("runs to and fro: back to point 0 only through all other points in reverse")
    );
    let any = true_record(&oval(12, 0.0, &format!("{rocker}closing = \"any\"\n{budget}")));
    let best = &any.candidates[0];
    assert!(best.accepted && best.goes_to_and_fro() && best.defects.is_empty());
    assert!(best.warnings.iter().any(|w| w.kind == WarningKind::ToAndFro));
    let page = flat(&any);
    assert!(page.contains("accepted (to and fro)") && page.contains("and back the same way"), "{page}");
    assert!(page.contains("the motion returns to its first point back through all others"), "{page}");
}

#[test]
fn the_way_back_is_among_what_conflicts_and_what_helps() {
    // Judged, not searched: the rocker of the loosened problem under the strict one.
    let rocker = "[require]\ntype = [\"triple-rocker\"]\n";
    let strict = parse(&oval(12, 0.0, &format!("{rocker}[solve]\nevaluations = 6000\n")));
    let record = true_record(&oval(12, 0.0, &format!("{rocker}[solve]\nevaluations = 6000\n")));
    let problem = Problem::new(strict.spec).expect("it is one");
    assert!(problem.has_to_turn_on());
    let among = &record.conflict.as_ref().expect("type and closing cannot be met together").among;
    assert!(among.contains(&"require.type".to_owned()), "{among:?}");
    let helps = |key: &str| record.relaxations.iter().any(|r| r.set.iter().any(|change| change.key == key));
    assert!(helps("require.closing"), "{:?}", record.relaxations);
}

#[test]
fn prescribed_angles_that_go_to_and_fro_close_no_path() {
    let timed = |angles: &str, require: &str| {
        oval(
            6,
            0.0,
            &format!(
                "[task.path.timing]\ncrank_deg = {angles}\n[require]\n{require}[solve]\nmethod = \"least-squares\"\nevaluations = 4000\n"
            ),
        )
    };
    let back = "[0, 60, 120, 180, 120, 60]";
    let file = parse(&timed(back, ""));
    assert!(file.warnings[0].message.contains("crank_deg turns back at point 4"), "{}", file.warnings[0]);
    assert!(run_on(2, file).candidates.iter().all(|c| !c.accepted));
    assert!(true_record(&timed("[0, 60, 120, 180, 240, 300]", "")).candidates[0].accepted);
    assert!(parse(&timed(back, "closing = \"any\"\n")).warnings.is_empty());
    assert!(parse(&timed("[0, -60, -120, -180, -240, -300]", "")).warnings.is_empty());
}

#[test]
fn mirror_images_of_a_symmetric_target_are_listed_once() {
    let record = true_record(&oval(12, 0.0, "[solve]\nevaluations = 30000\n"));
    assert!(record.candidates.iter().any(|c| c.mirror_serves));
    for (i, one) in record.candidates.iter().enumerate() {
        for other in &record.candidates[..i] {
            let (x, y) = (one.error.rms, other.error.rms);
            let same = (x - y).abs() <= 1e-7 * y
                && (one.transmission_deg.worst - other.transmission_deg.worst).abs() < 1e-5
                && (one.link_ratio - other.link_ratio).abs() < 1e-5 * other.link_ratio;
            assert!(!same, "#{} is #{} again", one.rank, other.rank);
        }
    }
    assert!(flat(&record).contains("the target is symmetric"));
    let bare = true_record(
        &oval(12, 0.13, "[solve]\nevaluations = 3000\n").replace("[40.0000, 0.0000]", "[40.5, 1.0]"),
    );
    let fewer = flat(&bare).contains("candidates that were asked for");
    assert_eq!(fewer, bare.candidates.len() < 5);
}
