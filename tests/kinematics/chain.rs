//! Compound mechanisms against the four-bar, independent solves, closed forms and central differences.

use linkwright::internals::files::linkage_file;
use linkwright::internals::files::schema::{SchemaKind, schema};
use linkwright::internals::mechanism::Linkage;
use linkwright::internals::mechanism::Unit;
use linkwright::internals::mechanism::chain::{
    ChainArc, ChainFault, ChainInput, ChainPlace, Outcome, PointId, SliderLine, Stage,
};
use linkwright::internals::mechanism::{
    AssemblyMode, Chain, ChainBuilder, Complex, CouplerSide, FourBar, NaturalCoordinates,
};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use std::path::Path;

use AssemblyMode::{Minus, Plus};

fn shipped(name: &str) -> Chain {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("problems/linkages/{name}.toml"));
    match linkage_file::load_any(&path).unwrap_or_else(|d| panic!("{d}")).linkage {
        Linkage::Chain(chain) => *chain,
        _ => panic!("{name} is no chain"),
    }
}

const CHAINS: [&str; 5] =
    ["jansen-leg", "watt-six-bar", "stephenson-six-bar", "slider-crank-offset", "quick-return"];

fn id(chain: &Chain, name: &str) -> PointId {
    chain.point_id(name).unwrap_or_else(|| panic!("no point {name}"))
}

/// All points at an angle; the chain must close.
fn points(chain: &Chain, angle: f64) -> Vec<Complex> {
    let mut pose = chain.pose();
    assert_eq!(chain.position(angle, &mut pose), Outcome::Closed, "at {angle}");
    pose.known().to_vec()
}

fn as_chain(linkage: &FourBar) -> Chain {
    let p = linkage.natural_coordinates();
    ChainBuilder::new()
        .pivot("A", p.crank_pivot)
        .pivot("B", p.follower_pivot)
        .crank("A", "C", p.crank)
        .dyad("D", ["C", "B"], [p.coupler, p.follower], p.assembly)
        .point_at_distances("P", ["C", "D"], [p.crank_side, p.follower_side], p.side)
        .build()
        .unwrap()
}

proptest! {
    #[test]
    fn a_four_bar_is_a_chain_to_the_bit(
        pivots in prop::array::uniform4(-10.0_f64..10.0),
        links in prop::array::uniform3(0.1_f64..20.0),
        offset in prop::array::uniform2(-10.0_f64..10.0),
        plus in any::<bool>(),
        angle in -7.0_f64..7.0,
    ) {
        let [a, b, c] = links;
        let linkage = FourBar::with_coupler_offset(
            [Complex::new(pivots[0], pivots[1]), Complex::new(pivots[2], pivots[3])],
            [a, b, c],
            Complex::new(offset[0], offset[1]),
            if plus { Plus } else { Minus },
        ).map_err(|e| TestCaseError::reject(e.to_string()))?;
        let chain = as_chain(&linkage);
        let mut pose = chain.pose();
        let outcome = chain.position(angle, &mut pose);
        match linkage.position(angle).joints() {
            None => prop_assert_eq!(outcome, Outcome::Open { stage: 0 }),
            Some(joints) => {
                prop_assert_eq!(outcome, Outcome::Closed);
                let at = |name| pose.point(id(&chain, name)).unwrap();
                prop_assert_eq!(at("C"), joints.crank_pin);
                prop_assert_eq!(at("D"), joints.follower_pin);
                // The chain subtracts C from the rounded D where the kernel still has D - C.
                let z = linkage.coupler_ratio().norm();
                let scale = (1.0 + z) * (at("C").norm() + at("D").norm());
                prop_assert!((at("P") - joints.coupler_point).norm() <= 8.0 * f64::EPSILON * scale);
            }
        }
    }
}

/// Newton's method on |i j| = length for pairs of points, from a start; the first `fixed` points stay.
fn newton(mut points: Vec<Complex>, fixed: usize, bars: &[(usize, usize, f64)]) -> Vec<Complex> {
    let n = points.len() - fixed;
    assert!(bars.len() == 2 * n, "as many bars as coordinates");
    for _ in 0..12 {
        let mut jacobian = DMatrix::<f64>::zeros(2 * n, 2 * n);
        let mut residual = DVector::<f64>::zeros(2 * n);
        for (row, &(i, j, length)) in bars.iter().enumerate() {
            let v = points[j] - points[i];
            residual[row] = v.norm_sqr() - length * length;
            for (k, sign) in [(i, -2.0), (j, 2.0)] {
                if k >= fixed {
                    jacobian[(row, 2 * (k - fixed))] += sign * v.re;
                    jacobian[(row, 2 * (k - fixed) + 1)] += sign * v.im;
                }
            }
        }
        let step = jacobian.lu().solve(&residual).expect("not at a toggle");
        for k in 0..n {
            points[fixed + k] -= Complex::new(step[2 * k], step[2 * k + 1]);
        }
    }
    points
}

