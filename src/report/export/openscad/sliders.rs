//! The scripts of linkages with a slider: a slotted plate, and a block with two guide pins.

use super::{Parameter, Script};
use crate::mechanism::plates::{Guide, Parts};
use crate::mechanism::{InvertedSliderCrank, SliderCrank};

/// Returns the parameters of a guide; `from` is the point from which places count, in words.
fn of_guide(parts: &Parts, [from, to]: [&'static str; 2]) -> Vec<Parameter> {
    let guide = parts.guide();
    let of = |value: fn(&Guide) -> f64| guide.map_or(0.0, value);
    vec![
        ("travel_from", of(|guide| guide.travel[0]), from),
        ("travel_to", of(|guide| guide.travel[1]), to),
        ("guide", of(|guide| 2.0 * guide.half), "distance of the guide pins E and F of the block"),
        ("end", of(|guide| guide.end), "room at either end of the slot"),
    ]
}

/// Returns the parameters and the body for a slider-crank.
pub(super) fn slider_crank(linkage: &SliderCrank, parts: &Parts) -> Script {
    let p = linkage.parameters();
    let mut numbers = vec![
        ("Ax", p.crank_pivot[0], "A, the fixed pivot of the crank"),
        ("Ay", p.crank_pivot[1], ""),
        ("a", p.crank, "|AC|, the crank"),
        ("b", p.coupler, "|CD|, the coupler"),
        ("Qx", p.line_point[0], "Q, a point of the slider's line"),
        ("Qy", p.line_point[1], ""),
        ("line_deg", p.line_deg, "direction of that line from the x axis"),
        ("Px", p.coupler_x, "P along C -> D, from C"),
        ("Py", p.coupler_y, "P across C -> D, left positive"),
    ];
    numbers.extend(of_guide(
        parts,
        [
            "least place of D over the motion, from Q along the line: it follows from the lengths",
            "greatest place",
        ],
    ));
    Script {
        t1: "1: of the two places of D on its line, the one further along it; -1: the other",
        numbers,
        body: [SLIDER_CRANK, PLATES, SLIDER_CRANK_ASSEMBLY, LAYOUT].concat(),
    }
}

/// Returns the parameters and the body for an inverted slider-crank.
pub(super) fn inverted_slider_crank(linkage: &InvertedSliderCrank, parts: &Parts) -> Script {
    let p = linkage.parameters();
    let mut numbers = vec![
        ("Ax", p.crank_pivot[0], "A, the fixed pivot of the crank"),
        ("Ay", p.crank_pivot[1], ""),
        ("Bx", p.block_pivot[0], "B, the fixed pivot of the block"),
        ("By", p.block_pivot[1], ""),
        ("a", p.crank, "|AC|, the crank"),
        ("offset", p.offset, "B lies this far to the left of the coupler's line through C"),
        ("Px", p.coupler_x, "P along the coupler, from C"),
        ("Py", p.coupler_y, "P across the coupler, left positive"),
    ];
    numbers.extend(of_guide(
        parts,
        [
            "least place of the block over the motion, from C along the coupler: it follows from the lengths",
            "greatest place",
        ],
    ));
    let drilled = if parts.undrilled().is_some() { 0.0 } else { 1.0 };
    numbers.push(("drill_P", drilled, "1: P has a hole; 0: it lies in the slot"));
    Script {
        t1: "1: the block is ahead of C along the coupler; -1: behind it",
        numbers,
        body: [INVERTED, PLATES, INVERTED_ASSEMBLY, LAYOUT].concat(),
    }
}

/// The points of the plates of a slider-crank.
const SLIDER_CRANK: &str = r#"
A = [Ax, Ay];
Q = [Qx, Qy];
s = [cos(line_deg), sin(line_deg)];
function along(v) = v * s;
function across(v) = s.x * v.y - s.y * v.x;

// Holes are x, y and their diameter; a slot is its two ends.
ground_holes = [[0, 0, @hole:ground:A@]];
ground_slot = [for (x = [travel_from - guide / 2 - end, travel_to + guide / 2 + end])
    [along(Q - A) + x, across(Q - A)]];
crank_holes = [[0, 0, @hole:crank:A@], [a, 0, @hole:crank:C@]];
coupler_holes = [[0, 0, @hole:coupler:C@], [b, 0, @hole:coupler:D@], [Px, Py, @hole:coupler:P@]];
coupler_slot = [];
coupler_corners = [];
block_holes = [[0, 0, @hole:block:D@], [-guide / 2, 0, @hole:block:E@], [guide / 2, 0, @hole:block:F@]];
"#;

/// The points of the plates of an inverted slider-crank.
const INVERTED: &str = r#"
A = [Ax, Ay];
B = [Bx, By];
g = norm(B - A);

// Holes are x, y and their diameter; a slot is its two ends.
ground_holes = [[0, 0, @hole:ground:A@], [g, 0, @hole:ground:B@]];
ground_slot = [];
crank_holes = [[0, 0, @hole:crank:A@], [a, 0, @hole:crank:C@]];
coupler_holes = concat([[0, 0, @hole:coupler:C@]], drill_P == 1 ? [[Px, Py, @hole:coupler:P@]] : []);
coupler_slot = [[travel_from - guide / 2 - end, 0], [travel_to + guide / 2 + end, 0]];
coupler_corners = [[Px, Py]];
block_holes = [[0, offset, @hole:block:B@], [-guide / 2, 0, @hole:block:E@], [guide / 2, 0, @hole:block:F@]];
"#;

/// The modules of the plates.
const PLATES: &str = r#"washer = thickness / 10; // between the layers of the assembly
function sides(radius) = max(24, min(720, ceil(180 / max(0.25, acos(max(0, 1 - chord / radius))))));
function radius(largest) = max(hole, largest) / 2 + margin;
@radii@
// A plate: the hull of its holes, its slot and further corners grown by a radius r, holes and slot taken out.
module plate(holes, r@t@, slot = [], corners = []) {
    difference() {
        linear_extrude(thickness) hull()
            for (h = concat(holes, slot, corners)) translate([h.x, h.y]) circle(r = r, $fn = sides(r));
        for (h = holes) translate([h.x, h.y, -thickness])
            cylinder(d = h.z, h = 3 * thickness, $fn = sides(h.z / 2));
        if (len(slot) == 2) translate([0, 0, -thickness]) linear_extrude(3 * thickness) hull()
            for (h = slot) translate([h.x, h.y]) circle(d = hole, $fn = sides(hole / 2));
    }
}
module ground() plate(ground_holes, @r:ground@@t:ground@, ground_slot);
module crank() plate(crank_holes, @r:crank@@t:crank@);
module coupler() plate(coupler_holes, @r:coupler@@t:coupler@, coupler_slot, coupler_corners);
module block() plate(block_holes, @r:block@@t:block@);

// Puts a plate's origin on a joint and its x axis along a vector, in a layer.
module place(from, vector, layer)
    translate([from.x, from.y, layer * @pitch@]) rotate(atan2(vector.y, vector.x)) children();
"#;

/// The position of a slider-crank: D = Q + y s with |D - C| = b.
const SLIDER_CRANK_ASSEMBLY: &str = r#"
// C on the crank; D on the line, at b from C.
C = A + a * [cos(crank_deg), sin(crank_deg)];
k = b * b - pow(across(C - Q), 2);
assert(view == "plates" || k > -1e-9 * b * b, "the links cannot be joined at this crank angle");
D = Q + (along(C - Q) + t1 * sqrt(max(0, k))) * s;

module assembly() {
    color("seagreen") place(D, s, 0) block();
    color("silver") place(A, s, 1) ground();
    color("tomato") place(A, C - A, 2) crank();
    color("steelblue") place(C, D - C, 3) coupler();
}
"#;

/// The position of an inverted slider-crank: u = V (x - i h)/|V|^2 with V = B - C.
const INVERTED_ASSEMBLY: &str = r#"
// C on the crank; the coupler's direction u, with B at the offset to its left.
C = A + a * [cos(crank_deg), sin(crank_deg)];
V = B - C;
k = V * V - offset * offset;
assert(view == "plates" || k > -1e-9 * (V * V), "the links cannot be joined at this crank angle");
x = t1 * sqrt(max(0, k));
u = [V.x * x + V.y * offset, V.y * x - V.x * offset] / (V * V);
D = C + x * u;

module assembly() {
    color("silver") place(A, B - A, 0) ground();
    color("tomato") place(A, C - A, 1) crank();
    color("seagreen") place(D, u, 2) block();
    color("steelblue") place(C, u, 3) coupler();
}
"#;

/// The layout of the plates, one above another.
const LAYOUT: &str = r#"
function low(points) = [min([for (p = points) p.x]), min([for (p = points) p.y])];
function high(points) = [max([for (p = points) p.x]), max([for (p = points) p.y])];
function height(points, r) = high(points).y - low(points).y + 2 * r + gap;
module laid(points, r, y) translate([r - low(points).x, y + r - low(points).y, 0]) children();

ground_points = concat(ground_holes, ground_slot);
coupler_points = concat(coupler_holes, coupler_slot, coupler_corners);
if (view == "assembly") {
    assembly();
} else {
    above_ground = height(ground_points, @r:ground@);
    above_crank = above_ground + height(crank_holes, @r:crank@);
    above_coupler = above_crank + height(coupler_points, @r:coupler@);
    laid(ground_points, @r:ground@, 0) ground();
    laid(crank_holes, @r:crank@, above_ground) crank();
    laid(coupler_points, @r:coupler@, above_crank) coupler();
    laid(block_holes, @r:block@, above_coupler) block();
}
"#;
