//! Lengths snapped to a stock: exact, judged under the problem as it was, and no worse than trying everything.

use crate::common::{bytes, literature, run_on};
use linkwright::internals::judge::rank::compare;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::multi_loop::LinkPair;
use linkwright::internals::mechanism::{
    AssemblyMode, Complex, CrankLinkage, DyadChainKind, FourBar, InvertedSliderCrank, LinkageKind, MultiLoop,
    SliderCrank,
};
use linkwright::internals::record::{Candidate, Reason, Record, Termination};
use linkwright::internals::synthesis::snap::{
    Fixed, JointName, Length, Request, SnapError, Snapped, Stock, own_curve, record, refit, snap,
};
use linkwright::internals::synthesis::{Budget, Context};
use linkwright::internals::task::Problem;
use linkwright::internals::task::spec::ProblemSpec;
use std::sync::OnceLock;
use std::sync::atomic::AtomicBool;

static NEVER: AtomicBool = AtomicBool::new(false);

fn budget() -> Budget<'static> {
    Budget::new(&NEVER, None)
}

/// A run of a problem with a prescribed timing and fixed pivots on the x axis, and one of free timing.
fn timed() -> &'static Record {
    static RECORD: OnceLock<Record> = OnceLock::new();
    RECORD.get_or_init(|| run_on(2, literature("e5", &[("solve.evaluations", "20000")])))
}

fn free() -> &'static Record {
    static RECORD: OnceLock<Record> = OnceLock::new();
    RECORD.get_or_init(|| run_on(2, literature("e5-free", &[("solve.evaluations", "20000")])))
}

fn spec(record: &Record) -> ProblemSpec {
    record.problem.resolved.clone()
}

fn request(step: f64, lengths: &[Length]) -> Request {
    let stock = Stock::grid(step).expect("a step");
    Request { stock, lengths: lengths.to_vec(), fixed: Fixed::default(), wanted: 4 }
}

fn snapped(record: &Record, request: &Request) -> (Problem, Candidate, Snapped) {
    let problem = Problem::new(spec(record)).expect("a problem");
    let candidate = record.candidates[0].clone();
    let found = snap(Context::new(&problem, &budget()), &candidate, request).expect("an answer");
    (problem, candidate, found)
}

/// Checks that every length that was snapped is a multiple of a step in all answers, up to a part of itself.
fn on_stock(found: &Snapped, step: f64, within: f64) {
    for candidate in &found.candidates {
        for length in &found.lengths {
            let value = length.of(candidate.linkage).expect("the linkage has it");
            let count = (value / step).round();
            assert!((value - step * count).abs() <= within * value, "{} {value}", length.key());
            assert!(count >= 1.0);
        }
    }
}

#[test]
fn snapped_lengths_are_stock_to_the_digit_and_the_record_is_true() {
    for (from, step) in [(timed(), 0.05), (free(), 0.1)] {
        let request = request(step, &Length::OF_ONE_LOOP);
        let (problem, before, found) = snapped(from, &request);
        assert!(before.accepted && found.candidates[0].accepted);
        on_stock(&found, step, 8.0 * f64::EPSILON);
        assert_eq!(found.lengths.len(), 6);
        let told = record(&problem, "snapped", None, None, &request, &found).expect("a record");
        // No search ended: the record must not say that one ran out of ideas.
        assert_eq!(told.termination, Termination { reason: Reason::Snapped, reproducible: true });
        assert_eq!(verify(&told).expect("a problem"), []);
        // What was done to the lengths one after another is never worse than all of them at once.
        let nearest = found.nearest.as_ref().expect("it closes");
        assert!(compare(&problem, &found.candidates[0], nearest).is_le());
        assert!(found.candidates[0].error.rms < 0.7 * nearest.error.rms, "{}", nearest.error.rms);
        assert!(found.candidates.windows(2).all(|pair| compare(&problem, &pair[0], &pair[1]).is_le()));
    }
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn no_combination_of_three_lengths_around_it_is_better_than_what_is_found() {
    for (from, step) in [(timed(), 0.2), (free(), 0.25)] {
        for lengths in [[Length::A, Length::B, Length::C], [Length::Ground, Length::A, Length::D]] {
            let request = request(step, &lengths);
            let (problem, before, found) = snapped(from, &request);
            let best = &found.candidates[0];
            let near = |length: Length| -> Vec<f64> {
                let middle = (length.of(before.linkage).expect("a four-bar has it") / step).round();
                (-3..=3).map(|k| (middle + f64::from(k)) * step).filter(|v| *v > 0.5 * step).collect()
            };
            let mut tried = 0;
            for one in near(lengths[0]) {
                for two in near(lengths[1]) {
                    for three in near(lengths[2]) {
                        let fixed = Fixed::default()
                            .with(lengths[0], one)
                            .with(lengths[1], two)
                            .with(lengths[2], three);
                        let Some(other) = refit(Context::new(&problem, &budget()), &before, &fixed, 400).0
                        else {
                            continue;
                        };
                        tried += 1;
                        let better = other.accepted && other.error.rms < best.error.rms * (1.0 - 1e-3);
                        assert!(
                            !better,
                            "{lengths:?}: {} of {fixed:?} for {}",
                            other.error.rms, best.error.rms
                        );
                    }
                }
            }
            assert!(tried > 100, "{tried}");
        }
    }
}

#[test]
fn the_same_lengths_come_out_whatever_the_threads() {
    let request = request(0.1, &Length::OF_ONE_LOOP);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let (problem, _, found) = pool.install(|| snapped(timed(), &request));
        bytes(&record(&problem, "snapped", None, None, &request, &found).expect("a record"))
    };
    assert_eq!(on(1), on(3));
}

