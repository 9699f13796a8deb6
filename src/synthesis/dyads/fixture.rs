//! Test fixtures: random poses, and poses of random linkages with the two dyads that made them.

use crate::mechanism::{AssemblyMode, Complex, Dyad, FourBar, Pose, bounding_box};
use crate::numbers::arithmetic::streams::{Stream, below, uniform};
use std::f64::consts::PI;

/// Draws a point of the square of half side `half`.
pub(super) fn random_point(draws: &mut Stream, half: f64) -> Complex {
    Complex::new(uniform(draws, -half, half), uniform(draws, -half, half))
}

/// Draws poses of any places in a square and any angles.
pub(super) fn random_poses(draws: &mut Stream, count: usize) -> Vec<Pose> {
    (0..count).map(|_| Pose::new(random_point(draws, 3.0), uniform(draws, -PI, PI))).collect()
}

/// A linkage, its body's frame on the coupler, and poses of it.
pub(super) struct Moved {
    pub linkage: FourBar,
    /// The angle from C -> D to the body's x axis.
    pub frame_angle: f64,
    pub poses: Vec<Pose>,
    /// The crank angle of each pose.
    pub crank_angles: Vec<f64>,
}

impl Moved {
    /// Draws a linkage of any type and `count` poses of it on one assembly.
    pub fn random(draws: &mut Stream, count: usize) -> Self {
        loop {
            let pivots = [random_point(draws, 2.0), random_point(draws, 2.0)];
            let links = std::array::from_fn(|_| uniform(draws, 0.3, 3.0));
            let assembly = [AssemblyMode::Plus, AssemblyMode::Minus][below(draws, 2)];
            let offset = random_point(draws, 2.0);
            let linkage = FourBar::with_coupler_offset(pivots, links, offset, assembly).expect("a linkage");
            let frame_angle = uniform(draws, -PI, PI);
            let angles: Vec<f64> = (0..40 * count).map(|_| uniform(draws, -PI, PI)).collect();
            let poses = angles.into_iter().filter_map(|phi| {
                let joints = linkage.position(phi).joints()?;
                let coupler = (joints.follower_pin - joints.crank_pin).arg();
                Some((phi, Pose::new(joints.coupler_point, coupler + frame_angle)))
            });
            let (crank_angles, poses): (Vec<f64>, Vec<Pose>) = poses.take(count).unzip();
            if poses.len() == count {
                return Moved { linkage, frame_angle, poses, crank_angles };
            }
        }
    }

    /// Returns the crank and the follower as dyads.
    pub fn dyads(&self) -> [Dyad; 2] {
        // u = 1 lies along the coupler; the body's frame is turned by its angle and P is its origin.
        let to_body = Complex::from_polar(1.0, -self.frame_angle);
        let (linkage, offset) = (&self.linkage, self.linkage.coupler_offset());
        [
            Dyad::RR { pin: -offset * to_body, pivot: linkage.crank_pivot(), length: linkage.crank() },
            Dyad::RR {
                pin: (linkage.coupler() - offset) * to_body,
                pivot: linkage.follower_pivot(),
                length: linkage.follower(),
            },
        ]
    }
}

/// Returns how far a dyad is from the nearest of a list, over pin, pivot and length; infinite for an empty list.
pub(super) fn nearest(dyad: &Dyad, list: &[Dyad]) -> f64 {
    let numbers = |dyad: &Dyad| match *dyad {
        Dyad::RR { pin, pivot, length } => (0, pin, pivot, length),
        Dyad::PR { pin, normal, distance } => (1, pin, normal, distance),
        Dyad::RP { pivot, normal, distance } => (2, pivot, normal, distance),
    };
    let (kind, one, other, number) = numbers(dyad);
    let distance = |dyad: &Dyad| {
        let (its, a, b, c) = numbers(dyad);
        if its == kind { (a - one).norm() + (b - other).norm() + (c - number).abs() } else { f64::INFINITY }
    };
    list.iter().map(distance).fold(f64::INFINITY, f64::min)
}

