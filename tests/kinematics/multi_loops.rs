//! Six-bars and eight-bars with the lengths of their links: against the chain, in images, in files and records, over a turn.

use crate::dyad_chains::drawn;
use linkwright::internals::files::linkage_file::{any_to_toml, parse_crank_linkage};
use linkwright::internals::mechanism::multi_loop::keys::{ChainKeys, DyadKeys, PointKeys};
use linkwright::internals::mechanism::{
    Complex, CrankLinkage, DyadChain, DyadChainKind, InputRange, LinkageKind, Mechanism, MultiLoop,
    NoMultiLoop,
};
use linkwright::internals::numbers::arithmetic::streams::{stream, uniform};
use std::f64::consts::{PI, TAU};

/// Linkages of every kind, each with the chain that it was made of.
fn linkages() -> Vec<(DyadChain, MultiLoop)> {
    let draws = &mut stream(4711, 0);
    let kinds = DyadChainKind::SIX_BARS.into_iter().chain(DyadChainKind::eight_bars());
    let mut all = Vec::new();
    for kind in kinds {
        for _ in 0..4 {
            let chain = drawn(kind, draws);
            let made = MultiLoop::of_dyad_chain(&chain).expect("its lengths are positive");
            // Not so thin that roundings count.
            if made.link_ratio() < 300.0 && made.full_turn_margin() > 1e-4 * made.longest() {
                all.push((chain, made));
            }
        }
    }
    assert!(all.len() > 100, "{}", all.len());
    all
}

#[test]
fn joints_are_those_of_the_chain_and_of_the_search() {
    for (dyads, linkage) in linkages() {
        let chain = linkage.to_chain().expect("a chain");
        let proportions = dyads.proportions();
        let near = |one: Complex, other: Complex| {
            let scale = linkage.longest() + one.norm();
            assert!((one - other).norm() < 1e-8 * scale, "{linkage}: {one} {other}");
        };
        assert_eq!(linkage.joint_names(), chain.names());
        assert_eq!(linkage.pivots().len(), Mechanism::pivots(&chain));
        for i in 0..12 {
            let angle = TAU * f64::from(i) / 12.0 + 0.1;
            let own = linkage.pose_at(angle);
            let other = chain.pose_at(angle);
            for (one, other) in own.joints.iter().zip(&other.joints) {
                near(one.expect("it closes"), other.expect("it closes"));
            }
            let p = linkage.point_at(angle).expect("it closes");
            near(p, own.joints[linkage.traced()].expect("it closes"));
            near(p, dyads.point(&proportions, angle - dyads.ground_angle()));
        }
        let close = |one: f64, other: f64| assert!((one - other).abs() < 1e-9 * one, "{one} {other}");
        close(linkage.longest(), dyads.longest());
        close(linkage.link_ratio(), dyads.link_ratio());
    }
}

#[test]
fn over_a_turn_it_stays_closed_and_its_transmission_angles_are_those_of_dense_samples() {
    const DENSE: usize = 20_000;
    for (dyads, linkage) in linkages().into_iter().step_by(5) {
        let any = CrankLinkage::MultiLoop(linkage);
        assert_eq!(any.mobility().input, InputRange::Full);
        let extremes = any.transmission_over_cycle().expect("it closes");
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for i in 0..DENSE {
            for angle in linkage.transmissions_at(TAU * i as f64 / DENSE as f64) {
                (least, most) = (least.min(angle), most.max(angle));
            }
        }
        assert!(extremes.min <= least + 1e-12 && least - extremes.min < 1e-5, "{} {least}", extremes.min);
        assert!(extremes.max >= most - 1e-12 && extremes.max - most < 1e-5, "{} {most}", extremes.max);
        let worst = extremes.min.min(PI - extremes.max);
        assert!((worst - dyads.least_transmission()).abs() < 1e-6, "{worst} {}", dyads.least_transmission());
    }
}

#[test]
fn images_draw_images_of_the_curve() {
    let draws = &mut stream(4711, 1);
    for (i, (_, linkage)) in linkages().into_iter().enumerate() {
        let mirrors = i % 2 == 1;
        let turn = Complex::from_polar(1.0, uniform(draws, -PI, PI));
        let shift = Complex::new(uniform(draws, -3.0, 3.0), uniform(draws, -3.0, 3.0));
        let image = linkage.carried(mirrors, turn, shift).expect("a linkage");
        let large = linkage.scaled(7.0).expect("a linkage");
        for k in 0..6 {
            let angle = f64::from(k) + 0.3;
            let p = linkage.point_at(angle).expect("it closes");
            let carried = if mirrors { p.conj() } else { p };
            let there = if mirrors { turn.arg() - angle } else { turn.arg() + angle };
            let at = image.point_at(there).expect("it closes");
            let scale = 1e-9 * (linkage.longest() + p.norm() + shift.norm()) * linkage.link_ratio();
            assert!((at - (shift + turn * carried)).norm() < scale, "{linkage}");
            assert!((large.point_at(angle).expect("it closes") - p * 7.0).norm() < 7.0 * scale);
        }
        let back = |l: &MultiLoop| [l.longest(), l.link_ratio(), l.full_turn_margin()];
        for (one, other) in back(&linkage).into_iter().zip(back(&image)) {
            assert!(
                (one - other).abs() < 1e-6 * linkage.longest().max(linkage.link_ratio()),
                "{one} {other}"
            );
        }
    }
}