fn crank_rocker() -> FourBar {
    FourBar::with_coupler_offset(
        [Complex::new(3.0, -2.0), Complex::new(83.0, -2.0)],
        [20.0, 70.0, 50.0],
        Complex::new(35.0, 30.0),
        AssemblyMode::Plus,
    )
    .expect("a linkage")
}

#[test]
fn a_linkage_whose_lengths_are_stock_already_keeps_them_and_its_curve() {
    let linkage = crank_rocker();
    let (problem, candidate) = own_curve(&linkage.into()).expect("it closes");
    assert!(candidate.accepted && candidate.error.rms < 1e-12);
    let keys = [Length::Ground, Length::A, Length::B, Length::C];
    let found =
        snap(Context::new(&problem, &budget()), &candidate, &request(10.0, &keys)).expect("an answer");
    for length in keys {
        let [is, was] =
            [found.candidates[0].linkage, linkage.into()].map(|linkage: CrankLinkage| length.of(linkage));
        assert!((is.expect("it has it") - was.expect("it has it")).abs() < 1e-12);
    }
    assert!(found.candidates[0].error.rms < 1e-9 * problem.task().size());
}

#[test]
fn what_is_kept_or_set_stays_and_what_cannot_be_snapped_is_told() {
    let linkage = crank_rocker();
    let (problem, candidate) = own_curve(&linkage.into()).expect("it closes");
    let mut wish = request(7.0, &Length::OF_ONE_LOOP);
    wish.fixed = Fixed::default().with(Length::A, 20.0).with(Length::C, 51.5);
    wish.fixed.crank_pivot = Some([3.0, -2.0]);
    wish.fixed.follower_pivot = Some([83.0, -2.0]);
    let found = snap(Context::new(&problem, &budget()), &candidate, &wish).expect("an answer");
    let best = found.candidates[0].linkage.four_bar().expect("a four-bar");
    assert_eq!((best.crank(), best.follower()), (20.0, 51.5));
    assert_eq!(best.natural_coordinates().crank_pivot, [3.0, -2.0]);
    assert_eq!(best.natural_coordinates().follower_pivot, [83.0, -2.0]);
    // The pivots hold the ground: it is not snapped.
    let mut snapped = found.lengths.clone();
    snapped.sort();
    assert_eq!(snapped, [Length::B, Length::D, Length::E]);

    // With B held, the ground is brought to its length by A.
    let mut wish = request(7.0, &[Length::Ground]);
    wish.fixed.follower_pivot = Some([83.0, -2.0]);
    let found = snap(Context::new(&problem, &budget()), &candidate, &wish).expect("an answer");
    let best = found.candidates[0].linkage.four_bar().expect("a four-bar");
    assert_eq!(best.natural_coordinates().follower_pivot, [83.0, -2.0]);
    assert!(
        (best.ground() - 77.0).abs() < 1e-12 || (best.ground() - 84.0).abs() < 1e-12,
        "{}",
        best.ground()
    );

    let mut wish = request(7.0, &[Length::A]);
    wish.fixed = Fixed::default().with(Length::A, 20.0);
    assert_eq!(snap(Context::new(&problem, &budget()), &candidate, &wish), Err(SnapError::NothingToSnap));
    let mut limited = problem.spec().clone();
    limited.design.a = Some(linkwright::internals::task::spec::Limits(18.0, 20.5));
    let limited = Problem::new(limited).expect("a problem");
    let refused = snap(Context::new(&limited, &budget()), &candidate, &request(7.0, &[Length::A]));
    assert!(matches!(refused, Err(SnapError::NoStock { ref key, .. }) if key == "a"), "{refused:?}");
}

