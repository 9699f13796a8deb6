//! `docs/seeds.md`: each example of the three seed papers beside our figure, with the errata. The document is
//! made from the figures that the library computes, so it cannot go stale: this test makes it again and
//! compares. To write it after a change of wording: `LINKWRIGHT_WRITE_DOCS=1 cargo test --test tool seeds_document`.

use crate::reference::shipped_linkage;
use linkwright::internals::mechanism::four_bar::loop_closure::{
    Arctangent, IterationOptions, IterationVerdict, LoopRoots, Singularity,
};
use linkwright::internals::mechanism::four_bar::motion::{CrankMotion, LinkageMotion, Motion};
use linkwright::internals::mechanism::{AssemblyMode, CouplerSide, FourBar, NaturalCoordinates};
use std::fmt::Write;

const HEAD: &str = "\
# The seed papers, checked

This project began with three papers. Every example in them is computed here again; where a
table is wrong, the right value is given beside it. This page is made from the library's own figures and compared
by a test (`tests/tool/seeds_document.rs`), so it says what the program does.

- **De Castro**: C. A. De Castro, *Analisis de posicion, velocidad y aceleracion de mecanismos de 4 barras por
  metodos analiticos-numericos* (vector loop, fixed-point iteration; examples 2.1 to 4.2).
- **Romero**: N. N. Romero Nunez, *Analisis de posicion de un mecanismo de cuatro barras utilizando coordenadas
  naturales* (2016; the nine parameters, the closed form (19), four configurations).
- **UTP**: Universidad Tecnologica de Panama, chapter 4 after Norton (graphical, algebraic (4.2d-g), complex).

To see any of it yourself:

```sh
linkwright analyze problems/seeds/de-castro-2-1.toml --angle 90,120,150,180 --omega 5 --method algebraic,complex,fixed-point
linkwright analyze problems/seeds/romero.toml --all-configurations --svg romero.svg
```
";

/// The number of decimals and whether what was printed agrees to them.
fn agrees(printed: f64, decimals: i32, ours: f64) -> bool {
    (printed - ours).abs() <= 0.5 * 10f64.powi(-decimals) * (1.0 + 1e-9)
}

fn moving(linkage: &FourBar, deg: f64, omega: f64) -> LinkageMotion {
    match linkage.motion(deg.to_radians(), CrankMotion::steady(omega)) {
        Motion::Definite(motion) => motion,
        other => panic!("{deg} degrees: {other:?}"),
    }
}

/// Example 2.1 and 2.2: rows (theta2, theta3, theta4, Px, Py) as printed.
fn positions(out: &mut String, linkage: &FourBar, rows: &[[f64; 5]], wrong: &[usize]) {
    out.push_str("| theta2 | theta3 printed | ours | theta4 printed | ours | P printed | P ours | |\n");
    out.push_str("|---|---|---|---|---|---|---|---|\n");
    for (i, [theta2, theta3, theta4, px, py]) in rows.iter().copied().enumerate() {
        let joints = linkage.position(theta2.to_radians()).joints().expect("the example closes");
        let posture = linkage.posture(joints);
        let near = |angle: f64, printed: f64| {
            let deg = angle.to_degrees();
            deg + 360.0 * ((printed - deg) / 360.0).round()
        };
        let near = |angle: f64, printed: f64| zero(near(angle, printed));
        let (ours3, ours4) = (near(posture.coupler_angle, theta3), near(posture.follower_angle, theta4));
        let p = joints.coupler_point;
        assert!(agrees(theta3, 1, ours3) && agrees(theta4, 1, ours4), "row {i}: {ours3} {ours4}");
        let right = agrees(px, 1, p.re) && agrees(py, 1, p.im);
        assert_eq!(right, !wrong.contains(&i), "row {i}: {p}");
        let verdict = if right { "agrees" } else { "**erratum**: P of the table is wrong" };
        writeln!(
            out,
            "| {theta2} | {theta3} | {ours3:.4} | {theta4} | {ours4:.4} | ({px}, {py}) | ({:.3}, {:.3}) | {verdict} |",
            zero(p.re),
            zero(p.im)
        )
        .expect("a string");
    }
}

/// No minus sign before a rounded zero.
fn zero(x: f64) -> f64 {
    if x.abs() < 5e-9 { 0.0 } else { x }
}

/// A table of (name, printed, decimals, ours); all agree.
fn figures(out: &mut String, rows: &[(&str, f64, i32, f64)]) {
    out.push_str("| quantity | printed | ours |\n|---|---|---|\n");
    for (name, printed, decimals, ours) in rows.iter().copied() {
        assert!(agrees(printed, decimals, ours), "{name}: {printed} printed, {ours}");
        let decimals = usize::try_from(decimals).expect("not negative");
        writeln!(out, "| {name} | {printed:.decimals$} | {:.5} |", zero(ours)).expect("a string");
    }
}