/// Returns poses given as x, y and the angle in degrees.
pub(super) fn poses_deg<const N: usize>(rows: [[f64; 3]; N]) -> [Pose; N] {
    rows.map(|[x, y, angle_deg]| Pose::new(Complex::new(x, y), angle_deg.to_radians()))
}

/// KINZEL5 and NISHIDA5: poses from two stored examples of the Multi-Pose Interactive Linkage Design code (G. Nishida,
/// A. Bousseau, D. Aliaga, Eurographics 2019), "kinzel" (after Kinzel, Schmiedeler, Pennock 2006) and "example5".
pub(super) const KINZEL5: [[f64; 3]; 5] =
    [[10.0, 9.0, 5.0], [9.0, 30.0, 35.0], [18.0, 32.0, 5.0], [22.0, 25.0, -45.0], [13.0, 22.0, -70.0]];
pub(super) const NISHIDA5: [[f64; 3]; 5] = [
    [8.4, 10.4, 0.0],
    [15.75307999925125, 6.635448633158675, 1.6616734751610893],
    [23.90048564278323, 11.00346784592804, 20.6930580629176],
    [22.17995730186216, 14.34686035802784, 43.4681702286939],
    [12.61818756779844, 15.25966971714668, -270.3228804174674],
];

/// Returns the diagonal of the box of the positions.
pub(super) fn size(poses: &[Pose]) -> f64 {
    let [low, high] = bounding_box(poses.iter().map(|pose| pose.position));
    (high - low).norm()
}

/// Returns the largest residual in parts of the size, or of the dyad's reach if that is larger: the places are known to
/// the rounding of the larger.
pub(super) fn error(dyad: &Dyad, poses: &[Pose]) -> f64 {
    let reach = match *dyad {
        Dyad::RR { pin, pivot, length } => pin.norm().max(pivot.norm()).max(length),
        Dyad::PR { pin, distance, .. } => pin.norm().max(distance.abs()),
        Dyad::RP { pivot, distance, .. } => pivot.norm().max(distance.abs()),
    };
    dyad.largest_residual(poses) / size(poses).max(reach)
}

/// Returns an RR dyad.
pub(super) fn rr(pin: [f64; 2], pivot: [f64; 2], length: f64) -> Dyad {
    Dyad::RR { pin: Complex::new(pin[0], pin[1]), pivot: Complex::new(pivot[0], pivot[1]), length }
}

/// Four poses, with their sliders by another program (2026).
pub(super) struct Four {
    pub poses: [[f64; 3]; 4],
    /// The pin, the line's unit normal and its distance.
    pub pin_on_line: [f64; 5],
    /// The pivot, the body line's unit normal and its distance.
    pub line_over_pivot: [f64; 5],
}

/// Stored examples of the same code as [`KINZEL5`]: "bulldozer_pose4" and "sofa-bed_pose4".
pub(super) const FOUR: [Four; 2] = [
    Four {
        poses: [
            [-1.399894073098376, 0.8105380961953004, 0.0],
            [-2.72725817963123, 1.116303963113566, -1.4454691823076982],
            [-4.813587839799906, 6.258732821886191, -19.128348845159564],
            [-2.384023949836752, 14.13974365970514, -45.10201853318161],
        ],
        pin_on_line: [
            15.940415199989987,
            7.111649157105416,
            -0.08520409845508022,
            0.9963635188054895,
            6.65446637465085,
        ],
        line_over_pivot: [
            11.513450848466595,
            1.4839105704977689,
            0.04057868343615464,
            -0.9991763460223567,
            -0.14881131271151427,
        ],
    },
    Four {
        poses: [
            [2.6, 8.1, 0.0],
            [2.484379015122517, 7.616478348632073, 18.938157109782942],
            [3.94841629367865, 9.037550319364493, 25.096754295359617],
            [7.3, 13.7, 0.0],
        ],
        pin_on_line: [
            4.3272878896716165,
            -4.022508376505494,
            0.7659742538299851,
            -0.642871248750166,
            2.6848220405924548,
        ],
        line_over_pivot: [
            -33.26975170793748,
            29.492880266016776,
            -0.7659742538299844,
            0.6428712487501665,
            41.228173950531215,
        ],
    },
];
