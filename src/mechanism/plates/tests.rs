//! Tests of plates: outlines close, areas are those of the outline, separations those of a dense sweep.

use super::*;
use crate::mechanism::{AssemblyMode, CouplerSide, NaturalCoordinates, cross, dot, point};
use std::f64::consts::TAU;

fn plate(points: &[[f64; 2]], radius: f64) -> Plate {
    let holes = points
        .iter()
        .zip([Joint::C, Joint::D, Joint::P, Joint::X2])
        .map(|(xy, joint)| Hole { joint, at: point(*xy) })
        .collect();
    Plate::new(Link::Coupler, holes, radius)
}

/// Returns plates of every kind: triangle both ways round, P in line (between, beyond), on C, all in one place, a line,
/// a point.
fn plates() -> Vec<Plate> {
    vec![
        plate(&[[0.0, 0.0], [5.0, 0.0], [2.0, 3.0]], 0.7),
        plate(&[[0.0, 0.0], [5.0, 0.0], [-2.0, -3.0]], 0.7),
        plate(&[[0.0, 0.0], [5.0, 0.0], [2.0, 0.0]], 0.5),
        plate(&[[0.0, 0.0], [5.0, 0.0], [9.0, 0.0]], 0.5),
        plate(&[[0.0, 0.0], [5.0, 0.0], [0.0, 0.0]], 0.5),
        plate(&[[0.0, 0.0], [5.0, 0.0], [5.0, 1e-12]], 0.5),
        plate(&[[1.0, 2.0], [1.0, 2.0], [1.0, 2.0]], 0.5),
        plate(&[[0.0, 0.0], [0.0, 4.0]], 0.25),
        plate(&[[3.0, 1.0]], 2.0),
        plate(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.5, 0.25]], 0.1),
    ]
}

/// Computes 0.5 times the integral of x dy - y dx along an edge, in closed form.
fn swept(edge: &Edge) -> f64 {
    match *edge {
        Edge::Line { from, to } => 0.5 * cross(from, to),
        Edge::Arc { from, to, centre, turn } => {
            0.5 * (cross(centre, to - from) + (from - centre).norm_sqr() * turn)
        }
    }
}

#[test]
fn outlines_are_closed_smooth_and_enclose_the_plate() {
    for plate in plates() {
        let edges = plate.outline();
        let tight = 1e-13 * (1.0 + plate.perimeter());
        let (mut turned, mut length, mut area) = (0.0, 0.0, 0.0);
        for (i, edge) in edges.iter().enumerate() {
            let next = edges[(i + 1) % edges.len()];
            let (Edge::Line { to, .. } | Edge::Arc { to, .. }) = *edge;
            assert!((to - next.from()).norm() < tight, "{plate:?}");
            area += swept(edge);
            match *edge {
                Edge::Line { from, to } => {
                    length += (to - from).norm();
                    // The next arc leaves at a right angle to its radius: no kink.
                    if let Edge::Arc { centre, .. } = next {
                        assert!(dot(to - from, next.from() - centre).abs() < tight * plate.perimeter());
                    }
                }
                Edge::Arc { from, to, centre, turn } => {
                    assert!(((from - centre).norm() - plate.radius).abs() < tight);
                    assert!(
                        ((from - centre) * Complex::from_polar(1.0, turn) - (to - centre)).norm() < tight
                    );
                    assert!(((edge.bulge().atan() * 4.0) - turn).abs() < 1e-14);
                    turned += turn;
                    length += turn * plate.radius;
                }
            }
        }
        assert!((turned - TAU).abs() < 1e-12, "{turned} {plate:?}");
        assert!((length - plate.perimeter()).abs() < tight);
        assert!((area - plate.area()).abs() < tight * plate.perimeter(), "{area} {} {plate:?}", plate.area());
        for hole in &plate.holes {
            assert!(plate.distance(&Placement::HOME, hole.at) <= -plate.radius + tight);
        }
        for edge in edges {
            assert!(plate.distance(&Placement::HOME, edge.from()).abs() < tight, "{plate:?}");
        }
    }
}

#[test]
fn corners_leave_out_what_is_in_line_or_in_one_place() {
    let corners: Vec<usize> = plates().iter().map(|plate| plate.corners.len()).collect();
    assert_eq!(corners, [3, 3, 2, 2, 2, 2, 1, 2, 1, 3]);
    let names = |plate: &Plate| -> Vec<String> { plate.distinct_holes().into_iter().map(|h| h.0).collect() };
    assert_eq!(names(&plates()[4]), ["CP", "D"]);
    assert_eq!(names(&plates()[6]), ["CDP"]);
    assert_eq!(names(&plates()[2]), ["C", "D", "P"]);
}

