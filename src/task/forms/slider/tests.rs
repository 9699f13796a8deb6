//! Derivatives against differences, and the closure against the position in closed form.

use super::fit::{Angles, BodyAngles, OwnAngles, SliderFit};
use super::limits::Limited;
use super::output::Outputs;
use super::shape::{SliderShape, Unknowns};
use super::swept::BoxLimits;
use crate::mechanism::{AssemblyMode, Complex, LinkageKind, bounding_box};
use crate::numbers::arithmetic::streams::{stream, uniform};
use crate::numbers::optimise::levenberg_marquardt::derivative_error;
use crate::task::region::Region;
use crate::task::spec::{DesignSpec, Limits, RequireSpec};
use crate::task::{AngleOffset, Output, Problem};
use std::f64::consts::TAU;

/// Draws a linkage that closes for cranks within half a radian of the x axis, as unknowns.
fn drawn(kind: LinkageKind, case: u64) -> (Unknowns, SliderShape) {
    let mut draws = stream(9, case);
    let mut in_range = |low: f64, high: f64| uniform(&mut draws, low, high);
    let x = match kind {
        LinkageKind::SliderCrank => [
            in_range(-1.0, 1.0),
            in_range(-1.0, 1.0),
            in_range(0.2, 0.6),
            in_range(2.2, 3.0),
            in_range(-0.3, 0.3),
            in_range(-3.0, 3.0),
            in_range(-1.0, 2.0),
            in_range(-1.0, 1.0),
            in_range(-1.0, 1.0),
            in_range(-3.0, 3.0),
        ],
        _ => [
            in_range(-0.2, 0.2),
            in_range(-0.2, 0.2),
            in_range(0.3, 0.6),
            in_range(1.5, 2.5),
            in_range(-1.0, 1.0),
            in_range(-0.5, 0.5),
            in_range(-1.0, 2.0),
            in_range(-1.0, 1.0),
            in_range(-1.0, 1.0),
            in_range(-3.0, 3.0),
        ],
    };
    (x, SliderShape::of(kind, &x).expect("lengths are positive"))
}

fn limits(kind: LinkageKind, turns: bool, ends: bool) -> Limited {
    let bounds = |low, high| ends.then_some(Limits(low, high));
    let require = RequireSpec {
        stroke: bounds(0.5, 1.0),
        time_ratio: bounds(1.05, 1.2),
        transmission_deg_min: Some(20.0),
        link_ratio_max: 9.0,
        longest_max: Some(11.0),
        pivots_in: Some(Region::Polygon(vec![[-2.0, -2.0], [3.0, -1.5], [2.0, 2.0]])),
        pins_in: Some(Region::Box([-2.0, -1.0, 1.0, 2.0])),
        footprint_in: Some([-2.0, -2.0, 4.0, 3.0]),
        extent_max: Some(4.0),
        ..RequireSpec::default()
    };
    let points: Vec<[f64; 2]> = (0..8).map(|j| [f64::from(j) * 0.3, 0.2 * f64::from(j * j)]).collect();
    let design =
        DesignSpec { line_point: Some([Limits(-0.3, 0.5), Limits(0.1, 0.4)]), ..DesignSpec::default() };
    let spec = Problem::builder(points).design(design).require(require).spec().expect("a problem");
    let problem = Problem::new(spec).expect("a problem");
    Limited::of(&problem, kind, Complex::new(0.0, 0.0), 1.0).turning(turns)
}

