//! Certificates for crank angles from the x axis: real linear unknowns, fixed pivots, limits of crank and ground.

use crate::certificate::{cell, directions, draws, points_of};
use crate::certificate_leaves::{sealed, stopped, whole};
use crate::chart::{Point, waits_at};
use crate::common::{job, literature};
use linkwright::internals::app::job::run::{Context, run};
use linkwright::internals::judge::certificate::{CheckError, Proof, Request, check};
use linkwright::internals::numbers::arithmetic::streams::{Stream, stream, unit};
use linkwright::internals::numbers::bound::absolute::{bound, exclude};
use linkwright::internals::numbers::bound::{Outcome, Question, Search, Target};
use linkwright::internals::numbers::checker::{
    claim::Claim,
    region::{Region, Shown},
};
use linkwright::internals::numbers::leaves::root;
use linkwright::internals::numbers::leaves::{Axis, Cell, Class, Leaves, Lengths, Line};
use linkwright::internals::record::Record;
use nalgebra::{Complex, DMatrix, DVector};
use std::sync::atomic::AtomicBool;

type C = Complex<f64>;

/// A problem with crank angles from the x axis.
struct Task {
    class: Class,
    points: Vec<[f64; 2]>,
    angles: Vec<f64>,
    axis: Axis,
    cap: f64,
}

fn between(random: &mut Stream, low: f64, high: f64) -> f64 {
    low + (high - low) * unit(random)
}

/// A planted linkage with a little noise: every variant in turn.
fn task(random: &mut Stream, i: usize, noise: f64) -> (Task, Point, f64) {
    let class = Class::ALL[i % 2];
    let n = 6 + (5.0 * unit(random)) as usize;
    let wide = between(random, 60.0, 360.0);
    let first = between(random, -180.0, 180.0);
    let angles: Vec<f64> =
        (0..n).map(|j| first + wide * (j as f64 + 0.5 * unit(random)) / n as f64).collect();
    let g = between(random, 0.1, 3.0);
    let most = g.min(std::f64::consts::PI - g);
    let theta = match i / 2 % 4 {
        // A ground line along the x axis has no rounding.
        0 => 0.0,
        _ => between(random, -180.0, 180.0),
    };
    let kappa = between(random, 0.3, 1.5);
    let x = Point {
        p: between(random, 0.05, 0.97),
        phi: -f64::to_radians(theta),
        g,
        d: between(random, -most, most),
    };
    let ground = if class == Class::CrankRocker { kappa / x.p } else { kappa * x.p };
    let mut draw = || [between(random, -1.0, 1.0), between(random, -1.0, 1.0)];
    let (a, z) = (draw(), draw());
    let u = directions(&x, class, 1.0, &angles);
    let points: Vec<[f64; 2]> = angles
        .iter()
        .zip(&u)
        .map(|(deg, u)| {
            let (e, off) = (Complex::from_polar(kappa, deg.to_radians()), draw());
            let p = C::new(a[0], a[1]) + e + C::new(z[0], z[1]) * C::new(u[0], u[1]);
            [p.re + noise * off[0], p.im + noise * off[1]]
        })
        .collect();
    let known = Lengths { crank: [0.8 * kappa, 1.3 * kappa], ground: [0.0, 2.0 * ground] };
    let (pivot, line, lengths) = match i / 2 % 8 {
        0 => (Some(a), Some(Line::Angle(theta)), Lengths { crank: [0.0, 50.0], ground: [0.0, 50.0] }),
        1 => (None, None, Lengths { crank: [0.0, f64::INFINITY], ground: [0.0, f64::INFINITY] }),
        2 => (Some(a), None, known),
        3 => (None, Some(Line::Angle(theta)), known),
        4 => (Some(a), Some(Line::Angle(theta)), Lengths { ground: [ground; 2], ..known }),
        5 => (None, None, Lengths { ground: [ground; 2], ..known }),
        6 => (Some(a), Some(Line::Angle(theta)), known),
        _ => {
            let way = Complex::from_polar(ground, theta.to_radians());
            let b = [a[0] + way.re, a[1] + way.im];
            let ground = (b[0] - a[0]).hypot(b[1] - a[1]);
            (Some(a), Some(Line::To(b)), Lengths { ground: [ground; 2], ..known })
        }
    };
    let phi = if line.is_some() { [0.0; 2] } else { [-3.2, 3.2] };
    let task = Task {
        class,
        points,
        angles,
        axis: Axis { pivot, line, lengths, limits_deg: None, phi },
        cap: 1e300,
    };
    let sum = task.least(&task.on_chart(&x, theta));
    (task, x, sum)
}

impl Task {
    /// A point of the task's chart: phi_0 = 0 where the ground line is known.
    fn on_chart(&self, x: &Point, theta: f64) -> Point {
        assert!((x.phi + theta.to_radians()).abs() < 1e-12);
        Point { phi: if self.axis.line.is_some() { 0.0 } else { x.phi }, ..*x }
    }