/// A slider-crank and an inverted one of odd lengths, in millimetres.
fn sliders() -> [CrankLinkage; 2] {
    let line = (Complex::new(110.3, 16.2), 0.3);
    let (offset, t1) = (Complex::new(61.7, 33.1), AssemblyMode::Plus);
    let slider = SliderCrank::from_parts(Complex::new(10.0, 20.0), [31.3, 97.4], line, offset, t1);
    let pivots = [Complex::new(0.0, 0.0), Complex::new(83.7, 11.2)];
    let inverted = InvertedSliderCrank::from_parts(pivots, 30.6, 9.1, offset, t1);
    [
        CrankLinkage::SliderCrank(slider.expect("a linkage")),
        CrankLinkage::InvertedSliderCrank(inverted.expect("a linkage")),
    ]
}

#[test]
fn lengths_of_linkages_with_a_slider_are_snapped_too() {
    let step = 5.0;
    for linkage in sliders() {
        let (problem, before) = own_curve(&linkage).expect("it closes");
        assert!(before.accepted && before.error.rms < 1e-10);
        let request = request(step, &Length::OF_ONE_LOOP);
        let found = snap(Context::new(&problem, &budget()), &before, &request).expect("an answer");
        let mut snapped = found.lengths.clone();
        snapped.sort();
        let has: Vec<Length> =
            Length::OF_ONE_LOOP.into_iter().filter(|length| length.of(linkage).is_some()).collect();
        assert_eq!(snapped, has);
        assert_eq!(has.len(), if linkage.slider_crank().is_some() { 4 } else { 3 });
        assert!(found.candidates.iter().all(|c| c.linkage.kind() == linkage.kind()));
        on_stock(&found, step, 1e-12);
        // Rounded lengths cost little where the rest is fitted again.
        let best = &found.candidates[0];
        assert!(best.accepted && best.error.rms < 0.01 * problem.task().size(), "{}", best.error.rms);
        let nearest = found.nearest.as_ref().expect("it closes");
        assert!(compare(&problem, best, nearest).is_le());
        let told = record(&problem, "snapped", None, None, &request, &found).expect("a record");
        assert_eq!(verify(&told).expect("a problem"), []);
    }
}

#[test]
fn kept_and_set_dimensions_of_a_slider_stay() {
    let [slider, inverted] = sliders();
    let (problem, before) = own_curve(&slider).expect("it closes");
    let mut wish = request(7.0, &[Length::B]);
    wish.fixed = Fixed::default().with(Length::A, 31.3).with(Length::E, 50.0);
    wish.fixed.crank_pivot = Some([10.0, 20.0]);
    let found = snap(Context::new(&problem, &budget()), &before, &wish).expect("an answer");
    let best = found.candidates[0].linkage;
    assert_eq!(best.crank(), 31.3);
    assert!((best.second_side().expect("e") - 50.0).abs() < 1e-12);
    assert_eq!(best.crank_pivot(), Complex::new(10.0, 20.0));

    let (problem, before) = own_curve(&inverted).expect("it closes");
    let mut wish = request(7.0, &[Length::Ground]);
    wish.fixed.follower_pivot = Some([83.7, 11.2]);
    wish.fixed.ground_angle_deg = Some(inverted.ground_angle().to_degrees());
    let found = snap(Context::new(&problem, &budget()), &before, &wish).expect("an answer");
    let best = found.candidates[0].linkage;
    let ground = best.ground().expect("a ground link");
    assert!((ground - 84.0).abs() < 1e-12, "{ground}");
    assert_eq!(best.second_pivot(), Some(Complex::new(83.7, 11.2)));
    assert!((best.ground_angle() - inverted.ground_angle()).abs() < 1e-9);
    // It has neither a coupler of a length nor a follower.
    let refused = snap(Context::new(&problem, &budget()), &before, &request(7.0, &[Length::B, Length::C]));
    assert_eq!(refused, Err(SnapError::NothingToSnap));
}

/// A Watt six-bar whose P lies off the line of its link, and an eight-bar, of odd lengths, in millimetres.
fn several_loops() -> [CrankLinkage; 2] {
    let (plus, minus) = (AssemblyMode::Plus, AssemblyMode::Minus);
    let pair = |ends: [Complex; 2], lengths: [f64; 2], side| LinkPair { ends, lengths, side };
    let z = |x: f64, y: f64| Complex::new(x, y);
    let first = pair([z(20.3, 0.0), z(71.2, 3.1)], [61.4, 46.3], minus);
    let second = pair([z(41.2, 29.3), z(76.1, -9.2)], [44.2, 41.3], plus);
    // Coupler and follower carry the second dyad.
    let watt = DyadChainKind::SIX_BARS.into_iter().find(|kind| kind.anchors(1) == [2, 3]).expect("Watt's");
    let six = MultiLoop::new(watt, (z(0.0, 0.0), 20.3), &[first, second], z(57.3, 21.2));
    // The third dyad hangs on the second, and on the ground where P is farthest from anything else.
    let eight = DyadChainKind::eight_bars()
        .into_iter()
        .find(|kind| kind.anchors(1) == [2, 3] && kind.anchors(2) == [4, 0])
        .expect("an eight-bar with a third pivot");
    let third = pair([z(55.3, 18.2), z(40.0, -140.2)], [70.3, 75.1], plus);
    let eight = MultiLoop::new(eight, (z(0.0, 0.0), 20.3), &[first, second, third], z(30.2, 15.3));
    [six, eight].map(|linkage| CrankLinkage::MultiLoop(linkage.expect("a linkage")))
}

