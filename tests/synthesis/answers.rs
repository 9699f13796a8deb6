//! What a record says beside its errors: distinct answers, cognates of the same curve, families of exact
//! answers, warnings and what can be built.

use crate::common::{bytes, literature, parse, run_on};
use linkwright::internals::judge::assess::assess;
use linkwright::internals::judge::cognates::cognates;
use linkwright::internals::judge::family::dimension;
use linkwright::internals::judge::rank::{chosen, count_distinct, distinct, divided};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::judge::warnings::{is_serious, warnings};
use linkwright::internals::mechanism::{AssemblyMode, FourBar, LinkageType, NaturalCoordinates};
use linkwright::internals::record::{Candidate, Record, Warning, WarningKind};
use linkwright::internals::synthesis::buildable::buildable;
use linkwright::internals::synthesis::offered_cognates;
use linkwright::internals::synthesis::{Budget, Context, plan};
use linkwright::internals::task::Problem;
use std::sync::atomic::AtomicBool;

fn is_true(record: &Record) {
    assert_eq!(verify(record).expect("the problem is one"), Vec::new());
}

fn problem(name: &str, set: &[(&str, &str)]) -> Problem {
    Problem::new(literature(name, set).spec).expect("it is one")
}

/// Everything that a search finds, the ranked first.
fn found(problem: &Problem) -> Vec<Candidate> {
    let flag = AtomicBool::new(false);
    let budget = Budget { cancel: &flag, deadline: None };
    let outcome = plan::search(Context::new(problem, &budget)).expect("it runs");
    outcome.candidates.into_iter().chain(outcome.others).collect()
}

fn joints(candidate: &Candidate) -> [linkwright::internals::mechanism::Complex; 4] {
    let joints = candidate
        .linkage
        .four_bar()
        .expect("a four-bar")
        .position_with(candidate.crank_deg[0].to_radians(), candidate.t1_at[0])
        .joints()
        .expect("it closes");
    let linkage = candidate.linkage.four_bar().expect("a four-bar");
    [linkage.crank_pivot(), linkage.follower_pivot(), joints.crank_pin, joints.follower_pin]
}

#[test]
fn five_members_of_a_family_look_different_and_are_ranked_by_transmission_angle() {
    let record = run_on(1, literature("v6", &[("solve.candidates", "5")]));
    is_true(&record);
    assert_eq!(record.candidates.len(), 5);
    for (i, one) in record.candidates.iter().enumerate() {
        assert!(one.error.sum_sq < 1e-18);
        for other in &record.candidates[..i] {
            assert!(one.transmission_deg.worst <= other.transmission_deg.worst);
            // A joint of one lies at least an eighth of the target's size from its counterpart: to be seen.
            let moved =
                joints(one).iter().zip(&joints(other)).map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
            assert!(moved > 25.0 / 8.0, "{} and {}: {moved}", one.rank, other.rank);
        }
    }
    let family = record.family.as_ref().expect("it says so");
    assert!(family.exact);
    assert_eq!(family.dimension, 3, "nine unknowns, six points");
    assert!(family.text.contains("3-parameter family"));
}

#[test]
fn the_dimension_of_a_family_counts_unknowns_that_the_points_do_not_fix() {
    let record = run_on(1, literature("v6", &[("solve.candidates", "1")]));
    let best = &record.candidates[0];
    let of = |set: &[(&str, &str)]| dimension(&problem("v6", set), best);
    let a = best.linkage.crank().to_string();
    let ground = best.linkage.four_bar().expect("a four-bar").ground().to_string();
    assert_eq!(of(&[]), Some(3));
    assert_eq!(of(&[("design.a", &a)]), Some(2));
    assert_eq!(of(&[("design.a", &a), ("design.ground", &ground)]), Some(1));
    // The same length between free pivots is an equation instead of one unknown less.
    assert_eq!(of(&[("design.B", "[[-90, 90], [-90, 90]]"), ("design.ground", &ground)]), Some(2));
}

