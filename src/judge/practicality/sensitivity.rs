//! Sensitivity of the path to errors of the dimensions.
//!
//! With s_jk the shift of the path at point j for a unit error of dimension k, to first order,
//!
//! ```text
//! of one dimension    rms_k = sqrt(sum_j |s_jk|^2 / n),   worst_k = max_j |s_jk|
//! of all together     band  = sigma sqrt(sum_k rms_k^2),  worst   = sigma max_j sqrt(sum_k |s_jk|^2)
//! ```
//!
//! with an independent error of standard deviation sigma in every dimension. The shift depends on the behaviour of the
//! crank angles once the linkage is built, see [`Crank`]: with free timing the part of dP along the path only makes the
//! point pass earlier or later, and the shift of the path is the part across it. (If the path misses the target by
//! T - P, that vector is perpendicular to the path, and the distance from the target changes by the same part.) So it is too
//! at a point whose crank angle is free although those of others are prescribed.
//!
//! Of a function it is not the path that counts but the output: s_jk is then the change of the follower's angle from the
//! ground line, in degrees, for a unit error of dimension k; where the offset of outputs is free, its mean is set to zero anew.
//!
//! The dimensions of a four-bar are the nine of [`crate::mechanism::NaturalCoordinates`], each moved alone. If P lies nearly
//! on the line C-D, d and e hardly determine its position (coupler_y is the root of a small difference): then the coupler
//! is measured by `coupler_x` and `coupler_y`, P along and across C -> D. Those of a slider are in
//! [`dimensions`](super::dimensions). `ground` moves B along A -> B; it is reported beside them, and is no part of the band
//! because Bx and By are.

use super::dimensions::{Dimensions, MOST, of_output, of_path};
pub use super::dimensions::{FLAT, is_flat};
use super::sweep::Sweep;
use crate::mechanism::effort::POINTS_AT_ONCE;
use crate::mechanism::{AssemblyMode, Complex, CrankLinkage, dot, length};
use crate::task::Output;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Speed of P, as a part of the fastest, at and below which the path has no direction at that point.
const STANDSTILL: f64 = 1e-9;

/// Behaviour of the crank angles when a dimension is off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crank {
    /// Free timing: at each point the crank turns until P is nearest; the shift is the part across the path.
    Settles,
    /// Prescribed increments, free offset: one offset for all points is set anew so that they move least.
    OffsetIsSet,
    /// Prescribed from the x axis: the angles stay.
    Stays,
    /// Prescribed from the ground line: the angles turn with A -> B.
    TurnsWithGround,
}

/// A position at which the path is examined.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct At {
    /// The crank angle, radians from the x axis.
    pub crank_angle: f64,
    /// The assembly mode.
    pub assembly: AssemblyMode,
    /// Whether the crank angle of this position is free although those of others are prescribed: it settles as with
    /// [`Crank::Settles`].
    pub is_free: bool,
}

/// Shift of the path for a unit error of one dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dimension {
    /// The dimension's letter in files.
    pub name: &'static str,
    /// Root mean square of the shift over the points.
    pub rms: f64,
    /// Largest shift at a point.
    pub worst: f64,
    /// Index of that point, counted from 0.
    pub worst_at: usize,
}

/// Shifts of the path for errors of the dimensions.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The behaviour of the crank angles.
    pub crank: Crank,
    /// The dimensions, of a four-bar in the order Ax, Ay, Bx, By, a, b, c, d, e (or coupler_x, coupler_y in place of d, e).
    pub dimensions: Vec<Dimension>,
    /// The dimension |AB|, B moved along the ground line: a combination of Bx and By. `None` without a ground link.
    pub ground: Option<Dimension>,
    /// The rms band for a standard deviation of 1 of each of the dimensions.
    pub band: f64,
    /// The same band at the point where it is largest.
    pub worst: f64,
    /// Index of that point, counted from 0.
    pub worst_at: usize,
    /// Indices of the points without a derivative (at a toggle, or with an open loop), left out of all figures.
    pub at_toggles: Vec<usize>,
    /// Number of points with a derivative.
    pub points: usize,
    /// Number of those at which the crank angle is free although those of others are prescribed.
    pub settled: usize,
}

impl Sensitivity {
    /// Returns the dimension whose error moves the path most, by rms; of equal ones the first.
    pub fn worst_dimension(&self) -> &Dimension {
        let first = &self.dimensions[0];
        self.dimensions.iter().fold(first, |worst, d| if d.rms > worst.rms { d } else { worst })
    }
}

/// Returns `n` positions spread evenly over each stretch of a motion, its ends left out.
pub fn along(sweep: &Sweep, n: usize) -> Vec<At> {
    let of = |stretch: &super::sweep::Stretch| {
        let stretch = *stretch;
        (0..n).map(move |i| At {
            crank_angle: stretch.from + (stretch.to - stretch.from) * (i as f64 + 0.5) / n as f64,
            assembly: stretch.assembly,
            is_free: false,
        })
    };
    sweep.stretches.iter().flat_map(of).collect()
}

/// Computes the shifts of the path at the given positions for errors of the dimensions; `None` if none of the positions
/// has a derivative.
pub fn sensitivity(linkage: impl Into<CrankLinkage>, positions: &[At], crank: Crank) -> Option<Sensitivity> {
    sensitivity_of(&*of_path(&linkage.into(), positions), positions, crank, None)
}

