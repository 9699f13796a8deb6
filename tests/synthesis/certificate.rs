//! The certificate: chart, balls, the bound of a box, each rule that discards, the search.

use crate::chart::{Point, sum_sq, waits_at};
use crate::common::thorough::cases;
use linkwright::internals::mechanism::{AssemblyMode, CouplerSide, FourBar, NaturalCoordinates};
use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, unit};
use linkwright::internals::numbers::bound::bound;
use linkwright::internals::numbers::bound::search::{in_cognate_half, outside};
use linkwright::internals::numbers::bound::{Ball, Outcome, Question, Search, Target};
use linkwright::internals::numbers::leaves::{Cell, Class, ROOT, root};

pub const K18: [[f64; 2]; 18] = [
    [0.5, 1.1],
    [0.4, 1.1],
    [0.3, 1.1],
    [0.2, 1.0],
    [0.1, 0.9],
    [0.05, 0.75],
    [0.02, 0.6],
    [0.0, 0.5],
    [0.0, 0.4],
    [0.03, 0.3],
    [0.1, 0.25],
    [0.15, 0.2],
    [0.2, 0.3],
    [0.3, 0.4],
    [0.4, 0.5],
    [0.5, 0.7],
    [0.6, 0.9],
    [0.6, 1.0],
];
const NO_CAP: f64 = f64::MAX;
pub const KINDS: [(Class, f64); 4] = [
    (Class::CrankRocker, 1.0),
    (Class::CrankRocker, -1.0),
    (Class::DoubleCrank, 1.0),
    (Class::DoubleCrank, -1.0),
];

pub fn turns() -> Vec<f64> {
    (0..18).map(|i| 20.0 * f64::from(i)).collect()
}

fn between(random: &mut Stream, low: f64, high: f64) -> f64 {
    low + (high - low) * unit(random)
}

/// A point of the chart where the loop closes.
fn point(random: &mut Stream) -> Point {
    let g = between(random, 0.02, std::f64::consts::PI - 0.02);
    let wide = g.min(std::f64::consts::PI - g);
    Point {
        p: between(random, 0.01, 0.99),
        phi: between(random, -std::f64::consts::PI, std::f64::consts::PI),
        g,
        d: between(random, -wide, wide),
    }
}

pub fn directions(point: &Point, class: Class, direction: f64, turns: &[f64]) -> Vec<[f64; 2]> {
    turns.iter().map(|deg| point.direction(class, direction * deg.to_radians())).collect()
}

/// Factor by which tests of many draws are shorter without optimisation.
pub fn draws(release: usize) -> usize {
    if cfg!(debug_assertions) { release / 10 } else { release }
}

#[test]
fn the_chart_gives_the_coupler_directions_of_the_position_solver() {
    let random = &mut stream(1, 0);
    for i in 0..2000 {
        let (class, _) = KINDS[i % 4];
        let x = point(random);
        let Some(ratios) = x.ratios().filter(|r| r.coupler.max(r.follower) < 100.0) else { continue };
        let (ground, crank) = if class == Class::CrankRocker { (1.0, x.p) } else { (x.p, 1.0) };
        let assembly = if ratios.positive { AssemblyMode::Plus } else { AssemblyMode::Minus };
        let linkage = FourBar::new(NaturalCoordinates {
            crank_pivot: [0.0, 0.0],
            follower_pivot: [ground, 0.0],
            crank,
            coupler: ratios.coupler,
            follower: ratios.follower,
            crank_side: ratios.coupler,
            follower_side: ratios.coupler,
            assembly,
            side: CouplerSide::Plus,
        })
        .expect("a linkage");
        let relative = |turn: f64| {
            let joints = linkage.position(x.phi + turn).joints().expect("its input turns fully");
            let bar = joints.follower_pin - joints.crank_pin;
            let [re, im] = x.direction(class, turn);
            let u = bar / bar.norm();
            [u.re * re + u.im * im, u.im * re - u.re * im]
        };
        let first = relative(0.0);
        for k in 1..12 {
            let [re, im] = relative(f64::from(k) * 0.5);
            assert!((re - first[0]).hypot(im - first[1]) < 1e-6, "{class:?} {x:?} {k}: {re} {im} {first:?}");
        }
    }
}