#[test]
fn few_points_at_prescribed_angles_leave_a_family_too() {
    let text = "format = 1\n[task.path]\npoints = [[0, 0], [2, 1], [4, 0]]\n[task.path.timing]\n\
                crank_deg = [0, 30, 60]\n[solve]\ncandidates = 3\n";
    let record = run_on(1, parse(text));
    is_true(&record);
    // Nine parameters and the offset, six equations.
    assert_eq!(record.family.as_ref().expect("it says so").dimension, 4);
    assert_eq!(record.candidates.len(), 3);
}

#[test]
fn an_exact_answer_to_many_points_stands_alone_and_a_poor_one_has_no_family() {
    // Twenty points of a known linkage: nothing is left to choose.
    let linkage = FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [4.0, 1.0],
        crank: 1.5,
        coupler: 4.0,
        follower: 3.5,
        crank_side: 3.0,
        follower_side: 2.5,
        assembly: AssemblyMode::Plus,
        side: linkwright::internals::mechanism::CouplerSide::Plus,
    })
    .expect("it is one");
    let deg: Vec<f64> = (0..20).map(|i| 18.0 * f64::from(i)).collect();
    let points: Vec<String> = deg
        .iter()
        .map(|d| linkage.position(d.to_radians()).joints().expect("it turns").coupler_point)
        .map(|p| format!("[{:?}, {:?}]", p.re, p.im))
        .collect();
    let text = format!("format = 1\n[task.path]\npoints = [{}]\nclosed = true\n", points.join(", "));
    let problem = Problem::new(parse(&text).spec).expect("it is one");
    let candidate = assess(&problem, linkage, &deg, &[AssemblyMode::Plus; 20]).expect("it closes");
    assert!(candidate.accepted && candidate.error.sum_sq < 1e-24);
    assert_eq!(dimension(&problem, &candidate), Some(0));
    assert_eq!(linkwright::internals::judge::family::family(&problem, &candidate), None);
    let record = run_on(1, literature("k18", &[("solve.candidates", "1")]));
    assert_eq!(record.family, None);
}

#[test]
fn answers_of_one_curve_are_one_answer() {
    let problem = problem("p12", &[("solve.candidates", "1")]);
    let best = distinct(&problem, found(&problem), 1).remove(0);
    let mut all = vec![best.clone()];
    all.extend(cognates(&problem, &best));
    assert_eq!(all.len(), 3, "two cognates that meet the points");
    // Nearly the same linkage: one part in a thousand longer in its crank.
    let mut parts = best.linkage.four_bar().expect("a four-bar").natural_coordinates();
    parts.crank *= 1.001;
    let near = FourBar::new(parts).expect("it is one");
    all.extend(assess(&problem, near, &best.crank_deg, &best.t1_at));
    assert_eq!(all.len(), 4);
    assert_eq!(count_distinct(&problem, &all, 5), 1);
    let (ranked, others) = divided(&problem, all, 5);
    assert_eq!((ranked.len(), others.len()), (1, 3));
    assert_eq!(ranked[0].rank, 1);
}

#[test]
fn the_order_in_which_answers_are_found_decides_nothing() {
    let problem = problem("v6", &[("solve.candidates", "5")]);
    let all = found(&problem);
    let mut turned = all.clone();
    turned.reverse();
    for wanted in [1, 3, 5] {
        let pick = |list: &[Candidate]| -> Vec<FourBar> {
            chosen(&problem, list, wanted)
                .into_iter()
                .map(|i| *list[i].linkage.four_bar().expect("a four-bar"))
                .collect()
        };
        assert_eq!(pick(&all), pick(&turned));
    }
}