/// Computes the changes of the output at the given positions for errors of the dimensions: of an angle in degrees, of a slider's
/// place as a length. `None` if none of the positions has a derivative, or the linkage no such output. `offset_is_free`: whether
/// outputs count from anywhere.
pub fn output_sensitivity(
    linkage: impl Into<CrankLinkage>,
    output: Output,
    positions: &[At],
    (crank, offset_is_free): (Crank, bool),
) -> Option<Sensitivity> {
    let of = of_output(&linkage.into(), output, positions)?;
    sensitivity_of(&*of, positions, crank, Some(offset_is_free))
}

/// As [`sensitivity`], or as [`output_sensitivity`] where `output` says whether its offset is free.
fn sensitivity_of(
    linkage: &dyn Dimensions,
    positions: &[At],
    crank: Crank,
    output: Option<bool>,
) -> Option<Sensitivity> {
    let names = linkage.names();
    let mut at_toggles = Vec::new();
    let mut places = Vec::new();
    let mut rows: Vec<Row> = Vec::new();
    let columns = |at: &At| linkage.columns(at);
    let shifts: Vec<_> = positions.par_iter().with_min_len(POINTS_AT_ONCE).map(columns).collect();
    for (j, shift) in shifts.into_iter().enumerate() {
        let Some((all, mut by_crank)) = shift else {
            at_toggles.push(j);
            continue;
        };
        let mut row = [Complex::new(0.0, 0.0); MOST + 1];
        row[..MOST].copy_from_slice(&all);
        let settles = crank == Crank::Settles || positions[j].is_free;
        if crank == Crank::TurnsWithGround {
            row.iter_mut().zip(linkage.of_ground()).for_each(|(shift, by)| *shift += by_crank * by);
        }
        row[MOST] = linkage.by_ground(&row).unwrap_or_default();
        if !settles && matches!(crank, Crank::Stays | Crank::TurnsWithGround) {
            by_crank = Complex::new(0.0, 0.0);
        }
        places.push(j);
        rows.push(Row { shifts: row, by_crank, settles });
    }
    if output == Some(true) {
        without_mean(&mut rows);
    }
    let settled = if crank == Crank::Settles { 0 } else { rows.iter().filter(|row| row.settles).count() };
    settle(&mut rows, crank);
    let of =
        |k: usize, name: &'static str| dimension(name, &places, rows.iter().map(|row| length(row.shifts[k])));
    let together =
        rows.iter().map(|row| row.shifts[..MOST].iter().map(Complex::norm_sqr).sum::<f64>().sqrt());
    let all = dimension("all", &places, together)?;
    let dimensions =
        names.into_iter().enumerate().map(|(k, name)| of(k, name)).collect::<Option<Vec<_>>>()?;
    let has_ground = linkage.by_ground(&[Complex::default(); MOST]).is_some();
    Some(Sensitivity {
        crank,
        dimensions,
        ground: if has_ground { of(MOST, "ground") } else { None },
        band: all.rms,
        worst: all.worst,
        worst_at: all.worst_at,
        at_toggles,
        points: rows.len(),
        settled,
    })
}

/// The shifts at a position for errors of the dimensions and of |AB|.
struct Row {
    shifts: [Complex; MOST + 1],
    /// The shift by the crank angle; zero where that stays.
    by_crank: Complex,
    /// Whether the crank settles at this position alone.
    settles: bool,
}

/// Removes the mean of each column: the part that the offset of outputs compensates.
fn without_mean(rows: &mut [Row]) {
    let n = rows.len().max(1) as f64;
    let means: [Complex; MOST + 1] =
        std::array::from_fn(|k| rows.iter().map(|row| row.shifts[k]).sum::<Complex>() / n);
    let mean_by_crank = rows.iter().map(|row| row.by_crank).sum::<Complex>() / n;
    for row in rows.iter_mut() {
        row.shifts.iter_mut().zip(means).for_each(|(shift, mean)| *shift -= mean);
        row.by_crank -= mean_by_crank;
    }
}

/// Removes from the shifts the part that the crank compensates. Where it settles at a position alone, its common offset
/// moves P along the path there, which does not count.
fn settle(rows: &mut [Row], crank: Crank) {
    let fastest = rows.iter().map(|row| length(row.by_crank)).fold(0.0, f64::max);
    for row in rows.iter_mut().filter(|row| row.settles) {
        if length(row.by_crank) > STANDSTILL * fastest {
            let across = Complex::from_polar(1.0, row.by_crank.arg() + FRAC_PI_2);
            row.shifts.iter_mut().for_each(|shift| *shift = across * dot(across, *shift));
        }
    }
    if crank == Crank::OffsetIsSet {
        let timed = || rows.iter().filter(|row| !row.settles);
        let sum_sq: f64 = timed().map(|row| row.by_crank.norm_sqr()).sum();
        if sum_sq > 0.0 {
            let along: [f64; MOST + 1] =
                std::array::from_fn(|k| timed().map(|row| dot(row.by_crank, row.shifts[k])).sum());
            for row in rows.iter_mut().filter(|row| !row.settles) {
                let by_crank = row.by_crank;
                row.shifts
                    .iter_mut()
                    .zip(along)
                    .for_each(|(shift, along)| *shift -= by_crank * (along / sum_sq));
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