#[test]
fn back_and_forth_through_the_links_is_the_same_point() {
    let random = &mut stream(2, 0);
    for _ in 0..2000 {
        let x = point(random);
        let Some(r) = x.ratios().filter(|r| r.coupler.max(r.follower) < 1e3) else { continue };
        let Some(back) = Point::of_ratios(x.p, x.phi, r.coupler, r.follower, r.positive) else { continue };
        assert!((back.g - x.g).abs() < 1e-4 && (back.d - x.d).abs() < 1e-4, "{x:?} {back:?}");
    }
}

#[test]
fn the_cognate_has_the_same_sum_a_shorter_coupler_and_a_shorter_arm() {
    let random = &mut stream(3, 0);
    let mut both = 0;
    for i in 0..2000 {
        let (class, direction) = KINDS[i % 4];
        let x = point(random);
        let Some(other) = x.cognate() else { continue };
        let Some((r, s)) = x.ratios().zip(other.ratios()).filter(|(r, _)| r.coupler.max(r.follower) < 100.0)
        else {
            continue;
        };
        let sum = |x: &Point| sum_sq(&K18, &turns(), direction, &directions(x, class, direction, &turns()));
        assert!((sum(&x) - sum(&other)).abs() < 1e-6 * sum(&x), "{x:?} {other:?}");
        assert!((r.coupler - s.follower).abs() < 1e-4 * r.coupler, "{r:?} {s:?}");
        // The half that the search drops is the one with b > c.
        let dropped = (x.g.sin() * x.d.sin()).abs() < x.p * (x.g.cos() * x.d.cos()).abs();
        if (r.coupler / r.follower - 1.0).abs() > 1e-6 {
            assert_eq!(dropped, r.coupler > r.follower, "{x:?} {r:?}");
            both |= 1 << u32::from(dropped);
        }
    }
    assert_eq!(both, 3, "both halves were drawn");
}

#[test]
fn balls_hold_the_exact_results() {
    use num_bigint::BigInt;
    // The exact value of a float times 2^1200.
    let exact = |x: f64| {
        let bits = x.to_bits();
        let (exponent, fraction) = ((bits >> 52 & 0x7ff) as i64, bits & ((1 << 52) - 1));
        let (m, e) = if exponent == 0 { (fraction, -1074) } else { (fraction | 1 << 52, exponent - 1075) };
        let m = BigInt::from(m) << (1200 + e) as usize;
        if x < 0.0 { -m } else { m }
    };
    let random = &mut stream(4, 0);
    let one = BigInt::from(1) << 1200_usize;
    let holds = |value: BigInt, scale: &BigInt, ball: Ball| {
        // |value/scale - mid| <= rad with value/scale in units of 2^-1200.
        let off = value - exact(ball.mid) * scale;
        let off = if off < BigInt::from(0) { -off } else { off };
        assert!(off <= exact(ball.rad) * scale, "{ball:?}");
    };
    for _ in 0..5000 {
        let mut draw = || (unit(random) - 0.5) * 2.0_f64.powi((unit(random) * 40.0) as i32 - 20);
        let (x, y) = (draw(), draw());
        let (a, b) = (Ball::exact(x), Ball::exact(y));
        let whole = BigInt::from(1);
        holds(exact(x) + exact(y), &whole, a + b);
        holds(exact(x) - exact(y), &whole, a - b);
        holds(exact(x) * exact(y), &one, a * b);
        // x/y = mid +- rad: multiply by y.
        let quotient = a.over(b);
        let sign = if y < 0.0 { -1 } else { 1 };
        holds(exact(x) * &one * sign, &(exact(y) * sign), quotient);
        // sqrt x in [mid - rad, mid + rad].
        let root = a.root();
        let (low, high) = (exact((root.mid - root.rad).max(0.0)), exact(root.mid + root.rad));
        let value = exact(x.max(0.0)) * &one;
        assert!(&low * &low <= value && value <= &high * &high, "{x} {root:?}");
        // Balls with a radius hold the results of what is in them.
        let (ra, rb) = (unit(random) * 0.3 * x.abs(), unit(random) * 0.3 * y.abs());
        let (wide, far) = (Ball { mid: x, rad: ra }, Ball { mid: y, rad: rb });
        let (i, j) = (x + ra * (2.0 * unit(random) - 1.0), y + rb * (2.0 * unit(random) - 1.0));
        let inside = |value: f64, ball: Ball| {
            assert!((value - ball.mid).abs() <= ball.rad * (1.0 + 1e-12), "{value} {ball:?}");
        };
        inside(i * j, wide * far);
        inside(i / j, wide.over(far));
        inside(i.max(0.0).sqrt(), wide.root());
        let angle = 8.0 * unit(random) - 4.0;
        let [cos, sin] = Ball::cos_sin(angle);
        assert!((cos.mid - angle.cos()).abs() <= cos.rad && (sin.mid - angle.sin()).abs() <= sin.rad);
        assert!(cos.rad < 1e-13 && sin.rad < 1e-13, "{cos:?} {sin:?}");
    }
    assert!(Ball::exact(1.0).over(Ball { mid: 1.0, rad: 0.6 }).rad.is_infinite());
    assert!(Ball::cos_sin(4.1)[0].rad.is_infinite());
}

