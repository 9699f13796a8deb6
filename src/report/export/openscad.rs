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
        ("hole", model.holes.pins, "diameter of the holes"),
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
    let own = |set: Option<f64>, usual: &str| set.map_or(usual.to_owned(), exact);
    let (motor, boss) = (model.settings.motor_hole_mm, model.settings.boss_hole_mm);
    out.push_str(&format!(
        "motor_hole = {}; // of the crank at A, for a motor's shaft\n",
        own(motor, "hole")
    ));
    out.push_str(&format!("boss_hole = {}; // of the ground at A, for its boss\n", own(boss, "motor_hole")));
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
washer = thickness / 10; // between the layers of the assembly
function sides(radius) = max(24, min(720, ceil(180 / max(0.25, acos(max(0, 1 - chord / radius))))));

// A plate: the hull of its holes grown by a radius r, holes taken out. A hole is x, y and its diameter.
function radius(largest) = max(hole, largest) / 2 + margin;
module plate(holes, r) {
    difference() {
        linear_extrude(thickness) hull()
            for (h = holes) translate([h.x, h.y]) circle(r = r, $fn = sides(r));
        for (h = holes) translate([h.x, h.y, -thickness])
            cylinder(d = h.z, h = 3 * thickness, $fn = sides(h.z / 2));
    }
}
r = radius(hole);
r_ground = radius(boss_hole);
r_crank = radius(motor_hole);
module ground() plate([[0, 0, boss_hole], [g, 0, hole]], r_ground);
module crank() plate([[0, 0, motor_hole], [a, 0, hole]], r_crank);
module coupler() plate([[0, 0, hole], [b, 0, hole], [P.x, P.y, hole]], r);
module follower() plate([[0, 0, hole], [c, 0, hole]], r);

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
    above = 2 * r_ground + 2 * r_crank + 2 * gap;
    bottom = r - min(0, P.y);
    translate([r_ground, r_ground, 0]) ground();
    translate([r_crank, 2 * r_ground + gap + r_crank, 0]) crank();
    translate([r - min(0, P.x), above + bottom, 0]) coupler();
    translate([r, above + bottom + max(0, P.y) + 2 * r + gap, 0]) follower();
}
"#;