fn de_castro(out: &mut String) {
    let first = shipped_linkage("de-castro-2-1");
    out.push_str("\n## De Castro, example 2.1\n\n");
    out.push_str(
        "O2 = (-350, 0), L2 = 700, L3 = 300, L4 = 500, Z1 = 200, beta = 30 degrees; t1 = +1 in all rows.\n\n",
    );
    let printed = [
        [90.0, 258.9, 54.2, 64.9, 510.8],
        [120.0, -34.8, 60.5, -285.1, 417.0],
        [150.0, 30.0, 89.6, -541.3, 160.8],
        [180.0, 100.3, 143.8, -635.1, -189.2],
    ];
    positions(out, &first, &printed, &[1, 2, 3]);
    out.push_str(
        "\nThe angles are right. The coupler points of rows 2 to 4 reuse the coupler angle of row 1: with \
         theta3 = 258.9 degrees in every row the table's P comes out.\n",
    );
    for [theta2, _, _, px, py] in &printed[1..] {
        let theta3 = (258.932_8f64 + 30.0).to_radians();
        let crank = theta2.to_radians();
        let p = [700.0 * crank.cos() + 200.0 * theta3.cos(), 700.0 * crank.sin() + 200.0 * theta3.sin()];
        assert!(agrees(*px, 1, p[0]) && agrees(*py, 1, p[1]), "the erratum's explanation: {p:?}");
    }
    out.push_str("\n## De Castro, example 2.2\n\nO2 = (1000, 0), L2 = L4 = 500, L3 = 1000, Z1 = 200, beta = 30 degrees: a parallelogram.\n\n");
    let second = shipped_linkage("de-castro-2-2");
    let printed = [
        [0.0, 0.0, 0.0, 673.2, 100.0],
        [30.0, 0.0, 30.0, 606.2, 350.0],
        [90.0, 0.0, 90.0, 173.2, 600.0],
        [150.0, 0.0, 150.0, -259.8, 350.0],
    ];
    positions(out, &second, &printed, &[]);
    assert!(matches!(second.motion(0.0, CrankMotion::steady(5.0)), Motion::Singular(_)));
    out.push_str(
        "\nIt is a change point: at 0 and 180 degrees it lies flat. The position is known there, velocities are \
         not decided by the crank, and `analyze` says `singular` instead of a number.\n",
    );

    out.push_str("\n## De Castro, examples 3.1 and 4.1\n\nExample 2.1 at theta2 = 120 degrees, omega2 = 5 rad/s, alpha2 = 0 (metres).\n\n");
    let m = moving(&first, 120.0, 5.0);
    let metres = 1e-3;
    figures(
        out,
        &[
            ("omega3, rad/s", 10.10, 2, m.coupler.speed_rad_s),
            ("omega4, rad/s", 2.99, 2, m.follower.speed_rad_s),
            ("vAx, m/s", -3.03, 2, m.crank_pin.velocity.re * metres),
            ("vAy, m/s", -1.75, 2, m.crank_pin.velocity.im * metres),
            ("vBx, m/s", -1.30, 2, m.follower_pin.velocity.re * metres),
            ("vBy, m/s", 0.74, 2, m.follower_pin.velocity.im * metres),
            ("vPx, m/s", -2.86, 2, m.coupler_point.velocity.re * metres),
            ("vPy, m/s", 0.26, 2, m.coupler_point.velocity.im * metres),
            ("alpha3, rad/s2", 5.31, 2, m.coupler.acceleration_rad_s2),
            ("alpha4, rad/s2", 30.46, 2, m.follower.acceleration_rad_s2),
            ("aAx, m/s2", 8.8, 1, m.crank_pin.acceleration.re * metres),
            ("aAy, m/s2", -15.2, 1, m.crank_pin.acceleration.im * metres),
            ("aBx, m/s2", -15.5, 1, m.follower_pin.acceleration.re * metres),
            ("aBy, m/s2", 3.6, 1, m.follower_pin.acceleration.im * metres),
            ("aPx, m/s2", -11.5, 1, m.coupler_point.acceleration.re * metres),
            ("aPy, m/s2", -12.4, 1, m.coupler_point.acceleration.im * metres),
        ],
    );
    out.push_str("\n## De Castro, examples 3.2 and 4.2\n\nExample 2.2 at theta2 = 60 degrees, omega2 = 5 rad/s, alpha2 = 0 (metres).\n\n");
    let m = moving(&second, 60.0, 5.0);
    let mut rows = vec![
        ("omega3, rad/s", 0.0, 2, m.coupler.speed_rad_s),
        ("omega4, rad/s", 5.0, 2, m.follower.speed_rad_s),
        ("alpha3, rad/s2", 0.0, 2, m.coupler.acceleration_rad_s2),
        ("alpha4, rad/s2", 0.0, 2, m.follower.acceleration_rad_s2),
    ];
    for (x, y, point) in
        [("vAx", "vAy", m.crank_pin), ("vBx", "vBy", m.follower_pin), ("vPx", "vPy", m.coupler_point)]
    {
        rows.push((x, -2.17, 2, point.velocity.re * metres));
        rows.push((y, 1.25, 2, point.velocity.im * metres));
    }
    for (x, y, point) in
        [("aAx", "aAy", m.crank_pin), ("aBx", "aBy", m.follower_pin), ("aPx", "aPy", m.coupler_point)]
    {
        rows.push((x, -6.3, 1, point.acceleration.re * metres));
        rows.push((y, -10.8, 1, point.acceleration.im * metres));
    }
    // -6.25 is printed as -6.3: half up, away from zero.
    figures(out, &rows);

    out.push_str("\n## De Castro, equations 4 and 5: the fixed-point iteration\n\n");
    out.push_str(
        "Example 2.1 by `--method fixed-point` (atan2, tolerance 1e-12 rad, start theta3 = 1 rad):\n\n",
    );
    out.push_str("| theta2 | verdict | rounds | distance of P from the closed form |\n|---|---|---|---|\n");
    for deg in [90.0f64, 120.0, 150.0, 180.0] {
        let run = first.close_by_iteration(deg.to_radians(), &IterationOptions::default());
        let IterationVerdict::Converged(root) = run.verdict else { panic!("{deg}: {run:?}") };
        let closed = first.position_with(deg.to_radians(), root.assembly).joints().expect("closed");
        let off = (closed.coupler_point - root.joints.coupler_point).norm();
        assert!(off < 1e-6, "{deg}: {off}");
        let t1 = root.assembly.sign();
        writeln!(out, "| {deg} | converged to t1 = {t1:+} | {} | below 1e-6 mm |", run.iterations)
            .expect("a string");
    }
    let printed = IterationOptions { arctangent: Arctangent::OfQuotient, ..IterationOptions::default() };
    let run = first.close_by_iteration(90f64.to_radians(), &printed);
    assert!(matches!(run.verdict, IterationVerdict::FalsePoint | IterationVerdict::Cycling), "{run:?}");
    writeln!(
        out,
        "\n**Erratum**: with the arctangent of a quotient, as equations 4 and 5 are printed, the iteration at 90 \
         degrees ends at theta3 = {:.2}, theta4 = {:.2} degrees, where the loop misses closure by {:.0} mm: it \
         stands still, but not at a position. The quadrants need atan2, and a small step is no proof: the \
         closure has to be checked. With atan2 a round shrinks the error by cos^2(theta3 - theta4), so it is \
         slow near a toggle.",
        run.coupler_angle.to_degrees(),
        run.follower_angle.to_degrees(),
        run.residual
    )
    .expect("a string");
}