/// Follows a chain by Newton on all bars at once, each position from the one before.
fn follows_newton(name: &str, bars: &[(&str, &str, f64)]) {
    let chain = shipped(name);
    let pivots = chain.source().pivots.len();
    let bars: Vec<_> =
        bars.iter().map(|(i, j, l)| (id(&chain, i).index(), id(&chain, j).index(), *l)).collect();
    // A point on the line of two others is left out: two distances don't cross there.
    let count = pivots + 1 + bars.len() / 2;
    let mut found = points(&chain, 0.0);
    found.truncate(count);
    for i in 0..720 {
        let expected = points(&chain, TAU * f64::from(i) / 720.0);
        found[pivots] = expected[pivots];
        found = newton(found, pivots + 1, &bars);
        for (f, e) in found.iter().zip(&expected) {
            // Coordinates of some 100, rounding amplified by at most 1e3 through the transmission angles.
            assert!((f - e).norm() < 1e3 * f64::EPSILON * 100.0, "{name} at {i}: {f} {e}");
        }
    }
}

#[test]
fn a_watt_six_bar_is_what_newton_finds() {
    follows_newton(
        "watt-six-bar",
        &[
            ("B", "C", 60.0),
            ("D", "C", 45.0),
            ("B", "E", 50.0),
            ("C", "E", (20.0_f64 * 20.0 + 30.0 * 30.0).sqrt()),
            ("D", "F", (75.0_f64 * 75.0 + 100.0).sqrt()),
            ("C", "F", (30.0_f64 * 30.0 + 100.0).sqrt()),
            ("E", "G", 45.0),
            ("F", "G", 40.0),
        ],
    );
}

#[test]
fn a_stephenson_six_bar_is_what_newton_finds() {
    follows_newton(
        "stephenson-six-bar",
        &[
            ("B", "C", 60.0),
            ("D", "C", 45.0),
            ("B", "E", 50.0),
            ("C", "E", 35.0),
            ("E", "G", 55.0),
            ("H", "G", 50.0),
        ],
    );
}

#[test]
fn the_jansen_leg_walks_as_published() {
    let chain = shipped("jansen-leg");
    let n = 36_000;
    let path: Vec<Complex> = chain.path(chain.trace(), n).into_iter().map(|p| p.unwrap()).collect();
    let extent = |f: fn(&Complex) -> f64| {
        path.iter().map(f).fold((f64::MAX, f64::MIN), |(lo, hi), x| (lo.min(x), hi.max(x)))
    };
    let ((left, right), (low, high)) = (extent(|p| p.re), extent(|p| p.im));
    assert!((right - left - 67.908).abs() < 1e-3, "stride {}", right - left);
    assert!((high - low - 22.457).abs() < 1e-3, "lift {}", high - low);
    assert!((low + 91.834).abs() < 1e-3, "lowest {low}");
    let down = path.iter().filter(|p| p.im < low + 2.0).count() as f64 / n as f64;
    assert!((down - 0.52).abs() < 0.005, "on the ground {down}");
    assert!(chain.input(720).is_full());
    // Every bar has its length, from the points alone.
    for i in 0..360 {
        let at = points(&chain, f64::from(i).to_radians());
        for (from, to, length) in [
            ("A", "B", 15.0),
            ("B", "X", 50.0),
            ("D", "X", 41.5),
            ("D", "Y", 40.1),
            ("X", "Y", 55.8),
            ("D", "W", 39.3),
            ("B", "W", 61.9),
            ("Y", "V", 39.4),
            ("V", "W", 36.7),
            ("V", "F", 65.7),
            ("W", "F", 49.0),
        ] {
            let found = (at[id(&chain, from).index()] - at[id(&chain, to).index()]).norm();
            assert!((found - length).abs() < 64.0 * f64::EPSILON * 100.0, "{from}{to} {found}");
        }
    }
}