    /// The ground's angle at a point of the chart.
    fn theta(&self, x: &Point) -> f64 {
        self.axis.angle_deg().map_or(-x.phi, f64::to_radians)
    }

    /// The least sum at a point of the chart, from the definition: real least squares for kappa within its limits.
    fn least(&self, x: &Point) -> f64 {
        let n = self.points.len();
        let theta = self.theta(x);
        let at = Point { phi: -theta, ..*x };
        let u = directions(&at, self.class, 1.0, &self.angles);
        let real = |of: &dyn Fn(usize) -> C| {
            DVector::from_iterator(2 * n, (0..2 * n).map(|k| if k < n { of(k).re } else { of(k - n).im }))
        };
        let i = C::new(0.0, 1.0);
        let u = |j: usize| C::new(u[j][0], u[j][1]);
        let e = real(&|j| Complex::from_polar(1.0, self.angles[j].to_radians()));
        let [a_x, a_y] = self.axis.pivot.unwrap_or_default();
        let target = real(&|j| C::new(self.points[j][0] - a_x, self.points[j][1] - a_y));
        let mut columns = vec![real(&u), real(&|j| i * u(j))];
        if self.axis.pivot.is_none() {
            columns.extend([real(&|_| C::new(1.0, 0.0)), real(&|_| i)]);
        }
        let off = |v: &DVector<f64>| {
            let columns = DMatrix::from_columns(&columns);
            let x = columns.clone().svd(true, true).solve(v, 1e-10).expect("a solution");
            v - columns * x
        };
        let (e, target) = (off(&e), off(&target));
        let Lengths { crank, ground } = self.axis.lengths;
        let over = if self.class == Class::CrankRocker { x.p } else { 1.0 / x.p };
        let [low, high] = [crank[0].max(ground[0] * over), crank[1].min(ground[1] * over)];
        if low > high * (1.0 + 1e-12) {
            return f64::INFINITY;
        }
        let [low, high] = if ground[0] == ground[1] { [ground[0] * over; 2] } else { [low, high] };
        let best = if e.norm_squared() > 1e-14 { e.dot(&target) / e.norm_squared() } else { low };
        (target - e * best.clamp(low, high)).norm_squared()
    }

    fn target(&self) -> Target {
        Target::on_axis(&self.points, &self.angles, &self.axis).expect("a target")
    }

    fn question(&self) -> Question {
        Question::from_axis(self.class, &self.points, &self.angles, self.cap, self.axis).expect("a question")
    }

    /// A box of the task's chart; often around x.
    fn cell(&self, random: &mut Stream, x: &Point) -> Cell {
        let mut cell = cell(random);
        if unit(random) < 0.6 {
            let at = [x.p, x.phi, x.g, x.d];
            let size = 10.0_f64.powf(-0.5 - 3.0 * unit(random));
            for (k, at) in at.into_iter().enumerate() {
                let near = at + between(random, -3.0, 3.0) * size;
                cell.low[k] = near - size * unit(random);
                cell.high[k] = near + size * unit(random);
            }
            (cell.low[0], cell.high[0]) = (cell.low[0].clamp(0.0, 1.0), cell.high[0].clamp(0.0, 1.0));
        }
        if self.axis.line.is_some() {
            (cell.low[1], cell.high[1]) = (0.0, 0.0);
        }
        cell
    }
}

#[test]
fn no_point_of_a_box_has_a_sum_below_the_certified_one() {
    let random = &mut stream(21, 0);
    let (mut certified, mut tight, mut excluded) = ([0; 8], [0; 8], 0);
    for i in 0..draws(16_000) {
        let (task, x, sum) = task(random, i, 0.05);
        let target = task.target();
        for _ in 0..8 {
            let cell = task.cell(random, &x);
            let wanted = sum * 10.0_f64.powf(between(random, -1.0, 2.0));
            let found = bound(&target, task.class, &cell, &task.axis.lengths, task.cap, wanted).sum_sq;
            let outside = exclude(&task.axis.lengths, task.class, &cell);
            excluded += usize::from(outside);
            if found == 0.0 && !outside {
                continue;
            }
            certified[i / 2 % 8] += 1;
            for x in points_of(&cell, random).into_iter().step_by(5) {
                if x.d.abs() > x.g.min(std::f64::consts::PI - x.g) || x.p == 0.0 {
                    continue;
                }
                let least = task.least(&x);
                assert!(!outside || least.is_infinite(), "{i} {:?} {cell:?} {x:?}", task.axis);
                assert!(
                    least >= found * (1.0 - 1e-7),
                    "{i} {:?} {:?} {cell:?} {x:?}: {least} below {found}, wanted {wanted}",
                    task.class,
                    task.axis
                );
                tight[i / 2 % 8] += usize::from(least < 1.1 * found);
            }
        }
    }
    assert!(certified.iter().all(|n| *n > draws(2_000)), "{certified:?}");
    assert!(
        tight.iter().all(|n| *n > draws(300)) && excluded > draws(1_000),
        "{tight:?}, {excluded} excluded"
    );
}

