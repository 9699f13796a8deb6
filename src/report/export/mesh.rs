//! A plate as a closed mesh of triangles: its outline and holes as polygons, extruded by the thickness.
//!
//! Top and bottom are one triangulation of the outline without the holes (the ear-clipping of the `earcut` crate), and
//! the sides are on the polygons' edges, so that each edge of the body belongs to two triangles that run through it in
//! opposite directions. [`Mesh::is_closed`] checks that for every body.

use super::model::Model;
use crate::mechanism::plates::{Edge, Placement, Plate};
use crate::mechanism::{Complex, cross};
use nalgebra::Vector3;
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// A triangle mesh; the corners of each triangle are counter-clockwise seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mesh {
    /// The vertices, in single precision, as every reader of STL keeps them.
    pub(super) vertices: Vec<[f32; 3]>,
    pub(super) triangles: Vec<[usize; 3]>,
}

/// The phases of the polygons of holes, as fractions of a side, chosen so that no two corners have the same height; the
/// next one is tried if collinear points lead to a triangulation that is not closed.
const PHASES: [f64; 4] = [0.291, 0.137, 0.413, 0.067];
/// The difference between the phases of successive holes.
const STAGGER: f64 = 0.019;

impl Mesh {
    /// Returns the mesh of a placed plate with its holes and its slot, with its lower side at z = 0. `None` if no closed
    /// body was found (holes that leave the plate).
    pub(super) fn of(model: &Model<'_>, plate: &Plate, place: &Placement) -> Option<Self> {
        PHASES.iter().find_map(|phase| Mesh::with_phase(model, plate, place, *phase))
    }

    fn with_phase(model: &Model<'_>, plate: &Plate, place: &Placement, phase: f64) -> Option<Self> {
        let (thickness, chord) = (model.thickness_of(plate.link), model.chord);
        let mut rings = vec![polygon(&plate.outline(), plate.radius, chord)];
        for (k, (joints, centre)) in plate.distinct_holes().into_iter().enumerate() {
            let radius = 0.5 * model.holes.of(plate.link, &joints);
            let n = sides(radius, chord);
            let phase = phase + STAGGER * k as f64;
            let turn = |i: usize| Complex::from_polar(radius, -TAU * (i as f64 + phase) / n as f64);
            rings.push((0..n).map(|i| centre + turn(i)).collect());
        }
        // Clockwise, as the holes.
        let slot = polygon(&plate.slot_outline(model.holes.pins), 0.5 * model.holes.pins, chord);
        rings.extend((!slot.is_empty()).then(|| slot.into_iter().rev().collect()));
        let flat: Vec<[f64; 2]> = rings.iter().flatten().map(|p| [p.re, p.im]).collect();
        let total = flat.len();
        let starts: Vec<usize> =
            rings.iter().scan(0, |start, ring| Some(std::mem::replace(start, *start + ring.len()))).collect();
        let mut corners: Vec<usize> = Vec::new();
        earcut::Earcut::new().earcut(flat.iter().copied(), &starts[1..], &mut corners);

        let mut triangles = Vec::with_capacity(2 * total + 2 * corners.len() / 3);
        for triangle in corners.chunks_exact(3) {
            let [i, j, k] = [triangle[0], triangle[1], triangle[2]];
            let at = |i: usize| Complex::new(flat[i][0], flat[i][1]);
            // Upward, whatever the direction of the triangulation.
            let [i, j, k] = if cross(at(j) - at(i), at(k) - at(i)) < 0.0 { [i, k, j] } else { [i, j, k] };
            triangles.push([total + i, total + j, total + k]);
            triangles.push([i, k, j]);
        }
        for (ring, start) in rings.iter().zip(starts) {
            let n = ring.len();
            for i in 0..n {
                let (here, next) = (start + i, start + (i + 1) % n);
                triangles.push([here, next, total + next]);
                triangles.push([here, total + next, total + here]);
            }
        }
        let placed = |p: &[f64; 2]| place.of(Complex::new(p[0], p[1]));
        let level = |z: f64| flat.iter().map(placed).map(move |p| [p.re as f32, p.im as f32, z as f32]);
        let mesh = Mesh { vertices: level(0.0).chain(level(thickness)).collect(), triangles };
        mesh.is_closed().then_some(mesh)
    }

    /// Returns whether every edge is run through once in each direction, by triangles that have an area.
    pub(super) fn is_closed(&self) -> bool {
        let mut edges: BTreeMap<(usize, usize), i32> = BTreeMap::new();
        for &[i, j, k] in &self.triangles {
            for (from, to) in [(i, j), (j, k), (k, i)] {
                *edges.entry((from, to)).or_default() += 1;
            }
        }
        edges.iter().all(|(&(from, to), &count)| count == 1 && edges.contains_key(&(to, from)))
            && self.triangles.iter().all(|triangle| self.normal(*triangle) != [0.0; 3])
    }

    /// Returns the unit normal of a triangle; zeros for one without area.
    pub(super) fn normal(&self, triangle: [usize; 3]) -> [f64; 3] {
        let [p, q, r] = triangle.map(|i| Vector3::from(self.vertices[i].map(f64::from)));
        (q - p).cross(&(r - p)).try_normalize(0.0).map_or([0.0; 3], Into::into)
    }
}

/// Returns the number of sides with which a circle's polygon lies within `chord` of it: r (1 - cos(pi/n)) <= chord.
fn sides(radius: f64, chord: f64) -> usize {
    const FEWEST: f64 = 24.0;
    const MOST: f64 = 720.0;
    let angle = (1.0 - chord / radius).max(0.0).acos();
    (PI / angle).ceil().clamp(FEWEST, MOST) as usize
}

/// Returns an outline as a polygon.
fn polygon(edges: &[Edge], radius: f64, chord: f64) -> Vec<Complex> {
    let n = sides(radius, chord) as f64;
    let mut points = Vec::new();
    for edge in edges {
        match *edge {
            Edge::Line { from, .. } => points.push(from),
            Edge::Arc { from, centre, turn, .. } => {
                let parts = (n * turn / TAU).ceil().max(1.0) as usize;
                let step = |i: usize| Complex::from_polar(1.0, turn * i as f64 / parts as f64);
                points.extend((0..parts).map(|i| centre + (from - centre) * step(i)));
            }
        }
    }
    points
}