#[test]
fn an_offset_slider_crank_is_its_closed_form() {
    let chain = shipped("slider-crank-offset");
    let (r, l, e, omega, alpha) = (30.0, 90.0, 10.0, 5.0, -3.0);
    let mut motion = chain.motion();
    for i in 0..720 {
        let phi = TAU * f64::from(i) / 720.0;
        let (sin, cos) = phi.sin_cos();
        assert_eq!(chain.move_at(phi, omega, alpha, &mut motion), Outcome::Closed);
        let h: f64 = e - r * sin;
        let w = (l * l - h * h).sqrt();
        let x = r * cos + w;
        // w w' = -h h', h' = -r cos phi phi'.
        let h1 = -r * cos;
        let w1 = -h * h1 / w;
        let w2 = (-h1 * h1 - h * (r * sin) - w1 * w1) / w;
        let (x1, x2) = (-r * sin + w1, -r * cos + w2);
        let c = chain.trace();
        let near = |found: Complex, re: f64, im: f64, scale: f64| {
            assert!(
                (found - Complex::new(re, im)).norm() <= 64.0 * f64::EPSILON * scale,
                "{found} {re} {im}"
            );
        };
        near(motion.point(c).unwrap(), x, e, l + r);
        near(motion.velocity(c).unwrap(), x1 * omega, 0.0, (l + r) * omega);
        near(motion.acceleration(c).unwrap(), x2 * omega * omega + x1 * alpha, 0.0, (l + r) * omega * omega);
    }
}

#[test]
fn a_quick_return_has_the_time_ratio_of_its_closed_form() {
    let chain = shipped("quick-return");
    let mut motion = chain.motion();
    let mut speed = |phi: f64| {
        assert_eq!(chain.move_at(phi, 1.0, 0.0, &mut motion), Outcome::Closed);
        motion.velocity(chain.trace()).unwrap().re
    };
    // The dead points of the ram by bisection of its speed.
    let mut zero = |mut low: f64, mut high: f64| {
        let below = speed(low);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if speed(middle) * below > 0.0 { low = middle } else { high = middle }
        }
        low
    };
    let (first, second) = (zero(-1.0, 0.0), zero(PI, PI + 1.0));
    // Crank square to the rocker: 60 degrees of crank each side of the line O A below A.
    assert!((first + PI / 6.0).abs() < 1e-12 && (second - 7.0 * PI / 6.0).abs() < 1e-12, "{first} {second}");
    let out = second - first;
    assert!((out / (TAU - out) - 2.0).abs() < 1e-11, "{}", out / (TAU - out));
    let at = |phi: f64| points(&chain, phi)[chain.trace().index()].re;
    assert!((at(first) - at(second) - 250.0).abs() < 1e-10, "the stroke is 2 * 250 sin 30");
}

/// A chain with a line on a link and guides with offset, on both sides.
fn sliding() -> Chain {
    ChainBuilder::new()
        .pivot("A", [1.0, 2.0])
        .pivot("O", [0.0, -3.0])
        .crank("A", "B", 2.0)
        .stage(Stage::Guide {
            joint: "E".into(),
            pivot: "O".into(),
            block: "B".into(),
            at: [4.0, 1.0],
            offset: 0.7,
            side: Plus,
        })
        .stage(Stage::Guide {
            joint: "F".into(),
            pivot: "O".into(),
            block: "B".into(),
            at: [4.0, 1.0],
            offset: -0.4,
            side: Minus,
        })
        .stage(Stage::Slider {
            joint: "G".into(),
            from: "B".into(),
            length: 9.0,
            line: SliderLine::OnLink { along: ["O".into(), "E".into()], offset: 0.3 },
            side: Plus,
        })
        .point("K", ["B", "G"], [3.0, -1.0])
        .slider("L", "K", 12.0, [0.0, 1.0], 0.4, Minus)
        .build()
        .unwrap()
}