#[test]
fn separations_agree_with_a_dense_walk_along_the_boundaries() {
    // The signed distance of a point, from the boundary's points and the winding number alone.
    let boundary = |plate: &Plate| -> Vec<Complex> {
        let n = 4000;
        let at = |edge: &Edge, share: f64| match *edge {
            Edge::Line { from, to } => from + (to - from) * share,
            Edge::Arc { from, centre, turn, .. } => {
                centre + (from - centre) * Complex::from_polar(1.0, turn * share)
            }
        };
        let edges = plate.outline();
        edges.iter().flat_map(|edge| (0..n).map(move |i| at(edge, f64::from(i) / f64::from(n)))).collect()
    };
    for plate in plates() {
        let around = boundary(&plate);
        for i in 0..12 {
            let z = Complex::new(-3.0 + 1.1 * f64::from(i), 0.37 + 0.61 * f64::from(i % 5) - 1.0);
            let nearest = around.iter().map(|p| (p - z).norm()).fold(f64::INFINITY, f64::min);
            let n = around.len();
            let winding: f64 = (0..n)
                .map(|k| {
                    let (u, v) = (around[k] - z, around[(k + 1) % n] - z);
                    cross(u, v).atan2(dot(u, v))
                })
                .sum();
            let expected = if winding > 1.0 { -nearest } else { nearest };
            assert!((plate.distance(&Placement::HOME, z) - expected).abs() < 1e-4, "{z} {plate:?}");
        }
    }
    // Two plates: moved apart along the direction of the least shift by the overlap, they only touch; the
    // distance of disjoint ones is that of their boundaries' nearest points.
    for p in plates() {
        for q in plates() {
            for i in 0..10 {
                let angle = 0.7 * f64::from(i);
                let at = Placement {
                    origin: Complex::from_polar(0.8 * f64::from(i), 1.3 * angle),
                    direction: Complex::from_polar(1.0, angle),
                };
                let gap = p.separation(&Placement::HOME, &q, &at);
                assert!((q.separation(&at, &p, &Placement::HOME) - gap).abs() < 1e-12);
                let moved = |shift: f64, direction: f64| Placement {
                    origin: at.origin + Complex::from_polar(shift, direction),
                    ..at
                };
                let best = (0..3600)
                    .map(|k| {
                        p.separation(&Placement::HOME, &q, &moved(gap.abs(), TAU * f64::from(k) / 3600.0))
                    })
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| (low.min(s), high.max(s)));
                if gap > 0.0 {
                    let (around, other) = (boundary(&p), boundary(&q));
                    let coarse = around.iter().step_by(40).flat_map(|z| {
                        other.iter().step_by(40).map(|w| (at.of(*w) - *z).norm()).collect::<Vec<_>>()
                    });
                    let nearest = coarse.fold(f64::INFINITY, f64::min);
                    assert!(nearest >= gap - 1e-12 && nearest - gap < 0.12, "{nearest} {gap}");
                    assert!(best.0.abs() < 1e-4 * (1.0 + gap), "{best:?} {gap}");
                } else {
                    // No shift shorter than the overlap separates them, one of that length does (to 0.05 degrees).
                    assert!(
                        best.1 <= 1e-12 && best.1 > -2e-3 * (1.0 + gap.abs()),
                        "{best:?} {gap} {p:?} {q:?}"
                    );
                }
            }
        }
    }
}

#[test]
fn plates_stand_where_the_joints_are() {
    let linkage = FourBar::new(NaturalCoordinates {
        crank_pivot: [1.0, -2.0],
        follower_pivot: [4.0, 1.0],
        crank: 2.0,
        coupler: 5.0,
        follower: 5.0,
        crank_side: 5.0,
        follower_side: 4.0,
        assembly: AssemblyMode::Plus,
        side: CouplerSide::Minus,
    })
    .unwrap();
    let joints = linkage.position(0.3).joints().unwrap();
    let place = |joint: Joint| match joint {
        Joint::A => linkage.crank_pivot(),
        Joint::B => linkage.follower_pivot(),
        Joint::C => joints.crank_pin,
        Joint::D => joints.follower_pin,
        _ => joints.coupler_point,
    };
    for plate in Plate::all(&linkage, 0.4) {
        let at = plate.placement(linkage, joints);
        for hole in &plate.holes {
            assert!((at.of(hole.at) - place(hole.joint)).norm() < 1e-13, "{} {hole:?}", plate.link.name());
        }
    }
}
