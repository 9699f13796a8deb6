//! Value of a chain at one set of unknowns: positions, the linear part, hinges, excursions.

use super::limits::{Bodies, Limits};
use super::reach::{Broken, broken};
use super::target::Points;
use crate::mechanism::AssemblyMode;
use crate::mechanism::dyad_chain::kinds::{CRANK, MAX_DYADS};
use crate::mechanism::dyad_chain::{
    DyadChainKind, Frames, Grid, MAX_PARAMETERS, Placement, Proportions, Shape,
};
use crate::numbers::arithmetic::complex_lanes::ComplexLanes;
use crate::numbers::arithmetic::lane::{F64x8, LANES, Lane};
use crate::numbers::arithmetic::sine::sin_cos_block;
use crate::numbers::arithmetic::{Complex, nearest_share};

/// Share of the product of both variances below which o and v are too nearly proportional for a linear part.
const INDEPENDENT: f64 = 1e-11;

/// A place where the curve leaves the target between two points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Excursion {
    /// Index of the phase on the grid.
    pub(super) phase: usize,
    /// Unit vector away from the target's edge.
    pub(super) away: Complex,
    /// Distance beyond the mean distance of neighbours.
    pub(super) excess: f64,
}

/// The chain at one set of unknowns.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    pub(super) shape: Shape,
    pub(super) of: Proportions,
    pub(super) at: Placement,
    pub(super) phases: Vec<f64>,
    origin: [Vec<f64>; 2],
    along: [Vec<f64>; 2],
    pub(super) grid: Grid,
    pub(super) excursions: Vec<Excursion>,
    /// Limits on footprint and extent that the motion breaks.
    pub(super) broken: Vec<Broken>,
    /// Mean square with the hinges, and without.
    pub(super) value: f64,
    pub(super) misfit: f64,
}

impl Default for Trial {
    fn default() -> Self {
        let shape = Shape {
            kind: DyadChainKind::FOUR_BAR,
            assembly: [AssemblyMode::Plus; MAX_DYADS],
            parameters: [0.5; MAX_PARAMETERS],
        };
        let mut grid = Grid::default();
        let zero = Complex::new(0.0, 0.0);
        Trial {
            shape,
            of: shape.resolve(&mut grid),
            at: Placement { origin: zero, ground: zero, pointer: zero },
            phases: Vec::new(),
            origin: [Vec::new(), Vec::new()],
            along: [Vec::new(), Vec::new()],
            grid,
            excursions: Vec::new(),
            broken: Vec::new(),
            value: f64::INFINITY,
            misfit: f64::INFINITY,
        }
    }
}

/// Returns the directions of the crank at eight phases.
#[inline(always)]
pub(super) fn direction(phases: &[f64], at: usize) -> ComplexLanes {
    let mut block = [0.0; LANES];
    block.copy_from_slice(&phases[at..at + LANES]);
    let (sin, cos) = sin_cos_block(&block);
    ComplexLanes { re: F64x8(cos), im: F64x8(sin) }
}

impl Trial {
    /// Makes room for so many phases.
    pub(super) fn resize(&mut self, padded: usize) {
        self.phases.resize(padded, 0.0);
        for column in self.origin.iter_mut().chain(&mut self.along) {
            column.resize(padded, 0.0);
        }
    }

    /// Computes the value. T, S and Z are those of least squares, unless `stepped` has a lower value together with its
    /// limits of size.
    #[inline(always)]
    pub(super) fn evaluate(
        &mut self,
        points: &Points,
        limits: &Limits,
        bodies: &Bodies,
        frames: &mut Frames<F64x8>,
        stepped: Option<Placement>,
    ) {
        self.of = self.shape.resolve(&mut self.grid);
        let last = self.phases[points.count - 1];
        self.phases[points.count..].fill(last);
        let body = self.shape.kind.traced();
        for at in (0..points.mask.len()).step_by(LANES) {
            frames.along[CRANK] = direction(&self.phases, at);
            frames.assemble_all(&self.of);
            frames.origin[body].store(&mut self.origin, at);
            frames.along[body].store(&mut self.along, at);
        }
        let n = points.count as f64;
        self.value = f64::INFINITY;
        let mut found = None;
        // Where phases depend on S, it is not linear.
        if !points.follow_the_ground()
            && let Some(at) = self.placed(points)
        {
            let sizes = limits.of_sizes(&self.of, &at, bodies);
            found = Some((at, self.misfit_at(points, &at) / n, sizes));
        }
        if let Some(at) = stepped
            && found.is_none_or(|(_, _, sizes)| sizes > 0.0)
        {
            let sizes = limits.of_sizes(&self.of, &at, bodies);
            let own = self.misfit_at(points, &at) / n;
            if found.is_none_or(|(_, misfit, other)| own + sizes < misfit + other) {
                found = Some((at, own, sizes));
            }
        }
        let Some((at, misfit, sizes)) = found else { return };
        (self.at, self.misfit) = (at, misfit);
        self.find_excursions(points);
        let over: f64 = self.excursions.iter().map(|e| e.excess * e.excess).sum();
        self.broken = broken(self, points, limits, bodies);
        let beyond: f64 = self.broken.iter().map(|limit| limit.over * limit.over).sum();
        let sizes = sizes + limits.pivot_weight * beyond;
        let value = misfit + limits.of_transmission(&self.of) + sizes + over / n;
        if value.is_finite() {
            self.value = value;
        }
    }

