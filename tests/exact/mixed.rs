//! Poses and points that have finitely many linkages: all of them, from file to record, beside a computation of their own.

use crate::common::thorough::cases;
use crate::common::{bytes, load, parse, root, run_on};
use crate::poses::{Taken, taken, wide};
use linkwright::internals::judge::verify::verify;
use linkwright::internals::mechanism::{AssemblyMode, Complex, FourBar, point};
use linkwright::internals::numbers::arithmetic::streams::{Stream, below, stream};
use linkwright::internals::record::{Completeness, ExactLinkage, Reason, Record};

/// Poses, points, and the number of linkages, real and complex.
const KINDS: [(usize, usize, usize); 4] = [(5, 0, 6), (4, 2, 30), (3, 4, 201), (2, 6, 1112)];

/// Poses, points, fixed pivots that are given, and the number of linkages.
const GIVEN: [(usize, usize, usize, usize); 6] =
    [(0, 5, 2, 36), (0, 7, 1, 243), (2, 4, 1, 94), (2, 2, 2, 6), (3, 2, 1, 12), (3, 0, 2, 1)];

/// A target: its place, and an angle, degrees.
type Row = (Complex, Option<f64>);

fn text(rows: &[Row], more: &str) -> String {
    let row = |(p, angle): &Row| match angle {
        Some(angle) => format!("[{:?}, {:?}, {angle:?}]", p.re, p.im),
        None => format!("[{:?}, {:?}]", p.re, p.im),
    };
    let (table, key) =
        if rows.iter().any(|(_, angle)| angle.is_some()) { ("motion", "poses") } else { ("path", "points") };
    let rows: Vec<String> = rows.iter().map(row).collect();
    format!("format = 1\n[task.{table}]\n{key} = [{}]\n{more}", rows.join(", "))
}

/// Positions of a random linkage, of which some places have an angle too.
fn positions(draws: &mut Stream, poses: usize, points: usize) -> (Taken, Vec<Row>) {
    let made = taken(draws, poses + points, 0.0);
    let mut with: Vec<bool> = (0..poses + points).map(|j| j < poses).collect();
    for last in (1..with.len()).rev() {
        with.swap(last, below(draws, last + 1));
    }
    let row = |((p, angle), with): (&(Complex, f64), &bool)| (*p, with.then_some(angle.to_degrees()));
    let rows = made.poses.iter().zip(&with).map(row).collect();
    (made, rows)
}

fn solved(rows: &[Row], more: &str) -> Record {
    run_on(2, parse(&text(rows, &format!("[solve]\nmethod = \"continuation\"\n{more}"))))
}

/// The position of a linkage at a crank angle, by the intersection of two circles: P, the coupler's angle, and the sine of
/// the transmission angle.
fn position(linkage: &FourBar, deg: f64, t1: AssemblyMode) -> (Complex, f64, f64) {
    let (a, b) = (linkage.crank_pivot(), linkage.follower_pivot());
    let c = a + Complex::from_polar(linkage.crank(), deg.to_radians());
    let (across, follower, coupler) = (b - c, linkage.follower(), linkage.coupler());
    let far = across.norm();
    let along = (coupler * coupler - follower * follower + far * far) / (2.0 * far);
    let side = (coupler * coupler - along * along).max(0.0).sqrt();
    let sign = if t1 == AssemblyMode::Plus { 1.0 } else { -1.0 };
    let direction = across / far * Complex::new(along, sign * side) / coupler;
    let to_follower = across - direction * coupler;
    let sine = (direction.conj() * to_follower).im.abs() / follower;
    (c + direction * linkage.coupler_offset(), direction.arg(), sine)
}

/// Checks that a linkage takes its coupler through all targets, with one frame of the body.
fn passes(linkage: &FourBar, listed: &ExactLinkage, rows: &[Row], size: f64) {
    let mut frame: Option<Complex> = None;
    for ((p, angle), (deg, t1)) in rows.iter().zip(listed.crank_deg.iter().zip(&listed.t1_at)) {
        let (at, direction, sine) = position(linkage, *deg, *t1);
        // At a toggle a position is known to the root of rounding.
        let span = linkage.longest_link().max(linkage.crank_side()).max(size);
        let limit = 1e-10 * span / sine.max(1e-7);
        assert!((at - p).norm() <= limit, "{:e} of {limit:e}", (at - p).norm());
        let Some(angle) = angle else { continue };
        let own = Complex::from_polar(1.0, angle.to_radians() - direction);
        let first = *frame.get_or_insert(own);
        assert!((own - first).norm() <= limit / size.min(1.0), "{:e} of {limit:e}", (own - first).norm());
    }
}