fn romero(out: &mut String) {
    out.push_str("\n## Romero's example\n\na = 2, b = c = d = e = 5, A = (0, 0), B = (4, 1): four configurations (his figure 3), here at 90 degrees.\n\n");
    let own = shipped_linkage("romero").natural_coordinates();
    out.push_str("| t1 | t2 | C | D | P | (5)-(8) hold within |\n|---|---|---|---|---|---|\n");
    for (assembly, side) in [
        (AssemblyMode::Plus, CouplerSide::Plus),
        (AssemblyMode::Minus, CouplerSide::Minus),
        (AssemblyMode::Plus, CouplerSide::Minus),
        (AssemblyMode::Minus, CouplerSide::Plus),
    ] {
        let linkage = FourBar::new(NaturalCoordinates { assembly, side, ..own }).expect("a linkage");
        let j = linkage.position(90f64.to_radians()).joints().expect("the crank turns fully");
        let miss = [
            (j.follower_pin - j.crank_pin).norm() - 5.0,
            (j.follower_pin - linkage.follower_pivot()).norm() - 5.0,
            (j.coupler_point - j.crank_pin).norm() - 5.0,
            (j.coupler_point - j.follower_pin).norm() - 5.0,
        ];
        assert!(miss.iter().all(|m| m.abs() <= 8.0 * f64::EPSILON * 5.0), "{miss:?}");
        let show =
            |z: linkwright::internals::mechanism::Complex| format!("({:.5}, {:.5})", zero(z.re), zero(z.im));
        writeln!(
            out,
            "| {:+} | {:+} | {} | {} | {} | 1e-14 |",
            assembly.sign(),
            side.sign(),
            show(j.crank_pin),
            show(j.follower_pin),
            show(j.coupler_point)
        )
        .expect("a string");
    }
    out.push_str("\n**Erratum**: below (4) the text speaks of the constraints (5), (6) and (7); the four distance constraints are (5) to (8).\n");
    let differs = shipped_linkage("romero-condition-20");
    let condition = differs.assembly_condition(180f64.to_radians()).expect("C is not on B");
    assert!(condition.necessary() && !condition.sufficient());
    assert!(differs.position(180f64.to_radians()).joints().is_none());
    writeln!(
        out,
        "\n**Erratum**: condition (20), (b^2 + d^2)/(l1^2 + l2^2) >= 1, is necessary but not sufficient. For \
         a = 1, b = c = 2, d = e = 5, A = (0, 0), B = (5, 0) at 180 degrees the ratio is {:.3}, and still the \
         loop is open: b^2 - l1^2 = {:.2}. What is needed is that each triangle closes: b^2 >= l1^2 and \
         d^2 >= l2^2. `analyze` prints both.",
        condition.ratio.expect("defined"),
        condition.loop_gap
    )
    .expect("a string");
}

