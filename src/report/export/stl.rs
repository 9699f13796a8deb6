//! STL as text: one solid for each plate, laid out side by side on z = 0, in millimetres. A text STL has no comments:
//! the mark of the generator follows the first solid's name.

use super::mesh::Mesh;
use super::model::Model;
use super::settings::Refusal;
use crate::files::generator::mark;
use crate::mechanism::plates::{Placement, Plate};
use std::fmt::Write;

/// Returns the plates as solids.
pub(super) fn plates(model: &Model<'_>, plates: &[(Plate, Placement)]) -> Result<String, Refusal> {
    let mut out = String::new();
    for (plate, at) in plates {
        let name = plate.link.name();
        let mesh = Mesh::of(model, plate, at).ok_or_else(|| {
            Refusal::new(
                format!("the {name} cannot be made a closed body with these sizes"),
                "choose a smaller hole_mm, or a larger margin_mm or chord_mm",
            )
        })?;
        let mark = if out.is_empty() { format!(" {}", mark()) } else { String::new() };
        let _ = writeln!(out, "solid {name}{mark}");
        for triangle in &mesh.triangles {
            let _ = writeln!(out, "facet normal {}", numbers(mesh.normal(*triangle).map(|x| x as f32)));
            out.push_str("outer loop\n");
            for corner in triangle {
                let _ = writeln!(out, "vertex {}", numbers(mesh.vertices[*corner]));
            }
            out.push_str("endloop\nendfacet\n");
        }
        let _ = writeln!(out, "endsolid {name}{mark}");
    }
    Ok(out)
}

fn numbers(v: [f32; 3]) -> String {
    // -0 is written as 0.
    let [x, y, z] = v.map(|x| x + 0.0);
    format!("{x} {y} {z}")
}