fn is_near(one: &FourBar, other: &FourBar) -> bool {
    let numbers = |l: &FourBar, swapped: bool| {
        let (a, b) = (l.crank_pivot(), l.follower_pivot());
        let (first, second, links) =
            if swapped { (b, a, [l.follower(), l.crank()]) } else { (a, b, [l.crank(), l.follower()]) };
        [first.re, first.im, second.re, second.im, links[0], links[1], l.coupler()]
    };
    let reach = 1e-5 * one.longest_link().max(other.longest_link());
    let same = |swapped: bool| {
        numbers(one, false).iter().zip(numbers(other, swapped)).all(|(x, y)| (x - y).abs() <= reach)
    };
    same(false) || same(true)
}

/// Whether a linkage is the one that is listed, or another mechanism of its class.
fn is_of_class(listed: &ExactLinkage, linkage: &FourBar) -> bool {
    let all = std::iter::once(listed.linkage.four_bar().expect("a four-bar"))
        .chain(listed.others.iter().map(|form| form.linkage.four_bar().expect("a four-bar")));
    all.into_iter().any(|form| is_near(form, linkage))
}

#[test]
fn positions_of_random_linkages_give_all_linkages_the_generating_one_among_them() {
    for ((poses, points, classes), instances) in KINDS.into_iter().zip(cases([10, 10, 4, 1], [40, 30, 12, 3]))
    {
        let mut checked = 0;
        for index in 0..instances {
            let draws = &mut stream(60 + poses as u64, index);
            let (made, rows) = positions(draws, poses, points);
            let far = 12.0 * made.linkage.longest_link().max(made.linkage.crank_side());
            let record = solved(&rows, &wide(rows[0].0, far));
            let exact = record.exact.as_ref().expect("exact answers");
            let name = format!("{poses} poses, {points} points, instance {index}");
            assert_eq!((exact.poses, exact.census.classes), (poses, classes), "{name}");
            assert_eq!((exact.completeness, exact.generic), (Completeness::Complete, true), "{name}");
            assert_eq!((exact.census.certified, exact.census.not_told_apart), (classes, 0), "{name}");
            let found = exact.linkages.iter().find(|one| is_of_class(one, &made.linkage));
            let found = found.unwrap_or_else(|| panic!("{name}: the generating linkage is not there"));
            assert!(found.certified.is_some() && found.free_of_defects, "{name}: {found:?}");
            let size = record.problem.resolved.task.points.iter().map(|p| (point(*p) - rows[0].0).norm());
            let size = size.fold(0.0, f64::max);
            for listed in &exact.linkages {
                passes(listed.linkage.four_bar().expect("a four-bar"), listed, &rows, size);
                checked += 1;
            }
            if index == 0 {
                assert_eq!(verify(&record).expect("a problem"), [], "{name}");
            }
        }
        assert!(checked >= cases(25, 100), "{poses} poses: {checked} linkages");
    }
}

#[test]
fn targets_of_random_linkages_with_their_pivots_given_lead_back_to_them() {
    for (poses, points, pivots, classes) in GIVEN {
        let mut checked = 0;
        for index in 0..if classes > 200 { 4 } else { 12 } {
            let draws = &mut stream(80 + (poses + 8 * pivots) as u64, index);
            let (made, rows) = positions(draws, poses, points);
            // With one pivot, now that of the crank and now that of the follower.
            let fixed = [made.linkage.crank_pivot(), made.linkage.follower_pivot()];
            let names: &[(usize, &str)] = match (pivots, index % 2) {
                (2, _) => &[(0, "A"), (1, "B")],
                (_, 0) => &[(0, "A")],
                _ => &[(1, "B")],
            };
            let lines: String = names
                .iter()
                .map(|(i, name)| format!("{name} = [{:?}, {:?}]\n", fixed[*i].re, fixed[*i].im))
                .collect();
            let ratio = "[require]\nlink_ratio_max = 1e6\nlongest_max = \"any\"\n";
            let record = solved(&rows, &format!("{ratio}[design]\n{lines}"));
            let exact = record.exact.as_ref().expect("exact answers");
            let name = format!("{poses} poses, {points} points, {pivots} pivots, instance {index}");
            assert_eq!((exact.poses, exact.pivots, exact.census.classes), (poses, pivots, classes), "{name}");
            assert_eq!((exact.census.certified, exact.census.not_told_apart), (classes, 0), "{name}");
            let found = exact.linkages.iter().find(|one| is_of_class(one, &made.linkage));
            let found = found.unwrap_or_else(|| panic!("{name}: the generating linkage is not there"));
            assert!(found.certified.is_some() && found.free_of_defects, "{name}: {found:?}");
            let size = record.problem.resolved.task.points.iter().map(|p| (point(*p) - rows[0].0).norm());
            let size = size.fold(0.0, f64::max);
            for listed in &exact.linkages {
                passes(listed.linkage.four_bar().expect("a four-bar"), listed, &rows, size);
                let own = [
                    listed.linkage.four_bar().expect("a four-bar").crank_pivot(),
                    listed.linkage.four_bar().expect("a four-bar").follower_pivot(),
                ];
                for (i, _) in names {
                    let off =
                        own.iter().map(|pivot| (pivot - fixed[*i]).norm()).fold(f64::INFINITY, f64::min);
                    assert!(off <= 1e-12 * listed.linkage.longest_link().max(size), "{name}: {off:e}");
                }
                checked += 1;
            }
            if index < 2 {
                assert_eq!(verify(&record).expect("a problem"), [], "{name}");
            }
        }
        assert!(checked >= 12, "{poses} poses, {pivots} pivots: {checked} linkages");
    }
}