/// Of prescribed timing the cognate at B, whose crank turns in step with the candidate's, keeps the angles: with
/// free offset and from the ground line, not from the x axis.
#[test]
fn the_cognate_in_step_with_the_crank_keeps_the_timing() {
    for (name, kept) in [("k18", 1), ("a6", 1), ("e5", 0)] {
        let problem = problem(name, &[("solve.candidates", "1")]);
        let best = distinct(&problem, found(&problem), 1).remove(0);
        let forms = cognates(&problem, &best);
        assert_eq!(forms.len(), kept, "{name}");
        for form in &forms {
            assert!((form.error.sum_sq / best.error.sum_sq - 1.0).abs() < 1e-9, "{name}");
            // One constant phase at every point, and the transmission angle of the candidate.
            let phase = form.crank_deg[0] - best.crank_deg[0];
            let z = best.linkage.four_bar().expect("a four-bar").coupler_ratio();
            let off = (phase.to_radians() - (1.0 - z).arg()).rem_euclid(std::f64::consts::TAU);
            assert!(off.min(std::f64::consts::TAU - off) < 1e-9, "{name}: {off}");
            for (theirs, own) in form.crank_deg.iter().zip(&best.crank_deg) {
                assert!((theirs - own - phase).abs() < 1e-9, "{name}");
            }
            assert!((form.transmission_deg.worst - best.transmission_deg.worst).abs() < 1e-6, "{name}");
            // From their ground lines the two cranks have the same angle.
            let from_ground = |c: &Candidate| c.crank_deg[0].to_radians() - c.linkage.ground_angle();
            let off = (from_ground(form) - from_ground(&best)).rem_euclid(std::f64::consts::TAU);
            assert!(off.min(std::f64::consts::TAU - off) < 1e-9, "{name}: {off}");
        }
    }
}

#[test]
fn the_better_cognate_takes_the_candidates_place() {
    let problem = problem("p12", &[("solve.candidates", "1")]);
    let best = distinct(&problem, found(&problem), 1).remove(0);
    let forms = cognates(&problem, &best);
    let flag = AtomicBool::new(false);
    let endless = Budget { cancel: &flag, deadline: None };
    for start in forms.iter().chain([&best]) {
        let mut list = vec![start.clone()];
        offered_cognates::offer(Context::new(&problem, &endless), &mut list);
        let first = &list[0];
        assert!(first.accepted);
        assert_eq!(first.alternatives.len(), 2);
        for other in first.alternatives.iter().filter(|a| a.accepted) {
            assert!(other.transmission_worst_deg <= first.transmission_deg.worst + 1e-4);
        }
        for other in &first.alternatives {
            assert_eq!(other.accepted, other.not_met.is_empty());
        }
        // Whichever of the three was found, the same one is given.
        let mut from_best = vec![best.clone()];
        offered_cognates::offer(Context::new(&problem, &endless), &mut from_best);
        assert!((first.linkage.crank() - from_best[0].linkage.crank()).abs() < 1e-9);
        assert!((first.linkage.crank_pivot() - from_best[0].linkage.crank_pivot()).norm() < 1e-9);
    }
}

#[test]
fn alternatives_warnings_and_families_that_are_not_so_are_found_out() {
    let record = run_on(1, literature("p12", &[("solve.candidates", "3")]));
    is_true(&record);
    let lies: [fn(&mut Record); 7] = [
        |r| r.candidates[0].alternatives[0].sum_sq *= 1.001,
        |r| r.candidates[0].alternatives[0].transmission_worst_deg += 1.0,
        |r| r.candidates[0].alternatives[0].accepted ^= true,
        |r| r.candidates[0].alternatives[1].not_met.clear(),
        |r| r.candidates[0].alternatives[0].crank_deg[3] += 1.0,
        |r| {
            r.candidates[0].warnings.push(Warning {
                kind: WarningKind::LinkRatio,
                text: "so it is".into(),
                key: "link_ratio".into(),
                value: 30.0,
                limit: 20.0,
            });
        },
        |r| r.buildable = r.candidates.first().cloned(),
    ];
    for (i, lie) in lies.into_iter().enumerate() {
        let mut false_record = record.clone();
        lie(&mut false_record);
        assert_ne!(verify(&false_record).expect("the problem is one"), Vec::new(), "lie {i}");
    }
    let v6 = run_on(1, literature("v6", &[("solve.candidates", "1")]));
    let mut wrong = v6.clone();
    wrong.family.as_mut().expect("it has one").dimension = 4;
    assert_ne!(verify(&wrong).expect("the problem is one"), Vec::new());
    let mut silent = v6;
    silent.family = None;
    assert_ne!(verify(&silent).expect("the problem is one"), Vec::new());
}

