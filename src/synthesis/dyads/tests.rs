//! Dyads of five poses and more: those of random linkages, of random poses, of published and of degenerate ones.

use super::fixture::{
    KINZEL5, Moved, NISHIDA5, error, nearest, poses_deg, random_point, random_poses, rr, size,
};
use super::*;
use crate::mechanism::four_bar::mobility::wrapped;
use crate::mechanism::{Complex, Dyad, Pose};
use crate::numbers::arithmetic::streams::{Stream, below, stream, uniform};

fn five(poses: &[Pose]) -> [Pose; 5] {
    poses.try_into().expect("five poses")
}

#[test]
fn five_poses_of_a_linkage_give_back_its_crank_and_its_follower() {
    let draws = &mut stream(20, 0);
    for case in 0..200 {
        let moved = Moved::random(draws, 5);
        let found = through_five(&five(&moved.poses));
        assert!(found.len() == 2 || found.len() == 4, "case {case}: {found:?}");
        for dyad in moved.dyads() {
            assert!(error(&dyad, &moved.poses) < 1e-14, "case {case}");
            // Five poses close together leave a dyad uncertain; the poses it meets all the same.
            assert!(nearest(&dyad, &found) < 1e-6, "case {case}: {dyad:?} not among {found:?}");
        }
        assert!(found.iter().all(|dyad| error(dyad, &moved.poses) < 1e-13), "case {case}");
    }
}

#[test]
fn five_random_poses_have_no_two_or_four_dyads() {
    let draws = &mut stream(21, 0);
    let mut counts = [0; 5];
    let mut worst: f64 = 0.0;
    for case in 0..300 {
        let poses = random_poses(draws, 5);
        let found = through_five(&five(&poses));
        assert!(matches!(found.len(), 0 | 2 | 4), "case {case}: {found:?}");
        counts[found.len()] += 1;
        worst = found.iter().map(|dyad| error(dyad, &poses)).fold(worst, f64::max);
    }
    assert!(worst < 1e-13, "{worst:e}");
    assert!(counts[0] > 10 && counts[2] > 150 && counts[4] > 20, "{counts:?}");
}

#[test]
fn published_poses_have_their_known_dyads() {
    // All real dyads, by the same quartic in another language (2026).
    let kinzel = [
        rr(
            [11.275525578896987, 2.1358478799154392],
            [20.103375980022903, 25.329783283732404],
            13.252934372264237,
        ),
        rr(
            [-12.994843514271327, 1.6940672735518378],
            [15.001046797065452, 16.152753876006177],
            19.25943406252295,
        ),
        rr(
            [-28.513487925493983, 7.076024534248884],
            [21.523641235169553, 12.352560287110334],
            40.563436472258275,
        ),
        rr(
            [-13.34328903503111, -15.293041400263862],
            [-14.405725323672478, 9.822587377677172],
            21.24727127819375,
        ),
    ];
    let nishida = [
        rr(
            [-9.58523102634356, -1.3620227423626707],
            [8.905042219958451, 18.714127712242473],
            13.980039406424913,
        ),
        rr(
            [3.5950961234035974, -11.66586512346761],
            [20.724227840812734, 7.181332357116225],
            12.147134880944561,
        ),
    ];
    for (rows, known) in [(KINZEL5, &kinzel[..]), (NISHIDA5, &nishida[..])] {
        let poses = poses_deg(rows);
        for found in [through_five(&poses), nearest_in_kernel(&poses)] {
            for dyad in known {
                assert!(nearest(dyad, &found) < 1e-10, "{dyad:?} not among {found:?}");
            }
        }
        assert_eq!(through_five(&poses).len(), known.len());
    }
}

#[test]
fn dyads_move_with_the_poses_and_grow_with_them() {
    let turn = Complex::from_polar(1.0, 0.7);
    for (shift, scale) in
        [(Complex::new(1e6, -2e6), 1.0), (Complex::new(0.0, 0.0), 1e-9), (Complex::new(3.0, 4.0), 1e9)]
    {
        let moved = poses_deg(KINZEL5).map(|pose| Pose {
            position: (turn * pose.position) * scale + shift,
            direction: turn * pose.direction,
        });
        let found = through_five(&moved);
        assert_eq!(found.len(), 4);
        for dyad in through_five(&poses_deg(KINZEL5)) {
            let Dyad::RR { pin, pivot, length } = dyad else { panic!("{dyad:?}") };
            let wanted =
                Dyad::RR { pin: pin * scale, pivot: turn * pivot * scale + shift, length: length * scale };
            assert!(nearest(&wanted, &found) < 1e-9 * (scale + shift.norm()), "{wanted:?}, {found:?}");
        }
    }
}