#[test]
fn what_the_checker_shows_of_a_box_holds_at_its_points() {
    let random = &mut stream(22, 0);
    let (mut shown, mut near, mut excluded) = ([0; 8], [0; 8], 0);
    for i in 0..draws(12_000) {
        let (task, x, sum) = task(random, i, 0.05);
        for _ in 0..8 {
            let cell = task.cell(random, &x);
            let region = Region { low: cell.low, high: cell.high };
            let claimed = sum * 10.0_f64.powf(between(random, -1.0, 1.0));
            let (points, angles) = (&task.points, &task.angles);
            let claim =
                Claim::on_axis(task.class, points, angles, task.cap, claimed, &task.axis).expect("a claim");
            assert!(!claim.has_cognates(&region));
            if claim.look(&region) != Shown::Yes || region.is_outside() {
                continue;
            }
            let outside = claim.is_outside(&region);
            excluded += usize::from(outside);
            shown[i / 2 % 8] += 1;
            for x in points_of(&cell, random).into_iter().step_by(5) {
                if x.d.abs() > x.g.min(std::f64::consts::PI - x.g) || x.p == 0.0 {
                    continue;
                }
                let least = task.least(&x);
                assert!(
                    if outside { least.is_infinite() } else { least >= claimed * (1.0 - 1e-7) },
                    "{i} {:?} {:?} {cell:?} {x:?}: {least} below {claimed}",
                    task.class,
                    task.axis
                );
                near[i / 2 % 8] += usize::from(least < 1.5 * claimed);
            }
        }
    }
    assert!(shown.iter().all(|n| *n > draws(1_500)), "{shown:?}");
    assert!(near.iter().all(|n| *n > draws(200)) && excluded > draws(500), "{near:?}, {excluded} excluded");
}

#[test]
fn the_cap_rule_excludes_no_linkage_within_the_cap() {
    let random = &mut stream(23, 0);
    let mut used = 0;
    for i in 0..draws(20_000) {
        let (mut task, _, sum) = task(random, i, 0.3);
        let target = task.target();
        // Near the tube p = d = 0 and the corners, where u is constant.
        let mut cell = cell(random);
        let width = 10.0_f64.powf(-1.0 - 3.0 * unit(random));
        (cell.low[0], cell.high[0]) = (0.0, width);
        (cell.low[3], cell.high[3]) = (-width, width);
        if task.axis.line.is_some() {
            (cell.low[1], cell.high[1]) = (0.0, 0.0);
        }
        let wanted = 10.0 * sum;
        let of = |cap: f64| bound(&target, task.class, &cell, &task.axis.lengths, cap, wanted).sum_sq;
        let cap = 10.0_f64.powf(2.0 * unit(random));
        let (with, without) = (of(cap), of(1e300));
        if with <= without {
            continue;
        }
        used += 1;
        task.cap = cap;
        let (points, angles) = (&task.points, &task.angles);
        let claimed = 0.9 * with;
        let claim = Claim::on_axis(task.class, points, angles, cap, claimed, &task.axis).expect("a claim");
        let shown = claim.look(&Region { low: cell.low, high: cell.high }) == Shown::Yes;
        for x in points_of(&cell, random).into_iter().step_by(4) {
            let u = directions(&Point { phi: -task.theta(&x), ..x }, task.class, 1.0, angles);
            let [a_x, a_y] = task.axis.pivot.unwrap_or_default();
            for _ in 0..20 {
                // Any kappa and any Z within the cap; the best A.
                let z = Complex::from_polar(cap * unit(random).sqrt(), between(random, -3.2, 3.2));
                let kappa = between(random, 0.0, 3.0);
                let off: Vec<C> = (0..points.len())
                    .map(|j| {
                        let e = Complex::from_polar(kappa, angles[j].to_radians());
                        C::new(points[j][0] - a_x, points[j][1] - a_y) - e - z * C::new(u[j][0], u[j][1])
                    })
                    .collect();
                let n = off.len() as f64;
                let mean = off.iter().sum::<C>() / n;
                let mean = if task.axis.pivot.is_some() { C::new(0.0, 0.0) } else { mean };
                let sum: f64 = off.iter().map(|v| (v - mean).norm_sqr()).sum();
                assert!(sum >= with * (1.0 - 1e-7), "{i} {cell:?} {x:?}: {sum} below {with}");
                assert!(!shown || sum >= claimed, "{i} {cell:?} {x:?}: {sum} below {claimed}");
            }
        }
    }
    assert!(used > draws(1_000), "{used}");
}

