//! Poses of bodies on the couplers of random four-bars: what the tests and the bench of motions draw from. Knows nothing of
//! any search.

#![allow(dead_code, reason = "every user takes its own part of it")]

use crate::random::{ROCKING, TURNING, linkage, one_of, trace};
use linkwright::FourBar;
use linkwright::internals::mechanism::Complex;
use linkwright::internals::numbers::arithmetic::streams::{Stream, below, normal, uniform};
use std::f64::consts::PI;

/// Poses of a body on a coupler, with the linkage that takes it through them and the body's frame.
pub struct Taken {
    /// What draws them.
    pub linkage: FourBar,
    /// Crank angle (radians) and assembly at each pose.
    pub positions: Vec<(f64, linkwright::AssemblyMode)>,
    /// From C -> D to the body's x axis, radians.
    pub frame: f64,
    /// Places and angles, radians.
    pub poses: Vec<(Complex, f64)>,
}

/// Draws a linkage of any type and `n` poses on one of its branches; noise in parts of the size and of a radian.
pub fn taken(draws: &mut Stream, n: usize, noise: f64) -> Taken {
    loop {
        let turning = below(draws, 2) == 0;
        let of = if turning { one_of(draws, &TURNING) } else { one_of(draws, &ROCKING) };
        let linkage = linkage(draws, of);
        let span = if turning { uniform(draws, 2.0, 5.8) } else { uniform(draws, 0.8, 2.4) };
        let Some(traced) = trace(draws, &linkage, n, Some(span)) else { continue };
        let one_branch = traced.positions.iter().all(|(_, t)| *t == traced.positions[0].1);
        let size = traced.size();
        let frame = uniform(draws, -PI, PI);
        let coupler = |(angle, t): &(f64, linkwright::AssemblyMode)| {
            let joints = traced.linkage.position_with(*angle, *t).joints().expect("it closes");
            (joints.follower_pin - joints.crank_pin).arg()
        };
        if !one_branch || size < 0.05 * linkage.longest_link() || linkage.link_ratio() > 15.0 {
            continue;
        }
        let mut pose = |(point, at): (&Complex, &(f64, linkwright::AssemblyMode))| {
            let off = Complex::new(normal(draws, 0.0, noise * size), normal(draws, 0.0, noise * size));
            (point + off, coupler(at) + frame + normal(draws, 0.0, noise))
        };
        let poses = traced.points.iter().zip(&traced.positions).map(&mut pose).collect();
        return Taken { linkage: traced.linkage, positions: traced.positions.clone(), frame, poses };
    }
}

/// The text of a problem of these poses, with further lines.
pub fn text(poses: &[(Complex, f64)], lines: &str) -> String {
    let rows: Vec<[f64; 3]> = poses.iter().map(|(p, angle)| [p.re, p.im, angle.to_degrees()]).collect();
    format!("format = 1\n[task.motion]\nposes = {rows:?}\n{lines}")
}

/// Wide bounds around the first pose, in units of `far`.
pub fn wide(at: Complex, far: f64) -> String {
    let (x, y) = ([at.re - far, at.re + far], [at.im - far, at.im + far]);
    let l = [1e-3 * far, far];
    let o = [-far, far];
    format!(
        "[design]\nA = [{x:?}, {y:?}]\nB = [{x:?}, {y:?}]\na = {l:?}\nb = {l:?}\nc = {l:?}\nground = {l:?}\n\
         coupler_x = {o:?}\ncoupler_y = {o:?}\n"
    )
}