#[test]
fn velocities_and_accelerations_are_the_central_differences() {
    let mut chains: Vec<Chain> = CHAINS.iter().map(|name| shipped(name)).collect();
    chains.push(sliding());
    let (omega, alpha, h) = (1.7, -2.3, 1e-4);
    for (which, chain) in chains.iter().enumerate() {
        let mut motion = chain.motion();
        for i in 0..360 {
            let phi = TAU * (f64::from(i) + 0.3) / 360.0;
            assert_eq!(
                chain.move_at(phi, omega, alpha, &mut motion),
                Outcome::Closed,
                "chain {which} at {phi}"
            );
            let at = |t: f64| points(chain, phi + omega * t + 0.5 * alpha * t * t);
            let (m2, m, o, p, p2) = (at(-2.0 * h), at(-h), at(0.0), at(h), at(2.0 * h));
            for (k, name) in chain.names().iter().enumerate() {
                let v = (m2[k] - m[k] * 8.0 + p[k] * 8.0 - p2[k]) / (12.0 * h);
                let a = (-m2[k] + m[k] * 16.0 - o[k] * 30.0 + p[k] * 16.0 - p2[k]) / (12.0 * h * h);
                let (found_v, found_a) = (
                    motion.velocity(id(chain, name)).unwrap(),
                    motion.acceleration(id(chain, name)).unwrap(),
                );
                // Rounding: 1e2 * eps / h = 2e-10 and 1e2 * eps / h^2 = 2e-6, amplified; truncation h^4 is less.
                assert!(
                    (v - found_v).norm() < 1e-8 * (1.0 + v.norm()) * 10.0,
                    "{which} {name} {v} {found_v}"
                );
                assert!((a - found_a).norm() < 2e-4 * (1.0 + a.norm()), "{which} {name} {a} {found_a}");
            }
        }
    }
}

#[test]
fn lines_on_links_and_offset_guides_keep_their_constraints() {
    let chain = sliding();
    let cross = |x: Complex, y: Complex| x.re * y.im - x.im * y.re;
    for i in 0..360 {
        let at = points(&chain, f64::from(i).to_radians());
        let p = |name| at[id(&chain, name).index()];
        let tolerance = 64.0 * f64::EPSILON * 20.0;
        for (joint, offset, ahead) in [("E", 0.7, 1.0), ("F", -0.4, -1.0)] {
            let u = (p(joint) - p("O")) / Complex::new(4.0, 1.0);
            assert!((u.norm() - 1.0).abs() < tolerance);
            let block = p("B") - p("O");
            assert!((cross(u, block) - offset).abs() < tolerance);
            assert!((u.conj() * block).re * ahead > 0.0);
        }
        let along = (p("E") - p("O")) / 17f64.sqrt();
        assert!((cross(along, p("G") - p("O")) - 0.3).abs() < tolerance);
        assert!(((p("G") - p("B")).norm() - 9.0).abs() < tolerance);
        let line = Complex::from_polar(1.0, 0.4);
        assert!(cross(line, p("L") - Complex::new(0.0, 1.0)).abs() < tolerance);
    }
}

#[test]
fn a_whitworth_guide_turns_fully_with_its_crank() {
    // The pivot of the guide lies inside the crank's circle: time ratio by the chord through it.
    let chain = ChainBuilder::new()
        .pivot("A", [0.0, 0.0])
        .pivot("O", [0.0, -1.0])
        .crank("A", "B", 2.0)
        .guide("E", "O", "B", [3.0, 0.0])
        .build()
        .unwrap();
    assert!(chain.input(360).is_full());
    let heading = |phi: f64| (points(&chain, phi)[3] - Complex::new(0.0, -1.0)).arg();
    // The guide is level where the block is: sin phi = -1/2.
    assert!(heading(-PI / 6.0).abs() < 1e-15 && (heading(-5.0 * PI / 6.0).abs() - PI).abs() < 1e-15);
}

#[test]
fn an_open_stage_is_named_and_points_before_it_are_known() {
    let chain = ChainBuilder::new()
        .pivot("A", [0.0, 0.0])
        .pivot("D", [10.0, 0.0])
        .crank("A", "B", 2.0)
        .dyad("C", ["B", "D"], [10.0, 6.0], Plus)
        .dyad("G", ["C", "A"], [1.0, 1.0], Plus)
        .build()
        .unwrap();
    let mut motion = chain.motion();
    assert_eq!(chain.move_at(1.0, 1.0, 0.0, &mut motion), Outcome::Open { stage: 1 });
    assert!(motion.velocity(id(&chain, "C")).is_some() && motion.point(id(&chain, "C")).is_some());
    assert!(motion.velocity(id(&chain, "G")).is_none() && motion.point(id(&chain, "G")).is_none());
    assert_eq!(chain.input(360), ChainInput::Never);
    assert_eq!(chain.joint_of(1), Some(id(&chain, "G")));
    for (angle, omega) in [(f64::NAN, 1.0), (f64::INFINITY, 1.0), (0.0, f64::NAN), (0.0, 1e300)] {
        assert_eq!(chain.move_at(angle, omega, 0.0, &mut motion), Outcome::InputNotUsable);
        assert!(motion.velocity(id(&chain, "B")).is_none());
    }
}