/// A box of any size anywhere in the chart, often beside what is degenerate.
pub fn cell(random: &mut Stream) -> Cell {
    let root = ROOT;
    let size = 10.0_f64.powf(-4.0 * unit(random));
    let mut cell = root;
    for k in 0..4 {
        let mut middle = between(random, root.low[k], root.high[k]);
        // p = 0 or 1, phi_j = 0, gamma = 0 or pi, d = 0.
        match ((8.0 * unit(random)) as usize, k) {
            (0, 0) => middle = 0.0,
            (1, 0) => middle = 1.0,
            (0, 1) => middle = (20.0 * (18.0 * unit(random)).floor() - 170.0).to_radians(),
            (0, 2) => middle = 0.0,
            (1, 2) => middle = std::f64::consts::PI,
            (0 | 1, 3) => middle = 0.0,
            (2, 3) => middle = cell.low[2],
            _ => {}
        }
        let half = size * 10.0_f64.powf(-unit(random)) * 0.5;
        cell.low[k] = (middle - half).max(root.low[k]);
        cell.high[k] = (middle + half).min(root.high[k]).max(cell.low[k]);
    }
    cell
}

fn within(cell: &Cell, at: [f64; 4]) -> Point {
    let x: Vec<f64> = (0..4).map(|k| cell.low[k] + (cell.high[k] - cell.low[k]) * at[k]).collect();
    Point { p: x[0], phi: x[1], g: x[2], d: x[3] }
}

pub fn points_of(cell: &Cell, random: &mut Stream) -> Vec<Point> {
    let corners = (0..16).map(|i| [0, 1, 2, 3].map(|k| f64::from(i >> k & 1))).collect::<Vec<_>>();
    let inner: Vec<[f64; 4]> = (0..12).map(|_| [0; 4].map(|_| unit(random))).collect();
    corners.iter().chain(&inner).map(|at| within(cell, *at)).collect()
}

#[test]
fn no_point_of_a_box_has_a_sum_below_the_certified_one() {
    let random = &mut stream(5, 0);
    let targets = KINDS.map(|(_, direction)| Target::new(&K18, &turns(), direction).expect("a target"));
    let (mut certified, mut tight) = (0, 0);
    // Without optimisation every third of the points.
    let step = if cfg!(debug_assertions) { 3 } else { 1 };
    for i in 0..cases(40_000, 100_000) {
        let ((class, direction), target) = (KINDS[i % 4], &targets[i % 4]);
        let cell = cell(random);
        let found = bound(target, class, &cell, NO_CAP, 0.98 * target.size_sq());
        if found.sum_sq == 0.0 {
            continue;
        }
        certified += 1;
        for x in points_of(&cell, random).into_iter().step_by(step) {
            let sum = sum_sq(&K18, &turns(), direction, &directions(&x, class, direction, &turns()));
            assert!(sum >= found.sum_sq * (1.0 - 1e-9), "{class:?} {cell:?} {x:?}: {sum} below {found:?}");
            tight += usize::from(sum < 1.1 * found.sum_sq);
        }
    }
    assert!(
        certified > cases(8_000, 20_000) && tight > draws(cases(400, 1_000)),
        "{certified} certified, {tight} near"
    );
}