fn utp(out: &mut String) {
    out.push_str("\n## The UTP chapter\n\nThe complex-number example: a = 2, b = 3, c = 4, d = 5, theta2 = 60 degrees.\n\n");
    let linkage = shipped_linkage("utp-complex");
    let LoopRoots::Closed(roots) = linkage.close_by_complex_numbers(60f64.to_radians()) else {
        panic!("open")
    };
    let printed = [[39.2750, 114.7975], [-86.1015, -161.6240]];
    out.push_str("| root | theta3 printed | ours | theta4 printed | ours | algebraic method |\n|---|---|---|---|---|---|\n");
    let LoopRoots::Closed(algebraic) = linkage.close_by_algebra(60f64.to_radians()) else { panic!("open") };
    for (root, [theta3, theta4]) in roots.iter().zip(printed) {
        let (ours3, ours4) = (root.coupler_angle.to_degrees(), root.follower_angle.to_degrees());
        assert!(agrees(theta3, 4, ours3) && agrees(theta4, 4, ours4), "{ours3} {ours4}");
        let twin = algebraic.iter().find(|r| r.assembly == root.assembly).expect("both roots");
        assert!((twin.joints.follower_pin - root.joints.follower_pin).norm() < 1e-12);
        writeln!(
            out,
            "| t1 = {:+} | {theta3} | {ours3:.5} | {theta4} | {ours4:.5} | agrees within 1e-12 |",
            root.assembly.sign()
        )
        .expect("a string");
    }
    let aligned = shipped_linkage("de-castro-2-1").close_by_algebra(120f64.to_radians());
    assert_eq!(aligned, LoopRoots::Singular(Singularity::CrankPinOverFollowerPivot));
    out.push_str(
        "\n**Errata** of the slides: the MATLAB line for P misplaces a parenthesis (P = Ay^2/(Ax - d)^2 + 1 is \
         meant) and the one for By drops one (By = (-Q +- sqrt(Q^2 - 4 P R))/(2 P)); `ax` stands for `Ax`; (4.2g) \
         needs atan2; \"conj(conj Z) != 1/Z\" should read conj(Z) != 1/Z.\n\n\
         **Limit**: the algebraic method divides by Ax - d. Where the crank pin stands straight over the follower \
         pivot, as in De Castro's example 2.1 at 120 degrees, it has no answer though the linkage has a position; \
         the program says `singular: Ax = d`. The quadratic in complex numbers fails only where C lies on B.\n",
    );
}

#[test]
fn the_seed_papers_page_says_what_the_library_computes() {
    let mut page = HEAD.to_string();
    de_castro(&mut page);
    romero(&mut page);
    utp(&mut page);
    let path = crate::common::root().join("docs/seeds.md");
    if std::env::var_os("LINKWRIGHT_WRITE_DOCS").is_some() {
        std::fs::write(&path, &page).expect("the page can be written");
    }
    let stands = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        stands == page,
        "docs/seeds.md is not what the library computes; write it with\n  LINKWRIGHT_WRITE_DOCS=1 cargo test --test seeds_document"
    );
}
