//! Targets with free crank angles among timed ones: derivatives, what the search finds, and that the records are true.

use crate::common::parse;
use crate::common::thorough::cases;
use crate::motion::{ALONE, solved};
use linkwright::internals::judge::practicality::sensitivity::Crank;
use linkwright::internals::judge::practicality::sensitivity_of;
use linkwright::internals::judge::verify::verify;
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use linkwright::internals::numbers::optimise::levenberg_marquardt::derivative_error;
use linkwright::internals::synthesis::multistart::{LONG_FIT, judged, polish};
use linkwright::internals::synthesis::nearest::nearest_positions;
use linkwright::internals::synthesis::starts::Starts;
use linkwright::internals::synthesis::{Budget, Context};
use linkwright::internals::task::forms::timed::TimedPathFit;
use linkwright::spec::{ProblemSpec, TimingSpec};
use linkwright::{AngleOffset, FourBar, Problem};
use std::sync::atomic::AtomicBool;

/// A foot 120 mm along the ground in thirteen even steps while the crank turns by `stance_deg`, and back over (60, 40) at any
/// angle.
fn foot(stance_deg: f64, lines: &str) -> ProblemSpec {
    let points: Vec<[f64; 2]> = (0..13).map(|j| [10.0 * f64::from(j), 0.0]).chain([[60.0, 40.0]]).collect();
    let crank: Vec<String> = (0..13).map(|j| format!("{:?}", stance_deg / 12.0 * f64::from(j))).collect();
    parse(&format!(
        "format = 1\nunit = \"mm\"\n[task.path]\npoints = {points:?}\nclosed = true\n[task.path.timing]\n\
         crank_deg = [{}, \"free\"]\n[require]\ntype = [\"crank-rocker\", \"double-crank\"]\ntransmission_deg_min = 30\n{lines}",
        crank.join(", ")
    ))
    .spec
}

/// Returns the least objective of accepted ends of fits from so many random starts, the same for any number of threads.
fn least_of_random_starts(problem: &Problem, starts: u64) -> f64 {
    const THREADS: u64 = 2;
    let part = |thread: u64| {
        let cancel = AtomicBool::new(false);
        let budget = Budget::new(&cancel, None);
        let context = Context::new(problem, &budget);
        let of = Starts::new(problem);
        let mut least = f64::INFINITY;
        for index in (thread..starts).step_by(THREADS as usize) {
            let Some(start) = of.draw(&mut stream(17, index)) else { continue };
            let Some(end) = polish(context, start, LONG_FIT, 5000).end else { continue };
            let candidate = judged(problem, &end).filter(|candidate| candidate.accepted);
            least = least.min(candidate.map_or(f64::INFINITY, |candidate| candidate.error.objective));
        }
        least
    };
    std::thread::scope(|scope| {
        let threads: Vec<_> = (0..THREADS).map(|thread| scope.spawn(move || part(thread))).collect();
        threads.into_iter().map(|thread| thread.join().expect("it ends")).fold(f64::INFINITY, f64::min)
    })
}

/// Compares the answers of seeds 1 to `seeds` for each stance with what random starts of the same fit find.
#[expect(clippy::print_stdout, reason = "the long run reports its figures")]
fn assert_as_good_as_random_starts(starts: u64, seeds: u64) {
    for stance in [90.0, 120.0, 150.0, 180.0] {
        let spec = foot(stance, ALONE);
        let least = least_of_random_starts(&Problem::new(spec.clone()).expect("a problem"), starts);
        let mut found = Vec::new();
        for seed in 1..=seeds {
            let mut spec = spec.clone();
            spec.solve.seed = seed;
            let record = solved(spec);
            assert_eq!(verify(&record).expect("a record"), []);
            let best = &record.candidates[0];
            assert!(best.accepted && best.transmission_deg.worst > 30.0 - 1e-6);
            found.push((best.error.objective / 14.0).sqrt());
            // The crank turns evenly under the stance, and on over the return.
            let turned: Vec<f64> = best.crank_deg.iter().map(|deg| deg - best.crank_deg[0]).collect();
            let way = turned[12].signum();
            for (j, deg) in turned.iter().enumerate().take(13) {
                assert!((deg - way * stance / 12.0 * j as f64).abs() < 1e-9);
            }
            assert!(way * turned[13] > stance && way * turned[13] < 360.0, "{}", turned[13]);
        }
        let least = (least / 14.0).sqrt();
        println!("stance {stance}: rms {least:.6} of {starts} random starts, by seed {found:.6?}");
        assert!(found.iter().all(|rms| *rms <= 1.01 * least), "{stance}: {found:?} {least}");
    }
}

#[test]
fn a_foot_goes_at_constant_speed_as_well_as_many_random_starts_find() {
    assert_as_good_as_random_starts(cases(100, 400), cases(1, 3));
}

/// Some ten minutes with all starts; fewer by `FOOT_STARTS`.
/// `cargo test --test synthesis foot -- --ignored --nocapture`
#[test]
#[ignore = "slow: .ci/run runs it with fewer starts"]
fn a_foot_goes_at_constant_speed_as_well_as_twenty_thousand_random_starts_find() {
    let starts =
        std::env::var("FOOT_STARTS").map_or(20_000, |text| text.parse().expect("a number of starts"));
    assert_as_good_as_random_starts(starts, 10);
}