/// Checks how lengths of a linkage that draws its target exactly are snapped; returns whether rounding them at once was an
/// answer too.
fn snapped_and_rounded_at_once(linkage: CrankLinkage) -> bool {
    let step = 5.0;
    let (problem, before) = own_curve(&linkage).expect("it closes");
    assert!(before.accepted && before.error.rms < 1e-10, "{:?}", before.requirements);
    // Of the eight-bar the links that the third dyad adds.
    let all = Length::all(&linkage);
    let wanted = match linkage.kind() {
        LinkageKind::SixBar => all.clone(),
        _ => ["X3F3", "Y3F3", "AY3", "a"].map(|key| Length::named(key).expect("a length")).to_vec(),
    };
    assert_eq!(all.len(), if linkage.kind() == LinkageKind::SixBar { 12 } else { 18 });
    let request = request(step, &wanted);
    let found = snap(Context::new(&problem, &budget()), &before, &request).expect("an answer");
    assert_eq!(found.lengths.len(), wanted.len());
    assert!(found.candidates.iter().all(|c| c.linkage.kind() == linkage.kind()));
    on_stock(&found, step, 1e-11);
    let best = &found.candidates[0];
    assert!(best.accepted && best.error.rms < 0.02 * problem.task().size(), "{}", best.error.rms);
    if let Some(nearest) = &found.nearest {
        assert!(compare(&problem, best, nearest).is_le());
    }
    let told = record(&problem, "snapped", None, None, &request, &found).expect("a record");
    assert_eq!(verify(&told).expect("a problem"), []);
    found.nearest.is_some()
}

#[test]
fn lengths_of_a_six_bar_are_snapped_too() {
    let [six_bar, _] = several_loops();
    snapped_and_rounded_at_once(six_bar);
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn lengths_of_an_eight_bar_are_snapped_too_and_some_are_rounded_at_once() {
    let snapped = several_loops().map(snapped_and_rounded_at_once);
    assert!(snapped.contains(&true), "none was rounded at once");
}

#[test]
fn kept_and_set_dimensions_of_an_eight_bar_stay() {
    let [_, linkage] = several_loops();
    let (problem, before) = own_curve(&linkage).expect("it closes");
    let named = |key: &str| Length::named(key).expect("a length");
    let mut wish = request(2.0, &[named("X2F2"), named("AY3"), Length::Ground]);
    wish.fixed = Fixed::default().with(Length::A, 20.3).with(named("X3F3"), 71.0);
    wish.fixed.crank_pivot = Some([0.0, 0.0]);
    wish.fixed.further_pivots = vec![(JointName::named("Y3").expect("a joint"), [40.0, -140.2])];
    let found = snap(Context::new(&problem, &budget()), &before, &wish).expect("an answer");
    // Both of its ends are kept: no stock for it.
    assert!(!found.lengths.contains(&named("AY3")) && found.lengths.len() == 2);
    let best = found.candidates[0].linkage;
    let of = best.multi_loop().expect("an eight-bar");
    assert_eq!((best.crank(), of.dyads()[2].lengths[0]), (20.3, 71.0));
    let pivots = of.named_pivots();
    assert_eq!(pivots[0], ("A", Complex::new(0.0, 0.0)));
    assert_eq!(pivots[2], ("Y3", Complex::new(40.0, -140.2)));
    let ground = best.ground().expect("a ground link");
    assert!((ground - 2.0 * (ground / 2.0).round()).abs() < 1e-12, "{ground}");
    // A length between joints of two bodies is none.
    let refused = snap(Context::new(&problem, &budget()), &before, &request(2.0, &[named("AF2")]));
    assert_eq!(refused, Err(SnapError::NothingToSnap));
}

#[test]
fn a_length_is_named_by_its_key_or_by_its_joints_in_either_order() {
    for (key, is) in [("ground", "ground"), ("AB", "ground"), ("F2X2", "X2F2"), ("PC", "d"), ("BY2", "BY2")] {
        assert_eq!(Length::named(key).map(Length::key).as_deref(), Some(is), "{key}");
    }
    for key in ["", "A", "AA", "X2", "X4F2", "groundAB", "AB "] {
        assert_eq!(Length::named(key), None, "{key}");
    }
}