#[test]
fn the_cap_rule_excludes_no_linkage_within_the_cap() {
    let random = &mut stream(6, 0);
    let mut used = 0;
    for i in 0..draws(40_000) {
        let (class, direction) = KINDS[i % 4];
        let target = Target::new(&K18, &turns(), direction).expect("a target");
        // Near the tube p = d = 0 and the corners.
        let mut cell = cell(random);
        let width = 10.0_f64.powf(-1.0 - 3.0 * unit(random));
        (cell.low[0], cell.high[0]) = (0.0, width);
        (cell.low[3], cell.high[3]) = (-width, width);
        let cap = 10.0_f64.powf(2.0 * unit(random));
        let wanted = 0.98 * target.size_sq();
        let with = bound(&target, class, &cell, cap, wanted).sum_sq;
        if with <= bound(&target, class, &cell, NO_CAP, wanted).sum_sq {
            continue;
        }
        used += 1;
        for x in points_of(&cell, random) {
            let u = directions(&x, class, direction, &turns());
            let sum = capped_sum(&K18, &turns(), direction, &u, cap);
            assert!(sum >= with * (1.0 - 1e-9), "{cell:?} {x:?}: {sum} below {with}");
        }
    }
    assert!(used > draws(2_000), "{used}");
}

/// The least sum of squares with |Z| <= cap, from scratch: |T' - Z u'|^2 is a circle's paraboloid in Z.
pub fn capped_sum(points: &[[f64; 2]], turns: &[f64], direction: f64, u: &[[f64; 2]], cap: f64) -> f64 {
    use nalgebra::{Complex, DMatrix, DVector};
    let complex = |v: &[f64; 2]| Complex::new(v[0], v[1]);
    let n = points.len();
    let columns = DMatrix::from_fn(n, 2, |j, k| match k {
        0 => Complex::new(1.0, 0.0),
        _ => Complex::from_polar(1.0, direction * turns[j].to_radians()),
    });
    let q = columns.qr().q();
    let off = |v: DVector<Complex<f64>>| &v - &q * (q.adjoint() * &v);
    let target = off(DVector::from_iterator(n, points.iter().map(complex)));
    let u = off(DVector::from_iterator(n, u.iter().map(complex)));
    let (uu, ut) = (u.norm_squared(), u.dotc(&target).norm());
    let z = if uu > 0.0 { (ut / uu).min(cap) } else { 0.0 };
    (target.norm_squared() - 2.0 * z * ut + z * z * uu).max(0.0)
}

#[test]
fn what_lies_outside_or_in_the_cognates_half_is_nothing_else() {
    let random = &mut stream(7, 0);
    let mut seen = [0; 2];
    for _ in 0..100_000 {
        let cell = cell(random);
        let (out, mirrored) = (outside(&cell), in_cognate_half(&cell));
        seen[0] += usize::from(out);
        seen[1] += usize::from(mirrored);
        if !out && !mirrored {
            continue;
        }
        for x in points_of(&cell, random) {
            if out {
                assert!(x.d.abs() > x.g.min(std::f64::consts::PI - x.g), "{cell:?} {x:?}");
            }
            if mirrored {
                let (sin, cos) = ((x.g.sin() * x.d.sin()).abs(), (x.g.cos() * x.d.cos()).abs());
                assert!(sin < x.p * cos, "{cell:?} {x:?}");
            }
        }
    }
    assert!(seen.iter().all(|n| *n > 5_000), "{seen:?}");
}

#[test]
fn leaving_a_point_out_lowers_the_sum() {
    let random = &mut stream(8, 0);
    for i in 0..2000 {
        let (class, direction) = KINDS[i % 4];
        let (mut points, mut fewer) = (K18.to_vec(), turns());
        let x = point(random);
        let sum = sum_sq(&points, &fewer, direction, &directions(&x, class, direction, &fewer));
        let j = i % 18;
        points.remove(j);
        fewer.remove(j);
        let less = sum_sq(&points, &fewer, direction, &directions(&x, class, direction, &fewer));
        assert!(less <= sum * (1.0 + 1e-12), "{x:?}: {less} above {sum}");
    }
}

