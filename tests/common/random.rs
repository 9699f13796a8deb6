//! Random four-bars and targets on their curves, from a stream of random numbers: what the recovery bench and
//! the property tests draw from. Knows nothing of any search.

#![allow(dead_code, reason = "every user takes its own part of it")]

use linkwright::internals::mechanism::four_bar::mobility::{grashof_margin, linkage_type};
use linkwright::internals::mechanism::{AssemblyMode, Circuit, Complex, FourBar, LinkageType};
use linkwright::internals::numbers::arithmetic::streams::{Stream, below, normal, uniform, unit};
use std::f64::consts::{PI, TAU};

/// The five types that have a margin.
pub const TYPES: [LinkageType; 5] = [
    LinkageType::CrankRocker,
    LinkageType::DoubleCrank,
    LinkageType::RockerCrank,
    LinkageType::DoubleRocker,
    LinkageType::TripleRocker,
];
/// Types whose crank turns fully.
pub const TURNING: [LinkageType; 2] = [LinkageType::CrankRocker, LinkageType::DoubleCrank];
/// Types whose crank rocks.
pub const ROCKING: [LinkageType; 3] =
    [LinkageType::RockerCrank, LinkageType::DoubleRocker, LinkageType::TripleRocker];

/// The longest link over the shortest, at most.
pub const LINK_RATIO: f64 = 10.0;
/// The coupler point lies within this many longest links of C ..
pub const COUPLER_REACH: f64 = 3.0;
/// .. and no nearer than this part of one: around C itself every curve is a circle.
const COUPLER_LEAST: f64 = 0.1;
/// The margin is at least this part of the longest link: nearer to a change point the circuits all but touch.
const LEAST_MARGIN: f64 = 0.01;

/// A value spread evenly in its logarithm.
pub fn log_uniform(stream: &mut Stream, low: f64, high: f64) -> f64 {
    uniform(stream, low.ln(), high.ln()).exp()
}

/// Whether a coin falls on this side, with probability `share`.
pub fn chance(stream: &mut Stream, share: f64) -> bool {
    unit(stream) < share
}

/// One of several.
pub fn one_of<T: Copy>(stream: &mut Stream, of: &[T]) -> T {
    of[below(stream, of.len())]
}

/// Link lengths [ground, crank, coupler, follower] of a type, the shortest near 1.
///
/// Grashof types by their slacks: the shortest link 1, the others 1 + (s_i + s_k)/2 with s_i > 0, which covers
/// exactly the shapes with that shortest link and a positive margin. Triple-rockers by trial.
pub fn links(stream: &mut Stream, of: LinkageType) -> [f64; 4] {
    let shortest = match of {
        LinkageType::DoubleCrank => Some(0),
        LinkageType::CrankRocker => Some(1),
        LinkageType::DoubleRocker => Some(2),
        LinkageType::RockerCrank => Some(3),
        _ => None,
    };
    loop {
        let links = match shortest {
            Some(place) => {
                let [s1, s2, s3] = [(); 3].map(|()| log_uniform(stream, 0.05, 12.0));
                let mut others = [0.5 * (s2 + s3), 0.5 * (s1 + s3), 0.5 * (s1 + s2)].into_iter();
                let mut links = [1.0; 4];
                for (_, link) in links.iter_mut().enumerate().filter(|(i, _)| *i != place) {
                    *link += others.next().expect("three links beside the shortest");
                }
                links
            }
            None => [(); 4].map(|()| log_uniform(stream, 1.0, LINK_RATIO)),
        };
        let longest = links.into_iter().fold(0.0, f64::max);
        let least = links.into_iter().fold(f64::INFINITY, f64::min);
        let moderate = longest <= LINK_RATIO * least && grashof_margin(links).abs() >= LEAST_MARGIN * longest;
        if moderate && linkage_type(links) == Some(of) {
            return links;
        }
    }
}

/// A linkage of a type in a random place, at a random size and assembly.
pub fn linkage(stream: &mut Stream, of: LinkageType) -> FourBar {
    let scale = log_uniform(stream, 0.1, 100.0);
    let links = links(stream, of).map(|l| l * scale);
    placed(stream, links)
}

/// The lengths of the other links of a linkage with a small crank, in cranks.
const SMALL_CRANK: (f64, f64) = (10.0, 50.0);