#[test]
fn a_toggle_has_a_position_and_no_velocity() {
    // A parallelogram lies flat at 0 and pi.
    let chain = ChainBuilder::new()
        .pivot("A", [0.0, 0.0])
        .pivot("D", [4.0, 0.0])
        .crank("A", "B", 1.0)
        .dyad("C", ["B", "D"], [4.0, 1.0], Plus)
        .point("P", ["B", "C"], [2.0, 1.0])
        .build()
        .unwrap();
    let mut motion = chain.motion();
    for angle in [0.0, PI, TAU, -PI] {
        assert_eq!(chain.move_at(angle, 1.0, 0.0, &mut motion), Outcome::Singular { stage: 0 }, "{angle}");
        assert!(motion.point(chain.trace()).is_some());
        assert!(motion.velocity(id(&chain, "B")).is_some() && motion.velocity(chain.trace()).is_none());
    }
    // A rod square to its slider's line; a block as far from the pivot as its guide's offset.
    let slider = ChainBuilder::new()
        .pivot("A", [0.0, 0.0])
        .crank("A", "B", 3.0)
        .slider("C", "B", 5.0, [0.0, -2.0], 0.0, Plus)
        .build()
        .unwrap();
    let mut motion = slider.motion();
    assert_eq!(slider.move_at(PI / 2.0, 1.0, 0.0, &mut motion), Outcome::Singular { stage: 0 });
    assert!((motion.point(slider.trace()).unwrap() - Complex::new(0.0, -2.0)).norm() < 1e-5);
}

#[test]
fn points_that_coincide_are_singular_and_never_nan() {
    // The crank's joint passes over D: with equal links every direction closes, with others none.
    for (lengths, expected) in
        [([3.0, 3.0], Outcome::Singular { stage: 0 }), ([3.0, 2.0], Outcome::Open { stage: 0 })]
    {
        let chain = ChainBuilder::new()
            .pivot("A", [0.1, 0.2])
            .pivot("D", [0.1, 2.2])
            .crank("A", "B", 2.0)
            .dyad("C", ["B", "D"], lengths, Plus)
            .build()
            .unwrap();
        let mut pose = chain.pose();
        assert_eq!(chain.position(PI / 2.0, &mut pose), expected);
        assert!(pose.point(chain.trace()).is_none());
    }
    let guide = ChainBuilder::new()
        .pivot("A", [0.0, 0.0])
        .pivot("O", [0.0, 2.0])
        .crank("A", "B", 2.0)
        .guide("E", "O", "B", [1.0, 0.0])
        .build()
        .unwrap();
    let mut motion = guide.motion();
    assert_eq!(guide.move_at(PI / 2.0, 1.0, 0.0, &mut motion), Outcome::Singular { stage: 0 });
    for i in 0..3600 {
        let outcome = guide.move_at(PI / 2.0 + f64::from(i - 1800) * 1e-15, 1e6, 1e6, &mut motion);
        for name in guide.names() {
            if let Some(a) = motion.acceleration(id(&guide, name)) {
                assert!(a.re.is_finite() && a.im.is_finite(), "{outcome:?}");
            }
        }
    }
}

#[test]
fn the_input_range_of_a_four_bar_is_its_mobility() {
    // Non-Grashof: the ends are where |CB| = b + c.
    let linkage = FourBar::new(NaturalCoordinates {
        crank_pivot: [0.0, 0.0],
        follower_pivot: [6.0, 0.0],
        crank: 4.0,
        coupler: 3.0,
        follower: 3.5,
        crank_side: 2.0,
        follower_side: 2.0,
        assembly: Plus,
        side: CouplerSide::Plus,
    })
    .unwrap();
    let chain = as_chain(&linkage);
    let ChainInput::Arcs(arcs) = chain.input(720) else { panic!("it rocks") };
    let limit = ((36.0_f64 + 16.0 - 6.5 * 6.5) / 48.0).acos();
    let [ChainArc { from, to }] = arcs[..] else { panic!("{arcs:?}") };
    // On either side the first stage opens.
    for beside in [from - 1e-9, to + 1e-9] {
        assert_eq!(chain.position(beside, &mut chain.pose()), Outcome::Open { stage: 0 });
    }
    // Within the tolerance for flat triangles, 1e-12 of b^2.
    assert!((from - (TAU - limit)).abs() < 1e-10 && (to - TAU - limit).abs() < 1e-10, "{from} {to} {limit}");
}

