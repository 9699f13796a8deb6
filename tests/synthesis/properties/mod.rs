//! What is called accepted is acceptable: random targets under random requirements, each record verified and
//! each accepted candidate checked again by code that shares nothing with the judge.

mod plain;
mod problems;

use crate::common::{bytes, run_on};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::LinkageType;
use linkwright::internals::record::Candidate;
use linkwright::internals::task::region::Region;
use linkwright::internals::task::spec::{
    DirectionPolicy, Limits, OnePolicy, OrderPolicy, ProblemSpec, TransmissionOver,
};
use problems::case;

const SEED: u64 = 20_261_121;
/// `.ci/run` tries 150, where it has the time.
const CASES: u64 = 10;
/// Cases that are tried at most until each fault has been looked for often enough.
const MOST_CASES: u64 = 100;

/// A range of cases from the environment, to look at one alone: `PROPERTY_CASES=17..18`.
fn cases() -> std::ops::Range<u64> {
    let Ok(asked) = std::env::var("PROPERTY_CASES") else { return 0..CASES };
    let (from, to) = asked.split_once("..").expect("FROM..TO");
    from.parse().expect("a number")..to.parse().expect("a number")
}

#[test]
fn whatever_is_called_accepted_is_acceptable() {
    let (mut problems, mut accepted, mut wrong) = (0, 0, Vec::new());
    for index in cases() {
        let Some(case) = case(SEED, index) else { continue };
        problems += 1;
        let text = case.text.clone();
        let spec = case.file.spec.clone();
        let record = run_on(1, case.file);
        let mut complaints: Vec<String> =
            verify(&record).expect("the problem is one").iter().map(ToString::to_string).collect();
        if record.candidates.iter().any(|c| c.accepted) {
            accepted += 1;
        }
        for candidate in record.candidates.iter().filter(|c| c.accepted) {
            let found = plain::complaints(&spec, candidate);
            complaints
                .extend(found.into_iter().map(|c| format!("accepted candidate {}: {c}", candidate.rank)));
        }
        if !complaints.is_empty() {
            let beside = [("weight", &spec.task.weight), ("tolerance", &spec.task.tolerance)];
            complaints.truncate(5);
            wrong.push(format!("case {index}: {}\n{text}{beside:?}", complaints.join("\n")));
        }
    }
    assert!(wrong.is_empty(), "seed {SEED}, {} of {problems}:\n{}", wrong.len(), wrong.join("\n\n"));
    if cases() == (0..CASES) {
        // A test of accepted candidates needs some.
        assert!(problems * 10 >= CASES * 8, "{problems} problems of {CASES} draws");
        assert!(accepted * 4 >= problems, "{accepted} of {problems} problems have an accepted answer");
    }
}

#[test]
fn one_and_two_threads_give_equal_bytes() {
    let twice = |index| Some((case(SEED, index)?, case(SEED, index)?));
    let mut seen = 0;
    for (one, two) in (0..).step_by(7).filter_map(twice).take(10) {
        seen += 1;
        assert_eq!(
            bytes(&run_on(1, one.file)),
            bytes(&run_on(2, two.file)),
            "case {}:\n{}",
            one.index,
            one.text
        );
    }
    assert_eq!(seen, 10);
}

