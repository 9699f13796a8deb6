//! STL as text: one solid a plate, laid out side by side on z = 0, in millimetres.

use super::mesh::Mesh;
use super::model::Model;
use super::settings::Refusal;
use crate::plates::{Placement, Plate};
use std::fmt::Write;

/// The plates as solids.
pub(super) fn plates(model: &Model<'_>, plates: &[(Plate, Placement)]) -> Result<String, Refusal> {
    let mut out = String::new();
    for (plate, at) in plates {
        let name = plate.link.name();
        let mesh = Mesh::of(plate, model.hole, model.thickness, model.chord).ok_or_else(|| {
            Refusal::new(
                format!("the {name} cannot be made a closed body with these sizes"),
                "choose a smaller hole_mm, or a larger margin_mm or chord_mm",
            )
        })?;
        let placed = |[x, y, z]: [f64; 3]| [x + at.origin.re, y + at.origin.im, z];
        let _ = writeln!(out, "solid {name}");
        for triangle in &mesh.triangles {
            let _ = writeln!(out, "facet normal {}", numbers(mesh.normal(*triangle)));
            out.push_str("outer loop\n");
            for corner in triangle {
                let _ = writeln!(out, "vertex {}", numbers(placed(mesh.vertices[*corner])));
            }
            out.push_str("endloop\nendfacet\n");
        }
        let _ = writeln!(out, "endsolid {name}");
    }
    Ok(out)
}

/// Single precision, as every reader of STL keeps it.
fn numbers(v: [f64; 3]) -> String {
    let [x, y, z] = v.map(|x| x as f32 + 0.0);
    format!("{x} {y} {z}")
}
