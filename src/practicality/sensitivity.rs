//! How far the path moves when a dimension is wrong.
//!
//! With s_jk the shift of the path at point j for a unit error of dimension k, to first order,
//!
//! ```text
//! of one dimension    rms_k = sqrt(sum_j |s_jk|^2 / n),   worst_k = max_j |s_jk|
//! of all together     band  = sigma sqrt(sum_k rms_k^2),  worst   = sigma max_j sqrt(sum_k |s_jk|^2)
//! ```
//!
//! where every dimension is off by its own independent error of standard deviation sigma. What the shift is depends
//! on what the crank angles do once the linkage is built, see [`Crank`]: with free timing the part of dP along the
//! path only makes the point pass earlier or later, and the shift of the path is the part across it. (Where the path
//! misses the target by T - P, that vector stands across the path, and the distance from the target changes by the
//! same part.)
//!
//! The dimensions are the nine of [`crate::linkage::NaturalCoordinates`], each moved alone. Where P lies nearly on the
//! line C-D, d and e hardly say where (coupler_y is the root of a small difference): there the coupler is measured
//! by `coupler_x` and `coupler_y`, P along and across C -> D. `ground` moves B along A -> B; it is told beside the
//! nine, and is no part of the band because Bx and By are.

use super::sweep::Sweep;
use crate::linkage::gradient::shape_gradient;
use crate::linkage::{AssemblyMode, Complex, FourBar, dot, length, turned};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// P counts as on the line C-D where it is nearer to it than this part of the larger of d and e.
pub const FLAT: f64 = 0.1;
/// A point of the path where P stands still to this part of the fastest has no direction of its own.
const STANDSTILL: f64 = 1e-9;

/// What the crank angles do when a dimension is off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crank {
    /// Free timing: at each point the crank turns to where P is nearest; the shift is the part across the path.
    Settles,
    /// Prescribed increments, free offset: one offset for all points is set anew so that they move least.
    OffsetIsSet,
    /// Prescribed from the x axis: the angles stay.
    Stays,
    /// Prescribed from the ground line: the angles turn with A -> B.
    TurnsWithGround,
}

/// A position at which the path is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct At {
    /// The crank angle, radians from the x axis.
    pub crank_angle: f64,
    /// How the loop is closed.
    pub assembly: AssemblyMode,
}

/// How far the path moves for a unit error of one dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dimension {
    /// Its letter in files.
    pub name: &'static str,
    /// The root of the mean square over the points.
    pub rms: f64,
    /// At the point where it is most.
    pub worst: f64,
    /// That point, counted from 0.
    pub worst_at: usize,
}

/// How far the path moves for errors of the dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// What the crank angles do.
    pub crank: Crank,
    /// The nine, in the order Ax, Ay, Bx, By, a, b, c, d, e (or coupler_x, coupler_y in place of d, e).
    pub dimensions: [Dimension; 9],
    /// |AB|, B moved along the ground line: a part of what Bx and By say.
    pub ground: Dimension,
    /// The rms band for a standard deviation of 1 of each of the nine.
    pub band: f64,
    /// The same at the point where it is most.
    pub worst: f64,
    /// That point, counted from 0.
    pub worst_at: usize,
    /// The points at which a toggle leaves no derivative; they are no part of any figure.
    pub at_toggles: Vec<usize>,
    /// How many points are.
    pub points: usize,
}

impl Sensitivity {
    /// The dimension whose error moves the path most, by rms; of equal ones the first.
    pub fn worst_dimension(&self) -> &Dimension {
        let first = &self.dimensions[0];
        self.dimensions.iter().fold(first, |worst, d| if d.rms > worst.rms { d } else { worst })
    }
}

/// `n` positions spread evenly over each stretch of a motion, its ends left out.
pub fn along(sweep: &Sweep, n: usize) -> Vec<At> {
    let of = |stretch: &super::sweep::Stretch| {
        let stretch = *stretch;
        (0..n).map(move |i| At {
            crank_angle: stretch.from + (stretch.to - stretch.from) * (i as f64 + 0.5) / n as f64,
            assembly: stretch.assembly,
        })
    };
    sweep.stretches.iter().flat_map(of).collect()
}

/// Whether the coupler is measured by coupler_x and coupler_y.
pub fn is_flat(linkage: &FourBar) -> bool {
    linkage.coupler_offset().im.abs() < FLAT * linkage.crank_side().max(linkage.follower_side())
}

/// Positions whose shifts a thread takes at once.
const AT_ONCE: usize = 512;