/// An accepted candidate of each problem, made wrong in one way: the plain checks must see it.
#[test]
#[ignore = "slow: .ci/run runs it"]
fn the_plain_checks_see_what_is_wrong() {
    type Spoil = fn(&mut ProblemSpec, &mut Candidate) -> bool;
    let spoils: [(&str, Spoil); 14] = [
        ("another sum", |_, c| {
            c.error.sum_sq = 1.001 * c.error.sum_sq + 1e-6 * c.linkage.crank().powi(2);
            true
        }),
        ("the other assembly at a point", |spec, c| {
            let margin =
                c.linkage.four_bar().expect("a four-bar").transmission_over_cycle().worst().to_degrees();
            let last = c.t1_at.len() - 1;
            let mut t1_at = c.t1_at.to_vec();
            t1_at[last] = t1_at[last].opposite();
            c.t1_at = t1_at.into();
            spec.require.branch == OnePolicy::One && spec.require.circuit == OnePolicy::One && margin > 5.0
        }),
        ("two points in each other's place", |spec, c| {
            c.crank_deg.swap(1, 2);
            spec.task.timing.is_none()
                && spec.require.order == OrderPolicy::Required
                && spec.require.circuit == OnePolicy::One
                && c.crank_deg.len() > 6
                && (c.crank_deg[1] - c.crank_deg[2]).abs() > 2.0
        }),
        ("a crank angle that was not asked for", |spec, c| {
            c.crank_deg[1] += 0.001;
            spec.task.timing.is_some()
        }),
        ("a tight ratio", |spec, c| {
            spec.require.link_ratio_max = 0.99 * c.link_ratio;
            true
        }),
        ("another type", |spec, c| {
            spec.require.types = vec![one_more(c.linkage_type.expect("a type"))];
            c.grashof_margin.abs() > 0.01 * c.linkage.longest_link()
        }),
        ("a pivot outside its box", |spec, c| {
            let a = c.linkage.crank_pivot();
            spec.require.pivots_in = Some(Region::Box([a.re + beyond(a.re), -1e12, 1e12, 1e12]));
            true
        }),
        ("a joint outside the footprint", |spec, c| {
            let p = c
                .linkage
                .four_bar()
                .expect("a four-bar")
                .position_with(c.crank_deg[0].to_radians(), c.t1_at[0])
                .joints();
            let x = p.map_or(0.0, |p| p.coupler_point.re);
            spec.require.footprint_in = Some([x + beyond(x), -1e12, 1e12, 1e12]);
            true
        }),
        ("a link that is too long", |spec, c| {
            let l = c.linkage.four_bar().expect("a four-bar");
            spec.require.longest_max =
                Some(0.99 * l.longest_link().max(l.crank_side()).max(l.follower_side()));
            true
        }),
        ("too large an extent", |spec, c| {
            let joints = c
                .linkage
                .four_bar()
                .expect("a four-bar")
                .position_with(c.crank_deg[0].to_radians(), c.t1_at[0])
                .joints();
            let reach = joints.map_or(0.0, |j| (j.coupler_point - c.linkage.crank_pivot()).norm());
            spec.require.extent_max = Some(0.99 * reach);
            // The box is measured along a motion on one branch.
            spec.require.branch == OnePolicy::One && spec.require.circuit == OnePolicy::One
        }),
        ("a flat transmission angle", |spec, c| {
            spec.require.transmission_deg_min = Some(c.transmission_deg.worst + 5.0);
            spec.require.transmission_over = Some(c.transmission_deg.over);
            let one = spec.require.branch == OnePolicy::One && spec.require.circuit == OnePolicy::One;
            c.transmission_deg.over == TransmissionOver::Cycle
                || (one && c.grashof_margin.abs() > 0.01 * c.linkage.longest_link())
                    && spec.require.order == OrderPolicy::Required
        }),
        ("a length outside its bounds", |spec, c| {
            spec.design.b = Some(Limits(
                0.0,
                c.linkage.four_bar().expect("a four-bar").coupler()
                    - beyond(c.linkage.four_bar().expect("a four-bar").coupler()),
            ));
            true
        }),
        ("a tolerance exceeded", |spec, c| {
            spec.task.tolerance = Some(vec![0.99 * c.error.max - 1e-6; c.crank_deg.len()]);
            c.error.max > 1e-4
        }),
        ("the wrong direction", |spec, c| {
            let [first, .., last] = c.crank_deg[..] else { return false };
            let rises = last >= first;
            spec.require.direction = if rises { DirectionPolicy::Cw } else { DirectionPolicy::Ccw };
            let plain = c.linkage_type.expect("a type").input_turns_fully() && (last - first).abs() > 1.0;
            let whole = spec.task.points.first() == spec.task.points.last();
            let one = spec.require.branch == OnePolicy::One && spec.require.circuit == OnePolicy::One;
            plain
                && one
                && !whole
                && spec.task.timing.is_none()
                && spec.require.order == OrderPolicy::Required
                && c.grashof_margin.abs() > 0.01 * c.linkage.longest_link()
        }),
    ];
    const TRIES: usize = 5;
    let mut seen = [0; 14];
    for case in (0..2 * MOST_CASES).filter_map(|index| case(SEED, index)) {
        if seen == [TRIES; 14] {
            break;
        }
        let spec = case.file.spec.clone();
        let record = run_on(1, case.file);
        let Some(candidate) = record.candidates.first().filter(|c| c.accepted) else { continue };
        for ((name, spoil), seen) in spoils.iter().zip(&mut seen) {
            let (mut spec, mut candidate) = (spec.clone(), candidate.clone());
            if *seen < TRIES && spoil(&mut spec, &mut candidate) {
                *seen += 1;
                let found = plain::complaints(&spec, &candidate);
                assert!(!found.is_empty(), "case {}: {name} is not seen:\n{}", case.index, case.text);
            }
        }
    }
    for ((name, _), seen) in spoils.iter().zip(seen) {
        assert!(seen == TRIES, "{name}: tried {seen} times");
    }
}

/// A type that is not this one.
fn one_more(kind: LinkageType) -> LinkageType {
    if kind == LinkageType::CrankRocker { LinkageType::DoubleCrank } else { LinkageType::CrankRocker }
}

/// Clearly more than a limit of this size may be exceeded by.
fn beyond(limit: f64) -> f64 {
    1e-5 * (1.0 + limit.abs())
}
