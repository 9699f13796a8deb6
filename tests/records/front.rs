//! A record of a front: `verify` agrees with it, and finds out what is changed in the front and in the picks.

use crate::common::literature;
use linkwright::internals::app::job::run::{Context, Job, run};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::record::{Axis, Front, Picks, Record};
use linkwright::internals::synthesis::front::FrontRequest;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

/// A record of eighteen points with a front of few evaluations.
pub fn with_front(set: &[(&str, &str)]) -> Record {
    let set = [&[("solve.evaluations", "4000"), ("solve.candidates", "2")], set].concat();
    let request = FrontRequest { points: 8, ..FrontRequest::default() };
    let job = Job { front: Some(request), ..Job::from(literature("k18", &set)) };
    let context = Context { cancel: &AtomicBool::new(false), observer: &|_| {} };
    run(&job, &context).expect("it runs").record
}

fn whole() -> &'static Record {
    static RECORD: OnceLock<Record> = OnceLock::new();
    RECORD.get_or_init(|| with_front(&[]))
}

/// The mismatches of a record after a change.
fn found(change: impl FnOnce(&mut Record)) -> Vec<String> {
    let mut record = whole().clone();
    change(&mut record);
    verify(&record).expect("the problem is one").iter().map(ToString::to_string).collect()
}

fn is_named(found: &[String], words: &str) -> bool {
    found.iter().any(|mismatch| mismatch.contains(words))
}

#[test]
fn a_front_as_it_was_found_is_true() {
    assert_eq!(found(|_| {}), Vec::<String>::new());
    let front = whole().front.as_ref().expect("a front");
    assert!(front.members.len() > 4 && front.members.iter().any(|member| member.knee), "{front:?}");
    let picks = whole().picks.as_ref().expect("picks");
    assert!(picks.smallest.is_some() && picks.best_transmission.is_some() && picks.within.is_some());
}

#[test]
fn a_changed_front_is_found_out() {
    type Change = fn(&mut Front);
    let changes: [(&str, Change); 19] = [
        ("front.members 1: figures.rms", |front| front.members[0].figures.rms *= 0.9),
        ("front.members 2: figures.max", |front| front.members[1].figures.max *= 1.01),
        ("front.members 3: figures.transmission_deg", |front| {
            front.members[2].figures.transmission_deg += 1.0
        }),
        ("front.members 2: figures.extent", |front| front.members[1].figures.extent *= 0.99),
        ("front.members 2: figures.longest", |front| front.members[1].figures.longest *= 0.99),
        ("front.members 2: figures.link_ratio", |front| front.members[1].figures.link_ratio *= 1.01),
        ("front.members 2: figures.sensitivity", |front| front.members[1].figures.sensitivity *= 0.99),
        ("front.members 1: accepted", |front| front.members[0].candidate.accepted = false),
        ("front.members 1: rank", |front| front.members[0].candidate.rank = 1),
        ("front.members 1: error.sum_sq", |front| {
            front.members[0].candidate.linkage = front.members[1].candidate.linkage;
        }),
        ("front.members 1: the number of crank_deg", |front| {
            front.members[0].candidate.crank_deg.pop();
        }),
        ("knee", |front| front.members.iter_mut().for_each(|member| member.knee = !member.knee)),
        ("front.axes", |front| front.axes.truncate(1)),
        ("each axis once", |front| front.axes = vec![Axis::Rms, Axis::Rms]),
        ("rms or max among them", |front| front.axes = vec![Axis::Transmission, Axis::Extent]),
        ("front.points", |front| front.points = 0),
        ("dominated by", |front| front.axes = vec![Axis::Rms, Axis::Max]),
        ("the order of the members", |front| front.members.reverse()),
        ("front.evaluations", |front| front.evaluations = u64::MAX),
    ];
    for (words, change) in changes {
        let found = found(|record| change(record.front.as_mut().expect("a front")));
        assert!(is_named(&found, words), "{words}: {found:?}");
    }
    let twice = found(|record| {
        let front = record.front.as_mut().expect("a front");
        front.points += 1;
        front.members.insert(1, front.members[0].clone());
    });
    assert!(is_named(&twice, "equal to 1"), "{twice:?}");
    let without = found(|record| {
        record.front.as_mut().expect("a front").members.remove(0);
    });
    assert!(is_named(&without, "without candidate 1, whose rms is smaller"), "{without:?}");
    let many = found(|record| record.front.as_mut().expect("a front").points = 2);
    assert!(is_named(&many, "at most the 2 that were asked for"), "{many:?}");
}

#[test]
fn changed_picks_are_found_out() {
    type Change = fn(&mut Picks);
    let changes: [(&str, Change); 7] = [
        ("picks.within", |picks| picks.within = picks.within.map(|within| 1.01 * within)),
        ("picks.within", |picks| picks.within = None),
        ("picks.smallest: extent", |picks| picks.smallest = picks.best_transmission.clone()),
        ("picks.best_transmission: transmission_deg.worst", |picks| {
            picks.best_transmission = picks.smallest.clone();
        }),
        ("picks.smallest: accepted", |picks| picks.smallest.as_mut().expect("one").accepted = false),
        ("picks.smallest: rank", |picks| picks.smallest.as_mut().expect("one").rank = 2),
        ("picks.best_transmission: link_ratio", |picks| {
            picks.best_transmission.as_mut().expect("one").link_ratio += 0.1;
        }),
    ];
    for (words, change) in changes {
        let found = found(|record| change(record.picks.as_mut().expect("picks")));
        assert!(is_named(&found, words), "{words}: {found:?}");
    }
    let far = found(|record| {
        let member = record.front.as_ref().and_then(|front| front.members.last()).expect("a member").clone();
        record.picks.as_mut().expect("picks").smallest = Some(member.candidate);
    });
    assert!(is_named(&far, "more than is allowed"), "{far:?}");
    let uncalled = found(|record| record.candidates[0].accepted = false);
    assert!(is_named(&uncalled, "no candidate is accepted"), "{uncalled:?}");
}