/// dP by the nine dimensions and the crank angle at a position; `None` at a toggle or where the loop is open.
fn columns(linkage: &FourBar, at: &At, flat: bool) -> Option<([Complex; 9], Complex)> {
    if !flat {
        return linkage.with_assembly(at.assembly).gradient(at.crank_angle);
    }
    let frame = linkage.frame(at.crank_angle, at.assembly)?;
    let gradient = shape_gradient(&frame, linkage.crank(), linkage.coupler(), linkage.coupler_offset())?;
    Some((gradient.shape, gradient.crank_angle))
}

/// How far the path moves at the given positions for errors of the dimensions; `None` where none of the positions
/// has a derivative.
pub fn sensitivity(linkage: &FourBar, positions: &[At], crank: Crank) -> Option<Sensitivity> {
    let flat = is_flat(linkage);
    let mut at_toggles = Vec::new();
    let mut places = Vec::new();
    let mut rows: Vec<([Complex; 10], Complex)> = Vec::new();
    let ground = Complex::from_polar(1.0, linkage.ground_angle());
    let shifts: Vec<_> =
        positions.par_iter().with_min_len(AT_ONCE).map(|at| columns(linkage, at, flat)).collect();
    for (j, shift) in shifts.into_iter().enumerate() {
        let Some((nine, mut by_crank)) = shift else {
            at_toggles.push(j);
            continue;
        };
        let mut row = [Complex::new(0.0, 0.0); 10];
        row[..9].copy_from_slice(&nine);
        if crank == Crank::TurnsWithGround {
            // d(angle of A -> B) = <i ground, dB - dA> / g
            let across = turned(ground) / linkage.ground();
            row[0] -= by_crank * across.re;
            row[1] -= by_crank * across.im;
            row[2] += by_crank * across.re;
            row[3] += by_crank * across.im;
        }
        row[9] = row[2] * ground.re + row[3] * ground.im;
        if matches!(crank, Crank::Stays | Crank::TurnsWithGround) {
            by_crank = Complex::new(0.0, 0.0);
        }
        places.push(j);
        rows.push((row, by_crank));
    }
    settle(&mut rows, crank);
    let of =
        |k: usize, name: &'static str| dimension(name, &places, rows.iter().map(|(row, _)| length(row[k])));
    let mut names = ["Ax", "Ay", "Bx", "By", "a", "b", "c", "d", "e"];
    if flat {
        (names[7], names[8]) = ("coupler_x", "coupler_y");
    }
    let together = rows.iter().map(|(row, _)| row[..9].iter().map(Complex::norm_sqr).sum::<f64>().sqrt());
    let all = dimension("all", &places, together)?;
    let mut dimensions = [all; 9];
    for (k, name) in names.into_iter().enumerate() {
        dimensions[k] = of(k, name)?;
    }
    Some(Sensitivity {
        crank,
        dimensions,
        ground: of(9, "ground")?,
        band: all.rms,
        worst: all.worst,
        worst_at: all.worst_at,
        at_toggles,
        points: rows.len(),
    })
}

/// Takes out of the shifts what the crank makes good.
fn settle(rows: &mut [([Complex; 10], Complex)], crank: Crank) {
    let fastest = rows.iter().map(|(_, by_crank)| length(*by_crank)).fold(0.0, f64::max);
    match crank {
        Crank::Stays | Crank::TurnsWithGround => {}
        Crank::Settles => {
            for (row, by_crank) in rows.iter_mut() {
                let speed = length(*by_crank);
                if speed > STANDSTILL * fastest {
                    let across = Complex::from_polar(1.0, by_crank.arg() + FRAC_PI_2);
                    row.iter_mut().for_each(|shift| *shift = across * dot(across, *shift));
                }
            }
        }
        Crank::OffsetIsSet => {
            let sum_sq: f64 = rows.iter().map(|(_, by_crank)| by_crank.norm_sqr()).sum();
            if sum_sq > 0.0 {
                for k in 0..10 {
                    let along: f64 = rows.iter().map(|(row, by_crank)| dot(*by_crank, row[k])).sum();
                    rows.iter_mut().for_each(|(row, by_crank)| row[k] -= *by_crank * (along / sum_sq));
                }
            }
        }
    }
}

fn dimension(name: &'static str, places: &[usize], shifts: impl Iterator<Item = f64>) -> Option<Dimension> {
    let mut of = Dimension { name, rms: 0.0, worst: 0.0, worst_at: *places.first()? };
    for (&place, shift) in places.iter().zip(shifts) {
        of.rms += shift * shift;
        if shift > of.worst {
            (of.worst, of.worst_at) = (shift, place);
        }
    }
    of.rms = (of.rms / places.len() as f64).sqrt();
    Some(of)
}