#[test]
fn a_planted_answer_is_never_excluded() {
    let random = &mut stream(24, 0);
    for i in 0..draws(640) {
        let (mut task, planted, sum) = task(random, i, 0.02);
        task.cap = 2.0;
        let theta = -planted.phi.to_degrees();
        let x = task.on_chart(&planted, theta);
        let at = [x.p, x.phi, x.g, x.d];
        let mut search = Search::new(task.question(), 1.1 * sum);
        for _ in 0..5 {
            search.step();
            assert!(
                waits_at(&search, root(task.axis.phi), at),
                "{x:?} of {:?}, {} boxes",
                task.axis,
                search.boxes()
            );
            assert!(search.lower_bound() <= sum * (1.0 + 1e-9));
        }
        let question = task.question();
        let mut cell = root(task.axis.phi);
        for step in 0..80 {
            let Outcome::Open(found) = question.look(&cell, sum * (1.0 + 1e-7)) else {
                panic!("{x:?} of {:?} was excluded in {cell:?}", task.axis);
            };
            assert!(found.sum_sq <= sum * (1.0 + 1e-7), "{x:?} in {cell:?}");
            let k = step % 4;
            let middle = 0.5 * (cell.low[k] + cell.high[k]);
            if at[k] <= middle { cell.high[k] = middle } else { cell.low[k] = middle }
        }
    }
}

fn record(name: &str, set: &[(&str, &str)]) -> Record {
    let idle = AtomicBool::new(false);
    let context = Context { cancel: &idle, observer: &|_| {} };
    run(&job(literature(name, set)), &context).expect("it runs").record
}

#[test]
#[ignore = "slow: .ci/run runs it"]
fn e5_is_a_proved_optimum() {
    let record = record("e5", &[]);
    let proof = whole(&record, 1e-4);
    let (leaves, certificate) = (proof.leaves(), proof.certificate());
    assert!(certificate.closed && certificate.gap <= 1e-4, "{certificate:?}");
    assert!((7.4150e-7..7.41576e-7).contains(&certificate.lower_bound), "{certificate:?}");
    // The problem asks for crank-rockers.
    assert_eq!(certificate.parts.len(), 1);
    for words in ["No crank-rocker", "crank pivot at (0, 0)", "ground line at 0 degrees", "x axis"] {
        assert!(certificate.statement.contains(words), "{}", certificate.statement);
    }
    assert!(certificate.not_covered.iter().any(|class| class.contains("double-cranks")));
    let bytes = leaves.to_bytes();
    let checked = |certificate: &_, bytes: &[u8]| {
        check(&record, certificate, bytes, &AtomicBool::new(false), &mut |_| {})
    };
    let found = checked(&certificate, &bytes).expect("true");
    assert_eq!(found.leaves, certificate.boxes / 2 + 1);
    // As a file of another question, and with a bound above the best.
    let subject = linkwright::internals::judge::certificate::Subject::new(&record, 1e-4).expect("a subject");
    let mut other = leaves.clone();
    other.parts[0].origin = 1;
    assert_eq!(checked(&subject.certificate(&other), &other.to_bytes()), Err(CheckError::Parts));
    let mut raised = leaves.clone();
    raised.parts[0].lower_bound = subject.best * (1.0 + 1e-6);
    let refused = checked(&subject.certificate(&raised), &raised.to_bytes());
    assert!(matches!(refused, Err(CheckError::Leaf { rule: "bounded", .. })), "{refused:?}");
    // Bounded leaves that are given out for outside or mirrored.
    let bounded: Vec<usize> =
        leaves.parts[0].nodes.codes().enumerate().filter(|(_, code)| *code == 3).map(|(at, _)| at).collect();
    for code in [1, 2] {
        let mut wrong = bytes.clone();
        let at = bounded[bounded.len() / 2];
        let byte = &mut wrong[16 + 24 + at / 2];
        *byte = if at.is_multiple_of(2) { *byte & 0xf0 | code } else { *byte & 0x0f | code << 4 };
        let wrong = Leaves::from_bytes(&sealed(wrong)).expect("a tree");
        let refused = checked(&subject.certificate(&wrong), &wrong.to_bytes());
        assert!(matches!(refused, Err(CheckError::Leaf { part: 1, .. })), "{refused:?}");
    }
    // Stopped and resumed: the same bytes.
    let mut broken = stopped(&record, 1e-4, 5);
    assert!(!broken.ended());
    broken = Proof::resume(&record, &Request { gap: 1e-4 }, &broken.checkpoint()).expect("it goes on");
    broken.run(&AtomicBool::new(false), None, &mut |_| {});
    assert_eq!(broken.leaves().to_bytes(), bytes);
    assert_eq!(broken.certificate(), certificate);
}