fn base() -> ChainBuilder {
    ChainBuilder::new().pivot("A", [0.0, 0.0]).pivot("D", [9.0, 0.0]).crank("A", "B", 2.0)
}

#[test]
fn errors_name_the_stage_the_key_and_the_point() {
    let dyad = |joint: &str, from, lengths| base().dyad(joint, from, lengths, Plus).build().unwrap_err();
    let told = |chain: ChainBuilder| chain.build().unwrap_err().to_string();
    assert_eq!(
        dyad("C", ["B", "E"], [1.0, 1.0]).to_string(),
        "stage 1, \"C\", from: there is no point \"E\""
    );
    assert_eq!(dyad("B", ["B", "D"], [1.0, 1.0]).fault, ChainFault::DuplicateName("B".into()));
    let error = dyad("C", ["B", "D"], [1.0, f64::NAN]);
    assert!(matches!(error.fault, ChainFault::NotFinite(value) if value.is_nan()));
    assert_eq!((error.place, error.key, error.index), (ChainPlace::Stage(0), "lengths", Some(1)));
    assert_eq!(dyad("C", ["B", "D"], [0.0, 1.0]).fault, ChainFault::LengthNotPositive(0.0));
    assert_eq!(dyad("C", ["B", "B"], [1.0, 1.0]).fault, ChainFault::SamePoint("B".into()));
    assert!(matches!(
        dyad("C", ["C", "B"], [1.0; 2]).fault,
        ChainFault::ForwardReference { itself: true, .. }
    ));
    assert!(matches!(dyad("a.b", ["D", "B"], [1.0; 2]).fault, ChainFault::BadName { .. }));
    assert_eq!(
        told(base().point("P", ["B", "D"], [1.0, 0.0])),
        "stage 1, \"P\", on: \"B\" and \"D\" are not on one link: their distance changes"
    );
    assert!(
        told(base().dyad("C", ["B", "E"], [1.0; 2], Plus).dyad("E", ["B", "D"], [1.0; 2], Plus))
            .ends_with("\"E\" is not known yet: it is made further down")
    );
    let impossible = base().point_at_distances("P", ["A", "B"], [0.5, 0.5], CouplerSide::Plus);
    assert!(matches!(impossible.build().unwrap_err().fault, ChainFault::NoTriangle { base: 2.0, .. }));
    assert!(matches!(base().guide("E", "D", "B", [0.0; 2]).build().unwrap_err().fault, ChainFault::NoLength));
    assert!(matches!(base().trace("Q").build().unwrap_err().place, ChainPlace::Chain));
    let no_pivot = ChainBuilder::new().crank("A", "B", 1.0).build().unwrap_err();
    assert!(matches!((no_pivot.place, no_pivot.fault), (ChainPlace::Crank, ChainFault::NotAPivot { .. })));
    assert!(base().build().is_ok());
}

#[test]
fn a_chain_file_is_read_in_the_order_in_which_it_stands() {
    let chain = shipped("watt-six-bar");
    assert_eq!(chain.names(), ["A", "D", "B", "C", "E", "F", "G", "P"]);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/linkages/quick-return.toml");
    let file = linkage_file::load_any(&path).unwrap();
    assert_eq!((file.name.as_str(), file.unit), ("quick-return", Some(Unit::Mm)));
    let refused = linkage_file::load(&path).unwrap_err().to_string();
    assert!(refused.contains("a chain is not a four-bar"), "{refused}");
    let hoeken = Path::new(env!("CARGO_MANIFEST_DIR")).join("problems/linkages/hoeken.toml");
    assert!(matches!(linkage_file::load_any(&hoeken).unwrap().linkage, Linkage::FourBar(_)));
    let schema = schema(SchemaKind::Linkage);
    for (table, key) in [("ChainDyad", "lengths"), ("ChainPoint", "at"), ("ChainGuide", "block")] {
        let definition = &schema["$defs"][table];
        assert!(definition["properties"][key].is_object(), "{table}: {schema:#}");
        assert_eq!(definition["additionalProperties"], false);
    }
}