#[test]
fn the_shipped_mixtures_have_the_linkages_that_are_known() {
    for name in ["four-poses-two-points", "two-poses-six-points"] {
        let job = || load(&root().join(format!("problems/motion/{name}.toml")), &[]);
        let record = run_on(2, job());
        let expect = job().expect.and_then(|e| e.exact).expect("a census is expected");
        let census = record.exact.as_ref().expect("a census").census;
        let found =
            [census.classes, census.real, census.one_circuit, census.in_order, census.free_of_defects];
        let known =
            [expect.classes, expect.real, expect.one_circuit, expect.in_order, expect.free_of_defects];
        assert_eq!(known, found.map(Some), "{name}");
        assert_eq!(verify(&record).expect("a problem"), [], "{name}");
        assert_eq!(bytes(&run_on(1, job())), bytes(&record), "{name}");
    }
}

#[test]
fn the_order_of_the_targets_changes_defects_and_no_linkage() {
    let (_, rows) = positions(&mut stream(64, 3), 4, 2);
    let mut turned = rows.clone();
    turned.rotate_left(2);
    turned.swap(0, 4);
    let [one, other] = [rows, turned].map(|rows| solved(&rows, "").exact.expect("exact answers"));
    assert_eq!((one.census.real, one.census.one_circuit), (other.census.real, other.census.one_circuit));
    for listed in &one.linkages {
        assert!(
            other.linkages.iter().any(|found| is_near(
                listed.linkage.four_bar().expect("a four-bar"),
                found.linkage.four_bar().expect("a four-bar")
            )),
            "{listed:?}"
        );
    }
}

#[test]
fn auto_takes_five_poses_as_an_exact_problem_and_one_more_as_an_approximate_one() {
    let (_, rows) = positions(&mut stream(65, 1), 5, 0);
    let used = |rows: &[Row]| run_on(2, parse(&text(rows, "")));
    let record = used(&rows);
    assert!(record.exact.is_some() && record.method.used[0] == "continuation", "{:?}", record.method.used);
    let mut more = rows.clone();
    more.push((rows[0].0 + 0.3, None));
    assert!(used(&more).exact.is_none());
}

#[test]
fn targets_in_special_position_are_counted_as_found_and_nothing_hangs() {
    let place = |j: usize| Complex::new(j as f64, (j as f64).powi(2) * 0.2);
    let on_a_line = |j: usize| Complex::new(j as f64, 0.5 * j as f64);
    let turn = |j: usize| 17.0 * j as f64 + (j * j) as f64;
    for (poses, points, classes) in KINDS {
        let row = |j: usize, at: &dyn Fn(usize) -> Complex, angle: &dyn Fn(usize) -> f64| {
            (at(j), (j < poses).then(|| angle(j)))
        };
        let n = poses + points;
        let sets: [(&str, Vec<Row>); 4] = [
            ("on a line", (0..n).map(|j| row(j, &on_a_line, &turn)).collect()),
            ("equal angles", (0..n).map(|j| row(j, &place, &|_| 30.0)).collect()),
            ("symmetric", {
                let at = |j: usize| {
                    Complex::new(j as f64 - 0.5 * (n as f64 - 1.0), ((2 * j) as f64 - n as f64 + 1.0).powi(2))
                };
                (0..n).map(|j| row(j, &at, &|j| 11.0 * (j as f64 - 0.5 * (poses as f64 - 1.0)))).collect()
            }),
            ("half a turn apart", (0..n).map(|j| row(j, &place, &|j| 180.0 * (j % 2) as f64)).collect()),
        ];
        for (name, rows) in sets.into_iter().skip(cases(poses % 2, 0)).step_by(cases(2, 1)) {
            let record = solved(&rows, "time_limit_s = 60\n");
            assert_ne!(record.termination.reason, Reason::TimeLimit, "{poses} {name}");
            let exact = record.exact.as_ref().expect("exact answers");
            assert!(
                exact.census.classes <= classes && exact.census.tracked == classes,
                "{poses} {name}: {:?}",
                exact.census
            );
            assert_eq!(exact.completeness == Completeness::Complete, exact.census.classes == classes);
            assert_eq!(verify(&record).expect("a problem"), [], "{poses} {name}");
        }
    }
}