/// A crank-rocker whose other links are all 10 to 50 cranks long, in a random place, at a random size and assembly.
pub fn with_small_crank(stream: &mut Stream) -> FourBar {
    loop {
        let scale = log_uniform(stream, 0.1, 100.0);
        let mut long = || log_uniform(stream, SMALL_CRANK.0, SMALL_CRANK.1);
        let links = [long(), 1.0, long(), long()];
        let longest = links.into_iter().fold(0.0, f64::max);
        if linkage_type(links) == Some(LinkageType::CrankRocker)
            && grashof_margin(links) >= LEAST_MARGIN * longest
        {
            return placed(stream, links.map(|l| l * scale));
        }
    }
}

/// A linkage with these links in a random place and assembly.
fn placed(stream: &mut Stream, [ground, crank, coupler, follower]: [f64; 4]) -> FourBar {
    let longest = [ground, crank, coupler, follower].into_iter().fold(0.0, f64::max);
    let pivot = Complex::new(uniform(stream, -3.0, 3.0), uniform(stream, -3.0, 3.0)) * longest;
    let other = pivot + Complex::from_polar(ground, uniform(stream, -PI, PI));
    let reach = uniform(stream, COUPLER_LEAST, COUPLER_REACH) * longest;
    let offset = Complex::from_polar(reach, uniform(stream, -PI, PI));
    let assembly = AssemblyMode::of(uniform(stream, -1.0, 1.0));
    FourBar::with_coupler_offset([pivot, other], [crank, coupler, follower], offset, assembly)
        .expect("these are lengths")
}

/// Points of a coupler curve with the positions that draw them.
#[derive(Clone, Debug)]
pub struct Traced {
    /// What draws them.
    pub linkage: FourBar,
    /// Crank angle (radians) and assembly at each point.
    pub positions: Vec<(f64, AssemblyMode)>,
    /// The points.
    pub points: Vec<Complex>,
}

impl Traced {
    /// The diagonal of the points' bounding box.
    pub fn size(&self) -> f64 {
        let [low_x, low_y, high_x, high_y] = bounding_box(&self.points);
        (high_x - low_x).hypot(high_y - low_y)
    }
}

/// [xmin, ymin, xmax, ymax].
pub fn bounding_box(points: &[Complex]) -> [f64; 4] {
    points
        .iter()
        .fold([f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY], |[x0, y0, x1, y1], p| {
            [x0.min(p.re), y0.min(p.im), x1.max(p.re), y1.max(p.im)]
        })
}

/// `n` points of one circuit, evenly in its parameter: the crank angle where the crank turns fully, psi where
/// it rocks (crank angle = middle + half width sin psi, assembly = sign cos psi: psi passes the toggles). The
/// stretch runs over `span` radians of the parameter, either way, from anywhere; `None`: the whole circuit,
/// its first point not repeated.
///
/// `None` where the loop does not close at a point by rounding, at a toggle.
pub fn trace(stream: &mut Stream, linkage: &FourBar, n: usize, span: Option<f64>) -> Option<Traced> {
    let mobility = linkage.mobility();
    let start = uniform(stream, -PI, PI);
    let way = if chance(stream, 0.5) { 1.0 } else { -1.0 };
    let circuit = Circuit { index: below(stream, usize::from(mobility.circuits())) as u8 };
    let step = way * span.map_or(TAU / n as f64, |span| span / (n - 1) as f64);
    let (mut positions, mut points) = (Vec::new(), Vec::new());
    for i in 0..n {
        let parameter = start + step * i as f64;
        let (angle, assembly) = match mobility.arc(circuit) {
            Some(arc) => (arc.crank_angle(parameter), AssemblyMode::of(parameter.cos())),
            None => (parameter, linkage.assembly()),
        };
        points.push(linkage.position_with(angle, assembly).joints()?.coupler_point);
        positions.push((angle, assembly));
    }
    let linkage = linkage.with_assembly(positions[0].1);
    Some(Traced { linkage, positions, points })
}

/// The points with normal noise of standard deviation `sigma` in each coordinate.
pub fn noisy(stream: &mut Stream, points: &[Complex], sigma: f64) -> Vec<Complex> {
    points.iter().map(|p| p + Complex::new(normal(stream, 0.0, sigma), normal(stream, 0.0, sigma))).collect()
}
