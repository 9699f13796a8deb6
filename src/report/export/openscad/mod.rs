//! An OpenSCAD script: every length is a parameter, the plates are laid out or assembled at a crank angle.

mod four_bar;
mod multi_loop;
mod sizes;
mod sliders;

use super::model::Model;
use super::settings::Refusal;
use crate::files::generator::mark;
use crate::mechanism::CrankLinkage;
use crate::report::text::exact;
use sizes::Names;

/// A parameter: name, value, and what it is.
type Parameter = (&'static str, f64, &'static str);

/// The part of a script that differs from kind to kind.
struct Script {
    /// The meaning of t1.
    t1: &'static str,
    /// The parameters of the linkage.
    numbers: Vec<Parameter>,
    /// The part that draws, with marks for the names of sizes ([`sizes`]).
    body: String,
}

/// Returns the script. Foreign text is in a comment on one line, cleaned of everything that would end the comment.
pub(super) fn script(model: &Model<'_>) -> Result<String, Refusal> {
    // Only a linkage whose plates can be made has a script.
    let plates = model.plates()?.into_iter().map(|(plate, _)| plate).collect();
    let names = Names::of(model, plates);
    let ((angle, assembly), _) = model.start()?;
    let (crank_deg, assembly) = match model.settings.crank_deg {
        Some(angle) => {
            model.pose()?;
            (angle, model.linkage.assembly())
        }
        None => (angle.to_degrees(), assembly),
    };
    let parts = model.parts()?;
    let own = match &model.linkage {
        CrankLinkage::FourBar(linkage) => four_bar::script(linkage),
        CrankLinkage::SliderCrank(linkage) => sliders::slider_crank(linkage, parts),
        CrankLinkage::InvertedSliderCrank(linkage) => sliders::inverted_slider_crank(linkage, parts),
        CrankLinkage::MultiLoop(linkage) => multi_loop::script(linkage, parts),
    };
    let common = [
        ("hole", model.holes.pins, "diameter of the holes"),
        ("margin", model.margin, "from a hole's edge to the edge of the plate"),
        ("thickness", model.thickness, "thickness of the plates"),
        ("gap", model.gap, "between plates that are laid out"),
        ("crank_deg", crank_deg, "crank angle from the x axis, for the assembly"),
        ("t1", assembly.sign(), own.t1),
    ];
    let chord = ("chord", model.chord, "how far an arc may lie from its polygon");
    let mut out = format!("// {}\n// {}; every number is a parameter\n\n", model.heading(), mark());
    out.push_str("view = \"plates\"; // [plates, assembly]\n");
    for (name, value, about) in common.into_iter().chain(own.numbers).chain([chord]) {
        let about = if about.is_empty() { String::new() } else { format!(" // {about}") };
        out.push_str(&format!("{name} = {};{about}\n", exact(value + 0.0)));
    }
    out.push_str(&names.parameters());
    out.push_str(&names.fill(&own.body));
    Ok(out)
}

/// The module of a plate with round holes, and the radii of plates.
const PLATE: &str = r#"washer = thickness / 10; // between the layers of the assembly
function sides(radius) = max(24, min(720, ceil(180 / max(0.25, acos(max(0, 1 - chord / radius))))));

// A plate: the hull of its holes grown by a radius r, holes taken out. A hole is x, y and its diameter.
function radius(largest) = max(hole, largest) / 2 + margin;
module plate(holes, r@t@) {
    difference() {
        linear_extrude(thickness) hull()
            for (h = holes) translate([h.x, h.y]) circle(r = r, $fn = sides(r));
        for (h = holes) translate([h.x, h.y, -thickness])
            cylinder(d = h.z, h = 3 * thickness, $fn = sides(h.z / 2));
    }
}
@radii@"#;