#[test]
fn it_comes_back_from_files_records_and_the_unknowns_of_a_search() {
    for (_, linkage) in linkages() {
        let any = CrankLinkage::MultiLoop(linkage);
        let json = serde_json::to_string(&any).expect("it is data");
        assert_eq!(serde_json::from_str::<CrankLinkage>(&json).expect("it was written"), any);
        let text = any_to_toml("it", None, &any);
        let read = parse_crank_linkage("it.toml", &text).expect("it was written").linkage;
        assert_eq!(read, any, "{text}");
        assert_eq!(linkage.with_numbers(&linkage.numbers()), Some(linkage));
        assert_eq!(linkage.with_numbers(&linkage.numbers()[1..]), None);
        let unknowns = linkage.to_dyad_chain().expect("it turns fully");
        let of = unknowns.proportions();
        for i in 0..9 {
            let angle = 0.7 * f64::from(i);
            let p = linkage.point_at(angle).expect("it closes");
            let again = unknowns.point(&of, angle - unknowns.ground_angle());
            let scale = 1e-9 * linkage.longest() * linkage.link_ratio();
            assert!((p - again).norm() < scale.max(1e-9 * p.norm()), "{linkage}: {p} {again}");
        }
    }
}

/// A six-bar in names of its own, its lists in no order: the second dyad hangs on a point of the crank and on the joint of the
/// first one, which begins at the fixed pivot.
fn by_hand() -> ChainKeys {
    let text = r#"{"trace": "tip", "pivots": {"O": [0, 0], "G": [3, 0.5]},
        "crank": {"pivot": "O", "joint": "K", "length": 1},
        "point": [{"name": "tip", "on": ["M", "E"], "at": [0.5, 1]}, {"name": "E", "on": ["K", "O"], "at": [0.2, 0.4]}],
        "dyad": [{"joint": "M", "from": ["E", "W"], "lengths": [3, 3.5], "side": -1},
                 {"joint": "W", "from": ["G", "K"], "lengths": [2.5, 3], "side": 1}]}"#;
    serde_json::from_str(text).expect("keys")
}

#[test]
fn a_chain_in_other_names_and_another_order_is_read_as_the_six_bar_that_it_is() {
    let keys = by_hand();
    let linkage = MultiLoop::from_keys(&keys).expect("a six-bar");
    assert_eq!(CrankLinkage::MultiLoop(linkage).kind(), LinkageKind::SixBar);
    // Its joints by the sides of triangles.
    let angle = 0.8_f64;
    let at = |p: Complex, q: Complex, [r, s]: [f64; 2], side: f64| {
        let (d, apart) = (q - p, (q - p).norm());
        let cosine = (r * r + apart * apart - s * s) / (2.0 * r * apart);
        p + d / apart * Complex::from_polar(r, side * cosine.acos())
    };
    let (o, g) = (Complex::new(0.0, 0.0), Complex::new(3.0, 0.5));
    let k = Complex::from_polar(1.0, angle);
    let w = at(g, k, [2.5, 3.0], 1.0);
    let e = k + (o - k) * Complex::new(0.2, 0.4);
    let m = at(e, w, [3.0, 3.5], -1.0);
    let tip = m + (e - m) / 3.0 * Complex::new(0.5, 1.0);
    let own = linkage.point_at(angle).expect("it closes");
    assert!((own - tip).norm() < 1e-12, "{own} {tip}");
}

#[test]
fn chains_that_are_no_six_bar_are_refused_with_the_reason() {
    let keys = by_hand();
    let refused = |keys: ChainKeys| MultiLoop::from_keys(&keys).expect_err("no six-bar");
    let dyads = |dyad: Vec<DyadKeys>| ChainKeys { dyad, ..by_hand() };
    assert_eq!(refused(dyads(keys.dyad[..1].to_vec())), NoMultiLoop::Dyads(1));
    let long = keys.dyad.iter().cloned().map(|d| DyadKeys { lengths: [3.0, 0.2], ..d }).collect();
    assert_eq!(refused(dyads(long)), NoMultiLoop::Turn);
    let mut first = keys.dyad.clone();
    first[1].from = ["K".into(), "K2".into()];
    assert!(matches!(refused(dyads(first)), NoMultiLoop::Unknown(_)));
    let negative = keys.dyad.iter().cloned().map(|d| DyadKeys { lengths: [-1.0, 3.0], ..d }).collect();
    assert!(matches!(refused(dyads(negative)), NoMultiLoop::Linkage(_)));
    assert_eq!(refused(ChainKeys { trace: "O".into(), ..by_hand() }), NoMultiLoop::Traced("O".into()));
    let stray = PointKeys { name: "S".into(), on: ["O".into(), "W".into()], at: [1.0, 0.0] };
    let point = keys.point.iter().cloned().chain([stray]).collect();
    assert_eq!(refused(ChainKeys { point, ..by_hand() }), NoMultiLoop::Unknown("S".into()));
}