#[test]
fn derivatives_of_a_partly_timed_path_agree_with_central_differences() {
    let problem = Problem::new(foot(150.0, "")).expect("a problem");
    let starts = Starts::new(&problem);
    let draws = &mut stream(18, 0);
    let mut errors = Vec::new();
    while errors.len() < 30 {
        let Some(start) = starts.draw(draws) else { continue };
        let fit = TimedPathFit::new(&problem, start.setting).expect("it is timed");
        let mut positions = start.positions.clone();
        // Away from the nearest point, so that the own unknown has a gradient.
        positions[13][0] *= linkwright::Complex::from_polar(1.0, uniform(draws, 0.01, 0.05));
        let mut steps = [1e-4; 10];
        steps[9] = 1e-6;
        errors.extend(
            derivative_error(&fit, &start.design, &positions, &steps, 1e-6).map(|error| error / 100.0),
        );
    }
    crate::motion::assert_mostly_small(errors);
}

#[test]
fn guesses_of_free_angles_lie_evenly_between_their_neighbours() {
    let of = |angles: &[Option<f64>]| {
        TimingSpec::partly(angles, AngleOffset::Free).expect("some are given").crank_deg
    };
    assert_eq!(of(&[Some(0.0), None, Some(90.0)]), [0.0, 45.0, 90.0]);
    assert_eq!(of(&[Some(0.0), Some(150.0), None, None]), [0.0, 150.0, 220.0, 290.0]);
    assert_eq!(of(&[None, Some(10.0), Some(190.0)]), [-80.0, 10.0, 190.0]);
    assert_eq!(of(&[Some(0.0), Some(-100.0), None]), [0.0, -100.0, -230.0]);
    assert_eq!(TimingSpec::partly(&[None, None], AngleOffset::Free), None);
}

#[test]
fn a_linkage_by_itself_is_measured_at_the_timed_angles_and_nearest_between_them() {
    let spec = foot(150.0, ALONE);
    let problem = Problem::new(spec.clone()).expect("a problem");
    let best = solved(spec).candidates.remove(0);
    let (crank_deg, _) =
        nearest_positions(&problem, best.linkage.four_bar().expect("a four-bar")).expect("it closes");
    for (has, found) in best.crank_deg.iter().zip(&crank_deg) {
        assert!((has - found).abs() < 1e-3, "{has} {found}");
    }
}

#[test]
fn a_wrong_dimension_shifts_the_path_as_its_derivative_says() {
    // Of a linkage whose coupler point is not near the line C-D, so that d and e are among the dimensions.
    let spec = foot(90.0, ALONE);
    let problem = Problem::new(spec.clone()).expect("a problem");
    let best = solved(spec).candidates.remove(0);
    let felt = sensitivity_of(&problem, &best).expect("it has derivatives");
    assert_eq!((felt.crank, felt.settled), (Crank::OffsetIsSet, 1));
    let step = 1e-5;
    for (letter, dimension) in
        ["Ax", "Ay", "Bx", "By", "a", "b", "c", "d", "e"].into_iter().zip(felt.dimensions)
    {
        assert_eq!(dimension.name, letter);
        let mut parameters = best.linkage.four_bar().expect("a four-bar").natural_coordinates();
        match letter {
            "Ax" => parameters.crank_pivot[0] += step,
            "Ay" => parameters.crank_pivot[1] += step,
            "Bx" => parameters.follower_pivot[0] += step,
            "By" => parameters.follower_pivot[1] += step,
            "a" => parameters.crank += step,
            "b" => parameters.coupler += step,
            "c" => parameters.follower += step,
            "d" => parameters.crank_side += step,
            _ => parameters.follower_side += step,
        }
        let other = FourBar::new(parameters).expect("a linkage");
        let place = |linkage: &FourBar, j: usize, turn: f64| {
            let linkage = linkage.with_assembly(best.t1_at[j]);
            linkage.position(best.crank_deg[j].to_radians() + turn).joints().expect("it closes").coupler_point
        };
        // The shift at a target, and the way of the coupler point there, by radian.
        let of = |j: usize| {
            let here = place(best.linkage.four_bar().expect("a four-bar"), j, 0.0);
            (
                (place(&other, j, 0.0) - here) / step,
                (place(best.linkage.four_bar().expect("a four-bar"), j, step) - here) / step,
            )
        };
        let (shifts, ways): (Vec<_>, Vec<_>) = (0..14).map(of).unzip();
        let along = |j: usize| (ways[j].conj() * shifts[j]).re;
        // One offset of the crank for the thirteen timed targets; the last one has its own.
        let offset =
            (0..13).map(along).sum::<f64>() / ways[..13].iter().map(|way| way.norm_sqr()).sum::<f64>();
        let left = |j: usize| {
            let offset = if j == 13 { along(j) / ways[j].norm_sqr() } else { offset };
            (shifts[j] - ways[j] * offset).norm_sqr()
        };
        let rms = ((0..14).map(left).sum::<f64>() / 14.0).sqrt();
        assert!((dimension.rms - rms).abs() < 1e-3 * (1.0 + rms), "{letter}: {} {rms}", dimension.rms);
    }
}

#[test]
fn a_point_may_dwell() {
    let text = format!(
        "format = 1\n[task.path]\npoints = [[0, 0], [0, 0], [0, 0], [3, 4], [6, 0]]\n[task.path.timing]\n\
         crank_deg = [0, 15, 30, 120, 200]\n{ALONE}"
    );
    let record = solved(parse(&text).spec);
    assert_eq!(verify(&record).expect("a record"), []);
    assert!(record.candidates[0].accepted && record.candidates[0].error.rms < 0.2);
}