#[test]
fn a_record_without_the_new_keys_is_read_and_says_nothing_of_them() {
    let record = run_on(1, literature("e5", &[("solve.candidates", "1")]));
    assert!(record.candidates[0].warnings.is_empty() && record.candidates[0].alternatives.is_empty());
    let text = bytes(&record);
    for key in ["\"family\"", "\"buildable\"", "\"warnings\"", "\"alternatives\""] {
        assert!(!text.contains(key), "{key}");
    }
    let read: Record = serde_json::from_str(&text).expect("it is a record");
    assert_eq!(read, record);
    // And one with them comes back the same.
    let record = run_on(1, literature("a6", &[("solve.candidates", "2")]));
    let read: Record = serde_json::from_str(&bytes(&record)).expect("it is a record");
    assert_eq!(read, record);
    is_true(&read);
}

#[test]
fn a_limit_that_decides_the_answer_is_named() {
    let record = run_on(1, literature("a6", &[("solve.candidates", "1")]));
    let keys: Vec<&str> = record.candidates[0].warnings.iter().map(|w| w.key.as_str()).collect();
    assert_eq!(keys, ["design.a", "design.ground"]);
    for warning in &record.candidates[0].warnings {
        assert_eq!(warning.kind, WarningKind::OnBound);
        assert!((warning.value - warning.limit).abs() < 1e-4);
    }
    // The side of a box is named.
    let file = crate::common::load(&crate::common::root().join("problems/examples/pivot-box.toml"), &[]);
    let record = run_on(1, file);
    let first = &record.candidates[0].warnings[0];
    assert_eq!(first.key, "pivots_in");
    assert!(first.text.starts_with("pivots_in y"), "{}", first.text);
    // A fixed value is no bound.
    let a = literature("a6", &[("design.a", "5"), ("solve.candidates", "1")]);
    let keys: Vec<String> = run_on(1, a).candidates[0].warnings.iter().map(|w| w.key.clone()).collect();
    assert!(!keys.contains(&"design.a".to_string()), "{keys:?}");
}

/// K18F: a linkage near the best known one, almost a change point. What is offered beside it turns well.
#[test]
fn what_is_offered_beside_a_linkage_that_jams_does_not_jam() {
    let problem = problem("k18f", &[]);
    // A long follower and nearly aligned links, from the best answers of a search without the ratio's limit.
    let all = found(&problem);
    let jams = all
        .iter()
        .filter(|c| c.accepted)
        .find(|c| warnings(&problem, c).iter().any(is_serious))
        .expect("many answers of K18F lie on the Grashof boundary");
    let first = Candidate { rank: 1, warnings: warnings(&problem, jams), ..jams.clone() };
    let flag = AtomicBool::new(false);
    let budget = Budget { cancel: &flag, deadline: None };
    let outcome = buildable(Context::new(&problem, &budget), std::slice::from_ref(&first), &[], 20_000);
    assert!(outcome.evaluations.objective > 0 && outcome.evaluations.objective <= 20_000);
    let built = outcome.candidate.expect("there is one");
    assert!(built.accepted && built.rank == 0);
    assert!(built.transmission_deg.worst >= 10.0 && built.link_ratio <= 20.0);
    assert!(!built.warnings.iter().any(is_serious));
    // Near the best known one that can be built, 0.0030708, with a tenth of a search's budget.
    assert!(built.error.sum_sq < 0.00310, "{}", built.error.sum_sq);
    // Where all that was found is at hand it is never worse than the best of these.
    let known = buildable(Context::new(&problem, &budget), std::slice::from_ref(&first), &all, 0);
    assert_eq!(known.evaluations.objective, 0);
    let free = |c: &&Candidate| c.accepted && !warnings(&problem, c).iter().any(is_serious);
    let least = all.iter().filter(free).map(|c| c.error.objective).fold(f64::INFINITY, f64::min);
    assert!(known.candidate.expect("one was found").error.objective <= least);
}