#[test]
fn derivatives_agree_with_differences() {
    for kind in [LinkageKind::SliderCrank, LinkageKind::InvertedSliderCrank] {
        for case in 0..60 {
            let (x, shape) = drawn(kind, case);
            let sign = if case % 2 == 0 { 1.0 } else { -1.0 };
            let cranks = (0..6).map(|j| Complex::from_polar(1.0, 0.7 * f64::from(j) - 1.4));
            let position = |e: Complex| Some([e, shape.coupler_direction(e, sign)?]);
            let positions: Vec<[Complex; 2]> =
                cranks.map(position).collect::<Option<_>>().expect("it closes");
            let points: Vec<Complex> =
                positions.iter().map(|p| shape.coupler_point(*p) + Complex::new(0.1, -0.05)).collect();
            let weights = [1.0, 2.0, 0.5, 1.0, 1.0, 3.0];
            let limits = limits(kind, case % 3 == 0, case % 5 == 0);
            let phases: Vec<Complex> = positions.iter().map(|p| p[0]).collect();
            let offset = [AngleOffset::Free, AngleOffset::Fixed, AngleOffset::Ground][case as usize % 3];
            let mut turned = x;
            if offset != AngleOffset::Fixed {
                turned[8] = 0.1;
            }
            let assembly = AssemblyMode::of(sign);
            let angle = |j: usize| (j != 2).then(|| positions[j][1].arg() + x[9] + 0.2 * j as f64);
            let body = BodyAngles { angles: (0..6).map(angle).collect(), weight: 0.7 };
            for angles in [Angles::Free, Angles::Prescribed(phases, offset, assembly)] {
                let is_free = matches!(angles, Angles::Free);
                // Of prescribed crank angles every other time two targets have their own.
                let own =
                    if is_free || case % 2 == 0 { Vec::new() } else { (0..6).map(|j| j % 4 == 1).collect() };
                let state = if is_free || !own.is_empty() { positions.clone() } else { Vec::new() };
                let path = SliderFit::<2> {
                    kind,
                    points: &points,
                    weights: &weights,
                    body: None,
                    outputs: None,
                    sign: 1.0,
                    angles: angles.clone(),
                    own: if own.is_empty() { OwnAngles::None } else { OwnAngles::Of(&own) },
                    limits: &limits,
                    sense: 1.0,
                    ends_meet: false,
                };
                let motion = SliderFit::<3> {
                    kind,
                    points: &points,
                    weights: &weights,
                    body: Some(&body),
                    outputs: None,
                    sign: 1.0,
                    angles: angles.clone(),
                    own: if own.is_empty() { OwnAngles::None } else { OwnAngles::Of(&own) },
                    limits: &limits,
                    sense: 1.0,
                    ends_meet: false,
                };
                let is_angle = kind == LinkageKind::InvertedSliderCrank && case % 4 < 2;
                let outputs = Outputs {
                    kind: if is_angle { Output::Angle } else { Output::Place },
                    wanted: (0..6).map(|j| 0.3 * f64::from(j)).collect(),
                    weight: 0.9,
                    from_ground: case % 2 == 0,
                };
                let function = SliderFit::<1> {
                    kind,
                    points: &[],
                    weights: &weights,
                    body: None,
                    outputs: Some(&outputs),
                    sign,
                    angles,
                    own: OwnAngles::None,
                    limits: &limits,
                    sense: 0.0,
                    ends_meet: false,
                };
                if !is_free
                    && let Some(error) = derivative_error(&function, &turned, &state, &[1e-6; 10], 0.0)
                {
                    assert!(error < 2e-8, "{kind} {case} {:?} {offset:?}: {error}", outputs.kind);
                }
                let along = if is_free || !own.is_empty() { 1e-6 } else { 0.0 };
                let errors = [
                    derivative_error(&path, &turned, &state, &[1e-6; 10], along),
                    derivative_error(&motion, &turned, &state, &[1e-6; 10], along),
                ];
                let [Some(of_path), Some(of_motion)] = errors else {
                    // A crank from the ground may stand where the loop is open.
                    assert!(offset == AngleOffset::Ground && !is_free);
                    continue;
                };
                let error = of_path.max(of_motion);
                assert!(error < 2e-8, "{kind} {case} free {is_free} {offset:?}: {error}");
            }
        }
    }
}

#[test]
fn a_shape_is_the_linkage_that_it_becomes() {
    for kind in [LinkageKind::SliderCrank, LinkageKind::InvertedSliderCrank] {
        for case in 0..60 {
            let (_, shape) = drawn(kind, case);
            let carried = shape.carried(Complex::new(1.5, -2.0), Complex::new(3.0, 0.7));
            for assembly in [AssemblyMode::Plus, AssemblyMode::Minus] {
                let linkage = carried.linkage(assembly).expect("a linkage");
                for j in 0..12 {
                    let e = Complex::from_polar(1.0, 0.5 * f64::from(j));
                    let Some(u) = carried.coupler_direction(e, assembly.sign()) else { continue };
                    assert!(carried.miss([e, u]).value.abs() < 1e-13);
                    assert_eq!(carried.assembly_of([e, u]), assembly);
                    let joints = linkage.joints_with(e.arg(), AssemblyMode::Plus).expect("it closes").joints;
                    let apart = (joints.coupler_point - carried.coupler_point([e, u])).norm();
                    assert!(apart < 1e-12, "{kind} {case} {j}: {apart}");
                }
            }
        }
    }
}

#[test]
fn the_extent_is_the_diagonal_of_the_box_of_all_joints() {
    for kind in [LinkageKind::SliderCrank, LinkageKind::InvertedSliderCrank] {
        for case in 0..60 {
            let (_, shape) = drawn(kind, case);
            // Over a turn, and over a stretch that begins and ends at positions.
            let whole = case % 2 == 0;
            let (from, span) = if whole { (0.3, TAU) } else { (-1.2 + 0.01 * case as f64, 2.4) };
            let at = |angle: f64| {
                let e = Complex::from_polar(1.0, angle);
                Some([e, shape.coupler_direction(e, 1.0)?])
            };
            let positions = (0..8).map(|j| at(from + span * f64::from(j) / if whole { 8.0 } else { 7.0 }));
            let Some(positions) = positions.collect::<Option<Vec<_>>>() else { continue };
            let linkage = shape.linkage(AssemblyMode::Plus).expect("a linkage");
            if whole && !linkage.mobility().input_turns_fully() {
                continue;
            }
            let mut reached: Vec<Complex> = linkage.pivots().collect();
            const DENSE: i32 = 20_000;
            for i in 0..=DENSE {
                let angle = from + span * f64::from(i) / f64::from(DENSE);
                let joints = linkage.joints_with(angle, AssemblyMode::Plus).expect("it closes").joints;
                reached.extend([joints.crank_pin, joints.follower_pin, joints.coupler_point]);
            }
            let [low, high] = bounding_box(reached.into_iter());
            let limits = BoxLimits { footprint: None, extent: Some(0.0), whole };
            let mut least = f64::INFINITY;
            limits.each(&shape, whole, &positions, &mut |bar| least = least.min(bar.value));
            let apart = (-least - (high - low).norm()).abs();
            assert!(apart < 1e-6, "{kind} {case}: {apart}");
        }
    }
}
