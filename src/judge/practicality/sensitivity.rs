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
//! The dimensions are the nine of [`crate::mechanism::NaturalCoordinates`], each moved alone. If P lies nearly on the
//! line C-D, d and e hardly determine its position (coupler_y is the root of a small difference): then the coupler is
//! measured by `coupler_x` and `coupler_y`, P along and across C -> D. `ground` moves B along A -> B; it is reported
//! beside the nine, and is no part of the band because Bx and By are.

use super::sweep::Sweep;
use crate::mechanism::effort::POINTS_AT_ONCE;
use crate::mechanism::four_bar::gradient::{follower_gradient, ground_gradient, shape_gradient};
use crate::mechanism::{AssemblyMode, Complex, FourBar, dot, length};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Distance of P from the line C-D, as a part of the larger of d and e, below which P counts as on that line.
pub const FLAT: f64 = 0.1;
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
    /// The nine dimensions, in the order Ax, Ay, Bx, By, a, b, c, d, e (or coupler_x, coupler_y in place of d, e).
    pub dimensions: [Dimension; 9],
    /// The dimension |AB|, B moved along the ground line: a combination of Bx and By.
    pub ground: Dimension,
    /// The rms band for a standard deviation of 1 of each of the nine.
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

/// Returns whether the coupler is measured by coupler_x and coupler_y.
pub fn is_flat(linkage: &FourBar) -> bool {
    linkage.coupler_offset().im.abs() < FLAT * linkage.crank_side().max(linkage.follower_side())
}

/// Computes dP by the nine dimensions and the crank angle at a position; `None` at a toggle or if the loop is open.
fn columns(linkage: &FourBar, at: &At, flat: bool) -> Option<([Complex; 9], Complex)> {
    if !flat {
        return linkage.with_assembly(at.assembly).gradient(at.crank_angle);
    }
    let frame = linkage.frame(at.crank_angle, at.assembly)?;
    let gradient = shape_gradient(&frame, linkage.crank(), linkage.coupler(), linkage.coupler_offset())?;
    Some((gradient.shape, gradient.crank_angle))
}

/// Computes the derivatives of the follower's angle from the ground line, degrees, as real parts; `None` at a toggle or if
/// the loop is open.
fn output_columns(linkage: &FourBar, at: &At) -> Option<([Complex; 9], Complex)> {
    let frame = linkage.frame(at.crank_angle, at.assembly)?;
    let (mut by_shape, by_crank) = follower_gradient(&frame, linkage.crank(), linkage.follower())?;
    let by_ground = ground_gradient(linkage.crank_pivot(), linkage.follower_pivot());
    by_shape.iter_mut().zip(by_ground).for_each(|(by, ground)| *by -= ground);
    let degrees = |radians: f64| Complex::new(radians.to_degrees(), 0.0);
    Some((by_shape.map(degrees), degrees(by_crank)))
}

/// Computes the shifts of the path at the given positions for errors of the dimensions; `None` if none of the positions
/// has a derivative.
pub fn sensitivity(linkage: &FourBar, positions: &[At], crank: Crank) -> Option<Sensitivity> {
    sensitivity_of(linkage, positions, crank, None)
}

/// Computes the changes of the follower's angle at the given positions for errors of the dimensions, degrees; `None` if none
/// of the positions has a derivative. `offset_is_free`: whether outputs count from any angle.
pub fn output_sensitivity(
    linkage: &FourBar,
    positions: &[At],
    crank: Crank,
    offset_is_free: bool,
) -> Option<Sensitivity> {
    sensitivity_of(linkage, positions, crank, Some(offset_is_free))
}

/// As [`sensitivity`], or as [`output_sensitivity`] where `output` says whether its offset is free.
fn sensitivity_of(
    linkage: &FourBar,
    positions: &[At],
    crank: Crank,
    output: Option<bool>,
) -> Option<Sensitivity> {
    let flat = is_flat(linkage) && output.is_none();
    let mut at_toggles = Vec::new();
    let mut places = Vec::new();
    let mut rows: Vec<Row> = Vec::new();
    let ground = Complex::from_polar(1.0, linkage.ground_angle());
    let columns = |at: &At| match output {
        None => columns(linkage, at, flat),
        Some(_) => output_columns(linkage, at),
    };
    let shifts: Vec<_> = positions.par_iter().with_min_len(POINTS_AT_ONCE).map(columns).collect();
    for (j, shift) in shifts.into_iter().enumerate() {
        let Some((nine, mut by_crank)) = shift else {
            at_toggles.push(j);
            continue;
        };
        let mut row = [Complex::new(0.0, 0.0); 10];
        row[..9].copy_from_slice(&nine);
        let settles = crank == Crank::Settles || positions[j].is_free;
        if crank == Crank::TurnsWithGround {
            let by_ground = ground_gradient(linkage.crank_pivot(), linkage.follower_pivot());
            row.iter_mut().zip(by_ground).for_each(|(shift, by)| *shift += by_crank * by);
        }
        row[9] = row[2] * ground.re + row[3] * ground.im;
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
    let mut names = ["Ax", "Ay", "Bx", "By", "a", "b", "c", "d", "e"];
    if flat {
        (names[7], names[8]) = ("coupler_x", "coupler_y");
    }
    let together = rows.iter().map(|row| row.shifts[..9].iter().map(Complex::norm_sqr).sum::<f64>().sqrt());
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
        settled,
    })
}

/// The shifts at a position for errors of the nine dimensions and of |AB|.
struct Row {
    shifts: [Complex; 10],
    /// The shift by the crank angle; zero where that stays.
    by_crank: Complex,
    /// Whether the crank settles at this position alone.
    settles: bool,
}

/// Removes the mean of each column: the part that the offset of outputs compensates.
fn without_mean(rows: &mut [Row]) {
    let n = rows.len().max(1) as f64;
    let means: [Complex; 10] =
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
            let along: [f64; 10] =
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