#[test]
fn without_warnings_nothing_is_searched() {
    let problem = problem("k18", &[("solve.candidates", "1")]);
    let best = distinct(&problem, found(&problem), 1);
    let flag = AtomicBool::new(false);
    let budget = Budget { cancel: &flag, deadline: None };
    let outcome = buildable(Context::new(&problem, &budget), &best, &[], 100_000);
    assert!(outcome.candidate.is_none());
    assert_eq!(outcome.evaluations.objective, 0);
}

/// A6 with lengths from zero: the best number is a change point. The buildable answer is as good as the one
/// that is known with every length at least 5.
#[test]
fn the_record_offers_what_can_be_built_beside_a_change_point() {
    let file = || literature("a6b", &[("solve.candidates", "2")]);
    let record = run_on(1, file());
    is_true(&record);
    let first = &record.candidates[0];
    assert_eq!(first.linkage_type.expect("a type"), LinkageType::ChangePoint);
    let kinds: Vec<WarningKind> = first.warnings.iter().map(|w| w.kind).collect();
    assert!(kinds.contains(&WarningKind::TransmissionAngle) && kinds.contains(&WarningKind::ChangePoint));
    let built = record.buildable.as_ref().expect("there is one");
    assert!(built.error.sum_sq >= first.error.sum_sq);
    assert!(built.error.sum_sq <= 2.5803557, "{}", built.error.sum_sq);
    assert_eq!(bytes(&record), bytes(&run_on(2, file())));
    // Its budget of evaluations covers both searches, and other methods do not look for it.
    assert!(record.evaluations.objective <= record.problem.resolved.solve.evaluations);
    let plain = literature("a6b", &[("solve.candidates", "2"), ("solve.method", "least-squares")]);
    assert!(run_on(1, plain).buildable.is_none());
}

/// The same far from the origin, where the search runs around the target's own centre.
#[test]
fn a_far_target_is_offered_the_same_linkage() {
    let by = [3e5, -2e5];
    let mut near = literature("a6b", &[("solve.candidates", "1")]);
    let one = run_on(2, near.clone());
    near.spec = near.spec.shifted(by);
    let far = run_on(2, near);
    is_true(&far);
    let sums = [one, far].map(|r| r.buildable.expect("there is one").error.sum_sq);
    assert!((sums[0] - sums[1]).abs() < 1e-3 * sums[0], "{sums:?}");
}

#[test]
fn the_table_says_what_stands_beside_the_candidates() {
    use linkwright::internals::report::Colour;
    use linkwright::internals::report::svg::candidate_svg;
    use linkwright::internals::report::table::candidates_table;
    let record = run_on(2, literature("a6b", &[("solve.candidates", "1")]));
    let text = candidates_table(&record, Colour::Never);
    for line in ["#1: worst transmission angle", "it will jam", "buildable (beside the table): sum of sq"] {
        assert!(text.contains(line), "{line}\n{text}");
    }
    assert!(candidate_svg(&record, 0).contains("it will jam"));
    let record = run_on(2, literature("v6", &[("solve.candidates", "1")]));
    let text = candidates_table(&record, Colour::Never);
    assert!(text.contains("a 3-parameter family of exact answers: ranked by transmission angle, then size"));
    assert!(text.contains("#1: same curve: 2 cognates"), "{text}");
}