/// Poses that infinitely many dyads meet, or none.
fn degenerate() -> Vec<Vec<Pose>> {
    let places = [[0.0, 0.0], [1.0, 0.2], [2.0, 1.0], [2.2, 2.0], [1.0, 3.0]];
    let angles = [0.1, 0.4, 1.1, 1.9, 2.8];
    let pose = |[x, y]: [f64; 2], angle: f64| Pose::new(Complex::new(x, y), angle);
    let shifted = places.map(|at| pose(at, 0.3)).to_vec();
    let on_circle = angles.map(|angle| Pose::new(Complex::from_polar(2.0, angle), 0.3)).to_vec();
    let at_one_place = angles.map(|angle| pose([3.0, -4.0], angle)).to_vec();
    // Turning about the body's point (0.3, -0.2), which stays at (1, 1).
    let turning = angles.map(|angle| {
        let direction = Complex::from_polar(1.0, angle);
        Pose { position: Complex::new(1.0, 1.0) - direction * Complex::new(0.3, -0.2), direction }
    });
    let all_equal = vec![pose([1.0, 2.0], 0.5); 5];
    let mut repeated: Vec<Pose> = (0..5).map(|k| pose(places[k], angles[k])).collect();
    repeated[3] = repeated[1];
    let not_finite = [f64::NAN, f64::INFINITY].map(|x| {
        let mut poses: Vec<Pose> = (0..5).map(|k| pose(places[k], angles[k])).collect();
        poses[2].position.im = x;
        poses
    });
    let huge = (0..5).map(|k| pose(places[k].map(|x| x * 1e300), angles[k])).collect();
    let mut sets = vec![shifted, on_circle, at_one_place, turning.to_vec(), all_equal, repeated, huge];
    sets.extend(not_finite);
    sets
}

#[test]
fn poses_that_infinitely_many_dyads_meet_have_no_list_of_dyads() {
    for (k, poses) in degenerate().into_iter().enumerate() {
        let five = five(&poses);
        let exact = through_five(&five);
        assert!(exact.is_empty(), "set {k}: {exact:?}");
        let near = nearest_in_kernel(&poses);
        assert!(near.is_empty(), "set {k}: {near:?}");
        let four = [five[0], five[1], five[2], five[3]];
        let curve = through_four_curve(&four, 40);
        assert!(curve.is_empty(), "set {k}: {} dyads", curve.len());
        let minima = circle_minima(&poses, None, 21, 2.5);
        let sliders =
            [pin_on_line(&poses), line_over_pivot(&poses), pin_on_line(&four), line_over_pivot(&four)];
        for dyad in exact.iter().chain(&near).chain(&curve).chain(&minima).chain(sliders.iter().flatten()) {
            assert!(dyad.is_finite(), "set {k}: {dyad:?}");
        }
        let three = [five[0], five[1], five[3]];
        for at in [Complex::new(0.3, -0.2), Complex::new(1.0, 1.0), Complex::new(f64::NAN, 0.0)] {
            let found = [through_three_from_pin(&three, at), through_three_from_pivot(&three, at)];
            assert!(found.iter().flatten().all(Dyad::is_finite), "set {k}: {found:?}");
            let fit = circle_fit(&poses, at, None);
            assert!(
                fit.is_none_or(|fit| fit.dyad(at).is_finite() && fit.rms.is_finite()),
                "set {k}: {fit:?}"
            );
        }
    }
    assert!(nearest_in_kernel(&poses_deg(KINZEL5)[..4]).is_empty());
    assert!(through_random_five(&poses_deg(KINZEL5)[..4], &mut stream(0, 0)).is_empty());
    assert_eq!(pin_on_line(&poses_deg(KINZEL5)[..3]), None);
}

#[test]
fn poses_with_coincidences_at_any_scale_give_finite_dyads_alone() {
    for case in 0..300 {
        let draws = &mut stream(33, case);
        let count = 5 + below(draws, 5);
        let scale = if below(draws, 2) == 0 { 1.0 } else { 10_f64.powf(uniform(draws, -320.0, 308.0)) };
        let mut poses = random_poses(draws, count);
        for k in 0..count {
            let other = poses[below(draws, count)];
            match below(draws, 8) {
                0 => poses[k].direction = other.direction,
                1 => poses[k].position = other.position,
                2 => poses[k] = other,
                3 => poses[k].direction = -other.direction,
                4 => poses[k].position.im = 0.0,
                _ => {}
            }
        }
        poses.iter_mut().for_each(|pose| pose.position *= scale);
        let at = random_point(draws, scale);
        let [three, four, five] = [3, 4, 5].map(|count| &poses[..count]);
        let (three, four) = (three.try_into().expect("three"), four.try_into().expect("four"));
        let mut found = through_five(five.try_into().expect("five"));
        found.extend(nearest_in_kernel(&poses));
        found.extend(through_random_five(&poses, draws));
        found.extend(circle_minima(&poses, None, 15, 2.5));
        found.extend(through_four_curve(four, 30));
        found.extend([pin_on_line(&poses), line_over_pivot(&poses)].into_iter().flatten());
        found.extend(through_three_from_pin(three, at));
        found.extend(through_three_from_pivot(three, at));
        found.extend(circle_fit(&poses, at, None).map(|fit| fit.dyad(at)));
        for dyad in &found {
            assert!(dyad.is_finite(), "case {case}: {dyad:?}");
            for made in found.iter().filter_map(|other| pair(dyad, other)) {
                assert!(
                    made.shape.offset.is_finite() && made.frame_angle.is_finite(),
                    "case {case}: {made:?}"
                );
            }
        }
    }
}