    /// Computes T, S and Z of least squares, by a 2x2 Hermitian system of centred columns; `None` if o and v are too nearly
    /// proportional.
    #[inline(always)]
    fn placed(&self, points: &Points) -> Option<Placement> {
        let per = 1.0 / points.count as f64;
        let padded = points.mask.len();
        let columns = [&self.origin, &self.along, &points.columns];
        let mut sums = [ComplexLanes::ZERO; 3];
        for at in (0..padded).step_by(LANES) {
            let mask = F64x8::load(&points.mask, at);
            for (sum, column) in sums.iter_mut().zip(columns) {
                *sum = *sum + ComplexLanes::load(column, at).scale(mask);
            }
        }
        let means = sums.map(|sum| sum.sum() * per);
        let [o_mean, v_mean, t_mean] = means.map(ComplexLanes::splat);
        let zero = F64x8::splat(0.0);
        let (mut oo, mut vv) = (zero, zero);
        let (mut ov, mut ot, mut vt) = (ComplexLanes::ZERO, ComplexLanes::ZERO, ComplexLanes::ZERO);
        for at in (0..padded).step_by(LANES) {
            let mask = F64x8::load(&points.mask, at);
            let o = (ComplexLanes::load(&self.origin, at) - o_mean).scale(mask);
            let v = (ComplexLanes::load(&self.along, at) - v_mean).scale(mask);
            let t = ComplexLanes::load(&points.columns, at) - t_mean;
            oo = oo + o.norm_sq();
            vv = vv + v.norm_sq();
            ov = ov + o.dot(v);
            ot = ot + o.dot(t);
            vt = vt + v.dot(t);
        }
        let (oo, vv) = (oo.sum(), vv.sum());
        let (ov, ot, vt) = (ov.sum(), ot.sum(), vt.sum());
        let det = oo * vv - ov.norm_sqr();
        if det.is_nan() || det <= INDEPENDENT * oo * vv {
            return None;
        }
        let ground = (ot * vv - ov * vt) / det;
        let pointer = (vt * oo - ov.conj() * ot) / det;
        let [o_mean, v_mean, t_mean] = means;
        Some(Placement { origin: t_mean - ground * o_mean - pointer * v_mean, ground, pointer })
    }

    /// Returns the sum of squares of P - T_j.
    #[inline(always)]
    pub(super) fn misfit_at(&self, points: &Points, at: &Placement) -> f64 {
        let [t, s, z] = at.numbers().map(ComplexLanes::splat);
        let mut sum = F64x8::splat(0.0);
        for at in (0..points.mask.len()).step_by(LANES) {
            let p = t + s * ComplexLanes::load(&self.origin, at) + z * ComplexLanes::load(&self.along, at);
            let r = p - ComplexLanes::load(&points.columns, at);
            sum = sum + r.norm_sq() * F64x8::load(&points.mask, at);
        }
        sum.sum()
    }

    /// Finds the phases of the grid at which the curve is farther from the edge between two neighbouring points than their
    /// mean distance.
    #[inline(always)]
    pub(super) fn find_excursions(&mut self, points: &Points) {
        self.excursions.clear();
        if points.timing.as_ref().is_some_and(|times| !times.rise) {
            return;
        }
        let curve = self.grid.points(self.shape.kind.traced(), self.at.numbers());
        let (n, phases) = (points.count, curve[0].len());
        let step = Grid::phase(1);
        let first = (self.phases[0] / step).ceil();
        let start = first.rem_euclid(phases as f64) as usize;
        let mut i = 0;
        for m in 0..phases {
            let phase = (first + m as f64) * step;
            while i + 1 < n && self.phases[i + 1] <= phase {
                i += 1;
            }
            if i + 1 == n && !points.closed {
                break;
            }
            let index = (start + m) % phases;
            let p = Complex::new(curve[0][index], curve[1][index]);
            let edge = [points.point(i), points.point((i + 1) % n)];
            let away = p - (edge[0] + (edge[1] - edge[0]) * nearest_share(p, edge));
            let distance = away.norm_sqr().sqrt();
            if distance > points.spacing {
                let excess = distance - points.spacing;
                self.excursions.push(Excursion { phase: index, away: away / distance, excess });
            }
        }
    }
}
