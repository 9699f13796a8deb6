//! An OpenSCAD script: every length is a parameter, the plates are laid out or assembled at a crank angle.

use super::model::Model;
use super::settings::Refusal;
use crate::files::generator::mark;
use crate::report::text::exact;

/// Returns the script. Foreign text is in a comment on one line, cleaned of everything that would end the comment.
pub(super) fn script(model: &Model<'_>) -> Result<String, Refusal> {
    let layout = model.plates()?;
    let ((angle, assembly), _) = model.start()?;
    let (crank_deg, assembly) = match model.settings.crank_deg {
        Some(angle) => {
            model.pose()?;
            (angle, model.linkage.assembly())
        }
        None => (angle.to_degrees(), assembly),
    };
    let p = model.linkage.natural_coordinates();
    let offset = model.linkage.coupler_offset();
    let numbers = [
        ("hole", model.hole, "diameter of every hole"),
        ("margin", model.margin, "from a hole's edge to the edge of the plate"),
        ("thickness", model.thickness, "thickness of the plates"),
        ("gap", model.gap, "between plates that are laid out"),
        ("crank_deg", crank_deg, "crank angle from the x axis, for the assembly"),
        ("t1", assembly.sign(), "1: D lies left of the line from C to B; -1: right"),
        ("Ax", p.crank_pivot[0], "A, the fixed pivot of the crank"),
        ("Ay", p.crank_pivot[1], ""),
        ("Bx", p.follower_pivot[0], "B, the fixed pivot of the follower"),
        ("By", p.follower_pivot[1], ""),
        ("a", p.crank, "|AC|, the crank"),
        ("b", p.coupler, "|CD|, the coupler"),
        ("c", p.follower, "|BD|, the follower"),
        ("Px", offset.re, "P along C -> D, from C"),
        ("Py", offset.im, "P across C -> D, left positive"),
        ("chord", model.chord, "how far an arc may lie from its polygon"),
    ];
    let mut out = format!("// {}\n// {}; every number is a parameter\n\n", model.heading(), mark());
    out.push_str("view = \"plates\"; // [plates, assembly]\n");
    for (name, value, about) in numbers {
        let about = if about.is_empty() { String::new() } else { format!(" // {about}") };
        out.push_str(&format!("{name} = {};{about}\n", exact(value + 0.0)));
    }
    debug_assert_eq!(layout.len(), 4);
    out.push_str(BODY);
    Ok(out)
}

/// The part of the script that draws; equations 10 to 18 of Romero (2016) give D and P.
const BODY: &str = r#"
A = [Ax, Ay];
B = [Bx, By];
g = norm(B - A);
P = [Px, Py];
r = hole / 2 + margin;
washer = thickness / 10; // between the layers of the assembly
function sides(radius) = max(24, min(720, ceil(180 / max(0.25, acos(max(0, 1 - chord / radius))))));

// A plate: the hull of its holes grown by the radius r, holes taken out.
module plate(holes) {
    difference() {
        linear_extrude(thickness) hull()
            for (h = holes) translate(h) circle(r = r, $fn = sides(r));
        for (h = holes) translate([h.x, h.y, -thickness])
            cylinder(d = hole, h = 3 * thickness, $fn = sides(hole / 2));
    }
}
module ground() plate([[0, 0], [g, 0]]);
module crank() plate([[0, 0], [a, 0]]);
module coupler() plate([[0, 0], [b, 0], P]);
module follower() plate([[0, 0], [c, 0]]);

// Where the joints are: C on the crank, D = C + V (u + i t1 sqrt k) with V = B - C.
C = A + a * [cos(crank_deg), sin(crank_deg)];
V = B - C;
s2 = V * V;
u = (1 + (b * b - c * c) / s2) / 2;
k = b * b / s2 - u * u;
assert(view == "plates" || k > -1e-9, "the links cannot be joined at this crank angle");
q = t1 * sqrt(max(0, k));
D = C + [V.x * u - V.y * q, V.y * u + V.x * q];

// Puts a plate's first hole on one joint and its x axis towards another, in a layer.
module place(from, to, layer)
    translate([from.x, from.y, layer * (thickness + washer)])
        rotate(atan2(to.y - from.y, to.x - from.x)) children();

if (view == "assembly") {
    color("silver") place(A, B, 0) ground();
    color("tomato") place(A, C, 1) crank();
    color("steelblue") place(C, D, 2) coupler();
    color("seagreen") place(B, D, 3) follower();
} else {
    bottom = r - min(0, P.y);
    translate([r, r, 0]) ground();
    translate([r, 3 * r + gap, 0]) crank();
    translate([r - min(0, P.x), 4 * r + 2 * gap + bottom, 0]) coupler();
    translate([r, 6 * r + 3 * gap + bottom + max(0, P.y), 0]) follower();
}
"#;