#[test]
fn a_trammel_has_one_dyad_beside_its_lines() {
    // Two body points on two lines at right angles: the midpoint runs on a circle about the lines' meeting point, and
    // infinitely many pins run on lines.
    let poses = [0.2, 0.7, 1.3, 2.0, 2.9].map(|angle: f64| {
        let direction = Complex::from_polar(1.0, angle);
        // The body's ends (-+1, 0) are on the y and on the x axis if its middle is at (cos, -sin).
        let middle = direction.conj();
        Pose { position: middle - direction * Complex::new(0.2, 0.4), direction }
    });
    let found = through_five(&poses);
    assert_eq!(found.len(), 1, "{found:?}");
    assert!(nearest(&rr([0.2, 0.4], [0.0, 0.0], 1.0), &found) < 1e-12, "{found:?}");
}

#[test]
fn dyads_of_five_poses_that_nearly_coincide_are_found() {
    // Shrinks the motion about one dyad pair until two of five random poses' real dyads meet and vanish.
    let draws = &mut stream(22, 0);
    let mut vanished = 0;
    for _ in 0..20 {
        let (one, other) = (random_poses(draws, 5), random_poses(draws, 5));
        let between = |share: f64| -> [Pose; 5] {
            std::array::from_fn(|k| {
                let position = one[k].position * (1.0 - share) + other[k].position * share;
                let turn = wrapped((other[k].direction * one[k].direction.conj()).arg());
                Pose { position, direction: one[k].direction * Complex::from_polar(1.0, share * turn) }
            })
        };
        let count = |share: f64| through_five(&between(share)).len();
        let (mut low, mut high) = (0.0, 1.0);
        let (before, after) = (count(low), count(high));
        if before == after {
            continue;
        }
        for _ in 0..52 {
            let middle = 0.5 * (low + high);
            if count(middle) == before {
                low = middle
            } else {
                high = middle
            }
            let poses = between(middle);
            assert!(through_five(&poses).iter().all(|dyad| error(dyad, &poses) < 1e-10));
        }
        vanished += 1;
    }
    assert!(vanished > 3, "{vanished}");
}

#[test]
fn the_kernel_of_noisy_poses_is_near_the_dyads_that_made_them() {
    let draws = &mut stream(23, 0);
    let (mut near, cases) = (0, 100);
    for _ in 0..cases {
        let moved = Moved::random(draws, 12);
        let exact = nearest_in_kernel(&moved.poses);
        for dyad in moved.dyads() {
            assert!(nearest(&dyad, &exact) < 1e-6, "{dyad:?} not among {exact:?}");
        }
        let noise = 1e-4 * size(&moved.poses);
        let noisy: Vec<Pose> = moved
            .poses
            .iter()
            .map(|pose| Pose {
                position: pose.position + random_point(draws, noise),
                direction: pose.direction * Complex::from_polar(1.0, uniform(draws, -1e-4, 1e-4)),
            })
            .collect();
        let found = nearest_in_kernel(&noisy);
        assert!(found.len() <= 4);
        let is_near = |dyad: &Dyad| nearest(dyad, &found) < 0.1 * size(&noisy);
        near += usize::from(moved.dyads().iter().all(is_near));
    }
    assert!(near >= 80, "{near} of {cases}");
}

#[test]
fn random_five_of_many_poses_give_the_dyads_that_all_share() {
    let draws = &mut stream(26, 0);
    for _ in 0..20 {
        let moved = Moved::random(draws, 12);
        for _ in 0..5 {
            let found = through_random_five(&moved.poses, draws);
            assert!(moved.dyads().iter().all(|dyad| nearest(dyad, &found) < 1e-5), "{found:?}");
        }
    }
}

/// Draws five random poses near each other, in place and angle.
fn small_motion(draws: &mut Stream, share: f64) -> [Pose; 5] {
    let middle = random_point(draws, 3.0);
    std::array::from_fn(|_| Pose::new(middle + random_point(draws, share), uniform(draws, -share, share)))
}

#[test]
fn small_motions_have_dyads_to_the_same_error() {
    let draws = &mut stream(32, 0);
    for share in [1e-1, 1e-2, 1e-3] {
        let mut some = 0;
        for _ in 0..50 {
            let poses = small_motion(draws, share);
            let found = through_five(&poses);
            some += usize::from(!found.is_empty());
            for dyad in found {
                assert!(error(&dyad, &poses) < 1e-12, "{share}: {:e}", error(&dyad, &poses));
            }
        }
        assert!(some > 25, "{share}: {some}");
    }
}