/// Targets on a known linkage's curve, with noise.
fn planted(random: &mut Stream, n: usize, noise: f64) -> (Point, Class, f64, Vec<[f64; 2]>, Vec<f64>, f64) {
    loop {
        let (class, direction) = KINDS[(4.0 * unit(random)) as usize];
        let x = point(random);
        let dropped = (x.g.sin() * x.d.sin()).abs() < x.p * (x.g.cos() * x.d.cos()).abs();
        if dropped {
            continue;
        }
        let turns: Vec<f64> = (0..n).map(|i| 360.0 / n as f64 * i as f64).collect();
        let mut draw = || [between(random, -1.0, 1.0), between(random, -1.0, 1.0)];
        let (a, k, z) = (draw(), draw(), draw());
        let times = |x: [f64; 2], y: [f64; 2]| [x[0] * y[0] - x[1] * y[1], x[0] * y[1] + x[1] * y[0]];
        let points = turns
            .iter()
            .map(|deg| {
                let turn = direction * deg.to_radians();
                let crank = times(k, [turn.cos(), turn.sin()]);
                let coupler = times(z, x.direction(class, turn));
                let off = draw();
                [0, 1].map(|i| a[i] + crank[i] + coupler[i] + noise * off[i])
            })
            .collect::<Vec<_>>();
        let sum = sum_sq(&points, &turns, direction, &directions(&x, class, direction, &turns));
        return (x, class, direction, points, turns, sum);
    }
}

#[test]
fn a_planted_better_answer_is_never_excluded() {
    let random = &mut stream(9, 0);
    for _ in 0..draws(60) {
        let (x, class, direction, points, turns, sum) = planted(random, 12, 0.02);
        let question = Question::new(class, direction, &points, &turns, 2.0).expect("a question");
        // Asked whether a tenth more can be excluded, the box with the planted answer must stay.
        let mut search = Search::new(question, 1.1 * sum);
        let at = [x.p, x.phi, x.g, x.d];
        for _ in 0..12 {
            search.step();
            assert!(
                waits_at(&search, ROOT, at),
                "{x:?} of {class:?} was excluded at {} boxes",
                search.boxes()
            );
            assert!(search.lower_bound() <= sum);
        }
    }
}

#[test]
fn a_planted_answer_from_the_ground_line_is_never_excluded() {
    let random = &mut stream(13, 0);
    for _ in 0..draws(300) {
        let (x, class, direction, points, turns, sum) = planted(random, 10, 0.02);
        // The same crank angles, from the ground line.
        let angles: Vec<f64> = turns.iter().map(|deg| direction * deg + x.phi.to_degrees()).collect();
        let question = Question::new(class, 1.0, &points, &angles, 2.0).expect("a question").from_ground();
        let mut search = Search::new(question, 1.1 * sum);
        for _ in 0..6 {
            search.step();
            assert!(
                waits_at(&search, root([0.0; 2]), [x.p, 0.0, x.g, x.d]),
                "{x:?} of {class:?}, {} boxes",
                search.boxes()
            );
            assert!(search.lower_bound() <= sum);
        }
    }
}

#[test]
fn every_box_around_a_planted_answer_stays_however_small() {
    let random = &mut stream(10, 0);
    for _ in 0..draws(500) {
        let (x, class, direction, points, turns, sum) = planted(random, 9, 0.02);
        let question = Question::new(class, direction, &points, &turns, 2.0).expect("a question");
        let mut cell = ROOT;
        let at = [x.p, x.phi, x.g, x.d];
        for i in 0..80 {
            let Outcome::Open(found) = question.look(&cell, sum * (1.0 + 1e-9)) else {
                panic!("{x:?} of {class:?} was excluded in {cell:?}");
            };
            assert!(found.sum_sq <= sum * (1.0 + 1e-9), "{x:?} in {cell:?}");
            let k = i % 4;
            let middle = 0.5 * (cell.low[k] + cell.high[k]);
            if at[k] <= middle { cell.high[k] = middle } else { cell.low[k] = middle }
        }
    }
}

#[test]
fn the_same_boxes_on_any_number_of_threads_and_the_bound_rises() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            let question = Question::new(Class::DoubleCrank, -1.0, &K18, &turns(), 71.0).expect("a question");
            let mut search = Search::new(question, 0.008);
            let mut last = 0.0;
            for _ in 0..draws(100) {
                search.step();
                assert!(search.lower_bound() >= last);
                last = search.lower_bound();
            }
            (search.boxes(), search.lower_bound().to_bits(), search.nodes().sha256())
        })
    };
    assert_eq!(run(1), run(2));
}
